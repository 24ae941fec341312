"""The tables of the page "What a level of a scene costs and misses", made of the numbers that
``scene_levels.py`` wrote.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

WRITTEN = Path(__file__).resolve().parents[1] / "docs" / "_generated" / "scene_levels.json"
_HEADS = {
    "impacts[0].b.delta_v": "delta-V",
    "B.rest.x": "rest x",
    "B.rest.y": "rest y",
    "B.rest.heading": "heading",
}
_MOTION = {"drag": "by drag", "wheels": "on wheels"}


def load() -> dict[str, Any]:
    """What was written."""
    found: dict[str, Any] = json.loads(WRITTEN.read_text(encoding="utf-8"))
    return found


def setting(found: dict[str, Any]) -> str:
    """How it was measured."""
    return (
        f"Differences are of {found['draws']} draws, and the time of a case in a batch is that of "
        f"{found['cases']}."
    )


def table(found: dict[str, Any], name: str) -> str:
    """One scene at every level."""
    record = found["scenes"][name]
    finest = record["levels"][-1]
    asked = record["tolerances"]
    lines = [
        f"**{name[:1].upper()}{name[1:]}.** {record['words']}",
        "",
        f"| contacts | motion | {' | '.join(_HEADS.values())} | cost of a run | in a batch |",
        f"|---|---|{'---|' * len(_HEADS)}---|---|",
    ]
    for row in record["levels"]:
        cells = [_cell(row["differences"][path], asked[path], path) for path in _HEADS]
        costs = (row[kind] / finest[kind] for kind in ("seconds", "seconds_in_batch"))
        shares = " | ".join(f"{cost:.2f}" for cost in costs)
        motion = _MOTION[row["motion"]]
        lines.append(f"| {row['contacts']} | {motion} | {' | '.join(cells)} | {shares} |")
    lines += ["", f"The cheapest within what was asked for: {record['level']}.", ""]
    lost = record["draws"] - record["answered"]
    if lost:
        lines += [f"{lost} of the draws have no answer at the finest level.", ""]
    return "\n".join(lines)


def costs(found: dict[str, Any]) -> str:
    """What the levels cost over all scenes."""
    shares: dict[tuple[str, str, str], list[float]] = {}
    for record in found["scenes"].values():
        finest = record["levels"][-1]
        for row in record["levels"]:
            for kind in ("seconds", "seconds_in_batch"):
                place = row["contacts"], row["motion"], kind
                shares.setdefault(place, []).append(row[kind] / finest[kind])

    def span(contacts: str, motion: str, kind: str) -> str:
        ends = shares[contacts, motion, kind]
        return f"{min(ends):.2f} to {max(ends):.2f}"

    return (
        "Of the finest level, a batch takes "
        f"{span('instant', 'drag', 'seconds_in_batch')} with contacts of an instant and a drag, "
        f"{span('in time', 'drag', 'seconds_in_batch')} with contacts in time and a drag, and "
        f"{span('instant', 'wheels', 'seconds_in_batch')} with contacts of an instant on wheels. "
        "One run alone saves less, as most of it is the same for all: "
        f"{span('instant', 'drag', 'seconds')} with contacts of an instant and a drag."
    )


def wheels_against_drag(found: dict[str, Any]) -> str:
    """How much longer a case takes on wheels than with a drag, in one sentence."""
    ratios = []
    for record in found["scenes"].values():
        seconds = {
            row["motion"]: row["seconds_in_batch"]
            for row in record["levels"]
            if row["contacts"] == "instant"
        }
        ratios.append(seconds["wheels"] / seconds["drag"])
    return (
        f"In four scenes that were measured, a case on wheels takes {min(ratios):.0f} to "
        f"{max(ratios):.0f} times as long as one with a drag."
    )


def _cell(difference: Any, asked: float, path: str) -> str:
    off = math.inf if isinstance(difference, str) else float(difference)
    if math.isinf(off):
        return "none"
    if path.endswith("heading"):
        text = f"{math.degrees(off):.0f}°"
    else:
        text = f"{off:.2f} {'m/s' if path.endswith('delta_v') else 'm'}"
    return f"**{text}**" if off <= asked else text
