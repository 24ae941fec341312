"""A refused single case is answered by the compiled kernel as by the kernel itself."""

import math

import numpy as np
import pytest

import collisions as col
from collisions.impact.inputs import read_inputs
from collisions.impact.models import BY_NAME, float_function, variant_of
from collisions.kernels.status import Answer, Status

# What the error of a refused case says of its answer; the other outputs become NaN.
SAID = {
    Status.SEPARATING: ("closing_speed",),
    Status.GRAZING: ("closing_speed",),
    Status.RATIO_JAMS: ("coupling", "effective_mass"),
}
LIMITS = {"friction": (0.0, 1.0), "impulse_ratio": (-3.0, 3.0), "critical_fraction": (0.0, 1.0)}


def cases(rule, law, count):
    """Inputs of all kinds: parting, grazing, pinned bodies, numbers near the limits."""
    rng = np.random.default_rng(38)

    def one(low, high, *others):
        return float(rng.choice([*rng.uniform(low, high, 3), *others]))

    def body():
        found = {"mass": one(500.0, 2000.0, math.inf), "yaw_inertia": one(500.0, 3000.0, math.inf)}
        found |= {"x": one(-2.0, 2.0, 0.0), "y": one(-1.0, 1.0, 0.0)}
        found |= {"yaw_rate": one(-1.0, 1.0, 0.0)}
        if rng.random() < 0.2 and math.isfinite(found["mass"] + found["yaw_inertia"]):
            return found | {"pivot": (one(-1.0, 1.0), 0.0)}
        return found | {"vx": one(-20.0, 20.0, 0.0, 1e308), "vy": one(-5.0, 5.0, 0.0)}

    for _ in range(count):
        values = tuple(one(*limits) if name == rule else None for name, limits in LIMITS.items())
        point = one(-1.0, 1.0, 0.0), one(-1.0, 1.0, 0.0)
        bodies = col.Vehicle(**body()), col.Vehicle(**body())
        contact = one(0.0, 1.0, 0.0, 1.0), one(-3.0, 3.0, 0.0), point
        yield read_inputs("eccentric", (*bodies, *contact, values, law))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rule", "law"),
    [
        *((rule, "brach") for rule in LIMITS),
        ("friction", "kudlich-slibar"),
        ("friction", "stronge"),
    ],
)
def test_refused_cases_are_the_kernels_own(rule, law):
    model, met = BY_NAME["eccentric"], set()
    for inputs in cases(rule, law, 1500):
        by_kernel = model.answer(inputs)
        found = float_function(model, *variant_of(inputs), refused=True)(vars(inputs))
        if found is None:
            continue
        assert found.status is by_kernel.status
        met.add(found.status)
        answered = found.status <= Status.ENERGY_GAIN
        for name in Answer._fields if answered else SAID.get(found.status, ()):
            assert repr(getattr(found, name)) == repr(getattr(by_kernel, name)), name
    assert met >= {Status.OK, Status.SEPARATING, Status.GRAZING}
