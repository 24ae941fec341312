"""speeds from recorders as they are built: readings made by stepping a crash through time, at a
place and in axes that turn, lead back to its speeds.
"""

import json
import math
import re
import warnings

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct, reporting
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform, propagate

MPH = 0.44704
A = col.Vehicle(
    mass="3400 lb", vx="30 mph", yaw_inertia="1770 slug*ft**2", x="-6.5 ft", y="1.3 ft",
    heading="0 deg",
)  # fmt: skip
B = col.Vehicle(
    mass="2900 lb", vx=0, vy="25 mph", yaw_inertia="1250 slug*ft**2", x="2.6 ft", y="-4 ft",
    heading="90 deg",
)  # fmt: skip
CONTACT = {"normal": 0.0, "point": (0.0, 0.0)}
COURSES = {"course_a": 0.0, "course_b": "90 deg"}

# These contacts stuck, as the friction of 2 has it, at ratios at which others slide.
pytestmark = [
    pytest.mark.filterwarnings("ignore:(?s).*to stick, the contact needs an impulse ratio"),
    pytest.mark.filterwarnings("ignore:(?s).*the contact was taken to stick at an impulse ratio"),
]


def crash(e=0.1, friction=2.0, spin_a=0.0, spin_b=0.0):
    a, b = A.replace(yaw_rate=spin_a), B.replace(yaw_rate=spin_b)
    return col.eccentric(a, b, e, **CONTACT, friction=friction)


def read(side, place, duration, axes="turning", steps=20000):
    """What a recorder shows, by the velocity of its place from step to step.

    The force has the direction of the impulse and rises as a quarter of a sine, and falls as one
    that takes e times as long. The heading is that of the end of compression.
    """
    e = side._inputs.restitution
    peak = duration / (1.0 + max(e, 0.0))
    time = np.linspace(0.0, duration, steps + 1)
    middle = 0.5 * (time[1:] + time[:-1])
    force = np.where(
        middle < peak,
        np.sin(0.5 * math.pi * middle / peak),
        np.cos(0.5 * math.pi * (middle - peak) / (max(e, 1e-9) * peak)),
    )
    passed = np.concatenate(([0.0], np.cumsum(force)))
    passed /= passed[-1]
    spin = side.before.yaw_rate + side.delta_yaw_rate * passed
    turn = np.concatenate(([0.0], np.cumsum(0.5 * (spin[1:] + spin[:-1]) * np.diff(time))))
    heading = side.before.heading + turn - np.interp(peak, time, turn)
    rx = np.cos(heading) * place[0] - np.sin(heading) * place[1]
    ry = np.sin(heading) * place[0] + np.cos(heading) * place[1]
    vx, vy = side.delta_vx * passed - spin * ry, side.delta_vy * passed + spin * rx
    facing = 0.5 * (heading[1:] + heading[:-1])
    if axes == "fixed":
        facing = np.full(steps, side.before.heading)
    dx, dy = np.diff(vx), np.diff(vy)
    return (
        float(np.sum(np.cos(facing) * dx + np.sin(facing) * dy)),
        float(np.sum(np.cos(facing) * dy - np.sin(facing) * dx)),
    )


def names(label, reading):
    return {
        f"delta_v_{part}_{label}": v for part, v in zip(("forward", "left"), reading, strict=True)
    }


def found_from(known, e=0.1, friction=math.inf, spin_a=0.0, spin_b=0.0, **options):
    """The speeds; without a value of friction, of a contact that is stated to have stuck."""
    bodies = A.replace(yaw_rate=spin_a), B.replace(yaw_rate=spin_b)
    if friction == math.inf and any("forward" in name or "left" in name for name in known):
        options.setdefault("regime", "sticking")
    return reconstruct.speeds(
        *bodies, **COURSES, restitution=e, **CONTACT, friction=friction, **known, **options
    )


def mph(impact):
    return [impact.a.before.speed / MPH, impact.b.before.speed / MPH]


