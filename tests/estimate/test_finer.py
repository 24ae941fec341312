"""finer= of posterior and fit: the answer is that of the finer model, against closed forms,
quadrature over a grid, and the finer model alone.

Errors of sampling are from eight islands, so of Student's t with 7 degrees of freedom: beyond five
of them lies a chance of 0.0016. Seeds are fixed.
"""

import json
import math
import pickle
import warnings

import numpy as np
import pytest
from scipy import stats

import collisions as col
from collisions import reconstruct
from collisions.estimate import tempering
from collisions.reconstruct import fit, posterior
from collisions.travel import Tyres
from collisions.uncertainty import Censored, Interval, Normal, Uniform

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


def normal_log(x, mean, sd):
    return -0.5 * ((x - mean) / sd) ** 2 - math.log(sd) - 0.5 * math.log(2.0 * math.pi)


def by_grid(model, log_prior, axes, observed):
    """Log evidence, and mean and standard deviation of each unknown, by sums over a grid."""
    points = np.meshgrid(*axes, indexing="ij")
    log = log_prior(*points)
    for name, column in model(*points).items():
        reading = observed[name]
        if isinstance(reading, Interval):
            inside = (column >= reading.low) & (column <= reading.high)
            log = log + np.where(inside, 0.0, -np.inf)
        else:
            log = log + normal_log(column, *reading)
    log = np.where(np.isnan(log), -np.inf, log)
    weight = np.exp(log - log.max())
    cell = math.prod(float(axis[1] - axis[0]) for axis in axes)
    total = float(np.sum(weight))
    means = [float(np.sum(weight * one)) / total for one in points]
    stds = [
        math.sqrt(float(np.sum(weight * (one - mean) ** 2)) / total)
        for one, mean in zip(points, means, strict=True)
    ]
    return float(log.max()) + math.log(total * cell), means, stds


def check_by_grid(found, exact):
    log_evidence, means, stds = exact
    close(found.log_evidence, found.log_evidence_error, log_evidence, 0.01)
    for name, mean, std in zip(found, means, stds, strict=True):
        one = found[name]
        close(one.mean, one.mean_standard_error, mean)
        close(one.std, one.std_standard_error, std)


# --- closed forms and quadrature


@pytest.mark.slow
def test_one_reading_through_two_lines():
    """Prior N(20, 2); the finer model reads 1.1 v: mean, deviation and evidence in closed form."""
    found, codes = sampled(
        lambda v: {"read": v},
        {"v": Normal(20.0, 2.0)},
        {"read": (23.0, 1.0)},
        finer=lambda v: {"read": 1.1 * v},
    )
    precision = 0.25 + 1.1**2
    close(found["v"].mean, found["v"].mean_standard_error, (5.0 + 1.1 * 23.0) / precision)
    close(found["v"].std, found["v"].std_standard_error, precision**-0.5)
    exact = normal_log(23.0, 22.0, math.hypot(1.0, 2.2))
    close(found.log_evidence, found.log_evidence_error, exact)
    # What it predicts is what the finer model computes.
    assert np.array_equal(found["read"].values, 1.1 * found["v"].values)
    assert found.calls["finer"] < 10 * found.samples < found.calls["model"]
    assert not codes


def side(speed, offset):
    return {"v": speed * np.cos(offset), "w": speed * np.sin(offset)}


def finer_side(speed, offset):
    return {
        "v": 1.1 * speed * np.cos(offset) + 0.02 * speed**2 * np.sin(offset),
        "w": speed * np.sin(1.1 * offset) - 0.3,
    }


def answered(model, where):
    """A model that answers only where it is told to."""

    def found(speed, offset):
        there = where(speed, offset)
        return {name: np.where(there, one, np.nan) for name, one in model(speed, offset).items()}

    return found


SIDE = {"speed": Uniform(0, 30), "offset": Normal(0.3, 0.2)}
AXES = (np.linspace(0.0, 30.0, 1201)[1:], np.linspace(-0.9, 1.5, 1201))
READINGS = {"v": (20.0, 1.0), "w": (4.5, 0.5)}


def log_side(speed, offset):
    return normal_log(offset, 0.3, 0.2) - math.log(30.0) + 0.0 * speed


