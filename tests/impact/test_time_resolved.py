"""``time_resolved``: against closed forms, other integrations, balances and limits; batches,
records and every refusal.
"""

import contextlib
import json
import math
import pickle
import random
import re
import warnings

import numpy as np
import pint
import pytest

import collisions as col
from collisions import plot
from collisions.travel import GRAVITY

WALL = col.Vehicle.barrier()
STRAIGHT = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5}
A = {"mass": 1500.0, "yaw_inertia": 2600.0, "vx": 20.0, "x": -2.2, "y": 0.0, "heading": 0.0}
B = {"mass": 1200.0, "yaw_inertia": 2100.0, "vy": 10.0, "x": 0.8, "y": -1.0, "heading": math.pi / 2}


def t_bone(restitution=0.1, a=None, b=None, **changes):
    """A car that strikes the side of another, which crosses."""
    contact = {**STRAIGHT, "duration": 0.1, "drag": 0.7, **changes}
    return col.time_resolved(a or col.Vehicle(**A), b or col.Vehicle(**B), restitution, **contact)


def scenes(count, seed, frictions=(0.2, 0.5, 0.8)):
    """Random impacts of two cars: vehicles, restitution and contact."""
    rng = random.Random(seed)
    found = []
    while len(found) < count:
        normal = rng.uniform(-math.pi, math.pi)
        n = math.cos(normal), math.sin(normal)
        bodies = []
        for sign in (-1.0, 1.0):
            along, across = (
                -sign * rng.uniform(0.0, 14.0),
                rng.uniform(-8.0, 8.0) * rng.choice([0.0, 0.3, 1.0]),
            )
            reach, lever = sign * rng.uniform(0.6, 2.2), rng.uniform(-1.0, 1.0)
            mass = rng.uniform(900.0, 2200.0)
            (vx, vy), (x, y) = (
                (u * n[0] - v * n[1], u * n[1] + v * n[0])
                for u, v in ((along, across), (reach, lever))
            )
            inertia, heading = mass * rng.uniform(1.2, 2.0), rng.uniform(-math.pi, math.pi)
            bodies.append(
                col.Vehicle(mass=mass, yaw_inertia=inertia, vx=vx, vy=vy, x=x, y=y, heading=heading)
            )
        e, contact = (
            rng.uniform(0.0, 0.4),
            {"normal": normal, "point": (0.0, 0.0), "friction": rng.choice(frictions)},
        )
        if col.eccentric(*bodies, e, **contact, on_failure="nan").closing_speed > 2.0:
            found.append((*bodies, e, contact))
    return found


def random_pair(random, n):
    """Cars that mostly meet, as two batches."""

    def cars(side):
        return col.Vehicle(
            mass=random.uniform(900.0, 2500.0, n),
            yaw_inertia=random.uniform(1200.0, 4500.0, n),
            x=side * random.uniform(1.0, 2.4, n),
            y=random.uniform(-1.2, 1.2, n),
            heading=random.uniform(-3.0, 3.0, n),
            vx=-side * random.uniform(-2.0, 20.0, n),
            vy=random.uniform(-12.0, 12.0, n),
            yaw_rate=random.uniform(-2.0, 2.0, n),
        )

    return cars(-1.0), cars(1.0)


def change(impact):
    """The change of both motions as one vector, in m/s: the yaw rates by the radii of gyration."""
    found = []
    for side in (impact.a, impact.b):
        radius = math.sqrt(side.before.yaw_inertia / side.before.mass)
        found += [side.delta_vx, side.delta_vy, radius * side.delta_yaw_rate]
    return np.array(found)


def off(one, other):
    """How far two changes are apart, in the size of the second."""
    return np.linalg.norm(one - other) / np.linalg.norm(other)


# Against a fixed wall in line: closed forms. The error of the steps is (w h)^2 / 24 of them, twice
# that for a sum of both halves; h is 1/100 of (1 + e) pi/2 / w, so 1e-4 holds for every e; a
# quarter of it with twice the steps.


@pytest.mark.parametrize("restitution", [0.0, 1e-3, 0.05, 0.3, 0.7, 1.0])
@pytest.mark.parametrize("geometry", ["maximum_engagement", "first_contact", "fixed"])
def test_a_linear_spring_against_a_barrier(restitution, geometry):
    """Half a sine that falls e times as fast: x = c sqrt(m/k), F = c sqrt(k m), T = (1 + e) pi/2
    sqrt(m/k), v' = e c.
    """
    mass, speed, stiffness = 1500.0, 10.0, 400e3
    car = col.Vehicle(mass=mass, yaw_inertia=2600.0, vx=speed, x=-2.0, y=0.0)
    errors = []
    for steps in (100, 200):
        impact = col.time_resolved(
            car, WALL, restitution, **STRAIGHT, stiffness=stiffness, geometry=geometry, steps=steps
        )
        pulse = impact.pulse
        frequency = math.sqrt(stiffness / mass)
        errors.append(
            [
                pulse.max_crush * frequency / speed - 1.0,
                pulse.peak_force / (speed * mass * frequency) - 1.0,
                pulse.duration * frequency / ((1.0 + restitution) * math.pi / 2) - 1.0,
                (impact.separation_speed - restitution * speed) / speed,
                impact.energy_loss / (0.5 * (1.0 - restitution**2) * mass * speed**2) - 1.0
                if restitution < 1.0
                else 0.0,
                pulse.peak_acceleration_a * mass / pulse.peak_force - 1.0,
            ]
        )
    first, second = np.abs(errors)
    assert first.max() < 6e-4
    # The largest acceleration is a sample, which may lie up to half a step off.
    assert np.all(second[:-1] <= first[:-1] / 3.5 + 3e-6)
    assert impact.kind == {0.0: "plastic", 1.0: "elastic"}.get(restitution, "elastoplastic")
    assert impact.compression_impulse == pytest.approx(mass * speed, rel=1e-4)
    assert impact.energy_absorbed == pytest.approx(0.5 * mass * speed**2, rel=2e-4)
    assert impact.common_velocity == pytest.approx(0.0, abs=1e-9 * speed)


def test_a_duration_is_that_of_the_two_bodies_with_their_levers():
    """Without friction and motion a spring swings with the effective mass along the normal: the
    contact takes as long as was given, and the largest force is that of its sine.
    """
    a = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, x=-2.0, y=0.3, heading=0.0, vx=15.0)
    b = col.Vehicle(mass=1200.0, yaw_inertia=1800.0, x=1.8, y=-1.2, heading=0.5, vx=-3.0)
    e, duration, normal = 0.3, 0.1, 0.2
    contact = {"normal": normal, "point": (0.0, 0.0), "friction": 0.0, "geometry": "fixed"}
    found = col.time_resolved(a, b, e, **contact, duration=duration)
    levers = [(0.0 - one.x) * math.sin(normal) - (0.0 - one.y) * math.cos(normal) for one in (a, b)]
    yields = sum(
        1.0 / one.mass + lever**2 / one.yaw_inertia
        for one, lever in zip((a, b), levers, strict=True)
    )
    # The same bounds as for a car against a barrier.
    assert found.pulse.duration == pytest.approx(duration, rel=6e-5)
    frequency = (1.0 + e) * math.pi / 2.0 / duration
    most = 18.0 * math.cos(normal) * frequency / yields
    assert found.pulse.peak_force == pytest.approx(most, rel=6e-5)
    points = 1.0 / (1.0 / a.mass + 1.0 / b.mass)
    # With the spring of point masses it would not.
    stiff = col.time_resolved(a, b, e, **contact, stiffness=points * frequency**2).pulse
    assert stiff.duration == pytest.approx(duration / math.sqrt(points * yields), rel=6e-5)


def test_crash_stiffness_against_a_barrier():
    """The worked case: 1500 kg at 15.6 m/s, A 60 kN/m, B 700 kN/m2, 1.5 m wide: 0.590 m, 42.1 g,
    65.3 ms; and closed forms.

    Loading is a line through the origin, F = w B x, so x = c sqrt(m/(w B)); A/B of it is given back
    and is not on the car.
    """
    mass, speed, e, growth = 1500.0, 15.6, 0.1, 700e3 * 1.5
    car = col.Vehicle(mass=mass, yaw_inertia=2600.0, vx=speed, x=-2.0, y=0.0)
    crush_a = ("60 kN/m", "700 kN/m**2", "1.5 m")
    found = col.time_resolved(car, WALL, e, **STRAIGHT, crush_a=crush_a).pulse
    assert found.max_crush == pytest.approx(0.590, abs=5e-4)
    assert found.peak_acceleration_a == pytest.approx(42.1 * GRAVITY, abs=0.05 * GRAVITY)
    assert found.duration == pytest.approx(0.0653, abs=5e-5)
    deepest = speed * math.sqrt(mass / growth)
    back = (growth * deepest) ** 2 / (e**2 * mass * speed**2)
    # The same bound as for the linear spring: a quarter of the same sine.
    assert found.max_crush == pytest.approx(deepest, rel=6e-5)
    assert found.peak_force == pytest.approx(growth * deepest, rel=6e-5)
    time = math.pi / 2 * (math.sqrt(mass / growth) + math.sqrt(mass / back))
    assert found.duration == pytest.approx(time, rel=6e-5)
    assert found.residual_crush_a == pytest.approx(deepest - 60.0 / 700.0, rel=1e-4)
    assert found.residual_crush == found.residual_crush_a
    assert found.residual_crush_b is None
    assert found.q.residual_crush_a.m_as("cm") == pytest.approx(100.0 * found.residual_crush_a)


@pytest.mark.parametrize("speed", [1.0, 2.0, 2.3, 5.0, 15.6, 30.0])
def test_crash_stiffness_takes_up_the_crush_energy(speed):
    """What is absorbed is ``crush_energy`` of the crush that is left; below A/B nothing is left,
    and the pulse says 0.
    """
    car = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=speed, x=-2.0, y=0.0)
    impact = col.time_resolved(car, WALL, 0.1, **STRAIGHT, crush_a=(60e3, 700e3, 1.5))
    left = impact.pulse.residual_crush_a
    assert impact.energy_absorbed == pytest.approx(0.5 * 1500.0 * speed**2, rel=2e-4)
    if speed * math.sqrt(1500.0 / (1.5 * 700e3)) < 60.0 / 700.0:
        assert left == impact.pulse.residual_crush == 0.0
        assert "none: the force stays below that which leaves some" in col.report(
            impact, form="markdown"
        )
    else:
        assert left == pytest.approx(impact.pulse.max_crush - 60.0 / 700.0, rel=1e-12)
        energy = col.reconstruct.crush_energy(1.5, [left, left], 60e3, 700e3)
        assert impact.energy_absorbed == pytest.approx(energy, rel=1e-12)


