"""One step of a contact that takes time: force over penetration, friction, tyres, and bodies that
move and turn meanwhile.

Each step pushes the bodies by the impulses of the contact; between two pushes they drift, and in
the middle of that the tyres act (position Verlet). A step changes motions by equal and opposite
impulses at one point, so momentum is kept to rounding, and the energies are those of the same
steps. All in units of the contact: its effective mass, closing speed and nominal duration.
"""

from collections.abc import Iterator
from math import inf
from typing import Any, NamedTuple, TypeAlias

from .elementwise import select
from .tyre import CORNERS, STANDING, Tyres, wheel_forces

# After so many nominal durations a contact is not waited for any longer.
LONGEST = 3.0
# A friction without bound: its product with a force of 0 is 0.
MOST_FRICTION = 1e150
# Restitution ends when this share of its way is left.
_LEFT = 1e-9


class Rolling(NamedTuple):
    """That the wheels roll, brake and steer as those of a run-out do; settings of
    ``wheel_forces``.
    """

    steered: bool
    transfers: bool


# Of wheels that slide whatever way they move, where each is: ahead and left by half the wheelbase
# and half the track.
Wheels: TypeAlias = tuple[tuple[float, float], ...] | Rolling


# The force of the tyres along both axes of the scene.
Pull: TypeAlias = tuple[Any, Any]
_NO_PULL: Pull = 0.0, 0.0


class Body(NamedTuple):
    """What does not change of a body: how it gives way, its lever, its heading, and its tyres, as
    ``Tyres`` have them.

    ``grip`` is the load of one wheel, ``cap`` the impulse for its speed that no tyre exceeds: with
    more, the four together could turn the motion round.
    """

    per_mass: Any
    per_inertia: Any
    rx: Any
    ry: Any
    cos: Any = 1.0
    sin: Any = 0.0
    grip: Any = 0.0
    cap: Any = 0.0
    front_left: Any = 1.0
    front_right: Any = 1.0
    rear_left: Any = 1.0
    rear_right: Any = 1.0
    friction: Any = 0.0
    cornering: Any = 0.0
    ahead: Any = 0.0
    left: Any = 0.0
    steer_cos: Any = 1.0
    steer_sin: Any = 0.0
    over_ahead: Any = 0.0
    over_left: Any = 0.0

    @property
    def tyres(self) -> Tyres:
        """As the force of the tyres takes them."""
        locks = self.front_left, self.front_right, self.rear_left, self.rear_right
        return Tyres(locks, *self[12:])


class Motion(NamedTuple):
    """Velocity, way since the start, turn since the start as its cosine and sine, and what the
    tyres have done.
    """

    vx: Any
    vy: Any
    spin: Any
    dx: Any = 0.0
    dy: Any = 0.0
    c: Any = 1.0
    s: Any = 0.0
    tyre_x: Any = 0.0
    tyre_y: Any = 0.0
    tyre_yaw: Any = 0.0
    tyre_work: Any = 0.0
    acceleration: Any = 0.0


class Contact(NamedTuple):
    """What does not change of the contact: a spring of this stiffness, which gives back a share of
    its work.

    ``on_a`` and ``turn_a`` are the shares of A in carrying the point and the normal.
    """

    stiffness: Any
    restitution: Any
    friction: Any
    nx: Any
    ny: Any
    on_a: Any
    turn_a: Any
    step: Any
    step_back: Any


class Passing(NamedTuple):
    """How far the contact has come: turn of the normal, penetration and the deepest one, impulse on
    B, work along n and t.

    ``late`` is the time since the push of the last step for which the bodies have not drifted yet,
    less than 0 where a step was cut short before its middle; ``owed`` the time for which the tyres
    have not acted yet.
    """

    c: Any = 1.0
    s: Any = 0.0
    crush: Any = 0.0
    deepest: Any = 0.0
    time: Any = 0.0
    late: Any = 0.0
    owed: Any = 0.0
    closing: Any = 1.0
    impulse_x: Any = 0.0
    impulse_y: Any = 0.0
    work_n: Any = 0.0
    work_t: Any = 0.0
    sticks: Any = False
    active: Any = True


