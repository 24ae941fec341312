"""probability of a condition: against normal probabilities, counts of drawn cases, and what has no
answer or no samples.
"""

import math

import mpmath
import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct, travel
from collisions.uncertainty import Interval, Normal, Uniform, propagate

TWO = {"x": Normal(3.0, 0.4), "y": Normal(2.0, 0.3)}


def both(x, y):
    return {"x": x + 0.0 * y, "y": y + 0.0 * x}


def above(limit):
    return lambda values: values > limit


@pytest.mark.parametrize("method", ["quasi_random", "latin_hypercube", "monte_carlo"])
@pytest.mark.parametrize("limit", [2.0, 3.0, 3.9])
def test_of_one_output_it_is_that_of_the_normal_distribution(method, limit):
    found = propagate(both, TWO, method=method, seed=1)
    chance, error = found["x"].probability(above(limit))
    exact = float(1 - mpmath.ncdf((limit - 3.0) / 0.4))
    assert abs(chance - exact) <= 6.5 * error
    assert error < 0.02
    assert found.probability(lambda at: at["x"] > limit) == (chance, error)


def test_of_two_outputs_it_is_that_of_their_difference():
    found = propagate(both, TWO, seed=2)
    chance, error = found.probability(lambda at: at["x"] > at["y"])
    assert abs(chance - float(mpmath.ncdf(1.0 / 0.5))) <= 6.5 * error
    together = found.probability(lambda at: (at["x"] > 3.0) & (at["y"] > 2.0))
    assert abs(together[0] - 0.25) <= 6.5 * together[1]


def test_what_no_sample_shows_has_an_error_of_one_sample():
    found = propagate(both, TWO, samples=64, seed=1)
    assert found["x"].probability(above(99.0)) == (0.0, 1 / 64)
    assert found["x"].probability(above(-99.0)) == (1.0, 1 / 64)


@pytest.mark.filterwarnings("ignore:.*had no answer")
def test_samples_without_an_answer_are_left_out_where_the_condition_reads_them():
    """x is uniform from 0 to 1 and its root NaN below 0.5: among the others half are above 0.75,
    and as many not.
    """

    def model(x):
        return {"x": x, "root": np.sqrt(x - 0.5)}

    found = propagate(model, {"x": Uniform(0.0, 1.0)}, seed=1)
    for condition in (lambda root: root > 0.5, lambda root: ~(root > 0.5)):
        chance, error = found["root"].probability(condition)
        assert abs(chance - 0.5) <= 6.5 * error
        assert found.probability(lambda at, ask=condition: ask(at["root"])) == (chance, error)
    chance, error = found.probability(lambda at: at["x"] > 0.75)
    assert abs(chance - 0.25) <= 6.5 * error
    # A condition on an array of those with an answer may use figures of that array.
    assert found["root"].probability(lambda root: root <= np.median(root))[0] == pytest.approx(0.5)


@pytest.mark.filterwarnings("ignore:.*had no answer")
def test_outputs_that_never_have_an_answer_together_are_refused():
    def model(x):
        return {"low": np.sqrt(0.5 - x), "high": np.sqrt(x - 0.5)}

    found = propagate(model, {"x": Uniform(0.0, 1.0)}, seed=1)
    with pytest.raises(col.NoSolutionError, match="'low', 'high'") as caught:
        found.probability(lambda at: at["low"] > at["high"])
    assert caught.value.code == "all_failed"


def test_a_posterior_leaves_out_what_has_no_answer_too():
    with pytest.warns(col.OutOfRangeWarning, match=r"samples \([\d.]+ %\) have no 'root'"):
        found = reconstruct.posterior(
            lambda x: {"x": x, "root": np.where(x > 0.0, x, np.nan) ** 0.5},
            {"x": Normal(0.0, 1.0)},
            {"x": (0.0, 1.0)},
            samples=1024,
            seed=1,
        )
    # The posterior is N(0, 1/2); of its positive half, those whose root is below the median.
    median = math.sqrt(0.5) * 0.6744897501960817
    for condition in (
        lambda at: at["root"] ** 2 < median,
        lambda at: ~(at["root"] ** 2 < median),
    ):
        chance, error = found.probability(condition)
        assert abs(chance - 0.5) <= 5.0 * error
        assert error < 0.1
    assert abs(found["root"].probability(lambda root: root**2 < median)[0] - 0.5) < 0.2


def test_in_the_unit_that_was_asked_for():
    def stop(skid):
        return {"speed": col.Vehicle(mass=1.0, vx=travel.speed(skid, drag=0.7)).q.vx}

    found = propagate(stop, {"skid": Normal("25 m", "2 m")}, seed=1)["speed"]
    assert found.to("mph").probability(lambda v: v > 40.0) == found.probability(
        lambda v: v > 40.0 * 0.44704
    )
    with pytest.raises(col.InputError, match="booleans"):
        found.to("mph").probability(lambda v: v)
    with pytest.raises(AttributeError, match="on the object itself"):
        found.q.probability(lambda v: v > 40.0)


@pytest.mark.parametrize(
    "condition",
    [3.0, lambda at: True, lambda at: at, lambda at: at[:3] > 1.0, lambda at: at.speed > 1.0],
)
def test_conditions_that_are_none_are_refused(condition):
    found = propagate(both, TWO, samples=64, seed=1)
    for asked in (found["x"].probability, found.probability):
        with pytest.raises(col.InputError, match="booleans, such as lambda") as caught:
            asked(condition)
        assert caught.value.code == "bad_condition"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("inputs", "method", "text"),
    [
        (TWO, "first_order", "take method='quasi_random'"),
        (TWO, "second_order", "take method='quasi_random'"),
        ({"x": Interval(1, 2), "y": Interval(1, 2)}, "interval", "give it a distribution"),
        ({"x": Interval(1, 2), "y": Normal(1, 2)}, "quasi_random", "give it a distribution"),
    ],
)
def test_methods_without_samples_say_what_to_take(inputs, method, text):
    found = propagate(both, inputs, method=method)
    for asked in (found["x"].probability, found.probability):
        with pytest.raises(col.InputError, match=text) as caught:
            asked(lambda at: at > 1.0)
        assert caught.value.code == "not_sampled"


def test_a_condition_on_a_direction_is_asked_of_what_the_model_gives():
    """Near half a turn the range is counted beyond it, and the condition not: against the normal
    distribution round the circle.
    """
    spread = math.radians(8.0)

    def model(x):
        around = np.mod(x + math.pi, math.tau) - math.pi
        return {"course": pint.Quantity(around, "rad")}

    given = {"x": Normal(math.radians(-170.0), spread)}
    found = propagate(model, given, seed=1)
    assert found["course"].interval()[0] < -math.pi

    def below(degrees):
        return 0.5 * math.erfc(-math.radians(degrees + 170.0) / spread / math.sqrt(2.0))

    for condition, exact in (
        (lambda course: course > 0.0, below(-180.0)),
        (lambda course: course > math.radians(170.0), below(-180.0) - below(-190.0)),
        (
            lambda course: np.abs(course) > math.radians(175.0),
            below(-175.0) - below(-185.0),
        ),
    ):
        alone = found["course"].probability(condition)
        joint = found.probability(lambda at, asked=condition: asked(at["course"]))
        assert alone == joint
        assert alone[0] == pytest.approx(exact, abs=2e-3)
    assert found["course"].to("deg").probability(lambda course: course > 0.0)[0] == pytest.approx(
        below(-180.0), abs=2e-3
    )
