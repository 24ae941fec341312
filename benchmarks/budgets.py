"""The budgets of speed and memory: every row is a ratio of two things timed in turn in one process.

``python benchmarks/budgets.py`` measures all rows in five processes, one after the other, and
prints the median of the five and their range against the budget; ``--json PATH`` also writes them,
``--rows a,b`` measures these rows only, ``--once`` prints the ratios of one process as JSON,
``--busy`` takes processor time, for a machine that is not idle, ``--quick`` shows that everything
runs. ``speed.py`` calls ``measure`` for the page "Speed against accuracy".
"""

from __future__ import annotations

import argparse
import ctypes
import gc
import io
import json
import math
import multiprocessing
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
import tracemalloc
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib import pyplot

ROOT = Path(__file__).resolve().parent.parent
if str(ROOT / "src") not in sys.path:
    sys.path.insert(0, str(ROOT / "src"))

import batch_speed
import speed_rivals

import collisions as col
from collisions import plot, reconstruct, travel
from collisions.scene import Contact, Mover, Scene
from collisions.uncertainty import Interval, Normal, Uniform, propagate

RUNS = 5
CLOCKS = {False: time.perf_counter, True: time.process_time}
clock = CLOCKS["--busy" in sys.argv]
# Rounds are cut to this share to see that everything runs.
effort = 0.1 if "--quick" in sys.argv else 1.0
SIZES = (10, 100, 1_000, 8_192, 10_000, 100_000, 1_000_000, 10_000_000)
Calls = dict[str, Callable[[], Any]]
# A call that another is measured against.
_FIXED = ", fixed"


class Budget(NamedTuple):
    """A row of the table: its key, what is measured, the most it may be, and what is aimed at."""

    key: str
    name: str
    budget: float
    aim: float | None = None


BUDGETS = (
    Budget(
        "import",
        "`import collisions` against `import numpy`, best of 15; pint and the solvers are not "
        "loaded",
        1.15,
        1.05,
    ),
    Budget("vehicle", "`Vehicle` from six floats against a bare frozen dataclass with slots", 2.5),
    Budget(
        "eccentric",
        "one `eccentric` against the textbook formula as a bare function of floats",
        3.0,
        2.5,
    ),
    Budget("nine", "the same with nine outputs read", 8.0, 5.5),
    Budget("linear", "one `linear_central` against that formula", 1.15, 0.9),
    Budget("batch", "a million `eccentric`, nine outputs read, against plain numpy", 0.60, 0.45),
    Budget("batch_c", "the same against the formula in C, one thread", 1.7, 1.25),
    Budget("batch_linear", "a million `linear_central` against plain numpy", 1.25, 1.0),
    Budget("batch_8192", "8192 `eccentric`, nine outputs read, against plain numpy", 2.0, 1.3),
    Budget(
        "batch_10",
        "a batch of 10, nine outputs read, against one case of that formula",
        150.0,
        80.0,
    ),
    Budget(
        "processes",
        "two processes with half of a million cases each against one with all",
        0.7,
        0.55,
    ),
    Budget(
        "memory",
        "memory kept a case beyond the inputs that the answer keeps, nine outputs read, in bytes",
        170.0,
    ),
    Budget(
        "quantities",
        "`Vehicle` from six Quantities in US units against six `.to(...).magnitude` of pint",
        0.15,
        0.08,
    ),
    Budget(
        "propagate",
        "quasi-random propagation, 8192 samples of six inputs, against its model once",
        4.0,
        2.5,
    ),
    Budget("speeds", "one `reconstruct.speeds` against one `eccentric`", 300.0, 200.0),
    Budget("solve", "one `solve` against one `eccentric`", 5.0, 3.0),
    Budget(
        "run_out", "one `travel.simulate` of a spun car, lock 0.3, against that formula", 5_000.0
    ),
    Budget("run_out_free", "the same with lock 0.05", 10_000.0),
    Budget(
        "run_out_batch",
        "a batch of 1000 `travel.simulate` for places of rest, lock 0.3, a case against that "
        "formula",
        200.0,
    ),
    Budget("scene", "one `Scene.run` of two cars that meet at touch, to rest", 12_000.0),
    Budget(
        "scene_batch",
        "a batch of 1000 of these, a car of a case against that formula",
        200.0,
    ),
    Budget("in_time", "one `time_resolved` of 100 steps with a drag against that formula", 2_500.0),
    Budget("in_time_batch", "a batch of 1000 of these, a case against that formula", 400.0),
    Budget(
        "engaged",
        "one `time_resolved` with tyres, places given at maximum engagement, against the same with "
        "a fixed geometry",
        2.0,
    ),
    Budget("engaged_batch", "a batch of 1000 of these against the same with a fixed geometry", 2.0),
    Budget("engaged_bare", "one without tyres against the same with a fixed geometry", 2.0),
    Budget("engaged_bare_batch", "a batch of 1000 without tyres against the same", 2.0),
    Budget(
        "required_in_time",
        "one `required_model` with duration and drag against that formula",
        900.0,
    ),
    Budget("report", "`report` of an impact, with its picture, against that formula", 500_000.0),
    Budget(
        "report_uncertain",
        "the same with the ranges of a propagation of 4096 samples",
        800_000.0,
    ),
    Budget("picture", "`plot.scene` of an impact to a PNG against that formula", 200_000.0),
    Budget("intervals", "`propagate` by intervals of one input against that formula", 20_000.0),
    Budget("new", "`python -m collisions new` against `import numpy`, best of 15", 1.4),
    Budget("texts", "the first impact from texts against `import numpy`, best of 15", 2.2),
)
CASE: dict[str, Any] = {"normal": 0.1, "point": (0.0, 0.0), "friction": 0.5}


