"""Simulated crashes that last: balances, symmetry, another integrator, the limit of an impulse."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import collisions as col
from scripts import benchmarks

ROOT = Path(__file__).resolve().parent.parent.parent

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (ROOT / "benchmarks").is_dir(), reason="the sdist has no benchmarks"),
]
SEED = 31


@pytest.fixture(scope="module")
def scripts():
    """The simulator, its population, and what is read of it."""
    return benchmarks("lasting_crashes", "lasting_population", "coverage_in_crashes")


@pytest.fixture(scope="module")
def lasting(scripts):
    """Three dozen crashes that last, with tyres."""
    return scripts[1].population(36, SEED)


@pytest.fixture(scope="module")
def instant(scripts):
    """The same crashes in 2 ms and without tyres."""
    return scripts[1].population(36, SEED, instant=True)


def after(contacts, crashes):
    """Changes of velocity and yaw rate of both cars."""
    before = np.stack([crashes.vx, crashes.vy, crashes.yaw_rate], axis=1)
    return contacts.after[:, 3:6] - before


def test_the_simulator_shares_no_code_with_the_package(scripts):
    for script in scripts[:2]:
        assert "collisions" not in Path(script.__file__).read_text(encoding="utf-8")


def test_momentum_energy_and_work_balance(scripts, lasting):
    """Contact: equal and opposite. Moment of momentum changes by that of the tyres. Energy too."""
    k, c = lasting.crashes, lasting.contacts
    size = np.hypot(c.impulse[0, 0], c.impulse[0, 1])
    assert np.all(np.abs(c.impulse.sum(axis=0)) < 1e-9 * size)

    def moments(x, y, vx, vy, yaw_rate):
        return k.inertia * yaw_rate + k.mass * (x * vy - y * vx)

    change = moments(*c.after[:, :2].swapaxes(0, 1), *c.after[:, 3:6].swapaxes(0, 1)) - moments(
        k.x, k.y, k.vx, k.vy, k.yaw_rate
    )
    by_tyres = c.after[:, scripts[0].TYRE_MOMENT].sum(axis=0)
    assert np.all(np.abs(change.sum(axis=0) - by_tyres) < 1e-6 * size)
    lost = c.energy_before.sum(axis=0) - c.energy_after.sum(axis=0)
    parts = c.lost_along + c.heat - c.tyre_work.sum(axis=0)
    assert np.all(np.abs(lost - parts) < 1e-5 * c.energy_before.sum(axis=0))
    assert np.all(c.heat >= 0.0)
    assert np.all(c.peak_ratio <= k.friction * (1.0 + 1e-9))


def test_a_mirror_changes_only_signs(scripts, lasting):
    k = lasting.crashes.take(slice(0, 12))
    one, other = (scripts[0].simulated(each, steps=1000, creep=0.05) for each in (k, k.mirrored()))
    seen = after(other, k.mirrored()) * np.array([1.0, -1.0, -1.0])[:, None]
    assert np.all(np.abs(seen - after(one, k)) < 1e-9)
    assert np.all(np.abs(one.duration - other.duration) < 1e-12)


def test_both_cars_can_be_named_the_other_way_round(scripts, lasting):
    k = lasting.crashes.take(slice(0, 12))
    of_cars = [name for name, value in vars(k).items() if value.ndim > 1 and name != "point"]
    swapped = {name: getattr(k, name)[::-1] for name in of_cars}
    other = replace(k, normal=k.normal + np.pi, **swapped)
    found = [after(scripts[0].simulated(each, steps=1000, creep=0.05), each) for each in (k, other)]
    assert np.all(np.abs(found[0] - found[1][::-1]) < 1e-9)


def test_another_integrator_and_another_step_agree(scripts, lasting):
    """scipy's LSODA on 8 crashes, to 0.1 % of delta-V; half the step on 12, to 0.01 %."""
    pytest.importorskip("scipy")
    k = lasting.crashes
    found = after(lasting.contacts, k)
    delta_v = np.hypot(found[:, 0], found[:, 1])
    few = k.take(slice(0, 12))
    halved = after(scripts[0].simulated(few, steps=2 * scripts[0].STEPS), few) - found[..., :12]
    assert np.all(np.hypot(*halved[:, :2].swapaxes(0, 1)) < 1e-4 * delta_v[:, :12])
    for i in range(8):
        duration, state = scripts[0].by_scipy(k, i)
        change = state[:, 3:6] - np.stack([k.vx[:, i], k.vy[:, i], k.yaw_rate[:, i]], axis=-1)
        assert abs(duration - lasting.contacts.duration[i]) < 1e-3 * duration
        assert np.all(np.hypot(*(change - found[..., i])[:, :2].T) < 1e-3 * delta_v[:, i])
        assert np.all(np.abs(change[:, 2] - found[:, 2, i]) < 2e-3)


