"""The motion of vehicles on their tyres, followed step by step until they rest; areas of other
friction end steps.

Numbers are those of ``kernels.run_out``: over the speed at the start, that over gravity, and the
product of both.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..kernels.elementwise import select
from ..kernels.run_out import OF_GROUND, Settings, accelerations, ending, size, step
from .areas import Areas

# Found for a case: at rest; nothing slows it, or it does not stay where it stops; its steps do not
# come to an end; it was followed for as long as was asked for, and can be followed on.
RESTS, GOES_ON, NO_END, IN_TIME = 0, 1, 2, 3
# Once the motion is down to this part of the first, by the way that is left, it goes on straight.
_ENDING = 1e-2
# And down to this part of that, where wheels may come to an edge of an area.
_ON_EDGES = 0.1
# The time until rest is then at most this part of the whole, where the motion turns aside as fast
# as it slows.
_ENDING_TIME = 2.5e-4
_FIRST_STEP, _LONGEST_STEP, _MOST_TURN = 0.05, 4.0, 0.5
# Where the direction of the motion changes at less than this share of gravity, it comes to roll or
# slide straight.
_NEARLY = 0.05
# Shorter steps are of a motion that cannot be followed, such as an immense spin.
_SHORTEST_STEP = 1e-12
_MOST_STEPS = 10_000
# A slowing below this share of gravity is none.
_NO_SLOWING = 1e-9
# Cases that are left are followed one by one, in plain floats, which is quicker than arrays of
# them; not so where wheels may cross edges, which is found in arrays.
_FEW, _FEW_BESIDE_EDGES = 16, 2
# A step is wider than the one before by this at most, and by this share of what the error of smooth
# forces allows: theirs bend, and a step that failed was taken in vain.
_WIDEST, _SAFE = 1.5, 0.9
# Rows of a step: time, place, heading, velocities, accelerations at its start and at its end.
ROWS = 13
# Rows from which a case is followed on: time, place, heading, velocities, accelerations, way,
# width, the width that was wanted before an edge, and how fast the motion changed its direction on
# the vehicle at the last step.
STATE = 14

_NUMBERS = tuple(f"[{at}]" for at in range(OF_GROUND + 9))


class Motion(NamedTuple):
    """Cases to follow: numbers of the ground by rows, velocities and heading at the start, areas of
    other friction.
    """

    ground: Any
    start: Any
    areas: Areas | None
    settings: Settings
    tolerance: float

    def of(self, which: Any) -> Motion:
        """Those of some of the cases."""
        areas = None if self.areas is None else self.areas.of(which)
        return self._replace(ground=self.ground[:, which], start=self.start[:, which], areas=areas)

    @classmethod
    def joined(cls, parts: Sequence[Motion]) -> Motion:
        """The cases of several, which have the same polygons, settings and tolerance."""
        if len(parts) == 1:
            return parts[0]
        areas = [part.areas for part in parts if part.areas is not None]
        return parts[0]._replace(
            ground=np.concatenate([part.ground for part in parts], axis=1),
            start=np.concatenate([part.start for part in parts], axis=1),
            areas=Areas.joined(areas) if areas else None,
        )


@lru_cache(maxsize=8)
def _of_floats(settings: Settings) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The step, and the accelerations, of one case of floats."""
    from ..engine.floats import compile_for_floats

    return compile_for_floats(step, _NUMBERS, settings), compile_for_floats(
        accelerations, _NUMBERS[: OF_GROUND + 5], settings
    )


