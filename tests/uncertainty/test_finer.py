"""finer= of propagate: against closed forms of the finer model, and the finer model alone."""

import json
import math
import pickle
import re
import warnings

import numpy as np
import pytest
from scipy import integrate, optimize, stats

import collisions as col
from collisions import uncertainty
from collisions.travel import Tyres
from collisions.uncertainty import Interval, Normal, Triangular, Uniform, propagate
from collisions.uncertainty.correction import corrected
from collisions.uncertainty.finer import FinerModel
from collisions.uncertainty.model import Model

INPUTS = {"x": Normal(10.0, 1.0), "y": Uniform(0.0, 2.0)}


def line(x, y):
    return {"z": x + y}


@pytest.mark.slow
def test_a_difference_that_is_a_polynomial_is_corrected_exactly():
    """z = x + y + 0.3 x y: mean 11 + 3, and the variance of products of independent inputs."""
    found = propagate(line, INPUTS, finer=lambda x, y: {"z": x + y + 0.3 * x * y}, seed=1)["z"]
    assert found.mean == pytest.approx(14.0, abs=3.0 * found.mean_standard_error)
    # var(x + y + a x y) by the moments of x and y: E x = 10, var 1; E y = 1, var 1/3.
    a, mean_x, mean_y, var_x, var_y = 0.3, 10.0, 1.0, 1.0, 1.0 / 3.0
    variance = (1 + a * mean_y) ** 2 * var_x + (1 + a * mean_x) ** 2 * var_y + a**2 * var_x * var_y
    assert found.std == pytest.approx(math.sqrt(variance), abs=4.0 * found.std_standard_error)
    assert found.mean_standard_error < 1e-3
    shares = {
        "x": (1 + a * mean_y) ** 2 * var_x / variance,
        "y": (1 + a * mean_x) ** 2 * var_y / variance,
    }
    for name, share in shares.items():
        assert found.contributions[name] == pytest.approx(share, abs=0.01)


def test_scatter_that_cannot_be_foreseen_is_added():
    """A ripple far finer than the regression can follow: its variance, 0.3^2 / 2, is kept."""
    ripple = {"x": Normal(0.0, 1.0)}
    near = propagate(
        lambda x: {"z": x},
        ripple,
        finer=lambda x: {"z": x + 0.3 * np.sin(1e4 * x)},
        seed=1,
        finer_samples=1024,
        method="monte_carlo",
    )
    assert near.scatter["z"] == pytest.approx(0.3 / math.sqrt(2.0), rel=0.1)
    assert near["z"].std == pytest.approx(math.hypot(1.0, 0.3 / math.sqrt(2.0)), abs=0.02)
    # The correction is known to what 1,024 cases tell of its mean, and the error says so.
    assert near["z"].mean_standard_error > 0.5 * near.scatter["z"] / 32.0
    assert abs(near["z"].mean) < 4.0 * near["z"].mean_standard_error
    said = next(one for one in near.statements if "asked about 1024 of 8192 cases" in one)
    assert "in cross-validation" in said


@pytest.mark.slow
def test_standard_errors_hold_over_many_seeds():
    """Means of 60 runs about the exact mean, in their own standard errors."""
    scores = []
    for seed in range(60):
        found = propagate(
            lambda x: {"z": x},
            {"x": Normal(0.0, 1.0)},
            finer=lambda x: {"z": x + 0.3 * np.sin(1e4 * x) + 0.1 * x**2},
            seed=seed,
            samples=1024,
            finer_samples=128,
        )["z"]
        scores.append((found.mean - 0.1) / found.mean_standard_error)
    assert 0.6 < np.sqrt(np.mean(np.square(scores))) < 1.4


# A difference with a bend that no regression on powers follows: it is nothing below y = 2.2.
BENT = {"x": Normal(3.0, 0.3), "y": Normal(2.0, 0.2)}


def product(x, y):
    return {"q": x * y}


def bent(x, y):
    return {"q": x * y + 4.0 * np.maximum(y - 2.2, 0.0)}


def below(q):
    """The probability that the bent one is below q, by scipy over y."""

    def density(y):
        x = (q - 4.0 * max(y - 2.2, 0.0)) / y
        return stats.norm.pdf(y, 2.0, 0.2) * stats.norm.cdf(x, 3.0, 0.3)

    return sum(integrate.quad(density, *part)[0] for part in ((0.8, 2.2), (2.2, 3.2)))


