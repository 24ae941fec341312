"""``Candidate``: a solution of a fit, where a search ended: its errors, and whether slopes describe the misfit around it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .fit_problem import FitInputs
from .least_squares import CONVERGED, REFUSED, Determination, Ends, Problem, determination, minimise

SAME_CHI_SQUARED = 1e-3  # misfits within this are the same

_TWO_ERRORS = 2.0
_AGREEMENT = 1e-2  # of the scale of an unknown: values within this agree
_NEAR = 1e-2  # standard errors: where the others end when one unknown is moved
_LEAST_MOVE = 0.1  # standard errors: smaller moves and smaller rises are not compared
_STEP_ROUNDS = 4
_MOST_STEPS = 100.0  # standard errors over which slopes may be taken at most


@dataclass(frozen=True, eq=False)
class Candidate:
    """The point where a search ended, with step sizes that suit it."""

    inputs: FitInputs
    problem: Problem
    point: Any
    outputs: Any
    slopes: Any
    chi_squared: float
    state: int

    @cached_property
    def determination(self) -> Determination:
        """The covariance of the unknowns by the slopes."""
        return self.determination_of(np.ones(len(self.point), dtype=bool))

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

    def turns_round(self, ends: Ends) -> bool:
        """Whether all searches agree in an unknown of which slopes tell nothing: its misfit turns there."""
        here = ends.points[ended_at(ends, self.chi_squared)]
        return len(here) > 1 and bool(np.any(np.isinf(self.errors) & (np.ptp(here, axis=0) < _AGREEMENT * self.problem.scale)))

    @cached_property
    def moves(self) -> tuple[Any, Any]:
        """Two errors of each unknown up and down (2, n), within the bounds, and how far the misfit rises there, in sigma."""
        covariance = self.determination_of(self.free).covariance
        known = np.isfinite(np.diagonal(covariance))
        which, covariance = np.flatnonzero(self.free)[known], covariance[np.ix_(known, known)]
        if not which.size:
            return np.zeros((2, 0)), np.zeros((2, 0))
        errors = np.sqrt(np.diagonal(covariance))
        ways = np.zeros((len(which), len(self.point)))
        # The others start from where they would be in a straight model, and are fitted again.
        ways[:, which] = covariance / errors[:, np.newaxis]
        room = np.stack([self.problem.high[which] - self.point[which], self.point[which] - self.problem.low[which]])
        far = np.minimum(room / errors, _TWO_ERRORS)
        starts = (self.point + (far * np.array([[1.0], [-1.0]]))[..., np.newaxis] * ways).reshape(-1, len(self.point))
        movable = np.tile(np.arange(len(self.point)) != which[:, np.newaxis], (2, 1))
        ends = minimise(self.problem, starts, movable, close=_NEAR)
        rise = np.where(ends.state == REFUSED, np.nan, np.maximum(ends.chi_squared - self.chi_squared, 0.0))
        return far, np.sqrt(rise).reshape(2, -1)

    @property
    def nonlinearity(self) -> float:
        """Relative error of the half-width of the 95 percent intervals; NaN if the model refuses within two errors.

        Of a straight model the misfit rises by as many sigma as an unknown is moved in standard errors.
        """
        far, risen = self.moves
        compared = np.fmax(far, risen) > _LEAST_MOVE
        if not np.any(compared):
            return 0.0
        with np.errstate(divide="ignore"):
            return float(np.max(abs(far / risen - 1.0)[compared | np.isnan(risen)]))

    def overstates_errors(self, times: float) -> bool:
        """Whether an unknown's error is at least ``times`` too large wherever it has room: its slope vanishes nearby."""
        far, risen = self.moves
        over = (risen > _TWO_ERRORS) & (risen > times * far)
        return bool(np.any(np.all(over | (far < _LEAST_MOVE), axis=0) & np.any(over, axis=0)))


def ended_at(ends: Ends, chi_squared: float) -> Any:
    """Which searches ended at a minimum of this misfit."""
    return (ends.state == CONVERGED) & (abs(ends.chi_squared - chi_squared) <= SAME_CHI_SQUARED)


def examined(inputs: FitInputs, problem: Problem, ends: Ends, k: int) -> Candidate:
    """The candidate where search k ended, refined with difference steps that suit it rather than the bounds or the start."""
    found = Candidate(inputs, problem, *(part[k] for part in ends))
    most = np.where(found.only_a_start, math.inf, 10.0 * problem.scale)
    for _ in range(_STEP_ROUNDS):
        size = np.clip(abs(found.point), np.minimum(0.1 * problem.scale, _MOST_STEPS * found.errors), most)
        if np.all(abs(np.log2(size / found.problem.sizes(found.point))) < 1.0):
            break
        finer = problem._replace(size=size)
        ends = minimise(finer, found.point[np.newaxis])
        if ends.state[0] == REFUSED or ends.chi_squared[0] > found.chi_squared + SAME_CHI_SQUARED:
            break
        found = Candidate(inputs, finer, *(part[0] for part in ends))
    return found
