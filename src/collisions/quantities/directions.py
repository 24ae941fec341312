"""Directions in the road plane: unit vectors from an angle or a vector, and the angle
of a vector.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ..kernels.elementwise import select
from ..messages.errors import InputError, ShapeError
from ..messages.marked import a_type_of
from .reading import ArgumentReader, broadcast, widened
from .refusals import must_be
from .units import Value


class Angle(NamedTuple):
    """An angle as it was given: in degrees, which can be reduced exactly, or in radians."""

    value: Any
    in_degrees: bool

    def beside(self, values: Iterable[Any]) -> Angle:
        """The same angle, widened to float64 if it or any of these values needs that."""
        return self._replace(value=widened((self.value,), values)[0])

    @property
    def radians(self) -> Any:
        """The angle in radians; degrees of many turns within one, which loses nothing of them."""
        if not self.in_degrees:
            return np.asarray(self.value)
        with np.errstate(invalid="ignore"):
            many = np.greater(np.abs(self.value), 360.0 * _MANY_TURNS)
            degrees = np.where(many, np.fmod(self.value, 360.0), self.value)
        return np.multiply(degrees, math.pi / 180.0)

    @property
    def within_turns(self) -> Any:
        """The angle in radians, within a turn where it is of so many that a difference from it
        would lose its direction.
        """
        radians = self.radians
        with np.errstate(invalid="ignore"):
            many = np.greater(np.abs(radians), math.tau * _MANY_TURNS)
            return np.where(many, np.arctan2(np.sin(radians), np.cos(radians)), radians)

    @property
    def direction(self) -> tuple[Any, Any]:
        """Unit vector in the direction of the angle."""
        return from_degrees(self.value) if self.in_degrees else from_radians(self.value)

    def to(self, other: Angle) -> tuple[Any, Any]:
        """Cosine and sine of the angle from here to the other, from their difference: exact for
        nearly equal courses.
        """
        if self.in_degrees and other.in_degrees:
            return from_degrees(np.fmod(other.value, 360.0) - np.fmod(self.value, 360.0))
        with np.errstate(over="ignore"):
            return from_radians(np.asarray(other.within_turns - self.within_turns))


# Turns up to which the rounding of an angle counts for nothing in its direction.
_MANY_TURNS = 1000.0

# A vector whose length is this close to 1 is taken as it is, so that a unit vector read from a
# result stays the same bits.
_UNIT_LENGTH = 2.0**-52


def direction(
    reader: ArgumentReader, value: Any, argument: str, beside: Iterable[Any] = ()
) -> tuple[Any, Any]:
    """Unit vector from an angle (number, text, Quantity or array) or from a tuple of two
    components.

    A float32 angle is widened to float64 if any value in ``beside`` is float64.
    """
    if isinstance(value, tuple):
        if len(value) != 2:
            problem = must_be(
                argument,
                "an angle or `|a tuple|a list` `(x, y)`",
                value,
                code="bad_shape",
                kind=ShapeError,
                got=f"{len(value)} components",
            )
            return reader.refuse(problem), math.nan
        count = len(reader.problems)
        vx, vy = reader.pair(value, "", argument)
        try:
            broadcast({f"{argument}[0]": vx, f"{argument}[1]": vy})
        except ShapeError as unlike:
            reader.refuse(unlike)
        if len(reader.problems) > count:
            return math.nan, math.nan
        vx, vy = widened((vx, vy), beside)
        return normalised(reader, vx, vy, argument)
    if isinstance(value, list):
        text = (
            f"{argument} is a list, which could be a vector or several angles: write the "
            "tuple `(nx, ny)` for a vector, np.array([...]) for angles"
        )
        return reader.refuse(ShapeError(text, code="bad_shape", argument=argument)), math.nan
    return Angle(*reader.angle(value, argument)).beside(beside).direction


def course(reader: ArgumentReader, value: Any, argument: str) -> Angle:
    """The angle of a course or a heading (number, text, Quantity or array); a vector is refused."""
    if isinstance(value, (tuple, list)):
        kind = argument.partition("_")[0]
        text = (
            f"{argument} is {a_type_of(value)}, and a {kind} is an angle"
            "`|; many angles go in a numpy array|`"
        )
        return Angle(reader.refuse(ShapeError(text, code="bad_shape", argument=argument)), False)
    return Angle(*reader.angle(value, argument))


def normalised(reader: ArgumentReader, vx: Any, vy: Any, argument: str) -> tuple[Any, Any]:
    """The vector divided by its length; cases of length 0 stay (0, 0), a single vector of length 0
    is refused.
    """
    if isinstance(vx, float) and isinstance(vy, float):
        # Scaled first: the length of a vector of 1e308 would overflow, that of one of 5e-324 loses
        # all its digits.
        scale = max(abs(vx), abs(vy))
        if scale == 0.0:
            text = f"{argument} has no length: `(0, 0)`; give the direction it points in"
            return reader.refuse(InputError(text, code="zero_normal", argument=argument)), math.nan
        length = math.hypot(vx, vy)
        if abs(length - 1.0) <= _UNIT_LENGTH:
            return vx, vy
        if not 1e-150 < scale < 1e150:
            exponent = -math.frexp(scale)[1]
            vx, vy = math.ldexp(vx, exponent), math.ldexp(vy, exponent)
            length = math.hypot(vx, vy)
        return vx / length, vy / length
    with np.errstate(all="ignore"):
        exponent = -np.frexp(np.maximum(abs(vx), abs(vy)))[1]
        length = np.hypot(vx, vy)
        scaled_x, scaled_y = np.ldexp(vx, exponent), np.ldexp(vy, exponent)
        scaled_length = np.hypot(scaled_x, scaled_y)
        divisor = np.where(scaled_length == 0.0, 1.0, scaled_length).astype(scaled_length.dtype)
        keep = abs(length - 1.0) <= np.finfo(length.dtype).eps
        # A part that is not finite makes the whole vector NaN.
        finite = np.where(np.isfinite(vx) & np.isfinite(vy), 0.0, np.nan).astype(length.dtype)
        return np.where(keep, vx, scaled_x / divisor) + finite, np.where(
            keep, vy, scaled_y / divisor
        ) + finite


def angle_of(x: Any, y: Any) -> Value:
    """Direction of a vector [rad] in (-pi, pi]; NaN without a length."""
    atan2: Any = math.atan2 if isinstance(x, float) and isinstance(y, float) else np.arctan2
    angle = atan2(y, x)
    # A vector that points straight back but for the last bit, or for the sign of a 0, has the angle
    # pi.
    back = angle <= -math.pi
    if getattr(angle, "dtype", None) == np.float32:
        # Some processors round such an angle of float32 to the next number; its vector tells it all
        # the same.
        back = back | ((angle < -3.0) & (abs(y) <= float(np.finfo(np.float32).eps) * abs(x)))
        angle = np.where(back, np.float32(-math.pi), angle)
    angle = select(back, -angle, angle)
    # Adding 0 turns the -0 of a 0 into 0.
    found: Value = select((x == 0.0) & (y == 0.0), math.nan, angle + 0.0)
    return found


def from_radians(angle: Any) -> tuple[Any, Any]:
    """Cosine and sine of an angle in radians."""
    if isinstance(angle, float):
        return (math.cos(angle), math.sin(angle)) if math.isfinite(angle) else (math.nan, math.nan)
    with np.errstate(invalid="ignore"):
        # An operand of a recording has no shape.
        if not isinstance(angle, np.ndarray) or angle.dtype != np.float64 or not angle.ndim:
            return np.cos(angle), np.sin(angle)
        # From the tangent of half the angle: a tenth of the time, and off by 1.2 eps at most.
        tangent = 0.5 * angle
        np.tan(tangent, out=tangent)
        share = tangent * tangent
        cosine = 1.0 - share
        share += 1.0
        cosine /= share
        tangent += tangent
        tangent /= share
        return cosine, tangent


def from_degrees(degrees: Any) -> tuple[Any, Any]:
    """Cosine and sine of an angle in degrees, exact at the quarter turns and accurate near them.

    Whole turns and the nearest quarter turn are taken off first, which rounds nothing; only the
    rest is converted.
    """
    xp: Any = math if isinstance(degrees, float) else np
    with np.errstate(invalid="ignore"):
        turn = xp.fmod(degrees, 360.0)
        quarters = xp.floor(turn / 90.0 + 0.5)
        rest = (turn - 90.0 * quarters) * (math.pi / 180.0)
        c, s = xp.cos(rest), xp.sin(rest)
        # cos and sin of the quarter turns themselves: 0, 1 or -1.
        qc = abs(quarters % 4.0 - 2.0) - 1.0
        qs = abs((quarters + 3.0) % 4.0 - 2.0) - 1.0
        return c * qc - s * qs + 0.0, s * qc + c * qs + 0.0
