"""fit: against the normal equations, published cases, scenes made forward, and simulated evidence
with known truth.

The slopes are differences over steps of 6e-6 of an unknown's size, so of a linear model they err by
rounding alone: eps |y| / (6e-6 size), below 1e-9 of a slope whose output is not above 30 times what
the unknown makes of it. A search ends within 1e-8 standard errors, or 1e-8 of the misfit where that
is above 1.
"""

import json
import math
import pickle
import warnings
from statistics import NormalDist

import mpmath
import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct, travel
from collisions.estimate.least_squares import Problem, chi_squared_tail, spread
from collisions.reconstruct import fit
from collisions.uncertainty.distributions import (
    Interval,
    LogNormal,
    Normal,
    Samples,
    Triangular,
    Uniform,
)
from collisions.uncertainty.propagation import propagate

ROW = ("o0", "o1", "o2", "o3", "o4")
MPH, DEGREE, POUND, SLUG_FOOT = 0.44704, math.pi / 180.0, 0.45359237, 1.3558179483314004


def fitted(*arguments):
    """The fit, and the codes of the warnings it gave."""
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        found = fit(*arguments)
    return found, [one.message.code for one in given]


def linear(matrix, names=("x", "y", "z")):
    """A model of which every output is a sum of the unknowns."""

    def model(**unknowns):
        return {
            ROW[i]: sum(row[j] * unknowns[name] for j, name in enumerate(unknowns))
            for i, row in enumerate(matrix)
        }

    return model


def crossing(speed_a, speed_b, restitution, friction=0.25):
    """The intersection of the examples folder, forward; courses, speeds and yaw rates after."""
    a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.1, y=-0.1, heading="0 deg", vx=speed_a)
    b = col.Vehicle(mass=1250, yaw_inertia=1900, x=0.8, y=-0.7, heading="90 deg", vy=speed_b)
    impact = col.eccentric(
        a, b, restitution, normal=0.0, point=(0.0, 0.2), friction=friction, on_failure="nan"
    )
    found = {}
    for label, car in (("a", impact.a.after), ("b", impact.b.after)):
        found |= {
            f"course_{label}_after": car.course,
            f"speed_{label}_after": car.speed,
            f"yaw_rate_{label}": car.yaw_rate,
        }
    return found


ERRORS = {"course": "3 deg", "speed": "0.5 m/s", "yaw": "15 deg/s"}
SPEEDS = {"speed_a": Interval("0 km/h", "150 km/h"), "speed_b": Interval("0 km/h", "150 km/h")}


def truth_of(model, **unknowns):
    return {
        name: float(value[0])
        for name, value in model(**{k: np.array([v]) for k, v in unknowns.items()}).items()
    }


def evidence(truth, rng=None):
    """Normal observations with units about the true values, moved by a draw of their errors."""
    found = {}
    for name, value in truth.items():
        number, unit = ERRORS[name.partition("_")[0]].split()
        size = float(number) * (DEGREE if "deg" in unit else 1.0)
        value += size * rng.standard_normal() if rng else 0.0
        unit = unit.replace("deg", "rad")
        found[name] = Normal(f"{value!r} {unit}", f"{size!r} {unit}")
    return found


# --- against what is known exactly


@pytest.mark.parametrize("freedom", [1, 2, 3, 7, 40, 300])
def test_chi_squared_tail(freedom):
    """Against the incomplete gamma function of mpmath.

    The exponent a ln x - x - lgamma(a) carries the relative error: a few eps of its largest term.
    """
    for share in (0.0, 1e-6, 0.1, 0.5, 0.9, 1.0, 1.1, 2.0, 5.0, 20.0):
        x = share * freedom
        exact = mpmath.gammainc(mpmath.mpf(freedom) / 2, mpmath.mpf(x) / 2, regularized=True)
        size = 1.0 + 0.5 * x + 0.5 * freedom * abs(math.log(0.5 * x)) if x else 1.0
        size += abs(math.lgamma(0.5 * freedom))
        assert abs(chi_squared_tail(x, freedom) - exact) <= 16 * 2.0**-52 * size * exact + 1e-300
    assert chi_squared_tail(math.inf, freedom) == 0.0


def test_chi_squared_without_freedom_is_nan():
    assert math.isnan(chi_squared_tail(1.0, 0))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("with_priors", [False, True])
def test_linear_models_follow_the_normal_equations(seed, with_priors):
    """Estimate, covariance, chi-squared and shares of a linear model, against numpy.linalg on the
    weighted rows.

    Slopes err by 1e-9, and the normal equations by the square of the condition, below 10 here,
    times that.
    """
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(5, 3)) + np.eye(5, 3) * 2.0
    values, sigma = matrix @ [3.0, -2.0, 1.0] + rng.normal(size=5) * 0.1, rng.uniform(0.05, 0.3, 5)
    unknowns = (
        {"x": Normal(2.8, 0.4), "y": 1.0, "z": Normal(1.5, 0.3)}
        if with_priors
        else {"x": 1.0, "y": 0.0, "z": Interval(-9, 9)}
    )
    rows, right = [matrix / sigma[:, None]], [values / sigma]
    if with_priors:
        rows.append([[1 / 0.4, 0, 0], [0, 0, 1 / 0.3]])
        right.append([2.8 / 0.4, 1.5 / 0.3])
    rows, right = np.vstack(rows), np.concatenate(right)
    best, (left,), *_ = np.linalg.lstsq(rows, right)
    covariance = np.linalg.inv(rows.T @ rows)
    errors = np.sqrt(np.diagonal(covariance))

    found, _ = fitted(
        linear(matrix),
        unknowns,
        {name: (v, s) for name, v, s in zip(ROW, values, sigma, strict=True)},
    )
    assert np.linalg.cond(rows / np.linalg.norm(rows, axis=0)) < 10
    assert np.all(
        abs(np.array(list(found.values.values())) - best)
        <= 1e-7 * max(1.0, math.sqrt(left)) * errors
    )
    np.testing.assert_allclose(
        found.covariance, covariance, rtol=0, atol=1e-7 * np.max(np.outer(errors, errors))
    )
    np.testing.assert_allclose(list(found.standard_errors.values()), errors, rtol=1e-7)
    assert found.chi_squared == pytest.approx(left, rel=1e-9)
    assert found.degrees_of_freedom == len(right) - 3
    assert found.p_value == pytest.approx(
        float(mpmath.gammainc(found.degrees_of_freedom / 2, left / 2, regularized=True)), rel=1e-8
    )
    assert found.nonlinearity < 1e-6
    shares = (covariance @ rows.T) ** 2 / np.diagonal(covariance)[:, None]
    for name, share in zip("xyz", shares, strict=True):
        np.testing.assert_allclose(list(found.contributions[name].values()), share, atol=1e-7)
        assert sum(found.contributions[name].values()) == pytest.approx(1.0, abs=1e-12)
    assert not found.undetermined
    assert not found.at_bounds


def test_one_observation_and_one_prior_by_hand():
    """Weights 1/0.5^2 = 4 and 1/1^2 = 1: 10 and 20 give 12, variance 1/5, chi-squared 10^2/(0.5^2 +
    1^2) = 80.
    """
    with pytest.warns(col.CollisionsWarning, match="contradicts itself") as given:
        found = fit(lambda v: {"v": v}, {"v": Normal(20, 1)}, {"v": (10, 0.5)})
    assert given[0].message.code == "contradictory"
    assert "the furthest off is the prior of v, by 8 sigma" in str(given[0].message)
    assert found["v"].value == pytest.approx(12.0, abs=1e-8)
    assert found["v"].standard_error == pytest.approx(math.sqrt(0.2), rel=1e-9)
    assert found.contributions["v"] == pytest.approx({"v": 0.8, "prior of v": 0.2}, abs=1e-9)
    assert found.chi_squared == pytest.approx(80.0, rel=1e-9)
    assert found.consistent is False
    assert found.residuals["v"].over_sigma == pytest.approx(-4.0, abs=1e-7)
    assert found.residuals["prior of v"].residual == pytest.approx(8.0, abs=1e-7)
    assert found.residuals["prior of v"].is_prior
    assert "contradicts itself" in found.statements[0]


@pytest.mark.parametrize(
    ("chance", "says", "number"),
    [
        (0.9, "agrees with itself:", "0.9"),
        (0.0501, "agrees with itself:", "0.05"),
        (
            0.0499,
            "agrees only weakly with itself, the model and the stated errors:",
            "just below 0.05",
        ),
        (0.017, "agrees only weakly with itself, the model and the stated errors:", "0.017"),
        (0.0101, "agrees only weakly with itself, the model and the stated errors:", "0.01"),
        (0.00999, "contradicts itself, the model or the stated errors:", "just below 0.01"),
        (0.004, "contradicts itself, the model or the stated errors:", "0.004"),
    ],
)
def test_a_chance_of_the_misfit_has_one_word_on_each_side_of_its_limits(chance, says, number):
    """Two readings of one speed, so far apart that their misfit has this chance: chi-squared of one
    degree of freedom by mpmath.
    """
    away = float(mpmath.sqrt(2) * mpmath.erfinv(1 - mpmath.mpf(chance))) * math.sqrt(2.0)
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        found = fit(
            lambda v: {"one": v, "two": v},
            {"v": Interval(0, 50)},
            {"one": (20.0, 1.0), "two": (20.0 + away, 1.0)},
        )
    assert found.p_value == pytest.approx(chance, rel=1e-6)
    assert (
        found.statements[0]
        == f"the evidence {says} a misfit this large or larger has a chance of {number}"
    )
    contradicts = says.startswith("contradicts")
    assert [one.message.code for one in given] == ["contradictory"] * contradicts
    assert found.consistent is not contradicts
    assert all(
        f"has a chance of {number}, and 0.01 would pass" in str(one.message) for one in given
    )


@pytest.mark.slow
def test_a_bound_that_holds():
    """Of x + y and x - y/2 with x held at 1, what is left is one unknown whose answer is a weighted
    mean.

    Unconstrained x would be 3: so the gradient points out. The covariance stays that without the
    bound.
    """
    matrix = np.array([[1.0, 1.0], [1.0, -0.5]])
    values = matrix @ [3.0, 2.0]
    found, codes = fitted(
        linear(matrix),
        {"x": Interval(0.0, 1.0), "y": 0.5},
        {"o0": (values[0], 0.5), "o1": (values[1], 0.5)},
    )
    column = matrix[:, 1]
    assert found.values["x"] == 1.0
    assert found.values["y"] == pytest.approx(
        column @ (values - matrix[:, 0]) / (column @ column), abs=1e-7
    )
    assert found.at_bounds == {"x": "high"}
    assert found["x"].at_bound == "high"
    np.testing.assert_allclose(found.covariance, 0.25 * np.linalg.inv(matrix.T @ matrix), rtol=1e-7)
    # The best y follows x, so that chi-squared is a parabola of x about 3.
    curve = (matrix[:, 0] - column * (column @ matrix[:, 0]) / (column @ column)) / 0.5
    misfit = math.sqrt(found.chi_squared + 1.959964**2) / np.linalg.norm(curve)
    low, high = found["x"].interval(0.95)
    assert (low, high) == (pytest.approx(3.0 - misfit, abs=1e-3), 1.0)
    assert found.degrees_of_freedom == 1
    assert any(
        "x ended on its high bound" in sentence and "below only" in sentence
        for sentence in found.statements
    )
    assert codes == ["contradictory"]


