"""From where a search ended to the answer of a fit, with everything that has to be said of it."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from .chi_squared import survival
from .determination import Determination, determination
from .fit_question import Question
from .fit_result import Direction, Fit, Residual, Values
from .least_squares import CONVERGED, REFUSED, Ends, minimise

SAME = 1e-3  # of chi-squared: searches that ended within this met the same misfit
_FAR, _NEAR = 2.0, 1e-2  # standard errors


def told_at(question: Question, ends: Ends, k: int, chosen: Any = ...) -> Determination:
    """What is told of the unknowns where a search ended; of the chosen ones if the others stay as they are."""
    problem = question.problem
    is_prior = np.arange(len(problem.target)) >= len(question.observed)
    steps = problem.steps(ends.points[k : k + 1])[0]
    unbounded = np.isinf(problem.low) & np.isinf(problem.high) & ~np.isin(np.arange(len(problem.scale)), question.with_prior)
    scale = np.where(unbounded, np.maximum(problem.scale, abs(ends.points[k])), problem.scale)
    return determination(ends.slopes[k][:, chosen], is_prior, scale[chosen], ends.outputs[k], steps[chosen])


def answer_at(question: Question, ends: Ends, k: int) -> Fit:
    """The Fit of the place where a search ended."""
    told = told_at(question, ends, k)
    problem, point = question.problem, ends.points[k]
    names, n = question.names, len(question.unknowns)
    stated = question.stated
    sigma = np.array([value.given_sd for _, value, _ in stated])
    computed = [
        *question.computed(point[np.newaxis])[0],
        *(point[names.index(name)] for name, _, is_prior in stated if is_prior),
    ]
    over_sigma = -problem.misfit(ends.outputs[k])
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
    free = np.array([name not in at_bounds for name in names])
    inner = told_at(question, ends, k, free) if at_bounds else told
    freedom = len(stated) - inner.rank
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
        nonlinearity=_nonlinearity(question, point, inner.covariance, free, chi_squared),
        searches=_counted(ends, k),
    )


def _nonlinearity(question: Question, point: Any, covariance: Any, free: Any, chi_squared: float) -> float:
    """Relative error of the half-width of the 95 percent intervals: each unknown moved by two errors, the others fitted again.

    Chi-squared then rises by 4 in a straight model. NaN if the model refuses there; ends beyond a bound are left out.
    """
    problem = question.problem
    which = np.flatnonzero(free)[np.isfinite(np.diagonal(covariance))]
    known = np.ix_(*[np.isfinite(np.diagonal(covariance))] * 2)
    ways = np.zeros((len(which), len(point)))
    ways[:, which] = _FAR * covariance[known] / np.sqrt(np.diagonal(covariance[known]))[:, np.newaxis]
    starts, moved = point + np.concatenate([ways, -ways]), np.tile(which, 2)
    rows = np.arange(len(moved))
    within = (starts[rows, moved] >= problem.low[moved]) & (starts[rows, moved] <= problem.high[moved])
    if not np.any(within):
        return 0.0
    movable = np.ones(starts.shape, dtype=bool)
    movable[rows, moved] = False
    ends = minimise(problem, starts[within], movable[within], close=_NEAR)
    if np.any(ends.state == REFUSED):
        return math.nan
    rise = np.maximum(ends.chi_squared - chi_squared, 0.0)
    with np.errstate(divide="ignore"):
        return float(np.max(abs(_FAR / np.sqrt(rise) - 1.0)))


def _counted(ends: Ends, k: int) -> dict[str, int]:
    same = (ends.state == CONVERGED) & (ends.chi_squared <= ends.chi_squared[k] + SAME)
    refused = ends.state == REFUSED
    counts = {
        "starts": len(same),
        "here": same,
        "elsewhere": (ends.state == CONVERGED) & ~same,
        "refused": refused,
        "without_end": ~refused & (ends.state != CONVERGED),
    }
    return {name: int(np.count_nonzero(one)) if isinstance(one, np.ndarray) else one for name, one in counts.items()}
