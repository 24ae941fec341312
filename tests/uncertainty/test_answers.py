"""What a propagation answers with: cases that fail, interrupts, directions, units, tables, pickles;
and every refusal.
"""

import functools
import itertools
import json
import math
import pickle
import re
import signal
import threading
import warnings

import numpy as np
import pint
import pytest

import collisions as col
from collisions import travel
from collisions.uncertainty import (
    Interval,
    Normal,
    Samples,
    Triangular,
    Uniform,
    propagate,
    propagation,
    sampling,
    turns,
)
from fuzzing import Case
from strategies import other_registry
from uncertain_scenes import SCENES

METHODS = ("quasi_random", "latin_hypercube", "monte_carlo")
every_method = pytest.mark.parametrize("method", METHODS)
ureg = pint.get_application_registry()
SPEED = {"speed": Normal(11.0, 1.0)}


def catching_up(speed):
    """A car behind one that drives at 10 m/s: no impact where it is slower."""
    a, b = col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1200.0, vx=10.0)
    impact = col.linear_central(a, b, 0.2, on_failure="nan")
    return {"delta_v": impact.b.delta_v, "hit": impact.ok, "speed": speed}


# Cases without an answer


@every_method
def test_failed_cases_are_counted(method):
    """Their share is the normal probability below -1, of 8192 cases with a binomial deviation of at
    most 0.004; the figures are those of a normal cut off there, mean closing speed 1 +
    phi(1)/Phi(1); and one warning says so at the caller."""
    with pytest.warns(
        col.OutOfRangeWarning,
        match="had no answer .* left out: the figures hold only where there is one",
    ) as caught:
        found = propagate(catching_up, SPEED, method=method, seed=2)
    assert [record.message.code for record in caught] == ["failed_cases"]
    assert caught[0].filename == __file__
    below = 0.5 * math.erfc(math.sqrt(0.5))
    assert found.failed == caught[0].message.fields["failed"]
    assert abs(found.failed / found.samples - below) < 5.0 * 0.004
    delta_v = found["delta_v"]
    assert delta_v.failed == found.failed == np.count_nonzero(np.isnan(delta_v.values))
    closing = 1.0 + math.exp(-0.5) / math.sqrt(2.0 * math.pi) / (1.0 - below)
    assert abs(delta_v.mean - closing * 1.2 * 1500.0 / 2700.0) < 6.5 * delta_v.mean_standard_error
    # A truth value has an answer in every case, and its mean is the probability.
    assert found["hit"].failed == 0
    assert abs(found["hit"].mean - (1.0 - below)) < 6.5 * found["hit"].mean_standard_error
    assert found["speed"].mean == pytest.approx(11.0, abs=0.05)
    assert f"{found.failed} without an answer" in repr(found)
    assert f"{found.failed} without an answer" in found._repr_html_()
    assert sum(delta_v.histogram().shares) == pytest.approx(1.0, abs=1e-12)
    assert delta_v.contributions["speed"] == pytest.approx(1.0, abs=0.1)


def test_truncation_leaves_no_case_without_an_answer():
    """What the warning advises."""
    found = propagate(
        catching_up,
        {"speed": Normal(11.0, 1.0, truncate=(10.0 + 1e-9, None))},
        method="quasi_random",
        seed=1,
    )
    assert found.failed == 0


@every_method
def test_no_case_has_an_answer(method):
    """Refused with the output's name; with a tolerance too, and then at once."""
    inputs = {"speed": Normal(5.0, 0.1)}
    for options in ({}, {"tolerance": {"delta_v": 1e-3}}):
        with pytest.raises(col.NoSolutionError, match="'delta_v' in any of 8192 cases") as caught:
            propagate(catching_up, inputs, method=method, seed=1, **options)
        assert caught.value.code == "all_failed"
        assert caught.value.fields["output"] == "delta_v"


def test_a_single_case_with_an_answer():
    """It has a mean and nothing else: no deviation and no standard error is made up."""
    run = {"method": "monte_carlo", "samples": 64, "seed": 1}
    largest = propagate(lambda x: {"y": x}, {"x": Normal(0.0, 1.0)}, **run)["y"].quantile(1.0)
    with pytest.warns(col.OutOfRangeWarning, match="63 of 64"):
        found = propagate(
            lambda x: {"y": np.where(x == largest, x, np.nan)}, {"x": Normal(0.0, 1.0)}, **run
        )
    y = found["y"]
    assert y.mean == y.quantile(0.5) == np.nanmax(y.values)
    for figure in (
        y.std,
        y.mean_standard_error,
        y.std_standard_error,
        y.quantile_standard_error(0.5),
    ):
        assert math.isnan(figure)
    assert json.loads(json.dumps(found.to_dict(), allow_nan=False))["outputs"]["y"]["std"] == "nan"


def test_infinite_is_no_answer():
    """A quotient that overflows is left out and counted like a refusal."""
    with pytest.warns(col.OutOfRangeWarning, match="had no answer"):
        found = propagate(
            lambda x: {"y": np.where(x > 0.0, x, math.inf)},
            {"x": Normal(0.0, 1.0)},
            method="latin_hypercube",
            samples=64,
            seed=1,
        )
    assert found.failed == 32


# Progress and interrupts


@pytest.mark.parametrize("threads", [1, 2])
def test_progress(monkeypatch, threads):
    """Called after every block, in order, with the cases done and those in all."""
    monkeypatch.setattr(sampling, "BLOCK", 1000)
    seen = []
    model, inputs, _ = SCENES["rear_end"]
    options = {"method": "monte_carlo", "samples": 3500, "seed": 1}
    propagate(model, inputs, threads=threads, progress=lambda *of: seen.append(of), **options)
    assert seen == [(1000, 3500), (2000, 3500), (3000, 3500), (3500, 3500)]


def test_progress_towards_a_tolerance():
    """As far as is known: the run is doubled until it suffices."""
    seen = []
    found = propagate(
        lambda x: {"y": x},
        {"x": Normal(0.0, 1.0)},
        method="monte_carlo",
        seed=1,
        tolerance=0.02,
        progress=lambda *of: seen.append(of),
    )
    assert seen[0] == (1024, 8192)
    assert (8192, 8192) in seen
    assert seen[-1] == (found.samples, found.samples)
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)


@pytest.mark.slow
@every_method
@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("where", ["progress", "model"])
def test_an_interrupt_returns_what_is_done(monkeypatch, method, threads, where):
    """With a warning; the cases are the beginning of the whole run to the bit."""
    monkeypatch.setattr(sampling, "BLOCK", 500)
    calls, lock, first, stopped = itertools.count(1), threading.Lock(), [], []

    def stop(done, total):
        if where == "progress" and done == 1500:
            raise KeyboardInterrupt

    def recorded(**inputs):
        first.append(inputs["speed"].tobytes())
        return SCENES["rear_end"][0](**inputs)

    def model(**inputs):
        if len(inputs["speed"]) < 10:  # asked again
            return SCENES["rear_end"][0](**inputs)
        with lock:
            call = next(calls)
        # Not in the first block, which a thread may come to last: then nothing would be done.
        if where == "model" and call >= 4 and not stopped and inputs["speed"].tobytes() != first[0]:
            stopped.append(call)
            raise KeyboardInterrupt
        return SCENES["rear_end"][0](**inputs)

    inputs = SCENES["rear_end"][1]
    whole = propagate(recorded, inputs, method=method, samples=5000, seed=3)
    with pytest.warns(col.CollisionsWarning, match="interrupted after") as caught:
        found = propagate(
            model, inputs, method=method, samples=5000, seed=3, threads=threads, progress=stop
        )
    (warning,) = [record.message for record in caught]
    assert (warning.code, warning.fields["done"]) == ("interrupted", found.samples)
    assert found.interrupted
    # Two threads may begin their blocks in another order than they were given, and the other one
    # may go on until this one is heard.
    known = where == "progress" or threads == 1
    assert found.samples in ((1500,) if known else range(500, 5000, 500))
    assert not whole.interrupted
    for name in found:
        assert found[name].values.tobytes() == whole[name].values[: found.samples].tobytes()
    assert found["delta_v"].mean_standard_error > 0.0
    assert next(iter(found["delta_v"].contributions)) == "restitution"


