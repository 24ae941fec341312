"""Oblique central impact: two point masses, impulse along the normal and, with friction, the tangent (eq 9 of the paper)."""

from typing import Any

from .contact_laws import LAWS, RULES, dissipates, energy_losses
from .elementwise import first_status, select
from .linear import shares
from .status import EPS, Answer, Status


def oblique_central(
    restitution: Any,
    nx: Any,
    ny: Any,
    tangential: Any,
    mass_a: Any,
    vx_a: Any,
    vy_a: Any,
    spin_a: Any,
    mass_b: Any,
    vx_b: Any,
    vy_b: Any,
    spin_b: Any,
    rule: str,
    law: str,
    carrying: bool = False,
    eps: float = EPS,
    impulse_only: bool = False,
) -> Any:
    """The ``Answer`` of the oblique central model: the masses divide the change of relative velocity (along n and t).

    A body that turns is refused, or, if ``carrying``, its yaw rate is carried through unchanged.
    With ``impulse_only``: whether there is an answer, whether no slip would need a pull, and the impulse along n and t.
    """
    share_a, share_b, effective_mass, immovable = shares(mass_a, mass_b)
    ux = vx_b - vx_a
    uy = vy_b - vy_a
    closing = -(nx * ux + ny * uy)
    slip = nx * uy - ny * ux
    kept = LAWS[law].sticking_slip(restitution)
    change_n = (1.0 + restitution) * closing
    no_slip_t = 0.0 - (1.0 - kept) * slip
    sticks, ratio, _, pulls = RULES[rule].decide(tangential, change_n, no_slip_t)
    change_t = select(sticks, no_slip_t, ratio * change_n)
    normal = effective_mass * change_n
    impulse_t = effective_mass * change_t
    if impulse_only:
        work = closing * normal + slip * impulse_t
        return (closing > 0.0) & (work - work == 0.0) & (immovable ^ True), pulls, normal, impulse_t

    beyond_sticking = change_t - no_slip_t
    slip_after = kept * slip + beyond_sticking
    # At rest after sticking, so that the sum is the slip before, to the bit.
    slip_sum = select(sticks, (1.0 + kept) * slip, slip + slip_after) if LAWS[law].compression_limit else slip + slip_after
    mobility = normal * change_n + impulse_t * change_t if dissipates(rule, law) else 0.0
    loss_n, loss_t, loss, gains = energy_losses(
        restitution, closing, slip, slip_after, slip_sum, beyond_sticking, normal, impulse_t, mobility, rule, law, eps
    )

    change_x = nx * change_n - ny * change_t
    change_y = ny * change_n + nx * change_t
    impulse_x = effective_mass * change_x
    impulse_y = effective_mass * change_y
    no_slip_impulse = effective_mass * no_slip_t
    total = normal + impulse_t + loss + loss_n + loss_t + slip_after + change_x + change_y
    # Zeros of what is finite, so that these cannot overflow in the sum.
    total = total + (0.0 * impulse_x + 0.0 * impulse_y + 0.0 * no_slip_impulse)
    spins: Any = False if carrying else (spin_a != 0.0) | (spin_b != 0.0)
    fine = (closing > 0.0) & (total - total == 0.0) & ((gains | pulls | spins) ^ True)
    status = (
        Status.OK
        if fine is True
        else select(
            fine,
            Status.OK,
            first_status(
                (spins, Status.SPINNING),
                (immovable, Status.IMMOVABLE),
                (closing < 0.0, Status.SEPARATING),
                (closing == 0.0, Status.GRAZING),
                (pulls, Status.NO_SLIP_PULLS),
                (total - total != 0.0, Status.OUT_OF_RANGE),
                (gains, Status.ENERGY_GAIN),
            ),
        )
    )
    return Answer(
        status=status,
        closing_speed=closing,
        slip_before=slip,
        slip_after=slip_after,
        normal_impulse=normal,
        tangential_impulse=impulse_t,
        compression_impulse=effective_mass * closing,
        no_slip_normal=normal,
        no_slip_tangential=no_slip_impulse,
        sticks=sticks,
        effective_mass=effective_mass,
        energy_loss_normal=loss_n,
        energy_loss_tangential=loss_t,
        energy_loss=loss,
        impulse_x=impulse_x,
        impulse_y=impulse_y,
        delta_vx_a=-(share_a * change_x),
        delta_vy_a=-(share_a * change_y),
        delta_vx_b=share_b * change_x,
        delta_vy_b=share_b * change_y,
    )
