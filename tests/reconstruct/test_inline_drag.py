"""The in-line shortcut with tyres: the closing speed of ``eccentric`` with the same impulses from
outside is found again from everything that may be known.
"""

import math
import random

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct

G = 9.80665
KINDS = ("delta_v_a", "delta_v_b", "energy_loss", "ees_a", "max_crush_speed_a")


def struck(rng, restitution=None):
    """A runs into the rear of B; drags act on both as impulses against their motion."""
    mass_a, mass_b = rng.uniform(900.0, 2200.0), rng.uniform(900.0, 2200.0)
    e = rng.uniform(0.05, 0.5) if restitution is None else restitution
    held = {
        "duration": rng.uniform(0.05, 0.15),
        "drag_a": rng.choice((0.0, 0.7, rng.uniform(0.0, 0.9))),
        "drag_b": rng.choice((0.7, rng.uniform(0.1, 0.9))),
    }
    a = col.Vehicle(
        mass=mass_a, yaw_inertia=2000.0, vx=rng.uniform(8.0, 20.0), x=-2.0, y=0.0, heading=0.0
    )
    b = col.Vehicle(mass=mass_b, yaw_inertia=2000.0, vx=2.0, x=2.0, y=0.0, heading=0.0)
    outside = {
        f"outside_{label}": (-held[f"drag_{label}"] * mass * G * held["duration"], 0.0)
        for label, mass in (("a", mass_a), ("b", mass_b))
    }
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.0}
    return col.eccentric(a, b, e, **contact, **outside), held


def known_of(impact, kind):
    if kind == "ees_a":
        return dict(zip(("ees_a", "ees_b"), impact.ees(0.3), strict=True))
    if kind == "max_crush_speed_a":
        names = "max_crush_speed_a", "max_crush_speed_b"
        return dict(zip(names, impact.max_crush_speeds(0.3), strict=True))
    if kind == "energy_loss":
        return {kind: impact.energy_loss}
    return {kind: getattr(impact, kind[-1]).delta_v}


@pytest.mark.parametrize("kind", KINDS)
def test_the_closing_speed_of_a_forward_answer_is_found_again(kind):
    rng = random.Random(44)
    for _ in range(40):
        impact, held = struck(rng)
        masses = impact.a.before.mass, impact.b.before.mass
        known = known_of(impact, kind)
        found = reconstruct.inline_closing_speed(*masses, impact.restitution, **known, **held)
        assert found == pytest.approx(impact.closing_speed, rel=1e-10)
        if held["drag_a"] != held["drag_b"] or kind.startswith("delta"):
            instant = reconstruct.inline_closing_speed(*masses, impact.restitution, **known)
            assert instant != pytest.approx(impact.closing_speed, rel=1e-4)


def test_a_wall_is_not_held():
    wall = reconstruct.inline_closing_speed(
        1500, np.inf, 0.1, delta_v_a=5.0, duration=0.1, drag_b=0.7
    )
    assert wall == reconstruct.inline_closing_speed(1500, np.inf, 0.1, delta_v_a=5.0)


def test_a_function_of_restitution_is_met_with_drags():
    impact, held = struck(random.Random(1), restitution=0.2)
    masses = impact.a.before.mass, impact.b.before.mass

    def restitution(speed):
        return 0.2 + 0.01 * (impact.closing_speed - speed)

    found = reconstruct.inline_closing_speed(
        *masses, restitution, delta_v_b=impact.b.delta_v, **held
    )
    assert found == pytest.approx(impact.closing_speed, rel=1e-6)


def test_a_batch_has_the_answers_of_its_cases_and_refuses_what_cannot_be():
    known = {"delta_v_b": 3.0, "duration": 0.1}
    drags = np.array([0.0, 0.4, 0.8])
    many = reconstruct.inline_closing_speed(1500, 1300, 0.2, **known, drag_b=drags)
    each = [
        reconstruct.inline_closing_speed(1500, 1300, 0.2, **known, drag_b=float(drag))
        for drag in drags
    ]
    assert many.tolist() == each
    with pytest.warns(col.CollisionsWarning, match="1 not_positive"):
        some = reconstruct.inline_closing_speed(
            1500, 1300, 0.2, delta_v_b=3.0, duration=np.array([0.1, -0.1]), drag_b=0.7
        )
    assert np.isnan(some).tolist() == [False, True]
    with pytest.warns(col.CollisionsWarning, match="1 negative_size"):
        reconstruct.inline_closing_speed(
            1500, 1300, 0.2, delta_v_b=3.0, duration=0.1, drag_b=np.array([0.7, -0.7])
        )