def test_an_interrupt_while_a_tolerance_is_sought(monkeypatch):
    """What was done before the doubling counts too."""
    monkeypatch.setattr(sampling, "BLOCK", 4096)

    def stop(done, total):
        if done == 12288:
            raise KeyboardInterrupt

    with pytest.warns(col.CollisionsWarning, match="interrupted after 12288"):
        found = propagate(
            lambda x: {"y": x},
            {"x": Normal(0.0, 1.0)},
            method="monte_carlo",
            seed=1,
            tolerance=1e-6,
            progress=stop,
        )
    whole = propagate(
        lambda x: {"y": x}, {"x": Normal(0.0, 1.0)}, method="monte_carlo", seed=1, samples=16384
    )
    assert found["y"].values.tobytes() == whole["y"].values[:12288].tobytes()


def test_an_interrupt_before_anything_is_done():
    """Nothing to return: it is passed on."""

    def model(x):
        raise KeyboardInterrupt

    for threads in (1, 2):
        with pytest.raises(KeyboardInterrupt):
            propagate(model, {"x": Normal(0.0, 1.0)}, method="monte_carlo", threads=threads)


@pytest.mark.skipif(
    threading.current_thread() is not threading.main_thread(),
    reason="signals reach the main thread only",
)
def test_an_interrupt_from_the_keyboard(monkeypatch):
    """The signal itself, in the middle of a block."""
    monkeypatch.setattr(sampling, "BLOCK", 500)
    calls = []

    def model(x):
        if len(x) > 10:  # not where a few are asked again
            calls.append(None)
        if len(calls) == 3:
            signal.raise_signal(signal.SIGINT)
        return {"y": x}

    # A shell may start the tests with the signal ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.warns(col.CollisionsWarning, match="interrupted after 1000"):
            found = propagate(model, {"x": Normal(0.0, 1.0)}, method="quasi_random", seed=1)
    finally:
        signal.signal(signal.SIGINT, before)
    assert found.samples == 1000


def test_a_model_that_fails_on_a_thread():
    """Its own error, not a hang nor a partial answer."""

    def model(x):
        if len(x) > 10 and x[0] != first:
            raise ZeroDivisionError("mine")
        return {"y": x}

    first = propagate(lambda x: {"y": x}, {"x": Normal(0.0, 1.0)}, method="monte_carlo", seed=1)[
        "y"
    ].values[0]
    for threads in (1, 3):
        with pytest.raises(ZeroDivisionError, match="mine"):
            propagate(
                model,
                {"x": Normal(0.0, 1.0)},
                method="monte_carlo",
                samples=50000,
                seed=1,
                threads=threads,
            )


# Tolerances


@pytest.mark.parametrize(
    "given", ["0.02 mph", ureg.Quantity(3.0, "cm/s"), {"v": "0.1 km/h"}, {"v": 0.02}]
)
def test_tolerances_with_units(given):
    """A text, a Quantity, one for each output: read in the unit of the output."""
    found = propagate(
        lambda v: {"v": v * ureg("m/s")},
        {"v": Normal("20 km/h", "2 km/h")},
        method="monte_carlo",
        seed=1,
        tolerance=given,
    )
    wanted = given["v"] if isinstance(given, dict) else given
    limit = wanted if isinstance(wanted, float) else ureg.Quantity(wanted).m_as("m/s")
    v = found["v"]
    errors = [
        v.mean_standard_error,
        v.std_standard_error,
        *v.quantile_standard_error([0.025, 0.975]),
    ]
    assert max(errors) <= limit
    assert found.samples >= 8192


@pytest.mark.parametrize(
    ("given", "code", "words"),
    [
        (0.0, "bad_tolerance", "must be a number > 0, got 0.0 for delta_v"),
        (-1.0, "bad_tolerance", "> 0"),
        (
            {"speeds": 0.1},
            "bad_tolerance",
            "'speeds', which is no output; the model returned delta_v, energy_loss",
        ),
        ({}, "bad_tolerance", "names no output"),
        ([0.1], "bad_tolerance", "must be a number > 0"),
        ("0.1 km/h", "bad_units", "tolerance"),
        (True, "not_a_number", "tolerance"),
        (math.nan, "not_finite", "tolerance"),
        ("fast", "bad_units", "tolerance"),
    ],
)
def test_tolerances_that_are_none(given, code, words):
    """Refused with what was given."""
    model, inputs, _ = SCENES["rear_end"]
    with pytest.raises(col.InputError, match=words) as caught:
        propagate(model, inputs, method="quasi_random", seed=1, tolerance=given)
    assert caught.value.code == code


# Directions


def struck(course):
    a = col.Vehicle(mass=1500.0, vx=15.0, heading=0.0)
    b = col.Vehicle(mass=1200.0, heading=course)
    return col.oblique_central(a, b, 0.1, normal=0.0, friction=0.0, on_failure="nan").b


@every_method
def test_directions_on_both_sides_of_pi(method):
    """The force on a car struck from behind: with its unit, mean pi and the deviation of its
    heading, and every share with the heading; without, a warning that names it."""
    inputs = {"course": Normal("0 deg", "5 deg"), "idle": Normal(0.0, 1.0)}
    found = propagate(
        lambda course, idle: {"pdof": struck(course).q.pdof}, inputs, method=method, seed=1
    )["pdof"]
    assert abs(abs(found.mean) - math.pi) < 6.5 * found.mean_standard_error + 1e-12
    assert abs(found.std - math.radians(5.0)) < 6.5 * found.std_standard_error
    assert found.contributions["course"] == pytest.approx(1.0, abs=0.06)
    assert found.contributions["idle"] == pytest.approx(0.0, abs=1e-12)
    with pytest.warns(
        col.OutOfRangeWarning, match="pdof has values near pi and near -pi: if it is an angle"
    ) as caught:
        propagate(lambda course, idle: {"pdof": struck(course).pdof}, inputs, method=method, seed=1)
    assert [record.message.code for record in caught] == ["may_wrap"]
    assert caught[0].message.fields["outputs"] == ("pdof",)


FULL_TURN = "has values near 0 and near a full turn, 2 pi, and few somewhere between"


