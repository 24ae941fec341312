"""How the tangential impulse follows from the normal one: Coulomb friction, a given ratio, a share of the critical ratio.

Both laws are told apart here too: what the slip is multiplied by while the contact sticks.
"""

from math import inf
from typing import Any

from .codes import CRITICAL_FRACTION, FRICTION, KUDLICH_SLIBAR
from .select import select


def sticking_slip(restitution: Any, law: str) -> Any:
    """Slip after over slip before of a contact that sticks.

    "brach" has it at rest at separation. "kudlich-slibar" has it at rest at the end of compression and multiplies the whole
    compression impulse by 1 + e, which sends the slip back as -e times the initial one.
    """
    return -restitution if law == KUDLICH_SLIBAR else 0.0


def tangential_rule(rule: str, value: Any, no_slip_n: Any, no_slip_t: Any) -> tuple[Any, Any, Any, Any]:
    """Whether the contact sticks, its impulse ratio otherwise, whether no slip matters, and whether it would need a pull.

    The no-slip impulse decides: the sign of the initial slip is the wrong one where the levers reverse it. The limit is
    compared by multiplication, so that an infinite friction needs no case of its own.
    """
    pushes = no_slip_n > 0.0
    if rule == FRICTION:
        matters = value > 0.0
        sticks = matters & pushes & (abs(no_slip_t) <= value * no_slip_n)
        # Adding 0 turns the -0 of a frictionless contact into 0.
        return sticks, select(no_slip_t < 0.0, -value, value) + 0.0, matters, (value == inf) & (no_slip_n <= 0.0)
    if rule == CRITICAL_FRACTION:
        matters = value > 0.0
        ratio = value * (no_slip_t / select(pushes, no_slip_n, 1.0))
        return pushes & (value == 1.0), ratio, matters, matters & (no_slip_n <= 0.0)
    return False, value, False, False
