"""Fixtures that the tests of the module share: places, a small flag, a shell."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import muslin
import numpy as np
import pytest

SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def source() -> Path:
    """The root of the repository."""
    return SOURCE


@pytest.fixture(scope="session")
def program() -> str:
    """The command-line program of the same build."""
    return os.environ["MUSLIN_PROGRAM"]


def grid_mesh(width: float, height: float, columns: int, rows: int, name: str = "flag") -> muslin.Mesh:
    """A flat sheet of quads in the plane z = 0, its lower left corner at the origin, with a group "top"."""
    x, y = np.meshgrid(np.linspace(0, width, columns + 1), np.linspace(0, height, rows + 1))
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    faces = np.stack([first, first + 1, first + columns + 2, first + columns + 1], axis=1)
    top = np.flatnonzero(positions[:, 1] == height)
    uvs = positions[:, :2] / [width, height]
    return muslin.Mesh(positions, faces, uvs=uvs, groups={"top": top}, name=name)


def flag_tables(**changes: Any) -> dict[str, Any]:
    """The thesis's flag of 10 x 6 m, held at its upper corners, two seconds."""
    tables: dict[str, Any] = {
        "title": "flag",
        "time": {"duration": 2, "frame_rate": 24, "steps_per_frame": 4},
        "body": [
            {
                "name": "flag",
                "mesh": grid_mesh(10, 6, 10, 6),
                "thickness": 1.0,
                "voxel_width": 1.0,
                "mass": "cells",
                "material": "thesis_flag",
            }
        ],
        "pin": [{"name": "corners", "where": {"nearest": [[0, 6, 0], [10, 6, 0]]}}],
        "force": [{"type": "gravity"}],
        "probe": [{"name": "tip", "at": [5, 0, 0]}],
    }
    return tables | changes


def shell_tables(**changes: Any) -> dict[str, Any]:
    """A piece of cloth of 1 x 1 m, as a shell."""
    tables: dict[str, Any] = {
        "title": "cloth",
        "time": {"duration": 1, "frame_rate": 24, "steps_per_frame": 4},
        "body": [{"name": "cloth", "mesh": grid_mesh(1, 1, 6, 6, "cloth"), "model": "shell", "material": "cotton"}],
        "pin": [{"where": {"group": "top"}}],
        "force": [{"type": "gravity"}],
    }
    return tables | changes


@pytest.fixture
def flag() -> Callable[..., muslin.Simulation]:
    """Makes a simulation of the flag, with other tables of the scene where given."""
    return lambda **changes: muslin.Simulation(muslin.make_scene(flag_tables(**changes)))


@pytest.fixture
def dust() -> Callable[..., muslin.Simulation]:
    """Makes a simulation of a free flag without gravity, pins or stiffness: each vertex obeys m a = F alone."""

    def make(**changes: Any) -> muslin.Simulation:
        tables = flag_tables(pin=None, force=None, **changes)
        tables["body"][0]["material"] = {"density": 10.0, "edge_modulus": 0.0}
        return muslin.Simulation(muslin.make_scene(tables))

    return make
