"""What each choice errs by: the cheaper models over lever and approach angle, and every choice over
mixed traffic.

An error is hypot of the error of the delta-V vector and of radius of gyration times the error of
the change of yaw rate, for the worse of both vehicles, against ``eccentric``, or of formulas in 64
bits against the evaluation of the tests in 60 digits; a share is of that vehicle's own delta-V.
Nothing here is timed.
"""

from __future__ import annotations

import gc
import math
import sys
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import batch_speed
import numpy as np
import speed_rivals

TESTS = Path(__file__).resolve().parent.parent / "tests"
if str(TESTS) not in sys.path:
    sys.path.insert(0, str(TESTS))

import collisions as col
import reference

MASS, INERTIA, REACH, CLOSING, RESTITUTION = 1500.0, 2400.0, 1.9, 15.0, 0.1
GYRATION = math.sqrt(INERTIA / MASS)
LEVERS = np.linspace(0.0, 1.5, 31)
ANGLES = np.linspace(0.0, 60.0, 31)
TOLERANCE = 0.5
SEED = 20240612

# --- Curves ---------------------------------------------------------------------------------------


def pair(
    lever_a: Any = 0.0, lever_b: Any = 0.0, across: Any = 0.0, inertia: float = INERTIA
) -> tuple[col.Vehicle, col.Vehicle]:
    """Two equal cars that meet at the origin along x, their centres off the line by so much."""
    body = {"mass": MASS, "yaw_inertia": inertia}
    a = col.Vehicle(**body, vx=CLOSING, vy=across, x=-REACH, y=lever_a)
    return a, col.Vehicle(**body, x=REACH, y=lever_b)


def compare(model: str, a: col.Vehicle, b: col.Vehicle, friction: float) -> dict[str, Any]:
    """What a central model errs by, from the answers of the solvers, and what ``required_model``
    says of it beforehand.
    """
    contact: dict[str, Any] = {"normal": 0.0, "point": (0.0, 0.0), "friction": friction}
    full = col.eccentric(a, b, RESTITUTION, **contact)
    cheap = central(model, a, b, RESTITUTION, 0.0, friction)
    error, share, delta_v = off(full, cheap)
    said = col.required_model(a, b, RESTITUTION, **contact, tolerance=1.0).errors[model]
    return {"error": error, "share": share, "delta_v_share": delta_v, "predicted": said}


def central(
    model: str, a: col.Vehicle, b: col.Vehicle, restitution: Any, normal: Any, friction: Any
) -> dict[str, tuple[Any, Any]]:
    """Changes of velocity by a central model, of vehicles that carry on with what it
    cannot hold.
    """
    n = np.cos(normal), np.sin(normal)
    if model == "oblique_central":
        cars = (col.Vehicle(mass=car.mass, vx=car.vx, vy=car.vy) for car in (a, b))
        impact = col.oblique_central(
            *cars, restitution, normal=normal, friction=friction, on_failure="nan"
        )
        return {
            side: (getattr(impact, side).delta_vx, getattr(impact, side).delta_vy) for side in "ab"
        }
    cars = (col.Vehicle(mass=car.mass, vx=car.vx * n[0] + car.vy * n[1]) for car in (a, b))
    impact = col.linear_central(*cars, restitution, on_failure="nan")
    return {side: tuple(getattr(impact, side).delta_vx * part for part in n) for side in "ab"}


def off(full: col.Impact, cheap: Any) -> tuple[Any, Any, Any]:
    """Error in m/s and as a share, for the worse vehicle, and the share of delta-V alone; ``cheap``
    is changes of velocity by side, or another answer with rotation.
    """
    errors, shares, alone = [], [], []
    for label in "ab":
        side = getattr(full, label)
        gyration = np.sqrt(side.before.yaw_inertia / side.before.mass)
        if isinstance(cheap, col.Impact):
            other = getattr(cheap, label)
            dvx, dvy, turn = other.delta_vx, other.delta_vy, other.delta_yaw_rate
        else:
            (dvx, dvy), turn = cheap[label], 0.0
        delta_v = np.hypot(side.delta_vx - dvx, side.delta_vy - dvy)
        # A body that cannot turn has infinite gyration and no change of yaw rate.
        turning = np.where(
            np.isinf(gyration),
            0.0,
            np.where(np.isinf(gyration), 0.0, gyration) * (side.delta_yaw_rate - turn),
        )
        errors.append(np.hypot(delta_v, turning))
        shares.append(errors[-1] / side.delta_v)
        alone.append(delta_v / side.delta_v)
    return np.maximum(*errors), np.maximum(*shares), np.maximum(*alone)


