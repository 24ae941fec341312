"""The derivation of an eccentric impact: section 2.3 of the paper, for free, pinned and fixed bodies, and with friction."""

from __future__ import annotations

import math

from ..impact import Impact
from ..kernels.eccentric import response
from ..models import body_numbers
from .contact import Mobility, impulses
from .energy import energy
from .expressions import Expression, Symbol, total
from .oblique import components, kept, scene_axes
from .page import Page
from .pinned import moments_about_pivot, turned
from .symbols import AFTER, BEFORE, COMPRESSED, Body, Contact, bodies, letter


class Lever:
    """The lever of one body: from its centre of mass, or from its pivot, to the contact; and what resists a turn."""

    def __init__(self, body: Body) -> None:
        impact, label = body.impact, body.label
        vehicle = body.start
        assert impact.point is not None
        self.body = body
        self.pinned = vehicle.pivot is not None
        mass, inertia, vx, vy, _, x, y, pivot_x, pivot_y = body_numbers(vehicle, impact.point)
        _, turn, rx, ry, _, _ = response(mass, inertia, vx, vy, x, y, pivot_x, pivot_y, *impact.point, self.pinned)
        nx, ny = impact.normal
        self.matters = (self.pinned or body.turns or vehicle.yaw_rate != 0.0) and vehicle.x is not None
        self.n = letter(rf"r_{{{label}n}}", f"r_{label}n", nx * rx + ny * ry, "length")
        self.t = letter(rf"r_{{{label}t}}", f"r_{label}t", nx * ry - ny * rx, "length")
        name = rf"I_{{{label}O}}" if self.pinned else rf"\bar{{I}}_{label}"
        text = f"I_{label}O" if self.pinned else f"I_{label}"
        self.inertia = letter(name, text, 1.0 / turn if turn else math.inf, "inertia")

    @property
    def turns(self) -> bool:
        """Whether an impulse can turn the body."""
        return math.isfinite(self.inertia.value)

    def write(self, page: Page, contact: Contact) -> None:
        """Where it comes from."""
        point, vehicle, label = self.body.impact.point, self.body.start, self.body.label
        assert point is not None
        center = vehicle.pivot or (vehicle.x, vehicle.y)
        foot = f"O_{label}" if self.pinned else f"G_{label}"
        parts = []
        for axis, there, here in zip("xy", point, center, strict=True):
            end = letter(f"C_{axis}", f"C_{axis}", there, "length")
            start = letter(rf"{foot[0]}_{{{label}{axis}}}", f"{foot}{axis}", here, "length")
            parts.append(end - start)
        x, y = parts
        what = f"from {'its pivot O' if self.pinned else 'its centre of mass G'} to the contact C"
        page.equation(f"Lever of {label} {what}, along the normal", self.n, contact.dot(x, y))
        page.equation(f"Lever of {label} {what}, along the tangent (r in (13))", self.t, contact.cross(x, y))
        if self.pinned:
            d_x, d_y = (self.body.arm(axis) for axis in "xy")
            page.say(f"From the pivot to the centre of mass of {label}: {page.shown(d_x)}, {page.shown(d_y)}.")
            page.equation(
                f"Yaw inertia of {label} about its pivot",
                self.inertia,
                self.body.inertia + self.body.mass * (d_x.squared() + d_y.squared()),
            )

    def at_contact(self, page: Page, when: str, caption: str, directions: str = "nt") -> None:
        """The velocity of the body at the contact."""
        # What nothing changes has the letter that it had before.
        body, spin = self.body, self.body.spin(when if self.turns else BEFORE)
        for direction in directions:
            name, lever, sign = ("normal", self.t, -1.0) if direction == "n" else ("tangent", self.n, 1.0)
            turning = spin * lever
            center = body.along(direction, BEFORE if body.fixed else when)
            if self.pinned:
                found: Expression = -turning if sign < 0.0 else turning
            elif not self.matters or spin.value == 0.0:
                found = center
            else:
                found = center - turning if sign < 0.0 else center + turning
            page.equation(f"{caption}, along the {name}", body.along(direction, when, contact=True), found)

    def torque(self, contact: Contact) -> Expression:
        """The moment of the impulse on this body."""
        pn, pt = contact.normal, contact.tangential
        forward, backward = self.t * pn, self.n * pt
        if pt.value == 0.0:
            return forward if self.body.sign < 0.0 else -forward
        return forward - backward if self.body.sign < 0.0 else backward - forward


