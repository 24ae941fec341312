"""The same crashes backwards: from what was measured to the speeds before the impact, which are
known.

Contact and masses are those of the cases, unchanged. The readings have the errors that the
documentation's other trials give an analyst, fixed before they were tried here: delta-V 4 percent,
a speed after the impact 5 percent, a course after it 2 degrees, one standard deviation each; what
places of rest are taken for is in ``from_rest``. Not blind: the measurements are inputs here.
"""

from __future__ import annotations

import math
import statistics
import warnings
from typing import Any

import numpy as np

import collisions as col
from collisions import reconstruct
from collisions.uncertainty import Normal, propagate

from . import from_rest, inputs, levels, measured
from .causes import BACKWARDS
from .predict import SEED

DELTA_V, SPEED, COURSE = 0.04, 0.05, math.radians(2.0)
SAMPLES = 4096
CROSSING = 30.0
"""Least angle between the courses before the impact, in degrees, for momentum to tell
both speeds.
"""


def by_momentum(numbers: dict[str, Any], read: dict[str, float]) -> Any:
    """Both speeds from both motions after, by ``reconstruct.momentum``: no contact, restitution or
    friction.
    """
    given = {name: numbers[name] for name in ("a.mass", "b.mass", "a.course", "b.course")}
    for side in ("a", "b"):
        forward, left = (read[f"velocity_after_{axis}_{side}"] for axis in ("forward", "left"))
        speed = math.hypot(forward, left)
        given[f"{side}.speed_after"] = Normal(speed, SPEED * speed)
        given[f"{side}.course_after"] = Normal(math.atan2(left, forward), COURSE)

    def solve(**values: Any) -> dict[str, Any]:
        found = reconstruct.momentum(
            values["a.mass"],
            values["b.mass"],
            **{f"course_{side}": values[f"{side}.course"] for side in ("a", "b")},
            **{
                f"{what}_{side}_after": values[f"{side}.{what}_after"]
                for side in ("a", "b")
                for what in ("speed", "course")
            },
            on_failure="nan",
        )
        return {"speed_a": found.speed_a, "speed_b": found.speed_b}

    return propagate(solve, given, method="quasi_random", samples=SAMPLES, seed=SEED)


def by_delta_v(numbers: dict[str, Any], read: dict[str, float], side: str) -> Any:
    """The speed of A from a delta-V and the speed of B, by ``reconstruct.speeds``."""
    given = {
        name: value
        for name, value in numbers.items()
        if name.partition(".")[0] in ("a", "b", "eccentric")
    }
    del given["a.speed"]
    delta_v = read[f"delta_v_{side}"]
    given["delta_v"] = Normal(delta_v, DELTA_V * delta_v)

    def solve(**values: Any) -> dict[str, Any]:
        a, b = levels.vehicles({**values, "a.speed": 0.0})
        found = reconstruct.speeds(
            a,
            b,
            course_a=values["a.course"],
            course_b=values["b.course"],
            speed_b=values["b.speed"],
            **{f"delta_v_{side}": values["delta_v"]},
            **levels.contact(values),
            forward_only=True,
        )
        answers = np.array([impact.a.before.speed for impact in found])
        only = np.isfinite(answers).sum(axis=0) == 1  # a case with two answers has none here
        return {"speed_a": np.where(only, np.nansum(answers, axis=0), np.nan)}

    return propagate(solve, given, method="quasi_random", samples=SAMPLES, seed=SEED)


def rows() -> list[dict[str, Any]]:
    """Every reconstruction of every crash that has the readings for it."""
    found = []
    readings = measured.readings()
    for key, (title, numbers) in inputs.cases().items():
        read = readings[key]
        courses = [math.degrees(inputs.middle(numbers[f"{side}.course"])) for side in ("a", "b")]
        crossing = abs((courses[1] - courses[0] + 90.0) % 180.0 - 90.0)
        routes: dict[str, Any] = {}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            if "velocity_after_forward_a" in read and crossing > CROSSING:
                routes["momentum"] = by_momentum(numbers, read)
            for side in ("a", "b"):
                if f"delta_v_{side}" in read:
                    routes[f"delta-V of {side.upper()}"] = by_delta_v(numbers, read, side)
        rests = from_rest.routes(key, numbers, read)
        for route, answer in (routes | rests).items():
            for name in ("speed_a", "speed_b", "a.speed", "b.speed"):
                if name not in answer:
                    continue
                car = name.removeprefix("speed_")[0]
                known = inputs.middle(numbers[f"{car}.speed"])
                low, high = answer[name].interval(0.95)
                median = answer[name].quantile(0.5)
                held = bool(low <= known <= high)
                if not held and (title, route) not in BACKWARDS:
                    raise LookupError(
                        f"{title}: {route} missed a speed, and causes.py does not say what by"
                    )
                found.append(
                    {
                        "test": title,
                        "route": route,
                        "speed": f"of {car.upper()}",
                        "known": round(3.6 * known, 2),
                        "found": round(3.6 * median, 2),
                        "range": [round(3.6 * low, 2), round(3.6 * high, 2)],
                        "percent": round(100 * (median / known - 1), 2),
                        "held": held,
                        "cause": "" if held else ": ".join(BACKWARDS[title, route]),
                        "contradicted": route in rests and not answer.consistent,
                    }
                )
    return found


def summaries(found: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Mean, standard deviation and worst of the errors of each route, in percent, and how often its
    range held.
    """
    answer = []
    for route, title in (
        ("momentum", "momentum"),
        ("delta-V", "delta-V of one car and the speed of B"),
        (from_rest.ALONE, f"{from_rest.ALONE} alone"),
        (from_rest.WITH, from_rest.WITH),
    ):
        mine = [
            row
            for row in found
            if (row["route"] == route if "rest" in route else row["route"].startswith(route))
        ]
        errors = [row["percent"] for row in mine]
        worst = max(mine, key=lambda row: abs(row["percent"]))
        answer.append(
            {
                "route": title,
                "speeds": len(mine),
                "mean": round(statistics.fmean(errors), 2),
                "sd": round(statistics.stdev(errors), 2),
                "worst": worst["percent"],
                "worst_of": f"{worst['test']}, {worst['route']}",
                "held": sum(row["held"] for row in mine),
            }
        )
    return answer