def test_two_crush_stiffnesses_in_series():
    """Two equal cars head on: each as against a barrier at its own speed. A rigid car: the other
    gives way alone.

    And different ones: at the common force each has the crush and the energy of ``crush_energy``.
    """
    crush = (60e3, 700e3, 1.5)
    car = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=15.6, x=-2.0, y=0.0)
    other = car.replace(vx=-15.6, x=2.0)
    alone = col.time_resolved(car, WALL, 0.1, **STRAIGHT, crush_a=crush).pulse
    both = col.time_resolved(car, other, 0.1, **STRAIGHT, crush_a=crush, crush_b=crush).pulse
    assert both.max_crush == pytest.approx(2.0 * alone.max_crush, rel=1e-9)
    assert both.peak_force == pytest.approx(alone.peak_force, rel=1e-9)
    assert both.duration == pytest.approx(alone.duration, rel=1e-9)
    assert (
        both.residual_crush_a
        == both.residual_crush_b
        == pytest.approx(alone.residual_crush, rel=1e-9)
    )
    by_other = col.time_resolved(WALL, other, 0.1, **STRAIGHT, crush_b=crush).pulse
    assert by_other.duration == pytest.approx(alone.duration, rel=1e-9)
    assert by_other.residual_crush_a is None

    softer = (20e3, 300e3, 1.2)
    impact = col.time_resolved(
        car, other.replace(mass=1000.0), 0.1, **STRAIGHT, crush_a=crush, crush_b=softer
    )
    pulse = impact.pulse
    most, crushes, work = pulse.peak_force, [], []
    for (force, growth, width), left in zip(
        (crush, softer), (pulse.residual_crush_a, pulse.residual_crush_b), strict=True
    ):
        crushes.append(most / (growth * width))
        assert left == pytest.approx(crushes[-1] - force / growth, rel=1e-12)
        work.append(col.reconstruct.crush_energy(width, [left, left], force, growth))
    assert sum(crushes) == pytest.approx(pulse.max_crush, rel=1e-12)
    assert pulse.residual_crush == pulse.residual_crush_a + pulse.residual_crush_b
    assert sum(work) == pytest.approx(0.5 * 600.0 * 31.2**2, rel=2e-4)
    assert sum(work) == pytest.approx(impact.energy_absorbed, rel=1e-12)
    speeds = np.array([31.2, 1.0])
    many = col.time_resolved(
        car.replace(vx=speeds - 15.6),
        other.replace(mass=1000.0),
        0.1,
        **STRAIGHT,
        crush_a=crush,
        crush_b=softer,
    )
    assert many.pulse.residual_crush_b[0] == pytest.approx(pulse.residual_crush_b, rel=1e-9)
    assert many.pulse.residual_crush[1] == 0.0
    assert many.to_columns()["pulse.residual_crush_a"] == many.pulse.residual_crush_a.tolist()


def test_no_crush_that_is_left_and_no_work_of_tyres_are_zeros_without_a_sign():
    """Alone, in a batch, and with a unit; a case without an answer stays NaN."""
    car = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=1.0, x=-2.0, y=0.0)
    crush = {"crush_a": (60e3, 700e3, 1.5)}
    one = col.time_resolved(car, WALL, 0.1, **STRAIGHT, **crush)
    many = col.time_resolved(
        car.replace(vx=np.array([1.0, 2.0, -1.0])), WALL, 0.1, **STRAIGHT, **crush,
        on_failure="nan",
    )  # fmt: skip
    for found in (one.pulse.residual_crush_a, one.pulse.residual_crush, one.a.tyre_loss):
        assert math.copysign(1.0, found) == 1.0
        assert found == 0.0
    assert str(one.pulse.q.residual_crush_a.magnitude) == "0.0"
    for name in ("pulse.residual_crush_a", "pulse.residual_crush", "a.tyre_loss"):
        column = many.to_columns()[name]
        assert [str(value) for value in column[:2]] == ["0.0", "0.0"]
        assert math.isnan(column[2])


@pytest.mark.parametrize(
    ("width", "worst"),
    [(60, 60), (10.1, 10.1), (np.array([1.5, 60.0]), 60), (9.9, None), ("60 in", None),
     ("60 m", None)],
)  # fmt: skip
def test_a_bare_width_of_crush_is_suspected_as_that_of_a_profile_is(width, worst):
    """One limit for both: what ``crush_energy`` takes for another unit, this does too."""
    car = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=10.0, x=-2.0, y=0.0)
    crush = 60e3, 700e3, width

    def suspected(solve):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            solve()
        return [one.message for one in caught if one.message.code == "suspect_units"]

    found = suspected(lambda: col.time_resolved(car, WALL, 0.1, **STRAIGHT, crush_a=crush))
    of_profile = suspected(
        lambda: col.reconstruct.crush_energy(
            [width] if isinstance(width, np.ndarray) else width, [0.3, 0.3], 60e3, 700e3
        )
    )
    assert [one.fields["value"] for one in found] == [one.fields["value"] for one in of_profile]
    assert [one.fields["value"] for one in found] == ([] if worst is None else [worst])
    for one in found:
        assert str(one) == (
            f"crush_a[2] = {worst:g} is read as metres of width; if another unit was meant, write "
            f"'{worst:g} cm' or '{worst:g} in'"
        )
    of_b = {"crush_b": crush, "crush_a": (60e3, 700e3, 1.5)}
    other = car.replace(x=2.0, vx=0.0)
    found = suspected(lambda: col.time_resolved(car, other, 0.1, **STRAIGHT, **of_b))
    assert [one.fields["argument"] for one in found] == ([] if worst is None else ["crush_b[2]"])


@pytest.mark.parametrize("vehicle", ["a", "b"])
def test_bare_stiffness_of_a_table_in_pounds_and_inches_is_suspected(vehicle):
    """As that of ``crush_energy`` is."""
    car = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=10.0, x=-2.0, y=0.0)
    other = car.replace(x=2.0, vx=0.0)
    crush = {"crush_a": ("60 kN/m", "700 kN/m**2", 1.5)}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        crush[f"crush_{vehicle}"] = (250, 50.0, "1.5 m")
        # A car as soft as that does not come to a stop within its contact.
        with contextlib.suppress(col.NoSolutionError):
            col.time_resolved(car, other, 0.1, **STRAIGHT, **crush)
    assert [str(one.message) for one in caught if one.message.code == "suspect_units"] == [
        f"crush_{vehicle}[0] = 250 is read as N/m, softer than any car; if another unit was "
        "meant, write '250 lbf/in' or '250 N/cm'",
        f"crush_{vehicle}[1] = 50 is read as N/m**2, softer than any car; if another unit was "
        "meant, write '50 lbf/in**2' or '50 N/cm**2'",
    ]


@pytest.mark.parametrize(
    "stated",
    [{"duration": "1.2 s"}, {"duration": np.array([1.2, 1.3])}, {"stiffness": "800 N/m"},
     {"crush_a": ("800 N/m", "900 N/m**2", "60 m")}],
)  # fmt: skip
def test_again_suspects_no_number_that_has_its_unit(stated):
    """It is the same number, with the unit that it was given with."""
    car = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=10.0, x=-2.0, y=0.0)
    with warnings.catch_warnings(record=True) as first:
        warnings.simplefilter("always")
        impact = col.time_resolved(car, WALL, 0.1, **STRAIGHT, **stated, on_failure="nan")
    with warnings.catch_warnings(record=True) as again:
        warnings.simplefilter("always")
        impact.again(restitution=0.2)
    codes = [[one.message.code for one in caught] for caught in (first, again)]
    bare = isinstance(stated.get("duration"), np.ndarray)
    assert [found.count("suspect_units") for found in codes] == [bare, bare]


@pytest.mark.parametrize("geometry", ["fixed", "maximum_engagement", "first_contact"])
@pytest.mark.parametrize("pull", [{}, {"drag": 0.6}], ids=str)
def test_the_arm_times_the_impulse_is_the_moment_that_came_about(geometry, pull):
    """By the yaw rates before and after, where the point moves on too; and in a batch."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.1, y=0.0, heading=0.0, vx=15.0)
    b = col.Vehicle(mass=1250.0, yaw_inertia=1900.0, x=0.9, y=-0.4, heading=math.pi / 2, vy=11.0)
    contact = {"normal": 0.0, "point": (0.0, 0.3), "friction": 0.5, "duration": 0.1, **pull}
    impact = col.time_resolved(a, b, 0.1, geometry=geometry, **contact)
    stays = col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.3), friction=0.5)
    for side in (impact.a, impact.b):
        turned = side.after.yaw_rate - side.before.yaw_rate
        moment = side.before.yaw_inertia * turned - side.tyre_moment
        size = math.hypot(side.impulse_x, side.impulse_y)
        assert side.moment_arm * size == pytest.approx(moment, rel=1e-9)
        k2 = side.before.yaw_inertia / side.before.mass
        assert side.gamma == pytest.approx(k2 / (k2 + side.moment_arm**2), rel=1e-12)
    # A contact that moves on has another arm than that of its point.
    moved = abs(impact.a.moment_arm - stays.a.moment_arm) > 0.04 * abs(stays.a.moment_arm)
    assert moved == (geometry != "fixed")
    stiff = a.replace(yaw_inertia=np.array([2500.0, math.inf]))
    many = col.time_resolved(stiff, b, 0.1, geometry=geometry, **contact)
    assert many.a.moment_arm[0] == pytest.approx(impact.a.moment_arm, rel=1e-6)
    assert np.isfinite(many.a.moment_arm[1])
    assert many.a.gamma[1] == 1.0


def test_of_a_batch_of_solve_an_impulse_has_its_arm_at_the_point():
    """Also beside cases that were followed in time."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.1, y=0.0, heading=0.0, vx=6.0)
    b = col.Vehicle(mass=1250.0, yaw_inertia=1900.0, x=0.9, y=0.4, heading="90 deg", vy=3.0)
    contact = {"normal": 0.0, "point": (0.0, 0.1), "friction": 0.3, "duration": 0.1}
    accepted = np.array([0.0, 1.0, 50.0])
    many = col.solve(a, b, 0.1, tolerance=accepted, **contact)
    assert len(set(many.model)) == 3
    for index, limit in enumerate(accepted):
        one = col.solve(a, b, 0.1, tolerance=limit, **contact)
        for mine, alone in ((many.a, one.a), (many.b, one.b)):
            assert mine.moment_arm[index] == pytest.approx(alone.moment_arm, rel=1e-7)
            assert mine.gamma[index] == pytest.approx(alone.gamma, rel=1e-7)


# Fixed geometry without tyres: energetic restitution


def by_events(a, b, e, normal, point, friction):
    """The impact with energetic restitution from one event to the next along the normal impulse: no
    steps, no law.

    The slip, the closing speed and its work are polynomials of the normal impulse between the
    events.
    """
    n = np.array([math.cos(normal), math.sin(normal)])
    t = np.array([-n[1], n[0]])
    arms = [np.array(point) - np.array([body.x, body.y]) for body in (a, b)]
    mobility = np.zeros((2, 2))
    velocity = np.zeros(2)
    for body, arm, sign in zip((a, b), arms, (-1.0, 1.0), strict=True):
        lever = np.array([n @ np.array([-arm[1], arm[0]]), t @ np.array([-arm[1], arm[0]])])
        mobility += np.eye(2) / body.mass + np.outer(lever, lever) / body.yaw_inertia
        velocity += sign * (
            np.array([n @ [body.vx, body.vy], t @ [body.vx, body.vy]]) + body.yaw_rate * lever
        )
    impulse, work, absorbed = np.zeros(2), 0.0, None
    for _ in range(20):
        hold = -mobility[0, 1] / mobility[1, 1]
        if abs(velocity[1]) > 1e-12:
            ratio = -friction * math.copysign(1.0, velocity[1])
        else:
            velocity[1] = 0.0
            ratio = hold if abs(hold) <= friction else math.copysign(friction, hold)
        rate = mobility @ [1.0, ratio]
        ends = []
        if velocity[1] * rate[1] < 0.0:
            ends.append(-velocity[1] / rate[1])
        if absorbed is None:
            if rate[0] > 0.0:
                ends.append(-velocity[0] / rate[0])
        else:
            # work + v p + rate p^2/2 = (1 - e^2) absorbed, from above: the work taken falls.
            left = work - (1.0 - e**2) * absorbed
            ends.append(
                (-velocity[0] + math.sqrt(velocity[0] ** 2 + 2.0 * rate[0] * left)) / rate[0]
            )
        step = min(ends)
        work -= velocity[0] * step + 0.5 * rate[0] * step**2
        impulse = impulse + step * np.array([1.0, ratio])
        velocity = velocity + step * rate
        if absorbed is None and abs(velocity[0]) < 1e-12:
            absorbed, velocity[0] = work, 0.0
            if e == 0.0:
                break
        elif absorbed is not None and abs(work - (1.0 - e**2) * absorbed) < 1e-9 * absorbed:
            break
    found = []
    for body, arm, sign in zip((a, b), arms, (-1.0, 1.0), strict=True):
        push = sign * (impulse[0] * n + impulse[1] * t)
        spin = (arm[0] * push[1] - arm[1] * push[0]) / body.yaw_inertia
        found += [*(push / body.mass), math.sqrt(body.yaw_inertia / body.mass) * spin]
    return np.array(found), velocity


