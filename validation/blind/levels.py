"""The levels at which the library predicts a crash. A further level is one more function in LEVELS.

Each takes the numbers of a case (arrays, SI) and returns an impact; what is read from it is in
``outputs``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import collisions as col
from collisions.reference import ROLLING_RESISTANCE
from collisions.travel import Tyres
from collisions.uncertainty import Distribution, Uniform

Numbers = dict[str, Any]

WHEELS: dict[str, Distribution] = {
    # Guess: a dry road, that of `contact_in_time.toml` in the middle. Both cars stand on it.
    "wheels.friction": Uniform("0.6", "0.8"),
    # Guess, any value alike: from rolling freely, by the library's own rolling resistance over that
    # friction, to locked, as in `contact_in_time.toml`. No input says how the cars were braked.
    "wheels.lock_a": Uniform(repr(round(ROLLING_RESISTANCE.low / 0.7, 3)), "1"),
    "wheels.lock_b": Uniform(repr(round(ROLLING_RESISTANCE.low / 0.7, 3)), "1"),
    # Guess: no input has them. From the smallest car here, a Civic, to the largest, a Torino.
    "wheels.wheelbase_a": Uniform("2.2 m", "3 m"),
    "wheels.wheelbase_b": Uniform("2.2 m", "3 m"),
    # Guess: both sides of a car of 1.6 to 2 m over all.
    "wheels.track_a": Uniform("1.3 m", "1.6 m"),
    "wheels.track_b": Uniform("1.3 m", "1.6 m"),
}
"""What wheels on the ground need beyond the inputs that were fixed: the same for every crash.

It was written after the measurements had been read, and was chosen by none of them.
"""


def vehicles(numbers: Numbers) -> tuple[col.Vehicle, col.Vehicle]:
    """Both vehicles, just before the impact."""

    def vehicle(side: str) -> col.Vehicle:
        own = {
            name: numbers[f"{side}.{name}"] for name in ("mass", "yaw_inertia", "heading", "x", "y")
        }
        speed, course = numbers[f"{side}.speed"], numbers[f"{side}.course"]
        return col.Vehicle(**own, vx=speed * np.cos(course), vy=speed * np.sin(course))

    return vehicle("a"), vehicle("b")


def contact(numbers: Numbers) -> dict[str, Any]:
    """Restitution and contact, the same at every level."""
    return {
        "restitution": numbers["eccentric.restitution"],
        "normal": numbers["eccentric.normal"],
        "point": (numbers["eccentric.point.0"], numbers["eccentric.point.1"]),
        "friction": numbers["eccentric.friction"],
    }


def impact(numbers: Numbers) -> col.Impact:
    """An instant: ``eccentric``, without tyres."""
    return col.eccentric(*vehicles(numbers), **contact(numbers), on_failure="nan")


def wheels(numbers: Numbers, side: str) -> Tyres:
    """The wheels of a vehicle, all four braked alike."""
    own = (numbers[f"wheels.{name}_{side}"] for name in ("lock", "wheelbase", "track"))
    return Tyres(numbers["wheels.friction"], *own)


def impact_with_tyres(numbers: Numbers) -> col.Impact:
    """An instant: ``eccentric``, with the impulse of the tyres for as long as the contact lasts."""
    return col.eccentric(
        *vehicles(numbers),
        **contact(numbers),
        duration=numbers["contact_in_time.duration"],
        tyres_a=wheels(numbers, "a"),
        tyres_b=wheels(numbers, "b"),
        on_failure="nan",
    )


def contact_in_time(numbers: Numbers) -> col.Impact:
    """A contact that lasts: ``time_resolved``, with one drag for all wheels; 50 steps are exact to
    1e-3 of delta-V.
    """
    return col.time_resolved(
        *vehicles(numbers),
        **contact(numbers),
        duration=numbers["contact_in_time.duration"],
        drag=numbers["contact_in_time.drag"],
        steps=50,
        on_failure="nan",
    )


@dataclass(frozen=True)
class Level:
    """How an impact is computed, of how many cases its ranges are made, the numbers that it takes
    (by name, or all of a table), and what it needs beyond the inputs of a case.
    """

    solve: Callable[[Numbers], col.Impact]
    samples: int
    tables: tuple[str, ...] = ("a", "b", "eccentric")
    beyond: dict[str, Distribution] = field(default_factory=dict)

    def numbers(self, stated: Numbers) -> Numbers:
        """Those numbers of a case that this level takes."""
        taken = {
            name: value
            for name, value in stated.items()
            if name in self.tables or name.partition(".")[0] in self.tables
        }
        return taken | self.beyond


LEVELS = {
    "impact": Level(impact, 4096),
    "impact with tyres": Level(
        impact_with_tyres, 4096, ("a", "b", "eccentric", "contact_in_time.duration"), WHEELS
    ),
    "contact in time": Level(contact_in_time, 1024, ("a", "b", "eccentric", "contact_in_time")),
}


def kinetic_energy(vehicle: col.Vehicle) -> Any:
    """Translation and yaw [J]."""
    speed2 = np.square(vehicle.vx) + np.square(vehicle.vy)
    return 0.5 * (vehicle.mass * speed2 + vehicle.yaw_inertia * np.square(vehicle.yaw_rate))


def outputs(found: col.Impact) -> dict[str, Any]:
    """What is compared with measurements, in SI, for the axes of the library."""
    result: dict[str, Any] = {}
    for name, side in (("a", found.a), ("b", found.b)):
        before, after = side.before, side.after
        along, across = np.cos(before.heading), np.sin(before.heading)
        dvx, dvy = after.vx - before.vx, after.vy - before.vy
        result[f"delta_v_{name}"] = side.delta_v
        result[f"delta_v_forward_{name}"] = dvx * along + dvy * across
        result[f"delta_v_left_{name}"] = dvy * along - dvx * across
        result[f"yaw_rate_{name}"] = after.yaw_rate
    lost = [kinetic_energy(side.before) - kinetic_energy(side.after) for side in (found.a, found.b)]
    result["energy_lost"] = lost[0] + lost[1]
    return result
