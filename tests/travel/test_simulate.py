"""``travel.simulate``: closed forms, an independent integration, the balance of energy, evidence
for ``fit``, and refusals.
"""

import inspect
import math
import pickle
import sys

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import collisions as col
from collisions import reconstruct, travel
from collisions.travel import motion

G = travel.GRAVITY
CAR = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, x=0.0, y=0.0, heading=0.0, vx=14.0)
ARM = math.hypot(1.35, 0.75)
# The promise of the docstring, for the place of rest over the way and for the heading [rad].
PROMISE = 1e-3


STANDING = 0.02


def counted(speed):
    """The slip that a wheel counts with, as the docstring has it; speeds are over that of the
    vehicle.
    """
    return np.where(speed < STANDING, (STANDING + speed**2 / STANDING) / 2.0, speed)


def accelerations(state, tyres, ground, slope=(0.0, 0.0), mass=1500.0, inertia=2400.0):
    """Of the centre of mass and in yaw, by angles of slip; ``ground`` gives the friction at places
    of the wheels.
    """
    vx, vy, w, x, y, heading = state
    length, width = tyres["wheelbase"], tyres["track"]
    a, b = np.array([1, 1, -1, -1]) * length / 2, np.array([1, -1, 1, -1]) * width / 2
    steer = heading + np.array([1, 1, 0, 0]) * tyres.get("steer", 0.0)
    rx, ry = (
        a * math.cos(heading) - b * math.sin(heading),
        a * math.sin(heading) + b * math.cos(heading),
    )
    speed = math.sqrt(vx**2 + vy**2 + (w * math.hypot(length, width) / 2) ** 2)
    ux, uy = (vx - w * ry) / speed, (vy + w * rx) / speed
    along, across = np.cos(steer) * ux + np.sin(steer) * uy, np.cos(steer) * uy - np.sin(steer) * ux
    mu, lock = ground(x + rx, y + ry), np.broadcast_to(tyres["lock"], 4)
    loads, height = np.ones(4), tyres.get("height", 0.0)
    for _ in range(100 if height else 1):
        brake = np.where(
            (lock >= 1.0) | (mu == 0.0),
            1.0,
            lock * tyres["friction"] / np.maximum(mu * loads, 1e-9),
        )
        x_part = np.clip(along / counted(np.hypot(along, across)), -brake, brake)
        with np.errstate(divide="ignore", invalid="ignore"):
            z = np.fmin(1.0, tyres.get("cornering", 9.5) * np.abs(across / along) / (3.0 * mu))
        rest = np.sqrt(np.maximum(0.0, 1.0 - x_part**2))
        most = np.minimum(
            np.minimum(rest, 1.0 - (1.0 - z) ** 3), np.abs(across) / counted(np.abs(across))
        )
        y_part = np.sign(across) * most
        px = -mu * loads * (np.cos(steer) * x_part - np.sin(steer) * y_part) / 4
        py = -mu * loads * (np.sin(steer) * x_part + np.cos(steer) * y_part) / 4
        ahead, aside = (
            (math.cos(turned) * px + math.sin(turned) * py).sum()
            for turned in (heading, heading + math.pi / 2)
        )
        before = loads
        loads = 1.0 - 2.0 * height * (np.sign(a) * ahead / length + np.sign(b) * aside / width)
        if np.max(np.abs(loads - before)) < 1e-9:
            break
    yaw = float((rx * py - ry * px).sum()) * mass * G / inertia
    # Across a slope presses the weight times the cosine of its angle, down it pulls that times the
    # sine.
    steep = math.hypot(*slope)
    angle = math.atan(steep)
    pull = math.sin(angle) / steep if steep else 0.0
    ax, ay = (
        G * (part.sum() * math.cos(angle) - pull * rise)
        for part, rise in zip((px, py), slope, strict=True)
    )
    return ax, ay, yaw * math.cos(angle)


def seen_from_above(slope, vx, vy):
    """A velocity along a slope in plan: its part up the slope times the cosine of the angle."""
    steep = math.hypot(*slope)
    if not steep:
        return vx, vy
    ux, uy = slope[0] / steep, slope[1] / steep
    less = (1.0 - math.cos(math.atan(steep))) * (ux * vx + uy * vy)
    return vx - less * ux, vy - less * uy


def with_rotation(state, tyres, ground, rotating, mass=1500.0, inertia=2400.0):
    """Of the centre of mass and in yaw, where each wheel that is not locked also turns: the inertia
    of its rotation takes force along it as its contact gains speed along itself. Equal loads;
    solved by iteration, with no term left out.
    """
    vx, vy, w, x, y, heading = state
    a = np.array([1, 1, -1, -1]) * tyres["wheelbase"] / 2
    b = np.array([1, -1, 1, -1]) * tyres["track"] / 2
    steer = heading + np.array([1, 1, 0, 0]) * tyres.get("steer", 0.0)
    c, s = math.cos(heading), math.sin(heading)
    rx, ry = a * c - b * s, a * s + b * c
    speed = math.sqrt(vx**2 + vy**2 + (w * math.hypot(a[0], b[0])) ** 2)
    ux, uy = vx - w * ry, vy + w * rx
    along, across = np.cos(steer) * ux + np.sin(steer) * uy, np.cos(steer) * uy - np.sin(steer) * ux
    mu, lock = ground(x + rx, y + ry), np.broadcast_to(tyres["lock"], 4)
    brake = np.where(lock >= 1.0, 1.0, lock * tyres["friction"] / mu)
    cosine = along / speed / counted(np.hypot(along, across) / speed)
    with np.errstate(divide="ignore"):
        z = np.fmin(1.0, 9.5 * np.abs(across / along) / (3.0 * mu))
    ax = ay = turned = 0.0
    for _ in range(60):
        # Of the velocity along the wheel, whose direction turns with the vehicle.
        gx, gy = ax - turned * ry - w * w * rx, ay + turned * rx - w * w * ry
        gain = np.cos(steer) * gx + np.sin(steer) * gy + w * across
        takes = np.where(lock >= 1.0, 0.0, rotating * gain / (G * mu))
        part = np.clip(np.clip(cosine, takes - brake, takes + brake), -1.0, 1.0)
        most = np.minimum(np.sqrt(1.0 - part**2), 1.0 - (1.0 - z) ** 3)
        most = np.minimum(most, np.abs(across) / speed / counted(np.abs(across) / speed))
        side = np.sign(across) * most
        px = -mu / 4 * (np.cos(steer) * part - np.sin(steer) * side)
        py = -mu / 4 * (np.sin(steer) * part + np.cos(steer) * side)
        ax, ay = px.sum() * G, py.sum() * G
        turned = float((rx * py - ry * px).sum()) * mass * G / inertia
    return ax, ay, turned


