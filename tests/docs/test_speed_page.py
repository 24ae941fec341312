"""The page "Speed against accuracy" has every row it shows, and the errors it shows are those of
the solvers; no time is judged.
"""

import ast
import inspect
import json
import math
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import collisions as col
from scripts import benchmarks

ROOT = Path(__file__).resolve().parent.parent.parent
# The file keeps three digits.
THREE_DIGITS = 0.006
PAGE = ROOT / "docs" / "speed_against_accuracy.md"
# Rows of what need not be installed.
OPTIONAL = {"numba", "numba_threads", "pymunk"}

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (ROOT / "benchmarks").is_dir(), reason="the sdist has no benchmarks"),
]


@pytest.fixture(scope="module")
def tables():
    """What makes the tables of the page."""
    return benchmarks("speed_tables")


@pytest.fixture(scope="module")
def committed(tables):
    """The committed numbers, and those of the contacts integrated in time."""
    return tables.load(), tables.load_contacts()


@pytest.fixture(scope="module")
def quick(tmp_path_factory):
    """The same of a quick run of the script."""
    path = tmp_path_factory.mktemp("speed") / "speed.json"
    script = ROOT / "benchmarks" / "speed.py"
    subprocess.run(
        [sys.executable, str(script), "--quick", "--json", str(path)],
        check=True,
        capture_output=True,
        timeout=1200,
    )
    return tuple(
        json.loads(file.read_text(encoding="utf-8"))
        for file in (path, path.with_name("time_resolved.json"))
    )


def keys(found):
    """Every row of a file of numbers, by its group."""
    groups = {
        group: {row["key"] for row in found[group]} - OPTIONAL
        for group in ("single", "batch", "budgets")
    }
    groups |= {
        group: {curve["key"] for curve in found["errors"][group]} for group in ("levers", "angles")
    }
    return groups | {
        "imports": set(found["imports"]["rows"]),
        "choices": set(found["errors"]["choices"]),
    }


def shown(tables, found, contacts):
    """Every table that the page shows, by the call that makes it."""
    calls = re.findall(r"tables\.(\w+)\((\w+)(?:, \"(\w+)\")?\)", PAGE.read_text(encoding="utf-8"))
    given = {"found": found, "contacts": contacts, "rungs": tables.load_ladder()}
    return {
        call: getattr(tables, call[0])(given[call[1]], *filter(None, call[2:])) for call in calls
    }


def test_a_quick_run_has_the_rows_of_the_committed_file(quick, committed):
    """So that the file was written by this script, and the script runs."""
    assert keys(quick[0]) == keys(committed[0])
    assert [row["name"] for row in quick[1]["rows"]] == [
        row["name"] for row in committed[1]["rows"]
    ]


@pytest.mark.parametrize("which", ["quick", "committed"])
def test_every_table_of_the_page_can_be_made(tables, request, which):
    """Also where numba and pymunk were not measured."""
    found, contacts = request.getfixturevalue(which)
    made = shown(tables, found, contacts)
    assert {call[0] for call in made} >= {
        "machine",
        "choices",
        "costs",
        "budgets",
        "curves",
        "contacts",
        "rivals",
        "imports",
    }
    assert all("nan" not in text for text in made.values())
    without = json.loads(json.dumps(found))
    for group in ("single", "batch"):
        without[group] = [row for row in without[group] if row["key"] not in OPTIONAL]
    without["rivals"] = dict.fromkeys(without["rivals"])
    without["errors"]["choices"]["pymunk"] = None
    without["imports"]["rows"] |= {"numba": None, "pymunk": None}
    assert "not measured" in shown(tables, without, contacts)["rivals", "found", ""]


def test_every_choice_of_the_chart_has_its_rows(tables, committed):
    """A cost for one case or for a batch, and an error."""
    found = keys(committed[0])
    for choice in tables.CHOICES:
        assert choice.single is not None or choice.batch is not None
        assert {choice.single} - {None} <= found["single"] | OPTIONAL
        assert {choice.batch} - {None} <= found["batch"] | OPTIONAL
        assert choice.error in found["choices"]


def test_the_figures_can_be_drawn(tables, committed, tmp_path):
    """And are the ones that the page shows."""
    pytest.importorskip("matplotlib")
    tables.draw_all(*committed, tmp_path)
    drawn = {path.name for path in tmp_path.iterdir()}
    assert drawn == set(re.findall(r"_static/(\w+\.svg)", PAGE.read_text(encoding="utf-8")))
    assert drawn <= {path.name for path in (ROOT / "docs" / "_static").iterdir()}


