"""speeds of contacts that slid, where the end of the family has a car go backwards: the bounds are
those of what goes forwards, against the forward solver; and what goes forwards where tyres act.
"""

import json
import math
import warnings

import numpy as np
import pytest

import collisions as col
from collisions import reporting
from collisions.reconstruct import speeds
from collisions.travel import Tyres
from collisions.uncertainty import Normal, OneSided, propagate

from .test_recorder_place import names, read

# A crash that slid, of a slow car A: the contact that sticks has A go backwards at 2.66 m/s.
SLOW = (
    col.Vehicle(mass=1377.9, yaw_inertia=1406.2, x=-1.2256, y=2.1382, heading=-0.8367),
    col.Vehicle(mass=2347.7, yaw_inertia=1720.1, x=-1.0283, y=-1.4380, heading=1.2920),
)
MET = {
    "course_a": -0.8952, "course_b": 1.3488, "restitution": 0.3373,
    "normal": -1.6745, "point": (0.6677, -0.9932),
}  # fmt: skip
TRUE, FRICTION = (0.63, 9.18), 0.3785


def moving(cars, both, met):
    return [
        car.replace(vx=speed * math.cos(way), vy=speed * math.sin(way))
        for car, speed, way in zip(cars, both, (met["course_a"], met["course_b"]), strict=True)
    ]


def met_forwards(cars, both, met, **rest):
    hit = {name: met[name] for name in ("normal", "point")}
    return col.eccentric(*moving(cars, both, met), met["restitution"], **hit, **rest)


def along(impact, met):
    pairs = ((getattr(impact, one).before, met[f"course_{one}"]) for one in "ab")
    return np.array([one.vx * math.cos(way) + one.vy * math.sin(way) for one, way in pairs])


def recorded(impact, label="b"):
    side = getattr(impact, label)
    return names(label, (side.delta_v_forward, side.delta_v_left))


def slow():
    return recorded(met_forwards(SLOW, TRUE, MET, friction=FRICTION))


def holds(found, both):
    """Whether these speeds are within what is stated."""
    sides = found.reconstruction.one_sided
    return all(
        side * (true - speed) >= -1e-6 if side else abs(true - speed) < 1e-6
        for side, true, speed in zip(
            (sides["speed_a"], sides["speed_b"]),
            both,
            (found.a.before.speed, found.b.before.speed),
            strict=True,
        )
    )


def slow_crash(rng):
    """A random crash that slid, with one slow car."""
    while True:
        ahead = rng.uniform(-math.pi, math.pi)
        aside = ahead + rng.uniform(0.5, 2.6) * rng.choice([-1, 1])
        cars = [
            col.Vehicle(
                mass=rng.uniform(900, 2500), yaw_inertia=rng.uniform(1300, 4500),
                x=rng.uniform(-1, 1) - far * math.cos(way),
                y=rng.uniform(-1, 1) - far * math.sin(way),
                heading=way, yaw_rate=rng.normal(0, 0.2),
            )
            for way, far in ((ahead, 2), (aside, 1))
        ]  # fmt: skip
        a, b = cars
        met = {
            "course_a": ahead + rng.normal(0, 0.05), "course_b": aside + rng.normal(0, 0.05),
            "restitution": rng.uniform(0, 0.4),
            "normal": math.atan2(b.y - a.y, b.x - a.x) + rng.normal(0, 0.3),
            "point": (rng.normal(0, 0.4), rng.normal(0, 0.4)),
        }  # fmt: skip
        both = [rng.uniform(0.1, 1.2), rng.uniform(4, 20)]
        rng.shuffle(both)
        friction = rng.uniform(0.2, 0.9)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                impact = met_forwards(cars, both, met, friction=friction)
        except col.CollisionsError:
            continue
        if impact.regime == "sliding" and impact.closing_speed > 0.5:
            return cars, both, met, friction, impact


