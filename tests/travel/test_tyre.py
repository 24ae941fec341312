"""The force of a tyre, and ``travel.Tyres``: against the integrated spin of a braked wheel, closed
forms, and refusals.
"""

import math
import pickle

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import collisions as col
from collisions import travel
from collisions.engine.floats import compile_for_floats
from collisions.impact.records import tyres_of, tyres_record
from collisions.kernels.tyre import (
    STANDING,
    Tyres,
    brake_share,
    tyre_force,
    tyre_forces,
    wheel_forces,
)
from collisions.vehicle.tyres import kernel_numbers

# Of a wheel: radius [m], inertia [kg*m**2], load [N], speed of its hub [m/s]; what it comes to does
# not depend on them.
RADIUS, INERTIA, LOAD, SPEED = 0.3, 1.2, 3700.0, 12.0


def spun(lock, degrees, friction=0.7, ground=0.7, load=1.0):
    """Share of the friction that drags, and force along and across over friction times load, of a
    wheel that spins freely.

    Friction acts against the slip of its contact, and the brake holds a moment against the spin;
    integrated until it is steady.
    """
    along, across = SPEED * math.cos(math.radians(degrees)), SPEED * math.sin(math.radians(degrees))
    moment, most = lock * friction * LOAD * RADIUS, ground * load * LOAD

    def force(spin):
        x, y = along - spin * RADIUS, across
        size = math.hypot(x, y, 1e-9 * SPEED)
        return most * x / size, most * y / size

    def rate(_, spin):
        turning = math.tanh(spin[0] / 1e-4)  # the brake works against the spin, whichever way it is
        return [(force(spin[0])[0] * RADIUS - moment * turning) / INERTIA]

    end = solve_ivp(rate, (0.0, 3.0), [along / RADIUS], method="Radau", rtol=1e-9, atol=1e-9)
    assert end.success
    x, y = (part / most for part in force(end.y[0, -1]))
    return (x * along + y * across) / SPEED, x, y


@pytest.mark.slow
@pytest.mark.parametrize(
    ("lock", "degrees", "share"),
    [
        (0.1, 20, 0.434),
        (0.3, 30, 0.737),
        (0.5, 45, 0.966),
        (0.8, 20, 0.957),
        (0.2, 90, 1.0),
        (1.0, 35, 1.0),
        (0.6, 130, None),
    ],
)
def test_a_braked_wheel_is_one_that_spins_until_its_brake_holds_it(lock, degrees, share):
    """The integrated spin, to its three digits: what drags, in the kernel and in ``path``; and both
    parts of the force.
    """
    drags, x, y = spun(lock, degrees)
    if share is not None:
        assert drags == pytest.approx(share, abs=6e-4)
    turned = math.radians(degrees)
    along, across = tyre_force(math.cos(turned), math.sin(turned), lock, 0.7, math.inf)
    assert (-along, -across) == pytest.approx((x, y), abs=1e-3)
    run = travel.path(
        [(0, 0), (10, 0)], [f"{degrees} deg"] * 2, friction=0.7, lock=lock, end_speed=3
    )
    assert run.drags[0] / 0.7 == pytest.approx(drags, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("ground", "load"), [(0.1, 1.0), (0.9, 1.0), (0.7, 1.4), (0.35, 0.6)])
def test_the_moment_of_a_brake_stays_on_other_ground_and_under_other_loads(ground, load):
    """A wheel braked at 0.4 is locked on ice, and rolls more freely on better ground: the
    integrated spin of the same brake.
    """
    _, x, y = spun(0.4, 25, ground=ground, load=load)
    brake = brake_share(0.4, 0.7, ground, load)
    along, across = tyre_force(
        math.cos(math.radians(25)), math.sin(math.radians(25)), brake, ground, math.inf
    )
    assert (-along, -across) == pytest.approx((x, y), abs=1e-3)
    assert brake_share(1.0, 0.7, ground, load) == 1.0
    assert brake_share(0.4, 0.7, 0.0, load) == 1.0


@pytest.mark.parametrize("tangent", [0.01, 0.05, 0.15])
def test_at_small_slip_the_side_force_is_fialas(tangent):
    """1 - (1 - z)**3 of the brush model, by integrating the shear of its patch: bristles bend until
    the parabolic pressure slides.

    The pressure over a patch of length 1 is 6 x (1 - x) for a load of 1; stiffness of a bristle 2
    c, so that the slope at no slip is the cornering stiffness c.
    """
    friction, cornering = 0.7, 9.5
    x = np.linspace(0.0, 1.0, 200_001)
    shear = np.minimum(2.0 * cornering * tangent * x, friction * 6.0 * x * (1.0 - x))
    wanted = float(np.sum((shear[1:] + shear[:-1]) / 2.0 * np.diff(x))) / friction
    _, across = tyre_force(1.0, tangent, 0.0, friction, cornering)
    assert -across == pytest.approx(wanted, rel=1e-6)
    # Braked at 0.9, the circle leaves less than that.
    along, across = tyre_force(1.0, 10.0 * tangent, 0.9, friction, cornering)
    assert math.hypot(along, across) <= 1.0 + 1e-12


