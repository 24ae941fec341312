"""What a reverse solver warns of stands in statements, summary and derivation as well."""

import math

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct

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
