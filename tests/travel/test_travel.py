"""Run-outs: against published tables, against 50 digits, against a body integrated forward in time,
and every refusal.
"""

import bisect
import inspect
import json
import math
import pickle
import re
import warnings
from itertools import pairwise
from pathlib import Path

import mpmath
import numpy as np
import pint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import collisions as col
from collisions import travel
from strategies import other_registry

EPS = 2.0**-52
MPH, FOOT = 0.44704, 0.3048
# What sheets in US units round to 30, written out in standard gravity.
THIRTY = 2 * travel.GRAVITY * FOOT / MPH**2
run_often = settings(deadline=None, derandomize=True, database=None, max_examples=300)
lengths = st.floats(1e-3, 1e3)
drags = st.floats(0.01, 1.4)
grades = st.floats(-0.3, 0.3)
speeds = st.floats(0.0, 60.0)
FULL_LOCK = {"friction": 0.7, "lock": 1.0}
STRAIGHT = [(0.0, 0.0), (5.0, 0.0), (9.0, 0.0)]


# Published values


def test_standard_gravity_is_the_one_of_the_definition():
    """The value fixed by the 3rd General Conference on Weights and Measures; and 30 is 0.14 % of
    speed above it.
    """
    assert travel.GRAVITY == 9.80665
    assert math.sqrt(30 / THIRTY) == pytest.approx(1.0014, abs=5e-5)
    assert math.sqrt(32.2 * FOOT / travel.GRAVITY) == pytest.approx(1.0004, abs=5e-5)


# Code of Virginia, section 46.2-880: speed [mph], braking distance of automobiles [ft].
VIRGINIA = [
    (10, 5), (15, 11), (20, 19), (25, 30), (30, 43), (35, 58), (40, 76), (45, 96), (50, 119),
        (55, 144), (60, 171), (65, 201),
    (70, 233), (75, 268), (80, 305), (85, 344),
]  # fmt: skip


@pytest.mark.parametrize(("mph", "feet"), VIRGINIA)
def test_the_stopping_distances_of_the_code_of_virginia(mph, feet):
    """The table is in whole feet with 30 for the constant, at a drag factor of 0.7 by its longest
    row (85**2 / 30 / 344).
    """
    found = travel.distance(f"{mph} mph", drag=0.7) / FOOT
    assert found * THIRTY / 30 == pytest.approx(feet, abs=0.5)


def test_the_skid_of_a_test_question():
    """gauthmath.com: 65 mph on dry asphalt of 0.8 leaves skids of 176 ft, in whole feet, with 30 or
    32.2 ft/s2.
    """
    assert travel.distance("65 mph", drag=0.8) / FOOT * THIRTY / 30 == pytest.approx(176, abs=0.5)


@pytest.mark.parametrize(
    ("feet", "end", "drag", "published", "within"),
    [
        # e-z.net/~ts/speedch.htm, read from a chart: 40 ft is about 30 mph; 60 ft into a 30 mph
        # impact about 46 to 48.
        (40, 0, 0.7, 29, 0.5),
        (40, 0, 0.8, 31, 0.5),
        (60, 30, 0.7, 46.5, 0.5),
        (60, 30, 0.8, 48.5, 0.5),
        # e-z.net/~ts/combine.htm: 30 mph lost in one slide, then 20, then 10, is 37 mph in whole
        # miles per hour.
        (30**2 / THIRTY / 0.7, math.hypot(20, 10), 0.7, 37, 0.5),
    ],
)
def test_published_slides(feet, end, drag, published, within):
    """To the digits that were printed; the 0.14 % between 30 and the exact constant is
    below them.
    """
    found = travel.speed(feet * FOOT, drag=drag, end_speed=end * MPH) / MPH
    assert found == pytest.approx(published, abs=within)


def test_the_metric_sheet_of_the_ontario_police():
    """S = 15.9 sqrt((f + e) d) in km/h, from J. Twelves, Skid to Stop Formula; 15.9 is rounded by
    up to 0.05 in 15.9.
    """
    found = 3.6 * travel.speed(20.0, drag=0.65, grade=-0.04)
    assert found == pytest.approx(15.9 * math.sqrt(0.61 * 20), rel=0.05 / 15.9)


def test_the_slide_after_the_inline_collision_of_tar_origin():
    """Example L14: 66 ft at 0.65 is 35.8748 mph with 30 f d, exactly sqrt(30 / 29.9139) above ours;
    rel for its 6 digits.
    """
    found = travel.speed("66 ft", drag=0.65) / MPH
    assert found * math.sqrt(30 / THIRTY) == pytest.approx(35.8748, rel=2e-6)
    cases = json.loads(
        (Path(__file__).parents[2] / "validation" / "data" / "worked_examples.json").read_text(
            "utf-8"
        )
    )
    (example,) = (
        case
        for case in (cases if isinstance(cases, list) else cases["cases"])
        if case["id"] == "L14"
    )
    assert example["recomputed_outputs"]["v_common"] == {"value": 35.8748, "unit": "mph"}


# Against 50 digits


def exact(segments, end):
    """Speeds from start to end and the times between, in 50 digits."""
    with mpmath.workdps(50):
        square = mpmath.mpf(end) ** 2
        found = [mpmath.sqrt(square)]
        for d, f, g in reversed(segments):
            square += (
                2 * mpmath.mpf(travel.GRAVITY) * (mpmath.mpf(f) + mpmath.mpf(g)) * mpmath.mpf(d)
            )
            found.append(mpmath.sqrt(square) if square >= 0 else mpmath.nan)
        found.reverse()
        slopes = [d * mpmath.sqrt(1 + mpmath.mpf(g) ** 2) for d, _, g in segments]
        times = [2 * s / (a + b) for s, a, b in zip(slopes, found, found[1:], strict=False)]
        return found, times


@pytest.mark.slow
@run_often
@given(st.lists(st.tuples(lengths, st.floats(0.31, 1.4), grades), min_size=1, max_size=6), speeds)
def test_speed_and_time_keep_their_digits(segments, end):
    """2 eps for the speed gained over a segment, one more for each sum of squares; the times add
    three: one and a half each for the length of the slope and for the quotient."""
    given_ = {
        "drag": [f for _, f, _ in segments],
        "grade": [g for _, _, g in segments],
        "end_speed": end,
    }
    start = travel.speed([d for d, _, _ in segments], **given_)
    duration = travel.time([d for d, _, _ in segments], **given_)
    found, times = exact(segments, end)
    assert start == pytest.approx(float(found[0]), rel=(2 + len(segments)) * EPS)
    assert duration == pytest.approx(float(sum(times)), rel=(5 + len(segments)) * EPS)
    assert type(start) is type(duration) is float


@pytest.mark.slow
@run_often
@given(lengths, st.floats(0.0, 0.1), st.floats(-0.4, -0.11), speeds)
def test_downhill_beyond_the_drag_the_condition_is_all_that_is_lost(d, f, g, end):
    """2 eps in each of two squares that are subtracted: 4 eps times their sum over their
    difference, and 1 for the product.
    """
    (start, _), _ = exact([(d, f, g)], end)
    if mpmath.isnan(start) or start < 1e-3:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            if mpmath.isnan(start):
                with pytest.raises(col.NoSolutionError):
                    travel.speed(d, drag=f, grade=g, end_speed=end)
        return
    condition = (2 * end**2 - float(start) ** 2) / float(start) ** 2
    assert travel.speed(d, drag=f, grade=g, end_speed=end) == pytest.approx(
        float(start), rel=(1 + 4 * condition) * EPS
    )


@pytest.mark.slow
@run_often
@given(speeds, speeds, drags, grades)
def test_distance_keeps_its_digits(one, other, f, g):
    """Six roundings of half an eps."""
    if f + g == 0.0:
        return
    start, end = (
        (max(one, other), min(one, other)) if f + g > 0 else (min(one, other), max(one, other))
    )
    with mpmath.workdps(50):
        work = 2 * mpmath.mpf(travel.GRAVITY) * (mpmath.mpf(f) + mpmath.mpf(g))
        wanted = float((mpmath.mpf(start) ** 2 - mpmath.mpf(end) ** 2) / work)
    assert travel.distance(start, drag=f, grade=g, end_speed=end) == pytest.approx(
        wanted, rel=3 * EPS, abs=5e-324
    )


def test_nearly_equal_speeds_keep_their_difference():
    """(v - u)(v + u), not the difference of squares, which would have lost six digits here."""
    wanted = (2e-9 * 60.0) / (2 * travel.GRAVITY * 0.7)
    found = travel.distance(30.0 + 2e-9, drag=0.7, end_speed=30.0)
    # 2e-9 itself is rounded when it is added to 30, to 1.8e-15.
    assert found == pytest.approx(wanted, rel=2e-6)
    assert found == pytest.approx(
        ((30.0 + 2e-9) - 30.0) * (60.0 + 2e-9) / (2 * travel.GRAVITY * 0.7), rel=4 * EPS
    )


@pytest.mark.parametrize(
    ("d", "f"), [(1e300, 1e-10), (1e-300, 1e10), (1e200, 1e-200), (1e-160, 1e-160), (1e308, 100.0)]
)
@pytest.mark.filterwarnings("ignore::collisions.SuspectUnitsWarning")
def test_products_do_not_overflow_where_the_answer_does_not(d, f):
    """The roots are taken before the product."""
    with mpmath.workdps(50):
        wanted = float(mpmath.sqrt(2 * mpmath.mpf(travel.GRAVITY) * mpmath.mpf(d) * mpmath.mpf(f)))
    assert travel.speed(d, drag=f) == pytest.approx(wanted, rel=3 * EPS)
    assert travel.speed(d, drag=0, grade=-f, end_speed=2 * wanted) == pytest.approx(
        math.sqrt(3) * wanted, rel=6 * EPS
    )


