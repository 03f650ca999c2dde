"""A pool of processes on this machine. A process that is lost is replaced, and its run continued."""

import json
import os
import selectors
import signal
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import asdict
from pathlib import Path
from typing import IO

import muslin
from muslin.errors import Interrupted, SolverError
from muslin.sweeps.job import Job
from muslin.sweeps.pool import MOST_LOSSES, Progress, give_up

GRACE = 60.0
"""Seconds in which a process that is asked to stop may finish its time step."""


class _Worker:
    """A process of ``muslin.sweeps.worker``: jobs go in as lines of JSON, lines of words come out."""

    def __init__(self, threads: int, log: IO[bytes], kept: list[int]) -> None:
        package = str(Path(muslin.__file__).parent.parent)
        path = os.pathsep.join([package, *filter(None, [os.environ.get("PYTHONPATH")])])
        self.process = subprocess.Popen(
            [sys.executable, "-m", "muslin.sweeps.worker", str(threads)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=log,
            env=os.environ | {"PYTHONPATH": path},
            pass_fds=kept,
            start_new_session=True,  # Ctrl-C reaches this process only
        )
        self.job: Job | None = None
        self.frame = -1
        self.ready = False
        self._text = b""

    def start(self, job: Job) -> None:
        assert self.process.stdin
        self.job, self.frame = job, -1
        try:
            self.process.stdin.write(json.dumps(asdict(job)).encode() + b"\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # lost; the end of its output says so

    def lines(self) -> list[list[str]] | None:
        """The words of the lines that have arrived; None if the process has ended."""
        assert self.process.stdout
        read = os.read(self.process.stdout.fileno(), 65536)
        if not read:
            return None
        *whole, self._text = (self._text + read).split(b"\n")
        return [line.decode().split() for line in whole]


class ProcessPool:
    """Executes jobs in ``count`` processes of ``threads`` threads each."""

    def __init__(self, count: int, threads: int, log: Path, lock: IO[str] | None = None) -> None:
        self._count, self._threads = count, threads
        self._log = open(log, "ab")  # noqa: SIM115  (closed by close)
        self._kept = [lock.fileno()] if lock else []
        self._workers: list[_Worker] = []
        self._selector = selectors.DefaultSelector()

    def run(self, jobs: Iterable[Job], progress: Progress, cancel: Callable[[], bool] | None) -> None:
        """Executes all jobs."""
        queue, losses = deque(jobs), dict[int, list[int]]()
        while queue or any(worker.job for worker in self._workers):
            while queue:
                worker = next((w for w in self._workers if not w.job), None) or self._new_worker()
                if worker is None:
                    break
                worker.start(queue.popleft())
            for key, _ in self._selector.select(timeout=0.2):
                worker = key.data
                lines = worker.lines()
                if lines is None:
                    self._replace(worker, queue, losses, progress)
                else:
                    self._hear(worker, lines, progress)
            if cancel and cancel():
                raise Interrupted("stopped", "run the sweep again to continue it")

    def close(self) -> None:
        """Asks the processes to stop, and waits for them."""
        for worker in self._workers:
            if worker.process.stdin:
                try:
                    worker.process.stdin.close()
                except BrokenPipeError:
                    pass
        end = time.monotonic() + GRACE
        try:
            for worker in self._workers:
                try:
                    worker.process.wait(max(end - time.monotonic(), 0))
                except subprocess.TimeoutExpired:
                    worker.process.kill()
        except KeyboardInterrupt:  # a second Ctrl-C
            for worker in self._workers:
                worker.process.kill()
            raise
        finally:
            for worker in self._workers:
                worker.process.wait()
                if worker.process.stdout:
                    worker.process.stdout.close()
            self._workers.clear()
            self._selector.close()
            self._log.close()

    def _new_worker(self) -> _Worker | None:
        if len(self._workers) >= self._count:
            return None
        worker = _Worker(self._threads, self._log, self._kept)
        assert worker.process.stdout
        self._workers.append(worker)
        self._selector.register(worker.process.stdout, selectors.EVENT_READ, worker)
        return worker

    def _hear(self, worker: _Worker, lines: list[list[str]], progress: Progress) -> None:
        for words in lines:
            if words[:1] == ["ready"]:
                worker.ready = True
            elif worker.job and words[:1] == ["frame"]:
                worker.frame = int(words[1])
                progress.frame(worker.job.number, int(words[1]), int(words[2]))
            elif worker.job and words[:1] == ["done"]:
                number, worker.job = worker.job.number, None
                progress.done(number)

    def _replace(
        self, worker: _Worker, queue: deque[Job], losses: dict[int, list[int]], progress: Progress
    ) -> None:
        """Forgets a lost process, and puts its job back to the front for the next one."""
        assert worker.process.stdout and worker.process.stdin
        self._selector.unregister(worker.process.stdout)
        self._workers.remove(worker)
        worker.process.stdout.close()
        try:
            worker.process.stdin.close()
        except BrokenPipeError:
            pass
        code = worker.process.wait()
        reason = f"killed by {_signal_name(-code)}" if code < 0 else f"ended with code {code}"
        if not worker.ready and code >= 0:
            raise SolverError(f"a worker cannot start, it {reason}", f"see {self._log.name}")
        job = worker.job
        if not job:
            return
        frames = losses.setdefault(job.number, [])
        frames.append(worker.frame)
        if frames.count(worker.frame) >= MOST_LOSSES:
            give_up(job, 128 - code if code < 0 else 128, reason)
            progress.done(job.number)
            return
        progress.lost(job.number, reason)
        queue.appendleft(job)


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
