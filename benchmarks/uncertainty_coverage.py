"""How often a stated 95 percent interval holds the truth, over simulated scenes whose truth is
known.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from uncertainty_scenes import (
    BY_KEY,
    ENDS,
    LOCAL,
    SAMPLED,
    Numbers,
    Scene,
    drawn,
    listening,
    run,
    t_bone,
)

from collisions.messages.errors import NoSolutionError
from collisions.uncertainty import Interval, Normal

SEED = 20250312
SAMPLES = 2048
SPARED = 20  # the search for extremes is slow, and holds nearly always: every so many scenes
METHODS = (*LOCAL, *SAMPLED, "interval")


def rounded(value: float, digits: int = 4) -> float:
    """So many digits, which is more than a simulation of this size knows."""
    return float(f"{value:.{digits}g}") if math.isfinite(value) else value


def simulated(
    scene: Scene, generator: np.random.Generator, count: int, off: float
) -> Iterator[tuple[Numbers, dict[str, Normal]]]:
    """The truth of a scene, and what an analyst states of it.

    What is measured lies anywhere in its range, and is measured with the standard deviation that is
    stated. What is taken from the literature is distributed as is stated. All errors are ``off``
    times as large as the analyst believes.
    """
    wider = {
        name: Normal(one.given_mean, off * one.given_sd, truncate=one.truncate)
        for name, one in scene.inputs.items()
    }
    literature = drawn(wider, generator, count)
    ranges = {name: generator.uniform(*ends, count) for name, ends in scene.measured.items()}
    slips = {
        name: off * generator.normal(0.0, scene.inputs[name].given_sd, count)
        for name in scene.measured
    }
    for case in range(count):
        truth, stated = {}, dict(scene.inputs)
        for name, known in scene.inputs.items():
            if name in ranges:
                truth[name] = float(ranges[name][case])
                stated[name] = Normal(
                    truth[name] + float(slips[name][case]), known.given_sd, truncate=known.truncate
                )
            else:
                truth[name] = float(literature[name][case])
        yield truth, stated


def stated_interval(
    scene: Scene, method: str, stated: Mapping[str, Normal], seed: int
) -> tuple[float, float, bool]:
    """The interval that a method states, and whether it warned."""
    if method == "interval":
        given = {
            name: Interval(*map(float, known.quantile(np.array(ENDS))))
            for name, known in stated.items()
        }
        found, codes = run(scene, method, given)
    elif method in LOCAL:
        found, codes = run(scene, method, stated)
    else:
        found, codes = run(scene, method, stated, samples=SAMPLES, seed=seed)
    (output,) = found.outputs.values()
    low, high = output.interval(0.95)
    return low, high, "not_local" in codes


def counted(key: str, count: int, off: float = 1.0) -> dict[str, Any]:
    """How often each method's interval held the truth, on which side it missed, and how wide it
    was.
    """
    scene = BY_KEY[key]
    generator = np.random.default_rng([SEED, list(BY_KEY).index(key), int(off)])
    empty = {
        "scenes": 0,
        "refused": 0,
        "held": 0,
        "below": 0,
        "above": 0,
        "warned": 0,
        "held_unwarned": 0,
        "width": 0.0,
    }
    tally = {method: dict(empty) for method in METHODS}
    for case, (truth, stated) in enumerate(simulated(scene, generator, count, off)):
        (true,) = (float(np.asarray(value).item()) for value in scene.model(**truth).values())
        for method, row in tally.items():
            if method == "interval" and case % SPARED:
                continue
            try:
                low, high, warned = stated_interval(scene, method, stated, case)
            except NoSolutionError:
                row["refused"] += 1
                continue
            row["scenes"] += 1
            row["below"] += true < low
            row["above"] += true > high
            row["held"] += low <= true <= high
            row["warned"] += warned
            row["held_unwarned"] += low <= true <= high and not warned
            row["width"] += high - low
    for row in tally.values():
        row["width"] = rounded(row["width"] / row["scenes"])
    return {"key": key, "off": off, "samples": SAMPLES, "methods": tally}


# --- Fit to evidence ------------------------------------------------------------------------------

FITTED = {"speed_a": (14.0, 20.0), "speed_b": (3.0, 6.0)}
PRIOR = Normal(0.2, 0.05, truncate=(0.0, 1.0))
SIGMA = {
    "delta_v_a": 0.4,
    "delta_v_b": 0.4,
    "course_a": math.radians(3.0),
    "course_b": math.radians(3.0),
    "yaw_b": 0.25,
}
# The restitution is known from the literature, or has to follow from the evidence.
CASES = {"prior": PRIOR, "open": Interval(0.0, 1.0)}


def evidence(speed_a: Any, speed_b: Any, restitution: Any) -> Numbers:
    """What is left to be measured after a side impact that sticks."""
    impact = t_bone(speed_a, speed_b, 1500.0, 1200.0, 2000.0, restitution, math.inf, 0.8)
    return {
        "delta_v_a": impact.a.delta_v,
        "delta_v_b": impact.b.delta_v,
        "course_a": impact.a.after.course,
        "course_b": impact.b.after.course,
        "yaw_b": impact.b.after.yaw_rate,
    }


def fitted(fit: Callable[..., Any], case: str, count: int) -> dict[str, Any]:
    """How often the 95 percent intervals of a fit to noisy evidence hold each unknown."""
    generator = np.random.default_rng([SEED, 99, list(CASES).index(case)])
    unknowns = {**{name: Interval(0.0, 40.0) for name in FITTED}, "restitution": CASES[case]}
    restitutions = drawn({"restitution": PRIOR}, generator, count)["restitution"]
    held = dict.fromkeys(unknowns, 0)
    errors: dict[str, list[float]] = {name: [] for name in unknowns}
    answered = rough = contradicted = 0
    for turn in range(count):
        truth = {name: float(generator.uniform(*ends)) for name, ends in FITTED.items()}
        truth["restitution"] = float(restitutions[turn])
        observed = {
            name: (float(value) + float(generator.normal(0.0, SIGMA[name])), SIGMA[name])
            for name, value in evidence(**truth).items()
        }
        with listening() as codes:
            try:
                found = fit(evidence, unknowns, observed)
            except NoSolutionError:
                continue
        answered += 1
        contradicted += "contradictory" in codes
        rough += not {"not_linear", "told_by_bounds"}.isdisjoint(codes)
        for name, true in truth.items():
            low, high = found[name].interval(0.95)
            held[name] += low <= true <= high
            errors[name].append(found[name].standard_error)
    return {
        "key": case,
        "scenes": count,
        "answered": answered,
        "rough": rough,
        "contradictory": contradicted,
        "held": held,
        "standard_error": {name: rounded(float(np.median(each))) for name, each in errors.items()},
    }
