"""First and second order against analytic derivatives and moments, at the ends of what is stated,
and where they must warn.
"""

import math
import warnings

import numpy as np
import pint
import pytest

import collisions as col
from collisions import travel
from collisions.uncertainty import (
    Interval,
    LogNormal,
    Normal,
    Samples,
    Triangular,
    Uniform,
    propagate,
)
from uncertain_scenes import SCENES

LOCAL = ("first_order", "second_order")
both_orders = pytest.mark.parametrize("method", LOCAL)
ureg = pint.get_application_registry()

# Differences at steps of 0.01 deviations: the fourth power of the step leaves 1e-8 of the fifth
# derivative, below 1e-9 of the gradient of the models here; rounding leaves 1.5 eps / 0.01 of the
# value, 1e-13, which is 1e-11 of a deviation of a hundredth.
FIRST = 1e-9


def codes_of(call):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = call()
    return found, [getattr(warning.message, "code", str(warning.message)) for warning in caught]


def local(model, inputs, method, **options):
    """An output named y that no warning goes with."""
    return propagate(model, inputs, method=method, **options)["y"]


# First order


def test_first_order_by_hand():
    """GUM eq 13 of the speed before a skid, v = sqrt(2 g f d): dv/df = v / 2f and dv/dd
    = v / 2d.
    """
    found = propagate(
        lambda drag, length: {"y": travel.speed(length, drag=drag)},
        {"drag": Normal(0.7, 0.02), "length": Normal(25.0, 0.5)},
        method="first_order",
    )["y"]
    speed = math.sqrt(2.0 * travel.GRAVITY * 0.7 * 25.0)
    by_drag, by_length = 0.5 * speed / 0.7 * 0.02, 0.5 * speed / 25.0 * 0.5
    sd = math.hypot(by_drag, by_length)
    assert found.mean == pytest.approx(speed, rel=4e-16)
    assert found.std == pytest.approx(sd, rel=FIRST)
    assert found.contributions == pytest.approx(
        {"drag": (by_drag / sd) ** 2, "length": (by_length / sd) ** 2}, rel=FIRST
    )
    assert found.total_contributions == found.contributions
    assert found.interval(0.95) == pytest.approx(
        (speed - 1.959963984540054 * sd, speed + 1.959963984540054 * sd), rel=FIRST
    )
    assert math.isnan(found.mean_standard_error)
    assert math.isnan(found.std_standard_error)
    assert all(
        math.isnan(error) for pair in found.contribution_standard_errors.values() for error in pair
    )


def test_first_order_with_correlations_by_hand():
    """The covariance term of GUM eq 13, for delta-V = m_a v / (m_a + m_b) (1 + e) of a
    real impact.
    """

    def model(a, b, v):
        return {
            "y": col.linear_central(
                col.Vehicle(mass=a, vx=v), col.Vehicle(mass=b), 0.2, on_failure="nan"
            ).b.delta_v
        }

    a, b, v, rho = 1500.0, 1200.0, 10.0, 0.8
    inputs = {"a": Normal(a, 30.0), "b": Normal(b, 40.0), "v": Normal(v, 0.3)}
    found = local(model, inputs, "first_order", correlation={("a", "b"): rho})
    value = 1.2 * v * a / (a + b)
    by_a, by_b, by_v = (
        1.2 * v * b / (a + b) ** 2 * 30.0,
        -1.2 * v * a / (a + b) ** 2 * 40.0,
        value / v * 0.3,
    )
    masses = by_a**2 + by_b**2 + 2.0 * rho * by_a * by_b
    assert found.mean == pytest.approx(value, rel=1e-15)
    assert found.std == pytest.approx(math.sqrt(masses + by_v**2), rel=FIRST)
    assert found.contributions["a & b"] == pytest.approx(masses / (masses + by_v**2), rel=FIRST)
    assert list(found.contributions) == ["v", "a & b"]