@pytest.mark.parametrize("method", ["quasi_random", "monte_carlo", "latin_hypercube"])
@pytest.mark.parametrize(("middle", "spread"), [(0.0, 5.0), (350.0, 20.0), (20.0, 10.0)])
@pytest.mark.parametrize("unit", [True, False])
def test_a_direction_that_jumps_at_a_full_turn_is_told(method, middle, spread, unit):
    """A normal direction in 0 to 360 degrees, whose plain mean is between its two ends; what the
    warning says to return has the mean and the deviation that were put in.
    """
    inputs = {"x": Normal(f"{middle} deg", f"{spread} deg")}
    radian = ureg.radian if unit else 1.0
    with pytest.warns(col.OutOfRangeWarning, match=f"h {FULL_TURN}") as caught:
        found = propagate(
            lambda x: {"h": np.remainder(x, math.tau) * radian}, inputs, method=method, seed=1
        )["h"]
    assert [record.message.code for record in caught] == ["may_wrap"]
    assert found.may_wrap()

    def returned(x):
        angle = np.degrees(x) % 360.0
        return {"h": ((angle + 180.0) % 360.0 - 180.0) * ureg.degree}

    found = propagate(returned, inputs, method=method, seed=1)["h"]
    away = (math.degrees(found.mean) - middle + 180.0) % 360.0 - 180.0
    assert abs(away) < math.degrees(6.5 * found.mean_standard_error)
    assert math.degrees(found.std) == pytest.approx(spread, rel=0.05)


def test_an_interval_across_a_full_turn_is_told():
    """Its least and greatest values are the ends of the turn, whatever the bounds."""
    with pytest.warns(col.OutOfRangeWarning, match=FULL_TURN):
        propagate(
            lambda x: {"h": np.remainder(x, math.tau) * ureg.radian},
            {"x": Interval(-0.1, 0.2)},
            method="interval",
        )


@pytest.mark.parametrize("unit", [True, False])
@pytest.mark.parametrize(
    "given",
    [
        Uniform(0.0, math.tau),
        Normal(3.5, 0.5, truncate=(0.0, math.tau)),
        Normal(1.0, 1.2, truncate=(0.0, math.tau)),
        Triangular(0.0, 0.1, math.tau),
        Normal(5.5, 0.4, truncate=(0.0, math.tau)),
    ],
)
@pytest.mark.parametrize("method", ["quasi_random", "monte_carlo"])
def test_a_rotation_within_a_turn_is_not_told(given, unit, method):
    """A rotation to any side, one about half a turn, and densities that only fall or only rise."""
    for seed in range(3):
        propagate(
            lambda x: {"h": x * (ureg.radian if unit else 1.0)}, {"x": given}, method=method,
            seed=seed,
        )  # fmt: skip


@pytest.mark.parametrize("middle", [-3.1, -2.0, 0.0, 1.0, 3.0, math.pi])
def test_directions_are_counted_about_their_middle(middle):
    """Values that lie within the turn stay as they are to the bit; those beyond pi are
    counted on.
    """
    found = propagate(
        lambda x: {
            "y": np.remainder(x + math.pi, 2.0 * math.pi) * ureg.radian - math.pi * ureg.radian,
            "x": x,
        },
        {"x": Normal(middle, 0.2)},
        method="quasi_random",
        seed=1,
    )
    away = (found["y"].mean - found["x"].mean) / (2.0 * math.pi)
    assert away == pytest.approx(round(away), abs=1e-12)
    assert -math.pi - 1e-3 <= found["y"].mean <= math.pi + 1e-3
    assert found["y"].std == pytest.approx(found["x"].std, rel=1e-12)


def pointing(course):
    """A direction with its unit, from -pi to pi."""
    return {"course": ureg.Quantity(np.arctan2(np.sin(course), np.cos(course)), "rad")}


def wrapped_normal(sd):
    """Standard deviation and quantiles about the middle, within half a turn, and the density
    opposite it over that of all sides.

    By the Fourier series of the density (Mardia and Jupp, Directional Statistics), summed until
    nothing is left.
    """
    k = np.arange(1.0, 200.0)
    size = np.exp(-0.5 * (k * sd) ** 2)

    def quantile(p):
        low, high = -math.pi, math.pi
        for _ in range(60):
            middle = 0.5 * (low + high)
            below = (
                0.5
                + middle / (2.0 * math.pi)
                + float(np.sum(size * np.sin(k * middle) / k)) / math.pi
            )
            low, high = (middle, high) if below < p else (low, middle)
        return low

    variance = math.pi**2 / 3.0 + 4.0 * float(np.sum((-1.0) ** k * size / k**2))
    return math.sqrt(variance), quantile, 1.0 + 2.0 * float(np.sum((-1.0) ** k * size))


@pytest.mark.slow
@pytest.mark.parametrize("middle", [180.0, 30.0, -100.0, 179.0])
@pytest.mark.parametrize("sd", [5.0, 40.0, 70.0])
@pytest.mark.parametrize("method", ["quasi_random", "latin_hypercube", "monte_carlo"])
def test_a_normal_direction_of_any_spread(method, sd, middle):
    """A wrapped normal, whose facts are known: no empty part of the circle is needed. 6.5 standard
    errors, as all tests here.
    """
    stated = Normal(f"{middle} deg", f"{sd} deg")
    found = propagate(pointing, {"course": stated}, method=method, seed=3, samples=16384)["course"]
    std, quantile, _ = wrapped_normal(math.radians(sd))
    mean = math.radians(middle)
    assert (
        abs(math.remainder(found.mean - mean, 2.0 * math.pi))
        < 6.5 * found.mean_standard_error + 1e-12
    )
    assert -math.pi < found.mean <= math.pi + 1e-9
    assert abs(found.std - std) < 6.5 * found.std_standard_error
    assert sd > 40.0 or found.std == pytest.approx(math.radians(sd), rel=0.02)
    for p in (0.025, 0.1, 0.5, 0.8, 0.975):
        away = math.remainder(found.quantile(p) - mean - quantile(p), 2.0 * math.pi)
        assert abs(away) < 6.5 * found.quantile_standard_error(p) + 1e-12, p
    low, high = found.interval(0.95)
    assert low < found.mean < high < low + 2.0 * math.pi


@pytest.mark.slow
def test_the_standard_error_of_a_mean_direction_knows_where_the_circle_was_cut():
    """It is that of a mean over 1 - the density opposite it, over that of all sides (Hotz and
    Huckemann 2015).

    Each error is from 16 sequences, and so within 18 percent as a standard deviation: the mean of
    16 runs within a fifth.
    """
    std, _, opposite = wrapped_normal(math.radians(85.0))
    assert 0.3 < opposite < 0.5
    found = [
        propagate(
            pointing,
            {"course": Normal("3 rad", "85 deg")},
            method="monte_carlo",
            seed=seed,
            samples=4096,
        )["course"]
        for seed in range(16)
    ]
    wanted = std / 64.0 / (1.0 - opposite)
    assert np.mean([one.mean_standard_error for one in found]) == pytest.approx(wanted, rel=0.2)
    away = [math.remainder(one.mean - 3.0, 2.0 * math.pi) for one in found]
    assert math.sqrt(np.mean(np.square(away))) == pytest.approx(wanted, rel=0.6)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_the_mean_direction_has_the_least_mean_square_of_the_way_to_it(seed):
    """By trying 20,000 directions on a few dozen that lie anyhow: none is better than the mean by
    more than the step allows.
    """
    rng = np.random.default_rng(seed)
    given_ = np.concatenate([rng.uniform(-math.pi, math.pi, 40), rng.normal(seed, 0.8, 50)])
    values = pointing(rng.permutation(given_))["course"].magnitude
    found = turns.counted(values)
    assert np.all(
        np.abs(np.rint((found - values) / (2.0 * math.pi)) * 2.0 * math.pi + values - found) < 1e-14
    )
    tried = np.linspace(-math.pi, math.pi, 20_001)[:, np.newaxis]
    squares = np.mean(
        (np.remainder(values - tried + math.pi, 2.0 * math.pi) - math.pi) ** 2, axis=1
    )
    assert np.var(found) <= squares.min() + 1e-12
    assert found.mean() == pytest.approx(float(tried[np.argmin(squares), 0]), abs=2e-4)
    rows = turns.counted(
        np.stack([values, np.where(np.arange(90) < 45, values, np.nan), np.full(90, np.nan)])
    )
    assert rows[0].tobytes() == found.tobytes()
    np.testing.assert_array_equal(rows[1][:45], turns.counted(values[:45]))