def test_truncation_of_a_prior_bounds_the_search():
    """The prior counts as given, not as truncated: with mean 1.0 and bounds up to 2, an observation
    5 ends at 2.
    """
    found, _ = fitted(
        lambda x: {"x": x}, {"x": Normal(1.0, 2.0, truncate=(None, 2.0))}, {"x": (5.0, 2.0)}
    )
    assert found.values["x"] == 2.0
    assert found.chi_squared == pytest.approx(0.25 + 2.25, abs=1e-12)
    assert found.bounds["x"] == (-math.inf, 2.0)


def test_a_start_far_too_small_is_left_behind():
    """An energy of 100 kJ known to a tenth, sought from 1 J, where a joule changes the evidence by
    1e-4 sigma.
    """
    found, codes = fitted(lambda energy: {"o": 1e-4 * energy}, {"energy": 1.0}, {"o": (10.0, 1.0)})
    assert found.values["energy"] == pytest.approx(1e5, rel=1e-7)
    assert found["energy"].standard_error == pytest.approx(1e4, rel=1e-7)
    assert codes == []


# --- scenes


def test_an_intersection_comes_back():
    """Evidence made forward from 15 and 12 m/s, e = 0.1: back to within 1e-6 of the standard
    errors.
    """
    true = {"speed_a": 15.0, "speed_b": 12.0, "restitution": 0.1}
    found, codes = fitted(
        crossing, SPEEDS | {"restitution": Uniform(0, 1)}, evidence(truth_of(crossing, **true))
    )
    for name, value in true.items():
        assert abs(found[name].value - value) <= 1e-6 * found[name].standard_error
    assert found.chi_squared < 1e-12
    assert found.consistent is True
    assert codes == []


def test_rest_positions_with_a_drag_factor_they_share():
    """Run-outs of 7 and 13 m with one uncertain drag factor: travel and impact in one model,
    everything fitted together.
    """

    def model(speed_a, speed_b, drag):
        after = crossing(speed_a, speed_b, 0.1)
        slack = {
            f"slack_{s}": travel.speed(d, drag=drag) - after[f"speed_{s}_after"]
            for s, d in (("a", 6.5), ("b", 12.0))
        }
        return slack | {name: after[name] for name in ("course_a_after", "course_b_after")}

    true = {"speed_a": 15.0, "speed_b": 12.0}
    after = truth_of(lambda **x: crossing(restitution=0.1, **x), **true)
    drag = after["speed_a_after"] ** 2 / (2 * 9.80665 * 6.5)
    observed = {name: value for name, value in evidence(after).items() if name.startswith("course")}
    observed |= {
        "slack_a": (0.0, 0.3),
        "slack_b": (travel.speed(12.0, drag=drag) - after["speed_b_after"], 0.3),
    }
    found, codes = fitted(
        model, SPEEDS | {"drag": Normal(drag, 0.07, truncate=(0, None))}, observed
    )
    for name, value in (true | {"drag": drag}).items():
        assert abs(found[name].value - value) <= 1e-6 * found[name].standard_error
    # The drag factor moves both run-out speeds alike, so the impact speeds rise together.
    assert found.correlation["speed_a", "drag"] > 0.0
    assert codes == []


OBLIQUE = {
    "4363": {
        "weights": (3451.1, 4695.4), "inertias": (2152, 2805), "headings": (180, 32),
        "speeds": (35.1, 35.0),
        "arms": ((2.6, 23.8), (5.7, 10.6)), "normal": 55, "e": 0.126,
        "published": {"delta_v_a": 39.5, "delta_v_b": 29.1, "spin_a": -31, "spin_b": 182},
    },
    "4474": {
        "weights": (3305.7, 4657), "inertias": (2066, 2863), "headings": (180, 31.6),
        "speeds": (35.0, 35.0),
        "arms": ((2.9, 34.7), (5.5, 15.2)), "normal": 51.8, "e": 0.15,
        "published": {"delta_v_a": 40.5, "delta_v_b": 28.7, "spin_a": 40, "spin_b": 194},
    },
}  # fmt: skip


@pytest.mark.parametrize("test", OBLIQUE)
def test_published_oblique_crash_tests(test):
    """NHTSA 4363 and 4474 after Rose, Fenton and Beauchamp (SAE 2006-01-0908): speeds and
    restitution from the printed delta-V and yaw.

    Printed to 0.1 mph and 1 deg/s, so with errors of 0.1/sqrt(12) and 1/sqrt(12); the arms were
    printed to 0.1 ft and 0.1 deg, which moves the yaw rates by about 2 deg/s, so that is their
    error here. The printed speeds and restitution, themselves rounded (to 0.05 mph, 0.0005), must
    lie within three standard errors. The sign of spin_a of 4363 is misprinted in the source.
    """
    case = OBLIQUE[test]
    places = []
    for heading, (arm, angle) in zip(case["headings"], case["arms"], strict=True):
        where = (heading + angle) * DEGREE
        places.append((-0.3048 * arm * math.cos(where), -0.3048 * arm * math.sin(where)))

    def model(speed_a, speed_b, restitution):
        cars = [
            col.Vehicle.from_speed(
                speed=speed,
                course=f"{heading} deg",
                mass=POUND * weight,
                yaw_inertia=SLUG_FOOT * inertia,
                x=x,
                y=y,
            )
            for speed, heading, weight, inertia, (x, y) in zip(
                (speed_a, speed_b),
                case["headings"],
                case["weights"],
                case["inertias"],
                places,
                strict=True,
            )
        ]
        normal = f"{case['normal'] + 180} deg"
        impact = col.eccentric(
            *cars,
            restitution,
            normal=normal,
            point=(0.0, 0.0),
            critical_fraction=1.0,
            on_failure="nan",
        )
        return {
            "delta_v_a": impact.a.delta_v,
            "delta_v_b": impact.b.delta_v,
            "spin_a": impact.a.delta_yaw_rate,
            "spin_b": impact.b.delta_yaw_rate,
        }

    observed = {
        name: Normal(f"{value} mph", f"{0.1 / math.sqrt(12)} mph")
        if name.startswith("delta")
        else Normal(f"{value} deg/s", "2 deg/s")
        for name, value in case["published"].items()
    }
    unknowns = {"speed_a": Interval("0 mph", "80 mph"), "speed_b": Interval("0 mph", "80 mph")}
    found, codes = fitted(
        model, unknowns | {"restitution": Normal(case["e"], 0.02, truncate=(0, 1))}, observed
    )
    true = {
        "speed_a": MPH * case["speeds"][0],
        "speed_b": MPH * case["speeds"][1],
        "restitution": case["e"],
    }
    for name, value in true.items():
        assert abs(found[name].value - value) <= 3.0 * found[name].standard_error
    assert found.consistent
    assert codes == []
    (direction,) = found.undetermined
    assert direction.held_by_prior
    # Four delta-Vs and yaw rates are the work of two components of one impulse: three unknowns are
    # one too many.
    _, codes = fitted(model, unknowns | {"restitution": Uniform(0, 1)}, observed)
    assert "undetermined" in codes


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say():
    """64 simulated scenes: 95 and 68.27 percent intervals, chi-squared and its chances, within
    binomial error.

    Three binomial standard deviations. The restitution is in the middle, so that bounds, which make
    intervals surer, do not act.
    """
    true, rng, count = (
        {"speed_a": 15.0, "speed_b": 12.0, "restitution": 0.35},
        np.random.default_rng(20),
        64,
    )
    exact = truth_of(crossing, **true)
    inside = {0.95: dict.fromkeys(true, 0), 0.6827: dict.fromkeys(true, 0)}
    misfits, chances = [], []
    for _ in range(count):
        found, _ = fitted(crossing, SPEEDS | {"restitution": Uniform(0, 1)}, evidence(exact, rng))
        misfits.append(found.chi_squared)
        chances.append(found.p_value)
        for coverage, hits in inside.items():
            for name, value in true.items():
                low, high = found[name].interval(coverage)
                hits[name] += low <= value <= high
    for coverage, hits in inside.items():
        for hit in hits.values():
            assert abs(hit - count * coverage) <= 3.0 * math.sqrt(
                count * coverage * (1.0 - coverage)
            )
    assert found.degrees_of_freedom == 3
    assert abs(np.mean(misfits) - 3.0) <= 3.0 * math.sqrt(2.0 * 3.0 / count)
    for share in (0.1, 0.5, 0.9):
        assert abs(np.mean(np.array(chances) < share) - share) <= 3.0 * math.sqrt(
            share * (1.0 - share) / count
        )


# --- what the evidence does not determine


def central(speed_a, speed_b):
    impact = col.linear_central(
        col.Vehicle(mass=1500, vx=speed_a),
        col.Vehicle(mass=1000, vx=speed_b),
        0.2,
        on_failure="nan",
    )
    return {"delta_v_a": impact.a.delta_v, "delta_v_b": impact.b.delta_v}


DELTA_V = {"delta_v_a": ("4.8 m/s", "0.2 m/s"), "delta_v_b": ("7.2 m/s", "0.3 m/s")}


def test_delta_v_determines_only_the_closing_speed():
    """In line, delta-V does not say how fast both went: only (+1, +1) is not determined, and no
    number is made of it.
    """
    found, codes = fitted(
        central, {"speed_a": Interval(0, 40), "speed_b": Interval(-40, 40)}, DELTA_V
    )
    assert codes == ["undetermined"]
    (direction,) = found.undetermined
    assert direction.changes["speed_a"] == pytest.approx(direction.changes["speed_b"], rel=1e-6)
    assert not direction.held_by_prior
    assert "speed_a by +1 together with speed_b by +1" in direction.sentence
    assert all(math.isnan(value) for value in found.values.values())
    assert list(found.standard_errors.values()) == [math.inf, math.inf]
    assert np.isnan(found.covariance[0, 1])
    assert found["speed_b"].interval(0.95) == (-40.0, 40.0)
    assert not found["speed_b"].determined
    assert found.degrees_of_freedom == 1
    for what in ("inputs", "correlation"):
        with pytest.raises(
            col.NoSolutionError, match="nothing determines speed_a, speed_b"
        ) as refused:
            getattr(found, what)
        assert refused.value.code == "undetermined"


