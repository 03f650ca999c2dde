"""`pip install` from the sources: what the sdist and the wheel hold, and that the installed module works.

The wheel is built from the unpacked sdist on the engine that is compiled already, so that the C++ library is not
compiled twice; that the sdist has all of the library is checked by its list of files.
"""

import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import muslin
import pytest

FROM_HERE = "import sys; from scikit_build_core import build; print(build.build_{kind}(sys.argv[1], {{{settings}}}))"


def run(*command: object, cwd: Path, **environment: str) -> str:
    done = subprocess.run(
        [str(part) for part in command], cwd=cwd, capture_output=True, text=True, env=os.environ | environment
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def sdist(source, tmp_path_factory) -> Path:
    """The source distribution, unpacked."""
    folder = tmp_path_factory.mktemp("sdist")
    name = run(sys.executable, "-c", FROM_HERE.format(kind="sdist", settings=""), folder, cwd=source).split()[-1]
    with tarfile.open(folder / name) as archive:
        archive.extractall(folder)
    return folder / name.removesuffix(".tar.gz")


def test_sdist_has_the_sources_and_no_more(source, sdist):
    assert sdist.name == f"muslin-{muslin.__version__}"
    packed = {path.relative_to(sdist).as_posix() for path in sdist.rglob("*") if path.is_file()}
    parts = ("CMakeLists.txt", "LICENSE", "README.md", "pyproject.toml", "cmake", "src", "materials", "viewer/dist", "python")
    tracked = run("git", "ls-files", *parts, cwd=source)
    assert packed - {"PKG-INFO"} == {name for name in tracked.split("\n") if name}


def test_wheel_installs_and_runs(source, sdist, tmp_path):
    build = os.environ["MUSLIN_BUILD"]
    settings = f"'cmake.source-dir': 'python', 'cmake.define.MUSLIN_BUILD': '{build}', 'cmake.build-type': 'Debug'"
    script = FROM_HERE.format(kind="wheel", settings=settings)
    name = run(sys.executable, "-c", script, tmp_path, cwd=sdist).split()[-1]
    abi = "cp312-abi3" if sys.version_info >= (3, 12) else f"cp3{sys.version_info.minor}-cp3{sys.version_info.minor}"
    assert name.startswith(f"muslin-{muslin.__version__}-{abi}-linux")
    with zipfile.ZipFile(tmp_path / name) as wheel:
        names = set(wheel.namelist())
        metadata = wheel.read(f"muslin-{muslin.__version__}.dist-info/METADATA").decode()
    package = source / "python/muslin"
    here = {path.relative_to(package).as_posix() for path in package.rglob("*") if path.suffix in (".py", ".html")}
    here |= {"_muslin.pyi", "py.typed"}
    module = {n for n in names if n.startswith("muslin/") and n.endswith(".so")}
    assert len(module) == 1
    assert {n for n in names if ".dist-info/" not in n} == {f"muslin/{n}" for n in here} | module
    assert "Requires-Dist: numpy" in metadata and "usd-core" in metadata

    site = tmp_path / "site"
    run(sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", site, tmp_path / name, cwd=tmp_path)
    check = (
        "import muslin, sys; assert muslin.__file__.startswith(sys.argv[1]); "
        "simulation = muslin.Simulation(muslin.read_scene(sys.argv[2])); simulation.advance(); "
        "print(muslin.__version__, simulation.frame, muslin.find_material('cotton').name)"
    )
    scene = source / "scenes/thesis/2_two_corners.toml"
    printed = run(sys.executable, "-c", check, site, scene, cwd=tmp_path, PYTHONPATH=str(site))
    assert printed.split() == [muslin.__version__, "1", "cotton"]
