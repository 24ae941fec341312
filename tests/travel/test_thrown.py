"""Speeds of somebody who was thrown, against a flight with bounces and a slide followed in time,
against the least over all angles in many digits, and in limits that are known.
"""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

import collisions as col
from collisions import travel
from collisions.travel import GRAVITY

MPH, FOOT = 0.44704, 0.3048


def lands_at(speed, angle, height, friction, bounce):
    """Where a body comes to rest that bounces with this restitution: each landing takes friction
    times the change of its fall, and what is left of the way it slides. Followed step by step.
    """
    x, along, up = 0.0, speed * math.cos(angle), speed * math.sin(angle)
    fall = math.sqrt(up**2 + 2.0 * GRAVITY * height)
    x += along * (up + fall) / GRAVITY
    for _ in range(400):
        along -= friction * (1.0 + bounce) * fall
        assert along > 0.0
        fall *= bounce
        x += along * 2.0 * fall / GRAVITY
        if fall < 1e-9:
            break
    step = along / (friction * GRAVITY) / 20000
    for _ in range(20000):
        before = along
        along -= friction * GRAVITY * step
        x += 0.5 * (before + along) * step
    return x


@pytest.mark.parametrize("bounce", [0.0, 0.3])
@pytest.mark.parametrize(
    ("speed", "degrees", "height", "friction"),
    [
        (14.0, 0.0, 0.0, 0.7),
        (14.0, 25.0, 0.0, 0.66),
        (18.0, 12.0, 1.1, 0.5),
        (20.0, -4.0, 0.6, 0.4),
    ],
)
def test_the_speed_of_a_throw_that_was_followed_in_time(speed, degrees, height, friction, bounce):
    """With bounces and without: the ground takes the same of the way in either."""
    far = lands_at(speed, math.radians(degrees), height, friction, bounce)
    found = travel.throw_speed(far, friction=friction, angle=f"{degrees} deg", height=height)
    assert found == pytest.approx(speed, rel=1e-9)
    least, greatest = travel.throw_bounds(far, friction=friction, height=height)
    assert least < speed
    assert speed <= greatest * (1.0 + 1e-9) or degrees < 0.0


@pytest.mark.parametrize("friction", [0.3, 0.66, 0.8])
@pytest.mark.parametrize("height", [0.0, 0.9])
def test_bounds_are_the_extremes_over_all_angles(friction, height):
    """Of the equation of motion itself, in 30 digits: the least is a minimum over angles, and the
    greatest is the level throw.
    """
    mpmath.mp.dps = 30
    mu, far, high, g = (mpmath.mpf(str(one)) for one in (friction, 25, height, GRAVITY))

    def distance(speed, angle):
        up, along = speed * mpmath.sin(angle), speed * mpmath.cos(angle)
        fall = mpmath.sqrt(up**2 + 2 * g * high)
        left = along - mu * fall
        return along * (up + fall) / g + left**2 / (2 * mu * g)

    def speed_at(angle):
        return mpmath.findroot(lambda speed: distance(speed, angle) - far, 15)

    at = mpmath.findroot(lambda angle: mpmath.diff(speed_at, angle, h=mpmath.mpf("1e-8")), 0.4)
    least, greatest = travel.throw_bounds(25.0, friction=friction, height=height)
    assert float(mpmath.tan(at)) == pytest.approx(friction, rel=1e-6)
    assert least == pytest.approx(float(speed_at(at)), rel=1e-12)
    assert greatest == pytest.approx(float(speed_at(mpmath.mpf(0))), rel=1e-12)


def test_limits_that_are_known():
    """A level throw from the ground is a slide; at 45 degrees without friction in landing left a
    throw is a shot; without a distance nobody moved.
    """
    slide = travel.speed("60 ft", drag=0.66)
    least, greatest = travel.throw_bounds("60 ft", friction=0.66)
    assert greatest == pytest.approx(slide, rel=1e-15)
    assert least == pytest.approx(slide / math.sqrt(1.0 + 0.66**2), rel=1e-15)
    # At a friction of 1 nothing is left to slide at 45 degrees: v**2 = g * distance.
    shot = travel.throw_speed(30.0, friction=1.0, angle="45 deg")
    assert shot == pytest.approx(math.sqrt(GRAVITY * 30.0), rel=1e-12)
    assert travel.throw_bounds(0.0, friction=0.7) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("friction", "height", "reached"),
    [(0.99, 0.0, True), (1.01, 0.0, False), (0.9, 1.0, False), (0.8, 1.0, True)],
)
def test_no_throw_reaches_the_least_speed_above_a_friction(friction, height, reached):
    """The one at the angle whose tangent is the friction would stop where it lands; with a height
    already below a friction of 1.
    """
    angle = math.atan(friction)
    least, _ = travel.throw_bounds(5.0, friction=friction, height=height)
    if reached:
        found = travel.throw_speed(5.0, friction=friction, angle=angle, height=height)
        assert found == pytest.approx(least, rel=1e-12)
    else:
        with pytest.raises(col.NoSolutionError) as caught:
            travel.throw_speed(5.0, friction=friction, angle=angle, height=height)
        assert caught.value.code == "stops_at_landing"


