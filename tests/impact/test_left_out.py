"""What the impulse idealisation leaves out: by hand, against a contact that takes time, and every
refusal.
"""

import itertools
import json
import math
import pickle
import re
import sys
import tracemalloc
import warnings
from pathlib import Path

import numpy as np
import pint
import pytest

import collisions as col
from collisions.impact.impact import solve_changed
from collisions.impact.left_out import LeftOut, LeftOutVehicle, _tyres_as_pushes
from collisions.travel import GRAVITY, Tyres
from scripts import benchmarks
from strategies import other_registry

ROOT = Path(__file__).resolve().parent.parent.parent
MOST = 0.7 * GRAVITY * 0.1
TOGETHER = ("duration", "drag", "mutual_crush", "residual_crush", "contact_slide")
SIDES = tuple(LeftOutVehicle.__dataclass_fields__)


def rear_end(speed, restitution=0.4, **changes):
    """Two equal cars in line, the front one at rest."""
    a, b = col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1500.0)
    return col.linear_central(a, b, restitution, **changes)


def t_bone(speed=20.0, restitution=0.1, b=None, **changes):
    """The one of the benchmark."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=speed, x=-2.2, y=0.0, heading=0.0)
    b = b or col.Vehicle(mass=1200.0, yaw_inertia=2100.0, x=0.8, y=-1.0, heading="90 deg")
    return col.eccentric(
        a, b, restitution, **{"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5, **changes}
    )


def spring(e, count=200_000):
    """Shares of the duration, the share of the impulse that comes in each, and what has passed by
    its middle.

    The force of a spring up to the end of compression and of a stiffer one after it, summed up in
    steps; 1e-9 of each sum.
    """
    share = (np.arange(count) + 0.5) / count
    phase = (1.0 + e) * share
    force = np.where(
        phase < 1.0, np.sin(0.5 * np.pi * phase), np.cos(0.5 * np.pi * (phase - 1.0) / (e or 1.0))
    )
    force /= force.sum()
    return share, force, np.cumsum(force) - 0.5 * force


def numbers(found):
    """Every field by its name."""
    return {name: getattr(found, name) for name in TOGETHER} | {
        f"{label}.{name}": getattr(getattr(found, label), name) for label in "ab" for name in SIDES
    }


# By hand


def test_the_impulses_of_the_tyres_are_quantities():
    """As [N*s] of the docstring says; 0.7 of the weight over 0.1 s."""
    found = col.left_out(rear_end(20.0))
    for pair, given in ((found.q.outside_a, found.outside_a), (found.q.outside_b, found.outside_b)):
        assert [one.m_as("N*s") for one in pair] == list(given)
        along, across = (one.m_as("lbf*s") for one in pair)
        assert abs(along) == pytest.approx(1500.0 * MOST / 4.4482216152605, rel=0.03)
        assert across == 0.0


@pytest.mark.parametrize(("speed", "share"), [(2.0, 0.49), (20.0, 0.049)])
def test_locked_wheels_in_a_rear_end_impact(speed, share):
    """0.69 m/s: half of the delta-V at 2 m/s, a twentieth at 20 m/s; delta-V is 0.7 of
    the speed.
    """
    found = col.left_out(rear_end(speed))
    for side in (found.a, found.b):
        assert side.tyre_delta_v_bound == pytest.approx(0.69, abs=0.005)
        assert side.tyre_impulse_bound == pytest.approx(1500 * MOST)
        assert side.tyre_share_bound == pytest.approx(MOST / (0.7 * speed))
        assert side.tyre_share_bound == pytest.approx(share, rel=0.01)
        # Both slide forward throughout, so the contact feels no difference.
        assert side.tyre_impulse == pytest.approx(1500 * MOST)
        assert side.tyre_delta_v == pytest.approx(MOST)
        assert side.tyre_share == pytest.approx(side.tyre_share_bound)
        assert side.rotation == 0.0
        assert side.geometry_delta_v is side.geometry_share is side.geometry_yaw_rate is None
    # A goes on at 0.3 and B at 0.7 of the speed, half of which they have after more than half of
    # the time.
    passed = spring(0.4)[2].mean()
    assert found.a.displacement_x == pytest.approx(0.1 * (1.0 - 0.7 * passed) * speed, rel=1e-8)
    assert found.b.displacement_x == pytest.approx(0.1 * 0.7 * passed * speed, rel=1e-8)
    assert found.a.displacement_y == found.b.displacement_y == found.contact_slide == 0.0
    assert found.residual_crush == pytest.approx(found.a.displacement_x - found.b.displacement_x)


@pytest.mark.slow
def test_tyres_that_one_vehicle_lacks_are_left_out():
    """A rolls, B slides forward: half of what its tyres take is shared by the contact. A wall has
    no tyres, and where both were given, nothing is left out.
    """
    a, b = (
        col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=x, y=0.0, heading=0.0, vx=vx)
        for x, vx in ((-2.2, 3.0), (2.2, 0.0))
    )
    rolling = Tyres(0.7, 0.0, 2.7, 1.5)
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5, "duration": 0.1}

    def found(b=b, **tyres):
        impact = col.eccentric(a, b, 0.3, **contact, tyres_a=rolling, **tyres)
        return col.left_out(impact), col.diagnose(impact)

    left, findings = found()
    assert left.drag == 0.7
    assert left.a.tyre_impulse_bound == left.a.tyre_impulse == 0.0
    assert left.b.tyre_impulse_bound == pytest.approx(1500.0 * MOST)
    assert left.b.tyre_share_bound == pytest.approx(MOST / 1.95)
    assert left.a.tyre_delta_v == pytest.approx(0.5 * MOST)
    assert left.b.tyre_delta_v == pytest.approx(0.5 * MOST)
    assert [one.vehicle for one in findings if one.code == "tyre_impulse"] == ["b"]
    wall = col.Vehicle.barrier().replace(x=2.2, y=0.0, heading=0.0)
    for none_left, findings in (found(tyres_b=rolling), found(b=wall)):
        assert none_left.drag == none_left.b.tyre_impulse_bound == none_left.a.tyre_share == 0.0
        assert "tyre_impulse" not in findings.measured
    page = " ".join(
        col.report(col.eccentric(a, b, 0.3, **contact, tyres_a=rolling), form="markdown").split()
    )
    assert "The tyres of B were not given, and do not act." in page
    assert "| B | delta-V from its own tyres, upper bound | 0.69 m/s (35 percent) |" in page
    assert "| A | delta-V from its own tyres" not in page
    assert "| A | change of delta-V by the tyres of B | 0.34 m/s (18 percent) |" in page


@pytest.mark.slow
def test_a_contact_in_time_without_the_tyres_of_one_vehicle():
    a, b = (
        col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=x, y=0.0, heading=0.0, vx=vx)
        for x, vx in ((-2.2, 3.0), (2.2, 0.0))
    )
    rolling = Tyres(0.7, 0.0, 2.7, 1.5)
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5, "duration": 0.1}
    impact = col.time_resolved(a, b, 0.3, **contact, tyres_a=rolling)
    assert [each.vehicle for each in col.diagnose(impact) if each.code == "tyre_impulse"] == ["b"]
    slid = col.time_resolved(a, b, 0.3, **contact, drag=0.3)
    assert "tyre_impulse" not in col.diagnose(slid).measured


def test_tyres_of_one_vehicle_are_shared_by_the_contact():
    """A plastic impact has one common velocity: what the tyres of either take is divided over both
    masses.
    """
    a, b = col.Vehicle(mass=1500.0, vx=10.0), col.Vehicle(mass=500.0, vx=-30.0)
    # The common velocity is 0: A slides forward throughout, B backward.
    found = col.left_out(col.linear_central(a, b, 0.0))
    assert found.a.tyre_delta_v == pytest.approx(MOST * (1500 - 500) / 2000)
    assert found.b.tyre_delta_v == pytest.approx(MOST * (1500 - 500) / 2000)
    assert found.b.tyre_impulse == pytest.approx(500 * MOST)


@pytest.mark.parametrize("restitution", [0.0, 0.05, 0.3, 0.7, 1.0])
def test_mutual_crush_is_that_of_a_spring(restitution):
    """m x'' = -k x: the most is c sqrt(m/k), after a quarter period; a spring of k/e**2 takes e
    times as long to let go, and gives back the share e**2 of the way. And the closing speed summed
    up to where it is 0, and to the end.
    """
    mass, stiffness = 750.0, 400e3
    quarter = 0.5 * math.pi * math.sqrt(mass / stiffness)
    found = col.left_out(rear_end(10.0, restitution), duration=(1.0 + restitution) * quarter)
    crush = 10.0 * math.sqrt(mass / stiffness)
    assert found.mutual_crush == pytest.approx(crush, rel=1e-14)
    assert found.residual_crush == pytest.approx(
        (1.0 - restitution**2) * crush, rel=1e-14, abs=1e-15
    )
    closing = 10.0 - (1.0 + restitution) * 10.0 * spring(restitution)[2]
    assert found.mutual_crush == pytest.approx(
        found.duration * np.maximum(closing, 0.0).mean(), rel=1e-8
    )
    assert found.residual_crush == pytest.approx(found.duration * closing.mean(), abs=1e-8)


def test_crush_at_the_ends_of_restitution():
    """A share of 2/pi of closing times duration if plastic, of 1/pi if elastic, and then nothing is
    left.
    """
    assert col.left_out(rear_end(10.0, 0.0)).mutual_crush == pytest.approx(2.0 / math.pi)
    elastic = col.left_out(rear_end(10.0, 1.0))
    assert elastic.mutual_crush == pytest.approx(1.0 / math.pi)
    assert elastic.residual_crush == 0.0


def test_a_car_that_turns_round_pulls_nothing_on_the_whole():
    """Elastic, of equal masses against each other: each slides as long one way as the other."""
    a, b = col.Vehicle(mass=1500.0, vx=10.0), col.Vehicle(mass=1500.0, vx=-10.0)
    found = col.left_out(col.linear_central(a, b, 1.0))
    assert found.a.tyre_impulse == pytest.approx(0.0, abs=1e-9)
    assert found.a.tyre_delta_v == pytest.approx(0.0, abs=1e-9)
    assert found.a.tyre_delta_v_bound == pytest.approx(MOST)


@pytest.mark.parametrize("restitution", [0.0, 0.3, 1.0])
def test_against_a_wall_in_line_tyres_take_what_the_wall_need_not(restitution):
    """Delta-V is (1 + e) times the speed, whoever gives it; the wall itself neither moves nor
    pulls.
    """
    impact = col.linear_central(
        col.Vehicle(mass=1500.0, vx=0.3), col.Vehicle.barrier(), restitution
    )
    found = col.left_out(impact)
    assert found.a.tyre_share_bound == pytest.approx(MOST / (0.3 * (1 + restitution)))
    assert found.a.tyre_delta_v == pytest.approx(0.0, abs=1e-12)
    assert all(
        value == 0.0
        for name, value in numbers(found).items()
        if name.startswith("b.") and value is not None
    )


def test_oblique_points_slide_along_each_other():
    """Frictionless at 10 m/s across the normal: 1 m of slide, and tyres against the way
    each goes.
    """
    a, b = col.Vehicle(mass=1500.0, vx=10.0, vy=0.0), col.Vehicle(mass=1500.0, vy=10.0)
    found = col.left_out(col.oblique_central(a, b, 0.0, normal=0.0, friction=0.0))
    assert found.contact_slide == pytest.approx(1.0)
    assert found.mutual_crush == pytest.approx(2.0 / math.pi)
    assert (found.b.displacement_x, found.b.displacement_y) == pytest.approx(
        (0.5 * (1.0 - 2.0 / math.pi), 1.0)
    )
    # A slows from 10 to 5 and is pulled back by all its tyres; B turns its course, and with it the
    # pull, from (0, 1) to (1, 2): the mean of directions within an angle is no shorter than the
    # cosine of its half.
    assert found.a.tyre_impulse == pytest.approx(1500 * MOST)
    assert math.cos(0.5 * math.atan(0.5)) < found.b.tyre_impulse / (1500 * MOST) < 1.0
    assert found.b.geometry_delta_v is None


def test_t_bone():
    """Rotation and displacement are those of velocities that change as the impulse passes; from its
    first touch, geometry moves delta-V by a tenth.
    """
    impact = t_bone()
    found = col.left_out(impact)
    passed = spring(0.1)[2].mean()
    assert found.b.rotation == pytest.approx(0.1 * passed * impact.b.after.yaw_rate, rel=1e-8)
    assert found.a.displacement_x == pytest.approx(
        0.1 * (20.0 + passed * impact.a.delta_vx), rel=1e-8
    )
    assert found.a.geometry_share == pytest.approx(found.b.geometry_share)
    assert col.left_out(impact, geometry="first_contact").b.geometry_share == pytest.approx(
        0.1, abs=0.05
    )
    assert found.b.geometry_share == pytest.approx(found.b.geometry_delta_v / impact.b.delta_v)


def test_geometry_that_does_not_matter():
    """Where both centres are on the normal and nothing turns, the impact is the same later on."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=20.0, x=-2.2, y=0.0)
    impact = col.eccentric(
        a, a.replace(vx=0.0, x=2.2), 0.2, normal=0.0, point=(0.0, 0.0), friction=0.5
    )
    assert col.left_out(impact).b.geometry_delta_v == pytest.approx(0.0, abs=1e-12)