@pytest.mark.slow
def test_from_event_to_event_is_the_law():
    """law="stronge" to the rounding of the other way, which looks for its end by a square root:
    1e-12, half of them to 1e-14.
    """
    errors, regimes = [], set()
    for a, b, e, contact in scenes(400, 12, (0.05, 0.2, 0.5, 0.8, 1.5)):
        law = col.eccentric(a, b, e, **contact, law="stronge")
        errors.append(off(change(law), by_events(a, b, e, **contact)[0]))
        regimes.add(law.regime)
    assert np.median(errors) < 1e-14
    assert max(errors) < 1e-12
    assert regimes == {"sliding", "sticking", "reversing"}


@pytest.mark.slow
def test_fixed_geometry_is_energetic_restitution():
    """At second order: 3e-5 (median) at 100 steps, a quarter at 200; sliding, sticking and
    reversing; whatever the stiffness.
    """
    errors, regimes = [], set()
    for a, b, e, contact in scenes(60, 3, (0.05, 0.2, 0.5, 0.8, 1.5)):
        wanted, velocity = by_events(a, b, e, **contact)
        found = [
            col.time_resolved(a, b, e, **contact, geometry="fixed", steps=steps, duration=0.1)
            for steps in (100, 200, 400)
        ]
        errors.append([off(change(one), wanted) for one in found])
        regimes.add(found[2].regime)
        law = col.eccentric(a, b, e, **contact, law="stronge")
        assert off(change(found[1]), change(law)) < 1e-5
        # Without slip before, which way it goes is rounding.
        assert found[1].regime == law.regime or abs(law.slip_before) < 1e-12
        assert found[2].separation_speed == pytest.approx(
            velocity[0], abs=1e-3 * found[2].closing_speed
        )
        stiffer = col.time_resolved(a, b, e, **contact, geometry="fixed", stiffness=1e9)
        assert off(change(stiffer), change(found[0])) < 1e-9
    first, second, third = np.median(errors, axis=0)
    assert first < 5e-5
    assert second < first / 3.5
    assert third < second / 3.5
    # A slip that stops or turns within a step costs no order.
    assert np.max(errors, axis=0)[2] < 2e-5
    assert regimes == {"sliding", "sticking", "reversing"}


# Moving geometry and tyres


class Apart:
    """The same contact as ordinary differential equations in the road plane, by Runge and Kutta's
    fourth order.

    Complex numbers are vectors. Only for contacts that slide one way throughout, on wheels that
    never stop: then nothing in the equations is rough but the end of compression, which is found by
    halving the last step, as is the end.
    """

    def __init__(self, a, b, e, contact, stiffness, drag):
        self.bodies, self.e, self.mu, self.k, self.drag = (
            (a, b),
            e,
            contact["friction"],
            stiffness,
            drag,
        )
        self.normal = complex(math.cos(contact["normal"]), math.sin(contact["normal"]))
        point = complex(*contact["point"])
        self.on = [point - complex(body.x, body.y) for body in (a, b)]
        self.wheels = [
            [
                complex(ahead, left) * complex(math.cos(body.heading), math.sin(body.heading))
                for ahead in (1.35, -1.35)
                for left in (0.75, -0.75)
            ]
            for body in (a, b)
        ]
        self.deepest, self.slowest = None, math.inf
        self.start = [
            part
            for body in (a, b)
            for part in (complex(body.vx, body.vy), body.yaw_rate, complex(body.x, body.y), 0.0)
        ]

    def contact(self, state):
        va, wa, xa, ta, vb, wb, xb, tb = state[:8]
        turns = complex(math.cos(ta), math.sin(ta)), complex(math.cos(tb), math.sin(tb))
        point = 0.5 * (xa + turns[0] * self.on[0] + xb + turns[1] * self.on[1])
        normal = self.normal * complex(math.cos(0.5 * (ta + tb)), math.sin(0.5 * (ta + tb)))
        relative = (vb + 1j * wb * (point - xb) - va - 1j * wa * (point - xa)) / normal
        return turns, point, normal, -relative.real, relative.imag

    def force(self, crush):
        if self.deepest is None:
            return self.k * crush
        return self.k / self.e**2 * (crush - (1.0 - self.e**2) * self.deepest)

    def rates(self, state):
        turns, point, normal, closing, slip = self.contact(state)
        push = self.force(state[8]) * complex(1.0, -math.copysign(self.mu, slip)) * normal
        found = []
        for body, turn, wheels, sign, (v, w, x, _) in zip(
            self.bodies, turns, self.wheels, (-1.0, 1.0), (state[:4], state[4:8]), strict=True
        ):
            arm = point - x
            force, moment = sign * push, sign * (arm.real * push.imag - arm.imag * push.real)
            for wheel in wheels:
                place = turn * wheel
                speed = v + 1j * w * place
                self.slowest = min(self.slowest, abs(speed))
                held = -0.25 * self.drag * GRAVITY * body.mass * speed / abs(speed)
                force, moment = (
                    force + held,
                    moment + place.real * held.imag - place.imag * held.real,
                )
            found += [force / body.mass, moment / body.yaw_inertia, v, w]
        return [*found, closing]

    def step(self, state, h):
        def moved(rates, by):
            return [part + by * rate for part, rate in zip(state, rates, strict=True)]

        one = self.rates(state)
        two = self.rates(moved(one, 0.5 * h))
        three = self.rates(moved(two, 0.5 * h))
        four = self.rates(moved(three, h))
        return moved(
            [
                (p + 2 * q + 2 * r + s) / 6.0
                for p, q, r, s in zip(one, two, three, four, strict=True)
            ],
            h,
        )

    def until(self, state, h, ended):
        while not ended(after := self.step(state, h)):
            state = after
        low, high = 0.0, h
        while high - low > 1e-13:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if ended(self.step(state, middle)) else (middle, high)
        return self.step(state, high)

    def run(self, h):
        """Maximum engagement, and the end."""
        engaged = self.until([*self.start, 0.0], h, lambda state: self.contact(state)[3] <= 0.0)
        self.deepest = engaged[8]
        return engaged, self.until(engaged, h * self.e, lambda state: self.force(state[8]) <= 0.0)


def car(mass, vx, vy, x, y, heading):
    """A car with the yaw inertia of one."""
    return col.Vehicle(mass=mass, yaw_inertia=1.7 * mass, vx=vx, vy=vy, x=x, y=y, heading=heading)


SLIDING = {
    "sideswipe": (
        car(1500.0, 25.0, 4.0, -1.2, -1.0, 0.15),
        car(1300.0, 15.0, 0.0, 0.8, 1.0, 0.0),
        0.2,
        math.pi / 2,
        0.2,
    ),
    "t_bone": (
        car(1500.0, 20.0, 0.0, -2.2, 0.2, 0.0),
        car(1200.0, 0.0, 12.0, 0.8, -0.6, math.pi / 2),
        0.1,
        0.3,
        0.1,
    ),
    "oblique": (
        car(1800.0, 16.0, 3.0, -1.9, 0.6, 0.2),
        car(1100.0, -9.0, -9.0, 1.7, -0.4, -2.4),
        0.4,
        -0.2,
        0.05,
    ),
}


@pytest.mark.parametrize("name", SLIDING)
def test_against_an_independent_integration(name):
    """With tyres and moving geometry, at second order; extrapolated from 200 and 400 steps it
    agrees to 1e-6.

    And maximum engagement: from places that the other integration reached, the start is found from
    which it came.
    """
    a, b, e, normal, friction = SLIDING[name]
    contact = {"normal": normal, "point": (0.0, 0.0), "friction": friction}
    apart = Apart(a, b, e, contact, 1e6, 0.7)
    engaged, end = apart.run(2e-4)
    wanted = []
    for at, body in ((0, a), (4, b)):
        dv = end[at] - complex(body.vx, body.vy)
        wanted += [
            dv.real,
            dv.imag,
            math.sqrt(body.yaw_inertia / body.mass) * (end[at + 1] - body.yaw_rate),
        ]
    wanted = np.array(wanted)
    once, twice = (
        change(
            col.time_resolved(
                a, b, e, **contact, geometry="first_contact", stiffness=1e6, drag=0.7, steps=steps
            )
        )
        for steps in (200, 400)
    )
    assert apart.slowest > 0.5
    assert apart.contact(engaged)[4] * apart.contact(end)[4] > 0.0
    assert off(twice, wanted) < 2e-5
    assert off(twice, wanted) < off(once, wanted) / 3.0
    assert off((4.0 * twice - once) / 3.0, wanted) < 1e-6

    _, point, normal, *_ = apart.contact(engaged)
    moved = [
        body.replace(
            x=engaged[at + 2].real, y=engaged[at + 2].imag, heading=body.heading + engaged[at + 3]
        )
        for at, body in ((0, a), (4, b))
    ]
    place = {
        "normal": math.atan2(normal.imag, normal.real),
        "point": (point.real, point.imag),
        "friction": contact["friction"],
    }
    found = col.time_resolved(*moved, e, **place, stiffness=1e6, drag=0.7, steps=800)
    assert off(change(found), wanted) < 1e-5
    assert found.pulse.max_crush == pytest.approx(engaged[8], rel=5e-6)
    # The state at the end of compression is that of the places given.
    for side, at in ((found.a, 0), (found.b, 4)):
        assert abs(complex(side.at_compression.vx, side.at_compression.vy) - engaged[at]) < 1e-3
        assert side.at_compression.yaw_rate == pytest.approx(engaged[at + 1], abs=1e-3)


@pytest.mark.parametrize("geometry", ["maximum_engagement", "first_contact", "fixed"])
@pytest.mark.parametrize("drag", [0.0, 0.7])
def test_momentum_and_energy_balance(geometry, drag):
    """To rounding: momenta with the tyres, kinetic energies with both losses; friction, tyres and
    spring only take.
    """
    for a, b, e, contact in scenes(8, 5):
        impact = col.time_resolved(a, b, e, **contact, geometry=geometry, duration=0.1, drag=drag)
        size = math.hypot(impact.normal_impulse, impact.tangential_impulse)
        assert impact.momentum_residual < 1e-13 * size
        energies = [
            0.5 * state.mass * state.speed**2 + 0.5 * state.yaw_inertia * state.yaw_rate**2
            for side in (impact.a, impact.b)
            for state in (side.before, side.after)
        ]
        lost = energies[0] - energies[1] + energies[2] - energies[3]
        tyres = impact.a.tyre_loss + impact.b.tyre_loss
        assert impact.energy_loss + tyres == pytest.approx(lost, abs=1e-12 * max(energies))
        for side, (before, after) in ((impact.a, energies[:2]), (impact.b, energies[2:])):
            assert side.kinetic_energy_change == pytest.approx(
                after - before, abs=1e-12 * max(energies)
            )
        assert impact.energy_loss_normal >= 0.0
        # Where a contact that sticks is carried on, its slip is 0 but for the error of the steps.
        assert impact.energy_loss_tangential >= -1e-4 * impact.energy_loss
        assert min(impact.a.tyre_loss, impact.b.tyre_loss) >= 0.0
        # Energetic restitution is exact in the limit of small steps only.
        assert impact.energy_loss_normal == pytest.approx(
            (1.0 - e**2) * impact.energy_absorbed, rel=3e-3
        )
        assert (tyres == 0.0) == (drag == 0.0)
        assert impact.compression_impulse + impact.restitution_impulse == pytest.approx(
            impact.normal_impulse, rel=1e-12
        )