TWO = {
    "readings": (side, finer_side, READINGS),
    "a sharp bound": (side, finer_side, {"v": (20.0, 1.0), "w": Interval(4.6, 4.8)}),
    "sharp bounds that the first model meets elsewhere": (
        side,
        lambda speed, offset: {"v": speed * np.cos(offset), "w": 2.0 * speed * np.sin(offset)},
        {"v": Interval(14.0, 15.0), "w": Interval(4.0, 4.3)},
    ),
    "the finer model has fewer answers": (
        side,
        answered(finer_side, lambda speed, offset: speed < 17.3),
        READINGS,
    ),
    "the finer model has a few more answers": (
        answered(side, lambda speed, offset: speed < 19.2),
        finer_side,
        READINGS,
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", TWO)
def test_two_unknowns_by_quadrature(case):
    model, finer, observed = TWO[case]
    found, codes = sampled(model, SIDE, observed, finer=finer)
    check_by_grid(found, by_grid(finer, log_side, AXES, observed))
    assert "islands_disagree" not in codes
    assert "collapsed" not in codes
    for name, one in observed.items():
        if isinstance(one, Interval):
            assert one.low <= found[name].values.min() <= found[name].values.max() <= one.high


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "finer"),
    [
        (answered(side, lambda speed, offset: speed < 18.0), finer_side),
        (
            answered(side, lambda speed, offset: offset < 0.27),
            answered(finer_side, lambda speed, offset: offset > 0.2),
        ),
    ],
)
def test_samples_where_only_the_finer_model_answers_are_said(model, finer):
    """A sixth of them and more: near what is right, with a warning that the way was not sure."""
    found, codes = sampled(model, SIDE, READINGS, finer=finer)
    log_evidence, means, stds = by_grid(finer, log_side, AXES, READINGS)
    for name, mean, std in zip(SIDE, means, stds, strict=True):
        assert found[name].mean == pytest.approx(mean, abs=0.1 * std)
        assert found[name].std == pytest.approx(std, rel=0.1)
    assert found.log_evidence == pytest.approx(log_evidence, abs=0.3)
    speed, offset = (found[name].values for name in SIDE)
    beyond = float(np.mean(np.isnan(model(speed, offset)["v"])))
    assert found.beyond == pytest.approx(beyond, abs=0.03)
    assert "beyond_model" in codes
    assert any("where only the finer model has an answer" in one for one in found.statements)


@pytest.mark.slow
def test_a_posterior_far_from_the_first_one():
    """Eight deviations between the two, and only some way there: what is found is right, or said
    not to be.
    """
    observed = {"v": (24.0, 0.3), "w": (4.5, 0.2)}
    model = answered(side, lambda speed, offset: speed < 22.0)
    found, codes = sampled(model, SIDE, observed, finer=finer_side)
    log_evidence, means, _ = by_grid(finer_side, log_side, AXES, observed)
    assert found["speed"].mean == pytest.approx(means[0], abs=0.1)
    assert found["offset"].mean == pytest.approx(means[1], abs=0.004)
    assert "islands_disagree" in codes or abs(found.log_evidence - log_evidence) < 0.5


@pytest.mark.slow
@pytest.mark.parametrize("error", [0.2, 0.05, 0.02, 0.01, 0.002])
def test_a_reading_finer_than_the_difference_of_the_models(error):
    """They are up to 450 errors of the reading apart, and less where x is small, to where all
    samples would be drawn half-way between them; by quadrature over the ridge that is left.
    """

    def model(x, y):
        return {"p": x * y}

    def finer(x, y):
        return {"p": 1.08 * x * y + 0.1 * x}

    priors = {"x": Normal(3.0, 1.0), "y": Normal(2.0, 0.5)}
    found, codes = sampled(model, priors, {"p": (7.0, error)}, finer=finer, samples=2048)
    # Of each x the reading of p is one of y, with the prior of y known to its error.
    x = np.linspace(0.05, 8.0, 20001)
    mean, sd = 1.08 * x * 2.0 + 0.1 * x, np.hypot(error, 1.08 * x * 0.5)
    log = normal_log(x, 3.0, 1.0) + np.array(
        [normal_log(7.0, *pair) for pair in zip(mean.tolist(), sd.tolist(), strict=True)]
    )
    weight = np.exp(log)
    middle = np.sum(weight * x) / np.sum(weight)
    std = math.sqrt(np.sum(weight * (x - middle) ** 2) / np.sum(weight))
    close(found["x"].mean, found["x"].mean_standard_error, middle)
    assert found["x"].mean == pytest.approx(middle, abs=0.2 * std)
    assert found["x"].std == pytest.approx(std, rel=0.2)
    evidence = math.log(np.sum(weight) * (x[1] - x[0]))
    assert found.log_evidence == pytest.approx(evidence, abs=0.35)
    assert "contradictory" not in codes


