"""When the impulse of a touch acts: at first touch, some time after it, or at a depth."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..messages.errors import InputError, NoSolutionError
from .against import moving_of
from .between import Between
from .contact import USUAL_DELAY
from .notices import Told
from .placing import BRIEF, normal_of
from .touching import LONGEST_SEARCH, Meeting, Pair, engaged, struck_face

# Faces within this angle [rad] of each other meet face to face.
_FACE_TO_FACE = math.radians(1.0)


def arrange(told: Told, pair: Between, cases: Any) -> None:
    """When the impulse of a touch acts."""
    if not len(cases) or pair.contact is None:
        return
    contact, moving = pair.contact, moving_of(pair)
    touch, take = pair.touch[cases], pair.ground.taker(cases)
    if not contact.from_outlines:
        pair.due[cases], pair.deepest[cases] = touch, False
        return
    depth = None if contact.depth is None else take(contact.depth)
    delay = take(USUAL_DELAY if contact.delay is None else contact.delay)
    later = touch + (np.maximum(delay, BRIEF) if depth is None else USUAL_DELAY)
    axis = pair.axis[cases] = struck_face(moving, touch, later, cases)
    _refuse_bare(told, pair, moving, cases, delay if depth is None else depth)

    def along(met: Meeting, some: Any) -> Any:
        return normal_of(pair, contact, met, axis[some], cases[some])

    due, deepest, unknown = engaged(
        moving, along, touch, cases, delay if depth is None else None, depth
    )
    if unknown.any():
        _refuse_unknown_depth(told, pair, cases[unknown])
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


def _refuse_bare(told: Told, pair: Between, moving: Pair, cases: Any, amount: Any) -> None:
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
    if flat.any() and told.single:
        one, other = pair.names
        raise InputError(
            f"{one} and {other} meet face to face, where the point at bare first touch "
            "depends on the last digit of a heading, and with it which way they spin; give "
            "a `delay=` or `depth=` above 0, or `normal=` and `point=`",
            code="bare_touch",
            argument="delay",
        )
    told.fail(cases[flat], "bare_touch")


def _refuse_unknown_depth(told: Told, pair: Between, cases: Any) -> None:
    """Refuse a depth of which it is not found out whether two come to it."""
    if told.single:
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
    told.fail(cases, "depth_undecided")
