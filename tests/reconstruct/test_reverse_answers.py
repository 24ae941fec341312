"""Tests of what every reverse answer has: both speeds before, what was found and was given."""

import copy
import json
import math
import pickle

import jsonschema
import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct
from collisions.derivation import explain
from collisions.impact.schema import impact_schema
from collisions.reporting import options, replay, report
from collisions.uncertainty import Normal, Uniform, propagate
from pages import section, tampered

UNITS = pint.get_application_registry()
A = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.0, y=0.6, vx=15.0, heading=0.0)
B = col.Vehicle(mass=1200.0, yaw_inertia=1800.0, x=0.9, y=-1.0, vy=9.0, heading=math.pi / 2)
PLACE = {"normal": 0.2, "point": (0.0, 0.0), "friction": 0.5}
CRASH = col.eccentric(A, B, 0.1, **PLACE)
COURSES = {"course_a": 0.0, "course_b": math.pi / 2, "restitution": 0.1, **PLACE}
EES = dict(zip(("ees_a", "ees_b"), CRASH.ees(0.4), strict=True))


def nearest(answers):
    """The one that is the crash."""
    return min(answers, key=lambda one: abs(one.speed_a - 15.0) + abs(one.speed_b - 9.0))


def of_speeds(**known):
    return nearest(reconstruct.speeds(A, B, **{**COURSES, **known}, forward_only=True))


def of_momentum(**changed):
    after = {
        f"{name}_{label}_after": getattr(getattr(CRASH, label).after, name)
        for label in "ab"
        for name in ("speed", "course")
    }
    courses = {"course_a": 0.0, "course_b": math.pi / 2}
    return reconstruct.momentum(1500.0, 1200.0, **{**courses, **after, **changed})


def of_central():
    end = col.linear_central(A, B.replace(vx=3.0, vy=0.0), 0.2)
    return reconstruct.central(
        1500.0, 1200.0, vb=3.0, va_after=end.a.after.vx, vb_after=end.b.after.vx
    )


def of_planar():
    end = col.eccentric(A, B, 0.1, **{**PLACE, "friction": 0.05})
    assert end.regime == "sliding"
    return reconstruct.planar(
        end.a.after,
        end.b.after,
        energy_loss=end.energy_loss,
        regime="sliding",
        **{**PLACE, "friction": 0.05},
    )


def given_of(record):
    """What a record says was given to its reverse solver."""
    return record["impact"]["results"]["reconstruction"]["given"]


def model(speed_a, speed_b):
    return {"x": 1500.0 * speed_a, "y": 1200.0 * speed_b}


