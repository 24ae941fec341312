"""Eccentric impact: bodies that also turn, free, pinned to a point of the road, or fixed (eqs 10 to
19 of the paper).

Every body answers an impulse at the contact through K_i = a_i 1 + b_i q q^T, with q its lever
turned by +90 degrees. Barriers, pivots and free bodies differ only in a_i and b_i.
"""

from functools import partial
from math import nan
from operator import add
from typing import Any, NamedTuple

from .contact_laws import LAWS, RULES, Passage, dissipates, energy_losses
from .elementwise import first_status, more_digits, safe_divisor, select, turning_velocity
from .problem import Body, Contact, Problem
from .status import EPS, Answer, Status


class Response(NamedTuple):
    """How a body answers an impulse at the contact: a_i, b_i, and its lever along x, y, n and t."""

    per_mass: Any
    per_inertia: Any
    rx: Any
    ry: Any
    rn: Any
    rt: Any


class Mobility(NamedTuple):
    """K = K_A + K_B: by how much an impulse changes the contact velocity.

    ``per_mass`` is the part without turning, ``trace`` that of K less ``per_mass``, and
    ``determinant`` that of K over ``trace``. ``bounded`` says that these are numbers, ``immovable``
    that nothing can yield along the normal, ``regular`` that K has an inverse.
    """

    per_mass: Any
    k_nn: Any
    k_nt: Any
    trace: Any
    determinant: Any
    bounded: Any
    immovable: Any
    regular: Any


class Approach(NamedTuple):
    """Closing speed, slip and restitution when the contact acts, and the changes that an impulse
    has to bring so that the contact sticks.

    ``push_n`` is what impulses from outside add to the closing speed; ``acts`` is False where they
    part the bodies before.
    """

    closing: Any
    slip: Any
    restitution: Any
    change_n: Any
    change_t: Any
    push_n: Any = 0.0
    acts: Any = True


class Struck(NamedTuple):
    """The impulse at the contact and what led to it, before energies and motions.

    ``without_slip`` is the impulse that a sticking contact needs, and ``no_slip_t_determinant`` its
    tangential part times the determinant.
    """

    responses: tuple[Response, Response]
    mobility: Mobility
    closing: Any
    slip: Any
    impulse: tuple[Any, Any]
    torques: tuple[Any, Any]
    without_slip: tuple[Any, Any]
    no_slip_t_determinant: Any
    sticks: Any
    singular: Any
    pulls: Any
    jams: Any
    push_n: Any
    acts: Any
    passage: Passage | None
    pushes: tuple[tuple[Any, Any, Any], ...] | None

    @property
    def answered(self) -> Any:
        """Whether the impulse is a finite number that a contact can have."""
        normal, tangential = self.impulse
        finite = self.mobility.bounded & (0.0 * normal + 0.0 * tangential == 0.0)
        refused = self.mobility.immovable | self.singular | self.pulls | self.jams
        return (self.closing > 0.0) & self.acts & finite & (refused ^ True)


def response(body: Body, contact: Contact) -> Response:
    """How the body answers an impulse at the contact.

    A pinned body turns about the pivot: its inertia is taken about it (Steiner), and it takes no
    share in a.
    """
    (nx, ny), (px, py) = contact.normal, contact.point
    if body.pivot is None:
        per_mass, inertia, rx, ry = 1.0 / body.mass, body.yaw_inertia, px - body.x, py - body.y
    else:
        arm_x, arm_y = body.x - body.pivot[0], body.y - body.pivot[1]
        per_mass = 0.0
        inertia = body.yaw_inertia + body.mass * (arm_x * arm_x + arm_y * arm_y)
        rx, ry = px - body.pivot[0], py - body.pivot[1]
    return Response(per_mass, 1.0 / inertia, rx, ry, nx * rx + ny * ry, nx * ry - ny * rx)


def without_spin(body: Body) -> tuple[Any, Any]:
    """The part of the velocity that is not spin; a pinned body has none."""
    return (body.vx, body.vy) if body.pivot is None else (0.0, 0.0)


def closing_and_slip(problem: Problem, a: Response, b: Response, eps: float) -> tuple[Any, Any]:
    """Velocity at the contact before, along n (eq 11) and t."""
    nx, ny = problem.contact.normal
    (ux_a, uy_a), (ux_b, uy_b) = without_spin(problem.a), without_spin(problem.b)
    spin_a, spin_b = problem.a.yaw_rate, problem.b.yaw_rate
    # Of A relative to B: differences first, then the spins, and into (n, t) last.
    ux = (ux_a - ux_b) + (spin_b * b.ry - spin_a * a.ry)
    uy = (uy_a - uy_b) + (spin_a * a.rx - spin_b * b.rx)
    closing, slip = nx * ux + ny * uy, ny * ux - nx * uy
    if problem.contact_velocity is None:
        return closing, slip
    turning = abs(spin_a) * (abs(a.rx) + abs(a.ry)) + abs(spin_b) * (abs(b.rx) + abs(b.ry))
    speeds = abs(problem.a.vx) + abs(problem.a.vy) + abs(problem.b.vx) + abs(problem.b.vy) + turning
    return more_digits(problem.contact_velocity, closing, slip, speeds, eps)


