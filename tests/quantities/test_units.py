"""The reader: every unit trap found while designing, each with its own test."""

import contextlib
import json
import math
import os
import pickle
import re
import subprocess
import sys
import warnings
from dataclasses import fields
from decimal import Decimal

import numpy as np
import pint
import pytest

import collisions as col
from collisions import reporting, travel, uncertainty
from collisions.quantities.attributes import unit_of
from collisions.quantities.units import si_unit
from collisions.uncertainty.model import read_input
from strategies import other_registry

EXACT = {"mph": 0.44704, "km/h": 1 / 3.6, "lb": 0.45359237, "ft": 0.3048}


@pytest.fixture(scope="module")
def ureg():
    """A registry of its own, not the application's; a test that changes one makes it itself."""
    return pint.UnitRegistry()


def value_error_code(call):
    """The code of the error a call raises."""
    with pytest.raises(col.CollisionsError) as caught:
        call()
    return caught.value.code


def test_numbers_are_si_and_stay_python_floats():
    """Ints, numpy scalars and 0-d arrays all become Python floats."""
    for given in (
        1100,
        1100.0,
        np.int32(1100),
        np.float32(1100),
        np.float64(1100),
        np.array(1100.0),
    ):
        assert type(col.Vehicle(mass=given).mass) is float
        assert col.Vehicle(mass=given).mass == 1100.0


@pytest.mark.parametrize(
    ("text", "field", "expected"),
    [
        ("1100 kg", "mass", 1100.0),
        ("2425 lb", "mass", 2425 * EXACT["lb"]),
        ("1.1e3kg", "mass", 1100.0),
        ("inf kg", "mass", math.inf),
        ("80 km/h", "vx", 80 * EXACT["km/h"]),
        ("-50 mph", "vx", -50 * EXACT["mph"]),
        ("+.5 ft/s", "vx", 0.5 * EXACT["ft"]),
        ("30 deg/s", "yaw_rate", math.radians(30)),
        ("90 °", "heading", math.pi / 2),
        ("1330 slug*ft**2", "yaw_inertia", 1330 * 14.593902937206365 * 0.09290304),
        ("1330 slug ft^2", "yaw_inertia", 1330 * 14.593902937206365 * 0.09290304),
        ("1330 lbf*ft*s**2", "yaw_inertia", 1330 * 4.4482216152605 * 0.3048),
        ("1800 kg·m²", "yaw_inertia", 1800.0),
    ],
)
def test_unit_strings(text, field, expected):
    """One plain number and one unit; conversion factors are exact by definition, so 4 eps covers
    their products.
    """
    given = {"mass": 1.0, field: text}
    assert getattr(col.Vehicle(**given), field) == pytest.approx(expected, rel=4 * 2**-52)


@pytest.mark.parametrize(
    "text",
    [
        "80 km/h 5",
        "80 km/h +- 5",
        "80 km/h +/- 5 km/h",
        "8 0 km/h",
        "80",
        "km/h",
        "",
        "   ",
        "80 km/h*2",
        "80 2*km/h",
        "9**9**9 m/s",
        "5 m**9**9/s",
        "5 (m**9)**9",
        "1_000 m/s",
        "1,5 m/s",
        "0x10 m/s",
        "nan m/s",
        "5 m/s**22",
        "5 m²²/s",
        "١٢ m/s",
        "80 km/h; import os",
        "5 __import__",
        "5 m/s" + " " * 60 + "m",
        "80 k m / h extra words that go on and on until nothing is left of it",
    ],
)
def test_strings_that_are_not_one_number_and_one_unit(text):
    """Handed to pint whole, some of these become other numbers and one hangs; all are refused,
    quoting the text.
    """
    with pytest.raises(col.UnitsError) as caught:
        col.Vehicle(mass=1.0, vx=text)
    assert repr(text)[:40] in str(caught.value)
    assert caught.value.code == "bad_units"
    assert "vx" in str(caught.value)


def test_thousands_with_a_space_are_refused():
    """pint reads "1 500 kg" as 500 kg."""
    with pytest.raises(col.UnitsError, match="1 500 kg"):
        col.Vehicle(mass="1 500 kg")


def test_whatever_pint_raises_is_a_units_error():
    """Undefined units and wrong dimensions name the argument, quote the text and say
    what to write.
    """
    for text in ("5 parsecs_per_fortnight_squared", "5 kg"):
        with pytest.raises(col.UnitsError, match=r"vx: .*'80 km/h'") as caught:
            col.Vehicle(mass=1.0, vx=text)
        assert text in str(caught.value)


def test_one_error_names_every_wrong_argument():
    """Three wrong units, one UnitsError that names all three."""
    with pytest.raises(col.UnitsError) as caught:
        col.Vehicle(mass="80 km/h", vx="3 kg", x="7 ft/s", y="1 m")
    assert len(caught.value.fields["problems"]) == 3
    for name in ("mass:", "vx:", "x:"):
        assert f"- {name}" in str(caught.value)
    with pytest.raises(col.InputError) as caught:
        col.Vehicle(mass=-1.0, vx="3 kg", yaw_rate=True)
    assert len(caught.value.fields["problems"]) == 3


def test_a_quantity_is_never_stripped(ureg):
    """np.asarray(Quantity) drops the unit in silence; the reader converts instead."""
    assert col.Vehicle(mass=1.0, vx=ureg.Quantity(30, "mph")).vx == pytest.approx(
        30 * EXACT["mph"], rel=1e-15
    )
    many = col.Vehicle(mass=1.0, vx=ureg.Quantity(np.array([30.0, 60.0]), "mph")).vx
    np.testing.assert_allclose(many, [30 * EXACT["mph"], 60 * EXACT["mph"]], rtol=1e-15)


def test_quantities_of_several_registries_mix(ureg):
    """Two registries in one call, each converted by its own."""
    other = other_registry()
    vehicle = col.Vehicle(mass=ureg.Quantity(2000, "lb"), vx=other.Quantity(30, "mph"))
    assert vehicle.mass == pytest.approx(2000 * EXACT["lb"], rel=1e-15)
    assert vehicle.vx == pytest.approx(30 * EXACT["mph"], rel=1e-15)


