"""Speeds of an instant refined for tyres that act: forward answers are found again from every pair
of what may be known.
"""

import math
import random
import warnings
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import optimize

import collisions as col
from collisions import reconstruct
from collisions.derivation import explain
from collisions.reconstruct.lasting import SETTLED
from collisions.reconstruct.speeds_algebra import Root
from collisions.reconstruct.speeds_search import in_order
from collisions.reconstruct.speeds_tyres import speeds_with_tyres
from collisions.reporting import replay
from collisions.travel import Tyres
from scenes import UNLIKE, WHEELS

COMPONENTS = ("delta_v_forward_a", "delta_v_left_a", "delta_v_forward_b", "delta_v_left_b")
PAIRS = [
    ("speed_b", "delta_v_a"),
    ("speed_a", "energy_loss"),
    ("delta_v_b", "energy_loss"),
    ("speed_b", "ees_a"),
    ("speed_a", "max_crush_speed_a"),
    COMPONENTS[:2],
    COMPONENTS,
]


def drawn(rng, stuck):
    """Two cars that meet at an angle, their contact and their wheels."""
    courses = rng.uniform(-0.3, 0.3), rng.uniform(1.1, 2.0)
    a, b = (
        col.Vehicle.from_speed(
            mass=rng.uniform(900.0, 2200.0),
            yaw_inertia=rng.uniform(1500.0, 3500.0),
            speed=rng.uniform(8.0, 22.0),
            course=course,
            heading=course + rng.uniform(-0.05, 0.05),
            x=x,
            y=y,
        )
        for course, x, y in zip(
            courses, (-2.0, 0.9), (rng.uniform(-0.5, 0.5), rng.uniform(-1.0, 1.0)), strict=True
        )
    )
    wheels = {
        "duration": rng.uniform(0.05, 0.15),
        "tyres_a": Tyres(rng.uniform(0.4, 0.9), rng.choice((0.0, 0.4, 1.0)), 2.7, 1.5),
        "tyres_b": Tyres(rng.uniform(0.4, 0.9), rng.choice((0.0, 0.4, 1.0)), 2.7, 1.5),
    }
    contact = {
        "normal": rng.uniform(-0.2, 0.2),
        "point": (0.0, 0.0),
        "friction": math.inf if stuck else rng.uniform(0.3, 0.6),
    }
    return a, b, rng.uniform(0.05, 0.3), contact, wheels


def read(impact, name):
    """What is known of an answer, by the argument of speeds."""
    label = name[-1]
    if name.startswith("ees"):
        return impact.ees(0.4)["ab".index(label)]
    if name.startswith("max_crush"):
        return impact.max_crush_speeds(0.4)["ab".index(label)]
    if name == "energy_loss":
        return impact.energy_loss
    side = getattr(impact, label)
    return side.before.speed if name.startswith("speed") else getattr(side, name[:-2])


def refined(impact, known, contact, wheels, e):
    """The refined speeds next to each answer of the instant."""
    courses = {label: getattr(impact, label).before.course for label in "ab"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        instants = reconstruct.speeds(
            impact.a.before,
            impact.b.before,
            **{f"course_{label}": course for label, course in courses.items()},
            **known,
            **contact,
            restitution=e,
        )
    directions = {label: (math.cos(at), math.sin(at)) for label, at in courses.items()}
    for instant in instants:
        start = [
            side.before.vx * directions[label][0] + side.before.vy * directions[label][1]
            for label, side in (("a", instant.a), ("b", instant.b))
        ]
        inputs = replace(instant.inputs, **wheels)
        yield start, speeds_with_tyres(inputs, directions, tuple(start), known, ())


@pytest.mark.slow
@pytest.mark.parametrize("names", PAIRS, ids=lambda names: "-".join(names))
def test_the_speeds_of_a_forward_answer_are_found_again(names):
    rng, met, moved = random.Random(41), 0, []
    while met < 5:
        a, b, e, contact, wheels = drawn(rng, stuck=names[0] in COMPONENTS)
        try:
            impact = col.eccentric(a, b, e, **contact, **wheels)
        except (col.NoImpactError, col.NoSolutionError):
            continue
        if impact.normal_impulse < 3000.0:
            continue
        known = {name: read(impact, name) for name in names}
        if "ees_a" in known or "max_crush_speed_a" in known:
            other = next(name for name in known if name[:3] in ("ees", "max")).removesuffix("a")
            known[f"{other}b"] = read(impact, f"{other}b")
        truth = [impact.a.before.speed, impact.b.before.speed]
        try:
            found = list(refined(impact, known, contact, wheels, e))
        except col.NoSolutionError:
            # An instant with these values does not exist.
            continue
        apart = [
            (
                max(abs(np.subtract((one.speed_a, one.speed_b), truth))),
                max(abs(np.subtract(start, truth))),
            )
            for start, one in found
            if one.settled
        ]
        if not apart:
            continue
        met += 1
        nearest, instant = min(apart)
        moved.append(instant)
        assert nearest < 1e-6
    # The instant was off.
    assert np.median(moved) > 0.05


@pytest.mark.slow
def test_a_batch_has_the_answers_of_its_cases():
    rng = random.Random(43)
    while True:
        a, b, e, contact, wheels = drawn(rng, stuck=False)
        try:
            impact = col.eccentric(a, b, e, **contact, **wheels)
            break
        except (col.NoImpactError, col.NoSolutionError):
            continue
    known = {"speed_b": read(impact, "speed_b"), "delta_v_a": read(impact, "delta_v_a")}
    ((start, one),) = list(refined(impact, known, contact, wheels, e))[:1]
    durations = np.array([wheels["duration"], 0.5 * wheels["duration"]])
    inputs = replace(impact.inputs, duration=durations)
    courses = {label: getattr(impact, label).before.course for label in "ab"}
    directions = {label: (math.cos(at), math.sin(at)) for label, at in courses.items()}
    many = speeds_with_tyres(inputs, directions, tuple(start), known, (2,))
    assert many[0][0] == pytest.approx(one[0], rel=1e-11)
    assert many[2].tolist() == [True, True]
    assert abs(many[0][1] - one[0]) > 0.01


A, B = UNLIKE
CONTACT = {"normal": 0.0713, "point": (0.0531, 0.0917), "friction": 0.4137}
COURSES = {"course_a": A.course, "course_b": B.course}


def ended(**changes):
    return col.eccentric(A, B, 0.1531, **(CONTACT | WHEELS | changes))


def asked(known, **changes):
    return reconstruct.speeds(
        A,
        B,
        **COURSES,
        restitution=0.1531,
        **known,
        **(CONTACT | WHEELS | {"forward_only": True} | changes),
    )


def apart_from_truth(found):
    return max(abs(found.a.before.speed - A.speed), abs(found.b.before.speed - B.speed))


@pytest.mark.slow
@pytest.mark.parametrize("names", PAIRS, ids=lambda names: "-".join(names))
def test_speeds_takes_tyres(names):
    friction = {"friction": math.inf} if names[0] in COMPONENTS else {}
    stuck = {"regime": "sticking"} if friction else {}
    end = ended(**friction)
    known = {name: read(end, name) for name in names}
    for name in list(known):
        if name in ("ees_a", "max_crush_speed_a"):
            known[f"{name[:-1]}b"] = read(end, f"{name[:-1]}b")
    answers = asked(known, **friction, **stuck)
    off = [apart_from_truth(one) for one in answers]
    assert min(off) < 1e-8
    best = answers[int(np.argmin(off))]
    assert best.inputs.duration == WHEELS["duration"]
    looked, left = (
        [one for one in best.statements if one.startswith(f"found with tyres: {what}")]
        for what in ("answers are looked for", "of delta-V that leaves out")
    )
    assert (len(looked), len(left)) == (1, 1)
    backwards = [one for one in best.statements if "goes backwards along its course: left" in one]
    assert len(best.statements) == 2 + len(backwards)
    page = col.report(best, form="markdown")
    assert "Found with tyres: answers are looked for" in page
    for name, value in known.items():
        if not name.startswith(("ees", "max")):
            assert read(best, name) == pytest.approx(value, rel=1e-8)
    instants = reconstruct.speeds(
        A,
        B,
        **COURSES,
        restitution=0.1531,
        **known,
        **(CONTACT | friction | stuck),
        forward_only=True,
    )
    assert min(apart_from_truth(one) for one in instants) > 0.01
    assert sum("found as an instant" in one for one in instants[0].statements) == 1


@pytest.mark.slow
def test_an_answer_is_explained_reported_and_recorded():
    end = ended()
    (found, *_) = asked({"speed_b": B.speed, "delta_v_a": end.a.delta_v}, duration="101.3 ms")
    page = col.report(found, form="markdown", units="si", figures=False)
    for text in (explain(found, units="si", form="text"), page.partition("## Record")[0]):
        for number in (0.1013, *WHEELS["tyres_a"].named.values()):
            assert f"{number:.6g}" in text
    assert replay(page) == found
    assert col.report(replay(page), form="markdown", units="si", figures=False) == page


@pytest.mark.slow
def test_a_batch_of_speeds_with_tyres():
    end = ended()
    known = {"speed_b": B.speed, "delta_v_a": end.a.delta_v}
    durations = np.array([0.05, 0.1013, -0.1])
    with pytest.warns(col.CollisionsWarning, match="not_positive"):
        many = asked(known, duration=durations)
    speeds = many[0].a.before.vx
    assert np.isnan(speeds).tolist() == [False, False, True]
    (one, *_) = asked(known, duration=0.05)
    assert speeds[0] == pytest.approx(one.a.before.vx, rel=1e-10)


def test_what_speeds_cannot_use_with_tyres_is_refused():
    known = {"speed_b": 6.0, "delta_v_a": 5.0}
    with pytest.raises(col.InputError, match="a function of restitution and tyres"):
        reconstruct.speeds(
            A, B, **COURSES, restitution=lambda speed: 0.1, **known, **CONTACT, **WHEELS
        )
    with pytest.raises(col.InputError, match="tyres need a duration"):
        asked(known, duration=None)


@pytest.mark.slow
def test_a_speed_beside_components_is_met_exactly():
    """As without tyres, readings that disagree with it by their errors leave it as it was given."""
    end = ended()
    known = {name: 1.02 * read(end, name) for name in COMPONENTS[:2]} | {"speed_b": B.speed}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.IllConditionedWarning)
        (found, *_) = asked(known)
        (instant, *_) = asked(known, duration=None, tyres_a=None, tyres_b=None)
    for one in (found, instant):
        assert one.b.before.speed == pytest.approx(B.speed, rel=1e-9)
    # The readings are two percent too large, and so is what they tell of A's speed beyond B's.
    assert found.a.before.speed == pytest.approx(A.speed, rel=0.03)


