"""The life of a bake as a pure function: transition(state, event) -> (state, effects).

    EMPTY ──bake──▶ CHECKING ──▶ CAPTURING ──▶ RUNNING ──▶ DONE
                       │             │            │ cancel
                       ▼             ▼            ▼
                     FAILED    (as before)     STOPPING ──▶ STOPPED ──resume──▶ RUNNING

No Blender, no files, no clock: the session (session.py) carries the effects out and reports what happens as
events. What is not foreseen in a state (a late progress report, a second press of a button) changes nothing.
"""

from dataclasses import dataclass, replace
from enum import Enum
from typing import Tuple


class Phase(Enum):
    EMPTY = "empty"  # nothing is baked
    CHECKING = "checking"  # muslin check looks at meshes and scene
    CAPTURING = "capturing"  # frames are sampled from Blender
    RUNNING = "running"  # the worker simulates
    STOPPING = "stopping"  # the worker was asked to stop
    STOPPED = "stopped"  # frames are there, the rest can be resumed
    FAILED = "failed"  # `problem` says why; frames that are there stay
    DONE = "done"


BUSY = {Phase.CHECKING, Phase.CAPTURING, Phase.RUNNING, Phase.STOPPING}

FRESH = -1  # a bake from the first frame, in place of a frame to go on from


@dataclass(frozen=True)
class State:
    phase: Phase = Phase.EMPTY
    frame: int = -1  # last frame that can be played, counted from the bake's first; -1: none
    total: int = 0  # last frame of the bake that is there or being made
    next_total: int = 0  # that of the bake being prepared
    origin: int = FRESH  # frame the bake being prepared goes on from
    problem: str = ""  # what went wrong, and what to do; empty if nothing did

    @property
    def busy(self):
        return self.phase in BUSY

    @property
    def resumable(self):
        return self.phase in (Phase.STOPPED, Phase.FAILED) and 0 <= self.frame < self.total


# Events


@dataclass(frozen=True)
class Bake:
    """A bake of frames 0 to `total` is requested."""

    total: int


@dataclass(frozen=True)
class BakeFrom:
    """Frames up to `frame` stay; later ones up to `total` are simulated again with the current scene."""

    frame: int
    total: int


@dataclass(frozen=True)
class Resume:
    """Continues an interrupted bake, with the scene as it was."""


@dataclass(frozen=True)
class Cancel:
    pass


@dataclass(frozen=True)
class Free:
    pass


@dataclass(frozen=True)
class Checked:
    problem: str = ""


@dataclass(frozen=True)
class Captured:
    problem: str = ""


@dataclass(frozen=True)
class Progressed:
    frame: int


@dataclass(frozen=True)
class WorkerEnded:
    """`code` is the exit code, negative for a signal; `frame` is the last complete frame."""

    code: int
    frame: int
    problem: str = ""


@dataclass(frozen=True)
class Opened:
    """The files found on disk when a .blend file is opened. `alive`: a worker of an earlier Blender still runs."""

    frame: int = -1
    total: int = 0
    alive: bool = False
    problem: str = ""


# Effects


@dataclass(frozen=True)
class StartCheck:
    pass


@dataclass(frozen=True)
class StartCapture:
    total: int


@dataclass(frozen=True)
class Abandon:
    """Ends the running check or capture and discards its files."""


@dataclass(frozen=True)
class StartWorker:
    """`origin` FRESH: from the start; a frame: from there with the new scene; None: from the last state."""

    origin: object


@dataclass(frozen=True)
class Interrupt:
    """Asks the worker to finish its step and stop."""


@dataclass(frozen=True)
class Kill:
    pass


@dataclass(frozen=True)
class Show:
    """Frames up to `frame` can be played."""

    frame: int


@dataclass(frozen=True)
class RemoveBake:
    """Removes files and playback."""


@dataclass(frozen=True)
class Tell:
    """Shows a sentence to the user without a change of state."""

    text: str


Effects = Tuple[object, ...]

EXIT_DONE, EXIT_USAGE, EXIT_INPUT, EXIT_SOLVER, EXIT_FILE, EXIT_INTERRUPTED = 0, 2, 3, 4, 5, 130


