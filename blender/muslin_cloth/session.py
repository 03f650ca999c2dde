"""A bake of one Blender scene: carries out the effects of bake_state.transition and reports events to it."""

import json
import time
import traceback

import bpy

from . import bake_state as bs
from . import playback, worker
from .advice import ERROR, Notice, crossing_faces, in_blender, of_polygons, of_report, problem_line, warnings_of
from .gather import Capture, Problem, cloth_objects
from .preferences import find_program, threads
from .scene_text import scene_toml

INTERVAL = 0.15  # between looks at the worker [s]
SAMPLING = 0.2  # of sampling at a time [s]

sessions = {}  # scene name → Session


class Session:
    def __init__(self, scene):
        self.scene_name = scene.name
        self.state = bs.State()
        self.folder = None  # of the bake that is there or being made
        self.notices, self.counts, self.message = [], {}, ""  # the notices of the last check and bake
        self.crossing = {}  # object → its faces that cross something at the start
        self.capture = self.question = self.worker = self.playback = None
        self._began = (0.0, 0)  # when the worker started, and at which frame
        self._sessions_before = 0  # of the run that is resumed, until the worker has begun its own; then -1
        self._checked_only = False
        if bpy.data.filepath:
            self.open(scene)

    # State on disk

    def open(self, scene):
        folder = playback.playing_folder(scene) or playback.own_folder(scene)
        description = playback.read_description(folder)
        if description is None:
            return
        self.folder, run = folder, folder / "run"
        self.playback = playback.Playback(folder, description)
        alive = worker.is_locked(run)
        frame, total = self.playback.available(), description["frames"]
        log, problem = folder / "worker.log", ""
        if alive:
            self.worker = worker.Orphan(run, description.get("pid", 0), log)
            self._began, self._sessions_before = (time.monotonic(), max(frame, 0)), -1
        elif frame < total and worker.run_status(run) == "running":
            problem = f"The bake was interrupted after frame {frame + description['frame_start']}; Resume continues it"
        elif worker.run_status(run) == "failed":
            problem = problem_line(worker.read_log(log)) or worker.read_run(run).get("reason", "")
        if not alive:
            self._read_warnings()
        self.feed(bs.Opened(frame, total, alive, problem if frame >= 0 else ""))
        self.attach()  # the file may have been saved before the bake was there

    def scene(self):
        return bpy.data.scenes.get(self.scene_name)

    @property
    def first_frame(self):
        return self.playback.description["frame_start"] if self.playback else 0

    def seconds_left(self):
        began, frame = self._began
        done = self.state.frame - frame
        if self.state.phase != bs.Phase.RUNNING or done <= 0:
            return None
        return (time.monotonic() - began) / done * (self.state.total - self.state.frame)

    def progress(self):
        """(fraction, text) of the running task."""
        phase, state = self.state.phase, self.state
        if phase == bs.Phase.CHECKING:
            return 0.0, "Checking"
        if phase == bs.Phase.CAPTURING and self.capture:
            done = self.capture.frame - self.capture.first
            return done / max(state.next_total + 1, 1), f"Reading frame {self.capture.frame}"
        share = max(state.frame, 0) / max(state.total, 1)
        if phase == bs.Phase.STOPPING:
            return share, "Stopping after this step"
        left = self.seconds_left()
        text = f"Frame {state.frame + self.first_frame} of {state.total + self.first_frame}"
        return share, text if left is None else f"{text}, {clock(left)} left"

    # Events in, effects out

    def feed(self, event):
        events = [event]
        while events:
            self.state, effects = bs.transition(self.state, events.pop(0))
            for effect in effects:
                follow_up = self._do(effect)
                if follow_up is not None:
                    events.append(follow_up)
        redraw()

    def _do(self, effect):
        """Carries an effect out; returns an event if it failed at once."""
        if isinstance(effect, bs.Tell):
            self.message = effect.text
        elif isinstance(effect, bs.StartCheck):
            return self._start_check()
        elif isinstance(effect, bs.StartCapture):
            pass  # the capture was begun by the check
        elif isinstance(effect, bs.Abandon):
            self._abandon()
        elif isinstance(effect, bs.RemoveBake):
            self._remove()
        elif isinstance(effect, bs.Show):
            self._show(effect.frame)
        elif isinstance(effect, bs.StartWorker):
            return self._start_worker(effect.origin)
        elif isinstance(effect, bs.Interrupt):
            self.worker.interrupt()
        elif isinstance(effect, bs.Kill):
            self.worker.kill()
        return None

    def _start_check(self):
        self._abandon()  # a check without a bake may be in work
        self._checked_only = False
        self.notices, self.message, self.crossing = [], "", {}
        try:
            self._begin_check()
        except Problem as problem:
            return bs.Checked(str(problem))
        except OSError as error:
            return bs.Checked(f"{error.strerror}: {error.filename}; choose a folder that can be written for the file")
        return None

    def _begin_check(self):
        program = find_program()
        if not program:
            raise Problem("The program muslin was not found: set its place in Preferences > Add-ons > Muslin Cloth")
        scene = self.scene()
        first, last = scene.muslin.frames(scene)
        folder = playback.own_folder(scene) if bpy.data.filepath else None
        self.capture = Capture(scene, folder, first, last)
        self.capture.begin()
        self.notices += self.capture.notices()
        check = folder / "check"
        self.capture.write_meshes(check)
        (check / "scene.toml").write_text(scene_toml(self.capture.input, moving=False), encoding="utf-8")
        files = [c.name for c in self.capture.input.cloths] + [c.name for c in self.capture.input.colliders]
        commands = [["check", "--json", str(check / f"{name}.obj")] for name in files]
        commands.append(["check", "--json", str(check / "scene.toml")])
        self.question = worker.Question(program, commands)

    def _finish_check(self):
        """The answers as notices; the first error is the event."""
        question, self.question = self.question, None
        inputs = self.capture.input
        names = {body: name for name, body in self.capture.names.items()}
        parts = [(c.name, c.model) for c in inputs.cloths] + [(c.name, "collider") for c in inputs.colliders]
        problem, said = question.error, set()
        for (body, model), (code, out, err) in zip(parts, question.answers):
            if code != 0:
                self.notices.append(Notice(ERROR, in_blender(problem_line(err), names), names[body]))
                continue
            report = json.loads(out)
            said.update(report["warnings"])
            self.notices += of_report(report, model, names[body])
            self.notices += of_polygons(self.capture.snapshots[names[body]].sizes, names[body])
        errors = [n for n in self.notices if n.level == ERROR]
        if not errors and len(question.answers) > len(parts):
            code, out, err = question.answers[-1]
            if code != 0:
                problem = problem or in_blender(problem_line(err), names)
            if out:  # a start that is refused is described too
                self._read_scene_check(json.loads(out), names, said)
        playback.remove_tree(self.capture.folder / "check")
        if errors:
            problem = f"{errors[0].object}: {errors[0].text}"
        return problem

    def _read_scene_check(self, answer, names, said):
        """Counts and warnings; those `said` of the meshes have been put into Blender's words already."""
        self.counts = {names[b["name"]]: b for b in answer["bodies"] if b["name"] in names}
        self.notices += warnings_of(answer["warnings"], names, said)
        self.crossing = crossing_faces(answer["crossings"], names)

    def check(self):
        """Checks without baking."""
        if self.state.busy:
            return "A bake is running: cancel it first"
        failed = self._start_check()
        if failed is None:
            self._checked_only = True
            return ""
        self._abandon()
        self.notices.append(Notice(ERROR, failed.problem))
        return failed.problem

    def _abandon(self):
        if self.question:
            self.question.cancel()
            self.question = None
        if self.capture:
            self.capture.abandon()
            playback.remove_tree(self.capture.folder / "check")
            remove_if_empty(self.capture.folder)
            self.capture = None

    def _remove(self):
        if self.playback:
            self.playback.close()
            self.playback = None
        scene = self.scene()
        if scene:
            playback.detach(scene)
        if self.folder and (not bpy.data.filepath or self.folder == playback.own_folder(scene)):
            playback.remove_files(self.folder)  # that of an earlier file stays with it
        if not self.state.busy:
            self.counts = {}

    def _show(self, frame):
        if self.playback is None:
            return
        try:
            self.playback.show(frame)
        except (OSError, ValueError) as error:
            self.message = f"Cannot write the playback: {error}"
            return
        self.attach()

    def attach(self):
        scene = self.scene()
        if scene and self.playback and self.state.frame >= 0:
            self.playback.attach(scene)
            redraw()

    def _start_worker(self, origin):
        program = find_program()
        if not program:
            return bs.WorkerEnded(bs.EXIT_FILE, self.state.frame, "The program muslin was not found: set its place in "
                                                                  "Preferences > Add-ons > Muslin Cloth")
        try:
            description = self._prepare_files(origin)
            words = ["run", str(self.folder / "scene.toml"), "-o", str(self.folder / "run"), "--quiet",
                     "--frames", str(description["frames"])]
            scene = self.scene()
            if scene is None or scene.muslin.keep_states:
                words.append("--keep-states")
            if threads():
                words += ["--threads", str(threads())]
            if origin is None:
                words.append("--resume")
            elif origin != bs.FRESH:
                words += ["--resume-from", str(origin)]
            self._sessions_before = sessions_of(self.folder / "run")
            self.worker = worker.Worker(program, words, self.folder / "worker.log")
            description["pid"] = self.worker.pid
            playback.write_description(self.folder, description)
        except (OSError, Problem) as error:
            return bs.WorkerEnded(bs.EXIT_FILE, self.state.frame, str(error))
        self._began = (time.monotonic(), max(self.state.frame, 0))
        if self.state.frame >= 0:
            self._show(self.state.frame)
        return None

    def _prepare_files(self, origin):
        if origin is None:
            return dict(self.playback.description)
        self.folder = self.capture.folder
        description = self.capture.commit()
        self.capture = None
        if self.playback:
            self.playback.close()
        self.playback = playback.Playback(self.folder, description)
        self.playback.remove()  # the object may move otherwise than before: all frames are converted anew
        return description

    # The clock

    def tick(self):
        """Polls the running task once; True while there is one."""
        if self.question and self.question.done():
            problem = self._finish_check()
            if self._checked_only:
                self._checked_only = False
                if problem and not any(problem.endswith(n.text) for n in self.notices):
                    self.notices.append(Notice(ERROR, problem))
                self._abandon()
                redraw()
            else:
                if problem:
                    self._abandon()
                self.feed(bs.Checked(problem))
        elif self.state.phase == bs.Phase.CAPTURING:
            self._tick_capture()
        elif self.state.phase in (bs.Phase.RUNNING, bs.Phase.STOPPING):
            self._tick_worker()
        return self.state.busy or self.question is not None

    def _tick_capture(self):
        try:
            if self.capture.step(SAMPLING):
                self.feed(bs.Captured())
        except (Problem, OSError) as problem:
            self._abandon()
            self.feed(bs.Captured(str(problem)))
        redraw()

    def _tick_worker(self):
        code = self.worker.ended()  # before the frames are counted: what it wrote last is then seen
        frame = self.playback.available()
        if code is None:
            if self._has_begun():
                self.feed(bs.Progressed(frame))
            return
        log = self.worker.problem()
        self.worker = None
        names = self._objects()
        self._read_warnings()
        self.feed(bs.WorkerEnded(code, frame, in_blender(problem_line(log), names)))
        mark_changed()

    def _objects(self):
        """The objects of the bake and its colliders as they were called: body → name."""
        description = self.playback.description
        return description.get("names") or {o["body"]: o["object"] for o in description["objects"]}

    def _read_warnings(self):
        """What the run says at its end, such as what yielded or crossed."""
        said = {n.text for n in self.notices}
        found = warnings_of(worker.read_run(self.folder / "run").get("warnings", []), self._objects(),
                            first_frame=self.first_frame)
        self.notices += [n for n in found if n.text not in said]

    def _has_begun(self):
        """Until then the caches of a run that is resumed from an earlier frame hold frames that will be removed."""
        if self._sessions_before >= 0 and sessions_of(self.folder / "run") > self._sessions_before:
            self._sessions_before = -1
        return self._sessions_before < 0

    def give_up(self, problem):
        self.stop()
        self.worker = None
        self.state = bs.at_rest(self.state, problem)
        redraw()

    def stop(self):
        """Blender closes or opens another file: the worker stops too, and can be resumed."""
        self._abandon()
        if self.worker:
            self.worker.interrupt()
        if self.playback:
            self.playback.close()


