"""A body that can only turn about a pivot, and moments about that pivot as in Example 3 of the paper."""

from __future__ import annotations

from collections.abc import Sequence

from ..impact import Impact
from .expressions import Expression, Symbol
from .page import Page
from .symbols import AFTER, Body, Contact, letter


def turned(page: Page, body: Body, inertia: Symbol, torque: Expression, contact: Contact) -> None:
    """The motion of a pinned body after the impact, and the impulse of its pivot."""
    label = body.label
    spin = body.spin(AFTER)
    page.equation(f"Yaw rate of {label} after, by moments about its pivot", spin, body.spin() + torque / inertia)
    page.say(f"{label} turns about its pivot, so its centre of mass moves with the yaw rate times the arm from there.")
    page.equation(f"Velocity of {label} after, along x", body.along("x", AFTER), -(spin * body.arm("y")))
    page.equation(f"Velocity of {label} after, along y", body.along("y", AFTER), spin * body.arm("x"))
    impulse_in_scene_axes(page, contact)
    for axis, value in (("x", body.side.pivot_impulse_x), ("y", body.side.pivot_impulse_y)):
        change = body.mass * (body.along(axis, AFTER) - body.along(axis))
        push = contact.impulse(axis)
        page.equation(
            f"Impulse of the pivot on {label}, along {axis}",
            letter(rf"J_{{{label}{axis}}}", f"J_{label}{axis}", value, "impulse"),
            change - push if body.sign > 0.0 else change + push,
        )


def impulse_in_scene_axes(page: Page, contact: Contact) -> None:
    """The impulse on B along x and y."""
    for axis in "xy":
        page.equation(
            f"Impulse on B, along {axis}", contact.impulse(axis), contact.scene(axis, contact.normal, contact.tangential)
        )


def moments_about_pivot(
    page: Page, impact: Impact, contact: Contact, pair: Sequence[tuple[Body, Symbol, Symbol, Symbol, bool]]
) -> None:
    """Equations (20) and (21): both bodies as one system about the pivot of one of them, without friction."""
    if [part[4] for part in pair].count(True) != 1 or contact.tangential.value != 0.0:
        return
    (body, _, lever, inertia, _), (other, *_) = sorted(pair, key=lambda part: not part[4])
    if other.fixed:
        return
    page.heading("Check by moments about the pivot, as in Example 3")
    page.say(
        f"Both vehicles are one system, and the impulse of the pivot has no moment about it. Velocities are counted along the "
        f"normal and the yaw rate counter-clockwise; the paper counts it clockwise, hence the sign of "
        f"{page.letter(body.spin(AFTER))}."
    )
    sides = []
    for when in ("before", AFTER):
        moment = other.mass * lever * other.along("n", when)
        turn = inertia * body.spin(when)
        sides.append(moment if body.spin(when).value == 0.0 else moment - turn)
    page.balance("Moments about the pivot (20)", sides[0], sides[1], "angular momentum")
    system = page.system
    scale, speed, rate = (system.scale(kind) for kind in ("angular momentum", "speed", "yaw rate"))
    v, w = other.along("n", AFTER), body.spin(AFTER)
    # Counted as in (21): the contact point of the pinned body less the other one, both after.
    sign = 1.0 if body.label == "B" else -1.0
    moments = (sides[0].value * scale, other.mass.value * lever.value * scale / speed, -inertia.value * scale / rate)
    parting = (impact.separation_speed * speed, -sign, -sign * lever.value * speed / rate)
    alone = other.spin(AFTER).value == 0.0
    more = page.enough((moments, parting), (v, w)) if alone else 0
    page.collected("(20) in numbers", moments[0], [(moments[1], v), (moments[2], w)], system.label("angular momentum"), more)
    if not alone:
        return
    page.collected(
        "(21) in numbers, from the restitution at the contact",
        parting[0],
        [(parting[2], w), (parting[1], v)],
        system.label("speed"),
        more,
    )
    page.say(f"Solved together: {page.shown(w)} and {page.shown(v)}.")