def test_a_batch_has_each_case_alone_and_counts_what_cannot_be():
    """A case that is refused alone is NaN among others, by the same code."""
    far = np.array([20.0, 1.0, -3.0, 20.0, 30.0])
    friction = np.array([0.66, 0.66, 0.66, 0.0, 0.5])
    with pytest.warns(col.CollisionsWarning, match="3 of 5") as caught:
        least, greatest = travel.throw_bounds(far, friction=friction, height=1.0)
    assert "1 negative_distance, 1 never_stops, 1 stops_at_landing" in str(caught[0].message)
    for i in (0, 4):
        alone = travel.throw_bounds(far[i], friction=friction[i], height=1.0)
        assert (least[i], greatest[i]) == alone
    assert np.isnan(least[1:4]).all()
    assert np.isnan(greatest[1:4]).all()
    angles = np.radians([10.0, 80.0, 95.0])
    with pytest.warns(col.CollisionsWarning, match="2 of 3") as caught:
        found = travel.throw_speed(20.0, friction=0.66, angle=angles)
    assert "1 bad_angle, 1 stops_at_landing" in str(caught[0].message)
    assert found[0] == travel.throw_speed(20.0, friction=0.66, angle="10 deg")


@pytest.mark.parametrize(
    ("distance", "given", "error", "code"),
    [
        (-1.0, {"friction": 0.7}, col.InputError, "negative_distance"),
        (9.0, {"friction": -0.7}, col.InputError, "bad_friction"),
        (9.0, {"friction": 0.7, "height": -1}, col.InputError, "negative_length"),
        (9.0, {"friction": 0.0}, col.NoSolutionError, "never_stops"),
        (1.0, {"friction": 0.7, "height": 1}, col.NoSolutionError, "stops_at_landing"),
        (9.0, {"friction": 0.7, "angle": "90 deg"}, col.InputError, "bad_angle"),
        (9.0, {"friction": 0.7, "angle": "70 deg"}, col.NoSolutionError, "stops_at_landing"),
        (9.0, {"friction": 0.7, "angle": "-80 deg"}, col.NoSolutionError, "stops_at_landing"),
    ],
)
def test_what_cannot_be_is_refused(distance, given, error, code):
    """A single one; in a batch it is NaN by the same code."""
    throw = travel.throw_speed if "angle" in given else travel.throw_bounds
    with pytest.raises(error) as refused:
        throw(distance, **given)
    assert refused.value.code == code


@pytest.mark.filterwarnings("ignore::collisions.SuspectUnitsWarning")
@pytest.mark.parametrize(("angle", "said"), [(10.0, "'10 deg'"), (100.0, "'20 deg'")])
def test_a_bare_angle_in_degrees_is_refused_with_what_to_write(angle, said):
    with pytest.raises(col.InputError, match=f"for degrees write {said}"):
        travel.throw_speed(20.0, friction=0.7, angle=angle)


@pytest.mark.parametrize(("far", "said"), [(1.0, "before 1 m,"), ("1 ft", "before 1 ft,")])
def test_a_refusal_has_the_units_of_the_inputs(far, said):
    with pytest.raises(col.NoSolutionError, match=said):
        travel.throw_bounds(far, friction=0.7, height=far)


def test_what_no_float_holds_is_refused():
    """After the question whether another unit was meant."""
    with (
        pytest.warns(col.SuspectUnitsWarning, match="friction"),
        pytest.raises(col.InputError) as refused,
    ):
        travel.throw_bounds(1e308, friction=1e308)
    assert refused.value.code == "out_of_range"


def test_quantities():
    """Speeds with their unit, the pair too."""
    least, greatest = travel.q.throw_bounds("60 ft", friction=0.66)
    assert least.to("mph").m < greatest.to("mph").m
    assert travel.q.throw_speed("60 ft", friction=0.66, angle="0 deg").m_as("m/s") == greatest.m