def test_no_force_jumps_where_a_wheel_stands():
    """From any side the force falls to none with the slip; above ``STANDING`` it is whole, whatever
    is nearly 0.
    """
    for angle in np.linspace(0.0, 2.0 * math.pi, 37):
        for lock in (0.0, 0.3, 1.0):
            x, y = tyre_force(1e-9 * math.cos(angle), 1e-9 * math.sin(angle), lock, 0.7, 9.5)
            assert math.hypot(x, y) < 1e-6
            full = tyre_force(STANDING * math.cos(angle), STANDING * math.sin(angle), 1.0, 0.7, 9.5)
            assert math.hypot(*full) == pytest.approx(1.0, abs=1e-12)
    assert tyre_force(0.0, 0.0, 0.5, 0.7, 9.5) == (0.0, 0.0)
    assert tyre_force(1.0, 0.1, 0.5, 0.0, 9.5)[1] < 0.0


def test_forces_never_leave_the_circle_nor_push():
    """100,000 random wheels: within the circle, against both parts of the motion."""
    generator = np.random.default_rng(3)
    along, across = generator.normal(0.0, 1.0, (2, 100_000)) * 10.0 ** generator.uniform(
        -6, 1, 100_000
    )
    lock, mu, cornering = (
        generator.uniform(0.0, 1.2, 100_000),
        generator.uniform(0.0, 1.0, 100_000),
        generator.uniform(1, 30, 100_000),
    )
    x, y = tyre_force(along, across, lock, mu, cornering)
    assert np.all(np.hypot(x, y) <= 1.0 + 1e-12)
    assert np.all(x * along <= 0.0)
    assert np.all(y * across <= 0.0)
    assert np.all(np.abs(x) <= lock + 1e-15)


def by_floats(*numbers):
    tyres = Tyres(numbers[:4], *numbers[4:12])
    return tyre_forces(tyres, numbers[12:16], *numbers[16:19], transfers=True)


@pytest.mark.slow
def test_floats_rows_and_recordings_agree():
    """The same vehicles one by one, in rows of arrays, and compiled: to rounding, with steer and
    load transfer.
    """
    generator = np.random.default_rng(5)
    many = np.array([
        *generator.uniform(0, 1, (4, 50)), generator.uniform(0.3, 0.9, 50),
        generator.uniform(5, 12, 50), np.full(50, 1.35),
        np.full(50, 0.75), np.full(50, math.cos(0.2)), np.full(50, math.sin(0.2)),
            np.full(50, 0.2), np.full(50, 0.33),
        *generator.uniform(0.1, 0.9, (4, 50)), *generator.normal(0, 1, (3, 50)),
    ])  # fmt: skip
    rows = Tyres((many[:4],), *many[4:12])
    wanted = tyre_forces(rows, (many[12:16],), *many[16:19], transfers=True)
    compiled = compile_for_floats(by_floats, tuple(f"[{i}]" for i in range(19)), ())
    for i in range(50):
        numbers = tuple(many[:, i].tolist())
        assert by_floats(*numbers) == pytest.approx(
            [part[i] for part in wanted], rel=1e-12, abs=1e-14
        )
        # x ** 0.5 and sqrt(x) can differ in the last digit.
        assert compiled(numbers) == pytest.approx(by_floats(*numbers), rel=1e-13, abs=1e-15)


def test_load_transfer_holds_the_vehicle_upright():
    """The loads found carry the weight, and their moments about the centre of mass balance those of
    the forces at its height.
    """
    height, ahead, left = 0.5, 1.35, 0.75
    tyres = Tyres(
        (0.3, 0.8, 0.2, 1.0),
        0.7,
        9.5,
        ahead,
        left,
        1.0,
        0.0,
        height / (2 * ahead),
        height / (2 * left),
    )
    here = (0.7, 0.5, 0.7, 0.9)
    wheels = wheel_forces(tyres, here, 0.9, 0.3, 0.2, transfers=True)
    loads = [load / 4.0 for *_, load in wheels]
    forces = [
        (mu * load * x, mu * load * y)
        for mu, load, (x, y, _) in zip(here, loads, wheels, strict=True)
    ]
    fx, fy = (sum(force[at] for force in forces) for at in (0, 1))
    places = [(ahead, left), (ahead, -left), (-ahead, left), (-ahead, -left)]
    assert sum(loads) == pytest.approx(1.0, abs=1e-12)
    # Eight passes: the loads are off by what is left of the last change, the moments [m, over the
    # weight] by a thousandth.
    assert sum(load * x for load, (x, _) in zip(loads, places, strict=True)) == pytest.approx(
        -height * fx, abs=1e-3
    )
    assert sum(load * y for load, (_, y) in zip(loads, places, strict=True)) == pytest.approx(
        -height * fy, abs=1e-3
    )


