"""From the posterior of one model to that of a finer one: tempered sequential Monte Carlo between
two likelihoods.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np

from .islands import Evaluate, Islands, UnreachableError, step_of

_MOVES, _MOVES_LAST, _MOST_SWEEPS = 2.0, 5.0, 80  # accepted moves a point, and tries at most
# the last of them, where more than so many points lie where the first model has no answer: these
# are reached from beside
_MOVES_BEYOND, _BEYOND = 10.0, 0.01
_PASSED = 0.3  # share of the moves, judged by the first model, that the finer one is asked about
# Points without an answer of the first model get this share of its posterior, so that none that
# the finer model answers is out of reach.
_UNANSWERED = 0.05
_NONE_SEEN = 3.0  # of all draws: fewer than so many may go unseen, with a chance of 5 percent
_MOST_STEPS = 100
_PER_TERM, _FLAT = 4, 1e-9  # values for each term of a fit, and what is left out of it


class FinerUnreachableError(Exception):
    """The finer model leaves nothing of the posterior of the first model, or is too far from it."""


class FinerIslands(Islands):
    """Islands on the way to the posterior of ``evaluate``, then on to that of ``finer``.

    The first model's likelihood is raised to the power ``end`` only, so that its posterior is wide
    enough to cover that of the finer model, and tails that only the finer one has are seen (from
    the full power they were missed without a sign). From there the target rises along
    likelihood**(end * (1 - share)) * finer_likelihood**share, in steps that leave half of the
    effective sample size: a path between two posteriors as between prior and posterior (P. Del
    Moral, A. Doucet, A. Jasra, 2006). A move is judged first by the model that costs less,
    and only one that passes by the finer model, so that the two together keep the target exactly:
    J. A. Christen and C. Fox, "Markov chain Monte Carlo using an approximation", J. Comput. Graph.
    Statist. 14 (2005). ``evaluate`` must have softened sharp bounds, which the finer model may
    meet elsewhere; these are met last, by the finer model.
    """

    carried: ClassVar[tuple[str, ...]] = ("points", "likelihood", "missed", "finer")
    end: ClassVar[float] = 0.15
    finer: Any
    _draws: Any
    _known: Any

    def __init__(
        self,
        evaluate: Evaluate,
        finer: Evaluate,
        shape: tuple[int, int, int],
        random: np.random.Generator,
    ) -> None:
        super().__init__(evaluate, shape, random)
        self.evaluate_finer = finer
        self.share: float | None = None
        self.floor = -math.inf

    def _reach_posterior(self, report: Callable[[float], None]) -> None:
        """From the prior towards the posterior of the first model, and on to that of the finer."""
        self.finer = np.zeros((self.shape[0], 0))
        super()._reach_posterior(lambda part: report(0.5 * part))
        # From here on that to the power reached.
        self.likelihood = self.end * self.likelihood
        self._open_unanswered()
        everywhere = np.ones(self.shape[:2], dtype=bool)
        self.finer, self.missed = self._finer_of(self.points, everywhere)
        self.share, self.limit = 0.0, math.inf
        answered = np.isfinite(self.finer)
        if not np.all(np.any(answered, axis=1)):
            raise FinerUnreachableError
        if not np.all(answered):
            self._resample(answered.astype(np.float64))
        for _ in range(_MOST_STEPS):
            self._raise_share()
            report(0.5 + 0.5 * self.share)
            if self.share == 1.0:
                break
        else:
            raise FinerUnreachableError
        try:
            self._meet_bounds()
        except UnreachableError:
            raise FinerUnreachableError from None

    def _evaluated(self, points: Any) -> tuple[Any, Any, Any]:
        """Points with their log-likelihoods by the first model, and by how much they miss."""
        points, likelihood, missed = super()._evaluated(points)
        if self.share is not None:
            likelihood = np.where(np.isfinite(likelihood), self.end * likelihood, self.floor)
        return points, likelihood, missed

    def _finer_of(self, points: Any, chosen: Any) -> tuple[Any, Any]:
        """Log-likelihoods by the finer model, and by how much points miss, of the chosen ones."""
        likelihood, missed = (np.full(self.shape[:2], end) for end in (-math.inf, math.inf))
        if np.any(chosen):
            likelihood[chosen], missed[chosen] = self.evaluate_finer(points[chosen])
        self.finer_calls += np.sum(chosen, axis=1)
        return likelihood, missed

    def _drawn(self, known: Any) -> None:
        """All points drawn from the prior, of which the finer model may answer the others."""
        self._draws, self._known = self.points, known
        self.finer = np.zeros(known.shape)

    def _open_unanswered(self) -> None:
        """Give points without an answer of the first model a small share of its posterior."""
        unanswered = ~self._known
        share = max(float(np.mean(unanswered)), _NONE_SEEN / unanswered.size)
        pooled = float(np.mean(self.log_evidence))
        self.floor = min(
            math.log(_UNANSWERED / share) + pooled, float(np.min(self.likelihood)) - 1.0
        )
        self.finer = np.zeros(self.shape[:2])
        if not np.any(unanswered):
            return
        count, draws = self.shape[1], unanswered.shape[1]
        of_draws = unanswered * np.exp(self.floor - self.log_evidence)[:, np.newaxis] / draws
        weights = np.concatenate([np.full(self.shape[:2], 1.0 / count), of_draws], axis=1)
        self.points = np.concatenate([self.points, self._draws], axis=1)
        for name, value in (("likelihood", self.floor), ("missed", 0.0), ("finer", 0.0)):
            part = np.concatenate([getattr(self, name), np.full(unanswered.shape, value)], axis=1)
            setattr(self, name, part)
        self._resample(weights * (count + draws))

    def _raise_share(self) -> None:
        """The next share of the finer model, at which half of the effective sample size is left, or
        1.
        """
        before = self.share or 0.0
        more, best, behind = step_of(self.finer - self.likelihood, 1.0 - before)
        self.share = 1.0 if more == 1.0 - before else before + more
        self.log_evidence += more * best[:, 0]
        self._select(np.exp(more * behind))

    def _move(self, others: Any, noise: Any) -> None:
        """Metropolis steps in two stages: the finer model is asked where the first one passes."""
        if self.share is None:
            super()._move(others, noise)
            return
        accepted = np.zeros(self.shape[:2], dtype=np.intp)
        guide = self._guide(self.share)
        here = guide(self.points, self.likelihood)
        last = self.share == 1.0 and (self.limit == 0.0 or not np.any(self.missed > 0.0))
        wanted = _MOVES
        for _ in range(_MOST_SWEEPS):
            points, likelihood, _ = self._evaluated(self._proposed(others, noise))
            prior = 0.5 * np.sum((self.points - points) * (self.points + points), axis=2)
            there = guide(points, likelihood)
            guided = prior + there - here
            passed = -self.random.standard_exponential(accepted.shape) < guided
            finer, missed = self._finer_of(points, passed)
            gain = (
                prior
                + (1.0 - self.share) * (likelihood - self.likelihood)
                + self.share * (finer - self.finer)
                - guided
            )
            better = (
                passed
                & (missed <= self.limit)
                & (-self.random.standard_exponential(accepted.shape) < gain)
            )
            self.points[better], self.likelihood[better] = points[better], likelihood[better]
            self.finer[better], self.missed[better] = finer[better], missed[better]
            here[better] = there[better]
            accepted += better
            self.scale *= math.exp(np.mean(passed) - _PASSED)
            self.beyond = np.mean(self.likelihood == self.floor, axis=1)
            if last:
                wanted = _MOVES_BEYOND if np.max(self.beyond) > _BEYOND else _MOVES_LAST
            if np.mean(accepted) >= wanted:
                break
        self.moved = np.mean(accepted > 0, axis=1)

    def _guide(self, share: float) -> Callable[[Any, Any], Any]:
        """What moves are judged by first, of points and the first model's log-likelihoods there.

        This is that log-likelihood, to the power that suits the share, and, times the share, a
        quadratic in the scores for how much higher the finer one is, by least squares over the
        points of the other islands. Any guide keeps the target; a good one asks the finer model
        seldom in vain.
        """
        above = self.finer - self.likelihood / self.end
        known = self.likelihood != self.floor
        power = (1.0 - share) + share / self.end
        fitted = []
        for k in range(self.shape[0]):
            others = (np.arange(self.shape[0]) != k)[:, np.newaxis] & known
            if not np.any(others):
                others = known
            values = above[others]
            terms = _terms(self.points[others], len(values))
            by, *_ = np.linalg.lstsq(terms, values, rcond=_FLAT)
            ends = (0.0, 0.0)
            if values.size:
                # Not far beyond what the points show.
                low, high = float(np.min(values)), float(np.max(values))
                ends = (2.0 * low - high, 2.0 * high - low)
            fitted.append((by, ends, len(values)))

        # Where the first model does not know, as likely as most points are.
        target = (1.0 - share) * self.likelihood + share * self.finer
        level = float(np.median(target))

        def guide(points: Any, likelihood: Any) -> Any:
            more = np.stack(
                [
                    np.clip(_weighed(_terms(each, count), by), *ends)
                    for each, (by, ends, count) in zip(points, fitted, strict=True)
                ]
            )
            found = power * likelihood + share * more
            return np.where(likelihood == self.floor, level, found)

        return guide


def _weighed(terms: Any, by: Any) -> Any:
    """The sum of terms by their coefficients; threads of a matrix product cost more than this."""
    return np.einsum("ij,j->i", terms, by)


def _terms(points: Any, count: int) -> Any:
    """Powers and products up to the second of scores (points, dimensions), as many as so many
    values determine.
    """
    dimensions = points.shape[1]
    parts = [np.ones((len(points), 1)), points]
    if count >= _PER_TERM * (2 * dimensions + 1):
        parts.append(points**2)
    if count >= _PER_TERM * (dimensions + 1) * (dimensions + 2) // 2:
        one, other = np.triu_indices(dimensions, 1)
        parts.append(points[:, one] * points[:, other])
    return np.concatenate(parts, axis=1)
