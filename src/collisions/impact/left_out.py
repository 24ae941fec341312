"""``left_out``: what the impulse idealisation neglects, tyre forces and the movement of the
vehicles during the contact.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, NamedTuple

import numpy as np

from ..engine.blocks import Part, in_parts, is_one_part
from ..kernels.contact_laws import BRACH
from ..kernels.elementwise import select, turning_velocity
from ..messages.errors import InputError
from ..messages.warning import quietly
from ..quantities.attributes import (
    Shown,
    hypot,
    in_units_of,
    math_or_numpy,
    read_only,
    returns,
)
from ..quantities.directions import from_radians
from ..quantities.precision import precision
from ..quantities.reading import ArgumentReader, broadcast, not_an_answer, widened
from ..quantities.settings import Default, callers_options, computing
from ..quantities.units import Input, Value, shown
from ..travel.surfaces import out_of_range, settle
from ..vehicle.drag import GRAVITY, USUAL_DURATION, read_drag, read_duration
from ..vehicle.tyres import Tyres, lacking
from ..vehicle.vehicle import Vehicle, needed
from . import pulse
from .impact import Impact, answer_of, part_of_impact, solve_changed
from .inputs import part_of
from .models import ECCENTRIC, LINEAR, TIME_RESOLVED
from .time_resolved_inputs import held_impulse, read_tyres
from .vehicle_result import VehicleResult

# Midpoints of equal time intervals, as shares of the duration.
_MOMENTS = (0.125, 0.375, 0.625, 0.875)


# Part of the tyre impulse that is tried, small enough that the regime does not change; a power of 2
# to avoid rounding.
_LITTLE = 2.0**-6


class Pull(NamedTuple):
    """What its own tyres would do to the velocity of a free vehicle over the contact, and the most
    they can do to this one.
    """

    x: Any
    y: Any
    most: Any
    yaw: Any = 0.0

    @classmethod
    def of(cls, side: VehicleResult, restitution: Any, most: Any) -> Pull:
        """``most`` is the change of velocity of a free body by tyres that pull one way
        throughout.
        """
        before, change_x, change_y = side.before, side.delta_vx, side.delta_vy
        most = select(math_or_numpy(before.mass).isfinite(before.mass), most, 0.0)
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
        arm_x, arm_y = (
            needed(before, "x", "left_out") - before.pivot[0],
            needed(before, "y", "left_out") - before.pivot[1],
        )
        square = arm_x * arm_x + arm_y * arm_y
        # A pinned body without an inertia has no result anyway.
        inertia = math.inf if before.yaw_inertia is None else before.yaw_inertia
        turning = before.mass / (inertia + before.mass * square)
        # For wheels at the radius of gyration k from the centre, the mean distance from the pivot
        # is at most hypot(arm, k).
        return cls(most * x, most * y, most * (turning * square) ** 0.5)


def by_wheels(
    impact: Impact,
    time: Any,
    tyres: Mapping[str, Tyres],
    pulls: tuple[Pull, Pull],
    left: Mapping[str, Any],
) -> tuple[Pull, Pull]:
    """What wheels that roll, brake and steer do over the contact, as ``eccentric`` takes them, as
    far as it is ``left`` out (1, or 0); of a vehicle without it is what a drag does.
    """
    inputs = replace(
        impact.inputs, tyres_a=tyres.get("tyres_a"), tyres_b=tyres.get("tyres_b"), duration=time
    )
    found = []
    for label, body, pull in zip("ab", (inputs.a, inputs.b), pulls, strict=True):
        own = inputs.tyres.get(label)
        if own is None:
            found.append(pull)
            continue
        mass = finite_mass(body)
        x, y, yaw = (
            left[label] * part / select(mass > 0.0, mass, 1.0)
            for part in held_impulse(inputs, answer_of(impact), label)
        )
        drag = left[label] * select(mass > 0.0, 1.0, 0.0) * own.friction * GRAVITY * time
        found.append(
            Pull(x, y, Pull.of(getattr(impact, label), inputs.restitution, drag).most, yaw)
        )
    return found[0], found[1]


def tyres_held(impact: Impact) -> tuple[str, ...]:
    """The vehicles, "a" and "b", whose tyres are in an impact: those that were given, or by
    ``central`` their drags. A central model that ``solve`` chose has none.
    """
    inputs, origin = impact.inputs, impact.reconstruction
    own = inputs.tyres if np.any(_takes_tyres(impact)) else {}
    if impact.pulse is not None and np.any(inputs.drag):
        return "a", "b"
    drags = {} if origin is None else {"a": origin.drag_a, "b": origin.drag_b}
    return tuple(label for label in "ab" if label in own or drags.get(label) is not None)


def _takes_tyres(impact: Impact) -> Any:
    """Whether the model that answered takes tyres; in a batch of ``solve`` of each case."""
    return (impact.model == ECCENTRIC.name) | (impact.model == TIME_RESOLVED.name)


def _left(impact: Impact, label: str, held: Collection[str]) -> Any:
    """1 where the tyres of a vehicle are left out of the impact, and 0 where not."""
    if label not in held:
        return 1.0
    return select(_takes_tyres(impact), 0.0, 1.0) if label in impact.inputs.tyres else 0.0


def tyres_lacking(impact: Impact) -> tuple[str, ...]:
    """The others that could have some."""
    return lacking(tyres_held(impact), impact.inputs.a.mass, impact.inputs.b.mass)


def with_tyres(impact: Impact, pulls: tuple[Pull, Pull]) -> list[Any]:
    """Change of each vehicle's delta-V by the tyres of both, as impulses from outside, which the
    eccentric model takes.
    """
    inputs, point = impact.inputs, impact.point
    central = impact.model != ECCENTRIC.name
    changes: dict[str, Any] = {"model": ECCENTRIC.name, "law": inputs.law or BRACH}
    changes["rule_value"] = select(impact.model == LINEAR.name, 0.0, inputs.rule_value)
    for label, pull in zip("ab", pulls, strict=True):
        body, given = getattr(inputs, label), getattr(inputs, f"outside_{label}") or (0.0, 0.0, 0.0)
        mass = _LITTLE * finite_mass(body)
        changes[f"outside_{label}"] = (
            given[0] + mass * pull.x,
            given[1] + mass * pull.y,
            given[2] + mass * pull.yaw,
        )
        if point is not None and body.x is not None and body.y is not None and np.any(central):
            # A central model knows no levers.
            x, y = (
                select(central, *places) for places in zip(point, (body.x, body.y), strict=True)
            )
            changes[label] = body.replace(x=x, y=y)

    def moved(**more: Any) -> list[Any]:
        again = solve_changed(impact, **changes, **more)
        return [
            hypot((new.delta_vx - old.delta_vx) / _LITTLE, (new.delta_vy - old.delta_vy) / _LITTLE)
            for old, new in ((impact.a, again.a), (impact.b, again.b))
        ]

    has = _takes_tyres(impact)
    if not inputs.tyres or np.all(has):
        return moved()
    without = moved(tyres_a=None, tyres_b=None, duration=None)
    if not np.any(has):
        return without
    return [select(has, *pair) for pair in zip(moved(), without, strict=True)]


def finite_mass(body: Vehicle) -> Any:
    """The body's mass, 0 for a fixed body, which tyres do not move."""
    return select(math_or_numpy(body.mass).isfinite(body.mass), body.mass, 0.0)