# Identities


@run_often
@given(lengths, drags, st.floats(0.0, 0.3), speeds)
def test_there_and_back(d, f, g, end):
    """distance undoes speed; where hardly any speed is lost, a distance is as uncertain as the
    speeds: 8 eps of v**2.
    """
    start = travel.speed(d, drag=f, grade=g, end_speed=end)
    back = travel.distance(start, drag=f, grade=g, end_speed=end)
    assert back == pytest.approx(d, abs=8 * EPS * (d + start**2 / (2 * travel.GRAVITY * (f + g))))


@pytest.mark.slow
@run_often
@given(st.floats(1.0, 100.0), st.floats(0.01, 0.99), drags, st.floats(0.0, 0.3), speeds)
def test_a_segment_cut_in_two_is_the_same_segment(d, share, f, g, end):
    """Energy does not know where the cut is; 6 eps for two segments against one."""
    parts = [share * d, d - share * d]
    for ask in (travel.speed, travel.time):
        whole = ask(d, drag=f, grade=g, end_speed=end)
        assert ask(parts, drag=f, grade=[g, g], end_speed=end) == pytest.approx(whole, rel=6 * EPS)


@pytest.mark.slow
@run_often
@given(lengths, drags, speeds)
def test_the_time_is_the_change_of_speed_over_the_deceleration(d, f, end):
    """A second route to the time, which cancels where the speed hardly changes."""
    start, duration = (ask(d, drag=f, end_speed=end) for ask in (travel.speed, travel.time))
    rate = travel.GRAVITY * f
    assert duration == pytest.approx((start - end) / rate, rel=8 * EPS, abs=8 * EPS * start / rate)


def slid_down(slopes, end, steps=200):
    """A point mass followed back in time over inclined planes, by the forces on it: weight, load
    across the plane, and drag.

    Of each slope drag, grade and duration, the last one first. Plan distances, speed, and how long
    it took; Runge-Kutta, which is exact where a force is constant.
    """
    speed, plans = end, []
    for drag, grade, duration in slopes:
        angle = math.atan(grade)
        along, across = (
            np.array([math.cos(angle), math.sin(angle)]),
            np.array([-math.sin(angle), math.cos(angle)]),
        )
        weight = np.array([0.0, -9.80665])
        load = -(weight @ across)

        def rate(velocity, weight=weight, across=across, load=load, drag=drag):
            return weight + load * across - drag * load * velocity / np.hypot(*velocity)

        step = -duration / steps
        place, velocity = np.zeros(2), speed * along
        for _ in range(steps):
            k1 = rate(velocity)
            k2 = rate(velocity + step / 2 * k1)
            k3 = rate(velocity + step / 2 * k2)
            k4 = rate(velocity + step * k3)
            place = place + step * velocity + step**2 / 6 * (k1 + k2 + k3)
            velocity = velocity + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        plans.append(-float(place[0]))
        speed = float(np.hypot(*velocity))
    return plans, speed, sum(duration for _, _, duration in slopes)


@pytest.mark.parametrize(
    "slopes",
    [
        [(0.7, 0.1, 1.5)],
        [(0.6, -0.2, 2.0)],
        [(0.45, 0.3, 0.8), (0.7, -0.08, 1.1), (0.2, -0.25, 0.7)],
        [(0.0, -0.2, 3.0)],
    ],
)
def test_speed_time_and_distance_are_those_of_a_body_on_inclined_planes(slopes):
    """Lengths of the plan, speeds along the slope, times over it; 200 steps of some roundings each
    are below 1e-12.
    """
    end = 12.0 if slopes[0][0] else 30.0
    plans, start, duration = slid_down(slopes, end)
    ground = {
        "drag": [drag for drag, _, _ in slopes][::-1],
        "grade": [grade for _, grade, _ in slopes][::-1],
    }
    assert travel.speed(plans[::-1], **ground, end_speed=end) == pytest.approx(start, rel=1e-12)
    assert travel.time(plans[::-1], **ground, end_speed=end) == pytest.approx(duration, rel=1e-12)
    if len(slopes) == 1:
        drag, grade, _ = slopes[0]
        found = travel.distance(start, drag=drag, grade=grade, end_speed=end)
        # From a difference of speeds: of two squares, each of a speed that is off by 1e-12.
        assert found == pytest.approx(
            plans[0], rel=4e-12 * (start**2 + end**2) / abs(start**2 - end**2)
        )


def test_times_and_yaw_rate_of_a_path_are_those_over_the_slope():
    """A body that yaws evenly down two slopes: its own times and rate; 1e-12 as above, and sums and
    quotients of them.
    """
    slopes = [(0.7, -0.2, 1.2), (0.7, 0.15, 0.9)]
    (last, first), start, duration = slid_down(slopes, 5.0)
    run = travel.path(
        [(0.0, 0.0), (first, 0.0), (first + last, 0.0)],
        [0.0, 0.9 * 0.8, (0.9 + 1.2) * 0.8],
        friction=0.7,
        lock=1.0,
        grade=[0.15, -0.2],
        end_speed=5.0,
    )
    assert run.speed == pytest.approx(start, rel=1e-12)
    assert run.time == pytest.approx(duration, rel=1e-12)
    assert run.yaw_rate == pytest.approx(0.8, rel=1e-11)
    assert run.distance == pytest.approx(first + last, rel=4 * EPS)


def test_order_of_surfaces_matters_to_the_time_only():
    """The speed at the start is the same either way; ice first takes less time, because it is
    crossed fast.
    """
    one = {"distance": [10.0, 20.0], "drag": [0.7, 0.2]}
    other = {"distance": [20.0, 10.0], "drag": [0.2, 0.7]}
    assert travel.speed(one["distance"], drag=one["drag"]) == pytest.approx(
        travel.speed(other["distance"], drag=other["drag"]), rel=4 * EPS
    )
    assert travel.time(one["distance"], drag=one["drag"]) > 1.2 * travel.time(
        other["distance"], drag=other["drag"]
    )


def test_nothing_happens_over_no_distance():
    """0 s, also where nothing moves and nothing slows."""
    assert travel.time(0, drag=0) == 0.0
    assert travel.time([0.0, 0.0], drag=0.7, end_speed=3) == 0.0
    assert travel.speed(0, drag=0.7, end_speed=3) == 3.0
    assert travel.distance(3.0, drag=0.7, end_speed=3.0) == 0.0
    assert travel.time(10.0, drag=0, end_speed=5.0) == 2.0
    # Coasting keeps the very bits, which the root of 2.0 squared would not; and no distance is not
    # minus nothing.
    assert travel.speed(10.0, drag=0, end_speed=2.0) == 2.0
    assert math.copysign(1.0, travel.distance(3.0, drag=0.1, grade=-0.2, end_speed=3.0)) == 1.0


# Units


def test_units_of_every_kind():
    """US units, percent, decelerations, and Quantities of another registry give the same floats; 4
    eps for the factors.
    """
    other = other_registry()
    wanted = travel.speed(60 * FOOT, drag=0.62, grade=-0.05, end_speed=30 * MPH)
    for arguments in (
        {"distance": "60 ft", "drag": "62 %", "grade": "-5 %", "end_speed": "30 mph"},
        {
            "distance": other.Quantity(720, "inch"),
            "drag": other.Quantity(62, "percent"),
            "grade": -0.05,
            "end_speed": "44 ft/s",
        },
        {
            "distance": "60 ft",
            "drag": f"{0.62 * travel.GRAVITY!r} m/s**2",
            "grade": -0.05,
            "end_speed": "30 mph",
        },
        {
            "distance": "60 ft",
            "drag": other.Quantity(0.62, "g_0"),
            "grade": -0.05,
            "end_speed": "30 mph",
        },
        {
            "distance": "60 ft",
            "drag": pint.Quantity(0.62 * travel.GRAVITY / FOOT, "ft/s**2"),
            "grade": "-0.05",
            "end_speed": "30 mph",
        },
    ):
        assert travel.speed(**arguments) == pytest.approx(wanted, rel=4 * EPS)
    assert travel.speed(
        [other.Quantity(60, "ft")], drag=["62 %"], grade=["-5 %"], end_speed="30 mph"
    ) == pytest.approx(wanted, rel=4 * EPS)


def test_a_deceleration_is_taken_on_the_level():
    """6.5 m/s**2 up a grade of 10 % slows by 6.5 + 0.98 m/s**2."""
    rate = 6.5 + 0.1 * travel.GRAVITY
    assert travel.distance(20.0, drag="6.5 m/s**2", grade=0.1) == pytest.approx(
        200.0 / rate, rel=4 * EPS
    )


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            {"drag": 6.9},
            (
                "drag = 6.9 is read as a fraction of gravity; if another unit was meant, write "
                "'6.9 m/s**2' or '6.9 %'"
            ),
        ),
        ({"drag": np.array([0.7, 70.0, math.nan])}, "'70 m/s**2' or '70 %'"),
        (
            {"drag": 0.7, "grade": -4},
            "grade = -4 is read as the rise over the run; if another unit was meant, write '-4 %'",
        ),
    ],
)
@pytest.mark.filterwarnings("ignore:1 of 3 cases")
def test_bare_numbers_of_a_suspect_size(arguments, said):
    """Read as what they are, with a warning; the same with a unit is beyond suspicion."""
    arguments = {"end_speed": 100.0, **arguments}
    with pytest.warns(col.SuspectUnitsWarning, match=re.escape(said)) as caught:
        travel.speed(10, **arguments)
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        travel.speed(10, drag="60 m/s**2", grade="60 %")


