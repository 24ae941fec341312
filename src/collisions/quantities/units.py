"""Units: reads texts and Quantities (``parse``, ``magnitude``), and makes Quantities
(``to_quantity``).

The only file that names pint, which it loads when a Quantity is asked for, or a unit appears that
is not in the table of usual ones.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from threading import RLock
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias, get_args
from weakref import WeakKeyDictionary

import numpy as np

from ..messages.errors import InputError, UnitsError
from ..messages.marked import as_code
from .usual_units import SCALES, USUAL, Usual, Worked, usual

if TYPE_CHECKING:
    import numpy.typing as npt

    class Quantity(Protocol):
        """The interface of a pint Quantity of any registry; pint's own types are not known to every
        type checker.
        """

        @property
        def magnitude(self) -> Any: ...
        def m_as(self, units: Any) -> Any: ...

    class Value(float):
        """The type of an attribute's value: a float in a single case, an array in a batch."""

        def __getattr__(self, name: str) -> Any: ...
        def __getitem__(self, key: Any) -> Any: ...
        def __len__(self) -> int: ...
        def __neg__(self) -> Value: ...
        def __add__(self, other: Any) -> Value: ...
        def __radd__(self, other: Any) -> Value: ...
        def __sub__(self, other: Any) -> Value: ...
        def __rsub__(self, other: Any) -> Value: ...
        def __mul__(self, other: Any) -> Value: ...
        def __rmul__(self, other: Any) -> Value: ...
        def __truediv__(self, other: Any) -> Value: ...
        def __rtruediv__(self, other: Any) -> Value: ...

    Input: TypeAlias = float | str | Quantity | npt.NDArray[Any] | np.number[Any] | Sequence[float]
    Pair: TypeAlias = tuple[Input, Input] | list[Any] | Quantity | npt.NDArray[Any]
    Impulse: TypeAlias = tuple[Input, Input] | tuple[Input, Input, Input] | list[Any]
else:
    Value = Input = Pair = Impulse = Any

# The unit systems of explanations, reports, findings and figures.
UnitSystem: TypeAlias = Literal["si", "metric", "us"]
SYSTEMS: tuple[UnitSystem, ...] = get_args(UnitSystem)
_ANY_KIND = "a number with a unit"
_PLAIN = "a plain number without a unit"
_EXAMPLES = {
    "kg": "1100 (kg), '1100 kg' or '2425 lb'",
    "m/s": "22.2 (m/s), '80 km/h' or '50 mph'",
    "rad/s": "0.5 (rad/s) or '30 deg/s'",
    "m/s**2": "6.9 (m/s2), '6.9 m/s**2' or '22.5 ft/s**2'",
    "kg*m**2": "1800 (kg m2), '1800 kg*m**2', '1330 slug*ft**2' or '1330 lbf*ft*s**2'",
    "s": "0.1 (s) or '100 ms'",
    "m": "2.1 (m), '2.1 m' or '7 ft'",
    "rad": "1.57 (rad) or '90 deg'",
    "degree": "90 (deg)",
    "J": "42000 (J), '42 kJ' or '31000 ft*lbf'",
    "N*s": "9000 (N s) or '9 kN*s'",
    "kg*m**2/s": "900 (N m s) or '900 N*m*s'",
    "N/m": "35000 (N/m), '35 kN/m' or '200 lbf/in'",
    "N/m**2": "450000 (N/m2), '450 kPa' or '65 lbf/in**2'",
    "": "0.4",
    _ANY_KIND: "'80 km/h' or '1100 kg'",
}
# How the units used here are written, by their powers of kg, m, s and rad.
_WRITTEN = {
    (1, 1, -2, 0): "N",
    (1, 1, -1, 0): "N*s",
    (1, 2, -2, 0): "J",
    (1, 0, -2, 0): "N/m",
    (1, -1, -2, 0): "N/m**2",
}
_ROOTS = {
    "gram": "kg",
    "meter": "m",
    "second": "s",
    "radian": "rad",
    "kelvin": "K",
    "ampere": "A",
    "mole": "mol",
    "candela": "cd",
}
_SPOKEN_PROPORTIONS = frozenset({"percent", "permille", "ppm"})

