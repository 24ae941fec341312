"""The derivation of an oblique central impact: section 2.2 of the paper, and friction beside it."""

from __future__ import annotations

from ..impact import Impact
from .contact import Mobility, impulses
from .energy import energy
from .expressions import Expression
from .page import Page
from .symbols import AFTER, Body, Contact, bodies


def oblique(page: Page, impact: Impact) -> None:
    """Write it down."""
    a, b = pair = bodies(impact)
    contact = Contact(impact)
    page.heading("Oblique central impact")
    page.say(
        "The vehicles are point masses: the line of impact passes through both centres of mass. The normal n points from A "
        "into B, and t is n turned by 90 degrees counter-clockwise."
    )
    for body in pair:
        components(page, body, contact)
    page.equation("Closing speed", contact.closing, a.along("n") - b.along("n"))
    page.equation("Slip, of B relative to A", contact.slip, b.along("t") - a.along("t"))
    if a.fixed or b.fixed:
        hit = b if a.fixed else a
        page.equation(f"Mass that the contact feels, as the other is infinite: that of {hit.label}", contact.mass, hit.mass)
    else:
        page.equation("Mass that the contact feels", contact.mass, a.mass * b.mass / (a.mass + b.mass))
    page.heading("Impulse")
    impulses(page, impact, contact, Mobility(1.0 / contact.mass, 1.0 / contact.mass, None))
    page.equation("Impulse of the compression period, area A1", contact.compression, contact.normal / (1.0 + contact.e))
    page.equation("Impulse of the restitution period, area A2 = e A1", contact.restitution, contact.e * contact.compression)
    page.heading("Velocities after")
    for body in pair:
        pushed(page, body, contact)
    page.equation(
        "Check: restitution (9)", contact.e, -((b.along("n", AFTER) - a.along("n", AFTER)) / (b.along("n") - a.along("n")))
    )
    page.equation("Slip after", contact.slip_after, b.along("t", AFTER) - a.along("t", AFTER))
    energy(page, impact, contact)


def components(page: Page, body: Body, contact: Contact) -> None:
    """The velocity before along n and t."""
    if body.side.before.speed == 0.0:
        page.say(f"The velocity of {body.label} before is 0: {page.shown(body.along('n'))} and {page.shown(body.along('t'))}.")
        return
    x, y = body.along("x"), body.along("y")
    page.equation(f"Velocity of {body.label} before, along the normal", body.along("n"), contact.dot(x, y))
    page.equation(f"Velocity of {body.label} before, along the tangent", body.along("t"), contact.cross(x, y))


def pushed(page: Page, body: Body, contact: Contact) -> None:
    """The velocity after of a body that is free to move, along n and t and back in scene axes."""
    if body.fixed:
        kept(page, body)
        return
    for direction, name, impulse in (("n", "normal", contact.normal), ("t", "tangent", contact.tangential)):
        before, after = body.along(direction), body.along(direction, AFTER)
        caption = f"Velocity of {body.label} after, along the {name}"
        if impulse.value == 0.0:
            page.equation(f"{caption}, as before", after, before)
            continue
        change: Expression = impulse / body.mass
        page.equation(caption, after, before + change if body.sign > 0.0 else before - change)
    scene_axes(page, body, contact)


def kept(page: Page, body: Body) -> None:
    """The velocity after of a body of infinite mass."""
    n, t = body.along("n", AFTER), body.along("t", AFTER)
    page.say(f"{body.label} has an infinite mass and keeps its velocity: {page.shown(n)} and {page.shown(t)}.")


def scene_axes(page: Page, body: Body, contact: Contact) -> None:
    """The velocity after in scene axes, where they are not those of the contact."""
    n, t = body.along("n", AFTER), body.along("t", AFTER)
    if contact.impact.normal == (1.0, 0.0):
        x, y = body.along("x", AFTER), body.along("y", AFTER)
        same = " and ".join(f"{page.letter(one)} = {page.shown(other)}" for one, other in ((x, n), (y, t)))
        page.say(f"The normal is the x axis and the tangent the y axis, so {same}.")
        return
    page.equation(f"Velocity of {body.label} after, along x", body.along("x", AFTER), contact.scene("x", n, t))
    page.equation(f"Velocity of {body.label} after, along y", body.along("y", AFTER), contact.scene("y", n, t))
