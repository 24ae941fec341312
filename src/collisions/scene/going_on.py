"""How the two vehicles of a contact go on after it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..impact.impact import Impact, way_to_separation
from ..vehicle.tyres import Tyres
from .contact import Contact
from .lasting import Lasting, duration_of, lasts_of
from .meanwhile import During, InTime
from .motion import Course, moved


def go_on(
    kept: Lasting,
    courses: Mapping[str, Course],
    contact: Contact,
    which: Any,
    time: Any,
    states: Any,
    impact: Impact,
) -> Any:
    """Let both vehicles go on from the motion after the contact; when they do, which is later
    only for one that was followed in time.
    """
    ground = courses[contact.a].ground
    hold = lasting = np.zeros(len(which))
    if contact.duration is not None:
        lasting, hold = duration_of(contact, ground, which, time)
    way = way_to_separation(impact)
    passed = np.zeros(len(which), dtype=bool)
    if way is not None:
        whole, lasts = lasts_of(impact, len(which))
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
                side.before if impact.inputs.geometry == "first_contact" else side.at_compression
            )
            table = _ends(states[name], begins, way.moved[label], hold, state, passed)
            rises = ground.rises(ground.taker(which))
            back = table[1:4, 1] - table[1:4, 0] - hold * state[3:]
            state[:3] = np.where(passed, moved(table[1:4, 0], back, rises), state[:3])
            until = kept.until[name]
            until[which] = np.where(passed, ends, until[which])
            tables[label] = table
        afters[label] = state
    in_time = InTime(impact, tables) if tables else None
    every = np.arange(len(which))
    for label, (name, _) in sides.items():
        during = None if in_time is None else During(in_time, label, every)
        tyres = contact.tyres_after.get(name)
        _turn(
            kept, courses[name], which, (time, hold, lasting), afters[label], tyres, during, passed
        )
        if contact.duration is not None:
            kept.brake(name, which, time + hold - lasting, time + hold)
    return ends


def _turn(
    kept: Lasting,
    course: Course,
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
    (time, hold, lasting), name = times, course.name
    # A slope pulls for what a contact at the start had of its time before it, too: what of that
    # is still owed goes on.
    owed, since, to = kept.owed[name][:, which]
    left = owed * np.clip((to - time) / np.where(to > since, to - since, 1.0), 0.0, 1.0)
    more = np.maximum(left, lasting - hold)
    until = kept.braked[name][1, which]
    longer = ~passed & (until - time > hold)
    own = np.where(longer, until - time, hold)
    kept.owed[name][:, which] = more, time, time + own
    course.turn(which, time, own, state, tyres, during, own + more)
    # One that was followed in time has its own end.
    beyond = passed & (until > time + hold)
    if beyond.any():
        some, ends, rest = which[beyond], (time + hold)[beyond], (until - time - hold)[beyond]
        course.turn(some, ends, rest, course.at(ends, some), None, None, rest)


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
