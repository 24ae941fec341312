"""From the posterior of one model to that of a finer one: tempered sequential Monte Carlo between
two likelihoods.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from .islands import Islands, Proposals, UnreachableError, step_of

# The highest power of the first model's likelihood.
_MOST_POWER = 0.15
# Of the effective sample size, on the way from there; with less, regions in which the models differ
# by more are all but lost.
_LEFT = 0.9
# As in islands.py; every move asks the finer model.
_GONE, _MOST_MOVES, _GONE_LAST, _MOST_MOVES_LAST, _MOST_SWEEPS = 0.4, 2.0, 0.9, 5.0, 80
# the last of them, where more than so many points lie where the first model has no answer: these
# are reached from beside
_MOVES_BEYOND, _BEYOND = 10.0, 0.01
# Steps judged by the guide between two questions to the finer model: as many as leave so large a
# share of moves that it confirms, until they lead so far.
_CONFIRMED, _FAR, _FEWEST_STEPS, _MOST_STEPS_OF_GUIDE = 0.5, 0.9, 1.0, 30.0
_REMEMBERED = 8  # sweeps whose answers of the finer model serve the guide
# Points without an answer of the first model get this share of its posterior, so that none that
# the finer model answers is out of reach.
_UNANSWERED = 0.05
_NONE_SEEN = 3.0  # of all draws: fewer than so many may go unseen, with a chance of 5 percent
_MOST_STEPS = 100
_PER_TERM, _FLAT = 4, 1e-9  # values for each term of a fit, and what is left out of it

# Of points (cases, dimensions), what a model computes of each observation (cases, observations).
Computed: TypeAlias = Callable[[Any], Any]


class FinerUnreachableError(Exception):
    """The finer model leaves nothing of the posterior of the first model, or is too far from it."""


class TwoModels(NamedTuple):
    """What two models compute; the likelihood of that, and by how much it misses, as ``Evaluate``
    gives them; how far the second of two such is from the first; and the error of each observation.

    The likelihood must have softened sharp bounds, which the finer model may meet elsewhere.
    """

    model: Computed
    finer: Computed
    judged: Callable[[Any], tuple[Any, Any]]
    apart: Callable[[Any, Any], Any]
    errors: Any


class Stage(NamedTuple):
    """Where the way to the first model's posterior was at a power."""

    power: float
    points: Any
    likelihood: Any
    missed: Any
    log_evidence: Any


# Logarithms of how likely points are nearly, of them, what the first model computes and its
# log-likelihood.
Guide: TypeAlias = Callable[[Any, Any, Any], Any]


