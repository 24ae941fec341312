"""``travel.simulate``: closed forms, an independent integration, the balance of energy, evidence
for ``fit``, and refusals.
"""

import inspect
import math
import pickle

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct, travel

G = travel.GRAVITY
CAR = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, x=0.0, y=0.0, heading=0.0, vx=14.0)
WHEELS = [(1.35, 0.75), (1.35, -0.75), (-1.35, 0.75), (-1.35, -0.75)]
ARM = math.hypot(1.35, 0.75)
# The promise of the docstring, for the place of rest over the way and for the heading [rad].
PROMISE = 1e-3


def tyre(along, across, lock, friction, cornering=9.5):
    """Force over load of one wheel, as the docstring has it, by the angle of slip; nothing where
    the wheel stands.
    """
    speed = math.hypot(along, across)
    if speed == 0.0:
        return 0.0, 0.0
    most = abs(across) / math.hypot(across, lock * along) if across else 0.0
    z = min(1.0, cornering * abs(math.tan(math.atan2(across, abs(along)))) / (3.0 * friction))
    if 1.0 - (1.0 - z) ** 3 < most:
        share = 1.0 - (1.0 - z) ** 3
        return -friction * lock * math.sqrt(1.0 - share**2) * math.copysign(
            1.0, along
        ), -friction * share * math.copysign(1.0, across)
    drag = math.hypot(across, lock * along)
    return -friction * lock**2 * along / drag, -friction * across / drag


def accelerations(state, lock, steer, friction, mass=1500.0, inertia=2400.0):
    """Of the centre of mass and in yaw, wheel by wheel; ``friction`` a function of the place of a
    wheel.
    """
    vx, vy, w, x, y, heading = state
    c, s = math.cos(heading), math.sin(heading)
    fx = fy = moment = 0.0
    for i, (a, b) in enumerate(WHEELS):
        turned = steer if i < 2 else 0.0
        rx, ry = c * a - s * b, s * a + c * b
        ux, uy = vx - w * ry, vy + w * rx
        ct, st = math.cos(heading + turned), math.sin(heading + turned)
        f, q = tyre(ct * ux + st * uy, ct * uy - st * ux, lock[i], friction(x + rx, y + ry))
        px, py = (f * ct - q * st) * mass * G / 4, (f * st + q * ct) * mass * G / 4
        fx, fy, moment = fx + px, fy + py, moment + rx * py - ry * px
    return fx / mass, fy / mass, moment / inertia


