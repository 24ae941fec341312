"""Whether stated ranges of run-outs hold cars whose wheels spin: an integration of the wheels'
own, which shares no line with the library.

``python benchmarks/run_out_coverage.py`` follows 200 cars with unequal brakes to rest, the spin of
every wheel integrated, reads from each what an analyst would read, with errors, and counts how
often a 95 % range of ``propagate`` holds the truth: speed and yaw rate at separation by
``travel.path`` from points of the way, place and heading of rest by ``travel.simulate`` from the
motion at separation. ``--json PATH`` also writes the table, as
docs/_generated/run_out_coverage.json. ``--quick`` takes few cars.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
if str(ROOT / "src") not in sys.path:
    sys.path.insert(0, str(ROOT / "src"))

import collisions as col
from collisions import travel
from collisions.uncertainty import Normal, propagate

CARS, SAMPLES, SEED = 200, 512, 37
# Other run-outs, from which it is measured how far path is off where all is read without error.
OTHERS, OTHER_SEED = 400, 370
GRAVITY, RADIUS, SPIN_INERTIA, CORNERING = 9.80665, 0.3, 1.0, 9.5
MASS, INERTIA, WHEELBASE, TRACK = 1500.0, 2400.0, 2.7, 1.5
AHEAD = np.array([1.0, 1.0, -1.0, -1.0])[:, None] * WHEELBASE / 2
LEFT = np.array([1.0, -1.0, 1.0, -1.0])[:, None] * TRACK / 2
STEP, SLOW = 2e-4, 0.3
POINTS = 9
KINDS = ("one jammed", "front", "left", "each its own")
# What is read errs by, one standard deviation: speed, course, yaw rate, friction, lock; place,
# heading along the way.
ERRORS = {"speed": 0.03, "course": 0.03, "yaw_rate": 0.1, "friction": 0.05, "lock": 0.05}
ROTATING = 4.0 * SPIN_INERTIA / RADIUS**2 / MASS
ROTATING_ERROR = 0.01
PLACE, HEADING = 0.1, math.radians(3.0)
LEAST, POOLED = 0.95, 0.94


def cars(count: int, rng: np.random.Generator) -> dict[str, Any]:
    """Motions at separation, friction and the lock of each wheel."""
    kind = np.arange(count) % len(KINDS)
    low = rng.uniform(0.03, 0.15, (4, count))
    lock = rng.uniform(0.05, 1.0, (4, count))
    jammed = np.arange(4)[:, None] == rng.integers(0, 4, count)
    lock = np.where(kind == 0, np.where(jammed, 1.0, low), lock)
    lock[2:] = np.where(kind == 1, low[2:], lock[2:])
    lock[1::2] = np.where(kind == 2, low[1::2], lock[1::2])
    return {
        "kind": kind,
        "lock": lock,
        "friction": rng.uniform(0.5, 0.8, count),
        "speed": rng.uniform(8.0, 20.0, count),
        "course": rng.uniform(-0.4, 0.4, count),
        "yaw_rate": rng.normal(0.0, 1.5, count),
    }


def integrated(car: dict[str, Any]) -> dict[str, Any]:
    """Times, places and headings of all cars until they rest, by the spin of their wheels.

    The contact of a wheel slips by the difference between its motion and its turning; the force is
    against that slip, of a brush of bristles that stick and then slide, and turns the wheel, which
    the moment of the brake holds. The spin is solved implicitly, as it follows within milliseconds.
    """
    count = car["speed"].size
    vx, vy = car["speed"] * np.cos(car["course"]), car["speed"] * np.sin(car["course"])
    turn, x, y, heading = car["yaw_rate"].copy(), *np.zeros((3, count))
    load, mu = MASS * GRAVITY / 4.0, car["friction"]
    moment = car["lock"] * mu * load * RADIUS
    spin = np.where(car["lock"] >= 1.0, 0.0, vx / RADIUS) * np.ones((4, 1))
    rows, going = [], np.ones(count, dtype=bool)
    rest = np.full((4, count), np.nan)
    for at in range(200_000):
        c, s = np.cos(heading), np.sin(heading)
        along = c * vx + s * vy - turn * LEFT
        across = c * vy - s * vx + turn * AHEAD
        spin, px, py = _wheels(along, across, spin, moment, mu * load, mu)
        ax = (c * px.sum(0) - s * py.sum(0)) / MASS
        ay = (s * px.sum(0) + c * py.sum(0)) / MASS
        if at % 100 == 0:
            rows.append((x.copy(), y.copy(), heading.copy()))
        speed = np.sqrt(vx**2 + vy**2 + (1.5 * turn) ** 2)
        ends = going & (speed < SLOW)
        if ends.any():
            # Less than two centimetres are left.
            slowed = np.maximum(-(vx * ax + vy * ay) / np.maximum(speed, 1e-9), 0.05)
            left = 0.5 * speed / slowed
            last = [x + left * vx, y + left * vy, heading + left * turn, 0.0 * x + at * STEP]
            rest[:, ends] = np.array(last)[:, ends]
            going &= ~ends
        if not going.any():
            break
        yaw = (AHEAD * py - LEFT * px).sum(0) / INERTIA
        vx, vy, turn = (
            np.where(going, part, 0.0)
            for part in (vx + STEP * ax, vy + STEP * ay, turn + STEP * yaw)
        )
        x, y, heading = x + STEP * vx, y + STEP * vy, heading + STEP * turn
    return {"rows": np.array(rows), "rest": rest}


def _wheels(
    along: Any, across: Any, spin: Any, moment: Any, most: Any, mu: Any
) -> tuple[Any, Any, Any]:
    """Spin after a step, and the force of each wheel ahead and to the left."""
    slip = along - RADIUS * spin
    rolling = np.maximum(abs(RADIUS * spin), 0.02 * abs(along) + 0.05)
    size = np.sqrt(slip * slip + across * across) + 1e-9
    bristles = np.minimum(CORNERING * size / (3.0 * mu * rolling), 1.0)
    force = most * (1.0 - (1.0 - bristles) ** 3)
    # What the force loses as the wheel turns faster, for the implicit step.
    stiff = force / size * RADIUS * RADIUS
    pull = force * slip / size * RADIUS
    share = STEP / SPIN_INERTIA
    free = (spin + share * (pull + stiff * spin)) / (1.0 + share * stiff)
    holds = share * moment / (1.0 + share * stiff)
    new = np.sign(free) * np.maximum(abs(free) - holds, 0.0)
    after = along - RADIUS * new
    size = np.sqrt(after * after + across * across) + 1e-9
    return new, -force * after / size, -force * across / size


def off_by_path(count: int) -> dict[str, float]:
    """What ``path`` is off by in other run-outs, those of ``simulate``, from as many points and
    without errors: standard deviations of the logarithm of the speed and of the yaw rate.
    """
    rng = np.random.default_rng(OTHER_SEED)
    speed, course = rng.uniform(6.0, 25.0, count), rng.uniform(-0.5, 0.5, count)
    yaw_rate = rng.uniform(-3.0, 3.0, count)
    start = col.Vehicle(
        mass=MASS,
        yaw_inertia=MASS * rng.uniform(1.3, 1.9, count),
        x=0.0,
        y=0.0,
        heading=0.0,
        vx=speed * np.cos(course),
        vy=speed * np.sin(course),
        yaw_rate=yaw_rate,
    )
    locks = [rng.uniform(0.0, 1.0, count) ** 2 for _ in range(4)]
    sizes = rng.uniform(2.4, 2.9, count), rng.uniform(1.4, 1.6, count)
    tyres = travel.Tyres(rng.uniform(0.4, 0.9, count), locks, *sizes)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        way = travel.simulate(start, tyres, moments=401, tolerance=1e-5)
        rows = np.array([way.x, way.y, way.heading])
        places = np.array([along(rows[:, :, at]) for at in range(count)])
        read = travel.path(
            [(places[:, 0, i], places[:, 1, i]) for i in range(POINTS)],
            [places[:, 2, i] for i in range(POINTS)],
            tyres=tyres,
        )
    return {
        "speed": float(np.nanstd(np.log(read.speed / speed))),
        "yaw_rate": float(np.nanstd(read.yaw_rate - yaw_rate)),
    }


def along(rows: Any) -> Any:
    """Place and heading at points in equal distances along the way."""
    x, y, _ = rows
    ways = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    return [np.interp(np.linspace(0.0, ways[-1], POINTS), ways, part) for part in rows]


def held(
    car: dict[str, Any], found: dict[str, Any], rng: np.random.Generator, off: dict[str, float]
) -> Any:
    """For each car whether the ranges hold the truth, by output; NaN where no range is stated."""
    rows = []
    for at in range(car["speed"].size):
        one = {name: value[..., at] for name, value in car.items()}
        read = {
            name: Normal(float(one[name] + error * rng.normal()), error)
            for name, error in ERRORS.items()
            if name != "lock"
        }
        speed = float(one["speed"] * (1.0 + ERRORS["speed"] * rng.normal()))
        read["speed"] = Normal(speed, ERRORS["speed"] * speed)
        rotating = ROTATING + ROTATING_ERROR * rng.normal()
        read["rotating_mass"] = Normal(rotating, ROTATING_ERROR, truncate=(0.0, 1.0))
        locks = {
            f"lock_{wheel}": _lock(float(lock), float(rng.normal()))
            for wheel, lock in enumerate(one["lock"])
        }
        rows.append(
            {
                "kind": int(one["kind"]),
                **_by_path(one, found, at, read, locks, rng, off),
                **_by_simulate(found, at, read, locks),
            }
        )
    return rows


def _lock(lock: float, off: float) -> Any:
    """A lock as it is read. That a wheel is jammed is seen: a range of locks that ends at 1 would
    never hold it.
    """
    error = ERRORS["lock"]
    return 1.0 if lock >= 1.0 else Normal(lock + error * off, error, truncate=(0.0, 1.0))


def _stated(
    model: Any, inputs: Any, truths: dict[str, float], method: str = "quasi_random"
) -> dict[str, float]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        try:
            result = propagate(model, inputs, method=method, samples=SAMPLES, seed=1)
        except col.CollisionsError:
            return dict.fromkeys(truths, math.nan)
    held = {}
    for name, truth in truths.items():
        low, high = result[name].interval(0.95)
        held[name] = float(low <= truth <= high)
    return held


def _by_path(
    one: dict[str, Any],
    found: dict[str, Any],
    at: int,
    read: Any,
    locks: Any,
    rng: Any,
    model_error: dict[str, float],
) -> dict[str, float]:
    places = along(found["rows"][:, :, at].T)
    inputs = {name: read[name] for name in ("friction", "rotating_mass")} | locks
    inputs |= {f"{name}_off": Normal(0.0, error) for name, error in model_error.items()}
    for name, part, error in zip("xyh", places, (PLACE, PLACE, HEADING), strict=True):
        off = part + error * rng.normal(size=POINTS)
        inputs |= {f"{name}{i}": Normal(float(off[i]), error) for i in range(POINTS)}

    def model(
        friction: Any, rotating_mass: Any, lock_0: Any, lock_1: Any, lock_2: Any, lock_3: Any,
        speed_off: Any, yaw_rate_off: Any, **p: Any,
    ) -> Any:  # fmt: skip
        way = travel.path(
            [(p[f"x{i}"], p[f"y{i}"]) for i in range(POINTS)],
            [p[f"h{i}"] for i in range(POINTS)],
            tyres=travel.Tyres(friction, [lock_0, lock_1, lock_2, lock_3], WHEELBASE, TRACK),
            rotating_mass=rotating_mass,
        )
        return {
            "path: speed": way.speed * np.exp(speed_off),
            "path: yaw rate": way.yaw_rate + yaw_rate_off,
        }

    truths = {"path: speed": float(one["speed"]), "path: yaw rate": float(one["yaw_rate"])}
    # More inputs than quasi-random points are spread over.
    return _stated(model, inputs, truths, "monte_carlo")


def _by_simulate(found: dict[str, Any], at: int, read: Any, locks: Any) -> dict[str, float]:
    def model(
        speed: Any, course: Any, yaw_rate: Any, friction: Any, rotating_mass: Any, lock_0: Any,
        lock_1: Any, lock_2: Any, lock_3: Any,
    ) -> Any:  # fmt: skip
        start = col.Vehicle(
            mass=MASS,
            yaw_inertia=INERTIA,
            x=0.0,
            y=0.0,
            heading=0.0,
            vx=speed * np.cos(course),
            vy=speed * np.sin(course),
            yaw_rate=yaw_rate,
        )
        tyres = travel.Tyres(friction, [lock_0, lock_1, lock_2, lock_3], WHEELBASE, TRACK)
        rest = travel.simulate(
            start, tyres, rotating_mass=rotating_mass, moments=2, tolerance=1e-5
        ).rest
        names = ("x", "y", "heading")
        return {f"simulate: {name}": getattr(rest, name) for name in names}

    x, y, heading, _ = found["rest"][:, at].tolist()
    truths = {"simulate: x": x, "simulate: y": y, "simulate: heading": heading}
    return _stated(model, {**read, **locks}, truths)


def binomial(hits: int, count: int, level: float = 0.998) -> tuple[float, float]:
    """Clopper and Pearson's interval, by bisection of the sums of binomial probabilities."""

    def below(p: float, most: int) -> float:
        return sum(math.comb(count, k) * p**k * (1.0 - p) ** (count - k) for k in range(most + 1))

    def root(wanted: float, most: int) -> float:
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if below(middle, most) > wanted else (low, middle)
        return 0.5 * (low + high)

    tail = 0.5 * (1.0 - level)
    low = 0.0 if hits == 0 else root(1.0 - tail, hits - 1)
    return low, 1.0 if hits == count else root(tail, hits)


