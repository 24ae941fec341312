"""if_halved: against the law of propagation for a sum, runs with inputs stated anew, and bounds."""

import json
import math
import pickle
import warnings

import numpy as np
import pytest

import collisions as col
from collisions import reference
from collisions.uncertainty import (
    Halved,
    Interval,
    LogNormal,
    Normal,
    OneSided,
    Samples,
    Triangular,
    Uniform,
    propagate,
)

Z = 1.9599639845400545
SD = {"x": 0.4, "y": 0.3, "z": 1.2}
FACTOR = {"x": 1.0, "y": -2.0, "z": 0.5}
INPUTS = {name: Normal(3.0, sd) for name, sd in SD.items()}


def total(x, y, z):
    return {"sum": x - 2.0 * y + 0.5 * z, "first": x}


def width(**sd):
    return 2.0 * Z * math.sqrt(sum((FACTOR[name] * one) ** 2 for name, one in (SD | sd).items()))


@pytest.mark.parametrize("method", ["first_order", "second_order", "quasi_random"])
def test_of_a_sum_of_normals_by_the_law_of_propagation(method):
    propagated = propagate(total, INPUTS, method=method, seed=1)
    found = propagated.if_halved()
    tolerance = 1e-9
    if method == "quasi_random":
        # The stated standard errors of both ends, 6.5 times.
        ends = [
            [one.quantile_standard_error([0.025, 0.975]), one.interval()]
            for one in propagated.outputs.values()
        ]
        tolerance = 6.5 * max(math.hypot(*errors) / (high - low) for errors, (low, high) in ends)
        assert tolerance < 0.05
    assert found.now["sum"] == pytest.approx(width(), rel=tolerance)
    for name, sd in SD.items():
        halved = width(**{name: 0.5 * sd})
        assert found[name]["sum"] == pytest.approx(halved, rel=tolerance), name
    assert list(found) == ["x", "y", "z"]  # of "first", x leaves half; then by what is left
    assert found["x"]["first"] == pytest.approx(Z * 0.4, rel=tolerance)
    # An input without effect leaves the very same samples.
    assert found["y"]["first"] == found.now["first"]
    assert len(found) == 3
    assert found.coverage == 0.95


@pytest.mark.parametrize(
    ("stated", "again"),
    [
        (Normal(3.0, 0.4), Normal(3.0, 0.2)),
        (Uniform(1.0, 5.0), Uniform(2.0, 4.0)),
        (Samples([1.0, 2.0, 6.0]), Samples([2.0, 2.5, 4.5])),
        (Triangular(0.0, 1.0, 5.0), Triangular(1.0, 1.5, 3.5)),
    ],
)
def test_as_if_it_had_been_stated_with_half_the_error(stated, again):
    """The same draws of the inputs stated by hand, in a model that bends."""

    def model(x, y):
        return {"out": x**2 / (1.0 + y**2)}

    options = {"method": "quasi_random", "samples": 512, "seed": 3}
    found = propagate(model, {"x": stated, "y": Normal(1.0, 0.1)}, **options).if_halved()
    low, high = propagate(model, {"x": again, "y": Normal(1.0, 0.1)}, **options)["out"].interval()
    assert found["x"]["out"] == pytest.approx(high - low, rel=1e-12)
    assert found.samples == 512


def test_a_skew_input_keeps_its_mean():
    stated = LogNormal.between(1.0, 8.0, 0.9)
    found = propagate(lambda x: {"x": x}, {"x": stated}, seed=1).if_halved()
    assert found["x"]["x"] == pytest.approx(0.5 * found.now["x"], rel=1e-12)


def test_correlated_inputs_and_joint_samples_stay_together():
    """Both masses by one scale: the sum has the sum of the deviations. Joint samples keep their
    rows.
    """
    masses = {"a": Normal(1500.0, 30.0), "b": Normal(1200.0, 20.0)}
    found = propagate(
        lambda a, b: {"sum": a + b},
        masses,
        method="first_order",
        correlation={("a", "b"): 1.0},
    ).if_halved()
    assert found.now["sum"] == pytest.approx(2.0 * Z * 50.0)
    assert found["a"]["sum"] == pytest.approx(2.0 * Z * 35.0)
    assert found["b"]["sum"] == pytest.approx(2.0 * Z * 40.0)
    values = np.linspace(0.0, 1.0, 101)
    joint = Samples.joint(p=values, q=-values)
    found = propagate(lambda p, q: {"sum": p + q}, joint, seed=1).if_halved()
    assert found.now["sum"] == 0.0
    assert found["p"]["sum"] == pytest.approx(0.5 * 0.95, abs=0.02)


