"""posterior: against conjugate closed forms, quadrature in two unknowns, modes of known weight, and
censored readings.

Errors of sampling come with their own standard errors, from eight islands, so of Student's t with 7
degrees of freedom: beyond five of them lies a chance of 0.0016. Seeds are fixed, so nothing here is
left to chance from run to run.
"""

import json
import math
import pickle
import threading
import warnings
from typing import ClassVar

import mpmath
import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct
from collisions.estimate import readings
from collisions.estimate.evidence import read_evidence, read_reading
from collisions.estimate.islands import Island
from collisions.estimate.posterior import _Problem
from collisions.estimate.posterior_result import notes_of
from collisions.estimate.readings import CensoredReading, ValueReading
from collisions.reconstruct import fit, posterior
from collisions.uncertainty import (
    Censored,
    Interval,
    LogNormal,
    Normal,
    Samples,
    Triangular,
    Uniform,
    propagate,
)
from collisions.uncertainty.distribution import Statement
from collisions.uncertainty.normal import log_survival
from collisions.uncertainty.sampling import Joint

SIGMAS = 5.0


def sampled(*arguments, **options):
    """The posterior, and the codes of the warnings it gave."""
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        found = posterior(*arguments, **{"samples": 4096, "seed": 1} | options)
    return found, [one.message.code for one in given]


def close(value, error, exact, least=0.0):
    """Within the stated errors of sampling."""
    assert abs(value - exact) <= SIGMAS * error + least, (value, error, exact)


def log_normal_density(x, mean, sd):
    return -0.5 * ((x - mean) / sd) ** 2 - math.log(sd) - 0.5 * math.log(2.0 * math.pi)


def phi(z):
    return float(mpmath.ncdf(z))


# --- closed forms


@pytest.mark.slow
def test_one_reading_of_a_normal_prior():
    """Weights 1/2^2 and 1/1^2; the evidence is the density of the reading about the prior's mean,
    variances added.
    """
    found, codes = sampled(
        lambda v: {"v": v}, {"v": Normal("20 m/s", "2 m/s")}, {"v": ("23 m/s", "1 m/s")}
    )
    close(found["v"].mean, found["v"].mean_standard_error, (20 / 4 + 23) / 1.25)
    close(found["v"].std, found["v"].std_standard_error, math.sqrt(0.8))
    close(found.log_evidence, found.log_evidence_error, log_normal_density(23, 20, math.sqrt(5.0)))
    assert found.log_evidence_error < 0.1
    low, high = found["v"].interval(0.95)
    for end, side in ((low, -1.0), (high, 1.0)):
        close(
            end,
            found["v"].quantile_standard_error(0.5 + 0.475 * side),
            22.4 + side * 1.959964 * math.sqrt(0.8),
        )
    chance, error = found.probability(lambda at: at["v"] > 23.0)
    close(chance, error, phi(-0.6 / math.sqrt(0.8)))
    close(found.shrinkage["v"], 0.05, 0.8)
    assert found["v"].q.mean.units == pint.application_registry.Unit("m/s")
    assert found.consistent
    assert not codes


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2, 3))]
)
def test_linear_models_with_correlated_priors(seed):
    """Five unknowns, three readings: mean, covariance and evidence by the normal equations of
    numpy.linalg.
    """
    rng = np.random.default_rng(seed)
    matrix, sigma = rng.normal(size=(3, 5)), np.array([0.05, 0.2, 1.0])
    prior = np.eye(5)
    prior[0, 1] = prior[1, 0] = 0.7
    prior[2, 4] = prior[4, 2] = -0.4
    names = [f"u{k}" for k in range(5)]
    values = matrix @ rng.multivariate_normal(np.zeros(5), prior) + sigma * rng.normal(size=3)

    def model(**u):
        return {
            f"y{i}": sum(row[j] * u[name] for j, name in enumerate(names))
            for i, row in enumerate(matrix)
        }

    found, _ = sampled(
        model,
        dict.fromkeys(names, Normal(0.0, 1.0)),
        {
            f"y{i}": (value, error)
            for i, (value, error) in enumerate(zip(values, sigma, strict=True))
        },
        correlation={("u0", "u1"): 0.7, ("u2", "u4"): -0.4},
    )
    said = "correlation of the inputs as stated: u0 and u1 0.7, u2 and u4 -0.4"
    assert found.statements[-1] == said == found.to_dict()["statements"][-1]
    total = matrix @ prior @ matrix.T + np.diag(sigma**2)
    gain = prior @ matrix.T @ np.linalg.inv(total)
    mean, covariance = gain @ values, prior - gain @ matrix @ prior
    exact = (
        -0.5 * values @ np.linalg.solve(total, values)
        - 0.5 * np.linalg.slogdet(2.0 * np.pi * total)[1]
    )
    close(found.log_evidence, found.log_evidence_error, exact)
    for k, name in enumerate(names):
        close(found[name].mean, found[name].mean_standard_error, mean[k])
        close(found[name].std, found[name].std_standard_error, math.sqrt(covariance[k, k]))
    # 4,096 samples tell a correlation to about 1/64.
    sizes = np.sqrt(np.diagonal(covariance))
    assert found.correlation["u0", "u1"] == pytest.approx(
        covariance[0, 1] / sizes[0] / sizes[1], abs=0.08
    )
    assert found.p_value == pytest.approx(
        float(
            mpmath.gammainc(1.5, 0.5 * values @ np.linalg.solve(total, values), regularized=True)
        ),
        abs=0.05,
    )


CENSORED = {
    "at least": (Censored(low=1.0), 1.0, None, None),
    "at most": (Censored(high=-0.5), None, -0.5, None),
    "between": (Censored(0.8, 1.2), 0.8, 1.2, None),
    "interval": (Interval(0.8, 1.2), 0.8, 1.2, None),
    "at least, read": (Censored(low=1.0, error=0.5), 1.0, None, 0.5),
    "at most, read": (Censored(high=-0.5, error=0.1), None, -0.5, 0.1),
    "between, read": (Censored(0.8, 1.2, error=0.3), 0.8, 1.2, 0.3),
    "a rare one": (Censored(low=4.0), 4.0, None, None),
}


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(name, marks=pytest.mark.slow) if "," in name or "rare" in name else name
        for name in CENSORED
    ],
)
def test_censored_readings_of_a_normal_prior(case):
    """Prior N(0, 1): the evidence is the probability of the bounds, and the mean that of a normal
    cut off by them.

    With an error s the reading is N(0, 1 + s^2), and the unknown is the reading over 1 + s^2 in the
    mean.
    """
    reading, low, high, error = CENSORED[case]
    found, codes = sampled(lambda x: {"x": x}, {"x": Normal(0.0, 1.0)}, {"x": reading})
    spread = math.hypot(1.0, error or 0.0)
    a, b = (
        (-math.inf if low is None else low / spread),
        (math.inf if high is None else high / spread),
    )
    share = (
        float(mpmath.ncdf(b) - mpmath.ncdf(a))
        if a < 3
        else float(mpmath.erfc(a / mpmath.sqrt(2)) / 2)
    )
    mean = float(mpmath.npdf(a) - mpmath.npdf(b)) / share / spread
    close(found.log_evidence, found.log_evidence_error, math.log(share))
    close(found["x"].mean, found["x"].mean_standard_error, mean)
    assert "islands_disagree" not in codes
    if not error:
        assert found["x"].values.min() >= (-math.inf if low is None else low)
        assert found["x"].values.max() <= (math.inf if high is None else high)
        missed = max(0.0, a, -b)
        chance = math.erfc(missed / math.sqrt(2.0))
        assert found.p_value == pytest.approx(chance, rel=0.02)
        assert found.consistent is (chance > 0.01)
        assert ("contradictory" in codes) is (chance < 0.01)
        furthest = f"the furthest off is the prior of x, by {found['x'].mean:.3g} sigma"
        assert (furthest in next(notes_of(found)).rest) is (chance < 0.01)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_sharp_bounds_that_add_nothing_do_not_hide_a_contradiction():
    """The chance is that of one unknown so far off its prior, however many bounds say so."""
    bounds = {f"x{k}": Censored(low=3.5 - 0.1 * k) for k in range(5)}
    found = posterior(
        lambda x: dict.fromkeys(bounds, x), {"x": Normal(0.0, 1.0)}, bounds, samples=512, seed=1
    )
    assert found.p_value == pytest.approx(math.erfc(3.5 / math.sqrt(2.0)), rel=0.05)
    assert not found.consistent


