"""Speed against accuracy: what every choice costs, and what it errs by.

``python benchmarks/speed.py`` runs all of it and writes docs/_generated/speed.json,
time_resolved.json and ladder.json beside it, and the figures in docs/_static. ``--quick`` measures
less, to see that everything runs; ``--json PATH`` writes there, without figures.

What is compared runs in turn in one process (imports: in turn, a process each), forwards and
backwards, round after round. A ratio is the median of those of the rounds, its spread their
quartiles, so that a slow spell of the machine meets both sides. numba and pymunk are measured where
they are installed (``pip install ".[bench]"``); otherwise their rows are null.
"""

from __future__ import annotations

import argparse
import gc
import json
import math
import os
import platform
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
if str(ROOT / "src") not in sys.path:
    sys.path.insert(0, str(ROOT / "src"))

import batch_speed
import budgets
import ladder
import speed_errors
import speed_rivals
import time_resolved
from import_times import MODULES, TIMED, Times, imports, ratio

import collisions as col
from collisions import reconstruct
from collisions.engine.batch import SCALAR_LIMIT
from collisions.impact import models
from collisions.impact.impact import solved

DATA = ROOT / "docs" / "_generated" / "speed.json"
FIGURES = ROOT / "docs" / "_static"
UNIT = "formula"


class Effort(NamedTuple):
    """How much is measured: rounds and seconds for single cases, cases and rounds of batches, and
    so on.
    """

    rounds: int
    seconds: float
    cases: int
    batch_rounds: int
    imports: int
    scenes: int


FULL = Effort(rounds=41, seconds=0.004, cases=1_000_000, batch_rounds=9, imports=15, scenes=30_000)
QUICK = Effort(rounds=3, seconds=0.0005, cases=20_000, batch_rounds=3, imports=2, scenes=3_000)


class Work(NamedTuple):
    """Something to be timed: what a reader calls it, the call, and how many cases one
    call answers.
    """

    name: str
    call: Callable[[], Any]
    cases: int = 1


# --- Timing ---------------------------------------------------------------------------------------


def timed(works: dict[str, Work], rounds: int, seconds: float) -> Times:
    """Seconds a case of every work in every round; short calls are repeated for so many seconds."""
    with warnings.catch_warnings():
        # What the library says of a few cases of a large batch is not the subject here.
        warnings.simplefilter("ignore", col.CollisionsWarning)
        return _timed(works, rounds, seconds)


def _timed(works: dict[str, Work], rounds: int, seconds: float) -> Times:
    repeats = {}
    for key, work in works.items():
        once = batch_speed.timed(work.call)
        if once < 0.1:  # the first call of a short one says little
            once = batch_speed.timed(work.call)
        repeats[key] = max(1, round(seconds / max(once, 1e-8)))
    found: Times = {key: [] for key in works}
    gc.collect()
    gc.disable()
    try:
        for turn in range(rounds):
            for key in list(works)[:: -1 if turn % 2 else 1]:
                call, count = works[key].call, repeats[key]
                start = time.perf_counter()
                for _ in range(count):
                    call()
                found[key].append((time.perf_counter() - start) / (count * works[key].cases))
    finally:
        gc.enable()
    return found


def costs(works: dict[str, Work], times: Times, to: str) -> list[dict[str, Any]]:
    """A row for every work."""
    return [
        {"key": key, "name": work.name, "to": to, **ratio(times, key, to)}
        for key, work in works.items()
    ]


# --- One case -------------------------------------------------------------------------------------

BODIES = (
    {"mass": 1500.0, "yaw_inertia": 2400.0, "vx": 13.9, "vy": 0.0, "x": -2.0, "y": 0.4},
    {"mass": 1200.0, "yaw_inertia": 1700.0, "vx": 0.0, "vy": 11.1, "x": 0.8, "y": -1.2},
)
US = {"mass": "lb", "yaw_inertia": "lb*ft**2", "vx": "mph", "vy": "mph", "x": "ft", "y": "ft"}
TEXTS = {
    "mass": "3300 lb",
    "yaw_inertia": "57000 lb*ft**2",
    "vx": "31 mph",
    "vy": "0 mph",
    "x": "-6.6 ft",
    "y": "1.3 ft",
}


