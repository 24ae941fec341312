"""The derivation of a linear central impact: section 2.1 of the paper."""

from __future__ import annotations

from ..impact import Impact
from .energy import kinetic_energies
from .expressions import HALF
from .page import Page
from .symbols import AFTER, COMPRESSED, Contact, bodies, letter


def linear(page: Page, impact: Impact) -> None:
    """Write it down."""
    a, b = bodies(impact)
    contact = Contact(impact)
    e = contact.e
    v_a, v_b = a.straight(), b.straight()
    after_a, after_b = a.straight(AFTER), b.straight(AFTER)
    common = letter("v_c", "v_c", (b if a.fixed else a).along("n", COMPRESSED).value, "speed")
    page.heading("Linear central impact")
    page.say(
        "The vehicles are taken as point masses, and the impulse is along the normal, which points from A into B. Velocities "
        "are counted along it; what a vehicle has across it, it keeps."
    )
    if impact.normal != (1.0, 0.0):
        for body, speed in ((a, v_a), (b, v_b)):
            along = contact.dot(body.along("x"), body.along("y"))
            page.equation(f"Velocity of {body.label} before, along the normal", speed, along)
    page.equation("Closing speed", contact.closing, v_a - v_b)
    if a.fixed or b.fixed:
        wall, hit = (a, b) if a.fixed else (b, a)
        v, wall_v = hit.straight(), wall.straight()
        page.say(
            f"{wall.label} has an infinite mass: it keeps its velocity ({page.shown(wall.straight(AFTER))}), so both share "
            f"{page.letter(wall_v)} at the end of compression (3), and the mass that the contact feels is "
            f"{page.letter(hit.mass)}."
        )
        page.equation(
            f"Impulse of the compression period, area A1 (3), on {hit.label}",
            contact.compression,
            hit.mass * (v - wall_v) if hit is a else hit.mass * (wall_v - v),
        )
        page.equation("Impulse of the restitution period, area A2 = e A1", contact.restitution, e * contact.compression)
        rests = wall_v.value == 0.0
        page.equation(
            f"Velocity of {hit.label} after, {'(5)' if hit is a else '(6)'} against a fixed body (Example 1)",
            hit.straight(AFTER),
            -(e * v) if rests else wall_v - e * (v - wall_v),
        )
        loss = HALF * (1.0 - e.squared()) * hit.mass * (v_b - v_a).squared()
    else:
        m_a, m_b = a.mass, b.mass
        both = m_a + m_b
        page.equation("Common velocity at the end of compression (3)", common, (m_a * v_a + m_b * v_b) / both)
        page.equation("Impulse of the compression period, area A1 (3), on B", contact.compression, m_b * (common - v_b))
        page.equation("Impulse of the restitution period, area A2 = e A1", contact.restitution, e * contact.compression)
        page.equation("Velocity of A after (5)", after_a, v_a + m_b / both * (1.0 + e) * (v_b - v_a))
        page.equation("Velocity of B after (6)", after_b, v_b + m_a / both * (1.0 + e) * (v_a - v_b))
        page.balance("Check: momentum before and after (2)", m_a * v_a + m_b * v_b, m_a * after_a + m_b * after_b, "impulse")
        loss = HALF * (1.0 - e.squared()) * (m_a * m_b / both) * (v_b - v_a).squared()
    page.equation("Check: restitution from the velocities, as in (9)", e, (after_b - after_a) / (v_a - v_b))
    if impact.normal != (1.0, 0.0):
        for body, before, after in ((a, v_a, after_a), (b, v_b, after_b)):
            for axis, part in (("x", contact.nx), ("y", contact.ny)):
                page.equation(
                    f"Velocity of {body.label} after, along {axis}",
                    body.along(axis, AFTER),
                    body.along(axis) + part * (after - before),
                )
    else:
        for body in (a, b):
            if body.state(AFTER).vy:
                page.equation(f"Velocity of {body.label} after, along y, as before", body.along("y", AFTER), body.along("y"))
    page.equation("Energy lost (8)", contact.loss, loss)
    kinetic_energies(page, impact, contact)
