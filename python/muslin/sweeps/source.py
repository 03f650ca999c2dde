"""The tables of a sweep as they were given, a file or Python's, with the place of each key for errors."""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import muslin._muslin
from muslin.errors import InputError, UsageError

# Private functions of the engine, which its stub leaves out.
_read_toml: Callable[[Path], tuple[dict[str, Any], dict[str, tuple[int, int]]]] = getattr(
    muslin._muslin, "_read_toml"
)
name_advice: Callable[[str, list[str]], str] = getattr(muslin._muslin, "_name_advice")


@dataclass
class Source:
    """Tables, and where their keys are. Paths of keys are dotted; items of lists are ``KEY[0]``."""

    tables: dict[str, Any]
    folder: Path
    """Paths in the tables are relative to it."""
    file: str = ""
    """Empty for tables from Python."""
    places: dict[str, tuple[int, int]] = field(default_factory=dict)

    def error(self, key: str, problem: str, remedy: str) -> InputError:
        """An error in the value of a key, at its line of the file or by its name."""
        if not self.file:
            return InputError(problem, remedy, f"sweep: {key}" if key else "sweep")
        line, column = self.places.get(key, (0, 0))
        return InputError(problem, remedy, self.file, line, column)

    def refuse_unknown(self, table: Mapping[str, Any], path: str, known: Iterable[str]) -> None:
        """Raises an error for the first key of a table that is not known."""
        names = list(known)
        for key in table:
            if key not in names:
                raise self.error(joined(path, key), f"there is no key `{key}` here", name_advice(key, names))

    def table(self, value: Any, path: str) -> dict[str, Any]:
        """The value, which must be a table."""
        if not isinstance(value, Mapping):
            raise self.error(path, f"`{path}` is {described(value)}", "write a table of scene keys")
        return dict(value)

    def values(self, value: Any, path: str) -> list[Any]:
        """The value, which must be a list that is not empty."""
        if not isinstance(value, list):
            raise self.error(path, f"`{path}` is {described(value)}", "give a list of values, as in [1, 2]")
        if not value:
            raise self.error(path, f"`{path}` has no values", "give at least one, or leave the key out")
        return value

    def text(self, value: Any, path: str) -> str:
        """The value, which must be a text."""
        if not isinstance(value, str):
            raise self.error(path, f"`{path}` is {described(value)}", "give a text")
        return value

    def word(self, value: Any, path: str, words: Iterable[str]) -> str:
        """The value, which must be one of some words."""
        names, text = list(words), self.text(value, path)
        if text not in names:
            raise self.error(path, f"`{text}` is no value of `{path}`", name_advice(text, names))
        return text

    def integer(self, value: Any, path: str, least: int) -> int:
        """The value, which must be a whole number of at least ``least``."""
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            shown = str(value) if isinstance(value, int) else described(value)
            raise self.error(path, f"`{path}` is {shown}", f"give a whole number of {least} or more")
        return value

    def truth(self, value: Any, path: str) -> bool:
        """The value, which must be true or false."""
        if not isinstance(value, bool):
            raise self.error(path, f"`{path}` is {described(value)}", "give true or false")
        return value


def read_file(file: str | os.PathLike[str]) -> Source:
    """The tables of a TOML file."""
    path = Path(file)
    tables, places = _read_toml(path)
    return Source(tables, path.parent, str(path), places)


def from_python(tables: Mapping[str, Any], folder: str | os.PathLike[str] = ".") -> Source:
    """Tables from Python, numpy's arrays and numbers converted to lists and numbers."""
    return Source(
        {key: _plain(value, key) for key, value in tables.items() if value is not None}, Path(folder)
    )


def joined(path: str, key: str) -> str:
    """The dotted path of a key in a table."""
    return f"{path}.{key}" if path else key


def described(value: Any) -> str:
    """The kind of a value, in words."""
    kinds = {
        bool: "true or false",
        int: "a number",
        float: "a number",
        str: "a text",
        list: "a list",
        dict: "a table",
    }
    return kinds.get(type(value), f"a {type(value).__name__}")


def _plain(value: Any, path: str) -> Any:
    if hasattr(value, "tolist"):  # numpy's arrays and numbers
        value = value.tolist()
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                raise UsageError(
                    f"the key {key!r} in `{path}` is not a text", "use the keys of the scene file"
                )
        return {key: _plain(item, joined(path, key)) for key, item in value.items() if item is not None}
    if isinstance(value, list | tuple | range):
        return [_plain(item, f"{path}[{i}]") for i, item in enumerate(value)]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value