def test_a_reading_of_bounds_is_missed_by_what_is_observed_less_what_is_computed():
    """Below them more was observed than computed, above them less."""
    reading = CensoredReading("x", Censored(0.3, 0.4, 0.05))
    found = reading.residual(np.array([0.0, 0.35, 1.0]), False)
    assert found == pytest.approx([0.3, 0.0, -0.6])


@pytest.mark.parametrize("sigma", [0.1, 1.0, 3.0])
def test_the_density_of_an_angle_is_one_in_all_round_the_circle(sigma):
    """However wide its error: two accounts with it are compared by such densities."""
    reading = ValueReading("x", Normal(0.4, sigma))
    turn = (np.arange(20000) + 0.5) / 20000.0 * math.tau - math.pi
    for angle, whole in ((True, 1.0), (False, math.erf(math.pi / (sigma * math.sqrt(2.0))))):
        density = np.exp(reading.log_likelihood(0.4 + turn, angle))
        assert np.mean(density) * math.tau == pytest.approx(whole, rel=1e-6)


@pytest.mark.parametrize("angle", [False, True])
def test_log_likelihoods_against_mpmath(angle):
    """Between bounds, far in a tail and in the middle: a few roundings of the logarithm, whose size
    is at least 1e-10 here.
    """
    values = np.array([-2.9, -1.0, 0.0, 0.31, 0.5, 1.0, 2.0, 3.1])
    for low, high, error in (
        (0.3, 0.4, 0.05),
        (0.3, 0.31, 1.0),
        (-1.0, 2.0, 0.1),
        (0.3, None, 0.1),
        (None, 0.4, 0.1),
    ):
        if angle and (low is None or high is None):
            with pytest.raises(col.InputError, match="one bound; give both"):
                CensoredReading("x", Censored(low, high, error)).log_likelihood(values, angle)
            continue
        with np.errstate(all="ignore"):
            found = CensoredReading("x", Censored(low, high, error)).log_likelihood(values, angle)
        with mpmath.workdps(60):
            for value, log in zip(values, found, strict=True):
                at = mpmath.mpf(float(value))
                if angle:
                    middle = (mpmath.mpf(low) + mpmath.mpf(high)) / 2
                    at += 2 * mpmath.pi * mpmath.ceil((middle - at) / (2 * mpmath.pi) - 0.5)
                ends = [
                    mpmath.inf if end is None else (mpmath.mpf(end) - at) / mpmath.mpf(error)
                    for end in (low, high)
                ]
                below = 0 if low is None else mpmath.erfc(-ends[0] / mpmath.sqrt(2)) / 2
                exact = mpmath.log(mpmath.erfc(-ends[1] / mpmath.sqrt(2)) / 2 - below)
                assert abs(log - exact) <= 1e-12 * (1.0 + abs(exact)), (low, high, error, value)


def test_log_survival_against_mpmath():
    z = np.array([-50.0, -5.0, -1.0, -1e-3, 0.0, 0.5, 3.0, 10.0, 30.0, 100.0, 1e4])
    for at, log in zip(z, log_survival(z), strict=True):
        with mpmath.workdps(40):
            exact = mpmath.log(mpmath.erfc(mpmath.mpf(at) / mpmath.sqrt(2)) / 2)
        assert abs(log - exact) <= 4 * 2.0**-52 * abs(exact)


# --- quadrature, modes


def central(speed_a, speed_b):
    impact = col.linear_central(
        col.Vehicle(mass=1500, vx=speed_a),
        col.Vehicle(mass=1000, vx=speed_b),
        0.2,
        on_failure="nan",
    )
    return {"delta_v_a": impact.a.delta_v, "vx_b": impact.b.after.vx}


@pytest.mark.slow
def test_an_impact_against_quadrature():
    """Two speeds, one log-normal, one triangular, by the midpoint rule on 1,000 x 1,000 equally
    likely cells.

    Where the bodies do not meet the model refuses: there the evidence is 0. The jump at that edge
    is one cell in a thousand wide.
    """
    priors = {"speed_a": LogNormal(14.0, 4.0), "speed_b": Triangular(-10.0, 5.0, 20.0)}
    observed = {"delta_v_a": (3.0, 0.4), "vx_b": Normal(14.0, 1.0)}
    found, codes = sampled(central, priors, observed, samples=8192)
    share = (np.arange(1000) + 0.5) / 1000
    a, b = (
        part.ravel() for part in np.meshgrid(*(prior.quantile(share) for prior in priors.values()))
    )
    closing = a - b
    # Both by hand: (1 + e) m_b/(m_a + m_b) and (1 + e) m_a/(m_a + m_b) of the closing speed.
    log = log_normal_density(3.0, 0.0, 0.4) - 0.5 * ((3.0 - 0.48 * closing) ** 2 - 3.0**2) / 0.4**2
    log += log_normal_density(14.0, 0.0, 1.0) - 0.5 * ((14.0 - b - 0.72 * closing) ** 2 - 14.0**2)
    weight = np.where(closing > 0.0, np.exp(log), 0.0)
    close(found.log_evidence, found.log_evidence_error, math.log(np.mean(weight)), least=1e-3)
    for name, values in (("speed_a", a), ("speed_b", b)):
        mean = np.average(values, weights=weight)
        close(found[name].mean, found[name].mean_standard_error, mean)
        close(
            found[name].std,
            found[name].std_standard_error,
            math.sqrt(np.average((values - mean) ** 2, weights=weight)),
        )
    # The share of the prior that is refused, and the prediction beside what was read.
    assert found.refused == pytest.approx(np.mean(closing <= 0.0), abs=5 * math.sqrt(0.1 / 8192))
    close(
        found.predicted["delta_v_a"].mean,
        found.predicted["delta_v_a"].mean_standard_error,
        np.average(0.48 * closing, weights=weight),
    )
    assert found.residuals["delta_v_a"].over_sigma == pytest.approx(
        (3.0 - found.predicted["delta_v_a"].mean) / 0.4, rel=1e-9
    )
    assert not codes


@pytest.mark.slow
@pytest.mark.parametrize("unknowns", [2, pytest.param(5, marks=pytest.mark.slow)])
def test_two_separate_modes_keep_their_weights(unknowns):
    """A density of two normals 40 deviations apart, 0.8 and 0.2: as the product of a reading of |x|
    and a coarse one of x.
    """
    names = [f"u{k}" for k in range(unknowns)]

    def model(**u):
        found = {f"size {name}": abs(u[name]) for name in names[1:]}
        return found | {"size": abs(u[names[0]]), "side": np.where(u[names[0]] > 0.0, 1.0, 0.0)}

    sharp = {f"size {name}": (1.0, 0.05) for name in names[1:]} | {"size": (1.0, 0.05)}
    # exp(-0.5 (1 - s)^2/e^2) is 4 times as large for s = 1 as for s = 0.
    found, _ = sampled(
        model,
        dict.fromkeys(names, Normal(0.0, 1.0)),
        sharp | {"side": (1.0, math.sqrt(0.5 / math.log(4.0)))},
        samples=8192,
    )
    close(*found.probability(lambda at: at[names[0]] > 0.0), 0.8)
    close(*found.probability(lambda at: at[names[1]] > 0.0), 0.5)


