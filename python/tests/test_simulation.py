"""Simulations: stepped, iterated, read, changed, saved and resumed."""

import subprocess

import numpy as np
import pytest
from conftest import flag_tables, shell_tables

import muslin


def test_iterates_to_the_last_frame(flag):
    simulation = flag(time={"duration": 0.25, "frame_rate": 24, "steps_per_frame": 2})
    assert [frame for frame in simulation] == [1, 2, 3, 4, 5, 6]
    assert simulation.frame == 6
    assert simulation.time == 0.25
    assert list(simulation) == []
    assert "frame 6 of 6" in repr(simulation)
    simulation.advance()  # beyond the scene's end, if asked
    assert simulation.frame == 7


def test_steps_make_a_frame(flag):
    by_steps, by_frames = flag(), flag()
    for count in (1, 2, 3):
        by_steps.step()
        assert (by_steps.frame, by_steps.steps_done) == (0, count)
    by_steps.step()
    assert (by_steps.frame, by_steps.steps_done) == (1, 0)
    by_frames.advance()
    assert by_steps.checkpoint() == by_frames.checkpoint()


def test_reaches_the_bits_of_the_program(source, program, tmp_path):
    scene = source / "scenes/thesis/2_two_corners.toml"
    subprocess.run([program, "run", scene, "-o", tmp_path / "run", "--frames", "5", "--quiet"], check=True)
    run = muslin.Run(tmp_path / "run")
    simulation = muslin.Simulation(muslin.read_scene(scene))
    for frame in range(6):
        if frame > 0:
            simulation.advance()
        for surface in ("skin", "contour"):
            points = simulation.points(surface=surface).astype(np.float32)
            assert np.array_equal(points, run.points(frame, surface=surface))
        assert np.array_equal(simulation.positions.astype(np.float32), run.lattice_points(frame))
    mine, theirs = simulation.history(), run.diagnostics
    assert mine.keys() == theirs.keys()
    for column in mine.keys() - {"wall_ms"}:
        assert np.array_equal(mine[column], theirs[column]), column


def test_state_is_a_snapshot(flag):
    simulation = flag()
    before = simulation.positions
    kept = before.copy()
    assert before.shape == (154, 3) and before.dtype == np.float64
    assert simulation.positions is before
    assert not before.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        before[0] = 0
    simulation.advance()
    assert np.array_equal(before, kept)
    assert not np.array_equal(simulation.positions, kept)
    assert np.abs(simulation.velocities).max() > 0


def test_setting_positions_moves_the_flag_and_its_pins(flag):
    simulation = flag()
    simulation.positions = simulation.positions + [0, 100, 0]
    for _ in range(3):
        simulation.advance()
    held = simulation.model.pins[0].vertices
    assert np.array_equal(simulation.positions[held], simulation.model.rest_positions[held] + [0, 100, 0])
    other = flag()
    for _ in range(3):
        other.advance()
    assert np.allclose(simulation.positions - [0, 100, 0], other.positions, atol=1e-3)


def test_setting_velocities(dust):
    simulation = dust()
    simulation.velocities = np.broadcast_to([1.0, 2.0, 3.0], (154, 3))
    assert np.array_equal(simulation.velocities[7], [1, 2, 3])
    assert simulation.diagnostics.kinetic == pytest.approx(0.5 * 600 * 14)
    assert simulation.history()["kinetic"][0] == simulation.diagnostics.kinetic
    simulation.advance()
    assert np.allclose(simulation.positions - simulation.model.rest_positions, np.array([1, 2, 3]) / 24)


@pytest.mark.parametrize("quantity", ["positions", "velocities"])
@pytest.mark.parametrize(
    ("value", "message"),
    [
        (np.zeros((153, 3)), "153 rows"),
        (np.zeros((154, 2)), "shape"),
        (np.zeros(462), "shape"),
        (np.full((154, 3), np.nan), r"\[0, 0\] is nan"),
        (np.full((154, 3), np.inf), r"\[0, 0\] is inf"),
        (np.zeros((154, 3), dtype=complex), "complex128"),
        ("words", "str|U5"),
        ([[1, 2], [3]], "no array"),
    ],
)
def test_refuses_other_states_and_keeps_its_own(flag, quantity, value, message):
    simulation = flag()
    before = simulation.checkpoint()
    with pytest.raises(muslin.UsageError, match=f"{quantity}.*({message})"):
        setattr(simulation, quantity, value)
    assert simulation.checkpoint() == before


