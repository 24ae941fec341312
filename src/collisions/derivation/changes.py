"""What is read out of an impact, each from its definition: delta-V, PDOF, and speed and course after."""

from __future__ import annotations

import math

from ..impact import Impact
from .expressions import Direction, Expression, Function, Symbol, root, total
from .page import Page
from .symbols import AFTER, Body, Contact, bodies, letter


def changes(page: Page, impact: Impact) -> None:
    """Write it down for both vehicles."""
    page.heading("Delta-V, direction of the force, and motion after")
    page.say(
        "Delta-V is the change of velocity of the centre of mass. The PDOF is where the impulse on a vehicle comes from, seen "
        "from that vehicle: 0 from ahead, positive clockwise. Directions are counted counter-clockwise from the x axis."
    )
    # What a body of infinite mass is pushed by is known from the other one.
    for body in sorted(bodies(impact), key=lambda body: body.fixed):
        if body.fixed:
            page.say(f"{body.label} has an infinite mass, so its delta-V is 0.")
        else:
            _delta_v(page, body)
        _pdof(page, impact, body)
        _after(page, body)


def magnitude(x: Expression, y: Expression) -> Expression:
    """The length of a vector, without a component that is 0."""
    parts = [part for part in (x, y) if part.value]
    return root(total(*(part.squared() for part in parts))) if len(parts) > 1 else Function("abs", parts[0] if parts else x)


def seen_from(page: Page, label: str, heading: float, alpha: Symbol, pdof: float) -> None:
    """The PDOF, from the heading and the direction of the impulse."""
    psi = letter(rf"\psi_{label}", f"psi_{label}", heading, "angle")
    half = letter(r"\pi", "pi", math.pi, "angle")
    turns = round((pdof - (psi.value - alpha.value)) / math.pi)
    back = half if abs(turns) == 1 else abs(turns) * half
    page.equation(
        f"PDOF of {label}: against the impulse, clockwise from its heading {page.letter(psi)} (definition)",
        letter(rf"\mathrm{{PDOF}}_{label}", f"PDOF_{label}", pdof, "angle"),
        psi - alpha + back if turns > 0 else psi - alpha - back,
    )


def delta(label: str, axis: str, value: float) -> Symbol:
    """A component of delta-V, or its magnitude if no axis is named."""
    return letter(rf"\Delta v_{{{label}{axis}}}", f"dv_{label}{axis}", value, "speed")


def alpha_of(label: str, value: float) -> Symbol:
    """The direction of the impulse on a vehicle."""
    return letter(rf"\alpha_{label}", f"alpha_{label}", value, "angle")


def _parts(body: Body) -> tuple[Symbol, Symbol]:
    return delta(body.label, "x", body.side.delta_vx), delta(body.label, "y", body.side.delta_vy)


def _delta_v(page: Page, body: Body) -> None:
    for axis, part in zip("xy", _parts(body), strict=True):
        before, after = body.axis(axis), body.axis(axis, AFTER)
        if before.value == 0.0 and after.value == 0.0:
            page.say(f"{body.label} does not move along {axis}, before or after: {page.shown(after)} and {page.shown(part)}.")
        else:
            page.equation(f"Delta-V of {body.label} along {axis} (definition)", part, after - before)
    page.equation(f"Delta-V of {body.label} (definition)", delta(body.label, "", body.side.delta_v), magnitude(*_parts(body)))


def _pdof(page: Page, impact: Impact, body: Body) -> None:
    side, label = body.side, body.label
    if body.start.heading is None or side.pdof is None or math.isnan(side.pdof):
        return
    alpha = alpha_of(label, side.impulse_direction)
    if not body.fixed and body.start.pivot is None:
        page.equation(
            f"Direction of the impulse on {label}, which is that of its delta-V (definition)", alpha, Direction(*_parts(body))
        )
    else:
        contact = Contact(impact)
        a, b = bodies(impact)
        other = b if label == "A" else a
        if other.fixed or other.start.pivot is not None or body.start.pivot is not None:
            x, y = contact.impulse("x"), contact.impulse("y")
            pushed = Direction(x, y) if label == "B" else Direction(-x, -y)
        else:
            x, y = _parts(other)
            pushed = Direction(-x, -y)
        page.equation(f"Direction of the impulse on {label}, opposite to that on {other.label} (1)", alpha, pushed)
    seen_from(page, label, body.start.heading, alpha, side.pdof)


def _after(page: Page, body: Body) -> None:
    """Speed and course after."""
    state, label = body.state(AFTER), body.label
    speed = letter(rf"\lvert v_{{{label}}}' \rvert", f"|v'_{label}|", state.speed, "speed")
    if page.system.working(state.speed, "speed") == "0":
        page.say(f"{label} is at rest after: {page.shown(speed)}, and no course.")
        return
    # What keeps its velocity keeps the letters of that before.
    x, y = (body.axis(axis, AFTER) if not body.fixed else body.axis(axis) for axis in "xy")
    page.equation(f"Speed of {label} after (definition)", speed, magnitude(x, y))
    course = letter(rf"\theta_{{{label}}}'", f"theta'_{label}", state.course, "angle")
    page.equation(f"Course of {label} after (definition)", course, Direction(x, y))