def rippled(share):
    """The probability that x (1 + share sin(phase)) is below q for a phase that may be any."""
    phase = (np.arange(2000) + 0.5) * math.pi / 1000.0
    return lambda q: float(np.mean(stats.norm.cdf(q / (1.0 + share * np.sin(phase)))))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "finer", "inputs", "exact", "within"),
    [
        (product, bent, BENT, below, (2.0, 14.0)),
        # What is left is larger the larger x is.
        (
            lambda x: {"q": x},
            lambda x: {"q": x * (1.0 + 0.3 * np.sin(1e4 * x))},
            {"x": Normal(0.0, 1.0)},
            rippled(0.3),
            (-6.0, 6.0),
        ),
    ],
    ids=["bent", "more scatter further out"],
)
def test_errors_of_both_ends_hold_where_what_is_left_depends_on_the_inputs(
    model, finer, inputs, exact, within
):
    """Over 20 seeds, against the exact distribution: of 40 ends as many within two stated errors as
    95 in 100 allow with 1 chance in 1,000, and none beyond four; and the same of a probability.
    """
    ends = [optimize.brentq(lambda q, p=p: exact(q) - p, *within) for p in (0.025, 0.975)]
    scores, chances = [], []
    for seed in range(20):
        found = propagate(model, inputs, finer=finer, seed=seed)
        for p, end in zip((0.025, 0.975), ends, strict=True):
            error = found["q"].quantile_standard_error(p)
            scores.append(abs(found["q"].quantile(p) - end) / error)
        alone = found["q"].probability(lambda q: q > ends[1])
        assert found.probability(lambda at: at["q"] > ends[1]) == alone
        chances.append(abs(alone[0] - 0.025) / alone[1])
    assert sum(score > 2.0 for score in scores) <= 7
    assert sum(chance > 2.0 for chance in chances) <= 5
    assert max(*scores, *chances) < 4.0


@pytest.mark.slow
def test_the_error_of_an_end_has_what_the_regression_leaves():
    """One of these seeds was 4 stated errors off, where only the sampling was counted."""
    high = optimize.brentq(lambda q: below(q) - 0.975, 2.0, 14.0)
    found = propagate(product, BENT, finer=bent, seed=1)["q"]
    assert abs(found.quantile(0.975) - high) < 2.5 * found.quantile_standard_error(0.975)


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

    def model(speed_a, speed_b, restitution, friction, contact):
        a = col.Vehicle(mass=1500, vx=speed_a, yaw_inertia=2500, x=-2.1, y=0.0, heading=0.0)
        b = col.Vehicle(
            mass=1250, vy=speed_b, yaw_inertia=1900, x=0.9, y=-0.4, heading=0.5 * math.pi
        )
        impact = col.eccentric(
            a,
            b,
            restitution,
            normal=0.0,
            point=(0.0, contact),
            friction=friction,
            on_failure="nan",
            **more,
        )
        return {
            "delta_v_a": impact.a.q.delta_v,
            "course_b": impact.b.after.q.course,
            "yaw_rate_b": impact.b.after.q.yaw_rate,
        }

    return model


CRASH = {
    "speed_a": Normal(16, 1.5),
    "speed_b": Normal(12, 1.5),
    "restitution": Normal(0.1, 0.05, truncate=(0, 1)),
    "friction": Normal(0.5, 0.1, truncate=(0, None)),
    "contact": Normal(0.2, 0.1),
}


@pytest.mark.slow
def test_a_crash_with_tyres_as_the_finer_model_alone():
    """Means, deviations and the ends of the 95 % range, within their standard errors and far closer
    than the model without tyres.
    """
    near = propagate(crash(False), CRASH, finer=crash(True), seed=1)
    alone = propagate(crash(True), CRASH, seed=2)
    rough = propagate(crash(False), CRASH, seed=1)
    for name in alone:
        one, other = near[name], alone[name]
        for figure in ("mean", "std"):
            error = math.hypot(
                *(getattr(each, f"{figure}_standard_error") for each in (one, other))
            )
            assert abs(getattr(one, figure) - getattr(other, figure)) < 5.0 * error
        for p in (0.025, 0.975):
            error = math.hypot(*(each.quantile_standard_error(p) for each in (one, other)))
            assert abs(one.quantile(p) - other.quantile(p)) < 5.0 * error
    for name in ("delta_v_a", "course_b"):
        gap = abs(rough[name].mean - alone[name].mean)
        assert abs(near[name].mean - alone[name].mean) < 0.02 * gap
    assert near.calls == {"model": 8192, "finer": 512}
    assert near["delta_v_a"].to("mph").mean == pytest.approx(near["delta_v_a"].mean / 0.44704)


