"""``Sourced``: a number that says what it was worked out from, so that a report can."""

from __future__ import annotations

from typing import Any

from .units import has_unit, is_quantity, unit_as_written


class Sourced(float):
    """A float that has with it, in ``source``, what it was worked out from.

    It is a float in everything, and what is worked out from it is one too; but the sum of two such
    numbers says what both were worked out from. Any other number added to it has no source, so
    that the sum has none either, but for 0, with which ``sum`` begins.
    """

    __slots__ = ("source",)

    source: str

    def __new__(cls, value: float, source: str = "") -> Sourced:
        made = super().__new__(cls, value)
        made.source = source
        return made

    def __add__(self, other: Any) -> Any:
        total = float.__add__(self, other)
        if isinstance(other, Sourced):
            return Sourced(total, f"{self.source}; {other.source}")
        zero = isinstance(other, (int, float)) and other == 0
        return Sourced(total, self.source) if zero else total

    __radd__ = __add__


def source_of(given: Any) -> str:
    """What a number, or that of a Quantity, was worked out from; "" where it does not say."""
    number = given.magnitude if is_quantity(given) else given
    return number.source if isinstance(number, Sourced) else ""


def as_given(given: Any, number: float, unit: str) -> str:
    """What was given with a unit as it is; the number itself, in SI, where there was none."""
    if isinstance(given, str) and has_unit(given):
        return given.strip()
    if is_quantity(given) and has_unit(given):
        return f"{given.magnitude:.10g} {unit_as_written(given)}"
    return f"{number:.10g} {unit}"
