"""``Candidate``: a solution of a fit, where a search ended; its errors, and how well they describe the misfit around it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from .fit_problem import FitInputs
from .fit_result import TWO_ERRORS
from .least_squares import CONVERGED, FLAT, REFUSED, Determination, Ends, Problem, determination, minimise

SAME_CHI_SQUARED = 1e-3  # misfits within this are the same
TWO_ERROR_RISE = 4.0  # of chi-squared

_AGREEMENT = 1e-2  # of the scale of an unknown: values within this agree
_NEAR = 1e-2  # standard errors: where the others end when one unknown is moved
_LEAST_MOVE = 0.1  # standard errors: smaller moves and smaller rises are not compared
_STEP_ROUNDS = 4
_MOST_STEPS = 100.0  # standard errors over which slopes may be taken at most
_BESIDE_BOUND = 0.1  # standard errors: an unknown this near to a bound may belong on it
_LEAST_RISE = 1e-5  # of chi-squared, at a tenth of the way to its rise by 4
_PARTS, _HALVINGS, _DIVISIONS = 32, 40, 4  # of the way from a bound to the other


class OneSidedLimit(NamedTuple):
    """For an unknown on a bound where the model turns back: the end of its range of two standard errors, and the error."""

    value: float
    error: float


@dataclass(frozen=True, eq=False)
class Candidate:
    """The point where a search ended, with step sizes that suit it; ``limits`` by the index of the unknown."""

    inputs: FitInputs
    problem: Problem
    point: Any
    outputs: Any
    slopes: Any
    chi_squared: float
    state: int
    limits: dict[int, OneSidedLimit] = field(default_factory=dict)

    @classmethod
    def of(cls, inputs: FitInputs, problem: Problem, ends: Ends, k: int) -> Candidate:
        """The candidate where search k ended."""
        return cls(inputs, problem, *(part[k] for part in ends))

    @cached_property
    def determination(self) -> Determination:
        """The covariance of all unknowns: from the limit for those that have one, from the slopes for the others."""
        n = len(self.point)
        sloped = ~np.isin(np.arange(n), list(self.limits))
        found = self.determination_of(sloped)
        if not self.limits:
            return found
        covariance = np.zeros((n, n))
        covariance[np.ix_(sloped, sloped)] = found.covariance
        lost = np.isinf(np.diagonal(covariance))
        for j, limit in self.limits.items():
            covariance[lost, j] = covariance[j, lost] = math.nan
            covariance[j, j] = limit.error**2
        shares = np.full((n, len(self.outputs)), math.nan)
        shares[sloped] = found.shares
        widen = np.eye(n)[sloped]
        return Determination(covariance, found.unidentified @ widen, found.prior_only @ widen, shares, found.rank)

    def determination_of(self, chosen: Any) -> Determination:
        """The determination of the chosen unknowns by the slopes, with the others fixed."""
        problem = self.problem
        scale = np.where(self.only_a_start, np.maximum(problem.scale, abs(self.point)), problem.scale)
        steps = problem.steps(self.point)
        return determination(self.slopes[:, chosen], self.inputs.is_prior, scale[chosen], self.outputs, steps[chosen])

    @property
    def only_a_start(self) -> Any:
        """For each unknown, whether its scale is only a guide for where to start."""
        return self.problem.unbounded & ~self.inputs.has_prior

    @property
    def errors(self) -> Any:
        """Standard errors; infinite for unknowns that are not identified."""
        return np.sqrt(np.diagonal(self.determination.covariance))

    @property
    def free(self) -> Any:
        """For each unknown, whether it is off its bounds; one that is not identified counts as off."""
        at_bound = (self.point <= self.problem.low) | (self.point >= self.problem.high)
        return ~(np.isfinite(self.errors) & at_bound)

    def agreed(self, ends: Ends) -> Any:
        """For each unknown, whether all searches with this misfit ended at one value, as they do not if it is unidentified."""
        here = (ends.state == CONVERGED) & (ends.chi_squared <= self.chi_squared + SAME_CHI_SQUARED)
        if np.count_nonzero(here) < 2:
            return np.zeros(len(self.point), dtype=bool)
        return np.ptp(ends.points[here], axis=0) < _AGREEMENT * self.problem.scale

    def rise(self, starts: Any, moved: Any) -> Any:
        """The rise of chi-squared at these points, with one unknown fixed and the others refitted; NaN where refused."""
        movable = np.ones(starts.shape, dtype=bool)
        movable[np.arange(len(starts)), moved] = False
        ends = minimise(self.problem, starts, movable, close=_NEAR)
        return np.where(ends.state == REFUSED, np.nan, np.maximum(ends.chi_squared - self.chi_squared, 0.0))

    @cached_property
    def moves(self) -> tuple[Any, Any]:
        """Moves of each unknown up and down (2, n), up to two errors, and the rise of the misfit at each in sigma."""
        covariance = self.determination_of(self.free).covariance
        known = np.isfinite(np.diagonal(covariance))
        which, covariance = np.flatnonzero(self.free)[known], covariance[np.ix_(known, known)]
        if not which.size:
            return np.zeros((2, 0)), np.zeros((2, 0))
        errors = np.sqrt(np.diagonal(covariance))
        ways = np.zeros((len(which), len(self.point)))
        ways[:, which] = covariance / errors[:, np.newaxis]
        room = np.stack([self.problem.high[which] - self.point[which], self.point[which] - self.problem.low[which]])
        far = np.minimum(room / errors, TWO_ERRORS)
        starts = self.point + np.concatenate([far[0, :, np.newaxis] * ways, -far[1, :, np.newaxis] * ways])
        return far, np.sqrt(self.rise(starts, np.tile(which, 2))).reshape(2, -1)

    @property
    def nonlinearity(self) -> float:
        """Relative error of the half-width of the 95 percent intervals, by refitting with each unknown moved by two errors.

        Chi-squared then rises by 4 in a straight model; where a bound is nearer, by the square of the errors as far as that.
        NaN if the model refuses there.
        """
        far, risen = self.moves
        compared = np.fmax(far, risen) > _LEAST_MOVE
        if not np.any(compared):
            return 0.0
        with np.errstate(divide="ignore"):
            return float(np.max(abs(far / risen - 1.0)[compared | np.isnan(risen)]))

    def overstates_errors(self, times: float) -> bool:
        """Whether an unknown's error is at least ``times`` too large on both sides: its slope vanishes nearby."""
        far, risen = self.moves
        return bool(np.any(np.all((risen > TWO_ERRORS) & (risen > times * far), axis=0)))


