"""Every transition of a bake, and random walks against a world that answers. Runs without Blender."""

import dataclasses
import random
import unittest

from support import load

bs = load("bake_state")
Phase, State, transition = bs.Phase, bs.State, bs.transition

EVENTS = [
    bs.Bake(10), bs.BakeFrom(4, 10), bs.BakeFrom(99, 100), bs.Resume(), bs.Cancel(), bs.Free(), bs.Checked(),
    bs.Checked("the mesh has no faces"), bs.Captured(), bs.Captured("the topology changes"), bs.Progressed(5),
    bs.Progressed(99), bs.WorkerEnded(0, 10), bs.WorkerEnded(130, 6), bs.WorkerEnded(4, 6, "it could not go on"),
    bs.WorkerEnded(-9, 6), bs.Opened(), bs.Opened(6, 10), bs.Opened(10, 10), bs.Opened(3, 10, alive=True),
    bs.Opened(3, 10, problem="it could not go on"),
]


def run(state, *events):
    effects = ()
    for event in events:
        state, effects = transition(state, event)
    return state, effects


class Transitions(unittest.TestCase):
    def expect(self, start, event, phase, *effects, **fields):
        state, got = transition(start, event)
        self.assertEqual(state.phase, phase)
        self.assertEqual(got, effects)
        for name, value in fields.items():
            self.assertEqual(getattr(state, name), value, name)
        return state

    def test_a_bake_from_the_button_to_the_last_frame(self):
        s = self.expect(State(), bs.Bake(10), Phase.CHECKING, bs.StartCheck())
        s = self.expect(s, bs.Checked(), Phase.CAPTURING, bs.StartCapture(10))
        s = self.expect(s, bs.Captured(), Phase.RUNNING, bs.RemoveBake(), bs.StartWorker(bs.FRESH), total=10, frame=-1)
        s = self.expect(s, bs.Progressed(0), Phase.RUNNING, bs.Show(0), frame=0)
        s = self.expect(s, bs.Progressed(7), Phase.RUNNING, bs.Show(7), frame=7)
        s = self.expect(s, bs.Progressed(7), Phase.RUNNING, frame=7)
        self.expect(s, bs.WorkerEnded(0, 10), Phase.DONE, bs.Show(10), frame=10)

    def test_a_bad_mesh_fails_before_anything_is_touched(self):
        done = State(Phase.DONE, 10, 10)
        s, _ = transition(done, bs.Bake(20))
        self.expect(s, bs.Checked("no faces"), Phase.FAILED, problem="no faces", frame=10, total=10)
        s, _ = run(done, bs.Bake(20), bs.Checked())
        self.expect(s, bs.Captured("topology"), Phase.FAILED, problem="topology", frame=10, total=10)

    def test_cancel_before_the_worker_leaves_all_as_it_was(self):
        for before in (State(), State(Phase.DONE, 10, 10), State(Phase.STOPPED, 4, 10)):
            s, _ = transition(before, bs.Bake(20))
            self.expect(s, bs.Cancel(), before.phase, bs.Abandon(), frame=before.frame, total=before.total)
            s, _ = transition(s, bs.Checked())
            after = self.expect(s, bs.Cancel(), before.phase, bs.Abandon())
            self.assertEqual(after, before)

    def test_cancel_of_the_worker_can_be_resumed(self):
        running = State(Phase.RUNNING, 4, 10)
        s = self.expect(running, bs.Cancel(), Phase.STOPPING, bs.Interrupt())
        self.expect(s, bs.Cancel(), Phase.STOPPING, bs.Kill())
        s = self.expect(s, bs.Progressed(5), Phase.STOPPING, bs.Show(5))
        s = self.expect(s, bs.WorkerEnded(130, 5), Phase.STOPPED, bs.Show(5), frame=5)
        self.assertTrue(s.resumable)
        s = self.expect(s, bs.Resume(), Phase.RUNNING, bs.StartWorker(None))
        self.expect(s, bs.WorkerEnded(0, 10), Phase.DONE, bs.Show(10))

    def test_a_killed_worker_can_be_resumed_and_says_so(self):
        s = self.expect(State(Phase.RUNNING, 4, 10), bs.WorkerEnded(-9, 4), Phase.FAILED, bs.Show(4))
        self.assertIn("signal 9", s.problem)
        self.assertIn("Resume", s.problem)
        self.assertTrue(s.resumable)
        s = self.expect(State(Phase.RUNNING, -1, 10), bs.WorkerEnded(-9, -1), Phase.FAILED)
        self.assertFalse(s.resumable)
        self.assertNotIn("Resume", s.problem)

    def test_an_error_of_the_engine_is_shown_and_its_frames_stay(self):
        s = self.expect(State(Phase.RUNNING, 4, 10), bs.WorkerEnded(4, 5, "raise steps"), Phase.FAILED, bs.Show(5))
        self.assertEqual(s.problem, "raise steps")
        s, _ = transition(State(Phase.RUNNING, 4, 10), bs.WorkerEnded(3, 5))
        self.assertIn("code 3", s.problem)

    def test_baking_on_from_a_frame_keeps_those_before(self):
        done = State(Phase.DONE, 10, 10)
        s = self.expect(done, bs.BakeFrom(4, 12), Phase.CHECKING, bs.StartCheck(), origin=4, frame=10)
        s, _ = transition(s, bs.Checked())
        self.expect(s, bs.Captured(), Phase.RUNNING, bs.Show(4), bs.StartWorker(4), frame=4, total=12)

    def test_baking_on_needs_a_baked_frame_that_is_not_the_last(self):
        for state, event in [(State(), bs.BakeFrom(0, 10)), (State(Phase.DONE, 10, 10), bs.BakeFrom(11, 20)),
                             (State(Phase.DONE, 10, 10), bs.BakeFrom(-3, 20)),
                             (State(Phase.DONE, 10, 10), bs.BakeFrom(10, 10))]:
            after, effects = transition(state, event)
            self.assertEqual(after, state)
            self.assertIsInstance(effects[0], bs.Tell)

    def test_nothing_starts_while_a_bake_is_in_work(self):
        for phase in bs.BUSY:
            state = State(phase, 4, 10, 10)
            for event in (bs.Bake(10), bs.BakeFrom(2, 10), bs.Resume(), bs.Free()):
                after, effects = transition(state, event)
                self.assertEqual(after, state, (phase, event))
                self.assertIsInstance(effects[0], bs.Tell)

    def test_free_forgets(self):
        for phase in set(Phase) - bs.BUSY:
            self.expect(State(phase, 4, 10, problem="x"), bs.Free(), Phase.EMPTY, bs.RemoveBake(), frame=-1, problem="")

    def test_opening_a_file_finds_what_is_there(self):
        self.expect(State(), bs.Opened(), Phase.EMPTY)
        self.expect(State(), bs.Opened(10, 10), Phase.DONE, frame=10)
        self.expect(State(), bs.Opened(4, 10), Phase.STOPPED, frame=4)
        self.expect(State(), bs.Opened(4, 10, alive=True), Phase.RUNNING, frame=4)
        self.expect(State(), bs.Opened(4, 10, problem="why"), Phase.FAILED, problem="why")
        self.expect(State(), bs.Opened(14, 10), Phase.DONE, frame=10)

    def test_what_comes_late_changes_nothing(self):
        late = [bs.Checked(), bs.Checked("x"), bs.Captured(), bs.Captured("x"), bs.Progressed(3), bs.WorkerEnded(0, 3)]
        for phase in set(Phase) - bs.BUSY:
            for event in late:
                state = State(phase, 4, 10)
                self.assertEqual(transition(state, event), (state, ()))

    def test_an_unknown_event_is_a_bug(self):
        with self.assertRaises(TypeError):
            transition(State(), "bake")


