"""Tempered sequential Monte Carlo on plain arrays: points of a posterior in normal scores, and its evidence."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

# Log-likelihoods of points (cases, dimensions), and by how much they miss sharp bounds: infinite where there is no answer.
Evaluate: TypeAlias = Callable[[Any], tuple[Any, Any]]
# Yields points to be evaluated.
Steps: TypeAlias = Generator[Any, tuple[Any, Any], None]

_FEWEST = 0.25  # of a population: with fewer answers more of the prior is drawn
_MOST_DRAWS = 64  # populations of the prior
_MOVES, _MOVES_LAST, _MOST_SWEEPS = 3.0, 10.0, 80  # accepted moves a point after each resampling, and tries at most
_ACCEPTED = 0.25  # share of moves to aim at, which suits many dimensions
_NOISE = 0.1  # of the spread, beside the differences of points
_NO_NEARER, _MOST_OF_THESE = 0.98, 5  # sharp bounds that so many stages miss by as much cannot be met
_BISECTIONS = 40


class UnreachableError(Exception):
    """No point has an answer (``missed`` is infinite), or none meets the sharp bounds."""

    def __init__(self, draws: int, missed: float) -> None:
        super().__init__(draws, missed)
        self.draws = draws
        self.missed = missed


class Island(NamedTuple):
    """Equally likely points, the logarithm of their evidence, the share of the prior that was refused, and of moved points."""

    points: Any
    log_evidence: float
    refused: float
    moved: float


def islands(
    evaluate: Evaluate,
    dimensions: int,
    count: int,
    randoms: Sequence[np.random.Generator],
    report: Callable[[float], None],
) -> list[Island]:
    """Points of the prior (standard normal) times the likelihood: an island for each generator, worked on side by side.

    By way of the rising powers of the likelihood: P. Del Moral, A. Doucet, A. Jasra, "Sequential Monte Carlo samplers", J. R.
    Statist. Soc. B 68 (2006); each power is the one that leaves half of the effective sample. The points are then moved by
    Metropolis steps along differences of two of them, which suit separate modes too: C. J. F. ter Braak, Statistics and
    Computing 16 (2006). Sharp bounds are met first, by thresholds that half of the points pass: S.-K. Au and J. L. Beck,
    Probabilistic Engineering Mechanics 16 (2001).
    """
    found = [_Population(dimensions, count, random) for random in randoms]
    at_work = [(one, one.steps()) for one in found]
    waiting = [next(steps) for _, steps in at_work]
    while at_work:
        likelihood, missed = evaluate(np.concatenate(waiting))
        ends = np.cumsum([len(points) for points in waiting])[:-1]
        answers = zip(at_work, np.split(likelihood, ends), np.split(missed, ends), strict=True)
        at_work, waiting = [], []
        for (one, steps), *answer in answers:
            try:
                waiting.append(steps.send((answer[0].copy(), answer[1].copy())))
                at_work.append((one, steps))
            except StopIteration:
                pass
        report(min(one.power for one in found))
    return [Island(one.points, one.log_evidence, one.refused, one.moved) for one in found]


class _Population:
    """Points of the prior times likelihood**power, within ``limit`` of the sharp bounds."""

    points: Any
    likelihood: Any
    missed: Any

    def __init__(self, dimensions: int, count: int, random: np.random.Generator) -> None:
        self.dimensions, self.count, self.random = dimensions, count, random
        self.power, self.limit, self.scale = 0.0, math.inf, 2.38 / math.sqrt(2.0 * dimensions)
        self.log_evidence, self.refused, self.moved = 0.0, 0.0, 1.0

    def steps(self) -> Steps:
        """From the prior to the posterior."""
        yield from self._draw()
        yield from self._meet_bounds()
        while self.power < 1.0:
            yield from self._raise_power()

    def _draw(self) -> Steps:
        """Points of the prior that have an answer."""
        drawn: list[tuple[Any, Any, Any]] = []
        draws = answers = 0
        while answers < _FEWEST * self.count and draws < _MOST_DRAWS * self.count:
            points = self.random.standard_normal((self.count, self.dimensions))
            likelihood, missed = yield points
            known = missed < math.inf
            drawn.append((points[known], likelihood[known], missed[known]))
            draws, answers = draws + self.count, answers + int(np.count_nonzero(known))
        if not answers:
            raise UnreachableError(draws, math.inf)
        self.points, self.likelihood, self.missed = (np.concatenate(part) for part in zip(*drawn, strict=True))
        self.refused = 1.0 - answers / draws
        self.log_evidence = math.log(answers / draws)
        if answers < draws:
            yield from self._select(np.ones(answers))

    def _meet_bounds(self) -> Steps:
        """Narrow the limit until the sharp bounds are met."""
        stuck = 0
        while self.limit > 0.0 and np.any(self.missed > 0.0):
            limit = float(np.median(self.missed))
            stuck = stuck + 1 if limit > _NO_NEARER * self.limit else 0
            if stuck == _MOST_OF_THESE:
                raise UnreachableError(0, float(np.min(self.missed)))
            self.limit = limit
            inside = (self.missed <= limit).astype(np.float64)
            self.log_evidence += math.log(np.mean(inside))
            yield from self._select(inside)
        self.limit = 0.0

    def _raise_power(self) -> Steps:
        """The next power, at which half of the effective sample is left, or 1."""
        best = float(np.max(self.likelihood))
        behind = self.likelihood - best

        def effective(more: float) -> float:
            weights = np.exp(more * behind)
            return float(np.sum(weights)) ** 2 / float(np.sum(weights**2))

        more = high = 1.0 - self.power
        if effective(high) < 0.5 * self.count:
            low = min(high, 0.1 / max(-float(np.min(behind)), 1e-300))
            for _ in range(_BISECTIONS):
                more = math.sqrt(low * high)
                low, high = (more, high) if effective(more) >= 0.5 * self.count else (low, more)
        weights = np.exp(more * behind)
        self.log_evidence += math.log(np.mean(weights)) + more * best
        self.power = 1.0 if more == 1.0 - self.power else self.power + more
        yield from self._select(weights)

    def _select(self, weights: Any) -> Steps:
        """Systematic resampling by weight, then moves that keep the distribution."""
        weights = weights / np.sum(weights)
        away = self.points - np.sum(weights[:, np.newaxis] * self.points, axis=0)
        spread = np.sqrt(np.sum(weights[:, np.newaxis] * away**2, axis=0))
        places = (self.random.random() + np.arange(self.count)) / self.count
        chosen = np.minimum(np.searchsorted(np.cumsum(weights), places), len(weights) - 1)
        self.points, self.likelihood, self.missed = self.points[chosen], self.likelihood[chosen], self.missed[chosen]
        yield from self._move(spread)

    def _move(self, spread: Any) -> Steps:
        """Metropolis steps along differences between points as they were at first, with some noise in all directions."""
        start, accepted = self.points.copy(), np.zeros(self.count, dtype=np.intp)
        for _ in range(_MOST_SWEEPS):
            one = self.random.integers(self.count, size=self.count)
            other = (one + self.random.integers(1, self.count, size=self.count)) % self.count
            noise = _NOISE * spread * self.random.standard_normal(self.points.shape)
            points = self.points + self.scale * (start[one] - start[other] + noise)
            likelihood, missed = yield points
            prior = 0.5 * np.sum((self.points - points) * (self.points + points), axis=1)
            gain = prior + self.power * (likelihood - self.likelihood)
            better = (missed <= self.limit) & (-self.random.standard_exponential(self.count) < gain)
            self.points[better], self.likelihood[better] = points[better], likelihood[better]
            self.missed[better] = missed[better]
            accepted += better
            self.scale *= math.exp(np.mean(better) - _ACCEPTED)
            if np.mean(accepted) >= (_MOVES if self.power < 1.0 else _MOVES_LAST):
                break
        self.moved = float(np.mean(accepted > 0))