SPEEDS = {name: Uniform(0.0, 40.0) for name in ("speed_a", "speed_b")}
SEEN = {"x": Normal(1500.0 * 15.0, 300.0), "y": Normal(1200.0 * 9.0, 300.0)}
ANSWERS = {
    "speeds": (lambda: of_speeds(**EES, delta_v_a=CRASH.a.delta_v), ("speed_a", "speed_b"), 1e-9),
    "one speed known": (
        lambda: of_speeds(speed_b=9.0, delta_v_a=CRASH.a.delta_v),
        ("speed_a",),
        1e-9,
    ),
    "restitution found": (
        lambda: of_speeds(speed_b=9.0, delta_v_a=CRASH.a.delta_v, restitution=lambda v: 0.1),
        ("speed_a", "restitution"),
        1e-6,
    ),
    "planar": (
        of_planar,
        (
            *(f"{name}_{label}" for label in "ab" for name in ("speed", "course", "yaw_rate")),
            "restitution",
        ),
        1e-9,
    ),
    "momentum": (of_momentum, ("speed_a", "speed_b"), 1e-9),
    "momentum, whole": (
        lambda: of_momentum(course_a=None, speed_b=9.0),
        ("speed_a", "course_a"),
        1e-9,
    ),
    "fit": (lambda: reconstruct.fit(model, SPEEDS, SEEN), ("speed_a", "speed_b"), 1e-6),
    "posterior": (
        lambda: reconstruct.posterior(model, SPEEDS, SEEN, seed=1, samples=512),
        ("speed_a", "speed_b"),
        0.05,
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", ANSWERS)
def test_every_reverse_answer_has_both_speeds_and_says_what_it_found(name):
    """The speeds of the impact solved forwards, from which each was told what it needs."""
    solve, found, off = ANSWERS[name]
    answer = solve()
    assert isinstance(answer, reconstruct.ReverseAnswer)
    assert answer.speed_a == pytest.approx(15.0, rel=off)
    assert answer.speed_b == pytest.approx(9.0, rel=off)
    assert answer.found == found
    if hasattr(answer, "q"):
        assert answer.q.speed_a.m_as("km/h") == pytest.approx(3.6 * answer.speed_a, rel=1e-12)


def test_in_line_the_velocity_that_was_given_is_not_found():
    answer = of_central()
    assert isinstance(answer, reconstruct.ReverseAnswer)
    assert (answer.speed_a, answer.speed_b) == pytest.approx((15.0, 3.0), rel=1e-12)
    assert answer.found == ("speed_a", "restitution")
    assert CRASH.found == ()


@pytest.mark.slow
def test_a_friction_that_the_components_show_is_found():
    """The contact of 0.05 slides, and the ratio of its components is that."""
    end = col.eccentric(A, B, 0.1, **{**PLACE, "friction": 0.05})
    known = {f"delta_v_{part}_a": getattr(end.a, f"delta_v_{part}") for part in ("forward", "left")}
    (found,) = reconstruct.speeds(
        A, B, **{**COURSES, "friction": math.inf}, **known, speed_b=9.0, regime="sliding"
    )
    assert found.found == ("speed_a", "friction")
    assert found.friction == pytest.approx(0.05, rel=1e-9)
    page = report(found, form="markdown", units="si", figures=False)
    given = section(page, "Inputs")
    assert "| contact | friction (bound on the impulse ratio) | 0.05, found |" in given
    assert report(replay(page), **options(page)) == page


@pytest.mark.slow
def test_what_has_no_such_name_has_no_speed():
    by_name = reconstruct.fit(lambda v: {"x": 2.0 * v}, {"v": Uniform(0, 9)}, {"x": (4.0, 1.0)})
    assert by_name.speed_a is None is by_name.speed_b
    length = reconstruct.fit(
        lambda speed_a: {"x": 2.0 * speed_a}, {"speed_a": Uniform("0 m", "9 m")}, {"x": (4.0, 1.0)}
    )
    assert length.speed_a is None


def test_a_wall_has_no_speed_that_could_be_found():
    wall = col.Vehicle(mass=math.inf, yaw_inertia=math.inf, x=1.0, y=0.0, heading=0.0)
    place = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.0}
    end = col.eccentric(A.replace(y=0.0), wall, 0.2, **place)
    found = reconstruct.planar(end.a.after, end.b.after, restitution=0.2, **place)
    assert found.found == ("speed_a", "course_a", "yaw_rate_a")
    assert (found.speed_a, found.speed_b) == pytest.approx((15.0, 0.0), abs=1e-12)


@pytest.mark.slow
def test_cases_of_a_batch_have_speeds_and_numbers_of_their_own():
    seen = np.array([1.0, 1.02]) * CRASH.a.delta_v
    (many, *_) = reconstruct.speeds(A, B, **COURSES, speed_b=9.0, delta_v_a=seen)
    assert many.speed_a.shape == (2,)
    assert many.found == ("speed_a",)
    given = many.reconstruction.given
    assert np.array_equal(given["delta_v_a"], seen)
    assert not given["delta_v_a"].flags.writeable
    assert many.case(1).reconstruction.given["delta_v_a"] == seen[1]
    again = pickle.loads(pickle.dumps(many))
    assert again.reconstruction == many.reconstruction
    assert not again.reconstruction.given["delta_v_a"].flags.writeable
    record = json.loads(json.dumps(many.to_dict()))
    jsonschema.validate(record, impact_schema())
    assert col.Impact.from_dict(record).reconstruction == many.reconstruction


def test_numbers_are_kept_as_they_were_given_whatever_their_form():
    """Of texts they are what pint says."""
    texts = {"delta_v_a": "17.3 mph", "speed_b": "9 m/s", "course_b": "90 deg"}
    (found, *_) = reconstruct.speeds(A, B, **{**COURSES, **texts})
    given = found.reconstruction.given
    assert list(given) == ["speed_b", "delta_v_a", "course_a", "course_b"]
    for name, text in texts.items():
        unit = "radian" if name.startswith("course") else "m/s"
        assert given[name] == pytest.approx(UNITS(text).m_as(unit), rel=1e-15)
    assert given["course_a"] == 0.0
    assert of_planar().reconstruction.given["energy_loss"] > 0.0
    assert of_central().reconstruction.given["vb"] == 3.0


RECORDER = {
    "delta_v_forward_a": -8.0,
    "delta_v_left_a": 1.5,
    "recorder_a": (0.5, 0.1),
    "axes": "turning",
    "duration": "90 ms",
    "speed_b": 9.0,
    "friction": 0.5,
}


def rows(page):
    """What stands under evidence, by what it is."""
    found = [line.split(" | ") for line in section(page, "Inputs").splitlines()]
    return {row[1]: row[2].removesuffix(" |") for row in found if row[0] == "| evidence"}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_all_that_was_known_stands_on_the_page_with_its_number():
    """Floats too, in the units of the page: 8 m/s are 17.90 mph; and no value is the answer's."""
    found = of_speeds(**RECORDER)
    page = report(found, form="markdown", units="us", figures=False)
    shown = rows(page)
    assert shown["delta-V forward of A, as its recorder reads it"] == "-17.90 mph, exactly -8 m/s"
    assert shown["delta-V to the left of A, as its recorder reads it"].startswith("3.355 mph")
    assert shown["recorder of A, ahead of the centre of mass"].startswith("1.640 ft")
    assert shown["duration of the contact, in which recorders turn"] == "0.09 s, given as 90 ms"
    assert shown["axes that turn with the car"] == "stated"
    assert not any(what.startswith("place of the recorder") for what in shown)
    assert not any("kept only" in value for value in shown.values())
    assert report(replay(page), **options(page)) == page
    table = section(explain(found, units="us"), "What was given and found")
    assert "delta-V forward of A, as its recorder reads it | -17.90 mph" in table


@pytest.mark.slow
def test_what_the_answer_has_stands_beside_a_component_that_it_does_not_meet():
    parts = {
        f"delta_v_{part}_a": getattr(CRASH.a, f"delta_v_{part}") for part in ("forward", "left")
    }
    found = of_speeds(speed_b=9.0, **{**parts, "delta_v_left_a": parts["delta_v_left_a"] + 0.3})
    shown = rows(report(found, form="markdown", units="si", figures=False))
    text = shown["delta-V to the left of A"]
    given, answer = text.split("; ")
    assert float(given.split()[0]) == pytest.approx(parts["delta_v_left_a"] + 0.3, rel=1e-3)
    assert float(answer.split()[0]) == pytest.approx(found.a.delta_v_left, rel=1e-3)


@pytest.mark.slow
def test_what_is_stated_of_an_input_stands_beside_it():
    def solved(delta_v_a):
        (found,) = reconstruct.speeds(
            A, B, **COURSES, speed_b=9.0, delta_v_a=delta_v_a, forward_only=True
        )
        return {"speed_a": found.speed_a}

    seen = CRASH.a.delta_v
    study = propagate(solved, {"delta_v_a": Normal(seen, 0.2)}, method="first_order")
    found = of_speeds(speed_b=9.0, delta_v_a=seen)
    page = report(found, form="markdown", units="metric", figures=False, uncertainty=study)
    text = rows(page)["delta-V of A"]
    # 0.2 m/s is 0.72 km/h.
    assert text == f"{3.6 * seen:.2f} km/h; stated as {3.6 * seen:.2f} ± 0.72 km/h"
    assert "; stated" not in rows(page)["speed of B before"]
    # An output of that name is the speed of A: its range stands in the answer.
    assert "- **A: speed before:** 5" in page
    assert "km/h (95 %)" in page


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("known", [{"speed_b": 9.0, "delta_v_a": CRASH.a.delta_v}, RECORDER])
def test_a_record_without_what_was_given_is_refused(known):
    """Whole or in part: what it leaves out no check could see."""
    found = of_speeds(**known)
    page = report(found, form="markdown", figures=False)
    for name in ("given", "found"):
        cut = copy.deepcopy(found.to_dict())
        del cut["results"]["reconstruction"][name]
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(json.loads(json.dumps(cut)), impact_schema())
        with pytest.raises(col.InputError, match=name):
            col.Impact.from_dict(cut)

        def without(record, name=name):
            del record["impact"]["results"]["reconstruction"][name]

        with pytest.raises(col.InputError, match=name):
            replay(tampered(page, without))
    for name in found.reconstruction.given:

        def in_part(record, name=name):
            del record["impact"]["results"]["reconstruction"]["given"][name]

        with pytest.raises(col.InputError):
            replay(tampered(page, in_part))


CRUSH = dict(
    zip(("max_crush_speed_a", "max_crush_speed_b"), CRASH.max_crush_speeds(0.4), strict=True)
)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize(
    "known",
    [
        EES | {"speed_b": 9.0},
        EES | {"delta_v_a": CRASH.a.delta_v},
        CRUSH | {"speed_b": 9.0},
        {"energy_loss": CRASH.energy_loss, "speed_b": 9.0},
        {"energy_loss": CRASH.energy_loss, "delta_v_a": CRASH.a.delta_v},
        {"speed_b": 9.0, "delta_v_b": CRASH.b.delta_v},
        RECORDER,
    ],
    ids=lambda known: "-".join(known),
)
def test_what_was_given_is_found_again_from_a_report(known):
    found = of_speeds(**known)
    assert replay(report(found, form="markdown", figures=False)) == found
    assert col.explain(col.Impact.from_dict(found.to_dict()), form="text")


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("shown", [False, True], ids=["friction known", "friction shown"])
def test_what_was_given_beside_a_car_that_stands_is_found_again(shown):
    """It has no course, so that no angle between courses is asked for."""
    a, b = A.replace(vx=12.0), B.replace(vy=0.0)
    place = {"normal": 0.1, "point": (-0.3, -0.5), "friction": 0.25}
    end = col.eccentric(a, b, 0.1, **place)
    known = {f"delta_v_{way}_a": getattr(end.a, f"delta_v_{way}") for way in ("forward", "left")}
    asked = place | ({"friction": math.inf, "regime": "sliding"} if shown else {})
    (found,) = reconstruct.speeds(
        a, b, course_a=0.0, course_b=None, speed_b=0.0, restitution=0.1, **asked, **known
    )
    assert found.a.before.speed == pytest.approx(12.0)
    assert replay(report(found, form="markdown", figures=False)) == found
    assert "near_collinear" not in {one.code for one in col.diagnose(found)}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_a_record_cannot_say_that_another_ending_was_stated():
    """Nor that one was where components did not ask for it; and its condition is a number."""
    slid = col.eccentric(A, B, 0.1, **PLACE | {"friction": 0.3})
    known = {f"delta_v_{way}_a": getattr(slid.a, f"delta_v_{way}") for way in ("forward", "left")}
    (stated,) = reconstruct.speeds(
        A, B, **COURSES | {"friction": math.inf}, **known, regime="sticking"
    )
    for found, changes in (
        (stated, ({"regime": None}, {"regime": "sliding"}, {"condition": None})),
        (of_speeds(speed_b=9.0, delta_v_a=CRASH.a.delta_v), ({"regime": "sticking"},)),
        (of_central(), ({"regime": "sliding"},)),
    ):
        page = report(found, form="markdown", figures=False)
        assert replay(page) == found
        for changed in changes:

            def forged(record, changed=changed):
                record["impact"]["results"]["reconstruction"].update(changed)

            with pytest.raises(col.InputError):
                replay(tampered(page, forged))


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_what_was_asked_in_other_ways_is_found_again():
    """Motions after by speed and course, a restitution that was a function, and courses that are
    one, where a contact slid at the ratio that components show.
    """
    after = (
        col.Vehicle.from_speed(
            mass=mass, yaw_inertia=inertia, x=x, y=y, heading=heading, speed=speed, course=course,
            yaw_rate=rate,
        )
        for mass, inertia, x, y, heading, speed, course, rate in (
            (1500, 2500, -1.9, -0.3, "5 deg", "30 km/h", "10 deg", "20 deg/s"),
            (1300, 2100, 1.1, 0.9, "90 deg", "45 km/h", "60 deg", "-10 deg/s"),
        )
    )  # fmt: skip
    place = {"normal": "17 deg", "point": ("0.1 m", "20 cm")}
    found = [reconstruct.planar(*after, **place, restitution=0.1, friction=0.05)]
    found += reconstruct.speeds(
        A, B, **COURSES | {"restitution": lambda g: 0.4 * math.exp(-g / 10.0)}, speed_b=9.0,
        delta_v_a=CRASH.a.delta_v,
    )  # fmt: skip
    ahead = B.replace(vx=5.0, vy=0.0)
    end = col.eccentric(A, ahead, 0.1, **PLACE | {"friction": 0.1})
    known = {f"delta_v_{way}_a": getattr(end.a, f"delta_v_{way}") for way in ("forward", "left")}
    (along,) = reconstruct.speeds(
        A, ahead, **COURSES | {"course_b": 0.0, "friction": math.inf}, speed_b=5.0, **known
    )
    assert along.a.before.speed == pytest.approx(15.0)
    for one in [*found, along]:
        assert replay(report(one, form="markdown", figures=False)) == one


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize(
    ("courses", "masses", "inertias", "both", "normal"),
    [
        (("15 deg", "99 deg"), (1408, 1402), (1994, 2916), (20.0, 14.0), "12 deg"),
        (("-17 deg", "67 deg"), (1962, 1324), (2050, 3058), (14.0, 14.0), "-13 deg"),
    ],
)
def test_one_that_just_sticks_or_just_slides_is_found_again(
    courses, masses, inertias, both, normal
):
    """Exact readings beside a known speed: degrees, which a record has in radians, are rounded, and
    that decides which of two conditions the answer has; one that was changed is refused.
    """
    places = ((-2.0, 0.2), (1.0, -1.0))
    before = [
        col.Vehicle.from_speed(
            mass=mass, yaw_inertia=inertia, x=x, y=y, heading=course, speed=speed, course=course
        )
        for course, mass, inertia, speed, (x, y) in zip(
            courses, masses, inertias, both, places, strict=True
        )
    ]
    contact = {"restitution": 0.1, "normal": normal, "point": (0.0, 0.2)}
    hit = col.eccentric(*before, friction=0.9, **contact)
    assert hit.regime == "sticking"
    known = {f"delta_v_{way}_a": getattr(hit.a, f"delta_v_{way}") for way in ("forward", "left")}
    with pytest.raises(col.AmbiguousSolutionError) as refused:
        reconstruct.speeds(
            *before, course_a=courses[0], course_b=courses[1], speed_a=both[0], friction=math.inf,
            **contact, **known,
        )  # fmt: skip
    assert len(refused.value.solutions) == 2
    for one in refused.value.solutions:
        page = report(one, form="markdown", figures=False)
        assert replay(page) == one
        for factor in (1.5, 0.5):
            changed = tampered(
                page,
                lambda record, one=one, factor=factor: record["impact"]["results"][
                    "reconstruction"
                ].update(condition=factor * one.reconstruction.condition),
            )
            with pytest.raises(col.InputError, match="give a condition of"):
                replay(changed)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_an_energy_that_sticking_does_not_lose_is_found_again():
    """Within what components may differ by."""
    end = col.eccentric(A, B, 0.1, **PLACE | {"friction": 2.0})
    assert end.regime == "sticking"
    known = {f"delta_v_{way}_a": getattr(end.a, f"delta_v_{way}") for way in ("forward", "left")}
    for share in (0.9, 1.1):
        found = of_speeds(
            **known, energy_loss=share * end.energy_loss, friction=math.inf, regime="sticking"
        )
        assert replay(report(found, form="markdown", figures=False)) == found


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"given": {"delta_v_a": 3.0}}, "delta_v_a was given as 3.0 m/s, but the delta-V of A is"),
        ({"given": {"delta_v_a": "3 m/s"}}, "delta_v_a, which a reverse solver was given"),
        ({"given": 3.0}, "is not what a reverse solver was given"),
    ],
)
def test_a_number_that_was_changed_in_a_record_is_refused(changed, said):
    page = report(of_speeds(speed_b=9.0, delta_v_a=CRASH.a.delta_v), form="markdown", figures=False)
    with pytest.raises(col.InputError, match=said):
        replay(tampered(page, lambda r: r["impact"]["results"]["reconstruction"].update(changed)))


