"""What a reverse solver warns of stands in statements, summary and derivation as well."""

import json
import math
import warnings

import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct, travel, uncertainty

A = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.0, y=0.0, heading=0.0)
B = col.Vehicle(mass=1300.0, yaw_inertia=2000.0, x=2.0, y=0.8, heading="70 deg")
MET = {
    "course_a": 0.0, "course_b": "70 deg", "restitution": 0.1, "normal": "10 deg",
    "point": (0.0, 0.4),
}  # fmt: skip
STUCK = {"friction": math.inf, "regime": "sticking"}
CASES = {
    "may_slide": (
        {**STUCK, "delta_v_forward_a": "-24 km/h", "delta_v_left_a": "9 km/h"},
        "needs an impulse ratio of 0.59",
    ),
    "negative_speed": (
        {"speed_a": "40 km/h", "delta_v_a": "34 km/h", "friction": 0.5},
        "speed_b was found backwards along its course",
    ),
    "nearly_collinear": (
        {
            **STUCK, "course_b": "8 deg", "delta_v_forward_a": "-24 km/h",
            "delta_v_left_a": "1 km/h",
        },
        "course_a and course_b are within 10 degrees of one line",
    ),
    "recorders_differ": (
        {
            **STUCK, "delta_v_forward_a": "-24 km/h", "delta_v_left_a": "9 km/h",
            "delta_v_forward_b": "-0.4 km/h", "delta_v_left_b": "-38.4 km/h",
        },
        "differ from this answer by 13 percent of the impulse, where recorders are accurate to 10",
    ),
}  # fmt: skip


