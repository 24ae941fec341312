"""Weighted least squares within bounds on plain arrays: the searches, the covariance, and the probability of a misfit."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

_EPS = 2.0**-52
_ROUNDS = 200
# Convergence limit: the remaining step in standard errors, or relative to the misfit where that is larger.
_CLOSE = 1e-8
# The same where rounding of the model lets the search come no closer.
_CLOSE_ENOUGH = 1e-3
_FIRST_DAMPING, _MOST_DAMPING = 1e-2, 1e16
_LEAST_DAMPING = 1e-12  # the least that rounding does not absorb, for singular equations
_LEAST_WEIGHT = 1e-6  # of the damping: an unknown that changes nothing is damped all the same
_KINK = 0.05  # of a slope; over so short a step a smooth model changes its own by less than a thousandth
FLAT = 1e-3  # sigma: evidence that changes less while an unknown moves by its whole scale does not identify it
_UNBOUNDED_SHARE = 0.1  # of a direction, in unknowns without bounds: along it a small slope may identify all the same
_NEGLIGIBLE_SHARE = 1e-4  # of its scale: an unknown that moves less along a direction is not part of it
_DIFFERENCE_ERROR = 10.0  # eps of the model's outputs, in a difference
_LARGEST = 1e100

SEARCHING, CONVERGED, STALLED, AT_REFUSAL, REFUSED = range(5)


class Problem(NamedTuple):
    """A least-squares problem in units of standard deviations.

    ``evaluate`` takes points (k, n) and gives what the model makes of them (k, m), NaN where it refuses; ``period`` is NaN for
    what does not go round a circle; ``scale`` is how far each unknown may be thought to move, and ``size`` the length over
    which the model changes, for the steps of the slopes; without it a guess from the scale.
    """

    evaluate: Callable[[Any], Any]
    target: Any
    period: Any
    low: Any
    high: Any
    scale: Any
    size: Any = None

    @property
    def unbounded(self) -> Any:
        """For each unknown, whether it has no bound on either side."""
        return np.isinf(self.low) & np.isinf(self.high)

    def wrapped(self, difference: Any) -> Any:
        """Differences of angles by the short way round, within half a turn."""
        with np.errstate(invalid="ignore"):
            turns = np.ceil(difference / self.period - 0.5)
        return difference - np.where(np.isnan(self.period), 0.0, self.period * np.where(np.isnan(turns), 0.0, turns))

    def misfit(self, outputs: Any) -> Any:
        """Computed minus observed values."""
        return self.wrapped(outputs - self.target)

    def sizes(self, points: Any) -> Any:
        """The length, by unknown, over which the model is assumed to vary."""
        return np.clip(abs(points), 0.1 * self.scale, 10.0 * self.scale) if self.size is None else self.size

    def steps(self, points: Any) -> Any:
        """Finite-difference steps by unknown, small enough to stay within the bounds on one side."""
        size = self.sizes(points)
        step = np.maximum(_EPS ** (1 / 3) * size, np.sqrt(_EPS * abs(points) * size))
        return np.minimum(step, 0.25 * (self.high - self.low))

    def with_slopes(self, points: Any) -> tuple[Any, Any]:
        """Outputs (k, m) and their derivatives (k, m, n) by second-order differences, in one call of the model.

        Both neighbours lie on one side where a bound is on the other. Where the model refuses one of them, the other is used;
        the derivative is NaN where it refuses both.
        """
        outputs, one, other, to_one, to_other = self._differences(points)
        with np.errstate(invalid="ignore", divide="ignore"):
            slopes = (one * to_other - other * to_one) / (to_other - to_one)
        slopes = np.where(np.isnan(one), other, np.where(np.isnan(other), one, slopes))
        return outputs, np.swapaxes(slopes, 1, 2)

    def has_kink(self, point: Any) -> bool:
        """Whether the one-sided slopes differ by more than a smooth model's do: a kink or a jump in between."""
        _, one, other, _, _ = self._differences(point[np.newaxis])
        sizes = [np.linalg.norm(part[0], axis=1) * self.scale for part in (one, other, one - other)]
        return bool(np.any(sizes[2] > _KINK * np.maximum(1.0, np.fmax(sizes[0], sizes[1]))))

    def _differences(self, points: Any) -> tuple[Any, Any, Any, Any, Any]:
        """Outputs, slopes towards two neighbours along each unknown (k, n, m), and the distances to these (k, n, 1)."""
        count, n = points.shape
        step = self.steps(points)
        first = np.where(points + step <= self.high, step, -step)
        second = np.where((first > 0.0) & (points - step >= self.low), -step, 2.0 * first)
        moves = np.stack([first, second], axis=1)
        places = points[:, np.newaxis, np.newaxis] + moves[..., np.newaxis] * np.eye(n)
        moves = np.einsum("kjii->kji", places) - points[:, np.newaxis]
        every = np.concatenate([points[:, np.newaxis], places.reshape(count, 2 * n, n)], axis=1)
        found = self.evaluate(every.reshape(-1, n)).reshape(count, 2 * n + 1, -1)
        changes = self.wrapped(found[:, 1:] - found[:, :1]).reshape(count, 2, n, -1)
        with np.errstate(invalid="ignore", divide="ignore"):
            one, other = np.moveaxis(changes / moves[..., np.newaxis], 1, 0)
        return found[:, 0], one, other, moves[:, 0, :, np.newaxis], moves[:, 1, :, np.newaxis]


