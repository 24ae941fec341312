"""Impact: its attributes, records that can be solved again, columns for a table, and states that
chain.
"""

import copy
import dataclasses
import gc
import json
import math
import pickle
import weakref
from dataclasses import FrozenInstanceError, is_dataclass

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct
from collisions.impact.impact import solved
from collisions.impact.vehicle_result import VehicleResult
from collisions.quantities.attributes import attributes
from collisions.reporting import replay

A = col.Vehicle(
    mass=1100.0,
    vx=20.0,
    vy=1.0,
    yaw_rate=0.1,
    yaw_inertia=1800.0,
    x=0.0,
    y=0.0,
    heading=0.0,
    name="A",
)
B = col.Vehicle(
    mass=950.0, vy=5.0, yaw_rate=0.2, yaw_inertia=1500.0, x=3.0, y=0.4, heading="90 deg"
)
PINNED = col.Vehicle(mass=1000.0, yaw_inertia=1333.0, x=3.0, y=0.4, pivot=(3.0, -2.0))
MANY = np.linspace(0.0, 1.0, 5)


def scenes():
    """One impact of every kind: solver, law, rule, barrier, pivot, batch."""
    place = {"normal": 0.1, "point": (1.7, 0.3)}
    straight = A.replace(vy=0.0, yaw_rate=0.0)
    yield col.linear_central(straight, B.replace(vy=0.0, yaw_rate=0.0), 0.3)
    yield col.linear_central(straight, col.Vehicle.barrier(), MANY)
    yield col.oblique_central(
        A.replace(yaw_rate=0.0), B.replace(yaw_rate=0.0), 0.3, normal=(3, 1), friction=0.2
    )
    yield col.eccentric(A, B, 0.3, friction=math.inf, **place)
    yield col.eccentric(A, B, 0.3, friction=0.1, law="kudlich-slibar", **place)
    yield col.eccentric(A, B, 0.3, impulse_ratio=0.05, **place)
    yield col.eccentric(A, PINNED, 0.3, critical_fraction=0.5, **place)
    yield col.eccentric(
        A, col.Vehicle.barrier(), MANY * 0.3, friction=np.array([[0.1], [0.9]]), **place
    )
    yield col.eccentric(A, B, 0.3, friction=0.2, law="stronge", **place)
    yield col.time_resolved(A, B, 0.3, friction=0.2, duration=0.1, **place)


SCENES = list(scenes())


@pytest.mark.parametrize("impact", SCENES, ids=[f"{i}-{s.model}" for i, s in enumerate(SCENES)])
def test_records_are_strict_json_and_solve_again_to_the_same_bits(impact):
    """to_dict through JSON without NaN or Infinity, and from_dict equal in every input
    and result.
    """
    text = json.dumps(impact.to_dict(), allow_nan=False)
    again = col.Impact.from_dict(json.loads(text))
    assert again == impact
    assert again.a.after == impact.a.after
    assert json.dumps(again.to_dict(), allow_nan=False) == text


@pytest.mark.parametrize("impact", SCENES, ids=[f"{i}-{s.model}" for i, s in enumerate(SCENES)])
def test_pickles_and_copies(impact):
    """Equal, and arrays stay locked."""
    for twin in (pickle.loads(pickle.dumps(impact)), copy.deepcopy(impact)):
        assert twin == impact
        if isinstance(impact.energy_loss, np.ndarray):
            for array in (twin.energy_loss, twin.a.after.vx, twin.a.delta_v, twin.restitution):
                assert not array.flags.writeable


@pytest.mark.parametrize("impact", SCENES, ids=[f"{i}-{s.model}" for i, s in enumerate(SCENES)])
def test_every_attribute_has_the_shape_of_the_batch(impact):
    """Scalars stay Python floats from reader to answer; in a batch every number has the broadcast
    shape or is an input.
    """
    shape = np.shape(impact.status)
    for owner, kind in ((impact, col.Impact), (impact.a, VehicleResult), (impact.b, VehicleResult)):
        for name in attributes(kind):
            value = getattr(owner, name)
            unit = vars(kind)[name].unit
            if unit is None or value is None:
                continue
            for part in value if isinstance(value, tuple) else (value,):
                if shape == ():
                    assert type(part) is float, name
                elif name not in ("restitution", "friction", "point", "normal", "normal_angle"):
                    assert np.shape(part) in (shape, ()), name


def test_a_reconstruction_read_from_a_record_is_locked():
    """As it is where it was found: no number of a result can be written over."""
    place = {"normal": 0.1, "point": (1.7, 0.3), "friction": 0.0}
    after = col.eccentric(A.replace(vx=A.vx + np.array([0.0, 1.0])), B, 0.3, **place)
    found = col.reconstruct.planar(after.a.after, after.b.after, restitution=0.3, **place)
    again = col.Impact.from_dict(found.to_dict())
    assert again == found
    for impact in (found, again):
        for array in (impact.reconstruction.condition, *impact.reconstruction.contact_velocity):
            assert array.shape == (2,)
            assert not array.flags.writeable


