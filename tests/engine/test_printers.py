"""One recording, three printers: numpy calls, plain Python and JavaScript give the bits of the
kernel.
"""

import ast
from pathlib import Path

import numpy as np
import pytest

import collisions
from collisions.engine.floats import compile_for_floats
from collisions.engine.javascript import javascript
from collisions.kernels.status import Status
from engine.test_tracing import numbers, programs
from javascript import answers

KERNELS = Path(collisions.__file__).parent / "engine"


@pytest.mark.parametrize(
    ("kernel", "settings", "count"),
    [
        one
        if "friction brach (False, False)" in one.id
        else pytest.param(*one.values, id=one.id, marks=pytest.mark.slow)
        for one in programs()
    ],
)
def test_javascript_and_python_give_the_bits_of_the_kernel(kernel, settings, count):
    """Ordinary and impossible values, every model, rule, law and pivot; the numpy calls are tested
    in test_tracing.
    """
    rng = np.random.default_rng(count)
    cases = np.concatenate(
        [np.column_stack(numbers(count, 150, np.float64, rng, odd)) for odd in (False, True)]
    )
    if settings[:1] == ("friction",):
        cases[:100, 3] = abs(cases[:100, 3])
    with np.errstate(all="ignore"):
        raw = kernel(*cases.T, *settings)
        wanted = np.column_stack(
            [np.broadcast_to(np.asarray(part, dtype=np.float64), len(cases)) for part in raw]
        )
    printed = javascript(lambda *x: kernel(*x, *settings)._asdict(), count)
    found = answers(printed, cases)
    np.testing.assert_array_equal(found, wanted)
    real = wanted == wanted
    np.testing.assert_array_equal(np.signbit(found[real]), np.signbit(wanted[real]))
    alone = compile_for_floats(kernel, tuple(f"[{which}]" for which in range(count)), settings)
    answered = 0
    for case, row in zip(cases.tolist(), wanted, strict=True):
        one = alone(case)
        if one is not None:
            answered += 1
            assert row[0] == Status.OK
            np.testing.assert_array_equal(np.array(one, dtype=float), row)
    assert answered > 0 or not np.any(wanted[:, 0] == Status.OK)


def test_what_has_no_pattern_is_refused():
    """By its name; nothing is left out in silence."""
    with pytest.raises(TypeError, match="wrong uses tan, which cannot be written as a text"):
        javascript(wrong, 1)


def wrong(x):
    """Uses what no kernel may."""
    return {"y": np.tan(x)}


@pytest.mark.slow
def test_functions_and_constants():
    """The few functions that kernels do not use and pages do; constants of every kind; NaN is
    passed over by the larger.
    """
    rows = np.array(
        [
            [x, y]
            for x in (-7.5, -0.0, 0.0, 2.25, 1e300, np.inf, np.nan)
            for y in (-4.0, 4.0, 0.5, 360.0, np.inf)
        ]
    )

    def outputs(x, y):
        return {
            "fmod": np.fmod(x, y), "rest": x % y, "floor": np.floor(x), "fmax": np.fmax(x, y),
            "not": (x > y) ^ True, "xor": (x > y) ^ (y > 1.0),
            "negative": -x, "zero": x * -0.0, "inf": x + np.inf,
            "minus": np.where(x > 0.0, x, -np.inf), "nan": np.where(x > 0.0, np.nan, y),
            "root": abs(x) ** 0.5,
        }  # fmt: skip

    with np.errstate(all="ignore"):
        wanted = np.column_stack(
            [np.asarray(one, dtype=float) for one in outputs(*rows.T).values()]
        )
        exact = rows[:, 1] != np.inf
        found = answers(javascript(outputs, 2), rows)
    np.testing.assert_array_equal(found[exact], wanted[exact])

    def angles(x, y):
        return {
            "cos": np.cos(x),
            "sin": np.sin(x),
            "hypot": np.hypot(x, y),
            "atan2": np.arctan2(x, y),
        }

    rows = np.random.default_rng(1).uniform(-9.0, 9.0, (200, 2))
    wanted = np.column_stack([*angles(*rows.T).values()])
    # The functions of a browser are good to an ulp or two, and are not the same bits everywhere.
    np.testing.assert_allclose(answers(javascript(angles, 2), rows), wanted, rtol=1e-15, atol=3e-16)


@pytest.mark.parametrize("name", ["replay", "floats", "javascript"])
def test_each_printer_is_short(name):
    """Under a hundred lines of code: what is common is on the tape."""
    tree = ast.parse((KERNELS / f"{name}.py").read_text(encoding="utf-8"))
    said = [
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    ]
    words = {row for node in said for row in range(node.lineno, node.end_lineno + 1)}
    code = {
        row
        for node in ast.walk(tree)
        if hasattr(node, "lineno")
        for row in (node.lineno, node.end_lineno)
    }
    assert len(code - words) < 100
