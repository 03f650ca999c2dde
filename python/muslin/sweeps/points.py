"""Points of a sweep: which values the swept keys have in each run."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from muslin.sweeps.sampling import METHODS, unit_samples
from muslin.sweeps.source import Source, described, joined

Point = dict[str, Any]
"""The value of each swept key."""


@dataclass(frozen=True)
class Span:
    """Numbers from one to another, or one of some values."""

    low: float = 0.0
    high: float = 1.0
    logarithmic: bool = False
    whole: bool = False
    choices: tuple[Any, ...] = ()

    def at(self, share: float) -> Any:
        """The value at a share from 0 to 1 of the span."""
        if self.choices:
            return self.choices[min(int(share * len(self.choices)), len(self.choices) - 1)]
        if self.whole:
            low, high = int(self.low), int(self.high)
            return min(low + int(share * (high - low + 1)), high)
        if self.logarithmic:
            value = self.low * (self.high / self.low) ** share
        else:
            value = self.low + share * (self.high - self.low)
        return min(max(value, self.low), self.high)


@dataclass(frozen=True)
class Sample:
    """Points drawn from spans."""

    method: str
    runs: int
    seed: int
    spans: dict[str, Span]

    def points(self) -> list[Point]:
        """The points, the same for the same seed."""
        shares = unit_samples(self.method, self.runs, len(self.spans), self.seed)
        return [{key: span.at(u) for (key, span), u in zip(self.spans.items(), row)} for row in shares]


def columns(source: Source, table: Mapping[str, Any], path: str) -> dict[str, list[Any]]:
    """The lists of values below a table by their dotted keys."""
    found: dict[str, list[Any]] = {}
    for key, value in table.items():
        own = joined(path, key)
        if isinstance(value, Mapping):
            nested = columns(source, value, own)
            found |= {joined(key, inner): values for inner, values in nested.items()}
        else:
            found[key] = source.values(value, own)
    return found


def spans(source: Source, table: Mapping[str, Any], path: str) -> dict[str, Span]:
    """The spans below a table by their dotted keys."""
    found: dict[str, Span] = {}
    for key, value in table.items():
        own = joined(path, key)
        if not isinstance(value, Mapping):
            raise source.error(
                own, f"`{own}` is {described(value)}", "write { from = 1, to = 2 } or { choose = [1, 2, 5] }"
            )
        if any(word in value and not isinstance(value[word], Mapping) for word in ("from", "to", "choose")):
            found[key] = _span(source, value, own)
        elif value:
            found |= {joined(key, inner): span for inner, span in spans(source, value, own).items()}
        else:
            raise source.error(
                own, f"`{own}` has no values", "write { from = 1, to = 2 } or { choose = [1, 2, 5] }"
            )
    return found


def _span(source: Source, table: Mapping[str, Any], path: str) -> Span:
    if "choose" in table:
        source.refuse_unknown(table, path, ["choose"])
        return Span(choices=tuple(source.values(table["choose"], f"{path}.choose")))
    source.refuse_unknown(table, path, ["from", "to", "choose", "scale", "whole"])
    for word in ("from", "to"):
        if word not in table:
            raise source.error(path, f"`{path}` has no `{word}`", "write { from = 1, to = 2 }")
        value = table[word]
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise source.error(
                f"{path}.{word}", f"`{path}.{word}` is {described(value)}", "give a finite number"
            )
    low, high = table["from"], table["to"]
    scale = source.word(table.get("scale", "linear"), f"{path}.scale", ["linear", "log"])
    whole = source.truth(table.get("whole", False), f"{path}.whole")
    if not low < high:
        raise source.error(path, f"`{path}` goes from {low} to {high}", "let `from` be the smaller number")
    if scale == "log" and low <= 0:
        raise source.error(f"{path}.from", f"a logarithmic scale begins at {low}", "begin above 0")
    if whole and (scale == "log" or low != int(low) or high != int(high)):
        raise source.error(
            path, "`whole` needs whole numbers on a linear scale", "give whole `from` and `to`"
        )
    return Span(float(low), float(high), scale == "log", whole)


def sample(source: Source, value: Any, path: str = "sample") -> Sample:
    """The settings of a sampler."""
    table = source.table(value, path)
    source.refuse_unknown(table, path, ["method", "runs", "seed", "keys"])
    method = source.word(table.get("method", "latin_hypercube"), f"{path}.method", METHODS)
    if "runs" not in table:
        raise source.error(path, f"`{path}` has no `runs`", "give the number of runs")
    runs = source.integer(table["runs"], f"{path}.runs", 1)
    seed = source.integer(table.get("seed", 0), f"{path}.seed", 0)
    return Sample(method, runs, seed, keys_of(source, table, path))


def keys_of(source: Source, table: Mapping[str, Any], path: str) -> dict[str, Span]:
    """The spans in the table `keys`, of which there must be one."""
    found = spans(source, source.table(table.get("keys", {}), f"{path}.keys"), f"{path}.keys")
    if not found:
        raise source.error(
            path, f"`{path}` has no `keys`", f"write [{path}.keys] with the scene keys to vary"
        )
    return found
