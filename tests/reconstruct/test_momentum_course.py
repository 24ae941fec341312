"""momentum with one velocity sought whole: against sums of vectors, the solution with the course
known, and differences of the answer.
"""

import math
import re

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct, reporting
from collisions.uncertainty import Normal, propagate

KMH = 1.0 / 3.6
MASSES = {"a": 1200.0, "b": 1800.0}
# A true impact: what is not given below is what has to be found.
TRUE = {
    "course_a": math.radians(270.0),
    "course_b": 0.0,
    "course_a_after": math.radians(-30.0),
    "course_b_after": math.radians(-40.0),
    "speed_a_after": 30.0 * KMH,
    "speed_b_after": 50.0 * KMH,
}
FOUND = reconstruct.momentum(1200, 1800, **TRUE)
TRUE |= {"speed_a": FOUND.speed_a, "speed_b": FOUND.speed_b}


def without(label):
    return {
        name: value
        for name, value in TRUE.items()
        if name not in (f"speed_{label}", f"course_{label}")
    }


@pytest.mark.parametrize("label", ["a", "b", "a_after", "b_after"])
def test_the_velocity_that_the_others_leave(label):
    """Each of the four in turn: that of an impact whose other speeds came from known courses."""
    found = reconstruct.momentum(1200, 1800, **without(label))
    assert found.unknowns == (f"speed_{label}", f"course_{label}")
    assert getattr(found, f"speed_{label}") == pytest.approx(TRUE[f"speed_{label}"], rel=1e-12)
    away = getattr(found, f"course_{label}") - TRUE[f"course_{label}"]
    assert math.remainder(away, math.tau) == pytest.approx(0.0, abs=1e-12)
    assert found.delta_v_a == pytest.approx(FOUND.delta_v_a, rel=1e-12)
    assert found.ok
    momenta = {name: MASSES[name[6]] * TRUE[name] for name in TRUE if name.startswith("speed")}
    own = momenta.pop(f"speed_{label}")
    assert found.condition == pytest.approx(sum(momenta.values()) / own, rel=1e-12)


def test_together_forward_is_the_common_velocity_of_complex_sums():
    found = reconstruct.momentum(
        1200, "1800 kg", course_a="270 deg", course_b="0 deg", speed_a="63.2 km/h",
        speed_b="55.6 km/h", together=True,
    )  # fmt: skip
    common = (1200 * 63.2 * KMH * -1j + 1800 * 55.6 * KMH) / 3000
    assert found.speed_a_after == found.speed_b_after == pytest.approx(abs(common), rel=1e-14)
    assert found.course_a_after == found.course_b_after
    assert found.course_a_after == pytest.approx(np.angle(common), abs=1e-14)
    # Backwards from it, with the course known, the speeds before come back.
    back = reconstruct.momentum(
        1200, 1800, course_a="270 deg", course_b=0, together=True,
        speed_a_after=found.speed_a_after, course_a_after=found.course_a_after,
    )  # fmt: skip
    assert [back.speed_a, back.speed_b] == pytest.approx([63.2 * KMH, 55.6 * KMH], rel=1e-12)


def test_together_forward_with_one_at_rest_and_a_push_from_outside():
    found = reconstruct.momentum(
        1000, 1500, course_a=0.0, speed_a=15.0, speed_b=0, together=True,
        outside_impulse=("-1000 N*s", 500.0),
    )  # fmt: skip
    common = (15000.0 - 1000.0 + 500.0j) / 2500.0
    assert found.speed_a_after == pytest.approx(abs(common), rel=1e-14)
    assert found.course_b_after == pytest.approx(np.angle(common), rel=1e-12)
    assert found.condition == pytest.approx(
        (15000.0 + math.hypot(1000.0, 500.0)) / (2500.0 * abs(common)), rel=1e-12
    )
    assert "velocity" in str(col.explain(found))


