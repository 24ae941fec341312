"""The tables of the page "Scenes": ranks of whole scenes, and what a posterior costs, made of what
``scene_ranks.py`` and ``scene_posterior.py`` wrote.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from coverage_in_crashes import binomial
from evenness import uniformity

WRITTEN = Path(__file__).resolve().parents[1] / "docs" / "_generated" / "scene_ranks.json"
SCENES = 200
COST = WRITTEN.with_name("scene_posterior.json")
_WORDS = {
    "A.speed": "speed of A",
    "B.speed": "speed of B",
    "contacts[0].friction": "friction of the contact",
    "contacts[0].restitution": "restitution",
    "ground": "friction of the ground",
}


def load(path: Path = WRITTEN) -> dict[str, Any]:
    """What was written."""
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found


def setting(found: dict[str, Any]) -> str:
    """How many scenes and samples."""
    count = found["summary"]["scenes"]
    scenes = f"{count} scenes" if count >= SCENES else f"So far {count} of {SCENES} scenes"
    return f"{scenes}, with {found['settings']['samples']:,} samples each."


def table(found: dict[str, Any]) -> str:
    """How often the ranges held, and how even the ranks are, by unknown."""
    summary = found["summary"]
    count = summary["scenes"]
    lines = [
        "| unknown | 95 % ranges that held | 99.8 % interval of that | ranks by tenths | chance |",
        "|---|---:|---:|---|---:|",
    ]
    for name, words in _WORDS.items():
        held = summary["held"][name]
        low, high = binomial(held, count)
        tenths = summary["tenths"][name]
        lines.append(
            f"| {words} | {100 * held / count:.1f} % | {100 * low:.1f} to {100 * high:.1f} % | "
            f"{' '.join(map(str, tenths))} | {uniformity(tenths):.2f} |"
        )
    return "\n".join(lines)


def cost(found: dict[str, Any]) -> str:
    """What ``scene_posterior.py`` wrote: the cost of a posterior by itself, and by ``finer=``."""
    words = {"plain": "by itself", "finer": "`finer=`, below it the scene with `tolerance=1e-3`"}
    lines = [
        "| posterior | runs a sample | of these finer | millions of formulas | budget |",
        "|---|---:|---:|---:|---:|",
    ]
    for name, row in found["rows"].items():
        calls = row["calls_a_sample"]
        lines.append(
            f"| {words[name]} | {sum(calls.values()):.0f} | {calls.get('finer', 0.0):.1f} | "
            f"{row['million_formulas']:.0f} | {found['budgets'][name]:.0f} |"
        )
    return "\n".join(
        [
            *lines,
            "",
            f"With {found['samples']:,} samples; the means lie up to {found['apart']:.2f} standard "
            "deviations apart.",
        ]
    )
