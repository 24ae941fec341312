"""What makes a case unfit to be answered: conditions on floats or arrays, each true where the case must be refused."""

from math import inf, isfinite
from typing import Any

import numpy as np

from .codes import EPS
from .turning import turning_velocity


def not_finite(value: Any) -> Any:
    """NaN or infinite."""
    return value - value != 0.0


def not_a_number(value: Any) -> Any:
    """NaN."""
    return value != value


def not_positive(value: Any) -> Any:
    """Zero or below."""
    return value <= 0.0


def negative(value: Any) -> Any:
    """Below zero, or NaN."""
    return (value < 0.0) | (value != value)


def outside_unit_interval(value: Any) -> Any:
    """Below 0, above 1, or NaN."""
    return (value < 0.0) | (value > 1.0) | (value != value)


def without_length(nx: Any, ny: Any) -> Any:
    """A vector of length 0."""
    return (nx == 0.0) & (ny == 0.0)


def either_infinite(mass: Any, inertia: Any = 0.0) -> Any:
    """A mass or, where it is known, a yaw inertia that is infinite."""
    return (mass == inf) | (inertia == inf)


def not_about_pivot(vx: Any, vy: Any, yaw_rate: Any, x: Any, y: Any, pivot_x: Any, pivot_y: Any, eps: float = EPS) -> Any:
    """A velocity that is not yaw rate times arm to 1e-9 (or to the rounding of a coarser precision)."""
    wanted_x, wanted_y = turning_velocity(yaw_rate, x, y, pivot_x, pivot_y)
    tolerance = max(1e-9, 8.0 * eps)
    return abs(vx - wanted_x) + abs(vy - wanted_y) > tolerance * (abs(wanted_x) + abs(wanted_y))


def rounding(eps: float, *values: Any) -> float:
    """The coarser of ``eps`` and the rounding of the arrays among the values."""
    return max(eps, *(float(np.finfo(value.dtype).eps) if isinstance(value, np.ndarray) else EPS for value in values))


def all_finite(values: Any) -> bool:
    """Whether an array holds finite numbers only, whose sum is finite too: a single reading."""
    return isfinite(np.add.reduce(values))


def all_positive(values: Any) -> bool:
    """Whether all of an array is above zero; the least of an array with NaN is NaN."""
    return bool(np.minimum.reduce(values) > 0.0)


def all_not_negative(values: Any) -> bool:
    """Whether all of an array is zero or above."""
    return bool(np.minimum.reduce(values) >= 0.0)


def all_in_unit_interval(values: Any) -> bool:
    """Whether all of an array is from 0 to 1."""
    return bool(np.minimum.reduce(values) >= 0.0 and np.maximum.reduce(values) <= 1.0)


def all_with_length(nx: Any, ny: Any) -> bool:
    """Whether no vector of an array has length 0."""
    return np.count_nonzero(nx) == np.size(nx) or not np.any(without_length(nx, ny))
