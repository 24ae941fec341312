"""The drag of each segment of a path, and what the rotation of its wheels adds to the mass."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from ..kernels.elementwise import select
from ..kernels.tyre import circle, rotation_takes, wheel_forces
from ..quantities.attributes import hypot, math_or_numpy
from ..vehicle.tyres import Tyres, kernel_numbers

# What the rotation takes follows from how fast the vehicle slows, and that from what it takes; each
# pass leaves at most a share of the error that is that of the rotation in the mass.
_PASSES = 8


class Leg(NamedTuple):
    """A segment: its friction, lock (of wheels that are not told apart) and grade, the cosine and
    sine of its crab angle, and the turn per way, which is all that the slip of the wheels needs.
    """

    friction: Any
    lock: Any
    grade: Any
    cosine: Any
    sine: Any
    turning: Any


class Wheels(NamedTuple):
    """The wheels of a vehicle: four with their numbers, or None where all are as one, of the lock
    of each segment; and what their rotation adds to the mass, None for nothing.
    """

    four: tuple[Tyres, dict[str, Any]] | None
    rotating: Any

    def drag(self, leg: Leg) -> Any:
        """The drag of a segment: the force of the ground against the motion over the weight."""
        drag = self._drag(leg, None)
        if self.rotating is not None:
            slowing = drag + leg.grade
            for _ in range(_PASSES):
                drag = self._drag(leg, slowing)
                slowing = slowing + (drag + leg.grade - slowing) / (1.0 + self.rotating)
        return drag

    def heavier(self, legs: Sequence[Leg], drags: Sequence[Any]) -> list[Any]:
        """For each segment a factor of the square of the speed, 1 in the last, with which it does
        not jump between them.

        The energy of wheels that turn before and after goes on. That of a wheel that locks is taken
        by its brake. What the ground gives to a wheel that is released is left out, as in
        ``simulate``.
        """
        if self.rotating is None:
            return [1.0] * len(legs)
        found: list[Any] = [1.0]
        gains = [drag + leg.grade for drag, leg in zip(drags, legs, strict=True)]
        turn = [self._turn(leg, gain) for leg, gain in zip(legs, gains, strict=True)]
        for i in range(len(legs) - 2, -1, -1):
            both = [before & after for before, after in zip(turn[i], turn[i + 1], strict=True)]
            on = self._share(both)
            before, after = 1.0 + on * legs[i].cosine ** 2, 1.0 + on * legs[i + 1].cosine ** 2
            found.append(found[-1] * before / after)
        return found[::-1]

    def _share(self, turn: Sequence[Any]) -> Any:
        """What the wheels that turn add to the mass."""
        return self.rotating * sum(select(one, 1.0, 0.0) for one in turn) / len(turn)

    def _drag(self, leg: Leg, slowing: Any) -> Any:
        wheels = self._forces(leg, slowing)
        x, y = (
            leg.friction * sum(wheel[at] * wheel[2] for wheel in wheels) / len(wheels)
            for at in (0, 1)
        )
        return y * leg.sine - x * leg.cosine

    def _turn(self, leg: Leg, slowing: Any) -> list[Any]:
        """Of each wheel whether it turns: a brake without limit would do no more to one that is
        locked.
        """
        wheels = self._forces(leg, slowing)
        locked = self._forces(leg, slowing, brake=math.inf)
        return [one[0] != other[0] for one, other in zip(wheels, locked, strict=True)]

    def _forces(self, leg: Leg, slowing: Any, brake: Any = None) -> list[tuple[Any, Any, Any]]:
        """For each wheel its force ahead and to the left over friction times load, and its load
        over that at rest, of a vehicle whose whole motion is slowed by ``slowing`` over gravity.
        """
        mu, cosine, sine = leg.friction, leg.cosine, leg.sine
        gain = None if slowing is None else -self.rotating * slowing
        if self.four is None:
            takes = None if gain is None else rotation_takes(leg.lock, gain * cosine, mu)
            along, across = circle(cosine, leg.lock if brake is None else brake, takes)
            return [(along, select(sine < 0.0, -across, across), 1.0)]
        tyres, flat = self.four
        numbers = kernel_numbers(flat, math_or_numpy(cosine, leg.turning, mu, *flat.values()))
        around = leg.turning * hypot(numbers.ahead, numbers.left)
        speed = (1.0 + around * around) ** 0.5
        motion = cosine, -sine, leg.turning
        return wheel_forces(
            numbers,
            (mu, mu, mu, mu),
            *(part / speed for part in motion),
            steered=tyres.steered,
            transfers=tyres.transfers,
            brakes=None if brake is None else [brake] * 4,
            rotation=None if gain is None else (gain, *motion),
        )


def legs_of(
    frictions: Sequence[Any],
    locks: Sequence[Any],
    grades: Sequence[Any],
    crabs: Sequence[Any],
    turns: Sequence[Any],
    lengths: Sequence[Any],
) -> list[Leg]:
    """The segments, from what is of each."""
    return [
        Leg(
            mu,
            lock,
            grade,
            math_or_numpy(crab).cos(crab),
            math_or_numpy(crab).sin(crab),
            turn / select(length > 0.0, length, math.nan),
        )
        for mu, lock, grade, crab, turn, length in zip(
            frictions, locks, grades, crabs, turns, lengths, strict=True
        )
    ]
