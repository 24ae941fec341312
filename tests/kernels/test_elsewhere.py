"""The kernels run on arrays of other libraries as they are; skipped where the extra "elsewhere" is
not installed.
"""

import doctest
import math
import tomllib
from pathlib import Path

import mpmath
import numpy as np
import pytest

import reference
from collisions.kernels.central import linear_central, oblique_approximation
from collisions.kernels.eccentric import eccentric
from collisions.kernels.problem import Body, Contact, Problem
from collisions.kernels.status import Answer
from engine.test_tracing import FREE, LAW_RULES, numbers, of_numbers, programs

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


@pytest.mark.slow
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


@pytest.mark.slow
def test_compiled_and_over_many_cases(jax):
    """``jit`` may contract a product and a sum, which moves the last digits; ``vmap`` of one case
    is a batch.
    """
    cases = np.abs(np.array(numbers(20, 200, np.float64, np.random.default_rng(3), False)))
    settings = ("friction", "brach")
    wanted = FREE(*cases, *settings)
    answered = wanted.status == 0
    assert answered.sum() > 20
    for solve in (
        jax.jit(lambda *x: FREE(*x, *settings)),
        jax.vmap(lambda *x: FREE(*x, *settings)),
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


@pytest.mark.slow
def test_derivatives(jax):
    """Of a linear impact in closed form; of an eccentric one as differences of the same kernel give
    them.
    """
    mass_a, mass_b, speed, e = 1500.0, 1200.0, 14.0, 0.2

    def delta_v(e, mass_a, speed):
        a, b = Body(mass_a, None, speed, 0.0, 0.0), Body(mass_b, None, 0.0, 0.0, 0.0)
        return linear_central(Problem(Contact(e, (1.0, 0.0)), a, b)).delta_vx_b

    share = mass_a / (mass_a + mass_b)
    wanted = share * speed, (1 + e) * speed * mass_b / (mass_a + mass_b) ** 2, (1 + e) * share
    np.testing.assert_allclose(jax.grad(delta_v, (0, 1, 2))(e, mass_a, speed), wanted, rtol=1e-13)
    settings = ("friction", "brach")
    body_a, body_b = (
        (1500.0, 2400.0, 14.0, 0.0, 0.0, -2.0, 0.4),
        (1200.0, 1700.0, 0.0, 11.0, 0.0, 0.8, -1.2),
    )
    scene = np.array([0.1, 1.0, 0.0, 0.5, 0.0, 0.0, *body_a, *body_b])
    for output in ("delta_yaw_rate_a", "energy_loss", "delta_vx_b"):
        slopes = np.asarray(
            jax.grad(lambda x, output=output: getattr(FREE(*x, *settings), output))(
                jax.numpy.asarray(scene)
            )
        )
        assert np.all(np.isfinite(slopes))
        for at in range(len(scene)):
            step = 1e-5 * max(1.0, abs(scene[at]))
            ends = [
                getattr(
                    FREE(*(scene + side * step * (np.arange(20) == at)).tolist(), *settings),
                    output,
                )
                for side in (-1.0, 1.0)
            ]
            # A central difference errs by its step squared and by rounding over its step.
            assert slopes[at] == pytest.approx(
                (ends[1] - ends[0]) / (2 * step), rel=1e-6, abs=1e-9 * abs(ends[0]) / step
            )


def scenes(rule, rng, count=40):
    """Numbers of a problem of free bodies [SI], one row each; a fifth against a barrier, a third
    without slip of the masses.
    """
    angle = rng.uniform(-np.pi, np.pi, count) * rng.choice([0.0, 1.0], count)
    value = {
        "friction": np.where(
            rng.random(count) < 0.3,
            rng.choice([0.0, 1.0, np.inf], count),
            rng.uniform(0.0, 2.0, count),
        ),
        "impulse_ratio": rng.uniform(-0.5, 0.5, count),
        "critical_fraction": rng.uniform(0.0, 0.99, count),
    }[rule]
    found = [
        rng.uniform(0.0, 1.0, count),
        np.cos(angle),
        np.sin(angle),
        value,
        np.zeros(count),
        np.zeros(count),
    ]
    for sign in (-1.0, 1.0):
        mass = rng.uniform(800.0, 2500.0, count)
        fixed = (rng.random(count) < 0.2) & (sign > 0.0)
        ahead, left = sign * rng.uniform(0.5, 2.2, count), rng.uniform(-1.0, 1.0, count)
        along, across = (
            -sign * rng.uniform(2.0, 14.0, count),
            rng.uniform(-9.0, 9.0, count) * rng.choice([0.0, 1.0, 1.0], count),
        )
        turned = [
            (u * found[1] - v * found[2], u * found[2] + v * found[1])
            for u, v in ((along, across), (ahead, left))
        ]
        inertia = np.where(fixed, np.inf, mass * rng.uniform(0.3, 2.0, count))
        spin = rng.uniform(-2.0, 2.0, count) * rng.choice([0.0, 1.0], count)
        found += [
            np.where(fixed, np.inf, mass),
            inertia,
            *turned[0],
            spin,
            *turned[1],
        ]
    return np.array(found).T


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rule", "law"),
    [
        ("friction", "brach"),
        ("friction", "stronge"),
        *(
            pytest.param(rule, law, marks=pytest.mark.slow)
            for rule, law in LAW_RULES
            if (rule, law) not in (("friction", "brach"), ("friction", "stronge"))
        ),
    ],
)
@pytest.mark.parametrize("central", [False, True])
def test_every_derivative_of_an_answer_is_that_of_the_answer(jax, rule, law, central):
    """Of all outputs by all inputs, infinite friction and barriers among them, against differences
    of the kernel of floats.

    Differences are taken where the cases on both sides slide or stick alike, off the kinks.
    """
    cases = scenes(rule, np.random.default_rng(5))
    kernel, settings = of_numbers(oblique_approximation) if central else FREE, (rule, law)
    if central:
        cases = cases[:, [0, 1, 2, 3, 6, 8, 9, 10, 13, 15, 16, 17]]
    names = [name for name in Answer._fields if name not in ("status", "sticks")]

    def outputs(x):
        answer = kernel(*x, *settings)
        return jax.numpy.stack([jax.numpy.asarray(getattr(answer, name), float) for name in names])

    with np.errstate(all="ignore"):
        answered = np.broadcast_to(kernel(*cases.T, *settings).status, len(cases)) == 0
    cases = cases[answered]
    assert len(cases) > 20
    compared = 0
    for derivative in (jax.jacfwd, jax.jacrev):
        found = np.asarray(jax.vmap(derivative(outputs))(jax.numpy.asarray(cases)))
        assert np.all(np.isfinite(found))
    for case, slopes in zip(cases[:6], found, strict=False):
        middle = kernel(*case.tolist(), *settings)
        for at in np.flatnonzero(np.isfinite(case)):
            step = 1e-6 * max(1.0, abs(case[at]))
            beside = [
                kernel(*(case + side * step * (np.arange(len(case)) == at)).tolist(), *settings)
                for side in (-1.0, 1.0)
            ]
            kinds = {
                (one.status, one.sticks, one.tangential_impulse > 0.0, one.slip_after > 0.0)
                for one in (middle, *beside)
            }
            if len(kinds) > 1 or 0.0 in (case[at], middle.slip_before):
                continue
            for name, slope in zip(names, slopes[:, at], strict=True):
                ends = [getattr(one, name) for one in beside]
                if np.isfinite(ends).all():
                    size = max(map(abs, ends))
                    wanted = pytest.approx(
                        (ends[1] - ends[0]) / (2 * step), rel=1e-4, abs=1e-8 * size / step + 1e-9
                    )
                    assert slope == wanted, (name, at, case)
                    compared += 1
    assert compared > 250