@pytest.mark.filterwarnings("ignore:method=:collisions.OutOfRangeWarning")
def test_first_order_knows_the_deviation_of_any_input():
    """Of a straight model the variances add, whatever the distributions."""
    inputs = {
        "a": Uniform(0.0, 1.0),
        "b": Triangular(0.0, 1.0, 4.0),
        "c": LogNormal(2.0, 0.3),
        "d": Normal(0.2, 0.1, truncate=(0.0, 1.0)),
        "e": Samples([1.0, 2.0, 4.0, 5.0]),
    }
    found = local(
        lambda a, b, c, d, e: {"y": a - b + 2.0 * c - 3.0 * d + 0.1 * e}, inputs, "first_order"
    )
    weights = {"a": 1.0, "b": -1.0, "c": 2.0, "d": -3.0, "e": 0.1}
    assert found.mean == pytest.approx(
        sum(weights[name] * one.mean for name, one in inputs.items()), rel=1e-14
    )
    assert found.std == pytest.approx(
        math.sqrt(sum((weights[name] * one.sd) ** 2 for name, one in inputs.items())), rel=1e-12
    )


# Second order


def moments(values):
    """Mean, deviation and skewness of equally likely values."""
    mean, sd = np.mean(values), np.std(values)
    return mean, sd, np.mean(((values - mean) / sd) ** 3)


@pytest.mark.filterwarnings("ignore:method=:collisions.OutOfRangeWarning")
def test_second_order_is_exact_on_quadratics_of_normals():
    """Mean and variance of q = g.u + u.H.u/2: tr(HC)/2 and g.C.g + tr(HCHC)/2; the third moment of
    an independent textbook form (A. M. Mathai and S. B. Provost, "Quadratic Forms in Random
    Variables", 1992): 3 g.CHC.g + tr((HC)^3)."""
    sd = np.array([0.5, 2.0, 1.0])
    rho = {("a", "b"): 0.6, ("b", "c"): -0.4}
    correlated = np.array([[1.0, 0.6, 0.0], [0.6, 1.0, -0.4], [0.0, -0.4, 1.0]])
    covariance = correlated * np.outer(sd, sd)
    g = np.array([1.0, -0.5, 2.0])
    h = np.array([[0.8, 0.3, 0.0], [0.3, -0.2, 0.5], [0.0, 0.5, 1.1]])

    def model(a, b, c):
        u = np.stack([a - 1.0, b - 2.0, c + 3.0])
        return {"y": 7.0 + g @ u + 0.5 * np.einsum("in,ij,jn->n", u, h, u)}

    inputs = {"a": Normal(1.0, 0.5), "b": Normal(2.0, 2.0), "c": Normal(-3.0, 1.0)}
    found = local(model, inputs, "second_order", correlation=rho)
    hc = h @ covariance
    variance = g @ covariance @ g + 0.5 * np.trace(hc @ hc)
    third = 3.0 * g @ covariance @ h @ covariance @ g + np.trace(hc @ hc @ hc)
    assert found.mean == pytest.approx(7.0 + 0.5 * np.trace(hc), rel=1e-9)
    assert found.std == pytest.approx(math.sqrt(variance), rel=1e-9)
    assert found.skewness == pytest.approx(third / variance**1.5, rel=1e-8)


