"""What other ranges would have held, tried after the measurements were read: no prediction, and no
input is changed by it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from collisions.uncertainty import Normal, Uniform

from . import compare, inputs, measured, predict

Numbers = dict[str, Any]
LEVEL = "impact"


def point_to(half: float) -> Callable[[Numbers], Numbers]:
    """The contact point known to so many metres along each axis, at 95 percent."""
    names = ("eccentric.point.0", "eccentric.point.1")
    return lambda numbers: (
        numbers
        | {name: Normal(inputs.middle(numbers[name]), half / inputs.HALF_95) for name in names}
    )


def friction(low: float, high: float) -> Callable[[Numbers], Numbers]:
    """Another friction between the cars, any value alike."""
    return lambda numbers: numbers | {"eccentric.friction": Uniform(low, high)}


TRIED: dict[str, Callable[[Numbers], Numbers]] = {
    "as stated": lambda numbers: numbers,
    "point to 0.5 m": point_to(0.5),
    "point to 0.9 m": point_to(0.9),
    "friction 0.3 to 0.6": friction(0.3, 0.6),
    "friction so high that nothing slips": friction(50.0, 51.0),
}


def rows() -> list[dict[str, Any]]:
    """How often the ranges of the staged crashes would have held, by what is tried and quantity."""
    staged = {
        key: case
        for key, case in inputs.cases().items()
        if compare.group(key) == compare.READ_FIRST
    }
    readings = [
        row
        for row in measured.rows()
        if row["case"] in staged and row["quantity"] in compare.QUANTITIES
    ]
    found = []
    for name, change in TRIED.items():
        predicted = {
            key: {"title": title, "levels": {LEVEL: predict.predict(LEVEL, change(numbers))}}
            for key, (title, numbers) in staged.items()
        }
        entries = [compare.beside(row, predicted[row["case"]]) for row in readings]
        for kind in dict.fromkeys(row["kind"] for row in entries):
            summary = compare.summary([row for row in entries if row["kind"] == kind], LEVEL)
            found.append(
                {
                    "tried": name,
                    "kind": kind,
                    **{key: summary[key] for key in ("readings", "held", "half_width", "measure")},
                }
            )
    return found
