"""Derivations of the three models: linear, oblique and eccentric, sections 2.1 to 2.3 of the paper,
also with friction.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..impact.impact import Impact, answer_of
from ..impact.instant import LIMITED
from .contact import Mobility, energy, impulses, kinetic_energies, velocity_after, velocity_before
from .expressions import HALF, ZERO, Expression, total
from .page import Page
from .symbols import AFTER, BEFORE, COMPRESSED, Body, Symbol, Symbols


def linear(page: Page, s: Symbols) -> None:
    """Section 2.1: point masses on one line."""
    a, b, e = s.a, s.b, s.e
    along_x = s.impact.normal == (1.0, 0.0)
    v_a, v_b, after_a, after_b = a.straight(), b.straight(), a.straight(AFTER), b.straight(AFTER)
    page.heading("Linear central impact")
    page.say(
        "The vehicles are taken as point masses, and the impulse is along the normal, which "
        "points from A into B. Velocities are taken along it; the velocity across it does not "
        "change."
    )
    if not along_x:
        for body in s.bodies:
            along = s.dot(body.along("x"), body.along("y"))
            page.equation(
                f"Velocity of {body.label} before, along the normal", body.straight(), along
            )
    page.equation("Closing speed", s.closing, v_a - v_b)
    mass = _reduced(a, b)
    if not s.impact.complete:
        mass = page.let("Mass that the contact feels", "m_e", "mass", mass)
        page.equation(
            "Normal impulse, all of it of the period of compression",
            s.normal,
            (1.0 + e) * mass * s.closing,
        )
        for body in s.bodies:
            if not body.fixed:
                found = body.straight().plus(body.sign, s.normal / body.mass)
                page.equation(f"Velocity of {body.label} after", body.straight(AFTER), found)
    else:
        if a.fixed or b.fixed:
            _against_fixed(page, s)
        else:
            _between_free(page, s)
        page.equation("Normal impulse, of both periods", s.normal, s.compression + s.restitution)
    page.equation("Separation speed", s.separation, after_b - after_a)
    page.equation(
        "Check: restitution from the velocities, as in (9)", e, (after_b - after_a) / (v_a - v_b)
    )
    for body in s.bodies:
        if along_x and body.state(AFTER).vy:
            page.equation(
                f"Velocity of {body.label} after, along y, as before",
                body.along("y", AFTER),
                body.along("y"),
            )
        elif not along_x:
            for axis, part in (("x", s.nx), ("y", s.ny)):
                found = body.along(axis) + part * (body.straight(AFTER) - body.straight())
                page.equation(
                    f"Velocity of {body.label} after, along {axis}", body.along(axis, AFTER), found
                )
    page.equation(
        "Energy lost (8)", s.loss, HALF * (1.0 - e.squared()) * mass * (v_b - v_a).squared()
    )
    kinetic_energies(page, s)


def _reduced(a: Body, b: Body) -> Expression:
    """The mass that the contact of two point masses feels."""
    return (b if a.fixed else a).mass if a.fixed or b.fixed else a.mass * b.mass / (a.mass + b.mass)


def _against_fixed(page: Page, s: Symbols) -> None:
    """Impulse, and velocity after, of a body that hits one of infinite mass."""
    wall, hit = (s.a, s.b) if s.a.fixed else (s.b, s.a)
    v, wall_v = hit.straight(), wall.straight()
    page.fact(
        f"{wall.label} has an infinite mass: it keeps its velocity "
        f"({page.shown(wall.straight(AFTER))}), so both share {page.symbol(wall_v)} at the end "
        f"of compression (3), and the mass that the contact feels is {page.symbol(hit.mass)}.",
        (wall.straight(AFTER), wall_v),
    )
    number, change = ("(5)", v - wall_v) if hit is s.a else ("(6)", wall_v - v)
    page.equation(
        f"Impulse of the compression period, area A1 (3), on {hit.label}",
        s.compression,
        hit.mass * change,
    )
    page.equation(
        "Impulse of the restitution period, area A2 = e A1", s.restitution, s.e * s.compression
    )
    common = wall_v.unless_zero()
    caption = f"Velocity of {hit.label} after, {number} against a fixed body (Example 1)"
    page.equation(caption, hit.straight(AFTER), common - s.e * (v - common))


def _between_free(page: Page, s: Symbols) -> None:
    """Impulses of both periods, and both velocities after."""
    m_a, m_b, e = s.a.mass, s.b.mass, s.e
    v_a, v_b, after_a, after_b = (
        s.a.straight(),
        s.b.straight(),
        s.a.straight(AFTER),
        s.b.straight(AFTER),
    )
    both = m_a + m_b
    compressed = s.a.along("n", COMPRESSED)
    # Between bodies of very unlike masses it is a small difference of large velocities.
    common = Symbol("v_c", compressed.value, "speed", size=compressed.size)
    page.equation(
        "Common velocity at the end of compression (3)", common, (m_a * v_a + m_b * v_b) / both
    )
    page.equation(
        "Impulse of the compression period, area A1 (3), on B", s.compression, m_b * (common - v_b)
    )
    page.equation(
        "Impulse of the restitution period, area A2 = e A1", s.restitution, e * s.compression
    )
    page.equation("Velocity of A after (5)", after_a, v_a + m_b / both * (1.0 + e) * (v_b - v_a))
    page.equation("Velocity of B after (6)", after_b, v_b + m_a / both * (1.0 + e) * (v_a - v_b))
    page.balance(
        "Check: momentum before and after (2)",
        m_a * v_a + m_b * v_b,
        m_a * after_a + m_b * after_b,
        "impulse",
    )


def oblique(page: Page, s: Symbols) -> None:
    """Section 2.2: point masses in the plane."""
    a, b = s.bodies
    page.heading("Oblique central impact")
    page.say(
        "The vehicles are point masses: the line of impact passes through both centres of mass. "
        "The normal n points from A into B, and t is n turned by 90 degrees counter-clockwise."
    )
    for body in s.bodies:
        velocity_before(page, body, s)
    page.equation("Closing speed", s.closing, a.along("n") - b.along("n"))
    page.equation("Slip, of B relative to A", s.slip, s.relative("t"))
    whose = (
        f", as the other is infinite: that of {(b if a.fixed else a).label}"
        if a.fixed or b.fixed
        else ""
    )
    page.equation(f"Mass that the contact feels{whose}", s.mass, _reduced(a, b))
    page.heading("Impulse")
    impulses(page, s, Mobility(1.0 / s.mass, 1.0 / s.mass, None))
    page.heading("Velocities after")
    for body in s.bodies:
        caption = f"Velocity of {body.label} after, along the normal"
        velocity_after(page, body, s, [(caption, BEFORE, AFTER, s.normal)])
    page.equation("Separation speed", s.separation, s.relative("n", AFTER))
    page.equation("Check: restitution (9)", s.e, -(s.relative("n", AFTER) / s.relative("n")))
    page.equation("Slip after", s.slip_after, s.relative("t", AFTER))
    energy(page, s)


class Lever(Body):
    """A body with its lever arm, from centre of mass or pivot to the contact, and its inertia about
    that point.
    """

    def __init__(self, impact: Impact, label: str) -> None:
        super().__init__(impact, label)
        assert impact.point is not None
        self.point = impact.point
        self.center = self.start.pivot or (self.start.x, self.start.y)
        # For a body without a position the lever arm does not matter.
        rx, ry = (
            0.0 if at is None else there - at
            for there, at in zip(self.point, self.center, strict=True)
        )
        nx, ny = impact.normal
        self.n = Symbol(rf"r_{{{label}n}}", nx * rx + ny * ry, "length")
        self.t = Symbol(rf"r_{{{label}t}}", nx * ry - ny * rx, "length")
        self.about_pivot = self.inertia + self.mass * (
            self.arm("x").squared() + self.arm("y").squared()
        )
        self.resistance = (
            Symbol(rf"I_{{{label}O}}", self.about_pivot.value, "inertia")
            if self.pinned
            else self.inertia
        )
        self.turns = math.isfinite(self.resistance.value)
        self.matters = (
            self.pinned or self.turns or self.start.yaw_rate != 0.0
        ) and self.start.x is not None

    def derive(self, page: Page, s: Symbols) -> None:
        """Write the components of the lever arm."""
        label = self.label
        x, y = (
            Symbol(f"C_{axis}", there, "length")
            - Symbol(f"{'O' if self.pinned else 'G'}_{{{label}{axis}}}", here, "length")
            for axis, there, here in zip("xy", self.point, self.center, strict=True)
        )
        what = f"from {'its pivot O' if self.pinned else 'its centre of mass G'} to the contact C"
        page.equation(f"Lever of {label} {what}, along the normal", self.n, s.dot(x, y))
        page.equation(
            f"Lever of {label} {what}, along the tangent (r in (13))", self.t, s.cross(x, y)
        )
        if self.pinned:
            d_x, d_y = (page.shown(self.arm(axis)) for axis in "xy")
            page.say(f"From the pivot to the centre of mass of {label}: {d_x}, {d_y}.")
            page.equation(
                f"Yaw inertia of {label} about its pivot", self.resistance, self.about_pivot
            )

    def at_contact(self, page: Page, when: str, caption: str, directions: str = "nt") -> None:
        """The velocity of the body at the contact."""
        # An unchanged velocity keeps its symbol of before.
        spin = self.spin(when if self.turns else BEFORE)
        for direction in directions:
            name, lever, sign = (
                ("normal", self.t, -1.0) if direction == "n" else ("tangent", self.n, 1.0)
            )
            center = ZERO if self.pinned else self.along(direction, BEFORE if self.fixed else when)
            turning = spin * lever if self.pinned or (self.matters and spin.value != 0.0) else ZERO
            found = center.plus(sign, turning)
            page.equation(
                f"{caption}, along the {name}", self.along(direction, when, contact=True), found
            )

    def torque(self, s: Symbols) -> Expression:
        """The moment of the impulse on this body."""
        by_normal = self.t * s.normal
        by_tangential = self.n * s.tangential.unless_zero()
        by_contact = by_normal - by_tangential if self.label == "A" else by_tangential - by_normal
        return by_contact if self.outside is None else by_contact + self.moment

    @property
    def moment(self) -> Symbol:
        """Moment of the impulse from outside, about the centre of mass or the pivot."""
        x, y, yaw = self.outside or (0.0, 0.0, 0.0)
        value = yaw + self.arm("x").value * y - self.arm("y").value * x if self.pinned else yaw
        return Symbol(
            rf"\mathrm{{M}}_{{{self.label}{'O' if self.pinned else ''}}}", value, "angular momentum"
        )


def eccentric(page: Page, s: Symbols) -> None:
    """Bodies that turn, with the impulse at one point."""
    a, b = levers = Lever(s.impact, "A"), Lever(s.impact, "B")
    page.heading("Eccentric impact")
    page.say(
        f"{_turns(page, levers)} The normal n points from A into B, and t is n turned by 90 "
        "degrees counter-clockwise; yaw is positive counter-clockwise. The impulse P acts on B "
        "at the contact C, and -P on A (1)."
    )
    for body in levers:
        if body.matters:
            body.derive(page, s)
    page.heading("Velocities of the contact points before")
    for body in levers:
        if not body.pinned:
            velocity_before(page, body, s)
        if body.start.speed != 0.0 or body.start.yaw_rate != 0.0:
            body.at_contact(page, BEFORE, f"Velocity of {body.label} at the contact")
        else:
            n, t = (body.along(direction, contact=True) for direction in "nt")
            text = (
                f"{body.label} is at rest at the contact too: {page.shown(n)} and {page.shown(t)}."
            )
            page.fact(text, (n, ZERO), (t, ZERO))
    page.equation(
        "Closing speed", s.closing, a.along("n", contact=True) - b.along("n", contact=True)
    )
    page.equation("Slip, of B relative to A", s.slip, s.relative("t", contact=True))
    page.heading("Impulse")
    impulses(page, s, _mobility(page, s, levers)._replace(push=_from_outside(page, s, levers)))
    if s.impact.inputs.pushed and not (a.pinned or b.pinned):
        impulse_in_scene_axes(page, s)
    page.heading("Motions after")
    for body in levers:
        if body.pinned:
            _turned_about_pivot(page, body, s)
        else:
            _moved(page, body, s)
    _moments_about_pivot(page, s, levers)
    page.heading("Check at the contact")
    for body in levers:
        body.at_contact(page, AFTER, f"Velocity of {body.label} at the contact after")
    _restitution(page, s, levers)
    page.equation("Slip after", s.slip_after, s.relative("t", AFTER, True))
    energy(page, s)


def time_resolved(page: Page, s: Symbols) -> None:
    """A contact in steps: its sums are not printed, but what they balance is."""
    steps = s.impact.inputs.steps or 100
    geometry = (s.impact.inputs.geometry or "maximum_engagement").replace("_", " ")
    wheels = "each wheel slides with the drag given"
    if s.impact.inputs.tyres:
        wheels = (
            "wheels roll, brake and steer as the tyres given say, within the friction of the ground"
        )
    page.heading("Time-resolved impact")
    page.say(
        "The contact was followed in steps, which are too many for a page. Along the normal a "
        "force grows with the penetration and gives back the share e squared of the work it "
        f"took; along the tangent friction acts as Coulomb's; {wheels}. Geometry: {geometry}; "
        f"{steps} steps in a nominal duration. The impulse on B is the sum over all steps: "
        f"{page.shown(s.normal)} along the normal, {page.shown(s.tangential)} along the tangent. "
        "What follows are its balances."
    )
    impulse_in_scene_axes(page, s)
    page.heading("Momentum")
    for body in s.bodies:
        for axis in () if body.fixed else "xy":
            push = body.along(axis).plus(body.sign, s.impulse(axis) / body.mass)
            held = Symbol(
                rf"J_{{{body.label}{axis}}}", getattr(body.side, f"tyre_impulse_{axis}"), "impulse"
            )
            if held.value:
                page.say(
                    f"Impulse of the tyres on {body.label} along {axis}, the sum over all steps: "
                    f"{page.shown(held)}."
                )
                push = push + held / body.mass
            page.equation(
                f"Velocity of {body.label} after, along {axis}", body.along(axis, AFTER), push
            )
    page.heading("Energy")
    page.say(
        "Lost along the normal and along the tangent, the sums over all steps: "
        f"{page.shown(s.loss_n)}, {page.shown(s.loss_t)}."
    )
    page.equation("Energy lost in the contact", s.loss, s.loss_n + s.loss_t)
    tyres = [Symbol(rf"W_{body.label}", body.side.tyre_loss, "energy") for body in s.bodies]
    whole = Symbol(r"\Delta T", s.loss.value + tyres[0].value + tyres[1].value, "energy")
    if tyres[0].value or tyres[1].value:
        page.say(
            f"Lost by the tyres of A and of B: {page.shown(tyres[0])}, {page.shown(tyres[1])}."
        )
        page.equation("Energy lost in all", whole, s.loss + tyres[0] + tyres[1])
    kinetic_energies(page, s, whole)


def _from_outside(page: Page, s: Symbols, levers: Sequence[Lever]) -> tuple[Expression, Expression]:
    """What the impulses from outside add to the closing speed and to the slip, each body's part
    written.
    """
    added: list[Expression] = [ZERO, ZERO]
    for body in levers:
        if body.outside is None:
            continue
        label, (j_x, j_y) = body.label, (body.pushed(axis) for axis in "xy")
        what = body.whence.capitalize()
        whence = "From outside an impulse acts"
        if "tyres" in body.whence:
            given = ""
            if "outside" in body.whence:
                given = ", with the impulse from outside that was given,"
            whence = (
                "The tyres, by their mean force before, half-way through and after the contact "
                f"times its duration, {LIMITED}{given or ','} act as an impulse"
            )
        page.say(
            f"{whence} on {label}: {page.shown(j_x)}, {page.shown(j_y)}, with "
            f"{page.shown(body.moment)}."
        )
        page.equation(f"{what} on {label}, along the normal", body.pushed("n"), s.dot(j_x, j_y))
        page.equation(
            f"{what} on {label}, along the tangent",
            body.pushed("t"),
            s.cross(j_x, j_y),
        )
        for at, (direction, name, lever, sign) in enumerate(
            (("n", "normal", body.t, -1.0), ("t", "tangent", body.n, 1.0))
        ):
            moved = ZERO if body.pinned or body.fixed else body.pushed(direction) / body.mass
            found = (
                moved.plus(sign, body.moment / body.resistance * lever)
                if body.turns and body.moment.value
                else moved
            )
            caption = f"What it changes the velocity of {label} at the contact by, along the {name}"
            change = page.let(caption, rf"\Delta c_{{{label}{direction}}}", "speed", found)
            added[at] = added[at].plus(body.sign * (-1.0, 1.0)[at], change)
    return added[0], added[1]


def impulse_in_scene_axes(page: Page, s: Symbols) -> None:
    """The impulse on B along x and y."""
    for axis in "xy":
        page.equation(
            f"Impulse on B, along {axis}", s.impulse(axis), s.scene(axis, s.normal, s.tangential)
        )


def _turns(page: Page, levers: Sequence[Lever]) -> str:
    """A sentence on the yaw rates that the impulse changes."""
    turned = [
        body for body in levers if page.system.working(body.side.delta_yaw_rate, "yaw rate") != "0"
    ]
    if not turned:
        return "The impulse has no moment about a body that could turn, so it changes no yaw rate."
    about = " and ".join(
        f"the {'pivot' if body.pinned else 'centre of mass'} of {body.label}" for body in turned
    )
    if len(turned) == 2:
        return f"The impulse has a moment about {about}, which changes both yaw rates."
    (other,) = (body.label for body in levers if body is not turned[0])
    return (
        f"The impulse has a moment about {about}, which changes its yaw rate; that of {other} "
        "stays."
    )


def _mobility(page: Page, s: Symbols, levers: Sequence[Lever]) -> Mobility:
    """Write the mobility: the relative velocity at the contact per unit of impulse."""
    turning = [body for body in levers if body.turns]
    central = [1.0 / body.mass for body in levers if not body.pinned and not body.fixed]
    page.say(
        "An impulse at the contact changes the velocity of B relative to A there, for each unit "
        "of impulse, by K: along n by a normal one, along t by a tangential one, and across."
    )
    k_nn = Symbol("K_{nn}", 1.0 / s.impact.effective_mass, "per mass")
    page.equation(
        "Along the normal",
        k_nn,
        total(*central, *(body.t.squared() / body.resistance for body in turning)),
    )
    page.equation("Mass that the contact feels", s.mass, 1.0 / k_nn)
    if s.tangential.value == 0.0 and s.impact.friction == 0.0:
        return Mobility(k_nn, k_nn, None)
    tangential = total(*central, *(body.n.squared() / body.resistance for body in turning))
    k_tt = page.let("Along the tangent", "K_{tt}", "per mass", tangential)
    if not turning:
        return Mobility(k_nn, k_tt, None)
    k_nt = Symbol("K_{nt}", answer_of(s.impact).coupling, "per mass")
    page.equation("Across", k_nt, -total(*(body.n * body.t / body.resistance for body in turning)))
    return Mobility(k_nn, k_tt, k_nt)


def _moved(page: Page, body: Lever, s: Symbols) -> None:
    """The motion of a body without a pivot after the impact."""
    label = body.label
    deformation = "at the end of deformation", BEFORE, COMPRESSED, s.compression
    restitution = "after", COMPRESSED, AFTER, s.restitution
    along_n = [
        (
            f"Velocity of the centre of mass of {label} {when}, along the normal ({number})",
            start,
            end,
            impulse,
        )
        for number, (when, start, end, impulse) in ((12, deformation), (14, restitution))
    ]
    whole = body.outside is not None or not s.impact.complete
    if whole:
        along_n = [
            (
                f"Velocity of the centre of mass of {label} after, along the normal",
                BEFORE,
                AFTER,
                s.normal,
            )
        ]
    velocity_after(page, body, s, along_n)
    if not body.turns:
        text = (
            f"{label} has an infinite yaw inertia and keeps its yaw rate "
            f"({page.shown(body.spin())})."
        )
        page.fact(text, (body.spin(AFTER), body.spin()))
    elif s.tangential.value != 0.0 or whole:
        caption = f"Yaw rate of {label} after, (13) and (15) with the whole moment"
        page.equation(caption, body.spin(AFTER), body.spin() + body.torque(s) / body.resistance)
    else:
        for number, (when, start, end, impulse) in ((13, deformation), (15, restitution)):
            found = body.spin(start).plus(-body.sign, body.t * impulse / body.resistance)
            page.equation(f"Yaw rate of {label} {when} ({number})", body.spin(end), found)


def _turned_about_pivot(page: Page, body: Lever, s: Symbols) -> None:
    """The motion after of a body that can only turn about a pivot, and the impulse of the pivot."""
    label, spin = body.label, body.spin(AFTER)
    turned = body.spin() + body.torque(s) / body.resistance
    page.equation(f"Yaw rate of {label} after, by moments about its pivot", spin, turned)
    page.say(
        f"{label} turns about its pivot, so its centre of mass moves with the yaw rate times the "
        "arm from there."
    )
    page.equation(
        f"Velocity of {label} after, along x", body.along("x", AFTER), -(spin * body.arm("y"))
    )
    page.equation(
        f"Velocity of {label} after, along y", body.along("y", AFTER), spin * body.arm("x")
    )
    impulse_in_scene_axes(page, s)
    for axis, value in (("x", body.side.pivot_impulse_x), ("y", body.side.pivot_impulse_y)):
        found = (body.mass * (body.along(axis, AFTER) - body.along(axis))).plus(
            -body.sign, s.impulse(axis)
        )
        found = found if body.outside is None else found - body.pushed(axis)
        symbol = Symbol(rf"R_{{{label}{axis}}}", value, "impulse")
        page.equation(f"Impulse of the pivot on {label}, along {axis}", symbol, found)


def _moments_about_pivot(page: Page, s: Symbols, levers: Sequence[Lever]) -> None:
    """Equations (20) and (21) of Example 3: both bodies as one system about the pivot of one of
    them, without friction.
    """
    body, other = sorted(levers, key=lambda body: not body.pinned)
    if (
        not body.pinned
        or other.pinned
        or other.fixed
        or s.tangential.value != 0.0
        or s.impact.inputs.pushed
    ):
        return
    page.heading("Check by moments about the pivot, as in Example 3")
    page.say(
        "Both vehicles are one system, and the impulse of the pivot has no moment about it. "
        "Velocities are counted along the normal and the yaw rate counter-clockwise; the paper "
        f"counts it clockwise, hence the sign of {page.symbol(body.spin(AFTER))}."
    )
    mass, inertia = other.mass * body.t, body.resistance
    before, after = (
        mass * other.along("n", when) - inertia * body.spin(when).unless_zero()
        for when in (BEFORE, AFTER)
    )
    page.balance("Moments about the pivot (20)", before, after, "angular momentum")
    scale, speed, rate = (
        page.system.scale(kind) for kind in ("angular momentum", "speed", "yaw rate")
    )
    v, w = other.along("n", AFTER), body.spin(AFTER)
    # Counted as in (21): the contact point of the pinned body less the other one, both after.
    sign, lever = body.sign, body.t.value
    moments = (
        before.value * scale,
        other.mass.value * lever * scale / speed,
        -body.resistance.value * scale / rate,
    )
    parting = (s.separation.value * speed, -sign, -sign * lever * speed / rate)
    solvable = other.spin(AFTER).value == 0.0
    more = page.figures_to_solve((moments, parting), (v, w)) if solvable else 0
    page.collected("(20) in numbers", moments, (v, w), "angular momentum", more)
    if solvable:
        parting_of_w = (parting[0], parting[2], parting[1])
        page.collected(
            "(21) in numbers, from the restitution at the contact",
            parting_of_w,
            (w, v),
            "speed",
            more,
        )
        page.say(f"Solved together: {page.shown(w)} and {page.shown(v)}.")


def _restitution(page: Page, s: Symbols, levers: tuple[Lever, Lever]) -> None:
    """Write the restitution at the contact, from both bodies and from one."""
    a, b = levers
    page.equation("Separation speed", s.separation, s.relative("n", AFTER, True))
    if s.law.followed:
        return
    closing = a.along("n", contact=True) - b.along("n", contact=True)
    page.balance("Restitution at the contact (11)", s.separation, s.e * closing, "speed")
    if s.impact.inputs.pushed or not s.impact.complete:
        return
    # From the body that changes more; if they are equal, max takes A.
    body = max(
        levers,
        key=lambda body: abs(
            body.along("n", AFTER, True).value - body.along("n", contact=True).value
        ),
    )
    # Without friction a body that is free has it from (13).
    if body.turns and (body.pinned or s.tangential.value != 0.0):
        caption = (
            f"Yaw rate of {body.label} at the end of deformation, as in (13) with the part 1 / "
            "(1 + e) of the impulse"
        )
        change = body.torque(s) / ((1.0 + s.e) * body.resistance)
        page.equation(caption, body.spin(COMPRESSED), body.spin() + change)
    body.at_contact(
        page, COMPRESSED, f"Velocity of {body.label} at the contact at the end of deformation", "n"
    )
    start, middle, end = (body.along("n", when, True) for when in (BEFORE, COMPRESSED, AFTER))
    caption = (
        f"The same from {body.label} alone, with {page.symbol(middle)} at the end of deformation "
        "(19)"
    )
    page.equation(caption, s.e, (middle - end) / (start - middle))
