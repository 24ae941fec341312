"""The dearer model where it matters, measured: what ``finer=`` costs and how far its answer is from
that of the finer model alone, in ``posterior``, ``propagate`` and ``fit``.

``python benchmarks/finer.py`` takes some minutes on two processors and writes
docs/_generated/finer.json. ``--quick`` measures less, to see that everything runs; ``--json PATH``
writes there.

One side impact with ten unknowns, worked out as an impulse of an instant (``eccentric``), with the
tyres' impulse on top (``eccentric`` with ``duration=`` and tyres), and as a contact in time
(``time_resolved``). The readings are those of the contact in time with drawn errors.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import time
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

# Threads of linear algebra would count as time of the processor while they wait.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
if str(ROOT / "src") not in sys.path:
    sys.path.insert(0, str(ROOT / "src"))

import collisions as col
from collisions.reconstruct import fit, posterior
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform, propagate

DATA = ROOT / "docs" / "_generated" / "finer.json"
SEED = 20261126
Numbers = dict[str, Any]
TYRES = {"tyres_a": Tyres(0.75, 1.0, 2.7, 1.5), "tyres_b": Tyres(0.75, 0.0, 2.6, 1.5)}


def side_impact(kind: str) -> Callable[..., Mapping[str, Any]]:
    """The crash as one kind of model works it out."""

    def model(
        speed_a: Any,
        speed_b: Any,
        restitution: Any,
        friction: Any,
        contact: Any,
        turn: Any,
        mass_a: Any,
        mass_b: Any,
        heading_b: Any,
        duration: Any,
    ) -> Mapping[str, Any]:
        a = col.Vehicle(
            mass=mass_a, vx=speed_a, yaw_inertia=1.7 * mass_a, x=-2.1, y=0.0, heading=0.0
        )
        b = col.Vehicle(
            mass=mass_b,
            vx=speed_b * np.cos(heading_b),
            vy=speed_b * np.sin(heading_b),
            yaw_inertia=1.5 * mass_b,
            x=0.9,
            y=-0.4,
            heading=heading_b,
        )
        more: Numbers = {"normal": turn, "point": (0.0, contact), "friction": friction}
        more["on_failure"] = "nan"
        if kind == "instant":
            impact = col.eccentric(a, b, restitution, **more)
        elif kind == "with tyres":
            impact = col.eccentric(a, b, restitution, duration=duration, **TYRES, **more)
        else:
            impact = col.time_resolved(
                a, b, restitution, duration=duration, geometry="fixed", **TYRES, **more
            )
        return {
            "delta_v_a": impact.a.q.delta_v,
            "speed_a_after": impact.a.after.q.speed,
            "course_a_after": impact.a.after.q.course,
            "course_b_after": impact.b.after.q.course,
            "yaw_rate_b_after": impact.b.after.q.yaw_rate,
        }

    return model


PRIORS = {
    "speed_a": Uniform(3.0, 35.0),
    "speed_b": Uniform(0.0, 30.0),
    "restitution": Normal(0.1, 0.04, truncate=(0.0, 1.0)),
    "friction": Normal(0.6, 0.15, truncate=(0.0, None)),
    "contact": Normal(0.2, 0.1),
    "turn": Normal(0.0, 0.07),
    "mass_a": Normal(1500.0, 30.0),
    "mass_b": Normal(1250.0, 25.0),
    "heading_b": Normal(0.5 * math.pi, 0.035),
    "duration": Normal(0.12, 0.015, truncate=(0.03, None)),
}
TRUTH = {
    "speed_a": 16.0,
    "speed_b": 11.0,
    "restitution": 0.1,
    "friction": 0.6,
    "contact": 0.25,
    "turn": 0.03,
    "mass_a": 1520.0,
    "mass_b": 1240.0,
    "heading_b": 1.56,
    "duration": 0.12,
}
ERRORS = {
    "delta_v_a": (0.4, "m/s"),
    "speed_a_after": (0.8, "m/s"),
    "course_a_after": (0.035, "rad"),
    "course_b_after": (0.035, "rad"),
    "yaw_rate_b_after": (0.2, "rad/s"),
}
# What is known in propagate: the same, with the speeds as estimates.
INPUTS = PRIORS | {"speed_a": Normal(16.0, 1.5), "speed_b": Normal(11.0, 1.5)}
# For fit, Normal priors without bounds.
UNKNOWNS = PRIORS | {
    "restitution": Normal(0.1, 0.04),
    "friction": Normal(0.6, 0.15),
    "duration": Normal(0.12, 0.015),
}
PAIRS = (("instant", "with tyres"), ("with tyres", "in time"))


def readings() -> dict[str, Normal]:
    """Readings of the crash as a contact in time, with errors."""
    random = np.random.default_rng(SEED)
    exact = side_impact("in time")(**{name: np.array([one]) for name, one in TRUTH.items()})
    return {
        name: Normal(
            f"{float(exact[name].magnitude[0]) + error * random.normal()} {unit}",
            f"{error} {unit}",
        )
        for name, (error, unit) in ERRORS.items()
    }


def timed(work: Callable[[], Any]) -> tuple[Any, float]:
    """What it gives and the seconds of a processor it takes; warnings are of no interest here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        start = time.process_time()
        found = work()
        return found, time.process_time() - start