@pytest.mark.slow
def test_the_truth_is_within_every_bound():
    """Also where only its friction is known to be less, alone and in a batch, and with forward_only
    alike; the impact found has the readings, by the forward solver and its own friction.
    """
    rng = np.random.default_rng(12)
    at_rest = 0
    for _ in range(25):
        cars, both, met, friction, impact = slow_crash(rng)
        known = recorded(impact, "ab"[rng.integers(2)])
        given = np.array([friction, 1.3 * friction, math.inf])
        options = {"slid": "bound", "forward_only": bool(rng.integers(2))}
        with warnings.catch_warnings():
            warnings.simplefilter("error", col.OutOfRangeWarning)
            (many,) = speeds(*cars, **met, **known, friction=given, **options)
            for i, one in enumerate(given):
                (found,) = speeds(*cars, **met, **known, friction=one, **options)
                (other,) = speeds(
                    *cars, **met, **known, friction=one,
                    **options | {"forward_only": not options["forward_only"]},
                )  # fmt: skip
                assert other == found
                assert holds(found, both)
                assert along(found, met).min() >= 0.0
                again = met_forwards(cars, along(found, met), met, friction=found.friction)
                for name, value in known.items():
                    told = getattr(getattr(again, name[-1]), name[:-2])
                    assert told == pytest.approx(value, abs=1e-7)
                alone = many.case(i)
                assert along(alone, met) == pytest.approx(along(found, met), abs=1e-9)
                assert alone.reconstruction.one_sided == found.reconstruction.one_sided
                assert alone.friction == pytest.approx(found.friction, rel=1e-9)
                at_rest += along(found, met).min() == 0.0
                # Half as much slip is still in the family, as is the truth.
                between = 0.5 * (along(found, met) + both)
                middle = met_forwards(cars, between, met, friction=friction)
                assert middle.impulse_ratio == pytest.approx(impact.impulse_ratio, rel=1e-9)
    assert at_rest > 5


@pytest.mark.slow
@pytest.mark.parametrize("friction", [FRICTION, 0.5, math.inf], ids=str)
def test_a_slow_car_is_not_said_to_be_faster_than_it_was(friction):
    """At rest is the least that is known of it; records, pages and ranges have that."""
    given = {**MET, **slow(), "friction": friction, "slid": "bound"}
    (found,) = speeds(*SLOW, **given)
    assert found.a.before.speed == 0.0
    assert found.reconstruction.one_sided == {"speed_a": 1, "speed_b": -1}
    assert TRUE[1] < found.b.before.speed < 10.0
    assert found.friction == pytest.approx(FRICTION, rel=1e-9)
    assert found.regime == "sliding"
    # Where it was given, rounding decides whether it is taken from the components.
    assert friction == FRICTION or "friction" in found.reconstruction.found
    record = json.loads(json.dumps(found.to_dict()))
    assert col.Impact.from_dict(record) == found
    page = col.report(found, form="markdown")
    assert reporting.replay(page) == found
    said = f"at most {found.b.before.speed:.2f} m/s"
    for text in (str(found.summary()), page, col.explain(found, form="text")):
        assert "speed of A is at least 0" in text
        assert said[:13] in text

    def model(forward):
        (one,) = speeds(*SLOW, **{**given, "delta_v_forward_b": forward})
        sides = one.reconstruction.one_sided
        return {
            "a": OneSided(one.a.before.speed, sides["speed_a"]),
            "b": OneSided(one.b.before.speed, sides["speed_b"]),
        }

    run = propagate(
        model, {"forward": Normal(given["delta_v_forward_b"], 0.003)}, samples=64, seed=1
    )
    (least, most), (slowest, fastest) = (run[one].interval() for one in "ab")
    assert least <= TRUE[0] < most == math.inf
    assert -math.inf == slowest < TRUE[1] <= fastest