@pytest.mark.parametrize("method", ["first_order", "second_order"])
def test_a_wide_direction_by_derivatives(method):
    """180 degrees with a standard deviation of 40, without a warning."""
    found = propagate(pointing, {"course": Normal("180 deg", "40 deg")}, method=method)["course"]
    assert abs(found.mean) == pytest.approx(math.pi, rel=1e-12)
    assert found.std == pytest.approx(math.radians(40.0), rel=1e-9)


@pytest.mark.slow
def test_a_wide_direction_at_every_place_of_an_interval():
    """Means from 150 to 210 degrees and 40 degrees about each: over the whole circle, and still one
    range.
    """
    inputs = {"course": Normal("0 deg", "40 deg"), "more": Interval("150 deg", "210 deg")}
    found = propagate(
        lambda course, more: pointing(course + more),
        inputs,
        method="quasi_random",
        seed=1,
        samples=4096,
    )["course"]
    low, high = np.degrees(found.mean)
    assert (low % 360.0, high % 360.0) == pytest.approx((150.0, 210.0), abs=0.5)
    assert high - low == pytest.approx(60.0, abs=0.5)
    assert np.degrees(found.std) == pytest.approx([40.0, 40.0], abs=0.5)


def test_directions_to_all_sides():
    """They have no mean, and that is said, and not that they should have a unit."""
    with pytest.warns(
        col.OutOfRangeWarning,
        match="y has directions so far round the circle from one another that its mean tells "
        "little",
    ):
        propagate(
            lambda x: {"y": np.remainder(x, 2.0 * math.pi) * ureg.radian - math.pi * ureg.radian},
            {"x": Uniform(0.0, 100.0)},
            method="quasi_random",
            seed=1,
        )


@pytest.mark.parametrize(("share", "warned"), [(0.5, True), (0.8, True), (0.95, False)])
@pytest.mark.parametrize("spread", [0.0, 0.2])
def test_directions_to_opposite_sides(share, warned, spread):
    """A share p ahead, the others behind: (1 - p) 180 deg to the left is as good a mean as to the
    right, and none goes there.
    """

    def model(side, about):
        turned = np.where(side < share, 0.0, math.pi) + spread * about
        return {
            "y": np.remainder(turned + math.pi, 2.0 * math.pi) * ureg.radian - math.pi * ureg.radian
        }

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        propagate(
            model,
            {"side": Uniform(0.0, 1.0), "about": Normal(0.0, 1.0)},
            method="quasi_random",
            seed=1,
        )
    assert [warning.message.code for warning in caught] == ["may_wrap"] * warned
    # Four in five ahead is a preferred side, and not all sides.
    assert not any(
        "preferred" in str(warning.message) or "all sides" in str(warning.message)
        for warning in caught
    )


@pytest.mark.parametrize(
    "stated", [Normal(7.0, 3.0), Uniform(0.0, 6.0), Uniform(-1.0, 2.5), Uniform(-20.0, 20.0)]
)
def test_rotations_keep_their_turns(stated):
    """What counts turns, or has its gap where the count begins, is left as it is."""
    found = propagate(
        lambda x: {"turned": x * ureg.radian, "x": x}, {"x": stated}, method="quasi_random", seed=1
    )
    assert found["turned"].values.tobytes() == found["x"].values.tobytes()


# Units, tables, pickles


@pytest.fixture(scope="module")
def chained():
    """A chain whose outputs have units."""

    def model(**inputs):
        answer = SCENES["chain"][0](**inputs)
        return {
            "speed_a": answer["speed_a"] * ureg("m/s"),
            "ratio": answer["speed_a"] / answer["speed_b"],
        }

    return propagate(model, SCENES["chain"][1], method="quasi_random", seed=1, samples=2048)


def test_quantities(chained):
    """The same figures with their unit; none for plain numbers."""
    found = chained["speed_a"]
    assert found.unit == "m/s"
    assert found.q.mean.m_as("km/h") == pytest.approx(3.6 * found.mean, rel=1e-15)
    for name in ("std", "mean_standard_error", "std_standard_error"):
        assert getattr(found.q, name) == getattr(found, name) * ureg("m/s")
    assert found.q.quantile([0.1, 0.9]).m_as("m/s").tolist() == found.quantile([0.1, 0.9]).tolist()
    assert tuple(end.m_as("m/s") for end in found.q.interval(0.9)) == found.interval(0.9)
    assert found.q.quantile_standard_error(0.5).units == ureg("m/s").units
    with pytest.raises(
        col.InputError, match="'ratio' has no unit, because the model returned plain numbers"
    ) as caught:
        _ = chained["ratio"].q
    assert caught.value.code == "no_unit"
    # A number of a function has a Quantity of its own.
    assert "travel.q.speed(...) in place of travel.speed(...)" in str(caught.value)


def test_other_units_are_turned_into_si():
    """Whatever unit and registry the model answers in."""
    other = other_registry()
    found = propagate(
        lambda v: {"v": other.Quantity(v, "km/h")}, {"v": Normal(36.0, 3.6)}, method="first_order"
    )["v"]
    assert (found.unit, found.mean) == ("m/s", pytest.approx(10.0))


@pytest.mark.slow
def test_to_dict_is_strict_json(chained):
    """Plain values, and what was stated."""
    record = json.loads(json.dumps(chained.to_dict(), allow_nan=False))
    assert record["method"] == "quasi_random"
    assert (record["samples"], record["failed"], record["seed"], record["interrupted"]) == (
        2048,
        0,
        1,
        False,
    )
    assert record["inputs"]["drag"] == repr(SCENES["chain"][1]["drag"])
    speed = record["outputs"]["speed_a"]
    assert speed["unit"] == "m/s"
    assert speed["mean"] == chained["speed_a"].mean
    assert speed["interval_95"] == list(chained["speed_a"].interval())
    assert speed["contributions"] == chained["speed_a"].contributions
    assert record["outputs"]["ratio"]["unit"] is None
    local = propagate(lambda x: {"y": x}, {"x": Normal(0.0, 1.0)}, method="first_order")
    assert (
        json.loads(json.dumps(local.to_dict(), allow_nan=False))["outputs"]["y"][
            "mean_standard_error"
        ]
        == "nan"
    )


