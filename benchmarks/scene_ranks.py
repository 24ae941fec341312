"""Ranks of the truth among the samples of posteriors of whole scenes, and how often their ranges
hold the speeds before.

Each scene is drawn from the priors, run, and read with the errors below: the places where both cars
rest, and with the route "recorder" also the delta-V along the first car. A posterior that is right
has ranks that are spread evenly, and 95 percent ranges that hold 95 percent.

    python benchmarks/scene_ranks.py RESULT.json [--scenes 0:200] [--samples 1024]
        [--route recorder|rests] [--join OTHER.json ...]

A run that was ended goes on where it was: every scene is written as it is done, with its seed. A
scene takes a minute or so, which is also given in millions of bare formulas of an impact. Several
processes may take some of the numbers each, and one more call joins their files.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
import timeit
import warnings
from pathlib import Path
from typing import Any

import batch_speed
import numpy as np
import speed_rivals

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "src"))

import collisions as col
from collisions import reconstruct, travel
from collisions.scene import Contact, Mover, Scene
from collisions.uncertainty import Normal, Uniform

SEED = 40
PLACE_ERROR, HEADING_ERROR = 0.3, math.radians(3.0)
DELTA_V_ERROR = 0.4
PRIORS: dict[str, Any] = {
    "A.speed": Uniform(5.0, 30.0),
    "B.speed": Uniform(5.0, 25.0),
    "contacts[0].friction": Uniform(0.3, 0.8),
    "contacts[0].restitution": Uniform(0.0, 0.3),
    "ground": Normal(0.7, 0.05, truncate=(0.4, 1.0)),
}
PLACES = {"x": PLACE_ERROR, "y": PLACE_ERROR, "heading": HEADING_ERROR}
RESTS = {f"{name}.rest.{part}": PLACES[part] for name in "AB" for part in PLACES}
RECORDED = {"impacts[0].a.delta_v_forward": DELTA_V_ERROR}


def crash() -> Scene:
    """Two cars that meet at a crossing, each with its own wheels braked by the damage."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, x=-2.3, y=0.0, heading=0.0, vx=14.0, vy=0.0)
    b = col.Vehicle(
        mass=1200.0, yaw_inertia=1700.0, x=0.9, y=-0.6, heading=math.pi / 2, vx=0.0, vy=9.0
    )
    contact = Contact("A", "B", restitution=0.1, friction=0.5, normal=0.0, point=(0.0, -0.2))
    return Scene(
        movers={
            "A": Mover(a, tyres=travel.Tyres(0.7, [1.0, 0.1, 0.1, 0.1], 2.78, 1.55)),
            "B": Mover(b, tyres=travel.Tyres(0.7, 0.3, 2.62, 1.48)),
        },
        contacts=[contact],
        shared={"ground": ("A.tyres.friction", "B.tyres.friction")},
    )


def drawn(rng: np.random.Generator, model: Any) -> tuple[dict[str, float], dict[str, Any]]:
    """A truth from the priors, and what a scene of it has."""
    while True:
        share = rng.uniform(size=len(PRIORS))
        truth = {
            name: float(prior.quantile(part))
            for (name, prior), part in zip(PRIORS.items(), share, strict=True)
        }
        try:
            return truth, model(**truth)
        except col.CollisionsError:
            # No scene: the cars miss each other, or roll on.
            continue


def one(number: int, samples: int, route: str) -> dict[str, Any]:
    """One scene from the priors, read and reconstructed: ranks of the truth, from 0 to 1."""
    rng = np.random.default_rng([SEED, number])
    errors = RESTS | (RECORDED if route == "recorder" else {})
    model, start = crash().as_model(list(PRIORS), list(errors)), time.process_time()
    truth, read = drawn(rng, model)
    observed = {
        name: Normal(float(read[name].magnitude) + error * rng.normal(), error)
        for name, error in errors.items()
    }
    found = reconstruct.posterior(crash(), PRIORS, observed, samples=samples, seed=number)
    took = time.process_time() - start
    ranks = {name: float(np.mean(found[name].values < truth[name])) for name in PRIORS}
    return {
        "scene": number,
        "truth": truth,
        "ranks": ranks,
        "seconds": round(took, 1),
        "million_formulas": round(took / formula_seconds() / 1e6, 1),
    }


def formula_seconds() -> float:
    """Seconds of a bare formula of an impact, the unit of the budgets."""
    numbers = [float(one[0]) for one in speed_rivals.numbers(batch_speed.scenes(1))]
    calls = timeit.repeat(lambda: speed_rivals.formula(*numbers), number=1000, repeat=25)
    return min(calls) / 1000


def summed(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """By unknown, how many ranks are in each tenth, and how many 95 percent ranges hold."""
    ranks = {name: [row["ranks"][name] for row in rows] for name in PRIORS}
    tenths = {name: np.histogram(ranks[name], 10, (0.0, 1.0))[0].tolist() for name in PRIORS}
    held = {name: sum(0.025 <= rank <= 0.975 for rank in ranks[name]) for name in PRIORS}
    return {"scenes": len(rows), "tenths": tenths, "held": held}


def numbers(text: str) -> range:
    """The numbers of scenes, as ``0:200``."""
    first, _, last = text.rpartition(":")
    return range(int(first or 0), int(last))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result", type=Path)
    parser.add_argument("--scenes", type=numbers, default=range(200))
    parser.add_argument("--samples", type=int, default=1024)
    parser.add_argument("--route", choices=("recorder", "rests"), default="recorder")
    parser.add_argument("--join", type=Path, nargs="*", default=[])
    given = parser.parse_args()
    settings = {"samples": given.samples, "route": given.route, "seed": SEED}
    rows: dict[int, dict[str, Any]] = {}

    def write() -> None:
        """All scenes so far, in order."""
        whole = [rows[number] for number in sorted(rows)]
        kept = {"settings": settings, "summary": summed(whole), "rows": whole}
        given.result.write_text(json.dumps(kept, indent=1) + "\n")

    for path in (given.result, *given.join):
        if path.exists():
            kept = json.loads(path.read_text())
            if kept["settings"] != settings:
                parser.error(f"{path} is of other settings: {kept['settings']}")
            rows |= {row["scene"]: row for row in kept["rows"]}
    if given.join:
        write()
        print(json.dumps(summed([rows[number] for number in sorted(rows)]), indent=1))
        return
    warnings.simplefilter("ignore", col.CollisionsWarning)
    for number in given.scenes:
        if number not in rows:
            rows[number] = one(number, given.samples, given.route)
            write()
            print(number, rows[number]["ranks"], rows[number]["seconds"], flush=True)
    print(json.dumps(summed([rows[number] for number in sorted(rows)]), indent=1))


if __name__ == "__main__":
    main()