# Patterns stay texts until the first unit is read, which compiles them. They match a text in one
# way at most: where there are several, all are tried before it is refused, and their number grows
# with its length.
_NUMBER = r"(?a:[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?|[+-]?inf(?=\s|$))"
_POWER = r"(?:\s*(?:\*\*|\^)\s*-?[0-9](?![0-9.])|[\u00b2\u00b3])?"
_NAME = r"(?:[^\W\d_]|[°%])(?:[^\W\d]|[°%])*"
_UNIT = rf"\(*{_NAME}{_POWER}\)*(?:(?:\s*(?:/|\*(?!\*)|·)\s*|\s+)\(*{_NAME}{_POWER}\)*)*"
# Names in a registry of somebody's own may have digits, as that of "cmH2O" has.
_UNIT_ELSEWHERE = _UNIT.replace(r"[^\W\d]|", r"\w|")
_WITH_COMMA = r"(?a:[+-]?\d[\d,]*,\d)"
_LONGEST_TEXT = 60
# By how much factors to SI of one unit may differ, such as one that was worked out in Decimal.
_ROUNDING = 1e-12
_ANGLES = ("degree", "turn", "arcminute", "arcsecond", "grade")
# Names that mean one thing to pint, or to one version of it, and another to their users.
_AMBIGUOUS = {
    "mil": (
        "a mil is one of 6400, 6300 or 6000 to the turn, and one of 64000 to older versions of "
        "pint: write 'deg' or 'rad'"
    ),
    "ton": (
        "a ton may be 1000 kg, 2000 lb or 2240 lb: write 'tonne', 'kg' or 'lb', or, in a text, "
        "'short_ton' or 'long_ton'"
    ),
    "quarter": "a quarter may be 25 lb, 28 lb, 500 lb or 560 lb: write 'kg' or 'lb'",
}
_US_UNITS = {"mile_per_hour", "mile", "foot", "inch", "yard", "pound", "force_pound", "slug"}
# Ways of writing units that pint does not read.
_MEANT = {
    **{unit.lower(): unit for unit in ("kg", "lb", "mph", "km/h", "deg", "ft", "kJ")},
    **dict.fromkeys(("kmh", "kmph"), "km/h"),
    **dict.fromkeys(("ftlb", "ftlbs", "lbft"), "ft*lbf"),
    "kgs": "kg",
    "lbm": "lb",
}
# Marks in place of a unit, and units of which pounds are a force.
_MARKS = {"'": "ft", '"': "in", "''": "in", "#": "lb"}
_FORCES = {"J", "N*s", "N/m", "N/m**2", "kg*m**2/s"}
_NEVER_PREFIXED = {
    "metric_ton",
    "force_kilogram",
}  # "mt" as milli-tonne; the kilopond of older versions of pint, 1000 kgf

# Held while a registry is asked for the first time: pint loads its own at its first use, and a
# second thread would find it half loaded. What has been read is looked up without it.
_first_use = RLock()
# Per registry: unit texts already read, and factors to SI. Neither keeps the registry alive. A
# registry that stands in ``_read`` is loaded.
_read: WeakKeyDictionary[Any, dict[str, Any]] = WeakKeyDictionary()
_known: WeakKeyDictionary[Any, dict[tuple[Any, ...], tuple[float, str]]] = WeakKeyDictionary()


def is_quantity(value: Any) -> bool:
    """Whether this is a Quantity of any pint registry; asked before numpy is, which would strip the
    unit in silence.
    """
    pint = sys.modules.get("pint")
    return pint is not None and isinstance(value, getattr(pint, "Quantity", ()))


def to_quantity(value: Any, unit: str) -> Any:
    """The SI value as a Quantity of pint's application registry, so that it mixes with the caller's
    own; tuples and mappings part by part. A word in place of a number, as of a contact at "touch",
    stays.
    """
    if isinstance(value, str):
        return value
    if isinstance(value, tuple):
        return tuple(to_quantity(part, unit) for part in value)
    if isinstance(value, (dict, MappingProxyType)):
        return MappingProxyType({name: to_quantity(part, unit) for name, part in value.items()})
    registry, _ = _registry()
    if registry.non_int_type.__name__ == "Decimal":
        # Such a registry cannot multiply floats. A float is a Decimal exactly.
        value = np.vectorize(registry.non_int_type, otypes=[object])(
            np.asarray(value, dtype=np.float64)
        )[()]
    # Not kept among the texts that were read: callers may not write every unit of a result, such
    # as 1/s.
    return registry.Quantity(value, _units_of(registry, {}, unit))


