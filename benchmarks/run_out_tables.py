"""The tables of the page "Run-outs", made from the numbers that benchmarks/run_outs.py and
benchmarks/run_out_coverage.py wrote.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from collisions.quantities.printed_tables import Part, in_markdown

DATA = Path(__file__).resolve().parent.parent / "docs" / "_generated"
WHAT = {"place": "place, over the way", "heading": "heading, in rad", "time": "time, over the time"}


def load(name: str) -> Any:
    """The numbers of one of the scripts."""
    return json.loads((DATA / name).read_text(encoding="utf-8"))


def table(head: list[str], rows: list[list[str]]) -> str:
    """A Markdown table whose columns of numbers are on the right."""
    sides = ["---", *["---:"] * (len(head) - 1)]
    return in_markdown(Part([tuple(row) for row in rows], columns=tuple(head)), sides=sides)


def promise(found: dict[str, Any]) -> str:
    """What places of rest, headings and times err by at the default tolerance."""
    known = found["promise"]
    rows = [
        [text, *(f"{known[name][key]:.1e}" for key in ("median", "p99", "largest"))]
        for name, text in WHAT.items()
    ]
    return table(["error in", "median", "99 of 100 below", "largest"], rows)


def beyond(found: dict[str, Any]) -> str:
    """How many were beyond the promise, and how sensitive these are."""
    known = found["promise"]
    if not known["beyond"]:
        return f"None of the {known['scenes']} is off by more than {found['promised']:g}."
    moved = ", ".join(f"{value:.1e}" for value in known["moved_by_speed"])
    return (
        f"{known['beyond']} of the {known['scenes']} are off by more than {found['promised']:g}. A "
        "change of the speed at separation by one part in 100,000 moves their rests by this part "
        f"of the way: {moved}."
    )


def ladder(found: dict[str, Any]) -> str:
    """Cost against error of every way to work out a run-out."""
    rows = []
    for row in found["ladder"]["rows"]:
        cells = [_percent(row["speed"][key]) for key in ("median", "p90")]
        place, heading = row.get("place"), row.get("heading")
        cells += ["–" if place is None else _percent(place[key]) for key in ("median", "p90")]
        cells.append("–" if heading is None else f"{heading['median']:.2g}")
        rows.append([row["name"], f"{row['cost']:.3g}", *cells])
    head = [
        "way",
        "cost of a case in a batch",
        "speed off by (median)",
        "9 of 10 below",
        "place off by (median)",
        "9 of 10 below",
        "heading off by (median), deg",
    ]
    return table(head, rows)


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %"


def coverage(found: dict[str, Any]) -> str:
    """How often stated 95 % ranges held cars whose wheels spin."""
    rows = found["rows"]
    kinds = list(dict.fromkeys(row["kind"] for row in rows))
    outputs = list(dict.fromkeys(row["output"] for row in rows))
    known = {(row["output"], row["kind"]): row for row in rows}
    lines = []
    for output in outputs:
        cells = []
        for kind in kinds:
            row = known[output, kind]
            share = f"{100.0 * row['held'] / row['cars']:.0f} %" if row["cars"] else "–"
            cells.append(f"**{share}**" if row["high"] < 0.95 else share)
        lines.append([output, *cells])
    return table(["95 % range of", *kinds], lines)


def off_by_path(found: dict[str, Any]) -> str:
    """What ``path`` is off by in other run-outs, in a phrase."""
    off = found["off"]
    return f"{100.0 * off['speed']:.1f} % in speed and {off['yaw_rate']:.2f} rad/s in yaw rate"


def pooled(found: dict[str, Any]) -> str:
    """The share held over all outputs."""
    rows = [row for row in found["rows"] if row["kind"] == "all"]
    return f"{100.0 * sum(row['held'] for row in rows) / sum(row['cars'] for row in rows):.1f} %"
