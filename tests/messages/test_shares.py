"""Probabilities and shares that are printed never say what is certain where it is not."""

import math

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct
from collisions.messages.shares import chance, in_percent, percent_beyond
from collisions.uncertainty import Normal, propagate


@pytest.mark.parametrize(
    ("probability", "figures", "text"),
    [
        (0.0, 2, "less than 1e-300"),
        (1e-310, 2, "less than 1e-300"),
        (2e-300, 2, "2e-300"),
        (0.0316, 2, "0.032"),
        (0.9949, 2, "0.99"),
        (0.996, 2, "more than 0.99"),
        (1.0, 2, "more than 0.99"),
        (0.9994, 3, "0.999"),
        (0.99951, 3, "more than 0.999"),
    ],
)
def test_a_probability_is_never_rounded_to_a_certainty(probability, figures, text):
    assert chance(probability, figures) == text


@pytest.mark.parametrize(
    ("part", "whole", "text"),
    [
        (0, 10**6, "0 %"),
        (3, 10**5, "0.003 %"),
        (999, 1000, "99.9 %"),
        (99_999, 100_000, "more than 99.9 %"),
        (7, 7, "100 %"),
    ],
)
def test_a_share_of_cases_is_100_percent_of_all_alone(part, whole, text):
    assert in_percent(part, whole) == text


def test_a_misfit_beyond_all_floats_has_no_chance_of_0():
    """A hundred standard errors: exp(-5000), which no float holds."""
    with pytest.warns(col.CollisionsWarning, match="contradicts"):
        found = reconstruct.fit(lambda x: {"y": x}, {"x": Normal(0.0, 1.0)}, {"y": (100.0, 1.0)})
    assert "has a chance of less than 1e-300" in found.statements[0]
    page = col.explain(found, form="text")
    assert any("chance of such" in row and "less than 1e-300" in row for row in page.splitlines())


def test_evidence_that_agrees_to_the_last_digit_has_no_chance_of_1():
    found = reconstruct.fit(lambda x: {"y": x}, {"x": Normal(20.0, 1.0)}, {"y": (20.001, 1.0)})
    assert "has a chance of more than 0.99" in found.statements[0]


@pytest.mark.slow
def test_accounts_compared_are_never_certain():
    """Evidence of 8.6 sigma for one of two: the other keeps exp(-8.6^2/4) of it, about 1e-8."""

    def account(mean):
        priors = {"s": Normal(mean, 1.0)}
        return reconstruct.posterior(lambda s: {"m": s}, priors, {"m": (16.6, 1.0)}, seed=1)

    with pytest.warns(col.CollisionsWarning):
        found = reconstruct.compare({"a": account(8.0), "b": account(17.0)})
    assert 0.0 < found.probability["a"] < 1e-7
    assert "become 9.66e-09 and more than 0.999." in found.sentence
    (row,) = [one for one in str(found).splitlines() if one.strip().startswith("b ")][:1]
    assert "more than 0.999 " in row
    assert "±" not in row


def test_few_cases_without_an_answer_are_not_0_percent():
    def model(x):
        return {"y": np.where(abs(x) < 4.2, x, np.nan)}

    with pytest.warns(col.OutOfRangeWarning, match=r"\(0\.00\d+ %\) had no answer"):
        propagate(model, {"x": Normal(0.0, 1.0)}, samples=65_536, seed=1)


@pytest.mark.parametrize(
    ("share", "text"),
    [(0.13, "13"), (0.104, "10.4"), (0.1004, "10.04"), (0.11, "11"), (math.inf, "inf")],
)
def test_a_share_beyond_its_limit_does_not_read_like_it(share, text):
    assert percent_beyond(share, 0.1) == text