@pytest.mark.slow
def test_numbers_at_the_edge_of_the_floats_have_an_answer():
    """Their spread overflows, and nothing can be learnt from it."""
    priors = {"x": Uniform(2.6, 8.7), "y": Normal(1.7e308, 1e307, truncate=(-6e306, None))}
    found, _ = sampled(
        lambda x, y: {"d": np.hypot(x, y)},
        priors,
        {"d": Censored(low=7.0, error=0.5)},
        finer=lambda x, y: {"d": np.hypot(x, y) * (1.0 - 0.01 * (x > 5.0))},
        samples=512,
    )
    assert 2.6 < found["x"].mean < 8.7
    assert np.all(np.isfinite(found["d"].values))


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("sharp", [True, False])
def test_an_unknown_that_matters_in_one_regime_of_the_finer_model(sharp, seed):
    """There the models are some ten errors of the reading apart, and elsewhere alike."""

    def regime(x):
        return np.where(x > 9.5, 1.0, 0.0) if sharp else 1.0 / (1.0 + np.exp(-(x - 9.5) / 0.1))

    def finer(x, y):
        return {"v": x + y * regime(x)}

    priors = {"x": Uniform(0.0, 20.0), "y": Normal(0.0, 1.0)}
    found, codes = sampled(
        lambda x, y: {"v": x}, priors, {"v": (10.0, 0.1)}, finer=finer, seed=seed
    )
    # Of each x the reading is one of y.
    x = (np.arange(40000) + 0.5) * 20.0 / 40000
    apart, sd = x - 10.0, np.hypot(0.1, regime(x))
    weight = np.exp(-0.5 * (apart / sd) ** 2) / sd
    mean = np.sum(weight * x) / np.sum(weight)
    std = math.sqrt(np.sum(weight * (x - mean) ** 2) / np.sum(weight))
    assert found["x"].mean == pytest.approx(mean, abs=0.15 * std)
    assert found["x"].std == pytest.approx(std, rel=0.15)
    top = x[np.searchsorted(np.cumsum(weight) / np.sum(weight), 0.975)]
    assert found["x"].interval(0.95)[1] == pytest.approx(top, abs=0.4 * std)
    assert "contradictory" not in codes


@pytest.mark.slow
@pytest.mark.parametrize("places", ["b", "ab"])
@pytest.mark.parametrize("error", [0.3, 0.1, 0.05])
def test_places_of_rest_surveyed_more_closely_than_the_models_agree(places, error):
    """A slide to rest with one drag, and cars that go a quarter further where they turn: the places
    differ by 1.3 m, and the survey by centimetres.
    """

    def slid(further):
        def model(speed_a, speed_b, contact, friction, drag):
            a = col.Vehicle(mass=1500, vx=speed_a, yaw_inertia=2500, x=-2.1, y=0.3, heading=0.0)
            b = col.Vehicle(mass=1250, vy=speed_b, yaw_inertia=1900, x=0.9, y=-0.4, heading=1.5708)
            impact = col.eccentric(
                a, b, 0.1, normal=0.0, point=(0.0, contact), friction=friction, on_failure="nan"
            )
            found = {}
            for label in places:
                after = getattr(impact, label).after
                way = after.speed**2 / (2.0 * 9.80665 * drag)
                way = way * (1.0 + further * np.tanh(np.abs(after.yaw_rate) / 3.0))
                found[f"x_{label}"] = way * after.vx / after.speed
                found[f"y_{label}"] = way * after.vy / after.speed
            return found

        return model

    priors = {
        "speed_a": Uniform(5, 30),
        "speed_b": Uniform(3, 25),
        "contact": Normal(0.2, 0.15),
        "friction": Normal(0.5, 0.1, truncate=(0.2, 0.9)),
        "drag": Normal(0.55, 0.08, truncate=(0.2, 0.9)),
    }
    finer = slid(0.25)
    observed = {name: (one, error) for name, one in finer(15.0, 9.0, 0.25, 0.45, 0.5).items()}
    found, codes = sampled(slid(0.0), priors, observed, finer=finer, samples=2048)
    alone, _ = sampled(finer, priors, observed, samples=2048, seed=2)
    # Of six seeds one leaves an island behind, and says so.
    within = 0.6 if "islands_disagree" in codes else 0.3
    for name in priors:
        one, other = found[name], alone[name]
        apart = math.hypot(one.mean_standard_error, other.mean_standard_error)
        close(one.mean, apart, other.mean, 0.1 * other.std)
        assert one.std == pytest.approx(other.std, rel=within), name
    off = math.hypot(found.log_evidence_error, alone.log_evidence_error)
    close(found.log_evidence, off, alone.log_evidence, 0.2)
    assert "contradictory" not in codes


