"""Intervals: never drawn from, extremes found between the bounds, and bounds on figures that hold
wherever the truth lies.
"""

import json
import math
import pickle
import tracemalloc

import numpy as np
import pytest

import collisions as col
from collisions import travel
from collisions.uncertainty import (
    Censored,
    Interval,
    LogNormal,
    Normal,
    OneSided,
    Samples,
    Triangular,
    Uniform,
    propagate,
)
from uncertain_scenes import SCENES, chain

# Nothing but intervals


@pytest.mark.slow
def test_monotone_bounds_are_exact_to_the_bit():
    """The speed before a skid rises with drag and length and falls with nothing: both ends are the
    model at two corners.
    """
    inputs = {"drag": Interval(0.61, 0.83), "length": Interval("61 ft", "72 ft")}
    found = propagate(
        lambda drag, length: {"speed": travel.speed(length, drag=drag)}, inputs, method="interval"
    )  # fmt: skip
    ends = [
        travel.speed(at[:1], drag=np.array([drag]))
        for at, drag in zip(_ends(inputs["length"]), (0.61, 0.83), strict=True)
    ]
    exact = (float(ends[0][0]), float(ends[1][0]))
    assert found["speed"].interval() == found["speed"].mean == found["speed"].quantile(0.5) == exact
    assert found["speed"].std == (0.0, 0.0)
    assert found.failed == 0
    assert found.seed is None
    assert "given the stated inputs" in repr(found)


def _ends(interval):
    return np.array([interval.low]), np.array([interval.high])


@pytest.mark.slow
def test_bounds_of_a_real_chain():
    """From the marks to the speeds before an impact, against a grid of 11^5 cases, of which no case
    is outside the bounds; and both bounds are reached, at a corner of the box."""
    bounds = {
        "drag": (0.6, 0.8),
        "length": (17.0, 19.0),
        "course_after": (0.5, 0.7),
        "mass_a": (1450.0, 1550.0),
        "mass_b": (1150.0, 1250.0),
    }
    found = propagate(
        chain, {name: Interval(*ends) for name, ends in bounds.items()}, method="interval"
    )
    grid = np.meshgrid(*[np.linspace(*ends, 11) for ends in bounds.values()], indexing="ij")
    answers = chain(**{name: axis.reshape(-1) for name, axis in zip(bounds, grid, strict=True)})
    for name, values in answers.items():
        assert found[name].interval() == (values.min(), values.max())


@pytest.mark.parametrize("width", [1.0, 1e-6, 1e6])
@pytest.mark.parametrize("peak", [0.5, 0.3, 0.123456789, 0.987, 0.01])
def test_an_extreme_between_the_bounds(width, peak):
    """A parabola whose top lies anywhere inside; x (1 - x) is the one at one half. Its value errs
    by the square of the place.
    """
    found = propagate(
        lambda x: {"y": 1.0 - ((x / width) - peak) ** 2}, {"x": Interval(0.0, width)},
        method="interval"
    )["y"]  # fmt: skip
    assert found.interval() == pytest.approx((1.0 - max(peak, 1.0 - peak) ** 2, 1.0), abs=1e-13)


@pytest.mark.slow
def test_extremes_on_a_ridge_and_in_a_valley():
    """A saddle with both extremes inside, in two inputs that are not aligned with it: sin(x + y)
    cos(x - 2 y).
    """

    def model(x, y):
        return {"y": np.sin(x + y) * np.cos(x - 2.0 * y)}

    found = propagate(model, {"x": Interval(0.0, 3.0), "y": Interval(0.0, 3.0)}, method="interval")[
        "y"
    ]
    x, y = np.meshgrid(np.linspace(0.0, 3.0, 2001), np.linspace(0.0, 3.0, 2001))
    values = model(x, y)["y"]
    low, high = found.interval()
    # The grid misses an extreme by half a step of 0.0015 at most, so its value by the curvature,
    # below 10, times that squared.
    assert values.min() - 1e-5 < low <= values.min() + 1e-12
    assert values.max() - 1e-12 <= high < values.max() + 1e-5


