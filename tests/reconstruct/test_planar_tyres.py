"""``planar`` with tyres: the forward solver is found again to rounding, in single cases, batches
and studies, and everything that prints or records an input has the tyres.
"""

import json
import math
import random
import warnings

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct
from collisions.derivation import explain
from collisions.reporting import replay
from collisions.travel import Tyres
from collisions.uncertainty import Normal, propagate
from scenes import UNLIKE, WHEELS

MOTION = ("vx", "vy", "yaw_rate")
A, B = UNLIKE[0], UNLIKE[1].replace(yaw_rate=0.3)
CONTACT = {"normal": 0.0713, "point": (0.0531, 0.0917), "friction": 0.0837}


def drawn(rng):
    """Two cars, their contact and their tyres; it may be that they part."""
    cars = [
        col.Vehicle(
            mass=rng.uniform(800.0, 2500.0),
            yaw_inertia=rng.uniform(1500.0, 4000.0),
            vx=rng.uniform(0.0, 20.0) * side,
            vy=rng.uniform(-15.0, 15.0),
            yaw_rate=rng.choice((0.0, rng.uniform(-2.0, 2.0))),
            x=-2.0 * side,
            y=rng.uniform(-1.0, 1.0),
            heading=rng.uniform(-math.pi, math.pi),
        )
        for side in (1.0, -1.0)
    ]
    tyres = [
        Tyres(
            rng.uniform(0.3, 0.9),
            [rng.choice((0.0, 0.3, 1.0)) for _ in range(4)],
            2.7,
            1.5,
            height=rng.choice((None, 0.5)),
        )
        for _ in range(2)
    ]
    rule = rng.choice(
        (
            {"friction": rng.uniform(0.05, 0.8)},
            {"impulse_ratio": rng.uniform(-0.3, 0.3)},
            {"critical_fraction": rng.choice((0.0, rng.uniform(0.2, 0.9)))},
        )
    )
    contact = {
        "normal": rng.uniform(-0.3, 0.3),
        "point": (rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3)),
        "law": rng.choice(("brach", "kudlich-slibar")),
        "duration": rng.uniform(0.03, 0.15),
        "tyres_a": tyres[0],
        "tyres_b": rng.choice((tyres[1], None)),
        **rule,
    }
    return cars, rng.choice((0.0, rng.uniform(0.05, 0.5))), contact


def ends_so(found, impact):
    """The largest difference of a motion after."""
    return max(
        abs(getattr(one.after, name) - getattr(other.after, name))
        for one, other in ((found.a, impact.a), (found.b, impact.b))
        for name in MOTION
    )


def begins_so(found, impact):
    return max(
        abs(getattr(one.before, name) - getattr(other.before, name))
        for one, other in ((found.a, impact.a), (found.b, impact.b))
        for name in MOTION
    )


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["restitution", "closing_speed", "energy_loss"])
def test_the_forward_answer_is_found_again(kind):
    """Every answer leads to the motions it was made from, and all but a few are the motions that
    they came from: two origins are refused, and solutions have the one.
    """
    rng = random.Random(3901)
    answers, same, several, lost, refused = 0, 0, 0, 0, 0
    codes = set()
    while answers < 25:
        (a, b), e, contact = drawn(rng)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            try:
                impact = col.eccentric(a, b, e, **contact)
            except (col.NoImpactError, col.NoSolutionError):
                continue
            known = e if kind == "restitution" else getattr(impact, kind)
            if impact.normal_impulse < 500.0 or (kind == "energy_loss" and known < 0.0):
                continue
            try:
                found = reconstruct.planar(
                    impact.a.after, impact.b.after, **{kind: known}, **contact
                )
            except col.AmbiguousSolutionError as error:
                several += 1
                lost += min(begins_so(one, impact) for one in error.solutions) > 1e-6
                continue
            except col.NoSolutionError as error:
                # What the impact has erased, and not whether it was found.
                refused += error.code not in ("stick_inverse", "inverse_e0")
                continue
            except col.InputError as error:
                codes.add(error.code)
                continue
        answers += 1
        same += begins_so(found, impact) < 1e-6
        assert ends_so(found, impact) < 1e-9
        assert found.inputs.duration == contact["duration"]
        if kind != "restitution":
            assert getattr(found, kind) == pytest.approx(known, rel=1e-9)
        else:
            assert found.restitution == known
    assert same >= answers - 1
    assert several > 0
    assert codes <= {"bad_combination"}
    assert lost <= 2
    assert refused <= 2