@pytest.mark.slow
def test_a_short_contact_is_the_impulse():
    """With tyres and motion it comes to energetic restitution in proportion to the duration.

    The design has 21 % at 0.1 s and 0.22 % at 1 ms; these scenes, which do not turn before, are
    nearer.
    """
    far = []
    for a, b, e, contact in scenes(25, 8):
        wanted, _ = by_events(a, b, e, **contact)
        impacts = [
            col.time_resolved(
                a, b, e, **contact, geometry="first_contact", duration=duration, drag=0.7
            )
            for duration in (1e-2, 1e-3, 1e-4)
        ]
        far.append([off(change(one), wanted) for one in impacts])
    tenth, hundredth, thousandth = np.median(far, axis=0)
    assert hundredth == pytest.approx(tenth / 10.0, rel=0.25)
    assert thousandth == pytest.approx(hundredth / 10.0, rel=0.25)
    assert hundredth < 2.2e-3


def test_tyres_by_hand():
    """A rear-end impact on locked wheels: each car loses 0.7 g t; one wheel's worth at the centre
    where there is no heading.

    A car at rest that nothing moves keeps at rest; one beside the line of the impulse is turned
    less with its wheels.
    """
    a, b = col.Vehicle(**A | {"vx": 8.0}), col.Vehicle(**A | {"vx": 5.0, "x": 2.2})
    impact = col.time_resolved(a, b, 0.4, **STRAIGHT, duration=0.1, drag=0.7)
    bare = col.time_resolved(
        a.replace(heading=None), b.replace(heading=None), 0.4, **STRAIGHT, duration=0.1, drag=0.7
    )
    for side, same in ((impact.a, bare.a), (impact.b, bare.b)):
        assert side.tyre_impulse_x == pytest.approx(
            -1500.0 * 0.7 * GRAVITY * impact.pulse.duration, rel=1e-12
        )
        assert side.tyre_impulse_x == pytest.approx(same.tyre_impulse_x, rel=1e-12)
        assert side.delta_vx == pytest.approx(
            (side.impulse_x + side.tyre_impulse_x) / 1500.0, rel=1e-12
        )
    # Against the wall the tyres lower the peak, and the wall takes none.
    held = col.time_resolved(a, WALL, 0.1, **STRAIGHT, duration=0.1, drag=0.7)
    free = col.time_resolved(a, WALL, 0.1, **STRAIGHT, duration=0.1)
    assert held.pulse.max_crush < free.pulse.max_crush
    assert held.b.tyre_loss == held.b.tyre_impulse_x == free.a.tyre_loss == 0.0
    turned = {
        "normal": 0.0,
        "point": (0.0, 0.7),
        "friction": 0.0,
        "duration": 0.1,
        "geometry": "fixed",
    }
    rates = [
        abs(col.time_resolved(a, b, 0.1, **turned, drag=drag).b.delta_yaw_rate)
        for drag in (0.0, 0.7)
    ]
    at_centre = col.time_resolved(a, b.replace(heading=None), 0.1, **turned, drag=0.7)
    assert rates[1] < 0.99 * rates[0]
    assert abs(at_centre.b.delta_yaw_rate) > 1.01 * rates[1]


def test_tyres_cannot_turn_a_motion_round():
    """A car that is hardly pushed stays: no chatter, no gain, whatever the drag; even of a light
    body with long axles.
    """
    a, b = (
        col.Vehicle(**A | {"vx": 0.3}),
        col.Vehicle(**A | {"vx": 0.0, "x": 2.2, "yaw_inertia": 60.0}),
    )
    for drag in (0.7, 1.4):
        impact = col.time_resolved(
            a,
            b,
            0.0,
            **STRAIGHT | {"point": (0.0, 0.3)},
            duration=0.1,
            drag=drag,
            wheelbase=6.0,
            geometry="first_contact",
        )
        assert 0.0 <= impact.b.after.vx < impact.a.before.vx
        assert impact.a.tyre_loss > 0.0
        assert impact.b.tyre_loss >= 0.0
        kinetic = 0.5 * 1500.0 * (0.3**2 - impact.a.after.speed**2 - impact.b.after.speed**2)
        assert impact.energy_loss + impact.a.tyre_loss + impact.b.tyre_loss == pytest.approx(
            kinetic
            - 0.5 * (2600.0 * impact.a.after.yaw_rate**2 + 60.0 * impact.b.after.yaw_rate**2),
            rel=1e-9,
        )


def test_mirrored_turned_and_exchanged_scenes():
    """The answer turns with the scene, is mirrored with it, and does not depend on who
    is called A.
    """
    impact = t_bone()
    wanted = change(impact)
    c, s = math.cos(1.0), math.sin(1.0)

    def turned(body):
        x, y, vx, vy = body.x, body.y, body.vx, body.vy
        return body.replace(
            x=c * x - s * y,
            y=s * x + c * y,
            vx=c * vx - s * vy,
            vy=s * vx + c * vy,
            heading=body.heading + 1.0,
        )

    a, b = impact.a.before, impact.b.before
    other = t_bone(a=turned(a), b=turned(b), normal=1.0)
    for side, was in ((other.a, impact.a), (other.b, impact.b)):
        assert side.delta_v == pytest.approx(was.delta_v, rel=1e-10)
        assert side.delta_yaw_rate == pytest.approx(was.delta_yaw_rate, rel=1e-9)
    mirrored = t_bone(
        a=a.replace(y=-a.y, vy=-a.vy, heading=-a.heading),
        b=b.replace(y=-b.y, vy=-b.vy, heading=-b.heading),
    )
    assert change(mirrored) == pytest.approx(wanted * [1, -1, -1, 1, -1, -1], rel=1e-10)
    exchanged = t_bone(a=b, b=a, normal=math.pi)
    assert change(exchanged) == pytest.approx([*wanted[3:], *wanted[:3]], rel=1e-9)
    assert exchanged.pulse.peak_acceleration_a == pytest.approx(
        impact.pulse.peak_acceleration_b, rel=1e-9
    )


@pytest.mark.parametrize("power", [-140, 140])
def test_answers_do_not_depend_on_the_unit(power):
    """Masses, lengths and times in other units, powers of 2 apart, give the same digits: from 1e-40
    to 1e40 of each.
    """
    impact = t_bone()
    for mass, length, time in ((power, 0, 0), (0, power, 0), (0, 0, -power), (power, power, power)):
        m, x, t = 2.0**mass, 2.0**length, 2.0**time
        scaled = [
            col.Vehicle(
                mass=body.mass * m,
                yaw_inertia=body.yaw_inertia * (m * x * x),
                vx=body.vx * (x / t),
                vy=body.vy * (x / t),
                x=body.x * x,
                y=body.y * x,
                heading=body.heading,
            )
            for body in (impact.a.before, impact.b.before)
        ]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.SuspectUnitsWarning)
            found = col.time_resolved(
                *scaled,
                0.1,
                **STRAIGHT,
                duration=0.1 * t,
                drag=0.7 * x / t**2,
                wheelbase=2.7 * x,
                track=1.5 * x,
            )
        for side, was in ((found.a, impact.a), (found.b, impact.b)):
            assert side.delta_vx == pytest.approx(was.delta_vx * (x / t), rel=1e-12)
            assert side.delta_vy == pytest.approx(was.delta_vy * (x / t), rel=1e-12)
        assert found.energy_loss == pytest.approx(
            impact.energy_loss * (m * x * x / (t * t)), rel=1e-12
        )


@pytest.mark.slow
@pytest.mark.parametrize("drag", [0.0, 0.7])
def test_how_near_the_start_is_found(monkeypatch, drag):
    """Against the start that leads to the places given to 1e-9: delta-V by 0.002 m/s in the median,
    0.03 at most.
    """
    kernel = "collisions.kernels.time_resolved"
    found = {}
    for near in (3e-3, 1e-9):
        monkeypatch.setattr(f"{kernel}._NEAR", near)
        found[near] = np.array(
            [
                [(side.delta_vx, side.delta_vy) for side in (impact.a, impact.b)]
                for a, b, e, contact in scenes(60, 21)
                for impact in [col.time_resolved(a, b, e, **contact, duration=0.1, drag=drag)]
            ]
        )
    apart = np.linalg.norm(found[3e-3] - found[1e-9], axis=2).max(axis=1)
    assert 0.0 < np.median(apart) < 0.002
    assert apart.max() < 0.03


# Batches, records, pictures


FIELDS = (
    "closing_speed",
    "separation_speed",
    "slip_before",
    "slip_after",
    "normal_impulse",
    "tangential_impulse",
)
FIELDS += (
    "compression_impulse",
    "common_velocity",
    "energy_loss",
    "energy_absorbed",
    "momentum_residual",
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("geometry", "stiffness"),
    [("maximum_engagement", "duration"), ("first_contact", "crush"), ("fixed", "stiffness")],
)
def test_a_batch_is_its_cases(geometry, stiffness):
    """Every number of every case as by itself, to 1e-9; refused ones are NaN, and their neighbours
    untouched.
    """
    speeds, drags = np.array([[3.0], [20.0], [-5.0]]), np.array([0.0, 0.7])
    kind = {
        "duration": {"duration": np.array([0.06, 0.12])},
        "stiffness": {"stiffness": np.array([5e5, 2e6])},
        "crush": {"crush_a": (6e4, np.array([7e5, 4e5]), 1.5), "crush_b": (3e4, 5e5, 1.4)},
    }[stiffness]
    a = col.Vehicle(**A | {"vx": speeds})
    contact = STRAIGHT | {"geometry": geometry}
    many = col.time_resolved(
        a, col.Vehicle(**B), 0.1, **contact, **kind, drag=drags, on_failure="nan"
    )
    assert many.status.shape == (3, 2)
    assert many.regime.tolist()[2] == ["", ""]
    assert many.pulse.time is None
    for i in range(2):
        for j in range(2):
            one = many.case((i, j))
            assert one.regime == many.regime[i, j]
            for name in FIELDS[:-1]:
                assert getattr(many, name)[i, j] == pytest.approx(
                    getattr(one, name), rel=1e-9, abs=1e-9
                ), name
            for name in (
                "duration",
                "peak_force",
                "max_crush",
                "peak_acceleration_a",
                "peak_acceleration_b",
            ):
                assert getattr(many.pulse, name)[i, j] == pytest.approx(
                    getattr(one.pulse, name), rel=1e-9
                ), name
            for label in "ab":
                for name in (
                    "delta_vx",
                    "delta_vy",
                    "delta_yaw_rate",
                    "tyre_impulse_x",
                    "tyre_loss",
                    "kinetic_energy_change",
                ):
                    got, wanted = (getattr(getattr(answer, label), name) for answer in (many, one))
                    assert got[i, j] == pytest.approx(wanted, rel=1e-9, abs=1e-6), name
    for name in FIELDS:
        assert np.all(np.isnan(getattr(many, name)[2]))
    assert np.all(np.isnan(many.pulse.duration[2]))
    with pytest.raises(col.NoImpactError):
        many.case((2, 0))
    with pytest.warns(col.CollisionsWarning, match="2 of 6 cases were refused"):
        col.time_resolved(a, col.Vehicle(**B), 0.1, **contact, **kind, drag=drags)