class Ends(NamedTuple):
    """The ends of the searches, one per row."""

    points: Any
    outputs: Any
    slopes: Any
    chi_squared: Any
    state: Any


def spread(count: int, low: Any, high: Any) -> Any:
    """Points evenly over a box, the middle first: the additive recurrence on powers of the generalised golden ratio.

    M. Roberts, "The unreasonable effectiveness of quasirandom sequences" (2018): the root of x^(n+1) = x + 1.
    """
    n = len(low)
    root = 2.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (n + 1))
    share = (0.5 + np.arange(count)[:, np.newaxis] * root ** -np.arange(1.0, n + 1.0)) % 1.0
    return low + (high - low) * share


def minimise(problem: Problem, starts: Any, movable: Any = None, close: float = _CLOSE) -> Ends:
    """Levenberg-Marquardt from every start at once, projected on the bounds; a step into a refusal is never taken.

    Damping after Nielsen (IMM-REP-1999-05). A search has converged when the undamped step that is left, seen in the metric of
    the standard errors, is rounding; it stalls where no step however short lowers the misfit, which a smooth model does only
    there. Where ``movable`` (k, n) is given, each search leaves the other unknowns as they start.
    """
    movable = np.ones(starts.shape, dtype=bool) if movable is None else movable
    points = np.clip(starts, problem.low, problem.high)
    outputs, slopes = problem.with_slopes(points)
    misfit = problem.misfit(outputs)
    cost = _cost(problem, misfit, slopes)
    state = np.where(np.isfinite(cost), SEARCHING, REFUSED)
    damping, growth = np.full(len(points), _FIRST_DAMPING), np.full(len(points), 2.0)

    for _ in range(_ROUNDS):
        arrived = _left_to_go(problem, points, misfit, slopes, movable, state == SEARCHING) <= close
        state = np.where(arrived, CONVERGED, state)
        live = np.flatnonzero(state == SEARCHING)
        if not live.size:
            break
        trial, foreseen = _step(problem, points[live], misfit[live], slopes[live], movable[live], damping[live])
        found, steep = problem.with_slopes(trial)
        rest = problem.misfit(found)
        new = _cost(problem, rest, steep)
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            gain = (cost[live] - new) / foreseen
        better = (new < cost[live]) & (foreseen > 0.0)
        taken = live[better]
        points[taken], outputs[taken], misfit[taken] = trial[better], found[better], rest[better]
        slopes[taken], cost[taken] = steep[better], new[better]
        damping[taken] *= np.maximum(1.0 / 3.0, 1.0 - (2.0 * np.clip(gain[better], 0.0, 1.0) - 1.0) ** 3)
        growth[taken] = 2.0
        left = live[~better]
        damping[left] *= growth[left]
        growth[left] *= 2.0
        stuck = damping[live] > _MOST_DAMPING
        state[live[stuck]] = np.where(np.isfinite(new[stuck]), STALLED, AT_REFUSAL)

    short_of_it = (state == STALLED) | (state == AT_REFUSAL) | (state == SEARCHING)
    near = _left_to_go(problem, points, misfit, slopes, movable, short_of_it) <= _CLOSE_ENOUGH
    return Ends(points, outputs, slopes, cost, np.where(near, CONVERGED, state))


