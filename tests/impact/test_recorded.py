"""What a recorder shows over time: against motions differentiated twice, the whole impact, and each
case of a batch by itself.
"""

import math

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct, travel
from collisions.impact.recorded import Curve, readings
from collisions.uncertainty import Normal, Uniform

A = col.Vehicle(mass=1500.0, vx=15.0, yaw_inertia=2500.0, x=-2.1, y=0.0, heading=0.1)
B = col.Vehicle(mass=1250.0, vy=11.0, yaw_inertia=1900.0, x=0.9, y=-0.4, heading=1.5)
MET = {"normal": 0.0, "point": (0.0, 0.3), "friction": 0.5, "duration": 0.1}
TIMES = [0.02, 0.05, 0.08, 0.2]
PLACES = [(0.0, 0.0), (0.5, 0.0), (-0.8, 0.3), (1.2, -0.7)]


def turned(angle, x, y):
    return np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y


@pytest.mark.parametrize("place", PLACES)
def test_an_accelerometer_at_a_place_of_a_moving_body(place):
    """The place's path is differentiated twice and the acceleration summed up in axes that turn: no
    rule for turning axes enters. The motion is smooth and invented.
    """
    time = np.linspace(0.0, 0.1, 20001)
    yaw = 0.3 + 1.5 * time + 18.0 * time**2 - 60.0 * time**3
    spin = 1.5 + 36.0 * time - 180.0 * time**2
    x = 15.0 * time - 500.0 * time**3
    y = 80.0 * time**2 - 2.0 * time
    px, py = turned(yaw, *place)
    step = time[1]
    ax, ay = (np.gradient(np.gradient(part, step), step) for part in (x + px, y + py))
    forward, left = turned(-yaw, ax, ay)
    # Without the ends, at which differences are one-sided.
    inside = slice(2, -2)
    shown = [
        float(np.sum(0.5 * (part[inside][1:] + part[inside][:-1])) * step)
        for part in (forward, left)
    ]
    at = time[inside]
    curve = Curve(
        at,
        -1500.0 * at**2 + 1500.0 * at[0] ** 2,
        160.0 * (at - at[0]),
        spin[inside],
        at[0],
    )
    found = readings(curve, yaw[inside][0], place, "turning", True)
    assert [part[-1] for part in found] == pytest.approx(shown, abs=2e-4)
    # In axes that do not turn it is the change of the place's velocity.
    vx, vy = (np.gradient(part, step)[inside] for part in (x + px, y + py))
    change = turned(-yaw[2], vx[-1] - vx[0], vy[-1] - vy[0])
    found = readings(curve, yaw[2], place, "fixed", True)
    assert [part[-1] for part in found] == pytest.approx(change, abs=2e-4)


@pytest.mark.parametrize("geometry", ["maximum_engagement", "first_contact", "fixed"])
@pytest.mark.parametrize("place", PLACES)
def test_of_an_impact_it_is_the_acceleration_of_its_place(place, geometry):
    """By the velocity of the place in the scene, from the pulse's curves; the heading is that of
    maximum engagement, unless first contact is what the positions are.
    """
    impact = col.time_resolved(A, B, 0.2, **MET, geometry=geometry, steps=400)
    pulse = impact.pulse
    time, spin = pulse.time, pulse.yaw_rate_a
    yaw = np.concatenate(([0.0], np.cumsum(0.5 * np.diff(time) * (spin[1:] + spin[:-1]))))
    if geometry != "first_contact":
        yaw = yaw - yaw[np.argmax(pulse.crush)]
    yaw = yaw + 0.1
    dx, dy = turned(0.1, pulse.delta_v_forward_a, pulse.delta_v_left_a)
    rx, ry = turned(yaw, *place)
    vx, vy = 15.0 + dx - spin * ry, dy + spin * rx
    middle = 0.5 * (yaw[1:] + yaw[:-1])
    steps = turned(-middle, np.diff(vx), np.diff(vy))
    shown = [float(np.sum(step)) for step in steps]
    found = impact.a.recorded(1.0, forward=place[0], left=place[1])
    assert found == pytest.approx(shown, abs=1e-4)
    late = np.array(impact.a.recorded([0.0, *pulse.time, 1.0], forward=place[0], left=place[1]))
    assert late[:, 0].tolist() == [0.0, 0.0]
    assert late[:, -1] == pytest.approx(late[:, -2], abs=1e-12)


