"""momentum with one velocity sought whole while tyres act: against a solution of its own equations
made here, the forward solver, and the same impact with other unknowns.
"""

import math
import random
import re

import numpy as np
import pytest
from scipy.optimize import fsolve

import collisions as col
from collisions import reconstruct
from collisions.derivation import explain
from collisions.reporting import replay
from collisions.travel import Tyres

G = 9.80665
LABELS = ["a", "b", "a_after", "b_after"]
MASSES = {"a": 1437.0, "b": 1823.0}
TIMES = {"duration": 0.11, "tyres_a": Tyres(0.7, 1.0, 2.7, 1.5), "tyres_b": Tyres(0.6, 1.0, 2.6, 1)}
TRUE = {
    "speed_a": 17.0,
    "speed_b": 12.0,
    "speed_a_after": 11.0,
    "speed_b_after": 9.0,
    "course_a": 0.1,
    "course_b": 1.7,
    "course_a_after": 0.6,
    "course_b_after": 1.1,
}
HEADINGS = {"heading_a": 0.1, "heading_b": 1.7}


def without(label):
    return {name: value for name, value in TRUE.items() if name.partition("_")[2] != label}


def momentum(known, **more):
    return reconstruct.momentum(MASSES["a"], MASSES["b"], **(known | HEADINGS | more))


def unit(course, speed):
    return speed * np.array([math.cos(course), math.sin(course)])


def imbalance(motions):
    """Momentum that is too much after a contact in which all wheels slide, from its equations."""
    half = 1.0 - math.cos(0.25 * math.pi)
    total = np.zeros(2)
    for label, mass in MASSES.items():
        before, after = (
            unit(motions[f"course_{label}{when}"], motions[f"speed_{label}{when}"])
            for when in ("", "_after")
        )
        middle = before + half * (after - before)
        directions = [v / np.linalg.norm(v) for v in (before, middle, after)]
        mean = (directions[0] + 4.0 * directions[1] + directions[2]) / 6.0
        friction = TIMES[f"tyres_{label}"].friction
        total += mass * (after - before) + friction * mass * G * TIMES["duration"] * mean
    return total


@pytest.mark.parametrize("label", LABELS)
def test_locked_wheels_that_do_not_turn_have_their_friction_against_the_motion(label):
    known, names = without(label), (f"speed_{label}", f"course_{label}")
    expected = fsolve(
        lambda found: imbalance(known | dict(zip(names, found, strict=True))),
        [TRUE[name] for name in names],
        xtol=1e-13,
    )
    answer = momentum(known, **TIMES)
    assert answer.unknowns == names
    assert [getattr(answer, name) for name in names] == pytest.approx(expected, rel=1e-9)
    # Without tyres the velocity is elsewhere.
    instant = momentum(known)
    apart = unit(*expected[::-1]) - unit(*(getattr(instant, name) for name in names[::-1]))
    assert np.hypot(*apart) > 0.1


@pytest.mark.parametrize("label", LABELS)
def test_an_impact_of_known_courses_is_found_again(label):
    rolling = Tyres(0.7, (0.2, 0.0, 0.4, 0.3), 2.7, 1.5, steer=0.09, cornering=8.0, height=0.5)
    more = TIMES | {"tyres_b": rolling, "yaw_rate_a_after": 1.5}
    known = {name: value for name, value in TRUE.items() if name not in ("speed_a", "speed_b")}
    first = momentum(known, outside_impulse=(300.0, -200.0), **more)
    all_of_it = {name: getattr(first, name) for name in TRUE}
    rest = {name: all_of_it[name] for name in without(label)}
    again = momentum(rest, outside_impulse=(300.0, -200.0), **more)
    for name, value in all_of_it.items():
        assert getattr(again, name) == pytest.approx(value, rel=1e-9), name
    assert again.tyre_impulse_y_b == pytest.approx(first.tyre_impulse_y_b, rel=1e-9)
    stated = ("outside_impulse_x", "outside_impulse_y")
    assert set(stated) < set(again.sensitivity[again.unknowns[0]])
    # The impulse of the tyres is none that was given.
    alone = momentum(rest, **more)
    assert not set(stated) & set(alone.sensitivity[alone.unknowns[0]])


@pytest.mark.slow
def test_the_velocity_after_that_the_forward_solver_gives_is_found_again():
    """The forward solver takes the force from the motions of an impact without tyres, this one from
    those with them: what is left of their effect is a tenth of it.
    """
    rng = random.Random(41)
    with_tyres, without_tyres = [], []
    for _ in range(40):
        tyres = {
            f"tyres_{label}": Tyres(
                rng.uniform(0.5, 0.9), [rng.choice((0.0, 0.3, 1.0)) for _ in range(4)], 2.7, 1.5
            )
            for label in "ab"
        }
        times = {"duration": rng.uniform(0.05, 0.15), **tyres}
        courses = rng.uniform(-0.3, 0.3), rng.uniform(1.2, 1.9)
        a, b = (
            col.Vehicle.from_speed(
                mass=rng.uniform(1100.0, 2000.0),
                yaw_inertia=rng.uniform(1800.0, 3000.0),
                speed=rng.uniform(8.0, 20.0),
                course=course,
                heading=course,
                x=x,
                y=y,
            )
            for course, x, y in zip(courses, (-2.1, 0.9), (0.0, rng.uniform(-1, 1)), strict=True)
        )
        impact = col.eccentric(a, b, 0.0, normal=0.05, point=(0.0, 0.0), friction=0.4, **times)
        known = {"speed_a_after": impact.a.after.speed, "course_a_after": impact.a.after.course}
        rates = {}
        for label, side in (("a", impact.a), ("b", impact.b)):
            known |= {
                f"mass_{label}": side.before.mass,
                f"course_{label}": side.before.course,
                f"speed_{label}": side.before.speed,
                f"heading_{label}": side.before.course,
            }
            rates[f"yaw_rate_{label}_after"] = side.after.yaw_rate
        truth = np.array([impact.b.after.vx, impact.b.after.vy])
        for misses, more in ((with_tyres, times | rates), (without_tyres, {})):
            answer = reconstruct.momentum(**known, **more)
            misses.append(np.hypot(*(unit(answer.course_b_after, answer.speed_b_after) - truth)))
    assert np.median(with_tyres) < 0.1 * np.median(without_tyres)
    assert max(with_tyres) < 0.25 * max(without_tyres)


