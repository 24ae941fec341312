"""Impulses from outside and incomplete impacts: by hand, by balances, and forwards and
back again.
"""

import itertools
import json
import math
import random
import warnings

import numpy as np
import pytest

import collisions as col
from collisions.derivation import explain
from collisions.diagnostics import diagnose
from collisions.reporting import report
from collisions.travel import Tyres
from reference import evaluate
from scenes import PUSHED, cases, draw, solved, solved_together

LAWS = ("brach", "kudlich-slibar", "stronge")
A = col.Vehicle(
    mass=1500.0,
    yaw_inertia=2400.0,
    vx=15.0,
    vy=2.0,
    yaw_rate=0.1,
    x=-2.0,
    y=0.4,
    heading=0.1,
    name="A",
)
B = col.Vehicle(mass=1200.0, yaw_inertia=1700.0, vy=9.0, x=2.0, y=-0.2, name="B")
PLACE = {"normal": 0.3, "point": (0.1, 0.2)}
PUSH = {"outside_a": (-400.0, 250.0, 120.0), "outside_b": (600.0, -300.0)}
IN_LINE = {"normal": 0.0, "point": (0.0, 0.0)}
FIRST = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, vx=10.0, x=-2.0, y=0.0)
SECOND = col.Vehicle(mass=1000.0, yaw_inertia=1500.0, x=2.0, y=0.0)


def energy(vehicle):
    """Kinetic energy of translation and rotation; none of what is fixed."""
    moving = (
        0.0 if math.isinf(vehicle.mass) else 0.5 * vehicle.mass * (vehicle.vx**2 + vehicle.vy**2)
    )
    return moving + (
        0.0 if math.isinf(vehicle.yaw_inertia) else 0.5 * vehicle.yaw_inertia * vehicle.yaw_rate**2
    )


# --- Impulses from outside ------------------------------------------------------------------------


@pytest.mark.parametrize("law", LAWS)
def test_what_parts_them_before_is_refused_with_tyres_too(law):
    """Alone and in a batch: the tyres of a contact that there is not do nothing to it."""
    speeds = np.linspace(1.0, 8.0, 8)
    a, b = (
        col.Vehicle(mass=1500, yaw_inertia=2600, vx=vx, x=x, y=y, heading=0.0)
        for vx, x, y in ((speeds, -2.2, 0.0), (0.0, 2.2, 0.4))
    )
    more = {"point": (0.0, 0.2), "friction": 0.5, "law": law, "outside_a": (-6000.0, 0.0)}
    tyres = {"duration": 0.1, "tyres_a": Tyres(0.7, 1.0, 2.7, 1.5)}
    bare, found = (
        col.eccentric(a, b, 0.1, normal=0.0, on_failure="nan", **more, **with_tyres)
        for with_tyres in ({}, tyres)
    )
    parted = bare.status == col.Status.SEPARATING
    assert np.any(parted)
    assert not np.all(parted)
    assert np.all(found.status[parted] == col.Status.SEPARATING)
    assert np.all(np.isnan(found.a.delta_vx[parted]))
    for solver in (col.eccentric, col.solve):
        with pytest.raises(col.NoImpactError, match="part the bodies"):
            solver(a.replace(vx=2.0), b, 0.1, normal=0.0, **more, **tyres)


@pytest.mark.parametrize("law", LAWS)
def test_in_line_by_hand(law):
    """Brakes of B that take 500 N s: c' = 10 + 500/1000, Pn = m (c' + e c) with m = 600 kg."""
    impact = col.eccentric(
        FIRST, SECOND, 0.2, friction=0.5, law=law, outside_b=(-500.0, 0.0), **IN_LINE
    )
    assert impact.closing_speed == 10.0
    assert impact.separation_speed == pytest.approx(2.0, rel=1e-14)
    assert impact.normal_impulse == pytest.approx(600.0 * (10.5 + 2.0), rel=1e-14)
    assert impact.b.delta_vx == pytest.approx(7.5 - 0.5, rel=1e-14)
    assert impact.a.delta_vx == pytest.approx(-5.0, rel=1e-14)
    assert impact.b.outside_work == pytest.approx(-500.0 * 3.5, rel=1e-14)
    assert (impact.a.outside_x, impact.b.outside_x, impact.b.outside_yaw) == (0.0, -500.0, 0.0)


def test_more_than_twice_the_closing_speed_that_is_left():
    """An impulse from outside that holds the vehicles apart: what the contact still brings is e c
    and more than 2 c'.
    """
    impact = col.eccentric(FIRST, SECOND, 0.5, friction=0.0, outside_b=(8000.0, 0.0), **IN_LINE)
    assert impact.normal_impulse == pytest.approx(600.0 * (2.0 + 5.0), rel=1e-14)
    assert impact.normal_impulse > 2.0 * 600.0 * 2.0
    assert impact.separation_speed == 5.0