def _cost(problem: Problem, misfit: Any, slopes: Any) -> Any:
    """Chi-squared, infinite where the model refuses or its numbers cannot be squared."""
    with np.errstate(invalid="ignore", over="ignore"):
        usable = np.all(abs(misfit) < _LARGEST, axis=1) & np.all(abs(slopes * problem.scale) < _LARGEST, axis=(1, 2))
    return np.where(usable, np.sum(np.where(usable[:, np.newaxis], misfit, 0.0) ** 2, axis=1), np.inf)


def _slope_error(outputs: Any, scale: Any, steps: Any) -> Any:
    """Bound of the rounding error in finite-difference slopes, per scale of each unknown."""
    return _DIFFERENCE_ERROR * _EPS * np.max(abs(outputs), axis=-1, initial=1.0)[..., np.newaxis] * scale / steps


def _normal_equations(problem: Problem, points: Any, misfit: Any, slopes: Any, movable: Any) -> tuple[Any, Any]:
    """Gradient and curvature in scaled unknowns, with those held by a bound or not movable left out."""
    scaled = slopes * problem.scale
    gradient = np.einsum("kmn,km->kn", scaled, misfit)
    held = ((points <= problem.low) & (gradient > 0.0)) | ((points >= problem.high) & (gradient < 0.0))
    free = movable & ~held
    curvature = np.einsum("kmi,kmj->kij", scaled, scaled) * (free[:, :, np.newaxis] & free[:, np.newaxis, :])
    return np.where(free, gradient, 0.0), curvature


def _step(problem: Problem, points: Any, misfit: Any, slopes: Any, movable: Any, damping: Any) -> tuple[Any, Any]:
    """The damped step within the bounds, and the predicted fall of chi-squared."""
    gradient, curvature = _normal_equations(problem, points, misfit, slopes, movable)
    weight = np.einsum("kii->ki", curvature)
    weight = np.maximum(weight, _LEAST_WEIGHT * np.maximum(1.0, np.max(weight, axis=1, keepdims=True)))

    def move_by(damping: Any) -> Any:
        damped = curvature + (damping[:, np.newaxis] * weight)[..., np.newaxis] * np.eye(len(problem.scale))
        return np.linalg.solve(damped, -gradient[..., np.newaxis])[..., 0]

    try:
        move = move_by(damping)
    except np.linalg.LinAlgError:
        move = move_by(np.maximum(damping, _LEAST_DAMPING))
    trial = np.clip(points + move * problem.scale, problem.low, problem.high)
    real = (trial - points) / problem.scale
    return trial, -2.0 * np.einsum("kn,kn->k", gradient, real) - np.einsum("ki,kij,kj->k", real, curvature, real)


def _left_to_go(problem: Problem, points: Any, misfit: Any, slopes: Any, movable: Any, wanted: Any) -> Any:
    """Length of the undamped step in standard errors, over the misfit where that is above 1; infinite where not wanted."""
    left = np.full(len(points), np.inf)
    rows = np.flatnonzero(wanted)
    if rows.size:
        points, misfit = points[rows], misfit[rows]
        gradient, curvature = _normal_equations(problem, points, misfit, slopes[rows], movable[rows])
        size, direction = np.linalg.eigh(curvature)
        along = np.einsum("kij,ki->kj", direction, gradient)
        # With bounds, directions that are too flat do not count either.
        error = np.einsum(
            "kij,ki->kj", abs(direction), _slope_error(misfit + problem.target, problem.scale, problem.steps(points))
        )
        unbounded = np.linalg.norm(direction * problem.unbounded[:, np.newaxis], axis=1) > _UNBOUNDED_SHARE
        identified = size > np.where(unbounded, error, np.maximum(FLAT, error)) ** 2
        step = np.sqrt(np.sum(np.where(identified, along**2 / np.where(identified, size, 1.0), 0.0), axis=1))
        left[rows] = step / np.maximum(1.0, np.sqrt(np.einsum("km,km->k", misfit, misfit)))
    return left