@pytest.fixture(scope="module")
def ladder():
    """The script of the rungs."""
    return benchmarks("ladder")


def test_every_rung_is_nearer_than_the_one_before(tables):
    """From linear_central to 200 steps; the tyres from outside take most of what tyres alone leave,
    as far as they are estimated.
    """
    found = tables.load_ladder()
    medians = [
        row["median"]
        for name, row in found["rungs"].items()
        if not name.endswith(", from maximum engagement")
    ]
    assert len(medians) == 10
    assert medians == sorted(medians, reverse=True)
    assert all(row["no_answer"] == 0 for row in found["rungs"].values())
    (wheels, held), (centre, nearly) = found["tyres_alone"].values()
    assert held < 0.3 * wheels
    assert nearly < 0.12 * centre < 0.02


def test_what_stronge_and_brach_differ_by_in_traffic(ladder):
    """The design's figures: the same where the slip goes on, a third of traffic; sticking 0.2 % in
    the median; reversing, which is rare, 5 %, up to 30 %.

    To the one digit that other draws of such traffic share; of 20,000 impacts 165 reverse, whose
    median is known to a tenth. What slides on is the same but for the rounding of both.
    """
    scene = ladder.traffic(20_000)
    stronge, brach = (
        ladder.solved(scene, ladder.col.eccentric, law=law) for law in ("stronge", "brach")
    )
    _, share = ladder.apart(stronge, brach)
    found = {
        regime: share[stronge.regime == regime] for regime in ("sliding", "sticking", "reversing")
    }
    assert found["sliding"].size / 20_000 == pytest.approx(1 / 3, abs=0.05)
    assert found["sliding"].max() < 16 * np.finfo(float).eps
    assert np.median(found["sticking"]) == pytest.approx(0.002, abs=0.0005)
    assert np.quantile(found["sticking"], 0.95) == pytest.approx(0.02, abs=0.005)
    assert found["reversing"].size / 20_000 == pytest.approx(0.01, abs=0.005)
    assert np.median(found["reversing"]) == pytest.approx(0.05, abs=0.005)
    assert found["reversing"].max() < 0.3


def test_too_little_is_accepted_in_less_than_one_of_a_hundred(tables, ladder):
    """Of 5,000 scenes at 0.5, 1 and 2 m/s; of fewer, the file's own script finds none again."""
    found = tables.load_ladder()["choices"]
    assert [row["tolerance"] for row in found] == [0.5, 1.0, 2.0]
    for row in found:
        assert row["impacts"] >= 5000
        assert sum(row["models"].values()) == row["impacts"]
        assert row["wrong"] < 0.01 * row["impacts"]
        assert row["wrong_share"] == pytest.approx(row["wrong"] / row["impacts"], rel=THREE_DIGITS)
    for row in ladder.choices(150):
        assert row["impacts"] > 140
        assert row["wrong"] <= 1


def test_the_rungs_measured_again_are_the_committed_ones(tables, ladder):
    """Over the same scenes, which are seeded: to the three digits that are kept."""
    found = tables.load_ladder()
    again = ladder.rungs(found["impacts"])
    assert again["rungs"].keys() == found["rungs"].keys()
    for name, row in again["rungs"].items():
        for figure in ("median", "most_of_10"):
            assert row[figure] == pytest.approx(found["rungs"][name][figure], rel=THREE_DIGITS), (
                name,
                figure,
            )
    for place, medians in again["tyres_alone"].items():
        assert medians == pytest.approx(found["tyres_alone"][place], rel=THREE_DIGITS), place
    for one, other in zip(again["by_closing_speed"], found["by_closing_speed"], strict=True):
        assert one == pytest.approx(other, rel=THREE_DIGITS)


@pytest.fixture(scope="module")
def yardsticks():
    """The scripts that hold what is compared with, and the budgets."""
    names = ("budgets", "batch_speed", "speed_rivals")
    return dict(zip(names, benchmarks(*names), strict=True))


def test_the_yardsticks_square_by_a_product(yardsticks):
    """``x**2`` takes Python several times as long as ``x * x``, which the formula in C has too: no
    ratio is to gain by that.
    """
    made = ("speed_rivals", "formula"), ("batch_speed", "textbook"), ("budgets", "textbook_linear")
    for module, name in made:
        tree = ast.parse(textwrap.dedent(inspect.getsource(getattr(yardsticks[module], name))))
        assert not [node for node in ast.walk(tree) if isinstance(node, ast.Pow)], (
            f"{module}.{name}"
        )
    assert "pow(" not in (ROOT / "benchmarks" / "formula.c").read_text(encoding="utf-8")