def test_at_two_milliseconds_without_tyres_the_impulse_is_the_answer(scripts, instant, lasting):
    """Energetic restitution and Coulomb friction, to 0.5 % of delta-V; lasting, 5 % and more."""

    def furthest(drawn):
        k, c = drawn.crashes, drawn.contacts
        a, b = (
            col.Vehicle(
                mass=k.mass[i],
                yaw_inertia=k.inertia[i],
                x=c.x[i],
                y=c.y[i],
                vx=k.vx[i],
                vy=k.vy[i],
                yaw_rate=k.yaw_rate[i],
            )
            for i in (0, 1)
        )
        contact = {
            "normal": c.normal,
            "point": tuple(c.point),
            "friction": k.friction,
            "law": "stronge",
        }
        impact = col.eccentric(a, b, np.maximum(k.restitution, scripts[0].LEAST), **contact)
        off = [
            np.hypot(side.after.vx - c.after[i, 3], side.after.vy - c.after[i, 4]) / side.delta_v
            for i, side in enumerate((impact.a, impact.b))
        ]
        turned = np.stack([impact.a.after.yaw_rate, impact.b.after.yaw_rate]) - c.after[:, 5]
        return np.array(off), np.abs(turned)

    off, turned = furthest(instant)
    assert off.max() < 0.005
    assert turned.max() < 0.05
    assert np.median(furthest(lasting)[0]) > 0.05


@pytest.mark.parametrize(
    ("lock", "angle", "share"),
    [(0.1, 20, 0.434), (0.3, 30, 0.737), (0.5, 45, 0.966), (0.8, 20, 0.957)],
)
def test_a_braked_wheel_rolls_until_its_brake_holds(
    scripts,
    lasting,
    monkeypatch,
    lock,
    angle,
    share,
):
    """Drag along the way: min(lock, cos) along the wheel, across what the circle leaves."""
    one = lasting.crashes.take([0])
    heading = np.radians([[0.0], [0.0]])
    k = replace(
        one,
        heading=heading,
        yaw_rate=np.zeros((2, 1)),
        vx=np.full((2, 1), 20.0 * np.cos(np.radians(angle))),
        vy=np.full((2, 1), 20.0 * np.sin(np.radians(angle))),
        ground=np.array([0.7]),
        lock=np.full((2, 4, 1), lock),
        height=np.full((2, 1), 1e-9),
    )
    monkeypatch.setattr(scripts[0], "RUN_IN", 1.5)  # until nothing changes any more
    world = scripts[0].World(k)
    state = world.start()
    along, across, _ = world.tyres(state, np.zeros_like(state))
    dragging = -(along * k.vx + across * k.vy) / (20.0 * 0.7 * k.mass * scripts[0].GRAVITY)
    assert np.all(np.abs(dragging - share) < 0.001)