def test_the_centre_of_mass_in_fixed_axes_has_the_delta_v_of_the_impact():
    impact = col.time_resolved(A, B, 0.2, **MET)
    pulse = impact.pulse
    for label, side in (("a", impact.a), ("b", impact.b)):
        curves = [getattr(pulse, f"delta_v_{part}_{label}") for part in ("forward", "left")]
        whole = side.delta_v_forward, side.delta_v_left
        assert [curve[-1] for curve in curves] == pytest.approx(whole, abs=1e-12)
        assert np.hypot(*curves) == pytest.approx(getattr(pulse, f"delta_v_{label}"), abs=1e-12)
        assert side.recorded(1.0, axes="fixed") == pytest.approx(whole, abs=1e-12)
    assert pulse.q.delta_v_forward_a.units == pulse.q.delta_v_a.units
    assert "delta_v_forward_a" in impact.to_dict()["results"]["pulse"]


def test_a_short_contact_gives_what_the_place_gains_at_once():
    """In 10 us nothing turns: the reading is that of ``delta_v_at``."""
    impact = col.time_resolved(A, B, 0.2, **(MET | {"duration": 1e-5}))
    x, y = turned(0.1, 0.7, -0.2)
    change = turned(-0.1, *impact.a.delta_v_at((A.x + x, A.y + y)))
    for axes in ("turning", "fixed"):
        found = impact.a.recorded("1 s", forward="70 cm", left=-0.2, axes=axes)
        assert found == pytest.approx(change, abs=2e-4)


TYRES = travel.Tyres(0.7, 0.4, 2.7, 1.5)


@pytest.mark.slow
@pytest.mark.parametrize("count", [3, 60])
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"geometry": "fixed", "drag": 0.6},
        {"geometry": "first_contact", "tyres_a": TYRES, "tyres_b": TYRES},
    ],
)
def test_every_case_of_a_batch_is_that_of_the_case_alone(count, options):
    """Few cases are followed one by one, many together; refused ones are NaN."""
    speeds = np.linspace(-2.0, 20.0, count)
    ahead, delay = np.linspace(-0.5, 0.5, count), np.linspace(0.0, 0.005, count)
    many = col.time_resolved(
        A.replace(vx=speeds), B.replace(heading=1.5 + 0.01 * speeds), 0.2, **MET, **options,
        on_failure="nan",
    )  # fmt: skip
    times = np.array(TIMES)[:, np.newaxis] + delay
    for label in "ab":
        side = getattr(many, label)
        forward, left = side.recorded(times, forward=ahead, left=-0.1)
        assert forward.shape == left.shape == (4, count)
        assert not forward.flags.writeable
        assert np.isnan(forward[:, 0]).all()
        for at in range(np.flatnonzero(~np.isnan(forward[0]))[0], count, 4):
            alone = getattr(many.case(at), label).recorded(
                times[:, at], forward=float(ahead[at]), left=-0.1
            )
            np.testing.assert_allclose(forward[:, at], alone[0], rtol=1e-9, atol=1e-9)
            np.testing.assert_allclose(left[:, at], alone[1], rtol=1e-9, atol=1e-9)
        one, _ = side.recorded("50 ms")
        row, _ = side.recorded([0.05])
        assert one.shape == (count,)
        np.testing.assert_array_equal(one, row[0])


@pytest.mark.slow
def test_few_steps_of_a_contact_that_turns_are_read_alike_together_and_alone():
    """In some the deepest step is not the one at which the places given are passed."""
    rng = np.random.default_rng(7)
    near = {"mass": 1240.0, "yaw_inertia": 1750.0, "x": -0.7, "y": -0.97, "heading": 0.7,
            "vx": 13.9, "vy": 7.8}  # fmt: skip
    drawn = {name: value * rng.uniform(0.8, 1.2, 60) for name, value in near.items()}
    b = col.Vehicle(mass=2075.0, yaw_inertia=3480.0, x=0.75, y=0.81, heading=2.89, vx=-5.7, vy=1.42)
    rolling = travel.Tyres(0.605, 0.01, 2.7, 1.57, height=0.5)
    more = {"normal": 0.815, "point": (-0.07, 0.65), "friction": 0.62, "duration": 0.16,
            "tyres_a": rolling, "tyres_b": rolling, "steps": 20}  # fmt: skip
    many = col.time_resolved(col.Vehicle(**drawn), b, 0.24, **more, on_failure="nan")
    found = np.array(many.a.recorded(1.0, forward=0.4, left=-0.2))
    answered = np.flatnonzero(~np.isnan(found[0]))
    assert answered.size > 40
    for at in answered:
        alone = many.case(at).a.recorded(1.0, forward=0.4, left=-0.2)
        np.testing.assert_allclose(found[:, at], alone, rtol=1e-10)


