"""Profiles: how chi-squared rises when one unknown is held at other values and the rest is fitted
again. Where a model bends or a bound is near they give the range that slopes do not.

The range of probability p holds the values at which chi-squared rises by less than the square of
the normal score of p (D. J. Venzon and S. H. Moolgavkar, "A method for computing
profile-likelihood-based confidence intervals", Applied Statistics 37 (1988) 87).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ..uncertainty.normal import score_of_coverage
from .least_squares import Ends, Problem, minimise, spread

LEVELS = score_of_coverage(0.95) / 8.0 * np.arange(13)  # sigma; the ninth is that of 95 percent
SAME_CHI_SQUARED = 1e-3  # misfits within this are the same
_RISE = 0.98  # sigma, aimed at from one value to the next: two lead to 95 percent
_MOST_RISE, _LONGER, _SHORTEST = 1.5, 4.0, 1e-3  # of steps, the last a part of the first
_MOST_STEPS = 24
_CLOSE, _ROUNDS = 1e-2, 40  # of the fits again: chi-squared to 1e-4
_FIRST = 0.125  # of its scale, for an unknown without a standard error
_BESIDE, _CLEARLY = 8, 0.05  # searches for another valley, and sigma by which it is lower
_BACK = (0.8, 0.6, 0.4, 0.2)  # of the way from the answer to where another valley was met


class Side(NamedTuple):
    """Values on one side of the answer, outward, the rise of the misfit at each in sigma, and the
    slope of chi-squared there; beyond the last the model refuses if it is ``at_edge``.
    """

    values: Any
    rises: Any
    slopes: Any
    bound: float
    at_edge: bool

    def reach(self, level: float) -> float:
        """The furthest value with no more than this rise."""
        inside = np.flatnonzero(self.rises <= level)
        if not inside.size:
            return math.nan
        k = int(inside[-1])
        values, rises = self.values, self.rises
        if k < len(values) - 1:
            return self._between(k, level)
        if self.at_edge or values[k] == self.bound:
            return float(values[k])
        slope = (values[k] - values[k - 1]) / (rises[k] - rises[k - 1]) if k else math.inf
        if rises[k] < LEVELS[-1] - _RISE or not math.isfinite(slope):
            return self.bound  # it goes on without a rise
        end = float(values[k] + slope * (level - rises[k]))
        return min(end, self.bound) if self.bound > self.values[0] else max(end, self.bound)

    def _between(self, k: int, level: float) -> float:
        """Where chi-squared reaches the level after value k, by the cubic of both ends and slopes;
        bisected, since that need not be monotonic.
        """
        start, width = self.values[k], self.values[k + 1] - self.values[k]
        (below, above), (left, right) = self.rises[k : k + 2] ** 2, self.slopes[k : k + 2] * width
        low, high = 0.0, 1.0
        for _ in range(40):
            t = 0.5 * (low + high)
            there = (
                below * (1.0 + 2.0 * t) * (1.0 - t) ** 2
                + left * t * (1.0 - t) ** 2
                + above * t * t * (3.0 - 2.0 * t)
                - right * t * t * (1.0 - t)
            )
            low, high = (t, high) if there <= level * level else (low, t)
        return float(start + low * width)


_NOWHERE = Side(np.zeros(1), np.full(1, np.inf), np.zeros(1), 0.0, True)


class Found(NamedTuple):
    """Both sides of each unknown that was followed, by its place, those of other valleys of the
    misfit that its range reaches into, and the least misfit met on the way.
    """

    sides: dict[int, tuple[Side, Side]]
    valleys: dict[int, list[tuple[Side, Side]]]
    lowest: float
    at: Any

    @property
    def refused(self) -> bool:
        """Whether the model refuses within the range of 95 percent."""
        return any(
            side.at_edge and side.rises[-1] < 2.0 for both in self.sides.values() for side in both
        )

    def pairs(self, unknown: int) -> list[tuple[Side, Side]]:
        """All profiles of an unknown that was followed."""
        return [self.sides[unknown], *self.valleys.get(unknown, ())]


class _Row(NamedTuple):
    """Where one side of one unknown is followed from: the point, the rise of the misfit there in
    sigma and the slope of chi-squared.
    """

    unknown: int
    outward: float
    at: Any
    rise: float
    climb: float


class _Track(NamedTuple):
    """One side as it was followed: value, rise and slope each, and whether the model refuses
    beyond.
    """

    steps: list[tuple[float, float, float]]
    at_edge: bool


class _Profiles:
    """Follows profiles from a point, by the rise above a chi-squared, which is that of the best
    answer. The covariance says where to look first.
    """

    def __init__(
        self, problem: Problem, point: Any, chi_squared: float, covariance: Any, scout: Problem
    ) -> None:
        self.problem, self.point, self.chi_squared = problem, point, chi_squared
        self.scout = scout
        errors = np.sqrt(np.diagonal(covariance))
        self.known = np.isfinite(errors)
        wide = np.minimum(problem.high - problem.low, problem.scale)
        self.first = np.where(self.known, np.minimum(_RISE * errors, wide), _FIRST * wide)
        ways = np.where(self.known, covariance / errors**2, 0.0).T
        self.ways = np.where(np.isfinite(ways), ways, 0.0)
        self.lowest, self.where = float(chi_squared), point

    def bound(self, row: _Row) -> float:
        """The bound on this side."""
        ends = self.problem.high if row.outward > 0.0 else self.problem.low
        return float(ends[row.unknown])

    def fitted(self, points: Any, unknowns: Any) -> tuple[Ends, Any, Any]:
        """All but one unknown each fitted again, the rise of the misfit and its slope by that."""
        held = np.arange(len(self.point)) == np.asarray(unknowns)[:, np.newaxis]
        ends = minimise(self.problem, points, held=held, close=_CLOSE, rounds=_ROUNDS)
        k = int(np.argmin(ends.chi_squared))
        if ends.chi_squared[k] < self.lowest:
            self.lowest, self.where = float(ends.chi_squared[k]), ends.points[k]
        rises = np.sqrt(np.maximum(0.0, ends.chi_squared - self.chi_squared))
        return ends, rises, _climbs(self.problem, ends, unknowns)

    def rows(self, which: Iterable[int]) -> list[_Row]:
        """Both sides of these unknowns, from the point.

        To either side by itself: the answer may be at a kink.
        """
        start = minimise(self.problem, self.point[np.newaxis])
        begin = math.sqrt(max(0.0, start.chi_squared[0] - self.chi_squared))
        _, changes, moves = self.problem.neighbours(self.point[np.newaxis])
        misfit = self.problem.misfit(start.outputs[0])
        toward = np.where(moves == 0.0, 0.0, changes / moves)[:, 0] @ misfit
        return [
            _Row(k, outward, self.point, begin, 2.0 * toward[int(outward < 0.0), k])
            for k in which
            for outward in (-1.0, 1.0)
        ]

    def outward(self, rows: list[_Row]) -> list[_Track]:
        """Follow these sides to their bounds, or until the misfit has risen enough."""
        count = len(rows)
        unknowns = np.array([row.unknown for row in rows], dtype=int)
        outward = np.array([row.outward for row in rows])
        at = np.array([row.at for row in rows]).reshape(count, len(self.point))
        rise = np.array([row.rise for row in rows])
        bound = np.array([self.bound(row) for row in rows])
        value = at[np.arange(count), unknowns].copy()
        ways, step = self.ways[unknowns].copy(), self.first[unknowns].copy()
        least = _SHORTEST * step
        tracks = [[(value[k], rise[k], row.climb)] for k, row in enumerate(rows)]
        edge, live = np.zeros(count, dtype=bool), (value != bound) & (rise < LEVELS[-1] - 0.01)
        every = np.arange(count)
        for _ in range(_MOST_STEPS):
            going = every[live]
            if not going.size:
                break
            new = value[going] + outward[going] * step[going]
            new = np.where(outward[going] * (new - bound[going]) >= 0.0, bound[going], new)
            guess = at[going] + ways[going] * (new - value[going])[:, np.newaxis]
            guess = np.clip(guess, self.problem.low, self.problem.high)
            guess[np.arange(going.size), unknowns[going]] = new
            ends, found, climbs = self.fitted(guess, unknowns[going])
            climbed = found - rise[going]
            short = step[going] <= least[going]
            refused = np.isinf(found)
            good = ~refused & ((climbed <= _MOST_RISE) | short)
            edge[going[refused & short]] = True
            live[going[refused & short]] = False
            step[going[~good]] *= np.where(refused[~good], 0.5, _RISE / climbed[~good]).clip(
                0.1, 0.6
            )
            for j in np.flatnonzero(good).tolist():
                row, moved = going[j], new[j] - value[going[j]]
                tracks[row].append((new[j], found[j], climbs[j]))
                ways[row] = (ends.points[j] - at[row]) / moved
                part = _RISE / climbed[j] if climbed[j] > 0.0 else _LONGER
                step[row] = abs(moved) * min(max(part, 1.0 / _LONGER), _LONGER)
                at[row], value[row], rise[row] = ends.points[j], new[j], found[j]
                live[row] = new[j] != bound[row] and found[j] < LEVELS[-1] - 0.01
        return [_Track(track, bool(edge[k])) for k, track in enumerate(tracks)]

    def side(self, row: _Row, track: _Track) -> Side:
        """One side as it was followed."""
        values, rises, slopes = np.array(track.steps).T
        return Side(values, rises, slopes, self.bound(row), track.at_edge)

    def valleys(self, ends: dict[tuple[int, float], tuple[float, float]]) -> list[_Row]:
        """Where the misfit has another valley beside a profile's: at these values, by unknown and
        side, with their rises, searches from around find the others elsewhere for clearly less.
        The ``scout`` searches, and where it ended the others are fitted again.

        At a kink, as where a contact just sticks, one valley leads up on either side of it.
        """
        if not ends:
            return []
        away = 2.0 * self.first
        starts, places = [], []
        for (k, _), (value, _) in ends.items():
            centre = self.point + self.ways[k] * (value - self.point[k])
            around = centre + spread(_BESIDE, -away, away)
            around = np.clip(around, self.problem.low, self.problem.high)
            around[:, k] = value
            starts.append(around)
            places += [k] * _BESIDE
        held = np.arange(len(self.point)) == np.asarray(places)[:, np.newaxis]
        tried = minimise(
            self.scout, np.concatenate(starts), held=held, close=_CLOSE, rounds=_ROUNDS
        )
        best = np.argmin(tried.chi_squared.reshape(-1, _BESIDE), axis=1)
        points = tried.points.reshape(-1, _BESIDE, len(self.point))[np.arange(len(ends)), best]
        found, rises, climbs = self.fitted(points, [k for k, _ in ends])
        return [
            _Row(k, outward, found.points[i], rises[i], climbs[i])
            for i, ((k, outward), (_, rise)) in enumerate(ends.items())
            if rises[i] < rise - _CLEARLY
        ]

    def inward(self, row: _Row) -> list[tuple[float, float, float]]:
        """The way back from another valley towards the answer, outward again: values, rises and
        slopes.
        """
        track, at = [], row.at
        start = self.point[row.unknown]
        for share in _BACK:
            new = start + share * (row.at[row.unknown] - start)
            guess = at.copy()
            guess[row.unknown] = new
            ends, rises, climbs = self.fitted(guess[np.newaxis], [row.unknown])
            if not math.isfinite(rises[0]):
                break
            at = ends.points[0]
            track.append((float(new), float(rises[0]), float(climbs[0])))
        return track[::-1]


def followed(
    problem: Problem,
    point: Any,
    chi_squared: float,
    covariance: Any,
    which: Iterable[int],
    scout: Problem,
) -> Found:
    """The profiles of these unknowns from a point, and of those whose range reaches into another
    valley of the misfit; the rise is above ``chi_squared``, which is that of the best answer.

    ``scout`` is a problem with nearly the same answers, or the same, that costs less.
    """
    profiles = _Profiles(problem, point, chi_squared, covariance, scout)
    chosen = [int(k) for k in which]
    # One unknown has no others to be found elsewhere, and where no range bends all lie in one.
    several = len(point) > 1 and len(chosen) > 0
    two: dict[tuple[int, float], tuple[float, float]] = {}
    for k in np.flatnonzero(profiles.known).tolist():
        if k not in chosen and several:
            error = math.sqrt(covariance[k, k])
            two |= {(k, way): (point[k] + 2.0 * way * error, 2.0) for way in (-1.0, 1.0)}
    chosen += sorted({row.unknown for row in profiles.valleys(two)})
    rows = profiles.rows(chosen)
    both = [profiles.side(*one) for one in zip(rows, profiles.outward(rows), strict=True)]
    sides = {row.unknown: (both[i - 1], both[i]) for i, row in enumerate(rows) if i % 2}
    reached = {}
    for row, side in zip(rows, both, strict=True):
        value = side.reach(2.0)
        if several and math.isfinite(value) and value != point[row.unknown]:
            rise = 2.0 if side.rises[-1] >= 2.0 else float(side.rises[-1])
            reached[row.unknown, row.outward] = value, rise
    beside = profiles.valleys(reached)
    valleys: dict[int, list[tuple[Side, Side]]] = {}
    for row, track in zip(beside, profiles.outward(beside), strict=True):
        side = profiles.side(row, track._replace(steps=profiles.inward(row) + track.steps))
        pair = (_NOWHERE, side) if row.outward > 0.0 else (side, _NOWHERE)
        valleys.setdefault(row.unknown, []).append(pair)
    return Found(sides, valleys, profiles.lowest, profiles.where)


def _climbs(problem: Problem, ends: Ends, unknowns: Any) -> Any:
    """Slope of chi-squared by the unknown that each row holds: the others add nothing to it where
    it is least in them.
    """
    gradient = 2.0 * np.einsum("kmn,km->kn", ends.slopes, problem.misfit(ends.outputs))
    return gradient[np.arange(len(unknowns)), unknowns]


def table(pairs: list[tuple[Side, Side]]) -> list[tuple[float, float, float]]:
    """Rise of the misfit in sigma, and the least and the greatest value with no more, of all these
    profiles of one unknown; the first is that of the best answer.
    """
    rows, low, high = [], math.inf, -math.inf
    for level in LEVELS.tolist():
        low = min([low, *(x for one in pairs if not math.isnan(x := one[0].reach(level)))])
        high = max([high, *(x for one in pairs if not math.isnan(x := one[1].reach(level)))])
        rows.append((level, low, high))
    return rows