@pytest.mark.filterwarnings("ignore:method=:collisions.OutOfRangeWarning")
@pytest.mark.parametrize(
    ("one", "other"),
    [
        (Uniform(0.0, 2.0), Triangular(0.0, 0.5, 3.0)),
        (LogNormal(1.0, 0.2), Normal(0.1, 0.1, truncate=(0.0, 1.0))),
        (Samples([0.0, 1.0, 1.5, 4.0]), Uniform(-1.0, 1.0)),
    ],
)
def test_second_order_is_exact_on_quadratics_of_other_inputs(one, other):
    """Mean and deviation, first and total contributions: of y = 2 u + u^2/2 - v + 0.3 v^2 + 0.7 u
    v, u and v independent and counted from their means, every moment follows from theirs: var(2u +
    u^2/2) = 4 m2 + 2 m3 + (m4 - m2^2)/4, and so on."""

    def model(u, v):
        u, v = u - one.mean, v - other.mean
        return {"y": 5.0 + 2.0 * u + 0.5 * u * u - v + 0.3 * v * v + 0.7 * u * v}

    found = local(model, {"u": one, "v": other}, "second_order")

    def variance(slope, bend, stated):
        m2, m3, m4 = stated.sd**2, stated.skewness * stated.sd**3, stated.kurtosis * stated.sd**4
        return slope**2 * m2 + 2.0 * slope * bend * m3 + bend**2 * (m4 - m2**2)

    by_u, by_v, by_both = (
        variance(2.0, 0.5, one),
        variance(-1.0, 0.3, other),
        (0.7 * one.sd * other.sd) ** 2,
    )
    whole = by_u + by_v + by_both
    assert found.mean == pytest.approx(5.0 + 0.5 * one.sd**2 + 0.3 * other.sd**2, rel=1e-9)
    assert found.std == pytest.approx(math.sqrt(whole), rel=1e-8)
    assert found.contributions == pytest.approx({"u": by_u / whole, "v": by_v / whole}, rel=1e-7)
    assert found.total_contributions == pytest.approx(
        {"u": (by_u + by_both) / whole, "v": (by_v + by_both) / whole}, rel=1e-7
    )


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:method=:collisions.OutOfRangeWarning")
def test_second_order_skewness_of_inputs_that_are_not_normal():
    """Of a slightly bent model of a uniform input: to first power of the bend, 6 g^2 (h/2) (m4 -
    m2^2)/2 of its moments, which is 0.4 of what a normal input gives. The exact skewness from a
    million evenly spaced quantiles."""
    bend = 0.02
    found = local(
        lambda u: {"y": u + 0.5 * bend * u * u},
        {"u": Uniform(-math.sqrt(3.0), math.sqrt(3.0))},
        "second_order",
    )
    u = math.sqrt(3.0) * (2.0 * (np.arange(10**6) + 0.5) / 10**6 - 1.0)
    _, _, skewness = moments(u + 0.5 * bend * u * u)
    # What is left out goes with the third power of the bend.
    assert found.skewness == pytest.approx(skewness, rel=4.0 * bend)
    assert found.skewness == pytest.approx(0.4 * 3.0 * bend, rel=0.01)


def test_second_order_quantiles_are_shifted_by_the_skewness():
    """Kinetic energy of a normal speed, a scaled noncentral chi-squared: its 95 percent range is
    the squares of that of the speed, since no speed is negative. What the next term would shift is
    the skewness squared over 36 times 2 z^3 - 5 z: 0.015."""
    inputs = {"v": Normal(20.0, 2.0)}
    low, high = 0.5 * (20.0 - 1.9599639845 * 2.0) ** 2, 0.5 * (20.0 + 1.9599639845 * 2.0) ** 2
    second = local(lambda v: {"y": 0.5 * v * v}, inputs, "second_order")
    assert second.interval(0.95) == pytest.approx((low, high), abs=0.02 * second.std)
    assert second.std == pytest.approx(math.sqrt((20.0 * 2.0) ** 2 + 0.5 * 2.0**4), rel=1e-9)


@pytest.mark.filterwarnings("ignore:method=:collisions.OutOfRangeWarning")
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_quantiles_of_a_local_method_never_fall(sign):
    """Of a square, whose skewness the first term of Cornish and Fisher cannot bear, neither tail
    turns back.
    """
    found = local(lambda x: {"y": sign * x**2}, {"x": Normal(0.0, 1.0)}, "second_order")
    at = found.quantile(np.linspace(0.0, 1.0, 2001))
    assert np.all(np.diff(at) >= 0.0)
    assert not np.isnan(at).any()
    assert abs(found.quantile(1.0 if sign > 0.0 else 0.0)) == math.inf
    assert found.interval(0.9)[0] < found.interval(0.9)[1]


@both_orders
def test_nothing_that_spreads(method):
    """An output that does not depend on the inputs has no deviation, no skewness and no shares to
    give.
    """
    found = local(lambda x: {"y": 3.0 + 0.0 * x}, {"x": Normal(0.0, 1.0)}, method)
    assert (found.mean, found.std, found.quantile(0.0), found.interval(0.95)) == (
        3.0,
        0.0,
        3.0,
        (3.0, 3.0),
    )
    assert found.quantile([0.0, 0.5]).tolist() == [3.0, 3.0]
    assert math.isnan(found.contributions["x"])


# Extremes