def magnitude(quantity: Any) -> Any:
    """The number or array of a Quantity, floats for Decimals; a Decimal that no float can hold
    stays, to be refused.
    """
    given = quantity.magnitude
    if type(given) is float:
        return given
    from decimal import Decimal

    parts = (
        given.ravel().tolist()
        if isinstance(given, np.ndarray) and given.dtype == object
        else [given]
    )
    if not all(type(part) is Decimal for part in parts):
        return given
    try:
        floats = np.array([float(part) for part in parts])
    except ValueError:  # a signalling NaN
        return given
    if any(
        part.is_finite()
        for part, read in zip(parts, floats.tolist(), strict=True)
        if math.isinf(read)
    ):
        return given
    return floats.reshape(np.shape(given)) if isinstance(given, np.ndarray) else float(floats[0])


def has_unit(value: Any) -> bool:
    """Whether a value has a unit; a text that is not a plain number is taken to have one."""
    if isinstance(value, str):
        return re.fullmatch(_NUMBER, value.strip()) is None
    # Decided by the units alone: a Decimal registry cannot convert a float to find out.
    return (isinstance(value, Usual) or is_quantity(value)) and bool(value._units)


def in_degrees(value: Any) -> bool:
    """Whether this is an angle to be read in degrees, which can be reduced exactly;
    radians cannot.
    """
    return (isinstance(value, Usual) or is_quantity(value)) and dict(value._units) in [
        {name: 1} for name in _ANGLES
    ]


def si_unit(value: Any, argument: str = "value", per_angle: bool = False) -> str:
    """The SI unit of the kind that a Quantity or a text is of, such as "m/s"; "" for a plain number
    or a proportion.

    An angle is "rad". Of kinds that share a dimension the library knows one: a moment reads "J".
    Refused, because here nothing else tells what was meant, are a count such as Hz, which may be of
    turns or of radians; grams, which are hardly ever meant; and an angle that is a part of another
    quantity, as in m/s/deg, unless ``per_angle``, as it may be a speed whose unit was mistyped.

    Examples
    --------
    >>> si_unit("80 km/h"), si_unit("5 deg"), si_unit("1330 lbf*ft*s**2"), si_unit("0.4")
    ('m/s', 'rad', 'kg*m**2', '')
    """
    if not has_unit(value):
        return ""
    quantity = parse(value, _ANY_KIND, argument) if isinstance(value, str) else value
    if isinstance(quantity, Usual):
        return quantity.si
    try:
        roots = dict(quantity._REGISTRY.get_root_units(quantity._units)[1]._units)
    except Exception as error:
        raise _bad_units(value, _ANY_KIND, argument, error) from None
    names = [str(name) for name in quantity._units]
    if names == ["gram"] or any(
        _is_count(quantity._REGISTRY, name) and name not in _SPOKEN_PROPORTIONS for name in names
    ):
        hint = "a drag factor is a plain number, an acceleration '6.9 m/s**2', a mass '0.7 kg'"
        if names != ["gram"]:
            hint = (
                "it counts, and could be meant as turns or as radians: write 'turn/s', 'rad/s' "
                "or 'deg/s', or a plain number"
            )
        raise UnitsError(
            f"{argument}: what {shown(value)} is meant to be is not clear from its unit; {hint}",
            code="bad_units",
            argument=argument,
            text=str(value),
        )
    if not roots.keys() <= _ROOTS.keys():
        raise _bad_units(value, _ANY_KIND, argument, None)
    powers = {unit: roots.get(root, 0) for root, unit in _ROOTS.items()}
    beside = any(power > 0 for unit, power in powers.items() if unit != "rad")
    if not per_angle and (powers["rad"] not in (0, 1) or (powers["rad"] and beside)):
        hint = (
            "; an angle stands above the line and alone there, as in rad/s: give any other as a "
            "plain number in SI"
        )
        raise _bad_units(value, _ANY_KIND, argument, None, hint)
    mechanical = tuple(powers[unit] for unit in ("kg", "m", "s", "rad"))
    if sum(map(abs, powers.values())) == sum(map(abs, mechanical)) and mechanical in _WRITTEN:
        return _WRITTEN[mechanical]
    return _written(powers)


