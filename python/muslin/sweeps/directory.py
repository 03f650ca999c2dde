"""The directory of a sweep: its description, its lock, and the results of its runs."""

import json
import os
import pickle
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

from muslin.errors import FileError, InputError, UsageError
from muslin.sweeps.description import Description
from muslin.sweeps.points import Point

try:
    import fcntl
except ImportError:  # not on every system
    fcntl = None  # type: ignore[assignment]

AGAIN = (5, 130)
"""Exit codes of runs that are tried again when the sweep continues, besides those of lost workers."""


class SweepDirectory:
    """The files of a sweep. One process at a time has it; its workers keep the lock until they end."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lock: IO[str] | None = None

    def open(self, description: Description) -> None:
        """Begins the sweep, or finds the one that is there. Errors: input, if it has another description."""
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            self._take_lock()
        except OSError as error:
            raise FileError(error.strerror or str(error), "check the path", str(self.path)) from None
        now = _as_read(description.facts() | {"keys": description.keys})
        file = self.path / "sweep.json"
        if file.exists():
            self._compare(read_json(file), now, description)
            return
        others = sorted({entry.name for entry in self.path.iterdir()} - {"sweep.lock"})
        if others:
            problem = f"the directory is not empty and holds no sweep (it has {others[0]})"
            raise FileError(problem, "choose an empty or a new directory with -o", str(self.path))
        if description.meshes:
            write_atomically(self.path / "meshes.pickle", pickle.dumps(description.meshes))
        points = None if description.search else description.points()
        content = {"title": description.title, "facts": now, "points": points}
        write_atomically(file, json.dumps(content, indent=1).encode())

    def close(self) -> None:
        """Releases the lock."""
        if self.lock:
            self.lock.close()
        self.lock = None

    def points(self) -> list[Point]:
        """The points that were drawn when the sweep began."""
        return list(read_json(self.path / "sweep.json")["points"])

    def run(self, number: int) -> Path:
        """The run directory of a run; runs count from 1."""
        return self.path / "runs" / f"{number:04d}"

    def result_file(self, number: int) -> Path:
        """The file with the result of a run, beside its directory."""
        return self.path / "runs" / f"{number:04d}.json"

    def result(self, number: int) -> dict[str, Any] | None:
        """The result of a run that has ended."""
        file = self.result_file(number)
        return read_json(file) if file.exists() else None

    def is_done(self, number: int) -> bool:
        """Whether a run has ended in a way that another try would not change."""
        result = self.result(number)
        return result is not None and result["exit_code"] not in AGAIN and result["exit_code"] < 128

    def _take_lock(self) -> None:
        file = open(self.path / "sweep.lock", "w")  # noqa: SIM115  (kept open)
        if fcntl:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                file.close()
                raise FileError(
                    "another process is running this sweep",
                    "wait for it or choose another directory with -o",
                    str(self.path),
                ) from None
        self.lock = file

    def _compare(self, kept: Mapping[str, Any], now: dict[str, Any], description: Description) -> None:
        before, file = kept["facts"], str(self.path / "sweep.json")
        for name in [*now, *(key for key in before if key not in now)]:
            old, new = before.get(name), now.get(name)
            if old == new:
                continue
            if isinstance(old, dict) and isinstance(new, dict):
                key = next(k for k in [*new, *old] if old.get(k) != new.get(k))
                name, old, new = f"{name}.{key}", old.get(key), new.get(key)
            change = f" ({_short(old)} then, {_short(new)} now)" if name not in ("scene", "meshes") else ""
            problem = f"`{name}` is not that of the sweep in this directory{change}"
            raise InputError(problem, f"choose another directory with -o, or delete {self.path}", file)


def read_json(file: Path) -> Any:
    """The content of a JSON file."""
    try:
        return json.loads(file.read_text())
    except OSError as error:
        raise FileError(error.strerror or str(error), "check the path", str(file)) from None
    except ValueError as error:
        raise InputError(
            f"this is not JSON: {error}", "delete the file; its run is repeated", str(file)
        ) from None


def write_atomically(file: Path, content: bytes) -> None:
    """Writes a file that is there as a whole or not at all."""
    part = file.with_name(file.name + ".part")
    try:
        part.write_bytes(content)
        os.replace(part, file)
    except OSError as error:
        raise FileError(error.strerror or str(error), "check the disk and the path", str(file)) from None


def _as_read(facts: dict[str, Any]) -> dict[str, Any]:
    try:
        read: dict[str, Any] = json.loads(json.dumps(facts))
    except TypeError as error:
        raise UsageError(
            f"a value is none of the scene file: {error}", "use numbers, texts, lists, tables"
        ) from None
    return read


def _short(value: Any) -> str:
    if value is None:
        return "absent"
    if isinstance(value, list) and len(value) > 4:
        return f"{len(value)} values"
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "…"
