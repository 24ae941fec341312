"""Predicts every blind case at every level from its inputs alone, with 95 percent ranges.

No module that this one imports reads a measurement.
"""

from __future__ import annotations

import json
import warnings
from typing import Any

import collisions as col
from collisions.uncertainty import propagate

from . import inputs, levels

SEED = 42
FIRST = inputs.HERE / "first_predictions.json"


def used_by(level: str, numbers: dict[str, Any]) -> dict[str, Any]:
    """The numbers that a level takes: an input that it ignores would be an input in vain."""
    extra = {"contact in time": "contact_in_time."}
    return {
        name: value
        for name, value in numbers.items()
        if name.partition(".")[0] in ("a", "b", "eccentric") or name.startswith(extra.get(level, "\0"))
    }


def predict(level: str, numbers: dict[str, Any]) -> dict[str, Any]:
    """One case at one level: the median and the 95 percent range of every output, in SI."""
    solve, samples = levels.LEVELS[level]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)  # kept, as statements of the answer
        found = propagate(
            lambda **given: levels.outputs(solve(given)),
            used_by(level, numbers),
            method="quasi_random",
            samples=samples,
            seed=SEED,
        )
    answer: dict[str, Any] = {"samples": found.samples, "without_answer": found.failed, "statements": list(found.statements)}
    answer["outputs"] = {
        name: {"median": significant(out.quantile(0.5)), "range": [significant(end) for end in out.interval(0.95)]}
        for name, out in ((name, found[name]) for name in found)
    }
    return answer


def significant(value: float) -> float:
    """Six digits: more than any measurement has, fewer than platforms differ in."""
    return float(f"{value:.6g}")


def predictions() -> dict[str, Any]:
    """Every case at every level; refused if an input has changed."""
    inputs.check()
    return {
        key: {"title": title, "levels": {level: predict(level, numbers) for level in levels.LEVELS}}
        for key, (title, numbers) in inputs.cases().items()
    }


def write_first() -> None:
    """Write what was predicted before the measurements were read; once."""
    if FIRST.exists():
        raise FileExistsError(f"{FIRST.name} stays as it was committed")
    FIRST.write_text(json.dumps(predictions(), indent=1) + "\n", encoding="utf-8")
