"""What a first-time user writes wrong, and that the message says what to write."""

import re

import pint
import pytest

import collisions as col
from collisions.quantities import Frozen, derived


@pytest.mark.parametrize(
    ("given", "cure"),
    [
        ({"mass": 1500.0, "speed": "45 mph"}, "Vehicle.from_speed(speed='45 mph', course='0 deg', ...)"),
        ({"weight": "3400 lb"}, "write mass=, such as mass='3400 lb'"),
        ({"mass": 1500.0, "izz": 2000.0}, "write yaw_inertia="),
        ({"mass": 1500.0, "headin": 0.0}, "write heading="),
        ({"mass": 1500.0, "colour": "red"}, "it has mass, vx, vy"),
    ],
)
def test_an_argument_that_a_vehicle_does_not_have_names_the_one_it_has(given, cure):
    with pytest.raises(TypeError, match=re.escape(cure)):
        col.Vehicle(**given)


def test_a_vehicle_without_a_mass_says_what_a_mass_may_be():
    with pytest.raises(col.MissingInputError, match="give it in kg, or inf for a barrier"):
        col.Vehicle(vx=1.0)


def test_an_attribute_is_looked_up_where_it_is():
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=20.0), col.Vehicle(mass=1000.0), 0.1)
    for owner, name, where in (
        (impact, "delta_v", "impact.a.delta_v or impact.b.delta_v"),
        (impact, "speed", "impact.a.after.speed"),
        (impact.a, "speed", "before.speed or after.speed"),
    ):
        with pytest.raises(AttributeError, match=re.escape(where)):
            getattr(owner, name)
        assert not hasattr(owner, name)
    for name in ("nothing", "_delta_v"):
        with pytest.raises(AttributeError, match=rf"no attribute '{name}'$"):
            getattr(impact, name)


@pytest.mark.parametrize(
    ("text", "argument", "cure"),
    [
        ("1,500 kg", "mass", "'1500 kg' or '1.500 kg'"),
        ("1,234,500 g", "mass", "'1234500 g'"),
        ("12,5 m", "x", "'12.5 m'"),
        ("40 kmh", "vx", "'kmh' is written 'km/h'"),
        ("40 KM/H", "vx", "'KM/H' is written 'km/h'"),
        ("1500 Kg", "mass", "'Kg' is written 'kg'"),
        ("7'6\"", "x", "'7.5 ft' is one"),
        ("7 ft 6 in", "x", "'7.5 ft' is one"),
        ("2100 lbf-ft-s**2", "yaw_inertia", "'2100 lbf*ft*s**2'"),
    ],
)
def test_a_text_that_cannot_be_read_names_the_one_that_can(text, argument, cure):
    with pytest.raises(col.UnitsError, match=re.escape(cure)) as refused:
        col.Vehicle(**{"mass": 1500.0, argument: text})
    written = re.findall(r"'([^']*)'(?: is one)?", cure)[-1]
    if " " in written:  # the cure is read, to what was meant
        col.Vehicle(**{"mass": 1500.0, argument: written})
    assert refused.value.fields["argument"] == argument


def test_a_list_of_texts_names_the_quantity_to_write():
    with pytest.raises(col.UnitsError, match=re.escape("pint.Quantity([40, 50.5], 'mph')")):
        col.Vehicle(mass=1500.0, vx=["40 mph", "50.5 mph"])
    for other in (["40 mph", 3.0], ["x", "y"], ["40 mph", "50 km/h"]):
        with pytest.raises(col.UnitsError, match=re.escape("pint.Quantity([40, 50], 'mph')")):
            col.Vehicle(mass=1500.0, vx=other)
    assert col.Vehicle(mass=1500.0, vx=pint.Quantity([40, 50.5], "mph")).vx[1] == pytest.approx(50.5 * 0.44704)


def test_an_attribute_that_cannot_be_worked_out_says_why():
    """Python asks ``__getattr__`` also when the attribute is there and raises an AttributeError itself."""

    class Answer(Frozen):
        @derived()
        def slope(self):
            return (1).slope_of_a_number

    with pytest.raises(AttributeError, match="'int' object has no attribute 'slope_of_a_number'"):
        _ = Answer().slope


@pytest.mark.parametrize("given", ["2100 lb-ft-s2", "2100 ft-lb-sec^2", "2100 slug ft2", "2100 slug-ft^2", "2100 lb*ft*s2"])
def test_what_a_refused_yaw_inertia_is_told_to_write_can_be_read(given):
    with pytest.raises(col.UnitsError, match=r"raised by \*\*, '([^']*)'") as caught:
        col.Vehicle(mass=1500.0, yaw_inertia=given)
    cure = re.search(r"raised by \*\*, '([^']*)'", str(caught.value))[1]
    assert col.Vehicle(mass=1500.0, yaw_inertia=cure).yaw_inertia == pytest.approx(2847.22, rel=1e-5)  # 2100 slug ft2


@pytest.mark.parametrize("given", ["30 to 35 mph", "30-35 mph", "35 +/- 2 mph", "35 ± 2 mph"])
def test_a_range_in_place_of_a_number_is_named(given):
    with pytest.raises(col.UnitsError, match=r"this is a range; ranges go to collisions\.uncertainty\.propagate"):
        col.Vehicle(mass=1500.0, vx=given)


def test_metres_per_hour_are_no_miles_per_hour():
    with pytest.raises(col.UnitsError, match="write 'mph' for miles"):
        col.Vehicle(mass=1500.0, vx="35 m/h")


def test_a_name_of_a_part_says_where_it_is():
    with pytest.raises(AttributeError, match=r"write collisions\.uncertainty\.Normal$"):
        _ = col.Normal
    with pytest.raises(AttributeError, match=r"write collisions\.plot\.momentum or collisions\.reconstruct\.momentum$"):
        _ = col.momentum
    assert not hasattr(col, "Vehicel")
