"""Vehicles within their outlines: the outline stays what is calculated with, the front is ahead,
the wheels are where the tyres have them, and nothing reaches beyond.
"""

from __future__ import annotations

import math

import matplotlib.pyplot as plt
import numpy as np
import pytest

import collisions as col
from collisions import plot
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres

TURN = math.radians(37.0)


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def drawn(outline, units="metric"):
    """What is drawn of a vehicle of this outline, by the part, in metres about its centre of mass,
    forward and left.
    """
    a = col.Vehicle(mass=1500, yaw_inertia=2500, vx=10.0, x=-3.0, y=1.0, heading=TURN)
    b = col.Vehicle(mass=1200, yaw_inertia=1900, x=3.0, y=0.0)
    impact = col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5)
    axes = plot.scene(impact, outline_a=outline, units=units)
    unit = 0.3048 if units == "us" else 1.0
    found = {}
    for artist in (*axes.patches, *axes.lines):
        gid = artist.get_gid() or ""
        if gid.startswith("a.") and gid not in ("a.centre", "a.before", "a.after"):
            places = (
                artist.get_xy()[:-1] if artist in axes.patches else artist.get_xydata()
            ) * unit
            turned = (places[:, 0] + 3.0 + 1j * (places[:, 1] - 1.0)) * np.exp(-1j * TURN)
            found.setdefault(gid[2:], []).append(np.column_stack([turned.real, turned.imag]))
    return found


@pytest.mark.parametrize("units", ["metric", "us"])
@pytest.mark.parametrize(
    ("outline", "wheels", "bodies"),
    [((4.4, 1.8, 0.1), 4, 1), ((9.0, 2.5), 4, 2), ((2.1, 0.8), 2, 1)],
    ids=["car", "truck", "motorcycle"],
)
def test_a_vehicle_fills_its_outline_and_no_more(outline, wheels, bodies, units):
    """The outline is that given, to the corner; wheels, glass and body lie in it, and the front is
    its front edge.
    """
    found = drawn(outline, units)
    length, width, ahead = (*outline, 0.0)[:3]
    low, high = np.array([-0.5 * length - ahead, -0.5 * width]), [0.5 * length - ahead, 0.5 * width]
    (corners,) = found["outline"]
    np.testing.assert_allclose(corners.min(axis=0), low, atol=1e-9)
    np.testing.assert_allclose(corners.max(axis=0), high, atol=1e-9)
    assert len(found["wheel"]) == wheels
    assert len(found["body"]) == bodies
    for part in ("wheel", "body", "glass"):
        for places in found[part]:
            assert np.all(places >= low - 1e-9), part
            assert np.all(places <= np.array(high) + 1e-9), part
    (front,) = found["front"]
    np.testing.assert_allclose(front[:, 0], high[0], atol=1e-9)
    # Left and right are alike, and front and rear are not.
    for places in found["body"]:
        mirrored = places * [1.0, -1.0]
        assert all(np.min(np.hypot(*(places - one).T)) < 1e-9 for one in mirrored)


@pytest.mark.parametrize(
    "outline",
    [
        (1.0, 1.0),
        (12.0, 0.5),
        ((2.2, 0.0), (1.5, 0.9), (-2.2, 0.9), (-2.2, -0.9), (1.5, -0.9)),
        ((2.2, 0.8), (-2.2, 1.0), (-2.2, -1.0), (2.2, -0.8)),
        ((2.2, 0.9), (-2.0, 0.9), (-2.4, -0.9), (1.8, -0.9)),
        ((2.2, 0.9), (-2.2, 0.9), (-2.2, -0.9)),
    ],
    ids=["small", "wall", "five corners", "tapered", "slanted", "three corners"],
)
def test_any_other_outline_stays_plain(outline):
    """With its front as the heavy edge."""
    assert drawn(outline).keys() == {"outline", "front"}


@pytest.mark.slow
def test_wheels_of_a_run_stand_where_its_tyres_are():
    """So that the marks begin under them."""
    car = {"mass": 1500, "yaw_inertia": 2500}
    movers = {
        "one": Mover(
            col.Vehicle(**car, x=0.0, y=0.0, heading=0.0, vx=10.0),
            outline=(4.5, 1.8),
            tyres=Tyres(0.7, 1.0, 2.65, 1.5),
        ),
        "other": Mover(col.Vehicle(**car, x=2.2, y=1.8, heading=0.0, vx=9.0), outline=(4.5, 1.8)),
    }
    contact = Contact("one", "other", restitution=0.0, friction=0.0, normal=0.0, point=(1.0, 0.9))
    run = Scene(movers=movers, contacts=[contact]).run()
    axes = plot.scene(run, units="metric")
    middles = {
        gid: sorted(
            tuple(np.round(patch.get_xy()[:-1].mean(axis=0), 9))
            for patch in axes.patches
            if patch.get_gid() == gid
        )
        for gid in ("one.start wheel", "other.start wheel")
    }
    assert middles["one.start wheel"] == [
        (-1.325, -0.75), (-1.325, 0.75), (1.325, -0.75), (1.325, 0.75),
    ]  # fmt: skip
    assert len(middles["other.start wheel"]) == 4
