"""The tables of the page "Evidence, measured", made from the numbers that benchmarks/evidence.py
wrote.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from stability_tables import table

DATA = Path(__file__).resolve().parent.parent / "docs" / "_generated" / "evidence.json"


def load() -> dict[str, Any]:
    """The numbers."""
    return json.loads(DATA.read_text(encoding="utf-8"))


def held(row: dict[str, Any]) -> str:
    """The share of the intervals that held the truth, and its standard error, in percent."""
    n = row["intervals"]
    if not n:
        return "none"
    share = row["held"] / n
    return f"{100 * share:.1f} ± {100 * math.sqrt(share * (1.0 - share) / n):.1f}"


def routes(found: dict[str, Any]) -> str:
    """How often each route held the truth, how wide it is, and what it warned of or refused."""
    head = [
        "route",
        "crashes",
        "intervals",
        "held the truth, %",
        "above",
        "below",
        "one-sided",
        "open",
        "half width, km/h",
        "warned: held, %",
        "refused",
    ]
    rows = []
    for name, row in found["routes"].items():
        plain, warned = row["plain"], row["warned"]
        counts = [
            str(row["crashes"]),
            str(plain["intervals"]),
            held(plain),
            str(plain["above"]),
            str(plain["below"]),
            str(row["one_sided"]),
            str(row["open"]),
        ]
        widths = (
            "{1:.1f} ({0:.1f} to {2:.1f})".format(*row["half_width"])
            if row["half_width"]
            else "none"
        )
        of_warned = f"{held(warned)} of {warned['intervals']}" if warned["intervals"] else "none"
        rows.append([name, *counts, widths, of_warned, str(row["refused"])])
    return table(head, rows)


def survey(found: dict[str, Any]) -> str:
    """Errors of course and speed by the spacing of the points."""
    head = [
        "points every",
        "course, three points",
        "course, smoothed",
        "speed, three points",
        "speed, smoothed",
    ]
    rows = [
        [
            f"{row['spacing']:g} m",
            f"{row['three_course']:.1f}°",
            f"{row['smoothed_course']:.1f}°",
            f"{100 * row['three_speed']:.1f} %",
            f"{100 * row['smoothed_speed']:.1f} %",
        ]
        for row in found["survey"]
    ]
    return table(head, rows)
