"""The force of a tyre on the ground: what the brake holds along the wheel, and what the friction
circle leaves across it.

A wheel that is braked by a moment rolls until the brake can hold it. So the force along it is that
of the brake, but never more than the share of the friction that a locked wheel would have along
itself, the cosine of the slip angle. Across the wheel acts Fiala's side force, at most what the
circle leaves. All forces are over friction times load.
"""

from typing import Any, NamedTuple

import numpy as np

from .elementwise import greatest, least, select, share_of, within

# Of the speed of the vehicle: a wheel that moves slower counts as standing. Its force grows from
# none with its motion, so that it does not jump from side to side where a wheel is held while the
# others move; any faster wheel has its whole force.
STANDING = 2e-2
# Loads under load transfer depend on the forces, and through the brakes the forces on the loads.
_PASSES = 8
_PART = 0.75


def brake_share(lock: Any, friction: Any, here: Any, load: Any) -> Any:
    """What a brake holds, over the friction ``here`` times the load, which is over the load at
    rest; 1 or more locks the wheel.

    The moment of a brake is ``lock`` times what locks its wheel on the ground of ``friction`` at
    the load at rest, wherever the wheel is. A wheel of ``lock`` 1 does not turn at all, on any
    ground.
    """
    most = load * here
    holds = most > 0.0
    return select((lock >= 1.0) | (holds ^ True), 1.0, lock * friction / select(holds, most, 1.0))


def circle(cosine: Any, brake: Any, takes: Any = None) -> tuple[Any, Any]:
    """The force along a wheel from the cosine of its slip angle, and what the circle leaves across.

    Both are over friction times load, and so is what the rotation of the wheel ``takes`` of the
    force against the motion ahead, its mass times how fast it gains speed ahead: negative where it
    slows down.
    """
    # Negative: against the motion.
    if takes is None:
        forward = -within(cosine, brake)
    else:
        forward = -least(brake + takes, greatest(takes - brake, cosine))
        forward = within(forward, 1.0)
    return forward, greatest(1.0 - forward * forward, 0.0) ** 0.5


def rotation_takes(lock: Any, gain: Any, most: Any) -> Any:
    """What the rotation of a wheel takes of the ``most`` that the ground gives, from the mass of
    its rotation times how fast its contact gains speed ahead. A wheel of ``lock`` 1 does not turn.
    """
    return _over(select(lock >= 1.0, 0.0, gain), most)


def tyre_force(
    along: Any,
    across: Any,
    brake: Any,
    friction: Any,
    cornering: Any,
    standing: Any = STANDING,
    takes: Any = None,
) -> tuple[Any, Any]:
    """The force of a wheel along and across itself, over friction times load, from the velocity of
    its contact with the ground.

    ``along`` and ``across`` are of that velocity, in any unit, of which ``standing`` (> 0) is the
    speed below which the wheel counts as standing. ``brake`` is ``brake_share``, ``cornering`` the
    cornering stiffness over the load [1/rad]. What ``takes`` is, ``circle`` says.
    """
    side = abs(across)
    slip = _not_standing((along * along + across * across) ** 0.5, standing)
    forward, most = circle(along / slip, brake, takes)
    # Fiala: 1 at and beyond the slip angle at which the whole contact slides.
    rest = 1.0 - share_of(cornering * side, 3.0 * friction * abs(along))
    most = least(most, 1.0 - rest * rest * rest)
    return forward, -within(across / _not_standing(side, standing), most)


def _not_standing(speed: Any, standing: Any) -> Any:
    """The speed, and below ``standing`` more than that, without a kink."""
    slow = least(speed, standing)
    return greatest(speed, 0.5 * standing + (0.5 / standing) * (slow * slow))


class Tyres(NamedTuple):
    """What the forces of four tyres depend on; each ``lock`` is of front left, front right, rear
    left, rear right.

    ``ahead`` and ``left`` are half the wheelbase and half the track, ``cos`` and ``sin`` of the
    steer of the front wheels. ``over_ahead`` and ``over_left`` are height over wheelbase and over
    track. Of many vehicles, ``locks`` may have one array instead, with a row for each wheel, and so
    has whatever is of each wheel.
    """

    locks: tuple[Any, ...]
    friction: Any
    cornering: Any
    ahead: Any
    left: Any
    cos: Any = 1.0
    sin: Any = 0.0
    over_ahead: Any = 0.0
    over_left: Any = 0.0


# Ahead and left of the centre of mass, by half the wheelbase and half the track; and whether a
# wheel is steered.
CORNERS = ((1.0, 1.0, 1.0), (1.0, -1.0, 1.0), (-1.0, 1.0, 0.0), (-1.0, -1.0, 0.0))
_ROWS = (tuple(np.array(CORNERS).T[:, :, None]),)


