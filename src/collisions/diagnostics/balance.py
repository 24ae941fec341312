"""Findings on a reconstruction by planar momentum, which knows courses and speeds but no contact."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..errors import Status
from ..reference import restitution_range
from ..travel.surfaces import GRAVITY
from .case import RATIO_OFF_BY, Balance, off_by, share
from .finding import Finding


def energy_gain(case: Balance) -> Iterator[Finding]:
    """More energy after than before."""
    gain = -case.energy_lost
    if case.solution.status == Status.ENERGY_GAIN:
        yield from case.above(
            "energy_gain", gain, f"the vehicles leave with {case.words.energy(gain)} more than they came with; none can"
        )


def restitution(case: Balance) -> Iterator[Finding]:
    """A restitution along the normal that was given, which no impact or no test has shown."""
    closing, e = case.solution.closing_speed, case.solution.restitution
    if closing is None or e is None:
        return
    if not closing > 0.0:
        sentence = (
            f"the centres do not approach along the normal: closing speed {case.words.speed(closing)}; it must point from A "
            f"into B"
        )
        yield from case.above("restitution_negative", math.inf, sentence)
        return
    highest = restitution_range(closing)[1]
    told = f"the restitution of the centres is {e:.3g} at a closing speed of {case.words.speed(closing)}"
    yield from case.above(
        "restitution",
        e,
        f"{told}, where {highest:.2g} is the highest that published values make plausible",
        limit=highest,
        rounding=RATIO_OFF_BY,
    )
    yield from case.above("restitution_negative", -e, f"{told}: they would pass through each other")


def near_collinear(case: Balance) -> Iterator[Finding]:
    """Courses along one line, across which momentum tells nothing."""
    solution = case.solution
    courses = [getattr(solution, name.replace("speed", "course")) for name in solution.unknowns]
    # Ten degrees themselves count, also where rounding makes more of them.
    angle = max(abs(math.remainder(courses[0] - courses[1], math.pi)) - off_by(*courses, math.pi), 0.0)
    yield from case.below(
        "near_collinear",
        angle,
        f"the courses of {' and '.join(solution.unknowns)} are {case.words.angle(angle)} from one line: across it, momentum "
        f"tells little of these speeds",
        or_at=True,
    )


def ill_conditioned(case: Balance) -> Iterator[Finding]:
    """Courses that magnify errors, and which of them most."""
    solution = case.solution
    told = []
    for answer, row in solution.sensitivity.items():
        name = max((name for name in row if name.startswith("course")), key=lambda name: abs(row[name]))
        told.append(f"{answer} moves by {case.words.speed(abs(row[name]) * math.pi / 180.0)} per degree of {name}")
    yield from case.above(
        "ill_conditioned",
        solution.condition,
        f"reconstruct.momentum has a condition of {case.words.plain(solution.condition)}: {'; '.join(told)}",
    )


def speed_backwards(case: Balance) -> Iterator[Finding]:
    """A vehicle that would have gone backwards along its course."""
    for name in case.solution.unknowns:
        speed = getattr(case.solution, name)
        yield from case.above(
            "speed_backwards",
            -speed,
            f"{name} is {case.words.speed(speed)}, backwards along its course: check the courses",
            name[6],
        )


def tyre_impulse(case: Balance) -> Iterator[Finding]:
    """Tyres that could do a good part of what the impact does."""
    most = case.drag * GRAVITY * case.duration
    for label, (who, delta_v, _) in case.told.items():
        part = share(most, delta_v)
        yield from case.above(
            "tyre_impulse",
            part,
            f"tyres of {who} that slide for {case.duration:.3g} s with a drag of {case.drag:.2g} give up to "
            f"{case.words.speed(most)}, {case.words.percent(part)} of its delta-V of {case.words.speed(delta_v)}",
            label,
        )


def suspect_inputs(case: Balance) -> Iterator[Finding]:
    """Masses, speeds and courses whose size suggests another unit."""
    solution = case.solution
    for label in "ab":
        who, mass = case.told[label].who, getattr(solution, f"mass_{label}")
        yield from case.below("suspect_mass", mass, f"{who} has a mass of {mass:.6g} kg; were tonnes or slugs meant?", label)
        yield from case.above("suspect_heavy", mass, f"{who} has a mass of {mass:.6g} kg; were grams meant?", label)
        speed = abs(getattr(solution, f"speed_{label}"))
        yield from case.above("suspect_speed", speed, f"{who} goes at {speed:.6g} m/s before; check units and courses", label)
        courses = {name: getattr(solution, name) for name in (f"course_{label}", f"course_{label}_after")}
        name, course = max(courses.items(), key=lambda item: abs(item[1] or 0.0))
        if course is not None:
            sentence = f"{name} is {course:.6g} rad, {abs(course) / math.tau:.3g} turns; were degrees meant?"
            yield from case.above("suspect_angle", abs(course), sentence, label, rounding=off_by(math.tau))