@pytest.mark.parametrize(
    ("beside", "argument"),
    [
        ({"recorder_a": (0.5, 0.1)}, "recorder_a"),
        ({"axes": "turning"}, "axes"),
        ({"slid": "bound"}, "slid"),
    ],
)
def test_an_energy_beside_readings_is_refused_with_tyres(beside, argument):
    known = {name: read(ended(), name) for name in (*COMPONENTS[:2], "energy_loss")}
    with pytest.raises(col.InputError, match="energy_loss and tyres") as refused:
        asked(known, **beside)
    assert refused.value.code == "bad_combination"
    assert refused.value.fields["argument"] == argument
    # A duration alone is that of nothing.
    with pytest.raises(col.InputError, match="or give tyres_a"):
        asked({name: known[name] for name in COMPONENTS[:2]}, tyres_a=None, tyres_b=None)


@pytest.mark.slow
def test_what_leaves_open_whether_it_stuck_has_both_answers_with_tyres():
    known = {name: read(ended(friction=math.inf), name) for name in COMPONENTS[:2]}
    with pytest.raises(col.AmbiguousSolutionError, match="stuck or slid") as open_:
        asked(known, friction=math.inf)
    stuck, slid = open_.value.solutions
    assert stuck.inputs.duration == slid.inputs.duration == WHEELS["duration"]
    assert apart_from_truth(stuck) < 1e-8
    # Without the tyres, whose force is taken from there, that ratio would slide.
    assert apart_from_truth(slid) < 0.1


@pytest.mark.slow
@pytest.mark.slow
def test_a_bound_with_a_car_going_backwards_says_that_it_is_of_such_cars():
    """At walking pace the tyres may explain the components with B backwards."""
    heading, wheels = 1.00438, Tyres(0.7, 0.3, 2.6, 1.5)
    a = col.Vehicle(mass=1923.14, vx=6.21076, yaw_inertia=3523.54, x=-2.1, y=-0.751714, heading=0.0)
    b = col.Vehicle(
        mass=2048.57, vx=3.32425, vy=5.22748, yaw_inertia=4300.39, x=1.13097, y=1.06335,
        heading=heading,
    )  # fmt: skip
    contact = {"normal": 0.19242804, "point": (0.0, 0.0)}
    contact |= {"duration": 0.1, "tyres_a": wheels, "tyres_b": wheels}
    impact = col.eccentric(a, b, 0.0744412, friction=0.208778, **contact)
    said = "the bound is of cars that go so, and says nothing of those that go forwards"
    with pytest.warns(col.OutOfRangeWarning, match=said):
        (found,) = reconstruct.speeds(
            a,
            b,
            course_a=0.0,
            course_b=heading,
            restitution=0.0744412,
            friction=math.inf,
            delta_v_forward_a=impact.a.delta_v_forward,
            delta_v_left_a=impact.a.delta_v_left,
            slid="bound",
            **contact,
        )
    assert np.hypot(found.b.before.vx, found.b.before.vy) > 0.5
    assert found.b.before.vy < 0.0