def test_columns_are_flat_and_of_one_length():
    """One list a number, one value a case, nothing nested: what a table takes."""
    for impact in SCENES:
        columns = impact.to_columns()
        assert {len(column) for column in columns.values()} == {np.size(impact.status)}
        assert all(
            type(v) in (float, int, str, bool) for column in columns.values() for v in column
        )
        assert columns["status"] == ["ok"] * np.size(impact.status)
        assert impact.inputs.rule in columns
        np.testing.assert_array_equal(
            columns["a.after.vx"],
            np.ravel(np.broadcast_to(impact.a.after.vx, np.shape(impact.status))),
        )


def test_a_record_that_is_none():
    """Anything else is refused with what it should be."""
    record = SCENES[0].to_dict()
    for broken in (
        {},
        {**record, "format": "other"},
        {**record, "inputs": {}},
        [],
        {**record, "inputs": {**record["inputs"], "a": {}}},
    ):
        with pytest.raises(col.InputError):
            col.Impact.from_dict(broken)


def test_refused_cases_survive_a_record():
    """NaN results and statuses of a batch come back; so does a single case answered with NaN."""
    with pytest.warns(col.CollisionsWarning):
        impact = col.linear_central(
            col.Vehicle(mass=1.0, vx=np.array([1.0, -1.0])), col.Vehicle(mass=1.0), 0.5
        )
    assert col.Impact.from_dict(json.loads(json.dumps(impact.to_dict(), allow_nan=False))) == impact
    one = col.linear_central(
        col.Vehicle(mass=1.0, vx=-1.0), col.Vehicle(mass=1.0), 0.5, on_failure="nan"
    )
    assert col.Impact.from_dict(one.to_dict()) == one


def test_a_batch_is_freed_with_its_last_reference():
    """No cycle keeps the arrays until the collector happens to run."""
    impact = col.linear_central(
        col.Vehicle(mass=1.0, vx=np.array([1.0, 2.0])), col.Vehicle(mass=1.0), 0.5
    )
    reference = weakref.ref(impact.a.after.vx)
    assert impact.b.delta_v.shape == (2,)
    gc.disable()
    try:
        del impact
        assert reference() is None
    finally:
        gc.enable()


def test_frozen():
    """Nothing can be set, and an Impact is not made by hand."""
    with pytest.raises(AttributeError):
        SCENES[0].restitution = 0.5
    with pytest.raises(AttributeError):
        SCENES[0].anything = 0.5
    with pytest.raises(AttributeError):
        SCENES[0].a.delta_v = 0.5
    with pytest.raises(AttributeError):
        del SCENES[0].restitution
    with pytest.raises(TypeError, match="linear_central"):
        col.Impact()
    with pytest.raises(TypeError):
        hash(SCENES[0])


@pytest.mark.slow
def test_repr_and_tables():
    """One line with units, and a table for notebooks, of every kind of impact."""
    for impact in SCENES:
        assert impact.model in repr(impact)
        assert "m/s" in repr(impact)
        assert "<table>" in impact._repr_html_()
        assert "delta_v" in impact.a._repr_html_()
        assert "after" in repr(impact.b)


def test_states_chain():
    """The state after one impact is the state before the next: three cars in a row, plastic, share
    the momentum.
    """
    a, b, c = (col.Vehicle(mass=1000.0, vx=v) for v in (30.0, 0.0, 0.0))
    first = col.linear_central(a, b, 0.0)
    second = col.linear_central(first.b.after, c, 0.0)
    third = col.linear_central(first.a.after, second.b.after.replace(mass=2000.0), 0.0)
    assert third.a.after.vx == pytest.approx(10.0, rel=1e-15)
    struck = col.eccentric(A, PINNED, 0.3, friction=0.2, normal=0.1, point=(1.7, 0.3)).b.after
    again = col.eccentric(
        A.replace(vx=40.0), struck, 0.3, friction=0.2, normal=0.1, point=(1.7, 0.3)
    )
    assert again.b.after.pivot == PINNED.pivot


@pytest.mark.parametrize(
    ("force", "heading", "pdof", "clock"),
    [
        ((-1, 0), 0, 0, 12),
        ((1, 0), 0, 180, 6),
        ((0, 1), 0, 90, 3),
        ((0, -1), 0, -90, 9),
        ((0, -1), 90, 0, 12),
        ((1, 0), 180, 0, 12),
        ((-1, 1), 0, 45, 2),
        ((-math.cos(math.radians(31)), math.sin(math.radians(31))), 0, 31, 1),
        ((-math.cos(math.radians(29)), -math.sin(math.radians(29))), 0, -29, 11),
    ],
)
def test_pdof(force, heading, pdof, clock):
    """0 from straight ahead, positive clockwise (from the right), in (-180, 180]; worked out by
    hand for each direction.
    """
    b = col.Vehicle(mass=1.0, heading=f"{heading} deg")
    a = col.Vehicle(mass=1.0, vx=float(force[0]), vy=float(force[1]))
    side = col.linear_central(a, b, 0.5, normal=tuple(map(float, force))).b
    assert math.degrees(side.pdof) == pytest.approx(pdof, abs=1e-12)
    assert side.pdof_clock == clock
    assert side.pdof > -math.pi


