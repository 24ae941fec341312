"""How often the 95 percent intervals of both speeds hold the truth, route by route, over simulated
crashes.

Each route of ``ROUTES`` reads what it needs of a crash of evidence_crashes.py and states an
interval for the speed of either vehicle before.

    python benchmarks/evidence.py [--quick] [--json PATH]

To add a route, write a function of a ``Crash`` and a generator that draws its own errors from the
generator and returns the two intervals in m/s, and name it in ``ROUTES`` with how many crashes it
is tried on and which it is for; an error of the package counts as refused.
"""

from __future__ import annotations

import argparse
import json
import math
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from evidence_crashes import (
    DAMAGE_ERROR,
    FRICTION,
    GROUND,
    HEADING_ERROR,
    LOCK,
    POINT_ERROR,
    RECORDED_SPEED,
    RESTITUTION,
    Crash,
    bodies,
    crashes,
    read,
    recorded,
    surveyed,
)

import collisions as col
from collisions import reconstruct, travel
from collisions.uncertainty import Normal, OneSided, Uniform, propagate

SEED = 20261122
CRASHES, OF_EVERYTHING, QUICK = 1200, 480, 12
DATA = Path(__file__).resolve().parent.parent / "docs" / "_generated" / "evidence.json"
KMH = 3.6
# What ``path`` leaves out, measured on crashes of another seed by --model-error. Wheels that slip
# by the yaw too drag less along the way: by this times the square of their speed by the yaw over
# that of the vehicle. And where the bend changes, a parabola is off: the course by this times
# window**2 friction g / speed**2, and the yaw rate by that in m2/s3 over speed**2. ARM is the
# distance of a wheel from the centre of mass.
YAWING, YAWING_LEFT = 0.54, 0.02
BEND, SPIN = 0.009, 26.5
ARM, WINDOW = 1.54, 7.0
SAMPLES, DRAWS = 512, 3072
LOCKS = np.linspace(0.0, 1.0, 201)
LOST = 0.02  # share of samples without an answer, above which a route refuses
FASTEST = 40.0  # m/s; any speed up to this is as likely before the evidence
SPACINGS = (3.2, 1.6, 0.8, 0.4)  # m, of the surveys that are compared
COMPARED = 100  # crashes

Speeds = dict[str, tuple[float, float]]


class Smoothed:
    """What the survey of one vehicle says of its motion at separation, with the errors of survey
    and method.
    """

    def __init__(self, survey: tuple[Any, Any]) -> None:
        self.run = run = travel.path(
            *survey,
            friction=GROUND.given_mean,
            lock=LOCK.given_mean,
            point_error=POINT_ERROR,
            heading_error=HEADING_ERROR,
        )
        bend = BEND * WINDOW**2 * GROUND.given_mean * travel.GRAVITY / run.speed**2
        self.course_error = math.hypot(run.course_error, bend)
        self.yaw_error = math.hypot(run.yaw_rate_error, SPIN / run.speed**2)
        self.drag = 1.0 - YAWING * (ARM * run.yaw_rate / run.speed) ** 2
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)  # as for the run above
            self.table = travel.path(*survey, friction=1.0, lock=LOCKS)

    def speed(self, friction: Any, lock: Any) -> Any:
        """Speed of another friction and lock. Over level ground to rest, its square grows as the
        friction.
        """
        return np.sqrt(np.maximum(friction * self.drag, 0.0)) * np.interp(
            lock, LOCKS, self.table.speed
        )

    def yaw_rate(self, friction: Any, lock: Any) -> Any:
        """Yaw rate, which grows as the speed does."""
        return np.sqrt(np.maximum(friction * self.drag, 0.0)) * np.interp(
            lock, LOCKS, self.table.yaw_rate
        )


def by_components_of_both(crash: Crash, generator: np.random.Generator) -> Speeds:
    """The components of both recorders, and no speed: whether the contact stuck or slid is not
    known, and where it may have slid the answer is the end of its family, known from one side.
    """
    return _by_components(crash, generator, ("a", "b"), slid="bound", friction=FRICTION)


def by_components_alone(crash: Crash, generator: np.random.Generator) -> Speeds:
    """The same of the recorder of A alone."""
    return _by_components(crash, generator, ("a",), slid="bound", friction=FRICTION)