# Refusals


def refusal(call):
    """The error a call raises."""
    with pytest.raises(col.CollisionsError) as caught:
        call()
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.code, str(again)) == (caught.value.code, str(caught.value))
    return caught.value


@pytest.mark.parametrize(
    ("distance", "rest", "code", "said"),
    [
        (-1, {"drag": 0.7}, "negative_distance", "distance must be >= 0, got -1"),
        ("-3 ft", {"drag": 0.7}, "negative_distance", "got '-3 ft'"),
        ([1, -2], {"drag": 0.7}, "negative_distance", "distance[1] must be >= 0, got -2"),
        (1, {"drag": -0.7}, "negative_drag", "drag must be >= 0, got -0.7"),
        (1, {"drag": "-7 m/s**2"}, "negative_drag", "how much the ground slows the vehicle"),
        (1, {"drag": 0.7, "end_speed": -1}, "negative_speed", "end_speed must be >= 0, got -1"),
        (math.nan, {"drag": 0.7}, "not_finite", "distance is NaN"),
        (1, {"drag": math.inf}, "not_finite", "drag must be finite"),
        (1, {"drag": 0.7, "grade": math.nan}, "not_finite", "grade is NaN"),
        (1, {"drag": True}, "not_a_number", "drag must be a number"),
        (1, {"drag": None}, "not_a_number", "drag must be a number"),
        ("5 kg", {"drag": 0.7}, "bad_units", "'5 kg' cannot be taken as m"),
        (
            1,
            {"drag": "5 m"},
            "bad_units",
            (
                "drag: cannot read '5 m' as a drag factor or a deceleration; write 0.7, '70 %', "
                "'6.9 m/s**2'"
            ),
        ),
        (1, {"drag": "x"}, "bad_units", "'22.5 ft/s**2'"),
        (1, {"drag": 0.7, "grade": "3 deg"}, "bad_units", "grade: '3 deg'"),
        ([], {"drag": 0.7}, "bad_shape", "distance is an empty list"),
        (5.0, {"drag": []}, "bad_shape", "drag is a list"),
        (
            [1, 2, 3],
            {"drag": [0.7, 0.5]},
            "bad_shape",
            "drag is a list of 2, and there are 3 segments",
        ),
        (
            (1, 2),
            {"drag": 0.7, "grade": (0.1,)},
            "bad_shape",
            "grade is a tuple of 1, and there are 2 segments",
        ),
        (
            1,
            {"drag": [0.7, 0.5]},
            "bad_shape",
            "distance is one surface; give distance as a list too",
        ),
        ([1, [2, 3]], {"drag": 0.7}, "bad_shape", "distance[1] is a list, and takes one value"),
        (
            1,
            {"drag": 0.7, "end_speed": [1, 2]},
            "bad_shape",
            "end_speed is a list, and takes one value",
        ),
        (np.ones(3), {"drag": np.ones(2)}, "bad_shape", "distance (3,), drag (2,)"),
        ([np.ones(3), 1.0], {"drag": np.ones(2)}, "bad_shape", "distance[0] (3,), drag (2,)"),
        (
            10,
            {"drag": 0},
            "contradictory",
            "nothing slows the vehicle there, and it is to come to rest",
        ),
        (
            10,
            {"drag": 0.02, "grade": -0.05},
            "contradictory",
            "from rest already to 2.4257 m/s, and is to end at 0 m/s; the square of its speed",
        ),
        (
            [5, 10],
            {"drag": 0.1, "grade": [0, -0.2], "end_speed": 1},
            "contradictory",
            "distance[1]: drag + grade is -0.1",
        ),
        (
            1e308,
            {"drag": 1.0, "end_speed": 1.7e308, "grade": 1e308},
            "out_of_range",
            "too large or too small",
        ),
        (1e308, {"drag": 9e306, "end_speed": 1.7e308}, "out_of_range", "too large or too small"),
    ],
)
@pytest.mark.filterwarnings("ignore::collisions.SuspectUnitsWarning")
def test_refused_run_outs(distance, rest, code, said):
    """Neither a speed nor a time comes of them, and the message says what to write."""
    for ask in (travel.speed, travel.time):
        error = refusal(lambda ask=ask: ask(distance, **rest))
        assert error.code == code
        assert said in str(error)
        assert isinstance(error, ValueError)


def test_the_refusal_says_by_how_much():
    """A vehicle that ends at 1 m/s after 10 m down a net grade of 3 %: 1 - 2 g 0.03 10
    = -4.88399.
    """
    error = refusal(lambda: travel.speed(10, drag=0.02, grade=-0.05, end_speed=1.0))
    assert isinstance(error, col.NoSolutionError)
    # -0.03 is the rounded sum of two decimals, 1 eps of 0.05 beside it.
    assert error.fields["missing"] == pytest.approx(
        1.0 - 2 * travel.GRAVITY * 0.03 * 10, rel=16 * EPS
    )


def test_refusals_have_the_units_of_the_inputs():
    """A speed in mph and a height in feet come back as such."""
    slope = {"drag": 0.1, "grade": -0.2}
    survey = [("0 ft", "0 ft"), ("20 ft", "0 ft")], ["0 deg", "10 deg"]
    for ask, said in (
        (lambda: travel.speed("30 ft", **slope), "already to 9.47321 mph, and is to end at 0 mph"),
        (lambda: travel.path(*survey, friction=0.1, lock=1, grade=-0.5), "already to 15.4697 mph"),
        (
            lambda: travel.distance("30 mph", drag=0.1, end_speed="40 mph"),
            "end_speed 40 mph is above speed 30 mph",
        ),
        (lambda: travel.distance("30 mph", **slope, end_speed="20 mph"), "never slows to 20 mph"),
        (lambda: travel.distance("30 mph", drag=0.0, end_speed="30 mph"), "keeps its 30 mph over"),
        (
            lambda: travel.Tyres(0.7, 0, "9 ft", "5 ft", height="9 ft"),
            "height is 9 ft, and from 3.12 ft on a wheel lifts off",
        ),
    ):
        assert said in str(refusal(ask))


def test_all_wrong_arguments_are_named_at_once():
    """One error, one line for each."""
    text = str(refusal(lambda: travel.speed("x", drag="y", grade="z", end_speed="10 km")))
    assert text.startswith("4 arguments cannot be used")
    for name in ("distance", "drag", "grade", "end_speed"):
        assert f"\n- {name}: " in text


@pytest.mark.parametrize(
    ("speed", "rest", "code", "said"),
    [
        (10, {"drag": 0}, "never_stops", "the vehicle never stops: drag + grade is 0"),
        (10, {"drag": 0.1, "grade": -0.1, "end_speed": 2}, "never_stops", "never slows to 2 m/s"),
        (10, {"drag": 0.1, "grade": -0.2}, "never_stops", "drag + grade is -0.1"),
        (
            10,
            {"drag": 0.7, "end_speed": 12},
            "contradictory",
            "end_speed 12 m/s is above speed 10 m/s",
        ),
        (10, {"drag": 0, "end_speed": 12}, "contradictory", "does not speed the vehicle up"),
        (10, {"drag": 0, "end_speed": 10}, "any_distance", "keeps its 10 m/s over any distance"),
        (-10, {"drag": 0.7}, "negative_speed", "speed must be >= 0"),
        (
            [10, 20],
            {"drag": 0.7},
            "bad_shape",
            "speed is a list, and takes one value; many cases go in a numpy array",
        ),
        (10, {"drag": [0.7]}, "bad_shape", "drag is a list, and takes one value"),
        (np.ones(3), {"drag": np.ones(2)}, "bad_shape", "speed (3,), drag (2,)"),
        (1e200, {"drag": 0.7}, "out_of_range", "too large"),
        (20, {"drag": "1e308 m/s**2"}, "out_of_range", "too large"),
    ],
)
def test_refused_distances(speed, rest, code, said):
    """No distance comes of them."""
    error = refusal(lambda: travel.distance(speed, **rest))
    assert error.code == code
    assert said in str(error)


# Many cases


@pytest.mark.slow
def test_a_batch_is_its_cases():
    """Every argument an array, broadcast, against the scalar calls; math and numpy differ by an ulp
    in hypot.
    """
    d, f = np.linspace(1, 60, 7), np.array([[0.3], [0.8]])
    g, end = np.array([[[-0.1]], [[0.0]], [[0.1]]]), np.linspace(0, 20, 7)
    for ask in (travel.speed, travel.time):
        batch = ask(d, drag=f, grade=g, end_speed=end)
        parts = ask([d, 2.0], drag=[f, "5 m/s**2"], grade=[g, 0.0], end_speed=end)
        assert batch.shape == parts.shape == (3, 2, 7)
        for index in np.ndindex(3, 2, 7):
            case = [float(np.broadcast_to(x, (3, 2, 7))[index]) for x in (d, f, g, end)]
            one = ask(case[0], drag=case[1], grade=case[2], end_speed=case[3])
            two = ask(
                [case[0], 2.0], drag=[case[1], "5 m/s**2"], grade=[case[2], 0.0], end_speed=case[3]
            )
            assert batch[index] == pytest.approx(one, rel=4 * EPS)
            assert parts[index] == pytest.approx(two, rel=4 * EPS)
    back = travel.distance(travel.speed(d, drag=f, end_speed=end), drag=f, end_speed=end)
    assert back == pytest.approx(np.broadcast_to(d, (2, 7)), rel=1e-13)


