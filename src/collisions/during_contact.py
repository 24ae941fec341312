"""The effect on delta-V of tyre forces and of movement during the contact, by solving the impact again with each of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from . import pulse
from .contact_time import held_impulse
from .directions import from_radians
from .drag import GRAVITY
from .impact import Impact, answer_of, solve_changed
from .kernels.contact_laws import BRACH
from .kernels.elementwise import select, turning_velocity
from .models import ECCENTRIC, LINEAR
from .quantities import hypot, numeric
from .side import Side
from .tyres import Tyres
from .vehicle import Vehicle, needed

# Midpoints of equal time intervals, as shares of the duration.
_MOMENTS = (0.125, 0.375, 0.625, 0.875)
# Part of the tyre impulse that is tried, small enough that the regime does not change; a power of 2 to avoid rounding.
_LITTLE = 2.0**-6


class Pull(NamedTuple):
    """What its own tyres would do to the velocity of a free vehicle over the contact, and the most they can do to this one."""

    x: Any
    y: Any
    most: Any
    yaw: Any = 0.0

    @classmethod
    def of(cls, side: Side, restitution: Any, most: Any) -> Pull:
        """``most`` is the change of velocity of a free body by tyres that pull one way throughout."""
        before, change_x, change_y = side.before, side.delta_vx, side.delta_vy
        most = select(numeric(before.mass).isfinite(before.mass), most, 0.0)
        x: Any = 0.0
        y: Any = 0.0
        for moment in _MOMENTS:
            passed = pulse.passed(restitution, moment)
            vx, vy = before.vx + passed * change_x, before.vy + passed * change_y
            speed = hypot(vx, vy)
            speed = select(speed == 0.0, 1.0, speed)
            x, y = x - vx / speed / len(_MOMENTS), y - vy / speed / len(_MOMENTS)
        if before.pivot is None:
            return cls(most * x, most * y, most)
        arm_x, arm_y = needed(before, "x", "left_out") - before.pivot[0], needed(before, "y", "left_out") - before.pivot[1]
        square = arm_x * arm_x + arm_y * arm_y
        # A pinned body without an inertia has no result anyway.
        inertia = math.inf if before.yaw_inertia is None else before.yaw_inertia
        turning = before.mass / (inertia + before.mass * square)
        # For wheels at the radius of gyration k from the centre, the mean distance from the pivot is at most hypot(arm, k).
        return cls(most * x, most * y, most * (turning * square) ** 0.5)


def by_wheels(impact: Impact, time: Any, tyres: Mapping[str, Tyres], pulls: tuple[Pull, Pull]) -> tuple[Pull, Pull]:
    """What wheels that roll, brake and steer do over the contact, as ``eccentric`` takes them; none where there are none."""
    inputs = replace(impact.inputs, tyres_a=tyres.get("tyres_a"), tyres_b=tyres.get("tyres_b"), duration=time)
    found = []
    for label, body, pull in zip("ab", (inputs.a, inputs.b), pulls, strict=True):
        own = inputs.tyres.get(label)
        if own is None:
            found.append(Pull(0.0 * pull.x, 0.0 * pull.y, 0.0 * pull.most))
            continue
        mass = finite_mass(body)
        x, y, yaw = (part / select(mass > 0.0, mass, 1.0) for part in held_impulse(inputs, answer_of(impact), label))
        drag = select(mass > 0.0, 1.0, 0.0) * own.friction * GRAVITY * time
        found.append(Pull(x, y, Pull.of(getattr(impact, label), inputs.restitution, drag).most, yaw))
    return found[0], found[1]


def with_tyres(impact: Impact, pulls: tuple[Pull, Pull]) -> list[Any]:
    """Change of each vehicle's delta-V by the tyres of both, as impulses from outside, which the eccentric model takes."""
    inputs, point = impact.inputs, impact.point
    central = impact.model != ECCENTRIC.name
    changes: dict[str, Any] = {"model": ECCENTRIC.name, "law": inputs.law or BRACH}
    changes["rule_value"] = select(impact.model == LINEAR.name, 0.0, inputs.rule_value)
    for label, pull in zip("ab", pulls, strict=True):
        body, given = getattr(inputs, label), getattr(inputs, f"outside_{label}") or (0.0, 0.0, 0.0)
        mass = _LITTLE * finite_mass(body)
        changes[f"outside_{label}"] = (given[0] + mass * pull.x, given[1] + mass * pull.y, given[2] + mass * pull.yaw)
        if point is not None and body.x is not None and body.y is not None and np.any(central):
            # A central model knows no levers.
            x, y = (select(central, *places) for places in zip(point, (body.x, body.y), strict=True))
            changes[label] = body.replace(x=x, y=y)
    again = solve_changed(impact, **changes)
    return [
        hypot((new.delta_vx - old.delta_vx) / _LITTLE, (new.delta_vy - old.delta_vy) / _LITTLE)
        for old, new in ((impact.a, again.a), (impact.b, again.b))
    ]


def finite_mass(body: Vehicle) -> Any:
    """The body's mass, 0 for a fixed body, which tyres do not move."""
    return select(numeric(body.mass).isfinite(body.mass), body.mass, 0.0)


