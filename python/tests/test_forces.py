"""Forces that Python computes: against closed forms, and when they go wrong."""

import gc
import weakref

import numpy as np
import pytest
from conftest import flag_tables

import muslin


def test_fall_with_linear_drag(dust):
    """v' = g - c v/m has v(t) = g m/c (1 - exp(-c t/m)) and y(t) = g m/c (t - m/c (1 - exp(-c t/m)))."""
    g, rate = -9.8, 2.0  # m/s², c/m in 1/s
    errors = []
    for steps in (8, 16):
        simulation = dust(time={"duration": 1, "frame_rate": 24, "steps_per_frame": steps})
        masses = simulation.model.masses[:, None]
        simulation.add_force(lambda x, v, t, m=masses: m * (np.array([0, g, 0]) - rate * v), name="fall")
        list(simulation)
        decay = 1 - np.exp(-rate)
        fallen = simulation.positions - simulation.model.rest_positions
        assert np.allclose(fallen, fallen[0], atol=1e-9)
        assert np.allclose(fallen[0, [0, 2]], 0)
        errors.append(abs(fallen[0, 1] - g / rate * (1 - decay / rate)))
        assert simulation.velocities[0, 1] == pytest.approx(g / rate * decay, rel=2e-2)
    assert errors[0] < 0.02
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.1)  # first order in the step


def test_fall_with_quadratic_drag_reaches_terminal_speed(dust):
    """v' = g - k v² has v(t) = sqrt(g/k) tanh(sqrt(g k) t)."""
    g, k = 9.8, 0.5
    simulation = dust(time={"duration": 2, "frame_rate": 24, "steps_per_frame": 20})
    masses = simulation.model.masses[:, None]

    def fall(x, v, t):
        speed = np.linalg.norm(v, axis=1, keepdims=True)
        return masses * (np.array([0, -g, 0]) - k * speed * v)

    simulation.add_force(fall)
    for frame in simulation:
        expected = -np.sqrt(g / k) * np.tanh(np.sqrt(g * k) * frame / 24)
        assert simulation.velocities[3, 1] == pytest.approx(expected, abs=0.03)


def test_spring_to_a_point_oscillates(dust):
    """x'' = -ω² (x - c): the force of a field that depends on x."""
    omega = 3.0
    simulation = dust(time={"duration": 2, "frame_rate": 24, "steps_per_frame": 200}, solver={"integrator": "symplectic_euler"})
    rest, masses = simulation.model.rest_positions, simulation.model.masses[:, None]
    simulation.add_force(lambda x, v, t: -masses * omega**2 * x, name="pull")
    for frame in simulation:
        assert np.allclose(simulation.positions, rest * np.cos(omega * frame / 24), atol=0.05)


def test_sees_the_state_and_time_at_the_beginning_of_each_step(flag):
    simulation = flag()
    seen = []
    simulation.add_force(lambda x, v, t: seen.append((x.copy(), v.copy(), t)))
    states = []
    for _ in range(6):
        states.append((simulation.positions, simulation.velocities, simulation.time))
        simulation.step()
    assert len(seen) == 6
    for (x, v, t), (x0, v0, t0) in zip(seen, states, strict=True):
        assert np.array_equal(x, x0) and np.array_equal(v, v0)
        assert t == pytest.approx(t0, abs=1e-12)


def test_does_work_in_the_energy_balance(flag):
    simulation = flag()
    simulation.add_force(lambda x, v, t: np.tile([0, 0, 5.0 * np.sin(t)], (len(x), 1)))
    list(simulation)
    history = simulation.history()
    assert history["work"][-1] > 10
    balance = sum(history[name] for name in ("kinetic", "elastic", "potential", "dissipated")) - history["work"]
    assert np.ptp(balance) < 1e-3 * np.ptp(history["potential"])


def test_acts_on_one_body_only():
    tables = flag_tables(pin=None, probe=None, force=None)
    tables["body"] = [tables["body"][0], tables["body"][0] | {"name": "other", "translate": [0, 0, 5]}]
    simulation = muslin.Simulation(muslin.make_scene(tables))
    shapes = set()

    def push(x, v, t):
        shapes.add(x.shape)
        return np.tile([60.0, 0, 0], (len(x), 1))

    simulation.add_force(push, body="other")
    simulation.advance()
    first, second = (simulation.model.body(name).vertices for name in ("flag", "other"))
    assert shapes == {(154, 3)}
    assert (simulation.velocities[first] == 0).all()
    assert (simulation.velocities[second][:, 0] > 0).any()
    with pytest.raises(muslin.UsageError, match="did you mean `other`"):
        simulation.add_force(push, body="othr")


