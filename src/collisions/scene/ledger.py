"""What the ground takes on the way: the power of the tyres, of a drag and of a slope at the states
of a track, and where tyres leave marks.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..kernels.tyre import wheel_forces
from ..travel.areas import Areas
from ..vehicle.drag import gravity_on
from ..vehicle.tyres import Tyres, kernel_numbers
from .motion import Ground
from .mover import Mover

# A tyre that uses this share of the friction leaves a mark.
_MARKS = 0.9
_WHEELS = ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0))


def on_tyres(tyres: Tyres, mover: Mover, ground: Ground, state: Any) -> tuple[Any, Any]:
    """The power that tyres take [W] and the marks, (4, 2, moments), at the states of one case."""
    numbers = {name: np.full(state.shape[1], value) for name, value in tyres.named.items()}
    own = kernel_numbers(numbers, np)
    x, y, heading, vx, vy, turn = state
    c, s = np.cos(heading), np.sin(heading)
    forward, left = c * vx + s * vy, c * vy - s * vx
    ahead = np.array([one * own.ahead for one, _ in _WHEELS])
    aside = np.array([two * own.left for _, two in _WHEELS])
    px, py = x + c * ahead - s * aside, y + s * ahead + c * aside
    here: Any = [own.friction] * 4
    if ground.surfaces:
        count = state.shape[1]
        areas = Areas(
            [np.array(corners) for corners, _ in ground.surfaces],
            np.array([np.full(count, friction) for _, friction in ground.surfaces]),
            own.friction,
            np.zeros((2, count)),
            np.ones(count),
            ahead,
            aside,
        )
        here = list(areas.friction_at(px, py))
    reach = np.hypot(own.ahead, own.left)
    speed = np.sqrt(vx * vx + vy * vy + (turn * reach) ** 2)
    scale = np.where(speed > 0.0, speed, 1.0)
    wheels = wheel_forces(
        own,
        tuple(here),
        forward / scale,
        left / scale,
        turn / scale,
        steered=tyres.steered,
        transfers=tyres.transfers,
    )
    power = np.zeros(state.shape[1])
    marks = np.full((4, 2, state.shape[1]), np.nan)
    weight = 0.25 * mover.vehicle.mass * gravity_on(*ground.slope)
    for at, (along, across, load) in enumerate(wheels):
        pull = load * here[at] * weight
        power -= pull * (along * (forward - turn * aside[at]) + across * (left + turn * ahead[at]))
        slides = (np.hypot(along, across) >= _MARKS) & (speed > 0.0)
        marks[at] = np.where(slides, np.array([px[at], py[at]]), np.nan)
    return power, marks


def on_drag(mover: Mover, ground: Ground, state: Any, slowing: float) -> Any:
    """The power that a drag takes of one case [W], the yaw included, which falls as the speed
    does.
    """
    body = mover.vehicle
    _, _, _, vx, vy, turn = state
    speed = np.hypot(vx, vy)
    power = body.mass * gravity_on(*ground.slope) * mover.drag * speed
    if np.any(turn != 0.0) and slowing > 0.0:
        rate = np.where(speed > 0.0, slowing / np.where(speed > 0.0, speed, 1.0), 0.0)
        power = power + body.yaw_inertia * turn * turn * rate
    return power


def on_slope(mover: Mover, ground: Ground, state: Any) -> Any:
    """The power that climbing takes of one case [W]."""
    climbs = ground.slope[0] * state[3] + ground.slope[1] * state[4]
    return mover.vehicle.mass * gravity_on(*ground.slope) * climbs
