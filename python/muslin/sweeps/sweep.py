"""``muslin.sweep``: executes the missing runs of a description, and writes the table and the page."""

import os
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from muslin.errors import InputError, UsageError
from muslin.sweeps.description import Description, Row, read_description
from muslin.sweeps.directory import SweepDirectory
from muslin.sweeps.job import Job
from muslin.sweeps.page import write_page
from muslin.sweeps.points import Point
from muslin.sweeps.pool import Pool, Progress, cores
from muslin.sweeps.processes import ProcessPool
from muslin.sweeps.source import from_python, read_file
from muslin.sweeps.table import columns_of, row_of, write_csv, write_parquet

BETWEEN_TABLES = 60.0
"""Seconds after which table and page are written again while runs end."""


@dataclass
class Sweep:
    """The runs of a sweep and their results."""

    directory: Path
    title: str
    keys: list[str]
    """The swept keys."""
    rows: list[Row]
    """One per run: the value of each column that the run has."""
    best: Row | None = None
    """Of a search: the row with the best objective."""
    lost: int = 0
    """Workers that were lost and replaced."""
    files: list[Path] = field(default_factory=list)
    """Table and page."""

    @property
    def columns(self) -> list[str]:
        """The columns of the table."""
        return columns_of(self.rows)

    def column(self, name: str) -> list[Any]:
        """A column; None where a run has no value."""
        return [row.get(name) for row in self.rows]

    @property
    def failed(self) -> list[Row]:
        """Rows of runs that ended with an error."""
        return [row for row in self.rows if row["status"] == "failed"]

    def __repr__(self) -> str:
        return f"<muslin.Sweep {self.directory}: {len(self.rows)} runs, {len(self.failed)} failed>"


def sweep(
    description: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    directory: str | os.PathLike[str] | None = None,
    *,
    workers: int | None = None,
    threads: int | None = None,
    ray: str | None = None,
    limit: int | None = None,
    progress: Callable[[int, int], object] | None = None,
    cancel: Callable[[], bool] | None = None,
    **more: Any,
) -> Sweep:
    """Runs a scene many times with other values of its keys, as ``muslin sweep`` does.

    ``muslin.sweep(scene="flag.toml", grid={"force.wind.velocity.0": [1, 2, 4]}, directory="out/wind")``

    description: a file, or its tables, which may also be given as keywords; ``scene`` may be a
    ``muslin.Scene``, and the objective of a search a function of a row. workers: processes (default: one per
    core); threads: of each (default: cores / workers). ray: the address of a Ray cluster, "auto" or "local",
    in place of processes. limit: the most runs allowed (default: 1000). progress(done, total) is called after
    each run.

    A directory with this sweep is continued; after Interrupted or KeyboardInterrupt too.
    """
    found = describe(description, more, limit=limit)
    place = Path(directory) if directory is not None else default_directory(description, found)
    report = _Count(found.count, progress)
    return run_sweep(found, place, workers=workers, threads=threads, ray=ray, progress=report, cancel=cancel)


def describe(
    description: str | os.PathLike[str] | Mapping[str, Any] | None,
    more: Mapping[str, Any],
    *,
    limit: int | None = None,
) -> Description:
    """The checked description of a file, or of tables and keywords."""
    if isinstance(description, str | os.PathLike):
        if more:
            raise UsageError(
                f"`{next(iter(more))}` is given besides a file", "write it into the file, or give tables only"
            )
        return read_description(read_file(description), limit=limit)
    if description is not None and not isinstance(description, Mapping):
        raise UsageError(f"the description is a {type(description).__name__}", "give a file or a dictionary")
    return read_description(from_python({**(description or {}), **more}), limit=limit)


def default_directory(description: object, found: Description) -> Path:
    """out/NAME of the file, or of the scene's file."""
    file = description if isinstance(description, str | os.PathLike) else found.scene.file
    return Path("out") / Path(file).stem


def jobs(
    description: str | os.PathLike[str] | Mapping[str, Any],
    directory: str | os.PathLike[str],
    *,
    limit: int | None = None,
) -> list[Job]:
    """The missing runs, to be executed by ``muslin.sweeps.execute`` anywhere, as by submitit on Slurm.

    Begins the sweep in the directory. ``muslin.sweep`` with the same description then writes table and page.
    """
    found = describe(description, {}, limit=limit)
    if found.search:
        raise UsageError("the runs of a search follow from their results", "run it by muslin.sweep")
    place = SweepDirectory(Path(directory).absolute())
    place.open(found)
    try:
        return [_job(found, place, number, point) for number, point in _missing(place, place.points())]
    finally:
        place.close()


def run_sweep(
    description: Description,
    directory: Path,
    *,
    workers: int | None,
    threads: int | None,
    ray: str | None,
    progress: Progress,
    cancel: Callable[[], bool] | None,
) -> Sweep:
    """Executes what is missing. Whatever ends it, table and page have the runs that are done."""
    for name, number in (("workers", workers), ("threads", threads)):
        if number is not None and number < 1:
            raise UsageError(f"{name} is {number}", "give 1 or more")
    proposer = _proposer(description)
    place = SweepDirectory(directory.absolute())
    place.open(description)
    try:
        session = _Session(description, place, progress)
        pool = _pool(description, place, workers, threads, ray)
        try:
            if proposer:
                _run_search(session, proposer, pool, cancel)
            else:
                session.points = place.points()
                session.execute(pool, cancel)
        finally:
            try:
                pool.close()
            finally:
                made = session.write()
        return made
    finally:
        place.close()


