"""Four wheels on the ground: the forces of their tyres, and the motion of the vehicle integrated
until it ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..quantities.attributes import hypot
from ..vehicle.drag import GRAVITY

# Speeds of a wheel over the ground, of that of the vehicle, below which its force falls to none: no
# force jumps where a wheel stands still while the others move.
_STANDING = 1e-3
# Once the motion is down to this part of the first, it goes on straight: what is left of the way is
# below its square.
_ENDING = 1e-3
_TOLERANCE = 1e-6
_LONGEST_STEP = 0.25
# Shorter steps are of a motion that cannot be followed, such as an immense spin.
_SHORTEST_STEP = 1e-9
_MOST_STEPS = 10_000

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


class Wheels(NamedTuple):
    """What the forces depend on; arrays of (4, cases) for the wheels, of (cases,) for the vehicle.

    Wheels are front left, front right, rear left, rear right; ``cos`` and ``sin`` are of their
    steer, ``reach`` is the distance of the wheels from the centre of mass, ``gyration`` mass over
    yaw inertia, ``areas`` pairs of corners and friction.
    """

    ahead: Any
    left: Any
    cos: Any
    sin: Any
    lock: Any
    friction: Any
    cornering: Any
    reach: Any
    gyration: Any
    areas: Sequence[tuple[Any, Any]]

    def of(self, which: Any) -> Wheels:
        """Those of some of the cases."""
        return Wheels._make(
            [
                *(part[..., which] for part in self[:-1]),
                [(corners, mu[which]) for corners, mu in self.areas],
            ]
        )

    def places(self, x: Any, y: Any, c: Any, s: Any) -> tuple[Any, Any]:
        """Where the wheels are in the scene, from the cosine and sine of the heading."""
        return x + c * self.ahead - s * self.left, y + s * self.ahead + c * self.left

    def forces(
        self, vx: Any, vy: Any, turning: Any, x: Any, y: Any, heading: Any
    ) -> tuple[Any, Any, Any]:
        """Along and across the vehicle, each over the load of the wheel, and the share of the
        friction that is used.

        Only the direction of the motion counts: velocities are over a speed, ``turning`` is the yaw
        rate over it.
        """
        c, s = np.cos(heading), np.sin(heading)
        ux, uy = c * vx + s * vy - turning * self.left, c * vy - s * vx + turning * self.ahead
        along, across = self.cos * ux + self.sin * uy, self.cos * uy - self.sin * ux
        friction = self._friction(x, y, c, s)
        least = _STANDING * _STANDING
        squares = along * along
        braked = self.lock * self.lock * squares + least
        side = np.abs(across)
        # Of the forces in the ellipse the one that works most against the slip, and no more across
        # than a tyre that rolls.
        slip = np.minimum(
            self.cornering * side / (3.0 * np.maximum(friction, 1e-300) * np.sqrt(squares + least)),
            1.0,
        )
        used = np.minimum(side / np.sqrt(side * side + braked), 1.0 - (1.0 - slip) ** 3)
        forward = -self.lock * np.sqrt(1.0 - used * used) * (self.lock * along / np.sqrt(braked))
        sideways = -np.sign(across) * used
        force_x = friction * (self.cos * forward - self.sin * sideways)
        force_y = friction * (self.sin * forward + self.cos * sideways)
        return force_x, force_y, hypot(forward, sideways)

    def _friction(self, x: Any, y: Any, c: Any, s: Any) -> Any:
        """The friction under each wheel: of the first area that holds it."""
        if not self.areas:
            return self.friction
        px, py = self.places(x, y, c, s)
        friction = np.broadcast_to(self.friction, px.shape)
        for corners, mu in reversed(self.areas):
            inside = np.zeros(px.shape, dtype=bool)
            for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
                if y0 != y1:
                    inside ^= ((y0 > py) != (y1 > py)) & (
                        px < x0 + (x1 - x0) * ((py - y0) / (y1 - y0))
                    )
            friction = np.where(inside, mu, friction)
        return friction

    def rates(self, state: Any) -> Any:
        """The state over the scaled time: seconds times GRAVITY over the speed, in which the end of
        a motion is regular.

        The state is velocity, yaw rate times reach, position, heading, time. Forces depend on the
        direction of the motion alone, so that a motion fades without end in the scaled time, at a
        rate that stays what it is.
        """
        vx, vy, turn, x, y, heading, _ = state
        speed = size(state)
        scale = np.where(speed > 0.0, speed, 1.0)
        force_x, force_y, _ = self.forces(
            vx / scale, vy / scale, turn / scale / self.reach, x, y, heading
        )
        yaw = np.mean(self.ahead * force_y - self.left * force_x, axis=0)
        force_x, force_y = np.mean(force_x, axis=0), np.mean(force_y, axis=0)
        c, s = np.cos(heading), np.sin(heading)
        pace = speed / GRAVITY
        return np.array(
            [
                speed * (c * force_x - s * force_y),
                speed * (s * force_x + c * force_y),
                speed * self.reach * self.gyration * yaw,
                pace * vx,
                pace * vy,
                pace * turn / self.reach,
                pace,
            ]
        )


def size(state: Any) -> Any:
    """The speed of the motion: of the centre of mass, and of the wheels about it."""
    return hypot(hypot(state[0], state[1]), state[2])


def integrate(wheels: Wheels, state: Any, limit: Any) -> tuple[Any, Any]:
    """States and accelerations at every step, until each case is at rest or beyond the limit of
    time.

    Where a case has no step any more, its last state is repeated.
    """
    start = size(state)
    state = state.copy()
    width = np.full(start.shape, 0.05)
    slope = wheels.rates(state)
    states, slopes = [state.copy()], [slope / np.where(slope[6] > 0.0, slope[6], 1.0)]
    going = np.flatnonzero(start > 0.0)
    for _ in range(_MOST_STEPS):
        if not len(going):
            break
        some, now, h = wheels.of(going), state[:, going], width[going]
        stages = [slope[:, going]]
        for weights in _STAGES:
            new = now + h * sum(
                weight * stage for weight, stage in zip(weights, stages, strict=False) if weight
            )
            stages.append(some.rates(new))
        error = h * sum(
            weight * stage for weight, stage in zip(_ERRORS, stages, strict=True) if weight
        )
        # Against the speed that is left: what a motion comes to depends on its direction to the
        # last.
        wrong = np.max(np.abs(error[:3]), axis=0) / size(now) + np.abs(error[5])
        good = wrong <= _TOLERANCE
        width[going] = np.minimum(
            h * np.clip(0.9 * (_TOLERANCE / np.maximum(wrong, 1e-300)) ** 0.2, 0.2, 4.0),
            _LONGEST_STEP,
        )
        done = going[good]
        state[:, done], slope[:, done] = new[:, good], stages[-1][:, good]
        over = np.zeros(start.shape, dtype=bool)
        over[done] = size(state[:, done]) <= _ENDING * start[done]
        for i in np.flatnonzero(over):
            _come_to_rest(state[:, i], slope[:, i])
        states.append(state.copy())
        slopes.append(slope / np.where(slope[6] > 0.0, slope[6], 1.0))
        going = going[
            ~over[going] & (state[6, going] < limit[going]) & (width[going] > _SHORTEST_STEP)
        ]
    return np.array(states), np.array(slopes)


def _come_to_rest(state: Any, slope: Any) -> None:
    """Ends the motion of one case: what is left of it goes on straight, slowed by the same force,
    if any slows it.
    """
    speed = size(state)
    slowing = -float(np.dot(state[:3] / speed, slope[:3])) / speed  # in the scaled time
    if slowing > 0.0:
        state[3:6] += 0.5 * slope[3:6] / slowing
        state[6] += slope[6] / slowing
        state[:3] = 0.0
