"""The table of results: one row per run."""

import csv
import io
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from muslin.sweeps.description import Row
from muslin.sweeps.directory import write_atomically
from muslin.sweeps.points import Point
from muslin.tables import to_value

TIMES = ("wall_seconds",)
"""Columns that differ between repetitions of a run."""


def row_of(number: int, point: Point, result: dict[str, Any] | None) -> Row:
    """The row of a run; without a result its status is "missing"."""
    row: Row = {"run": number, **{key: _cell(value) for key, value in point.items()}}
    if result is None:
        return row | {"status": "missing", "exit_code": None, "message": "", "warnings": None, "frames": None}
    row |= {"status": "finished" if result["exit_code"] == 0 else "failed", "exit_code": result["exit_code"]}
    row |= {"message": result["message"], "warnings": len(result["warnings"]), "frames": result["frames"]}
    row |= result["values"]
    return row


def columns_of(rows: Iterable[Row]) -> list[str]:
    """The columns of all rows, in the order of their first occurrence, times last."""
    found = dict.fromkeys(key for row in rows for key in row)
    return [key for key in found if key not in TIMES] + [key for key in found if key in TIMES]


def write_csv(file: Path, rows: list[Row]) -> None:
    """Writes the table as CSV; cells without a value are empty."""
    columns, text = columns_of(rows), io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    for row in rows:
        writer.writerow([_text(row.get(column)) for column in columns])
    write_atomically(file, text.getvalue().encode())


def write_parquet(file: Path, rows: list[Row]) -> bool:
    """Writes the table as Parquet if pyarrow is installed."""
    try:
        import pyarrow  # type: ignore[import-untyped, import-not-found, unused-ignore]
        import pyarrow.parquet  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ImportError:
        return False
    columns = {column: _uniform([row.get(column) for row in rows]) for column in columns_of(rows)}
    part = file.with_name(file.name + ".part")
    pyarrow.parquet.write_table(pyarrow.table(columns), part)
    part.replace(file)
    return True


def _cell(value: Any) -> Any:
    """A swept value as a cell: lists and tables as the text of TOML."""
    return to_value(value, "value") if isinstance(value, list | dict) else value


def _text(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and math.isfinite(value) and value == int(value) and abs(value) < 1e15:
        return str(int(value))
    return str(value)


def _uniform(values: list[Any]) -> list[Any]:
    """Values of one type: numbers, or all of them as texts."""
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int}:
        return values
    if kinds <= {int, float}:
        return [None if value is None else float(value) for value in values]
    return values if len(kinds) <= 1 else [None if value is None else _text(value) for value in values]
