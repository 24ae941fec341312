"""The spring pulse: an assumed shape of the contact force over time, where one is needed.

The force is largest when compression ends, as in figure 3 of "Application of Impulse Momentum Theory to Vehicle Collisions". It
rises as that of a linear spring, a quarter of a sine, and falls as that of a stiffer one, another quarter, which takes
restitution times as long. Whatever the restitution, its peak is pi/2 times its mean. ``share`` is of the duration.
"""

from __future__ import annotations

import math
from typing import Any

from .kernels.elementwise import safe_divisor, select
from .quantities import numeric

_QUARTER = 0.5 * math.pi


def rise(share: Any) -> Any:
    """Force over its peak at a share of the compression time; restitution runs the curve backwards."""
    return numeric(share).sin(_QUARTER * share)


def compression_time(e: Any) -> Any:
    """Share of the duration after which compression ends."""
    return 1.0 / (1.0 + e)


def passed(e: Any, share: float) -> Any:
    """Share of the impulse that has been transmitted at a share of the duration."""
    xp = numeric(e)
    phase = share * (1.0 + e)
    compressing = 1.0 - xp.cos(_QUARTER * phase)
    # 0 before restitution begins: divided by a tiny restitution it would be infinite, which has no sine.
    late = select(phase <= 1.0, 0.0, phase - 1.0)
    restoring = 1.0 + e * xp.sin(_QUARTER * (late / safe_divisor(True, e)))
    return select(phase <= 1.0, compressing, restoring) / (1.0 + e)


def mean_passed(e: Any) -> Any:
    """Mean of ``passed`` over the duration."""
    return (1.0 - (1.0 - e) / _QUARTER) / (1.0 + e)


def mean_square_passed(e: Any) -> Any:
    """Mean of the square of ``passed`` over the duration."""
    return (1.5 - 2.0 / _QUARTER + e * (1.0 + e * (2.0 / _QUARTER + 0.5 * e))) / (1.0 + e) ** 3


def greatest_crush(e: Any) -> Any:
    """Greatest mutual crush, over closing speed times duration."""
    return compression_time(e) / _QUARTER
