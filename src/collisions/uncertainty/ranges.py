"""Intervals, of which nothing is known but the bounds: where the truth may lie, and the extremes of what follows.

An interval is never drawn from. Mixed with distributions, the same drawn cases are worked out at place after place of it, and
the range of each figure over the places is what is known of that figure.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..errors import InputError, NoSolutionError
from . import angles
from .model import Model

_PLACES = {1: 9, 2: 7, 3: 5, 4: 4, 5: 3}  # on each of so many intervals, ends included
_MOST_MIXED = 10
_MOST_GRID = 20000
_ROUNDS = 60  # halvings of the search box: from the whole interval to rounding


def places(bounds: Mapping[str, tuple[float, float]]) -> Iterator[dict[str, float]]:
    """Where to look: a grid over few intervals, over more of them the corners and the middle."""
    if len(bounds) > _MOST_MIXED:
        raise InputError(
            f"{len(bounds)} intervals beside distributions are {2 ** len(bounds)} corners; give at most {_MOST_MIXED}, the "
            f"others as distributions, or method='interval' with nothing but intervals",
            code="too_many_intervals",
            argument="inputs",
        )
    count = _PLACES.get(len(bounds), 2)
    for place in itertools.product(*(np.linspace(low, high, count) for low, high in bounds.values())):
        yield dict(zip(bounds, map(float, place), strict=True))
    if count == 2:
        yield {name: 0.5 * (low + high) for name, (low, high) in bounds.items()}


def extremes(model: Model, bounds: Mapping[str, tuple[float, float]]) -> tuple[dict[str, tuple[float, float]], int, int]:
    """Least and greatest value of every output; how many cases that took, and how many had no answer.

    A grid finds where to look, then a shrinking box around the best place finds the extreme: exact where the output has a
    single one between the bounds or is monotone, as solver outputs are but for friction limits.
    """
    names = tuple(bounds)
    low, high = (np.array([bounds[name][end] for name in names]) for end in (0, 1))
    count = len(names)
    asked = failed = 0
    cuts: dict[str, float | None] = {}

    def ask(shares: Any) -> dict[str, Any]:
        nonlocal asked, failed
        # The upper bound from above, so that a share of 1 is that bound to the bit.
        with np.errstate(all="ignore"):
            at = np.where(shares < 0.5, low + shares * (high - low), high - (1.0 - shares) * (high - low))
        answers = model({name: np.ascontiguousarray(at[:, i]) for i, name in enumerate(names)}, len(at))
        answers = {name: angles.folded(values, cuts.get(name)) for name, values in answers.items()}
        asked += len(at)
        failed += int(np.count_nonzero(np.any([np.isnan(values) for values in answers.values()], axis=0)))
        return answers

    grid = _grid(count)
    first = ask(grid)
    cuts |= {name: angles.cut(values) for name, values in first.items() if model.units[name] == "rad"}
    first = {name: angles.folded(values, cuts.get(name)) for name, values in first.items()}
    found: dict[str, tuple[float, float]] = {}
    for output, values in first.items():
        if np.isnan(values).all():
            raise NoSolutionError(
                f"the model has no answer for {output!r} anywhere between the bounds", code="all_failed", output=output
            )
        ends = []
        for sign in (1.0, -1.0):
            best = int(np.nanargmin(sign * values))
            place, value, size = grid[best], sign * values[best], 0.5
            for _ in range(_ROUNDS):
                around = np.clip(place + size * _star(count), 0.0, 1.0)
                beside = sign * ask(around)[output]
                if not np.isnan(beside).all() and np.nanmin(beside) < value:
                    place, value = around[int(np.nanargmin(beside))], float(np.nanmin(beside))
                else:
                    size *= 0.5
            ends.append(sign * float(value))
        found[output] = ends[0], ends[1]
    return found, asked, failed


def _grid(count: int) -> Any:
    """Shares of the way from lower to upper bound: as fine a grid as is cheap, corners included."""
    if count > 14:
        raise InputError(
            f"{count} intervals are {2**count} corners; give at most 14, the others as numbers", code="too_many_intervals",
            argument="inputs",
        )  # fmt: skip
    fineness = max(2, min(41, int(_MOST_GRID ** (1.0 / count))))
    return np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, fineness)] * count, indexing="ij"), axis=-1).reshape(-1, count)


def _star(count: int) -> Any:
    """One step along each input both ways, and along each diagonal of few."""
    unit = np.eye(count)
    steps = np.concatenate((unit, -unit))
    if count <= 6:
        steps = np.concatenate((steps, np.array(list(itertools.product((-1.0, 1.0), repeat=count)))))
    return steps
