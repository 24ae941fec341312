"""Cost of a large batch: the library against plain numpy, one thread against two, float32 against
float64.

``python benchmarks/batch_speed.py [file.json]`` prints a table, and writes it when a file is named.
Everything compared runs in turn in one process, so that a slow spell of the machine meets all of
it; the ratio is that of the fastest runs, its spread that of the rounds. The plain formula below is
what one would write without the library: whole arrays and ``np.where``.
"""

from __future__ import annotations

import argparse
import json
import platform
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

SOURCE = Path(__file__).resolve().parent.parent / "src"
if str(SOURCE) not in sys.path:
    sys.path.insert(0, str(SOURCE))

import collisions as col

CASES = 1_000_000
ROUNDS = 9
SEED = 20240611
BODY = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y")


def scenes(count: int, dtype: Any = np.float64) -> dict[str, Any]:
    """Cars that meet at random angles, every input an array; all of them collide."""
    rng = np.random.default_rng(SEED)

    def body(sign: float) -> dict[str, Any]:
        mass = rng.uniform(900.0, 2200.0, count)
        return {
            "mass": mass,
            "yaw_inertia": mass * rng.uniform(1.2, 2.2, count),
            "vx": sign * rng.uniform(8.0, 25.0, count),
            "vy": rng.normal(0.0, 2.0, count),
            "yaw_rate": rng.normal(0.0, 0.2, count),
            "x": -sign * rng.uniform(1.0, 2.2, count),
            "y": rng.normal(0.0, 0.5, count),
        }

    found = {
        "a": body(1.0),
        "b": body(-1.0),
        "restitution": rng.uniform(0.0, 0.4, count),
        "normal": rng.normal(0.0, 0.2, count),
        "point": (rng.normal(0.0, 0.2, count), rng.normal(0.0, 0.4, count)),
        "friction": rng.uniform(0.0, 0.8, count),
    }
    return {name: _cast(value, dtype) for name, value in found.items()}


def _cast(value: Any, dtype: Any) -> Any:
    if isinstance(value, dict):
        return {name: _cast(part, dtype) for name, part in value.items()}
    return (
        tuple(_cast(part, dtype) for part in value)
        if isinstance(value, tuple)
        else value.astype(dtype)
    )


def textbook(
    a: dict[str, Any], b: dict[str, Any], restitution: Any, normal: Any, point: Any, friction: Any
) -> tuple[Any, ...]:
    """Planar impact mechanics with Coulomb friction, as one writes it: velocities and yaw rates
    after, impulses, loss.
    """
    nx, ny = np.cos(normal), np.sin(normal)
    px, py = point
    rx1, ry1 = px - a["x"], py - a["y"]
    rx2, ry2 = px - b["x"], py - b["y"]
    ux = (b["vx"] - b["yaw_rate"] * ry2) - (a["vx"] - a["yaw_rate"] * ry1)
    uy = (b["vy"] + b["yaw_rate"] * rx2) - (a["vy"] + a["yaw_rate"] * rx1)
    un, ut = ux * nx + uy * ny, uy * nx - ux * ny
    rn1, rt1 = rx1 * nx + ry1 * ny, ry1 * nx - rx1 * ny
    rn2, rt2 = rx2 * nx + ry2 * ny, ry2 * nx - rx2 * ny
    m1, m2, i1, i2 = a["mass"], b["mass"], a["yaw_inertia"], b["yaw_inertia"]
    knn = 1 / m1 + 1 / m2 + rt1 * rt1 / i1 + rt2 * rt2 / i2
    ktt = 1 / m1 + 1 / m2 + rn1 * rn1 / i1 + rn2 * rn2 / i2
    knt = -(rn1 * rt1 / i1 + rn2 * rt2 / i2)
    det = knn * ktt - knt * knt
    vn = -(1 + restitution) * un
    stick_n = (ktt * vn + knt * ut) / det
    stick_t = -(knt * vn + knn * ut) / det
    sticks = (stick_n > 0) & (np.abs(stick_t) <= friction * stick_n)
    mu = np.where(stick_t < 0, -friction, friction)
    slide_n = vn / (knn + mu * knt)
    pn = np.where(sticks, stick_n, slide_n)
    pt = np.where(sticks, stick_t, mu * slide_n)
    fx, fy = pn * nx - pt * ny, pn * ny + pt * nx
    vx1, vy1 = a["vx"] - fx / m1, a["vy"] - fy / m1
    vx2, vy2 = b["vx"] + fx / m2, b["vy"] + fy / m2
    w1 = a["yaw_rate"] - (rx1 * fy - ry1 * fx) / i1
    w2 = b["yaw_rate"] + (rx2 * fy - ry2 * fx) / i2
    before = m1 * (a["vx"] * a["vx"] + a["vy"] * a["vy"]) + i1 * a["yaw_rate"] * a["yaw_rate"]
    before = (
        before + m2 * (b["vx"] * b["vx"] + b["vy"] * b["vy"]) + i2 * b["yaw_rate"] * b["yaw_rate"]
    )
    after = (
        m1 * (vx1 * vx1 + vy1 * vy1) + i1 * w1 * w1 + m2 * (vx2 * vx2 + vy2 * vy2) + i2 * w2 * w2
    )
    answers = vx1, vy1, w1, vx2, vy2, w2, pn, pt, (before - after) / 2
    return tuple(np.where(un < 0, answer, np.nan) for answer in answers)


