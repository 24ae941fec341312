"""Oblique central impact: two point masses, impulse along the normal and, with friction, the tangent (eq 9 of the paper)."""

from typing import Any

from .central import shares
from .codes import (
    BRACH,
    ENERGY_GAIN,
    EPS,
    FRICTION,
    GRAZING,
    IMMOVABLE,
    KUDLICH_SLIBAR,
    NO_SLIP_PULLS,
    OK,
    OUT_OF_RANGE,
    SEPARATING,
    SPINNING,
)
from .energy import energy_losses
from .friction import sticking_slip, tangential_rule
from .select import select, verdict


def oblique_central(
    restitution: Any,
    nx: Any,
    ny: Any,
    tangential: Any,
    mass_a: Any,
    vx_a: Any,
    vy_a: Any,
    mass_b: Any,
    vx_b: Any,
    vy_b: Any,
    rule: str,
    law: str,
    eps: float = EPS,
    impulse_only: bool = False,
) -> tuple[Any, ...]:
    """Answers in the order of ``codes.OUTPUTS``; the masses divide the change of relative velocity (along n and t).

    With ``impulse_only``: whether there is an answer, whether no slip would need a pull, and the impulse along n and t.
    """
    share_a, share_b, effective_mass, immovable = shares(mass_a, mass_b)
    ux = vx_b - vx_a
    uy = vy_b - vy_a
    closing = -(nx * ux + ny * uy)
    slip = nx * uy - ny * ux
    kept = sticking_slip(restitution, law)
    change_n = (1.0 + restitution) * closing
    no_slip_t = 0.0 - (1.0 - kept) * slip
    sticks, ratio, _, pulls = tangential_rule(rule, tangential, change_n, no_slip_t)
    change_t = select(sticks, no_slip_t, ratio * change_n)
    normal = effective_mass * change_n
    impulse_t = effective_mass * change_t
    if impulse_only:
        work = closing * normal + slip * impulse_t
        return (closing > 0.0) & (work - work == 0.0) & (immovable ^ True), pulls, normal, impulse_t

    beyond_sticking = change_t - no_slip_t
    slip_after = kept * slip + beyond_sticking
    # At rest after sticking, so that the sum is the slip before, to the bit.
    slip_sum = slip + slip_after if law == BRACH else select(sticks, (1.0 + kept) * slip, slip + slip_after)
    mobility = normal * change_n + impulse_t * change_t if law == KUDLICH_SLIBAR and rule == FRICTION else 0.0
    loss_n, loss_t, loss, gains = energy_losses(
        restitution, closing, slip, slip_after, slip_sum, beyond_sticking, normal, impulse_t, mobility, rule, law, eps
    )

    change_x = nx * change_n - ny * change_t
    change_y = ny * change_n + nx * change_t
    total = normal + impulse_t + loss + loss_n + loss_t + slip_after + change_x + change_y
    fine = (closing > 0.0) & (total - total == 0.0) & (gains ^ True) & (pulls ^ True)
    status = (
        OK
        if fine is True
        else verdict(
            (immovable, IMMOVABLE),
            (closing < 0.0, SEPARATING),
            (closing == 0.0, GRAZING),
            (pulls, NO_SLIP_PULLS),
            (total - total != 0.0, OUT_OF_RANGE),
            (gains, ENERGY_GAIN),
        )
    )
    return (
        status, closing, slip, slip_after, normal, impulse_t, effective_mass * closing, normal, effective_mass * no_slip_t,
        sticks, effective_mass, 0.0, loss_n, loss_t, loss,
        effective_mass * change_x, effective_mass * change_y,
        -(share_a * change_x), -(share_a * change_y), 0.0, share_b * change_x, share_b * change_y, 0.0,
    )  # fmt: skip


def outside_central(spin_a: Any, spin_b: Any, eps: float = EPS) -> Any:
    """Status of motion that a point mass cannot have, 0 where there is none."""
    spins = (spin_a != 0.0) | (spin_b != 0.0)
    return OK if spins is False else verdict((spins, SPINNING))