def known_ends(**changes):
    return col.eccentric(A, B, 0.1531, **(CONTACT | WHEELS | changes))


@pytest.mark.slow
def test_one_scene_is_found_again_and_differs_from_the_instant():
    end = known_ends()
    found = reconstruct.planar(end.a.after, end.b.after, restitution=0.1531, **CONTACT, **WHEELS)
    assert begins_so(found, end) < 1e-9
    assert found.a.tyre_impulse_x == pytest.approx(end.a.tyre_impulse_x, rel=1e-9)
    instant = reconstruct.planar(end.a.after, end.b.after, restitution=0.1531, **CONTACT)
    assert begins_so(instant, end) > 0.2
    assert found.reconstruction.method == "planar"
    assert found.reconstruction.answers == 1


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["closing_speed", "energy_loss"])
def test_a_plastic_contact_is_found_with_a_restitution_of_0(kind):
    end = col.eccentric(A, B, 0.0, **CONTACT, **WHEELS)
    found = reconstruct.planar(
        end.a.after, end.b.after, **{kind: getattr(end, kind)}, **CONTACT, **WHEELS
    )
    assert begins_so(found, end) < 1e-8
    assert 0.0 <= found.restitution < 1e-9


@pytest.mark.slow
def test_a_barrier_and_a_pinned_body():
    wall = col.Vehicle.barrier()
    contact = {"normal": 0.2, "point": (0.0, 0.0), "friction": 0.2}
    wheels = {"duration": 0.1, "tyres_a": WHEELS["tyres_a"]}
    end = col.eccentric(A, wall, 0.2, **contact, **wheels)
    found = reconstruct.planar(end.a.after, end.b.after, restitution=0.2, **contact, **wheels)
    assert begins_so(found, end) < 1e-9
    pinned = col.Vehicle(
        mass=1200.0, yaw_inertia=1900.0, x=2.0, y=0.0, heading=1.3, pivot=(2.0, 1.2)
    )
    contact = {"normal": 0.0713, "point": (0.0531, 0.0917), "impulse_ratio": 0.05}
    end = col.eccentric(A, pinned, 0.2, **contact, **wheels)
    found = reconstruct.planar(end.a.after, end.b.after, restitution=0.2, **contact, **wheels)
    assert begins_so(found, end) < 1e-9


@pytest.mark.slow
def test_a_batch_has_the_answers_of_its_cases():
    durations = np.array([0.05, 0.1, 0.14])
    tyres = Tyres(np.array([0.4, 0.6, 0.8]), 1.0, 2.7, 1.5)
    end = known_ends(duration=durations, tyres_b=tyres)
    known = {"restitution": 0.1531, **CONTACT}
    many = reconstruct.planar(
        end.a.after,
        end.b.after,
        **known,
        duration=durations,
        tyres_a=WHEELS["tyres_a"],
        tyres_b=tyres,
    )
    assert np.max(abs(many.a.before.vx - 14.0)) < 1e-9
    for i in range(3):
        one = reconstruct.planar(
            end.case(i).a.after,
            end.case(i).b.after,
            **known,
            duration=durations[i],
            tyres_a=WHEELS["tyres_a"],
            tyres_b=tyres.replace(friction=float(tyres.friction[i])),
        )
        assert many.a.before.vx[i] == pytest.approx(one.a.before.vx, rel=1e-12)
        assert many.b.before.yaw_rate[i] == pytest.approx(one.b.before.yaw_rate, rel=1e-9)


@pytest.mark.slow
def test_a_batch_refuses_what_cannot_be():
    end = known_ends()
    with pytest.warns(col.CollisionsWarning, match="1 not_positive, 1 bad_friction"):
        many = reconstruct.planar(
            end.a.after,
            end.b.after,
            restitution=0.1531,
            **CONTACT,
            duration=np.array([0.1, -0.1, 0.1]),
            tyres_a=Tyres(np.array([0.7, 0.7, -0.7]), 1.0, 2.7, 1.5),
        )
    assert np.isnan(many.a.before.vx).tolist() == [False, True, True]