def test_a_contact_that_takes_no_time_leaves_nothing_out():
    """Nor does one without drag and time; all numbers are 0."""
    found = numbers(col.left_out(t_bone(), duration=0.0))
    assert {name: value for name, value in found.items() if value != 0.0} == {"drag": 0.7}
    assert col.left_out(t_bone(), drag=0).a.tyre_delta_v == 0.0


def test_a_pinned_vehicle():
    """Its tyres turn it about the pivot: as much as the arm, the inertia and the mass make of their
    moment.
    """
    b = col.Vehicle(mass=1200.0, yaw_inertia=2100.0, x=0.8, y=0.5, pivot=(0.8, -1.0))
    impact = t_bone(b=b, friction=0.0)
    found = col.left_out(impact)
    share = 1200 * 1.5**2 / (2100 + 1200 * 1.5**2)
    # Wheels at the radius of gyration k: a moment of m (drag g) hypot(arm, k), over m (k^2 +
    # arm^2), times the arm.
    gyration = math.sqrt(2100 / 1200)
    assert found.b.tyre_delta_v_bound == pytest.approx(MOST * 1.5 / math.hypot(1.5, gyration))
    assert found.b.tyre_impulse == pytest.approx(1200 * MOST)
    # A slides forward, B's centre too. Frictionless and in line the contact is one-dimensional:
    # masses along the normal.
    pushed = (2100 + 1200 * 1.5**2) / 1.0**2
    kick_a, kick_b = -MOST, -MOST * share * 1.0 / 1.5
    common = (1500 * kick_a + pushed * kick_b) / (1500 + pushed)
    assert found.a.tyre_delta_v == pytest.approx(abs(common))
    assert found.b.tyre_delta_v == pytest.approx(abs(common) * 1.5)
    passed = spring(impact.restitution)[2].mean()
    assert found.b.rotation == pytest.approx(0.1 * passed * impact.b.after.yaw_rate, rel=1e-8)
    assert 0.0 < found.b.geometry_delta_v < impact.b.delta_v


