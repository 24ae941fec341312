"""Vehicle: what it holds, what it works out, and what it refuses when it is made."""

import copy
import dataclasses
import math
import pickle
import warnings

import numpy as np
import pytest

import collisions as col

INF = math.inf


def code_of(call):
    """The code of the error a call raises."""
    with pytest.raises(col.CollisionsError) as caught:
        call()
    return caught.value.code


def test_frozen_and_keyword_only():
    """No field can be set, none is positional, and there is no room for a misspelt one."""
    vehicle = col.Vehicle(mass=1.0)
    with pytest.raises(AttributeError):
        vehicle.mass = 2.0
    for name in ("speed", "nonsense", "given"):
        with pytest.raises(AttributeError):
            setattr(vehicle, name, 3.0)
    with pytest.raises(TypeError):
        col.Vehicle(1.0)
    with pytest.raises(TypeError):
        col.Vehicle(mass=1.0, velocity=3.0)


def test_equality_is_by_value_and_there_is_no_hash():
    """Arrays and NaN included; a name counts, how a number was written does not."""
    assert col.Vehicle(mass="1 kg") == col.Vehicle(mass=1)
    assert col.Vehicle(mass=1.0) != col.Vehicle(mass=1.0, name="B")
    assert col.Vehicle(mass=1.0) != 1.0
    many = {"mass": np.array([1.0, np.nan]), "pivot": None}
    assert col.Vehicle(**many) == col.Vehicle(**many)
    assert col.Vehicle(mass=np.array([1.0, 2.0])) != col.Vehicle(mass=np.array([1.0, 2.0, 3.0]))
    with pytest.raises(TypeError):
        hash(col.Vehicle(mass=1.0))


def test_copies_and_pickles_are_equal_and_locked():
    """Through pickle and deepcopy, texts kept, arrays still locked."""
    vehicle = col.Vehicle(
        mass="1000 kg", vx=np.array([1.0, 2.0]), x=0, y=0, yaw_rate=0.5, yaw_inertia=1e3, pivot=None
    )
    for twin in (pickle.loads(pickle.dumps(vehicle)), copy.deepcopy(vehicle), copy.copy(vehicle)):
        assert twin == vehicle
        assert twin.given == vehicle.given
        assert not twin.vx.flags.writeable


@pytest.mark.parametrize(
    "place", [{}, {"x": 1.0}, {"y": -0.0}, {"x": 1.0, "y": 2.0}, {"x": 1e308, "y": 1e308}]
)
def test_plain_floats_were_not_given_as_texts(place):
    """With one coordinate as with both or none."""
    assert col.Vehicle(mass=1.0, **place).given is None


@pytest.mark.parametrize("field", ["mass", "yaw_inertia"])
@pytest.mark.parametrize("value", [0, -1.0, -INF, "-5 kg", "0 kg*m**2"])
def test_masses_and_inertias_are_positive(field, value):
    """Zero and below are refused with the field and the value; inf is allowed."""
    if isinstance(value, str) and ("m**2" in value) != (field == "yaw_inertia"):
        value = -1.0
    with pytest.raises(col.InputError, match=rf"{field} must be > 0 \(inf allowed\)") as caught:
        col.Vehicle(**{"mass": 1.0, field: value})
    assert caught.value.code == "not_positive"
    assert getattr(col.Vehicle(**{"mass": 1.0, field: INF}), field) == INF


@pytest.mark.parametrize("field", ["vx", "vy", "yaw_rate", "x", "y", "heading"])
@pytest.mark.parametrize("value", [INF, -INF, math.nan])
def test_motion_and_place_are_finite(field, value):
    """Only masses and inertias may be infinite; NaN is nothing."""
    assert code_of(lambda: col.Vehicle(**{"mass": 1.0, field: value})) == "not_finite"
    assert code_of(lambda: col.Vehicle(mass=math.nan)) == "not_finite"