@pytest.mark.slow
def test_of_two_axes_and_float32():
    speeds = np.linspace(8.0, 20.0, 30, dtype=np.float32).reshape(5, 6)
    many = col.time_resolved(A.replace(vx=speeds), B, 0.2, **MET)
    forward, _ = many.a.recorded(TIMES)
    assert forward.shape == (4, 5, 6)
    alone, _ = many.case((3, 2)).a.recorded(TIMES)
    np.testing.assert_allclose(forward[:, 3, 2], alone, rtol=1e-4)


def test_refusals():
    impact = col.time_resolved(A, B.replace(heading=None), 0.2, **MET)
    with pytest.raises(col.MissingInputError, match="heading"):
        impact.b.recorded(0.1)
    assert impact.pulse.delta_v_forward_b is None
    for time, options, code, text in (
        (0.1, {"axes": "car"}, "bad_option", "'turning'"),
        (0.1, {"forward": "1 s"}, "bad_units", "forward"),
        (0.1, {"forward": 500.0}, "out_of_range", "were millimetres meant"),
        (0.1, {"left": np.array([0.1, 0.2])}, "bad_shape", "left has shape"),
        (math.nan, {}, "not_finite", "time"),
        ("1 m", {}, "bad_units", "time"),
        (np.zeros((2, 3)), {}, "bad_shape", "times first"),
        ([0.1, [0.2]], {}, "bad_shape", "time has parts of different shapes"),
    ):
        with pytest.raises(col.InputError, match=text) as caught:
            impact.a.recorded(time, **options)
        assert caught.value.code == code
    instant = {name: MET[name] for name in ("normal", "point", "friction")}
    with pytest.raises(col.InputError, match="an impulse takes no time") as caught:
        col.eccentric(A, B, 0.2, **instant).a.recorded(0.1)
    assert caught.value.code == "no_pulse"


@pytest.mark.slow
def test_samples_of_a_curve_are_evidence():
    """Of a crash made with a recorder off the centre of mass: its speeds and the duration are found
    within their ranges, and the speed with less than the prior left open.
    """
    truth = col.time_resolved(A, B, 0.2, **(MET | {"geometry": "fixed", "steps": 30}))
    times = [0.02, 0.04, 0.06, 0.08, 0.1]
    seen = truth.a.recorded(times, forward=0.5, left=0.1)

    def model(speed_a, speed_b, duration):
        impact = col.time_resolved(
            A.replace(vx=speed_a), B.replace(vy=speed_b), 0.2, normal=0.0, point=(0.0, 0.3),
            friction=0.5, duration=duration, geometry="fixed", steps=30, on_failure="nan",
        )  # fmt: skip
        forward, left = impact.a.recorded(times, forward=0.5, left=0.1)
        return {
            f"{name}_{at}": curve[at]
            for name, curve in (("forward", forward), ("left", left))
            for at in range(len(times))
        }

    observed = {
        f"{name}_{at}": (float(curve[at]), 0.1)
        for name, curve in (("forward", seen[0]), ("left", seen[1]))
        for at in range(len(times))
    }
    found = reconstruct.posterior(
        model,
        {
            "speed_a": Uniform(8.0, 22.0),
            "speed_b": Normal(11.0, 1.0),
            "duration": Uniform(0.06, 0.15),
        },
        observed,
        samples=2048,
        seed=1,
    )
    for name, value, most in (("speed_a", 15.0, 0.5), ("duration", 0.1, 0.003)):
        low, high = found[name].interval(0.99)
        assert low < value < high
        assert found[name].std < most