@pytest.mark.slow
def test_a_friction_limit_between_the_bounds():
    """The yaw rate of a side impact, which bends where sticking begins: bounds against 20,001
    frictions, the least speed.
    """

    def model(friction):
        a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.2, y=0.0, vx=15.0)
        b = col.Vehicle(mass=1300.0, yaw_inertia=2100.0, x=0.9, y=-0.4, vy=10.0)
        return {
            "yaw": col.eccentric(
                a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=friction, on_failure="nan"
            ).b.after.yaw_rate
        }  # fmt: skip

    found = propagate(model, {"friction": Interval(0.0, 1.0)}, method="interval")["yaw"]
    values = model(np.linspace(0.0, 1.0, 20001))["yaw"]
    assert found.interval() == pytest.approx((values.min(), values.max()), abs=1e-4)
    assert found.interval()[0] <= values.min()
    assert found.interval()[1] >= values.max()


def test_many_intervals():
    """14 are searched at every corner; one more is refused."""
    inputs = {f"x{i}": Interval(-1.0, 2.0) for i in range(14)}
    found = propagate(lambda **x: {"y": sum(x.values())}, inputs, method="interval")["y"]
    assert found.interval() == (-14.0, 28.0)
    inputs["x14"] = Interval(0.0, 1.0)
    with pytest.raises(
        col.InputError, match="15 intervals are 32768 corners; give at most 14"
    ) as caught:
        propagate(lambda **x: {"y": sum(x.values())}, inputs, method="interval")
    assert caught.value.code == "too_many_intervals"


def test_bounded_distributions_lend_their_support():
    """And nothing else: how likely its values are counts for nothing."""
    inputs = {
        "a": Uniform(1.0, 2.0),
        "b": Triangular(0.0, 0.9, 1.0),
        "c": Normal(0.1, 0.1, truncate=(0.0, 1.0)),
        "d": Samples([3.0, 5.0, 4.0]),
        "e": Interval(0.0, 10.0),
        "f": 100.0,
    }
    found = propagate(lambda **x: {"y": sum(x.values())}, inputs, method="interval")["y"]
    assert found.interval() == (104.0, 119.0)


@pytest.mark.parametrize(
    "unbounded", [Normal(1.0, 0.1), LogNormal(1.0, 0.1), Normal(1.0, 0.1, truncate=(0.0, None))]
)
def test_a_distribution_without_bounds(unbounded):
    """Refused with its name and what to write."""
    with pytest.raises(
        col.InputError,
        match=r"^mass = .* has no bounds for method='interval'; write Interval\(low, high\)",
    ) as caught:
        propagate(lambda mass: {"y": mass}, {"mass": unbounded}, method="interval")
    assert caught.value.code == "unbounded"
    assert caught.value.fields["argument"] == "mass"


def test_nothing_uncertain():
    """Refused by every method, with what to take."""
    for method in ("first_order", "quasi_random"):
        for value, advice in (
            (1.0, r"write Normal\(mean, sd\)"),
            (Interval(0.0, 1.0), "of intervals alone take method='interval'"),
        ):
            with pytest.raises(
                col.InputError, match=f"needs an input with a distribution.*{advice}"
            ) as caught:
                propagate(lambda x: {"y": x}, {"x": value}, method=method)
            assert caught.value.code == "nothing_uncertain"
    with pytest.raises(col.InputError, match="needs an input with bounds") as caught:
        propagate(lambda x: {"y": x}, {"x": 1.0}, method="interval")
    assert caught.value.code == "nothing_uncertain"


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (Censored(low="28 km/h", error="1 km/h"), "x is a reading with a bound"),
        (OneSided(1.0, 1), "x is an output that is known from one side only"),
    ],
)
@pytest.mark.parametrize("beside", [{}, {"z": Normal(0.0, 1.0)}, {"z": Interval(0.0, 1.0)}])
@pytest.mark.parametrize("method", ["first_order", "quasi_random", "interval"])
def test_what_is_known_from_one_side_is_no_input(value, said, beside, method):
    """Alone and beside others; the model is not called with it."""
    with pytest.raises(col.InputError, match=said) as caught:
        propagate(lambda x, z=0.0: {"y": x + z}, {"x": value, **beside}, method=method)
    assert caught.value.code == "bad_inputs"