def unit_as_written(given: Any) -> str:
    """The unit of a text as it stands there; of a Quantity, or a unit, its symbol."""
    if isinstance(given, str):
        return re.sub(_NUMBER, "", given.strip(), count=1).strip()
    return f"{getattr(given, 'units', given):~}".replace(" ", "")


def of_another_registry(text: str) -> bool:
    """Whether a text is a number with a unit that is not known here."""
    number, unit = re.match(_NUMBER, text.strip()), unit_as_written(text)
    if number is None or not re.fullmatch(_UNIT_ELSEWHERE, unit):
        return False
    try:
        parse(text, _ANY_KIND, "")
    except UnitsError:
        return True
    return False


def means_the_same_here(quantity: Any, unit: str, by: float, name: str) -> bool:
    """Whether the application registry, which reads texts, has this factor ``by`` to an SI unit for
    the unit of a Quantity, by this name; also where it does not know the name at all.
    """
    pint: Any = sys.modules["pint"]
    if quantity._REGISTRY is pint.get_application_registry().get():
        return True
    try:
        here = parse(f"1 {name}", unit, "")
    except UnitsError:
        return True
    try:
        found, _ = factor(here, unit, "", here)
    except UnitsError:
        return False
    return abs(found - by) <= _ROUNDING * abs(by)


def with_symbol(text: str) -> str:
    """A text with the symbol of its unit, such as mph, where it has the name that pint gives a
    Quantity's.
    """
    try:
        quantity = parse(text, _ANY_KIND, "")
    except UnitsError:
        return text
    named = quantity.name if isinstance(quantity, Usual) else f"{quantity.units}"
    if f" {named}" not in text:
        return text
    return text.replace(named, unit_as_written(_of_pint(quantity).units)).replace(".0 ", " ", 1)


class Texts(dict[str, str]):
    """What was given with a unit, as texts by argument; ``units`` has the units of what has no text
    of its own.

    That is an array, and any number of a result: it is shown in the units of what it was worked out
    from.
    """

    def __init__(self, *givens: Mapping[str, str] | None, units: Iterable[str] = ()) -> None:
        super().__init__()
        self.units = tuple(units)
        for given in givens:
            self.update(given or {})
            self.units += getattr(given, "units", ())


def texts_of(given: Mapping[str, Any] | None) -> tuple[Any, ...]:
    """All texts by which the units of a summary are chosen."""
    return () if given is None else (*given.values(), *getattr(given, "units", ()))


def system_given(texts: Iterable[str]) -> str:
    """The system, "si", "metric" or "us", that these texts with units agree on; of speeds if others
    differ; else SI.

    Speeds in m/s are what this library returns, so beside other units they do not count.
    """
    found = [_systems(text) for text in texts]
    for votes in (
        found,
        [vote for vote in found if "speed" in vote],
        [vote for vote in found if vote != {"si"}],
    ):
        agreed = set.intersection({*SYSTEMS, "speed"}, *votes) - {"speed"}
        if votes and agreed:
            return next(name for name in SYSTEMS if name in agreed)
    return "si"


def kinds_in_degrees(texts: Iterable[str]) -> set[str]:
    """Which of "angle" and "yaw rate" these texts with units have in degrees."""
    found = set()
    for text in texts:
        try:
            names = {str(name) for name in parse(text, _ANY_KIND, "")._units}
        except UnitsError:
            continue
        if "degree" in names:
            found.add("yaw rate" if names & {"second", "minute", "hour"} else "angle")
    return found


