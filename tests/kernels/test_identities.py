"""The equations of "Application of Impulse Momentum Theory to Vehicle Collisions", each as an
identity on the results.

The central ones hold to the promises of section 5 of the numerics note: 4 eps relative for delta-V
and impulses, 5 eps (|v| + |dv|) for velocities, 6 eps for the loss. The eccentric ones to the
promises of v' and w', times the masses and levers they meet.
"""

from __future__ import annotations

import math
import random
from fractions import Fraction
from functools import cache
from typing import Any

import pytest

import collisions as col
from reference import EPS, Answer, Body, Scene
from scenes import cases, solved


@cache
def central() -> tuple[col.Impact, ...]:
    """Linear central impacts of two cars in ordinary traffic, against a wall too, over the whole
    range of restitution.
    """
    rng = random.Random("identities")
    found = []
    for i in range(200):
        va, vb = sorted((rng.uniform(-40.0, 40.0), rng.uniform(-40.0, 40.0)), reverse=True)
        e = (0.0, 1.0, rng.random(), 0.3 * rng.random())[i % 4]
        a = Body(rng.uniform(700.0, 3000.0), math.inf, vx=va)
        b = Body(rng.uniform(700.0, 40000.0), math.inf, vx=vb)
        found.append(
            solved(
                "linear_central", Scene(a, b, e, (1.0, 0.0), (0.0, 0.0), "friction", 0.0, "brach")
            )
        )
    return tuple(found)


def given(impact: col.Impact) -> tuple[Fraction, Fraction, Fraction, Fraction, Fraction]:
    """m1, m2, v1, v2 and e of a central impact as exact fractions."""
    a, b = impact.a.before, impact.b.before
    return (
        Fraction(a.mass),
        Fraction(b.mass),
        Fraction(a.vx),
        Fraction(b.vx),
        Fraction(impact.restitution),
    )


def near(found: float, wanted: Fraction, allowed: float) -> bool:
    """Whether a float is within an error of an exact number."""
    return abs(float(Fraction(found) - wanted)) <= allowed


def test_eqs_1_and_2_impulses_are_opposite_and_momentum_stays() -> None:
    """m1 v1 + m2 v2 = m1 v1' + m2 v2', and what one body is given the other loses (1 eps of sum m
    (|v| + |v'|)).
    """
    for impact in central():
        m1, m2, v1, v2, _ = given(impact)
        u1, u2 = Fraction(impact.a.after.vx), Fraction(impact.b.after.vx)
        assert abs(m1 * (u1 - v1) + m2 * (u2 - v2)) <= Fraction(EPS) * (
            m1 * (abs(v1) + abs(u1)) + m2 * (abs(v2) + abs(u2))
        )
        assert impact.a.impulse_x == -impact.b.impulse_x


def test_eqs_3_and_4_common_velocity() -> None:
    """v_c = (m1 v1 + m2 v2) / (m1 + m2) of the velocities before, and of those after, and is both
    vehicles' at compression.
    """
    for impact in central():
        m1, m2, v1, v2, _ = given(impact)
        scale = max(abs(side.before.vx) + side.delta_v for side in (impact.a, impact.b))
        # 5 eps (|v| + |dv|), the promise of a velocity.
        assert near(impact.common_velocity, (m1 * v1 + m2 * v2) / (m1 + m2), 5 * EPS * scale)
        after = (m1 * Fraction(impact.a.after.vx) + m2 * Fraction(impact.b.after.vx)) / (m1 + m2)
        assert near(impact.common_velocity, after, 5 * EPS * (scale + scale))
        for side in (impact.a, impact.b):
            assert near(side.at_compression.vx, (m1 * v1 + m2 * v2) / (m1 + m2), 5 * EPS * scale)


def test_eqs_3_and_4_impulses_of_both_periods() -> None:
    """m2 (v_c - v2) is the compression impulse, m2 (v2' - v_c) the restitution impulse, and their
    ratio A2/A1 is e.
    """
    for impact in central():
        m1, m2, v1, v2, e = given(impact)
        common = (m1 * v1 + m2 * v2) / (m1 + m2)
        compression = m2 * (common - v2)
        assert near(impact.compression_impulse, compression, 4 * EPS * float(compression))
        assert near(impact.restitution_impulse, e * compression, 4 * EPS * float(e * compression))
        assert near(
            impact.normal_impulse, (1 + e) * compression, 4 * EPS * float((1 + e) * compression)
        )
        assert impact.restitution_impulse == impact.restitution * impact.compression_impulse


