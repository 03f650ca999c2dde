"""The results of a run that a table can hold, read from its run directory."""

import csv
import json
import math
from pathlib import Path
from typing import Any

POINTS = 48
"""At most so many points are kept of each curve."""


def read_outcome(directory: Path) -> dict[str, Any]:
    """Diagnostics and probes at the last frame, convergence, extremes, curves; without what is missing."""
    table = _read(directory / "diagnostics.csv")
    outcome: dict[str, Any] = {"frames": max(len(table.get("frame", [])) - 1, 0), "values": {}, "curves": {}}
    values, curves = outcome["values"], outcome["curves"]
    if not table.get("frame"):
        return outcome
    shown = _shown(len(table["frame"]))
    for name, column in table.items():
        if name != "frame":
            values[name] = column[-1]
        if name in (
            "time",
            "kinetic",
            "elastic",
            "potential",
            "dissipated",
            "max_stretch",
            "min_distance",
            "error",
        ):
            curves[name] = [_rounded(column[i]) for i in shown]
    values.pop("wall_ms", None)
    values["wall_seconds"] = math.fsum(table.get("wall_ms", [])) / 1000
    values["largest_stretch"] = max(table.get("max_stretch", [math.nan]))
    values["smallest_distance"] = min(table.get("min_distance", [math.nan]))
    for name, column in _probes(directory / "probes.csv").items():
        values[f"probe.{name}"] = column[-1]
        if name.endswith((".x", ".y", ".z")):
            curves[f"probe.{name}"] = [_rounded(column[i]) for i in shown if i < len(column)]
    for name, value in _convergence(directory / "run.json").items():
        values[f"convergence.{name}"] = value
    return outcome


def _shown(count: int) -> list[int]:
    """Numbers of rows to draw, the first and the last among them."""
    if count <= POINTS:
        return list(range(count))
    return [round(i * (count - 1) / (POINTS - 1)) for i in range(POINTS)]


def _rounded(value: float) -> float | None:
    return float(f"{value:.4g}") if math.isfinite(value) else None


def _rows(file: Path) -> list[dict[str, str]]:
    """The complete rows of a table; a killed process may have left half a row."""
    try:
        with open(file, newline="") as text:
            return [row for row in csv.DictReader(text) if None not in row.values() and None not in row]
    except OSError:
        return []


def _read(file: Path) -> dict[str, list[float]]:
    rows = _rows(file)
    return {name: [float(row[name]) for row in rows] for name in (rows[0] if rows else ())}


def _probes(file: Path) -> dict[str, list[float]]:
    columns: dict[str, list[float]] = {}
    for row in _rows(file):
        for part in ("x", "y", "z", "vx", "vy", "vz"):
            columns.setdefault(f"{row['name']}.{part}", []).append(float(row[part]))
    return columns


def _convergence(file: Path) -> dict[str, float]:
    try:
        found = json.loads(file.read_text())["convergence"]
    except (OSError, ValueError, KeyError):
        return {}
    return {
        "steps": found["steps"],
        "converged_steps": found["converged_steps"],
        "worst_error": found["worst_error"],
        "frames_missed": len(found["frames_missed"]),
    }