@pytest.mark.slow
def test_a_bent_reading_has_its_own_shape():
    """The square of a uniform unknown, read as 0: the density exp(-x^4/2 s^2), whose moments are
    gamma functions.
    """
    found, codes = sampled(lambda x: {"o": x**2}, {"x": Uniform(0.0, 10.0)}, {"o": (0.0, 1.0)})
    gamma = [math.gamma(k / 4.0) for k in range(1, 6)]
    # The integral of x^k exp(-x^4/2) from 0 is 2^((k+1)/4) gamma((k+1)/4)/4.
    zeroth, first = 2**0.25 * gamma[0] / 4.0, 2**0.5 * gamma[1] / 4.0
    close(found["x"].mean, found["x"].mean_standard_error, first / zeroth)
    close(
        found.log_evidence,
        found.log_evidence_error,
        math.log(zeroth / 10.0 / math.sqrt(2.0 * math.pi)),
    )
    assert not codes


@pytest.mark.slow
def test_angles_go_round():
    """A course of 179 degrees read as -179: 2 degrees apart, and its figures lie about
    180 degrees.
    """

    def model(course):
        return {
            "course": pint.application_registry.Quantity(
                np.arctan2(np.sin(course), np.cos(course)), "rad"
            )
        }

    found, codes = sampled(
        model, {"course": Normal("179 deg", "2 deg")}, {"course": ("-179 deg", "2 deg")}
    )
    assert not codes
    close(found["course"].mean, found["course"].mean_standard_error, math.pi)
    assert found.residuals["course"].over_sigma == pytest.approx(0.5, abs=0.1)
    exact = log_normal_density(math.radians(2.0), 0.0, math.radians(2.0 * math.sqrt(2.0)))
    close(found.log_evidence, found.log_evidence_error, exact)
    # Between bounds on either side of where the figures jump.
    for bounds in (Interval("176 deg", "184 deg"), Censored("176 deg", "184 deg", "1 deg")):
        between, _ = sampled(model, {"course": Normal("180 deg", "2 deg")}, {"course": bounds})
        assert between.log_evidence < 0.0
        shown = between.residuals["course"]
        assert shown.computed == pytest.approx(math.pi, abs=math.radians(0.2))
        assert shown.observed == pytest.approx(math.pi, abs=math.radians(0.2))


@pytest.mark.slow
def test_joint_samples_as_priors_go_on():
    """The posterior of one reading as the prior of the next is that of both, and what propagates
    from it too.
    """
    model, prior = (
        (lambda x, y: {"s": x + y, "x": x}),
        {"x": Normal(0.0, 1.0), "y": Normal(0.0, 1.0)},
    )
    first, _ = sampled(model, prior, {"s": (1.0, 0.5)}, samples=8192)
    again, _ = sampled(model, first.inputs(), {"x": (0.8, 0.5)})
    both, _ = sampled(model, prior, {"s": (1.0, 0.5), "x": (0.8, 0.5)})
    for name in "xy":
        close(
            again[name].mean,
            math.hypot(again[name].mean_standard_error, both[name].mean_standard_error, 0.01),
            both[name].mean,
        )
    close(
        first.log_evidence + again.log_evidence,
        math.hypot(first.log_evidence_error, again.log_evidence_error, both.log_evidence_error),
        both.log_evidence,
    )
    result = propagate(model, first.inputs(), method="quasi_random", seed=1)
    # Resampled from the rows: only their order is drawn again.
    assert result["s"].mean == pytest.approx(first["s"].mean, abs=0.01)
    # Var(s) of the posterior is 1/(1/2 + 4).
    assert result["s"].std == pytest.approx(math.sqrt(1.0 / 4.5), rel=0.05)
    together = "joint samples, which keep the rows in which they were given: "
    assert result.statements == (together + ", ".join(first.inputs()),)


@pytest.mark.slow
def test_what_a_posterior_states_goes_with_its_samples():
    """Two readings of one speed that are 14 of their errors apart, of an impact as an instant."""

    def model(v):
        a, b = col.Vehicle(mass=1000.0, vx=v), col.Vehicle(mass=1000.0)
        after = col.linear_central(a, b, 0.0, on_failure="nan").b.after.vx
        return {"one": after, "other": after}

    readings = {"one": (5.0, 1.0), "other": (25.0, 1.0)}
    first, codes = sampled(model, {"v": Uniform(0.0, 60.0)}, readings)
    assert codes == ["contradictory"]
    with pytest.warns(col.CollisionsWarning) as given:
        second = propagate(lambda v: {"o": v + 0.0}, first.inputs(), seed=1)
    assert [one.message.code for one in given] == ["contradictory"]
    assert second.statements == tuple(f"from a posterior (v): {one}" for one in first.statements)
    assert "as an instant" in second.statements[-1]


@pytest.mark.slow
def test_the_evidence_of_few_samples_is_not_too_high():
    """Six unknowns, five read to a fifth of their prior's deviation, 64 samples an island: the mean
    over seeds is the evidence.

    Islands that moved along differences of their own points came out 23 percent too high, eight
    standard errors of 25 runs.
    """
    names, errors = [f"u{k}" for k in range(6)], 0.2
    exact = 5 * log_normal_density(0.5, 0.0, math.hypot(1.0, errors))
    readings = dict.fromkeys(names[:5], (0.5, errors))
    found = [
        math.exp(
            sampled(
                lambda **u: u,
                dict.fromkeys(names, Normal(0.0, 1.0)),
                readings,
                samples=512,
                seed=seed,
            )[0].log_evidence
            - exact
        )
        for seed in range(25)
    ]
    assert abs(np.mean(found) - 1.0) <= 4.0 * np.std(found, ddof=1) / 5.0


# --- what it says


@pytest.mark.slow
def test_contradictory_evidence_says_so():
    """Two readings six errors apart, and a reading far beyond its prior."""
    _, codes = sampled(
        lambda v: {"p": v, "q": v}, {"v": Uniform(0, 50)}, {"p": (20.0, 1.0), "q": (26.0, 1.0)}
    )
    assert codes == ["contradictory"]
    found, codes = sampled(lambda v: {"v": v}, {"v": Normal(20, 1)}, {"v": (10.0, 0.5)})
    assert codes == ["contradictory"]
    assert found.consistent is False
    # The least of chi-squared is 10^2/(0.5^2 + 1^2).
    assert found.p_value == pytest.approx(math.erfc(math.sqrt(40.0)), rel=0.2)
    assert "contradicts itself" in found.statements[0]
    with pytest.raises(
        col.NoSolutionError,
        match=r"meets the bounds observed of delta_v_a: the nearest misses them by",
    ) as caught:
        posterior(
            central,
            {"speed_a": Uniform(0, 20), "speed_b": Uniform(0, 5)},
            {"delta_v_a": Interval(50, 60)},
            seed=1,
        )
    assert caught.value.code == "contradictory"


@pytest.mark.slow
def test_what_the_evidence_does_not_tell_is_said():
    """A restitution that changes nothing observed: a uniform one warns, a normal one is named."""

    def model(speed, e):
        return {"speed": speed + 0.0 * e}

    found, codes = sampled(
        model, {"speed": Uniform(0, 40), "e": Uniform(0, 1)}, {"speed": (20.0, 1.0)}
    )
    assert codes == ["undetermined"]
    assert found.prior_only == ("e",)
    close(found["e"].mean, found["e"].mean_standard_error, 0.5)
    found, codes = sampled(
        model, {"speed": Uniform(0, 40), "e": Normal(0.1, 0.05)}, {"speed": (20.0, 1.0)}
    )
    assert codes == []
    assert any(
        "says next to nothing of e: what is given of it rests on its prior, 0.1 " in one
        for one in found.statements
    )


@pytest.mark.slow
def test_a_model_that_refuses_everywhere_says_so():
    def model(speed_a):
        return {
            "v": col.linear_central(
                col.Vehicle(mass=1500, vx=speed_a), col.Vehicle(mass=1000), 0.2, on_failure="nan"
            ).b.delta_v
        }

    with pytest.raises(
        col.NoSolutionError, match=r"refuses all \d+ points .*speed_a = -15"
    ) as caught:
        posterior(model, {"speed_a": Uniform(-20, -10)}, {"v": (5.0, 1.0)}, seed=1)
    assert caught.value.code == "refused"
    with pytest.raises(
        col.NoSolutionError, match="no point of them fits within numbers that a float holds"
    ):
        posterior(lambda x: {"x": x}, {"x": Normal(24.6, 1.0)}, {"x": (0.0, 1e-200)}, seed=1)