@both_orders
@pytest.mark.parametrize(
    ("mean", "sd"),
    [(1e-9, 1e-11), (1e12, 1e10), (1e12, 1e3), (-1e12, 1e3), (1e12, 1.0), (0.0, 1e-9)],
)
def test_inputs_of_any_size(method, mean, sd):
    """y = 3 x + 2: exact but for rounding of the value, over the step, in deviations: at worst a
    step of 1e6 roundings of the mean is known to a millionth."""
    found = local(lambda x: {"y": 3.0 * x + 2.0}, {"x": Normal(mean, sd)}, method)
    assert found.mean == pytest.approx(3.0 * mean + 2.0, rel=1e-12, abs=1e-12)
    assert found.std == pytest.approx(3.0 * sd, rel=1e-5, abs=1e-13 * abs(2.0 + 3.0 * mean))


@both_orders
@pytest.mark.parametrize("sd", [1e-2, 1e-1, 1.0])
def test_a_deviation_near_the_rounding_of_the_mean(method, sd):
    """At 1e12 numbers lie 1.2e-4 apart, so a hundredth of such a deviation is no step at all; the
    answer is not 0 for that.
    """
    found = local(lambda x: {"y": 2.0 * x}, {"x": Normal(1e12, sd)}, method)
    assert found.std == pytest.approx(2.0 * sd, rel=1e-5)
    assert found.mean == 2e12


@both_orders
def test_rounding_is_no_curvature(method):
    """An output of 1e12 that moves by 1: second differences are nothing but rounding, which is not
    taken for a bend.
    """
    inputs = {name: Normal(0.0, 1.0) for name in "abc"}
    found = local(lambda a, b, c: {"y": 1e12 + 100.0 * (a + b - c)}, inputs, method)
    assert found.mean == 1e12
    # 1.5 roundings of 1.2e-4 over the step of 0.01, in each of three inputs.
    assert found.std == pytest.approx(100.0 * math.sqrt(3.0), abs=0.05)


@pytest.mark.filterwarnings("ignore:method=:collisions.OutOfRangeWarning")
@both_orders
@pytest.mark.parametrize(
    "stated",
    [
        Normal(0.0, 0.1, truncate=(0.0, 1.0)),
        Normal(-0.5, 0.1, truncate=(0.0, 1.0)),
        Normal(0.05, 1e-3, truncate=(0.0499, 0.0501)),
        Uniform(0.0, 1e-9),
        Samples([0.0] * 400 + [1.0]),
    ],
)
def test_no_step_leaves_what_an_input_can_be(method, stated):
    """A model that does not exist outside the support is never asked there, nor at its ends by the
    derivatives.
    """
    low, high = stated.support
    asked = []

    def model(x):
        asked.append((x.min(), x.max(), x.size))
        return {"y": 2.0 * x}

    found = local(model, {"x": stated}, method)
    assert all(low <= least and most <= high for least, most, _ in asked)
    assert low < asked[0][0] < asked[0][1] < high
    assert asked[0][2] == 5
    assert found.std == pytest.approx(2.0 * stated.sd, rel=1e-5)


def test_how_often_the_model_is_asked():
    """One call for all derivatives: 1 + 4 n cases, and 2 n (n - 1) more for the second ones; and
    the probes.

    Between them one case is asked again alone, that of the greatest answer, and the four of the
    least together."""
    sizes = []

    def model(**inputs):
        sizes.append(len(inputs["a"]))
        return {"y": sum(inputs.values())}

    for method, expected in (("first_order", 13), ("second_order", 25)):
        found = propagate(model, {name: Normal(0.0, 1.0) for name in "abc"}, method=method)
        assert sizes == [expected, 1, 4, 4096]
        assert (found.samples, found.failed, found.seed) == (expected + 4096, 0, None)
        sizes.clear()


def test_local_results_are_not_random():
    """Two runs agree in every figure."""
    model, inputs, _ = SCENES["chain"]
    one, other = (propagate(model, inputs, method="second_order").to_dict() for _ in range(2))
    assert one == other


# Against sampling, on real scenes