def sessions_of(run):
    return len(worker.read_run(run).get("timings", {}).get("sessions", []))


def clock(seconds):
    s = round(seconds)
    if s < 60:
        return f"{s} s"
    return f"{s // 60}:{s % 60:02} min" if s < 3600 else f"{s // 3600}:{s // 60 % 60:02} h"


def remove_if_empty(folder):
    for empty in (folder, folder.parent):
        try:
            empty.rmdir()
        except OSError:
            return


def mark_changed():
    """Marks the file as changed after modifiers were set by the add-on, so that Blender asks to save it."""
    windows = bpy.context.window_manager.windows
    if not bpy.app.background and len(windows):
        with bpy.context.temp_override(window=windows[0]):
            bpy.ops.ed.undo_push(message="Muslin Bake")


def redraw():
    for window in bpy.context.window_manager.windows if bpy.context.window_manager else ():
        for area in window.screen.areas:
            if area.type in ("PROPERTIES", "VIEW_3D"):
                area.tag_redraw()


def session_of(scene):
    if scene.name not in sessions:
        sessions[scene.name] = Session(scene)
    return sessions[scene.name]


def baking(scene):
    """The session if there is one; asks the disk for nothing. For drawing."""
    return sessions.get(scene.name)


# The clock runs while something is in work.