def curves() -> dict[str, list[dict[str, Any]]]:
    """The error over lever over radius of gyration, and over the angle between the relative
    velocity and the normal.
    """
    h = GYRATION * LEVERS
    across = CLOSING * np.tan(np.radians(ANGLES))
    levers = (
        ("one", "one car off-centre, frictionless", "oblique_central", (0.0, h), 0.0),
        ("both", "both cars off-centre, frictionless", "oblique_central", (-h, h), 0.0),
        ("friction", "both cars off-centre, friction 0.5", "oblique_central", (-h, h), 0.5),
    )
    angles = (
        ("linear_0.1", "linear central, friction of 0.1 left out", "linear_central", 0.1, math.inf),
        ("linear_0.5", "linear central, friction of 0.5 left out", "linear_central", 0.5, math.inf),
        (
            "oblique_0.1",
            "oblique central, friction 0.1, rotation left out",
            "oblique_central",
            0.1,
            INERTIA,
        ),
        (
            "oblique_0.5",
            "oblique central, friction 0.5, rotation left out",
            "oblique_central",
            0.5,
            INERTIA,
        ),
    )
    return {
        "levers": [
            _curve(key, name, LEVERS, compare(model, *pair(*places), friction))
            for key, name, model, places, friction in levers
        ],
        "angles": [
            _curve("ignored", "linear central, the angle ignored", ANGLES, ignored(across)),
            *(
                _curve(
                    key,
                    name,
                    ANGLES,
                    compare(model, *pair(across=across, inertia=inertia), friction),
                )
                for key, name, model, friction, inertia in angles
            ),
        ],
    }


def ignored(across: Any) -> dict[str, Any]:
    """The whole relative speed taken along the line of impact, where the contact is
    frictionless.
    """
    a, b = pair(across=across, inertia=math.inf)
    full = col.eccentric(a, b, RESTITUTION, normal=0.0, point=(0.0, 0.0), friction=0.0)
    taken = col.linear_central(
        col.Vehicle(mass=MASS, vx=np.hypot(CLOSING, across)), col.Vehicle(mass=MASS), RESTITUTION
    )
    error, share, delta_v = off(full, {side: (getattr(taken, side).delta_vx, 0.0) for side in "ab"})
    return {"error": error, "share": share, "delta_v_share": delta_v, "predicted": None}


def _curve(key: str, name: str, x: Any, found: dict[str, Any]) -> dict[str, Any]:
    columns = {
        label: None if values is None else [rounded(value) for value in values]
        for label, values in found.items()
    }
    return {"key": key, "name": name, "x": [rounded(value) for value in x], **columns}


# --- Mixed traffic --------------------------------------------------------------------------------


def traffic(count: int) -> dict[str, Any]:
    """A third nearly in line, a third at an angle with the impulse through both centres, a third as
    it comes; shuffled.
    """
    third = count // 3
    rng = np.random.default_rng(SEED)

    def of(values: tuple[Any, Any]) -> dict[str, Any]:
        mass = rng.uniform(900.0, 2200.0, third)
        names = ("vx", "vy", "yaw_rate", "x", "y")
        return {
            "mass": mass,
            "yaw_inertia": mass * rng.uniform(1.2, 2.2, third),
            **dict(zip(names, values, strict=True)),
        }

    def spread(width: float) -> Any:
        return rng.normal(0.0, width, third)

    zero = np.zeros(third)
    in_line = {
        "a": of(
            (
                rng.uniform(8.0, 25.0, third),
                spread(0.02),
                zero,
                -rng.uniform(1.6, 2.2, third),
                spread(0.02),
            )
        ),
        "b": of(
            (
                -rng.uniform(0.0, 7.0, third),
                spread(0.02),
                zero,
                rng.uniform(1.6, 2.2, third),
                spread(0.02),
            )
        ),
        "friction": rng.uniform(0.0, 0.8, third),
    }
    # It slides, so that the direction of the impulse is known beforehand: normal and friction.
    friction, way = rng.uniform(0.1, 0.4, third), rng.choice([-1.0, 1.0], third)
    angled: dict[str, Any] = {"friction": friction}
    for side, sign in (("a", 1.0), ("b", -1.0)):
        reach = rng.uniform(1.0, 2.2, third)
        velocity = sign * rng.uniform(5.0, 8.0, third), sign * way * rng.uniform(6.0, 9.0, third)
        angled[side] = of(
            (*velocity, zero, -sign * reach, -sign * reach * friction * way + spread(0.02))
        )
    for part in (in_line, angled):
        part |= {"restitution": rng.uniform(0.0, 0.4, third), "normal": zero, "point": (zero, zero)}
    return _taken(
        _joined([in_line, angled, batch_speed.scenes(count - 2 * third)]), rng.permutation(count)
    )