def test_positions_too_far_away_are_refused(flag):
    with pytest.raises(muslin.UsageError, match="beyond"):
        flag().positions = np.full((154, 3), 1e12)


def test_checkpoint_goes_on_bit_for_bit(flag):
    straight, first, second = flag(), flag(), flag()
    for _ in range(6):
        straight.advance()
    for _ in range(2):
        first.advance()
    first.step()
    saved = first.checkpoint()
    assert isinstance(saved, bytes)
    second.restore(saved)
    assert (second.frame, second.steps_done) == (2, 1)
    assert np.array_equal(second.positions, first.positions)
    while second.frame < 6:
        second.advance()
    assert second.checkpoint() == straight.checkpoint()
    assert len(second.history()["frame"]) == 5


def test_damaged_and_foreign_checkpoints_are_refused(flag):
    simulation = flag()
    saved = simulation.checkpoint()
    for bad in (b"", b"nonsense", saved[:-1], saved[:40] + b"x" + saved[41:]):
        with pytest.raises(muslin.InputError):
            simulation.restore(bad)
    tables = flag_tables()
    tables["body"][0]["voxel_width"] = 2.0
    with pytest.raises(muslin.InputError, match="other bodies"):
        muslin.Simulation(muslin.make_scene(tables)).restore(saved)
    with pytest.raises(TypeError):
        simulation.restore("text")
    assert simulation.checkpoint() == saved


def test_points_and_probes_are_carried(flag):
    simulation = flag()
    simulation.advance()
    body = simulation.model.body("flag")
    assert np.array_equal(simulation.points(), body.skin.apply(simulation.positions))
    assert np.array_equal(simulation.points("flag", surface="contour"), body.contour.embedding.apply(simulation.positions))
    tip = simulation.probes()["tip"]
    assert tip.shape == (3,) and tip[1] < 0
    assert simulation.probe_velocities()["tip"][1] < 0
    with pytest.raises(muslin.UsageError, match="skin"):
        simulation.points(surface="sking")
    with pytest.raises(muslin.UsageError, match="flag"):
        simulation.points("flug")
    shell = muslin.Simulation(muslin.make_scene(shell_tables()))
    assert np.array_equal(shell.points(), shell.positions)
    with pytest.raises(muslin.UsageError, match="contour"):
        shell.points(surface="contour")


def test_history_and_balance(flag):
    simulation = flag()
    frames = list(simulation)
    history = simulation.history()
    assert history["frame"].tolist() == [0, *frames]
    assert np.allclose(history["time"], history["frame"] / 24)
    assert history["momentum"].shape == (len(frames) + 1, 3)
    last = simulation.diagnostics
    assert (last.frame, last.kinetic, last.max_stretch) == (
        history["frame"][-1],
        history["kinetic"][-1],
        history["max_stretch"][-1],
    )
    balance = sum(history[name] for name in ("kinetic", "elastic", "potential", "dissipated")) - history["work"]
    assert np.ptp(balance) < 1e-4 * np.ptp(history["potential"])
    assert last.balance == pytest.approx(balance[-1])
    assert "frame 48" in repr(last)


def test_costs_without_contact(flag):
    simulation = flag()
    simulation.advance()
    costs = simulation.costs()
    assert set(costs) == {"search", "limit", "contact", "linearize", "solve"}
    assert costs["search"] == costs["limit"] == costs["contact"] == 0


def test_solver_errors_leave_the_last_good_step(flag):
    simulation = flag(solver={"integrator": "symplectic_euler"}, time={"duration": 2, "steps_per_frame": 1, "frame_rate": 1e-3})
    before = simulation.checkpoint()
    with pytest.raises(muslin.SolverError, match="steps_per_frame") as caught:
        simulation.advance()
    assert caught.value.exit_code == 4
    assert simulation.checkpoint() == before


def test_progress_and_cancel_inside_a_frame(flag):
    simulation, undisturbed = flag(), flag()
    fractions = []

    def stop() -> bool:
        return len(fractions) == 3

    with pytest.raises(muslin.Interrupted) as caught:
        simulation.advance(progress=lambda fraction, stage: fractions.append((fraction, stage)), cancel=stop)
    assert caught.value.exit_code == 130
    assert fractions == [(0, "simulation"), (0.25, "simulation"), (0.5, "simulation")]
    assert (simulation.frame, simulation.steps_done) == (0, 2)
    simulation.advance()
    undisturbed.advance()
    assert simulation.checkpoint() == undisturbed.checkpoint()
    with pytest.raises(KeyError):
        simulation.advance(progress=lambda fraction, stage: {}[stage])
    with pytest.raises(TypeError):
        simulation.advance(progress=3)


