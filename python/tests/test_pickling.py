"""Copies and pickles are what they were made of, to the bit."""

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import flag_tables, grid_mesh, shell_tables

import muslin


def pickled(thing: Any) -> Any:
    return pickle.loads(pickle.dumps(thing))


WAYS = pytest.mark.parametrize("way", [copy.copy, copy.deepcopy, pickled])
Way = Callable[[Any], Any]


@WAYS
def test_meshes(way: Way) -> None:
    mesh = muslin.Mesh(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 1e-17]],
        [[0, 1, 2, 3], [1, 4, 2]],
        uvs=[[0, 0], [1, 0], [0, 1]],
        corner_uvs=[0, 1, 2, -1, 0, 1, 2],
        groups={"top": [2, 3]},
        face_groups={"side": [1]},
        materials={"Blue Cotton": [0]},
        name="flag",
    )
    other = way(mesh)
    for name in ("positions", "face_vertices", "face_offsets", "uvs", "corner_uvs"):
        np.testing.assert_array_equal(getattr(other, name), getattr(mesh, name))
    for part in ("groups", "face_groups", "materials"):
        groups, others = getattr(mesh, part), getattr(other, part)
        assert {name: list(found) for name, found in groups.items()} == {n: list(f) for n, f in others.items()}
    assert other.name == "flag"
    assert len(way(grid_mesh(1, 1, 3, 3)).uvs) == 16


@WAYS
@pytest.mark.parametrize("name", muslin.material_names())
def test_materials(way: Way, name: str) -> None:
    material = muslin.find_material(name)
    other = way(material)
    for part in ("name", "description", "source", "guesses", "lattice", "shell", "curves", "reference"):
        assert getattr(other, part) == getattr(material, part), part


@WAYS
def test_scenes_with_their_overrides_and_meshes(way: Way) -> None:
    scene = muslin.make_scene(flag_tables(), overrides=["time.duration=0.25"])
    other = way(scene)
    assert other.resolved == scene.resolved
    assert other.overrides == ["time.duration=0.25"]
    assert other.duration == 0.25
    np.testing.assert_array_equal(muslin.Simulation(other).positions, muslin.Simulation(scene).positions)


@WAYS
def test_simulations_go_on_with_the_same_bits(way: Way) -> None:
    simulation = muslin.Simulation(muslin.make_scene(flag_tables()))
    simulation.advance()
    simulation.step()
    other = way(simulation)
    assert other.frame == 1
    np.testing.assert_array_equal(other.positions, simulation.positions)
    simulation.advance()
    assert other.frame == 1
    other.advance()
    np.testing.assert_array_equal(other.positions, simulation.positions)
    np.testing.assert_array_equal(other.velocities, simulation.velocities)


def test_a_cut_simulation_is_copied_but_not_pickled() -> None:
    simulation = muslin.Simulation(muslin.make_scene(shell_tables()))
    simulation.cut([(3, 10), (10, 17)])  # from the lower border upwards
    simulation.advance()
    other = copy.deepcopy(simulation)
    np.testing.assert_array_equal(other.positions, simulation.positions)
    with pytest.raises(muslin.UsageError, match="cut cannot be pickled"):
        pickle.dumps(simulation)


@WAYS
def test_diagnostics(way: Way) -> None:
    simulation = muslin.Simulation(muslin.make_scene(flag_tables()))
    simulation.advance()
    row = simulation.diagnostics
    other = way(row)
    for name in (n for n in dir(row) if not n.startswith("_")):
        np.testing.assert_array_equal(getattr(other, name), getattr(row, name))


def test_results_of_runs_are_told(tmp_path: Path) -> None:
    result = muslin.run(muslin.make_scene(flag_tables()), tmp_path / "run", frames=1)
    assert repr(result).startswith("<muslin.RunResult frames 0 to 1")
