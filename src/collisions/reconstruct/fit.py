"""fit: unknowns of a scene from whatever was measured of it, each with its error."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..errors import (
    AmbiguousSolutionError,
    CollisionsWarning,
    IllConditionedWarning,
    NoSolutionError,
    SuspectUnitsWarning,
)
from ..warning import warn
from .fit_answer import answer_at, turns
from .fit_place import SAME, TWICE, Place, agreed, on_bounds, seen_closely, told_at
from .fit_problem import Question, read_question, refused_everywhere
from .fit_result import BENT, CONTRADICTION, Fit
from .least_squares import AT_REFUSAL, CONVERGED, REFUSED, SEARCHING, STALLED, Ends, minimise, spread

_STARTS = 64
_MORE_STARTS = 4096  # looked at where the model refuses all of the first
_FEW = 2  # searches that ended at the best: more are begun around it
_CLOSER, _CLOSEST = 4.0, 6  # how many times closer each time, and how often
_NARROWER = 10.0  # times
_BENT = (
    "there the model has a jump or a bend (a contact that begins to stick, an angle without unit that goes round), so that no "
    "error can be given"
)
_APART = 1.0  # standard errors
_AROUND, _NUDGE = 8, 1e-2  # searches, and part of the scale of each unknown by which they start off at most


def fit(model: Callable[..., Mapping[str, Any]], unknowns: Mapping[str, Any], observed: Mapping[str, Any]) -> Fit:
    """Find the unknowns of a scene that fit what was measured of it, each measurement with its error.

    Weighted least squares: the sum of the squares of (observed - computed)/sigma, over the observations and over what was known
    before, is made least within the bounds (Levenberg-Marquardt from 64 starts spread over what was known). The covariance is
    that of the slopes of the model at the answer and of the errors as stated; it is not scaled by the misfit. It holds where
    the errors of the observations are normal and independent and the model bends little within two standard errors, which
    is tried and warned of. Rivals are looked for between the starts, and closer by where few found the best; they are not
    proved absent.

    Parameters
    ----------
    model : function
        ``model(**unknowns)`` returns a dict of named outputs. It is called with an array of cases for every unknown [SI] and
        answers each with an array as long, NaN where it refuses (``on_failure="nan"``), as for ``uncertainty.propagate``: every
        case by itself, of which a few are asked again alone. What is known exactly is written in the model.
    unknowns : dict
        By name what is known before: a ``Normal`` (a prior that weighs in; ``truncate=`` are bounds), a ``Uniform`` or an
        ``Interval`` (bounds that weigh nothing), or a number, text or Quantity to start from (nothing known; searches start
        between 0 and twice of it, between -1 and 1 in SI if it is 0).
    observed : dict
        By output of the model, ``Normal(value, error)`` or the pair (value, error), both in SI or both with a unit; the error
        is a standard deviation. What is observed, or returned by the model, with a unit of angle goes round the circle: its
        residual is within half a turn. A bare number in radians cannot be told from another and does not.

    Returns
    -------
    Fit
        ``fit["speed_a"]`` has value, standard error and interval; see its attributes for residuals, chi-squared, what the
        evidence does not determine, and what ended on a bound.

    Raises
    ------
    InputError
        An argument that cannot be used, or a model (code "bad_model") that returns something else than named arrays, mixes the
        cases it is called with, or answers the same case differently.
    AmbiguousSolutionError
        Another answer, more than a standard error away, has a chi-squared less than 4 above the best: all are in ``solutions``.
        So it is with a friction that slides, or sticks whatever its value.
    NoSolutionError
        The model refuses everywhere (code "refused"); or the misfit is least at a jump, a bend, an edge or, off the bounds, a
        turning point of the model, where no error can be given (code "no_convergence"). A turning point on a bound, such as
        no restitution where only its square matters, has a range to one side, see ``Fit.reaches``.

    Warns
    -----
    IllConditionedWarning
        Nothing determines an unknown, or less than its bounds do; or the model bends, or refuses, within two standard errors of
        the answer.
    SuspectUnitsWarning
        A bare observation that differs by more than half a turn from what is computed, both within it: perhaps an angle.
    CollisionsWarning
        The evidence contradicts itself: a misfit this large has a chance below 0.01.

    Examples
    --------
    A Golf (1200 kg) going south and a Pinto (1800 kg) going east, with the momenta after the impact (published answers 63.2
    and 55.6 km/h), here each with an error of 1300 N s.

    >>> import numpy as np
    >>> import collisions as col
    >>> from collisions.uncertainty.distributions import Interval, Normal
    >>> def momentum(speed_golf, speed_pinto):
    ...     east, south = 1800 * speed_pinto, 1200 * speed_golf
    ...     return {"east": east, "south": south}
    >>> east = 1200 * 30 / 3.6 * np.cos(np.pi / 6) + 1800 * 50 / 3.6 * np.cos(np.pi / 4.5)
    >>> south = 1200 * 30 / 3.6 * np.sin(np.pi / 6) + 1800 * 50 / 3.6 * np.sin(np.pi / 4.5)
    >>> speeds = {"speed_golf": Interval("0 km/h", "150 km/h"), "speed_pinto": Interval("0 km/h", "150 km/h")}
    >>> found = col.reconstruct.fit(momentum, speeds, {"east": (east, 1300.0), "south": (south, 1300.0)})
    >>> round(3.6 * found["speed_golf"].value, 1), round(3.6 * found["speed_pinto"].value, 1)
    (63.2, 55.6)
    """
    # What leaves the range of floats is a point that is refused.
    with np.errstate(all="ignore"):
        question = read_question(model, unknowns, observed)
        first = _searched(question)
        ends = _searched_around(question, first)
        best = seen_closely(question, ends, _lowest(ends))
        if best.state == CONVERGED:
            best = on_bounds(best, ends)
        _check_ended(best, ends)
        fits = [answer_at(place, ends, len(ends.state) - len(first.state)) for place in _rivals(question, ends, best)]
    if len(fits) > 1:
        raise _ambiguous(fits)
    _say(question, fits[0])
    return fits[0]


def _searched(question: Question) -> Ends:
    """Where the searches from all starts ended; refuses a model that answers at none."""
    low, high = (np.array(ends) for ends in zip(*(unknown.box for unknown in question.unknowns), strict=True))
    starts = spread(_STARTS, low, high)
    starts[0] = [unknown.start for unknown in question.unknowns]
    ends = minimise(question.problem, starts)
    if np.all(ends.state == REFUSED):
        starts = spread(_MORE_STARTS, low, high)
        known = np.all(np.isfinite(question.problem.evaluate(starts)), axis=1)
        if np.any(known):
            ends = minimise(question.problem, starts[known][:_STARTS])
    if np.all(ends.state == REFUSED):
        raise refused_everywhere(question, _STARTS + _MORE_STARTS)
    return ends


def _searched_around(question: Question, ends: Ends) -> Ends:
    """The same searches, and where few ended at the best, as among many hollows, more around it, closer and closer."""
    low, high = (np.array(ends) for ends in zip(*(unknown.box for unknown in question.unknowns), strict=True))
    best = _lowest(ends)
    here = (ends.state == CONVERGED) & (ends.chi_squared <= ends.chi_squared[best] + SAME)
    if ends.state[best] != CONVERGED or np.count_nonzero(here) > _FEW or len(here) <= _FEW:
        return ends
    for closer in range(1, _CLOSEST + 1):
        middle, half = ends.points[_lowest(ends)], 0.5 * (high - low) / _CLOSER**closer
        more = minimise(question.problem, spread(_STARTS, middle - half, middle + half))
        ends = Ends(*(np.concatenate(both) for both in zip(ends, more, strict=True)))
    return ends


def _lowest(ends: Ends) -> int:
    """The search of the least misfit, one that converged if it is as good."""
    lowest = int(np.argmin(ends.chi_squared))
    best = int(np.argmin(np.where(ends.state == CONVERGED, ends.chi_squared, np.inf)))
    return best if ends.state[best] == CONVERGED and ends.chi_squared[best] <= ends.chi_squared[lowest] + SAME else lowest


def _check_ended(place: Place, ends: Ends) -> None:
    """Refuses where the misfit is least at a place that is no minimum of a smooth model."""
    advice = "Narrow the bounds to one side of it, or give fewer unknowns"
    if place.state != CONVERGED:
        why = {
            STALLED: _BENT,
            AT_REFUSAL: "beyond it the model refuses (the bodies no longer meet, for one)",
            SEARCHING: "the search was still going down",
        }[place.state]
    elif place.question.problem.is_bent(place.point):
        why = _BENT
    elif _turns(place, ends):
        why = "there the model turns round, so that its slopes tell no error"
        advice = (
            "Narrow the bounds to one side of it (on a bound the rise of chi-squared tells a range), give a prior of it (a "
            "Normal), or fewer unknowns"
        )
    else:
        return
    at = dict(zip(place.question.names, place.point.tolist(), strict=True))
    where = ", ".join(f"{name} = {value:.6g}" for name, value in at.items())
    raise NoSolutionError(
        f"no search ended at a minimum: the least misfit found is chi-squared {place.chi_squared:.6g} at {where}, and "
        f"{why}. {advice}",
        code="no_convergence",
        chi_squared=place.chi_squared,
        at=at,
    )


def _turns(place: Place, ends: Ends) -> bool:
    """Whether searches agree in an unknown that the slopes leave open, or slopes vanish so close by that no error holds."""
    is_open = np.isinf(np.diagonal(told_at(place).covariance))
    return bool(np.any(is_open & agreed(place, ends))) or turns(place, _NARROWER)


def _rivals(question: Question, ends: Ends, best: Place) -> list[Place]:
    """The best answer, and others that the evidence does not rule out although the errors of the best do.

    Apart are those beyond one standard error in what the better one determines; what it leaves open is open there too.
    """
    near = np.flatnonzero((ends.state == CONVERGED) & (ends.chi_squared <= best.chi_squared + TWICE))
    turning = np.array([unknown.unit == "rad" for unknown in question.unknowns])
    kept = [(best, _precision(told_at(best).covariance))]
    for k in near[np.argsort(ends.chi_squared[near], kind="stable")].tolist():
        for one, precision in kept:
            way = ends.points[k] - one.point
            way = np.where(turning, (way + np.pi) % (2.0 * np.pi) - np.pi, way)
            if way @ precision @ way <= _APART**2:
                break
        else:
            place = seen_closely(question, ends, k)
            if _is_minimum(place):
                place = on_bounds(place, ends)
                kept.append((place, _precision(told_at(place).covariance)))
    return [place for place, _ in kept]


def _is_minimum(place: Place) -> bool:
    """Whether searches from around the place do not leave it: from a ridge that one start met exactly they do."""
    problem = place.question.problem
    away = np.minimum(_NUDGE * problem.scale, np.sqrt(np.diagonal(told_at(place).covariance)))
    again = minimise(problem, place.point + spread(_AROUND, -away, away))
    return bool(np.min(again.chi_squared) >= place.chi_squared - SAME)


def _precision(covariance: Any) -> Any:
    """The inverse of the covariance of what is determined, 0 for the rest."""
    known = np.isfinite(np.diagonal(covariance))
    size = np.where(known, np.sqrt(np.diagonal(covariance)), np.inf)
    correlation = np.where(np.outer(known, known), covariance, 0.0) / np.outer(size, size)
    return np.linalg.pinv(correlation, hermitian=True) / np.outer(size, size)


def _ambiguous(fits: list[Fit]) -> AmbiguousSolutionError:
    listed = "; ".join(
        f"chi-squared {one.chi_squared:.4g} at "
        + ", ".join(f"{name} {'open' if math.isnan(value) else f'= {value:.6g}'}" for name, value in one.values.items())
        for one in fits
    )
    return AmbiguousSolutionError(
        f"{len(fits)} answers fit the evidence about as well: {listed}. All are in .solutions; narrow the bounds of an unknown "
        f"to one of them, or add an observation that tells them apart",
        code="ambiguous",
        solutions=tuple(fits),
    )


def _say(question: Question, found: Fit) -> None:
    """What must not be overlooked in the answer, as warnings; and those that the model itself gives there."""
    lost = [name for name in found.names if not found[name].determined]
    if lost:
        sentences = "; ".join(one.sentence for one in found.undetermined if not one.held_by_prior)
        _warn(
            IllConditionedWarning,
            f"nothing determines {', '.join(lost)}, which are NaN: {sentences}. Give a prior (a Normal), or an observation "
            f"that tells it",
            "undetermined",
        )
    else:
        with np.errstate(all="ignore"):
            question.model.function(**{name: np.array([value]) for name, value in found.values.items()})
    if math.isnan(found.nonlinearity) or found.nonlinearity > BENT:
        _warn(IllConditionedWarning, f"{found.bend}; sample the unknowns, or give priors that hold them closer", "not_linear")
    if found.told_by_bounds:
        sentences = "; ".join(one for one in found.statements if "exceeds the width of its bounds" in one)
        _warn(IllConditionedWarning, f"{sentences}; give an observation that tells more, or a prior", "told_by_bounds")
    if found.consistent is False:
        worst = max(found.residuals.items(), key=lambda item: abs(item[1].over_sigma))
        _warn(
            CollisionsWarning,
            f"the evidence contradicts itself, the model or the stated errors: a misfit this large (chi-squared "
            f"{found.chi_squared:.4g} with {found.degrees_of_freedom} degrees of freedom) has a chance of {found._chance}, and "
            f"{CONTRADICTION} would pass; the furthest off is {worst[0]}, by {abs(worst[1].over_sigma):.3g} sigma",
            "contradictory",
        )
    for name, one in found.residuals.items():
        bare = not one.unit and not one.is_prior and max(abs(one.observed), abs(one.computed)) <= math.pi
        if bare and abs(one.residual) > math.pi:
            _warn(
                SuspectUnitsWarning,
                f"{name} is observed as {one.observed:.6g} and computed as {one.computed:.6g}; if it is an angle, the short "
                f"way between them is round the circle: give it with its unit, such as Normal("
                f"'{math.degrees(one.observed):.4g} deg', '{math.degrees(one.sigma):.3g} deg')",
                "bare_angle",
            )


def _warn(kind: type[CollisionsWarning], text: str, code: str) -> None:
    warn(kind(text, code=code))
