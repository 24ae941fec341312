"""Inputs of an uncertainty against 40 digits: quantiles, tails, moments of what a truncation keeps;
and what is refused.
"""

import copy
import math
import pickle
import random
import statistics
from dataclasses import FrozenInstanceError
from itertools import pairwise
from typing import ClassVar

import mpmath as mp
import numpy as np
import pint
import pytest

import collisions as col
from collisions.quantities.units import si_unit
from collisions.uncertainty import (
    Censored,
    Distribution,
    Interval,
    LogNormal,
    Normal,
    Samples,
    Triangular,
    Uniform,
    normal,
    normal_family,
)
from collisions.uncertainty.distribution import from_numbers
from collisions.uncertainty.model import read_input
from strategies import other_registry

EPS = 2.0**-52
INF = math.inf
KMH = 1 / 3.6


@pytest.fixture(autouse=True)
def forty_digits():
    with mp.workdps(40):
        yield


def refusal(call):
    with pytest.raises(col.CollisionsError) as caught:
        call()
    return caught.value


def below(z):
    """The normal probability below z; erfc, because 1 - 1e-300 is 1 even in 40 digits."""
    return mp.erfc(-mp.mpf(z) / mp.sqrt(2)) / 2


def exact_score(lower, upper):
    """The z with these probabilities below and above: Newton's method on the logarithm of the
    smaller one, in 40 digits.
    """
    tail, side = (lower, -1) if lower <= upper else (upper, 1)
    tail = mp.mpf(tail)
    distance = mp.mpf(abs(normal.quantile(float(min(tail, 0.5)) or 5e-324)))
    for _ in range(60):
        found = below(-distance)
        step = mp.log(found / tail) * found / mp.npdf(distance)
        distance += step
        if abs(step) < mp.mpf(10) ** -36:
            return side * distance
    raise AssertionError(f"no score found for {lower}, {upper}")


# The standard normal distribution

DRAWS = random.Random(1)
PROBABILITIES = [
    *(
        5e-324,
        1e-310,
        1e-300,
        1e-200,
        1e-100,
        1e-30,
        1e-16,
        1.3887943864964021e-11,
        1.388794386496403e-11,
        1e-9,
        1e-5,
        1e-3,
    ),
    *(
        0.0249,
        0.07499999999999996,
        0.075,
        0.07500000000000001,
        0.1,
        0.3,
        0.49999999,
        0.5 - 2**-54,
        0.5 + 2**-53,
    ),
    *(
        0.5001,
        0.7,
        0.925,
        0.9250000000000002,
        0.975,
        0.99,
        1 - 1e-6,
        1 - 1e-10,
        1 - 1e-13,
        1 - 1e-15,
        1 - 1e-16,
    ),
    *(DRAWS.random() for _ in range(100)),
    *(10 ** DRAWS.uniform(-300, -1) for _ in range(20)),
]


# Each polynomial has terms of one sign only, so that steps damp the roundings before them and two
# are left of each; with the quotient, the product, the root, the logarithm and the shift of the
# root, whose sum cancels at most once: 8 in all.
QUANTILE = 8 * EPS


@pytest.mark.parametrize("p", PROBABILITIES)
def test_quantile_against_forty_digits(p):
    exact = exact_score(mp.mpf(p), 1 - mp.mpf(p))
    assert abs(normal.quantile(p) - exact) <= QUANTILE * abs(exact)
    assert abs(normal.quantile(np.array([p]))[0] - exact) <= QUANTILE * abs(exact)


def test_quantile_against_the_standard_library():
    """The same algorithm by other hands: every coefficient, with what rounding may differ in."""
    given = np.array([p for p in PROBABILITIES if p > 1e-323])
    theirs = np.array([statistics.NormalDist().inv_cdf(p) for p in given])
    np.testing.assert_allclose(normal.quantile(given), theirs, rtol=QUANTILE, atol=0.0)


def test_quantile_at_and_outside_the_ends():
    for p, expected in ((0.0, -INF), (1.0, INF), (0.5, 0.0)):
        assert normal.quantile(p) == expected
    for p in (-1e-9, 1 + 1e-9, 2.0, -INF, INF, math.nan):
        assert math.isnan(normal.quantile(p))
    found = normal.quantile(np.array([[0.0, 1.0, 0.5], [-1e-9, 1 + 1e-9, math.nan]]))
    np.testing.assert_array_equal(found, [[-INF, INF, 0.0], [math.nan] * 3])


def test_quantile_keeps_shape_and_leaves_its_argument():
    p = np.linspace(0.01, 0.99, 12).reshape(3, 4)[:, ::2]
    before = p.copy()
    found = normal.quantile(p)
    assert found.shape == (3, 2)
    np.testing.assert_array_equal(p, before)
    np.testing.assert_allclose(
        found, [[normal.quantile(float(x)) for x in row] for row in p], rtol=QUANTILE
    )


SCORES = [
    *(
        -37.5,
        -30.0,
        -12.3,
        -8.0,
        -5.0,
        -1e-3,
        1e-300,
        0.0,
        0.1,
        1.0,
        3.0,
        4.999,
        5.0,
        5.001,
        8.0,
        25.0,
        37.5,
    ),
    *(DRAWS.uniform(-37, 37) for _ in range(40)),
    *(DRAWS.gauss(0, 2) for _ in range(100)),
]


@pytest.mark.parametrize("z", SCORES)
def test_both_tails_against_forty_digits(z):
    """The rounding of z**2 / 2 and of z over the root of two shows z**2-fold; 4 more are those of
    the rest.
    """
    within = (4 + z * z) * EPS
    for side, function in ((z, normal.cdf), (-z, normal.survival)):
        exact = below(side)
        assert abs(function(z) - exact) <= within * exact
        assert abs(function(np.array([z]))[0] - exact) <= within * exact
    for given in (z, np.array([z])):
        for found, side in zip(normal.both_tails(given), (z, -z), strict=True):
            assert abs(mp.mpf(float(np.squeeze(found))) - below(side)) <= within * below(side)
    assert normal.density(z) == pytest.approx(float(mp.npdf(z)), rel=within)


def test_tails_beyond_the_smallest_number():
    for z, low, high in ((-40.0, 0.0, 1.0), (40.0, 1.0, 0.0), (-INF, 0.0, 1.0)):
        assert normal.both_tails(z) == (low, high)
    lower, upper = normal.both_tails(np.array([[-40.0, 40.0]]))
    np.testing.assert_array_equal([lower, upper], [[[0.0, 1.0]], [[1.0, 0.0]]])


@pytest.mark.parametrize(
    "coverage",
    [1e-300, 1e-12, 0.1, 0.5, 0.6827, 0.85, 0.8500000000000002, 0.9, 0.95, 0.999, 1 - 1e-15],
)
def test_score_of_a_coverage(coverage):
    """The root of two times the inverse error function; the width of nearly nothing keeps its
    digits.
    """
    exact = mp.sqrt(2) * mp.erfinv(mp.mpf(coverage))
    assert abs(normal.score_of_coverage(coverage) - exact) <= QUANTILE * exact


# Moments