@pytest.mark.slow
def test_blocks_threads_and_progress():
    """More cases than a block, on two threads, are the same; each block is reported."""
    speeds = np.linspace(5.0, 20.0, 2100)
    contact = STRAIGHT | {"duration": 0.1, "geometry": "fixed", "steps": 10}
    seen = []
    a, b = col.Vehicle(**A | {"vx": speeds}), col.Vehicle(**B)
    once = col.time_resolved(
        a, b, 0.1, **contact, progress=lambda done, total: seen.append((done, total))
    )
    twice = col.time_resolved(a, b, 0.1, **contact, threads=2)
    assert once == twice
    assert seen[-1] == (2100, 2100)
    assert len(seen) == 3
    assert np.all(np.diff(once.b.delta_v) > 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("geometry", ["maximum_engagement", "first_contact"])
@pytest.mark.parametrize("drag", [0.0, 0.7])
@pytest.mark.parametrize("least", [0, 2, 32])
def test_blocks_and_single_cases_are_the_same(monkeypatch, geometry, drag, least):
    """The steps of a block of arrays, whose last cases are followed one by one, are those of plain
    floats.
    """
    speeds = np.array([20.0, 4.0, -1.0, 11.0])
    changes = {
        "a": col.Vehicle(**A | {"vx": speeds}),
        "geometry": geometry,
        "drag": drag,
        "steps": 20,
        "on_failure": "nan",
    }
    changes["restitution"] = np.array([0.1, 0.0, 0.2, 1.0])
    one_by_one = t_bone(**changes)
    monkeypatch.setattr("collisions.impact.time_resolved_inputs._FEW", 0)
    monkeypatch.setattr("collisions.kernels.time_resolved._LEAST", least)
    together = t_bone(**changes)
    assert together.status.tolist() == one_by_one.status.tolist()
    assert together.regime.tolist() == one_by_one.regime.tolist()
    for name in ("separation_speed", "slip_after", "energy_loss", "normal_impulse"):
        assert getattr(together, name) == pytest.approx(
            getattr(one_by_one, name), rel=1e-9, abs=1e-9, nan_ok=True
        )
    assert together.a.tyre_loss == pytest.approx(one_by_one.a.tyre_loss, rel=1e-9, nan_ok=True)
    assert together.b.delta_yaw_rate == pytest.approx(
        one_by_one.b.delta_yaw_rate, rel=1e-9, nan_ok=True
    )


def test_precisions_and_empty_batches():
    """float32 arrays give float32 answers to its rounding; no case is answered with no case; a 0-d
    array is a number.
    """
    speed = np.array([20.0, 10.0], dtype=np.float32)
    single = t_bone(a=col.Vehicle(**A | {"vx": speed}))
    assert single.b.delta_v.dtype == np.float32
    assert single.b.delta_v[0] == pytest.approx(t_bone().b.delta_v, rel=1e-6)
    assert t_bone(a=col.Vehicle(**A | {"vx": np.array([])})).b.delta_v.shape == (0,)
    assert isinstance(t_bone(a=col.Vehicle(**A | {"vx": np.array(20.0)})).b.delta_v, float)


@pytest.mark.slow
@pytest.mark.parametrize(
    "kind",
    [
        {"duration": "100 ms"},
        {"duration": None, "stiffness": "900 kN/m"},
        {"duration": None, "crush_a": ("60 kN/m", 7e5, "1.5 m")},
    ],
)
def test_records_pickles_and_columns(kind):
    """A record is solved again to the same answer, with the texts it was given; columns and schema
    have the pulse.
    """
    jsonschema = pytest.importorskip("jsonschema")
    impact = t_bone(**kind, drag="6.9 m/s**2", geometry="first_contact")
    record = json.loads(json.dumps(impact.to_dict(), allow_nan=False))
    jsonschema.Draft202012Validator(col.impact_schema()).validate(record)
    again = col.Impact.from_dict(record)
    assert again == impact
    assert again.to_dict() == impact.to_dict()
    assert pickle.loads(pickle.dumps(impact)) == impact
    assert impact.to_columns()["pulse.duration"] == [impact.pulse.duration]
    speeds = np.array([20.0, -1.0])
    many = t_bone(a=col.Vehicle(**A | {"vx": speeds}), **kind, on_failure="nan")
    record = json.loads(json.dumps(many.to_dict(), allow_nan=False))
    jsonschema.Draft202012Validator(col.impact_schema()).validate(record)
    assert col.Impact.from_dict(record) == many
    assert pickle.loads(pickle.dumps(many)) == many
    broken = json.loads(json.dumps(impact.to_dict()))
    broken["inputs"]["geometry"] = "elsewhere"
    with pytest.raises(col.InputError, match="geometry"):
        col.Impact.from_dict(broken)


@pytest.mark.slow
def test_again_changes_arguments():
    """Another restitution, another kind of stiffness, another geometry; a law it has not."""
    impact = t_bone()
    assert impact.again(restitution=0.3) == t_bone(0.3)
    assert impact.again(geometry="fixed", steps=50, drag=0.0) == t_bone(
        geometry="fixed", steps=50, drag=0.0
    )
    stiffer = impact.again(stiffness="1 MN/m")
    assert stiffer == t_bone(duration=None, stiffness=1e6)
    assert stiffer.again(crush_b=(6e4, 7e5, 1.5)) == t_bone(duration=None, crush_b=(6e4, 7e5, 1.5))
    with pytest.raises(TypeError, match="law"):
        impact.again(law="brach")


def test_units_texts_and_quantities():
    """US units and Quantities, each number in its own."""
    q = pint.Quantity
    crush = (q(342.6, "lbf/in"), "101.5 lbf/in**2", q(59.06, "inch"))
    metric = tuple(
        value.to(unit).magnitude
        for value, unit in (
            (q(342.6, "lbf/in"), "N/m"),
            (q(101.5, "lbf/in**2"), "N/m**2"),
            (q(59.06, "inch"), "m"),
        )
    )
    found = t_bone(duration=None, crush_a=crush, wheelbase="106.3 in", track="59.06 in")
    same = t_bone(duration=None, crush_a=metric, wheelbase=106.3 * 0.0254, track=59.06 * 0.0254)
    assert change(found) == pytest.approx(change(same), rel=1e-12)
    assert found.pulse.q.max_crush.to("inch").magnitude == pytest.approx(
        found.pulse.max_crush / 0.0254
    )


def test_the_pulse():
    """Its arrays go together: force is that of the spring, crush and delta-V end at those of the
    answer, all locked.
    """
    impact = t_bone(duration=None, stiffness=1e6)
    pulse = impact.pulse
    rising = slice(0, int(pulse.crush.argmax()) + 1)
    assert pulse.force[rising] == pytest.approx(1e6 * pulse.crush[rising], rel=1e-9)
    assert pulse.force.max() == pytest.approx(pulse.peak_force, rel=1e-12)
    assert pulse.crush.max() == pulse.max_crush
    assert pulse.force[-1] == 0.0
    assert pulse.time[0] == pulse.crush[0] == pulse.force[0] == pulse.delta_v_a[0] == 0.0
    assert pulse.time[-1] == pulse.duration
    assert np.all(np.diff(pulse.time) > 0.0)
    for name in "ab":
        side = getattr(impact, name)
        assert getattr(pulse, f"delta_v_{name}")[-1] == pytest.approx(side.delta_v, rel=1e-9)
        assert getattr(pulse, f"yaw_rate_{name}")[0] == side.before.yaw_rate
        assert getattr(pulse, f"yaw_rate_{name}")[-1] == pytest.approx(
            side.after.yaw_rate, rel=1e-9
        )
    # The impulse along the normal, which turns little, is the area under the force.
    area = float(np.sum(0.5 * (pulse.force[1:] + pulse.force[:-1]) * np.diff(pulse.time)))
    assert area == pytest.approx(impact.normal_impulse, rel=0.02)
    with pytest.raises(ValueError, match="read-only"):
        pulse.force[0] = 1.0
    assert col.eccentric(impact.a.before, impact.b.before, 0.1, **STRAIGHT).pulse is None
    assert "peak_force" in pulse._repr_html_()
    assert pulse.q.duration.m_as("ms") == pytest.approx(1e3 * pulse.duration)


@pytest.mark.slow
@pytest.mark.parametrize("geometry", ["fixed", "maximum_engagement"])
@pytest.mark.parametrize("friction", [0.5, math.inf])
def test_the_largest_acceleration_does_not_depend_on_the_step(friction, geometry):
    """Friction without bound stops the slip at once, which a step would make an acceleration of.

    The force of friction jumps where the slip stops, so that a few contacts are off by more.
    """
    random = np.random.default_rng(4)
    n = 400
    pair, restitution = random_pair(random, n), random.uniform(0.0, 0.3, n)
    contact = {"normal": random.uniform(-0.6, 0.6, n), "point": (0.0, 0.0), "friction": friction}
    peaks = []
    for steps in (100, 400):
        found = col.time_resolved(
            *pair,
            restitution,
            **contact,
            duration=0.1,
            drag=0.7,
            geometry=geometry,
            steps=steps,
            on_failure="nan",
        )
        peaks.append(found.pulse.peak_acceleration_a)
    apart = abs(peaks[0] / peaks[1] - 1.0)
    apart = apart[np.isfinite(apart)]
    assert apart.size > 300
    assert np.quantile(apart, 0.5) < 2e-3
    assert np.quantile(apart, 0.9) < 0.05
    assert np.max(apart) < 0.5
    straight = t_bone(friction=math.inf, drag=0.0, geometry=geometry)
    least = straight.pulse.peak_force / straight.a.before.mass
    assert 0.9 * least <= straight.pulse.peak_acceleration_a <= 1.5 * least


@pytest.mark.slow
def test_report_explain_diagnose():
    """The pages have the pulse, its inputs and its tyres; and a record that gives the
    page again.
    """
    from collisions.reporting import replay

    impact = t_bone()
    page = col.report(impact, form="markdown", units="us")
    for text in (
        "How the contact passed",
        "largest acceleration",
        "energy lost by the tyres",
        "nominal duration",
        "Places:",
    ):
        assert text in page
    assert "What is left out" not in page
    assert "Law:" not in page
    assert replay(page) == impact
    working = col.explain(impact, form="text", units="metric")
    assert "cannot be worked out" not in working
    assert re.search(
        r"Velocity of B after, along x:\n  v'_Bx = v_Bx \+ P_x / m_B \+ J_Bx / m_B", working
    )
    codes = col.diagnose(impact).measured
    assert "tyre_impulse" not in codes
    assert "tyre_impulse" in col.diagnose(t_bone(drag=0.0)).measured
    assert "contact_points_approach" not in codes
    assert not [one for one in col.diagnose(impact) if one.code == "rounding"]
    assert "first contact;" in col.report(t_bone(geometry="first_contact"), form="markdown")
    bare = t_bone(a=col.Vehicle(**A | {"heading": None}))
    assert "without a heading" in col.report(bare, form="markdown")


@pytest.mark.slow
def test_pictures():
    """The pulse in three panels; the energy that tyres took; their momentum; and what draws an
    impulse refuses.
    """
    pytest.importorskip("matplotlib")
    impact = t_bone()
    axes = plot.pulse(impact, units="us")
    assert [panel.get_ylabel() for panel in axes.child_axes] == [
        "force [lbf]",
        "crush [ft]",
        "delta-V [mph]",
    ]
    (line,) = [one for one in axes.child_axes[0].get_lines() if one.get_gid() == "force"]
    assert max(line.get_ydata()) == pytest.approx(impact.pulse.peak_force / 4.4482216152605)
    gids = [patch.get_gid() for patch in plot.energy(impact).patches]
    assert "lost.tyres" in gids
    assert "lost.tyres" not in [patch.get_gid() for patch in plot.energy(t_bone(drag=0.0)).patches]
    assert "tyres" in plot.momentum(impact).get_legend().get_texts()[-1].get_text()
    for draw in (plot.impulse_plane, lambda one: plot.force_time(one, "100 ms")):
        with pytest.raises(col.InputError) as caught:
            draw(impact)
        assert caught.value.code == "takes_time"
    with pytest.raises(col.InputError) as caught:
        plot.pulse(col.eccentric(impact.a.before, impact.b.before, 0.1, **STRAIGHT))
    assert caught.value.code == "takes_no_time"
    with pytest.raises(col.InputError) as caught:
        col.left_out(impact)
    assert caught.value.code == "takes_time"
    import matplotlib.pyplot as plt

    plt.close("all")


# Refusals


@pytest.mark.parametrize(
    ("changes", "code", "text"),
    [
        ({"duration": None}, "one_stiffness", "give one of duration="),
        ({"stiffness": 1e6}, "one_stiffness", "got duration and stiffness"),
        ({"crush_a": (6e4, 7e5, 1.0)}, "one_stiffness", "duration and crush_a"),
        ({"duration": 0.0}, "not_positive", "must be > 0"),
        (
            {"duration": -0.1},
            "negative_duration",
            "duration must be > 0, got -0.1; it is the time from touching to parting",
        ),
        ({"duration": math.inf}, "not_finite", "duration must be finite"),
        ({"duration": None, "stiffness": 0.0}, "not_positive", "stiffness"),
        ({"duration": None, "stiffness": "1 kN"}, "bad_units", "stiffness"),
        ({"duration": None, "crush_a": 6e4}, "bad_shape", r"crush_a must be \(A, B, width\)"),
        ({"duration": None, "crush_a": (6e4, 0.0, 1.5)}, "not_positive", r"crush_a\[1\]"),
        ({"duration": None, "crush_b": (-1.0, 1e5, 1.5)}, "negative_size", r"crush_b\[0\]"),
        ({"duration": None, "crush_b": (6e4, 1e5, math.nan)}, "not_finite", r"crush_b\[2\]"),
        ({"drag": -0.1}, "negative_drag", "drag"),
        ({"drag": math.nan}, "not_finite", "drag"),
        ({"drag": "wet"}, "bad_units", "drag"),
        ({"drag": None}, "not_a_number", "drag"),
        ({"wheelbase": 0.0}, "not_positive", "wheelbase"),
        ({"track": -1.0}, "not_positive", "track"),
        ({"geometry": "moving"}, "bad_option", "geometry must be one of"),
        ({"geometry": None}, "bad_option", "geometry must be one of"),
        ({"steps": 9}, "bad_option", "steps must be a whole number from 10"),
        ({"steps": 100.0}, "bad_option", "steps must be a whole number"),
        ({"steps": True}, "bad_option", "steps must be a whole number"),
        ({"friction": None}, "one_tangential", "no default"),
        ({"friction": -0.5}, "bad_friction", "friction"),
        ({"restitution": 1.5}, "bad_restitution", "restitution"),
        ({"restitution": -0.1}, "bad_restitution", "restitution"),
        ({"point": None}, "missing_point", "time_resolved needs it"),
        ({"normal": math.pi}, "separating", "closing speed -20"),
        ({"on_failure": "no"}, "bad_option", "on_failure"),
        ({"threads": 0}, "bad_option", "threads"),
    ],
)
def test_refused_arguments(changes, code, text):
    """Each names the argument and what to write."""
    with pytest.raises(col.CollisionsError, match=text) as caught:
        t_bone(**changes)
    assert caught.value.code == code


def test_refused_vehicles():
    """No pivot, nothing missing, nothing that cannot move."""
    pinned = col.Vehicle(mass=1000.0, yaw_inertia=1300.0, x=0.0, y=2.0, pivot=(0.0, 0.0))
    for changes, code in (
        ({"b": pinned}, "pinned"),
        ({"b": col.Vehicle(**B | {"yaw_inertia": None})}, "missing_inertia"),
        ({"a": col.Vehicle(**A | {"x": None})}, "missing_position"),
        ({"a": col.Vehicle(mass=math.inf, yaw_inertia=math.inf, vx=1.0), "b": WALL}, "immovable"),
        ({"a": "car"}, "not_a_vehicle"),
    ):
        with pytest.raises(col.CollisionsError) as caught:
            t_bone(**changes)
        assert caught.value.code == code, code
    with pytest.raises(col.InputError) as caught:
        t_bone(b=pinned, duration=None, steps=0)
    assert {problem.code for problem in caught.value.fields["problems"]} == {
        "pinned",
        "one_stiffness",
        "bad_option",
    }


def test_a_body_on_a_pivot_is_an_infinite_mass_there():
    """As the refusal says: with the inertia about the pivot it is struck as the pinned body is, to
    the error of the steps.
    """
    a = col.Vehicle(**A | {"y": 0.1})
    pinned = col.Vehicle(
        mass=1000.0, yaw_inertia=1300.0, x=0.5, y=2.0, pivot=(0.5, -2.0), yaw_rate=0.3
    )
    post = col.Vehicle(
        mass=math.inf, yaw_inertia=1300.0 + 1000.0 * 4.0**2, x=0.5, y=-2.0, yaw_rate=0.3
    )
    contact = {"normal": 0.1, "point": (0.0, 0.5), "friction": 0.4}
    with pytest.raises(
        col.InputError, match="an infinite mass at the pivot, with the yaw inertia about it"
    ):
        t_bone(a=a, b=pinned, **contact)
    wanted = col.eccentric(a, pinned, 0.2, **contact, law="stronge")
    found = t_bone(0.2, a=a, b=post, **contact, geometry="fixed", drag=0.0)
    assert found.a.delta_vx == pytest.approx(wanted.a.delta_vx, rel=5e-5)
    assert found.a.delta_vy == pytest.approx(wanted.a.delta_vy, rel=5e-5)
    assert found.b.delta_yaw_rate == pytest.approx(wanted.b.delta_yaw_rate, rel=5e-5)


@pytest.mark.slow
def test_steps_within_which_a_body_turns_too_far_are_refused():
    """Below, the answer is within some percent of that of ten times the steps. Where nothing moves
    the turn does not matter, nor does the yaw rate after.
    """
    for rate, steps, refused in ((260, 100, True), (240, 100, False), (260, 1000, False),
                                 (40, 12, True), (25, 12, False), (1e20, 100, True)):  # fmt: skip
        spinning = {"b": col.Vehicle(**B | {"yaw_rate": f"{rate} rad/s"})}
        contact = spinning | {"duration": 0.1, "steps": steps}
        for geometry in ("first_contact", "maximum_engagement"):
            if refused:
                with pytest.raises(col.NoSolutionError, match="give more steps=") as caught:
                    t_bone(0.2, **contact, geometry=geometry)
                assert caught.value.code == "coarse_steps"
        if not refused:
            found = t_bone(0.2, **contact, geometry="first_contact")
            finer = t_bone(0.2, **contact | {"steps": 10 * steps}, geometry="first_contact")
            assert found.a.delta_v == pytest.approx(finer.a.delta_v, rel=0.03)
        assert t_bone(0.2, **contact, geometry="fixed", drag=0.0).energy_loss > 0.0
    light = {
        "mass": 174.6, "vy": 5.3, "yaw_rate": -4.55, "yaw_inertia": 1.036, "x": 0.253, "y": 0.0,
        "heading": math.pi / 2,
    }  # fmt: skip
    a = col.Vehicle(**A | {"vx": 14.84, "vy": -2.34, "yaw_rate": -1.57, "x": -2.0, "y": 0.39})
    contact = {"friction": 0.355, "duration": 0.1586, "drag": 0.0, "geometry": "first_contact"}
    found = t_bone(0.24, a, col.Vehicle(**light), **contact)
    assert abs(found.b.after.yaw_rate) > 50.0
    finer = t_bone(0.24, a, col.Vehicle(**light), **contact, steps=1000)
    assert found.a.delta_v == pytest.approx(finer.a.delta_v, rel=2e-3)


@pytest.mark.slow
def test_refused_contacts():
    """One that tyres hold does not end; one whose start cannot be found, or that lies apart there;
    too large for floats.
    """
    slow = {"a": col.Vehicle(**A | {"vx": 0.4}), "b": col.Vehicle(**B | {"vy": 0.0})}
    with pytest.raises(col.NoSolutionError, match="three times its nominal duration") as caught:
        t_bone(0.3, **slow, duration=0.3, geometry="first_contact")
    assert caught.value.code == "endless_contact"
    spinning = {
        "a": col.Vehicle(**A | {"vx": 3.0, "yaw_rate": 15.0}),
        "b": col.Vehicle(**B | {"vy": 0.0}),
    }
    with pytest.raises(col.NoSolutionError, match="geometry='first_contact'") as caught:
        t_bone(**spinning, duration=0.5)
    assert caught.value.code == "no_start"
    with pytest.raises(
        col.NoSolutionError, match="pull at each other; give a finite friction="
    ) as caught:
        col.time_resolved(
            col.Vehicle(mass=1.0, yaw_inertia=0.09, vx=0.2, vy=-4.0, x=0.0, y=0.0), WALL, 0.5,
                normal=0.0, point=(0.5, 0.8),
            friction=math.inf, duration=0.1, geometry="fixed",
        )  # fmt: skip
    assert caught.value.code == "no_slip_pulls"
    with pytest.raises(col.InputError) as caught:
        t_bone(a=col.Vehicle(**A | {"vx": 1e200}), geometry="fixed")
    assert caught.value.code == "out_of_range"
    with pytest.raises(col.InputError) as caught:
        t_bone(duration=None, stiffness="1e-155 N/m", geometry="first_contact")
    assert caught.value.code == "out_of_range"
    # The crush at the end, which is negative by then, is below all numbers.
    with pytest.raises(col.InputError) as caught:
        col.time_resolved(
            col.Vehicle(mass=1500, vx=20, vy=1, yaw_inertia=2400, x=-2, y=0.4, heading=0.1),
            col.Vehicle(mass=1200, vx=-3, yaw_inertia=1700, x=2, y=0, heading=3),
            0.2, normal=0.1, point=(0, 0.4), friction=0.4, steps=25,
                duration="2.1129693985116045e121 s",
            tyres_b=col.travel.Tyres(0.7, 0.1, 2.7, 1.5),
        )  # fmt: skip
    assert caught.value.code == "out_of_range"
    with pytest.raises(col.InputError, match=r"case 1: .*duration"):
        t_bone(duration=np.array([0.1, -0.1]), on_failure="raise")
    with pytest.warns(
        col.CollisionsWarning, match="1 of 3 cases were refused and are NaN .1 negative_size."
    ):
        t_bone(drag=np.array([0.1, -0.1, 0.2]))
    # Of a batch by the same names as of a single case.
    endless = np.array([1e6, -math.inf, math.inf, math.nan])
    found = t_bone(duration=None, stiffness=endless, on_failure="nan").status
    for stiffness, status in zip(endless[1:], found[1:], strict=True):
        with pytest.raises(col.InputError) as caught:
            t_bone(duration=None, stiffness=stiffness)
        assert caught.value.code == col.Status(status).label


@pytest.mark.parametrize("geometry", ["fixed", "first_contact", "maximum_engagement"])
def test_a_contact_that_friction_without_bound_parts_at_once_is_refused(geometry):
    """As under "stronge", whose limit it is; its answer would be that of a step or two, however
    short these are.
    """
    a = col.Vehicle(mass=1500, yaw_inertia=2550, x=-2.2, y=-0.54, heading=0.24, vx=2.3, vy=0.6)
    b = col.Vehicle(mass=1500, yaw_inertia=2550, x=1.95, y=-1.18, heading=-1.26, vx=3.7, vy=-11.7)
    contact = {"normal": 0.42, "point": (0.0, 0.0)}
    in_time = contact | {"duration": 0.1, "geometry": geometry}
    with pytest.raises(col.NoSolutionError) as as_limit:
        col.eccentric(a, b, 0.1, friction=math.inf, law="stronge", **contact)
    with pytest.raises(col.NoSolutionError) as refused:
        col.time_resolved(a, b, 0.1, friction=math.inf, **in_time)
    assert refused.value.code == as_limit.value.code == "no_slip_pulls"
    # It is the bound that is missing, and a contact that presses first has an answer without one.
    friction = np.array([0.5, math.inf])
    found = col.time_resolved(a, b, 0.1, friction=friction, **in_time, on_failure="nan")
    assert found.status.tolist() == [col.Status.OK, col.Status.NO_SLIP_PULLS]
    slower = b.replace(vx=-8.0, vy=-1.7)
    assert col.time_resolved(a, slower, 0.1, friction=math.inf, **in_time).normal_impulse > 100.0


@pytest.mark.slow
@pytest.mark.parametrize("geometry", ["fixed", "first_contact"])
def test_which_contacts_friction_parts_at_once(geometry):
    """The same of random pairs as under "stronge", each once."""
    random = np.random.default_rng(20261130)
    n = 2000
    pair, restitution = random_pair(random, n), random.uniform(0.0, 0.3, n)
    contact = {"normal": random.uniform(-0.6, 0.6, n), "point": (0.0, 0.0), "friction": math.inf}
    nan = {"on_failure": "nan"}
    instant = col.eccentric(*pair, restitution, law="stronge", **contact, **nan)
    found = col.time_resolved(*pair, restitution, **contact, duration=0.1, geometry=geometry, **nan)
    assert np.array_equal(found.status, instant.status)
    assert 5 < np.sum(found.status == col.Status.NO_SLIP_PULLS) < 50


def test_a_batch_without_friction_or_slip_is_frictionless():
    """As the case by itself: with nothing along the tangent the contact neither slides nor is held
    by friction.
    """
    a, b = (
        {"mass": 1500.0, "vx": 10.0, "x": -2.0, "y": 0.0, "yaw_inertia": 2000.0},
        col.Vehicle.barrier(x=1.0, y=0.0),
    )
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.0, "duration": 0.1, "steps": 20}
    many = col.time_resolved(
        col.Vehicle(**a | {"mass": np.array([1500.0, 900.0])}), b, 0.2, **contact
    )
    assert many.regime.tolist() == [many.case(i).regime for i in range(2)] == ["frictionless"] * 2


