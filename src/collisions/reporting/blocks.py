"""What a report is made of, before it is HTML or Markdown."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from ..derivation.page import Page
from ..formatting import SI_UNITS

# Signs that join letters; what else has no shape of its own could make a line read as another.
_JOINERS = "\u200c\u200d"
_SAME = 1e-9  # relative: what six figures show of a number that they hold
_DIGITS = 12  # a number of no more was written by somebody; the record has those of all others


@dataclass(frozen=True, slots=True)
class Heading:
    """The heading of a part; ``level`` 1 is the title."""

    text: str
    level: int = 2


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A sentence or more; ``stressed`` if it must not be read over."""

    text: str
    stressed: bool = False


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of what it is of, the quantity, and its value."""

    head: tuple[str, str, str]
    rows: tuple[tuple[str, str, str], ...]


@dataclass(frozen=True, slots=True)
class Items:
    """A list, each line with what it begins with, which may be nothing."""

    lines: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure as SVG, and what it shows."""

    caption: str
    svg: str


@dataclass(frozen=True, slots=True)
class Working:
    """The derivation: Markdown with LaTeX, or plain text."""

    text: str


@dataclass(frozen=True, slots=True)
class Record:
    """What the report can be made again from, as JSON."""

    text: str


Block: TypeAlias = Heading | Paragraph | Table | Items | Picture | Working | Record


class Sheet(Page):
    """A page of the derivation that keeps what is put down, for the tables that a report shares with it."""

    def __init__(self, page: Page) -> None:
        super().__init__(page.system, False, page.deviations, page.ranges)
        self.blocks: list[Block] = []

    def as_given(self, value: float | None, kind: str, text: str | None) -> str:
        """A number in the units of the page, and how it was given; without a text with all the digits that were typed."""
        if value is None:
            return f"given as {plain(text or '')}"
        told = self.number(value, kind)
        if text is not None:
            return told if plain(text) == told else f"{told}, given as {plain(text)}"
        if not math.isfinite(value) or abs(float(f"{value:.{_DIGITS}g}") - value) > 1e-15 * abs(value):
            return told
        printed = float(told.split()[0])
        if abs(printed - value * self.system.scale(kind)) <= _SAME * abs(printed):
            return told
        return f"{told}, exactly {value:.{_DIGITS}g} {SI_UNITS[kind]}".rstrip()

    def title(self, text: str) -> None:
        self.blocks.append(Heading(text, 1))

    def heading(self, text: str) -> None:
        self.blocks.append(Heading(text))

    def say(self, text: str) -> None:
        self.blocks.append(Paragraph(text))

    def stress(self, text: str) -> None:
        self.blocks.append(Paragraph(text, stressed=True))

    def table(self, head: tuple[str, str, str], rows: Sequence[tuple[str, str, str]]) -> None:
        self.blocks.append(Table(head, tuple(rows)))

    def listed(self, lines: Sequence[str]) -> None:
        self.blocks.append(Items(tuple(("", line) for line in lines)))

    def name(self, text: str) -> str:
        return plain(text)

    def aside(self) -> Sheet:
        """Another sheet with the same units and digits, to take parts from."""
        return Sheet(self)


def plain(text: str) -> str:
    """A text that somebody gave, in one line and without signs that cannot be seen."""
    return "".join(map(_visible, " ".join(text.split())))


def visible(text: str) -> str:
    """A text of several lines without signs that cannot be seen."""
    return "\n".join("".join(map(_visible, line)) for line in text.split("\n"))


def _visible(sign: str) -> str:
    return sign if sign in _JOINERS or unicodedata.category(sign)[0] != "C" else "\ufffd"