def side_impact(speed_a, speed_b, friction, y, **lasting):
    a = col.Vehicle(mass=1500, yaw_inertia=2500, vx=speed_a, x=-2.1, y=0.0, heading=0.0)
    b = col.Vehicle(mass=1250, yaw_inertia=1900, vy=speed_b, x=0.9, y=-0.4, heading=1.57)
    place = {"normal": 0.0, "point": (0.0, y)}
    impact = col.eccentric(a, b, 0.1, friction=friction, **place, **lasting, on_failure="nan")
    return {
        "delta_v": impact.b.q.delta_v,
        "yaw_rate": impact.b.after.q.yaw_rate,
        "pdof": impact.a.q.pdof,
    }


def side_impact_with_tyres(**values):
    tyres = Tyres(0.7, 0.2, 2.7, 1.5)
    return side_impact(**values, duration=0.12, tyres_a=tyres, tyres_b=tyres)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("friction", [Triangular(0.3, 0.5, 0.8), Uniform(0.3, 0.8)])
def test_a_regime_that_hardly_any_case_is_in_is_not_extrapolated_into(friction, seed):
    """One contact in some hundreds slid: of those asked one or none, and of the rest every one
    differs from all others in how its numbers hang together.
    """
    inputs = {
        "speed_a": Normal(15.0, 1.5),
        "speed_b": Normal(8.0, 1.0),
        "friction": friction,
        "y": Normal(0.2, 0.1),
    }
    near = propagate(side_impact, inputs, finer=side_impact_with_tyres, seed=seed)
    exact = propagate(side_impact_with_tyres, inputs, seed=seed)
    for name, one in exact.outputs.items():
        assert near[name].std == pytest.approx(one.std, rel=0.01)
        off = np.abs(near[name].values - one.values)
        assert np.nanmax(off) < 0.5 * one.std
        assert near[name].contributions == pytest.approx(one.contributions, abs=0.03)
    more = near.calls["finer"] - 512
    assert 0 <= more < 80
    assert any(f"and {more} more that lie beyond these" in one for one in near.statements) == (
        more > 0
    )


@pytest.mark.slow
@pytest.mark.parametrize(("least", "most_off"), [(3.1, 1e-9), (2.6, 0.5)])
@pytest.mark.parametrize("unlike", [0.0, 1e-3])
def test_a_difference_that_is_one_number_is_not_taken_for_that_of_another_regime(
    least, most_off, unlike
):
    """Beyond the least x the model is off by more than 100. Of the cases asked one or none is
    there, which is then alone: what is left of it is no scatter of the others. Or a few are, and
    the others there are corrected by these.
    """

    def model(x, y):
        return {"z": np.where(x > least, 50.0 * x, x) + y}

    def finer(x, y):
        usual = model(x, y)["z"] + 0.1 + unlike * np.sin(1e4 * x)
        return {"z": np.where(x > least, x + y, usual)}

    inputs = {"x": Normal(0.0, 1.0), "y": Normal(1.0, 0.2)}
    for seed in range(4):
        near, exact = (
            propagate(one, inputs, seed=seed, **more)["z"]
            for one, more in ((model, {"finer": finer}), (finer, {}))
        )
        assert near.std == pytest.approx(exact.std, rel=2e-3)
        assert np.max(abs(near.values - exact.values)) < 5.0 * unlike + most_off
        assert near.contributions["y"] == pytest.approx(0.04 / 1.04, abs=0.01)