def test_bodies_that_cannot_move_or_turn():
    """An infinite inertia, an infinite mass that turns, two that cannot move along the tangent;
    friction without end.
    """
    a, b = col.Vehicle(**A | {"yaw_inertia": math.inf}), col.Vehicle(**B)
    assert t_bone(a=a).a.delta_yaw_rate == 0.0
    post = col.Vehicle(mass=math.inf, yaw_inertia=2000.0, x=0.3, y=0.5)
    struck = t_bone(b=post)
    assert struck.b.delta_vx == struck.b.tyre_loss == 0.0
    assert struck.b.delta_yaw_rate != 0.0
    for friction in (0.0, 1e-300, 1e300, math.inf):
        impact = t_bone(b=b, friction=friction, geometry="fixed", drag=0.0)
        assert impact.regime == (
            "frictionless" if friction == 0.0 else "sliding" if friction < 1.0 else "sticking"
        )
        assert impact.separation_speed > 0.0
    wanted, _ = by_events(t_bone().a.before, b, 0.1, 0.0, (0.0, 0.0), 50.0)
    assert (
        off(change(t_bone(friction=math.inf, geometry="fixed", drag=0.0, steps=400)), wanted) < 1e-2
    )


# The least model, with a duration


def off_by(answer, other):
    """How far two answers are apart for the worse vehicle, in m/s: delta-V, and radius of gyration
    times yaw rate.
    """
    difference = change(answer) - change(other)
    return max(np.linalg.norm(difference[:3]), np.linalg.norm(difference[3:]))


