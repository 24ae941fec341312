"""``momentum`` with tyres that act while the contact lasts: against a solution of its own equations
made here, the forward solver, and everything that prints or records an input.
"""

import json
import math
import random
import re
import warnings

import numpy as np
import pytest
from scipy.optimize import fsolve

import collisions as col
from collisions import reconstruct
from collisions.derivation import explain
from collisions.reporting import replay
from collisions.travel import Tyres
from collisions.uncertainty import Normal, propagate
from scenes import UNLIKE

G = 9.80665
MASSES = {"mass_a": 1437.0, "mass_b": 1823.0}
CROSSED = {
    "course_a": 0.1,
    "course_b": 1.7,
    "course_a_after": 0.6,
    "course_b_after": 1.1,
    "speed_a_after": 11.0,
    "speed_b_after": 9.0,
    "heading_a": 0.1,
    "heading_b": 1.7,
}
ROLLING = Tyres(
    0.6713,
    (0.1719, 0.2317, 0.3137, 0.4179),
    2.7139,
    1.5317,
    steer=0.0917,
    cornering=8.317,
    height=0.5179,
)


def found(**changes):
    return reconstruct.momentum(**(MASSES | CROSSED | changes))


def locked(friction, **more):
    return Tyres(friction, 1.0, 2.7, 1.5, **more)


def test_locked_wheels_that_do_not_turn_have_their_friction_against_the_motion():
    """Then every wheel moves as the centre does, and the equations are written in three lines."""
    mu, duration = 0.7, 0.11
    half = 1.0 - math.cos(0.25 * math.pi)

    def unit(course, speed):
        return speed * np.array([math.cos(course), math.sin(course)])

    def residual(speeds):
        total = np.zeros(2)
        for label, speed in zip("ab", speeds, strict=True):
            before = unit(CROSSED[f"course_{label}"], speed)
            after = unit(CROSSED[f"course_{label}_after"], CROSSED[f"speed_{label}_after"])
            middle = before + half * (after - before)
            directions = [v / np.linalg.norm(v) for v in (before, middle, after)]
            force = -mu * MASSES[f"mass_{label}"] * G
            mean = (directions[0] + 4.0 * directions[1] + directions[2]) / 6.0
            total += MASSES[f"mass_{label}"] * (after - before) - force * duration * mean
        return total

    expected = fsolve(residual, [15.0, 10.0], xtol=1e-13)
    answer = found(duration=duration, tyres_a=locked(mu), tyres_b=locked(mu))
    assert [answer.speed_a, answer.speed_b] == pytest.approx(expected, rel=2e-5)
    # And without them the speeds differ by two percent and more.
    assert found().speed_a < 0.98 * expected[0]


def test_the_impulse_of_the_tyres_is_in_the_balance():
    answer = found(duration=0.1, tyres_a=ROLLING, tyres_b=locked(0.7), yaw_rate_b_after=2.0)
    for axis, function in (("x", math.cos), ("y", math.sin)):
        change = sum(
            getattr(answer, f"mass_{label}")
            * (
                getattr(answer, f"speed_{label}_after")
                * function(getattr(answer, f"course_{label}_after"))
                - getattr(answer, f"speed_{label}") * function(getattr(answer, f"course_{label}"))
            )
            for label in "ab"
        )
        tyres = sum(getattr(answer, f"tyre_impulse_{axis}_{label}") for label in "ab")
        assert change == pytest.approx(tyres, abs=1e-9 * 3e4)


def forward(rng):
    """A plastic impact of two cars of which the tyres act for a time, forward."""
    tyres = [
        Tyres(rng.uniform(0.5, 0.9), [rng.choice((0.0, 0.3, 1.0)) for _ in range(4)], 2.7, 1.5)
        for _ in range(2)
    ]
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
        for course, x, y in zip(courses, (-2.1, 0.9), (0.0, rng.uniform(-1.0, 1.0)), strict=True)
    )
    times = {"duration": rng.uniform(0.05, 0.15), "tyres_a": tyres[0], "tyres_b": tyres[1]}
    impact = col.eccentric(a, b, 0.0, normal=0.05, point=(0.0, 0.0), friction=0.4, **times)
    known = {"heading_a": courses[0], "heading_b": courses[1], **times}
    for label, side in (("a", impact.a), ("b", impact.b)):
        known |= {
            f"mass_{label}": side.before.mass,
            f"course_{label}": side.before.course,
            f"course_{label}_after": side.after.course,
            f"speed_{label}_after": side.after.speed,
            f"yaw_rate_{label}_after": side.after.yaw_rate,
        }
    return impact, known