@pytest.mark.parametrize("gap", [(0.45, 0.5), (0.4, 0.5)])
def test_cases_that_neither_model_answers_do_not_lie_beyond_those_asked(gap):
    """There is nothing to correct in them; the models differ by one number."""

    def model(x, y, more=0.0):
        none = (y / 2.0 > gap[0]) & (y / 2.0 < gap[1])
        return {"z": np.where(none, np.nan, x + y + more)}

    with pytest.warns(col.OutOfRangeWarning, match="had no answer"):
        found = propagate(model, INPUTS, finer=lambda x, y: model(x, y, 0.1), seed=1)
    assert found.calls["finer"] == 512
    assert found.failed == pytest.approx(8192 * (gap[1] - gap[0]), abs=2)
    with pytest.warns(col.OutOfRangeWarning, match="had no answer"):
        alone = propagate(lambda x, y: model(x, y, 0.1), INPUTS, seed=1)
    assert found["z"].mean == pytest.approx(alone["z"].mean, abs=1e-9)


@pytest.mark.slow
def test_more_cases_beyond_those_asked_than_were_asked_are_refused():
    """The first 64 of 4,096 cases are of one regime, a tenth of all others of another."""

    def model(x, rare):
        return {"z": x, "other": np.where(rare > 1.0, 0.0, x)}

    draws = np.concatenate([np.zeros(64), np.where(np.arange(4032) % 10 == 0, 2.0, 0.0)])
    inputs = {"x": np.random.default_rng(1).normal(size=4096), "rare": draws}
    answers = model(**inputs)
    whole = Model(model, {})
    whole.units = {"z": None, "other": None}
    dearer = FinerModel(lambda x, rare: {"z": x + 1.0, "other": x}, {})
    with pytest.raises(col.NoSolutionError, match="404 of 4096 cases lie so far beyond the 64"):
        corrected(whole, dearer, inputs, answers, 64, 1)
    found = corrected(whole, dearer, inputs, answers, 640, 1)
    assert found.calls == 640
    assert found.values["z"] == pytest.approx(inputs["x"] + 1.0)


def test_directions_are_corrected_round_the_circle():
    """About pi: 0.1 rad more take half of them past it."""

    def direction(turn):
        def model(x):
            angle = math.pi + 0.05 * x + turn
            return {"course": col.Vehicle(mass=1.0, vx=np.cos(angle), vy=np.sin(angle)).q.course}

        return model

    found = propagate(direction(-0.1), {"x": Normal(0.0, 1.0)}, finer=direction(0.02), seed=1)[
        "course"
    ]
    assert abs(math.remainder(found.mean - math.pi - 0.02, math.tau)) < 1e-3
    assert found.std == pytest.approx(0.05, rel=0.01)


def test_all_samples_may_be_asked():
    """Then the answer is that of the finer model, to the bit."""
    near = propagate(line, INPUTS, finer=lambda x, y: {"z": x * y}, seed=1, samples=256)
    alone = propagate(lambda x, y: {"z": x * y}, INPUTS, seed=1, samples=256)
    assert np.array_equal(near["z"].values, alone["z"].values)
    assert near.calls == {"model": 256, "finer": 256}
    assert near["z"].mean_standard_error == alone["z"].mean_standard_error
    assert near["z"].contributions == alone["z"].contributions


@pytest.mark.slow
@pytest.mark.parametrize("method", ["quasi_random", "latin_hypercube", "monte_carlo"])
def test_a_seed_makes_it_reproducible(method):
    options = {"seed": 3, "samples": 1024, "finer_samples": 100, "method": method}
    runs = [
        propagate(line, INPUTS, finer=lambda x, y: {"z": x * y}, threads=threads, **options)
        for threads in (1, 2)
    ]
    assert runs[0].to_dict() == runs[1].to_dict()
    again = pickle.loads(pickle.dumps(runs[0]))
    assert again.to_dict() == runs[0].to_dict()
    found = json.loads(json.dumps(again.to_dict(), allow_nan=False))
    assert found["calls"] == {"model": 1024, "finer": 100}
    assert set(found["scatter"]) == {"z"}


def test_both_models_warnings_are_stated():
    def warning(limit):
        def model(speed):
            found = col.reconstruct.momentum(
                1500.0,
                1200.0,
                course_a=0.0,
                course_b=math.pi / 2,
                course_a_after=0.1,
                course_b_after=-0.3,
                speed_a_after=5.0,
                speed_b_after=np.where(speed > limit, 4.0, 0.1),
            )
            return {"z": speed + 0.0 * found.speed_b}

        return model

    with pytest.warns(col.OutOfRangeWarning, match="finer: .*speed_b is below 0"):
        found = propagate(warning(10.0), {"speed": Normal(10.0, 1.0)}, finer=warning(9.0), seed=1)
    said = [one for one in found.statements if "speed_b is below 0" in one]
    assert sorted(one.partition(" ")[0] for one in said) == ["4096", "finer:"]