def _systems(text: str) -> set[str]:
    """The systems of units that a text may be in, and "speed" if it is one."""
    try:
        units = parse(text, _ANY_KIND, "")._units
    except UnitsError:
        return {*SYSTEMS}
    names = {str(name) for name in units}
    speed = (
        {"speed"}
        if names & {"mile_per_hour", "kilometer_per_hour"} or names >= {"kilometer", "hour"}
        else set()
    )
    if names & _US_UNITS:
        return speed | {"us"}
    if names & {"kilometer", "kilometer_per_hour"}:
        return speed | {"metric"}
    if names >= {"meter", "second"}:
        return speed | {"si"}
    return {"si", "metric"} if names & {"meter", "kilogram", "newton", "kilonewton"} else {*SYSTEMS}


def parse(text: str, unit: str, argument: str) -> Any:
    """A Quantity from one plain number and one unit: float reads the number, pint only the unit.
    A ``Usual`` where the table has the unit and no registry has been made that may know another.

    Whole strings are never handed to pint, which reads "80 km/h 5" as 400 km/h and "1 500 kg" as
    500 kg.
    """
    stripped = text.strip()
    number = re.match(_NUMBER, stripped) if len(stripped) <= _LONGEST_TEXT else None
    name = stripped[number.end() :].strip() if number else ""
    readable = (name in USUAL or re.fullmatch(_UNIT, name)) if name else not unit
    if number is None or not readable:
        how = "one plain number and one unit" if unit else "one plain number"
        instead = f"; write {how}, such as {example(unit)}"
        raise UnitsError(
            f"{argument}: cannot read {shown(text)}{_cure(stripped, unit)}{instead}",
            code="bad_units",
            argument=argument,
            given=text,
            instead=instead,
            text=text,
        )
    value = float(number.group())
    if math.isinf(value) and "inf" not in number.group():
        raise InputError(
            f"{argument} is too large: {shown(text)}", code="out_of_range", argument=argument
        )
    listed = usual(value, name) if _is_unused() else None
    if listed is not None:
        return listed
    registry, read = _registry()
    try:
        return registry.Quantity(value, _units_of(registry, read, name))
    except UnitsError as error:
        raise _bad_units(text, unit, argument, None, f"; {error}") from None
    except Exception as error:
        raise _bad_units(text, unit, argument, error) from None


def _of_pint(quantity: Any) -> Any:
    """The Quantity of pint, also of a number in a unit from the table."""
    if not isinstance(quantity, Usual):
        return quantity
    registry, read = _registry()
    return registry.Quantity(quantity.magnitude, _units_of(registry, read, quantity.written))


def _units_of(registry: Any, read: dict[str, Any], name: str) -> Any:
    """The units that a text names in a registry, kept in ``read``; UnitsError if it may be several.

    Upper and lower case count first also in a registry that passes over them: there "kg" may be
    kilogauss, and "kN" knots, as the order of a set has it.
    """
    units = read.get(name)
    if units is None:
        with _first_use:
            try:
                units = registry.parse_units(name, case_sensitive=True)._units
            except Exception:
                if registry.case_sensitive:
                    raise
                for part in re.findall(_NAME, name):
                    meant = ["".join(found) for found in registry.parse_unit_name(part)]
                    if len(meant) > 1 and part not in registry._units:
                        text = (
                            f"in this registry, made with `case_sensitive=False`, {part!r} may be "
                        )
                        text += (
                            f"{' or '.join(sorted(meant))}: write it in its own upper and lower "
                            "case"
                        )
                        raise UnitsError(text, code="bad_units") from None
                units = registry.parse_units(name, case_sensitive=False)._units
            read[name] = units
    return units