def test_a_recorder_half_a_metre_ahead_was_taken_for_the_centre_of_mass():
    """The case of the record: in a contact without duration the place alone turns 30 and 25 mph
    into 25.6 and 43.5; with it they come back.
    """
    side = crash().a
    reading = side.delta_v_forward, side.delta_v_left + 0.5 * side.delta_yaw_rate
    (wrong,) = found_from(names("a", reading))
    assert [round(speed, 1) for speed in mph(wrong)] == [25.6, 43.5]
    (found,) = found_from(names("a", reading), recorder_a=("50 cm", 0), duration=0)
    assert mph(found) == pytest.approx([30.0, 25.0], rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("axes", ["turning", "fixed"])
@pytest.mark.parametrize("labels", ["a", "b", "ab"])
def test_readings_lead_back_to_a_crash_in_which_tyres_act(axes, labels):
    """Their impulse passes as that of the contact does; without them the speeds are others."""
    wheels = {
        "duration": 0.1,
        "tyres_a": Tyres(0.7, 1.0, 2.7, 1.5),
        "tyres_b": Tyres(0.7, 0.0, 2.6, 1.5),
    }
    impact = col.eccentric(A, B, 0.1, **CONTACT, friction=2.0, **wheels)
    places = {"a": (0.5, -0.1), "b": (-0.6, 0.2)}
    known, recorders = {}, {}
    for label in labels:
        known |= names(label, read(getattr(impact, label), places[label], 0.1, axes))
        recorders[f"recorder_{label}"] = places[label]
    (found,) = found_from(known, **recorders, axes=axes, **wheels)
    assert mph(found) == pytest.approx([30.0, 25.0], abs=1e-3)
    (bare,) = found_from(known, **recorders, axes=axes, duration=0.1)
    assert max(abs(np.subtract(mph(bare), [30.0, 25.0]))) > 0.5
    assert found.reconstruction.known[-1] == f"recorder_axes_{axes}"
    again = col.Impact.from_dict(json.loads(json.dumps(found.to_dict())))
    assert again == found
    for page in (col.explain(found), col.report(found)):
        assert "as its recorder reads it" in page or "place of the recorder" in page


@pytest.mark.slow
@pytest.mark.parametrize(
    "known",
    [{"speed_a": 17.4, "friction": math.inf}, {"friction": 0.717}],
    ids=["speed", "friction"],
)
def test_speeds_to_which_only_their_own_tyres_lead_are_found(known):
    """Of turns far apart the wrong one fits better until the tyres are those of the answer; and
    whole changes of the tyres lead past it.
    """
    wheels = {
        "duration": 0.1045,
        "tyres_a": Tyres(0.706, 0.4, 2.7, 1.5),
        "tyres_b": Tyres(0.81, 0.0, 2.7, 1.5),
    }
    met = {"restitution": 0.277, "normal": 0.415, "point": (0.286, 0.046)}
    a = col.Vehicle.from_speed(
        mass=1387, yaw_inertia=2404, x=-1.8, y=-0.122, heading=-0.0135, yaw_rate=0.107, speed=17.4,
        course=0.0,
    )  # fmt: skip
    b = col.Vehicle.from_speed(
        mass=1042, yaw_inertia=1946, x=1.8, y=1.457, heading=-1.158, yaw_rate=0.0066, speed=8.29,
        course=-1.155,
    )  # fmt: skip
    place = (-0.701, -0.092)
    impact = col.eccentric(a, b, **met, **wheels, friction=0.717)
    assert impact.regime == "sticking"
    readings = names("a", read(impact.a, place, wheels["duration"]))
    found = reconstruct.speeds(
        a,
        b,
        course_a=0.0,
        course_b=-1.155,
        **met,
        **wheels,
        **readings,
        recorder_a=place,
        **known,
        regime="sticking",
        forward_only=True,
    )
    pairs = [(one.a.before.speed, one.b.before.speed) for one in found]
    assert min(math.dist(pair, (17.4, 8.29)) for pair in pairs) < 1e-3
    for one in found:
        shown = read(one.a, place, wheels["duration"])
        assert list(shown) == pytest.approx(list(readings.values()), abs=1e-5)


@pytest.mark.slow
def test_a_contact_that_sticks_only_with_its_own_tyres_is_found():
    """Without them, or with those of cars that go forwards, it takes more than the friction."""
    wheels = {
        "duration": 0.122,
        "tyres_a": Tyres(0.857, 0.4, 2.7, 1.5),
        "tyres_b": Tyres(0.59, 1.0, 2.7, 1.5),
    }
    met = {"restitution": 0.071, "normal": 0.0432, "point": (-0.258, 0.097), "friction": 0.698}
    a = col.Vehicle.from_speed(
        mass=1338, yaw_inertia=2075, x=-1.8, y=-1.11, heading=0.022, yaw_rate=-0.128, speed=8.22,
        course=0.0,
    )  # fmt: skip
    b = col.Vehicle.from_speed(
        mass=1598, yaw_inertia=2441, x=1.8, y=1.915, heading=2.038, yaw_rate=0.155, speed=13.3,
        course=2.12,
    )  # fmt: skip
    place = (-0.719, 0.003)
    impact = col.eccentric(a, b, **met, **wheels)
    assert impact.regime == "sticking"
    readings = names("a", read(impact.a, place, wheels["duration"]))
    (found,) = reconstruct.speeds(
        a, b, course_a=0.0, course_b=2.12, **met, **wheels, **readings, recorder_a=place,
        regime="sticking",
    )  # fmt: skip
    pair = found.a.before.speed, found.b.before.speed
    assert pair == pytest.approx((8.22, 13.3), abs=1e-3)


@pytest.mark.slow
def test_readings_with_tyres_come_out_of_a_batch_as_alone():
    wheels = {"duration": np.array([0.06, 0.12]), "tyres_a": Tyres(0.7, 1.0, 2.7, 1.5)}
    place = {"recorder_b": (0.4, 0.1)}
    known = names("b", read(crash().b, (0.4, 0.1), 0.09))
    (many,) = found_from(known, **place, **wheels)
    for i, duration in enumerate(wheels["duration"]):
        (one,) = found_from(known, **place, **wheels | {"duration": float(duration)})
        pair = [many.a.before.speed[i], many.b.before.speed[i]]
        assert pair == pytest.approx([one.a.before.speed, one.b.before.speed], rel=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("axes", ["turning", "fixed"])
@pytest.mark.parametrize("place", [(0.0, 0.0), (0.5, 0.0), (-0.9, 0.4), (1.5, -0.6)])
@pytest.mark.parametrize(
    ("e", "spins", "duration"),
    [(0.1, (0.0, 0.0), 0.1), (0.0, (1.2, -2.0), 0.15), (0.7, (-0.8, 0.5), 0.08)],
)
def test_what_a_recorder_shows_of_a_crash_leads_back_to_it(axes, place, e, spins, duration):
    """Of either car, and of both."""
    impact = crash(e, spin_a=spins[0], spin_b=spins[1])
    readings = {
        label: names(label, read(getattr(impact, label), place, duration, axes)) for label in "ab"
    }
    for labels in ("a", "b", "ab"):
        known = {name: value for label in labels for name, value in readings[label].items()}
        places = {f"recorder_{label}": place for label in labels}
        answers = found_from(
            known, e, spin_a=spins[0], spin_b=spins[1], **places, axes=axes, duration=duration,
            forward_only=True,
        )  # fmt: skip
        for label in labels:
            for one in answers:
                shown = read(getattr(one, label), place, duration, axes)
                assert shown == pytest.approx(tuple(readings[label].values()), abs=2e-5)
        found = min(answers, key=lambda one: abs(mph(one)[0] - 30.0))
        assert mph(found) == pytest.approx([30.0, 25.0], abs=2e-4)
        assert found.a.delta_v_left == pytest.approx(impact.a.delta_v_left, abs=1e-4)
        told = (*places, f"recorder_axes_{axes}")
        assert found.reconstruction.known[-len(told) :] == told


def test_an_incomplete_impact_is_engaged_the_most_at_its_end():
    """Cut short at cos phase = -e of the quarter wave."""
    impact = col.eccentric(A, B, -0.3, **CONTACT, friction=2.0, incomplete=True)
    side, steps, duration, place = impact.a, 20000, 0.1, (0.6, 0.2)
    time = np.linspace(0.0, duration, steps + 1)
    passed = (1.0 - np.cos(time / duration * math.acos(0.3))) / 0.7
    spin = side.delta_yaw_rate * passed
    turn = np.concatenate(([0.0], np.cumsum(0.5 * (spin[1:] + spin[:-1]) * np.diff(time))))
    heading = turn - turn[-1]
    vx = side.delta_vx * passed - spin * (np.sin(heading) * place[0] + np.cos(heading) * place[1])
    vy = side.delta_vy * passed + spin * (np.cos(heading) * place[0] - np.sin(heading) * place[1])
    facing = 0.5 * (heading[1:] + heading[:-1])
    dx, dy = np.diff(vx), np.diff(vy)
    reading = (
        float(np.sum(np.cos(facing) * dx + np.sin(facing) * dy)),
        float(np.sum(np.cos(facing) * dy - np.sin(facing) * dx)),
    )
    (found,) = found_from(
        names("a", reading), -0.3, recorder_a=place, duration=duration, incomplete=True
    )
    assert mph(found) == pytest.approx([30.0, 25.0], abs=2e-4)


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.3, 0.5])
def test_of_a_contact_that_slid_one_speed_and_readings_give_the_other(friction):
    """The readings of B, and its speed, give that of A."""
    impact = crash(friction=friction)
    assert impact.regime == "sliding"
    known = names("b", read(impact.b, (0.7, 0.1), 0.12))
    options = {"recorder_b": (0.7, 0.1), "duration": "120 ms", "friction": friction}
    (found,) = found_from(known | {"speed_b": "25 mph"}, **options)
    assert mph(found) == pytest.approx([30.0, 25.0], abs=2e-4)