@pytest.mark.slow
def test_a_refusal_says_that_the_contact_that_stuck_goes_backwards():
    given = {**MET, **slow(), "friction": math.inf}
    with pytest.raises(col.AmbiguousSolutionError) as refused:
        speeds(*SLOW, **given)
    text = str(refused.value)
    stuck, slid = refused.value.solutions
    assert f"A would go backwards along its course at {stuck.a.before.speed:.6g} m/s" in text
    assert f"the speed of B is {stuck.b.before.speed:.6g} m/s; if it slid" in text
    assert "A is at least 0 m/s" in text
    assert f"B is at most {slid.b.before.speed:.6g} m/s" in text
    assert holds(slid, TRUE)
    # With forwards alone it slid, and the slip is open.
    with pytest.raises(col.NoSolutionError, match="leaves the slip undetermined") as refused:
        speeds(*SLOW, **given, forward_only=True)
    assert refused.value.code == "undetermined"
    with pytest.warns(col.CollisionsWarning):
        (many,) = speeds(*SLOW, **given | {"friction": np.array([math.inf])}, forward_only=True)
    assert [col.Status(int(one)).label for one in many.status] == ["undetermined"]
    # Stated to have stuck, it goes backwards; the bounds beside that are of what goes forwards.
    with pytest.warns(col.CollisionsWarning) as caught:
        speeds(*SLOW, **given, regime="sticking")
    told = {one.message.code: str(one.message) for one in caught}
    assert "came out as -2.6" in told["negative_speed"]
    assert "speed of A is at least 0 m/s" in told["may_slide"]
    assert f"speed of B is at most {slid.b.before.speed:.6g} m/s" in told["may_slide"]


@pytest.mark.slow
def test_a_family_that_goes_backwards_as_a_whole():
    """With the course of a car turned about whose speed rises: it is negative and falls, which is
    said, and its size rises.
    """
    rng = np.random.default_rng(3)
    tried = 0
    while tried < 5:
        cars, both, met, friction, impact = slow_crash(rng)
        given = {**recorded(impact, "a"), "friction": friction, "slid": "bound"}
        (right,) = speeds(*cars, **met, **given)
        rising = [
            one
            for one in "ab"
            if right.reconstruction.one_sided[f"speed_{one}"] == 1
            and getattr(right, one).before.speed > 0.1
        ]
        if not rising:
            continue
        tried += 1
        course = f"course_{rising[0]}"
        turned = {**met, course: met[course] + math.pi}
        with pytest.warns(col.OutOfRangeWarning, match="backwards along its course"):
            (found,) = speeds(*cars, **turned, **given)
        assert along(found, met) == pytest.approx(along(right, met), abs=1e-9)
        assert found.reconstruction.one_sided == right.reconstruction.one_sided
        assert holds(found, both)
        with pytest.raises(col.NoSolutionError, match="a vehicle goes backwards along its"):
            speeds(*cars, **turned, **given, forward_only=True)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_a_contact_that_slid_has_the_readings_at_a_place_too(seed):
    """Of a refusal, which gives both; its bounds are those of ``slid="bound"``. Against stepping
    through time.
    """
    rng = np.random.default_rng(seed)
    doubts = 0
    while doubts < 4:
        cars, both, met, friction, _ = slow_crash(rng)
        both = rng.uniform(6.0, 20.0, 2)
        label, place = "ab"[rng.integers(2)], (rng.uniform(-1.5, 1.5), rng.uniform(-0.6, 0.6))
        axes = ("turning", "fixed")[rng.integers(2)]
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                impact = met_forwards(cars, both, met, friction=friction)
        except col.CollisionsError:
            continue
        known = names(label, read(getattr(impact, label), place, 0.08, axes))
        given = {
            **met, **known, f"recorder_{label}": place, "axes": axes, "duration": 0.08,
            "friction": (1.5 * friction, math.inf)[rng.integers(2)],
        }  # fmt: skip
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                speeds(*cars, **given)
                continue
            except col.AmbiguousSolutionError as error:
                refused = error
            except col.CollisionsError:
                continue
            try:
                bounds = speeds(*cars, **given, slid="bound")
            except col.AmbiguousSolutionError as error:
                # In either direction, or stuck.
                bounds = error.solutions
        slid = [one for one in refused.solutions if one.regime == "sliding"]
        assert slid
        for one in slid:
            again = read(getattr(one, label), place, 0.08, axes)
            apart = np.hypot(*np.subtract(again, list(known.values())))
            # At the friction that was given they differ by no more than recorders may.
            far = 0.1 if one.friction == given["friction"] else 1e-4
            assert apart <= far * math.hypot(*known.values()) * 3
            same = [
                other.reconstruction.one_sided
                for other in bounds
                if other.reconstruction.one_sided
                and np.allclose(along(other, met), along(one, met), rtol=1e-4, atol=1e-4)
            ]
            assert one.reconstruction.one_sided in same
        doubts += 1