@pytest.mark.slow
def test_the_pdof_is_that_of_the_contact_without_the_tyres():
    """What the contact does to A it does to B the other way (Newton's third law); and it comes from
    where it comes forward.
    """
    rng = random.Random(3901)
    misses, of_delta_v = [], []
    for _ in range(12):
        impact, known = forward(rng)
        answer = reconstruct.momentum(**known)
        on_a, on_b = (
            getattr(answer, f"heading_{label}") - getattr(answer, f"pdof_{label}") for label in "ab"
        )
        assert abs(math.remainder(on_a - on_b, math.tau)) == pytest.approx(math.pi, abs=1e-9)
        for label, side in (("a", impact.a), ("b", impact.b)):
            found_from = getattr(answer, f"pdof_{label}")
            misses.append(abs(math.remainder(found_from - side.pdof, math.tau)))
            changed = math.atan2(-side.delta_v_left, side.delta_v_forward) + math.pi
            of_delta_v.append(abs(math.remainder(changed - side.pdof, math.tau)))
    assert np.median(misses) < 0.2 * np.median(of_delta_v)


def test_the_pdof_with_an_impulse_from_outside_says_what_is_in_it():
    said = "is left in its PDOF, which is not the direction of the contact's force alone"
    pushed = found(outside_impulse=(500.0, -300.0))
    assert [said in one for one in pushed.statements].count(True) == 1
    without = {name: value for name, value in CROSSED.items() if "heading" not in name}
    for answer in (
        found(),
        reconstruct.momentum(**MASSES, **without, outside_impulse=(500.0, -300.0)),
    ):
        assert not any(said in one for one in answer.statements)
    for text in (
        explain(pushed, form="text"),
        str(pushed.summary()),
        col.report(pushed, form="markdown", figures=False),
    ):
        assert said in " ".join(text.split())


def test_the_sensitivities_say_that_they_hold_the_impulse_of_the_tyres():
    said = "worked out with the impulse of the tyres as it is"
    with_tyres = found(duration=0.1, tyres_a=ROLLING, tyres_b=locked(0.7))
    for answer, times in ((with_tyres, 1), (found(), 0)):
        for text in (str(answer.summary()), col.report(answer, form="markdown", figures=False)):
            assert " ".join(text.split()).count(said) == times


@pytest.mark.slow
def test_the_forward_answer_is_found_again():
    """The forward solver takes the force from the motions of an impact without tyres, this one from
    those with them: what is left of their effect is a tenth of it.
    """
    rng = random.Random(39)
    with_tyres, without = [], []
    for _ in range(60):
        impact, known = forward(rng)
        truth = np.array([impact.a.before.speed, impact.b.before.speed])
        for misses, given in (
            (with_tyres, known),
            (
                without,
                {n: v for n, v in known.items() if n[:4] not in ("dura", "tyre", "yaw_")},
            ),
        ):
            answer = reconstruct.momentum(**given)
            misses.append(np.abs(np.array([answer.speed_a, answer.speed_b]) - truth).max())
    assert np.median(with_tyres) < 0.1 * np.median(without)
    assert max(with_tyres) < 0.25 * max(without)


def test_yaw_rates_turn_the_forces():
    turned = found(duration=0.1, tyres_a=locked(0.7), yaw_rate_a_after=6.0)
    straight = found(duration=0.1, tyres_a=locked(0.7))
    assert turned.tyre_impulse_x_a != straight.tyre_impulse_x_a
    assert turned.yaw_rate_a_after == 6.0
    assert straight.yaw_rate_a_after is None
    assert "yaw rate of A was not given and taken as 0" in explain(straight, form="text")
    assert "taken as 0" not in explain(turned, form="text")


@pytest.mark.slow
def test_a_batch_has_the_answers_of_its_cases():
    durations, frictions = np.array([0.06, 0.1, 0.14]), np.array([0.3, 0.6, 0.9])
    many = found(duration=durations, tyres_a=locked(frictions), tyres_b=ROLLING)
    for i, (duration, friction) in enumerate(zip(durations, frictions, strict=True)):
        one = found(duration=duration, tyres_a=locked(friction), tyres_b=ROLLING)
        assert many.speed_a[i] == pytest.approx(one.speed_a, rel=1e-13)
        assert many.tyre_impulse_y_b[i] == pytest.approx(one.tyre_impulse_y_b, rel=1e-12)