def test_the_rule_of_quadrature():
    """Nodes are the zeros of the Legendre polynomial of degree 12, weights those of the textbook,
    each to the last digit.
    """
    for x, weight in zip(normal_family._POSITIVE, normal_family._WEIGHTS, strict=True):
        zero = mp.findroot(lambda y: mp.legendre(12, y), mp.mpf(x))
        assert float(zero) == x
        assert float(2 * (1 - zero**2) / (12 * mp.legendre(11, zero)) ** 2) == weight


def exact_moments(weight, value, points):
    """Mean, deviation, skewness and kurtosis of a value under an unnormalised density.

    Gauss-Legendre quadrature in 40 digits, 48 nodes on each panel: exact to them for panels of two
    deviations.
    """
    rule = mp.calculus.quadrature.GaussLegendre(mp.mp).calc_nodes(5, mp.mp.prec)
    terms = []
    for start, end in pairwise(points):
        half, middle = (end - start) / 2, (end + start) / 2
        terms += [(half * w * weight(middle + half * x), value(middle + half * x)) for x, w in rule]
    total = mp.fsum(w for w, _ in terms)
    mean = mp.fsum(w * x for w, x in terms) / total
    second, third, fourth = (
        mp.fsum(w * (x - mean) ** k for w, x in terms) / total for k in (2, 3, 4)
    )
    sd = mp.sqrt(second)
    return mean, sd, third / sd**3, fourth / second**2


def panels(start, end, width=2):
    count = int(mp.ceil((end - start) / width))
    return mp.linspace(start, end, count + 1)


def kept_points(centre, scale, low, high, reach):
    """Scores from one bound to the other, or as far as the density reaches from the kept value
    nearest to the centre.
    """
    a = -mp.inf if low is None else (mp.mpf(low) - centre) / scale
    b = mp.inf if high is None else (mp.mpf(high) - centre) / scale
    return panels(max(a, min(max(a, 0), b) - 16), min(b, max(a, min(0, b)) + 16 + reach))


TRUNCATED = [
    (0.1, 0.1, 0.0, 1.0),
    (1500.0, 50.0, 0.0, None),
    (0.7, 0.07, 0.0, None),
    (0.5, 0.3, 0.0, 1.0),
    (0.0, 1.0, 0.0, None),
    (0.0, 1.0, 6.9, None),
    (0.0, 1.0, None, -6.9),
    (3.0, 2.0, None, 2.5),
    (0.0, 1.0, 5.0, 5.5),
    (0.0, 1.0, 1.0, 1.0 + 1e-9),
    (1.0, 1.0, 0.999, 1.002),
    (-2.0, 1.0, 0.0, None),
    (100.0, 30.0, -20.0, 400.0),
]


@pytest.mark.slow
@pytest.mark.parametrize(("mean", "sd", "low", "high"), TRUNCATED)
def test_moments_of_a_truncated_normal(mean, sd, low, high):
    """Weights and density are good to 4 roundings each near the mode, where all the weight is; a
    sum of terms of one sign keeps that: 8 on the mean in deviations and on the deviation, once more
    for every further power."""
    found = Normal(mean, sd, truncate=(low, high))
    points = kept_points(mp.mpf(mean), mp.mpf(sd), low, high, 0)
    middle = points[0] if points[0] > 0 else points[-1] if points[-1] < 0 else mp.mpf(0)
    where, spread, skewness, kurtosis = exact_moments(
        lambda z: mp.exp(-(z - middle) * (z + middle) / 2), lambda z: z, points
    )
    assert abs(found.mean - (mean + sd * where)) <= 8 * EPS * (abs(found.mean) + sd * spread)
    assert abs(found.sd - sd * spread) <= 8 * EPS * sd * spread
    assert abs(found.skewness - skewness) <= 24 * EPS * (1 + abs(skewness))
    assert abs(found.kurtosis - kurtosis) <= 32 * EPS * kurtosis
    assert found.support == (-INF if low is None else low, INF if high is None else high)
    assert (found.given_mean, found.given_sd, found.truncate) == (mean, sd, (low, high))


def test_half_normal():
    """Known in closed form."""
    half = Normal(0.0, 1.0, truncate=(0, None))
    pi = math.pi
    assert half.mean == pytest.approx(math.sqrt(2 / pi), rel=8 * EPS)
    assert half.sd == pytest.approx(math.sqrt(1 - 2 / pi), rel=8 * EPS)
    assert half.skewness == pytest.approx(math.sqrt(2) * (4 - pi) / (pi - 2) ** 1.5, rel=24 * EPS)
    assert half.kurtosis == pytest.approx(3 + 8 * (pi - 3) / (pi - 2) ** 2, rel=32 * EPS)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mean", "sd", "low", "high"),
    [
        *((1.0, ratio, None, None) for ratio in (1e-9, 1e-3, 0.3, 1.0, 10.0)),
        (7e5, 2e5, 5e5, None),
        (7e5, 2e5, None, 6e5),
        (7e5, 2e5, 5e5, 5e5 + 1e-3),
        (7e5, 2e5, -1.0, 9e5),
        (1.0, 1.0, 30.0, None),
        (1.0, 10.0, 1e-20, 1e6),
        (1.0, 10.0, None, 1e-5),
        (3.0, 1e-5, 2.99999, 3.00003),
    ],
)
def test_moments_of_a_lognormal(mean, sd, low, high):
    """Of the quantity itself. 40 roundings: the exponent is up to 4 deviations of the logarithm
    steeper than in the normal.
    """
    found = LogNormal(mean, sd, truncate=(low, high))
    ratio = mp.mpf(sd) / mp.mpf(mean)
    scale = mp.sqrt(mp.log(1 + ratio**2))
    centre = mp.log(mean) - scale**2 / 2
    bounds = [
        None if bound is None or bound <= 0 else mp.log(mp.mpf(bound)) for bound in (low, high)
    ]
    points = kept_points(centre, scale, *bounds, reach=4 * scale)
    middle = points[0] if points[0] > 0 else points[-1] if points[-1] < 0 else mp.mpf(0)
    where, spread, skewness, kurtosis = exact_moments(
        lambda z: mp.exp(-(z - middle) * (z + middle) / 2),
        lambda z: mp.exp(centre + scale * z),
        points,
    )
    assert abs(found.mean - where) <= 40 * EPS * where
    assert abs(found.sd - spread) <= 40 * EPS * spread
    assert abs(found.skewness - skewness) <= 80 * EPS * (1 + abs(skewness))
    assert abs(found.kurtosis - kurtosis) <= 160 * EPS * kurtosis


@pytest.mark.slow
@pytest.mark.parametrize(
    ("low", "mode", "high"),
    [(0.6, 0.7, 0.75), (0, 0, 1), (-3, 5, 5), (-1.0, 0.0, 1.0), (100, 100.1, 900)],
)
def test_moments_of_a_triangle(low, mode, high):
    found = Triangular(low, mode, high)
    low, mode, high = map(mp.mpf, (low, mode, high))

    def weight(x):
        return (
            (x - low) / (mode - low)
            if x < mode
            else (high - x) / (high - mode)
            if x > mode
            else mp.mpf(1)
        )

    mean, sd, skewness, kurtosis = exact_moments(weight, lambda x: x, sorted({low, mode, high}))
    assert abs(found.mean - mean) <= 4 * EPS * max(abs(low), high)
    assert abs(found.sd - sd) <= 8 * EPS * sd
    assert abs(found.skewness - skewness) <= 16 * EPS
    assert abs(found.kurtosis - kurtosis) <= EPS * kurtosis


