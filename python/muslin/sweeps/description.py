"""The description of a sweep: its scene, what varies, and how; read from SWEEP.toml or from Python."""

import hashlib
import itertools
import math
import pickle
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from muslin._muslin import Mesh, Scene, parse_scene, read_scene, version
from muslin.errors import Error, FileError
from muslin.sweeps import points
from muslin.sweeps.points import Point, Sample, Span
from muslin.sweeps.source import Source, described
from muslin.tables import to_value

Row = dict[str, Any]
"""A row of the table of results: the value of each column."""

KEYS = ("title", "scene", "frames", "set", "grid", "list", "sample", "search", "pictures", "pages")
PAGES = ("report", "view")
MOST_RUNS = 1000
"""Without a limit of the caller."""


@dataclass(frozen=True)
class Search:
    """A search for the least or largest value of an objective."""

    objective: str | Callable[[Row], float]
    """A column of the table, or a function of a row."""
    maximize: bool
    runs: int
    seed: int
    batch: int
    """Runs that are proposed together."""
    spans: dict[str, Span]


@dataclass
class Description:
    """A sweep, checked."""

    source: Source
    title: str
    scene: Scene
    meshes: dict[str, Mesh]
    frames: int | None
    settings: list[str]
    """KEY=VALUE for all runs."""
    grid: dict[str, list[Any]]
    listed: dict[str, list[Any]]
    sample: Sample | None
    search: Search | None
    pictures: bool
    pages: list[str]

    @property
    def keys(self) -> list[str]:
        """The swept keys."""
        if self.search:
            return list(self.search.spans)
        return [*self.listed, *self.grid, *(self.sample.spans if self.sample else {})]

    @property
    def count(self) -> int:
        """The number of runs."""
        if self.search:
            return self.search.runs
        listed = len(next(iter(self.listed.values()), [None]))
        sampled = self.sample.runs if self.sample else 1
        return listed * sampled * math.prod(len(values) for values in self.grid.values())

    def points(self) -> list[Point]:
        """The point of each run: each row of the list with each point of the grid with each sample."""
        listed = [dict(zip(self.listed, row)) for row in zip(*self.listed.values())] or [{}]
        grid = [dict(zip(self.grid, row)) for row in itertools.product(*self.grid.values())]
        sampled = self.sample.points() if self.sample else [{}]
        return [first | second | third for first in listed for second in grid for third in sampled]

    def overrides(self, point: Point) -> list[str]:
        """KEY=VALUE of a run."""
        return [
            *self.scene.overrides,
            *self.settings,
            *(f"{key}={to_value(v, key)}" for key, v in point.items()),
        ]

    def facts(self) -> dict[str, Any]:
        """All that decides what the runs contain, as JSON has it."""
        facts: dict[str, Any] = {
            "muslin": version(),
            "scene": _hash(self.scene.text.encode()),
            "frames": self.frames,
        }
        facts |= {"set": [*self.scene.overrides, *self.settings], "grid": self.grid, "list": self.listed}
        if self.meshes:
            facts["meshes"] = {path: _hash(pickle.dumps(mesh)) for path, mesh in self.meshes.items()}
        if self.sample:
            facts["sample"] = {
                "method": self.sample.method,
                "runs": self.sample.runs,
                "seed": self.sample.seed,
            }
            facts["sample.keys"] = {key: vars(span) for key, span in self.sample.spans.items()}
        if self.search:
            facts["search"] = {
                "objective": _name(self.search.objective),
                "maximize": self.search.maximize,
                "runs": self.search.runs,
                "seed": self.search.seed,
                "batch": self.search.batch,
            }
            facts["search.keys"] = {key: vars(span) for key, span in self.search.spans.items()}
        return facts


def read_description(source: Source, *, limit: int | None = None) -> Description:
    """The sweep that some tables describe. Errors name the key and its place."""
    tables = source.tables
    source.refuse_unknown(tables, "", KEYS)
    scene, meshes = _scene(source)
    frames = source.integer(tables["frames"], "frames", 0) if "frames" in tables else None
    grid = points.columns(source, source.table(tables.get("grid", {}), "grid"), "grid")
    listed = points.columns(source, source.table(tables.get("list", {}), "list"), "list")
    description = Description(
        source=source,
        title=source.text(tables.get("title", scene.title), "title"),
        scene=scene,
        meshes=meshes,
        frames=frames,
        settings=[source.text(entry, f"set[{i}]") for i, entry in enumerate(_list(source, "set"))],
        grid=grid,
        listed=listed,
        sample=points.sample(source, tables["sample"]) if "sample" in tables else None,
        search=_search(source, tables["search"]) if "search" in tables else None,
        pictures=source.truth(tables.get("pictures", True), "pictures"),
        pages=[
            source.word(page, f"pages[{i}]", PAGES)
            for i, page in enumerate(_list(source, "pages", ["report"]))
        ],
    )
    _check_kinds(description)
    _check_count(description, MOST_RUNS if limit is None else limit)
    _check_scenes(description)
    return description


def _list(source: Source, key: str, default: Sequence[Any] = ()) -> list[Any]:
    value = source.tables.get(key, list(default))
    if not isinstance(value, list):
        raise source.error(key, f"`{key}` is {described(value)}", "give a list")
    return value


