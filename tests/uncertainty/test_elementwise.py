"""A model works every case out by itself: one that mixes cases, or draws random numbers, is
refused; honest ones are not.
"""

import math
import warnings

import numpy as np
import pint
import pytest

import collisions as col
from collisions.uncertainty import Interval, Normal, Uniform, model, propagate, sampling

METHODS = ("first_order", "second_order", "latin_hypercube", "quasi_random", "monte_carlo")
V = {"v": Normal(20.0, 2.0)}
BETWEEN = {"v": Interval(14.0, 26.0)}
RUNS = [(V, {"method": method}) for method in METHODS]
RUNS += [(V, {"method": method, "threads": 2, "samples": 8192}) for method in METHODS[2:]]
RUNS += [(BETWEEN, {"method": "interval"})]
RUNS += [
    (V | {"k": Interval(1.0, 2.0)}, {"method": method})
    for method in ("first_order", "quasi_random")
]
every_run = pytest.mark.parametrize(
    ("inputs", "how"), RUNS, ids=lambda of: "-".join(map(str, of.values()))
)


def refused(function, inputs, **how):
    """The refusal of a model, which names the output it was noticed at."""
    with pytest.raises(col.InputError) as caught:
        propagate(function, inputs, **{"method": "quasi_random", "seed": 1, **how})
    assert (caught.value.code, caught.value.fields["argument"]) == ("bad_model", "model")
    return caught.value


def seeded(v):
    return v + np.random.default_rng(0).normal(size=v.shape)


# Models that mix cases


@every_run
@pytest.mark.parametrize(
    "mixed",
    [
        lambda v: v - v.mean(),
        lambda v: v / v.max(),
        lambda v: v - v.min(),
        lambda v: v * v[0],
        lambda v: np.full_like(v, v.mean()),
        lambda v: np.full_like(v, v[0]),
        lambda v: np.full_like(v, v[-1] + v[0]),
        np.sort,
        np.cumsum,
        lambda v: np.roll(v, 1),
        lambda v: np.clip(v, *np.quantile(v, (0.2, 0.8))),
        lambda v: v > np.median(v),
        lambda v: v >= np.median(v),
        lambda v: v * (2.0 if v.max() > 20.0 else 1.0),
        lambda v: v * (2.0 if v.min() < 20.0 else 1.0),
        np.maximum.accumulate,
        lambda v: (v - v.mean()) * pint.Quantity(1.0, "m/s"),
        seeded,
    ],
)
def test_a_model_that_mixes_cases(mixed, inputs, how):
    """Refused by every method, on one thread and on two, with what to write instead."""
    found = refused(lambda v, k=0.0: {"dv": mixed(v)}, inputs, **how)
    assert found.fields["output"] == "dv"
    for words in (
        "mixes cases",
        "v = ",
        "Every case must be worked out by itself",
        "x.mean()",
        "numpy.where",
        "Random numbers",
    ):
        assert words in str(found)


@every_run
def test_a_model_that_is_random_in_itself(inputs, how):
    """Its answers to one and the same case differ, and what to write instead is said."""
    rng = np.random.default_rng(1)
    found = refused(lambda v, k=0.0: {"sure": v, "dv": v + rng.normal(size=v.shape)}, inputs, **how)
    assert found.fields["output"] == "dv"
    assert "Random numbers drawn in the model" in str(found)
    assert "an argument of its own, with its distribution" in str(found)


@pytest.mark.parametrize("method", METHODS[2:])
def test_mixed_far_out_only(method):
    """The greatest and the least answers are looked at."""
    refused(lambda v: {"dv": np.where(v > 24.0, 10.0 + v.mean(), v)}, V, method=method)
    refused(lambda v: {"dv": np.minimum(v, np.quantile(v, 0.99))}, V, method=method)
    refused(lambda v: {"fast": v > np.quantile(v, 0.99)}, V, method=method)