def test_moments_of_a_uniform():
    found = Uniform(-1.0, 5.0)
    assert (found.mean, found.sd, found.skewness, found.kurtosis) == (
        2.0,
        pytest.approx(math.sqrt(3), rel=EPS),
        0.0,
        1.8,
    )
    assert found.support == (-1.0, 5.0)


SMOOTH = [
    Normal(16.7, 0.8),
    Normal(0.1, 0.1, truncate=(0, 1)),
    Normal(0.0, 1.0, truncate=(2, None)),
    Normal(1500, 50, truncate=(0, None)),
    LogNormal(7e5, 2e5),
    LogNormal(7e5, 2e5, truncate=(4e5, 9e5)),
    Uniform(-1.0, 5.0),
]


@pytest.mark.parametrize("distribution", SMOOTH, ids=repr)
def test_moments_are_those_of_what_is_drawn(distribution):
    """The trapezoidal rule over all scores, spectrally accurate for smooth values: what quantiles
    give has the stated moments.

    Steps of 1/16 leave exp(-2 pi**2 16**2), nothing; 1e-12 is the rounding of 400 values of up to
    12 deviations, fourth power.
    """
    z = np.arange(-12, 12.01, 1 / 16)
    weight = np.exp(-0.5 * z * z) / math.sqrt(2.0 * math.pi) / 16
    value = distribution.scored(z)
    away = (value - distribution.mean) / distribution.sd
    moments = [float(np.sum(weight * away**k)) for k in range(5)]
    expected = [1.0, 0.0, 1.0, distribution.skewness, distribution.kurtosis]
    assert moments == pytest.approx(
        expected, rel=1e-12, abs=1e-12 * distribution.mean / distribution.sd
    )


# Quantiles of the distributions

DEEP = [-37.0, -20.0, -9.0, -5.0, -2.0, -0.1, 0.0, 0.7, 1.96, 4.0, 9.0, 20.0, 37.0]


def truncated_exact(mean, sd, low, high, lower, upper):
    a = -mp.inf if low is None else (mp.mpf(low) - mean) / sd
    b = mp.inf if high is None else (mp.mpf(high) - mean) / sd
    lost, gone = (
        (below(a) if low is not None else mp.mpf(0)),
        (below(-b) if high is not None else mp.mpf(0)),
    )
    share = below(b) - lost if b <= 0 else below(-a) - gone
    return mean + sd * exact_score(lost + lower * share, gone + upper * share)


@pytest.mark.parametrize(
    ("mean", "sd", "low", "high"), [case for case in TRUNCATED if case[:2] != (1500.0, 50.0)]
)
def test_truncated_scores_against_forty_digits(mean, sd, low, high):
    """A share with a relative error of (z**2 + 8) roundings is a score with that over z, as the
    tail falls as exp(-z**2 / 2).
    """
    distribution = Normal(mean, sd, truncate=(low, high))
    found = distribution.scored(np.array(DEEP))
    for z, batch in zip(DEEP, found, strict=True):
        exact = truncated_exact(mp.mpf(mean), mp.mpf(sd), low, high, below(z), below(-z))
        score = abs((exact - mean) / sd)
        within = EPS * (2 * abs(mean) + sd * (4 * score + 16 / (1 + score)))
        assert abs(distribution.scored(z) - exact) <= within
        assert abs(batch - exact) <= within
        assert distribution.support[0] <= batch <= distribution.support[1]


def test_a_truncation_nobody_notices():
    """30 deviations below the mean: the whole, to the bit, but no value outside the bound."""
    mass, whole = Normal(1500.0, 50.0, truncate=(0, None)), Normal(1500.0, 50.0)
    assert (mass.mean, mass.sd, mass.skewness, mass.kurtosis) == (1500.0, 50.0, 0.0, 3.0)
    z = np.linspace(-10, 10, 101)
    np.testing.assert_array_equal(mass.scored(z), whole.scored(z))
    assert mass.quantile(0.0) == mass.scored(-37.0) == 0.0
    assert whole.scored(-37.0) == -350.0
    assert mass.support == (0.0, INF)


EVERY = [
    *SMOOTH,
    Normal(0.0, 1.0, truncate=(None, -6.0)),
    LogNormal(1.0, 10.0),
    LogNormal(1.0, 0.2, truncate=(None, 1.1)),
    Triangular(0.6, 0.7, 0.75),
    Triangular(0, 0, 1),
    Triangular(0, 1, 1),
]


@pytest.mark.parametrize("distribution", EVERY, ids=repr)
def test_a_score_is_the_quantile_of_its_probability(distribution):
    """Where the probability is held exactly enough: from 8 deviations below up to the middle;
    above, that of its complement.

    The probability is good to z**2 + 4 roundings and the quantile changes by its own reciprocal of
    them: 64 deviations' worth.
    """
    z = np.linspace(-8.0, 0.5, 52)
    scored, through = distribution.scored(z), distribution.quantile(normal.cdf(z))
    within = (
        64
        * EPS
        * (
            np.abs(scored) * (1 + 4 * distribution.sd / abs(distribution.mean))
            + abs(distribution.mean)
        )
    )
    assert np.all(np.abs(scored - through) <= within)
    one_by_one = np.array([distribution.scored(float(x)) for x in z])
    assert np.all(np.abs(scored - one_by_one) <= within)
    assert type(distribution.scored(0.3)) is type(distribution.quantile(0.3)) is float
    assert distribution.scored(z.reshape(4, 13)).shape == (4, 13)
    assert distribution.quantile(np.full((2, 3), 0.1)).shape == (2, 3)


def test_deep_tails_of_bounded_quantities():
    """Near each bound what is left of the way to it is as exact as the probability, on
    either side.
    """
    for z in (-37.0, -12.0, -9.0):
        tail, within = below(z), (8 + z * z) * EPS
        for given in (z, np.array([z])):
            assert np.squeeze(Uniform(0, 3).scored(given)) == pytest.approx(
                float(3 * tail), rel=within
            )
            assert np.squeeze(Uniform(-3, 0).scored(-given)) == pytest.approx(
                float(-3 * tail), rel=within
            )
            assert np.squeeze(Triangular(0, 1, 4).scored(given)) == pytest.approx(
                float(mp.sqrt(tail * 4)), rel=within
            )
            assert np.squeeze(Triangular(-4, -1, 0).scored(-given)) == pytest.approx(
                float(-mp.sqrt(tail * 4)), rel=within
            )


@pytest.mark.parametrize("p", [0.0, 1e-300, 0.2, 0.6666666666666666, 0.67, 0.9, 1 - 1e-16, 1.0])
def test_triangular_quantiles(p):
    """The closed form in 40 digits; the root makes the rounding of p half of one, the rest are the
    six operations.
    """
    low, mode, high = map(mp.mpf, (0.6, 0.7, 0.75))
    width = high - low
    exact = (
        low + mp.sqrt(p * width * (mode - low))
        if p <= (mode - low) / width
        else high - mp.sqrt((1 - mp.mpf(p)) * width * (high - mode))
    )
    found = Triangular(0.6, 0.7, 0.75).quantile(p)
    assert abs(found - exact) <= 4 * EPS
    assert Triangular(0.6, 0.7, 0.75).quantile(np.array([p]))[0] == found
    assert 0.6 <= found <= 0.75