@pytest.mark.slow
def test_three_unknowns_by_brute_force():
    """Speeds before an inline impact and its restitution; the finer model loses 8 % to the tyres,
    more at low speeds.
    """

    def central(speed_a, speed_b, restitution):
        change = (1.0 + restitution) * (speed_a - speed_b)
        return {
            "delta_v_a": 1250.0 / 2750.0 * change,
            "after_b": speed_b + 1500.0 / 2750.0 * change,
        }

    def with_tyres(speed_a, speed_b, restitution):
        found = central(speed_a, speed_b, restitution)
        return {
            "delta_v_a": 1.08 * found["delta_v_a"] + 0.4,
            "after_b": found["after_b"] - 0.6 - 0.5 / (1.0 + speed_b**2),
        }

    def log_prior(speed_a, speed_b, restitution):
        return (
            normal_log(speed_a, 18.0, 4.0)
            + normal_log(speed_b, 6.0, 2.0)
            + normal_log(restitution, 0.2, 0.08)
        )

    priors = {
        "speed_a": Normal(18.0, 4.0),
        "speed_b": Normal(6.0, 2.0),
        "restitution": Normal(0.2, 0.08),
    }
    observed = {"delta_v_a": (7.0, 0.5), "after_b": (13.5, 0.8)}
    axes = (np.linspace(4, 32, 141), np.linspace(-2, 14, 129), np.linspace(-0.2, 0.6, 101))
    found, codes = sampled(central, priors, observed, finer=with_tyres)
    check_by_grid(found, by_grid(with_tyres, log_prior, axes, observed))
    assert not codes


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_islands_agree_on_seventeen_unknowns(seed):
    """Nine readings of normal unknowns, linear: mean, deviation and evidence in closed form. With
    1,024 samples the islands agree, for no more than twelve calls of the finer model a sample.
    """
    rng = np.random.default_rng([17, seed])
    count, readings, error = 17, 9, 0.2
    names = [f"u{k}" for k in range(count)]
    near = rng.normal(size=(readings, count)) / math.sqrt(count) * np.repeat([6.0, 1.0], [4, 13])
    far = near * (1.0 + 0.1 * rng.normal(size=near.shape))
    offset = error * rng.normal(size=readings)
    read = far @ rng.normal(size=count) + offset + error * rng.normal(size=readings)

    def linear(matrix, constant):
        def model(**values):
            found = np.einsum("ij,j...->i...", matrix, np.stack([values[name] for name in names]))
            return {f"r{k}": one + constant[k] for k, one in enumerate(found)}

        return model

    found, codes = sampled(
        linear(near, np.zeros(readings)),
        dict.fromkeys(names, Normal(0.0, 1.0)),
        {f"r{k}": (one, error) for k, one in enumerate(read)},
        finer=linear(far, offset),
        samples=1024,
        seed=seed,
    )
    covariance = np.linalg.inv(np.eye(count) + far.T @ far / error**2)
    mean = covariance @ far.T @ (read - offset) / error**2
    of_readings = error**2 * np.eye(readings) + far @ far.T
    misfit = (read - offset) @ np.linalg.solve(of_readings, read - offset)
    exact = -0.5 * (misfit + np.linalg.slogdet(2.0 * math.pi * of_readings)[1])
    assert "islands_disagree" not in codes
    # Its error is 0.18 in the mean of such problems.
    assert found.log_evidence == pytest.approx(exact, abs=0.7)
    std = np.sqrt(np.diag(covariance))
    off = [(found[name].mean - mean[k]) / std[k] for k, name in enumerate(names)]
    assert np.max(np.abs(off)) < 0.2
    assert np.sqrt(np.mean(np.square(off))) < 0.07
    ratios = [found[name].std / std[k] for k, name in enumerate(names)]
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.03)
    assert found.calls["finer"] < 12 * found.samples
    # Chi-squared of the best sample lies 4 above the least, more or less by 1.
    assert stats.chi2.isf(found.p_value, readings) == pytest.approx(misfit, abs=2.5)


# --- the finer model alone


def crash(lasting):
    """A side impact, of an instant or of 0.12 s with the wheels of A locked."""
    more = (
        {
            "duration": 0.12,
            "tyres_a": Tyres(0.75, 1.0, 2.7, 1.5),
            "tyres_b": Tyres(0.75, 0.0, 2.6, 1.5),
        }
        if lasting
        else {}
    )

    def model(speed_a, speed_b, restitution, friction, contact, turn):
        a = col.Vehicle(mass=1500, vx=speed_a, yaw_inertia=2500, x=-2.1, y=0.0, heading=0.0)
        b = col.Vehicle(
            mass=1250, vy=speed_b, yaw_inertia=1900, x=0.9, y=-0.4, heading=0.5 * math.pi
        )
        impact = col.eccentric(
            a,
            b,
            restitution,
            normal=turn,
            point=(0.0, contact),
            friction=friction,
            on_failure="nan",
            **more,
        )
        return {
            "delta_v_a": impact.a.q.delta_v,
            "speed_a_after": impact.a.after.q.speed,
            "course_a_after": impact.a.after.q.course,
            "course_b_after": impact.b.after.q.course,
            "yaw_rate_b_after": impact.b.after.q.yaw_rate,
        }

    return model


