"""The units that accidents are described in, read from a table instead of by pint, whose registry
takes a third of a second to make.

Every row is what pint gives, to the last bit; other spellings are pint's to read.
"""

from __future__ import annotations

from typing import Any

# Pint's name of a unit, the SI unit of its kind, the factor to it, and how it is written. Pint
# multiplies in the order of the text, which may change the last bit of a factor.
_ROWS = (
    ("kilogram", "kg", 1.0, "kg, kilogram, kilograms"),
    ("pound", "kg", 0.4535923700000001, "lb, lbs, pound, pounds"),
    ("metric_ton", "kg", 1000.0, "t, tonne, tonnes"),
    ("slug", "kg", 14.59390293720637, "slug, slugs"),
    ("meter / second", "m/s", 1.0, "m/s"),
    ("kilometer / hour", "m/s", 0.2777777777777778, "km/h"),
    ("kilometer_per_hour", "m/s", 0.2777777777777778, "kph"),
    ("mile_per_hour", "m/s", 0.44704, "mph"),
    ("mile / hour", "m/s", 0.44704, "mi/h, mile/hour"),
    ("foot / second", "m/s", 0.30479999999999996, "ft/s, foot/second"),
    ("inch / second", "m/s", 0.0254, "in/s"),
    ("knot", "m/s", 0.5144444444444445, "knot, knots"),
    ("radian / second", "rad/s", 1.0, "rad/s"),
    ("degree / second", "rad/s", 0.017453292519943295, "deg/s, degree/second, degrees/second"),
    ("turn / second", "rad/s", 6.283185307179586, "turn/s"),
    ("meter / second ** 2", "m/s**2", 1.0, "m/s**2, m/s^2, m/s²"),
    ("foot / second ** 2", "m/s**2", 0.30479999999999996, "ft/s**2, ft/s^2, ft/s²"),
    (
        "kilogram * meter ** 2",
        "kg*m**2",
        1.0,
        "kg*m**2, kg*m^2, kg*m², kg m**2, kg m^2, kg m², kg·m²",
    ),
    ("foot ** 2 * slug", "kg*m**2", 1.3558179483314006, "slug*ft**2, slug*ft^2"),
    ("foot * force_pound * second ** 2", "kg*m**2", 1.3558179483314006, "lbf*ft*s**2"),
    ("foot * force_pound * second ** 2", "kg*m**2", 1.3558179483314001, "ft*lbf*s**2"),
    ("foot ** 2 * pound", "kg*m**2", 0.0421401100938048, "lb*ft**2, lb*ft^2"),
    ("second", "s", 1.0, "s, sec, second, seconds"),
    ("millisecond", "s", 0.001, "ms, millisecond, milliseconds"),
    ("minute", "s", 60.0, "min"),
    ("meter", "m", 1.0, "m, meter, meters, metre, metres"),
    ("kilometer", "m", 1000.0, "km"),
    ("centimeter", "m", 0.01, "cm, centimeter"),
    ("millimeter", "m", 0.001, "mm, millimeter"),
    ("foot", "m", 0.30479999999999996, "ft, foot, feet"),
    ("inch", "m", 0.0254, "in, inch, inches"),
    ("yard", "m", 0.9144, "yd, yard"),
    ("mile", "m", 1609.344, "mi, mile"),
    ("radian", "rad", 1.0, "rad, radian, radians"),
    ("degree", "rad", 0.017453292519943295, "deg, degree, degrees, °"),
    ("joule", "J", 1.0, "J"),
    ("kilojoule", "J", 1000.0, "kJ"),
    ("megajoule", "J", 1000000.0, "MJ"),
    ("meter * newton", "J", 1.0, "N*m, N m"),
    ("kilonewton * meter", "J", 1000.0, "kN*m"),
    ("foot * force_pound", "J", 1.3558179483314001, "ft*lbf"),
    ("foot * force_pound", "J", 1.3558179483314006, "lbf*ft"),
    ("newton * second", "N*s", 1.0, "N*s, N s"),
    ("kilonewton * second", "N*s", 1000.0, "kN*s, kN s"),
    ("kilogram * meter / second", "N*s", 1.0, "kg*m/s"),
    ("force_pound * second", "N*s", 4.4482216152605005, "lbf*s"),
    ("meter * newton * second", "kg*m**2/s", 1.0, "N*m*s, N m s"),
    ("kilonewton * meter * second", "kg*m**2/s", 1000.0, "kN*m*s"),
    ("kilogram * meter ** 2 / second", "kg*m**2/s", 1.0, "kg*m**2/s"),
    ("foot * force_pound * second", "kg*m**2/s", 1.3558179483314006, "lbf*ft*s"),
    ("foot * force_pound * second", "kg*m**2/s", 1.3558179483314001, "ft*lbf*s"),
    ("newton / meter", "N/m", 1.0, "N/m"),
    ("kilonewton / meter", "N/m", 1000.0, "kN/m"),
    ("newton / millimeter", "N/m", 1000.0, "N/mm"),
    ("newton / centimeter", "N/m", 100.0, "N/cm"),
    ("kilonewton / millimeter", "N/m", 1000000.0, "kN/mm"),
    ("force_pound / inch", "N/m", 175.12683524647645, "lbf/in"),
    ("force_pound / foot", "N/m", 14.59390293720637, "lbf/ft"),
    ("newton / meter ** 2", "N/m**2", 1.0, "N/m**2, N/m^2, N/m²"),
    ("pascal", "N/m**2", 1.0, "Pa"),
    ("kilopascal", "N/m**2", 1000.0, "kPa"),
    ("megapascal", "N/m**2", 1000000.0, "MPa"),
    ("newton / centimeter ** 2", "N/m**2", 10000.0, "N/cm**2"),
    ("pound_force_per_square_inch", "N/m**2", 6894.7572931683635, "psi"),
    ("force_pound / inch ** 2", "N/m**2", 6894.7572931683635, "lbf/in**2, lbf/in^2"),
    ("newton", "N", 1.0, "N"),
    ("kilonewton", "N", 1000.0, "kN"),
    ("force_pound", "N", 4.4482216152605005, "lbf"),
    ("percent", "", 0.01, "%, percent"),
)
# The factors from SI to the units of printed pages.
SCALES = {
    ("kg", "lb"): 2.2046226218487757,
    ("m/s", "km/h"): 3.6,
    ("m/s", "mph"): 2.2369362920544025,
    ("m/s**2", "ft/s**2"): 3.2808398950131235,
    ("rad", "deg"): 57.29577951308232,
    ("rad/s", "deg/s"): 57.29577951308232,
    ("m", "ft"): 3.2808398950131235,
    ("s", "ms"): 1000.0,
    ("kg*m**2", "lb*ft**2"): 23.73036040423194,
    ("N*s", "kN*s"): 0.001,
    ("N*s", "lbf*s"): 0.22480894309971053,
    ("kg*m/s", "kN*s"): 0.001,
    ("kg*m/s", "lbf*s"): 0.22480894309971053,
    ("kg*m**2/s", "kN*m*s"): 0.001,
    ("kg*m**2/s", "lbf*ft*s"): 0.7375621492772655,
    ("J", "kJ"): 0.001,
    ("J", "ft*lbf"): 0.7375621492772655,
    ("N", "kN"): 0.001,
    ("N", "lbf"): 0.22480894309971053,
    ("N/m", "lbf/in"): 0.0057101471547326465,
    ("N/m**2", "kN/m**2"): 0.001,
    ("N/m**2", "lbf/in**2"): 0.0001450377377302092,
    ("1/kg", "1/lb"): 0.4535923700000001,
}
# In degrees an angle is reduced exactly, so degrees are read as they are.
_DEGREES = {"degree": 1.0}


