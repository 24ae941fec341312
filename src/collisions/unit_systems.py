"""The systems of units that answers are written in: unit and decimals of each kind of quantity, and the check of ``units=``."""

from __future__ import annotations

from functools import cache
from typing import Any, Literal, NamedTuple, TypeAlias

from .errors import InputError
from .units import shown, to_quantity

# In which explanations, reports, findings and figures can be written.
UnitSystem: TypeAlias = Literal["si", "metric", "us"]
SYSTEMS: tuple[UnitSystem, ...] = ("si", "metric", "us")


class _Kind(NamedTuple):
    si: str
    metric: str
    us: str
    decimals: tuple[int, int, int] | None = None  # of an answer, by system; without them its writer sets the figures


# Decimals: 0.1 km/h, 0.1 mph, 0.1 degree, 1 degree/s, and in SI the next finer power of ten.
# US inertia is lb*ft**2, not lbf*ft*s**2: only beside masses in lb does 1/m + r**2/I add up as it is printed.
# A contact lasts some hundredths of a second, so its duration is in ms; other times are those of travel.
_KINDS = {
    "number": _Kind("", "", "", (2, 2, 2)),
    "mass": _Kind("kg", "kg", "lb"),
    "speed": _Kind("m/s", "km/h", "mph", (2, 1, 1)),
    "acceleration": _Kind("m/s**2", "m/s**2", "ft/s**2"),
    "angle": _Kind("rad", "deg", "deg", (2, 0, 0)),
    "yaw rate": _Kind("rad/s", "deg/s", "deg/s", (2, 0, 0)),
    "length": _Kind("m", "m", "ft", (2, 2, 2)),
    "duration": _Kind("s", "ms", "ms"),
    "time": _Kind("s", "s", "s"),
    "inertia": _Kind("kg*m**2", "kg*m**2", "lb*ft**2"),
    "impulse": _Kind("N*s", "kN*s", "lbf*s"),
    "momentum": _Kind("kg*m/s", "kN*s", "lbf*s"),
    "angular momentum": _Kind("kg*m**2/s", "kN*m*s", "lbf*ft*s"),
    "energy": _Kind("J", "kJ", "ft*lbf"),
    "force": _Kind("N", "kN", "lbf"),
    "stiffness": _Kind("N/m", "N/m", "lbf/in"),
    "per mass": _Kind("1/kg", "1/kg", "1/lb"),
}
# The SI unit of each kind, and the kind that a number in an SI unit is taken to be of.
SI_UNITS = {kind: row.si for kind, row in _KINDS.items()}
KIND_OF = {row.si: kind for kind, row in _KINDS.items() if kind != "duration"}


def unit_of(kind: str, system: str) -> str:
    """The unit that a kind is written in, as pint writes it."""
    label: str = getattr(_KINDS[kind], system)
    return label


def decimals_of(kind: str, system: str) -> int | None:
    """The decimals of an answer of this kind; None if it has a number of figures instead."""
    decimals = _KINDS[kind].decimals
    return None if decimals is None else decimals[SYSTEMS.index(system)]


@cache
def scale_of(kind: str, system: str) -> float:
    """What an SI number of this kind is multiplied by."""
    inside, label = SI_UNITS[kind], unit_of(kind, system)
    return 1.0 if inside == label else float(to_quantity(1.0, inside).m_as(label))


def bad_system(units: Any) -> InputError | None:
    """The refusal of an argument ``units`` that names none of the systems."""
    if isinstance(units, str) and units in SYSTEMS:
        return None
    return InputError(
        f"units must be 'si', 'metric' or 'us', got {shown(units)}; the units of the numbers given are known, only those of "
        f"what is written are chosen",
        code="bad_option",
        argument="units",
    )
