"""``fit``: estimates the unknowns of a scene from measurements, each with its error, by weighted least squares."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..errors import AmbiguousSolutionError, NoSolutionError, SuspectUnitsWarning
from ..quantities import lock
from ..settings import in_si
from ..warning import warn
from .fit_candidate import SAME_CHI_SQUARED, Candidate, ended_at, examined
from .fit_problem import FitInputs, read_fit_inputs
from .fit_result import Direction, Fit, Values, notes_of, residual_of, warn_of
from .least_squares import (
    AT_REFUSAL,
    CONVERGED,
    REFUSED,
    SEARCHING,
    STALLED,
    Ends,
    Problem,
    chi_squared_tail,
    minimise,
    spread,
)
from .observations import listed, refused_everywhere

_STARTS = 64
_FEW = 2  # searches that ended at the best, among more: there may be a better one
_OVERSTATED = 10.0  # times the errors that chi-squared shows: then the slope vanishes nearby
_TOO_CLOSE = 4.0  # of chi-squared, that the errors of the best do not exclude
_APART = 1.0  # standard errors
_AROUND, _NUDGE = 8, 1e-2  # searches, and part of the scale of each unknown by which they start off at most

_WHY_NO_MINIMUM = {
    STALLED: "there the model has a jump or a bend (a contact that begins to stick, an angle without unit that goes round), so "
    "that no error can be given",
    AT_REFUSAL: "beyond it the model refuses (the bodies no longer meet, for one)",
    SEARCHING: "the search was still going down",
}


def fit(model: Callable[..., Mapping[str, Any]], unknowns: Mapping[str, Any], observed: Mapping[str, Any]) -> Fit:
    """Estimate the unknowns of a scene from measurements, each given with its error.

    Weighted least squares: the sum of the squares of (observed - computed)/sigma, over the observations and over what was known
    before, is made least within the bounds (Levenberg-Marquardt from 64 starts spread over what was known). The covariance is
    that of the slopes of the model at the answer and of the errors as stated; it is not scaled by the misfit. It holds where
    the errors of the observations are normal and independent and the model bends little within two standard errors, which
    is tried and warned of. Where one answer with such errors does not describe what the evidence says, this refuses or warns:
    ``posterior`` answers then, whatever the priors and however the model bends.

    Parameters
    ----------
    model : function
        ``model(**unknowns)`` returns a dict of named outputs. It is called with an array of cases for every unknown [SI] and
        answers each with an array as long, NaN where it refuses (``on_failure="nan"``), as for ``uncertainty.propagate``: every
        case by itself, of which a few are called again by themselves. What is known exactly is written in the model.
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
        Another answer, more than a standard error away, has a chi-squared less than 4 above the best: all that the searches met
        are in ``solutions``. So it is with a friction that slides, or sticks whatever its value.
    NoSolutionError
        The model refuses at every start (code "refused"); or the misfit is least at a jump, a bend, an edge or a turning point
        of the model, such as no restitution where only its square matters: no error can be given there; or at most two of the
        searches ended there, so that a better answer may have been missed (code "no_convergence").

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
    # A point at which numbers overflow counts as refused.
    with np.errstate(all="ignore"):
        inputs = read_fit_inputs(model, unknowns, observed)
        problem = inputs.problem()
        starts = spread(_STARTS, *inputs.box)
        starts[0] = inputs.numbers_of("start")
        ends = minimise(problem, starts)
        if np.all(ends.state == REFUSED):
            raise _refused_everywhere(inputs)
        best = examined(inputs, problem, ends, _lowest(ends))
        _check_minimum(best, ends)
        fits = [_answer(candidate, ends) for candidate in _rivals(problem, ends, best)]
        if len(fits) > 1:
            raise _ambiguous(fits)
        found = fits[0]
        if not any(map(math.isnan, found.values.values())):
            # For the warnings that the model itself gives there.
            with in_si():
                inputs.model.function(**{name: np.array([value]) for name, value in found.values.items()})
    _warn_of(found)
    return found