PRIORS = {
    "speed_a": Uniform(3, 35),
    "speed_b": Uniform(0, 30),
    "restitution": Normal(0.1, 0.05, truncate=(0, 1)),
    "friction": Normal(0.5, 0.15, truncate=(0, None)),
    "contact": Normal(0.2, 0.1),
    "turn": Normal(0.0, 0.07),
}
ERRORS = {
    "delta_v_a": (0.4, "m/s"),
    "speed_a_after": (0.8, "m/s"),
    "course_a_after": (0.035, "rad"),
    "course_b_after": (0.035, "rad"),
    "yaw_rate_b_after": (0.2, "rad/s"),
}


def evidence(rng):
    """Readings with errors of a crash that lasts."""
    truth = {
        "speed_a": rng.uniform(10, 22),
        "speed_b": rng.uniform(6, 18),
        "restitution": rng.uniform(0.05, 0.15),
        "friction": rng.uniform(0.3, 0.8),
        "contact": rng.normal(0.2, 0.1),
        "turn": rng.normal(0.0, 0.07),
    }
    exact = crash(True)(**{name: np.array([value]) for name, value in truth.items()})
    return {
        name: Normal(f"{exact[name].magnitude[0] + error * rng.normal()} {unit}", f"{error} {unit}")
        for name, (error, unit) in ERRORS.items()
    }


def inline(tyres):
    """Speeds before an inline impact and its restitution, from recorder and run-out."""

    def model(speed_a, speed_b, restitution):
        change = (1.0 + restitution) * (speed_a - speed_b)
        lost = tyres * (0.5 + 0.1 * speed_b)
        return {
            "delta_v_a": 1250.0 / 2750.0 * change + lost,
            "after_b": speed_b + 1500.0 / 2750.0 * change - lost,
        }

    return model


def problems(count):
    """So many problems: cheap and finer model, priors, and readings drawn with the finer model."""
    rng = np.random.default_rng(20261125)
    for k in range(count):
        if k % 3 == 0:
            yield crash(False), crash(True), PRIORS, evidence(rng)
            continue
        models = (inline(0.0), inline(rng.uniform(0.3, 1.2)))
        priors = {
            "speed_a": Normal(18.0, 4.0),
            "speed_b": Normal(6.0, 2.0),
            "restitution": Uniform(0.0, 0.5),
        }
        errors = {"delta_v_a": 0.5, "after_b": 0.8}
        truth = {"speed_a": rng.normal(18, 4), "speed_b": 6.0, "restitution": rng.uniform(0, 0.5)}
        if k % 3 == 2:
            models, priors, errors = (side, finer_side), SIDE, {"v": 1.0, "w": 0.5}
            truth = {"speed": rng.uniform(8, 25), "offset": rng.normal(0.3, 0.2)}
        exact = models[1](**truth)
        observed = {
            name: (exact[name] + error * rng.normal(), error) for name, error in errors.items()
        }
        yield *models, priors, observed


@pytest.mark.slow
def test_the_same_answer_as_the_finer_model_alone_on_twelve_problems():
    """Means, deviations and evidence differ by their sampling errors: the scores have the spread of
    a difference of two Student's t, for a fraction of the calls.
    """
    scores, calls = [], []
    for k, (model, finer, priors, observed) in enumerate(problems(12)):
        near, _ = sampled(model, priors, observed, finer=finer, samples=1024, seed=k)
        alone, _ = sampled(finer, priors, observed, samples=1024, seed=k + 100)
        for name in priors:
            one, other = near[name], alone[name]
            for figure in ("mean", "std"):
                errors = (getattr(each, f"{figure}_standard_error") for each in (one, other))
                scores.append((getattr(one, figure) - getattr(other, figure)) / math.hypot(*errors))
        scores.append(
            (near.log_evidence - alone.log_evidence)
            / math.hypot(near.log_evidence_error, alone.log_evidence_error)
        )
        calls.append(near.calls["finer"] / alone.calls["model"])
    # Of t with 7 degrees of freedom or more: deviation 1.18, one in 500 beyond 5.
    assert np.sqrt(np.mean(np.square(scores))) < 1.5
    assert np.max(np.abs(scores)) < 5.0
    assert abs(np.mean(scores)) < 0.4
    assert np.mean(calls) < 0.25


# --- fit


UNKNOWNS = PRIORS | {"restitution": Normal(0.1, 0.05), "friction": Normal(0.5, 0.15)}