def of_posterior(model: str, finer: str, samples: int) -> Numbers:
    """The posterior by both models and by the finer one alone, in its own deviations."""
    observed = readings()
    near, seconds = timed(
        lambda: posterior(
            side_impact(model),
            PRIORS,
            observed,
            finer=side_impact(finer),
            samples=samples,
            seed=1,
        )
    )
    alone, alone_seconds = timed(
        lambda: posterior(side_impact(finer), PRIORS, observed, samples=samples, seed=2)
    )
    cheap, cheap_seconds = timed(
        lambda: posterior(side_impact(model), PRIORS, observed, samples=samples, seed=2)
    )

    def off(one: Any) -> float:
        return max(abs(one[name].mean - alone[name].mean) / alone[name].std for name in PRIORS)

    errors = [
        abs(near[name].mean - alone[name].mean)
        / math.hypot(near[name].mean_standard_error, alone[name].mean_standard_error)
        for name in PRIORS
    ]
    return {
        "calls": near.calls["finer"] / samples,
        "calls_model": near.calls["model"] / samples,
        "calls_alone": alone.calls["model"] / samples,
        "seconds": seconds,
        "seconds_alone": alone_seconds,
        "seconds_cheap": cheap_seconds,
        "off": off(near),
        "off_cheap": off(cheap),
        "errors": float(np.sqrt(np.mean(np.square(errors)))),
    }


def of_propagate(model: str, finer: str, samples: int) -> Numbers:
    """The ranges by both models and by the finer one alone, in deviations of the latter."""
    samples *= 2
    near, seconds = timed(
        lambda: propagate(
            side_impact(model), INPUTS, finer=side_impact(finer), samples=samples, seed=1
        )
    )
    alone, alone_seconds = timed(
        lambda: propagate(side_impact(finer), INPUTS, samples=samples, seed=1)
    )
    cheap, cheap_seconds = timed(
        lambda: propagate(side_impact(model), INPUTS, samples=samples, seed=1)
    )

    def off(one: Any) -> float:
        """The furthest end of a 95 % range."""
        return max(
            abs(end - other) / alone[name].std
            for name in alone
            for end, other in zip(one[name].interval(), alone[name].interval(), strict=True)
        )

    return {
        "calls": near.calls["finer"] / samples,
        "calls_model": near.calls["model"] / samples,
        "calls_alone": 1.0,
        "seconds": seconds,
        "seconds_alone": alone_seconds,
        "seconds_cheap": cheap_seconds,
        "off": off(near),
        "off_cheap": off(cheap),
        "scatter": max(near.scatter[name] / near[name].std for name in near),
    }


def of_fit(model: str, finer: str, samples: int) -> Numbers:
    """The fit by both models and by the finer one alone, in standard errors."""
    observed = readings()
    near, seconds = timed(
        lambda: fit(side_impact(model), UNKNOWNS, observed, finer=side_impact(finer))
    )
    alone, alone_seconds = timed(lambda: fit(side_impact(finer), UNKNOWNS, observed))
    cheap, cheap_seconds = timed(lambda: fit(side_impact(model), UNKNOWNS, observed))

    def off(one: Any) -> float:
        return max(
            abs(one[name].value - alone[name].value) / alone[name].standard_error
            for name in UNKNOWNS
        )

    return {
        "calls": float(near.calls["finer"]),
        "calls_model": float(near.calls["model"]),
        "calls_alone": float(alone.calls["model"]),
        "seconds": seconds,
        "seconds_alone": alone_seconds,
        "seconds_cheap": cheap_seconds,
        "off": off(near),
        "off_cheap": off(cheap),
    }


STUDIES = {"posterior": of_posterior, "propagate": of_propagate, "fit": of_fit}


def measured(samples: int, pairs: tuple[tuple[str, str], ...] = PAIRS) -> list[Numbers]:
    """A row by study and pair of models."""
    return [
        {"study": name, "model": model, "finer": finer} | study(model, finer, samples)
        for name, study in STUDIES.items()
        for model, finer in pairs
    ]


def table(found: list[Numbers]) -> str:
    """The rows as a table of Markdown."""
    lines = [
        "| study | model, finer | calls of the finer model | alone | seconds | alone | off | "
        "model alone off |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for row in found:
        each = "" if row["study"] == "fit" else " a sample"
        lines.append(
            f"| `{row['study']}` | {row['model']}, {row['finer']} | {row['calls']:.3g}{each} | "
            f"{row['calls_alone']:.3g} | {row['seconds']:.2g} | {row['seconds_alone']:.2g} | "
            f"{row['off']:.1g} | {row['off_cheap']:.2g} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--json", type=Path, default=DATA)
    options = parser.parse_args()
    found = measured(512, PAIRS[:1]) if options.quick else measured(4096)
    options.json.write_text(json.dumps({"rows": found}, indent=1) + "\n", encoding="utf-8")
    sys.stdout.write(table(found) + "\n")


if __name__ == "__main__":
    main()