class Compliance(NamedTuple):
    """K of a moment: how much the contact velocities change by an impulse, along n, across, and
    along t.
    """

    nn: Any
    nt: Any
    tt: Any


class Pushed(NamedTuple):
    """What the contact does in a step: impulse on B along n and t, closing speed after, whether it
    sticks, the share of the step that it took, and whether the approach ends in it.
    """

    normal: Any
    along: Any
    after: Any
    sticks: Any
    part: Any
    ends: Any


class Place(NamedTuple):
    """The geometry of a moment: normal, and levers of both bodies."""

    nx: Any
    ny: Any
    ax: Any
    ay: Any
    bx: Any
    by: Any


def force_back(contact: Contact, depth: Any, deepest: Any) -> tuple[Any, Any]:
    """Force on the way back, or where it is deeper than ever, and the penetration at which the
    bodies part.
    """
    way = contact.restitution * contact.restitution * deepest
    # 0.0 at the end of a plastic contact, whose way back has no length.
    share = 1.0 - (deepest - depth) / select(way > 0.0, way, 1.0)
    back = select((share > 0.0) & (way > 0.0), share * deepest, 0.0)
    return contact.stiffness * select(depth > deepest, depth, back), deepest - way


def turned(c: Any, s: Any, half: Any) -> tuple[Any, Any]:
    """Cosine and sine of an angle that grows by twice the arc tangent of ``half``."""
    sine = half * (2.0 / (1.0 + half * half))
    versed = half * sine
    return c - (versed * c + sine * s), s - (versed * s - sine * c)


def place_of(
    contact: Contact, a: Body, b: Body, on_a: Motion, on_b: Motion, passing: Passing
) -> Place:
    """Normal and levers of this moment: the point is carried by the places of both
    bodies that met.
    """
    ax, ay = on_a.c * a.rx - on_a.s * a.ry, on_a.s * a.rx + on_a.c * a.ry
    bx, by = on_b.c * b.rx - on_b.s * b.ry, on_b.s * b.rx + on_b.c * b.ry
    # From the place on A to the place on B.
    apart_x, apart_y = (
        (on_b.dx - on_a.dx) + ((bx - b.rx) - (ax - a.rx)),
        (on_b.dy - on_a.dy) + ((by - b.ry) - (ay - a.ry)),
    )
    off_a, off_b = 1.0 - contact.on_a, contact.on_a
    return Place(
        passing.c * contact.nx - passing.s * contact.ny,
        passing.s * contact.nx + passing.c * contact.ny,
        ax + off_a * apart_x,
        ay + off_a * apart_y,
        bx - off_b * apart_x,
        by - off_b * apart_y,
    )


def approach(place: Place, on_a: Motion, on_b: Motion) -> tuple[Any, Any]:
    """Closing speed, and slip of B relative to A."""
    nx, ny, ax, ay, bx, by = place
    ux, uy = (
        (on_b.vx - on_b.spin * by) - (on_a.vx - on_a.spin * ay),
        (on_b.vy + on_b.spin * bx) - (on_a.vy + on_a.spin * ax),
    )
    return -(nx * ux + ny * uy), nx * uy - ny * ux


def compliance(place: Place, a: Body, b: Body) -> Compliance:
    """K of both bodies, from their masses, yaw inertias and levers."""
    nx, ny, ax, ay, bx, by = place
    n_a, t_a, n_b, t_b = nx * ax + ny * ay, nx * ay - ny * ax, nx * bx + ny * by, nx * by - ny * bx
    yields = a.per_mass + b.per_mass
    return Compliance(
        yields + (a.per_inertia * (t_a * t_a) + b.per_inertia * (t_b * t_b)),
        -(a.per_inertia * (t_a * n_a) + b.per_inertia * (t_b * n_b)),
        yields + (a.per_inertia * (n_a * n_a) + b.per_inertia * (n_b * n_b)),
    )