class FinerIslands(Islands):
    """Islands on the way to the posterior of a model, then on to that of a finer one.

    The first model's likelihood is raised to the power ``end`` only, so that its posterior is wide
    enough to cover that of the finer model, and tails that only the finer one has are seen (from
    the full power they were missed without a sign). Where the two differ by several errors of the
    readings, it goes back to a lower power: half-way between them all points would be drawn to
    where they differ least, and would not spread again. From there the target rises along
    likelihood**(end * (1 - share)) * finer_likelihood**share, in steps that leave half of the
    effective sample size: a path between two posteriors as between prior and posterior (P. Del
    Moral, A. Doucet, A. Jasra, 2006). Points go
    some steps that only the model that costs less judges, corrected by what the finer one was seen
    to compute otherwise; the finer model is asked where these lead, and confirms the whole way or
    refuses it, so that the two together keep the target exactly: J. S. Liu, "Monte Carlo Strategies
    in Scientific Computing" (2001), section 9.4.3; J. A. Christen and C. Fox, "Markov chain Monte
    Carlo using an approximation", J. Comput. Graph. Statist. 14 (2005). Sharp bounds are met last,
    by the finer model.
    """

    end: float
    computed: Any
    finer: Any
    apart: Any
    _draws: Any
    _known: Any

    def __init__(
        self, models: TwoModels, shape: tuple[int, int, int], random: np.random.Generator
    ) -> None:
        super().__init__(lambda points: self._first(points)[1:], shape, random)
        self.models = models
        self.end = _MOST_POWER
        self.stages: list[Stage] = []
        self.share: float | None = None
        self.floor, self.steps = -math.inf, 4.0
        # What the finer model was seen to compute: points, what the first one computes there, and
        # how far the finer one is from that.
        self.seen: list[tuple[Any, Any, Any]] = []

    def _first(self, points: Any) -> tuple[Any, Any, Any]:
        """What the first model computes, with likelihood; only the finer one must meet bounds."""
        computed = self.models.model(points)
        likelihood, missed = self.models.judged(computed)
        return computed, likelihood, np.where(np.isfinite(missed), 0.0, missed)

    def _reach_posterior(self, report: Callable[[float], None]) -> None:
        """From the prior towards the posterior of the first model, and on to that of the finer."""
        super()._reach_posterior(lambda part: report(0.5 * part))
        while True:
            # From here on that to the power reached.
            self.likelihood = self.end * self.likelihood
            self._open_unanswered()
            everywhere = np.ones(self.shape[:2], dtype=bool)
            self.finer, self.missed, self.apart = self._finer_of(
                self.points, self.computed, everywhere
            )
            most = self._widest()
            if most >= self.end:
                break
            self._go_back(most)
        self.share, self.limit = 0.0, math.inf
        self.carried = (*self.carried, "computed", "finer", "apart")
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

    def _raise_power(self) -> None:
        """The next power, from a place that is kept."""
        kept = self.points, self.likelihood, self.missed, self.log_evidence
        self.stages.append(Stage(self.power, *(part.copy() for part in kept)))
        super()._raise_power()

    def _widest(self) -> float:
        """The power up to which points do not crowd where the two models differ least.

        On the way from the power p of the one likelihood to the other, at a share s, a point at
        which the readings that the two compute are d errors apart weighs exp(-w d**2 / 2) beside
        what fits both best, where w is p (1 - s) s / (p (1 - s) + s), at most p / (1 + sqrt(p))**2.
        These weights are to leave most of the effective sample size.
        """
        apart = self.apart.reshape(-1, self.apart.shape[2]) / self.models.errors
        squares = np.sum(apart**2, axis=1)
        squares = squares[np.isfinite(squares)]
        if not squares.size:
            return self.end
        most = self.end / (1.0 + math.sqrt(self.end)) ** 2
        more, _, _ = step_of(-0.5 * squares[np.newaxis], most, _LEFT)
        return self.end if more == most else (math.sqrt(more) / (1.0 - math.sqrt(more))) ** 2

    def _go_back(self, power: float) -> None:
        """To the last stage of the first model at this power or below, where its points go on until
        they have gone far enough.
        """
        while self.stages[-1].power > power:
            self.stages.pop()
        stage = self.stages.pop()
        self.power = self.end = stage.power
        for name, value in stage._asdict().items():
            setattr(self, name, value)
        self._select(np.ones(self.shape[:2]))

    def _first_of(self, points: Any) -> tuple[Any, Any]:
        """What the first model computes, and its log-likelihood to the power of this path."""
        computed, likelihood, _ = self._first(points.reshape(-1, self.shape[2]))
        self.calls += points.shape[1]
        likelihood = likelihood.reshape(points.shape[:2])
        likelihood = np.where(np.isfinite(likelihood), self.end * likelihood, self.floor)
        return computed.reshape(*points.shape[:2], -1), likelihood

    def _finer_of(self, points: Any, computed: Any, chosen: Any) -> tuple[Any, Any, Any]:
        """Log-likelihoods by the finer model, by how much the chosen points miss, and how far what
        it computes is from what the first one computes there.
        """
        likelihood, missed = (np.full(self.shape[:2], end) for end in (-math.inf, math.inf))
        apart = np.full(computed.shape, math.nan)
        if np.any(chosen):
            found = self.models.finer(points[chosen])
            likelihood[chosen], missed[chosen] = self.models.judged(found)
            apart[chosen] = self.models.apart(computed[chosen], found)
        self.finer_calls += np.sum(chosen, axis=1)
        self.seen = [*self.seen[1 - _REMEMBERED :], (points, computed, apart)]
        return likelihood, missed, apart

    def _drawn(self, known: Any) -> None:
        """All points drawn from the prior, of which the finer model may answer the others."""
        self._draws, self._known = self.points, known

    def _open_unanswered(self) -> None:
        """Give points without an answer of the first model a small share of its posterior."""
        unanswered = ~self._known
        share = max(float(np.mean(unanswered)), _NONE_SEEN / unanswered.size)
        pooled = float(np.mean(self.log_evidence))
        self.floor = min(
            math.log(_UNANSWERED / share) + pooled, float(np.min(self.likelihood)) - 1.0
        )
        if np.any(unanswered):
            self._add_unanswered(unanswered)
        self.computed, self.likelihood = self._first_of(self.points)

    def _add_unanswered(self, unanswered: Any) -> None:
        """Draws without an answer among the points, by the floor of the likelihood there."""
        count, draws = self.shape[1], unanswered.shape[1]
        of_draws = unanswered * np.exp(self.floor - self.log_evidence)[:, np.newaxis] / draws
        weights = np.concatenate([np.full(self.shape[:2], 1.0 / count), of_draws], axis=1)
        self.points = np.concatenate([self.points, self._draws], axis=1)
        for name, value in (("likelihood", self.floor), ("missed", 0.0)):
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

    def _move(self, proposals: Proposals) -> None:
        """Metropolis steps judged by the guide, and where they lead by the finer model."""
        if self.share is None:
            super()._move(proposals)
            return
        accepted, start = np.zeros(self.shape[:2], dtype=np.intp), self.points.copy()
        guide = self._guide(self.share)
        here = guide(self.points, self.computed, self.likelihood)
        last = self.share == 1.0 and (self.limit == 0.0 or not np.any(self.missed > 0.0))
        enough, most = (_GONE_LAST, _MOST_MOVES_LAST) if last else (_GONE, _MOST_MOVES)
        for _ in range(_MOST_SWEEPS):
            points, computed, likelihood, there = self._guided(guide, here, proposals)
            passed = np.any(points != self.points, axis=2)
            finer, missed, apart = self._finer_of(points, computed, passed)
            gain = (
                (1.0 - self.share) * (likelihood - self.likelihood)
                + self.share * (finer - self.finer)
                - (there - here)
            )
            better = (
                passed
                & (missed <= self.limit)
                & (-self.random.standard_exponential(accepted.shape) < gain)
            )
            confirmed = float(np.sum(better)) / max(float(np.sum(passed)), 1.0)
            far = float(np.mean(proposals.gone(self.points, points)))
            if confirmed < _CONFIRMED or far < _FAR:
                self.steps *= math.exp(confirmed - _CONFIRMED)
                self.steps = min(max(self.steps, _FEWEST_STEPS), _MOST_STEPS_OF_GUIDE)
            for name, new in (
                ("points", points),
                ("computed", computed),
                ("likelihood", likelihood),
                ("finer", finer),
                ("missed", missed),
                ("apart", apart),
            ):
                getattr(self, name)[better] = new[better]
            here[better] = there[better]
            accepted += better
            self.beyond = np.mean(self.likelihood == self.floor, axis=1)
            moves = float(np.mean(accepted))
            if last and np.max(self.beyond) > _BEYOND and moves < _MOVES_BEYOND:
                continue
            if moves >= most or np.mean(proposals.gone(start, self.points)) >= enough:
                break
        self.moved = np.mean(accepted > 0, axis=1)

    def _guided(self, guide: Guide, here: Any, proposals: Proposals) -> tuple[Any, Any, Any, Any]:
        """Where some steps lead that only the guide judges: points, with what the first model
        computes, its likelihood and the guide there.
        """
        at = [self.points.copy(), self.computed.copy(), self.likelihood.copy(), here.copy()]
        for _ in range(round(self.steps)):
            points, gain, drawn = self._proposed(proposals, at[0])
            computed, likelihood = self._first_of(points)
            there = guide(points, computed, likelihood)
            gain += there - at[3]
            better = -self.random.standard_exponential(gain.shape) < gain
            self._adapt(drawn, better, proposals.gone(at[0], points))
            for old, new in zip(at, (points, computed, likelihood, there), strict=True):
                old[better] = new[better]
        return at[0], at[1], at[2], at[3]

    def _guide(self, share: float) -> Guide:
        """What steps are judged by, of points, what the first model computes and its
        log-likelihood.

        It is the target with what the finer model computes replaced by what the first one computes
        and a correction: by least squares over what the finer one was seen to compute at points of
        the other islands. Any guide keeps the target; a good one is seldom refused.
        """
        seen = [(self.points, self.computed, self.apart), *self.seen]
        points, computed, apart = (np.concatenate(part, axis=1) for part in zip(*seen, strict=True))
        known = np.all(np.isfinite(apart), axis=2)
        corrections = []
        for k in range(self.shape[0]):
            others = (np.arange(self.shape[0]) != k)[:, np.newaxis] & known
            if not np.any(others):
                others = known
            corrections.append(Correction(points[others], computed[others], apart[others]))

        # Where the first model does not know, as likely as most points are.
        target = (1.0 - share) * self.likelihood + share * self.finer
        level = float(np.median(target))

        def guide(points: Any, computed: Any, likelihood: Any) -> Any:
            corrected = np.stack(
                [
                    one.of(own, base)
                    for one, own, base in zip(corrections, points, computed, strict=True)
                ]
            )
            finer, _ = self.models.judged(corrected.reshape(-1, corrected.shape[2]))
            finer = finer.reshape(likelihood.shape)
            found = (1.0 - share) * likelihood + share * finer
            return np.where(likelihood == self.floor, level, found)

        return guide