def test_several_forces_add_up(dust):
    simulation = dust()
    masses = simulation.model.masses[:, None]
    simulation.add_force(lambda x, v, t: masses * [3.0, 0, 0])
    simulation.add_force(lambda x, v, t: masses * [-1.0, 2, 0])
    simulation.add_force(lambda x, v, t: None)
    simulation.advance()
    assert np.allclose(simulation.velocities, np.array([2, 2, 0]) / 24)


@pytest.mark.parametrize(
    ("returned", "message"),
    [
        (lambda x: np.zeros((3, 3)), '"drag" returned: it has 3 rows'),
        (lambda x: np.zeros(3), "shape"),
        (lambda x: 0.0, "shape"),
        (lambda x: x * np.nan, "is nan"),
        (lambda x: x.astype(complex), "complex128"),
        (lambda x: "force", "U5|str"),
    ],
)
def test_refuses_what_is_no_force(flag, returned, message):
    simulation = flag()
    simulation.add_force(lambda x, v, t: returned(x), name="drag")
    before = simulation.checkpoint()
    with pytest.raises(muslin.UsageError, match=message):
        simulation.advance()
    assert simulation.checkpoint() == before


def test_any_layout_of_the_returned_array(dust):
    simulation = dust()
    masses = simulation.model.masses[:, None]
    simulation.add_force(lambda x, v, t: np.asfortranarray(masses * [0.0, 24.0, 0.0]).astype(np.float32))
    simulation.advance()
    assert np.allclose(simulation.velocities[:, 1], 1, rtol=1e-5)


def test_exception_propagates_and_leaves_the_last_whole_step(flag):
    simulation, undisturbed = flag(), flag()
    calls = []

    def fuse(x, v, t):
        calls.append(t)
        if len(calls) == 3:
            raise LookupError("blown")

    simulation.add_force(fuse)
    undisturbed.add_force(lambda x, v, t: None)
    with pytest.raises(LookupError, match="blown"):
        simulation.advance()
    assert simulation.steps_done == 2
    simulation.advance()
    undisturbed.advance()
    assert simulation.checkpoint() == undisturbed.checkpoint()


def test_wrong_signature_is_a_type_error(flag):
    simulation = flag()
    simulation.add_force(lambda x: x)
    with pytest.raises(TypeError, match="positional argument"):
        simulation.advance()
    with pytest.raises(TypeError):
        simulation.add_force(3)


def test_arrays_may_be_kept_and_written(flag):
    simulation = flag()
    kept = []

    def greedy(x, v, t):
        kept.append((x, v, x.copy()))
        x[:] = 7
        return None

    simulation.add_force(greedy)
    simulation.advance()
    del simulation
    gc.collect()
    assert all((x == 7).all() for x, v, original in kept)
    assert not np.array_equal(kept[0][2], kept[-1][2])


def test_may_read_but_not_change_the_simulation(flag):
    simulation = flag()
    times = []

    def look(x, v, t):
        assert np.array_equal(simulation.positions, x)
        times.append(simulation.time)
        if len(times) == 4:
            simulation.positions = x

    simulation.add_force(look)
    with pytest.raises(muslin.UsageError, match="calls back"):
        simulation.advance()
    assert np.allclose(times, np.arange(4) / 96)

    other = flag()
    other.add_force(lambda x, v, t: other.step())
    with pytest.raises(muslin.UsageError, match="calls back"):
        other.advance()


def test_force_that_refers_to_its_simulation_is_collected(flag):
    class Marker:
        pass

    simulation, marker = flag(), Marker()
    gone = weakref.ref(marker)
    simulation.add_force(lambda x, v, t, m=marker, s=simulation: None)
    del simulation, marker
    gc.collect()
    assert gone() is None


def test_resumes_with_its_forces(flag):
    def make():
        simulation = flag()
        simulation.add_force(lambda x, v, t: np.tile([0, 0, 5.0 * np.sin(9 * t)], (len(x), 1)), name="blow")
        return simulation

    straight, first, second = make(), make(), make()
    for _ in range(8):
        straight.advance()
    for _ in range(3):
        first.advance()
    second.restore(first.checkpoint())
    while second.frame < 8:
        second.advance()
    assert second.checkpoint() == straight.checkpoint()
