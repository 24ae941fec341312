"""The force of a tyre on the ground: what the brake holds along the wheel, and what the friction circle leaves across it.

A wheel that is braked by a moment rolls until the brake can hold it. So the force along it is that of the brake, but never
more than the share of the friction that a locked wheel would have along itself, the cosine of the slip angle. Across the wheel
acts Fiala's side force, at most what the circle leaves. All forces are over friction times load.
"""

from typing import Any, NamedTuple

from .elementwise import select

# Of the speed of the vehicle: a wheel that moves slower counts as standing. Its force grows from none with its motion, so that
# it does not jump from side to side where a wheel is held while the others move; any faster wheel has its whole force.
STANDING = 2e-2
# Loads under load transfer depend on the forces, and through the brakes the forces on the loads.
_PASSES = 3


def brake_share(lock: Any, friction: Any, here: Any, load: Any) -> Any:
    """What a brake holds, over the friction ``here`` times the load, which is over the load at rest; 1 or more locks the wheel.

    The moment of a brake is ``lock`` times what locks its wheel on the ground of ``friction`` at the load at rest, wherever
    the wheel is. A wheel of ``lock`` 1 does not turn at all, on any ground.
    """
    most = here * load
    holds = most > 0.0
    return select((lock >= 1.0) | (holds ^ True), 1.0, lock * friction / select(holds, most, 1.0))


def tyre_force(along: Any, across: Any, brake: Any, friction: Any, cornering: Any, standing: Any = STANDING) -> tuple[Any, Any]:
    """The force of a wheel along and across itself, over friction times load, from the velocity of its contact with the ground.

    ``along`` and ``across`` are of that velocity, in any unit, of which ``standing`` (> 0) is the speed below which the wheel
    counts as standing. ``brake`` is ``brake_share``, ``cornering`` the cornering stiffness over the load [1/rad].
    """
    side = abs(across)
    slip = _not_standing((along * along + across * across) ** 0.5, standing)
    # Negative: against the motion.
    forward = -along / slip
    forward = select(forward > brake, brake, select(forward < -brake, -brake, forward))
    left = 1.0 - forward * forward
    most = select(left > 0.0, left, 0.0) ** 0.5
    # Fiala: 1 at and beyond the slip angle at which the whole contact slides.
    steep, whole = cornering * side, 3.0 * friction * abs(along)
    sticks = steep < whole
    rest = 1.0 - steep / select(sticks, whole, 1.0)
    fiala = select(sticks, 1.0 - rest * rest * rest, 1.0)
    most = select(fiala < most, fiala, most)
    slides = side / _not_standing(side, standing)
    most = select(slides < most, slides, most)
    return forward, select(across > 0.0, -most, most)


def _not_standing(speed: Any, standing: Any) -> Any:
    """The speed, and below ``standing`` more than that, without a kink."""
    return select(speed < standing, 0.5 * (standing + speed * speed / standing), speed)


class Tyres(NamedTuple):
    """What the forces of four tyres depend on; each ``lock`` is of front left, front right, rear left, rear right.

    ``ahead`` and ``left`` are half the wheelbase and half the track, ``cos`` and ``sin`` of the steer of the front wheels.
    ``over_ahead`` and ``over_left`` are height over wheelbase and over track.
    """

    locks: tuple[Any, Any, Any, Any]
    friction: Any
    cornering: Any
    ahead: Any
    left: Any
    cos: Any = 1.0
    sin: Any = 0.0
    over_ahead: Any = 0.0
    over_left: Any = 0.0


# Ahead and left of the centre of mass, by half the wheelbase and half the track.
CORNERS = ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0))


def tyre_forces(
    tyres: Tyres,
    here: tuple[Any, Any, Any, Any],
    forward: Any,
    left: Any,
    turning: Any,
    standing: Any = STANDING,
    *,
    steered: bool = True,
    transfers: bool = False,
) -> tuple[Any, Any, Any]:
    """Force ahead and to the left over the weight, and moment over the weight, of four tyres on a moving vehicle.

    ``forward`` and ``left`` are the velocity of the centre of mass in the axes of the vehicle, ``turning`` the yaw rate, in
    units in which ``standing`` is. ``here`` is the friction under each wheel. ``steered`` and ``transfers`` are settings: with
    False, steer and height are taken as none.
    """
    moving = []
    for ahead, aside in CORNERS:
        ux, uy = forward - turning * (aside * tyres.left), left + turning * (ahead * tyres.ahead)
        turned = steered and ahead > 0.0
        moving.append((tyres.cos * ux + tyres.sin * uy, tyres.cos * uy - tyres.sin * ux) if turned else (ux, uy))
    loads: tuple[Any, ...] = (1.0, 1.0, 1.0, 1.0)
    for _ in range(_PASSES if transfers else 1):
        forces = []
        for (ahead, _), (along, across), lock, mu, load in zip(CORNERS, moving, tyres.locks, here, loads, strict=True):
            brake = brake_share(lock, tyres.friction, mu, load)
            x, y = tyre_force(along, across, brake, mu, tyres.cornering, standing)
            if steered and ahead > 0.0:
                x, y = tyres.cos * x - tyres.sin * y, tyres.sin * x + tyres.cos * y
            forces.append((mu * x, mu * y))
        if transfers:
            loads = _loads(tyres, forces)
    x, y, yaw = 0.0, 0.0, 0.0
    for (ahead, aside), (one_x, one_y), load in zip(CORNERS, forces, loads, strict=True):
        one_x, one_y = load * one_x, load * one_y
        x, y = x + one_x, y + one_y
        yaw = yaw + (ahead * tyres.ahead) * one_y - (aside * tyres.left) * one_x
    return 0.25 * x, 0.25 * y, 0.25 * yaw


def _loads(tyres: Tyres, forces: list[tuple[Any, Any]]) -> tuple[Any, ...]:
    """The loads of the wheels over those at rest, where each has this force over its load: they hold the vehicle upright."""
    back, over = 2.0 * tyres.over_ahead, 2.0 * tyres.over_left
    x, y = 0.25 * sum(one for one, _ in forces), 0.25 * sum(one for _, one in forces)
    # The forces on all four are those of these loads, which depend on them: two linear equations.
    x_ahead, y_ahead = (0.25 * sum(ahead * one[at] for one, (ahead, _) in zip(forces, CORNERS, strict=True)) for at in (0, 1))
    x_left, y_left = (0.25 * sum(aside * one[at] for one, (_, aside) in zip(forces, CORNERS, strict=True)) for at in (0, 1))
    one, two, three, four = 1.0 + back * x_ahead, over * x_left, back * y_ahead, 1.0 + over * y_left
    size = one * four - two * three
    x, y = (four * x - two * y) / size, (one * y - three * x) / size
    return tuple(1.0 - ahead * back * x - aside * over * y for ahead, aside in CORNERS)
