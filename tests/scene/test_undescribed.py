"""Touches that no contact describes: a batch and every study count the cases of which a single run
has the finding.
"""

from __future__ import annotations

import re
import warnings
from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.reconstruct import compare, fit, posterior
from collisions.scene import Contact, Mover, Run, Scene
from collisions.scene.run import _OF_FINDING
from collisions.travel import GRAVITY
from collisions.uncertainty import Normal, Uniform, propagate

CODE = "touch_without_contact"
UNKNOWNS = {"A.vx": Uniform(8.0, 16.0)}
# Of the three cars in line: restitution, drag, and the way of the middle one to the third [m].
RESTITUTION, DRAG, WAY = 0.4, 0.5, 2.0
SPEEDS = np.linspace(4.0, 14.0, 41)


def in_line(speed: Any = 14.0, *, at: str | float = "touch") -> Scene:
    """A strikes B, which slides on to C if it is fast enough; nothing says what happens then."""

    def car(x: float, vx: Any) -> Mover:
        body = col.Vehicle(mass=1200.0, yaw_inertia=1900.0, x=x, y=0.0, heading=0.0, vx=vx)
        return Mover(body, outline=(4.0, 1.8), drag=DRAG)

    rule = Contact("A", "B", restitution=RESTITUTION, normal=0.0, model="linear_central", at=at)
    movers = {"A": car(-4.0, speed), "B": car(0.0, 0.0), "C": car(4.0 + WAY, 0.0)}
    return Scene(movers=movers, contacts=[rule])


def reaches() -> Any:
    """Whether B slides as far as C, in closed form."""
    after = 0.5 * (1.0 + RESTITUTION) * SPEEDS
    return after**2 / (2.0 * GRAVITY * DRAG) > WAY