@pytest.mark.filterwarnings("ignore:method=:collisions.OutOfRangeWarning")
@pytest.mark.parametrize("method", ["quasi_random", "second_order", "interval"])
def test_a_pickle_without_its_model(method):
    """A lambda cannot be pickled, what it was asked for can: figures, contributions, and values
    locked as before.
    """
    inputs = {"x": Uniform(1.0, 2.0), "y": Uniform(0.0, 1.0)}
    options = {"seed": 1, "samples": 512} if method == "quasi_random" else {}
    found = propagate(lambda x, y: {"z": x * y + x}, inputs, method=method, **options)
    again = pickle.loads(pickle.dumps(found))
    assert again.to_dict() == found.to_dict()
    assert repr(again) == repr(found)
    assert again.inputs == found.inputs
    if method != "interval":
        assert again["z"].total_contributions == found["z"].total_contributions
        assert again["z"].contribution_standard_errors.keys() == {"x", "y"}
    if method == "quasi_random":
        assert again["z"].values.tobytes() == found["z"].values.tobytes()


def test_what_is_shown(chained):
    """Every range says what it is given."""
    for text in (repr(chained), chained._repr_html_(), repr(chained["speed_a"])):
        assert "given the stated inputs" in text.lower()
    assert "95 percent from" in repr(chained["speed_a"])
    assert "m/s" in repr(chained["speed_a"])
    assert "<th style" in chained._repr_html_()
    escaped = propagate(
        lambda x: {"<b>": x}, {"x": Normal(0.0, 1.0)}, method="first_order"
    )._repr_html_()
    assert "&lt;b&gt;" in escaped
    assert "<b>" not in escaped


def test_the_outputs_by_name(chained):
    """In the order in which the model returned them; another name is refused with the ones there
    are.
    """
    assert list(chained) == ["speed_a", "ratio"]
    assert len(chained) == 2
    assert "ratio" in chained
    with pytest.raises(
        col.InputError, match="no output 'speed_b'; the model returned speed_a, ratio"
    ) as caught:
        chained["speed_b"]
    assert caught.value.code == "no_output"


def test_correlation_of_outputs():
    """Of x + y and x - y with deviations 2 and 1: (4 - 1) / (4 + 1); over the cases that answer
    both.
    """
    inputs = {"x": Normal(0.0, 2.0), "y": Normal(0.0, 1.0)}
    found = propagate(lambda x, y: {"p": x + y, "m": x - y}, inputs, method="quasi_random", seed=1)
    assert found.correlation["p", "m"] == pytest.approx(0.6, abs=0.01)
    with pytest.warns(col.OutOfRangeWarning, match="had no answer"):
        half = propagate(
            lambda x, y: {"p": np.where(x > 0.0, x, np.nan), "m": -x}, inputs,
            method="quasi_random", seed=1
        )  # fmt: skip
    assert half.correlation["p", "m"] == pytest.approx(-1.0, abs=1e-12)
    with pytest.warns(col.OutOfRangeWarning, match="had no answer"):
        apart = propagate(
            lambda x, y: {"p": np.where(x > 0.0, x, np.nan), "m": np.where(x > 0.0, np.nan, x)},
            inputs,
            method="monte_carlo",
            seed=1,
        )
    assert math.isnan(apart.correlation["p", "m"])


def test_histograms(chained):
    """Shares that make up the whole, with binomial errors at most; their edges hold every case."""
    found = chained["speed_a"]
    edges, shares, errors = found.histogram(25)
    assert len(edges) == 26
    assert len(shares) == len(errors) == 25
    assert sum(shares) == pytest.approx(1.0, abs=1e-12)
    assert (edges[0], edges[-1]) == (found.values.min(), found.values.max())
    assert np.array_equal(shares * 2048, np.histogram(found.values, edges)[0])
    assert 0.0 < np.mean(errors) < 1.2 * np.mean(np.sqrt(shares * (1.0 - shares) / 2048))
    for bins in (0, -1, 1.5, "auto", True, None, [1.0, 2.0], 10**9):
        with pytest.raises(col.InputError, match="bins must be a whole number") as caught:
            found.histogram(bins)
        assert caught.value.code == "bad_option"
    flat = propagate(
        lambda x: {"y": 1e20 + 0.0 * x},
        {"x": Normal(0.0, 1.0)},
        method="monte_carlo",
        samples=64,
        seed=1,
    )["y"]
    with pytest.raises(col.InputError, match="do not differ by more than rounding"):
        flat.histogram()
    with pytest.raises(col.InputError, match="nothing was sampled; take method='quasi_random'"):
        propagate(lambda x: {"y": x}, {"x": Normal(0.0, 1.0)}, method="first_order")[
            "y"
        ].histogram()


@pytest.mark.parametrize(
    "p", [-0.1, 1.1, math.nan, "0.5", True, None, [0.5, 2.0], 0.5j, ureg.Quantity(0.5), object()]
)
def test_what_is_no_probability(chained, p):
    """Refused wherever one is asked for."""
    for call in (
        chained["speed_a"].quantile,
        chained["speed_a"].quantile_standard_error,
        chained["speed_a"].interval,
    ):
        with pytest.raises(col.InputError, match="from 0 to 1") as caught:
            call(p)
        assert caught.value.code == "bad_fraction"
    with pytest.raises(col.InputError, match="coverage must be one number"):
        chained["speed_a"].interval([0.5, 0.9])


def test_quantiles(chained):
    """numpy's, of the values; arrays of any shape, floats for floats."""
    found = chained["speed_a"]
    assert type(found.quantile(0.3)) is float
    assert found.quantile(0.3) == np.quantile(found.values, 0.3)
    assert found.quantile(np.array([[0.1, 0.2]])).shape == (1, 2)
    assert found.quantile(np.array([[[0.1, 0.2]]])).shape == (1, 1, 2)
    assert found.quantile_standard_error(np.array([[0.1, 0.2]])).shape == (1, 2)
    assert (found.quantile(0), found.quantile(1)) == (found.values.min(), found.values.max())
    with pytest.raises(ValueError, match="read-only"):
        found.values[0] = 0.0


# Refusals


def refused(model, inputs, **options):
    with pytest.raises(col.InputError) as caught:
        propagate(model, inputs, **{"method": "quasi_random", **options})
    assert str(caught.value)
    return caught.value


X = {"x": Normal(0.0, 1.0)}


@pytest.mark.parametrize("model", [None, 3.0, "model", {"y": 1.0}])
def test_a_model_that_is_no_function(model):
    found = refused(model, X)
    assert found.code == "bad_model"
    assert f"got {type(model).__name__}" in str(found)


