"""A run of a sweep as a job: what any process with the package and the files can execute."""

import json
import pickle
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from muslin import _muslin
from muslin.errors import Error, FileError, Interrupted
from muslin.sweeps.directory import write_atomically
from muslin.sweeps.outcome import read_outcome

PICTURE_SIZE = (192, 108)
WAIT_FOR_LOCK = 120.0
"""Seconds after which a run that another process writes is given up; a lost machine takes a while to go."""

Report = Callable[[int, int], object]
"""Receives the finished frames and the last frame."""


@dataclass(frozen=True)
class Job:
    """A run to execute. It can be pickled, and written as JSON; paths are absolute."""

    number: int
    text: str
    """The scene file."""
    file: str
    """The path of the scene file, which its paths are relative to."""
    overrides: list[str]
    directory: str
    result: str
    frames: int | None = None
    meshes: str = ""
    """A file of meshes in place of those of paths in the scene."""
    pictures: bool = True
    pages: tuple[str, ...] = ()


def execute(
    job: Job, report: Report | None = None, cancel: Callable[[], bool] | None = None
) -> dict[str, Any]:
    """Runs a job, or continues it, and writes its result.

    Errors of the scene, the solver and files are part of the result. Raises ``Interrupted`` if ``cancel``
    returns true; the job can be executed again.
    """
    result: dict[str, Any] = {"run": job.number, "exit_code": 0, "message": "", "warnings": []}
    begin = time.monotonic()
    try:
        result["warnings"] = _run(job, report, cancel).warnings
    except Interrupted:
        raise
    except Error as error:
        sweep = f"{Path(job.directory).parent.parent}/"
        result |= {"exit_code": error.exit_code, "message": str(error).replace(sweep, "")}
    result |= {"overrides": job.overrides, "seconds": time.monotonic() - begin}
    result |= read_outcome(Path(job.directory))
    result["files"] = _pictures_and_pages(job) if result["frames"] > 0 else []
    write_result(Path(job.result), result)
    return result


def write_result(file: Path, result: dict[str, Any]) -> None:
    """Writes the result of a run."""
    file.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(file, json.dumps(result).encode())


def _run(job: Job, report: Report | None, cancel: Callable[[], bool] | None) -> _muslin.RunResult:
    meshes = _meshes(job.meshes) if job.meshes else {}
    scene = _muslin.parse_scene(job.text, job.file, job.overrides, meshes=meshes)
    begin = time.monotonic()

    def progress(now: _muslin.RunProgress) -> None:
        if report:
            report(now.frame, now.total)

    while True:
        try:
            return _muslin.run(
                scene, job.directory, frames=job.frames, resume=True, progress=progress, cancel=cancel
            )
        except FileError as error:
            if "another process is writing" not in error.problem or time.monotonic() - begin > WAIT_FOR_LOCK:
                raise
        if cancel and cancel():
            raise Interrupted("stopped", "run the sweep again")
        time.sleep(0.2)


@lru_cache(maxsize=1)
def _meshes(file: str) -> dict[str, _muslin.Mesh]:
    meshes: dict[str, _muslin.Mesh] = pickle.loads(Path(file).read_bytes())
    return meshes


def _pictures_and_pages(job: Job) -> list[str]:
    """Writes what the page of the sweep shows of a run; returns the names. A failure leaves out the rest."""
    made = []
    try:
        if job.pictures:
            pictures = _muslin.RunPictures(job.directory, size=PICTURE_SIZE, samples=2)
            pictures.write(Path(job.directory) / "picture.png")
            made.append("picture.png")
        run = _muslin.Run(job.directory)
        for page in job.pages:
            file = Path(job.directory) / f"{page}.html"
            if page == "report":
                _muslin.write_report(run, file, json=file.with_suffix(".json"), pictures=False)
            else:
                _muslin.write_view(run, file)
            made.append(file.name)
    except Error:
        pass
    return made