def of_planar_stuck():
    """At a friction of 1.0 the contact sticks: a greater one would change no number of it."""
    place = PLACE | {"friction": 1.0, "law": "kudlich-slibar"}
    end, more = (col.eccentric(A, B, 0.1, **place | {"friction": mu}) for mu in (1.0, 5.0))
    assert end.regime == "sticking"
    assert end.a.after == more.a.after
    return reconstruct.planar(end.a.after, end.b.after, restitution=0.1, regime="sticking", **place)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("solve", "name"),
    [
        (of_planar_stuck, "friction"),
        (of_planar_stuck, "restitution"),
        (of_planar, "friction"),
        (of_central, "vb"),
    ],
)
def test_an_input_that_was_changed_where_a_record_says_what_was_given_is_refused(solve, name):
    """Inputs stand in a record a second time as what the reverse solver was given, also those that
    the answer does not depend on; both are one number.
    """
    found = solve()
    given = found.reconstruction.given[name]
    assert given == {"vb": found.inputs.b.vx, "restitution": found.restitution}.get(
        name, found.inputs.rule_value
    )
    page = report(found, form="markdown", figures=False)
    assert replay(page) == found
    for other in (given * (1.0 + 1e-6), given * 1.02, given + 4.2, "inf"):

        def change(record, other=other):
            given_of(record)[name] = other

        with pytest.raises(col.InputError):
            replay(tampered(page, change))
        record = json.loads(json.dumps(found.to_dict()))
        change({"impact": record})
        for of in (col.explain, report, col.diagnose):
            with pytest.raises(col.InputError):
                of(col.Impact.from_dict(record))


