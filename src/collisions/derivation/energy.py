"""What became of the energy: the loss at the contact, and the check with the kinetic energies."""

from __future__ import annotations

import math

from ..impact import Impact
from ..vehicle import Vehicle
from .expressions import HALF, Expression, total
from .letters import Contact, letter
from .page import Page


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
    for label, side in (("A", impact.a), ("B", impact.b)):
        for mark, vehicle, terms in (("", side.before, starts), ("'", side.after, ends)):
            value = _kinetic(vehicle)
            if not math.isfinite(value):
                page.say("A body of infinite mass or inertia that moves has no finite kinetic energy: (7) is no check here.")
                return
            if math.isfinite(vehicle.mass) or value:
                terms.append(letter(f"T_{label}{mark}", f"T{mark}_{label}", value, "energy"))
    right = total(*starts)
    for term in ends:
        right = right - term
    page.equation("Check: kinetic energies before less those after (7)", contact.loss, right)


def _kinetic(vehicle: Vehicle) -> float:
    """Kinetic energy, as far as what is known of the body tells it; a turning point mass has none that is known."""
    turns_unknown = vehicle.yaw_inertia is None and vehicle.yaw_rate != 0.0
    return math.nan if turns_unknown else float(vehicle.kinetic_energy)
