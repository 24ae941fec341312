"""What has to be doubted of an impact that was found backwards: a speed backwards along its course,
courses near one line, and a contact that was taken to stick and may have slid.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..kernels.contact_laws import FRICTION
from ..messages.shares import percent_beyond
from ..reference import INTER_VEHICLE_FRICTION, RECORDER_ACCURACY
from .impact import Impact
from .reconstruction import NOT_THIS, Reconstruction, from_components, known_in_words

# Courses that are this near one line tell little of both speeds.
NEARLY_COLLINEAR = math.radians(10.0)
# Between vehicles a contact may slide from this impulse ratio on.
MAY_SLIDE = INTER_VEHICLE_FRICTION.low
# In m/s (0.4 km/h): a speed backwards by less is below what evidence shows.
BACKWARDS = 0.1
# One percent of the motions after may become more than ten of the closing speed.
MOTIONS_CANCEL = 10.0


def doubts(impact: Impact) -> Iterator[str]:
    """Each doubt in a sentence without a unit; of a batch, with the number of its cases."""
    origin = impact.reconstruction
    if origin is None:
        return
    answered = np.logical_not(impact.refused)
    for name, speed in speeds_along(impact).items():
        sentence = (
            f"{name} was found backwards along its course (its size is printed): check the "
            "courses, and the normal, which must point from A into B"
        )
        yield from in_cases(answered & np.less(speed, -BACKWARDS), sentence)
    angle = angle_of_courses(origin)
    if angle is not None:
        sentence = (
            f"course_a and course_b are within {math.degrees(NEARLY_COLLINEAR):.2g} degrees of one "
            "line: small errors of delta-V and of the courses move both speeds far"
        )
        yield from in_cases(answered & np.less(angle, NEARLY_COLLINEAR), sentence)
    growth = growth_by_motions(impact)
    yield from in_cases(answered & (growth > MOTIONS_CANCEL), motions_cancel(growth))
    share = shares_apart(impact)
    yield from in_cases(share > RECORDER_ACCURACY.high, apart_in_words(impact, share))
    if taken_to_stick(impact):
        ratio = np.abs(impact.impulse_ratio)
        slides = answered & (ratio >= MAY_SLIDE) & np.equal(impact.regime, "sticking")
        shown = float(np.max(np.where(slides, ratio, 0.0), initial=0.0))
        yield from in_cases(slides, sticking_needs(shown, NOT_THIS))


def sticking_needs(ratio: float, if_it_slid: str) -> str:
    """The sentence on a contact that was taken to stick with an impulse ratio at which it may have
    slid.
    """
    return (
        f"to stick, the contact needs an impulse ratio of {ratio:.2f}, and contacts between "
        f"vehicles slide from {MAY_SLIDE:g} on; if it slid, {if_it_slid}"
    )


def growth_by_motions(impact: Impact) -> Any:
    """How large a relative error of the motions after may become in the closing speed, where that
    was found from them and a restitution; else 0.

    The closing speed goes with the separation speed, a difference of the velocities that both
    vehicles have at the contact, along the normal.
    """
    origin, point = impact.reconstruction, impact.point
    if origin is None or origin.method != "planar" or "restitution" not in origin.known:
        return 0.0
    assert point is not None
    (nx, ny), parts = impact.normal, 0.0
    for side in (impact.a, impact.b):
        body = side.after
        with np.errstate(all="ignore"):
            vx, vy = body.velocity_at(point)
            at_point = nx * vx + ny * vy
            along = 0.0 if body.pivot is not None else nx * body.vx + ny * body.vy
            parts = parts + np.abs(along) + np.abs(at_point - along)
    with np.errstate(all="ignore"):
        return np.where(impact.refused, 0.0, parts / np.abs(impact.separation_speed))


def motions_cancel(growth: Any) -> str:
    """The sentence on the largest growth of errors of the motions after."""
    most = float(np.max(growth, initial=0.0))
    return (
        "along the normal, the velocities at the contact after nearly cancel: one percent of them "
        f"may become {most:.0f} percent of the closing speed"
    )


def in_cases(where: Any, sentence: str) -> Iterator[str]:
    """The sentence where it holds, of a batch with the number of cases; nothing where in none."""
    count = int(np.count_nonzero(where))
    if count:
        of = "" if np.ndim(where) == 0 else f"in {count} of {np.size(where)} cases, "
        yield of + sentence


def speeds_along(impact: Impact) -> dict[str, Any]:
    """The speeds that were found along a known course, by name, below 0 where backwards."""
    origin = impact.reconstruction
    found: dict[str, Any] = {}
    if origin is None:
        return found
    for label in "ab":
        course = origin.given.get(f"course_{label}")
        if f"speed_{label}" in origin.found and course is not None:
            before = getattr(impact, label).before
            with np.errstate(all="ignore"):
                along = before.vx * np.cos(course) + before.vy * np.sin(course)
            found[f"speed_{label}"] = along
    return found


def angle_of_courses(origin: Reconstruction) -> Any:
    """How far both courses are from one line, where both speeds were found from components of
    delta-V along courses that were given; else None.
    """
    if not from_components(origin.known) or len(origin.found) < 2:
        return None
    if not {"course_a", "course_b"} <= origin.given.keys():
        return None  # one that stands needs no course
    return from_one_line(origin.given["course_a"], origin.given["course_b"])


def from_one_line(one: Any, other: Any) -> Any:
    """How far two courses are from one line, in either direction."""
    # A refused case may have no number.
    with np.errstate(all="ignore"):
        between = np.mod(np.subtract(one, other), np.pi)
        return np.minimum(between, np.pi - between)


def shares_apart(impact: Impact) -> Any:
    """How far components of delta-V that were given are from the answer, as a share of the impulse;
    0 without an answer, or where none were given.
    """
    origin = impact.reconstruction
    if origin is None or origin.misfit is None:
        return 0.0
    return np.where(impact.refused, 0.0, origin.misfit)


def apart_in_words(impact: Impact, shares: Any) -> str:
    """The sentence on the largest of these shares."""
    origin, most = impact.reconstruction, float(np.max(shares, initial=0.0))
    if origin is None or most == 0.0:
        return "components of delta-V that were given agree"
    names = [name for name in origin.known if not name.startswith("recorder")]
    known = " and ".join(f"the {words}" for words in known_in_words(names))
    up_to = "" if np.ndim(shares) == 0 else "up to "
    much = percent_beyond(most, RECORDER_ACCURACY.high)
    # What is given of friction moves a contact that slid.
    slid = impact.inputs.rule not in (None, *origin.found) and np.any(
        np.not_equal(impact.regime, "sticking")
    )
    rule = f"the {impact.inputs.rule}, ".replace("_", " ") if slid else ""
    energy = any(name.startswith(("energy", "ees", "max_crush")) for name in names)
    twice = f" (or {200.0 * most:.0f} percent of the energy)" if energy else ""
    return (
        f"{known} differ from this answer by {up_to}{much} percent of the impulse{twice}, "
        f"where recorders are accurate to {100.0 * RECORDER_ACCURACY.high:.0f} percent: {rule}one "
        "of them, a course or the geometry is wrong"
    )


def taken_to_stick(impact: Impact) -> bool:
    """Whether components of delta-V told the speeds of an impact only because it was stated, or
    taken, to have stuck.
    """
    origin = impact.reconstruction
    return (
        origin is not None
        and impact.inputs.rule == FRICTION
        and from_components(origin.known)
        and (
            origin.regime == "sticking"
            or not any(name.startswith(("speed", "energy", "ees")) for name in origin.known)
        )
        and not any(np.any(side) for side in (origin.one_sided or {}).values())
    )