def _refused_everywhere(inputs: FitInputs) -> NoSolutionError:
    """The error if the model has no answer anywhere, with its own reason if a single case gives one."""
    at = {name: unknown.start for name, unknown in inputs.unknowns.items()}
    return NoSolutionError(
        f"the model refuses all {_STARTS} points tried for the unknowns, among them {listed(at)}"
        f"{refused_everywhere(inputs.model, at)}. Give bounds or starts of the unknowns within which the impact happens; "
        f"reconstruct.posterior finds rare ones too",
        code="refused",
        points=_STARTS,
        at=at,
    )


def _lowest(ends: Ends) -> int:
    """The search with the least misfit, or a converged one that is as good."""
    lowest = int(np.argmin(ends.chi_squared))
    best = int(np.argmin(np.where(ends.state == CONVERGED, ends.chi_squared, np.inf)))
    as_good = ends.chi_squared[best] <= ends.chi_squared[lowest] + SAME_CHI_SQUARED
    return best if ends.state[best] == CONVERGED and as_good else lowest


def _check_minimum(best: Candidate, ends: Ends) -> None:
    """Raise if the misfit is least at a point that is not a minimum of a smooth model."""
    why, here = _WHY_NO_MINIMUM.get(best.state), ended_at(ends, best.chi_squared)
    if why is None and best.problem.has_kink(best.point):
        why = _WHY_NO_MINIMUM[STALLED]
    if why is None and (best.turns_round(ends) or best.overstates_errors(_OVERSTATED)):
        why = "there the model turns round, so that its slopes give no error"
    if why is None and np.count_nonzero(here) <= _FEW < np.count_nonzero(ends.state != REFUSED):
        why = f"few of the {_STARTS} searches ended there, so that a better answer may lie between them"
    if why is not None:
        at = dict(zip(best.inputs.names, best.point.tolist(), strict=True))
        raise NoSolutionError(
            f"no search ended at a minimum that can be relied on: the least misfit found is chi-squared "
            f"{best.chi_squared:.6g} at {listed(at)}, and "
            f"{why}. reconstruct.posterior answers there too, with a range; or narrow the bounds to one side of it, or give a "
            f"prior of it (a Normal), or fewer unknowns",
            code="no_convergence",
            chi_squared=float(best.chi_squared),
            at=at,
        )


def _rivals(problem: Problem, ends: Ends, best: Candidate) -> list[Candidate]:
    """The best solution, and others that the evidence does not exclude although the errors of the best do.

    Apart are those beyond one standard error in what the better one determines; what it does not is not in the other either.
    """
    near = np.flatnonzero((ends.state == CONVERGED) & (ends.chi_squared <= best.chi_squared + _TOO_CLOSE))
    turning = np.array([unknown.unit == "rad" for unknown in best.inputs.unknowns.values()])
    found = [(best, _precision(best.determination.covariance))]
    for k in near[np.argsort(ends.chi_squared[near], kind="stable")].tolist():
        for one, precision in found:
            way = ends.points[k] - one.point
            way = np.where(turning, (way + np.pi) % (2.0 * np.pi) - np.pi, way)
            if way @ precision @ way <= _APART**2:
                break
        else:
            rival = examined(best.inputs, problem, ends, k)
            if _is_minimum(rival):
                found.append((rival, _precision(rival.determination.covariance)))
    return [one for one, _ in found]


def _is_minimum(found: Candidate) -> bool:
    """Whether searches started around the point do not leave it; they do leave a ridge that one search met exactly."""
    away = np.minimum(_NUDGE * found.problem.scale, found.errors)
    again = minimise(found.problem, found.point + spread(_AROUND, -away, away))
    return bool(np.min(again.chi_squared) >= found.chi_squared - SAME_CHI_SQUARED)


def _precision(covariance: Any) -> Any:
    """The inverse of the covariance of the identified unknowns, 0 for the others."""
    known = np.isfinite(np.diagonal(covariance))
    size = np.where(known, np.sqrt(np.diagonal(covariance)), np.inf)
    correlation = np.where(np.outer(known, known), covariance, 0.0) / np.outer(size, size)
    return np.linalg.pinv(correlation, hermitian=True) / np.outer(size, size)


