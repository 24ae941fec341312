"""First- and second-order propagation: derivatives at the mean of the inputs, and a test of whether
they suffice.

First order is the law of propagation of uncertainty of the "Guide to the expression of uncertainty
in measurement" (JCGM 100:2008, eq 13); second order adds the curvature, and is exact where the
model is quadratic in independent or normal inputs. Neither knows of a friction limit or a refusal
away from the mean, so the model is also evaluated at points drawn from the inputs, and the two are
compared.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np

from ..messages.errors import NoSolutionError
from . import normal
from . import turns as angles
from .model import Model, count_failed
from .output import Output, Shares
from .sampled import average, deviation
from .sampling import Joint

# A step in standard deviations: the differences below err by its fourth power and by rounding
# over its square.
_STEP = 0.01
_LEAST_STEP = 1e6  # roundings of the mean, so that the step itself is known to a millionth
_EPSILON = float(np.finfo(np.float64).eps)
_ROUNDING = 64.0 * _EPSILON / _STEP  # of a slope over a step
_LEAST = float(np.finfo(np.float64).tiny)  # below, floats have few digits
PROBES = 4096  # cases drawn from the inputs
_NOTICED = (
    0.1  # standard deviations by which a local figure may differ at the probes without a warning
)
# Relative change of the slope within the steps, beyond the effect of curvature, that is a kink or a
# jump. That of a smooth model is a millionth of its fourth derivative.
_KINK = 0.01
_NO_DIFFERENCE = 1e-12  # of the values: differences this small are rounding


class Local(Output):
    """An output propagated by derivatives at the mean of the inputs: normal quantiles, with
    skewness if known.
    """

    def __init__(
        self, name: str, unit: str | None, mean: float, std: float, skewness: float, shares: Shares
    ) -> None:
        super().__init__(name, unit)
        self._figures = mean, std
        self.skewness = skewness
        self._known_shares = shares

    def turned(self, turns: float) -> Local:
        """The same direction plus this many turns."""
        mean, std = self._figures
        return (
            Local(
                self.name,
                self.unit,
                mean + math.tau * turns,
                std,
                self.skewness,
                self._known_shares,
            )
            if turns
            else self
        )

    def _mean(self) -> Any:
        return self._figures[0]

    def _std(self) -> Any:
        return self._figures[1]

    def _quantile(self, p: Any) -> Any:
        mean, std = self._figures
        if std == 0.0:
            return mean + 0.0 * p
        z = normal.quantile(p)
        if self.skewness:
            # Cornish and Fisher's first term, which shifts the quantiles of a skew distribution, as
            # far as it rises.
            turn = -3.0 / self.skewness
            z = np.maximum(z, turn) if self.skewness > 0.0 else np.minimum(z, turn)
            with np.errstate(invalid="ignore"):
                z = np.where(np.isinf(z), z, z + (z * z - 1.0) * (self.skewness / 6.0))
        # Beyond the greatest float it is infinite.
        with np.errstate(over="ignore"):
            found = mean + std * z
        return found if np.ndim(found) else float(found)

    def _shares(self) -> Shares:
        return self._known_shares


# Value, gradient and second derivatives of an output at the mean of the inputs, per standard
# deviation of each.
Slopes: TypeAlias = tuple[float, Any, Any]


def slopes(model: Model, joint: Joint, second: bool) -> tuple[dict[str, Slopes], int]:
    """Derivatives of every output by central differences, from one call of the model; and the
    number of cases it took.
    """
    inputs = joint.inputs.values()
    count = len(inputs)
    mean, sd = np.array([one.mean for one in inputs]), np.array([one.sd for one in inputs])
    # In standard deviations, both its doubles among the values the input can take.
    room = (
        np.array([min(one.mean - one.support[0], one.support[1] - one.mean) for one in inputs]) / sd
    )
    step = np.minimum(np.maximum(_STEP, _LEAST_STEP * _EPSILON * np.abs(mean) / sd), 0.25 * room)
    unit = np.eye(count)
    pairs = [(i, j) for i in range(count) for j in range(i)] if second else []
    rows = [np.zeros(count), *(k * unit[i] for i in range(count) for k in (-2, -1, 1, 2))]
    rows += [p * unit[i] + q * unit[j] for i, j in pairs for p in (-1, 1) for q in (-1, 1)]
    at = mean + np.array(rows) * (step * sd)
    answers = model(
        {name: np.ascontiguousarray(at[:, i]) for i, name in enumerate(joint.inputs)}, len(at)
    )
    found: dict[str, Slopes] = {}
    for name, values in answers.items():
        if np.isnan(values).any():
            raise NoSolutionError(
                f"the model has no answer for {name!r} at or beside the mean of the inputs, so "
                "it has no derivative there; take `method='quasi_random'`, which counts such "
                "cases",
                code="no_derivative",
                output=name,
            )
        if model.units[name] == "rad":
            values = angles.beside(values, float(values[0]))
        rounding = _EPSILON * float(np.max(np.abs(values)))
        two_below, below, above, two_above = (
            values[1 : 1 + 4 * count].reshape(count, 4) - values[0]
        ).T
        gradient = (8.0 * (above - below) - (two_above - two_below)) / (12.0 * step)
        change = np.abs((two_above + two_below) - 4.0 * (above + below))
        kinked = (change > 64.0 * rounding) & (
            change > _KINK * step * float(np.linalg.norm(gradient))
        )
        if kinked.any():
            raise NoSolutionError(
                f"the model has a bend or a jump in {name!r} at the mean of the inputs, along "
                f"{list(joint.inputs)[int(np.argmax(kinked))]!r}, so its derivatives there tell "
                "nothing of the spread; take `method='quasi_random'`",
                code="no_derivative",
                output=name,
            )
        curvature = np.diag((16.0 * (above + below) - (two_above + two_below)) / (12.0 * step**2))
        for (i, j), (mm, mp, pm, pp) in zip(
            pairs, values[1 + 4 * count :].reshape(-1, 4), strict=True
        ):
            curvature[i, j] = curvature[j, i] = ((pp - pm) - (mp - mm)) / (4.0 * step[i] * step[j])
        # A curvature that rounding of the values could make is taken as 0.
        curvature[np.abs(curvature) * np.outer(step, step) < 8.0 * rounding] = 0.0
        found[name] = float(values[0]), gradient, curvature
    return found, len(at)


def local_output(name: str, unit: str | None, joint: Joint, slope: Slopes, second: bool) -> Local:
    """The output propagated at first order, or with the curvature too."""
    value, gradient, curvature = slope
    # In units of the largest, so that no square overflows.
    scale = (
        max(float(np.max(np.abs(gradient))), float(np.max(np.abs(curvature))) if second else 0.0)
        or 1.0
    )
    gradient, curvature = (
        gradient / scale,
        curvature / scale if second else np.zeros_like(curvature),
    )
    inputs = joint.inputs.values()
    skewness = np.array([one.skewness for one in inputs])
    # Excess fourth moments; the part of a normal distribution is in the trace.
    excess = np.array([one.kurtosis for one in inputs]) - 3.0
    correlated = joint.correlations()
    product, diagonal = curvature @ correlated, np.diag(curvature)
    skewed = gradient * diagonal * skewness + 0.25 * diagonal**2 * excess
    variance = float(gradient @ correlated @ gradient)
    variance += 0.5 * float(np.trace(product @ product)) + float(np.sum(skewed))
    third = float(np.sum(skewness * gradient**3)) + 1.5 * float(
        np.sum(gradient**2 * diagonal * excess)
    )
    third += 3.0 * float(gradient @ correlated @ curvature @ correlated @ gradient) + float(
        np.trace(product @ product @ product)
    )
    variance = max(variance, 0.0)
    mean, std = value + scale * (0.5 * float(np.trace(product))), scale * math.sqrt(variance)
    if not (math.isfinite(mean) and math.isfinite(std)):
        raise NoSolutionError(
            f"{name!r} or its derivatives are too large for a float64; look for a wrong unit or "
            "a slipped digit",
            code="out_of_range",
            output=name,
        )
    first, total = {}, {}
    # What differs by the rounding of its derivatives alone has nothing to share.
    varies = std > _ROUNDING * abs(mean)
    order = {key: i for i, key in enumerate(joint.inputs)}
    for label, group in zip(joint.labels, joint.rows, strict=True):
        rows = [order[key] for key in group]
        others = [i for i in range(len(gradient)) if i not in rows]
        part, inner = (
            correlated[np.ix_(rows, rows)],
            curvature[np.ix_(rows, rows)] @ correlated[np.ix_(rows, rows)],
        )
        mixed = curvature[np.ix_(rows, others)]
        own = (
            float(gradient[rows] @ part @ gradient[rows])
            + 0.5 * float(np.trace(inner @ inner))
            + float(np.sum(skewed[rows]))
        )
        shared = float(np.trace(part @ mixed @ correlated[np.ix_(others, others)] @ mixed.T))
        first[label] = own / variance if varies else math.nan
        total[label] = (own + shared) / variance if varies else math.nan
    unknown = dict.fromkeys(first, math.nan)
    # The skewness of the inputs stays out of a first-order answer, which knows them only by mean
    # and standard deviation.
    skew = third / math.sqrt(variance) ** 3 if second and variance > 0.0 else 0.0
    return Local(name, unit, mean, std, skew, Shares(first, total, unknown, unknown))


def differences(
    model: Model, drawn: Mapping[str, Any], outputs: Mapping[str, Local]
) -> tuple[dict[str, float], int]:
    """Differences, in standard deviations, of the local figures from cases drawn from the inputs,
    where they are too large.

    Also the number of those cases without an answer.
    """
    answers = model(drawn, PROBES)
    ends = np.array([0.025, 0.975])
    found: dict[str, float] = {}
    for name, values in answers.items():
        local, values = outputs[name], values[~np.isnan(values)]
        if local.unit == "rad":
            values = angles.beside(values, local.mean)
        if len(values) < 2:
            found[name] = math.inf
            continue
        sampled = deviation(values)
        away = [
            average(values) - local.mean,
            sampled - local.std,
            *(np.quantile(values, ends) - local.quantile(ends)),
        ]
        most, scale = float(max(map(abs, away))), max(local.std, sampled)
        by = most / scale if scale else math.inf
        if by > _NOTICED and most > max(_NO_DIFFERENCE * float(np.max(np.abs(values))), _LEAST):
            found[name] = by
    return found, count_failed(answers)