@pytest.mark.slow
def test_registries_that_define_a_unit_differently_stay_apart():
    """A factor kept for one registry is not used for another in which the same name means something
    else.
    """
    ureg = pint.UnitRegistry()
    other = pint.UnitRegistry()
    ureg.define("stein = 6 kg")
    other.define("stein = 7 kg")
    assert col.Vehicle(mass=ureg.Quantity(1, "stein")).mass == 6.0
    assert col.Vehicle(mass=other.Quantity(1, "stein")).mass == 7.0


@pytest.mark.slow
@pytest.mark.filterwarnings("error")
def test_a_unit_of_another_registry_that_is_another_one_here_is_shown_in_si():
    """36 km/h that their registry calls mph; on a page, in a record and in a distribution."""
    theirs = pint.UnitRegistry()
    theirs.define("mph = 1 km/hour")
    theirs.define("psi = 1 m")  # of another kind here
    theirs.define("smoot = 1.7018 m")  # of no kind here
    vehicle = col.Vehicle(
        mass="1000 kg",
        vx=theirs.Quantity(36, "mph"),
        x=theirs.Quantity(3, "psi"),
        y=theirs.Quantity(2, "smoot"),
        heading=theirs.Quantity(90, "degree"),
    )
    assert (vehicle.vx, vehicle.x) == (pytest.approx(10.0, rel=1e-15), 3.0)
    assert vehicle.given == {"mass": "1000 kg", "y": "2.0 smoot", "heading": "90.0 degree"}
    impact = col.linear_central(vehicle, col.Vehicle(mass=1000.0, x=5.0), 0.2)
    assert col.Impact.from_dict(json.loads(json.dumps(impact.to_dict()))) == impact
    for form in ("markdown", "html"):
        page = col.report(impact, form=form, units="metric")
        assert reporting.replay(page) == impact
        assert "36.0 mph" not in page
        assert "36.00 km/h" in page or "36 km/h" in page
    stated = uncertainty.Normal(theirs.Quantity(36, "mph"), theirs.Quantity(2, "mph"))
    assert str(stated) == str(uncertainty.Normal("10 m/s", f"{2 / 3.6!r} m/s"))
    with col.options(require_units=True):
        assert col.Vehicle(mass="1 kg", vx=theirs.Quantity(36, "mph")).vx == vehicle.vx
    speeds = theirs.Quantity(np.array([36.0, 72.0]), "mph")
    np.testing.assert_allclose(col.Vehicle(mass="1 kg", vx=speeds).vx, [10.0, 20.0], rtol=1e-15)
    # What is the same unit in both stays as it was given.
    usual = other_registry().Quantity(36, "km/hour")
    assert col.Vehicle(mass="1 kg", vx=usual).given["vx"] == "36.0 kilometer / hour"


@pytest.mark.slow
def test_a_context_is_obeyed_and_forgotten():
    """A unit redefined inside a context counts only there."""
    ureg = pint.UnitRegistry()
    ureg.define("stein = 6 kg")
    context = pint.Context()
    context.redefine("stein = 8 kg")
    stein = ureg.Quantity(1, "stein")
    assert col.Vehicle(mass=stein).mass == 6.0
    with ureg.context(context):
        assert col.Vehicle(mass=stein).mass == pytest.approx(8.0, rel=1e-15)
    assert col.Vehicle(mass=stein).mass == 6.0


def test_a_text_without_a_unit_is_no_angle_after_it_was_a_proportion():
    """Units of texts are kept once read; that a proportion has none makes no bare text an angle or
    a speed.
    """
    a, b = col.Vehicle(mass=1500, vx=10), col.Vehicle(mass=1200)
    assert col.linear_central(a, b, "0.4").restitution == 0.4
    for argument, text in (("vx", "20"), ("yaw_rate", "1")):
        with pytest.raises(col.UnitsError, match="write one plain number and one unit"):
            col.Vehicle(mass=1500, **{argument: text})


@pytest.mark.slow
def test_texts_are_read_by_the_registry_of_the_moment():
    """A unit that one application registry defines is unknown to the next, and one defined
    differently differs.
    """
    before = pint.get_application_registry().get()
    try:
        for length in (1.7, 1.8):
            pint.set_application_registry(pint.UnitRegistry())
            pint.get_application_registry().define(f"smoot = {length} m")
            assert col.Vehicle(mass=1500, x="2 smoot", y=0).x == 2 * length
        pint.set_application_registry(pint.UnitRegistry())
        with pytest.raises(col.UnitsError, match="smoot"):
            col.Vehicle(mass=1500, x="2 smoot", y=0)
    finally:
        pint.set_application_registry(before)


@pytest.fixture
def decimal_registry():
    """A registry that counts in Decimal, as the application's."""
    before = pint.get_application_registry().get()
    registry = pint.UnitRegistry(non_int_type=Decimal)
    pint.set_application_registry(registry)
    yield registry
    pint.set_application_registry(before)


@pytest.mark.slow
def test_quantities_of_a_registry_that_counts_in_decimal():
    """Its Quantities hold Decimals, or floats that it cannot convert itself; also in arrays, pairs
    and outlines.
    """
    q = pint.UnitRegistry(non_int_type=Decimal).Quantity
    car = col.Vehicle(
        mass=q(Decimal("1100.5"), "kg"),
        vx=q(90.0, "km/h"),
        heading=q(Decimal(-30), "deg"),
        x=q(7, "ft"),
        y=0,
    )
    assert (car.mass, car.vx, car.heading, car.x) == (
        1100.5,
        25.0,
        -math.pi / 6,
        pytest.approx(7 * EXACT["ft"], rel=2**-52),
    )
    speeds = (np.array([Decimal(18), Decimal("inf")]), np.array([18.0, math.inf]))
    for given in speeds:
        assert col.Vehicle(mass=1.0, vx=q(given, "km/h")).vx.tolist() == [5.0, math.inf]
    for pair in (q([Decimal(1), Decimal(-2)], "km"), (q(Decimal(1), "km"), q(-2.0, "km"))):
        assert car.replace(heading=0.0).velocity_at(pair) == (25.0, 0.0)
    wall = col.Vehicle.barrier()
    impact = col.oblique_central(
        car, wall, q(Decimal("12.5"), "percent"), normal=q(Decimal(0), "deg"), friction=0.0
    )
    assert (impact.restitution, impact.normal, impact.a.after.vx) == (0.125, (1.0, 0.0), -3.125)
    corners = np.array([[2, 1], [-2, 1], [-2, -1], [2, -1]]) * Decimal(1)
    findings = [
        col.diagnose(impact, outline_a=outline)
        for outline in (q(corners, "m"), corners.astype(float))
    ]
    assert findings[0] == findings[1]