@pytest.mark.parametrize(
    ("answer", "code", "words"),
    [
        (
            lambda x: x,
            "bad_model",
            (
                r"must return a dict of named outputs, such as \{'delta_v': "
                r"impact\.a\.q\.delta_v\}, got nd"
            ),
        ),
        (lambda x: None, "bad_model", "got NoneType"),
        (lambda x: {}, "bad_model", "must return a dict of named outputs, .*, got an empty one$"),
        (
            lambda x: {"y": col.Vehicle(mass=1.0, vx=f"{x} mph").q.vx},
            "bad_units",
            r"belongs in the distribution, Normal\('30 mph'",
        ),
        (lambda x: {3: x}, "bad_model", "must name its outputs by texts, got 3"),
        (
            lambda x: {"y": 1.0},
            "bad_shape",
            r"output 'y' of the model has shape \(\) .* leave out what is the same in every case",
        ),
        (lambda x: {"y": x[:-1]}, "bad_shape", r"an array of shape \(8192,\)"),
        (lambda x: {"y": np.stack([x, x])}, "bad_shape", r"\(2, 8192\)"),
        (lambda x: {"y": "fast"}, "bad_units", "fast"),
        (lambda x: {"y": np.array(["a"] * len(x))}, "not_a_number", "y"),
        (lambda x: {"y": x * 1j}, "not_a_number", "y"),
        (lambda x: {"y": None}, "not_a_number", "y"),
        (lambda x: {"y": x.astype(object)}, "not_a_number", "y"),
        (lambda x: {"y": np.mean(x) * ureg("m/s")}, "bad_shape", "case by itself"),
    ],
)
@pytest.mark.parametrize("method", ["quasi_random", "first_order"])
def test_answers_that_are_none(answer, code, words, method):
    """Refused with the name of the output and what an answer is."""
    with pytest.raises(
        col.InputError, match=words.replace("8192", "8192" if method == "quasi_random" else "5")
    ) as caught:
        propagate(answer, X, method=method)
    assert caught.value.code == code


@pytest.mark.parametrize("second", [{"z": 1.0}, {"y": 1.0, "z": 1.0}, {"y": 1.0 * ureg("m")}])
def test_another_answer_on_the_second_call(second, monkeypatch):
    """Refused: other names, more of them, another unit."""
    monkeypatch.setattr(sampling, "BLOCK", 100)
    calls = []

    def model(x):
        calls.append(None)
        return {"y": x} if len(calls) == 1 else {name: x * value for name, value in second.items()}

    found = refused(model, X)
    assert found.code == "bad_model"
    assert "now and y before; it must always return the same outputs" in str(found)


@pytest.mark.parametrize(
    ("model", "error"),
    [
        (lambda x: {"y": math.sqrt(x)}, TypeError),
        (lambda x: {"y": x if x > 0.0 else -x}, ValueError),
        (lambda x: {"y": x * ureg.Quantity(1.0, "m") + ureg.Quantity(1.0, "s")}, TypeError),
        (lambda x: {"y": x.speed}, AttributeError),
    ],
)
@every_method
def test_models_that_cannot_take_arrays(model, error, method):
    """What Python or numpy says of it, what a model is called with, and what to write."""
    found = refused(model, X, method=method)
    assert type(found) is col.InputError
    assert (found.code, found.fields["argument"]) == ("bad_model", "model")
    assert isinstance(found.__cause__, error)
    for words in (
        f"model raised {type(found.__cause__).__name__}: ",
        "numpy in place of math (numpy.sqrt)",
        "on_failure='nan'",
    ):
        assert words in str(found)
    assert re.search(
        r"It is called with arrays of \d+ cases for x, and must work case by case", str(found)
    )
    assert "numpy.where in place of if (numpy.where(x > 0, x, -x))" in str(found)
    assert "Uniform" not in str(found)


def test_a_model_between_bounds_that_cannot_take_arrays():
    """The same of the method that draws nothing."""
    found = refused(lambda x: {"y": math.sqrt(x)}, {"x": Interval(1.0, 2.0)}, method="interval")
    assert "numpy in place of math (numpy.sqrt)" in str(found)


@pytest.mark.parametrize(
    ("model", "code"),
    [
        (lambda x, drag: {"y": x * 0.5 * drag}, "bad_model"),
        (lambda x, drag: {"y": x * np.sqrt(drag)}, "bad_model"),
        (lambda x, drag: {"y": np.sqrt(drag)}, "bad_shape"),
    ],
)
def test_a_pair_that_was_meant_as_a_range(model, code):
    """A pair is a place, which is the same in every case; where the model fails with one, it is
    said what a range is written as.
    """
    found = refused(model, {**X, "drag": (0.6, 0.8)})
    assert isinstance(found, col.InputError)
    assert found.code == code
    assert (
        "drag is the pair (0.6, 0.8) in every case; if a range was meant, write Uniform(0.6, "
        "0.8) or Interval(0.6, 0.8)" in (str(found))
    )
    for method in ("quasi_random", "interval"):
        alone = refused(lambda drag: {"y": drag}, {"drag": (0.6, 0.8)}, method=method)
        assert alone.code == "nothing_uncertain"
        assert "write Uniform(0.6, 0.8) or Interval(0.6, 0.8)" in str(alone)
    assert "Uniform" not in str(
        refused(lambda x, point: {"y": math.sqrt(x)}, {**X, "point": (2.0, -1.0)})
    )


def test_a_refusal_of_a_solver_comes_with_the_note_too():
    """As it is raised where on_failure was not thought of."""
    with pytest.raises(col.InputError) as caught:
        propagate(
            lambda x: {
                "y": col.linear_central(
                    col.Vehicle(mass=1.0, vx=x), col.Vehicle(mass=1.0), "much"
                ).b.delta_v
            },
            X,
            method="monte_carlo",
        )
    assert "called with arrays" in caught.value.__notes__[0]
    with pytest.raises(col.InputError, match="drag is a tuple") as caught:
        propagate(
            lambda x, drag: {"y": travel.speed(x, drag=drag)},
            {**X, "drag": (0.6, 0.8)},
            method="quasi_random",
        )
    assert "write Uniform(0.6, 0.8)" in caught.value.__notes__[0]


@pytest.mark.parametrize(
    ("inputs", "words"),
    [
        (
            {"z": Normal(0.0, 1.0)},
            "inputs are z, but the model takes .x.: missing a required argument: 'x'",
        ),
        ({"x": Normal(0.0, 1.0), "z": 1.0}, "got an unexpected keyword argument 'z'"),
        ({}, "inputs are none"),
        ({1: Normal(0.0, 1.0)}, "inputs must be a dict"),
        ([Normal(0.0, 1.0)], "got list"),
        (None, "got NoneType"),
        (Normal(0.0, 1.0), "got Normal"),
    ],
)
def test_inputs_that_do_not_fit(inputs, words):
    """Names that the model does not know are refused before it is called; so is what is no dict."""
    with pytest.raises(col.InputError, match=words) as caught:
        propagate(lambda x: {"y": x}, inputs, method="quasi_random")
    assert caught.value.code == "bad_inputs"


class Scaled:
    """A model that is an object, with a method that could be one."""

    def __call__(self, x):
        return {"y": x}

    def method(self, x):
        return {"y": x}


@functools.wraps(lambda x: {"y": x})
def wrapping(*args, **options):
    """It shows the signature of what it wraps."""
    return {"y": options["x"]}


@pytest.mark.parametrize(
    "model",
    [
        Scaled(),
        Scaled().method,
        functools.partial(lambda x, k: {"y": k * x}, k=1.0),
        wrapping,
        lambda x, k=1.0: {"y": k * x},
    ],
)
def test_models_that_are_no_plain_function(model):
    """They are called by the same names, and refused by them."""
    assert propagate(model, X, method="monte_carlo", seed=1)["y"].std == pytest.approx(
        1.0, rel=0.05
    )
    for inputs in ({}, {"self": X["x"]}, {"z": X["x"]}):
        with pytest.raises(col.InputError, match="but the model takes") as caught:
            propagate(model, inputs, method="monte_carlo")
        assert caught.value.code == "bad_inputs"