def told(result):
    """Where a page may say something: statements, summary and derivation, in one line each."""
    pages = *result.statements, str(result.summary()), str(col.explain(result, form="text"))
    return [" ".join(page.split()) for page in pages]


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("code", CASES)
def test_what_speeds_warns_of_is_stated(code):
    known, said = CASES[code]
    with pytest.warns(col.CollisionsWarning) as warned:
        (found,) = reconstruct.speeds(A, B, **MET | known)
    assert code in {one.message.code for one in warned}
    pages = told(found)
    assert sum(said in page for page in pages) == 3
    for other, (_, text) in CASES.items():
        if other not in {one.message.code for one in warned}:
            assert not any(text in page for page in pages)


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_of_a_batch_it_is_stated_of_how_many_cases():
    known = {"speed_a": "40 km/h", "delta_v_a": np.array([34.0, 34.0, 18.0]) / 3.6, "friction": 0.5}
    found = reconstruct.speeds(A, B, **MET | known)[0]
    backwards = [found.case(i).statements for i in range(3)]
    assert [sum("backwards" in one for one in said) for said in backwards] == [1, 1, 0]
    assert any(one.startswith("in 2 of 3 cases, speed_b was found") for one in found.statements)


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_how_far_recorders_differ_is_in_the_record_and_worked_out_again():
    known, said = CASES["recorders_differ"]
    (found,) = reconstruct.speeds(A, B, **MET | known)
    # The mean of both impulses is halfway between 1 and 1.3 times that of A.
    assert found.reconstruction.misfit == pytest.approx(0.15 / 1.15, rel=1e-2)
    record = json.loads(json.dumps(found.to_dict()))
    again = col.Impact.from_dict(record)
    assert again.reconstruction == found.reconstruction
    assert any(said in one for one in again.statements)
    for value in (0.05, None):
        record["results"]["reconstruction"]["misfit"] = value
        with pytest.raises(col.InputError, match="the answer, and solving it again"):
            col.report(col.Impact.from_dict(record))
    many = reconstruct.speeds(
        A, B, **MET | known | {"delta_v_left_b": np.array([-29.5, -38.4, -99.0]) / 3.6}
    )[0]
    assert any(one.startswith("in 1 of 3 cases") and "up to" in one for one in many.statements)
    assert [math.isfinite(one) for one in many.reconstruction.misfit] == [True, True, False]


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_what_momentum_warns_of_is_stated():
    known = {
        "course_a": "175 deg", "course_b": 0.0, "course_a_after": "-30 deg",
        "course_b_after": "-40 deg", "speed_a_after": "30 km/h", "speed_b_after": "50 km/h",
    }  # fmt: skip
    found = reconstruct.momentum(1200.0, 1800.0, **known)
    said = (
        "speed_a is below 0: backwards along its course",
        "course_a and course_b are within 10 degrees of one line",
    )
    pages = told(found)
    for text in said:
        assert sum(text in page for page in pages) == 3
    across = reconstruct.momentum(
        1200.0, 1800.0, **known | {"course_a": "120 deg", "course_b_after": "90 deg"}
    )
    assert not any(text in page for page in told(across) for text in said)


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_numbers_beside_a_bound_are_said_to_be_those_of_the_least_slip():
    known = {"delta_v_forward_a": "-24 km/h", "delta_v_left_a": "9 km/h", "friction": 0.4}
    (found,) = reconstruct.speeds(A, B, **MET | known, slid="bound")
    assert "All other numbers are those of the least slip" in " ".join(str(found.summary()).split())


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_a_contact_that_may_have_stuck_is_said_with_both_ends():
    """Of planar where the slip after is all but 0: on every page, of a batch, in the record, which
    is worked out again.
    """
    after_a = A.replace(y=0.4, vx=9.2, vy=2.5, yaw_rate=1.6)
    after_b = B.replace(mass=1200.0, yaw_inertia=1900.0, y=0.0, vx=10.0, vy=5.0, yaw_rate=-0.5)
    met = {"normal": 0.07, "point": (0.05, 0.09), "friction": 0.3}
    with pytest.warns(col.IllConditionedWarning, match="may be none"):
        found = reconstruct.planar(after_a, after_b, energy_loss=90e3, **met)
    said = "the slip before was anything between -18.55 m/s and 9.96 m/s"
    pages = [*told(found), " ".join(str(col.report(found, form="markdown")).split())]
    assert sum(said in page for page in pages) == 4
    (condition,) = (one for one in col.diagnose(found) if one.code == "ill_conditioned")
    assert "the sign of the slip after" in condition.sentence
    # The ends: at the limits of friction the same motions after have these slips before.
    low, high = found.reconstruction.slip_if_stuck
    for ratio, slip in ((0.3, low), (-0.3, high)):
        end = reconstruct.planar(
            after_a, after_b, energy_loss=90e3, **met | {"friction": None}, impulse_ratio=ratio
        )
        assert end.slip_before == pytest.approx(slip, rel=1e-6)
    record = json.loads(json.dumps(found.to_dict()))
    assert col.Impact.from_dict(record).reconstruction == found.reconstruction
    record["results"]["reconstruction"]["slip_if_stuck"][0] = -9.0
    with pytest.raises(col.InputError, match="it says a slip from -9"):
        col.report(col.Impact.from_dict(record))
    energies = np.array([90e3, 60e3])
    many = reconstruct.planar(after_a, after_b, energy_loss=energies, **met)
    assert any(one.startswith("in 2 of 2 cases, the slip after") for one in many.statements)
    assert any(said in one for one in many.case(0).statements)
    some = reconstruct.planar(
        after_a,
        after_b.replace(vy=np.array([5.0, 9.0])),
        energy_loss=90e3,
        **met,
        on_failure="nan",
    )
    assert any(one.startswith("in 1 of 2 cases, the slip after") for one in some.statements)
    for i in range(2):
        case = some.case(i)
        assert (case.reconstruction.slip_if_stuck is None) == (i == 1)
        col.report(col.Impact.from_dict(json.loads(json.dumps(case.to_dict()))))


KEPT_SPEED = {
    "course_b": 0.0, "course_a_after": "-30 deg", "course_b_after": "-40 deg",
    "speed_a_after": "30 km/h", "speed_b_after": "50 km/h", "course_near": "-70 deg",
}  # fmt: skip


