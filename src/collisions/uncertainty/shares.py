"""How much of the variance each input brings: asked of the model by drawing one input anew while the others stay.

First-order shares by the estimator of A. Saltelli et al., "Variance based sensitivity analysis of model output", Computer
Physics Communications 181 (2010), total shares by that of M. J. W. Jansen, "Analysis of variance designs for model output",
Computer Physics Communications 117 (1999).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from . import angles
from .designs import REPLICATES, Design
from .draw import Joint
from .model import Model
from .output import Shares, average, deviation


def label(group: Sequence[str]) -> str:
    """What the share of inputs that go together is called by."""
    return " & ".join(group)


def sampled_shares(model: Model, joint: Joint, design: Callable[[int], Design], samples: int) -> dict[str, Shares]:
    """Shares of every output, from ``samples`` cases for each input and two more times as many."""
    places = -(-samples // REPLICATES)
    points = design(2 * joint.dimensions)(0, places).reshape(2 * joint.dimensions, -1)
    one, other = points[: joint.dimensions], points[joint.dimensions :]

    designs = [one, other]
    for group in joint.groups:
        mixed = one.copy()
        mixed[joint.rows[group]] = other[joint.rows[group]]
        designs.append(mixed)
    with np.errstate(all="ignore"):
        answers = [model(joint.values(rows), rows.shape[1]) for rows in designs]
    labels = [label(group) for group in joint.groups]
    found: dict[str, Shares] = {}
    for name, unit in model.units.items():
        values = np.array([answer[name] for answer in answers])
        if unit == "rad":
            values = angles.counted(values.reshape(-1)).reshape(values.shape)
        shares = [_shares(values[0], values[1], mixed) for mixed in values[2:]]
        found[name] = Shares(*(dict(zip(labels, figures, strict=True)) for figures in zip(*shares, strict=True)))
    return found


def _shares(one: Any, other: Any, mixed: Any) -> tuple[float, ...]:
    """First-order and total share, and their standard errors, over the cases where all three have an answer."""
    answered = ~np.isnan(one + other + mixed)

    def figures(chosen: Any) -> tuple[float, float]:
        a, b, c = one[chosen], other[chosen], mixed[chosen]
        if len(a) < 2:
            return math.nan, math.nan
        both = np.concatenate((a, b))
        # In its own deviations, whose squares leave no range of floats.
        middle, scale = average(both), deviation(both)
        if not scale > 0.0:
            return math.nan, math.nan
        a, b, c, both = ((part - middle) / scale for part in (a, b, c, both))
        variance = float(np.var(both))
        # The mean taken away first: the estimator is free of it, its scatter is not.
        first = float(np.mean((b - both.mean()) * (c - a)))
        total = 0.5 * float(np.mean((a - c) ** 2))
        return (first / variance, total / variance) if variance > 0.0 else (math.nan, math.nan)

    sequence = np.arange(one.size) % REPLICATES
    with np.errstate(all="ignore"):
        first, total = figures(answered)
        apart = np.array([figures(answered & (sequence == which)) for which in range(REPLICATES)])
        errors = np.std(apart, axis=0, ddof=1) / math.sqrt(REPLICATES)
    return first, total, float(errors[0]), float(errors[1])