def _cure(text: str, unit: str) -> str:
    """The hint for a text that is nearly one number and one unit; "" for others."""
    if re.match(r"\[[\[\s]*(?:[-+.]?[0-9]|nan\b|[-+]?inf\b)", text):
        return (
            ": this is a printed array. A model of propagate is called with arrays of "
            "cases, and the unit belongs in the distribution, `Normal('30 mph', '2 mph')`"
        )
    if len(text) > _LONGEST_TEXT:
        return f": a text of {len(text)} characters is no number"
    if unit == "rad" and re.match(r"(north|south|east|west|[ns] ?\d|[nsew]{1,3}$)", text.lower()):
        return (
            ": angles are counted from the x axis, counter-clockwise; with x to the east, north "
            "is '90 deg'"
        )
    if mark := re.fullmatch(rf"({_NUMBER})\s*('|\"|''|#|\w+\.)", text):
        return f", {f'{mark[1]} {_MARKS.get(mark[2]) or mark[2][:-1]}'!r} can be read"
    feet = re.fullmatch(
        r"""([0-9]+)\s*(?:'|ft|feet)\s*([0-9]+(?:\.[0-9]+)?)\s*(?:"|''|in|inch|inches)""", text
    )
    if feet:
        return (
            f": feet and inches are two numbers, '{int(feet[1]) + float(feet[2]) / 12.0:.6g} ft' "
            "is one"
        )
    if re.match(_WITH_COMMA, text):
        return f": {no_comma(text)}" if without_commas(text) else ""
    if "\u2212" in text:
        return ": a minus is typed as a hyphen, " + repr(text.replace("\u2212", "-"))
    if re.search(r"\d\s*(?:-|\.\.|to|–|±|\+/?-)\s*\d", text):
        return (
            ": this is a range; `|ranges go to collisions.uncertainty.propagate|"
            "this key takes one number`"
        )
    cured = re.sub(r"(?<=[a-z])(\d)\b", r"**\1", re.sub(r"(?<=[a-z])-(?=[a-z])", "*", text))
    if cured != text:
        # Pounds beside seconds are a force: lb ft s2 is the yaw inertia of a US data sheet.
        cured = _as_force(cured) if unit in _FORCES or re.search(r"\bs(?:ec)?\b", cured) else cured
        return f": units are multiplied by * and raised by **, {cured!r}"
    return ""


def without_commas(text: str) -> list[str]:
    """What a text may mean whose number has commas: between thousands, or as a decimal point; empty
    for others.
    """
    text = text.strip()
    if not re.match(_WITH_COMMA, text):
        return []
    whole = [text.replace(",", "")] if re.match(r"(?a:[+-]?\d{1,3}(,\d{3})+(?!\d))", text) else []
    return whole + ([text.replace(",", ".")] if text.count(",") == 1 and "." not in text else [])


def no_comma(text: str) -> str:
    """The hint for a text whose number has commas."""
    return f"a number has no comma here, write {' or '.join(map(repr, without_commas(text)))}"


def _as_force(text: str) -> str:
    return re.sub(r"\b(?:lbs?|pounds?)\b", "lbf", text)


def factor(quantity: Any, unit: str, argument: str, given: Any) -> tuple[float, str]:
    """The factor to SI and the unit's name, cached for each registry: pint takes 60 us
    to find out.
    """
    if isinstance(quantity, Usual):
        by = quantity.factor(unit)
        if by is not None:
            return by, quantity.name if quantity.si else ""
        if isinstance(quantity, Worked):
            raise _of_another_kind(quantity, unit, argument)
        made = _of_pint(quantity)
        quantity, given = made, made if given is quantity else given
    registry = quantity._REGISTRY
    known = _known.get(registry)
    if known is None:
        known = _known.setdefault(registry, {})
    key = (quantity._units, unit, _is_short_ton(given))
    found = known.get(key)
    # An active context may give a unit another meaning until it ends, so nothing is kept of it.
    in_context = bool(getattr(getattr(registry, "_active_ctx", None), "contexts", ()))
    if found is None or in_context:
        with _first_use:
            found = _factor(quantity, unit, argument, given)
        if not in_context:
            known[key] = found
    return found


def scale(inside: str, label: str) -> float:
    """The factor from an SI unit to the unit that numbers are printed in."""
    found = SCALES.get((inside, label)) if _is_unused() else None
    if found is not None:
        return found
    return float(to_quantity(1.0, inside).m_as(to_quantity(1.0, label).units))


