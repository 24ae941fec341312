"""How the tangential impulse came about: the rule, the law, and what decided."""

from __future__ import annotations

import math
from typing import NamedTuple

from ..impact import Impact
from ..kernels.contact_laws import BRACH, CRITICAL_FRACTION, FRICTION, IMPULSE_RATIO, LAWS
from .expressions import Expression, Symbol, over
from .page import Page
from .symbols import Contact, letter


class Mobility(NamedTuple):
    """What an impulse does to the velocity of B relative to A at the contact; the coupling is None for point masses."""

    normal: Expression
    tangential: Expression
    coupling: Expression | None


def impulses(page: Page, impact: Impact, contact: Contact, k: Mobility) -> None:
    """Both components of the impulse on B."""
    rule, bound = impact.inputs.rule, impact.inputs.rule_value
    change = (1.0 + contact.e) * contact.closing
    if math.isnan(contact.critical.value):
        page.say(
            "The contact has one degree of freedom, so the impulse that just stops the slip and the critical impulse ratio are "
            "not defined."
        )
    if rule == FRICTION and bound == 0.0:
        page.say(f"Without friction the impulse is along the normal alone, as in the paper: {page.shown(contact.tangential)}.")
        page.equation("Normal impulse", contact.normal, over(change, k.normal))
        return
    if rule == IMPULSE_RATIO:
        page.say(f"The impulse ratio was given: {page.shown(contact.ratio)}, tangential over normal, signed.")
        _at_ratio(page, contact, change, k)
        return
    if rule == CRITICAL_FRACTION and bound == 0.0:
        page.say(f"A critical fraction of 0 leaves no tangential impulse: {page.shown(contact.tangential)}.")
        page.equation("Normal impulse", contact.normal, over(change, k.normal))
        return
    _without_slip(page, impact, contact, k)
    if rule == CRITICAL_FRACTION:
        fraction = letter("f", "f", bound, "number")
        page.say(f"The critical fraction was given: {page.shown(fraction)} of the ratio that just stops the slip.")
        page.equation("Impulse ratio", contact.ratio, fraction * contact.critical)
        _at_ratio(page, contact, change, k)
        return
    _decide(page, impact, contact, change, k)


def _without_slip(page: Page, impact: Impact, contact: Contact, k: Mobility) -> None:
    """The impulse that stops the slip."""
    ns, ts = _no_slip(impact)
    e, s = contact.e, contact.slip
    page.say(
        f"The impulse that just stops the slip has the components {page.letter(ns)} and {page.letter(ts)}: with it, "
        f"{LAWS[impact.law or BRACH].derivation}."
    )
    wanted = -s if impact.law == BRACH else -((1.0 + e) * s)
    change = (1.0 + e) * contact.closing
    if k.coupling is None:
        page.equation("Its normal component", ns, over(change, k.normal))
        page.equation("Its tangential component", ts, over(wanted, k.tangential))
    else:
        page.say("Both are found from two equations at once:")
        page.balance("Along the normal", k.normal * ns + k.coupling * ts, change, "speed")
        page.balance("Along the tangent", k.coupling * ns + k.tangential * ts, wanted, "speed")
        determinant = k.normal * k.tangential - k.coupling.squared()
        stopped = (1.0 + e) * s if impact.law != BRACH else s
        page.equation(
            "Solved for the normal component (Cramer's rule)",
            ns,
            (k.tangential * change + k.coupling * stopped) / determinant,
        )
        page.equation("Solved for the tangential component", ts, -((k.normal * stopped + k.coupling * change) / determinant))
    if ns.value > 0.0:
        page.equation("The critical impulse ratio", contact.critical, ts / ns)


def _decide(page: Page, impact: Impact, contact: Contact, change: Expression, k: Mobility) -> None:
    """Whether the contact sticks under a friction bound."""
    ns, ts = _no_slip(impact)
    mu = letter(r"\mu", "mu", impact.inputs.rule_value, "number")
    if impact.regime == "sticking":
        if math.isinf(mu.value):
            page.say("The friction has no bound and this impulse pushes, so the contact sticks: it is the impulse.")
        else:
            page.say(
                f"The friction allows |{page.letter(contact.ratio)}| up to {page.shown(mu)}. The critical ratio is within "
                "that and the impulse pushes, so the contact sticks: it is the impulse."
            )
        page.equation("Normal impulse", contact.normal, ns)
        page.equation("Tangential impulse", contact.tangential, ts)
        return
    why = (
        "the critical ratio is beyond it"
        if ns.value > 0.0
        else f"the impulse without slip would have to pull ({page.shown(ns)})"
    )
    page.say(
        f"The friction allows |{page.letter(contact.ratio)}| up to {page.shown(mu)}, and {why}, so the contact slides. The "
        f"impulse ratio is the bound with the sign of {page.letter(ts)} ({page.number(ts.value, 'impulse')})."
    )
    page.equation("Impulse ratio", contact.ratio, mu if contact.ratio.value >= 0.0 else -mu)
    _at_ratio(page, contact, change, k)


def _at_ratio(page: Page, contact: Contact, change: Expression, k: Mobility) -> None:
    """Both components at a ratio."""
    resistance = k.normal if k.coupling is None else k.normal + contact.ratio * k.coupling
    page.equation("Normal impulse", contact.normal, over(change, resistance))
    page.equation("Tangential impulse", contact.tangential, contact.ratio * contact.normal)


def _no_slip(impact: Impact) -> tuple[Symbol, Symbol]:
    return (
        letter("N_s", "N_s", impact._output("no_slip_normal"), "impulse"),
        letter("T_s", "T_s", impact._output("no_slip_tangential"), "impulse"),
    )