def test_the_case_is_named():
    """With the answer among others and the one alone, which for v - mean(v) is 0: of 41 places the
    last is 6 above the mean.
    """
    found = refused(lambda v: {"dv": v - v.mean()}, BETWEEN, method="interval")
    assert (
        "among 41 cases it answers 'dv' with 6 for v = 26, and with 0 for that case alone"
        in str(found)
    )


def test_one_refused_case_that_takes_all_answers_away():
    """A mean over cases one of which has no answer is none: mixed too, rather than a scene without
    an answer.
    """
    found = refused(
        lambda v: {"dv": v - np.where(v > 22.0, np.nan, v).mean()}, {"v": Uniform(10.0, 22.5)}
    )
    assert "with no answer for v = " in str(found)


def test_an_output_beside_others():
    """Each is looked at, and the one that is mixed named."""
    found = refused(lambda v: {"a": v, "b": -v, "c": v**2, "d": v - v.mean()}, V)
    assert found.fields["output"] == "d"


@pytest.mark.parametrize("seed", range(20))
def test_a_threshold_in_the_last_output(seed):
    """Both its sides are 0 or 1 whatever the company, so that cases from anywhere else may agree by
    chance.
    """
    both = {"v": Normal(20.0, 2.0), "w": Uniform(-1.0, 1.0)}
    found = refused(lambda v, w: {"a": v, "fast": w > w.mean()}, both, seed=seed, samples=256)
    assert found.fields["output"] == "fast"


def test_turns_that_are_counted_on_from_one_case_to_the_next():
    """numpy.unwrap adds whole turns by what the cases before had: two answers a turn apart are the
    same direction and no more.
    """
    found = refused(
        lambda v: {"course": np.unwrap(v) * pint.Quantity(1.0, "rad")}, {"v": Uniform(-3.1, 3.1)}
    )
    assert found.fields["output"] == "course"


@pytest.mark.parametrize(
    "bad",
    [np.gradient, lambda v: v + np.zeros(8192), lambda v: v * np.log(len(v) - 1) / (len(v) - 1)],
)
def test_a_model_that_fails_alone(bad):
    """Its own error is the cause, or what it answered is no single number."""
    found = refused(lambda v: {"dv": bad(v)}, V)
    assert "bad" not in str(found)
    assert "case" in str(found)


def test_what_a_single_case_raised_is_in_the_message():
    def fails(v):
        if len(v) == 1:
            raise ZeroDivisionError("mine.")
        return {"dv": v}

    found = refused(fails, V)
    assert isinstance(found.__cause__, ZeroDivisionError)
    assert (
        "among others, but not alone, as arrays of one number: ZeroDivisionError: mine. Every case"
        in str(found)
    )


def test_answers_whose_width_leaves_the_range_of_floats():
    """Then nothing is too small to be noticed beside it."""
    refused(lambda v: {"dv": 1.7e308 * np.sign(v - np.median(v))}, V)


# Models that do not


@pytest.mark.slow
@every_run
def test_answers_are_the_same_to_the_bit(inputs, how, monkeypatch):
    """As without the comparison: it draws nothing, and its cases are not counted."""

    def scene(v, k=0.5):
        a, b = col.Vehicle(mass=1500.0, vx=v), col.Vehicle(mass=1200.0, vx=12.0)
        impact = col.linear_central(a, b, k / 3.0, on_failure="nan")
        return {
            "delta_v": impact.b.q.delta_v,
            "course": np.arctan2(v - 20.0, 4.0 * k),
            "slow": v < 10.0,
        }

    def figures():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.OutOfRangeWarning)
            found = propagate(scene, inputs, seed=5, **how)
        values = [getattr(found[name], "values", np.zeros(0)).tobytes() for name in found]
        return (
            found.samples,
            found.failed,
            values,
            [(one.mean, one.std, one.interval()) for one in found.outputs.values()],
        )

    compared = figures()
    monkeypatch.setattr(model, "check_elementwise", lambda *of: True)
    assert figures() == compared


