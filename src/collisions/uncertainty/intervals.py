"""Propagation of ``Interval`` inputs: searches for the least and greatest outputs between the
bounds.

An interval is never drawn from. Without distributions, the search is for the extremes of the
outputs. Mixed with distributions, it is for the extremes of the mean, the standard deviation and
both ends of the 95 percent interval, over the same few drawn cases at every place; the full run is
then made at the places found.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..messages.errors import InputError, NoSolutionError
from ..quantities.attributes import OWN_UNIT, derived, returns
from ..quantities.strict_json import strict
from . import turns
from .derivatives import Local
from .designs import REPLICATES
from .model import Model, count_failed
from .normal import power_of_two
from .output import COVERAGE, Output, Shares
from .probability import Condition
from .sampled import Sampled

COMMON_CASES = 16 * REPLICATES  # drawn cases, the same at every point
_BLOCK = 2**16  # cases a call
_VALLEYS = 4  # of the grid, from which an extreme is looked for
_PATIENCE = 10  # steps for each halving, at most


class _Effort(NamedTuple):
    """Limits of the search: number of intervals, points of the grid in all and along one interval,
    halvings of the search box.

    Every interval doubles the corners, which are always among the places. Up to ``diagonal``
    intervals it also steps along diagonals.
    """

    intervals: int
    places: int
    finest: int
    halvings: int
    diagonal: int


_ONLY_INTERVALS = _Effort(
    intervals=14, places=20000, finest=41, halvings=60, diagonal=6
)  # to rounding
_MIXED = _Effort(
    intervals=10, places=400, finest=21, halvings=24, diagonal=3
)  # to a millionth of the interval

_FIGURES: tuple[Callable[[Any], Any], ...] = (
    np.mean,
    lambda row: float(np.std(row / power_of_two(row))) * power_of_two(row),
    lambda row: np.quantile(row, 0.025),
    lambda row: np.quantile(row, 0.975),
)


class Extremes(NamedTuple):
    """Least and greatest value by output, the points of all extremes, the cost, and the cuts of
    mean directions.
    """

    values: dict[str, tuple[float, float]]
    places: list[dict[str, float]]
    samples: int
    failed: int
    wrapped: Mapping[str, str]
    cuts: dict[str, float | None]


def extremes(
    model: Model, bounds: Mapping[str, tuple[float, float]], common: Mapping[str, Any]
) -> Extremes:
    """Find where the outputs, or their figures over the ``common`` drawn cases, are least and
    greatest.

    A grid finds where to look, then a shrinking box around each of its best places finds the
    extreme: exact where the grid shows the few that there are between the bounds, or the figure is
    monotone, as those of solver outputs are but for friction limits.
    """
    effort = _MIXED if common else _ONLY_INTERVALS
    if len(bounds) > effort.intervals:
        raise InputError(
            f"{len(bounds)} intervals are {2 ** len(bounds)} corners; give at most "
            f"{effort.intervals}{' beside distributions' if common else ''}, the others as "
            f"{'distributions' if common else 'numbers'}",
            code="too_many_intervals",
            argument="inputs",
        )
    places = _GridPoints(model, bounds, common)
    grid = _grid(len(bounds), effort)
    first = places.count_directions(places.answers(grid))
    searches: list[_Search] = []
    for name, values in first.items():
        if np.isnan(values).all():
            raise NoSolutionError(
                f"the model has no answer for {name!r} anywhere between the bounds",
                code="all_failed",
                output=name,
            )
        for figure in _FIGURES if common else _FIGURES[:1]:
            judged = _per_point(figure, values)
            if not np.isnan(judged).all():
                searches += (
                    _Search(
                        name, figure, sign, _steps_from(grid, at, float(judged[at]), sign, effort)
                    )
                    for sign in (1.0, -1.0)
                    for at in _starts(sign * judged, len(bounds))
                )
    # The best of those that look for the same.
    ends: dict[tuple[str, Any, float], tuple[Any, float]] = {}
    for search, end in zip(searches, _in_lockstep(places, searches), strict=True):
        sought = search.output, search.figure, search.sign
        if sought not in ends or search.sign * end[1] < search.sign * ends[sought][1]:
            ends[sought] = end
    found: dict[str, tuple[float, float]] = {}
    for (name, figure, sign), (_, least) in ends.items():
        if sign > 0.0:
            found.setdefault(name, (least, ends[name, figure, -1.0][1]))
    spots = [place for place, _ in ends.values()]
    unique = np.unique(np.round(spots, 12), axis=0)
    listed = [dict(zip(bounds, map(float, places.at(spot)), strict=True)) for spot in unique]
    jumps = {
        name: turns.jump_of(values.ravel(), model.units[name], drawn=bool(common))
        for name, values in first.items()
    }
    wrapped = {name: where for name, where in jumps.items() if where is not None}
    return Extremes(found, listed, places.samples, places.failed, wrapped, places.cuts)


class _GridPoints:
    """The model at points between bounds, given as shares of the way from the lower to the upper
    bound.
    """

    def __init__(
        self, model: Model, bounds: Mapping[str, tuple[float, float]], common: Mapping[str, Any]
    ) -> None:
        self.model = model
        self.names = tuple(bounds)
        self.low, self.high = (np.array([bounds[name][end] for name in bounds]) for end in (0, 1))
        self.common = common
        self.cases = max((len(values) for values in common.values()), default=1)
        self.samples = self.failed = 0
        self.cuts: dict[str, float | None] = {}

    def at(self, shares: Any) -> Any:
        """The inputs at these shares; measured from the nearer bound, so that a share of 1 is
        exactly the upper one.
        """
        with np.errstate(all="ignore"):
            width = self.high - self.low
            return np.where(
                shares < 0.5, self.low + shares * width, self.high - (1.0 - shares) * width
            )

    def answers(self, shares: Any) -> dict[str, Any]:
        """The values at every point by output, one row per point."""
        step = max(1, _BLOCK // self.cases)
        parts = [self._answers(self.at(shares[i : i + step])) for i in range(0, len(shares), step)]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _answers(self, at: Any) -> dict[str, Any]:
        values = {name: np.repeat(at[:, i], self.cases) for i, name in enumerate(self.names)}
        values |= {name: np.tile(drawn, len(at)) for name, drawn in self.common.items()}
        count = len(at) * self.cases
        found = self.model(values, count)
        self.samples += count
        self.failed += count_failed(found)
        return {name: self._counted(name, one.reshape(len(at), -1)) for name, one in found.items()}

    def count_directions(self, first: Mapping[str, Any]) -> dict[str, Any]:
        """Decide from the first values which outputs are directions; unwraps them, and all later
        ones, within one turn.
        """
        for name, values in first.items():
            if self.model.units[name] == "rad" and turns.are_directions(values):
                self.cuts[name] = turns.cut(_means(turns.counted(values)))
        return {name: self._counted(name, values) for name, values in first.items()}

    def _counted(self, name: str, values: Any) -> Any:
        if name not in self.cuts:
            return values
        about = turns.counted(values)
        return about + math.tau * np.reshape(
            turns.turns_to(_means(about), self.cuts[name]), (-1, 1)
        )


class _Search(NamedTuple):
    """A search for one extreme: the output, the figure of it that is judged, 1 for the least and -1
    for the greatest, and the steps, which ask for points.
    """

    output: str
    figure: Callable[[Any], Any]
    sign: float
    steps: Generator[Any, Any, tuple[Any, float]]


def _in_lockstep(places: _GridPoints, searches: Sequence[_Search]) -> list[tuple[Any, float]]:
    """The point and the figure where each search ends.

    All searches take each step together, so that the model is called once a step, and no figure is
    worked out twice: searches for different outputs meet at the same corners.
    """
    ends: list[Any] = [None] * len(searches)
    asked = {at: next(search.steps) for at, search in enumerate(searches)}
    known: dict[tuple[bytes, str, Any], float] = {}
    while asked:
        keys = {
            at: [(point.tobytes(), searches[at].output, searches[at].figure) for point in points]
            for at, points in asked.items()
        }
        new = {
            key[0]: point
            for at, points in asked.items()
            for key, point in zip(keys[at], points, strict=True)
            if key not in known
        }
        row = {point: i for i, point in enumerate(new)}
        answers = places.answers(np.array(list(new.values()))) if new else {}
        for at in list(asked):
            name, figure, _, steps = searches[at]
            missing = [key for key in keys[at] if key not in known]
            if missing:
                rows = answers[name][[row[key[0]] for key in missing]]
                known.update(zip(missing, map(float, _per_point(figure, rows)), strict=True))
            try:
                asked[at] = steps.send(np.array([known[key] for key in keys[at]]))
            except StopIteration as ended:
                ends[at] = ended.value
                del asked[at]
    return ends


def _starts(judged: Any, count: int) -> list[int]:
    """The best place of the grid along ``count`` intervals, and the next best of those that none
    beside them is better than: the least figure may be near any of them.
    """
    found = np.where(np.isnan(judged), math.inf, judged)
    grid = found.reshape((round(len(found) ** (1.0 / count)),) * count)
    none_better, one_worse = np.ones(grid.shape, dtype=bool), np.zeros(grid.shape, dtype=bool)
    for axis in range(count):
        along, better, worse = (np.moveaxis(of, axis, 0) for of in (grid, none_better, one_worse))
        for here, beside in ((slice(1, None), slice(None, -1)), (slice(None, -1), slice(1, None))):
            better[here] &= along[here] <= along[beside]
            worse[here] |= along[here] < along[beside]
    best = int(np.argmin(found))
    valleys = np.flatnonzero(none_better & one_worse)
    others = [int(one) for one in valleys[np.argsort(found[valleys], kind="stable")] if one != best]
    return [best, *others[: _VALLEYS - 1]]


def _steps_from(
    grid: Any, start: int, judged: float, sign: float, effort: _Effort
) -> Generator[Any, Any, tuple[Any, float]]:
    """The steps from one place of the grid to the least figure near it, or the greatest for a sign
    of -1.

    Each step asks for the figures at the points around the best one; the end is that point and its
    figure.
    """
    place, value = grid[start], sign * judged
    steps, smallest = _steps(len(place), effort), 0.5**effort.halvings
    # At first about as far as the grid is wide, so as not to leap from one valley into another.
    along = round(len(grid) ** (1.0 / len(place)))
    size = 0.5 ** max(1, int(math.log2(along - 1)))
    for _ in range(_PATIENCE * effort.halvings):
        around = np.clip(place + size * steps, 0.0, 1.0)
        beside = sign * (yield around)
        least = int(np.argmin(np.where(np.isnan(beside), math.inf, beside)))
        if beside[least] < value:
            place, value = around[least], float(beside[least])
        elif size == smallest:
            break
        else:
            size *= 0.5
    return place, sign * value


def _means(values: Any) -> Any:
    """Mean of the values at each point; NaN without any."""
    known = ~np.isnan(values)
    with np.errstate(invalid="ignore"):
        return np.sum(np.where(known, values, 0.0), axis=1) / np.count_nonzero(known, axis=1)


def _per_point(figure: Callable[[Any], Any], values: Any) -> Any:
    """The figure over the answered cases of every row; NaN for fewer than two. If the row is one
    case, its value.
    """
    if values.shape[1] == 1:
        return values[:, 0]
    rows = (row[~np.isnan(row)] for row in values)
    with np.errstate(all="ignore"):
        return np.array([figure(row) if row.size > 1 else np.nan for row in rows])


def _grid(count: int, effort: _Effort) -> Any:
    """Grid points as shares from lower to upper bound, as fine as is cheap; corners included."""
    fineness = max(2, min(effort.finest, int(effort.places ** (1.0 / count) + 1e-9)))
    return np.stack(
        np.meshgrid(*[np.linspace(0.0, 1.0, fineness)] * count, indexing="ij"), axis=-1
    ).reshape(-1, count)


def _steps(count: int, effort: _Effort) -> Any:
    """Search directions: along each input both ways, and along the diagonals if there are few
    inputs.
    """
    unit = np.eye(count)
    steps = np.concatenate((unit, -unit))
    if count <= effort.diagonal:
        steps = np.concatenate(
            (steps, np.array(list(itertools.product((-1.0, 1.0), repeat=count))))
        )
    return steps


class Bounds(Output):
    """An output with an interval among its inputs: the range of every figure over ``cases``, the
    places where it was found.
    """

    def __init__(
        self,
        name: str,
        unit: str | None,
        cases: Sequence[Local | Sampled],
        cut: float | None = None,
    ) -> None:
        super().__init__(name, unit)
        # One turn for the means of all directions, the one that ends at the cut, or the figures
        # could not be compared.
        self.cases = [case.turned(float(turns.turns_to(case.mean, cut))) for case in cases]

    @property
    def bounds_only(self) -> bool:
        """Whether intervals are all that is uncertain about it."""
        return bool(self.mean == self.interval())

    @derived(OWN_UNIT)
    def mean_standard_error(self) -> Any:
        """The largest standard error among the means."""
        return max(case.mean_standard_error for case in self.cases)

    @derived(OWN_UNIT)
    def std_standard_error(self) -> Any:
        """The largest standard error among the standard deviations."""
        return max(case.std_standard_error for case in self.cases)

    @returns(OWN_UNIT)
    def quantile_standard_error(self, p: Any) -> Any:
        """The largest standard error among the quantiles."""
        return np.max([case.quantile_standard_error(p) for case in self.cases], axis=0)

    @returns(OWN_UNIT)
    def interval(self, coverage: float = COVERAGE) -> tuple[float, float]:
        """The range (low, high) that holds the value with at least this probability wherever in the
        interval the truth lies.
        """
        ends = [case.interval(coverage) for case in self.cases]
        return min(low for low, _ in ends), max(high for _, high in ends)

    def probability(self, condition: Condition) -> tuple[float, float]:
        """Refused, as an interval says nothing of likelihood."""
        raise InputError(
            f"{self.name!r} has no one probability, because an Interval among the inputs says "
            "nothing of likelihood; give it a distribution, or ask with a number at each of its "
            "ends in its place",
            code="not_sampled",
            argument="inputs",
        )

    def row(self) -> tuple[str, str]:
        """Name and figures as a text."""
        low, high = self.interval()
        unit = f" {self.unit}" if self.unit else ""
        least, most = self.mean
        if self.bounds_only:
            return self.name, f"between {low:.6g} and {high:.6g}{unit}"
        return (
            self.name,
            (
                f"mean between {least:.6g} and {most:.6g}{unit}, 95 percent within {low:.6g} to "
                f"{high:.6g}{unit}"
            ),
        )

    def record(self) -> dict[str, Any]:
        """The figures as plain values that strict JSON can hold."""
        figures = {
            "unit": self.unit,
            "mean": self.mean,
            "std": self.std,
            "interval_95": self.interval(),
        }
        found: dict[str, Any] = strict(figures)
        return found

    def _mean(self) -> Any:
        return _range(case.mean for case in self.cases)

    def _std(self) -> Any:
        return _range(case.std for case in self.cases)

    def _quantile(self, p: Any) -> Any:
        found = np.array([case.quantile(p) for case in self.cases])
        low, high = found.min(axis=0), found.max(axis=0)
        return (low, high) if np.ndim(low) else (float(low), float(high))

    def _shares(self) -> Shares:
        raise InputError(
            f"{self.name!r} has no variance to share, because an Interval among the inputs says "
            "nothing of likelihood; give it a distribution, or compare the bounds with and "
            "without it",
            code="no_variance",
            argument=self.name,
        )


def _range(figures: Iterable[float]) -> tuple[float, float]:
    found = list(figures)
    return min(found), max(found)