def test_cases_without_an_answer_are_nan_and_counted_once():
    """Their neighbours are untouched."""
    d = np.array([10.0, -1.0, math.nan, 10.0, 10.0, math.inf])
    f = np.array([0.7, 0.7, 0.7, 0.0, -0.1, 0.7])
    with pytest.warns(
        col.CollisionsWarning, match="5 of 6 cases cannot be answered and are NaN"
    ) as caught:
        found = travel.speed(d, drag=f)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert caught[0].message.fields["counts"] == {
        "not_finite": 2,
        "negative_distance": 1,
        "negative_drag": 1,
        "contradictory": 1,
    }
    assert found[0] == pytest.approx(travel.speed(10, drag=0.7), rel=2 * EPS)
    assert np.isnan(found[1:]).all()
    # Locked, as it is without refused cases.
    assert not found.flags.writeable
    assert not travel.speed(d[:1], drag=f[:1]).flags.writeable
    # Arrays of their own, where one number is that of every case.
    same = travel.path(
        [(0.0, 0.0), (5.0, 0.5)], [0.1, 0.2], friction=np.array([0.5, 0.6]), lock=1.0
    )
    assert same.distance.flags.c_contiguous
    assert not same.distance.flags.writeable
    with pytest.warns(col.CollisionsWarning, match="5 of 6"):
        assert np.isnan(travel.time(d, drag=f)).tolist() == [False, *[True] * 5]


def test_one_reason_may_come_from_several_arguments():
    """NaN in two arrays, in two cases."""
    with pytest.warns(
        col.CollisionsWarning,
        match=re.escape("2 of 3 cases cannot be answered and are NaN (2 not_finite)"),
    ):
        travel.speed(np.array([1.0, math.nan, 1.0]), drag=np.array([0.7, 0.7, math.inf]))


def test_distances_without_an_answer_are_nan():
    """Also those that only one argument as an array makes many."""
    with pytest.warns(col.CollisionsWarning, match="4 of 5 cases") as caught:
        found = travel.distance(
            10.0, drag=0.1, grade=np.array([0.0, -0.1, -0.2, math.nan, -math.inf]), end_speed=5
        )
    assert caught[0].message.fields["counts"] == {"not_finite": 2, "contradictory": 2}
    assert np.isnan(found).tolist() == [False, True, True, True, True]
    with pytest.warns(col.CollisionsWarning, match="1 of 2 cases"):
        assert np.isnan(travel.distance(np.array([1e200, 1.0]), drag=0.7)).tolist() == [True, False]


def test_a_wrong_scalar_is_wrong_for_every_case():
    """It raises, whatever the arrays beside it."""
    assert refusal(lambda: travel.speed(np.ones(3), drag=-1.0)).code == "negative_drag"
    assert (
        refusal(lambda: travel.speed([np.ones(3), 10.0], drag=[0.7, 0.0])).code == "contradictory"
    )


def test_arrays_stay_what_they_are():
    """float32 stays float32, an empty array is an answer, and what was given is not changed."""
    given_ = np.array([1.0, 2.0], np.float32)
    assert travel.speed(given_, drag=0.7).dtype == np.float32
    with pytest.warns(col.CollisionsWarning, match="1 of 2"):
        assert travel.speed(-given_ + np.float32(1.5), drag=0.7).dtype == np.float32
    assert travel.speed(np.array([]), drag=0.7).shape == (0,)
    assert given_.tolist() == [1.0, 2.0]
    assert travel.speed(pint.Quantity([1.0, 2.0], "ft"), drag=0.7).shape == (2,)


# Paths


def test_straight_with_locked_wheels_it_is_the_speed():
    """Whatever the heading, locked wheels drag alike; 6 eps for the sine and cosine of the crab
    angle.
    """
    for heading in (0.0, 0.3, math.pi / 2, 2.5, -3.0):
        run = travel.path(
            STRAIGHT, [heading] * 3, friction=[0.7, 0.5], lock=1, grade=[0.0, 0.05], end_speed=4.0
        )
        wanted = travel.speed([5.0, 4.0], drag=[0.7, 0.5], grade=[0.0, 0.05], end_speed=4.0)
        assert run.speed == run.speeds[0] == pytest.approx(wanted, rel=6 * EPS)
        assert run.time == pytest.approx(
            travel.time([5.0, 4.0], drag=[0.7, 0.5], grade=[0.0, 0.05], end_speed=4.0), rel=6 * EPS
        )
        assert (run.course, run.yaw_rate, run.course_difference, run.distance) == (
            0.0,
            0.0,
            0.0,
            9.0,
        )
        assert run.speeds[-1] == 4.0


def most_work(crab, friction, lock):
    """The largest work against the slip of a force in the friction circle that the brake can hold,
    by trying 200 001 forces.
    """
    angle = np.linspace(0.0, 2.0 * math.pi, 200_001)
    held = np.abs(np.cos(angle)) <= lock + 1e-15
    ends = np.array(
        [math.acos(lock), -math.acos(lock), math.pi - math.acos(lock), math.pi + math.acos(lock)]
    )
    angle = np.concatenate([angle[held], ends])
    return float(
        np.max(friction * (np.cos(angle) * math.cos(crab) + np.sin(angle) * math.sin(crab)))
    )


@pytest.mark.parametrize("lock", [0.0, 0.1, 0.35, 0.8, 1.0])
@pytest.mark.parametrize("degrees", [0, 10, 45, 90, 120, 180, 250, -60])
def test_the_drag_is_the_most_work_of_what_the_brake_and_the_circle_allow(lock, degrees):
    """The same force by search; the step of 3e-5 rad misses at most its square over 8 of the
    maximum.
    """
    crab = math.radians(degrees)
    wanted = most_work(crab, 0.8, lock)
    run = travel.path([(0, 0), (0, 10)], ["90 deg"] * 2, friction=0.8, lock=1, end_speed=5)
    assert run.drags == (0.8,)
    run = travel.path(
        [(0, 0), (10, 0)], [f"{degrees} deg"] * 2, friction=0.8, lock=lock, end_speed=5
    )
    assert run.drags[0] == pytest.approx(wanted, abs=2e-10)
    assert math.cos(run.crab_angles[0]) == pytest.approx(math.cos(crab), abs=2 * EPS)
    assert math.sin(run.crab_angles[0]) == pytest.approx(math.sin(crab), abs=4 * EPS)


def test_the_drag_has_the_limits_published_for_the_crash_equation():
    """Rose, Rollover Accident Reconstruction, CRASH Model: the braking level at no sideslip, 1 at
    90 deg or full braking.
    """

    def normalised(degrees, lock):
        (drag,) = travel.path(
            [(0, 0), (10, 0)], [f"{degrees} deg"] * 2, friction=0.8, lock=lock, end_speed=1
        ).drags
        return drag / 0.8

    for lock in (0.0, 0.2, 0.6):
        assert normalised(0, lock) == pytest.approx(lock, abs=2 * EPS)
        assert normalised(90, lock) == pytest.approx(1.0, rel=2 * EPS)
        rising = [normalised(degrees, lock) for degrees in range(0, 91, 5)]
        assert all(after >= before - 2 * EPS for before, after in pairwise(rising))
    for degrees in (0, 20, 45, 70, 90):
        assert normalised(degrees, 1) == pytest.approx(1.0, rel=2 * EPS)
        # Without braking it is the sine of the sideslip.
        assert normalised(degrees, 0) == pytest.approx(math.sin(math.radians(degrees)), abs=2 * EPS)


def slide(
    lock, friction=0.7, start=18.0, yaw_rate=3.0, course=0.4, bend=0.02, duration=1.4, steps=2800
):
    """A body integrated forward: its path bends by ``bend`` rad/m, its yaw rate falls, and its
    braked tyres drag.

    Classical Runge-Kutta; with this step its error is below 1e-9, which halving the step confirms.
    The vehicle points to the left of its way throughout, where the drag has no kink.
    """

    def heading(t):
        return 0.6 + yaw_rate * t - 0.8 * t * t

    def rates(t, state):
        _, _, v, way = state
        crab = heading(t) - way
        ahead, aside = math.cos(crab), math.sin(crab)
        held = min(lock, abs(ahead))
        decel = 9.80665 * friction * (held * abs(ahead) + math.sqrt(1.0 - held * held) * abs(aside))
        return np.array([v * math.cos(way), v * math.sin(way), -decel, bend * v])

    step = duration / steps
    state = np.array([2.0, -1.0, start, course])
    states = [state]
    for i in range(steps):
        t = i * step
        k1 = rates(t, state)
        k2 = rates(t + step / 2, state + step / 2 * k1)
        k3 = rates(t + step / 2, state + step / 2 * k2)
        k4 = rates(t + step, state + step * k3)
        state = state + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        states.append(state)
    return np.array(states), np.array([heading(i * step) for i in range(steps + 1)])


@pytest.mark.slow
@pytest.mark.parametrize("lock", [0.0, 0.3, 1.0])
def test_a_body_integrated_forward_is_found_backward(lock):
    """Without smoothing the error falls fourfold when the points are twice as many, and is small
    with 28 segments.
    """
    states, headings = slide(lock)
    finer, _ = slide(lock, steps=5600)
    assert np.max(np.abs(finer[::2] - states)) < 1e-9
    errors = []
    for every in (400, 200, 100, 50):
        run = travel.path(
            states[::every, :2],
            headings[::every],
            friction=0.7,
            lock=lock,
            end_speed=float(states[-1, 2]),
            window=0,
        )
        errors.append(
            [
                abs(run.speed - 18.0),
                abs(run.course - 0.4),
                abs(run.yaw_rate - 3.0),
                abs(run.time - 1.4),
            ]
        )
    # The crab angle is a mean, the chord shorter than the arc, the tangents parabolas: all of
    # second order, a factor of 16 in two steps in the limit. 10 allows for the terms of higher
    # order; a method of first order would have 4.
    coarse, middle, fine, finest = np.array(errors)
    assert np.all(fine < coarse / 10), errors
    assert np.all(finest < middle / 10), errors
    # With 28 segments the crab angle changes by at most 2.5 / 28 in each, so the drag of its mean
    # is off by 0.09**2 / 24 = 3.4e-4: of at most 9.6 m/s lost, of the 1.4 s, and of the 3 rad/s.
    # The tangent by 0.9 m * 1.8 m * 0.02**2 / 6.
    assert np.all(fine < [3.3e-3, 1.1e-4, 1e-3, 4.8e-4]), errors


