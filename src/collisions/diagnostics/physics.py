"""Findings on the answer itself: energy, restitution, the impulse, and what the bodies do after."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..reference import restitution_range
from ..side import Side
from .case import Case, degrees, kmh, named
from .finding import Finding
from ..outlines import distance_outside, overlap, placed

# A shorter lever turns a car by nothing that could be seen.
_NO_LEVER = 0.01
# Ratios that round to the critical one have not passed it.
_ROUNDING = 1e-9


def energy_gain(case: Case) -> Iterator[Finding]:
    """More energy after than before."""
    impact = case.impact
    if not impact.ok:
        gain = -impact.energy_loss
        yield from case.above("energy_gain", gain, f"the impact ends with {gain:.6g} J more than it began with; none can")


def momentum_energy(case: Case) -> Iterator[Finding]:
    """The balances a reader would check by hand, from the speeds, against the impulse."""
    impact = case.impact
    impulse = math.hypot(impact.normal_impulse, impact.tangential_impulse)
    share: float = _share(impact.momentum_residual, impulse)
    what = f"momentum changes by {share:.2g} of the impulse"
    sides = (impact.a, impact.b)
    if not any(_moves_for_ever(side) for side in sides):
        before, after = (sum(_energy(side, which) for side in sides) for which in (0, 1))
        by_work = max(abs(impact.energy_loss), impact.energy_absorbed)
        by_speeds = _share(abs((before - after) - impact.energy_loss), by_work)
        if by_speeds > share:
            share = by_speeds
            what = (
                f"kinetic energies before and after differ by {before - after:.6g} J, and the impulse takes "
                f"{impact.energy_loss:.6g} J"
            )
    yield from case.above("momentum_energy", share, f"{what}: rounding of speeds that are large against the closing speed")


def _share(part: float, whole: float) -> float:
    """The quotient; infinite where there is nothing to compare with, or no number to compare."""
    if part == 0.0:
        return 0.0
    return part / whole if whole > 0.0 and math.isfinite(part) else math.inf


def _moves_for_ever(side: Side) -> bool:
    """Whether the kinetic energy is infinite, so that nothing can be taken from it."""
    before = side.before
    turning = before.yaw_inertia is not None and math.isinf(before.yaw_inertia) and before.yaw_rate != 0.0
    return turning or (math.isinf(before.mass) and before.speed > 0.0)


def _energy(side: Side, after: int) -> float:
    """Kinetic energy; that of a yaw rate which does not change is left out."""
    vehicle = side.after if after else side.before
    energy = 0.0 if math.isinf(vehicle.mass) else 0.5 * vehicle.mass * (vehicle.vx * vehicle.vx + vehicle.vy * vehicle.vy)
    if side.delta_yaw_rate == 0.0 or vehicle.yaw_inertia is None or math.isinf(vehicle.yaw_inertia):
        return energy
    return energy + 0.5 * vehicle.yaw_inertia * vehicle.yaw_rate * vehicle.yaw_rate


def restitution(case: Case) -> Iterator[Finding]:
    """A restitution that no test has shown at such a closing speed."""
    impact = case.impact
    highest = restitution_range(impact.closing_speed)[1]
    sentence = (
        f"restitution {impact.restitution:.3g} at a closing speed of {kmh(impact.closing_speed)}, where {highest:.2g} is the "
        f"highest that published values make plausible"
    )
    yield from case.above("restitution", impact.restitution, sentence, limit=highest)


def impulse_ratio(case: Case) -> Iterator[Finding]:
    """A tangential impulse beyond what ends the slip, or against it."""
    impact = case.impact
    ratio, critical = impact.impulse_ratio, impact.critical_impulse_ratio
    if ratio == 0.0 or impact.model == "linear_central":
        return
    share = math.inf if critical == 0.0 else ratio / critical
    if share < 0.0:
        share = math.inf
        what = f"drives the slip instead of ending it: the critical one is {critical:.3g}; check its sign"
    else:
        share = 1.0 if abs(share - 1.0) <= _ROUNDING else share
        what = f"is {share:.2f} of the critical one, {critical:.3g}, which already ends the slip"
    yield from case.above("impulse_ratio", share, f"the impulse ratio {ratio:.3g} {what}")


def jamming(case: Case) -> Iterator[Finding]:
    """A tangential impulse that presses the bodies together."""
    impact = case.impact
    if impact.regime not in ("given", "sliding"):
        return
    plain = impact.effective_mass * impact.closing_speed
    if not plain > 0.0:
        return
    share = 1.0 - plain / impact.compression_impulse
    yield from case.above(
        "jamming",
        share,
        f"the tangential impulse makes the normal one {impact.compression_impulse / plain:.2f} times as large: the ratio is "
        f"{share:.2f} of the one at which the bodies jam",
    )


def contact_points(case: Case) -> Iterator[Finding]:
    """Contact points that have not parted, where the model that was taken does not see them."""
    impact = case.impact
    point, (nx, ny) = impact.point, impact.normal
    if point is None or any(side.after.yaw_rate != 0.0 and side.after.x is None for _, side in case.sides):
        return
    (ax, ay), (bx, by) = (side.after.velocity_at(point) for _, side in case.sides)
    approach = nx * (ax - bx) + ny * (ay - by)
    yield from case.above(
        "contact_points_approach",
        approach,
        f"after the impact the contact points still approach at {kmh(approach)}: {impact.model} leaves the turning out",
    )


def outlines(case: Case) -> Iterator[Finding]:
    """Outlines that move into each other after."""
    if len(case.outlines) < 2:
        return
    duration = case.left_out.duration
    now, later = (
        overlap(*(placed(case.outlines[label], side.after, label, time) for label, side in case.sides))
        for time in (0.0, duration)
    )
    grown = later - max(now, 0.0)
    yield from case.above(
        "outlines_interpenetrate",
        grown,
        f"{duration:.3g} s after separation the outlines overlap by {later:.2f} m, {grown:.2f} m more than at the impact "
        f"({max(now, 0.0):.2f} m)",
    )


def yaw_against_lever(case: Case) -> Iterator[Finding]:
    """A vehicle that turns against what the normal impulse alone would do."""
    impact = case.impact
    if impact.point is None:
        return
    (nx, ny), (px, py) = impact.normal, impact.point
    for (label, side), sign in zip(case.sides, (-1.0, 1.0), strict=True):
        before = side.before
        centre = before.pivot if before.pivot is not None else (before.x, before.y)
        if centre[0] is None or centre[1] is None:
            continue
        lever = sign * ((px - centre[0]) * ny - (py - centre[1]) * nx)
        against = -math.copysign(1.0, lever) * side.delta_yaw_rate
        if abs(lever) > _NO_LEVER:
            yield from case.above(
                "yaw_against_lever",
                against,
                f"{named(label, side)} is turned by {math.degrees(side.delta_yaw_rate):.0f} degrees/s, against the lever of "
                f"the normal impulse ({abs(lever):.2f} m): friction decides which way it turns",
                label,
            )


def impulse_off_normal(case: Case) -> Iterator[Finding]:
    """A force far from perpendicular to the damage."""
    impact = case.impact
    angle = math.atan2(abs(impact.tangential_impulse), impact.normal_impulse)
    seen = [f"{named(label, side)} has a PDOF of {degrees(side.pdof)}" for label, side in case.sides if side.pdof is not None]
    told = f"; {', '.join(seen)} (0 ahead, positive clockwise)" if seen else ""
    yield from case.above(
        "impulse_off_normal", angle, f"the impulse is {degrees(angle)} off the normal, the direction of damage{told}"
    )


def point_outside(case: Case) -> Iterator[Finding]:
    """A contact point that is not on the vehicle."""
    point = case.impact.point
    if point is None:
        return
    for label, side in case.sides:
        if label in case.outlines:
            distance = distance_outside(placed(case.outlines[label], side.before, label), point)
            yield from case.above(
                "point_outside",
                distance,
                f"the contact point is {distance:.2f} m outside the outline of {named(label, side)}",
                label,
            )


def near_collinear(case: Case) -> Iterator[Finding]:
    """Courses along one line, across which momentum tells nothing."""
    a, b = case.impact.a.before, case.impact.b.before
    if not (a.speed > 0.0 and b.speed > 0.0) or math.isinf(a.mass) or math.isinf(b.mass):
        return
    # Scaled first: the product of two speeds may overflow.
    (ax, ay), (bx, by) = ((vehicle.vx / vehicle.speed, vehicle.vy / vehicle.speed) for vehicle in (a, b))
    angle = math.atan2(abs(ax * by - ay * bx), abs(ax * bx + ay * by))
    yield from case.below(
        "near_collinear",
        angle,
        f"the courses before are {degrees(angle)} from one line: across it, momentum tells little of the speeds",
        or_at=True,
    )


def tyre_impulse(case: Case) -> Iterator[Finding]:
    """Tyres that could do a good part of what the impact does."""
    found = case.left_out
    for (label, side), left in zip(case.sides, (found.a, found.b), strict=True):
        yield from case.above(
            "tyre_impulse",
            left.tyre_share_bound,
            f"tyres of {named(label, side)} that slide for {found.duration:.3g} s with a drag of {found.drag:.2g} give up to "
            f"{kmh(left.tyre_delta_v_bound)}, {left.tyre_share_bound:.0%} of its delta-V of {kmh(side.delta_v)}",
            label,
        )


def reference_range(case: Case) -> Iterator[Finding]:
    """Friction and impulse ratios beyond what was published."""
    impact = case.impact
    friction, ratio = impact.friction, abs(impact.impulse_ratio)
    slides = impact.regime in ("sliding", "frictionless") and impact.slip_before != 0.0 and impact.model != "linear_central"
    if friction is not None and slides:
        yield from case.below(
            "friction_low",
            friction,
            f"the contact slides with a friction of {friction:.3g}; 0.3 to 1.0 is recommended between vehicles, 0.55 usual",
        )
    yield from case.above(
        "ratio_high",
        ratio,
        f"the tangential impulse is {ratio:.2f} times the normal one, beyond friction between vehicles: parts must have "
        f"snagged, as in small-overlap tests (1.57 to 2.05)",
    )


def ill_conditioned(case: Case) -> Iterator[Finding]:
    """A reconstruction that magnifies errors."""
    origin = case.impact.reconstruction
    if origin is not None:
        yield from case.above(
            "ill_conditioned",
            origin.condition,
            f"reconstruct.{origin.method}: one percent in what was given ({', '.join(origin.known)}) may become "
            f"{origin.condition:.3g} percent of the closing speed in the speeds before",
        )
