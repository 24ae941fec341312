"""Outputs known from one side in some cases: ends that are infinite where these decide them, and
figures that then do not exist.
"""

import json
import math
import pickle
import re
import warnings

import matplotlib.pyplot as plt
import numpy as np
import pytest
from scipy.special import ndtri

import collisions as col
from collisions import plot
from collisions.quantities.units import to_quantity
from collisions.reconstruct import fit, posterior
from collisions.uncertainty import Interval, Normal, OneSided, Uniform, propagate

UNIT = {"x": Uniform(0.0, 1.0)}
OPTIONS = {"samples": 1024, "seed": 1}


def beyond(least, side):
    """A number from 0 to 1, known from one side only above ``least``; and the same both ways."""

    def model(x):
        found = to_quantity(x, "m/s")
        sided = OneSided(found, np.where(x > least, side, 0))
        return {"sided": sided, "known": found}

    return model


def test_the_share_decides_an_end():
    """Of uniform numbers: the low end of a contact known from below is that of the bounds; the high
    end is finite as long as fewer than 2.5 % are unbounded.
    """
    for least, high in ((0.99, 0.975), (0.9, math.inf), (-1.0, math.inf)):
        found = propagate(beyond(least, 1), UNIT, **OPTIONS)["sided"]
        assert found.interval() == pytest.approx((0.025, high), abs=2e-3)
        assert found.quantile(0.0) == pytest.approx(0.0, abs=2e-3)
        assert found.quantile(1.0) == math.inf
    below = propagate(beyond(0.5, -1), UNIT, **OPTIONS)["sided"]
    assert below.interval() == (-math.inf, pytest.approx(0.975, abs=2e-3))
    # 10 % from one side: an interval of a half still has two ends.
    some = propagate(beyond(0.9, 1), UNIT, **OPTIONS)["sided"]
    assert some.interval(0.5) == pytest.approx((0.25, 0.75), abs=2e-3)
    found = some.quantile(np.array([0.1, 0.5, 0.95]))
    assert found == pytest.approx([0.1, 0.5, math.inf], abs=2e-3)
    both = propagate(
        lambda x: {"x": OneSided(x, np.where(x > 0.6, 1, np.where(x < 0.4, -1, 0)))},
        UNIT,
        **OPTIONS,
    )["x"]
    assert both.interval() == (-math.inf, math.inf)
    assert "open on both sides at 95 percent" in repr(both)
    middle = propagate(lambda x: {"x": OneSided(x, 1)}, UNIT, **OPTIONS)["x"]
    assert math.isnan(middle.quantile(0.5))
    assert middle.shares_of_sides() == (1.0, 0.0)
    assert math.isnan(middle.quantile_standard_error(0.975))
    assert 0.0 < middle.quantile_standard_error(0.025) < 0.01


def partly_open(samples, seed, method="quasi_random"):
    """A normal number of which every tenth case is open above, and every twentieth below."""
    return propagate(
        lambda v, q: {"x": OneSided(v, np.where(q < 0.1, 1, np.where(q > 0.95, -1, 0)))},
        {"v": Normal(10.0, 2.0), "q": Uniform(0.0, 1.0)},
        samples=samples,
        seed=seed,
        method=method,
    )["x"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "samples", "seeds", "shares"),
    [
        ("quasi_random", 2048, 24, (0.1, 0.3, 0.7, 0.8)),
        ("latin_hypercube", 2048, 24, (0.1, 0.3, 0.7, 0.8)),
        ("monte_carlo", 2048, 24, (0.1, 0.3, 0.7, 0.8)),
        # One percent of the cases from where the quantiles become infinite.
        ("quasi_random", 8192, 40, (0.06, 0.89)),
        ("latin_hypercube", 8192, 40, (0.06, 0.89)),
    ],
)
def test_the_standard_error_of_a_quantile_is_how_far_it_is_off(method, samples, seeds, shares):
    """Against the exact quantiles: its size over many seeds."""
    drawn = [partly_open(samples, seed, method) for seed in range(seeds)]
    for share in shares:
        right = 10.0 + 2.0 * float(ndtri(share / 0.9 if share > 0.5 else (share - 0.05) / 0.95))
        size = math.sqrt(np.mean([(one.quantile(share) - right) ** 2 for one in drawn]))
        stated = np.mean([one.quantile_standard_error(share) for one in drawn])
        assert 0.5 < size / stated < 2.0, share