@pytest.mark.parametrize("z", [-37.0, -3.0, 0.0, 2.5, 37.0])
def test_lognormal_scores(z):
    """The median times a factor; the exponent is up to 80 and so are its roundings, the scale
    brings a few of its own.
    """
    ratio = mp.mpf(10)
    scale = mp.sqrt(mp.log(1 + ratio**2))
    exact = mp.exp(-(scale**2) / 2 + scale * z)
    assert (
        abs(LogNormal(1.0, 10.0).scored(z) - exact) <= (8 + 4 * float(abs(scale * z))) * EPS * exact
    )


def test_ends_of_the_quantiles():
    assert (Normal(1, 2).quantile(0.0), Normal(1, 2).quantile(1.0)) == (-INF, INF)
    assert (LogNormal(1, 2).quantile(0.0), LogNormal(1, 2).quantile(1.0)) == (0.0, INF)
    kept = Normal(0.1, 0.1, truncate=(0, 1))
    assert (kept.quantile(0.0), kept.quantile(1.0)) == (0.0, 1.0)
    assert kept.scored(np.array([-60.0, 60.0])).tolist() == [0.0, 1.0]
    assert (Uniform(0.1, 0.3).quantile(0.0), Uniform(0.1, 0.3).quantile(1.0)) == (0.1, 0.3)
    assert LogNormal(1, 10).scored(1e6) == INF


@pytest.mark.parametrize("kind", [Normal, LogNormal])
@pytest.mark.parametrize(("low", "high"), [(0.65, 0.85), (1e-3, 2e4), (1499.9, 1500.1)])
@pytest.mark.parametrize("coverage", [0.5, 0.8, 0.9, 0.95, 0.9973, 1 - 1e-9])
def test_between_gives_the_range_back(kind, low, high, coverage):
    """The tails hold (1 - coverage) / 2 each, a p whose own rounding moves the ends by less than a
    rounding of the range.
    """
    found = kind.between(low, high, coverage)
    tail = 0.5 * (1 - coverage)
    half = normal.score_of_coverage(coverage)
    within = 16 * EPS * (high if kind is Normal else 1 + math.log(high / low))
    for score, p, end in ((-half, tail, low), (half, 1 - tail, high)):
        tolerance = within if kind is Normal else within * end
        assert abs(found.scored(score) - end) <= tolerance
        slope = (
            EPS
            / normal.density(half)
            * (found.sd if kind is Normal else end * math.log(high / low) / half)
        )
        assert abs(found.quantile(p) - end) <= tolerance + slope


def test_between_with_a_truncation():
    """The coverage is that of the whole, of which the truncation then keeps a part."""
    found = Normal.between("-1 m/s", "3 m/s", 0.95, truncate=("0 m/s", None))
    assert found == Normal(
        "1 m/s", f"{2 / normal.score_of_coverage(0.95)!r} m/s", truncate=(0, None)
    )
    assert found.mean > 1.0
    assert Normal.between(-1, 3, "95 percent").sd == pytest.approx(found.given_sd, rel=8 * EPS)
    assert LogNormal.between(1, 4, 0.9, truncate=(None, 3)).support == (0.0, 3.0)


# Samples

VALUES = [0.74, 0.68, 0.71, 0.71]


def test_samples_are_their_empirical_distribution():
    found = Samples(VALUES)
    assert [found.quantile(p) for p in (0.0, 0.2499, 0.25, 0.5, 0.7499, 0.75, 1.0)] == [
        0.68,
        0.68,
        0.71,
        0.71,
        0.71,
        0.74,
        0.74,
    ]
    np.testing.assert_array_equal(found.quantile(np.array([[0.0, 0.99]])), [[0.68, 0.74]])
    assert found.scored(0.0) == 0.71
    assert found.scored(np.array([-9.0, 9.0, 40.0])).tolist() == [0.68, 0.74, 0.74]
    assert found.support == (0.68, 0.74)
    assert (found.rows.tolist(), found.group, found.unit) == (VALUES, None, "")
    assert found.mean == pytest.approx(statistics.fmean(VALUES), rel=EPS)
    assert found.sd == pytest.approx(statistics.pstdev(VALUES), rel=8 * EPS)
    values = [mp.mpf(x) for x in VALUES]
    mean = mp.fsum(values) / 4
    second, third, fourth = (mp.fsum((x - mean) ** k for x in values) / 4 for k in (2, 3, 4))
    # Each difference is good to a rounding of the values, 35 times the deviation, and skewness is
    # zero but for these.
    assert found.skewness == pytest.approx(float(third / second**1.5), abs=3 * 35 * EPS)
    assert found.kurtosis == pytest.approx(float(fourth / second**2), rel=4 * 35 * EPS)


def test_samples_with_units_are_copied_and_locked():
    given = np.array([36.0, 72.0, 54.0])
    found = Samples(other_registry().Quantity(given, "km/h"))
    given[0] = 0.0
    assert found.rows == pytest.approx([10.0, 20.0, 15.0], rel=2 * EPS)
    assert found.unit == "m/s"
    for one in (found, pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        assert not one.rows.flags.writeable
        assert one == found
    assert Samples(np.array([1, 2], dtype=np.float32)).rows.dtype == np.float64
    plain = np.array([1.0, 2.0])
    one = Samples(plain)
    plain[0] = 5.0
    assert one.rows[0] == 1.0
    assert plain.flags.writeable


def test_joint_samples_belong_together():
    found = Samples.joint(
        drag=VALUES, speed=pint.Quantity([50.0, 52.0, 49.0, 51.0], "km/h"), cls=[1, 2, 3, 5]
    )
    assert list(found) == ["drag", "speed", "cls"]
    assert len({one.group for one in found.values()}) == 1
    assert found["drag"].group is not None
    assert found["speed"].unit == "m/s"
    assert Samples.joint(drag=VALUES)["drag"] == Samples(VALUES)
    assert (
        Samples.joint(a=VALUES, b=VALUES)["a"].group != Samples.joint(a=VALUES, b=VALUES)["a"].group
    )
    assert found["drag"] != Samples(VALUES)
    apart = [pickle.loads(pickle.dumps(one)) for one in found.values()]
    assert apart == list(found.values())
    assert len({one.group for one in apart}) == 1
    assert repr(found["drag"]) == "Samples(4 values, mean=0.71, sd=0.02121, joint)"


# Units


@pytest.mark.parametrize(
    ("given", "unit"),
    [
        ("80 km/h", "m/s"), ("5 deg", "rad"), ("30 deg/s", "rad/s"), ("20 rpm", "rad/s"),
            ("2425 lb", "kg"), ("7 ft", "m"),
        ("1330 slug*ft**2", "kg*m**2"), ("9 kN*s", "N*s"), ("31000 ft*lbf", "J"),
            ("200 lbf/in", "N/m"), ("65 lbf/in**2", "N/m**2"),
        ("22.5 ft/s**2", "m/s**2"), ("100 ms", "s"), ("300 lbf", "N"), ("40 percent", ""),
            ("0.4", ""), (" 1e3 ", ""), (0.4, ""),
        ("5 W", "kg*m**2/s**3"), ("3 deg/s**2", "rad/s**2"), ("2 rad/m", "rad/m"),
            ("3 ft**2", "m**2"), ("12 V", "kg*m**2/s**3/A"),
        (other_registry().Quantity(5, "1/s"), "1/s"), (pint.Quantity(0.4), ""),
            (pint.Quantity(2, "m**0.5"), "m**0.5"),
    ],
)  # fmt: skip
def test_si_unit(given, unit):
    """And its own text is read as itself, so that a Quantity of it is of the same kind."""
    assert si_unit(given) == unit
    if unit:
        assert si_unit(pint.Quantity(1.0, unit)) == unit
        assert (
            pint.Quantity(1.0, unit).to_root_units().units == pint.Quantity(1.0, unit).units
            or unit[0] in "NJk"
        )


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ("1 Hz", "turns or as radians"), ("3 count", "turns or as radians"), ("5 dB", "turns"),
            ("0.7 g", "drag factor is a plain"),
        ("80 kmh", "'80 km/h' or '1100 kg'"), ("80 km/h 5", "one plain number and one unit"),
            ("", "one plain number"), ("abc", "abc"),
        ("5 pixel", "'5 pixel' cannot be taken as a number with a unit"),
            ("5 m/s/deg", "plain number in SI"),
        ("5 m/s/rad", "plain number in SI"), ("5 N*m/rad", "plain number in SI"),
            ("5 m*deg/s", "plain number in SI"),
        ("90 deg*deg", "plain number in SI"),
            (pint.Quantity(5.0, "m/s/turn"), "plain number in SI"),
    ],
)  # fmt: skip
def test_si_unit_refuses(given, says):
    error = refusal(lambda: si_unit(given, "speed"))
    assert (type(error), error.code) == (col.UnitsError, "bad_units")
    assert str(error).startswith("speed: ")
    assert says in str(error)


