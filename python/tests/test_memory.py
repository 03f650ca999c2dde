"""Views of the engine's memory: no copies, read-only, alive as long as the last of them."""

import gc
import sys

import numpy as np
import pytest
from conftest import flag_tables, grid_mesh

import muslin


def address(array: np.ndarray) -> int:
    return array.__array_interface__["data"][0]


def views_of(model: muslin.Model) -> dict[str, np.ndarray]:
    body = model.bodies[0]
    return {
        "rest_positions": model.rest_positions,
        "masses": model.masses,
        "mesh.positions": body.mesh.positions,
        "mesh.face_vertices": body.mesh.face_vertices,
        "mesh.uvs": body.mesh.uvs,
        "mesh.groups": body.mesh.groups["top"],
        "lattice.voxels": body.lattice.voxels,
        "lattice.vertices": body.lattice.vertices,
        "lattice.voxel_vertices": body.lattice.voxel_vertices,
        "lattice.fill": body.lattice.fill,
        "springs.share": body.springs.share,
        "skin.vertices": body.skin.vertices,
        "skin.weights": body.skin.weights,
        "contour.positions": body.contour.mesh.positions,
        "pin.vertices": model.pins[0].vertices,
    }


def test_views_share_memory_and_are_read_only():
    model = muslin.build_model(muslin.make_scene(flag_tables()))
    first, second = views_of(model), views_of(model)
    for name, array in first.items():
        assert address(array) == address(second[name]), name
        assert not array.flags.owndata, name
        assert not array.flags.writeable, name
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
        with pytest.raises(ValueError):
            array.setflags(write=True)
    assert model.bodies[0] is model.bodies[0]


def test_views_outlive_everything_they_came_from():
    model = muslin.build_model(muslin.make_scene(flag_tables()))
    views = views_of(model)
    copies = {name: array.copy() for name, array in views.items()}
    simulation = muslin.Simulation(model)
    state = simulation.positions
    copy = state.copy()
    del model, simulation
    gc.collect()
    scratch = [np.full(1000, 7.0) for _ in range(1000)]  # whatever was freed is written over
    for name, array in views.items():
        assert np.array_equal(array, copies[name]), name
    assert np.array_equal(state, copy)
    assert len(scratch) == 1000


def test_parts_keep_the_whole_alive_and_release_it():
    model = muslin.build_model(muslin.make_scene(flag_tables()))
    count = sys.getrefcount(model)
    view = model.bodies[0].mesh.positions
    assert sys.getrefcount(model) > count
    del view
    gc.collect()
    assert sys.getrefcount(model) == count


def test_a_simulation_keeps_its_model(flag):
    model = muslin.build_model(muslin.make_scene(flag_tables()))
    simulation = muslin.Simulation(model)
    assert simulation.model is model
    del model
    gc.collect()
    assert simulation.model.vertex_count == 154


def test_meshes_made_from_arrays_do_not_follow_them():
    positions = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    mesh = muslin.Mesh(positions, [[0, 1, 2]])
    positions[:] = 9
    assert mesh.positions[1, 0] == 1


def test_a_run_of_views_does_not_grow():
    """Reading and stepping over and over holds the same memory."""
    simulation = muslin.Simulation(muslin.make_scene(flag_tables()))
    mesh = grid_mesh(10, 6, 100, 60)

    def resident() -> int:
        with open("/proc/self/statm") as statm:
            return int(statm.read().split()[1]) * 4096

    def work() -> None:
        for _ in range(200):
            simulation.positions = simulation.positions + 0.0
            simulation.points()
            simulation.checkpoint()
            mesh.moved(mesh.positions + 1.0).triangles()

    work()
    gc.collect()
    before = resident()
    work()
    gc.collect()
    assert resident() - before < 20e6  # 200 meshes alone would be 60 MB