# Masses, yaw inertias, places, headings, yaw rates and speeds of A and B, how they met, wheels, the
# recorder and what it shows: crashes whose tyres move their readings so far that the contact
# without tyres leads to no answer, or only to others.
WITH_TYRES = {
    "both recorders": (
        (1900.8, 2389.4, -2.8225, 1.3218, -0.29169, 0.0, 17.5483),
        (1899.3, 4213.5, 0.84092, -1.66755, 1.83498, 0.0, 15.5505),
        {"course_a": -0.28681, "course_b": 1.84818, "restitution": 0.30389,
         "normal": -0.78071, "point": (-0.076584, -0.611701)},
        {"duration": 0.106458, "tyres_b": Tyres(0.444425, 1.0, 2.592, 1.474)},
        {"recorder_a": (0.51698, 0.31319), "recorder_b": (-0.91719, 0.11)}, "fixed",
        ("delta_v_forward_a", "delta_v_forward_b"),
    ),
    "near the centre of mass": (
        (1590.07, 3097.93, -2.06007, 1.17571, -0.32747, -0.54254, 7.33366),
        (2411.41, 3456.58, -0.12738, -0.40035, 1.49576, -0.31733, 13.88611),
        {"course_a": -0.28597, "course_b": 1.41532, "restitution": 0.34435,
         "normal": -0.20371, "point": (-0.086844, 0.407221)},
        {"duration": 0.12281, "tyres_a": Tyres(0.71831, 0.766, 2.971, 1.4445),
         "tyres_b": Tyres(0.78207, 1.0, 2.946, 1.413)},
        {"recorder_b": (-0.016, -0.003)}, "turning", ("delta_v_forward_b", "delta_v_left_b"),
    ),
    "two that go forwards": (
        (1448.24, 1353.12, 1.51593, -0.95454, 2.02644, 0.0, 23.58415),
        (2097.01, 4279.82, -0.9008, -1.81959, 1.1491, 0.0, 18.4028),
        {"course_a": 2.07337, "course_b": 1.0878, "restitution": 0.26548,
         "normal": -3.34633, "point": (0.44146, -0.15103)},
        {"duration": 0.062165, "tyres_a": Tyres(0.75959, 1.0, 2.686, 1.505),
         "tyres_b": Tyres(0.79143, 1.0, 2.407, 1.524)},
        {"recorder_a": (-0.80428, -0.09397)}, "fixed", ("delta_v_forward_a", "delta_v_left_a"),
    ),
}  # fmt: skip