def test_a_batch_refuses_the_cases_whose_tyres_cannot_be():
    with pytest.warns(col.CollisionsWarning, match="2 not_positive, 1 bad_friction"):
        many = found(
            duration=np.array([0.1, 0.0, -0.1, 0.1]),
            tyres_a=locked(np.array([0.7, 0.7, 0.7, -1.0])),
        )
    assert np.isnan(many.speed_a).tolist() == [False, True, True, True]


def test_distributions_go_through():
    def model(duration, friction):
        return {"b": found(duration=duration, tyres_a=locked(friction)).speed_b}

    study = propagate(
        model, {"duration": Normal(0.1, 0.01), "friction": Normal(0.7, 0.05)}, samples=256, seed=3
    )
    middle = found(duration=0.1, tyres_a=locked(0.7)).speed_b
    assert study["b"].mean == pytest.approx(middle, rel=1e-3)
    low, high = study["b"].interval()
    # A tenth of the effect of the tyres, and twice that where both are 95 %.
    moved = abs(middle - found().speed_b)
    assert 0.1 * moved < high - low < moved


@pytest.mark.slow
@pytest.mark.parametrize("name", ["duration", "yaw_rate_a_after", *ROLLING.named])
def test_every_number_is_used_and_said(name):
    arguments = {
        "duration": 0.1013,
        "tyres_a": ROLLING,
        "tyres_b": locked(0.5137),
        "yaw_rate_a_after": 0.7139,
    }
    if name in arguments:
        value, other = arguments[name], arguments | {name: 1.139 * arguments[name]}
    else:
        value = ROLLING.named[name]
        changed = {
            "lock": [0.777 if name == f"lock[{i}]" else lock for i, lock in enumerate(ROLLING.lock)]
        }
        moved = ROLLING.replace(**(changed if "lock" in name else {name: 1.139 * value}))
        other = arguments | {"tyres_a": moved}
    answer, beside = found(**arguments), found(**other)
    assert answer.speed_a != beside.speed_a
    for form in ("text", "markdown"):
        assert f"{value:.6g}" in explain(answer, units="si", form=form)
    page = col.report(answer, form="markdown", units="si", figures=False)
    assert f"{value:.6g}" in page.partition("## Record")[0]
    assert replay(page) == answer
    assert col.report(replay(page), form="markdown", units="si", figures=False) == page
    assert json.dumps(value) in page.partition("## Record")[2]


@pytest.mark.parametrize(
    ("arguments", "code", "argument"),
    [
        ({"duration": 0.1}, "bad_combination", "duration"),
        ({"tyres_a": locked(0.7)}, "one_stiffness", "duration"),
        ({"duration": 0.0, "tyres_a": locked(0.7)}, "not_positive", "duration"),
        ({"duration": 0.1, "tyres_a": 0.7}, "not_tyres", "tyres_a"),
        (
            {"duration": 0.1, "tyres_b": locked(0.7), "heading_b": None},
            "missing_heading",
            "heading_b",
        ),
        (
            {"duration": 0.1, "tyres_b": locked(0.7), "yaw_rate_a_after": 1.0},
            "bad_combination",
            "yaw_rate_a_after",
        ),
        ({"yaw_rate_a_after": 1.0}, "bad_combination", "yaw_rate_a_after"),
    ],
)
def test_what_cannot_be_used_is_refused(arguments, code, argument):
    with pytest.raises(col.InputError) as refused:
        found(**arguments)
    assert refused.value.code == code
    assert refused.value.fields["argument"] == argument


def test_without_tyres_it_says_what_that_leaves_out():
    """The estimate is nearly what wheels that slide change, which is worked out with them."""
    instant = found()
    sliding = found(duration=0.1, tyres_a=locked(0.7), tyres_b=locked(0.7))
    assert sliding.statements == ()
    (sentence,) = instant.statements
    assert sentence.startswith("found as an instant, which leaves out the tyres")
    for name in ("speed_a", "speed_b"):
        change = getattr(sliding, name) - getattr(instant, name)
        words = f"speed of {name[-1].upper()}"
        said = re.search(rf"{words} would be ([0-9.]+) m/s (more|less)", sentence)
        assert float(said[1]) == pytest.approx(abs(change), rel=0.06)
        assert (said[2] == "more") == (change > 0.0)
    for text in (
        explain(instant, form="text"),
        str(instant.summary()),
        col.report(instant, form="markdown", figures=False),
    ):
        assert "which leaves out the tyres" in " ".join(text.split())