@pytest.mark.slow
def test_both_recorders_far_from_the_centre_seemed_to_contradict():
    """Of cars that turn fast their readings disagree if taken for the centres."""
    impact = crash()
    known = names("a", read(impact.a, (1.6, 0.0), 0.1)) | names(
        "b", read(impact.b, (1.6, 0.0), 0.1)
    )
    with pytest.warns(col.IllConditionedWarning, match="28%") as caught:
        found_from(known)
    assert caught[0].message.code == "recorders_differ"
    (found,) = found_from(known, recorder_a=(1.6, 0), recorder_b=(1.6, 0), duration=0.1)
    assert mph(found) == pytest.approx([30.0, 25.0], abs=2e-4)


@pytest.mark.slow
def test_batches_are_their_cases():
    count = 7
    ahead, lasts = np.linspace(-1.0, 1.0, count), np.linspace(0.05, 0.15, count)
    readings = np.array(
        [read(crash().a, (float(x), 0.1), float(t)) for x, t in zip(ahead, lasts, strict=True)]
    ).T
    options = {"forward_only": True}
    (found,) = found_from(names("a", readings), recorder_a=(ahead, 0.1), duration=lasts, **options)
    assert found.a.before.speed / MPH == pytest.approx(np.full(count, 30.0), abs=2e-4)
    for at in (0, 3, 6):
        (alone,) = found_from(
            names("a", readings[:, at]),
            recorder_a=(float(ahead[at]), 0.1),
            duration=float(lasts[at]),
            **options,
        )
        assert alone.b.before.speed == pytest.approx(found.b.before.speed[at], rel=1e-9)


