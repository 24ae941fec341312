"""momentum with one velocity before sought whole while tyres act on a slow vehicle: where another
velocity fits too, it is found and said. Truths are drawn, and their motions after are those that
momentum finds forwards, of which there is one.
"""

import math
import random
import re
import warnings
from functools import cache

import numpy as np
import pytest
from scipy import optimize

import collisions as col
from collisions import reconstruct
from collisions.derivation import explain
from collisions.travel import Tyres
from collisions.uncertainty import Normal, propagate

SOUGHT = [(f"speed_{label}", f"course_{label}") for label in "ab"]


def drawn(seed):
    """Arguments of a truth, half of them slow, with all speeds and courses."""
    rng = random.Random(seed)

    def speed():
        return rng.uniform(0.0, 3.0) if rng.random() < 0.5 else rng.uniform(3.0, 25.0)

    known = {"duration": rng.uniform(0.05, 0.15)}
    for label in "ab":
        known |= {
            f"heading_{label}": rng.uniform(-3.0, 3.0),
            f"yaw_rate_{label}_after": rng.gauss(0.0, 3.0),
            f"tyres_{label}": Tyres(
                rng.uniform(0.3, 0.9), [rng.uniform(0.0, 1.0) for _ in range(4)], 2.6, 1.5
            ),
        }
    truth = {"mass_a": rng.uniform(900.0, 3000.0), "mass_b": rng.uniform(900.0, 3000.0)}
    truth |= {f"speed_{label}": speed() for label in ("a", "b", "a_after")}
    truth |= {f"course_{label}": known[f"heading_{label}"] + rng.gauss(0.0, 0.05) for label in "ab"}
    truth["course_a_after"] = rng.uniform(-3.0, 3.0)
    return known, truth


def answered(**arguments):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        answer = reconstruct.momentum(**arguments)
    return answer, [warning.message for warning in caught]


def velocity(answer, label):
    speed, course = getattr(answer, f"speed_{label}"), getattr(answer, f"course_{label}")
    return speed * math.cos(course), speed * math.sin(course)


@cache
def missed():
    """The drawn truths with what was sought, the answer, its warnings and how far it is off."""
    found = []
    for seed in range(150):
        known, truth = drawn(seed)
        try:
            whole, _ = answered(**known, **truth)
        except col.CollisionsError:
            continue
        truth |= {name: getattr(whole, name) for name in ("speed_b_after", "course_b_after")}
        for pair in SOUGHT:
            given = {name: value for name, value in truth.items() if name not in pair}
            try:
                answer, warned = answered(**known, **given)
            except col.CollisionsError:
                continue
            label = pair[0][-1]
            off = math.dist(velocity(answer, label), velocity(whole, label))
            if off > 1e-6:
                found.append((known, given, label, answer, warned, off))
    return found


@pytest.mark.slow
def test_no_other_velocity_is_missed_in_silence():
    assert len(missed()) >= 15
    said = [[message.code for message in warned] for _, _, _, _, warned, _ in missed()]
    assert all({"another_fits", "momenta_cancel"} & set(codes) for codes in said)
    assert sum("another_fits" in codes for codes in said) >= 15


def others_of(sentence):
    """Speed, course and distance of each velocity that is said to fit too."""
    return [
        tuple(map(float, numbers))
        for numbers in re.findall(
            r"= ([0-9.e+-]+) m/s with course_. = ([0-9.e+-]+) rad, which is ([0-9.e+-]+) m/s away",
            sentence,
        )
    ]


@pytest.mark.slow
def test_what_is_said_to_fit_does():
    """With it stated before, the same motions come after."""
    checked = 0
    for known, given, label, answer, warned, _ in missed():
        others = [message for message in warned if message.code == "another_fits"]
        if not others:
            continue
        (sentence,) = (one for one in answer.statements if "fits too" in one or "fit too" in one)
        assert str(others[0]) == sentence.replace("`", "")
        for speed, course, apart in others_of(sentence):
            stated = {**given, f"speed_{label}": speed, f"course_{label}": course}
            wanted = stated.pop("speed_b_after"), stated.pop("course_b_after")
            try:
                again, _ = answered(**known, **stated)
            except col.NoSolutionError:
                continue  # forwards, the motions after are not always found
            was = wanted[0] * math.cos(wanted[1]), wanted[0] * math.sin(wanted[1])
            # The sentence has three digits.
            assert math.dist(velocity(again, "b_after"), was) < 0.02 * max(1.0, apart)
            x, y = speed * math.cos(course), speed * math.sin(course)
            assert math.dist((x, y), velocity(answer, label)) == pytest.approx(apart, abs=0.02)
            checked += 1
        apart = [one[2] for one in others_of(sentence)]
        assert apart == sorted(apart, reverse=True)
        assert others[0].fields["value"] == pytest.approx(apart[0], rel=0.01)
        text = " ".join(explain(answer, form="text").split()).lower()
        assert ("another velocity fits too" if len(apart) == 1 else "other velocities fit") in text
    assert checked >= 60