@pytest.mark.slow
@pytest.mark.parametrize("number", ["1e400", "sNaN"])
def test_decimals_that_no_float_can_hold_are_refused(number):
    """Alone and in an array."""
    q = pint.UnitRegistry(non_int_type=Decimal).Quantity
    for value in (Decimal(number), np.array([Decimal(1), Decimal(number)])):
        assert (
            value_error_code(lambda value=value: col.Vehicle(mass=q(value, "kg"))) == "not_a_number"
        )


@pytest.mark.slow
def test_an_application_registry_that_counts_in_decimal(decimal_registry):
    """Texts are read, .q gives what the registry can convert, and what came out goes in again."""
    a = col.Vehicle(mass="1.1 tonne", vx="90 km/h", heading="30 deg")
    assert (a.mass, a.vx, a.heading) == (1100.0, 25.0, math.pi / 6)
    batch = col.linear_central(
        a.replace(vx=np.array([20.0, 25.0])), col.Vehicle(mass=1100.0), "50 %"
    )
    impact = batch.case(1)
    assert impact.a.after.q.vx == decimal_registry.Quantity(Decimal(impact.a.after.vx), "m/s")
    assert float(impact.a.after.q.vx.m_as("km/h")) == pytest.approx(
        impact.a.after.vx * 3.6, rel=1e-15
    )
    assert float(impact.a.q.pdof.m_as("deg")) == pytest.approx(30.0, rel=1e-15)
    assert [part.m_as("percent") for part in impact.q.normal] == [100, 0]
    per_hour = batch.a.after.q.vx.to("km/h")
    assert per_hour.magnitude.astype(float) == pytest.approx(batch.a.after.vx * 3.6, rel=1e-15)
    assert col.Vehicle(mass=a.q.mass.to("lb"), vx=per_hour).vx == pytest.approx(
        batch.a.after.vx, rel=2 * 2**-52
    )
    assert impact.q.ees(0.5)[0].m_as("mph") > 0
    assert col.uncertainty.Normal("90 km/h", "9 km/h").mean == 25.0
    assert math.isinf(col.Vehicle.barrier().q.mass.magnitude)
    assert "mph" in col.explain(impact, units="us")


IN_ANY_CASE = """
import json, pint, collisions as col
pint.set_application_registry(pint.UnitRegistry(case_sensitive=False))
texts = json.loads(input())
a = col.Vehicle(**texts)
found = [a.mass, a.vx, a.x, a.y, a.yaw_inertia, a.heading]
impact = col.linear_central(a, col.Vehicle(mass="1200 kg", x="3 m"), 0.1)
found += [str(impact.q.energy_loss.to("kJ").units), str(a.q.mass.units), str(a.q.vx.units), \
str(impact.summary(units="us"))]
for text in ("1500 KG", "3000 LB"):
    try:
        found.append(col.Vehicle(mass=text).mass)
    except col.UnitsError as error:
        found.append(str(error))
print(json.dumps(found))
"""


@pytest.mark.slow
@pytest.mark.parametrize("seed", ["1", "2", "3"])
def test_a_registry_that_passes_over_upper_and_lower_case(seed):
    """What is written in its own case is that unit; sets of names, in an order of chance, made "kg"
    kilogauss.
    """
    texts = {
        "mass": "3000 lb",
        "vx": "40 km/h",
        "x": "7 cm",
        "y": "7 mm",
        "yaw_inertia": "2000 kg*m**2",
        "heading": "90 deg",
    }
    done = subprocess.run(
        [sys.executable, "-c", IN_ANY_CASE],
        input=json.dumps(texts), capture_output=True, text=True, encoding="utf-8", check=True,
        env={**os.environ, "PYTHONHASHSEED": seed},
    )  # fmt: skip
    *numbers, joule, kilogram, speed, summary, capitals, pounds = json.loads(done.stdout)
    plain = col.Vehicle(**texts)
    assert numbers == [plain.mass, plain.vx, plain.x, plain.y, plain.yaw_inertia, plain.heading]
    assert (joule, kilogram, speed) == ("kilojoule", "kilogram", "meter / second")
    assert summary == str(
        col.linear_central(plain, col.Vehicle(mass="1200 kg", x="3 m"), 0.1).summary(units="us")
    )
    # Capitals may be more than one unit, which is said, or one only.
    assert "'1500 KG' cannot be taken as kg; 'KG' is written 'kg'" in capitals
    assert pounds == plain.mass


@pytest.mark.slow
def test_a_quantity_whose_registry_took_its_unit_for_another():
    registry = pint.UnitRegistry(case_sensitive=False)
    quantity = registry.Quantity(1500, registry.parse_units("kilogauss"))
    with pytest.raises(
        col.UnitsError,
        match="its registry, made with case_sensitive=False, may have taken another unit",
    ):
        col.Vehicle(mass=quantity)


@pytest.mark.parametrize("count", [50, 100_000])
@pytest.mark.parametrize(
    "form",
    ["1", "1!", "1 ", "1 a  ", "a  ", "1,", "1-", "1.", "1e", "'", "(a ", "a/", "°", "[", "1'"],
)
def test_texts_of_any_length_are_refused_at_once(form, count):
    """A pattern that matches in many ways tries them all: 60 letters and spaces took a second,
    100,000 digits days.
    """
    for text in ((form * count)[:count] + "!", "1 " + (form * count)[:count] + "!"):
        with pytest.raises(col.UnitsError, match="mass: cannot read"):
            col.Vehicle(mass=text)
        with pytest.raises(col.InputError):
            uncertainty.Normal(text, text)
        with pytest.raises(col.UnitsError):
            travel.speed("20 m", drag=text)