def test_the_standard_error_is_infinite_where_the_quantile_may_be_and_none_where_it_is():
    output = partly_open(8192, 39)
    assert output.quantile(0.8975) < math.inf == output.quantile_standard_error(0.8975)
    assert output.quantile(0.0515) > -math.inf
    assert output.quantile_standard_error(0.0515) == math.inf
    assert output.quantile(0.04) == -math.inf
    assert math.isnan(output.quantile_standard_error(0.04))


@pytest.mark.slow
@pytest.mark.parametrize("method", ["quasi_random", "latin_hypercube", "monte_carlo"])
def test_the_standard_error_of_a_probability_is_how_far_it_is_off(method):
    """Of a condition that no side leaves open: every case above 8 says "at least"."""
    off, stated = [], []
    for seed in range(40):
        output = propagate(
            lambda v, q: {"x": OneSided(v + 0.0 * q, np.where(v > 8.0, 1, 0))},
            {"v": Normal(10.0, 2.0), "q": Uniform(0.0, 1.0)},
            samples=2048,
            seed=seed,
            method=method,
        )["x"]
        probability, error = output.probability(lambda x: x > 7.0)
        off.append(probability - 0.5 * math.erfc(-1.5 / math.sqrt(2.0)))
        stated.append(error)
    assert 0.5 < math.sqrt(np.mean(np.square(off))) / np.median(stated) < 2.0


def test_without_a_side_it_is_what_it_was():
    """Sides of 0 change no bit; nor do those of one output change another."""
    plain = propagate(lambda x: {"x": x}, UNIT, **OPTIONS)["x"]
    sided = propagate(lambda x: {"x": OneSided(x, 0 * (x > 0.5))}, UNIT, **OPTIONS)["x"]
    assert type(sided) is type(plain)
    for name in ("mean", "std", "mean_standard_error", "contributions"):
        assert getattr(sided, name) == getattr(plain, name)
    other = propagate(beyond(0.5, 1), UNIT, **OPTIONS)["known"]
    assert (other.mean, other.interval()) == (plain.mean, plain.interval())
    assert other.contributions == plain.contributions


def test_what_does_not_exist_is_not_given():
    """Mean, deviation and correlation are NaN, there are no shares and no histogram; texts, tables,
    records and pickles say the range.
    """
    result = propagate(beyond(0.5, 1), UNIT, **OPTIONS)
    found = result["sided"]
    for name in ("mean", "std", "mean_standard_error", "std_standard_error"):
        assert math.isnan(getattr(found, name))
        assert math.isnan(getattr(found.q, name).magnitude)
    assert found.contributions == found.total_contributions == {}
    assert found.row()[1].startswith("at least 0.02")
    assert found.row()[1].endswith("m/s, 97.5 percent")
    assert "at least 0.1 mph, 97.5 %" in str(found.summary("us"))
    assert "at least 0.1 km/h, 97.5 %" in str(result.summary("metric"))
    assert found.to("mph").interval()[1] == math.inf
    record = json.loads(json.dumps(result.to_dict()))["outputs"]["sided"]
    assert record["interval_95"][1] == "inf"
    assert record["at_least"] == pytest.approx(0.5, abs=2e-3)
    assert record["at_most"] == 0.0
    (statement,) = result.statements
    assert "in 50 % of the cases sided is known from one side only, as at least" in statement
    assert "reconstruct.posterior with a prior for it has two sides" in statement
    again = pickle.loads(pickle.dumps(result))["sided"]
    assert again.interval() == found.interval()
    assert math.isnan(result.correlation["sided", "known"])
    for call in (
        lambda: found.histogram(),
        lambda: plot.distribution(found),
        lambda: plot.contributions(result, "sided"),
    ):
        with pytest.raises(col.InputError, match="sided' has no"):
            call()
    plt.close("all")


def test_a_report_has_the_range():
    """Beside the figures of other outputs."""
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=15.0), col.Vehicle(mass=1200.0), 0.1)

    def model(speed_a):
        hit = col.linear_central(
            col.Vehicle(mass=1500.0, vx=speed_a), col.Vehicle(mass=1200.0), 0.1, on_failure="nan"
        )
        return {
            "a.before.speed": OneSided(hit.a.before.q.speed, 1),
            "b.delta_v": hit.b.q.delta_v,
        }

    known = {"speed_a": Normal(15.0, 0.5)}
    page = col.report(impact, uncertainty=propagate(model, known, **OPTIONS), form="markdown")
    assert "at least 14.04 m/s, 97.5 %" in page
    assert re.search("n 100 % of the cases .* known from one side only", page)


