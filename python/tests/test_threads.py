"""The GIL is free while the engine works; Ctrl-C stops it; one simulation, one thread."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest
from conftest import flag_tables, grid_mesh

import muslin


def large_flag(**changes) -> muslin.Simulation:
    tables = flag_tables(**changes)
    tables["body"][0] |= {"voxel_width": 0.25, "thickness": 0.25, "mesh": grid_mesh(10, 6, 40, 24)}
    return muslin.Simulation(muslin.make_scene(tables))


def test_python_runs_while_a_frame_is_advanced():
    simulation = large_flag(time={"duration": 1, "frame_rate": 2, "steps_per_frame": 240})
    simulation.step()  # warm up
    counted = 0
    done = threading.Event()

    def advance() -> None:
        simulation.advance()
        done.set()

    thread = threading.Thread(target=advance)
    thread.start()
    while not done.is_set():
        counted += 1
        time.sleep(0.0005)
    thread.join()
    assert simulation.frame == 1
    assert counted > 20  # with the GIL held it would be one or two


def test_two_simulations_in_two_threads():
    def bits(sink: list[bytes], index: int) -> None:
        simulation = large_flag()
        for _ in range(2):
            simulation.advance()
        sink[index] = simulation.checkpoint()

    results = [b""] * 3
    threads = [threading.Thread(target=bits, args=(results, index)) for index in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    bits(results, 2)
    assert results[0] == results[1] == results[2] != b""


def test_a_simulation_at_work_refuses_other_threads():
    simulation = large_flag()
    inside, go_on = threading.Event(), threading.Event()

    def wait(fraction: float, stage: str) -> None:
        inside.set()
        go_on.wait()

    thread = threading.Thread(target=lambda: simulation.advance(progress=wait))
    thread.start()
    inside.wait()
    try:
        for use in (
            lambda: simulation.positions,
            lambda: simulation.advance(),
            lambda: simulation.step(),
            lambda: simulation.checkpoint(),
            lambda: simulation.history(),
            lambda: simulation.frame,
            lambda: simulation.add_force(lambda x, v, t: None),
            lambda: setattr(simulation, "positions", simulation.model.rest_positions),
            lambda: simulation.restore(b""),
        ):
            with pytest.raises(muslin.UsageError, match="another thread"):
                use()
    finally:
        go_on.set()
        thread.join()
    assert simulation.frame == 1


def test_cancel_from_another_thread():
    simulation = large_flag()
    stop = threading.Event()
    timer = threading.Timer(0.2, stop.set)
    timer.start()
    with pytest.raises(muslin.Interrupted):
        while True:
            simulation.advance(cancel=stop.is_set)
    before = simulation.frame
    simulation.advance()
    assert simulation.frame == before + 1


def test_keyboard_interrupt_stops_at_a_step_and_can_go_on(flag):
    simulation, undisturbed = large_flag(), large_flag()
    steps = []

    def press(x, v, t):
        steps.append(t)
        if len(steps) == 2:
            os.kill(os.getpid(), signal.SIGINT)

    simulation.add_force(press)
    undisturbed.add_force(lambda x, v, t: None)
    with pytest.raises(KeyboardInterrupt):
        for _ in simulation:
            pass
    assert simulation.frame == 0
    simulation.advance()
    undisturbed.advance()
    assert simulation.checkpoint() == undisturbed.checkpoint()


def test_ctrl_c_ends_a_program_that_does_nothing_else(source):
    """A bare loop over a long simulation, stopped from outside as a shell would."""
    script = (
        "import sys, muslin\n"
        f"scene = muslin.read_scene({str(source / 'scenes/thesis/2_two_corners.toml')!r}, ['time.duration=10000'])\n"
        "print('ready', flush=True)\n"
        "for frame in muslin.Simulation(scene): pass\n"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert child.stdout is not None and child.stdout.readline() == "ready\n"
    time.sleep(0.5)
    child.send_signal(signal.SIGINT)
    _, errors = child.communicate(timeout=60)
    assert "KeyboardInterrupt" in errors
    assert child.returncode in (1, 130, -signal.SIGINT)
