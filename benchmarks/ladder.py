"""Error against cost, from the linear impact to a contact in 200 steps; and how often
``required_model`` accepts too little.

``python benchmarks/ladder.py [file.json]`` prints the tables, and writes them when a file is named.
Random impacts of two cars, not accident statistics: the front of A meets front, side or rear of B,
e 0 to 0.3, friction 0.2 to 0.8, 0.1 s of contact, locked wheels at 0.7. The error of an answer is
hypot of the error of delta-V and of radius of gyration times that of the yaw-rate change, for the
worse vehicle, as a share of its delta-V; what it is measured against is ``time_resolved`` with
everything in it, in 800 steps.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import sys
import time
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

SOURCE = Path(__file__).resolve().parent.parent / "src"
if str(SOURCE) not in sys.path:
    sys.path.insert(0, str(SOURCE))

import collisions as col
from collisions.engine.float_loops import compile_loop
from collisions.impact.time_resolved_inputs import kernel_arguments as arguments
from collisions.kernels.contact_step import Motion, Passing
from collisions.kernels.time_resolved import Noted, float_run, time_resolved

DURATION, DRAG = 0.1, 0.7
SCENES, CHOICES, SEED = 1500, 5100, 20250101
STEPS = (10, 25, 50, 100, 200)
REFERENCE = 800
TOLERANCES = (0.5, 1.0, 2.0)
SPEEDS = (2.0, 5.0, 10.0, 20.0, 40.0)
TYRES = "eccentric, geometry of maximum engagement, tyres as outside impulses"
NAMES = ("mass", "yaw_inertia", "vx", "vy", "x", "y", "heading")


def traffic(count: int, seed: int = SEED) -> dict[str, Any]:
    """Random impacts as arrays: bodies, restitution, friction and normal; the contact is at the
    origin.
    """
    rng = np.random.default_rng(seed)
    found: list[dict[str, Any]] = []
    while sum(one["restitution"].size for one in found) < count:
        size = 2 * count
        bodies = []
        turn = rng.uniform(-math.pi, math.pi, size)
        # Where on the outline, as forward and left of the centre, and its outward normal: front, a
        # side, or the rear.
        place = rng.choice(4, size, p=(0.35, 0.2, 0.2, 0.25))
        along = rng.uniform(-1.0, 1.0, size)
        spots = {
            "a": (rng.uniform(1.8, 2.2, size), rng.uniform(-0.8, 0.8, size), np.zeros(size)),
            "b": (
                np.choose(place, (2.0 + 0.0 * along, 1.6 * along, 1.6 * along, -2.0 + 0.0 * along)),
                np.choose(place, (0.8 * along, 0.8 + 0.0 * along, -0.8 + 0.0 * along, 0.8 * along)),
                np.choose(place, (0.0, 0.5 * math.pi, -0.5 * math.pi, math.pi)),
            ),
        }
        headings = {"a": np.zeros(size), "b": turn}
        for label in "ab":
            forward, left, _ = spots[label]
            c, s = np.cos(headings[label]), np.sin(headings[label])
            speed = rng.uniform(0.0, 20.0, size)
            mass = rng.uniform(900.0, 2200.0, size)
            place_x, place_y = -(c * forward - s * left), -(s * forward + c * left)
            numbers = (
                mass,
                mass * rng.uniform(1.3, 2.0, size),
                c * speed,
                s * speed,
                place_x,
                place_y,
                headings[label],
            )
            bodies.append(dict(zip(NAMES, numbers, strict=True)))
        into = np.where(rng.random(size) < 0.5, 0.0, turn + spots["b"][2] + math.pi)
        scene = {
            "restitution": rng.uniform(0.0, 0.3, size),
            "friction": rng.uniform(0.2, 0.8, size),
        }
        scene |= {"normal": (np.cos(into), np.sin(into)), "a": bodies[0], "b": bodies[1]}
        first = solved(scene, col.eccentric)
        # B faces the front of A, and they meet.
        facing = np.cos(turn + spots["b"][2] + math.pi) > 0.5
        found.append(taken(scene, (first.closing_speed > 2.0) & facing & (first.status == 0)))
    whole = {name: joined([one[name] for one in found]) for name in found[0]}
    return taken(whole, np.arange(count))


def joined(parts: list[Any]) -> Any:
    """Arrays, pairs of them or dicts of them, one after another."""
    if isinstance(parts[0], dict):
        return {name: joined([part[name] for part in parts]) for name in parts[0]}
    if isinstance(parts[0], tuple):
        return tuple(joined(list(one)) for one in zip(*parts, strict=True))
    return np.concatenate(parts)


def taken(scene: Any, some: Any) -> Any:
    """Some of the cases."""
    if isinstance(scene, dict):
        return {name: taken(value, some) for name, value in scene.items()}
    return tuple(taken(one, some) for one in scene) if isinstance(scene, tuple) else scene[some]


def solved(scene: dict[str, Any], solver: Callable[..., Any], **options: Any) -> Any:
    """The answer of a solver to all cases."""
    a, b = (col.Vehicle(**scene[label]) for label in "ab")
    contact = {"normal": scene["normal"], "friction": scene["friction"]}
    if solver is not col.oblique_central:
        contact["point"] = scene.get("point", (0.0, 0.0))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return solver(a, b, scene["restitution"], **contact, **options)


def in_time(
    scene: dict[str, Any], steps: int, geometry: str = "maximum_engagement", stiffness: Any = None
) -> Any:
    """The contact followed, with the nominal duration or with a stiffness."""
    kind = {"duration": DURATION} if stiffness is None else {"stiffness": stiffness}
    return solved(
        scene,
        col.time_resolved,
        steps=steps,
        geometry=geometry,
        drag=DRAG,
        on_failure="nan",
        **kind,
    )


def with_tyres(scene: dict[str, Any]) -> Any:
    """The impulse with that of the tyres as ``left_out`` estimates it, as impulses from outside."""
    bare = solved(scene, col.eccentric, on_failure="nan")
    found = col.left_out(bare, duration=DURATION, drag=DRAG)
    return solved(
        scene, col.eccentric, on_failure="nan", outside_a=found.outside_a, outside_b=found.outside_b
    )


def summary(answer: Any, reference: Any) -> dict[str, Any]:
    """What an answer errs by, over the cases that have one."""
    _, share = apart(answer, reference)
    known = share[np.isfinite(share)]
    return {
        "median": figures(np.median(known)),
        "most_of_10": figures(np.quantile(known, 0.9)),
        "no_answer": int(share.size - known.size),
    }


def apart(answer: Any, other: Any) -> tuple[Any, Any]:
    """How far two answers are apart for the worse vehicle, in m/s, and as a share of that vehicle's
    delta-V.
    """
    sizes = []
    for one, two in ((answer.a, other.a), (answer.b, other.b)):
        radius = np.sqrt(two.before.yaw_inertia / two.before.mass)
        moved = np.hypot(one.delta_vx - two.delta_vx, one.delta_vy - two.delta_vy)
        sizes.append(np.hypot(moved, radius * (one.delta_yaw_rate - two.delta_yaw_rate)))
    first = sizes[0] >= sizes[1]
    return np.where(first, *sizes), np.where(
        first, sizes[0] / other.a.delta_v, sizes[1] / other.b.delta_v
    )


def engaged(scene: dict[str, Any]) -> dict[str, Any]:
    """The scene of first contact with the places of its maximum engagement."""
    moved: list[list[float]] = []
    count = scene["restitution"].size
    start = len(Motion._fields)
    for case in range(count):
        one = {
            name: float(value)
            for name, value in taken(scene, case).items()
            if name in ("restitution", "friction")
        }
        a, b = (
            col.Vehicle(**{name: float(value[case]) for name, value in scene[label].items()})
            for label in "ab"
        )
        normal = tuple(float(part[case]) for part in scene["normal"])
        impact = col.time_resolved(
            a, b, one["restitution"], normal=normal, point=(0.0, 0.0), friction=one["friction"],
            duration=DURATION, drag=DRAG, geometry="first_contact",
        )  # fmt: skip
        note = Noted()
        time_resolved(
            **arguments(impact.inputs, lambda value: value),
            run=partial(float_run, compiled=compile_loop),
            note=note,
        )
        crush = 2 * start + Passing._fields.index("crush")
        state = max(note, key=lambda one: one[crush])
        motions = Motion(*state[:start]), Motion(*state[start : 2 * start])
        turn = Passing(*state[2 * start :])
        first = col.eccentric(
            a, b, 0.0, normal=normal, point=(0.0, 0.0), friction=0.0
        ).closing_speed
        length = first * DURATION
        row = [
            number
            for motion in motions
            for number in (motion.dx * length, motion.dy * length, math.atan2(motion.s, motion.c))
        ]
        moved.append([*row, math.atan2(turn.s, turn.c)])
    shifts = np.array(moved).T
    found = {**scene, "a": dict(scene["a"]), "b": dict(scene["b"])}
    places = []
    for label, (dx, dy, angle) in (("a", shifts[:3]), ("b", shifts[3:6])):
        body = found[label]
        c, s = np.cos(angle), np.sin(angle)
        arm_x, arm_y = -body["x"], -body["y"]
        body |= {"x": body["x"] + dx, "y": body["y"] + dy, "heading": body["heading"] + angle}
        places.append((body["x"] + c * arm_x - s * arm_y, body["y"] + s * arm_x + c * arm_y))
    (ax, ay), (bx, by) = places
    c, s = np.cos(shifts[6]), np.sin(shifts[6])
    nx, ny = scene["normal"]
    found["point"] = 0.5 * (ax + bx), 0.5 * (ay + by)
    found["normal"] = c * nx - s * ny, s * nx + c * ny
    return found


def rungs(count: int = SCENES) -> dict[str, Any]:
    """The errors of every rung over the scenes of first contact."""
    scene = traffic(count)
    late = engaged(scene)
    reference = in_time(scene, REFERENCE, "first_contact")
    answers = {
        "linear_central": solved(scene, col.solve, tolerance=1e9),
        "oblique_central": solved(scene, col.oblique_central, on_failure="nan"),
        "eccentric, geometry of first contact": solved(scene, col.eccentric, on_failure="nan"),
        "eccentric, geometry of maximum engagement": solved(late, col.eccentric, on_failure="nan"),
        TYRES: with_tyres(late),
    }
    for steps in STEPS:
        answers[f"time_resolved, {steps} steps"] = in_time(scene, steps, "first_contact")
    # The same nominal duration would be another stiffness there, as the levers are others.
    first = answers["eccentric, geometry of first contact"]
    stiffness = (
        first.effective_mass * (0.5 * math.pi * (1.0 + scene["restitution"]) / DURATION) ** 2
    )
    answers["time_resolved, 100 steps, from maximum engagement"] = in_time(
        late, 100, stiffness=stiffness
    )
    table = {name: summary(answer, reference) for name, answer in answers.items()}
    # Tyres alone, in places that stay: what the impulses from outside are for; and with all of the
    # weight at the centre.
    headless = {**late, **{label: {**late[label], "heading": None} for label in "ab"}}
    alone = {}
    for place, bodies in (("four wheels", late), ("the centre of mass", headless)):
        still = in_time(bodies, REFERENCE, "fixed", stiffness)
        alone[place] = [summary(answers[name], still)["median"] for name in list(answers)[3:5]]
    _, share = apart(answers["eccentric, geometry of first contact"], reference)
    by_speed = []
    for low, high in itertools.pairwise(SPEEDS):
        some = (
            (reference.closing_speed >= low) & (reference.closing_speed < high) & np.isfinite(share)
        )
        by_speed.append(
            {
                "from": low,
                "to": high,
                "median": figures(np.median(share[some])),
                "impacts": int(some.sum()),
            }
        )
    return {"impacts": count, "rungs": table, "tyres_alone": alone, "by_closing_speed": by_speed}


def choices(count: int = CHOICES) -> list[dict[str, Any]]:
    """How often ``required_model`` accepts a model that takes no time and errs by more than the
    tolerance.
    """
    scene = traffic(count, SEED + 1)
    reference = in_time(scene, 100)
    found = []
    for tolerance in TOLERANCES:
        answer = solved(
            scene, col.solve, tolerance=tolerance, duration=DURATION, drag=DRAG, on_failure="nan"
        )
        error, _ = apart(answer, reference)
        known = np.isfinite(error)
        cheaper = known & (answer.model != "time_resolved")
        wrong = cheaper & (error > tolerance)
        models = {
            str(name): int(np.count_nonzero(known & (answer.model == name)))
            for name in np.unique(answer.model)
        }
        row = {
            "tolerance": tolerance,
            "impacts": int(known.sum()),
            "models": models,
            "wrong": int(wrong.sum()),
        }
        found.append(row | {"wrong_share": figures(wrong.sum() / known.sum())})
    return found


def costs(repeats: int = 40) -> dict[str, float]:
    """Processor time of one call of each rung, in units of one of ``eccentric``; side by side, the
    best of many.
    """
    scene = taken(traffic(8), 0)
    a, b = (
        col.Vehicle(**{name: float(value) for name, value in scene[label].items()})
        for label in "ab"
    )
    e, friction, normal = (
        float(scene["restitution"]),
        float(scene["friction"]),
        math.atan2(*map(float, scene["normal"][::-1])),
    )
    contact = {"normal": normal, "friction": friction}
    in_line, ahead = col.Vehicle(mass=a.mass, vx=10.0), col.Vehicle(mass=b.mass)
    calls: dict[str, Callable[[], Any]] = {
        # It refuses what moves across the normal, and costs the same without.
        "linear_central": lambda: col.linear_central(in_line, ahead, e),
        "oblique_central": lambda: col.oblique_central(a, b, e, **contact),
        "eccentric": lambda: col.eccentric(a, b, e, **contact, point=(0.0, 0.0)),
        "required_model, 0.1 s": lambda: col.required_model(
            a, b, e, **contact, point=(0.0, 0.0), tolerance=1.0, duration=DURATION, drag=DRAG
        ),
    }

    def tyres() -> Any:
        left = col.left_out(
            col.eccentric(a, b, e, **contact, point=(0.0, 0.0)), duration=DURATION, drag=DRAG
        )
        return col.eccentric(
            a, b, e, **contact, point=(0.0, 0.0), outside_a=left.outside_a, outside_b=left.outside_b
        )

    calls[TYRES] = tyres
    for geometry, name in (
        ("first_contact", "time_resolved"),
        ("maximum_engagement", "time_resolved, from maximum engagement"),
    ):
        for steps in STEPS:
            calls[f"{name}, {steps} steps"] = lambda geometry=geometry, steps=steps: (
                col.time_resolved(
                    a,
                    b,
                    e,
                    **contact,
                    point=(0.0, 0.0),
                    duration=DURATION,
                    drag=DRAG,
                    geometry=geometry,
                    steps=steps,
                )
            )
    best = dict.fromkeys(calls, math.inf)
    for _ in range(repeats):
        for name, call in calls.items():
            number = 50 if "time" not in name and "0.1" not in name else 1
            start = time.process_time_ns()
            for _ in range(number):
                call()
            best[name] = min(best[name], (time.process_time_ns() - start) / number)
    return {name: figures(cost / best["eccentric"]) for name, cost in best.items()}


def measure() -> dict[str, Any]:
    """All of it."""
    conditions = {"duration": DURATION, "drag": DRAG, "reference_steps": REFERENCE}
    return {**conditions, **rungs(), "choices": choices(), "costs": costs()}


def figures(value: float) -> float:
    """Three of them."""
    return float(f"{float(value):.3g}")


def main() -> None:
    """Measure, print, and write the numbers where a file is named."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n\n")[0])
    parser.add_argument("file", nargs="?", type=Path, help="where to write the numbers as JSON")
    options = parser.parse_args()
    found = measure()
    for name, row in found["rungs"].items():
        print(
            f"{name:<45}{100 * row['median']:8.2f} %{100 * row['most_of_10']:8.2f} %   no answer "
            f"{row['no_answer']}"
        )
    for row in (*found["by_closing_speed"], *found["choices"]):
        print(row)
    for name, cost in found["costs"].items():
        print(f"{name:<60}{cost:10.3g}")
    if options.file is not None:
        options.file.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