def fastest(calls: Calls, rounds: int, seconds: float = 0.0) -> dict[str, float]:
    """Seconds of the fastest round of each call, in turn; short calls are repeated for so many
    seconds a round.
    """
    repeats = {}
    for key, call in calls.items():
        call()
        start = clock()
        call()
        repeats[key] = max(1, round(effort * seconds / max(clock() - start, 1e-8)))
    best = dict.fromkeys(calls, float("inf"))
    gc.collect()
    gc.disable()
    try:
        for turn in range(max(2, round(effort * rounds))):
            for key in list(calls)[:: -1 if turn % 2 else 1]:
                call, count = calls[key], repeats[key]
                start = clock()
                for _ in range(count):
                    call()
                best[key] = min(best[key], (clock() - start) / count)
    finally:
        gc.enable()
    return best


def cars() -> tuple[col.Vehicle, col.Vehicle]:
    """Two cars that meet off-centre."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, vx=13.9, x=-2.0, y=0.4)
    return a, col.Vehicle(mass=1200.0, yaw_inertia=1700.0, vy=11.1, x=0.8, y=-1.2)


def nine(impact: col.Impact) -> tuple[Any, ...]:
    """Velocities and yaw rates after, impulses, energy loss."""
    a, b = impact.a.after, impact.b.after
    motion = a.vx, a.vy, a.yaw_rate, b.vx, b.vy, b.yaw_rate
    return (*motion, impact.normal_impulse, impact.tangential_impulse, impact.energy_loss)


def singles(wanted: set[str]) -> dict[str, float]:
    """One case, one vehicle, one reverse solution; and a batch of ten."""
    a, b = cars()
    numbers = (
        1500.0,
        2400.0,
        13.9,
        0.0,
        0.0,
        -2.0,
        0.4,
        1200.0,
        1700.0,
        0.0,
        11.1,
        0.0,
        0.8,
        -1.2,
        0.1,
        0.1,
        0.0,
        0.0,
        0.5,
    )
    impact = col.eccentric(a, b, 0.1, **CASE)
    np.testing.assert_allclose(nine(impact), speed_rivals.formula(*numbers), rtol=1e-9)
    line = col.Vehicle(mass=1500.0, vx=13.9), col.Vehicle(mass=1200.0, vx=2.0)
    six = {"mass": 1500.0, "yaw_inertia": 2400.0, "vx": 13.9, "vy": 0.0, "x": -2.0, "y": 0.4}
    known = {
        "course_a": a.course,
        "course_b": b.course,
        "delta_v_a": impact.a.delta_v,
        "speed_b": b.speed,
    }
    ten = batch_speed.states(batch_speed.scenes(10))
    calls: Calls = {
        "formula": lambda: speed_rivals.formula(*numbers),
        "bare": lambda: speed_rivals.Bare(**six),
        "vehicle": lambda: col.Vehicle(**six),
        "eccentric": lambda: col.eccentric(a, b, 0.1, **CASE),
        "nine": lambda: nine(col.eccentric(a, b, 0.1, **CASE)),
        "linear": lambda: col.linear_central(*line, 0.1),
        "solve": lambda: col.solve(a, b, 0.1, **CASE, tolerance=0.3),
        "speeds": lambda: reconstruct.speeds(a, b, restitution=0.1, **known, **CASE),
        "batch_10": lambda: batch_speed.library(**ten),
    }
    if "quantities" in wanted:
        calls |= quantities(six)
    against = {"vehicle": "bare", "quantities": "to", "speeds": "eccentric", "solve": "eccentric"}
    rows = [row for row in calls if row in wanted]
    needed = {*rows, *(against.get(row, "formula") for row in rows)}
    best = fastest({key: call for key, call in calls.items() if key in needed}, 41, 0.004)
    return {row: best[row] / best[against.get(row, "formula")] for row in rows}


# Sideways speed and yaw rate of spun cars: mean and standard deviation.
SPUN = {"vy": (0.0, 3.0), "yaw_rate": (0.0, 2.0)}


def crash(speed: Any) -> Scene:
    """Two cars that meet at a crossing and run out, the one with a jammed wheel."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, x=-6.0, y=-0.4, heading=0.1, vx=speed, vy=0.0)
    b = col.Vehicle(mass=1200.0, yaw_inertia=1700.0, x=0.0, y=-5.0, heading=1.5, vx=0.0, vy=9.0)
    jammed = travel.Tyres(0.7, [1.0, 0.05, 0.05, 0.05], 2.78, 1.55)
    return Scene(
        movers={
            "A": Mover(a, outline=(4.8, 1.8), tyres=jammed),
            "B": Mover(b, outline=(4.5, 1.7), tyres=travel.Tyres(0.7, 0.3, 2.62, 1.48)),
        },
        contacts=[Contact("A", "B", restitution=0.1, friction=0.5, at="touch")],
    )