def at_rest(state, problem=""):
    """Returns the idle state that the frames imply."""
    if problem:
        phase = Phase.FAILED
    elif state.frame < 0:
        phase = Phase.EMPTY
    elif state.frame >= state.total:
        phase = Phase.DONE
    else:
        phase = Phase.STOPPED
    return replace(state, phase=phase, next_total=0, origin=FRESH, problem=problem)


def transition(state: State, event) -> Tuple[State, Effects]:
    handler = _HANDLERS.get(type(event))
    if handler is None:
        raise TypeError(f"{event!r} is no event of a bake")
    return handler(state, event)


def _bake(state, event):
    if state.busy:
        return state, (Tell("A bake is running: cancel it first"),)
    return _prepare(state, FRESH, event.total)


def _bake_from(state, event):
    if state.busy:
        return state, (Tell("A bake is running: cancel it first"),)
    if not 0 <= event.frame <= state.frame:
        return state, (Tell("This frame is not baked: go to one that is, or bake from the start"),)
    if event.total <= event.frame:
        return state, (Tell("This is the last frame: go to an earlier one, or move the end of the range"),)
    return _prepare(state, event.frame, event.total)


def _prepare(state, origin, total):
    state = replace(state, phase=Phase.CHECKING, origin=origin, next_total=max(total, 0), problem="")
    return state, (StartCheck(),)


def _resume(state, _):
    if not state.resumable:
        return state, (Tell("There is nothing to resume"),)
    return replace(state, phase=Phase.RUNNING, problem=""), (StartWorker(None),)


def _cancel(state, _):
    if state.phase in (Phase.CHECKING, Phase.CAPTURING):
        return at_rest(state), (Abandon(),)
    if state.phase == Phase.RUNNING:
        return replace(state, phase=Phase.STOPPING), (Interrupt(),)
    if state.phase == Phase.STOPPING:
        return state, (Kill(),)
    return state, ()


def _free(state, _):
    if state.busy:
        return state, (Tell("A bake is running: cancel it first"),)
    return State(), (RemoveBake(),)


def _checked(state, event):
    if state.phase != Phase.CHECKING:
        return state, ()
    if event.problem:
        return at_rest(state, event.problem), ()
    return replace(state, phase=Phase.CAPTURING), (StartCapture(state.next_total),)


def _captured(state, event):
    if state.phase != Phase.CAPTURING:
        return state, ()
    if event.problem:
        return at_rest(state, event.problem), ()
    running = replace(state, phase=Phase.RUNNING, frame=state.origin, total=state.next_total)
    before = (RemoveBake(),) if state.origin == FRESH else (Show(state.origin),)
    return running, before + (StartWorker(state.origin),)


def _progressed(state, event):
    if state.phase not in (Phase.RUNNING, Phase.STOPPING):
        return state, ()
    frame = min(event.frame, state.total)
    if frame <= state.frame:
        return state, ()
    return replace(state, frame=frame), (Show(frame),)


def _worker_ended(state, event):
    if state.phase not in (Phase.RUNNING, Phase.STOPPING):
        return state, ()
    frame = min(max(event.frame, -1), state.total)
    effects = (Show(frame),) if frame >= 0 else ()
    state = replace(state, frame=frame)
    if event.code in (EXIT_DONE, EXIT_INTERRUPTED) or state.phase == Phase.STOPPING:
        return at_rest(state), effects
    if event.code < 0:
        problem = f"The worker was killed (signal {-event.code})"
        if frame >= 0:
            problem += f"; Resume continues after frame {frame}"
        return at_rest(state, problem), effects
    return at_rest(state, event.problem or f"muslin ended with code {event.code} and said nothing"), effects


def _opened(_, event):
    total = max(event.total, 0)
    frame = min(max(event.frame, -1), total)
    state = State(frame=frame, total=total)
    if event.alive:
        return replace(state, phase=Phase.RUNNING), ()
    return at_rest(state, event.problem), ()


_HANDLERS = {
    Bake: _bake,
    BakeFrom: _bake_from,
    Resume: _resume,
    Cancel: _cancel,
    Free: _free,
    Checked: _checked,
    Captured: _captured,
    Progressed: _progressed,
    WorkerEnded: _worker_ended,
    Opened: _opened,
}
