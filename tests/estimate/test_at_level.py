"""``tolerance=`` of ``posterior``: the level of a scene that its accuracy needs, in its place."""

from __future__ import annotations

import math
from typing import Any

import pytest

import collisions as col
from collisions.reconstruct import posterior
from collisions.scene import Contact, Mover, Scene
from collisions.travel import GRAVITY, Tyres
from collisions.uncertainty import Interval, Normal, Uniform

SPEED = {"A.vx": Uniform("8 m/s", "22 m/s")}


def skid(lock: Any = 1, turned: float = 0.0) -> Scene:
    """One car that slides to rest."""
    car = col.Vehicle(mass=1500, yaw_inertia=2500, vx=15, x=0, y=0, heading=turned)
    return Scene(movers={"A": Mover(car, tyres=Tyres(0.7, lock, 2.7, 1.5))}, contacts=[])


def crash() -> Scene:
    a = col.Vehicle(mass=1500, yaw_inertia=2600, vx=15, x=-2.2, y=0.3, heading=0)
    b = col.Vehicle(mass=1200, yaw_inertia=2000, x=2.2, y=0, heading=0)
    wheels = Tyres(0.7, [1, 1, 0.1, 0.1], 2.7, 1.5)
    hit = Contact("A", "B", restitution=0.1, friction=0.5, normal=0, point=(0, 0))
    return Scene(movers={"A": Mover(a, tyres=wheels), "B": Mover(b, tyres=wheels)}, contacts=[hit])


STRUCK = "contacts[0].impact.B.delta_v"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tolerance", "asked"),
    [
        (2.0, "1 m/s"),
        ({STRUCK: "1 m/s"}, "1 m/s"),
        pytest.param(1e-6, "5e-7 m/s", marks=pytest.mark.slow),
    ],
)
def test_the_answer_is_that_of_the_level_that_required_takes(tolerance: Any, asked: str) -> None:
    scene, seen = crash(), {STRUCK: ("9 m/s", "0.5 m/s")}
    found = posterior(scene, SPEED, seen, tolerance=tolerance, samples=512, seed=1)
    required = scene.required({STRUCK: asked}, SPEED)
    alone = posterior(required.level, SPEED, seen, samples=512, seed=1)
    assert found.draws["A.vx"].tolist() == alone.draws["A.vx"].tolist()
    text = " ".join(found.statements)
    assert f"level of the scene: {required.level.name}" in text
    assert "a drag does not act" not in text
    assert ("the finest level" in text) == (required.level is required.finest)
    assert (asked == "5e-7 m/s") == (required.level is required.finest)


@pytest.mark.slow
def test_a_straight_skid_needs_no_wheels() -> None:
    """Locked wheels slow it by mu g, so that v^2 = 2 mu g d."""
    seen = {"A.rest.x": ("16 m", "0.2 m")}
    found = posterior(skid(), SPEED, seen, tolerance={"A.rest.x": "0.5 m"}, samples=512, seed=1)
    assert "motion by drag" in " ".join(found.statements)
    wanted = math.sqrt(2.0 * 0.7 * GRAVITY * 16.0)
    assert found["A.vx"].mean == pytest.approx(wanted, rel=0.02)
    assert "finer" not in found.calls


@pytest.mark.slow
def test_wheels_are_followed_coarsely_first() -> None:
    """The answer is that of the scene itself, within the errors of both samples."""
    scene = skid([1, 1, 0, 0], turned=0.4)
    place = scene.run().rest["A"]
    seen = {"A.rest.x": Normal(place.x, 0.3), "A.rest.y": Normal(place.y, 0.3)}
    found = posterior(scene, SPEED, seen, tolerance=0.1, samples=512, seed=1)
    plain = posterior(scene, SPEED, seen, samples=512, seed=2)
    assert found.calls["finer"] < 0.2 * found.calls["model"]
    errors = [one["A.vx"].mean_standard_error for one in (found, plain)]
    assert abs(found["A.vx"].mean - plain["A.vx"].mean) < 4.0 * math.hypot(*errors)
    assert abs(found["A.vx"].mean - 15.0) < 4.0 * found["A.vx"].std


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"model": lambda **values: {"A.rest.x": values["A.vx"]}}, "is for a scene.Scene"),
        ({"finer": skid()}, "give finer= or tolerance="),
        ({"tolerance": {"A.rest.y": "1 m"}}, "tolerance says nothing of A.rest.x"),
        ({"tolerance": {"A.rest.x": "1 s"}}, r"tolerance\['A.rest.x'\]"),
        ({"tolerance": {"A.rest.x": "1 m", "A.rest.z": "1 m"}}, "tolerance has no 'A.rest.z'"),
        ({"tolerance": 0.0}, "tolerance must be > 0"),
        ({"tolerance": "much"}, "tolerance"),
        ({"tolerance": [0.1, 0.2]}, "tolerance"),
        ({"tolerance": {}}, "tolerance says nothing of A.rest.x"),
        ({"observed": {"A.rest.x": col.uncertainty.Censored("5 m")}}, "one sharp bound; give a"),
    ],
)
def test_a_tolerance_that_cannot_be_is_refused(change: dict[str, Any], says: str) -> None:
    given: dict[str, Any] = {
        "model": skid(),
        "unknowns": SPEED,
        "observed": {"A.rest.x": ("16 m", "0.5 m")},
        "tolerance": 0.5,
    }
    with pytest.raises(col.InputError, match=says) as caught:
        posterior(**(given | change), samples=512)
    assert str(caught.value.argument).startswith("tolerance")


@pytest.mark.slow
def test_a_share_of_bounds_is_that_of_their_width() -> None:
    seen = {"A.rest.x": Interval("14 m", "18 m")}
    found = posterior(skid(), SPEED, seen, tolerance=0.25, samples=512, seed=1)
    assert "of the 1 m asked for" in " ".join(found.statements)
