"""A search by Optuna: proposes points in batches, from the results of all earlier batches.

A batch does not depend on the number of workers or on which of its runs ends first, so the same description
gives the same runs, and a search that was stopped goes through the same points again with the results it has.
"""

import math
import numbers
from typing import Any

from muslin.errors import UsageError
from muslin.sweeps.description import Row, Search
from muslin.sweeps.points import Point
from muslin.sweeps.source import name_advice


class Proposer:
    """Proposes points, and learns from the rows of their runs."""

    def __init__(self, search: Search) -> None:
        try:
            import optuna  # type: ignore[import-untyped, import-not-found, unused-ignore]
        except ImportError:
            raise UsageError("the package optuna is not installed", "pip install muslin[sweep]") from None
        optuna.logging.set_verbosity(optuna.logging.WARNING)
        self._search = search
        self._optuna: Any = optuna
        self._study: Any = optuna.create_study(
            direction="maximize" if search.maximize else "minimize",
            sampler=optuna.samplers.TPESampler(seed=search.seed, constant_liar=True),
        )
        self._open: list[Any] = []

    def propose(self, count: int) -> list[Point]:
        """The next points."""
        self._open = [self._study.ask() for _ in range(count)]
        return [self._point(trial) for trial in self._open]

    def learn(self, rows: list[Row]) -> None:
        """Takes the rows of the points that were proposed last. Failed runs are known as failed."""
        for trial, row in zip(self._open, rows):
            value = objective_of(self._search, row)
            if value is None:
                self._study.tell(trial, state=self._optuna.trial.TrialState.FAIL)
            else:
                self._study.tell(trial, value)

    def _point(self, trial: Any) -> Point:
        point: Point = {}
        for key, span in self._search.spans.items():
            if span.choices:
                point[key] = span.choices[trial.suggest_categorical(key, list(range(len(span.choices))))]
            elif span.whole:
                point[key] = trial.suggest_int(key, int(span.low), int(span.high))
            else:
                point[key] = trial.suggest_float(key, span.low, span.high, log=span.logarithmic)
        return point


def objective_of(search: Search, row: Row) -> float | None:
    """The objective of a run; None if the run failed or the objective is not a finite number."""
    if row["status"] != "finished":
        return None
    if callable(search.objective):
        value = search.objective(row)
    elif search.objective in row:
        value = row[search.objective]
    else:
        named = [
            key for key, cell in row.items() if isinstance(cell, int | float) and not isinstance(cell, bool)
        ]
        raise UsageError(
            f"the table has no column `{search.objective}`", name_advice(search.objective, named)
        )
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise UsageError(f"the objective of run {row['run']} is {value!r}", "let it be a number")
    return float(value) if math.isfinite(value) else None


def best_of(search: Search, rows: list[Row]) -> Row | None:
    """The row with the best objective."""
    found = [(value, row) for row in rows if (value := objective_of(search, row)) is not None]
    if not found:
        return None
    return (max if search.maximize else min)(found, key=lambda pair: pair[0])[1]