@pytest.mark.slow
@both_orders
def test_a_nearly_straight_scene(method):
    """The chain from marks through travel and momentum: no warning, and within a tenth of the
    deviation of the reference, which is what a local method promises; in fact within a fiftieth."""
    model, inputs, _ = SCENES["chain"]
    found, codes = codes_of(lambda: propagate(model, inputs, method=method))
    assert codes == []
    sampled = propagate(model, inputs, method="quasi_random", seed=2)
    for name in found:
        away = 0.1 if method == "first_order" else 0.02
        assert found[name].mean == pytest.approx(sampled[name].mean, abs=away * sampled[name].std)
        assert found[name].std == pytest.approx(sampled[name].std, rel=away)
        assert found[name].interval() == pytest.approx(
            sampled[name].interval(), abs=2.0 * away * sampled[name].std
        )
        for key, (error, _) in sampled[name].contribution_standard_errors.items():
            assert (
                abs(found[name].contributions[key] - sampled[name].contributions[key])
                < 6.5 * error + 0.01
            )


def side_impact(friction_sd, **options):
    """The kink of sliding and sticking lies at a friction of about 0.45 here."""
    model, inputs, _ = SCENES["stick_slip"]
    inputs = {
        "speed_a": Normal(15.0, 0.1),
        "speed_b": Normal(10.0, 0.1),
        "restitution": 0.1,
        "friction": Normal(0.55, friction_sd, truncate=(0.0, None)),
    }
    return propagate(model, inputs, **options)


@both_orders
def test_a_friction_limit_within_the_spread(method):
    """Both regimes lie within one deviation: at the mean the contact sticks and friction counts for
    nothing there.
    """
    kink = 0.5 * abs(_critical_ratio())
    assert 0.1 < kink < 0.6
    found, codes = codes_of(lambda: side_impact(0.25, method=method))
    assert codes == ["not_local"]
    truth = side_impact(0.25, method="quasi_random", seed=1)
    assert abs(found["yaw"].std / truth["yaw"].std - 1.0) > 0.1
    # Far from the limit the same scene is nothing to warn of.
    assert codes_of(lambda: side_impact(0.01, method=method))[1] == []


def _critical_ratio():
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.2, y=0.0, vx=15.0)
    b = col.Vehicle(mass=1300.0, yaw_inertia=2100.0, x=0.9, y=-0.4, vy=10.0)
    return col.eccentric(
        a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=10.0
    ).critical_impulse_ratio


@both_orders
def test_a_truncation_in_the_model(method):
    """A restitution that the model clips, as an analyst does who has not heard of truncate=."""

    def model(speed, restitution):
        a, b = col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1200.0)
        impact = col.linear_central(a, b, np.clip(restitution, 0.0, 1.0), on_failure="nan")
        return {"delta_v": impact.b.delta_v}

    inputs = {"speed": Normal(10.0, 0.1), "restitution": Normal(0.1, 0.2)}
    with pytest.warns(
        col.OutOfRangeWarning,
        match=f"method='{method}' differs from cases drawn .* delta_v by [01]",
    ) as caught:
        propagate(model, inputs, method=method)
    (warning,) = [record.message for record in caught]
    assert warning.code == "not_local"
    assert warning.fields["differences"]["delta_v"] > 0.1
    assert "quasi_random" in str(warning)
    assert caught[0].filename == __file__


@both_orders
def test_refusals_beside_the_mean(method):
    """Cases that do not collide: the share of them is counted, and stated."""

    def model(speed):
        a, b = col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1200.0, vx=10.0)
        return {"delta_v": col.linear_central(a, b, 0.2, on_failure="nan").b.delta_v}

    with pytest.warns(col.OutOfRangeWarning, match="cases without an answer among") as caught:
        found = propagate(model, {"speed": Normal(11.0, 1.0)}, method=method)
    assert [record.message.code for record in caught] == ["not_local"]
    assert caught[0].message.fields["failed"] == found.failed
    # The normal probability below -1, of 4096 even points: 649.9 with a binomial deviation of 23.4
    # at most.
    assert abs(found.failed - 649.9) < 23.4


@both_orders
def test_no_derivative_at_the_mean(method):
    """Refused: the model has no answer there, or beside."""

    def model(speed):
        a, b = col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1200.0, vx=10.0)
        return {"delta_v": col.linear_central(a, b, 0.2, on_failure="nan").b.delta_v}

    for mean in (9.0, 10.0, 10.01):
        with pytest.raises(
            col.NoSolutionError, match=r"'delta_v' at or beside the mean .*quasi_random"
        ) as caught:
            propagate(model, {"speed": Normal(mean, 1.0)}, method=method)
        assert caught.value.code == "no_derivative"