def braked(body: Body, motion: Motion, time: Any, wheels: Wheels) -> Motion:
    """The motion after the tyres have acted for a time; each pulls against its own motion and
    cannot turn it round.
    """
    if not wheels:
        return motion
    # In the axes of the vehicle.
    cos, sin = motion.c * body.cos - motion.s * body.sin, motion.s * body.cos + motion.c * body.sin
    velocity = cos * motion.vx + sin * motion.vy, cos * motion.vy - sin * motion.vx
    cap = select(time > 0.0, body.cap, 0.0)
    pulls = _rolling if isinstance(wheels, Rolling) else _sliding
    forward: Any = 0.0
    left: Any = 0.0
    yaw: Any = 0.0
    for (ahead, aside), (along, across) in pulls(body, *velocity, motion.spin, time, cap, wheels):
        forward, left, yaw = forward + along, left + across, yaw + (ahead * across - aside * along)
    x, y = cos * forward - sin * left, sin * forward + cos * left
    after = motion._replace(
        vx=motion.vx + body.per_mass * x,
        vy=motion.vy + body.per_mass * y,
        spin=motion.spin + body.per_inertia * yaw,
    )
    work = 0.5 * (
        x * (motion.vx + after.vx) + y * (motion.vy + after.vy) + yaw * (motion.spin + after.spin)
    )
    return after._replace(
        tyre_x=motion.tyre_x + x,
        tyre_y=motion.tyre_y + y,
        tyre_yaw=motion.tyre_yaw + yaw,
        tyre_work=motion.tyre_work + work,
    )


def _sliding(
    body: Body, forward: Any, left: Any, spin: Any, time: Any, cap: Any, wheels: Any
) -> Iterator[Any]:
    """Place and impulse of each wheel, which has its whole friction against its motion, whatever
    way that is.
    """
    share = 4.0 / len(wheels)
    most, cap = share * (body.friction * (body.grip * time)), share * cap
    for ahead, aside in wheels:
        at = ahead * body.ahead, aside * body.left
        ux, uy = forward - spin * at[1], left + spin * at[0]
        speed = (ux * ux + uy * uy) ** 0.5
        hold = select(most < cap * speed, most / select(speed > 0.0, speed, 1.0), cap)
        yield at, (-hold * ux, -hold * uy)


def _rolling(
    body: Body, forward: Any, left: Any, spin: Any, time: Any, cap: Any, wheels: Any
) -> Iterator[Any]:
    """The same of wheels that roll, brake and steer, with the force that they have in a run-out."""
    tyres, here = body.tyres, (body.friction,) * len(CORNERS)
    reach = spin * spin * (body.ahead * body.ahead + body.left * body.left)
    speed = (forward * forward + left * left + reach) ** 0.5
    standing = STANDING * select(speed > 0.0, speed, 1.0)
    # On one ground and under the loads at rest, what a brake holds is its lock.
    brakes = None if wheels.transfers else list(tyres.locks)
    forces = wheel_forces(
        tyres, here, forward, left, spin, standing, **wheels._asdict(), brakes=brakes
    )
    most = body.friction * (body.grip * time)
    for (ahead, aside, _), (along, across, load) in zip(CORNERS, forces, strict=True):
        at = ahead * body.ahead, aside * body.left
        x, y = (most * load) * along, (most * load) * across
        takes = -(x * (forward - spin * at[1]) + y * (left + spin * at[0]))
        square = x * x + y * y
        # As much as would stop the motion along it, and none if it does not act against that.
        stops = cap * select(takes > 0.0, takes, 0.0)
        less = stops < square
        share = select(less, stops / select(less, square, 1.0), 1.0)
        yield at, (share * x, share * y)


def _headed(motion: Motion, time: Any) -> Motion:
    """The motion with the heading of some time later."""
    c, s = turned(motion.c, motion.s, 0.5 * time * motion.spin)
    return motion._replace(c=c, s=s)