@pytest.mark.slow
def test_a_contact_that_slid_with_tyres_has_a_bound_that_the_truth_lies_beyond():
    """Forward answers that slid: each speed is on the side that is said, of the bound."""
    rng, met = random.Random(45), 0
    while met < 6:
        a, b, e, contact, wheels = drawn(rng, stuck=False)
        try:
            impact = col.eccentric(a, b, e, **contact, **wheels)
        except (col.NoImpactError, col.NoSolutionError):
            continue
        if impact.normal_impulse < 3000.0 or impact.regime != "sliding":
            continue
        met += 1
        known = {name: read(impact, name) for name in COMPONENTS}
        courses = {f"course_{label}": getattr(impact, label).before.course for label in "ab"}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            (found,) = reconstruct.speeds(
                a, b, restitution=e, **courses, **contact, **wheels, **known, slid="bound"
            )
        sides = found.reconstruction.one_sided
        assert sides["speed_a"] or sides["speed_b"]
        for label in "ab":
            beyond = getattr(impact, label).before.speed - getattr(found, label).before.speed
            side = sides[f"speed_{label}"]
            assert side * beyond > 0.0 if side else abs(beyond) < 0.5
        # It only just slides, or sticks, and the impulse is that of the components but for what
        # the tyres do otherwise at the other speeds.
        assert abs(found.slip_after) < 1e-6
        assert 0.9 < abs(found.impulse_ratio) / contact["friction"] < 1.0 + 1e-9
        assert found.normal_impulse == pytest.approx(impact.normal_impulse, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize(
    "names",
    [
        ("speed_a", "delta_v_b"),
        ("delta_v_a", "energy_loss"),
        ("speed_a", "energy_loss"),
        ("delta_v_a", "speed_b"),
    ],
    ids=lambda names: "-".join(names),
)
def test_no_speeds_of_a_forward_answer_are_missed(names):
    """Also where an instant without tyres has other answers, or none."""
    rng, without = random.Random(53), 0
    met = 0
    while met < 12:
        a, b, e, contact, wheels = drawn(rng, stuck=False)
        try:
            impact = col.eccentric(a, b, e, **contact, **wheels)
        except (col.NoImpactError, col.NoSolutionError):
            continue
        if impact.normal_impulse < 3000.0:
            continue
        met += 1
        known = {name: read(impact, name) for name in names}
        courses = {f"course_{v}": getattr(impact, v).before.course for v in "ab"}
        given = {**known, **courses, **contact, "restitution": e}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            found = reconstruct.speeds(a, b, **given, **wheels)
            try:
                instants = len(reconstruct.speeds(a, b, **given))
            except col.NoSolutionError:
                instants = 0
        without += instants < len(found)
        off = [
            max(abs(one.a.before.vx - a.vx), abs(one.a.before.vy - a.vy),
                abs(one.b.before.vx - b.vx), abs(one.b.before.vy - b.vy))
            for one in found
        ]  # fmt: skip
        assert min(off) < 1e-5
        for one in found:
            again = col.eccentric(one.a.before, one.b.before, e, **contact, **wheels)
            for name, value in known.items():
                assert read(again, name) == pytest.approx(value, rel=1e-6)
    if "energy_loss" in names and "delta_v_a" in names:
        assert without  # Else nothing here needed more than the instant.


@pytest.mark.slow
def test_components_of_a_contact_that_stuck_may_have_several_answers_with_tyres():
    """Three pairs of speeds have these components by ``eccentric``; the instant leads to the last
    alone.
    """
    rear = (0.02, 0.88, 0.61, 0.57)
    wheels = {
        "tyres_a": Tyres(0.263, 1, 2.65, 1.59, steer=0.231),
        "tyres_b": Tyres(0.866, rear, 2.45, 1.42, height=0.42),
        "duration": 0.12,
    }
    a = col.Vehicle(mass=895, yaw_inertia=1236, x=-2.175, y=0.691, heading=2.556, vx=4.91, vy=5.91)
    b = col.Vehicle(
        mass=2143, yaw_inertia=3896, x=1.877, y=-0.893, heading=-2.985, vx=-14.61, vy=-7.75,
        yaw_rate=-1.806,
    )  # fmt: skip
    contact = {"normal": 0.16, "point": (-0.013, 0.007), "friction": 0.9}
    impact = col.eccentric(a, b, 0.373, **contact, **wheels)
    assert impact.regime == "sticking"
    known = {name: read(impact, name) for name in ("delta_v_forward_b", "delta_v_left_b")}
    courses = {f"course_{v}": getattr(impact, v).before.course for v in "ab"}
    given = {**known, **courses, **contact, **wheels, "restitution": 0.373}
    found = reconstruct.speeds(a, b, **given, regime="sticking")
    assert len(found) == 3
    assert min(abs(one.a.before.speed - a.speed) for one in found) < 1e-5
    for one in found:
        again = col.eccentric(one.a.before, one.b.before, 0.373, **contact, **wheels)
        assert {name: read(again, name) for name in known} == pytest.approx(known, rel=1e-8)
    several = {name: np.array([value, value]) for name, value in known.items()}
    batch = reconstruct.speeds(a, b, **{**given, **several}, regime="sticking")
    for one, both in zip(found, batch, strict=True):
        assert both.a.before.speed == pytest.approx(one.a.before.speed, rel=1e-9)


BOUNDED = {
    "at an angle": (
        {
            "mass": 2494,
            "yaw_inertia": 2641,
            "x": -2.17,
            "y": -0.56,
            "heading": -0.02,
            "speed": 3.99,
        },
        {"mass": 996, "yaw_inertia": 3479, "x": 1.65, "y": 0.42, "heading": -1.2, "speed": 0.535},
        {"normal": 0.041, "point": (0.0, 0.089), "friction": 0.665, "restitution": 0.203},
        (0.099, 0.078, 0.944),
        3,
    ),
    "nearly in line": (
        {"mass": 2101, "yaw_inertia": 3031, "x": -2.17, "y": 0.58, "heading": 0.149, "speed": 6.66},
        {"mass": 1177, "yaw_inertia": 1945, "x": 1.79, "y": -0.29, "heading": 0.204, "speed": 2.36},
        {"normal": 0.053, "point": (0.0, 0.228), "friction": 0.768, "restitution": 0.263},
        (0.08, 0.53, 0.542),
        2,
    ),
}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("case", BOUNDED)
def test_a_bound_leaves_out_no_answer_of_a_contact_that_stuck(case):
    """Where a contact stuck nothing is open, so that a bound asks for the same answers."""
    *bodies, contact, (duration, lock_a, lock_b), count = BOUNDED[case]
    wheels = {
        "duration": duration,
        "tyres_a": Tyres(0.7, lock_a, 2.7, 1.5),
        "tyres_b": Tyres(0.6, lock_b, 2.6, 1.5),
    }
    a, b = (
        col.Vehicle.from_speed(speed=body.pop("speed"), course=body["heading"], **body)
        for body in map(dict, bodies)
    )
    impact = col.eccentric(a, b, **contact, **wheels)
    assert impact.regime == "sticking"
    known = {name: read(impact, name) for name in COMPONENTS[:2]}
    courses = {f"course_{v}": getattr(impact, v).before.course for v in "ab"}
    given = {**known, **courses, **contact, **wheels}
    found = reconstruct.speeds(a, b, **given)
    bounded = reconstruct.speeds(a, b, **given, slid="bound")
    assert len(found) == len(bounded) == count
    assert found[0].a.before.speed == pytest.approx(a.speed, rel=1e-6)
    for one, other in zip(found, bounded, strict=True):
        assert other.a.before.speed == one.a.before.speed
        assert other.b.before.speed == one.b.before.speed
        assert other.reconstruction.one_sided == {"speed_a": 0, "speed_b": 0}


@pytest.mark.slow
def test_no_speeds_of_a_contact_that_stuck_are_missed():
    """From both components of one vehicle."""
    rng, met = random.Random(54), 0
    while met < 25:
        a, b, e, contact, wheels = drawn(rng, stuck=True)
        try:
            impact = col.eccentric(a, b, e, **contact, **wheels)
        except (col.NoImpactError, col.NoSolutionError):
            continue
        if impact.normal_impulse < 3000.0 or impact.regime != "sticking":
            continue
        met += 1
        label = rng.choice("ab")
        names = (f"delta_v_forward_{label}", f"delta_v_left_{label}")
        courses = {f"course_{v}": getattr(impact, v).before.course for v in "ab"}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            found = reconstruct.speeds(
                a, b, restitution=e, regime="sticking", **contact, **wheels, **courses,
                **{name: read(impact, name) for name in names},
            )  # fmt: skip
        off = [
            abs(one.a.before.vx - a.vx) + abs(one.a.before.vy - a.vy)
            + abs(one.b.before.vx - b.vx) + abs(one.b.before.vy - b.vy)
            for one in found
        ]  # fmt: skip
        assert min(off) < 1e-4


@pytest.mark.slow
def test_speeds_that_no_instant_leads_to():
    """12 and 5 m/s have these values by ``eccentric``; an instant has none of them."""
    a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2, y=0.3, heading=0, vx=12.0)
    b = col.Vehicle(mass=1500, yaw_inertia=2500, x=0.9, y=-0.3, heading="90 deg", vy=5.0)
    locked = Tyres(0.7, 1, 2.7, 1.5)
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5, "restitution": 0.1}
    lasts = {"duration": 0.1, "tyres_a": locked, "tyres_b": locked}
    impact = col.eccentric(a, b, **contact, **lasts)
    given = {"course_a": "0 deg", "course_b": "90 deg"}
    given |= {"delta_v_a": impact.a.delta_v, "energy_loss": impact.energy_loss}
    with pytest.raises(col.NoSolutionError):
        reconstruct.speeds(a, b, **contact, **given)
    (best,) = reconstruct.speeds(a, b, **contact, **given, **lasts, forward_only=True)
    assert best.a.before.speed == pytest.approx(12.0, rel=1e-9)
    assert best.b.before.speed == pytest.approx(5.0, rel=1e-9)
    known = {"course_a": "0 deg", "course_b": "90 deg", "speed_a": 12.0, "delta_v_b": 60.0}
    with pytest.raises(col.NoSolutionError, match=r"is missed\. .*posterior with wide priors"):
        reconstruct.speeds(a, b, **contact, **known, **lasts, forward_only=True)