def test_a_few_cases_that_only_one_model_answers_are_said():
    def finer(x, y):
        return {"z": np.where(x < 12.4, x + y, np.nan)}

    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        found = propagate(line, INPUTS, finer=finer, seed=1)
    assert [one.message.code for one in given] == ["finer_differs", "failed_cases"]
    asked = re.match(
        r"in (\d+) of 512 cases asked of both, .* among the other 7680, .* about (\d+) will",
        str(given[0].message),
    )
    assert asked is not None
    assert int(asked[2]) == round(7680 * int(asked[1]) / 512)
    assert found.failed == int(np.sum(np.isnan(found["z"].values)))


def jump(x, y):
    return {"z": np.where(np.sin(97.0 * x) > 0.0, 5.0, -5.0)}


@pytest.mark.parametrize(
    ("finer", "options", "kind", "code", "text"),
    [
        (jump, {}, col.NoSolutionError, "too_different",
            r"z of the finer model cannot be foreseen.*propagate\(finer, inputs\)"),
        (lambda x, y: {"z": np.where(x < 11.0, x, np.nan)}, {}, col.NoSolutionError,
            "too_different", "differ in .* on whether there is an answer"),
        # 1.8 percent; the test above has 0.8.
        (lambda x, y: {"z": np.where(x < 12.1, x, np.nan)}, {}, col.NoSolutionError,
            "too_different", "differ in .* on whether there is an answer"),
        (lambda x, y: {"w": x}, {}, col.InputError, "different_outputs",
            "z is no output of finer and a plain number of model; w is a plain number"),
        (lambda x: {"z": x}, {}, col.InputError, "bad_inputs", "finer: inputs are x, y"),
        (lambda x, y: {"z": math.sqrt(x)}, {}, col.InputError, "bad_model", "finer: model raised"),
        (3.0, {}, col.InputError, "bad_model", "finer: model must be a function"),
        (line, {"method": "first_order"}, col.InputError, "no_finer", "'first_order' draws none"),
        (line, {"method": "second_order"}, col.InputError, "no_finer", "draws none"),
        (line, {"method": "interval"}, col.InputError, "no_finer", "draws none"),
        (line, {"tolerance": 0.1}, col.InputError, "no_finer", "tolerance= asks for as many"),
        (line, {"finer_samples": 63}, col.InputError, "bad_option", "from 64 to"),
        (line, {"finer_samples": 1.5}, col.InputError, "bad_option", "finer_samples must be"),
        (None, {"finer_samples": 100}, col.InputError, "bad_option", "finer= is not given"),
    ],
)  # fmt: skip
def test_refusals(finer, options, kind, code, text):
    with pytest.raises(kind, match=f"(?s){text}") as refused:
        propagate(line, INPUTS, finer=finer, seed=1, **options)
    assert refused.value.code == code


def test_intervals_and_outputs_of_yes_or_no_are_refused():
    with pytest.raises(col.InputError, match="y is an Interval") as refused:
        propagate(line, INPUTS | {"y": Interval(0.0, 1.0)}, finer=line, seed=1)
    assert refused.value.code == "no_finer"
    with pytest.raises(col.NoSolutionError, match="z is either 0 or 1") as refused:
        propagate(lambda x, y: {"z": x > 10.0}, INPUTS, finer=lambda x, y: {"z": x > 10.02}, seed=1)
    assert refused.value.code == "too_different"
    same = propagate(
        lambda x, y: {"z": x > 10.0}, INPUTS, finer=lambda x, y: {"z": x > 10.0}, seed=1
    )
    assert same["z"].mean == pytest.approx(0.5, abs=0.01)
    assert isinstance(same["z"], uncertainty.Output)


def test_the_scatter_is_told_with_its_share_of_the_spread_of_the_output():
    """A ripple of 0.3 on a spread of 1: 0.2 of 1.02, a fifth."""
    near = propagate(
        lambda x: {"z": x},
        {"x": Normal(0.0, 1.0)},
        finer=lambda x: {"z": x + 0.3 * np.sin(1e4 * x)},
        seed=1,
        finer_samples=512,
        method="monte_carlo",
    )
    said = next(one for one in near.statements if "in cross-validation" in one)
    share = float(said.split(" z ")[1].split("(")[1].split(" %")[0])
    assert share == pytest.approx(100.0 * near.scatter["z"] / near["z"].std, rel=0.05)
    assert share == pytest.approx(20.8, rel=0.1)


