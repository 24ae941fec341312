"""``select``, vector conditions that work on floats and arrays alike, and the domains of the inputs
(``Domain``).
"""

from collections.abc import Callable
from math import inf, isfinite
from typing import Any, NamedTuple

import numpy as np

from .status import EPS, Status


def select(condition: Any, yes: Any, no: Any) -> Any:
    """``yes`` where the condition holds, ``no`` elsewhere; both have been worked out already."""
    if condition is True:
        return yes
    if condition is False:
        return no
    if type(condition) is np.ndarray:
        # Of numpy, whatever the others are: said first, since batches come here most.
        return np.where(condition, yes, no)
    xp = library(condition, yes, no)
    if xp is not np:
        yes, no = (
            xp.asarray(int(value)) if isinstance(value, Status) else value for value in (yes, no)
        )
        yes = xp.asarray(yes) if isinstance(yes, float) and isinstance(no, float) else yes
    return xp.where(condition, yes, no)


def library(*values: Any) -> Any:
    """The array library of these values: numpy, unless one of them is an array of another, as of
    JAX.
    """
    for value in values:
        if (named := getattr(value, "__array_namespace__", None)) is not None:
            return named()
    return np


def larger(one: Any, other: Any) -> Any:
    """The larger of the two; NaN only if both are."""
    if isinstance(one, float) and isinstance(other, float):
        return one if one >= other or other != other else other
    xp = library(one, other)
    return (
        np.fmax(one, other) if xp is np else xp.where((one >= other) | (other != other), one, other)
    )


def least(one: Any, other: Any) -> Any:
    """The smaller of the two; of arrays of numpy in one step."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return np.minimum(one, other)
    return select(one < other, one, other)


def greatest(one: Any, other: Any) -> Any:
    """The larger of the two; of arrays of numpy in one step."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return np.maximum(one, other)
    return select(one > other, one, other)


def within(value: Any, most: Any) -> Any:
    """The value, but from ``-most`` to ``most``."""
    return greatest(-most, least(most, value))


def share_of(part: Any, whole: Any) -> Any:
    """The part of a whole, both not negative, but 1 at most; 1 of none."""
    if isinstance(part, np.ndarray) or isinstance(whole, np.ndarray):
        # 0 over 0 is no number, which ``fmin`` passes over.
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.fmin(part / whole, 1.0)
    less = part < whole
    return select(less, part, 1.0) / select(less, whole, 1.0)


def safe_divisor(usable: Any, value: Any) -> Any:
    """``value``, or 1.0 where the quotient is discarded (Python floats raise on
    division by zero).
    """
    return 1.0 if usable is False or (isinstance(value, float) and value == 0.0) else value


def first_status(*findings: tuple[Any, Status]) -> Any:
    """Status of the first condition that holds, OK if none does."""
    status: Any = Status.OK
    for condition, code in reversed(findings):
        if condition is not False:
            status = select(condition, code, status)
    return status


def all_zero(*values: Any) -> bool:
    """Whether all of these are the plain number 0, so that what depends on them alone need not be
    worked out.
    """
    return all(type(value) is float and value == 0.0 for value in values)


def more_digits(
    known: tuple[Any, Any], closing: Any, slip: Any, speeds: Any, eps: float
) -> tuple[Any, Any]:
    """The ``known`` closing speed and slip where they equal the computed ones to the rounding of
    ``speeds``, else those.
    """
    exact_closing, exact_slip = known
    scale = speeds + abs(exact_closing) + abs(exact_slip)
    same = abs(exact_closing - closing) + abs(exact_slip - slip) <= 64.0 * eps * scale
    return select(same, exact_closing, closing), select(same, exact_slip, slip)


def turning_velocity(
    yaw_rate: Any, x: Any, y: Any, center_x: Any, center_y: Any
) -> tuple[Any, Any]:
    """Velocity at (x, y) of a body that turns about the centre: the arm turned by +90 degrees,
    times the yaw rate.
    """
    return -yaw_rate * (y - center_y), yaw_rate * (x - center_x)


def without_length(nx: Any, ny: Any) -> Any:
    """Whether the vector has length 0."""
    return (nx == 0.0) & (ny == 0.0)


