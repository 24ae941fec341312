"""How often the 95 percent intervals of both speeds hold the truth, from what event data recorders tell of simulated crashes.

A crash is drawn and solved by ``eccentric``; its recorders tell delta-V within 49 CFR 563, and the rest is known with errors.
Each route of ``ROUTES`` states an interval for the speed of either vehicle before.

    python benchmarks/evidence_recorder.py [--quick] [--json PATH]
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "src"))

import collisions as col
from collisions import reconstruct, reference
from collisions.uncertainty import Normal, Uniform, propagate

SEED = 20260412
CRASHES, QUICK = 900, 12
DATA = ROOT / "docs" / "_generated" / "evidence_recorder.json"
KMH = 3.6
# What an analyst knows of every crash; the truth is drawn from it.
RESTITUTION, FRICTION = Uniform(0.0, 0.3), Uniform(0.3, 0.6)
RECORDED_SPEED = 1.0 / KMH  # to either side; speed before, 49 CFR 563.8, Table III
MASS_ERROR, INERTIA_ERROR = 0.02, 0.10  # shares
COURSE_ERROR, NORMAL_ERROR = math.radians(2.0), math.radians(4.0)
PLACE_ERROR = 0.1  # m, of each coordinate of the contact point
SAMPLES = 512
LOST = 0.02  # share of samples without an answer, above which a route refuses

Speeds = dict[str, tuple[float, float]]
Route = Callable[[col.Impact, np.random.Generator], Speeds]


def crashes(count: int, seed: int) -> list[col.Impact]:
    """Two cars whose courses cross at 50 to 130 degrees, at 29 to 72 km/h, anywhere on each other."""
    generator = np.random.default_rng(seed)
    n = 2 * count
    draw = generator.uniform
    crossing = np.radians(draw(50.0, 130.0, n)) * generator.choice([-1.0, 1.0], n)
    normal = np.radians(draw(-35.0, 35.0, n)) + np.where(draw(size=n) < 0.5, 0.0, 0.5 * crossing)
    nx, ny = np.cos(normal), np.sin(normal)
    across, speeds, masses = draw(-0.8, 0.8, (2, n)), draw(8.0, 20.0, (2, n)), draw(900.0, 2000.0, (2, n))
    a, b = (
        col.Vehicle.from_speed(
            speed=speeds[i], course=course, heading=course, mass=masses[i], yaw_inertia=1.6 * masses[i],
            x=-away * nx - across[i] * ny, y=-away * ny + across[i] * nx,
        )
        for i, (course, away) in enumerate(((np.zeros(n), 1.6), (crossing, -1.3)))
    )  # fmt: skip
    friction, restitution = FRICTION.quantile(draw(size=n)), RESTITUTION.quantile(draw(size=n))
    many = col.eccentric(a, b, restitution, normal=normal, point=(0.0, 0.0), friction=friction, on_failure="nan")
    return [many.case(int(i)) for i in np.flatnonzero(many.ok)[:count]]


def both_recorders(impact: col.Impact, generator: np.random.Generator) -> Speeds:
    """The components of both, and no speed: of contacts that stuck, as their damage shows."""
    if impact.regime != "sticking":
        raise col.NoSolutionError("where the contact slid, delta-V tells of the closing speed alone", code="undetermined")
    return _speeds(impact, generator, ("a", "b"), friction=math.inf)


def one_recorder_and_its_speed(impact: col.Impact, generator: np.random.Generator) -> Speeds:
    """The components and the speed before that the recorder of A tells, also of contacts that slid."""
    reading = impact.a.before.speed + generator.uniform(-RECORDED_SPEED, RECORDED_SPEED)
    speed = Uniform(reading - RECORDED_SPEED, reading + RECORDED_SPEED)
    return _speeds(impact, generator, ("a",), friction=FRICTION, speed_a=speed)


def _speeds(impact: col.Impact, generator: np.random.Generator, recorders: tuple[str, ...], **known: Any) -> Speeds:
    sides = {"a": impact.a, "b": impact.b}
    inputs: dict[str, Any] = {"restitution": RESTITUTION, **known}
    for label in recorders:
        inputs |= recorded(sides[label], generator).inputs(label)
    errors = {"normal": (impact.normal_angle, NORMAL_ERROR), "x": (0.0, PLACE_ERROR), "y": (0.0, PLACE_ERROR)}
    for label, side in sides.items():
        mass, inertia = side.before.mass, side.before.yaw_inertia
        assert inertia is not None
        errors |= {f"mass_{label}": (mass, MASS_ERROR * mass), f"inertia_{label}": (inertia, INERTIA_ERROR * inertia)}
        errors[f"course_{label}"] = side.before.course, COURSE_ERROR
    inputs |= {name: Normal(truth + generator.normal(0.0, error), error) for name, (truth, error) in errors.items()}

    def model(**values: Any) -> dict[str, Any]:
        bodies = [
            side.before.replace(
                mass=values.pop(f"mass_{label}"),
                yaw_inertia=values.pop(f"inertia_{label}"),
                heading=values[f"course_{label}"],
            )
            for label, side in sides.items()
        ]
        found = reconstruct.speeds(*bodies, point=(values.pop("x"), values.pop("y")), **values)[0]
        return {"speed_a": found.a.before.speed, "speed_b": found.b.before.speed}

    found = propagate(model, inputs, method="quasi_random", samples=SAMPLES, seed=int(generator.integers(2**31)))
    if found.failed > LOST * SAMPLES:
        raise col.NoSolutionError(f"{found.failed} of {SAMPLES} samples have no answer", code="contradictory")
    return {name: found[name].interval(0.95) for name in ("speed_a", "speed_b")}


def recorded(side: Any, generator: np.random.Generator) -> reconstruct.RecordedPulse:
    """What a recorder within 49 CFR 563 tells: each component anywhere within its accuracy."""
    time = np.arange(0.0, 0.251, 0.01)
    shape = 0.5 * (1.0 - np.cos(np.pi * np.clip(time / 0.1, 0.0, 1.0)))
    readings = []
    for truth in (side.delta_v_forward, side.delta_v_left):
        half = max(reference.RECORDER_ACCURACY.high * abs(truth), 0.5 * reference.RECORDER_RESOLUTION.high)
        readings.append((truth + generator.uniform(-half, half)) * shape)
    return reconstruct.recorded_pulse(time, *readings, polarity="ISO 8855")


ROUTES: dict[str, Route] = {
    "components of both recorders, contact stuck": both_recorders,
    "components and speed of one recorder": one_recorder_and_its_speed,
}


def measured(route: Route, drawn: list[col.Impact], seed: int) -> dict[str, Any]:
    """How often a route holds the truth and how wide it is, of crashes that it does not warn of and of those that it does."""
    missed: dict[bool, list[int]] = {False: [], True: []}
    widths, refused = [], 0
    for i, impact in enumerate(drawn):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", col.CollisionsWarning)
            try:
                found = route(impact, np.random.default_rng([seed, i]))
            except col.CollisionsError:
                refused += 1
                continue
        for label, side in (("a", impact.a), ("b", impact.b)):
            low, high = found[f"speed_{label}"]
            truth = side.before.speed
            missed[bool(caught)].append(int(truth > high) - int(truth < low))
            widths.append(0.5 * (high - low) * KMH)
    counts = {
        key: {"intervals": len(found), "held": found.count(0), "above": found.count(1), "below": found.count(-1)}
        for key, found in (("plain", missed[False]), ("warned", missed[True]))
    }
    halves = [round(float(np.percentile(widths, p)), 2) for p in (10, 50, 90)] if widths else []
    return {"crashes": len(drawn), "refused": refused, **counts, "half_width": halves}


def main() -> None:
    """Measure every route and write the numbers."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help=f"{QUICK} crashes, to see that everything runs")
    parser.add_argument("--json", type=Path, default=DATA)
    options = parser.parse_args()
    drawn = crashes(QUICK if options.quick else CRASHES, SEED)
    routes = {name: measured(route, drawn, SEED) for name, route in ROUTES.items()}
    print(json.dumps(routes, indent=1))
    options.json.write_text(json.dumps({"routes": routes}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
