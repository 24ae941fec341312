"""Other velocities before that fit a balance of momentum too, where tyres act on a vehicle so slow
that their force turns with what is sought.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..impact.inputs import part_of
from ..vehicle.drag import GRAVITY
from .lasting import settle
from .momentum_tyres import PASSED_AT_HALF, Lasting, what_is_sought

if TYPE_CHECKING:
    from .momentum_solution import MomentumSolution

# Of what the tyres of a vehicle can change of its velocity: where all wheels are faster than the
# first all the while, a change of the velocity moves their impulse by less than itself, and there
# is one answer (the side force grows by 9.5 times a slip angle, and 1 / 6 + 0.71 * 4 / 6 of the
# weight of Simpson's rule moves with the velocity before). Two answers nearer than the second are
# one.
_FAST, _ONE_ANSWER = 8.0, 1e-3
# Where it is begun: parts of twice what the tyres can change, as no answers are farther apart, and
# directions.
_PARTS, _DIRECTIONS = (0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0), 16
# And then between the answer and the farthest other.
_BETWEEN = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)


class Other(NamedTuple):
    """Other velocities that fit, and how far they are from the answer: for each case from the
    farthest on, and NaN beyond the last. The first axis is that of the velocities.
    """

    speed: Any
    course: Any
    apart: Any

    def sentence(self, solution: MomentumSolution, say: Callable[[float, str], str]) -> str:
        """What it says, of a batch of the case where it is farthest; ``say`` writes a number of a
        kind, "speed" or "angle".
        """
        at = int(np.nanargmax(self.apart[0]))
        (name, angle) = solution.unknowns
        found = [
            f"{name} = {say(float(speed), 'speed')} with {angle} = {say(float(course), 'angle')}, "
            f"which is {say(float(apart), 'speed')} away"
            for speed, course, apart in zip(
                *(value.reshape(len(value), -1)[:, at] for value in self), strict=True
            )
            if np.isfinite(apart)
        ]
        fit = "another velocity fits" if len(found) == 1 else "other velocities fit"
        return (
            f"the tyres of {name[-1].upper()} can hold or turn a vehicle so slow, and {fit} too: "
            f"{'; '.join(found)}; momentum does not tell which of them it was, and other evidence "
            "has to"
        )


def other_velocity(solution: MomentumSolution) -> Other | None:
    """The velocities before that fit too; None where none is found.

    It is looked for where the velocity sought is that of one vehicle before, whole: what friction
    takes grows with a velocity after, so that one alone fits.
    """
    name = solution.unknowns[0]
    label = name[-1]
    if what_is_sought(solution) != "velocity" or name.endswith("after"):
        return None
    if label not in solution.tyres:
        return None
    named, most, slow = _slow(solution, label)
    shape = np.broadcast_shapes(np.shape(solution.status), np.shape(solution.speed_a))
    where = np.flatnonzero(np.broadcast_to(slow, shape))
    if not where.size:
        return None

    def take(value: Any) -> Any:
        return np.broadcast_to(np.asarray(value, np.float64), shape).ravel()[where]

    lasting = Lasting(
        take(solution.duration),
        {label: part_of(solution.tyres[label], take)},
        {label: take(named["yaw_rate_after"])},
    )
    x, y, apart = _others(
        lasting, label, {part: take(value) for part, value in named.items()}, take(most)
    )
    if not np.any(apart > 0.0):
        return None
    there = apart > 0.0

    def whole(value: Any) -> Any:
        made = np.full((len(apart), math.prod(shape)), np.nan)
        made[:, where] = np.where(there, value, np.nan)
        return made.reshape(-1, *shape)

    return Other(whole(np.hypot(x, y)), whole(np.arctan2(y, x)), whole(apart))


def tyres_may_turn(solution: MomentumSolution) -> bool:
    """Whether, beside the speed of another, the course is sought of a vehicle that is so slow
    before that other courses may fit, which are not looked for.
    """
    course = solution.unknowns[1]
    label = course.split("_")[1]
    if what_is_sought(solution) != "beside" or course.endswith("after"):
        return False
    return label in solution.tyres and bool(np.any(_slow(solution, label)[2]))


def _slow(solution: MomentumSolution, label: str) -> tuple[dict[str, Any], Any, Any]:
    """Numbers of the motion of a vehicle, what its tyres can change of its velocity, and where it
    is so slow that their force turns with its velocity before.
    """
    tyres = solution.tyres[label]
    parts = ("speed", "course", "mass", "heading", "tyre_impulse_x", "tyre_impulse_y")
    named = {part: getattr(solution, f"{part}_{label}") for part in parts}
    for part in ("speed", "course", "yaw_rate"):
        value = getattr(solution, f"{part}_{label}_after")
        named[f"{part}_after"] = 0.0 if value is None else value
    # Refused cases of a batch are looked at like all others.
    with np.errstate(all="ignore"):
        most = GRAVITY * tyres.friction * solution.duration
        after = _velocity(named["speed_after"], named["course_after"])
        found = _velocity(named["speed"], named["course"])
        half = np.hypot(
            *(was + PASSED_AT_HALF * (now - was) for was, now in zip(found, after, strict=True))
        )
        # Half-way through the contact the wheels move with the turning of the vehicle too.
        arm = np.hypot(tyres.wheelbase, tyres.track)
        turning = PASSED_AT_HALF * abs(named["yaw_rate_after"]) * arm
        slow = np.minimum(named["speed"], half - turning) < _FAST * most
    return named, most, slow


def _others(lasting: Lasting, label: str, of: dict[str, Any], most: Any) -> tuple[Any, Any, Any]:
    """Velocities before of the other answers of each case from the farthest on, and how far they
    are; 0 beyond the last.
    """
    before, after = f"speed_{label}", f"speed_{label}_after"
    found = _velocity(of["speed"], of["course"])
    left = _velocity(of["speed_after"], of["course_after"])
    push = of["tyre_impulse_x"], of["tyre_impulse_y"]

    def missed(values: Any) -> list[Any]:
        pushes = lasting.impulses(
            {label: of["mass"]},
            {label: of["heading"]},
            {before: tuple(values), after: left},
            single=False,
        )[label]
        return [
            (value - one + (now - was) / of["mass"]) / most
            for value, one, now, was in zip(values, found, pushes, push, strict=True)
        ]

    angles = 2.0 * math.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    aside = [
        np.concatenate([2.0 * part * turn(angles) for part in _PARTS])[:, None] * most
        for turn in (np.cos, np.sin)
    ]
    # And where it stands before, or half-way through.
    still = -PASSED_AT_HALF / (1.0 - PASSED_AT_HALF)
    start = [
        np.concatenate((one + away, np.zeros((1, one.size)), still * end[None]))
        for one, away, end in zip(found, aside, left, strict=True)
    ]
    (x, y), settled = settle(missed, start, [most, most])
    apart = np.hypot(x - found[0], y - found[1])
    apart = np.where(settled & (apart > _ONE_ANSWER * most), apart, 0.0)
    if np.any(apart > 0.0):
        # Of three that fit, the one between is hard to reach from outside.
        best = np.argmax(apart, axis=0)[None]
        ends = [np.take_along_axis(part, best, axis=0) for part in (x, y)]
        parts = np.array(_BETWEEN)[:, None]
        start = [one + parts * (end - one) for one, end in zip(found, ends, strict=True)]
        more, reached = settle(missed, start, [most, most])
        x, y = (np.concatenate(both) for both in zip((x, y), more, strict=True))
        settled = np.concatenate((settled, reached & np.any(apart > 0.0, axis=0)))
        apart = np.hypot(x - found[0], y - found[1])
        apart = np.where(settled & (apart > _ONE_ANSWER * most), apart, 0.0)
    for i in range(1, len(x)):  # what was found from several starts is one
        again = np.hypot(x[:i] - x[i], y[:i] - y[i]) <= _ONE_ANSWER * most
        apart[i] = np.where(np.any(again & (apart[:i] > 0.0), axis=0), 0.0, apart[i])
    order = np.argsort(-apart, axis=0, kind="stable")
    x, y, apart = (np.take_along_axis(part, order, axis=0) for part in (x, y, apart))
    count = max(1, int(np.max(np.count_nonzero(apart, axis=0))))
    return x[:count], y[:count], apart[:count]


def _velocity(speed: Any, course: Any) -> tuple[Any, Any]:
    return speed * np.cos(course), speed * np.sin(course)