def _joined(parts: list[Any]) -> Any:
    first = parts[0]
    if isinstance(first, dict):
        return {name: _joined([part[name] for part in parts]) for name in first}
    if isinstance(first, tuple):
        return tuple(_joined(list(values)) for values in zip(*parts, strict=True))
    return np.concatenate(parts)


def _taken(scenes: Any, order: Any) -> Any:
    if isinstance(scenes, dict):
        return {name: _taken(value, order) for name, value in scenes.items()}
    if isinstance(scenes, tuple):
        return tuple(_taken(value, order) for value in scenes)
    return scenes[order]


def choices(count: int, contacts: dict[str, Any], pymunk: ModuleType | None) -> dict[str, Any]:
    """Mean error, and the error that 19 of 20 scenes stay below, of every choice that has an error;
    shares of delta-V.
    """
    scene = traffic(count)
    states = batch_speed.states(scene)
    a, b, contact = (
        states["a"],
        states["b"],
        {name: scene[name] for name in ("normal", "point", "friction")},
    )
    full = col.eccentric(a, b, scene["restitution"], **contact)
    found: dict[str, Any] = {
        model: _summary(
            off(
                full, central(model, a, b, scene["restitution"], scene["normal"], scene["friction"])
            )[1]
        )
        for model in ("linear_central", "oblique_central")
    }
    least = col.solve(a, b, scene["restitution"], **contact, tolerance=TOLERANCE)
    error, share, _ = off(full, least)
    models, counts = np.unique(least.choice.model, return_counts=True)
    found["solve"] = _summary(share) | {
        "most": rounded(error.max()),
        "tolerance": TOLERANCE,
        "chosen": {
            str(model): rounded(number / count)
            for model, number in zip(models, counts, strict=True)
        },
    }
    other = col.eccentric(a, b, scene["restitution"], **contact, law="kudlich-slibar")
    sticks = (full.regime == "sticking") | (other.regime == "sticking")
    found["law"] = _summary(off(full, other)[1][sticks]) | {
        "sticking": rounded(float(sticks.mean()))
    }
    single = batch_speed._cast(scene, np.float32)
    exact = batch_speed._cast(single, np.float64)
    one, other = (col.eccentric(**batch_speed.states(numbers)) for numbers in (exact, single))
    found["float32"] = _summary(off(one, other)[1])
    found |= of_rounding(scene, full)
    found |= of_contacts(contacts)
    found["pymunk"] = None if pymunk is None else of_pymunk(pymunk, scene, full)
    return found


DIGITS, EVALUATED = 60, 600


def of_rounding(scene: dict[str, Any], full: col.Impact) -> dict[str, Any]:
    """What ``eccentric`` and the textbook formula in float64 err by, against the same scenes
    evaluated in 60 digits.
    """
    textbook = batch_speed.textbook(**scene)
    ours = tuple(
        getattr(getattr(full, label).after, name)
        for label in "ab"
        for name in ("vx", "vy", "yaw_rate")
    )
    count = full.status.size
    found: dict[str, list[float]] = {"float64": [], "textbook": []}
    for case in np.linspace(0, count - 1, min(EVALUATED, count), dtype=int):
        answer = evaluated(scene, case)
        for key, values in (("float64", ours), ("textbook", textbook)):
            shares = []
            for half, label, at in ((answer.a, "a", 0), (answer.b, "b", 3)):
                body = scene[label]
                gyration = math.sqrt(body["yaw_inertia"][case] / body["mass"][case])
                vx, vy, yaw_rate = (
                    exact - float(value[case])
                    for exact, value in zip(
                        (half.vx, half.vy, half.w), values[at : at + 3], strict=True
                    )
                )
                away = math.hypot(float(vx), float(vy), gyration * float(yaw_rate))
                shares.append(away / math.hypot(float(half.dvx), float(half.dvy)))
            found[key].append(max(shares))
    return {key: _summary(np.array(shares)) for key, shares in found.items()}