def followed(wanted: set[str]) -> dict[str, float]:
    """Run-outs to rest and contacts in time, in calls of the formula."""
    numbers, (a, b) = speed_rivals.numbers(batch_speed.scenes(1)), cars()
    one = [float(number[0]) for number in numbers]
    rng = np.random.default_rng(1)
    spun = a.replace(x=0.0, y=0.0, heading=0.0, vx=14.0, vy=3.0, yaw_rate=3.0)
    motion = {name: rng.normal(*about, 1000) for name, about in SPUN.items()}
    many = spun.replace(vx=rng.uniform(6.0, 16.0, 1000), **motion)
    half, free = (travel.Tyres(0.7, lock, 2.7, 1.5) for lock in (0.3, 0.05))
    one_scene, scenes = crash(14.0), crash(np.linspace(10.0, 18.0, 1000))
    lasting = {**CASE, "duration": 0.1, "drag": 0.7}
    fast = a.replace(vx=rng.uniform(8.0, 20.0, 1000))
    calls: Calls = {
        "run_out": lambda: travel.simulate(spun, half),
        "run_out_free": lambda: travel.simulate(spun, free),
        "run_out_batch": lambda: travel.simulate(many, half, moments=2),
        "scene": one_scene.run,
        "scene_batch": scenes.run,
        "in_time": lambda: col.time_resolved(a, b, 0.1, **lasting),
        "in_time_batch": lambda: col.time_resolved(fast, b, 0.1, **lasting, on_failure="nan"),
        "required_in_time": lambda: col.required_model(a, b, 0.1, **lasting, tolerance=0.3),
    }
    contact = {**CASE, "duration": 0.1}
    calls |= engaging("engaged", a, b, fast, {**contact, "tyres_a": half, "tyres_b": half})
    calls |= engaging("engaged_bare", a, b, fast, contact)
    calls = {key: call for key, call in calls.items() if key.removesuffix(_FIXED) in wanted}
    best = fastest({"formula": lambda: speed_rivals.formula(*one), **calls}, 9, 0.004)
    cases = {key: 1000 if key.endswith("batch") else 1 for key in calls} | {"scene_batch": 2000}
    return {
        key: best[key] / best[key + _FIXED]
        if key + _FIXED in calls
        else best[key] / best["formula"] / cases[key]
        for key in calls
        if not key.endswith(_FIXED)
    }


