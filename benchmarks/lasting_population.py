"""The crashes that lasting_crashes.py is run on: cars of all sizes that meet at wide angles.

The ranges below and the seed were fixed before any answer of the package was looked at on these
crashes. Each is uniform.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from lasting_crashes import Contacts, Crashes, simulated

SEED = 20261125
CROSSING = (35.0, 145.0)  # degrees between the courses, to either side
SPEED = (6.0, 24.0)  # m/s, each
MASS = (900.0, 2300.0)
GYRATION = (0.46, 0.54)  # radius of gyration in yaw over wheelbase
WHEELBASE, AHEAD, TRACK, HEIGHT = (2.4, 3.0), (0.42, 0.54), (1.4, 1.65), (0.45, 0.70)
NOSE, HALF_WIDTH = (
    (1.8, 2.3),
    (0.80, 0.92),
)  # m from the centre of mass to the bumper and to the side, less some crush
CORNERING, RADIUS, SPIN_INERTIA = (8.0, 14.0), (0.28, 0.34), (0.8, 1.5)
DURATION = (0.05, 0.16)  # s, of the contacts that are kept
DEEPEST = 1.2  # m, that both cars give way together in those
RESTITUTION, FRICTION, GROUND = (0.0, 0.3), (0.2, 0.9), (0.3, 0.9)
DRIFT = 4.0  # degrees, to either side, of the heading from the course
TILT = 20.0  # degrees, to either side, of the normal from that of the two faces
SWERVE = 0.15  # rad/s, to either side, of the yaw rate before
CLOSING = 3.0  # m/s along the normal at first touch, at least
REACH = 0.3  # m along the normal between each centre of mass and the point, at least
BRAKED, LOCKED, RESISTING = (
    (0.15, 0.9),
    1.5,
    (0.0, 0.03),
)  # locks of wheels: braked, locked, and rolling
ROLLING = 0.4  # of the crashes, the share in which all eight wheels roll
ROUGH = {
    "steps": 1000,
    "creep": 0.05,
}  # the integration that sorts out contacts of the wrong length
RECORDER = (0.5, 0.2)  # m, how far a recorder may lie from the centre of mass along and across


@dataclass(frozen=True, kw_only=True)
class Population:
    """Crashes, what became of them, and where their recorders are."""

    crashes: Crashes
    contacts: Contacts
    recorder: Any  # (2, 2, crashes): forward and left, of each car

    @property
    def rolling(self) -> Any:
        """Whether all eight wheels roll."""
        return np.all(self.crashes.lock <= RESISTING[1], axis=(0, 1))


def _locks(generator: np.random.Generator, n: int) -> Any:
    """All wheels of a car braked alike, locked, each braked by itself, or rolling."""
    rolling = generator.uniform(*RESISTING, (2, 1, n)) * np.ones((1, 4, 1))
    alike = generator.uniform(*BRAKED, (2, 1, n)) * np.ones((1, 4, 1))
    apart = generator.uniform(0.0, 1.2, (2, 4, n))  # above 1 a wheel is jammed
    kind = generator.integers(0, 4, (2, 1, n))  # 3: this one rolls
    first = generator.integers(0, 2, n)
    kind[first, 0, np.arange(n)] = generator.integers(0, 3, n)  # but not both
    kind[:, :, generator.uniform(size=n) < ROLLING] = 3
    kinds = [alike, np.full_like(apart, LOCKED), apart, rolling]
    return np.select([kind == which for which in range(4)], kinds)


def drawn(n: int, seed: int) -> tuple[Crashes, Any]:
    """Crashes at first touch and the places of their recorders.

    The front of one car strikes the side of the other (three in five), or its front.
    """
    generator = np.random.default_rng(seed)
    draw = generator.uniform
    m = 12 * n
    wheelbase, mass = draw(*WHEELBASE, (2, m)), draw(*MASS, (2, m))
    crossing = np.radians(draw(*CROSSING, m)) * generator.choice([-1.0, 1.0], m)
    course = np.stack([np.zeros(m), crossing])
    heading = course + np.radians(draw(-DRIFT, DRIFT, (2, m)))
    nose, half = draw(*NOSE, (2, m)), draw(*HALF_WIDTH, (2, m))
    across = draw(-0.85, 0.85, (2, m)) * half
    along = draw(-0.9, 0.9, m) * nose[1]
    side = draw(size=m) < 0.6
    # Where the point lies on each car, forward and left: of a side, the one that A comes from.
    nearer = np.sign(np.sin(heading[1] - heading[0]))
    forward = np.stack([nose[0], np.where(side, along, nose[1])])
    left = np.stack([across[0], np.where(side, nearer * half[1], across[1])])
    # Outward from each face; the normal lies between that of A's and the inward one of B's.
    out_b = heading[1] + np.where(side, nearer * np.pi / 2.0, 0.0)
    share = draw(0.2, 0.8, m)
    apart = np.angle(np.exp(1j * (out_b + np.pi - heading[0])))
    normal = heading[0] + share * apart + np.radians(draw(-TILT, TILT, m))
    c, s = np.cos(heading), np.sin(heading)
    x, y = -(c * forward - s * left), -(s * forward + c * left)
    speed = draw(*SPEED, (2, m))
    vx, vy = speed * np.cos(course), speed * np.sin(course)
    yaw_rate = draw(-SWERVE, SWERVE, (2, m))
    inertia = mass * (draw(*GYRATION, (2, m)) * wheelbase) ** 2
    nx, ny = np.cos(normal), np.sin(normal)
    moment = x * ny - y * nx  # of the normal about each centre of mass, with its sign turned
    yielding = np.sum(1.0 / mass + moment**2 / inertia, axis=0)
    restitution = draw(*RESTITUTION, m)
    nominal = draw(*DURATION, m)
    stiffness = (np.pi / 2.0 * (1.0 + restitution) / nominal) ** 2 / yielding
    crashes = Crashes(
        mass=mass,
        inertia=inertia,
        x=x,
        y=y,
        heading=heading,
        vx=vx,
        vy=vy,
        yaw_rate=yaw_rate,
        point=np.zeros((2, m)),
        normal=normal,
        stiffness=stiffness,
        restitution=restitution,
        friction=draw(*FRICTION, m),
        nominal=nominal,
        ground=draw(*GROUND, m),
        lock=_locks(generator, m),
        wheelbase=wheelbase,
        ahead=draw(*AHEAD, (2, m)),
        track=draw(*TRACK, (2, m)),
        height=draw(*HEIGHT, (2, m)),
        cornering=draw(*CORNERING, (2, m)),
        radius=draw(*RADIUS, (2, m)),
        spin_inertia=draw(*SPIN_INERTIA, (2, m)),
    )
    recorder = draw(-1.0, 1.0, (2, 2, m)) * np.array(RECORDER)[None, :, None]
    # Half of them are told the other way round, and each scene lies at any angle.
    crashes, recorder = _relabelled(crashes, recorder, draw(size=m) < 0.5)
    crashes = _rotated(crashes, draw(-np.pi, np.pi, m))
    fit = np.flatnonzero(_meet(crashes))[: 3 * n]
    return crashes.take(fit), recorder[..., fit]


def _relabelled(crashes: Crashes, recorder: Any, swap: Any) -> tuple[Crashes, Any]:
    values = {}
    for name, value in vars(crashes).items():
        cars = value.ndim > 1 and name != "point"
        values[name] = np.where(swap, value[::-1], value) if cars else value
    values["normal"] = np.where(swap, crashes.normal + np.pi, crashes.normal)
    return Crashes(**values), np.where(swap, recorder[::-1], recorder)


def _rotated(crashes: Crashes, angle: Any) -> Crashes:
    c, s = np.cos(angle), np.sin(angle)
    values = dict(vars(crashes))
    for one, other in (("x", "y"), ("vx", "vy")):
        first, second = values[one], values[other]
        values[one], values[other] = c * first - s * second, s * first + c * second
    values["heading"] = crashes.heading + angle
    values["normal"] = np.angle(np.exp(1j * (crashes.normal + angle)))
    return Crashes(**values)


def _meet(crashes: Crashes) -> Any:
    """Whether the two points close, and both centres of mass lie behind the contact."""
    k = crashes
    nx, ny = np.cos(k.normal), np.sin(k.normal)
    vx, vy = k.vx + k.yaw_rate * k.y, k.vy - k.yaw_rate * k.x  # the point is the origin
    closing = (vx[0] - vx[1]) * nx + (vy[0] - vy[1]) * ny
    behind = k.x * nx + k.y * ny
    return (closing > CLOSING) & (behind[0] < -REACH) & (behind[1] > REACH)


def population(n: int, seed: int = SEED, *, instant: bool = False) -> Population:
    """So many crashes whose contact lasts as long as it should; another number draws others.

    With ``instant`` the same crashes with contacts of 2 ms and without tyres: a world in which an
    impulse is the truth.
    """
    crashes, recorder = drawn(n, seed)
    contacts = simulated(crashes, **ROUGH)
    good = contacts.ended & (contacts.duration >= DURATION[0]) & (contacts.duration <= DURATION[1])
    good &= contacts.penetration <= DEEPEST
    which = np.flatnonzero(good)[:n]
    if which.size < n:
        raise ValueError(f"only {which.size} of {n} crashes have a contact of this length")
    kept = crashes.take(which)
    kept = kept.instant() if instant else kept
    return Population(crashes=kept, contacts=simulated(kept), recorder=recorder[..., which])