@pytest.mark.slow
def test_a_rare_answer_is_found():
    """The model answers for 1 percent of the prior: the evidence counts that."""
    found, _ = sampled(
        lambda x: {"x": np.where((x > 0.7) & (x < 0.71), x, np.nan)},
        {"x": Uniform(0, 1)},
        {"x": (0.705, 10.0)},
    )
    close(
        found.log_evidence,
        found.log_evidence_error,
        math.log(0.01) + log_normal_density(0.0, 0.0, 10.0),
    )
    assert found.refused == pytest.approx(0.99, abs=0.002)
    assert any("no answer for 99% of the prior" in one for one in found.statements)


@pytest.mark.slow
def test_answers_too_rare_to_be_found_say_so():
    """The first island draws 4,096 points and finds 1 or 2 of the share 1/4096 that has an answer;
    the next by chance none.
    """

    def model(x):
        return {"x": np.where((x > 0.0) & (x < 1.0 / 4096.0), x, np.nan)}

    outcomes = set()
    for seed in range(4):
        try:
            outcomes.add(
                sampled(model, {"x": Uniform(0, 1)}, {"x": (0.0, 1.0)}, samples=512, seed=seed)[
                    0
                ].refused
                > 0.99
            )
        except col.NoSolutionError as refused:
            seldom = str(refused).startswith("the model answers so seldom that none of 4096 points")
            outcomes.add(seldom and refused.code == "refused")
    assert outcomes == {True}


@pytest.mark.slow
def test_a_sample_that_cannot_be_moved_says_so():
    """Three values as a prior, and a reading that leaves one: every sample is the same."""
    found, codes = sampled(lambda x: {"x": x}, {"x": Samples([1.0, 2.0, 3.0])}, {"x": (2.0, 1e-3)})
    assert found["x"].mean == 2.0
    close(
        found.log_evidence,
        found.log_evidence_error,
        math.log(1 / 3) + log_normal_density(0, 0, 1e-3),
    )
    assert set(codes) <= {"islands_disagree", "collapsed"}


# --- the run


def side(speed, offset):
    return {"v": speed * np.cos(offset), "w": speed * np.sin(offset)}


SIDE = ({"speed": Uniform(0, 30), "offset": Normal(0.3, 0.2)}, {"v": (14.0, 1.0), "w": (4.0, 0.5)})


@pytest.mark.slow
def test_a_seed_makes_it_reproducible_for_any_number_of_threads():
    one = posterior(side, *SIDE, samples=1024, seed=7)
    for threads in (1, 2, 5):
        other = posterior(side, *SIDE, samples=1024, seed=7, threads=threads)
        assert other.to_dict() == one.to_dict()
        assert np.array_equal(other["speed"].values, one["speed"].values)
    free = posterior(side, *SIDE, samples=1024)
    assert free.seed != 7
    assert posterior(side, *SIDE, samples=1024, seed=free.seed).to_dict() == free.to_dict()
    assert one.samples == len(one["speed"].values) == 1024
    assert posterior(side, *SIDE, samples=1001, seed=1).samples == 1001


@pytest.mark.slow
@pytest.mark.parametrize("threads", [1, 3])
def test_progress_rises_to_the_end(threads):
    seen = []
    posterior(
        side,
        *SIDE,
        samples=1024,
        seed=1,
        threads=threads,
        progress=lambda done, total: seen.append((done, total)),
    )
    assert seen[-1] == (1024, 1024)
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)
    assert all(total == 1024 for _, total in seen)