@pytest.mark.parametrize(
    ("law", "push"), [("brach", 15000.0), ("kudlich-slibar", 15001.0), ("stronge", 10000.0)]
)
def test_what_parts_them_before_is_refused(law, push):
    with pytest.raises(col.NoImpactError, match="impulses from outside part the bodies") as refused:
        col.eccentric(FIRST, SECOND, 0.5, friction=0.0, law=law, outside_b=(push, 0.0), **IN_LINE)
    assert refused.value.code == "separating"
    many = col.eccentric(
        FIRST,
        SECOND,
        0.5,
        friction=0.0,
        law=law,
        outside_b=(np.array([0.0, push]), 0.0),
        on_failure="nan",
        **IN_LINE,
    )
    assert many.status.tolist() == [col.Status.OK, col.Status.SEPARATING]
    assert np.isnan(many.b.delta_v[1])
    assert many.b.outside_x[1] == push


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(
    "family",
    [
        "traffic",
        *(
            pytest.param(name, marks=pytest.mark.slow)
            for name in ("barrier", "A pinned", "B pinned")
        ),
    ],
)
def test_momentum_and_energy_balance_with_their_share(family, law):
    """Kinetic energy before and the work from outside are that after and the loss; momentum with
    both impulses.
    """
    for scene, _ in cases(family, law, PUSHED, 100):
        impact = solved("eccentric", scene)
        sides = (impact.a, impact.b)
        if any(
            (math.isinf(side.before.mass) and side.before.speed)
            or math.isinf(side.before.yaw_inertia)
            for side in sides
        ):
            continue
        before, after = (
            sum(map(energy, states))
            for states in zip(*((s.before, s.after) for s in sides), strict=True)
        )
        lost = impact.energy_loss - impact.a.outside_work - impact.b.outside_work
        # Differences of energies of a million joules, of bodies that a light partner may make a
        # thousand times as fast.
        assert before - after == pytest.approx(lost, abs=1e-12 * (before + after) + 1e-6), scene
        assert impact.momentum_residual <= 1e-12 * (
            abs(impact.normal_impulse) + abs(impact.tangential_impulse) + 1e4
        )
        changes = sum(side.kinetic_energy_change for side in sides)
        assert changes == pytest.approx(after - before, abs=1e-12 * (before + after) + 1e-6), scene
        for side in sides:
            if side.before.pivot is not None:
                whole = side.before.mass * side.delta_vx - side.impulse_x - side.outside_x
                assert side.pivot_impulse_x == pytest.approx(whole, abs=1e-6)


@pytest.mark.parametrize("law", LAWS)
def test_none_and_zero_are_the_same(law):
    for friction in (0.0, 0.3, 2.0):
        without = col.eccentric(A, B, 0.3, friction=friction, law=law, **PLACE)
        zero = col.eccentric(A, B, 0.3, friction=friction, law=law, outside_a=(0.0, 0.0), **PLACE)
        for name in (
            "normal_impulse",
            "tangential_impulse",
            "energy_loss",
            "energy_loss_normal",
            "slip_after",
        ):
            assert getattr(zero, name) == pytest.approx(
                getattr(without, name), rel=1e-13, abs=1e-13
            )
        assert zero.a.outside_work == without.b.outside_work == 0.0


@pytest.mark.parametrize("law", LAWS)
def test_an_elastic_contact_without_friction_gains_nothing(law):
    """By the balance of energy, what the contact takes at the mean of the speeds before and after
    is then 0; what rounding leaves of it is no gain, in a batch or alone.
    """
    generator, count = np.random.default_rng(7), 2000
    speed, normal = generator.uniform(5.0, 30.0, count), generator.uniform(-0.4, 0.4, count)
    push = [generator.uniform(-size, size, count) for size in (600.0, 900.0, 200.0)]

    def solve(take):
        outside = tuple(take(part) for part in push)
        return col.eccentric(
            A.replace(vx=take(speed)), B, 1.0, friction=0.0, law=law, normal=take(normal),
            point=(0.1, 0.2), outside_b=outside,
        )  # fmt: skip

    with warnings.catch_warnings():
        warnings.simplefilter("error", col.EnergyGainWarning)
        many = solve(lambda part: part)
        ones = [solve(lambda part, at=at: float(part[at])) for at in range(0, count, 20)]
    assert np.all(many.ok)
    assert all(one.ok for one in ones)
    size = many.closing_speed * many.normal_impulse
    assert np.all(np.abs(many.energy_loss) <= 16.0 * 2.0**-52 * size)