def test_models_without_a_signature():
    """Some functions written in C tell no names, and are called all the same."""

    class Silent:
        __signature__ = "none"

        def __call__(self, x):
            return {"y": x}

    assert propagate(Silent(), X, method="first_order")["y"].std == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("value", "code"),
    [
        (math.nan, "not_finite"),
        (True, "not_a_number"),
        ("soft", "bad_units"),
        (np.array([1.0, 2.0]), "bad_shape"),
        ("12 foo", "bad_units"),
    ],
)
def test_fixed_inputs_that_are_none(value, code):
    """Refused with the name of the input."""
    found = refused(lambda x, k: {"y": x}, X | {"k": value})
    assert found.code == code
    assert "k" in str(found)


@pytest.mark.parametrize("method", ["first_order", "monte_carlo", "interval"])
def test_a_fixed_input_that_holds_itself_reaches_the_model(method):
    """What is no number is the model's own affair; its answer can be read and written down all the
    same.
    """
    loop = [1.0]
    loop.append(loop)
    seen = []

    def model(x, own):
        seen.append(own is loop)
        return {"y": 2.0 * x}

    x = Interval(1.0, 2.0) if method == "interval" else Normal(1.5, 0.1)
    found = propagate(model, {"x": x, "own": loop}, method=method)
    assert seen
    assert all(seen)
    assert found.inputs["own"] is loop
    assert (
        json.loads(json.dumps(found.to_dict(), allow_nan=False))["inputs"]["own"] == "[1.0, [...]]"
    )
    Case("looked at").look(found, None, thorough=True)


def test_fixed_inputs_reach_the_model_in_si():
    """A text with its unit as a number; what is no number as it is."""
    seen = {}

    def model(x, **rest):
        seen.update(rest)
        return {"y": x}

    law = object()
    found = propagate(model, X | {"v": "36 km/h", "k": 2, "law": law}, method="first_order")
    assert seen == {"v": 10.0, "k": 2.0, "law": law}
    assert found.inputs["v"] == 10.0


def test_a_model_cannot_change_its_inputs():
    """They are the same arrays for everything that follows."""

    def model(x):
        x += 1.0
        return {"y": x}

    with pytest.raises(ValueError, match="read-only"):
        propagate(model, X, method="monte_carlo")
    values = propagate(lambda x: {"y": x}, X, method="monte_carlo", seed=1, samples=64)["y"].values
    assert values.base is None or not values.flags.writeable


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (
            {"method": "fosm"},
            "method must be one of first_order, second_order, .* interval, got 'fosm'",
        ),
        ({"method": ["quasi_random"]}, "method must be one of"),
        ({"samples": 63}, "samples must be a whole number from 64 to 16777216, got 63"),
        ({"samples": 2**24 + 1}, "samples must be"),
        ({"samples": 100.0}, "samples must be"),
        ({"samples": True}, "samples must be"),
        ({"samples": "many"}, "samples must be"),
        ({"seed": -1}, "seed must be a whole number from 0, or None, got -1"),
        ({"seed": 1.0}, "seed must be"),
        ({"seed": "1"}, "seed must be"),
        ({"seed": True}, "seed must be"),
        ({"threads": 0}, "threads must be a whole number from 1, got 0"),
        ({"threads": None}, "threads must be"),
        ({"threads": 1.5}, "threads must be"),
        ({"progress": 1}, "progress must be a function of .done, total., or True for a bar, got 1"),
        ({"progress": "yes"}, "progress must be"),
        ({"samples": 100, "tolerance": 0.1}, "give samples= or tolerance=, not both"),
        (
            {"method": "first_order", "samples": 100},
            "samples is for methods that draw; method='first_order' does not",
        ),
        ({"method": "second_order", "tolerance": 0.1}, "tolerance is for methods that draw"),
        ({"method": "interval", "samples": 100}, "samples is for methods that draw"),
    ],
)
def test_options_that_are_none(options, words):
    """Each is named with what was given and what is allowed."""
    with pytest.raises(col.InputError, match=words) as caught:
        propagate(lambda x: {"y": x}, X, **{"method": "quasi_random", **options})
    assert caught.value.code == "bad_option"
    assert caught.value.fields["argument"] in words


@pytest.mark.parametrize(
    ("correlation", "words"),
    [
        ([("a", "b", 0.5)], "must be a dict such as .*, got list"),
        ({("a",): 0.5}, "keys are pairs of two names"),
        ({"ab": 0.5}, "keys are pairs of two names, got 'ab'"),
        ({("a", "a"): 0.5}, "keys are pairs"),
        ({("a", "z"): 0.5}, "'z' is not an input with a distribution; these are a, b, j, k"),
        ({("a", "fixed"): 0.5}, "'fixed' is not an input with a distribution"),
        ({("a", "range"): 0.5}, "'range' is not an input with a distribution"),
        ({("a", "b"): 1.5}, "correlation of a and b must be a number from -1 to 1, got 1.5"),
        ({("a", "b"): math.nan}, "from -1 to 1"),
        ({("a", "b"): True}, "from -1 to 1"),
        ({("a", "b"): "0.5"}, "from -1 to 1"),
        ({("a", "b"): 0.5, ("b", "a"): 0.6}, "b and a are given twice, as 0.5 and 0.6"),
        ({("a", "j"): 0.5}, "'j' belongs to joint samples"),
    ],
)
def test_correlations_that_are_none(correlation, words):
    inputs = {
        "a": Normal(0.0, 1.0),
        "b": Normal(0.0, 1.0),
        "fixed": 1.0,
        "range": Interval(0.0, 1.0),
    }
    inputs |= Samples.joint(j=[1.0, 2.0], k=[2.0, 1.0])
    with pytest.raises(col.InputError, match=words) as caught:
        propagate(lambda **x: {"y": x["a"]}, inputs, method="quasi_random", correlation=correlation)
    assert caught.value.code == "bad_correlation"


def test_a_correlation_given_twice_alike():
    """Is one."""
    inputs = {"a": Normal(0.0, 1.0), "b": Normal(0.0, 1.0)}
    pairs = {("a", "b"): 0.5, ("b", "a"): np.float32(0.5)}
    assert propagate(lambda a, b: {"y": a + b}, inputs, method="first_order", correlation=pairs)[
        "y"
    ].std == pytest.approx(math.sqrt(3.0))