def test_units_are_read_once():
    """Factors are exact by definition; two roundings."""
    foreign = other_registry()
    for speed in (
        Normal("60 km/h", "3 km/h"),
        Normal(foreign.Quantity(60, "km/h"), pint.Quantity(3.0, "km/h")),
        Normal("60 km/h", f"{3 * KMH!r} m/s", truncate=(None, None)),
    ):
        assert (speed.mean, speed.sd, speed.unit) == (
            pytest.approx(60 * KMH, rel=2 * EPS),
            pytest.approx(3 * KMH, rel=2 * EPS),
            "m/s",
        )
        assert type(speed.mean) is float
    angle = Triangular("5 deg", "0.2 rad", "20 deg")
    assert (angle.mode, angle.unit) == (0.2, "rad")
    assert angle.support == pytest.approx((math.radians(5), math.radians(20)), rel=2 * EPS)
    assert Interval("1400 kg", "1.65 t").high == 1650.0
    assert Normal("40 percent", "5 percent").mean == pytest.approx(0.4, rel=EPS)
    assert Normal("0.4", 0.05) == Normal(0.4, "0.05")
    assert Normal("1500 kg", "50 kg", truncate=(0, None)).truncate == (0.0, None)
    for low, high in ((-math.inf, "1800 kg"), ("-inf", "1800 kg")):
        opened = Normal("1500 kg", "50 kg", truncate=(low, high))
        assert opened == Normal("1500 kg", "50 kg", truncate=(None, high))
    assert Uniform(0, "5 km/h").unit == "m/s"
    assert LogNormal("700 kN/m", "200 kN/m").mean == 700e3
    assert Normal(20, 1).unit == ""


# Refusals

BIG = 1.7e308