def _scene(source: Source) -> tuple[Scene, dict[str, Mesh]]:
    given = source.tables.get("scene")
    if isinstance(given, Scene):
        return given, given.__getstate__()[3]
    if given is None:
        raise source.error("", "there is no `scene`", 'name a scene file, as in scene = "flag.toml"')
    path = source.folder / source.text(given, "scene")
    try:
        return read_scene(path), {}
    except FileError as error:
        raise FileError(
            f"the scene {path}: {error.problem}", "correct `scene`", *_place(source, "scene")
        ) from None


def _place(source: Source, key: str) -> tuple[str, int, int]:
    error = source.error(key, "", "")
    return error.file, error.line, error.column


def _search(source: Source, value: Any) -> Search:
    table = source.table(value, "search")
    source.refuse_unknown(table, "search", ["objective", "direction", "runs", "seed", "batch", "keys"])
    for key, meaning in (("objective", "name a column of the table"), ("runs", "give the number of runs")):
        if key not in table:
            raise source.error("search", f"`search` has no `{key}`", meaning)
    objective = table["objective"]
    if not callable(objective):
        objective = source.text(objective, "search.objective")
    return Search(
        objective=objective,
        maximize=source.word(table.get("direction", "minimize"), "search.direction", ["minimize", "maximize"])
        == "maximize",
        runs=source.integer(table["runs"], "search.runs", 1),
        seed=source.integer(table.get("seed", 0), "search.seed", 0),
        batch=source.integer(table.get("batch", 8), "search.batch", 1),
        spans=points.keys_of(source, table, "search"),
    )


def _check_kinds(description: Description) -> None:
    source = description.source
    others = [name for name in ("grid", "list", "sample") if name in source.tables]
    if description.search and others:
        raise source.error(others[0], f"a search has no `{others[0]}`", "leave one of them out")
    if not description.keys:
        raise source.error("", "nothing varies", "write [grid], [list], [sample] or [search] with scene keys")
    lengths = {key: len(values) for key, values in description.listed.items()}
    for key, length in lengths.items():
        first = next(iter(lengths))
        if length != lengths[first]:
            problem = f"`list.{key}` has {length} values, `list.{first}` has {lengths[first]}"
            raise source.error(
                f"list.{key}", problem, "give the lists equal lengths; [grid] combines all values"
            )
    seen: dict[str, str] = {}
    tables = {"list": description.listed, "grid": description.grid}
    if description.sample:
        tables["sample.keys"] = {key: [] for key in description.sample.spans}
    for name, keys in tables.items():
        for key in keys:
            if key in seen:
                raise source.error(f"{name}.{key}", f"`{key}` is in [{seen[key]}] too", "keep one of them")
            seen[key] = name


def _check_count(description: Description, limit: int) -> None:
    if description.count <= limit:
        return
    factors = [str(len(values)) for values in description.grid.values()]
    if description.listed:
        factors.insert(0, str(len(next(iter(description.listed.values())))))
    if description.sample:
        factors.append(str(description.sample.runs))
    product = f" ({' × '.join(factors)})" if len(factors) > 1 else ""
    source = description.source
    place = next(name for name in ("search", "grid", "list", "sample") if name in source.tables)
    problem = f"these are {description.count} runs{product}, more than the limit of {limit}"
    option = "--limit " if source.file else "limit="
    raise source.error(place, problem, f"give fewer values, or raise the limit: {option}{description.count}")


def _check_scenes(description: Description) -> None:
    """Reads the scene with each value of each key at least once; of spans, with their ends."""
    for point in _points_to_check(description):
        overrides = description.overrides(point)
        try:
            parse_scene(description.scene.text, description.scene.file, overrides)
        except Error as error:
            raise _placed(description, error, point) from None


def _points_to_check(description: Description) -> list[Point]:
    if description.search:
        named = description.search.spans
        return [{key: span.at(share) for key, span in named.items()} for share in (0.0, 1.0)]
    sampled = description.sample.spans if description.sample else {}
    every = description.points()
    chosen = [every[0] | {key: span.at(share) for key, span in sampled.items()} for share in (0.0, 1.0)]
    tried = {(key, repr(value)) for key, value in every[0].items()}
    for point in every:
        news = {(key, repr(value)) for key, value in point.items() if key not in sampled} - tried
        if news:
            chosen.append(point)
            tried |= news
    return chosen


def _placed(description: Description, error: Error, point: Point) -> Error:
    """The error of a scene at the key of the sweep that caused it, if one did."""
    source = description.source
    for i, setting in enumerate(description.settings):
        if error.file == f"--set {setting}":
            return type(error)(error.problem, error.remedy, *_place(source, f"set[{i}]"))
    for key, value in point.items():
        if error.file != f"--set {key}={to_value(value, key)}":
            continue
        tables: Mapping[str, Any] = {
            "list": description.listed,
            "grid": description.grid,
            "sample.keys": description.sample.spans if description.sample else {},
            "search.keys": description.search.spans if description.search else {},
        }
        name = next(name for name, keys in tables.items() if key in keys)
        place = f"{name}.{key}"
        values = tables[name][key]
        if isinstance(values, list) and f"{place}[{values.index(value)}]" in source.places:
            place = f"{place}[{values.index(value)}]"
        return type(error)(
            f"`{key}` = {to_value(value, key)}: {error.problem}", error.remedy, *_place(source, place)
        )
    return error


def _name(objective: str | Callable[[Row], float]) -> str:
    return (
        objective
        if isinstance(objective, str)
        else getattr(objective, "__qualname__", type(objective).__name__)
    )


def _hash(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
