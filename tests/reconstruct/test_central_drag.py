"""``central`` with tyres that act while the contact lasts: motions that were integrated here are
found again from every three values.
"""

import json
import random
from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct

G = 9.80665
EPS = 2.0**-52
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


@pytest.mark.slow
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


def exactly_ended(mass_a, mass_b, va, vb, e, held):
    """What momentum makes of an impact with tyres, in rationals, each rounded once."""
    mass_a, mass_b, va, vb, e = map(Fraction, (mass_a, mass_b, va, vb, e))
    slowed_a, slowed_b = (
        Fraction(G) * Fraction(held["duration"]) * Fraction(held.get(f"drag_{label}", 0.0))
        for label in "ab"
    )
    closing = va - vb
    impulse = mass_a * mass_b / (mass_a + mass_b) * ((1 + e) * closing + slowed_b - slowed_a)
    after = va - impulse / mass_a - slowed_a, vb + impulse / mass_b - slowed_b
    values = va, vb, *after, e, impulse * (1 - e) * closing / 2
    return dict(zip(KNOWN, map(float, values), strict=True))


def answers(masses, known, held):
    """The answers, one or both, and the code of the refusal if there is one."""
    try:
        return [reconstruct.central(*masses, **known, **held)], None
    except col.CollisionsError as error:
        return error.solutions, error.code


def lost(names, equal, e):
    """The code for what these values say nothing of."""
    if e == 0.0:
        return "inverse_e0" if {"va_after", "vb_after", "restitution"} == {*names} else None
    # Equal masses exchange their velocities, whatever they were.
    crossed = ({"va", "vb_after"}, {"vb", "va_after"})
    exchanged = equal and any({*names} - pair <= {"restitution", "energy_loss"} for pair in crossed)
    return "undetermined" if exchanged or {"restitution", "energy_loss"} < {*names} else None


HELD = [
    {"duration": 0.1, "drag_a": 0.3, "drag_b": 0.5},
    {"duration": 0.1, "drag_a": 0.5, "drag_b": 0.3},
    {"duration": 0.1, "drag_a": 0.7},
    {"duration": 0.15, "drag_b": 0.7},
    {"duration": 0.1, "drag_a": 0.4, "drag_b": 0.4},
    {"duration": 0.1, "drag_a": 1e-9},
    {"duration": 0.1, "drag_b": 1e-9},
]


@pytest.mark.slow
@pytest.mark.parametrize("names", list(combinations(KNOWN, 3)), ids="-".join)
@pytest.mark.parametrize("e", [0.0, 1.0])
def test_the_edges_of_restitution_are_found_again(names, e):
    """An e of exactly 0 or 1, which rounding moves to either side, is among the answers; or the
    refusal says what is lost. Where a root is double, e is the square root of its rounding.
    """
    for masses in ((1200.0, 900.0), (1000.0, 1600.0), (1477.163, 1412.903), (1200.0, 1200.0)):
        for va, vb in ((20.0, 10.0), (35.859796, 16.370361)):
            for held in HELD:
                truth = exactly_ended(*masses, va, vb, e, held)
                known = {name: truth[name] for name in names}
                found, code = answers(masses, known, held)
                if not found:
                    assert code == lost(names, masses[0] == masses[1], e), (masses, known, held)
                    continue
                near = min(found, key=lambda one: abs(one.restitution - e))
                within = 16.0 * EPS * (1.0 + near.reconstruction.condition) * va
                assert abs(near.a.before.vx - va) < within, (masses, known, held)
                assert abs(near.b.before.vx - vb) < within, (masses, known, held)
                assert 0.0 <= near.restitution <= 1.0
                assert abs(near.restitution - e) < 4.0 * np.sqrt(EPS), (masses, known, held)


@pytest.mark.parametrize("held", HELD[:4])
@pytest.mark.parametrize("more", [3e-14, 1e-12, 1e-9, 1e-6])
def test_a_restitution_below_0_is_not_taken_for_rounding(held, more):
    """Where B is held more, more energy than that of a plastic impact means a separation below 0;
    where A is held more, less energy does, and what fits is the bounce that loses as much.
    """
    known = {"va": 20.0, "vb": 10.0}
    most = exactly_ended(1200.0, 900.0, 20.0, 10.0, 0.0, held)["energy_loss"]
    bounces = held.get("drag_a", 0.0) > held.get("drag_b", 0.0)
    energy = most * (1.0 - more if bounces else 1.0 + more)
    found, code = answers((1200.0, 900.0), known | {"energy_loss": energy}, held)
    assert code == (None if bounces else "not_separating")
    assert [one.restitution > 0.01 for one in found] == [True] * bounces


