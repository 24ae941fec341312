"""The course of a scene: from contact to contact, in all cases at once, each on its own clock."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from .against import refuse_lost
from .ahead import at_start, look_ahead
from .between import pairs_of
from .came import MOST_CONTACTS, Came
from .contact import Contact
from .contradicted import check, endless, refuse_numbers
from .lasting import Lasting
from .motion import Course, Ground, follow_on
from .mover import Mover
from .notices import Told
from .striking import Striking

_MOST_ROUNDS = 200


class Followed:
    """A scene that was followed: its contacts in order, the courses of all movers, notices, and
    what became of each case.

    Touches that no contact describes are looked for until the last contact of each case, and
    ``to_rest`` also after it.
    """

    def __init__(
        self,
        movers: Mapping[str, Mover],
        contacts: Sequence[Contact],
        ground: Ground,
        order: Sequence[tuple[str, str]] | None,
        *,
        to_rest: bool = True,
    ) -> None:
        self._looks_to_rest = to_rest
        self.contacts, self.ground, self.order = contacts, ground, order
        self.single = ground.single
        self.count = int(np.prod(ground.shape or (), dtype=int))
        self.courses = {
            name: Course(name, mover, ground, self.count) for name, mover in movers.items()
        }
        self.told = Told(movers, self.count, single=ground.single)
        self.came = Came(self.count)
        self.lasting = Lasting(movers, self.count)
        self._pairs = pairs_of(self.courses, contacts)
        for contact in contacts:
            refuse_numbers(self.told, ground, contact)
        self._follow()

    def _follow(self) -> None:
        now = np.zeros(self.count)
        striking = Striking(
            self.contacts, self.courses, self._pairs, self.told, self.lasting, self.came
        )
        for pair in self._pairs:
            at_start(self.told, pair)
        left = {
            i: np.ones(self.count, dtype=bool)
            for i, contact in enumerate(self.contacts)
            if not contact.touches
        }
        alive = self.told.failed == ""
        # In the order of the movers, so that a refusal names the same one each time.
        paired = {name for pair in self._pairs if pair.shapes is not None for name in pair.names}
        outlined = [course for name, course in self.courses.items() if name in paired]
        for _ in range(_MOST_ROUNDS):
            times, rules = self._next(now, alive, left)
            alive = alive & (self.told.failed == "")
            for course in self.courses.values():
                alive &= course.failed == ""
            comes = alive & np.isfinite(times)
            many = self.came.many >= MOST_CONTACTS
            if (comes & many).any():
                self._endless(np.flatnonzero(comes & many), rules)
                comes = comes & ~many
            if not comes.any():
                break
            # Up to then others may come to touch; on the level all motion is known.
            some = np.flatnonzero(comes & self.ground.sloped)
            if len(some):
                comes[some] = refuse_lost(outlined, some, times[some])
            now = np.where(comes, times, now)
            for rule in np.unique(rules[comes]).tolist():
                which = np.flatnonzero(comes & (rules == rule))
                if rule in left:
                    left[rule][which] = False
                for some in striking.of_one_kind(rule, which, now):
                    striking.strike(rule, some, now)
        else:
            self._endless(np.flatnonzero(comes), rules)
        self.gather()
        check(self.told, self.came, self.courses, self.contacts, self._pairs, self.order)
        self.gather()

    def _next(self, now: Any, alive: Any, left: Mapping[int, Any]) -> tuple[Any, Any]:
        """When the next contact of each case comes, and by which rule; infinite where none does."""
        times, rules = np.full(self.count, np.inf), np.full(self.count, -1)
        for rule, waits in left.items():
            at = self.ground.cases(self.contacts[rule].at)
            sooner = waits & alive & (at < times)
            times, rules = np.where(sooner, at, times), np.where(sooner, rule, rules)
        # A contact that is due now needs no look ahead.
        looks = alive & ~(times <= now)
        moving = [pair for pair in self._pairs if pair.shapes is not None]
        for pair in moving:
            if pair.rule is not None:
                look_ahead(self.told, self.lasting, pair, now, looks)
                sooner = alive & (pair.due < times)
                times = np.where(sooner, pair.due, times)
                rules = np.where(sooner, pair.rule, rules)
        # What no contact describes is looked for as far as it is known how the vehicles go on.
        looks &= ~(times <= now)
        if not self._looks_to_rest:
            looks &= np.isfinite(times)
        for pair in moving:
            if pair.rule is None:
                look_ahead(self.told, self.lasting, pair, now, looks, times)
        return times, rules

    def to_rest(self, names: Iterable[str]) -> None:
        """Follow some movers to their rest, all at once."""
        with np.errstate(all="ignore"):
            every = np.arange(self.count)
            follow_on([self.courses[name] for name in names], np.full(self.count, np.inf), every)

    def gather(self) -> None:
        """Leave the cases without an answer of which a motion could not be followed."""
        self.told.gather(self.courses.values())

    def _endless(self, cases: Any, rules: Any) -> None:
        endless(self.told, self.came, self.contacts[int(rules[cases[0]])], cases)
