"""Numbers as people read them: figures or decimals, units, and words for NaN and infinity."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Any, NamedTuple

from ..messages.errors import InputError
from .refusals import must_be
from .units import SYSTEMS as SYSTEMS
from .units import UnitSystem as UnitSystem
from .units import scale

_FIGURES = 3  # of results without a fixed number of decimals: impulses and energies
_NO_SPREAD = 1e-12  # relative: a standard deviation this small is rounding


def in_words(value: float) -> str:
    """The words for a number that is NaN or infinite."""
    return "not defined" if math.isnan(value) else "infinite"


def percent(share: float, decimals: int = 0) -> str:
    """A share in percent."""
    return (
        f"{with_decimals(100.0 * share, decimals)} percent"
        if math.isfinite(share)
        else in_words(share)
    )


def clock_hour(pdof: float) -> int:
    """A PDOF as the nearest hour of a clock face: 12 from straight ahead, 3 from the right."""
    return (round(pdof * (6.0 / math.pi)) - 1) % 12 + 1


def clock(name: str, value: float) -> str:
    """The text after a PDOF, known by the name of its attribute: its clock hour; "" after other
    numbers.
    """
    return (
        f" ({clock_hour(value)} o'clock)" if "pdof" in name.lower() and math.isfinite(value) else ""
    )


def places(value: float, figures: int) -> int:
    """The decimals that show so many figures after rounding; negative to the left of the decimal
    point.
    """
    return figures - 1 - int(f"{value:.{figures - 1}e}".partition("e")[2])


def with_decimals(value: float, decimals: int, thousands: str = "") -> str:
    """A number with so many decimals, or rounded to a power of ten, and never -0."""
    # Above 1e300 a digit before the point can round beyond the range of floats.
    rounded = value if decimals >= 0 or abs(value) > 1e300 else round(value, decimals)
    text = f"{rounded:,.{max(decimals, 0)}f}".replace(",", thousands)
    return text if text.strip("-0.") else text.lstrip("-")


def rounded(value: float, decimals: int) -> str:
    """A number of a result with so many decimals; from 1e15, where a float does not hold them, with
    six figures.
    """
    return f"{value:.6g}" if abs(value) >= 1e15 else with_decimals(value, decimals)


def typeset(text: str) -> str:
    """Units as they are printed: "lb*ft**2" is lb·ft², "30 deg" is 30°."""
    for plain, printed in (("**2", "²"), ("**3", "³"), ("^2", "²"), ("*", "·")):
        text = text.replace(plain, printed)
    return re.sub(r"(?<![a-z]) ?\b(?:degrees?|deg)\b", "°", text)


def number_with_unit(number: str, unit: str) -> str:
    """A number and its unit as they are printed; no space before a degree sign."""
    printed = typeset(unit)
    return f"{number}{'' if printed[:1] == '°' else ' '}{printed}".rstrip()


class Numbers:
    """How SI numbers are written in one system of units, by kind of quantity."""

    # Whether units are written as on a printed page, lb·ft² and 30°, or as pint reads them.
    typeset = False
    # The kind that numbers are taken to be of if their SI unit is none of those in the table of
    # kinds.
    unlisted: str | None = None

    # The kinds that are written in degrees whatever the system, as the inputs were.
    in_degrees: frozenset[str] = frozenset()

    def __init__(self, system: str) -> None:
        self.name = system

    def system_of(self, kind: str) -> str:
        """The system that a kind is written in: "metric" has the degrees of what "si" has in
        radians.
        """
        return "metric" if kind in self.in_degrees and self.name == "si" else self.name

    def label(self, kind: str) -> str:
        """The unit of a kind, as pint writes it."""
        return unit_of(kind, self.system_of(kind))

    def unit(self, kind: str) -> str:
        """The unit behind a number, with the space before it."""
        label = self.label(kind)
        return number_with_unit("", label) if self.typeset else f" {label}".rstrip()

    def scale(self, kind: str) -> float:
        """The factor from SI to the unit of this kind."""
        return scale_of(kind, self.system_of(kind))

    def converted(self, value: float, kind: str) -> float:
        """An SI value of this kind in the unit it is written in."""
        found = value * self.scale(kind)
        if math.isinf(found):
            raise InputError(
                f"{value:.6g} {unit_of(kind, 'si')} is too large to be written in "
                f"{self.label(kind)}; look for a slipped digit",
                code="out_of_range",
                argument="units",
            )
        return found

    def span(self, low: float, high: float, kind: str, deviation: float | None = None) -> str:
        """A range as a result, with the unit at its end; one value if both ends are
        printed alike.
        """
        ends = [self.answer(end, kind, deviation).partition(" ± ")[0] for end in (low, high)]
        if not math.isfinite(low + high):
            return " to ".join(ends)
        unit = self.unit(kind)
        return " to ".join(dict.fromkeys(end.removesuffix(unit) for end in ends)) + unit

    def answer(self, value: float, kind: str, deviation: float | None = None) -> str:
        """A number as a result, rounded to its standard deviation where that is known, with the
        unit.
        """
        if not math.isfinite(value):
            return in_words(value)
        number, unit = self.converted(value, kind), self.unit(kind)
        if (
            deviation is not None
            and math.isfinite(deviation)
            and deviation > _NO_SPREAD * abs(value)
        ):
            spread = self.converted(deviation, kind)
            decimals = places(spread, 2)
            return f"{rounded(number, decimals)} ± {rounded(spread, decimals)}{unit}"
        known = decimals_of(kind, self.system_of(kind))
        figures = places(number, _FIGURES) if number else 0
        return rounded(number, figures if known is None else known) + unit


class _Kind(NamedTuple):
    si: str
    metric: str
    us: str
    decimals: tuple[int, int, int] | None = (
        None  # of a result, by system; without an entry, figures are used
    )


# Decimals: 0.1 km/h, 0.1 mph, 0.1 degree, 1 degree/s, and in SI the next finer power of ten. US
# inertia is lb*ft**2, not lbf*ft*s**2: only beside masses in lb does 1/m + r**2/I add up as it is
# printed. A contact lasts some hundredths of a second, so its duration is in ms; other times are
# those of travel.
_KINDS = {
    "number": _Kind("", "", "", (2, 2, 2)),
    "ratio": _Kind("", "", "", (3, 3, 3)),
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
    "crush stiffness": _Kind("N/m**2", "kN/m**2", "lbf/in**2"),
    "per mass": _Kind("1/kg", "1/kg", "1/lb"),
}
# The SI unit of each kind, and the kind that a number in an SI unit is taken to be of.
SI_UNITS = {kind: row.si for kind, row in _KINDS.items()}
KIND_OF = {row.si: kind for kind, row in _KINDS.items() if kind not in ("duration", "ratio")}


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
    """The factor from SI to the unit of this kind."""
    inside, label = SI_UNITS[kind], unit_of(kind, system)
    if inside == label:
        return 1.0
    return scale(inside, label)


def check_system(units: Any) -> None:
    """Refuse an argument ``units`` that names none of the systems."""
    if not isinstance(units, str) or units not in SYSTEMS:
        raise must_be(
            "units",
            f"{', '.join(map(repr, SYSTEMS[:-1]))} or {SYSTEMS[-1]!r}",
            units,
            "; they are those of what is printed, not those of the inputs",
            code="bad_option",
        )
