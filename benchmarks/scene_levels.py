"""Four scenes at every level: what a run costs and how far it is from the finest level, written to
``docs/_generated/scene_levels.json``.

``python benchmarks/scene_levels.py [draws]``; a few minutes for 64 draws. Times are processor
time: of one run, and of a case among ``CASES`` worked out together.
"""

from __future__ import annotations

import json
import sys
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import collisions as col
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform

OUT = Path(__file__).resolve().parents[1] / "docs" / "_generated" / "scene_levels.json"
DRAWS, CASES = 64, 512
# What a run of the levels is followed in; the places of rest it moves are below a centimetre.
TOLERANCE = 1e-4


def car(mass: float, **state: Any) -> col.Vehicle:
    """A car or a truck whose yaw inertia goes with its mass."""
    return col.Vehicle(mass=mass, yaw_inertia=mass * 1.3**2, **state)


def wheels(lock: Any, friction: float = 0.7, wheelbase: float = 2.7) -> Tyres:
    return Tyres(friction, lock, wheelbase, 1.55)


CAR, TRUCK = (4.5, 1.8), (8.0, 2.5)
ROLLING = [0.6, 0.05, 0.05, 0.05]
"""A wheel jammed by the damage."""


def rear_end() -> Scene:
    """In line, both braked: little turns, and the contact is long against the speeds."""
    return Scene(
        movers={
            "A": Mover(car(1500, x=-2.25, y=0.15, heading=0, vx=9), outline=CAR, tyres=wheels(0.9)),
            "B": Mover(car(1300, x=2.25, y=0, heading=0, vx=1), outline=CAR, tyres=wheels(0.8)),
        },
        contacts=[
            Contact("A", "B", restitution=0.15, friction=0.5, normal=0, point=(0, 0.07),
                    duration=0.1)
        ],
        shared={"road": ("A.tyres.friction", "B.tyres.friction")},
    )  # fmt: skip


def side() -> Scene:
    """A car is struck in its side, ahead of its centre of mass, and turns on rolling wheels."""
    return Scene(
        movers={
            "A": Mover(
                car(1500, x=-3.1, y=0, heading=0, vx=14), outline=CAR, tyres=wheels(ROLLING)
            ),
            "B": Mover(
                car(1250, x=0, y=-0.8, heading=np.pi / 2, vy=9), outline=CAR,
                tyres=wheels([0.05, 0.05, 0.9, 0.05]),
            ),
        },
        contacts=[
            Contact("A", "B", restitution=0.1, friction=0.5, normal=0, point=(-0.9, 0.1),
                    duration=0.1)
        ],
        shared={"road": ("A.tyres.friction", "B.tyres.friction")},
    )  # fmt: skip


def truck() -> Scene:
    """A truck pushes a car that crosses in front of it."""
    return Scene(
        movers={
            "A": Mover(
                col.Vehicle(mass=12000, yaw_inertia=60000, x=-4.8, y=0.4, heading=0, vx=11),
                outline=TRUCK, tyres=wheels(0.6, wheelbase=5.0),
            ),
            "B": Mover(
                car(1300, x=0.1, y=-0.5, heading=np.pi / 2, vy=6), outline=CAR, tyres=wheels(0.1)
            ),
        },
        contacts=[
            Contact("A", "B", restitution=0.05, friction=0.5, normal=0, point=(-0.8, 0),
                    duration=0.15)
        ],
        shared={"road": ("A.tyres.friction", "B.tyres.friction")},
    )  # fmt: skip


def into_parked() -> Scene:
    """A car is struck in its side and comes against a parked one: two contacts."""
    return Scene(
        movers={
            "A": Mover(car(1550, x=-3.2, y=-0.5, heading=0, vx=18), outline=CAR,
                       tyres=wheels(1.0)),
            "B": Mover(car(1250, x=0, y=1.2, heading=np.pi / 2, vy=9), outline=CAR,
                       tyres=wheels(0.15)),
            "C": Mover(car(1700, x=5.5, y=9.0, heading=np.pi / 2), outline=CAR, tyres=wheels(0.5)),
        },
        contacts=[
            Contact("A", "B", restitution=0.1, friction=0.5, normal=0, point=(-0.9, -0.2),
                    duration=0.1),
            Contact("B", "C", restitution=0.15, friction=0.5, at="touch", duration=0.1),
        ],
        shared={"road": tuple(f"{name}.tyres.friction" for name in "ABC")},
    )  # fmt: skip


SCENES = {
    "rear end, both braked": rear_end,
    "struck in the side, rolling": side,
    "truck pushes a car": truck,
    "into a parked car, two impacts": into_parked,
}


def unknowns(scene: Scene) -> dict[str, Any]:
    """What an analyst may not know better."""
    found: dict[str, Any] = {
        "A.speed": Normal(scene.movers["A"].vehicle.speed, 1.0),
        "B.mass": Normal(scene.movers["B"].vehicle.mass, 40.0),
        "contacts[0].restitution": Uniform(0.05, 0.25),
        "contacts[0].friction": Uniform(0.35, 0.65),
        "road": Uniform(0.6, 0.8),
    }
    return found


ASKED = {
    "impacts[0].b.delta_v": 0.5,
    "B.rest.x": 1.0,
    "B.rest.y": 1.0,
    "B.rest.heading": np.radians(20.0),
}


def in_batch(level: Any, inputs: dict[str, Any], paths: list[str]) -> float:
    """Seconds a case among many."""
    generator = np.random.default_rng(3)
    points = generator.random(CASES)
    values = {name: one.quantile(generator.permutation(points)) for name, one in inputs.items()}
    model = level.as_model(list(values), paths, tolerance=TOLERANCE)
    begun = time.process_time()
    model(**values)
    return (time.process_time() - begun) / CASES


def measured(draws: int) -> dict[str, Any]:
    """Every scene at every level."""
    found: dict[str, Any] = {"draws": draws, "cases": CASES, "version": col.__version__,
                             "scenes": {}}  # fmt: skip
    for name, make in SCENES.items():
        scene = make()
        inputs = unknowns(scene)
        answer = scene.required(ASKED, inputs, draws=draws, tolerance=TOLERANCE)
        record = answer.to_dict()
        record["words"] = " ".join((make.__doc__ or "").split())
        for row, cost in zip(record["levels"], answer.costs, strict=True):
            row["seconds_in_batch"] = in_batch(cost.level, inputs, list(ASKED))
        found["scenes"][name] = record
        print(name, "->", record["level"], flush=True)
        print(answer, flush=True)
    return found


def main() -> None:
    draws = int(sys.argv[1]) if len(sys.argv) > 1 else DRAWS
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        found = measured(draws)
    OUT.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