def test_an_interval_knows_no_correlation():
    """Refused."""
    with pytest.raises(col.InputError, match="no correlation either") as caught:
        propagate(
            lambda a, b: {"y": a + b},
            {"a": Interval(0.0, 1.0), "b": Interval(0.0, 1.0)},
            method="interval",
            correlation={("a", "b"): 1.0},
        )
    assert caught.value.code == "bad_correlation"


@pytest.mark.slow
def test_cases_between_the_bounds_without_an_answer():
    """Counted and warned of; the bounds are those of the others, and none at all is refused."""

    def model(speed):
        a, b = col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1200.0, vx=10.0)
        return {"delta_v": col.linear_central(a, b, 0.2, on_failure="nan").b.delta_v}

    with pytest.warns(col.OutOfRangeWarning, match="had no answer") as caught:
        found = propagate(model, {"speed": Interval(8.0, 12.0)}, method="interval")
    assert [record.message.code for record in caught] == ["failed_cases"]
    assert 0 < found.failed < found.samples
    low, high = found["delta_v"].interval()
    assert high == pytest.approx(2.0 * 1.2 * 1500.0 / 2700.0, rel=1e-14)
    # Nearer to no impact at all than a cell of the grid.
    assert 0.0 < low < 1e-9
    with pytest.raises(
        col.NoSolutionError, match="'delta_v' anywhere between the bounds"
    ) as refused:
        propagate(model, {"speed": Interval(8.0, 9.0)}, method="interval")
    assert refused.value.code == "all_failed"


@pytest.mark.slow
def test_directions_across_pi():
    """From 175 degrees on to 185, not from -180 to 180; an angle without its unit keeps the range
    it has.
    """

    def model(course):
        a = col.Vehicle(mass=1500.0, vx=15.0, heading=0.0)
        b = col.Vehicle(mass=1200.0, heading=course)
        return {
            "pdof": col.oblique_central(
                a, b, 0.1, normal=0.0, friction=0.0, on_failure="nan"
            ).b.q.pdof
        }

    found = propagate(model, {"course": Interval("-5 deg", "5 deg")}, method="interval")["pdof"]
    assert np.degrees(found.interval()) == pytest.approx([175.0, 185.0], abs=1e-9)
    one_side = propagate(model, {"course": Interval("1 deg", "5 deg")}, method="interval")["pdof"]
    assert np.degrees(one_side.interval()) == pytest.approx([-179.0, -175.0], abs=1e-9)
    assert found.q.interval()[1].m_as("deg") == pytest.approx(185.0)


# Together with distributions


def test_an_interval_is_never_drawn_from():
    """The model is asked at places between the bounds, both bounds among them, and at each of them
    with the same draws.
    """
    searched, ran = [], []

    def model(x, k):
        if len(x) > 4:  # not where some cases are asked again
            (ran if len(x) == 64 else searched).append((k, x))
        return {"y": x + k}

    found = propagate(
        model,
        {"x": Normal(0.0, 1.0), "k": Interval(2.0, 3.0)},
        method="quasi_random",
        seed=1,
        samples=64,
    )
    common = searched[0][1][:256].tobytes()
    for k, x in searched:
        for places, draws in zip(k.reshape(-1, 256), x.reshape(-1, 256), strict=True):
            assert np.ptp(places) == 0.0
            assert 2.0 <= places[0] <= 3.0
            assert draws.tobytes() == common
    assert {2.0, 3.0} <= {float(place) for k, _ in ran for place in np.unique(k)}
    assert all(np.ptp(k) == 0.0 for k, _ in ran)
    assert len({x.tobytes() for _, x in ran}) == 1
    assert found.samples == sum(x.size for _, x in searched + ran)