def _factor(quantity: Any, unit: str, argument: str, given: Any) -> tuple[float, str]:
    """The factor to SI and the unit's name, as pint finds them."""
    registry = quantity._REGISTRY
    try:
        wanted = registry.Unit(_units_of(registry, {}, unit))
        # Whole numbers, because a registry may count in Decimal.
        numbers = [registry.Quantity(number, quantity.units) for number in (0, 1, 2)]
        zero, one, two = (float(number.m_as(wanted)) for number in numbers)
        found = one, "" if numbers[1].unitless else f"{quantity.units}"
    except Exception as error:
        other = "; its registry, made with `case_sensitive=False`, may have taken another unit"
        beside = "" if registry.case_sensitive else other
        raise _bad_units(given, unit, argument, error, beside=beside) from None
    if zero != 0.0 or two != 2.0 * one:
        raise _bad_units(given, unit, argument, None)
    if (hint := _out_of_place(quantity, unit, wanted)) or (
        hint := _ambiguous_unit(quantity, given)
    ):
        raise _bad_units(given, unit, argument, None, hint)
    return found


def shown(value: Any) -> str:
    """What was given, short and marked as code, for a message."""
    return as_code(rendered(value))


def rendered(value: Any, longest: int = 80) -> str:
    """A short rendering of what was given, safe for any object."""
    try:
        # numpy's own text of a number names its class.
        plain = value.item() if isinstance(value, np.number) else value
        text = f"{value}" if is_quantity(value) else repr(plain)
    except Exception:
        text = f"a {type(value).__name__}"
    return text if len(text) <= longest else text[: longest - 3] + "..."


def example(unit: str) -> str:
    """An example of a number of this unit."""
    return _EXAMPLES.get(unit) or f"'1 {unit}'"


def _out_of_place(quantity: Any, unit: str, units_of_it: Any) -> str:
    """The hint for an angle, a proportion or a count that has no place in the wanted unit; ""
    without one.

    To pint they are numbers, by which it multiplies: "5 m/s/deg" would be 286 m/s, and 4 %*% would
    be 0.0004.
    """
    registry = quantity._REGISTRY
    units = {str(name): power for name, power in quantity._units.items()}
    if unit == "" and units in [{name: 1} for name in _SPOKEN_PROPORTIONS]:
        return ""
    wanted = _radians(registry, units_of_it)
    angles = {
        name: turned * power
        for name, power in units.items()
        if (turned := _radians(registry, name))
    }
    strange = [] if wanted and list(angles.values()) == [wanted] else list(angles)
    strange += [
        name
        for name in units
        if _is_count(registry, name) or (unit == "" and registry.Unit(name).dimensionless)
    ]
    if strange and unit == "rad/s" and not registry.Unit(strange[0]).dimensionless:
        return "; Hz counts turns: write 'deg/s', 'rad/s' or 'turn/s'"
    return (
        f"; {strange[0]} has no place in it, though pint takes it for a number" if strange else ""
    )


def _radians(registry: Any, unit: Any) -> Any:
    """The power of an angle in a unit."""
    return registry.get_root_units(unit)[1]._units.get("radian", 0)


def _is_count(registry: Any, name: str) -> bool:
    """Whether a unit is a number or a rate, such as Hz, bpm or curie, that holds no angle, as rpm
    does. pi is just a number.
    """
    powers = {str(kind): power for kind, power in registry.get_dimensionality(name).items()}
    if name == "pi" or powers not in ({}, {"[time]": -1}):
        return False
    return _radians(registry, name) != 1 or not registry.get_root_units(name)[1]._units.keys() <= {
        "radian",
        "second",
    }


def _is_short_ton(given: Any) -> bool:
    """Whether a text says which ton it means, by a name that a Quantity does not keep: to pint a
    short_ton is a ton.
    """
    if not isinstance(given, str) or "short_ton" not in given:
        return False
    return re.search(r"\btons?\b", given) is None


def _ambiguous_unit(quantity: Any, given: Any) -> str:
    """The hint for a unit whose name means different things to different people; "" for others."""
    registry = quantity._REGISTRY
    if set(map(str, quantity._units)) == {"meter", "hour"}:
        return "; m/h are metres per hour: write 'mph' for miles, 'km/h' for kilometres"
    for name in map(str, quantity._units):
        (prefix, root, _), *_ = registry.parse_unit_name(name) or [("", name, "")]
        if root in _AMBIGUOUS and not (root == "ton" and _is_short_ton(given)):
            return f"; {_AMBIGUOUS[root]}"
        powers = {str(kind): power for kind, power in registry.get_dimensionality(root).items()}
        is_rate = powers.pop("[time]", 0) == -1 and powers in ({"[length]": 1}, {})
        if prefix and (is_rate or root in _NEVER_PREFIXED):
            return f"; to pint it is a {prefix}-{root.replace('_', ' ')}"
    return ""