def test_wheels_at_the_radius_of_gyration_turn_a_pinned_vehicle_no_more_than_is_said():
    """Four of them on that circle, locked, each pulling across its arm; farther out, as those of a
    car, they do more.
    """
    inertia, mass, x, y = 1333.0, 1000.0, 0.3, 0.2
    b = col.Vehicle(mass=mass, yaw_inertia=inertia, x=x, y=y, pivot=(0.0, 0.0), heading=1.0)
    a = col.Vehicle(mass=900.0, vx=16.67, yaw_inertia=900.0, x=-2.0, y=1.0, heading=0.0)
    found = col.left_out(col.eccentric(a, b, 0.2, normal=0.1, point=(0.0, 1.0), friction=0.3)).b

    def by_wheels(ahead, left):
        arms = []
        for sign_x, sign_y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            wx, wy = sign_x * ahead, sign_y * left
            arms.append(
                math.hypot(
                    x + math.cos(1.0) * wx - math.sin(1.0) * wy,
                    y + math.sin(1.0) * wx + math.cos(1.0) * wy,
                )
            )
        return (
            MOST
            * mass
            * math.fsum(arms)
            / 4.0
            / (inertia + mass * (x * x + y * y))
            * math.hypot(x, y)
        )

    gyration = math.sqrt(inertia / mass)
    # The mean distance of two opposite wheels is at least that of their middle, and that of each
    # from it.
    least = max(math.hypot(x, y), gyration) / math.hypot(x, y, gyration)
    for angle in np.linspace(0.0, 1.5, 7):
        one = by_wheels(gyration * math.cos(angle), gyration * math.sin(angle))
        assert least * found.tyre_delta_v_bound < one <= found.tyre_delta_v_bound
    assert by_wheels(1.35, 0.75) > found.tyre_delta_v_bound
    assert "no bound but an estimate" in " ".join(LeftOutVehicle.__doc__.split())


TOUCHES = pytest.mark.parametrize("geometry", ["maximum_engagement", "first_contact"])


def sides_in_time(impact, geometry, duration, steps):
    """Of A and of B what ``time_resolved`` finds with places that move, and with fixed ones."""
    given = impact.inputs
    contact = {
        "normal": given.normal,
        "point": given.point,
        "friction": given.rule_value,
        "duration": duration,
        "steps": steps,
    }
    moves, stands = (
        col.time_resolved(given.a, given.b, given.restitution, **contact, geometry=one)
        for one in (geometry, "fixed")
    )
    return (moves.a, stands.a), (moves.b, stands.b)


def in_time(*asked):
    """How far delta-V moves with the geometry, of A and of B."""
    return [
        math.hypot(moves.delta_vx - stands.delta_vx, moves.delta_vy - stands.delta_vy)
        for moves, stands in sides_in_time(*asked)
    ]


def turned_in_time(*asked):
    """The same of the change of the yaw rate."""
    return [
        abs(moves.delta_yaw_rate - stands.delta_yaw_rate) for moves, stands in sides_in_time(*asked)
    ]


@pytest.mark.slow
@TOUCHES
@pytest.mark.parametrize("normal", [0.0, 0.3])
def test_geometry_of_a_short_plastic_contact_is_that_in_time(geometry, normal):
    """What is linear in the duration, and without friction exact: 0.1 ms in 2000 steps leave a
    thousandth of it.
    """
    b = col.Vehicle(mass=1200.0, yaw_inertia=2100.0, vy=10.0, yaw_rate=0.3, x=0.8, y=-1.0)
    impact = t_bone(b=b, restitution=0.0, friction=0.0, normal=normal)
    found = col.left_out(impact, duration=1e-4, geometry=geometry)
    wanted = in_time(impact, geometry, 1e-4, 2000)
    assert wanted[0] > 1e-5
    assert [found.a.geometry_delta_v, found.b.geometry_delta_v] == pytest.approx(wanted, rel=3e-3)
    turned = turned_in_time(impact, geometry, 1e-4, 2000)
    assert [found.a.geometry_yaw_rate, found.b.geometry_yaw_rate] == pytest.approx(turned, rel=3e-3)


@pytest.mark.slow
@TOUCHES
def test_geometry_of_an_impact_is_that_in_time_to_two_percent_of_delta_v(geometry):
    """T-bones, also of a vehicle that crosses and turns, and a wall; positions at maximum
    engagement leave 3 to 6 percent.
    """
    car = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=15.0, x=-1.8, y=0.4)
    crossing = col.Vehicle(mass=1200.0, yaw_inertia=2100.0, vy=10.0, yaw_rate=0.3, x=0.8, y=-1.0)
    wall = col.eccentric(
        car, col.Vehicle.barrier(), 0.1, normal="30 deg", point=(0.0, 0.0), friction=0.4
    )
    for impact in (t_bone(), t_bone(b=crossing), wall):
        found, wanted = col.left_out(impact, geometry=geometry), in_time(impact, geometry, 0.1, 200)
        for side, estimate, change in (
            (impact.a, found.a, wanted[0]),
            (impact.b, found.b, wanted[1]),
        ):
            assert estimate.geometry_delta_v == pytest.approx(change, abs=0.02 * side.delta_v)
        turned = turned_in_time(impact, geometry, 0.1, 200)
        for estimate, change in zip((found.a, found.b), turned, strict=True):
            assert 0.5 * change <= estimate.geometry_yaw_rate <= 2.0 * change
        if geometry == "maximum_engagement":
            assert 0.02 < wanted[0] / impact.a.delta_v < 0.07


def test_positions_are_those_of_maximum_engagement_unless_it_is_said():
    impact = t_bone(np.array([10.0, 20.0]))
    found, first = col.left_out(impact), col.left_out(impact, geometry="first_contact")
    assert numbers(found)["a.geometry_share"] == pytest.approx(
        numbers(col.left_out(impact, geometry="maximum_engagement"))["a.geometry_share"]
    )
    assert np.all(first.a.geometry_share > 3.0 * found.a.geometry_share)
    one = col.left_out(impact.case(1), geometry="first_contact")
    assert one.a.geometry_share == pytest.approx(first.a.geometry_share[1], rel=1e-9)
    for wrong in ("fixed", "first", None, 1, np.array(["first_contact"])):
        with pytest.raises(
            col.InputError,
            match="geometry must be 'maximum_engagement' or 'first_contact', which says",
        ) as caught:
            col.left_out(impact, geometry=wrong)
        assert (caught.value.code, caught.value.fields["argument"]) == ("bad_option", "geometry")


