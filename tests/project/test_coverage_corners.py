"""Corners that no other test comes to: each is a refusal, a display or a rare kind of batch that a
user can meet.
"""

import copy
import json
import math
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

import collisions as col
from collisions.impact.records import _count
from collisions.uncertainty import Normal, propagate

A = {"mass": 1500.0, "yaw_inertia": 2400.0, "vx": 13.9, "x": -2.0, "y": 0.4}
B = {"mass": 1200.0, "yaw_inertia": 1700.0, "vy": 11.1, "x": 0.8, "y": -1.2}
CONTACT = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5}


def crash(**changes):
    rules = {
        name: changes.pop(name)
        for name in ("impulse_ratio", "critical_fraction")
        if name in changes
    }
    return col.eccentric(col.Vehicle(**{**A, **changes}), col.Vehicle(**B), 0.1, **CONTACT, **rules)


@pytest.mark.parametrize("count", [3, 20_000])
def test_a_case_beyond_float32_has_no_answer_at_all(count):
    """The square of 1e18 m/s times a mass is more than 3e38 J, all that float32 holds; the
    neighbours are untouched.
    """
    speeds = np.full(count, 10.0, np.float32)
    speeds[1] = 1e18
    options = {"on_failure": "nan", "normal": 0.0}
    found = col.linear_central(
        col.Vehicle(mass=1500.0, vx=speeds), col.Vehicle(mass=1200.0), 0.1, **options
    )
    assert [col.Status(int(code)).label for code in found.status[:3]] == [
        "ok",
        "out_of_range",
        "ok",
    ]
    for name in ("energy_loss", "compression_impulse", "effective_mass", "energy_loss_normal"):
        values = getattr(found, name)
        assert np.isnan(values[1]), name
        assert np.isfinite(np.delete(values, 1)).all(), name
    # Two products and two changes of velocity, each rounded to float32.
    assert found.a.delta_vx[0] * 1500.0 == pytest.approx(
        -found.b.delta_vx[0] * 1200.0, rel=4 * 2.0**-23
    )


def test_the_first_case_beyond_float32_is_named():
    """Alone it would be worked out in float64 and be answered; the batch says which case it was and
    why.
    """
    speeds = np.array([10.0, 1e18, 20.0], np.float32)
    with pytest.raises(col.InputError, match=r"^case 1: ") as caught:
        col.linear_central(
            col.Vehicle(mass=1500.0, vx=speeds),
            col.Vehicle(mass=1200.0),
            0.1,
            normal=0.0,
            on_failure="raise",
        )
    assert caught.value.code == "out_of_range"


@pytest.mark.parametrize("speed", [20.0, np.array([10.0, 20.0])], ids=["one case", "a batch"])
def test_a_pivot_needs_the_whole_model(speed):
    """No central model holds one, so every case is eccentric, whatever the tolerance."""
    post = col.Vehicle(mass=1000.0, yaw_inertia=1333.0, x=0.0, y=2.0, pivot=(0.0, 0.0))
    car = col.Vehicle(mass=900.0, vx=speed, yaw_inertia=math.inf, x=-1.0, y=4.0)
    scene = {"normal": 0.0, "point": (0.0, 4.0), "friction": 0.0}
    solved = col.solve(car, post, 0.8, tolerance=100.0, **scene)
    assert np.all(np.equal(solved.model, "eccentric"))
    # Example 3 of the paper has 60 km/h and b = 1333.3: the yaw rate is in proportion to the speed.
    np.testing.assert_allclose(
        solved.b.after.yaw_rate, -405.0 / 74.0 * speed / (50.0 / 3.0), rtol=1e-3
    )


@pytest.mark.slow
def test_a_record_of_solve_is_read_before_solve_was_ever_used():
    """In a fresh interpreter, where the record is all there is."""
    inputs = {**CONTACT, "tolerance": 1.0}
    record = json.dumps(col.solve(col.Vehicle(**A), col.Vehicle(**B), 0.1, **inputs).to_dict())
    code = (
        f"import sys, json; sys.path.insert(0, {str(Path(col.__file__).parents[1])!r}); import "
        "collisions;print(repr(collisions.Impact.from_dict(json.load(sys.stdin)).a.delta_v))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        input=record,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=True,
    )
    assert (
        float(done.stdout) == col.solve(col.Vehicle(**A), col.Vehicle(**B), 0.1, **inputs).a.delta_v
    )


def test_an_impact_equals_nothing_else():
    assert crash() == crash()
    assert crash() != "an impact"
    assert crash() != crash(vx=14.0)


def test_quantities_of_a_result_say_whose_they_are():
    """They can be copied, which looks for special names they do not have."""
    impact = crash()
    assert repr(impact.q) == f"<Quantities of {impact!r}>"
    assert copy.copy(impact.q).closing_speed == impact.q.closing_speed


def test_errors_of_models_are_shown_as_a_dict():
    choice = col.required_model(col.Vehicle(**A), col.Vehicle(**B), 0.1, tolerance=1.0, **CONTACT)
    assert repr(choice.errors) == repr(dict(choice.errors))
    assert set(choice.errors) == {"linear_central", "oblique_central"}


def test_an_angle_that_is_not_finite_is_refused_in_degrees_too():
    with pytest.raises(col.InputError) as caught:
        col.eccentric(col.Vehicle(**A), col.Vehicle(**B), 0.1, **{**CONTACT, "normal": "inf deg"})
    assert caught.value.code == "not_finite"