@pytest.mark.slow
def test_the_truth_is_among_those_that_are_said_to_fit():
    """Whether it is the farthest or lies between the answer and that."""
    checked = 0
    for _, _, _, answer, warned, off in missed():
        if any(message.code == "another_fits" for message in warned):
            (sentence,) = (
                one for one in answer.statements if "fits too" in one or "fit too" in one
            )
            assert min(abs(one[2] - off) for one in others_of(sentence)) < 1e-3
            checked += 1
    assert checked >= 15


@pytest.mark.slow
def test_of_three_that_fit_the_one_between_is_said_too():
    """Vehicles that leave together; each of the three goes forwards to the motion known."""
    known = {
        "mass_a": 1360.451650217694, "mass_b": 966.8665820853196, "duration": 0.1362039808234032,
        "tyres_a": Tyres(0.585311, 0.70963, 2.49057, 1.44011),
        "tyres_b": Tyres(0.72398, 1.0, 2.51561, 1.4735), "heading_a": -2.3510427488637093,
        "heading_b": 0.11267472679742685, "course_b": 0.14591382383092644,
        "speed_b": 17.820194514703957, "together": True,
    }  # fmt: skip
    truth = {"speed_a": 1.4958655769258506, "course_a": -2.3435942240875223}
    forwards, _ = answered(**known, **truth)
    after = {name: getattr(forwards, name) for name in ("course_a_after", "speed_a_after")}
    answer, _ = answered(**known, **after)
    (sentence,) = [one for one in answer.statements if "fit too" in one]
    found = [(answer.speed_a, answer.course_a), *(one[:2] for one in others_of(sentence))]
    assert len(found) == 3
    for speed, course in found:
        again, _ = answered(**known, speed_a=speed, course_a=course)
        # The sentence has six digits.
        assert again.speed_a_after == pytest.approx(after["speed_a_after"], rel=2e-5)
        assert again.course_a_after == pytest.approx(after["course_a_after"], rel=2e-4)
    near = [one for one in found if abs(one[0] - truth["speed_a"]) < 1e-4]
    assert [one[1] for one in near] == [pytest.approx(truth["course_a"], abs=1e-4)]


@pytest.mark.slow
def test_a_batch_counts_the_cases():
    known, given, label, _, _, _ = next(
        one for one in missed() if any(w.code == "another_fits" for w in one[4])
    )
    name = "speed_a_after"
    # A fast vehicle, whose tyres hold it nowhere, beside the slow one.
    given = {**given, name: np.array([given[name], 60.0])}
    batch, warned = answered(**known, **given)
    others = [message for message in warned if message.code == "another_fits"]
    assert str(others[0]).startswith("1 of 2 cases: ")
    alone, _ = answered(**known, **{**given, name: float(given[name][0])})
    assert getattr(batch, f"speed_{label}")[0] == pytest.approx(getattr(alone, f"speed_{label}"))
    alike = [one.partition(" cases, ")[2] or one for one in batch.statements]
    assert tuple(alike) == alone.statements


@pytest.mark.slow
def test_a_study_counts_the_samples():
    known, given, *_ = next(
        one for one in missed() if [message.code for message in one[4]] == ["another_fits"]
    )

    def model(mass_a):
        answer = reconstruct.momentum(**known, **{**given, "mass_a": mass_a})
        return {"speed": getattr(answer, answer.unknowns[0])}

    with pytest.warns(col.OutOfRangeWarning, match="another velocity fits"):
        result = propagate(model, {"mass_a": Normal(given["mass_a"], 1.0)}, samples=64, seed=1)
    assert any("another velocity fits" in sentence for sentence in result.statements)