@pytest.mark.slow
@pytest.mark.parametrize(
    ("locks", "yaw_rate"),
    [([1.0, 0.05, 0.05, 0.05], 3.0), ([0.5, 0.1, 0.5, 0.1], -2.0), ([0.6, 0.6, 0.1, 0.1], 1.0)],
)
@pytest.mark.parametrize("rotating", [0.0, 0.03])
def test_with_its_four_wheels_a_path_goes_back_to_the_speed_that_led_to_it(
    locks, yaw_rate, rotating
):
    """Forward by ``simulate`` on the same wheels, back from 41 points of the way: within 1.5 %,
    where the mean lock of the wheels is off by more.
    """
    car = col.Vehicle(
        mass=1500.0, yaw_inertia=2400.0, x=0.0, y=0.0, heading=0.0, vx=15.0, vy=1.5,
        yaw_rate=yaw_rate,
    )  # fmt: skip
    tyres = travel.Tyres(0.7, locks, 2.7, 1.5)
    way = travel.simulate(car, tyres, rotating_mass=rotating, moments=2001)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(way.x), np.diff(way.y)))])
    at = np.linspace(0.0, along[-1], 41)
    x, y, heading = (np.interp(at, along, part) for part in (way.x, way.y, way.heading))
    points = list(zip(x.tolist(), y.tolist(), strict=True))
    found = travel.path(points, heading.tolist(), tyres=tyres, rotating_mass=rotating)
    assert found.speed == pytest.approx(math.hypot(15.0, 1.5), rel=0.015)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.OutOfRangeWarning)
        mean = travel.path(points, heading.tolist(), friction=0.7, lock=sum(locks) / 4.0)
    assert abs(mean.speed - found.speed) > 0.1


def test_wheels_that_turn_count_in_a_path_as_so_much_more_mass():
    """Straight: half the square of the speed times one and a bit is what the brakes took."""
    for wheels in ({"friction": 0.7, "lock": 0.2}, {"tyres": travel.Tyres(0.7, 0.2, 2.7, 1.5)}):
        found = travel.path([(0, 0), (10, 0), (20, 0)], [0, 0, 0], rotating_mass="4 %", **wheels)
        assert found.speed**2 * 1.04 == pytest.approx(2.0 * travel.GRAVITY * 0.14 * 20.0)
    locked = travel.path([(0, 0), (20, 0)], [0, 0], friction=0.7, lock=1, rotating_mass=0.04)
    assert locked.speed == pytest.approx(travel.speed(20.0, drag=0.7))


def way_of_a_spinning_wheel(speed, segments, rotating, step=2e-5):
    """Forward along a straight line, heading along it, with the spin of the wheel integrated; from
    0.05 m/s of slip on, friction is whole. Of each segment length, friction, and the force of the
    brake over the load.
    """
    spin, way, edges = speed, 0.0, np.cumsum([length for length, _, _ in segments]).tolist()
    spin = 0.0 if segments[0][2] >= segments[0][1] else speed
    while speed > 0.1:
        at = min(bisect.bisect(edges, way), len(segments) - 1)
        _, mu, brake = segments[at]
        pull = mu * max(-1.0, min((speed - spin) / 0.05, 1.0))
        speed -= travel.GRAVITY * pull * step
        spin = max(0.0, spin + travel.GRAVITY * (pull - brake) / rotating * step)
        way += speed * step
    return way


LOCKED = 100.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("wheels", "segments"),
    [
        ({"friction": 0.7, "lock": [0.5, 1.0]}, [(10, 0.7, 0.35), (10, 0.7, LOCKED)]),
        ({"friction": [0.7, 0.2]}, [(10, 0.7, 0.56), (10, 0.2, 0.56)]),
        ({"friction": 0.2}, [(10, 0.2, 0.56), (10, 0.2, 0.56)]),
        ({"friction": 0.57}, [(10, 0.57, 0.56), (10, 0.57, 0.56)]),
    ],
)
def test_the_spin_of_a_wheel_integrated_goes_as_far_as_a_path_says(wheels, segments):
    """Wheels that lock between segments, or are locked on ice by their brake: the way within
    0.3 %.
    """
    if "lock" not in wheels:
        wheels = wheels | {"tyres": travel.Tyres(0.7, 0.8, 2.7, 1.5)}
    found = travel.path([(0, 0), (10, 0), (20, 0)], [0, 0, 0], rotating_mass=0.03, **wheels)
    way = way_of_a_spinning_wheel(found.speed, segments, 0.03)
    assert way == pytest.approx(20.0, rel=3e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("wheels", "segments"),
    [
        ({"friction": 0.7, "lock": [1.0, 0.5]}, [(10, 0.7, LOCKED), (10, 0.7, 0.35)]),
        ({"friction": [0.2, 0.7]}, [(10, 0.2, 0.56), (10, 0.7, 0.56)]),
    ],
)
def test_the_spin_that_the_ground_gives_a_released_wheel_is_left_out(wheels, segments):
    """With it the vehicle comes less far, by two times the rotating mass at most, as it says."""
    if "lock" not in wheels:
        wheels = wheels | {"tyres": travel.Tyres(0.7, 0.8, 2.7, 1.5)}
    found = travel.path([(0, 0), (10, 0), (20, 0)], [0, 0, 0], rotating_mass=0.03, **wheels)
    way = way_of_a_spinning_wheel(found.speed, segments, 0.03)
    assert 20.0 * (1.0 - 2.0 * 0.03) < way < 20.0


def test_wheels_released_again_and_again_never_take_more_than_locked_ones():
    """The ground gives friction times the weight at most, however often wheels are released."""
    points = [(float(x), 0.0) for x in range(21)]
    headings = [0.0] * 21
    found = travel.path(
        points, headings, friction=0.7, lock=[1.0, 0.9] * 10, rotating_mass=0.03
    ).speed
    assert found < math.sqrt(2.0 * travel.GRAVITY * 0.7 * 20.0)
    ice = travel.path(
        points,
        headings,
        friction=[0.7, 0.3] * 10,
        tyres=travel.Tyres(0.7, 0.8, 2.7, 1.5),
        rotating_mass=0.03,
    ).speed
    assert ice < math.sqrt(2.0 * travel.GRAVITY * 0.5 * 20.0)


def test_a_wheel_that_its_brake_holds_at_its_slip_angle_adds_nothing_to_the_mass():
    """Locked, as the cosine of the crab angle is less than the lock: friction alone slows it."""
    points, headings = [(0, 0), (10, 0), (20, 0)], ["45 deg"] * 3
    alone = math.sqrt(2.0 * travel.GRAVITY * 0.7 * 20.0)
    for wheels in ({"friction": 0.7, "lock": 0.8}, {"tyres": travel.Tyres(0.7, 0.8, 2.7, 1.5)}):
        found = travel.path(points, headings, rotating_mass="3 %", **wheels)
        assert found.speed == pytest.approx(alone, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("lock", [0.1, 0.4, 0.7, 0.9])
def test_wheels_that_turn_in_a_spin_count_in_a_path_as_in_a_run_out(lock):
    """Back from 81 points of a run-out that spins, forward by ``simulate``: within 0.5 %, of up to
    1.5 % that all wheels make where they are counted as turning.
    """
    car = col.Vehicle(
        mass=1500.0, yaw_inertia=2400.0, x=0.0, y=0.0, heading=0.8, vx=15.0, yaw_rate=1.0
    )
    tyres = travel.Tyres(0.7, lock, 2.7, 1.5)
    way = travel.simulate(car, tyres, rotating_mass=0.06, moments=2001)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(way.x), np.diff(way.y)))])
    at = np.linspace(0.0, along[-1], 81)
    x, y, heading = (np.interp(at, along, part) for part in (way.x, way.y, way.heading))
    points = list(zip(x.tolist(), y.tolist(), strict=True))
    found = travel.path(points, heading.tolist(), tyres=tyres, rotating_mass=0.06, window="0.1 m")
    assert found.speed == pytest.approx(15.0, rel=5e-3)


def test_a_path_whose_wheels_lock_in_some_cases_is_that_of_each_alone():
    """Friction, lock and rotating mass as arrays."""
    points, headings = [(0, 0), (9, -1), (18, -1)], [0.0, 0.9, 1.8]
    frictions, locks = [[0.2, 0.7, 0.7], 0.5], np.array([0.3, 0.6, 1.0])
    many = travel.path(
        points, headings, friction=[np.array(frictions[0]), 0.5], lock=locks, rotating_mass=0.04
    )
    for i in range(3):
        one = travel.path(
            points,
            headings,
            friction=[frictions[0][i], 0.5],
            lock=float(locks[i]),
            rotating_mass=0.04,
        )
        assert many.speed[i] == pytest.approx(one.speed, rel=1e-12)
        assert many.drags[0][i] == pytest.approx(one.drags[0], rel=1e-12)


