"""What is added to the tables of laws, rules, domains and kernels is used as it says, or refused:
never taken for another.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

import collisions as col
from collisions.engine.floats import compile_for_floats
from collisions.impact import run
from collisions.kernels.contact_laws import BRACH, KUDLICH_SLIBAR, LAWS, STRONGE, Law
from collisions.kernels.elementwise import Domain
from collisions.kernels.status import Answer, Status
from collisions.quantities.reading import ArgumentReader

A = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, x=-2.0, y=0.4, vx=14.0, vy=3.0, yaw_rate=0.2)
B = col.Vehicle(mass=1200.0, yaw_inertia=1800.0, x=2.0, y=0.0, vy=-6.0)
CONTACT = {"normal": 0.1, "point": (0.0, 0.1)}


def law(name, sticking_slip):
    """A law with this slip after sticking."""
    return Law(
        name,
        sticking_slip,
        no_slip="what is tried",
        derivation="what is tried",
        assumption="what is tried",
    )


@pytest.fixture
def half(monkeypatch):
    """A third law: half of the slip comes back."""
    monkeypatch.setitem(LAWS, "half", law("half", lambda restitution: -(0.5 * restitution)))
    return "half"


@pytest.mark.parametrize(
    ("sticking_slip", "is_limit"),
    [
        (lambda e: -e, True),
        (lambda e: 0.5 * e - 1.5 * e, False),  # -e to rounding only
        (lambda e: -0.5 * e, False),
        (lambda e: e, False),
        (lambda e: 0.0, False),
        (lambda e: -e * e, False),
    ],
)
def test_the_energy_form_follows_from_the_slip(sticking_slip, is_limit):
    """A law cannot say of itself that it has a compression limit."""
    assert law("tried", sticking_slip).compression_limit is is_limit


@pytest.mark.parametrize("friction", [0.1, 5.0])
@pytest.mark.parametrize("solver", [col.oblique_central, col.eccentric])
def test_the_energy_lost_under_a_third_law(half, solver, friction):
    """Against the kinetic energies before and after, one case and many."""
    contact = CONTACT if solver is col.eccentric else {"normal": 0.1}
    a, b = (A, B) if solver is col.eccentric else (A.replace(yaw_rate=0.0), B)
    for e in (0.3, np.array([0.0, 0.3, 0.5])):
        impact = solver(a, b, e, friction=friction, law=half, **contact)
        sides = (impact.a, impact.b)
        lost = sum(side.before.kinetic_energy - side.after.kinetic_energy for side in sides)
        # A few roundings of 2e5 J.
        np.testing.assert_allclose(impact.energy_loss, lost, rtol=0.0, atol=1e-8)
        if friction > 1.0:
            assert np.all(impact.regime == "sticking")
            np.testing.assert_allclose(
                impact.slip_after, -0.5 * e * impact.slip_before, rtol=0.0, atol=1e-12
            )


def test_a_new_domain_is_checked_for_one_number():
    """The reader asks the domain itself, in words and with the code of its status."""
    small = Domain(
        "below 2",
        ((lambda value: value >= 2.0, Status.BAD_FRACTION),),
        lambda values: bool(np.all(values < 2.0)),
    )
    reader = ArgumentReader()
    assert reader.number(1.5, "", "gear", small) == 1.5
    reader.close()
    reader.number(3.0, "", "gear", small)
    with pytest.raises(
        col.InputError, match=r"gear must be below 2, got 3\.0: the critical fraction is outside"
    ) as raised:
        reader.close()
    assert (raised.value.code, raised.value.fields["argument"]) == ("bad_fraction", "gear")


def test_every_status_says_its_family():
    """Where it is declared, so that one appended needs no place in a range."""
    families = {
        "impact": "SEPARATING GRAZING NO_CLOSING",
        "input": (
            "OUT_OF_RANGE NOT_FINITE NOT_POSITIVE BAD_RESTITUTION BAD_FRICTION BAD_FRACTION "
            "ZERO_NORMAL PINNED_INFINITE PINNED_VELOCITY SPINNING TRANSVERSE NEGATIVE_SIZE "
            "WHEEL_LIFTS"
        ),
    }
    of = {name: family for family, names in families.items() for name in names.split()}
    for status in Status:
        assert vars(status)["about"] == of.get(status.name, "solution")


def test_an_operation_that_cannot_be_printed_is_named():
    """And the kernel that uses it."""

    def curved(restitution):
        sine = np.sin(restitution)
        fine = sine > 0.0
        return Answer(status=np.where(fine, Status.OK, Status.SEPARATING), closing_speed=sine)

    with pytest.raises(TypeError, match="curved uses sin, which cannot be written as a text"):
        compile_for_floats(curved, ("restitution",), ())


def test_a_ratio_that_jams_is_named_by_its_rule():
    """As it was given."""
    impact = col.eccentric(A, B, 0.3, impulse_ratio=0.2, **CONTACT)
    inputs = replace(impact.inputs, rule="slope", rule_value=0.7)
    error = run.refusal(inputs, impact._answer._replace(status=Status.RATIO_JAMS))
    assert str(error).startswith("slope = 0.7 jams the bodies: at ")
    assert math.isfinite(error.fields["limit"])


def test_the_laws_of_today():
    """One keeps the form of energy that cannot go negative."""
    assert {name: known.compression_limit for name, known in LAWS.items()} == {
        BRACH: False,
        KUDLICH_SLIBAR: True,
        STRONGE: False,
    }
    assert [name for name, known in LAWS.items() if known.followed] == [STRONGE]
