"""What ``travel.simulate`` errs by, and what each way to work out a run-out costs.

``python benchmarks/run_outs.py`` follows 1,000 run-outs at the default tolerance and at a tight one
and prints how far places of rest, headings and times are apart, then the ladder of run-outs: time
against error. ``--json PATH`` also writes both, as docs/_generated/run_outs.json, which the page
"Run-outs" shows. ``--quick`` takes few scenes.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
if str(ROOT / "src") not in sys.path:
    sys.path.insert(0, str(ROOT / "src"))

import speed_rivals

import collisions as col
from collisions import travel

# A twentieth of the default's error and less; the tests have an integration of their own.
TIGHT = 1e-9
PROMISED = 1e-3
KINDS = ("locked", "alike", "unlike", "jammed")


class Scene(NamedTuple):
    """Run-outs that are followed together: vehicles, tyres, and areas that they share."""

    vehicle: col.Vehicle
    tyres: travel.Tyres
    surfaces: Any = None
    slope: Any = (0.0, 0.0)


def scenes(count: int, seed: int) -> list[Scene]:
    """Run-outs of every kind of lock, half of them over areas of another friction, in groups."""
    rng = np.random.default_rng(seed)
    groups, each = 20, max(2, count // 20)
    return [_group(rng, each, group) for group in range(groups)]


def _group(rng: np.random.Generator, each: int, group: int) -> Scene:
    vehicle = col.Vehicle(
        mass=1500.0,
        yaw_inertia=rng.uniform(1800.0, 3200.0, each),
        x=0.0,
        y=0.0,
        heading=rng.uniform(-3.0, 3.0, each),
        vx=rng.uniform(4.0, 20.0, each),
        vy=rng.normal(0.0, 3.0, each),
        yaw_rate=rng.normal(0.0, 2.5, each),
    )
    more: dict[str, Any] = {}
    if group % 5 == 1:
        more["steer"] = rng.uniform(-0.4, 0.4, each)
    if group % 5 == 2:
        more["height"] = rng.uniform(0.3, 0.6, each)
    friction = rng.uniform(0.4, 0.9, each)
    tyres = travel.Tyres(friction, locks(rng, KINDS[group % 4], each), 2.6, 1.5, **more)
    surfaces = None
    if group % 2:
        surfaces = []
        for _ in range(3):
            x, y = rng.uniform(1.0, 18.0), rng.uniform(-9.0, 6.0)
            wide, high = rng.uniform(0.5, 8.0, 2)
            corners = [(x, y), (x + wide, y), (x + wide, y + high), (x, y + high)]
            surfaces.append((corners, float(rng.uniform(0.05, 0.9))))
    slope = tuple(rng.uniform(-0.03, 0.03, 2)) if group % 10 in (4, 5) else (0.0, 0.0)
    return Scene(vehicle, tyres, surfaces, slope)


def locks(rng: np.random.Generator, kind: str, each: int) -> Any:
    """One lock for all wheels, or four."""
    if kind == "locked":
        return 1.0
    if kind == "alike":
        return rng.uniform(0.1, 1.0, each)
    if kind == "unlike":
        return [rng.uniform(0.1, 1.0, each) for _ in range(4)]
    jammed = rng.integers(0, 4, each)
    return [np.where(jammed == wheel, 1.0, 0.05) for wheel in range(4)]


def followed(scene: Scene, **options: Any) -> Any:
    """Their paths."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        return travel.simulate(
            *scene[:2], surfaces=scene.surfaces, slope=scene.slope, moments=2, **options
        )


def promise(count: int, seed: int) -> dict[str, Any]:
    """How far the default tolerance is from a tight one, over so many scenes.

    Beside what is beyond the promise stands how far a change of the speed by 1e-5 moves the same
    rests: those of scenes on a knife's edge.
    """
    errors, moved, refused = [], [], 0
    for scene in scenes(count, seed):
        ours, tight = followed(scene), followed(scene, tolerance=TIGHT)
        way = np.hypot(tight.rest.x, tight.rest.y)
        found = np.array(
            [
                _apart(ours.rest, tight.rest) / way,
                abs(ours.rest.heading - tight.rest.heading),
                abs(ours.time[-1] / tight.time[-1] - 1.0),
            ]
        )
        refused += int(np.count_nonzero(np.isnan(found[0])))
        if np.nanmax(found) > PROMISED:
            faster = scene.vehicle.replace(vx=scene.vehicle.vx * (1.0 + 1e-5))
            other = followed(scene._replace(vehicle=faster), tolerance=TIGHT).rest
            beyond = np.any(found > PROMISED, axis=0)
            moved += (_apart(other, tight.rest) / way)[beyond].tolist()
        errors.append(found)
    rows = np.concatenate(errors, axis=1)
    rows = rows[:, ~np.isnan(rows[0])]
    return {
        "scenes": rows.shape[1],
        "refused": refused,
        "beyond": len(moved),
        "moved_by_speed": [rounded(value) for value in moved],
        **{
            name: {
                "median": rounded(np.median(row)),
                "p99": rounded(np.quantile(row, 0.99)),
                "largest": rounded(np.max(row)),
            }
            for name, row in zip(("place", "heading", "time"), rows, strict=True)
        },
    }