def with_motion(impact: Impact, time: Any, geometry: str) -> list[tuple[Any, Any]]:
    """Change of delta-V, and of the change of the yaw rate, of each vehicle because the geometry
    moves during the contact; None without a geometry.

    ``geometry`` says what moment the positions of the impact are those of: "maximum_engagement" or
    "first_contact".
    """
    point, placed = impact.point, impact.model == ECCENTRIC.name
    if point is None or placed is False:
        return [(None, None)] * 2
    if impact.refused is True or not np.any(placed):
        return [(math.nan, math.nan)] * 2
    # In a function of its own: what it works with is freed before the impact is solved again.
    bodies, point, normal = _acted_on(impact, point, time, geometry)
    again = solve_changed(
        impact, a=bodies[0], b=bodies[1], point=point, normal=normal, **_tyres_as_pushes(impact)
    )
    return [
        (
            select(
                placed, hypot(new.delta_vx - old.delta_vx, new.delta_vy - old.delta_vy), math.nan
            ),
            select(placed, abs(new.delta_yaw_rate - old.delta_yaw_rate), math.nan),
        )
        for old, new in ((impact.a, again.a), (impact.b, again.b))
    ]


def _tyres_as_pushes(impact: Impact) -> dict[str, Any]:
    """The tyres of an impact as what they did from outside, which stays where velocities are moved
    so that those at the contact are others: tyres go by each vehicle's own.
    """
    inputs = impact.inputs
    if not inputs.tyres:
        return {}
    takes = _takes_tyres(impact)
    # Of both, as an impulse on one alone is none.
    pushes = {}
    for label in "ab":
        push = getattr(inputs, f"outside_{label}") or (0.0, 0.0, 0.0)
        if label in inputs.tyres:
            side = getattr(impact, label)
            did = side.tyre_impulse_x, side.tyre_impulse_y, side.tyre_moment
            push = tuple(
                one + select(takes, part, 0.0) for one, part in zip(push, did, strict=True)
            )
        pushes[f"outside_{label}"] = push
    return {"tyres_a": None, "tyres_b": None, "duration": None, **pushes}