def test_load_transfer_balances_whichever_way_the_vehicle_slides():
    """Round the circle, by the same moments and to the same thousandth: braked wheels that take and
    give back load from pass to pass end nearer than that.
    """
    height, ahead, left, mu = 0.6, 1.3, 0.75, 0.9
    given = travel.Tyres(mu, (1.0, 0.2, 0.5, 0.0), 2.0 * ahead, 2.0 * left, height=height)
    angle = np.linspace(-math.pi, math.pi, 2000, endpoint=False)
    rows = kernel_numbers({name: np.full(2000, one) for name, one in given.named.items()}, np)
    wheels = wheel_forces(
        rows, (rows.friction,) * 4, np.cos(angle), np.sin(angle), 0.0 * angle, transfers=True
    )
    fx, fy = (sum(mu * 0.25 * wheel[2] * wheel[at] for wheel in wheels) for at in (0, 1))
    places = [(ahead, left), (ahead, -left), (-ahead, left), (-ahead, -left)]
    over_x, over_y = (
        sum(0.25 * wheel[2] * place[at] for wheel, place in zip(wheels, places, strict=True))
        for at in (0, 1)
    )
    assert np.max(np.hypot(over_x + height * fx, over_y + height * fy)) < 1e-3


# Tyres


def test_tyres_are_a_frozen_record_with_units():
    """Texts, Quantities, arrays; repr, .q, pickle, JSON and replace."""
    for tyres in (
        travel.Tyres("70 %", [1, 0.05, "5 %", 0.05], "270 cm", "60 in", steer="3 deg"),
        travel.Tyres(0.7, 0.3, 2.7, 1.5, height=0.5, cornering=8.0),
        travel.Tyres(np.array([0.7, 0.6]), 0.3, col.Vehicle(mass=1.0, x="2.7 m").q.x, 1.5),
    ):
        assert pickle.loads(pickle.dumps(tyres)) == tyres
        assert tyres_of(tyres_record(tyres)) == tyres
        assert tyres.q.wheelbase.m_as("cm") == pytest.approx(270.0)
        assert tyres.replace(friction=0.5).friction == 0.5
        assert tyres.replace(friction=0.5).steer == tyres.steer
        with pytest.raises(AttributeError):
            tyres.friction = 0.3
    assert tyres_of(None) is None
    assert tyres_record(None) is None
    first = travel.Tyres("70 %", [1, 0.05, "5 %", 0.05], "270 cm", "60 in", steer="3 deg")
    assert first.locks == (1.0, 0.05, 0.05, 0.05)
    assert tyres_record(first)["track"] == "60 in"
    assert repr(first) == (
        "Tyres(friction=0.7, lock=(1, 0.05, 0.05, 0.05), wheelbase=2.7 m, track=1.524 m, "
        "steer=0.0523599 rad, cornering=9.5)"
    )
    assert "height" not in repr(first)
    with pytest.raises(col.InputError, match="tyres have friction"):
        tyres_of({"friction": 0.7})


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        ({"friction": -0.7}, "bad_friction", "friction must be >= 0, got -0.7"),
        ({"friction": math.nan}, "not_finite", "friction"),
        ({"lock": 1.1}, "bad_fraction", "lock must be from 0 to 1, got 1.1"),
        ({"lock": math.nan}, "bad_fraction", "lock must be from 0 to 1"),
        ({"lock": [1, 1, 1, -1]}, "bad_fraction", "lock[3] must be from 0 to 1"),
        (
            {"lock": [1, 1]},
            "bad_shape",
            "lock is a list of 2; give one value for all wheels, or four: front left",
        ),
        ({"wheelbase": 0.0}, "not_positive", "wheelbase must be > 0, got 0.0"),
        ({"track": "-1 m"}, "not_positive", "track must be > 0, got '-1 m'"),
        ({"track": math.inf}, "not_finite", "track must be finite"),
        ({"steer": math.nan}, "not_finite", "steer is NaN"),
        ({"cornering": 0}, "not_positive", "cornering must be > 0"),
        ({"height": -0.5}, "negative_length", "height must be >= 0"),
        ({"height": 1.2}, "wheel_lifts", "a wheel lifts off"),
    ],
)
def test_refused_tyres(options, code, said):
    """Each names what is wrong, what was given and what is allowed."""
    with pytest.raises(col.InputError) as caught:
        travel.Tyres(**{"friction": 0.7, "lock": 1, "wheelbase": 2.7, "track": 1.5, **options})
    assert caught.value.code == code
    assert said in str(caught.value)