@pytest.mark.slow
def test_the_least_model_with_a_duration():
    """The errors are those against a contact in 25 steps; the least model within 1 / 1.15 of the
    tolerance; 0 is the fullest.
    """
    a, b = col.Vehicle(**A), col.Vehicle(**B)
    time = {"duration": "100 ms", "drag": 0.7}
    rough = t_bone(steps=25)
    eccentric, central = (
        col.eccentric(a, b, 0.1, **STRAIGHT),
        col.oblique_central(a, b, 0.1, normal=0.0, friction=0.5),
    )
    choice = col.required_model(a, b, 0.1, **STRAIGHT, **time)
    assert choice.model == "time_resolved"
    assert "tolerance of 0" in choice.reason
    error = off_by(eccentric, rough)
    assert choice.errors["eccentric"] == pytest.approx(error, rel=1e-9)
    assert choice.errors["oblique_central"] == pytest.approx(off_by(central, rough), rel=1e-9)
    assert list(choice.missing) == [
        "linear_central",
        "oblique_central",
        "eccentric",
        "time_resolved",
    ]
    for tolerance, model in (
        (1.16 * error, "eccentric"),
        (1.14 * error, "time_resolved"),
        (100.0, "linear_central"),
    ):
        assert col.required_model(a, b, 0.1, **STRAIGHT, **time, tolerance=tolerance).model == model
        impact = col.solve(a, b, 0.1, **STRAIGHT, **time, tolerance=tolerance)
        assert impact.model == model
        if model == "time_resolved":
            assert change(impact) == pytest.approx(change(t_bone()), rel=1e-12)
            assert impact.pulse == t_bone().pulse
            assert f"would err by {error:.3g} m/s over this duration" in impact.choice.reason
            # What is accepted is more than that, but not by enough.
            assert impact.choice.reason.endswith(
                ", which has to be 1.15 times that, as the error is known roughly"
            )
        elif model == "eccentric":
            assert impact == col.solve(a, b, 0.1, **STRAIGHT, **time, tolerance=tolerance)
            assert change(impact) == pytest.approx(change(eccentric), rel=1e-12)
            assert impact.pulse is None
    # Without a duration nothing changes, and without a drag there are no tyres.
    assert col.required_model(a, b, 0.1, **STRAIGHT).model == "eccentric"
    free = col.solve(a, b, 0.1, **STRAIGHT, duration=0.1)
    assert change(free) == pytest.approx(change(t_bone(drag=0.0)), rel=1e-12)


def test_a_low_speed_impact_requires_time():
    """Brakes at 2 m/s take half of the delta-V; at 20 m/s an impulse in line is enough
    for 2 m/s.
    """
    for speed, model in ((2.0, "time_resolved"), (20.0, "linear_central")):
        a, b = (col.Vehicle(**A | {"vx": vx, "x": x}) for vx, x in ((speed, -2.2), (0.0, 2.2)))
        tolerance = 0.5 if speed == 2.0 else 2.0
        choice = col.required_model(
            a, b, 0.4, **STRAIGHT, tolerance=tolerance, duration=0.1, drag=0.7
        )
        assert choice.model == model
        assert choice.errors["linear_central"] == pytest.approx(0.69, abs=0.05)


def test_where_time_is_no_candidate():
    """A ratio, a fraction, a pivot, what is missing: the reason says so. Where a rough run has no
    answer, more steps are taken.
    """
    a, b = col.Vehicle(**A), col.Vehicle(**B)
    where, time = {"normal": 0.0, "point": (0.0, 0.0)}, {"duration": 0.1, "tolerance": 0.5}
    for rule in ("impulse_ratio", "critical_fraction"):
        choice = col.required_model(a, b, 0.1, **where, **time, **{rule: 0.1})
        assert choice.model == "eccentric"
        assert choice.reason.endswith(f"; time_resolved takes friction, and {rule} was given")
        assert list(choice.errors) == ["linear_central", "oblique_central"]
    for law in ("kudlich-slibar", "stronge"):
        asked = {**where, "duration": 0.1, "friction": 0.5, "law": law}
        impact = col.solve(a, b, 0.1, **asked)
        assert impact.model == "eccentric"
        wanted = f"; time_resolved has a law of its own, and {law} was given"
        assert impact.choice.reason.endswith(wanted)
        del asked["duration"]
        assert impact.b.delta_v == col.eccentric(a, b, 0.1, **asked).b.delta_v
    pinned = col.Vehicle(mass=1000.0, yaw_inertia=1300.0, x=0.5, y=2.0, pivot=(0.5, -2.0))
    assert (
        "takes no body with a pivot"
        in col.required_model(a, pinned, 0.1, **where, **time, friction=0.5).reason
    )
    unknown = col.required_model(a, b.replace(yaw_inertia=None), 0.1, **where, **time, friction=0.5)
    assert "time_resolved needs b.yaw_inertia" in unknown.reason
    with pytest.raises(col.MissingInputError):
        col.solve(a, b.replace(yaw_inertia=None), 0.1, **where, **time, friction=0.5)
    spinning = col.Vehicle(**A | {"vx": 3.0, "yaw_rate": 15.0}), col.Vehicle(**B | {"vy": 0.0})
    choice = col.required_model(*spinning, 0.1, **where, friction=0.5, duration=0.5, tolerance=1.0)
    assert choice.model == "time_resolved"
    assert "not known" in choice.reason
    with pytest.raises(col.NoSolutionError, match="no start"):
        col.solve(*spinning, 0.1, **where, friction=0.5, duration=0.5, tolerance=1.0)
    with pytest.raises(col.NoImpactError):
        col.solve(a, b, 0.1, normal=math.pi, point=(0.0, 0.0), friction=0.5, **time)
    with pytest.raises(col.InputError, match=r"drag = 0\.7 needs a duration"):
        col.required_model(a, b, 0.1, **where, friction=0.5, drag=0.7)
    with pytest.raises(col.InputError, match="duration must be > 0"):
        col.solve(a, b, 0.1, **where, friction=0.5, duration=0)


@pytest.mark.slow
def test_a_batch_of_solve_with_a_duration():
    """Each case by its own model, as by itself; a record is solved again."""
    speeds, tolerances = np.array([20.0, 3.0, -4.0, 8.0]), np.array([5.0, 0.1, 1.0, 1.0])
    a, b = col.Vehicle(**A | {"vx": speeds}), col.Vehicle(**B)
    time = {"duration": "100 ms", "drag": 0.7}
    many = col.solve(a, b, 0.1, **STRAIGHT, **time, tolerance=tolerances, on_failure="nan")
    assert many.model.tolist() == ["eccentric", "time_resolved", "eccentric", "eccentric"]
    assert many.status.tolist() == [0, 0, col.Status.SEPARATING, 0]
    assert np.isfinite(many.pulse.duration).tolist() == [False, True, False, False]
    for case in (0, 1, 3):
        one = many.case(case)
        assert one.model == many.model[case]
        assert one.regime == many.regime[case]
        for name in FIELDS[:-1]:
            assert getattr(many, name)[case] == pytest.approx(
                getattr(one, name), rel=1e-9, abs=1e-9
            ), name
        for label in "ab":
            got, wanted = getattr(many, label), getattr(one, label)
            assert got.at_compression.vx[case] == pytest.approx(
                wanted.at_compression.vx, rel=1e-9, abs=1e-9
            )
            assert got.kinetic_energy_change[case] == pytest.approx(
                wanted.kinetic_energy_change, rel=1e-9
            )
            assert got.tyre_loss[case] == pytest.approx(wanted.tyre_loss, rel=1e-9)
    assert many.momentum_residual[[0, 1, 3]] == pytest.approx(0.0, abs=1e-9)
    record = json.loads(json.dumps(many.to_dict(), allow_nan=False))
    assert col.Impact.from_dict(record) == many
    assert pickle.loads(pickle.dumps(many)) == many
    assert len(many.to_columns()["pulse.duration"]) == 4
    one = col.solve(col.Vehicle(**A), b, 0.1, **STRAIGHT, **time, tolerance="0.1 km/h")
    assert one.to_dict()["inputs"]["duration"] == "100 ms"
    assert col.Impact.from_dict(json.loads(json.dumps(one.to_dict()))) == one
    assert one.again(drag=0.0).a.tyre_loss == 0.0
    page = col.report(one, form="markdown")
    assert "the contact followed in time" in page
    assert "law of restitution" not in page
    stray = json.loads(json.dumps(col.eccentric(col.Vehicle(**A), b, 0.1, **STRAIGHT).to_dict()))
    stray["inputs"]["duration"] = 0.1
    with pytest.raises(
        col.InputError, match="eccentric takes a duration for tyres_a and tyres_b alone"
    ):
        col.Impact.from_dict(stray)