def test_cases_without_an_answer_are_left_out():
    """As of any output; with none, there is nothing to give."""

    def model(x):
        return {"x": OneSided(np.where(x < 0.25, np.nan, x), 1)}

    with pytest.warns(col.OutOfRangeWarning, match="256 of 1024"):
        found = propagate(model, UNIT, **OPTIONS)["x"]
    assert found.interval() == (pytest.approx(0.25 + 0.75 * 0.025, abs=2e-3), math.inf)
    with pytest.raises(col.NoSolutionError, match="no answer for 'x'"):
        propagate(lambda x: {"x": OneSided(x * math.nan, 1)}, UNIT, **OPTIONS)


def test_blocks_and_threads_keep_the_sides():
    """Sides that begin in a later block, and in blocks done at once."""
    for threads in (1, 2):
        found = propagate(
            lambda x: {"x": OneSided(x, (x > 0.999).astype(int))},
            UNIT,
            samples=40000,
            seed=2,
            threads=threads,
        )["x"]
        assert found.shares_of_sides()[0] == pytest.approx(0.001, abs=2e-4)
        assert found.sides.shape == (40000,)


@pytest.mark.parametrize(
    "call",
    [
        lambda model: propagate(model, UNIT, method="first_order"),
        lambda model: propagate(model, UNIT, method="interval"),
        lambda model: propagate(model, UNIT, tolerance=0.1),
        lambda model: propagate(
            lambda x, y: model(x), {**UNIT, "y": Interval(0.0, 1.0)}, samples=64
        ),
        lambda model: posterior(model, UNIT, {"known": Normal(0.5, 0.1)}, samples=512, seed=1),
        lambda model: fit(model, UNIT, {"known": Normal(0.5, 0.1)}),
    ],
    ids=["first_order", "interval", "tolerance", "beside an interval", "posterior", "fit"],
)
def test_where_it_has_no_meaning(call):
    """Derivatives, searches and likelihoods know no bounds."""
    with pytest.raises(col.InputError, match="is OneSided, which is for") as caught:
        call(beyond(0.2, 1))
    assert caught.value.code == "one_sided"