def test_the_size_of_the_vehicle_is_asked_for():
    """A truck with the wheelbase of a car comes to rest metres elsewhere: no default, and a hint
    for other words.
    """
    with pytest.raises(col.InputError, match=r"wheelbase.*was not given"):
        travel.Tyres(0.7, 1)
    with pytest.raises(TypeError, match="write friction="):
        travel.Tyres(mu=0.7, lock=1, wheelbase=2.7, track=1.5, friction=0.7)
    with pytest.warns(col.SuspectUnitsWarning, match="106"):
        travel.Tyres(0.7, 1, 106, 1.5)


def test_the_height_from_which_a_wheel_lifts_off_is_that_of_its_load():
    """The load of the wheel that lifts is W/4 - mu W h (cos/wheelbase + sin/track)/2; over all
    directions the least is 0 at h = 1 / (2 mu hypot(1/wheelbase, 1/track)).
    """
    highest = 1.0 / (2.0 * 0.7 * math.hypot(1.0 / 2.7, 1.0 / 1.5))
    assert highest == pytest.approx(0.9366, abs=1e-4)
    assert travel.Tyres(0.7, 1, 2.7, 1.5, height=0.999 * highest).transfers
    with pytest.raises(col.InputError, match=r"height is 0\.93\d* m, and from 0\.937 m on"):
        travel.Tyres(0.7, 1, 2.7, 1.5, height=1.001 * 0.9366)


def test_four_locks_stay_as_they_were_given_when_something_else_changes():
    tyres = travel.Tyres(0.7, ["100 %", 0.05, "5 %", 0.0], 2.7, 1.5).replace(friction=0.5)
    assert tyres.locks == (1.0, 0.05, 0.05, 0.0)
    assert [tyres.given[f"lock[{wheel}]"] for wheel in (0, 2)] == ["100 %", "5 %"]


def test_of_many_vehicles_one_that_steers_has_its_steer():
    """Beside others that do not, it has the path that it has alone."""
    car = {"mass": 1500.0, "yaw_inertia": 2400.0, "x": 0.0, "y": 0.0, "heading": 0.0, "vx": 12.0}
    steer = np.array([0.0, 0.05])
    both = travel.simulate(
        col.Vehicle(**car), travel.Tyres(0.7, 0.3, 2.7, 1.5, steer=steer), tolerance=1e-5
    )
    for case, angle in enumerate(steer):
        alone = travel.simulate(
            col.Vehicle(**car), travel.Tyres(0.7, 0.3, 2.7, 1.5, steer=angle), tolerance=1e-5
        )
        assert both.rest.y[case] == pytest.approx(alone.rest.y, rel=1e-9, abs=1e-9)
    assert abs(both.rest.y[1]) > 1.0


def test_a_locked_wheel_has_its_whole_force_from_two_percent_of_the_speed_on():
    """In units of the speed of the vehicle; below that it grows from none, with no jump in slope:
    s / (1 + s^2) * 2 of the whole where s is the speed over that of a standing wheel.
    """
    for speed in (0.0201, 0.1, 1.0):
        assert tyre_force(speed, 0.0, 1.0, 0.7, 9.5)[0] == -1.0
    for share in (0.25, 0.5, 0.9):
        force, _ = tyre_force(0.02 * share, 0.0, 1.0, 0.7, 9.5)
        assert force == pytest.approx(-2.0 * share / (1.0 + share * share), rel=1e-12)


@pytest.mark.parametrize(
    ("locks", "moment"),
    [((1.0, 0.0, 1.0, 0.0), 0.2625), ((0.0, 1.0, 0.0, 1.0), -0.2625), ((1.0, 0.0, 0.0, 1.0), 0.0)],
    ids=["left", "right", "across"],
)
def test_a_car_that_brakes_on_one_side_turns_to_it(locks, moment):
    """Two wheels of a quarter of the weight each drag with 0.7 of it, 0.75 m beside the centre of
    mass: 0.35 of the weight, and 0.2625 m of it to the left.
    """
    tyres = Tyres(locks, 0.7, 9.5, 1.35, 0.75)
    x, y, yaw = tyre_forces(tyres, (0.7,) * 4, 1.0, 0.0, 0.0)
    assert (x, y, yaw) == pytest.approx((-0.35, 0.0, moment), abs=1e-15)
