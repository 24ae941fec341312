"""How often the 95 percent intervals of both speeds hold the truth, route by route, over simulated crashes.

A crash is drawn, its impact is solved by ``eccentric`` and its vehicles go to rest on four wheels by ``travel.simulate``. Then
it is surveyed and measured with errors, and each route of ``ROUTES`` states an interval for the speed of either vehicle before.

    python benchmarks/evidence.py [--quick] [--json PATH]

To add a route, write a function of a ``Crash`` and a generator that draws its own errors from the generator and returns the two
intervals in m/s, and name it in ``ROUTES``; an error of the package counts as refused.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "src"))

import collisions as col
from collisions import reconstruct, travel
from collisions.travel import SimulatedPath
from collisions.uncertainty import Normal, propagate

SEED = 20260412
CRASHES = 600
QUICK = 12
DATA = ROOT / "docs" / "_generated" / "evidence.json"
KMH = 3.6

# What an analyst knows of every crash beforehand; the truth is drawn from it. Each with its unit in SI.
GROUND = Normal(0.70, 0.05)
LOCK = Normal(0.40, 0.10, truncate=(0.05, 1.0))
MASS_ERROR = 0.02  # of the mass
COURSE_ERROR = math.radians(2.0)
POINT_ERROR = 0.06  # m, of each coordinate of a point of the survey
HEADING_ERROR = math.radians(3.0)
SPACING = 1.5  # m, between the points of a survey
# What ``path`` leaves out, measured on crashes of another seed by --model-error. Wheels that slip by the yaw too drag less
# along the way: by this times the square of their speed by the yaw over that of the vehicle. And where the bend changes, a
# parabola is off: by this times window**2 friction g / speed**2. ARM is the distance of a wheel from the centre of mass.
YAWING, YAWING_LEFT = 0.38, 0.011
BEND = 0.0083
ARM, WINDOW = 1.54, 7.0
SAMPLES = 512
SPACINGS = (3.2, 1.6, 0.8, 0.4)  # m, of the surveys that are compared
COMPARED = 100  # crashes

Speeds = dict[str, tuple[float, float]]


@dataclass(frozen=True, kw_only=True)
class Crash:
    """One crash as it was; what is known of it, each route draws for itself."""

    impact: col.Impact
    friction: float  # of the ground
    locks: tuple[float, float]
    ways: tuple[SimulatedPath, SimulatedPath]

    @property
    def speeds(self) -> dict[str, float]:
        return {"speed_a": self.impact.a.before.speed, "speed_b": self.impact.b.before.speed}


def crashes(count: int, seed: int) -> list[Crash]:
    """Two cars whose courses cross at 50 to 130 degrees, anywhere on each other; those that slide 5 m or more to rest."""
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
            speed=speeds[i], course=course, heading=course, mass=masses[i], yaw_inertia=1.6 * masses[i],
            x=-away * nx - across[i] * ny, y=-away * ny + across[i] * nx,
        )
        for i, (course, away) in enumerate(((np.zeros(n), 1.6), (crossing, -1.3)))
    )  # fmt: skip
    contact = {"normal": normal, "point": (0.0, 0.0), "friction": draw(0.3, 0.6, n)}
    friction = GROUND.quantile(draw(size=n))
    locks = LOCK.quantile(draw(size=(2, n)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        impact = col.eccentric(a, b, draw(0.0, 0.3, n), **contact, on_failure="nan")
        ways = [
            travel.simulate(side.after, friction=friction, lock=lock, moments=301)
            for side, lock in zip((impact.a, impact.b), locks, strict=True)
        ]
    lengths = [np.sum(np.hypot(np.diff(way.x, axis=0), np.diff(way.y, axis=0)), axis=0) for way in ways]
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
    return SimulatedPath(
        time=way.time[:, i], x=way.x[:, i], y=way.y[:, i], heading=way.heading[:, i], marks=(),
        rest=col.Vehicle(mass=float(rest.mass[i]), x=float(rest.x[i]), y=float(rest.y[i])),
    )  # fmt: skip


def surveyed(way: SimulatedPath, generator: np.random.Generator | None = None, spacing: float = SPACING) -> tuple[Any, Any]:
    """Points and headings along a way, at equal distances; with their errors if there is a generator for them."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(way.x), np.diff(way.y)))])
    at = np.linspace(0.0, along[-1], max(4, round(along[-1] / spacing) + 1))
    x, y, heading = (np.interp(at, along, part) for part in (way.x, way.y, way.heading))
    points = np.column_stack([x, y])
    if generator is None:
        return points, heading
    points += generator.normal(0.0, POINT_ERROR, (len(at), 2))
    return points, heading + generator.normal(0.0, HEADING_ERROR, len(at))


