"""Arbitrary arguments to ``propagate``: an answer in full or a CollisionsError, nothing else."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

import collisions as col
from collisions.uncertainty import (
    Interval,
    LogNormal,
    Normal,
    Samples,
    Triangular,
    Uniform,
    propagate,
)
from project.test_fuzz import attempt, examples
from strategies import extreme, garbage, registries, texts

pytestmark = pytest.mark.slow

METHODS = (
    "first_order",
    "second_order",
    "latin_hypercube",
    "quasi_random",
    "monte_carlo",
    "interval",
)


def rear_end(speed: Any, restitution: Any, mass: Any) -> dict[str, Any]:
    """A real impact, which refuses what is no restitution, no mass and no impact, case by case."""
    a, b = col.Vehicle(mass=mass, vx=speed), col.Vehicle(mass=1200.0)
    impact = col.linear_central(a, b, restitution, on_failure="nan")
    return {
        "delta_v": impact.b.q.delta_v,
        "energy_loss": impact.energy_loss,
        "hit": impact.ok,
    }


def tame(speed: Any, restitution: Any, mass: Any) -> dict[str, Any]:
    """Takes whatever there is: floats, arrays and other objects."""
    count = next(
        (len(value) for value in (speed, restitution, mass) if isinstance(value, np.ndarray)), 1
    )
    parts = [
        np.broadcast_to(value, count) if isinstance(value, (float, np.ndarray)) else np.zeros(count)
        for value in (speed, restitution, mass)
    ]
    return {"sum": parts[0] + parts[1] * parts[2], "ratio": parts[0] / parts[2]}


def is_shown(value: Any) -> bool:
    """Whether the object itself can be written down."""
    try:
        return bool(repr(value))
    except Exception:
        return False


def answers(values: Any) -> Any:
    """A model that answers with this, whatever it is asked."""
    return lambda **inputs: values


@st.composite
def distributions(draw: Any, low: float, high: float) -> Any:
    """An input of any kind that lies about here."""
    ends = sorted(draw(st.tuples(st.floats(low, high), st.floats(low, high))))
    if not ends[1] - ends[0] > 1e-9 * abs(ends[1]) + 1e-12:
        return ends[0]
    middle = 0.5 * (ends[0] + ends[1])
    kinds = [
        lambda: Normal(middle, ends[1] - ends[0]),
        lambda: Normal(middle, ends[1] - ends[0], truncate=ends),
        lambda: Uniform(*ends),
        lambda: Triangular(ends[0], middle, ends[1]),
        lambda: LogNormal(abs(middle) + 0.1, ends[1] - ends[0]),
        lambda: Samples([*ends, middle]),
        lambda: Interval(*ends),
        lambda: middle,
    ]
    return draw(st.sampled_from(kinds))()


@st.composite
def calls(draw: Any) -> dict[str, Any]:
    """Arguments that are in order."""
    inputs = {
        "speed": draw(distributions(0.0, 30.0)),
        "restitution": draw(distributions(0.0, 1.0)),
        "mass": draw(distributions(800.0, 2000.0)),
    }
    found: dict[str, Any] = {
        "model": rear_end,
        "inputs": inputs,
        "method": draw(st.sampled_from(METHODS)),
        "seed": draw(st.integers(0, 2**70)),
    }
    if found["method"] in METHODS[2:5]:
        found["samples"] = draw(st.integers(64, 600))
        found["threads"] = draw(st.sampled_from((1, 2)))
    if draw(st.booleans()):
        found["correlation"] = {
            ("speed", "mass"): draw(st.floats(-1.0, 1.0)),
            ("mass", "restitution"): draw(st.floats(-1.0, 1.0)),
        }
    return found


def read_in_full(found: Any) -> None:
    """Every figure of an answer, as the refusals of it allow."""
    if isinstance(found, col.CollisionsError):
        return
    json.dumps(found.to_dict() if "interval" in found.method else _figures(found), allow_nan=False)
    assert "given the stated inputs" in attempt("repr", lambda: repr(found))
    assert 0 <= found.failed <= found.samples
    for name in found:
        output = found[name]
        low, high = output.interval(0.9)
        assert not low > high
        mean, std = output.mean, output.std
        if isinstance(mean, tuple):
            assert not mean[0] > mean[1]
            assert not std[0] < 0.0
        else:
            assert not std < 0.0
            assert math.isfinite(mean)
        attempt("quantile", lambda output=output: output.quantile([0.0, 0.25, 1.0]))
        attempt("error", lambda output=output: output.quantile_standard_error(0.5))
        attempt("histogram", lambda output=output: output.histogram(7))


def _figures(found: Any) -> Any:
    for name in found:
        attempt("contributions", lambda name=name: found[name].total_contributions)
    return attempt("record", found.to_dict)


@examples(2)
@given(calls())
def test_arguments_in_order(call: dict[str, Any]) -> None:
    """Answered, or refused because nothing in it is uncertain, has bounds, or can hold together."""
    found = attempt("propagate", lambda: propagate(**call))
    read_in_full(found)
    if isinstance(found, col.CollisionsError):
        assert found.code in {
            "nothing_uncertain",
            "unbounded",
            "bad_correlation",
            "all_failed",
            "no_derivative",
        }, found


@examples(3)
@given(calls(), st.data())
def test_one_argument_of_any_kind(call: dict[str, Any], data: Any) -> None:
    """Anything at all in place of one argument."""
    name = data.draw(
        st.sampled_from(
            (
                "model",
                "inputs",
                "method",
                "samples",
                "tolerance",
                "seed",
                "threads",
                "progress",
                "correlation",
            )
        )
    )
    given_value = data.draw(st.one_of(garbage(), texts(), extreme(), st.integers(-5, 10**5)))
    if (
        name == "threads"
        and isinstance(given_value, (int, np.integer))
        and not isinstance(given_value, bool)
    ):
        given_value = min(given_value, 4)
    if name == "tolerance":
        call.pop("samples", None)
        # What may be a tolerance is made so wide that the run ends.
        given_value = data.draw(
            st.one_of(
                st.just(given_value).filter(lambda value: not _is_narrow(value)), st.just(1e30)
            )
        )
    # What a callback of the caller raises is the caller's own.
    assume(name != "progress" or not callable(given_value))
    call[name] = given_value
    if name == "inputs" and isinstance(given_value, dict):
        call["model"] = lambda **inputs: {
            "y": np.zeros(next((len(v) for v in inputs.values() if isinstance(v, np.ndarray)), 1))
        }
    read_in_full(attempt(name, lambda: propagate(**call)))


def _is_narrow(value: Any) -> bool:
    """Whether a run to this tolerance could take minutes."""
    if isinstance(value, (dict, str)) or hasattr(value, "units"):
        return True
    try:
        return 0.0 < float(np.min(np.asarray(value, dtype=float))) < 1e6
    except Exception:
        return False


@examples(3)
@given(calls(), st.sampled_from(("speed", "restitution", "mass")), st.data())
def test_one_input_of_any_kind(call: dict[str, Any], name: str, data: Any) -> None:
    """Anything at all in place of one input: refused when arguments are read, or handed to the
    model as it is.
    """
    call["inputs"][name] = data.draw(st.one_of(garbage(), texts(), extreme()).filter(is_shown))
    call["model"] = tame
    read_in_full(attempt(name, lambda: propagate(**call)))


@examples(2)
@given(calls(), st.data())
def test_answers_of_any_kind(call: dict[str, Any], data: Any) -> None:
    """Whatever a model returns."""
    value = data.draw(
        st.one_of(
            garbage(),
            st.dictionaries(st.one_of(st.text(max_size=3), st.integers()), garbage(), max_size=2),
        )
    )
    call["model"] = answers(value)
    read_in_full(attempt("model", lambda: propagate(**call)))


@examples(2)
@example("latin_hypercube", -1e155, 1e155, 1e155, 0)
@example("second_order", 1e150, 1e155, 1e150, 0)
@given(st.sampled_from(METHODS), extreme(), extreme(), extreme(), st.integers(0, 3))
def test_numbers_of_any_size(
    method: str, middle: float, spread: float, factor: float, registry: int
) -> None:
    """From the least to the greatest float: answered or refused, and no figure that numpy had to
    warn of.
    """
    inputs = attempt(
        "Normal",
        lambda: Normal(middle, abs(spread), truncate=(-abs(middle) - 1e3, abs(middle) + 1e3)),
    )
    if isinstance(inputs, col.CollisionsError):
        return
    unit = registries()[registry].Unit("m/s")
    options = {"samples": 64, "seed": 1} if method in METHODS[2:5] else {}

    def model(x: Any) -> dict[str, Any]:
        return {"y": factor * x, "z": np.square(x) * unit}

    if registry != 2:
        read_in_full(
            attempt("propagate", lambda: propagate(model, {"x": inputs}, method=method, **options))
        )


@pytest.mark.parametrize("scale", [1e-300, 1e-150, 1e150, 1e300])
@pytest.mark.parametrize("method", METHODS[:5])
def test_the_ends_of_the_range(method: str, scale: float) -> None:
    """A straight model of enormous or tiny numbers, whose squares leave the range of floats, is
    answered right or refused.
    """
    found = attempt(
        "ends",
        lambda: propagate(
            lambda x: {"y": x},
            {"x": Normal(3.0 * scale, scale)},
            method=method,
            **({"seed": 1} if method in METHODS[2:] else {}),
        ),
    )
    assert not isinstance(found, col.CollisionsError)
    assert found["y"].std == pytest.approx(scale, rel=0.05)
