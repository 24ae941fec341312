"""The page "Evidence, measured": its file has what it shows and says what the page says, and a quick run of the script agrees."""

import json
import math
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

pytestmark = [pytest.mark.slow, pytest.mark.skipif(not (ROOT / "benchmarks").is_dir(), reason="the sdist has no benchmarks")]


@pytest.fixture(scope="module")
def committed():
    """The committed numbers."""
    return json.loads((ROOT / "docs" / "_generated" / "evidence.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def scripts():
    """The script and its tables."""
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        import evidence
        import evidence_tables
    finally:
        sys.path.remove(str(ROOT / "benchmarks"))
    return evidence, evidence_tables


def test_every_route_holds_the_truth_as_often_as_it_states(committed, scripts):
    """Of 300 crashes or more, 93 to 97 % of the intervals that nothing was warned of."""
    assert set(committed["routes"]) == set(scripts[0].ROUTES)
    for name, row in committed["routes"].items():
        assert row["crashes"] >= 300, name
        assert row["refused"] <= 0.02 * row["crashes"], name
        assert 0.93 <= row["plain"]["held"] / row["plain"]["intervals"] <= 0.97, name
        assert row["plain"]["intervals"] >= row["crashes"], name


def test_a_denser_survey_is_never_worse(committed):
    """Smoothed, each halving of the spacing; 200 ways are good to 5 %, and share their crashes. Three points become worse."""
    for coarse, dense in pairwise(committed["survey"]):
        for name in ("smoothed_course", "smoothed_speed"):
            assert dense[name] <= 1.03 * coarse[name]
        assert dense["three_course"] > 1.5 * coarse["three_course"]


def test_a_quick_run_agrees_and_the_page_can_be_drawn(scripts, committed, tmp_path):
    """A dozen crashes: as many intervals held as the committed share has it, but for chance."""
    evidence, tables = scripts
    path = tmp_path / "evidence.json"
    script = ROOT / "benchmarks" / "evidence.py"
    subprocess.run([sys.executable, str(script), "--quick", "--json", str(path)], check=True, capture_output=True, timeout=300)
    quick = json.loads(path.read_text("utf-8"))
    for name, row in quick["routes"].items():
        # Two speeds of a crash err together, so as 12 draws of 0.95: fewer than 9 held by chance once in 500.
        held = sum(row[key]["held"] for key in ("plain", "warned"))
        assert held >= 0.7 * sum(row[key]["intervals"] for key in ("plain", "warned")), name
    for found in (quick, committed):
        assert tables.routes(found).count("\n") == 1 + len(found["routes"])
        assert tables.survey(found).count("\n") == 1 + len(evidence.SPACINGS)


def test_what_path_leaves_out_is_what_the_page_says(scripts):
    """The two errors of the method, of 40 crashes of another seed: a fifth of each is chance."""
    evidence, _ = scripts
    found = evidence.model_error(evidence.crashes(40, evidence.SEED + 1))
    assert found["YAWING"] == pytest.approx(evidence.YAWING, rel=0.2)
    assert found["BEND"] == pytest.approx(evidence.BEND, rel=0.5)
    assert found["YAWING_LEFT"] < 2.0 * evidence.YAWING_LEFT
    page = (ROOT / "docs" / "evidence.md").read_text("utf-8")
    for number in (evidence.YAWING, evidence.YAWING_LEFT, evidence.BEND):
        assert f"{number:g}" in page
    for speed, degrees in ((60 / 3.6, 0.5), (25 / 3.6, 3.0)):
        off = evidence.BEND * evidence.WINDOW**2 * evidence.GROUND.given_mean * 9.80665 / speed**2
        assert math.degrees(off) == pytest.approx(degrees, abs=0.35)