@pytest.mark.parametrize("label", ["b", "a_after", "together"])
def test_sensitivities_are_differences_of_the_answer(label):
    given = without(label) if label != "together" else {
        name: TRUE[name] for name in ("course_a", "course_b", "speed_a", "speed_b")
    }  # fmt: skip
    options = {"together": True} if label == "together" else {}

    def solved(**changed):
        numbers = {"mass_a": 1200.0, "mass_b": 1800.0, **given} | changed
        push = numbers.pop("outside_impulse_x", 300.0), numbers.pop("outside_impulse_y", -200.0)
        return reconstruct.momentum(**numbers, **options, outside_impulse=push)

    found = solved()
    start = {"mass_a": 1200.0, "mass_b": 1800.0, "outside_impulse_x": 300.0,
             "outside_impulse_y": -200.0, **given}  # fmt: skip
    for answer, row in found.sensitivity.items():
        assert row.keys() == start.keys()
        for name, value in row.items():
            step = 1e-5 * max(1.0, abs(start[name]))
            low, high = (
                getattr(solved(**{name: start[name] + by}), answer) for by in (-step, step)
            )
            assert value == pytest.approx((high - low) / (2.0 * step), rel=1e-6, abs=1e-9), (
                answer,
                name,
            )
    degrees = found.sensitivity.q[found.unknowns[1]]["mass_a"]
    assert degrees.m_as("deg/kg") == pytest.approx(
        math.degrees(found.sensitivity[found.unknowns[1]]["mass_a"])
    )


def test_batches_and_studies():
    speeds = np.linspace(10.0, 20.0, 5)
    given = {"course_a": 0.0, "course_b": "90 deg", "speed_b": 12.0, "together": True}
    found = reconstruct.momentum(1200, 1800, speed_a=speeds, **given)
    for at, speed in enumerate(speeds.tolist()):
        alone = reconstruct.momentum(1200, 1800, speed_a=speed, **given)
        assert found.course_a_after[at] == pytest.approx(alone.course_a_after, rel=1e-14)
        assert found.sensitivity["course_a_after"]["mass_a"][at] == pytest.approx(
            alone.sensitivity["course_a_after"]["mass_a"], rel=1e-12
        )

    def model(speed):
        one = reconstruct.momentum(1200, 1800, speed_a=speed, **given)
        return {"course": one.q.course_a_after}

    result = propagate(model, {"speed": Normal(15.0, 1.0)}, samples=256, seed=1)
    assert result["course"].mean == pytest.approx(math.atan2(1800 * 12, 1200 * 15), abs=0.01)


def test_momenta_that_cancel_leave_no_course():
    given = {"course_a": 0.0, "course_b": math.pi, "speed_b": 10.0, "together": True}
    with pytest.raises(col.NoSolutionError, match="give speed_a_after=0") as caught:
        reconstruct.momentum(1800, 1800, speed_a=10.0, **given)
    assert caught.value.code == "undetermined"
    with pytest.warns(col.IllConditionedWarning, match="nearly cancel") as warned:
        found = reconstruct.momentum(1800, 1800, speed_a=10.5, **given)
    assert warned[0].message.code == "momenta_cancel"
    assert found.speed_a_after == pytest.approx(0.25)
    assert found.condition == pytest.approx(41.0)
    with pytest.warns(col.CollisionsWarning):
        many = reconstruct.momentum(1800, 1800, speed_a=np.array([10.0, 30.0]), **given)
    assert many.status[0] == col.Status.UNDETERMINED
    assert math.isnan(many.course_a_after[0])
    assert many.course_a_after[1] == pytest.approx(0.0, abs=1e-15)


def test_a_course_missed_out_is_still_asked_for():
    given = without("a") | {}
    del given["speed_b"]
    with pytest.raises(col.MissingInputError, match="course_a not given") as caught:
        reconstruct.momentum(1200, 1800, **given)
    assert caught.value.code == "missing_course"
    # One course is sought beside the speed of another, but not two.
    del given["course_b_after"]
    with pytest.raises(col.MissingInputError, match="course_a, course_b_after not given"):
        reconstruct.momentum(1200, 1800, **(given | {"speed_a": 10.0}))
    # With all courses known one speed fewer is one too many.
    with pytest.raises(col.InputError) as caught:
        reconstruct.momentum(1200, 1800, **(TRUE | {"speed_a": None}))
    assert caught.value.code == "too_many_knowns"


@pytest.mark.slow
@pytest.mark.parametrize("label", ["a", "b_after"])
def test_pages_findings_and_records_have_it(label):
    found = reconstruct.momentum(1200, 1800, **without(label), heading_b=0.1)
    assert not [one for one in col.diagnose(found) if one.code in ("near_collinear",)]
    derived = str(col.explain(found))
    assert "Unknown is one velocity" in derived
    assert "does not" not in derived.partition("## Notes")[0]
    page = str(col.report(found))
    answers = re.sub("<[^>]+>", " ", page[page.index("Results") :])
    when = "after" if label.endswith("after") else "before"
    assert re.search(rf"course {when}\s+-\d\.\d\d rad", answers)
    assert "the sum of the other momenta over what they leave" in page
    assert reporting.replay(page) == found