def test_the_course_that_course_near_did_not_choose_is_said():
    found = reconstruct.momentum(1200.0, 1800.0, **KEPT_SPEED, speed_a="68 km/h")
    other = reconstruct.momentum(
        1200.0, 1800.0, **KEPT_SPEED | {"course_near": "-110 deg"}, speed_a="68 km/h"
    )
    said = (
        "two courses fit as the course of A, and `course_near` chose; with the other, "
        f"{math.degrees(other.course_a):.4g}°, the speed of B is {3.6 * other.speed_b:.4g} km/h"
    )
    pages = [*told(found), " ".join(str(col.report(found, form="markdown")).split())]
    plain = [page.replace("`", "").replace("\\", "") for page in pages]
    assert sum(said[1:].replace("`", "") in page for page in plain) == 4


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_where_no_course_fits_with_tyres_it_is_said():
    """The balance with tyres asks for 66.3 km/h, as the solver with these tyres says as well."""
    found = reconstruct.momentum(1200.0, 1800.0, **KEPT_SPEED, speed_a="65 km/h")
    assert "with a drag of 0.7, no course of A would fit what is known" in found.statements[0]
    wheels = {f"tyres_{label}": travel.Tyres(0.7, 1.0, 2.6, 1.5) for label in "ab"}
    with pytest.raises(col.NoSolutionError, match="no course_a fits"):
        reconstruct.momentum(
            1200.0, 1800.0, **KEPT_SPEED, speed_a="65 km/h", duration=0.1, **wheels,
            heading_a=found.course_a, heading_b=0.0,
        )  # fmt: skip
    (instant,) = (one for one in col.diagnose(found) if one.code == "instant")
    assert "no course of A would fit" in instant.sentence


def test_a_reading_beyond_what_recorders_are_exact_to_is_said_with_it():
    """Summary, inputs of a study and evidence of a posterior; and a record that is cut."""
    time = np.arange(0.0, 0.26, 0.01)
    forward = pint.Quantity(-125.0 * np.clip(time / 0.11, 0.0, 1.0), "km/h")
    with pytest.warns(col.OutOfRangeWarning, match="exact to 100 km/h"):
        pulse = reconstruct.recorded_pulse(time, forward, polarity="ISO 8855")
    said = "delta-V forward goes to -125 km/h, and 49 CFR 563 asks recorders to be exact to 100"
    assert any(said in one for one in pulse.statements)
    printed = " ".join(str(pulse.summary()).split()).replace("Delta", "delta")
    assert said.replace("-125 km/h", "-125.0 km/h") in printed
    with pytest.warns(col.OutOfRangeWarning, match=r"from the recorder \(delta_v_forward_a\)"):
        study = uncertainty.propagate(
            lambda delta_v_forward_a: {"x": delta_v_forward_a}, pulse.inputs("a"), samples=64
        )
    assert any(said in one for one in study.statements)
    with pytest.warns(col.OutOfRangeWarning, match=said):
        found = reconstruct.posterior(
            lambda speed: {"delta_v": -0.5 * speed},
            {"speed": uncertainty.Uniform(40.0, 90.0)},
            {"delta_v": pulse.evidence[0]},
            samples=512,
        )
    assert any(said in one for one in found.statements)
    with pytest.warns(col.OutOfRangeWarning, match="lower bound"):
        cut = reconstruct.recorded_pulse(time[:8], forward[:8] / 5.0, polarity="ISO 8855")
    assert "is a lower bound" in " ".join(str(cut.summary()).split())
    assert not reconstruct.recorded_pulse(time, forward / 5.0, polarity="ISO 8855").statements


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_a_study_of_readings_at_a_place_says_how_speeds_were_looked_for():
    known = {"delta_v_forward_a": "-24 km/h", "delta_v_left_a": "9 km/h", "regime": "sticking"}
    more = {"friction": math.inf, "recorder_a": (0.3, -0.2), "duration": 0.1}

    def model(restitution):
        found = reconstruct.speeds(A, B, **MET | {"restitution": restitution} | known, **more)
        return {"b": found[0].speed_b}

    study = uncertainty.propagate(model, {"restitution": uncertainty.Uniform(0.0, 0.2)}, samples=64)
    assert any("speeds from readings away from the centre" in one for one in study.statements)