@both_orders
def test_a_model_with_no_answer_but_at_the_mean(method):
    """Said to differ everywhere, not divided by nothing."""
    with pytest.warns(
        col.OutOfRangeWarning, match="y everywhere and knows nothing of the 4096 cases"
    ):
        found = propagate(
            lambda x: {"y": x if len(x) < 4096 else np.full(len(x), np.nan)},
            {"x": Normal(0.0, 1.0)},
            method=method,
        )
    assert found["y"].std == pytest.approx(1.0)


def test_a_heavy_tail_is_no_local_matter():
    """A factor of two either way through a cube."""
    with pytest.warns(col.OutOfRangeWarning, match="not_local|differs"):
        propagate(lambda x: {"y": x**3}, {"x": LogNormal(1.0, 0.6)}, method="second_order")


# Directions


def struck(course):
    """The direction of the force on a car that is struck from behind: pi, whichever way
    it stands.
    """
    a = col.Vehicle(mass=1500.0, vx=15.0, heading=0.0)
    b = col.Vehicle(mass=1200.0, heading=course)
    return col.oblique_central(a, b, 0.1, normal=0.0, friction=0.0, on_failure="nan").b


@both_orders
def test_a_direction_across_pi(method):
    """With its unit it is one: mean pi, the deviation of the heading, and no warning. Without, the
    jump is refused.
    """
    inputs = {"course": Normal("0 deg", "5 deg")}
    found = propagate(lambda course: {"pdof": struck(course).q.pdof}, inputs, method=method)["pdof"]
    assert abs(found.mean) == pytest.approx(math.pi, rel=1e-15)
    assert found.std == pytest.approx(math.radians(5.0), rel=1e-9)
    with pytest.raises(
        col.NoSolutionError,
        match="a bend or a jump in 'pdof' at the mean of the inputs, along 'course'",
    ):
        propagate(lambda course: {"pdof": struck(course).pdof}, inputs, method=method)


@both_orders
def test_a_bend_at_the_mean_is_refused(method):
    """Where the contact just sticks the slopes on both sides differ, and a difference across says
    nothing of either.
    """
    a = col.Vehicle(mass=1500.0, vx=15.0, yaw_inertia=2500.0, x=-2.0, y=0.0)
    b = col.Vehicle(mass=1200.0, vy=8.0, yaw_inertia=1900.0, x=1.0, y=0.5)

    def ask(friction):
        return col.eccentric(
            a, b, 0.1, normal=0.0, point=(0.0, 0.2), friction=friction, on_failure="nan"
        )

    limit = abs(ask(0.1).critical_impulse_ratio)
    for mean in (limit, limit + 0.001, limit - 0.0015):
        with pytest.raises(
            col.NoSolutionError, match=r"a bend or a jump in 'yaw rate'.* along 'friction'"
        ) as caught:
            propagate(
                lambda friction: {"yaw rate": ask(friction).b.delta_yaw_rate},
                {"friction": Normal(mean, 0.1)},
                method=method,
            )
        assert caught.value.code == "no_derivative"
    with pytest.raises(col.NoSolutionError, match="along 'x'"):
        propagate(
            lambda x, y: {"z": np.abs(x) + y},
            {"x": Normal(0.0, 1.0), "y": Normal(3.0, 1.0)},
            method=method,
        )