class _Session:
    """A sweep while it runs: counts for the caller, and writes table and page from time to time."""

    def __init__(self, description: Description, place: SweepDirectory, progress: Progress) -> None:
        self.description, self.place, self.progress = description, place, progress
        self.points: list[Point] = []
        self._written, self._lost = time.monotonic(), 0

    def execute(self, pool: Pool, cancel: Callable[[], bool] | None, first: int = 1) -> None:
        """Executes the points from number ``first`` on that have no result."""
        missing = _missing(self.place, self.points, first)
        there = {number for number, _ in missing}
        for number in range(first, len(self.points) + 1):
            if number not in there:
                self.progress.done(number, kept=True)
        if missing:
            pool.run([_job(self.description, self.place, n, point) for n, point in missing], self, cancel)

    def frame(self, number: int, frame: int, last: int) -> None:
        self.progress.frame(number, frame, last)

    def done(self, number: int, kept: bool = False) -> None:
        self.progress.done(number, kept)
        if time.monotonic() - self._written > BETWEEN_TABLES:
            self.write()

    def lost(self, number: int, reason: str) -> None:
        self._lost += 1
        self.progress.lost(number, reason)

    def rows(self, first: int = 1) -> list[Row]:
        numbers = range(first, len(self.points) + 1)
        return [row_of(n, self.points[n - 1], self.place.result(n)) for n in numbers]

    def write(self) -> Sweep:
        """Writes table and page."""
        rows, path, search = self.rows(), self.place.path, self.description.search
        files = [path / "table.csv", path / "index.html"]
        write_csv(files[0], rows)
        if write_parquet(path / "table.parquet", rows):
            files.insert(1, path / "table.parquet")
        best = None
        if search:
            from muslin.sweeps.search import best_of

            best = best_of(search, rows)
        write_page(path / "index.html", self.description, rows, self.place, best["run"] if best else None)
        self._written = time.monotonic()
        return Sweep(path, self.description.title, self.description.keys, rows, best, self._lost, files)


class _Count:
    """Calls a function with the number of runs that are done."""

    def __init__(self, total: int, call: Callable[[int, int], object] | None) -> None:
        self._done, self._total, self._call = 0, total, call

    def frame(self, number: int, frame: int, last: int) -> None:
        pass

    def done(self, number: int, kept: bool = False) -> None:
        self._done += 1
        if self._call:
            self._call(self._done, self._total)

    def lost(self, number: int, reason: str) -> None:
        pass


def _run_search(session: _Session, proposer: Any, pool: Pool, cancel: Callable[[], bool] | None) -> None:
    search = session.description.search
    assert search
    while len(session.points) < search.runs:
        first = len(session.points) + 1
        session.points += proposer.propose(min(search.batch, search.runs - len(session.points)))
        for number in range(first, len(session.points) + 1):
            kept = session.place.result(number)
            if kept and kept["overrides"] != session.description.overrides(session.points[number - 1]):
                raise InputError(
                    "the search proposes other values for this run than when it began",
                    "use the optuna and the objective of then, or choose another directory with -o",
                    str(session.place.result_file(number)),
                )
        session.execute(pool, cancel, first)
        proposer.learn(session.rows(first))


def _proposer(description: Description) -> Any:
    if not description.search:
        return None
    from muslin.sweeps.search import Proposer

    return Proposer(description.search)


def _missing(place: SweepDirectory, points: list[Point], first: int = 1) -> list[tuple[int, Point]]:
    numbered = list(enumerate(points, start=1))[first - 1 :]
    return [(number, point) for number, point in numbered if not place.is_done(number)]


def _job(description: Description, place: SweepDirectory, number: int, point: Point) -> Job:
    return Job(
        number=number,
        text=description.scene.text,
        file=str(Path(description.scene.file).absolute()),
        overrides=description.overrides(point),
        directory=str(place.run(number)),
        result=str(place.result_file(number)),
        frames=description.frames,
        meshes=str(place.path / "meshes.pickle") if description.meshes else "",
        pictures=description.pictures,
        pages=tuple(description.pages),
    )


def _pool(
    description: Description, place: SweepDirectory, workers: int | None, threads: int | None, ray: str | None
) -> Pool:
    if ray is not None:
        if workers is not None:
            raise UsageError(
                "workers are given for a Ray cluster", "leave them out; the cluster's CPUs decide"
            )
        from muslin.sweeps.on_ray import RayPool

        return RayPool(ray, threads or 1)
    count = min(workers or cores(), description.search.batch if description.search else description.count)
    return ProcessPool(count, threads or max(cores() // count, 1), place.path / "workers.log", place.lock)
