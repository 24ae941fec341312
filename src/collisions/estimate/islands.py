"""Tempered sequential Monte Carlo on plain arrays: points of a posterior in normal scores, and its
evidence.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

# Log-likelihoods of points (cases, dimensions), and by how much they miss sharp bounds: infinite
# where there is no answer.
Evaluate: TypeAlias = Callable[[Any], tuple[Any, Any]]

_FEWEST = 0.25  # of a population: with fewer answers more of the prior is drawn
_MOST_DRAWS = 64  # populations of the prior
# After each resampling points are moved until they have gone so far (1: as far as one point is from
# another), after so many accepted moves a point at least and at most; tries at most.
_GONE, _MOVES, _MOST_MOVES = 0.4, 3.0, 4.0
_GONE_LAST, _MOVES_LAST, _MOST_MOVES_LAST = 0.95, 10.0, 15.0
_MOST_SWEEPS = 80
_ACCEPTED = 0.25, 0.3  # share of steps and of draws to aim at, which suits many dimensions
_LEAST_SHARE, _FORGET = 0.35, 0.3  # of proposals each kind keeps; weight of the last ones' success
_NOISE = 0.1  # of the spread, beside the differences of points
_FLAT = 1e-12  # of the prior's variance: what is added to that of points, which may be the same
_NO_NEARER, _MOST_OF_THESE = (
    0.98,
    5,
)  # sharp bounds that so many stages miss by as much cannot be met
# Ordinary evidence takes 5 to 50 stages. A stage goes on by a quarter of a deviation of the prior
# or more, so that these end at 100 deviations from its mean at least: no prior means that.
_MOST_STAGES = 500
# After so many stages the further way is judged by what the last ones gained: beyond reach is what
# at that rate would take so many stages by its misfit, and so many by the power. Where evidence
# contradicts itself the misfit stays, and the power rises fast.
_JUDGED, _LAST_STAGES, _STAGES_BY_MISFIT, _STAGES_BY_POWER = 12, 6, 10_000, 100
# where the rounding of a logarithm is no longer small against 1, and all points are as likely
_MOST_MISFIT = 1e13
_BISECTIONS = 40


class UnreachableError(Exception):
    """No point has an answer (``missed`` is infinite), none meets the sharp bounds, or all are too
    far away (it is 0).
    """

    def __init__(self, draws: int, missed: float) -> None:
        super().__init__(draws, missed)
        self.draws = draws
        self.missed = missed


class Island(NamedTuple):
    """Equally likely points, the logarithm of their evidence, the share of the prior that was
    refused, and of moved points; the cases that the model, and a finer one, were called with; and
    the share of points that only the finer one answers.
    """

    points: Any
    log_evidence: float
    refused: float
    moved: float
    calls: int
    finer_calls: int
    beyond: float


class Islands:
    """Points (islands, points, dimensions) of the prior (standard normal) times likelihood**power,
    within ``limit`` of bounds.

    The powers rise to 1: P. Del Moral, A. Doucet, A. Jasra, "Sequential Monte Carlo samplers", J.
    R. Statist. Soc. B 68 (2006); each leaves half of the effective sample size. The points are then
    moved by Metropolis steps of two kinds (``Proposals``), made of the points of other islands:
    steps that depended on the errors of their own island would leave the evidence too high. Sharp
    bounds are met first, by thresholds that half of the points pass: S.-K. Au and J. L. Beck,
    Probabilistic Engineering Mechanics 16 (2001).
    """

    # Where the powers end.
    end: float = 1.0
    points: Any
    likelihood: Any
    missed: Any

    def __init__(
        self, evaluate: Evaluate, shape: tuple[int, int, int], random: np.random.Generator
    ) -> None:
        self.evaluate, self.shape, self.random = evaluate, shape, random
        # What goes with each point when points are resampled.
        self.carried: tuple[str, ...] = ("points", "likelihood", "missed")
        self.power, self.limit = 0.0, math.inf
        # Of each kind of proposal its size, and how far it lately went.
        self.sizes, self.went = [2.38 / math.sqrt(2.0 * shape[2]), 0.5], [1.0, 1.0]
        self.log_evidence, self.refused, self.moved = (
            np.full(shape[0], start) for start in (0.0, 0.0, 1.0)
        )
        self.beyond = np.zeros(shape[0])
        self.calls, self.finer_calls = (np.zeros(shape[0], dtype=np.intp) for _ in range(2))

    def found(self, report: Callable[[float], None]) -> list[Island]:
        """The islands, taken from the prior to the posterior."""
        self._reach_posterior(report)
        return list(
            map(
                Island,
                self.points,
                self.log_evidence.tolist(),
                self.refused.tolist(),
                self.moved.tolist(),
                self.calls.tolist(),
                self.finer_calls.tolist(),
                self.beyond.tolist(),
            )
        )

    def _reach_posterior(self, report: Callable[[float], None]) -> None:
        """From the prior to the posterior."""
        self._draw()
        self._meet_bounds()
        # Of each stage the power and the misfit of the best point, in standard errors.
        stages: list[tuple[float, float]] = []
        for _ in range(_MOST_STAGES):
            if self.power == self.end or _beyond_reach(stages, self.end):
                break
            self._raise_power()
            best = float(np.max(self.likelihood))
            stages.append((self.power, math.sqrt(max(-2.0 * best, 0.0))))
            report(self.power)
        if self.power < self.end or np.max(self.likelihood) < -_MOST_MISFIT:
            raise UnreachableError(0, 0.0)

    def _evaluated(self, points: Any) -> tuple[Any, Any, Any]:
        """Points with their log-likelihoods and by how much they miss."""
        likelihood, missed = self.evaluate(points.reshape(-1, points.shape[2]))
        self.calls += points.shape[1]
        return points, likelihood.reshape(points.shape[:2]), missed.reshape(points.shape[:2])

    def _draw(self) -> None:
        """Points of the prior that have an answer."""
        count, drawn, known = self.shape[1], [], np.zeros((self.shape[0], 0), dtype=bool)
        while (
            np.any(np.sum(known, axis=1) < _FEWEST * count) and known.shape[1] < _MOST_DRAWS * count
        ):
            drawn.append(self._evaluated(self.random.standard_normal(self.shape)))
            known = np.concatenate([known, drawn[-1][2] < math.inf], axis=1)
        if not np.all(np.any(known, axis=1)):
            raise UnreachableError(known.shape[1], math.inf)
        self.points, self.likelihood, self.missed = (
            np.concatenate(part, axis=1) for part in zip(*drawn, strict=True)
        )
        self.refused = np.mean(~known, axis=1)
        self._drawn(known)
        if not np.all(known):
            self._select(known.astype(np.float64))

    def _drawn(self, known: Any) -> None:
        """What is to be kept of all points drawn, those without an answer among them."""

    def _meet_bounds(self) -> None:
        """Narrow the limit until the sharp bounds are met."""
        stuck = 0
        while self.limit > 0.0 and np.any(self.missed > 0.0):
            # That half of the points of each island pass.
            limit = float(np.max(np.median(self.missed, axis=1)))
            stuck = stuck + 1 if limit > _NO_NEARER * self.limit else 0
            if stuck == _MOST_OF_THESE:
                raise UnreachableError(0, float(np.min(self.missed)))
            self.limit = limit
            self._select((self.missed <= limit).astype(np.float64))
        self.limit = 0.0

    def _raise_power(self) -> None:
        """The next power, at which half of the effective sample size is left, or 1."""
        rest = self.end - self.power
        more, best, behind = step_of(self.likelihood, rest)
        self.power = self.end if more == rest else self.power + more
        self.log_evidence += more * best[:, 0]
        self._select(np.exp(more * behind))

    def _select(self, weights: Any) -> None:
        """Systematic resampling by weight, whose mean goes into the evidence; then moves that keep
        the distribution.
        """
        spread = self._resample(weights)
        self._move(Proposals(self.points, np.roll(_NOISE * spread, 1, axis=0)))

    def _resample(self, weights: Any) -> Any:
        """Systematic resampling by weight, whose mean goes into the evidence; the weighted
        deviations of the points.
        """
        self.log_evidence += np.log(np.mean(weights, axis=1))
        sums = np.cumsum(weights, axis=1)
        weights = (weights / sums[:, -1:])[..., np.newaxis]
        away = self.points - np.sum(weights * self.points, axis=1, keepdims=True)
        spread = np.sqrt(np.sum(weights * away**2, axis=1, keepdims=True))
        count = self.shape[1]
        places = (self.random.random((len(sums), 1)) + np.arange(count)) / count * sums[:, -1:]
        chosen = np.stack(
            [np.searchsorted(row, place) for row, place in zip(sums, places, strict=True)]
        )
        chosen = np.minimum(chosen, weights.shape[1] - 1)
        for name in self.carried:
            part = getattr(self, name)
            index = chosen[..., np.newaxis] if part.ndim == 3 else chosen
            setattr(self, name, np.take_along_axis(part, index, axis=1))
        return spread

    def _move(self, proposals: Proposals) -> None:
        """Metropolis steps until the points have gone far enough."""
        accepted, start = np.zeros(self.shape[:2], dtype=np.intp), self.points.copy()
        enough, least, most = (
            (_GONE, _MOVES, _MOST_MOVES)
            if self.power < self.end
            else (_GONE_LAST, _MOVES_LAST, _MOST_MOVES_LAST)
        )
        for _ in range(_MOST_SWEEPS):
            points, gain, drawn = self._proposed(proposals, self.points)
            points, likelihood, missed = self._evaluated(points)
            gain += self.power * (likelihood - self.likelihood)
            better = (missed <= self.limit) & (
                -self.random.standard_exponential(accepted.shape) < gain
            )
            self._adapt(drawn, better, proposals.gone(self.points, points))
            self.points[better], self.likelihood[better] = points[better], likelihood[better]
            self.missed[better] = missed[better]
            accepted += better
            moves = float(np.mean(accepted))
            far = float(np.mean(proposals.gone(start, self.points)))
            if moves >= most or (moves >= least and far >= enough):
                break
        self.moved = np.mean(accepted > 0, axis=1)

    def _proposed(self, proposals: Proposals, points: Any) -> tuple[Any, Any, Any]:
        """A point to go to from each point; the logarithm of how much more likely it is by the
        prior, and to be come from; and whether it was drawn rather than stepped to.
        """
        share = min(max(self.went[1] / max(sum(self.went), 1e-300), _LEAST_SHARE), 1 - _LEAST_SHARE)
        drawn = self.random.random(self.shape[:2]) < share
        stepped = proposals.stepped(points, self.sizes[0], self.random)
        found, gain = proposals.drawn(points, self.sizes[1], self.random)
        found = np.where(drawn[..., np.newaxis], found, stepped)
        prior = 0.5 * np.sum((points - found) * (points + found), axis=2)
        return found, prior + np.where(drawn, gain, 0.0), drawn

    def _adapt(self, drawn: Any, better: Any, gone: Any) -> None:
        """Size and share of each kind of proposal, by how many were accepted and how far these
        went.
        """
        for kind, chosen in enumerate((~drawn, drawn)):
            if np.any(chosen):
                rate = float(np.mean(better[chosen]))
                self.sizes[kind] *= math.exp(rate - _ACCEPTED[kind])
                went = float(np.mean((better * gone)[chosen]))
                self.went[kind] += _FORGET * (went - self.went[kind])
        self.sizes[1] = min(self.sizes[1], 1.0)


class Proposals:
    """Where points (islands, points, dimensions) may go, of the points of the other islands.

    Steps go along the difference of two points of the next island, with some ``noise`` in all
    directions, which suits separate modes too: C. J. F. ter Braak, Statistics and Computing 16
    (2006). Draws are from the normal distribution fitted to all the other islands, correlated with
    where the point is so that the fitted distribution is kept: R. M. Neal, "Regression and
    classification using Gaussian process priors", Bayesian Statistics 6 (1999). Near a normal
    posterior they go as far in many dimensions as in few.
    """

    def __init__(self, points: Any, noise: Any) -> None:
        self.next, self.noise, self.shape = np.roll(points, 1, axis=0), noise, points.shape
        islands, _, dimensions = points.shape
        fitted = []
        for k in range(islands):
            others = points[np.arange(islands) != k].reshape(-1, dimensions)
            mean = np.mean(others, axis=0)
            covariance = np.einsum("ni,nj->ij", others - mean, others - mean) / len(others)
            # Towards independence, by how little so few points tell of so many dimensions.
            doubt = dimensions / (dimensions + len(others))
            covariance *= 1.0 - doubt + doubt * np.eye(dimensions)
            root = np.linalg.cholesky(covariance + _FLAT * np.eye(dimensions))
            fitted.append((mean, root, np.linalg.inv(root)))
        means, self.root, self.inverse = map(np.stack, zip(*fitted, strict=True))
        self.mean = means[:, np.newaxis]
        self.variance = np.sum(self.root**2, axis=2)[:, np.newaxis]

    def gone(self, start: Any, points: Any) -> Any:
        """How far each point is from where it was: 1 in the mean where that does not matter."""
        return np.mean(0.5 * (points - start) ** 2 / self.variance, axis=2)

    def stepped(self, points: Any, size: float, random: np.random.Generator) -> Any:
        """Each point and a step from it."""
        islands, count, _ = self.shape
        which = np.arange(islands)[:, np.newaxis]
        one = random.integers(count, size=(islands, count))
        other = (one + random.integers(1, count, size=(islands, count))) % count
        step = self.next[which, one] - self.next[which, other]
        return points + size * (step + self.noise * random.standard_normal(self.shape))

    def drawn(self, points: Any, size: float, random: np.random.Generator) -> tuple[Any, Any]:
        """A draw for each point, and the logarithm of how much less likely it is than the point by
        the fitted distribution; of size 1 it is independent of the point.
        """
        scores = np.einsum("kij,knj->kni", self.inverse, points - self.mean)
        found = math.sqrt(1.0 - size**2) * scores + size * random.standard_normal(self.shape)
        gain = 0.5 * np.sum((found - scores) * (found + scores), axis=2)
        return self.mean + np.einsum("kij,knj->kni", self.root, found), gain


def step_of(ratios: Any, most: float, least: float = 0.5) -> tuple[float, Any, Any]:
    """The power of these likelihood ratios, by their logarithms (islands, points), that leaves so
    much of the effective sample size, or ``most``; the greatest logarithm of each island, and by
    how much the others are below it.
    """
    best = np.max(ratios, axis=1, keepdims=True)
    behind = ratios - best

    def effective(more: float) -> float:
        weights = np.exp(more * behind)
        return float(np.mean(np.mean(weights, axis=1) ** 2 / np.mean(weights**2, axis=1)))

    more = high = most
    if effective(high) < least:
        low = min(high, 0.1 / max(-float(np.min(behind)), 1e-300))
        for _ in range(_BISECTIONS):
            more = math.sqrt(low) * math.sqrt(high)
            low, high = (more, high) if effective(more) >= least else (low, more)
    return more, best, behind


def _beyond_reach(stages: Sequence[tuple[float, float]], end: float) -> bool:
    """Whether points that have come so far, by the power and the misfit of the best one after each
    stage, would not get to the evidence.
    """
    if len(stages) < _JUDGED:
        return False
    (power, misfit), (last_power, last_misfit) = stages[-_LAST_STAGES - 1], stages[-1]
    nearer = (misfit - last_misfit) / _LAST_STAGES
    risen = math.log(last_power / power) / _LAST_STAGES
    return (
        last_misfit > _STAGES_BY_MISFIT * max(nearer, 0.0)
        and math.log(end / last_power) > _STAGES_BY_POWER * risen
    )
