"""How a mover goes on between contacts: on its tyres, by drag, or unslowed; and where it is at any
time.

States are rows of x, y, heading, vx, vy and yaw rate, with a column for each case.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..impact.inputs import part_of
from ..messages.errors import (
    CollisionsError,
    InputError,
    MissingInputError,
    NoSolutionError,
    Status,
    placed,
)
from ..messages.warning import quietly
from ..quantities.settings import in_si
from ..quantities.units import Texts, texts_of
from ..travel.following import PULLED_ON, Following, reach
from ..travel.motion import GOES_ON
from ..travel.simulate import prepared, refuse_one
from ..vehicle.drag import GRAVITY, gravity_on, in_plan
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import NAMES, Vehicle, needed, vehicle_of
from .meanwhile import During
from .mover import Mover

STATE = ("x", "y", "heading", "vx", "vy", "yaw_rate")
_PLACES, _RATES = slice(0, 3), slice(3, 6)
# A wheel whose slip is below this share of the speed rolls straight.
_ROLLS = 1e-9
# Over areas of other friction a motion begins at whole multiples of this, in metres, radians and
# seconds. A contact is solved with other last digits alone and in a batch; where a wheel nearly
# stands or rolls, steps pass them on and they grow to 1e-6 m at the place of rest.
_LAST_DIGITS = 2.0**-36
# Below this share of gravity, a drag and a slope together change no speed.
_LEAST_DRAG = 1e-9


class Leg(NamedTuple):
    """The motion of some cases from ``start`` [s] on, until the next leg.

    Until ``hold`` [s] after the start the motion is unslowed; or, where the ends of ``during`` are
    not NaN, that of a contact followed in time. Then it is that on tyres where ``place``, that of
    the case in ``followed``, is not -1; and else straight on, slowed evenly to rest within
    ``stops`` [s], which is infinite for a motion that nothing slows.

    Where the ground slopes, by ``rises``, velocities are along it and places in plan; ``pull`` is
    the acceleration down it until ``hold``, and ``gains`` that after it, along its way, of a case
    whose drag is less than the slope along it.
    """

    which: Any
    start: Any
    hold: Any
    state: Any
    stops: Any
    place: Any
    followed: Following | None
    tyres: Tyres | None
    during: During | None = None
    rises: Any = None
    pull: Any = None
    gains: Any = None

    def at(self, time: Any, cases: Any) -> Any:
        """The states of some of its cases, by their places in it, at a time of each."""
        after = np.maximum(time - self.start[cases], 0.0)
        hold, begin = self.hold[cases], self.state[:, cases]
        some: Any = None
        if self.followed is not None:
            on = (self.place[cases] >= 0) & (after > hold)
            if on.all():
                return self.followed.at(after - hold, self.place[cases])
            some = np.flatnonzero(on)
        held = np.minimum(after, hold)
        after = after - held
        found = np.empty_like(begin)
        stops = self.stops[cases]
        part = np.minimum(after, stops) / np.where(stops > 0.0, stops, 1.0)
        part = np.where(stops > 0.0, part, 1.0)
        whole = np.isinf(stops)
        further = np.where(whole, after, np.where(whole, 0.0, stops) * part * (1 - 0.5 * part))
        slows = np.where(after > 0.0, 1.0 - np.where(whole, 0.0, part), 1.0)
        if self.rises is None:
            found[_PLACES] = begin[_PLACES] + (held + further) * begin[_RATES]
            found[_RATES] = begin[_RATES] * slows
        else:
            rises, pull = self.rises[:, cases], self.pull[:, cases]
            reached = pulled(begin, held, pull, rises)
            found[_PLACES] = moved(reached[_PLACES], further * reached[_RATES], rises)
            found[_RATES] = reached[_RATES] * slows
            gains = self.gains[:, cases]
            faster = np.flatnonzero(np.any(gains != 0.0, axis=0))
            if len(faster):
                found[:, faster] = pulled(
                    reached[:, faster], after[faster], gains[:, faster], rises[:, faster]
                )
        if some is not None and len(some):
            assert self.followed is not None
            found[:, some] = self.followed.at(after[some], self.place[cases[some]])
        if self.during is not None:
            inside = (held < hold) & np.isfinite(self.during.ends[0, 1, cases])
            some = np.flatnonzero(inside)
            if len(some):
                there = self.during.at(held[some], cases[some])
                if self.rises is not None:
                    begun, rises = self.during.ends[1:4, 0, cases[some]], rises[:, some]
                    there[_PLACES] = moved(begun, there[_PLACES] - begun, rises)
                    still = np.zeros_like(there[_RATES])
                    resting = np.concatenate([there[_PLACES], still])
                    more = pulled(resting, held[some], pull[:, some], rises)
                    there = np.concatenate([more[_PLACES], there[_RATES] + more[_RATES]])
                found[:, some] = there
        return found

    @property
    def begun(self) -> Any:
        """The states of its cases when what slows them begins to act, at the end of ``hold``."""
        if self.pull is None:
            return np.concatenate([self.state[_PLACES] + self.hold * self.state[_RATES],
                                   self.state[_RATES]])  # fmt: skip
        return pulled(self.state, self.hold, self.pull, self.rises)

    def rests(self, cases: Any) -> Any:
        """When some of its cases have come to rest [s]; infinite where they do not. Wheels that
        neither come to rest nor roll straight on are refused.
        """
        last, place = self.stops[cases].copy(), self.place[cases]
        some = np.flatnonzero(place >= 0)
        if self.followed is not None and len(some):
            last[some] = self.followed.rests(place[some])
        still = ~np.any(self.state[:, cases][_RATES] != 0.0, axis=0)
        return self.start[cases] + np.where(still & (place < 0), 0.0, self.hold[cases] + last)


def follow_on(courses: Sequence[Course], time: Any, cases: Any) -> None:
    """Follow some cases of several movers to a time of each, all at once, so that their states are
    there when they are asked for.
    """
    if len(cases) > 1:
        reach([one for course in courses for one in course.followed_for(time, cases)])


def moved(place: Any, way: Any, rises: Any) -> Any:
    """Places and headings after ways along ground that rises so, and turns."""
    return place + np.array([*in_plan(rises, way[0], way[1]), way[2]])


def pulled(state: Any, time: Any, pull: Any, rises: Any) -> Any:
    """The states after times of free motion, in which the ground only pulls."""
    gained = np.zeros_like(state[_RATES])
    gained[:2] = time * pull
    places = moved(state[_PLACES], time * (state[_RATES] + 0.5 * gained), rises)
    return np.concatenate([places, state[_RATES] + gained])


class Course:
    """The legs of one mover, one after another, in all cases; a leg is worked out when its motion
    is first asked for.
    """

    def __init__(self, name: str, mover: Mover, ground: Ground, count: int) -> None:
        self.name, self.mover, self.ground, self.count = name, mover, ground, count
        self.legs: list[Leg] = []
        self.failed: Any = np.full(count, "", dtype=object)
        body = mover.vehicle
        self.placed = body.x is not None and body.y is not None
        self.aimed = body.heading is not None
        given = [getattr(body, name) for name in STATE]
        values = [np.nan if value is None else value for value in given]
        rows = [ground.cases(value) for value in values]
        every = np.arange(count)
        none = np.zeros(count)
        self._waiting: list[tuple[Any, Any, Any, Any, Tyres | None, Any, Any]] = [
            (every, none, none, np.array(rows), mover.tyres, None, none)
        ]
        # Of each leg, the places of the cases in it, or -1; and which leg each case is in now.
        self._places: list[Any] = []
        self._present: Any = np.zeros(count, dtype=int)
        self.fixed = mover.fixed
        self._refuse_body()
        self._refuse_speeds()
        if mover.drag is not None:
            self._refuse_drags()
        # All tyres that it has had, and on which of them each case moves now.
        self.wheels: list[Tyres | None] = [mover.tyres]
        self.wheels_of: Any = np.zeros(count, dtype=int)

    def _refuse_body(self) -> None:
        """Leave the cases without an answer of which a number of the vehicle cannot be, also where
        its motion does not rest on it; of a single case it was refused when it was read.
        """
        body = self.mover.vehicle
        for name in STATE:
            value = getattr(body, name)
            if isinstance(value, np.ndarray):
                number = self.ground.cases(value)
                self._fail(np.flatnonzero(~np.isfinite(number)), Status.NOT_FINITE.label)
        for value in (body.mass, body.yaw_inertia):
            if isinstance(value, np.ndarray):
                number = self.ground.cases(value)
                self._fail(np.flatnonzero(np.isnan(number)), Status.NOT_FINITE.label)
                self._fail(np.flatnonzero(~(number > 0.0)), Status.NOT_POSITIVE.label)

    def _refuse_speeds(self) -> None:
        """Leave the cases without an answer whose kinetic energy is beyond the range of floats; an
        infinite mass or yaw inertia that moves is none of these.
        """
        body, cases = self.mover.vehicle, self.ground.cases
        inertia = 0.0 if body.yaw_inertia is None else body.yaw_inertia
        with np.errstate(all="ignore"):
            energy = sum(
                np.where(np.isfinite(weight), weight * square, 0.0)
                for weight, square in (
                    (cases(body.mass), cases(body.vx) ** 2 + cases(body.vy) ** 2),
                    (cases(inertia), cases(body.yaw_rate) ** 2),
                )
            )
        lost = np.flatnonzero(np.isposinf(energy))
        if len(lost) and self.ground.single:
            raise InputError(
                f"the kinetic energy of {self.name} is not a finite number: its mass, yaw inertia, "
                "speed or yaw rate is too large for floats",
                code="out_of_range",
                argument="movers",
            )
        self._fail(lost, Status.NOT_FINITE.label)

    def _refuse_drags(self) -> None:
        """Leave the cases without an answer whose drag or slope slows nothing that can be said."""
        drag = self.ground.cases(self.mover.drag)
        for number in (drag, *map(self.ground.cases, self.ground.slope)):
            self._fail(np.flatnonzero(~np.isfinite(number)), Status.NOT_FINITE.label)
        self._fail(np.flatnonzero(drag < 0.0), "negative_drag")

    def turn(
        self,
        which: Any,
        start: Any,
        hold: Any,
        state: Any,
        tyres: Tyres | None,
        during: During | None = None,
        lasts: Any = 0.0,
    ) -> None:
        """Let some cases go on from a time and a state, after a contact: on new tyres, or on those
        that they have. A contact that ``lasts`` [s], of which ``hold`` is after that time, is one
        in which the slope pulls all the while.

        Of a contact followed in time, which takes ``hold`` and moves as ``during`` says, the state
        is the one from which its end is reached at the velocities after it.
        """
        if tyres is not None:
            self.wheels_of[which] = len(self.wheels)
            self.wheels.append(tyres)
        for leg, places in zip(self.legs, self._places, strict=True):
            if leg.followed is not None:
                some = places[which]
                some = leg.place[some[some >= 0]]
                leg.followed.leave(some[some >= 0])
        on = self.wheels_of[which]
        for kind in np.unique(on).tolist():
            some = np.flatnonzero(on == kind)
            self._waiting.append(
                (
                    which[some],
                    start[some],
                    hold[some],
                    state[:, some],
                    self.wheels[kind],
                    None if during is None else during.of(some),
                    np.broadcast_to(lasts, len(which))[some],
                )
            )

    def began(self, cases: Any) -> Any:
        """When the present leg of each case began [s]."""
        start = np.zeros(self.count)
        for leg in self.settled():
            start[leg.which] = leg.start
        return start[cases]

    def settled(self) -> list[Leg]:
        """All legs."""
        while self._waiting:
            which, start, hold, state, tyres, during, lasts = self._waiting.pop(0)
            # Nobody asks for the motion of a leg that ends as it begins.
            brief = np.zeros(len(which), dtype=bool)
            for others, begun, *_ in self._waiting:
                next_start = np.full(self.count, np.inf)
                next_start[others] = begun
                brief |= next_start[which] <= start
            self._present[which] = len(self.legs)
            places = np.full(self.count, -1)
            places[which] = np.arange(len(which))
            self._places.append(places)
            pull = self._pull(which, hold, state, tyres, lasts)
            leg = self._leg((which, start, hold, state, tyres), brief, pull)
            self.legs.append(leg._replace(during=during))
        return self.legs

    def at(self, time: Any, cases: Any, *, before: bool = False) -> Any:
        """The states of some cases, each at its own time; at a contact that after it, or that
        ``before``.
        """
        if len(self._waiting) == 1 and not self.legs and not np.any(time):
            # The start needs no motion.
            return self._waiting[0][3][:, cases]
        legs = self.settled()
        if self.count == 1 and len(cases) == 1:
            return self._of_one(float(time[0]), before)
        if len(legs) == 1:
            return legs[0].at(time, cases)
        found = np.empty((6, len(cases)))
        left = np.arange(len(cases))
        for number in range(len(legs) - 1, -1, -1):
            leg = legs[number]
            at = self._places[number][cases[left]]
            now = time[left]
            begun = leg.start[at] < now if before and number else leg.start[at] <= now
            begun &= at >= 0
            some, at, left = left[begun], at[begun], left[~begun]
            if len(some):
                found[:, some] = leg.at(time[some], at)
            if not len(left):
                break
        return found

    def _of_one(self, time: float, before: bool) -> Any:
        """The state of a single case at one time."""
        for number in range(len(self.legs) - 1, -1, -1):
            leg = self.legs[number]
            start = float(leg.start[0])
            if not number or start < time or (start == time and not before):
                break
        after = max(time - start, 0.0) - float(leg.hold[0])
        if leg.followed is not None and after > 0.0:
            return leg.followed.of_one(after)
        return leg.at(np.array([time]), np.zeros(1, dtype=int))

    def leg_at(self, time: float) -> Leg:
        """The leg of the one case of a scene that is no batch."""
        legs = self.settled()
        begun = [leg for leg in legs if leg.start[0] <= time]
        return (begun or legs[:1])[-1]

    def followed_for(self, time: Any, cases: Any) -> list[tuple[Following, Any, Any]]:
        """What ``reach`` takes to follow the present legs of some cases to a time of each."""
        asked = []
        for number, leg in enumerate(self.settled()):
            if leg.followed is not None:
                places = self._places[number][cases]
                mine = np.flatnonzero((places >= 0) & (self._present[cases] == number))
                at = places[mine]
                after, place = time[mine] - leg.start[at] - leg.hold[at], leg.place[at]
                moves = (place >= 0) & (after > 0.0)
                asked.append((leg.followed, after[moves], place[moves]))
        return asked

    @property
    def rests(self) -> Any:
        """When each case has come to rest for good [s], to which it is followed for it; infinite
        where it does not.
        """
        found = np.empty(self.count)
        for number, leg in enumerate(self.settled()):
            mine = np.flatnonzero(self._present[leg.which] == number)
            if len(mine):
                found[leg.which[mine]] = leg.rests(mine)
                self._refuse_unheld(leg, mine)
        return found

    def _present_of(self, cases: Any) -> Iterator[tuple[Leg, Any, Any]]:
        """The legs that some cases are in, which of these cases, and their places in it."""
        for number, leg in enumerate(self.settled()):
            places = self._places[number][cases]
            mine = np.flatnonzero((places >= 0) & (self._present[cases] == number))
            if len(mine):
                yield leg, mine, places[mine]

    def to_end(self, cases: Any) -> None:
        """Follow some cases to their rest, or until it is known how they go on for good."""
        self.until(np.full(len(cases), np.inf), cases)

    def until(self, time: Any, cases: Any) -> None:
        """Follow some cases to a time of each."""
        reach(self.followed_for(time, cases))

    def lost(self, cases: Any) -> Any:
        """From when on the motion of some cases is not known [s], as far as they were followed:
        that of one which does not stay where it stops on a slope. Infinite where it is known.
        """
        found = np.full(len(cases), np.inf)
        for leg, mine, at in self._present_of(cases):
            ends, place = np.full(len(at), np.inf), leg.place[at]
            for some, until, _ in self._unheld(leg, at):
                ends[some] = until[some]
            if leg.followed is not None:
                some = np.flatnonzero(place >= 0)
                ends[some] = leg.hold[at[some]] + leg.followed.lost(place[some])
            found[mine] = leg.start[at] + ends
        return found

    def refuse_lost(self, cases: Any) -> None:
        """Refuse some cases whose motion is asked for beyond what is known of it."""
        for leg, _, at in self._present_of(cases):
            place = leg.place[at]
            if leg.followed is not None:
                leg.followed.refuse(place[place >= 0])
            self._refuse_unheld(leg, at)

    def evenly(self, cases: Any) -> tuple[Any, Any, Any]:
        """From when on some cases rest or move with an even acceleration for good [s], infinite
        where that is not known; whether they move; and that acceleration in plan [m/s**2], (2,
        ...).
        """
        since, moves = np.zeros(len(cases)), np.zeros(len(cases), dtype=bool)
        push = np.zeros((2, len(cases)))
        for leg, mine, at in self._present_of(cases):
            stops, place = leg.stops[at], leg.place[at]
            goes = np.isinf(stops) & np.any(leg.begun[_RATES][:, at] != 0.0, axis=0)
            ends = np.where(np.isfinite(stops), stops, 0.0)
            some = np.flatnonzero(place >= 0)
            if leg.gains is not None:
                push[:, mine] = leg.gains[:, at]
            if leg.followed is not None and len(some):
                on, push[:, mine[some]] = leg.followed.evenly(place[some])
                goes[some] = np.isfinite(on)
                ends[some] = np.minimum(on, leg.followed.known_rests(place[some]))
            if leg.rises is not None:
                push[:, mine] = in_plan(leg.rises[:, at], *push[:, mine])
            since[mine], moves[mine] = leg.start[at] + leg.hold[at] + ends, goes
        return since, moves, push

    def fastest(self, cases: Any, state: Any, reach: float) -> Any:
        """The most that any point within ``reach`` can move at from a state on; infinite where that
        is not known.
        """
        if self.fixed:
            return 0.0
        if self.ground.steepest:
            return np.inf
        speed, turning = np.hypot(state[3], state[4]), np.abs(state[5])
        body = self.mover.vehicle
        if len(self.wheels) == 1 and self.wheels[0] is None:
            return speed + reach * turning
        if body.yaw_inertia is None:
            return np.inf
        # Wheels may turn the one into the other.
        square = self.ground.taker(cases)(body.yaw_inertia / body.mass)
        return np.sqrt(speed * speed + square * turning * turning) + reach * np.sqrt(
            turning * turning + speed * speed / square
        )

    def bounds(self, cases: Any) -> tuple[Any, Any]:
        """Bounds of what the motion may change by: of the acceleration and the yaw acceleration."""
        body, ground = self.mover.vehicle, self.ground
        if self.fixed:
            return 0.0, 0.0
        push = np.zeros(len(cases))
        spin = np.zeros(len(cases))
        for leg in self.settled():
            here = np.isin(cases, leg.which)
            if not here.any():
                continue
            if leg.tyres is not None:
                mine = cases[here]
                take = ground.taker(mine)
                most = ground.greatest(leg.tyres, take)
                reach = np.hypot(
                    *(0.5 * take(size) for size in (leg.tyres.wheelbase, leg.tyres.track))
                )
                # Gravity on the level, which is a bound of that on any slope.
                push[here] = GRAVITY * (most + ground.steepest)
                spin[here] = GRAVITY * most * reach * take(body.mass) / take(body.yaw_inertia)
            elif self.mover.drag is not None:
                place = np.full(self.count, 0)
                place[leg.which] = np.arange(len(leg.which))
                at = place[cases[here]]
                stops = leg.stops[at]
                begun, pulls = leg.begun[:, at], 0.0
                if leg.pull is not None:
                    pulls = np.hypot(*leg.pull[:, at])
                speed = np.hypot(begun[3], begun[4])
                moving = (stops > 0.0) & np.isfinite(stops)
                slowing = np.where(moving, speed / np.where(moving, stops, 1.0), 0.0)
                if leg.gains is not None:
                    pulls = np.maximum(pulls, np.hypot(*leg.gains[:, at]))
                push[here] = np.maximum(slowing, pulls)
                turning = np.abs(leg.state[5, at])
                spin[here] = np.where(moving, turning / np.where(moving, stops, 1.0), 0.0)
        return push, spin

    def _pull(self, which: Any, hold: Any, state: Any, tyres: Tyres | None, lasts: Any) -> Any:
        """Acceleration down the slope while a contact holds: what comes to its pull over all of
        the contact, also of the part before the time of the states.
        """
        if not self.ground.steepest:
            return None
        rises = np.array(self.ground.rises(self.ground.taker(which)))
        # What nothing slows is not pulled either, and what stands is held.
        holds = self.fixed or (tyres is None and self.mover.drag is None)
        acts = (hold > 0.0) & np.any(state[_RATES] != 0.0, axis=0) & (not holds)
        share = np.where(acts, lasts / np.where(hold > 0.0, hold, 1.0), 0.0)
        return -gravity_on((rises[0], rises[1])) * rises * share

    def _leg(self, begins: tuple[Any, ...], brief: Any, pull: Any) -> Leg:
        which, start, hold, state, tyres = begins
        rises = None if pull is None else np.array(self.ground.rises(self.ground.taker(which)))
        count = len(which)
        none = np.full(count, -1)
        leg = Leg(
            which, start, hold, state, np.zeros(count), none, None, tyres, rises=rises, pull=pull
        )
        gains = None if pull is None else np.zeros((2, count))
        begun = leg.begun
        speed = np.hypot(begun[3], begun[4])
        still = (speed == 0.0) & (begun[5] == 0.0)
        stops = np.where(still, 0.0, np.inf)
        place: Any = none.copy()
        followed = None
        if self.fixed or count == 0:
            pass
        elif tyres is not None:
            rolling = self._rolls(tyres, which, begun, speed)
            moves = ~(rolling | brief | (still & (self.ground.steepest == 0.0)))
            if moves.any():
                place[moves] = np.arange(int(moves.sum()))
                followed = self._followed(which[moves], begun[:, moves], tyres)
        elif self.mover.drag is not None:
            slowing = self._slowing(which, begun, speed)
            stops = np.where(slowing > 0.0, speed / np.where(slowing > 0.0, slowing, 1.0), np.inf)
            stops = np.where(still, 0.0, stops)
            if gains is not None:
                along = begun[3:5] / np.where(speed > 0.0, speed, 1.0)
                gains = np.maximum(-slowing, 0.0) * along
        return leg._replace(stops=stops, place=place, followed=followed, gains=gains)

    def _rolls(self, tyres: Tyres, which: Any, state: Any, speed: Any) -> Any:
        """Whether all wheels roll freely straight on, so that nothing slows the vehicle."""
        take = self.ground.taker(which)
        free = ~np.any([take(lock) != 0.0 for lock in tyres.locks], axis=0)
        straight = (take(tyres.steer) == 0.0) & (state[5] == 0.0)
        aside = state[4] * np.cos(state[2]) - state[3] * np.sin(state[2])
        level = self.ground.steepest == 0.0
        return free & straight & level & (np.abs(aside) <= _ROLLS * speed) & (speed > 0.0)

    def _slowing(self, which: Any, state: Any, speed: Any) -> Any:
        """The even deceleration of each case by its drag and the slope along its way [m/s**2]:
        below 0 where the slope falls by more than the drag.
        """
        take = self.ground.taker(which)
        rises = self.ground.rises(take)
        climbs = (rises[0] * state[3] + rises[1] * state[4]) / np.where(speed > 0.0, speed, 1.0)
        slowing = take(self.mover.drag) + np.where(speed > 0.0, climbs, 0.0)
        return gravity_on(rises) * np.where(np.abs(slowing) > _LEAST_DRAG, slowing, 0.0)

    def _refuse(self, cases: Any, how: str) -> None:
        """Refuse what a drag does not stop."""
        if len(cases) and self.ground.single:
            raise NoSolutionError(
                f"{self.name} {how}; give it `tyres=`, with the lock of its wheels",
                code="never_stops",
            )
        self._fail(cases, "never_stops")

    def _unheld(self, leg: Leg, mine: Any) -> Iterator[tuple[Any, Any, str]]:
        """Which cases of a leg a drag does not hold where they stand or stop, or does not slow;
        from when on after its start [s]; and how they do that.
        """
        if leg.tyres is not None or self.mover.drag is None or self.fixed:
            return
        begun, stops, take = leg.begun[:, mine], leg.stops[mine], self.ground.taker(leg.which[mine])
        speed, turns = np.hypot(begun[3], begun[4]), begun[5] != 0.0
        steep = np.hypot(*map(take, self.ground.slope)) > take(self.mover.drag)
        for cases, how in (
            ((speed == 0.0) & turns, "turns on the spot, which a drag does not slow"),
            ((speed == 0.0) & ~turns & steep, "stands on a slope that is too steep for its drag"),
            ((speed > 0.0) & np.isfinite(stops) & steep,
             "stops on a slope that is too steep for its drag"),
        ):  # fmt: skip
            yield cases, leg.hold[mine] + np.where(speed > 0.0, stops, 0.0), how

    def _refuse_unheld(self, leg: Leg, mine: Any) -> None:
        """Refuse what a drag does not hold or slow."""
        for cases, _, how in self._unheld(leg, mine):
            self._refuse(leg.which[mine[cases]], how)

    def _followed(self, which: Any, state: Any, tyres: Tyres) -> Following:
        """The motion of some cases on tyres."""
        body, ground = self.mover.vehicle, self.ground
        for name in ("yaw_inertia", "x", "y", "heading"):
            needed(body, name, "motion on tyres", self.name)
        one = ground.single
        take = _as_it_is if one else ground.taker(which)
        numbers = {name: getattr(body, name) for name in NAMES}
        if ground.surfaces:
            state = np.rint(state / _LAST_DIGITS) * _LAST_DIGITS
        rows = dict(zip(STATE, state, strict=True))
        if one:
            numbers |= {name: float(row[0]) for name, row in rows.items()}
            wheels: Any = tyres
        else:
            numbers |= {"mass": take(body.mass), "yaw_inertia": take(body.yaw_inertia), **rows}
            wheels = part_of(tyres, take)
        areas = [(np.array(corners), mu) for corners, mu in ground.surfaces_for(take)]
        slope = tuple(part_of(part, take) for part in ground.slope)
        try:
            with quietly([]), in_si():
                made = prepared(vehicle_of(numbers), wheels, areas, slope, ground.tolerance)
        except CollisionsError as error:
            raise placed(error, self.name) from None
        wrong = np.zeros(len(which), dtype=bool)
        for code, found in made.checks:
            new = np.broadcast_to(found, len(which)) & ~wrong
            self._fail(which[new], code)
            wrong |= new

        def refused(some: Any, how: Any) -> None:
            goes_on = (how == GOES_ON) | (how == PULLED_ON)
            if one and goes_on[0]:
                why = (
                    "and does not roll straight on either; give the lock that stopped it, or the "
                    "resistance to rolling as a lock such as 0.02"
                )
                if ground.steepest:
                    why = (
                        f"as the slope of {ground.steepest:.3g} is too steep for its wheels to "
                        "hold it; give the lock that held it, or correct slope"
                    )
                text = f"{self.name}: it does not come to rest, {why}"
                raise NoSolutionError(text, code="never_stops")
            if one:
                try:
                    refuse_one(int(how[0]), made.motion.settings.sloped)
                except CollisionsError as error:
                    raise placed(error, self.name) from None
            self._fail(which[some[goes_on]], "never_stops")
            self._fail(which[some[~goes_on]], "no_convergence")

        return Following(made, refused)

    def _fail(self, cases: Any, code: str) -> None:
        fresh = cases[self.failed[cases] == ""]
        self.failed[fresh] = code


def _as_it_is(value: Any) -> Any:
    """The number of the one case of a scene that is no batch."""
    return value


@dataclass(frozen=True)
class Ground:
    """What all movers of a scene share: areas, slope, how finely motion is followed, and the cases.

    ``shape`` is that of the cases of a batch, None for one.
    """

    surfaces: tuple[tuple[Any, Any], ...]
    slope: tuple[Any, Any]
    tolerance: float
    shape: tuple[int, ...] | None

    @property
    def single(self) -> bool:
        """Whether the scene is one case."""
        return self.shape is None

    @cached_property
    def steepest(self) -> float:
        """The greatest rise over run in any case."""
        return float(np.max(np.hypot(*self.slope), initial=0.0))

    @property
    def sloped(self) -> Any:
        """Which cases are not on the level."""
        return (self.cases(self.slope[0]) != 0.0) | (self.cases(self.slope[1]) != 0.0)

    def rises(self, take: Callable[[Any], Any]) -> tuple[Any, Any]:
        """The slope of some cases."""
        return take(self.slope[0]), take(self.slope[1])

    def cases(self, value: Any) -> Any:
        """A number of the scene in every case, as a fresh array."""
        shape = self.shape or ()
        return np.array(np.broadcast_to(np.asarray(value, float), shape)).reshape(-1)

    def taker(self, which: Any) -> Callable[[Any], Any]:
        """What takes the numbers of some cases from a number of the scene."""

        def take(value: Any) -> Any:
            return self.cases(value)[which]

        return take

    def surfaces_for(self, take: Callable[[Any], Any]) -> list[tuple[Any, Any]]:
        """The areas as ``simulate`` takes them, with the friction of some cases."""
        return [(list(corners), part_of(friction, take)) for corners, friction in self.surfaces]

    def greatest(self, tyres: Tyres, take: Callable[[Any], Any]) -> Any:
        """The greatest friction anywhere."""
        most = take(tyres.friction)
        for _, friction in self.surfaces:
            most = np.maximum(most, take(friction))
        return most


def no_rest(course: Course) -> MissingInputError:
    """The error for the place of rest of a mover of a single case that does not stop."""
    why, give = why_no_rest(course)
    return MissingInputError(
        f"{course.name} has no place of rest, as {why}; {give}",
        code="missing_drag",
        argument=course.name,
    )


def why_no_rest(course: Course) -> tuple[str, str]:
    """Why a mover of a single case does not stop, and what to give."""
    mover, ground = course.mover, course.ground
    give = "give it `tyres=`, or `drag=`, in its `|Mover|[[mover]]`"
    why = "nothing slows it"
    last = course.settled()[-1]
    if mover.drag is not None:
        vx, vy = last.begun[3:5, 0]
        falls = -float(ground.slope[0] * vx + ground.slope[1] * vy) / float(np.hypot(vx, vy))
        why = f"the slope falls by {falls:.3g} along its way, and its drag is {mover.drag:.3g}"
        give = (
            f"give a `drag=` above {falls:.3g}, as that on the level, or `tyres=`, or correct slope"
        )
        if falls <= 0.0:
            why, give = "a drag of 0 slows nothing", "give a `drag=` above 0, or `tyres=`"
    elif last.tyres is not None:
        why = "its wheels roll freely straight on"
        give = "give the lock of its `tyres=`, for the resistance to rolling such as 0.02"
    return why, give


def body_at(
    mover: Mover, name: str, state: Any, take: Callable[[Any], Any], *, single: bool
) -> Vehicle:
    """The vehicle of a mover in a state of some cases: floats for one, else arrays."""
    body = mover.vehicle
    numbers: dict[str, Any] = {one: getattr(body, one) for one in NAMES}
    rows: Mapping[str, Any] = dict(zip(STATE, state, strict=True))
    for one, row in rows.items():
        if numbers[one] is not None:
            numbers[one] = float(row[0]) if single else row
    if not single:
        for one in ("mass", "yaw_inertia"):
            numbers[one] = part_of(numbers[one], take)
    numbers["name"] = name
    # Shown in the units that the mover was given in.
    return vehicle_of(numbers, given=Texts(units=texts_of(body.given)))
