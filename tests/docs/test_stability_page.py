"""The page "Numerical stability" says what is so: its numbers are those of its script, and they
keep the promises.
"""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from scripts import benchmarks

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs" / "numerical_stability.md"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (ROOT / "benchmarks").is_dir(), reason="the sdist has no benchmarks"),
]


@pytest.fixture(scope="module")
def scripts():
    """The script and its tables."""
    return benchmarks("stability", "stability_tables")


@pytest.fixture(scope="module")
def found():
    """The committed numbers."""
    return json.loads((ROOT / "docs" / "_generated" / "stability.json").read_text(encoding="utf-8"))


def compared(found, regime):
    """What the file says of a regime."""
    return next(entry for entry in found["regimes"] if entry["key"] == regime)["compared"]


def test_every_committed_error_keeps_its_promise(found):
    """No regime has an error of the library beyond its promise, and every promise was measured."""
    promised = {row["key"]: row["eps"] for row in found["promises"]}
    for row in found["promises"]:
        assert 0.0 < row["seen"] <= row["eps"], row
    for regime in found["regimes"]:
        for key, worst in regime["promised"].items():
            assert worst <= promised["P" if key == "stick" else key], (regime["key"], key)


def test_what_came_after_the_first_laws_keeps_the_promises(scripts, found):
    """Energetic restitution, incomplete impacts and impulses from outside those of the first laws;
    contacts in steps their own.
    """
    stability, _ = scripts
    promised = {row["key"]: row["eps"] for row in found["promises"]}
    assert [row["name"] for row in found["later"]] == list(stability.LATER)
    for row in found["later"]:
        assert row["cases"] >= 500
        assert {"closing", "P", "v", "loss", "pivot"} <= row["seen"].keys()
        for key, worst in row["seen"].items():
            assert worst <= promised[key], (row["name"], key)
    assert [row["family"] for row in found["in_time"]["rows"]] == list(stability.in_time.FAMILIES)
    for row in found["in_time"]["rows"]:
        assert row["seen"].keys() == found["in_time"]["promises"].keys()
        for name, worst in row["seen"].items():
            assert 0.0 < worst <= found["in_time"]["promises"][name], row


def test_the_file_has_the_regimes_and_promises_of_the_script(scripts, found):
    """Nothing was added to or left out of the script since the file was written."""
    stability, _ = scripts
    assert [entry["key"] for entry in found["regimes"]] == [
        regime.key for regime in stability.REGIMES
    ]
    assert [(row["output"], row["eps"], row["scale"]) for row in found["promises"]] == [
        (promise.output, promise.eps, promise.scale) for promise in stability.PROMISES
    ]


