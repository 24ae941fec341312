"""Where tyres leave marks: from 90 percent of the friction on, and under the wheel."""

from __future__ import annotations

import numpy as np
import pytest

import collisions as col
from collisions.scene import Mover, Scene
from collisions.travel import Tyres

# Front left, front right, rear left, rear right: braked below and above 90 percent.
LOCKS = {"front_left": 1.0, "front_right": 0.88, "rear_left": 0.92, "rear_right": 0.0}
PLACES = {
    "front_left": (1.35, 0.75),
    "front_right": (1.35, -0.75),
    "rear_left": (-1.35, 0.75),
    "rear_right": (-1.35, -0.75),
}


def track(**given: object) -> object:
    car = col.Vehicle.from_speed(
        mass=1500.0, yaw_inertia=2400.0, x=3.0, y=1.0, speed=10.0, course="30 deg", **given
    )
    tyres = Tyres(0.7, list(LOCKS.values()), 2.7, 1.5)
    return Scene(movers={"A": Mover(car, tyres=tyres)}, contacts=[]).run()["A"].path


def test_a_wheel_marks_from_90_percent_of_the_friction_on() -> None:
    """As the car sets out straight on, each wheel has the force of its brake alone; a wheel that
    marks does so where it stands.
    """
    path = track(heading="30 deg")
    c, s = np.cos(np.pi / 6.0), np.sin(np.pi / 6.0)
    for wheel, lock in LOCKS.items():
        x, y = path.marks[wheel]
        assert np.isfinite(x[0]) == (lock >= 0.9), wheel
        if lock >= 0.9:
            ahead, left = PLACES[wheel]
            assert (x[0], y[0]) == pytest.approx(
                (3.0 + c * ahead - s * left, 1.0 + s * ahead + c * left), rel=1e-12
            )


def test_a_car_that_slides_sideways_marks_with_all_wheels_until_it_rests() -> None:
    """Rolling or locked, no wheel follows its own direction; one at rest leaves no mark."""
    path = track(heading="120 deg")
    for wheel in LOCKS:
        x, _ = path.marks[wheel]
        assert np.isfinite(x[0]), wheel
        assert np.isnan(x[-1]), wheel


def test_a_car_that_turns_on_the_spot_marks_circles_and_leaves_its_spin_to_the_ground() -> None:
    """Wheels at hypot(1.35, 0.75) m from a centre that stays where it is."""
    car = col.Vehicle(
        mass=1500.0, yaw_inertia=2400.0, x=3.0, y=1.0, vx=0.0, vy=0.0, yaw_rate=4.0, heading=0.0
    )
    run = Scene(movers={"A": Mover(car, tyres=Tyres(0.7, 1.0, 2.7, 1.5))}, contacts=[]).run()
    for x, y in run["A"].path.marks.values():
        marked = np.isfinite(x)
        assert marked[0]
        assert np.hypot(x[marked] - 3.0, y[marked] - 1.0) == pytest.approx(
            np.hypot(1.35, 0.75), rel=1e-6
        )
    energy = run.energy
    assert energy["before"] == pytest.approx(0.5 * 2400.0 * 16.0, rel=1e-12)
    assert energy["ground"] == pytest.approx(energy["before"], rel=1e-3)