def drifted(
    contact: Contact,
    bodies: tuple[Motion, Motion],
    passing: Passing,
    time: Any,
    held: tuple[Motion, Motion] | None = None,
) -> tuple[Motion, Motion, Passing]:
    """Both bodies and the normal some time later; ``held`` are the bodies after their tyres have
    acted in the middle of that time.
    """
    half, spins, after = 0.5 * time, [], []
    for before, body in zip(bodies, held or bodies, strict=True):
        vx, vy, spin = body[:3]
        if held is not None:
            vx, vy, spin = (
                0.5 * (was + now) for was, now in zip(before[:3], (vx, vy, spin), strict=True)
            )
        c, s = turned(before.c, before.s, half * spin)
        moved = {"dx": before.dx + time * vx, "dy": before.dy + time * vy}
        after.append(body._replace(c=c, s=s, **moved))
        spins.append(spin)
    spin = contact.turn_a * spins[0] + (1.0 - contact.turn_a) * spins[1]
    c, s = turned(passing.c, passing.s, half * spin)
    return after[0], after[1], passing._replace(c=c, s=s)


def _pushed(
    body: Body,
    motion: Motion,
    x: Any,
    y: Any,
    arm: tuple[Any, Any],
    lasting: tuple[Any, Any],
    per_time: Any,
    tyres: Pull,
) -> Motion:
    """The motion after an impulse, and the square of its largest acceleration so far, by what of
    the impulse is ``lasting`` and by the force of the tyres.
    """
    force_x, force_y = lasting[0] * per_time, lasting[1] * per_time
    if tyres is not _NO_PULL:
        force_x, force_y = force_x + tyres[0], force_y + tyres[1]
    ax, ay = body.per_mass * force_x, body.per_mass * force_y
    square = ax * ax + ay * ay
    return motion._replace(
        vx=motion.vx + body.per_mass * x,
        vy=motion.vy + body.per_mass * y,
        spin=motion.spin + body.per_inertia * (arm[0] * y - arm[1] * x),
        acceleration=select(square > motion.acceleration, square, motion.acceleration),
    )


def _rate(time: Any) -> Any:
    """1 over a time; 0 for none."""
    some = time > 0.0
    return select(some, 1.0, 0.0) / select(some, time, 1.0)


def _pull(before: Motion, after: Motion, per_time: Any) -> Pull:
    """The mean force of the tyres between two motions."""
    return (after.tyre_x - before.tyre_x) * per_time, (after.tyre_y - before.tyre_y) * per_time


def step_length(contact: Contact, passing: Passing, engaging: bool) -> Any:
    """How long the step is; on the way back the last one ends where the force does."""
    step = contact.step
    if not engaging:
        closing = passing.closing
        _, parting = force_back(contact, passing.crush, passing.deepest)
        left = passing.crush - parting
        last = (closing < 0.0) & (left < -closing * contact.step_back)
        step = select(last, left / select(last, -closing, 1.0), contact.step_back)
    return select(passing.active, step, 0.0)


def turns_at(contact: Contact, k: Compliance, slip: Any) -> Any:
    """The normal impulse at which friction that cannot hold turns with the slip, within the step;
    infinite where it does not.
    """
    coupled, held = abs(k.nt), contact.friction * k.tt
    opposes = (coupled > held) & (slip * k.nt < 0.0)
    return select(opposes, abs(slip) / select(opposes, coupled + held, 1.0), inf)


def friction_impulse(
    contact: Contact, k: Compliance, slip: Any, turn: Any, normal: Any
) -> tuple[Any, Any]:
    """The tangential impulse beside a normal one: what stops the slip, within what Coulomb friction
    allows; and whether it does.
    """
    wanted = -(slip + k.nt * normal) / select(k.tt > 0.0, k.tt, inf)
    most = contact.friction * normal
    limited = select(wanted > most, most, select(wanted < -most, -most, wanted))
    turns = turn < normal
    turning = contact.friction * (normal - 2.0 * select(turns, turn, 0.0))
    turning = select(k.nt < 0.0, turning, -turning)
    sticks = (wanted <= most) & (wanted >= -most) & (turns ^ True)
    return select(turns, turning, limited), sticks


