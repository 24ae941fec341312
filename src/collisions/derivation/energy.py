"""What became of the energy: the loss at the contact, and the check with the kinetic energies."""

from __future__ import annotations

import math

from ..impact import Impact
from ..vehicle import Vehicle
from .expressions import HALF, Expression, total
from .page import Page
from .symbols import AFTER, BEFORE, Body, Contact, bodies, letter


def energy(page: Page, impact: Impact, contact: Contact) -> None:
    """The loss along the normal and along the tangent."""
    page.heading("Energy")
    e, pn, pt = contact.e, contact.normal, contact.tangential
    page.equation("Energy lost along the normal, (8) at the contact", contact.loss_n, HALF * (1.0 - e) * contact.closing * pn)
    if pt.value != 0.0:
        work = -(HALF * pt * (contact.slip + contact.slip_after))
        page.equation("Energy lost along the tangent, to the mean of both slips", contact.loss_t, work)
        page.equation("Energy lost", contact.loss, contact.loss_n + contact.loss_t)
    else:
        page.equation("Energy lost, as nothing is lost along the tangent", contact.loss, contact.loss_n)
    kinetic_energies(page, impact, contact)


def kinetic_energies(page: Page, impact: Impact, contact: Contact) -> None:
    """The loss as the difference of the kinetic energies, where those are finite."""
    starts: list[Expression] = []
    ends: list[Expression] = []
    states = [(body, when, _kinetic(body.state(when))) for body in bodies(impact) for when in (BEFORE, AFTER)]
    if any(math.isnan(value) for *_, value in states):
        page.say("A body turns whose yaw inertia is not known, and so its kinetic energy is not: (7) is no check here.")
        return
    if any(math.isinf(value) for *_, value in states):
        page.say("A body of infinite mass or inertia that moves has no finite kinetic energy: (7) is no check here.")
        return
    for body, when, value in states:
        if body.fixed and not value:
            page.say(f"{body.label} has an infinite mass and rests {when}, so it has no kinetic energy.")
            continue
        mark = "'" if when == AFTER else ""
        symbol = letter(f"T_{body.label}{mark}", f"T{mark}_{body.label}", value, "energy")
        (ends if mark else starts).append(symbol)
        parts = _parts(body, when)
        if parts:
            turning = ", of translation and rotation" if body.state(when).yaw_rate else ""
            page.equation(f"Kinetic energy of {body.label} {when}{turning}", symbol, total(*parts))
        else:
            page.say(f"{body.label} rests {when}: {page.shown(symbol)}.")
    right = total(*starts)
    for term in ends:
        right = right - term
    page.equation("Check: kinetic energies before less those after (7)", contact.loss, right)


def _parts(body: Body, when: str) -> list[Expression]:
    """Half of mass times speed squared, and half of yaw inertia times yaw rate squared, as far as they are not 0."""
    state, parts = body.state(when), list[Expression]()
    if state.speed:
        along = [body.axis(axis, when) for axis in "xy"]
        parts.append(HALF * body.mass * total(*(part.squared() for part in along if part.value)))
    if state.yaw_rate:
        # A central model leaves the yaw rate as it was.
        spin = body.spin(when if body.impact.model == "eccentric" else BEFORE)
        parts.append(HALF * body.inertia * spin.squared())
    return parts


def _kinetic(vehicle: Vehicle) -> float:
    """Kinetic energy, as far as what is known of the body tells it; a turning point mass has none that is known."""
    turns_unknown = vehicle.yaw_inertia is None and vehicle.yaw_rate != 0.0
    return math.nan if turns_unknown else float(vehicle.kinetic_energy)
