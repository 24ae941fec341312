"""What a report says of a posterior: the answer that was asked for, each reading beside what is
computed for it, and the rest folded.
"""

import re

import pytest

import collisions as col
from collisions import reconstruct
from collisions.reporting import options
from collisions.uncertainty import Interval, Normal, Uniform


def box(page):
    return page.split("\n## Answer\n")[1].split("\n## ")[0]


@pytest.fixture(scope="module")
def found():
    """A speed and a drag by two readings, and how far it got: v^2 / (2 g drag)."""
    one = reconstruct.posterior(
        lambda speed, drag: {"video": speed, "way": speed**2 / (2.0 * 9.80665 * drag)},
        {"speed": Uniform("5 mph", "60 mph"), "drag": Uniform(0.5, 0.9)},
        {"video": ("30 mph", "1 mph"), "way": ("70 ft", "5 ft")},
        samples=1024,
        seed=1,
    )
    return one.with_result("twice", lambda speed: 2.0 * speed, "m/s", speed=one["speed"])


def test_the_answer_is_what_was_worked_out_and_the_speeds(found):
    page = col.report(found, form="markdown")
    text = box(page)
    assert re.findall(r"\*\*(.+):\*\*", text) == ["twice", "speed"]
    assert page.index("Also found:") < page.index("| drag | 0.")
    folded = col.report(found, figures=False)
    assert "<details>\n<summary>Also found:</summary>" in folded


def test_the_answer_is_what_was_asked_for_in_that_order(found):
    page = col.report(found, form="markdown", answers=["drag", "way"])
    assert re.findall(r"\*\*(.+):\*\*", box(page)) == ["drag", "way"]
    assert options(page)["answers"] == ["drag", "way"]
    assert col.report(found, **options(page)) == page


def test_the_answer_of_an_impact_and_of_a_fit_can_be_asked_for_too():
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=20.0), col.Vehicle(mass=1500.0), 0.2)
    text = box(col.report(impact, form="markdown", units="us", answers=["b.delta_v"]))
    assert re.findall(r"\*\*(.+):\*\*", text) == ["B: delta-V"]
    fitted = reconstruct.fit(
        lambda x, y: {"x": x, "y": y},
        {"x": Interval(0.0, 9.0), "y": Interval(0.0, 9.0)},
        {"x": (3.0, 0.1), "y": (4.0, 0.1)},
    )
    text = box(col.report(fitted, form="markdown", answers=["y"]))
    assert re.findall(r"\*\*(.+):\*\*", text) == ["y"]


@pytest.mark.parametrize(
    ("answers", "said"),
    [
        ("drag", "answers must be a list of names"),
        ([], "answers must be a list of names"),
        (
            ["speeed"],
            "answers has 'speeed', which nothing on this page is called; near it are speed",
        ),
    ],
)
def test_an_answer_that_nothing_is_called_is_refused(found, answers, said):
    with pytest.raises(col.InputError, match=re.escape(said)):
        col.report(found, answers=answers)


def test_each_reading_stands_in_one_row_with_what_is_computed(found):
    page = col.report(found, form="markdown", figures=False)
    assert "| of | reading | stated error | computed | off by |" in page
    (row,) = re.findall(r"^\| video \| (.*) \|$", page, re.MULTILINE)
    reading, error, computed, off = row.split(" | ")
    assert (reading, error) == ("30 mph", "1 mph")
    number, in_errors = re.fullmatch(r"([-+][\d.]+) mph \((-?[\d.]+)\)", off).groups()
    assert float(in_errors) == pytest.approx(found.residuals["video"].over_sigma, abs=0.006)
    assert 30.0 - float(computed.split(" ")[0]) == pytest.approx(float(number), abs=0.06)


def test_where_a_reading_and_a_prior_are_from_stands_beside_them(found):
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=20.0), col.Vehicle(mass=1500.0), 0.2)
    notes = ["A word.", {"video": "Camera at the bank", "drag": "Skid tests"}]
    for results in (found, [found, impact]):
        page = col.report(results, form="markdown", notes=notes)
        assert "computed | off by | where it is from |" in page
        (row,) = re.findall(r"^\| video \| (.*) \|$", page, re.MULTILINE)
        assert row.endswith("| Camera at the bank")
        assert re.search(r"\| drag \| [^|]*equally likely. Skid tests \|", page)
    fitted = reconstruct.fit(
        lambda x: {"x": x}, {"x": Interval("0 m/s", "9 m/s")}, {"x": Normal("3 m/s", "1 m/s")}
    )
    page = col.report(fitted, form="markdown", notes={"x": "Camera"})
    assert "| x | observed | 3 m/s ± 1 m/s. Camera |" in page


def test_a_note_beside_nothing_is_refused_with_what_it_can_stand_beside(found):
    with pytest.raises(col.InputError, match=r"they are video, way, speed, drag$"):
        col.report(found, notes={"vide": "Camera"})
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=20.0), col.Vehicle(mass=1500.0), 0.2)
    with pytest.raises(col.InputError, match="texts alone, but for those of the readings"):
        col.report([impact, impact], notes={"a.mass": "Weighed"})