def nine(impact: col.Impact) -> tuple[Any, ...]:
    """Velocities and yaw rates after, impulses, energy loss."""
    return (
        *batch_speed._motion(impact),
        impact.normal_impulse,
        impact.tangential_impulse,
        impact.energy_loss,
    )


def single_works() -> dict[str, Work]:
    """One case at a time: models, laws, the way in, and backwards."""
    one, other = BODIES
    a, b = col.Vehicle(**one), col.Vehicle(**other)
    contact: dict[str, Any] = {"normal": 0.1, "point": (0.0, 0.0), "friction": 0.5}
    sticking = contact | {"friction": math.inf}
    numbers = (
        *(body.get(name, 0.0) for body in BODIES for name in batch_speed.BODY),
        *(0.1, contact["normal"], *contact["point"], contact["friction"]),
    )
    np.testing.assert_allclose(
        nine(col.eccentric(a, b, 0.1, **contact)), speed_rivals.formula(*numbers), rtol=1e-9
    )
    points = [col.Vehicle(mass=car.mass, vx=car.vx, vy=car.vy) for car in (a, b)]
    line = [col.Vehicle(mass=1500.0, vx=13.9), col.Vehicle(mass=1200.0, vx=2.0)]
    # Where each model is the least: in line, with the impulse through both centres, and as it
    # comes.
    in_line = [car.replace(vy=0.0, y=0.0) for car in (a, b)], {**contact, "normal": 0.0}
    angled = (
        [
            col.Vehicle(mass=1500.0, yaw_inertia=2400.0, vx=7.0, vy=8.0, x=-1.5, y=-0.45),
            col.Vehicle(mass=1200.0, yaw_inertia=1700.0, vx=-7.0, vy=-8.0, x=1.5, y=0.45),
        ],
        {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.3},
    )
    least = {"linear_central": in_line, "oblique_central": angled, "eccentric": ((a, b), contact)}

    def solved(model: str) -> Callable[[], col.Impact]:
        cars, there = least[model]

        def solve() -> col.Impact:
            return col.solve(*cars, 0.1, **there, tolerance=speed_errors.TOLERANCE)

        assert solve().model == model, model
        return solve

    impact = col.eccentric(a, b, 0.1, **contact)
    works = {
        UNIT: Work(
            "the textbook formula, a bare function of floats",
            lambda: speed_rivals.formula(*numbers),
        ),
        "linear_central": Work("`linear_central`", lambda: col.linear_central(*line, 0.1)),
        "oblique_central": Work(
            "`oblique_central`", lambda: col.oblique_central(*points, 0.1, normal=0.1, friction=0.5)
        ),
        "eccentric": Work("`eccentric`", lambda: col.eccentric(a, b, 0.1, **contact)),
        "eccentric_nine": Work(
            "`eccentric`, nine outputs read", lambda: nine(col.eccentric(a, b, 0.1, **contact))
        ),
        "array_of_one": Work(
            "`eccentric`, an array of one case, nine outputs read",
            lambda: nine(col.eccentric(a, b, np.array([0.1]), **contact)),
        ),
        "array_of_few": Work(
            f"`eccentric`, an array of {SCALAR_LIMIT} cases, nine outputs read",
            lambda: nine(col.eccentric(a, b, np.linspace(0.1, 0.2, SCALAR_LIMIT), **contact)),
        ),
        "brach": Work(
            '`eccentric`, sticking, law "brach"', lambda: col.eccentric(a, b, 0.1, **sticking)
        ),
        "kudlich_slibar": Work(
            '`eccentric`, sticking, law "kudlich-slibar"',
            lambda: col.eccentric(a, b, 0.1, **sticking, law="kudlich-slibar"),
        ),
        **{
            f"solve_{model}": Work(f"`solve`, where it takes {model}", solved(model))
            for model in least
        },
        "required_model": Work(
            "`required_model`",
            lambda: col.required_model(a, b, 0.1, **contact, tolerance=speed_errors.TOLERANCE),
        ),
        "left_out": Work("`left_out` of an impact", lambda: col.left_out(impact)),
        **backwards(impact, contact),
        **reader_works(),
    }
    return works