def test_a_prior_settles_what_the_evidence_does_not():
    """With a standing car B known to 0.5 m/s: closing speed from both delta-Vs, and the variances
    add.

    delta_v_a = 0.4 x 1.2 x closing and delta_v_b = 0.6 x 1.2 x closing, with errors in the same
    proportion: both give a closing speed of 10 with an error of 0.2/0.48.
    """
    found, codes = fitted(
        central, {"speed_a": Interval(0, 40), "speed_b": Normal(0.0, 0.5)}, DELTA_V
    )
    assert codes == []
    (direction,) = found.undetermined
    assert direction.held_by_prior
    assert "rests on what was stated before" in direction.sentence
    closing = (0.2 / 0.48) ** 2 / 2.0
    assert found.values["speed_a"] == pytest.approx(10.0, abs=1e-6)
    np.testing.assert_allclose(found.covariance, [[closing + 0.25, 0.25], [0.25, 0.25]], rtol=1e-7)


def bent(v, spare=0.0):
    """A way whose middle is far from both ends, of which ``path`` warns, and an unknown that it
    does not depend on.
    """
    way = [(0, 0), (6, -1.6), (12, -2.3)]
    return {"y": travel.path(way, [0.0, 2.0, 3.5], friction=0.7, lock=v).q.speed + 0.0 * spare}


@pytest.mark.slow
def test_an_unknown_that_nothing_determines_does_not_silence_the_model():
    """The model gives the same warning whatever the spare unknown is."""
    with pytest.warns(col.OutOfRangeWarning):
        at = float(bent(0.3)["y"].magnitude)
    alone, codes = fitted(bent, {"v": Interval(0.1, 0.9)}, {"y": (at, 0.1)})
    assert codes == ["wide_segment", "fast_yaw"]
    unknowns = {"v": Interval(0.1, 0.9), "spare": Uniform(0.0, 1.0)}
    found, codes = fitted(bent, unknowns, {"y": (at, 0.1)})
    assert math.isnan(found.values["spare"])
    assert sorted(codes) == ["fast_yaw", "undetermined", "wide_segment"]
    for note, other in zip(found.model_notes, alone.model_notes, strict=True):
        assert note.fields["share"] == 1.0
        assert note.sentence.endswith(other.sentence)
        assert note.statement in found.statements


def test_a_warning_of_some_values_that_nothing_determines_is_kept():
    """Half of the values of the spare unknown are warned of, and the search starts at either."""

    def model(v, spare):
        way = [(0, 0), (6, -1.6), (12, -2.3)]
        some = np.asarray(spare) > 0.5
        if np.any(some):
            travel.path(way, [0.0, 2.0, 3.5], friction=0.7, lock=np.asarray(v)[some])
        return {"y": 2.0 * v}

    found, _ = fitted(model, {"v": Interval(0.1, 0.9), "spare": Uniform(0, 1)}, {"y": (0.8, 0.1)})
    assert "wide_segment" in [note.code for note in found.model_notes]


@pytest.mark.slow
def test_the_answers_of_an_ambiguous_fit_have_the_warnings_of_the_model():
    def model(v):
        bent(np.clip(np.abs(v), 0.1, 0.9))
        return {"square": v * v}

    with pytest.raises(col.AmbiguousSolutionError) as refused:
        fit(model, {"v": Interval(-0.9, 0.9)}, {"square": (0.25, 0.01)})
    assert len(refused.value.solutions) == 2
    for one in refused.value.solutions:
        assert "wide_segment" in [note.code for note in one.model_notes]


def test_friction_that_does_not_act_is_named():
    """Head-on through both centres of mass nothing slips: friction is not determined, the speeds
    are.
    """

    def model(speed_a, friction):
        a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2, y=0, vx=speed_a)
        b = col.Vehicle(mass=1250, yaw_inertia=1900, x=2, y=0)
        impact = col.eccentric(
            a, b, 0.1, normal=0.0, point=(0, 0), friction=friction, on_failure="nan"
        )
        return {"vx_a": impact.a.after.vx, "vx_b": impact.b.after.vx, "vy_b": impact.b.after.vy}

    at = truth_of(model, speed_a=14.0, friction=0.4)
    found, codes = fitted(
        model,
        {"speed_a": 10.0, "friction": Interval(0, 1)},
        {name: (value, 0.3) for name, value in at.items()},
    )
    assert codes == ["undetermined"]
    assert [one.unknowns for one in found.undetermined] == [("friction",)]
    assert (
        found.undetermined[0].sentence
        == "friction is not determined by the evidence, and no prior settles it"
    )
    assert math.isnan(found.values["friction"])
    assert found.values["speed_a"] == pytest.approx(14.0, abs=1e-6)
    # Slopes: m_a (1 + e)/m of both; by hand.
    slopes = np.array([1.0 - 1250 * 1.1 / 2750, 1500 * 1.1 / 2750])
    assert found["speed_a"].standard_error == pytest.approx(0.3 / math.hypot(*slopes), rel=1e-7)
    assert np.isnan(found.correlation_matrix[0, 1])
    assert found.correlation_matrix[0, 0] == 1.0
    assert found.contributions["friction"] == {}


def test_fewer_observations_than_unknowns():
    """One observation of x + y and one of z: z is answered, x and y are not."""
    matrix = [[1.0, 1.0, 0.0], [0.0, 0.0, 2.0]]
    found, codes = fitted(
        linear(matrix), {"x": 1.0, "y": 1.0, "z": 1.0}, {"o0": (3.0, 0.1), "o1": (4.0, 0.2)}
    )
    assert found.values["z"] == pytest.approx(2.0, abs=1e-8)
    assert found["z"].standard_error == pytest.approx(0.1, rel=1e-8)
    assert [sorted(one.unknowns) for one in found.undetermined] == [["x", "y"]]
    assert math.isnan(found.p_value)
    assert found.consistent is None
    assert found.degrees_of_freedom == 0
    assert "nothing checks it" in found.statements[0]
    assert codes == ["undetermined"]


# --- more than one answer, and none


@pytest.mark.slow
def test_two_answers_are_both_given():
    """A square has two roots."""
    with pytest.raises(
        col.AmbiguousSolutionError, match=r"2 answers fit the evidence about as well"
    ) as refused:
        fit(lambda x: {"square": x**2}, {"x": Interval(-3, 3)}, {"square": (4.0, 0.1)})
    assert refused.value.code == "ambiguous"
    assert sorted(round(one.values["x"], 6) for one in refused.value.solutions) == [-2.0, 2.0]
    assert refused.value.solutions[0]["x"].standard_error == pytest.approx(0.1 / 4.0, rel=1e-6)
    one = fit(lambda x: {"square": x**2}, {"x": Interval(0, 3)}, {"square": (4.0, 0.1)})
    assert one.values["x"] == pytest.approx(2.0, abs=1e-8)


@pytest.mark.slow
def test_two_answers_within_three_standard_errors_are_two_as_well():
    """The roots of a coarse square, 2 and -2 with errors of 1.5 each: neither is preferred, and the
    ridge between is no answer.
    """
    with pytest.raises(col.AmbiguousSolutionError) as refused:
        fit(lambda x: {"square": x**2}, {"x": Interval(-3, 3)}, {"square": (4.0, 6.0)})
    assert sorted(round(one.values["x"], 6) for one in refused.value.solutions) == [-2.0, 2.0]


@pytest.mark.slow
@pytest.mark.parametrize("high", [10.0, 12.0])
def test_a_turning_point_that_fits_as_well_is_a_second_answer(high):
    """(x - 3)^2 (x - 9)/10 - 0.5 turns at x = 3, half a sigma below what was observed, and meets it
    at one place, above 9.

    From 2 to 4 it is within 1.1 sigma: the root alone, 9.13 with an error of 0.25, would be a wrong
    number. The slope at the turning point gives no error.
    """
    with pytest.raises(col.AmbiguousSolutionError) as refused:
        fit(
            lambda x: {"o": (x - 3.0) ** 2 * (x - 9.0) / 10.0 - 0.5},
            {"x": Interval(0, high)},
            {"o": (0.0, 1.0)},
        )
    root, turning = refused.value.solutions
    (real,) = (one.real for one in np.roots([1.0, -15.0, 63.0, -86.0]) if abs(one.imag) < 1e-9)
    assert root.values["x"] == pytest.approx(real, abs=1e-6)
    assert turning.chi_squared == pytest.approx(0.25, abs=1e-6)
    assert math.isnan(turning.values["x"])


BROKEN = {
    "a kink": lambda x: np.where(x < 5, x, np.where(x < 6, 5 - 3 * (x - 5), 2 + (x - 6))),
    "a jump": lambda x: np.where(x < 5, x, x - 3),
    "a refusal": lambda x: np.where(x < 5, x, np.where(x < 7, np.nan, x - 4)),
}