@pytest.mark.slow
def test_bounds_move_halfway_to_their_middle():
    inputs = {"x": Interval(1.0, 3.0), "y": Interval(0.0, 4.0)}
    found = propagate(lambda x, y: {"sum": x + y}, inputs).if_halved()
    assert found.now == {"sum": pytest.approx(6.0)}
    assert {name: row["sum"] for name, row in found.widths.items()} == {
        "y": pytest.approx(4.0),
        "x": pytest.approx(5.0),
    }
    assert found.coverage is None
    assert "whole range" in str(found)
    mixed = propagate(
        lambda x, y: {"sum": x + y},
        {"x": Interval(1.0, 3.0), "y": Normal(0.0, 0.5)},
        samples=512,
        seed=1,
    ).if_halved()
    assert mixed["x"]["sum"] == pytest.approx(mixed.now["sum"] - 1.0, abs=1e-6)
    assert mixed.samples == 512


def test_it_shows_itself_in_the_units_of_the_inputs():
    def rear_end(speed, mass):
        a, b = col.Vehicle(mass=mass, vx=speed), col.Vehicle(mass="3000 lb")
        return {"delta_v": col.linear_central(a, b, 0.1).b.q.delta_v, "ratio": mass / 1500.0}

    inputs = {"speed": Normal("30 mph", "2 mph"), "mass": Normal("3400 lb", "100 lb"), "k": 1.0}
    inputs.pop("k")
    propagated = propagate(rear_end, inputs, method="first_order")
    found = propagated.if_halved()
    assert isinstance(found, Halved)
    assert propagated.if_halved() is found
    text = str(found)
    assert "mph (" in text
    assert "95% range" in text
    assert "-50 %" in text
    assert "same" in text
    assert "now" in found._repr_html_()
    assert found.q["speed"]["delta_v"].to("mph").magnitude == pytest.approx(
        found["speed"]["delta_v"] / 0.44704
    )
    assert found.q["speed"]["ratio"] == found["speed"]["ratio"]
    record = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert record["now"]["delta_v"] == found.now["delta_v"]
    assert record["units"] == {"delta_v": "m/s", "ratio": None}
    with pytest.raises(col.InputError, match="'drag' is none of the uncertain inputs") as caught:
        found["drag"]
    assert caught.value.code == "unknown_name"


def twice(x):
    return {"twice": 2.0 * x}


def test_a_pickle_keeps_the_answer_but_not_the_model():
    found = propagate(twice, {"x": Normal(1.0, 0.1)}, method="first_order")
    with pytest.raises(col.InputError, match="before it is pickled") as caught:
        pickle.loads(pickle.dumps(found)).if_halved()
    assert caught.value.code == "no_model"
    widths = found.if_halved()
    kept = pickle.loads(pickle.dumps(found)).if_halved()
    assert kept.to_dict() == widths.to_dict()


def test_large_runs_are_cut_to_what_ranks_them():
    found = propagate(twice, {"x": Normal(1.0, 0.1)}, samples=20000, seed=1)
    widths = found.if_halved()
    assert widths.samples == 8192
    assert widths["x"]["twice"] == pytest.approx(0.5 * widths.now["twice"], rel=1e-12)
    assert widths.now["twice"] == pytest.approx(2.0 * Z * 0.2, rel=5e-3)


def test_an_output_that_does_not_vary_has_no_change():
    found = propagate(lambda x: {"one": 0.0 * x + 1.0}, {"x": Normal(1.0, 0.1)}, seed=1)
    assert "no change known" in str(found.if_halved())


def test_warnings_are_given_once():
    """Those of the runs with half an error are those of the propagation, which said them."""

    def model(x):
        return {"root": np.sqrt(x)}

    with pytest.warns(col.OutOfRangeWarning, match="had no answer"):
        found = propagate(model, {"x": Normal(1.0, 1.0)}, samples=512, seed=1)
    assert found.if_halved()["x"]["root"] < found.if_halved().now["root"]