def test_newtons_hypothesis() -> None:
    """v1' - v_c = e (v_c - v1), and likewise for the other body."""
    for impact in central():
        e = impact.restitution
        for side in (impact.a, impact.b):
            before, middle, after = side.before.vx, side.at_compression.vx, side.after.vx
            # Two velocities to 5 eps (|v| + |dv|) each on the left; e <= 1 times one of them on the
            # right.
            assert abs((after - middle) - e * (middle - before)) <= 15 * EPS * (
                abs(before) + side.delta_v
            )


def test_eqs_5_and_6_velocities_after() -> None:
    """v1' = v1 + m2/(m1+m2) (1+e)(v2-v1), v2' = v2 + m1/(m1+m2) (1+e)(v1-v2); delta-V to 4 eps of
    itself.
    """
    for impact in central():
        m1, m2, v1, v2, e = given(impact)
        for side, wanted, v in (
            (impact.a, m2 / (m1 + m2) * (1 + e) * (v2 - v1), v1),
            (impact.b, m1 / (m1 + m2) * (1 + e) * (v1 - v2), v2),
        ):
            assert near(side.delta_vx, wanted, 4 * EPS * abs(float(wanted)))
            assert near(side.after.vx, v + wanted, 5 * EPS * (abs(float(v)) + abs(float(wanted))))


def test_eq_7_equals_eq_8() -> None:
    """The loss is (1-e^2)/2 m1 m2/(m1+m2) (v2-v1)^2 to 6 eps, and the difference of kinetic
    energies in exact arithmetic.
    """
    for impact in central():
        m1, m2, v1, v2, e = given(impact)
        eq8 = (1 - e * e) / 2 * m1 * m2 / (m1 + m2) * (v2 - v1) ** 2
        u1 = v1 + m2 / (m1 + m2) * (1 + e) * (v2 - v1)
        u2 = v2 + m1 / (m1 + m2) * (1 + e) * (v1 - v2)
        assert (m1 * v1**2 + m2 * v2**2 - m1 * u1**2 - m2 * u2**2) / 2 == eq8
        assert near(impact.energy_loss, eq8, 6 * EPS * float(eq8))
        assert impact.energy_loss_normal == impact.energy_loss
        assert impact.energy_loss_tangential == 0.0
        # Eq 7 from the velocities returned: each energy carries twice the relative error of its
        # velocity, and its own rounding.
        energies = [
            (side.before.kinetic_energy, side.after.kinetic_energy, side)
            for side in (impact.a, impact.b)
        ]
        eq7 = sum(before - after for before, after, _ in energies)
        allowed = sum(
            10 * EPS * side.before.mass * abs(side.after.vx) * (abs(side.before.vx) + side.delta_v)
            + 4 * EPS * (before + after)
            for before, after, side in energies
        )
        assert abs(eq7 - impact.energy_loss) <= allowed


def test_kinds_of_impact() -> None:
    """e = 1 is elastic and loses nothing, e = 0 plastic and loses most, anything between
    elastoplastic.
    """
    kinds = set()
    for impact in central():
        kinds.add(impact.kind)
        e = impact.restitution
        assert impact.kind == (
            "elastic" if e == 1.0 else "plastic" if e == 0.0 else "elastoplastic"
        )
        # What is absorbed at the end of compression is what a plastic impact would lose; (1 - e^2)
        # of it is lost.
        wanted = (1.0 - e) * (1.0 + e) * impact.energy_absorbed
        assert impact.energy_loss == pytest.approx(
            wanted, rel=10 * EPS, abs=0
        )  # two losses of 6 eps at most, less what they share
        if e == 1.0:
            assert impact.energy_loss == 0.0
    assert kinds == {"elastic", "plastic", "elastoplastic"}