def test_what_needs_a_heading_is_none_without_one():
    """Never taken from the direction of travel."""
    side = SCENES[1].b
    assert side.pdof is side.delta_v_forward is side.delta_v_left is side.pdof_clock is None


def test_own_axes_and_recorder_sign():
    """Struck from its right side a vehicle is pushed to its left: delta_v_left is positive, a
    recorder would print it negative.
    """
    b = col.Vehicle(mass=1000.0, heading="90 deg")
    side = col.linear_central(col.Vehicle(mass=1000.0, vx=-10.0), b, 0.0, normal="180 deg").b
    assert side.delta_v_left == pytest.approx(5.0, rel=1e-15)
    assert side.delta_v_forward == pytest.approx(0.0, abs=1e-15)
    assert side.pdof == pytest.approx(math.pi / 2, rel=1e-15)


def test_ees():
    """Shares of the energy lost (ISO 12353), and of that absorbed at maximum crush; a share outside
    0 to 1 is refused.
    """
    impact = col.linear_central(col.Vehicle(mass=1000.0, vx=20.0), col.Vehicle(mass=2000.0), 0.5)
    for speeds, energy in (
        (impact.ees, impact.energy_loss),
        (impact.max_crush_speeds, impact.energy_absorbed),
    ):
        speed_a, speed_b = speeds("30 %")
        assert 0.5 * (1000.0 * speed_a**2 + 2000.0 * speed_b**2) == pytest.approx(energy, rel=1e-14)
        assert 0.5 * 1000.0 * speed_a**2 == pytest.approx(0.3 * energy, rel=1e-14)
    assert impact.energy_absorbed * (1 - 0.5**2) == pytest.approx(
        impact.energy_loss_normal, rel=1e-14
    )
    # Into a wall: the whole impact speed at maximum crush, of which the loss leaves sqrt(1 - e^2).
    against_wall = col.linear_central(col.Vehicle(mass=1000.0, vx=20.0), col.Vehicle.barrier(), 0.6)
    assert against_wall.max_crush_speeds(1.0) == (20.0, 0.0)
    assert against_wall.ees(1.0) == pytest.approx((16.0, 0.0), rel=1e-14)
    # With friction the whole loss counts, not the part along the normal alone.
    car = {"mass": 1000.0, "yaw_inertia": 1500.0, "y": 0.5}
    slides = col.eccentric(
        col.Vehicle(**car, x=-2.0, vx=20.0, vy=9.0),
        col.Vehicle(**car, x=2.0),
        0.2,
        normal=0.0,
        point=(0.0, 0.0),
        friction=0.3,
    )
    ees_a, ees_b = slides.ees(0.5)
    lost = sum(
        0.5 * 1000.0 * (s.before.speed**2 - s.after.speed**2) - 750.0 * s.after.yaw_rate**2
        for s in (slides.a, slides.b)
    )
    assert 500.0 * (ees_a**2 + ees_b**2) == pytest.approx(lost, rel=1e-12)
    # Energy gained leaves nothing that an equivalent speed could stand for; an elastic impact loses
    # nothing.
    with pytest.warns(col.EnergyGainWarning):
        gains = col.oblique_central(
            col.Vehicle(mass=1000.0, vx=20.0, vy=1.0),
            col.Vehicle(mass=1000.0),
            1.0,
            normal=0.0,
            impulse_ratio=-0.9,
        )
    assert all(map(math.isnan, gains.ees(0.5)))
    assert col.linear_central(col.Vehicle(mass=1000.0, vx=20.0), col.Vehicle(mass=2000.0), 1.0).ees(
        0.5
    ) == (0.0, 0.0)
    with pytest.raises(col.InputError, match="share_a"):
        impact.ees(1.5)
    with pytest.raises(TypeError):
        impact.ees()


