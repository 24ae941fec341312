"""The page of levels of scenes: its tables are made of the numbers that were written, and a sample
of them is worked out again.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def scripts() -> tuple[ModuleType, ModuleType]:
    """The script that writes the numbers, and the tables made of them."""
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        import scene_levels
        import scene_levels_tables
    finally:
        sys.path.pop(0)
    return scene_levels, scene_levels_tables


def test_every_scene_has_its_table(scripts: Any) -> None:
    """What is bold is within what was asked for."""
    levels, tables = scripts
    found = tables.load()
    assert list(found["scenes"]) == list(levels.SCENES)
    for name, record in found["scenes"].items():
        text = tables.table(found, name)
        assert record["tolerances"] == pytest.approx(levels.ASKED)
        rows = [
            line for line in text.splitlines() if line.startswith(("| instant", "| with", "| in"))
        ]
        assert len(rows) == 5
        for row, line in zip(record["levels"], rows, strict=True):
            bold = sum(
                not isinstance(off, str) and off <= record["tolerances"][path]
                for path, off in row["differences"].items()
            )
            assert line.count("**") == 2 * bold
        assert record["levels"][-1]["within"]


def test_what_the_page_says_of_the_numbers(scripts: Any) -> None:
    _, tables = scripts
    for record in tables.load()["scenes"].values():
        rows = {(row["contacts"], row["motion"]): row for row in record["levels"]}
        finest = rows["in time", "wheels"]
        assert rows["instant", "drag"]["seconds_in_batch"] < finest["seconds_in_batch"]
        # Delta-V of the first contact is the same by drag and on wheels, but where draws that do
        # not come to a second contact have no answer at all.
        one, other = (
            rows["instant", motion]["differences"]["impacts[0].b.delta_v"]
            for motion in ("drag", "wheels")
        )
        assert isinstance(one, str) or one == pytest.approx(other, rel=1e-6)


@pytest.mark.slow
def test_a_scene_is_measured_again(scripts: Any) -> None:
    """With the draws that were written, the same differences, to the digits of the page."""
    levels, tables = scripts
    found = tables.load()
    name = "rear end, both braked"
    scene = levels.SCENES[name]()
    again = scene.required(
        levels.ASKED, levels.unknowns(scene), draws=found["draws"], tolerance=levels.TOLERANCE
    ).to_dict()
    for row, was in zip(again["levels"], found["scenes"][name]["levels"], strict=True):
        for path, off in row["differences"].items():
            if isinstance(off, str) or isinstance(was["differences"][path], str):
                assert off == was["differences"][path]
            else:
                assert math.isclose(off, was["differences"][path], rel_tol=1e-3, abs_tol=1e-4)