def test_what_a_planar_reconstruction_leaves_out_is_said():
    a, b = UNLIKE[0].replace(vy=0.0), UNLIKE[1]
    contact = {"normal": 0.07, "point": (0.05, 0.09), "friction": 0.08}
    end = col.eccentric(a, b, 0.15, **contact)
    assert end.statements == ()
    answer = reconstruct.planar(end.a.after, end.b.after, restitution=0.15, **contact)
    left = col.left_out(answer)
    tyres = max(left.a.tyre_share, left.b.tyre_share)
    motion = max(left.a.geometry_share, left.b.geometry_share)
    (sentence,) = answer.statements
    assert f"about {100 * tyres:.0f} percent for tyres that slide" in sentence
    assert f"and {100 * motion:.0f} percent for point and normal that move on" in sentence
    for text in (explain(answer, form="text"), col.report(answer, form="markdown", figures=False)):
        assert "Found as an instant" in text


def test_tyres_that_are_in_the_answer_are_no_finding():
    checks = [
        col.diagnose(answer).measured & {"tyre_impulse", "instant"}
        for answer in (found(), found(duration=0.1, tyres_a=ROLLING, tyres_b=ROLLING))
    ]
    assert checks == [{"tyre_impulse", "instant"}, set()]


def test_without_the_tyres_of_one_vehicle_it_says_what_these_would_change():
    one = found(duration=0.13, tyres_a=ROLLING)
    both = found(duration=0.13, tyres_a=ROLLING, tyres_b=locked(0.7))
    (sentence,) = one.statements
    assert sentence.startswith(
        "found without the tyres of vehicle B: if its wheels slid for 0.13 s with a drag of 0.7"
    )
    said = re.search(r"the speed of B would be ([0-9.]+) m/s more; give tyres_b=", sentence)
    assert float(said[1]) == pytest.approx(both.speed_b - one.speed_b, rel=0.06)
    assert both.statements == ()
    limits = {"tyre_impulse": 0.0, "instant": 0.0}
    (tyres,) = (each for each in col.diagnose(one, limits=limits) if each.code == "tyre_impulse")
    assert tyres.vehicle == "b"
    assert tyres.measured == pytest.approx(0.7 * G * 0.13 / one.delta_v_b, rel=1e-12)
    (instant,) = (each for each in col.diagnose(one, limits=limits) if each.code == "instant")
    page = " ".join(col.report(one, form="markdown", figures=False).split())
    for text in (instant.sentence, " ".join(explain(one, form="text").split()), page):
        assert "without the tyres of vehicle B" in text


@pytest.mark.parametrize("wheels", [np.array([1.0, 2.0]), np.zeros(0), "x", 0])
def test_tyres_that_are_none_are_refused_without_a_duration_too(wheels):
    known = {"course_a": 0, "course_b": 1, "course_a_after": 0.3, "course_b_after": 0.5}
    known |= {"speed_a_after": 5, "speed_b_after": 6, "heading_a": 0}
    with pytest.raises(col.InputError, match="tyres_a must be Tyres") as refused:
        reconstruct.momentum(1500, 1500, **known, tyres_a=wheels)
    assert "tyres need a duration" in str(refused.value)


@pytest.mark.parametrize(
    ("units", "a", "b"), [("us", "1.8 mph", "1.7 mph"), ("si", "0.83", "0.75")]
)
def test_a_statement_has_the_units_of_its_page(units, a, b):
    """The summary and the derivation: of about 0.825 m/s 1.8 mph, and of 0.75 m/s 1.7 mph."""
    found = reconstruct.momentum(
        1500.0, 1200.0, course_a=0.0, course_b="90 deg",
        speed_a_after=11.0, course_a_after="25 deg", speed_b_after=12.0, course_b_after="40 deg",
    )  # fmt: skip
    for page in (found.summary(units), col.explain(found, units=units, form="text")):
        text = " ".join(str(page).split())
        assert f"the speed of A would be {a}" in text
        assert f"the speed of B would be {b}" in text


@pytest.mark.parametrize(("off", "says"), [(1e-9, True), (1e-8, True), (1e-3, False)])
def test_a_normal_along_which_nearly_nothing_closes_has_no_restitution_to_rely_on(off, says):
    """Square to the relative velocity before, but for this angle."""
    instant = found()
    x, y = (
        instant.speed_a * function(instant.course_a) - instant.speed_b * function(instant.course_b)
        for function in (math.cos, math.sin)
    )
    normal = math.atan2(y, x) + 0.5 * math.pi - off
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert found(normal=normal).closing_speed > 0.0
        many = found(normal=normal, speed_a_after=np.array([11.0, 11.0]))
    codes = [one.message.code for one in caught]
    assert codes.count("ill_conditioned") == (2 if says else 0)
    assert np.all(np.isfinite(many.restitution))