@pytest.mark.slow
@pytest.mark.parametrize("seed", [4, *(pytest.param(k, marks=pytest.mark.slow) for k in (6, 7))])
def test_a_fit_is_that_of_the_finer_model(seed):
    """Value by value the same as from 64 starts of the finer model, for a fifth of its calls."""
    observed = evidence(np.random.default_rng(seed))
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        near = fit(crash(False), UNKNOWNS, observed, finer=crash(True))
        alone = fit(crash(True), UNKNOWNS, observed)
    codes = [one.message.code for one in given]
    assert codes[: len(codes) // 2] == codes[len(codes) // 2 :]
    for name in UNKNOWNS:
        error = alone[name].standard_error
        assert near[name].value == pytest.approx(alone[name].value, abs=1e-3 * error)
        assert near[name].standard_error == pytest.approx(error, rel=1e-3)
    assert near.chi_squared == pytest.approx(alone.chi_squared, abs=1e-6)
    assert near.calls["finer"] < 0.2 * alone.calls["model"]
    assert near.to_dict()["calls"] == near.calls
    assert "that of the finer model" in " ".join(near.statements)


def test_a_fit_by_a_line_has_a_closed_form():
    """y = 2 x + 1 read as 7 +/- 0.5 gives 3 +/- 0.25, whatever the first model says."""
    found = fit(
        lambda x: {"y": 1.5 * x},
        {"x": Uniform(0, 10)},
        {"y": (7.0, 0.5)},
        finer=lambda x: {"y": 2.0 * x + 1.0},
    )
    assert found["x"].value == pytest.approx(3.0, rel=1e-9)
    assert found["x"].standard_error == pytest.approx(0.25, rel=1e-6)


@pytest.mark.slow
def test_ranges_of_a_finer_model_that_bends_cost_few_calls_of_it():
    """Ends at which chi-squared, with the other unknowns fitted again, rises by 3.84: as of the
    finer model alone, with a call of it where that takes one more for each unknown.
    """

    def bent(more):
        def model(speed, friction, mass, angle):
            energy = mass * speed**2 * (1.0 + more * friction)
            return {
                "energy": energy,
                "way": speed**2 / friction + 30.0 * more * angle,
                "delta-V": speed * np.cos(angle) + more * friction**2,
            }

        return model

    unknowns = {
        "speed": Interval(1.0, 40.0),
        "friction": Normal(0.6, 0.15, truncate=(0.1, 1.2)),
        "mass": Normal(1.5, 0.1),
        "angle": Normal(0.3, 0.3),
    }
    observed = {"energy": (330.0, 90.0), "way": (300.0, 120.0), "delta-V": (13.0, 3.0)}
    alone = fit(bent(0.1), unknowns, observed)
    found = fit(bent(0.0), unknowns, observed, finer=bent(0.1))
    assert found.profiles
    for name in found.profiles:
        low, high = alone[name].interval(0.95)
        assert found[name].interval(0.95) == pytest.approx((low, high), abs=0.005 * (high - low))
    # A third of it for the searches all over the bounds.
    assert found.calls["finer"] < 0.2 * alone.calls["model"]


@pytest.mark.slow
@pytest.mark.parametrize("known", [(0.5, 0.15), (0.55, 0.15), (0.45, 0.1), (0.6, 0.2)])
def test_a_contact_that_only_the_finer_model_lets_slide_is_found(known):
    """Of the cheap model it stuck, at one speed of B; where it slid, the friction has its say, and
    any speed above fits about as well.
    """

    def solved(friction):
        def model(speed_a, speed_b, ratio):
            a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.0, y=0.3, heading=0.0, vx=speed_a)
            b = col.Vehicle(mass=1200, yaw_inertia=1900, x=0.9, y=-0.5, heading=1.5, vy=speed_b)
            impact = col.eccentric(
                a,
                b,
                0.1,
                normal=0.0,
                point=(0.0, 0.0),
                friction=friction(ratio),
                on_failure="nan",
            )
            return {"delta_v": impact.a.delta_v, "aside": impact.a.after.vy}

        return model

    stuck, may_slide = solved(lambda ratio: 1e3), solved(lambda ratio: ratio)
    truth = stuck(12.0, 9.0, 0.5)
    observed = {name: (value, 0.1) for name, value in truth.items()}
    unknowns = {
        "speed_a": Interval(3.0, 25.0),
        "speed_b": Interval(0.0, 25.0),
        "ratio": Normal(*known),
    }
    alone = fit(may_slide, unknowns, observed)
    found = fit(stuck, unknowns, observed, finer=may_slide)
    assert alone["speed_b"].interval(0.95)[1] == 25.0
    for name in unknowns:
        low, high = alone[name].interval(0.95)
        assert found[name].interval(0.95) == pytest.approx((low, high), abs=0.02 * (high - low))
    assert len(found.others) == 1