@pytest.mark.slow
@every_run
def test_few_cases_are_asked_again_once(inputs, how, monkeypatch):
    """In two calls, however many outputs that are least together, blocks, and places between
    bounds; the same on threads too.

    Places in rising order, as those along one interval are to begin with, tell nothing of a sort:
    there two more."""
    monkeypatch.setattr(sampling, "BLOCK", 500)
    compared, calls, asked, few = model.check_elementwise, [], [], []

    def comparing(answer, *of):
        def counted(cases, count):
            few.append(cases["v"].tobytes())
            calls.append(-count)
            return answer(cases, count)

        return compared(counted, *of)

    def honest(v, k=1.0):
        asked.append(len(v))
        return {name: v * k + i for i, name in enumerate("abcde")}

    def again():
        for one in (calls, asked, few):
            one.clear()
        found = propagate(honest, inputs, seed=5, **how)
        assert found.samples == sum(asked) + sum(calls)
        assert 2 <= len(few) <= (4 if inputs is BETWEEN else 2)
        return list(few)

    monkeypatch.setattr(model, "check_elementwise", comparing)
    assert again() == again()


def test_an_answer_without_the_axis_of_cases():
    """Of one case it may be a bare number, as numpy.squeeze makes it."""
    found = propagate(
        lambda v: {"y": np.stack([v, v]).T[:, :1].squeeze()}, V, method="monte_carlo", seed=1
    )["y"]
    assert found.mean == propagate(lambda v: {"y": v}, V, method="monte_carlo", seed=1)["y"].mean


def test_an_iteration_until_all_have_converged():
    """Alone it ends sooner: a little off from what it comes to among others, which no
    figure shows.
    """

    def root(v):
        x, step = v.copy(), np.ones(1)
        while np.max(np.abs(step)) > 1e-4:
            step = 0.5 * (v / x - x)
            x = x + step
        return {"y": x}

    among, alone = root(np.array([20.0, 1e6]))["y"][0], root(np.array([20.0]))["y"][0]
    assert 0.0 < abs(among - alone) < 1e-6
    found = propagate(root, {"v": Uniform(10.0, 1000.0)}, method="quasi_random", seed=1)["y"]
    # The mean of a root: 2/3 (b^1.5 - a^1.5)/(b - a); five standard errors of the run.
    truth = 2.0 / 3.0 * (1000.0**1.5 - 10.0**1.5) / 990.0
    assert abs(found.mean - truth) < 5.0 * found.mean_standard_error + 1e-8


def rounded(v):
    """The case among others as another path through numpy may have it: off by one rounding."""
    return v * (1.0 + np.finfo(float).eps) if len(v) > 8 else v


@pytest.mark.parametrize(
    "honest",
    [
        lambda v: rounded(v),
        lambda v: 1e9 + 1e-4 * rounded(v),
        # Directions that come out at either end of the turn.
        lambda v: np.where(v < 20.0, 3.0, math.pi if len(v) > 1 else -math.pi),
        lambda v: (
            np.where(v < 20.0, 3.0, math.pi if len(v) > 1 else -math.pi) * pint.Quantity(1.0, "rad")
        ),
    ],
)
def test_what_rounding_explains(honest):
    """Answered as without the comparison."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.OutOfRangeWarning)
        assert propagate(lambda v: {"y": honest(v)}, BETWEEN, method="interval")["y"].mean


@pytest.mark.parametrize(
    "honest",
    [
        lambda v: np.where(rounded(v) / 26.0 > 1.0, 0.0, v),
        lambda v: np.where(rounded(v) / 26.0 > 1.0, np.nan, v),
        lambda v: rounded(v) / 26.0 > 1.0,
    ],
)
def test_a_jump_that_the_last_bit_decides(honest):
    """The place at 26 is just beyond it among others and just before it alone, and a few roundings
    on it is beyond.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.OutOfRangeWarning)
        assert propagate(lambda v: {"y": honest(v)}, BETWEEN, method="interval")["y"]


