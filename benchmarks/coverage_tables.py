"""The table of ranges in crashes that last on the page "Reverse reconstruction", made from the
numbers that benchmarks/coverage_in_crashes.py wrote.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

DATA = Path(__file__).resolve().parent.parent / "docs" / "_generated" / "lasting_crashes.json"
STATED = 0.95
HEAD = [
    "known, and which crashes",
    "crashes: refused, warned",
    "silent ranges that held",
    "99.8 % interval",
    "too low, too high",
    "one-sided",
    "width, over that of an instant",
]


def load() -> Any:
    """The numbers by world, route and cell."""
    return json.loads(DATA.read_text(encoding="utf-8"))


def coverage(found: dict[str, Any]) -> str:
    """How often the silent ranges of each route held, and in which crashes; bold where too rarely
    to be chance.
    """
    lines = [HEAD, ["---", *["---:"] * (len(HEAD) - 1)]]
    for route, cells in found["lasting"].items():
        beside = found.get("instant", {}).get(route)
        for cell, row in cells.items():
            name = f"**{route}**" if cell == "all" else f"– {cell}"
            lines.append([name, *_cells(row, beside and beside[cell])])
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _cells(row: dict[str, Any], instant: dict[str, Any] | None) -> list[str]:
    low, high = row["interval"]
    share = f"{100.0 * row['held'] / row['ranges']:.1f} %" if row["ranges"] else ""
    held = f"**{share}**" if high < STATED else share
    width, wide = row["width"], instant and instant["width"]
    over = f", {width / wide:.2f}" if width and wide else ""
    return [
        f"{row['crashes']}: {row['refused']}, {row['warned']}",
        f"{held} of {row['ranges']}" if row["ranges"] else "–",
        f"{100.0 * low:.0f} to {100.0 * high:.0f} %" if row["ranges"] else "–",
        f"{row['above']}, {row['below']}",
        str(row["one_sided"]),
        "–" if width is None else f"{3.6 * width:.1f} km/h{over}",
    ]