def test_an_infinite_mass_takes_none():
    wall = col.Vehicle.barrier()
    plain, pushed = (
        col.eccentric(FIRST, wall, 0.2, friction=0.4, **IN_LINE, **push)
        for push in ({}, {"outside_b": (9e5, 1.0, 5.0)})
    )
    assert pushed.normal_impulse == plain.normal_impulse
    assert pushed.b.delta_v == 0.0


@pytest.mark.parametrize("law", LAWS)
def test_a_pivot_takes_the_moment_about_it(law):
    """A bar that a force of its own turns about the pivot: the same as the yaw rate that the force
    gives it before.
    """
    bar = col.Vehicle(mass=1000.0, yaw_inertia=4000.0 / 3.0, x=0.0, y=2.0, pivot=(0.0, 0.0))
    pushed = col.eccentric(
        FIRST.replace(y=4.0),
        bar,
        0.0,
        normal=0.0,
        point=(0.0, 4.0),
        friction=0.0,
        law=law,
        outside_b=(300.0, 50.0, -40.0),
    )
    turning = -(2.0 * 300.0 + 40.0) / (4000.0 / 3.0 + 4000.0)
    before = bar.replace(yaw_rate=turning)
    other = col.eccentric(
        FIRST.replace(y=4.0), before, 0.0, normal=0.0, point=(0.0, 4.0), friction=0.0, law=law
    )
    assert pushed.normal_impulse == pytest.approx(other.normal_impulse, rel=1e-14)
    assert pushed.b.after.yaw_rate == pytest.approx(other.b.after.yaw_rate, rel=1e-13)
    assert pushed.b.after.vx == pytest.approx(-2.0 * pushed.b.after.yaw_rate, rel=1e-14)


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
def test_a_batch_is_its_cases(law):
    scenes = [scene for scene, _ in cases("traffic", law, PUSHED, 100)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.EnergyGainWarning)
        many = solved_together("eccentric", scenes)
    for at, scene in enumerate(scenes):
        one = solved("eccentric", scene)
        for name in ("normal_impulse", "separation_speed", "energy_loss", "compression_impulse"):
            assert getattr(many, name)[at] == pytest.approx(getattr(one, name), rel=1e-9), name
        assert many.b.outside_work[at] == pytest.approx(one.b.outside_work, rel=1e-9)
    record = json.loads(json.dumps(many.case(3).to_dict()))
    assert col.Impact.from_dict(record).to_dict() == record


def test_solve_takes_the_eccentric_model():
    scene = {"friction": 0.5, **IN_LINE}
    assert col.required_model(FIRST, SECOND, 0.2, tolerance=1.0, **scene).model == "linear_central"
    choice = col.required_model(FIRST, SECOND, 0.2, tolerance=1.0, outside_b=(-500.0, 0.0), **scene)
    assert choice.model == "eccentric"
    assert "impulse from outside" in choice.reason
    assert set(choice.errors.values()) == {math.inf}
    impact = col.solve(FIRST, SECOND, 0.2, tolerance=1.0, outside_b=(-500.0, 0.0), **scene)
    assert (
        impact.normal_impulse
        == col.eccentric(FIRST, SECOND, 0.2, outside_b=(-500.0, 0.0), **scene).normal_impulse
    )
    many = col.solve(
        FIRST, SECOND, 0.2, tolerance=np.array([0.0, 1.0]), outside_b=(-500.0, 0.0), **scene
    )
    assert many.normal_impulse == pytest.approx(impact.normal_impulse, rel=1e-14)
    with pytest.raises(col.MissingInputError):
        col.solve(
            FIRST.replace(yaw_inertia=None),
            SECOND,
            0.2,
            tolerance=1.0,
            outside_b=(-500.0, 0.0),
            **scene,
        )


def test_given_with_units_recorded_and_changed():
    impact = col.eccentric(A, B, 0.3, friction=0.4, outside_a=("100 lbf*s", 5, "3 N*m*s"), **PLACE)
    assert impact.a.outside_x == pytest.approx(444.8221615260501, rel=1e-12)
    assert impact.to_dict()["inputs"]["outside_a"] == ["100 lbf*s", 5.0, "3 N*m*s"]
    assert col.Impact.from_dict(impact.to_dict()) == impact
    assert impact.a.q.outside_yaw.to("N*m*s").magnitude == 3.0
    assert impact.again(outside_a=None, outside_b=(0.0, 0.0)).normal_impulse == pytest.approx(
        col.eccentric(A, B, 0.3, friction=0.4, **PLACE).normal_impulse, rel=1e-13
    )
    columns = impact.to_columns()
    assert columns["a.outside_x"] == [impact.a.outside_x]
    assert "b.outside_work" in columns


