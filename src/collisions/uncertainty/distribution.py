"""Base classes of the uncertain inputs: read with units once, frozen, compared by value, shown with
their unit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import FrozenInstanceError
from itertools import pairwise
from typing import Any, ClassVar, TypeVar

import numpy as np

from ..kernels.elementwise import FINITE, UNCHECKED
from ..messages.errors import InputError, ShapeError, UnitsError
from ..messages.marked import as_code
from ..messages.warning import AGREES, Note
from ..quantities.attributes import equal
from ..quantities.formatting import SI_UNITS, Numbers, typeset
from ..quantities.reading import ArgumentReader, mixed_units
from ..quantities.refusals import must_be
from ..quantities.settings import units_required
from ..quantities.units import (
    example,
    factor,
    has_unit,
    is_quantity,
    means_the_same_here,
    parse,
    shown,
    si_unit,
    unit_as_written,
)
from .normal import both_tails

# Digits of a number that its unit may have rounded.
_ALL_DIGITS = 15
# Of a spread, or of the error of a number: to that it is printed.
_OF_SPREAD = 0.01
_NAMED = 4  # inputs at most, beside what was stated of them


class GivenUnit(str):
    """An SI unit that also has the unit its numbers were ``written`` in, and the ``factor`` from
    that to SI.
    """

    written: str
    factor: float

    @classmethod
    def of(cls, given: Any, argument: str) -> GivenUnit:
        """The unit of a text or a Quantity; the SI unit where that of a Quantity of another
        registry is another one to those who read it.
        """
        made = cls(si_unit(given, argument))
        quantity = parse(given, made, argument) if isinstance(given, str) else given
        made.factor = factor(quantity, made, argument, given)[0]
        made.written = unit_as_written(given)
        if is_quantity(given) and not means_the_same_here(given, made, made.factor, made.written):
            made.factor, made.written = 1.0, str(made)
        return made


class WithoutUnit(str):
    """The empty unit of numbers that were given as texts without one: ``text`` is the first.

    A bare number is in SI; a text needs its unit wherever the quantity has one.
    """

    text: str

    @classmethod
    def of(cls, text: str) -> WithoutUnit:
        """The unit of such a text."""
        made = cls()
        made.text = text
        return made


class Statement:
    """Base of all statements about a quantity: a frozen value of SI numbers and the unit they are
    in.

    ``_parts`` are what it was made of, by the names of the arguments; ``_derive`` takes them and
    sets all else. ``_range`` is the low, high and share that ``between`` was given; people read
    these in place of the parts that follow from them. ``source`` is what its number was worked out
    from, "" where that does not say, and ``notes`` are what was stated where it was found, such as
    by a fit; two statements of the same numbers are equal whatever these are.
    """

    __slots__ = ("_parts", "_range", "notes", "source", "unit")

    unit: str
    source: str
    notes: tuple[Note, ...]
    _words: ClassVar[str]
    # Parts that are not in the unit of the quantity, and their own: of degrees of freedom, "".
    _part_units: ClassVar[Mapping[str, str]] = {}
    _parts: dict[str, Any]
    _range: tuple[float, float, float] | None
    _derive: Callable[..., None]

    def _make(
        self, unit: str, given_range: tuple[float, float, float] | None = None, **parts: Any
    ) -> None:
        self._set(unit=unit, source="", notes=(), _parts=parts, _range=given_range)
        self._derive(**parts)

    def _set(self, **values: Any) -> None:
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        raise FrozenInstanceError(
            f"cannot change {name!r}: {type(self).__name__} is frozen, make a new one"
        )

    def __delattr__(self, name: str) -> None:
        raise FrozenInstanceError(
            f"cannot delete {name!r}: {type(self).__name__} is frozen, make a new one"
        )

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self.unit == other.unit and equal(self._parts, other._parts)

    def __hash__(self) -> int:
        return hash((type(self), self.unit, *self._parts.values()))

    def __reduce__(self) -> tuple[Any, ...]:
        made_of = type(self), self.unit, self._parts, self._range, self.source, self.notes
        return from_numbers, made_of

    def __repr__(self) -> str:
        shown = (
            f"{name}={show(part, self._part_units.get(name, self.unit), within=0.0)}"
            for name, part in self._parts.items()
            if part is not None
        )
        return f"{type(self).__name__}({', '.join(shown)})"

    def __str__(self) -> str:
        return self._written(self._words, self._parts)

    def _written(self, words: str, parts: Mapping[str, Any]) -> str:
        """The numbers in these words, with the unit of a range at its end."""
        units = {name: self._part_units.get(name, self.unit) for name in parts}
        own = [part for name, part in parts.items() if name not in self._part_units]
        within = narrowest(*(part for part in own if isinstance(part, float)))
        text = words.format(
            **{name: show(part, units[name], within) for name, part in parts.items()}
        )
        unit = (
            f" {self.unit.written}"
            if isinstance(self.unit, GivenUnit)
            else f" {self.unit}".rstrip()
        )
        return typeset(text.replace(f"{unit} to ", " to ") if unit else text)


class Distribution(Statement):
    """A quantity that is not known exactly, and how likely each of its values is.

    All numbers are bare SI floats, and describe the distribution as it is used: after truncation.

    Attributes
    ----------
    mean, sd : float
        Mean and standard deviation.
    skewness, kurtosis : float
        Third and fourth central moments over the third and fourth powers of ``sd``: 0 and 3 for a
        normal distribution.
    support : tuple of float
        Lowest and highest value.
    unit : str
        SI unit of these numbers, such as "m/s"; "" when none was given.
    source : str
        What the mean of a ``Normal`` was worked out from, such as the dents measured by
        ``reconstruct.crush_energy``; "" where that is not known.
    notes : tuple
        What a fit or a posterior stated of it, whose inputs it is one of: a study of it states
        that again.
    """

    __slots__ = ("kurtosis", "mean", "sd", "skewness", "support")

    mean: float
    sd: float
    skewness: float
    kurtosis: float
    support: tuple[float, float]

    def quantile(self, p: Any) -> Any:
        """Value below which the quantity lies with probability p.

        Parameters
        ----------
        p : float or array [1]
            Probability, from 0 to 1.

        Returns
        -------
        float or array
            In SI.

        Raises
        ------
        InputError
            A probability outside 0 to 1, or not a number.
        """
        p = probability(p)
        return _like(p, self._at(np.asarray(p), np.asarray(1.0 - p)))

    def scored(self, z: Any) -> Any:
        """Value that is as likely to be exceeded as z is by a standard normal variable.

        The quantile at the normal probability of z, without the digits that are lost in a
        probability near 1.

        Parameters
        ----------
        z : float or array [1]
            Standard normal score.

        Returns
        -------
        float or array
            In SI.

        Raises
        ------
        InputError
            A score that is NaN, or not a number.
        """
        reader = ArgumentReader()
        z = _plain_number(reader, z, "z")
        reader.close()
        if np.any(np.isnan(z)):
            raise InputError("z must be a number, got NaN", code="not_finite", argument="z")
        return _like(z, self._scored(np.asarray(z)))

    def _scored(self, z: Any) -> Any:
        return self._at(*both_tails(z))

    def _at(self, below: Any, above: Any) -> Any:
        """The values with these probabilities below and above them, which add up to 1."""
        raise NotImplementedError

    def _describe(
        self, mean: float, sd: float, skewness: float, kurtosis: float, support: tuple[float, float]
    ) -> None:
        """Set the moments; refused if one has overflowed."""
        if not np.all(np.isfinite((mean, sd, skewness, kurtosis))):
            raise self._beyond_floats()
        if not sd > 0.0:
            raise self._beyond_floats("its deviation is too small")
        self._set(mean=mean, sd=sd, skewness=skewness, kurtosis=kurtosis, support=support)

    def _beyond_floats(
        self, what: str = "its mean, its deviation or their ratio is too large"
    ) -> InputError:
        return InputError(
            f"{type(self).__name__}: {what} for a float64; look for a wrong unit or a slipped "
            "digit",
            code="out_of_range",
            argument=next(iter(self._parts)),
        )


def at_probabilities(distribution: Distribution, p: Any) -> Any:
    """The values of a distribution at an array of probabilities that needs no check."""
    return distribution._at(p, 1.0 - p)


def at_scores(distribution: Distribution, z: Any) -> Any:
    """The values of a distribution at an array of normal scores that needs no check."""
    return distribution._scored(z)


def _like(given: Any, found: Any) -> Any:
    """What was found for an array, or the number in it if a number was given."""
    return found if isinstance(given, np.ndarray) else float(found)


T = TypeVar("T", bound=Statement)


def from_numbers(
    kind: type[T],
    unit: str,
    parts: Mapping[str, Any],
    given_range: tuple[float, float, float] | None = None,
    source: str = "",
    notes: tuple[Note, ...] = (),
) -> T:
    """An instance from SI numbers, which are not read again."""
    made = object.__new__(kind)
    made._make(unit, given_range, **parts)
    made._set(source=source, notes=notes)
    return made


# Of a note that says how what a fit found goes together; ``Joint`` tells whether a study knows.
CORRELATED = "correlated"


def correlated(
    found: Mapping[str, T], correlation: Mapping[tuple[str, str], float]
) -> dict[str, T]:
    """The statements that a fit found, each with how their errors go together."""
    return {
        name: from_numbers(
            type(one),
            one.unit,
            one._parts,
            one._range,
            one.source,
            (
                *one.notes,
                Note(None, "", code=CORRELATED, fields={"name": name, "with": dict(correlation)}),
            ),
        )
        for name, one in found.items()
    }


def correlation_found(one: Statement, other: Statement) -> float:
    """The correlation of two inputs with which one fit found them; 0 where none is known."""
    of_one, of_other = (
        [note.fields for note in each.notes if note.code == CORRELATED] for each in (one, other)
    )
    for mine in of_one:
        for its in of_other:
            if mine["with"] == its["with"]:
                pair = mine["name"], its["name"]
                same = 1.0 if pair[0] == pair[1] else 0.0
                return float(mine["with"].get(pair, mine["with"].get(pair[::-1], same)))
    return 0.0


def found_by(study: str, found: Mapping[str, T], notes: Iterable[Note]) -> dict[str, T]:
    """The statements that a study found, each with what the study stated, but for its evidence
    agreeing with itself.
    """
    said = tuple(
        note._replace(sentence=f"from {study}: {note.sentence}")
        for note in notes
        if note.code != AGREES
    )
    return {
        name: from_numbers(type(one), one.unit, one._parts, one._range, one.source, said)
        for name, one in found.items()
    }


def notes_of_inputs(inputs: Iterable[tuple[str, Any]]) -> Iterator[Note]:
    """What was stated of the inputs of a study where they were found, each once."""
    names: dict[tuple[str, str], list[str]] = {}
    notes: dict[tuple[str, str], Note] = {}
    for name, one in inputs:
        for note in one.notes if isinstance(one, Statement) else ():
            if note.code == CORRELATED:
                continue
            key = note.code, note.sentence
            notes[key] = note
            names.setdefault(key, []).append(name)
    for key, note in notes.items():
        study, _, sentence = note.sentence.partition(": ")
        few = names[key] if len(names[key]) <= _NAMED else [*names[key][: _NAMED - 1], "others"]
        yield note._replace(sentence=f"{study} ({', '.join(few)}): {sentence}")


def stated_in(value: Statement, numbers: Numbers, kind: str) -> str:
    """What was stated of a quantity of this kind; bare numbers in the unit that it is written
    in.
    """
    if value.unit != "":
        return str(value)
    unit = GivenUnit(SI_UNITS[kind])
    unit.written = numbers.label(kind)
    unit.factor = 1.0 / numbers.scale(kind)
    return str(from_numbers(type(value), unit, value._parts, value._range))


def probability(given: Any, argument: str = "p") -> Any:
    """A probability or an array of them, as float64; texts and Quantities are refused."""
    reader = ArgumentReader()
    found = _plain_number(reader, given, argument)
    if reader.problems or not (
        np.min(found, initial=0.0) >= 0.0 and np.max(found, initial=1.0) <= 1.0
    ):
        raise must_be(argument, "a probability from 0 to 1", given, code="bad_fraction")
    return found


def _plain_number(reader: ArgumentReader, given: Any, argument: str) -> Any:
    """A float64 or an array of them, from a value without unit."""
    if isinstance(given, str) or is_quantity(given):
        return reader.refuse(must_be(argument, "a plain number", given, code="not_a_number"))
    found = reader.number(given, "", argument, UNCHECKED)
    return found.astype(np.float64, copy=False) if isinstance(found, np.ndarray) else found


def show(value: Any, unit: str, within: float = math.inf) -> str:
    """A number of an input as people read it, in the unit it was given in: four digits, or all
    before the point, and more where it would be further than ``within`` [SI] from the number.
    """
    if isinstance(value, tuple):
        return f"({', '.join(show(part, unit, within) for part in value)})"
    if not isinstance(value, float):
        return str(value)
    if isinstance(unit, GivenUnit):
        within = within / abs(unit.factor)
        value, unit = value / unit.factor, unit.written
    text = f"{value:.0f}" if 1e4 <= abs(value) < 1e15 else f"{value:.4g}"
    for digits in range(5, _ALL_DIGITS + 1):
        if not abs(float(text) - value) > within:
            break
        text = f"{value:.{digits}g}"
    return f"{text} {unit}" if unit else text


def narrowest(*numbers: float | None) -> float:
    """To what the numbers of a statement are printed: a hundredth of what is between them."""
    there = sorted(one for one in numbers if one is not None and math.isfinite(one))
    apart = [more - less for less, more in pairwise(there) if more > less]
    return _OF_SPREAD * min(apart, default=math.inf)


def read_alike(
    needed: Mapping[str, Any], optional: Mapping[str, Any] | None = None, arrays: bool = False
) -> tuple[list[Any], str]:
    """SI numbers of one kind, and their unit: all have a unit or none has; an optional one may be
    None.
    """
    optional = optional or {}
    given = {**needed, **{name: value for name, value in optional.items() if value is not None}}
    measured = [name for name, value in given.items() if has_unit(value)]
    texts = [value for value in given.values() if isinstance(value, str)]
    unit: str = ""
    if measured:
        unit = GivenUnit.of(given[measured[0]], measured[0])
    elif texts:
        unit = WithoutUnit.of(texts[0])
    if (mixed := mixed_units(given)) is not None:
        raise mixed
    reader = ArgumentReader()
    numbers = {
        name: reader.number(value, unit, name, UNCHECKED if name in optional else FINITE)
        for name, value in given.items()
    }
    refused = {problem.fields.get("argument") for problem in reader.problems}
    for name, number in numbers.items():
        if (
            name in optional
            and name not in refused
            and isinstance(number, float)
            and not math.isfinite(number)
        ):
            what = "is NaN" if math.isnan(number) else f"must be finite, got {shown(given[name])}"
            instead = (
                "leave it out for a sharp bound"
                if name == "error"
                else (
                    "write `|None for an end that is open|-inf for a lower end that is open, inf "
                    "for an upper one`"
                )
            )
            reader.refuse(InputError(f"{name} {what}; {instead}", code="not_finite", argument=name))
        if isinstance(number, np.ndarray) is not arrays and not reader.problems:
            what = (
                "`|an array or a list|a list` of values"
                if arrays
                else "one number; for a set of measured values use Samples"
            )
            reader.refuse(must_be(name, what, given[name], code="bad_shape", kind=ShapeError))
    reader.close()
    return [numbers.get(name) for name in (*needed, *optional)], unit


def missing_unit(label: str, stated: str, wanted: str) -> UnitsError | None:
    """The error for numbers stated without a unit where the quantity is in ``wanted``; None where
    they may be: bare numbers are in SI, unless options(require_units=True), and texts are not.
    """
    if not wanted or stated or isinstance(stated, GivenUnit):
        return None
    # Of the examples the first one that is a text with its unit.
    text = example(wanted).split("'")[1]
    written = f"write for example {text!r}"
    if isinstance(stated, WithoutUnit):
        got = f" = {shown(stated.text)} has no unit; {written}"
    elif units_required.get():
        got = f" has no unit, and options(require_units=True) asks for one; {written}"
    else:
        return None
    return UnitsError(f"{as_code(label)}{got}", code="bad_units", argument=label)


def check_order(low: float, high: float, what: str = "low and high", unit: str = "") -> None:
    """Refuse a range without width; for angles, with a hint on how to count on across the end of a
    turn.
    """
    if low < high:
        return
    hint = (
        "exchange them"
        if high < low
        else "of a quantity that is known exactly give the number itself"
    )
    start, end = math.degrees(low), math.degrees(high)
    if unit == "rad" and high < low:
        onwards = (end - start) % 360.0
        if 0.0 < onwards < 180.0:
            hint = (
                "an angle that goes on across the end of the turn is counted on: write "
                f"'{start:.6g} deg' and '{start + onwards:.6g} deg'"
            )
    raise must_be(
        what,
        "in rising order",
        (low, high),
        f"; {hint}",
        code="bad_range",
        got=f"{show(low, unit)} and {show(high, unit)}",
        named="low",
    )