@pytest.mark.slow
@pytest.mark.parametrize("broken", BROKEN)
@pytest.mark.parametrize("above", [0.001, 0.02, 0.08])
@pytest.mark.parametrize("second", [False, True])
def test_an_answer_where_the_model_bends_jumps_or_refuses_is_a_second_one(broken, above, second):
    """No search converges at 5, which misses what was read by so little."""
    far = {"a kink": 9.0, "a jump": 8.0, "a refusal": 9.0}[broken] + above

    def model(x, y=0.0):
        return {"v": BROKEN[broken](x) + y}

    unknowns = {"x": Interval(0.0, 10.0)} | ({"y": Normal(0.0, 0.01)} if second else {})
    with pytest.raises(col.AmbiguousSolutionError) as refused:
        fit(model, unknowns, {"v": (5.0 + above, 0.05)})
    one, other = refused.value.solutions
    assert one["x"].value == pytest.approx(far, abs=1e-5)
    assert other["x"].value == pytest.approx(5.0, abs=1e-3)
    least = (above / 0.05) ** 2 if not second else above**2 / (0.05**2 + 0.01**2)
    assert other.chi_squared == pytest.approx(least, abs=2e-3)
    # Its own range, from where the misfit is higher by 3.84 to the break or just beyond.
    low, high = other["x"].interval(0.95)
    if not second:
        rise = 0.05 * math.sqrt(least + 1.95996**2)
        assert low == pytest.approx(5.0 + above - rise, abs=2e-3)
        slope = 1.0 / 3.0 if broken == "a kink" else 0.0
        assert high == pytest.approx(5.0 + slope * (rise - above), abs=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("broken", BROKEN)
def test_a_break_that_the_evidence_rules_out_is_no_answer(broken):
    above = 0.15  # three errors
    far = {"a kink": 9.0, "a jump": 8.0, "a refusal": 9.0}[broken] + above
    found = fit(
        lambda x: {"v": BROKEN[broken](x)}, {"x": Interval(0.0, 10.0)}, {"v": (5.0 + above, 0.05)}
    )
    assert found["x"].value == pytest.approx(far, abs=1e-6)
    assert found["x"].interval(0.95) == pytest.approx((far - 0.098, far + 0.098), abs=1e-3)


def test_a_rival_that_the_evidence_rules_out_is_none():
    """The other root misses the second observation by 40 sigma."""

    def model(x):
        return {"square": x**2, "itself": x}

    assert fit(model, {"x": Interval(-3, 3)}, {"square": (4.0, 0.1), "itself": (2.0, 0.1)}).values[
        "x"
    ] == pytest.approx(2.0)


@pytest.mark.slow
def test_sliding_or_sticking():
    """Friction just below the critical 0.418: the evidence fits sliding, and nearly as well any
    friction that sticks.

    An answer of sliding alone, 0.40 with an error of 0.02, would be a wrong number for every
    contact that stuck. They are one range: nothing between them is excluded.
    """
    unknowns = SPEEDS | {"restitution": Uniform(0, 1), "friction": Interval(0, 1)}
    true = {"speed_a": 15.0, "speed_b": 12.0, "restitution": 0.1, "friction": 0.4}
    observed = evidence(truth_of(crossing, **true))
    found, codes = fitted(crossing, unknowns, observed)
    assert codes == []
    assert found.values["friction"] == pytest.approx(0.4, abs=1e-6)
    (sticking,) = found.others
    assert [one.unknowns for one in sticking.undetermined] == [("friction",)]
    low, high = found["friction"].interval(0.95)
    assert 0.3 < low < 0.4 < high == 1.0
    for name in true:
        low, high = found[name].interval(0.95)
        assert low <= true[name] <= high
    # Every contact that stuck and fits is within the ranges.
    stuck, _ = fitted(crossing, unknowns | {"friction": Interval(0.45, 1)}, observed)
    for name in ("speed_a", "speed_b"):
        low, high = found[name].interval(0.95)
        assert low < stuck[name].value < high
    low = fit(crossing, unknowns | {"friction": Interval(0, 0.41)}, observed)
    assert low.values["friction"] == pytest.approx(0.4, abs=1e-6)


@pytest.mark.slow
@pytest.mark.slow
def test_a_direction_is_told_of_the_unknown_that_moves_most_along_it():
    """Beside their errors: the speed, which delta-V tells, moves by little with the normal and the
    point, which nothing tells apart.
    """
    a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.1, y=0.0, heading=0.0, vx=15.0)
    b = col.Vehicle(mass=1300, yaw_inertia=2000, x=2.1, y=0.0, heading=0.0, vx=5.0)

    def model(va, turn, aside):
        impact = col.eccentric(
            a.replace(vx=va), b, 0.15, normal=turn, point=(0.0, aside), friction=0.5,
            on_failure="nan",
        )  # fmt: skip
        return {"pdof": impact.b.q.pdof, "delta_v": impact.b.q.delta_v}

    unknowns = {"va": Interval("8 m/s", "25 m/s"), "turn": Normal("0 deg", "3 deg")}
    unknowns |= {"aside": Normal("0 m", "0.1 m")}
    observed = {"pdof": Normal("-178 deg", "3 deg"), "delta_v": Normal("6 m/s", "0.3 m/s")}
    found, _ = fitted(model, unknowns, observed)
    (direction,) = found.undetermined
    assert direction.unknowns[-1] == "va"
    assert "a change of turn by +1 together with aside by" in direction.sentence


@pytest.mark.slow
def test_sticking_leaves_friction_undetermined():
    """Evidence of a contact that stuck: friction is named, the rest answered."""
    true = {"speed_a": 15.0, "speed_b": 12.0, "restitution": 0.1}
    observed = evidence(truth_of(crossing, **true, friction=0.7))
    found, codes = fitted(
        crossing, SPEEDS | {"restitution": Uniform(0, 1), "friction": Interval(0, 1)}, observed
    )
    assert [one.unknowns for one in found.undetermined] == [("friction",)]
    assert codes == ["undetermined"]
    for name, value in true.items():
        assert found.values[name] == pytest.approx(value, abs=1e-6)


def test_the_model_refuses_everywhere():
    """A moves away from B at any speed of the interval: the refusal says what the model says of a
    single case.
    """

    def model(speed_a):
        impact = col.linear_central(col.Vehicle(mass=1500, vx=speed_a), col.Vehicle(mass=1000), 0.2)
        return {"delta_v_b": impact.b.delta_v}

    with pytest.raises(
        col.NoSolutionError, match=r"refuses all \d+ points .* speed_a = -15: .*closing speed"
    ) as refused:
        fit(model, {"speed_a": Interval(-20, -10)}, {"delta_v_b": (5.0, 1.0)})
    assert refused.value.code == "refused"
    found = fit(model, {"speed_a": Interval(-40, 40)}, {"delta_v_b": (7.2, 0.3)})
    assert found.values["speed_a"] == pytest.approx(10.0, abs=1e-6)


@pytest.mark.slow
def test_places_too_rare_for_the_searches_are_for_the_posterior():
    """Answers only from 0.7013 to 0.7101 of the range, where none of 64 starts lies: the posterior
    finds them.
    """

    def model(x):
        return {"x": np.where((x > 0.7013) & (x < 0.7101), x, np.nan)}

    with pytest.raises(
        col.NoSolutionError,
        match=r"refuses all 64 points.*reconstruct\.posterior finds rare ones too",
    ) as refused:
        fit(model, {"x": Interval(0, 1)}, {"x": (0.705, 0.001)})
    assert refused.value.code == "refused"
    found = reconstruct.posterior(
        model, {"x": Uniform(0, 1)}, {"x": (0.705, 0.001)}, samples=1024, seed=1
    )
    assert abs(found["x"].mean - 0.705) < 5.0 * found["x"].mean_standard_error + 1e-5


@pytest.mark.slow
@pytest.mark.parametrize(
    "model",
    [
        lambda x: {"o": 1.0 + abs(x)},
        lambda x: {"o": np.where(x < 0.3, 2.0 - x, 3.0 + x)},
        lambda x: {"o": np.where(x > 0.25, 1.0 + x, np.nan)},
        lambda x: {"o": x**2},
    ],
)
def test_an_end_that_is_no_minimum_is_refused(model):
    """At a bend back, a jump, a turning point or the edge of what the model answers, no error could
    be given.
    """
    with pytest.raises(
        col.NoSolutionError, match=r"jumps, bends, turns round or refuses.*reconstruct\.posterior"
    ) as refused:
        fit(model, {"x": Interval(-1, 2)}, {"o": (0.0, 1.0)})
    assert refused.value.code == "no_convergence"
    assert set(refused.value.fields["at"]) == {"x"}


def score(coverage):
    """How many sigma to either side hold this probability."""
    return NormalDist().inv_cdf(0.5 * (1.0 + coverage))


@pytest.mark.slow
@pytest.mark.parametrize("coverage", [0.5, 0.8, 0.95, 0.99, 0.999])
def test_a_kink_has_the_range_in_which_chi_squared_rises_by_less(coverage):
    """1 + |x| + 0.3 x is observed as 0: chi-squared is its square, and rises by z^2 where it is
    sqrt(1 + z^2).
    """
    found, codes = fitted(
        lambda x: {"o": 1.0 + abs(x) + 0.3 * x}, {"x": Interval(-9, 9)}, {"o": (0.0, 1.0)}
    )
    assert codes == []
    rise = math.sqrt(1.0 + score(coverage) ** 2) - 1.0
    assert found["x"].value == pytest.approx(0.0, abs=1e-3)
    assert found["x"].interval(coverage) == pytest.approx([-rise / 0.7, rise / 1.3], rel=0.02)