def eccentric(page: Page, impact: Impact) -> None:
    """Write it down."""
    pair = bodies(impact)
    contact = Contact(impact)
    levers = [Lever(body) for body in pair]
    page.heading("Eccentric impact")
    page.say(
        f"{_turns(page, levers)} The normal n points from A into B, and t is n turned by 90 degrees counter-clockwise; yaw is "
        "positive counter-clockwise. The impulse P acts on B at the contact C, and -P on A (1)."
    )
    for lever in levers:
        if lever.matters:
            lever.write(page, contact)
    page.heading("Velocities of the contact points before")
    for lever in levers:
        if not lever.pinned:
            components(page, lever.body, contact)
        label, (n, t) = lever.body.label, (lever.body.along(direction, contact=True) for direction in "nt")
        if lever.body.state(BEFORE).speed != 0.0 or lever.body.spin().value != 0.0:
            lever.at_contact(page, BEFORE, f"Velocity of {label} at the contact")
        else:
            page.say(f"{label} is at rest at the contact too: {page.shown(n)} and {page.shown(t)}.")
    a, b = pair
    page.equation("Closing speed", contact.closing, a.along("n", contact=True) - b.along("n", contact=True))
    page.equation("Slip, of B relative to A", contact.slip, b.along("t", contact=True) - a.along("t", contact=True))
    page.heading("Impulse")
    impulses(page, impact, contact, _mobility(page, impact, contact, levers))
    page.equation("Impulse of the period of deformation", contact.compression, contact.normal / (1.0 + contact.e))
    page.equation("Impulse of the period of restitution (10)", contact.restitution, contact.e * contact.compression)
    page.heading("Motions after")
    for lever in levers:
        _after(page, lever, contact)
    moments_about_pivot(
        page, impact, contact, [(lever.body, lever.n, lever.t, lever.inertia, lever.pinned) for lever in levers]
    )
    page.heading("Check at the contact")
    for lever in levers:
        lever.at_contact(page, AFTER, f"Velocity of {lever.body.label} at the contact after")
    _restitution(page, contact, levers)
    page.equation("Slip after", contact.slip_after, b.along("t", AFTER, True) - a.along("t", AFTER, True))
    energy(page, impact, contact)


def _turns(page: Page, levers: list[Lever]) -> str:
    """Which yaw rates the impulse changes."""
    turned = [lever for lever in levers if page.system.working(lever.body.side.delta_yaw_rate, "yaw rate") != "0"]
    if not turned:
        return "The impulse has no moment about a body that could turn, so it changes no yaw rate."
    about = " and ".join(f"the {'pivot' if lever.pinned else 'centre of mass'} of {lever.body.label}" for lever in turned)
    if len(turned) == 2:
        return f"The impulse has a moment about {about}, which changes both yaw rates."
    (other,) = (lever.body.label for lever in levers if lever is not turned[0])
    return f"The impulse has a moment about {about}, which changes its yaw rate; that of {other} stays."


def _mobility(page: Page, impact: Impact, contact: Contact, levers: list[Lever]) -> Mobility:
    """What an impulse does to the relative velocity at the contact."""
    turning = [lever for lever in levers if lever.turns]
    central: list[Expression] = [1.0 / lever.body.mass for lever in levers if not lever.pinned and not lever.body.fixed]
    k_nn = letter("K_{nn}", "K_nn", 1.0 / impact.effective_mass, "per mass")
    page.say(
        "An impulse at the contact changes the velocity of B relative to A there, for each unit of impulse, by K: along n by "
        "a normal one, along t by a tangential one, and across."
    )
    page.equation("Along the normal", k_nn, total(*central, *(lever.t.squared() / lever.inertia for lever in turning)))
    page.equation("Mass that the contact feels", contact.mass, 1.0 / k_nn)
    if contact.tangential.value == 0.0 and impact.friction == 0.0:
        return Mobility(k_nn, k_nn, None)
    tangential = total(*central, *(lever.n.squared() / lever.inertia for lever in turning)) if central or turning else None
    k_tt = Symbol("K_{tt}", "K_tt", 0.0 if tangential is None else tangential.value, "per mass")
    if tangential is not None:
        page.equation("Along the tangent", k_tt, tangential)
    k_nt = letter("K_{nt}", "K_nt", impact._output("coupling"), "per mass")
    if not turning:
        return Mobility(k_nn, k_tt, None)
    crossed = total(*(lever.n * lever.t / lever.inertia for lever in turning))
    page.equation("Across", k_nt, -crossed)
    return Mobility(k_nn, k_tt, k_nt)


