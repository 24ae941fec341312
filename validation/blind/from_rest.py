"""Backwards from the places of rest, alone and with delta-V: the speeds before the impact by
``reconstruct.posterior``.

The model is that of an analyst who has no more than a scale drawing: the impact of the case, then a
straight way to rest at one drag for each car. How the wheels were braked is not known, so any drag
from that of a rolling car to that of a locked one on a dry road is as likely. These and the errors
were fixed before they were tried.
"""

from __future__ import annotations

import math
import warnings
from typing import Any

import collisions as col
from collisions import reconstruct, travel
from collisions.reference import ROLLING_RESISTANCE
from collisions.uncertainty import Normal, Uniform

from . import inputs, levels
from .predict import SEED

SAMPLES = 2048
SPEED = Uniform("0 km/h", "130 km/h")
DRAG = Uniform(ROLLING_RESISTANCE.low, 0.8)
OF_THE_WAY = 0.1
"""Standard deviation of each coordinate of a place of rest, as a share of the way to it: what
straight ways leave out is far more than a tape does.
"""
DELTA_V = 0.04
STOPPED = {("ricsac_10", "b")}
"""Stopped by an obstacle, as the source says: of such a car the place of rest tells no speed."""
ALONE, WITH = "places of rest", "places of rest and both delta-V"


def model(cars: list[str], numbers: levels.Numbers) -> dict[str, Any]:
    """Where these cars come to rest, and the delta-V of both."""
    found = col.eccentric(*levels.vehicles(numbers), **levels.contact(numbers), on_failure="nan")
    answers = {}
    for car in "ab":
        side = getattr(found, car)
        answers[f"delta_v_{car}"] = side.delta_v
        if car in cars:
            after = side.after
            way = after.speed**2 / (2.0 * travel.GRAVITY * numbers[f"{car}.drag"])
            answers[f"rest_forward_{car}"] = after.x + way * after.vx / after.speed
            answers[f"rest_left_{car}"] = after.y + way * after.vy / after.speed
    return answers


def routes(key: str, numbers: dict[str, Any], read: dict[str, float]) -> dict[str, Any]:
    """The posterior of each route; none for a crash whose places of rest were not measured."""
    if "rest_forward_a" not in read:
        return {}
    cars = [car for car in "ab" if (key, car) not in STOPPED]
    stated = {
        name: number
        for name, number in numbers.items()
        if name.partition(".")[0] in ("a", "b", "eccentric")
    }
    stated |= {f"{car}.drag": DRAG for car in cars}
    exact = {name: inputs.middle(text) for name, text in stated.items() if isinstance(text, str)}
    unknown = {name: number for name, number in stated.items() if name not in exact}
    unknown |= {f"{car}.speed": SPEED for car in "ab" if f"{car}.speed" in unknown}
    rests: dict[str, Any] = {}
    for car in cars:
        start = [inputs.middle(numbers[f"{car}.{axis}"]) for axis in "xy"]
        place = [read[f"rest_{axis}_{car}"] for axis in ("forward", "left")]
        error = OF_THE_WAY * math.dist(start, place)
        for axis, coordinate in zip(("forward", "left"), place, strict=True):
            rests[f"rest_{axis}_{car}"] = Normal(coordinate, error)
    delta_vs = {
        f"delta_v_{car}": Normal(read[f"delta_v_{car}"], DELTA_V * read[f"delta_v_{car}"])
        for car in "ab"
    }
    found = {}
    for route, observed in ((ALONE, rests), (WITH, rests | delta_vs)):

        def solve(observed: dict[str, Any] = observed, **values: Any) -> dict[str, Any]:
            answers = model(cars, exact | values)
            return {name: answers[name] for name in observed}

        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)  # kept in its statements
            found[route] = reconstruct.posterior(
                solve, unknown, observed, samples=SAMPLES, seed=SEED
            )
    return found