@pytest.mark.slow
def test_extremes_between_the_places_of_a_grid():
    """Delta-V is greatest where the impulse passes through the centre of mass: away from any place
    that a grid would take.
    """

    def model(speed, aside):
        a = col.Vehicle(mass=1500.0, vx=speed, yaw_inertia=2500.0, x=-2.1, y=0.0)
        b = col.Vehicle(mass=1250.0, yaw_inertia=1900.0, x=0.9, y=0.0)
        impact = col.eccentric(
            a, b, 0.1, normal=0.0, point=(0.0, aside), friction=0.4, on_failure="nan"
        )
        return {"delta_v": impact.b.delta_v}

    inputs = {"speed": Normal(15.0, 0.1), "aside": Interval(-0.55, 1.2)}
    found = propagate(model, inputs, method="quasi_random", seed=3)["delta_v"]
    truth = propagate(model, inputs | {"aside": 0.0}, method="quasi_random", seed=3)["delta_v"]
    # Central, so (1 + e) m_a / (m_a + m_b) of the speed; the search ends within 2**-24 of the
    # interval, where nothing is left.
    assert found.mean[1] == pytest.approx(1.1 * 15.0 * 1500.0 / 2750.0, rel=1e-6)
    low, high = found.interval()
    assert low <= truth.interval()[0]
    assert high >= truth.interval()[1] * (1.0 - 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 2, 3, 4, 6])
