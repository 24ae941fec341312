"""What was given, and the answers, as tables."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from ..impact import Impact
from ..kernels.contact_laws import RULES
from ..vehicle import Vehicle
from .expressions import Function
from .page import Page
from .symbols import Contact, letter

_SIDE = {
    "after.vx": ("velocity after, along x", "speed"),
    "after.vy": ("velocity after, along y", "speed"),
    "after.speed": ("speed after", "speed"),
    "after.course": ("course after", "angle"),
    "after.yaw_rate": ("yaw rate after", "yaw rate"),
    "delta_v": ("delta-V", "speed"),
    "delta_vx": ("delta-V along x", "speed"),
    "delta_vy": ("delta-V along y", "speed"),
    "delta_yaw_rate": ("change of yaw rate", "yaw rate"),
    "pdof": ("PDOF (0 from ahead, positive clockwise)", "angle"),
    "pivot_impulse_x": ("impulse of the pivot, along x", "impulse"),
    "pivot_impulse_y": ("impulse of the pivot, along y", "impulse"),
}
_BEFORE = {
    "before.vx": ("velocity before, along x", "speed"),
    "before.vy": ("velocity before, along y", "speed"),
    "before.speed": ("speed before", "speed"),
    "before.yaw_rate": ("yaw rate before", "yaw rate"),
}
_CONTACT = {
    "closing_speed": ("closing speed", "speed"),
    "separation_speed": ("separation speed", "speed"),
    "slip_before": ("slip before", "speed"),
    "slip_after": ("slip after", "speed"),
    "restitution": ("restitution", "number"),
    "normal_impulse": ("normal impulse", "impulse"),
    "tangential_impulse": ("tangential impulse", "impulse"),
    "impulse_ratio": ("impulse ratio", "number"),
    "energy_absorbed": ("energy absorbed along the normal at the end of compression", "energy"),
    "energy_loss": ("energy lost", "energy"),
}
_ECCENTRIC = ("yaw_rate", "delta_yaw_rate")
_FRICTION = ("slip_before", "slip_after", "tangential_impulse", "impulse_ratio")

NAMES = tuple(f"{label}.{name}" for label in "ab" for name in (*_BEFORE, *_SIDE)) + tuple(_CONTACT)


def kind_of(name: str) -> str:
    """The kind of quantity of an answer."""
    label, _, rest = name.partition(".")
    return (_CONTACT[name] if name in _CONTACT else (_SIDE | _BEFORE)[rest if label in "ab" else name])[1]


def given(page: Page, impact: Impact) -> None:
    """What went in."""
    rows: list[tuple[str, str, str]] = []
    for label, vehicle in (("A", impact.a.before), ("B", impact.b.before)):
        name = f"{label} ({page.name(vehicle.name)})" if vehicle.name and vehicle.name != label else label
        rows += [(name, what, text) for what, text in _vehicle(page, vehicle)]
    direction = page.number(impact.normal_angle, "angle")
    bare = impact.inputs.bare_normal
    if bare is not None:
        direction += f", given as {bare:.6g} without a unit"
    rows.append(("contact", "normal, direction from A into B", direction))
    if impact.point is not None and impact.model == "eccentric":
        rows.append(("contact", "contact point (x, y)", ", ".join(page.number(part, "length") for part in impact.point)))
    rows.append(("contact", "restitution e", page.number(impact.restitution, "number")))
    if impact.model != "linear_central":
        value = page.number(impact.inputs.rule_value, "number")
        rows.append(("contact", RULES[impact.inputs.rule].meaning, value))
        rows.append(("contact", "law of restitution and no slip", impact.law or ""))
    page.table(("of", "quantity", "value"), rows)


def direction(page: Page, impact: Impact) -> None:
    """The components of the normal, which the formulas need wherever it is not the x axis."""
    if impact.normal == (1.0, 0.0):
        return
    nx, ny = Contact(impact).nx, Contact(impact).ny
    if 0.0 in impact.normal:
        page.say(f"Components of the normal: {page.shown(nx)} and {page.shown(ny)}.")
        return
    phi = letter(r"\varphi", "phi", impact.normal_angle, "angle")
    page.equation(f"Normal along x, from its direction {page.letter(phi)}", nx, Function("cos", phi))
    page.equation("Normal along y", ny, Function("sin", phi))


def _vehicle(page: Page, vehicle: Vehicle) -> Iterator[tuple[str, str]]:
    yield "mass", page.number(vehicle.mass, "mass")
    yield "velocity along x", page.number(vehicle.vx, "speed")
    yield "velocity along y", page.number(vehicle.vy, "speed")
    for what, value, kind in (
        ("yaw rate", vehicle.yaw_rate or None, "yaw rate"),
        ("yaw inertia about the centre of mass", vehicle.yaw_inertia, "inertia"),
        ("position x of the centre of mass", vehicle.x, "length"),
        ("position y of the centre of mass", vehicle.y, "length"),
        ("heading", vehicle.heading, "angle"),
    ):
        if value is not None:
            yield what, page.number(value, kind)
    if vehicle.pivot is not None:
        yield "pivot O (x, y)", ", ".join(page.number(part, "length") for part in vehicle.pivot)


def answers(page: Page, impact: Impact) -> None:
    """What came out, rounded."""
    rows = []
    for label, side in (("a", impact.a), ("b", impact.b)):
        found = {**(_BEFORE if impact.reconstruction is not None else {}), **_SIDE}
        for name, (what, kind) in found.items():
            if impact.model != "eccentric" and name.endswith("yaw_rate"):
                continue
            if side.before.pivot is None and name.startswith("pivot"):
                continue
            if name == "after.course" and page.system.working(side.after.speed, "speed") == "0":
                continue
            value = _read(side, name)
            if value is not None and not math.isnan(value):
                rows.append((label.upper(), what, page.answer(f"{label}.{name}", value, kind)))
    for name, (what, kind) in _CONTACT.items():
        if (impact.model == "linear_central" and name in _FRICTION) or (
            name == "restitution" and impact.reconstruction is None
        ):
            continue
        rows.append(("contact", what, page.answer(name, getattr(impact, name), kind)))
    page.heading("Answers")
    page.table(("of", "quantity", "value"), rows)


def _read(owner: Any, path: str) -> float | None:
    for part in path.split("."):
        owner = getattr(owner, part)
    return None if owner is None else float(owner)