@pytest.mark.parametrize("e", [0.0, 0.25, 0.4, 1.0])
@pytest.mark.parametrize("model", ["linear_central", "oblique_central", "eccentric"])
def test_example_1_a_fixed_body(model: str, e: float) -> None:
    """Against a fixed body v' = -e v, in every model; v and e are chosen so that nothing rounds
    beyond 5 eps (|v| + |dv|).
    """
    a, wall = Body(1000.0, 1500.0, vx=13.0, x=-2.0), Body(math.inf, math.inf)
    impact = solved(model, Scene(a, wall, e, (1.0, 0.0), (0.0, 0.0), "friction", 0.0, "brach"))
    assert abs(impact.a.after.vx + e * 13.0) <= 5 * EPS * (13.0 + impact.a.delta_v)
    assert impact.a.after.vy == impact.a.after.yaw_rate == 0.0
    assert impact.b.delta_v == 0.0
    assert impact.common_velocity == 0.0


def test_eq_9_oblique_central_impact() -> None:
    """Without friction normal components obey e = -(v'n2 - v'n1)/(vn2 - vn1) and tangential ones
    stay as they are.
    """
    rng = random.Random("eq 9")
    for _ in range(200):
        angle = rng.uniform(-3.0, 3.0)
        a = Body(
            rng.uniform(700.0, 3000.0), math.inf, vx=rng.uniform(-30, 30), vy=rng.uniform(-30, 30)
        )
        b = Body(
            rng.uniform(700.0, 3000.0), math.inf, vx=rng.uniform(-30, 30), vy=rng.uniform(-30, 30)
        )
        closing = (a.vx - b.vx) * math.cos(angle) + (a.vy - b.vy) * math.sin(angle)
        scene = Scene(
            a,
            b,
            rng.random(),
            angle if closing > 0 else angle + math.pi,
            (0.0, 0.0),
            "friction",
            0.0,
            "brach",
        )
        impact = solved("oblique_central", scene)
        (nx, ny), e = impact.normal, impact.restitution
        velocities = [
            (nx * v.vx + ny * v.vy, nx * v.vy - ny * v.vx)
            for v in (impact.a.before, impact.b.before, impact.a.after, impact.b.after)
        ]
        (n1, t1), (n2, t2), (m1, s1), (m2, s2) = velocities
        # The promise of v' (kappa is 1): 8 eps (|v| + a S_P), a S_P <= (1+e) S_U; components add
        # 1.5 eps of each velocity.
        s_u = math.hypot(b.vx - a.vx, b.vy - a.vy)
        of = [10 * EPS * (side.before.speed + (1 + e) * s_u) for side in (impact.a, impact.b)]
        assert abs((m2 - m1) + e * (n2 - n1)) <= sum(of)
        assert abs(s1 - t1) <= of[0]
        assert abs(s2 - t2) <= of[1]


# --- Eccentric impact: no friction, as in section 2.3 ---------------------------------------------


@cache
def eccentric() -> tuple[tuple[Scene, Answer, col.Impact], ...]:
    """Frictionless eccentric impacts in traffic, on map coordinates and against a body that is
    fixed or cannot turn.
    """
    found = []
    for family in ("traffic", "map grid", "barrier"):
        for scene, answer in cases(family, "brach", "friction", 100):
            if scene.value == 0.0:
                found.append((scene, answer, solved("eccentric", scene)))
    return tuple(found)


def along(impact: col.Impact, vehicle: col.Vehicle) -> float:
    """Component of the velocity of the centre of mass along the line of impact nn."""
    return impact.normal[0] * vehicle.vx + impact.normal[1] * vehicle.vy


def bodies(scene: Scene, answer: Answer, impact: col.Impact) -> Any:
    """Each finite body: the vehicle's side, the sign and distance r of the line of impact, and the
    errors of v and w.
    """
    for name, sign in (("a", -1.0), ("b", 1.0)):
        side, half, body = getattr(impact, name), getattr(answer, name), getattr(scene, name)
        if math.isinf(body.mass) or math.isinf(body.inertia):
            continue
        lever_x, lever_y = scene.point[0] - body.x, scene.point[1] - body.y
        nx, ny = impact.normal
        # The moment of a unit impulse along n: -(n turned by +90 degrees).r
        r = lever_x * ny - lever_y * nx
        # The promises of v' and w', and 2 eps more of v for its component along n, of r for working
        # it out.
        of_v = 10 * EPS * float(half.speed + half.a * answer.spread)
        of_w = 8 * EPS * float(abs(body.spin) + half.b * half.r * answer.spread)
        yield side, sign, r, float(half.r), of_v, of_w