@pytest.mark.parametrize(
    "text", ["1_0 kg", "\u0661\u0662 kg", "\uff11 kg", "1_000", "\u0661,\u0665 kg", "1\u00b2 kg"]
)
def test_digits_that_python_alone_reads_are_no_number(text):
    """float() reads 1_0 as 10, and the digits of other scripts; nobody who types them means that
    here.
    """
    for call in (
        lambda: col.Vehicle(mass=text),
        lambda: uncertainty.Normal(text, "1 kg"),
        lambda: travel.speed("20 m", drag=text),
        lambda: travel.speed(["20 m"], drag=[text]),
        lambda: col.linear_central(col.Vehicle(mass=1.0, vx=1.0), col.Vehicle(mass=1.0), text),
    ):
        with pytest.raises(col.InputError) as refused:
            call()
        assert "\u0661.\u0665" not in str(refused.value)


@pytest.mark.slow
def test_the_default_system_of_a_registry_changes_nothing():
    """to_base_units() follows the registry's default system; the reader names its target."""
    registry = pint.UnitRegistry(system="imperial")
    assert col.Vehicle(mass=registry.Quantity(1, "lb")).mass == pytest.approx(
        EXACT["lb"], rel=1e-15
    )


def test_degrees_typed_as_a_bare_number_are_suspected():
    """20 degrees typed as 20 pass as 20 rad: a warning says so; the value is still what was
    written.
    """
    with pytest.warns(col.SuspectUnitsWarning, match="'20 deg'"):
        assert col.Vehicle(mass=1.0, heading=20).heading == 20.0
    with pytest.warns(col.SuspectUnitsWarning, match="'31 deg/s'"):
        col.Vehicle(mass=1.0, yaw_rate=31.0)
    with pytest.warns(col.SuspectUnitsWarning, match="normal = 55"):
        col.linear_central(
            col.Vehicle(mass=1.0, vx=math.cos(55), vy=math.sin(55)),
            col.Vehicle(mass=1.0),
            0.1,
            normal=55,
        )
    with pytest.warns(col.SuspectUnitsWarning, match="heading"):
        col.Vehicle(mass=1.0, heading=np.array([0.1, np.nan, -20.0]))


