"""The JSON Schema that the program prints accepts what the program accepts, and refuses mistakes."""

import copy
import json
import os
import re
import subprocess
import tomllib
from pathlib import Path

import jsonschema
import muslin
import pytest

ROOT = Path(__file__).resolve().parents[2]


def printed(*arguments):
    program = os.environ["MUSLIN_PROGRAM"]
    return subprocess.run([program, "schema", *arguments], check=True, capture_output=True, text=True).stdout


@pytest.fixture(scope="module")
def validator():
    schema = json.loads(printed())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def examples_of_the_guide():
    page = (ROOT / "docs/guide/scene-file.md").read_text()
    blocks = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    return [tomllib.loads(block) for block in blocks if "[lattice]" not in block]


def test_every_scene_is_valid(validator):
    scenes = [tomllib.loads(file.read_text()) for file in sorted(ROOT.glob("scenes/**/*.toml"))]
    assert len(scenes) > 10
    for scene in scenes + examples_of_the_guide():
        assert [error.message for error in validator.iter_errors(scene)] == []


SOUND = {
    "time": {"duration": 2, "steps_per_frame": "auto"},
    "body": [
        {"name": "a", "mesh": "a.obj", "voxel_width": 0.1, "material": "rubber", "scale": [1, 2, 3]},
        {"mesh": "b.obj", "model": "shell", "material": {"base": "cotton", "poisson": 0.1}, "stretch_limit": 1.05},
        {"name": "c", "mesh": "b.obj", "model": "shell", "material": {"base": "cotton", "warp_curve": [[0, 0], [0.1, 9]]}},
        {"name": "d", "mesh": "b.obj", "model": "shell", "material": {"base": "cotton", "weft_curve": [[0.01 * i, i] for i in range(11)]}},
    ],
    "collider": [{"shape": "sphere", "radius": 1, "density": 2}],
    "pin": [{"body": "a", "where": {"nearest": [0, 0, 0]}, "keyframes": [{"time": 0}, {"time": 1}]}],
    "force": [{"type": "gravity"}, {"type": "wind", "velocity": [1, 0, 0]}],
}

ELEVEN = [[0.01 * i, i] for i in range(1, 12)]

MISTAKES = [
    ("time", {"duraton": 2}),
    ("time", {"duration": -1}),
    ("time", {"steps_per_frame": "many"}),
    ("time", {"steps_per_frame": 0}),
    ("time", {"steps_per_frame": 1.5}),
    ("solver", {"integrator": "euler"}),
    ("body", [{"mesh": "a.obj", "material": "rubber"}]),
    ("body", [{"mesh": "a.obj", "voxel_width": 1, "material": "rubber", "warp": [1, 0, 0]}]),
    ("body", [{"mesh": "a.obj", "model": "shell", "material": "cotton", "voxel_width": 1}]),
    ("body", [{"mesh": "a.obj", "model": "shell", "material": "cotton", "stretch_limit": 1}]),
    ("body", [{"mesh": "a.obj", "model": "shell", "material": {"bending_warp": 1}}]),
    ("body", [{"mesh": "a.obj", "model": "shell", "material": {"base": "cotton", "warp_curve": [[0.1, 9, 1]]}}]),
    ("body", [{"mesh": "a.obj", "model": "shell", "material": {"base": "cotton", "warp_curve": [[-0.1, 9]]}}]),
    ("body", [{"mesh": "a.obj", "model": "shell", "material": {"base": "cotton", "warp_curve": [[11, 9]]}}]),
    ("body", [{"mesh": "a.obj", "model": "shell", "material": {"base": "cotton", "shear_curve": [[81, 9]]}}]),
    ("body", [{"mesh": "a.obj", "model": "shell", "material": {"base": "cotton", "weft_curve": ELEVEN}}]),
    ("body", [{"mesh": "a.obj", "voxel_width": 1, "material": {"density": 1}}]),
    ("body", [{"mesh": "a.obj", "voxel_width": 1, "material": {"base": "rubber", "shear_modulus": 1}}]),
    ("body", [{"mesh": "", "voxel_width": 1, "material": "rubber"}]),
    ("collider", [{"radius": 1}]),
    ("collider", [{"shape": "plane", "radius": 1}]),
    ("collider", [{"shape": "sphere"}]),
    ("collider", [{"shape": "sphere", "radius": 1, "velocity": [1, 0, 0]}]),
    ("collider", [{"shape": "sphere", "radius": 1, "density": 1, "keyframes": [{"time": 0}]}]),
    ("collider", [{"shape": "capsule", "radius": 1, "points": [[0, 0, 0]]}]),
    ("collider", [{"shape": "sphere", "radius": 1, "colour": [2, 0, 0]}]),
    ("contact", {"mode": "fast"}),
    ("pin", [{"body": "a", "where": {"neerest": [0, 0, 0]}}]),
    ("pin", [{"body": "a", "where": {"sphere": {"center": [0, 0, 0]}}}]),
    ("force", [{"type": "gravity", "drag": 1}]),
    ("force", [{"type": "wind"}]),
    ("force", [{"type": "wind", "velocity": [1, 0, 0], "keyframes": [{"time": 0, "value": [0, 0, 0]}]}]),
    ("probe", [{"at": [0, 0]}]),
    ("bodi", []),
]


@pytest.mark.parametrize(("table", "value"), MISTAKES, ids=str)
def test_mistakes_are_refused_by_schema_and_program(validator, table, value):
    assert list(validator.iter_errors(SOUND)) == []
    muslin.make_scene(SOUND)
    scene = copy.deepcopy(SOUND)
    scene[table] = value
    assert not validator.is_valid(scene)
    if table == "body":  # otherwise pins do not know theirs
        scene["pin"] = []
    with pytest.raises(muslin.InputError):
        muslin.make_scene(scene)


def test_types_are_those_that_the_program_prints():
    module = ROOT / "python/muslin/scene_types.py"
    assert module.read_text() == printed("--python"), "run tools/write_schema"