class Usual:
    """A number in one of these units, with those attributes of a Quantity that reading needs.

    ``written`` is the unit as it stood in the text, ``name`` the one pint gives it, and ``si`` the
    SI unit of its kind.
    """

    __slots__ = ("_factors", "_units", "magnitude", "name", "si", "written")

    def __init__(self, magnitude: float, written: str, row: tuple[str, str, float]) -> None:
        self.magnitude, self.written = magnitude, written
        self.name, self.si, by = row
        self._units = _powers(self.name)
        self._factors = {self.si: by} | (_DEGREES if self.name == "degree" else {})

    def __repr__(self) -> str:
        return f"{self.magnitude} {self.name}"

    def factor(self, unit: str) -> float | None:
        """The factor to an SI unit; None where the number may be of another kind."""
        return self._factors.get(unit)


class Worked(Usual):
    """A number in SI, or an array, that a function of a case file gave: ``source``, such as
    "travel.speed". Or, with the unit "", one that stands for the text ``source`` without a unit.

    Its unit is checked like that of a text, but it is not what somebody wrote, so it is not shown
    as given.
    """

    __slots__ = ("source",)

    def __init__(self, magnitude: Any, unit: str, source: str) -> None:
        super().__init__(magnitude, unit, ("", unit, 1.0))
        self.source = source
        if not unit:
            self._units = {}


def usual(magnitude: float, written: str) -> Usual | None:
    """A number in the unit that is written so; None if it is not in the table."""
    row = USUAL.get(written)
    return None if row is None else Usual(magnitude, written, row)


def _powers(name: str) -> dict[str, int]:
    """The powers of the units in a name as pint writes it, such as "foot * second ** 2"."""
    above, *below = name.split(" / ")
    factors = [(part, 1) for part in above.split(" * ")] + [(part, -1) for part in below]
    powers = {}
    for part, sign in factors:
        unit, _, power = part.partition(" ** ")
        powers[unit] = sign * int(power or 1)
    powers.pop("dimensionless", None)
    return powers


USUAL = {
    written: (name, si, factor)
    for name, si, factor, spellings in _ROWS
    for written in spellings.split(", ")
} | {"": ("dimensionless", "", 1.0)}