def test_a_path_on_tyres_takes_friction_of_the_ground_and_arrays():
    """A brake that locks its wheel on ice; each case of a batch as alone."""
    points, headings = [(0, 0), (9, -1), (18, -1)], [0.0, 0.9, 1.8]
    tyres = travel.Tyres(0.7, 0.3, 2.7, 1.5, height=0.5, steer=0.05)
    dry, icy = (
        travel.path(points, headings, tyres=tyres, friction=mu) for mu in (None, [0.1, 0.7])
    )
    assert icy.drags[0] == pytest.approx(0.1, rel=0.03)
    assert icy.drags[1] == dry.drags[1]
    locks = np.array([0.1, 0.3])
    many = travel.path(points, headings, tyres=tyres.replace(lock=locks))
    assert many.speed[1] == pytest.approx(dry.speed, rel=1e-12)
    exact = travel.path(points, headings, tyres=tyres, point_error=0.1, heading_error=0.05)
    assert exact.speed == dry.speed
    assert 0.0 < exact.speed_error < 1.0


@pytest.mark.parametrize(
    ("given", "code", "said"),
    [
        ({}, "missing_friction", "friction is missing"),
        ({"friction": 0.7}, "missing_lock", "lock is missing; give it, or tyres="),
        ({"tyres": 0.3}, "not_tyres", "tyres must be Tyres"),
        (
            {"tyres": travel.Tyres(0.7, 0.1, 2.7, 1.5), "lock": 0.1},
            "bad_combination",
            "lock is given beside tyres",
        ),
        (
            {"tyres": travel.Tyres(0.2, 0.1, 2.7, 1.5, height=0.9), "friction": 0.9},
            "wheel_lifts",
            "a wheel lifts off",
        ),
        ({"friction": 0.7, "lock": 0.1, "rotating_mass": 11.0}, "bad_fraction", "rotating_mass"),
    ],
)
def test_wheels_of_a_path_that_are_refused(given, code, said):
    """Told twice, not at all, or not as they can be."""
    with pytest.raises(col.CollisionsError) as caught:
        travel.path([(0, 0), (9, 0)], [0.0, 0.1], **given)
    assert code in {caught.value.code, *(one.code for one in getattr(caught.value, "problems", ()))}
    assert said in str(caught.value)


def test_refused_tyres_of_a_batch_of_paths_leave_their_neighbours():
    """Each reason is counted."""
    tyres = travel.Tyres(
        0.7, np.array([0.1, 1.5, 0.1, 0.1]), np.array([2.7, 2.7, -1.0, 2.7]), 1.5,
        height=np.array([0.5, 0.5, 0.5, 3.0]),
    )  # fmt: skip
    said = r"3 of 4 cases .*\(1 not_positive, 1 bad_fraction, 1 wheel_lifts\)"
    with pytest.warns(col.CollisionsWarning, match=said):
        found = travel.path([(0, 0), (9, 0)], [0.0, 0.1], tyres=tyres)
    assert np.isfinite(found.speed).tolist() == [True, False, False, False]


def test_locked_wheels_on_an_arc_against_the_closed_form():
    """A constant deceleration on a circle: all is known in closed form, and the speed depends on
    the length alone.
    """
    radius, start, friction = 30.0, 15.0, 0.6
    rate = friction * 9.80665
    total = start / rate
    t = np.linspace(0.0, total, 41)
    s = start * t - rate * t * t / 2
    points = np.column_stack([radius * np.sin(s / radius), radius * (1.0 - np.cos(s / radius))])
    headings = 0.5 + 4.0 * (t - t * t / (2 * total))
    run = travel.path(points, headings, friction=friction, lock=1, window=0)
    # Chords are shorter than their arcs by (L / R)**2 / 24 of the longest L = 0.96 m: 4e-5 of the
    # length, half of it of speed.
    assert run.speed == pytest.approx(start, rel=3e-5)
    assert run.time == pytest.approx(total, rel=1e-4)
    # The parabola misses the tangent by the third derivative: L1 (L1 + L2) / 6 / R**2 = 3e-4 rad.
    assert run.course == pytest.approx(0.0, abs=5e-4)
    # The heading is itself a parabola in time, so only the times are approximate.
    assert run.yaw_rate == pytest.approx(4.0, rel=1e-4)
    chord = math.hypot(*(points[-1] - points[0]))
    assert chord < run.distance < s[-1]
    assert run.straight_course == pytest.approx(s[-1] / radius / 2, rel=1e-12)
    assert run.course_difference == pytest.approx(run.course - run.straight_course, abs=1e-15)


def test_two_points_have_the_tangents_of_the_chord():
    """Course along the line, yaw rate the turn over the time."""
    run = travel.path([(0, 0), (3, 4)], ["10 deg", "70 deg"], friction=0.7, lock=0.5)
    for course in (run.course, run.straight_course):
        assert course == pytest.approx(math.atan2(4, 3), rel=2 * EPS)
    assert run.yaw_rate == pytest.approx(math.radians(60) / run.time, rel=4 * EPS)
    assert run.course_difference == pytest.approx(0.0, abs=4 * EPS)


def test_the_tangents_hold_for_points_at_uneven_distances():
    """A heading that is a parabola in time is found exactly; a flat parabola of the path to its
    slope times its square.
    """
    rate, times = 0.7 * travel.GRAVITY, np.array([0.0, 0.3, 1.0, 1.4])
    points = np.column_stack([15.0 * times - rate * times**2 / 2, np.zeros(4)])
    run = travel.path(
        points,
        0.2 + 2.0 * times - 0.5 * times**2,
        friction=0.7,
        lock=1,
        end_speed=15.0 - rate * 1.4,
    )
    assert run.yaw_rate == pytest.approx(2.0, rel=64 * EPS)
    x = np.array([0.0, 1.0, 4.0, 5.0])
    run = travel.path(np.column_stack([x, 1e-3 * x**2]), np.zeros(4), **FULL_LOCK)
    # Chords are longer than their x by half of slope**2, here at most 2e-5 of slopes up to 5e-3.
    assert run.course == pytest.approx(0.0, abs=1e-7)


def test_crab_angles_end_at_half_a_turn_to_the_left():
    """A vehicle that slides backward has a crab angle of pi, not -pi."""
    for heading in (math.pi, -math.pi):
        assert travel.path([(0, 0), (5, 0)], [heading] * 2, **FULL_LOCK).crab_angles == (math.pi,)


@pytest.mark.filterwarnings("ignore:the yaw alone")
def test_headings_count_on_through_turns():
    """A full turn more or less on all of them changes nothing, and one within them is a spin."""
    points = [(0, 0), (4, 0), (8, 0), (12, 0)]
    once = travel.path(points, ["0 deg", "80 deg", "170 deg", "250 deg"], friction=0.7, lock=0.2)
    again = travel.path(
        points, ["720 deg", "800 deg", "890 deg", "970 deg"], friction=0.7, lock=0.2
    )
    # 4 pi more in a heading rounds it by 2e-15, and crab angles and turns with it.
    assert again.drags == pytest.approx(once.drags, abs=1e-14)
    assert again.yaw_rate == pytest.approx(once.yaw_rate, abs=1e-13)
    assert once.yaw_rate > 0
    other_way = travel.path(
        points, ["0 deg", "-80 deg", "-170 deg", "-250 deg"], friction=0.7, lock=0.2
    )
    assert other_way.yaw_rate == -once.yaw_rate
    assert other_way.speed == once.speed
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        travel.path(points, [6.0, 7.0, 8.0, 9.0], friction=0.7, lock=0.2)
        travel.path(points, np.array([6.0, 7.0, 8.0, 9.0]), friction=0.7, lock=0.2)
    with pytest.warns(
        col.SuspectUnitsWarning, match=re.escape("headings[0] = 90 is read as rad")
    ) as caught:
        travel.path(points, [90, 91, 92, 93], friction=0.7, lock=0.2)
    assert len(caught) == 1


def test_the_scene_may_be_turned_and_moved():
    """A quarter turn and a shift of whole metres change course and nothing else."""
    points, headings = [(0, 0), (5, 1), (9, 3), (12, 6)], [0.1, 0.9, 1.8, 2.5]
    moved = [(100 - y, 50 + x) for x, y in points]
    here = travel.path(points, headings, friction=0.7, lock=0.2)
    there = travel.path(moved, [h + math.pi / 2 for h in headings], friction=0.7, lock=0.2)
    for name in ("speed", "yaw_rate", "time", "distance", "course_difference"):
        assert getattr(there, name) == pytest.approx(getattr(here, name), rel=32 * EPS)
    assert there.course == pytest.approx(here.course + math.pi / 2, rel=8 * EPS)


PATH_PARTS = (
    "speed",
    "course",
    "yaw_rate",
    "time",
    "distance",
    "straight_course",
    "course_difference",
)


def test_a_batch_of_paths_is_each_of_them_alone():
    """Arrays in place of single numbers: every case as if it were asked alone, in the shape they
    broadcast to.
    """
    generator = np.random.default_rng(8)
    xs = np.cumsum(generator.uniform(1.0, 6.0, (4, 5)), axis=0)
    ys = generator.uniform(-1.0, 1.0, (4, 5))
    turned = np.cumsum(generator.uniform(-1.4, 1.4, (4, 5)), axis=0)
    friction, lock = generator.uniform(0.5, 0.8, 5), generator.uniform(0.1, 1.0, (2, 1))
    run = travel.path(
        list(zip(xs, ys, strict=True)),
        list(turned),
        friction=friction,
        lock=lock,
        grade=[0.0, 0.01, 0.0],
    )
    assert run.speed.shape == (2, 5)
    assert not run.speed.flags.writeable
    for i, j in np.ndindex(2, 5):
        points = list(zip(xs[:, j].tolist(), ys[:, j].tolist(), strict=True))
        alone = travel.path(
            points,
            turned[:, j].tolist(),
            friction=float(friction[j]),
            lock=float(lock[i, 0]),
            grade=[0, 0.01, 0],
        )
        for name in PATH_PARTS:
            # numpy and math differ in the last bit of sine and arctangent; a yaw rate is a
            # difference of two rates.
            assert getattr(run, name)[i, j] == pytest.approx(
                getattr(alone, name), rel=64 * EPS, abs=64 * EPS
            ), name
        for name in ("speeds", "crab_angles", "drags"):
            many = [part[i, j] for part in getattr(run, name)]
            assert many == pytest.approx(getattr(alone, name), rel=64 * EPS, abs=64 * EPS), name


