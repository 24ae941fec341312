"""What is said of a scene while it is followed: its notices, and which cases have no answer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np

from ..quantities.tables import Sentences
from ..quantities.units import texts_of
from .motion import Course
from .mover import Mover


class Notice(NamedTuple):
    """Something that the scene does not describe, or that limits its answer.

    Attributes
    ----------
    code : str
        A label that does not change between versions.
    sentence : str
        What was found, with names and times.
    time : float [s]
    movers : tuple of str
    """

    code: str
    sentence: str
    time: float
    movers: tuple[str, ...]


class Number(NamedTuple):
    """A number in a notice, in SI: its value, its kind and how many figures of it are written."""

    value: float
    kind: str
    figures: int


class Noted(NamedTuple):
    """A notice whose numbers are not written yet: its words, with numbers between them."""

    code: str
    words: Iterable[str | Number]
    time: float
    movers: tuple[str, ...]


class Told:
    """What is said of the cases of a scene: notices of a single one, what limits those of a batch,
    and why some have no answer.
    """

    def __init__(self, movers: Mapping[str, Mover], count: int, *, single: bool) -> None:
        self.single = single
        # Numbers in sentences, in the units that the vehicles were given in.
        self.say = Sentences(
            [text for mover in movers.values() for text in texts_of(mover.vehicle.given)]
        )
        self.notices: list[Noted] = []
        self.failed: Any = np.full(count, "", dtype=object)
        # Whether two vehicles of a case go through or into each other after their contact, whether
        # a drag does not act in one that has a duration, whether wheels stand on ground of
        # different friction in such a one, whether tyres act in one only for what an earlier one
        # leaves of it, whether two touch and no contact says what happens, and whether a touch is
        # passed over as nothing pushes in it.
        self.driven: Any = np.zeros(count, dtype=bool)
        self.dragless: Any = np.zeros(count, dtype=bool)
        self.mixed: Any = np.zeros(count, dtype=bool)
        self.partly: Any = np.zeros(count, dtype=bool)
        self.undescribed: Any = np.zeros(count, dtype=bool)
        self.passed_over: Any = np.zeros(count, dtype=bool)

    def notices_in(self, units: str | None) -> list[Notice]:
        """The notices with their numbers in a system of units; for None in that of the vehicles."""
        say = self.say if units is None else Sentences(units=units)
        return [
            Notice(
                noted.code,
                "".join(word if isinstance(word, str) else say(*word) for word in noted.words),
                noted.time,
                noted.movers,
            )
            for noted in self.notices
        ]

    def fail(self, cases: Any, code: str) -> None:
        """Leave some cases without an answer; of several reasons the first counts."""
        fresh = cases[self.failed[cases] == ""]
        self.failed[fresh] = code

    def gather(self, courses: Iterable[Course]) -> None:
        """Leave the cases without an answer of which a motion could not be followed."""
        for course in courses:
            fresh = (self.failed == "") & (course.failed != "")
            self.failed[fresh] = course.failed[fresh]

    def note(
        self, code: str, words: Iterable[str | Number], time: float, movers: tuple[str, ...]
    ) -> None:
        """Note something of the single case."""
        self.notices.append(Noted(code, words, time, movers))

    def note_once(
        self, code: str, words: Iterable[str | Number], time: float, movers: tuple[str, str]
    ) -> None:
        """Note something of a pair of which the last word counts."""
        self.notices[:] = [
            notice for notice in self.notices if (notice.code, notice.movers) != (code, movers)
        ]
        self.note(code, words, time, movers)

    @contextmanager
    def unsaid(self) -> Iterator[None]:
        """Within this context nothing is noted of tyres."""
        kept, said = (self.mixed.copy(), self.partly.copy()), len(self.notices)
        try:
            yield
        finally:
            self.mixed[:], self.partly[:] = kept
            del self.notices[said:]