def mobility(a: Response, b: Response, eps: float) -> Mobility:
    """K in (n, t), from linear and angular momentum at the contact (eqs 12 to 15)."""
    a_a, b_a, rx_a, ry_a, rn_a, rt_a = a
    a_b, b_b, rx_b, ry_b, rn_b, rt_b = b
    per_mass = a_a + a_b
    brt_a, brt_b = b_a * rt_a, b_b * rt_b
    # K_nn, the trace and the determinant are sums of terms that are >= 0, so nothing cancels.
    k_nn = per_mass + brt_a * rt_a + brt_b * rt_b
    k_nt = -(brt_a * rn_a + brt_b * rn_b)
    trace = per_mass + b_a * (rx_a * rx_a + ry_a * ry_a) + b_b * (rx_b * rx_b + ry_b * ry_b)
    # K is made of squares of levers, which are known to some eps.
    threshold = (64.0 * eps) * (64.0 * eps) * trace
    bounded = threshold - threshold == 0.0
    yields = (k_nn > threshold) & (trace > 0.0)
    k_nn, trace = safe_divisor(yields, k_nn), safe_divisor(yields, trace)
    cross = rx_a * ry_b - ry_a * rx_b
    determinant = per_mass + ((b_a / trace) * cross) * (b_b * cross)
    immovable, regular = bounded & (yields ^ True), determinant > threshold
    return Mobility(per_mass, k_nn, k_nt, trace, determinant, bounded, immovable, regular)


def change_by(a: Response, b: Response, along_n: Any, along_t: Any) -> tuple[Any, Any]:
    """K times an impulse: the change of the contact velocity along n and t."""
    per_mass = a.per_mass + b.per_mass
    turn_a = a.per_inertia * (a.rt * along_n - a.rn * along_t)
    turn_b = b.per_inertia * (b.rt * along_n - b.rn * along_t)
    return (
        per_mass * along_n + a.rt * turn_a + b.rt * turn_b,
        per_mass * along_t - a.rn * turn_a - b.rn * turn_b,
    )


def push(body: Body, outside: tuple[Any, ...]) -> tuple[Any, Any, Any]:
    """An impulse from outside as moment, x and y: about the pivot of a pinned body."""
    x, y, yaw = outside
    if body.pivot is not None:
        yaw = yaw + ((body.x - body.pivot[0]) * y - (body.y - body.pivot[1]) * x)
    return yaw, x, y


def approach(
    contact: Contact,
    law: str,
    a: Response,
    b: Response,
    pushes: tuple[tuple[Any, Any, Any], ...] | None,
    closing: Any,
    slip: Any,
) -> Approach:
    """What the contact has to do, after what comes from outside.

    Restitution ends the contact at e times the closing speed before (eqs 10 and 11); impulses from
    outside shift the contact velocity, and the contact brings what is left.
    """
    restitution = contact.restitution
    change_n = (1.0 + restitution) * closing
    change_t = 0.0 - (1.0 - LAWS[law].sticking_slip(restitution)) * slip
    if pushes is None:
        return Approach(closing, slip, restitution, change_n, change_t)
    nx, ny = contact.normal
    on_a, on_b = pushes
    turn_a, turn_b = a.per_inertia * on_a[0], b.per_inertia * on_b[0]
    push_x = (a.per_mass * on_a[1] - b.per_mass * on_b[1]) + (turn_b * b.ry - turn_a * a.ry)
    push_y = (a.per_mass * on_a[2] - b.per_mass * on_b[2]) + (turn_a * a.rx - turn_b * b.rx)
    push_n, push_t = nx * push_x + ny * push_y, ny * push_x - nx * push_y
    pushed, shifted = closing + push_n, slip + push_t
    change_n, change_t = change_n + push_n, change_t - push_t
    # Only where there is a compression to give back from; elsewhere it is refused.
    compresses = (closing > 0.0) & (pushed > 0.0) & (change_n > 0.0)
    e = restitution * select(compresses, closing / select(compresses, pushed, 1.0), 1.0)
    # A law that follows the contact begins with a compression, of which there is none if
    # pushed <= 0.
    follows = LAWS[law].passage is not None
    parts = (change_n <= 0.0) | (pushed <= 0.0) if follows else change_n <= 0.0
    return Approach(pushed, shifted, e, change_n, change_t, push_n, parts ^ True)