@pytest.mark.slow
def test_a_duration_beside_tyres_and_a_recorder_that_was_changed_is_refused():
    """The duration of the tyres is that of the recorder: what it was given stands twice."""
    known = {f"delta_v_{way}_a": getattr(CRASH.a, f"delta_v_{way}") for way in ("forward", "left")}
    tyres = col.travel.Tyres(0.7, 0.3, 2.7, 1.5)
    found = of_speeds(**known, speed_b=9.0, recorder_a=(0.3, 0.2), duration=0.1, tyres_a=tyres)
    page = report(found, form="markdown", figures=False)
    for changed in (0.1001, -0.1):
        with pytest.raises(col.InputError, match="duration was given to its reverse solver as"):
            replay(tampered(page, lambda r, to=changed: given_of(r).update(duration=to)))


@pytest.mark.slow
def test_a_yaw_rate_after_that_was_changed_is_refused():
    """Of which the energy, and so the speeds before, hardly depend on."""
    found = of_planar()
    page = report(found, form="markdown", figures=False)
    rate = found.a.after.yaw_rate + 1e-4
    with pytest.raises(col.InputError, match="does not lead to its speeds"):
        replay(tampered(page, lambda r: given_of(r).update({"a_after.yaw_rate": rate})))


@pytest.mark.slow
def test_a_page_says_that_a_condition_with_a_function_cannot_be_checked_from_it():
    """The record has the restitution alone, not how steep the function is."""
    known = {"speed_b": 9.0, "delta_v_a": CRASH.a.delta_v}
    said = "the condition, and whether it is named among the findings, can be checked with the"
    assert said in explain(of_speeds(**known, restitution=lambda v: 0.1), form="text")
    assert said not in explain(of_speeds(**known, restitution=0.1), form="text")