@pytest.mark.parametrize(
    ("call", "kind", "code", "says"),
    [
        (lambda: Normal("60 km/h", 3), col.UnitsError, "bad_units",
            "sd = 3 has no unit, but mean = '60 km/h' has one"),
        (lambda: Normal(60, "3 km/h"), col.UnitsError, "bad_units",
            "mean = 60 has no unit, but sd = '3 km/h' has one"),
        (lambda: Normal("60 km/h", "3 km/h", truncate=(1, None)), col.UnitsError, "bad_units",
            "truncate[0] = 1 has no unit"),
        (lambda: Uniform("0.4", "50 percent"), col.UnitsError, "bad_units",
            "low = '0.4' has no unit"),
        (lambda: Interval(pint.Quantity(3, "m"), 4), col.UnitsError, "bad_units",
            "high = 4 has no unit, but low = 3 meter"),
        (lambda: Normal("60 km/h", "3 kg"), col.UnitsError, "bad_units",
            "sd: '3 kg' cannot be taken as m/s"),
        (lambda: Normal("5 deg", "1 percent"), col.UnitsError, "bad_units",
            "sd: '1 percent' cannot be taken as rad"),
        (lambda: Normal("300 lbf", "10 lb"), col.UnitsError, "bad_units",
            "write for example '1 N'"),
        (lambda: Normal("20 degC", "1 degC"), col.UnitsError, "bad_units", "cannot be taken as K"),
        (lambda: Normal("0.7 g", "0.1 g"), col.UnitsError, "bad_units",
            "mean: what '0.7 g' is meant"),
        (lambda: Normal("fast", "3 km/h"), col.UnitsError, "bad_units", "mean: cannot read 'fast'"),
        (lambda: Normal(True, 1), col.InputError, "not_a_number", "mean must be a number"),
        (lambda: Normal(None, 1), col.InputError, "not_a_number", "mean must be a number"),
        (lambda: Normal(math.nan, 1), col.InputError, "not_finite", "mean is NaN"),
        (lambda: Normal(1, INF), col.InputError, "not_finite", "sd must be finite"),
        (lambda: Normal(1, 0), col.InputError, "not_positive",
            "sd must be > 0, got 0; of a quantity that is known exactly give the number"),
        (lambda: Normal("60 km/h", "-3.6 km/h"), col.InputError, "not_positive", "got -3.6 km/h"),
        (lambda: Normal([1.0, 2.0], 1), col.ShapeError, "bad_shape",
            "mean must be one number; for a set of measured values use Samples"),
        (lambda: Normal(1, np.ones(3)), col.ShapeError, "bad_shape", "sd must be one number"),
        (lambda: Normal(1, 1, truncate=(2, 1)), col.InputError, "bad_range",
            "the bounds of truncate must be in rising order, got 2 and 1"),
        (lambda: Normal(1, 1, truncate=(2, 2)), col.InputError, "bad_range", "rising order"),
        (lambda: Normal(1, 1, truncate=0), col.ShapeError, "bad_shape",
            "pair (low, high), where None leaves a side open, got 0"),
        (lambda: Normal(1, 1, truncate=(0, 1, 2)), col.ShapeError, "bad_shape", "pair (low, high)"),
        (lambda: Normal(1, 1, truncate=(INF, None)), col.InputError, "not_finite",
            "truncate[0] must be finite, got inf; write None for an end that is open"),
        (lambda: Normal("1 m", "1 m", truncate=("-inf m", None)), col.InputError, "not_finite",
            "truncate[0] must be finite, got '-inf m'; write None"),
        (lambda: Normal("10 mph", "1 mph", truncate=("0 mph", "20 m")), col.UnitsError,
            "bad_units", "truncate[1]: '20 m' cannot be taken as m/s"),
        (lambda: Censored(low=1.0, error=math.nan), col.InputError, "not_finite",
            "error is NaN; leave it out for a sharp bound"),
        (lambda: LogNormal.between(1, 2, 0.9, truncate=(0, math.nan)), col.InputError,
            "not_finite", "truncate[1] is NaN; write None"),
        (lambda: Normal(1, 1, truncate=(0, [1, 2])), col.ShapeError, "bad_shape",
            "truncate[1] must be one number"),
        (lambda: Normal(0, 1, truncate=(7.1, None)), col.InputError, "truncated_away",
            "leaves less than 1e-12 of the probability of Normal(mean=0, sd=1)"),
        (lambda: Normal("1 m", "1 m", truncate=("-1e9 m", "-1e8 m")), col.InputError,
            "truncated_away", "(-1000000000 m, -100000000 m)"),
        (lambda: Normal(0, 1, truncate=(None, -1e200)), col.InputError, "truncated_away",
            "wrong bound"),
        (lambda: Normal(0, 1, truncate=(1, 1 + 1e-12)), col.InputError, "truncated_away",
            "Uniform"),
        (lambda: Normal(0, BIG, truncate=(0, 5e-324)), col.InputError, "truncated_away", "Uniform"),
        (lambda: LogNormal(1, 1, truncate=(None, -1)), col.InputError, "truncated_away",
            "LogNormal"),
        (lambda: LogNormal(1, 1, truncate=(-1, 0)), col.InputError, "truncated_away", "LogNormal"),
        (lambda: LogNormal(0, 1), col.InputError, "not_positive",
            "mean must be > 0 for a lognormal distribution, got 0"),
        (lambda: LogNormal(1, 0), col.InputError, "not_positive", "sd must be > 0"),
        (lambda: LogNormal(1e-300, 1), col.InputError, "out_of_range",
            "LogNormal: its mean, its deviation or their ratio is too large"),
        (lambda: LogNormal(1, 1e30, truncate=(1, None)), col.InputError, "out_of_range",
            "slipped digit"),
        (lambda: LogNormal.between(0, 1, 0.9), col.InputError, "not_positive", "low must be > 0"),
        (lambda: LogNormal.between(1, 1e6, 0.01), col.InputError, "out_of_range", "mean"),
        (lambda: Normal.between(2, 1, 0.9), col.InputError, "bad_range",
            "low and high must be in rising order, got 2 and 1"),
        (lambda: Normal.between(1, 1, 0.9), col.InputError, "bad_range", "give the number itself"),
        (lambda: Normal.between(1, 2, 1), col.InputError, "bad_fraction",
            "coverage must be more than 0 and less than 1, such as 0.95, got 1"),
        (lambda: Normal.between(1, 2, 0.0), col.InputError, "bad_fraction", "got 0.0"),
        (lambda: Normal.between(1, 2, 95), col.InputError, "bad_fraction", "got 95"),
        (lambda: Normal.between(1, 2, np.array([0.9, 0.95])), col.InputError, "bad_fraction",
            "coverage"),
        (lambda: Normal.between(1, 2, True), col.InputError, "not_a_number",
            "coverage must be a number"),
        (lambda: Normal.between(1, 2, "5 m"), col.UnitsError, "bad_units", "coverage: '5 m'"),
        (lambda: Normal.between("1 m", 2, 0.9), col.UnitsError, "bad_units",
            "high = 2 has no unit"),
        (lambda: Uniform(1, 1), col.InputError, "bad_range", "give the number itself"),
        (lambda: Uniform(2, 1), col.InputError, "bad_range", "got 2 and 1"),
        (lambda: Uniform("350 deg", "10 deg"), col.InputError, "bad_range",
            ("got 350 deg and 10 deg; an angle that goes on across the end of the turn is "
             "counted on: write '350 deg' and '370 deg'")),
        (lambda: Interval("170 deg", "-170 deg"), col.InputError, "bad_range",
            "write '170 deg' and '190 deg'"),
        (lambda: Triangular("-10 deg", "-20 deg", "-20 deg"), col.InputError, "bad_range",
            "got -10 deg and -20 deg; exchange them"),
        (lambda: Normal("0 deg", "9 deg", truncate=("330 deg", "20 deg")), col.InputError,
            "bad_range", "write '330 deg' and '380 deg'"),
        (lambda: Normal.between("710 deg", "10 deg", 0.9), col.InputError, "bad_range",
            "write '710 deg' and '730 deg'"),
        (lambda: Uniform("10 deg", "10 deg"), col.InputError, "bad_range",
            "got 10 deg and 10 deg; of a quantity"),
        (lambda: Uniform(6.1, 0.2), col.InputError, "bad_range", "got 6.1 and 0.2; exchange them"),
        (lambda: Uniform("6 m", "1 m"), col.InputError, "bad_range",
            "got 6 m and 1 m; exchange them"),
        (lambda: Uniform(-BIG, BIG), col.InputError, "out_of_range", "Uniform"),
        (lambda: Triangular(0, 2, 1), col.InputError, "bad_range",
            "mode must be from low to high, 0 to 1, got 2"),
        (lambda: Triangular(1, 1, 1), col.InputError, "bad_range", "rising order"),
        (lambda: Triangular(-BIG, 0, BIG), col.InputError, "out_of_range", "Triangular"),
        (lambda: Interval(1, 1), col.InputError, "bad_range", "give the number itself"),
        (lambda: Interval(1, math.nan), col.InputError, "not_finite", "high is NaN"),
        (lambda: Samples([1.0]), col.InputError, "no_spread",
            "at least two different values, got 1;"),
        (lambda: Samples([]), col.InputError, "no_spread", "got 0;"),
        (lambda: Samples([2.0, 2.0]), col.InputError, "no_spread", "got 2 that are all the same"),
        (lambda: Samples([1.0, math.nan]), col.InputError, "not_finite",
            "values: value 1 is not a finite number"),
        (lambda: Samples([1.0, INF, 2.0]), col.InputError, "not_finite", "value 1"),
        (lambda: Samples([-BIG, BIG]), col.InputError, "out_of_range", "Samples"),
        (lambda: Samples(3.0), col.ShapeError, "bad_shape",
            "values must be an array or a list of values, got 3.0"),
        (lambda: Samples([[1.0, 2.0]]), col.ShapeError, "bad_shape",
            "one row of values, got shape (1, 2)"),
        (lambda: Samples(["1 m", "2 m"]), col.UnitsError, "bad_units", "put the unit on the whole"),
        (lambda: Samples("1 m"), col.ShapeError, "bad_shape", "got '1 m'"),
        (lambda: Samples.joint(), col.ShapeError, "bad_shape", "got none"),
        (lambda: Samples.joint(a=[1, 2], b=[1, 2, 3]), col.ShapeError, "bad_shape", "a 2, b 3"),
        (lambda: Samples.joint(a=[1, 2], b=[1, 1]), col.InputError, "no_spread", "b must hold"),
        (lambda: Normal(1, 1).quantile(1.5), col.InputError, "bad_fraction",
            "p must be a probability from 0 to 1"),
        (lambda: Samples(VALUES).quantile(np.array([0.5, math.nan])), col.InputError,
            "bad_fraction", "p must"),
        (lambda: Uniform(0, 1).scored(math.nan), col.InputError, "not_finite", "z must"),
        (lambda: read_input("e", True), col.InputError, "not_a_number", "e must be a number"),
        (lambda: read_input("e", np.bool_(True)), col.InputError, "not_a_number",
            "e must be a number"),
        (lambda: read_input("e", 1j), col.InputError, "not_a_number", "e must be a number"),
        (lambda: read_input("e", math.nan), col.InputError, "not_finite", "e is NaN"),
        (lambda: read_input("e", pint.Quantity(math.nan, "m")), col.InputError, "not_finite",
            "e is NaN"),
        (lambda: read_input("e", [1.0, np.float64(2.0)]), col.ShapeError, "bad_shape",
            "e is a list of 2 numbers; measured values are given as Samples(values)"),
        (lambda: read_input("e", [1]), col.ShapeError, "bad_shape",
            "e is a list of 1 number; measured"),
        (lambda: read_input("e", np.arange(3.0)), col.ShapeError, "bad_shape",
            "e is an array of shape (3,); measured values are given as Samples"),
        (lambda: read_input("v", pint.Quantity([1, 2], "m/s")), col.ShapeError, "bad_shape",
            "v is an array"),
        (lambda: read_input("law", "brach"), col.UnitsError, "bad_units",
            "law: cannot read 'brach'"),
        (lambda: read_input("law", "brach"), col.UnitsError, "bad_units",
            "the name of a law, is written into the model itself"),
        (lambda: read_input("v", "1 Hz"), col.UnitsError, "bad_units", "turns"),
        (lambda: read_input("v", pint.Quantity(1, "Hz")), col.UnitsError, "bad_units", "turns"),
    ],
)  # fmt: skip
def test_refusals(call, kind, code, says):
    error = refusal(call)
    assert (type(error), error.code) == (kind, code)
    assert says in str(error)