# Shifts aside of A and of B, the course of B, the place of the recorder of A, both speeds.
SEVERAL = {
    "the other root backwards": (-0.2, -0.3, 111.0, (-0.9, 0.4), 15.9, 17.8),
    "three roots": (0.2, 0.1, 84.0, (-0.7, -0.2), 17.9, 6.2),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", SEVERAL)
@pytest.mark.parametrize("forward_only", [False, True])
@pytest.mark.filterwarnings("ignore:the speed of B came out as")
def test_all_speeds_with_the_readings_at_a_place_are_given(case, forward_only):
    """By the readings that each answer has when it is stepped through time: none misses them, and
    the crash that they were made with is among the answers.
    """
    ya, yb, course, place, *speeds = SEVERAL[case]
    a = col.Vehicle.from_speed(
        mass=1500, yaw_inertia=2500, x=-2, y=ya, speed=speeds[0], course=0, heading=0
    )
    b = col.Vehicle.from_speed(
        mass=1300, yaw_inertia=2000, x=1, y=yb, speed=speeds[1],
        course=f"{course} deg", heading=f"{course} deg",
    )  # fmt: skip
    contact = {"normal": "5 deg", "point": (0, 0.1), "friction": math.inf}
    reading = read(col.eccentric(a, b, 0.1, **contact).a, place, 0.1)
    found = reconstruct.speeds(
        a, b, course_a=0, course_b=f"{course} deg", restitution=0.1, **contact,
        **names("a", reading), recorder_a=place, duration=0.1, regime="sticking",
        forward_only=forward_only,
    )  # fmt: skip
    for one in found:
        assert read(one.a, place, 0.1) == pytest.approx(reading, abs=1e-6)
        (said,) = [text for text in one.statements if "is missed" in text]
        assert said.startswith("found from readings away from the centre of mass")
        assert "answers are looked for from many turns" in str(col.report(one))
    pairs = [(one.a.before.speed, one.b.before.speed) for one in found]
    assert any(pair == pytest.approx(speeds, abs=1e-4) for pair in pairs)
    assert len(found) == (3 if case == "three roots" else 1)


# Seeds of crashes that slid, whose components alone show other ratios as well.
@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 2])
def test_the_ratio_that_readings_show_is_that_of_the_crash(seed):
    """Where the components alone may mean several impulses, the known speed says which it was."""
    draw = np.random.default_rng(seed)
    for _ in range(40):
        a = A.replace(vx=draw.uniform(8, 20), y=draw.normal(0, 0.7), yaw_rate=draw.normal(0, 0.3))
        b = B.replace(vy=draw.uniform(5, 20), y=draw.normal(0, 1), yaw_rate=draw.normal(0, 0.3))
        place = draw.normal(0, 0.8), draw.normal(0, 0.4)
        impact = col.eccentric(a, b, 0.1, **CONTACT, friction=0.3, on_failure="nan")
        if not impact.ok or impact.regime != "sliding":
            continue
        (found,) = reconstruct.speeds(
            a, b, **COURSES, restitution=0.1, **CONTACT, friction=math.inf, regime="sliding",
            speed_b=b.speed, **names("a", read(impact.a, place, 0.1)), recorder_a=place,
            duration=0.1,
        )  # fmt: skip
        assert found.a.before.speed == pytest.approx(a.speed, abs=1e-4)
        assert found.regime == "sliding"