def integrated(start, lock, steer=0.0, friction=lambda x, y: 0.7, step=1e-3):
    """Classical Runge-Kutta in seconds; shorter steps where the motion is slow. At 1e-3 m/s it
    counts as rest.
    """

    def rates(state):
        return np.array([*accelerations(state, lock, steer, friction), *state[:3]])

    state, time, track = np.array(start, float), 0.0, []
    while (size := math.hypot(state[0], state[1], ARM * state[2])) > 1e-3:
        track.append((time, *state))
        h = min(step, 3e-3 * size)
        k1 = rates(state)
        k2 = rates(state + h / 2 * k1)
        k3 = rates(state + h / 2 * k2)
        k4 = rates(state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        time += h
    return state, time, np.array(track)


def moving(vx, vy, yaw_rate, heading=0.0):
    return CAR.replace(vx=vx, vy=vy, yaw_rate=yaw_rate, heading=heading)


# Closed forms


@pytest.mark.parametrize("heading", [0.0, 0.7, math.pi / 2, -2.5])
def test_a_straight_skid_on_locked_wheels(heading):
    """Whatever the heading, v**2 / (2 g mu) along the course in v / (g mu); 5e-7 is the force that
    a slow wheel lacks.
    """
    path = travel.simulate(CAR.replace(heading=heading), friction=0.7, lock=1)
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
    path = travel.simulate(moving(0.0, 0.0, -5.0), friction=0.7, lock=lock)
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
    path = travel.simulate(
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
    path = travel.simulate(start, friction=mu, lock=0.02, limit=600, moments=20_001)
    z = np.linspace(0.1, 0.6, 20_001)
    rate = cornering * G / v * (z - z**2 + z**3 / 3)
    wanted = float(np.sum((1 / rate[1:] + 1 / rate[:-1]) / 2 * np.diff(z)))
    sideways = np.gradient(path.y, path.time)
    found = float(np.interp(-0.1 * 3 * mu / cornering * v, -sideways, path.time))
    assert found == pytest.approx(wanted, rel=8e-3)
    assert path.rest.heading == 0.0


# An independent integration, and energy

CASES = {
    "locked": (13.0, 3.0, 4.0, 0.3, (1.0,) * 4, 0.0),
    "half": (13.0, -4.0, -3.0, 0.0, (0.4,) * 4, 0.0),
    "one jammed": (12.0, 2.0, 3.5, -0.4, (1.0, 0.08, 0.08, 0.08), 0.0),
    "steered": (15.0, 0.0, 0.5, 0.0, (0.3, 0.3, 0.15, 0.15), 0.2),
    "backward": (-8.0, 1.0, 2.0, 0.2, (0.2, 0.5, 0.2, 0.5), -0.1),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_an_independent_integration_comes_to_the_same_rest(name):
    """Another method in another variable, wheel by wheel: the promised place and heading; on the
    way 2 mm and 1 mrad.
    """
    vx, vy, w, heading, lock, steer = CASES[name]
    end, time, track = integrated((vx, vy, w, 0.0, 0.0, heading), lock, steer)
    path = travel.simulate(moving(vx, vy, w, heading), friction=0.7, lock=list(lock), steer=steer)
    way = float(np.sum(np.hypot(*np.diff(track[:, 4:6], axis=0).T)))
    assert math.dist((path.rest.x, path.rest.y), end[3:5]) < PROMISE * way
    assert path.rest.heading == pytest.approx(end[5], abs=PROMISE)
    assert path.time[-1] == pytest.approx(time, rel=1e-3)
    for found, column, within in ((path.x, 4, 2e-3), (path.y, 5, 2e-3), (path.heading, 6, 1e-3)):
        assert found[:-1] == pytest.approx(
            np.interp(path.time[:-1], track[:, 0], track[:, column]), abs=within + PROMISE
        )


@pytest.mark.slow
def test_an_area_of_grass_against_an_independent_integration():
    """Wheels that leave the road one after the other, onto friction 0.35."""
    corners = [(6.0, -50.0), (60.0, -50.0), (60.0, 50.0), (6.0, 50.0)]
    end, _, _ = integrated(
        (13.0, 1.0, 2.0, 0.0, 0.0, 0.0),
        (1.0,) * 4,
        friction=lambda x, y: 0.35 if x > 6.0 else 0.7,
        step=2e-3,
    )
    path = travel.simulate(moving(13.0, 1.0, 2.0), friction=0.7, lock=1, surfaces=[(corners, 0.35)])
    # The other integration steps over the edge, up to 26 mm late, where 0.35 of the friction is
    # lost: 0.1 % of its way.
    assert math.dist((path.rest.x, path.rest.y), end[3:5]) < 2e-3 * 20.0
    assert path.rest.heading == pytest.approx(end[5], abs=5e-3)
    assert path.rest.x > 1.2 * travel.simulate(moving(13.0, 1.0, 2.0), friction=0.7, lock=1).rest.x


@pytest.mark.parametrize(
    "name",
    [*list(CASES)[:2], *(pytest.param(name, marks=pytest.mark.slow) for name in list(CASES)[2:])],
)
def test_the_tyres_take_the_energy_that_there_was(name):
    """The work of the forces along the path that was found: kinetic energy to 0.3 %, for the
    trapezes of 2000 moments.
    """
    vx, vy, w, heading, lock, steer = CASES[name]
    start = moving(vx, vy, w, heading)
    path = travel.simulate(start, friction=0.7, lock=list(lock), steer=steer, moments=2001)
    motion = [np.gradient(part, path.time) for part in (path.x, path.y, path.heading)]
    power = []
    for state in zip(*motion, path.x, path.y, path.heading, strict=True):
        ax, ay, turning = accelerations(state, lock, steer, lambda x, y: 0.7)
        power.append(-1500.0 * (ax * state[0] + ay * state[1]) - 2400.0 * turning * state[2])
    work = float(np.sum((np.array(power)[1:] + np.array(power)[:-1]) / 2 * np.diff(path.time)))
    assert work == pytest.approx(start.kinetic_energy, rel=3e-3)


def test_the_scene_may_be_turned_moved_and_mirrored():
    """Places turn with it; a mirror exchanges left and right wheels."""
    vx, vy, w, heading, lock, steer = CASES["one jammed"]
    here = travel.simulate(moving(vx, vy, w, heading), friction=0.7, lock=list(lock), steer=steer)
    there = travel.simulate(
        moving(-vy, vx, w, heading + math.pi / 2).replace(x=500.0, y=-200.0),
        friction=0.7,
        lock=list(lock),
        steer=steer,
    )
    assert (there.rest.x - 500.0, there.rest.y + 200.0) == pytest.approx(
        (-here.rest.y, here.rest.x), abs=1e-6
    )
    mirrored = travel.simulate(
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
    one = travel.simulate(moving(10.0, 2.0, 3.0), friction=0.7, lock=0.5)
    for factor in (1e-150, 1e150):
        other = moving(10.0, 2.0, 3.0).replace(mass=1500.0 * factor, yaw_inertia=2400.0 * factor)
        assert travel.simulate(other, friction=0.7, lock=0.5).rest.x == pytest.approx(
            one.rest.x, rel=1e-9
        )
    tiny = travel.simulate(moving(1e-60, 0.0, 0.0), friction=0.7, lock=1)
    assert tiny.rest.x == pytest.approx(1e-120 / (2 * G * 0.7), rel=1e-5)


# What comes out


@pytest.mark.slow
def test_marks_are_left_where_a_tyre_slides():
    """Locked wheels mark all their way, at their places; free ones only where they slide across."""
    path = travel.simulate(CAR, friction=0.7, lock=[1, 0.05, 0.05, 0.05])
    (fx, fy), (gx, _), *_ = path.marks
    c, s = np.cos(path.heading), np.sin(path.heading)
    assert fx == pytest.approx(path.x + 1.35 * c - 0.75 * s, abs=1e-12)
    assert fy == pytest.approx(path.y + 1.35 * s + 0.75 * c, abs=1e-12)
    assert np.isnan(gx).any()
    straight = travel.simulate(CAR, friction=0.7, lock=0.05, limit=60)
    assert all(np.isnan(part).all() for mark in straight.marks for part in mark)
    broadside = travel.simulate(
        CAR.replace(heading=math.pi / 2, yaw_inertia=math.inf), friction=0.7, lock=0.05
    )
    assert all(np.isfinite(part).all() for mark in broadside.marks for part in mark)


def test_a_simulated_path_is_a_frozen_record_with_units():
    """Locked arrays of the moments, a Vehicle at rest that counts its turns, pickles."""
    path = travel.simulate(
        moving(9.0, 0.0, 9.0).replace(name="A"), friction=0.6, lock=0.6, moments=7
    )
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
    path = travel.simulate(moving(0.0, 0.0, 0.0), friction=0.7, lock=0)
    assert path.time.tolist() == path.x.tolist() == [0.0] * 101
    assert path.rest == moving(0.0, 0.0, 0.0)


def test_a_batch_is_its_cases_and_refused_ones_are_nan():
    """Arrays of the vehicle, the ground and the wheels broadcast; each case is as alone, and its
    neighbours do not matter.
    """
    vx, w = np.array([10.0, 14.0, 9.0, math.nan, 12.0, 11.0]), np.array([[2.0], [-3.0]])
    friction = np.array([0.7, 0.5, 0.7, 0.7, 0.0, -0.7])
    jammed = np.array([0.5, 1.0, 1.5, 0.5, 0.5, 0.5])
    with pytest.warns(col.CollisionsWarning, match="8 of 12 cases") as caught:
        path = travel.simulate(
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
        alone = travel.simulate(
            moving(float(vx[j]), 1.0, float(w[i, 0])),
            friction=float(friction[j]),
            lock=[float(jammed[j]), 0.3, 0.3, 0.3],
            moments=11,
        )
        for name in ("time", "x", "y", "heading"):
            # The same steps; numpy rounds sines of arrays of other lengths otherwise, and a step
            # can differ in its last digit.
            assert getattr(path, name)[:, i, j] == pytest.approx(
                getattr(alone, name), rel=1e-9, abs=1e-9
            ), name
    assert np.isnan(path.rest.heading[:, 2:]).all()
    assert np.isnan(path.time[:, :, 2:]).all()


def test_arrays_stay_what_they_are():
    """float32 stays float32, an empty batch is an answer."""
    assert (
        travel.simulate(CAR.replace(vx=np.float32([3.0, 4.0])), friction=0.7, lock=1).rest.x.dtype
        == np.float32
    )
    empty = travel.simulate(CAR.replace(vx=np.array([])), friction=0.7, lock=1, moments=5)
    assert (empty.x.shape, empty.rest.x.shape) == ((5, 0), (0,))


def test_units_of_every_kind():
    """Texts and Quantities give the same rest."""
    wanted = travel.simulate(
        moving(10.0, 1.0, 2.0), friction=0.6, lock=0.4, wheelbase=2.6, track=1.6, steer=0.1
    )
    found = travel.simulate(
        moving("36 km/h", "1 m/s", 2.0), friction="60 %", lock=["40 %"] * 4, wheelbase="260 cm",
            track="1600 mm",
        steer=f"{math.degrees(0.1)} deg", limit="1 min",
    )  # fmt: skip
    assert (found.rest.x, found.rest.y, found.rest.heading) == pytest.approx(
        (wanted.rest.x, wanted.rest.y, wanted.rest.heading), rel=1e-9
    )


# Evidence for fit


@pytest.mark.slow
def test_places_of_rest_are_evidence_for_fit():
    """Speed, course and yaw rate at separation from the place and heading of rest and the friction,
    within their errors.
    """
    truth = moving(12.0, 3.0, 2.5)
    rest = travel.simulate(truth, friction=0.7, lock=0.5, moments=2).rest

    def model(vx, vy, yaw_rate):
        end = travel.simulate(
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
        (CAR, {"friction": 0.0}, "never_stops", "friction or lock slow it too little"),
        (
            CAR,
            {"lock": 0.0},
            "never_stops",
            (
                "not at rest after 30 s: friction or lock slow it too little (a wheel of lock 0 "
                "rolls on)"
            ),
        ),
        (CAR, {"lock": 0.5, "limit": "1 s"}, "never_stops", "not at rest after 1 s"),
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
        (CAR, {"limit": "5 m"}, "bad_units", "limit"),
        (
            CAR,
            {"moments": 1},
            "bad_option",
            "moments must be a whole number from 2 to 100000, got 1",
        ),
        (CAR, {"moments": 10.0}, "bad_option", "got 10.0"),
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
        (CAR.replace(vx=1e200), {}, "never_stops", "not at rest"),
    ],
)
def test_refused_simulations(vehicle, options, code, said):
    """No path comes of them, and the message says what to write."""
    with pytest.raises(col.CollisionsError) as caught:
        travel.simulate(vehicle, **{"friction": 0.7, "lock": 1, **options})
    assert caught.value.code == code
    assert said in str(caught.value)
    assert isinstance(caught.value, ValueError)


def test_all_wrong_arguments_are_named_at_once():
    """One error, one line for each."""
    with pytest.raises(col.InputError) as caught:
        travel.simulate(
            "x", friction="y", lock=2, wheelbase=-1, track="z", steer="north", limit=-1, moments=0
        )
    for name in ("friction", "lock", "wheelbase", "track", "steer", "limit", "moments", "vehicle"):
        assert f"\n- {name}" in str(caught.value)


def test_what_is_documented():
    """Every parameter, and the sections a reader needs."""
    text = inspect.getdoc(travel.simulate)
    for section in ("Parameters", "Returns", "Raises", "Warns", "Notes", "Examples"):
        assert f"\n{section}\n{'-' * len(section)}\n" in text
    for name in inspect.signature(travel.simulate).parameters:
        assert name in text.split("Parameters\n")[1].split("Returns\n")[0]