@pytest.mark.parametrize(
    ("given", "code"),
    [
        (5.0, "bad_shape"),
        ((1.0,), "bad_shape"),
        ((1.0, 2.0, 3.0, 4.0), "bad_shape"),
        (("1 m", 0.0), "bad_units"),
        ((math.inf, 0.0), "not_finite"),
    ],
)
def test_what_is_no_impulse_is_refused(given, code):
    with pytest.raises(col.InputError, match="outside_b") as refused:
        col.eccentric(A, B, 0.3, friction=0.4, outside_b=given, **PLACE)
    assert refused.value.code == code
    with pytest.raises(TypeError):
        col.oblique_central(A, B, 0.3, normal=0.0, friction=0.4, outside_b=(1.0, 0.0))


def test_left_out_hands_the_tyres_over():
    """By hand for a car at rest that is struck: its tyres pull back as soon as it
    moves, 0.7 g m T.
    """
    impact = col.eccentric(FIRST.replace(vx=3.0), SECOND, 0.3, friction=0.5, **IN_LINE)
    found = col.left_out(impact, duration=0.1, drag=0.7)
    pull = 0.7 * 9.80665 * 0.1
    assert found.outside_b == pytest.approx((-1000.0 * pull, 0.0), rel=1e-3)
    assert found.outside_a == pytest.approx((-1500.0 * pull, 0.0), rel=1e-12)
    braked = impact.again(outside_a=found.outside_a, outside_b=found.outside_b)
    # What left_out estimates by a small part of the tyre impulse; in line the answer is linear in
    # it.
    assert abs(braked.b.delta_v - impact.b.delta_v) == pytest.approx(found.b.tyre_delta_v, rel=1e-3)
    many = col.left_out(impact, duration=np.array([0.05, 0.1]))
    assert many.outside_b[0] == pytest.approx(np.array([-500.0, -1000.0]) * pull, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
def test_explained_and_reported(law):
    rng = random.Random(law)
    done = 0
    while done < 6:
        scene = draw(rng.choice(("traffic", "B pinned", "barrier")), law, PUSHED, rng)
        if evaluate(scene).refused:
            continue
        impact = solved("eccentric", scene)
        page = explain(impact, form="text", units=rng.choice(("si", "metric", "us")))
        assert "From outside an impulse acts on" in page
        assert "In this form the numbers cancel" not in page, scene
        done += 1
    impact = col.eccentric(A, B, 0.3, friction=0.4, law=law, **PLACE, **PUSH)
    text = report(impact, form="markdown")
    assert "impulse on A from outside" in text
    assert "work of the impulse from outside" in text
    assert "rounding" not in [finding.code for finding in diagnose(impact)]


# --- Incomplete impacts ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    "solver", ["linear_central", "oblique_central", "eccentric", "solve", "required_model"]
)
def test_a_restitution_below_0_needs_the_option(solver):
    """Draws of a Normal(0.1, 0.1) must not slip below 0 unseen."""
    contact = {"normal": 0.0} if "central" in solver else dict(IN_LINE)
    contact |= {} if solver == "linear_central" else {"friction": 0.3}
    call = getattr(col, solver)
    with pytest.raises(col.InputError, match="incomplete=True") as refused:
        call(FIRST, SECOND, -0.1, **contact)
    assert refused.value.code == "bad_restitution"
    assert call(FIRST, SECOND, -0.1, incomplete=True, **contact) is not None
    for e in (-1.0, -1.5, 1.1, math.nan):
        with pytest.raises(col.InputError, match="above -1 and at most 1") as refused:
            call(FIRST, SECOND, e, incomplete=True, **contact)
        assert refused.value.code == "bad_restitution"
    with pytest.raises(col.InputError, match="incomplete must be True or False") as refused:
        call(FIRST, SECOND, 0.1, incomplete=1, **contact)
    assert refused.value.code == "bad_option"


def test_in_a_batch_only_the_cases_below_are_refused():
    e = np.array([-1.0, -0.2, 0.0, 0.2])
    for incomplete, refused in (
        (True, [True, False, False, False]),
        (False, [True, True, False, False]),
    ):
        many = col.eccentric(
            A, B, e, friction=0.4, incomplete=incomplete, on_failure="nan", **PLACE
        )
        assert many.refused.tolist() == refused
        kinds = [
            "" if gone else kind
            for gone, kind in zip(
                refused, ["", "incomplete", "plastic", "elastoplastic"], strict=True
            )
        ]
        assert many.kind.tolist() == kinds
        assert many.complete.tolist() == [
            not gone and kind != "incomplete" for gone, kind in zip(refused, kinds, strict=True)
        ]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("friction", [0.0, 0.05])