def _apart(one: col.Vehicle, other: col.Vehicle) -> Any:
    return np.hypot(one.x - other.x, one.y - other.y)


def rounded(value: Any) -> float:
    """Three digits."""
    return float(f"{float(value):.3g}")


HEIGHT = 0.55


def ladder(count: int, seed: int) -> dict[str, Any]:
    """Every way to work out a run-out against a tight integration with load transfer."""
    rng = np.random.default_rng(seed)
    start = col.Vehicle(
        mass=1500.0,
        yaw_inertia=2400.0,
        x=0.0,
        y=0.0,
        heading=rng.uniform(-1.0, 1.0, count),
        vx=rng.uniform(8.0, 20.0, count),
        vy=0.0,
        yaw_rate=rng.normal(0.0, 2.0, count),
    )
    lock = [rng.choice([0.05, 0.1, 0.4, 1.0], count) for _ in range(4)]
    lower = travel.Tyres(0.7, lock, 2.7, 1.5)
    tyres = lower.replace(height=HEIGHT)
    truth = travel.simulate(start, tyres, moments=17, tolerance=1e-8)
    way = np.sum(np.hypot(np.diff(truth.x, axis=0), np.diff(truth.y, axis=0)), axis=0)
    straight = np.hypot(truth.rest.x, truth.rest.y)
    share = sum(lock) / 4.0
    places = [list(pair) for pair in zip(truth.x[::2], truth.y[::2], strict=True)]
    headings = list(truth.heading[::2])

    def by_path() -> Any:
        return travel.path(places, headings, friction=0.7, lock=share).speed

    rows = []
    for key, name, call in (
        ("full", "straight to rest, drag = friction", lambda: travel.speed(straight, drag=0.7)),
        (
            "braked",
            "straight to rest, drag = friction x mean lock",
            lambda: travel.speed(straight, drag=0.7 * share),
        ),
        ("path", "`path` of nine points", by_path),
    ):
        seconds, found = timed(call)
        rows.append(_row(key, name, seconds / count, abs(found / start.speed - 1.0)))
    for key, name, own, tolerance in (
        ("coarse", "`simulate`, tolerance 1e-3", lower, 1e-3),
        ("middle", "`simulate`, tolerance 1e-5", lower, 1e-5),
        ("default", "`simulate`, default tolerance", lower, None),
        ("transfer", f"`simulate`, load transfer with a height of {HEIGHT:g} m", tyres, None),
    ):
        options: dict[str, Any] = {} if tolerance is None else {"tolerance": tolerance}
        seconds, found = timed(
            lambda own=own, options=options: travel.simulate(start, own, moments=2, **options)
        )
        rest = found.rest
        # The square of the speed goes with the way.
        speed = abs(np.sqrt(straight / np.hypot(rest.x, rest.y)) - 1.0)
        row = _row(key, name, seconds / count, speed)
        row["place"] = _spread(_apart(rest, truth.rest) / way)
        row["heading"] = _spread(np.degrees(abs(rest.heading - truth.rest.heading)))
        rows.append(row)
    return {"cases": count, "height": HEIGHT, "rows": rows}


def _row(key: str, name: str, seconds: float, error: Any) -> dict[str, Any]:
    cost = rounded(seconds / bare())
    return {"key": key, "name": name, "cost": cost, "speed": _spread(error)}


def _spread(error: Any) -> dict[str, float]:
    error = error[np.isfinite(error)]
    return {"median": rounded(np.median(error)), "p90": rounded(np.quantile(error, 0.9))}


def timed(call: Callable[[], Any]) -> tuple[float, Any]:
    """Processor time of the faster of two calls, and what it gave."""
    best = float("inf")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        for _ in range(2):
            start = time.process_time()
            found = call()
            best = min(best, time.process_time() - start)
    return best, found


def bare() -> float:
    """Seconds of the textbook formula of an impact as a bare function of floats."""
    numbers = (1500.0, 2400.0, 13.9, 0.0, 0.0, -2.0, 0.4, 1200.0, 1700.0, 0.0, 11.1, 0.0, 0.8, -1.2)

    def many() -> None:
        for _ in range(2000):
            speed_rivals.formula(*numbers, 0.1, 0.1, 0.0, 0.0, 0.5)

    return timed(many)[0] / 2000.0


def measure(quick: bool = False) -> dict[str, Any]:
    """All of it."""
    return {
        "promised": PROMISED,
        "promise": promise(40 if quick else 1000, 2),
        "ladder": ladder(50 if quick else 500, 5),
    }


def main() -> None:
    """Measure, print, and write if asked to."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", type=Path)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    found = measure(options.quick)
    text = json.dumps(found, indent=1) + "\n"
    print(text)
    if options.json:
        options.json.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