def examined(inputs: FitInputs, problem: Problem, ends: Ends, k: int) -> Candidate:
    """The candidate where search k ended, refined with difference steps that suit it rather than the bounds or the start."""
    found = Candidate.of(inputs, problem, ends, k)
    most = np.where(found.only_a_start, np.inf, 10.0 * problem.scale)
    for _ in range(_STEP_ROUNDS):
        size = np.clip(abs(found.point), np.minimum(0.1 * problem.scale, _MOST_STEPS * found.errors), most)
        if np.all(abs(np.log2(size / found.problem.sizes(found.point))) < 1.0):
            break
        finer = problem._replace(size=size)
        ends = minimise(finer, found.point[np.newaxis])
        if ends.state[0] == REFUSED or ends.chi_squared[0] > found.chi_squared + SAME_CHI_SQUARED:
            break
        found = Candidate.of(inputs, finer, ends, 0)
    return found


def with_limits(found: Candidate, ends: Ends) -> Candidate:
    """The candidate with unknowns near a bound put on it if the model turns back there, and with their limits."""
    together = found.agreed(ends)
    for j in range(len(found.point)):
        bound, other = (float(side[j]) for side in (found.problem.low, found.problem.high))
        if abs(found.point[j] - bound) > abs(found.point[j] - other):
            bound, other = other, bound
        error, width = float(found.errors[j]), abs(other - bound)
        beside = min(_BESIDE_BOUND * error, 0.5 * width) if math.isfinite(error) else _AGREEMENT * width
        if not math.isfinite(bound - other) or abs(found.point[j] - bound) > beside:
            continue
        there = _moved_to_bound(found, j, bound)
        # Where the model refuses the bound there are no slopes to look at.
        if not there.chi_squared <= found.chi_squared + SAME_CHI_SQUARED:
            continue
        if math.isfinite(there.determination_of([j]).covariance[0, 0]):
            continue
        limit = _limit(there, j, bound, other, known=bool(together[j]))
        if limit:
            found = replace(there, limits=found.limits | {j: limit})
    return found


def _moved_to_bound(found: Candidate, j: int, bound: float) -> Candidate:
    """The candidate with one unknown put on its bound and the others fitted again."""
    unknowns = np.arange(len(found.point))
    start = np.where(unknowns == j, bound, found.point)
    movable = ~np.isin(unknowns, [j, *found.limits])
    ends = minimise(found.problem, start[np.newaxis], movable[np.newaxis])
    return replace(Candidate.of(found.inputs, found.problem, ends, 0), state=found.state, limits=found.limits)


def _limit(found: Candidate, j: int, bound: float, other: float, known: bool) -> OneSidedLimit | None:
    """The value at which chi-squared has risen by 4, or the other bound; None if it never rises or is flat here.

    If it never has, the furthest point. Unless the model is ``known`` to turn back, chi-squared must rise near the bound too.
    """

    def rise(shares: Any) -> Any:
        starts = np.tile(found.point, (len(shares), 1))
        starts[:, j] = bound + (other - bound) * shares
        return found.rise(starts, np.full(len(shares), j))

    shares = np.unique([0.0, *np.linspace(0.0, 1.0, _PARTS + 1)[1:], *2.0 ** -np.arange(1.0, _HALVINGS)])
    rises = rise(shares)
    if not np.nanmax(rises) > FLAT**2:
        return None
    last = int(np.max(np.flatnonzero(rises <= TWO_ERROR_RISE), initial=0))
    if last == len(shares) - 1:
        share, error = 1.0, abs(other - bound) / math.sqrt(min(max(rises[last], FLAT**2), TWO_ERROR_RISE))
    else:
        low, high = shares[last], shares[last + 1]
        for _ in range(_DIVISIONS):
            between = np.linspace(low, high, _PARTS // 2 + 1)
            inside = int(np.max(np.flatnonzero(rise(between) <= TWO_ERROR_RISE), initial=0))
            low, high = between[inside], between[min(inside + 1, len(between) - 1)]
        share, error = float(low), 0.5 * abs(other - bound) * float(low)
    if share == 0.0 or not (known or rise(np.array([0.1 * share]))[0] > _LEAST_RISE):
        return None
    return OneSidedLimit(bound + (other - bound) * share, error)
