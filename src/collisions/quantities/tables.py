"""``Summary``: a result as a table that prints as plain text and shows itself in a notebook."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from functools import cached_property
from typing import Any

import numpy as np

from ..messages.errors import Status
from .formatting import KIND_OF, Numbers, check_system, clock, in_words, number_with_unit
from .printed_tables import PAGE, aligned, in_notebook
from .printed_tables import Part as Part
from .units import kinds_in_degrees, system_given
from .user_text import plain

_LARGEST = 1e9  # beyond it numbers are written with a power of ten
_NOT_KNOWN = "\u2013"
# Names of one of the two vehicles: "delta_v_a", "speed_a_after", "a.tyre_delta_v".
_SIDED = r"(?:(?P<lead>[ab])\.(?P<inner>.+)|(?P<stem>.+)_(?P<side>[ab])(?P<after>_after)?)"
# Names of angles that are directions, of which 180 and -180 degrees are one; others, such as a
# rotation, may count turns.
_DIRECTION = (
    r"(?:(?:straight_)?course|heading|pdof|normal_angle|crab_angles|"
    r"course_difference)(?:_[ab](?:_after)?)?"
)
_ANGLE_TOL = 1e-6  # more than the rounding of a direction in float32
_WORDS = {"delta v": "delta-V", "pdof": "PDOF", "ees": "EES"}


class Cells(Numbers):
    """Writes numbers for a table: rounded, with the unit; angles are in degrees in every system of
    units.
    """

    typeset = True
    # Which cases of a batch have an answer: ranges are of these alone.
    answered: Any = None
    # Whether arrays go on over time, in which headings count their turns.
    over_time = False

    def text(self, value: Any, unit: str | None, name: str = "") -> str:
        """A number in this SI unit; the range of an array, of directions by its name; other values
        as they are.
        """
        if value is None:
            return _NOT_KNOWN
        if isinstance(value, tuple):
            return ", ".join(self.text(part, unit, name) for part in value)
        if isinstance(value, np.ndarray):
            return self._range(value, unit, name)
        if isinstance(value, bool):
            return "yes" if value else "no"
        if not isinstance(value, float) or unit is None:
            return str(value) or "not known"
        kind = KIND_OF.get(unit)
        if not math.isfinite(value):
            return in_words(value)
        if kind is None or math.isinf(value * self.scale(kind)):
            return number_with_unit(f"{value:.4g}", unit)
        if not abs(value * self.scale(kind)) < _LARGEST:
            return number_with_unit(f"{value * self.scale(kind):.4g}", self.label(kind))
        if kind in ("angle", "yaw rate") and self.name == "si":
            return Cells("metric").text(value, unit, name)
        return self.answer(value, kind) + clock(name, value)

    def _range(self, values: Any, unit: str | None, name: str) -> str:
        """An array by its least and greatest value, of directions by the ends of their arc."""
        if isinstance(self.answered, np.ndarray):
            values = np.broadcast_to(values, self.answered.shape)[self.answered]
        if values.dtype.kind != "f" or unit is None:
            return ", ".join(map(str, np.unique(values).tolist())) or _NOT_KNOWN
        known = values[~np.isnan(values)]
        if not known.size:
            return in_words(math.nan)
        directions = re.fullmatch(_DIRECTION, name) and not self.over_time
        ends = _arc(known) if directions else (float(known.min()), float(known.max()))
        low, high = (self.text(end, unit) for end in ends)
        # The 1 of 1/m belongs to the unit.
        unit = re.sub(r"^.*\d(?!/)", "", high)
        return low if low == high else f"{low.removesuffix(unit)} to {high}"


def _arc(directions: Any) -> tuple[float, float]:
    """The ends of the shortest arc that holds all directions, rising: 174 to 186 degrees for 174
    and -174.

    Where it does not cross 180 degrees they are the least and the greatest value, and so for values
    that span more than a turn.
    """
    found = np.sort(directions, axis=None).astype(np.float64)
    low, high = float(found[0]), float(found[-1])
    if len(found) == 1 or not high - low <= math.tau + _ANGLE_TOL:
        return low, high
    gaps = np.diff(found)
    widest = int(np.argmax(gaps))
    if gaps[widest] <= math.tau - (high - low) + _ANGLE_TOL:
        return low, high
    low, high = float(found[widest + 1]), float(found[widest]) + math.tau
    back = math.tau if low > math.pi + _ANGLE_TOL else 0.0
    return low - back, high - back


def cells(units: Any, texts: Iterable[Any] = ()) -> Cells:
    """How a table writes its numbers: in the system named or, for None, in that of the texts the
    inputs were given as.
    """
    if units is None:
        return Cells(system_given(text for text in texts if isinstance(text, str)))
    check_system(units)
    return Cells(units)


_ROUND = 1e-12


class Sentences:
    """How sentences about a case write its numbers: called with an SI number and its kind, in the
    units of the inputs.

    Parameters
    ----------
    texts : iterable
        What the inputs were given as; the texts with units among it are read when the first number
        is written.
    units : str, optional
        The system of units of the page that the sentences are on, in place of that of the inputs.
    """

    def __init__(self, texts: Iterable[Any] = (), units: str | None = None) -> None:
        self._texts, self._units = texts, units

    @cached_property
    def _system(self) -> Cells:
        given = [text for text in self._texts if isinstance(text, str)]
        system = cells(self._units, given)
        system.in_degrees = frozenset(kinds_in_degrees(given))
        return system

    def __call__(self, value: float, kind: str, figures: int = 6) -> str:
        # A number that is too large for the unit stays as it is: the sentence is about something
        # else.
        system = self._system if math.isfinite(value * self._system.scale(kind)) else Cells("si")
        return f"{value * system.scale(kind) + 0.0:.{figures}g}{system.unit(kind)}"

    def at_least(self, value: float, kind: str, figures: int = 6) -> str:
        """A bound below, rounded up, so that it may be written as it is read."""
        return self._bound(value, kind, figures, ROUND_CEILING)

    def at_most(self, value: float, kind: str, figures: int = 6) -> str:
        """A bound above, rounded down."""
        return self._bound(value, kind, figures, ROUND_FLOOR)

    def _bound(self, value: float, kind: str, figures: int, rounding: str) -> str:
        scale = self._system.scale(kind)
        number = value * scale
        # A round number that rounding left beside itself is that number.
        if math.isfinite(number) and not math.isclose(
            float(f"{number:.{figures}g}"), number, rel_tol=_ROUND
        ):
            inside = Context(prec=figures, rounding=rounding).create_decimal(number)
            value = float(inside) / scale
        return self(value, kind, figures)

    def apart(self, values: Sequence[float], kind: str, figures: int = 6) -> list[str]:
        """Each of these numbers, with more figures where so few would write two of them alike."""
        texts: list[str] = []
        # Seventeen figures tell any two floats apart.
        for enough in range(figures, 18):
            texts = [self(value, kind, enough) for value in values]
            if len(set(texts)) == len(set(values)):
                break
        return texts


def said(value: float, kind: str, texts: Iterable[Any], figures: int = 6) -> str:
    """A number in a sentence, in the units that the inputs were given in."""
    return Sentences(texts)(value, kind, figures)


def spoken_system(texts: Iterable[Any]) -> str:
    """The system for sentences about inputs given as these texts: "us" if they are in US units,
    else "metric".
    """
    return "us" if cells(None, texts).name == "us" else "metric"


class Summary:
    """A result as a table. ``print`` writes it as plain text; a notebook shows it as HTML, with the
    folded part below.

    Attributes
    ----------
    title : str
    parts : tuple of Part
        Rows of texts, by part.
    notes : tuple of str
        Sentences below the table, such as the sign conventions.
    """

    def __init__(self, title: str, parts: Iterable[Part], notes: Iterable[str] = ()) -> None:
        self.title, self.parts, self.notes = (
            plain(title),
            tuple(part.plain() for part in parts if part.rows),
            tuple(map(plain, notes)),
        )

    def __str__(self) -> str:
        from textwrap import wrap

        shown = [part for part in self.parts if not part.folded]
        notes = [line for note in self.notes for line in wrap(note, PAGE)]
        return "\n".join([self.title, *aligned(shown), *notes])

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return "".join(in_notebook(self.title, self.parts, self.notes))


class Summarized:
    """Base of results with a summary: ``_parts`` gives its rows, ``_texts`` the texts that its
    inputs were given as.
    """

    __slots__ = ()

    def summary(self, units: str | None = None) -> Summary:
        """The result as a table, which ``print`` writes as text and a notebook shows.

        Parameters
        ----------
        units : {"si", "metric", "us"}, optional
            By default those that the inputs were given in, if they agree; otherwise SI. Angles are
            in degrees in each of them, but for SI in the summary of a ``Propagation``, a
            ``Posterior`` or an ``Output`` of these, which has radians for all but what was stated
            of inputs.

        Returns
        -------
        Summary
        """
        return self._summary(cells(units, given_texts(self)))

    def __repr__(self) -> str:
        return str(self.summary())

    def _summary(self, numbers: Cells) -> Summary:
        raise NotImplementedError

    def _texts(self) -> Iterable[Any]:
        return ()

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()


def given_texts(result: Summarized) -> list[str]:
    """The texts with units that the inputs of a result were given as."""
    return [text for text in result._texts() if isinstance(text, str)]


_NAME = re.compile(r"`|[a-z]\w*(?:[_=(\[]|\.\w)")


def as_sentence(text: str) -> str:
    """A statement, or a question, as a sentence of its own, with a capital and its stop; a name at
    its beginning, such as ``energy_loss`` or ``a.delta_v``, stays as it is written.
    """
    begins = text[:1] if _NAME.match(text) else text[:1].upper()
    ends = "" if text.endswith("?") else "."
    return f"{begins}{text[1:].rstrip('.')}{ends}"


def outcomes(status: Any) -> list[str]:
    """Sentences on cases that were refused or gain energy."""
    if isinstance(status, Status):
        sentence = f"{status.sentence}."
        if status > Status.ENERGY_GAIN:
            return [f"Refused: {sentence}"]
        return [] if status is Status.OK else [sentence[0].upper() + sentence[1:]]
    said = (
        (
            status > Status.ENERGY_GAIN,
            "were refused, for what their status says; the ranges are those of the others.",
        ),
        (status == Status.ENERGY_GAIN, "end with more energy than they began with."),
    )
    counts = ((np.count_nonzero(which), what) for which, what in said)
    return [f"{count} of {np.size(status)} cases {what}" for count, what in counts if count]


def all_numbers(rows: Iterable[tuple[str, str]]) -> Part:
    """The folded part with every attribute of a result."""
    return Part(list(rows), "All numbers, in SI", folded=True)


def sided(values: Iterable[tuple[str, Any, str | None]], numbers: Cells) -> list[Part]:
    """The rows of named values: those of the two vehicles side by side, the others below."""
    pairs: dict[str, dict[str, str]] = {}
    single: list[tuple[str, str]] = []
    for name, value, unit in values:
        found = re.fullmatch(_SIDED, name)
        text = numbers.text(value, unit, name)
        if found is None:
            single.append((label_of(name), text))
        else:
            label = found["inner"] or found["stem"] + (found["after"] or "")
            pairs.setdefault(label_of(label), {})[found["lead"] or found["side"]] = text
    both = [(label, *(of.get(side, _NOT_KNOWN) for side in "ab")) for label, of in pairs.items()]
    return [Part(both, columns=("A", "B")), Part(single)]


def label_of(name: str) -> str:
    """The name of an attribute in words."""
    words = re.sub(r"[_.]", " ", name)
    for word, written in _WORDS.items():
        words = re.sub(rf"\b{word}\b", written, words)
    return words