def by_components_of_one(crash: Crash, generator: np.random.Generator) -> Speeds:
    """The components and the speed before that the recorder of A tells, also of
    contacts that slid.
    """
    reading = crash.impact.a.before.speed + generator.uniform(-RECORDED_SPEED, RECORDED_SPEED)
    speed = Uniform(reading - RECORDED_SPEED, reading + RECORDED_SPEED)
    return _by_components(crash, generator, ("a",), friction=FRICTION, speed_a=speed)


def _by_components(
    crash: Crash,
    generator: np.random.Generator,
    recorders: tuple[str, ...],
    slid: Literal["bound"] | None = None,
    **known: Any,
) -> Speeds:
    inputs: dict[str, Any] = {"restitution": RESTITUTION, **known}
    for label in recorders:
        inputs |= recorded(crash.sides[label], generator).inputs(label)
    inputs |= read(crash, generator)

    def model(**values: Any) -> dict[str, Any]:
        both = bodies(crash, {name: value for name, value in values.items() if "speed" not in name})
        taken = {
            name: value
            for name, value in values.items()
            if not name.startswith(("mass", "inertia")) and len(name) > 1
        }
        found = reconstruct.speeds(*both, point=(values["x"], values["y"]), slid=slid, **taken)[0]
        speeds = {"speed_a": found.a.before.speed, "speed_b": found.b.before.speed}
        assert found.reconstruction is not None
        sides = found.reconstruction.one_sided or dict.fromkeys(speeds, 0)
        return {name: OneSided(speed, sides[name]) for name, speed in speeds.items()}

    return _ranges(model, inputs, generator)


def by_momentum(crash: Crash, generator: np.random.Generator) -> Speeds:
    """Momentum: courses before are known, speeds and courses after come from a smoothed path with
    its stated errors.
    """
    paths = {
        label: Smoothed(surveyed(way, generator))
        for label, way in zip("ab", crash.ways, strict=True)
    }
    known = read(crash, generator)
    inputs: dict[str, Any] = {"friction": GROUND}
    for label, path in paths.items():
        inputs |= {name: known[name] for name in (f"mass_{label}", f"course_{label}")}
        inputs |= {f"lock_{label}": LOCK, f"drag_{label}": Normal(1.0, YAWING_LEFT)}
        inputs[f"survey_speed_{label}"] = Normal(0.0, path.run.speed_error)
        inputs[f"survey_course_{label}"] = Normal(0.0, path.course_error)

    def model(**values: Any) -> dict[str, Any]:
        after = {}
        for label, path in paths.items():
            speed = path.speed(
                values["friction"] * values[f"drag_{label}"], values[f"lock_{label}"]
            )
            after[f"speed_{label}_after"] = speed + values[f"survey_speed_{label}"]
            after[f"course_{label}_after"] = path.run.course + values[f"survey_course_{label}"]
            after[f"course_{label}"] = values[f"course_{label}"]
        found = reconstruct.momentum(values["mass_a"], values["mass_b"], **after)
        return {"speed_a": found.speed_a, "speed_b": found.speed_b}

    return _ranges(model, inputs, generator)