def with_tyres(case):
    """The cars, speeds, how they met, and what is known of a contact that stuck."""
    *bodies, met, wheels, places, axes, known = WITH_TYRES[case]
    cars = [
        col.Vehicle(mass=m, yaw_inertia=inertia, x=x, y=y, heading=heading, yaw_rate=spin)
        for m, inertia, x, y, heading, spin, _ in bodies
    ]
    both = [body[-1] for body in bodies]
    impact = met_forwards(cars, both, met, friction=math.inf, **wheels)
    shown = {}
    for name, place in places.items():
        label = name[-1]
        shown |= names(label, read(getattr(impact, label), place, wheels["duration"], axes))
    rest = {**wheels, **places, "axes": axes, "regime": "sticking", "friction": math.inf}
    return cars, both, met, {name: shown[name] for name in known}, rest


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:(?s).*to stick, the contact needs an impulse ratio")
@pytest.mark.parametrize("friction", [math.inf, 0.85], ids=str)
@pytest.mark.parametrize("case", WITH_TYRES)
def test_what_goes_forwards_is_found_with_tyres(case, friction):
    """Every answer has the readings, by stepping through time; the crash is among them, in order of
    closing speeds, and what goes backwards is said.
    """
    cars, both, met, known, rest = with_tyres(case)
    rest["friction"] = friction
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = speeds(*cars, **met, **known, **rest)
    assert any(along(one, met) == pytest.approx(both, abs=1e-3) for one in found)
    closing = [one.closing_speed for one in found]
    assert closing == sorted(closing)
    assert all(one.reconstruction.answers == len(found) for one in found)
    backwards = any(along(one, met).min() < 0.0 for one in found)
    assert backwards == ("negative_speed" in {one.message.code for one in caught})
    for one in found:
        for name, value in known.items():
            label = name[-1]
            reading = read(
                getattr(one, label), rest[f"recorder_{label}"], rest["duration"], rest["axes"]
            )
            assert reading["left" in name] == pytest.approx(value, abs=1e-3)
    ahead = speeds(*cars, **met, **known, **rest, forward_only=True)
    assert ahead[0].reconstruction.answers == len(ahead) == len(
        [one for one in found if along(one, met).min() >= 0.0]
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:(?s).*taken to stick at an impulse ratio", "ignore:(?s).*to st")
def test_a_batch_with_one_answer_and_with_two_is_its_cases():
    cars, _, met, known, rest = with_tyres("both recorders")
    rest["duration"] = rest["duration"] * np.array([1.0, 0.7, 0.4, 0.1])
    with pytest.warns(col.CollisionsWarning, match="backwards along its course"):
        many = speeds(*cars, **met, **known, **rest)
    counts = []
    for i, duration in enumerate(rest["duration"]):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.OutOfRangeWarning)
            alone = speeds(*cars, **met, **known, **rest | {"duration": float(duration)})
        there = [one.case(i) for one in many if not one.refused[i]]
        assert len(there) == len(alone)
        for one, other in zip(alone, there, strict=True):
            assert along(one, met) == pytest.approx(along(other, met), rel=1e-9)
            assert other.reconstruction.answers == len(alone)
        counts.append(len(alone))
    assert set(counts) == {1, 2}


@pytest.mark.slow
def test_a_ratio_far_below_the_friction_is_not_said_to_slide():
    """From readings at a place: the crash, which stuck, is the answer or among those of a refusal,
    which says that sliding at the friction fits within the accuracy of recorders.
    """
    rng = np.random.default_rng(4)
    refused = 0
    while refused < 4:
        cars, _, met, friction, _ = slow_crash(rng)
        both, place = rng.uniform(6.0, 20.0, 2), (rng.uniform(-1.5, 1.5), rng.uniform(-0.6, 0.6))
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                impact = met_forwards(cars, both, met, friction=friction)
        except col.CollisionsError:
            continue
        if friction < 0.3 or abs(impact.impulse_ratio) > 0.45 * friction:
            continue
        known = names("a", read(impact.a, place, 0.1))
        rest = {"friction": friction, "recorder_a": place, "duration": 0.1}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            text = ""
            try:
                found = speeds(*cars, **met, **known, **rest)
            except col.AmbiguousSolutionError as error:
                found, text = error.solutions, str(error)
        if text:
            refused += 1
            far = f"a contact that slid with friction={friction:.4g} has the same within 10%"
            assert far in text or "is not clearly above that" in text
        assert any(along(one, met) == pytest.approx(both, abs=1e-2) for one in found)
