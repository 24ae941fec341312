"""Central impacts of two point masses: along one line (eqs 2 to 8 of the paper), and oblique, with
friction (eq 9).

Each model comes twice: one refuses motion that it cannot represent, and its approximation carries
that through unchanged.
"""

from math import inf
from typing import Any, NamedTuple

from .contact_laws import LAWS, RULES, Passage, dissipates, energy_losses
from .elementwise import all_zero, first_status, larger, more_digits, select
from .problem import Body, Contact, Problem
from .status import EPS, Answer, Status


class Shares(NamedTuple):
    """Share of A and of B in a change of the relative velocity, reduced mass, and whether both
    bodies are immovable.
    """

    a: Any
    b: Any
    mass: Any
    immovable: Any


class Struck(NamedTuple):
    """The impulse of an oblique impact, as changes of the relative velocity along n and t: each is
    its impulse over the reduced mass.

    ``no_slip_t`` is the change that a sticking contact needs.
    """

    shares: Shares
    closing: Any
    slip: Any
    change_n: Any
    change_t: Any
    no_slip_t: Any
    sticks: Any
    pulls: Any
    passage: Passage | None

    @property
    def impulse(self) -> tuple[Any, Any]:
        """Along n and t."""
        return self.shares.mass * self.change_n, self.shares.mass * self.change_t

    @property
    def answered(self) -> Any:
        """Whether there is an impulse; one that would have to pull among them."""
        normal, tangential = self.impulse
        work = self.closing * normal + self.slip * tangential
        return (self.closing > 0.0) & (work - work == 0.0) & (self.shares.immovable ^ True)


