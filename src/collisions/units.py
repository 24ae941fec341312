"""The door: numbers, arrays, unit strings and Quantities in, SI numbers out, and Quantities back on request.

The only file that names pint, which it loads when a unit first appears. Nothing behind the door ever sees a Quantity.
"""

from __future__ import annotations

import math
import re
import sys
import warnings
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias
from weakref import WeakKeyDictionary

import numpy as np

from .errors import InputError, ShapeError, SuspectUnitsWarning, UnitsError

if TYPE_CHECKING:
    import numpy.typing as npt
    from pint import Quantity

    class Value(float):
        """What an attribute holds, as a type checker sees it: a float in a single case, in a batch an array."""

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

    Input: TypeAlias = float | str | Quantity[Any] | npt.NDArray[Any] | np.number[Any] | Sequence[float]
    Pair: TypeAlias = tuple[Input, Input] | list[Any] | Quantity[Any] | npt.NDArray[Any]
else:
    Value = Input = Pair = Any

POSITIVE = "positive"
FINITE = "finite"
UNIT_INTERVAL = "unit interval"
NOT_NEGATIVE = "not negative"

_ANY_KIND = "a number with a unit"
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
    "N/m": "35000 (N/m), '35 kN/m' or '200 lbf/in'",
    "N/m**2": "450000 (N/m2), '450 kPa' or '65 lbf/in**2'",
    "": "0.4",
    _ANY_KIND: "'80 km/h' or '1100 kg'",
}
# How the units of what comes up here are written, by their powers of kg, m, s and rad.
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
_TURNS_OF_A_SCENE = 2.0 * math.pi * (1.0 + 1e-9)
# Above this a bare angle is probably in degrees, a bare yaw rate in degrees per second (20 rad/s is three turns a second).
_PLAUSIBLE = {"rad": _TURNS_OF_A_SCENE, "rad/s": 20.0}
_SPOKEN_PROPORTIONS = frozenset({"percent", "permille", "ppm"})
_COUNTS = (
    "hertz",
    "becquerel",
    "count",
    "counts_per_second",
    "percent",
    "permille",
    "ppm",
    "bit",
    "byte",
    "neper",
    "bel",
    "steradian",
)

# Patterns stay texts, which the first unit that appears compiles.
_NUMBER = r"(?a:[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?inf(?=\s|$))"
_POWER = r"(?:\s*(?:\*\*|\^)\s*-?[0-9](?![0-9.])|[\u00b2\u00b3])?"
_NAME = r"(?:[^\W\d_]|[°%])(?:[^\W\d]|[°%])*"
_UNIT = rf"\(*{_NAME}{_POWER}\)*(?:\s*(?:/|\*(?!\*)|·|\s)\s*\(*{_NAME}{_POWER}\)*)*"
_LONGEST_TEXT = 60
_DEEPEST = 32  # dimensions of a nested list; numpy itself stops at 64
# Read in degrees, which can be reduced exactly; radians cannot.
_ANGLES = ("degree", "turn", "arcminute", "arcsecond", "grade")

_known: WeakKeyDictionary[Any, dict[tuple[Any, str], tuple[float, str]]] = WeakKeyDictionary()


def is_quantity(value: Any) -> bool:
    """Whether this is a Quantity of any pint registry; asked before numpy is, which would strip the unit in silence."""
    pint = sys.modules.get("pint")
    return pint is not None and isinstance(value, getattr(pint, "Quantity", ()))


def to_quantity(value: Any, unit: str) -> Any:
    """The SI value as a Quantity of pint's application registry, so that it mixes with the caller's own; pairs part by part."""
    if isinstance(value, tuple):
        return tuple(to_quantity(part, unit) for part in value)
    return _registry().Quantity(value, unit or "dimensionless")


def has_unit(value: Any) -> bool:
    """Whether a unit is written with it; a text that is no plain number is taken to have one."""
    if isinstance(value, str):
        return re.fullmatch(_NUMBER, value.strip()) is None
    # Asked of the units alone: a registry that counts in Decimal cannot convert a float to find out.
    return is_quantity(value) and bool(value._units)