def test_a_wall_keeps_its_normal_and_the_car_its_place_of_contact():
    """Whether the wall has a position or not, and whichever of the two it is."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=15.0, x=-1.8, y=0.4)
    rest = {"normal": "30 deg", "point": (0.0, 0.0), "friction": 0.4}
    impact = col.eccentric(a, col.Vehicle.barrier(), 0.1, **rest)
    wanted = col.left_out(impact).a.geometry_delta_v
    assert wanted > 0.1
    placed = col.left_out(col.eccentric(a, col.Vehicle.barrier(x=1.0, y=0.0), 0.1, **rest))
    swapped = col.left_out(
        col.eccentric(col.Vehicle.barrier(), a, 0.1, **{**rest, "normal": "210 deg"})
    )
    assert placed.a.geometry_delta_v == pytest.approx(wanted, rel=1e-8)
    assert swapped.b.geometry_delta_v == pytest.approx(wanted, rel=1e-8)


@pytest.mark.parametrize("turn", [0.7, 2.5, -1.9])
def test_the_scene_may_be_turned_and_exchanged(turn):
    """Nothing depends on the axes or on which vehicle is called A; 1e-9 for the rounding of a
    change that is scaled up.
    """
    c, s = math.cos(turn), math.sin(turn)

    def turned(vehicle):
        place = {"x": c * vehicle.x - s * vehicle.y + 3.0, "y": s * vehicle.x + c * vehicle.y - 2.0}
        return vehicle.replace(
            vx=c * vehicle.vx - s * vehicle.vy, vy=s * vehicle.vx + c * vehicle.vy, **place
        )

    impact = t_bone(
        b=col.Vehicle(mass=1200.0, yaw_inertia=2100.0, vy=10.0, yaw_rate=0.3, x=0.8, y=-1.0)
    )
    found = col.left_out(impact)
    a, b = turned(impact.a.before), turned(impact.b.before)
    again = col.left_out(col.eccentric(a, b, 0.1, normal=turn, point=(3.0, -2.0), friction=0.5))
    swapped = col.left_out(
        col.eccentric(b, a, 0.1, normal=turn + math.pi, point=(3.0, -2.0), friction=0.5)
    )
    skipped = ("displacement_x", "displacement_y", "tyre_impulse_x", "tyre_impulse_y")
    for name in SIDES:
        if name not in skipped:
            assert getattr(again.b, name) == pytest.approx(getattr(found.b, name), rel=1e-9), name
            assert getattr(swapped.a, name) == pytest.approx(getattr(found.b, name), rel=1e-9), name
    for name in TOGETHER:
        assert getattr(again, name) == pytest.approx(getattr(found, name), rel=1e-9, abs=1e-12), (
            name
        )


@pytest.mark.parametrize("law", ["brach", "stronge"])
@pytest.mark.parametrize("geometry", ["maximum_engagement", "first_contact"])
def test_nor_does_it_with_tyres_in_the_impact(law, geometry):
    """A lorry and a car, each with tyres of its own, which go by the vehicle's own velocity and not
    by that of the contact.
    """
    lorry = col.Vehicle(mass=28000, yaw_inertia=350000, x=-6.0, y=0.2, heading=0.0, vx=9.0)
    car = col.Vehicle(mass=1300, yaw_inertia=2000, x=0.8, y=-0.6, heading=math.pi / 2, vy=7.0)
    pinned = col.Vehicle(mass=1300, yaw_inertia=2000, x=0.8, y=-0.6, pivot=(1.5, 0.5))
    rest = {"point": (0.0, 0.0), "friction": 0.5, "duration": 0.1, "law": law}
    wheels, others = Tyres(0.7, 0.3, 2.6, 1.5), Tyres(0.5, 1.0, 1.4, 1.5)
    for one, other in ((lorry, car), (lorry.replace(vx=2.0), car), (lorry, pinned)):
        own = {"tyres_a": wheels} if other is pinned else {"tyres_a": wheels, "tyres_b": others}
        turned = {{"tyres_a": "tyres_b", "tyres_b": "tyres_a"}[name]: own[name] for name in own}
        impact = col.eccentric(one, other, 0.05, normal=0.0, **rest, **own)
        swapped = col.eccentric(other, one, 0.05, normal=math.pi, **rest, **turned)
        found = col.left_out(impact, geometry=geometry)
        again = col.left_out(swapped, geometry=geometry)
        for name in SIDES:
            assert getattr(again.b, name) == pytest.approx(
                getattr(found.a, name), rel=1e-8, abs=1e-10
            ), name
            assert getattr(again.a, name) == pytest.approx(
                getattr(found.b, name), rel=1e-8, abs=1e-10
            ), name
        assert found.a.geometry_delta_v > 1e-4


@pytest.mark.parametrize("law", ["brach", "stronge"])
@pytest.mark.parametrize("label", ["a", "b"])
@pytest.mark.parametrize("other", ["car", "wall", "pinned"])
def test_tyres_of_one_vehicle_stay_where_the_geometry_moves(law, label, other):
    """The impact solved again has them: as the duration goes to 0, so does what motion does."""
    car = col.Vehicle(mass=2000, yaw_inertia=3500, x=-2.0, y=0.2, heading=0.0, vx=9.0)
    struck = {
        "car": col.Vehicle(mass=1300, yaw_inertia=2000, x=0.8, y=-0.6, heading=math.pi / 2, vy=7.0),
        "wall": col.Vehicle.barrier(),
        "pinned": col.Vehicle(mass=1300, yaw_inertia=2000, x=0.8, y=-0.6, pivot=(1.5, 0.5)),
    }[other]
    if label == "b" and other != "car":
        return
    rest = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5, "law": law, "duration": 0.1}
    wheels, none = Tyres(0.7, 0.3, 2.6, 1.5), Tyres(1e-12, 0.3, 2.6, 1.5)
    own = {f"tyres_{label}": wheels}
    impact = col.eccentric(car, struck, 0.05, **rest, **own)
    again = solve_changed(impact, **_tyres_as_pushes(impact))
    for name in ("delta_vx", "delta_vy", "delta_yaw_rate"):
        for side in "ab":
            now, was = (getattr(getattr(one, side), name) for one in (again, impact))
            assert now == pytest.approx(was, rel=1e-9, abs=1e-10)
    if other == "car":
        beside = {f"tyres_{'b' if label == 'a' else 'a'}": none}
        with_none = col.eccentric(car, struck, 0.05, **rest, **own, **beside)
        for side in "ab":
            alone, both = (getattr(col.left_out(one), side) for one in (impact, with_none))
            assert alone.geometry_delta_v == pytest.approx(both.geometry_delta_v, rel=1e-6)
    short = col.left_out(impact, duration=1e-6)
    assert short.a.geometry_delta_v < 1e-4


@pytest.mark.parametrize("law", ["brach", "kudlich-slibar"])
@pytest.mark.parametrize(
    "rule",
    [{"friction": 0.2}, {"friction": math.inf}, {"impulse_ratio": 0.1}, {"critical_fraction": 0.5}],
)
def test_every_law_and_rule_is_asked_again(law, rule):
    """By hand: with a 1024th of the impulse of the tyres from outside.

    The laws are linear in the impulse, for a fraction to the order of what is tried, a 64th of 0.7
    of 20 m/s; 1e-8 for the rounding of a change that is scaled up.
    """
    rule = {"friction": None, **rule}
    impact = t_bone(law=law, **rule)
    found = col.left_out(impact)
    little = {
        f"outside_{label}": tuple(part / 1024 for part in getattr(found, f"outside_{label}"))
        for label in "ab"
    }
    pushed = impact.again(**little)
    for name in "ab":
        old, new, side = getattr(impact, name), getattr(pushed, name), getattr(found, name)
        by_tyres = math.hypot(new.delta_vx - old.delta_vx, new.delta_vy - old.delta_vy)
        within = 1.0 / 64 if "critical_fraction" in rule else 1e-8
        assert side.tyre_delta_v == pytest.approx(1024 * by_tyres, rel=within)


@pytest.mark.parametrize("friction", [0.2, math.inf])
def test_tyres_shift_the_velocities_first(friction):
    """By hand, without impulses from outside: velocities shifted, and the restitution for which the
    points part as they did.

    Under "brach": for "kudlich-slibar" the restitution is that of the slip too.
    """
    impact = t_bone(friction=friction)
    found = col.left_out(impact)
    part = 1.0 / 1024
    moved = [
        side.before.replace(
            vx=side.before.vx + part * x / side.before.mass,
            vy=side.before.vy + part * y / side.before.mass,
        )
        for side, (x, y) in ((impact.a, found.outside_a), (impact.b, found.outside_b))
    ]
    closing = moved[0].vx - moved[1].vx
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": friction}
    again = col.eccentric(*moved, 0.1 * impact.closing_speed / closing, **contact)
    for name in "ab":
        old, new = getattr(impact, name).after, getattr(again, name).after
        change = math.hypot(new.vx - old.vx, new.vy - old.vy)
        assert getattr(found, name).tyre_delta_v == pytest.approx(change / part, rel=1e-8)


# Units and looks


def test_units_of_every_kind():
    """Texts and Quantities of another registry; a deceleration for the drag."""
    other = other_registry()
    wanted = numbers(col.left_out(t_bone(), duration=0.08, drag=0.6))
    for arguments in (
        {"duration": "80 ms", "drag": "60 %"},
        {"duration": other.Quantity(80, "ms"), "drag": other.Quantity(0.6, "g_0")},
        {"duration": pint.Quantity(0.08, "s"), "drag": f"{0.6 * GRAVITY!r} m/s**2"},
    ):
        assert numbers(col.left_out(t_bone(), **arguments)) == pytest.approx(
            wanted, rel=1e-9, abs=1e-12
        )


def test_quantities_and_tables():
    """Every field has its unit, as a Quantity, in the repr and in the table of a notebook."""
    found = col.left_out(t_bone())
    assert isinstance(found, LeftOut)
    assert all(type(value) is float for value in numbers(found).values())
    assert found.q.mutual_crush.to("cm").magnitude == pytest.approx(100 * found.mutual_crush)
    assert found.q.b.rotation.to("deg").magnitude == pytest.approx(math.degrees(found.b.rotation))
    assert found.b.q.tyre_impulse.check("[mass] * [length] / [time]")
    assert found.q.a.tyre_share.dimensionless
    assert repr(found).startswith("LeftOut(duration=0.1 s, drag=0.7, mutual_crush=")
    assert "b.tyre_delta_v_bound=0.686465 m/s" in repr(found)
    assert repr(found.b).startswith("LeftOutVehicle(tyre_impulse_bound=823.759 N*s")
    page = found._repr_html_()
    for name in numbers(found):
        assert f">{name}</th>" in page
    assert "geometry" not in repr(col.left_out(rear_end(5.0)))
    with pytest.raises(AttributeError):
        found.duration = 0.2


def test_pickles():
    """The same numbers, and arrays still locked."""
    found = col.left_out(t_bone(np.array([10.0, 20.0])))
    again = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(again.b.tyre_share, found.b.tyre_share)
    assert not again.b.tyre_share.flags.writeable
    assert not again.mutual_crush.flags.writeable


# Many cases


def test_a_batch_is_its_cases():
    """Speeds, durations and drags broadcast; 1e-9 for the rounding of a change that is
    scaled up.
    """
    speeds, durations, drags = (
        np.array([2.0, 20.0]),
        np.array([[0.05], [0.1], [0.0]]),
        np.array([0.3, 0.9]),
    )
    found = numbers(col.left_out(t_bone(speeds), duration=durations, drag=drags))
    for value in found.values():
        assert value.shape == (3, 2)
        assert not value.flags.writeable
    for index in np.ndindex(3, 2):
        one = col.left_out(
            t_bone(speeds[index[1]]), duration=durations[index[0], 0], drag=drags[index[1]]
        )
        for name, value in numbers(one).items():
            assert found[name][index] == pytest.approx(value, rel=1e-9, abs=1e-12), name


def test_one_impact_of_many_durations_and_many_impacts_of_one():
    """Either may be the array; geometry is None all over for the central models."""
    for found in (
        col.left_out(rear_end(10.0), duration=np.array([0.05, 0.1])),
        col.left_out(rear_end(np.array([10.0, 10.0]))),
    ):
        assert (
            found.a.tyre_delta_v.shape == found.mutual_crush.shape == found.duration.shape == (2,)
        )
        assert found.a.geometry_delta_v is None
        assert found.b.tyre_delta_v[1] == pytest.approx(MOST)


def test_one_impact_of_many_drags():
    """Each drag as it would be alone; the duration and the impact are plain numbers."""
    drags = np.array([0.3, 0.9])
    found = col.left_out(rear_end(10.0), drag=drags)
    for index, drag in enumerate(drags):
        one = col.left_out(rear_end(10.0), drag=float(drag))
        assert found.a.tyre_delta_v_bound[index] == pytest.approx(
            one.a.tyre_delta_v_bound, rel=1e-15
        )
        assert found.b.tyre_delta_v[index] == pytest.approx(one.b.tyre_delta_v, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [None, 0.5])
def test_a_large_batch_is_worked_out_in_blocks(tolerance):
    """What its cases give alone, and beyond inputs and answers no more memory than 20 MiB, which is
    no array of all cases.

    For a block of 16384 cases 150 numbers of 8 bytes are 19 MiB; for all cases at once they would
    be 229 MiB.
    """
    size = 200_000
    speeds = np.linspace(2.0, 20.0, size).reshape(2, -1)
    a = col.Vehicle(
        mass=1500.0, yaw_inertia=2600.0, vx=speeds, x=-2.2, y=np.linspace(0.0, 1.0, size // 2)
    )
    b = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, x=0.8, y=-0.2)
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5}
    impact = (
        col.eccentric(a, b, 0.1, **contact)
        if tolerance is None
        else col.solve(a, b, 0.1, tolerance=tolerance, **contact)
    )
    tracemalloc.start()
    try:
        found = col.left_out(impact, duration=0.12)
        kept, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert most - kept < 20 * 2**20
    assert found.a.rotation.shape == (2, size // 2)
    for row, column in ((0, 0), (0, 16383), (0, 16384), (1, size // 2 - 1)):
        one = col.left_out(impact.case((row, column)), duration=0.12)
        for name, value in numbers(one).items():
            many = numbers(found)[name][row, column]
            assert (
                math.isnan(many)
                if value is None
                else many == pytest.approx(value, rel=1e-9, abs=1e-12)
            ), name


def test_single_precision_stays():
    """float32 where every array is; the scaled change keeps four digits."""
    speeds = np.array([2.0, 20.0])
    short, full = (col.left_out(t_bone(speeds.astype(kind))) for kind in (np.float32, np.float64))
    for name, value in numbers(short).items():
        assert value.dtype == np.float32, name
        np.testing.assert_allclose(value, numbers(full)[name], rtol=2e-4, atol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_a_linear_impact_at_an_angle_has_estimates_in_every_case(kind):
    """Both slide one way, so that each loses what its tyres take; the rounding of the pull is not
    motion across the normal.
    """
    rng = np.random.default_rng(5)
    angle = rng.uniform(-3.0, 3.0, 40_000).astype(kind)
    speed = rng.uniform(5.0, 12.0, angle.size).astype(kind)
    n = np.cos(angle), np.sin(angle)
    a, b = (
        col.Vehicle(mass=mass, vx=v * n[0], vy=v * n[1])
        for mass, v in ((1500.0, speed), (900.0, kind(0.5) * speed))
    )
    impact = col.linear_central(a, b, 0.3, normal=n, on_failure="nan")
    assert np.count_nonzero(impact.refused) == 0
    found = col.left_out(impact)
    # The change is scaled up 64 times, and with it the rounding of speeds of 12 m/s.
    rounding = 64 * 4 * 12 * np.finfo(kind).eps
    for side in (found.a, found.b):
        np.testing.assert_allclose(side.tyre_delta_v, MOST, atol=rounding + 1e-6 * MOST)


def test_one_linear_impact_at_an_angle_against_a_wall():
    """Where rounding the pull of the tyres was taken for motion across the normal. In line it
    leaves nothing of delta-V.
    """
    angle, speed = 0.4119811571212382, 1.4832347944330992
    n = math.cos(angle), math.sin(angle)
    car = col.Vehicle(mass=1500.0, vx=speed * n[0], vy=speed * n[1])
    found = col.left_out(
        col.linear_central(car, col.Vehicle(mass=math.inf), 0.44644584810264654, normal=n)
    )
    assert abs(found.a.tyre_delta_v) <= MOST


def test_refused_cases_are_nan_and_their_neighbours_untouched():
    """Those that the impact refused, without another word; those of a bad duration or drag, with
    one warning.
    """
    speeds = np.array([20.0, -1.0, 20.0, 20.0, 20.0])
    impact = t_bone(speeds, on_failure="nan")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = numbers(col.left_out(impact))
    for value in found.values():
        assert np.isnan(value).tolist() == [False, True, False, False, False]
    durations = np.array([0.1, 0.1, -0.1, math.nan, 0.1])
    drags = np.array([0.7, 0.7, 0.7, 0.7, -0.7])
    with pytest.warns(
        col.CollisionsWarning, match="3 of 5 cases cannot be answered and are NaN"
    ) as caught:
        found = numbers(col.left_out(impact, duration=durations, drag=drags))
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert caught[0].message.fields["counts"] == {
        "not_finite": 1,
        "negative_duration": 1,
        "negative_drag": 1,
    }
    one = numbers(col.left_out(t_bone()))
    for name, value in found.items():
        assert np.isnan(value).tolist() == [False, True, True, True, True]
        assert value[0] == pytest.approx(one[name], rel=1e-9, abs=1e-12)


def test_a_single_refused_impact_is_nan():
    """As its own numbers are; in as many cases as there are durations."""
    impact = t_bone(-1.0, on_failure="nan")
    assert all(math.isnan(value) for value in numbers(col.left_out(impact)).values())
    many = col.left_out(impact, duration=np.array([0.1, 0.2]))
    assert np.isnan(many.a.geometry_share).tolist() == [True, True]


def test_a_geometry_that_is_no_impact_later_on_is_nan():
    """One that slides by, and turns, so that the surfaces part when most of the contact is over;
    alone as in a batch.
    """
    for speed in (0.3, np.array([0.3])):
        a = col.Vehicle(
            mass=1500.0, yaw_inertia=2600.0, vx=speed, vy=-10.0, yaw_rate=3.0, x=-0.8, y=0.0
        )
        b = col.Vehicle(mass=1200.0, yaw_inertia=2100.0, yaw_rate=3.0, x=0.8, y=0.0)
        impact = col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.0)
        found = col.left_out(impact, geometry="first_contact")
        assert np.isnan(found.a.geometry_delta_v)
        assert np.isnan(found.b.geometry_share)
        assert np.isfinite(found.a.tyre_delta_v)


def test_an_impact_that_gains_energy_says_so_once():
    """The solver did when it was called, and not again for what is left out."""
    with pytest.warns(col.EnergyGainWarning):
        impact = t_bone(friction=None, impulse_ratio=-0.9)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert col.left_out(impact).a.tyre_delta_v > 0.0


@pytest.mark.slow
def test_a_large_batch_that_gains_energy_says_so_once():
    """Also where it is worked out in blocks."""
    with pytest.warns(col.EnergyGainWarning):
        impact = t_bone(restitution=np.full(16_385, 1.0), friction=None, impulse_ratio=-0.9)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.all(col.left_out(impact).a.tyre_delta_v > 0.0)


# Impacts of solve


def test_a_batch_without_a_point_has_no_geometry():
    """Also with a case that parts, for which no model is known to be enough."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=math.inf, vx=np.array([10.0, -5.0]))
    b = col.Vehicle(mass=1000.0, yaw_inertia=math.inf)
    impact = col.solve(
        a, b, 0.3, normal=0.0, point=None, friction=0.0, tolerance=0.1, on_failure="nan"
    )
    assert list(impact.model) == ["linear_central", "eccentric"]
    found = col.left_out(impact)
    assert found.a.geometry_delta_v is None
    assert found.b.geometry_share is None
    assert found.a.tyre_delta_v[0] == pytest.approx(MOST, rel=1e-9)
    assert np.isnan(found.a.tyre_delta_v).tolist() == [False, True]