def _acted_on(
    impact: Impact, point: Any, time: Any, geometry: str
) -> tuple[list[Vehicle], Any, Any]:
    """Both bodies, point and normal as the impulse of a moving contact finds them: where they are
    on the mean while the force acts, with what the end sees of the velocities.
    """
    e = impact.restitution
    passed = pulse.mean_passed(e)
    # Shares of the duration times the velocity before, and times its change, that a body has gone
    # on from first contact: at maximum engagement, on the mean while the force acts, and at the
    # end.
    most, acting, last = (
        pulse.engaged(e),
        (1.0 - passed, passed - pulse.mean_square_passed(e)),
        (1.0, passed),
    )
    given = most if geometry == "maximum_engagement" else (0.0, 0.0)
    # A drift of the closing speed counts most at first for what the spring takes up, and at last
    # for what it gives back.
    taking, giving = pulse.drifting(e)

    def at(moment: tuple[Any, Any]) -> tuple[list[Vehicle], Any, Any]:
        shares = (here - there for here, there in zip(moment, given, strict=True))
        return _moved(impact, point, time, *shares)

    def closing(moment: tuple[Any, Any], *shares: Any) -> list[tuple[Any, Any]]:
        place = at(moment)
        return [_closing(impact, share, *place) for share in shares]

    bodies, mean_point, (nx, ny) = mean = at(acting)
    # The impulse acts at the mean, but what is left of the velocities at the contact is what the
    # end sees of them.
    early, (late,) = _closing(impact, 1.0, *mean), closing(last, 1.0)
    by_n, by_t = late[0] - early[0], late[1] - early[1]
    # What closes while the spring is pressed, of which restitution gives back a share, and what of
    # that a drift then takes.
    share = taking[1] / taking[0]
    start, at_first = closing((0.0, 0.0), share, 0.0)
    (taken,) = closing(taking, share)
    share = pulse.restoring(e)
    (engaged,) = closing(most, share)
    (given_back,) = closing((most[0] + giving[0], most[1] + giving[1]), share)
    gained, lost = taken[0] - start[0], given_back[0] - engaged[0]
    pressed = at_first[0] + gained
    by_n = (by_n + e * (pressed - _closing(impact, 0.0, *mean)[0]) - lost) / (1.0 + e)
    free = next((place for place, body in enumerate(bodies) if body.pivot is None), None)
    if free is not None:
        body, sign = bodies[free], 1.0 - 2.0 * free
        by_x, by_y = nx * by_n - ny * by_t, ny * by_n + nx * by_t
        bodies[free] = body.replace(vx=body.vx + sign * by_x, vy=body.vy + sign * by_y)
    return bodies, mean_point, (nx, ny)