@pytest.mark.slow
def test_a_contact_that_starts_without_slip_has_the_derivative_by_it(jax):
    """Sticking, "stronge" goes smoothly through a slip of 0."""
    contact = Contact(0.3, (1.0, 0.0), 0.9, (0.0, 0.0))
    a = Body(1500.0, 2400.0, 14.0, 0.0, 0.0, -2.0, 0.4)
    b = Body(1200.0, 1700.0, 0.0, 0.0, 0.0, 0.8, -0.2)

    def solve(vy_b):
        return eccentric(Problem(contact, a, b._replace(vy=vy_b)), "friction", "stronge")

    assert solve(0.0).slip_before == 0.0
    assert solve(0.0).sticks
    for output in ("delta_vy_b", "normal_impulse", "energy_loss"):
        ends = [getattr(solve(side * 1e-4), output) for side in (-1.0, 1.0)]
        slope = float(jax.grad(lambda vy, output=output: getattr(solve(vy), output))(0.0))
        assert slope == pytest.approx((ends[1] - ends[0]) / 2e-4, rel=1e-4)


@pytest.mark.slow
def test_friction_from_zero_on_has_the_derivative_of_a_slip_that_turns_round(jax):
    """The levers turn the slip round without friction as well as with a little."""
    a = Body(1459.0, 3026.0, 21.6, -1.7, 0.4, -2.0, 0.15)
    b = Body(1195.0, 2683.0, 0.0, -2.9, -1.0, 2.0, 0.0)

    def solve(friction):
        contact = Contact(0.91, (1.0, 0.0), friction, (-0.28, -0.38))
        return eccentric(Problem(contact, a, b), "friction", "stronge")

    assert solve(0.0).slip_before > 0.0 > solve(0.0).slip_after
    for output in ("normal_impulse", "tangential_impulse", "energy_loss"):
        difference = (getattr(solve(1e-7), output) - getattr(solve(0.0), output)) / 1e-7
        slope = float(
            jax.grad(lambda friction, output=output: getattr(solve(friction), output))(0.0)
        )
        assert slope == pytest.approx(difference, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("law", ["brach", "kudlich-slibar", "stronge"])
def test_without_friction_the_energy_lost_has_its_derivative(jax, law):
    a = Body(1500.0, 2400.0, 13.9, 0.0, 0.0, -2.0, 0.4)
    b = Body(1200.0, 1700.0, 0.0, 11.1, 0.0, 0.8, -1.2)

    def lost(friction):
        contact = Contact(0.1, (1.0, 0.0), friction, (0.0, 0.0))
        return eccentric(Problem(contact, a, b), "friction", law).energy_loss

    assert float(jax.grad(lost)(0.0)) == pytest.approx((lost(1e-6) - lost(0.0)) / 1e-6, rel=1e-5)


# Outputs, by their names in the reference.
EXACT = {
    "closing_speed": "closing", "slip_before": "slip", "slip_after": "slip_after",
    "normal_impulse": "pn", "tangential_impulse": "pt", "energy_loss": "loss",
    "energy_loss_normal": "loss_n", "energy_loss_tangential": "loss_t",
    "delta_vx_a": "a.dvx", "delta_vy_a": "a.dvy", "delta_yaw_rate_a": "a.dw",
    "delta_vx_b": "b.dvx", "delta_vy_b": "b.dvy", "delta_yaw_rate_b": "b.dw",
}  # fmt: skip


def exact_scene(kind, friction, law, rng):
    """Restitution, angle of the normal, friction, point and both bodies, in numbers of few digits:
    a slip or a coupling of 0 is one to the bit.
    """

    def number(low, high):
        return float(round(64.0 * rng.uniform(low, high))) / 64.0

    in_line, at_rest = kind in ("in line", "without coupling"), kind in ("in line", "without slip")
    across = number(-5.0, 5.0) * rng.choice([0.0, 1.0])
    found = [number(0.1, 0.9), 0.0, friction, 0.0, 0.0]
    if law == "stronge" and rng.random() < 0.3:
        found[0] *= -1.0
    for ahead, speed in ((-2.0, number(4.0, 15.0)), (1.5, number(-9.0, 2.0))):
        sideways = across if at_rest else number(-8.0, 8.0)
        spin = 0.0 if at_rest else number(-1.0, 1.0)
        left = 0.0 if in_line else number(-0.8, 0.8)
        found += [number(800.0, 2500.0), number(900.0, 4000.0), speed, sideways, spin, ahead, left]
    return found


def in_sixty_digits(numbers, law):
    """The outputs of such a scene by the reference."""
    a, b = (reference.Body(*numbers[at : at + 7]) for at in (5, 12))
    normal, point = mpmath.mp.cos_sin(numbers[1]), (numbers[3], numbers[4])
    scene = reference.Scene(a, b, numbers[0], normal, point, "friction", numbers[2], law)
    answer = reference.evaluate(scene)
    assert answer.refused is None
    found = []
    for path in EXACT.values():
        label, _, name = path.rpartition(".")
        found.append(getattr(getattr(answer, label) if label else answer, name))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["in line", "without slip", "without coupling"])