def test_moment_arms_and_gamma():
    """The moment of the impulse is what changes the yaw rate; gamma takes energy to delta-V as the
    CRASH programs do.
    """
    rng = np.random.default_rng(4)
    for friction in (0.0, 0.3, math.inf):
        a, b = (
            col.Vehicle(
                mass=rng.uniform(800, 3000),
                yaw_inertia=rng.uniform(800, 4000),
                x=x,
                y=rng.uniform(-1, 1),
                vx=vx,
                vy=rng.uniform(-5, 5),
            )
            for x, vx in ((-2.0, 20.0), (2.0, 0.0))
        )
        impact = col.eccentric(
            a, b, 0.2, normal=rng.uniform(-0.4, 0.4), point=(0.1, 0.3), friction=friction
        )
        for side in (impact.a, impact.b):
            before, impulse = side.before, math.hypot(side.impulse_x, side.impulse_y)
            # A difference of two products of a lever and an impulse: some eps of these.
            assert before.yaw_inertia * side.delta_yaw_rate == pytest.approx(
                side.moment_arm * impulse, abs=1e-13 * 3 * impulse
            )
            k = math.sqrt(before.yaw_inertia / before.mass)
            assert side.gamma == pytest.approx(k * k / (k * k + side.moment_arm**2), rel=1e-14)
            if friction == 0.0:
                assert side.normal_arm == pytest.approx(side.moment_arm, abs=1e-15)
                # The paper's eq 13 with r.
                assert side.delta_yaw_rate == pytest.approx(
                    side.normal_arm * impact.normal_impulse / before.yaw_inertia, rel=1e-13
                )
        assert impact.a.gamma < 1.0
        # The impulse does its work against both masses, each lessened by gamma: E = P^2 (1/(g1 m1)
        # + 1/(g2 m2)) / 2.
        if friction == 0.0:
            felt = [side.gamma * side.before.mass for side in (impact.a, impact.b)]
            absorbed = (
                (1.2 * impact.compression_impulse) ** 2 * sum(0.5 / mass for mass in felt) / 1.44
            )
            assert absorbed == pytest.approx(impact.energy_absorbed, rel=1e-13)
    wall = col.eccentric(a, col.Vehicle.barrier(), 0.2, normal=0.0, point=(0.1, 0.3), friction=0.0)
    assert wall.b.gamma is None
    assert wall.b.moment_arm is None
    stiff = col.eccentric(
        a.replace(yaw_inertia=math.inf),
        b.replace(mass=math.inf),
        0.2,
        normal=0.0,
        point=(0.1, 0.3),
        friction=0.0,
    )
    assert (stiff.a.gamma, stiff.b.gamma) == (1.0, 0.0)
    assert stiff.a.moment_arm != 0.0
    flat = SCENES[1]
    assert flat.a.moment_arm is flat.a.gamma is flat.a.normal_arm is flat.a.q.gamma is None
    many = col.eccentric(
        a.replace(vx=np.array([20.0, -9.0])),
        b,
        0.2,
        normal=0.0,
        point=(0.1, 0.3),
        friction=0.1,
        on_failure="nan",
    )
    assert np.isnan([many.a.gamma[1], many.a.moment_arm[1], many.a.normal_arm[1]]).all()
    assert np.isfinite([many.a.gamma[0], many.a.moment_arm[0], many.a.normal_arm[0]]).all()


def test_damage_to_delta_v_of_the_edcrash_tutorial():
    """Both delta-Vs by damage of its figures 5-15, 5-16 and 5-23, from damage energies, masses,
    inertias and impulse centres.

    EDCRASH counts headings clockwise and y to the right. A plastic contact that moves along the
    impulse alone is its model.
    """
    energy = 262905.65 + 140864.15

    def at(mass, inertia, heading, forward, right):
        """A car whose impulse centre lies at the origin."""
        car = col.Vehicle(
            mass=mass, yaw_inertia=inertia, x=0.0, y=0.0, heading=math.radians(heading)
        )
        x, y = car.point(forward=forward, left=-right)
        return car.replace(x=-x, y=-y)

    ford = at(1124.04, 1763.82, -195.0, 1.5209, -0.1649)
    nissan = at(1149.52, 2033.94, 90.0, -0.5848, 0.6765)
    # The force on the Ford comes from 30 degrees left of ahead, and the normal points where it
    # comes from.
    normal = math.radians(-195.0 + 30.0)
    contact = {"normal": normal, "point": (0.0, 0.0), "friction": 0.0}
    (found,) = col.reconstruct.speeds(
        ford,
        nissan,
        course_a=normal,
        course_b=None,
        speed_b=0.0,
        energy_loss=energy,
        restitution=0.0,
        **contact,
    )
    for side, pdof, arm, delta_v, forward, right in (
        (found.a, -30.0, 0.6176, 60.7, -52.6, 30.4),
        (found.b, 75.0, 0.7400, 59.4, -15.4, -57.4),
    ):
        assert math.degrees(side.pdof) == pytest.approx(pdof, abs=1e-9)
        # Half a unit of the last digit printed; a clockwise arm is positive there.
        assert abs(side.moment_arm) == pytest.approx(arm, abs=2e-4)
        assert 3.6 * side.delta_v == pytest.approx(delta_v, abs=0.05)
        assert 3.6 * side.delta_v_forward == pytest.approx(forward, abs=0.05)
        assert -3.6 * side.delta_v_left == pytest.approx(right, abs=0.05)
    gammas = {"gamma_a": found.a.gamma, "gamma_b": found.b.gamma}
    assert col.reconstruct.crush_delta_v(energy, 1124.04, 1149.52, **gammas) == pytest.approx(
        (found.a.delta_v, found.b.delta_v), rel=1e-12
    )
    # The energies divide as the damage says, and the EES with them.
    ees = found.ees(262905.65 / energy)
    assert ees == pytest.approx(
        (math.sqrt(2 * 262905.65 / 1124.04), math.sqrt(2 * 140864.15 / 1149.52)), rel=1e-12
    )


def test_linear_attributes():
    """The linear model has no tangent: ratios 0, frictionless, no law, no point."""
    impact = SCENES[0]
    assert impact.regime == "frictionless"
    assert impact.critical_impulse_ratio == impact.impulse_ratio == 0.0
    assert impact.law is impact.point is impact.choice is None
    assert impact.kind == "elastoplastic"
    assert SCENES[1].kind.tolist() == ["plastic", *["elastoplastic"] * 3, "elastic"]


