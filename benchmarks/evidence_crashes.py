"""Simulated crashes whose truth is known, and what is read of them: surveys, recorders, damage,
each with its errors.
"""

from __future__ import annotations

import math
import sys
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "src"))

import collisions as col
from collisions import reconstruct, reference, travel
from collisions.travel import SimulatedPath
from collisions.uncertainty import Normal

# What an analyst knows of every crash beforehand; the truth is drawn from it. Each in SI.
RESTITUTION, FRICTION = (
    Normal(0.12, 0.06, truncate=(0.0, 0.4)),
    Normal(0.45, 0.08, truncate=(0.2, 0.8)),
)
GROUND = Normal(0.70, 0.05)
LOCK = Normal(0.40, 0.10, truncate=(0.05, 1.0))
MASS_ERROR, INERTIA_ERROR = 0.02, 0.10  # shares
COURSE_ERROR, NORMAL_ERROR = math.radians(2.0), math.radians(4.0)
PLACE_ERROR = 0.1  # m, of each coordinate of the contact point
RECORDED_SPEED = 1.0 / 3.6  # to either side; speed before, 49 CFR 563.8, Table III
DAMAGE_ERROR = 0.15  # of the energy of the damage, as a share of it
POINT_ERROR = 0.06  # m, of each coordinate of a point of the survey
HEADING_ERROR = math.radians(3.0)
SPACING = 1.5  # m, between the points of a survey


@dataclass(frozen=True, kw_only=True)
class Crash:
    """One crash as it was; what is known of it, each route draws for itself."""

    impact: col.Impact
    friction: float  # of the ground
    locks: tuple[float, float]
    ways: tuple[SimulatedPath, SimulatedPath]

    @property
    def sides(self) -> dict[str, Any]:
        return {"a": self.impact.a, "b": self.impact.b}


def crashes(count: int, seed: int) -> list[Crash]:
    """Two cars whose courses cross at 50 to 130 degrees, anywhere on each other; those that slide 5
    m or more to rest.
    """
    generator = np.random.default_rng(seed)
    n = 3 * count
    draw = generator.uniform
    crossing = np.radians(draw(50.0, 130.0, n)) * generator.choice([-1.0, 1.0], n)
    normal = np.radians(draw(-35.0, 35.0, n)) + np.where(draw(size=n) < 0.5, 0.0, 0.5 * crossing)
    nx, ny = np.cos(normal), np.sin(normal)
    across = draw(-0.8, 0.8, (2, n))
    speeds, masses = draw(8.0, 20.0, (2, n)), draw(900.0, 2000.0, (2, n))
    a, b = (
        col.Vehicle.from_speed(
            speed=speeds[i], course=course, heading=course, mass=masses[i],
            yaw_inertia=1.6 * masses[i],
            x=-away * nx - across[i] * ny, y=-away * ny + across[i] * nx,
        )
        for i, (course, away) in enumerate(((np.zeros(n), 1.6), (crossing, -1.3)))
    )  # fmt: skip
    contact = {"normal": normal, "point": (0.0, 0.0), "friction": FRICTION.quantile(draw(size=n))}
    friction = GROUND.quantile(draw(size=n))
    locks = LOCK.quantile(draw(size=(2, n)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        impact = col.eccentric(
            a, b, RESTITUTION.quantile(draw(size=n)), **contact, on_failure="nan"
        )
        ways = [
            travel.simulate(
                side.after, travel.Tyres(friction, lock, wheelbase=2.7, track=1.5), moments=301
            )
            for side, lock in zip((impact.a, impact.b), locks, strict=True)
        ]
    lengths = [
        np.sum(np.hypot(np.diff(way.x, axis=0), np.diff(way.y, axis=0)), axis=0) for way in ways
    ]
    fit = np.flatnonzero((lengths[0] >= 5.0) & (lengths[1] >= 5.0))[:count]
    return [
        Crash(
            impact=impact.case(int(i)),
            friction=float(friction[i]),
            locks=(float(locks[0, i]), float(locks[1, i])),
            ways=tuple(_one(way, int(i)) for way in ways),
        )
        for i in fit
    ]


def _one(way: SimulatedPath, i: int) -> SimulatedPath:
    rest = way.rest
    curves = ("time", "x", "y", "heading", "vx", "vy", "yaw_rate")
    return SimulatedPath(
        **{name: getattr(way, name)[:, i] for name in curves},
        marks=(),
        end=col.Vehicle(mass=float(rest.mass[i]), x=float(rest.x[i]), y=float(rest.y[i])),
    )


def surveyed(
    way: SimulatedPath, generator: np.random.Generator | None = None, spacing: float = SPACING
) -> tuple[Any, Any]:
    """Points and headings along a way, at equal distances; with their errors if there is a
    generator for them.
    """
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(way.x), np.diff(way.y)))])
    at = np.linspace(0.0, along[-1], max(4, round(along[-1] / spacing) + 1))
    x, y, heading = (np.interp(at, along, part) for part in (way.x, way.y, way.heading))
    points = np.column_stack([x, y])
    if generator is None:
        return points, heading
    points += generator.normal(0.0, POINT_ERROR, (len(at), 2))
    return points, heading + generator.normal(0.0, HEADING_ERROR, len(at))


def recorded(side: Any, generator: np.random.Generator) -> reconstruct.RecordedPulse:
    """What a recorder within 49 CFR 563 tells: each component anywhere within its accuracy."""
    time = np.arange(0.0, 0.251, 0.01)
    shape = 0.5 * (1.0 - np.cos(np.pi * np.clip(time / 0.1, 0.0, 1.0)))
    readings = []
    for truth in (side.delta_v_forward, side.delta_v_left):
        half = max(
            reference.RECORDER_ACCURACY.high * abs(truth), 0.5 * reference.RECORDER_RESOLUTION.high
        )
        readings.append((truth + generator.uniform(-half, half)) * shape)
    return reconstruct.recorded_pulse(time, *readings, polarity="ISO 8855")


def read(crash: Crash, generator: np.random.Generator) -> dict[str, Normal]:
    """The geometry and the vehicles as an analyst has them, each read with its error."""
    found = {
        "normal": (crash.impact.normal_angle, NORMAL_ERROR),
        "x": (0.0, PLACE_ERROR),
        "y": (0.0, PLACE_ERROR),
    }
    for label, side in crash.sides.items():
        found[f"mass_{label}"] = side.before.mass, MASS_ERROR * side.before.mass
        found[f"inertia_{label}"] = side.before.yaw_inertia, INERTIA_ERROR * side.before.yaw_inertia
        found[f"course_{label}"] = side.before.course, COURSE_ERROR
    return {
        name: Normal(truth + generator.normal(0.0, error), error)
        for name, (truth, error) in found.items()
    }


def bodies(crash: Crash, values: dict[str, Any]) -> list[col.Vehicle]:
    """Both vehicles before with these values of ``read``, and of their speeds if these are among
    them.
    """
    return [
        col.Vehicle.from_speed(
            mass=values[f"mass_{label}"], yaw_inertia=values[f"inertia_{label}"], x=side.before.x,
            y=side.before.y,
            speed=values.get(f"speed_{label}", 0.0), course=values[f"course_{label}"],
            heading=values[f"course_{label}"],
        )
        for label, side in crash.sides.items()
    ]  # fmt: skip