def test_fast_vehicles_have_one():
    rng = random.Random(5)
    for _ in range(20):
        speeds = {f"speed_{label}": rng.uniform(14.0, 25.0) for label in ("a_after", "b_after")}
        tyres = {f"tyres_{label}": Tyres(0.8, rng.random(), 2.6, 1.5) for label in "ab"}
        answer, warned = answered(
            mass_a=1500.0, mass_b=1800.0, duration=0.12, **tyres, **speeds, heading_a=0.0,
            heading_b=1.6, speed_b=15.0, course_b=1.6, course_a_after=0.5, course_b_after=0.9,
        )  # fmt: skip
        assert answer.statements == ()
        assert [message.code for message in warned if message.code == "another_fits"] == []


def test_two_speeds_along_nearly_one_line_say_that_others_were_not_looked_for():
    """Two pairs of speeds after, each with the same motions before."""
    known = {
        "mass_a": 2299.1059223079574, "mass_b": 1895.7013819444162, "duration": 0.13074227810412944,
        "heading_a": 2.9102565571733194, "heading_b": 0.8281891791037665,
        "yaw_rate_a_after": -2.661880717584603, "yaw_rate_b_after": 5.670050726466594,
        "tyres_a": Tyres(0.857654, 0.670307, 2.49824, 1.40478),
        "tyres_b": Tyres(0.882231, 1.0, 2.96814, 1.46988),
        "course_a": 2.9075134012723964, "course_b": 0.8731261685466749,
        "course_a_after": 2.393967762212393, "course_b_after": 2.3072477459369183,
    }  # fmt: skip
    before = {"speed_a": 12.44500836666282, "speed_b": 8.62563877221815}
    found, _ = answered(**known, **before)
    for pair in ((found.speed_a_after, found.speed_b_after), (7.0263082, 3.8907646)):
        after = dict(zip(("speed_a_after", "speed_b_after"), pair, strict=True))
        again, _ = answered(**known, **after)
        assert (again.speed_a, again.speed_b) == pytest.approx(tuple(before.values()), abs=2e-4)
    near_line, sentence = found.statements
    assert "within 10 degrees of one line" in near_line
    assert "another pair may fit with the tyres, which was not looked for" in sentence
    wide, _ = answered(**{**known, "course_b_after": 1.0}, speed_a=12.4, speed_b=8.6)
    assert wide.statements == ()


@pytest.mark.slow
def test_a_course_of_a_slow_vehicle_beside_the_speed_of_another_says_that_others_may_fit():
    """Two courses of A on one side have the same motions; one of them is not looked for."""
    known = {
        "mass_a": 1272.0, "mass_b": 2238.0, "heading_a": -0.6468, "heading_b": -2.1607,
        "duration": 0.1416, "course_b": -2.1474, "speed_b": 3.8931, "speed_b_after": 3.3095,
        "course_b_after": -1.9932, "course_a_after": -0.7662,
        "tyres_a": Tyres(0.676, [0.055, 0.009, 0.041, 0.068], 2.7, 1.5),
        "tyres_b": Tyres(0.706, [0.051, 0.0036, 0.067, 1.0], 2.7, 1.5),
    }  # fmt: skip
    found, _ = answered(**known, speed_a=4.7)
    assert found.unknowns == ("speed_a_after", "course_a")

    def off(course):
        return answered(**known, course_a=course)[0].speed_a - 4.7

    assert off(found.course_a) == pytest.approx(0.0, abs=1e-9)
    other = optimize.brentq(off, -0.67, -0.66, xtol=1e-12)
    assert off(other) == pytest.approx(0.0, abs=1e-9)
    (sentence,) = found.statements
    assert "with a vehicle as slow as here another pair may fit with the tyres" in sentence
    fast, _ = answered(**{**known, "speed_b": 13.0, "speed_b_after": 12.0}, speed_a=14.0)
    assert fast.statements == ()
    # A case whose numbers overflow leaves the other as it is, without a warning of numpy's.
    long, _ = answered(**known | {"duration": np.array([known["duration"], 1.7e308])}, speed_a=4.7)
    assert long.course_a[0] == pytest.approx(found.course_a, rel=1e-12)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert long.statements == (sentence,)