def strike(problem: Problem, rule: str, law: str, eps: float) -> Struck:
    """The impulse at the contact."""
    contact, pushes = problem.contact, None
    if problem.outside is not None:
        pushes = push(problem.a, problem.outside[0]), push(problem.b, problem.outside[1])
    a, b = response(problem.a, contact), response(problem.b, contact)
    closing, slip = closing_and_slip(problem, a, b, eps)
    k = mobility(a, b, eps)
    now = approach(contact, law, a, b, pushes, closing, slip)

    # K^-1 times the change: what a sticking contact needs.
    _, b_a, _, _, rn_a, rt_a = a
    _, b_b, _, _, rn_b, rt_b = b
    per_mass, change_n, change_t = k.per_mass, now.change_n, now.change_t
    q_a = b_a * (rn_a * change_n + rt_a * change_t)
    q_b = b_b * (rn_b * change_n + rt_b * change_t)
    no_slip_t_determinant = (per_mass * change_t + q_a * rt_a + q_b * rt_b) / k.trace
    divided_by = select(k.regular, k.determinant, 1.0)
    no_slip_n = ((per_mass * change_n + q_a * rn_a + q_b * rn_b) / k.trace) / divided_by
    no_slip_t = no_slip_t_determinant / divided_by

    value, follow = contact.rule_value, LAWS[law].passage
    passage: Passage | None = None
    jams: Any = False
    if follow is not None:
        respond = partial(change_by, a, b)
        k_tt = respond(0.0, 1.0)[1]
        stuck_n = k.determinant * (k.trace / select(k_tt == 0.0, 1.0, k_tt))
        passage = follow(now.restitution, now.closing, now.slip, value, respond, stuck_n)
        impulse, sticks = (passage.normal, passage.tangential), passage.sticks
        needs_no_slip, pulls = value > 0.0, passage.normal <= 0.0
    else:
        sticks, ratio, needs_no_slip, pulls = RULES[rule].decide(value, no_slip_n, no_slip_t)
        along_a, along_b = rt_a - ratio * rn_a, rt_b - ratio * rn_b
        resistance = per_mass + b_a * rt_a * along_a + b_b * rt_b * along_b
        jams = (resistance <= 0.0) & (sticks ^ True)
        # NaN where a ratio is so great that the resistance overflows: no impulse of 0 then.
        sliding_n = change_n / safe_divisor(resistance != 0.0, resistance) + 0.0 * resistance
        impulse = select(sticks, no_slip_n, sliding_n), select(sticks, no_slip_t, ratio * sliding_n)
    singular = k.bounded & (k.regular ^ True) & needs_no_slip
    return Struck(
        (a, b),
        k,
        closing,
        slip,
        impulse,
        torques(a, b, *impulse),
        (no_slip_n, no_slip_t),
        no_slip_t_determinant,
        sticks,
        singular,
        pulls,
        jams,
        now.push_n,
        now.acts,
        passage,
        pushes,
    )


def torques(a: Response, b: Response, normal: Any, tangential: Any) -> tuple[Any, Any]:
    """Moments of the impulse on A and on B about what they turn about (eqs 13 and 15)."""
    return a.rt * normal - a.rn * tangential, b.rn * tangential - b.rt * normal


def recoil(body: Body, answer: Response, torque: Any, x: Any, y: Any) -> tuple[Any, Any, Any]:
    """Change of velocity (x, y) and of yaw rate of a body under an impulse (eqs 12 to 15)."""
    spin = answer.per_inertia * torque
    if body.pivot is not None:
        return *turning_velocity(spin, body.x, body.y, *body.pivot), spin
    return answer.per_mass * x, answer.per_mass * y, spin