def test_sliding_it_is_a_part_of_the_plastic_impulse(law, friction):
    plastic = col.eccentric(A, B, 0.0, friction=friction, law=law, **PLACE)
    assert plastic.regime in ("frictionless", "sliding")
    for e in (-0.1, -0.6):
        impact = col.eccentric(A, B, e, friction=friction, law=law, incomplete=True, **PLACE)
        assert impact.normal_impulse == pytest.approx((1.0 + e) * plastic.normal_impulse, rel=1e-13)
        assert impact.separation_speed == pytest.approx(e * impact.closing_speed, rel=1e-13)
        assert impact.compression_impulse == impact.normal_impulse
        assert impact.restitution_impulse == 0.0
        assert impact.energy_loss_normal == pytest.approx(
            0.5 * (1.0 - e) * impact.closing_speed * impact.normal_impulse, rel=1e-12
        )
        assert impact.energy_absorbed == impact.energy_loss_normal > 0.0
        assert impact.a.at_compression == impact.a.after
        assert math.isnan(impact.common_velocity)
        assert (impact.kind, impact.complete) == ("incomplete", False)
        assert col.Impact.from_dict(json.loads(json.dumps(impact.to_dict()))) == impact


def test_in_line_by_hand_incomplete():
    """1500 kg at 10 m/s passes 1000 kg at rest and leaves 2 m/s of the closing speed: Pn = 600 x
    0.8 x 10.
    """
    impact = col.linear_central(FIRST, SECOND, -0.2, incomplete=True)
    assert impact.normal_impulse == pytest.approx(4800.0, rel=1e-14)
    assert (impact.a.after.vx, impact.b.after.vx) == (pytest.approx(6.8), pytest.approx(4.8))
    assert impact.energy_loss == pytest.approx(0.5 * 600.0 * (100.0 - 4.0), rel=1e-14)


@pytest.mark.slow
@pytest.mark.parametrize("e", [-0.02, -0.5])
def test_central_goes_back_from_any_three(e):
    impact = col.linear_central(FIRST, SECOND, e, incomplete=True)
    values = {
        "va": 10.0,
        "vb": 0.0,
        "va_after": impact.a.after.vx,
        "vb_after": impact.b.after.vx,
        "restitution": e,
    }
    values |= {"energy_loss": impact.energy_loss}
    for names in itertools.combinations(values, 3):
        known = {name: values[name] for name in names}
        try:
            found = (col.reconstruct.central(1500.0, 1000.0, incomplete=True, **known),)
        except col.AmbiguousSolutionError as two:
            found = two.solutions
        assert any(
            one.a.before.vx == pytest.approx(10.0, rel=1e-9)
            and one.restitution == pytest.approx(e, rel=1e-7)
            for one in found
        ), names
    with pytest.raises(col.AmbiguousSolutionError) as two:
        col.reconstruct.central(
            1500.0, 1000.0, va=10.0, vb=0.0, energy_loss=impact.energy_loss, incomplete=True
        )
    assert sorted(one.restitution for one in two.value.solutions) == pytest.approx(
        [e, -e], rel=1e-9
    )
    assert (
        col.reconstruct.central(
            1500.0, 1000.0, va=10.0, vb=0.0, energy_loss=impact.energy_loss
        ).restitution
        > 0.0
    )
    with pytest.raises(col.NoSolutionError, match="incomplete=True") as refused:
        col.reconstruct.central(1500.0, 1000.0, va=10.0, vb=0.0, va_after=impact.a.after.vx)
    assert refused.value.code == "not_separating"


@pytest.mark.slow
@pytest.mark.parametrize("law", ["brach", "kudlich-slibar"])
@pytest.mark.filterwarnings("ignore:the speed of . came out:collisions.OutOfRangeWarning")
def test_planar_and_speeds_go_back(law):
    contact = {"law": law, "incomplete": True, **PLACE}
    for e, (rule, value) in itertools.product(
        (-0.05, -0.4),
        (("friction", 0.0), ("friction", 0.08), ("friction", 2.0), ("impulse_ratio", 0.1)),
    ):
        impact = col.eccentric(A, B, e, **contact, **{rule: value})
        lost = impact.regime == "sticking" and law == "brach"
        for known in (
            {"restitution": e},
            {"closing_speed": impact.closing_speed},
            {"energy_loss": impact.energy_loss},
        ):
            try:
                found = (
                    col.reconstruct.planar(
                        impact.a.after, impact.b.after, **known, **contact, **{rule: value}
                    ),
                )
            except col.AmbiguousSolutionError as several:
                found = several.solutions
            except col.NoSolutionError as refused:
                found, lost = (), lost and refused.code == "stick_inverse"
                assert lost
                continue
            assert any(
                one.a.before.vx == pytest.approx(15.0, rel=1e-9)
                and one.b.before.vy == pytest.approx(9.0, rel=1e-9)
                for one in found
            )
        crush_a, crush_b = impact.max_crush_speeds(0.3)
        asked = {"course_a": A.course, "course_b": B.course, "restitution": e, "speed_a": A.speed}
        for known in (
            {"delta_v_b": impact.b.delta_v},
            {"energy_loss": impact.energy_loss},
            {"max_crush_speed_a": crush_a, "max_crush_speed_b": crush_b},
        ):
            found = col.reconstruct.speeds(A, B, **asked, **known, **contact, **{rule: value})
            assert any(one.b.before.speed == pytest.approx(9.0, rel=1e-6) for one in found)
    with pytest.raises(col.InputError, match="incomplete=True"):
        col.reconstruct.planar(
            impact.a.after,
            impact.b.after,
            restitution=-0.1,
            normal=0.3,
            point=(0.1, 0.2),
            friction=0.1,
        )