def test_plausible_angles_are_not_suspected():
    """A full turn, and degrees with their unit, pass without a word."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        col.Vehicle(mass=1.0, heading=2 * math.pi, yaw_rate=8.0)
        col.Vehicle(mass=1.0, heading="359 deg", yaw_rate="1000 deg/s")


def test_the_suspicion_points_at_the_caller():
    """The warning is attributed to this file, not to the library."""
    with pytest.warns(col.SuspectUnitsWarning) as caught:
        col.Vehicle(mass=1.0, heading=20)
    assert caught[0].filename == __file__


@pytest.mark.parametrize(
    "given", ["1 Hz", "60 kHz", "3 bpm", "3 curie", "3 baud", "3 strain/s", "3 percent/s"]
)
def test_hertz_is_no_yaw_rate(given):
    """pint takes 1 Hz for 1 rad/s; it is a count of turns, so it is refused. So are other counts,
    and proportions.
    """
    with pytest.raises(col.UnitsError, match="deg/s"):
        col.Vehicle(mass=1.0, yaw_rate=given)


@pytest.mark.parametrize("given", ["1 percent", "1 strain", "1 bit", "1 count*rad"])
def test_a_number_is_no_angle(given):
    """pint takes each for radians."""
    with pytest.raises(col.UnitsError, match="deg"):
        col.Vehicle(mass=1.0, heading=given)


def test_what_counts_needs_a_word_of_what_it_counts():
    """Where the kind of quantity is open, too."""
    for given in ("3 Hz", "3 bpm", "3 curie", "3 baud", "3 count"):
        with pytest.raises(col.UnitsError):
            si_unit(given)
    assert si_unit("3 rpm") == "rad/s"


@pytest.mark.parametrize(
    ("field", "given", "said"),
    [
        ("vx", "80 kmph", "'kmph' is written 'km/h'"),
        ("vx", "50 hmph", "hecto-mile per hour"),
        ("vx", "5 kiloknot", "kilo-knot"),
        ("vx", "100 dkph", "deci-kilometer per hour"),
        ("vx", pint.Quantity(20, "kilofoot_per_second"), "kilo-foot per second"),
        ("yaw_rate", "5 mrpm", "milli-revolutions per minute"),
        ("mass", "1.5 mt", "milli-metric ton"),
        ("heading", "1600 mil", "a mil is one of 6400"),
        ("heading", "1.6 kmil", "a mil is one of 6400"),
        ("yaw_rate", "100 mil/s", "a mil is one of 6400"),
        ("mass", "1.1 ton", "a ton may be 1000 kg, 2000 lb or 2240 lb"),
        ("mass", "1.1 kiloton", "a ton may be 1000 kg, 2000 lb or 2240 lb"),
        ("mass", pint.Quantity(1.1, "short_ton"), "write 'tonne', 'kg' or 'lb'"),
        ("mass", "6 quarter", "a quarter may be"),
        ("vx", "10 kilokgf*s/kg", "kilo-force kilogram"),
    ],
)
def test_units_that_hardly_anybody_means_by_their_name(field, given, said):
    """Pint puts prefixes before everything: "80 kmph" would be 80 thousand miles an hour, "1.5 mt"
    1.5 kg.
    """
    with pytest.raises(col.UnitsError, match=said) as caught:
        col.Vehicle(**{"mass": 1500, field: given})
    assert caught.value.code == "bad_units"


@pytest.mark.parametrize(
    ("field", "given", "value"),
    [
        ("vx", "80 kph", 80 / 3.6),
        ("vx", "20 mm/ms", 20.0),
        ("vx", "50 knot", 50 * 1852 / 3600),
        ("mass", "1.5 t", 1500.0),
        ("mass", "1.5 Mg", 1500.0),
        ("mass", "80 klb", 80e3 * 0.45359237),
        ("heading", "20 mrad", 0.02),
    ],
)
def test_prefixes_that_are_meant(field, given, value):
    """Of what is no rate, and in a quotient."""
    assert getattr(col.Vehicle(**{"mass": 1500, field: given}), field) == pytest.approx(
        value, rel=1e-15
    )


def test_a_kilopond_is_never_a_thousand():
    """1000 kgf to pint 0.25.0, by a mistake, which is refused; 1 kgf to later versions."""
    with contextlib.suppress(col.UnitsError):
        assert col.Vehicle(mass=1500, vx="10 kilopond*s/kg").vx == pytest.approx(98.0665, rel=1e-15)


@pytest.mark.slow
def test_a_mil_of_the_caller():
    """One who gives it a name of its own, and says how many go to the turn, is understood."""
    ureg = pint.UnitRegistry()
    ureg.define("artillery_mil = turn / 6400")
    car = col.Vehicle(mass=1500, heading=ureg.Quantity(1600, "artillery_mil"))
    assert car.heading == pytest.approx(math.pi / 2, rel=1e-14)


def test_revolutions_are_a_yaw_rate():
    """rpm carries its turns with it."""
    assert col.Vehicle(mass=1.0, yaw_rate="1 rpm").yaw_rate == pytest.approx(
        2 * math.pi / 60, rel=4 * 2**-52
    )


def test_an_angle_is_no_proportion():
    """20 deg is dimensionless to pint, but not a friction of 0.349; 40 percent is 0.4."""
    a, b = col.Vehicle(mass=1.0, vx=1.0), col.Vehicle(mass=1.0)
    with pytest.raises(col.UnitsError, match="friction"):
        col.oblique_central(a, b, 0.1, normal=0, friction="20 deg")
    assert col.linear_central(a, b, "40 %").restitution == pytest.approx(0.4, rel=1e-15)


@pytest.mark.parametrize(
    ("field", "given", "strange"),
    [
        ("vx", "5 m/s/deg", "degree"),
        ("vx", "30 deg*m/s", "degree"),
        ("vx", "2 m*rad/s", "radian"),
        ("vx", "3 m*rpm", "revolutions_per_minute"),
        ("vx", "50 %*m/s", "percent"),
        ("vx", "5 m*Hz", "hertz"),
        ("vx", "5 m/s*deg/rad", "degree"),
        ("mass", "1000 kg/deg", "degree"),
        ("mass", "3 kg*bit", "bit"),
        ("yaw_inertia", "1800 N*m*s**2/rad", "radian"),
        ("x", "3 m/turn", "turn"),
        ("heading", "90 deg*deg", "degree"),
        ("heading", "3 rad*rad/deg", "radian"),
        ("heading", "1 deg**-1", "degree"),
        ("heading", "1 sr", "steradian"),
        ("yaw_rate", "30 deg**2/s", "degree"),
        ("restitution", "40 %*%", "percent"),
        ("restitution", "40 %/deg", "degree"),
        ("restitution", "40 deg/rad", "degree"),
    ],
)
def test_an_angle_or_a_proportion_inside_another_unit_is_refused(field, given, strange, ureg):
    """pint multiplies by 180/pi or 0.01 in silence: "5 m/s/deg" is 286 m/s to it. As a text and as
    a Quantity.
    """
    number, _, unit = given.partition(" ")
    for value in (
        given,
        ureg.Quantity(float(number), unit),
        ureg.Quantity(np.array([float(number)]), unit),
    ):
        given_to = (
            {"mass": 1.0, "vx": 1.0} if field == "restitution" else {"mass": 1.0, field: value}
        )
        with pytest.raises(
            col.UnitsError, match=rf"{field}: .* cannot be taken as .*{strange} has no place in it"
        ):
            col.linear_central(
                col.Vehicle(**given_to),
                col.Vehicle(mass=1.0),
                value if field == "restitution" else 0.1,
            )


@pytest.mark.parametrize(
    ("field", "given", "expected"),
    [
        ("vx", "50 mph", 50 * EXACT["mph"]),
        ("yaw_rate", "2 rad/s", 2.0),
        ("yaw_rate", "30 deg/s", math.pi / 6),
        ("yaw_rate", "1800 deg/min", math.pi / 6),
        ("yaw_rate", "0.5 turn/s", math.pi),
        ("yaw_rate", "500 mrad/s", 0.5),
        ("heading", "5400 arcmin", math.pi / 2),
        ("heading", "0.5 pi*rad", math.pi / 2),
        ("x", "3 m*m/m", 3.0),
        ("yaw_inertia", "10 J*s**2", 10.0),
    ],
)
def test_units_that_hold_the_angle_they_should(field, given, expected):
    """A yaw rate holds one angle, a heading is one; whatever cancels is gone."""
    assert getattr(col.Vehicle(**{"mass": 1.0, field: given}), field) == pytest.approx(
        expected, rel=4 * 2**-52
    )


def test_speeds_per_degree_go_out_and_are_no_input_of_a_model(ureg):
    """Sensitivities have angles below the line: .q gives them, and a model may answer them. As an
    input "m/s/deg" is refused.

    It would reach the model as a bare number, 57 times what is written, where a Vehicle refuses it
    for a speed.
    """
    found = col.reconstruct.momentum(
        1100.0, 950.0, course_a="0 deg", course_b="90 deg", course_a_after="30 deg",
        course_b_after="40 deg",
        speed_a_after=8.0, speed_b_after=9.0,
    )  # fmt: skip
    per_degree = found.q.sensitivity["speed_a"]["course_b_after"]
    assert per_degree.m_as("m/s/deg") == pytest.approx(
        math.radians(found.sensitivity["speed_a"]["course_b_after"]), rel=1e-15
    )
    uncertainty = col.uncertainty
    for given in (ureg.Quantity(2.0, "m/s/deg"), "2 m/s/deg"):
        for stated in (
            lambda given: uncertainty.Normal(given, given),
            lambda given: uncertainty.LogNormal(given, given),
            lambda given: uncertainty.Uniform(0, given),
            lambda given: uncertainty.Triangular(0, 0, given),
            lambda given: uncertainty.Interval(0, given),
            lambda given: given,
        ):
            with pytest.raises(
                col.UnitsError, match="an angle stands above the line and alone there"
            ) as refused:
                read_input("speed", stated(given))
            assert refused.value.code == "bad_units"
    with pytest.raises(col.UnitsError, match="plain number in SI"):
        uncertainty.Samples(ureg.Quantity(np.array([1.0, 2.0]), "m/s/deg"))
    result = uncertainty.propagate(
        lambda x: {"slope": x * ureg.Quantity(1.0, "m/s/deg")},
        {"x": uncertainty.Normal(2, 1)},
        method="first_order",
    )
    assert result["slope"].unit == "m/s/rad"
    assert result["slope"].mean == pytest.approx(2.0 * 180.0 / math.pi, rel=1e-12)


@pytest.mark.parametrize(
    ("field", "given", "hint"),
    [
        ("mass", "2425 lbf", "'lb'"),
        ("mass", "9800 N", "'lb' or 'kg'"),
        ("yaw_inertia", "1330 lb*ft*s**2", "lbf"),
        ("vx", "0.7 g", "km/h"),
    ],
)
def test_pounds_and_grams_confused(field, given, hint):
    """Forces for masses and the like are refused with what to write."""
    with pytest.raises(col.UnitsError) as caught:
        col.Vehicle(**{"mass": 1.0, field: given})
    assert hint in str(caught.value)
    assert given in str(caught.value)


@pytest.mark.parametrize("given", ["3000 lbf", "15 kN", "1500 kgf", "3 kip"])
def test_a_weight_is_no_mass(given):
    with pytest.raises(col.UnitsError, match="a weight in lbf or N is a force"):
        col.Vehicle(mass=given)


@pytest.mark.parametrize(
    ("field", "given", "said"),
    [
        ("mass", "1 dBm", "decibelmilliwatt"),
        ("mass", "3 J", "joule"),
        ("mass", "3 Pa", "pascal"),
        ("mass", "1 MG", "megagauss"),
        ("mass", "1500 k g", "'k g' is written 'kg'"),
        ("mass", "1500 k G", "'k G' is written 'kg'"),
        ("vx", "80 k m/h", "'k m/h' is written 'km/h'"),
        ("yaw_inertia", "1 dBm", "decibelmilliwatt"),
        ("yaw_inertia", "1800 N*m", "newton"),
        ("yaw_inertia", "1330 ft lb", "pound"),
    ],
)
def test_what_is_no_force_is_not_called_one(field, given, said):
    """The reason is that of what was given."""
    with pytest.raises(col.UnitsError, match=said) as caught:
        col.Vehicle(**{"mass": 1.0, field: given})
    assert "force" not in str(caught.value).partition("; write for example")[0]


def test_a_short_ton_is_2000_pounds():
    """In a text, whatever was read before; pint itself makes it a ton, which may be others."""
    for _ in range(2):
        for given in ("1 short_ton", "1 short_tons"):
            mass = col.Vehicle(mass=given).mass
            assert mass == pytest.approx(2000 * EXACT["lb"], rel=1e-15)
        for given in ("1 ton", pint.Quantity(1, "short_ton"), "1 short_ton*ton/ton"):
            with pytest.raises(col.UnitsError, match="a ton may be"):
                col.Vehicle(mass=given)
    truck = col.Vehicle(mass="20 short_ton", vx="10 m/s")
    impact = col.linear_central(truck, col.Vehicle(mass="1 long_ton"), 0.2)
    assert col.Impact.from_dict(json.loads(json.dumps(impact.to_dict()))) == impact
    page = col.report(impact, form="markdown", units="us")
    assert reporting.replay(page) == impact
    assert "40000 lb, given as 20 short" in page
    assert str(uncertainty.Normal("20 short_ton", "1 short_ton")) == "20 ± 1 short_ton"


def test_a_list_of_quantities_is_caught_as_it_is_read(ureg):
    """numpy would fail on it deep inside with a meaningless message."""
    with pytest.raises(col.UnitsError, match="put the unit on the whole"):
        col.Vehicle(mass=1.0, vx=[ureg.Quantity(1, "m/s"), ureg.Quantity(2, "m/s")])
    with pytest.raises(col.UnitsError, match="put the unit on the whole"):
        col.Vehicle(mass=1.0, vx=["1 m/s", "2 m/s"])


def test_arrays_are_copied_and_locked(ureg):
    """An SI array in a Quantity shares memory with the caller: changing it afterwards must change
    nothing here.
    """
    for wrap in (lambda array: array, lambda array: ureg.Quantity(array, "m/s")):
        source = np.array([1.0, 2.0])
        vehicle = col.Vehicle(mass=1.0, vx=wrap(source))
        source[0] = 99.0
        assert vehicle.vx[0] == 1.0
        with pytest.raises(ValueError, match="read-only"):
            vehicle.vx[0] = 5.0


@pytest.mark.parametrize(
    "given",
    [
        True,
        np.True_,
        1 + 2j,
        None,
        object(),
        np.array([True, False]),
        np.array([1 + 2j]),
        np.array([object()]),
        np.array(["1", "2"]),
        np.ma.masked_array([1.0, 2.0], [True, False]),
        [1.0, True],
        {"value": 1.0},
        b"5 m/s",
        np.datetime64("2020-01-01"),
    ],
)
def test_what_is_not_a_number(given):
    """Booleans, complex, objects, texts in arrays, masks: refused with the argument and
    the type.
    """
    with pytest.raises(col.InputError, match="vx"):
        col.Vehicle(mass=1.0, vx=given)


def test_a_boolean_in_a_quantity_is_still_a_boolean(ureg):
    """Multiplying by a factor would turn True into 1.0."""
    with pytest.raises(col.InputError, match="vx"):
        col.Vehicle(mass=1.0, vx=ureg.Quantity(np.array([True, False]), "m/s"))


def test_numbers_that_no_float_can_hold():
    """Integers and long doubles out of range, and a unit that pushes a float over the edge."""
    assert value_error_code(lambda: col.Vehicle(mass=10**400)) == "out_of_range"
    assert value_error_code(lambda: col.Vehicle(mass="1e308 tonne")) == "out_of_range"


def test_arrays_with_units_of_another_library_are_refused():
    """A subclass of ndarray may carry a unit or a mask that numpy would drop."""

    class Tagged(np.ndarray):
        unit = "mph"

    with pytest.raises(col.InputError, match="plain numpy array"):
        col.Vehicle(mass=1.0, vx=np.array([30.0]).view(Tagged))


def test_pairs(ureg):
    """A pair is two parts of any kind, one length-2 Quantity, or one length-2 array."""
    wall = col.Vehicle(mass=1.0, yaw_rate=0.0, x=0.0, y=0.0, vx=3.0)
    for point in (
        ("1 m", 2.0),
        ["1 m", "200 cm"],
        ureg.Quantity([1.0, 2.0], "m"),
        np.array([1.0, 2.0]),
    ):
        assert wall.velocity_at(point) == (3.0, 0.0)
    for point in (
        1.0,
        (1.0,),
        (1.0, 2.0, 3.0),
        np.zeros((2, 2)),
        np.zeros(3),
        "1 m",
        ureg.Quantity([1.0, 2.0, 3.0], "m"),
        None,
    ):
        with pytest.raises(col.ShapeError, match="point"):
            wall.velocity_at(point)


@pytest.mark.parametrize(
    ("degrees", "expected"),
    [
        (0, (1, 0)),
        (90, (0, 1)),
        (180, (-1, 0)),
        (270, (0, -1)),
        (-90, (0, -1)),
        (360, (1, 0)),
        (360000090, (0, 1)),
        (-450, (0, -1)),
    ],
)
def test_quarter_turns_are_exact(degrees, expected, ureg):
    """Degrees are reduced before they are converted, so 90 deg is exactly (0, 1), however it is
    written.
    """
    n = np.array(expected, dtype=float)
    a = col.Vehicle(mass=1.0, vx=n[0], vy=n[1])
    for normal in (
        f"{degrees} deg",
        ureg.Quantity(degrees, "degree"),
        ureg.Quantity(np.array([float(degrees)]), "deg"),
    ):
        impact = col.linear_central(a, col.Vehicle(mass=1.0), 0.5, normal=normal)
        found = np.array([np.ravel(part)[0] for part in impact.normal])
        assert found.tolist() == n.tolist()
        assert not np.signbit(found[found == 0]).any()


def test_degrees_beside_a_quarter_turn_keep_their_digits():
    """cos(90 deg + 1e-10 deg) is -1.745329e-12; converted first it loses five of sixteen digits."""
    a = col.Vehicle(mass=1.0, vy=1.0, vx=-1.7453292519943295e-12)
    nx, _ = col.linear_central(a, col.Vehicle(mass=1.0), 0.5, normal="90.0000000001 deg").normal
    rest = 90.0000000001 - 90.0
    assert nx == pytest.approx(-math.sin(math.radians(rest)), rel=1e-15)


def test_normals_as_tuple_array_and_list():
    """A tuple is a vector and is normalised, an array is angles, a list is refused with both
    spellings.
    """
    a, b = col.Vehicle(mass=1.0, vx=3.0, vy=4.0), col.Vehicle(mass=1.0)

    def solve(normal):
        return col.oblique_central(a, b, 0.5, normal=normal, friction=0.0)

    assert solve((3, 4)).normal == (0.6, 0.8)
    assert solve((3e-200, 4e-200)).normal == pytest.approx((0.6, 0.8), rel=2**-51)
    assert solve((3e300, 4e300)).normal == pytest.approx((0.6, 0.8), rel=2**-51)
    assert solve(np.array([0.1, 0.2])).normal[0].shape == (2,)
    with pytest.raises(col.InputError, match=r"\(nx, ny\).*np\.array"):
        solve([3, 4])
    assert value_error_code(lambda: solve((0.0, 0.0))) == "zero_normal"
    assert value_error_code(lambda: solve((1.0, 0.0, 0.0))) == "bad_shape"


@pytest.mark.slow
def test_a_unit_normal_can_be_given_again():
    """Normalising the normal of a result gives the same bits, single or many."""
    generator = np.random.default_rng(7)
    angles = generator.uniform(-3, 3, 2000)
    a, b = col.Vehicle(mass=1.0, vx=np.cos(angles), vy=np.sin(angles)), col.Vehicle(mass=1.0)
    many = col.oblique_central(
        a, b, 0.5, normal=(7 * np.cos(angles), 7 * np.sin(angles)), friction=0.0
    )
    again = col.oblique_central(a, b, 0.5, normal=many.normal, friction=0.0)
    assert np.array_equal(many.normal[0], again.normal[0])
    assert np.array_equal(many.normal[1], again.normal[1])
    for angle in angles[:300]:
        one = col.Vehicle(mass=1.0, vx=math.cos(angle), vy=math.sin(angle))
        n = col.oblique_central(
            one, b, 0.5, normal=(7 * math.cos(angle), 7 * math.sin(angle)), friction=0.0
        ).normal
        assert col.oblique_central(one, b, 0.5, normal=n, friction=0.0).normal == n


@pytest.mark.slow
def test_pint_is_loaded_only_for_units():
    """Importing and solving with numbers never loads pint; the first unit does."""
    code = (
        "import sys, collisions as col\na = col.Vehicle(mass=1000.0, vx=20.0); b = "
        "col.Vehicle(mass=1200.0)\nimpact = col.linear_central(a, b, 0.2); impact.energy_loss; "
        "impact.to_dict(); repr(impact)\nassert 'pint' not in sys.modules and 'matplotlib' not "
        "in sys.modules\nimpact.q.energy_loss\nassert 'pint' in sys.modules\n"
    )
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


def test_results_come_back_in_the_callers_registry():
    """.q gives Quantities of the application registry, with the unit each attribute declares."""
    registry = pint.get_application_registry()
    a = col.Vehicle(mass="1100 kg", vx="80 km/h", heading="0 deg")
    impact = col.linear_central(a, col.Vehicle(mass=950.0), 0.4)
    assert impact.q.energy_loss + registry.Quantity(1.0, "kJ") > registry.Quantity(100.0, "kJ")
    assert impact.a.after.q.vx.to("km/h").magnitude == pytest.approx(
        impact.a.after.vx * 3.6, rel=1e-14
    )
    assert impact.q.a.delta_v.m_as("m/s") == impact.a.delta_v
    assert impact.q.normal[0].dimensionless
    assert a.q.name == ""
    assert a.q.pivot is None
    assert a.q.momentum[0].check("[mass] * [length] / [time]")
    assert "vx" in dir(a.q)


def test_a_quantity_that_needs_an_input_says_which():
    """Without a heading pdof is None; its Quantity is asked for to be converted, and what None
    cannot do tells nothing.
    """
    golf = col.Vehicle(mass=1000.0, vx=20.0, name="Golf")
    impact = col.linear_central(golf.replace(heading=0.0), golf.replace(vx=0.0), 0.1)
    for name in ("pdof", "delta_v_forward", "delta_v_left"):
        assert getattr(impact.b, name) is None
        with pytest.raises(
            col.MissingInputError,
            match=rf"b \(Golf\) has no heading, which {name} needs; give heading=",
        ) as caught:
            getattr(impact.b.q, name)
        assert (caught.value.code, caught.value.fields["argument"]) == (
            "missing_heading",
            "heading",
        )
        assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)
        # What looks whether it is there, as completion does, finds that it is not.
        assert hasattr(impact.a.q, name)
        assert not hasattr(impact.q.b, name)
    for name, code in (
        ("heading", "missing_heading"),
        ("x", "missing_position"),
        ("yaw_inertia", "missing_inertia"),
    ):
        with pytest.raises(
            col.MissingInputError, match=rf"no {name}, which \.q\.{name} needs; give {name}="
        ) as caught:
            getattr(golf.q, name)
        assert caught.value.code == code
    # None where nothing is missing: a free body, a central model.
    assert golf.q.pivot is None
    assert impact.q.point is None


def test_methods_of_q_give_quantities():
    """Their bare results would silently lose the unit; what is no quantity is not offered."""
    a = col.Vehicle(mass=1000.0, vx=20.0, x=0.0, y=0.0, heading=0.0, yaw_inertia=1500.0)
    impact = col.eccentric(
        a, a.replace(vx=0.0, x=4.0), 0.1, normal=0.0, point=(2.0, 0.5), friction=0.5
    )
    for pair in (a.q.velocity_at((1.0, 1.0)), impact.a.q.delta_v_at((1.0, 1.0)), impact.q.ees(0.5)):
        assert all(part.check("[length] / [time]") for part in pair)
    assert a.q.point(forward=1.0)[0].m_as("cm") == pytest.approx(100.0, rel=1e-15)
    with pytest.raises(AttributeError, match=r"without \.q"):
        a.q.replace(mass=1.0)


@pytest.mark.parametrize("given", ["0.25 turn", "5400 arcmin", "324000 arcsecond", "100 grade"])
def test_other_angles_are_reduced_like_degrees(given):
    """A quarter turn is exactly (0, 1) in every unit but the radian, which cannot hold one."""
    vehicle = col.Vehicle.from_speed(mass=1.0, speed=2.0, course=given)
    assert (vehicle.vx, vehicle.vy) == (0.0, 2.0)


def test_a_friction_without_end_as_a_text():
    """ "inf" is one plain number; nonsense is answered with an example of a number."""
    a, b = col.Vehicle(mass=1.0, vx=1.0), col.Vehicle(mass=1.0)
    assert col.oblique_central(a, b, 0.1, normal=0.0, friction="inf").friction == math.inf
    with pytest.raises(col.UnitsError, match=r"one plain number, such as 0\.4"):
        col.oblique_central(a, b, 0.1, normal=0.0, friction="rough")
    with pytest.raises(col.UnitsError) as caught:
        col.Vehicle(mass="5 m")
    assert "force" not in str(caught.value)


def test_every_declared_unit_is_one_pint_knows():
    """Units live once, in the metadata; each of them converts to itself."""
    registry = pint.get_application_registry()
    a = col.Vehicle(mass=1.0, vx=1.0)
    impact = col.linear_central(a, col.Vehicle(mass=1.0), 0.4)
    units = [f.metadata["unit"] for f in fields(a) if "unit" in f.metadata]
    for kind in (type(impact), type(impact.a), col.Vehicle):
        units += [unit for name in dir(kind) if (unit := unit_of(kind, name)) is not None]
    assert len(units) > 40
    for unit in units:
        assert registry.Quantity(1.0, unit or "dimensionless").m_as(unit or "dimensionless") == 1.0


def test_texts_are_kept_for_reports(ureg):
    """What was written with a unit is kept beside the number, and follows the vehicle when other
    fields change.
    """
    vehicle = col.Vehicle(mass=" 1100 kg", vx=ureg.Quantity(50, "mph"), vy=2.0)
    assert vehicle.given == {"mass": "1100 kg", "vx": "50.0 mile_per_hour"}
    assert vehicle.replace(vy=3.0).given == vehicle.given
    assert vehicle.replace(mass=900.0).given == {"vx": "50.0 mile_per_hour"}
    assert col.Vehicle(mass=1.0).given is None


@pytest.mark.parametrize("text", ["50 percent/s", "5 deg*percent/s"])
def test_a_proportion_in_a_yaw_rate_is_not_said_to_count_turns(text):
    """As Hz does."""
    with pytest.raises(col.UnitsError, match="percent has no place in it"):
        col.Vehicle(mass=1.0, yaw_rate=text)
    with pytest.raises(col.UnitsError, match="Hz counts turns"):
        col.Vehicle(mass=1.0, yaw_rate="3 Hz")


def test_a_unit_that_pint_refuses_without_a_word_leaves_no_empty_brackets():
    """What pint says of it differs between its versions: nothing, or a sentence."""
    with pytest.raises(col.UnitsError, match=r"'3 dB\*m/s' cannot be taken as m/s") as refused:
        col.Vehicle(mass=1000.0, vx="3 dB*m/s")
    assert "()" not in str(refused.value)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (
            {"heading": -90.0},
            "heading = -90 is read as rad; if degrees were meant, write '-90 deg'",
        ),
        ({"heading": np.array([10.0, -90.0])}, "write '-90 deg'"),
        ({"heading": 90.0}, "write '90 deg'"),
        ({"yaw_rate": -40.0}, "write '-40 deg/s'"),
    ],
)
def test_a_suspect_number_keeps_its_sign_in_what_to_write(given, says):
    with pytest.warns(col.SuspectUnitsWarning) as caught:
        col.Vehicle(mass=1500.0, vx=10.0, **given)
    assert says in str(caught[0].message)


def test_a_suspect_number_of_some_samples_is_counted():
    """Of a drag that is normal around 1.4, the share above 1.5 and not all samples."""
    drags = uncertainty.Normal(1.4, 0.3)
    with pytest.warns(col.CollisionsWarning):
        found = uncertainty.propagate(
            lambda drag: {"v": travel.speed(20.0, drag=drag)}, {"drag": drags}, seed=1, samples=4096
        )
    (said,) = [one for one in found.statements if "drag is so large" in one]
    cases = int(re.match(r"(\d+) of 4096 cases", said)[1])
    assert 0.3 < cases / 4096 < 0.45