def least(a=None, b=None, tolerance=0.1, **changes):
    """Nearly in line: what model is the least hangs on the tolerance."""
    one, other = (
        {"mass": 1500.0, "vx": 10.0, "x": -2.0, "y": 0.0},
        {"mass": 1200.0, "x": 2.0, "y": 0.0},
    )
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5, **changes}
    return col.solve(
        col.Vehicle(**{**one, **(a or {})}),
        col.Vehicle(**{**other, **(b or {})}),
        0.2,
        tolerance=tolerance,
        **contact,
    )


def test_an_impact_of_solve_without_yaw_inertias():
    """What the linear model leaves out, alone and in a batch, without a point too."""
    wanted = numbers(
        col.left_out(
            col.linear_central(col.Vehicle(mass=1500.0, vx=10.0), col.Vehicle(mass=1200.0), 0.2)
        )
    )

    def moved(impact):
        """Without what a central model leaves None."""
        return {
            name: value
            for name, value in numbers(col.left_out(impact)).items()
            if value is not None
        }

    there = {name: value for name, value in wanted.items() if value is not None}
    assert set(wanted) - set(there) == {
        f"{side}.geometry_{kind}" for side in "ab" for kind in ("delta_v", "share", "yaw_rate")
    }
    assert moved(least()) == pytest.approx(there, rel=1e-12, abs=1e-12)
    stiff = {"x": None, "y": None, "yaw_inertia": math.inf}
    assert moved(least(stiff, stiff, point=None)) == pytest.approx(there, rel=1e-12, abs=1e-12)
    many = numbers(col.left_out(least({"vx": np.array([10.0, -1.0])}, on_failure="nan")))
    for name, value in many.items():
        assert math.isnan(value[1])
        assert (
            math.isnan(value[0])
            if wanted[name] is None
            else value[0] == pytest.approx(wanted[name], rel=1e-12, abs=1e-12)
        )
    longer = col.left_out(least(), duration=np.array([0.1, 0.2]))
    assert longer.a.geometry_delta_v is None
    assert longer.mutual_crush.tolist() == pytest.approx(
        [wanted["mutual_crush"], 2.0 * wanted["mutual_crush"]]
    )