@pytest.mark.slow
def test_an_interrupt_returns_the_finished_islands():
    def stop(done, total):
        if done >= 0.6 * total:
            raise KeyboardInterrupt

    with pytest.warns(
        col.CollisionsWarning, match="interrupted; the figures are those of 1024 samples"
    ):
        found = posterior(side, *SIDE, samples=2048, seed=1, progress=stop)
    assert found.interrupted
    assert math.isfinite(found.log_evidence_error)

    def at_once(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        posterior(side, *SIDE, samples=1024, seed=1, progress=at_once)


@pytest.mark.slow
def test_the_model_may_run_in_several_threads():
    seen = set()

    def model(speed, offset):
        seen.add(threading.get_ident())
        return side(speed, offset)

    posterior(model, *SIDE, samples=1024, seed=1, threads=3)
    assert len(seen - {threading.get_ident()}) > 1


@pytest.mark.slow
def test_shown_and_read_again():
    found = posterior(side, *SIDE, samples=1024, seed=1)
    assert (
        json.loads(json.dumps(found.to_dict(), allow_nan=False))["log_evidence"]
        == found.log_evidence
    )
    for text in (repr(found), found._repr_html_()):
        for part in (
            "speed",
            "predicted",
            "log evidence",
            "agrees with itself",
            "given the evidence and the priors",
        ):
            assert part in text.lower()
    again = pickle.loads(pickle.dumps(found))
    assert again.to_dict() == found.to_dict()
    assert list(found) == ["speed", "offset"]
    assert len(found) == 2
    assert found["v"] is found.predicted["v"]
    assert found["speed"].histogram(10).shares.sum() == pytest.approx(1.0)
    with pytest.raises(ValueError, match="read-only"):
        found.draws["speed"][0] = 1.0
    with pytest.raises(AttributeError):
        found.seed = 1
    assert isinstance(found, reconstruct.Posterior)
    with pytest.raises(col.InputError, match="none of the unknowns") as caught:
        found["nothing"]
    assert caught.value.code == "unknown_name"
    with pytest.raises(col.InputError, match="depend on one another") as caught:
        _ = found["speed"].contributions
    assert caught.value.code == "no_shares"


@pytest.mark.slow
@pytest.mark.parametrize(
    "condition",
    [
        3.0,
        lambda at: True,
        lambda at: at["speed"],
        lambda at: at["speed"][:3] > 1.0,
        lambda at: at["speed"] > 1.0 and at["speed"] < 3.0,
        lambda at: at["velocity"] > 1.0,
        lambda at: at.speed > 1.0,
        np.float64,
    ],
)
def test_conditions_that_are_none(condition):
    found = posterior(side, *SIDE, samples=512, seed=1)
    with pytest.raises(col.InputError, match="booleans, such as") as caught:
        found.probability(condition)
    assert caught.value.code == "bad_condition"


@pytest.mark.parametrize(
    ("prior", "reading"),
    [
        pytest.param(Normal(0.0, 1.0), 1e3, marks=pytest.mark.slow),
        pytest.param(Normal(0.0, 1.0), -1e9, marks=pytest.mark.slow),
        (Normal(0.0, 1.0), 1e151),
        (Uniform(1.8e151, 2.7e151), 20.0),
    ],
)
def test_evidence_out_of_all_reach_is_refused_soon(prior, reading):
    """So many deviations away the samples crept on without end, or stayed where they were, as
    likely as one another.
    """
    with pytest.raises(col.NoSolutionError, match="contradicts the priors") as caught:
        posterior(lambda x: {"s": x}, {"x": prior}, {"s": (reading, 1.0)}, samples=512, seed=1)
    assert caught.value.code == "contradictory"


@pytest.mark.slow
def test_evidence_that_would_take_thousands_of_stages_is_refused_soon():
    """Each of its stages got twenty times as far as where the samples creep, from a likelihood of
    1e-250 on.
    """
    calls = []

    def model(x, y):
        calls.append(len(x))
        return {"s": np.sqrt(x) * y, "d": np.where(x > y, x * x, y / x)}

    priors = {"x": Normal(2.029e-124, 7.125e-126), "y": LogNormal(2.0, 1.0)}
    with pytest.raises(col.NoSolutionError, match="contradicts the priors"):
        posterior(model, priors, {"d": Normal(16.96, 0.8)}, samples=512, seed=1)
    assert len(calls) < 500 * 80  # sweeps of a stage at most, for the first islands


@pytest.mark.slow
def test_what_the_model_warns_of_is_said_once_with_the_samples_it_is_of():
    """Of the final samples, not of all the points on the way to them."""

    def model(speed_b_after):
        found = reconstruct.momentum(
            1500.0,
            1200.0,
            course_a=0.0,
            course_b=math.pi / 2,
            course_a_after=0.1,
            course_b_after=-0.3,
            speed_a_after=5.0,
            speed_b_after=speed_b_after,
        )
        return {"speed_b": found.speed_b}

    with pytest.warns(col.OutOfRangeWarning, match="speed_b is below 0") as caught:
        found = posterior(
            model,
            {"speed_b_after": Normal(2.0, 0.4)},
            {"speed_b": Normal(0.0, 2.0)},
            samples=512,
            seed=1,
        )
    below = int(np.sum(found["speed_b"].values < 0.0))
    assert 0 < below < 512
    assert [str(one.message).partition(":")[0] for one in caught] == [
        f"{below} of 512 cases ({100 * below / 512:.3g} %)"
    ]
    # It stands with the result too, in its table and in its record.
    said = next(one for one in found.statements if "speed_b is below 0" in one)
    assert said.startswith(f"{below} of 512 cases")
    assert said in found.to_dict()["statements"]
    assert said in " ".join(str(found.summary()).split())


def test_an_output_without_any_answer_has_no_figures():
    found = posterior(
        lambda x: {"s": x, "d": np.nan * x},
        {"x": Normal(0.0, 1.0)},
        {"s": (1.0, 1.0)},
        samples=512,
        seed=1,
    )
    assert "none of the 512 samples has 'd', and it has no figures" in found.statements
    output = found["d"]
    assert all(
        math.isnan(one)
        for one in (output.mean, output.std, output.quantile(0.5), *output.interval(0.95))
    )
    assert output.failed == 512
    assert str(output.summary())
    assert "one case that has an answer" not in str(found.summary())


def test_a_plain_output_has_the_unit_that_it_was_observed_in():
    """In the units of the inputs; one that is not observed has none, and that is said."""
    found = posterior(
        lambda v: {"video": v, "twice": 2.0 * v},
        {"v": Normal("20 mph", "5 mph")},
        {"video": ("22 mph", "1 mph")},
        samples=512,
        seed=1,
    )
    assert found["video"].unit == "m/s"
    assert found["twice"].unit is None
    text = str(found.summary())
    (line,) = (one for one in text.splitlines() if one.startswith("  video") and "to" in one)
    assert line.count("mph") == 2
    assert "Without a unit, as the model returned plain numbers: twice." in text


@pytest.mark.slow
def test_what_no_sample_shows_has_an_error_of_one_sample():
    found = posterior(side, *SIDE, samples=512, seed=1)
    assert found.probability(lambda at: at["speed"] > 29.9) == (0.0, 1 / 512)
    assert found.probability(lambda at: at["speed"] < 29.9) == (1.0, 1 / 512)


def identity(x):
    return {"x": x}


GOOD = ({"x": Normal(1.0, 0.5)}, {"x": (1.0, 0.1)})


@pytest.mark.parametrize(
    ("model", "unknowns", "observed", "options", "kind", "code", "text"),
    [
        (3.0, *GOOD, {}, col.InputError, "bad_model", "model must be a function"),
        (identity, {"y": Normal(1, 1)}, GOOD[1], {}, col.InputError, "bad_model",
            r"unknowns are y, but the model takes \(x\)"),
        (lambda x: {"x": math.sqrt(x)}, *GOOD, {}, col.InputError, "bad_model",
            "numpy in place of math"),
        (lambda x: {"x": 1.0 if x > 0 else 2.0}, *GOOD, {}, col.InputError, "bad_model",
            "numpy.where in place of if"),
        (lambda x: {"x": x - x.mean() + 1.0}, *GOOD, {}, col.InputError, "bad_model",
            "model mixes cases"),
        (lambda x: {"x": x[:1]}, *GOOD, {}, col.ShapeError, "bad_shape", "'x'"),
        (identity, {"x": Interval(0, 1)}, GOOD[1], {}, col.InputError, "bad_prior",
            "Interval; give a distribution .*Uniform"),
        (identity, {"x": 1.0}, GOOD[1], {}, col.InputError, "bad_prior",
            "float; give a distribution"),
        (identity, {"x": (0, 1)}, GOOD[1], {}, col.InputError, "bad_prior",
            r"write Uniform\(0, 1\)"),
        (identity, {}, GOOD[1], {}, col.InputError, "bad_type",
            "unknowns must be a dict.*an empty one"),
        (identity, GOOD[0], {"z": (1.0, 0.1)}, {}, col.InputError, "unknown_output",
            "names z, .*it returns x"),
        (identity, GOOD[0], {"x": 1.0}, {}, col.InputError, "bad_observation",
            "number without its error"),
        (identity, GOOD[0], {"x": Uniform(0, 1)}, {}, col.InputError, "bad_observation",
            "type Uniform; give Normal"),
        (identity, GOOD[0], {"x": Normal(1, 1, truncate=(0, None))}, {}, col.InputError,
            "bad_observation", "bounds belong to unknowns"),
        (identity, GOOD[0], {"x": Censored(low="3 deg", error="1 deg")}, {}, col.InputError,
            "bad_observation", "one bound; give both"),
        (identity, *GOOD, {"samples": 500}, col.InputError, "bad_option", "from 512"),
        (identity, *GOOD, {"samples": None}, col.InputError, "bad_option", "from 512"),
        (identity, *GOOD, {"samples": 1.5}, col.InputError, "bad_option",
            "samples must be a whole number"),
        (identity, *GOOD, {"seed": -1}, col.InputError, "bad_option", "seed must be"),
        (identity, *GOOD, {"threads": 0}, col.InputError, "bad_option", "threads must be"),
        (identity, *GOOD, {"progress": 3}, col.InputError, "bad_option", "progress must be"),
        (identity, *GOOD, {"correlation": {("x", "y"): 0.5}}, col.InputError, "bad_correlation",
            "'y' is not an input"),
    ],
)  # fmt: skip
def test_refusals(model, unknowns, observed, options, kind, code, text):
    with pytest.raises(kind, match=f"(?s){text}") as refused:
        posterior(model, unknowns, observed, **{"samples": 512, "seed": 1} | options)
    assert refused.value.code == code


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        ({}, "missing_bound", r"needs a bound; write Censored\(low=...\)"),
        ({"low": 2.0, "high": 1.0}, "bad_range", "rising order"),
        ({"low": 2.0, "error": 0.0}, "not_positive", "error must be > 0, got 0"),
        ({"low": "2 m/s", "error": 1.0}, "bad_units", "has no unit"),
        ({"low": math.nan}, "not_finite", "NaN"),
    ],
)
def test_censored_readings_that_are_none(arguments, code, text):
    with pytest.raises(col.InputError, match=text) as refused:
        Censored(**arguments)
    assert refused.value.code == code


def test_a_censored_reading_is_a_value():
    one = Censored(low="28 km/h", error="1 km/h")
    assert (one.low, one.high, one.unit) == (pytest.approx(28 / 3.6, rel=1e-15), None, "m/s")
    assert one == Censored(low="28 km/h", error="1 km/h") != Censored(low="28 km/h")
    assert hash(one) == hash(pickle.loads(pickle.dumps(one)))
    with pytest.raises(col.InputError, match=r"weighed by reconstruct\.posterior"):
        reconstruct.fit(identity, {"x": 1.0}, {"x": one})


@pytest.mark.parametrize("samples", [10, 64, 511, None])
def test_the_least_number_of_samples_is_said_the_same_for_every_number(samples):
    with pytest.raises(col.InputError, match="samples must be a whole number from 512 to"):
        posterior(identity, {"x": Normal(0.0, 1.0)}, {"x": (1.0, 1.0)}, samples=samples)


