"""How two movers move against each other, and until when that is known."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..vehicle.drag import in_plan
from .between import APART, Between
from .motion import Course, Ground, follow_on
from .touching import Pair

# Two that are pushed on as evenly as this [m/s**2] go on evenly beside each other.
_NO_PUSH = 1e-8


def moving_of(pair: Between) -> Pair:
    """The outlines of both in motion, at any time of the scene."""
    one, other = pair.courses
    assert pair.shapes is not None

    def states(time: Any, cases: Any) -> tuple[Any, Any]:
        follow_on((one, other), time, cases)
        return (
            _in_plan(pair.ground, one.at(time, cases), cases),
            _in_plan(pair.ground, other.at(time, cases), cases),
        )

    kept: list[Any] = []

    def bounds(cases: Any) -> Any:
        if not kept:
            every = np.arange(one.count)
            rows = (*one.bounds(every), *other.bounds(every))
            kept.append(np.array([np.broadcast_to(row, one.count) for row in rows]))
        return kept[0][:, cases]

    reach_a, reach_b = (shape.reach for shape in pair.shapes)

    def speeds(cases: Any, state_a: Any, state_b: Any) -> Any:
        return one.fastest(cases, state_a, reach_a) + other.fastest(cases, state_b, reach_b)

    return Pair(*pair.shapes, states, bounds, speeds)


def _in_plan(ground: Ground, state: Any, cases: Any) -> Any:
    """States as outlines meet: in plan, in which velocities along a slope are less."""
    if not ground.steepest:
        return state
    rises = ground.rises(ground.taker(cases))
    return np.array([*state[:3], *in_plan(rises, state[3], state[4]), state[5]])


def backwards(pair: Between, cases: Any) -> tuple[Pair, Any]:
    """Both vehicles backwards from the start of some cases, unslowed, on a clock that runs
    back; and until when they may be in contact on it [s].
    """
    assert pair.shapes is not None
    start = np.zeros(len(cases))
    begin = [
        _in_plan(pair.ground, course.at(start, cases, before=True), cases)
        for course in pair.courses
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


def horizon(pair: Between, cases: Any) -> Any:
    """Until when two movers may touch [s]."""
    courses = pair.courses
    assert pair.shapes is not None
    goes_on = cases
    if not pair.ground.steepest:
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
        _, state_a, state_b = moving_of(pair).at(last[some], cases[some])
        reach = pair.shapes[0].reach + pair.shapes[1].reach + 2.0 * APART
        push = (push_b - push_a)[:, some]
        last[some] += _left_behind(
            state_b[:2] - state_a[:2], state_b[3:5] - state_a[3:5], push, reach
        )
    return last


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


def ends_of(pair: Between, cases: Any) -> Any:
    """When both movers rest [s], to which they are followed; infinite where one goes on, and
    where its motion is not known to its end, until when it is.
    """
    courses = pair.courses
    for course in courses:
        course.to_end(cases)
    since, moves, _ = zip(*(course.evenly(cases) for course in courses), strict=True)
    rests = np.where(np.any(moves, axis=0), np.inf, np.max(since, axis=0))
    return np.minimum(rests, lost_of(courses, cases))


def lost_of(courses: Iterable[Course], cases: Any) -> Any:
    """From when on the motion of some movers is not known [s], as far as they were followed."""
    return np.min([course.lost(cases) for course in courses], axis=0)


def refuse_lost(courses: Iterable[Course], cases: Any, time: Any) -> Any:
    """Which cases are left in which the motion of some movers is known until a time of each;
    the others are refused.
    """
    good = np.ones(len(cases), dtype=bool)
    for course in courses:
        course.until(time, cases)
        lost = course.lost(cases) < time
        course.refuse_lost(cases[lost])
        good &= ~lost
    return good