def test_an_impact_of_solve_at_the_edge_of_its_tolerance():
    """The model that answered is run again, and not the one that the kicked inputs
    would require.
    """
    body = {"yaw_inertia": 2000.0}
    a, b = {**body, "y": 0.05}, {**body, "vx": -12.0}
    full = least(a, b, tolerance=0.0, friction=0.0)
    edge = 1.15 * full.choice.errors["linear_central"]
    linear, above = (least(a, b, tolerance=edge * (1.0 + by), friction=0.0) for by in (1e-4, 0.2))
    assert (full.model, linear.model, above.model) == (
        "eccentric",
        "linear_central",
        "linear_central",
    )
    assert col.left_out(linear).a.tyre_delta_v == col.left_out(above).a.tyre_delta_v
    # The bound on the share of a lever of 0.05 m: 1 percent of the delta-V.
    assert col.left_out(linear).a.tyre_delta_v == pytest.approx(
        col.left_out(full).a.tyre_delta_v, rel=0.01
    )
    same = col.eccentric(
        full.a.before, full.b.before, 0.2, normal=0.0, point=(0.0, 0.0), friction=0.0
    )
    assert numbers(col.left_out(full)) == numbers(col.left_out(same))


def test_geometry_only_where_the_eccentric_model_answered():
    """By tolerance: None for a central model alone, NaN in a batch, and the rest of a batch as it
    is alone.
    """
    tolerances = (0.0, 0.5, 5.0)
    a = {"yaw_inertia": 2000.0, "vy": 3.0, "x": -0.6, "y": -0.15}
    b = {"yaw_inertia": 2000.0, "vx": -2.0, "vy": -4.0, "x": 0.6, "y": 0.15}
    alone = [least(a, b, tolerance=tolerance, friction=0.3) for tolerance in tolerances]
    assert [impact.model for impact in alone] == ["eccentric", "oblique_central", "linear_central"]
    many = numbers(col.left_out(least(a, b, tolerance=np.array(tolerances), friction=0.3)))
    for i, impact in enumerate(alone):
        for name, value in numbers(col.left_out(impact)).items():
            assert (value is None) == (i > 0 and "geometry" in name)
            if value is None:
                assert math.isnan(many[name][i])
            else:
                assert many[name][i] == pytest.approx(value, rel=1e-9, abs=1e-12), name


# Refusals


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        ({"duration": -0.1}, "negative_duration", "duration must be >= 0, got -0.1"),
        ({"duration": "-5 ms"}, "negative_duration", "got '-5 ms'"),
        ({"duration": math.nan}, "not_finite", "duration is NaN"),
        ({"duration": math.inf}, "not_finite", "duration must be finite"),
        ({"duration": "5 m"}, "bad_units", "'5 m' cannot be taken as s"),
        ({"duration": "x"}, "bad_units", "such as 0.1 (s) or '100 ms'"),
        ({"duration": None}, "not_a_number", "duration must be a number"),
        ({"duration": True}, "not_a_number", "duration must be a number"),
        (
            {"duration": [0.1, 0.2]},
            "bad_shape",
            "duration is a list, and takes one value; many cases go in a numpy array",
        ),
        ({"duration": "1e308 s"}, "out_of_range", "too large"),
        ({"drag": -0.7}, "negative_drag", "drag must be >= 0, got -0.7"),
        (
            {"drag": "5 m"},
            "bad_units",
            "drag: cannot read '5 m' as a drag factor or a deceleration",
        ),
        ({"drag": math.inf}, "not_finite", "drag must be finite"),
        ({"duration": np.ones(2), "drag": np.ones(3)}, "bad_shape", "duration (2,), drag (3,)"),
        ({"impact": 3.0}, "not_an_impact", "impact must be an Impact, got float"),
        ({"impact": None}, "not_an_impact", "write left_out(collisions.eccentric(...))"),
        ({"impact": col.Vehicle(mass=1.0)}, "not_an_impact", "got Vehicle"),
    ],
)
def test_refusals(arguments, code, said):
    """Each says what to write."""
    arguments = {"impact": t_bone(), **arguments}
    with pytest.raises(col.InputError, match=re.escape(said)) as caught:
        col.left_out(arguments.pop("impact"), **arguments)
    assert caught.value.code == code


