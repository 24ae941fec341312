"""The kernels run on arrays of other libraries as they are; skipped where those are not
installed.
"""

import doctest
from pathlib import Path

import numpy as np
import pytest

from collisions.kernels.central import linear_central
from collisions.kernels.eccentric import eccentric
from collisions.kernels.status import Answer
from engine.test_tracing import numbers, programs

PAGE = Path(__file__).parents[2] / "docs" / "kernels_elsewhere.md"
KERNELS = [
    one
    if "friction brach (False, False)" in one.id
    else pytest.param(*one.values, id=one.id, marks=pytest.mark.slow)
    for one in programs()
]


@pytest.fixture
def jax():
    """JAX in double precision."""
    found = pytest.importorskip("jax")
    found.config.update("jax_enable_x64", True)
    return found


def same(found, wanted):
    """To the bit, NaN and all."""
    for name, one, other in zip(Answer._fields, found, wanted, strict=True):
        one = np.asarray(one, dtype=float)
        np.testing.assert_array_equal(
            one, np.broadcast_to(np.asarray(other, dtype=float), one.shape), err_msg=name
        )


@pytest.mark.parametrize("library", ["jax", "array_api_strict"])
@pytest.mark.parametrize(("kernel", "settings", "count"), KERNELS)
def test_the_bits_are_those_of_numpy(kernel, settings, count, library, request):
    """Operation by operation. JAX takes numbers below the normal range for 0, so it gets no
    impossible values.
    """
    asarray = (
        request.getfixturevalue("jax").numpy.asarray
        if library == "jax"
        else pytest.importorskip(library).asarray
    )
    for odd in (False,) if library == "jax" else (False, True):
        cases = numbers(count, 100, np.float64, np.random.default_rng(count), odd)
        with np.errstate(all="ignore"):
            same(kernel(*map(asarray, cases), *settings), kernel(*cases, *settings))


def test_compiled_and_over_many_cases(jax):
    """``jit`` may contract a product and a sum, which moves the last digits; ``vmap`` of one case
    is a batch.
    """
    cases = np.abs(np.array(numbers(24, 200, np.float64, np.random.default_rng(3), False)))
    settings = ("friction", "brach", False, False)
    wanted = eccentric(*cases, *settings)
    answered = wanted.status == 0
    assert answered.sum() > 20
    for solve in (
        jax.jit(lambda *x: eccentric(*x, *settings)),
        jax.vmap(lambda *x: eccentric(*x, *settings)),
    ):
        for one, other in zip(solve(*cases), wanted, strict=True):
            scale = (
                np.max(np.abs(np.asarray(other)[answered]), initial=0.0) if np.ndim(other) else 1.0
            )
            # Levers that nearly cancel cost a factor of 100 or so of the rounding.
            np.testing.assert_allclose(
                *(
                    np.broadcast_to(np.asarray(each), answered.shape)[answered]
                    for each in (one, other)
                ),
                rtol=1e-12,
                atol=1e-13 * scale,
            )


def test_derivatives(jax):
    """Of a linear impact in closed form; of an eccentric one as differences of the same kernel give
    them.
    """
    mass_a, mass_b, speed, e = 1500.0, 1200.0, 14.0, 0.2

    def delta_v(e, mass_a, speed):
        return linear_central(
            e, 1.0, 0.0, mass_a, speed, 0.0, 0.0, mass_b, 0.0, 0.0, 0.0, False
        ).delta_vx_b

    share = mass_a / (mass_a + mass_b)
    wanted = share * speed, (1 + e) * speed * mass_b / (mass_a + mass_b) ** 2, (1 + e) * share
    np.testing.assert_allclose(jax.grad(delta_v, (0, 1, 2))(e, mass_a, speed), wanted, rtol=1e-13)
    settings = ("friction", "brach", False, False)
    body_a, body_b = (
        (1500.0, 2400.0, 14.0, 0.0, 0.0, -2.0, 0.4, 0.0, 0.0),
        (1200.0, 1700.0, 0.0, 11.0, 0.0, 0.8, -1.2, 0.0, 0.0),
    )
    scene = np.array([0.1, 1.0, 0.0, 0.5, 0.0, 0.0, *body_a, *body_b])
    for output in ("delta_yaw_rate_a", "energy_loss", "delta_vx_b"):
        slopes = np.asarray(
            jax.grad(lambda x, output=output: getattr(eccentric(*x, *settings), output))(
                jax.numpy.asarray(scene)
            )
        )
        assert np.all(np.isfinite(slopes))
        for at in range(len(scene)):
            step = 1e-5 * max(1.0, abs(scene[at]))
            ends = [
                getattr(
                    eccentric(*(scene + side * step * (np.arange(24) == at)).tolist(), *settings),
                    output,
                )
                for side in (-1.0, 1.0)
            ]
            # A central difference errs by its step squared and by rounding over its step.
            assert slopes[at] == pytest.approx(
                (ends[1] - ends[0]) / (2 * step), rel=1e-6, abs=1e-9 * abs(ends[0]) / step
            )


def test_the_page_shows_what_comes_out(jax):
    """Its code is run here, because the pages are built without JAX."""
    found = doctest.testfile(str(PAGE), module_relative=False, encoding="utf-8")
    assert (found.failed, found.attempted > 5) == (0, True)