def test_locked_wheels_slide_to_rest_as_the_square_of_the_speed(scripts, lasting):
    """Not turning: speed**2 / (2 friction g). A car whose wheels roll is not at rest by then."""
    k = lasting.crashes.take([0, 1])
    k = replace(k, ground=np.array([0.5, 0.8]), lock=np.full((2, 4, 2), 1.5))
    k = replace(k, lock=k.lock * np.array([[[1.0]], [[0.0]]]))
    after = lasting.contacts.after[..., :2].copy()
    after[:, 2], after[:, 3], after[:, 4], after[:, 5] = 0.0, 6.0, 8.0, 0.0
    after[:, 6:12] = 0.0
    contacts = replace(lasting.contacts, after=after)
    found, when = scripts[0].rests(k, contacts, longest=3.0)
    gone = np.hypot(*(found[0, :2] - after[0, :2]))
    expected = 10.0**2 / (2.0 * k.ground * scripts[0].GRAVITY)
    assert np.all(np.abs(gone / expected - 1.0) < 0.03)
    assert np.all(np.isnan(when[1]))


def place_velocity(motion, forward, left):
    """Velocity of a place on a car, from heading, vx, vy and yaw rate."""
    heading, vx, vy, yaw_rate = motion
    c, s = np.cos(heading), np.sin(heading)
    return vx - yaw_rate * (s * forward + c * left), vy + yaw_rate * (c * forward - s * left)


def test_a_recorder_integrates_what_its_place_feels(scripts, lasting):
    """Its readings, turned back step by step, are the change of velocity of its place."""
    k, c = lasting.crashes, lasting.contacts
    forward, left = lasting.recorder[:, 0], lasting.recorder[:, 1]
    along, across = c.turning(forward, left)
    start = place_velocity((k.heading, k.vx, k.vy, k.yaw_rate), forward, left)
    end = place_velocity(c.after[:, 2:6].swapaxes(0, 1), forward, left)
    steps = np.diff(c.time, axis=0)[:, None]
    yaw_rate = k.yaw_rate + c.turned
    turned = np.cumsum(0.5 * (yaw_rate[1:] + yaw_rate[:-1]) * steps, axis=0)
    heading = k.heading + np.concatenate([np.zeros_like(turned[:1]), turned])
    heading = 0.5 * (heading[1:] + heading[:-1])
    felt = np.exp(1j * heading) * (np.diff(along, axis=0) + 1j * np.diff(across, axis=0))
    change = felt.sum(axis=0)
    assert np.all(np.abs(change - (end[0] - start[0] + 1j * (end[1] - start[1]))) < 2e-3)
    assert np.abs(c.turning(forward, left)[0][-1] - c.fixed(k)[0]).max() > 0.5
    moments, curve, _ = c.sampled(0, forward, left)
    assert np.allclose(np.diff(moments)[:-1], 0.01, rtol=0.0, atol=1e-12)
    assert np.all(np.abs(curve[-1] - along[-1, :, 0]) < 1e-12)


@pytest.mark.parametrize(("held", "n"), [(0, 12), (12, 12), (272, 300), (1, 2)])
def test_the_binomial_interval_is_the_exact_one(scripts, held, n):
    stats = pytest.importorskip("scipy.stats")
    exact = stats.binomtest(held, n).proportion_ci(0.998, method="exact")
    assert scripts[2].binomial(held, n) == pytest.approx((exact.low, exact.high), abs=1e-9)


def test_ranges_of_momentum_hold_where_momentum_is_the_truth(scripts, instant):
    """Contacts of 2 ms without tyres: readings and errors are those that are stated."""
    coverage = scripts[2]
    read = list(coverage.readings(instant, SEED, samples=256, axes="fixed"))
    row = coverage.counted([coverage.told(coverage.by_momentum, one) for one in read])
    assert row["refused"] == 0
    assert row["warned"] < 8
    low, high = row["interval"]
    assert 0.75 < low < 0.95 < high


def test_a_fit_answers_ordinary_crashes_and_its_ranges_hold(scripts, instant):
    """Contacts that stuck, slid or nearly either: of one in five at most it refuses or warns, and
    what it refuses it hands to the posterior.
    """
    coverage = scripts[2]
    read = list(coverage.readings(instant, SEED, samples=256, axes="turning"))[:30]
    row = coverage.counted([coverage.told(coverage.by_fit, one) for one in read])
    assert row["refused"] + row["warned"] <= 6
    assert set(row["reasons"]) <= {"no_convergence", "contradictory", "ambiguous"}
    low, high = row["interval"]
    assert 0.75 < low < 0.95 < high