def eccentric_crash(speed_a, speed_b):
    """Delta-v of both, what A does after and where B goes, and the energy, in SI."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, x=-2.2, y=0.0, heading=0.0, vx=speed_a)
    b = col.Vehicle(mass=1200.0, yaw_inertia=2000.0, x=0.9, y=-0.8, heading=1.57, vy=speed_b)
    impact = col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.4, on_failure="nan")
    return {
        "delta_v_a": impact.a.delta_v,
        "delta_v_b": impact.b.delta_v,
        "yaw_rate_a": impact.a.after.yaw_rate,
        "speed_a_after": impact.a.after.speed,
        "course_a": impact.a.after.course,
        "course_b": impact.b.after.course,
        "energy": impact.energy_loss,
    }


@pytest.mark.slow
@pytest.mark.parametrize(
    "observed",
    [
        {
            "yaw_rate_a": (5.31622568, 0.25688933),
            "course_a": (0.30340881, 0.07706680),
            "course_b": (0.83962289, 0.07706680),
        },
        {
            "delta_v_b": (11.93736532, 0.73115143),
            "yaw_rate_a": (4.39983253, 0.24371715),
            "course_b": (0.82579399, 0.07311514),
        },
        {
            "yaw_rate_a": (3.00151594, 0.18558965),
            "speed_a_after": (7.67021852, 0.55676896),
            "energy": (85545.85332497, 5567.68961155),
        },
        {
            "delta_v_a": (5.29497419, 0.24249392),
            "delta_v_b": (6.03742242, 0.24249392),
            "energy": (50537.65638824, 2424.93923455),
        },
        {
            "delta_v_a": (7.78923682, 0.27453302),
            "delta_v_b": (9.48457118, 0.27453302),
            "energy": (106365.07160201, 2745.33022897),
        },
        {
            "delta_v_a": (5.69777828, 0.51255791),
            "yaw_rate_a": (2.88387283, 0.17085264),
            "course_b": (0.71192615, 0.05125579),
        },
    ],
)
def test_ranges_beyond_a_kink_end_where_chi_squared_rises_by_so_much(observed):
    """The least chi-squared over a fine grid of the other speed passes 3.84 above the best within
    3 percent of the width from each end.
    """
    found, _ = fitted(
        lambda **speeds: {name: eccentric_crash(**speeds)[name] for name in observed},
        {"speed_a": Interval(0, 40), "speed_b": Interval(0, 40)},
        observed,
    )
    grid = np.linspace(0.0, 40.0, 8001)

    def rise(name, value):
        other = {"speed_a": "speed_b", "speed_b": "speed_a"}[name]
        computed = eccentric_crash(**{name: np.full_like(grid, value), other: grid})
        chi_squared = sum(
            ((computed[row] - mean) / sigma) ** 2 for row, (mean, sigma) in observed.items()
        )
        return np.nanmin(chi_squared) - found.chi_squared

    for name in found.names:
        low, high = found[name].interval(0.95)
        near = 0.03 * (high - low)
        for end, way in ((low, -near), (high, near)):
            assert rise(name, end - way) < score(0.95) ** 2 < rise(name, end + way)


@pytest.mark.slow
@pytest.mark.parametrize("coverage", [0.8, 0.95, 0.99])
def test_a_model_that_bends_has_the_range_in_which_chi_squared_rises_by_less(coverage):
    """The square of 0.5 known to 0.15: its root, up to z errors of the square off; the standard
    error is of a straight line, and the result says that it is rough.
    """
    found, codes = fitted(
        lambda x: {"square": x**2}, {"x": Interval(0.0, 3)}, {"square": (0.25, 0.15)}
    )
    assert codes == []
    assert found.nonlinearity > 0.2
    assert any(
        "the model bends within two standard errors" in sentence for sentence in found.statements
    )
    ends = [math.sqrt(max(0.0, 0.25 + way * 0.15 * score(coverage))) for way in (-1.0, 1.0)]
    assert found["x"].interval(coverage) == pytest.approx(ends, abs=0.004)


@pytest.mark.slow
@pytest.mark.parametrize("coverage", [0.5, 0.68, 0.8, 0.9, 0.95, 0.99])
def test_every_probability_has_its_own_range_where_the_model_bends_hard(coverage):
    """exp(x) of 1 known to 0.6: its logarithm, z errors off, is -4.34 at 90 percent and beyond the
    bound at 95. Ends that are fitted are right to a thousandth of the half-width, and those of 68
    percent, between them, to a hundredth.
    """
    found, _ = fitted(lambda x: {"y": np.exp(x)}, {"x": Interval(-5.0, 5.0)}, {"y": (1.0, 0.6)})
    off = 0.6 * score(coverage)
    exact = (math.log(1.0 - off) if off < 1.0 else -5.0, math.log(1.0 + off))
    near = (0.01 if coverage == 0.68 else 0.001) * 0.5 * (exact[1] - exact[0])
    assert found["x"].interval(coverage) == pytest.approx(exact, abs=near)


@pytest.mark.slow
def test_ranges_of_higher_probabilities_hold_those_of_lower_ones():
    """Also where several valleys make up a range."""
    unknowns = {"x": Interval(-3, 3), "y": Interval(-3, 5)}
    found, _ = fitted(
        lambda x, y: {"o": 10.0 * (y - x * x), "x": x},
        unknowns,
        {"o": (0.0, 0.01), "x": (1.0, 0.5)},
    )
    low, high = np.array([found["y"].interval(p) for p in np.linspace(0.01, 0.999, 200)]).T
    assert np.all(np.diff(low) <= 0.0)
    assert np.all(np.diff(high) >= 0.0)


@pytest.mark.slow
def test_a_valley_that_bends_has_the_range_of_its_floor():
    """y meets x^2 and x is 1 with an error of 1: the range of y is the square of that of x."""

    def valley(x, y):
        return {"o": 10.0 * (y - x * x), "x": x}

    unknowns = {"x": Interval(-3, 3), "y": Interval(-3, 5)}
    found, codes = fitted(valley, unknowns, {"o": (0.0, 0.01), "x": (1.0, 0.5)})
    assert codes == []
    assert found["x"].interval(0.95) == pytest.approx([0.02, 1.98], abs=0.01)
    low, high = found["y"].interval(0.95)
    assert low == pytest.approx(0.0, abs=0.02)
    assert high == pytest.approx(1.98**2, rel=0.02)
    assert found.nonlinearity > 0.2


@pytest.mark.slow
def test_a_model_that_refuses_within_its_errors_warns():
    """A root known to end a standard error below the estimate."""
    found, codes = fitted(
        lambda x: {"x": np.where(x > 0.9, x, np.nan)}, {"x": Interval(0.0, 3)}, {"x": (1.0, 0.1)}
    )
    assert codes == ["not_linear"]
    assert math.isnan(found.nonlinearity)


# --- bounds within the errors, and turning points on them


def square(a):
    return {"o": a**2}


@pytest.mark.slow
def test_a_bound_within_two_errors_is_looked_at_too():
    """The square of 0.1 known to 0.1: an error of 0.5, so 0.2 errors to 0 and 1.8 to 1.

    Chi-squared rises there by 0.1^2 and 9.9^2, so the errors are off by |0.2/0.1 - 1| = 1 and
    |1.8/9.9 - 1| = 0.82.
    """
    found, codes = fitted(square, {"a": Interval(0, 1)}, {"o": (0.01, 0.1)})
    assert codes == []
    assert found["a"].interval(0.95) == (0.0, pytest.approx(math.sqrt(0.01 + 0.195996), abs=0.01))
    assert found.nonlinearity == pytest.approx(1.0, abs=1e-6)
    assert found["a"].standard_error == pytest.approx(0.5, rel=1e-6)


@pytest.mark.parametrize(
    ("model", "unknown", "observed", "code"),
    [
        (lambda a: {"o": np.where(a > 0.9, a, np.nan)}, Interval(0, 3), (1.0, 0.1), "not_linear"),
        (lambda a: {"o": a}, Interval(0, 1), (0.4, 5.0), "told_by_bounds"),
        (lambda a: {"o": 0.0 * a}, Interval(0, 1), (0.0, 0.1), "undetermined"),
    ],
)
def test_every_warning_of_rough_errors_names_the_posterior(model, unknown, observed, code):
    with pytest.warns(col.IllConditionedWarning, match=r"reconstruct\.posterior") as given:
        fit(model, {"a": unknown}, {"o": observed})
    assert [one.message.code for one in given] == [code]


def test_an_error_wider_than_the_bounds_is_said():
    """A straight model that gives 0.4 to 5 within 0 and 1: nothing bends, but the bounds say more
    than the evidence.
    """
    found, codes = fitted(linear([[1.0]], "a"), {"a": Interval(0, 1)}, {"o0": (0.4, 5.0)})
    assert codes == ["told_by_bounds"]
    assert found.nonlinearity < 1e-6
    assert found.told_by_bounds == ("a",)
    assert any(
        "the evidence excludes no value of a within its bounds" in sentence
        for sentence in found.statements
    )
    assert found["a"].interval(0.95) == (0.0, 1.0)


@pytest.mark.parametrize("unknown", [Interval(-1, 9), 1.0])
def test_slopes_that_vanish_close_by_are_refused(unknown):
    """The square of nothing, known to 0.1, off the bounds: the search ends at 2e-5, where slopes
    would give an error of 3000.
    """
    with pytest.raises(
        col.NoSolutionError, match=r"turns round.*give a prior \(a Normal\)"
    ) as refused:
        fit(square, {"a": unknown}, {"o": (0.0, 0.1)})
    assert refused.value.code == "no_convergence"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "bounds", "observed"),
    [
        (square, (0.0, 10.0), (0.0, 0.1)),
        (square, (0.0, 10.0), (0.002, 0.1)),
        (lambda a: {"o": np.cos(a)}, (-1.0, 0.0), (1.0, 0.1)),
        (lambda a: {"o": a**4}, (0.0, 2.0), (0.0, 0.1)),
        (lambda a: {"o": np.where(a < 0.3, a**2, np.nan)}, (0.0, 1.0), (0.0, 0.1)),
        (square, (0.0, 1.0), (0.0, 1.0)),
    ],
)
def test_a_turning_point_on_a_bound_is_for_the_posterior(model, bounds, observed):
    """Slopes vanish there: refused, and the posterior has the range. Its density is exp(-(o(a) -
    observed)^2/2 s^2) on a grid.
    """
    with pytest.raises(
        col.NoSolutionError, match=r"turns round.*reconstruct\.posterior answers there too"
    ) as refused:
        fit(model, {"a": Interval(*bounds)}, {"o": observed})
    assert refused.value.code == "no_convergence"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.IllConditionedWarning)  # the last tells next to nothing
        found = reconstruct.posterior(
            model, {"a": Uniform(*bounds)}, {"o": observed}, samples=2048, seed=1
        )
    grid = np.linspace(*bounds, 200_001)
    weight = np.nan_to_num(np.exp(-0.5 * ((model(grid)["o"] - observed[0]) / observed[1]) ** 2))
    shares = np.cumsum(weight) / np.sum(weight)
    for share, end in zip((0.025, 0.975), found["a"].interval(0.95), strict=True):
        exact = grid[np.searchsorted(shares, share)]
        assert abs(end - exact) <= 5.0 * found["a"].quantile_standard_error(share) + 1e-3 * (
            bounds[1] - bounds[0]
        )


def test_a_turning_point_beside_what_nothing_determines():
    """One unknown turns on its bound, another changes nothing: refused as a whole."""
    with pytest.raises(col.NoSolutionError, match="turns round"):
        fit(
            lambda a, b, v: {"o": a**2 + v + 0.0 * b},
            {"a": Interval(0, 3), "b": Interval(0, 3), "v": Normal(5, 0.1)},
            {"o": (4.9, 0.1)},
        )


# --- many hollows, wide bounds, and starts far off


def hollows(a):
    return {"o": np.sin(30.0 * a) + 0.5 * a, "q": a}


@pytest.mark.slow
def test_many_hollows_are_for_the_posterior():
    """One of 64 searches over 20 ends at the least of chi-squared that they find, 2.28; on a grid
    of 1e-6 it is 0.02, at 2.007.
    """
    arguments = hollows, {"o": (0.5, 0.01), "q": (2.0, 0.02)}
    with pytest.raises(
        col.NoSolutionError, match=r"few of the 64 searches ended.*reconstruct\.posterior"
    ) as refused:
        fit(arguments[0], {"a": Interval(-10, 10)}, arguments[1])
    assert refused.value.code == "no_convergence"
    grid = np.arange(1.9, 2.1, 1e-6)
    weight = np.exp(
        -0.5 * ((hollows(grid)["o"] - 0.5) / 0.01) ** 2 - 0.5 * ((grid - 2.0) / 0.02) ** 2
    )
    found = reconstruct.posterior(
        arguments[0], {"a": Uniform(-10, 10)}, arguments[1], samples=2048, seed=1
    )
    assert (
        abs(found["a"].mean - np.average(grid, weights=weight))
        < 5.0 * found["a"].mean_standard_error
    )


@pytest.mark.parametrize(
    ("model", "width", "observed", "value", "error"),
    [
        (square, 1e8, (400.0, 4.0), 20.0, 0.1),
        (lambda a: {"o": np.sqrt(a)}, 1e6, (2.0, 0.01), 4.0, 0.04),
        (lambda a: {"o": np.log(a + 1.0)}, 1e8, (math.log(6.0), 0.05), 5.0, 0.3),
        (lambda a: {"o": 1.0 / (a + 1.0)}, 1e8, (0.2, 0.002), 4.0, 0.05),
    ],
)
def test_bounds_far_too_wide(model, width, observed, value, error):
    """Slopes are over steps that fit the answer; 1e-6 of an error covers where the search ends,
    1e-7 the slopes (see the head).
    """
    found, codes = fitted(model, {"a": Interval(0, width)}, {"o": observed})
    assert abs(found.values["a"] - value) <= 1e-6 * error
    assert found["a"].standard_error == pytest.approx(error, rel=1e-7)
    assert codes == []


@pytest.mark.parametrize("start", [1.0, 0.0, 1e12])
@pytest.mark.parametrize("true", [1e8, 3.0])
def test_a_start_far_off_has_the_same_errors(start, true):
    """An unknown and its square, each telling it to a hundredth: an error of true/100/sqrt(2),
    wherever the search began.
    """

    def model(a):
        return {"itself": a, "square": a**2}

    observed = {"itself": (true, 0.01 * true), "square": (true**2, 0.02 * true**2)}
    found = fit(model, {"a": start}, observed)
    assert found["a"].standard_error == pytest.approx(0.01 * true / math.sqrt(2.0), rel=1e-7)


def test_errors_are_given_the_stated_errors():
    """Said wherever errors are printed."""
    found, _ = simple()
    assert "given the stated errors" in repr(found)
    assert "given the stated errors of the observations and priors" in str(found)
    assert "given the stated errors of the observations and priors" in found._repr_html_()


# --- angles


def around(x):
    return {"one": (x + np.pi) % (2 * np.pi) - np.pi, "other": (x + np.pi) % (2 * np.pi) - np.pi}


def test_angles_go_round_the_circle():
    """179 and -179 degrees are 2 degrees apart: the answer is 180, each off by 1 degree."""
    found, codes = fitted(
        around, {"x": "150 deg"}, {"one": ("179 deg", "2 deg"), "other": ("-179 deg", "2 deg")}
    )
    assert math.degrees(found.values["x"]) % 360.0 == pytest.approx(180.0, abs=1e-6)
    assert found.chi_squared == pytest.approx(0.5, abs=1e-9)
    assert found.residuals["one"].residual == pytest.approx(-DEGREE, abs=1e-8)
    assert found.residuals["other"].residual == pytest.approx(DEGREE, abs=1e-8)
    assert found["x"].standard_error == pytest.approx(2 * DEGREE / math.sqrt(2), rel=1e-7)
    assert codes == []


@pytest.mark.slow
def test_answers_a_turn_apart_are_one():
    """A course between -360 and 360 degrees, seen by its cosine and sine."""
    model, observed = (
        lambda x: {"cos": np.cos(x), "sin": np.sin(x)},
        {"cos": (math.cos(3.0), 0.1), "sin": (math.sin(3.0), 0.1)},
    )
    found = fit(model, {"x": Interval("-360 deg", "360 deg")}, observed)
    assert found.values["x"] % (2.0 * math.pi) == pytest.approx(3.0, abs=1e-7)
    with pytest.raises(col.AmbiguousSolutionError):
        fit(model, {"x": Interval(-6.0, 6.0)}, observed)


def test_an_angle_that_the_model_returns_as_a_quantity_goes_round_too():
    """The unit may come from either side."""

    def model(x):
        return {"one": pint.application_registry.Quantity(np.degrees(around(x)["one"]), "deg")}

    found, _ = fitted(model, {"x": Normal(-3.1, 0.1)}, {"one": (3.1, 0.1)})
    assert found.values["x"] == pytest.approx(-3.1 - 0.5 * (2 * math.pi - 6.2), abs=1e-7)


@pytest.mark.slow
def test_a_bare_angle_that_jumps_is_pointed_out():
    """Without a unit 3.1 and -3.1 are far apart; the answer says so."""
    found, codes = fitted(
        lambda x: {"course": x}, {"x": Normal(-3.1, 0.01)}, {"course": (3.1, 5.0)}
    )
    assert codes == ["bare_angle"]
    assert found.residuals["course"].residual == pytest.approx(6.2, abs=1e-3)
    assert (
        fitted(lambda x: {"speed": x}, {"x": Normal(-3.1, 0.01)}, {"speed": ("3.1 m/s", "5 m/s")})[
            1
        ]
        == []
    )


# --- what comes out


def simple():
    matrix = [[1.0, 0.5], [0.2, 1.0], [1.0, -1.0]]
    observed = {
        "o0": ("4.1 m/s", "0.2 m/s"),
        "o1": ("2.5 m/s", "0.1 m/s"),
        "o2": ("1.1 m/s", "0.3 m/s"),
    }
    return fit(linear(matrix), {"x": Normal("3 m/s", "1 m/s"), "y": 2.0}, observed), np.array(
        matrix
    )


@pytest.mark.slow
def test_a_fit_feeds_a_propagation():
    """First order through a linear model: A C A^T, as matrices have it."""
    found, matrix = simple()
    assert found.inputs["x"].unit == "m/s"
    assert found.inputs["y"].given_sd == found.standard_errors["y"]
    result = propagate(
        linear(matrix), found.inputs, method="first_order", correlation=found.correlation
    )
    exact = np.sqrt(np.diagonal(matrix @ found.covariance @ matrix.T))
    for name, deviation in zip(ROW, exact, strict=False):
        assert result[name].std == pytest.approx(deviation, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "unknown", "reading", "words"),
    [
        # Of v^4 / 1000 = 20 with an error of 15, chi-squared is 1.78 at v = 0.
        (lambda v: {"o": v**4 / 1e3}, Interval(0, 60), (20.0, 15.0), "the model bends"),
        (lambda v: {"o": v}, Interval(0, 4), (5.0, 1.0), "v ended on its high bound"),
        (lambda v: {"o": v}, Interval(0, 1), (0.4, 5.0), "excludes no value of v"),
        (lambda v: {"o": np.where(v > 0.9, v, np.nan)}, Interval(0, 3), (1.0, 0.1), "refuses"),
        (lambda v: {"o": np.abs(v - 1.0)}, Interval(-3, 4), (0.5, 1.0), "another answer fits"),
    ],
)
def test_normals_that_do_not_describe_an_answer_are_not_handed_on(model, unknown, reading, words):
    found, _ = fitted(model, {"v": unknown}, {"o": reading})
    with pytest.raises(col.NoSolutionError, match=words) as refused:
        assert found.inputs
    assert refused.value.code == "not_normal"
    assert "posterior(model, unknowns, observed, seed=1).inputs()" in str(refused.value)


def contradictory():
    """Two readings of one speed, 10 and 30 with an error of 1: 20 with one of 0.71, at a
    chi-squared of 200.
    """
    readings = {"a": (10.0, 1.0), "b": (30.0, 1.0)}
    return fitted(lambda v: {"a": v, "b": v}, {"v": Interval(0, 60)}, readings)[0].inputs["v"]


def with_a_sum(known):
    first = reconstruct.posterior(same, {"v": Normal(9.0, 1.0)}, {"o": (9.0, 1.0)}, seed=1)
    return first.with_result("sum", lambda v, u: v + u, v=first["v"], u=known)


def same(v):
    return {"o": v + 0.0}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("study", "name"),
    [
        (lambda known: propagate(same, {"v": known}, seed=1), "v"),
        (lambda known: propagate(same, {"v": known}, method="interval"), "v"),
        (lambda known: fit(same, {"v": known}, {"o": (20.0, 1.0)}), "v"),
        (lambda known: reconstruct.posterior(same, {"v": known}, {"o": (20.0, 1.0)}, seed=1), "v"),
        (with_a_sum, "u"),
    ],
)
def test_what_a_fit_states_goes_with_its_inputs(study, name):
    known = pickle.loads(pickle.dumps(contradictory()))
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        second = study(known)
    assert [one.message.code for one in given] == ["contradictory"]
    (said,) = (one for one in second.statements if "contradicts itself" in one)
    assert said.startswith(f"from a fit ({name}): the evidence contradicts itself")
    assert str(given[0].message).startswith(said)
    assert said in second.to_dict()["statements"]
    assert said[1:] in " ".join(str(second.summary()).split())


def test_evidence_that_agrees_is_not_handed_on():
    found, _ = simple()
    result = propagate(
        linear([[1.0, 1.0]]), found.inputs, seed=1, samples=64, correlation=found.correlation
    )
    rho = found.correlation["x", "y"]
    assert result.statements == (f"correlation of the inputs as stated: x and y {rho:.15g}",)


@pytest.mark.parametrize("study", ["propagate", "posterior"])
def test_what_a_fit_found_together_is_not_taken_as_independent_in_silence(study):
    """Also under other names; with the correlation, or of one unknown alone, nothing is said."""
    found, matrix = simple()
    rho = found.correlation["x", "y"]
    assert abs(rho) > 0.1
    inputs = {"v": found.inputs["x"], "w": found.inputs["y"]}

    def studied(inputs, **more):
        def model(**given):
            return {
                "o0": sum(row * one for row, one in zip(matrix[0], given.values(), strict=False))
            }

        if study == "propagate":
            return propagate(model, inputs, seed=1, samples=64, **more)
        return reconstruct.posterior(model, inputs, {"o0": (4.0, 1.0)}, samples=512, seed=1, **more)

    said = f"found v and w with a correlation of {rho:.2g}, and this pair was"
    with pytest.warns(col.OutOfRangeWarning, match="this pair was taken as independent") as told:
        result = studied(inputs)
    assert [one.message.code for one in told] == ["correlation_left_out"]
    assert any(said in one for one in result.statements)
    for silent in (
        studied(inputs, correlation={("v", "w"): rho}),
        studied({"v": inputs["v"], "w": Normal(1.0, 0.1)}),
        studied(pickle.loads(pickle.dumps(inputs)), correlation={("w", "v"): rho}),
    ):
        assert not any("found v and w" in one for one in silent.statements)


def test_a_unit_that_begins_with_1_comes_back():
    """A curvature: its text, 1.5 1/m, cannot be read, so it is handed on as a Quantity."""
    unit = pint.get_application_registry().Unit("1/m")
    found = fit(lambda x: {"o0": 2.0 * x}, {"x": Interval(0 * unit, 3 * unit)}, {"o0": (3.0, 0.1)})
    assert str(found.inputs["x"]) == "1.5 ± 0.05 1/m, at least 0 1/m, at most 3 1/m"
    assert "1.402 to 1.598 1/m" in str(found.summary())


def test_units_come_back():
    found, _ = simple()
    assert found.values.q["x"].m_as("km/h") == pytest.approx(3.6 * found.values["x"])
    assert found.q.values["x"].units == found.values.q["x"].units
    assert found.values.q["y"] == found.values["y"]
    assert found["x"].q["standard_error"].m_as("m/s") == found.standard_errors["x"]
    assert found.residuals["o0"].q["observed"].m_as("m/s") == 4.1
    assert found.residuals["o0"].residual == pytest.approx(
        found.residuals["o0"].observed - found.residuals["o0"].computed, abs=1e-12
    )


def test_shown_and_read_again():
    """Texts, table, strict JSON and pickle say the same."""
    found, _ = simple()
    for text in (repr(found), str(found), found._repr_html_()):
        for part in ("prior of x", "residual over sigma", "degrees of freedom", "m/s"):
            assert part in text
    assert "standard_error" in repr(found["x"])
    assert "over_sigma" in found.residuals["o0"]._repr_html_()
    record = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert record["unknowns"]["x"]["value"] == found.values["x"]
    assert record["unknowns"]["y"]["low"] == "-inf"
    assert record["residuals"]["prior of x"]["is_prior"] is True
    again = pickle.loads(pickle.dumps(found))
    assert again.to_dict() == found.to_dict()
    assert isinstance(again, reconstruct.Fit)
    for one in (found, again):
        with pytest.raises(ValueError, match="read-only"):
            one.covariance[0, 0] = 1.0
    with pytest.raises(AttributeError):
        found.chi_squared = 0.0
    with pytest.raises(
        col.InputError, match="'speed' is none of the unknowns, which are x, y"
    ) as refused:
        found["speed"]
    assert refused.value.code == "unknown_name"
    with pytest.raises(col.InputError, match="between 0 and 1") as refused:
        found["x"].interval(95)
    assert refused.value.code == "bad_fraction"


def test_an_undetermined_fit_is_shown_and_strict_json():
    found, _ = fitted(central, {"speed_a": Interval(0, 40), "speed_b": Interval(-40, 40)}, DELTA_V)
    record = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert record["unknowns"]["speed_a"]["value"] == "nan"
    assert record["covariance"][0] == ["inf", "nan"]
    assert "not determined" in str(found)
    assert record["undetermined"][0]["sentence"][1:] in found._repr_html_()
    assert pickle.loads(pickle.dumps(found)).to_dict() == found.to_dict()


@pytest.mark.slow
def test_the_same_question_has_the_same_answer():
    """Bit for bit: nothing is drawn at random."""
    one, other = (simple()[0].to_dict() for _ in range(2))
    assert one == other


def test_warnings_of_the_model_at_the_answer_are_passed_on():
    """An impact that gains energy at the answer says so, once; those on the way are not
    repeated.
    """

    def model(speed_a):
        a, b = col.Vehicle(mass=1500, vx=speed_a, vy=10.0), col.Vehicle(mass=1000)
        impact = col.oblique_central(a, b, 1.0, normal=0.0, impulse_ratio=-0.5, on_failure="nan")
        return {"vx_b": impact.b.after.vx}

    _, codes = fitted(model, {"speed_a": 10.0}, {"vx_b": (12.0, 0.5)})
    assert codes == ["energy_gain"]


# --- numbers below


def test_slopes_keep_within_bounds_and_refusals():
    """Derivatives of sine in the middle, on both bounds and beside a refusal, against cosine.

    Central differences with h = 6e-6 of the size: h^2/6 of the curve and eps/h = 4e-11 of rounding;
    1e-9 covers both. On a bound or beside a refusal one difference is left, off by h/2 of the
    curve.
    """
    seen = []

    def evaluate(points):
        seen.append(points)
        return np.where(points < 1.2 - 1e-9, np.nan, np.sin(points))

    one = np.ones(1)
    problem = Problem(evaluate, one, np.full(1, np.nan), one, 2.0 * one, one, one)
    points = np.array([[1.5], [2.0], [1.2]])
    outputs, slopes = problem.with_slopes(points)
    assert np.array_equal(outputs, np.sin(points))
    assert np.all((seen[0] >= 1.0) & (seen[0] <= 2.0))
    assert abs(slopes[0, 0, 0] - math.cos(1.5)) < 1e-9
    np.testing.assert_allclose(slopes[1:, 0], np.cos(points[1:]), rtol=0, atol=8e-6)


def test_starts_are_spread_evenly():
    """Each quarter of each side holds a quarter of 64 starts within two, which chance would give
    with an error of 3.5.
    """
    points = spread(64, np.array([0.0, 10.0]), np.array([1.0, 30.0]))
    assert np.array_equal(points[0], [0.5, 20.0])
    for share in ((points - [0.0, 10.0]) / [1.0, 20.0]).T:
        assert np.all(abs(np.histogram(share, np.linspace(0, 1, 5))[0] - 16) <= 2)


# --- refusals


def identity(x):
    return {"x": x}


GOOD = ({"x": 1.0}, {"x": (1.0, 0.1)})
RANDOM = np.random.default_rng(1)


@pytest.mark.slow
def test_a_few_cases_are_called_again_alone(monkeypatch):
    """After the first large call, for the noise of the model near five starts, five and perhaps
    their neighbours; the fit is the same to the bit without them.
    """
    sizes = []

    def model(x, y):
        sizes.append(len(x))
        return {"a": x * y, "b": x - y, "c": np.where(x < 9.0, x, np.nan)}

    def fitted():
        sizes.clear()
        unknowns = {"x": Interval(0, 10), "y": Normal(2, 1)}
        return fit(
            model, unknowns, {"a": (6.0, 0.1), "b": (1.0, 0.2), "c": (3.1, 0.3)}
        ).to_dict(), list(sizes)

    compared, sizes_called = fitted()
    monkeypatch.setattr("collisions.uncertainty.model.check_elementwise", lambda *of: True)
    plain, sizes_called_plain = fitted()
    assert plain == compared
    more = len(sizes_called) - len(sizes_called_plain)
    assert sizes_called_plain == [2, 5 * 18, 64 * 5, *sizes_called[3 + more :]]
    assert 5 <= sum(sizes_called[2 : 2 + more]) <= 1 + 4 + 4 + 1 + 1


def scattered(value, scatter):
    """A value whose last digits are as good as random, the same for the same input."""
    return value + scatter * np.modf(1e9 * np.sin(1e7 * value))[0]


@pytest.mark.slow
@pytest.mark.parametrize("scatter", [1e-7, 1e-5, 1e-3])
def test_a_model_that_scatters_has_the_answer_of_one_that_does_not(scatter):
    """As one that integrates with steps of its own: slopes over a part of the errors, from which
    1e-3 sigma of scatter take two digits.
    """
    unknowns = {"v": Normal(12, 2), "w": Interval(0, 6)}
    observed = {"x": (15.0, 0.5), "turn": (4.0, 0.1)}

    def smooth(v, w):
        return {"x": v * v / 12.0 - 0.1 * w * w, "turn": w * w / 3.0 + 0.02 * v}

    def rough(v, w):
        found = smooth(v, w)
        return {
            "x": scattered(found["x"], 0.5 * scatter),
            "turn": scattered(found["turn"], 0.1 * scatter),
        }

    wanted, got = fit(smooth, unknowns, observed), fit(rough, unknowns, observed)
    for name in unknowns:
        error = wanted[name].standard_error
        assert got[name].value == pytest.approx(wanted[name].value, abs=0.02 * error)
        assert got[name].standard_error == pytest.approx(error, rel=0.02)


@pytest.mark.slow
def test_a_kink_is_refused_in_a_model_that_scatters_too():
    """The slope of |x| changes sign where the misfit is least."""

    def bent(x):
        return {"y": scattered(2.0 + 3.0 * abs(x - 4.0), 1e-5)}

    with pytest.raises(col.NoSolutionError, match="jumps, bends"):
        fit(bent, {"x": Interval(0, 10)}, {"y": (1.0, 0.1)})


@pytest.mark.parametrize(
    ("model", "unknowns", "observed", "kind", "code", "text"),
    [
        (3.0, *GOOD, col.InputError, "bad_model", "model must be a function"),
        (identity, {"y": 1.0}, GOOD[1], col.InputError, "bad_model",
            r"unknowns are y, but the model takes \(x\)"),
        (lambda x: {"x": math.sqrt(x)}, *GOOD, col.InputError, "bad_model",
            "numpy in place of math"),
        (lambda x: {"x": x - x.mean() + 5.0}, {"x": Interval(0, 10)}, {"x": (5, 1)},
            col.InputError, "bad_model", "model mixes cases: among 90 cases"),
        (lambda x: {"x": x - x.mean() + 5.0}, {"x": 4.0}, {"x": (5, 1)}, col.InputError,
            "bad_model", "In place of what is taken over all"),
        (lambda x: {"x": x * x.max()}, {"x": Normal(2, 1)}, {"x": (5, 1)}, col.InputError,
            "bad_model", "for that case among 4 of them"),
        (lambda x: {"x": x + RANDOM.normal(size=x.shape)}, *GOOD, col.InputError, "bad_model",
            "Random numbers drawn in the model"),
        (lambda x: {"x": np.gradient(x)}, *GOOD, col.InputError, "bad_model",
            "among others, but not alone"),
        (lambda x: {"x": 1.0 if x > 0 else 2.0}, *GOOD, col.InputError, "bad_model",
            r"arrays of 2 cases for x.*numpy.where in place of if"),
        (lambda x: {"x": x if x.size < 3 else math.sqrt(x)}, *GOOD, col.InputError, "bad_model",
            r"arrays of \d+ cases for x.*numpy.sqrt"),
        (lambda x: x, *GOOD, col.InputError, "bad_model", "dict of named outputs"),
        (lambda x: {"x": x[:1]}, *GOOD, col.ShapeError, "bad_shape", "'x'"),
        (identity, {}, GOOD[1], col.InputError, "bad_type",
            "unknowns must be a dict.*an empty one"),
        (identity, GOOD[0], {}, col.InputError, "bad_type",
            "observed must be a dict.*an empty one"),
        (identity, [1.0], GOOD[1], col.InputError, "bad_type", "unknowns must be a dict.*got list"),
        (identity, GOOD[0], {"z": (1.0, 0.1)}, col.InputError, "unknown_output",
            "names z, .*it returns x"),
        (identity, GOOD[0], {"x": 1.0}, col.InputError, "bad_observation",
            "number without its error"),
        (identity, GOOD[0], {"x": Uniform(0, 1)}, col.InputError, "bad_observation",
            "Uniform; give Normal"),
        (identity, GOOD[0], {"x": Interval(0, 1)}, col.InputError, "bad_observation",
            "type Interval; give Normal"),
        (identity, GOOD[0], {"x": Normal(1, 1, truncate=(0, None))}, col.InputError,
            "bad_observation", "bounds belong to unknowns"),
        (identity, GOOD[0], {"x": (1.0, "0.1 m/s")}, col.UnitsError, "bad_units",
            r"observed\['x'\].*has no unit"),
        (identity, GOOD[0], {"x": (1.0, 0.0)}, col.InputError, "not_positive",
            r"observed\['x'\] error must be > 0, got 0; give the pair \(value, error\)"),
        (identity, GOOD[0], {"x": (1.0, -0.1)}, col.InputError, "not_positive",
            "error must be > 0, got -0.1; give the pair"),
        (identity, GOOD[0], {"x": (math.nan, 0.1)}, col.InputError, "not_finite", "NaN"),
        (identity, {"x": LogNormal(1, 0.1)}, GOOD[1], col.InputError, "bad_prior",
            "LogNormal; give a Normal"),
        (identity, {"x": Triangular(0, 1, 2)}, GOOD[1], col.InputError, "bad_prior",
            "Triangular; give a Normal"),
        (identity, {"x": Samples([1.0, 2.0, 3.0])}, GOOD[1], col.InputError, "bad_prior",
            "Samples; give a Normal"),
        (identity, {"x": None}, GOOD[1], col.InputError, "bad_prior", "NoneType; give a Normal"),
        (identity, {"x": (0, 1)}, GOOD[1], col.InputError, "bad_prior",
            r"tuple; give a Normal.*write Uniform\(0, 1\) or Interval\(0, 1\)"),
        (identity, {"x": (0, 100)}, GOOD[1], col.InputError, "bad_prior",
            (r"reconstruct.posterior takes every distribution; if a range was meant, write "
             r"Uniform\(0, 100\)")),
        (identity, {"x": [0, 1]}, GOOD[1], col.InputError, "bad_prior",
            r"list; give a Normal.*Uniform\(0, 1\) or Interval\(0, 1\)"),
        (identity, {"x": ("0 m", "1 m")}, GOOD[1], col.InputError, "bad_prior",
            r"tuple; give a Normal.*Interval\('0 m', '1 m'\)"),
        (identity, GOOD[0], {"x": ("1 m/s", 0.1)}, col.UnitsError, "bad_units",
            r"observed\['x'\] error = 0.1 has no unit"),
        (identity, {"x": math.inf}, GOOD[1], col.InputError, "not_finite", "finite"),
        (identity, {"x": "fast"}, GOOD[1], col.UnitsError, "bad_units", "cannot read"),
        (identity, {"x": True}, GOOD[1], col.InputError, "not_a_number", "number"),
    ],
)  # fmt: skip
def test_refusals(model, unknowns, observed, kind, code, text):
    """Class, label and what the message says."""
    with pytest.raises(kind, match=f"(?s){text}") as refused:
        fit(model, unknowns, observed)
    assert refused.value.code == code


def test_errors_too_small_to_be_counted_in():
    """Numbers in sigma that have no square are refused like any other case that has no number."""
    with pytest.raises(col.NoSolutionError, match="refuses all") as refused:
        fit(identity, {"x": 1.0}, {"x": (0.0, 1e-200)})
    assert refused.value.code == "refused"


def test_all_wrong_arguments_in_one_error():
    with pytest.raises(
        col.InputError, match=r"(?s)3 arguments.*unknowns\['x'\].*observed\['x'\].*observed\['y'\]"
    ):
        fit(identity, {"x": LogNormal(1, 0.1)}, {"x": 1.0, "y": (1.0, 0.0)})


def test_a_unit_of_another_kind_is_refused():
    """The model returns a speed where an angle was observed."""

    def model(x):
        return {"x": pint.application_registry.Quantity(x, "m/s")}

    with pytest.raises(
        col.UnitsError, match="observed x is in rad, but the model returns it in m/s"
    ) as refused:
        fit(model, {"x": 1.0}, {"x": ("3 deg", "1 deg")})
    assert refused.value.code == "bad_units"


@pytest.mark.parametrize(("value", "error"), [(-1e-320, 1e-154), (1e300, 1e-300), (5e-324, 5e-324)])
def test_observations_whose_errors_leave_the_range_of_floats(value, error):
    """Answered or refused; numpy has no say in it."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", col.CollisionsWarning)
        try:
            found = reconstruct.fit(
                lambda x: {"s": 2.0 * x}, {"x": Normal(24.6, 1.0)}, {"s": (value, error)}
            )
        except col.CollisionsError:
            return
    assert math.isfinite(found["x"].value)