@both_orders
@pytest.mark.parametrize(
    "curve",
    [np.exp, np.sin, lambda x: x**4, lambda x: 1.0 / x, np.log, np.tan],
    ids=["exponential", "sine", "fourth power", "inverse", "logarithm", "tangent"],
)
def test_a_smooth_model_is_no_bend(curve, method):
    """However curved it is: here the deviation of the input is half of the scale on which the model
    bends.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.OutOfRangeWarning)
        found = propagate(
            lambda x: {"y": curve(x)}, {"x": Normal(1.0, 0.5, truncate=(0.2, 1.8))}, method=method
        )
    assert math.isfinite(found["y"].std)


@pytest.mark.slow
@both_orders
def test_a_direction_across_pi_over_an_interval(method):
    """The bounds stand on one side of the cut: 8 degrees either way, and the deviation in each
    place that of the heading.
    """
    inputs = {"course": Normal("0 deg", "2 deg"), "more": Interval("-8 deg", "8 deg")}
    found = propagate(
        lambda course, more: {"pdof": struck(course + more).q.pdof}, inputs, method=method
    )["pdof"]
    low, high = found.mean
    assert high - low == pytest.approx(math.radians(16.0), rel=1e-9)
    assert abs(0.5 * (low + high)) == pytest.approx(math.pi, rel=1e-12)
    assert found.std == pytest.approx((math.radians(2.0),) * 2, rel=1e-9)


@both_orders
def test_a_rotation_is_no_direction(method):
    """One and a half turns stay so."""
    found = propagate(lambda x: {"turn": x * ureg.radian}, {"x": Normal(9.0, 0.5)}, method=method)[
        "turn"
    ]
    assert (found.mean, found.unit) == (9.0, "rad")
    assert found.std == pytest.approx(0.5, rel=1e-9)
    assert found.q.std.units == ureg.radian


# With intervals


@both_orders
def test_an_interval_gives_bounds_on_what_is_local(method):
    """The mean at both ends, the deviation where it is least and most: y = k x."""
    found = propagate(
        lambda x, k: {"y": k * x}, {"x": Normal(10.0, 1.0), "k": Interval(1.0, 3.0)}, method=method
    )["y"]
    assert found.mean == pytest.approx((10.0, 30.0), rel=1e-12)
    assert found.std == pytest.approx((1.0, 3.0), rel=1e-9)
    low, high = found.interval(0.95)
    assert (low, high) == pytest.approx(
        (10.0 - 1.959963984540054, 30.0 + 3.0 * 1.959963984540054), rel=1e-9
    )
    assert math.isnan(found.mean_standard_error)


@pytest.mark.slow
@both_orders
def test_a_local_warning_is_given_once_over_an_interval(method):
    """Not at each of the places, and with the worst of them."""
    with pytest.warns(col.OutOfRangeWarning) as caught:
        propagate(
            lambda x, k: {"y": k + np.abs(x)},
            {"x": Normal(0.5, 1.0), "k": Interval(0.0, 1.0)},
            method=method,
        )
    assert [record.message.code for record in caught] == ["not_local"]


def test_more_inputs_than_points_are_spread_over():
    """33 independent inputs are refused, and the message names what takes them; 32 are not."""
    inputs = {f"x{i}": Normal(0.0, 1.0) for i in range(33)}
    for method in (*LOCAL, "quasi_random"):
        with pytest.raises(
            col.InputError,
            match=r"33 independent inputs are more than the 32 .* method='monte_carlo'",
        ) as caught:
            propagate(lambda **x: {"y": sum(x.values())}, inputs, method=method)
        assert caught.value.code == "too_many_inputs"
    for method in ("monte_carlo", "latin_hypercube"):
        found = propagate(
            lambda **x: {"y": sum(x.values())}, inputs, method=method, samples=1024, seed=1
        )["y"]
        assert abs(found.std - math.sqrt(33.0)) < 6.5 * found.std_standard_error
    del inputs["x0"]
    assert propagate(lambda **x: {"y": sum(x.values())}, inputs, method="first_order")[
        "y"
    ].std == pytest.approx(math.sqrt(32.0))


def test_a_local_answer_of_next_to_nothing():
    """What differs by the least of all floats is rounding; what jumps beside the mean is none."""
    inputs = {"x": Normal(1212.0, 130.9, truncate=(0.0, None))}
    found = propagate(lambda x: {"y": np.arctan2(-1e-320, x)}, inputs, method="first_order")
    assert abs(found["y"].mean) < 1e-300
    with pytest.warns(col.OutOfRangeWarning):
        propagate(
            lambda x: {"y": np.where(abs(x - 1212.0) < 20.0, 1.0, 0.0 * x)},
            inputs,
            method="first_order",
        )


def test_a_correlation_that_is_an_array():
    with pytest.raises(col.InputError, match="correlation must be a dict") as refused:
        propagate(
            lambda x: {"y": x}, {"x": Normal(1.0, 0.1)}, method="first_order", correlation=np.eye(2)
        )
    assert refused.value.code == "bad_correlation"