# --- another kind of evidence


class StudentT(Statement):
    """A value whose error has heavy tails, as one might add it."""

    __slots__ = ("dof", "location", "scale")
    _part_units: ClassVar[dict[str, str]] = {"dof": ""}

    def _derive(self, location, scale, dof):
        self._set(location=location, scale=scale, dof=dof)


class StudentReading(readings.Reading):
    __slots__ = ()

    is_value = True

    @property
    def sigma(self):
        return self.value.scale

    def residual(self, computed, angle):
        return self.value.location - computed

    def log_likelihood(self, computed, angle):
        dof, z = self.value.dof, self.residual(computed, angle) / self.sigma
        ratio = math.lgamma((dof + 1.0) / 2.0) - math.lgamma(dof / 2.0)
        return (
            ratio
            - 0.5 * math.log(dof * math.pi)
            - math.log(self.sigma)
            - 0.5 * (dof + 1.0) * np.log1p(z * z / dof)
        )

    def misfit(self, computed, angle):
        z = self.residual(computed, angle) / self.sigma
        return (self.value.dof + 1.0) * np.log1p(z * z / self.value.dof)


@pytest.mark.slow
def test_a_kind_of_evidence_is_one_class(monkeypatch):
    """A speed known before and one reading with heavy tails: against quadrature; and evidence that
    such tails allow for is not called contradictory.
    """
    monkeypatch.setitem(readings.KINDS, StudentT, StudentReading)
    reading = StudentT.__new__(StudentT)
    reading._make("m/s", location=13.0, scale=0.5, dof=3.0)
    found, codes = sampled(
        lambda v: {"read": v, "also": v},
        {"v": Normal(10.0, 4.0)},
        {"read": reading, "also": (10.5, 0.5)},
    )
    grid = np.linspace(0.0, 30.0, 60001)
    log = (
        -0.5 * ((grid - 10.0) / 4.0) ** 2
        - 2.0 * np.log1p(((13.0 - grid) / 0.5) ** 2 / 3.0)
        - 0.5 * ((grid - 10.5) / 0.5) ** 2
    )
    weight = np.exp(log - log.max())
    mean = float(np.sum(weight * grid) / np.sum(weight))
    close(found["v"].mean, found["v"].mean_standard_error, mean)
    assert codes == []
    assert found.residuals["read"].observed == pytest.approx(13.0)
    assert "dof=3" in repr(found.observed["read"])


@pytest.mark.slow
def test_what_is_shown_as_computed_is_the_mean_of_what_the_model_gives():
    """A prior of 20 +/- 2 and a reading of 23 +/- 1: the mean is 22.4, less than was read."""
    found, _ = sampled(lambda v: {"v": v}, {"v": Normal(20, 2)}, {"v": (23.0, 1.0)})
    shown = found.residuals["v"]
    assert shown.computed == pytest.approx(found.predicted["v"].mean, rel=1e-12)
    assert shown.observed == 23.0
    assert shown.residual == pytest.approx(shown.observed - shown.computed, rel=1e-12)
    close(shown.computed, found["v"].mean_standard_error, 22.4)


@pytest.mark.slow
@pytest.mark.parametrize(("apart", "agrees"), [(3.2, True), (3.55, True), (3.75, False)])
def test_evidence_contradicts_itself_from_a_chance_of_one_in_a_hundred_on(apart, agrees):
    """Chi-squared of a prior and a reading that far apart, of variance 1 each, is half the square:
    chances of 0.024, 0.012 and 0.008.
    """
    found, codes = sampled(
        lambda v: {"v": v}, {"v": Normal(20, 1)}, {"v": (20.0 + apart, 1.0)}, samples=1024
    )
    assert found.p_value == pytest.approx(math.erfc(apart / 2.0), rel=0.05)
    assert found.consistent is agrees
    assert codes == ([] if agrees else ["contradictory"])


@pytest.mark.slow
def test_an_unknown_that_the_evidence_moved_or_narrowed_does_not_rest_on_its_prior():
    """A speed of 0 +/- 1 that is the root of an energy is a likelihood of exp(-energy/2): it moves
    a normal prior by half its variance and leaves the spread as it was.
    """
    found, _ = sampled(
        lambda energy: {"speed": np.sqrt(np.maximum(5.0 + energy, 0.0))},
        {"energy": Normal(0, 1)},
        {"speed": (0.0, 1.0)},
    )
    close(found["energy"].mean, found["energy"].mean_standard_error, -0.5)
    close(found.shrinkage["energy"], 0.0, 0.0, 0.06)
    assert found.prior_only == ()
    # Narrowed by a sixth, about the same mean: 1 / sqrt(1 + 4/9) = 0.832.
    found, _ = sampled(lambda v: {"v": v}, {"v": Normal(20, 2)}, {"v": (20.0, 3.0)})
    close(found["v"].mean, found["v"].mean_standard_error, 20.0)
    assert found.prior_only == ()


def test_an_island_counts_by_its_evidence():
    """Eight islands that found the values 1 to 8, and an evidence in the ratio of these: the mean
    over all is the sum of squares over the sum, 204 / 36, and the evidence their mean.
    """
    unknowns, observed = {"v": Normal(0, 1)}, {"v": (0.0, 1.0)}
    called, priors, rows = read_evidence(
        lambda v: {"v": v}, unknowns, observed, "", lambda _, given: given, read_reading
    )
    problem = _Problem(called, Joint(priors, None), rows)
    islands = [
        Island(np.full((1024, 1), float(found)), math.log(found), 0.0, 1.0, 10, 0, 0.0)
        for found in range(1, 9)
    ]
    called({"v": np.zeros(2)}, 2, True)
    found = problem.result(islands, 8192, 1)
    assert found.samples == 8192
    assert found["v"].mean == pytest.approx(204.0 / 36.0, abs=2e-3)
    assert found.log_evidence == pytest.approx(math.log(36.0 / 8.0), rel=1e-12)
    # Of a mean of eight: the standard deviation of the values over the root of eight, over the
    # mean, to first order.
    first_order = np.std(np.arange(1.0, 9.0), ddof=1) / math.sqrt(8.0) / 4.5
    assert found.log_evidence_error == pytest.approx(first_order, rel=0.05)


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_a_bare_angle_that_no_square_holds_is_answered():
    """As any other angle, which goes round."""

    def model(x):
        return {"course": x * pint.get_application_registry().rad}

    found = posterior(
        model, {"x": Normal(0.0, 0.5)}, {"course": (-1e200, 0.5)}, samples=512, seed=1
    )
    assert abs(found["x"].mean) < 0.5 * math.pi


@pytest.mark.slow
def test_a_bare_observation_is_written_in_the_unit_of_what_the_model_predicts():
    """93112 J beside a prediction in ft·lbf would be read as the larger of the two."""

    def model(speed):
        impact = col.linear_central(
            col.Vehicle(mass="3300 lb", vx=speed), col.Vehicle(mass="2800 lb"), 0.1
        )
        return {"energy": impact.q.energy_loss, "share": impact.a.delta_v / speed}

    found = posterior(
        model,
        {"speed": Uniform("0 mph", "60 mph")},
        {"energy": (93112.0, 18622.0), "share": (0.5, 0.2)},
        samples=512,
        seed=1,
    )
    stated = {
        row[0]: row[1] for part in found.summary("us").parts for row in part.rows if len(row) > 2
    }
    assert stated["energy"].endswith("ft*lbf") or stated["energy"].endswith("ft·lbf")
    number = float(stated["energy"].split(" ± ")[0])
    assert number == pytest.approx(93112.0 / 1.3558179483314004, rel=1e-4)
    assert stated["share"] == "0.5 ± 0.2"