def test_a_mass_too_small_for_its_reciprocal_is_refused():
    """Alone; in a batch it is NaN beside an answered case."""
    struck = col.Vehicle(mass=1200.0)
    with pytest.raises(col.InputError, match="too large or too small") as caught:
        col.left_out(col.linear_central(col.Vehicle(mass=5e-324, vx=3.0), struck, 0.3))
    assert caught.value.code == "out_of_range"
    impact = col.linear_central(col.Vehicle(mass=np.array([5e-324, 1500.0]), vx=3.0), struck, 0.3)
    with pytest.warns(
        col.CollisionsWarning, match="1 of 2 cases cannot be answered and are NaN .1 out_of_range"
    ):
        found = col.left_out(impact)
    assert np.isnan(found.a.tyre_delta_v).tolist() == [True, False]


def test_all_wrong_arguments_are_named_at_once():
    """One error, one line for each."""
    with pytest.raises(col.InputError, match="3 arguments cannot be used") as caught:
        col.left_out(None, duration="x", drag="y")
    for name in ("impact", "duration", "drag"):
        assert f"\n- {name}" in str(caught.value)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [({"duration": 100}, "'100 ms'"), ({"drag": 6.9}, "'6.9 m/s**2' or '6.9 %'")],
)
def test_bare_numbers_of_a_suspect_size(arguments, said):
    """Read as what they are, with a warning; the same with a unit is beyond suspicion."""
    with pytest.warns(col.SuspectUnitsWarning, match=re.escape(said)) as caught:
        col.left_out(rear_end(10.0), **arguments)
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        col.left_out(rear_end(10.0), duration="2 s", drag="20 m/s**2")


# Against a contact that takes time


@pytest.fixture(scope="module")
def script():
    """The benchmark."""
    if not (ROOT / "benchmarks").is_dir():
        pytest.skip("the sdist has no benchmarks")
    return benchmarks("time_resolved")


@pytest.fixture(scope="module")
def measured(script):
    """All scenes, with tyres, motion, both and neither."""
    return script.measure()


def hold(script, steps=None):
    """What locked wheels take of a velocity in one step."""
    return script.DRAG * GRAVITY * script.DURATION / (steps or script.STEPS)


@pytest.mark.slow
def test_the_reference_is_the_impulse_where_nothing_is_left_out(script):
    """With the geometry of first contact and no tyres it comes to law "stronge", at second order:
    twice the steps, a quarter.
    """
    law = script.changes([scene.impact(law="stronge") for scene in script.SCENES])
    once, twice = (
        np.linalg.norm(
            script.changes([scene.passed("fixed", steps) for scene in script.SCENES]) - law,
            axis=(0, 1),
        )
        for steps in (50, 100)
    )
    assert np.round(np.log2(once / twice)).tolist() == [2.0] * len(script.SCENES)


@pytest.mark.slow
def test_the_reference_has_converged(script):
    """At second order where wheels slide throughout, as in the sideswipe. Else to what tyres take
    in one step.

    A wheel that starts to slide or stops within a step is held for all of it or for none. The
    contact shares out what both vehicles miss by that, so neither is off by more than one whole
    step; what is second order is 1e-4 m/s or less beside it.
    """
    found = [
        script.changes([scene.passed("all", steps) for scene in script.SCENES])
        for steps in (100, 200, 400)
    ]
    once, twice = (np.hypot(*(new - old)[:2]) for old, new in itertools.pairwise(found))
    assert once.max() < hold(script, 100)
    assert twice.max() < hold(script, 200)
    sideswipe = [scene.key for scene in script.SCENES].index("sideswipe")
    assert np.round(np.log2(once[:, sideswipe] / twice[:, sideswipe])).tolist() == [2.0, 2.0]


@pytest.mark.slow
def test_tyres_are_estimated_to_a_factor_of_one_and_a_half(measured):
    """Sliding with the centre, and at four wheels, which also turn; 1.5 is the margin the design
    asks for on the estimates.
    """
    for row in measured["rows"]:
        for which in ("tyres", "wheels"):
            assert 1 / 1.5 < row["left_out"]["tyre_delta_v"] / row[which]["delta_v"] < 1.5, (
                row["scene"],
                which,
            )


@pytest.mark.slow
def test_no_tyres_take_more_than_they_can_hold(script):
    """However they turn: drag times weight times the time that the contact took; of the estimate,
    the time given.
    """
    for scene in script.drawn(20):
        impact, found = (
            scene.passed("wheels", 50),
            col.left_out(scene.impact(), duration=script.DURATION, drag=script.DRAG),
        )
        for label in "ab":
            side, estimate = getattr(impact, label), getattr(found, label)
            most = script.DRAG * GRAVITY * side.before.mass
            assert math.hypot(
                side.tyre_impulse_x, side.tyre_impulse_y
            ) <= most * impact.pulse.duration * (1.0 + 1e-12)
            assert estimate.tyre_impulse <= estimate.tyre_impulse_bound * (1.0 + 1e-12)
            assert estimate.tyre_impulse_bound == pytest.approx(most * script.DURATION, rel=1e-12)


@pytest.mark.slow
def test_geometry_is_estimated_to_a_factor_of_one_and_a_half(measured):
    """From first contact; of what little is left from maximum engagement, to 2 percent
    of delta-V.
    """
    for row in measured["rows"]:
        moved = row["moving"]["delta_v"]
        if row["scene"].startswith("rear_end"):
            assert moved == row["left_out"]["geometry_delta_v"] == 0.0
            continue
        assert 1 / 1.5 < row["left_out"]["geometry_delta_v"] / moved < 1.5, row["scene"]
        off = row["left_out"]["engaged_delta_v"] - row["engaged"]["delta_v"]
        assert abs(off) < 0.02 * row["delta_v"], row["scene"]
        assert row["engaged"]["delta_v"] < 0.75 * moved


@pytest.mark.slow
def test_estimates_over_random_impacts_are_as_the_docstring_says(measured):
    """Worked out again; the docstring has the figures of the committed file, which keeps three
    digits.
    """
    file = json.loads((ROOT / "docs" / "_generated" / "time_resolved.json").read_text("utf-8"))
    said = " ".join(col.left_out.__doc__.split())
    assert measured["frictions"] == file["frictions"]
    for key, frictions in file["frictions"].items():
        committed = file[key]
        assert measured[key]["impacts"] == committed["impacts"] == 150
        assert f"over {committed['impacts']} random impacts" in said
        assert f"a friction of {frictions[0]:g} to {frictions[-1]:g}" in said
        for name in ("tyres", "moving", "engaged"):
            row = committed[name]
            assert measured[key][name]["quantiles"] == pytest.approx(row["quantiles"], rel=0.006)
            assert measured[key][name]["outside_1.5"] == pytest.approx(
                row["outside_1.5"], rel=0.006
            )
            assert measured[key][name]["vehicles"] == row["vehicles"]
            least, low, *_, high, most = row["quantiles"]
            assert re.search(
                rf"{low:.2f} to {high:.2f} of [\w ]+ in 9 of 10, {least:.2f} to {most:.2f} in all",
                said,
            )
            assert row["no_estimate"] == 0


@pytest.mark.slow
@pytest.mark.parametrize("key", ["drawn", "drawn_with_little_friction"])
def test_other_random_impacts_are_as_often_within(script, key):
    """The shares said hold for impacts of another seed, to three standard errors of both samples.

    Both vehicles of an impact go together, so a share of N vehicles has a standard error of sqrt(p
    (1 - p) / (N/2)).
    """
    file = json.loads((ROOT / "docs" / "_generated" / "time_resolved.json").read_text("utf-8"))
    again = script.ratios_of_drawn(80, 50, tuple(file["frictions"][key]), seed=7)
    for name, (ratio, missing) in again.items():
        row = file[key][name]
        _, low, *_, high, _ = row["quantiles"]
        within = float(np.mean((low <= ratio) & (ratio <= high)))
        for share, said in ((within, 0.9), (script.outside(ratio), row["outside_1.5"])):
            error = math.sqrt(said * (1.0 - said) * (2.0 / ratio.size + 2.0 / row["vehicles"]))
            assert abs(share - said) <= 3.0 * error, name
        assert missing == 0


