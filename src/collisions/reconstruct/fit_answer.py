"""From where a search ended to the answer of a fit, with everything that has to be said of it."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from .chi_squared import survival
from .fit_parts import TWO_ERRORS, Direction, Residual, Values
from .fit_place import SAME, Place, rise_when_moved, told_at
from .fit_result import Fit
from .least_squares import CONVERGED, REFUSED, Ends

_LEAST = 0.1  # standard errors: what moves less, and less than that in sigma, is not compared


def answer_at(place: Place, ends: Ends, around: int) -> Fit:
    """The Fit of the place where one of the searches ended, the last of them begun around the best."""
    told = told_at(place)
    question, point = place.question, place.point
    problem = question.problem
    names, n = question.names, len(question.unknowns)
    stated = question.stated
    sigma = np.array([value.given_sd for _, value, _ in stated])
    computed = [
        *question.computed(point[np.newaxis])[0],
        *(point[names.index(name)] for name, _, is_prior in stated if is_prior),
    ]
    over_sigma = -problem.misfit(place.outputs)
    residuals: dict[str, Residual] = {}
    for i, (name, value, is_prior) in enumerate(stated):
        residuals[f"prior of {name}" if is_prior else name] = Residual(
            name=name,
            unit=value.unit or question.model.units.get(name) or "",
            observed=value.given_mean,
            computed=float(computed[i]),
            residual=float(over_sigma[i] * sigma[i]),
            sigma=value.given_sd,
            over_sigma=float(over_sigma[i]),
            is_prior=is_prior,
        )
    errors = np.sqrt(np.diagonal(told.covariance))
    sides = np.where(point <= problem.low, "low", np.where(point >= problem.high, "high", ""))
    at_bounds = {names[j]: str(sides[j]) for j in range(n) if sides[j] and np.isfinite(errors[j])}
    freedom = len(stated) - told_at(place, _free(place)).rank
    chi_squared = float(over_sigma @ over_sigma)
    values = {name: float(point[j]) if np.isfinite(errors[j]) else math.nan for j, name in enumerate(names)}
    units = {unknown.name: unknown.unit for unknown in question.unknowns}
    covariance = np.array(told.covariance)
    covariance.setflags(write=False)
    directions = itertools.chain(zip(told.open, itertools.repeat(False)), zip(told.held, itertools.repeat(True)))
    return Fit(
        values=Values(values, units),
        names=names,
        units=units,
        bounds={unknown.name: (unknown.low, unknown.high) for unknown in question.unknowns},
        covariance=covariance,
        residuals=residuals,
        contributions={
            name: dict(zip(residuals, told.shares[j].tolist(), strict=True)) if math.isfinite(errors[j]) else {}
            for j, name in enumerate(names)
        },
        chi_squared=chi_squared,
        degrees_of_freedom=freedom,
        p_value=survival(chi_squared, freedom),
        undetermined=tuple(
            Direction(changes={names[j]: float(row[j]) for j in np.flatnonzero(row)}, held_by_prior=held)
            for row, held in directions
        ),
        at_bounds=at_bounds,
        reaches={names[j]: reach.value for j, reach in place.reaches.items()},
        nonlinearity=nonlinearity(place),
        searches=_counted(ends, place.chi_squared) | {"around": around},
    )


def nonlinearity(place: Place) -> float:
    """Relative error of the half-width of the 95 percent intervals: each unknown moved by two errors, the others fitted again.

    Chi-squared then rises by 4 in a straight model; where a bound is nearer, by the square of the errors as far as that. NaN if
    the model refuses there.
    """
    far, risen = _moved(place)
    compared = np.fmax(far, risen) > _LEAST
    if not np.any(compared):
        return 0.0
    with np.errstate(divide="ignore"):
        return float(np.max(abs(far / risen - 1.0)[compared | np.isnan(risen)]))


def turns(place: Place, narrower: float) -> bool:
    """Whether the errors of an unknown are so many times too large to both sides: its slope vanishes close by."""
    far, risen = _moved(place)
    return bool(np.any(np.all((risen > TWO_ERRORS) & (risen > narrower * far), axis=0)))


def _moved(place: Place) -> tuple[Any, Any]:
    """By how many errors each unknown is moved up and down (2, n), and by how many sigma the misfit rises; NaN if refused."""
    problem, point = place.question.problem, place.point
    free = _free(place)
    covariance = told_at(place, free).covariance
    known = np.isfinite(np.diagonal(covariance))
    which, covariance = np.flatnonzero(free)[known], covariance[np.ix_(known, known)]
    if not which.size:
        return np.zeros((2, 0)), np.zeros((2, 0))
    errors = np.sqrt(np.diagonal(covariance))
    ways = np.zeros((len(which), len(point)))
    ways[:, which] = covariance / errors[:, np.newaxis]
    room = np.stack([problem.high[which] - point[which], point[which] - problem.low[which]])
    far = np.minimum(room / errors, TWO_ERRORS)
    starts = point + np.concatenate([far[0, :, np.newaxis] * ways, -far[1, :, np.newaxis] * ways])
    return far, np.sqrt(rise_when_moved(place, starts, np.tile(which, 2))).reshape(2, -1)


def _free(place: Place) -> Any:
    """The unknowns that are not on a bound, as far as they are determined at all."""
    problem, point = place.question.problem, place.point
    told = np.isfinite(np.diagonal(told_at(place).covariance))
    return ~(told & ((point <= problem.low) | (point >= problem.high)))


def _counted(ends: Ends, chi_squared: float) -> dict[str, int]:
    same = (ends.state == CONVERGED) & (abs(ends.chi_squared - chi_squared) <= SAME)
    refused = ends.state == REFUSED
    counts = {
        "starts": len(same),
        "here": same,
        "elsewhere": (ends.state == CONVERGED) & ~same,
        "refused": refused,
        "without_end": ~refused & (ends.state != CONVERGED),
    }
    return {name: int(np.count_nonzero(one)) if isinstance(one, np.ndarray) else one for name, one in counts.items()}
