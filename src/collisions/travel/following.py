"""Motion on tyres that is followed as far as it is asked for, and where its cases are then."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..vehicle.drag import in_plan
from .motion import GOES_ON, IN_TIME, RESTS, STATE, Followed, Motion, between, follow, gone_on
from .simulate import Prepared

# Cases that are followed together: few calls of numpy, and memory that is kept small.
_BLOCK = 2048
# Motions are followed on by this much more [s] than was asked for, all together, and once one was
# asked for up to this time, to their ends: most contacts come within a moment of another.
_AHEAD, _TO_THE_END = 0.3, 0.6
# Found for a case beside what ``follow`` finds: nothing slows it, and it rolls straight on; or it
# goes on under forces that stay as they are.
ROLLS_ON, PULLED_ON = 4, 5
_KNOWN_ON = (ROLLS_ON, PULLED_ON)
# Longer than anything takes that comes to rest [s].
_FOR_EVER = 1e4
# What nothing slows goes straight on where it is not sped up or turned either, in units of gravity,
# and hardly turns for its speed.
_NO_FORCE, _STRAIGHT = 1e-9, 1e-7


class _Piece(NamedTuple):
    """Steps of some cases: the place of each case in it or -1, where its rows begin and end, and
    all rows.
    """

    place: Any
    first: Any
    last: Any
    rows: Any


class Following:
    """Cases in motion on their tyres, by their places in ``made``; ``refused`` is told of which of
    them the rest is asked for, though they have none, or the motion beyond what is known of it; and
    how they ended.
    """

    def __init__(self, made: Prepared, refused: Callable[[Any, Any], None]) -> None:
        self._motion: Motion = made.motion
        self._tell = refused
        self.count = made.motion.start.shape[1]
        self._x, self._y, self._second, self._length, _ = made.units
        self._spin = made.motion.ground[17]
        # Where the ground slopes, steps go along it, and places are in plan.
        self._rises = made.motion.ground[18:20] if made.motion.settings.sloped else None
        self._ended: Any = np.full(self.count, IN_TIME)
        self._reached: Any = np.zeros(self.count)
        self._state: Any = np.zeros((STATE, self.count))
        self._push: Any = np.zeros((2, self.count))
        self._left: Any = np.zeros(self.count, dtype=bool)
        self._pieces: list[_Piece] = []
        # The steps of a single case, and their times.
        self._steps: list[list[float]] = []
        self._times: list[float] = []
        if self.count == 1:
            self._units = float(self._second[0]), float(self._length[0])
            self._turns = float(self._spin[0])

    def at(self, time: Any, cases: Any) -> Any:
        """Places, heading and velocities of some cases, (6, ...), at a time of each from the start
        [s]; NaN beyond what is known of one, as ``lost`` has it.
        """
        scaled = time / self._second[cases]
        self._reach(scaled, cases)
        found = np.full((6, len(cases)), np.nan)
        left = np.arange(len(cases))
        for piece in reversed(self._all_pieces()):
            place = piece.place[cases[left]]
            inside = place >= 0
            inside &= scaled[left] >= piece.rows[0, piece.first[place]]
            some, left = left[inside], left[~inside]
            if len(some):
                # What leaves the range of floats is no number then, which is refused.
                with np.errstate(all="ignore"):
                    found[:, some] = self._within(piece, scaled[some], cases[some], place[inside])
            if not len(left):
                break
        return found

    def of_one(self, time: float) -> Any:
        """The same of a single case, (6, 1), in floats."""
        second, length = self._units
        time = time / second
        if not self._times or time >= self._times[-1]:
            self._reach(np.array([time]), np.zeros(1, dtype=int))
        steps, after = self._steps, bisect_right(self._times, time)
        x, y = float(self._x[0]), float(self._y[0])
        how, turning = int(self._ended[0]), 0.0
        if after < len(steps):
            before, row = steps[max(after - 1, 0)], steps[after]
            took = row[0] - before[0]
            share = (time - before[0]) / took if took > 0.0 else 0.0
            (px, py, heading), (vx, vy, turning) = between(before, row, share, self._turns)
        elif not steps or how not in (RESTS, *_KNOWN_ON):
            return np.full((6, 1), np.nan)
        elif how in _KNOWN_ON:
            last = _evenly(steps[-1], how == PULLED_ON)
            places, rates = gone_on(last, time - last[0], self._turns)
            (px, py, heading), (vx, vy, turning) = places, rates
            turning *= self._turns
        else:
            _, px, py, heading, *_ = steps[-1]
            vx = vy = 0.0
        rate = length / second
        px, py = self._in_plan(px, py)
        state = [x + length * px, y + length * py, heading, rate * vx, rate * vy, turning / second]
        return np.array([state]).T

    def _in_plan(self, px: float, py: float) -> tuple[float, float]:
        """A way of the single case."""
        if self._rises is None:
            return px, py
        rise_x, rise_y = self._rises[:, 0].tolist()
        return in_plan((rise_x, rise_y), px, py)

    def leave(self, cases: Any) -> None:
        """Follow some cases no further than is asked for, as they go on otherwise."""
        self._left[cases] = True

    def rests(self, cases: Any) -> Any:
        """When some cases rest [s], which are followed to their end for it; infinite for those that
        roll straight on. Those that have no rest otherwise are refused.
        """
        ends = self.ends(cases)
        return np.where(self._ended[cases] == RESTS, ends, np.inf)

    def ends(self, cases: Any) -> Any:
        """When some cases rest or roll straight on [s], which are followed to that; others are
        refused.
        """
        self._reach(np.full(len(cases), np.inf), cases)
        self.refuse(cases)
        return self._times_reached(cases)

    def refuse(self, cases: Any) -> None:
        """Tell of those that were followed to their end and have no rest, though they do not roll
        straight on.
        """
        how = self._ended[cases]
        none = ~np.isin(how, (RESTS, ROLLS_ON, IN_TIME))
        if none.any():
            self._tell(cases[none], how[none])

    def known_rests(self, cases: Any) -> Any:
        """When some cases rest [s]; infinite where they do not, or were not followed so far."""
        rests = self._ended[cases] == RESTS
        return np.where(rests, self._times_reached(cases), np.inf)

    def lost(self, cases: Any) -> Any:
        """From when on the motion of some cases is not known [s], as that of one which does not
        stay where it stops on a slope; infinite where it is, or they were not followed so far.
        """
        known = np.isin(self._ended[cases], (IN_TIME, RESTS, *_KNOWN_ON))
        return np.where(known, np.inf, self._times_reached(cases))

    def evenly(self, cases: Any) -> tuple[Any, Any]:
        """From when on some cases go on with an even acceleration for good [s], and that [m/s**2],
        (2, ...), along the ground; infinite and 0 where they do not, or were not followed so far.
        """
        on = np.isin(self._ended[cases], _KNOWN_ON)
        since = np.where(on, self._times_reached(cases), np.inf)
        return since, self._push[:, cases] * self._length[cases] / self._second[cases] ** 2

    def _times_reached(self, cases: Any) -> Any:
        # What cannot be followed has no number.
        with np.errstate(all="ignore"):
            return self._reached[cases] * self._second[cases]

    def steps(self, cases: Any) -> Any:
        """When the steps of some cases begin and end [s], (moments, cases), as far as they were
        followed; the first again and again of one with fewer. None goes over an edge.
        """
        found = [np.zeros((1, len(cases)))]
        for piece in self._all_pieces():
            place = piece.place[cases]
            first, last = piece.first[place], piece.last[place]
            rows = first + np.arange(int(np.max(last - first, initial=0)) + 1)[:, None]
            moments = piece.rows[0, np.minimum(rows, last)]
            found.append(np.where(place >= 0, moments, 0.0))
        with np.errstate(all="ignore"):
            return np.sort(np.concatenate(found), axis=0) * self._second[cases]

    def _all_pieces(self) -> list[_Piece]:
        """All steps; those of a single case as one piece."""
        if self.count > 1 or not self._steps:
            return self._pieces
        ends = np.array([len(self._steps) - 1])
        none = np.zeros(1, dtype=int)
        return [_Piece(none, none, ends, np.array(self._steps).T)]

    def _reach(self, time: Any, cases: Any) -> None:
        """Follow some cases on until they have passed a time of each, in the units of steps."""
        _together([_Part(self, *due) for due in self._due(time, cases)])

    def _due(self, time: Any, cases: Any) -> list[tuple[Any, Any, bool]]:
        """Which cases are to be followed on for that, until when in the units of steps, and whether
        they have begun.
        """
        short = (self._reached[cases] <= time) & (self._ended[cases] == IN_TIME)
        if not short.any():
            return []
        wanted = float(np.max((time * self._second[cases])[short]))
        waits = (self._ended == IN_TIME) & ~self._left
        waits[cases[short]] = True
        which = np.flatnonzero(waits)
        until = wanted + _AHEAD if wanted < _TO_THE_END else np.inf
        until = np.minimum(until, _FOR_EVER) / self._second[which]
        until = np.maximum(until, self._reached[which])
        begun = self._reached[which] > 0.0
        kinds = ((~begun, False), (begun, True))
        return [(which[some], until[some], kind) for some, kind in kinds if some.any()]

    def keep(self, which: Any, begun: bool, found: Followed) -> None:
        """Keep how some cases went on, which had ``begun`` before or not."""
        whole, counts, ended, state = found
        if begun:
            # Steps begin where the ones before ended.
            start = self._state[:, which]
            leads = np.concatenate([start[:10], start[7:10]])
            whole = np.insert(whole, np.cumsum(counts) - counts, leads, axis=1)
            counts = counts + 1
        last = np.cumsum(counts) - 1
        answered = counts > 0
        ends = np.where(answered, whole[0, last] if whole.shape[1] else 0.0, 0.0)
        goes = np.flatnonzero((ended == GOES_ON) & answered)
        rows = whole[:, last[goes]]
        moves, rolls = np.any(rows[4:7] != 0.0, axis=0), _rolls_on(rows)
        ended[goes[moves]], ended[goes[rolls]] = PULLED_ON, ROLLS_ON
        self._push[:, which[goes]] = np.where(moves & ~rolls, rows[10:12], 0.0)
        ended[(ended == IN_TIME) & (ends >= _FOR_EVER / self._second[which])] = GOES_ON
        self._state[:, which], self._ended[which] = state, ended
        self._reached[which] = ends
        if self.count == 1:
            more = whole[:, begun:].T.tolist()
            self._steps += more
            self._times += [row[0] for row in more]
        else:
            place = np.full(self.count, -1)
            place[which[answered]] = np.flatnonzero(answered)
            self._pieces.append(_Piece(place, last - counts + 1, last, whole))

    def _within(self, piece: _Piece, time: Any, cases: Any, place: Any) -> Any:
        """The states of some cases in a piece, at or after its begin."""
        low, high = piece.first[place], piece.last[place]
        last, moments = high, piece.rows[0]
        for _ in range(int(np.max(high - low)).bit_length()):
            middle = (low + high + 1) // 2
            passed = moments[middle] <= time
            low, high = np.where(passed, middle, low), np.where(passed, high, middle - 1)
        before, after = piece.rows[:, low], piece.rows[:, np.minimum(low + 1, last)]
        took = after[0] - before[0]
        share = (time - before[0]) / np.where(took > 0.0, took, 1.0)
        ended = low >= last
        share = np.where(ended, 0.0, share)
        (px, py, heading), rates = between(before, after, share, self._spin[cases])
        length, second = self._length[cases], self._second[cases]
        how = self._ended[cases]
        known = np.isin(how, (RESTS, *_KNOWN_ON))
        beyond = np.where(ended & ~known, np.nan, 0.0)
        # At rest, or going on from the last row.
        rates = np.where(ended, 0.0 * rates + beyond, rates)
        on = np.flatnonzero(ended & np.isin(how, _KNOWN_ON))
        if len(on):
            row, spin = before[:, on], self._spin[cases[on]]
            last = _evenly(row, how[on] == PULLED_ON)
            places, going = gone_on(last, time[on] - row[0], spin)
            px[on], py[on], heading[on] = places
            rates[:, on] = [*going[:2], going[2] * spin]
        if self._rises is not None:
            px, py = in_plan(self._rises[:, cases], px, py)
        return np.array(
            [
                self._x[cases] + length * px + beyond,
                self._y[cases] + length * py + beyond,
                heading + beyond,
                length / second * rates[0],
                length / second * rates[1],
                rates[2] / second,
            ]
        )


def _evenly(row: Any, pulled: Any) -> list[Any]:
    """The state from which cases go on evenly, from their last row: under its forces, or where they
    are not ``pulled``, straight on.
    """
    share = 1.0 * pulled
    return [*row[:6], *(share * part for part in (row[6], *row[10:]))]


class _Part(NamedTuple):
    """Cases of one ``Following`` to be followed on, until a time of each, and whether they have
    begun.
    """

    following: Following
    which: Any
    until: Any
    begun: bool

    @property
    def kind(self) -> tuple[Any, ...]:
        """What is the same for all cases that can be in one array."""
        motion = self.following._motion
        areas = () if motion.areas is None else tuple(map(np.ndarray.tobytes, motion.areas.corners))
        return self.begun, motion.settings, motion.tolerance, areas


def reach(asked: Sequence[tuple[Following, Any, Any]]) -> None:
    """Follow the cases of several on, each until a time of its own from the start [s]: in one
    array, as far as they are of one kind.
    """
    _together(
        [
            _Part(following, *due)
            for following, time, cases in asked
            for due in following._due(time / following._second[cases], cases)
        ]
    )


def _together(parts: list[_Part]) -> None:
    while parts:
        kind = parts[0].kind
        alike = [part for part in parts if part.kind == kind]
        parts = [part for part in parts if part.kind != kind]
        blocks = -(-sum(len(part.which) for part in alike) // _BLOCK)
        cut = [np.array_split(np.arange(len(part.which)), blocks) for part in alike]
        for block in zip(*cut, strict=True):
            _follow(
                [
                    part._replace(which=part.which[some], until=part.until[some])
                    for part, some in zip(alike, block, strict=True)
                ]
            )


def _follow(parts: list[_Part]) -> None:
    """Follow some cases of one kind in one array."""
    motion = Motion.joined([part.following._motion.of(part.which) for part in parts])
    start = None
    if parts[0].begun:
        start = np.concatenate([part.following._state[:, part.which] for part in parts], axis=1)
    with np.errstate(all="ignore"):
        found = follow(motion, np.concatenate([part.until for part in parts]), start)
    begin, rows = 0, 0
    for part in parts:
        cases = slice(begin, begin + len(part.which))
        begin = cases.stop
        counts = found.counts[cases]
        own = slice(rows, rows + int(counts.sum()))
        rows = own.stop
        ended, state = found.ended[cases], found.state[:, cases]
        part.following.keep(
            part.which, part.begun, Followed(found.rows[:, own], counts, ended, state)
        )


def _rolls_on(rows: Any) -> Any:
    """Whether each of some cases, of which the last row is given, goes straight on."""
    _, _, _, _, vx, vy, turn, *_, ax, ay, yaw = rows
    speed, force = np.hypot(vx, vy), np.maximum(np.hypot(ax, ay), np.abs(yaw))
    return (speed > 0.0) & (force <= _NO_FORCE) & (np.abs(turn) <= _STRAIGHT * speed)