@pytest.mark.parametrize("law", ["brach", "kudlich-slibar", "stronge"])
def test_without_friction_without_slip_or_in_line_every_derivative_is_one(jax, law, kind):
    """All outputs by all inputs, against quotients of the reference on both sides: of an answer
    that is smooth there the derivative is that of both, at a kink that of one.
    """
    rng = np.random.default_rng(len(kind))
    frictions = (0.0, 0.0, 0.0, 0.25, 0.5, math.inf)
    cases = [exact_scene(kind, friction, law, rng) for friction in frictions for _ in range(2)]

    def outputs(x):
        normal = jax.numpy.cos(x[1]), jax.numpy.sin(x[1])
        contact = Contact(x[0], normal, x[2], (x[3], x[4]))
        answer = eccentric(Problem(contact, Body(*x[5:12]), Body(*x[12:19])), "friction", law)
        found = [getattr(answer, name) for name in ("status", "slip_before", "coupling", *EXACT)]
        return jax.numpy.stack([jax.numpy.asarray(one, float) for one in found])

    numbers = jax.numpy.asarray(cases)
    status, slip, coupling, *_ = np.asarray(jax.vmap(outputs)(numbers)).T
    assert not status.any()
    assert (not slip.any()) == (kind != "without coupling")
    assert (not coupling.any()) == (kind != "without slip")
    slopes = np.asarray(jax.vmap(jax.jacfwd(outputs))(numbers))[:, 3:]
    assert np.all(np.isfinite(slopes))
    step = mpmath.mpf(10) ** -25
    with mpmath.workdps(60):
        for case, found in zip(cases, slopes, strict=True):
            exact = [mpmath.mpf(number) for number in case]
            middle = in_sixty_digits(exact, law)
            for at in np.flatnonzero(np.isfinite(case)):
                # There is no friction below 0.
                sides = (1,) if at == 2 and case[at] == 0.0 else (1, -1)
                quotients = [
                    [
                        float((beside - here) / (side * step))
                        for beside, here in zip(
                            in_sixty_digits(
                                [one + side * step * (i == at) for i, one in enumerate(exact)], law
                            ),
                            middle,
                            strict=True,
                        )
                    ]
                    for side in sides
                ]
                for name, value, slope, *wanted in zip(
                    EXACT, middle, found[:, at], *quotients, strict=True
                ):
                    # Rounding of the kernel: of terms that may cancel in the derivative.
                    scale = 1e-9 * max(map(abs, wanted)) + 1e-12 * abs(float(value)) + 1e-9
                    kink = max(wanted) - min(wanted) > scale
                    apart = [abs(slope - one) for one in wanted]
                    assert (min(apart) if kink else max(apart)) <= scale, (name, at, case)
                    # Nothing but a friction that cannot hold the slip has a kink here.
                    assert not kink or (law == "stronge" and kind == "without slip" and case[2])


def test_the_extra_installs_what_is_tried_here():
    """And the page names it."""
    project = PAGE.parents[1] / "pyproject.toml"
    if not project.is_file():
        pytest.skip("only where the project file is")
    extras = tomllib.loads(project.read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    assert [need.partition(">=")[0] for need in extras["elsewhere"]] == ["jax", "array-api-strict"]
    assert "collisions[elsewhere]" in PAGE.read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_page_shows_what_comes_out(jax):
    """Its code is run here, because the pages are built without JAX."""
    found = doctest.testfile(str(PAGE), module_relative=False, encoding="utf-8")
    assert (found.failed, found.attempted > 5) == (0, True)