def test_what_cannot_be_read_is_refused_once():
    """As it was given, and not as the NaN that stands for it."""
    for call in (
        lambda: Normal("10 mph", "1 mph", truncate=("0 mph", "20 m")),
        lambda: Censored(low="10 mph", error="1 s"),
    ):
        assert "NaN" not in str(refusal(call))
    error = refusal(lambda: Normal("10 mph", "1 mph", truncate=("0 s", "20 m")))
    assert [one.fields["argument"] for one in error.fields["problems"]] == [
        "truncate[0]",
        "truncate[1]",
    ]


# What every input is


INPUTS = [
    *EVERY,
    Samples(VALUES),
    Interval("1400 kg", "1650 kg"),
    Normal("60 km/h", "3 km/h", truncate=("0 km/h", None)),
]


@pytest.mark.parametrize("stated", INPUTS, ids=repr)
def test_frozen_compared_by_value_and_pickled(stated):
    for again in (pickle.loads(pickle.dumps(stated)), copy.copy(stated), copy.deepcopy(stated)):
        assert again == stated
        assert hash(again) == hash(stated)
        assert again.unit == stated.unit
        if isinstance(stated, Distribution):
            assert (again.mean, again.sd, again.skewness, again.kurtosis) == (
                stated.mean,
                stated.sd,
                stated.skewness,
                stated.kurtosis,
            )
            assert again.quantile(0.3) == stated.quantile(0.3)
    for change in (
        lambda: setattr(stated, "unit", "m"),
        lambda: delattr(stated, "unit"),
        lambda: setattr(stated, "new", 1),
    ):
        with pytest.raises(FrozenInstanceError, match="frozen, make a new one"):
            change()
    assert not hasattr(stated, "__dict__")
    assert sum(stated == other for other in INPUTS) == 1
    assert stated != "a text"


def test_equality_looks_at_every_part():
    base = Normal(1.0, 2.0, truncate=(0, 3))
    for other in (
        Normal(1.5, 2.0, truncate=(0, 3)),
        Normal(1.0, 2.5, truncate=(0, 3)),
        Normal(1.0, 2.0, truncate=(0, None)),
        Normal(1.0, 2.0),
        Normal("1 m", "2 m", truncate=("0 m", "3 m")),
        LogNormal(1.0, 2.0, truncate=(0, 3)),
    ):
        assert base != other
    assert Uniform(1, 2) != Interval(1, 2)
    assert Samples([1, 2]) != Samples([2, 1])
    assert Normal(1, 2, truncate=(None, None)) == Normal(1, 2)
    assert not isinstance(Interval(1, 2), Distribution)


@pytest.mark.parametrize(
    ("stated", "text"),
    [
        (Normal("60 km/h", "3 km/h"), "Normal(mean=60 km/h, sd=3 km/h)"),
        (Normal(0.1, 0.1, truncate=(0, 1)), "Normal(mean=0.1, sd=0.1, truncate=(0, 1))"),
        (
            Normal("1500 kg", "50 kg", truncate=(0, None)),
            "Normal(mean=1500 kg, sd=50 kg, truncate=(0 kg, None))",
        ),
        (LogNormal(123456.7, 20000), "LogNormal(mean=123456.7, sd=20000)"),
        (Uniform("2 deg", "4 deg"), "Uniform(low=2 deg, high=4 deg)"),
        (Triangular(0.6, 0.7, 0.75), "Triangular(low=0.6, mode=0.7, high=0.75)"),
        (Interval("1400 kg", "1650 kg"), "Interval(low=1400 kg, high=1650 kg)"),
        (Samples(VALUES), "Samples(4 values, mean=0.71, sd=0.02121)"),
    ],
)
def test_shown(stated, text):
    assert repr(stated) == text


def test_read_input():
    vehicle, distribution, interval, pair = (
        col.Vehicle(mass=900),
        Normal(1, 2),
        Interval(1, 2),
        (1.0, 2.0),
    )
    for other in (vehicle, distribution, interval, pair, None, [pair], [], len, Samples(VALUES)):
        assert read_input("x", other) is other
    for given, expected in (
        (0.4, 0.4),
        (3, 3.0),
        (np.float32(0.5), 0.5),
        (np.array(2.0), 2.0),
        ("0.4", 0.4),
        ("36 km/h", 10.0),
        ("inf kg", INF),
        (INF, INF),
        (pint.Quantity(36, "km/h"), 10.0),
        (other_registry().Quantity(180.0, "deg"), math.pi),
    ):
        found = read_input("x", given)
        assert type(found) is float
        assert found == pytest.approx(expected, rel=2 * EPS)


@pytest.mark.parametrize("ask", ["quantile", "scored"])
@pytest.mark.parametrize(
    "given",
    ["x", "0.5", True, np.array([True]), None, 0.5j, pint.Quantity(0.5, "m"), pint.Quantity(0.5),
        np.ma.masked_array([0.5], [True]),
     object(), [[0.5], [0.1, 0.2]], pytest.param(10**400, id="too large")],
)  # fmt: skip
def test_what_is_no_plain_number_has_no_quantile(ask, given):
    """A unit is not dropped, a truth is no 1, and nobody else's error comes out."""
    with pytest.raises(col.InputError) as refused:
        getattr(Normal(10, 1), ask)(given)
    assert refused.value.code in ("bad_fraction", "not_a_number", "bad_shape", "out_of_range")