def warned(call: Callable[[], Any], code: str = CODE) -> tuple[Any, list[str]]:
    """What a call gives, and its warnings of a code."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = call()
    return found, [str(one.message) for one in caught if one.message.code == code]  # type: ignore[union-attr]


def codes(run: Run) -> list[str]:
    return [one.code for one in run.findings]


@pytest.mark.slow
@pytest.mark.parametrize("at", ["touch", 0.0])
def test_a_batch_counts_the_cases_of_single_runs(at: str | float) -> None:
    expected = reaches()
    assert 0 < expected.sum() < len(SPEEDS)
    _, (said,) = warned(in_line(SPEEDS, at=at).run)
    assert said.startswith(f"in {expected.sum()} of {len(SPEEDS)} cases of the scene two vehicles")
    single = [CODE in codes(in_line(speed, at=at).run()) for speed in SPEEDS.tolist()]
    assert single == expected.tolist()


@pytest.mark.slow
def test_a_pair_with_a_contact_at_a_time_may_touch_again() -> None:
    """C drives the lighter B back into A, with which it had its contact at 0."""

    def crash(speed: Any) -> Scene:
        movers = {
            name: Mover(
                col.Vehicle(mass=mass, yaw_inertia=2e3, x=x, y=0.0, heading=0.0, vx=vx),
                outline=(4.0, 1.8),
            )
            for name, mass, x, vx in (
                ("A", 1e4, 0.0, 0.0), ("B", 1e3, -4.0, 6.0), ("C", 1e4, -12.0, speed)
            )
        }  # fmt: skip
        central = {"normal": 0.0, "model": "linear_central", "restitution": 0.5}
        hits = [Contact("B", "A", **central), Contact("C", "B", at="touch", **central)]
        return Scene(movers=movers, contacts=hits)

    speeds = np.array([-1.0, 3.0, 9.0])
    single = [CODE in codes(crash(speed).run()) for speed in speeds.tolist()]
    assert single == [False, True, True]
    _, (said,) = warned(crash(speeds).run)
    assert said.startswith("in 2 of 3 cases of the scene two vehicles touch")


@pytest.mark.slow
def test_every_study_says_it() -> None:
    """Propagation, posterior, fit, levels and a comparison of accounts; as a statement too."""
    scene, rest = in_line(), in_line(14.0).run().rest["B"].x
    read = {"B.rest.x": Normal(rest, 0.3)}
    for call in (
        lambda: propagate(scene, UNKNOWNS, outputs=["B.rest.x"], samples=64, seed=1),
        lambda: posterior(scene, UNKNOWNS, read, samples=512, seed=1),
        lambda: fit(scene, {"A.vx": 12.0}, read),
    ):
        found, said = warned(call)
        assert len(said) == 1
        assert any("no contact says what happens" in one for one in found.statements)
    found, said = warned(lambda: scene.required({"B.rest.x": 1.0}, UNKNOWNS))
    assert len(said) == 1
    accounts, _ = warned(
        lambda: {
            name: posterior(scene, {"A.vx": one}, read, samples=512, seed=1)
            for name, one in (("fast", Uniform(10.0, 20.0)), ("any", Uniform(5.0, 30.0)))
        }
    )
    assert all(
        any("no contact says" in one for one in account.statements) for account in accounts.values()
    )
    compared, _ = warned(lambda: compare(accounts))
    assert "no contact says what happens" in " ".join(str(compared).split())


@pytest.mark.slow
def test_what_comes_after_all_that_is_asked_for_is_not_followed() -> None:
    """Of the impact alone, nothing that comes later is asked; of one case and of many."""
    for speed in (14.0, SPEEDS):
        for path, count in (("impacts[0].b.delta_v", 0), ("B.rest.x", 1), ("end", 1)):
            model = in_line().as_model(["A.vx"], [path])
            _, said = warned(lambda model=model, speed=speed: model(**{"A.vx": speed}))
            assert len(said) == count, path


@pytest.mark.slow
def test_a_touch_before_a_later_impact_counts_whatever_is_asked_for() -> None:
    """B goes through C to D, with which it has a contact."""
    scene = in_line()
    movers = {**scene.movers, "D": scene.movers["C"].replace(
        vehicle=scene.movers["C"].vehicle.replace(x=10.5)
    )}  # fmt: skip
    hit = Contact("B", "D", restitution=0.1, normal=0.0, model="linear_central", at="touch")
    crash = Scene(movers=movers, contacts=[*scene.contacts, hit])
    model = crash.as_model(["A.vx"], ["impacts[1].b.delta_v"])
    for speed in (14.0, np.array([14.0, 13.0])):
        _, said = warned(lambda speed=speed: model(**{"A.vx": speed}))
        assert len(said) == 1


@pytest.mark.slow
def test_touches_that_are_passed_over_are_counted_too() -> None:
    """A creeps up to B and stops within the delay of their contact; C drives it on later."""

    def crash(creeps: Any) -> Scene:
        movers = {
            name: Mover(
                col.Vehicle(mass=1e3, yaw_inertia=2e3, x=x, y=0.0, heading=0.0, vx=vx),
                outline=(4.0, 1.8),
                drag=0.7,
            )
            for name, x, vx in (("A", -4.0005, creeps), ("B", 0.0, 0.0), ("C", -10.0, 12.0))
        }
        hits = [Contact(*two, restitution=0.1, friction=0.5, at="touch") for two in ("AB", "CA")]
        return Scene(movers=movers, contacts=hits)

    creeps = np.array([0.1, 0.0, 0.11])
    single = ["touch_passed_over" in codes(crash(one).run()) for one in creeps.tolist()]
    assert single == [True, False, True]
    _, (said,) = warned(crash(creeps).run, "touch_passed_over")
    assert said.startswith("in 2 of 3 cases of the scene two vehicles touch and do not close")
    for speed in (0.1, creeps):
        model = crash(0.1).as_model(["A.vx"], ["B.rest.x"])
        _, said_of = warned(
            lambda speed=speed, model=model: model(**{"A.vx": speed}), "touch_passed_over"
        )
        assert len(said_of) == 1


@pytest.mark.slow
def test_impulses_at_the_deepest_are_counted_too() -> None:
    """A clips a corner of B, by which some do not come as deep as was asked for."""

    def crash(across: Any) -> Scene:
        a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-6.0, y=1.55, heading=0.0, vx=14.0)
        b = col.Vehicle(mass=1200.0, yaw_inertia=1900.0, x=0.0, y=0.0, heading="90 deg", vy=across)
        movers = {
            "A": Mover(a, outline=(4.4, 1.8), drag=0.7),
            "B": Mover(b, outline=(4.2, 1.7), drag=0.7),
        }
        hit = Contact("A", "B", restitution=0.1, friction=0.4, at="touch", depth=0.3)
        return Scene(movers=movers, contacts=[hit])

    across = np.linspace(-7.6, -6.6, 12)
    batch, _ = warned(crash(across).run)
    answered = batch.status == "ok"
    single = [
        ok and "at_deepest" in codes(crash(one).run())
        for one, ok in zip(across.tolist(), answered.tolist(), strict=True)
    ]
    assert 0 < sum(single) < answered.sum()
    _, (said,) = warned(crash(across).run, "at_deepest")
    assert said.startswith(f"in {sum(single)} of 12 cases of the scene two vehicles part before")
    model = crash(-7.0).as_model(["B.vy"], ["impacts[0].b.delta_v"])
    _, said_of = warned(lambda: model(**{"B.vy": float(across[single.index(True)])}), "at_deepest")
    assert len(said_of) == 1
    unknown = {"B.vy": Uniform(-7.6, -6.6)}
    found, said_of = warned(
        lambda: propagate(crash(-7.0), unknown, outputs=["times[0]"], samples=64, seed=1),
        "at_deepest",
    )
    assert len(said_of) == 1
    assert any("the impulse acts at their deepest" in one for one in found.statements)


# What varies between the cases of a scene of three cars.
VARIED = (
    "A.vx", "A.y", "A.heading", "B.heading", "B.vy", "C.y", "C.heading", "C.vx", "C.drag",
)  # fmt: skip


def three(rng: np.random.Generator, count: int, kind: int) -> tuple[Scene, dict[str, Any]]:
    """A scene of three cars, of which two or three may meet, and what varies in it."""
    low = np.array([1.0, -2.2, -0.4, 0.0, -5.0, -2.0, -2.0, -1.0, 0.3])
    high = np.array([16.0, 2.2, 0.4, 3.0, 5.0, 2.0, 2.0, 1.0, 0.8])
    drawn = dict(zip(VARIED, rng.uniform(low, high, (count, len(low))).T, strict=True))
    bodies = {
        "A": col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-6.0, y=0.0, vx=9.0, heading=0.0),
        "B": col.Vehicle(mass=1200.0, yaw_inertia=1900.0, x=0.0, y=0.0, vy=1.0, heading=1.0),
        "C": col.Vehicle(mass=1800.0, yaw_inertia=2900.0, x=5.5, y=0.0, vx=1.0, heading=0.0),
    }
    movers = {name: Mover(body, outline=(4.4, 1.8), drag=0.5) for name, body in bodies.items()}
    place = ({"depth": 1.0}, {"delay": 0.2}, {"duration": 0.1})[kind % 3]
    pairs = ("AB", "BC") if kind < 3 else ("AB",)
    hits = [Contact(*two, restitution=0.1, friction=0.4, at="touch", **place) for two in pairs]
    return Scene(movers=movers, contacts=hits), drawn


def counted(said: list[Any]) -> dict[str, int]:
    """The cases that warnings of findings count, by code."""
    found = {}
    for one in said:
        if many := re.match(r"in (\d+) of \d+ cases of the scene ", str(one.message)):
            found[one.message.code] = int(many[1])
    return found


@pytest.mark.slow
def test_each_finding_of_single_runs_is_counted_in_batches_and_studies() -> None:
    """Of 240 cases one by one: every code comes that vehicles without tyres may have, and each is
    counted.
    """
    rng, total = np.random.default_rng(10), Counter[str]()
    alike = {"driven_together": "driven_through"}
    for kind in range(6):
        scene, drawn = three(rng, 40, kind)
        with warnings.catch_warnings(record=True) as of_batch:
            warnings.simplefilter("always")
            batch = scene.replace(drawn).run()
        model = scene.as_model(VARIED, ["A.rest.x"])
        with warnings.catch_warnings(record=True) as of_study:
            warnings.simplefilter("always")
            model(**drawn)
        single = Counter[str]()
        for i in np.flatnonzero(batch.status == "ok").tolist():
            one = {name: float(values[i]) for name, values in drawn.items()}
            found = codes(scene.replace(one).run())
            single.update({alike.get(code, code) for code in found})
            total.update(set(found))
            with warnings.catch_warnings(record=True) as of_one:
                warnings.simplefilter("always")
                model(**one)
            assert {each.message.code for each in of_one} == {alike.get(c, c) for c in found}
        assert counted(of_batch) == counted(of_study) == dict(single)
    assert set(total) == set(_OF_FINDING) - {"mixed_friction", "durations_overlap"}