def test_an_interrupt_while_the_errors_are_judged(monkeypatch):
    """Between two doublings too what is done is returned."""

    def judged(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(propagation, "enough", judged)
    with pytest.warns(col.CollisionsWarning, match="interrupted after 8192 cases"):
        found = propagate(lambda x: {"y": x}, X, method="monte_carlo", tolerance=1e-9, seed=1)
    assert found.interrupted
    assert found.samples == 8192


@pytest.mark.parametrize("spread", [0.1, 0.5, 0.8, 1.0])
def test_a_bare_angle_around_pi_is_told_whatever_its_spread(spread):
    """A few cases on the far side of the circle do not hide it; an interval around pi is warned of
    too, a quantity about 0 is not.
    """

    def course(angle):
        return {"course": np.arctan2(np.sin(angle), np.cos(angle))}

    with pytest.warns(col.OutOfRangeWarning, match="near pi and near -pi") as caught:
        propagate(
            course, {"angle": Normal(math.pi, spread)}, method="monte_carlo", seed=1, samples=16384
        )
    assert caught[0].message.code == "may_wrap"
    with pytest.warns(col.OutOfRangeWarning, match="near pi and near -pi"):
        propagate(course, {"angle": Interval(3.0, 3.3)}, method="interval")
    propagate(
        lambda x: {"y": x},
        {"x": Normal(0.0, 1.0, truncate=(-3.1, 3.1))},
        method="monte_carlo",
        seed=1,
    )


@pytest.mark.parametrize("method", ["quasi_random", "monte_carlo"])
def test_what_was_never_seen_is_not_known_to_be_impossible(method):
    """Of a probability with no case in all of them the standard error is that of one case, so no
    tolerance below is reached.
    """
    found = propagate(lambda x: {"p": x > 6.0}, X, method=method, seed=1, samples=4096)["p"]
    assert found.mean == 0.0
    assert found.mean_standard_error == 1.0 / 4096
    seldom = propagate(lambda x: {"p": x > 2.0}, X, method=method, seed=1, tolerance=1e-3)["p"]
    assert seldom.mean == pytest.approx(
        0.5 * math.erfc(math.sqrt(2.0)), abs=6.5 * seldom.mean_standard_error
    )


@pytest.mark.slow
def test_an_output_without_an_answer_at_a_place_of_an_interval():
    """Left out there, counted and warned of; refused where it has none at any place."""
    inputs = {"x": Normal(10.0, 1.0), "k": Interval(-1.0, 1.0)}
    with pytest.warns(col.OutOfRangeWarning, match="had no answer"):
        found = propagate(
            lambda x, k: {"y": np.where(k < 0.0, np.nan, x + k), "z": x - k},
            inputs,
            method="quasi_random",
            seed=1,
        )
    assert found["y"].mean == pytest.approx((10.0, 11.0), abs=1e-4)
    assert found["z"].mean == pytest.approx((9.0, 11.0), abs=1e-4)
    with pytest.raises(col.NoSolutionError, match="anywhere between the bounds"):
        propagate(lambda x, k: {"y": np.nan * (x + k)}, inputs, method="quasi_random", seed=1)


@pytest.mark.parametrize(
    "point", [("5 m", "3 m"), (Normal(2.0, 1.0), 3.0), [pint.Quantity(2.0, "m"), 3.0]]
)
def test_a_pair_with_more_than_numbers_in_it_is_refused(point):
    """It would reach the model unread."""
    with pytest.raises(col.InputError, match="give each part as an input of its own") as caught:
        propagate(lambda x, point: {"y": x}, X | {"point": point}, method="monte_carlo")
    assert caught.value.code == "bad_inputs"


@pytest.mark.parametrize("size", [1e-200, 1.0, 1e300])
def test_contributions_of_any_size(size):
    """Shares have no unit, so no size of the output leaves their range."""
    inputs = {"x": Normal(0.0, 1.0), "z": Normal(0.0, 2.0)}
    found = propagate(
        lambda x, z: {"y": size * x + size * z}, inputs, method="quasi_random", seed=1
    )["y"]
    assert found.contributions == pytest.approx({"z": 0.8, "x": 0.2}, abs=0.01)


def test_the_ends_of_an_interval_share_no_variance():
    """One place of an interval has nothing uncertain about it."""
    ends = propagate(lambda x: {"y": 2.0 * x}, {"x": Interval(1.0, 2.0)}, method="interval")[
        "y"
    ].cases
    assert [end.contribution_standard_errors for end in ends] == [{}, {}]


def test_a_correlation_of_intervals_that_is_an_array():
    with pytest.raises(col.InputError, match="knows no likelihood"):
        propagate(
            lambda x: {"y": x}, {"x": Interval(1.0, 2.0)}, method="interval", correlation=np.eye(2)
        )


@pytest.mark.parametrize("time", [np.timedelta64(70, "s"), np.timedelta64("NaT", "s")])
def test_a_time_is_no_whole_number(time):
    """Numpy counts it among its integers; as a seed, a count, a correlation or an index it is
    refused.
    """
    inputs = {"x": Normal(1.0, 0.1), "z": Normal(1.0, 0.1)}
    options = {"method": "monte_carlo", "samples": 64, "seed": 1}
    for name in ("seed", "samples", "threads"):
        with pytest.raises(col.InputError, match=f"{name} must be a whole number"):
            propagate(lambda x, z: {"y": x + z}, inputs, **options | {name: time})
    with pytest.raises(col.InputError, match="must be a number from -1 to 1"):
        propagate(lambda x, z: {"y": x + z}, inputs, **options, correlation={("x", "z"): time})
    with pytest.raises(col.InputError, match="bins must be"):
        propagate(lambda x, z: {"y": x + z}, inputs, **options)["y"].histogram(time)
    batch = col.linear_central(
        col.Vehicle(mass=1500.0, vx=np.full(80, 20.0)), col.Vehicle(mass=1200.0), 0.1
    )
    with pytest.raises(col.InputError, match="index must be"):
        batch.case(time)


@pytest.mark.parametrize("size", [1e-200, 1.0, 1e200])
def test_correlations_and_errors_do_not_depend_on_the_size_of_the_numbers(size):
    """Of y = x and z = x + x' the correlation is the root of one half; 8192 points of a sequence
    give it to a hundredth.
    """
    inputs = {"x": Normal(0.0, 1.0), "other": Normal(0.0, 1.0)}
    found = propagate(
        lambda x, other: {"y": size * x, "z": size * (x + other)},
        inputs,
        method="quasi_random",
        seed=1,
        samples=8192,
    )
    assert found.correlation["y", "z"] == pytest.approx(math.sqrt(0.5), abs=0.01)
    plain = propagate(
        lambda x, other: {"y": x + other}, inputs, method="quasi_random", seed=1, samples=8192
    )["y"]
    # The same points: only roundings differ, and they are divided by the small error that they are
    # a part of.
    assert found["z"].mean_standard_error == pytest.approx(
        size * plain.mean_standard_error, rel=1e-6
    )
    assert found["z"].std_standard_error == pytest.approx(size * plain.std_standard_error, rel=1e-6)


def test_histograms_are_equal_by_value():
    """Not as arrays are, which have no truth value."""
    found = propagate(
        lambda x: {"y": x}, {"x": Uniform(0, 1)}, method="monte_carlo", samples=64, seed=1
    )["y"]
    assert found.histogram(3) == found.histogram(3)
    assert found.histogram(3).__ne__(found.histogram(3)) is False
    assert found.histogram(3) != found.histogram(4)


def test_the_bars_of_few_quasi_random_inputs_are_no_comb():
    """Neighbouring bars differ by chance at most: three standard deviations of counts."""
    for seed in range(5):
        inputs = {"speed": Normal("54 km/h", "2 km/h"), "e": Uniform(0.05, 0.2)}
        found = propagate(
            lambda speed, e: {"speed": speed * (1.0 + e) / 2.0},
            inputs,
            method="quasi_random",
            seed=seed,
        )
        counts = np.asarray(found["speed"].histogram().shares)[10:20] * found.samples
        bends = counts[1:-1] - 0.5 * (counts[2:] + counts[:-2])
        assert np.all(abs(bends) <= 3.0 * np.sqrt(1.5 * counts[1:-1]))