def backwards(impact: col.Impact, contact: dict[str, Any]) -> dict[str, Work]:
    """The reverse solvers on the same impact."""
    a, b = impact.a, impact.b
    courses = {"course_a": a.before.course, "course_b": b.before.course}
    ends = {
        "course_a_after": a.after.course,
        "course_b_after": b.after.course,
        "speed_a_after": a.after.speed,
        "speed_b_after": b.after.speed,
    }
    return {
        "momentum": Work(
            "`reconstruct.momentum`",
            lambda: reconstruct.momentum(a.before.mass, b.before.mass, **courses, **ends),
        ),
        "planar": Work(
            "`reconstruct.planar`",
            lambda: reconstruct.planar(a.after, b.after, restitution=0.1, **contact),
        ),
        "speeds": Work(
            "`reconstruct.speeds`",
            lambda: reconstruct.speeds(
                a.before,
                b.before,
                **courses,
                restitution=0.1,
                **contact,
                delta_v_a=a.delta_v,
                speed_b=b.before.speed,
            ),
        ),
    }


def reader_works() -> dict[str, Work]:
    """A Vehicle from floats, Quantities and texts, and what each is measured against."""
    import pint

    ureg = pint.get_application_registry()
    one = BODIES[0]
    quantities = {name: ureg.Quantity(one[name], US[name]) for name in one}
    wanted = {"mass": "kg", "yaw_inertia": "kg*m**2", "vx": "m/s", "vy": "m/s", "x": "m", "y": "m"}
    return {
        "bare": Work(
            "a bare frozen dataclass with slots, six floats", lambda: speed_rivals.Bare(**one)
        ),
        "vehicle": Work("`Vehicle`, six floats", lambda: col.Vehicle(**one)),
        "vehicle_quantities": Work(
            "`Vehicle`, six Quantities in US units", lambda: col.Vehicle(**quantities)
        ),
        "vehicle_texts": Work("`Vehicle`, six texts in US units", lambda: col.Vehicle(**TEXTS)),
        "to": Work(
            'six times `.to("unit").magnitude` of pint',
            lambda: [quantities[name].to(wanted[name]).magnitude for name in wanted],
        ),
    }


# --- Batches --------------------------------------------------------------------------------------

RENAMED = {
    "numpy": ("numpy", "the textbook formula on whole numpy arrays"),
    "library": ("eccentric", "`eccentric`"),
    "library, two threads": ("eccentric_threads", "`eccentric`, two threads"),
    "library, with the vehicles made": (
        "eccentric_made",
        "`eccentric`, with the vehicles made from arrays",
    ),
    "library, float32": ("eccentric_float32", "`eccentric`, float32"),
    "numpy, float32": ("numpy_float32", "the textbook formula on whole numpy arrays, float32"),
    "library, linear_central": ("linear_central", "`linear_central`"),
    "its inputs and answers moved once": ("moved", "the arrays of `linear_central` copied once"),
}