def test_a_report_says_that_cases_had_no_answer():
    """A speed that may be backwards does not close in some cases."""
    inputs = {"vx": Normal(1.0, 1.0)}

    def model(vx):
        wall = col.linear_central(
            col.Vehicle(mass=1500.0, vx=vx), col.Vehicle.barrier(), 0.1, on_failure="nan"
        )
        return {"a.delta_v": wall.a.delta_v}

    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", col.CollisionsWarning
        )  # that cases failed is warned of, and asserted here
        found = propagate(model, inputs, method="monte_carlo", samples=640, seed=1)
    assert found.failed > 0
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=1.0), col.Vehicle.barrier(), 0.1)
    page = col.report(impact, uncertainty=found, form="markdown")
    assert f"{found.failed} without an answer" in page
    assert "had no answer and are left out: the figures hold only where there is one." in page


@pytest.mark.parametrize("share", ["half", None, object(), [0.5, 2.0], 1.5, -0.1, math.nan, True])
def test_a_quantile_is_of_a_probability(share):
    """Between 0 and 1; texts, objects and truths are none."""
    found = propagate(
        lambda x: {"y": 2.0 * x}, {"x": Normal(1.0, 0.1)}, method="quasi_random", samples=64, seed=1
    )["y"]
    with pytest.raises(col.InputError):
        found.quantile(share)


def test_second_order_terms_too_large_for_a_float():
    """They are refused and not infinite."""
    with pytest.raises(col.NoSolutionError) as caught:
        propagate(
            lambda x: {"y": 1e300 * x * x},
            {"x": Normal(1.0, 1e5, truncate=None)},
            method="second_order",
        )
    assert caught.value.code == "out_of_range"


def speed_in(unit):
    """An output of 10 m/s in another unit."""
    return (
        propagate(
            lambda v: {"v": col.Vehicle(mass=1.0, vx=v).q.vx}, {"v": Normal("10 m/s", "1 m/s")}
        )["v"]
        .to(unit)
        .mean
    )


LONG = 10**5000  # Python writes no int of more than 4,300 digits


@pytest.mark.parametrize("name", [LONG, ["x"], np.array([1.0, 2.0])], ids=["long", "list", "array"])
def test_what_is_no_name_is_refused_by_results_that_are_read_by_name(name):
    def model(x):
        return {"s": 2.0 * x}

    known = {"x": Normal(5.0, 1.0)}
    for found, code in (
        (propagate(model, known, method="monte_carlo", samples=64, seed=1), "no_output"),
        (col.reconstruct.fit(model, known, {"s": (9.0, 1.0)}), "unknown_name"),
        (
            col.reconstruct.posterior(model, known, {"s": (9.0, 1.0)}, samples=512, seed=1),
            "unknown_name",
        ),
    ):
        with pytest.raises(col.InputError) as caught:
            found[name]
        assert caught.value.code == code


@pytest.mark.parametrize(
    ("call", "code"),
    [
        (
            lambda: propagate(
                lambda x: {"s": x}, {"x": Normal(1, 1)}, correlation={(LONG, "x"): 0.5}
            ),
            "bad_correlation",
        ),
        (
            lambda: propagate(lambda x: {"s": x}, {"x": Normal(1, 1)}, tolerance={LONG: 0.5}),
            "bad_tolerance",
        ),
        (lambda: speed_in(LONG), "bad_units"),
        (lambda: speed_in([LONG]), "bad_units"),
        (lambda: speed_in(3.6), "bad_units"),
        (lambda: speed_in("3.6 km/h"), "bad_units"),
        (lambda: speed_in(""), "bad_units"),
        (lambda: speed_in("nan m/s"), "bad_units"),
        (lambda: speed_in("0 m/s"), "bad_units"),
        (lambda: crash(impulse_ratio=np.array([0.1, 0.2])), "one_tangential"),
        (lambda: crash(critical_fraction=np.array([])), "one_tangential"),
        (lambda: crash().again(law=np.array(["brach", "stronge"])), "bad_law"),
        (lambda: crash().again(law=""), "bad_law"),
        (lambda: col.diagnose(crash(), limits={LONG: 1.0}), "unknown_finding"),
        (lambda: crash().to_columns(columns=[LONG]), "unknown_name"),
        (lambda: crash().to_columns(columns=np.array("x")), "unknown_name"),
        (
            lambda: col.reconstruct.recorded_pulse(
                [0.0, 0.1, 0.2], [0.0, 1.0, 1.0], polarity="ISO 8855"
            ).inputs(np.zeros(2)),
            "bad_option",
        ),
    ],
)
def test_a_key_that_is_no_name_is_refused_in_words(call, code):
    with pytest.raises(col.InputError) as caught:
        call()
    assert caught.value.code == code


@pytest.mark.parametrize("text", ["1_0", "\u0661", "2.5", True, None])
def test_a_number_of_a_record_is_no_text_of_one(text):
    """numpy reads "1_0" as 10, True as 1 and None as NaN; ``to_dict`` does not write numbers so."""
    record = crash(mass=np.array([1500.0, 1600.0])).to_dict()
    record["inputs"]["a"]["mass"]["values"][1] = text
    with pytest.raises(col.InputError, match="in an array is no number"):
        col.Impact.from_dict(record)


@pytest.mark.parametrize("count", ["1_0", "2", 2.5, True])
def test_a_count_of_a_record_is_a_whole_number(count):
    for one in (count, {"dtype": "int64", "shape": [1], "values": [count]}):
        with pytest.raises(col.InputError, match="is no whole number"):
            _count(one)