def test_a_missing_mass_is_named():
    """None is not a mass."""
    with pytest.raises(col.MissingInputError, match="mass is missing"):
        col.Vehicle(mass=None)
    with pytest.raises(col.InputError, match="vx is None"):
        col.Vehicle(mass=1.0, vx=None)
    with pytest.raises(col.InputError, match="name must be a text"):
        col.Vehicle(mass=1.0, name=3)


def test_barrier():
    """Neither moves nor turns; may be given a name and a place."""
    wall = col.Vehicle.barrier()
    assert wall.mass == wall.yaw_inertia == INF
    assert wall.kinetic_energy == 0.0
    assert wall.momentum == (0.0, 0.0)
    assert col.Vehicle.barrier(name="pole", x=1.0).x == 1.0
    assert wall.replace(vx=1.0).kinetic_energy == INF
    assert wall.replace(vx=-1.0).momentum == (-INF, 0.0)


def test_from_speed_is_exact_at_quarter_turns():
    """Course 90 deg gives vx exactly 0; both ways of giving the velocity at once are refused."""
    vehicle = col.Vehicle.from_speed(mass=1.0, speed="36 km/h", course="90 deg")
    assert (vehicle.vx, vehicle.vy) == (0.0, 10.0)
    assert vehicle.given == {"speed": "36 km/h", "course": "90 deg"}
    assert col.Vehicle.from_speed(mass=1.0, speed=5.0, course=(3, 4)).vx == 3.0
    assert (
        code_of(lambda: col.Vehicle.from_speed(mass=1.0, speed=5.0, course=0.0, vx=3.0))
        == "speed_twice"
    )
    many = col.Vehicle.from_speed(mass=1.0, speed=np.array([1.0, 2.0]), course="180 deg")
    assert many.vx.tolist() == [-1.0, -2.0]


def test_the_dataclass_tools_work():
    """fields, asdict and replace of the dataclasses module see the public fields and
    nothing else.
    """
    vehicle = col.Vehicle(mass="1000 kg", vx=1.0)
    assert [f.name for f in dataclasses.fields(vehicle)][:2] == ["mass", "vx"]
    assert "given" not in dataclasses.asdict(vehicle)
    assert dataclasses.replace(vehicle, mass=2.0).mass == 2.0


def test_a_replaced_vehicle_is_suspected_only_of_what_changed():
    """A heading of 720 deg, once given with its unit, is not taken for degrees later."""
    vehicle = col.Vehicle(mass=1.0, heading="720 deg", yaw_rate="4000 deg/s")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert vehicle.replace(vx=2.0).heading == vehicle.heading
    with pytest.warns(col.SuspectUnitsWarning):
        vehicle.replace(heading=30)


def test_a_speed_is_not_negative():
    """Backwards is another course, not another sign."""
    assert (
        code_of(lambda: col.Vehicle.from_speed(mass=1.0, speed=-5.0, course=0.0))
        == "negative_speed"
    )


def test_speed_and_course():
    """Magnitude and direction of the velocity; a standing vehicle has no course."""
    vehicle = col.Vehicle(mass=2.0, vx=-3.0, vy=4.0)
    assert vehicle.speed == 5.0
    assert vehicle.course == math.atan2(4.0, -3.0)
    assert vehicle.kinetic_energy == 25.0
    assert math.isnan(col.Vehicle(mass=1.0).course)
    assert col.Vehicle(mass=1.0, vx=-1.0, vy=-0.0).course == math.pi
    many = col.Vehicle(mass=1.0, vx=np.array([3.0, 0.0]), vy=4.0)
    assert many.speed.tolist() == [5.0, 4.0]
    assert many.course[1] == math.pi / 2


def test_the_kinetic_energy_of_a_turning_body_needs_its_inertia():
    """Never taken as zero."""
    turning = col.Vehicle(mass=2.0, vx=1.0, yaw_rate=2.0)
    with pytest.raises(col.MissingInputError, match="yaw_inertia"):
        _ = turning.kinetic_energy
    assert turning.replace(yaw_inertia=3.0).kinetic_energy == 7.0


