"""Gravity, and the drag of tyres as a fraction of it: how it is read, and the time that a contact
takes.
"""

from __future__ import annotations

import math
from typing import Any

from ..kernels.elementwise import FINITE, UNCHECKED, Domain
from ..messages.errors import ShapeError, UnitsError
from ..messages.marked import a_type_of
from ..quantities.reading import ArgumentReader, at_least_zero, warn_if_large
from ..quantities.refusals import must_be
from ..quantities.settings import Default
from ..quantities.units import is_quantity, shown

GRAVITY = 9.80665
"""Standard gravity [m/s**2]. It varies by 0.5 % between the equator and the poles, speeds by half
of that.
"""


def gravity_on(rises: tuple[Any, Any]) -> Any:
    """What presses on ground that rises so over the run along x and y [m/s**2]: gravity times the
    cosine of its angle.

    Times this, friction, a drag and the rise over the run itself are decelerations along the
    ground.
    """
    return GRAVITY / (1.0 + rises[0] * rises[0] + rises[1] * rises[1]) ** 0.5


def in_plan(rises: tuple[Any, Any], x: Any, y: Any) -> tuple[Any, Any]:
    """A way, or a velocity, along ground that rises so over the run, as it is seen in plan: shorter
    by the cosine of the angle up and down the slope, and as it is across it.
    """
    root = (1.0 + rises[0] * rises[0] + rises[1] * rises[1]) ** 0.5
    # One minus the cosine, over the square of the steepest rise.
    less = (rises[0] * x + rises[1] * y) / (root * (1.0 + root))
    return x - less * rises[0], y - less * rises[1]


# No road tyre holds more than this on any road: beyond, a bare number is in another unit.
HIGHEST_DRAG = 1.5
# No contact of vehicles lasts longer: beyond, a bare number is in another unit.
LONGEST_CONTACT = 1.0
USUAL_DURATION = Default(0.1)
"""Duration of a contact [s], where none is given."""


def one_value(
    reader: ArgumentReader, value: Any, unit: str, name: str, domain: Domain = FINITE
) -> Any:
    """A float or an array; a list is refused, as it would be neither segments nor cases."""
    if isinstance(value, (list, tuple)):
        return reader.refuse(
            ShapeError(
                f"{name} is {a_type_of(value)}, and takes one value"
                "`|; many cases go in a numpy array|`",
                code="bad_shape",
                argument=name,
            )
        )
    return reader.number(value, unit, name, domain)


def read_drag(reader: ArgumentReader, value: Any, name: str) -> Any:
    """The drag factor, also from a deceleration."""
    either = isinstance(value, str) or is_quantity(value)
    read = (
        _factor_or_deceleration(reader, value, name)
        if either
        else one_value(reader, value, "", name)
    )
    why = "it says how much the ground slows the vehicle, whatever way it goes"
    read = at_least_zero(reader, read, value, name, "negative_drag", why)
    warn_if_large(value, read, HIGHEST_DRAG, name, "a fraction of gravity", "m/s**2", "%")
    return read


def read_friction(reader: ArgumentReader, value: Any, name: str, label: str = "") -> Any:
    """The friction of locked tyres, >= 0 and finite; with a ``label`` of it, if its name is not
    that of a friction.
    """
    wrong = len(reader.problems)
    read = one_value(reader, value, "", name, UNCHECKED)
    if len(reader.problems) > wrong:
        return read
    if isinstance(read, float) and not math.isfinite(read):
        return reader.refuse(must_be(name, "finite", value, code="not_finite"))
    if isinstance(read, float) and read < 0.0:
        why = "; it acts against the sliding whichever way that goes, so give its magnitude"
        error = must_be(label or name, ">= 0", value, why, code="bad_friction", named=name)
        return reader.refuse(error)
    warn_if_large(value, read, HIGHEST_DRAG, name, "a fraction of the load", "%")
    return read


def _factor_or_deceleration(reader: ArgumentReader, value: Any, name: str) -> Any:
    factor, deceleration = ArgumentReader(), ArgumentReader()
    read = factor.number(value, "", name)
    if not factor.problems:
        return read
    read = deceleration.number(value, "m/s**2", name)
    if not deceleration.problems:
        return read / GRAVITY
    if isinstance(factor.problems[0], UnitsError) and isinstance(
        deceleration.problems[0], UnitsError
    ):
        text = (
            f"{name}: cannot read {shown(value)} as a drag factor or a deceleration; write 0.7, "
            "'70 %', '6.9 m/s**2' or '22.5 ft/s**2'"
        )
        return reader.refuse(UnitsError(text, code="bad_units", argument=name))
    return reader.refuse(
        next(p for p in (*factor.problems, *deceleration.problems) if not isinstance(p, UnitsError))
    )


def read_duration(reader: ArgumentReader, duration: Any, instead_of_zero: str = "") -> Any:
    """The duration of the contact, with a warning if a bare number is longer than any contact;
    0 is refused where it says what to write ``instead_of_zero``.
    """
    read = one_value(reader, duration, "s", "duration")
    if isinstance(read, float) and (read < 0.0 or (instead_of_zero and read == 0.0)):
        allowed = "> 0" if instead_of_zero else ">= 0"
        code, hint = (
            ("negative_duration", "it is the time from touching to parting")
            if read < 0.0
            else ("not_positive", instead_of_zero)
        )
        read = reader.refuse(must_be("duration", allowed, duration, f"; {hint}", code=code))
    warn_if_large(duration, read, LONGEST_CONTACT, "duration", "seconds", "ms")
    return read
