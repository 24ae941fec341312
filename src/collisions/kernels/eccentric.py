"""Eccentric impact: bodies that also turn, free, pinned to a point of the road, or fixed (eqs 10 to
19 of the paper).

Every body answers an impulse at the contact through K_i = a_i 1 + b_i q q^T, with q its lever
turned by +90 degrees. Barriers, pivots and free bodies differ only in a_i and b_i.
"""

from math import nan
from operator import add
from typing import Any

from .contact_laws import LAWS, RULES, dissipates, energetic_contact, energy_losses
from .elementwise import first_status, more_digits, safe_divisor, select, turning_velocity
from .status import EPS, Answer, Status


def response(
    mass: Any,
    inertia: Any,
    vx: Any,
    vy: Any,
    x: Any,
    y: Any,
    pivot_x: Any,
    pivot_y: Any,
    px: Any,
    py: Any,
    pinned: bool,
) -> tuple[Any, Any, Any, Any, Any, Any]:
    """The body's a and b, its lever (x, y), and the part of its velocity that is not spin.

    A pinned body turns about the pivot: its inertia is taken about it, it takes no share in a, and
    all its velocity is spin.
    """
    if pinned:
        arm_x = x - pivot_x
        arm_y = y - pivot_y
        return (
            0.0,
            1.0 / (inertia + mass * (arm_x * arm_x + arm_y * arm_y)),
            px - pivot_x,
            py - pivot_y,
            0.0,
            0.0,
        )
    return 1.0 / mass, 1.0 / inertia, px - x, py - y, vx, vy


def recoil(
    a: Any,
    b: Any,
    torque: Any,
    impulse_x: Any,
    impulse_y: Any,
    x: Any,
    y: Any,
    pivot_x: Any,
    pivot_y: Any,
    pinned: bool,
) -> tuple[Any, Any, Any]:
    """Change of velocity (x, y) and of yaw rate of a body under an impulse at the contact."""
    spin = b * torque
    if pinned:
        return *turning_velocity(spin, x, y, pivot_x, pivot_y), spin
    return a * impulse_x, a * impulse_y, spin


def moment_about(
    impulse: tuple[Any, ...], x: Any, y: Any, pivot_x: Any, pivot_y: Any, pinned: bool
) -> Any:
    """Moment of an impulse from outside, with components x, y, yaw at the centre of mass: about
    that, or about the pivot.
    """
    jx, jy, yaw = impulse
    return yaw + ((x - pivot_x) * jy - (y - pivot_y) * jx) if pinned else yaw


