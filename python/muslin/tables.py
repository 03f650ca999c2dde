"""Scenes from Python tables: the words of the scene file as dictionaries, lists, numbers and meshes."""

import math
import numbers
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from muslin._muslin import Mesh, Scene, parse_scene
from muslin.errors import Error, UsageError


def make_scene(
    tables: Mapping[str, Any] | None = None,
    *,
    folder: str | os.PathLike[str] = ".",
    overrides: Iterable[str] = (),
    **more: Any,
) -> Scene:
    """A scene from the tables of the scene file, checked as a file would be.

    ``make_scene(title="flag", time={"duration": 2}, body=[{"mesh": mesh, ...}], force=[{"type": "gravity"}])``

    A ``mesh`` or ``rest_mesh`` may be a ``muslin.Mesh`` in place of a path; paths are relative to ``folder``. numpy
    arrays and numbers count as lists and numbers; ``None`` leaves a key out. Errors name the entry, as in
    ``body[0].mesh``. ``muslin.scene_types`` has the types of the tables.
    """
    meshes: dict[str, Mesh] = {}
    content = _with_paths({**_tables(tables), **more}, meshes)
    text, file = to_toml(content), Path(folder) / "scene.toml"
    try:
        return parse_scene(text, file, list(overrides), meshes=meshes)
    except Error as error:
        if error.line == 0 or error.file != str(file):
            raise
        raise type(error)(error.problem, error.remedy, f"make_scene: {_entry_at(text, error.line)}") from None


def _entry_at(text: str, line: int) -> str:
    """The entry of a line of such a text as Python names it, such as body[0].mesh; lines count from 1."""
    lines = text.split("\n")[:line]
    headings = [entry for entry in lines if entry.startswith("[")]
    key = lines[-1].partition(" = ")[0]
    if not headings:
        return key
    table = headings[-1].strip("[]")
    if headings[-1].startswith("[["):
        table += f"[{headings.count(headings[-1]) - 1}]"
    return table if lines[-1].startswith("[") else f"{table}.{key}"


def to_toml(tables: Mapping[str, Any]) -> str:
    """The text of a scene file with these tables."""
    tables = _tables(tables)
    lines = [f"{_key(key)} = {to_value(value, key)}" for key, value in tables.items() if _is_value(value)]
    for key, value in tables.items():
        if isinstance(value, Mapping):
            lines += ["", f"[{_key(key)}]", *_entries(value, key)]
        elif value is not None and not _is_value(value):
            for table in value:
                lines += ["", f"[[{_key(key)}]]", *_entries(table, key)]
    return "\n".join(lines).lstrip("\n") + "\n"


def _tables(tables: object) -> Mapping[str, Any]:
    if tables is None:
        return {}
    if not isinstance(tables, Mapping):
        raise UsageError(f"the tables are a {type(tables).__name__}", "give a dictionary, as in {'title': 'flag'}")
    return tables


def _with_paths(value: Any, meshes: dict[str, Mesh]) -> Any:
    """Returns the tables with each mesh replaced by a path, under which it is stored in ``meshes``."""
    if isinstance(value, Mesh):
        path = f"{value.name or 'mesh'}.{len(meshes)}"
        meshes[path] = value
        return path
    if isinstance(value, Mapping):
        return {key: _with_paths(item, meshes) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_with_paths(item, meshes) for item in value]
    return value


def _is_value(value: Any) -> bool:
    """Returns true if the value is written after ``key =`` and not under a heading."""
    if value is None or isinstance(value, Mapping):
        return False
    return not (isinstance(value, list | tuple) and value and all(isinstance(item, Mapping) for item in value))


def _entries(table: Mapping[str, Any], title: str) -> list[str]:
    return [f"{_key(key)} = {to_value(value, f'{title}.{key}')}" for key, value in table.items() if value is not None]


def _key(key: object) -> str:
    if not isinstance(key, str):
        raise UsageError(f"the key {key!r} is not a text", "use the words of the scene file")
    return key if key and all(c.isascii() and (c.isalnum() or c in "_-") for c in key) else _text(key)


def _text(text: str) -> str:
    escapes = {'"': '\\"', "\\": "\\\\"}
    return '"' + "".join(escapes.get(c, c if c.isprintable() else _escape(c)) for c in text) + '"'


def _escape(c: str) -> str:
    return f"\\u{ord(c):04x}" if ord(c) < 0x10000 else f"\\U{ord(c):08x}"


def to_value(value: Any, name: str) -> str:
    """The text of a value in TOML; `name` is what errors call it."""
    if hasattr(value, "tolist"):  # numpy's arrays and numbers
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        number = float(value)
        return repr(number) if math.isfinite(number) else str(number)
    if isinstance(value, str | os.PathLike):
        return _text(os.fspath(value))
    if isinstance(value, Mapping):
        items = [f"{_key(k)} = {to_value(v, f'{name}.{k}')}" for k, v in value.items() if v is not None]
        return "{ " + ", ".join(items) + " }" if items else "{}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(to_value(item, name) for item in value) + "]"
    raise UsageError(f"`{name}` is a {type(value).__name__}", "use numbers, texts, lists, dictionaries or meshes")