def test_a_moving_wall_does_its_work():
    """In a frame in which the wall moves, it does what the car gains and both lose."""
    car = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, x=-2.0, y=0.0)
    impact = col.time_resolved(car, col.Vehicle.barrier(vx=-10.0), 0.2, **STRAIGHT, duration=0.1)
    assert impact.a.delta_vx == pytest.approx(-12.0, rel=1e-3)
    assert impact.b.kinetic_energy_change == pytest.approx(impact.b.impulse_x * -10.0, rel=1e-9)


def test_units_may_be_required():
    """The sizes that are not given need no unit, those that are do; a record is in SI whatever is
    required.
    """
    a = col.Vehicle(**A)
    b = col.Vehicle(**B)
    contact = {"normal": "0 deg", "point": ("0 m", "0 m"), "friction": 0.5}
    wanted = col.time_resolved(a, b, 0.1, **contact, duration="0.1 s", drag=0.7)
    with col.options(require_units=True):
        assert col.time_resolved(a, b, 0.1, **contact, duration="0.1 s", drag=0.7) == wanted
        assert (
            col.solve(a, b, 0.1, **contact, tolerance="0.1 m/s", duration="0.1 s", drag=0.7).pulse
            == wanted.pulse
        )
        assert col.Impact.from_dict(wanted.to_dict()) == wanted
        assert wanted.again(drag=0.0).a.tyre_loss == 0.0
        for changes in (
            {"duration": 0.1},
            {"duration": "0.1 s", "wheelbase": 2.7},
            {"crush_a": (6e4, "7e5 N/m**2", "1.5 m")},
        ):
            with pytest.raises(col.UnitsError, match="has no unit"):
                col.time_resolved(a, b, 0.1, **contact, **changes)


def test_a_wall_at_rest_gains_nothing():
    """Also beside a body of infinite yaw inertia that turns, whose own energy is not known: it has
    what the wall has not.
    """
    b = col.Vehicle(mass=1500.0, yaw_inertia=math.inf, yaw_rate=0.5, vx=-12.0, x=2.0, y=0.3)
    wall = col.Vehicle.barrier(x=-1.0, y=0.0)
    impact = col.time_resolved(
        wall, b, 0.3, normal=0.0, point=(0.0, 0.0), friction=0.4, duration=0.1
    )
    assert impact.a.kinetic_energy_change == 0.0
    assert impact.b.kinetic_energy_change == -impact.energy_loss


# The ends of what it answers


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_energy_that_only_the_steps_gain_is_said(friction):
    """At a restitution of 1 a contact loses nothing along the normal; what the steps miss may be
    either side of that.
    """
    rng = np.random.default_rng(3)
    count = 150
    a, b = (
        col.Vehicle(
            mass=rng.uniform(900, 2200, count), yaw_inertia=rng.uniform(1500, 3500, count),
            vx=rng.uniform(*speeds, count),
            vy=rng.uniform(-5, 5, count), x=side * rng.uniform(0.6, 2.2, count),
            y=rng.uniform(-1, 1, count),
        )
        for side, speeds in ((-1.0, (5, 25)), (1.0, (-5, 0)))
    )  # fmt: skip
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": friction, "duration": 0.1}
    with pytest.warns(
        col.EnergyGainWarning, match=r"the error of the steps.* give more steps than 100"
    ):
        many = col.time_resolved(a, b, 1.0, **contact, on_failure="nan")
    answered = many.status <= col.Status.ENERGY_GAIN
    assert np.count_nonzero(answered) > count - 3
    gains = many.energy_loss < -1e-12 * many.energy_absorbed
    assert np.array_equal(many.status == col.Status.ENERGY_GAIN, gains)
    assert np.array_equal(many.ok, answered & ~gains)
    assert np.all(many.energy_loss[answered] > -2e-4 * many.energy_absorbed[answered])
    with pytest.warns(col.EnergyGainWarning, match="the error of the steps"):
        one = many.case(int(np.nanargmin(many.energy_loss)))
    assert not one.ok
    assert one.energy_loss == pytest.approx(np.nanmin(many.energy_loss), rel=1e-6)
    assert one.pulse.time.size > 80
    less = col.time_resolved(a, b, 0.999, **contact, on_failure="nan")
    assert not np.any(less.status == col.Status.ENERGY_GAIN)


@pytest.mark.parametrize("geometry", ["maximum_engagement", "first_contact", "fixed"])
def test_a_duration_beyond_floats_is_told_as_such(geometry):
    """Not as a start that was not found: levers over the way of 1e-200 s overflow."""
    given = {"duration": None, "geometry": geometry}
    with pytest.raises(col.InputError, match="too large or too small for floats") as caught:
        t_bone(**given | {"duration": 1e-200})
    assert caught.value.code == "out_of_range"
    many = t_bone(**given | {"duration": np.array([1e-100, 1e-200])}, on_failure="nan")
    assert many.status.tolist() == [col.Status.OK, col.Status.OUT_OF_RANGE]


def test_a_wall_is_not_the_limit_of_a_heavy_vehicle_while_the_geometry_moves():
    """As the docstring says: whoever carries the point, it differs; with a geometry that is fixed
    the two are one.
    """
    a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=15.0, x=-1.8, y=0.6)
    heavy = col.Vehicle(mass=1e18, yaw_inertia=1e18, x=2.0, y=0.0)
    contact = {"normal": math.radians(45.0), "point": (0.0, 0.0), "friction": 0.0, "duration": 0.1}
    turned = {
        geometry: [
            col.time_resolved(a, b, 0.1, **contact, geometry=geometry).a.after.yaw_rate
            for b in (col.Vehicle.barrier(), heavy)
        ]
        for geometry in ("fixed", "first_contact")
    }
    assert turned["fixed"][0] == pytest.approx(turned["fixed"][1], rel=1e-9)
    wall, mass = turned["first_contact"]
    assert mass / wall == pytest.approx(1.25, abs=0.05)
    assert "the yaw rate by a quarter in some cases" in " ".join(col.time_resolved.__doc__.split())
    assert "not the limit of a very heavy vehicle" in " ".join(col.time_resolved.__doc__.split())


@pytest.mark.parametrize("restitution", [0.0, 0.001, 0.3, 1.0])
def test_nothing_pushes_any_more_as_the_bodies_part(restitution):
    """Plastic or elastic, the last force of a pulse is none, and the one before it no jump away
    where the way back has a length.
    """
    pulse = t_bone(restitution).pulse
    assert pulse.force[-1] == 0.0
    if restitution >= 0.3:
        assert pulse.force[-2] < 0.1 * pulse.peak_force
    assert pulse.force[0] == 0.0
    # A plastic contact parts where it is greatest, which leaves the step before that.
    close = 1e-12 if restitution else 1e-3
    assert pulse.force.max() == pytest.approx(pulse.peak_force, rel=close)


@pytest.mark.slow
def test_what_few_steps_correct_is_what_all_steps_find(monkeypatch):
    """Starts corrected with few steps against those that all steps find, thirty times as near:
    delta-V within what the docstring says, for 60 T-bones of cars on tyres.
    """
    from collisions.kernels import time_resolved as kernel

    shifted, count = kernel._shifted, []

    def counted(*given):
        count.append(1)
        return shifted(*given)

    monkeypatch.setattr(kernel, "_shifted", counted)
    generator, apart = np.random.default_rng(41), []
    for _ in range(60):
        a = col.Vehicle(
            mass=1500.0, yaw_inertia=2400.0, x=-2.0, y=0.4, heading=0.0,
            vx=generator.uniform(6.0, 20.0), vy=generator.normal(),
        )  # fmt: skip
        b = col.Vehicle(
            mass=1200.0, yaw_inertia=1700.0, x=0.8, y=-1.2, heading=1.57,
            vy=generator.uniform(-12.0, 12.0),
        )  # fmt: skip
        tyres = {f"tyres_{one}": col.travel.Tyres(0.7, 0.05, 2.7, 1.5) for one in "ab"}
        given = {"normal": 0.1, "point": (0.0, 0.0), "friction": 0.5, "duration": 0.1, **tyres}
        before = len(count)
        found = col.time_resolved(a, b, 0.1, **given)
        few = len(count) > before
        with monkeypatch.context() as nearer:
            nearer.setattr(kernel, "_NEAR", 1e-4)
            try:
                exact = col.time_resolved(a, b, 0.1, **given)
            except col.NoSolutionError:
                # All steps come no nearer, where a slip stops.
                continue
        if few:
            apart += [
                math.hypot(one.delta_vx - other.delta_vx, one.delta_vy - other.delta_vy)
                for one, other in ((found.a, exact.a), (found.b, exact.b))
            ]
    assert len(apart) > 30
    assert np.quantile(apart, 0.9) < 5e-3
    assert max(apart) < 0.02


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_how_far_energies_are_off_at_a_restitution_of_one():
    """Nothing may be lost along the normal then: what is, is the error that the docstring states,
    of contacts without friction, which have the largest.
    """
    random, count = np.random.default_rng(1), 1500

    def between(low, high):
        return random.uniform(low, high, count)

    a, b = (
        col.Vehicle(
            mass=between(900, 2500), yaw_inertia=between(1300, 4500), x=side * between(1.2, 2.2),
            y=between(-0.8, 0.8), heading=0.0, vx=between(*along), vy=between(-6, 6),
            yaw_rate=between(-1, 1),
        )
        for side, along in ((-1.0, (4, 22)), (1.0, (-10, 3)))
    )  # fmt: skip
    found = col.time_resolved(
        a, b, 1.0, normal=between(-0.4, 0.4), point=(between(-0.2, 0.2), between(-0.5, 0.5)),
        friction=0.0, duration=0.1, on_failure="nan",
    )  # fmt: skip
    answered = ~found.refused
    assert np.mean(answered) > 0.95
    off = abs(found.energy_loss_normal[answered]) / found.energy_absorbed[answered]
    assert np.quantile(off, 0.9) < 3e-4
    assert np.quantile(off, 0.99) < 2e-3


def test_a_gain_that_is_the_error_of_the_steps_is_not_laid_to_the_inputs():
    """An elastic contact in steps may gain a little, and every page says why."""
    a = col.Vehicle(mass=1500, yaw_inertia=2500, vx=19.8, x=-2, y=-0.175, heading=0)
    b = col.Vehicle(mass=1300, yaw_inertia=2200, vy=-0.05, x=2, y=-0.511, heading=1.4)
    gains = []
    for steps in (50, 100, 200):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.EnergyGainWarning)
            impact = col.time_resolved(
                a, b, 1.0, normal=0.0, point=(0, 0), friction=0.41, duration=0.1, steps=steps
            )
        gains.append(-impact.energy_loss)
        if impact.ok:
            continue
        found = " ".join(one.sentence for one in col.diagnose(impact))
        for page in (found, str(col.explain(impact)), str(col.report(impact, form="markdown"))):
            assert "that is the error of the steps" in page
            assert "do not go together" not in page
            assert "none can" not in page
    assert max(gains) > 0.0
    assert abs(gains[2]) < 0.5 * abs(gains[0])