def test_regimes():
    """Sticking, sliding, frictionless, given: as the contact went."""
    place = {"normal": 0.1, "point": (1.7, 0.3)}
    assert col.eccentric(A, B, 0.3, friction=0.0, **place).regime == "frictionless"
    assert col.eccentric(A, B, 0.3, friction=0.01, **place).regime == "sliding"
    assert col.eccentric(A, B, 0.3, friction=math.inf, **place).regime == "sticking"
    assert col.eccentric(A, B, 0.3, critical_fraction=1.0, **place).regime == "given"
    assert col.eccentric(A, B, 0.3, impulse_ratio=0.0, **place).friction is None
    many = col.eccentric(A, B, 0.3, friction=np.array([0.0, 0.01, math.inf]), **place)
    assert many.regime.tolist() == ["frictionless", "sliding", "sticking"]


ARM = {"mass": 1000.0, "yaw_inertia": 1333.0, "x": 0.0, "y": 1.0}
GATE = col.Vehicle(**ARM, pivot=(0.0, 0.0))
ONE_DEGREE = {
    "gate against a wall": (col.Vehicle.barrier(vx=5.0, x=-5.0, y=0.0), GATE),
    "two parallel arms": (col.Vehicle(**{**ARM, "y": 3.0}, yaw_rate=2.0, pivot=(0.0, 4.0)), GATE),
    "arms in batches": (
        col.Vehicle(**{**ARM, "y": 3.0}, yaw_rate=np.array([2.0, 3.0]), pivot=(0.0, 4.0)),
        GATE,
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("which", ONE_DEGREE)
@pytest.mark.parametrize(
    "rule",
    [{"friction": 0.0}, {"critical_fraction": 0.0}, {"impulse_ratio": 0.1}],
    ids=lambda rule: next(iter(rule)),
)
def test_one_degree_of_freedom_has_no_critical_ratio(which, rule):
    """K has rank 1 there, so that no impulse is the one without slip: NaN, in the record too, and
    said in words.
    """
    a, b = ONE_DEGREE[which]
    impact = col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 2.0), **rule)
    assert np.all(impact.ok)
    assert np.all(np.isnan(impact.critical_impulse_ratio))
    # The closing speed is that along x of the point 2 m from either pivot; all masses are reckoned
    # about their pivots.
    responses = [0.0 if body.pivot is None else 4.0 / (1333.0 + 1000.0) for body in (a, b)]
    closing = 5.0 if a.pivot is None else a.yaw_rate * 2.0
    assert impact.normal_impulse == pytest.approx(1.1 * closing / sum(responses), rel=1e-14)
    assert col.Impact.from_dict(json.loads(json.dumps(impact.to_dict(), allow_nan=False))) == impact
    if isinstance(impact.status, np.ndarray):
        return
    assert "not defined" in col.explain(impact)
    assert "impulse_ratio" not in col.diagnose(impact).measured
    assert replay(col.report(impact, form="markdown")) == impact


@pytest.mark.slow
def test_one_degree_of_freedom_backwards():
    """A critical fraction of 0 leads back as no friction does, for both laws."""
    a, b = ONE_DEGREE["two parallel arms"]
    contact = {"normal": 0.0, "point": (0.2, 2.0)}
    for law in ("brach", "kudlich-slibar"):
        end = col.eccentric(a, b, 0.3, friction=0.0, law=law, **contact)
        for known in (
            {"restitution": 0.3},
            {"closing_speed": end.closing_speed},
            {"energy_loss": end.energy_loss},
        ):
            start = col.reconstruct.planar(
                end.a.after, end.b.after, critical_fraction=0.0, law=law, **known, **contact
            )
            assert start.a.before.yaw_rate == pytest.approx(2.0, rel=1e-13)
            assert start.b.before.yaw_rate == pytest.approx(0.0, abs=1e-13)


def test_the_impulse_plane_says_what_is_not_defined():
    """Off the square, where the slip of a gate against a wall changes with the impulse; no no-slip
    impulse is drawn.
    """
    impact = col.eccentric(
        *ONE_DEGREE["gate against a wall"], 0.1, normal=0.0, point=(0.3, 2.0), friction=0.0
    )
    axes = col.plot.impulse_plane(impact)
    assert "the no-slip impulse is not defined" in axes.get_title()
    assert "no-slip impulse" not in {line.get_gid() for line in axes.get_lines()}