def by_everything(crash: Crash, generator: np.random.Generator) -> Speeds:
    """All at once by ``posterior``: the delta-V of the recorder of A, both surveys down to the
    rest, and the damage.

    No speed before is known. Of the damage the logarithm of its energy is observed, because its
    error is a share of it.
    """
    paths = {
        label: Smoothed(surveyed(way, generator))
        for label, way in zip("ab", crash.ways, strict=True)
    }
    unknowns: dict[str, Any] = read(crash, generator) | {
        "restitution": RESTITUTION,
        "friction": FRICTION,
        "ground": GROUND,
    }
    forward, left = recorded(crash.impact.a, generator).evidence
    damage = math.log(crash.impact.energy_absorbed) + generator.normal(0.0, DAMAGE_ERROR)
    observed: dict[str, Any] = {
        "forward": forward,
        "left": left,
        "damage": Normal(damage, DAMAGE_ERROR),
    }
    for label, path in paths.items():
        unknowns |= {f"speed_{label}": Uniform(0.0, FASTEST), f"lock_{label}": LOCK}
        # Half a percent of speed for every percent of drag.
        error = math.hypot(path.run.speed_error, 0.5 * YAWING_LEFT * path.run.speed)
        observed[f"faster_{label}"] = Normal(0.0, error)
        observed[f"turned_{label}"] = Normal(0.0, path.course_error)
        observed[f"spun_{label}"] = Normal(0.0, path.yaw_error)

    def model(**values: Any) -> dict[str, Any]:
        contact = {
            "normal": values["normal"],
            "point": (values["x"], values["y"]),
            "friction": values["friction"],
        }
        impact = col.eccentric(
            *bodies(crash, values), values["restitution"], **contact, on_failure="nan"
        )
        found = {
            "forward": impact.a.delta_v_forward,
            "left": impact.a.delta_v_left,
            "damage": np.log(impact.energy_absorbed),
        }
        for label, side in (("a", impact.a), ("b", impact.b)):
            known = values["ground"], values[f"lock_{label}"]
            turn = side.after.course - paths[label].run.course
            found[f"faster_{label}"] = side.after.speed - paths[label].speed(*known)
            found[f"turned_{label}"] = np.arctan2(np.sin(turn), np.cos(turn))
            found[f"spun_{label}"] = side.after.yaw_rate - paths[label].yaw_rate(*known)
        return found

    found = reconstruct.posterior(
        model, unknowns, observed, samples=DRAWS, seed=int(generator.integers(2**31))
    )
    return {name: found[name].interval(0.95) for name in ("speed_a", "speed_b")}


def _ranges(
    model: Callable[..., dict[str, Any]], inputs: dict[str, Any], generator: np.random.Generator
) -> Speeds:
    found = propagate(
        model, inputs, method="quasi_random", samples=SAMPLES, seed=int(generator.integers(2**31))
    )
    if found.failed > LOST * SAMPLES:
        raise col.NoSolutionError(
            f"{found.failed} of {SAMPLES} samples have no answer", code="contradictory"
        )
    return {name: found[name].interval(0.95) for name in ("speed_a", "speed_b")}


class Route(NamedTuple):
    """How a route states its intervals, on how many crashes it is tried, and which of them it is
    for.
    """

    intervals: Callable[[Crash, np.random.Generator], Speeds]
    crashes: int = 900
    regime: str | None = None


ROUTES = {
    "components of both recorders, contact stuck": Route(
        by_components_of_both, CRASHES, "sticking"
    ),
    "components of one recorder, contact stuck": Route(by_components_alone, CRASHES, "sticking"),
    "components of one recorder, contact slid": Route(by_components_alone, regime="sliding"),
    "components and speed of one recorder": Route(by_components_of_one),
    "momentum from smoothed paths": Route(by_momentum),
    "everything: delta-V of one recorder, both surveys, damage": Route(
        by_everything, OF_EVERYTHING
    ),
}


def measured(route: Route, drawn: list[Crash], seed: int) -> dict[str, Any]:
    """How often a route holds the truth and how wide it is, of crashes it does not warn of and of
    those it does.
    """
    missed: dict[bool, list[int]] = {False: [], True: []}
    widths, refused, one_sided, open_ = [], 0, 0, 0
    fit = [i for i, crash in enumerate(drawn) if route.regime in (None, crash.impact.regime)][
        : route.crashes
    ]
    for i in fit:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", col.CollisionsWarning)
            try:
                found = route.intervals(drawn[i], np.random.default_rng([seed, i]))
            except col.CollisionsError:
                refused += 1
                continue
        for label, side in drawn[i].sides.items():
            low, high = found[f"speed_{label}"]
            truth = side.before.speed
            missed[bool(caught)].append(int(truth > high) - int(truth < low))
            ends = math.isfinite(low) + math.isfinite(high)
            one_sided, open_ = one_sided + (ends == 1), open_ + (ends == 0)
            widths += [0.5 * (high - low) * KMH] if ends == 2 and not caught else []
    counts = {
        key: {
            "intervals": len(found),
            "held": found.count(0),
            "above": found.count(1),
            "below": found.count(-1),
        }
        for key, found in (("plain", missed[False]), ("warned", missed[True]))
    }
    halves = [round(float(np.percentile(widths, p)), 2) for p in (10, 50, 90)] if widths else []
    sides = {"one_sided": one_sided, "open": open_}
    return {"crashes": len(fit), "refused": refused, **counts, **sides, "half_width": halves}