def test_the_errors_of_steps_measured_again_are_the_committed_ones(scripts, monkeypatch):
    """To the two digits that are kept, where they are the same cases; of a tenth of them the
    median, which varies little.

    The table of the page is made from them: the worst is over all cases, and twice the steps have a
    quarter of the error.
    """
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import steps

    found = scripts[1].load_steps()
    committed = {row["key"]: row for row in found["rows"]}
    assert (found["steps"], found["start"]) == (list(steps.STEPS), steps._NEAR)
    for key, again in (("barrier", steps.barrier()), ("sliding", steps.sliding("first_contact"))):
        assert committed[key]["cases"] == len(again)
        assert committed[key]["worst"] == pytest.approx(np.max(again, axis=0), rel=0.06)
        assert committed[key]["median"] == pytest.approx(np.median(again, axis=0), rel=0.06)
    assert committed["fixed"]["cases"] == steps.COUNT
    monkeypatch.setattr(steps, "COUNT", steps.COUNT // 10)
    again = steps.fixed()
    assert committed["fixed"]["median"] == pytest.approx(np.median(again, axis=0), rel=0.06)
    assert np.all(np.max(again, axis=0) < 1.06 * np.array(committed["fixed"]["worst"]))
    for key in ("barrier", "fixed", "sliding"):
        assert committed[key]["median"][0] == pytest.approx(
            4.0 * committed[key]["median"][1], rel=0.06
        )
    text = scripts[1].of_steps(found)
    assert all(scripts[1].number(row["worst"][0]) in text for row in found["rows"])


@pytest.mark.parametrize("regime", ["traffic", "slow"])
def test_a_regime_measured_again_gives_the_committed_figures(scripts, found, regime):
    """Two regimes again: the same figures but for the last digits, which another platform may round
    otherwise.
    """
    stability, _ = scripts
    again = stability.regime(next(which for which in stability.REGIMES if which.key == regime))
    was = next(entry for entry in found["regimes"] if entry["key"] == regime)
    assert again["cases"] == was["cases"]
    assert again["compared"].keys() == was["compared"].keys()
    for key, entry in again["compared"].items():
        for who in ("library", "textbook"):
            assert entry[who] == pytest.approx(was["compared"][key][who], rel=0.5, abs=0.5), (
                key,
                who,
            )


@pytest.mark.parametrize(
    ("regime", "output", "times"),
    [
        ("traffic", "loss", 10),
        ("traffic", "delta-V", 5),
        ("masses", "delta-V", 1e10),
        ("slow", "loss", 1e15),
        ("slow", "closing", 1e8),
        ("fast", "closing", 1e10),
        ("levers", "stick", 1e8),
        ("inertia", "stick", 1e6),
        ("grid", "P", 1e4),
        ("percussion", "loss", 5),
    ],
)
def test_the_textbook_form_is_worse_where_the_page_says_so(found, regime, output, times):
    """By at least so many times."""
    entry = compared(found, regime)[output]
    assert entry["textbook"] > times * entry["library"]


def test_a_barrier_has_no_textbook_energy(found):
    """Equation 7 gives no number for an infinite mass; the closing speed and the
    impulse are fine.
    """
    entries = compared(found, "barrier")
    assert entries["loss"]["textbook"] is None
    for key in ("closing", "P", "w"):
        assert entries[key]["textbook_no_answer"] == 0.0
        assert entries[key]["textbook"] < 8.0


def test_errors_of_ill_conditioned_impacts_are_those_of_their_data(found):
    """The library is off by what one eps in the data does to the exact answer; by more where a
    contact is almost singular.
    """
    for condition in found["conditions"]:
        for row in condition["rows"]:
            assert row["library"] <= row["promise"], row
            assert row["library_over_one_eps"] < (
                100.0 if condition["key"] == "kappa_s" and row["kappa"] > 1e11 else 2.0
            ), row


def test_float32_keeps_the_same_number_of_its_own_eps(found):
    """In traffic; the same eps of the same scales, and four digits in the worst case."""
    assert found["float32"]["eps"] == pytest.approx(2.0**-23, rel=0.05)
    for row in found["float32"]["outputs"]:
        assert row["worst_in_eps"] <= 8.0, row
        assert row["worst_relative"] < 1e-4, row


def test_the_page_shows_every_table_and_names_every_promise(scripts, found):
    """The table of promises has a row for each, and the page shows it and all the others."""
    stability, tables = scripts
    page = PAGE.read_text(encoding="utf-8")
    table = tables.promises(found)
    for promise in stability.PROMISES:
        assert f"| {promise.output} | {promise.eps} |" in table
    shown = "\n".join(re.findall(r"```{code-cell}.*?```", page, flags=re.S))
    assert "tables.promises(found)" in shown
    for key in stability.COMPARED:
        assert f'"{key}"' in shown, key
    for condition in found["conditions"]:
        assert f'tables.conditions(found, "{condition["key"]}")' in shown
    for name in ("relative", "grid", "float32"):
        assert f"tables.{name}(found)" in shown
    assert "(docs/_generated" not in page
    assert "stability_forms.svg" in page


def test_every_promise_is_one_the_tests_assert(scripts):
    """All that test_reference.py measures of the planar solvers is a row of the page, with the same
    number of eps.
    """
    stability, _ = scripts
    scene, answer = stability.known("A pinned", "brach", "friction")[0]
    free, answer_free = stability.known("traffic", "brach", "friction")[0]
    names = set()
    for case, known in ((scene, answer), (free, answer_free)):
        outputs = stability.asserted._outputs(stability.solved("eccentric", case))
        for measure in stability.asserted.PROMISES:
            names |= {
                name.removeprefix("a.").removeprefix("b.")
                for name, _, _ in measure(case, known, outputs)
            }
        for entry in stability.measured(case, known, outputs):
            assert entry.key in {promise.key for promise in stability.PROMISES}
    # The separation speed is the closing speed times e and one more rounding: it has no row of its
    # own.
    assert names - {"separation_speed"} == set(stability.OF_NAME)
    closing = next(
        bound
        for name, _, bound in stability.asserted.closing_and_slip(free, answer_free, outputs)
        if name == "closing_speed"
    )
    assert math.isclose(closing, 4 * stability.EPS * float(answer_free.s_u))