@pytest.mark.slow
def test_eq_10_ratio_of_the_impulses() -> None:
    """e is the restitution impulse over the compression impulse, and both make the whole."""
    assert len(eccentric()) > 50
    for scene, answer, impact in eccentric():
        assert impact.restitution_impulse == scene.restitution * impact.compression_impulse
        whole = impact.compression_impulse + impact.restitution_impulse
        assert abs(whole - impact.normal_impulse) <= 3 * 8 * EPS * float(
            answer.spread
        )  # the promises of P, Pc and Pr


def test_eq_11_relative_velocity_of_the_points_of_contact() -> None:
    """(v'B)n - (v'A)n = e [(vA)n - (vB)n] at the contact, to the promises of v' and w' |r|."""
    for scene, answer, impact in eccentric():
        (ax, ay), (bx, by) = (side.after.velocity_at(scene.point) for side in (impact.a, impact.b))
        nx, ny = impact.normal
        allowed = 4 * EPS * float(answer.s_u)
        for name in "ab":
            half, body = getattr(answer, name), getattr(scene, name)
            allowed += (
                12
                * EPS
                * float(half.speed + half.r * abs(body.spin) + half.mobility * answer.spread)
            )
        assert (
            abs(nx * (bx - ax) + ny * (by - ay) - scene.restitution * impact.closing_speed)
            <= allowed
        )


def test_eqs_12_and_14_momentum_along_the_line_of_impact() -> None:
    """m vn - P = m un in the period of compression and m un - R = m v'n in that of restitution
    (with + for body B).
    """
    for scene, answer, impact in eccentric():
        pc, pr = impact.compression_impulse, impact.restitution_impulse
        for side, sign, _, _, of_v, _ in bodies(scene, answer, impact):
            m = side.before.mass
            v, u, w = (
                along(impact, vehicle) for vehicle in (side.before, side.at_compression, side.after)
            )
            # Two velocities, and P to its promise.
            allowed = 2 * m * of_v + 8 * EPS * float(answer.spread)
            assert abs(m * v + sign * pc - m * u) <= allowed
            assert abs(m * u + sign * pr - m * w) <= allowed


def test_eqs_13_and_15_moments_about_the_centre_of_mass() -> None:
    """I w - r P = I w0 in the period of compression and I w0 - r R = I w' in that of
    restitution.
    """
    for scene, answer, impact in eccentric():
        pc, pr = impact.compression_impulse, impact.restitution_impulse
        for side, sign, r, length, _, of_w in bodies(scene, answer, impact):
            inertia = side.before.yaw_inertia
            spins = side.before.yaw_rate, side.at_compression.yaw_rate, side.after.yaw_rate
            # Two yaw rates; P to its promise on the lever, and the lever, worked out here, to 2 eps
            # of |r|.
            allowed = 2 * inertia * of_w + (8 + 2) * EPS * length * float(answer.spread)
            assert abs(inertia * spins[0] + sign * r * pc - inertia * spins[1]) <= allowed
            assert abs(inertia * spins[1] + sign * r * pr - inertia * spins[2]) <= allowed


def test_eq_16_restitution_from_velocities_and_from_yaw_rates() -> None:
    """e (vn - un) = un - v'n, and e (w - w0) = w0 - w', for each body."""
    for scene, answer, impact in eccentric():
        e = scene.restitution
        for side, _, _, _, of_v, of_w in bodies(scene, answer, impact):
            v, u, w = (
                along(impact, vehicle) for vehicle in (side.before, side.at_compression, side.after)
            )
            assert abs(e * (v - u) - (u - w)) <= 3 * of_v
            w0, w1, w2 = side.before.yaw_rate, side.at_compression.yaw_rate, side.after.yaw_rate
            assert abs(e * (w0 - w1) - (w1 - w2)) <= 3 * of_w


def test_eq_18_restitution_from_both_together() -> None:
    """e [(vn + r w) - (un + r w0)] = (un + r w0) - (v'n + r w'), the sum that eq 17 allows."""
    for scene, answer, impact in eccentric():
        for side, _, r, length, of_v, of_w in bodies(scene, answer, impact):
            at = [
                along(impact, vehicle) + r * vehicle.yaw_rate
                for vehicle in (side.before, side.at_compression, side.after)
            ]
            # Three states; 3 eps of r w for the lever and the sum are within the promise of w'
            # times |r| taken once more.
            allowed = 3 * of_v + 2 * 3 * length * of_w
            assert abs(scene.restitution * (at[0] - at[1]) - (at[1] - at[2])) <= allowed


