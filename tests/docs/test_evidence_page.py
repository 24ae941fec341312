"""The page "Evidence, measured": its file has what it shows and says what the page says, and a
quick run of the script agrees.
"""

import json
import math
import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

from scripts import benchmarks

ROOT = Path(__file__).resolve().parent.parent.parent

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (ROOT / "benchmarks").is_dir(), reason="the sdist has no benchmarks"),
]


@pytest.fixture(scope="module")
def committed():
    """The committed numbers."""
    return json.loads((ROOT / "docs" / "_generated" / "evidence.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def scripts():
    """The script and its tables."""
    return benchmarks("evidence", "evidence_tables")


def test_every_route_holds_the_truth_as_often_as_it_states(committed, scripts):
    """Of 300 answered crashes or more, 93 to 97 % of the intervals that nothing was warned of; of
    those known from one side more, as they may be no wider.
    """
    assert set(committed["routes"]) == set(scripts[0].ROUTES)
    for name, row in committed["routes"].items():
        answered = row["crashes"] - row["refused"]
        assert answered >= 300, name
        assert row["plain"]["intervals"] + row["warned"]["intervals"] == 2 * answered, name
        share = row["plain"]["held"] / row["plain"]["intervals"]
        assert share >= 0.93, name
        assert share <= 0.97 or row["one_sided"] + row["open"] > 0, name
        # Four in five have an end at least.
        assert row["open"] <= 0.2 * 2 * answered, name
        # A recorder with its own speed knows more than there are unknowns: near the edge of sliding
        # its readings contradict it. A contact that slid may be so slight that delta-V is no more
        # than a recorder's half km/h, whose sign is then open. Otherwise only a path that its spin
        # leaves no drag is refused.
        assert (
            row["refused"] <= 0.01 * row["crashes"]
            or name == "components and speed of one recorder"
            or (name.endswith("contact slid") and row["refused"] <= 0.02 * row["crashes"])
        ), name
    momentum, everything = (
        committed["routes"][name]["half_width"][1] for name in list(scripts[0].ROUTES)[4:]
    )
    assert everything < 0.6 * momentum


def test_a_denser_survey_is_never_worse(committed):
    """Smoothed, by more than chance: two standard errors of a root mean square of 200, 5 % each.
    Three points become worse.
    """
    for coarse, dense in pairwise(committed["survey"]):
        for name in ("smoothed_course", "smoothed_speed"):
            assert dense[name] <= 1.1 * coarse[name]
        assert dense["three_course"] > 1.5 * coarse["three_course"]


def test_a_quick_run_agrees_and_the_page_can_be_drawn(scripts, committed, tmp_path):
    """A dozen crashes: as many intervals held as the committed share has it, but for chance."""
    evidence, tables = scripts
    path = tmp_path / "evidence.json"
    script = ROOT / "benchmarks" / "evidence.py"
    subprocess.run(
        [sys.executable, str(script), "--quick", "--json", str(path)],
        check=True,
        capture_output=True,
        timeout=1200,
    )
    quick = json.loads(path.read_text("utf-8"))
    for name, row in quick["routes"].items():
        # Two speeds of a crash err together, so as 12 draws of 0.95: fewer than 9 held by chance
        # once in 500.
        held = sum(row[key]["held"] for key in ("plain", "warned"))
        assert held >= 0.7 * sum(row[key]["intervals"] for key in ("plain", "warned")), name
    for found in (quick, committed):
        assert tables.routes(found).count("\n") == 1 + len(found["routes"])
        assert tables.survey(found).count("\n") == 1 + len(evidence.SPACINGS)


def test_what_path_leaves_out_is_what_the_page_says(scripts):
    """The two errors of the method, of 400 crashes: a tenth of each is chance, of what is left
    more.
    """
    evidence, _ = scripts
    found = evidence.model_error(evidence.crashes(400, evidence.SEED + 1))
    assert found["YAWING"] == pytest.approx(evidence.YAWING, rel=0.05)
    assert found["BEND"] == pytest.approx(evidence.BEND, rel=0.1)
    assert found["YAWING_LEFT"] < 1.3 * evidence.YAWING_LEFT
    page = (ROOT / "docs" / "evidence.md").read_text("utf-8")
    assert found["SPIN"] == pytest.approx(evidence.SPIN, rel=0.1)
    for number in (evidence.YAWING, evidence.YAWING_LEFT, evidence.BEND, evidence.SPIN):
        assert f"{number:g}" in page
        assert f"{number:g}" in (ROOT / "docs" / "intersection_case.md").read_text("utf-8")
    for speed, degrees in ((60 / 3.6, 5.5), (25 / 3.6, 31.5)):
        assert math.degrees(evidence.SPIN / speed**2) == pytest.approx(degrees, abs=0.5)
    for speed, degrees in ((60 / 3.6, 0.6), (25 / 3.6, 3.6)):
        off = evidence.BEND * evidence.WINDOW**2 * evidence.GROUND.given_mean * 9.80665 / speed**2
        assert math.degrees(off) == pytest.approx(degrees, abs=0.35)


def cells_of(page):
    """The code of a page, cell by cell."""
    text = (ROOT / "docs" / f"{page}.md").read_text("utf-8")
    return re.findall(r"```\{code-cell\} ipython3\n(?::tags: \[[^\n]*\n)?(.*?)```", text, re.DOTALL)


def test_where_the_information_is_lost_each_way_back_refuses_or_warns(capsys):
    """The cases of the page, in their order."""
    names = {}
    for cell in cells_of("evidence")[1:-1]:
        exec(cell, names)
    said = re.findall(r"^(?:refused|warned) \((\w+)\)", capsys.readouterr().out, re.MULTILINE)
    along = ["nearly_collinear", "parallel_headings", "nearly_collinear", "may_slide"]
    slip = ["undetermined", "ambiguous"]
    cut, fold, spin = (
        ["pulse_cut", "pulse_cut"],
        ["may_slide", "fold", "failed_cases"],
        ["wide_segment", "fast_yaw"],
    )
    thin = ["contradictory", "may_slide", "undetermined", "may_slide"]
    assert said == [*along, *slip, *cut, *fold, *spin, *thin]


@pytest.mark.filterwarnings("ignore:(?s).*contact.*stick at an impulse ratio of 0.3 or more")
def test_the_worked_case_says_what_came_out():
    """Its cells, run: every range of the table holds the truth, and the numbers that its text names
    are still so.
    """
    cells = cells_of("intersection_case")
    pytest.importorskip("matplotlib").use("agg")
    names = {"display": lambda *shown: None, "Markdown": str}
    for cell in cells:
        exec(cell.replace("from IPython.display import Markdown, display", ""), names)
    assert len(names["held"]) == 18
    assert all(names["held"])
    assert names["truth"].regime == "sticking"
    a = names["runs"]["a"].course - names["truth"].a.after.course
    assert abs(a) > 2.0 * names["course_error"]["a"]
    assert 100 < 1 / sum(names["weights"] ** 2) < 2000  # of 4096
    residuals = {name: abs(one.over_sigma) for name, one in names["found"].residuals.items()}
    assert max(residuals, key=residuals.__getitem__) == "course of A"
