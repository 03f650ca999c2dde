"""A pool on a Ray cluster whose nodes share the folder of the sweep.

Ray starts a task again when its worker or its node is lost; the task continues the run from its last
checkpoint.
"""

import logging
import signal
import socket
import threading
import time
from collections.abc import Callable, Iterable
from typing import Any

from muslin._muslin import set_thread_count
from muslin.errors import FileError, Interrupted, UsageError
from muslin.sweeps.job import Job, execute
from muslin.sweeps.pool import MOST_LOSSES, Progress, give_up

GRACE = 60.0
"""Seconds in which tasks that are asked to stop may finish their time step."""


class RayPool:
    """Executes each job as a task of ``threads`` CPUs."""

    def __init__(self, address: str, threads: int) -> None:
        try:
            import ray  # type: ignore[import-untyped, import-not-found, unused-ignore]
        except ImportError:
            raise UsageError("the package ray is not installed", "pip install muslin[sweep]") from None
        self._ray: Any = ray
        self._began = not ray.is_initialized()
        handler = signal.getsignal(signal.SIGTERM)
        try:
            if self._began:
                _knock(address)
                cluster = None if address == "local" else address
                ray.init(cluster, log_to_driver=False, logging_level=logging.WARNING)
        except (OSError, ValueError, RuntimeError) as error:
            remedy = "start one with `ray start --head`, or name its address"
            raise FileError(f"there is no Ray cluster at `{address}`: {error}", remedy) from None
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, handler)  # Ray has set its own, which ends the process at once
        task = ray.remote(num_cpus=threads, max_retries=MOST_LOSSES - 1)(_execute)
        self._submit: Callable[[Job], Any] = lambda job: task.remote(job, threads)
        self._tasks: dict[Any, Job] = {}

    def run(self, jobs: Iterable[Job], progress: Progress, cancel: Callable[[], bool] | None) -> None:
        """Executes all jobs."""
        errors = self._ray.exceptions
        self._tasks = {self._submit(job): job for job in jobs}
        while self._tasks:
            ended, _ = self._ray.wait(list(self._tasks), num_returns=1, timeout=0.2)
            for task in ended:
                job = self._tasks.pop(task)
                try:
                    self._ray.get(task)
                except errors.TaskCancelledError:
                    raise Interrupted("a task was cancelled", "run the sweep again to continue it") from None
                except errors.RayError as error:
                    give_up(job, 128, str(error).split("\n")[0])
                progress.done(job.number)
            if cancel and cancel():
                raise Interrupted("stopped", "run the sweep again to continue it")

    def close(self) -> None:
        """Cancels the tasks, whose runs can be continued; leaves the cluster if this pool has joined it."""
        for task in self._tasks:
            self._ray.cancel(task)
        end = time.monotonic() + GRACE
        if self._tasks:
            self._ray.wait(
                list(self._tasks), num_returns=len(self._tasks), timeout=max(end - time.monotonic(), 0)
            )
        self._tasks = {}
        if self._began:
            self._ray.shutdown()


def _knock(address: str) -> None:
    """Raises an OSError if nothing listens at HOST:PORT; Ray would try for minutes."""
    host, _, port = address.rpartition("://")[2].rpartition(":")
    if host and port.isdigit():
        socket.create_connection((host, int(port)), timeout=10).close()


def _execute(job: Job, threads: int) -> None:
    set_thread_count(threads)
    execute(job)