def evaluated(scene: dict[str, Any], case: int) -> Any:
    """A scene of many in 60 digits."""
    names = {
        "mass": "mass",
        "yaw_inertia": "inertia",
        "yaw_rate": "spin",
        "vx": "vx",
        "vy": "vy",
        "x": "x",
        "y": "y",
    }
    a, b = (
        reference.Body(**{to: float(scene[label][name][case]) for name, to in names.items()})
        for label in "ab"
    )
    e, normal, friction = (
        float(scene[name][case]) for name in ("restitution", "normal", "friction")
    )
    point = float(scene["point"][0][case]), float(scene["point"][1][case])
    return reference.evaluate(
        reference.Scene(a, b, e, normal, point, "friction", friction, "brach"), DIGITS
    )


def _away(full: col.Impact, found: dict[str, Any], chosen: Any) -> Any:
    """The share for the worse vehicle, of velocities and yaw rates after."""
    shares = []
    for label, (vx, vy, yaw_rate) in found.items():
        side = getattr(full, label)
        gyration = np.sqrt(side.before.yaw_inertia / side.before.mass)[chosen]
        away = np.hypot(vx - side.after.vx[chosen], vy - side.after.vy[chosen])
        shares.append(
            np.hypot(away, gyration * (yaw_rate - side.after.yaw_rate[chosen]))
            / side.delta_v[chosen]
        )
    return np.maximum(*shares)


def of_contacts(contacts: dict[str, Any]) -> dict[str, Any]:
    """What an impulse leaves out, of time_resolved.py; and how far off ``left_out`` is that tells
    how much it is.

    Its two numbers, of tyres and of geometry, are magnitudes; the worse one counts, against a
    contact with just that.
    """
    rows = contacts["rows"]
    off_by = [
        max(
            abs(row["left_out"]["tyre_delta_v"] - row["tyres"]["delta_v"]),
            abs(row["left_out"]["geometry_delta_v"] - row["moving"]["delta_v"]),
        )
        / row["delta_v"]
        for row in rows
    ]
    return {
        "impulse": _summary(np.array([row["all"]["share"] for row in rows])),
        "left_out": _summary(np.array(off_by)),
        "time_resolved": _summary(np.array([row["fixed"]["share"] for row in rows])),
    }


def of_pymunk(pymunk: ModuleType, scene: dict[str, Any], full: col.Impact) -> dict[str, Any]:
    """How far the answers of a game engine are from ours, with its ten iterations; the same
    friction and restitution.
    """
    cases = np.array(speed_rivals.numbers(scene)).T
    chosen = np.linspace(0, len(cases) - 1, 300, dtype=int)
    found = np.array(
        [speed_rivals.stepped(pymunk, tuple(map(float, cases[case]))) for case in chosen]
    )
    return _summary(_away(full, {"a": found[:, :3].T, "b": found[:, 3:].T}, chosen))


# --- Memory ---------------------------------------------------------------------------------------


def memory(count: int) -> dict[str, float]:
    """MiB that a batch takes at most, beyond its inputs and what is kept of it."""
    mixed = batch_speed.states(traffic(count))
    impact = col.eccentric(**mixed, on_failure="nan")
    works: dict[str, Callable[[], Any]] = {
        "eccentric": lambda: col.eccentric(**mixed, on_failure="nan"),
        "solve": lambda: col.solve(**mixed, tolerance=TOLERANCE, on_failure="nan"),
        "left_out": lambda: col.left_out(impact),
        "eccentric_threads": lambda: col.eccentric(**mixed, on_failure="nan", threads=2),
        "solve_threads": lambda: col.solve(
            **mixed, tolerance=TOLERANCE, on_failure="nan", threads=2
        ),
    }
    return {name: rounded(_beyond_what_is_kept(work)) for name, work in works.items()}


def _beyond_what_is_kept(work: Callable[[], Any]) -> float:
    work()
    gc.collect()
    tracemalloc.start()
    try:
        kept = work()
        held, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    del kept
    return (most - held) / 2**20


def _summary(shares: Any) -> dict[str, float]:
    return {
        "mean": rounded(float(np.mean(shares))),
        "p95": rounded(float(np.quantile(shares, 0.95))),
    }


def rounded(value: float) -> float:
    """Three digits."""
    return float(f"{float(value):.3g}")