def push_of(
    contact: Contact,
    k: Compliance,
    closing: Any,
    slip: Any,
    normal: Any,
    engaging: bool,
    active: Any,
) -> Pushed:
    """What the contact does in a step whose force makes this normal impulse; the step in which the
    bodies stop to approach is cut short there.
    """
    turn = turns_at(contact, k, slip)
    along, sticks = friction_impulse(contact, k, slip, turn, normal)
    after = closing - (k.nn * normal + k.nt * along)
    if not engaging:
        return Pushed(normal, along, after, sticks, 1.0, False)
    ends = (after <= 0.0) & active
    cut = ends & (closing > 0.0)
    part = select(cut, closing / select(cut, closing - after, 1.0), select(ends, 0.0, 1.0))
    normal = part * normal
    along, sticks = friction_impulse(contact, k, slip, turn, normal)
    after = closing - (k.nn * normal + k.nt * along)
    return Pushed(normal, along, after, sticks, part, ends)


def advance(
    contact: Contact,
    a: Body,
    b: Body,
    on_a: Motion,
    on_b: Motion,
    passing: Passing,
    engaging: bool,
    moves: bool,
    wheels_a: Wheels,
    wheels_b: Wheels,
) -> tuple[Motion, Motion, Passing]:
    """One step of a contact that is still active: ``engaging`` up to maximum engagement, and else
    of the way back.
    """
    active, crush, deepest = passing.active, passing.crush, passing.deepest
    step = step_length(contact, passing, engaging)
    # Since the push of the last step.
    drift = select(active, passing.late + 0.5 * step, 0.0)
    before, pulls, pays = (on_a, on_b), (_NO_PULL, _NO_PULL), bool(wheels_a or wheels_b)
    if pays:
        due = passing.owed + 0.5 * step
        due = select(active & (due > 0.0), due, 0.0)
        if moves:
            on_a, on_b = _headed(on_a, 0.5 * drift), _headed(on_b, 0.5 * drift)
        on_a, on_b = braked(a, on_a, due, wheels_a), braked(b, on_b, due, wheels_b)
        per_due = _rate(due)
        pulls = _pull(before[0], on_a, per_due), _pull(before[1], on_b, per_due)
        passing = passing._replace(owed=passing.owed - due)
    if moves:
        held = (on_a, on_b) if pays else None
        on_a, on_b, passing = drifted(contact, before, passing, drift, held)

    place = place_of(contact, a, b, on_a, on_b, passing)
    closing, slip = approach(place, on_a, on_b)
    k = compliance(place, a, b)
    depth = crush + 0.5 * step * closing
    force = contact.stiffness * depth if engaging else force_back(contact, depth, deepest)[0]
    pushed = push_of(contact, k, closing, slip, force * step, engaging, active)
    normal, along, after, sticks, part, ends = pushed

    slip_after = slip + (k.nt * normal + k.tt * along)
    px, py = place.nx * normal - place.ny * along, place.ny * normal + place.nx * along
    took = part * step
    per_time = _rate(took)
    # Friction without bound stops at once the slip with which a step begins: no acceleration.
    at_once = (contact.friction >= MOST_FRICTION) & (k.tt > 0.0)
    stops = select(at_once, slip, 0.0) / select(at_once, k.tt, 1.0)
    fx, fy = px - place.ny * stops, py + place.nx * stops
    on_a = _pushed(a, on_a, -px, -py, (place.ax, place.ay), (-fx, -fy), per_time, pulls[0])
    on_b = _pushed(b, on_b, px, py, (place.bx, place.by), (fx, fy), per_time, pulls[1])
    mean = 0.5 * (closing + after)
    crush = crush + took * mean
    deepest = select(crush > deepest, crush, deepest)
    if engaging:
        still = active & (ends ^ True)
    else:
        _, parting = force_back(contact, crush, deepest)
        still = active & (crush - parting > _LEFT * (deepest - parting))
    time = passing.time + took
    passing = passing._replace(
        crush=crush,
        deepest=deepest,
        time=time,
        late=passing.late + took - drift if moves else passing.late,
        owed=passing.owed + took if pays else passing.owed,
        closing=select(active, after, passing.closing),
        impulse_x=passing.impulse_x + px,
        impulse_y=passing.impulse_y + py,
        work_n=passing.work_n + normal * mean,
        work_t=passing.work_t - along * (0.5 * (slip + slip_after)),
        sticks=select(active, sticks, passing.sticks),
        active=still & (time < LONGEST),
    )
    return on_a, on_b, passing
