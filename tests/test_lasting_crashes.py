"""The simulated crashes of benchmarks/lasting_crashes.py: balances, symmetry, another integrator, and the limit of an impulse."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import collisions as col

ROOT = Path(__file__).resolve().parent.parent

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (ROOT / "benchmarks").is_dir(), reason="the sdist has no benchmarks"),
]
SEED = 31


@pytest.fixture(scope="module")
def scripts():
    """The simulator and its population."""
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        import lasting_crashes
        import lasting_population
    finally:
        sys.path.remove(str(ROOT / "benchmarks"))
    return lasting_crashes, lasting_population


@pytest.fixture(scope="module")
def lasting(scripts):
    """Three dozen crashes that last, with tyres."""
    return scripts[1].population(36, SEED)


def after(contacts, crashes):
    """Changes of velocity and yaw rate of both cars."""
    before = np.stack([crashes.vx, crashes.vy, crashes.yaw_rate], axis=1)
    return contacts.after[:, 3:6] - before


def test_the_simulator_shares_no_code_with_the_package(scripts):
    for script in scripts:
        assert "collisions" not in Path(script.__file__).read_text(encoding="utf-8")


def test_momentum_energy_and_work_balance(scripts, lasting):
    """Contact: equal and opposite. Moment of momentum about the origin changes by that of the tyres. Energy is accounted for."""
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
    swapped = {name: value[::-1] for name, value in vars(k).items() if value.ndim > 1 and name != "point"}
    other = replace(k, normal=k.normal + np.pi, **swapped)
    found = [after(scripts[0].simulated(each, steps=1000, creep=0.05), each) for each in (k, other)]
    assert np.all(np.abs(found[0] - found[1][::-1]) < 1e-9)


def test_another_integrator_and_another_step_agree(scripts, lasting):
    """scipy's LSODA with events on 20 crashes, and half the step on all, to a thousandth of delta-V."""
    pytest.importorskip("scipy")
    k = lasting.crashes
    found = after(lasting.contacts, k)
    delta_v = np.hypot(found[:, 0], found[:, 1])
    halved = after(scripts[0].simulated(k, steps=2 * scripts[0].STEPS), k)
    assert np.all(np.hypot(*(halved - found)[:, :2].swapaxes(0, 1)) < 1e-3 * delta_v)
    for i in range(20):
        duration, state = scripts[0].by_scipy(k, i)
        change = state[:, 3:6] - np.stack([k.vx[:, i], k.vy[:, i], k.yaw_rate[:, i]], axis=-1)
        assert abs(duration - lasting.contacts.duration[i]) < 1e-3 * duration
        assert np.all(np.hypot(*(change - found[..., i])[:, :2].T) < 1e-3 * delta_v[:, i])
        assert np.all(np.abs(change[:, 2] - found[:, 2, i]) < 2e-3)


def test_at_two_milliseconds_without_tyres_the_impulse_is_the_answer(scripts):
    """The law of energetic restitution with Coulomb friction, to 0.5 % of delta-V; a contact that lasts differs by far more."""
    instant = scripts[1].population(36, SEED, instant=True)

    def furthest(drawn):
        k, c = drawn.crashes, drawn.contacts
        a, b = (
            col.Vehicle(
                mass=k.mass[i], yaw_inertia=k.inertia[i], x=c.x[i], y=c.y[i], vx=k.vx[i], vy=k.vy[i], yaw_rate=k.yaw_rate[i]
            )
            for i in (0, 1)
        )
        contact = {"normal": c.normal, "point": tuple(c.point), "friction": k.friction, "law": "stronge"}
        impact = col.eccentric(a, b, np.maximum(k.restitution, scripts[0].LEAST), **contact)
        off = [
            np.hypot(side.after.vx - c.after[i, 3], side.after.vy - c.after[i, 4]) / side.delta_v
            for i, side in enumerate((impact.a, impact.b))
        ]
        turned = [side.after.yaw_rate - c.after[i, 5] for i, side in enumerate((impact.a, impact.b))]
        return np.array(off), np.abs(turned)

    off, turned = furthest(instant)
    assert off.max() < 0.005
    assert turned.max() < 0.05
    assert np.median(furthest(scripts[1].population(36, SEED))[0]) > 0.05


@pytest.mark.parametrize(("lock", "angle", "share"), [(0.1, 20, 0.434), (0.3, 30, 0.737), (0.5, 45, 0.966), (0.8, 20, 0.957)])
def test_a_braked_wheel_drags_as_the_dynamics_of_its_spin_have_it(scripts, lasting, monkeypatch, lock, angle, share):
    """Share of friction along the way of a car that drifts: min(lock, cos) along the wheel, what the circle leaves across."""
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


def test_a_recorder_integrates_what_its_place_feels(scripts, lasting):
    """At the centre of mass of a car that does not turn: delta-V. Elsewhere: the velocity of the place, differentiated."""
    k, c = lasting.crashes, lasting.contacts
    forward, left = lasting.recorder[:, 0], lasting.recorder[:, 1]
    along, across = c.turning(forward, left)
    # d/dt of the place's velocity in turning axes is what it feels plus the turning of the axes: u' = f + r w, w' = g - r u.
    at_end = []
    for label in (0, 1):
        heading, yaw = c.after[label, 2], c.after[label, 5]
        vx = c.after[label, 3] - yaw * (np.sin(heading) * forward[label] + np.cos(heading) * left[label])
        vy = c.after[label, 4] + yaw * (np.cos(heading) * forward[label] - np.sin(heading) * left[label])
        at_end.append((vx, vy))
    for i in range(12):
        time = c.time[:, i]
        for label in (0, 1):
            yaw = k.yaw_rate[label, i] + c.turned[:, label, i]
            turned = k.heading[label, i] + np.concatenate([[0.0], np.cumsum(0.5 * (yaw[1:] + yaw[:-1]) * np.diff(time))])
            middle = 0.5 * (turned[1:] + turned[:-1])
            f, g = np.diff(along[:, label, i]), np.diff(across[:, label, i])
            dx, dy = np.cos(middle) * f - np.sin(middle) * g, np.sin(middle) * f + np.cos(middle) * g
            start = k.yaw_rate[label, i]
            h = k.heading[label, i]
            vx = k.vx[label, i] - start * (np.sin(h) * forward[label, i] + np.cos(h) * left[label, i])
            vy = k.vy[label, i] + start * (np.cos(h) * forward[label, i] - np.sin(h) * left[label, i])
            assert abs(vx + dx.sum() - at_end[label][0][i]) < 2e-3
            assert abs(vy + dy.sum() - at_end[label][1][i]) < 2e-3
    times, curve, _ = c.sampled(0, forward, left)
    assert np.all(np.diff(times)[:-1] > 0.0099)
    assert np.all(np.abs(curve[-1] - along[-1, :, 0]) < 1e-12)