@pytest.mark.slow
def test_errors_of_very_different_size():
    """What one observation says 1e14 or 1e18 times more firmly than the other is found: x = y by
    it, y = 4 by the prior.
    """
    unknowns = {"x": Interval(0.0, 40.0), "y": Normal(4.0, 2.0)}

    def fitted(error):
        return reconstruct.fit(
            lambda x, y: {"s": x + 2.0 * y, "d": x - y},
            unknowns,
            {"s": (15.0, error), "d": (0.0, 1.0 / error)},
        )

    for error in (1e7, 1e9):
        found = fitted(error)
        assert (found["x"].value, found["y"].value) == pytest.approx((4.0, 4.0), abs=1e-6)


@pytest.mark.slow
def test_a_bound_that_the_model_refuses_beside_an_answer():
    """At x = 0 there is y / 0; the second answer lies so near to that bound that it is
    tried there.
    """

    def model(x, y):
        with np.errstate(all="ignore"):
            return {"s": np.sqrt(x) * y, "d": np.where(x > y, x * x, y / x)}

    with pytest.raises(col.AmbiguousSolutionError) as caught:
        fit(
            model,
            {"x": Interval(0, 40), "y": 5.0},
            {"s": (0.0, 0.5), "d": (14.666854856781896, 0.5)},
        )
    # x**2 = d where x > y, and y = 0.
    assert caught.value.solutions[0].values["x"] == pytest.approx(
        math.sqrt(14.666854856781896), rel=1e-6
    )