def _bad_units(
    given: Any, unit: str, argument: str, error: Exception | None, hint: str = "", beside: str = ""
) -> UnitsError:
    wanted = unit or _PLAIN
    text = str(given)
    dimensions = str(getattr(error, "dim1", "")).strip(" ()")
    is_weight = {*re.findall(r" ([*/]) (\[\w+\](?: \*\* [0-9.]+)?)", f" * {dimensions}")} == {
        ("*", "[mass]"),
        ("*", "[length]"),
        ("/", "[time] ** 2"),
    }
    name = unit_as_written(given) if isinstance(given, str) else ""
    joined = re.sub(r"\s", "", name)
    meant = _MEANT.get(joined.rstrip(".").lower(), name)
    # Of a name with blanks in it, only if they are all that is wrong.
    if meant != name and (joined == name or meant == joined.lower()):
        hint = f"; {name!r} is written {meant!r}"
    if unit == "kg" and is_weight:
        hint = "; a weight in lbf or N is a force: give the mass, in 'lb' or 'kg'"
    elif unit in _FORCES and _as_force(text) != text:
        hint = f"; pounds here are a force, {_as_force(text)!r}"
    elif unit == "kg*m**2" and "[time]" in dimensions and re.search("lb|pound", text):
        hint = "; pounds here are a force: write 'lbf*ft*s**2' or 'slug*ft**2'"
    # pint's own words are about dimensions, and the hint says it better.
    reason = f" ({error})" if str(error or "") and not hint else ""
    instead = f"; write for example {example(unit)}"
    return UnitsError(
        f"{argument}: {shown(given)} cannot be taken as {wanted}{reason}{hint}{beside}{instead}",
        code="bad_units",
        argument=argument,
        given=given,
        instead=instead,
        text=text,
    )


def _of_another_kind(worked: Worked, unit: str, argument: str) -> UnitsError:
    instead = f"; write for example {example(unit)}"
    if not worked.written:
        return UnitsError(
            f"{argument}: {worked.source} has no unit{instead}", code="bad_units", argument=argument
        )
    return UnitsError(
        f"{argument} is worked out by {worked.source}, which gives {worked.written}, and cannot be "
        f"taken as {unit or _PLAIN}{instead}",
        code="bad_units",
        argument=argument,
        instead=instead,
    )


def _written(powers: Mapping[str, Any]) -> str:
    """Powers of units as a text, numerators first."""
    above = [_to_the_power(unit, power) for unit, power in powers.items() if power > 0]
    below = [_to_the_power(unit, -power) for unit, power in powers.items() if power < 0]
    return "/".join(["*".join(above) or ("1" if below else ""), *below])


def _to_the_power(unit: str, power: Any) -> str:
    return unit if power == 1 else f"{unit}**{power:g}"


def _is_unused() -> bool:
    """Whether pint's application registry is its own and not made yet, so that nothing in it can
    differ from the table of usual units.
    """
    pint: Any = sys.modules.get("pint")
    if pint is None:
        return True
    # While another thread imports pint it may have no such function yet.
    ask = getattr(pint, "get_application_registry", None)
    registry = None if ask is None else ask().get()
    made_without = vars(registry).get("params") if registry is not None else None
    return type(registry).__name__ == "LazyRegistry" and made_without == ((), {})


def _registry() -> tuple[Any, dict[str, Any]]:
    """Pint's application registry, loaded, and the unit texts that were read in it.

    The caller's own quantities are made with this registry unless they chose another.
    """
    import pint

    known: Any = pint
    registry = known.get_application_registry().get()
    read = _read.get(registry)
    if read is None:
        with _first_use:
            registry.Quantity  # noqa: B018 - any attribute makes pint load its registry
            read = _read.setdefault(registry, {})
    return registry, read
