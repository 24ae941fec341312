"""Central impacts of two point masses: along one line (eqs 2 to 8 of the paper), and oblique, with
friction (eq 9).
"""

from math import inf
from typing import Any

from .contact_laws import LAWS, RULES, dissipates, energetic_contact, energy_losses
from .elementwise import all_zero, first_status, larger, more_digits, select
from .status import EPS, Answer, Status


def shares(mass_a: Any, mass_b: Any) -> tuple[Any, Any, Any, Any]:
    """Share of A, share of B, reduced mass, and whether both bodies are immovable.

    Built on ratios of the masses, which are 0 or infinite against a barrier: no sum or product of
    masses overflows, and no infinity meets another. The reduced mass is the lighter mass times its
    own share.
    """
    fixed_a, fixed_b = mass_a == inf, mass_b == inf
    # An infinite ratio is chosen, not divided: its derivative would be infinite, and NaN times the
    # 0 of its share.
    share_a = 1.0 / (1.0 + select(fixed_a, inf, select(fixed_a, 1.0, mass_a) / mass_b))
    share_b = 1.0 / (1.0 + select(fixed_b, inf, select(fixed_b, 1.0, mass_b) / mass_a))
    lighter = mass_a <= mass_b
    reduced = select(lighter, mass_a, mass_b) * select(lighter, share_a, share_b)
    return share_a, share_b, reduced, fixed_a & fixed_b


def linear_central(
    restitution: Any,
    nx: Any,
    ny: Any,
    mass_a: Any,
    vx_a: Any,
    vy_a: Any,
    spin_a: Any,
    mass_b: Any,
    vx_b: Any,
    vy_b: Any,
    spin_b: Any,
    carrying: bool = False,
    eps: float = EPS,
    *,
    contact_velocity: tuple[Any, Any] | None = None,
) -> Answer:
    """The ``Answer`` of the linear central model.

    What turns or moves across the normal is refused, or, if ``carrying``, carried through
    unchanged. ``contact_velocity`` is as for ``eccentric``, without slip.
    """
    share_a, share_b, effective_mass, immovable = shares(mass_a, mass_b)
    # Velocities are subtracted before anything else, so that a common motion of both bodies costs
    # no digits.
    ux = vx_b - vx_a
    uy = vy_b - vy_a
    closing = -(nx * ux + ny * uy)
    if contact_velocity is not None:
        speeds = abs(vx_a) + abs(vy_a) + abs(vx_b) + abs(vy_b)
        closing, _ = more_digits(contact_velocity, closing, 0.0, speeds, eps)
    change = (1.0 + restitution) * closing
    compression = effective_mass * closing
    normal = effective_mass * change
    loss = 0.5 * (1.0 - restitution) * (closing * normal)
    dvn_a = -(share_a * change)
    dvn_b = share_b * change
    total = normal + loss + dvn_a + dvn_b
    slip: Any = 0.0
    spins: Any = False
    across: Any = False
    if carrying:
        slip = nx * uy - ny * ux
        total = total + slip
    elif not all_zero(ny, vy_a, vy_b, spin_a, spin_b):
        spins = (spin_a != 0.0) | (spin_b != 0.0)
        # Most impacts are along x: compiled for floats, the first condition ends the look at what
        # is across.
        sideways = (ny != 0.0) | (vy_a != 0.0) | (vy_b != 0.0)
        # What rounding leaves of motions along the normal is below 8 eps of the speeds, also after
        # an impact has cancelled one.
        most = 8.0 * eps * (abs(nx * vx_a + ny * vy_a) + abs(nx * vx_b + ny * vy_b))
        across = sideways & (larger(abs(nx * vy_a - ny * vx_a), abs(nx * vy_b - ny * vx_b)) > most)
    fine = (closing > 0.0) & (total - total == 0.0) & ((spins | across) ^ True)
    status = select(
        fine,
        Status.OK,
        first_status(
            (spins, Status.SPINNING),
            (across, Status.TRANSVERSE),
            (immovable, Status.IMMOVABLE),
            (closing < 0.0, Status.SEPARATING),
            (closing == 0.0, Status.GRAZING),
            (total - total != 0.0, Status.OUT_OF_RANGE),
        ),
    )
    return Answer(
        status=status,
        closing_speed=closing,
        slip_before=slip,
        slip_after=slip,
        normal_impulse=normal,
        compression_impulse=compression,
        no_slip_normal=normal,
        effective_mass=effective_mass,
        energy_loss_normal=loss,
        energy_loss=loss,
        impulse_x=nx * normal,
        impulse_y=ny * normal,
        delta_vx_a=nx * dvn_a,
        delta_vy_a=ny * dvn_a,
        delta_vx_b=nx * dvn_b,
        delta_vy_b=ny * dvn_b,
    )