def rise_at(model, unknowns, observed, least, name, end):
    """How far chi-squared is above the least at one value of one of two unknowns, by 20,001 values
    of the other.
    """
    ((other, before),) = ((one, prior) for one, prior in unknowns.items() if one != name)
    low, high = (
        (before.low, before.high)
        if isinstance(before, Interval)
        else np.clip(before.support, -9, 9)
    )
    values = {other: np.linspace(low, high, 20_001), name: np.full(20_001, end)}
    answers = model(**values)
    total = 0.0
    for output, (value, error) in observed.items():
        total = total + ((answers[output] - value) / error) ** 2
    for one, prior in unknowns.items():
        if isinstance(prior, Normal):
            total = total + ((values[one] - prior.given_mean) / prior.given_sd) ** 2
    return np.nanmin(total) - least


def side_impact(tyres=None, **known):
    """A model of one, of two unknowns beside what is known."""
    held = {} if tyres is None else {"duration": 0.1, **tyres}

    def model(**rest):
        given = known | rest
        a = col.Vehicle(
            mass=1500, vx=given["speed_a"], yaw_inertia=2500, x=-2.1, y=0.0, heading=0.0
        )
        b = col.Vehicle(
            mass=1250, vy=given["speed"], yaw_inertia=1900, x=0.9, y=-0.4, heading=0.5 * math.pi
        )
        place = {"normal": 0.0, "point": (0.0, given["contact"]), "friction": given["friction"]}
        impact = col.eccentric(a, b, given["restitution"], **place, **held, on_failure="nan")
        return {
            "energy": impact.energy_loss,
            "course": impact.b.after.course,
            "yaw rate": impact.b.after.yaw_rate,
            "yaw rate of A": impact.a.after.yaw_rate,
            "course of A": impact.a.after.course,
            "delta-V of A": impact.a.delta_v,
        }

    return model