@pytest.mark.slow
def test_a_known_value_that_any_speed_fits_is_refused():
    """A contact that slides gives the struck car the same delta-V whatever its own speed is, with
    tyres as without.
    """
    a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2, y=0.3, heading=0, vx=15.0)
    b = col.Vehicle(mass=1500, yaw_inertia=2500, x=0.9, y=-0.3, heading="90 deg", vy=10.0)
    free = Tyres(0.7, 0, 2.7, 1.5)
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.3, "restitution": 0.1}
    lasts = {"duration": 0.1, "tyres_a": free, "tyres_b": free}
    for more in ({}, lasts):
        delta_v = col.eccentric(a, b, **contact, **more).b.delta_v
        known = {"course_a": 0.0, "course_b": "90 deg", "speed_a": 15.0, "delta_v_b": delta_v}
        with pytest.raises(col.NoSolutionError, match="leave the other speed open") as refused:
            reconstruct.speeds(a, b, **contact, **known, **more)
        assert refused.value.code == "undetermined"


def test_each_root_is_given_once():
    """Searches find a root again beside another of the same closing speed, and some end apart by
    its condition times the share to which they meet what is known.
    """
    scene = SimpleNamespace(shape=(), plain=False, undetermined=np.False_, ambiguous=np.False_)
    roots = [
        Root(8.7, 7.3, 0.1, 300.0, 8.5),
        Root(8.3, -5.2, 0.1, 260.0, 8.5),
        Root(8.7 + 1e-9, 7.3, 0.1, 300.0, 8.5 + 1e-12),
        Root(12.20078, 17.56466, 0.1, 2.3e6, 13.5),
        Root(12.20077, 17.56472, 0.1, 2.3e6, 13.5),
    ]
    found = in_order(scene, roots, SETTLED)
    assert [float(root.speed_b) for root, _ in found] == [7.3, -5.2, 17.56466]
    # Roots of the algebra are right to rounding.
    assert len(in_order(scene, roots)) == 4
    for condition in (math.inf, math.nan):
        twice = [Root(4.0, 0.0, 0.0, condition, 4.0), Root(4.0, 2.5e-15, 0.0, condition, 4.0)]
        for met in (0.0, SETTLED):
            assert len(in_order(scene, twice, met)) == 1


@pytest.mark.slow
@pytest.mark.parametrize("rule", ["friction", "impulse_ratio", "critical_fraction"])
def test_a_contact_without_friction_tells_of_the_closing_speed(rule):
    """All speeds of one closing speed have its delta-V and energy, with tyres that pull alike over
    a range of speeds too: here any of B from 4.65 to 6.45 m/s.
    """
    courses, normal = (0.32540355, -2.08149278), -0.037686
    a = col.Vehicle(mass=1007.13, yaw_inertia=2741.64, x=-2.37303, y=0.436196, heading=0.182627)
    b = col.Vehicle(mass=1231.41, yaw_inertia=2093.17, x=2.31029, y=0.0238404, heading=-1.0436)
    contact = {"normal": normal, "point": (-0.042512, 0.453494), rule: 0.0}
    lasts = {
        "duration": 0.1524106,
        "tyres_a": Tyres(0.554799, 0, 2.6, 1.5),
        "tyres_b": Tyres(0.371585, 0.05, 2.6, 1.5),
    }
    along = [math.cos(course - normal) for course in courses]
    shown = []
    for speed_b in (4.82, 5.3, 5.82, 6.32):
        speed_a = 11.644 + (speed_b - 4.82) * along[1] / along[0]
        bodies = [
            body.replace(vx=speed * math.cos(course), vy=speed * math.sin(course))
            for body, speed, course in zip((a, b), (speed_a, speed_b), courses, strict=True)
        ]
        impact = col.eccentric(*bodies, 0.0, **contact, **lasts)
        shown.append((impact.a.delta_v, impact.energy_loss))
    for one in shown[1:]:
        assert one == pytest.approx(shown[0], rel=1e-13)
    known = {"delta_v_a": shown[0][0], "energy_loss": shown[0][1], "restitution": 0.0}
    known |= {"course_a": courses[0], "course_b": courses[1]}
    with pytest.raises(col.NoSolutionError, match="by what the tyres add") as refused:
        reconstruct.speeds(a, b, **contact, **known, **lasts)
    assert refused.value.code == "undetermined"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        many = reconstruct.speeds(a, b, **contact | {rule: np.array([0.0, 0.2])}, **known, **lasts)
    for one in many:
        assert one.status[0] == col.Status.UNDETERMINED


