"""``central`` with tyres that act while the contact lasts: motions that were integrated here are
found again from every three values.
"""

import json
import random
from itertools import combinations

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct

G = 9.80665
KNOWN = ("va", "vb", "va_after", "vb_after", "restitution", "energy_loss")


def integrated(rng, steps=4000):
    """Two cars on a line, pushed apart by half a sine in time while each brakes at its own rate.

    Runge and Kutta's method, with the work of the contact along.
    """
    mass = np.array([rng.uniform(900.0, 2200.0), rng.uniform(900.0, 2200.0)])
    drag = np.array([rng.choice((0.0, rng.uniform(0.1, 0.8))), rng.uniform(0.1, 0.8)])
    duration = rng.uniform(0.05, 0.15)
    start = np.array([rng.uniform(9.0, 20.0), rng.uniform(2.5, 5.0), 0.0])
    reduced = mass[0] * mass[1] / mass.sum()
    impulse = reduced * (start[0] - start[1]) * rng.uniform(1.05, 1.4)

    def rate(time, state):
        force = impulse * np.pi / (2.0 * duration) * np.sin(np.pi * time / duration)
        va, vb, _ = state
        pushed = np.array([-force, force]) / mass - G * drag * np.sign([va, vb])
        return np.append(pushed, force * (va - vb))

    state, step = start.copy(), duration / steps
    for i in range(steps):
        now = i * step
        k1 = rate(now, state)
        k2 = rate(now + 0.5 * step, state + 0.5 * step * k1)
        k3 = rate(now + 0.5 * step, state + 0.5 * step * k2)
        k4 = rate(now + step, state + step * k3)
        state = state + step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
    found = dict(zip(KNOWN, [*start[:2], *state[:2]], strict=False))
    found["restitution"] = (state[1] - state[0]) / (start[0] - start[1])
    found["energy_loss"] = state[2]
    held = {"duration": duration, "drag_a": drag[0], "drag_b": drag[1]}
    return mass, found, held


@pytest.fixture(scope="module")
def crashes():
    rng = random.Random(39)
    return [integrated(rng, 400) for _ in range(12)]


@pytest.mark.parametrize("names", list(combinations(KNOWN, 3)), ids="-".join)
def test_an_integrated_motion_is_found_again_from_any_three_values(crashes, names):
    """The pulse is integrated to 1e-9; a condition of some tens makes 1e-6 of it."""
    for mass, truth, held in crashes:
        known = {name: truth[name] for name in names}
        try:
            found = [reconstruct.central(*mass, **known, **held)]
        except col.AmbiguousSolutionError as error:
            found = error.solutions
        misses = []
        for impact in found:
            values = {
                "va": impact.a.before.vx,
                "vb": impact.b.before.vx,
                "va_after": impact.a.after.vx,
                "vb_after": impact.b.after.vx,
                "restitution": impact.restitution,
                "energy_loss": impact.energy_loss / truth["energy_loss"] * truth["va"],
            }
            wanted = truth | {"energy_loss": truth["va"]}
            misses.append(max(abs(values[name] - wanted[name]) for name in KNOWN))
        assert min(misses) < 1e-6


def test_every_way_of_finding_it_can_be_derived(crashes):
    """``explain`` raises where an equation has two sides that differ."""
    mass, truth, held = crashes[0]
    for names in combinations(KNOWN, 3):
        try:
            found = [reconstruct.central(*mass, **{one: truth[one] for one in names}, **held)]
        except col.AmbiguousSolutionError as error:
            found = error.solutions
        for impact in found:
            assert "Closing speed of these" in col.explain(impact)


def test_a_batch_answers_as_its_cases(crashes):
    mass, truth, held = (
        {name: np.array([one[at][name] for one in crashes]) for name in crashes[0][at]}
        if at
        else np.array([one[at] for one in crashes]).T
        for at in range(3)
    )
    known = {name: truth[name] for name in ("va", "vb_after", "restitution")}
    found = reconstruct.central(*mass, **known, **held)
    for i in range(len(crashes)):
        alone = reconstruct.central(
            *mass[:, i],
            **{name: value[i] for name, value in known.items()},
            **{name: value[i] for name, value in held.items()},
        )
        assert found.b.before.vx[i] == alone.b.before.vx
        assert found.reconstruction.condition[i] == alone.reconstruction.condition