def eccentric(
    restitution: Any,
    nx: Any,
    ny: Any,
    tangential: Any,
    px: Any,
    py: Any,
    mass_a: Any,
    inertia_a: Any,
    vx_a: Any,
    vy_a: Any,
    spin_a: Any,
    x_a: Any,
    y_a: Any,
    pivot_x_a: Any,
    pivot_y_a: Any,
    mass_b: Any,
    inertia_b: Any,
    vx_b: Any,
    vy_b: Any,
    spin_b: Any,
    x_b: Any,
    y_b: Any,
    pivot_x_b: Any,
    pivot_y_b: Any,
    rule: str,
    law: str,
    pinned_a: bool,
    pinned_b: bool,
    eps: float = EPS,
    impulse_only: bool = False,
    *,
    contact_velocity: tuple[Any, Any] | None = None,
    outside: tuple[Any, ...] | None = None,
) -> Any:
    """The ``Answer`` of the eccentric model.

    ``contact_velocity`` is the closing speed and the slip before, known to more digits than the
    motions hold. It is used where it is that of the motions to their rounding. ``outside`` has
    impulses on A and then on B from other things than the contact (x, y, yaw at the centre of
    mass): they shift the velocities at the contact, which brings what is left to the separation.

    With ``impulse_only``: whether there is an answer, the closing speed, the impulse along n and t,
    that without slip, and of A and B a and b, the torque, and the torque of the impulse without
    slip.
    """
    a_a, b_a, rx_a, ry_a, ux_a, uy_a = response(
        mass_a, inertia_a, vx_a, vy_a, x_a, y_a, pivot_x_a, pivot_y_a, px, py, pinned_a
    )
    a_b, b_b, rx_b, ry_b, ux_b, uy_b = response(
        mass_b, inertia_b, vx_b, vy_b, x_b, y_b, pivot_x_b, pivot_y_b, px, py, pinned_b
    )
    # Contact velocity of A relative to B: differences first, then the spins, and into (n, t) last.
    ux = (ux_a - ux_b) + (spin_b * ry_b - spin_a * ry_a)
    uy = (uy_a - uy_b) + (spin_a * rx_a - spin_b * rx_b)
    closing = nx * ux + ny * uy
    slip = ny * ux - nx * uy
    if contact_velocity is not None:
        turning = abs(spin_a) * (abs(rx_a) + abs(ry_a)) + abs(spin_b) * (abs(rx_b) + abs(ry_b))
        speeds = abs(vx_a) + abs(vy_a) + abs(vx_b) + abs(vy_b) + turning
        closing, slip = more_digits(contact_velocity, closing, slip, speeds, eps)
    rn_a = nx * rx_a + ny * ry_a
    rt_a = nx * ry_a - ny * rx_a
    rn_b = nx * rx_b + ny * ry_b
    rt_b = nx * ry_b - ny * rx_b

    # K, its trace less a, and its determinant over that trace: sums of terms that are >= 0, so
    # nothing cancels.
    a = a_a + a_b
    brt_a = b_a * rt_a
    brt_b = b_b * rt_b
    k_nn = a + brt_a * rt_a + brt_b * rt_b
    k_nt = -(brt_a * rn_a + brt_b * rn_b)
    trace = a + b_a * (rx_a * rx_a + ry_a * ry_a) + b_b * (rx_b * rx_b + ry_b * ry_b)
    threshold = (64.0 * eps) * (64.0 * eps) * trace
    bounded = threshold - threshold == 0.0
    yields = (k_nn > threshold) & (trace > 0.0)
    immovable = bounded & (yields ^ True)
    k_nn = safe_divisor(yields, k_nn)
    trace = safe_divisor(yields, trace)
    cross = rx_a * ry_b - ry_a * rx_b
    determinant = a + ((b_a / trace) * cross) * (b_b * cross)
    regular = determinant > threshold

    # The impulse that leaves the slip of a sticking contact (0, or what the law leaves).
    sticking_slip = LAWS[law].sticking_slip(restitution)
    change_n = (1.0 + restitution) * closing
    change_t = 0.0 - (1.0 - sticking_slip) * slip
    # What is closing, the slip and the restitution when the contact acts.
    pushed, shifted, e = closing, slip, restitution
    on_a: tuple[Any, ...] = ()
    on_b: tuple[Any, ...] = ()
    if outside is not None:
        on_a = moment_about(outside[:3], x_a, y_a, pivot_x_a, pivot_y_a, pinned_a), *outside[:2]
        on_b = moment_about(outside[3:], x_b, y_b, pivot_x_b, pivot_y_b, pinned_b), *outside[3:5]
        turn_a, turn_b = b_a * on_a[0], b_b * on_b[0]
        push_x = (a_a * on_a[1] - a_b * on_b[1]) + (turn_b * ry_b - turn_a * ry_a)
        push_y = (a_a * on_a[2] - a_b * on_b[2]) + (turn_a * rx_a - turn_b * rx_b)
        push_n = nx * push_x + ny * push_y
        push_t = ny * push_x - nx * push_y
        pushed, shifted = closing + push_n, slip + push_t
        change_n, change_t = change_n + push_n, change_t - push_t
        # Only where there is a compression to give back from; elsewhere it is refused below.
        acts = (closing > 0.0) & (pushed > 0.0) & (change_n > 0.0)
        e = restitution * select(acts, closing / select(acts, pushed, 1.0), 1.0)
    q_a = b_a * (rn_a * change_n + rt_a * change_t)
    q_b = b_b * (rn_b * change_n + rt_b * change_t)
    no_slip_t_determinant = (a * change_t + q_a * rt_a + q_b * rt_b) / trace
    divided_by = select(regular, determinant, 1.0)
    no_slip_n = ((a * change_n + q_a * rn_a + q_b * rn_b) / trace) / divided_by
    no_slip_t = no_slip_t_determinant / divided_by

    energetic = LAWS[law].energetic
    if energetic:

        def respond(along_n: Any, along_t: Any) -> tuple[Any, Any]:
            turn_a = b_a * (rt_a * along_n - rn_a * along_t)
            turn_b = b_b * (rt_b * along_n - rn_b * along_t)
            return (
                a * along_n + rt_a * turn_a + rt_b * turn_b,
                a * along_t - rn_a * turn_a - rn_b * turn_b,
            )

        k_tt = respond(0.0, 1.0)[1]
        stuck_n = determinant * (trace / select(k_tt == 0.0, 1.0, k_tt))
        passage = energetic_contact(e, pushed, shifted, tangential, respond, stuck_n)
        normal, impulse_t, sticks = passage.normal, passage.tangential, passage.sticks
        needs_no_slip, pulls, jams = tangential > 0.0, normal <= 0.0, False
    else:
        sticks, ratio, needs_no_slip, pulls = RULES[rule].decide(tangential, no_slip_n, no_slip_t)
        resistance = a + brt_a * (rt_a - ratio * rn_a) + brt_b * (rt_b - ratio * rn_b)
        jams = (resistance <= 0.0) & (sticks ^ True)
        sliding_n = change_n / safe_divisor(resistance != 0.0, resistance)
        normal = select(sticks, no_slip_n, sliding_n)
        impulse_t = select(sticks, no_slip_t, ratio * sliding_n)
    torque_a = rt_a * normal - rn_a * impulse_t
    torque_b = rn_b * impulse_t - rt_b * normal
    stuck = bounded & (regular ^ True) & needs_no_slip
    closes = closing > 0.0
    apart = closing < 0.0
    if outside is not None:
        # Under an energetic law restitution gives back work of compression, of which there is none
        # if pushed <= 0.
        parts = (change_n <= 0.0) | (pushed <= 0.0) if energetic else change_n <= 0.0
        closes, apart = closes & (parts ^ True), apart | ((closing > 0.0) & parts)
    if impulse_only:
        bounded = bounded & (0.0 * normal + 0.0 * impulse_t == 0.0)
        answered = closes & bounded & ((immovable | stuck | pulls | jams) ^ True)
        for_a = a_a, b_a, torque_a, rt_a * no_slip_n - rn_a * no_slip_t
        for_b = a_b, b_b, torque_b, rn_b * no_slip_t - rt_b * no_slip_n
        return answered, closing, (normal, impulse_t), (no_slip_n, no_slip_t), for_a, for_b

    separation: Any = 0.0
    if energetic:
        separation, slip_after = passage.separation, passage.slip_after
        loss_n, loss_t, gains = passage.loss_n, passage.loss_t, False
        loss = loss_n + loss_t
        if outside is not None:
            # What the contact took, at the mean of the velocities before and after; the passage
            # began with those shifted.
            mean = separation / safe_divisor(closing != 0.0, closing)
            of_mean = mean, closing, slip, slip_after, sticks, 0.0, normal, impulse_t, None
            _, _, loss, gains = energy_losses(law, *of_mean, eps)
            loss_n = loss - loss_t
    else:
        beyond_sticking = select(
            sticks, 0.0, (determinant * impulse_t - no_slip_t_determinant) / (k_nn / trace)
        )
        slip_after = sticking_slip * slip + beyond_sticking
        impulse_work: Any = None
        if dissipates(rule, law) and outside is None:
            work_a, work_b = b_a * torque_a * torque_a, b_b * torque_b * torque_b
            impulse_work = a * (normal * normal + impulse_t * impulse_t) + work_a + work_b
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

    impulse_x = nx * normal - ny * impulse_t
    impulse_y = ny * normal + nx * impulse_t
    by_a: Any = torque_a, -impulse_x, -impulse_y
    by_b: Any = torque_b, impulse_x, impulse_y
    if outside is not None:
        by_a, by_b = tuple(map(add, by_a, on_a)), tuple(map(add, by_b, on_b))
    dvx_a, dvy_a, spin_change_a = recoil(
        a_a, b_a, by_a[0], by_a[1], by_a[2], x_a, y_a, pivot_x_a, pivot_y_a, pinned_a
    )
    dvx_b, dvy_b, spin_change_b = recoil(
        a_b, b_b, by_b[0], by_b[1], by_b[2], x_b, y_b, pivot_x_b, pivot_y_b, pinned_b
    )
    # 0.0 * value is 0 if finite, else NaN: adding the values themselves could overflow.
    total = loss + slip_after + dvx_a + dvy_a + spin_change_a + dvx_b + dvy_b + spin_change_b
    total = total + (0.0 * impulse_x + 0.0 * impulse_y + 0.0 * no_slip_n + 0.0 * no_slip_t)
    if LAWS[law].compression_limit:
        total = total + loss_n + loss_t
    if energetic:
        total = total + separation
    finite = bounded & (total - total == 0.0)
    fine = closes & finite & (loss >= 0.0) & ((immovable | stuck | pulls | jams) ^ True)
    status = select(
        fine,
        Status.OK,
        first_status(
            (immovable, Status.IMMOVABLE),
            (apart, Status.SEPARATING),
            (closing == 0.0, Status.GRAZING),
            (stuck, Status.SINGULAR_CONTACT),
            (pulls, Status.NO_SLIP_PULLS),
            (jams, Status.RATIO_JAMS),
            (finite ^ True, Status.OUT_OF_RANGE),
            (gains, Status.ENERGY_GAIN),
        ),
    )
    # A contact with one degree of freedom has no impulse without slip.
    no_slip_n = select(regular, no_slip_n, nan)
    return Answer(
        status=status,
        closing_speed=closing,
        slip_before=slip,
        slip_after=slip_after,
        normal_impulse=normal,
        tangential_impulse=impulse_t,
        compression_impulse=normal / (1.0 + restitution),
        no_slip_normal=no_slip_n,
        no_slip_tangential=no_slip_t,
        sticks=sticks,
        effective_mass=1.0 / k_nn,
        coupling=k_nt,
        energy_loss_normal=loss_n,
        energy_loss_tangential=loss_t,
        energy_loss=loss,
        impulse_x=impulse_x,
        impulse_y=impulse_y,
        delta_vx_a=dvx_a,
        delta_vy_a=dvy_a,
        delta_yaw_rate_a=spin_change_a,
        delta_vx_b=dvx_b,
        delta_vy_b=dvy_b,
        delta_yaw_rate_b=spin_change_b,
        separation_speed=separation,
    )


def from_contact_velocity(closing: Any, slip: Any, *inputs: Any) -> Any:
    """``eccentric`` with the closing speed and the slip before, which stand before its other
    inputs.
    """
    return eccentric(*inputs, contact_velocity=(closing, slip))


def with_outside(*inputs: Any) -> Any:
    """``eccentric`` with the impulses from outside on A and on B, which stand before its other
    inputs.
    """
    return eccentric(*inputs[6:], outside=inputs[:6])