def test_a_jump_that_moves_with_the_cases():
    """Beside it a case has the other answer among all cases, and never by itself."""
    refused(lambda v: {"y": v / v.mean() > 1.0}, BETWEEN, method="interval")
    refused(lambda v: {"y": np.where(v >= v.max(), np.nan, v)}, BETWEEN, method="interval")


def test_refused_cases():
    """NaN among others and alone, or an error where there was no answer among others either."""

    def solver(v):
        if len(v) == 1 and v[0] > 22.0:
            raise col.NoImpactError("apart")
        return {"y": np.where(v > 22.0, np.nan, v)}

    for function in (solver, lambda v: {"y": np.where(v > 22.0, np.nan, v)}):
        with pytest.warns(col.OutOfRangeWarning, match="no answer"):
            found = propagate(function, {"v": Uniform(18.0, 22.1)}, method="monte_carlo", seed=1)
        assert found.failed > 0
        assert found["y"].quantile(1.0) <= 22.0


def test_a_model_without_an_answer_anywhere():
    """Says so, as before."""
    with pytest.raises(col.NoSolutionError, match="any of 8192 cases"):
        propagate(lambda v: {"y": v * np.nan}, V, method="quasi_random", seed=1)


@pytest.mark.parametrize(
    "answer",
    [
        lambda v: 3.0,
        lambda v: v,
        lambda v: col.linear_central(col.Vehicle(mass=1.0, vx=v), col.Vehicle(mass=2.0), 0.5),
    ],
)
def test_no_dict(answer):
    """A float, an array and an impact are no named outputs, alone as among others."""
    assert "must return a dict of named outputs" in str(refused(answer, V))


def test_a_list_of_values():
    """Refused for Samples as for an array, in place of an error from within the model; a pair stays
    a fixed value.
    """
    for values in ([1.0, 2.0], np.array([1.0, 2.0])):
        with pytest.raises(
            col.ShapeError, match=r"v is an? (list|array) of .* given as Samples\(values\)"
        ) as caught:
            propagate(
                lambda v, x: {"y": v + x},
                {"v": values, "x": Normal(0.0, 1.0)},
                method="quasi_random",
            )
        assert caught.value.code == "bad_shape"
    found = propagate(
        lambda v, x: {"y": v[0] + x}, {"v": (1.0, 2.0), "x": Normal(0.0, 1.0)}, method="first_order"
    )
    assert found["y"].mean == 1.0


@pytest.mark.parametrize("method", METHODS[2:])
@pytest.mark.parametrize("seed", range(4))
def test_outliers_left_out_by_all_cases_together(method, seed):
    """Their tails would be cut in silence: one of the refused cases is asked alone, and has an
    answer.
    """

    def cut(v):
        return {"dv": np.where(abs(v - v.mean()) > 2.0 * v.std(), np.nan, v)}

    error = refused(cut, V, method=method, seed=seed, samples=2048)
    assert "no answer" in str(error)


def test_an_output_that_is_mostly_0_may_end_an_iteration_differently_too():
    """The middle half of its answers has no width by which to judge a difference of rounding."""

    def model(x):
        last = 1e-13 if np.size(x) > 10 else 0.0
        return {"y": np.where(x > 0.9, 0.1 * x + last, 0.0)}

    found = propagate(model, {"x": Uniform(0.0, 1.0)}, samples=256, seed=1)
    assert 0.0 < found["y"].mean < 0.1

    def mixing(x):
        return {"y": np.where(x > 0.9, 0.1 * x + 1e-3 * np.mean(x), 0.0)}

    with pytest.raises(col.InputError, match="mixes cases"):
        propagate(mixing, {"x": Uniform(0.0, 1.0)}, samples=256, seed=1)