def test_a_text_that_is_not_its_number_is_refused():
    found = of_speeds(speed_b="9 m/s", delta_v_a=CRASH.a.delta_v)
    page = report(found, form="markdown", figures=False)

    def change(record):
        record["impact"]["inputs"]["known"]["speed_b"] = "9.00001 m/s"

    with pytest.raises(col.InputError, match="which is not its number"):
        replay(tampered(page, change))


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize(
    "changed",
    [
        {"condition": 1.0},
        {"answers": 7},
        {"known": ["restitution"]},
        {"method": "guess"},
        {"duration": 0.1, "drag_a": 0.7, "drag_b": 0.7},
        {"drag_b": 0.7},
    ],
)
@pytest.mark.parametrize("show", [col.diagnose, col.explain, col.report], ids=lambda f: f.__name__)
def test_a_reconstruction_that_a_record_alone_says_is_refused_where_it_is_shown(changed, show):
    """As `replay` refuses it; of an untouched record each shows what it shows of the original."""
    nearly = reconstruct.central(1500.0, 1200.0, va_after=12.0, vb_after=12.01, restitution=0.001)
    record = json.loads(json.dumps(nearly.to_dict()))
    read = col.Impact.from_dict(record)
    assert read.reconstruction == nearly.reconstruction
    assert "ill_conditioned" in [one.code for one in col.diagnose(read)]
    assert str(show(read)) == str(show(nearly))
    assert str(show(pickle.loads(pickle.dumps(read)))) == str(show(nearly))
    with col.options(require_units=True):
        show(read)
    record["results"]["reconstruction"].update(changed)
    spoilt = col.Impact.from_dict(record)
    with pytest.raises(col.InputError, match="a record that contradicts itself") as refused:
        show(spoilt)
    assert (refused.value.code, refused.value.argument) == ("bad_record", "impact")
    with pytest.raises(col.InputError, match="a record that contradicts itself"):
        show(pickle.loads(pickle.dumps(spoilt)))


def test_a_case_of_a_batch_that_was_read_from_a_record_is_worked_out_again():
    batch = reconstruct.central(
        1500.0, 1200.0, va=np.array([20.0, 22.0]), vb=0.0, restitution=0.1, on_failure="nan"
    )
    record = json.loads(json.dumps(batch.to_dict()))
    col.diagnose(col.Impact.from_dict(record).case(1))
    record["results"]["reconstruction"]["condition"]["values"] = [1.0, 77.0]
    with pytest.raises(col.InputError, match="a record that contradicts itself"):
        col.diagnose(col.Impact.from_dict(record).case(1))