def engaging(
    key: str, a: col.Vehicle, b: col.Vehicle, many: col.Vehicle, contact: dict[str, Any]
) -> Calls:
    """Contacts in time whose start is found, and the same with a geometry that is not to be found;
    one and many.
    """
    calls: Calls = {}
    facing = b.replace(heading=math.pi / 2)
    for own, body, more in ((key, a, {}), (f"{key}_batch", many, {"on_failure": "nan"})):
        call = partial(col.time_resolved, body.replace(heading=0.0), facing, 0.1, **contact, **more)
        calls |= {own: call, own + _FIXED: partial(call, geometry="fixed")}
    return calls


def pages(wanted: set[str]) -> dict[str, float]:
    """Reports, pictures, and a study by intervals, in calls of the formula."""
    numbers, (a, b) = speed_rivals.numbers(batch_speed.scenes(1)), cars()
    one = [float(number[0]) for number in numbers]
    a, b = a.replace(heading=0.0), b.replace(heading=math.pi / 2)
    impact = col.eccentric(a, b, 0.1, **CASE)

    def model(speed: Any) -> dict[str, Any]:
        found = col.eccentric(a.replace(vx=speed), b, 0.1, **CASE, on_failure="nan")
        return {"a.delta_v": found.a.delta_v}

    def by_intervals() -> Any:
        return propagate(model, {"speed": Interval(13.0, 15.0)})

    stated = {"speed": Normal(13.9, 0.5)}
    spread = propagate(model, stated, samples=4096, seed=1)
    outlines = {"outline_a": (4.5, 1.8), "outline_b": (4.2, 1.7)}

    def picture() -> None:
        figure = plot.scene(impact, **outlines).figure
        figure.savefig(io.BytesIO(), format="png")
        pyplot.close(figure)

    calls: Calls = {
        "report": lambda: str(col.report(impact, **outlines)),
        "report_uncertain": lambda: str(col.report(impact, **outlines, uncertainty=spread)),
        "picture": picture,
        "intervals": by_intervals,
    }
    calls = {key: call for key, call in calls.items() if key in wanted}
    best = fastest({"formula": lambda: speed_rivals.formula(*one), **calls}, 9, 0.004)
    return {key: best[key] / best["formula"] for key in calls}


def quantities(six: dict[str, float]) -> Calls:
    """A vehicle from Quantities in US units, and what pint takes to convert them."""
    import pint

    ureg = pint.get_application_registry()
    units = {"mass": ("lb", "kg"), "yaw_inertia": ("lb*ft**2", "kg*m**2")}
    units |= dict.fromkeys(("vx", "vy"), ("mph", "m/s")) | dict.fromkeys("xy", ("ft", "m"))
    given = {name: ureg.Quantity(value, units[name][0]) for name, value in six.items()}
    return {
        "quantities": lambda: col.Vehicle(**given),
        "to": lambda: [given[name].to(unit).magnitude for name, (_, unit) in units.items()],
    }


def batches(wanted: set[str], cases: int) -> dict[str, float]:
    """Many cases against plain numpy and C."""
    found = {}
    scene, small = batch_speed.scenes(cases), batch_speed.scenes(8192)
    if wanted & {"batch", "batch_c"}:
        ours = batch_speed.states(scene)
        calls: Calls = {
            "batch": lambda: batch_speed.library(**ours),
            "numpy": lambda: batch_speed.textbook(**scene),
        }
        compiled = in_c(scene) if "batch_c" in wanted else None
        best = fastest(calls | ({"c": compiled} if compiled else {}), 9)
        found = {
            "batch": best["batch"] / best["numpy"],
            "batch_c": best["batch"] / best["c"] if compiled else float("nan"),
        }
    if "batch_8192" in wanted:
        states = batch_speed.states(small)
        best = fastest(
            {
                "ours": lambda: batch_speed.library(**states),
                "numpy": lambda: batch_speed.textbook(**small),
            },
            41,
            0.02,
        )
        found["batch_8192"] = best["ours"] / best["numpy"]
    if "batch_linear" in wanted:
        one, other = ({name: scene[side][name] for name in ("mass", "vx")} for side in "ab")
        pair, e = (col.Vehicle(**one), col.Vehicle(**other)), scene["restitution"]
        best = fastest(
            {
                "ours": lambda: batch_speed.central(*pair, e),
                "numpy": lambda: textbook_linear(one, other, e),
            },
            15,
        )
        found["batch_linear"] = best["ours"] / best["numpy"]
    return found