def test_vehicles_that_leave_together():
    known = {name: TRUE[name] for name in ("speed_a", "speed_b", "course_a", "course_b")}
    answer = momentum(known, together=True, **TIMES)
    assert answer.speed_a_after == answer.speed_b_after
    assert answer.course_a_after == answer.course_b_after
    motions = {name: getattr(answer, name) for name in TRUE}
    assert np.abs(imbalance(motions)).max() < 1e-6


@pytest.mark.parametrize("label", LABELS)
def test_a_batch_has_the_answers_of_its_cases(label):
    known = without(label)
    durations = np.array([0.05, 0.1, 0.15])
    many = momentum(known, **(TIMES | {"duration": durations}))
    for i, duration in enumerate(durations):
        one = momentum(known, **(TIMES | {"duration": duration}))
        for name in many.unknowns:
            assert getattr(many, name)[i] == pytest.approx(getattr(one, name), rel=1e-13)


@pytest.mark.parametrize("label", LABELS)
def test_explain_and_report_show_the_impulse_of_the_tyres(label):
    answer = momentum(without(label), **TIMES)
    text = explain(answer, form="text", units="si")
    assert "one velocity, its speed and its course" in text
    assert "The tyres of A give an impulse while the contact lasts" in text
    assert "found again with it until it changed no more" in " ".join(text.split())
    page = col.report(answer, form="markdown", units="si", figures=False)
    assert f"{answer.tyre_impulse_x_a:.5g}"[:5] in page.replace(",", "")
    assert replay(page) == answer


@pytest.mark.parametrize("given", ["velocities", "courses"])
def test_what_an_instant_leaves_out_of_vehicles_that_stay_together(given):
    """The common velocity has the mass of both: the estimate is what tyres that slide change."""
    known = {name: TRUE[name] for name in ("speed_a", "course_a", "course_b")}
    known |= {"speed_b": 12.0} if given == "velocities" else {"course_a_after": 0.85}
    sliding = Tyres(0.7, 1.0, 2.7, 1.5)
    lasting = momentum(known, together=True, duration=0.1, tyres_a=sliding, tyres_b=sliding)
    instant = momentum(known, together=True)
    (sentence,) = instant.statements
    change = lasting.speed_a_after - instant.speed_a_after
    said = float(sentence.partition("speed of A after would be ")[2].split()[0])
    assert said == pytest.approx(-change, rel=0.06)
    assert ("course of A after would be" in sentence) == (given == "velocities")


@pytest.mark.slow
def test_speeds_that_do_not_settle_are_refused():
    """Few degrees apart, the courses turn a change of the tyres' force into a larger one."""
    wheels = Tyres(0.7, 1.0, 2.7, 1.5)
    known = {
        "course_a": -2.71,
        "course_b": np.array([-2.84, -1.0]),
        "course_a_after": np.array([-3.02, -2.5]),
        "course_b_after": np.array([-2.56, -1.9]),
        "speed_a_after": 3.31,
        "speed_b_after": 1.53,
        "heading_a": -2.71,
        "heading_b": -2.84,
    }
    times = {"duration": 0.1, "tyres_a": wheels, "tyres_b": wheels}
    one = {name: np.ravel(value)[0] for name, value in known.items()}
    with pytest.raises(col.NoSolutionError, match="do not settle while the tyres act") as refused:
        reconstruct.momentum(1437.0, 1823.0, **one, **times)
    assert refused.value.code == "undetermined"
    many = reconstruct.momentum(1437.0, 1823.0, **known, **times, on_failure="nan")
    assert np.isnan(many.speed_a).tolist() == [True, False]
    with pytest.raises(col.NoSolutionError, match=r"case 0: .*do not settle"):
        reconstruct.momentum(1437.0, 1823.0, **known, **times, on_failure="raise")


def test_what_an_instant_leaves_out_of_a_course_has_its_size_and_side():
    """More or less, as tyres that slide change the speed and the course of the velocity after."""
    known = {name: TRUE[name] for name in ("speed_a", "course_a", "course_b")}
    known |= {"speed_b": 12.0}
    sliding = Tyres(0.7, 1.0, 2.7, 1.5)
    lasting = momentum(known, together=True, duration=0.1, tyres_a=sliding, tyres_b=sliding)
    instant = momentum(known, together=True)
    (sentence,) = instant.statements
    change = lasting.course_a_after - instant.course_a_after
    said = re.search(r"course of A after would be ([0-9.]+) rad (more|less)", sentence)
    assert float(said[1]) == pytest.approx(abs(change), rel=0.1)
    assert (said[2] == "more") == (change > 0.0)
    side = "more" if lasting.speed_a_after > instant.speed_a_after else "less"
    assert re.search(rf"speed of A after would be [0-9.]+ m/s {side}", sentence)