@pytest.mark.parametrize(
    ("more", "code", "words"),
    [
        ({"duration": 0.1}, "bad_combination", "duration counts for drag_a and drag_b alone"),
        ({"drag_b": 0.7}, "bad_combination", "drag_b need a duration"),
        ({"drag_b": -0.7, "duration": 0.1}, "negative_drag", "drag_b"),
        ({"drag_b": 0.7, "duration": 0.0}, "not_positive", "duration must be > 0"),
    ],
)
def test_what_cannot_be_used_is_refused(more, code, words):
    with pytest.raises(col.InputError, match=words) as refused:
        reconstruct.inline_closing_speed(1500, 1300, 0.2, delta_v_b=3.0, **more)
    assert refused.value.code == code


def test_a_delta_v_that_tyres_alone_would_give_is_no_impact():
    with pytest.raises(col.NoSolutionError, match="tyres alone") as refused:
        reconstruct.inline_closing_speed(1500, 1300, 0.2, delta_v_a=0.5, duration=0.1, drag_a=0.7)
    assert refused.value.code == "contradictory"


@pytest.mark.parametrize("restitution", [0.2, lambda closing: 0.2])
@pytest.mark.parametrize("closing", [4.0, 12.0, 32.0])
def test_the_size_of_a_delta_v_that_its_tyres_may_have_made(closing, restitution):
    """A lorry that brakes is hit from behind: whether it ends faster or slower its size does not
    say, and both closing speeds lead forwards to it.
    """
    lost = -0.7 * G * 20000.0 * 0.15
    place = {"x": 0.0, "y": 0.0, "yaw_inertia": math.inf}

    def delta_v(speed):
        a = col.Vehicle(mass=1200, vx=8.0 + speed, **place)
        b = col.Vehicle(mass=20000, vx=8.0, **place)
        return col.eccentric(
            a, b, 0.2, normal=0, point=(0, 0), friction=0, outside_b=(lost, 0)
        ).b.delta_vx

    seen = delta_v(closing)
    known = {"delta_v_b": abs(seen), "duration": 0.15, "drag_b": 0.7}
    if closing > 30.0:  # beyond what the tyres could do alone
        assert seen > 0.0
        found = reconstruct.inline_closing_speed(1200, 20000, restitution, **known)
        assert found == pytest.approx(closing, rel=1e-12)
        return
    with pytest.raises(col.AmbiguousSolutionError, match="closing speeds of") as caught:
        reconstruct.inline_closing_speed(1200, 20000, restitution, **known)
    slow, fast = caught.value.solutions
    assert slow == pytest.approx(closing, rel=1e-12)
    assert delta_v(fast) == pytest.approx(-seen, rel=1e-12)
    known["delta_v_b"] = np.array([abs(seen), 3.0])
    with pytest.warns(col.CollisionsWarning, match="1 ambiguous"):
        found = reconstruct.inline_closing_speed(1200, 20000, restitution, **known)
    assert np.isnan(found).tolist() == [True, False]


@pytest.mark.parametrize("restitution", [0.2, lambda speed: 0.2], ids=["number", "function"])
def test_a_delta_v_of_b_that_its_tyres_or_a_give_is_said_to_be_that(restitution):
    with pytest.raises(col.AmbiguousSolutionError, match="its tyres slow B by more") as both:
        reconstruct.inline_closing_speed(
            1500, 1300, restitution, delta_v_b="1 km/h", duration="100 ms", drag_b=0.7
        )
    # The impulse of the contact is what B changes by and what its tyres take, of either sign; from
    # it comes (1 + e) times the closing speed and what the tyres open the gap by.
    slowed, share = 0.7 * 9.80665 * 0.1, 1500 / 2800
    expected = [((slowed + sign / 3.6) / share - slowed) / 1.2 for sign in (-1.0, 1.0)]
    assert both.value.solutions == pytest.approx(tuple(expected), rel=1e-12)
