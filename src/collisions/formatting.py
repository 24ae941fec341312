"""Numbers as people read them: their figures or decimals, the unit behind them, and words for what is no number."""

from __future__ import annotations

import math

from .errors import InputError
from .unit_systems import decimals_of, scale_of, unit_of

_FIGURES = 3  # of answers that have no decimals of their own: impulses and energies
_NO_SPREAD = 1e-12  # relative: a deviation this small is what rounding left of none


def in_words(value: float) -> str:
    """What is said in place of a number that is NaN or infinite."""
    return "not defined" if math.isnan(value) else "infinite"


def percent(share: float, decimals: int = 0) -> str:
    """A share in percent."""
    return f"{with_decimals(100.0 * share, decimals)} percent" if math.isfinite(share) else in_words(share)


def places(value: float, figures: int) -> int:
    """The decimals that so many figures take, counted after rounding; below 0 in front of the point."""
    return figures - 1 - int(f"{value:.{figures - 1}e}".partition("e")[2])


def with_decimals(value: float, decimals: int, thousands: str = "") -> str:
    """A number with so many decimals, or rounded to a power of ten, and never -0."""
    # Above 1e300 a digit before the point can round beyond the range of floats.
    rounded = value if decimals >= 0 or abs(value) > 1e300 else round(value, decimals)
    text = f"{rounded:,.{max(decimals, 0)}f}".replace(",", thousands)
    return text if text.strip("-0.") else text.lstrip("-")


class Numbers:
    """How SI numbers are written in one system of units, by kind of quantity."""

    def __init__(self, system: str) -> None:
        self.name = system

    def label(self, kind: str) -> str:
        """The unit of a kind, as pint writes it."""
        return unit_of(kind, self.name)

    def unit(self, kind: str) -> str:
        """The unit behind a number, with the space before it."""
        return f" {self.label(kind)}".rstrip()

    def scale(self, kind: str) -> float:
        """What an SI value of this kind is multiplied by."""
        return scale_of(kind, self.name)

    def converted(self, value: float, kind: str) -> float:
        """An SI value of this kind in the unit it is written in."""
        found = value * self.scale(kind)
        if math.isinf(found):
            raise InputError(
                f"{value:.6g} {unit_of(kind, 'si')} is too large to be written in {self.label(kind)}; look for a slipped digit",
                code="out_of_range",
                argument="units",
            )
        return found

    def answer(self, value: float, kind: str, deviation: float | None = None) -> str:
        """A number as an answer, rounded to its standard deviation where that is known, with the unit."""
        if not math.isfinite(value):
            return in_words(value)
        number, unit = self.converted(value, kind), self.unit(kind)
        if deviation is not None and math.isfinite(deviation) and deviation > _NO_SPREAD * abs(value):
            spread = self.converted(deviation, kind)
            decimals = places(spread, 2)
            return f"{with_decimals(number, decimals)} ± {with_decimals(spread, decimals)}{unit}"
        known = decimals_of(kind, self.name)
        return with_decimals(number, places(number, _FIGURES) if known is None else known) + unit