def test_points_on_the_vehicle():
    """Forward and left, or distance and angle from the heading, counter-clockwise."""
    vehicle = col.Vehicle(mass=1.0, x=10.0, y=5.0, heading="90 deg")
    assert vehicle.point(forward=2.0, left="1 m") == pytest.approx((9.0, 7.0), abs=1e-15)
    assert vehicle.point(distance=2.0, angle="-90 deg") == pytest.approx((12.0, 5.0), abs=1e-15)
    for arguments in (
        {},
        {"distance": 1.0},
        {"forward": 1.0, "distance": 1.0},
        {"forward": 1.0, "distance": 1.0, "angle": 0.0},
    ):
        assert code_of(lambda arguments=arguments: vehicle.point(**arguments)) == "bad_point"
    for field in ("x", "heading"):
        with pytest.raises(col.MissingInputError, match=f"no {field}"):
            vehicle.replace(**{field: None}).point(forward=1.0)


def test_velocity_at_needs_a_position_only_to_turn():
    """A body that does not turn moves alike everywhere."""
    assert col.Vehicle(mass=1.0, vx=2.0).velocity_at((5.0, 5.0)) == (2.0, 0.0)
    with pytest.raises(col.MissingInputError, match="no x"):
        col.Vehicle(mass=1.0, yaw_rate=1.0).velocity_at((5.0, 5.0))
    assert col.Vehicle(mass=1.0, yaw_rate=1.0, x=5.0, y=4.0).velocity_at((5.0, 5.0)) == (-1.0, 0.0)


def test_a_pinned_velocity_is_worked_out():
    """Yaw rate times arm, counter-clockwise; worked out again by replace; refused when it
    disagrees.
    """
    pinned = col.Vehicle(
        mass=1000.0, yaw_inertia=1333.0, x=2.0, y=0.0, yaw_rate=3.0, pivot=(0.0, 0.0)
    )
    assert (pinned.vx, pinned.vy) == (0.0, 6.0)
    assert pinned.replace(yaw_rate=1.0).vy == 2.0
    assert pinned.replace(vy=6.0 * (1 + 1e-10)).vy == 6.0
    assert pinned.replace(pivot=None).vy == 6.0
    with pytest.raises(col.InputError, match=r"gives \(-?0 m/s, 6 m/s\)") as caught:
        pinned.replace(vy=6.1)
    assert caught.value.code == "pinned_velocity"


def test_a_pin_needs_a_position_and_finite_mass():
    """A pinned body turns about a place, so it has one, and a mass and inertia that can turn."""
    body = {"mass": 1.0, "yaw_inertia": 1.0, "x": 1.0, "y": 0.0, "pivot": (0.0, 0.0)}
    assert code_of(lambda: col.Vehicle(**{**body, "x": None})) == "missing_position"
    assert code_of(lambda: col.Vehicle(**{**body, "mass": INF})) == "pinned_infinite"
    assert code_of(lambda: col.Vehicle(**{**body, "yaw_inertia": INF})) == "pinned_infinite"
    assert code_of(lambda: col.Vehicle(**{**body, "pivot": (0.0, math.nan)})) == "not_finite"


def test_repr_and_table_carry_units():
    """What is printed says which unit it is in, and leaves out what was not given."""
    vehicle = col.Vehicle(mass=1000, vx=np.array([1.0, 2.0]), name="<A>")
    assert repr(vehicle) == "Vehicle(mass=1000 kg, vx=array(2,) 1 to 2 m/s, name='<A>')"
    html = vehicle._repr_html_()
    assert "1000 kg" in html
    assert "<A>" not in html
    assert "&lt;A&gt;" in html


@pytest.mark.parametrize("cases", [1, 3])
def test_a_number_that_no_case_has_is_said_to_be_none(cases):
    """As a single NaN is: the shape alone would pass for an answer."""
    apart = np.full(cases, 10.0)
    refused = col.linear_central(
        col.Vehicle(mass=1000.0), col.Vehicle(mass=1.0, vx=apart), 0.1, normal=0.0, on_failure="nan"
    )
    shown = refused._repr_html_()
    assert (
        f"energy_loss</th><td style='text-align:left;padding-left:1em'>array{(cases,)} not "
        "defined</td>" in shown
    )
    assert (
        "energy lost</th><td style='text-align:right;white-space:nowrap;padding-left:1em'>not "
        "defined</td>" in shown
    )
    assert f"energy_loss=array{(cases,)} not defined" in repr(refused)