@pytest.mark.slow
def test_ranges_that_a_reading_excludes_to_the_last_digit_end_in_an_answer_or_a_refusal():
    """A delta-V of nearly nothing, the wrong way, with an error of as little."""

    def struck(x, y):
        a, b = col.Vehicle(mass=1500.0, vx=x), col.Vehicle(mass=1200.0, vx=y)
        return {"s": col.linear_central(a, b, 0.2, on_failure="nan").a.delta_v}

    def finer(x, y):
        return struck(1.02 * x, y)

    unknowns = {"x": Normal(17.01, 1.0, truncate=(13.15, None)), "y": Interval(-2.908, 6.642)}
    # Which of the two it is hangs on the last digit, which differs between processors.
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always", col.CollisionsWarning)
        try:
            found = fit(struck, unknowns, {"s": (-1e-9, 1e-9)}, finer=finer)
        except col.CollisionsError:
            return
    assert math.isfinite(found["x"].value)
    assert any("contradicts itself" in str(one.message) for one in given)


@pytest.mark.slow
def test_two_answers_of_the_finer_model_are_refused_with_the_call_to_write():
    """Of (x - 1)^2 = 4: both are found from both answers of x^2 = 4."""
    with pytest.raises(col.AmbiguousSolutionError) as refused:
        fit(
            lambda x: {"y": x * x},
            {"x": Uniform(-3.5, 3.5)},
            {"y": (4.0, 0.5)},
            finer=lambda x: {"y": (x - 1.0) ** 2},
        )
    found = sorted(one["x"].value for one in refused.value.solutions)
    assert found == pytest.approx([-1.0, 3.0], abs=1e-6)
    assert "write posterior(model, unknowns, observed, seed=1)" in str(refused.value)


@pytest.mark.slow
def test_rival_answers_say_on_what_they_agree():
    """|x| = 2 has two answers, of the same y."""
    with pytest.raises(
        col.AmbiguousSolutionError, match=r"They agree on y within a standard error"
    ):
        fit(
            lambda x, y: {"s": x * x, "t": y},
            {"x": Uniform(-5, 5), "y": Uniform(0, 10)},
            {"s": (4.0, 0.1), "t": (3.0, 0.1)},
        )


def test_what_nothing_determines_is_said_of_the_finer_model_too():
    def model(x, y):
        return {"s": x + 0.0 * y}

    with pytest.warns(col.IllConditionedWarning, match="y is not determined"):
        found = fit(
            model,
            {"x": Uniform(0, 10), "y": Uniform(0, 1)},
            {"s": (4.0, 0.5)},
            finer=lambda x, y: {"s": 1.1 * x + 0.0 * y},
        )
    assert found["x"].value == pytest.approx(4.0 / 1.1, rel=1e-9)


@pytest.mark.parametrize(
    ("finer", "kind", "code", "text"),
    [
        ("x", col.InputError, "bad_model", "finer: model must be a function"),
        (lambda y: {"s": y}, col.InputError, "bad_model", "finer: unknowns are x, but"),
        (lambda x: {"t": x}, col.InputError, "unknown_output", "the model does not return"),
        (lambda x: {"s": x, "t": x}, col.InputError, "different_outputs", "t is a plain number"),
        (lambda x: {"s": np.where(x > 5.0, x, np.nan)}, col.NoSolutionError, "refused",
            r"fit\(finer, unknowns, observed\)"),
    ],
)  # fmt: skip
def test_finer_models_of_a_fit_that_are_none(finer, kind, code, text):
    with pytest.raises(kind, match=text) as refused:
        fit(lambda x: {"s": x}, {"x": Uniform(0, 10)}, {"s": (2.0, 0.1)}, finer=finer)
    assert refused.value.code == code


# --- the run


@pytest.mark.slow
def test_a_seed_makes_it_reproducible_for_any_number_of_threads():
    options = {"samples": 1024, "seed": 7, "finer": finer_side}
    one, _ = sampled(side, SIDE, READINGS, **options)
    other, _ = sampled(side, SIDE, READINGS, threads=2, **options)
    assert other.to_dict() == one.to_dict()
    assert np.array_equal(other["speed"].values, one["speed"].values)
    assert pickle.loads(pickle.dumps(one)).to_dict() == one.to_dict()
    assert json.loads(json.dumps(one.to_dict(), allow_nan=False))["calls"] == one.calls
    said = " ".join(str(one.summary()).split())
    assert "The figures are those of the finer model, called" in said


@pytest.mark.slow
def test_calls_are_all_cases_that_either_model_was_asked():
    """But for those that are asked again, to see whether the model answers case by case."""
    asked = {"model": 0, "finer": 0}

    def counted(name, model):
        def found(speed, offset):
            asked[name] += len(speed)
            return model(speed, offset)

        return found

    found, _ = sampled(
        counted("model", side),
        SIDE,
        READINGS,
        finer=counted("finer", finer_side),
        samples=1024,
    )
    for name in asked:
        assert found.calls[name] <= asked[name] <= found.calls[name] + 40
    asked["model"] = 0
    alone, _ = sampled(counted("model", side), SIDE, READINGS, samples=512)
    assert set(alone.calls) == {"model"}
    assert alone.calls["model"] <= asked["model"] <= alone.calls["model"] + 40


