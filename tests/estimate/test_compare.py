"""compare: Bayes factors against closed forms of normal readings, and what is refused."""

import dataclasses
import json
import math
import pickle

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct
from collisions.reconstruct import compare, posterior
from collisions.uncertainty import Normal, Uniform

READING = {"v": (16.0, 1.0)}


def account(prior, observed=None, seed=1, samples=4096):
    return posterior(
        lambda v: {"v": v}, {"v": prior}, observed or READING, samples=samples, seed=seed
    )


@pytest.fixture(scope="module")
def accounts():
    """Three statements of a speed, each to 1 m/s."""
    return {str(mean): account(Normal(mean, 1.0), seed=mean) for mean in (14, 16, 17)}


def test_factors_and_probabilities_of_normal_accounts(accounts):
    """A reading of variance 1 about a mean of variance 1: the density is exp(-(16 - mean)^2/4),
    times what all have in common.
    """
    found = compare(accounts)
    logs = {name: -((16.0 - float(name)) ** 2) / 4.0 for name in accounts}
    for (one, other), factor in found.log_bayes_factors.items():
        error = found.log_bayes_factor_errors[one, other]
        assert abs(factor - (logs[one] - logs[other])) <= 5.0 * error
        assert error < 0.1
        assert found.log_bayes_factors[other, one] == -factor
    total = sum(map(math.exp, logs.values()))
    for name, log in logs.items():
        assert (
            abs(found.probability[name] - math.exp(log) / total)
            <= 5.0 * found.probability_error[name]
        )
    assert sum(found.probability.values()) == pytest.approx(1.0, rel=1e-12)


def test_a_prior_of_the_accounts_weighs_in(accounts):
    """Odds after are odds before times the Bayes factor, which does not depend on them."""
    two = {name: accounts[name] for name in ("14", "16")}
    even, uneven = compare(two), compare(two, prior={"14": 0.9, "16": 0.1})
    assert uneven.log_bayes_factors == even.log_bayes_factors
    odds = uneven.probability["16"] / uneven.probability["14"]
    assert odds == pytest.approx(math.exp(even.log_bayes_factors["16", "14"]) / 9.0, rel=1e-12)
    assert uneven.prior == {"14": 0.9, "16": 0.1}


@pytest.mark.slow
def test_errors_of_probabilities_are_those_of_repeated_runs():
    """The spread over 40 seeds of a probability near a half, against the mean of its stated errors:
    40 values tell it to 11 percent.
    """
    found = [
        compare(
            {
                "a": account(Normal(16, 1), seed=seed, samples=512),
                "b": account(Uniform(14, 20), seed=seed + 100, samples=512),
            }
        )
        for seed in range(40)
    ]
    spread = np.std([one.probability["a"] for one in found], ddof=1)
    stated = math.sqrt(np.mean([one.probability_error["a"] ** 2 for one in found]))
    assert 0.65 < spread / stated < 1.5


@pytest.mark.slow
def test_a_wider_prior_loses(accounts):
    """Of a uniform prior of width w around the reading the evidence is 1/w: so is its factor, and
    the priors are printed.
    """
    found = compare({"narrow": account(Uniform(10, 22)), "wide": account(Uniform(0, 120), seed=2)})
    factor, error = (
        found.log_bayes_factors["narrow", "wide"],
        found.log_bayes_factor_errors["narrow", "wide"],
    )
    assert abs(factor - math.log(10.0)) <= 5.0 * error
    assert found.priors == {
        "narrow": {"v": str(Uniform(10, 22))},
        "wide": {"v": str(Uniform(0, 120))},
    }
    for text in (repr(found), found._repr_html_()):
        assert "0 to 120" in text
        assert "times" in text


@pytest.mark.slow
def test_the_sentence(accounts):
    found = compare(accounts)
    assert found.sentence.startswith("The evidence is ")
    assert 'more probable if "16" is true than if "17" is and ' in found.sentence
    assert (
        'than if "14" is. Prior probabilities of 0.333 for "14", 0.333 for "16" and 0.333 for '
        '"17" become ' in found.sentence
    )
    with pytest.warns(col.CollisionsWarning, match="contradicts itself"):
        far = account(Normal(30, 1))
    found = compare({"here": accounts["16"], "far": far})
    assert (
        'more than a million times more probable if "here" is true than if "far" is'
        in found.sentence
    )
    assert found.probability["far"] < 1e-18
    assert json.loads(json.dumps(found.to_dict(), allow_nan=False))["sentence"] == found.sentence
    assert pickle.loads(pickle.dumps(found)).to_dict() == found.to_dict()
    assert isinstance(found, reconstruct.Comparison)


@pytest.mark.slow
def test_evidence_against_every_account_is_warned_of():
    with pytest.warns(col.CollisionsWarning, match="contradicts itself"):
        far, farther = account(Normal(26, 1)), account(Normal(27, 1))
    with pytest.warns(col.CollisionsWarning, match="contradicts every account") as given:
        compare({"far": far, "farther": farther})
    assert given[0].message.code == "contradictory"


