"""The staged crashes from the impact to rest: a scene on wheels, for those whose places of rest
were measured.

The inputs are those that were fixed and the wheels of ``levels.WHEELS``, which were not.
"""

from __future__ import annotations

from typing import Any

from collisions.scene import Contact, Mover, Scene
from collisions.uncertainty import propagate

from . import inputs, levels, measured
from .causes import AT_REST
from .compare import rounded
from .predict import SEED, significant

SAMPLES = 256
PLACES = ("rest_forward_a", "rest_left_a", "rest_forward_b", "rest_left_b")
"""Along and across A before the impact, from its centre of mass at the impact."""


def scene(numbers: levels.Numbers) -> Scene:
    """The contact of the case at time 0, and both cars on their wheels after it."""
    a, b = levels.vehicles(numbers)
    return Scene(
        movers={
            "A": Mover(a, tyres=levels.wheels(numbers, "a")),
            "B": Mover(b, tyres=levels.wheels(numbers, "b")),
        },
        contacts=[Contact("A", "B", **levels.contact(numbers), at=0)],
    )


def places(**numbers: Any) -> dict[str, Any]:
    """Where both come to rest."""
    rest = scene(numbers).run().rest
    return {
        f"rest_{axis}_{side}": getattr(rest[side.upper()], of)
        for side in ("a", "b")
        for axis, of in (("forward", "x"), ("left", "y"))
    }


def predict(numbers: levels.Numbers) -> dict[str, Any]:
    """The median and the 95 percent range of every place [m]."""
    how = levels.Level(levels.impact, SAMPLES, beyond=levels.WHEELS)
    found = propagate(
        places, how.numbers(numbers), method="quasi_random", samples=SAMPLES, seed=SEED
    )
    if found.failed:
        raise AssertionError(f"{found.failed} cases do not come to rest")
    return {
        name: [significant(end) for end in (found[name].quantile(0.5), *found[name].interval(0.95))]
        for name in PLACES
    }


def rows() -> list[dict[str, Any]]:
    """Every measured place of rest beside its prediction; refused if a miss has no cause."""
    cases, predicted = inputs.cases(), {}
    found = []
    for row in measured.rows():
        if row["quantity"] not in PLACES:
            continue
        case = row["case"]
        if case not in predicted:
            predicted[case] = predict(cases[case][1])
        median, low, high = predicted[case][row["quantity"]]
        reading = measured.value(row)
        held = low <= reading <= high
        if not held and (case, row["quantity"]) not in AT_REST:
            raise LookupError(f"{case}: {row['quantity']} was missed, and causes.py has no cause")
        cause, because = ("", "") if held else AT_REST[case, row["quantity"]]
        _, axis, side = row["quantity"].split("_")
        found.append(
            {
                "case": case,
                "test": cases[case][0],
                "quantity": row["quantity"],
                "name": f"{side.upper()}, {'forward' if axis == 'forward' else 'to the left'}",
                "measured": rounded(reading),
                "predicted": rounded(median),
                "range": [rounded(low), rounded(high)],
                "held": held,
                "outside": rounded(max(low - reading, reading - high, 0.0)),
                "cause": cause,
                "because": because,
            }
        )
    return found