@pytest.mark.slow
def test_answers_of_batches_compare_by_value():
    """Equal to one that was solved again and to its pickle, and not to one with another number in
    one case.
    """
    vx = np.array([20.0, 21.0])

    def found(vx):
        by_central = col.reconstruct.central(1500.0, 1200.0, va=vx, vb=0.0, vb_after=13.0)
        bodies = (A.replace(vx=vx), B)
        return {
            "Impact": by_central,
            "Reconstruction": by_central.reconstruction,
            "LeftOut": col.left_out(by_central),
            "RunOut": col.travel.path([(0.0, 0.0), (vx, 1.0)], [0.0, 0.1], friction=0.7, lock=0.5),
            "ModelChoice": col.required_model(
                *bodies, 0.1, normal=0.1, point=(1.7, 0.3), friction=0.1, tolerance=vx / 10.0
            ),
            "MomentumSolution": col.reconstruct.momentum(
                1000.0,
                1100.0,
                course_a=0.0,
                course_b=1.0,
                course_a_after=0.1,
                course_b_after=0.9,
                speed_a=vx,
                speed_b=12.0,
            ),
        }

    for (name, one), same, other in zip(
        found(vx).items(),
        found(vx).values(),
        found(vx + np.array([0.0, 1.0])).values(),
        strict=True,
    ):
        assert type(one).__name__ == name
        assert one == same == pickle.loads(pickle.dumps(one))
        assert one != other
        assert one != vx.tolist()


def test_exact_zeros():
    """Slip after sticking, loss of an elastic impact, delta-V of a barrier: exact, not rounded."""
    place = {"normal": 0.1, "point": (1.7, 0.3)}
    for rule in ({"friction": math.inf}, {"critical_fraction": 1.0}):
        assert col.eccentric(A, B, 0.3, **rule, **place).slip_after == 0.0
        returned = col.eccentric(A, B, 0.3, law="kudlich-slibar", **rule, **place)
        assert returned.slip_after == -0.3 * returned.slip_before
    assert col.eccentric(A, B, 1.0, friction=0.0, **place).energy_loss == 0.0
    assert (
        col.eccentric(A, B, 1.0, friction=math.inf, law="kudlich-slibar", **place).energy_loss
        == 0.0
    )
    wall = col.eccentric(A, col.Vehicle.barrier(vx=-2.0), 0.3, friction=0.4, **place)
    assert wall.b.delta_v == wall.b.delta_yaw_rate == 0.0
    assert wall.common_velocity == pytest.approx(-2.0 * math.cos(0.1), rel=1e-15)


@pytest.mark.parametrize("impact", SCENES, ids=[f"{i}-{s.model}" for i, s in enumerate(SCENES)])
def test_one_case_of_a_batch_is_that_case_alone(impact):
    """Every case of a batch; to 1e-13 of its scale, as the arithmetic of one case and of many may
    round differently.
    """
    if not isinstance(impact.status, np.ndarray):
        with pytest.raises(col.ShapeError, match="is one case") as caught:
            impact.case(0)
        assert caught.value.code == "bad_shape"
        return
    for place in np.ndindex(impact.status.shape):
        one = impact.case(place if len(place) > 1 else place[0])
        assert isinstance(one.normal_impulse, float)
        assert one.model == impact.model
        for name in (
            "closing_speed",
            "slip_before",
            "normal_impulse",
            "tangential_impulse",
            "energy_loss",
        ):
            many = getattr(impact, name)
            assert getattr(one, name) == pytest.approx(
                many[place], rel=1e-13, abs=1e-13 * float(abs(many).max())
            )
        assert one == col.Impact.from_dict(one.to_dict())


def test_a_case_of_solve_is_answered_by_its_own_model():
    """Also where the choice was made for other inputs and is taken again."""
    a, b = A.replace(vx=np.array([20.0, 9.0]), x=-1.0), B.replace(x=2.0)
    contact = {"normal": 0.1, "point": (1.0, 0.3), "friction": 0.2}
    choice = col.required_model(a, b, 0.1, tolerance=np.array([99.0, 0.0]), **contact)
    inputs = col.solve(a, b, 0.1, tolerance=99.0, **contact).inputs
    many = solved(dataclasses.replace(inputs, a=a.replace(vy=5.0)), choice=choice)
    assert list(many.model) == ["linear_central", "eccentric"]
    for place in (0, 1, -1):
        one = many.case(place)
        assert one.model == many.model[place]
        assert one.a.delta_v == pytest.approx(many.a.delta_v[place], rel=1e-13)


@pytest.mark.parametrize("at", [0, 1])
def test_a_case_of_solve_gives_the_reason_of_its_own_choice(at):
    """Not that of the batch, which counts its cases: so a record of the case and a report of it say
    the same again.
    """
    a = A.replace(vx=np.array([20.0, 20.0]), x=-2.0, y=0.0, yaw_inertia=2000.0)
    b = B.replace(vx=0.0, vy=0.0, x=2.0, y=0.0, yaw_inertia=1700.0)
    contact = {
        "normal": 0.0,
        "point": (0.0, np.array([0.0, 0.5])),
        "friction": 0.3,
        "tolerance": 0.1,
    }
    many = col.solve(a, b, 0.2, **contact)
    one, alone = (
        many.case(at),
        col.solve(a.replace(vx=20.0), b, 0.2, **{**contact, "point": (0.0, (0.0, 0.5)[at])}),
    )
    assert "cases" in many.choice.reason
    assert one.choice.reason == alone.choice.reason
    assert one.choice.reason.startswith(one.model)
    assert col.Impact.from_dict(one.to_dict()).choice == one.choice
    assert replay(col.report(one, form="markdown")) == one


