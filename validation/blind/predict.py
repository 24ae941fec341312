"""Predicts every blind case at every level from its inputs alone, with 95 percent ranges.

No module that this one imports reads a measurement.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Collection
from typing import Any

import collisions as col
from collisions.uncertainty import propagate

from . import inputs, levels

SEED = 42
FIRST = inputs.HERE / "first_predictions.json"


def predict(level: str, numbers: dict[str, Any]) -> dict[str, Any]:
    """One case at one level: the median and the 95 percent range of every output, in SI."""
    how = levels.LEVELS[level]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)  # kept, as statements of the answer
        found = propagate(
            lambda **given: levels.outputs(how.solve(given)),
            how.numbers(numbers),
            method="quasi_random",
            samples=how.samples,
            seed=SEED,
        )
    return {
        "samples": found.samples,
        "without_answer": found.failed,
        "statements": list(found.statements),
        "outputs": {
            name: {
                "median": significant(found[name].quantile(0.5)),
                "range": [significant(end) for end in found[name].interval(0.95)],
            }
            for name in found
        },
    }


def significant(value: float) -> float:
    """Six digits: more than any measurement has, fewer than platforms differ in."""
    return float(f"{value:.6g}")


def predictions(only: Collection[str] = tuple(levels.LEVELS)) -> dict[str, Any]:
    """Every case at every level; refused if an input has changed."""
    inputs.check()
    return {
        key: {"title": title, "levels": {level: predict(level, numbers) for level in only}}
        for key, (title, numbers) in inputs.cases().items()
    }


def write_first() -> None:
    """Write what was predicted before the measurements were read; once."""
    if FIRST.exists():
        raise FileExistsError(f"{FIRST.name} stays as it was committed")
    FIRST.write_text(json.dumps(predictions(), indent=1) + "\n", encoding="utf-8")