def si_unit(value: Any, argument: str = "value") -> str:
    """The SI unit of the kind that a Quantity or a text is of, such as "m/s"; "" for a plain number or a proportion.

    An angle is "rad". Of kinds with one dimension the library knows one: a moment reads "J". Refused, because here nothing
    else tells what was meant: a count such as Hz, which may be of turns or of radians, and grams, which are hardly ever meant.

    Examples
    --------
    >>> si_unit("80 km/h"), si_unit("5 deg"), si_unit("1330 lbf*ft*s**2"), si_unit("0.4")
    ('m/s', 'rad', 'kg*m**2', '')
    """
    if not has_unit(value):
        return ""
    quantity = _parse(value, _ANY_KIND, argument) if isinstance(value, str) else value
    try:
        roots = dict(quantity._REGISTRY.get_root_units(quantity._units)[1]._units)
    except Exception as error:
        raise _bad_units(value, _ANY_KIND, argument, error) from error
    names = [str(name) for name in quantity._units]
    if names == ["gram"] or any(name.endswith(_COUNTS) and name not in _SPOKEN_PROPORTIONS for name in names):
        hint = "a drag factor is a plain number, an acceleration '6.9 m/s**2', a mass '0.7 kg'"
        if names != ["gram"]:
            hint = "it counts, and could be meant as turns or as radians: write 'turn/s', 'rad/s' or 'deg/s', or a plain number"
        raise UnitsError(
            f"{argument}: what {shown(value)} is meant to be cannot be told from its unit; {hint}",
            code="bad_units",
            argument=argument,
            text=str(value),
        )
    if not roots.keys() <= _ROOTS.keys():
        raise _bad_units(value, _ANY_KIND, argument, None)
    powers = {unit: roots.get(root, 0) for root, unit in _ROOTS.items()}
    mechanical = tuple(powers[unit] for unit in ("kg", "m", "s", "rad"))
    if sum(map(abs, powers.values())) == sum(map(abs, mechanical)) and mechanical in _WRITTEN:
        return _WRITTEN[mechanical]
    return _written(powers)


def _written(powers: Mapping[str, Any]) -> str:
    """Powers of units as a text, numerators first."""
    above = [_to_the_power(unit, power) for unit, power in powers.items() if power > 0]
    below = [_to_the_power(unit, -power) for unit, power in powers.items() if power < 0]
    return "/".join(["*".join(above) or ("1" if below else ""), *below])


def _to_the_power(unit: str, power: Any) -> str:
    return unit if power == 1 else f"{unit}**{power:g}"


def _registry() -> Any:
    """Pint's application registry, which is the one the caller's own quantities are made with unless they chose another."""
    import pint

    registry: Any = pint
    return registry.get_application_registry()


class Door:
    """Reads the arguments of one call; ``close`` raises one error that names every wrong one."""

    def __init__(self, trusted: Collection[str] = ()) -> None:
        self.trusted = trusted
        self.problems: list[InputError] = []
        self.texts: dict[str, str] = {}

    def refuse(self, problem: InputError) -> float:
        self.problems.append(problem)
        return math.nan

    def close(self) -> None:
        if self.problems:
            raise self.error()

    def error(self) -> InputError:
        first = self.problems[0]
        if len(self.problems) == 1:
            return first
        kinds = {type(problem) for problem in self.problems}
        kind = kinds.pop() if len(kinds) == 1 else UnitsError if UnitsError in kinds else InputError
        text = "\n".join(f"- {problem}" for problem in self.problems)
        return kind(
            f"{len(self.problems)} arguments cannot be used:\n{text}",
            code=next((problem.code for problem in self.problems if type(problem) is kind), "several_arguments"),
            problems=tuple(self.problems),
        )

    def number(self, value: Any, unit: str, argument: str, domain: str = FINITE) -> Any:
        """A float or a locked float array in the given SI unit; scalars are checked against the domain."""
        try:
            read, text = _read(value, unit, argument)
        except InputError as problem:
            return self.refuse(problem)
        if text:
            self.texts[argument] = text
        if isinstance(read, np.ndarray):
            read.setflags(write=False)
        else:
            problem_found = _outside(read, domain, argument, value)
            if problem_found is not None:
                return self.refuse(problem_found)
        if not text and argument not in self.trusted:
            _warn_if_implausible(read, unit, argument)
        return read

    def pair(self, value: Any, unit: str, argument: str) -> tuple[Any, Any]:
        """Two numbers from a pair, each part a number, string, Quantity or array, or from one length-2 Quantity."""
        whole = value.magnitude if is_quantity(value) else value
        parts = value
        if isinstance(whole, np.ndarray):
            parts = tuple(value) if whole.shape == (2,) and whole.dtype.kind in "fiu" else None
        if not isinstance(parts, (tuple, list)) or len(parts) != 2:
            shape = f" of shape {whole.shape}" if isinstance(whole, np.ndarray) else ""
            self.refuse(
                ShapeError(
                    f"{argument} must be a pair (x, y), got {shown(value)}{shape}; for many points write "
                    f"(xs, ys) with one array each, such as (points[:, 0], points[:, 1])",
                    code="bad_shape",
                    argument=argument,
                )
            )
            return math.nan, math.nan
        return self.number(parts[0], unit, f"{argument}[0]"), self.number(parts[1], unit, f"{argument}[1]")

    def angle(self, value: Any, argument: str) -> tuple[Any, bool]:
        """An angle, and whether it is in degrees: those are handed on as given, so that they can be reduced exactly."""
        try:
            quantity = _parse(value, "rad", argument) if isinstance(value, str) else value
            if is_quantity(quantity) and dict(quantity._units) in [{name: 1} for name in _ANGLES]:
                degrees, text = _convert(quantity, "degree", argument, value)
                problem_found = None if isinstance(degrees, np.ndarray) else _outside(degrees, FINITE, argument, value)
                if problem_found is not None:
                    raise problem_found
                if text:
                    self.texts[argument] = value.strip() if isinstance(value, str) else text
                return degrees, True
        except InputError as problem:
            return self.refuse(problem), False
        return self.number(quantity, "rad", argument), False


