"""What executes the jobs of a sweep: processes of this machine, or a cluster."""

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Protocol

from muslin.sweeps.job import Job, write_result

MOST_LOSSES = 5
"""A run is given up when so many of its workers were lost at the same frame."""


class Progress(Protocol):
    """Receives what happens to runs."""

    def frame(self, number: int, frame: int, last: int) -> None:
        """A run has finished a frame."""

    def done(self, number: int, kept: bool = False) -> None:
        """A run has a result, now or from earlier."""

    def lost(self, number: int, reason: str) -> None:
        """The worker of a run was lost; another one continues it."""


class Pool(Protocol):
    """Executes jobs."""

    def run(self, jobs: Iterable[Job], progress: Progress, cancel: Callable[[], bool] | None) -> None:
        """Executes all jobs. Raises ``Interrupted`` if ``cancel`` returns true; jobs can be continued."""

    def close(self) -> None:
        """Stops what still runs, in a way that can be continued."""


def cores() -> int:
    """The cores that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1


def give_up(job: Job, exit_code: int, reason: str) -> None:
    """Writes the result of a job whose workers are lost again and again."""
    message = f"given up after {MOST_LOSSES} lost workers: {reason}; run the sweep again to try once more"
    result = {"run": job.number, "exit_code": exit_code, "message": message, "warnings": [], "frames": 0}
    result |= {"values": {}, "curves": {}, "overrides": job.overrides, "files": []}
    write_result(Path(job.result), result)