def parting_as_given(script, key, variant):
    """A scene followed with that spring for which it takes 0.1 s and the points part at e times the
    closing speed.
    """
    (scene,) = (one for one in script.SCENES if one.key == key)
    e, duration = scene.restitution, script.DURATION
    contact = {
        "normal": scene.normal,
        "point": scene.point,
        "friction": scene.friction,
        **script.VARIANTS[variant],
    }
    for _ in range(60):
        impact = col.time_resolved(
            *scene.vehicles(), e, **contact, duration=duration, steps=script.STEPS
        )
        parts = impact.separation_speed / (scene.restitution * impact.closing_speed)
        lasts = impact.pulse.duration / script.DURATION
        if abs(parts - 1.0) + abs(lasts - 1.0) < 1e-5:
            break
        e, duration = e / parts, duration / lasts
    assert abs(parts - 1.0) + abs(lasts - 1.0) < 1e-5
    return impact.b.delta_v / scene.impact().b.delta_v - 1.0


def braked_in_line(speed, e, duration, count=20_000):
    """Share of the delta-V of the front of two equal cars that locked wheels of both take: masses
    on a line, in small steps.

    Energetic restitution: a spring, let go along one that is 1 / e squared as stiff. Tyres take
    what they can and no more.
    """
    stiffness, step, take = (
        0.5 * ((1.0 + e) * math.pi / (2.0 * duration)) ** 2,
        duration / count,
        MOST / 0.1 * duration / count,
    )
    a, b, crush, deepest = speed, 0.0, 0.0, 0.0
    while True:
        deepest = max(deepest, crush)
        force = stiffness * (crush if crush == deepest else deepest - (deepest - crush) / e**2)
        if force < 0.0:
            return 1.0 - b / (0.5 * (1.0 + e) * speed)
        a, b = a - force * step, b + force * step
        a, b = (math.copysign(max(abs(v) - take, 0.0), v) for v in (a, b))
        crush += (a - b) * step


@pytest.mark.slow
def test_the_figures_of_the_design(script, measured):
    """Tyres are half of the delta-V of a rear-end impact at 2 m/s and 5 % at 20 m/s; a T-bone at 20
    m/s loses 5 %.

    43 % and 5.2 % are those of a force of 0.1 s after which the points part at e times the closing
    speed, as with impulses from outside. A spring that gives back the part e squared of its work
    lets them part otherwise where tyres act or the geometry moves: so 48 % and 4.8 %.
    """
    rows = {(row["scene"], row["side"]): row for row in measured["rows"]}
    two, twenty = (rows[f"rear_end_{speed}", "b"]["wheels"]["share"] for speed in (2, 20))
    assert two == pytest.approx(0.5, abs=0.05)
    assert twenty == pytest.approx(0.05, abs=0.005)
    assert rows["t_bone", "b"]["moving"]["magnitude"] == pytest.approx(-0.05, abs=0.005)
    # To what tyres take in a step, and three digits.
    for share, speed in ((two, 2.0), (twenty, 20.0)):
        assert share == pytest.approx(
            braked_in_line(speed, 0.4, 0.1), abs=hold(script) / (0.7 * speed), rel=0.005
        )
    # The tyres of A hold it in the end: it keeps none of the (1 - e) / 2 of the speed that it
    # would.
    assert rows["rear_end_2", "a"]["wheels"]["share"] == pytest.approx(
        0.6 / 1.4, abs=hold(script) / 1.4
    )
    # B leaves it at e c = 0.8 m/s, not at 1.4.
    assert parting_as_given(script, "rear_end_2", "wheels") == pytest.approx(
        -0.6 / 1.4, abs=hold(script) / 1.4
    )
    assert parting_as_given(script, "t_bone", "moving") == pytest.approx(-0.052, abs=5e-4)


@pytest.mark.slow
def test_the_script_writes_what_it_prints(script, measured, monkeypatch, capsys, tmp_path):
    """Strict JSON in the file that is named, a table on the screen."""
    monkeypatch.setattr(script, "measure", lambda: measured)
    monkeypatch.setattr(sys, "argv", ["time_resolved.py", str(tmp_path / "found.json")])
    script.main()
    assert json.loads((tmp_path / "found.json").read_text("utf-8")) == measured
    printed = capsys.readouterr().out
    for scene in script.SCENES:
        assert scene.name in printed


@pytest.mark.slow
@pytest.mark.parametrize("restitution", [5e-324, 1e-320])
def test_the_least_restitution_leaves_out_what_none_does(restitution):
    """Restitution takes so long as compression: next to nothing, not a time over nothing."""
    a, b = col.Vehicle(mass=1500.0, vx=20.0), col.Vehicle(mass=1200.0)
    least, none = (col.left_out(col.linear_central(a, b, e)) for e in (restitution, 0.0))
    assert (least.mutual_crush, least.a.tyre_delta_v) == pytest.approx(
        (none.mutual_crush, none.a.tyre_delta_v), rel=1e-12
    )


def test_what_a_refused_scene_without_a_point_leaves_out():
    """Bodies that move apart are refused whatever else is missing; nothing was left out
    for them.
    """
    gate = col.Vehicle(mass=1000.0, yaw_inertia=1300.0, x=2.0, y=1.0, pivot=(2.0, 0.0))
    away = col.Vehicle(mass=1500.0, vx=np.array([-20.0, -10.0]), yaw_inertia=2000.0, x=0.0, y=0.0)
    for a in (away, away.replace(vx=np.array([]))):
        impact = col.solve(a, gate, 0.1, normal=0.0, point=None, friction=0.3, on_failure="nan")
        assert np.isnan(col.left_out(impact).b.tyre_delta_v).all()


@pytest.mark.slow
@pytest.mark.parametrize("both", [False, True])
def test_tyres_that_a_central_model_leaves_out_of_solve_count(both):
    """What they change is what the eccentric model changes with them, not a multiple of it; each
    case of a batch with both models as alone.
    """
    tyres = {"tyres_a": col.travel.Tyres(0.7, 1.0, 2.6, 1.5)}
    tyres |= {"tyres_b": col.travel.Tyres(0.7, 1.0, 2.6, 1.5)} if both else {}
    b = col.Vehicle(mass=1250, yaw_inertia=1900, x=2.4, y=0.0, heading=0.0)
    contact = {"restitution": 0.1, "friction": 0.5, "normal": 0.0, "point": (0.0, 0.0)}

    def struck(speed, y=0.0):
        a = col.Vehicle(mass=1540, yaw_inertia=2600, x=-2.4, y=y, heading=0.0, vx=speed)
        return a, col.solve(a, b, tolerance=1.5, duration=0.1, **tyres, **contact)

    a, impact = struck(6.0)
    assert impact.model == "linear_central"
    bare, held = (
        col.eccentric(a, b, **contact),
        col.eccentric(a, b, duration=0.1, **tyres, **contact),
    )
    left = col.left_out(impact)
    # The tyres of the one that is not given slide, and change no more than 0.7 g in 0.1 s.
    wanted = abs(bare.b.delta_v - held.b.delta_v)
    assert left.b.tyre_delta_v == pytest.approx(wanted, abs=0.02 if both else MOST)
    assert left.a.tyre_delta_v_bound == pytest.approx(MOST)
    rows = [move.what for move in col.diagnose(impact).moves if move.what.startswith("tyres")]
    assert rows == [
        "tyres as given, 0.1 s" if both else "tyres of B sliding 0.1 s, drag 0.7, others as given"
    ]
    _, many = struck(np.array([6.0, 25.0]), 0.6)
    assert many.model.tolist() == ["linear_central", "eccentric"]
    found = col.left_out(many)
    for i, speed in enumerate((6.0, 25.0)):
        alone = col.left_out(struck(speed, 0.6)[1])
        for name in ("tyre_delta_v", "tyre_delta_v_bound"):
            for label in "ab":
                one, other = (getattr(getattr(of, label), name) for of in (found, alone))
                assert one[i] == pytest.approx(other, rel=1e-9, abs=1e-12)