def test_the_input_that_narrows_some_range_the_most_comes_first():
    """By the best share of any output, whatever the names: z halves the range of one output, a
    narrows both by less. Of normal x and y the width of x + y follows by squares.
    """
    inputs = {"a": Normal(0.0, 1.0), "z": Normal(0.0, 2.0), "m": Normal(0.0, 1.0)}

    def model(a, z, m):
        return {"one": a + 2.0 * m, "other": 0.5 * a + 0.5 * m + z}

    halved = propagate(model, inputs, method="first_order").if_halved()
    # Shares that are left: of "one" m sqrt(1 + 1) / sqrt(5), a sqrt(1/4 + 4) / sqrt(5); of "other"
    # z sqrt(0.5 + 1) / sqrt(4.5).
    assert list(halved) == ["z", "m", "a"]
    left = [min(halved[name][of] / halved.now[of] for of in halved.now) for name in halved]
    assert left == pytest.approx([math.sqrt(1.5 / 4.5), math.sqrt(2 / 5), math.sqrt(4.25 / 5)])


def test_cases_without_an_answer_are_counted_in_every_row():
    """A car that runs into one ahead at 5 m/s catches up only where it is faster."""
    ahead = col.Vehicle(mass=1200.0, vx=5.0)

    def model(v, e):
        impact = col.linear_central(
            col.Vehicle(mass=1500.0, vx=v), ahead, restitution=e, on_failure="nan"
        )
        return {"delta_v": impact.b.delta_v}

    with pytest.warns(col.CollisionsWarning):
        propagated = propagate(model, {"v": Normal(4.0, 2.0), "e": Uniform(0.0, 0.3)}, seed=1)
    found = propagated.if_halved()
    slower = {sd: 0.5 * math.erfc(-1.0 / sd / math.sqrt(2.0)) for sd in (1.0, 2.0)}
    assert found.without_answer_now == pytest.approx(slower[2.0], abs=2e-3)
    shares = {"e": slower[2.0], "v": slower[1.0]}
    assert found.without_answer == pytest.approx(shares, abs=2e-3)
    assert list(found.without_answer) == [*found]
    assert "Cases without an answer, which the widths leave out: now 69.1%" in str(found.summary())
    assert found.to_dict()["without_answer"] == found.without_answer
    whole = propagate(total, INPUTS, seed=1).if_halved()
    assert "without an answer" not in str(whole.summary())


@pytest.mark.slow
@pytest.mark.parametrize("method", ["first_order", "second_order", "quasi_random"])
def test_the_share_without_an_answer_is_of_the_cases_drawn(method):
    """Not of those for derivatives too, of which twenty inputs take hundreds; exact by the normal
    distribution.
    """

    def model(**values):
        return {"sum": np.where(values["x0"] > -1.0, sum(values.values()), np.nan)}

    inputs = {f"x{number}": Normal(0.0, 1.0) for number in range(20)}
    with pytest.warns(col.OutOfRangeWarning):
        found = propagate(model, inputs, method=method, seed=1).if_halved()
    below = {sd: 0.5 * math.erfc(1.0 / sd / math.sqrt(2.0)) for sd in (1.0, 0.5)}
    assert found.without_answer_now == pytest.approx(below[1.0], abs=1e-3)
    assert found.without_answer["x1"] == found.without_answer_now
    assert found.without_answer["x0"] == pytest.approx(below[0.5], abs=1e-3)


def test_a_seldom_case_without_an_answer_is_not_rounded_away():
    def model(x):
        return {"x": np.where(x > -3.3, x, np.nan)}

    with pytest.warns(col.OutOfRangeWarning):
        halved = propagate(model, {"x": Normal(0.0, 1.0)}, seed=1).if_halved()
    assert 0.0 < halved.without_answer_now < 5e-4
    assert f"now {100.0 * halved.without_answer_now:.3g}%, x 0%" in str(halved.summary())


def test_what_is_warned_of_one_row_alone_stands_with_the_table():
    """Tangents describe ``a + 0.35 |b|`` well enough for the error of ``a``, not for half of it."""
    inputs = {"a": Normal(0.0, 1.0), "b": Normal(0.3, 0.5)}
    found = propagate(lambda a, b: {"y": a + 0.35 * abs(b)}, inputs, method="first_order")
    assert found.statements == ()
    halved = found.if_halved()
    (said,) = halved.statements
    assert said.startswith("with half the error of a, method='first_order' differs from cases")
    assert "With half the error of a, method='first_order'" in str(halved.summary())
    assert halved.to_dict()["statements"] == [said]
    with pytest.warns(col.OutOfRangeWarning, match="differs"):
        propagate(
            lambda a, b: {"y": a + 0.35 * abs(b)},
            inputs | {"a": Normal(0.0, 0.5)},
            method="first_order",
        )