def test_a_refused_case_of_a_batch_is_stated_without_a_warning_of_numpy():
    wall = col.Vehicle(mass=math.inf, yaw_inertia=math.inf, vx=0.0, vy=0.0, yaw_rate=0.0)
    car = col.Vehicle(mass=1200.0, yaw_inertia=1800.0, vx=10.0, vy=0.0, yaw_rate=0.0, x=0.0, y=0.0)
    point = (0.0, np.array([0.0, 0.0, math.inf], dtype=np.float32))
    found = reconstruct.planar(
        wall, car, closing_speed=1.0, normal=0.0, point=point, friction=0.0, on_failure="nan"
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not any("approach" in one for one in found.statements)


BOUNDED = {"delta_v_forward_a": "-24 km/h", "delta_v_left_a": "9 km/h"}


@pytest.mark.filterwarnings("ignore::collisions.IllConditionedWarning")
def test_a_bound_that_is_taken_for_a_value_is_warned_of_in_a_study():
    """Of the speed as it is; as OneSided its own note says on which side."""

    def bound(friction):
        return reconstruct.speeds(A, B, **MET | BOUNDED, friction=friction, slid="bound")[0]

    def value(friction):
        return {"b": bound(friction).speed_b}

    def sided(friction):
        found = bound(friction)
        side = found.reconstruction.one_sided["speed_b"]
        return {"b": uncertainty.OneSided(found.speed_b, side)}

    friction = {"friction": uncertainty.Uniform(0.38, 0.42)}
    said = "64 of 64 cases .*one side only: hand it on as uncertainty.OneSided"
    with pytest.warns(col.OutOfRangeWarning, match=said) as told:
        study = uncertainty.propagate(value, friction, samples=64)
    assert "bound_as_value" in {one.message.code for one in told}
    assert any("hand it on as uncertainty.OneSided" in one for one in study.statements)
    with pytest.warns(col.OutOfRangeWarning, match="hand it on"):
        reconstruct.posterior(value, friction, {"b": (value(0.4)["b"], 1.0)}, samples=512, seed=1)
    with warnings.catch_warnings():
        warnings.simplefilter("error", col.OutOfRangeWarning)
        study = uncertainty.propagate(sided, friction, samples=64)
        bound(0.4)
    assert any("as at least its value" in one for one in study.statements)
    assert not any("hand it on" in one for one in study.statements)


def test_a_batch_of_no_case_has_nothing_to_doubt():
    known = {**STUCK, "delta_v_forward_a": np.zeros(0), "delta_v_left_a": np.zeros(0)}
    (found,) = reconstruct.speeds(A, B, **MET | known)
    assert not any("impulse ratio" in one for one in found.statements)


def test_a_number_of_numpy_is_named_as_it_is():
    with pytest.raises(col.InputError, match=r"got -3\.0"):
        A.replace(mass=np.float64(-3.0))


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_a_second_course_of_a_batch_with_refused_cases_gives_no_warning_of_numpy():
    found = reconstruct.momentum(
        np.array([1200.0, 0.0, 1200.0]), np.array([1800.0, 1800.0, math.inf]), **KEPT_SPEED,
        speed_a="68 km/h",
    )  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert any("look at the other too" in one for one in found.statements)
    courses = {"course_b": np.array([0.0, math.inf, 0.1]), "course_a": "175 deg"}
    known = {name: value for name, value in KEPT_SPEED.items() if name != "course_near"}
    found = reconstruct.momentum(1200.0, 1800.0, **known | courses)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert any("of one line" in one for one in found.statements)


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_motions_after_that_nearly_cancel_are_said_to():
    """Of planar with a restitution: errors of the velocities after grow as differences show."""
    a = A.replace(mass=1500.0, vx="16.5 m/s", yaw_rate=0.3, y=0.4)
    b = B.replace(vx="17.2 m/s", vy=1.0, yaw_rate=-0.2)
    met = {"normal": 0.05, "point": (0.0, 0.4), "friction": 0.2, "restitution": 0.5}
    found = reconstruct.planar(a, b, **met)
    growth = 0.0
    for changed in (
        {"a_after": a.replace(vx=16.5 * 1.0001)},
        {"a_after": a.replace(yaw_rate=0.3 * 1.0001)},
        {"b_after": b.replace(vx=17.2 * 1.0001, vy=1.0001)},
        {"b_after": b.replace(yaw_rate=-0.2 * 1.0001)},
    ):
        other = reconstruct.planar(**{"a_after": a, "b_after": b} | changed, **met)
        growth += abs(other.closing_speed / found.closing_speed - 1.0) / 1e-4
    (finding,) = (one for one in col.diagnose(found) if one.code == "motions_after_cancel")
    assert finding.measured == pytest.approx(growth, rel=1e-6)
    said = f"one percent of them may become {growth:.0f} percent of the closing speed"
    assert sum(said in page for page in told(found)) == 3
    many = reconstruct.planar(a.replace(vx=np.array([16.5, 2.0])), b, **met)
    assert any(one.startswith("in 1 of 2 cases, along the normal") for one in many.statements)
    energy = reconstruct.planar(a, b, **met | {"restitution": None}, energy_loss="20 kJ")
    assert not any("nearly cancel" in one for one in energy.statements)