def from_closing_speed(closing: Any, *inputs: Any) -> Answer:
    """``linear_central`` with the closing speed before its other inputs."""
    return linear_central(*inputs, contact_velocity=(closing, 0.0))


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
    """The ``Answer`` of the oblique central model: the masses divide the change of relative
    velocity (along n and t).

    A body that turns is refused, or, if ``carrying``, its yaw rate is carried through unchanged.
    With ``impulse_only``: whether there is an answer, whether no slip would need a pull, and the
    impulse along n and t.
    """
    share_a, share_b, effective_mass, immovable = shares(mass_a, mass_b)
    ux = vx_b - vx_a
    uy = vy_b - vy_a
    closing = -(nx * ux + ny * uy)
    slip = nx * uy - ny * ux
    sticking_slip = LAWS[law].sticking_slip(restitution)
    change_n = (1.0 + restitution) * closing
    no_slip_t = 0.0 - (1.0 - sticking_slip) * slip
    energetic = LAWS[law].energetic
    if energetic:
        # In changes of velocity, each of which is its impulse over the effective mass.
        passage = energetic_contact(
            restitution, closing, slip, tangential, lambda along_n, along_t: (along_n, along_t), 1.0
        )
        change_n, change_t, sticks, pulls = (
            passage.normal,
            passage.tangential,
            passage.sticks,
            passage.normal <= 0.0,
        )
    else:
        sticks, ratio, _, pulls = RULES[rule].decide(tangential, change_n, no_slip_t)
        change_t = select(sticks, no_slip_t, ratio * change_n)
    normal = effective_mass * change_n
    impulse_t = effective_mass * change_t
    if impulse_only:
        work = closing * normal + slip * impulse_t
        return (closing > 0.0) & (work - work == 0.0) & (immovable ^ True), pulls, normal, impulse_t

    separation: Any = 0.0
    if energetic:
        separation, slip_after, gains = passage.separation, passage.slip_after, False
        loss_n, loss_t = effective_mass * passage.loss_n, effective_mass * passage.loss_t
        loss = loss_n + loss_t
    else:
        beyond_sticking = change_t - no_slip_t
        slip_after = sticking_slip * slip + beyond_sticking
        impulse_work = normal * change_n + impulse_t * change_t if dissipates(rule, law) else None
        loss_n, loss_t, loss, gains = energy_losses(
            law,
            restitution,
            closing,
            slip,
            slip_after,
            sticks,
            beyond_sticking,
            normal,
            impulse_t,
            impulse_work,
            eps,
        )

    change_x = nx * change_n - ny * change_t
    change_y = ny * change_n + nx * change_t
    impulse_x = effective_mass * change_x
    impulse_y = effective_mass * change_y
    no_slip_impulse = effective_mass * no_slip_t
    total = normal + impulse_t + loss + loss_n + loss_t + slip_after + change_x + change_y
    # 0.0 * value is 0 if finite, else NaN: adding the values themselves could overflow.
    total = total + (0.0 * impulse_x + 0.0 * impulse_y + 0.0 * no_slip_impulse)
    if energetic:
        total = total + separation
    spins: Any = False if carrying else (spin_a != 0.0) | (spin_b != 0.0)
    fine = (closing > 0.0) & (total - total == 0.0) & ((gains | pulls | spins) ^ True)
    status = select(
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
        separation_speed=separation,
    )
