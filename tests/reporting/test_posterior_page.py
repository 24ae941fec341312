"""What a report says of a posterior: the answer that was asked for, each reading beside what is
computed for it, and the rest folded.
"""

import re

import numpy as np
import pytest

import collisions as col
from collisions import plot, reconstruct
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


@pytest.mark.slow
def test_the_answer_is_what_was_worked_out_and_the_speeds(found):
    page = col.report(found, form="markdown")
    text = box(page)
    assert re.findall(r"\*\*(.+):\*\*", text) == ["twice", "speed"]
    assert page.index("Also found:") < page.index("| drag | 0.")
    folded = col.report(found, figures=False)
    assert "<details>\n<summary>Also found:</summary>" in folded


@pytest.mark.slow
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


@pytest.mark.slow
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


def test_a_pole_has_no_delta_v_and_what_does_not_turn_no_change_of_yaw_rate():
    car = col.Vehicle(
        mass=1500.0, yaw_inertia=2500.0, vx=13.0, x=-2.2, y=0.3, heading=0.0, name="Seat"
    )
    pole = col.Vehicle(mass=np.inf, yaw_inertia=np.inf, x=0.0, y=0.0, heading=0.0, name="pole")
    impact = col.eccentric(car, pole, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5)
    page = col.report(impact, form="markdown")
    rows = [line for line in page.splitlines() if line.startswith("| B (pole) | ")]
    assert rows
    assert not [row for row in rows if "delta-V" in row or "PDOF" in row or "change of" in row]
    assert "| A (Seat) | change of yaw rate | " in page


def test_a_gain_of_next_to_nothing_is_not_told_as_one():
    """Past the middle of a pole by 15 cm: what slips is turned round, by a thousandth of all."""
    car = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, vx=13.0, vy=0.2, x=-2.2, y=0.15, heading=0.0)
    pole = col.Vehicle(mass=np.inf, yaw_inertia=np.inf, x=0.0, y=0.0)
    impact = col.eccentric(car, pole, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5)
    assert -1e-3 < impact.energy_loss_tangential / car.kinetic_energy < 0.0
    texts = [text.get_text() for text in plot.energy(impact).texts]
    assert "less than 0.1 %" in texts
    assert not [text for text in texts if "gained" in text]


@pytest.mark.slow
def test_a_reading_has_the_unit_that_it_was_given_in_and_figures_the_digits_of_the_table(found):
    turned = reconstruct.posterior(
        lambda angle: {"angle": angle},
        {"angle": Uniform("150 deg", "190 deg")},
        {"angle": ("175 deg", "5 deg")},
        samples=512,
        seed=1,
    )
    page = col.report(turned, form="markdown", figures=False)
    assert re.search(r"^\| angle \| 175 ?° \| 5 ?° \| ", page, re.MULTILINE), page
    drag = found["drag"]
    (row,) = re.findall(r"^\| drag \| ([\d.]+) ± ", col.report(found, form="markdown"), re.M)
    (legend,) = plot.distribution(drag).figure.legends or [plot.distribution(drag).get_legend()]
    assert f"mean {row}" in [text.get_text() for text in legend.get_texts()]