def _moved(
    impact: Impact, point: Any, time: Any, by_was: Any, by_change: Any
) -> tuple[list[Vehicle], Any, Any]:
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
        fixed.append(
            math_or_numpy(before.mass).isinf(before.mass) & math_or_numpy(inertia).isinf(inertia)
        )
        if before.x is None or before.y is None:
            bodies.append(before)
            places.append((dx, dy))
            continue
        arm = point[0] - before.x, point[1] - before.y
        now = _turned(*arm, turn)
        places.append((dx + (now[0] - arm[0]), dy + (now[1] - arm[1])))
        bodies.append(before.replace(x=before.x + dx, y=before.y + dy))
    on_a = select(fixed[1], 1.0, select(fixed[0], 0.0, 0.5))
    point = tuple(
        was + on_a * by_a + (1.0 - on_a) * by_b
        for was, by_a, by_b in zip(point, *places, strict=True)
    )
    return bodies, point, _turned(*impact.normal, (1.0 - on_a) * turns[0] + on_a * turns[1])


def _closing(
    impact: Impact, share: Any, bodies: list[Vehicle], point: Any, normal: Any
) -> tuple[Any, Any]:
    """Velocity of A relative to B at a contact point, along the normal and the tangent, after a
    share of the impulse.
    """
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


_GEOMETRIES = ("maximum_engagement", "first_contact")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class LeftOutVehicle(Shown):
    """The effects neglected for one vehicle. Shares are of the vehicle's own delta-V in the impact.

    Attributes
    ----------
    tyre_impulse_bound : float or array [N*s]
        The largest impulse that tyres sliding throughout can give: drag x weight x duration; 0 for
        an infinite mass, and for a vehicle whose tyres are in the impact.
    tyre_delta_v_bound, tyre_share_bound : float or array [m/s], [-]
        The change of velocity of the centre of mass due to that impulse, and its share. For a
        pinned vehicle it is no bound but an estimate, since it is not known how far from the pivot
        its wheels are: they are taken to be at the radius of gyration from the centre of mass, with
        all forces at right angles to their arms. Wheels that lie farther out can give more.
    tyre_impulse, tyre_impulse_x, tyre_impulse_y : float or array [N*s]
        Estimate of the impulse, its magnitude and its components along scene x and y: the tyres act
        against the motion of the centre of mass, as that changes during the contact.
    tyre_delta_v, tyre_share : float or array [m/s], [-]
        Estimate of how far the delta-V vector moves due to the tyres of both vehicles, as far as
        they are not in the impact, and the response of the contact to them; it may therefore exceed
        the bound, which is for the vehicle's own tyres.
    displacement_x, displacement_y : float or array [m]
        Displacement of the centre of mass during the contact.
    rotation : float or array [rad]
        Rotation during the contact, counter-clockwise.
    geometry_delta_v, geometry_share : float or array [m/s], [-]
        Estimate of how far the delta-V vector moves because positions and normal change during the
        contact, in which those of the impact hold at one moment only: at maximum engagement, or
        as ``geometry`` said; None for the central models, which have no geometry, and for any
        impact without a point. In a batch of ``solve`` with a point it is NaN where a central
        model answered. It is also NaN where there is no answer with the geometry of later in the
        contact, mostly because the bodies then part.
    geometry_yaw_rate : float or array [rad/s]
        Estimate of how far the change of the yaw rate moves for the same reason; None and NaN as
        above.
    """

    _title = "Left out for one vehicle"

    tyre_impulse_bound: Value = field(metadata={"unit": "N*s"})
    tyre_delta_v_bound: Value = field(metadata={"unit": "m/s"})
    tyre_share_bound: Value = field(metadata={"unit": ""})
    tyre_impulse: Value = field(metadata={"unit": "N*s"})
    tyre_impulse_x: Value = field(metadata={"unit": "N*s"})
    tyre_impulse_y: Value = field(metadata={"unit": "N*s"})
    tyre_delta_v: Value = field(metadata={"unit": "m/s"})
    tyre_share: Value = field(metadata={"unit": ""})
    displacement_x: Value = field(metadata={"unit": "m"})
    displacement_y: Value = field(metadata={"unit": "m"})
    rotation: Value = field(metadata={"unit": "rad"})
    geometry_delta_v: Value | None = field(metadata={"unit": "m/s"})
    geometry_share: Value | None = field(metadata={"unit": ""})
    geometry_yaw_rate: Value | None = field(metadata={"unit": "rad/s"})


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class LeftOut(Shown):
    """The result of ``left_out``; floats, or arrays in a batch.

    Attributes
    ----------
    duration : float or array [s]
        Duration of the contact, as given.
    drag : float or array [-]
        Drag factor of the tyres on the ground, as given; 0 where the tyres of both are in the
        impact.
    mutual_crush : float or array [m]
        Largest distance by which the contact points pass into each other along the normal, both
        vehicles together. NaN for an incomplete impact, in which the bodies pass each other or
        tear.
    residual_crush : float or array [m]
        The same at separation.
    contact_slide : float or array [m]
        How far B's contact point moves along the tangent, relative to A's.
    a, b : LeftOutVehicle
        What was left out for each vehicle.
    """

    _title = "Left out by the impulse idealisation"

    duration: Value = field(metadata={"unit": "s"})
    drag: Value = field(metadata={"unit": ""})
    mutual_crush: Value = field(metadata={"unit": "m"})
    residual_crush: Value = field(metadata={"unit": "m"})
    contact_slide: Value = field(metadata={"unit": "m"})
    a: LeftOutVehicle = field()
    b: LeftOutVehicle = field()

    @property
    @returns("N*s")
    def outside_a(self) -> tuple[Value, Value]:
        """The estimated impulse of A's tyres (x, y) [N*s], to be given to ``eccentric`` or
        ``solve`` as ``outside_a``.
        """
        return self.a.tyre_impulse_x, self.a.tyre_impulse_y

    @property
    @returns("N*s")
    def outside_b(self) -> tuple[Value, Value]:
        """The same of B's tyres, for ``outside_b``."""
        return self.b.tyre_impulse_x, self.b.tyre_impulse_y


