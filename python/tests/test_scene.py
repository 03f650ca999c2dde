"""Scenes from files, texts and tables: the same checks, and messages with places."""

import numpy as np
import pytest
from conftest import flag_tables, grid_mesh

import muslin


def test_steps_are_automatic_unless_a_number_is_given():
    scene = muslin.make_scene(flag_tables(time={"duration": 1}))
    assert (scene.steps_per_frame, scene.effort, scene.tolerance) == (None, "normal", 0.2)
    assert scene.resolved["time"]["steps_per_frame"] == "auto"
    for steps, expected in (("auto", None), (7, 7)):
        scene = muslin.make_scene(flag_tables(time={"steps_per_frame": steps}, solver={"effort": "exact"}))
        assert (scene.steps_per_frame, scene.effort, scene.tolerance) == (expected, "exact", 1e-3)
    with pytest.raises(muslin.InputError, match='"auto" or a whole number'):
        muslin.make_scene(flag_tables(time={"steps_per_frame": "many"}))


def test_reads_a_scene_of_the_repository(source):
    scene = muslin.read_scene(source / "scenes/thesis/2_two_corners.toml", ["time.duration=1", "body.flag.voxel_width=2"])
    assert scene.title.startswith("Thesis experiment 2")
    assert scene.file.name == "2_two_corners.toml"
    assert (scene.duration, scene.frame_rate, scene.steps_per_frame, scene.frames) == (1, 24, 10, 24)
    assert scene.time_step == pytest.approx(1 / 240)
    assert scene.resolved["body"][0]["voxel_width"] == 2
    assert scene.text == scene.file.read_text()
    assert scene.warnings == []
    assert "24 frames" in repr(scene)


def test_errors_name_place_and_remedy(source, tmp_path):
    text = "[time]\nduration = 2\n\n[[body]]\nmesh = 'a.obj'\nvoxel_widht = 1\n"
    with pytest.raises(muslin.InputError) as caught:
        muslin.parse_scene(text, "flag.toml")
    error = caught.value
    assert (error.file, error.line, error.column) == ("flag.toml", 6, 1)
    assert "voxel_widht" in error.problem and "voxel_width" in error.remedy
    assert str(error) == f"flag.toml:6:1: {error.problem}; {error.remedy}"
    assert error.exit_code == 3
    assert isinstance(error, muslin.Error) and isinstance(error, ValueError)
    with pytest.raises(muslin.FileError) as missing:
        muslin.read_scene(tmp_path / "none.toml")
    assert missing.value.exit_code == 5
    with pytest.raises(muslin.Error):
        muslin.read_scene(source / "scenes/thesis/2_two_corners.toml", ["nonsense"])
    with pytest.raises(TypeError):
        muslin.read_scene(3)


def test_tables_make_the_scene_that_their_text_makes():
    scene = muslin.make_scene(flag_tables(), overrides=["time.duration=3"])
    assert scene.duration == 3
    assert scene.resolved["pin"][0]["where"]["nearest"] == [[0, 6, 0], [10, 6, 0]]
    assert scene.title == "flag"
    with pytest.raises(muslin.InputError, match=r"^make_scene: force\[0\]\.type: .*did you mean `gravity`"):
        muslin.make_scene(flag_tables(force=[{"type": "gravty"}]))
    with pytest.raises(muslin.InputError, match=r"^make_scene: time\.frame_rate: "):
        muslin.make_scene(flag_tables(time={"duration": 1, "frame_rate": -24}))
    with pytest.raises(muslin.InputError, match=r"^make_scene: body\[1\]\.voxel_widht: "):
        muslin.make_scene(flag_tables(body=[flag_tables()["body"][0], {"name": "b", "mesh": "b.obj", "voxel_widht": 1}]))
    with pytest.raises(muslin.InputError, match=r"^make_scene: titel: .*title"):
        muslin.make_scene(titel="flag")
    with pytest.raises(muslin.InputError, match="bodi"):
        muslin.make_scene(bodi=[{}])


def test_toml_of_every_kind_of_value():
    import tomllib

    tables = {
        "title": 'quotes " \\ new\nline \x7f é 🧵',
        "time": {"duration": np.float32(0.5), "frame_rate": 24, "steps_per_frame": np.int64(3)},
        "on": True,
        "empty": [],
        "odd key": 1,
        "none": None,
        "body": [{"at": np.array([1.0, 2.0, 3e-30]), "where": {"line": {"from": (0, 1, 2)}}, "x": None}, {"y": 1e300}],
    }
    assert tomllib.loads(muslin.to_toml(tables)) == {
        "title": tables["title"],
        "time": {"duration": 0.5, "frame_rate": 24, "steps_per_frame": 3},
        "on": True,
        "empty": [],
        "odd key": 1,
        "body": [{"at": [1.0, 2.0, 3e-30], "where": {"line": {"from": [0, 1, 2]}}}, {"y": 1e300}],
    }
    with pytest.raises(muslin.UsageError, match=r"`body\.mesh` is a object"):
        muslin.to_toml({"body": [{"mesh": object()}]})
    with pytest.raises(muslin.UsageError, match="not a text"):
        muslin.to_toml({3: 1})


def test_meshes_in_memory_are_what_files_would_be(tmp_path):
    mesh = grid_mesh(10, 6, 10, 6)
    muslin.write_mesh(tmp_path / "flag.obj", mesh)
    tables = flag_tables()
    tables["body"][0]["mesh"] = "flag.obj"
    from_file = muslin.Simulation(muslin.make_scene(tables, folder=tmp_path))
    in_memory = muslin.Simulation(muslin.make_scene(flag_tables()))
    for simulation in (from_file, in_memory):
        for _ in range(3):
            simulation.advance()
    assert from_file.checkpoint() == in_memory.checkpoint()


def test_two_bodies_of_one_mesh():
    tables = flag_tables(pin=None, probe=None)
    tables["body"] = [tables["body"][0], tables["body"][0] | {"name": "other", "translate": [0, 0, 5]}]
    model = muslin.build_model(muslin.make_scene(tables))
    assert [body.name for body in model.bodies] == ["flag", "other"]
    first, second = (model.rest_positions[body.vertices] for body in model.bodies)
    assert np.allclose(second - first, [0, 0, 5])


def test_building_reports_and_can_be_stopped():
    scene = muslin.make_scene(flag_tables())
    stages = []
    muslin.build_model(scene, progress=lambda fraction, stage: stages.append(stage))
    assert {"mesh", "distance field", "voxels", "springs", "contour"} <= set(stages)
    with pytest.raises(muslin.Interrupted):
        muslin.build_model(scene, cancel=lambda: True)
    with pytest.raises(ZeroDivisionError):
        muslin.build_model(scene, progress=lambda fraction, stage: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        muslin.build_model(scene, cancel=lambda: 1 / 0)