@pytest.mark.slow
def test_in_a_study_with_an_uncertain_place():
    reading = read(crash().a, (0.5, 0.0), 0.1)

    def model(forward, left, place, duration):
        (found,) = found_from(
            names("a", (forward, left)), recorder_a=(place, 0.0), duration=duration
        )
        return {"speed_a": found.a.before.speed, "speed_b": found.b.before.speed}

    inputs = {
        "forward": Normal(reading[0], 0.1),
        "left": Normal(reading[1], 0.1),
        "place": Normal("50 cm", "10 cm"),
        "duration": Uniform("80 ms", "120 ms"),
    }
    found = propagate(model, inputs, samples=256, seed=1)
    assert found.failed == 0
    assert found["speed_b"].mean / MPH == pytest.approx(25.0, abs=1.0)
    assert found["speed_b"].contributions["place"] > 0.3


def test_from_a_record_to_the_speeds():
    """Polarity, place and duration are those of the pulse."""
    reading = read(crash().a, (0.5, -0.2), 0.1)
    time = np.arange(0.0, 0.2501, 0.01)
    share = np.clip(time / 0.1, 0.0, 1.0)
    pulse = reconstruct.recorded_pulse(
        time, reading[0] * share, -reading[1] * share, polarity="49 CFR 563", forward=0.5, left=-0.2
    )
    means = {name: one.mean for name, one in pulse.inputs("a").items() if name != "recorder_a"}
    (found,) = found_from(means, recorder_a=pulse.place, duration=pulse.duration)
    assert mph(found) == pytest.approx([30.0, 25.0], abs=2e-4)