@computing
def left_out(
    impact: Impact,
    *,
    duration: Input = USUAL_DURATION,
    drag: Input = 0.7,
    tyres_a: Tyres | None = None,
    tyres_b: Tyres | None = None,
    geometry: Literal["maximum_engagement", "first_contact"] = "maximum_engagement",
) -> LeftOut:
    """Estimate what an impact that takes no time and has no tyres leaves out, to judge whether the
    idealisation fits the case.

    An impulse acts at one instant and one place; a real contact takes about 0.1 s, in which the
    tyres act too, and the vehicles move and turn. The bound on the tyres needs only drag and
    duration; the rest is estimated from the states before and after, with the spring pulse as the
    contact force, which ``plot.force_time`` draws: a quarter of a sine up to the end of
    compression, and one down that takes e times as long.

    Parameters
    ----------
    impact : Impact
        From any solver but ``time_resolved``; a single case or a batch.
    duration : float, str, Quantity or array [s]
        Duration of the contact, >= 0: 0.05 to 0.15 s for cars, the softer the longer.
    drag : float, str, Quantity or array [-]
        Drag factor of the tyres of both vehicles on the ground, >= 0: a plain number, or a
        deceleration such as ``"6.9 m/s**2"``. 0.7 is locked wheels on a dry road. It stands for
        wheels that slide whatever way they go; those that roll hardly resist along themselves, and
        sideways with their full friction: give ``tyres_a`` and ``tyres_b``.
    tyres_a, tyres_b : travel.Tyres, optional
        The wheels of each vehicle in place of the drag, which still counts for a vehicle without:
        the impulse of the tyres is then that which ``eccentric`` takes with them, and its bound
        that of their friction. Of a vehicle whose tyres are in the impact none are left out, of the
        other those that slide with the drag; the duration is then that of the impact, unless
        another is given.
    geometry : {"maximum_engagement", "first_contact"}
        When the positions, the point and the normal of the impact are those of the vehicles, as for
        ``time_resolved``: as everywhere at maximum engagement, at which damage is matched, or at
        first contact.

    Returns
    -------
    LeftOut
        In a batch a case that was refused is NaN, and so is the effect of geometry in one that
        would be refused when shifted. An impact of ``solve`` is solved again by the model that
        answered it.

    Raises
    ------
    InputError
        Some arguments cannot be used; the message names each of them.

    Notes
    -----
    Let s be the share of the impulse that has passed: with constant geometry every velocity of a
    body is its value before plus s times its change. The spring pulse is the force of a linear
    spring that unloads along a stiffer one. Over a duration T it has s = (1 - cos(pi (1 + e) t/(2
    T)))/(1 + e) up to the end of compression at T/(1 + e), and a mean of s over time of m = (1 - 2
    (1 - e)/pi)/(1 + e): 0.36 if plastic, 1/2 if elastic. The rest follows, all derived here:

    - displacement and rotation are T times the sum of the velocity before and m times its change;
      so is the slide, which is exact if the slip does not end during the contact;
    - mutual crush is 2 c T/(pi (1 + e)) for a closing speed c: 0.64 c T if plastic, 0.32 c T if
      elastic; with a constant force it would be c T/(2 (1 + e)). At separation 2 (1 - e) c T/pi of
      it is left;
    - the tyre impulse is drag x weight x T times the mean over time of the direction opposite to
      the motion of the centre of mass, taken at a few moments, so that it is rough where a vehicle
      nearly stops or turns back meanwhile. It moves delta-V together with the response of the
      contact to it, as ``outside_a`` and ``outside_b`` do: restitution still ends the impact with e
      times the closing speed. In line against a wall, nothing of it is left;
    - for the geometry, positions and angles follow from the displacement and the rotation up to any
      moment, before that of the impact or after it; the contact point moves with the mean of the
      two places that met, the normal turns with the mean of the rotations; with a fixed body the
      normal stays, and the point moves with the other body. The impact is solved again with the
      impulse where the bodies are on the mean while the force acts, with velocities at the
      contact that are then left as seen at the end. Restitution gives back e times what closed
      while the spring was pressed: the closing speed at first contact, and what positions and
      normal added to it since.

    Measured against ``time_resolved`` (benchmarks/time_resolved.py), over 150 random impacts of two
    cars without spin that close at 2 to 28 m/s, with a friction of 0.2 to 0.8 and a restitution
    of 0 to 0.4, for vehicles whose delta-V changes by more than 2 percent: the estimate is 0.71
    to 1.25 of the change due to tyres in 9 of 10, 0.05 to 1.56 in all; 0.48 to 1.38 of that due
    to geometry in 9 of 10, 0.20 to 1.66 in all; and with ``geometry="first_contact"`` 0.83 to
    1.31 of that in 9 of 10, 0.69 to 1.55 in all. Over as many impacts with a friction of 0 to 0.1
    it is 0.69 to 1.29 of the change due to tyres in 9 of 10, 0.05 to 2.43 in all; 0.59 to 1.08 of
    that due to geometry in 9 of 10, 0.21 to 1.22 in all; and from first contact 0.82 to 1.36 of
    that in 9 of 10, 0.21 to 2.26 in all. Of a plastic impact without friction the estimate for
    the geometry is exact as the duration goes to 0. A higher restitution makes it too large: at
    0.8 up to six times the change, which is small there from maximum engagement. Spin before,
    pivots and walls have not been measured.

    Also left out here: the turning moment of the tyres, load and suspension, and crush that moves
    the centre of mass.

    Examples
    --------
    The bound on tyres in rear-end impacts at 2 and at 20 m/s; the rotation in a T-bone, and what
    motion does to its delta-V:

    >>> import collisions as col
    >>> for speed in (2.0, 20.0):
    ...     a, b = col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1500.0)
    ...     found = col.left_out(col.linear_central(a, b, restitution=0.4))
    ...     side = found.b
    ...     bound, crush = side.tyre_delta_v_bound, found.mutual_crush
    ...     print(f"{bound:.2f} m/s, {side.tyre_share_bound:.0%} of it; crush {crush:.2f} m")
    0.69 m/s, 49% of it; crush 0.09 m
    0.69 m/s, 5% of it; crush 0.91 m
    >>> a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=20.0, x=-2.2, y=0.0)
    >>> b = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, x=0.8, y=-1.0)
    >>> impact = col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5)
    >>> found = col.left_out(impact, duration="100 ms")
    >>> first = col.left_out(impact, duration="100 ms", geometry="first_contact")
    >>> print(
    ...     f"{found.b.q.rotation.to('deg'):.0f~P}, delta-V moves by {found.b.geometry_share:.1%}"
    ... )
    -10 deg, delta-V moves by 1.3%
    >>> print(f"taken as those of first contact: {first.b.geometry_share:.1%}")
    taken as those of first contact: 9.8%
    """
    reader = ArgumentReader()
    if isinstance(impact, Impact) and impact.pulse is not None:
        text = (
            "impact was followed in time, so an impulse left nothing out of it; its pulse and "
            "a.tyre_loss have what came about"
        )
        reader.refuse(InputError(text, code="takes_time", argument="impact"))
    elif not isinstance(impact, Impact):
        reader.refuse(not_an_answer(impact, (Impact,), "left_out"))
    tyres: dict[str, Any] = {}
    if isinstance(impact, Impact):
        bodies = impact.a.before, impact.b.before
        tyres = read_tyres(reader, "left_out", *bodies, {"tyres_a": tyres_a, "tyres_b": tyres_b})
    with callers_options():
        time = read_duration(reader, duration)
        pull = read_drag(reader, drag, "drag")
    if not isinstance(geometry, str) or geometry not in _GEOMETRIES:
        known = " or ".join(map(repr, _GEOMETRIES))
        text = (
            f"geometry must be {known}, which says when the positions of the impact are those, "
            f"got {shown(geometry)}"
        )
        reader.refuse(InputError(text, code="bad_option", argument="geometry"))
    held = tyres_held(impact) if tyres else ()
    if held:
        if tyres_a is not None or tyres_b is not None:
            text = (
                "impact has its tyres, so they are not left out of it; leave tyres_a and tyres_b "
                "out, or write again()"
            )
            reader.refuse(InputError(text, code="bad_combination", argument="tyres_a"))
        if not tyres_lacking(impact) and (not impact.inputs.tyres or np.all(_takes_tyres(impact))):
            pull = 0.0
        if isinstance(duration, Default):
            origin, time = impact.reconstruction, impact.inputs.duration
            time = origin.duration if time is None and origin is not None else time
    if isinstance(impact, Impact) and tyres_a is tyres_b is None and impact.inputs.tyres:
        if isinstance(duration, Default):
            time = impact.inputs.duration
        if not np.all(_takes_tyres(impact)):
            # Those that a central model left out.
            tyres = {f"tyres_{label}": one for label, one in impact.inputs.tyres.items()}
    reader.close()
    given = {"impact": impact.closing_speed, "duration": time, "drag": pull}
    own = {name: one for name, one in tyres.items() if one is not None}
    given |= {
        f"{name}.{inner}": value for name, one in own.items() for inner, value in one.named.items()
    }
    shape, dtype = broadcast(given), precision(given.values())
    time, pull = widened((time, pull), (impact.closing_speed, time, pull))
    beyond, texts = (
        np.isinf(_extent(impact, time, pull)) & np.logical_not(impact.refused),
        impact.inputs.texts,
    )
    if shape is None:
        if beyond:
            raise out_of_range()
        return _assembled(_estimated(impact, time, pull, held, own, geometry), texts)
    if is_one_part(shape):
        whole = {
            name: value if value is None else np.broadcast_to(value, shape).astype(dtype)
            for name, value in _estimated(impact, time, pull, held, own, geometry).items()
        }
    else:

        def work(part: Part) -> dict[str, Any]:
            # The impact itself gave the warnings about its cases.
            with quietly():
                some = part_of_impact(impact, part.of, on_failure="nan")
            there = part_of(own, part.of)
            return _estimated(some, part.of(time), part.of(pull), held, there, geometry)

        whole = in_parts(work, shape, dtype)
    there = {name: value for name, value in whole.items() if value is not None}
    return _assembled(
        whole | settle(there, {"duration": time, "drag": pull}, shape, [("out_of_range", beyond)]),
        texts,
    )