@pytest.mark.parametrize(
    ("code", "values", "sides"),
    [
        ("bad_option", 1.0, 2),
        ("bad_option", 1.0, 0.5),
        ("bad_option", 1.0, math.nan),
        ("bad_option", 1.0, "up"),
        ("bad_option", 1.0, None),
        ("bad_option", np.ones(3), [1, 0, 3]),
        ("bad_option", np.ones(2), to_quantity(np.array([1.0, 0.0]), "m/s")),
        ("bad_option", np.ones(2), np.ma.array([1.0, 0.0], mask=[True, False])),
        ("bad_shape", np.ones(3), [1, 0]),
        ("bad_shape", 1.0, [1, 0]),
        ("not_a_number", None, 1),
    ],
)
def test_refusals(code, values, sides):
    """Sides that are none, or not one for each value."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(col.InputError) as caught:
            OneSided(values, sides)
    assert caught.value.code == code


def test_a_condition_that_the_bounds_decide_has_its_probability():
    """Uniform from 0 to 1, at least 0.8 above that: all of these are above 0.7."""
    found = propagate(beyond(0.8, 1), UNIT, **OPTIONS)
    known = found["known"].probability(lambda x: x > 0.7)
    assert found["sided"].probability(lambda x: x > 0.7) == known
    assert found["sided"].to("km/h").probability(lambda x: x > 0.7 * 3.6) == known
    assert found.probability(lambda at: at["sided"] > 0.7) == known
    assert known[0] == pytest.approx(0.3, abs=3e-3)
    below = propagate(beyond(0.5, -1), UNIT, **OPTIONS)["sided"]
    with pytest.raises(col.InputError):
        below.probability(lambda x: x < 0.9)
    most = propagate(lambda x: {"x": OneSided(x, np.where(x < 0.5, -1, 0))}, UNIT, **OPTIONS)["x"]
    assert most.probability(lambda x: x < 0.6)[0] == pytest.approx(0.6, abs=3e-3)
    # A condition that does not read it does not depend on it.
    assert found.probability(lambda at: at["known"] > 0.9)[0] == pytest.approx(0.1, abs=3e-3)


@pytest.mark.parametrize(
    ("condition", "share"),
    [
        (lambda x: x > 0.9, 0.1),
        (lambda x: x <= 0.9, 0.1),
        # Both the bounds and infinity say no; between them it may hold.
        (lambda x: (x > 1.5) & (x < 1.6), None),
        (lambda x: np.abs(x - 3.0) < 0.01, None),
        (lambda x: x < 1e6, 0.2),
    ],
)
def test_a_condition_that_they_leave_open_is_refused(condition, share):
    found = propagate(beyond(0.8, 1), UNIT, **OPTIONS)
    for asked in (
        lambda: found["sided"].probability(condition),
        lambda: found.probability(lambda at: condition(at["sided"])),
    ):
        with pytest.raises(col.InputError, match=r"'sided' is known from one") as refused:
            asked()
        assert refused.value.code == "one_sided"
        assert "reconstruct.posterior" in str(refused.value)
        undecided = int(str(refused.value).split()[3])
        if share is not None:
            assert undecided / 1024 == pytest.approx(share, abs=3e-3)


@pytest.mark.slow
def test_two_outputs_known_from_one_side_are_not_compared():
    """The first is larger at all bounds; each may lie anywhere above."""

    def model(x):
        sides = np.where(x > 0.5, 1, 0)
        return {"high": OneSided(x + 2.0, sides), "low": OneSided(x, sides)}

    found = propagate(model, UNIT, **OPTIONS)
    with pytest.raises(col.InputError, match="'high' and 'low' are known") as refused:
        found.probability(lambda at: at["high"] > at["low"])
    assert refused.value.code == "one_sided"
    # "At least" against "at most" is decided.
    apart = propagate(
        lambda x: {"high": OneSided(x + 2.0, 1), "low": OneSided(x, -1)}, UNIT, **OPTIONS
    )
    assert apart.probability(lambda at: at["high"] > at["low"]) == (1.0, 1 / 1024)
    # Only together they reach it.
    both = propagate(lambda x: {"one": OneSided(x, 1), "other": OneSided(x, 1)}, UNIT, **OPTIONS)
    with pytest.raises(col.InputError, match="1024 of 1024"):
        both.probability(lambda at: (at["one"] > 5.0) & (at["other"] > 5.0))
    with pytest.raises(col.InputError, match="samples the condition may hold or not"):
        both.probability(lambda at: (np.abs(at["one"] - 3.0) < 0.5) & (at["other"] > 9.0))


@pytest.mark.filterwarnings("ignore:.*had no answer")
def test_a_case_without_an_answer_stays_out_of_a_probability():
    def model(x):
        return {"x": OneSided(np.where(x < 0.5, np.nan, x), np.where(x > 0.8, 1, 0))}

    found = propagate(model, UNIT, **OPTIONS)
    for chance, error in (
        found["x"].probability(lambda x: x > 0.75),
        found.probability(lambda at: at["x"] > 0.75),
    ):
        assert chance == pytest.approx(0.5, abs=3e-3)
        assert error > 0.0


@pytest.mark.parametrize("unit", [None, "rad"])
def test_a_direction_about_the_jump_that_is_known_from_one_side_is_warned_of(unit) -> None:
    """At least 180 degrees, with an error of 7: its numbers lie at both ends. About 90 they do not,
    and neither do they when counted from 180.
    """

    def course(x):
        wrapped = np.mod(x + math.pi, 2.0 * math.pi) - math.pi
        return to_quantity(wrapped, unit) if unit else wrapped

    def found(middle, less=0.0):
        return propagate(
            lambda x: {"c": OneSided(course(x - less), 1)},
            {"x": Normal(middle, math.radians(7.0))},
            **OPTIONS,
        )

    with pytest.warns(
        col.OutOfRangeWarning, match="c has values near pi and near -pi, and some are"
    ):
        about = found(math.pi)
    assert about["c"].may_wrap()
    assert any("the ends of its range mean nothing" in one for one in about.statements)
    for apart in (found(0.5 * math.pi), found(math.pi, math.pi)):
        assert not apart["c"].may_wrap()
