"""One step of a contact that takes time: force over penetration, friction, tyres, and bodies that
move and turn meanwhile.

Each step is a half drift, the impulses of the contact, and a half drift (position Verlet); the
impulse of the tyres comes between two steps. It changes motions by equal and opposite impulses at
one point, so momentum is kept to rounding, and the energies are those of the same steps. All in
units of the contact: its effective mass, closing speed and nominal duration.
"""

from math import inf
from typing import Any, NamedTuple, TypeAlias

from .elementwise import select

# After so many nominal durations a contact is not waited for any longer.
LONGEST = 3.0
# Restitution ends when this share of its way is left.
_LEFT = 1e-9


Wheels: TypeAlias = tuple[tuple[float, float], ...]


class Spring(NamedTuple):
    """Force over penetration while it grows: ``force`` at first, ``soft`` per length up to the
    ``knee``, then ``stiff``.
    """

    force: Any
    soft: Any
    knee: Any
    stiff: Any

    def at(self, depth: Any) -> tuple[Any, Any]:
        """Force and work at a penetration that has not been larger before."""
        first = select(depth < self.knee, depth, self.knee)
        then = depth - first
        at_knee = self.force + self.soft * first
        return at_knee + self.stiff * then, first * (
            self.force + 0.5 * self.soft * first
        ) + then * (at_knee + 0.5 * self.stiff * then)


