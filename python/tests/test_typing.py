"""The stub is what the extension offers, and types check: the package, its tests' examples, wrong uses."""

import inspect
import subprocess
import sys
from pathlib import Path

import muslin
import muslin._muslin

PACKAGE = Path(muslin.__file__).parent


def mypy(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(cwd / "mypy"), *arguments],
        cwd=cwd,
        capture_output=True,
        text=True,
    )


def test_package_is_typed(tmp_path):
    assert (PACKAGE / "py.typed").exists()
    checked = mypy("-p", "muslin", cwd=tmp_path)
    assert checked.returncode == 0, checked.stdout


def test_stub_names_all_there_is():
    import ast

    stub = ast.parse((PACKAGE / "_muslin.pyi").read_text())
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    public = [name for name in dir(muslin._muslin) if not name.startswith("_")]
    assert set(public) == set(classes) | functions
    assert set(public) <= set(muslin.__all__)
    for name, node in classes.items():
        cls = getattr(muslin._muslin, name)
        members = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
        offered = {member for member in vars(cls) if not member.startswith("_")}
        assert offered == {member for member in members if not member.startswith("_")}, name


def test_everything_public_is_documented():
    for name in muslin.__all__:
        thing = getattr(muslin, name)
        if name == "__version__":
            continue
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing) and thing.__module__.startswith("muslin._muslin"):
            for member, value in vars(thing).items():
                if callable(value) and not member.startswith("_"):
                    assert value.__doc__, f"{name}.{member}"


GOOD = """
import muslin
import numpy as np

mesh = muslin.Mesh(np.zeros((3, 3)), [[0, 1, 2]], groups={"a": [0]})
scene = muslin.read_scene("flag.toml", ["time.duration=2"])
simulation = muslin.Simulation(scene)
simulation.positions = simulation.positions + 1.0
simulation.velocities = [[0.0, 0.0, 0.0]]
simulation.add_force(lambda x, v, t: -0.1 * v, name="drag")
for frame in simulation:
    number: int = frame
history = simulation.history()
total: float = float(history["kinetic"].max())
lattice = simulation.model.bodies[0].lattice
count: int = lattice.voxel_count if lattice is not None else 0
try:
    simulation.advance(progress=lambda fraction, stage: None, cancel=lambda: False)
except muslin.SolverError as error:
    print(error.remedy, error.line)
with muslin.RunWriter("out", simulation) as writer:
    writer.write_frame()
cloth: muslin.scene_types.ShellBody = {"mesh": mesh, "model": "shell", "material": "cotton", "warp": np.zeros(3)}
wind: muslin.scene_types.WindForce = {"type": "wind", "velocity": [1, 0, 0], "drag": None}
tables: muslin.scene_types.Scene = {"time": {"duration": 2}, "body": [cloth], "force": [wind]}
muslin.make_scene(tables)
made: muslin.Sweep = muslin.sweep(scene="flag.toml", grid={"time.steps_per_frame": [2, 4]}, workers=2)
best = made.best["largest_stretch"] if made.best is not None else made.column("largest_stretch")
"""

BAD = {
    "simulation.advance(progress=3)": "arg-type",
    "simulation.positon": "attr-defined",
    "simulation.frame = 3": "misc",
    "muslin.read_scene(7)": "arg-type",
    "simulation.model.bodies[0].lattice.voxel_count": "union-attr",
    "muslin.Mesh([[0, 0, 0]])": "call-arg",
    "muslin.sweep('sweep.toml', workers='two')": "arg-type",
    "a: muslin.scene_types.Time = {'duraton': 2}": "typeddict-unknown-key",
    "b: muslin.scene_types.Solver = {'effort': 'exat'}": "typeddict-item",
    "c: muslin.scene_types.WindForce = {'velocity': [1, 0, 0]}": "typeddict-item",
}


def test_uses_check_and_misuses_do_not(tmp_path):
    (tmp_path / "good.py").write_text(GOOD)
    checked = mypy("good.py", cwd=tmp_path)
    assert checked.returncode == 0, checked.stdout
    (tmp_path / "bad.py").write_text(
        "import muslin\nsimulation = muslin.Simulation(muslin.read_scene('a'))\n" + "\n".join(BAD) + "\n"
    )
    complaints = mypy("bad.py", cwd=tmp_path).stdout.splitlines()
    for line, code in enumerate(BAD.values(), start=3):
        assert any(text.startswith(f"bad.py:{line}:") and text.endswith(f"[{code}]") for text in complaints), (
            line,
            complaints,
        )