def _answer(found: Candidate, ends: Ends) -> Fit:
    """The ``Fit`` of a candidate."""
    inputs, problem, point, determined = found.inputs, found.problem, found.point, found.determination
    names = inputs.names
    units = {name: unknown.unit for name, unknown in inputs.unknowns.items()}
    identified = np.isfinite(found.errors).tolist()
    over_sigma = -problem.misfit(found.outputs)
    computed = inputs.computed(point[np.newaxis])[0]
    residuals = {
        f"prior of {row.name}" if row.is_prior else row.name: residual_of(
            row, inputs.model.units.get(row.name), value, sigmas * row.sigma, sigmas
        )
        for row, value, sigmas in zip(inputs.rows, computed.tolist(), over_sigma.tolist(), strict=True)
    }
    sides = np.where(point <= problem.low, "low", np.where(point >= problem.high, "high", "")).tolist()
    degrees_of_freedom = len(inputs.rows) - found.determination_of(found.free).rank
    chi_squared = float(over_sigma @ over_sigma)
    values = np.where(identified, point, math.nan).tolist()
    shares = [dict(zip(residuals, row, strict=True)) for row in determined.shares.tolist()]
    return Fit(
        values=Values(dict(zip(names, values, strict=True)), units),
        names=names,
        units=units,
        bounds={name: (unknown.low, unknown.high) for name, unknown in inputs.unknowns.items()},
        covariance=lock(np.array(determined.covariance)),
        residuals=residuals,
        contributions={name: row if known else {} for name, row, known in zip(names, shares, identified, strict=True)},
        chi_squared=chi_squared,
        degrees_of_freedom=degrees_of_freedom,
        p_value=chi_squared_tail(chi_squared, degrees_of_freedom),
        undetermined=tuple(
            Direction(changes={names[j]: float(row[j]) for j in np.flatnonzero(row)}, held_by_prior=held)
            for held, rows in ((False, determined.unidentified), (True, determined.prior_only))
            for row in rows
        ),
        at_bounds={name: side for name, side, known in zip(names, sides, identified, strict=True) if side and known},
        nonlinearity=found.nonlinearity,
        searches=_counted(ends, found.chi_squared),
    )


def _counted(ends: Ends, chi_squared: float) -> dict[str, int]:
    here, converged, refused = ended_at(ends, chi_squared), ends.state == CONVERGED, ends.state == REFUSED
    kinds = {"here": here, "elsewhere": converged & ~here, "refused": refused, "without_end": ~refused & ~converged}
    return {"starts": len(here)} | {name: int(np.count_nonzero(one)) for name, one in kinds.items()}


def _warn_of(found: Fit) -> None:
    """Give each warning that the result needs, once."""
    warn_of(notes_of(found))
    for name, one in found.residuals.items():
        bare = not one.unit and not one.is_prior and max(abs(one.observed), abs(one.computed)) <= math.pi
        if bare and abs(one.residual) > math.pi:
            warn(
                SuspectUnitsWarning(
                    f"{name} is observed as {one.observed:.6g} and computed as {one.computed:.6g}; if it is an angle, the "
                    f"short way between them is round the circle: give it with its unit, such as Normal("
                    f"'{math.degrees(one.observed):.4g} deg', '{math.degrees(one.sigma):.3g} deg')",
                    code="bare_angle",
                )
            )


def _ambiguous(fits: list[Fit]) -> AmbiguousSolutionError:
    answers = "; ".join(f"chi-squared {one.chi_squared:.4g} at {listed(one.values)}" for one in fits)
    return AmbiguousSolutionError(
        f"{len(fits)} answers fit the evidence about as well: {answers}. All are in .solutions; "
        f"reconstruct.posterior says how probable each is; or narrow the bounds of an unknown to one of them, or add an "
        f"observation that tells them apart",
        code="ambiguous",
        solutions=tuple(fits),
    )
