"""Findings on inputs whose size suggests another unit."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..provenance import BareAngle
from ..reference import CONTACT_DURATION
from .case import Case, Examined, named, off_by
from .finding import Finding


def suspect_inputs(case: Case) -> Iterator[Finding]:
    """Masses, speeds, yaw rates, inertias, levers, headings and a normal that no road vehicle has."""
    normal = case.impact.normal
    if isinstance(normal, BareAngle):
        turns = abs(normal.radians) / math.tau
        sentence = f"the normal was given as {normal.radians:.6g} rad, {turns:.3g} turns; were degrees meant?"
        yield from case.above("suspect_angle", abs(normal.radians), sentence, rounding=off_by(math.tau))
    for label, side in case.sides:
        vehicle, who = side.before, named(label, side)
        mass, inertia = vehicle.mass, vehicle.yaw_inertia
        yield from case.below("suspect_mass", mass, f"{who} has a mass of {mass:.6g} kg; were tonnes or slugs meant?", label)
        if not math.isinf(mass):
            sentence = f"{who} has a mass of {mass:.6g} kg; were grams meant, or an immovable body (inf)?"
            yield from case.above("suspect_heavy", mass, sentence, label)
        sentence = f"{who} goes at {vehicle.speed:.6g} m/s before; were km/h or mph meant?"
        yield from case.above("suspect_speed", vehicle.speed, sentence, label)
        sentence = f"{who} turns at {vehicle.yaw_rate:.6g} rad/s before; were degrees/s meant?"
        yield from case.above("suspect_yaw_rate", abs(vehicle.yaw_rate), sentence, label)
        if inertia is not None and not math.isinf(inertia) and not math.isinf(mass):
            radius = math.sqrt(inertia / mass)
            sentence = f"{who} has a yaw inertia of {inertia:.6g} kg m2, a radius of gyration of {radius:.3g} m; check its unit"
            yield from case.below("suspect_inertia_low", radius, sentence, label)
            yield from case.above("suspect_inertia_high", radius, sentence, label)
        point = case.impact.point
        if point is not None and vehicle.x is not None and vehicle.y is not None and not math.isinf(mass):
            lever = math.hypot(point[0] - vehicle.x, point[1] - vehicle.y)
            sentence = f"the contact point is {lever:.3g} m from the centre of mass of {who}; check units and origin"
            yield from case.above("suspect_lever", lever, sentence, label)
        if vehicle.heading is not None:
            turns = abs(vehicle.heading) / math.tau
            sentence = f"{who} has a heading of {vehicle.heading:.6g} rad, {turns:.3g} turns; were degrees meant?"
            yield from case.above("suspect_angle", abs(vehicle.heading), sentence, label, rounding=off_by(math.tau))


def suspect_duration(case: Examined) -> Iterator[Finding]:
    """A contact that lasts longer than any."""
    times = case.duration / CONTACT_DURATION.high
    sentence = (
        f"the contact is taken to last {case.duration:.6g} s, {times:.3g} times what was published; were milliseconds meant?"
    )
    yield from case.above("suspect_duration", times, sentence)