@pytest.mark.parametrize("still", ["x", "yaw_rate"])
def test_a_plain_number_beyond_float32_is_not_made_infinite_by_an_array_beside_it(still):
    """As in the solvers, what float32 cannot hold is worked out in float64."""
    fast = float(np.finfo(np.float32).max) * (1.0 + 1e-6)
    numbers = {"vy": fast, "yaw_rate": 1.0, "x": 0.0, "y": 0.0} | {
        still: np.zeros(3, dtype=np.float32)
    }
    _, vy = col.Vehicle(mass=300.0, **numbers).velocity_at((0.0, 0.0))
    assert (vy == fast).all()
    impact = col.eccentric(
        col.Vehicle(mass=300.0, vx=1.0, yaw_inertia=200.0, **numbers),
        col.Vehicle.barrier(),
        0.0,
        normal=0.0,
        point=(0.0, 0.0),
        friction=0.0,
    )
    # Frictionless and plastic, through the centre: the wall takes m vx^2 / 2, whatever is beside
    # it.
    assert impact.a.kinetic_energy_change == pytest.approx(-150.0, rel=1e-15)


def test_a_velocity_along_one_axis_stays_a_plain_number_where_the_other_is_an_array():
    """A point of which one coordinate is an array: the velocity square to it is the same in every
    case.
    """
    vx, vy = col.Vehicle(mass=300.0, yaw_rate=0.5, x=0.0, y=0.0).velocity_at(
        (2.0, np.array([1.0, 3.0]))
    )
    assert vx.tolist() == [-0.5, -1.5]
    assert type(vy) is float
    assert vy == 1.0


def test_replace_takes_fields_only():
    """A speed and a course are those of a new vehicle; the record of an impact may hold no other
    field either.
    """
    with pytest.raises(
        TypeError, match=r"replace\(\) takes the fields .*got 'speed'.*Vehicle\.from_speed"
    ):
        col.Vehicle(mass=900).replace(speed=10, course=0)
    record = col.linear_central(col.Vehicle(mass=900, vx=10), col.Vehicle(mass=900), 0.1).to_dict()
    record["inputs"]["a"]["colour"] = 1.0
    with pytest.raises(col.InputError, match="a vehicle has no 'colour'") as caught:
        col.Impact.from_dict(record)
    assert caught.value.code == "bad_record"


def test_a_distance_and_an_angle_that_do_not_go_together():
    vehicle = col.Vehicle(mass=1100.0, x=10.0, y=5.0, heading=0.0)
    with pytest.raises(col.ShapeError, match=r"distance.*angle"):
        vehicle.point(distance=np.array([1.0, 2.0, 3.0]), angle=np.array([0.1, 0.2]))


@pytest.mark.parametrize("cases", [None, 3])
def test_the_velocity_of_a_pinned_body_agrees_to_1e_9(cases):
    """Alone and in a batch: half of that beside the velocity about the pivot is as good, twice is
    another motion.
    """
    gate = {
        "mass": 400.0,
        "yaw_inertia": 300.0,
        "x": 0.0,
        "y": 2.0,
        "pivot": (0.0, 0.0),
        "yaw_rate": -5.0,
    }
    car = col.Vehicle(mass=1000.0, vx=20.0, x=-2.0, y=2.0, yaw_inertia=1500.0)

    def struck(error):
        vx = 10.0 * (1.0 + error) if cases is None else np.full(cases, 10.0 * (1.0 + error))
        body = col.Vehicle(**gate, vx=vx)
        return col.eccentric(
            car, body, 0.1, normal=0.0, point=(0.0, 2.0), friction=0.1, on_failure="raise"
        )

    assert np.all(struck(0.5e-9).ok)
    with pytest.raises(col.InputError) as caught:
        struck(2e-9)
    assert caught.value.code == "pinned_velocity"
