"""The derivations of central impacts: linear, section 2.1 of the paper, and oblique, section 2.2, also with friction."""

from __future__ import annotations

from .contact import Mobility, energy, impulses, kinetic_energies, velocity_after, velocity_before
from .expressions import HALF, ZERO, Expression
from .page import Page
from .symbols import AFTER, BEFORE, COMPRESSED, Symbol, Symbols


def linear(page: Page, s: Symbols) -> None:
    """Section 2.1: point masses on one line."""
    a, b, e = s.a, s.b, s.e
    along_x = s.impact.normal == (1.0, 0.0)
    v_a, v_b, after_a, after_b = a.straight(), b.straight(), a.straight(AFTER), b.straight(AFTER)
    page.heading("Linear central impact")
    page.say(
        "The vehicles are taken as point masses, and the impulse is along the normal, which points from A into B. Velocities "
        "are counted along it; what a vehicle has across it, it keeps."
    )
    if not along_x:
        for body in s.bodies:
            along = s.dot(body.along("x"), body.along("y"))
            page.equation(f"Velocity of {body.label} before, along the normal", body.straight(), along)
    page.equation("Closing speed", s.closing, v_a - v_b)
    if a.fixed or b.fixed:
        _against_fixed(page, s)
        mass: Expression = (b if a.fixed else a).mass
    else:
        _between_free(page, s)
        mass = a.mass * b.mass / (a.mass + b.mass)
    page.equation("Check: restitution from the velocities, as in (9)", e, (after_b - after_a) / (v_a - v_b))
    for body in s.bodies:
        if along_x and body.state(AFTER).vy:
            page.equation(f"Velocity of {body.label} after, along y, as before", body.along("y", AFTER), body.along("y"))
        elif not along_x:
            for axis, part in (("x", s.nx), ("y", s.ny)):
                change = part * (body.straight(AFTER) - body.straight())
                page.equation(
                    f"Velocity of {body.label} after, along {axis}", body.along(axis, AFTER), body.along(axis) + change
                )
    page.equation("Energy lost (8)", s.loss, HALF * (1.0 - e.squared()) * mass * (v_b - v_a).squared())
    kinetic_energies(page, s)


def _against_fixed(page: Page, s: Symbols) -> None:
    """Impulse and velocity after of the body that hits one of infinite mass."""
    wall, hit = (s.a, s.b) if s.a.fixed else (s.b, s.a)
    v, wall_v = hit.straight(), wall.straight()
    at_rest = wall_v if wall_v.value else ZERO
    page.say(
        f"{wall.label} has an infinite mass: it keeps its velocity ({page.shown(wall.straight(AFTER))}), so both share "
        f"{page.symbol(wall_v)} at the end of compression (3), and the mass that the contact feels is {page.symbol(hit.mass)}."
    )
    page.equation(
        f"Impulse of the compression period, area A1 (3), on {hit.label}",
        s.compression,
        hit.mass * (v - wall_v if hit is s.a else wall_v - v),
    )
    page.equation("Impulse of the restitution period, area A2 = e A1", s.restitution, s.e * s.compression)
    page.equation(
        f"Velocity of {hit.label} after, {'(5)' if hit is s.a else '(6)'} against a fixed body (Example 1)",
        hit.straight(AFTER),
        at_rest - s.e * (v - at_rest),
    )


def _between_free(page: Page, s: Symbols) -> None:
    """Impulses of both periods, and both velocities after."""
    m_a, m_b, e = s.a.mass, s.b.mass, s.e
    v_a, v_b, after_a, after_b = s.a.straight(), s.b.straight(), s.a.straight(AFTER), s.b.straight(AFTER)
    both = m_a + m_b
    common = Symbol("v_c", s.a.along("n", COMPRESSED).value, "speed")
    page.equation("Common velocity at the end of compression (3)", common, (m_a * v_a + m_b * v_b) / both)
    page.equation("Impulse of the compression period, area A1 (3), on B", s.compression, m_b * (common - v_b))
    page.equation("Impulse of the restitution period, area A2 = e A1", s.restitution, e * s.compression)
    page.equation("Velocity of A after (5)", after_a, v_a + m_b / both * (1.0 + e) * (v_b - v_a))
    page.equation("Velocity of B after (6)", after_b, v_b + m_a / both * (1.0 + e) * (v_a - v_b))
    page.balance("Check: momentum before and after (2)", m_a * v_a + m_b * v_b, m_a * after_a + m_b * after_b, "impulse")


def oblique(page: Page, s: Symbols) -> None:
    """Section 2.2: point masses in the plane."""
    a, b = s.bodies
    page.heading("Oblique central impact")
    page.say(
        "The vehicles are point masses: the line of impact passes through both centres of mass. The normal n points from A "
        "into B, and t is n turned by 90 degrees counter-clockwise."
    )
    for body in s.bodies:
        velocity_before(page, body, s)
    page.equation("Closing speed", s.closing, a.along("n") - b.along("n"))
    page.equation("Slip, of B relative to A", s.slip, b.along("t") - a.along("t"))
    if a.fixed or b.fixed:
        hit = b if a.fixed else a
        page.equation(f"Mass that the contact feels, as the other is infinite: that of {hit.label}", s.mass, hit.mass)
    else:
        page.equation("Mass that the contact feels", s.mass, a.mass * b.mass / (a.mass + b.mass))
    page.heading("Impulse")
    impulses(page, s, Mobility(1.0 / s.mass, 1.0 / s.mass, None))
    page.equation("Impulse of the compression period, area A1", s.compression, s.normal / (1.0 + s.e))
    page.equation("Impulse of the restitution period, area A2 = e A1", s.restitution, s.e * s.compression)
    page.heading("Velocities after")
    for body in s.bodies:
        caption = f"Velocity of {body.label} after, along the normal"
        velocity_after(page, body, s, [(caption, BEFORE, AFTER, s.normal)])
    page.equation("Check: restitution (9)", s.e, -((b.along("n", AFTER) - a.along("n", AFTER)) / (b.along("n") - a.along("n"))))
    page.equation("Slip after", s.slip_after, b.along("t", AFTER) - a.along("t", AFTER))
    energy(page, s)