@pytest.mark.slow
def test_distributions_go_through():
    end = known_ends()

    def model(duration, friction):
        found = reconstruct.planar(
            end.a.after,
            end.b.after,
            restitution=0.1531,
            **CONTACT,
            duration=duration,
            tyres_a=WHEELS["tyres_a"],
            tyres_b=Tyres(friction, 1.0, 2.6319, 1.4731, height=0.5179),
            on_failure="nan",
        )
        return {"speed": found.a.before.speed}

    inputs = {"duration": Normal(0.1013, 0.01), "friction": Normal(0.5713, 0.05)}
    study = propagate(model, inputs, samples=128, seed=3)
    low, high = study["speed"].interval()
    assert low < A.speed < high
    assert high - low < 0.2 * A.speed


@pytest.mark.slow
def test_it_is_explained_reported_and_recorded():
    end = known_ends()
    wheels = WHEELS | {"duration": "101.3 ms"}
    found = reconstruct.planar(
        end.a.after, end.b.after, closing_speed=end.closing_speed, **CONTACT, **wheels
    )
    numbers = ["0.1013", *(f"{value:.6g}" for value in WHEELS["tyres_a"].named.values())]
    page = col.report(found, form="markdown", units="si", figures=False)
    for text in (explain(found, units="si", form="text"), page.partition("## Record")[0]):
        assert [number for number in numbers if number not in text] == []
    assert "given as 101.3 ms" in page
    assert replay(page) == found
    assert col.report(replay(page), form="markdown", units="si", figures=False) == page
    record = json.loads(json.dumps(found.to_dict()))
    assert col.Impact.from_dict(record) == found


@pytest.mark.slow
def test_what_decides_is_said_for_the_lasting_contact():
    """A slow slip: sliding either way or not at all ends so, and each of the solutions leads to
    this end while the tyres act.
    """
    rng, met = random.Random(7), []
    while len(met) < 3:
        (a, b), e, contact = drawn(rng)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            try:
                end = col.eccentric(a, b, e, **contact)
                reconstruct.planar(end.a.after, end.b.after, restitution=e, **contact)
            except col.AmbiguousSolutionError as error:
                met.append((end, error.solutions))
            except (col.NoImpactError, col.NoSolutionError):
                continue
    for end, solutions in met:
        assert len(solutions) > 1
        assert max(ends_so(one, end) for one in solutions) < 1e-9
        assert {one.reconstruction.answers for one in solutions} == {len(solutions)}


@pytest.mark.parametrize(
    ("changes", "code", "argument"),
    [
        ({"tyres_a": None, "tyres_b": None}, "bad_combination", "duration"),
        ({"duration": None}, "one_stiffness", "duration"),
        ({"tyres_b": "locked"}, "not_tyres", "tyres_b"),
    ],
)
def test_what_cannot_be_used_is_refused(changes, code, argument):
    end = known_ends()
    with pytest.raises(col.InputError) as refused:
        reconstruct.planar(
            end.a.after, end.b.after, restitution=0.1531, **CONTACT, **(WHEELS | changes)
        )
    assert refused.value.code == code
    assert refused.value.fields["argument"] == argument


def crashes(count, seed):
    """Pairs of cars that meet, their contacts and tyres as arrays, none of them special."""
    rng = np.random.default_rng(seed)

    def car(x, speed, course):
        return col.Vehicle(
            mass=rng.uniform(900.0, 3000.0, count),
            yaw_inertia=rng.uniform(1200.0, 6000.0, count),
            x=x + rng.normal(0.0, 0.2, count),
            y=rng.normal(0.0, 0.4, count),
            vx=speed * np.cos(course),
            vy=speed * np.sin(course),
            heading=course,
            yaw_rate=rng.normal(0.0, 0.1, count),
        )

    a = car(-2.0, rng.uniform(4.0, 25.0, count), rng.normal(0.0, 0.02, count))
    b = car(1.0, rng.uniform(0.0, 20.0, count), rng.uniform(-3.0, 3.0, count))
    contact = {
        "normal": 0.0,
        "point": (0.0, 0.0),
        "impulse_ratio": rng.uniform(-0.3, 0.3, count),
        "duration": rng.uniform(0.06, 0.14, count),
    }
    for label in ("tyres_a", "tyres_b"):
        locks = [rng.uniform(0.0, 1.0, count) for _ in range(4)]
        contact[label] = Tyres(rng.uniform(0.5, 0.9, count), locks, 2.7, 1.5)
    return a, b, rng.uniform(0.02, 0.4, count), contact


