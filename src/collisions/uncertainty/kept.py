"""What a truncation keeps of a normal distribution: how much, and the moments and quantiles of what is kept.

Everything is counted from an anchor, the most likely of the kept values, in standard deviations of the whole. From there the
density falls as exp(-t (t + 2 m) / 2), m the score of the anchor, which neither underflows nor cancels however far out in a
tail, or however narrow, the kept range is. The moments are integrals of this density over the kept range by Gauss-Legendre
quadrature, whose terms all have one sign; the closed forms are differences of nearly equal numbers there.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from .normal import density, power_of_two, quantile

# Positive nodes of the Gauss-Legendre rule of 12 points and their weights: numpy's come from eigenvalues, which leaves the
# weights 40 roundings off and the last digits to the machine.
_POSITIVE = (
    0.9815606342467192,
    0.9041172563704749,
    0.7699026741943047,
    0.5873179542866175,
    0.3678314989981802,
    0.1252334085114689,
)
_WEIGHTS = (
    0.04717533638651183,
    0.10693932599531843,
    0.16007832854334622,
    0.20316742672306592,
    0.2334925365383548,
    0.24914704581340277,
)
_NODES = np.array((*_POSITIVE, *(-x for x in _POSITIVE)))
_PANELS = 2.0  # to a standard deviation
_NEGLIGIBLE = 55.0  # beyond exp(-55) of its peak an integrand is nothing beside 1e-16


class Moments(NamedTuple):
    """The share kept, and the moments of what is kept."""

    share: float
    mean: float
    sd: float
    skewness: float
    kurtosis: float


def moments(anchor: float, low: float, high: float, steepness: float = 0.0) -> Moments:
    """Moments of t between low <= 0 and high >= 0 from the anchor's score, or of exp(steepness t) - 1 if steepness > 0."""
    # The fourth power of exp(steepness t) has its peak this much further up.
    tilt = 4.0 * steepness
    start = max(low, -_reach(anchor))
    end = min(high, max(0.0, tilt - anchor) + _reach(max(0.0, anchor - tilt)))
    panels = max(1, math.ceil(max(_PANELS, steepness) * (end - start)))
    half = 0.5 * (end - start) / panels
    t = (start + half * (2.0 * np.arange(panels)[:, None] + 1.0 + _NODES)).reshape(-1)
    weighted = np.tile(_WEIGHTS, 2 * panels) * (half * np.exp(-0.5 * t * (t + 2.0 * anchor)))
    with np.errstate(all="ignore"):
        value = np.expm1(steepness * t) if steepness else t
        scale = power_of_two(value)
        value = value / scale
        total = float(np.sum(weighted))
        mean = float(np.sum(weighted * value)) / total
        away = value - mean
        sd = math.sqrt(float(np.sum(weighted * away**2)) / total)
        away /= sd
        third, fourth = (float(np.sum(weighted * away**power)) / total for power in (3, 4))
    return Moments(float(density(anchor)) * total, scale * mean, scale * sd, third, fourth)


def kept_score(below: Any, above: Any, lost_below: float, share: float, lost_above: float) -> Any:
    """The score in the whole distribution of what has the shares ``below`` and ``above`` of the kept part on its sides.

    Both come in, and the smaller side decides, so that nothing is lost near either end.
    """
    lower, upper = lost_below + below * share, lost_above + above * share
    if not isinstance(lower, np.ndarray):
        return quantile(lower) if lower <= upper else -quantile(upper)
    score = quantile(np.minimum(lower, upper))
    return np.where(lower <= upper, score, -score)


def _reach(score: float) -> float:
    """How far from a score on, away from the centre, the density is more than negligible beside that at the score."""
    return 2.0 * _NEGLIGIBLE / (math.sqrt(score * score + 2.0 * _NEGLIGIBLE) + abs(score))
