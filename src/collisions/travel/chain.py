"""Speeds along a chain of surfaces, backward from its end, and the time they take."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..errors import CollisionsError, InputError, NoSolutionError
from ..kernels.elementwise import select
from ..quantities import hypot, numeric

GRAVITY = 9.80665
"""Standard gravity [m/s**2]. It varies by 0.5 % between the equator and the poles, speeds by half of that."""


def speeds_along(lengths: Sequence[Any], drops: Sequence[Any], end: Any, name: Callable[[int], str]) -> list[Any]:
    """Speed at every point, start to end; NaN in the lanes of arrays that contradict themselves."""
    speeds = [end]
    for i in range(len(lengths) - 1, -1, -1):
        after = speeds[-1]
        gained = root(2.0 * GRAVITY * abs(drops[i])) * root(lengths[i])
        # Downhill beyond the drag: the root of the difference of squares, without the squares that overflow.
        falling = root(after - gained) * root(after + gained)
        before = select(drops[i] >= 0.0, hypot(after, gained), falling)
        # A vehicle that nothing slows does not come to rest, unless it has not moved.
        before = select((drops[i] <= 0.0) & (after == 0.0) & (lengths[i] > 0.0), math.nan, before)
        if isinstance(before, float) and not math.isfinite(before):
            raise contradiction(name(i), drops[i], after, gained)
        speeds.append(before)
    return speeds[::-1]


def durations_along(lengths: Sequence[Any], grades: Sequence[Any], speeds: Sequence[Any]) -> list[Any]:
    """Time over each segment, along its slope: at a constant deceleration the mean speed is half the sum."""
    found = []
    for plan, grade, before, after in zip(lengths, grades, speeds, speeds[1:], strict=False):
        length = plan * numeric(grade).hypot(1.0, grade)
        double = before + after
        duration = 2.0 * length / select(double == 0.0, math.nan, double)
        # A speed beyond floats would make it 0, which looks like an answer.
        found.append(select(length == 0.0, 0.0, select(double == math.inf, math.inf, duration)))
    return found


def root(value: Any) -> Any:
    """Square root, NaN below 0."""
    if isinstance(value, float):
        return math.sqrt(value) if value >= 0.0 else math.nan
    return np.sqrt(value)


def contradiction(where: str, drop: float, after: float, gained: float) -> CollisionsError:
    """Why no speed before a segment leads to the speed after it."""
    if drop > 0.0 or math.isinf(gained):
        return out_of_range()
    if drop == 0.0:
        return NoSolutionError(
            f"{where}: drag + grade is 0, so nothing slows the vehicle there, and it is to come to rest; correct "
            f"what slows it, or give an end_speed",
            code="contradictory",
            missing=0.0,
        )
    missing = (after - gained) * (after + gained)
    return NoSolutionError(
        f"{where}: drag + grade is {drop:.6g}, so the vehicle speeds up there, from rest already to {gained:.6g} m/s, and is "
        f"to end at {after:.6g} m/s; the square of its speed before would be {missing:.6g} m2/s2. Correct the sign of the "
        f"grade, the drag, or the end_speed",
        code="contradictory",
        missing=missing,
    )


def out_of_range() -> InputError:
    """The refusal of a single case whose answer is no finite number."""
    return InputError(
        "the answer is not a finite number: the arguments are too large or too small for floats", code="out_of_range"
    )