def of_two(model, first, second, observed):
    """The same with its two unknowns in its signature, and only what is observed."""

    def asked(one, other):
        found = model(**{first: one, second: other})
        return {name: found[name] for name in observed}

    return lambda **values: asked(values[first], values[second])


SIDE_IMPACTS = [
    (
        {"friction": Normal(0.4753, 0.1917, truncate=(0.05, 1.2)), "speed": Interval(2, 25)},
        {"speed_a": 12.7665, "restitution": 0.1902, "contact": -0.0597},
        {"energy": (58485.0, 8000.0), "course": (0.6250, 0.04)},
    ),
    (
        {
            "friction": Normal(0.4955, 0.1917, truncate=(0.05, 1.2)),
            "contact": Normal(0.0268, 0.2, truncate=(-0.6, 0.6)),
        },
        {"speed_a": 20.527, "speed": 15.350, "restitution": 0.2216},
        {"energy": (176181.0, 8000.0), "yaw rate": (-0.9313, 0.15)},
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize(("unknowns", "known", "observed"), SIDE_IMPACTS)
def test_a_range_goes_on_where_the_contact_slides(unknowns, known, observed):
    """Where it stuck no friction fits better than the prior's mean; three of its errors below, the
    contact slid, and fits as well with values further out: either end is where chi-squared is 3.84
    above the least.
    """
    model = of_two(side_impact(**known), *unknowns, observed)
    found = fit(model, unknowns, observed)
    (_, name) = unknowns
    for end in found[name].interval(0.95):
        risen = rise_at(model, unknowns, observed, found.chi_squared, name, end)
        assert risen == pytest.approx(3.84, abs=0.04)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("unknowns", "known", "observed"),
    [
        (
            {
                "friction": Normal(0.2013, 0.19, truncate=(0.05, 1.2)),
                "contact": Normal(0.2812, 0.2, truncate=(-0.6, 0.6)),
            },
            {"speed_a": 14.8675, "speed": 8.2471, "restitution": 0.2963},
            {
                "yaw rate": (0.23108, 0.15),
                "yaw rate of A": (1.29915, 0.15),
                "course of A": (0.393071, 0.04),
            },
        ),
        (
            {"friction": Normal(0.6135, 0.19, truncate=(0.05, 1.2)), "speed": Interval(2, 25)},
            {"speed_a": 22.9381, "restitution": 0.0696, "contact": 0.1839},
            {
                "delta-V of A": (10.807836, 0.3),
                "course of A": (0.19527, 0.04),
                "yaw rate": (-2.758522, 0.15),
            },
        ),
    ],
)
def test_ranges_of_a_finer_model_are_those_of_its_own_valleys(unknowns, known, observed):
    """Also where the other model has none there, or its slopes are far off: either end of each
    range is on a bound, or where chi-squared of the finer model is 3.84 above the least.
    """
    tyres = {
        "tyres_a": travel.Tyres(0.7, 0.3, 2.7, 1.5),
        "tyres_b": travel.Tyres(0.7, 0.0, 2.7, 1.5),
    }
    models = [of_two(side_impact(given, **known), *unknowns, observed) for given in (None, tyres)]
    found = fit(models[0], unknowns, observed, finer=models[1])
    for name, before in unknowns.items():
        bounds = (before.low, before.high) if isinstance(before, Interval) else before.support
        for end in found[name].interval(0.95):
            risen = rise_at(models[1], unknowns, observed, found.chi_squared, name, end)
            assert risen == pytest.approx(3.84, abs=0.15) or (end in bounds and risen < 3.84)


@pytest.mark.slow
def test_another_valley_is_looked_for_where_slopes_are_steep():
    """The end of the range of y lies beyond a turn of the sine, which no short step leads to."""

    def model(x, y):
        u = (0.57798 * x + 0.81605 * y) * 1.10328 + 0.00649
        v = 0.38264 * x + 0.92390 * y - 0.13409 * u * u
        return {"sine": 2.0 * np.sin(0.55285 * u), "square": v + 0.3 * u * u}

    unknowns = {"x": Normal(-1.317, 0.8909, truncate=(-3.826, 0.603)), "y": Normal(-0.167, 1.173)}
    observed = {"sine": (-1.91685, 0.48761), "square": (-0.76186, 0.05589)}
    found = fit(model, unknowns, observed)
    for end in found["y"].interval(0.95):
        risen = rise_at(model, unknowns, observed, found.chi_squared, "y", end)
        assert risen == pytest.approx(3.84, abs=0.04)