def braking(**more):
    """A speed at the end of a skid, read to 0.1 m/s, and the speed at its start."""
    found = posterior(
        lambda speed: {"video": speed},
        {"speed": Uniform("0 m/s", "40 m/s")},
        {"video": ("10 m/s", "0.1 m/s")},
        samples=4096,
        seed=1,
    )
    given = {"distance": "12 m", "drag": Normal(0.7, 0.05), "end_speed": found["speed"]} | more
    return found, found.with_result("before", col.travel.speed, "m/s", **given)


@pytest.mark.slow
def test_what_follows_has_the_range_of_all_that_it_follows_from():
    """v0^2 = v1^2 + 2 g drag d: with small errors its deviation is that of the slopes."""
    found, more = braking()
    start = math.sqrt(10.0**2 + 2.0 * 0.7 * 9.80665 * 12.0)
    spread = math.hypot(10.0 * 0.1, 9.80665 * 12.0 * 0.05) / start
    result = more["before"]
    close(result.mean, result.mean_standard_error, start, 0.01)
    close(result.std, result.std / math.sqrt(2.0 * 4096.0), spread, 0.002)
    assert result.unit == "m/s"
    assert "before" not in found.draws
    assert found.results == {}
    # Without the draws of the drag it is the function of the samples and nothing else.
    _, plain = braking(drag=0.7)
    exact = np.sqrt(found.draws["speed"] ** 2 + 2.0 * 0.7 * 9.80665 * 12.0)
    assert np.allclose(plain.draws["before"], exact, rtol=1e-12)
    over, _ = plain.probability(lambda at: at["before"] > start)
    assert over == pytest.approx(0.5, abs=0.03)


@pytest.mark.slow
def test_what_follows_is_said_and_recorded():
    _, more = braking()
    record = json.loads(json.dumps(more.to_dict(), allow_nan=False))
    assert record["results"]["before"]["mean"] == more["before"].mean
    assert record["results_from"]["before"] == {
        "by": "travel.speed",
        "distance": "12 m",
        "drag": "0.7 ± 0.05",
        "end_speed": "speed",
    }
    said = "by travel.speed: distance = 12 m, drag = 0.7 ± 0.05, end speed = speed"
    assert said in " ".join(repr(more).split())
    again = pickle.loads(pickle.dumps(more))
    assert again.to_dict() == more.to_dict()
    assert np.array_equal(braking()[1].draws["before"], more.draws["before"])


@pytest.mark.slow
def test_what_a_reading_was_worked_out_from_is_said_and_recorded():
    one = reconstruct.crush_energy("1.5 m", ["20 cm", "30 cm"], "40 kN/m", "600 kN/m**2")
    other = reconstruct.crush_energy(
        "5 ft", ["11 in", "9 in"], "300 lbf/in", "60 lbf/in**2", name="side of B"
    )
    damage = one + other
    for reading in ((damage, 0.2 * damage), Normal(damage, 0.2 * damage)):
        found, _ = sampled(
            lambda energy: {"energy": energy, "video": energy},
            {"energy": Uniform(0.0, 4.0 * damage)},
            {"energy": reading, "video": (float(damage), 0.2 * damage)},
            samples=512,
        )
        assert found.observed["energy"].source == f"{one.source}; {other.source}"
        assert found.to_dict()["observed_from"] == {"energy": damage.source}
        assert pickle.loads(pickle.dumps(found)).observed["energy"].source == damage.source
        page = col.report(found, form="markdown", units="us")
        assert "A 40 kN/m, B 600 kN/m²" in page
        assert "side of B, by crush" in page
        assert "width 5 ft, depths 11 in, 9 in, A 300 lbf/in, B 60 lbf/in²" in page
    # Statements of the same numbers are equal, whatever these were worked out from.
    assert Normal(damage, 1e4) == Normal(float(damage), 1e4)


@pytest.mark.slow
def test_a_result_that_no_sample_has_is_refused_with_what_to_write():
    """A car that goes against the x axis has a vx below 0, which is no speed."""
    found, _ = sampled(
        lambda **at: {"video": at["Corolla.vx"]},
        {"Corolla.vx": Uniform("-30 m/s", "-5 m/s")},
        {"video": ("-10 m/s", "1 m/s")},
        samples=512,
    )
    given = {"distance": "12 m", "drag": 0.7, "end_speed": found["Corolla.vx"]}
    for function in (col.travel.speed, col.travel.q.speed):
        with pytest.raises(col.NoSolutionError, match="at any of the 512 samples") as caught:
            found.with_result("before", function, **given)
        assert caught.value.code == "refused"
        said = str(caught.value)
        assert "end_speed must be >= 0" in said
        assert "end_speed is 'Corolla.vx', which is below 0 in every sample" in said
        assert "Vehicle.from_speed(speed=..., course=...)" in said
        assert "'Corolla.speed'" in said
    with pytest.raises(col.NoSolutionError, match="look at what each argument is"):
        found.with_result("before", lambda v: v * math.nan, v=found["Corolla.vx"])
    with pytest.raises(col.InputError, match=r"v is in a unit of its own.*leave \.to\(\) out"):
        found.with_result("before", lambda v: v, v=found["Corolla.vx"].to("mph"))
    turned = found.with_result("before", lambda v: -v, "m/s", v=found["Corolla.vx"])
    assert turned["before"].mean == pytest.approx(-found["Corolla.vx"].mean, rel=1e-12)


@pytest.mark.slow
def test_the_unit_of_a_result_is_that_of_what_the_function_returns():
    found, _ = braking()
    given = {"distance": "12 m", "drag": 0.7, "end_speed": found["speed"]}
    quantities = found.with_result("before", col.travel.q.speed, **given)["before"]
    plain = found.with_result("before", col.travel.speed, "m/s", **given)["before"]
    assert quantities.unit == plain.unit == "m/s"
    assert np.array_equal(quantities.values, plain.values)
    with pytest.raises(col.UnitsError, match=r"unit is 'mph', .*write 'm/s', .*leave unit out"):
        found.with_result("before", col.travel.speed, "mph", **given)
    for unit in ("glorp", 3, "kg*m"):
        with pytest.raises(col.UnitsError, match=r"write (its SI unit, such as )?'"):
            found.with_result("before", col.travel.speed, unit, **given)


@pytest.mark.slow
def test_results_follow_from_results_and_share_no_draws():
    _, more = braking()
    drag = Normal(0.7, 0.05)
    more = more.with_result(
        "again", col.travel.speed, "m/s", distance="12 m", drag=drag, end_speed=more["speed"]
    )
    twice = more.with_result("twice", lambda x: 2.0 * x, x=more["before"])
    assert np.array_equal(twice.draws["twice"], 2.0 * more.draws["before"])
    assert twice["twice"].unit is None
    assert "by" not in twice.results_from["twice"]
    assert list(twice.results) == ["before", "again", "twice"]
    assert not np.array_equal(more.draws["before"], more.draws["again"])
    with pytest.raises(col.InputError, match="worked out were before, again, twice"):
        twice["thrice"]
    carried = more.with_result("a", lambda v: v * pint.UnitRegistry()("1 m/s"), v=more["before"])
    assert carried["a"].unit == "m/s"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "kind", "code"),
    [
        ({"name": "speed"}, col.InputError, "bad_name"),
        ({"name": " "}, col.InputError, "bad_name"),
        ({"name": 3}, col.InputError, "bad_name"),
        ({"unit": "mph"}, col.UnitsError, "bad_units"),
        ({"drag": Interval(0.6, 0.8)}, col.InputError, "bad_argument"),
        ({"end_speed": "10 m/s"}, col.InputError, "bad_argument"),
        ({"end_speed": "other"}, col.InputError, "bad_argument"),
        ({"function": lambda **given: 1.0}, col.ShapeError, None),
        ({"function": lambda **given: math.sqrt(given["end_speed"])}, col.InputError, "bad_model"),
    ],
)
def test_results_that_do_not_follow(change, kind, code):
    found, more = braking()
    given = {
        "name": "before",
        "function": col.travel.speed,
        "unit": "m/s",
        "distance": "12 m",
        "drag": 0.7,
        "end_speed": found["speed"],
    } | change
    if given["end_speed"] == "other":
        given["end_speed"] = more["before"]
    name, function, unit = (given.pop(one) for one in ("name", "function", "unit"))
    with pytest.raises(kind) as caught:
        found.with_result(name, function, unit, **given)
    assert code is None or caught.value.code == code


