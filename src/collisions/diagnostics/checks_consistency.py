"""Findings on contradictions: within the answer, and between answer, outlines, positions,
directions and damage.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..impact.run import gain_of_steps
from ..impact.vehicle_result import VehicleResult
from ..kernels.contact_laws import LAWS
from ..quantities.directions import from_radians
from ..reference import RECORDER_ACCURACY, restitution_range
from ..vehicle.outlines import distance_outside, in_scene
from .case import RATIO_ROUNDING, Case, ImpactCase, MomentumCase, off_by, outline_off_by
from .finding import MESSAGES, METHOD, Measured, above, finding
from .numbers import percent, share

# In metres, of positions and outlines together.
_POSITION_ERROR = 0.3
# A lever arm that would reverse if the force were turned by 10 degrees tells nothing.
_LEVER_TOL = math.sin(math.radians(10.0))
# Slower than this, in m/s, a course tells little; faster than this, in rad/s, a vehicle spins.
_SLOW, _SPINNING = 1.0, 0.5
_BACKWARDS = math.radians(135.0)
# Of the work of tyres: an energy below it is none.
_ROUNDING = 1e-9


@finding(
    "energy of the bodies after less that before",
    above(0.0, "J"),
    f'eq 7 of the paper; "the crash created energy", {MESSAGES}',
)
def energy_gain(case: Case) -> Iterator[Measured]:
    gain, whose = 0.0 if case.answer.ok else -_energy_loss(case), "the impact ends"
    if isinstance(case, MomentumCase) and case.answer.ok and case.answer.tyres:
        hidden = -_lost_in_contact(case)[1]
        if hidden > _ROUNDING * abs(hidden + _energy_loss(case)):
            gain, whose = hidden, "without what the tyres took the contact ends"
    steps = gain_of_steps(case.answer.inputs) if isinstance(case, ImpactCase) else ""
    yield Measured(
        gain,
        f"{whose} with {case.text(gain, 'energy')} more than it began with; {steps or 'none can'}",
    )


def _energy_loss(case: Case) -> float:
    loss: float = (
        case.answer.translational_energy_loss
        if isinstance(case, MomentumCase)
        else case.answer.energy_loss
    )
    return loss


def _lost_in_contact(case: Case) -> tuple[float, float]:
    """The least and the most that the contact took of the energy [J]: of planar momentum what the
    tyres did not take, nor an impulse from outside, on whichever vehicle that acted.
    """
    lost = _energy_loss(case)
    if isinstance(case, ImpactCase):
        return lost, lost
    pushed = (case.answer.outside_impulse_x or 0.0, case.answer.outside_impulse_y or 0.0)
    worked = [case.work_on(label, pushed) for label in "ab"]
    for label in case.answer.tyres:
        x, y = (getattr(case.answer, f"tyre_impulse_{axis}_{label}") for axis in "xy")
        lost += case.work_on(label, (x, y))
    return lost + min(worked), lost + max(worked)


@finding(
    "difference of the crush energy that was given from the energy lost, or from what was absorbed "
    "by maximum crush and by sliding, if that is nearer, as a share of it",
    above(0.5),
    f"Conservation of Energy Warning, {MESSAGES}: typically 50 percent",
)
def momentum_energy(case: Case) -> Iterator[Measured]:
    crush = case.crush_energy
    if crush is not None:
        least, lost = _lost_in_contact(case)
        nearest = min(max(crush, least), lost)
        off = share(abs(crush - nearest), nearest)
        leaves = f"{case.text(lost, 'energy')} to be lost"
        if least < lost:
            leaves = f"{case.text(least, 'energy')} to {leaves}"
        if isinstance(case, MomentumCase):
            others = ["the tyres"] if case.answer.tyres else []
            others += [] if case.answer.outside_impulse_x is None else ["the impulse from outside"]
            leaves += f" beside what {' and '.join(others)} took" if others else ""
        if isinstance(case, ImpactCase):
            # Coefficients fitted to the speeds of barrier tests count what restitution gives back.
            taken = case.answer.energy_absorbed + case.answer.energy_loss_tangential
            most = case.text(taken, "energy")
            if taken > lost and most != case.text(lost, "energy"):
                off = min(off, share(abs(crush - taken), taken))
                leaves = f"{most} to be absorbed by maximum crush and by sliding, and {leaves}"
        sentence = (
            f"the damage takes {case.text(crush, 'energy')} by the crush energy given, and "
            f"momentum leaves {leaves}: speeds or damage are wrong"
        )
        yield Measured(off, sentence, rounding=off_by(1.0))


@finding(
    "share by which momentum or energy, by the speeds before and after, differs from the impulse "
    "or its work",
    above(0.01),
    "set here: both are one number but for rounding, and one percent would be seen by whoever "
    "checks by hand",
)
def rounding(case: ImpactCase) -> Iterator[Measured]:
    impact = case.answer
    if math.isnan(impact.momentum_residual):
        yield Measured(
            math.inf,
            "momentum before and after cannot be compared, because a number in it is not known or "
            "larger than numbers can be: do not rely on this result",
        )
        return
    off = share(
        impact.momentum_residual, math.hypot(impact.normal_impulse, impact.tangential_impulse)
    )
    what = f"momentum changes by {off:.2g} of the impulse"
    sides = (impact.a, impact.b)
    if not any(_has_infinite_energy(side) for side in sides):
        before, after = (sum(_energy(side, after) for side in sides) for after in (False, True))
        lost = impact.energy_loss + sum(side.tyre_loss - side.outside_work for side in sides)
        by_speeds = share(
            abs((before - after) - lost),
            max(abs(impact.energy_loss), abs(lost), impact.energy_absorbed),
        )
        if by_speeds > off:
            off = by_speeds
            what = (
                "kinetic energies before and after differ by "
                f"{case.text(before - after, 'energy')}, and the impulses take "
                f"{case.text(lost, 'energy')}"
            )
    yield Measured(off, f"{what}: rounding of speeds that are large against the closing speed")


def _has_infinite_energy(side: VehicleResult) -> bool:
    before = side.before
    turning = (
        before.yaw_inertia is not None and math.isinf(before.yaw_inertia) and before.yaw_rate != 0.0
    )
    return turning or (math.isinf(before.mass) and before.speed > 0.0)


def _energy(side: VehicleResult, after: bool) -> float:
    """Kinetic energy before or after, without that of a yaw rate that does not change."""
    vehicle = side.after if after else side.before
    energy = (
        0.0
        if math.isinf(vehicle.mass)
        else 0.5 * vehicle.mass * (vehicle.vx * vehicle.vx + vehicle.vy * vehicle.vy)
    )
    if side.delta_yaw_rate == 0.0 or vehicle.yaw_inertia is None or math.isinf(vehicle.yaw_inertia):
        return energy
    return energy + 0.5 * vehicle.yaw_inertia * vehicle.yaw_rate * vehicle.yaw_rate


@finding(
    "restitution",
    above("the highest that is plausible for the closing speed"),
    "reference.restitution_range",
)
def restitution(case: Case) -> Iterator[Measured]:
    closing, e = case.answer.closing_speed, case.answer.restitution
    # Planar momentum has neither without a normal, and its centres may move apart along it.
    if closing is not None and e is not None and closing > 0.0:
        highest = restitution_range(closing)[1]
        of = " of the centres" if isinstance(case, MomentumCase) else ""
        sentence = (
            f"restitution{of} {e:.3g} at a closing speed of {case.text(closing, 'speed')}, where "
            f"{highest:.2g} is the highest that published values make plausible"
        )
        yield Measured(e, sentence, limit=highest, rounding=RATIO_ROUNDING)


@finding(
    "how far the restitution of momentum is below 0, infinite where the centres do not approach",
    above(0.01),
    f"set here: what rounded inputs leave of 0; Coefficient of Restitution Warnings, {MESSAGES}, "
    "warn of any",
)
def restitution_negative(case: MomentumCase) -> Iterator[Measured]:
    closing, e = case.answer.closing_speed, case.answer.restitution
    if closing is None or e is None:
        return
    speed = case.text(closing, "speed")
    if closing > 0.0:
        sentence = (
            f"restitution of the centres {e:.3g} at a closing speed of {speed}: after the impact "
            "they still approach along the normal, which the centres of vehicles that it turns "
            "may do for a moment; ask reconstruct.restitution with the contact point, or check the "
            "normal"
        )
        yield Measured(-e, sentence)
    else:
        sentence = (
            f"the centres do not approach along the normal: closing speed {speed}; it must point "
            "from A into B"
        )
        yield Measured(math.inf, sentence)


@finding(
    "impulse ratio as a share of the critical one, infinite where it drives the slip",
    above(1.0),
    "Coulomb friction ends with the slip and cannot reverse it; "
    "reference.SHARE_OF_CRITICAL_SMALL_OVERLAP ends at 1",
)
def impulse_ratio(case: ImpactCase) -> Iterator[Measured]:
    ratio, critical = case.answer.impulse_ratio, case.answer.critical_impulse_ratio
    # A contact with one degree of freedom has no critical ratio.
    if ratio == 0.0 or math.isnan(critical) or case.answer.model == "linear_central":
        return
    part = math.inf if critical == 0.0 else ratio / critical
    if part < 0.0:
        part = math.inf
        what = (
            f"drives the slip instead of ending it: the critical one is {critical:.3g}; check "
            "its sign"
        )
    else:
        part = 1.0 if abs(part - 1.0) <= RATIO_ROUNDING else part
        what = f"is {part:.2f} of the critical one, {critical:.3g}, which already ends the slip"
    yield Measured(part, f"the impulse ratio {ratio:.3g} {what}")


@finding(
    "energy that the tangential impulse adds, as a share of the energy absorbed",
    above(0.005),
    "set here: friction takes energy; half a percent is less than what any speed is known to",
)
def friction_gain(case: ImpactCase) -> Iterator[Measured]:
    impact = case.answer
    gain = -impact.energy_loss_tangential
    part = share(gain, impact.energy_absorbed) if gain > 0.0 else 0.0
    followed = impact.law is not None and LAWS[impact.law].followed
    why = (
        "what acts from outside shifts the slip before the contact, and counts in proportion to "
        "the normal impulse in the energies, so that the parts of the loss are estimates, and only "
        "their sum is exact"
        if followed and impact.inputs.pushed
        else "the slip turns round during the contact, which one impulse ratio does not tell"
    )
    sentence = (
        f"the tangential impulse adds {case.text(gain, 'energy')}, {percent(part, 1)} of the "
        f"energy absorbed, where friction can only take it: {why}"
    )
    yield Measured(part, sentence)


@finding(
    "impulse ratio as a share of the one at which the bodies jam",
    above(0.5),
    "set here: at one half, the normal impulse is twice that of a frictionless contact",
)
def jamming(case: ImpactCase) -> Iterator[Measured]:
    impact = case.answer
    frictionless = impact.effective_mass * impact.closing_speed
    apart = impact.pulse is not None or impact.inputs.outside_a is not None
    if (
        impact.regime in ("given", "sliding")
        and frictionless > 0.0
        and impact.normal_impulse != 0.0
        and not apart
    ):
        times = impact.normal_impulse / (1.0 + impact.restitution) / frictionless
        part = 1.0 - 1.0 / times
        sentence = (
            f"the tangential impulse makes the normal one {times:.2f} times as large: the "
            f"ratio is {part:.2f} of the one at which the bodies jam"
        )
        yield Measured(part, sentence)


@finding(
    "speed at which the contact points still approach after the impact",
    above(0.1, "m/s"),
    f"set here: 0.4 km/h, below what evidence shows; {MESSAGES} warns of any",
)
def contact_points_approach(case: ImpactCase) -> Iterator[Measured]:
    impact = case.answer
    point, (nx, ny) = impact.point, impact.normal
    # Where positions and normal change during the contact, the given ones tell nothing of its end.
    if (
        point is None
        or impact.pulse is not None
        or any(side.after.yaw_rate != 0.0 and side.after.x is None for _, _, side in case.sides)
    ):
        return
    (ax, ay), (bx, by) = (side.after.velocity_at(point) for _, _, side in case.sides)
    # An incomplete impact ends while they approach.
    approach = nx * (ax - bx) + ny * (ay - by) + min(impact.separation_speed, 0.0)
    speed = case.text(approach, "speed")
    sentence = (
        f"after the impact the contact points still approach at {speed}: {impact.model} leaves "
        "the turning out"
    )
    yield Measured(approach, sentence)


@finding(
    "speed at which the contact points still approach when an incomplete impact ends",
    above(0.0, "m/s"),
    "set here: solid bodies do not pass through each other",
)
def incomplete(case: ImpactCase) -> Iterator[Measured]:
    if case.answer.restitution >= 0.0:
        # A contact followed in time ends as near to 0 as its steps tell.
        return
    speed = -case.answer.separation_speed
    sentence = (
        f"the impact ends while the contact points still approach at {case.text(speed, 'speed')} "
        f"(restitution {case.answer.restitution:.3g}): the bodies must be able to pass, or what "
        "held them to tear"
    )
    yield Measured(speed, sentence)


@finding(
    "how much further the outlines pass into each other by the end of the duration after "
    "separation",
    above(0.2, "m"),
    "set here: two positions, each read to 10 cm; stiff outlines of vehicles that turn apart "
    "pass by less",
)
def outlines_interpenetrate(case: ImpactCase) -> Iterator[Measured]:
    if case.overlaps is not None and case.answer.complete:
        now, later, rounding = case.overlaps
        depth = max(now, 0.0)
        sentence = (
            f"{case.duration:.3g} s after separation the outlines overlap by "
            f"{case.text(later, 'length')}, {case.text(later - depth, 'length')} more than at "
            f"the impact ({case.text(depth, 'length')})"
        )
        yield Measured(later - depth, sentence, rounding=rounding)


@finding(
    "how deep the outlines overlap at the impact",
    above("the mutual crush of the impact in the duration and 0.3 m more", "m"),
    "set here: the crush by left_out, positions to 10 cm each, and 10 cm for outlines that are "
    "rounder than drawn",
)
def outlines_overlap(case: ImpactCase) -> Iterator[Measured]:
    if case.overlaps is not None and case.answer.complete:
        now, _, rounding = case.overlaps
        pulse, left = case.answer.pulse, case.left_out
        depth, crush = (
            max(now, 0.0),
            pulse.max_crush
            if pulse is not None
            else left.mutual_crush
            if left is not None
            else 0.0,
        )
        sentence = (
            f"at the impact the outlines overlap by {case.text(depth, 'length')}, and the impact "
            f"crushes both together by {case.text(crush, 'length')} in {case.duration:.3g} s; "
            "check positions and headings"
        )
        yield Measured(depth, sentence, limit=crush + _POSITION_ERROR, rounding=rounding)


@finding(
    "gap between the outlines at the impact",
    above(0.3, "m"),
    "set here: positions to 10 cm each, and 10 cm for outlines that are smaller than drawn",
)
def outlines_gap(case: ImpactCase) -> Iterator[Measured]:
    if case.overlaps is not None:
        now, _, rounding = case.overlaps
        gap = case.text(-now, "length")
        sentence = (
            f"at the impact there is a gap of {gap} between the outlines; check positions and "
            "headings"
        )
        yield Measured(-now, sentence, rounding=rounding)


@finding(
    "along the normal, how far A's centre is past the contact point or B's before it; without a "
    "point, A's past B's",
    above(0.1, "m"),
    "set here: the normal points from A into B, so that a convex body has its centre behind the "
    "contact; 10 cm of reading",
)
def normal_against_positions(case: ImpactCase) -> Iterator[Measured]:
    (nx, ny), point = case.answer.normal, case.answer.point
    a, b = (
        None
        if vehicle.x is None or vehicle.y is None or math.isinf(vehicle.mass)
        else (vehicle.x, vehicle.y)
        for vehicle in (case.answer.a.before, case.answer.b.before)
    )
    # Along the normal the first of each pair should come first.
    for label, one, other in [("", a, b)] if point is None else [("a", a, point), ("b", point, b)]:
        if one is None or other is None:
            continue
        behind = nx * (one[0] - other[0]) + ny * (one[1] - other[1])
        far = case.text(behind, "length")
        if label:
            sentence = (
                "the normal, which points from A into B, points "
                f"{'back into A' if label == 'a' else 'away from B'}: the centre of "
                f"{case.vehicles[label].who} is {far} on the wrong side of the contact point"
            )
        else:
            sentence = (
                f"along the normal, which points from A into B, the centre of B is {far} behind "
                "that of A; check the normal and the positions"
            )
        yield Measured(behind, sentence, label, rounding=off_by(*one, *other))


@finding(
    "change of yaw rate against the lever of a force from the damage_pdof given, which 10 "
    "degrees would not turn round",
    above(0.1, "rad/s"),
    f"set here: 6 deg/s; Rotation Direction Warning, {MESSAGES}, warns of any",
)
def yaw_against_lever(case: ImpactCase) -> Iterator[Measured]:
    point = case.answer.point
    for label, who, side in case.sides:
        before, pdof = side.before, case.damage[label].pdof
        x, y = before.pivot if before.pivot is not None else (before.x, before.y)
        if point is None or pdof is None or x is None or y is None or before.heading is None:
            continue
        # The PDOF is where the force comes from, clockwise from the heading.
        c, s = from_radians(before.heading - pdof)
        arm_x, arm_y = point[0] - x, point[1] - y
        lever = arm_y * c - arm_x * s
        if abs(lever) > _LEVER_TOL * math.hypot(arm_x, arm_y):
            turned = _turned_by_contact(side)
            sentence = (
                f"the contact turns {who} by {case.text(turned, 'yaw rate')}, against the "
                f"lever ({case.text(abs(lever), 'length')}) of a force from the "
                f"{case.text(pdof, 'angle')} that its damage shows"
            )
            yield Measured(-math.copysign(1.0, lever) * turned, sentence, label)


def _turned_by_contact(side: VehicleResult) -> float:
    """The change of the yaw rate without what tyres and an impulse from outside do [rad/s]."""
    inertia = side.before.yaw_inertia
    if inertia is None or math.isinf(inertia) or side.before.pivot is not None:
        # What acts on a body on a pivot from outside turns it about that.
        return side.delta_yaw_rate
    return side.delta_yaw_rate - (side.tyre_moment + side.outside_yaw) / inertia


@finding(
    "angle between the PDOF and the damage_pdof that was given",
    above(math.radians(10.0), "rad"),
    f"PDOF Compatibility Warning, {MESSAGES}: about 10 degrees",
)
def pdof_off_damage(case: Case) -> Iterator[Measured]:
    for label, vehicle in case.vehicles.items():
        pdof, seen = vehicle.pdof, case.damage[label].pdof
        if pdof is not None and seen is not None:
            off = abs(math.remainder(seen - pdof, math.tau))
            sentence = (
                f"{vehicle.who} has a PDOF of {case.text(pdof, 'angle')}, "
                f"{case.text(off, 'angle')} off the {case.text(seen, 'angle')} that its damage "
                "shows (0 ahead, positive clockwise)"
            )
            yield Measured(off, sentence, label, rounding=off_by(seen, pdof, math.tau))


@finding(
    "difference of the damage_delta_v that was given from delta-V, of a pair as vectors, as a "
    "share of delta-V",
    above(0.1),
    f"Delta-V Compatibility Note, {MESSAGES}: about 10 percent",
)
def delta_v_off_damage(case: Case) -> Iterator[Measured]:
    for label, vehicle in case.vehicles.items():
        delta_v, seen, direction = (
            vehicle.delta_v,
            case.damage[label].delta_v,
            case.damage[label].direction,
        )
        if seen is None:
            continue
        has, shows, off = case.text(delta_v, "speed"), case.text(seen, "speed"), abs(seen - delta_v)
        comes = vehicle.delta_v_from
        if direction is not None and comes is not None and not math.isnan(comes):
            has, shows = (
                f"{size} from {case.text(angle, 'angle')}"
                for size, angle in ((has, comes), (shows, direction))
            )
            off = math.hypot(
                off, 2.0 * math.sqrt(seen * delta_v) * math.sin(0.5 * (direction - comes))
            )
        sentence = f"{vehicle.who} has a delta-V of {has}, and its damage shows {shows}"
        yield Measured(share(off, delta_v), sentence, label, rounding=off_by(1.0))


@finding(
    "momentum that both damage_delta_v which were given leave over, less what acts from outside, "
    "as a share of the mean of both impulses",
    above(2.0 * RECORDER_ACCURACY.high),
    "reference.RECORDER_ACCURACY: each of two recorders may be off by 10 percent; of seven staged "
    "crashes with instruments, three leave over more (docs/validation.md, table 1)",
)
def delta_v_pair(case: Case) -> Iterator[Measured]:
    both = [(vehicle, case.damage[label]) for label, vehicle in case.vehicles.items()]
    if any(seen.delta_v is None or math.isinf(vehicle.mass) for vehicle, seen in both):
        return
    sizes = [vehicle.mass * float(seen.delta_v or 0.0) for vehicle, seen in both]
    outside_x, outside_y = case.from_outside
    if any(seen.direction is None or vehicle.heading is None for vehicle, seen in both):
        left = max(abs(sizes[0] - sizes[1]) - math.hypot(outside_x, outside_y), 0.0)
        how = "in size"
    else:
        # A delta-V points where the force goes to, a direction to where it comes from, clockwise.
        turns = [
            from_radians(float(vehicle.heading or 0.0) - float(seen.direction or 0.0))
            for vehicle, seen in both
        ]
        left = math.hypot(
            *(
                outside + sum(size * turn[axis] for size, turn in zip(sizes, turns, strict=True))
                for axis, outside in enumerate((outside_x, outside_y))
            )
        )
        how = "as vectors"
    mean = 0.5 * sum(sizes)
    part = share(left, mean)
    speeds = " and ".join(case.text(float(seen.delta_v or 0.0), "speed") for _, seen in both)
    sentence = (
        f"the delta-Vs given, {speeds}, times the masses differ {how} by {percent(part)} of their "
        "mean, which no impact between the two gives: one of them or a mass is wrong, or more "
        "acted on the vehicles than each other"
    )
    yield Measured(part, sentence, rounding=off_by(1.0))


@finding(
    "angle between the impulse and the normal",
    above(math.radians(45.0), "rad"),
    "the angle up to which crush energy is corrected for a force that is not perpendicular, "
    f"{METHOD}",
)
def impulse_off_normal(case: ImpactCase) -> Iterator[Measured]:
    angle = math.atan2(abs(case.answer.tangential_impulse), case.answer.normal_impulse)
    pdofs = [
        f"{who} has a PDOF of {case.text(side.pdof, 'angle')}"
        for _, who, side in case.sides
        if side.pdof is not None
    ]
    which = f"; {', '.join(pdofs)} (0 ahead, positive clockwise)" if pdofs else ""
    yield Measured(
        angle,
        f"the impulse is {case.text(angle, 'angle')} off the normal, the direction of "
        f"damage{which}",
    )


@finding(
    "angle between heading and course before, of a vehicle that goes 1 m/s or more and turns by "
    "less than 0.5 rad/s",
    above(math.radians(45.0), "rad"),
    "set here: beyond, it goes more sideways or backwards than ahead; a vehicle that slides with "
    "its rear out stays below",
)
def heading_off_course(case: ImpactCase) -> Iterator[Measured]:
    for label, who, side in case.sides:
        before = side.before
        if (
            before.heading is None
            or math.isinf(before.mass)
            or before.speed < _SLOW
            or abs(before.yaw_rate) >= _SPINNING
        ):
            continue
        off = abs(math.remainder(before.course - before.heading, math.tau))
        how = "backwards" if off > _BACKWARDS else "sideways"
        sentence = (
            f"{who} goes {how} before, at {case.text(before.speed, 'speed')}, "
            f"{case.text(off, 'angle')} off its heading, as only a vehicle that slides far aside "
            "or is in reverse does; check heading, vx and vy"
        )
        yield Measured(off, sentence, label, rounding=off_by(before.heading, math.tau))


@finding(
    "distance of the contact point from the outline, outside of it",
    above(0.1, "m"),
    "set here: 10 cm, about what positions are read to",
)
def point_outside(case: ImpactCase) -> Iterator[Measured]:
    point = case.answer.point
    for label, who, side in case.sides:
        if point is not None and label in case.outlines:
            outline = case.outlines[label]
            distance = distance_outside(in_scene(outline, side.before, label), point)
            sentence = (
                f"the contact point is {case.text(distance, 'length')} outside the outline of {who}"
            )
            yield Measured(
                distance,
                sentence,
                label,
                rounding=outline_off_by(outline, side.before) + off_by(*point),
            )