def _tick():
    busy = False
    for session in list(sessions.values()):
        try:
            busy = session.tick() or busy
        except Exception:  # a bug must not leave a bake that seems to be in work for ever
            traceback.print_exc()
            session.give_up("Internal error: the console says more; please report it")
    return INTERVAL if busy else None


def start_clock():
    if not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=INTERVAL, persistent=True)


def wait(session):
    """Blocks until no task is running: for scripts and Blender without a window."""
    try:
        while session.tick():
            time.sleep(0.02)
    except KeyboardInterrupt:
        session.feed(bs.Cancel())
        while session.tick():
            time.sleep(0.02)


# Handlers of Blender's events


@bpy.app.handlers.persistent
def on_load(*_):
    sessions.clear()
    for scene in bpy.data.scenes:
        if cloth_objects(scene):
            session_of(scene)
    if any(s.state.busy for s in sessions.values()):
        start_clock()


@bpy.app.handlers.persistent
def before_load(*_):
    stop_all()


@bpy.app.handlers.persistent
def on_undo(*_):
    """Undo reverts settings, not files: playback keeps the bake."""
    for session in sessions.values():
        session.attach()


def stop_all():
    for session in sessions.values():
        session.stop()
    sessions.clear()


HANDLERS = (("load_pre", before_load), ("load_post", on_load), ("undo_post", on_undo), ("redo_post", on_undo))


def register():
    import atexit
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)
    atexit.register(stop_all)
    bpy.app.timers.register(_open_once, first_interval=0.1)


def _open_once():
    """When the add-on is switched on in a file that is already open."""
    for scene in bpy.data.scenes:
        if cloth_objects(scene):
            session_of(scene)
    if any(s.state.busy for s in sessions.values()):
        start_clock()


def unregister():
    import atexit
    atexit.unregister(stop_all)
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    stop_all()
