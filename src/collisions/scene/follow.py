"""The course of a scene: from contact to contact, in all cases at once, each on its own clock."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext, suppress
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from ..impact.impact import Impact, way_to_separation
from ..impact.inputs import OnFailure, part_of
from ..impact.solvers import eccentric, linear_central, oblique_central, solve, time_resolved
from ..kernels.contact_laws import FRICTION, RULES
from ..messages.errors import (
    CollisionsError,
    InputError,
    MissingInputError,
    NoSolutionError,
    Status,
    placed,
)
from ..messages.warning import NO_ANSWER, of_some, quietly
from ..quantities.settings import in_si
from ..quantities.tables import Sentences
from ..quantities.units import texts_of
from ..vehicle.drag import in_plan
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import needed
from .contact import IN_TIME, USUAL_DELAY, Contact
from .ledger import tyres_in_part, tyres_where_they_are
from .meanwhile import During, InTime
from .motion import Course, Ground, body_at, follow_on, moved
from .mover import Mover
from .touching import (
    LONGEST_SEARCH,
    TOUCHING,
    Meeting,
    Pair,
    Shape,
    closing_of,
    distance_outside,
    engaged,
    first_apart,
    first_touch,
    overlap_of,
    struck_face,
)

# Outlines close by this much [m/s] where a touch counts, and again after a contact.
_LEAST_CLOSING, _AGAIN = 0.02, 1.0
# A pair is one contact until its outlines were so far apart [m].
APART = 0.05
MOST_CONTACTS = 20
# Touches in a row that are too slow for a contact, after which two are not followed further.
_MOST_PASSED = 100
_MOST_ROUNDS = 200
# Outlines overlap at the start beyond this [m].
_OVERLAPS = 1e-6
# Two that do not part are driven into each other where they overlap by so much more than at their
# contact [m].
_DEEPER = 0.3
# Two that touch too slowly for a contact are pushed without a blow where they come to overlap by so
# much more [m].
_PUSHED = 0.05
# Between their contact and the time they part, where it is looked how deep they are.
_SHARES = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
# A time [s] that is later than any other.
_LONG = 1e300
# Two that are pushed on as evenly as this [m/s**2] go on evenly beside each other.
_NO_PUSH = 1e-8
# Later than this [s] motion that nothing slows comes together by rounding alone.
_SOON = 1e3
# So many moments are looked at for how near two vehicles come that do not touch.
_LOOKS = 129
# Faces within this angle [rad] of each other meet face to face.
_FACE_TO_FACE = math.radians(1.0)
# So long [s] after a touch it is seen at the least of which edge at a corner the overlap stays
# least.
_BRIEF = 1e-3
# A contact at a time that comes within this [s] of a touch is that of the touch.
_LATE = 0.5
# Outlines may be this far apart [m] at a contact at a time with a normal and a point of its own,
# and the point this far outside of the nearer one. Positions to 10 cm each and outlines that are
# rounder than drawn explain 0.3 m, at which `diagnose` has a finding; nothing explains more than
# what a contact crushes.
_FAR = 0.5
# Rounds in which it settles how long a contact lasts in which tyres act for a part.
_ROUNDS = 3
# Two contacts that share less of their duration than this share nothing.
_SHARED = 1e-9
# How exactly it is found when two first touched: a share of 2 to the power of minus this.
_HALVINGS = 40
# Axes are those of one face within the angle whose cosine this is.
_ALIKE = math.cos(math.radians(5.0))
# What a negative number of a contact is called.
_NEGATIVE = {"at": "negative_time", "depth": "negative_length", "delay": "negative_duration"}
# Outlines whose edges are this near in line [m] cross nowhere in particular.
_IN_LINE = 0.01


class Hit(NamedTuple):
    """One contact of some cases: which rule, when, the impact, whether it was at its deepest, and
    which impact of each case it is.
    """

    rule: int
    which: Any
    time: Any
    impact: Impact
    deepest: Any
    number: Any


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


class _Between:
    """Two movers: what contacts they may have, whether they are apart, and their next touch."""

    def __init__(self, one: str, other: str, shapes: tuple[Shape, Shape] | None, count: int):
        self.names = one, other
        self.shapes = shapes
        self.rule: int | None = None
        self.timed: list[int] = []
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
        self.least: Any = np.full(count, _LEAST_CLOSING)
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
        fresh = (self.allowed[cases] != _DEEPER) | (allowed == _DEEPER)
        some = cases[fresh]
        self.met[some] = np.broadcast_to(time, cases.shape)[fresh]
        self.side[:, some] = side[:, fresh]
        self.depth[some] = self.crushed[some] = np.maximum(-met.gap, 0.0)[fresh]
        self.allowed[some] = allowed


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
        self.movers, self.contacts, self.ground, self.order = movers, contacts, ground, order
        self.single = ground.single
        self.count = int(np.prod(ground.shape or (), dtype=int))
        self.courses = {
            name: Course(name, mover, ground, self.count) for name, mover in movers.items()
        }
        # Numbers in sentences, in the units that the vehicles were given in.
        self._say = Sentences(
            [text for mover in movers.values() for text in texts_of(mover.vehicle.given)]
        )
        self.hits: list[Hit] = []
        self.notices: list[Noted] = []
        self.failed: Any = np.full(self.count, "", dtype=object)
        # Whether two vehicles of a case go through or into each other after their contact, whether
        # a drag does not act in one that has a duration, whether wheels stand on ground of
        # different friction in such a one, whether tyres act in one only for what an earlier one
        # leaves of it, whether two touch and no contact says what happens, and whether a touch is
        # passed over as nothing pushes in it.
        self.driven: Any = np.zeros(self.count, dtype=bool)
        self.dragless: Any = np.zeros(self.count, dtype=bool)
        self.mixed: Any = np.zeros(self.count, dtype=bool)
        self.partly: Any = np.zeros(self.count, dtype=bool)
        self.undescribed: Any = np.zeros(self.count, dtype=bool)
        self.passed_over: Any = np.zeros(self.count, dtype=bool)
        # The contacts of each case in order, and when they came; -1 and NaN after the last.
        self.rules: Any = np.full((MOST_CONTACTS, self.count), -1)
        self.times: Any = np.full((MOST_CONTACTS, self.count), np.nan)
        self.many: Any = np.zeros(self.count, dtype=int)
        # By mover, until when the last contact that was followed in time lasts.
        self.lasts: dict[str, Any] = {name: np.zeros(self.count) for name in movers}
        # By mover, from when and until when the impulses of its contacts have what its tyres do.
        self.braked: dict[str, Any] = {
            name: np.repeat([[np.inf], [-np.inf]], self.count, axis=1) for name in movers
        }
        # By mover, for how much longer than there is time a slope pulls in its last contact, and
        # from when to when [s].
        self.owed: dict[str, Any] = {name: np.zeros((3, self.count)) for name in movers}
        self._pairs = self._all_pairs()
        for contact in contacts:
            self._refuse_numbers(contact)
        self._follow()

    @property
    def at_deepest(self) -> Any:
        """Whether an impulse of each case acts at the deepest, before what was asked for."""
        found = np.zeros(self.count, dtype=bool)
        for hit in self.hits:
            found[hit.which] |= hit.deepest
        return found

    def notices_in(self, units: str | None) -> list[Notice]:
        """The notices with their numbers in a system of units; for None in that of the vehicles."""
        say = self._say if units is None else Sentences(units=units)
        return [
            Notice(
                noted.code,
                "".join(word if isinstance(word, str) else say(*word) for word in noted.words),
                noted.time,
                noted.movers,
            )
            for noted in self.notices
        ]

    def _all_pairs(self) -> list[_Between]:
        shapes = {
            name: Shape.of(mover.outline)
            for name, mover in self.movers.items()
            if mover.outline is not None
        }
        found = []
        for one, other in combinations(self.movers, 2):
            rules = [
                i
                for i, contact in enumerate(self.contacts)
                if {contact.a, contact.b} == {one, other}
            ]
            touching = [i for i in rules if self.contacts[i].touches]
            both = None
            placed = all(_placed(self.movers[name]) for name in (one, other))
            if one in shapes and other in shapes and (placed or touching):
                both = shapes[one], shapes[other]
            pair = _Between(one, other, both, self.count)
            pair.rule = touching[0] if touching else None
            pair.timed = [i for i in rules if not self.contacts[i].touches]
            still = self.movers[one].fixed and self.movers[other].fixed
            if touching or pair.timed or (both is not None and not still):
                found.append(pair)
        return found

    @property
    def most(self) -> int:
        """The number of contacts of the case that has most of them."""
        return int(self.many.max(initial=0))

    @property
    def longest(self) -> list[int]:
        """The contacts of a case that has most of them, in order."""
        found: list[int] = self.rules[: self.most, int(self.many.argmax())].tolist()
        return found

    @property
    def same_order(self) -> bool:
        """Whether the contacts of all cases come in one order, as far as they go."""
        longest = np.array(self.longest)[:, None]
        rules = self.rules[: self.most]
        return bool(np.all((rules == longest) | (rules < 0)))

    # Where things are

    def _pair(self, pair: _Between) -> Pair:
        one, other = (self.courses[name] for name in pair.names)
        assert pair.shapes is not None

        def states(time: Any, cases: Any) -> tuple[Any, Any]:
            follow_on((one, other), time, cases)
            return (
                self._in_plan(one.at(time, cases), cases),
                self._in_plan(other.at(time, cases), cases),
            )

        kept: list[Any] = []

        def bounds(cases: Any) -> Any:
            if not kept:
                every = np.arange(self.count)
                rows = (*one.bounds(every), *other.bounds(every))
                kept.append(np.array([np.broadcast_to(row, self.count) for row in rows]))
            return kept[0][:, cases]

        reach_a, reach_b = (shape.reach for shape in pair.shapes)

        def speeds(cases: Any, state_a: Any, state_b: Any) -> Any:
            return one.fastest(cases, state_a, reach_a) + other.fastest(cases, state_b, reach_b)

        return Pair(*pair.shapes, states, bounds, speeds)

    def _in_plan(self, state: Any, cases: Any) -> Any:
        """States as outlines meet: in plan, in which velocities along a slope are less."""
        if not self.ground.steepest:
            return state
        rises = self.ground.rises(self.ground.taker(cases))
        return np.array([*state[:3], *in_plan(rises, state[3], state[4]), state[5]])

    def _back(self, pair: _Between, cases: Any) -> tuple[Pair, Any]:
        """Both vehicles backwards from the start of some cases, unslowed, on a clock that runs
        back; and until when they may be in contact on it [s].
        """
        assert pair.shapes is not None
        start = np.zeros(len(cases))
        begin = [
            self._in_plan(self.courses[name].at(start, cases, before=True), cases)
            for name in pair.names
        ]

        def states(time: Any, at: Any) -> tuple[Any, Any]:
            one, other = (
                np.concatenate([state[:3, at] - time * state[3:, at], -state[3:, at]])
                for state in begin
            )
            return one, other

        def bounds(at: Any) -> Any:
            return np.zeros((4, len(at)))

        def speeds(at: Any, *_: Any) -> Any:
            return np.full(len(at), np.inf)

        away = begin[1] - begin[0]
        apart, speed = np.hypot(*away[:2]), np.hypot(*away[3:5])
        far = apart + pair.shapes[0].reach + pair.shapes[1].reach
        until = np.where(speed > 0.0, far / np.where(speed > 0.0, speed, 1.0), 0.0)
        return Pair(*pair.shapes, states, bounds, speeds), until

    def _horizon(self, pair: _Between, cases: Any) -> Any:
        """Until when two movers may touch [s]."""
        courses = [self.courses[name] for name in pair.names]
        assert pair.shapes is not None
        goes_on = cases
        if not self.ground.steepest:
            goes_on = cases[np.any([course.evenly(cases)[1] for course in courses], axis=0)]
        if len(goes_on):
            # The one that goes on, as it may down a slope, may come to the other until that rests.
            for course in courses:
                course.to_end(goes_on)
        (since_a, moves_a, push_a), (since_b, moves_b, push_b) = (
            course.evenly(cases) for course in courses
        )
        last = np.maximum(since_a, since_b)
        some = np.flatnonzero((moves_a | moves_b) & np.isfinite(last))
        if len(some):
            # From then on the relative motion is even: until one has left the other behind.
            _, state_a, state_b = self._pair(pair).at(last[some], cases[some])
            reach = pair.shapes[0].reach + pair.shapes[1].reach + 2.0 * APART
            push = (push_b - push_a)[:, some]
            last[some] += _left_behind(
                state_b[:2] - state_a[:2], state_b[3:5] - state_a[3:5], push, reach
            )
        return last

    def _lost(self, names: Iterable[str], cases: Any) -> Any:
        """From when on the motion of some movers is not known [s], as far as they were followed."""
        return np.min([self.courses[name].lost(cases) for name in names], axis=0)

    def _refuse_lost(self, names: Iterable[str], cases: Any, time: Any) -> Any:
        """Which cases are left in which the motion of some movers is known until a time of each;
        the others are refused.
        """
        good = np.ones(len(cases), dtype=bool)
        for name in names:
            course = self.courses[name]
            course.until(time, cases)
            lost = course.lost(cases) < time
            course.refuse_lost(cases[lost])
            good &= ~lost
        return good

    def _ends(self, pair: _Between, cases: Any) -> Any:
        """When both movers rest [s], to which they are followed; infinite where one goes on, and
        where its motion is not known to its end, until when it is.
        """
        courses = [self.courses[name] for name in pair.names]
        for course in courses:
            course.to_end(cases)
        since, moves, _ = zip(*(course.evenly(cases) for course in courses), strict=True)
        rests = np.where(np.any(moves, axis=0), np.inf, np.max(since, axis=0))
        return np.minimum(rests, self._lost(pair.names, cases))

    # The loop

    def _follow(self) -> None:
        every = np.arange(self.count)
        now = np.zeros(self.count)
        for pair in self._pairs:
            self._at_start(pair, every)
        left = {
            i: np.ones(self.count, dtype=bool)
            for i, contact in enumerate(self.contacts)
            if not contact.touches
        }
        alive = self.failed == ""
        # In the order of the movers, so that a refusal names the same one each time.
        paired = {name for pair in self._pairs if pair.shapes is not None for name in pair.names}
        outlined = [name for name in self.movers if name in paired]
        for _ in range(_MOST_ROUNDS):
            times, rules = self._next(now, alive, left)
            alive = alive & (self.failed == "")
            for course in self.courses.values():
                alive &= course.failed == ""
            comes = alive & np.isfinite(times)
            many = self.many >= MOST_CONTACTS
            if (comes & many).any():
                self._endless(np.flatnonzero(comes & many), rules)
                comes = comes & ~many
            if not comes.any():
                break
            # Up to then others may come to touch; on the level all motion is known.
            some = np.flatnonzero(comes & self.ground.sloped)
            if len(some):
                comes[some] = self._refuse_lost(outlined, some, times[some])
            now = np.where(comes, times, now)
            for rule in np.unique(rules[comes]).tolist():
                which = np.flatnonzero(comes & (rules == rule))
                if rule in left:
                    left[rule][which] = False
                for some in self._of_one_kind(rule, which, now):
                    self._strike(rule, some, now)
        else:
            self._endless(np.flatnonzero(comes), rules)
        self.gather()
        self._check()
        self.gather()

    def to_rest(self, names: Iterable[str]) -> None:
        """Follow some movers to their rest, all at once."""
        with np.errstate(all="ignore"):
            every = np.arange(self.count)
            follow_on([self.courses[name] for name in names], np.full(self.count, np.inf), every)

    def gather(self) -> None:
        """Leave the cases without an answer of which a motion could not be followed."""
        for course in self.courses.values():
            fresh = (self.failed == "") & (course.failed != "")
            self.failed[fresh] = course.failed[fresh]

    def _at_start(self, pair: _Between, every: Any) -> None:
        """Refuse outlines that overlap at the start without a contact; pairs that touch are one
        contact.
        """
        if pair.shapes is None:
            return
        for name in pair.names:
            for part in ("x", "y", "heading"):
                needed(self.movers[name].vehicle, part, "an outline in a scene", name)
        met, state_a, state_b = self._pair(pair).at(np.zeros(self.count), every)
        pair.apart = met.gap > TOUCHING
        pair.first[~pair.apart] = np.where(met.gap < -_OVERLAPS, -np.inf, 0.0)[~pair.apart]
        begins = np.zeros(self.count, dtype=bool)
        for rule in pair.timed:
            begins |= self.ground.cases(self.contacts[rule].at) == 0.0
        wrong = (met.gap < -_OVERLAPS) & ~begins
        if self.single and wrong.any():
            one, other = pair.names
            raise InputError(
                f"the outlines of {one} and {other} overlap by "
                f"{self._say(-float(met.gap[0]), 'length', 3)} "
                "at the start, and no contact of these two is at time 0; correct x, y, "
                f"heading or outline, or write `|Contact({one!r}, {other!r}, ...)|"
                f'[[contact]] with a = "{one}", b = "{other}"` at 0',
                code="overlap_at_start",
                argument="movers",
                movers=pair.names,
            )
        self._fail(np.flatnonzero(wrong), "overlap_at_start")
        # Two that touch as the scene begins, and close, have their contact then.
        axis = met.axis(met.widest)
        closing = closing_of(met, axis, state_a, state_b)
        pair.meets(every, 0.0, met, axis, _PUSHED)
        pair.allowed[pair.apart | begins] = np.inf
        at_once = ~pair.apart & ~wrong & ~begins & (closing >= _LEAST_CLOSING)
        pair.touch[at_once], pair.closing[at_once] = 0.0, closing[at_once]
        pair.first[at_once] = 0.0
        self._arrange(pair, np.flatnonzero(at_once))

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
                self._look_ahead(pair, now, looks)
                sooner = alive & (pair.due < times)
                times = np.where(sooner, pair.due, times)
                rules = np.where(sooner, pair.rule, rules)
        # What no contact describes is looked for as far as it is known how the vehicles go on.
        looks &= ~(times <= now)
        if not self._looks_to_rest:
            looks &= np.isfinite(times)
        for pair in moving:
            if pair.rule is None:
                self._look_ahead(pair, now, looks, times)
        return times, rules

    def _look_ahead(self, pair: _Between, now: Any, alive: Any, limits: Any = None) -> None:
        """Find the next touch of a pair where it is not known, and what becomes of it; with
        ``limits`` until a time of each case [s].
        """
        if limits is None:
            limits = np.full(self.count, np.inf)
        cases = np.flatnonzero(alive & np.isnan(pair.touch) & np.isinf(pair.due))
        rounds = 0
        while len(cases):
            rounds += 1
            if rounds > _MOST_PASSED:
                self._grazing(pair, cases)
                return
            moving, limit = self._pair(pair), limits[cases]
            until = limit.copy()
            if np.isinf(limit).any():
                until = np.minimum(limit, self._horizon(pair, cases))
            until = np.minimum(until, self._lost(pair.names, cases))
            begin = np.maximum(now[cases], np.where(np.isnan(pair.begun), 0.0, pair.begun)[cases])
            # A contact followed in time goes to its end before another of the two begins.
            for name in pair.names:
                begin = np.maximum(begin, self.lasts[name][cases])
            near = ~pair.apart[cases]
            if near.any():
                begin[near] = first_apart(moving, begin[near], until[near], cases[near], APART)
                self._note_through(pair, moving, cases[near], begin[near], limit[near])
            touch = first_touch(moving, begin, until, cases)
            self._refuse_unknown_touch(pair, cases, touch.given_up)
            pair.apart[cases] = np.isfinite(begin)
            closer = touch.nearest < pair.nearest[cases]
            pair.nearest[cases] = np.where(closer, touch.nearest, pair.nearest[cases])
            pair.nearest_at[cases] = np.where(closer, touch.nearest_at, pair.nearest_at[cases])
            touches = np.isfinite(touch.time)
            # What is not found until then is looked for again from there on.
            unknown = ~touches & np.isfinite(limit)
            pair.touch[cases] = np.where(unknown, np.nan, touch.time)
            pair.closing[cases] = touch.closing
            pair.first[cases[touches]] = touch.time[touches]
            counts = touches & (touch.closing >= pair.least[cases])
            passes = touches & ~counts
            if pair.rule is not None:
                pair.instant[cases[counts]] = False
                self._arrange(pair, cases[counts])
            # A resting contact is passed over: the search goes on once they were apart.
            over = cases[passes]
            met, *_ = moving.at(touch.time[passes], over)
            pair.meets(over, touch.time[passes], met, met.axis(met.widest), _PUSHED)
            pair.touch[over], pair.begun[over], pair.apart[over] = np.nan, touch.time[passes], False
            cases = over

    def _refuse_unknown_touch(self, pair: _Between, cases: Any, until: Any) -> None:
        """Refuse what goes on for so long that it is not found out whether two touch; ``until``
        when they were followed [s], NaN where it is known.
        """
        lost = np.isfinite(until)
        if self.single and lost.any():
            one, other = pair.names
            raise NoSolutionError(
                f"{one} and {other} were followed until {float(until[0]):.4g} s, and still come "
                "nearer, so that it is not known whether they touch later; give what moves more "
                "drag, or tyres, or leave out the outline of one that is not to touch",
                code="touch_undecided",
                time=float(until[0]),
                movers=pair.names,
            )
        self._fail(cases[lost], "touch_undecided")

    def _note_through(
        self, pair: _Between, moving: Pair, cases: Any, parts: Any, limit: Any
    ) -> None:
        """Note two that were in contact, or touched too slowly for one, and go through each other
        before they part, or come to overlap deeper than they did then: what pushes them without a
        blow is not followed.

        ``parts`` is when they are apart [s]; not finite where they are not until ``limit``, from
        which on they may go another way.
        """
        had = np.isfinite(pair.allowed[cases])
        cases, parts, limit = cases[had], parts[had], limit[had]
        apart = np.isfinite(parts)
        ends, still = np.where(apart, parts, limit), ~apart & np.isinf(limit)
        ends[still] = self._ends(pair, cases[still])
        soon, struck = ends <= _SOON, pair.allowed[cases] > _PUSHED
        # What was passed over is looked at for so long, as it may come together ever so slowly.
        ends, apart = np.where(soon, ends, _SOON), apart & soon
        soon |= ~struck
        cases, apart, ends, struck = cases[soon], apart[soon], ends[soon], struck[soon]
        if not len(cases):
            return
        met, state_a, state_b = moving.at(ends, cases)
        way = pair.side[:, cases]
        beyond = way[0] * (state_b[0] - state_a[0]) + way[1] * (state_b[1] - state_a[1]) < 0.0
        overlap, when = np.where(apart, 0.0, -met.gap), ends.copy()
        # Two that part, or rest, may have been deeper in between.
        for share in _SHARES:
            begun = pair.met[cases]
            moments = begun + share * (ends - begun)
            between, *_ = moving.at(moments, cases)
            when = np.where(-between.gap > overlap, moments, when)
            overlap = np.maximum(overlap, -between.gap)
        # One that is on the other side has gone through it, however deep their contact was.
        before = np.where(beyond & apart, pair.depth[cases], pair.crushed[cases])
        driven = overlap > before + pair.allowed[cases]
        self.driven[cases[driven]] = True
        if not self.single or not driven[0]:
            return
        (first, second), at = pair.names, float(ends[0])
        deep = Number(float(overlap[0]), "length", 2)
        how = "do not part right after their contact"
        if not struck[0]:
            how = f"touch at {float(pair.met[cases[0]]):.3g} s, too slowly for a contact"
        if beyond[0] and apart[0]:
            text = (
                f"{first} and {second} {how}, and are followed through "
                f"each other, to the other side at {at:.3g} s: one is slowed less and would push "
                "the other, which is not followed; their motion from there on is not what happened"
            )
            self._notice_once("driven_through", text, at, pair.names)
        else:
            at = float(when[0])
            rest = (
                f" at {at:.3g} s, more than then: what pushes or turns them into each other "
                "without a blow is not followed"
            )
            words = f"{first} and {second} {how}, and overlap by ", deep, rest
            self._notice_once("driven_together", words, at, pair.names)

    def _notice_once(
        self, code: str, words: Iterable[str | Number], time: float, movers: tuple[str, str]
    ) -> None:
        """Note something of a pair of which the last word counts."""
        self.notices[:] = [
            notice for notice in self.notices if (notice.code, notice.movers) != (code, movers)
        ]
        self.notices.append(Noted(code, words, time, movers))

    def _arrange(self, pair: _Between, cases: Any) -> None:
        """When the impulse of a touch acts."""
        if not len(cases) or pair.rule is None:
            return
        contact, moving = self.contacts[pair.rule], self._pair(pair)
        touch, take = pair.touch[cases], self.ground.taker(cases)
        if not contact.from_outlines:
            pair.due[cases], pair.deepest[cases] = touch, False
            return
        depth = None if contact.depth is None else take(contact.depth)
        delay = take(USUAL_DELAY if contact.delay is None else contact.delay)
        later = touch + (np.maximum(delay, _BRIEF) if depth is None else USUAL_DELAY)
        axis = pair.axis[cases] = struck_face(moving, touch, later, cases)
        self._refuse_bare(pair, moving, cases, delay if depth is None else depth)

        def along(met: Meeting, some: Any) -> Any:
            return self._axis(pair, contact, met, axis[some], cases[some])

        due, deepest, unknown = engaged(
            moving, along, touch, cases, delay if depth is None else None, depth
        )
        if unknown.any():
            self._refuse_unknown_depth(pair, cases[unknown])
            due = np.where(unknown, np.inf, due)
        # A contact in time begins at first touch, where the face and the place that it comes to are
        # known.
        early = np.full(len(cases), contact.in_time)
        if contact._takes_least and contact._may_be_in_time:
            early = ~pair.instant[cases]
            pair.seen[cases] = due
        elif contact.in_time:
            pair.seen[cases] = due
        pair.due[cases], pair.deepest[cases] = np.where(early, touch, due), deepest

    def _refuse_bare(self, pair: _Between, moving: Pair, cases: Any, amount: Any) -> None:
        """Refuse a point at bare first touch where two faces meet."""
        bare = amount == 0.0
        if not bare.any():
            return
        met, *_ = moving.at(pair.touch[cases], cases)
        count = moving.a.normals.shape[1]
        struck = met.axis(pair.axis[cases])
        own = pair.axis[cases] < count
        others = np.where(own, np.arange(len(met.axes[0]))[:, None] >= count, False)
        others |= np.where(~own, np.arange(len(met.axes[0]))[:, None] < count, False)
        turned = np.abs(met.axes[0] * struck[1] - met.axes[1] * struck[0])
        facing = met.axes[0] * struck[0] + met.axes[1] * struck[1] > 0.0
        flat = bare & (others & facing & (turned < math.sin(_FACE_TO_FACE))).any(axis=0)
        if flat.any() and self.single:
            one, other = pair.names
            raise InputError(
                f"{one} and {other} meet face to face, where the point at bare first touch "
                "depends on the last digit of a heading, and with it which way they spin; give "
                "a `delay=` or `depth=` above 0, or `normal=` and `point=`",
                code="bare_touch",
                argument="delay",
            )
        self._fail(cases[flat], "bare_touch")

    def _refuse_unknown_depth(self, pair: _Between, cases: Any) -> None:
        """Refuse a depth of which it is not found out whether two come to it."""
        if self.single:
            one, other = pair.names
            raise NoSolutionError(
                f"{one} and {other} touch at {float(pair.touch[0]):.4g} s, and in the "
                f"{LONGEST_SEARCH:g} s after it they neither come as deep as the `depth=` of their "
                "contact, nor part, nor stop; give a `depth=` that is less, a `delay=`, or "
                "velocities with which they come there sooner",
                code="depth_undecided",
                time=float(pair.touch[0]),
                movers=pair.names,
            )
        self._fail(cases, "depth_undecided")

    def _axis(self, pair: _Between, contact: Contact, met: Meeting, axis: Any, cases: Any) -> Any:
        """The normal from the first of the pair to the second, of each case."""
        if contact.normal is None:
            return met.axis(axis)
        sign = 1.0 if contact.a == pair.names[0] else -1.0
        take = self.ground.taker(cases)
        return sign * np.array([take(part) for part in contact.normal])

    # One contact

    def _of_one_kind(self, rule: int, which: Any, now: Any) -> list[Any]:
        """The cases by the tyres that act during a contact that lasts, and by whether it is at the
        start.
        """
        contact = self.contacts[rule]
        if contact.duration is None or self.single:
            return [which]
        groups: dict[tuple[int, int, bool], list[int]] = {}
        for case in which.tolist():
            one, other = (int(self.courses[n].wheels_of[case]) for n in (contact.a, contact.b))
            groups.setdefault((one, other, bool(now[case] == 0.0)), []).append(case)
        return [np.array(cases) for cases in groups.values()]

    def _strike(self, rule: int, which: Any, now: Any) -> None:
        """Apply a contact whose time has come, by its model or by the least that is near enough."""
        contact = self.contacts[rule]
        pair = next(p for p in self._pairs if {contact.a, contact.b} == {*p.names})
        if not contact._takes_least:
            self._strike_by(contact, rule, pair, which, now)
            return
        # A contact in time begins at first touch; what takes no time acts when an impulse does.
        early = np.zeros(len(which), dtype=bool)
        if contact.touches and contact._may_be_in_time:
            early = ~pair.instant[which] & (now[which] < pair.seen[which])
        fresh = which[early]
        if len(fresh):
            begins = self._least(contact._by_model(IN_TIME), rule, pair, fresh, now) == IN_TIME
            self._strike_by(contact._by_model(IN_TIME), rule, pair, fresh[begins], now)
            wait = fresh[~begins]
            pair.instant[wait], pair.due[wait] = True, pair.seen[wait]
        which = which[~early]
        if not len(which):
            return
        models = self._least(contact, rule, pair, which, now)
        for model in np.unique(models).tolist():
            self._strike_by(contact._by_model(model), rule, pair, which[models == model], now)

    def _least(self, contact: Contact, rule: int, pair: _Between, which: Any, now: Any) -> Any:
        """The least model near enough of each of these cases of a contact, by where it strikes now:
        of a contact in time where that begins.
        """
        time = now[which]
        states = {name: self.courses[name].at(time, which) for name in (contact.a, contact.b)}
        # What cannot be worked out is refused where it strikes.
        found: Any = "eccentric"
        with self._unsaid(), quietly(), suppress(CollisionsError):
            place = self._place(pair, contact, which, time, states)
            whole = self.contacts[rule]
            impact = self._solved_by(rule, whole, which, time, states, place, on_failure="nan")
            found = impact.model
        return np.broadcast_to(np.asarray(found, dtype=object), len(which))

    @contextmanager
    def _unsaid(self) -> Iterator[None]:
        """Within this context nothing is noted of tyres."""
        kept, said = (self.mixed.copy(), self.partly.copy()), len(self.notices)
        try:
            yield
        finally:
            self.mixed, self.partly = kept
            del self.notices[said:]

    def _strike_by(
        self,
        contact: Contact,
        rule: int,
        pair: _Between,
        which: Any,
        now: Any,
    ) -> None:
        which = self._refuse_meanwhile(rule, contact, which, now[which])
        if not len(which):
            return
        time = now[which]
        states = {name: self.courses[name].at(time, which) for name in (contact.a, contact.b)}
        known = self._refuse_lost(states, which, time)
        if not known.all():
            which, time = which[known], time[known]
            states = {name: state[:, known] for name, state in states.items()}
            if not len(which):
                return
        normal, point = self._place(pair, contact, which, time, states)
        if contact.touches:
            # Two that do not close where they would push each other are passed over.
            closes = _closing_at(contact, states, normal, point) >= _LEAST_CLOSING
            if not closes.all():
                self._pass_over(pair, which[~closes], time[~closes])
                which, time = which[closes], time[closes]
                if not len(which):
                    return
                states = {name: state[:, closes] for name, state in states.items()}
                normal, point = (
                    None
                    if part is None
                    else tuple(one[closes] if np.ndim(one) else one for one in part)
                    for part in (normal, point)
                )
        impact = self._solved(rule, contact, which, time, states, (normal, point))
        refused = np.atleast_1d(np.asarray(impact.status)) > Status.ENERGY_GAIN
        if refused.any() and not self.single:
            labels = np.array([Status(code).label for code in np.ravel(impact.status).tolist()])
            for label in np.unique(labels[refused]).tolist():
                self._fail(which[refused & (labels == label)], label)
        deepest = pair.deepest[which].copy() if contact.touches else np.zeros(len(which), bool)
        number = self.many[which]
        self.hits.append(Hit(rule, which, time, impact, deepest, number))
        self.rules[number, which], self.times[number, which] = rule, time
        self.many[which] += 1
        before = self._closings(pair, which, time)
        pair.first[which] = self._began(pair, which, time)
        ends = self._go_on(contact, which, time, states, impact)
        self._keep_touches(pair, which, time)
        pair.due[which], pair.touch[which], pair.apart[which] = np.inf, np.nan, False
        pair.least[which], pair.begun[which], pair.anew[which] = _AGAIN, np.nan, False
        if contact.duration is not None:
            self._note_drags(contact, which, time)
        if pair.shapes is not None:
            moving = self._pair(pair)
            met, *_ = moving.at(time, which)
            pair.struck[which] = time
        sign = 1.0 if contact.a == pair.names[0] else -1.0
        for row, part in zip(pair.way, impact.normal, strict=True):
            row[which] = sign * part
        if pair.shapes is not None:
            pair.meets(which, ends, met, pair.way[:, which], _DEEPER)
            crushed = np.maximum(-moving.at(ends, which)[0].gap, 0.0)
            pair.crushed[which] = np.maximum(pair.depth[which], crushed)
        for other in self._pairs:
            if other is pair or not {contact.a, contact.b} & {*other.names}:
                continue
            self._disturbed(other, which, (time, ends), before.get(id(other)))

    def _note_drags(self, contact: Contact, which: Any, time: Any) -> None:
        """Note vehicles whose drag does not act during a contact that has a duration."""
        drags = {name: self.movers[name].drag for name in (contact.a, contact.b)}
        slid = [name for name, drag in drags.items() if drag is not None and np.any(drag)]
        if not slid:
            return
        self.dragless[which] = True
        if self.single:
            text = (
                f"during the contact of {contact.a} and {contact.b}, which has a duration, "
                f"the drag of {' and '.join(slid)} does not act; tyres in place of a drag do"
            )
            names = contact.a, contact.b
            self.notices.append(Noted("drag_during_contact", text, float(time[0]), names))

    def _pass_over(self, pair: _Between, which: Any, time: Any) -> None:
        """A touch in which nothing pushes: the search goes on once the two were apart."""
        self.passed_over[which] = True
        if self.single:
            one, other = pair.names
            text = (
                f"{one} and {other} touch at {float(pair.touch[0]):.3g} s and do not close where "
                "the impulse would act; they are followed without one"
            )
            self.notices.append(Noted("touch_passed_over", text, float(time[0]), pair.names))
        pair.due[which], pair.touch[which], pair.apart[which] = np.inf, np.nan, False
        pair.begun[which] = time
        met, *_ = self._pair(pair).at(time, which)
        pair.meets(which, time, met, met.axis(met.widest), _PUSHED)

    def _closings(self, struck: _Between, which: Any, time: Any) -> dict[int, Any]:
        """How fast the pairs close that are in contact beside the one that is struck."""
        found = {}
        for pair in self._pairs:
            if pair is not struck and pair.shapes is not None and {*pair.names} & {*struck.names}:
                found[id(pair)] = self._closing(pair, which, time)
        return found

    def _closing(self, pair: _Between, which: Any, time: Any) -> tuple[Any, Any, Any]:
        met, state_a, state_b = self._pair(pair).at(time, which)
        axis = met.axis(met.widest)
        return closing_of(met, axis, state_a, state_b), met.gap, met.widest

    def _disturbed(self, pair: _Between, which: Any, times: tuple[Any, Any], before: Any) -> None:
        """A pair of which one was struck, from a time to another: its next touch is to be found
        again; it comes at once where it is in contact and is driven together.
        """
        struck, time = times
        came = self._keep_touches(pair, which, struck)
        pair.apart[came], pair.begun[came] = False, pair.touch[came]
        # A touch that was still ahead when it was passed over is none any more.
        ahead = which[pair.begun[which] > struck]
        pair.begun[ahead], pair.apart[ahead] = np.nan, True
        self._not_yet_apart(pair, which, struck)
        # A touch that has begun goes on to its impulse.
        waiting = np.isfinite(pair.due[which]) & (pair.touch[which] <= struck)
        pair.touch[which] = np.where(waiting, pair.touch[which], np.nan)
        pair.due[which] = np.where(waiting, pair.due[which], np.inf)
        if pair.shapes is None or pair.rule is None:
            return
        kept = which[waiting]
        if len(kept):
            self._arrange(pair, kept)
            pair.due[kept] = np.maximum(pair.due[kept], time[waiting])
            pair.seen[kept] = np.maximum(pair.seen[kept], pair.due[kept])
        closing, gap, widest = self._closing(pair, which, time)
        least = pair.least[which]
        in_contact = ~pair.apart[which] & ~waiting & (gap < APART)
        # Two that were pushed into each other slowly may close faster than that already.
        struck_on = (before[0] < least) | (closing - before[0] >= _AGAIN)
        together = in_contact & (closing >= least) & struck_on
        driven = together & (gap <= TOUCHING)
        # Outlines that have parted a little meet anew.
        anew = which[together & ~driven]
        pair.apart[anew] = pair.anew[anew] = True
        some = which[driven]
        if not len(some):
            return
        contact = self.contacts[pair.rule]
        pair.instant[some] = False
        pair.touch[some], pair.closing[some] = time[driven], closing[driven]
        pair.axis[some], pair.deepest[some] = widest[driven], False
        pair.due[some] = pair.seen[some] = time[driven]
        # Outlines that only touch have no overlap yet.
        bare = driven & (gap > -1e-3)
        if contact.from_outlines and bare.any():
            pair.due[which[bare]] = np.inf
            self._arrange(pair, which[bare])

    def _keep_touches(self, pair: _Between, which: Any, time: Any) -> Any:
        """Keep the touches until a time that no rule describes, before they are looked for anew;
        the cases that have one.
        """
        if pair.rule is not None:
            return which[:0]
        came = which[pair.touch[which] <= time]
        if len(came):
            pair.touched.append((came, pair.touch[came], pair.closing[came]))
        return came

    def _began(self, pair: _Between, which: Any, time: Any) -> Any:
        """When two that are in contact at a time of each case first touched [s]."""
        ahead = pair.apart[which] & ~np.isfinite(pair.touch[which])
        return np.fmin(np.where(ahead, time, pair.first[which]), time)

    def _not_yet_apart(self, pair: _Between, which: Any, time: Any) -> None:
        """Take back that two are apart which are so only later than an impact that comes before:
        their next touch was looked for from when they part.
        """
        if pair.shapes is None:
            return
        blow = np.where(np.any(pair.way[:, which] != 0.0, axis=0), pair.struck[which], np.nan)
        since = np.fmax(blow, pair.begun[which])
        some = pair.apart[which] & ~pair.anew[which] & (since <= time)
        if some.any():
            cases, until = which[some], time[some]
            parts = first_apart(self._pair(pair), since[some], until, cases, APART)
            pair.apart[cases] = parts <= until

    def _refuse_meanwhile(self, rule: int, contact: Contact, which: Any, time: Any) -> Any:
        """The cases in which no other contact of the two lasts, to which a contact at a time would
        come.
        """
        until = np.max([self.lasts[name][which] for name in (contact.a, contact.b)], axis=0)
        meanwhile = time < until
        if meanwhile.any() and self.single:
            raise NoSolutionError(
                f"contacts[{rule}], {contact.a} and {contact.b}, is at {float(time[0]):.4g} s, "
                f"while another contact of one of them lasts until {float(until[0]):.4g} s; "
                "give a later time, a shorter duration, or `at='touch'`",
                code="contact_meanwhile",
                time=float(time[0]),
                movers=(contact.a, contact.b),
            )
        self._fail(which[meanwhile], "contact_meanwhile")
        return which[~meanwhile]

    def _place(
        self, pair: _Between, contact: Contact, which: Any, time: Any, states: Mapping[str, Any]
    ) -> tuple[Any, Any]:
        """Normal and point of a contact: as given, or of each case from the outlines."""
        take = self.ground.taker(which)
        normal: Any = contact.normal
        point: Any = contact.point
        if pair.shapes is not None:
            self._refuse_places(pair, contact, which, time)
        if not self.single:
            normal = None if normal is None else tuple(part_of(part, take) for part in normal)
            point = None if point is None else tuple(part_of(part, take) for part in point)
        if not contact.from_outlines:
            return normal, point
        if pair.shapes is None:
            lacks = [name for name in pair.names if self.movers[name].outline is None]
            raise MissingInputError(
                f"{' and '.join(lacks)} has no outline, from which normal and point of the "
                f"contact of {contact.a} and {contact.b} come; give `outline=(length, width)` "
                "to its `|Mover|[[mover]]`, or "
                "`normal=` and `point=` to the `|Contact|[[contact]]`",
                code="missing_outline",
                argument="outline",
            )
        carried = contact.in_time and contact.touches
        seen = pair.seen[which] if carried else time
        met, state_a, state_b = self._pair(pair).at(seen, which)
        which_axis = pair.axis[which]
        if not contact.touches and contact.normal is None:
            which_axis = self._face(pair, contact, which, time)
        axis = self._axis(pair, contact, met, which_axis, which)
        centre, _, crossings = overlap_of(met.one, met.other)
        if contact.plane == "crossings":
            axis = _through_crossings(met, crossings, axis)
        # Where outlines only touch, the corner that is ahead.
        nearest = _nearest_corner(met, axis)
        centre = np.where(np.isnan(centre), nearest, centre) + state_a[:2]
        sign = 1.0 if contact.a == pair.names[0] else -1.0
        if carried:
            fixed = [self.movers[name].fixed for name in pair.names]
            begun = [states[name] for name in pair.names]
            centre, axis = _carried_back(centre, axis, (state_a, state_b), begun, fixed)
        if normal is None:
            found = sign * axis
            normal = tuple(float(part[0]) if self.single else part for part in found)
        if point is None and contact.model not in ("linear_central", "oblique_central"):
            point = tuple(float(part[0]) if self.single else part for part in centre)
        return normal, point

    def _refuse_places(self, pair: _Between, contact: Contact, which: Any, time: Any) -> None:
        """Refuse a contact at a time at which the outlines are apart, and a point that is far from
        both.
        """
        if contact.touches and contact.point is None:
            return
        met, state_a, _ = self._pair(pair).at(time, which)
        # What comes from the outlines needs that they touch.
        most = TOUCHING if contact.from_outlines else _FAR
        apart = (met.gap > most) & (not contact.touches)
        when = f"at {float(time[0]):.4g} s"
        if self.single and apart[0]:
            raise InputError(
                f"{contact.a} and {contact.b} are {self._say(float(met.gap[0]), 'length', 3)} "
                f"apart {when}, where contact says that they meet; correct the states, `at=` or "
                "the outlines, or write `at='touch'`",
                code="contact_missing",
                argument="contacts",
                distance=float(met.gap[0]),
                time=float(time[0]),
                movers=(contact.a, contact.b),
            )
        self._fail(which[apart], "contact_missing")
        if contact.point is None:
            return
        take = self.ground.taker(which)
        point = np.array([take(part) for part in contact.point]) - state_a[:2]
        off = np.array([distance_outside(point, one) for one in (met.one, met.other)])
        far = off.min(axis=0) > _FAR
        if self.single and far[0]:
            x, y = (self._say(float(take(part)[0]), "length", 3) for part in contact.point)
            one, other = (self._say(float(part), "length", 3) for part in off[:, 0])
            raise InputError(
                f"the point ({x}, {y}) of the contact of {contact.a} and {contact.b} lies {one} "
                f"outside the outline of {pair.names[0]} and {other} outside that of "
                f"{pair.names[1]} {when}, and may lie {self._say(_FAR, 'length', 3)} outside the "
                "nearer one; correct `point=`, the states or the outlines, or leave out normal "
                "and point, which then come from the outlines",
                code="point_outside",
                argument="contacts",
                time=float(time[0]),
                movers=(contact.a, contact.b),
            )
        self._fail(which[far], "point_outside")

    def _face(self, pair: _Between, contact: Contact, which: Any, time: Any) -> Any:
        """Which axis is that of the face struck at first touch, of a contact at a time: in the
        scene, or before its start, to which both then came straight on.
        """
        moving, first = self._pair(pair), self._began(pair, which, time)
        met, *_ = moving.at(time, which)
        face = met.widest.copy()
        known = np.isfinite(first)
        if known.any():
            later = np.maximum(time, first + _BRIEF)[known]
            face[known] = struck_face(moving, first[known], later, which[known])
        some = np.flatnonzero(~known)
        if not len(some):
            return face
        back, until = self._back(pair, which[some])
        every, begun = np.arange(len(some)), np.zeros(len(some))
        parted = first_apart(back, begun, until, every, 0.0)
        found = np.flatnonzero(np.isfinite(parted))
        self._refuse_undecided(pair, contact, which[some[np.isinf(parted)]], met, time)
        low, high = begun[found], parted[found]
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            apart = back.at(middle, found)[0].gap >= 0.0
            low, high = np.where(apart, low, middle), np.where(apart, middle, high)
        face[some[found]] = struck_face(back, high, np.minimum(begun[found], high - _BRIEF), found)
        return face

    def _refuse_undecided(
        self, pair: _Between, contact: Contact, cases: Any, met: Meeting, time: Any
    ) -> None:
        """Refuse a normal from outlines that overlap from the start, of which it is not known how
        they came to it.
        """
        if not len(cases) or not self.single:
            self._fail(cases, "face_undecided")
            return
        sign = 1.0 if contact.a == pair.names[0] else -1.0
        by_depth = np.argsort(-met.gaps[:, 0], kind="stable").tolist()
        axes = [(sign * met.axes[:, at, 0], -float(met.gaps[at, 0])) for at in by_depth]
        # Edges that are parallel have one normal.
        other = next(one for one in axes if axes[0][0] @ one[0] < _ALIKE)
        listed = " or ".join(
            f"({axis[0] + 0.0:.3g}, {axis[1] + 0.0:.3g}), along which they overlap by "
            f"{self._say(deep, 'length', 3)}"
            for axis, deep in (axes[0], other)
        )
        raise InputError(
            f"{contact.a} and {contact.b} overlap at {float(time[0]):.4g} s, and going straight "
            "back from the states at the start they do not part, so that it is not decided which "
            f"faces met first: the normal is {listed}; give `normal=` and `point=`, or the "
            "velocities just before the contact",
            code="face_undecided",
            argument="contacts",
            time=float(time[0]),
            movers=(contact.a, contact.b),
        )

    def _solved(
        self, rule: int, contact: Contact, which: Any, time: Any, states: Any, place: Any
    ) -> Impact:
        """The impact of a contact; of one that takes the least model near enough the answer of
        ``solve``, which takes that model again.
        """
        if contact.in_time:
            return self._solved_by(rule, contact, which, time, states, place)
        with nullcontext() if contact.duration is not None else self._unsaid():
            return self._solved_by(rule, self.contacts[rule], which, time, states, place)

    def _at(self, error: CollisionsError, rule: int, time: Any) -> CollisionsError:
        """The error with the contact and its time before it."""
        contact = self.contacts[rule]
        where = f"contacts[{rule}], {contact.a} and {contact.b} at {float(time[0]):.4g} s"
        return placed(error, where)

    def _solved_by(
        self,
        rule: int,
        contact: Contact,
        which: Any,
        time: Any,
        states: Any,
        place: Any,
        on_failure: OnFailure | None = None,
    ) -> Impact:
        take = self.ground.taker(which)

        def numbers(value: Any) -> Any:
            return value if self.single else part_of(value, take)

        a, b = (
            body_at(self.movers[name], name, states[name], take, single=self.single)
            for name in (contact.a, contact.b)
        )
        if self.single and float(time[0]) == 0.0 and not self.hits:
            # As they were given, texts included.
            a, b = (self.movers[name].vehicle.replace(name=name) for name in (contact.a, contact.b))
        normal, point = place
        options: dict[str, Any] = {"normal": normal, "incomplete": contact.incomplete}
        solver: Any = linear_central
        if contact.model != "linear_central":
            options |= {name: numbers(getattr(contact, name)) for name in RULES}
            options |= {"law": contact.law}
            solver = oblique_central
        if contact.model in ("eccentric", "solve", IN_TIME):
            solver = {"eccentric": eccentric, "solve": solve, IN_TIME: time_resolved}[contact.model]
            options["point"] = point
            if contact.in_time:
                options = {name: options[name] for name in ("normal", "point", FRICTION)}
                at_start = not contact.touches and float(time[0]) == 0.0
                options["geometry"] = "maximum_engagement" if at_start else "first_contact"
        if contact.model == "solve":
            options["tolerance"] = 0.0 if contact.tolerance is None else numbers(contact.tolerance)

        def solved(spans: Any, on_failure: OnFailure | None) -> Impact:
            given = options | {"on_failure": on_failure if self.single else "nan"}
            if spans is not None:
                given["duration"] = numbers(contact.duration)
                given |= {
                    f"tyres_{label}": self._tyres(name, which, time, spans, states[name])
                    for label, name in (("a", contact.a), ("b", contact.b))
                }
            found: Impact = solver(a, b, numbers(contact.restitution), **given)
            return found

        spans = None if contact.duration is None else self._duration(contact, which, time)
        # Of a study, what is warned of is noted of the cases that come to this contact now; which
        # of them have no answer the run says itself.
        cases = np.isin(np.arange(self.count), which)
        try:
            with in_si(), of_some(cases, but=NO_ANSWER):
                if (
                    contact.in_time
                    and spans is not None
                    and self._shares(states, which, time, spans)
                ):
                    # How much of it the tyres have had goes by how long it lasts, and the other
                    # way round: a few rounds settle that.
                    with self._unsaid(), quietly():
                        for _ in range(_ROUNDS):
                            whole, left = _lasts(solved(spans, "nan"), len(which))
                            known = np.isfinite(left)
                            spans = (
                                np.where(known, whole, spans[0]),
                                np.where(known, left, spans[1]),
                            )
                return solved(spans, on_failure)
        except CollisionsError as error:
            raise self._at(error, rule, time) from None

    def _shares(self, names: Iterable[str], which: Any, time: Any, spans: tuple[Any, Any]) -> bool:
        """Whether tyres of these vehicles act for a part of a contact only, in any case."""
        return any(bool(self._had(name, which, time, spans).any()) for name in names)

    def _had(self, name: str, which: Any, time: Any, spans: tuple[Any, Any]) -> Any:
        """For how much of a contact, of which ``spans`` has all and what is to come [s], the
        impulses of earlier ones have what the tyres of a vehicle do.
        """
        lasting, hold = spans
        begin, until = self.braked[name][:, which]
        ends = time + hold
        had = np.minimum(until, ends) - np.maximum(begin, ends - lasting)
        # One that follows at once on another shares nothing with it but rounding.
        return np.where(had > _SHARED * lasting, np.clip(had, 0.0, lasting), 0.0)

    def _tyres(
        self, name: str, which: Any, time: Any, spans: tuple[Any, Any], state: Any
    ) -> Tyres | None:
        """The tyres of a vehicle on the ground where it is in a contact that lasts, for as much of
        it as no earlier one has already.
        """
        course = self.courses[name]
        tyres = course.wheels[int(course.wheels_of[which[0]])]
        if tyres is None:
            return None
        tyres, mixed = tyres_where_they_are(tyres, self.ground, state, which)
        self.mixed[which] |= mixed
        if self.single and mixed[0]:
            text = (
                f"in the contact at {float(time[0]):.3g} s the wheels of {name} stand on ground of "
                f"different friction, of which the mean, {tyres.friction:.3g}, acts on all four "
                "while the contact lasts"
            )
            self.notices.append(Noted("mixed_friction", text, float(time[0]), (name,)))
        lasting, had = spans[0], self._had(name, which, time, spans)
        if not had.any():
            return tyres
        self.partly[which] |= had > 0.0
        if self.single:
            text = (
                f"in the contact at {float(time[0]):.3g} s the tyres of {name} act for "
                f"{float(lasting[0] - had[0]):.3g} s of its {float(lasting[0]):.3g} s, with that "
                "share of their friction, as an earlier contact has the rest"
            )
            self.notices.append(Noted("durations_overlap", text, float(time[0]), (name,)))
        share = 1.0 - had / lasting
        return tyres_in_part(tyres, float(share[0]) if self.single else share)

    def _duration(self, contact: Contact, which: Any, time: Any) -> tuple[Any, Any]:
        """How long a contact lasts that has a duration, and how much of that is to come [s]."""
        lasting = np.broadcast_to(self.ground.taker(which)(contact.duration), len(which))
        # States at time 0 are those of maximum engagement, half of the contact before them.
        return lasting, np.where((time == 0.0) & (not contact.touches), 0.5 * lasting, lasting)

    def _go_on(self, contact: Contact, which: Any, time: Any, states: Any, impact: Impact) -> Any:
        """Let both vehicles go on from the motion after the contact; when they do, which is later
        only for one that was followed in time.
        """
        hold = lasting = np.zeros(len(which))
        if contact.duration is not None:
            lasting, hold = self._duration(contact, which, time)
        way = way_to_separation(impact)
        passed = np.zeros(len(which), dtype=bool)
        if way is not None:
            whole, lasts = _lasts(impact, len(which))
            passed = np.isfinite(lasts)
            hold = np.where(passed, lasts, hold)
            lasting = np.where(passed, whole, lasting)
        ends = np.where(passed, time + hold, time)
        sides = {"a": (contact.a, impact.a), "b": (contact.b, impact.b)}
        afters, tables = {}, {}
        for label, (name, side) in sides.items():
            after, state = side.after, states[name].copy()
            for row, value in zip((3, 4, 5), (after.vx, after.vy, after.yaw_rate), strict=True):
                state[row] = value
            if way is not None and passed.any():
                begins = (
                    side.before
                    if impact.inputs.geometry == "first_contact"
                    else (side.at_compression)
                )
                table = _ends(states[name], begins, way.moved[label], hold, state, passed)
                rises = self.ground.rises(self.ground.taker(which))
                back = table[1:4, 1] - table[1:4, 0] - hold * state[3:]
                state[:3] = np.where(passed, moved(table[1:4, 0], back, rises), state[:3])
                self.lasts[name][which] = np.where(passed, ends, self.lasts[name][which])
                tables[label] = table
            afters[label] = state
        in_time = InTime(impact, tables) if tables else None
        every = np.arange(len(which))
        for label, (name, _) in sides.items():
            during = None if in_time is None else During(in_time, label, every)
            tyres = contact.tyres_after.get(name)
            self._turn(name, which, (time, hold, lasting), afters[label], tyres, during, passed)
            if contact.duration is not None:
                begin, until = self.braked[name][:, which]
                begin = np.minimum(begin, time + hold - lasting)
                self.braked[name][:, which] = begin, np.maximum(until, time + hold)
        return ends

    def _turn(
        self,
        name: str,
        which: Any,
        times: tuple[Any, Any, Any],
        state: Any,
        tyres: Tyres | None,
        during: During | None,
        passed: Any,
    ) -> None:
        """Let one vehicle go on after a contact: its tyres act again when no impulse of its
        contacts has what they do, be it that of this contact or of an earlier one.
        """
        (time, hold, lasting), course = times, self.courses[name]
        # A slope pulls for what a contact at the start had of its time before it, too: what of that
        # is still owed goes on.
        owed, since, to = self.owed[name][:, which]
        left = owed * np.clip((to - time) / np.where(to > since, to - since, 1.0), 0.0, 1.0)
        more = np.maximum(left, lasting - hold)
        until = self.braked[name][1, which]
        longer = ~passed & (until - time > hold)
        own = np.where(longer, until - time, hold)
        self.owed[name][:, which] = more, time, time + own
        course.turn(which, time, own, state, tyres, during, own + more)
        # One that was followed in time has its own end.
        beyond = passed & (until > time + hold)
        if beyond.any():
            some, ends, rest = which[beyond], (time + hold)[beyond], (until - time - hold)[beyond]
            course.turn(some, ends, rest, course.at(ends, some), None, None, rest)

    # What the scene contradicts

    def _refuse_numbers(self, contact: Contact) -> None:
        """Leave the cases without an answer whose time, depth or delay cannot be."""
        for name, code in _NEGATIVE.items():
            value = getattr(contact, name)
            if isinstance(value, np.ndarray):
                every = self.ground.cases(value)
                self._fail(np.flatnonzero(~np.isfinite(every)), Status.NOT_FINITE.label)
                self._fail(np.flatnonzero(every < 0.0), code)

    def _fail(self, cases: Any, code: str) -> None:
        fresh = cases[self.failed[cases] == ""]
        self.failed[fresh] = code

    def _grazing(self, pair: _Between, cases: Any) -> None:
        """Give up cases in which two touch again and again, too slowly for a contact: what nothing
        slows may turn and graze another for years.
        """
        one, other = pair.names
        if self.single and pair.rule is not None:
            raise NoSolutionError(
                f"{one} and {other} touch again and again, {_MOST_PASSED} times by "
                f"{float(pair.begun[0]):.4g} s, always too slowly for a contact; give what moves "
                "tyres= or drag=, which would end it",
                code="never_ends",
                movers=pair.names,
            )
        pair.touch[cases] = np.inf
        if pair.rule is not None:
            self._fail(cases, "never_ends")

    def _endless(self, cases: Any, rules: Any) -> None:
        contact = self.contacts[int(rules[cases[0]])]
        if self.single:
            raise NoSolutionError(
                f"the scene has not come to its end after {MOST_CONTACTS} contacts: {contact.a} "
                f"and {contact.b} go on touching, at {float(self.times[-1, 0]):.4g} s; a lower "
                "restitution, or tyres or drag, would end it",
                code="never_ends",
                movers=(contact.a, contact.b),
            )
        self._fail(cases, "never_ends")

    def _check(self) -> None:
        """Refuse a case in which a contact does not come, or the order is another; note touches
        that no contact describes.
        """
        for rule, contact in enumerate(self.contacts):
            # What the contact before was refused for is said, and nothing more.
            self.gather()
            absent = np.flatnonzero(~np.any(self.rules == rule, axis=0) & (self.failed == ""))
            # It may come where the motion of the two is not known any more.
            known = self._refuse_lost((contact.a, contact.b), absent, np.full(len(absent), np.inf))
            absent = absent[known]
            if len(absent) and self.single:
                raise self._not_coming(rule, contact)
            self._fail(absent, "contact_missing")
        if self.order is not None:
            names = [(contact.a, contact.b) for contact in self.contacts]
            good = self.many == len(self.order)
            for number, pair in enumerate(self.order[:MOST_CONTACTS]):
                fits = [i for i, one in enumerate(names) if {*one} == {*pair}]
                good &= np.isin(self.rules[number], fits)
            if self.single and not good[0]:
                took = [names[rule] for rule in self.longest]
                raise NoSolutionError(
                    f"the contacts come in the order {_listed(took)}, and order says "
                    f"{_listed(self.order)}",
                    code="other_order",
                    order=tuple(took),
                )
            self._fail(np.flatnonzero(~good), "other_order")
        for one in self._pairs:
            self._note(one)

    def _note(self, pair: _Between) -> None:
        """Note touches of a pair that no contact describes."""
        if pair.rule is not None:
            return
        self._keep_touches(pair, np.arange(self.count), np.full(self.count, _LONG))
        one, other = pair.names
        for cases, times, closings in pair.touched:
            later = self.times[:, cases] - times
            of_them = np.isin(self.rules[:, cases], pair.timed) & (later >= 0.0) & (later <= _LATE)
            lacking = ~of_them.any(axis=0)
            self.undescribed[cases[lacking]] = True
            if not self.single or not lacking[0]:
                continue
            time = float(times[0])
            words = (
                f"{one} and {other} touch at {time:.3g} s, closing by ",
                Number(float(closings[0]), "speed", 3),
                ", and no contact says what happens; they are followed as if they passed through "
                "each other",
            )
            self.notices.append(Noted("touch_without_contact", words, time, pair.names))

    def _not_coming(self, rule: int, contact: Contact) -> CollisionsError:
        pair = next(p for p in self._pairs if {contact.a, contact.b} == {*p.names})
        near, at = self._nearest(pair)
        if not math.isfinite(near) or not math.isfinite(at):
            reason = "do not part and meet again"
        elif near <= TOUCHING:
            reason = (
                f"touch at {at:.3g} s, and do not close along the normal from {contact.a} into "
                f"{contact.b} where the impulse would act"
            )
        else:
            reason = f"are {self._say(near, 'length', 3)} apart at their closest, at {at:.3g} s"
        return NoSolutionError(
            f"contacts[{rule}] does not come: {contact.a} and {contact.b} {reason}; correct what "
            "leads there, or leave the contact out",
            code="contact_missing",
            distance=near,
            time=at,
            movers=(contact.a, contact.b),
        )

    def _nearest(self, pair: _Between) -> tuple[float, float]:
        """How near two vehicles of a single case come to each other [m], and when [s]; infinite
        where they were not looked for.

        The search for a touch passes over what cannot touch, so that it has seen but a bound.
        """
        near, at, one = float(pair.nearest[0]), float(pair.nearest_at[0]), np.zeros(1, dtype=int)
        if not math.isfinite(near) or near <= TOUCHING:
            return near, at
        moving, last = self._pair(pair), float(self._horizon(pair, one)[0])

        def gap(time: float) -> float:
            return float(moving.at(np.array([time]), one)[0].gap[0])

        times = np.linspace(0.0, min(last, _SOON), _LOOKS).tolist()
        gaps = [gap(time) for time in times]
        best = min(range(_LOOKS), key=gaps.__getitem__)
        low, high = times[max(best - 1, 0)], times[min(best + 1, _LOOKS - 1)]
        for _ in range(40):
            one_third, two_thirds = low + (high - low) / 3.0, high - (high - low) / 3.0
            low, high = (
                (low, two_thirds) if gap(one_third) <= gap(two_thirds) else (one_third, high)
            )
        found = min((gap(time), time) for time in (0.5 * (low + high), times[best]))
        return found if found[0] < near else (near, at)


def _lasts(impact: Impact, count: int) -> tuple[Any, Any]:
    """How long contacts last that were followed in time, and how much of that is to come [s]; NaN
    of a case that was not.
    """
    way = way_to_separation(impact)
    if way is None:
        return np.full(count, np.nan), np.full(count, np.nan)
    whole = left = np.broadcast_to(way.duration, count)
    # The places given are those of first touch, or of maximum engagement.
    if impact.inputs.geometry != "first_contact":
        left = np.broadcast_to(whole - way.engaged, count)
    return whole, left


def _ends(
    begun: Any, begins: Any, moved: tuple[Any, Any, Any], hold: Any, after: Any, passed: Any
) -> Any:
    """The motion of a vehicle during a contact that was followed in time: time and state at its
    start and its end, (7, 2, cases); NaN where it was not followed.
    """
    rows = np.full((7, 2, len(hold)), np.nan)
    rows[0, 0], rows[0, 1] = 0.0, hold
    rows[1:4, 0] = begun[:3]
    for row, (name, way) in enumerate(zip(("vx", "vy", "yaw_rate"), moved, strict=True)):
        rows[1 + row, 1] = begun[row] + way
        rows[4 + row, 0] = getattr(begins, name)
        rows[4 + row, 1] = after[3 + row]
    return np.where(passed, rows, np.nan)


def _left_behind(away: Any, going: Any, push: Any, reach: float) -> Any:
    """How long after these relative places, velocities and even accelerations two may come within
    ``reach`` of each other [s]; 0 where they do not.
    """
    size, square = np.hypot(*push), going[0] ** 2 + going[1] ** 2
    pushed = size > _NO_PUSH
    with np.errstate(all="ignore"):
        dot = away[0] * going[0] + away[1] * going[1]
        inside = dot * dot - square * (away[0] ** 2 + away[1] ** 2 - reach * reach)
        even = np.where((square > 0.0) & (inside > 0.0), (np.sqrt(inside) - dot) / square, 0.0)
        # With an acceleration, by the way along it and by that across it.
        u, v = push / np.where(pushed, size, 1.0)
        start, rate = u * away[0] + v * away[1], u * going[0] + v * going[1]
        root = np.sqrt(np.maximum(rate * rate - 2.0 * size * (start - reach), 0.0))
        along = np.where(rate > 0.0, 2.0 * (reach - start) / (rate + root), (root - rate) / size)
        along = np.where(rate * rate < 2.0 * size * (start - reach), 0.0, along)
        start, rate = u * away[1] - v * away[0], u * going[1] - v * going[0]
        across = (reach - np.where(rate < 0.0, -start, start)) / np.abs(rate)
        across = np.where(rate == 0.0, np.where(np.abs(start) <= reach, np.inf, 0.0), across)
    return np.maximum(np.where(pushed, np.minimum(along, across), even), 0.0)


def _carried_back(
    point: Any, axis: Any, seen: Sequence[Any], begun: Sequence[Any], fixed: Sequence[bool]
) -> tuple[Any, Any]:
    """A point and a normal that were seen at some states of two vehicles, as they lie at earlier
    ones: with the mean of both, and against a fixed one the point with the vehicle and the normal
    with what is fixed, as a contact followed in time carries them.
    """
    places, turns = [], []
    for then, was in zip(seen, begun, strict=True):
        turn = was[2] - then[2]
        turned = _rotated(point - then[:2], turn)
        places.append(turned + was[:2])
        turns.append(turn)
    share = 0.5 if fixed[0] == fixed[1] else float(fixed[1])
    centre = share * places[0] + (1.0 - share) * places[1]
    turn = (
        (1.0 - share) * turns[0] + share * turns[1]
        if fixed[0] != fixed[1]
        else (0.5 * (turns[0] + turns[1]))
    )
    return centre, _rotated(axis, turn)


def _rotated(vector: Any, angle: Any) -> Any:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def _closing_at(contact: Contact, states: Mapping[str, Any], normal: Any, point: Any) -> Any:
    """Closing speed of each case where the impulse would act."""
    a, b = states[contact.a], states[contact.b]
    vx, vy = a[3] - b[3], a[4] - b[4]
    if point is not None:
        px, py = point
        vx = vx - a[5] * (py - a[1]) + b[5] * (py - b[1])
        vy = vy + a[5] * (px - a[0]) - b[5] * (px - b[0])
    return vx * normal[0] + vy * normal[1]


def _placed(mover: Mover) -> bool:
    """Whether a mover has a position and a heading."""
    body = mover.vehicle
    return body.x is not None and body.y is not None and body.heading is not None


def _listed(pairs: Sequence[tuple[str, str]]) -> str:
    return ", then ".join(f"{one} and {other}" for one, other in pairs) or "none"


def _nearest_corner(met: Meeting, axis: Any) -> Any:
    """The corner that is farthest along the axis towards the other outline; the middle where
    several are.
    """
    p = axis[0] * met.one[0] + axis[1] * met.one[1]
    q = axis[0] * met.other[0] + axis[1] * met.other[1]
    ahead = p >= p.max(axis=0) - TOUCHING
    behind = q <= q.min(axis=0) + TOUCHING
    own = ahead.sum(axis=0) <= behind.sum(axis=0)
    one = np.where(ahead, met.one, 0.0).sum(axis=1) / ahead.sum(axis=0)
    other = np.where(behind, met.other, 0.0).sum(axis=1) / behind.sum(axis=0)
    return np.where(own, one, other)


def _through_crossings(met: Meeting, crossings: Any, face: Any) -> Any:
    """The normal of the plane through the two points where outlines cross, along the face's.

    The face's own where there are not two such points, or where they are the ends of two faces in
    line.
    """
    flat = crossings.reshape(2, -1, crossings.shape[-1])
    valid = np.isfinite(flat[0])
    two = valid.sum(axis=0) == 2
    order = np.argsort(~valid, axis=0, kind="stable")
    first, second = (
        np.take_along_axis(flat, np.broadcast_to(order[k], flat[:, :1].shape), axis=1)[:, 0]
        for k in (0, 1)
    )
    away = second - first
    length = np.hypot(*away)
    with np.errstate(all="ignore"):
        normal = np.array([away[1], -away[0]]) / length
    toward = normal[0] * face[0] + normal[1] * face[1]
    normal = np.where(toward < 0.0, -normal, normal)
    p = -face[1] * met.one[0] + face[0] * met.one[1]
    q = -face[1] * met.other[0] + face[0] * met.other[1]
    in_line = (np.abs(p.max(axis=0) - q.max(axis=0)) < _IN_LINE) & (
        np.abs(p.min(axis=0) - q.min(axis=0)) < _IN_LINE
    )
    return np.where(two & (length > 0.0) & ~in_line & np.isfinite(normal[0]), normal, face)
