"""Where a contact acts: its normal and point, as given or from the outlines."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..impact.inputs import part_of
from ..messages.errors import InputError, MissingInputError
from .against import backwards, moving_of
from .between import Between
from .contact import Contact
from .notices import Told
from .touching import (
    TOUCHING,
    Meeting,
    distance_outside,
    first_apart,
    overlap_of,
    struck_face,
)

# So long [s] after a touch it is seen at the least of which edge at a corner the overlap stays
# least.
BRIEF = 1e-3
# Outlines may be this far apart [m] at a contact at a time with a normal and a point of its own,
# and the point this far outside of the nearer one. Positions to 10 cm each and outlines that are
# rounder than drawn explain 0.3 m, at which `diagnose` has a finding; nothing explains more than
# what a contact crushes.
_FAR = 0.5
# How exactly it is found when two first touched: a share of 2 to the power of minus this.
_HALVINGS = 40
# Axes are those of one face within the angle whose cosine this is.
_ALIKE = math.cos(math.radians(5.0))
# Outlines whose edges are this near in line [m] cross nowhere in particular.
_IN_LINE = 0.01


def place_of(
    told: Told, pair: Between, contact: Contact, which: Any, time: Any, states: Mapping[str, Any]
) -> tuple[Any, Any]:
    """Normal and point of a contact: as given, or of each case from the outlines."""
    take = pair.ground.taker(which)
    normal: Any = contact.normal
    point: Any = contact.point
    if pair.shapes is not None:
        _refuse_places(told, pair, contact, which, time)
    if not told.single:
        normal = None if normal is None else tuple(part_of(part, take) for part in normal)
        point = None if point is None else tuple(part_of(part, take) for part in point)
    if not contact.from_outlines:
        return normal, point
    if pair.shapes is None:
        lacks = [course.name for course in pair.courses if course.mover.outline is None]
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
    met, state_a, state_b = moving_of(pair).at(seen, which)
    which_axis = pair.axis[which]
    if not contact.touches and contact.normal is None:
        which_axis = _face(told, pair, contact, which, time)
    axis = normal_of(pair, contact, met, which_axis, which)
    centre, _, crossings = overlap_of(met.one, met.other)
    if contact.plane == "crossings":
        axis = through_crossings(met, crossings, axis)
    # Where outlines only touch, the corner that is ahead.
    nearest = _nearest_corner(met, axis)
    centre = np.where(np.isnan(centre), nearest, centre) + state_a[:2]
    sign = 1.0 if contact.a == pair.names[0] else -1.0
    if carried:
        fixed = [course.fixed for course in pair.courses]
        begun = [states[name] for name in pair.names]
        centre, axis = _carried_back(centre, axis, (state_a, state_b), begun, fixed)
    if normal is None:
        found = sign * axis
        normal = tuple(float(part[0]) if told.single else part for part in found)
    if point is None and contact.model not in ("linear_central", "oblique_central"):
        point = tuple(float(part[0]) if told.single else part for part in centre)
    return normal, point


def normal_of(pair: Between, contact: Contact, met: Meeting, axis: Any, cases: Any) -> Any:
    """The normal from the first of the pair to the second, of each case."""
    if contact.normal is None:
        return met.axis(axis)
    sign = 1.0 if contact.a == pair.names[0] else -1.0
    take = pair.ground.taker(cases)
    return sign * np.array([take(part) for part in contact.normal])


def _refuse_places(told: Told, pair: Between, contact: Contact, which: Any, time: Any) -> None:
    """Refuse a contact at a time at which the outlines are apart, and a point that is far from
    both.
    """
    if contact.touches and contact.point is None:
        return
    met, state_a, _ = moving_of(pair).at(time, which)
    # What comes from the outlines needs that they touch.
    most = TOUCHING if contact.from_outlines else _FAR
    apart = (met.gap > most) & (not contact.touches)
    when = f"at {float(time[0]):.4g} s"
    if told.single and apart[0]:
        raise InputError(
            f"{contact.a} and {contact.b} are {told.say(float(met.gap[0]), 'length', 3)} "
            f"apart {when}, where contact says that they meet; correct the states, `at=` or "
            "the outlines, or write `at='touch'`",
            code="contact_missing",
            argument="contacts",
            distance=float(met.gap[0]),
            time=float(time[0]),
            movers=(contact.a, contact.b),
        )
    told.fail(which[apart], "contact_missing")
    if contact.point is None:
        return
    take = pair.ground.taker(which)
    point = np.array([take(part) for part in contact.point]) - state_a[:2]
    off = np.array([distance_outside(point, one) for one in (met.one, met.other)])
    far = off.min(axis=0) > _FAR
    if told.single and far[0]:
        x, y = (told.say(float(take(part)[0]), "length", 3) for part in contact.point)
        one, other = (told.say(float(part), "length", 3) for part in off[:, 0])
        raise InputError(
            f"the point ({x}, {y}) of the contact of {contact.a} and {contact.b} lies {one} "
            f"outside the outline of {pair.names[0]} and {other} outside that of "
            f"{pair.names[1]} {when}, and may lie {told.say(_FAR, 'length', 3)} outside the "
            "nearer one; correct `point=`, the states or the outlines, or leave out normal "
            "and point, which then come from the outlines",
            code="point_outside",
            argument="contacts",
            time=float(time[0]),
            movers=(contact.a, contact.b),
        )
    told.fail(which[far], "point_outside")


def _face(told: Told, pair: Between, contact: Contact, which: Any, time: Any) -> Any:
    """Which axis is that of the face struck at first touch, of a contact at a time: in the
    scene, or before its start, to which both then came straight on.
    """
    moving, first = moving_of(pair), pair.began(which, time)
    met, *_ = moving.at(time, which)
    face = met.widest.copy()
    known = np.isfinite(first)
    if known.any():
        later = np.maximum(time, first + BRIEF)[known]
        face[known] = struck_face(moving, first[known], later, which[known])
    some = np.flatnonzero(~known)
    if not len(some):
        return face
    back, until = backwards(pair, which[some])
    every, begun = np.arange(len(some)), np.zeros(len(some))
    parted = first_apart(back, begun, until, every, 0.0)
    found = np.flatnonzero(np.isfinite(parted))
    _refuse_undecided(told, pair, contact, which[some[np.isinf(parted)]], met, time)
    low, high = begun[found], parted[found]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        apart = back.at(middle, found)[0].gap >= 0.0
        low, high = np.where(apart, low, middle), np.where(apart, middle, high)
    face[some[found]] = struck_face(back, high, np.minimum(begun[found], high - BRIEF), found)
    return face


def _refuse_undecided(
    told: Told, pair: Between, contact: Contact, cases: Any, met: Meeting, time: Any
) -> None:
    """Refuse a normal from outlines that overlap from the start, of which it is not known how
    they came to it.
    """
    if not len(cases) or not told.single:
        told.fail(cases, "face_undecided")
        return
    sign = 1.0 if contact.a == pair.names[0] else -1.0
    by_depth = np.argsort(-met.gaps[:, 0], kind="stable").tolist()
    axes = [(sign * met.axes[:, at, 0], -float(met.gaps[at, 0])) for at in by_depth]
    # Edges that are parallel have one normal.
    other = next(one for one in axes if axes[0][0] @ one[0] < _ALIKE)
    listed = " or ".join(
        f"({axis[0] + 0.0:.3g}, {axis[1] + 0.0:.3g}), along which they overlap by "
        f"{told.say(deep, 'length', 3)}"
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


def closing_at(contact: Contact, states: Mapping[str, Any], normal: Any, point: Any) -> Any:
    """Closing speed of each case where the impulse would act."""
    a, b = states[contact.a], states[contact.b]
    vx, vy = a[3] - b[3], a[4] - b[4]
    if point is not None:
        px, py = point
        vx = vx - a[5] * (py - a[1]) + b[5] * (py - b[1])
        vy = vy + a[5] * (px - a[0]) - b[5] * (px - b[0])
    return vx * normal[0] + vy * normal[1]


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


def through_crossings(met: Meeting, crossings: Any, face: Any) -> Any:
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