def shares(mass_a: Any, mass_b: Any) -> Shares:
    """How two masses share a change of their relative velocity (eq 2).

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
    return Shares(share_a, share_b, reduced, fixed_a & fixed_b)


def closing_and_slip(contact: Contact, a: Body, b: Body) -> tuple[Any, Any]:
    """Closing speed, and slip of B relative to A (eq 9)."""
    nx, ny = contact.normal
    # Velocities are subtracted before anything else, so that a common motion of both bodies costs
    # no digits.
    ux, uy = b.vx - a.vx, b.vy - a.vy
    return -(nx * ux + ny * uy), nx * uy - ny * ux


def beyond_line(contact: Contact, a: Body, b: Body, eps: float) -> tuple[Any, Any]:
    """Whether a body turns, and whether one moves across the normal."""
    nx, ny = contact.normal
    if all_zero(ny, a.vy, b.vy, a.yaw_rate, b.yaw_rate):
        return False, False
    # Most impacts are along x: compiled for floats, the first condition ends the look at what is
    # across.
    sideways = (ny != 0.0) | (a.vy != 0.0) | (b.vy != 0.0)
    # What rounding leaves of motions along the normal is below 8 eps of the speeds, also after an
    # impact has cancelled one.
    most = 8.0 * eps * (abs(nx * a.vx + ny * a.vy) + abs(nx * b.vx + ny * b.vy))
    across = larger(abs(nx * a.vy - ny * a.vx), abs(nx * b.vy - ny * b.vx)) > most
    return turning(a, b), sideways & across


def turning(a: Body, b: Body) -> Any:
    """Whether a body turns."""
    return (a.yaw_rate != 0.0) | (b.yaw_rate != 0.0)


def linear_central(problem: Problem, eps: float = EPS) -> Answer:
    """The ``Answer`` of the linear central model; what turns or moves across the normal is
    refused.
    """
    spins, across = beyond_line(problem.contact, problem.a, problem.b, eps)
    return _along_line(problem, eps, None, spins, across)


def linear_approximation(problem: Problem, eps: float = EPS) -> Answer:
    """The same, with what turns or moves across the normal carried through unchanged."""
    _, slip = closing_and_slip(problem.contact, problem.a, problem.b)
    return _along_line(problem, eps, slip, False, False)


def _along_line(problem: Problem, eps: float, slip: Any, spins: Any, across: Any) -> Answer:
    """The linear central impact (eqs 4 to 8), with the slip that is carried through."""
    contact, a, b = problem.contact, problem.a, problem.b
    restitution, (nx, ny) = contact.restitution, contact.normal
    share_a, share_b, mass, immovable = shares(a.mass, b.mass)
    closing, _ = closing_and_slip(contact, a, b)
    if problem.contact_velocity is not None:
        speeds = abs(a.vx) + abs(a.vy) + abs(b.vx) + abs(b.vy)
        known = problem.contact_velocity[0], 0.0
        closing, _ = more_digits(known, closing, 0.0, speeds, eps)
    change = (1.0 + restitution) * closing
    normal = mass * change
    loss = 0.5 * (1.0 - restitution) * (closing * normal)  # eq 8
    dvn_a, dvn_b = -(share_a * change), share_b * change  # eqs 5 and 6
    total = normal + loss + dvn_a + dvn_b
    if slip is None:
        slip = 0.0
    else:
        total = total + slip
    ok = (closing > 0.0) & (total - total == 0.0) & ((spins | across) ^ True)
    status = select(
        ok,
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
        compression_impulse=mass * closing,
        no_slip_normal=normal,
        effective_mass=mass,
        energy_loss_normal=loss,
        energy_loss=loss,
        impulse_x=nx * normal,
        impulse_y=ny * normal,
        delta_vx_a=nx * dvn_a,
        delta_vy_a=ny * dvn_a,
        delta_vx_b=nx * dvn_b,
        delta_vy_b=ny * dvn_b,
    )


def strike(problem: Problem, rule: str, law: str) -> Struck:
    """The impulse of an oblique central impact (eq 9): the masses divide the change of relative
    velocity.
    """
    restitution, value = problem.contact.restitution, problem.contact.rule_value
    closing, slip = closing_and_slip(problem.contact, problem.a, problem.b)
    change_n = (1.0 + restitution) * closing
    no_slip_t = 0.0 - (1.0 - LAWS[law].sticking_slip(restitution)) * slip
    passage, follow = None, LAWS[law].passage
    if follow is not None:
        passage = follow(restitution, closing, slip, value, _own_change, 1.0)
        change_n, change_t, sticks = passage.normal, passage.tangential, passage.sticks
        pulls = passage.normal <= 0.0
    else:
        sticks, ratio, _, pulls = RULES[rule].decide(value, change_n, no_slip_t)
        change_t = select(sticks, no_slip_t, ratio * change_n)
    of_masses = shares(problem.a.mass, problem.b.mass)
    return Struck(of_masses, closing, slip, change_n, change_t, no_slip_t, sticks, pulls, passage)


def _own_change(along_n: Any, along_t: Any) -> tuple[Any, Any]:
    """Without levers, a change of velocity changes nothing but itself."""
    return along_n, along_t


def oblique_central(problem: Problem, rule: str, law: str, eps: float = EPS) -> Answer:
    """The ``Answer`` of the oblique central model; a body that turns is refused."""
    return _oblique(problem, rule, law, eps, turning(problem.a, problem.b))


def oblique_approximation(problem: Problem, rule: str, law: str, eps: float = EPS) -> Answer:
    """The same, with yaw rates carried through unchanged."""
    return _oblique(problem, rule, law, eps, False)


def _oblique(problem: Problem, rule: str, law: str, eps: float, spins: Any) -> Answer:
    struck = strike(problem, rule, law)
    share_a, share_b, mass, immovable = struck.shares
    closing, slip, (normal, tangential) = struck.closing, struck.slip, struck.impulse
    change_n, change_t = struck.change_n, struck.change_t
    separation: Any = 0.0
    if struck.passage is not None:
        separation, slip_after, gains = struck.passage.separation, struck.passage.slip_after, False
        loss_n, loss_t = mass * struck.passage.loss_n, mass * struck.passage.loss_t
        loss = loss_n + loss_t
    else:
        restitution = problem.contact.restitution
        beyond_sticking = change_t - struck.no_slip_t
        slip_after = LAWS[law].sticking_slip(restitution) * slip + beyond_sticking
        work = normal * change_n + tangential * change_t if dissipates(rule, law) else None
        loss_n, loss_t, loss, gains = energy_losses(
            law,
            restitution,
            closing,
            slip,
            slip_after,
            struck.sticks,
            beyond_sticking,
            normal,
            tangential,
            work,
            eps,
        )

    nx, ny = problem.contact.normal
    change_x, change_y = nx * change_n - ny * change_t, ny * change_n + nx * change_t
    impulse_x, impulse_y = mass * change_x, mass * change_y
    no_slip_impulse = mass * struck.no_slip_t
    total = normal + tangential + loss + loss_n + loss_t + slip_after + change_x + change_y
    # 0.0 * value is 0 if finite, else NaN: adding the values themselves could overflow.
    total = total + (0.0 * impulse_x + 0.0 * impulse_y + 0.0 * no_slip_impulse)
    if struck.passage is not None:
        total = total + separation
    ok = (closing > 0.0) & (total - total == 0.0) & ((gains | struck.pulls | spins) ^ True)
    status = select(
        ok,
        Status.OK,
        first_status(
            (spins, Status.SPINNING),
            (immovable, Status.IMMOVABLE),
            (closing < 0.0, Status.SEPARATING),
            (closing == 0.0, Status.GRAZING),
            (struck.pulls, Status.NO_SLIP_PULLS),
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
        tangential_impulse=tangential,
        compression_impulse=mass * closing,
        no_slip_normal=normal,
        no_slip_tangential=no_slip_impulse,
        sticks=struck.sticks,
        effective_mass=mass,
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