def by_momentum(crash: Crash, generator: np.random.Generator) -> Speeds:
    """Momentum: courses before are known, speeds and courses after come from a smoothed path with its stated errors."""
    surveys = [surveyed(way, generator) for way in crash.ways]
    sides = crash.impact.a, crash.impact.b
    inputs: dict[str, Any] = {"friction": GROUND}
    given = {}
    for letter, side, (points, headings) in zip("ab", sides, surveys, strict=True):
        given[letter] = travel.path(
            points,
            headings,
            friction=GROUND.given_mean,
            lock=LOCK.given_mean,
            point_error=POINT_ERROR,
            heading_error=HEADING_ERROR,
        )
        mass, course = side.before.mass, side.before.course
        inputs[f"lock_{letter}"] = LOCK
        inputs[f"drag_{letter}"] = Normal(1.0, YAWING_LEFT)
        bend = BEND * WINDOW**2 * GROUND.given_mean * travel.GRAVITY / given[letter].speed ** 2
        inputs[f"bend_{letter}"] = Normal(0.0, bend)
        inputs[f"mass_{letter}"] = Normal(mass * generator.normal(1.0, MASS_ERROR), mass * MASS_ERROR)
        inputs[f"course_{letter}"] = Normal(course + generator.normal(0.0, COURSE_ERROR), COURSE_ERROR)
        inputs[f"survey_speed_{letter}"] = Normal(0.0, given[letter].speed_error)
        inputs[f"survey_course_{letter}"] = Normal(0.0, given[letter].course_error)

    def model(**values: Any) -> dict[str, Any]:
        known = {}
        for letter, (points, headings) in zip("ab", surveys, strict=True):
            yawing = 1.0 - YAWING * (ARM * given[letter].yaw_rate / given[letter].speed) ** 2
            friction = values["friction"] * values[f"drag_{letter}"] * yawing
            run = travel.path(points, headings, friction=friction, lock=values[f"lock_{letter}"])
            known[f"speed_{letter}_after"] = run.speed + values[f"survey_speed_{letter}"]
            known[f"course_{letter}_after"] = run.course + values[f"survey_course_{letter}"] + values[f"bend_{letter}"]
            known[f"course_{letter}"] = values[f"course_{letter}"]
        found = reconstruct.momentum(values["mass_a"], values["mass_b"], **known)
        return {"speed_a": found.speed_a, "speed_b": found.speed_b}

    found = propagate(model, inputs, method="quasi_random", samples=SAMPLES, seed=int(generator.integers(2**31)))
    return {name: found[name].interval(0.95) for name in ("speed_a", "speed_b")}


ROUTES: dict[str, Callable[[Crash, np.random.Generator], Speeds]] = {"momentum from smoothed paths": by_momentum}


def measured(route: Callable[[Crash, np.random.Generator], Speeds], drawn: list[Crash], seed: int) -> dict[str, Any]:
    """How often a route holds the truth and how wide it is, of crashes it does not warn of and of those it does."""
    missed: dict[bool, list[int]] = {False: [], True: []}
    widths, refused = [], 0
    for i, crash in enumerate(drawn):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", col.CollisionsWarning)
            try:
                found = route(crash, np.random.default_rng([seed, i]))
            except col.CollisionsError:
                refused += 1
                continue
        for name, truth in crash.speeds.items():
            low, high = found[name]
            missed[bool(caught)].append(int(truth > high) - int(truth < low))
            if not caught:
                widths.append(0.5 * (high - low) * KMH)
    counts = {
        key: {"intervals": len(found), "held": found.count(0), "above": found.count(1), "below": found.count(-1)}
        for key, found in (("plain", missed[False]), ("warned", missed[True]))
    }
    return {
        "crashes": len(drawn),
        "refused": refused,
        **counts,
        "half_width": [round(float(np.percentile(widths, p)), 2) for p in (10, 50, 90)],
    }