@pytest.mark.parametrize(
    ("change", "prior", "code", "text"),
    [
        (lambda two: [two], None, "bad_type", "two or more posteriors by name"),
        (lambda two: {"one": two["14"]}, None, "bad_type", "two or more"),
        (lambda two: two | {"x": 3.0}, None, "bad_type", "two or more"),
        (lambda two: two | {"x": account(Normal(16, 1), {"v": (16.0, 2.0)})}, None,
            "different_evidence", "of v; only accounts of the same"),
        (lambda two: two, {"14": 0.5}, "bad_prior", "a probability for each of 14, 16"),
        (lambda two: two, {"14": 0.5, "16": 0.6}, "bad_prior", "add up to 1"),
        (lambda two: two, {"14": 0.0, "16": 1.0}, "bad_prior", "above 0"),
        (lambda two: two, {"14": "a", "16": 1.0}, "bad_units", "prior"),
    ],
)  # fmt: skip
def test_refusals(accounts, change, prior, code, text):
    two = {name: accounts[name] for name in ("14", "16")}
    with pytest.raises(col.InputError, match=f"(?s){text}") as refused:
        compare(change(two), prior)
    assert refused.value.code == code


def stated(found, log_evidence, error):
    """The posterior with this evidence and this sampling error of its logarithm."""
    return dataclasses.replace(found, log_evidence=log_evidence, log_evidence_error=error)


def test_the_range_in_the_sentence_is_two_standard_errors_of_independent_runs(accounts):
    """A factor of 20 whose logarithm is known to hypot(0.03, 0.04) = 0.05: 20 exp(0.1) = 22.1 and
    20 exp(-0.1) = 18.1 are two standard errors away.
    """
    found = compare(
        {
            "here": stated(accounts["16"], math.log(20.0), 0.03),
            "there": stated(accounts["17"], 0.0, 0.04),
        }
    )
    assert found.log_bayes_factor_errors["here", "there"] == pytest.approx(0.05, rel=1e-12)
    assert "The evidence is 20 times (18.1 to 22.1, allowing for sampling error)" in found.sentence
    assert "of 0.5 for " in found.sentence
    assert "become 0.952 and 0.0476." in found.sentence


def test_the_sentence_begins_with_what_the_evidence_favours_whatever_was_thought_before(accounts):
    """Evidence and prior point to different accounts: the factor stays that of the evidence."""
    two = {
        "likely": stated(accounts["16"], 0.0, 0.001),
        "unlikely": stated(accounts["17"], math.log(3.0), 0.001),
    }
    found = compare(two, {"likely": 0.9, "unlikely": 0.1})
    assert found.sentence.startswith(
        "The evidence is 3 times (2.99 to 3.01, allowing for sampling error) more probable if "
        '"unlikely" is true than if "likely" is. Prior probabilities of 0.9 for "likely" and 0.1 '
        'for "unlikely" become 0.75 and 0.25.'
    )


def test_errors_of_probabilities_are_those_of_the_evidence_passed_on(accounts):
    """Three accounts whose evidence is known with different errors: the spread of the probabilities
    over draws of the logarithms, which is not the same for all.
    """
    logs, errors = np.array([0.0, 0.7, -0.4]), np.array([0.002, 0.02, 0.08])
    three = {
        name: stated(accounts["16"], float(log), float(error))
        for name, log, error in zip("abc", logs, errors, strict=True)
    }
    found = compare(three, {"a": 0.2, "b": 0.3, "c": 0.5})
    drawn = np.random.default_rng(1).normal(logs, errors, (100_000, 3))
    weights = np.array([0.2, 0.3, 0.5]) * np.exp(drawn)
    spread = np.std(weights / weights.sum(axis=1, keepdims=True), axis=0)
    # 100,000 draws tell a spread to 0.3 percent; the second order of the errors is as small.
    assert [found.probability_error[name] for name in "abc"] == pytest.approx(spread, rel=0.015)


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_what_the_accounts_state_stands_in_the_comparison():
    """Once where several state it, with their names; not that the evidence of each agrees."""
    a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.1, y=0.0, heading=0.0)
    b = col.Vehicle(mass=1250, yaw_inertia=1900, x=0.9, y=-0.4, heading=math.pi / 2, vy=8.0)

    def hit(normal):
        def model(vx):
            found = col.eccentric(a.replace(vx=vx), b, 0.1, normal=normal, point=(0.0, 0.2),
                                  friction=0.5, on_failure="nan")  # fmt: skip
            return {"delta_v": found.a.delta_v}

        return posterior(
            model, {"vx": Uniform(3.0, 25.0)}, {"delta_v": (5.0, 0.3)}, samples=512, seed=1
        )

    found = compare({"square": hit(0.0), "turned": hit(0.3)})
    (said,) = (one for one in found.statements if "as an instant" in one)
    assert said.startswith("square, turned: eccentric solved every case as an instant")
    assert not any("the evidence agrees with" in one for one in found.statements)


def test_a_prior_that_the_evidence_contradicts_is_named_as_one():
    readings = dict.fromkeys("abc", (6.0, 0.1))
    with pytest.warns(col.CollisionsWarning, match="the furthest off is the prior of v"):
        found = posterior(
            lambda v: dict.fromkeys(readings, v), {"v": Normal(0, 1)}, readings, samples=512, seed=1
        )
    said = "contradicts itself, the model, the stated errors or the priors: a misfit"
    assert any(said in one for one in found.statements)
