"""How a sentence writes a number: with its unit, in the system that was asked for."""

from __future__ import annotations

from typing import Any

from ..door import Door
from ..errors import InputError
from ..units import shown

SYSTEMS = ("si", "metric", "us")
# By system: of a kind, what an SI number is divided by, the decimals and the unit. All but the degree are exact by definition.
_TABLE: dict[str, dict[str, tuple[float, int, str]]] = {
    "si": {
        "speed": (1.0, 2, "m/s"),
        "length": (1.0, 2, "m"),
        "angle": (1.0, 3, "rad"),
        "yaw_rate": (1.0, 2, "rad/s"),
        "energy": (1.0, -1, "J"),
    },
    "metric": {
        "speed": (1.0 / 3.6, 1, "km/h"),
        "length": (1.0, 2, "m"),
        "angle": (0.017453292519943295, 1, "degrees"),
        "yaw_rate": (0.017453292519943295, 0, "degrees/s"),
        "energy": (1000.0, -1, "kJ"),
    },
    "us": {
        "speed": (0.44704, 1, "mph"),
        "length": (0.3048, 2, "ft"),
        "angle": (0.017453292519943295, 1, "degrees"),
        "yaw_rate": (0.017453292519943295, 0, "degrees/s"),
        "energy": (0.3048 * 0.45359237 * 9.80665, -1, "ft lbf"),
    },
}


class Words:
    """Numbers as sentences in one system of units have them."""

    def __init__(self, system: str) -> None:
        self._of = _TABLE[system]

    def number(self, value: float, kind: str) -> str:
        """The number alone; an energy to four figures."""
        size, decimals, _ = self._of[kind]
        told = value / size
        text = f"{told:.{decimals}f}" if decimals >= 0 else f"{float(f'{told:.4g}'):.12g}"
        return text.lstrip("-") if float(text) == 0.0 else text

    def _told(self, value: float, kind: str) -> str:
        return f"{self.number(value, kind)} {self._of[kind][2]}"

    def speed(self, value: float) -> str:
        """A speed [m/s]."""
        return self._told(value, "speed")

    def length(self, value: float) -> str:
        """A length [m]."""
        return self._told(value, "length")

    def angle(self, value: float) -> str:
        """An angle [rad]."""
        return self._told(value, "angle")

    def yaw_rate(self, value: float) -> str:
        """A yaw rate [rad/s]."""
        return self._told(value, "yaw_rate")

    def energy(self, value: float) -> str:
        """An energy [J]."""
        return self._told(value, "energy")


def read_words(door: Door, units: Any) -> Words:
    """The words of a system of units, which must be one of the known ones."""
    if not isinstance(units, str) or units not in SYSTEMS:
        door.refuse(
            InputError(
                f"units must be 'si', 'metric' or 'us', got {shown(units)}; the SI units of the numbers are known, only those "
                f"of the sentences are chosen",
                code="bad_option",
                argument="units",
            )
        )
        return Words("metric")
    return Words(units)