def test_a_case_that_was_refused_says_why():
    """The error that the solver raises of it alone, also for what only a batch may hold."""
    a = col.Vehicle(mass=np.array([1500.0, 1500.0, -1.0]), vx=np.array([9.0, -9.0, 9.0]))
    many = col.linear_central(a, col.Vehicle(mass=1200.0), 0.1, on_failure="nan")
    with pytest.raises(col.NoImpactError) as caught:
        many.case(1)
    assert caught.value.closing_speed == -9.0
    with pytest.raises(col.InputError, match=r"^a: mass must be > 0") as wrong:
        many.case(2)
    assert wrong.value.fields["argument"] == "mass"


@pytest.mark.parametrize(
    ("wrong", "code"),
    [
        ({"mass": math.nan}, "not_finite"),
        ({"mass": -5.0}, "not_positive"),
        ({"vx": math.nan}, "not_finite"),
        ({"x": math.inf}, "not_finite"),
        ({"pivot": (math.nan, 0.0)}, "not_finite"),
    ],
    ids=str,
)
def test_of_two_faults_a_batch_and_its_case_name_the_same(wrong, code):
    """What is wrong with a vehicle comes before a restitution below 0, as a vehicle is made before
    it meets another.
    """
    columns = {
        name: tuple(map(np.array, ([part] for part in value)))
        if name == "pivot"
        else np.array([value])
        for name, value in wrong.items()
    }
    a = A.replace(name="Golf", **({"vx": 0.0, "vy": 0.0} if "pivot" in wrong else {}), **columns)
    many = col.eccentric(
        a, B, np.array([-0.1]), normal=0.1, point=(1.7, 0.3), friction=0.2, on_failure="nan"
    )
    assert col.Status(many.status[0]).label == code
    with pytest.raises(col.InputError, match=r"^a \(Golf\): ") as caught:
        many.case(0)
    assert caught.value.code == code


def test_a_case_of_a_reverse_solver_keeps_how_it_was_found():
    """With its own condition; a refused one names the solver that says more."""
    ends = np.array([0.1, 0.0])
    place = {"normal": 0.1, "point": (1.7, 0.3)}
    impact = col.eccentric(A, B, ends, friction=0.05, **place)
    found = col.reconstruct.planar(
        impact.a.after, impact.b.after, restitution=ends, friction=0.05, on_failure="nan", **place
    )
    one = found.case(0)
    assert one.reconstruction.method == "planar"
    assert one.reconstruction.condition == found.reconstruction.condition[0]
    assert one.a.before.vx == pytest.approx(20.0, rel=1e-12)
    with pytest.raises(
        col.NoSolutionError, match=r"case 1 has no answer.*reconstruct\.planar"
    ) as caught:
        found.case(1)
    assert caught.value.code == col.Status(found.status[1]).label


@pytest.mark.parametrize("index", [5, -6, 1.0, True, (0, 0), None, "0", (), np.array([0])], ids=str)
def test_an_index_that_is_no_case_is_refused(index):
    """Named, with what to write."""
    with pytest.raises(col.InputError, match=r"got .*write impact\.case\(0\)") as caught:
        SCENES[1].case(index)
    assert (caught.value.code, caught.value.fields["argument"]) == ("bad_index", "index")


@pytest.mark.parametrize(
    "heading",
    ["90 deg", "-90 deg", math.pi / 2, -math.pi / 2, np.array([math.pi / 2, -math.pi / 2])],
)
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_struck_from_behind_is_pi_and_not_minus_pi(heading, kind):
    """Of a car that is hit straight from behind the last bit of its heading does not decide the
    sign: PDOF is in (-pi, pi].
    """
    heading = heading.astype(kind) if isinstance(heading, np.ndarray) else heading
    body = {"mass": 1500.0, "heading": heading}
    for way in (1.0, -1.0):
        a, b = col.Vehicle(vy=10.0 * way, **body), col.Vehicle(**body)
        impact = col.oblique_central(a, b, 0.1, normal=(0.0, way), friction=0.0)
        for side in (impact.a, impact.b):
            turned = np.asarray(side.pdof)
            ahead = abs(turned) < 1.0
            np.testing.assert_allclose(
                turned[~ahead], np.full(np.count_nonzero(~ahead), math.pi), rtol=1e-6
            )
            assert (turned > -3.0).all()


def test_only_what_moves_across_is_named():
    """By the linear model, which cannot hold it."""
    with pytest.raises(col.InputError, match="a moves at 3 m/s across it; use") as caught:
        col.linear_central(col.Vehicle(mass=1500, vx=10, vy=3), col.Vehicle(mass=1500), 0.1)
    assert "b moves" not in str(caught.value)


