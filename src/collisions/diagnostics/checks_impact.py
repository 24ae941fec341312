"""Findings on the answer itself: energy, restitution, the impulse, and what the bodies do after."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..outlines import distance_outside, overlap, placed
from ..reference import restitution_range
from ..side import Side
from .case import RATIO_OFF_BY, Case, named, off_by, outline_off_by, share
from .finding import Finding

# Of positions and outlines together.
_READ_TO = 0.3
# Slower than this, in m/s, a course tells little; faster than this, in rad/s, a vehicle spins.
_GOES, _SPINS = 1.0, 0.5
_BACKWARDS = math.radians(135.0)


def energy_gain(case: Case) -> Iterator[Finding]:
    """More energy after than before."""
    impact = case.impact
    if not impact.ok:
        gain = -impact.energy_loss
        yield from case.above(
            "energy_gain", gain, f"the impact ends with {case.words.energy(gain)} more than it began with; none can"
        )


def rounding(case: Case) -> Iterator[Finding]:
    """The balances a reader would check by hand, from the speeds, against the impulse."""
    impact = case.impact
    impulse = math.hypot(impact.normal_impulse, impact.tangential_impulse)
    off: float = share(impact.momentum_residual, impulse)
    what = f"momentum changes by {off:.2g} of the impulse"
    sides = (impact.a, impact.b)
    if not any(_moves_for_ever(side) for side in sides):
        before, after = (sum(_energy(side, which) for side in sides) for which in (0, 1))
        by_work = max(abs(impact.energy_loss), impact.energy_absorbed)
        by_speeds = share(abs((before - after) - impact.energy_loss), by_work)
        if by_speeds > off:
            off = by_speeds
            what = (
                f"kinetic energies before and after differ by {case.words.energy(before - after)}, and the impulse takes "
                f"{case.words.energy(impact.energy_loss)}"
            )
    yield from case.above("rounding", off, f"{what}: rounding of speeds that are large against the closing speed")


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
        f"restitution {impact.restitution:.3g} at a closing speed of {case.words.speed(impact.closing_speed)}, where "
        f"{highest:.2g} is the highest that published values make plausible"
    )
    yield from case.above("restitution", impact.restitution, sentence, limit=highest, rounding=RATIO_OFF_BY)


def impulse_ratio(case: Case) -> Iterator[Finding]:
    """A tangential impulse beyond what ends the slip, or against it."""
    impact = case.impact
    ratio, critical = impact.impulse_ratio, impact.critical_impulse_ratio
    # A contact with one degree of freedom has no critical ratio.
    if ratio == 0.0 or math.isnan(critical) or impact.model == "linear_central":
        return
    part = math.inf if critical == 0.0 else ratio / critical
    if part < 0.0:
        part = math.inf
        what = f"drives the slip instead of ending it: the critical one is {critical:.3g}; check its sign"
    else:
        part = 1.0 if abs(part - 1.0) <= RATIO_OFF_BY else part
        what = f"is {part:.2f} of the critical one, {critical:.3g}, which already ends the slip"
    yield from case.above("impulse_ratio", part, f"the impulse ratio {ratio:.3g} {what}")


def friction_gain(case: Case) -> Iterator[Finding]:
    """A tangential impulse that puts energy in."""
    impact = case.impact
    gain = -impact.energy_loss_tangential
    part = share(gain, impact.energy_absorbed) if gain > 0.0 else 0.0
    yield from case.above(
        "friction_gain",
        part,
        f"the tangential impulse adds {case.words.energy(gain)}, {case.words.percent(part, 1)} of the energy absorbed, where "
        f"friction can only take it: the slip turns round during the contact, which one impulse ratio does not tell",
    )


def jamming(case: Case) -> Iterator[Finding]:
    """A tangential impulse that presses the bodies together."""
    impact = case.impact
    if impact.regime not in ("given", "sliding"):
        return
    plain = impact.effective_mass * impact.closing_speed
    if not plain > 0.0 or impact.compression_impulse == 0.0:
        return
    part = 1.0 - plain / impact.compression_impulse
    yield from case.above(
        "jamming",
        part,
        f"the tangential impulse makes the normal one {impact.compression_impulse / plain:.2f} times as large: the ratio is "
        f"{part:.2f} of the one at which the bodies jam",
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
        f"after the impact the contact points still approach at {case.words.speed(approach)}: {impact.model} leaves the "
        f"turning out",
    )


def outlines(case: Case) -> Iterator[Finding]:
    """Outlines that lie in each other or apart at the impact, or move into each other after."""
    # Also one outline alone is placed, so that one without a place is refused.
    both = [
        [placed(case.outlines[label], side.after, label, time) for label, side in case.sides if label in case.outlines]
        for time in (0.0, case.duration)
    ]
    if len(case.outlines) < 2:
        return
    now, later = (overlap(*outlines) for outlines in both)
    off = sum(outline_off_by(case.outlines[label], side.after, case.duration) for label, side in case.sides)
    depth = max(now, 0.0)
    grown = later - depth
    yield from case.above(
        "outlines_interpenetrate",
        grown,
        f"{case.duration:.3g} s after separation the outlines overlap by {case.words.length(later)}, "
        f"{case.words.length(grown)} more than at the impact ({case.words.length(depth)})",
        rounding=off,
    )
    crush = case.left_out.mutual_crush
    yield from case.above(
        "outlines_overlap",
        depth,
        f"at the impact the outlines overlap by {case.words.length(depth)}, and the impact crushes both together by "
        f"{case.words.length(crush)} in {case.duration:.3g} s; check positions and headings",
        limit=crush + _READ_TO,
        rounding=off,
    )
    yield from case.above(
        "outlines_gap",
        -now,
        f"at the impact there is a gap of {case.words.length(-now)} between the outlines; check positions and headings",
        rounding=off,
    )


def normal_against_positions(case: Case) -> Iterator[Finding]:
    """A normal that does not point from A into B."""
    impact = case.impact
    (nx, ny), point = impact.normal, impact.point
    centres = [
        None if vehicle.x is None or vehicle.y is None or math.isinf(vehicle.mass) else (vehicle.x, vehicle.y)
        for vehicle in (impact.a.before, impact.b.before)
    ]
    if point is None:
        a, b = centres
        if a is not None and b is not None:
            behind = nx * (a[0] - b[0]) + ny * (a[1] - b[1])
            yield from case.above(
                "normal_against_positions",
                behind,
                f"along the normal, which points from A into B, the centre of B is {case.words.length(behind)} behind that "
                f"of A; check the normal and the positions",
                rounding=off_by(*a, *b),
            )
        return
    for (label, side), sign, centre in zip(case.sides, (1.0, -1.0), centres, strict=True):
        if centre is not None:
            behind = sign * (nx * (centre[0] - point[0]) + ny * (centre[1] - point[1]))
            yield from case.above(
                "normal_against_positions",
                behind,
                f"the normal, which points from A into B, points {'away from B' if label == 'b' else 'back into A'}: the "
                f"centre of {named(label, side)} is {case.words.length(behind)} on the wrong side of the contact point",
                label,
                rounding=off_by(*centre, *point),
            )


def impulse_off_normal(case: Case) -> Iterator[Finding]:
    """A force far from perpendicular to the damage."""
    impact = case.impact
    angle = math.atan2(abs(impact.tangential_impulse), impact.normal_impulse)
    seen = [
        f"{named(label, side)} has a PDOF of {case.words.angle(side.pdof)}"
        for label, side in case.sides
        if side.pdof is not None
    ]
    told = f"; {', '.join(seen)} (0 ahead, positive clockwise)" if seen else ""
    yield from case.above(
        "impulse_off_normal", angle, f"the impulse is {case.words.angle(angle)} off the normal, the direction of damage{told}"
    )


def heading_off_course(case: Case) -> Iterator[Finding]:
    """A vehicle that does not point where it goes, and does not spin."""
    for label, side in case.sides:
        before = side.before
        heading = before.heading
        if heading is None or math.isinf(before.mass) or before.speed < _GOES or abs(before.yaw_rate) >= _SPINS:
            continue
        off = abs(math.remainder(before.course - heading, math.tau))
        how = "backwards" if off > _BACKWARDS else "sideways"
        yield from case.above(
            "heading_off_course",
            off,
            f"{named(label, side)} goes {how} before, at {case.words.speed(before.speed)}, {case.words.angle(off)} off its "
            f"heading, as only a vehicle that slides far aside or is in reverse does; check heading, vx and vy",
            label,
            rounding=off_by(heading, math.tau),
        )


def point_outside(case: Case) -> Iterator[Finding]:
    """A contact point that is not on the vehicle."""
    point = case.impact.point
    if point is None:
        return
    for label, side in case.sides:
        if label in case.outlines:
            outline = case.outlines[label]
            distance = distance_outside(placed(outline, side.before, label), point)
            yield from case.above(
                "point_outside",
                distance,
                f"the contact point is {case.words.length(distance)} outside the outline of {named(label, side)}",
                label,
                rounding=outline_off_by(outline, side.before) + off_by(*point),
            )


def tyre_impulse(case: Case) -> Iterator[Finding]:
    """Tyres that could do a good part of what the impact does; of a body that turns about a pivot as if at its centre."""
    found = case.left_out
    for (label, side), left in zip(case.sides, (found.a, found.b), strict=True):
        how = "up to" if side.before.pivot is None else "about"
        yield from case.above(
            "tyre_impulse",
            left.tyre_share_bound,
            f"tyres of {named(label, side)} that slide for {found.duration:.3g} s with a drag of {found.drag:.2g} give {how} "
            f"{case.words.speed(left.tyre_delta_v_bound)}, {case.words.percent(left.tyre_share_bound)} of its delta-V of "
            f"{case.words.speed(side.delta_v)}",
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
            f"{case.words.plain(origin.condition)} percent of the closing speed in the speeds before",
        )


def not_unique(case: Case) -> Iterator[Finding]:
    """An answer beside which another fits as well."""
    origin = case.impact.reconstruction
    if origin is not None:
        yield from case.above(
            "not_unique",
            origin.answers,
            f"reconstruct.{origin.method} found {origin._fitting} that fit what was given "
            f"({', '.join(origin.known)}), of which this is one: other evidence must tell which",
        )
