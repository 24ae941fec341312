"""One table of units and one check: explanations, reports, findings and figures write a quantity
alike.
"""

import pint
import pytest

import collisions as col
from collisions import plot
from collisions.derivation import explain
from collisions.derivation.expressions import System
from collisions.diagnostics import diagnose
from collisions.diagnostics.case import MomentumCase
from collisions.plot.canvas import Units
from collisions.quantities.formatting import KIND_OF, SI_UNITS, SYSTEMS, rounded, scale_of, unit_of
from collisions.reporting import report

UREG = pint.get_application_registry()
IMPACT = col.linear_central(col.Vehicle(mass=1100, vx=20.0), col.Vehicle(mass=950), 0.3)


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("kind", SI_UNITS)
def test_every_unit_is_of_its_kind(kind, system):
    """By pint, to the last digits of a factor; no conversion moves the zero."""
    label = unit_of(kind, system)
    assert UREG.Quantity(1.0, SI_UNITS[kind]).m_as(label) == pytest.approx(
        scale_of(kind, system), rel=1e-15
    )
    assert UREG.Quantity(0.0, SI_UNITS[kind]).m_as(label) == 0.0


@pytest.mark.parametrize("system", SYSTEMS)
def test_mass_length_and_inertia_go_together(system):
    """1/m + r**2/I adds up as it is printed: I over m r**2 is 1 in the units of a system, without a
    factor.
    """
    inertia, mass, length = (
        UREG.Quantity(1.0, unit_of(kind, system)) for kind in ("inertia", "mass", "length")
    )
    # A power of a length is rounded a few times.
    assert (inertia / mass / length**2).m_as("") == pytest.approx(1.0, rel=1e-14)


def test_a_unit_is_that_of_one_kind():
    """A number of which only the unit is known has one kind; seconds are those of any time but a
    contact's, plain numbers no impulse ratio.
    """
    assert len(KIND_OF) == len(SI_UNITS) - 2
    assert KIND_OF["s"] == "time"
    assert KIND_OF[""] == "number"


@pytest.mark.parametrize("system", SYSTEMS)
def test_a_quantity_is_written_alike(system):
    """A speed, a PDOF, a length and a yaw rate, by the three that write; each has its own signs for
    degrees and powers.
    """
    for kind, value in (
        ("speed", 12.34567),
        ("angle", 0.54321),
        ("length", 3.45678),
        ("yaw rate", 2.34567),
    ):
        page = System(system).answer(value, kind)
        case = MomentumCase(
            answer=None, damage={}, crush_energy=None, duration=0.1, drag=0.7, units=system
        )
        label = Units(system).text(value, SI_UNITS[kind])
        # An angle stands beside a limit, with one decimal more.
        assert case.number(value, kind).startswith(page.split()[0])
        assert kind == "angle" or case.text(value, kind).replace("degrees", "deg") == page
        assert page.split()[0] == label.partition("°")[0].split()[0]
        # With four figures at most, which these numbers do not exceed.
        assert Units(system).name(SI_UNITS[kind]) == page.split()[1].replace("deg", "°")


@pytest.mark.parametrize("units", ["SI", "imperial", "", 3, ["us"]])
def test_units_are_checked_in_one_way(units):
    """The four that take ``units=`` refuse what is no system with one text and one code."""
    said = set()
    for function in (explain, report, diagnose, plot.energy):
        with pytest.raises(
            col.InputError, match="units must be 'si', 'metric' or 'us', got"
        ) as caught:
            function(IMPACT, units=units)
        assert (caught.value.code, caught.value.fields["argument"]) == ("bad_option", "units")
        said.add(str(caught.value))
    assert len(said) == 1


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [
        (9.994e14, -12, "999000000000000"),
        (1e15, 2, "1e+15"),
        (-1.7e308, -305, "-1.7e+308"),
        (-0.004, 2, "0.00"),
    ],
)
def test_numbers_beyond_what_a_float_holds_are_short(value, decimals, text):
    """A float has at most 17 digits, so an impulse of 1e150 N s is not printed with 150."""
    assert rounded(value, decimals) == text