def test_inputs_are_what_was_asked():
    """The inputs in SI numbers and the texts it was given as, frozen, and equal whatever the texts
    were.
    """
    a, b = A.replace(x=-1.0), B.replace(x=2.0)
    contact = {"normal": "10 deg", "point": (1.0, "30 cm"), "friction": 0.2}
    impact = col.eccentric(a, b, "10 %", **contact)
    inputs = impact.inputs
    assert is_dataclass(inputs)
    assert (inputs.model, inputs.a, inputs.b, inputs.restitution) == ("eccentric", a, b, 0.1)
    assert (inputs.rule, inputs.rule_value, inputs.law, inputs.point) == (
        "friction",
        0.2,
        "brach",
        (1.0, 0.3),
    )
    assert inputs.normal == impact.normal
    assert inputs.given == {"restitution": "10 %", "normal": "10 deg", "point[1]": "30 cm"}
    with pytest.raises(FrozenInstanceError):
        inputs.restitution = 0.2
    same_numbers = col.eccentric(
        a, b, 0.1, normal=impact.normal, point=(1.0, 0.3), friction=0.2
    ).inputs
    assert same_numbers == inputs
    assert same_numbers != dataclasses.replace(inputs, restitution=0.2)
    assert pickle.loads(pickle.dumps(inputs)) == inputs
    with pytest.raises(TypeError):
        hash(inputs)


def test_inputs_of_the_other_solvers():
    """The linear model has no law and no point, ``solve`` the tolerance that it was given."""
    a, b = col.Vehicle(mass=1500.0, vx=10.0, x=-2.0, y=0.0), col.Vehicle(mass=1200.0, x=2.0, y=0.0)
    linear = col.linear_central(a, b, 0.2).inputs
    assert (linear.model, linear.law, linear.point, linear.tolerance) == (
        "linear_central",
        None,
        None,
        None,
    )
    least = col.solve(
        a, b, 0.2, normal=0.0, point=(0.0, 0.0), friction=0.5, tolerance="0.36 km/h"
    ).inputs
    assert (least.model, least.tolerance, least.given) == ("solve", 0.1, None)


CRASH = {"normal": "10 deg", "point": ("1 in", 0.4), "friction": 0.5}


def crash_bodies():
    return (
        col.Vehicle(mass="1500 kg", vx=10.0, yaw_inertia=2400.0, x=-2.0, y=0.4),
        col.Vehicle(mass=1200.0, yaw_inertia=1700.0, x=2.0, y=0.0),
    )


@pytest.mark.parametrize(
    "changes",
    [
        {}, {"restitution": "10 %"}, {"friction": 0.1}, {"impulse_ratio": 0.1},
            {"law": "kudlich-slibar"}, {"normal": "0 deg"},
        {"point": (0.0, "0.2 m")},
            {"a": col.Vehicle(mass=900, vx=20.0, yaw_inertia=1500.0, x=-2.0, y=0.1)},
        {"restitution": np.array([0.0, 0.1])},
    ],
)  # fmt: skip
@pytest.mark.parametrize("solver", ["oblique_central", "eccentric", "solve"])
def test_an_impact_again_is_what_its_solver_gives(solver, changes):
    """With the same arguments and the changed ones; a new tangential rule takes the place of the
    old; texts stay or go with them.
    """
    a, b = crash_bodies()
    contact = {
        name: CRASH[name] for name in CRASH if solver != "oblique_central" or name != "point"
    }
    if solver == "oblique_central" and "point" in changes:
        pytest.skip("has no point")
    arguments = {
        "a": a,
        "b": b,
        "restitution": 0.2,
        **contact,
        **({"tolerance": 0.5} if solver == "solve" else {}),
    }
    impact = getattr(col, solver)(**arguments)
    rule = {
        name: value
        for name, value in arguments.items()
        if name != "friction" or "impulse_ratio" not in changes
    }
    expected = getattr(col, solver)(**(rule | changes))
    again = impact.again(**changes)
    assert again == expected
    assert (again.inputs.given or {}) == (expected.inputs.given or {})
    assert json.dumps(again.to_dict()) == json.dumps(expected.to_dict())


def test_an_impact_again_takes_what_its_solver_takes():
    """An argument of another solver is a TypeError, a bad value the solver's own refusal."""
    impact = col.linear_central(col.Vehicle(mass=1100.0, vx=20.0), col.Vehicle(mass=950.0), 0.4)
    with pytest.raises(
        TypeError,
        match="takes the arguments of linear_central: a, b, incomplete, normal, restitution; got "
        "'friction'",
    ):
        impact.again(friction=0.1)
    with pytest.raises(col.InputError, match="restitution must be from 0 to 1"):
        impact.again(restitution=3.0)
    with pytest.raises(col.NoImpactError):
        impact.again(normal="180 deg")
    other = col.eccentric(*crash_bodies(), 0.2, **CRASH)
    with pytest.raises(col.InputError, match="friction and impulse_ratio, not both"):
        other.again(friction=0.1, impulse_ratio=0.1)
    with pytest.raises(col.InputError, match="give exactly one of"):
        other.again(friction=None)
    with pytest.raises(col.MissingInputError, match="point"):
        other.again(point=None)


def test_what_a_reverse_solver_found_is_solved_forward_again():
    """From the motions that it found."""
    found = reconstruct.central(1500.0, 1200.0, va=20.0, vb=0.0, vb_after=13.0)
    again = found.again(restitution=0.0)
    assert again.reconstruction is None
    # 1500 kg of 20 m/s among 2700 kg.
    assert again.b.after.vx == pytest.approx(20.0 * 1500.0 / 2700.0, rel=1e-14)
