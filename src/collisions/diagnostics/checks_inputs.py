"""Findings on inputs: sizes that suggest another unit, and inputs missing for a check
of the model.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from ..impact.impact import Impact
from ..impact.inputs import PLACED, Inputs
from ..reference import CONTACT_DURATION
from ..vehicle.drag import HIGHEST_DRAG
from ..vehicle.vehicle import Vehicle
from .case import Case, ImpactCase, VehicleFigures, off_by
from .finding import NOTE, Measured, above, below, finding

# How far a contact may be from the centre of mass: in radii of gyration, and in metres where there
# is none.
_RADII, _FURTHEST = 3.0, 10.0
_WHOLE = 1e-12  # rad: the rounding of an angle from its unit vector


@finding(
    "mass",
    below(150.0, "kg"),
    "set here: no car is lighter, and a car of 1500 kg has 103 slug; tonnes or slugs as kg",
)
def suspect_mass(case: Case) -> Iterator[Measured]:
    for label, vehicle in case.vehicles.items():
        sentence = _of_mass(case, vehicle, "less than any car", "were tonnes or slugs meant?")
        yield Measured(vehicle.mass, sentence, label)


def _of_mass(case: Case, vehicle: VehicleFigures, unusual: str, doubt: str) -> str:
    """What a mass is, with a doubt of how it was given where it had no unit; a unit that was given
    is not in doubt.
    """
    if vehicle.mass_has_unit:
        return f"{vehicle.who} has a mass of {case.text(vehicle.mass, 'mass')}, {unusual}"
    return f"{vehicle.who} has a mass of {vehicle.mass:.6g} kg; {doubt}"


@finding(
    "finite mass",
    above(1e5, "kg"),
    "set here: no road vehicle is heavier; grams as kg, or an immovable body that should be inf",
)
def suspect_heavy(case: Case) -> Iterator[Measured]:
    immovable = ", or an immovable body (inf)" if isinstance(case, ImpactCase) else ""
    for label, vehicle in case.vehicles.items():
        if not math.isinf(vehicle.mass):
            doubt = f"were grams meant{immovable}?"
            sentence = _of_mass(case, vehicle, "more than any road vehicle", doubt)
            yield Measured(vehicle.mass, sentence, label)


@finding("speed before", above(44.0, "m/s"), "set here: 158 km/h; km/h or mph as m/s")
def suspect_speed(case: Case) -> Iterator[Measured]:
    for label, vehicle in case.vehicles.items():
        who, speed = vehicle.who, abs(vehicle.speed)
        fast = case.text(speed, "speed")
        sentence = f"{who} goes at {speed:.6g} m/s before; were km/h or mph meant?"
        if case.was_found(label, "speed"):
            sentence = f"{who} was found to go at {fast} before; check what was given"
        elif vehicle.speed_has_unit:
            sentence = f"{who} goes at {fast} before, which is unusually fast"
        yield Measured(speed, sentence, label)


@finding(
    "yaw rate before",
    above(20.0, "rad/s"),
    "set here: three turns a second, the limit of a number without a unit as well; deg/s as rad/s",
)
def suspect_yaw_rate(case: ImpactCase) -> Iterator[Measured]:
    for label, who, side in case.sides:
        rate = side.before.yaw_rate
        quick = case.text(rate, "yaw rate")
        sentence = f"{who} turns at {rate:.6g} rad/s before; were degrees/s meant?"
        if case.was_found(label, "yaw_rate"):
            sentence = f"{who} was found to turn at {quick} before; check what was given"
        elif "yaw_rate" in (case.stated(label).given or {}):
            sentence = f"{who} turns at {quick} before, which is unusually fast"
        yield Measured(abs(rate), sentence, label)


def _radii_of_gyration(case: ImpactCase, unusual: str) -> Iterator[Measured]:
    for label, who, side in case.sides:
        mass, inertia = side.before.mass, side.before.yaw_inertia
        if inertia is not None and not math.isinf(inertia) and not math.isinf(mass):
            radius = math.sqrt(inertia / mass)
            stated = {"mass", "yaw_inertia"} <= set(case.stated(label).given or {})
            sentence = (
                f"{who} has a radius of gyration of {case.text(radius, 'length')} by its yaw "
                f"inertia{f', {unusual}' if stated else '; check its unit'}"
            )
            yield Measured(radius, sentence, label)


@finding("radius of gyration", below(0.3, "m"), "set here: no vehicle is as compact; t·m² as kg·m²")
def suspect_inertia_low(case: ImpactCase) -> Iterator[Measured]:
    return _radii_of_gyration(case, "less than any car")


@finding(
    "radius of gyration",
    above(5.0, "m"),
    "set here: that of a rectangle 17 m long; lb·ft² as kg·m²",
)
def suspect_inertia_high(case: ImpactCase) -> Iterator[Measured]:
    return _radii_of_gyration(case, "more than any car")


@finding(
    "distance of the contact point from the centre of mass",
    above(
        "three radii of gyration of the vehicle, or 10 m where its yaw inertia is not known or "
        "infinite, or where the places were given with their unit",
        "m",
    ),
    "set here: the corner of a rectangle is 1.7 of its radii away, and a centre of mass may "
    "be off the middle; 10 m is half a road train; feet or cm as m, or two origins mixed",
)
def suspect_lever(case: ImpactCase) -> Iterator[Measured]:
    point = case.answer.point
    for label, who, side in case.sides:
        vehicle = side.before
        if (
            point is not None
            and vehicle.x is not None
            and vehicle.y is not None
            and not math.isinf(vehicle.mass)
        ):
            lever = math.hypot(point[0] - vehicle.x, point[1] - vehicle.y)
            far = case.text(lever, "length")
            stated = _has_units(case.stated(label), "x", "y")
            stated &= _has_units(case.answer.inputs, "point")
            doubt = "positions and origin" if stated else "units (feet?) and origin"
            sentence = f"the contact point is {far} from the centre of mass of {who}; check {doubt}"
            rounding = off_by(vehicle.x, vehicle.y, *point)
            limit = _FURTHEST if stated else _longest_lever(vehicle)
            yield Measured(lever, sentence, label, limit=limit, rounding=rounding)


def _has_units(whole: Vehicle | Inputs, *names: str) -> bool:
    """Whether these places were given with a unit, so that they are not feet read as metres; 0
    needs none.
    """
    given = whole.given or {}
    parts: dict[str, Any] = {}
    for name in names:
        value = getattr(whole, name)
        parts |= (
            {f"{name}[{i}]": part for i, part in enumerate(value)}
            if isinstance(value, tuple)
            else {name: value}
        )
    return any(name in given for name in parts) and all(
        value == 0.0 or name in given for name, value in parts.items()
    )


def _longest_lever(vehicle: Vehicle) -> float:
    inertia = vehicle.yaw_inertia
    return (
        _FURTHEST
        if inertia is None or math.isinf(inertia)
        else _RADII * math.sqrt(inertia / vehicle.mass)
    )


@finding(
    "without a contact point, distance between both centres of mass",
    above("both limits of suspect_lever together", "m"),
    "set here: as for suspect_lever",
)
def suspect_distance(case: ImpactCase) -> Iterator[Measured]:
    vehicles = [side.before for _, _, side in case.sides]
    places = [
        (float(vehicle.x), float(vehicle.y))
        for vehicle in vehicles
        if vehicle.x is not None and vehicle.y is not None
    ]
    if (
        case.answer.point is None
        and len(places) == 2
        and not any(math.isinf(vehicle.mass) for vehicle in vehicles)
    ):
        distance = math.dist(*places)
        far = case.text(distance, "length")
        stated = all(_has_units(case.stated(label), "x", "y") for label in "ab")
        doubt = "positions and origin" if stated else "units (feet?) and origin"
        sentence = f"the centres of mass are {far} apart at the impact; check {doubt}"
        longest = (
            2.0 * _FURTHEST if stated else sum(_longest_lever(vehicle) for vehicle in vehicles)
        )
        yield Measured(distance, sentence, limit=longest, rounding=off_by(*places[0], *places[1]))


@finding(
    "heading or course, or normal that was given as a number without a unit",
    above(math.tau, "rad"),
    "set here: a full turn, the limit of a number without a unit as well; degrees as rad",
)
def suspect_angle(case: Case) -> Iterator[Measured]:
    angles: list[tuple[str, str, float | None, bool]] = []
    if isinstance(case, ImpactCase):
        angles.append(("", "the normal was given as", case.answer.inputs.bare_normal, False))
        angles += [
            (
                label,
                f"{who} has a heading of",
                case.stated(label).heading,
                "heading" in (case.stated(label).given or {}),
            )
            for label, who, _ in case.sides
        ]
    else:
        for label in "ab":
            courses = {
                name: getattr(case.answer, name)
                for name in (f"course_{label}", f"course_{label}_after")
            }
            name = max(courses, key=lambda name: abs(courses[name] or 0.0))
            given = (case.answer.given or {}).get(name)
            angles.append((label, f"{name} is", courses[name], isinstance(given, str)))
    for label, what, angle, has_unit in angles:
        if angle is not None:
            turns = f"{abs(angle) / math.tau:.3g} turns"
            sentence = f"{what} {angle:.6g} rad, {turns}; were degrees meant?"
            if has_unit:
                sentence = f"{what} {case.text(angle, 'angle')}, {turns}; check it"
            yield Measured(abs(angle), sentence, label, rounding=off_by(math.tau))


@finding(
    "heading, course or normal that is a whole number of radians and was given without a unit",
    above(0.0, "rad"),
    "set here: nobody measures whole radians; degrees as rad",
)
def suspect_bare_angle(case: Case) -> Iterator[Measured]:
    angles: list[tuple[str, str, float | None]] = []
    if isinstance(case, ImpactCase):
        if not isinstance((case.answer.inputs.given or {}).get("normal"), str):
            angles += [
                ("", "the normal", case.answer.normal_angle + turn)
                for turn in (-math.tau, 0.0, math.tau)
            ]
        for label, who, _ in case.sides:
            vehicle = case.stated(label)
            if "heading" not in (vehicle.given or {}):
                angles.append((label, f"the heading of {who}", vehicle.heading))
    else:
        for name, given in (case.answer.given or {}).items():
            if name.startswith(("course", "heading")) and isinstance(given, (int, float)):
                angles.append((name.split("_")[1], name, float(given)))
    for label, what, angle in angles:
        # Those of more than a turn are found by suspect_angle.
        if angle is not None and abs(angle) <= math.tau:
            bare, degrees = round(angle), math.degrees(angle)
            sentence = (
                f"{what} is {bare} without a unit, which is {degrees:.0f} degrees; were {bare} "
                "degrees meant?"
            )
            yield Measured(float(abs(bare)) if abs(angle - bare) < _WHOLE else 0.0, sentence, label)


@finding(
    "finite friction between the vehicles",
    above(5.0),
    "set here: over twice the highest impulse ratio of the small-overlap tests (2.05); percent "
    "as a plain number",
)
def suspect_friction(case: ImpactCase) -> Iterator[Measured]:
    friction = case.answer.friction
    if friction is not None and not math.isinf(friction):
        sentence = (
            f"the friction between the vehicles is {friction:.6g}; was percent meant, or a "
            "contact that sticks (inf)?"
        )
        yield Measured(friction, sentence)


@finding(
    "drag of the tyres",
    above(HIGHEST_DRAG),
    "set here: no road tyre holds more, the limit of a number without a unit as well; percent or "
    "m/s² as a fraction of gravity",
)
def suspect_drag(case: Case) -> Iterator[Measured]:
    impact = _in_time(case)
    drag = case.drag if impact is None else impact.inputs.drag or 0.0
    sentence = (
        f"the tyres are taken to have a drag of {drag:.6g} of gravity; were percent or m/s² meant?"
    )
    yield Measured(drag, sentence)


def _in_time(case: Case) -> Impact | None:
    """The impact, where it was followed in time and so has a duration and a drag of its own."""
    impact = case.answer if isinstance(case, ImpactCase) else None
    return impact if impact is not None and impact.pulse is not None else None


@finding(
    "duration of the contact as a multiple of the longest that was published of rear-end "
    "impacts, 0.147 s",
    above(10.0),
    "set here: no contact of vehicles lasts ten times reference.CONTACT_DURATION; ms as s",
)
def suspect_duration(case: Case) -> Iterator[Measured]:
    pulse = None if (impact := _in_time(case)) is None else impact.pulse
    duration = case.duration if pulse is None else pulse.duration
    times = duration / CONTACT_DURATION.high
    sentence = (
        f"the contact is taken to last {duration:.6g} s, {times:.3g} times what was "
        "published; check it and its unit"
    )
    yield Measured(times, sentence)


@finding(
    "number of inputs that are missing to estimate the error of a central model", above(0.0), NOTE
)
def model_unknown(case: ImpactCase) -> Iterator[Measured]:
    name = case.answer.model
    if name not in PLACED:
        choice, _ = case.model_choice
        missing = choice.missing["eccentric"]
        if missing and math.isnan(choice.errors[name]):
            yield Measured(
                len(missing),
                f"the error of {name} cannot be estimated; supply {', '.join(missing)}",
            )