def broadcast(values: Mapping[str, Any]) -> tuple[int, ...] | None:
    """The shape the arrays among these go together to; None without any. ShapeError names them all."""
    shapes = {name: value.shape for name, value in values.items() if isinstance(value, np.ndarray)}
    if not shapes:
        return None
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise ShapeError(f"these arrays do not broadcast together: {listed}", code="bad_shape") from None


def _read(value: Any, unit: str, argument: str) -> tuple[Any, str]:
    """The value in the unit, and how it was written if it came with one."""
    if type(value) is float:
        return value, ""
    if isinstance(value, str):
        return _convert(_parse(value, unit, argument), unit, argument, value)[0], value.strip()
    if is_quantity(value):
        return _convert(value, unit, argument, value)
    return _plain(value, argument, unit), ""


def _plain(value: Any, argument: str, unit: str) -> Any:
    """A float or a fresh float array from a number or an array without unit."""
    if isinstance(value, (bool, np.bool_, np.timedelta64)):
        raise _not_a_number(value, argument, unit)
    if isinstance(value, (int, float, np.integer, np.floating)):
        try:
            read = float(value)
        except OverflowError:
            read = math.inf
        if math.isinf(read) and (isinstance(value, (int, np.integer)) or not np.isinf(value)):
            raise InputError(
                f"{argument} is a number too large to be held as a float: {shown(value)}",
                code="out_of_range",
                argument=argument,
            )
        return read
    if isinstance(value, (list, tuple)):
        value = _from_sequence(value, argument, unit)
    elif not isinstance(value, np.ndarray):
        if not hasattr(value, "__array__") or hasattr(value, "units") or hasattr(value, "unit"):
            raise _not_a_number(value, argument, unit)
        try:
            value = value.__array__()
        except Exception as error:
            raise _not_a_number(value, argument, unit) from error
    if not isinstance(value, np.ndarray):
        raise _not_a_number(value, argument, unit)
    if type(value) not in (np.ndarray, np.memmap):
        raise InputError(
            f"{argument} is a {type(value).__module__}.{type(value).__name__}, whose mask or unit would be lost; give a plain "
            f"numpy array (masked values filled with nan), or a pint Quantity",
            code="not_a_number",
            argument=argument,
        )
    if value.dtype.kind not in "fiu":
        raise InputError(
            f"{argument} is an array of {value.dtype}; give an array of floats or integers, for example by .astype(float)",
            code="not_a_number",
            argument=argument,
        )
    kept = value.dtype.newbyteorder("=") if value.dtype == np.float32 else np.dtype(np.float64)
    with np.errstate(over="ignore"):
        array = np.array(value, dtype=kept)
    if value.dtype.itemsize > 8 and bool(np.any(np.isinf(array) & ~np.isinf(value))):
        raise InputError(f"{argument} holds numbers too large for a float64", code="out_of_range", argument=argument)
    return float(array) if array.ndim == 0 else array