@pytest.mark.parametrize("coverage", [5e-324, 1e-320, 1e-300])
def test_a_coverage_of_next_to_nothing(coverage):
    """The range is so small a part of the distribution that its width in standard deviations is
    coverage times sqrt(pi/2).
    """
    if coverage == 1e-300:
        assert Normal.between(1, 2, coverage).sd == pytest.approx(
            0.5 / (coverage * math.sqrt(math.pi / 2.0)), rel=1e-13
        )
        return
    for between in (Normal.between, LogNormal.between):
        with pytest.raises(col.InputError) as refused:
            between(1, 2, coverage)
        assert refused.value.code == "out_of_range"


def test_a_score_far_out_is_at_the_end_of_the_range():
    """Of an array as of a number: nothing is above it, also where its square is too large for a
    float.
    """
    bounded = Normal(0.0, 1.0, truncate=(-1.0, 2.0))
    far = np.array([-math.inf, -1e300, -50.0, 50.0, 1e300, math.inf])
    assert (
        bounded.scored(far).tolist()
        == [-1.0] * 3 + [2.0] * 3
        == [bounded.scored(z) for z in far.tolist()]
    )


def test_a_lognormal_with_a_deviation_far_smaller_than_its_mean():
    """Bounds that cut nothing off leave it as it is; where half is cut off, it is half a normal,
    whose variance is 1 - 2/pi of it.
    """
    mean, sd = 6.885814622919143e305, 2.5402266878585364
    whole = LogNormal(mean, sd, truncate=(30.0, None))
    assert (whole.mean, whole.sd) == (mean, sd)
    for factor in (1.0, 1e-306 / sd):
        # The quadrature is good to some roundings.
        half = LogNormal(mean * factor, sd * factor, truncate=(mean * factor, None))
        assert half.sd == pytest.approx(sd * factor * math.sqrt(1.0 - 2.0 / math.pi), rel=1e-12)
        assert half.kurtosis == pytest.approx(
            3.8691773, rel=1e-7
        )  # (3 pi^2 - 4 pi - 12)/(pi - 2)^2
    few = LogNormal(1.0, 1e-200, truncate=(1.0, 2.0))
    assert few.sd == pytest.approx(1e-200 * math.sqrt(1.0 - 2.0 / math.pi), rel=1e-12)


@pytest.mark.parametrize("size", [2.4e-189, 1e-160, 1e-300, 1e200, 1e307])
def test_samples_whose_squares_leave_the_range_of_floats(size):
    """Moments against those of the same values in 40 digits, without a warning of numpy's; the
    skewness has no unit.
    """
    values = [0.0, -size, 3.0 * size, 0.5 * size]
    found = Samples(values)
    exact = [mp.mpf(value) for value in values]
    mean = mp.fsum(exact) / 4
    sd = mp.sqrt(mp.fsum((value - mean) ** 2 for value in exact) / 4)
    # A few roundings of sums of four numbers.
    assert found.mean == pytest.approx(float(mean), rel=8 * EPS)
    assert found.sd == pytest.approx(float(sd), rel=8 * EPS)
    assert found.skewness == pytest.approx(
        float(mp.fsum(((value - mean) / sd) ** 3 for value in exact) / 4), rel=32 * EPS
    )
    assert found.kurtosis == pytest.approx(
        float(mp.fsum(((value - mean) / sd) ** 4 for value in exact) / 4), rel=32 * EPS
    )


@pytest.mark.parametrize("make", [Uniform, lambda *ends: Samples(ends)])
def test_a_deviation_below_all_floats_is_refused(make):
    """As 0 it would be divided by, and say that the quantity is known exactly."""
    with pytest.raises(col.InputError, match="deviation is too small for a float64") as refused:
        make(0.0, 5e-324)
    assert refused.value.code == "out_of_range"


def test_a_score_whose_value_is_beyond_floats():
    assert Normal(1.0, 1e10).scored(np.array([-1e300, 1e300])).tolist() == [-math.inf, math.inf]


@pytest.mark.parametrize("options", [{}, {"truncate": (5.0, 13.0)}])
def test_a_lognormal_whose_deviation_is_nothing_beside_its_mean(options):
    """Their ratio is 0 as a float, with which no quantile and no truncation can be worked out."""
    with pytest.raises(col.InputError, match="nothing beside") as refused:
        LogNormal(9.6049022777862, 5e-324, **options)
    assert refused.value.code == "out_of_range"
    assert Normal(9.6, 5e-324).quantile(0.9) == 9.6


@pytest.mark.parametrize(
    ("given", "read"),
    [
        (Normal.between("28 mph", "32 mph", 0.95), "28 to 32 mph (95 percent), normal"),
        (Normal.between(0.6, 0.8, "99.7 percent"), "0.6 to 0.8 (99.7 percent), normal"),
        (
            Normal.between("-5 deg", 0, 0.07, truncate=("-6 deg", None)),
            "-5 to 0° (7 percent), at least -6°, normal",
        ),
        (LogNormal.between("20 mph", "40 mph", 0.95), "20 to 40 mph (95 percent), log-normal"),
    ],
)
def test_a_range_with_a_share_is_read_as_it_was_stated(given, read):
    assert str(given) == str(pickle.loads(pickle.dumps(given))) == str(copy.deepcopy(given)) == read
    plain = from_numbers(type(given), given.unit, given._parts)
    assert plain == given
    assert (hash(plain), repr(plain)) == (hash(given), repr(given))
    assert str(plain) != read


class Tailed(Distribution):
    """A kind of input with a part that is a pure number, as one might add it."""

    __slots__ = ()
    _words = "location {location}, scale {scale}, shape {dof}"
    _part_units: ClassVar[dict[str, str]] = {"dof": ""}

    def _derive(self, **parts):
        self._set(support=(-math.inf, math.inf), mean=parts["location"], sd=parts["scale"])


def test_a_part_without_the_unit_of_the_quantity_is_written_without_it():
    unit = Normal("50 km/h", "4 km/h").unit
    one = Tailed.__new__(Tailed)
    one._make(unit, location=50 / 3.6, scale=4 / 3.6, dof=4.0)
    assert repr(one) == "Tailed(location=50 km/h, scale=4 km/h, dof=4)"
    assert str(one) == "location 50 km/h, scale 4 km/h, shape 4"


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        (Normal(4512345.67, 0.5), "4512345.67 ± 0.5"),
        (Interval(100.001, 100.002), "100.001 to 100.002, no distribution assumed"),
        (Uniform("12345.6 m", "12346.1 m"), "12345.6 to 12346.1 m, all values equally likely"),
        (Triangular(100.01, 100.02, 100.04), "100.01 to 100.04, most likely 100.02"),
        (Censored(low=4512345.1, high=4512346.2), "at least 4512345.1, at most 4512346.2"),
        (Normal("50 km/h", "3 km/h"), "50 ± 3 km/h"),
        (Normal(43.123456789, 7.6), "43.12 ± 7.6"),
    ],
)
def test_numbers_are_printed_to_a_hundredth_of_what_is_between_them(stated, words):
    """So that a page does not contradict itself; what is recorded has all digits."""
    assert str(stated) == words
    again = eval(repr(stated)) if stated.unit == "" else stated
    assert again == stated