def all_with_length(nx: Any, ny: Any) -> bool:
    """Whether no vector of an array has length 0."""
    return np.count_nonzero(nx) == np.size(nx) or not np.any(without_length(nx, ny))


def either_infinite(mass: Any, inertia: Any = 0.0) -> Any:
    """Whether the mass or the yaw inertia is infinite."""
    return (mass == inf) | (inertia == inf)


def rounding(eps: float, *values: Any) -> float:
    """The coarser of ``eps`` and the rounding of the arrays among the values."""
    return max(
        eps,
        *(
            float(np.finfo(value.dtype).eps) if isinstance(value, np.ndarray) else EPS
            for value in values
        ),
    )


def not_about_pivot(
    vx: Any, vy: Any, yaw_rate: Any, x: Any, y: Any, pivot_x: Any, pivot_y: Any, eps: float = EPS
) -> Any:
    """Whether a velocity is not yaw rate times arm, to 1e-9 (or to the rounding of a coarser
    precision).
    """
    wanted_x, wanted_y = turning_velocity(yaw_rate, x, y, pivot_x, pivot_y)
    tolerance = max(1e-9, 8.0 * eps)
    return abs(vx - wanted_x) + abs(vy - wanted_y) > tolerance * (abs(wanted_x) + abs(wanted_y))


class Domain(NamedTuple):
    """The set of values that an argument may have.

    ``faults`` has conditions for values outside, each with its status; ``holds`` is a cheaper test
    of a whole array, which may be False although every value is inside.
    """

    name: str
    faults: tuple[tuple[Callable[[Any], Any], Status], ...]
    holds: Callable[[Any], bool]


FINITE = Domain(
    "finite",
    ((lambda value: value - value != 0.0, Status.NOT_FINITE),),
    # The sum is finite only if every number is: a single reading.
    lambda values: isfinite(np.add.reduce(values)),
)
# A tangential impulse so many times the normal one leaves none of that as a number.
RATIO = Domain(
    "from -1e100 to 1e100",
    (*FINITE.faults, (lambda value: abs(value) > 1e100, Status.OUT_OF_RANGE)),
    lambda values: bool(np.minimum.reduce(values) >= -1e100 and np.maximum.reduce(values) <= 1e100),
)
POSITIVE = Domain(
    "positive",
    (
        (lambda value: value != value, Status.NOT_FINITE),
        (lambda value: value <= 0.0, Status.NOT_POSITIVE),
    ),
    # The least of an array with NaN is NaN.
    lambda values: bool(np.minimum.reduce(values) > 0.0),
)
NOT_NEGATIVE = Domain(
    "not negative",
    ((lambda value: (value < 0.0) | (value != value), Status.BAD_FRICTION),),
    lambda values: bool(np.minimum.reduce(values) >= 0.0),
)
POSITIVE_FINITE = Domain(
    "positive and finite", (*POSITIVE.faults, *FINITE.faults), lambda values: False
)
AT_LEAST_ZERO = Domain(
    "at least 0 and finite",
    (*FINITE.faults, (lambda value: value < 0.0, Status.NEGATIVE_SIZE)),
    lambda values: False,
)
UNIT_INTERVAL = Domain(
    "unit interval",
    ((lambda value: (value < 0.0) | (value > 1.0) | (value != value), Status.BAD_FRACTION),),
    lambda values: bool(np.minimum.reduce(values) >= 0.0 and np.maximum.reduce(values) <= 1.0),
)
UNCHECKED = Domain("unchecked", (), lambda values: True)
# Above -1: below 0 an incomplete impact, whose contact ends before a common velocity.
INCOMPLETE = Domain(
    "incomplete restitution",
    ((lambda value: (value <= -1.0) | (value > 1.0) | (value != value), Status.BAD_RESTITUTION),),
    lambda values: bool(np.minimum.reduce(values) > -1.0 and np.maximum.reduce(values) <= 1.0),
)
RESTITUTION = UNIT_INTERVAL._replace(
    name="restitution", faults=((UNIT_INTERVAL.faults[0][0], Status.BAD_RESTITUTION),)
)


def restitution_domain(incomplete: Any) -> Domain:
    """The restitutions that a solver takes, with its option ``incomplete`` as given."""
    return INCOMPLETE if incomplete is True else RESTITUTION