def integrated(start, tyres, surfaces=None, slope=(0.0, 0.0), rtol=1e-8, nearest=0.25, forced=None):
    """scipy's integration over time divided by speed, until 1e-3 of the speed is left; place and
    heading of rest, way, time.

    What is left, a millionth of the way, goes on straight. ``nearest`` [m] is the longest way in a
    step.
    """
    reach = math.hypot(tyres["wheelbase"], tyres["track"]) / 2

    def ground(px, py):
        mu = np.full(4, tyres["friction"])
        for corners, other in reversed(surfaces or []):
            (x0, y0), (x1, y1) = np.min(corners, axis=0), np.max(corners, axis=0)
            mu = np.where((px > x0) & (px < x1) & (py > y0) & (py < y1), other, mu)
        return mu

    def speed_of(state):
        return math.sqrt(state[0] ** 2 + state[1] ** 2 + (reach * state[2]) ** 2)

    first = speed_of(start)

    def rates(_, state):
        size = speed_of(state)
        found = (
            accelerations(state[:6], tyres, ground, slope)
            if forced is None
            else forced(state[:6], tyres, ground)
        )
        # Over the first speed, so that one tolerance does for all.
        going = (*seen_from_above(slope, *state[:2]), state[2])
        return size * np.array([*found, *going, 1.0, math.hypot(state[0], state[1])]) / first

    def slow(_, state):
        return speed_of(state) - 1e-3 * first

    slow.terminal = True
    longest = nearest / first if surfaces else np.inf
    scale = np.array(
        [first, first, first / reach, first**2 / G, first**2 / G, 1.0, first / G, first**2 / G]
    )
    end = solve_ivp(
        rates,
        (0.0, 1e4),
        [*start, 0.0, 0.0],
        rtol=rtol,
        atol=1e-2 * rtol * scale,
        max_step=longest,
        events=slow,
        method="RK45",
    )
    assert end.status == 1
    state = end.y[:, -1]
    forced = np.array(accelerations(state[:6], tyres, ground, slope))
    weights = np.array([1.0, 1.0, reach**2])
    left = -(weights * state[:3] ** 2).sum() / (weights * state[:3] * forced).sum()
    return state[3:6] + 0.5 * left * state[:3], state[7], state[6] + left, end


def drive(
    vehicle,
    *,
    friction=0.7,
    lock=1.0,
    wheelbase=2.7,
    track=1.5,
    surfaces=None,
    slope=(0, 0),
    **options,
):
    """``simulate`` with the tyres of a car."""
    rest = {name: options.pop(name) for name in ("steer", "cornering", "height") if name in options}
    tyres = travel.Tyres(friction, lock, wheelbase, track, **rest)
    return travel.simulate(vehicle, tyres, surfaces=surfaces, slope=slope, **options)


def moving(vx, vy, yaw_rate, heading=0.0):
    return CAR.replace(vx=vx, vy=vy, yaw_rate=yaw_rate, heading=heading)


# Closed forms


@pytest.mark.parametrize("heading", [0.0, 0.7, math.pi / 2, -2.5])
def test_a_straight_skid_on_locked_wheels(heading):
    """Whatever the heading, v**2 / (2 g mu) along the course in v / (g mu); 5e-7 is the force that
    a slow wheel lacks.
    """
    path = drive(CAR.replace(heading=heading), friction=0.7, lock=1)
    assert path.rest.x == pytest.approx(14.0**2 / (2 * G * 0.7), rel=2e-6)
    assert path.time[-1] == pytest.approx(14.0 / (G * 0.7), rel=2e-6)
    assert path.rest.y == pytest.approx(0.0, abs=1e-9)
    assert path.rest.heading == pytest.approx(heading, abs=1e-9)
    # In between a parabola, which a cubic holds.
    assert path.x == pytest.approx(14.0 * path.time - 0.5 * G * 0.7 * path.time**2, abs=1e-4)


@pytest.mark.parametrize(("lock", "arm"), [(1.0, ARM), (0.0, 1.35)])
def test_a_spin_on_the_spot(lock, arm):
    """Locked wheels drag at their arm, free ones, which slide sideways, at half the wheelbase: w**2
    I / (2 mu m g arm).
    """
    path = drive(moving(0.0, 0.0, -5.0), friction=0.7, lock=lock)
    assert path.rest.heading == pytest.approx(
        -25.0 * 2400.0 / (2 * 0.7 * 1500.0 * G * arm), rel=2e-6
    )
    assert path.time[-1] == pytest.approx(5.0 * 2400.0 / (0.7 * 1500.0 * G * arm), rel=2e-6)
    assert math.hypot(path.rest.x, path.rest.y) < 1e-9


@pytest.mark.parametrize(
    ("lock", "degrees"), [(0.1, 40.0), (0.35, 0.0), (0.35, 75.0), (0.8, 20.0), (0.0, 90.0)]
)
def test_without_yaw_the_drag_is_that_of_path(lock, degrees):
    """A body that cannot turn, at a crab angle where the tyre slides: at first its force along the
    course is that of ``path``.
    """
    heading = math.radians(degrees)
    path = drive(
        CAR.replace(heading=heading, yaw_inertia=math.inf), friction=0.7, lock=lock, moments=3001
    )
    slowed = -np.diff(path.x[:3], 2)[0] / path.time[1] ** 2 / G
    run = travel.path([(0, 0), (1, 0)], [heading] * 2, friction=0.7, lock=lock)
    # Second differences of 3000 moments: the acceleration changes by 1e-3 in one of them.
    assert slowed == pytest.approx(run.drags[0], rel=3e-3)


@pytest.mark.slow
def test_a_rolling_wheel_recovers_as_fiala_has_it():
    """Little slip at 10 m/s on free wheels: the sideways speed falls as z' = -(c g / v)(z - z**2 +
    z**3 / 3), z = c tan / (3 mu).

    Time from z to 0.1 by quadrature; with lock 0.02 the speed falls by 0.4 % in it.
    """
    cornering, mu, v = 9.5, 0.7, 10.0
    first = 0.6 * 3 * mu / cornering * v
    start = moving(v, first, 0.0).replace(yaw_inertia=math.inf)
    path = drive(start, friction=mu, lock=0.02, moments=20_001)
    z = np.linspace(0.1, 0.6, 20_001)
    rate = cornering * G / v * (z - z**2 + z**3 / 3)
    wanted = float(np.sum((1 / rate[1:] + 1 / rate[:-1]) / 2 * np.diff(z)))
    sideways = np.gradient(path.y, path.time)
    found = float(np.interp(-0.1 * 3 * mu / cornering * v, -sideways, path.time))
    assert found == pytest.approx(wanted, rel=8e-3)
    assert path.rest.heading == 0.0


# An independent integration, and energy

CASES = {
    "locked": (13.0, 3.0, 4.0, 0.3, 1.0, 0.0),
    "half": (13.0, -4.0, -3.0, 0.0, 0.4, 0.0),
    "one jammed": (12.0, 2.0, 3.5, -0.4, (1.0, 0.08, 0.08, 0.08), 0.0),
    "steered": (15.0, 0.0, 0.5, 0.0, (0.3, 0.3, 0.15, 0.15), 0.2),
    "backward": (-8.0, 1.0, 2.0, 0.2, (0.2, 0.5, 0.2, 0.5), -0.1),
}


def scene(number):
    """A random scene: every kind of lock, steer, area, height and slope."""
    generator = np.random.default_rng(number)
    start = [
        *(generator.uniform(4.0, 16.0) * np.array([1.0, 0.0])),
        *generator.normal(0.0, [3.0, 2.0]),
    ]
    vx, vy, w = start[0], start[2], start[3]
    kind = number % 4
    lock = (
        float(generator.uniform(0.15, 1.0)), 1.0, generator.choice([0.05, 0.1, 0.4, 1.0], 4),
            generator.uniform(0.1, 1.0, 4)
    )[kind]  # fmt: skip
    tyres = {
        "friction": float(generator.uniform(0.4, 0.9)),
        "lock": lock,
        "wheelbase": 2.6,
        "track": 1.5,
    }
    if number % 5 == 1:
        tyres["steer"] = float(generator.uniform(-0.4, 0.4))
    if number % 5 == 2:
        tyres["height"] = float(generator.uniform(0.3, 0.6))
    if number % 7 == 0:
        tyres["cornering"] = float(generator.uniform(6.0, 12.0))
    surfaces = None
    if number % 3 == 1:
        x, y = generator.uniform(1.0, 12.0), generator.uniform(-8.0, 0.0)
        sizes = generator.uniform(1.0, 8.0, 2)
        corners = [(x, y), (x + sizes[0], y), (x + sizes[0], y + sizes[1]), (x, y + sizes[1])]
        surfaces = [(corners, float(generator.uniform(0.05, 0.9)))]
    slope = tuple(generator.uniform(-0.03, 0.03, 2)) if number % 6 == 5 else (0.0, 0.0)
    return (vx, vy, w, 0.0, 0.0, float(generator.normal())), tyres, surfaces, slope