@pytest.mark.slow
@pytest.mark.parametrize("estimate", [posterior, reconstruct.fit])
def test_a_reading_with_the_sign_of_another_convention_is_named(estimate):
    """Recorders count a lateral delta-V positive to the right."""
    name = "impacts[0].b.delta_v_left"
    options = {"samples": 512, "seed": 1} if estimate is posterior else {}

    def said(reading):
        with warnings.catch_warnings(record=True) as given:
            warnings.simplefilter("always")
            estimate(
                lambda speed: {name: -speed, "video": speed, "marks": speed},
                {"speed": Uniform("0 m/s", "30 m/s")},
                {
                    name: (reading, "0.5 m/s"),
                    "video": ("10 m/s", "0.3 m/s"),
                    "marks": ("10 m/s", "0.3 m/s"),
                },
                **options,
            )
        return " ".join(str(one.message) for one in given)

    assert f"{name} fits better with the opposite sign: recorders count" in said("10 m/s")
    assert "opposite sign" not in said("-10 m/s")
    # So far off that the other sign is no better.
    assert "contradicts itself" in said("-25 m/s")
    assert "opposite sign" not in said("-25 m/s")


@pytest.mark.slow
@pytest.mark.parametrize("returned", ["to a full turn", "to half a turn"])
def test_a_predicted_direction_that_jumps_is_told(returned):
    """A heading about 0 that is returned in 0 to 360 degrees has a mean between both ends, and is
    told; what the warning says to return has the prior's mean and deviation.
    """

    def model(heading, speed):
        angle = np.degrees(heading) % 360.0
        if returned == "to half a turn":
            angle = (angle + 180.0) % 360.0 - 180.0
        return {"heading after": pint.Quantity(angle, "deg"), "video": speed}

    unknowns = {"heading": Normal("0 deg", "5 deg"), "speed": Uniform(5.0, 15.0)}
    observed = {"video": (10.0, 0.5)}

    def asked():
        return posterior(model, unknowns, observed, seed=1, samples=2048)

    if returned == "to a full turn":
        with pytest.warns(col.OutOfRangeWarning, match="near a full turn") as caught:
            found = asked()
        assert [one.message.code for one in caught] == ["may_wrap"]
        assert any("near a full turn" in said for said in found.statements)
        return
    found = asked()["heading after"]
    assert math.degrees(found.mean) == pytest.approx(0.0, abs=0.8)
    assert math.degrees(found.std) == pytest.approx(5.0, rel=0.1)


def _halved(v):
    return {"dv": pint.application_registry.Quantity(0.5 * v, "m/s")}


@pytest.mark.slow
@pytest.mark.parametrize("study", [posterior, fit])
def test_a_reading_as_a_text_needs_the_unit_that_the_model_returns(study):
    """A text needs its unit, a bare number is in SI; of a model of bare floats it is not known."""
    prior = {"v": Normal("10 m/s", "2 m/s")}
    options = {"samples": 512, "seed": 1} if study is posterior else {}
    readings = [("5", "1"), Normal("5", "1"), (5, "1"), Normal.between("4", "6", 0.95)]
    readings += [Interval("4", "6"), Censored(low="4")] if study is posterior else []
    for reading in readings:
        with pytest.raises(
            col.UnitsError, match=r"observed\['dv'\] = '[451]' has no unit; .*'80 km/h'"
        ):
            study(_halved, prior, {"dv": reading}, **options)
    for model in (_halved, lambda v: {"dv": 0.5 * v}):
        found = study(model, prior, {"dv": (5, 1)}, **options)
        assert found.residuals["dv"].observed == 5.0
    assert study(model, prior, {"dv": ("5", "1")}, **options).residuals["dv"].observed == 5.0


@pytest.mark.slow
@pytest.mark.parametrize("study", [posterior, fit])
def test_units_that_are_required_are_required_of_readings(study):
    """Where the model returns a unit; a model of bare floats has none."""
    prior = {"v": Normal("10 m/s", "2 m/s")}
    options = {"samples": 512, "seed": 1} if study is posterior else {}
    with col.options(require_units=True):
        for reading in ((5, 1), Normal(5, 1), (0, 1)):
            with pytest.raises(col.UnitsError, match=r"observed\['dv'\] .*require_units=True"):
                study(_halved, prior, {"dv": reading}, **options)
        study(_halved, prior, {"dv": ("5 m/s", "1 m/s")}, **options)
        study(lambda v: {"dv": 0.5 * v}, prior, {"dv": (5, 1)}, **options)
    if study is posterior:
        with col.options(require_units=True), pytest.raises(col.UnitsError, match="require_units"):
            study(_halved, prior, {"dv": (5, 1)}, threads=2, **options)


@pytest.mark.slow
@pytest.mark.parametrize(("at", "error"), [(1e4, 0.01), (1e8, 1.0)])
def test_what_no_prior_reaches_is_refused_soon(at, error):
    """As the way there, at the rate of the first stages, would take thousands of them."""
    calls = 0

    def model(x):
        nonlocal calls
        calls += 1
        return {"y": x}

    with pytest.raises(col.NoSolutionError, match="the evidence contradicts the priors"):
        posterior(model, {"x": Normal(0.0, 1.0)}, {"y": (at, error)}, samples=512, seed=1)
    assert calls < 200


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:the evidence contradicts itself")
def test_what_lies_ninety_deviations_off_is_reached():
    """In closed form; the way there takes hundreds of stages."""
    found = posterior(
        lambda x: {"y": x}, {"x": Normal(0.0, 1.0)}, {"y": (90.0, 0.01)}, samples=512, seed=1
    )
    mean, deviation = 90.0 / (1.0 + 1e-4), 0.01 / math.sqrt(1.0 + 1e-4)
    assert found["x"].mean == pytest.approx(mean, abs=deviation)


def test_what_says_all_but_the_sign_is_not_said_to_say_nothing():
    """Mean and variance are those of the prior, and nearly all of its range is excluded."""
    found = posterior(
        lambda x: {"y": x**2}, {"x": Normal(0, 2)}, {"y": (4.0, 0.1)}, samples=2048, seed=1
    )
    assert abs(found.shrinkage["x"]) < 0.1
    assert found.prior_only == ()
    assert not any("next to nothing" in one for one in found.statements)
    nothing = posterior(
        lambda x, y: {"y": y + 0.0 * x},
        {"x": Normal(0, 2), "y": Normal(4, 1)},
        {"y": (4.0, 0.1)},
        samples=512,
        seed=1,
    )
    assert nothing.prior_only == ("x",)


def test_samples_as_a_prior_of_which_few_are_left_are_warned_of():
    """Joint samples of another posterior: the exact answer has a standard deviation of 0.49, and
    its range is that of a dozen rows.
    """
    first = posterior(
        lambda a, b: {"y": a + b},
        {"a": Normal(0, 2), "b": Normal(0, 2)},
        {"y": (1.0, 0.5)},
        samples=512,
        seed=1,
    )

    def second(error, priors):
        return posterior(
            lambda a, **rest: {"z": a}, priors, {"z": (0.5, error)}, samples=1024, seed=2
        )

    with pytest.warns(col.IllConditionedWarning, match="the evidence leaves about") as told:
        found = second(0.02, first.inputs())
    assert "few_rows" in {one.message.code for one in told}
    assert len(set(found.draws["b"].tolist())) < 40
    assert any("all draws are copies" in one for one in found.statements)
    # Evidence that excludes little, and a quantity that has only these values.
    for error, priors in ((3.0, first.inputs()), (0.2, {"a": Samples([0.0, 1.0, 2.0, 4.0])})):
        assert not any("are copies" in one for one in second(error, priors).statements)