def _estimated(
    impact: Impact,
    time: Any,
    drag: Any,
    held: Collection[str],
    wheels: Mapping[str, Tyres],
    geometry: str,
) -> dict[str, Any]:
    """The fields of ``LeftOut`` by name, those of its sides prefixed "a." or "b."; NaN where
    refused. Tyres of the vehicles ``held`` are in the impact.
    """
    with np.errstate(all="ignore"):
        e = impact.restitution
        most = drag * GRAVITY * time
        left = {label: _left(impact, label, held) for label in "ab"}
        bounds = {label: most * left[label] for label in "ab"}
        pulls = Pull.of(impact.a, e, bounds["a"]), Pull.of(impact.b, e, bounds["b"])
        if wheels:
            pulls = by_wheels(impact, time, wheels, pulls, left)
            for name, one in wheels.items():
                bounds[name[-1]] = one.friction * GRAVITY * time * left[name[-1]]
        # A refused single case cannot be solved again.
        tyres = [math.nan] * 2 if impact.refused is True else with_tyres(impact, pulls)
        moved = with_motion(impact, time, geometry)
        passed, crush = (
            pulse.mean_passed(e),
            pulse.greatest_crush(e) * (impact.closing_speed * time),
        )
        found = {
            "duration": time,
            "drag": drag,
            "mutual_crush": crush,
            "residual_crush": (1.0 - e) * (1.0 + e) * crush,
            "contact_slide": (
                impact.slip_before + passed * (impact.slip_after - impact.slip_before)
            )
            * time,
        }
        for label, pull, by_tyres, (by_motion, turns) in zip(
            "ab", pulls, tyres, moved, strict=True
        ):
            side = getattr(impact, label)
            before, delta_v = side.before, side.delta_v
            mass = finite_mass(before)
            of_side = {
                "tyre_impulse_bound": mass * bounds[label],
                "tyre_delta_v_bound": pull.most,
                "tyre_share_bound": _share(pull.most, delta_v),
                "tyre_impulse": mass * hypot(pull.x, pull.y),
                "tyre_impulse_x": mass * pull.x,
                "tyre_impulse_y": mass * pull.y,
                "tyre_delta_v": by_tyres,
                "tyre_share": _share(by_tyres, delta_v),
                "displacement_x": (before.vx + passed * side.delta_vx) * time,
                "displacement_y": (before.vy + passed * side.delta_vy) * time,
                "rotation": (before.yaw_rate + passed * side.delta_yaw_rate) * time,
                "geometry_delta_v": by_motion,
                "geometry_share": None if by_motion is None else _share(by_motion, delta_v),
                "geometry_yaw_rate": turns,
            }
            found |= {f"{label}.{name}": value for name, value in of_side.items()}
        return {
            name: None if value is None else select(impact.refused, math.nan, value)
            for name, value in found.items()
        }