@pytest.mark.slow
def test_speeds_take_a_function_that_goes_below_0():
    """A restitution that falls through 0 with the closing speed: found by the search on its grid
    from -1.
    """
    impact = col.eccentric(A, B, -0.15, friction=0.08, incomplete=True, **PLACE)

    def falling(closing):
        return -0.15 - 0.02 * (closing - impact.closing_speed)

    asked = {
        "course_a": A.course,
        "course_b": B.course,
        "speed_a": A.speed,
        "delta_v_b": impact.b.delta_v,
        "friction": 0.08,
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.OutOfRangeWarning)
        found = col.reconstruct.speeds(A, B, restitution=falling, incomplete=True, **asked, **PLACE)
    assert any(
        one.b.before.speed == pytest.approx(9.0, rel=1e-6)
        and one.restitution == pytest.approx(-0.15, rel=1e-6)
        for one in found
    )


@pytest.mark.slow
def test_what_is_left_out_and_found():
    impact = col.eccentric(A, B, -0.3, friction=0.4, incomplete=True, **PLACE)
    found = col.left_out(impact)
    assert math.isnan(found.mutual_crush)
    assert math.isnan(found.residual_crush)
    assert math.isfinite(found.a.tyre_delta_v)
    assert math.isfinite(found.b.geometry_delta_v)
    (finding,) = (one for one in diagnose(impact) if one.code == "incomplete")
    assert finding.measured == pytest.approx(0.3 * impact.closing_speed, rel=1e-12)
    assert "pass" in finding.sentence
    assert "tear" in finding.sentence
    assert "incomplete" in report(impact, form="markdown")
    assert "incomplete" in explain(impact)


def test_the_pulse_of_an_incomplete_impact_ends_on_the_way_up():
    """A linear spring from c to -e c: s = (1 - cos w t)/(1 + e) with cos w T = -e; its means by a
    sum of 100,000 parts.
    """
    from collisions.impact import pulse

    for e in (-1e-6, -0.2, -0.9):
        shares = (np.arange(100000) + 0.5) / 100000
        passed = (1.0 - np.cos(math.acos(-e) * shares)) / (1.0 + e)
        assert pulse.passed(e, 0.375) == pytest.approx(
            (1.0 - math.cos(0.375 * math.acos(-e))) / (1.0 + e), rel=1e-12
        )
        assert pulse.mean_passed(e) == pytest.approx(passed.mean(), rel=1e-9)
        assert pulse.mean_square_passed(e) == pytest.approx((passed**2).mean(), rel=1e-9)
        assert pulse.mean_passed(np.array([e, 0.3])).tolist() == pytest.approx(
            [pulse.mean_passed(e), pulse.mean_passed(0.3)]
        )
    for e in (-1.0, -1.2):  # as a search may try: nothing is held
        for found in (pulse.passed(e, 0.375), pulse.mean_passed(e)):
            assert math.isnan(found)
        assert np.isnan(pulse.passed(np.array([e]), 0.375)).all()


def test_an_impulse_from_outside_beyond_all_measure_is_refused_under_stronge():
    """Infinite friction stops the slip on no way at all, by which nothing may be divided."""
    a = col.Vehicle(
        mass=1500.0, vx=-15.0, vy=-17.0, yaw_rate=-1.0, yaw_inertia=2500.0, x=0.7, y=0.3
    )
    b = col.Vehicle(mass=1200.0, vx=2.0, vy=4.0, yaw_inertia=1900.0, x=-1.1, y=-1.2)
    contact = {"normal": -2.0, "point": (4.8, -1.0), "friction": math.inf, "law": "stronge"}
    with pytest.raises(col.CollisionsError):
        col.eccentric(a, b, 0.38, outside_a=(-33.0, 1e200), **contact)


