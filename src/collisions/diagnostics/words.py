"""How a sentence writes a number: with its unit, in the system that was asked for."""

from __future__ import annotations

import math
from typing import Any

from ..formatting import in_words
from ..reading import ArgumentReader
from ..unit_systems import bad_system, decimals_of, scale_of, unit_of

_FIGURES = 4  # of what has no decimals of its own: an energy


class Words:
    """Numbers as sentences in one system of units have them."""

    def __init__(self, system: str) -> None:
        self._system = system

    def number(self, value: float, kind: str, more: int = 0) -> str:
        """The number alone, with so many decimals more than an answer has; an energy to four figures."""
        told = value * scale_of(kind, self._system)
        if not math.isfinite(told):
            return in_words(told)
        decimals = decimals_of(kind, self._system)
        text = f"{float(f'{told:.{_FIGURES}g}'):.12g}" if decimals is None else f"{told:.{decimals + more}f}"
        return text.lstrip("-") if float(text) == 0.0 else text

    def _told(self, value: float, kind: str, more: int = 0) -> str:
        unit = unit_of(kind, self._system).replace("deg", "degrees").replace("*", " ")
        return f"{self.number(value, kind, more)} {unit}" if math.isfinite(value) else in_words(value)

    def plain(self, value: float) -> str:
        """A number without a unit, to three figures."""
        return f"{value:.3g}" if math.isfinite(value) else in_words(value)

    def percent(self, share: float, decimals: int = 0) -> str:
        """A share; of nothing everything is an infinite one."""
        return f"{share:.{decimals}%}" if math.isfinite(share) else f"a share that is {in_words(share)}"

    def speed(self, value: float) -> str:
        """A speed [m/s]."""
        return self._told(value, "speed")

    def length(self, value: float) -> str:
        """A length [m]."""
        return self._told(value, "length")

    def angle(self, value: float) -> str:
        """An angle [rad], to one decimal more than an answer has, because it stands beside a limit."""
        return self._told(value, "angle", more=1)

    def yaw_rate(self, value: float) -> str:
        """A yaw rate [rad/s]."""
        return self._told(value, "yaw rate")

    def energy(self, value: float) -> str:
        """An energy [J]."""
        return self._told(value, "energy")


def read_words(reader: ArgumentReader, units: Any) -> Words:
    """The words of a system of units, which must be one of the known ones."""
    problem = bad_system(units)
    if problem is not None:
        reader.refuse(problem)
        return Words("metric")
    return Words(units)
