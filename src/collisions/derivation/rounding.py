"""Digits: how many figures of each number are printed, and the conversions between units that a line needs."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple, TypeAlias

from ..errors import InputError
from ..formatting import in_words
from ..unit_systems import decimals_of, scale_of, unit_of

# Labels of units with their powers.
Powers: TypeAlias = tuple[tuple[str, float], ...]

# What is this near to nothing in SI is what rounding left of it, and printed as 0.
_NOTHING = {"impulse": 1e-8, "angular momentum": 1e-8, "energy": 1e-8, "per mass": 1e-15}
_FIGURES = 3  # of answers that have no decimals of their own: impulses and energies
_WORKING = 4  # figures of a number in the working
_EXACT = 1e-9  # relative: a number this near to one of six figures is that number
_DUST = 1e-12  # relative: a spread this small is what rounding left of none


class Conversion(NamedTuple):
    """A number that converts units: whether to divide by it, the number as printed, and the units it stands between."""

    divides: bool
    number: str
    one: str
    other: str


class System:
    """One system of units, and the conversions that were used while writing in it, by the units they stand between."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._used: dict[tuple[str, str], str] = {}

    @property
    def conversions(self) -> list[str]:
        """Each conversion that was used, with the most figures that a line needed of it."""
        return [f"1 {one} = {number} {other}" for (one, other), number in self._used.items()]

    def use(self, conversions: Iterable[Conversion]) -> None:
        """Note down conversions that were printed."""
        for conversion in conversions:
            key = conversion.one, conversion.other
            self._used[key] = max(self._used.get(key, ""), conversion.number, key=len)

    def label(self, kind: str) -> str:
        """The unit of a kind, as pint writes it."""
        return unit_of(kind, self.name)

    def unit(self, kind: str, latex: bool) -> str:
        """The unit behind a number, with the space before it."""
        label = self.label(kind)
        if not label:
            return ""
        return rf"\ \mathrm{{{label.replace('**2', '^2').replace('*', chr(92) + ',')}}}" if latex else f" {label}"

    def scale(self, kind: str) -> float:
        """What an SI value of this kind is multiplied by."""
        return scale_of(kind, self.name)

    def shown(self, value: float, kind: str) -> float:
        """An SI value of this kind in the unit it is written in."""
        shown = value * self.scale(kind)
        if math.isinf(shown):
            raise InputError(
                f"{value:.6g} {unit_of(kind, 'si')} is too large to be written in {self.label(kind)}; look for a slipped digit",
                code="out_of_range",
                argument="units",
            )
        return shown

    def working(self, value: float, kind: str, more: int = 0) -> str:
        """A number in the working: as it is if six figures hold it, else four or the decimals of an answer, and more."""
        if not math.isfinite(value):
            return "not known" if math.isnan(value) else "infinite"
        shown = self.shown(value, kind)
        least = decimals_of(kind, self.name)
        if abs(value) <= _NOTHING.get(kind, 1e-10):
            return "0"
        return self.figures(shown, least, more)

    def figures(self, shown: float, least: int | None = None, more: int = 0) -> str:
        """A number as it is if six figures hold it, else four figures, or at least so many decimals and two more at most."""
        exact = f"{shown:.6g}"
        if (
            abs(float(exact) - shown) <= _EXACT * 10.0 ** -max(more - 4, 0) * abs(shown)
            and len(exact) <= 9
            and "e" not in exact
        ):
            return exact
        return _plain(shown, _places(shown, least) + more)

    def half_unit(self, value: float, kind: str, size: float) -> float:
        """Half a unit, as printed, of the last of the figures that the working promises of this number.

        Of a number that is 0 it is that of the ``size`` of what has cancelled to it.
        """
        least = decimals_of(kind, self.name)
        scale = self.scale(kind)
        decimals = len(self.working(value, kind).partition(".")[2])
        nothing = abs(value) <= _NOTHING.get(kind, 1e-10)
        figures = _places(size * scale, None) if nothing and 0.0 < size < math.inf else _places(value * scale, least)
        return 0.5 * 10.0 ** -max(decimals, figures)

    def answer(self, value: float, kind: str, deviation: float | None = None) -> str:
        """A number as an answer, rounded to its standard deviation where that is known, with the unit."""
        if not math.isfinite(value):
            return in_words(value)
        shown = self.shown(value, kind)
        unit = self.unit(kind, False)
        if deviation is not None and math.isfinite(deviation) and deviation > _DUST * abs(value):
            spread = self.shown(deviation, kind)
            places = 1 - _magnitude(spread, 2)
            return f"{_plain(shown, places)} ± {_plain(spread, places)}{unit}"
        decimals = decimals_of(kind, self.name)
        places = _FIGURES - 1 - _magnitude(shown, _FIGURES) if decimals is None else decimals
        return _plain(shown, places) + unit

    def conversion(self, factor: float, powers: Powers, wanted: Powers, more: int = 0) -> Conversion:
        """What turns a number from one unit into another: it may well be a number to divide by."""
        divides = factor < 1.0
        one, other = (wanted, powers) if divides else (powers, wanted)
        size = 1.0 / factor if divides else factor
        number = f"{size:.{6 + more}g}" if size < 999999.5 else f"{size:.{more}f}"
        return Conversion(divides, number, _named(one), _named(other))


def _magnitude(value: float, figures: int) -> int:
    """The power of ten of the first figure, after rounding to so many figures."""
    return int(f"{value:.{figures - 1}e}".partition("e")[2])


def _places(shown: float, least: int | None) -> int:
    """Decimals of a number in the working."""
    figures = _WORKING - 1 - _magnitude(shown, _WORKING)
    return max(figures if least is None else max(least, min(figures, least + 2)), 0)


def _plain(value: float, places: int) -> str:
    """A number with so many decimals, or rounded to a power of ten, and never -0."""
    # Above this a digit before the point can round beyond the range of floats.
    rounded = value if abs(value) > 1e300 else round(value, places)
    text = f"{rounded:.{max(places, 0)}f}"
    return text.lstrip("-") if float(text) == 0.0 else text


def _named(powers: Powers) -> str:
    over: list[str] = []
    under: list[str] = []
    for label, power in powers:
        size = abs(power)
        loose = ("/" in label and len(powers) > 1) or ("*" in label and power < 0.0)
        held = f"({label})" if loose or (size != 1.0 and not label.isalpha()) else label
        (over if power > 0.0 else under).append(held if size == 1.0 else f"{held}**{size:g}")
    return " / ".join([" * ".join(over) or "1", *under])


def powers_of(label: str) -> Powers:
    """The powers of a unit by itself."""
    if label.startswith("1/"):
        return ((label[2:], -1.0),)
    return ((label, 1.0),) if label else ()