@pytest.mark.slow
@pytest.mark.parametrize("locks", [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
def test_contacts_at_the_edge_between_stuck_and_slid_have_an_answer(locks):
    """Forward impacts that slid, less and less: their components and A's speed lead back to each.

    Near the edge the tyres of a contact that stuck make it one that slid, and the other way round:
    it may have been either, so the truth lies at the answer or on the side that is left open.
    """
    a = col.Vehicle.from_speed(
        mass=1500, yaw_inertia=2500, speed=14.0, course=0.0, heading=0.0, x=-2.0, y=0.3
    )
    b = col.Vehicle.from_speed(
        mass=1200, yaw_inertia=1900, speed=11.0, course=1.4, heading=1.4, x=0.9, y=-0.5
    )
    wheels = {
        "duration": 0.16,
        "tyres_a": Tyres(0.9, locks[0], 2.7, 1.5),
        "tyres_b": Tyres(0.9, locks[1], 2.6, 1.5),
    }
    contact = {"normal": 0.1, "point": (0.0, 0.0)}
    forward = col.eccentric(a, b, 0.1, friction=np.linspace(0.35, 0.5, 78), **contact, **wheels)
    known = {name: read(forward, name) for name in COMPONENTS[:2]}
    with warnings.catch_warnings():
        # Without the tyres some differ from their best common answer.
        warnings.simplefilter("ignore", col.IllConditionedWarning)
        (found,) = reconstruct.speeds(
            a,
            b,
            course_a=0.0,
            course_b=1.4,
            speed_a=14.0,
            restitution=0.1,
            friction=math.inf,
            slid="bound",
            **known,
            **contact,
            **wheels,
        )
    assert not np.any(found.refused)
    side = found.reconstruction.one_sided["speed_b"]
    off = 11.0 - found.b.before.speed
    assert np.all(abs(off[side == 0]) < 1e-6)
    assert np.all(off[side != 0] * side[side != 0] > 0.0)
    assert 0 < np.count_nonzero(side) < side.size


@pytest.mark.slow
def test_beside_a_speed_a_case_is_the_same_alone_in_a_batch_and_with_a_bound():
    """Components that differ are met by least squares, whatever the other cases leave open."""
    wheels = Tyres(0.7, 0.3, 2.7, 1.5)
    bodies = {
        "a": {"mass": 2470.5, "yaw_inertia": 4222.5, "heading": 0.05706, "yaw_rate": -0.25685},
        "b": {
            "mass": 2291.5, "yaw_inertia": 4722.6, "x": 3.7988, "heading": 4.4979,
            "yaw_rate": 0.23584,
        },
    }  # fmt: skip
    contact = {
        "restitution": 0.32988, "normal": 0.14559, "point": (1.7033, 0.8067), "friction": math.inf,
        "duration": 0.1, "tyres_a": wheels, "tyres_b": wheels,
    }  # fmt: skip
    cars = [col.Vehicle(**{"x": 0.0, "y": 0.0, **fields}) for fields in bodies.values()]
    known = {"speed_b": 8.949, "delta_v_forward_a": -6.04465, "delta_v_left_a": -1.3205}
    # The other case leaves open whether it stuck or slid.
    beside = {"speed_b": 8.0, "delta_v_forward_a": -4.0, "delta_v_left_a": -0.6}

    def missed(speed):
        moving = [
            col.Vehicle.from_speed(speed=v, course=course, **{"x": 0.0, "y": 0.0, **fields})
            for v, course, fields in zip(
                (speed, known["speed_b"]), (0.07229, 4.56458), bodies.values(), strict=True
            )
        ]
        impact = col.eccentric(*moving, **contact)
        return sum((read(impact, name) - known[name]) ** 2 for name in COMPONENTS[:2])

    def found(**options):
        (one,) = reconstruct.speeds(*cars, course_a=0.07229, course_b=4.56458, **contact, **options)
        return one.a.before.speed

    best = optimize.minimize_scalar(missed, bounds=(9.5, 10.5), options={"xatol": 1e-9}).x
    alone = found(**known)
    assert alone == pytest.approx(best, abs=1e-5)
    assert found(**known, slid="bound") == pytest.approx(alone, rel=1e-9)
    with pytest.warns(col.CollisionsWarning):
        both = found(**{name: np.array([known[name], beside[name]]) for name in known})
    assert both[0] == pytest.approx(alone, rel=1e-9)
    assert math.isnan(both[1])


@pytest.mark.slow
@pytest.mark.parametrize("slid", [None, "bound"])
def test_a_speed_and_one_component_of_a_contact_that_slid_lead_back_to_it(slid):
    wheels = Tyres(0.7, 0.3, 2.7, 1.5)
    a, b = (
        col.Vehicle.from_speed(
            mass=mass, yaw_inertia=2 * mass, speed=speed, course=course, heading=course, x=x, y=0
        )
        for mass, speed, course, x in ((2470, 12.0, 0.057, 0.0), (2291, 9.0, 4.498, 3.8))
    )
    contact = {
        "restitution": 0.33, "normal": 0.146, "point": (1.7, 0.81), "friction": 0.02,
        "duration": 0.1, "tyres_a": wheels, "tyres_b": wheels,
    }  # fmt: skip
    impact = col.eccentric(a, b, **contact)
    assert impact.regime == "sliding"
    (found,) = reconstruct.speeds(
        a, b, course_a=0.057, course_b=4.498, **contact, slid=slid, speed_b=9.0,
        delta_v_forward_a=impact.a.delta_v_forward,
    )  # fmt: skip
    assert found.a.before.speed == pytest.approx(12.0, rel=1e-9)
    assert found.regime == "sliding"


# Speeds, courses, yaw rates and places aside of A and B, normal, point, restitution, duration,
# wheels, and what is known.
MET_FROM_AFAR = {
    "components and energy": (
        (15.68985171994705, 12.172055850289476), (-0.3832674716265385, 2.4983921716109276),
        (-0.0330379, 0.130253), (0.302742, -0.974293), 0.33918891159121933, 0.17813544077384794,
        0.05750901722254286, 0.05389684819440878,
        Tyres(0.643958, (0.606346, 0.876025, 0.897866, 0.989294), 2.7, 1.5, steer=-0.160297),
        0.993629, ("delta_v_forward_b", "delta_v_left_b", "energy_loss"),
    ),
    "components and a speed": (
        (3.684547774124127, 4.626021840494893), (0.2831799093874533, 1.8851381893599877),
        (-0.0178232, -0.355592), (-0.143217, -0.181866), 0.3614547318133461, 0.570423172050814,
        0.2821664529186353, 0.09088965198835418,
        Tyres(0.415736, (0.828021, 0.800255, 0.522253, 0.363955), 2.7, 1.5, steer=-0.0863032),
        0.413604, (*COMPONENTS, "speed_a"),
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("case", MET_FROM_AFAR)
def test_speeds_that_meet_more_than_is_needed_are_found_from_afar(case):
    """The contact slid, and where the instant without tyres leads to misses what was known."""
    pair, courses, spins, aside, normal, y, e, duration, tyres, lock, names = MET_FROM_AFAR[case]
    a, b = (
        col.Vehicle.from_speed(
            mass=mass, yaw_inertia=inertia, x=x, y=y_of, speed=speed, course=course,
            heading=course, yaw_rate=spin,
        )
        for mass, inertia, x, y_of, speed, course, spin in zip(
            (1500, 1300), (2500, 2000), (-2, 1), aside, pair, courses, spins, strict=True
        )
    )  # fmt: skip
    contact = {"normal": normal, "point": (0, y), "friction": 0.15}
    wheels = {"duration": duration, "tyres_a": tyres, "tyres_b": Tyres(0.7, lock, 2.7, 1.5)}
    impact = col.eccentric(a, b, e, **contact, **wheels)
    assert impact.regime == "sliding"
    shown = {"energy_loss": impact.energy_loss, "speed_a": pair[0]}
    shown |= {name: getattr(getattr(impact, name[-1]), name[:-2]) for name in COMPONENTS}
    found = reconstruct.speeds(
        a, b, course_a=courses[0], course_b=courses[1], restitution=e, regime="sliding",
        **contact, **wheels, **{name: shown[name] for name in names},
    )  # fmt: skip
    for one in found:
        again = col.eccentric(one.a.before, one.b.before, e, **contact, **wheels)
        for name in names:
            if name.startswith("delta_v"):
                told = getattr(getattr(again, name[-1]), name[:-2])
                assert told == pytest.approx(shown[name], abs=1e-4)
    speeds = [(one.a.before.speed, one.b.before.speed) for one in found]
    assert any(one == pytest.approx(pair, rel=1e-4) for one in speeds)


def along_b(impact, course):
    """The speed of B along its course, below 0 backwards."""
    return impact.b.before.vx * math.cos(course) + impact.b.before.vy * math.sin(course)


@pytest.mark.slow
def test_beside_a_known_speed_one_of_three_answers_is_not_left_out():
    """A scan with ``eccentric`` shows three speeds of B; starts far from it led to two."""
    a = col.Vehicle(
        mass=1739.728238987327, yaw_inertia=1843.589103691465, x=-2.431587015788364,
        y=0.6889392765171745, vx=20.18639496564865, vy=0.17436630524189667,
        yaw_rate=2.7342645368280047, heading=-3.5324468260789894,
    )  # fmt: skip
    b = col.Vehicle(
        mass=1181.1413979377498, yaw_inertia=2956.3723320257973, x=0.7038377971888874,
        y=0.7618864948600468, vx=1.0342615328604339, vy=-4.884434474811593,
        heading=0.7018162579774856,
    )  # fmt: skip
    contact = {
        "normal": 0.7875946241225049, "point": (0.021419555680452507, 0.8792152124118517),
        "friction": 0.7331170443149204, "restitution": 0.0, "duration": 0.14660781764445666,
        "tyres_a": Tyres(
            0.6667788748729144, 0.8600676280633616, 3.021976392522025, 1.5536354356052529,
            steer=0.018320068367342568,
        ),
        "tyres_b": Tyres(
            0.9842339296170557, 0.6958797254257115, 3.818503902761825, 1.9685143385088886
        ),
    }  # fmt: skip
    lost = col.eccentric(a, b, **contact).energy_loss
    assert lost == pytest.approx(140996.3279980885, rel=1e-12)
    known = {"course_a": a.course, "course_b": b.course, "speed_a": a.speed}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        found = reconstruct.speeds(a, b, **known, energy_loss=lost, **contact)
        batch = reconstruct.speeds(
            a, b, **known, energy_loss=np.array([lost, 1.2 * lost, lost]), **contact
        )
    speeds = sorted(along_b(one, b.course) for one in found)
    assert speeds == pytest.approx([-4.444446, 4.992734, 7.825806], abs=1e-6)
    assert any("by a scan of the unknown speed" in text for text in found[0].statements)
    for i in (0, 2):
        both = sorted(float(along_b(one, b.course)[i]) for one in batch)
        assert [one for one in both if math.isfinite(one)] == pytest.approx(speeds, rel=1e-9)


def met_fast_or_slow(rng):
    """Two cars as fast as on roads, either way, turning or not, and their contact."""
    cars = []
    for x, vx in ((rng.uniform(-3, -1), (0, 25)), (rng.uniform(0.5, 3), (-20, 5))):
        mass = rng.uniform(700, 3000)
        cars.append(
            col.Vehicle(
                mass=mass, yaw_inertia=mass * rng.uniform(1, 1.7) ** 2, x=x,
                y=rng.uniform(-1.5, 1.5), vx=rng.uniform(*vx), vy=rng.uniform(-15, 15),
                yaw_rate=rng.choice((0, rng.uniform(-3, 3))), heading=rng.uniform(-4, 4),
            )
        )  # fmt: skip
    contact = {
        "normal": rng.uniform(-0.8, 0.8), "restitution": rng.choice((0, 0.1, rng.uniform(0, 1))),
        "point": (rng.uniform(-0.3, 0.3), rng.uniform(-1, 1)),
        "friction": rng.choice((0, 0.4, math.inf, rng.uniform(0, 1.5))),
        "duration": rng.uniform(0.05, 0.2),
    }  # fmt: skip
    for name in ("tyres_a", "tyres_b"):
        contact[name] = Tyres(
            rng.uniform(0.2, 1), rng.choice((0, 1, rng.uniform(0, 1))), rng.uniform(2, 4),
            rng.uniform(1.2, 2), steer=rng.choice((0, rng.uniform(-0.5, 0.5))),
        )  # fmt: skip
    return *cars, contact


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.EnergyGainWarning")
def test_beside_a_known_speed_no_answer_that_a_scan_shows_is_missed():
    rng, met, several = random.Random(6), 0, 0
    while met < 80:
        a, b, contact = met_fast_or_slow(rng)
        name = rng.choice(("energy_loss", "delta_v_a", "delta_v_b"))
        try:
            impact = col.eccentric(a, b, **contact)
        except (col.NoImpactError, col.NoSolutionError):
            continue
        value, course = read(impact, name), b.course
        if value < 0.1:
            continue
        met += 1
        given = {**contact, name: value, "speed_a": a.speed}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            found = reconstruct.speeds(a, b, **given, course_a=a.course, course_b=course)
        speeds = np.array([along_b(one, course) for one in found])
        assert min(abs(speeds - b.speed)) < 1e-5 * (1.0 + b.speed)
        for one in found:
            again = col.eccentric(one.a.before, one.b.before, **contact)
            assert read(again, name) == pytest.approx(value, rel=1e-6)
        # With a step that no place of the search has.
        tried = b.speed + np.arange(-40.0, 40.0, 0.0217)
        moving = b.replace(vx=tried * math.cos(course), vy=tried * math.sin(course))
        missed = read(col.eccentric(a, moving, **contact, on_failure="nan"), name) - value
        (at,) = np.nonzero(missed[:-1] * missed[1:] < 0.0)
        several += at.size > 1
        for speed in 0.5 * (tried[at] + tried[at + 1]):
            assert min(abs(speeds - speed)) < 0.02
    assert several


@pytest.mark.parametrize(
    "known",
    [
        {"delta_v_forward_b": [], "delta_v_left_b": 2.0, "recorder_b": (0.5, 0.1)},
        {"speed_a": [], "delta_v_b": 5.0},
        {"speed_a": 10.0, "energy_loss": []},
    ],
)
def test_a_batch_of_no_cases_has_none(known):
    wheels = Tyres(0.7, 0.2, 2.7, 1.5)
    a, b = (
        col.Vehicle(mass=mass, yaw_inertia=2000.0, x=x, y=y, heading=heading)
        for mass, x, y, heading in ((1500.0, -2.0, 0.3, 0.0), (1200.0, 0.9, -0.5, 1.4))
    )
    (found,) = reconstruct.speeds(
        a, b, course_a=0.0, course_b=1.4, restitution=0.1, friction=0.5, normal=0.0,
        point=(0.0, 0.0), duration=0.1, tyres_a=wheels, tyres_b=wheels,
        **{name: np.array(value) if value == [] else value for name, value in known.items()},
    )  # fmt: skip
    assert found.status.shape == found.a.before.speed.shape == (0,)


@pytest.mark.slow
def test_an_energy_beside_components_finds_a_contact_that_slid_with_tyres():
    """The ratio that the components show is that of the contact alone, without what tyres do: with
    that of an instant both speeds came out metres per second off. Without its friction several
    ratios fit in some, and the call is refused.
    """
    rng, met = random.Random(12), 0
    while met < 12:
        (a, b), contact, wheels = drawn_apart(rng)
        try:
            truth = col.eccentric(a, b, 0.2, **contact, **wheels)
        except (col.NoImpactError, col.NoSolutionError):
            continue
        if truth.regime != "sliding":
            continue
        met += 1
        label = rng.choice("ab")
        names = (f"delta_v_forward_{label}", f"delta_v_left_{label}", "energy_loss")
        known = {name: read(truth, name) for name in names}
        asked = {"course_a": a.course, "course_b": b.course, "restitution": 0.2, **contact}
        answers = reconstruct.speeds(a, b, **asked, **wheels, **known)
        for law in ({"friction": math.inf}, {"friction": math.inf, "regime": "sliding"}):
            with pytest.raises(col.InputError, match="several contacts fit") as refused:
                reconstruct.speeds(a, b, **asked | law, **wheels, **known)
            assert refused.value.code == "bad_combination"
        off = [
            max(abs(one.a.before.speed - a.speed), abs(one.b.before.speed - b.speed))
            for one in answers
        ]
        assert min(off) < 1e-6


@pytest.mark.slow
def test_an_energy_beside_a_component_of_either_vehicle_misses_no_answer_with_tyres():
    """With a known friction; the balance of the tyres by itself leads to other speeds in some."""
    rng = random.Random(31)
    for _ in range(16):
        (a, b), contact, wheels = drawn_apart(rng)
        try:
            truth = col.eccentric(a, b, 0.2, **contact, **wheels)
        except (col.NoImpactError, col.NoSolutionError):
            continue
        names = ("delta_v_forward_a", "delta_v_left_b", "energy_loss")
        answers = reconstruct.speeds(
            a, b, course_a=a.course, course_b=b.course, restitution=0.2, **contact, **wheels,
            **{name: read(truth, name) for name in names},
        )  # fmt: skip
        off = [
            max(abs(one.a.before.speed - a.speed), abs(one.b.before.speed - b.speed))
            for one in answers
        ]
        assert min(off) < 1e-5


def drawn_apart(rng):
    """Two cars whose contact slides, and each wheel of theirs locked, braked or rolling."""
    cars = [
        col.Vehicle.from_speed(
            mass=mass, yaw_inertia=mass * rng.uniform(1.3, 1.9), speed=rng.uniform(5.0, 25.0),
            course=course, heading=course, x=x, y=rng.uniform(-0.6, 0.6),
        )
        for mass, course, x in (
            (rng.uniform(1000, 2300), rng.uniform(-0.3, 0.3), rng.uniform(-2.0, -1.0)),
            (rng.uniform(1000, 2300), rng.uniform(1.0, 2.4), rng.uniform(0.8, 2.0)),
        )
    ]  # fmt: skip
    contact = {
        "normal": rng.uniform(-0.5, 0.5),
        "point": (0.0, rng.uniform(-0.2, 0.2)),
        "friction": rng.uniform(0.05, 0.3),
    }
    wheels: dict[str, object] = {"duration": rng.uniform(0.05, 0.12)}
    for label in "ab":
        locks = [rng.choice((1.0, rng.uniform(0.0, 0.1), 0.4)) for _ in range(4)]
        wheels[f"tyres_{label}"] = Tyres(rng.uniform(0.5, 0.8), locks, 2.7, 1.5)
    return cars, contact, wheels


@pytest.mark.slow
def test_an_answer_beside_the_end_of_all_answers_is_found():
    """The only one within 60 m/s lies in a step of the scan at whose other end there is none."""
    a = col.Vehicle(
        mass=2691.18, yaw_inertia=6110.07, x=-1.37786, y=0.0887, vx=0.29616, vy=1.04998,
        heading=-0.51291,
    )  # fmt: skip
    b = col.Vehicle(
        mass=1161.06, yaw_inertia=1525.22, x=0.60856, y=-0.13889, vx=-0.69983, vy=2.93722,
        yaw_rate=0.59171, heading=-0.53151,
    )  # fmt: skip
    contact = {
        "normal": 0.19864, "restitution": 0.1, "point": (0.21016, -0.86308), "friction": 0.53576,
        "duration": 0.05026, "tyres_a": Tyres(0.85354, 0, 2.28022, 1.68052, steer=0.03284),
        "tyres_b": Tyres(0.60452, 1, 3.30887, 1.7734),
    }  # fmt: skip
    energy = col.eccentric(a, b, **contact).energy_loss
    (found,) = reconstruct.speeds(
        a, b, course_a=a.course, course_b=b.course, speed_b=b.speed, energy_loss=energy, **contact
    )
    assert found.a.before.speed == pytest.approx(a.speed, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("label", ["a", "b"])
@pytest.mark.parametrize("given", [{}, {"friction": math.inf, "regime": "sliding"}])
def test_beside_a_speed_the_condition_is_known_with_tyres(label, given):
    """Other starts lead to the same answer, and do not take its condition away."""
    a = col.Vehicle.from_speed(
        mass=2296, yaw_inertia=4454.24, x=-1.724, y=-0.538, heading=0.17, speed=8.8, course=0.17
    )
    b = col.Vehicle.from_speed(
        mass=1555, yaw_inertia=2254.75, x=1.803, y=0.191, heading=1.621, speed=14.15, course=1.621
    )
    contact = {
        "normal": 0.186, "point": (0.153, -0.125), "friction": 0.446, "restitution": 0.304,
        "duration": 0.064, "tyres_a": Tyres(0.421, 1, 2.71, 1.45),
        "tyres_b": Tyres(0.773, [0.091, 0.027, 0.084, 0.086], 2.81, 1.51, cornering=8.758),
    }  # fmt: skip
    truth = col.eccentric(a, b, **contact)
    names = (f"delta_v_forward_{label}", f"delta_v_left_{label}")
    (found,) = reconstruct.speeds(
        a, b, course_a=a.course, course_b=b.course, speed_a=8.8, **contact | given,
        **{name: read(truth, name) for name in names},
    )  # fmt: skip
    assert found.b.before.speed == pytest.approx(14.15, rel=1e-9)
    assert 1.0 < found.reconstruction.condition < 100.0


@pytest.mark.slow
@pytest.mark.parametrize(
    "names",
    [
        ("delta_v_forward_a", "delta_v_left_a", "energy_loss"),
        ("delta_v_forward_a", "delta_v_left_b", "energy_loss"),
        ("speed_a", "delta_v_forward_a", "delta_v_left_a"),
        ("delta_v_forward_a", "delta_v_left_a"),
        ("delta_v_forward_a", "delta_v_left_b"),
        ("delta_v_a", "energy_loss"),
        ("speed_a", "delta_v_forward_b"),
        ("speed_b", "energy_loss"),
    ],
)
def test_the_condition_is_that_of_the_whole_call_with_tyres(names):
    """By finite differences of each known value, with the tyres worked out again each time."""
    rng, met = random.Random(8), 0
    while met < 2:
        (a, b), contact, wheels = drawn_apart(rng)
        if set(names) <= set(COMPONENTS):
            # Components alone do not hold one that slid.
            contact["friction"] = 0.9
        try:
            truth = col.eccentric(a, b, 0.2, **contact, **wheels)
            known = {name: read(truth, name) for name in names}
            courses = {"course_a": a.course, "course_b": b.course, "restitution": 0.2}

            def found(known, a=a, b=b, rest=courses | contact | wheels):
                with warnings.catch_warnings():
                    # Another answer may go backwards.
                    warnings.simplefilter("ignore", col.CollisionsWarning)
                    answers = reconstruct.speeds(a, b, **rest, **known)
                return min(answers, key=lambda one: abs(one.b.before.speed - b.speed))

            condition = found(known).reconstruction.condition
        except (col.NoImpactError, col.NoSolutionError):
            continue
        met += 1
        sought = "b" if "speed_a" in known else "a" if "speed_b" in known else "ab"
        moved = np.zeros(len(sought))
        for name, value in known.items():
            up, down = (found({**known, name: value * (1.0 + step)}) for step in (1e-5, -1e-5))
            moved += [
                abs(getattr(up, side).before.speed - getattr(down, side).before.speed) / 2e-5
                for side in sought
            ]
        assert condition == pytest.approx(max(moved) / truth.closing_speed, rel=0.02)


BESIDE = [
    (*COMPONENTS[:2], "energy_loss"),
    (*COMPONENTS, "energy_loss"),
    (*COMPONENTS[:2], "ees_a"),
]
NOTHING = Tyres(1e-9, 0.0, 2.7, 1.5)


@pytest.mark.slow
@pytest.mark.parametrize("stuck", [False, True], ids=["slid", "stuck"])
@pytest.mark.parametrize("names", [*PAIRS, *BESIDE, ("speed_a", *COMPONENTS[:2])], ids="-".join)
def test_tyres_that_hold_nothing_change_nothing(names, stuck):
    """Neither answers nor conditions nor warnings, also where readings and an energy differ."""
    rng, met = random.Random(61), 0
    for _ in range(40):
        if met == 3:
            break
        a, b, e, contact, _ = drawn(rng, stuck=False)
        if stuck:
            contact["friction"] = 0.9
        try:
            truth = col.eccentric(a, b, e, **contact)
        except (col.NoImpactError, col.NoSolutionError):
            continue
        if (truth.regime == "sticking") != stuck:
            continue
        known = {name: read(truth, name) for name in names}
        known |= {f"{one[:-1]}b": read(truth, f"{one[:-1]}b") for one in names if one[:3] == "ees"}
        known |= (
            {"max_crush_speed_b": read(truth, "max_crush_speed_b")} if "max" in str(names) else {}
        )
        factor = rng.choice((0.85, 1.0, 1.1, 1.3)) if "energy_loss" in names[2:] else 1.0
        known |= {"energy_loss": factor * known["energy_loss"]} if factor != 1.0 else {}
        given = {"course_a": a.course, "course_b": b.course, "restitution": e, **known, **contact}
        wheels = {"duration": 0.1, "tyres_a": NOTHING, "tyres_b": NOTHING}
        found, codes = [], []
        for more in ({}, wheels):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                try:
                    found.append(reconstruct.speeds(a, b, **given, **more))
                except col.CollisionsError as error:
                    found.append(type(error))
            codes.append({one.message.code for one in caught})
        if isinstance(found[0], tuple) != isinstance(found[1], tuple):
            raise AssertionError(f"{found}, {known}, {contact}")
        if not isinstance(found[0], tuple):
            continue
        met += 1
        assert codes[0] == codes[1]
        assert len(found[0]) == len(found[1])
        for one, other in zip(*found, strict=True):
            for label in "ab":
                speeds = (getattr(each, label).before.speed for each in (one, other))
                assert next(speeds) == pytest.approx(next(speeds), abs=1e-4)
            assert other.reconstruction.condition == pytest.approx(
                one.reconstruction.condition, rel=1e-3
            )


@pytest.mark.slow
@pytest.mark.parametrize("tyres", [False, True], ids=["instant", "tyres"])
def test_beside_an_energy_one_that_slid_is_not_said_to_have_stuck_in_silence(tyres):
    """With its own friction and ordinary errors of the recorder and of the energy: where one that
    stuck fits too, the call is ambiguous, with both in its solutions.
    """
    rng, slid, open_, both = random.Random(77), 0, 0, set()
    while slid + open_ < (24 if tyres else 120):
        (a, b), contact, wheels = drawn_apart(rng)
        more = wheels if tyres else {}
        try:
            truth = col.eccentric(a, b, 0.2, **contact, **more)
        except (col.NoImpactError, col.NoSolutionError):
            continue
        if truth.regime != "sliding":
            continue
        known = {
            name: read(truth, name) * rng.gauss(1.0, 0.03)
            for name in ("delta_v_forward_a", "delta_v_left_a", "energy_loss")
        }
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                answers = reconstruct.speeds(
                    a, b, course_a=a.course, course_b=b.course, restitution=0.2, **known, **contact,
                    **more,
                )  # fmt: skip
            except col.AmbiguousSolutionError as error:
                open_ += 1
                both |= {one.regime for one in error.solutions}
                continue
            except col.NoSolutionError:
                continue
        slid += 1
        regimes = {one.regime for one in answers}
        assert "sliding" in regimes or caught, (a, b, contact, known)
    assert slid > open_
    assert both == {"sticking", "sliding"}


@pytest.mark.slow
def test_a_family_that_slides_either_way_with_tyres_is_told_so():
    """The way in doubt says that it may have slid either way, and not the first of its ways."""
    a = col.Vehicle(
        mass=2297.87932585118, yaw_inertia=4097.223757007686, vx=1.4910420055679954,
        vy=0.24320579303414497, x=-1.7278054892208838, y=0.05200229955909852,
        heading=0.1616874155052443,
    )  # fmt: skip
    b = col.Vehicle(
        mass=1276.7603459456102, yaw_inertia=2259.055821749676, vx=-1.0939322780379372,
        vy=1.3728211399093753, x=1.9754623426023685, y=0.4011965865997328,
        heading=2.243613473594908,
    )  # fmt: skip
    locks = (
        (1.0, 0.023968110718606564, 0.4, 0.4),
        (0.03148337939738334, 1.0, 0.09017901432985659, 3.0202047351157724e-05),
    )
    with pytest.raises(col.AmbiguousSolutionError, match="in which direction the contact slid"):
        reconstruct.speeds(
            a, b, course_a=a.course, course_b=b.course, restitution=0.2,
            normal=-0.21156011733357438, point=(0.0, 0.13085821417700827),
            friction=0.11535437067332155, delta_v_forward_a=-1.287925506855398,
            delta_v_left_b=-0.9759016373868096, duration=0.09021306001782423,
            tyres_a=Tyres(0.6734464678573435, locks[0], 2.7, 1.5),
            tyres_b=Tyres(0.7936661865110097, locks[1], 2.7, 1.5),
            regime="sliding", slid="bound",
        )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.9, 1.0, 1.1])
def test_against_a_wall_with_tyres_an_energy_moves_no_speed(factor):
    """A wall has no delta-V, and all of the impulse is that of the vehicle."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, vx=12.0, x=-2.0, y=0.1, heading=0.0, name="A")
    wall = col.Vehicle(mass=math.inf, yaw_inertia=math.inf, x=0.5, y=0.0)
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.9}
    wheels = {"duration": 0.1, "tyres_a": Tyres(0.7, 0.4, 2.7, 1.5)}
    truth = col.eccentric(a, wall, 0.1, **contact, **wheels)
    assert truth.regime == "sticking"
    known = {name: read(truth, name) for name in COMPONENTS[:2]}
    with warnings.catch_warnings():
        # The courses lie on one line.
        warnings.simplefilter("ignore", col.CollisionsWarning)
        (found,) = reconstruct.speeds(
            a, wall, course_a=0.0, course_b=1.0, restitution=0.1, **known,
            energy_loss=factor * truth.energy_loss, **contact, **wheels,
        )  # fmt: skip
    assert found.speed_a == pytest.approx(12.0, abs=1e-6)
    assert found.speed_b == pytest.approx(0.0, abs=1e-6)