def _after(page: Page, lever: Lever, contact: Contact) -> None:
    """The motion of one body after the impact."""
    body, label = lever.body, lever.body.label
    if lever.pinned:
        turned(page, body, lever.inertia, lever.torque(contact), contact)
        return
    if body.fixed:
        kept(page, body)
    else:
        _moved(page, body, contact)
    if not lever.turns:
        page.say(f"{label} has an infinite yaw inertia and keeps its yaw rate ({page.shown(body.spin())}).")
        return
    if contact.tangential.value == 0.0:
        way = 1.0 if body.sign < 0.0 else -1.0
        for name, number, start, end, impulse in (
            ("at the end of deformation", "13", body.spin(), body.spin(COMPRESSED), contact.compression),
            ("after", "15", body.spin(COMPRESSED), body.spin(AFTER), contact.restitution),
        ):
            change = lever.t * impulse / lever.inertia
            page.equation(f"Yaw rate of {label} {name} ({number})", end, start + change if way > 0.0 else start - change)
    else:
        page.equation(
            f"Yaw rate of {label} after, (13) and (15) with the moment of both components",
            body.spin(AFTER),
            body.spin() + lever.torque(contact) / lever.inertia,
        )


def _moved(page: Page, body: Body, contact: Contact) -> None:
    """The velocity of the centre of mass of a free body after the impact."""
    label = body.label
    for name, number, start, end, impulse in (
        ("at the end of deformation", "12", body.along("n"), body.along("n", COMPRESSED), contact.compression),
        ("after", "14", body.along("n", COMPRESSED), body.along("n", AFTER), contact.restitution),
    ):
        change = impulse / body.mass
        caption = f"Velocity of the centre of mass of {label} {name}, along the normal ({number})"
        page.equation(caption, end, start + change if body.sign > 0.0 else start - change)
    before, after = body.along("t"), body.along("t", AFTER)
    if contact.tangential.value == 0.0:
        page.equation(f"Velocity of {label} after, along the tangent, as before", after, before)
    else:
        change = contact.tangential / body.mass
        page.equation(
            f"Velocity of {label} after, along the tangent", after, before + change if body.sign > 0.0 else before - change
        )
    scene_axes(page, body, contact)


def _restitution(page: Page, contact: Contact, levers: list[Lever]) -> None:
    """Restitution at the contact, from both bodies and from one."""
    a, b = (lever.body for lever in levers)
    after = b.along("n", AFTER, True) - a.along("n", AFTER, True)
    page.balance(
        "Restitution at the contact (11)", after, contact.e * (a.along("n", contact=True) - b.along("n", contact=True)), "speed"
    )
    changes = [abs(body.along("n", AFTER, True).value - body.along("n", contact=True).value) for body in (a, b)]
    lever = levers[0] if changes[0] >= changes[1] else levers[1]
    body, label = lever.body, lever.body.label
    # Without friction a body that is free has it from (13).
    if lever.turns and (lever.pinned or contact.tangential.value != 0.0):
        page.equation(
            f"Yaw rate of {label} at the end of deformation, as in (13) with the part 1 / (1 + e) of the impulse",
            body.spin(COMPRESSED),
            body.spin() + lever.torque(contact) / ((1.0 + contact.e) * lever.inertia),
        )
    lever.at_contact(page, COMPRESSED, f"Velocity of {label} at the contact at the end of deformation", "n")
    start, middle, end = (body.along("n", when, True) for when in ("before", COMPRESSED, AFTER))
    page.equation(
        f"The same from {label} alone, with {page.letter(middle)} at the end of deformation (19)",
        contact.e,
        (middle - end) / (start - middle),
    )