@pytest.mark.slow
@pytest.mark.parametrize("known", ["closing_speed", "restitution", "energy_loss"])
def test_what_is_answered_while_tyres_act_is_what_was(known):
    """Several motions before may end in the same motions, as a tyre pulls to one side or the other
    with the sign of a slip: then none of them is given as the only one.
    """
    a, b, e, contact = crashes(600, 11)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        end = col.eccentric(a, b, e, **contact, on_failure="nan")
        also = e if known == "restitution" else getattr(end, known)
        found = reconstruct.planar(
            end.a.after, end.b.after, **contact, **{known: also}, on_failure="nan"
        )
    off = sum(
        abs(getattr(side.before, name) - getattr(was, name))
        for side, was in ((found.a, a), (found.b, b))
        for name in MOTION
    )
    answered = end.ok & found.ok
    ambiguous = found.status == col.Status.AMBIGUOUS_INVERSE
    assert np.count_nonzero(answered) > 0.6 * np.count_nonzero(end.ok)
    assert np.all(answered | ambiguous | ~end.ok)
    # An origin from which none of the starts comes near is missed, as the statement says.
    assert np.count_nonzero(off[answered] > 1e-6) <= 0.005 * np.count_nonzero(answered)
    assert any("is missed" in line for line in found.statements)
    assert any("(medians)" in line for line in found.statements)


@pytest.mark.slow
def test_every_motion_that_ends_so_is_among_the_solutions():
    """A crash whose end four motions before lead to; each of them does, run forward."""
    a = col.Vehicle(mass=1300, yaw_inertia=3400, x=-2, y=0.4, vx=8.4, heading=0)
    b = col.Vehicle.from_speed(
        mass=1400, yaw_inertia=1600, x=1, y=0.3, speed=2.4, course=0.1, heading=0.1
    )
    contact = {
        "normal": 0.0,
        "point": (0.0, 0.0),
        "impulse_ratio": 0.1,
        "duration": 0.1,
        "tyres_a": Tyres(0.7, 0, 2.7, 1.5),
        "tyres_b": Tyres(0.7, 0.6, 2.7, 1.5),
    }
    end = col.eccentric(a, b, 0.12, **contact)
    with pytest.raises(col.AmbiguousSolutionError, match="yaw rates before: take") as raised:
        reconstruct.planar(end.a.after, end.b.after, closing_speed=end.closing_speed, **contact)
    several = raised.value.solutions
    assert len(several) > 1
    for one in several:
        again = col.eccentric(one.a.before, one.b.before, one.restitution, **contact)
        for side, wanted in ((again.a, end.a), (again.b, end.b)):
            for name in MOTION:
                assert abs(getattr(side.after, name) - getattr(wanted.after, name)) < 1e-8
    assert min(abs(one.b.before.yaw_rate - b.yaw_rate) for one in several) < 1e-8
    # The message tells them apart.
    told = [
        f"{one.a.before.yaw_rate:.3g} rad/s (A) and {one.b.before.yaw_rate:.3g} rad/s (B)"
        for one in several
        if abs(one.b.before.yaw_rate) > 1e-3
    ]
    assert len(set(told)) == len(told) == len(several) - 1
    assert all(text in str(raised.value) for text in [*told, "of 0 rad/s (A) and 0 rad/s (B)"])


@pytest.mark.slow
def test_what_it_still_leaves_out_is_the_motion_that_the_contact_in_time_has():
    """The share that it states, against the contact in time with moving and with fixed places."""
    one = col.Vehicle(mass=1500, yaw_inertia=2600, vx=14.0, x=-2.0, y=0.4, heading=0.1)
    other = col.Vehicle(mass=1200, yaw_inertia=1900, vy=6.0, x=2.0, y=0.0, heading=1.3)
    contact = {"normal": 0.07, "point": (0.05, 0.09), "friction": 0.08}
    rolling = col.travel.Tyres(0.7, 0.0, 2.7, 1.5)
    times = {"duration": 0.1, "tyres_a": rolling, "tyres_b": rolling}
    end = col.eccentric(one, other, 0.15, **contact, **times)
    found = reconstruct.planar(end.a.after, end.b.after, restitution=0.15, **contact, **times)
    moving, fixed = (
        col.time_resolved(one, other, 0.15, **contact, duration=0.1, geometry=geometry)
        for geometry in ("maximum_engagement", "fixed")
    )
    share = max(
        np.hypot(
            getattr(moving, label).delta_vx - getattr(fixed, label).delta_vx,
            getattr(moving, label).delta_vy - getattr(fixed, label).delta_vy,
        )
        / getattr(end, label).delta_v
        for label in "ab"
    )
    (said,) = [text for text in found.statements if "leaves out about" in text]
    assert "0.1 s" in said
    stated = float(said.partition("leaves out about ")[2].partition(" percent")[0])
    assert stated == pytest.approx(100.0 * share, rel=0.5, abs=1.0)
    assert "point and normal that move on" in str(col.report(found))


