"""The pull of a slope while a contact with a duration lasts."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import collisions as col
from collisions.impact.impact import way_to_separation
from collisions.scene import Contact, Mover, Scene
from collisions.travel import GRAVITY, Tyres

OUTLINE = (4.4, 1.8)
MASSES = (1500.0, 1100.0)
TYRES = Tyres(0.7, 0.3, 2.6, 1.5)


def in_line(slope: tuple[Any, Any], *, touch: bool = True, **given: Any) -> Scene:
    """One car runs into another that goes ahead of it, without turning."""
    slowed = given.pop("slowed", {"drag": 0.5})
    a, b = (
        col.Vehicle(mass=mass, yaw_inertia=2000.0, x=x, y=0.0, heading=0.0, vx=vx)
        for mass, x, vx in zip(MASSES, (-5.0 if touch else -2.2, 2.2), (12.0, 4.0), strict=True)
    )
    when = {"at": "touch"} if touch else {"point": (0.0, 0.0)}
    if not given.get("model", "").startswith("ecc"):
        given.setdefault("friction", 0.0)
    contact = Contact("A", "B", normal=0.0 if not touch else None, **when, **given)
    movers = {name: Mover(body, outline=OUTLINE, **slowed) for name, body in (("A", a), ("B", b))}
    return Scene(movers=movers, contacts=[contact], slope=slope)


@pytest.mark.slow
@pytest.mark.parametrize("rise", [0.1, -0.2])
def test_a_spring_between_two_on_a_slope(rise: float) -> None:
    """Two blocks on a line that rises, with a spring between them that gives all back, by scipy:
    velocities along the slope at separation, and places in plan.
    """
    run = in_line((rise, 0.0), restitution=1.0, duration=0.12).run()
    impact, time = run.impacts[0], run.times[0]
    lasts = impact.pulse.duration
    (m, n), pull = MASSES, -GRAVITY * math.sin(math.atan(rise))
    k = (math.pi / 0.12) ** 2 * m * n / (m + n)

    def rates(_: float, state: Any) -> Any:
        x, y, u, v = state
        force = k * max(x - y, 0.0)
        return [u, v, pull - force / m, pull + force / n]

    def parts(moment: float, state: Any) -> float:
        return float(state[0] - state[1]) if moment > 0.01 else 1.0

    parts.terminal = True  # type: ignore[attr-defined]
    begin = [0.0, 0.0, impact.a.before.vx, impact.b.before.vx]
    end = solve_ivp(rates, (0.0, 1.0), begin, events=parts, rtol=1e-9, atol=1e-9, max_step=1e-3)
    assert end.status == 1
    assert lasts == pytest.approx(end.t[-1], rel=1e-3)
    before, after = run.at(time), run.at(time + lasts)
    for name, at in (("A", 0), ("B", 1)):
        assert after[name].vx == pytest.approx(end.y[2 + at, -1], abs=2e-3)
        moved = (after[name].x - before[name].x) / math.cos(math.atan(rise))
        assert moved == pytest.approx(end.y[at, -1], abs=2e-3)
    # Beside the contact itself it is what the slope pulls, 0.12 m/s and more.
    assert abs(after["A"].vx - impact.a.after.vx) == pytest.approx(abs(pull) * lasts, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    "given",
    [
        {"duration": 0.1, "slowed": {"tyres": TYRES}},
        {"duration": 0.1, "slowed": {"tyres": TYRES}, "model": "eccentric", "friction": 0.5},
    ],
    ids=["in time", "between"],
)
@pytest.mark.parametrize("touch", [True, False])
def test_the_pull_over_all_of_a_contact(given: dict[str, Any], touch: bool) -> None:
    """At the end of the contact both have what the impact gives, and the pull over all of its
    duration, also over the part before time 0; energy closes as on the level, and a batch agrees.
    """
    slope = (0.1, -0.05)
    scene = in_line(slope, touch=touch, restitution=0.2, **given)
    run = scene.run(tolerance=1e-6)
    impact, time = run.impacts[0], run.times[0]
    lasts = left = 0.1
    if impact.pulse is not None:
        lasts = left = impact.pulse.duration
    if not touch:
        way = way_to_separation(impact)
        left = 0.5 * lasts if way is None else lasts - float(way.engaged)
    pull = -GRAVITY / math.sqrt(1.0 + 0.1**2 + 0.05**2) * np.array(slope)
    for name, side in (("A", impact.a), ("B", impact.b)):
        found = run.at(time + left)[name]
        gained = found.vx - side.after.vx, found.vy - side.after.vy
        assert gained == pytest.approx(tuple(pull * lasts), abs=1e-9)
    energy = run.energy
    closes = energy["before"] - sum(energy["contacts"]) - energy["ground"] - energy["left"]
    assert abs(closes) < 1e-3 * energy["before"]
    both = np.array([1.0, 0.0])
    many = in_line((slope[0] * both, slope[1] * both), touch=touch, restitution=0.2, **given)
    level = in_line((0.0, 0.0), touch=touch, restitution=0.2, **given).run(tolerance=1e-6)
    rests = many.run(tolerance=1e-6).rest["B"]
    assert rests.x == pytest.approx([run.rest["B"].x, level.rest["B"].x], abs=1e-3)
    assert rests.y == pytest.approx([run.rest["B"].y, level.rest["B"].y], abs=1e-3)


@pytest.mark.slow
def test_what_nothing_slows_is_not_pulled() -> None:
    """Nor is what is fixed; a contact without a duration takes no time, in which nothing pulls."""
    level = in_line((0.0, 0.0), touch=False, restitution=0.2, duration=0.1, slowed={}).run()
    steep = in_line((0.1, 0.0), touch=False, restitution=0.2, duration=0.1, slowed={}).run()
    assert steep.at(0.2)["A"].vx == level.at(0.2)["A"].vx
    bare = in_line((0.1, 0.0), touch=False, restitution=0.2).run()
    assert bare.at(0.0)["A"].vx == bare.impacts[0].a.after.vx


@pytest.mark.slow
@pytest.mark.parametrize("rise", [-0.12, 0.06])
def test_what_a_contact_takes_from_what_the_slope_adds(rise: float) -> None:
    """Of two that push each other apart by a spring only the first is pulled. By scipy: the force
    as on the level, which is that of the model, and its power on what the slope adds meanwhile.
    """
    bodies = {
        name: col.Vehicle(mass=mass, yaw_inertia=2000.0, x=x, y=0.0, heading=0.0, vx=vx)
        for name, mass, x, vx in zip("AB", MASSES, (-5.0, 2.2), (12.0, 4.0), strict=True)
    }
    movers = {
        "A": Mover(bodies["A"], outline=OUTLINE, drag=0.5),
        "B": Mover(bodies["B"], outline=OUTLINE),
    }
    rule = Contact("A", "B", restitution=1.0, friction=0.0, at="touch", duration=0.12)
    run = Scene(movers=movers, contacts=[rule], slope=(rise, 0.0)).run()
    (impact,) = run.impacts
    (m, n), pull = MASSES, -GRAVITY * math.sin(math.atan(rise))
    k = (math.pi / 0.12) ** 2 * m * n / (m + n)

    def rates(time: float, state: Any) -> Any:
        x, y, u, v, _ = state
        force = k * max(x - y, 0.0)
        return [u, v, -force / m, force / n, force * pull * time]

    begin = [0.0, 0.0, impact.a.before.vx, impact.b.before.vx, 0.0]
    end = solve_ivp(rates, (0.0, 0.12), begin, rtol=1e-10, atol=1e-10, max_step=1e-3)
    taken = end.y[4, -1]
    assert abs(taken) > 100.0
    assert run.energy["contacts"][0] == pytest.approx(taken, rel=1e-3)


@pytest.mark.slow
def test_the_pull_of_a_contact_that_lasts_is_not_that_of_one_at_the_same_moment() -> None:
    """B strikes C at an instant while A strikes B for a time: the first takes its own alone."""
    speeds = {"A": (-4.0, 15.0), "B": (0.0, 8.0), "C": (4.0, 0.0)}
    movers = {
        name: Mover(
            col.Vehicle(mass=1500.0, yaw_inertia=2000.0, x=x, y=0.0, heading=0.0, vx=vx),
            outline=OUTLINE,
            drag=0.6,
        )
        for name, (x, vx) in speeds.items()
    }
    common: dict[str, Any] = {"restitution": 0.1, "friction": 0.5, "normal": 0.0}
    contacts = [
        Contact("B", "C", point=(2.0, 0.0), at=0.0, **common),
        Contact("A", "B", point=(-2.0, 0.0), at=0.0, duration=0.2, **common),
    ]
    run = Scene(movers=movers, contacts=contacts, slope=(-0.1, 0.0)).run(tolerance=1e-8)
    energy = run.energy
    assert energy["contacts"][0] == pytest.approx(run.impacts[0].energy_loss, rel=1e-12)
    closes = energy["before"] - sum(energy["contacts"]) - energy["ground"] - energy["left"]
    assert abs(closes) < 1e-8 * energy["before"]


SLOWED: dict[str, dict[str, Any]] = {
    "wheels": {"tyres": TYRES}, "drag": {"drag": 0.5}, "nothing": {},
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("touch", [True, False])
@pytest.mark.parametrize("slope", [(-0.12, 0.0), (0.03, 0.06)])
@pytest.mark.parametrize(("one", "other"), [*itertools.combinations_with_replacement(SLOWED, 2)])
def test_the_account_closes_whoever_is_pulled(
    one: str, other: str, slope: tuple[float, float], touch: bool
) -> None:
    """What the ground takes is the sum of its power along the way; the rest is by the states at the
    start and at the end and by the impact. Two cars that turn after a lasting contact.
    """
    states = {
        "A": {"x": -6.0 if touch else -2.0, "y": 0.3, "heading": 0.0, "vx": 12.0, "vy": 0.0},
        "B": {"x": 0.0 if touch else 2.1, "y": 0.0, "heading": 0.3, "vx": -8.0, "vy": 2.0},
    }
    movers = {
        name: Mover(
            col.Vehicle(mass=1500.0, yaw_inertia=2500.0, **state), outline=(4.5, 1.8), **SLOWED[how]
        )
        for (name, state), how in zip(states.items(), (one, other), strict=True)
    }
    when: dict[str, Any] = {"at": "touch"} if touch else {"normal": 0.0, "point": (0.0, 0.1)}
    rule = Contact("A", "B", restitution=0.2, friction=0.5, duration=0.1, **when)
    run = Scene(movers=movers, contacts=[rule], slope=slope).run(tolerance=1e-6)
    energy = run.energy
    closes = energy["before"] - sum(energy["contacts"]) - energy["ground"] - energy["left"]
    assert abs(closes) < 2e-6 * energy["before"]
    ends = run.at(run.end)
    left = sum(ends[name].kinetic_energy for name in "AB")
    assert energy["left"] == pytest.approx(left, abs=1e-6)