def states(scene: dict[str, Any]) -> dict[str, Any]:
    """The same scene for the library: the vehicles made."""
    return {**scene, "a": col.Vehicle(**scene["a"]), "b": col.Vehicle(**scene["b"])}


def library(
    a: col.Vehicle, b: col.Vehicle, restitution: Any, threads: int = 1, **rest: Any
) -> tuple[Any, ...]:
    """The same nine answers from the library."""
    impact = col.eccentric(a, b, restitution, threads=threads, on_failure="nan", **rest)
    return (*_motion(impact), impact.normal_impulse, impact.tangential_impulse, impact.energy_loss)


def central(a: col.Vehicle, b: col.Vehicle, restitution: Any) -> tuple[Any, ...]:
    """What a linear central impact answers."""
    impact = col.linear_central(a, b, restitution)
    return impact.a.after.vx, impact.b.after.vx, impact.normal_impulse, impact.energy_loss


def _motion(impact: col.Impact) -> tuple[Any, ...]:
    a, b = impact.a.after, impact.b.after
    return a.vx, a.vy, a.yaw_rate, b.vx, b.vy, b.yaw_rate


def timed(work: Callable[[], Any]) -> float:
    """Seconds that a call takes."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def rounds(works: dict[str, Callable[[], Any]], count: int) -> dict[str, list[float]]:
    """Seconds of each work in each round, all of them once a round."""
    for work in works.values():
        work()
    found: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(count):
        for name, work in works.items():
            found[name].append(timed(work))
    return found


def ratio(times: dict[str, list[float]], one: str, other: str) -> dict[str, float]:
    """How much one costs of the other: the fastest runs, and the quartiles of the rounds."""
    each = [x / y for x, y in zip(times[one], times[other], strict=True)]
    low, _, high = statistics.quantiles(each, n=4)
    return {"best": min(times[one]) / min(times[other]), "low": low, "high": high}


def works(count: int = CASES) -> dict[str, Callable[[], Any]]:
    """What is measured, by name; each gives back what it worked out."""
    scene, single = scenes(count), scenes(count, np.float32)
    ours, ours_single = states(scene), states(single)
    along = (
        {"mass": scene["a"]["mass"], "vx": scene["a"]["vx"]},
        {"mass": scene["b"]["mass"], "vx": scene["b"]["vx"]},
    )
    pair = col.Vehicle(**along[0]), col.Vehicle(**along[1])
    moved = [
        *along[0].values(),
        *along[1].values(),
        scene["restitution"],
        *central(*pair, scene["restitution"]),
    ]
    return {
        "numpy": lambda: textbook(**scene),
        "library": lambda: library(**ours),
        "library, two threads": lambda: library(**ours, threads=2),
        "library, with the vehicles made": lambda: library(**states(scene)),
        "library, float32": lambda: library(**ours_single),
        "numpy, float32": lambda: textbook(**single),
        "library, linear_central": lambda: central(*pair, scene["restitution"]),
        "its inputs and answers moved once": lambda: [array.copy() for array in moved],
    }


def measure(count: int = CASES, repeats: int = ROUNDS) -> dict[str, Any]:
    """Nanoseconds a case, and the ratios the budgets of the project are set in."""
    measured = works(count)
    for answer, wanted in zip(measured["library"](), measured["numpy"](), strict=True):
        np.testing.assert_allclose(answer, wanted, rtol=1e-6, atol=1e-6)
    times = rounds(measured, repeats)
    compared = (
        ("library", "numpy"),
        ("library, two threads", "library"),
        ("library, with the vehicles made", "numpy"),
        ("library, float32", "library"),
        ("library, float32", "numpy, float32"),
        ("library, linear_central", "its inputs and answers moved once"),
    )
    return {
        "cases": count,
        "rounds": repeats,
        "machine": {
            "python": platform.python_version(),
            "numpy": np.__version__,
            "processor": platform.machine(),
        },
        "nanoseconds a case": {name: 1e9 * min(seconds) / count for name, seconds in times.items()},
        "ratios": [{"of": one, "to": other, **ratio(times, one, other)} for one, other in compared],
    }


def show(found: dict[str, Any]) -> None:
    """The table, for people."""
    print(f"{found['cases']} cases, best of {found['rounds']} rounds")
    for name, cost in found["nanoseconds a case"].items():
        print(f"  {name:40s}{cost:8.1f} ns a case")
    for line in found["ratios"]:
        names = f"{line['of']} / {line['to']}"
        print(
            f"  {names:64s}{line['best']:6.2f}   half of the rounds {line['low']:.2f} to "
            f"{line['high']:.2f}"
        )


def main() -> None:
    """Measures, prints, and writes JSON when asked to."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("file", nargs="?", type=Path, help="where to write the table as JSON")
    parser.add_argument("--cases", type=int, default=CASES)
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    options = parser.parse_args()
    found = measure(options.cases, options.rounds)
    show(found)
    if options.file is not None:
        options.file.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