class Determination(NamedTuple):
    """The covariance from the evidence (inf and NaN where nothing determines it), and the contribution of each row.

    ``unidentified`` are directions that nothing determines, ``prior_only`` those that the priors determine and the evidence
    does not, each a row of changes in the units of the unknowns, the largest share of a scale being one whole scale. ``rank``
    is how many directions are determined.
    """

    covariance: Any
    unidentified: Any
    prior_only: Any
    shares: Any
    rank: int


def determination(slopes: Any, is_prior: Any, scale: Any, outputs: Any, steps: Any) -> Determination:
    """The determination from slopes (m, n) in standard deviations per unknown; some rows are priors.

    A direction is unidentified if moving along it by one scale changes everything by less than a thousandth of a standard
    deviation, or by less than the rounding of the differences that the slopes came from.
    """
    scaled = slopes * scale
    error = _slope_error(outputs, scale, steps)
    size, direction = _directions(scaled)
    identified = size > np.maximum(FLAT, abs(direction) @ error)
    unidentified, axes = direction[~identified], direction[identified] / size[identified, np.newaxis]

    size, direction = _directions(scaled[~is_prior])
    without_priors = direction[size <= np.maximum(FLAT, abs(direction) @ error)]
    # Minus the directions that nothing determines at all.
    size, direction = _directions(without_priors - without_priors @ unidentified.T @ unidentified)
    prior_only = direction[size > 0.5]

    lost = np.linalg.norm(unidentified, axis=0) > _NEGLIGIBLE_SHARE
    gain = np.where(lost[:, np.newaxis], np.nan, axes.T @ (axes @ scaled.T))
    covariance = np.where(lost[:, np.newaxis] | lost, np.nan, axes.T @ axes) * np.outer(scale, scale)
    covariance[lost, lost] = np.inf
    with np.errstate(invalid="ignore", divide="ignore"):
        shares = gain**2 / np.sum(gain**2, axis=1, keepdims=True)
    return Determination(covariance, _reduced(unidentified) * scale, _reduced(prior_only) * scale, shares, len(axes))


def _directions(matrix: Any) -> tuple[Any, Any]:
    """All n singular values, padded with 0, and their directions as rows."""
    n = matrix.shape[1]
    _, size, direction = np.linalg.svd(matrix, full_matrices=True)
    return np.append(size, np.zeros(n - len(size))), direction


def _reduced(directions: Any) -> Any:
    """The same space by rows that each involve few unknowns: reduced row echelon form with small entries dropped."""
    rows = np.array(directions)
    for i in range(len(rows)):
        rest = abs(rows[i:])
        k, column = np.unravel_index(np.argmax(rest), rest.shape)
        rows[[i, i + int(k)]] = rows[[i + int(k), i]]
        rows[i] /= rows[i, column]
        others = np.arange(len(rows)) != i
        rows[others] -= np.outer(rows[others, column], rows[i])
    rows = np.where(abs(rows) > _NEGLIGIBLE_SHARE, rows, 0.0)
    return rows / np.max(abs(rows), axis=1, keepdims=True, initial=_NEGLIGIBLE_SHARE)


def chi_squared_tail(chi_squared: float, degrees_of_freedom: int) -> float:
    """Probability that a chi-squared variable exceeds the value; NaN without degrees of freedom.

    The finite sums for whole degrees of freedom, whose terms all have one sign (Abramowitz and Stegun 26.4.4, 26.4.5).
    """
    if degrees_of_freedom < 1 or math.isnan(chi_squared):
        return math.nan
    half, odd = 0.5 * max(chi_squared, 0.0), degrees_of_freedom % 2
    if half == 0.0 or math.isinf(half):
        return float(half == 0.0)
    powers = (j + 0.5 * odd for j in range(degrees_of_freedom // 2))
    return math.erfc(math.sqrt(half)) * odd + sum(math.exp(j * math.log(half) - half - math.lgamma(j + 1.0)) for j in powers)
