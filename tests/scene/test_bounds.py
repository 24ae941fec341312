"""The bounds within which the first touch of two outlines is looked for."""

from __future__ import annotations

import numpy as np
import pytest

import collisions as col
from collisions.scene import Mover, Scene
from collisions.travel import Tyres

BARE = {"mass": 1500.0, "x": 3.0, "y": 1.0, "heading": 0.0}


@pytest.mark.parametrize(
    ("moving", "slowed", "slope"),
    [
        # Uphill the slope slows beside the tyres.
        ({"vx": 15.0, "vy": 0.0, "yaw_inertia": 2400.0}, {"lock": 1.0}, (0.1, 0.0)),
        # On the spot every tyre turns against the spin; a small inertia feels it more.
        (
            {"vx": 0.0, "vy": 0.0, "yaw_rate": 6.0, "yaw_inertia": 1200.0},
            {"lock": 1.0},
            (0.0, 0.0),
        ),
        (
            {"vx": 9.0, "vy": 5.0, "yaw_rate": 3.0, "yaw_inertia": 2400.0},
            {"drag": 0.6},
            (0.1, 0.05),
        ),
    ],
)
def test_no_motion_changes_faster_than_its_bounds(
    moving: dict[str, float], slowed: dict[str, float], slope: tuple[float, float]
) -> None:
    """A first touch is found within them: the change of the motion that came out stays below, and
    comes within a third of them.
    """
    given = slowed if "drag" in slowed else {"tyres": Tyres(0.7, slowed["lock"], 2.7, 1.5)}
    scene = Scene(
        movers={"A": Mover(col.Vehicle(**BARE, **moving), **given)}, contacts=[], slope=slope
    )
    run = scene.run()
    path = run["A"].path
    push, spin = (float(np.max(one)) for one in run._followed.courses["A"].bounds(np.array([0])))
    step = np.diff(path.time)
    pushes = np.hypot(np.diff(path.vx), np.diff(path.vy)) / step
    spins = np.abs(np.diff(path.yaw_rate)) / step
    assert np.max(pushes) <= push * (1.0 + 1e-6)
    assert np.max(spins) <= spin * (1.0 + 1e-6)
    assert max(np.max(pushes) / push, np.max(spins) / spin) > 0.66


def test_bounds_hold_on_the_area_with_the_most_friction() -> None:
    """From ice onto dry ground: what the tyres do there is within the bounds of the whole way."""
    car = col.Vehicle(**BARE, vx=15.0, vy=0.0, yaw_inertia=2400.0)
    dry = ([(8.0, -10.0), (60.0, -10.0), (60.0, 10.0), (8.0, 10.0)], 0.9)
    tyres = Tyres(0.1, 1.0, 2.7, 1.5)
    scene = Scene(movers={"A": Mover(car, tyres=tyres)}, contacts=[], surfaces=[dry])
    run = scene.run()
    path = run["A"].path
    push, _ = run._followed.courses["A"].bounds(np.array([0]))
    slowing = np.max(np.abs(np.diff(path.vx)) / np.diff(path.time))
    assert slowing == pytest.approx(0.9 * col.travel.GRAVITY, rel=1e-2)
    assert slowing <= float(push[0]) * (1.0 + 1e-6)
