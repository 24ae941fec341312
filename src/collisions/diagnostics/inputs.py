"""Findings on inputs whose size suggests another unit."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..reference import CONTACT_DURATION
from ..vehicle import Vehicle
from .case import Case, Examined, named, off_by
from .finding import Finding

# Of a contact from the centre of mass: in radii of gyration, and in metres where there is none.
_RADII, _FURTHEST = 3.0, 10.0


def suspect_inputs(case: Case) -> Iterator[Finding]:
    """Masses, speeds, yaw rates, inertias, levers, headings and a normal that no road vehicle has."""
    normal, origin = case.impact.inputs.bare_normal, case.impact.reconstruction
    if normal is not None:
        turns = abs(normal) / math.tau
        sentence = f"the normal was given as {normal:.6g} rad, {turns:.3g} turns; were degrees meant?"
        yield from case.above("suspect_angle", abs(normal), sentence, rounding=off_by(math.tau))
    for label, side in case.sides:
        vehicle, who = side.before, named(label, side)
        mass, inertia = vehicle.mass, vehicle.yaw_inertia
        yield from case.below("suspect_mass", mass, f"{who} has a mass of {mass:.6g} kg; were tonnes or slugs meant?", label)
        if not math.isinf(mass):
            sentence = f"{who} has a mass of {mass:.6g} kg; were grams meant, or an immovable body (inf)?"
            yield from case.above("suspect_heavy", mass, sentence, label)
        sentence = f"{who} goes at {vehicle.speed:.6g} m/s before; were km/h or mph meant?"
        if origin is not None and not {f"v{label}", f"speed_{label}"} & set(origin.known):
            sentence = f"{who} was found to go at {vehicle.speed:.6g} m/s before; check what was given"
        yield from case.above("suspect_speed", vehicle.speed, sentence, label)
        sentence = f"{who} turns at {vehicle.yaw_rate:.6g} rad/s before; were degrees/s meant?"
        if origin is not None and origin.method == "planar":
            sentence = f"{who} was found to turn at {vehicle.yaw_rate:.6g} rad/s before; check what was given"
        yield from case.above("suspect_yaw_rate", abs(vehicle.yaw_rate), sentence, label)
        if inertia is not None and not math.isinf(inertia) and not math.isinf(mass):
            radius = math.sqrt(inertia / mass)
            sentence = f"{who} has a yaw inertia of {inertia:.6g} kg m2, a radius of gyration of {radius:.3g} m; check its unit"
            yield from case.below("suspect_inertia_low", radius, sentence, label)
            yield from case.above("suspect_inertia_high", radius, sentence, label)
        point = case.impact.point
        if point is not None and vehicle.x is not None and vehicle.y is not None and not math.isinf(mass):
            lever = math.hypot(point[0] - vehicle.x, point[1] - vehicle.y)
            told = case.words.length(lever)
            sentence = f"the contact point is {told} from the centre of mass of {who}; check units (feet?) and origin"
            off = off_by(vehicle.x, vehicle.y, *point)
            yield from case.above("suspect_lever", lever, sentence, label, limit=_reach(vehicle), rounding=off)
        if vehicle.heading is not None:
            turns = abs(vehicle.heading) / math.tau
            sentence = f"{who} has a heading of {vehicle.heading:.6g} rad, {turns:.3g} turns; were degrees meant?"
            yield from case.above("suspect_angle", abs(vehicle.heading), sentence, label, rounding=off_by(math.tau))


def suspect_friction(case: Case) -> Iterator[Finding]:
    """A friction that no contact has; one that is infinite says that the contact sticks."""
    friction = case.impact.friction
    if friction is not None and not math.isinf(friction):
        sentence = f"the friction between the vehicles is {friction:.6g}; was percent meant, or a contact that sticks (inf)?"
        yield from case.above("suspect_friction", friction, sentence)


def suspect_distance(case: Case) -> Iterator[Finding]:
    """Centres of mass that are too far apart to have met, where no contact point tells."""
    vehicles = [side.before for _, side in case.sides]
    if case.impact.point is not None or any(math.isinf(vehicle.mass) for vehicle in vehicles):
        return
    places = [(float(vehicle.x), float(vehicle.y)) for vehicle in vehicles if vehicle.x is not None and vehicle.y is not None]
    if len(places) < 2:
        return
    distance = math.dist(*places)
    sentence = f"the centres of mass are {case.words.length(distance)} apart at the impact; check units (feet?) and origin"
    reach = sum(_reach(vehicle) for vehicle in vehicles)
    off = off_by(*places[0], *places[1])
    yield from case.above("suspect_distance", distance, sentence, limit=reach, rounding=off)


def _reach(vehicle: Vehicle) -> float:
    """How far a contact may be from the centre of mass."""
    inertia = vehicle.yaw_inertia
    return _FURTHEST if inertia is None or math.isinf(inertia) else _RADII * math.sqrt(inertia / vehicle.mass)


def suspect_drag(case: Examined) -> Iterator[Finding]:
    """Tyres that hold more than any."""
    sentence = f"the tyres are taken to have a drag of {case.drag:.6g} of gravity; were percent or m/s2 meant?"
    yield from case.above("suspect_drag", case.drag, sentence)


def suspect_duration(case: Examined) -> Iterator[Finding]:
    """A contact that lasts longer than any."""
    times = case.duration / CONTACT_DURATION.high
    sentence = (
        f"the contact is taken to last {case.duration:.6g} s, {times:.3g} times what was published; were milliseconds meant?"
    )
    yield from case.above("suspect_duration", times, sentence)
