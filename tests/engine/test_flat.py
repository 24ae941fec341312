"""The kernels printed as plain functions of floats give the bits of the kernels, or leave the case
to them.
"""

import itertools
import math
import random

import numpy as np
import pytest

import collisions as col
from collisions.impact import run
from collisions.impact.inputs import Inputs
from collisions.impact.models import (
    CANDIDATES,
    ECCENTRIC,
    LINEAR,
    OBLIQUE,
    float_function,
    variant_of,
)
from collisions.kernels.contact_laws import LAWS, RULES
from collisions.kernels.status import Status
from scenes import FAMILIES, draw, solved

SETTINGS = [
    pytest.param(model, rule, law, pinned, id=f"{model.kernel.__name__} {rule} {law} {pinned}")
    for model, rule, law, pinned in itertools.product(
        (LINEAR, OBLIQUE, *CANDIDATES), RULES, LAWS, ("", "a", "ab")
    )
    if (rule == "friction" or not LAWS[law].followed)
    and (
        model is ECCENTRIC
        or (model.name == OBLIQUE.name and not pinned)
        or (rule, law, pinned) == ("friction", "brach", "")
    )
]
VALUES = {
    "friction": (0.0, 0.3, 2.0, math.inf),
    "impulse_ratio": (-0.4, 0.0, 0.3),
    "critical_fraction": (0.0, 0.5, 1.0),
}
ODD = (0.0, -0.0, 5e-324, 1e-160, 1e160, 1.7e308, math.inf)


def bits(value):
    """What two floats must share to be the same, the sign of a 0 and NaN included."""
    return np.float64(value).tobytes() if isinstance(value, float) else value


def drawn(rng, rule, law, pinned, odd):
    """Inputs at random: cars that meet, of any mass ratio, and with ``odd`` now and then a number
    that no car has.
    """

    def body(sign, free):
        mass = rng.uniform(500.0, 3000.0) * 10.0 ** rng.choice([0.0, 0.0, -9.0, 9.0])
        found = {
            "mass": mass,
            "yaw_inertia": mass * rng.uniform(0.8, 2.5),
            "x": -sign * rng.uniform(0.5, 2.5),
            "y": rng.normal(),
            "yaw_rate": rng.choice([0.0, rng.normal()]),
        }
        if free:
            found |= {
                "vx": sign * rng.uniform(-5.0, 25.0),
                "vy": rng.choice([0.0, rng.normal(0.0, 4.0)]),
            }
        if odd and rng.random() < 0.3:
            # A large bare yaw rate is warned of.
            names = [
                name
                for name in found
                if name != "yaw_rate" and (free or name not in ("mass", "yaw_inertia"))
            ]
            name = str(rng.choice(names))
            value = float(rng.choice(ODD))
            if math.isfinite(value) or name in ("mass", "yaw_inertia"):
                found[name] = max(value, 5e-324) if name in ("mass", "yaw_inertia") else value
        pivot = {} if free else {"pivot": (float(rng.normal()), float(rng.normal(2.0)))}
        return {name: float(value) for name, value in found.items()} | pivot

    a, b = (body(sign, label not in pinned) for sign, label in ((1.0, "a"), (-1.0, "b")))
    angle = float(rng.choice([0.0, rng.normal(0.0, 0.8)]))
    return Inputs(
        "eccentric", col.Vehicle(**a), col.Vehicle(**b),
        float(rng.choice([0.0, rng.random(), 1.0])),
        (math.cos(angle), math.sin(angle)), rule, float(rng.choice(VALUES[rule])), law,
        (float(rng.normal(0.0, 0.5)), float(rng.normal(0.0, 0.5))),
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("model", "rule", "law", "pinned"), SETTINGS)
def test_the_bits_are_those_of_the_kernel(model, rule, law, pinned):
    """Cars, extreme ratios and odd numbers; what the function leaves to the kernel is never a plain
    answer.
    """
    rng = np.random.default_rng(
        [7, len(rule), len(law), len(pinned), model not in (LINEAR, OBLIQUE, ECCENTRIC)]
    )
    answered = left = 0
    for number in range(300):
        try:
            inputs = drawn(rng, rule, law, pinned, odd=number % 2)
        except col.InputError:
            continue
        wanted = model.answer(inputs)
        found = float_function(model, *variant_of(inputs))(vars(inputs))
        if found is None:
            left += 1
            # A division by zero is left too, and of an infinite friction nothing but that.
            assert wanted.status != Status.OK or number % 2 or math.isinf(inputs.rule_value), inputs
        else:
            answered += 1
            assert wanted.status == Status.OK
            assert type(found) is type(wanted)
            assert [bits(value) for value in found] == [bits(value) for value in wanted], inputs
    assert answered > 10
    assert left > 10


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_extreme_scenes_answer_alike(family, monkeypatch):
    """The families of the promises through the solver, with the flat functions and without."""
    scenes = [
        draw(family, law, rule, random.Random(f"{family}{law}{rule}{i}"))
        for law in LAWS
        for rule in RULES
        for i in range(40)
        if rule == "friction" or not LAWS[law].followed
    ]
    found = [attempted(scene) for scene in scenes]
    monkeypatch.setattr(run, "float_function", lambda *_, **_options: lambda inputs: None)
    wanted = [attempted(scene) for scene in scenes]
    assert sum(isinstance(one, col.Impact) for one in found) > len(scenes) // 3
    for one, other in zip(found, wanted, strict=True):
        if isinstance(other, col.Impact):
            assert [bits(value) for value in one._answer] == [
                bits(value) for value in other._answer
            ]
        else:
            assert one == other


def attempted(scene):
    """The answer, or the text of the refusal."""
    try:
        return solved("eccentric", scene)
    except col.CollisionsError as error:
        return str(error)


def test_a_function_is_made_once():
    """For its kernel, law, rule and constraints; the value of a friction is not one of them."""
    a = col.Vehicle(mass=1500.0, vx=15.0, yaw_inertia=2400.0, x=-2.0, y=0.4)
    b = col.Vehicle(mass=1200.0, yaw_inertia=1800.0, x=2.0, y=0.0)
    contact = {"normal": 0.0, "point": (0.0, 0.1)}
    col.eccentric(a, b, 0.1, **contact, friction=0.5)
    made = float_function.cache_info().misses
    for friction in (0.0, 0.25, 0.75):
        col.eccentric(a, b, friction, **contact, friction=friction)
    assert float_function.cache_info().misses == made
    col.eccentric(a, b, 0.1, **contact, friction=0.5, law="kudlich-slibar")
    assert float_function.cache_info().misses <= made + 1
