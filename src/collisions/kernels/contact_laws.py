"""How restitution and friction act at a contact: the laws, what may be said of the tangent, and the energy that is lost.

A new law or a new tangential rule is an entry of the tables below; every solver, page and message reads it there.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf
from typing import Any, NamedTuple

from .elementwise import FINITE, NOT_NEGATIVE, UNIT_INTERVAL, Domain, select


@dataclass(frozen=True, eq=False, slots=True)
class Law:
    """How restitution acts, and what no slip means.

    Parameters
    ----------
    name : str
        As given to ``law=``.
    sticking_slip : callable
        Slip after over slip before of a contact that sticks, from the restitution, by + - * / alone: ``explain`` writes it in
        symbols.
    no_slip : str
        What no slip means, in a few words for messages.
    derivation, assumption : str
        The same as ``explain`` and a report say it.

    Attributes
    ----------
    compression_limit : bool
        Whether that slip is -e, so that a sticking contact is at rest at the end of compression and restitution multiplies that
        whole impulse by 1 + e. Then the energy lost with friction is a sum of terms that are >= 0.
    """

    name: str
    sticking_slip: Callable[[Any], Any]
    no_slip: str
    derivation: str
    assumption: str
    compression_limit: bool = field(init=False)

    def __post_init__(self) -> None:
        at_rest = all(self.sticking_slip(e) == -e for e in (0.0, 0.1, 0.3, 0.7, 1.0))
        object.__setattr__(self, "compression_limit", at_rest)


class Tangent(NamedTuple):
    """What a rule decides: whether the contact sticks, and its impulse ratio if it does not.

    ``needs_no_slip`` says whether the no-slip impulse matters, ``pulls`` whether that would need the bodies to pull.
    """

    sticks: Any
    ratio: Any
    needs_no_slip: Any
    pulls: Any


@dataclass(frozen=True, eq=False, slots=True)
class Rule:
    """One way to say what happens along the tangent.

    Parameters
    ----------
    name : str
        The argument that gives its value.
    domain : Domain
        The values it may have.
    meaning : str
        What the value is, for tables.
    decide : callable
        The ``Tangent`` from the value and the no-slip impulse (n, t).
    """

    name: str
    domain: Domain
    meaning: str
    decide: Callable[[Any, Any, Any], Tangent]


def _coulomb(friction: Any, no_slip_n: Any, no_slip_t: Any) -> Tangent:
    # The no-slip impulse decides: the sign of the initial slip is the wrong one where the levers reverse it. The limit is
    # compared by multiplication, so that an infinite friction needs no case of its own. Adding 0 turns a -0 into 0.
    matters = friction > 0.0
    sticks = matters & (no_slip_n > 0.0) & (abs(no_slip_t) <= friction * no_slip_n)
    ratio = select(no_slip_t < 0.0, -friction, friction) + 0.0
    return Tangent(sticks, ratio, matters, pulls=(friction == inf) & (no_slip_n <= 0.0))


def _given_ratio(ratio: Any, no_slip_n: Any, no_slip_t: Any) -> Tangent:
    return Tangent(sticks=False, ratio=ratio, needs_no_slip=False, pulls=False)


def _share_of_critical(share: Any, no_slip_n: Any, no_slip_t: Any) -> Tangent:
    pushes = no_slip_n > 0.0
    matters = share > 0.0
    ratio = share * (no_slip_t / select(pushes, no_slip_n, 1.0))
    return Tangent(pushes & (share == 1.0), ratio, matters, pulls=matters & (no_slip_n <= 0.0))


FRICTION, IMPULSE_RATIO, CRITICAL_FRACTION = "friction", "impulse_ratio", "critical_fraction"
BRACH, KUDLICH_SLIBAR = "brach", "kudlich-slibar"

RULES = {
    rule.name: rule
    for rule in (
        Rule(FRICTION, NOT_NEGATIVE, "friction (bound on the impulse ratio)", _coulomb),
        Rule(IMPULSE_RATIO, FINITE, "impulse ratio", _given_ratio),
        Rule(CRITICAL_FRACTION, UNIT_INTERVAL, "critical fraction", _share_of_critical),
    )
}
LAWS = {
    law.name: law
    for law in (
        Law(
            BRACH,
            lambda restitution: 0.0,
            no_slip="no slip at separation",
            derivation='no slip is left at separation (law "brach")',
            assumption="restitution acts on the normal impulse; with enough friction the contact has stopped slipping when the "
            "vehicles part",
        ),
        Law(
            KUDLICH_SLIBAR,
            lambda restitution: -restitution,
            no_slip="no slip at the end of compression",
            derivation="the contact is at rest at the end of compression and the whole compression impulse is multiplied by "
            '1 + e (law "kudlich-slibar"), which turns the slip around and leaves e times as much',
            assumption="with enough friction the contact is at rest at the end of compression, and the whole impulse until "
            "then is multiplied by 1 + e, so that slip comes back with the opposite sign",
        ),
    )
}


def energy_losses(
    restitution: Any,
    closing: Any,
    slip_before: Any,
    slip_after: Any,
    slip_sum: Any,
    slip_change: Any,
    normal: Any,
    tangential: Any,
    impulse_work: Any,
    rule: str,
    law: str,
    eps: float,
) -> tuple[Any, Any, Any, Any]:
    """Loss along the normal (eq 8), loss along the tangent, their sum, and whether the sum is a gain beyond its own rounding.

    Kelvin's theorem, and for friction with a compression limit the form that cannot go negative. Differences of kinetic
    energies (eq 7 of the paper) lose every digit in a moving frame; these forms use only what happens at the contact, hold for
    barriers and pivots and do not depend on the frame. ``impulse_work`` is P.K P, twice an energy, ``slip_change`` the
    difference of the slip after from that of a sticking contact.
    """
    loss_n = 0.5 * (1.0 - restitution) * (closing * normal)
    loss_t = 0.0 - 0.5 * tangential * slip_sum
    if dissipates(rule, law):
        # Every term is >= 0: the compression impulse's own work, and friction over the slip left at the end of compression.
        loss = (0.5 * (1.0 - restitution) * impulse_work + abs(tangential * slip_change)) / (1.0 + restitution)
        return loss_n, loss_t, loss, False
    loss = loss_n + loss_t
    rounding = -16.0 * eps * (loss_n + abs(tangential) * (abs(slip_before) + abs(slip_after)))
    return loss_n, loss_t, loss, loss < rounding


def dissipates(rule: str, law: str) -> bool:
    """Whether the energy lost is a sum of terms that are >= 0, so that no case can gain."""
    return rule == FRICTION and LAWS[law].compression_limit