def batch_works(effort: Effort) -> dict[str, Work]:
    """Many cases at once, every input an array."""
    count = effort.cases
    works = {
        RENAMED[old][0]: Work(RENAMED[old][1], call, count)
        for old, call in batch_speed.works(count).items()
    }
    scene = speed_errors.traffic(count)
    mixed = batch_speed.states(scene)
    first = col.solve(**mixed, tolerance=speed_errors.TOLERANCE, on_failure="nan")
    inputs, choice = first.inputs, first.choice

    def by(which: Any) -> Any:
        """``solve`` where the model of every case is known before."""
        known = replace(choice, _which=which)
        return lambda: nine(solved(inputs, on_failure="nan", choice=known))

    alone = {
        f"solve_all_{model}": Work(
            f"`solve`, `{model}` for all, without the prediction",
            by(np.full_like(choice._which, at)),
            count,
        )
        for at, model in enumerate(model.name for model in models.MODELS)
    }
    few = max(1, count // 50)
    floats = [
        tuple(map(float, case))
        for case in np.array(speed_rivals.numbers(batch_speed.scenes(few))).T
    ]
    points = {
        side: col.Vehicle(**{name: scene[side][name] for name in ("mass", "vx", "vy")})
        for side in "ab"
    } | {name: scene[name] for name in ("restitution", "normal", "friction")}
    tenth = col.eccentric(**batch_speed.states(batch_speed.scenes(count // 10)), on_failure="nan")
    ends = tenth.a.after, tenth.b.after
    rng = np.random.default_rng(batch_speed.SEED)
    contact = {
        "normal": tenth.normal,
        "point": tenth.point,
        "friction": batch_speed.scenes(count // 10)["friction"],
    }
    return {
        UNIT: Work(
            "the textbook formula, a bare function of floats, in a loop",
            lambda: [_formula(*case) for case in floats],
            few,
        ),
        **works,
        "oblique_central": Work(
            "`oblique_central`",
            lambda: _central(col.oblique_central(**points, on_failure="nan")),
            count,
        ),
        "kudlich_slibar": Work(
            '`eccentric`, law "kudlich-slibar"',
            lambda: batch_speed.library(**mixed, law="kudlich-slibar"),
            count,
        ),
        "solve": Work(
            "`solve`, a third of the cases for each model",
            lambda: nine(col.solve(**mixed, tolerance=speed_errors.TOLERANCE, on_failure="nan")),
            count,
        ),
        **alone,
        "solve_known": Work(
            "`solve`, a third for each model, without the prediction", by(choice._which), count
        ),
        "left_out": Work("`left_out` of a batch", lambda: col.left_out(tenth), count // 10),
        "planar": Work(
            "`reconstruct.planar`",
            lambda: reconstruct.planar(
                *ends, **contact, restitution=tenth.restitution, on_failure="nan"
            ),
            count // 10,
        ),
        "draws": Work(
            "eleven random normals drawn", lambda: rng.standard_normal((11, count)), count
        ),
        **quantity_works(count),
    }


_formula = speed_rivals.formula


def _central(impact: col.Impact) -> tuple[Any, ...]:
    a, b = impact.a.after, impact.b.after
    return (
        a.vx,
        a.vy,
        b.vx,
        b.vy,
        impact.normal_impulse,
        impact.tangential_impulse,
        impact.energy_loss,
    )


def quantity_works(count: int) -> dict[str, Work]:
    """A batch of vehicles from arrays, and from Quantities that hold arrays."""
    import pint

    ureg = pint.get_application_registry()
    body = batch_speed.scenes(count)["a"]
    units = US | {"yaw_rate": "deg/s"}
    quantities = {name: ureg.Quantity(values, units[name]) for name, values in body.items()}
    return {
        "vehicle": Work("`Vehicle`, seven arrays of floats", lambda: col.Vehicle(**body), count),
        "vehicle_quantities": Work(
            "`Vehicle`, seven Quantities of arrays in US units",
            lambda: col.Vehicle(**quantities),
            count,
        ),
    }


# --- Imports --------------------------------------------------------------------------------------


# --- What else a user could take ------------------------------------------------------------------


class Rivals(NamedTuple):
    """numba and pymunk where they are installed."""

    numba: Any
    pymunk: Any

    def single(self) -> dict[str, Work]:
        """A case in pymunk."""
        if self.pymunk is None:
            return {}
        cases = np.array(speed_rivals.numbers(batch_speed.scenes(20))).T
        listed = [tuple(map(float, case)) for case in cases]
        return {
            "pymunk": Work(
                "pymunk: a space with two bodies made, and one step",
                lambda: [speed_rivals.stepped(self.pymunk, case) for case in listed],
                len(listed),
            )
        }

    def batch(self, effort: Effort) -> tuple[dict[str, Work], float | None]:
        """The formula compiled by numba, and seconds until it first answers."""
        if self.numba is None:
            return {}, None
        numbers = speed_rivals.numbers(batch_speed.scenes(effort.cases))
        one = speed_rivals.jitted(self.numba, parallel=False)
        compiling = batch_speed.timed(lambda: one(*numbers))
        works = {
            "numba": Work(
                "numba: the textbook formula in a compiled loop",
                lambda: one(*numbers),
                effort.cases,
            )
        }
        if effort is FULL:
            many = speed_rivals.jitted(self.numba, parallel=True)
            self.numba.set_num_threads(min(2, self.numba.config.NUMBA_NUM_THREADS))
            works["numba_threads"] = Work(
                "numba: the same, parallel on two threads", lambda: many(*numbers), effort.cases
            )
        return works, compiling


def in_time() -> dict[str, Work]:
    """A contact of time_resolved.py followed in time, one of its scenes."""
    scene = time_resolved.SCENES[4]
    return {
        "time_resolved": Work(
            f"`time_resolved` in {time_resolved.STEPS} steps", lambda: scene.passed("all")
        )
    }


# --- Everything -----------------------------------------------------------------------------------


def machine() -> dict[str, Any]:
    """What class of machine it was."""
    return {
        "cores": os.cpu_count(),
        "processor": platform.machine(),
        "system": platform.system(),
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


def say(text: str) -> None:
    """Where it is, for whoever waits."""
    print(text, file=sys.stderr, flush=True)


def measure(effort: Effort = FULL) -> tuple[dict[str, Any], dict[str, Any]]:
    """All of it: costs, errors, budgets and rivals; and the contacts followed in time."""
    rivals = Rivals(speed_rivals.installed("numba"), speed_rivals.installed("pymunk"))
    say("one case at a time")
    single = {**single_works(), **rivals.single()}
    single_times = timed(single, effort.rounds, effort.seconds)
    long = {UNIT: single[UNIT], **in_time()}
    long_times = timed(long, 3, effort.seconds)
    say("batches")
    compiled, compiling = rivals.batch(effort)
    batch = {**batch_works(effort), **compiled}
    batch_times = timed(batch, effort.batch_rounds, 0.0)
    of_batch = costs(batch, batch_times, UNIT)
    del batch, compiled
    taken = speed_errors.memory(effort.cases)
    say("imports")
    imported = imports(effort.imports, MODULES if effort is FULL else MODULES[:3])
    say("budgets")
    quick = effort is QUICK
    flags = (
        "--cases",
        str(effort.cases),
        *(["--quick"] if quick else []),
        *(["--busy"] if "--busy" in sys.argv else []),
    )
    held = budgets.measure(1 if quick else budgets.RUNS, None, flags)
    of_sizes = budgets.sizes(effort.cases if quick else budgets.SIZES[-1])
    say("errors")
    contacts = time_resolved.measure()
    versions = {
        "numba": rivals.numba and rivals.numba.__version__,
        "pymunk": rivals.pymunk and rivals.pymunk.version,
        "numba_first_call": None if compiling is None else _in_imports(compiling),
    }
    found = {
        "machine": machine(),
        "effort": effort._asdict(),
        "unit": single[UNIT].name,
        "single": [*costs(single, single_times, UNIT), costs(long, long_times, UNIT)[-1]],
        "batch": of_batch,
        "budgets": held,
        "sizes": of_sizes,
        "memory": taken,
        "imports": imported,
        "rivals": versions,
        "errors": {
            "choices": speed_errors.choices(effort.scenes, contacts, rivals.pymunk),
            **speed_errors.curves(),
        },
    }
    return found, contacts


def _in_imports(seconds: float) -> float:
    """A time as so many imports of numpy, each in a process of its own; the best of three."""
    printed = [
        subprocess.run(
            [sys.executable, "-c", TIMED.format("numpy")],
            capture_output=True,
            text=True,
            encoding="utf-8",
        )
        for _ in range(3)
    ]
    return speed_errors.rounded(seconds / min(float(one.stdout.split()[0]) for one in printed))


def main() -> None:
    """Measure, write, and draw."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--quick", action="store_true", help="measure less, to see that everything runs"
    )
    parser.add_argument(
        "--json", type=Path, help="where to write the numbers; no figures are written then"
    )
    parser.add_argument(
        "--busy",
        action="store_true",
        help="budgets by processor time, on a machine that is not idle",
    )
    options = parser.parse_args()
    found, contacts = measure(QUICK if options.quick else FULL)
    data = options.json or DATA
    for path, numbers in ((data, found), (data.with_name("time_resolved.json"), contacts)):
        path.write_text(json.dumps(numbers, indent=1) + "\n", encoding="utf-8")
    import speed_tables

    print(speed_tables.summary(found))
    if options.json is None:
        numbers = ladder.measure()
        data.with_name("ladder.json").write_text(
            json.dumps(numbers, indent=1) + "\n", encoding="utf-8"
        )
        speed_tables.draw_all(found, contacts, FIGURES)


if __name__ == "__main__":
    main()