def test_thread_count_changes_no_bit(flag):
    results = []
    for count in (1, 2, 0):
        muslin.set_thread_count(count)
        if count:
            assert muslin.thread_count() == count
        simulation = flag()
        for _ in range(3):
            simulation.advance()
        results.append(simulation.checkpoint())
    assert results[0] == results[1] == results[2]
    with pytest.raises(muslin.UsageError):
        muslin.set_thread_count(-1)


def test_cut_sheet_goes_on_as_two():
    simulation = muslin.Simulation(muslin.make_scene(shell_tables()))
    simulation.advance()
    before, momentum = simulation.positions, simulation.diagnostics.momentum
    row = 3 * 7  # the vertices in the middle of 6 by 6 squares
    simulation.cut([(row + i, row + i + 1) for i in range(6)])
    assert len(simulation.positions) == len(before) + 7
    assert np.array_equal(simulation.positions[:49], before)
    assert np.allclose(simulation.diagnostics.momentum, momentum, rtol=1e-12)
    assert simulation.model.bodies[0].mesh.positions.shape == (56, 3)
    height = simulation.positions[:7, 1].mean()
    for _ in range(10):
        simulation.advance()
    assert simulation.positions[:7, 1].mean() < height - 0.5  # the lower half falls
    with pytest.raises(muslin.UsageError, match="share no edge"):
        simulation.cut([(0, 8)], body="cloth")


def test_pins_and_attachments_report_their_forces():
    where = {"group": "top"}
    tables = shell_tables(
        pin=[{"name": "hand", "body": "cloth", "where": where, "stiffness": 200, "damping": 5}],
        collider=[{"name": "bar", "shape": "box", "size": [1, 1, 1], "center": [0, 4, 0], "contact": False}],
        attachment=[{"name": "cord", "body": "cloth", "where": where, "to": "bar", "rest": "cord", "stiffness": 200,
                     "damping": 5}])
    simulation = muslin.Simulation(muslin.make_scene(tables))
    assert simulation.attachment_force("cord").holding == 0  # before the first step
    for _ in range(72):
        simulation.advance()
    pin, cord = simulation.pin_force("hand"), simulation.attachment_force("cord")
    weight = 9.8 * simulation.model.body("cloth").mass
    assert pin.sum[1] + cord.sum[1] == pytest.approx(weight, rel=0.05)
    assert cord.holding == 7 and 0 < cord.mean <= cord.largest and 0 < pin.mean <= pin.largest
    assert pin.most >= np.linalg.norm(pin.sum)
    with pytest.raises(muslin.UsageError, match="hand"):
        simulation.pin_force("hands")


def test_attachments_and_limits_of_stretch_change_over_time():
    tables = shell_tables(
        pin=[],
        collider=[{"name": "bar", "shape": "box", "size": [1, 1, 1], "center": [0, 4, 0], "contact": False}],
        attachment=[{"name": "cord", "body": "cloth", "where": {"group": "top"}, "to": "bar", "rest": "cord",
                     "stiffness": {"keyframes": [{"time": 0, "value": 200}, {"time": 1, "value": 100}]},
                     "damping": {"keyframes": [{"time": 0, "value": 0}, {"time": 0.1, "value": 5}]}}])
    tables["body"][0]["stretch_limit"] = {"keyframes": [{"time": 0, "value": 1.3}, {"time": 1, "value": 1.05}]}
    simulation = muslin.Simulation(muslin.make_scene(tables))
    for _ in range(72):
        simulation.advance()
    weight = 9.8 * simulation.model.body("cloth").mass
    assert simulation.attachment_force("cord").sum[1] == pytest.approx(weight, rel=0.05)
    assert simulation.diagnostics.max_stretch < 1.05
    tables["body"][0]["stretch_limit"]["keyframes"][1]["value"] = 1
    with pytest.raises(muslin.InputError, match="`stretch_limit` is 1 at 1 s"):
        muslin.make_scene(tables)
