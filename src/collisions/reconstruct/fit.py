"""fit: unknowns of a scene from whatever was measured of it, each with its error."""

from __future__ import annotations

import math
import warnings
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
from ..units import callers_level
from .fit_answer import SAME, answer_at, told_at
from .fit_question import Question, read_question, refused_everywhere
from .fit_result import BENT, CONTRADICTION, Fit
from .least_squares import AT_REFUSAL, CONVERGED, REFUSED, SEARCHING, STALLED, Ends, minimise, spread

_STARTS = 64
_MORE_STARTS = 4096  # looked at where the model refuses all of the first
_RIVAL = 4.0  # of chi-squared: two standard errors
_OPEN = 1e-2  # of the scale of an unknown
_BENT = (
    "there the model has a jump or a bend (a contact that begins to stick, an angle without unit that goes round), so that no "
    "error can be given"
)
_APART = 1.0  # standard errors
_AROUND, _NUDGE = 8, 1e-2  # searches, and part of the scale of each unknown by which they start off


def fit(model: Callable[..., Mapping[str, Any]], unknowns: Mapping[str, Any], observed: Mapping[str, Any]) -> Fit:
    """Find the unknowns of a scene that fit what was measured of it, each measurement with its error.

    Weighted least squares: the sum of the squares of (observed - computed)/sigma, over the observations and over what was known
    before, is made least within the bounds (Levenberg-Marquardt from 64 starts spread over what was known). The covariance is
    that of the slopes of the model at the answer and of the errors as stated; it is not scaled by the misfit. It holds where
    the errors of the observations are normal and independent and the model bends little within two standard errors, which
    is tried and warned of. Rivals are looked for between the starts, not proved absent.

    Parameters
    ----------
    model : function
        ``model(**unknowns)`` returns a dict of named outputs. It is called with an array of cases for every unknown [SI] and
        answers each with an array as long, NaN where it refuses (``on_failure="nan"``), as for ``uncertainty.propagate``. What
        is known exactly is written in the model.
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
        An argument that cannot be used, or a model that returns something else than named arrays.
    AmbiguousSolutionError
        Another answer, more than a standard error away, has a chi-squared less than 4 above the best: all are in ``solutions``.
        So it is with a friction that slides, or sticks whatever its value.
    NoSolutionError
        The model refuses everywhere (code "refused"); or the misfit is least at a jump, a bend, an edge or a turning point of
        the model, where no error can be given (code "no_convergence").

    Warns
    -----
    IllConditionedWarning
        Nothing determines an unknown; or the model bends, or refuses, within two standard errors of the answer.
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
    >>> from collisions.uncertainty.inputs import Interval, Normal
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
    question = read_question(model, unknowns, observed)
    ends = _searched(question)
    best = int(np.argmin(np.where(ends.state == CONVERGED, ends.chi_squared, np.inf)))
    _check_ended(question, ends, best)
    fits = [answer_at(question, ends, k) for k in _rivals(question, ends, best)]
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


def _check_ended(question: Question, ends: Ends, best: int) -> None:
    """Refuses where the misfit is least at a place that is no minimum of a smooth model."""
    lowest = int(np.argmin(ends.chi_squared))
    if ends.state[best] != CONVERGED or ends.chi_squared[best] > ends.chi_squared[lowest] + SAME:
        why = {
            STALLED: _BENT,
            AT_REFUSAL: "beyond it the model refuses (the bodies no longer meet, for one)",
            SEARCHING: "the search was still going down",
        }[int(ends.state[lowest])]
    elif question.problem.is_bent(ends.points[best]):
        lowest, why = best, _BENT
    elif _turns(question, ends, best):
        lowest, why = best, "there the model turns round, so that its slopes tell no error"
    else:
        return
    at = dict(zip(question.names, ends.points[lowest].tolist(), strict=True))
    where = ", ".join(f"{name} = {value:.6g}" for name, value in at.items())
    raise NoSolutionError(
        f"no search ended at a minimum: the least misfit found is chi-squared {ends.chi_squared[lowest]:.6g} at {where}, and "
        f"{why}. Narrow the bounds to one side of it, or give fewer unknowns",
        code="no_convergence",
        chi_squared=float(ends.chi_squared[lowest]),
        at=at,
    )


def _turns(question: Question, ends: Ends, best: int) -> bool:
    """Whether searches agree in an unknown that the slopes leave open: what is open stays wherever a search began."""
    here = (ends.state == CONVERGED) & (ends.chi_squared <= ends.chi_squared[best] + SAME)
    is_open = np.isinf(np.diagonal(told_at(question, ends, best).covariance))
    spans = np.ptp(ends.points[here], axis=0) / question.problem.scale
    return bool(np.count_nonzero(here) > 1 and np.any(is_open & (spans < _OPEN)))


def _rivals(question: Question, ends: Ends, best: int) -> list[int]:
    """The best answer, and others that the evidence does not rule out although the errors of the best do.

    Apart are those beyond one standard error in what the better one determines; what it leaves open is open there too.
    """
    near = np.flatnonzero((ends.state == CONVERGED) & (ends.chi_squared <= ends.chi_squared[best] + _RIVAL))
    turning = np.array([unknown.unit == "rad" for unknown in question.unknowns])
    kept = {best: _precision(told_at(question, ends, best).covariance)}
    for k in near[np.argsort(ends.chi_squared[near], kind="stable")].tolist():
        for one, precision in kept.items():
            way = ends.points[k] - ends.points[one]
            way = np.where(turning, (way + np.pi) % (2.0 * np.pi) - np.pi, way)
            if way @ precision @ way <= _APART**2:
                break
        else:
            if _is_minimum(question, ends, k):
                kept[k] = _precision(told_at(question, ends, k).covariance)
    return list(kept)


def _is_minimum(question: Question, ends: Ends, k: int) -> bool:
    """Whether searches from around the place do not leave it: from a ridge that one start met exactly they do."""
    around = spread(_AROUND, -_NUDGE * question.problem.scale, _NUDGE * question.problem.scale)
    again = minimise(question.problem, ends.points[k] + around)
    return bool(np.min(again.chi_squared) >= ends.chi_squared[k] - SAME)


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
    if found.consistent is False:
        worst = max(found.residuals.items(), key=lambda item: abs(item[1].over_sigma))
        _warn(
            CollisionsWarning,
            f"the evidence contradicts itself, the model or the stated errors: a misfit this large (chi-squared "
            f"{found.chi_squared:.4g} with {found.degrees_of_freedom} degrees of freedom) has a chance of {found.p_value:.1g}, "
            f"less than {CONTRADICTION}; the furthest off is {worst[0]}, by {abs(worst[1].over_sigma):.3g} sigma",
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
    warnings.warn(kind(text, code=code), stacklevel=callers_level())
