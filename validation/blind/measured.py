"""The measurements, in the axes of the library, and what those of the staged crashes say about
themselves.
"""

from __future__ import annotations

import csv
import math
from typing import Any

import numpy as np

from . import axes
from .inputs import HERE

FILE = HERE / "measured.csv"
UNITS = {
    "m/s": 1.0,
    "km/h": 1 / 3.6,
    "mph": 0.44704,
    "rad/s": 1.0,
    "deg/s": math.pi / 180,
    "J": 1.0,
    "ft": 0.3048,
    "deg": math.pi / 180,
}
TURNED = {"clockwise": axes.angle, "right": axes.angle, "rearward": lambda value: -value}
"""Senses that the library counts the other way round; a component changes its sign as an angle
does.
"""


def rows() -> list[dict[str, str]]:
    """The readings as they are printed."""
    with open(FILE, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def value(row: dict[str, str], column: str = "printed") -> float:
    """A reading in SI and in the sense of the library."""
    found = float(row[column]) * UNITS[row["unit"]]
    return (
        TURNED[row["sense"]](found) + 0.0 if row["sense"] in TURNED else found
    )  # + 0.0: no minus zero


def readings() -> dict[str, dict[str, float]]:
    """By case and quantity."""
    found: dict[str, dict[str, float]] = {}
    for row in rows():
        found.setdefault(row["case"], {})[row["quantity"]] = value(row)
    return found


def _cross(arm: Any, vector: Any) -> float:
    return float(arm[0] * vector[1] - arm[1] * vector[0])


def self_check(own: dict[str, float], numbers: dict[str, float]) -> dict[str, float]:
    """How well a test closes, and where its impulse must have passed.

    Each car's change of velocity times its mass is the impulse on it. The two must be equal and
    opposite; what remains is of the tyres and of the measurement. Along the direction of the
    impulse, the contact points of the drawing separate after the impact at a share of the speed at
    which they approached: a restitution, if that is where the impulse acted. Each car's change of
    yaw rate says how far from its centre of mass the impulse passed, if it acted in an instant; the
    drawn contact says it too, for the same direction. Lever arms are positive where the impulse
    turns the car counterclockwise. A point elsewhere, or a couple between the cars, moves both arms
    by as much, one up and one down: half their difference is ``aside``. Half their sum, ``common``,
    turns both cars the same way, which nothing between them does.
    """
    found: dict[str, float] = {}
    impulses, points, velocity = {}, {}, {}
    for side in ("a", "b"):
        course = numbers[f"{side}.course"]
        before = numbers[f"{side}.speed"] * np.array([np.cos(course), np.sin(course)])
        velocity[side] = before
        after = np.array(
            [own[f"velocity_after_forward_{side}"], own[f"velocity_after_left_{side}"]]
        )
        impulses[side] = numbers[f"{side}.mass"] * (after - before)
        size = float(np.linalg.norm(impulses[side]))
        arm = np.array(
            [
                numbers[f"eccentric.point.{at}"] - numbers[f"{side}.{axis}"]
                for at, axis in enumerate("xy")
            ]
        )
        across = np.array([-arm[1], arm[0]])
        points[side] = before, after + own[f"yaw_rate_{side}"] * across
        found[f"lever_{side}"] = numbers[f"{side}.yaw_inertia"] * own[f"yaw_rate_{side}"] / size
        found[f"lever_drawn_{side}"] = _cross(arm, impulses[side]) / size
    off_a, off_b = (found[f"lever_{side}"] - found[f"lever_drawn_{side}"] for side in ("a", "b"))
    found["aside"], found["common"] = (off_b - off_a) / 2, (off_b + off_a) / 2
    shared = (impulses["b"] - impulses["a"]) / 2
    along = shared / np.linalg.norm(shared)
    approach, separation = ((points["b"][at] - points["a"][at]) @ along for at in (0, 1))
    found["restitution"] = float(-separation / approach)
    found["unclosed"] = float(
        np.linalg.norm(impulses["a"] + impulses["b"]) / np.linalg.norm(shared)
    )
    found["direction"] = math.atan2(shared[1], shared[0])
    closing = velocity["a"] - velocity["b"]
    found["direction_closing"] = math.atan2(closing[1], closing[0])
    return found
