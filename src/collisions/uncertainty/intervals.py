"""Intervals, of which nothing is known but the bounds: where between them a figure is least and greatest.

An interval is never drawn from. Alone, the values of the outputs are searched for their extremes. Mixed with distributions, the
mean, the standard deviation and both ends of the 95 percent interval are, over the same few drawn cases at every place; at the
places found the run is then made in full.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..errors import InputError, NoSolutionError
from . import angles
from .designs import REPLICATES, Design
from .draw import Joint
from .model import Model
from .normal import power_of_two

_MOST = {True: 10, False: 14}  # intervals, beside distributions and alone: each doubles the corners
_GRID = {True: 400, False: 20000}  # places to begin with, corners always among them
_FINEST = {True: 21, False: 41}  # of them along one interval
_ROUNDS = {True: 24, False: 60}  # halvings of the search box: to a millionth of the interval, and to rounding
_PATIENCE = 10  # steps for each halving, at most
_DIAGONAL = {True: 3, False: 6}  # intervals up to which steps along diagonals are affordable
_COMMON = 16 * REPLICATES  # cases that every place is judged by
_LANES = 2**16


class Extremes(NamedTuple):
    """Least and greatest value by output, the places of all extremes, what it took to find them, and where means were cut."""

    values: dict[str, tuple[float, float]]
    places: list[dict[str, float]]
    asked: int
    failed: int
    wrapped: tuple[str, ...]
    cuts: dict[str, float | None]


class _Places:
    """The model at places between bounds, given as shares of the way from the lower to the upper bound."""

    def __init__(self, model: Model, bounds: Mapping[str, tuple[float, float]], common: Mapping[str, Any]) -> None:
        self.model = model
        self.names = tuple(bounds)
        self.low, self.high = (np.array([bounds[name][end] for name in bounds]) for end in (0, 1))
        self.common = common
        self.cases = max((len(values) for values in common.values()), default=1)
        self.asked = self.failed = 0
        self.cuts: dict[str, float | None] = {}

    def at(self, shares: Any) -> Any:
        """The upper bound from above, so that a share of 1 is that bound to the bit."""
        with np.errstate(all="ignore"):
            width = self.high - self.low
            return np.where(shares < 0.5, self.low + shares * width, self.high - (1.0 - shares) * width)

    def answers(self, shares: Any) -> dict[str, Any]:
        """By output the values at every place, one row a place."""
        step = max(1, _LANES // self.cases)
        parts = [self._answers(shares[i : i + step]) for i in range(0, len(shares), step)]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _answers(self, shares: Any) -> dict[str, Any]:
        at = self.at(shares)
        values = {name: np.repeat(at[:, i], self.cases) for i, name in enumerate(self.names)}
        values |= {name: np.tile(drawn, len(at)) for name, drawn in self.common.items()}
        count = len(at) * self.cases
        found = self.model(values, count)
        self.asked += count
        self.failed += int(np.count_nonzero(np.any([np.isnan(one) for one in found.values()], axis=0)))
        return {name: self._counted(name, one.reshape(len(at), -1)) for name, one in found.items()}

    def count_directions(self, first: Mapping[str, Any]) -> dict[str, Any]:
        """The first answers, and from now on all others, with directions about their mean, and the means within one turn."""
        for name, values in first.items():
            if self.model.units[name] == "rad" and angles.are_directions(values):
                self.cuts[name] = angles.cut(_means(angles.counted(values)))
        return {name: self._counted(name, values) for name, values in first.items()}

    def _counted(self, name: str, values: Any) -> Any:
        if name not in self.cuts:
            return values
        about = angles.counted(values)
        means = _means(about)
        return about + 2.0 * np.pi * np.rint((angles.folded(means, self.cuts[name]) - means) / (2.0 * np.pi))[:, np.newaxis]


def extremes(
    model: Model, bounds: Mapping[str, tuple[float, float]], joint: Joint | None = None, design: Design | None = None
) -> Extremes:
    """Where the outputs, or with ``joint`` their figures, are least and greatest.

    A grid finds where to look, then a shrinking box around the best place finds the extreme: exact where there is a single one
    between the bounds or the figure is monotone, as those of solver outputs are but for friction limits.
    """
    mixed = joint is not None
    if len(bounds) > _MOST[mixed]:
        raise InputError(
            f"{len(bounds)} intervals are {2 ** len(bounds)} corners; give at most {_MOST[mixed]}"
            f"{' beside distributions' if mixed else ''}, the others as {'distributions' if mixed else 'numbers'}",
            code="too_many_intervals",
            argument="inputs",
        )
    common: dict[str, Any] = {}
    if joint is not None and design is not None:
        with np.errstate(all="ignore"):
            common = joint.values(design(0, _COMMON // REPLICATES).reshape(joint.dimensions, -1))
    places = _Places(model, bounds, common)
    grid = _grid(len(bounds), _GRID[mixed], _FINEST[mixed])
    first = places.answers(grid)
    first = places.count_directions(first)
    star = _star(len(bounds), _DIAGONAL[mixed])
    found: dict[str, tuple[float, float]] = {}
    spots = []
    for name, values in first.items():
        if np.isnan(values).all():
            raise NoSolutionError(
                f"the model has no answer for {name!r} anywhere between the bounds", code="all_failed", output=name
            )
        for figure in _FIGURES if mixed else (_only,):
            judged = figure(values)
            if np.isnan(judged).all():
                continue
            judge = partial(_judged, places, name, figure)
            ends = [_search(judge, grid, judged, sign, star, _ROUNDS[mixed]) for sign in (1.0, -1.0)]
            spots += [place for place, _ in ends]
            found.setdefault(name, (ends[0][1], ends[1][1]))
    unique = np.unique(np.round(spots, 12), axis=0)
    listed = [dict(zip(places.names, map(float, places.at(spot)), strict=True)) for spot in unique]
    wrapped = tuple(name for name, values in first.items() if model.units[name] is None and angles.jump(values.ravel()))
    return Extremes(found, listed, places.asked, places.failed, wrapped, places.cuts)


def _search(judge: Callable[[Any], Any], grid: Any, judged: Any, sign: float, star: Any, rounds: int) -> tuple[Any, float]:
    """The place of the least figure (of the greatest for a sign of -1) and the figure there, from the best of the grid."""
    best = int(np.nanargmin(sign * judged))
    place, value, size = grid[best], sign * float(judged[best]), 0.5
    halvings = 0
    for _ in range(_PATIENCE * rounds):
        around = np.clip(place + size * star, 0.0, 1.0)
        beside = sign * judge(around)
        if not np.isnan(beside).all() and np.nanmin(beside) < value:
            place, value = around[int(np.nanargmin(beside))], float(np.nanmin(beside))
        else:
            size, halvings = 0.5 * size, halvings + 1
            if halvings == rounds:
                break
    return place, sign * value


def _judged(places: _Places, name: str, figure: Callable[[Any], Any], shares: Any) -> Any:
    return figure(places.answers(shares)[name])


def _means(values: Any) -> Any:
    """Of the answers at each place, NaN where there is none."""
    known = ~np.isnan(values)
    with np.errstate(invalid="ignore"):
        return np.sum(np.where(known, values, 0.0), axis=1) / np.count_nonzero(known, axis=1)


def _only(values: Any) -> Any:
    return values[:, 0]


def _figure(work_out: Callable[[Any], float]) -> Callable[[Any], Any]:
    """A figure of the answered cases of every row; NaN for a row of which less than two are."""

    def figure(values: Any) -> Any:
        rows = (row[~np.isnan(row)] for row in values)
        with np.errstate(all="ignore"):
            return np.array([work_out(row) if row.size > 1 else np.nan for row in rows])

    return figure


_FIGURES = (
    _figure(lambda row: float(np.mean(row))),
    _figure(lambda row: float(np.std(row / power_of_two(row))) * power_of_two(row)),
    _figure(lambda row: float(np.quantile(row, 0.025))),
    _figure(lambda row: float(np.quantile(row, 0.975))),
)


def _grid(count: int, most: int, finest: int) -> Any:
    """Shares of the way from lower to upper bound: as fine a grid as is cheap, corners included."""
    fineness = max(2, min(finest, int(most ** (1.0 / count) + 1e-9)))
    return np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, fineness)] * count, indexing="ij"), axis=-1).reshape(-1, count)


def _star(count: int, diagonal: int) -> Any:
    """One step along each input both ways, and along each diagonal of few."""
    unit = np.eye(count)
    steps = np.concatenate((unit, -unit))
    if count <= diagonal:
        steps = np.concatenate((steps, np.array(list(itertools.product((-1.0, 1.0), repeat=count)))))
    return steps