# A crash to which the tyres bring the contact: as an instant none ends so, near a fold.
BEYOND_A = col.Vehicle(
    mass=1240.48, vx=7.96092, vy=-1.60398, yaw_rate=-0.232128, yaw_inertia=2920.29,
    x=-2.7822, y=1.17859, heading=-0.0939119,
)  # fmt: skip
BEYOND_B = col.Vehicle(
    mass=2497.15, vx=-10.3081, vy=13.0266, yaw_rate=0.785092, yaw_inertia=1370.88,
    x=0.983593, y=3.17105, heading=2.26368,
)  # fmt: skip
BEYOND = {
    "normal": 0.342093794, "point": (0.01822851, -0.072372669), "critical_fraction": 0.9198578,
    "duration": 0.117,
}  # fmt: skip
BEYOND_WHEELS = {
    "tyres_a": Tyres(0.376566, (0.263189, 0.842033, 0.604903, 0.283506), 2.7, 1.5, height=0.5),
    "tyres_b": Tyres(0.45813, (0.147019, 0.896711, 0.992002, 0.514749), 2.7, 1.5),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["restitution", "closing_speed"])
def test_motions_before_are_found_from_the_fold_of_the_instant(kind):
    """Each ends so by ``eccentric``, and the crash is among them."""
    impact = col.eccentric(BEYOND_A, BEYOND_B, 0.4836653, **BEYOND, **BEYOND_WHEELS)
    after = impact.a.after, impact.b.after
    with pytest.raises(col.NoSolutionError) as caught:
        reconstruct.planar(*after, **{kind: getattr(impact, kind)}, **BEYOND, **BEYOND_WHEELS)
    solutions = caught.value.solutions
    for one in solutions:
        again = col.eccentric(
            one.a.before, one.b.before, one.restitution, **BEYOND, **BEYOND_WHEELS
        )
        assert again.a.after.vx == pytest.approx(after[0].vx, abs=1e-6)
        assert again.b.after.yaw_rate == pytest.approx(after[1].yaw_rate, abs=1e-6)
    assert min(abs(one.a.before.vx - BEYOND_A.vx) for one in solutions) < 1e-5


@pytest.mark.slow
def test_a_motion_before_that_was_not_found_is_not_said_to_be_none():
    """Tyres that hardly act do not bring the contact there."""
    impact = col.eccentric(BEYOND_A, BEYOND_B, 0.4836653, **BEYOND, **BEYOND_WHEELS)
    ice = {"tyres_a": Tyres(0.001, 1.0, 2.7, 1.5)}
    with pytest.raises(col.NoSolutionError) as caught:
        reconstruct.planar(impact.a.after, impact.b.after, restitution=0.4836653, **BEYOND, **ice)
    said = str(caught.value)
    assert said.startswith("no motion before was found")
    assert "is missed" in said
    assert "reconstruct.posterior" in said


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["restitution", "closing_speed", "energy_loss"])
@pytest.mark.parametrize(
    ("law", "friction"), [("brach", 0.05), ("kudlich-slibar", 0.05), ("kudlich-slibar", 0.8)]
)
def test_tyres_that_hold_nothing_leave_the_condition(kind, law, friction):
    """Of one that stuck as of one that slid."""
    a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.0, y=0.0, vx=14.0, heading=0.1)
    b = col.Vehicle(mass=1300, yaw_inertia=2000, x=2.0, y=0.8, vx=2.0, vy=11.0, heading=1.4)
    contact = {"normal": 0.0, "point": (0.0, 0.4), "friction": friction, "law": law}
    truth = col.eccentric(a, b, 0.1, **contact)
    assert truth.regime == ("sticking" if friction > 0.5 else "sliding")
    nothing = Tyres(1e-9, 0.0, 2.7, 1.5)
    known = {kind: getattr(truth, kind)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        one, other = (
            reconstruct.planar(
                truth.a.after, truth.b.after, regime=truth.regime, **known, **contact, **more
            )
            for more in ({}, {"duration": 0.1, "tyres_a": nothing})
        )
    assert other.reconstruction.condition == pytest.approx(one.reconstruction.condition, rel=1e-6)