def table(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Shares held, by output and by kind of brakes."""
    found = []
    for name in (key for key in rows[0] if key != "kind"):
        for kind in (*range(len(KINDS)), None):
            some = [row[name] for row in rows if kind is None or row["kind"] == kind]
            stated = [value for value in some if not math.isnan(value)]
            hits = round(sum(stated))
            low, high = binomial(hits, len(stated)) if stated else (0.0, 1.0)
            found.append(
                {
                    "output": name,
                    "kind": "all" if kind is None else KINDS[kind],
                    "cars": len(stated),
                    "refused": len(some) - len(stated),
                    "held": hits,
                    "low": round(low, 3),
                    "high": round(high, 3),
                }
            )
    return found


def measure(count: int, others: int = OTHERS) -> dict[str, Any]:
    """The table, and what ``path`` was stated to be off by."""
    rng = np.random.default_rng(SEED)
    car, off = cars(count, rng), off_by_path(others)
    return {
        "rows": table(held(car, integrated(car), rng, off)),
        "off": {name: float(f"{value:.3g}") for name, value in off.items()},
    }


def main() -> None:
    """Measure, print, and write if asked to."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", type=Path)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    found = measure(*((16, 50) if options.quick else (CARS, OTHERS)))
    print(f"path off by {found['off']}")
    for row in found["rows"]:
        print(
            f"{row['output']:20}{row['kind']:14}{row['held']:4} of {row['cars']:4}"
            f"{row['refused']:4} refused   {row['low']:.3f} to {row['high']:.3f}"
        )
    if options.json:
        options.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