def low_speed(law, count, seed, e):
    """Two cars that close slowly, under impulses from outside that often part them or press them
    together; arrays.
    """
    rng = np.random.default_rng(seed)

    def between(low, high):
        return rng.uniform(low, high, count)

    a = {
        "mass": between(800, 2500),
        "yaw_inertia": between(1000, 4000),
        "vx": between(0, 4),
        "vy": between(-1.5, 1.5),
    }
    b = {
        "mass": between(800, 2500),
        "yaw_inertia": between(1000, 4000),
        "vx": between(-2, 0),
        "vy": between(-1, 1),
    }
    a |= {"x": between(-2.5, -1), "y": between(-1, 1)}
    b |= {"x": between(1, 2.5), "y": between(-1, 1)}
    friction = np.where(rng.random(count) < 0.3, math.inf, between(0, 1))
    pushes = {f"outside_{label}": (between(-4000, 4000), between(-4000, 4000)) for label in "ab"}
    return (
        a,
        b,
        between(*e),
        {"friction": friction, **pushes},
        {"law": law, "normal": 0.0, "point": (0.0, 0.0)},
    )


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("e", [(0.0, 1.0), (-0.9, 0.0)])
def test_a_case_by_itself_ends_as_in_a_batch(law, e):
    """Also where less is left closing than e times what closed before, or nothing, or where they
    are only pressed together.
    """
    count = 300
    a, b, restitution, arrays, rest = low_speed(law, count, 12, e)

    def solve(take, on_failure):
        bodies = [
            col.Vehicle(**{name: take(value) for name, value in body.items()}) for body in (a, b)
        ]
        given = {
            name: tuple(map(take, value)) if isinstance(value, tuple) else take(value)
            for name, value in arrays.items()
        }
        return col.eccentric(
            *bodies,
            take(restitution),
            **given,
            **rest,
            incomplete=e[0] < 0.0,
            on_failure=on_failure,
        )

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.EnergyGainWarning)
        many = solve(lambda value: value, "nan")
    for at in range(count):
        if many.status[at] > col.Status.ENERGY_GAIN:
            with pytest.raises(col.CollisionsError) as refused:
                solve(lambda value, at=at: float(value[at]), None)
            assert refused.value.code == col.Status(many.status[at]).label
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.EnergyGainWarning)
            one = solve(lambda value, at=at: float(value[at]), None)
        assert one.status == many.status[at]
        assert one.b.delta_v == pytest.approx(many.b.delta_v[at], rel=1e-9)
    assert count / 20 < np.count_nonzero(many.status > col.Status.ENERGY_GAIN) < count / 2


def test_what_impulses_from_outside_leave_of_the_compression_decides_under_stronge():
    """Up to where they alone stop the approach it parts at e c, however little closes; beyond, the
    work to give back is none.
    """
    contact = {"friction": 0.0, "law": "stronge", **IN_LINE}
    for push in (8000.0, 9999.0, 9999.999999):
        impact = col.eccentric(FIRST, SECOND, 0.5, outside_b=(push, 0.0), **contact)
        assert impact.separation_speed == pytest.approx(5.0, rel=1e-12)
    with pytest.raises(
        col.NoImpactError, match=r"'stronge' finds no compression .* take law='brach'"
    ) as refused:
        col.eccentric(FIRST, SECOND, 0.5, outside_b=(10001.0, 0.0), **contact)
    assert refused.value.code == "separating"
    # An incomplete one that would end before it began.
    with pytest.raises(col.NoImpactError, match="by more than restitution does"):
        col.eccentric(FIRST, SECOND, -0.5, outside_b=(6000.0, 0.0), incomplete=True, **contact)


def test_no_speed_of_maximum_crush_where_the_contact_gave_energy():
    """Under a huge moment the work of the contact, at the mean of the velocities, is below 0: NaN
    by itself as in a batch.
    """
    moments = np.array([1e30, 0.0])
    together = col.eccentric(
        A, B, 0.3, **PLACE, friction=0.5, law="stronge", outside_a=(0.0, 0.0, moments)
    )
    alone = col.eccentric(
        A, B, 0.3, **PLACE, friction=0.5, law="stronge", outside_a=(0.0, 0.0, 1e30)
    )
    assert alone.energy_absorbed < 0.0 < together.energy_absorbed[1]
    assert all(map(math.isnan, alone.max_crush_speeds(0.5)))
    for speeds in together.max_crush_speeds(0.5):
        assert np.isnan(speeds).tolist() == [True, False]


