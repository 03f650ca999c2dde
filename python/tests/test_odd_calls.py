"""Odd arguments to everything: a clear exception or a result, never a crash, and never an error from inside."""

import functools
import random
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import flag_tables, grid_mesh

import muslin
import muslin._muslin

CLEAR = (muslin.Error, TypeError, MemoryError, OverflowError)


def odd_values() -> list[Any]:
    return [
        None,
        True,
        0,
        -1,
        3,
        2**31,
        2**70,
        0.5,
        -0.0,
        float("nan"),
        float("inf"),
        "",
        "cover",
        "nothing\0here",
        "flag",
        "out/flag.obj",
        b"",
        b"MUSLINCP" + bytes(200),
        [],
        [0, 1, 2],
        [[0, 1, 2]],
        [[0.0, 1.0, 2.0], [1.0, 0.0, 0.0]],
        [[0], [0, 1]],
        {},
        {"flag": [0]},
        {"title": 3},
        np.zeros((0, 3)),
        np.zeros((154, 3)),
        np.full((154, 3), np.nan),
        np.zeros((154, 3), dtype=np.float32)[::-1],
        np.zeros((2, 3, 4)),
        np.array(5.0),
        np.array(["a", "b"]),
        np.array([None, object()]),
        np.ma.masked_array(np.ones((154, 3)), mask=True),
        lambda *arguments: None,
        lambda *arguments: "odd",
        object(),
        Path("out"),
    ]


@pytest.fixture
def good_values(tmp_path, monkeypatch) -> list[Any]:
    """One of everything, and a folder in which odd names do no harm."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").mkdir()
    mesh = grid_mesh(2, 1, 4, 2)
    solid = muslin.thicken(mesh, 0.5)
    distance = muslin.SignedDistance(solid)
    lattice = muslin.build_lattice(solid, distance, 0.5)
    scene = muslin.make_scene(flag_tables(time={"duration": 0.1, "steps_per_frame": 1}))
    muslin.run(scene, tmp_path / "run")
    simulation = muslin.Simulation(scene)
    return [
        mesh,
        solid,
        distance,
        lattice,
        muslin.build_springs(lattice),
        muslin.embed(lattice, mesh.positions),
        muslin.build_contour(lattice, solid, distance, "squares"),
        muslin.build_shell(mesh),
        muslin.sample_field(distance, [0, 0, 0], 0.5, (3, 3, 3)),
        muslin.find_material("cotton"),
        scene,
        simulation.model,
        simulation,
        simulation.diagnostics,
        muslin.Run(tmp_path / "run"),
        muslin.RunPictures(tmp_path / "run", size=(32, 32), samples=1),
    ]


def callables(values: list[Any]) -> Iterator[tuple[str, Callable[..., Any]]]:
    """Functions and constructors of the module, methods and setters of the values."""
    for name in muslin.__all__:
        thing = getattr(muslin, name)
        if callable(thing) and not (isinstance(thing, type) and issubclass(thing, Exception)):
            yield name, thing
    for value in values:
        kind = type(value)
        for name in dir(kind):
            member = getattr(kind, name)
            if callable(member) and (not name.startswith("__") or name in ("__call__", "__len__")):
                yield f"{kind.__name__}.{name}", getattr(value, name)
    simulation = next(value for value in values if isinstance(value, muslin.Simulation))
    for name in ("positions", "velocities"):
        yield f"Simulation.{name} =", functools.partial(setattr, simulation, name)


def test_odd_arguments(good_values):
    random_numbers = random.Random(7)
    # Runs, movies and thread counts are tried elsewhere; here they would only take time.
    slow = {"run", "RunPictures", "RunPictures.write", "RunPictures.draw", "set_thread_count", "RunWriter"}
    tried = refused = 0
    for name, function in list(callables(good_values)):
        if name in slow:
            continue
        for _ in range(150):
            pool = odd_values() + good_values
            count = random_numbers.randint(0, 4)
            given = [random_numbers.choice(pool) for _ in range(count)]
            tried += 1
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                try:
                    function(*given)
                except CLEAR as error:
                    refused += 1
                    assert "std::" not in str(error).split("Invoked with")[0], (name, given, error)
    assert tried > 5000
    assert refused > tried / 2
    simulation = next(value for value in good_values if isinstance(value, muslin.Simulation))
    assert np.isfinite(simulation.positions).all()
