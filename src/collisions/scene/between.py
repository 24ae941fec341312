"""What is kept of two movers between their contacts: how they met, and when they next touch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np

from .contact import Contact
from .motion import Course
from .touching import Meeting, Shape

# Outlines close by this much [m/s] where a touch counts, and again after a contact.
LEAST_CLOSING, AGAIN = 0.02, 1.0
# A pair is one contact until its outlines were so far apart [m].
APART = 0.05
# Two that do not part are driven into each other where they overlap by so much more than at their
# contact [m].
DEEPER = 0.3
# Two that touch too slowly for a contact are pushed without a blow where they come to overlap by so
# much more [m].
PUSHED = 0.05


class Between:
    """Two movers: what contacts they may have, whether they are apart, and their next touch."""

    def __init__(
        self,
        one: Course,
        other: Course,
        shapes: tuple[Shape, Shape] | None,
        contacts: Mapping[int, Contact],
    ) -> None:
        self.courses, self.shapes = (one, other), shapes
        self.names, self.ground, count = (one.name, other.name), one.ground, one.count
        # The contact that comes when they touch, and those at a time of their own.
        self.rule: int | None = None
        self.contact: Contact | None = None
        self.timed = {i: contact for i, contact in contacts.items() if not contact.touches}
        for i, contact in contacts.items():
            if contact.touches:
                self.rule, self.contact = i, contact
                break
        self.apart: Any = np.ones(count, dtype=bool)
        # Whether they count as apart since an impact that drove them together again, although they
        # had parted by less than what ends a contact.
        self.anew: Any = np.zeros(count, dtype=bool)
        # From one to the other along the normal of their last contact; 0 before there was one.
        self.way: Any = np.zeros((2, count))
        # When that was [s].
        self.struck: Any = np.zeros(count)
        # Of their last contact, or of a touch that was passed over, when that was [s], the way from
        # one to the other, how deep their outlines overlapped, and how much deeper they may
        # come [m]: infinite where there was neither.
        self.met: Any = np.zeros(count)
        self.side: Any = np.zeros((2, count))
        self.depth: Any = np.zeros(count)
        # How deep a contact that was followed in time left them.
        self.crushed: Any = np.zeros(count)
        self.allowed: Any = np.full(count, np.inf)
        self.least: Any = np.full(count, LEAST_CLOSING)
        # The next touch and how fast it closes; NaN where it has to be looked for.
        self.touch: Any = np.full(count, np.nan)
        self.closing: Any = np.zeros(count)
        self.due: Any = np.full(count, np.inf)
        # Of a contact followed in time, when it is engaged as far as its place is taken from.
        self.seen: Any = np.full(count, np.nan)
        self.begun: Any = np.full(count, np.nan)
        self.axis: Any = np.zeros(count, dtype=int)
        self.deepest: Any = np.zeros(count, dtype=bool)
        self.nearest: Any = np.full(count, np.inf)
        self.nearest_at: Any = np.zeros(count)
        # Of a contact that takes the least model which is near enough, whether it was decided at
        # first touch that it is none that takes time.
        self.instant: Any = np.zeros(count, dtype=bool)
        # When they first touched, of the contact that they are in [s]: before the start -inf.
        self.first: Any = np.full(count, np.nan)
        # Touches that came: of which cases, when, and how fast they closed.
        self.touched: list[tuple[Any, Any, Any]] = []

    def meets(self, cases: Any, time: Any, met: Meeting, side: Any, allowed: float) -> None:
        """Keep how some cases meet, against which it is held how deep they come to overlap; of
        those that had a contact that stays what counts.
        """
        fresh = (self.allowed[cases] != DEEPER) | (allowed == DEEPER)
        some = cases[fresh]
        self.met[some] = np.broadcast_to(time, cases.shape)[fresh]
        self.side[:, some] = side[:, fresh]
        self.depth[some] = self.crushed[some] = np.maximum(-met.gap, 0.0)[fresh]
        self.allowed[some] = allowed

    def keep_touches(self, which: Any, time: Any) -> Any:
        """Keep the touches until a time that no rule describes, before they are looked for anew;
        the cases that have one.
        """
        if self.rule is not None:
            return which[:0]
        came = which[self.touch[which] <= time]
        if len(came):
            self.touched.append((came, self.touch[came], self.closing[came]))
        return came

    def began(self, which: Any, time: Any) -> Any:
        """When two that are in contact at a time of each case first touched [s]."""
        ahead = self.apart[which] & ~np.isfinite(self.touch[which])
        return np.fmin(np.where(ahead, time, self.first[which]), time)


def pairs_of(courses: Mapping[str, Course], contacts: Sequence[Contact]) -> list[Between]:
    """All twos of which one moves and that have outlines, or that have a contact."""
    shapes = {
        name: Shape.of(course.mover.outline)
        for name, course in courses.items()
        if course.mover.outline is not None
    }
    found = []
    for one, other in combinations(courses, 2):
        rules = {
            i: contact
            for i, contact in enumerate(contacts)
            if {contact.a, contact.b} == {one, other}
        }
        touching = any(contact.touches for contact in rules.values())
        two = courses[one], courses[other]
        both = None
        placed = all(course.placed and course.aimed for course in two)
        if one in shapes and other in shapes and (placed or touching):
            both = shapes[one], shapes[other]
        still = all(course.fixed for course in two)
        if rules or (both is not None and not still):
            found.append(Between(*two, both, rules))
    return found