def test_every_budget_is_that_of_the_design(committed, yardsticks):
    """The page judges by them; whether they hold is not judged here."""
    budgets = {row.key: row.budget for row in yardsticks["budgets"].BUDGETS}
    assert {row["key"] for row in committed[0]["budgets"]} == budgets.keys()
    assert budgets == {
        "import": 1.15,
        "vehicle": 2.5,
        "eccentric": 3.0,
        "nine": 8.0,
        "linear": 1.15,
        "batch": 0.6,
        "batch_c": 1.7,
        "batch_linear": 1.25,
        "batch_8192": 2.0,
        "batch_10": 150.0,
        "processes": 0.7,
        "memory": 170.0,
        "quantities": 0.15,
        "propagate": 4.0,
        "speeds": 300.0,
        "solve": 5.0,
        "run_out": 5_000.0,
        "run_out_free": 10_000.0,
        "run_out_batch": 200.0,
        "scene": 12_000.0,
        "scene_batch": 200.0,
        "in_time": 2_500.0,
        "in_time_batch": 400.0,
        "engaged": 2.0,
        "engaged_batch": 2.0,
        "engaged_bare": 2.0,
        "engaged_bare_batch": 2.0,
        "required_in_time": 900.0,
        "report": 500_000.0,
        "report_uncertain": 800_000.0,
        "picture": 200_000.0,
        "intervals": 20_000.0,
        "new": 1.4,
        "texts": 2.2,
    }
    for row in committed[0]["budgets"]:
        assert row["held"] == (row["median"] <= row["budget"]), row


def car(**given):
    """The car of the curves."""
    return col.Vehicle(mass=1500.0, **given)


def test_errors_over_the_lever_are_those_of_the_solvers(committed):
    """One car off-centre, worked out here again; delta-V alone is half of (lever / radius of
    gyration) squared.
    """
    curve = next(curve for curve in committed[0]["errors"]["levers"] if curve["key"] == "one")
    gyration = math.sqrt(2400.0 / 1500.0)
    cheap = col.oblique_central(car(vx=15.0), car(), 0.1, normal=0.0, friction=0.0)
    for x, error, share, alone, predicted in zip(
        *(curve[name] for name in ("x", "error", "share", "delta_v_share", "predicted")),
        strict=True,
    ):
        a, b = (
            car(yaw_inertia=2400.0, **where)
            for where in ({"vx": 15.0, "x": -1.9, "y": 0.0}, {"x": 1.9, "y": x * gyration})
        )
        full = col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.0)
        off = math.hypot(full.b.delta_vx - cheap.b.delta_vx, gyration * full.b.delta_yaw_rate)
        assert error == pytest.approx(off, rel=THREE_DIGITS, abs=1e-12)
        assert share == pytest.approx(off / full.b.delta_v, rel=THREE_DIGITS, abs=1e-12)
        assert alone == pytest.approx(0.5 * x * x, rel=THREE_DIGITS, abs=1e-12)
        assert predicted == pytest.approx(error, rel=THREE_DIGITS, abs=1e-12)


def test_errors_over_the_angle_are_those_of_the_solvers(committed):
    """Ignored, the angle costs 1/cos - 1; friction left out costs what the friction impulse is of
    the whole.
    """
    curves = {curve["key"]: curve for curve in committed[0]["errors"]["angles"]}
    for angle, share in zip(curves["ignored"]["x"], curves["ignored"]["share"], strict=True):
        assert share == pytest.approx(
            1.0 / math.cos(math.radians(angle)) - 1.0, rel=THREE_DIGITS, abs=1e-12
        )
    for friction in (0.1, 0.5):
        curve = curves[f"linear_{friction}"]
        for angle, share, predicted, error in zip(
            *(curve[name] for name in ("x", "share", "predicted", "error")), strict=True
        ):
            a = car(vx=15.0, vy=15.0 * math.tan(math.radians(angle)))
            full = col.oblique_central(a, car(), 0.1, normal=0.0, friction=friction)
            assert share == pytest.approx(
                abs(full.b.delta_vy) / full.b.delta_v, rel=THREE_DIGITS, abs=1e-12
            )
            assert predicted == pytest.approx(error, rel=THREE_DIGITS, abs=1e-12)