def test_what_is_not_foreseen_is_no_share_of_an_input():
    """A ripple of 0.6 on a variance of 2: 0.18 of 2.18, of which the regression sees nothing."""
    near = propagate(
        lambda x, y, z: {"o": x + y},
        {"x": Normal(0.0, 1.0), "y": Normal(0.0, 1.0), "z": Uniform(-1.0, 1.0)},
        finer=lambda x, y, z: {"o": x + y + 0.6 * np.sin(15.0 * z)},
        seed=1,
    )
    assert any("as a share of the variance belongs to no input" in one for one in near.statements)
    for shares in (near["o"].contributions, near["o"].total_contributions):
        assert shares == {
            "x": pytest.approx(1.0 / 2.18, abs=0.02),
            "y": pytest.approx(1.0 / 2.18, abs=0.02),
            "z": pytest.approx(0.0, abs=0.005),
        }
    kept = sum(near["o"].contributions.values())
    assert kept == pytest.approx(1.0 - (near.scatter["o"] / near["o"].std) ** 2, abs=0.01)


def test_what_the_cases_asked_cannot_show_is_said():
    """The finer model differs in a slot that holds one case in 5,000, and none of those asked."""
    near = propagate(
        lambda x, y: {"o": 0.3 * x + y},
        {"x": Uniform(0.0, 1.0), "y": Normal(0.0, 1.0)},
        finer=lambda x, y: {"o": 0.3 * x + y + np.where(abs(x - 0.3) < 1e-4, 8.0, 0.0)},
        seed=1,
    )
    assert near.scatter["o"] == 0.0
    assert any("and in fewer than 3 of 512 cases, may be missed" in one for one in near.statements)
    share, error = near["o"].probability(lambda values: values > 6.0)
    assert share == 0.0
    assert error == pytest.approx(1.0 / 512.0, rel=0.01)
    # Of a yes or no that both models answer in the same way, too.
    seldom = propagate(
        lambda x: {"p": x > 9.0},
        {"x": Normal(0.0, 1.0)},
        finer=lambda x: {"p": x > 9.0},
        seed=1,
    )
    assert seldom["p"].mean_standard_error == pytest.approx(1.0 / 512.0)
    _, error = near.probability(lambda of: of["o"] > 6.0)
    assert error == pytest.approx(1.0 / 512.0, rel=0.01)


@pytest.mark.slow
def test_the_error_of_a_mean_is_mostly_that_of_the_few_cases_asked():
    """Evenly drawn, samples know the mean of the model far better than 256 cases know that of a
    ripple of 0.3: 0.3 / sqrt(2) / 16. An error from eight parts is known to a quarter, the mean
    over eight seeds to a tenth.
    """
    squares = []
    for seed in range(8):
        found = propagate(
            lambda x: {"z": x},
            {"x": Normal(0.0, 1.0)},
            finer=lambda x: {"z": x + 0.3 * np.sin(1e4 * x)},
            seed=seed,
            finer_samples=256,
            method="latin_hypercube",
        )
        squares.append(found["z"].mean_standard_error ** 2)
    assert math.sqrt(np.mean(squares)) == pytest.approx(0.3 / math.sqrt(2.0) / 16.0, rel=0.3)


@pytest.mark.parametrize(("ripple", "refused"), [(0.42, False), (0.58, True)])
def test_a_correction_that_leaves_more_than_a_third_of_the_spread_is_refused(ripple, refused):
    """A ripple of a on a spread of 1 leaves a / sqrt(2 + a^2) of the whole: 0.28 and 0.38."""

    def corrected():
        return propagate(
            lambda x: {"z": x},
            {"x": Normal(0.0, 1.0)},
            finer=lambda x: {"z": x + ripple * np.sin(1e4 * x)},
            seed=1,
            finer_samples=512,
            method="monte_carlo",
        )

    if refused:
        with pytest.raises(col.NoSolutionError, match="more than a third of its spread") as caught:
            corrected()
        assert caught.value.code == "too_different"
    else:
        assert corrected()["z"].std == pytest.approx(math.sqrt(1.0 + ripple**2 / 2.0), rel=0.05)
