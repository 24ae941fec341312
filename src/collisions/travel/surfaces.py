"""The reader of travel: drag, grade, lengths and speeds, one value or one for each segment."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from ..amounts import at_least_zero
from ..errors import ShapeError, UnitsError
from ..kernels.elementwise import FINITE, Domain
from ..reading import ArgumentReader, warn_if_large
from ..units import Input, is_quantity, shown
from .chain import GRAVITY

Segments: TypeAlias = Input | Sequence[Input]
_Reader: TypeAlias = Callable[[ArgumentReader, Any, str], Any]

# No road tyre holds more than this on any road, and no road is steeper: beyond, a bare number is in another unit.
HIGHEST_DRAG = 1.5
_STEEPEST_GRADE = 0.5


def for_each(reader: ArgumentReader, value: Any, name: str, count: int | None, read: _Reader) -> list[Any]:
    """One number for each segment; a single value stands for all.

    ``count`` is 0 for one surface, not given as a list, and None if the segments could not be read.
    """
    if not isinstance(value, (list, tuple)):
        one = read(reader, value, name)
        return [one] * (count or 1)
    if count is None or len(value) == count > 0:
        return [read(reader, part, f"{name}[{i}]") for i, part in enumerate(value)]
    kind = type(value).__name__
    if count:
        text = f"{name} is a {kind} of {len(value)}, and there are {count} segments; give one value for all, or one for each"
    else:
        text = (
            f"{name} is a {kind}, one value for each segment, and distance is one surface; give distance as a list too, or "
            f"many cases as a numpy array"
        )
    reader.refuse(ShapeError(text, code="bad_shape", argument=name))
    return [math.nan] * (count or 1)


def one_value(reader: ArgumentReader, value: Any, unit: str, name: str, domain: Domain = FINITE) -> Any:
    """A float or an array; a list here is neither segments nor cases."""
    if isinstance(value, (list, tuple)):
        return reader.refuse(
            ShapeError(
                f"{name} is a {type(value).__name__}, and takes one value; many cases go in a numpy array",
                code="bad_shape",
                argument=name,
            )
        )
    return reader.number(value, unit, name, domain)


def read_length(reader: ArgumentReader, value: Any, name: str) -> Any:
    """A length of way [m], >= 0."""
    read = one_value(reader, value, "m", name)
    return at_least_zero(reader, read, value, name, "negative_distance", "it is counted along the way travelled")


def read_speed(reader: ArgumentReader, value: Any, name: str) -> Any:
    """A speed along the way [m/s], >= 0."""
    read = one_value(reader, value, "m/s", name)
    return at_least_zero(reader, read, value, name, "negative_speed", "it is counted along the way travelled")


def read_drag(reader: ArgumentReader, value: Any, name: str) -> Any:
    """The drag factor, also from a deceleration."""
    either = isinstance(value, str) or is_quantity(value)
    read = _factor_or_deceleration(reader, value, name) if either else one_value(reader, value, "", name)
    why = "it says how much the ground slows the vehicle, whatever way it goes"
    read = at_least_zero(reader, read, value, name, "negative_drag", why)
    warn_if_large(value, read, HIGHEST_DRAG, name, "a fraction of gravity", "m/s**2", "%")
    return read


def _factor_or_deceleration(reader: ArgumentReader, value: Any, name: str) -> Any:
    factor, deceleration = ArgumentReader(), ArgumentReader()
    read = factor.number(value, "", name)
    if not factor.problems:
        return read
    read = deceleration.number(value, "m/s**2", name)
    if not deceleration.problems:
        return read / GRAVITY
    if isinstance(factor.problems[0], UnitsError) and isinstance(deceleration.problems[0], UnitsError):
        text = (
            f"{name}: cannot read {shown(value)} as a drag factor or a deceleration; write 0.7, '70 %', '6.9 m/s**2' or "
            f"'22.5 ft/s**2'"
        )
        return reader.refuse(UnitsError(text, code="bad_units", argument=name))
    return reader.refuse(next(p for p in (*factor.problems, *deceleration.problems) if not isinstance(p, UnitsError)))


def read_grade(reader: ArgumentReader, value: Any, name: str) -> Any:
    """The rise over the run, with a warning if a bare number is steeper than any road."""
    read = one_value(reader, value, "", name)
    warn_if_large(value, read, _STEEPEST_GRADE, name, "the rise over the run", "%")
    return read