def test_every_prediction_is_the_error_made(committed):
    """To the digits that are kept, on every curve that has one."""
    for group in ("levers", "angles"):
        for curve in committed[0]["errors"][group]:
            assert (curve["predicted"] is None) == (curve["key"] == "ignored")
            if curve["predicted"] is not None:
                assert curve["predicted"] == pytest.approx(
                    curve["error"], rel=THREE_DIGITS, abs=1e-12
                ), curve["key"]


def test_errors_of_the_choices_are_found_again(committed):
    """From the seeded scenes: to the digits that are kept; what is rounding, to a fifth, as another
    numpy may round otherwise.
    """
    speed_errors = benchmarks("speed_errors")
    found, contacts = committed
    again = speed_errors.choices(found["effort"]["scenes"], contacts, None)
    rounding = {"float64", "textbook", "float32"}
    for key, errors in found["errors"]["choices"].items():
        if key == "pymunk":
            continue
        assert errors.keys() == again[key].keys()
        for name, value in errors.items():
            assert value == pytest.approx(
                again[key][name], rel=0.2 if key in rounding else THREE_DIGITS
            ), (key, name)


def test_both_formulas_in_64_bits_are_measured_alike(committed):
    """Against 60 digits: in ordinary traffic each errs by about an eps of delta-V, and neither by
    nothing.
    """
    choices = committed[0]["errors"]["choices"]
    for key in ("float64", "textbook"):
        assert 2.0**-54 < choices[key]["mean"] < 2.0**-51


def test_the_other_law_is_compared_where_it_sticks(committed):
    """Restitution is 0 to 0.4, and both laws agree at 0 and where the contact slides: 0.5 percent
    over all, 0.9 over these.
    """
    law = committed[0]["errors"]["choices"]["law"]
    assert law["sticking"] == pytest.approx(0.58, abs=0.01)
    assert law["mean"] * law["sticking"] == pytest.approx(0.00515, rel=0.02)


def test_memory_of_a_batch_is_stated(tables, committed):
    """All work in blocks: a whole array of a million cases is 7.6 MiB, and left_out has some 120 of
    a block of 16384 cases.
    """
    taken = committed[0]["memory"]
    assert taken["eccentric"] < 8.0
    assert taken["solve"] < 8.0
    assert taken["left_out"] < 20.0
    assert max(taken["eccentric_threads"], taken["solve_threads"]) < 9.0
    assert "with two threads" in tables.memory(committed[0])
    assert "no more with more cases" in tables.memory(committed[0])


def test_errors_of_the_choices_are_what_the_page_says(committed):
    """solve keeps its tolerance and takes every model; float32 and the other formulas agree with
    eccentric.
    """
    choices = committed[0]["errors"]["choices"]
    solve = choices["solve"]
    assert solve["most"] <= solve["tolerance"]
    assert set(solve["chosen"]) == {"linear_central", "oblique_central", "eccentric"}
    assert choices["linear_central"]["mean"] > choices["oblique_central"]["mean"] > 0.1
    assert choices["float32"]["p95"] < 1e-6
    assert choices["textbook"]["p95"] < 1e-15
    assert choices["left_out"]["mean"] < 0.2 * choices["impulse"]["mean"]
    if choices["pymunk"] is not None:
        assert choices["pymunk"]["p95"] < 1e-3


def test_what_to_call_has_the_numbers_of_the_files(tables, committed):
    """Each row of the first table: its error is that of its rung, and what it costs is what was
    measured; every call in it takes the arguments that it is shown with.
    """
    ladder = tables.load_ladder()
    text = tables.calls(committed[0], ladder)
    lines = [line.strip("| ").split(" | ") for line in text.splitlines()[2:]]
    single, batch = (tables.rows(committed[0], group) for group in ("single", "batch"))
    assert len(lines) == len(tables.CALLS) + 2
    for line, row in zip(lines, tables.CALLS, strict=False):
        error = ladder["rungs"][row.rung]
        assert line[1].startswith(f"{100.0 * error['median']:.2g}\u00a0%")
        assert line[1].endswith(f"within {100.0 * error['most_of_10']:.2g}\u00a0%")
        each = (
            single["eccentric"]["median"] * tables.cost_of(ladder, row.rung)
            if row.batch is None
            else batch[row.batch]["median"]
        )
        seconds = float(re.sub(r"\D", "", line[2])) * each * tables.FORMULA
        assert seconds == pytest.approx(1.0, rel=0.5)
        assert line[3] == row.call
        for option in re.findall(r"(\w+)=", row.call):
            assert option in inspect.signature(col.time_resolved).parameters