def test_an_extreme_inside_of_several_intervals(count):
    """Found to what its curvature leaves, however many there are and however the corners look."""

    def model(speed, **aside):
        return {"y": speed * np.exp(-sum((value - 0.3) ** 2 for value in aside.values()))}

    inputs = {"speed": Normal(15.0, 0.1)} | {f"k{i}": Interval(-0.5, 0.8) for i in range(count)}
    found = propagate(model, inputs, method="monte_carlo", seed=3, samples=1024)["y"]
    truth = propagate(
        model,
        inputs | {f"k{i}": 0.3 for i in range(count)},
        method="monte_carlo",
        seed=3,
        samples=1024,
    )["y"]
    assert found.mean[1] == pytest.approx(truth.mean, rel=1e-9)
    assert found.interval()[1] == pytest.approx(truth.interval()[1], rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("count", range(1, 8))
def test_every_corner_is_a_place(count):
    """And there are few enough places to work out."""
    asked = set()

    def model(x, **rest):
        asked.update(
            zip(*(np.broadcast_to(value, x.shape).tolist() for value in rest.values()), strict=True)
        )
        return {"y": x}

    inputs = {"x": Normal(0.0, 1.0)} | {f"k{i}": Interval(0.0, 1.0) for i in range(count)}
    propagate(model, inputs, method="monte_carlo", samples=64, seed=1)
    assert {place for place in asked if set(place) <= {0.0, 1.0}} == set(np.ndindex((2,) * count))


def test_too_many_intervals_beside_distributions():
    """Refused with what to do."""
    inputs = {"x": Normal(0.0, 1.0)} | {f"k{i}": Interval(0.0, 1.0) for i in range(11)}
    with pytest.raises(
        col.InputError, match="11 intervals are 2048 corners; give at most 10 beside distributions"
    ) as caught:
        propagate(lambda **x: {"y": x["x"]}, inputs, method="monte_carlo", samples=64)
    assert caught.value.code == "too_many_intervals"


@pytest.mark.filterwarnings("ignore:method=:collisions.OutOfRangeWarning")
@pytest.mark.parametrize(
    "method",
    [
        "quasi_random",
        *(
            pytest.param(name, marks=pytest.mark.slow)
            for name in ("monte_carlo", "first_order", "second_order")
        ),
    ],
)
def test_bounds_contain_every_truth(method):
    """A rear-end impact whose restitution is only known to lie between two values: the figures of
    20 truths in there, each worked out by itself with the same seed, lie within the bounds on them,
    and those of the two ends on the bounds."""
    model, inputs, _ = SCENES["rear_end"]
    inputs = inputs | {"restitution": Interval(0.05, 0.3)}
    options = {} if "order" in method else {"seed": 4, "samples": 1024}
    found = propagate(model, inputs, method=method, **options)
    for truth in np.linspace(0.05, 0.3, 20):
        known = propagate(model, inputs | {"restitution": float(truth)}, method=method, **options)
        for name in found:
            for figure in (
                lambda output: output.mean,
                lambda output: output.quantile(0.025),
                lambda output: output.quantile(0.975),
            ):
                low, high = figure(found[name])
                assert low <= figure(known[name]) <= high
            low, high = found[name].interval(0.9)
            inner = known[name].interval(0.9)
            assert low <= inner[0] < inner[1] <= high
    first = propagate(model, inputs | {"restitution": 0.05}, method=method, **options)["delta_v"]
    assert (
        found["delta_v"].quantile([0.025, 0.5])[0].tolist() == first.quantile([0.025, 0.5]).tolist()
    )


@pytest.mark.slow
def test_figures_of_bounds():
    """Pairs with their units, errors that are the largest there are, and no share of a variance
    that nobody stated.
    """
    found = propagate(
        lambda v, k: {"energy": 0.5 * k * v**2},
        {"v": Normal(10.0, 1.0), "k": Interval("1000 kg", "2000 kg")},
        method="quasi_random",
        seed=1,
        samples=1024,
    )
    energy = found["energy"]
    each = [
        propagate(
            lambda v, k=k: {"e": 0.5 * k * v**2},
            {"v": Normal(10.0, 1.0)},
            method="quasi_random",
            seed=1,
            samples=1024,
        )["e"]
        for k in (1000.0, 2000.0)
    ]
    assert energy.mean == tuple(one.mean for one in each)
    assert energy.std == tuple(one.std for one in each)
    assert energy.mean_standard_error == each[1].mean_standard_error
    assert energy.std_standard_error == each[1].std_standard_error
    assert energy.quantile_standard_error(0.9) == each[1].quantile_standard_error(0.9)
    assert found.samples > len(energy.cases) * 1024
    for name in ("contributions", "total_contributions", "contribution_standard_errors"):
        with pytest.raises(
            col.InputError, match="Interval among the inputs says nothing of likelihood"
        ) as caught:
            getattr(energy, name)
        assert caught.value.code == "no_variance"
    with pytest.raises(col.InputError, match="no histogram"):
        energy.histogram()
    assert "mean between 50" in repr(found)
    assert "given the stated inputs" in repr(found)
    assert "Given the stated inputs" in found._repr_html_()
    record = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert record["outputs"]["energy"]["interval_95"] == list(energy.interval())
    assert record["inputs"]["k"] == "Interval(low=1000 kg, high=2000 kg)"
    again = pickle.loads(pickle.dumps(found))
    assert again["energy"].mean == energy.mean
    assert found.correlation == {}


@pytest.mark.slow
def test_a_spread_that_is_not_known_is_strict_json():
    """With this seed one of 64 cases has an answer at both ends, which has no spread: NaN is
    written by name.
    """
    with pytest.warns(col.OutOfRangeWarning, match="had no answer"):
        found = propagate(
            lambda x, e: {"y": np.where(x < 0.02, x + e, np.nan)},
            {"x": Uniform(0, 1), "e": Interval(0.1, 0.2)},
            samples=64,
            seed=1,
        )
    record = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert record["outputs"]["y"]["std"] == ["nan", "nan"]


@pytest.mark.slow
def test_failures_over_an_interval_are_told_once():
    """In all, not once for each place: of the square root of x in one case of six none, of 256
    draws to a binomial deviation.
    """
    with pytest.warns(col.OutOfRangeWarning) as caught:
        found = propagate(
            lambda x, k: {"y": np.sqrt(x) + k},
            {"x": Normal(1.0, 1.0), "k": Interval(0.0, 1.0)},
            method="quasi_random",
            samples=1024,
            seed=2,
        )
    assert [record.message.code for record in caught] == ["failed_cases"]
    assert found.failed == caught[0].message.fields["failed"]
    assert found.failed / found.samples == pytest.approx(0.5 * math.erfc(math.sqrt(0.5)), abs=0.02)


@pytest.mark.slow
def test_progress_over_an_interval():
    """Of all places together, rising to the end."""
    seen = []
    propagate(
        lambda x, k: {"y": x + k},
        {"x": Normal(0.0, 1.0), "k": Interval(0.0, 1.0)},
        method="monte_carlo",
        samples=100,
        seed=1,
        progress=lambda done, total: seen.append((done, total)),
    )
    total = seen[-1][1]
    assert total >= 200
    assert seen == [(done, total) for done in range(100, total + 1, 100)]


@pytest.mark.slow
def test_an_interrupt_over_an_interval():
    """What is done is returned, and it is said that the bounds are not those of the
    whole interval.
    """

    def stop(done, total):
        if done == 300:
            raise KeyboardInterrupt

    with pytest.warns(
        col.CollisionsWarning,
        match=r"at 2 of \d+ places between the bounds: they say nothing of the rest",
    ) as caught:
        found = propagate(
            lambda x, k: {"y": x + k},
            {"x": Normal(0.0, 1.0), "k": Interval(0.0, 8.0)},
            method="monte_carlo",
            samples=100,
            seed=1,
            progress=stop,
        )
    assert [record.message.code for record in caught] == ["interrupted"]
    assert found.interrupted
    assert 1 < len(found["y"].cases) < 4

    def model(x, k):
        if np.size(k) > 4 and np.ptp(k) == 0.0 and k[0] > 0.0:
            raise KeyboardInterrupt
        return {"y": x + k}

    inputs = {"x": Normal(0.0, 1.0), "k": Interval(0.0, 8.0)}
    with pytest.warns(col.CollisionsWarning, match=r"at 1 of \d+ places") as caught:
        assert propagate(model, inputs, method="first_order").interrupted
    with pytest.raises(KeyboardInterrupt):
        propagate(lambda x, k: stop(300, 0), inputs, method="first_order")


@pytest.mark.slow
def test_directions_across_pi_at_every_place():
    """A heading known to lie within an interval across the jump, and a course with an error: bounds
    of one range without a gap.
    """

    def model(course, heading):
        a = col.Vehicle(mass=1500.0, vx=15.0, heading=0.0)
        b = col.Vehicle(mass=1200.0, heading=course + heading)
        return {
            "pdof": col.oblique_central(
                a, b, 0.1, normal=0.0, friction=0.0, on_failure="nan"
            ).b.q.pdof
        }

    inputs = {"course": Normal("0 deg", "1 deg"), "heading": Interval("-20 deg", "20 deg")}
    found = propagate(model, inputs, method="quasi_random", seed=3, samples=1024)["pdof"]
    low, high = np.degrees(found.mean)
    assert (low % 360.0, high % 360.0) == pytest.approx((160.0, 200.0), abs=0.05)
    assert high - low == pytest.approx(40.0, abs=0.1)
    assert np.degrees(found.std) == pytest.approx([1.0, 1.0], abs=0.02)


@pytest.mark.slow
def test_a_local_method_is_not_random():
    """The same places between the bounds are found every time, with a seed too: the result could
    not say which it was.
    """
    inputs = {"x": Normal(1.0, 0.3), "k": Interval(-1.0, 1.0)}
    one, *others = (
        propagate(
            lambda x, k: {"y": (k - 0.3 * x) ** 2 + x}, inputs, method="second_order", seed=seed
        )
        for seed in (None, None, 1)
    )
    assert one.seed is None
    assert all(other.to_dict() == one.to_dict() for other in others)


@pytest.mark.slow
@pytest.mark.parametrize("beside", [False, True])
@pytest.mark.parametrize("periods", [1.3, 2.1, 2.9])
def test_smooth_extremes_of_several_valleys_are_found(periods, beside):
    """Some of them as good on the grid as others, against twenty thousand places."""
    for turn in np.linspace(0.0, 6.0, 13):

        def wave(i, turn=turn):
            return np.sin(2.0 * math.pi * periods * i + turn) + 0.1 * i

        at = wave(np.linspace(0.0, 1.0, 20001))
        if beside:
            inputs = {"i": Interval(0.0, 1.0), "x": Normal(0.0, 1.0)}
            found = propagate(lambda i, x: {"o": wave(i) + 0.0 * x}, inputs, seed=1, samples=64)
        else:
            found = propagate(
                lambda i: {"o": wave(i)}, {"i": Interval(0.0, 1.0)}, method="interval"
            )
        assert found["o"].mean == pytest.approx((at.min(), at.max()), abs=1e-6)


@pytest.mark.slow
def test_as_many_intervals_as_there_may_be_take_little_memory():
    """Every one doubles the corners; what is compared with its neighbours is no more than they
    are, and not the 4**14 places of a grid with a margin, 2 GB of them.
    """
    inputs = {f"x{k}": Interval(0.0, 1.0) for k in range(14)}
    tracemalloc.start()
    try:
        found = propagate(lambda **of: {"o": sum(of.values())}, inputs, method="interval")
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert found["o"].mean == (0.0, 14.0)
    assert found.samples < 30_000
    assert most < 1e8