def with_motion(impact: Impact, time: Any, geometry: str) -> list[Any]:
    """Change of delta-V of each vehicle because the geometry moves during the contact; None without a geometry.

    ``geometry`` says what moment the positions of the impact are those of: "maximum_engagement" or "first_contact".
    """
    point, placed = impact.point, impact.model == ECCENTRIC.name
    if point is None or placed is False:
        return [None] * 2
    if impact.refused is True or not np.any(placed):
        return [math.nan] * 2
    e = impact.restitution
    passed = pulse.mean_passed(e)
    # By how much of the duration times the velocity before, and times its change, a body has gone on from first contact: at
    # maximum engagement, on the mean while the force acts, and at the end.
    most, acting, last = pulse.engaged(e), (1.0 - passed, passed - pulse.mean_square_passed(e)), (1.0, passed)
    given = most if geometry == "maximum_engagement" else (0.0, 0.0)
    # A drift of the closing speed counts most at first for what the spring takes up, and at last for what it gives back.
    taking, giving = pulse.drifting(e)
    moments = (0.0, 0.0), most, acting, last, taking, (most[0] + giving[0], most[1] + giving[1])
    start, engaged, mean, end, taken, given_back = (
        _moved(impact, point, time, *(here - there for here, there in zip(moment, given, strict=True))) for moment in moments
    )
    # The impulse acts at the mean, but what is left of the velocities at the contact is what the end sees of them.
    early, late = _closing(impact, 1.0, *mean), _closing(impact, 1.0, *end)
    by_n, by_t = late[0] - early[0], late[1] - early[1]
    # What closes while the spring is pressed, of which restitution gives back a share, and what of that a drift then takes.
    gained, lost = (
        _closing(impact, share, *then)[0] - _closing(impact, share, *before)[0]
        for share, before, then in (
            (taking[1] / taking[0], start, taken),
            (pulse.restoring(e), engaged, given_back),
        )
    )
    pressed = _closing(impact, 0.0, *start)[0] + gained
    by_n = (by_n + e * (pressed - _closing(impact, 0.0, *mean)[0]) - lost) / (1.0 + e)
    bodies, point, (nx, ny) = mean
    free = next((at for at, body in enumerate(bodies) if body.pivot is None), None)
    if free is not None:
        body, sign = bodies[free], 1.0 - 2.0 * free
        by_x, by_y = nx * by_n - ny * by_t, ny * by_n + nx * by_t
        bodies[free] = body.replace(vx=body.vx + sign * by_x, vy=body.vy + sign * by_y)
    again = solve_changed(impact, a=bodies[0], b=bodies[1], point=point, normal=(nx, ny))
    return [
        select(placed, hypot(new.delta_vx - old.delta_vx, new.delta_vy - old.delta_vy), math.nan)
        for old, new in ((impact.a, again.a), (impact.b, again.b))
    ]


def _moved(impact: Impact, point: Any, time: Any, by_was: Any, by_change: Any) -> tuple[list[Vehicle], Any, Any]:
    """Both bodies, point and normal, further on by these shares of velocities and their changes."""
    bodies, turns, places, fixed = [], [], [], []
    for side in (impact.a, impact.b):
        before = side.before
        dx, dy, turn = (
            time * (by_was * was + by_change * change)
            for was, change in (
                (before.vx, side.delta_vx),
                (before.vy, side.delta_vy),
                (before.yaw_rate, side.delta_yaw_rate),
            )
        )
        turns.append(turn)
        # A body without an inertia is not known to be fixed; a central model solved it, or none.
        inertia = 0.0 if before.yaw_inertia is None else before.yaw_inertia
        fixed.append(numeric(before.mass).isinf(before.mass) & numeric(inertia).isinf(inertia))
        if before.x is None or before.y is None:
            bodies.append(before)
            places.append((dx, dy))
            continue
        arm = point[0] - before.x, point[1] - before.y
        now = _turned(*arm, turn)
        places.append((dx + (now[0] - arm[0]), dy + (now[1] - arm[1])))
        bodies.append(before.replace(x=before.x + dx, y=before.y + dy))
    on_a = select(fixed[1], 1.0, select(fixed[0], 0.0, 0.5))
    point = tuple(was + on_a * by_a + (1.0 - on_a) * by_b for was, by_a, by_b in zip(point, *places, strict=True))
    return bodies, point, _turned(*impact.normal, (1.0 - on_a) * turns[0] + on_a * turns[1])


def _closing(impact: Impact, share: Any, bodies: list[Vehicle], point: Any, normal: Any) -> tuple[Any, Any]:
    """Velocity of A relative to B at a contact point, along the normal and the tangent, after a share of the impulse."""
    ux: Any = 0.0
    uy: Any = 0.0
    for sign, side, body in zip((1.0, -1.0), (impact.a, impact.b), bodies, strict=True):
        vx, vy = side.before.vx + share * side.delta_vx, side.before.vy + share * side.delta_vy
        x, y = body.x, body.y
        if body.pivot is not None:
            vx, vy, (x, y) = 0.0, 0.0, body.pivot
        if x is not None and y is not None:
            rate = side.before.yaw_rate + share * side.delta_yaw_rate
            turn_x, turn_y = turning_velocity(rate, point[0], point[1], x, y)
            vx, vy = vx + turn_x, vy + turn_y
        ux, uy = ux + sign * vx, uy + sign * vy
    return normal[0] * ux + normal[1] * uy, normal[0] * uy - normal[1] * ux


def _turned(x: Any, y: Any, angle: Any) -> tuple[Any, Any]:
    c, s = from_radians(angle)
    return c * x - s * y, s * x + c * y