def textbook_linear(a: dict[str, Any], b: dict[str, Any], e: Any) -> tuple[Any, ...]:
    """A central impact along a line as one writes it: velocities after, impulse, energy lost (eqs 5
    to 8 of the paper).
    """
    m1, m2, v1, v2 = a["mass"], b["mass"], a["vx"], b["vx"]
    closing = v1 - v2
    impulse = (1 + e) * closing * m1 * m2 / (m1 + m2)
    lost = 0.5 * (1 - e * e) * closing * closing * m1 * m2 / (m1 + m2)
    return tuple(
        np.where(closing > 0, found, np.nan)
        for found in (v1 - impulse / m1, v2 + impulse / m2, impulse, lost)
    )


def in_c(scene: dict[str, Any]) -> Callable[[], Any] | None:
    """The formula compiled by the C compiler of this machine; None without one."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        return None
    folder = tempfile.mkdtemp()
    made = f"{folder}/formula.so"
    source = str(Path(__file__).with_name("formula.c"))
    subprocess.run([compiler, "-O3", "-shared", "-fPIC", "-o", made, source, "-lm"], check=True)
    library = ctypes.CDLL(made)
    numbers = speed_rivals.numbers(scene)
    count = len(numbers[0])

    def pointers(arrays: Any) -> Any:
        return (ctypes.c_void_p * len(arrays))(*(array.ctypes.data for array in arrays))

    def call() -> Any:
        found = [np.empty(count) for _ in range(9)]
        library.formula(ctypes.c_long(count), pointers(numbers), pointers(found))
        return found

    np.testing.assert_allclose(call(), batch_speed.textbook(**scene), rtol=1e-9, atol=1e-9)
    return call


def kept(cases: int) -> float:
    """Bytes a case that stay in memory with an impact of which nine outputs were read, its copies
    of the arguments aside.
    """
    scene = batch_speed.states(batch_speed.scenes(cases))
    batch_speed.library(**scene)
    gc.collect()
    tracemalloc.start()
    try:
        impact = col.eccentric(**scene, on_failure="nan")
        answers = nine(impact)
        held, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert len(answers) == 9
    given = impact.inputs
    inputs = (given.restitution, given.rule_value, *given.normal, *(given.point or ()))
    return (held - sum(part.nbytes for part in inputs)) / cases


def _work(cases: int, pipe: Any) -> None:
    """A process of its own: makes its vehicles, says so, and answers at every call how long it
    took.
    """
    states = batch_speed.states(batch_speed.scenes(cases))
    batch_speed.library(**states)
    pipe.send(None)
    while pipe.recv():
        pipe.send(batch_speed.timed(lambda: batch_speed.library(**states)))


def processes(cases: int) -> float:
    """What two processes that run at once take for half of the cases each, of what one takes for
    all; the best of each.
    """
    context = multiprocessing.get_context("spawn")
    best = []
    for count in (1, 2):
        pipes = []
        for _ in range(count):
            ours, theirs = context.Pipe()
            context.Process(target=_work, args=(cases // count, theirs), daemon=True).start()
            pipes.append(ours)
        for pipe in pipes:
            pipe.recv()
        times = []
        for _ in range(max(2, round(effort * 9))):
            start = time.perf_counter()
            for pipe in pipes:
                pipe.send(True)
            for pipe in pipes:
                pipe.recv()
            times.append(time.perf_counter() - start)
        best.append(min(times))
        for pipe in pipes:
            pipe.send(False)
    return best[1] / best[0]


def propagation() -> float:
    """8192 quasi-random samples of six inputs against one call of the model with as many cases."""

    def model(
        speed_a: Any, speed_b: Any, mass_a: Any, restitution: Any, friction: Any, lever: Any
    ) -> dict[str, Any]:
        a = col.Vehicle(mass=mass_a, yaw_inertia=2600.0, vx=speed_a, x=-2.2, y=0.0)
        b = col.Vehicle(mass=1200.0, yaw_inertia=2000.0, vy=speed_b, x=0.9, y=-lever)
        found = col.eccentric(
            a, b, restitution, normal=0.0, point=(0.0, 0.0), friction=friction, on_failure="nan"
        )
        return {"delta_v": found.b.delta_v}

    inputs = {
        "speed_a": Normal(15.0, 0.5),
        "speed_b": Normal(5.0, 0.5),
        "mass_a": Normal(1500.0, 30.0),
    }
    inputs |= {
        "restitution": Uniform(0.1, 0.2),
        "friction": Uniform(0.5, 0.7),
        "lever": Normal(0.8, 0.05),
    }
    rng = np.random.default_rng(1)
    drawn = {name: one.quantile(rng.random(8192)) for name, one in inputs.items()}
    best = fastest(
        {
            "ours": lambda: propagate(model, inputs, method="quasi_random", samples=8192, seed=1)[
                "delta_v"
            ].interval(0.95),
            "once": lambda: model(**drawn),
        },
        41,
        0.02,
    )
    return best["ours"] / best["once"]


def once(wanted: set[str], cases: int = 1_000_000) -> dict[str, float]:
    """The ratios of one run."""
    found = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        found |= singles(wanted)
        found |= followed(wanted)
        found |= pages(wanted)
        found |= batches(wanted, cases)
        for key, row in (
            ("memory", lambda: kept(cases)),
            ("processes", lambda: processes(cases)),
            ("propagate", propagation),
        ):
            if key in wanted:
                found[key] = row()
    of_imports = {"import": "collisions", "new": "new", "texts": "texts"}
    if wanted & of_imports.keys():
        import import_times

        names = ("numpy", *of_imports.values())
        rows = import_times.imports(max(2, round(effort * 15)), names)["rows"]
        found |= {key: rows[name]["best"] for key, name in of_imports.items()}
    return {key: value for key, value in found.items() if key in wanted}


def sizes(most: int = SIZES[-1]) -> list[dict[str, float]]:
    """Batches of every size against plain numpy."""
    found = []
    for cases in (size for size in SIZES if size <= most):
        scene = batch_speed.scenes(cases)
        states = batch_speed.states(scene)
        calls = {
            "ours": partial(batch_speed.library, **states),
            "numpy": partial(batch_speed.textbook, **scene),
        }
        best = fastest(calls, 5 if cases > 100_000 else 21, 0.004)
        found.append({"cases": cases, "ratio": float(f"{best['ours'] / best['numpy']:.3g}")})
    return found


def measure(
    runs: int = RUNS, keys: list[str] | None = None, options: tuple[str, ...] = ()
) -> list[dict[str, Any]]:
    """Every row: the median and the range of so many runs, each in a process of its own, and
    whether the budget is held.
    """
    wanted = keys or [row.key for row in BUDGETS]
    command = [sys.executable, __file__, "--once", "--rows", ",".join(wanted), *options]
    each = [
        json.loads(
            subprocess.run(
                command, capture_output=True, text=True, encoding="utf-8", check=True
            ).stdout
        )
        for _ in range(runs)
    ]
    rows = []
    for row in BUDGETS:
        values = [one[row.key] for one in each if one.get(row.key) == one.get(row.key) is not None]
        if row.key in wanted and values:
            median = float(f"{statistics.median(values):.3g}")
            low, high = (float(f"{end:.3g}") for end in (min(values), max(values)))
            rows.append(
                {
                    **row._asdict(),
                    "median": median,
                    "low": low,
                    "high": high,
                    "held": median <= row.budget,
                }
            )
    return rows


def options_of(options: argparse.Namespace) -> list[str]:
    """Those that every process is to have."""
    return [f"--{name}" for name in ("busy", "quick") if getattr(options, name)]


def main() -> None:
    """Measure, print, and write if asked to."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--once", action="store_true")
    parser.add_argument("--busy", action="store_true")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--rows")
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--cases", type=int, default=1_000_000)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    keys = options.rows.split(",") if options.rows else [row.key for row in BUDGETS]
    if options.once:
        print(json.dumps(once(set(keys), options.cases)))
        return
    rows = measure(options.runs, keys, ("--cases", str(options.cases), *options_of(options)))
    for row in rows:
        text = f"{row['median']:8.3g} ({row['low']:.3g} to {row['high']:.3g}) of {row['budget']:g}"
        print(f"{row['key']:14s}{text:40s}{'' if row['held'] else 'missed'}")
    if options.json is not None:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