def _extent(impact: Impact, time: Any, drag: Any) -> Any:
    """An upper bound of tyre impulses, distances, rotations and 1 over a mass; infinite where one
    may overflow.
    """
    states = (impact.a.before, impact.a.after, impact.b.before, impact.b.after)
    with np.errstate(all="ignore"):
        most = drag * GRAVITY * time
        reach = sum(
            time * (abs(state.vx) + abs(state.vy) + abs(state.yaw_rate)) for state in states
        )
        contact = time * (
            abs(impact.closing_speed) + abs(impact.slip_before) + abs(impact.slip_after)
        )
        held = sum(
            most * finite_mass(side.before) + 1.0 / side.before.mass
            for side in (impact.a, impact.b)
        )
        return most + reach + contact + held


def _assembled(found: dict[str, Any], texts: tuple[str, ...]) -> LeftOut:
    """A ``LeftOut`` from its fields by name, in the units of these texts."""
    read_only(found)
    a, b = (
        in_units_of(
            LeftOutVehicle(
                **{name[2:]: value for name, value in found.items() if name.startswith(f"{label}.")}
            ),
            texts,
        )
        for label in "ab"
    )
    return in_units_of(
        LeftOut(**{name: value for name, value in found.items() if "." not in name}, a=a, b=b),
        texts,
    )


def _share(part: Any, whole: Any) -> Any:
    """The quotient; 0 for a part of 0, otherwise NaN for a whole of 0."""
    return select(part == 0.0, 0.0, part / select(whole == 0.0, math.nan, whole))