@pytest.mark.slow
@pytest.mark.parametrize("number", range(30))
def test_an_independent_integration_comes_to_the_same_rest(number):
    """scipy's method in another variable, by angles, wheel by wheel: the promised place and
    heading, for 30 random scenes.
    """
    start, tyres, surfaces, slope = scene(number)
    (x, y, heading), way, time, _ = integrated(start, tyres, surfaces, slope)
    vehicle = moving(*start[:3], start[5])
    lock = tyres["lock"] if np.ndim(tyres["lock"]) == 0 else list(tyres["lock"])
    path = drive(vehicle, **{**tyres, "lock": lock}, surfaces=surfaces, slope=slope)
    assert math.dist((path.rest.x, path.rest.y), (x, y)) < PROMISE * way
    assert path.rest.heading == pytest.approx(heading, abs=PROMISE)
    assert path.time[-1] == pytest.approx(time, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("lock", "rotating"), [(0.1, 0.03), (0.6, 0.08)])
def test_wheels_that_turn_lengthen_a_straight_run_by_what_they_weigh(lock, rotating):
    """Their energy is that of so much more mass, which the brakes take too; locked wheels have
    none.
    """
    whole = CAR.vx**2 / (2.0 * G * 0.7 * lock)
    path = drive(CAR, lock=lock, rotating_mass=rotating)
    assert path.rest.x == pytest.approx((1.0 + rotating) * whole, rel=1e-5)
    locked = drive(CAR, lock=1.0, rotating_mass=rotating)
    assert locked.rest.x == pytest.approx(lock * whole, rel=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_wheels_that_turn_against_an_integration_without_a_term_left_out(name):
    """The rotation of the wheels, iterated until it is consistent: what it adds to the way is a
    few percent, of which a twentieth may be left out.
    """
    vx, vy, w, heading, lock, steer = CASES[name]
    tyres = {"friction": 0.7, "lock": lock, "wheelbase": 2.7, "track": 1.5, "steer": steer}
    rotating = 0.03

    def forced(state, tyres, ground):
        return with_rotation(state, tyres, ground, rotating)

    start = (vx, vy, w, 0.0, 0.0, heading)
    (x, y, turned), way, _, _ = integrated(start, tyres, rtol=1e-6, forced=forced)
    tyres["lock"] = list(lock) if np.ndim(lock) else lock
    path = drive(moving(vx, vy, w, heading), **tyres, rotating_mass=rotating)
    assert math.dist((path.rest.x, path.rest.y), (x, y)) < 2e-3 * way
    assert path.rest.heading == pytest.approx(turned, abs=5e-3)


@pytest.mark.slow
def test_wheels_that_turn_in_a_batch_and_in_a_mirror():
    """Each case of a batch as alone; the mirrored scene comes to the mirrored rest."""
    rates = np.linspace(-3.0, 3.0, 24)
    many = drive(CAR.replace(yaw_rate=rates), lock=0.2, rotating_mass=np.linspace(0.0, 0.06, 24))
    one = drive(CAR.replace(yaw_rate=rates[20]), lock=0.2, rotating_mass=0.06 * 20 / 23)
    other = drive(CAR.replace(yaw_rate=-rates[20]), lock=0.2, rotating_mass=0.06 * 20 / 23)
    assert many.rest.x[20] == pytest.approx(one.rest.x, abs=1e-3)
    assert many.rest.y[20] == pytest.approx(one.rest.y, abs=1e-3)
    assert (other.rest.x, other.rest.y) == pytest.approx((one.rest.x, -one.rest.y), abs=1e-6)
    free = drive(CAR.replace(yaw_rate=rates[0]), lock=0.2)
    assert many.rest.x[0] == pytest.approx(free.rest.x, abs=1e-3)


# Until a time


def test_a_car_that_nothing_slows_is_followed_until_a_time_and_has_no_rest():
    """Straight on it is where its speed takes it; spun, it rolls on with what its tyres leave."""
    with pytest.raises(col.NoSolutionError, match="or until, the time") as caught:
        drive(CAR, lock=0.0)
    assert caught.value.code == "never_stops"
    path = drive(CAR, lock=0.0, until="3 s")
    assert path.time[-1] == pytest.approx(3.0, rel=1e-12)
    assert (path.end.x, path.end.vx) == pytest.approx((42.0, 14.0), rel=1e-12)
    assert path.at(1.5).x == pytest.approx(21.0, rel=1e-12)
    spun = drive(moving(12.0, 2.0, 2.5), lock=0.0, until=20.0)
    early, late = spun.at(10.0), spun.end
    assert late.speed == pytest.approx(early.speed, rel=1e-6)
    assert late.x - early.x == pytest.approx(10.0 * late.vx, rel=1e-6)
    assert late.speed < 12.0
    for stopped in (path, spun):
        with pytest.raises(col.NoSolutionError, match="did not come to rest within") as caught:
            _ = stopped.rest
        assert caught.value.code == "never_stops"
        with pytest.raises(col.InputError, match="give simulate a later until"):
            stopped.at(21.0)
        assert "end.x=" in repr(stopped)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_until_a_time_is_the_beginning_of_the_whole(name):
    """At the time where it is left, and before; a later time changes nothing."""
    vx, vy, w, heading, lock, steer = CASES[name]
    lock = list(lock) if np.ndim(lock) else lock
    whole = drive(moving(vx, vy, w, heading), lock=lock, steer=steer, moments=1001)
    part = drive(moving(vx, vy, w, heading), lock=lock, steer=steer, moments=1001, until=1.0)
    for time in (0.4, 1.0):
        one, other = whole.at(time), part.at(time)
        for what in ("x", "y", "heading", "vx", "vy", "yaw_rate"):
            assert getattr(one, what) == pytest.approx(getattr(other, what), abs=2e-4), what
    later = drive(moving(vx, vy, w, heading), lock=lock, steer=steer, until="1 min")
    assert later.rest.x == whole.rest.x
    assert later.time[-1] == whole.time[-1]


@pytest.mark.slow
def test_until_a_time_in_a_batch():
    """Each case as alone; those that move at its end have no rest and no later place."""
    locks, until = np.linspace(0.0, 1.0, 24), np.where(np.arange(24) % 2, 2.0, 30.0)
    many = drive(moving(12.0, 1.0, 1.0), lock=locks, until=until)
    for at in (0, 1, 2, 23):
        one = drive(moving(12.0, 1.0, 1.0), lock=locks[at], until=until[at])
        assert many.end.x[at] == pytest.approx(one.end.x, abs=2e-3)
        assert many.end.vx[at] == pytest.approx(one.end.vx, abs=2e-3)
    moves = many.end.vx != 0.0
    assert moves[:2].all()
    assert not moves[-1]
    assert np.isnan(many.rest.x).tolist() == moves.tolist()
    assert many.rest.vx[-1] == 0.0
    assert np.isnan(many.at(40.0).x).tolist() == moves.tolist()
    with pytest.warns(col.CollisionsWarning, match="1 of 2 cases .*1 not_positive"):
        drive(CAR, lock=np.array([0.1, 0.2]), until=np.array([1.0, -1.0]))


def test_what_slides_on_down_a_slope_is_followed_until_a_time():
    """A slope of 20 % against locked wheels of friction 0.1: half g times the difference, and the
    cosine of the angle for what presses, and once more for the place in plan.
    """
    path = drive(CAR, friction=0.1, lock=1.0, slope=(-0.2, 0.0), until=2.0)
    cosine = math.cos(math.atan(0.2))
    push = 0.1 * G * cosine
    assert path.end.x == pytest.approx(cosine * (28.0 + 0.5 * push * 4.0), rel=1e-6)
    assert path.end.vx == pytest.approx(14.0 + push * 2.0, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_places_and_velocities_on_the_way(name):
    """Against the same integration: within 2 mm and 1 mrad beside the promise, and velocities
    within 0.01 m/s; ``at`` too.
    """
    vx, vy, w, heading, lock, steer = CASES[name]
    tyres = {"friction": 0.7, "lock": lock, "wheelbase": 2.7, "track": 1.5, "steer": steer}
    *_, end = integrated((vx, vy, w, 0.0, 0.0, heading), tyres)
    path = drive(
        moving(vx, vy, w, heading), lock=list(np.broadcast_to(lock, 4)), steer=steer, moments=301
    )
    within = {"x": 2e-3, "y": 2e-3, "heading": 1e-3, "vx": 1e-2, "vy": 1e-2, "yaw_rate": 1e-2}
    times = path.time[path.time < end.y[6, -1]]
    for row, column in (("vx", 0), ("vy", 1), ("yaw_rate", 2), ("x", 3), ("y", 4), ("heading", 5)):
        wanted = np.interp(times, end.y[6], end.y[column])
        # The steps of the other are joined by straight lines.
        finest = np.max(np.abs(np.diff(end.y[column]))) ** 2
        assert getattr(path, row)[: len(times)] == pytest.approx(
            wanted, abs=within[row] + PROMISE + 0.2 * finest
        ), row
    for moment in (0.0, 0.37, 0.5 * path.time[-1], path.time[-1], 99.0):
        there = path.at(moment)
        for row in within:
            assert getattr(there, row) == pytest.approx(
                np.interp(moment, path.time, getattr(path, row)), abs=3e-3
            ), row
    assert path.at(99.0) == path.rest
    assert path.at("0 s").vx == pytest.approx(vx)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_the_tyres_take_the_energy_that_there_was(name):
    """The work of the forces along the path that was found is the kinetic energy, which never
    rises.
    """
    vx, vy, w, heading, lock, steer = CASES[name]
    start = moving(vx, vy, w, heading)
    path = drive(start, lock=list(np.broadcast_to(lock, 4)), steer=steer, moments=2001)
    tyres = {"friction": 0.7, "lock": lock, "wheelbase": 2.7, "track": 1.5, "steer": steer}
    motion = np.array([path.vx, path.vy, path.yaw_rate, path.x, path.y, path.heading])
    energy = 750.0 * (motion[0] ** 2 + motion[1] ** 2) + 1200.0 * motion[2] ** 2
    assert np.all(np.diff(energy) <= 1e-9 * energy[0])
    power = []
    for state in motion[:, :-1].T:
        ax, ay, turning = accelerations(state, tyres, lambda x, y: np.full(4, 0.7))
        power.append(-1500.0 * (ax * state[0] + ay * state[1]) - 2400.0 * turning * state[2])
    power = np.array([*power, 0.0])
    work = float(np.sum((power[1:] + power[:-1]) / 2 * np.diff(path.time)))
    assert work == pytest.approx(start.kinetic_energy, rel=1e-3)


# Areas and slopes

STRIP = [(11.5, -9.0), (14.5, -9.0), (14.5, 9.0), (11.5, 9.0)]


def test_a_strip_of_ice_is_not_stepped_over():
    """Locked wheels at 30 m/s over 3 m of no friction: each axle skids 3 m less of it, so that the
    rest is 3 m further.
    """
    car = CAR.replace(vx=30.0)
    plain, iced = drive(car), drive(car, surfaces=[(STRIP, 0.0)])
    assert plain.rest.x == pytest.approx(30.0**2 / (2 * G * 0.7), rel=1e-12)
    assert round(plain.rest.x, 3) == 65.553
    assert round(iced.rest.x, 3) == 68.553
    assert iced.rest.x - plain.rest.x == pytest.approx(3.0, abs=1e-4)


def in_closed_form(vx, friction, strips):
    """Where a car on locked wheels comes to rest straight ahead: the energy that each axle takes
    over each strip.
    """

    def taken(x):
        total = 0.0
        for axle in (1.35, -1.35):
            total += friction * x
            for low, high, mu in strips:
                total += (mu - friction) * max(0.0, min(x + axle, high) - max(axle, low))
        return G * total / 2

    low, high = 0.0, 1e4
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if taken(middle) < 0.5 * vx**2 else (low, middle)
    return low


@pytest.mark.slow
def test_straight_skids_over_strips_in_closed_form():
    """400 random ones, in one batch and some alone: to a hundred-thousandth of the way, where the
    promise is a thousandth.
    """
    generator = np.random.default_rng(7)
    vx, friction, mu = (
        generator.uniform(3, 35, 400),
        generator.uniform(0.3, 0.9, 400),
        generator.uniform(0, 1, (2, 400)),
    )
    edges = [(3.0, 3.7), (9.0, 12.0)]
    surfaces = [
        ([(a, -9), (b, -9), (b, 9), (a, 9)], part) for (a, b), part in zip(edges, mu, strict=True)
    ]
    path = drive(CAR.replace(vx=vx), friction=friction, surfaces=surfaces, moments=2)
    for i in range(400):
        strips = [(a, b, part[i]) for (a, b), part in zip(edges, mu, strict=True)]
        wanted = in_closed_form(vx[i], friction[i], strips)
        assert path.rest.x[i] == pytest.approx(wanted, rel=1e-5), i
        if i % 40 == 0:
            one = [(corners, float(part[i])) for corners, part in surfaces]
            alone = drive(
                CAR.replace(vx=float(vx[i])), friction=float(friction[i]), surfaces=one, moments=2
            )
            assert alone.rest.x == pytest.approx(wanted, rel=1e-5)


def test_marks_end_at_edges():
    """Wheels of lock 0.4 that are locked on ice alone, straight ahead: marks at the moments on the
    ice, by each wheel's place.
    """
    path = drive(CAR.replace(vx=20.0), lock=0.4, surfaces=[(STRIP, 0.1)], moments=2001)
    for (x, _), place in zip(path.marks, (1.35, 1.35, -1.35, -1.35), strict=True):
        on = (path.x + place > 11.5) & (path.x + place < 14.5)
        assert on.sum() > 20
        assert np.array_equal(np.isfinite(x), on)


@pytest.mark.parametrize("rise", [0.05, -0.05, 0.12])
@pytest.mark.parametrize("course", [0.0, 2.1])
def test_a_skid_on_a_slope(rise, course):
    """Straight up or down: the distance of ``travel.distance`` with that grade, in whatever
    direction.
    """
    slope = (rise * math.cos(course), rise * math.sin(course))
    car = CAR.replace(vx=14.0 * math.cos(course), vy=14.0 * math.sin(course), heading=0.4)
    path = drive(car, slope=slope)
    found = math.hypot(path.rest.x, path.rest.y)
    way = travel.distance(14.0, drag=0.7, grade=rise)
    assert found == pytest.approx(way, rel=1e-6)
    assert path.time[-1] == pytest.approx(travel.time(way, drag=0.7, grade=rise), rel=5e-5)


def on_inclined_plane(slope, friction, course, speed=14.0):
    """A block on a plane in space: its velocity and gravity as vectors, friction times what presses
    across the plane against its motion. Time to rest, and where, seen from above.
    """
    up = np.array([-slope[0], -slope[1], 1.0])
    up /= np.linalg.norm(up)
    weight = np.array([0.0, 0.0, -G])
    # The axes of the scene, turned about the level line through the plane onto it.
    level = np.cross([0.0, 0.0, 1.0], up)
    sine = np.linalg.norm(level)
    level /= sine
    ahead = np.array([math.cos(course), math.sin(course), 0.0])
    ahead = ahead * up[2] + np.cross(level, ahead) * sine + level * (level @ ahead) * (1.0 - up[2])
    assert abs(ahead @ up) < 1e-12
    press = -(weight @ up)
    pull = weight + press * up

    def rates(_, state):
        velocity = state[3:]
        return [
            *velocity,
            *(pull - friction * press * velocity / max(np.linalg.norm(velocity), 1e-12)),
        ]

    def slow(_, state):
        return np.linalg.norm(state[3:]) - 1e-4

    slow.terminal = True
    begin = [0.0, 0.0, 0.0, *(speed * ahead)]
    end = solve_ivp(rates, (0.0, 99.0), begin, rtol=1e-10, atol=1e-10, events=slow, method="LSODA")
    assert end.status == 1
    return end.t[-1], end.y[:2, -1]


@pytest.mark.parametrize("rise", [0.05, 0.1, 0.2])
@pytest.mark.parametrize("course", [0.0, 1.2, math.pi / 2, 2.0, math.pi])
def test_time_and_place_of_a_skid_on_an_inclined_plane(rise, course):
    """Up, down and across: to 1e-4, of which the promise is ten times that."""
    slope = (0.8 * rise, 0.6 * rise)
    time, place = on_inclined_plane(slope, 0.7, course)
    car = CAR.replace(vx=14.0 * math.cos(course), vy=14.0 * math.sin(course), heading=0.4)
    path, near = drive(car, slope=slope), 1e-4 * np.hypot(*place)
    assert path.time[-1] == pytest.approx(time, rel=1e-4)
    assert (path.rest.x, path.rest.y) == pytest.approx(tuple(place), abs=near)
    # Of a batch, with the level beside it.
    both = np.array([1.0, 0.0])
    many = drive(car, slope=(slope[0] * both, slope[1] * both))
    assert many.time[-1] == pytest.approx([time, 14.0 / (0.7 * G)], rel=1e-4)
    assert many.rest.x[0] == pytest.approx(place[0], abs=near)


@pytest.mark.slow
@pytest.mark.parametrize("rise", [0.05, 0.1, 0.2])
def test_a_turning_car_on_a_slope(rise):
    """A spun car with a jammed wheel, over ice on the slope, against scipy's integration: the rates
    of places are the velocities seen from above. To what the docstring promises.
    """
    slope = (0.6 * rise, -0.8 * rise)
    tyres = {"friction": 0.7, "lock": [1, 0.3, 0.3, 0.3], "wheelbase": 2.7, "track": 1.5}
    surfaces = [([(6, -9), (9, -9), (9, 9), (6, 9)], 0.2)]
    for areas in (None, surfaces):
        (x, y, heading), way, time, _ = integrated((13, 2, 3, 0, 0, 0.3), tyres, areas, slope)
        car = CAR.replace(vx=13.0, vy=2.0, yaw_rate=3.0, heading=0.3)
        path = drive(car, **tyres, surfaces=areas, slope=slope)
        assert (path.rest.x, path.rest.y) == pytest.approx((x, y), abs=1e-3 * way)
        assert path.rest.heading == pytest.approx(heading, abs=1e-3)
        assert path.time[-1] == pytest.approx(time, rel=1e-3)


def test_a_slope_that_the_brakes_do_not_hold_is_refused():
    """A car that stops uphill and rolls back, one that speeds up, and one that stands; across the
    slope it holds.
    """
    for car in (CAR, CAR.replace(vx=-14.0), CAR.replace(vx=0.0), CAR.replace(yaw_rate=1.0)):
        with pytest.raises(col.NoSolutionError, match="slope") as caught:
            drive(car, lock=0.05, slope=(0.1, 0.0))
        assert caught.value.code == "never_stops"
    assert drive(CAR.replace(vx=0.0), lock=0.15, slope=(0.1, 0.0)).rest.x == 0.0
    assert (
        drive(CAR.replace(vx=0.0, heading=math.pi / 2), lock=0.05, slope=(0.1, 0.0)).rest.x == 0.0
    )
    vx = np.array([14.0, 14.0, 0.0])
    with pytest.warns(col.CollisionsWarning, match="1 of 3"):
        path = drive(
            CAR.replace(vx=vx), lock=np.array([0.05, 0.3, 0.3]), slope=(0.1, 0.0), moments=2
        )
    assert np.isfinite(path.rest.x).tolist() == [False, True, True]


@pytest.mark.slow
def test_load_transfer_moves_the_rest_of_spins_only():
    """Locked wheels straight ahead use the whole friction under any load; spun, the rest moves by
    some percent.
    """
    assert drive(CAR, height=0.55).rest.x == pytest.approx(drive(CAR).rest.x, rel=1e-9)
    spun = moving(12.0, 2.0, 4.0)
    plain, high, low = (
        drive(spun, lock=0.3, height=height, tolerance=1e-9) for height in (None, 0.55, 1e-9)
    )
    assert (
        1e-3
        < math.dist((plain.rest.x, plain.rest.y), (high.rest.x, high.rest.y)) / plain.rest.x
        < 0.15
    )
    assert (low.rest.x, low.rest.heading) == pytest.approx(
        (plain.rest.x, plain.rest.heading), rel=1e-5
    )


@pytest.mark.slow
def test_a_braked_wheel_that_stands_does_not_chatter():
    """A car that turns about its jammed wheel, and cars let on their brakes: a few hundred steps,
    not thousands.
    """
    generator = np.random.default_rng(2)
    most = 0
    counted_steps = motion._of_floats

    for _ in range(60):
        vx, vy, w = generator.normal(0.0, [4.0, 3.0, 4.0])
        # One wheel at least that is held; a car that hardly slows takes many steps because it goes
        # far.
        lock = generator.permuted([1.0, *generator.choice([0.0, 0.05, 0.5, 1.0], 3)]).tolist()
        steps = 0

        def counting(settings):
            step, forced = counted_steps(settings)

            def one(numbers):
                nonlocal steps
                steps += 1
                return step(numbers)

            return one, forced

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(motion, "_of_floats", counting)
            drive(moving(vx, vy, w), lock=lock, moments=2)
        most = max(most, steps)
    assert most < 1000


@pytest.mark.slow
def test_all_cases_of_a_long_run_keep_the_promise(request):
    """The default tolerance against a hundred times tighter steps, with and without areas."""
    generator = np.random.default_rng(11)
    count = 100
    cars = CAR.replace(
        vx=generator.uniform(3, 18, count), vy=generator.normal(0, 3, count),
        yaw_rate=generator.normal(0, 2.5, count),
        heading=generator.normal(0, 1, count),
    )  # fmt: skip
    lock = [generator.uniform(0.05, 1.0, count) for _ in range(4)]
    for surfaces in (None, [(STRIP, 0.15)]):
        fine, plain = (
            drive(cars, lock=lock, surfaces=surfaces, tolerance=tol) for tol in (5e-9, 5e-7)
        )
        way = np.hypot(np.diff(fine.x, axis=0), np.diff(fine.y, axis=0)).sum(axis=0)
        off = np.hypot(fine.rest.x - plain.rest.x, fine.rest.y - plain.rest.y) / way
        assert np.max(off) < PROMISE
        assert np.max(np.abs(fine.rest.heading - plain.rest.heading)) < PROMISE


def test_the_scene_may_be_turned_moved_and_mirrored():
    """Places turn with it; a mirror exchanges left and right wheels."""
    vx, vy, w, heading, lock, steer = CASES["one jammed"]
    here = drive(moving(vx, vy, w, heading), friction=0.7, lock=list(lock), steer=steer)
    there = drive(
        moving(-vy, vx, w, heading + math.pi / 2).replace(x=500.0, y=-200.0),
        friction=0.7,
        lock=list(lock),
        steer=steer,
    )
    assert (there.rest.x - 500.0, there.rest.y + 200.0) == pytest.approx(
        (-here.rest.y, here.rest.x), abs=1e-6
    )
    mirrored = drive(
        moving(vx, -vy, -w, -heading),
        friction=0.7,
        lock=[lock[1], lock[0], lock[3], lock[2]],
        steer=-steer,
    )
    assert (mirrored.rest.x, -mirrored.rest.y, -mirrored.rest.heading) == pytest.approx(
        (here.rest.x, here.rest.y, here.rest.heading), abs=1e-9
    )


def test_mass_does_not_matter_but_its_share_in_the_inertia_does():
    """Friction is in proportion to mass; extremes of it and of the speed, whose rest is in
    proportion to its square.
    """
    one = drive(moving(10.0, 2.0, 3.0), friction=0.7, lock=0.5)
    for factor in (1e-150, 1e150):
        other = moving(10.0, 2.0, 3.0).replace(mass=1500.0 * factor, yaw_inertia=2400.0 * factor)
        assert drive(other, friction=0.7, lock=0.5).rest.x == pytest.approx(one.rest.x, rel=1e-9)
    tiny = drive(moving(1e-60, 0.0, 0.0), friction=0.7, lock=1)
    assert tiny.rest.x == pytest.approx(1e-120 / (2 * G * 0.7), rel=1e-5)


# What comes out


@pytest.mark.slow
def test_marks_are_left_where_a_tyre_slides():
    """Locked wheels mark all their way, at their places; free ones only where they slide across."""
    path = drive(CAR, friction=0.7, lock=[1, 0.05, 0.05, 0.05])
    (fx, fy), (gx, _), *_ = path.marks
    c, s = np.cos(path.heading), np.sin(path.heading)
    assert fx == pytest.approx(path.x + 1.35 * c - 0.75 * s, abs=1e-12)
    assert fy == pytest.approx(path.y + 1.35 * s + 0.75 * c, abs=1e-12)
    assert np.isnan(gx).any()
    straight = drive(CAR, friction=0.7, lock=0.05)
    assert all(np.isnan(part).all() for mark in straight.marks for part in mark)
    broadside = drive(
        CAR.replace(heading=math.pi / 2, yaw_inertia=math.inf), friction=0.7, lock=0.05
    )
    assert all(np.isfinite(part).all() for mark in broadside.marks for part in mark)


def test_a_simulated_path_is_a_frozen_record_with_units():
    """Locked arrays of the moments, a Vehicle at rest that counts its turns, pickles."""
    path = drive(moving(9.0, 0.0, 9.0).replace(name="A"), friction=0.6, lock=0.6, moments=7)
    assert path.time.shape == path.x.shape == path.marks[3][1].shape == (7,)
    assert (path.time[0], path.x[0], path.heading[0]) == (0.0, 0.0, 0.0)
    assert (path.rest.x, path.rest.y, path.rest.heading) == (
        path.x[-1],
        path.y[-1],
        path.heading[-1],
    )
    assert (path.rest.speed, path.rest.yaw_rate, path.rest.name, path.rest.mass) == (
        0.0,
        0.0,
        "A",
        1500.0,
    )
    assert path.rest.heading > 2 * math.pi
    assert not path.x.flags.writeable
    assert path.q.time.check("[time]")
    assert pickle.loads(pickle.dumps(path)) == path
    assert repr(path).startswith("SimulatedPath(time=array(7,) 0 to ")
    with pytest.raises(AttributeError):
        path.time = 3.0
    # The place of rest is what is compared with the scene.
    (part,) = (part for part in path.summary("us").parts if not part.folded)
    cells = dict(part.rows)
    assert cells["rest x"] == f"{path.rest.x / 0.3048:.2f} ft"
    assert cells["rest heading"] == f"{math.degrees(path.rest.heading):.0f}°"
    assert f"rest.y={path.rest.y:.6g} m" in repr(path)


def test_a_vehicle_at_rest_stays():
    """No time passes."""
    path = drive(moving(0.0, 0.0, 0.0), friction=0.7, lock=0)
    assert path.time.tolist() == path.x.tolist() == [0.0] * 101
    assert path.rest == moving(0.0, 0.0, 0.0)


@pytest.mark.slow
def test_a_batch_is_its_cases_and_refused_ones_are_nan():
    """Arrays of the vehicle, the ground and the wheels broadcast; each case is as alone, and its
    neighbours do not matter.
    """
    vx, w = np.array([10.0, 14.0, 9.0, math.nan, 12.0, 11.0]), np.array([[2.0], [-3.0]])
    friction = np.array([0.7, 0.5, 0.7, 0.7, 0.0, -0.7])
    jammed = np.array([0.5, 1.0, 1.5, 0.5, 0.5, 0.5])
    with pytest.warns(col.CollisionsWarning, match="8 of 12 cases") as caught:
        path = drive(
            moving(vx, 1.0, w), friction=friction, lock=[jammed, 0.3, 0.3, 0.3], moments=11
        )
    assert caught[0].message.fields["counts"] == {
        "not_finite": 2,
        "bad_friction": 2,
        "bad_fraction": 2,
        "never_stops": 2,
    }
    assert path.x.shape == path.marks[0][0].shape == (11, 2, 6)
    assert path.rest.x.shape == (2, 6)
    for i, j in np.ndindex(2, 2):
        alone = drive(
            moving(float(vx[j]), 1.0, float(w[i, 0])),
            friction=float(friction[j]),
            lock=[float(jammed[j]), 0.3, 0.3, 0.3],
            moments=11,
        )
        for name in ("time", "x", "y", "heading"):
            assert getattr(path, name)[:, i, j] == pytest.approx(
                getattr(alone, name), rel=1e-9, abs=1e-9
            ), name
    assert np.isnan(path.rest.heading[:, 2:]).all()
    assert np.isnan(path.time[:, :, 2:]).all()


@pytest.mark.slow
def test_last_digits_of_the_start_hardly_move_the_rest_over_areas():
    """By no more than they grow in the motion itself. In some cases wheels come to an edge to the
    last digit; in the last ones steps near rest, away from all edges, passed the digits on.
    """
    rng, count = np.random.default_rng(5), 1000
    drawn = {
        "mass": rng.uniform(900, 2500, count),
        "yaw_inertia": rng.uniform(1500, 3000, count),
        "x": rng.uniform(-9, 9, count),
        "y": rng.uniform(-5, 5, count),
        "heading": rng.uniform(-3, 3, count),
        "vx": rng.uniform(6, 22, count),
        "vy": rng.normal(0, 3, count),
        "yaw_rate": rng.normal(0, 2, count),
    }
    some = [*range(60), 654, 978, 100, 438, 807, 979, 593, 823, 230, 559, 676, 362]
    drawn = {name: numbers[some] for name, numbers in drawn.items()}
    surfaces = [([(3, -6), (9, -8), (10, 4), (4, 9)], 0.25)]
    surfaces += [([(-1, 3), (20, 7), (18, 14), (0, 12)], 0.4)]
    rests = []
    for last in (0.0, 2e-15):
        cars = {name: part * (1 + last * rng.choice([-1, 1], len(some)))
                for name, part in drawn.items()}  # fmt: skip
        tyres = travel.Tyres(0.7, [1, 0.1, 0.3, 0.1], 2.7, 1.5)
        path = travel.simulate(col.Vehicle(**cars), tyres, surfaces=surfaces, moments=2)
        rests.append([path.rest.x, path.rest.y, path.rest.heading])
    assert np.abs(np.subtract(*rests)).max() < 1e-9


@pytest.mark.slow
def test_a_case_rests_at_the_same_place_in_a_large_batch_and_alone():
    """In arrays, in floats, and in floats from where few cases are left, the numbers are the same:
    in two of these cases a last digit decides on which step a wheel comes to an edge.
    """
    generator = np.random.default_rng(5)
    low = {"mass": 900, "yaw_inertia": 1500, "x": -9, "heading": -3, "vx": 6}
    high = {"mass": 2500, "yaw_inertia": 3000, "x": 9, "heading": 3, "vx": 26}
    drawn = {name: generator.uniform(low[name], high[name], 1000) for name in low}
    drawn |= {"vy": generator.normal(0.0, 3.0, 1000), "yaw_rate": generator.normal(0.0, 2.0, 1000)}
    ground = {"surfaces": [([(5, -5), (15, -5), (15, 5), (5, 5)], 0.3)], "tolerance": 1e-5}
    path = drive(CAR.replace(**drawn), friction=0.7, lock=0.3, moments=2, **ground)
    for i in (*range(0, 1000, 50), 406, 621):
        one = CAR.replace(**{name: float(numbers[i]) for name, numbers in drawn.items()})
        alone = drive(one, friction=0.7, lock=0.3, moments=2, **ground)
        place = path.rest.x[i], path.rest.y[i]
        assert (alone.rest.x, alone.rest.y) == pytest.approx(place, rel=0, abs=1e-9), i


def test_arrays_stay_what_they_are():
    """float32 stays float32, an empty batch is an answer."""
    assert (
        drive(CAR.replace(vx=np.float32([3.0, 4.0])), friction=0.7, lock=1).rest.x.dtype
        == np.float32
    )
    empty = drive(CAR.replace(vx=np.array([])), friction=0.7, lock=1, moments=5)
    assert (empty.x.shape, empty.rest.x.shape) == ((5, 0), (0,))


def test_units_of_every_kind():
    """Texts and Quantities give the same rest."""
    wanted = drive(
        moving(10.0, 1.0, 2.0), friction=0.6, lock=0.4, wheelbase=2.6, track=1.6, steer=0.1
    )
    found = drive(
        moving("36 km/h", "1 m/s", 2.0), friction="60 %", lock=["40 %"] * 4, wheelbase="260 cm",
            track="1600 mm",
        steer=f"{math.degrees(0.1)} deg",
    )  # fmt: skip
    assert (found.rest.x, found.rest.y, found.rest.heading) == pytest.approx(
        (wanted.rest.x, wanted.rest.y, wanted.rest.heading), rel=1e-6
    )  # numbers that differ in their last digit may take other steps


# Evidence for fit


@pytest.mark.slow
def test_places_of_rest_are_evidence_for_fit():
    """Speed, course and yaw rate at separation from the place and heading of rest and the friction,
    within their errors.
    """
    truth = moving(12.0, 3.0, 2.5)
    rest = drive(truth, friction=0.7, lock=0.5, moments=2).rest

    def model(vx, vy, yaw_rate):
        end = drive(
            CAR.replace(vx=vx, vy=vy, yaw_rate=yaw_rate), friction=0.7, lock=0.5, moments=2
        ).rest
        return {"x": end.x, "y": end.y, "heading": end.heading}

    priors = {
        name: col.uncertainty.Normal(mean, 1.0)
        for name, mean in (("vx", 11.5), ("vy", 2.5), ("yaw_rate", 2.0))
    }
    observed = {
        "x": (rest.x, 0.1),
        "y": (rest.y, 0.1),
        "heading": (f"{rest.heading} rad", "0.03 rad"),
    }
    fit = reconstruct.fit(model, priors, observed)
    for name in priors:
        assert fit[name].value == pytest.approx(
            getattr(truth, name), abs=0.5 * fit[name].standard_error
        ), name
        assert fit[name].standard_error < 0.5


# Refusals


@pytest.mark.parametrize(
    ("vehicle", "options", "code", "said"),
    [
        (CAR, {"friction": -0.7}, "bad_friction", "friction must be >= 0, got -0.7"),
        (CAR, {"friction": math.nan}, "not_finite", "friction"),
        (CAR, {"friction": 0.0}, "never_stops", "nothing slows it, since friction or lock are 0"),
        (
            CAR.replace(yaw_rate=2.0),
            {"friction": 0.0},
            "never_stops",
            "nothing slows it, since friction or lock are 0",
        ),
        (
            CAR,
            {"lock": 0.0},
            "never_stops",
            "nothing slows it, since friction or lock are 0 (a wheel of lock 0 rolls on)",
        ),
        (
            CAR.replace(vy=2.0, yaw_rate=2.0),
            {"lock": 0.0},
            "never_stops",
            "a wheel of lock 0 rolls on",
        ),
        (CAR.replace(vx=0.01), {"lock": 0.0}, "never_stops", "a wheel of lock 0 rolls on"),
        (
            CAR,
            {"friction": 0.0, "lock": 0.5, "surfaces": [(STRIP, 0.7)]},
            "bad_friction",
            "the friction of the common ground",
        ),
        (CAR, {"height": 0.6, "surfaces": [(STRIP, 1.2)]}, "wheel_lifts", "a wheel lifts off"),
        (CAR, {"slope": 0.05}, "bad_shape", "slope must be a pair"),
        (
            CAR,
            {"tolerance": 1.0},
            "bad_option",
            "tolerance must be one number from 1e-10 to 0.01, got 1.0",
        ),
        (CAR, {"tolerance": np.ones(2)}, "bad_option", "tolerance must be one number"),
        (CAR, {"lock": 1.1}, "bad_fraction", "lock must be from 0 to 1, got 1.1"),
        (CAR, {"lock": math.nan}, "bad_fraction", "lock must be from 0 to 1"),
        (CAR, {"lock": [1, 1, 1, -1]}, "bad_fraction", "lock[3] must be from 0 to 1"),
        (
            CAR,
            {"lock": [1, 1]},
            "bad_shape",
            "lock is a list of 2; give one value for all wheels, or four: front left",
        ),
        (
            CAR,
            {"lock": np.ones(2), "friction": np.ones(3)},
            "bad_shape",
            "friction (3,), lock (2,)",
        ),
        (CAR, {"wheelbase": 0.0}, "not_positive", "wheelbase must be > 0, got 0.0"),
        (CAR, {"track": "-1 m"}, "not_positive", "track must be > 0, got '-1 m'"),
        (CAR, {"track": math.inf}, "not_finite", "track must be finite"),
        (CAR, {"track": -math.inf}, "not_positive", "track must be > 0, got -inf"),
        (CAR, {"steer": math.nan}, "not_finite", "steer is NaN"),
        (CAR, {"cornering": 0}, "not_positive", "cornering must be > 0"),
        (
            CAR,
            {"moments": 1},
            "bad_option",
            "moments must be a whole number from 2 to 100000, got 1",
        ),
        (CAR, {"moments": 10.0}, "bad_option", "got 10.0"),
        (CAR, {"until": 0.0}, "not_positive", "until must be > 0"),
        (CAR, {"rotating_mass": "11 kg"}, "bad_units", "rotating_mass"),
        (
            CAR,
            {"surfaces": [([(3, -9), (23, 9), (23, -9), (3, 9)], 0.2)]},
            "bad_outline",
            "surfaces[0] has sides that cross, from corner 0 to 1 and from 2 to 3",
        ),
        (CAR, {"surfaces": 0.7}, "bad_shape", "surfaces[0] must be a pair of corners"),
        (
            CAR,
            {"surfaces": [([(0, 0), (1, 1)], 0.5)]},
            "bad_shape",
            "surfaces[0] must be a pair of corners",
        ),
        (
            CAR,
            {"surfaces": [([(0, 0), (1, 1), (0, 1)], -0.5)]},
            "bad_friction",
            "surfaces[0] must be >= 0",
        ),
        (
            CAR,
            {"surfaces": [([(0, 0), (1, 1), (0, np.ones(2))], 0.5)]},
            "bad_shape",
            "the same for every case",
        ),
        (CAR.replace(heading=None), {}, "missing_heading", "has no heading, which simulate needs"),
        (CAR.replace(yaw_inertia=None), {}, "missing_inertia", "has no yaw_inertia"),
        (CAR.replace(x=None), {}, "missing_position", "has no x"),
        (CAR.replace(mass=math.inf), {}, "infinite_mass", "infinite"),
        (CAR.replace(pivot=(0.0, 5.0), vx=0.0), {}, "pinned", "is on a pivot"),
        ("car", {}, "not_a_vehicle", "vehicle must be a Vehicle, got str"),
        (CAR.replace(vx=1e200), {}, "out_of_range", "too large"),
    ],
)
def test_refused_simulations(vehicle, options, code, said):
    """No path comes of them, and the message says what to write."""
    with pytest.raises(col.CollisionsError) as caught:
        drive(vehicle, **{"friction": 0.7, "lock": 1, **options})
    assert caught.value.code == code
    assert said in str(caught.value)
    assert isinstance(caught.value, ValueError)


def test_all_wrong_arguments_are_named_at_once():
    """One error, one line for each."""
    with pytest.raises(col.InputError) as caught:
        travel.Tyres("y", 2, -1, "z", steer="north", cornering=-1)
    for name in ("friction", "lock", "wheelbase", "track", "steer", "cornering"):
        assert f"\n- {name}" in str(caught.value)
    with pytest.raises(col.InputError) as caught:
        travel.simulate("x", 0.7, slope=("a", 0), moments=0, tolerance=-1)
    for name in ("slope", "moments", "tolerance", "vehicle", "tyres"):
        assert f"\n- {name}" in str(caught.value)


def test_what_is_documented():
    """Every parameter, and the sections a reader needs."""
    text = inspect.getdoc(travel.simulate)
    for section in ("Parameters", "Returns", "Raises", "Warns", "Notes", "Examples"):
        assert f"\n{section}\n{'-' * len(section)}\n" in text
    for name in inspect.signature(travel.simulate).parameters:
        assert name in text.split("Parameters\n")[1].split("Returns\n")[0]


@pytest.mark.parametrize("lock", [0.001, 0.01, 0.3])
def test_at_follows_a_car_that_recovers_and_then_rolls_for_minutes(lock):
    """Its sideways motion ends within a second: the states there are those of many moments."""
    car = CAR.replace(vx=10.0, vy=-1.0)
    few, many = (drive(car, lock=lock, moments=moments) for moments in (101, 20_001))
    for time in (0.05, 0.2, 0.5, 1.0, 3.0):
        one, other = few.at(time), many.at(time)
        for name in ("x", "y", "heading", "vx", "vy", "yaw_rate"):
            assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-3, abs=2e-3)


@pytest.mark.parametrize("times", [np.array([1.0, 2.0]), np.array([[1.0], [2.0]]), np.zeros(0)])
def test_a_motion_of_one_case_is_asked_at_one_time(times):
    path = travel.simulate(CAR, travel.Tyres(0.7, 1.0, 2.7, 1.5))
    with pytest.raises(col.ShapeError, match=r"one case, at one time; .*have all moments") as found:
        path.at(times)
    assert (found.value.code, found.value.argument) == ("bad_shape", "time")
    assert path.at(np.array(1.0)).x == path.at(1.0).x


@pytest.mark.parametrize("times", [np.array([1.0, 2.0, 3.0]), np.ones((2, 1)), np.ones((3, 2))])
def test_a_motion_of_a_batch_is_asked_at_one_time_for_each_case(times):
    path = travel.simulate(CAR.replace(vx=np.array([14.0, 9.0])), travel.Tyres(0.7, 1.0, 2.7, 1.5))
    with pytest.raises(col.ShapeError, match="takes one value, or one for each case") as found:
        path.at(times)
    assert (found.value.code, found.value.argument) == ("bad_shape", "time")


@pytest.mark.slow
@pytest.mark.parametrize("lock", [[1, 0.05, 0.05, 0.05], [0.3, 0.02, 0.02, 0.02]])
@pytest.mark.parametrize("count", [1, 40])
def test_a_motion_that_keeps_its_direction_on_the_vehicle_ends_along_an_arc(
    lock, count, monkeypatch
):
    """Its last steps are left out, a quarter or more, and it rests where they would have led it."""
    speeds = np.linspace(9.0, 18.0, count) if count > 1 else 12.0
    car, tyres = CAR.replace(vx=speeds, vy=1.0, yaw_rate=1.0), travel.Tyres(0.7, lock, 2.7, 1.5)
    rows = []

    def counted_steps(*given):
        found = follow(*given)
        rows.append(found.rows.shape[1])
        return found

    follow = motion.follow
    monkeypatch.setattr(sys.modules["collisions.travel.simulate"], "follow", counted_steps)
    arc = travel.simulate(car, tyres)
    monkeypatch.setattr(motion, "_settled", lambda left, *others: left < 0.0)
    stepped = travel.simulate(car, tyres)
    assert rows[0] < 0.75 * rows[1]
    way = np.hypot(stepped.rest.x, stepped.rest.y)
    assert np.max(np.hypot(arc.rest.x - stepped.rest.x, arc.rest.y - stepped.rest.y) / way) < 1e-5
    assert np.max(np.abs(arc.rest.heading - stepped.rest.heading)) < 1e-5
    # On the way as well.
    late = 0.98 * stepped.time[-1]
    assert np.max(np.abs(arc.at(late).x - stepped.at(late).x)) < 1e-3
    assert np.max(np.abs(arc.at(late).heading - stepped.at(late).heading)) < 1e-4


@pytest.mark.slow
def test_areas_may_have_dents_holes_and_a_closing_corner():
    """A ring around a hole, its sides there and back along one line, as one list of corners."""
    car = col.Vehicle(mass=1500, yaw_inertia=2500, x=0, y=0, heading=0, vx=10, vy=0)
    tyres = travel.Tyres(0.7, 1.0, 2.7, 1.5)
    ring = [(-9, -9), (30, -9), (30, 9), (-9, 9), (-9, -9)]
    hole = [(-5, -5), (-5, 5), (25, 5), (25, -5), (-5, -5)]
    bare = travel.simulate(car, tyres)
    assert travel.simulate(car, tyres, surfaces=[([*ring, *hole], 0.2)]).x[-1] == bare.x[-1]
    dented = [(-9, -9), (30, -9), (30, 9), (12, 0), (-9, 9)]
    # Back at the first corner, as maps write areas.
    closed, open_ = (
        travel.simulate(car, tyres, surfaces=[(corners, 0.2)])
        for corners in ([*dented, dented[0]], dented)
    )
    assert closed.x[-1] == open_.x[-1] > bare.x[-1]
    # A corner given twice, sides that touch in a corner, and one there and back.
    touching = [(30, 9), (12, 0), (12, 0), (-9, 9), (-9, -9), (12, 0), (30, -9)]
    spiked = [(-9, -9), (30, -9), (40, -9), (30, -9), (30, 9), (12, 0), (-9, 9)]
    for corners in (touching, spiked):
        assert travel.simulate(car, tyres, surfaces=[(corners, 0.2)]).x[-1] > bare.x[-1]


def test_a_case_without_cornering_is_refused_beside_others():
    """Alone in its batch, where it is followed as one case is, and beside one with an answer."""
    car = col.Vehicle(mass=1500, yaw_inertia=2500, x=0.0, y=0.0, heading=0.3, vx=9.0, vy=2.0)
    for cornering in ([-0.0], [-0.0, 9.5]):
        tyres = travel.Tyres(0.7, 0.9, 2.7, 1.5, cornering=np.array(cornering))
        with pytest.warns(col.CollisionsWarning, match="1 not_positive"):
            found = travel.simulate(car, tyres)
        assert np.isnan(found.x[-1]).tolist() == [True, False][: len(cornering)]