def tyre_forces(
    tyres: Tyres,
    here: tuple[Any, ...],
    forward: Any,
    left: Any,
    turning: Any,
    standing: Any = STANDING,
    *,
    steered: bool = True,
    transfers: bool = False,
    brakes: list[Any] | None = None,
    rotation: tuple[Any, ...] | None = None,
) -> tuple[Any, Any, Any]:
    """Force ahead and to the left over the weight, and moment over the weight, of four tyres on a
    moving vehicle.

    ``forward`` and ``left`` are the velocity of the centre of mass in the axes of the vehicle,
    ``turning`` the yaw rate, in units in which ``standing`` is. ``here`` is the friction under each
    wheel. ``steered`` and ``transfers`` are settings: with False, steer and height are taken as
    none. ``brakes`` are ``brake_shares`` where they were worked out before. ``rotation`` is the
    mass that the rotation of all wheels adds over that of the vehicle, how fast the vehicle gains
    speed ahead and to the left, in its own axes, over gravity, and the same of its yaw rate.
    """
    wheels = wheel_forces(
        tyres,
        here,
        forward,
        left,
        turning,
        standing,
        steered=steered,
        transfers=transfers,
        brakes=brakes,
        rotation=rotation,
    )
    parts = []
    for (ahead, aside, _), mu, (along, across, load) in zip(
        _corners(tyres), here, wheels, strict=True
    ):
        carried = load * mu if transfers else mu
        x, y = carried * along, carried * across
        parts.append((x, y, (ahead * tyres.ahead) * y - (aside * tyres.left) * x))
    x, y, yaw = (0.25 * _sum([part[at] for part in parts]) for at in range(3))
    return x, y, yaw


def brake_shares(
    tyres: Tyres, here: tuple[Any, ...], loads: tuple[Any, ...] = (1.0, 1.0, 1.0, 1.0)
) -> list[Any]:
    """``brake_share`` of each wheel."""
    return [
        brake_share(lock, tyres.friction, mu, load)
        for lock, mu, load in zip(tyres.locks, here, loads, strict=False)
    ]


def wheel_forces(
    tyres: Tyres,
    here: tuple[Any, ...],
    forward: Any,
    left: Any,
    turning: Any,
    standing: Any = STANDING,
    *,
    steered: bool = True,
    transfers: bool = False,
    brakes: list[Any] | None = None,
    rotation: tuple[Any, ...] | None = None,
) -> list[tuple[Any, Any, Any]]:
    """For each wheel its force ahead and to the left over friction times load, and its load over
    that at rest.
    """
    corners = _corners(tyres)
    moving: list[Any] = []
    turns: list[Any] = []
    gains: list[Any] = []
    for ahead, aside, front in corners:
        ux, uy = forward - turning * (aside * tyres.left), left + turning * (ahead * tyres.ahead)
        # A rear wheel in a row with the others is turned by an angle of 0.
        turn = (
            None
            if not (steered and np.any(front))
            else (_of_front(tyres.cos, front, 1.0), _of_front(tyres.sin, front, 0.0))
        )
        turns.append(turn)
        moving.append(
            (ux, uy) if turn is None else (turn[0] * ux + turn[1] * uy, turn[0] * uy - turn[1] * ux)
        )
        if rotation is None:
            gains.append(None)
            continue
        mass, gain_x, gain_y, gain_turn = rotation
        gain = gain_x - gain_turn * (aside * tyres.left)
        if turn is not None:
            gain = turn[0] * gain + turn[1] * (gain_y + gain_turn * (ahead * tyres.ahead))
        gains.append(mass * gain)
    loads: tuple[Any, ...] = (1.0, 1.0, 1.0, 1.0)
    found: list[tuple[Any, Any]] = []
    for _ in range(_PASSES if transfers else 1):
        found = []
        shares = brake_shares(tyres, here, loads) if brakes is None else brakes
        for turn, (along, across), brake, mu, gain, load, lock in zip(
            turns, moving, shares, here, gains, loads, tyres.locks, strict=False
        ):
            takes = None if gain is None else rotation_takes(lock, gain, load * mu)
            x, y = tyre_force(along, across, brake, mu, tyres.cornering, standing, takes)
            found.append(
                (x, y) if turn is None else (turn[0] * x - turn[1] * y, turn[1] * x + turn[0] * y)
            )
        if transfers:
            pulls = zip(loads, here, found, strict=False)
            new = _loads(tyres, [(load * mu * x, load * mu * y) for load, mu, (x, y) in pulls])
            # More load on a braked wheel lets it roll more freely: the whole change would go to and
            # fro.
            loads = tuple(old + _PART * (one - old) for old, one in zip(loads, new, strict=False))
    return [(x, y, load) for (x, y), load in zip(found, loads, strict=False)]


def _over(part: Any, whole: Any) -> Any:
    """The part of a whole that is not negative; none of none."""
    some = whole > 0.0
    return select(some, part, 0.0) / select(some, whole, 1.0)


def _corners(tyres: Tyres) -> Any:
    """The wheels one by one, or all in the rows of an array."""
    return CORNERS if len(tyres.locks) == len(CORNERS) else _ROWS


def _of_front(turn: Any, front: Any, none: float) -> Any:
    """Cosine or sine of the steer, of a rear wheel that of none."""
    return np.where(front > 0.0, turn, none) if isinstance(front, np.ndarray) else turn


def _sum(parts: list[Any]) -> Any:
    """The sum over the wheels."""
    if len(parts) == 1:
        (rows,) = parts
        parts = [rows[0], rows[1], rows[2], rows[3]]
    one, two, three, four = parts
    # Left and right first: mirrored scenes come out the same to the bit.
    return (one + two) + (three + four)


def _loads(tyres: Tyres, forces: list[tuple[Any, Any]]) -> tuple[Any, ...]:
    """The loads of the wheels over those at rest, where each has this force over its load at rest:
    they keep it upright.
    """
    back, over = 2.0 * tyres.over_ahead, 2.0 * tyres.over_left
    x, y = (0.25 * _sum([force[at] for force in forces]) for at in (0, 1))
    return tuple(1.0 - ahead * back * x - aside * over * y for ahead, aside, _ in _corners(tyres))
