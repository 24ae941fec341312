"""Both speeds of an instant, refined for a contact in which tyres act: those for which
``eccentric`` with its duration and tyres has what was known.

From components of delta-V they are found as without tyres, with the impulse of the tyres in the
balance. It follows from the speeds that are found, so they are found again with it until it changes
no more. All other pairs are found by Newton's method from those and from other speeds: beside a
known speed from where a scan of the other shows an answer.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import replace
from functools import partial, reduce
from typing import Any, NamedTuple

import numpy as np

from ..impact.inputs import Inputs, part_of
from ..impact.models import ECCENTRIC
from ..impact.run import solve_inputs
from ..impact.time_resolved_inputs import held_impulse
from ..kernels.reverse import energy_of_speeds
from ..messages.warning import quietly
from ..quantities.attributes import read_only
from ..quantities.directions import from_radians
from ..vehicle.vehicle import moved
from .common import Cases
from .grid_roots import Narrowing, roots_on_grid
from .lasting import misses_of_impacts, settle, slopes_at
from .speeds_algebra import EITHER, FREE, HELD, ROOT_TOL, Root, Scene
from .speeds_components import (
    ACCURACY,
    COMPONENTS,
    ComponentScene,
    by_way,
    fit_either,
    with_most_energy,
)

# Shares of the impulse of all tyres: below the first a change of it is rounding, above the second
# it has not settled; and how often it is worked out. Nearly all cases need fewer than 20.
_SAME, _STEADY, _ROUNDS = 1e-12, 1e-9, 64
# From when on only half of each change is made: tyres may turn back and forth with the speeds.
_HALVED = 20
# How often a contact may turn from stuck to slid or back before it counts as either: the tyres of
# the instant, which has none, may turn it once and their correction back.
_TURNS = 2
# Of the impulse of the tyres and of the speeds: what comes as near as that to a root leads to it.
_LEADS_TO = 0.03
# How often the directions are taken anew in which more components than are needed are met.
_TURNED = 3
# Of the speeds: answers that differ by no more are one.
_ONE_ANSWER = 1e-6
# The second of a pair that together is one energy.
_STANDS_FOR_NONE = ("ees_b", "max_crush_speed_b")
# Speeds that are tried beside those of the instant, as parts of what the known values stand for:
# where tyres weigh much there are answers that have none there.
_PARTS = (0.1, 0.3, 0.6, 1.0, 1.5)
# Beside a known speed the other is looked through in so many steps to either side, as far as this,
# in m/s, and as so many times the fastest answer of the instant.
_LINE_STEPS, _LINE_REACH = 64, 60.0
_TIMES_INSTANT = 2.0
# Roots there are narrowed until they lead to an answer, which is then refined; a turning point as
# near as this, as a share of the reach, may be one.
_ON_LINE = Narrowing(np.inf, rounds=2, turns=6, touching=1e-7, near=2.0, closer=2)
# Of the reach: what is missed by no more is met.
_ROUNDING = 1e-14
# Of so many of a case, of which the known values then say nothing, no more are tried.
_MOST_STARTS = 16


class Found(NamedTuple):
    """Speeds of A and B along their courses, where they have what was known, the closing speed,
    where the contact sticks, the condition, and by how much of the impulse the components are
    missed that are more than is needed, in all and of the vehicle that is missed by more; None
    where none is.
    """

    speed_a: Any
    speed_b: Any
    settled: Any
    closing: Any
    sticks: Any
    condition: Any
    misfit: Any = None
    worst: Any = None


class Attempt(NamedTuple):
    """A scene with what acts in it, its roots and where each is, the inputs with the friction that
    was used, the frictions by the way of a root, where they differ, and whether the components
    showed one.
    """

    scene: Scene
    found: list[tuple[Root, Any]]
    inputs: Inputs
    frictions: Sequence[Any] = ()
    shows: bool = False

    def inputs_of(self, root: Root) -> Inputs:
        """The inputs with the friction of a root."""
        return self.inputs_of_way(root.way)

    def inputs_of_way(self, way: Any) -> Inputs:
        """The inputs with the friction that goes with the way of a root."""
        if not self.frictions:
            return self.inputs
        friction = by_way(way, self.frictions)
        own: Any = read_only(friction) if np.ndim(friction) else float(friction)
        return replace(self.inputs, rule_value=own)

    def ways_of_starts(self, count: int) -> Any:
        """The way of each of so many starts, of which the first are the roots: of others that of
        the first root that a case has, and in a case without one the last, which is no root's.
        """
        none = max(len(self.frictions) - 1, 0)
        of_roots = [np.where(there, root.way, none) for root, there in self.found]
        first: Any = np.full(self.scene.shape, float(none))
        for (_, there), way in zip(self.found[::-1], of_roots[::-1], strict=True):
            first = np.where(there, way, first)
        return np.stack([*of_roots, *[first] * (count - len(of_roots))])


def in_balance(
    attempt: Callable[..., Attempt], numbers: Mapping[str, Any], cases: Cases, free: bool = False
) -> Attempt:
    """The roots from components of delta-V with the impulse of the tyres in the balance: those that
    each root of the instant comes to, and those that roots come to with what the tyres do where
    both cars go forwards.

    ``attempt`` solves with given impulses of the tyres, by the names in ``HELD``. Until they have
    settled, known values may differ by any amount, as the tyres may be what they differ by: the
    roots of the instant alone may be so far off that they lead to none or to another. With ``free``
    a contact that is stated to have stuck may take any friction until then, in cases without
    another root.
    """

    def of_free(held: Mapping[str, Any], most: float) -> Attempt:
        return attempt({**held, FREE: 1.0}, most)

    instant = attempt({}, math.inf)
    results: list[Attempt] = []
    kept: list[_Kept] = []
    doubts: list[tuple[Attempt, Any]] = []
    forwards = _forwards(instant, numbers, cases)
    begins = [(attempt, instant), (attempt, attempt(forwards, math.inf))]
    if free:
        # What it takes to stick may be too much only until the tyres are those of the answer.
        begins += [(of_free, of_free(one, math.inf)) for one in ({}, forwards)]
    for way, begun in begins:
        before = list(kept)
        for slot in range(max(len(begun.found), 1)):
            left: Any = np.ones(cases.shape or (), dtype=bool)
            if way is of_free:
                left = ~reduce(np.logical_or, (one.there for one in before), left & False)
            for halved in (_HALVED, 0):
                # Whole changes may lead past a root to where there is none.
                if not np.any(left):
                    break
                held, settled, at, left = _settled(
                    way, begun, slot, numbers, cases, before, left, halved
                )
                if (before or halved == 0 or way is of_free) and not np.any(settled):
                    continue
                last = attempt(held)
                results.append(last)
                if np.any(doubt := last.scene.ambiguous & settled):
                    doubts.append((last, doubt))
                if not last.found:
                    continue
                root, there = _followed(last, at)
                size = np.hypot(root.speed_a, root.speed_b)
                # Where known values differ by more than they may, the next root is another.
                same = abs(root.speed_a - at[0]) + abs(root.speed_b - at[1]) <= _LEADS_TO * size
                there = there & settled & same
                for earlier in kept:
                    there = there & ~(
                        earlier.there & (_apart(earlier.root, root) <= _ONE_ANSWER * size)
                    )
                if np.any(there):
                    kept.append(_Kept(root, there, last, held))
    if not results:
        return instant._replace(found=[])  # a batch of no cases
    kept, doubts = _best(kept, doubts)
    first = results[0]
    if not kept and all(one is first for one, _ in doubts):
        return first._replace(found=[])
    if len(kept) == 1 and kept[0].of is first and not first.frictions and not doubts:
        return first._replace(found=[(kept[0].root, kept[0].there)])
    return _as_one(first, kept, doubts)


class _Kept(NamedTuple):
    """A root in balance, where it is, of which attempt it is, and with what impulses of tyres."""

    root: Root
    there: Any
    of: Attempt
    held: Mapping[str, Any]


def _best(
    kept: Sequence[_Kept], doubts: Sequence[tuple[Attempt, Any]]
) -> tuple[list[_Kept], list[tuple[Attempt, Any]]]:
    """Those that meet the known values exactly, or else the one that fits best."""
    misfits = [np.where(one.there, _misfit(one.of, one.root.way), np.inf) for one in kept]
    misfits += [np.where(there, _misfit(one), np.inf) for one, there in doubts]
    if len(misfits) < 2:
        return list(kept), list(doubts)
    most = np.maximum(np.minimum.reduce(misfits), ROOT_TOL)
    best = [misfit <= most for misfit in misfits]
    return (
        [
            one._replace(there=one.there & here)
            for one, here in zip(kept, best, strict=False)
            if np.any(one.there & here)
        ],
        [
            (one, there & here)
            for (one, there), here in zip(doubts, best[len(kept) :], strict=True)
            if np.any(there & here)
        ],
    )


def _misfit(one: Attempt, way: Any = 0.0) -> Any:
    """By how much of the impulse a root misses what is known."""
    return one.scene.of_way(way).misfit if isinstance(one.scene, ComponentScene) else 0.0


def _apart(one: Root, other: Root) -> Any:
    """What the speeds of two roots differ by."""
    return abs(one.speed_a - other.speed_a) + abs(one.speed_b - other.speed_b)


def _as_one(
    first: Attempt, kept: Sequence[_Kept], doubts: Sequence[tuple[Attempt, Any]]
) -> Attempt:
    """One attempt with several roots, each of an attempt of its own; where none is, it is that of
    the ``first``, which is the last of the ways. In ``doubts`` are those in which the contact may
    have stuck or slid, and where.
    """
    scene = copy(first.scene)
    roots = [
        (one.root._replace(way=np.full(np.shape(one.there), float(i))), one.there)
        for i, one in enumerate(kept)
    ]
    if isinstance(scene, ComponentScene):
        ways = [(one.of, one.root.way, one.there, False) for one in kept]
        ways += [(one, 0.0, there, True) for one, there in doubts]
        ways.append((first, 0.0, np.zeros(first.scene.shape, dtype=bool), False))
        scene.ways = []
        for one, way, there, doubt in ways:
            assert isinstance(one.scene, ComponentScene)
            own = copy(one.scene.of_way(way))
            own.ambiguous = np.logical_and(there, doubt)
            scene.ways.append(own)
        theres = np.stack(np.broadcast_arrays(*(there for _, _, there, _ in ways)))
        answered = np.any(theres, axis=0)
        misfit = by_way(np.argmax(theres, axis=0), [one.misfit for one in scene.ways])
        scene.misfit = np.where(answered, misfit, scene.misfit)
        scene.undetermined = scene.undetermined & ~answered
        in_doubt = reduce(np.logical_or, (one.ambiguous for one in scene.ways))
        scene.ambiguous = in_doubt | (scene.ambiguous & ~answered)
    frictions = [one.of.inputs_of(one.root).rule_value for one in kept]
    frictions += [one.inputs.rule_value for one, _ in [*doubts, (first, None)]]
    shows = next((one.of for one in kept if one.of.shows), first)
    return Attempt(scene, roots, shows.inputs, frictions, shows.shows)


def _forwards(now: Attempt, numbers: Mapping[str, Any], cases: Cases) -> dict[str, Any]:
    """The impulses of tyres of cars that go forwards, as fast as what is known; none where they do
    not meet.

    What a tyre does hardly depends on how fast its car goes, only on which way.
    """
    shape = cases.shape or ()
    speeds = (now.scene.targets.get(f"speed_{label}", 1.0) for label in "ab")
    root = Root(*(np.broadcast_to(one, shape) for one in speeds), *[math.nan] * 3)
    found = _pushes(now, root, np.ones(shape, dtype=bool), numbers, cases)
    held = {name: np.where(np.isfinite(one), one, 0.0) for name, one in found.items()}
    return _plain(held | {EITHER: np.zeros(shape)}, shape)


def _settled(
    attempt: Callable[..., Attempt],
    now: Attempt,
    slot: int,
    numbers: Mapping[str, Any],
    cases: Cases,
    kept: Sequence[_Kept],
    sought: Any,
    halved: int,
) -> tuple[dict[str, Any], Any, tuple[Any, Any], Any]:
    """The impulses of the tyres that lead to the speeds from which they follow, where there are
    some, and those speeds; and in which cases they led nowhere.

    Only of cases that are ``sought``; from the round ``halved`` on half of each change is made.
    What leads to a root that was ``kept`` is not followed. A case that has settled stays, so that
    it comes out of a batch as alone. One in which a contact that stuck and one that slid lead to
    each other is ``EITHER`` from then on.
    """
    shape = cases.shape or ()
    held = {name: np.zeros(shape) for name in (*HELD, EITHER)}
    if not now.found:
        nowhere = np.full(shape, np.nan)
        none = np.zeros(shape, dtype=bool)
        return _plain(held, shape), none, (nowhere, nowhere), none
    sought = sought & now.found[slot][1]
    at = tuple(np.where(now.found[slot][1], speed, np.nan) for speed in now.found[slot][0][:2])
    slid, turns = _shows_slip(now, at, shape), np.zeros(shape)
    moving, settled, known = sought, np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool)
    for number in range(_ROUNDS):
        if not now.found:
            break
        root, there = _followed(now, at)
        at = tuple(
            np.where(moving & there, speed, was) for speed, was in zip(root[:2], at, strict=True)
        )
        new = _pushes(now, root, there, numbers, cases)
        size, change = _size(new), _differ(new, held)
        moving = moving & np.isfinite(change)
        for one in kept:
            near = _apart(one.root, root) <= _LEADS_TO * np.hypot(root.speed_a, root.speed_b)
            near = near & (_differ(new, one.held) <= _LEADS_TO * size) & one.there
            known = known | (moving & near)
            moving = moving & ~near
        share = 1.0 if number < halved else 0.5
        held |= {
            name: np.where(moving, held[name] + share * (new[name] - held[name]), held[name])
            for name in HELD
        }
        settled = settled | (moving & (change <= _STEADY * size))
        moving = moving & (change > _SAME * size)
        if not np.any(moving):
            break
        now = attempt(_plain(held, shape), math.inf)
        before, slid = slid, _shows_slip(now, at, shape)
        turns = turns + (moving & (slid != before))
        held[EITHER] = np.where(turns > _TURNS, 1.0, held[EITHER])
    return _plain(held, shape), settled, (at[0], at[1]), sought & ~settled & ~known


def _size(held: Mapping[str, Any]) -> Any:
    """The size of the impulses of tyres."""
    return np.sqrt(sum(held[name] ** 2 for name in HELD if not name.endswith("moment")))


def _differ(one: Mapping[str, Any], other: Mapping[str, Any]) -> Any:
    """The size of what impulses of tyres differ by."""
    return _size({name: one[name] - other[name] for name in HELD})


def _plain(held: dict[str, Any], shape: tuple[int, ...]) -> dict[str, Any]:
    """Floats for a single case."""
    return held if shape else {name: float(one) for name, one in held.items()}


def _followed(now: Attempt, at: tuple[Any, ...]) -> tuple[Root, Any]:
    """Of several roots that which is next to these speeds, and where it is."""
    if len(now.found) == 1:
        return now.found[0]
    apart = np.stack(
        [
            np.where(there, abs(root.speed_a - at[0]) + abs(root.speed_b - at[1]), np.inf)
            for root, there in now.found
        ]
    )
    nearest = np.argmin(np.where(np.isnan(apart), np.inf, apart), axis=0)
    roots, places = zip(*now.found, strict=True)
    return Root(*(by_way(nearest, parts) for parts in zip(*roots, strict=True))), by_way(
        nearest, places
    )


def _shows_slip(now: Attempt, at: tuple[Any, ...], shape: tuple[int, ...]) -> Any:
    """Where a friction is used: one that was given, or the ratio of a contact that slid."""
    inputs = now.inputs_of(_followed(now, at)[0]) if now.found else now.inputs
    return np.broadcast_to(np.isfinite(inputs.rule_value), shape)


def _pushes(
    now: Attempt, root: Root, there: Any, numbers: Mapping[str, Any], cases: Cases
) -> dict[str, Any]:
    """Impulses of the tyres at the speeds of a root, as ``eccentric`` works them out: by the
    impact without them.
    """
    bodies = []
    for label, body, speed in zip("ab", (now.inputs.a, now.inputs.b), root[:2], strict=True):
        speed = np.where(there, speed * now.scene.speed_unit, np.nan)
        course = (numbers[f"course_{label}[{i}]"] for i in range(2))
        vx, vy = (cases.values(speed * part) for part in course)
        bodies.append(moved(body, vx, vy, body.yaw_rate))
    inputs = replace(
        now.inputs_of(root),
        a=bodies[0],
        b=bodies[1],
        given=None,
        contact_velocity=None,
        duration=None,
    )
    bare = replace(inputs, tyres_a=None, tyres_b=None)
    with quietly(), np.errstate(all="ignore"):
        answer = solve_inputs(ECCENTRIC, bare, "nan")
        found: dict[str, Any] = {}
        for label in "ab":
            parts = held_impulse(replace(inputs, duration=now.inputs.duration), answer, label)
            names = (name for name in HELD if name[5] == label)
            found |= {
                name: np.where(there, part, np.nan) for name, part in zip(names, parts, strict=True)
            }
    return found


def speeds_with_tyres(
    inputs: Inputs,
    directions: Mapping[str, tuple[Any, Any]],
    instant: tuple[Any, Any],
    known: Mapping[str, Any],
    shape: tuple[int, ...],
    kept: int = 0,
) -> Found:
    """Speeds of A and B along their courses at which a contact with these tyres has what was known.

    ``inputs`` are those of ``eccentric`` with duration and tyres, in which the velocities count for
    nothing; ``directions`` has cosine and sine of each course by "a" and "b", ``instant`` the
    speeds that were found without tyres, below 0 for a motion backwards, ``known`` what was known,
    by the arguments of ``speeds``. Energies are those of the contact, without what the tyres take.
    More components of delta-V than are needed are met by least squares, all weighing alike as parts
    of the impulse, and a speed or an energy beside them exactly, as ``speeds`` does. The first
    ``kept`` starts are answers already, of which only the misfit is worked out.
    """
    start = [np.broadcast_to(np.asarray(speed, np.float64), shape) for speed in instant]
    speed = np.hypot(*start)
    sizes = [np.where(speed > 0.0, speed, 1.0)] * 2
    inputs_at = partial(_at_speeds, inputs, directions)

    def off(tried: Inputs, answer: Any) -> list[Any]:
        """The miss of each known value, as a share of its size."""
        return [
            part / sizes[0]
            for name, value in known.items()
            for part in _missed(name, value, known, tried, answer, directions)
        ]

    by_name = {name: value for name, value in known.items() if name not in _STANDS_FOR_NONE}
    exact = [name not in COMPONENTS for name in by_name]
    sought = [at for at, label in enumerate("ab") if f"speed_{label}" not in known]
    # By how much of the size the miss of each changes with the whole of it.
    weights = [
        (_part_of_impulse(inputs, name) if name in COMPONENTS else 1.0)
        * _as_speed(name, value, known, inputs)
        / sizes[0]
        for name, value in by_name.items()
    ]

    missed = misses_of_impacts(inputs_at, off)
    rows = slopes_at(missed, start, sizes)
    if len(rows) == 2:
        # As many as are sought, each of which is met.
        values, settled = settle(missed, start, sizes)
        closing, sticks, _ = _contact(inputs_at(values))
        slopes = slopes_at(missed, values, sizes)
        condition = _condition(slopes, [True, True], weights, sought, closing)
        return Found(values[0], values[1], settled, closing, sticks, condition)

    def equations(tried: Inputs, answer: Any) -> list[Any]:
        left = off(tried, answer)
        return [
            sum(part * one for part, one in zip(parts, left, strict=True))
            for parts in _met_together(rows, exact)
        ]

    values, settled = start, np.False_
    for _ in range(_TURNED):
        # The directions in which they are met are those of where the last round ended.
        values, settled = settle(misses_of_impacts(inputs_at, equations), values, sizes)
        rows = slopes_at(missed, values, sizes)
    if kept:
        values = [
            np.concatenate((begun[:kept], one[kept:]))
            for begun, one in zip(start, values, strict=True)
        ]
        settled = np.concatenate((np.isfinite(values[0][:kept]), settled[kept:]))
    tried = inputs_at(values)
    closing, sticks, answer = _contact(tried)
    of_vehicles = [
        sum(
            (one * sizes[0]) ** 2
            for one, name in zip(off(tried, answer), by_name, strict=True)
            if name in COMPONENTS and name[-1] == label
        )
        for label in "ab"
    ]
    impulse = np.hypot(answer.normal_impulse, answer.tangential_impulse)
    per_impulse = _mass_of_both(inputs) / impulse
    condition = _condition(slopes_at(missed, values, sizes), exact, weights, sought, closing)
    misfit, worst = (
        np.sqrt(one) * per_impulse for one in (sum(of_vehicles), np.maximum(*of_vehicles))
    )
    return Found(values[0], values[1], settled, closing, sticks, condition, misfit, worst)


def speeds_beside_an_energy(
    inputs: Inputs,
    directions: Mapping[str, tuple[Any, Any]],
    instant: tuple[Any, Any],
    known: Mapping[str, Any],
    shape: tuple[int, ...],
    kept: Sequence[Any],
    forward_only: bool,
) -> tuple[Found, Any]:
    """As ``speeds_with_tyres``, from components and an energy, and in which cases one that stuck
    and one that slid fit either way.

    As without tyres, one that slid loses that energy, and of one that stuck the components alone
    tell the speeds, while the energy is a reading that its loss is held against. ``kept`` has the
    misfits of the first starts, which are answers already: one that stuck may be taken for one that
    slid where it takes all of the friction, and loses another energy.
    """
    count = len(kept)
    slid = speeds_with_tyres(inputs, directions, instant, known, shape, count)
    if count:
        own_misfit = np.stack(np.broadcast_arrays(*kept, slid.misfit[0])[:-1])
        for part in (slid.misfit, slid.worst):
            part[:count] = np.fmax(part[:count], own_misfit)
    parts = {name: value for name, value in known.items() if name in COMPONENTS}
    stuck = speeds_with_tyres(inputs, directions, instant, parts, shape, count)
    there = stuck.settled & stuck.sticks
    # From a root that slid it has come to another one.
    there[:count] &= slid.sticks[:count]
    *_, answer = _contact(_at_speeds(inputs, directions, (stuck.speed_a, stuck.speed_b)))
    (name,) = known.keys() - parts.keys() - set(_STANDS_FOR_NONE)
    energy = _energy(name, known[name], known, inputs)
    with np.errstate(all="ignore"):
        # An energy goes as the square of the impulse, of which all misfits are shares.
        off = 0.5 * abs(energy / answer.energy_loss - 1.0)
    stuck = stuck._replace(
        **{
            part: np.fmax(0.0 if (one := getattr(stuck, part)) is None else one, off)
            for part in ("misfit", "worst")
        }
    )
    slid = slid._replace(settled=slid.settled & ~slid.sticks)
    # Of one start that which fits better.
    better = there & ~(slid.settled & (slid.misfit < stuck.misfit))
    found = Found(*(np.where(better, one, other) for one, other in zip(stuck, slid, strict=True)))
    reached = speeds_with_tyres(inputs, directions, instant, with_most_energy(known), shape)
    # The best of each. One that loses more fits too, also where none loses as little.
    own, *own_speeds, closing = _with_least(there, stuck, stuck.closing)
    other, *speeds = _with_least(slid.settled & (slid.worst <= ACCURACY), slid)
    there_too = reached.settled & ~reached.sticks & (reached.worst <= ACCURACY)
    _, *more_speeds = _with_least(there_too, reached)
    pairs = speeds, more_speeds
    either = fit_either(own, np.fmin(own, other), own_speeds, pairs, closing, forward_only)
    return found, either


def _with_least(there: Any, found: Found, *more: Any) -> list[Any]:
    """Of several starts of a case the least misfit of those that are there, infinite for none, and
    the speeds and what ``more`` is asked for where it is, NaN for none.
    """
    misfit = np.where(there & np.isfinite(found.worst), found.worst, np.inf)
    at = np.argmin(misfit, axis=0)[np.newaxis]
    values = [np.where(there, one, np.nan) for one in (found.speed_a, found.speed_b, *more)]
    return [np.take_along_axis(one, at, axis=0)[0] for one in (misfit, *values)]


def _met_together(rows: Sequence[Sequence[Any]], exact: Sequence[bool]) -> list[list[Any]]:
    """Of more known values than are sought the two equations that are met, each by the parts of
    what is missed: those of least squares, or the values that are ``exact`` and, along what leaves
    the first of these as it is, all others.

    ``rows`` say how what is missed of each changes with both speeds.
    """
    if not any(exact):
        return [[row[i] for row in rows] for i in range(2)]
    first = exact.index(True)
    met = [
        [1.0 if i == at else 0.0 for i in range(len(rows))]
        for at, alone in enumerate(exact)
        if alone
    ]
    x, y = rows[first]
    size = np.hypot(x, y)
    rest = [
        0.0 if alone else (row[1] * x - row[0] * y) / size
        for row, alone in zip(rows, exact, strict=True)
    ]
    return [*met, rest][:2]


def _condition(
    rows: Sequence[Sequence[Any]],
    exact: Sequence[bool],
    weights: Sequence[Any],
    sought: Sequence[int],
    closing: Any,
) -> Any:
    """How far relative errors of all known values, which count with these weights, may move the
    speeds that are sought, in closing speeds; infinite where the known values do not hold them.
    """
    with np.errstate(all="ignore"):
        met = _met_together(rows, exact)
        (p, q), (r, s) = (
            [sum(part * row[j] for part, row in zip(parts, rows, strict=True)) for j in range(2)]
            for parts in met
        )
        determinant = p * s - q * r
        inverse = ((s, -q), (-r, p))
        moved: Any = 0.0
        for at in sought:
            one, other = inverse[at]
            moved = np.maximum(
                moved,
                sum(
                    abs(one * first + other * second) * weight
                    for first, second, weight in zip(*met, weights, strict=True)
                ),
            )
        found = moved / abs(determinant * closing)
        return np.where(np.isfinite(found), found, np.inf)


def starts_on_line(
    inputs: Inputs,
    directions: Mapping[str, tuple[Any, Any]],
    instant: Sequence[tuple[Any, Any]],
    known: Mapping[str, Any],
    shape: tuple[int, ...],
) -> list[tuple[Any, Any]]:
    """Speeds to begin from beside a known speed and one other known value: where the latter is met,
    or all but met, along the speed that is not known.

    That is looked through as far as other starts would go, and further. ``instant`` has the speeds
    of each root of the instant.
    """
    label = "b" if "speed_a" in known else "a"
    at = "ab".index(label)
    reach = np.fmax(_PARTS[-1] * _most(inputs, known, shape), _LINE_REACH)
    for pair in instant:
        reach = np.fmax(reach, _TIMES_INSTANT * abs(pair[at]))
    fixed = np.broadcast_to(np.asarray(known[f"speed_{'ba'[at]}"], dtype=np.float64), shape)
    reaches, fixed_of = reach.ravel(), fixed.ravel()

    def mismatch(at_share: Any, case: Any) -> list[Any]:
        def take(value: Any) -> Any:
            return read_only(np.broadcast_to(value, shape).ravel()[case])

        part, own, along = (part_of(one, take) for one in (inputs, dict(known), dict(directions)))
        pair = at_share * reaches[case], fixed_of[case]
        tried = _at_speeds(part, along, pair if at == 0 else pair[::-1])
        with quietly(), np.errstate(all="ignore"):
            answer = solve_inputs(ECCENTRIC, tried, "nan")
            (missed,) = (
                one
                for name, value in own.items()
                if not name.startswith("speed")
                for one in _missed(name, value, own, tried, answer, along)
            )
            share = missed / reaches[case]
            # Of values that say nothing of the speed, what is missed is all rounding.
            return [np.where(abs(share) <= _ROUNDING, 0.0, share)]

    grid = np.arange(-_LINE_STEPS, _LINE_STEPS + 1.0) / _LINE_STEPS
    found: list[list[float]] = [[] for _ in range(reaches.size)]
    for case, _, share in roots_on_grid(mismatch, reaches.size, grid, _ON_LINE):
        if len(found[case]) < _MOST_STARTS:
            found[case].append(share * float(reaches[case]))
    speeds = np.full((max(map(len, found), default=0), reaches.size), np.nan)
    for case, of_case in enumerate(found):
        speeds[: len(of_case), case] = of_case
    pairs = [(speed.reshape(shape), fixed) for speed in speeds]
    return pairs if at == 0 else [(other, speed) for speed, other in pairs]


def other_starts(
    inputs: Inputs, known: Mapping[str, Any], shape: tuple[int, ...]
) -> list[tuple[Any, Any]]:
    """Speeds to begin from beside those of the instant.

    The largest is one and a half times what all known values together stand for.
    """
    most = _most(inputs, known, shape)
    of_each = [
        [np.broadcast_to(np.asarray(known[f"speed_{label}"], dtype=np.float64), shape)]
        if f"speed_{label}" in known
        else [part * most for part in _PARTS]
        for label in "ab"
    ]
    return [(one, other) for one in of_each[0] for other in of_each[1]]


def _most(inputs: Inputs, known: Mapping[str, Any], shape: tuple[int, ...]) -> Any:
    """Twice the speed that all known values together stand for."""
    # Of an energy its relative error counts half in the speed that it stands for.
    sizes = [
        _as_speed(name, value, known, inputs) * (2.0 if name == "energy_loss" else 1.0)
        for name, value in known.items()
        if name not in _STANDS_FOR_NONE
    ]
    return np.broadcast_to(np.asarray(2.0 * sum(sizes), dtype=np.float64), shape)


def _at_speeds(
    inputs: Inputs, directions: Mapping[str, tuple[Any, Any]], values: Sequence[Any]
) -> Inputs:
    """The inputs with these speeds of A and B along their courses."""
    a, b = (
        moved(body, value * directions[label][0], value * directions[label][1], body.yaw_rate)
        for label, body, value in zip("ab", (inputs.a, inputs.b), values, strict=True)
    )
    return replace(inputs, a=a, b=b, given=None, contact_velocity=None)


def _contact(inputs: Inputs) -> tuple[Any, Any, Any]:
    """The closing speed, whether the contact sticks, and the answer that has both."""
    with quietly(), np.errstate(all="ignore"):
        answer = solve_inputs(ECCENTRIC, inputs, "nan")
    return answer.closing_speed, answer.sticks, answer


def _as_speed(name: str, value: Any, known: Mapping[str, Any], inputs: Inputs) -> Any:
    """What a known value changes by, as a speed, where it changes by the whole of itself."""
    if name == "energy_loss" or name.startswith(("ees", "max_crush")):
        light = np.minimum(inputs.a.mass, inputs.b.mass)
        # An energy goes as the square of an EES or of a speed of maximum crush.
        power = 0.5 if name == "energy_loss" else 1.0
        return power * np.sqrt(2.0 * _energy(name, value, known, inputs) / light)
    return abs(value)


def _missed(
    name: str,
    value: Any,
    known: Mapping[str, Any],
    tried: Inputs,
    answer: Any,
    directions: Mapping[str, tuple[Any, Any]],
) -> list[Any]:
    """The miss of a known value, as a speed: none for what another one stands for."""
    label = name[-1]
    body: Any = getattr(tried, label, None)
    if name.startswith("speed"):
        c, s = directions[label]
        return [c * body.vx + s * body.vy - value]
    if name.startswith("delta_v"):
        dvx, dvy = (getattr(answer, f"delta_{axis}_{label}") for axis in ("vx", "vy"))
        if name in ("delta_v_a", "delta_v_b"):
            return [np.hypot(dvx, dvy) - value]
        c, s = from_radians(body.heading)
        along = c * dvx + s * dvy if "forward" in name else c * dvy - s * dvx
        return [_part_of_impulse(tried, name) * (along - value)]
    if name in _STANDS_FOR_NONE:
        return []
    lost = answer.energy_loss
    if name.startswith("max_crush"):
        absorbed = 0.5 * answer.closing_speed * answer.compression_impulse
        # An incomplete contact absorbs until it ends.
        lost = np.where(tried.restitution < 0.0, answer.energy_loss_normal, absorbed)
    # Energies as the speeds that they stand for.
    energy = _energy(name, value, known, tried)
    light = np.minimum(tried.a.mass, tried.b.mass)
    return [np.sqrt(2.0 * np.maximum(lost, 0.0) / light) - np.sqrt(2.0 * energy / light)]


def _part_of_impulse(inputs: Inputs, name: str) -> Any:
    """What makes a component of delta-V a part of the impulse, as a speed of both together."""
    return getattr(inputs, name[-1]).mass / _mass_of_both(inputs)


def _mass_of_both(inputs: Inputs) -> Any:
    """The mass of both vehicles, without one that is infinite, whose delta-V is none."""
    masses = inputs.a.mass, inputs.b.mass
    return sum(np.where(np.isinf(mass), 0.0, mass) for mass in masses)


def _energy(name: str, value: Any, known: Mapping[str, Any], inputs: Inputs) -> Any:
    """The energy that is known, or that known EES or speeds of maximum crush stand for."""
    if name == "energy_loss":
        return abs(value)
    return energy_of_speeds(inputs.a.mass, value, inputs.b.mass, known[f"{name[:-1]}b"])