@pytest.mark.slow
def test_of_two_answers_with_tyres_neither_is_left_out():
    """Tyres of A slow the approach: a plastic impact and a bounce lose the same, whichever way the
    energy was rounded.
    """
    held = {"duration": 0.1, "drag_a": 0.7}
    truth = exactly_ended(1000.0, 1600.0, 20.0, 0.0, 0.0, held)
    for ulps in range(-4, 5):
        energy = truth["energy_loss"] + ulps * np.spacing(truth["energy_loss"])
        found, code = answers(
            (1000.0, 1600.0), {"va": 20.0, "vb": 0.0, "energy_loss": energy}, held
        )
        assert code == "ambiguous"
        plastic, bounce = sorted(found, key=lambda one: one.restitution)
        assert plastic.restitution == pytest.approx(0.0, abs=1e-13)
        assert plastic.a.after.vx == pytest.approx(truth["va_after"], rel=1e-13)
        # (e g + k / 2)^2 is the same for both: e = -k / g.
        assert bounce.restitution == pytest.approx(0.07 * G / 20.0, rel=1e-12)


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
def test_what_was_given_is_shown_and_a_record_finds_it_again():
    impact = reconstruct.central(
        1100, 950, va="80 km/h", vb=0.0, energy_loss="105 kJ", duration="100 ms", drag_b=0.7
    )
    origin = impact.reconstruction
    assert origin.known == ("va", "vb", "energy_loss", "contact_duration", "drag_b")
    assert (origin.duration, origin.drag_a, origin.drag_b) == (0.1, None, 0.7)
    assert "No drag of A was given: J_Ax = 0" in " ".join(col.explain(impact, form="text").split())
    for page, duration in ((col.explain(impact), "0.1 s"), (col.report(impact), "100 ms")):
        assert "duration of the contact with its tyres" in page
        assert duration in page
        assert "0.7" in page
    (sentence,) = impact.statements
    assert sentence.startswith("found without the tyres of vehicle A: of delta-V")
    again = col.Impact.from_dict(json.loads(json.dumps(impact.to_dict())))
    assert again == impact
    col.report(again)


def test_what_the_tyres_of_a_vehicle_without_a_drag_would_do_is_said():
    """Both slide forward: an impulse J on B moves that of the contact by J m/m_B, m the reduced
    mass, as restitution still ends it.
    """
    known = {"va": 4.0, "vb": 0.0, "vb_after": 2.2, "duration": 0.12}
    one = reconstruct.central(1500, 1300, **known, drag_a=0.7)
    change = 0.7 * 9.80665 * 0.12 * 1500.0 / (1500.0 + 1300.0)
    left = col.left_out(one)
    assert left.duration == 0.12
    assert left.a.tyre_delta_v_bound == 0.0
    assert left.b.tyre_delta_v_bound == pytest.approx(0.7 * 9.80665 * 0.12, rel=1e-12)
    assert left.a.tyre_delta_v == pytest.approx(change * 1300.0 / 1500.0, rel=1e-6)
    (sentence,) = one.statements
    share = max(left.a.tyre_share, left.b.tyre_share)
    assert "without the tyres of vehicle B" in sentence
    assert f"leaves out about {100.0 * share:.0f} percent if they slide" in sentence
    assert "give drag_b=, which is 0 where its wheels roll" in sentence
    found = {each.code: each for each in col.diagnose(one)}
    assert found["instant"].sentence == sentence
    assert found["tyre_impulse"].vehicle == "b"
    for rolls in (0.0, 0.7):
        both = reconstruct.central(1500, 1300, **known, drag_a=0.7, drag_b=rolls)
        assert both.statements == ()
        assert not {"instant", "tyre_impulse"} & {each.code for each in col.diagnose(both)}
        assert col.left_out(both).b.tyre_impulse_bound == 0.0
    wall = reconstruct.central(
        1500, np.inf, va=10.0, vb=4.0, restitution=0.2, duration=0.12, drag_a=0.7
    )
    assert wall.statements == ()


def test_an_instant_that_could_take_drags_says_so():
    behind = reconstruct.central(1100, 950, va=20.0, vb=5.0, restitution=0.2)
    assert "give duration= and drag_a=, drag_b=" in behind.statements[0]
    head_on = reconstruct.central(1100, 950, va=20.0, vb=-15.0, restitution=0.2)
    assert "collisions.left_out" in head_on.statements[0]


def test_a_wall_is_not_asked_for_its_tyres():
    a = col.Vehicle(mass=1500, yaw_inertia=2600, x=-2.0, y=0.3, heading=0.0, vx=12.0)
    contact = {"normal": 0.0, "point": (0.0, 0.0), "impulse_ratio": 0.1}
    after = col.eccentric(a, col.Vehicle.barrier(), 0.2, **contact).a.after
    found = reconstruct.planar(after, col.Vehicle.barrier(), restitution=0.2, **contact)
    assert found.statements[0].endswith("give duration= and tyres_a=")


@pytest.mark.slow
def test_a_report_lists_no_place_that_nobody_gave():
    """Drags make it an impact of two bodies at places of its own."""
    found = reconstruct.central(
        1500.0, 1200.0, va=15.0, vb=0.0, restitution=0.2, duration=0.1, drag_b=0.7
    )
    given = str(col.report(found, form="markdown")).split("## Inputs")[1].split("## ")[0]
    assert "drag of B while the contact lasts" in given
    for word in ("position", "contact point", "inertia", "friction", "law of restitution"):
        assert word not in given, word
    assert "heading" not in given
    for drag in ({"duration": 0.1, "drag_b": 0.7}, {}):
        headed = reconstruct.central(
            1500.0, 1200.0, va=15.0, vb=0.0, restitution=0.2, heading_a="180 deg", **drag
        )
        page = str(col.report(headed, form="markdown", notes={"a.heading": "it drove backwards"}))
        assert "180°. it drove backwards" in page.split("## Inputs")[1].split("## ")[0]
        assert "| A | heading | 180" in str(col.explain(headed))


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
        ({"duration": -0.1, "drag_a": 0.7}, "negative_duration", "duration must be > 0"),
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