class Correction:
    """What is to be added to what the first model computes, by least squares."""

    def __init__(self, points: Any, computed: Any, apart: Any) -> None:
        self.count = len(points)
        self.low = self.high = np.zeros(apart.shape[1])
        self.middle, self.spread = self.low, self.low + 1.0
        if self.count:
            # Not far beyond what was seen.
            low, high = np.min(apart, axis=0), np.max(apart, axis=0)
            self.low, self.high = 2.0 * low - high, 2.0 * high - low
            self.middle, self.spread = np.mean(computed, axis=0), np.std(computed, axis=0)
            self.spread = np.where(self.spread > 0.0, self.spread, 1.0)
        terms = self._terms(points, computed)
        # Numbers at the edge of the floats have no spread.
        usable = np.all(np.isfinite(terms), axis=1) & np.all(np.isfinite(apart), axis=1)
        self.by, *_ = np.linalg.lstsq(terms[usable], apart[usable], rcond=_FLAT)

    def of(self, points: Any, computed: Any) -> Any:
        """What the finer model will compute, as far as is known."""
        more = np.einsum("ij,jk->ik", self._terms(points, computed), self.by)
        return computed + np.where(np.isfinite(more), np.clip(more, self.low, self.high), 0.0)

    def _terms(self, points: Any, computed: Any) -> Any:
        """Powers and products up to the second of scores, as many as the values determine, and what
        the first model computes.
        """
        dimensions = points.shape[1]
        parts = [np.ones((len(points), 1)), points, (computed - self.middle) / self.spread]
        if self.count >= _PER_TERM * (2 * dimensions + 1 + computed.shape[1]):
            parts.append(points**2)
        if self.count >= _PER_TERM * ((dimensions + 1) * (dimensions + 2) // 2 + computed.shape[1]):
            one, other = np.triu_indices(dimensions, 1)
            parts.append(points[:, one] * points[:, other])
        return np.concatenate(parts, axis=1)
