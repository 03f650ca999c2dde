"""Samples of the unit cube: random, Latin hypercube, Sobol."""

import random

from muslin.errors import UsageError

METHODS = ("random", "latin_hypercube", "sobol")


def unit_samples(method: str, count: int, dimensions: int, seed: int) -> list[list[float]]:
    """``count`` points of the unit cube, the same for the same seed."""
    if method == "sobol":
        return _sobol(count, dimensions, seed)
    source = random.Random(seed)
    if method == "random":
        return [[source.random() for _ in range(dimensions)] for _ in range(count)]
    rows = [[0.0] * dimensions for _ in range(count)]
    for dimension in range(dimensions):
        cells = list(range(count))
        source.shuffle(cells)
        for row, cell in zip(rows, cells):
            row[dimension] = (cell + source.random()) / count
    return rows


def _sobol(count: int, dimensions: int, seed: int) -> list[list[float]]:
    try:
        from scipy.stats import qmc  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ImportError:
        raise UsageError(
            'the method "sobol" needs the package scipy', "pip install scipy, or take latin_hypercube"
        ) from None
    engine = qmc.Sobol(dimensions, scramble=True, seed=seed)
    drawn = engine.random_base2((count - 1).bit_length())  # a power of two keeps its balance
    return [[float(u) for u in row] for row in drawn[:count]]