class Properties(unittest.TestCase):
    def check(self, state):
        self.assertLessEqual(-1, state.frame)
        self.assertLessEqual(state.frame, state.total)
        if state.phase == Phase.EMPTY:
            self.assertEqual(state.frame, -1)
        if state.phase == Phase.DONE:
            self.assertEqual(state.frame, state.total)
        if state.phase == Phase.STOPPED:
            self.assertTrue(state.resumable)
        self.assertEqual(state.phase == Phase.FAILED, state.problem != "")
        if not state.busy:
            self.assertEqual((state.next_total, state.origin), (0, bs.FRESH))

    def test_any_event_in_any_state(self):
        """All pairs that four events lead to; the opening of a file is among them."""
        reached, edge = set(), {State()}
        for _ in range(4):
            edge = {transition(s, e)[0] for s in edge for e in EVENTS} - reached
            reached |= edge
        self.assertGreater(len(reached), 30)
        self.assertEqual({s.phase for s in reached}, set(Phase))
        for state in reached:
            self.check(state)

    def test_random_walks_keep_one_activity_at_a_time(self):
        """The world does what the effects say and answers in its own time; the artist presses anything."""
        for seed in range(400):
            self.walk(random.Random(seed))

    def walk(self, rng):
        state, activity, frame = State(), None, -1
        for _ in range(60):
            if activity and rng.random() < 0.6:
                event, activity, frame = self.answer(rng, activity, frame, state)
            else:
                total = rng.randrange(0, 9)
                event = rng.choice([bs.Bake(total), bs.BakeFrom(rng.randrange(-1, 9), total), bs.Resume(), bs.Cancel(),
                                    bs.Free()])
            state, effects = transition(state, event)
            for effect in effects:
                if isinstance(effect, (bs.StartCheck, bs.StartCapture, bs.StartWorker)):
                    self.assertIsNone(activity, "two things at once")
                    activity = type(effect)
                if isinstance(effect, bs.StartWorker):
                    frame = frame if effect.origin is None else effect.origin
                if isinstance(effect, bs.Abandon):
                    self.assertIn(activity, (bs.StartCheck, bs.StartCapture))
                    activity = None
                if isinstance(effect, (bs.Interrupt, bs.Kill)):
                    self.assertEqual(activity, bs.StartWorker)
                if isinstance(effect, bs.RemoveBake):
                    self.assertIsNone(activity, "files taken from under the worker")
                    frame = -1
                if isinstance(effect, bs.Show):
                    self.assertLessEqual(effect.frame, max(frame, state.frame))
            self.assertEqual(state.busy, activity is not None)
            self.check(state)

    def answer(self, rng, activity, frame, state):
        if activity is bs.StartCheck:
            return bs.Checked(rng.choice(["", "", "bad"])), None, frame
        if activity is bs.StartCapture:
            return bs.Captured(rng.choice(["", "", "bad"])), None, frame
        if rng.random() < 0.5 and frame < state.total:
            return bs.Progressed(frame + 1), activity, frame + 1
        code = rng.choice([0, 130, 3, 4, 5, -9])
        frame = state.total if code == 0 else frame
        return bs.WorkerEnded(code, frame, "" if code in (0, 130) else "bad"), None, frame

    def test_states_and_events_are_values(self):
        for cls in (State, *[type(e) for e in EVENTS]):
            self.assertTrue(dataclasses.is_dataclass(cls))
            hash(cls(**{f.name: 1 for f in dataclasses.fields(cls)}))


if __name__ == "__main__":
    unittest.main()