@lru_cache(maxsize=8)
def _of_rows(settings: Settings) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The step, and how near the end it is, of many cases: from parts that have the rows of their
    numbers.
    """
    from ..engine.rows import RowProgram

    return RowProgram(step, len(_NUMBERS), settings), RowProgram(ending, 7, ())


@lru_cache(maxsize=1)
def _ending_of_floats() -> Callable[..., Any]:
    """``ending`` of one case of floats, with the roots that arrays have, to the last bit."""
    from ..engine.floats import compile_for_floats

    return compile_for_floats(ending, _NUMBERS[:7], ())


class Followed(NamedTuple):
    """The rows of all steps, of (``ROWS``, steps), case by case and in order of time; how many each
    case has, what became of it, and from where those that wait are followed on.
    """

    rows: Any
    counts: Any
    ended: Any
    state: Any

    @property
    def ends(self) -> Any:
        """The first row of each case that is no longer its own."""
        return np.cumsum(self.counts)

    @property
    def by_case(self) -> list[Any]:
        """The rows of each case."""
        ends = self.ends.tolist()
        return [
            self.rows[:, end - count : end]
            for end, count in zip(ends, self.counts.tolist(), strict=True)
        ]


def follow(motion: Motion, until: Any = None, going: Any = None) -> Followed:
    """Follow all cases until they rest, or to the first step that ends at or after a time of each;
    from the start, or ``going`` on from the state of those that waited.
    """
    count = motion.start.shape[1]
    until = np.full(count, np.inf) if until is None else until
    kept: list[tuple[Any, Any]] = []
    found: Any = np.full(count, NO_END)
    state = np.zeros((STATE, count))
    if count <= _few(motion):
        for case in range(count):
            start = None if going is None else going[:, case].tolist()
            rows, found[case], state[:, case] = _one(motion.of([case]), start, float(until[case]))
            kept.append((np.full(rows.shape[1], case), rows))
    else:
        _several(motion, kept, found, state, going, until)
    followed = Followed(*_by_case(kept, count), found, state)
    if motion.settings.sloped:
        for case in np.flatnonzero(found == RESTS).tolist():
            last = followed.ends[case] - 1
            place = followed.rows[1:4, last] if followed.counts[case] else going[1:4, case]
            if not _holds(motion.of([case]), *place):
                found[case] = GOES_ON
    return followed


def _few(motion: Motion) -> int:
    """So many cases, and fewer, are followed one by one."""
    return _FEW if motion.areas is None else _FEW_BESIDE_EDGES


def _by_case(kept: list[tuple[Any, Any]], count: int) -> tuple[Any, Any]:
    """The rows of all steps, case by case and in order of time; and how many each case has."""
    if not kept:
        return np.empty((ROWS, 0)), np.zeros(count, dtype=int)
    cases, rows = (np.concatenate(part, axis=-1) for part in zip(*kept, strict=True))
    order = np.argsort(cases, kind="stable")
    return rows[:, order], np.bincount(cases, minlength=count)


def _wider(wrong: Any, tolerance: float) -> Any:
    """The factor by which the next step may be wider, from the error of the last one; NaN counts as
    a large error.
    """
    if isinstance(wrong, float):
        ratio: float = (tolerance / max(wrong, 1e-300)) ** 0.2
        return min(_WIDEST, max(0.2, _SAFE * ratio)) if wrong == wrong else 0.2
    return np.fmin(_WIDEST, np.fmax(0.2, _SAFE * (tolerance / np.maximum(wrong, 1e-300)) ** 0.2))


def _rounded(width: Any) -> Any:
    """The width down to the next of 4, 5, 6 and 7 times a power of two.

    The last digits of a width would pass on from step to step, and grow where the forces bend: the
    place of rest of a scene that is turned, or that hardly differs, would be another.
    """
    if isinstance(width, float):
        if math.isinf(width):
            return width  # of a case that is refused
        part, power = math.frexp(width)
        return math.ldexp(math.floor(8.0 * part), power - 3)
    part, power = np.frexp(width)
    return np.ldexp(np.floor(8.0 * part), power - 3)


def _last(motion: Motion) -> float:
    """The part of the motion that goes on straight."""
    return _ENDING * min(1.0, math.sqrt(motion.tolerance / 1e-5))


def _ends(time: Any, speed: Any, slowing: Any, aside: Any, tolerance: float) -> Any:
    """Whether the time to rest is known well enough: what slows the motion changes as its direction
    does.
    """
    part = _ENDING_TIME * max(1.0, math.sqrt(tolerance / 5e-7))
    return speed * aside <= part * time * slowing * slowing


def _settled(left: Any, drift: Any, slowing: Any, spin: Any, tolerance: float) -> Any:
    """Whether the motion keeps its direction on the vehicle from here, so that it goes on along an
    arc, as it does where no wheel begins or ends to slide.

    The change of that direction fades as fast as the square of the speed, so that over the way that
    is left it comes to ``drift / (2 slowing)``; its effect is weighed as the error of a step is.
    """
    return left * drift * (1.0 + spin) <= 2.0 * tolerance * slowing


def _one(
    motion: Motion, going: Sequence[float] | None, until: float
) -> tuple[Any, int, Sequence[float]]:
    """The rows of one case, what became of it, and its state, in plain floats; from the start, or
    ``going`` on from a state.
    """
    ground = [float(number) for number in motion.ground[:, 0]]
    areas, tolerance, spin, last = motion.areas, motion.tolerance, ground[17], _last(motion)
    alone, most = areas is None and not motion.settings.sloped, float(_settling(motion.ground)[0])
    stepped, forced = _of_floats(motion.settings)
    ends = _ending_of_floats()
    known: Any = None
    if going is None:
        time, x, y, way, width, wanted, drifted = 0.0, 0.0, 0.0, 0.0, _FIRST_STEP, 0.0, 0.0
        vx, vy, turn, heading = (float(number) for number in motion.start[:, 0])
    else:
        time, x, y, heading, vx, vy, turn, *known, way, width, wanted, drifted = going
        # Under the wheels the ground may be another from here.
        known = None if areas is not None else tuple(known)
    rows: list[tuple[float, ...]] = []
    found, bends = NO_END, 0.0
    for _ in range(_MOST_STEPS):
        if time >= until and (rows or going is not None):
            found = IN_TIME
            break
        # As of arrays, whose last bit may be another than that of ``math``.
        c, s = float(np.cos(heading)), float(np.sin(heading))
        if known is None:
            if areas is not None:
                ground[12:16] = areas.under(*_columns(x, y, heading, vx, vy, turn * spin))[
                    :, 0
                ].tolist()
            known = forced((*ground, vx, vy, turn, c, s))
            if known is None:
                break
            if not rows and going is None:
                rows.append((time, x, y, heading, vx, vy, turn, *known, *known))
        ending_now = ends((vx, vy, turn, *known, spin))
        if ending_now is None:
            break
        speed, slowing, aside, drift, slides, spins = ending_now
        if speed == 0.0 or not math.isfinite(speed + slowing):
            found = RESTS if speed == 0.0 else NO_END
            break
        stops = slowing > _NO_SLOWING
        left = 0.5 * speed * speed / slowing if stops else math.inf
        if slides or (spins and alone):
            edge = math.inf
            if areas is not None:
                edge = float(areas.ahead(*_columns(x, y, heading, vx / speed, vy / speed, left))[0])
            if left <= edge:
                found = RESTS if stops else GOES_ON
                if not stops:
                    # With the forces under which it goes on.
                    rows.append((time, x, y, heading, vx, vy, turn, *known, *known))
                break
            after = math.sqrt(max(speed * speed - 2.0 * slowing * edge, 0.0))
            took, share = 2.0 * edge / (speed + after), after / speed
            mean = 0.5 * (1.0 + share) * took
            time, way = time + took, way + edge
            x, y, heading = x + mean * vx, y + mean * vy, heading + mean * turn * spin
            vx, vy, turn = share * vx, share * vy, share * turn
            rows.append((time, x, y, heading, vx, vy, turn, *known, *known))
            known = None
            continue
        nears = left <= last * last * way and _ends(time, speed, slowing, aside, tolerance)
        arcs = (
            not nears
            and not motion.settings.sloped
            and stops
            and drift < drifted
            and _settled(left, drift, slowing, spin, tolerance)
            and _ends(time, speed, slowing, drift, tolerance)
        )
        if (nears or arcs) and (
            areas is None or bool(areas.clear(*_columns(x, y, heading, left))[0])
        ):
            found, bends = RESTS, 1.0 if arcs else 0.0
            break
        if areas is not None and nears and left <= (_ON_EDGES * last) ** 2 * way:
            found = RESTS
            break
        width = min(
            width,
            most if aside < _NEARLY else _LONGEST_STEP,
            _MOST_TURN / max(abs(speed * turn * spin), 1e-300),
        )
        if not wanted:
            width = _rounded(width)
        new = stepped((*ground, vx, vy, turn, c, s, *known, width))
        if new is None or width < _SHORTEST_STEP:
            break
        wrong = new[10]
        if not wrong <= tolerance:
            width *= min(_wider(wrong, tolerance), 0.9)
            continue
        took, after = new[6], math.sqrt(new[0] * new[0] + new[1] * new[1] + new[2] * new[2])
        row = (time + took, x + new[3], y + new[4], heading + new[5], *new[:3], *known, *new[7:10])
        if areas is not None:
            before = (time, x, y, heading, vx, vy, turn, *known, *known)
            share = float(
                areas.crossed(np.array([before]).T, np.array([row]).T, np.array([spin]))[0]
            )
            if share < 1.0:
                # To the width over which so much of the time passes.
                wanted, width = (
                    max(wanted, width),
                    width * _passed(share, took, width, speed, after),
                )
                continue
        rows.append(row)
        time, x, y, heading, vx, vy, turn = row[:7]
        way += 0.5 * (speed + after) * took
        drifted = drift
        known = new[7:10] if areas is None else None
        width, wanted = max(width * _wider(wrong, tolerance), wanted), 0.0
    table = np.array(rows, dtype=float).reshape(-1, ROWS).T
    if found == RESTS and known is not None and (vx, vy, turn) != (0.0, 0.0, 0.0):
        state = np.array([[time, x, y, heading, vx, vy, turn, *known]]).T
        table = np.concatenate([table, _to_rest(state, np.array([spin]), bends)], axis=1)
    forces = (0.0, 0.0, 0.0) if known is None else known
    return table, found, (time, x, y, heading, vx, vy, turn, *forces, way, width, wanted, drifted)


def _settling(ground: Any) -> Any:
    """The longest step of a vehicle that nearly rolls straight: its slip fades as fast as its tyres
    are stiff.
    """
    gyration, ahead = ground[16], ground[6]
    return 2.0 / (ground[5] * np.maximum(1.0, gyration * ahead * ahead))


def _columns(*numbers: Any) -> tuple[Any, ...]:
    """Each number as an array of one case."""
    return tuple(np.array([number]) for number in numbers)


def _passed(share: Any, took: Any, width: Any, before: Any, after: Any) -> Any:
    """The share of a step over which so much of its time passes, by the cubic of time over the
    step.
    """
    one, two = width * before / took, width * after / took
    part = share
    for _ in range(6):
        at = part * (one + part * ((3.0 - 2.0 * one - two) + part * (one + two - 2.0)))
        rate = one + part * (2.0 * (3.0 - 2.0 * one - two) + part * 3.0 * (one + two - 2.0))
        part = np.clip(part - (at - share) / np.maximum(rate, 0.05), 0.0, 1.0)
    return part if isinstance(share, np.ndarray) else float(part)


def _to_rest(state: Any, spin: Any, bends: Any) -> Any:
    """The row of rest, from those of time to accelerations: the forces slow the whole motion as
    they do now, and turn with the vehicle where the motion ``bends`` (1, else 0).
    """
    time, x, y, heading, vx, vy, turn, ax, ay, yaw = state
    speed, slowing, *_ = ending(vx, vy, turn, ax, ay, yaw, spin)
    takes = speed / slowing
    turns = 0.5 * takes * turn * spin
    # Along the chord of the arc.
    bend = bends * turns
    c, s, short = np.cos(0.5 * bend), np.sin(0.5 * bend), 1.0 - bend * bend / 24.0
    along = [c * vx - s * vy, s * vx + c * vy]
    place = [x + 0.5 * takes * (short * along[0]), y + 0.5 * takes * (short * along[1])]
    # Those that bring every part of it to rest at once.
    slowed = [-part / takes for part in (vx, vy, turn)]
    rate = bends * turn * spin
    begins = [slowed[0] - rate * vy, slowed[1] + rate * vx, slowed[2]]
    c, s = np.cos(bend), np.sin(bend)
    ends = [c * slowed[0] - s * slowed[1], s * slowed[0] + c * slowed[1], slowed[2]]
    none = 0.0 * time
    return np.array([time + takes, *place, heading + turns, none, none, none, *begins, *ends])


def _several(
    motion: Motion, kept: list[tuple[Any, Any]], found: Any, states: Any, start: Any, until: Any
) -> None:
    """The rows of all cases, followed together in arrays; those that are left over one by one."""
    areas, tolerance, last, few = motion.areas, motion.tolerance, _last(motion), _few(motion)
    alone = areas is None and not motion.settings.sloped
    ground: Any = motion.ground.copy()
    going: Any = np.arange(motion.start.shape[1])
    if start is None:
        state: Any = np.zeros((STATE, len(going)))
        state[4:7], state[3], state[11] = motion.start[:3], motion.start[3], _FIRST_STEP
    else:
        state = start.copy()
    first: Any = np.full(len(going), start is None)
    # Under the wheels the ground may be another from here.
    fresh: Any = first if areas is None else np.ones(len(going), dtype=bool)
    later = until
    stepped, ended = _of_rows(motion.settings)

    def noted(which: Any, rows: Any) -> None:
        kept.append((going[which], rows))

    for _ in range(_MOST_STEPS):
        if len(going) <= few:
            break
        c, s = np.cos(state[3]), np.sin(state[3])
        if fresh.any():
            some = np.flatnonzero(fresh)
            if areas is not None:
                turning = state[6, some] * ground[17, some]
                ground[12:16, some] = areas.of(some).under(*(*state[1:6, some], turning))
            state[7:10, some] = accelerations(
                *ground[:, some], *state[4:7, some], c[some], s[some], *motion.settings
            )
            if first.any():
                noted(some, np.concatenate([state[:10, some], state[7:10, some]]))
                first = np.zeros(len(going), dtype=bool)
            fresh = np.zeros(len(going), dtype=bool)
        spin = ground[17]
        speed, slowing, aside, drift, *straight = ended(state[4:10], spin)
        slides, spins = (part != 0.0 for part in straight)
        usable = np.isfinite(speed + slowing)
        stops = slowing > _NO_SLOWING
        left = np.where(stops, 0.5 * speed * speed / np.where(stops, slowing, 1.0), np.inf)
        straight = usable & (slides | (spins & alone)) & (speed > 0.0)
        some_straight = bool(straight.any())
        edge = np.full(len(going), np.inf)
        if areas is not None and some_straight:
            some = np.flatnonzero(straight)
            towards = state[4, some] / speed[some], state[5, some] / speed[some]
            edge[some] = areas.of(some).ahead(*(*state[1:4, some], *towards, left[some]))
        goes_on = straight & ~stops & ~np.isfinite(edge) if some_straight else straight
        nears = (left <= last * last * state[10]) & _ends(
            state[0], speed, slowing, aside, tolerance
        )
        if some_straight:
            nears &= ~straight
        arcs = nears
        if not motion.settings.sloped:
            arcs = (
                ~(nears | straight)
                & stops
                & (drift < state[13])
                & _settled(left, drift, slowing, spin, tolerance)
                & _ends(state[0], speed, slowing, drift, tolerance)
            )
        rests = nears | arcs
        if areas is not None and rests.any():
            some = np.flatnonzero(rests)
            brief = nears[some] & (left[some] <= (_ON_EDGES * last) ** 2 * state[10, some])
            x, y, heading = state[1:4, some]
            clear = areas.of(some).clear(x, y, heading, left[some])
            rests[some] = brief | clear
            arcs = arcs & rests
        if some_straight:
            rests |= straight & stops & (left <= edge)
        rests = usable & (rests | (speed == 0.0))
        if rests.any():
            moved = rests & (speed > 0.0)
            bends = np.where(arcs[moved], 1.0, 0.0) if not motion.settings.sloped else 0.0
            noted(moved, _to_rest(state[:10, moved], spin[moved], bends))
            found[going[rests]] = RESTS
        if some_straight:
            noted(goes_on, np.concatenate([state[:10, goes_on], state[7:10, goes_on]]))
            found[going[goes_on]] = GOES_ON
        slid = straight & ~rests & ~goes_on if some_straight else straight
        if slid.any():
            sliding, before = state[:, slid], speed[slid]
            after = np.maximum(before * before - 2.0 * slowing[slid] * edge[slid], 0.0) ** 0.5
            took, share = 2.0 * edge[slid] / (before + after), after / before
            mean = 0.5 * (1.0 + share) * took
            state[0, slid] += took
            state[1:4, slid] += mean * np.array([sliding[4], sliding[5], sliding[6] * spin[slid]])
            state[4:7, slid] *= share
            state[10, slid] += edge[slid]
            noted(slid, np.concatenate([state[:10, slid], state[7:10, slid]]))
            fresh |= slid
        stuck = ~usable | (state[11] < _SHORTEST_STEP)
        out = rests | goes_on | stuck
        steps = np.flatnonzero(~(out | slid))
        if len(steps):
            now, own = state, ground
            if len(steps) < len(going):
                now, own, c, s = state[:, steps], ground[:, steps], c[steps], s[steps]
                speed, aside, drift = speed[steps], aside[steps], drift[steps]
            turning = np.abs(speed * now[6] * own[17])
            longest = np.where(aside < _NEARLY, _settling(own), _LONGEST_STEP)
            widths = np.minimum(
                np.minimum(now[11], longest), _MOST_TURN / np.maximum(turning, 1e-300)
            )
            wanted = now[12]
            widths = np.where(wanted > 0.0, widths, _rounded(widths))
            new = stepped(own, now[4:7], c, s, now[7:10], widths)
            wrong, took, after = new[10], new[6], size(*new[:3])
            good = wrong <= tolerance
            rows = np.empty((ROWS, len(steps)))
            np.add(now[0], took, out=rows[0])
            np.add(now[1:4], new[3:6], out=rows[1:4])
            rows[4:7], rows[7:10], rows[10:] = new[:3], now[7:10], new[7:10]
            factor = _wider(wrong, tolerance)
            shorter = np.fmin(factor, 0.9)
            if areas is not None and good.any():
                before = np.concatenate([now[:10], now[7:10]])
                at = np.flatnonzero(good)
                share = np.ones(len(steps))
                share[at] = areas.of(steps[at]).crossed(before[:, at], rows[:, at], own[17, at])
                cut = share < 1.0
                part = _passed(share, took, widths, speed, after)
                shorter = np.where(good, np.where(cut, part, 1.0), shorter)
                wanted = np.where(cut, np.maximum(wanted, widths), wanted)
                good &= ~cut
            wider = np.maximum(widths * factor, wanted)
            wider = np.where(good, wider, widths * shorter)
            wanted = np.where(good, 0.0, wanted)
            drift = np.where(good, drift, now[13])
            way = 0.5 * (speed + after) * took
            if good.all():
                done = steps
            else:
                done, rows, way = steps[good], rows[:, good], way[good]
            noted(done, rows)
            if len(done) == len(going):
                state[:7], state[7:10] = rows[:7], rows[10:]
                state[10] += way
            else:
                state[:7, done], state[7:10, done] = rows[:7], rows[10:]
                state[10, done] += way
            if len(steps) == len(going):
                state[11], state[12], state[13] = wider, wanted, drift
            else:
                state[11, steps], state[12, steps], state[13, steps] = wider, wanted, drift
            if areas is not None:
                fresh[done] = True
        waits = ~out & (state[0] >= later)
        if waits.any():
            found[going[waits]], states[:, going[waits]] = IN_TIME, state[:, waits]
            out |= waits
        if out.any():
            on = np.flatnonzero(~out)
            ground, state, going, fresh, first, later = (
                ground[:, on],
                state[:, on],
                going[on],
                fresh[on],
                first[on],
                later[on],
            )
            areas = None if areas is None else areas.of(on)
    begun = bool(kept) or start is not None
    for left_over, one in enumerate(going.tolist()):
        rows, found[one], states[:, one] = _one(
            motion.of([one]),
            state[:, left_over].tolist() if begun else None,
            float(until[one]),
        )
        kept.append((np.full(rows.shape[1], one), rows))


def gone_on(state: Any, takes: Any, spin: Any) -> tuple[list[Any], list[Any]]:
    """Place and heading, and their rates, of cases that nothing slows, a while after a state of 10
    rows: the forces stay as they are, and they slide, roll or spin on under them.
    """
    _, x, y, heading, vx, vy, turn, ax, ay, yaw = state
    half = 0.5 * takes
    after = [vx + takes * ax, vy + takes * ay, turn + takes * yaw]
    place = [x + half * (vx + after[0]), y + half * (vy + after[1])]
    place.append(heading + half * (turn + after[2]) * spin)
    return place, after


def went_on(rows: Any, until: float, spin: float) -> Any:
    """The rows of a case that nothing slows, followed until a time."""
    takes = until - rows[0, -1]
    if not takes > 0.0:
        return rows
    forces = rows[10:, -1]
    place, after = gone_on([*rows[:7, -1], *forces], takes, spin)
    row = np.array([[until, *place, *after, *forces, *forces]]).T
    return np.concatenate([rows, row], axis=1)


def _holds(motion: Motion, x: float, y: float, heading: float) -> bool:
    """Whether a vehicle that came to rest on a slope stays there: a creep down the slope comes to
    an end.

    The forces of the tyres are those that take most work out of a motion, so a creep that can go on
    at all goes on from there.
    """
    ground = [float(number) for number in motion.ground[:, 0]]
    if motion.areas is not None:
        ground[12:16] = motion.areas.under(*_columns(x, y, heading, 0.0, 0.0, 0.0))[:, 0].tolist()
    if not math.isfinite(sum(ground) + x + y + heading):
        return True  # refused for that
    slope, spin = math.hypot(ground[18], ground[19]), 0.0
    along = abs(math.cos(heading) * ground[18] + math.sin(heading) * ground[19])
    if slope == 0.0:
        return True
    wheels = list(zip(ground[:4], ground[12:16], strict=True))
    held = [mu if lock >= 1.0 else min(mu, lock * ground[4]) for lock, mu in wheels]
    plain = not (motion.settings.steered or motion.settings.transfers)
    if plain and all(
        one > 1.001 * along and mu > 1.001 * slope
        for one, (_, mu) in zip(held, wheels, strict=True)
    ):
        # Every wheel can hold what it carries.
        return True
    ground[17] = spin
    stepped, forced = _of_floats(motion.settings)
    c, s = math.cos(heading), math.sin(heading)
    state, width = (-ground[18] / slope, -ground[19] / slope, 0.0), _FIRST_STEP
    known = forced((*ground, *state, c, s))
    for _ in range(_MOST_STEPS // 10):
        new = stepped((*ground, *state, c, s, *known, width))
        if new is None:
            return False
        if new[10] <= 1e-4:
            state, known = new[:3], new[7:10]
            speed = size(*state)
            if not 1e-3 < speed < 1.5:
                return bool(speed <= 1e-3)
        width = min(width * _wider(new[10], 1e-4), _LONGEST_STEP)
    return False


def between(before: Any, after: Any, share: Any, spin: Any) -> tuple[Any, Any]:
    """Place and heading, and their rates, at shares of the time of steps, from the rows at both
    ends.

    Polynomials of the fifth degree, which have the places, velocities and accelerations of both
    ends.
    """
    took = after[0] - before[0]
    u = share
    u2 = u * u
    u3, u4 = u2 * u, u2 * u2
    u5 = u4 * u
    scale = select(took > 0.0, took, 1.0)
    places, rates = [], []
    for at, factor in ((0, 1.0), (1, 1.0), (2, spin)):
        p, q = before[1 + at], after[1 + at]
        v, w = factor * before[4 + at] * took, factor * after[4 + at] * took
        a, b = factor * after[7 + at] * took * took, factor * after[10 + at] * took * took
        rise = q - p
        places.append(
            p + v * u + 0.5 * a * u2
            + (10.0 * rise - 6.0 * v - 4.0 * w - 1.5 * a + 0.5 * b) * u3
            + (-15.0 * rise + 8.0 * v + 7.0 * w + 1.5 * a - b) * u4
            + (6.0 * rise - 3.0 * (v + w) - 0.5 * (a - b)) * u5
        )  # fmt: skip
        rates.append((
            v + a * u
            + 3.0 * (10.0 * rise - 6.0 * v - 4.0 * w - 1.5 * a + 0.5 * b) * u2
            + 4.0 * (-15.0 * rise + 8.0 * v + 7.0 * w + 1.5 * a - b) * u3
            + 5.0 * (6.0 * rise - 3.0 * (v + w) - 0.5 * (a - b)) * u4
        ) / scale)  # fmt: skip
    if isinstance(share, float):
        return places, rates
    return np.array(places), np.array(rates)
