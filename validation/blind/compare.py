"""Holds the predictions against the measurements: held or missed, by how much, and the statistics
of both.
"""

from __future__ import annotations

import json
import math
import statistics
from typing import Any

from . import inputs, measured, predict
from .causes import CAUSES

QUANTITIES = {
    "delta_v_a": ("delta-V of A", "delta-V", "km/h"),
    "delta_v_b": ("delta-V of B", "delta-V", "km/h"),
    "delta_v_forward_a": ("delta-V of A along it", "delta-V", "km/h"),
    "delta_v_forward_b": ("delta-V of B along it", "delta-V", "km/h"),
    "delta_v_left_a": ("delta-V of A to its left", "delta-V", "km/h"),
    "delta_v_left_b": ("delta-V of B to its left", "delta-V", "km/h"),
    "yaw_rate_a": ("yaw rate of A after", "yaw rate", "deg/s"),
    "yaw_rate_b": ("yaw rate of B after", "yaw rate", "deg/s"),
    "energy_lost": ("energy lost", "energy lost", "kJ"),
}
SHOWN = {"km/h": 3.6, "deg/s": 180 / math.pi, "kJ": 1e-3}
READ_FIRST = "inputs fixed before the measurements were read"
KNOWN = "measurements read with the inputs"
REBUILT = 0.01
"""Predictions that differ by more than this share from those first committed are counted."""


def group(key: str) -> str:
    """Whether the measurements were read before the inputs were fixed."""
    return READ_FIRST if key.startswith("ricsac") else KNOWN


def beside(row: dict[str, str], predicted: dict[str, Any]) -> dict[str, Any]:
    """One reading beside what every level predicts, in the unit of the page."""
    title, kind, unit = QUANTITIES[row["quantity"]]
    times = SHOWN[unit]
    reading = measured.value(row) * times
    found: dict[str, Any] = {
        "case": row["case"],
        "test": predicted["title"],
        "quantity": row["quantity"],
        "name": title,
        "kind": kind,
        "unit": unit,
        "group": group(row["case"]),
        "measured": rounded(reading),
        "second": rounded(measured.value(row, "second") * times) if row["second"] else None,
        "note": row["note"],
        "source": row["source"],
        "levels": {},
    }
    for level, answer in predicted["levels"].items():
        out = answer["outputs"][row["quantity"]]
        low, high = (end * times for end in out["range"])
        outside = min(reading - low, 0.0) + max(reading - high, 0.0)
        error = (
            abs(out["median"] * times) - abs(reading)
            if kind != "yaw rate"
            else out["median"] * times - reading
        )
        found["levels"][level] = {
            "predicted": rounded(out["median"] * times),
            "range": [rounded(low), rounded(high)],
            "held": outside == 0.0,
            "outside": rounded(outside),
            "error": rounded(error),
            "percent": rounded(100 * error / abs(reading)) if kind != "yaw rate" else None,
        }
    return found


def entry(row: dict[str, str], predicted: dict[str, Any]) -> dict[str, Any]:
    """A reading beside its predictions, with the cause of a miss; refused if a miss has none."""
    found = beside(row, predicted)
    if not all(answer["held"] for answer in found["levels"].values()):
        if (row["case"], row["quantity"]) not in CAUSES:
            raise LookupError(
                f"{row['case']}: {row['quantity']} was missed, and causes.py does not say what by"
            )
        found["cause"], found["because"] = CAUSES[row["case"], row["quantity"]]
    return found


def rounded(number: float) -> float:
    """Four digits: the readings have three."""
    return float(f"{number:.4g}") + 0.0


def summary(rows: list[dict[str, Any]], level: str) -> dict[str, Any]:
    """Mean, standard deviation and worst of the errors; the share of ranges that held; their median
    half width.
    """
    of_size = rows[0]["kind"] != "yaw rate"
    errors = [row["levels"][level]["percent" if of_size else "error"] for row in rows]
    widths = []
    for row in rows:
        low, high = row["levels"][level]["range"]
        half = (high - low) / 2
        widths.append(100 * half / abs(row["levels"][level]["predicted"]) if of_size else half)
    worst = max(range(len(rows)), key=lambda at: abs(errors[at]))
    return {
        "readings": len(rows),
        "measure": "%" if of_size else rows[0]["unit"],
        "mean": rounded(statistics.fmean(errors)),
        "sd": rounded(statistics.stdev(errors)),
        "worst": errors[worst],
        "worst_of": f"{rows[worst]['test']}, {rows[worst]['name']}",
        "held": sum(row["levels"][level]["held"] for row in rows),
        "half_width": rounded(statistics.median(widths)),
    }


def summaries(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """By group of tests, kind of quantity and level."""
    found = []
    for name in (READ_FIRST, KNOWN, "all"):
        for kind in dict.fromkeys(row["kind"] for row in rows):
            mine = [row for row in rows if row["kind"] == kind and name in ("all", row["group"])]
            if len(mine) > 1:
                found += [
                    {"group": name, "kind": kind, "level": level, **summary(mine, level)}
                    for level in mine[0]["levels"]
                ]
    return found


def self_checks(predicted: dict[str, Any]) -> list[dict[str, Any]]:
    """What the measurements of each staged crash say of themselves, with the direction that was
    predicted.
    """
    found = []
    readings = measured.readings()
    for key, (title, numbers) in inputs.cases().items():
        if group(key) == READ_FIRST:
            entry = measured.self_check(
                readings[key], {name: inputs.middle(stated) for name, stated in numbers.items()}
            )
            impact = predicted[key]["levels"]["impact"]["outputs"]
            entry["direction_predicted"] = math.atan2(
                -impact["delta_v_left_a"]["median"], -impact["delta_v_forward_a"]["median"]
            )
            found.append({"test": title, **{name: rounded(value) for name, value in entry.items()}})
    return found


def changed_since_first(predicted: dict[str, Any]) -> dict[str, int]:
    """How many medians and ends of ranges are not those first committed, by level; the library may
    have changed since.
    """
    first = json.loads(predict.FIRST.read_text(encoding="utf-8"))
    found: dict[str, int] = {}
    for key, case in first.items():
        for level, answer in case["levels"].items():
            if level not in predicted[key]["levels"]:
                continue
            found.setdefault(level, 0)
            for name, out in answer["outputs"].items():
                now = predicted[key]["levels"][level]["outputs"][name]
                scale = out["range"][1] - out["range"][0]
                pairs = zip(
                    [out["median"], *out["range"]], [now["median"], *now["range"]], strict=True
                )
                found[level] += sum(abs(old - new) > REBUILT * scale for old, new in pairs)
    return found


def entries(predicted: dict[str, Any]) -> list[dict[str, Any]]:
    """Every reading beside its predictions."""
    return [
        entry(row, predicted[row["case"]])
        for row in measured.rows()
        if row["quantity"] in QUANTITIES
    ]