def test_eq_19_restitution_from_the_points_of_contact() -> None:
    """e [(vA)n - (uA)n] = (uA)n - (v'A)n at the contact of each body, and (uA)n = (uB)n = v_c at
    the end of compression.
    """
    for scene, answer, impact in eccentric():
        nx, ny = impact.normal
        shared = []
        for name in "ab":
            side, half, body = getattr(impact, name), getattr(answer, name), getattr(scene, name)
            if (
                math.isinf(body.mass)
                and math.isinf(body.inertia)
                and (body.vx or body.vy or body.spin)
            ):
                continue
            contact = [
                vehicle.velocity_at(scene.point)
                for vehicle in (side.before, side.at_compression, side.after)
            ]
            v, u, w = (nx * x + ny * y for x, y in contact)
            one = (
                12
                * EPS
                * float(half.speed + half.r * abs(body.spin) + half.mobility * answer.spread)
            )
            assert abs(scene.restitution * (v - u) - (u - w)) <= 3 * one
            assert abs(u - float(answer.common_velocity)) <= one + 4 * EPS * float(answer.s_u)
            shared.append((u, one))
            assert abs(impact.common_velocity - float(answer.common_velocity)) <= _of_common(
                scene, answer
            )
        if len(shared) == 2:
            assert abs(shared[0][0] - shared[1][0]) <= shared[0][1] + shared[1][
                1
            ] + 4 * EPS * float(answer.s_u)


def _of_common(scene: Scene, answer: Answer) -> float:
    """Error of v_c: that of the contact velocity of the body it is built on, whichever that is."""
    return max(
        12 * EPS * float(half.speed + half.r * abs(body.spin) + half.mobility * answer.spread)
        for half, body in ((answer.a, scene.a), (answer.b, scene.b))
    )


def test_example_3_by_its_own_equations() -> None:
    """Eqs 20 and 21 in exact arithmetic: w'B = 405/74 rad/s, v'A = 950/111 m/s; the numerics note
    allows 1e-14.
    """
    a = col.Vehicle(mass=900, vx="60 km/h", yaw_inertia=math.inf, x=-1.0, y=4.0)
    b = col.Vehicle(mass=1000, yaw_inertia=1000 * 4**2 / 12, x=0.0, y=2.0, pivot=(0.0, 0.0))
    impact = col.eccentric(a, b, 0.80, normal=0.0, point=(0.0, 4.0), friction=0.0)
    # The paper counts the turn the other way: struck above O to the right, B turns clockwise.
    assert -impact.b.after.yaw_rate == pytest.approx(405 / 74, rel=1e-14)
    assert impact.a.after.vx == pytest.approx(950 / 111, rel=1e-14)
    moment = 900 * impact.a.after.vx * 4 + (1000 * 2 * 2 + 4000 / 3) * -impact.b.after.yaw_rate
    assert moment == pytest.approx(60000, rel=1e-14)
    assert 4 * -impact.b.after.yaw_rate - impact.a.after.vx == pytest.approx(
        0.8 * 60 / 3.6, rel=1e-14
    )
    # As printed, truncated in the last digit: 5.47 rad/s and 8.55 m/s.
    assert -impact.b.after.yaw_rate == pytest.approx(5.47, abs=1e-2)
    assert impact.a.after.vx == pytest.approx(8.55, abs=1e-2)


def test_example_2_by_its_own_numbers() -> None:
    """With the restitution it finds, e = 35/88, example 2 ends at 60 and 310/11 km/h to 5 eps (|v|
    + |dv|), and as printed.
    """
    impact = col.linear_central(
        col.Vehicle(mass=1100.0, vx="80 km/h"), col.Vehicle(mass=950.0), 35 / 88
    )
    assert impact.b.after.vx == pytest.approx(60 / 3.6, rel=1e-14)
    assert impact.a.after.vx == pytest.approx(310 / 11 / 3.6, rel=1e-14)
    assert impact.a.after.vx == pytest.approx(7.82, abs=1e-2)
    assert impact.restitution == pytest.approx(0.40, abs=1e-2)
