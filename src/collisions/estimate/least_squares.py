"""Weighted least squares within bounds on plain arrays: the searches, the covariance, and the
probability of a misfit.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

_EPS = 2.0**-52
_ROUNDS = 200
# Convergence limit: the remaining step in standard errors, or relative to the misfit where that is
# larger.
_CLOSE = 1e-8
# The same with a finer model, each call of which is dear: chi-squared to 1e-8.
_CLOSE_OF_FINER = 1e-4
# The same where rounding of the model lets the search come no closer.
_CLOSE_ENOUGH = 1e-3
# Of chi-squared, or absolute: a search that falls by less over so many rounds gets no further.
_STALLED, _STALLED_ROUNDS = 1e-6, 10
_STALLED_OF_FINER, _ROUNDS_OF_FINER = 1e-4, 6
_FIRST_DAMPING = 1e-2
# of the largest slope: an unknown that changes less is damped like one that changes so much
_LEAST_WEIGHT = 1e-3
# of a slope; over so short a step a smooth model changes its own by less than a thousandth
_KINK = 0.05
# sigma, from one neighbour to the next: more is a jump
_JUMP = 1e-2
# sigma: evidence that changes less while an unknown moves by its whole scale does not identify it
FLAT = 1e-3
_NEGLIGIBLE_SHARE = (
    1e-4  # of its scale: an unknown that moves less along a direction is not part of it
)
# Multiples of the error of an unknown and the cube root of the noise: over that a noisy model
# is compared.
_NOISY_STEP, _MOST_NOISY_STEP = 2.0, 0.5
# of its scale, for the error of an unknown before that is known
_REACH = 0.1
# of a slope of a noisy model, whose longer steps change it by more than a smooth model's
_NOISY_KINK = 0.25
# Neighbours whose fourth differences are the noise, at so many steps of the slopes from each other;
# less noise than this share of the outputs, or of sigma, is none.
_NEIGHBOURS, _APART, _NO_NOISE = 9, (1.0, 10.0), 1e-9
_DIFFERENCE_ERROR = 10.0  # eps of the model's outputs, in a difference
_LARGEST = 1e100


class Borrowed(NamedTuple):
    """Slopes (m, n) of a problem at one point, and those of its scout there."""

    slopes: Any
    of_scout: Any


class Problem(NamedTuple):
    """A least-squares problem in units of standard deviations.

    ``evaluate`` takes points (k, n) and returns the outputs of the model there (k, m), NaN where it
    refuses; ``period`` is NaN for what does not go round a circle; ``scale`` is how far each
    unknown may be expected to move, ``span`` how far searches go, and ``size`` the length over
    which the model changes, which sets the steps of the slopes; without it, a guess from the scale.
    ``noise`` is how far outputs scatter from one neighbour to the next, as where a model integrates
    with steps of its own; slopes are then taken over a part of ``reach``, the errors of the
    unknowns. ``scout`` is the problem of a cheaper model; with ``borrowed`` slopes those
    elsewhere change as the scout's do.
    """

    evaluate: Callable[[Any], Any]
    target: Any
    period: Any
    low: Any
    high: Any
    scale: Any
    span: Any
    size: Any = None
    noise: float = 0.0
    reach: Any = None
    scout: Problem | None = None
    borrowed: Borrowed | None = None

    def borrowing(self, point: Any, slopes: Any) -> Problem:
        """The same with the slopes at one point (m, n) and their changes from the scout, if there
        is one: a model of n unknowns is then asked once for a point, not 1 + 2 n times.
        """
        if self.scout is None:
            return self
        of_scout = self.scout.with_slopes(point[np.newaxis])[1][0]
        return self._replace(borrowed=Borrowed(slopes, of_scout))

    def wrapped(self, difference: Any) -> Any:
        """Differences of angles by the short way round, within half a turn."""
        return difference - np.where(
            np.isnan(self.period), 0.0, self.period * np.ceil(difference / self.period - 0.5)
        )

    def misfit(self, outputs: Any) -> Any:
        """Computed minus observed values."""
        return self.wrapped(outputs - self.target)

    def sizes(self, points: Any) -> Any:
        """The length, by unknown, over which the model is assumed to vary."""
        return (
            np.clip(abs(points), 1e-3 * self.scale, 10.0 * self.scale)
            if self.size is None
            else self.size
        )

    def steps(self, points: Any) -> Any:
        """Finite-difference steps by unknown, small enough to stay within the bounds on
        one side.
        """
        size = self.sizes(points)
        step = np.maximum(_EPS ** (1 / 3) * size, np.sqrt(_EPS * abs(points) * size))
        if self.noise:
            part = min(_NOISY_STEP * self.noise ** (1 / 3), _MOST_NOISY_STEP)
            step = np.maximum(step, part * self.reaches)
        return np.minimum(step, 0.25 * (self.high - self.low))

    @property
    def reaches(self) -> Any:
        """How far, by unknown, a noisy model counts as nearly linear."""
        return _REACH * self.scale if self.reach is None else self.reach

    def noise_near(self, points: Any) -> float:
        """How far the outputs scatter between neighbours at most of these points (k, n); 0 where
        that is rounding.

        Fourth differences of white noise have 70 times its variance, and a smooth model has none
        over so short a way (Moré and Wild, SIAM J. Sci. Comput. 33 (2011) 1292).
        """
        steps = np.multiply.outer(_APART, self.steps(points))
        ways = np.arange(_NEIGHBOURS)[:, np.newaxis] - 0.5 * (_NEIGHBOURS - 1)
        most = ways[-1] * steps
        middle = np.clip(points, self.low + most, np.maximum(self.low + most, self.high - most))
        places = middle[..., np.newaxis, :] + ways * steps[..., np.newaxis, :]
        found = self.evaluate(places.reshape(-1, points.shape[1]))
        found = found.reshape(*places.shape[:-1], -1)
        rises = self.wrapped(found - found[..., :1, :])
        scatter = np.sqrt(np.mean(np.diff(rises, 4, axis=-2) ** 2, axis=-2) / 70.0)
        sizes = np.maximum(1.0, np.max(abs(found), axis=-2))
        scatter = np.where(scatter > _NO_NOISE * sizes, scatter, 0.0)
        each = np.max(scatter, axis=(0, 2))
        usable = each[np.isfinite(each)]
        return float(np.median(usable)) if usable.size else 0.0

    def with_slopes(self, points: Any, held: Any = None) -> tuple[Any, Any]:
        """Outputs (k, m) and their derivatives (k, m, n) by differences, NaN where the model
        refuses on both sides; 0 by what is ``held`` (k, n).
        """
        if self.scout is not None and self.borrowed is not None:
            change = self.scout.with_slopes(points, held)[1] - self.borrowed.of_scout
            slopes = self.borrowed.slopes + np.where(np.isfinite(change), change, 0.0)
            free = True if held is None else ~held[:, np.newaxis]
            return self.evaluate(points), np.where(free, slopes, 0.0)
        outputs, (above, below), (up, down) = self.neighbours(points, held)
        return outputs, np.swapaxes((above - below) / (up - down), 1, 2)

    def jumps(self, point: Any) -> bool:
        """Whether the outputs change between neighbours by more than slopes could: a jump."""
        _, changes, _ = self.neighbours(point[np.newaxis])
        return bool(np.max(abs(changes)) > _JUMP)

    def kinks(self, points: Any) -> Any:
        """At which points (k, n) the one-sided slopes differ by more than a smooth model's do: a
        kink or a jump in between.
        """
        if not len(points):
            return np.zeros(0, dtype=bool)
        _, changes, moves = self.neighbours(points)
        above, below = changes / moves
        sizes = [
            np.linalg.norm(part, axis=2) * self.scale for part in (above, below, above - below)
        ]
        largest = np.maximum(1.0, np.fmax(sizes[0], sizes[1]))
        if not self.noise:
            return np.any(sizes[2] > _KINK * largest, axis=1)
        scatter = 4.0 * self.noise * self.scale / self.steps(points)
        return np.any(sizes[2] > _NOISY_KINK * largest + scatter, axis=1)

    def has_kink(self, point: Any) -> bool:
        """Whether there is a kink or a jump at one point."""
        return bool(self.kinks(point[np.newaxis])[0])

    def neighbours(self, points: Any, held: Any = None) -> tuple[Any, Any, Any]:
        """Outputs, by how much they change towards a neighbour above and below (2, k, n, m), and
        the moves (2, k, n, 1).

        Where a bound or a refusal is in the way both are 0. Nothing is asked, and no change given,
        for what is ``held`` (k, n).
        """
        count, n = points.shape
        step = self.steps(points)
        moved = np.clip(np.stack([points + step, points - step]), self.low, self.high)
        places = np.where(np.eye(n, dtype=bool), moved[..., np.newaxis], points[:, np.newaxis])
        asked = np.ones((2, count, n), dtype=bool)
        if held is not None:
            asked &= ~held
        answers = self.evaluate(np.concatenate([points, places[asked]]))
        outputs = answers[:count]
        found = np.tile(outputs[:, np.newaxis], (2, 1, n, 1))
        found[asked] = answers[count:]
        changes = self.wrapped(found - outputs[:, np.newaxis])
        refused = np.any(np.isnan(changes), axis=3, keepdims=True)
        return (
            outputs,
            np.where(refused, 0.0, changes),
            np.where(refused, 0.0, (moved - points)[..., np.newaxis]),
        )


class Ends(NamedTuple):
    """The ends of the searches, one per row; chi-squared is infinite where the model refuses from
    the start.
    """

    points: Any
    outputs: Any
    slopes: Any
    chi_squared: Any
    converged: Any


def spread(count: int, low: Any, high: Any) -> Any:
    """Points evenly over a box, the middle first: the additive recurrence on powers of the
    generalised golden ratio.

    M. Roberts, "The unreasonable effectiveness of quasirandom sequences" (2018): the root of
    x^(n+1) = x + 1.
    """
    n = len(low)
    root = 2.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (n + 1))
    share = (0.5 + np.arange(count)[:, np.newaxis] * root ** -np.arange(1.0, n + 1.0)) % 1.0
    return low + (high - low) * share


def minimise(
    problem: Problem,
    starts: Any,
    *,
    held: Any = None,
    close: float = _CLOSE,
    rounds: int = _ROUNDS,
) -> Ends:
    """Levenberg-Marquardt from every start at once, projected on the bounds; a step into a refusal
    is never taken. What is ``held`` (as the starts) stays where it is.

    Damping after Nielsen (IMM-REP-1999-05). A search has converged when the undamped step that is
    left, in the metric of the standard errors, is rounding; one that no step down to the square of
    ``close`` takes lower, as at a jump or a refusal, has not. With a scout, its slopes lead most of
    the way.
    """
    points = np.clip(starts, problem.low, problem.high)
    if problem.scout is not None and problem.borrowed is None:
        quick = problem.borrowing(points[0], problem.with_slopes(points[:1])[1][0])
        points = minimise(quick, points, held=held, close=close, rounds=rounds).points
        close = max(close, _CLOSE_OF_FINER)
    fixed = np.zeros(points.shape, dtype=bool) if held is None else held
    outputs, slopes = problem.with_slopes(points, fixed)
    cost = _cost(problem, outputs, slopes)
    live, left = np.isfinite(cost), np.full(len(points), np.inf)
    damping, growth = np.full(len(points), _FIRST_DAMPING), np.full(len(points), 2.0)

    earlier = np.full(len(points), np.inf)
    stalled, often = (
        (_STALLED, _STALLED_ROUNDS)
        if problem.scout is None
        else (_STALLED_OF_FINER, _ROUNDS_OF_FINER)
    )

    for count in range(rounds):
        if count % often == 0:
            # Along a kink a search goes on by ever shorter steps; borrowed slopes go no further.
            slow = np.flatnonzero(live & (earlier - cost <= stalled * np.maximum(1.0, cost)))
            at_kink = True if problem.borrowed is not None else problem.kinks(points[slow])
            live[slow[at_kink]] = False
            earlier = cost.copy()
        rows = np.flatnonzero(live)
        trial, foreseen, left[rows] = _step(
            problem, points[rows], outputs[rows], slopes[rows], damping[rows], fixed[rows]
        )
        live = live & (left > close) & (damping <= close**-2)
        going = live[rows]
        rows, trial, foreseen = rows[going], trial[going], foreseen[going]
        if not rows.size:
            break
        found, steep = problem.with_slopes(trial, fixed[rows])
        new = _cost(problem, found, steep)
        better = (new < cost[rows]) & (foreseen > 0.0)
        taken, other = rows[better], rows[~better]
        gain = np.clip((cost[taken] - new[better]) / foreseen[better], 0.0, 1.0)
        points[taken], outputs[taken], slopes[taken], cost[taken] = (
            trial[better],
            found[better],
            steep[better],
            new[better],
        )
        damping[taken] *= np.maximum(1.0 / 3.0, 1.0 - (2.0 * gain - 1.0) ** 3)
        growth[taken] = 2.0
        damping[other] *= growth[other]
        growth[other] *= 2.0
    if held is not None and len(points):
        slopes = np.where(held[:, np.newaxis], problem.with_slopes(points, ~held)[1], slopes)
    enough = max(close, _CLOSE_ENOUGH, _NOISY_STEP * problem.noise ** (2 / 3))
    return Ends(points, outputs, slopes, cost, left <= enough)


def _cost(problem: Problem, outputs: Any, slopes: Any) -> Any:
    """Chi-squared, infinite where the model refuses or its numbers cannot be squared."""
    misfit = problem.misfit(outputs)
    usable = np.all(abs(misfit) < _LARGEST, axis=1) & np.all(
        abs(slopes * problem.scale) < _LARGEST, axis=(1, 2)
    )
    return np.where(
        usable, np.sum(np.where(usable[:, np.newaxis], misfit, 0.0) ** 2, axis=1), np.inf
    )


def _slope_error(outputs: Any, scale: Any, steps: Any, noise: float) -> Any:
    """Bound of the error by rounding, or noise, in finite-difference slopes, per scale of each
    unknown.
    """
    rounding = _DIFFERENCE_ERROR * _EPS * np.max(abs(outputs), axis=-1, initial=1.0)
    return np.maximum(rounding, noise)[..., np.newaxis] * scale / steps


def _step(
    problem: Problem, points: Any, outputs: Any, slopes: Any, damping: Any, fixed: Any
) -> tuple[Any, Any, Any]:
    """Where the damped step within the bounds leads, the predicted fall of chi-squared, and how
    much there is left to go.

    The last is the length of the undamped step in standard errors, over the misfit where that is
    above 1, along directions in which the slopes are more than rounding.
    """
    misfit, scaled = problem.misfit(outputs), slopes * problem.scale
    gradient = np.einsum("kmn,km->kn", scaled, misfit)
    held = (
        fixed
        | ((points <= problem.low) & (gradient > 0.0))
        | ((points >= problem.high) & (gradient < 0.0))
    )
    scaled = np.where(held[:, np.newaxis], 0.0, scaled)
    weight = np.linalg.norm(scaled, axis=1)
    weight = np.maximum(
        weight, _LEAST_WEIGHT * np.maximum(1.0, np.max(weight, axis=1, keepdims=True))
    )
    across, size, direction = np.linalg.svd(scaled / weight[:, np.newaxis], full_matrices=False)
    along = np.einsum("kmi,km->ki", across, misfit)
    error = _slope_error(outputs, problem.scale, problem.steps(points), problem.noise)
    # Within bounds a slope that identifies nothing counts no more: at a turning point it never is
    # down to its rounding.
    error = np.where(np.isinf(problem.high - problem.low), error, np.maximum(error, FLAT))
    error = np.einsum("kij,kj->ki", abs(direction), error / weight)
    left = np.linalg.norm(np.where(size > error, along, 0.0), axis=1) / np.maximum(
        1.0, np.linalg.norm(misfit, axis=1)
    )
    move = (
        -np.einsum("kij,ki->kj", direction, along * size / (size**2 + damping[:, np.newaxis]))
        / weight
    )
    trial = np.clip(points + move * problem.scale, problem.low, problem.high)
    trial = np.where(fixed, points, trial)
    change = np.einsum("kmn,kn->km", scaled, (trial - points) / problem.scale)
    return trial, -np.sum(change * (2.0 * misfit + change), axis=1), left


class Determination(NamedTuple):
    """The covariance from the evidence (inf and NaN where nothing determines it), and the
    contribution of each row.

    ``unidentified`` are directions that nothing determines, ``prior_only`` those that the priors
    determine and the evidence does not, each a row of changes in the units of the unknowns, the
    largest share of a scale being one whole scale. ``rank`` is how many directions are determined.
    """

    covariance: Any
    unidentified: Any
    prior_only: Any
    shares: Any
    rank: int


def determination(
    slopes: Any, is_prior: Any, scale: Any, outputs: Any, steps: Any, noise: float = 0.0
) -> Determination:
    """The determination from slopes (m, n) in standard deviations per unknown; some rows are
    priors.

    A direction is unidentified if moving along it by one scale changes everything by less than a
    thousandth of a standard deviation, or by less than the rounding of the differences that the
    slopes came from.
    """
    scaled = slopes * scale
    error = _slope_error(outputs, scale, steps, noise)
    size, direction = _directions(scaled)
    identified = size > np.maximum(FLAT, abs(direction) @ error)
    unidentified, axes = (
        direction[~identified],
        direction[identified] / size[identified, np.newaxis],
    )

    size, direction = _directions(scaled[~is_prior])
    without_priors = direction[size <= np.maximum(FLAT, abs(direction) @ error)]
    # Minus the directions that nothing determines at all.
    size, direction = _directions(without_priors - without_priors @ unidentified.T @ unidentified)
    prior_only = direction[size > 0.5]

    lost = np.linalg.norm(unidentified, axis=0) > _NEGLIGIBLE_SHARE
    gain = np.where(lost[:, np.newaxis], np.nan, axes.T @ (axes @ scaled.T))
    covariance = np.where(lost[:, np.newaxis] | lost, np.nan, axes.T @ axes) * np.outer(
        scale, scale
    )
    covariance[lost, lost] = np.inf
    shares = gain**2 / np.sum(gain**2, axis=1, keepdims=True)
    return Determination(
        covariance, _reduced(unidentified) * scale, _reduced(prior_only) * scale, shares, len(axes)
    )


def _directions(matrix: Any) -> tuple[Any, Any]:
    """All n singular values, padded with 0, and their directions as rows."""
    n = matrix.shape[1]
    _, size, direction = np.linalg.svd(matrix, full_matrices=True)
    return np.append(size, np.zeros(n - len(size))), direction


def _reduced(directions: Any) -> Any:
    """The same space by rows that each involve few unknowns: reduced row echelon form with small
    entries dropped.
    """
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

    The finite sums for whole degrees of freedom, whose terms all have one sign (Abramowitz and
    Stegun 26.4.4, 26.4.5).
    """
    if degrees_of_freedom < 1 or math.isnan(chi_squared):
        return math.nan
    half, odd = 0.5 * max(chi_squared, 0.0), degrees_of_freedom % 2
    if half == 0.0 or math.isinf(half):
        return float(half == 0.0)
    powers = (j + 0.5 * odd for j in range(degrees_of_freedom // 2))
    return math.erfc(math.sqrt(half)) * odd + sum(
        math.exp(j * math.log(half) - half - math.lgamma(j + 1.0)) for j in powers
    )