@pytest.mark.slow
def test_progress_rises_to_the_end():
    seen = []
    sampled(
        side,
        SIDE,
        READINGS,
        finer=finer_side,
        samples=1024,
        progress=lambda done, total: seen.append(done),
    )
    assert seen == sorted(seen)
    assert seen[-1] == 1024


@pytest.mark.slow
def test_both_models_warn_and_only_the_finer_one_of_the_answer():
    def warning(model, slowest):
        def found(speed, offset):
            # Speed B comes out below 0 where B goes off fast.
            reconstruct.momentum(
                1500.0,
                1200.0,
                course_a=0.0,
                course_b=math.pi / 2,
                course_a_after=0.1,
                course_b_after=-0.3,
                speed_a_after=5.0,
                speed_b_after=np.where(speed > slowest, 4.0, 0.1),
            )
            return model(speed, offset)

        return found

    found, codes = sampled(
        warning(side, 0.0), SIDE, READINGS, finer=warning(finer_side, 17.5), samples=512
    )
    fast = int(np.sum(found["speed"].values > 17.5))
    assert 0 < fast < 512
    said = [one for one in found.statements if "speed_b is below 0" in one]
    assert len(said) == 2
    assert said[0].startswith(f"{fast} of 512 cases")
    assert said[1].startswith("model, not finer: 512 of 512 cases")
    assert len(codes) == len(set(codes))
    by_code = [note for note in found.model_notes if "speed_b is below 0" in note.sentence]
    assert [note.warning is None for note in by_code] == [False, True]


@pytest.mark.parametrize(
    ("finer", "kind", "code", "text"),
    [
        (3.0, col.InputError, "bad_model", "finer: model must be a function"),
        (lambda speed: side(speed, 0.0), col.InputError, "bad_model",
            "finer: unknowns are speed, offset, but the model takes"),
        (lambda speed, offset: {"v": speed}, col.InputError, "different_outputs",
            "w is no output of finer and a plain number of model"),
        (lambda speed, offset: {**side(speed, offset), "x": speed}, col.InputError,
            "different_outputs", "x is a plain number of finer and no output of model"),
        (lambda speed, offset: {name: col.Vehicle(mass=1.0, vx=one).q.vx
            for name, one in side(speed, offset).items()}, col.InputError, "different_outputs",
            "v is in m/s of finer and a plain number of model"),
        (lambda speed, offset: {"v": math.cos(speed), "w": speed}, col.InputError, "bad_model",
            "finer: model raised"),
        (lambda speed, offset: {"v": speed - speed.mean(), "w": offset}, col.InputError,
            "bad_model", "finer: model mixes cases"),
        (lambda speed, offset: {"v": np.nan * speed, "w": offset}, col.NoSolutionError, "too_far",
            r"run the finer model alone: posterior\(finer, unknowns, observed\)"),
    ],
)  # fmt: skip
def test_finer_models_that_are_none(finer, kind, code, text):
    with pytest.raises(kind, match=text) as refused:
        posterior(side, SIDE, READINGS, finer=finer, samples=512, seed=1)
    assert refused.value.code == code
    assert refused.value.fields.get("argument") in ("finer", "unknowns", None)


@pytest.mark.slow
def test_sharp_bounds_that_only_the_first_model_meets_are_refused():
    with pytest.raises(col.NoSolutionError, match="run the finer model alone") as refused:
        posterior(
            lambda x: {"y": x},
            {"x": Uniform(0.0, 1.0)},
            {"y": Interval(0.2, 0.4)},
            finer=lambda x: {"y": x + 5.0},
            samples=512,
            seed=1,
        )
    assert refused.value.code == "too_far"


@pytest.mark.slow
def test_a_way_that_does_not_end_is_refused(monkeypatch):
    monkeypatch.setattr(tempering, "_MOST_STEPS", 1)
    with pytest.raises(col.NoSolutionError, match="too far from") as refused:
        posterior(side, SIDE, READINGS, finer=finer_side, samples=512, seed=1)
    assert refused.value.code == "too_far"


@pytest.mark.slow
def test_a_censored_reading_with_an_error():
    """Against the finer model alone: nothing of it is softened."""
    observed = {"v": Censored(low=18.0, error=0.5), "w": (4.5, 0.5)}
    near, _ = sampled(side, SIDE, observed, finer=finer_side)
    alone, _ = sampled(finer_side, SIDE, observed, seed=2)
    for name in SIDE:
        error = math.hypot(near[name].mean_standard_error, alone[name].mean_standard_error)
        close(near[name].mean, error, alone[name].mean)
    error = math.hypot(near.log_evidence_error, alone.log_evidence_error)
    close(near.log_evidence, error, alone.log_evidence)
