"""One step of a vehicle that runs out on its tyres, of orders 5 and 4, and how near the end it is.

All in units of the motion at its start: its speed, that over gravity, and the product of both. The
steps are over a time that slows down with the vehicle (time over speed), in which forces depend on
the direction of the motion alone and its end is regular. The yaw rate is over the distance of a
wheel from the centre of mass, so that it is a speed too.
"""

from typing import Any, NamedTuple

import numpy as np

from .elementwise import larger, select
from .tyre import Tyres, brake_shares, tyre_forces

# The embedded pair of orders 5 and 4 of Dormand and Prince, J. Comput. Appl. Math. 6 (1980) 19.
_STAGES = (
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
_ERRORS = (71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40)
# A motion whose direction changes at less than this share of its slowing, or of the least slowing
# that counts, is straight.
_STRAIGHT, _SLOWEST = 1e-6, 1e-4

# In the error of a step, the weight of that over the speed that is left.
_RELATIVE = 1e-3


class Ground(NamedTuple):
    """What does not change in a step: tyres, the friction under each wheel, mass over inertia, turn
    per way, slope, and what the rotation of the wheels adds to the mass, as a share of it.
    """

    tyres: Tyres
    here: tuple[Any, ...]
    gyration: Any
    spin: Any
    slope_x: Any
    slope_y: Any
    rotating: Any


class Settings(NamedTuple):
    """What is the same for all cases: whether wheels are steered, loads follow forces, the ground
    slopes, and the rotation of the wheels counts.
    """

    steered: bool
    transfers: bool
    sloped: bool
    rotates: bool = False


# How many numbers the ground has.
OF_GROUND = 21


def ground_of(numbers: tuple[Any, ...]) -> Ground:
    """The ground, from its numbers in a row."""
    if isinstance(numbers[0], np.ndarray) and numbers[0].ndim:
        # The wheels in the rows of one array: a quarter of the calls.
        return Ground(
            Tyres((np.stack(numbers[:4]),), *numbers[4:12]),
            (np.stack(numbers[12:16]),),
            *numbers[16:OF_GROUND],
        )
    return Ground(Tyres(numbers[:4], *numbers[4:12]), numbers[12:16], *numbers[16:OF_GROUND])


def size(vx: Any, vy: Any, turn: Any) -> Any:
    """The speed of the motion: of the centre of mass, and of the wheels about it."""
    return (vx * vx + vy * vy + turn * turn) ** 0.5


def accelerations(*numbers: Any) -> tuple[Any, Any, Any]:
    """Along x and y and in yaw, from those of the ground, the velocities, cosine and sine of the
    heading, and settings.
    """
    *rest, steered, transfers, sloped, rotates = numbers
    return _accelerations(
        ground_of(tuple(rest[:OF_GROUND])),
        Settings(steered, transfers, sloped, rotates),
        *rest[OF_GROUND:],
    )


def _accelerations(
    ground: Ground,
    settings: Settings,
    vx: Any,
    vy: Any,
    turn: Any,
    c: Any,
    s: Any,
    brakes: Any = None,
) -> tuple[Any, Any, Any]:
    speed = size(vx, vy, turn)
    scale = select(speed > 0.0, speed, 1.0)
    ux, uy, turning = vx / scale, vy / scale, turn / scale
    motion = c * ux + s * uy, c * uy - s * ux, turning

    def forces(rotation: tuple[Any, ...] | None) -> tuple[Any, Any, Any]:
        return tyre_forces(
            ground.tyres,
            ground.here,
            *motion,
            steered=settings.steered,
            transfers=settings.transfers,
            brakes=brakes,
            rotation=rotation,
        )

    forward, left, yaw = forces(None)
    if settings.rotates:
        forward, left, yaw = forces(
            _rotation(ground, settings, forward, left, yaw, c, s, vx, vy, turn)
        )
    ax, ay = c * forward - s * left, s * forward + c * left
    if settings.sloped:
        ax, ay = ax - ground.slope_x, ay - ground.slope_y
    return ax, ay, ground.gyration * yaw


def _rotation(
    ground: Ground, settings: Settings, forward: Any, left: Any, yaw: Any, *motion: Any
) -> tuple[Any, ...]:
    """What ``tyre_forces`` takes as the rotation of the wheels, from the forces without it.

    Wheels that hardly slip along themselves turn as fast as their contacts move. Their rotation
    slows the gain of speed ahead that it follows; here as where all of them roll.
    """
    c, s, vx, vy, turn = motion
    gain_x, gain_y = forward, left
    if settings.sloped:
        gain_x = gain_x - (c * ground.slope_x + s * ground.slope_y)
        gain_y = gain_y - (c * ground.slope_y - s * ground.slope_x)
    # In axes that turn with the vehicle.
    rate = turn * ground.spin
    gain_x, gain_y = gain_x + rate * (c * vy - s * vx), gain_y - rate * (c * vx + s * vy)
    return ground.rotating / (1.0 + ground.rotating), gain_x, gain_y, ground.gyration * yaw


def step(*numbers: Any) -> tuple[Any, ...]:
    """One step: velocities after it, way along x and y, turn and time, accelerations after it, and
    the error.

    Of the numbers of the ground; velocities, cosine and sine of the heading, accelerations, and
    width; and settings.
    """
    *rest, steered, transfers, sloped, rotates = numbers
    ground = ground_of(tuple(rest[:OF_GROUND]))
    settings = Settings(steered, transfers, sloped, rotates)
    vx, vy, turn, c, s, ax, ay, yaw, width = rest[OF_GROUND:]
    rows = isinstance(vx, np.ndarray) and vx.ndim == 1
    start: Any = np.stack([vx, vy, turn, c, s]) if rows else (vx, vy, turn, c, s)
    brakes = None if settings.transfers else brake_shares(ground.tyres, ground.here)

    def rates(now: Any, found: tuple[Any, ...] | None = None) -> tuple[Any, tuple[Any, ...]]:
        vx, vy, turn, c, s = now
        speed = size(vx, vy, turn)
        x, y, turning = found or _accelerations(ground, settings, vx, vy, turn, c, s, brakes)
        rate = speed * (turn * ground.spin)
        row = (
            speed * x,
            speed * y,
            speed * turning,
            -rate * s,
            rate * c,
            speed * vx,
            speed * vy,
            rate,
            speed,
        )
        return np.stack(row) if rows else row, (x, y, turning)

    stages, now = [rates(start, (ax, ay, yaw))[0]], start
    for weights in _STAGES:
        now = _further(start, width, _sum(weights, stages, 0, 5))
        further, after = rates(now)
        stages.append(further)
    way = [width * part for part in _sum(_STAGES[-1], stages, 5, 9)]
    off = [*_sum(_ERRORS, stages, 0, 3), *_sum(_ERRORS, stages, 7, 8)]
    # What it moves and turns the place of rest: an error in velocity lasts for a time that is as
    # long as the speed is high.
    left = size(*now[:3])
    relative = _RELATIVE / select(left > 0.0, left, 1.0)
    off_velocity, off_turn, off_heading = (
        (off[0] * off[0] + off[1] * off[1]) ** 0.5,
        abs(off[2]),
        abs(off[3]),
    )
    wrong = width * (
        off_velocity * (left + relative)
        + off_turn * (left * (1.0 + ground.spin) + relative)
        + off_heading
    )
    return (*now[:3], *way, *after, wrong)


def _sum(weights: tuple[float, ...], stages: list[Any], first: int, end: int) -> Any:
    """The weighted sums of some of the rates over the stages: rows of an array, or one by one."""
    used = [
        (weight, stage[first:end]) for weight, stage in zip(weights, stages, strict=False) if weight
    ]
    weight, stage = used[0]
    if isinstance(stage, np.ndarray):
        total = weight * stage
        for weight, stage in used[1:]:
            total = total + weight * stage
        return total
    found = [weight * part for part in stage]
    for weight, stage in used[1:]:
        found = [one + weight * part for one, part in zip(found, stage, strict=True)]
    return found


def _further(start: Any, width: Any, rates: Any) -> Any:
    if isinstance(rates, np.ndarray):
        return start + width * rates
    return tuple(one + width * part for one, part in zip(start, rates, strict=True))


def ending(
    vx: Any, vy: Any, turn: Any, ax: Any, ay: Any, yaw: Any, spin: Any
) -> tuple[Any, Any, Any, Any, Any, Any]:
    """The speed, how fast it falls, how fast its direction changes, and that on the vehicle; and
    whether the motion is straight from here.

    That is, whether it slides on without turning, and whether it turns on the spot.
    """
    speed = size(vx, vy, turn)
    scale = select(speed > 0.0, speed, 1.0)
    ux, uy, turning = vx / scale, vy / scale, turn / scale
    slowing = -(ux * ax + uy * ay + turning * yaw)
    off_x, off_y, off_turn = ax + slowing * ux, ay + slowing * uy, yaw + slowing * turning
    aside = size(off_x, off_y, off_turn)
    rate = speed * (turn * spin)
    drift = size(off_x + rate * uy, off_y - rate * ux, off_turn)
    straight = aside <= _STRAIGHT * larger(slowing, _SLOWEST + 0.0 * slowing)
    # Without any force it turns on for ever, on the spot or not.
    spins = (ux * ux + uy * uy <= _STRAIGHT * _STRAIGHT) | ((slowing == 0.0) & (aside == 0.0))
    slides = straight & (abs(turning) <= _STRAIGHT)
    return speed, slowing, aside, drift, slides, straight & spins
