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
from .least_squares import Ends, Problem, minimise

LEVELS = score_of_coverage(0.95) / 8.0 * np.arange(13)  # sigma; the ninth is that of 95 percent
SAME_CHI_SQUARED = 1e-3  # misfits within this are the same
_RISE = 0.98  # sigma, aimed at from one value to the next: two lead to 95 percent
_MOST_RISE, _LONGER, _SHORTEST = 1.5, 4.0, 1e-3  # of steps, the last a part of the first
_MOST_STEPS = 24
_CLOSE, _ROUNDS = 1e-2, 40  # of the fits again: chi-squared to 1e-4
_FIRST = 0.125  # of its scale, for an unknown without a standard error


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


class Found(NamedTuple):
    """Both sides of each unknown that was followed, by its place, and the least misfit met on the
    way.
    """

    sides: dict[int, tuple[Side, Side]]
    lowest: float
    at: Any

    @property
    def refused(self) -> bool:
        """Whether the model refuses within the range of 95 percent."""
        return any(
            side.at_edge and side.rises[-1] < 2.0 for both in self.sides.values() for side in both
        )


def followed(
    problem: Problem, point: Any, chi_squared: float, covariance: Any, which: Iterable[int]
) -> Found:
    """The profiles of these unknowns from a point, by the rise above ``chi_squared``, which is that
    of the best answer. The covariance says where to look first.
    """
    unknowns = np.repeat(np.fromiter(which, dtype=int), 2)
    outward = np.tile([-1.0, 1.0], len(unknowns) // 2)
    count, n = len(unknowns), len(point)
    every = np.arange(count)
    errors = np.sqrt(np.diagonal(covariance))
    wide = np.minimum(problem.high - problem.low, problem.scale)
    first = np.where(np.isfinite(errors), np.minimum(_RISE * errors, wide), _FIRST * wide)
    ways = np.where(np.isfinite(errors), covariance / errors**2, 0.0).T[unknowns]
    ways = np.where(np.isfinite(ways), ways, 0.0)
    bound = np.where(outward > 0.0, problem.high[unknowns], problem.low[unknowns])
    held = np.arange(n) == unknowns[:, np.newaxis]

    start = minimise(problem, point[np.newaxis])
    begin = math.sqrt(max(0.0, start.chi_squared[0] - chi_squared))
    # To either side by itself: the answer may be at a kink.
    _, changes, moves = problem.neighbours(point[np.newaxis])
    toward = np.where(moves == 0.0, 0.0, changes / moves)[:, 0] @ problem.misfit(start.outputs[0])
    climbs = 2.0 * toward[np.where(outward > 0.0, 0, 1), unknowns]
    at, value, rise = np.tile(point, (count, 1)), point[unknowns].copy(), np.full(count, begin)
    step, least = first[unknowns].copy(), _SHORTEST * first[unknowns]
    tracks = [[(value[k], begin, climbs[k])] for k in range(count)]
    edge, live = np.zeros(count, dtype=bool), value != bound
    lowest, where = float(chi_squared), point
    for _ in range(_MOST_STEPS):
        rows = every[live]
        if not rows.size:
            break
        new = value[rows] + outward[rows] * step[rows]
        new = np.where(outward[rows] * (new - bound[rows]) >= 0.0, bound[rows], new)
        guess = at[rows] + ways[rows] * (new - value[rows])[:, np.newaxis]
        guess = np.clip(guess, problem.low, problem.high)
        guess[np.arange(rows.size), unknowns[rows]] = new
        ends = minimise(problem, guess, held=held[rows], close=_CLOSE, rounds=_ROUNDS)
        k = int(np.argmin(ends.chi_squared))
        if ends.chi_squared[k] < lowest:
            lowest, where = float(ends.chi_squared[k]), ends.points[k]
        found = np.sqrt(np.maximum(0.0, ends.chi_squared - chi_squared))
        climbed, climbs = found - rise[rows], _climbs(problem, ends, unknowns[rows])
        short = step[rows] <= least[rows]
        refused = np.isinf(found)
        good = ~refused & ((climbed <= _MOST_RISE) | short)
        edge[rows[refused & short]] = True
        live[rows[refused & short]] = False
        step[rows[~good]] *= np.where(refused[~good], 0.5, _RISE / climbed[~good]).clip(0.1, 0.6)
        for j in np.flatnonzero(good).tolist():
            row, moved = rows[j], new[j] - value[rows[j]]
            tracks[row].append((new[j], found[j], climbs[j]))
            ways[row] = (ends.points[j] - at[row]) / moved
            part = _RISE / climbed[j] if climbed[j] > 0.0 else _LONGER
            step[row] = abs(moved) * min(max(part, 1.0 / _LONGER), _LONGER)
            at[row], value[row], rise[row] = ends.points[j], new[j], found[j]
            live[row] = new[j] != bound[row] and found[j] < LEVELS[-1] - 0.01
    both = []
    for k, track in enumerate(tracks):
        values, rises, slopes = np.array(track).T
        both.append(Side(values, rises, slopes, float(bound[k]), bool(edge[k])))
    sides = {int(unknowns[k]): (both[k], both[k + 1]) for k in range(0, count, 2)}
    return Found(sides, lowest, where)


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
