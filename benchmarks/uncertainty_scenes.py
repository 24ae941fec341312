"""Four impacts with inputs that are not known exactly: nearly straight, cut off, with a kink, and
with refused cases.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

SOURCE = Path(__file__).resolve().parent.parent / "src"
if str(SOURCE) not in sys.path:
    sys.path.insert(0, str(SOURCE))

import collisions as col
from collisions import reconstruct
from collisions.uncertainty import Normal, Propagation, propagate

Numbers = dict[str, Any]


class Scene(NamedTuple):
    """A model with one output, what is stated of its inputs, and where the truth of those that are
    measured may lie.
    """

    key: str
    name: str
    output: str
    model: Callable[..., Mapping[str, Any]]
    inputs: dict[str, Normal]
    measured: dict[str, tuple[float, float]]


def t_bone(
    speed_a: Any,
    speed_b: Any,
    mass_a: Any,
    mass_b: Any,
    inertia_b: Any,
    restitution: Any,
    friction: Any,
    lever: Any,
) -> col.Impact:
    """A drives into the side of B, ahead of the centre of mass of B by the lever."""
    a = col.Vehicle(mass=mass_a, yaw_inertia=2600.0, vx=speed_a, x=-2.2, y=0.0)
    b = col.Vehicle(mass=mass_b, yaw_inertia=inertia_b, vy=speed_b, x=0.9, y=-lever)
    return col.eccentric(
        a, b, restitution, normal=0.0, point=(0.0, 0.0), friction=friction, on_failure="nan"
    )


def side_delta_v(**inputs: Any) -> Mapping[str, Any]:
    """Delta-V of the car that is struck from the side."""
    return {"delta_v": t_bone(**inputs).b.delta_v}


def side_yaw_rate(**inputs: Any) -> Mapping[str, Any]:
    """Change of its yaw rate, clockwise positive."""
    return {"yaw_rate": -t_bone(**inputs).b.delta_yaw_rate}


def rear_end(speed: Any, mass_a: Any, mass_b: Any, restitution: Any) -> Mapping[str, Any]:
    """Delta-V of a standing car that is struck from behind."""
    a, b = col.Vehicle(mass=mass_a, vx=speed), col.Vehicle(mass=mass_b)
    return {"delta_v": col.linear_central(a, b, restitution, on_failure="nan").b.delta_v}


def nearly_collinear(
    course_a: Any, course_b: Any, course_after: Any, speed_after: Any
) -> Mapping[str, Any]:
    """Speed of A from courses that nearly agree; a case in which a car would have gone backwards
    has no answer.
    """
    found = reconstruct.momentum(
        1500.0,
        1200.0,
        course_a=course_a,
        course_b=course_b,
        course_a_after=course_after,
        speed_a_after=speed_after,
        together=True,
        on_failure="nan",
    )
    forwards = (np.asarray(found.speed_a) >= 0.0) & (np.asarray(found.speed_b) >= 0.0)
    return {"speed_a": np.where(forwards, found.speed_a, math.nan)}


POSITIVE = (0.0, None)
SIDE = {
    "speed_a": Normal(15.0, 0.5),
    "speed_b": Normal(5.0, 0.5),
    "mass_a": Normal(1500.0, 30.0),
    "mass_b": Normal(1200.0, 30.0),
    "inertia_b": Normal(2000.0, 100.0),
    "restitution": Normal(0.15, 0.03, truncate=(0.0, 1.0)),
    "friction": Normal(0.6, 0.05, truncate=POSITIVE),
    "lever": Normal(0.8, 0.05),
}
SCENES = (
    Scene(
        "near_linear",
        "side impact that sticks",
        "delta-V of B",
        side_delta_v,
        SIDE,
        {
            "speed_a": (14.0, 20.0),
            "speed_b": (3.0, 6.0),
            "mass_a": (1200.0, 1800.0),
            "mass_b": (1000.0, 1500.0),
        },
    ),
    Scene(
        "truncated",
        "rear-end, restitution cut off at 0",
        "delta-V of B",
        rear_end,
        {
            "speed": Normal(5.0, 0.1),
            "mass_a": Normal(1500.0, 30.0),
            "mass_b": Normal(1200.0, 30.0),
            "restitution": Normal(0.1, 0.1, truncate=(0.0, 1.0)),
        },
        {"speed": (3.0, 7.0), "mass_a": (1200.0, 1800.0), "mass_b": (1000.0, 1500.0)},
    ),
    Scene(
        "stick_slip",
        "side impact that sticks or slides",
        "yaw rate of B",
        side_yaw_rate,
        SIDE | {"speed_b": Normal(8.0, 0.5), "friction": Normal(0.35, 0.1, truncate=POSITIVE)},
        {
            "speed_a": (13.0, 17.0),
            "speed_b": (7.0, 9.0),
            "mass_a": (1200.0, 1800.0),
            "mass_b": (1000.0, 1500.0),
        },
    ),
    Scene(
        "collinear",
        "momentum, courses 15° apart",
        "speed of A",
        nearly_collinear,
        {
            "course_a": Normal("0 deg", "3 deg"),
            "course_b": Normal("15 deg", "3 deg"),
            "course_after": Normal("6 deg", "1.5 deg"),
            "speed_after": Normal(15.0, 0.5),
        },
        {},
    ),
)
BY_KEY = {scene.key: scene for scene in SCENES}

LOCAL = ("first_order", "second_order")
SAMPLED = ("quasi_random", "latin_hypercube", "monte_carlo")


def drawn(inputs: Mapping[str, Normal], generator: np.random.Generator, count: int) -> Numbers:
    """Cases by numpy's own normals, drawn again where they are cut off: nothing of the package is
    in them.
    """
    found = {}
    for name, stated in inputs.items():
        values = generator.normal(stated.given_mean, stated.given_sd, count)
        low, high = stated.truncate or (None, None)
        while True:
            outside = np.zeros(count, bool)
            outside |= False if low is None else values < low
            outside |= False if high is None else values > high
            again = int(np.count_nonzero(outside))
            if not again:
                break
            values[outside] = generator.normal(stated.given_mean, stated.given_sd, again)
        found[name] = values
    return found


@contextmanager
def listening() -> Iterator[list[str]]:
    """The codes of what the library says meanwhile, in place of its saying so."""
    codes: list[str] = []
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            yield codes
        finally:
            codes += [getattr(one.message, "code", "") for one in said]


def run(
    scene: Scene, method: str, inputs: Mapping[str, Any] | None = None, **how: Any
) -> tuple[Propagation, list[str]]:
    """A propagation, and the codes of its warnings."""
    with listening() as codes:
        found = propagate(
            scene.model, scene.inputs if inputs is None else inputs, method=method, **how
        )
    return found, codes


FIGURES = ("mean", "std", "low", "high")
ENDS = (0.025, 0.975)


def figures(found: Propagation) -> list[float]:
    """Mean, standard deviation and both ends of the 95 percent interval of the only output."""
    (output,) = found.outputs.values()
    return [output.mean, output.std, *output.interval(0.95)]


def errors(found: Propagation) -> list[float]:
    """Their stated standard errors."""
    (output,) = found.outputs.values()
    return [
        output.mean_standard_error,
        output.std_standard_error,
        *output.quantile_standard_error(np.array(ENDS)).tolist(),
    ]