SLIDING = {
    "pushed along the tangent": {"outside_b": (0.0, -4000.0)},
    "pushed": {"outside_a": (-900.0, 100.0, 200.0), "outside_b": (300.0, 0.0, -150.0)},
    "tyres": {"duration": 0.1, "tyres_a": Tyres(0.8, 1.0, 2.7, 1.5),
        "tyres_b": Tyres(0.8, 1.0, 2.7, 1.5)},
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("acts", SLIDING.values(), ids=SLIDING)
@pytest.mark.parametrize("turns", [True, False])
def test_the_laws_are_one_where_the_contact_slides_one_way(acts, turns):
    """Also in what each energy is of and in what has passed by the end of compression; and
    restitution gives back e squared of the work of compression along the normal.
    """
    e, inertias = 0.3, (2500.0, 1900.0) if turns else (math.inf, math.inf)
    a = col.Vehicle(mass=1500.0, yaw_inertia=inertias[0], x=-2.1, y=0.0, heading=0.0, vx=6.0)
    b = col.Vehicle(
        mass=1250.0,
        yaw_inertia=inertias[1],
        x=0.9,
        y=0.0,
        heading="90 deg",
        vy=np.array([6.0, 9.0]),
    )
    contact = {"normal": 0.0, "point": (0.0, 0.1), "friction": 0.1, **acts}
    for single in (0, 1, None):
        brach, stronge = (
            col.eccentric(
                a, b if single is None else b.replace(vy=(6.0, 9.0)[single]), e, law=law, **contact
            )
            for law in ("brach", "stronge")
        )
        assert np.all(brach.regime == "sliding")
        mine, other = stronge.to_columns(), brach.to_columns()
        for name, values in other.items():
            if isinstance(values[0], float) and not name.startswith(("critical", "no_slip")):
                assert mine[name] == pytest.approx(values, rel=1e-9, abs=1e-9, nan_ok=True), name
        for impact in (brach, stronge):
            back = impact.energy_absorbed - impact.energy_loss_normal
            assert back == pytest.approx(e * e * impact.energy_absorbed, rel=1e-9)
            assert impact.max_crush_speeds(1.0)[0] == pytest.approx(
                np.sqrt(2.0 * impact.energy_absorbed / 1500.0), rel=1e-12
            )


def test_a_push_along_the_tangent_leaves_the_work_along_the_normal():
    """Of bodies that do not turn: half the reduced mass times the square of the closing speed."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=math.inf, x=-2.1, y=0.0, vx=8.0)
    b = col.Vehicle(mass=1250.0, yaw_inertia=math.inf, x=0.9, y=0.0, vy=9.0)
    impact = col.eccentric(
        a, b, 0.5, normal=0.0, point=(0.0, 0.0), friction=0.1, law="stronge", outside_b=(0.0, -4e3)
    )
    work = 0.5 * (1500.0 * 1250.0 / 2750.0) * 8.0**2
    assert impact.energy_absorbed == pytest.approx(work, rel=1e-12)
    assert impact.energy_loss_normal == pytest.approx(0.75 * work, rel=1e-12)
    assert impact.energy_loss_tangential == pytest.approx(impact.energy_loss - 0.75 * work)


@pytest.mark.slow
def test_compression_ends_within_the_contact_whatever_acts():
    """Where with a part of what acts from outside it would not, all of that comes first."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.1, y=0.0, heading=0.0, vx=3.435146)
    b = col.Vehicle(
        mass=1250.0, yaw_inertia=1900.0, x=0.9, y=-1.449387, heading="90 deg", vy=-11.488038
    )
    pushes = {"outside_a": (53.37, 584.66, 460.55), "outside_b": (938.92, 89.65, -514.24)}
    contact = {"normal": 0.0, "point": (0.0, 0.1), "law": "stronge", **pushes}
    for friction in (math.inf, np.array([0.1, math.inf])):
        impact = col.eccentric(a, b, 0.6, friction=friction, **contact)
        assert np.all(impact.compression_impulse > 0.0)
        assert np.all(impact.restitution_impulse > 0.0)
        for index in range(np.size(friction)):
            one = impact if np.ndim(friction) == 0 else impact.case(index)
            page = explain(one, form="text")
            assert "taken as 1/(1 + e) of them" in " ".join(page.split())


@pytest.mark.slow
def test_what_acts_from_outside_under_stronge_is_explained():
    """Every regime: the derivation gives what the solver does, or raises."""
    rng = random.Random(45)
    regimes, within = set(), []
    for _ in range(150):
        a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.1, y=0.0, vx=rng.uniform(3.0, 15.0))
        b = col.Vehicle(mass=1250.0, yaw_inertia=1900.0, x=0.9, y=rng.uniform(-1.5, 1.5),
            vy=rng.uniform(-12.0, 12.0))  # fmt: skip
        pushes = {
            f"outside_{label}": tuple(rng.gauss(0.0, 600.0) for _ in range(3)) for label in "ab"
        }
        try:
            impact = col.eccentric(
                a,
                b,
                rng.choice((0.0, 0.2, 0.6)),
                normal=0.0,
                point=(0.0, 0.1),
                friction=rng.choice((0.0, 0.1, 0.4, 2.0, math.inf)),
                law="stronge",
                **pushes,
            )
        except col.CollisionsError:
            continue
        explain(impact, form="text")
        regimes.add(impact.regime)
        within.append(impact.compression_impulse <= impact.normal_impulse * (1.0 + 1e-12))
    assert regimes == {"sliding", "sticking", "reversing", "frictionless"}
    assert all(within)
    assert len(within) > 100