def test_refused_paths_of_a_batch_leave_their_neighbours():
    """A case that cannot be answered is NaN in every answer, counted by its kind, and the first
    stays as it is alone.
    """
    good = travel.path([(0.0, 0.0), (5.0, 1.0)], [0.0, 1.0], friction=0.7, lock=0.5)
    #        good  coincident  turned  friction  lock  end_speed  never stops
    x = np.array([5.0, 0.0, 5.0, 5.0, 5.0, 5.0, 5.0, math.nan])
    y = np.array([1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    turn = np.array([1.0, 1.0, 3.2, 1.0, 1.0, 1.0, 1.0, 1.0])
    friction = np.array([0.7, 0.7, 0.7, -0.1, 0.7, 0.7, 0.0, 0.7])
    lock = np.array([0.5, 0.5, 0.5, 0.5, 1.1, 0.5, 0.5, 0.5])
    end = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0])
    with pytest.warns(col.CollisionsWarning) as caught:
        run = travel.path(
            [(0.0, 0.0), (x, y)], [0.0, turn], friction=friction, lock=lock, end_speed=end
        )
    refused = [one.message for one in caught if one.message.code == "refused_cases"]
    assert refused[0].fields["counts"] == {
        "not_finite": 1,
        "bad_friction": 1,
        "bad_fraction": 1,
        "negative_speed": 1,
        "coincident_points": 1,
        "turns_too_far": 1,
        "contradictory": 1,
    }
    for name in PATH_PARTS:
        found = getattr(run, name)
        assert found[0] == pytest.approx(getattr(good, name), rel=8 * EPS)
        assert np.all(np.isnan(found[1:]))
    assert np.all(np.isnan(run.drags[0][1:]))


@pytest.mark.parametrize("last", [9.1e15, 1e17])
def test_a_segment_that_is_lost_beside_the_others_has_no_tangent(last):
    """The way to both of the last points is the same number, so no parabola passes through them."""
    points, ground = [(0.0, last), (0.0, 0.0), (0.0, 1.0)], {"lock": 1.0, "end_speed": 1.0}
    with pytest.raises(col.InputError) as caught:
        travel.path(points, [0.0] * 3, friction=0.125, **ground)
    assert caught.value.code == "out_of_range"
    places = [(0.0, np.array([last, 5.0])), *points[1:]]
    with pytest.warns(col.CollisionsWarning) as warned:
        run = travel.path(places, [0.0] * 3, friction=np.array([0.125, 0.125]), **ground)
    (refused,) = [one.message for one in warned if one.message.code == "refused_cases"]
    assert refused.fields["counts"] == {"out_of_range": 1}
    for name in ("speed", "course", "yaw_rate", "time", "distance"):
        assert np.isnan(getattr(run, name)).tolist() == [True, False], name


def test_paths_in_units_of_every_kind():
    """Texts, arrays and Quantities of another registry, whole or part by part."""
    other = other_registry()
    points, headings = [(0, 0), (20, -5), (40, -8)], [0, 70, 130]
    metres = [(x * FOOT, y * FOOT) for x, y in points]
    wanted = travel.path(
        metres, [f"{h} deg" for h in headings], friction=0.7, lock=0.2, end_speed=5 * MPH
    )
    for places in (
        np.array(metres),
        other.Quantity(points, "ft"),
        [other.Quantity(point, "ft") for point in points],
        [(f"{x} ft", f"{y} ft") for x, y in points],
        tuple(np.array(point) for point in metres),
    ):
        for turned in (
            np.radians(headings),
            other.Quantity(headings, "deg"),
            [other.Quantity(h, "deg") for h in headings],
            tuple(math.radians(h) for h in headings),
        ):
            run = travel.path(
                places, turned, friction="70 %", lock=["20 %", 0.2], grade="0 %", end_speed="5 mph"
            )
            assert run.speed == pytest.approx(wanted.speed, rel=8 * EPS)
            assert run.yaw_rate == pytest.approx(wanted.yaw_rate, rel=16 * EPS)
            assert run.course == pytest.approx(wanted.course, rel=8 * EPS)


@pytest.mark.parametrize(
    ("points", "headings", "rest", "code", "said"),
    [
        (
            [(0, 0)],
            [0],
            FULL_LOCK,
            "too_few_points",
            "points holds 1, and a path needs at least two",
        ),
        ([], [], FULL_LOCK, "too_few_points", "points holds 0"),
        (
            3.0,
            [0, 0],
            FULL_LOCK,
            "bad_shape",
            (
                "points is one number; give a list with one for each point, or an array of shape "
                "(n, 2)"
            ),
        ),
        (np.zeros((3, 3)), [0, 0, 0], FULL_LOCK, "bad_shape", "points is an array of shape (3, 3)"),
        (
            [(0, 0), (1, 1, 1), (2, 2)],
            [0, 0, 0],
            FULL_LOCK,
            "bad_shape",
            "points[1] must be a pair (x, y), got (1, 1, 1)",
        ),
        ([(0, 0), 7], [0, 0], FULL_LOCK, "bad_shape", "points[1] must be a pair (x, y), got 7"),
        (
            [(0, 0), (np.zeros(2), np.ones(3))],
            [0, 0],
            FULL_LOCK,
            "bad_shape",
            "do not broadcast together: points[1][0] (2,), points[1][1] (3,)",
        ),
        ([(0, 0), (math.nan, 1)], [0, 0], FULL_LOCK, "not_finite", "points[1][0] is NaN"),
        (
            np.array([[0, 0], [math.inf, 1]]),
            [0, 0],
            FULL_LOCK,
            "not_finite",
            "points[1][0] must be finite",
        ),
        (
            [(0, 0), (3, 4), (3, 4)],
            [0, 0, 0],
            FULL_LOCK,
            "coincident_points",
            "points[1] and points[2] are the same place (3, 4)",
        ),
        (STRAIGHT, [0, 0], FULL_LOCK, "bad_shape", "headings holds 2 and points holds 3"),
        (
            STRAIGHT,
            0.0,
            FULL_LOCK,
            "bad_shape",
            "headings is one number; give a list with one for each point",
        ),
        (
            STRAIGHT,
            np.zeros((3, 1)),
            FULL_LOCK,
            "bad_shape",
            "headings is an array of shape (3, 1)",
        ),
        (STRAIGHT, [0, math.nan, 0], FULL_LOCK, "not_finite", "headings[1] is NaN"),
        (STRAIGHT, np.array([0, math.nan, 0]), FULL_LOCK, "not_finite", "headings[1] is NaN"),
        (
            STRAIGHT,
            [0, [1], 0],
            FULL_LOCK,
            "bad_shape",
            "headings[1] is a list, and takes one value",
        ),
        (
            STRAIGHT,
            [0, np.zeros(2), np.zeros(3)],
            FULL_LOCK,
            "bad_shape",
            "do not broadcast together: headings[1] (2,)",
        ),
        (
            STRAIGHT,
            ["0 deg", "north", 0],
            FULL_LOCK,
            "bad_units",
            "headings[1]: cannot read 'north'",
        ),
        (
            STRAIGHT,
            ["350 deg", "10 deg", 0],
            FULL_LOCK,
            "turns_too_far",
            "headings[0] to headings[1] turn by -340 deg",
        ),
        (
            STRAIGHT,
            ["350 deg", "10 deg", 0],
            FULL_LOCK,
            "turns_too_far",
            "(350 deg, then 370 deg), and give points between",
        ),
        (
            STRAIGHT,
            [0, 30, 60],
            FULL_LOCK,
            "turns_too_far",
            "bare numbers are radians, so write degrees as '30 deg'",
        ),
        (
            STRAIGHT,
            np.array([0.0, 30.0, 60.0]),
            FULL_LOCK,
            "turns_too_far",
            "so write degrees as '30 deg'",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": -0.1, "lock": 1},
            "bad_friction",
            "friction must be >= 0, got -0.1",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": math.inf, "lock": 1},
            "not_finite",
            "friction must be finite, got inf",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": pint.Quantity(math.nan), "lock": 1},
            "not_finite",
            "friction must be finite",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": [0.7, -1], "lock": 1},
            "bad_friction",
            "friction[1] must be >= 0",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": [0.7], "lock": 1},
            "bad_shape",
            "friction is a list of 1, and there are 2 segments",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": np.ones(2), "lock": np.ones(3)},
            "bad_shape",
            "friction (2,)",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": 0.7, "lock": 1.01},
            "bad_fraction",
            "lock must be from 0 to 1, got 1.01",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": 0.7, "lock": [1, -0.1]},
            "bad_fraction",
            "lock[1] must be from 0 to 1",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": 0.7, "lock": math.nan},
            "bad_fraction",
            "lock must be from 0 to 1, got nan",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": 0.7, "lock": [1, 1, 1]},
            "bad_shape",
            "lock is a list of 3, and there are 2 segments",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {**FULL_LOCK, "grade": [0.1]},
            "bad_shape",
            "grade is a list of 1, and there are 2 segments",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {**FULL_LOCK, "grade": "steep"},
            "bad_units",
            "grade: cannot read 'steep'",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {**FULL_LOCK, "end_speed": -1},
            "negative_speed",
            "end_speed must be >= 0, got -1",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": 0.7, "lock": 0},
            "contradictory",
            "points[1] to points[2]: drag + grade is 0",
        ),
        (
            STRAIGHT,
            [0, 0, 0],
            {"friction": 0.1, "lock": 1, "grade": -0.2},
            "contradictory",
            "points[1] to points[2]: drag + grade is -0.1",
        ),
        ([(0, 0), (1e308, 1e308)], [0, 0], FULL_LOCK, "out_of_range", "too large or too small"),
        (
            [(0, 0), (1e-300, 0)],
            [0, 1],
            {**FULL_LOCK, "end_speed": 1e20},
            "out_of_range",
            "too large or too small",
        ),
        (
            [(0, 0), (5e-324, 0)],
            [0, 1],
            {**FULL_LOCK, "end_speed": 1e300},
            "out_of_range",
            "too large or too small",
        ),
    ],
)
def test_refused_paths(points, headings, rest, code, said):
    """No run-out comes of them, and the message says what to write."""
    error = refusal(lambda: travel.path(points, headings, **rest))
    assert error.code == code
    assert said in str(error)


