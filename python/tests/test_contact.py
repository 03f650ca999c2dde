"""Contact from Python: colliders, crossings found and refused, what may be put where."""

import json

import numpy as np
import pytest
from conftest import grid_mesh

import muslin


def drop_tables(height: float = 0.32) -> dict:
    """A piece of cloth of 0.6 m over a ball of 0.3 m on a floor."""
    flat = grid_mesh(0.6, 0.6, 12, 12, "cloth")
    lying = muslin.Mesh(flat.positions[:, [0, 2, 1]] - [0.3, 0, 0.3], flat.faces, name="cloth")
    return {
        "title": "drop",
        "time": {"duration": 0.5, "frame_rate": 24, "steps_per_frame": 5},
        "body": [
            {
                "name": "cloth",
                "mesh": lying,
                "model": "shell",
                "warp": [1, 0, 0],
                "material": "cotton",
                "translate": [0, height, 0],
            }
        ],
        "collider": [
            {"name": "ball", "shape": "sphere", "center": [0, 0, 0], "radius": 0.3},
            {"name": "floor", "shape": "plane", "center": [0, -0.4, 0]},
        ],
        "contact": {"friction": 0.3, "distance": 0.004},
        "force": [{"type": "gravity"}],
    }


@pytest.fixture(scope="module")
def draped():
    """The simulation, half a second later: the cloth lies on the ball."""
    simulation = muslin.Simulation(muslin.make_scene(drop_tables()))
    for _ in simulation:
        pass
    return simulation


def test_cloth_lies_on_the_ball(draped):
    model = draped.model
    cloth, ball = model.body("cloth"), model.body("ball")
    assert not cloth.is_collider and ball.is_collider and ball.prescribed
    assert (model.masses[ball.vertices] == 0).all() and (model.masses[cloth.vertices] > 0).all()
    distance = np.linalg.norm(draped.positions[cloth.vertices], axis=1)
    assert distance.min() >= 0.3
    assert distance.min() < 0.31
    assert model.crossings(draped.positions) == []
    assert 0 < draped.diagnostics.min_distance < 0.004
    assert np.array_equal(draped.points(), draped.positions[cloth.vertices])  # the only body that is no collider
    costs = draped.costs()
    assert costs["search"] > 0 and costs["limit"] > 0 and costs["contact"] > 0


def test_positions_that_cross_are_refused(draped):
    before = draped.checkpoint()
    with pytest.raises(muslin.InputError, match="ball"):
        draped.positions = draped.positions - [0, 0.1, 0]
    assert draped.checkpoint() == before
    crossings = draped.model.crossings(draped.positions - [0, 0.1, 0] * (draped.model.masses > 0)[:, None])
    assert crossings and all("cloth" in sentence for sentence in crossings)


def test_what_moves_as_it_is_told_stays(draped):
    again = muslin.Simulation(draped.model)
    again.restore(draped.checkpoint())
    again.positions = again.positions + [0, 1, 0]
    again.velocities = again.velocities + [0, 1, 0]
    ball, cloth = (draped.model.body(name).vertices for name in ("ball", "cloth"))
    assert np.array_equal(again.positions[ball], draped.positions[ball])
    assert np.array_equal(again.velocities[ball], draped.velocities[ball])
    assert np.allclose(again.positions[cloth], draped.positions[cloth] + [0, 1, 0])
    assert again.model.crossings(again.positions) == []


def test_a_start_that_crosses_is_listed_and_repaired_or_refused():
    model = muslin.build_model(muslin.make_scene(drop_tables(height=0.2)))
    assert model.crossings()
    repaired = muslin.Simulation(model)
    assert model.crossings(repaired.positions) == []
    strict = muslin.make_scene({**drop_tables(height=0.2), "contact": {"tangled": "refuse"}})
    with pytest.raises(muslin.InputError, match="cross"):
        muslin.Simulation(strict)
    tangled = muslin.Simulation(model, allow_tangled=True)
    tangled.advance()
    assert tangled.frame == 1


def test_a_run_may_start_tangled_and_remembers_it(tmp_path):
    scene = muslin.make_scene(drop_tables(height=0.2))
    muslin.run(scene, tmp_path / "repaired", frames=1)
    assert json.loads((tmp_path / "repaired/run.json").read_text())["tangled_start"]["left"] == 0
    muslin.run(scene, tmp_path / "run", frames=1, allow_tangled=True)
    assert json.loads((tmp_path / "run/run.json").read_text())["allow_tangled"] is True
    assert muslin.Run(tmp_path / "run").diagnostics["min_distance"][0] < 0
    muslin.run(scene, tmp_path / "run", frames=2, resume=True)
    assert muslin.Run(tmp_path / "run").frame_count == 3


def test_a_collider_may_be_a_mesh_in_memory(tmp_path):
    tables = drop_tables()
    table = muslin.thicken(grid_mesh(1, 1, 2, 2, "table"), 0.2)
    tables["collider"] = [{"name": "table", "shape": "mesh", "mesh": table, "rotate": [90, 0, 0], "translate": [-0.5, 0, -0.5]}]
    muslin.run(muslin.make_scene(tables), tmp_path / "run", frames=2)
    run = muslin.Run(tmp_path / "run")
    assert run.bodies == ["cloth", "table"]
    assert run.is_collider("table") and not run.has_lattice("table")
    assert run.points(0).shape == (169, 3)
    assert np.allclose(run.points(0, "table")[:, 1].max(), 0.1, atol=1e-6)


def test_friction_may_change_over_time():
    falls = {"keyframes": [{"time": 0, "value": 0.5}, {"time": 1, "value": 0.1, "interpolation": "step"}]}
    tables = drop_tables()
    tables["contact"]["friction"] = falls
    tables["body"][0]["friction"] = falls
    tables["collider"][0]["friction"] = falls
    tables["contact"]["pair"] = [{"between": ["cloth", "floor"], "friction": falls}]
    resolved = muslin.make_scene(tables).resolved
    for owner in (resolved["contact"], resolved["body"][0], resolved["collider"][0], resolved["contact"]["pair"][0]):
        assert [key["value"] for key in owner["friction"]["keyframes"]] == [0.5, 0.1]
    tables["contact"]["friction"] = {"keyframes": [{"time": 0, "value": -1}]}
    with pytest.raises(muslin.InputError, match="`friction` is -1 at 0 s"):
        muslin.make_scene(tables)
