"""Energy that an impact turns into damage and heat: Kelvin's theorem, and the form that cannot go negative.

Differences of kinetic energies (eq 7 of the paper) lose every digit in a moving frame; these forms use only what happens at the
contact, hold for barriers and pivots and do not depend on the frame.
"""

from typing import Any

from .codes import FRICTION, KUDLICH_SLIBAR


def energy_losses(
    restitution: Any,
    closing: Any,
    slip_before: Any,
    slip_after: Any,
    slip_sum: Any,
    slip_change: Any,
    normal: Any,
    tangential: Any,
    mobility: Any,
    rule: str,
    law: str,
    eps: float,
) -> tuple[Any, Any, Any, Any]:
    """Loss along the normal (eq 8), loss along the tangent, their sum, and whether the sum is a gain beyond its own rounding.

    ``mobility`` is P.K P, ``slip_change`` what the slip after differs by from that of a sticking contact.
    """
    loss_n = 0.5 * (1.0 - restitution) * (closing * normal)
    loss_t = 0.0 - 0.5 * tangential * slip_sum
    if law == KUDLICH_SLIBAR and rule == FRICTION:
        # Every term is >= 0: the compression impulse's own work, and friction over the slip left at the end of compression.
        loss = (0.5 * (1.0 - restitution) * mobility + abs(tangential * slip_change)) / (1.0 + restitution)
        return loss_n, loss_t, loss, False
    loss = loss_n + loss_t
    rounding = -16.0 * eps * (loss_n + abs(tangential) * (abs(slip_before) + abs(slip_after)))
    return loss_n, loss_t, loss, loss < rounding