def test_what_was_given_is_shown_and_a_record_finds_it_again():
    impact = reconstruct.central(
        1100, 950, va="80 km/h", vb=0.0, energy_loss="105 kJ", duration="100 ms", drag_b=0.7
    )
    origin = impact.reconstruction
    assert origin.known == ("va", "vb", "energy_loss", "contact_duration", "drag_a", "drag_b")
    assert (origin.duration, origin.drag_a, origin.drag_b) == (0.1, 0.0, 0.7)
    for page, duration in ((col.explain(impact), "0.1 s"), (col.report(impact), "100 ms")):
        assert "duration of the contact with its tyres" in page
        assert duration in page
        assert "0.7" in page
    assert not impact.statements
    again = col.Impact.from_dict(json.loads(json.dumps(impact.to_dict())))
    assert again == impact
    col.report(again)


def test_an_instant_that_could_take_drags_says_so():
    behind = reconstruct.central(1100, 950, va=20.0, vb=5.0, restitution=0.2)
    assert "give `duration=` and `drag_a=`, `drag_b=`" in behind.statements[0]
    head_on = reconstruct.central(1100, 950, va=20.0, vb=-15.0, restitution=0.2)
    assert "collisions.left_out" in head_on.statements[0]


def test_a_barrier_is_not_slowed():
    wall = reconstruct.central(
        1100, np.inf, va=10.0, vb=4.0, restitution=0.1, duration=0.1, drag_a=0.7, drag_b=0.5
    )
    assert wall.b.after.vx == 4.0
    assert wall.a.after.vx == pytest.approx(4.0 - 0.1 * 6.0, abs=1e-12)


@pytest.mark.parametrize(
    ("given", "code", "words"),
    [
        ({"drag_b": 0.7}, "bad_combination", "need a duration"),
        ({"duration": 0.1}, "bad_combination", "duration counts for drag_a and drag_b alone"),
        ({"duration": 0.0, "drag_a": 0.7}, "not_positive", "duration must be > 0"),
        ({"duration": -0.1, "drag_a": 0.7}, "negative_duration", "duration"),
        ({"duration": 0.1, "drag_b": 0.7, "vb": -8.0}, "contradictory", "from B towards A"),
    ],
)
def test_what_cannot_be_is_refused(given, code, words):
    known = {"va": 10.0, "vb": 2.0, "restitution": 0.2} | given
    with pytest.raises(col.CollisionsError, match=words) as caught:
        reconstruct.central(1100, 950, **known)
    assert caught.value.code == code


def test_the_cases_of_a_batch_that_cannot_be_are_nan():
    with pytest.warns(col.CollisionsWarning, match="cases"):
        found = reconstruct.central(
            1100,
            950,
            va=10.0,
            vb=np.array([2.0, -8.0, 2.0, 2.0]),
            restitution=0.2,
            duration=np.array([0.1, 0.1, 0.0, 0.1]),
            drag_b=np.array([0.7, 0.7, 0.7, -0.1]),
        )
    assert np.isfinite(found.b.after.vx).tolist() == [True, False, False, False]


def test_an_energy_that_two_restitutions_lose_while_tyres_act_is_ambiguous():
    """Tyres that slow A more than B take from the separation: of 8000 J lost at 5 m/s one bounce
    gives the one, and another is stopped by them.
    """
    given = {"va": 5.0, "vb": 0.0, "duration": "150 ms", "drag_a": 0.5}
    with pytest.raises(col.AmbiguousSolutionError) as caught:
        reconstruct.central(1500, 1500, energy_loss=8000.0, **given)
    assert len(caught.value.solutions) == 2
    for one in caught.value.solutions:
        again = reconstruct.central(1500, 1500, restitution=one.restitution, **given)
        assert again.energy_loss == pytest.approx(8000.0, rel=1e-9)
        assert again.a.after.vx == pytest.approx(one.a.after.vx, rel=1e-9)
    first, second = (one.a.after.vx for one in caught.value.solutions)
    assert abs(first - second) > 0.3
    many = reconstruct.central(
        1500, 1500, energy_loss=np.array([8000.0, 8000.0]), on_failure="nan", **given
    )
    assert set(many.status.tolist()) == {col.Status.AMBIGUOUS}