class Body(NamedTuple):
    """What does not change of a body: how it gives way, its lever, half its wheelbase and half its
    track, and its tyres.

    ``grip`` is the force of one wheel, ``cap`` the impulse for its speed that no tyre exceeds: with
    more, the four together could turn the motion round.
    """

    per_mass: Any
    per_inertia: Any
    rx: Any
    ry: Any
    ahead_x: Any
    ahead_y: Any
    left_x: Any
    left_y: Any
    grip: Any
    cap: Any


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
    """What does not change of the contact; ``on_a`` and ``turn_a`` are the shares of A in carrying
    the point and the normal.
    """

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
    """

    c: Any = 1.0
    s: Any = 0.0
    crush: Any = 0.0
    deepest: Any = 0.0
    time: Any = 0.0
    owed: Any = 0.0
    closing: Any = 1.0
    impulse_x: Any = 0.0
    impulse_y: Any = 0.0
    work_n: Any = 0.0
    work_t: Any = 0.0
    sticks: Any = False
    active: Any = True


class Place(NamedTuple):
    """The geometry of a moment: normal, and levers of both bodies."""

    nx: Any
    ny: Any
    ax: Any
    ay: Any
    bx: Any
    by: Any


def force_back(spring: Spring, e: Any, depth: Any, deepest: Any) -> tuple[Any, Any]:
    """Force on the way back, or where it is deeper than ever, and the penetration at which the
    bodies part.
    """
    most, work = spring.at(deepest)
    way = 2.0 * e * e * work / select(most > 0.0, most, 1.0)
    # 0.0 at the end of a plastic contact, whose way back has no length.
    share = 1.0 - (deepest - depth) / select(way > 0.0, way, 1.0)
    back = select((share > 0.0) & (way > 0.0), share * most, 0.0)
    return select(depth > deepest, spring.at(depth)[0], back), deepest - way


def turned(c: Any, s: Any, half: Any) -> tuple[Any, Any]:
    """Cosine and sine of an angle that grows by twice the arc tangent of ``half``."""
    by = 2.0 / (1.0 + half * half)
    sine, versed = half * by, half * (half * by)
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


def compliance(place: Place, a: Body, b: Body) -> tuple[Any, Any, Any]:
    """K: how much the contact velocities change by an impulse, along n, across, and along t."""
    nx, ny, ax, ay, bx, by = place
    n_a, t_a, n_b, t_b = nx * ax + ny * ay, nx * ay - ny * ax, nx * bx + ny * by, nx * by - ny * bx
    yields = a.per_mass + b.per_mass
    return (
        yields + (a.per_inertia * (t_a * t_a) + b.per_inertia * (t_b * t_b)),
        -(a.per_inertia * (t_a * n_a) + b.per_inertia * (t_b * n_b)),
        yields + (a.per_inertia * (n_a * n_a) + b.per_inertia * (n_b * n_b)),
    )


def braked(body: Body, motion: Motion, time: Any, wheels: Wheels) -> Motion:
    """The motion after the tyres have slid for a time; each pulls against its own motion and cannot
    turn it round.
    """
    if not wheels:
        return motion
    ahead_x, ahead_y = (
        motion.c * body.ahead_x - motion.s * body.ahead_y,
        motion.s * body.ahead_x + motion.c * body.ahead_y,
    )
    left_x, left_y = (
        motion.c * body.left_x - motion.s * body.left_y,
        motion.s * body.left_x + motion.c * body.left_y,
    )
    x: Any = 0.0
    y: Any = 0.0
    yaw: Any = 0.0
    most = (4.0 / len(wheels)) * (body.grip * time)
    cap = select(time > 0.0, (4.0 / len(wheels)) * body.cap, 0.0)
    for ahead, left in wheels:
        wx, wy = ahead * ahead_x + left * left_x, ahead * ahead_y + left * left_y
        ux, uy = motion.vx - motion.spin * wy, motion.vy + motion.spin * wx
        speed = (ux * ux + uy * uy) ** 0.5
        hold = select(most < cap * speed, most / select(speed > 0.0, speed, 1.0), cap)
        x, y, yaw = x - hold * ux, y - hold * uy, yaw - hold * (wx * uy - wy * ux)
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


def drifted(motion: Motion, time: Any) -> Motion:
    """The motion some time later, with the velocities that it has."""
    c, s = turned(motion.c, motion.s, 0.5 * time * motion.spin)
    return motion._replace(
        dx=motion.dx + time * motion.vx, dy=motion.dy + time * motion.vy, c=c, s=s
    )


def _drifted(
    contact: Contact, on_a: Motion, on_b: Motion, passing: Passing, time: Any
) -> tuple[Motion, Motion, Passing]:
    spin = contact.turn_a * on_a.spin + (1.0 - contact.turn_a) * on_b.spin
    c, s = turned(passing.c, passing.s, 0.5 * time * spin)
    return drifted(on_a, time), drifted(on_b, time), passing._replace(c=c, s=s)


def _pushed(
    body: Body,
    motion: Motion,
    x: Any,
    y: Any,
    arm: tuple[Any, Any],
    per_time: Any,
    tyres: tuple[Any, Any],
) -> Motion:
    """The motion after an impulse, and the square of its largest acceleration so far, by that and
    by the force of the tyres.
    """
    ax, ay = body.per_mass * (x * per_time + tyres[0]), body.per_mass * (y * per_time + tyres[1])
    square = ax * ax + ay * ay
    return motion._replace(
        vx=motion.vx + body.per_mass * x,
        vy=motion.vy + body.per_mass * y,
        spin=motion.spin + body.per_inertia * (arm[0] * y - arm[1] * x),
        acceleration=select(square > motion.acceleration, square, motion.acceleration),
    )


def advance(
    spring: Spring,
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
    step = contact.step if engaging else contact.step_back
    if not engaging:
        # The last step ends where the force does.
        _, parting = force_back(spring, contact.restitution, crush, deepest)
        left = crush - parting
        last = (passing.closing < 0.0) & (left < -passing.closing * step)
        step = select(last, left / select(last, -passing.closing, 1.0), step)
    step = select(active, step, 0.0)
    pay = passing.owed + 0.5 * step
    pay = select(active & (pay > 0.0), pay, 0.0)
    per_tyres = select(pay > 0.0, 1.0, 0.0) / select(pay > 0.0, pay, 1.0)
    held_before = (on_a.tyre_x, on_a.tyre_y), (on_b.tyre_x, on_b.tyre_y)
    on_a, on_b = braked(a, on_a, pay, wheels_a), braked(b, on_b, pay, wheels_b)
    if moves:
        on_a, on_b, passing = _drifted(contact, on_a, on_b, passing, 0.5 * step)
    place = place_of(contact, a, b, on_a, on_b, passing)
    closing, slip = approach(place, on_a, on_b)
    k_nn, k_nt, k_tt = compliance(place, a, b)
    depth = crush + 0.5 * step * closing
    force = (
        spring.at(depth)[0]
        if engaging
        else force_back(spring, contact.restitution, depth, deepest)[0]
    )

    coupled, held = abs(k_nt), contact.friction * k_tt
    opposes = (coupled > held) & (slip * k_nt < 0.0)
    turn = select(opposes, abs(slip) / select(opposes, coupled + held, 1.0), inf)

    def tangential(normal: Any) -> tuple[Any, Any]:
        wanted, most = (
            -(slip + k_nt * normal) / select(k_tt > 0.0, k_tt, inf),
            contact.friction * normal,
        )
        limited = select(wanted > most, most, select(wanted < -most, -most, wanted))
        # Friction that cannot hold turns with the slip, within the step.
        turns = turn < normal
        turning = contact.friction * (normal - 2.0 * select(turns, turn, 0.0))
        turning = select(k_nt < 0.0, turning, -turning)
        return select(turns, turning, limited), (wanted <= most) & (wanted >= -most) & (
            turns ^ True
        )

    part: Any = 1.0
    normal = force * step
    along, sticks = tangential(normal)
    after = closing - (k_nn * normal + k_nt * along)
    ends: Any = False
    if engaging:
        # The step in which the bodies stop to approach is cut short there.
        ends = (after <= 0.0) & active
        cut = ends & (closing > 0.0)
        part = select(cut, closing / select(cut, closing - after, 1.0), select(ends, 0.0, 1.0))
        normal = part * normal
        along, sticks = tangential(normal)
        after = closing - (k_nn * normal + k_nt * along)
    slip_after = slip + (k_nt * normal + k_tt * along)
    px, py = place.nx * normal - place.ny * along, place.ny * normal + place.nx * along
    took = part * step
    per_time = select(took > 0.0, 1.0, 0.0) / select(took > 0.0, took, 1.0)
    pull_a, pull_b = (
        ((motion.tyre_x - x) * per_tyres, (motion.tyre_y - y) * per_tyres)
        for motion, (x, y) in zip((on_a, on_b), held_before, strict=True)
    )
    on_a = _pushed(a, on_a, -px, -py, (place.ax, place.ay), per_time, pull_a)
    on_b = _pushed(b, on_b, px, py, (place.bx, place.by), per_time, pull_b)
    mean = 0.5 * (closing + after)
    crush = crush + took * mean
    deepest = select(crush > deepest, crush, deepest)
    if engaging:
        still = active & (ends ^ True)
    else:
        _, parting = force_back(spring, contact.restitution, crush, deepest)
        still = active & (crush - parting > _LEFT * (deepest - parting))
    time = passing.time + took
    passing = passing._replace(
        crush=crush,
        deepest=deepest,
        time=time,
        owed=select(active, passing.owed + took - pay, passing.owed),
        closing=select(active, after, passing.closing),
        impulse_x=passing.impulse_x + px,
        impulse_y=passing.impulse_y + py,
        work_n=passing.work_n + normal * mean,
        work_t=passing.work_t - along * (0.5 * (slip + slip_after)),
        sticks=select(active, sticks, passing.sticks),
        active=still & (time < LONGEST),
    )
    if moves:
        return _drifted(contact, on_a, on_b, passing, took - 0.5 * step)
    return on_a, on_b, passing