def model_error(drawn: list[Crash]) -> dict[str, float]:
    """What ``path`` of exact points is off by: the numbers YAWING, YAWING_LEFT and BEND, of ways that it does not warn of."""
    yaws, factors, bends = [], [], []
    for crash in drawn:
        for side, way, lock in zip((crash.impact.a, crash.impact.b), crash.ways, crash.locks, strict=True):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always", col.CollisionsWarning)
                run = travel.path(*surveyed(way), friction=crash.friction, lock=lock)
            if caught:
                continue
            yaws.append((ARM * run.yaw_rate / run.speed) ** 2)
            factors.append((side.after.speed / run.speed) ** 2)
            turn = math.remainder(run.course - side.after.course, 2.0 * math.pi)
            bends.append(turn * run.speed**2 / (WINDOW**2 * crash.friction * travel.GRAVITY))
    squares, missing = np.array(yaws), 1.0 - np.array(factors)
    slope = float(np.sum(squares * missing) / np.sum(squares**2))
    return {
        "YAWING": slope,
        "YAWING_LEFT": float(np.std(missing - slope * squares)),
        "BEND": float(np.sqrt(np.mean(np.square(bends)))),
    }


def _quiet(side: Any) -> bool:
    """Whether ``path`` has no reason to warn of the yaw."""
    return abs(side.after.yaw_rate) * ARM < 0.5 * side.after.speed


def survey_errors(drawn: list[Crash], seed: int) -> list[dict[str, float]]:
    """Root mean square error of course and speed by the spacing of the points, by three points alone and smoothed."""
    rows = []
    for spacing in SPACINGS:
        row = {"spacing": spacing}
        for name, window in (("three", 0.0), ("smoothed", WINDOW)):
            turns, speeds = [], []
            for i, crash in enumerate(drawn):
                for side, way, lock in zip((crash.impact.a, crash.impact.b), crash.ways, crash.locks, strict=True):
                    survey = surveyed(way, np.random.default_rng([seed, i]), spacing)
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore", col.CollisionsWarning)
                        run = travel.path(*survey, friction=crash.friction, lock=lock, window=window)
                    turns.append(math.degrees(math.remainder(run.course - side.after.course, 2.0 * math.pi)))
                    speeds.append(run.speed / side.after.speed - 1.0)
            row[f"{name}_course"], row[f"{name}_speed"] = (
                round(float(np.sqrt(np.mean(np.square(errors)))), 4) for errors in (turns, speeds)
            )
        rows.append(row)
    return rows


def main() -> None:
    """Measure every route and write the numbers."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help=f"{QUICK} crashes, to see that everything runs")
    parser.add_argument("--json", type=Path, default=DATA)
    parser.add_argument(
        "--route", action="append", choices=list(ROUTES), help="only this one; the others stay as they are in the file"
    )
    parser.add_argument("--model-error", action="store_true", help="print how far the drag of path is off, and stop")
    options = parser.parse_args()
    count = QUICK if options.quick else CRASHES
    if options.model_error:
        print(model_error(crashes(count, SEED + 1)))
        return
    found = json.loads(options.json.read_text("utf-8")) if options.route and options.json.exists() else {"routes": {}}
    drawn = crashes(count, SEED)
    for name in options.route or ROUTES:
        found["routes"][name] = measured(ROUTES[name], drawn, SEED)
        row = found["routes"][name]
        print(name, row)
    if not options.route:
        quiet = [crash for crash in drawn if all(_quiet(side) for side in (crash.impact.a, crash.impact.b))]
        found["survey"] = survey_errors(quiet[:COMPARED], SEED)
    options.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
