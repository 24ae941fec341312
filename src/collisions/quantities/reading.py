"""The reader: the arguments of a call in, SI numbers out, and one error that names every argument
that cannot be used.

Nothing behind it ever sees a unit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ..kernels.elementwise import (
    AT_LEAST_ZERO,
    FINITE,
    INCOMPLETE,
    NOT_NEGATIVE,
    POSITIVE,
    RATIO,
    RESTITUTION,
    UNIT_INTERVAL,
    Domain,
)
from ..messages.errors import (
    CollisionsError,
    InputError,
    ShapeError,
    Status,
    SuspectUnitsWarning,
    UnitsError,
    as_marked,
)
from ..messages.marked import a_type_of, as_code, type_of
from ..messages.warning import warn
from .refusals import must_be
from .settings import Default, had_unit, unit_required
from .units import (
    Texts,
    example,
    factor,
    has_unit,
    in_degrees,
    is_quantity,
    magnitude,
    means_the_same_here,
    no_comma,
    parse,
    rendered,
    shown,
    si_unit,
    unit_as_written,
    without_commas,
)
from .usual_units import Usual, Worked

# Above this a bare angle is probably in degrees, a bare yaw rate in degrees per second (20 rad/s is
# three turns a second).
_PLAUSIBLE = {"rad": 2.0 * math.pi * (1.0 + 1e-9), "rad/s": 20.0}
# Units of the components of an impulse from outside: along x, y, and about the centre of mass.
OUTSIDE_UNITS = ("N*s", "N*s", "kg*m**2/s")
_MOST_DIMENSIONS = 24  # numpy itself stops at 32 in places, and some solvers add a few of their own


class ArgumentReader:
    """Reads the arguments of one call; ``close`` raises one error that names every wrong one."""

    def __init__(self, trusted: Collection[str] = ()) -> None:
        self.trusted = trusted
        self.problems: list[InputError] = []
        self.texts = Texts()

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
        text = "\n".join(f"- {as_marked(problem)}" for problem in self.problems)
        return kind(
            f"{len(self.problems)} arguments cannot be used:\n{text}",
            code=next(
                (problem.code for problem in self.problems if type(problem) is kind),
                "several_arguments",
            ),
            problems=tuple(self.problems),
        )

    def number(self, value: Any, unit: str, argument: str, domain: Domain = FINITE) -> Any:
        """A float or a locked float array in the given SI unit; scalars are checked against the
        domain.
        """
        try:
            read, text = _read(value, unit, argument)
        except InputError as problem:
            return self.refuse(problem)
        if isinstance(read, np.ndarray):
            read.setflags(write=False)
            self.texts.units += (text,) if text else ()
        else:
            if text:
                self.texts[argument] = text
            problem_found = _outside(read, domain, argument, value)
            if problem_found is not None:
                return self.refuse(problem_found)
        bare = not text and (type(value) is float or not is_quantity(value) or not value._units)
        if bare and argument not in self.trusted:
            strict = unit and unit_required(argument) and not isinstance(value, (Default, Worked))
            if strict and 0.0 < largest(read) < math.inf:
                return self.refuse(_without_unit(value, unit, argument))
            _warn_if_implausible(read, unit, argument)
        return read

    def impulse(self, value: Any, argument: str) -> tuple[Any, Any, Any]:
        """Components x, y [N*s] and, if there is a third, yaw [N*m*s] of an impulse
        from outside.
        """
        if not isinstance(value, (tuple, list)) or len(value) not in (2, 3):
            self.refuse(
                must_be(
                    argument,
                    "`(x, y)` or `(x, y, yaw)`: an impulse on the vehicle in N*s along the axes of "
                    "the scene and its moment about the centre of mass in N*m*s",
                    value,
                    code="bad_shape",
                    kind=ShapeError,
                )
            )
            return math.nan, math.nan, math.nan
        parts = zip((*value, 0.0)[:3], OUTSIDE_UNITS, strict=True)
        x, y, yaw = (
            self.number(part, unit, f"{argument}[{i}]") for i, (part, unit) in enumerate(parts)
        )
        return x, y, yaw

    def pair(self, value: Any, unit: str, argument: str) -> tuple[Any, Any]:
        """Two numbers from a pair, each part a number, string, Quantity or array, or from one
        length-2 Quantity.
        """
        whole = magnitude(value) if is_quantity(value) else value
        parts = value
        if isinstance(whole, np.ndarray):
            parts = tuple(value) if whole.shape == (2,) and whole.dtype.kind in "fiu" else None
        if not isinstance(parts, (tuple, list)) or len(parts) != 2:
            shape = f" of shape {whole.shape}" if isinstance(whole, np.ndarray) else ""
            self.refuse(
                must_be(
                    argument,
                    "a pair `(x, y)`",
                    value,
                    f"{shape}`|; for many points write (xs, ys) with one array each, such as "
                    "(points[:, 0], points[:, 1])|`",
                    code="bad_shape",
                    kind=ShapeError,
                )
            )
            return math.nan, math.nan
        return self.number(parts[0], unit, f"{argument}[0]"), self.number(
            parts[1], unit, f"{argument}[1]"
        )

    def angle(self, value: Any, argument: str) -> tuple[Any, bool]:
        """An angle, and whether it is in degrees; these are kept as given, so that they can be
        reduced exactly.
        """
        try:
            quantity = parse(value, "rad", argument) if isinstance(value, str) else value
            if in_degrees(quantity):
                degrees, text = _convert(quantity, "degree", argument, value)
                problem_found = (
                    None
                    if isinstance(degrees, np.ndarray)
                    else _outside(degrees, FINITE, argument, value)
                )
                if problem_found is not None:
                    raise problem_found
                if text and not isinstance(degrees, np.ndarray):
                    self.texts[argument] = value.strip() if isinstance(value, str) else text
                return degrees, True
        except InputError as problem:
            return self.refuse(problem), False
        return self.number(quantity, "rad", argument), False


def is_whole(value: Any) -> bool:
    """Whether this is an integer; a bool does not count, nor does a timedelta, which numpy counts
    among its integers.
    """
    return isinstance(value, (int, np.integer)) and not isinstance(value, (bool, np.timedelta64))


def mixed_units(given: Mapping[str, Any], argument: str = "") -> UnitsError | None:
    """The error for numbers of one kind, by name, of which some have a unit and others none; 0 is
    the same in every unit.
    """
    measured = [name for name, value in given.items() if has_unit(value)]
    zeros = [
        name
        for name, value in given.items()
        if (isinstance(value, float) or is_whole(value)) and value == 0
    ]
    bare = [name for name in given if name not in measured and name not in zeros]
    if not (measured and bare):
        return None
    return UnitsError(
        f"{bare[0]} = {shown(given[bare[0]])} has no unit, but {measured[0]} = "
        f"{shown(given[measured[0]])} has one; give each with its unit, or each as a number in SI",
        code="bad_units",
        argument=argument or bare[0],
    )


def broadcast(values: Mapping[str, Any]) -> tuple[int, ...] | None:
    """The common shape of the arrays among these values; None without any. ShapeError names them
    all.
    """
    shapes = {name: value.shape for name, value in values.items() if isinstance(value, np.ndarray)}
    if not shapes:
        return None
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise ShapeError(
            f"these arrays do not broadcast together: {listed}", code="bad_shape"
        ) from None


def widened(parts: Collection[Any], beside: Iterable[Any] = ()) -> Any:
    """The parts; float32 arrays are widened if any number in ``parts`` or ``beside``
    needs float64.
    """
    for part in parts:
        if isinstance(part, np.ndarray) and part.dtype == np.float32:
            break
    else:
        return parts
    # Adds a twentieth to the import of the package, and hardly anybody comes here.
    from .precision import precision

    kind = precision([*parts, *beside])
    return [
        part.astype(kind, copy=False) if isinstance(part, np.ndarray) else part for part in parts
    ]


def largest(value: Any) -> float:
    """The largest magnitude among the numbers, 0 without one; NaN is passed over."""
    return abs(_farthest(value))


def _farthest(value: Any) -> float:
    """The number of the largest magnitude, with its sign."""
    if not isinstance(value, np.ndarray):
        return float(value)
    # fmin and fmax pass over NaN, and reductions make no temporary.
    low, high = (float(bound.reduce(value, axis=None, initial=0.0)) for bound in (np.fmin, np.fmax))
    return low if -low > high else high


def warn_if_large(
    given: Any, read: Any, limit: float, argument: str, meaning: str, *units: str
) -> None:
    """Warns that a number without a unit is so large that it may have been meant in one of these
    units.
    """
    worst = _farthest(read)
    if limit < abs(worst) < math.inf and not (has_unit(given) or had_unit(argument)):
        _warn_of_size(worst, np.abs(read) > limit, "large", argument, meaning, units)


def warn_if_small(
    given: Any, read: Any, limit: float, argument: str, meaning: str, *units: str
) -> None:
    """Warns that a number above 0 without a unit is so small that it may have been meant in one of
    these units.
    """
    small = np.greater(read, 0.0) & np.less(read, limit)
    if np.any(small) and not (has_unit(given) or had_unit(argument)):
        least = float(np.min(read, where=small, initial=limit))
        _warn_of_size(least, small, "small", argument, meaning, units)


def _warn_of_size(
    worst: float, cases: Any, size: str, argument: str, meaning: str, units: Sequence[str]
) -> None:
    spelled = " or ".join(f"'{worst:g} {unit}'" for unit in units)
    warn(
        SuspectUnitsWarning(
            f"{argument} = {worst:g} is read as {meaning}; if another unit was meant, write "
            f"{spelled}",
            code="suspect_units",
            argument=argument,
            value=worst,
        ),
        cases,
        f"{argument} is so {size}, read as {meaning}, that {' or '.join(units)} may have been "
        "meant; then write the unit with the number",
    )


def _read(value: Any, unit: str, argument: str) -> tuple[Any, str]:
    """The value in the unit, and the text it was given as if it had a unit; of an array the text of
    one such unit.
    """
    if type(value) is float:
        return value, ""
    if (
        type(value) is np.ndarray
        and value.dtype == np.float64
        and 0 < value.ndim <= _MOST_DIMENSIONS
    ):
        return np.array(value), ""
    if isinstance(value, str):
        quantity = parse(value, unit, argument)
        return _convert(quantity, unit, argument, value)[0], value.strip() if has_unit(
            quantity
        ) else ""
    if is_quantity(value) or isinstance(value, Usual):
        return _convert(value, unit, argument, value)
    return _plain(value, argument, unit), ""


def _convert(quantity: Any, unit: str, argument: str, given: Any) -> tuple[Any, str]:
    """The magnitude in the unit, and the quantity written as a text; "" where its unit, of another
    registry, is another one to those who read the text.
    """
    number = _plain(magnitude(quantity), argument, unit)
    by, name = factor(quantity, unit, argument, given)
    if name and is_quantity(given) and not means_the_same_here(given, unit, by, name):
        name = ""
    text = f"{number if isinstance(number, float) else 1.0!r} {name}" if name else ""
    if by == 1.0:
        return number, text
    if isinstance(number, float):
        converted: Any = number * by
        overflows = math.isinf(converted) and not math.isinf(number)
    else:
        infinite = np.count_nonzero(np.isinf(number))
        with np.errstate(over="ignore"):
            number *= by
        converted, overflows = number, bool(np.count_nonzero(np.isinf(number)) > infinite)
    if overflows:
        raise InputError(
            f"{argument} is too large: {shown(given)}", code="out_of_range", argument=argument
        )
    return converted, text


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
        except Exception:
            raise _not_a_number(value, argument, unit) from None
    if not isinstance(value, np.ndarray):
        raise _not_a_number(value, argument, unit)
    if type(value) not in (np.ndarray, np.memmap):
        raise InputError(
            f"{argument} is a {type(value).__module__}.{type(value).__name__}, whose mask or "
            "unit would be lost; give a plain numpy array (masked values filled with nan), or a "
            "pint Quantity",
            code="not_a_number",
            argument=argument,
        )
    if value.ndim > _MOST_DIMENSIONS:
        raise ShapeError(
            f"{argument} is an array of {value.ndim} dimensions, and may have {_MOST_DIMENSIONS} "
            f"at most; give it as {argument}.ravel()",
            code="bad_shape",
            argument=argument,
        )
    if value.dtype.kind not in "fiu":
        parts, cure = (
            value.flat[:20].tolist(),
            "give an array of floats or integers, for example by .astype(float)",
        )
        if any(isinstance(part, str) or is_quantity(part) for part in parts):
            cure = _as_quantity(parts, argument, unit)
        raise InputError(
            f"{argument} is an array of {value.dtype}; {cure}",
            code="not_a_number",
            argument=argument,
        )
    dtype = value.dtype.newbyteorder("=") if value.dtype == np.float32 else np.dtype(np.float64)
    with np.errstate(over="ignore"):
        array = np.array(value, dtype=dtype)
    if value.dtype.itemsize > 8 and bool(np.any(np.isinf(array) & ~np.isinf(value))):
        raise InputError(
            f"{argument} holds numbers too large for a float64",
            code="out_of_range",
            argument=argument,
        )
    return float(array) if array.ndim == 0 else array


def _from_sequence(value: Sequence[Any], argument: str, unit: str) -> Any:
    stack: list[tuple[Any, int]] = [(value, 0)]
    while stack:
        item, depth = stack.pop()
        if isinstance(item, (list, tuple)):
            if depth == _MOST_DIMENSIONS:
                raise ShapeError(
                    f"{argument} is nested too deeply; give an array",
                    code="bad_shape",
                    argument=argument,
                )
            stack.extend((part, depth + 1) for part in item)
        elif is_quantity(item) or isinstance(item, str):
            raise UnitsError(
                f"{argument} is {a_type_of(value)} with {shown(item)} in it; "
                f"{_as_quantity(value, argument, unit)}",
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
            f"{argument} is {a_type_of(value)} of unequal rows; give an array",
            code="bad_shape",
            argument=argument,
        ) from None


def _as_quantity(values: Sequence[Any], argument: str, unit: str) -> str:
    """How a list of texts and Quantities is written as one Quantity, in the first unit in it; dots
    for what cannot be read.
    """
    commas = {part: without_commas(part) for part in values if isinstance(part, str)}
    note = next(
        (
            f"cannot read {shown(part)}: {no_comma(part)}; "
            for part, meant in commas.items()
            if meant
        ),
        "",
    )
    values = [
        commas[part][0] if isinstance(part, str) and commas[part] else part for part in values
    ]
    first = next((part for part in values if has_unit(part)), None)
    if first is None:
        return f"{note}give numbers, without quotes"

    def number(part: Any) -> str:
        try:
            # What a number without a unit was meant in is not known.
            return f"{_read(part, unit, argument)[0] / by:.10g}" if has_unit(part) else "..."
        except (InputError, TypeError):  # of an array among them, too
            return "..."

    try:
        name, unit = unit_as_written(first), unit or si_unit(first)
        by, _ = _read(f"1 {name}", unit, argument)
        parts = [number(part) for part in values]
    except InputError:
        parts, name = ["..."], example(unit).rpartition("'")[0].rpartition(" ")[2] or "%"
    whole = f"pint.Quantity([{rendered(', '.join(parts))[1:-1]}], {name!r})"
    python = f"put the unit on the whole: {as_code(whole)[1:-1]}, or give numbers in SI"
    return f"{note}`|{python}|write numbers in SI`"


def _not_a_number(value: Any, argument: str, unit: str) -> InputError:
    got = (
        "it was not given`|, or as None|`"
        if value is None
        else f"got {shown(value)}`| of type {type(value).__name__}|`"
    )
    got += "; write its mass, such as a.mass" if unit == "kg" and hasattr(value, "mass") else ""
    allowed = f"a number`|, an array or a Quantity| or a text`, such as {example(unit)}"
    return InputError(
        f"{argument} must be {allowed}; {got}",
        code="not_a_number",
        argument=argument,
        given=value,
        allowed=allowed,
    )


def _outside(value: float, domain: Domain, argument: str, given: Any) -> InputError | None:
    """InputError for a scalar outside its domain, else None."""
    for fault, status in domain.faults:
        if fault(value):
            return _out_of_domain(value, domain, status, argument, given)
    return None


def _out_of_domain(
    value: float, domain: Domain, status: Status, argument: str, given: Any
) -> InputError:
    must, hint = domain.name, f": {status.sentence}"
    if status is Status.NOT_FINITE and domain is not AT_LEAST_ZERO:
        if math.isnan(value):
            return InputError(
                f"{argument} is NaN; give a number", code=status.label, argument=argument
            )
        must, hint = "finite", "; only mass, yaw_inertia and friction may be inf"
    elif status is Status.NOT_POSITIVE:
        must, hint = "> 0 (inf allowed)" if domain is POSITIVE else "> 0", ""
    elif domain is RATIO:
        hint = ""
    elif domain is NOT_NEGATIVE:
        must, hint = ">= 0 (inf allowed)", ": its direction is worked out, give the magnitude"
    elif domain is INCOMPLETE:
        must, hint = "above -1 and at most 1", ": at -1 the bodies would pass untouched"
    elif domain in (UNIT_INTERVAL, RESTITUTION):
        must, hint = "from 0 to 1", ""
        if 1.1 <= value <= 100.0:
            hint = f"; if percent were meant, write '{value:g} %'"
        elif domain is RESTITUTION and -1.0 < value < 0.0:
            hint = (
                "; of bodies that pass or tear before a common velocity, the impulse solvers "
                "take it with `incomplete=True`"
            )
    return must_be(argument, must, given, hint, code=status.label)


def _warn_if_implausible(value: Any, unit: str, argument: str) -> None:
    limit = _PLAUSIBLE.get(unit)
    if limit is None:
        return
    worst = _farthest(value)
    if abs(worst) > limit and not math.isinf(worst) and not had_unit(argument):
        degrees = "deg" if unit == "rad" else "deg/s"
        warn(
            SuspectUnitsWarning(
                f"{argument} = {worst:g} is read as {unit}; if degrees were meant, write "
                f"'{worst:g} {degrees}'",
                code="suspect_units",
                argument=argument,
                value=worst,
            ),
            np.abs(value) > limit,
            f"{argument} is so large, read as {unit}, that degrees may have been meant; then "
            f"write the unit with the number, as '90 {degrees}'",
        )


def _without_unit(value: Any, unit: str, argument: str) -> UnitsError:
    written = example(unit).split("'")[1]
    return UnitsError(
        f"{argument} = {shown(value)} has no unit, and options(require_units=True) asks for one; "
        f"write for example {written!r}",
        code="bad_units",
        argument=argument,
    )


_CODES = {
    "m/s": "negative_speed",
    "J": "negative_energy",
    "m": "negative_length",
    "N/m": "negative_stiffness",
}


def amount(
    reader: ArgumentReader, value: Any, unit: str, name: str, hint: str = "give the magnitude"
) -> Any:
    """A number read through the reader; the elements of an array are checked later, by
    the solvers.
    """
    return at_least_zero(reader, reader.number(value, unit, name), value, name, _CODES[unit], hint)


def at_least_zero(
    reader: ArgumentReader, read: Any, given: Any, name: str, code: str, hint: str
) -> Any:
    """A number that was read; refused if it is a single number below zero."""
    if isinstance(read, float) and read < 0.0:
        return reader.refuse(must_be(name, ">= 0", given, f"; {hint}", code=code))
    return read


def single_number(
    reader: ArgumentReader, read: Any, name: str, text: str, argument: str = ""
) -> Any:
    """A number that was read; refused with the text, which follows its name, if it is an array."""
    if isinstance(read, np.ndarray):
        return reader.refuse(
            ShapeError(f"{name} {text}", code="bad_shape", argument=argument or name)
        )
    return read


def _refused(status: int, text: str, **fields: Any) -> CollisionsError:
    return InputError(text, code="refused_impact", status=Status(status).label, **fields)


def not_an_answer(
    answer: Any,
    kinds: tuple[type[Any], ...],
    function: str,
    *,
    instead: str = "",
    runs: bool = False,
) -> InputError:
    """The error for an argument ``impact`` of another type than these, with what to write; of a
    scene and a run its impact, or the whole where ``runs`` are taken.
    """
    names = [*(kind.__name__ for kind in kinds), *["Run"] * runs]
    *others, last = [f"{'an' if name[0] in 'AEIOU' else 'a'} {name}" for name in names]
    wanted = f"{', '.join(others)} or {last}" if others else last
    run = getattr(type(answer), "_run_in_words", "")
    if run and runs:
        told = f"{function}({run})"
    elif run and "Impact" in names:
        told = f"{function}({run}.impacts[0]) for the first impact"
    else:
        fit = "" if "Fit" in names else ", for a Fit with the values that it found"
        told = f"{function}(collisions.eccentric(...)){fit}{instead}"
    return must_be(
        "impact", wanted, answer, f"; write {told}", code="not_an_impact", got=type_of(answer)
    )


def need_one_case(
    answer: Any,
    kinds: tuple[type[Any], ...],
    function: str,
    *,
    instead: str = "",
    many: str = "",
    runs: bool = False,
    refused: Callable[..., CollisionsError] = _refused,
) -> None:
    """Raise unless the argument ``impact`` is a single result of one of these types.

    ``function`` is the name of the caller in messages; ``instead`` and ``many`` are advice for
    another type and for a batch; ``runs`` says that the caller takes a ``Run`` too; ``refused``
    makes the error of a refused case from its status, a text and fields.
    """
    if not isinstance(answer, kinds):
        if isinstance(answer, tuple) and answer and all(isinstance(one, kinds) for one in answer):
            raise InputError(
                f"impact must be one answer, got a tuple of {len(answer)}, all that fit; write "
                f"{function}(found[0]) for the first",
                code="not_an_impact",
                argument="impact",
            )
        raise not_an_answer(answer, kinds, function, instead=instead, runs=runs)
    # There are no refused fits: a fit raises instead.
    status = getattr(answer, "status", Status.OK)
    if isinstance(status, np.ndarray):
        how = "ask the solver again with the numbers of that case, such as mass=float(masses[0])"
        if hasattr(answer, "case"):
            first = 0 if status.ndim == 1 else (0,) * status.ndim
            how = (
                f"write {function}(impact.case({first})) for the first one; impact.to_columns() "
                "has the table of all"
            )
        raise ShapeError(
            f"impact is a batch of shape {status.shape}, and {function} takes one case: "
            f"{how}{many}",
            code="bad_shape",
            argument="impact",
        )
    if status > Status.ENERGY_GAIN:
        raise refused(
            int(status),
            f"impact was refused, so {function} has nothing to work on: {status.sentence}; mend "
            "its inputs and solve it again",
            argument="impact",
        )
