"""First and second order: derivatives at the mean of the inputs, and a test of whether they tell enough.

First order is the law of propagation of uncertainty of the "Guide to the expression of uncertainty in measurement" (JCGM
100:2008, eq 13); second order adds the curvature, exactly so where the model is a quadratic of independent or of normal inputs.
Neither knows of a friction limit or a refusal beside the mean, which is why the model is asked at points drawn from the inputs
as well and both are compared.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..errors import NoSolutionError
from . import angles, normal
from .designs import Design
from .draw import Joint
from .model import Model
from .output import Output, Shares, average, deviation
from .shares import label

# Of a step, in standard deviations: the differences below err by its fourth power and by rounding over its square.
_STEP = 0.01
_LEAST_STEP = 1e6  # roundings of the mean, so that the step itself is known to a millionth
_EPSILON = float(np.finfo(np.float64).eps)
_LEAST = float(np.finfo(np.float64).tiny)  # below, floats have few digits
_PROBES = 4096
_NOTICED = 0.1  # standard deviations by which a local figure may differ at the probes before it is said so
# Of the slope: a change of it within the steps, beyond what a curvature makes, which is a bend or a jump. That of a smooth
# model is a millionth of its fourth derivative.
_BENT = 0.01
_NO_DIFFERENCE = 1e-12  # of the values: what rounding may make


class Slopes(NamedTuple):
    """Value, gradient and second derivatives of an output at the mean of the inputs, each input in its standard deviations."""

    value: float
    gradient: Any
    curvature: Any


class Local(Output):
    """An output from derivatives at the mean of the inputs, whose quantiles are those of a normal, with skewness if known."""

    def __init__(
        self,
        name: str,
        unit: str | None,
        mean: float,
        std: float,
        skewness: float,
        shares: Callable[[], Mapping[str, Shares]],
    ) -> None:
        super().__init__(name, unit, shares)
        self._figures = mean, std
        self.skewness = skewness

    def _mean(self) -> Any:
        return self._figures[0]

    def _std(self) -> Any:
        return self._figures[1]

    def _quantile(self, p: Any) -> Any:
        z = normal.quantile(p)
        mean, std = self._figures
        if std == 0.0:
            return mean + 0.0 * np.asarray(p) if np.ndim(p) else mean
        if self.skewness:
            # Cornish and Fisher's first term, which shifts the quantiles of a skew distribution, as far as it rises.
            turn = -3.0 / self.skewness
            z = np.maximum(z, turn) if self.skewness > 0.0 else np.minimum(z, turn)
            with np.errstate(invalid="ignore"):
                z = np.where(np.isinf(z), z, z + (z * z - 1.0) * (self.skewness / 6.0))
        found = mean + std * z
        return found if np.ndim(found) else float(found)

    def _turn(self, turns: float) -> None:
        self._figures = self._figures[0] + 2.0 * math.pi * turns, self._figures[1]
        self._cache.clear()


def slopes(model: Model, joint: Joint, second: bool) -> tuple[dict[str, Slopes], int]:
    """The derivatives of every output by central differences, from one call of the model; and how many cases that took."""
    names = joint.names
    count = len(names)
    mean = np.array([joint.inputs[name].mean for name in names])
    sd = np.array([joint.inputs[name].sd for name in names])
    step = np.array([_step(joint.inputs[name].support, m, s) for name, m, s in zip(names, mean, sd, strict=True)])
    unit = np.eye(count)
    pairs = [(i, j) for i in range(count) for j in range(i)] if second else []
    rows = [np.zeros(count), *(k * unit[i] for i in range(count) for k in (-2, -1, 1, 2))]
    rows += [p * unit[i] + q * unit[j] for i, j in pairs for p in (-1, 1) for q in (-1, 1)]
    away = np.array(rows)
    at = mean + away * (step * sd)
    answers = model({name: np.ascontiguousarray(at[:, i]) for i, name in enumerate(names)}, len(at))
    found = {}
    for name, values in answers.items():
        if np.isnan(values).any():
            raise NoSolutionError(
                f"the model has no answer for {name!r} at or beside the mean of the inputs, so it has no derivative there; "
                f"take method='quasi_random', which counts such cases",
                code="no_derivative",
                output=name,
            )
        if model.units[name] == "rad":
            values = angles.beside(values, float(values[0]))
        beside = values[1 : 1 + 4 * count].reshape(count, 4) - values[0]
        gradient = (8.0 * (beside[:, 2] - beside[:, 1]) - (beside[:, 3] - beside[:, 0])) / (12.0 * step)
        bent = np.abs((beside[:, 3] + beside[:, 0]) - 4.0 * (beside[:, 2] + beside[:, 1]))
        rounding = 64.0 * _EPSILON * float(np.max(np.abs(values)))
        bends = (bent > rounding) & (bent > _BENT * step * float(np.linalg.norm(gradient)))
        if bends.any():
            raise NoSolutionError(
                f"the model has a bend or a jump in {name!r} at the mean of the inputs, along "
                f"{names[int(np.argmax(bends))]!r}, so its derivatives there tell nothing of the spread; take "
                f"method='quasi_random'",
                code="no_derivative",
                output=name,
            )
        curvature = np.diag((16.0 * (beside[:, 2] + beside[:, 1]) - (beside[:, 3] + beside[:, 0])) / (12.0 * step**2))
        for (i, j), (mm, mp, pm, pp) in zip(pairs, values[1 + 4 * count :].reshape(-1, 4), strict=True):
            curvature[i, j] = curvature[j, i] = ((pp - pm) - (mp - mm)) / (4.0 * step[i] * step[j])
        # What the rounding of the values alone can make is no curvature.
        curvature[np.abs(curvature) * np.outer(step, step) < 8.0 * _EPSILON * np.max(np.abs(values))] = 0.0
        found[name] = Slopes(float(values[0]), gradient, curvature)
    return found, len(at)


def local_output(name: str, unit: str | None, joint: Joint, slope: Slopes, second: bool) -> Local:
    """An output by its derivatives: of first order, or with the curvature too."""
    value, gradient, curvature = slope
    # Counted in the largest of them, so that no square leaves the range of floats.
    scale = max(float(np.max(np.abs(gradient))), float(np.max(np.abs(curvature))) if second else 0.0) or 1.0
    gradient, curvature = gradient / scale, curvature / scale
    correlated = joint.correlations()
    skewness = np.array([joint.inputs[key].skewness for key in joint.names])
    # What the fourth moments have beyond those of a normal, whose own part is in the trace.
    excess = np.array([joint.inputs[key].kurtosis for key in joint.names]) - 3.0
    linear = float(gradient @ correlated @ gradient)
    third = float(np.sum(skewness * gradient**3))
    bend, variance = 0.0, linear
    own = np.zeros_like(gradient)
    if second:
        bent = curvature @ correlated
        diagonal = np.diag(curvature)
        bend = 0.5 * float(np.trace(bent))
        own = gradient * diagonal * skewness + 0.25 * diagonal**2 * excess
        third += 1.5 * float(np.sum(gradient**2 * diagonal * excess))
        variance += 0.5 * float(np.trace(bent @ bent)) + float(np.sum(own))
        third += 3.0 * float(gradient @ correlated @ curvature @ correlated @ gradient) + float(np.trace(bent @ bent @ bent))
    variance = max(variance, 0.0)
    std = math.sqrt(variance)
    # The skewness of the inputs stays out of a first-order answer: it is known only as mean and standard deviation.
    skew = third / std**3 if second and std > 0.0 else 0.0
    where = {key: i for i, key in enumerate(joint.names)}
    first, total = {}, {}
    for group in joint.groups:
        rows = [where[key] for key in group]
        part = correlated[np.ix_(rows, rows)]
        inner = curvature[np.ix_(rows, rows)] @ part if second else np.zeros((len(rows), len(rows)))
        across = [i for i in range(len(gradient)) if i not in rows]
        mixed = curvature[np.ix_(rows, across)] if second else np.zeros((len(rows), len(across)))
        beyond = float(np.trace(part @ mixed @ correlated[np.ix_(across, across)] @ mixed.T))
        alone = float(gradient[rows] @ part @ gradient[rows]) + 0.5 * float(np.trace(inner @ inner)) + float(np.sum(own[rows]))
        first[label(group)] = alone / variance if variance else math.nan
        total[label(group)] = (alone + beyond) / variance if variance else math.nan
    mean, std = value + scale * bend, scale * std
    if not (math.isfinite(mean) and math.isfinite(std)):
        raise NoSolutionError(
            f"{name!r} or its derivatives are too large for a float64; look for a wrong unit or a slipped digit",
            code="out_of_range",
            output=name,
        )
    unknown = dict.fromkeys(first, math.nan)
    found = {name: Shares(first, total, unknown, unknown)}
    return Local(name, unit, mean, std, skew, lambda: found)


def differences(model: Model, joint: Joint, design: Design, outputs: dict[str, Local]) -> tuple[dict[str, float], int, int]:
    """By how many standard deviations local figures differ from the model at points drawn from the inputs, if by too many.

    Also how many points that took, and at how many of them there was no answer.
    """
    points = design(0, _PROBES).reshape(joint.dimensions, -1)[:, :_PROBES]
    answers = model(joint.values(points), _PROBES)
    ends = np.array([0.025, 0.975])
    worst: dict[str, float] = {}
    failed = np.zeros(_PROBES, dtype=bool)
    for name, values in answers.items():
        refused = np.isnan(values)
        failed |= refused
        local, values = outputs[name], values[~refused]
        if local.unit == "rad":
            values = angles.beside(values, local.mean)
        if len(values) < 2:
            worst[name] = math.inf
            continue
        sampled = deviation(values)
        away = [average(values) - local.mean, sampled - local.std]
        away += list(np.quantile(values, ends) - local.quantile(ends))
        scale = max(local.std, sampled)
        most = float(max(map(abs, away)))
        differs = most > max(_NO_DIFFERENCE * float(np.max(np.abs(values))), _LEAST)
        worst[name] = (most / scale if scale else math.inf) if differs else 0.0
    return {name: by for name, by in worst.items() if by > _NOTICED}, _PROBES, int(np.count_nonzero(failed))


def _step(support: tuple[float, float], mean: float, sd: float) -> float:
    """The step in standard deviations, both of whose doubles stay among the values the input can take."""
    room = min(mean - support[0], support[1] - mean) / sd
    return min(max(_STEP, _LEAST_STEP * _EPSILON * abs(mean) / sd), 0.25 * room)