def model_error(drawn: list[Crash]) -> dict[str, float]:
    """What ``path`` of exact points is off by: YAWING, YAWING_LEFT, BEND and SPIN, of ways that it
    does not warn of.
    """
    yaws, factors, bends, spins = [], [], [], []
    for crash in drawn:
        for side, way, lock in zip(
            (crash.impact.a, crash.impact.b), crash.ways, crash.locks, strict=True
        ):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always", col.CollisionsWarning)
                run = travel.path(*surveyed(way), friction=crash.friction, lock=lock)
            if caught:
                continue
            yaws.append((ARM * run.yaw_rate / run.speed) ** 2)
            factors.append((side.after.speed / run.speed) ** 2)
            turn = math.remainder(run.course - side.after.course, 2.0 * math.pi)
            bends.append(turn * run.speed**2 / (WINDOW**2 * crash.friction * travel.GRAVITY))
            spins.append(
                (run.yaw_rate * math.sqrt(1.0 - YAWING * yaws[-1]) - side.after.yaw_rate)
                * run.speed**2
            )
    squares, missing = np.array(yaws), 1.0 - np.array(factors)
    slope = float(np.sum(squares * missing) / np.sum(squares**2))
    return {
        "YAWING": slope,
        "YAWING_LEFT": float(np.std(missing - slope * squares)),
        "BEND": float(np.sqrt(np.mean(np.square(bends)))),
        "SPIN": float(np.sqrt(np.mean(np.square(spins)))),
    }


def _quiet(side: Any) -> bool:
    """Whether ``path`` has no reason to warn of the yaw."""
    return abs(side.after.yaw_rate) * ARM < 0.5 * side.after.speed


def survey_errors(drawn: list[Crash], seed: int) -> list[dict[str, float]]:
    """Root mean square error of course and speed by the spacing of the points, by three points
    alone and smoothed.
    """
    rows = []
    for spacing in SPACINGS:
        row = {"spacing": spacing}
        for name, window in (("three", 0.0), ("smoothed", WINDOW)):
            turns, speeds = [], []
            for i, crash in enumerate(drawn):
                for side, way, lock in zip(
                    (crash.impact.a, crash.impact.b), crash.ways, crash.locks, strict=True
                ):
                    survey = surveyed(way, np.random.default_rng([seed, i]), spacing)
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore", col.CollisionsWarning)
                        run = travel.path(
                            *survey, friction=crash.friction, lock=lock, window=window
                        )
                    turns.append(
                        math.degrees(math.remainder(run.course - side.after.course, 2.0 * math.pi))
                    )
                    speeds.append(run.speed / side.after.speed - 1.0)
            row[f"{name}_course"], row[f"{name}_speed"] = (
                round(float(np.sqrt(np.mean(np.square(errors)))), 4) for errors in (turns, speeds)
            )
        rows.append(row)
    return rows


def main() -> None:
    """Measure every route and write the numbers."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n\n")[0])
    parser.add_argument(
        "--quick", action="store_true", help=f"{QUICK} crashes, to see that everything runs"
    )
    parser.add_argument("--json", type=Path, default=DATA)
    parser.add_argument(
        "--route",
        action="append",
        choices=list(ROUTES),
        help="only this one; the others stay as they are in the file",
    )
    parser.add_argument(
        "--model-error", action="store_true", help="print how far the drag of path is off, and stop"
    )
    options = parser.parse_args()
    count = QUICK if options.quick else CRASHES
    if options.model_error:
        print(model_error(crashes(count, SEED + 1)))
        return
    found = (
        json.loads(options.json.read_text("utf-8"))
        if options.route and options.json.exists()
        else {"routes": {}}
    )
    drawn = crashes(count, SEED)
    for name in options.route or ROUTES:
        found["routes"][name] = measured(ROUTES[name], drawn, SEED)
        print(name, found["routes"][name])
        options.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    if not options.route:
        quiet = [
            crash
            for crash in drawn
            if all(_quiet(side) for side in (crash.impact.a, crash.impact.b))
        ]
        found["survey"] = survey_errors(quiet[:COMPARED], SEED)
    options.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