def _from_sequence(value: Sequence[Any], argument: str, unit: str) -> Any:
    stack: list[tuple[Any, int]] = [(value, 0)]
    while stack:
        item, depth = stack.pop()
        if isinstance(item, (list, tuple)):
            if depth == _DEEPEST:
                raise ShapeError(f"{argument} is nested too deeply; give an array", code="bad_shape", argument=argument)
            stack.extend((part, depth + 1) for part in item)
        elif is_quantity(item) or isinstance(item, str):
            raise UnitsError(
                f"{argument} is a {type(value).__name__} with {shown(item)} in it; put the unit on the whole: "
                f"Quantity([1.0, 2.0], 'm/s'), or convert each to SI numbers first",
                code="bad_units",
                argument=argument,
            )
        elif isinstance(item, (bool, np.bool_, np.timedelta64)) or not (
            isinstance(item, (int, float, np.number)) or type(item) is np.ndarray
        ):
            raise _not_a_number(item, argument, unit)
    try:
        return np.array(value)
    except ValueError:
        raise ShapeError(
            f"{argument} is a {type(value).__name__} of unequal rows; give an array", code="bad_shape", argument=argument
        ) from None


def _parse(text: str, unit: str, argument: str) -> Any:
    """A Quantity from one plain number and one unit: float reads the number, pint only the unit.

    Whole strings are never handed to pint, which reads "80 km/h 5" as 400 km/h and "1 500 kg" as 500 kg.
    """
    stripped = text.strip()
    number = re.match(_NUMBER, stripped) if len(stripped) <= _LONGEST_TEXT else None
    name = stripped[number.end() :].strip() if number else ""
    if number is None or not (re.fullmatch(_UNIT, name) or (not name and not unit)):
        how = "one plain number and one unit" if unit else "one plain number"
        raise UnitsError(
            f"{argument}: cannot read {shown(text)}; write {how}, such as {_example(unit)}",
            code="bad_units",
            argument=argument,
            text=text,
        )
    try:
        registry = _registry()
        return registry.Quantity(float(number.group()), registry.parse_units(name))
    except Exception as error:
        raise _bad_units(text, unit, argument, error) from error


def _convert(quantity: Any, unit: str, argument: str, given: Any) -> tuple[Any, str]:
    """The magnitude in the unit, and the quantity as a text."""
    magnitude = _plain(quantity.magnitude, argument, unit)
    factor, name = _factor(quantity, unit, argument, given)
    text = f"{magnitude!r} {name}" if name and isinstance(magnitude, float) else ""
    if factor == 1.0:
        return magnitude, text
    if isinstance(magnitude, float):
        converted: Any = magnitude * factor
        overflows = math.isinf(converted) and not math.isinf(magnitude)
    else:
        infinite = np.count_nonzero(np.isinf(magnitude))
        with np.errstate(over="ignore"):
            magnitude *= factor
        converted, overflows = magnitude, bool(np.count_nonzero(np.isinf(magnitude)) > infinite)
    if overflows:
        raise InputError(f"{argument} is too large: {shown(given)}", code="out_of_range", argument=argument)
    return converted, text


def _factor(quantity: Any, unit: str, argument: str, given: Any) -> tuple[float, str]:
    """What to multiply the magnitude by and what its unit is called, kept for each registry: pint takes 60 us to find out."""
    registry = quantity._REGISTRY
    known = _known.get(registry)
    if known is None:
        known = _known[registry] = {}
    key = (quantity._units, unit)
    found = known.get(key)
    # An active context may give a unit another meaning until it ends, so nothing is kept of it.
    in_context = bool(getattr(getattr(registry, "_active_ctx", None), "contexts", ()))
    if found is None or in_context:
        try:
            # Whole numbers, because a registry may count in Decimal.
            zero, factor, two = (float(registry.Quantity(x, quantity.units).m_as(unit or "dimensionless")) for x in (0, 1, 2))
            found = factor, "" if quantity.unitless else f"{quantity.units}"
        except Exception as error:
            raise _bad_units(given, unit, argument, error) from error
        if zero != 0.0 or two != 2.0 * factor or _is_of_another_kind(quantity, unit):
            raise _bad_units(given, unit, argument, None)
        if not in_context:
            known[key] = found
    return found