def slip_and_losses(
    problem: Problem, rule: str, law: str, struck: Struck, eps: float
) -> tuple[Any, Any, Any, Any, Any, Any]:
    """Separation speed of a law that has its own, slip after, and the losses as ``energy_losses``
    has them (eq 8).
    """
    restitution, alone = problem.contact.restitution, problem.outside is None
    closing, slip, (normal, tangential) = struck.closing, struck.slip, struck.impulse
    passage, k = struck.passage, struck.mobility
    if passage is not None and alone:
        loss_n, loss_t = passage.loss_n, passage.loss_t
        return passage.separation, passage.slip_after, loss_n, loss_t, loss_n + loss_t, False
    if passage is not None:
        # What the contact took, at the mean of the velocities before and after. The passage began
        # with those shifted, so along the normal it counts half of the shift too much.
        mean = passage.separation / safe_divisor(closing != 0.0, closing)
        of_mean = mean, closing, slip, passage.slip_after, struck.sticks, 0.0, normal, tangential
        _, _, loss, gains = energy_losses(law, *of_mean, None, eps, passage.separation)
        along_n = passage.loss_n - 0.5 * (struck.push_n * normal)
        # Without friction it is all there is, and the sum has more digits.
        loss_n = select(tangential == 0.0, loss, along_n)
        return passage.separation, passage.slip_after, loss_n, loss - loss_n, loss, gains
    beyond_sticking = select(
        struck.sticks,
        0.0,
        (k.determinant * tangential - struck.no_slip_t_determinant) / (k.k_nn / k.trace),
    )
    slip_after = LAWS[law].sticking_slip(restitution) * slip + beyond_sticking
    impulse_work: Any = None
    if dissipates(rule, law) and alone:
        torque_a, torque_b = struck.torques
        a, b = struck.responses
        work_a = a.per_inertia * torque_a * torque_a
        work_b = b.per_inertia * torque_b * torque_b
        square = normal * normal + tangential * tangential
        impulse_work = k.per_mass * square + work_a + work_b
    losses = energy_losses(
        law,
        restitution,
        closing,
        slip,
        slip_after,
        struck.sticks,
        beyond_sticking,
        normal,
        tangential,
        impulse_work,
        eps,
    )
    return 0.0, slip_after, *losses


def eccentric(problem: Problem, rule: str, law: str, eps: float = EPS) -> Answer:
    """The ``Answer`` of the eccentric model."""
    struck = strike(problem, rule, law, eps)
    k, closing, (normal, tangential) = struck.mobility, struck.closing, struck.impulse
    no_slip_n, no_slip_t = struck.without_slip
    separation, slip_after, loss_n, loss_t, loss, gains = slip_and_losses(
        problem, rule, law, struck, eps
    )

    nx, ny = problem.contact.normal
    torque_a, torque_b = struck.torques
    impulse_x, impulse_y = nx * normal - ny * tangential, ny * normal + nx * tangential
    by_a: Any = torque_a, -impulse_x, -impulse_y
    by_b: Any = torque_b, impulse_x, impulse_y
    if struck.pushes is not None:
        by_a = tuple(map(add, by_a, struck.pushes[0]))
        by_b = tuple(map(add, by_b, struck.pushes[1]))
    dvx_a, dvy_a, spin_change_a = recoil(problem.a, struck.responses[0], *by_a)
    dvx_b, dvy_b, spin_change_b = recoil(problem.b, struck.responses[1], *by_b)

    # 0.0 * value is 0 if finite, else NaN: adding the values themselves could overflow.
    total = loss + slip_after + dvx_a + dvy_a + spin_change_a + dvx_b + dvy_b + spin_change_b
    total = total + (0.0 * impulse_x + 0.0 * impulse_y + 0.0 * no_slip_n + 0.0 * no_slip_t)
    if LAWS[law].compression_limit:
        total = total + loss_n + loss_t
    if struck.passage is not None:
        total = total + separation
    finite = k.bounded & (total - total == 0.0)
    refused = k.immovable | struck.singular | struck.pulls | struck.jams
    closes, apart = closing > 0.0, closing < 0.0
    if struck.pushes is not None:
        apart = apart | (closes & (struck.acts ^ True))
        closes = closes & struck.acts
    status = select(
        closes & finite & (loss >= 0.0) & (refused ^ True),
        Status.OK,
        first_status(
            (k.immovable, Status.IMMOVABLE),
            (apart, Status.SEPARATING),
            (closing == 0.0, Status.GRAZING),
            (struck.singular, Status.SINGULAR_CONTACT),
            (struck.pulls, Status.NO_SLIP_PULLS),
            (struck.jams, Status.RATIO_JAMS),
            (finite ^ True, Status.OUT_OF_RANGE),
            (gains, Status.ENERGY_GAIN),
        ),
    )
    return Answer(
        status=status,
        closing_speed=closing,
        slip_before=struck.slip,
        slip_after=slip_after,
        normal_impulse=normal,
        tangential_impulse=tangential,
        compression_impulse=normal / (1.0 + problem.contact.restitution),
        # A contact with one degree of freedom has no impulse without slip.
        no_slip_normal=select(k.regular, no_slip_n, nan),
        no_slip_tangential=no_slip_t,
        sticks=struck.sticks,
        effective_mass=1.0 / k.k_nn,
        coupling=k.k_nt,
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