@pytest.mark.slow
def test_pages_and_records_say_that_readings_were_carried_over():
    """The result has the delta-V of the centre of mass, so the texts of the readings, which are
    other numbers, are not held against it.
    """
    reading = [f"{part / MPH:.6f} mph" for part in read(crash().a, (0.5, 0.0), 0.1)]
    (found,) = found_from(names("a", reading), recorder_a=("50 cm", 0), duration="100 ms")
    assert found.reconstruction.known == (
        "delta_v_forward_a",
        "delta_v_left_a",
        "recorder_a",
        "recorder_axes_turning",
    )
    page = str(col.report(found))
    assert "carried over to the centre of mass" in page
    rows = re.sub("<[^>]+>", " ", page)
    for what, text in (
        ("delta-V forward of A, as its recorder reads it", reading[0].partition(".")[0]),
        ("recorder of A, ahead of the centre of mass", r"1\.640 ft, given as 50 cm"),
        ("duration of the contact, in which recorders turn", "0\\.1 s, given as 100 ms"),
    ):
        assert re.search(rf"{what}\s+{text}", rows), (what, rows[:6000])
    assert reporting.replay(page).reconstruction == found.reconstruction
    assert "carried over to the centre of mass" in (told := str(col.explain(found)))
    # The derivation ends at the delta-V of the centre of mass, and says so.
    assert "it must reproduce what was known" in told
    assert "away from it, or in axes that turn, differ from that, and are not worked out" in told
    assert "For this one:" not in told
    again = col.Impact.from_dict(json.loads(json.dumps(found.to_dict())))
    assert again.reconstruction == found.reconstruction
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        col.diagnose(found)


READING = names("a", (-5.0, 3.0))


@pytest.mark.parametrize(
    ("known", "options", "code", "text"),
    [
        (READING, {"recorder_a": (0.5, 0)}, "missing_duration", "write duration='100 ms'"),
        (READING, {"axes": "turning"}, "missing_duration", "or 0 for"),
        (READING, {"duration": 0.1}, "bad_combination", "write axes='turning'"),
        (READING, {"recorder_a": 0.5, "duration": 0.1}, "bad_shape", r"\(forward, left\)"),
        (READING, {"recorder_a": (500, 0), "duration": 0.1}, "out_of_range", "millimetres"),
        (READING, {"recorder_a": ("1 kg", 0), "duration": 0.1}, "bad_units", "recorder_a"),
        (READING, {"recorder_b": (0.5, 0), "duration": 0.1}, "bad_combination", "recorder_b is"),
        (READING, {"axes": "car", "duration": 0.1}, "bad_option", "'turning'"),
        (READING, {"axes": "fixed", "duration": -0.1}, "negative_duration", "duration"),
        (
            {"delta_v_a": 6.0, "speed_b": 3.0},
            {"axes": "turning", "duration": 0.1},
            "bad_combination",
            "axes is for components",
        ),
    ],
)
def test_refusals(known, options, code, text):
    with pytest.raises(col.InputError, match=text) as caught:
        found_from(known, **options)
    assert caught.value.code == code