@pytest.mark.parametrize(
    "headings",
    [
        ["350 deg", "10 deg", "20 deg"],
        pint.Quantity([350.0, 10.0, 20.0], "deg"),
        ["350 deg", pint.Quantity(10, "deg"), 0],
    ],
)
def test_headings_with_units_are_not_told_to_write_them(headings):
    """10 deg is what was meant; only a jump at a full turn, or a spin that was faster than the
    points, can be mended.
    """
    text = str(refusal(lambda: travel.path(STRAIGHT, headings, **FULL_LOCK)))
    assert "turn by -340 deg" in text
    assert "count headings on without a jump at a full turn (350 deg, then 370 deg)" in text
    assert "0.174533" not in text
    assert "radians" not in text
    assert travel.path(STRAIGHT, ["350 deg", "370 deg", "380 deg"], **FULL_LOCK).yaw_rate > 0.0


def test_all_wrong_arguments_of_a_path_are_named_at_once():
    """Also those beside points that cannot be read."""
    text = str(
        refusal(
            lambda: travel.path([(0, 0)], ["x"], friction=[-1, -2], lock=2, grade="y", end_speed=-1)
        )
    )
    for name in (
        "points",
        "headings[0]",
        "friction[0]",
        "friction[1]",
        "lock",
        "grade",
        "end_speed",
    ):
        assert f"\n- {name}" in text


@pytest.mark.filterwarnings("ignore:the yaw alone:collisions.OutOfRangeWarning")
def test_a_wide_segment_is_warned_of_where_it_matters():
    """One crab angle for more than a quarter turn is crude, unless locked wheels drag alike at
    every angle.
    """
    with pytest.warns(
        col.OutOfRangeWarning,
        match=re.escape("points[1] to points[2]: the vehicle turns by more than 90 deg"),
    ) as caught:
        travel.path(STRAIGHT, ["0 deg", "90 deg", "190 deg"], friction=0.7, lock=[0.1, 0.1])
    assert caught[0].message.fields["segments"] == (1,)
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # Of the yaw it is, as the first lock is low.
        warnings.filterwarnings("ignore", "the yaw alone")
        travel.path(STRAIGHT, ["0 deg", "90 deg", "270 deg"], friction=0.7, lock=[0.1, 1])


def test_a_loop_has_no_straight_line():
    """Back at the first point: NaN, as for the course of a vehicle at rest."""
    run = travel.path([(0, 0), (5, 0), (5, 5), (0, 0)], [0, 1, 2, 3], **FULL_LOCK)
    assert math.isnan(run.straight_course)
    assert math.isnan(run.course_difference)
    assert run.speed > 0.0


def test_the_course_difference_is_wrapped():
    """Near due west the two courses lie on both sides of the cut at 180 deg."""
    run = travel.path([(0, 0), (-5, 0.2), (-10, -0.3)], [0, 0, 0], **FULL_LOCK)
    assert run.course > 3.0
    assert run.straight_course < -3.0
    assert run.course_difference == pytest.approx(
        run.course - run.straight_course - 2 * math.pi, abs=8 * EPS
    )
    assert -0.2 < run.course_difference < -0.1


def test_a_run_out_is_a_frozen_record_with_units():
    """Floats and tuples of floats, Quantities under .q, six digits and units in the repr, ready for
    the state after an impact.
    """
    run = travel.path(
        [(0, 0), (6, 2), (12, 3)], ["0 deg", "50 deg", "90 deg"], friction=0.7, lock=0.3
    )
    for name in (
        "speed",
        "course",
        "yaw_rate",
        "time",
        "distance",
        "straight_course",
        "course_difference",
    ):
        assert type(getattr(run, name)) is float
    for name, count in (("speeds", 3), ("crab_angles", 2), ("drags", 2)):
        assert [type(part) for part in getattr(run, name)] == [float] * count
    assert run.q.speed.m_as("km/h") == pytest.approx(3.6 * run.speed, rel=2 * EPS)
    assert run.q.yaw_rate.check("1/[time]")
    assert run.q.time.check("[time]")
    assert run.q.distance.m_as("ft") == pytest.approx(run.distance / FOOT, rel=2 * EPS)
    assert run.q.course_difference.m_as("deg") == pytest.approx(
        math.degrees(run.course_difference), rel=4 * EPS
    )
    assert [part.m_as("deg") for part in run.q.crab_angles] == pytest.approx(
        [math.degrees(x) for x in run.crab_angles]
    )
    assert repr(run).startswith(
        f"RunOut(speed={run.speed:.6g} m/s, course={run.course:.6g} rad, yaw_rate="
    )
    assert f"course_difference={run.course_difference:.6g} rad)" in repr(run)
    assert "<caption>Run-out</caption>" in run._repr_html_()
    assert pickle.loads(pickle.dumps(run)) == run
    with pytest.raises(AttributeError):
        run.speed = 3.0
    after = col.Vehicle.from_speed(
        speed=run.speed, course=run.course, yaw_rate=run.yaw_rate, mass=1200
    )
    assert after.speed == pytest.approx(run.speed, rel=4 * EPS)


@pytest.mark.parametrize("function", [travel.speed, travel.distance, travel.time, travel.path])
def test_what_is_documented_of_each_function(function):
    """The sections a reader needs: what goes in, what comes out, what is refused and warned of, one
    worked example.
    """
    text = inspect.getdoc(function)
    for section in ("Parameters", "Returns", "Raises", "Warns", "Examples"):
        assert f"\n{section}\n{'-' * len(section)}\n" in text
    named = re.findall(
        r"^([a-z_, ]+?)(?: :|$)", text.split("Parameters\n")[1].split("Returns\n")[0], re.MULTILINE
    )
    assert {name for line in named for name in line.split(", ")} >= set(
        inspect.signature(function).parameters
    )


def test_every_function_of_travel_has_a_docstring():
    """Also those that are not public, where a name is shared between the files."""
    for module in (travel.run_out, travel.surfaces, travel.straight):
        for name, member in vars(module).items():
            if (
                inspect.isfunction(member)
                and member.__module__ == module.__name__
                and not name.startswith("_")
            ):
                assert member.__doc__, name


@pytest.mark.parametrize(
    "number",
    [5, "5", pint.Quantity(5, ""), np.array([0.1, 5.0])],
    ids=["bare", "text", "quantity", "array"],
)
def test_a_number_without_a_unit_is_suspected_however_it_is_written(number):
    """5 for 5 percent as a grade, and as a drag; "500 %" is what somebody meant."""
    with pytest.warns(col.SuspectUnitsWarning, match="grade = 5 is read as the rise over the run"):
        travel.speed("20 m", drag=0.7, grade=number)
    with pytest.warns(col.SuspectUnitsWarning, match="drag = 5 is read as a fraction of gravity"):
        travel.speed("20 m", drag=number)
    with pytest.warns(
        col.SuspectUnitsWarning, match="friction = 5 is read as a fraction of the load"
    ):
        travel.path([(0.0, 0.0), (9.0, 1.0)], [0.0, 1.0], friction=number, lock=1.0)
    travel.speed("20 m", drag="500 %")


def test_an_empty_list_is_said_to_be_empty_and_nothing_else():
    """What stands beside it is not wrong because of it."""
    error = refusal(lambda: travel.speed([], drag=[0.7], grade=[0.0]))
    assert str(error) == "distance is an empty list; give at least one segment"


def test_no_distance_in_many_cases_is_an_answer_for_each():
    """Not one number for all, and not one for a drag that no surface has."""
    assert travel.time(0.0, drag=np.array([0.5, 0.7])).tolist() == [0.0, 0.0]
    with pytest.warns(col.CollisionsWarning, match="1 of 2 cases cannot be answered and are NaN"):
        assert np.isnan(travel.time(0.0, drag=np.array([-0.5, 0.7]))).tolist() == [True, False]


def test_a_heading_beyond_float32_beside_float32_headings():
    """No turn that can be told, and no warning of numpy's."""
    headings = [3.4028235677973366e38, np.zeros(3, dtype=np.float32)]
    with pytest.warns(col.CollisionsWarning) as caught:
        found = travel.path([(0.0, 0.0), (0.0, 1.0)], headings, friction=0.0, lock=0.0)
    assert all(isinstance(one.message, col.CollisionsWarning) for one in caught)
    assert np.isnan(found.speed).all()