def _is_of_another_kind(quantity: Any, unit: str) -> bool:
    """Units that pint calls dimensionless are still not one kind: an angle is no proportion, a count of turns no angle."""
    names = [str(name) for name in quantity._units]
    if unit == "":
        units = quantity._REGISTRY.Unit
        return any(units(name).dimensionless and name not in _SPOKEN_PROPORTIONS for name in names)
    return unit in ("rad", "rad/s") and any(name.endswith(_COUNTS) for name in names)


def _outside(value: float, domain: str, argument: str, given: Any) -> InputError | None:
    """The refusal of a scalar outside its domain, if it is."""
    if math.isnan(value) and domain in (POSITIVE, FINITE):
        return InputError(f"{argument} is NaN; give a number", code="not_finite", argument=argument)
    if domain == POSITIVE and not value > 0.0:
        return InputError(f"{argument} must be > 0 (inf allowed), got {shown(given)}", code="not_positive", argument=argument)
    if domain == UNIT_INTERVAL and not 0.0 <= value <= 1.0:
        code = "bad_restitution" if argument == "restitution" else "bad_fraction"
        return InputError(f"{argument} must be from 0 to 1, got {shown(given)}", code=code, argument=argument)
    if domain == NOT_NEGATIVE and not value >= 0.0:
        return InputError(
            f"{argument} must be >= 0 (inf allowed), got {shown(given)}: its direction is worked out, give the magnitude",
            code="bad_friction",
            argument=argument,
        )
    if domain == FINITE and math.isinf(value):
        return InputError(
            f"{argument} must be finite, got {shown(given)}; only mass, yaw_inertia and friction may be inf",
            code="not_finite",
            argument=argument,
        )
    return None


def _warn_if_implausible(value: Any, unit: str, argument: str) -> None:
    limit = _PLAUSIBLE.get(unit)
    if limit is None:
        return
    # fmin and fmax pass over NaN, and reductions make no temporary.
    if isinstance(value, np.ndarray):
        bounds = (
            (float(np.fmin.reduce(value, axis=None)), float(np.fmax.reduce(value, axis=None))) if value.size else (0.0, 0.0)
        )
        worst = max(-bounds[0], bounds[1])
    else:
        worst = abs(value)
    if worst > limit and not math.isinf(worst):
        degrees = "deg" if unit == "rad" else "deg/s"
        warnings.warn(
            SuspectUnitsWarning(
                f"{argument} = {worst:g} is read as {unit}; if degrees were meant, write '{worst:g} {degrees}'",
                code="suspect_units",
                argument=argument,
                value=worst,
            ),
            stacklevel=callers_level(),
        )


def callers_level() -> int:
    """The stack level of the first caller outside this package, where a warning belongs."""
    level = 1
    frame: Any = sys._getframe(1)
    package = __name__.partition(".")[0]
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame = frame.f_back
        level += 1
    return level


def _example(unit: str) -> str:
    return _EXAMPLES.get(unit) or f"'1 {unit}'"


def _not_a_number(value: Any, argument: str, unit: str) -> InputError:
    return InputError(
        f"{argument} must be a number, an array or a Quantity, such as {_example(unit)}; got {shown(value)} of type "
        f"{type(value).__name__}",
        code="not_a_number",
        argument=argument,
    )


def _bad_units(given: Any, unit: str, argument: str, error: Exception | None) -> UnitsError:
    wanted = unit or "a plain number without a unit"
    reason = f" ({error})" if error is not None else ""
    hint = ""
    text = str(given)
    is_timed = "[time]" in str(getattr(error, "dim1", ""))
    if unit == "kg" and is_timed:
        hint = "; a weight in lbf or N is a force: give the mass, in 'lb' or 'kg'"
    elif unit == "kg*m**2" and is_timed:
        hint = "; pounds here are a force: write 'lbf*ft*s**2' or 'slug*ft**2'"
    elif unit == "rad/s" and error is None:
        hint = "; Hz counts turns: write 'deg/s', 'rad/s' or 'turn/s'"
    return UnitsError(
        f"{argument}: {shown(given)} cannot be taken as {wanted}{reason}{hint}; write for example {_example(unit)}",
        code="bad_units",
        argument=argument,
        text=text,
    )


def shown(value: Any, longest: int = 80) -> str:
    """A short rendering of what was given, safe for any object."""
    try:
        text = f"{value}" if is_quantity(value) else repr(value)
    except Exception:
        text = f"a {type(value).__name__}"
    return text if len(text) <= longest else text[: longest - 3] + "..."