def test_what_is_warned_of_all_widths_is_said_once():
    """An angle that jumps, in every row; cases without an answer are counted and not said again."""

    def model(x, y):
        return {"sum": x + y, "heading": (x + y) % (2.0 * math.pi)}

    with pytest.warns(col.OutOfRangeWarning):
        found = propagate(model, {"x": Normal(0.0, 0.3), "y": Normal(0.0, 0.2)}, seed=1)
    halved = found.if_halved()
    (said,) = halved.statements
    assert said == f"as stated, {found.statements[0]}"


def test_what_more_cases_of_a_row_are_warned_of_is_said_of_it_again():
    """A formula outside its range in half of the cases as stated, and in all of a row."""

    def model(speed, factor):
        outside = np.where(abs(speed - 3.0) < 1.0, 8.0, 3.0)
        return {"e": reference.restitution(outside, outside="warn") * factor + 0.01 * speed}

    inputs = {"speed": Uniform(1.0, 5.0), "factor": Normal(1.0, 0.05)}
    with pytest.warns(col.OutOfRangeWarning):
        found = propagate(model, inputs, samples=1024, seed=1)
    said = found.if_halved().statements
    assert [one.partition(": ")[0] for one in said] == [
        "as stated, 512 of 1024 cases (50 %)",
        "with half the error of speed, 1024 of 1024 cases (100 %)",
    ]


def test_two_warnings_of_one_code_are_told_apart():
    """Two formulas outside their ranges, in half of the cases and in a twentieth, in each row as in
    the cases as they are stated.
    """

    def model(first, second):
        often = reference.restitution(np.where(first > 0.0, 8.0, 3.0), outside="warn")
        length = np.where(abs(second) < 0.05, 9.0, 4.5)
        seldom = reference.yaw_inertia(1500.0, length=length, wheelbase=2.7, outside="warn")
        return {"e": often + 1e-6 * seldom}

    inputs = {"first": Uniform(-1.0, 1.0), "second": Samples([-1.0, 1.0] * 19 + [0.0] * 2)}
    with pytest.warns(col.OutOfRangeWarning):
        found = propagate(model, inputs, samples=1024, seed=1)
    shares = [one.fields["share"] for one in found.notes if one.code == "outside_reference"]
    assert shares == pytest.approx([0.5, 0.05], abs=0.02)
    said = found.if_halved().statements
    assert [one.partition(", ")[0] for one in said] == ["as stated", "as stated"]


def test_an_input_may_be_called_now():
    with pytest.warns(col.OutOfRangeWarning):
        found = propagate(
            lambda now, x: {"y": np.where(now > 0.0, x, np.nan)},
            {"now": Normal(1.0, 1.0), "x": Normal(0.0, 1.0)},
            seed=1,
        )
    halved = found.if_halved()
    none = {sd: 0.5 * math.erfc(1.0 / sd / math.sqrt(2.0)) for sd in (0.5, 1.0)}
    assert halved.without_answer_now == pytest.approx(none[1.0], abs=2e-3)
    assert halved.without_answer["now"] == pytest.approx(none[0.5], abs=2e-3)
    assert halved.without_answer["x"] == pytest.approx(none[1.0], abs=2e-3)


@pytest.mark.parametrize(
    ("whole", "first", "said", "share"),
    [(1.0, "s", "The first row gains the most.", "no longer infinite"),
     (0.5, "v", "None makes one narrower.", "same")],
)  # fmt: skip
def test_an_infinite_range_gains_where_half_an_error_makes_it_finite(whole, first, said, share):
    """Cases below 0.2 are known from one side alone: of 0 to 1 a fifth, halved none, and of 0 to
    0.5 two fifths and two tenths, where the other input makes no difference to it.
    """

    def model(v, s):
        return {"v": OneSided(v, np.where(s < 0.2, 1, 0))}

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        found = propagate(
            model, {"v": Normal(6.0, 0.3), "s": Uniform(0.0, whole)}, samples=2048, seed=1
        ).if_halved()
    assert found.now["v"] == math.inf
    assert next(iter(found)) == first
    assert found["v"]["v"] == math.inf
    text = str(found)
    assert said in text
    row = next(line for line in text.splitlines() if line.strip().startswith("s "))
    assert f"({share})" in row
    if share != "same":
        assert found["s"]["v"] == pytest.approx(2.0 * Z * 0.3, rel=0.02)
