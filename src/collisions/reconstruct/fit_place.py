"""A place where a search ended, seen closely: slopes by steps that fit it, and how far what turns on a bound reaches."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from .determination import Determination, determination
from .fit_problem import Question
from .least_squares import CONVERGED, FLAT, REFUSED, Ends, minimise

SAME = 1e-3  # of chi-squared: searches that ended within this met the same misfit
OPEN = 1e-2  # of the scale of an unknown: searches that ended within this agree in it
NEAR = 1e-2  # standard errors: where the others end when one unknown is moved
TWICE = 4.0  # of chi-squared: two standard errors

_LOOKS = 4
_WITHIN = 100.0  # standard errors over which slopes may be told at most
_BESIDE = 0.1  # standard errors: an unknown that is as near to a bound may belong on it
_CURVED = 1e-5  # of chi-squared, at a tenth of the way to its rise by 4
_PARTS, _HALVINGS, _ROUNDS = 32, 40, 4


class Reach(NamedTuple):
    """Of an unknown that turns on its bound: the end of its range of two standard errors, and the standard error."""

    value: float
    error: float


class Place(NamedTuple):
    """Where a search ended; ``question`` has the steps that fit it."""

    question: Question
    point: Any
    outputs: Any
    slopes: Any
    chi_squared: float
    state: int
    reaches: dict[int, Reach]


def seen_closely(question: Question, ends: Ends, k: int) -> Place:
    """The place where search k ended, by slopes over steps that fit it."""
    return _fitting_steps(_at(question, ends, k))


def agreed(place: Place, ends: Ends) -> Any:
    """By unknown, whether all searches that met this misfit ended together: what is open stays wherever a search began."""
    here = (ends.state == CONVERGED) & (ends.chi_squared <= place.chi_squared + SAME)
    if np.count_nonzero(here) < 2:
        return np.zeros(len(place.point), dtype=bool)
    return np.ptp(ends.points[here], axis=0) < OPEN * place.question.problem.scale


def on_bounds(place: Place, ends: Ends) -> Place:
    """The same place, with the unknowns that turn on a bound put there, and how far they reach."""
    problem = place.question.problem
    together = agreed(place, ends)
    for j in range(len(place.point)):
        sides = (float(problem.low[j]), float(problem.high[j]))
        bound, other = sides if abs(place.point[j] - sides[0]) <= abs(place.point[j] - sides[1]) else sides[::-1]
        error, width = math.sqrt(told_at(place).covariance[j, j]), abs(other - bound)
        beside = min(_BESIDE * error, 0.5 * width) if math.isfinite(error) else OPEN * width
        if not math.isfinite(bound - other) or abs(place.point[j] - bound) > beside:
            continue
        there = _held_at(place, j, bound)
        alone = np.arange(len(place.point)) == j
        if not there.chi_squared <= place.chi_squared + SAME or math.isfinite(_told_by_slopes(there, alone).covariance[0, 0]):
            continue
        reach = _reach(there, j, bound, other, known=bool(together[j]))
        if reach:
            place = there._replace(reaches=place.reaches | {j: reach})
    return place


def _held_at(place: Place, j: int, bound: float) -> Place:
    """The place with one unknown put on its bound and the others fitted again."""
    start = np.where(np.arange(len(place.point)) == j, bound, place.point)
    movable = ~np.isin(np.arange(len(place.point)), [j, *place.reaches])
    ends = minimise(place.question.problem, start[np.newaxis], movable[np.newaxis])
    return _at(place.question, ends, 0)._replace(state=place.state, reaches=place.reaches)


def told_at(place: Place, chosen: Any = None) -> Determination:
    """What is told of the unknowns at the place; of the chosen ones if the others stay as they are.

    An unknown that turns on its bound has the error of its reach, and the others are told as if it stayed there.
    """
    n = len(place.point)
    chosen = np.ones(n, dtype=bool) if chosen is None else chosen
    sloping = chosen & ~np.isin(np.arange(n), list(place.reaches))
    told = _told_by_slopes(place, sloping)
    if np.array_equal(sloping, chosen):
        return told
    lost = np.isinf(np.diagonal(told.covariance))
    covariance = np.zeros((n, n))
    covariance[np.ix_(sloping, sloping)] = told.covariance
    for j, reach in place.reaches.items():
        covariance[np.flatnonzero(sloping)[lost], j] = covariance[j, np.flatnonzero(sloping)[lost]] = math.nan
        covariance[j, j] = reach.error**2
    shares = np.full((n, told.shares.shape[1]), math.nan)
    shares[sloping] = told.shares
    directions = []
    for rows in (told.open, told.held, told.axes):
        wide = np.zeros((len(rows), n))
        wide[:, sloping] = rows
        directions.append(wide[:, chosen])
    return Determination(covariance[np.ix_(chosen, chosen)], directions[0], directions[1], shares[chosen], directions[2])


def rise_when_moved(place: Place, starts: Any, moved: Any) -> Any:
    """By how much chi-squared rises at these points, one unknown held and the others fitted again; NaN where refused."""
    movable = np.ones(starts.shape, dtype=bool)
    movable[np.arange(len(starts)), moved] = False
    ends = minimise(place.question.problem, starts, movable, close=NEAR)
    return np.where(ends.state == REFUSED, np.nan, np.maximum(ends.chi_squared - place.chi_squared, 0.0))


def _at(question: Question, ends: Ends, k: int) -> Place:
    return Place(question, ends.points[k], ends.outputs[k], ends.slopes[k], float(ends.chi_squared[k]), int(ends.state[k]), {})


def _told_by_slopes(place: Place, chosen: Any) -> Determination:
    question, problem = place.question, place.question.problem
    is_prior = np.arange(len(problem.target)) >= len(question.observed)
    steps = problem.steps(place.point)
    scale = np.where(_nothing_known(question), np.maximum(problem.scale, abs(place.point)), problem.scale)
    return determination(place.slopes[:, chosen], is_prior, scale[chosen], place.outputs, steps[chosen])


def _nothing_known(question: Question) -> Any:
    """Of each unknown, whether its scale says no more than where to start."""
    problem = question.problem
    with_prior = np.isin(np.arange(len(problem.scale)), question.with_prior)
    return np.isinf(problem.low) & np.isinf(problem.high) & ~with_prior


def _fitting_steps(place: Place) -> Place:
    """The search ended anew with slopes over steps that fit the answer and its error rather than the bounds or the start."""
    most = np.where(_nothing_known(place.question), np.inf, 10.0 * place.question.problem.scale)
    for _ in range(_LOOKS):
        problem = place.question.problem
        errors = np.sqrt(np.diagonal(told_at(place).covariance))
        size = np.clip(abs(place.point), np.minimum(0.1 * problem.scale, _WITHIN * errors), most)
        if np.all(abs(np.log2(size / problem.sizes(place.point))) < 1.0):
            break
        finer = place.question._replace(problem=problem._replace(size=size))
        ends = minimise(finer.problem, place.point[np.newaxis])
        if ends.state[0] == REFUSED or ends.chi_squared[0] > place.chi_squared + SAME:
            break
        place = _at(finer, ends, 0)
    return place


def _reach(place: Place, j: int, bound: float, other: float, known: bool) -> Reach | None:
    """How far the unknown goes until chi-squared has risen by 4, or to its other bound; None if it never rises or is flat here.

    The furthest place of all where it has not. Unless it is ``known`` that the model turns, it must rise near the bound too.
    """

    def rise(shares: Any) -> Any:
        starts = np.tile(place.point, (len(shares), 1))
        starts[:, j] = bound + (other - bound) * shares
        return rise_when_moved(place, starts, np.full(len(shares), j))

    shares = np.unique([0.0, *np.linspace(0.0, 1.0, _PARTS + 1)[1:], *2.0 ** -np.arange(1.0, _HALVINGS)])
    rises = rise(shares)
    if not np.nanmax(rises) > FLAT**2:
        return None
    last = int(np.max(np.flatnonzero(rises <= TWICE), initial=0))
    if last == len(shares) - 1:
        share, error = 1.0, abs(other - bound) / math.sqrt(min(max(rises[last], FLAT**2), TWICE))
    else:
        low, high = shares[last], shares[last + 1]
        for _ in range(_ROUNDS):
            between = np.linspace(low, high, _PARTS // 2 + 1)
            inside = int(np.max(np.flatnonzero(rise(between) <= TWICE), initial=0))
            low, high = between[inside], between[min(inside + 1, len(between) - 1)]
        share, error = float(low), 0.5 * abs(other - bound) * float(low)
    if share == 0.0 or not (known or rise(np.array([0.1 * share]))[0] > _CURVED):
        return None
    return Reach(bound + (other - bound) * share, error)
