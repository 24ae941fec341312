"""What the ground takes on the way: the power of the tyres, of a drag and of a slope at the states
of a track, and where tyres leave marks.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..impact.inputs import part_of
from ..kernels.tyre import Tyres as Numbers
from ..kernels.tyre import brake_share, wheel_forces
from ..quantities.settings import in_si
from ..travel.areas import Areas
from ..travel.simulate import MARKS
from ..vehicle.drag import gravity_on
from ..vehicle.tyres import Tyres, kernel_numbers
from .motion import Ground
from .mover import Mover

# A vehicle slower than this [m/s] stands: what is left of its speed at rest is rounding.
_STANDS = 1e-9
_WHEELS = ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0))


class OnTyres(NamedTuple):
    """What tyres do at some states: the power that they take [W], where the wheels are [m], (4, 2,
    ...), and the share of the friction that each uses, (4, ...), 0 of a vehicle at rest.
    """

    power: Any
    places: Any
    use: Any

    @property
    def marks(self) -> Any:
        """Where the wheels are while they leave marks; NaN elsewhere."""
        return np.where(self.use[:, None] >= MARKS, self.places, np.nan)


class _Wheels(NamedTuple):
    """The numbers of tyres, where the four wheels are on the vehicle and in the scene [m], (4,
    ...), and the friction under each.
    """

    own: Numbers
    ahead: Any
    aside: Any
    px: Any
    py: Any
    here: list[Any]


def _wheels(tyres: Tyres, ground: Ground, state: Any, take: Any) -> _Wheels:
    count = state.shape[1]
    own = kernel_numbers({name: take(value) for name, value in tyres.named.items()}, np)
    x, y, heading, *_ = state
    c, s = np.cos(heading), np.sin(heading)
    ahead = np.array([one * own.ahead for one, _ in _WHEELS])
    aside = np.array([two * own.left for _, two in _WHEELS])
    px, py = x + c * ahead - s * aside, y + s * ahead + c * aside
    here: Any = [own.friction] * 4
    if ground.surfaces:
        areas = Areas(
            [np.array(corners) for corners, _ in ground.surfaces],
            np.array([take(friction) for _, friction in ground.surfaces]),
            own.friction,
            np.zeros((2, count)),
            np.ones(count),
            ahead,
            aside,
        )
        here = list(areas.friction_at(px, py))
    return _Wheels(own, ahead, aside, px, py, here)


def tyres_where_they_are(tyres: Tyres, ground: Ground, state: Any, cases: Any) -> tuple[Tyres, Any]:
    """Tyres on the ground that is under their wheels at these states, (6, cases), of one friction:
    where it is not the same under all four, their mean; and in which cases that is so.
    """
    take = ground.taker(cases)
    own, *_, here = _wheels(tyres, ground, state, take)
    taken = tyres if ground.single else part_of(tyres, take)
    rows = np.array([np.broadcast_to(mu, len(cases)) for mu in here])
    mixed = np.ptp(rows, axis=0) > 0.0
    friction = np.where(mixed, np.mean(rows, axis=0), rows[0])
    if np.all(friction == own.friction):
        return taken, mixed
    # A brake holds its moment, so that on ice it locks the wheel.
    locks = [np.minimum(brake_share(lock, own.friction, friction, 1.0), 1.0) for lock in own.locks]
    numbers = [friction, *(np.broadcast_to(lock, len(cases)) for lock in locks)]
    if ground.single:
        numbers = [float(number[0]) for number in numbers]
    with in_si():
        return taken.replace(friction=numbers[0], lock=numbers[1:]), mixed


def tyres_in_part(tyres: Tyres, share: Any) -> Tyres:
    """Tyres whose forces are this share of their own, at every slip."""
    # Fiala's force at a small slip angle is that of the cornering alone, which stays above 0.
    cornering = np.where(share > 0.0, share * tyres.cornering, tyres.cornering)
    with in_si():
        return tyres.replace(
            friction=share * tyres.friction,
            cornering=cornering if np.ndim(cornering) else float(cornering),
        )


def on_tyres(tyres: Tyres, mover: Mover, ground: Ground, state: Any, cases: Any = None) -> OnTyres:
    """What tyres do at the states of one case, (6, moments), or of those of a batch."""
    count = state.shape[1]
    take = ground.taker(np.zeros(count, dtype=int) if cases is None else cases)
    own, ahead, aside, px, py, here = _wheels(tyres, ground, state, take)
    _, _, heading, vx, vy, turn = state
    c, s = np.cos(heading), np.sin(heading)
    forward, left = c * vx + s * vy, c * vy - s * vx
    reach = np.hypot(own.ahead, own.left)
    speed = np.sqrt(vx * vx + vy * vy + (turn * reach) ** 2)
    moves = speed > _STANDS
    scale = np.where(moves, speed, 1.0)
    wheels = wheel_forces(
        own,
        tuple(here),
        forward / scale,
        left / scale,
        turn / scale,
        steered=tyres.steered,
        transfers=tyres.transfers,
    )
    power, use = np.zeros(count), np.empty((4, count))
    weight = 0.25 * take(mover.vehicle.mass) * gravity_on(ground.rises(take))
    for at, (along, across, load) in enumerate(wheels):
        pull = load * here[at] * weight
        power -= pull * (along * (forward - turn * aside[at]) + across * (left + turn * ahead[at]))
        use[at] = np.where(moves, np.hypot(along, across), 0.0)
    # At rest they take nothing, also of a vehicle whose heading is not known.
    power = np.where(moves, power, 0.0)
    return OnTyres(power, np.array([px, py]).swapaxes(0, 1), use)


def on_drag(mover: Mover, ground: Ground, state: Any, slowing: float) -> Any:
    """The power that a drag takes of one case [W], the yaw included, which falls as the speed
    does.
    """
    body = mover.vehicle
    _, _, _, vx, vy, turn = state
    speed = np.hypot(vx, vy)
    power = body.mass * gravity_on(ground.slope) * mover.drag * speed
    if np.any(turn != 0.0) and slowing > 0.0:
        rate = np.where(speed > 0.0, slowing / np.where(speed > 0.0, speed, 1.0), 0.0)
        power = power + body.yaw_inertia * turn * turn * rate
    return power


def on_slope(mover: Mover, ground: Ground, state: Any) -> Any:
    """The power that climbing takes of one case [W]."""
    climbs = ground.slope[0] * state[3] + ground.slope[1] * state[4]
    return mover.vehicle.mass * gravity_on(ground.slope) * climbs
