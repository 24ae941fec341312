"""Amounts: numbers that say how much of something there is, and cannot be below zero."""

from __future__ import annotations

from typing import Any

from .errors import InputError
from .reading import ArgumentReader
from .units import shown

_CODES = {"m/s": "negative_speed", "J": "negative_energy", "m": "negative_length", "N/m": "negative_stiffness"}


def amount(reader: ArgumentReader, value: Any, unit: str, name: str, hint: str = "give the magnitude") -> Any:
    """A number read through the reader; of arrays the solvers look at every case themselves."""
    return at_least_zero(reader, reader.number(value, unit, name), value, name, _CODES[unit], hint)


def at_least_zero(reader: ArgumentReader, read: Any, given: Any, name: str, code: str, hint: str) -> Any:
    """A number that was read, refused if it is a single one below zero."""
    if isinstance(read, float) and read < 0.0:
        return reader.refuse(InputError(f"{name} must be >= 0, got {shown(given)}; {hint}", code=code, argument=name))
    return read
