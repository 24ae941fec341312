"""The pictures of a whole scene show its numbers: places, marks, speeds and times are read back
from what was drawn.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("agg")

import matplotlib.pyplot as plt

import collisions as col
from collisions import plot
from collisions.scene import Contact, Mover, Scene
from crashes import NAMES, coasting, furthest_from, over_ice, three_cars

FOOT, MPH = 0.3048, 0.44704


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def by_gid(axes: Any, gid: str) -> list[Any]:
    """What was drawn under a gid."""
    return [artist for artist in axes.get_children() if artist.get_gid() == gid]


def corners(vehicle: col.Vehicle, length: float, width: float) -> set[tuple[float, float]]:
    """Corners of a rectangle about a vehicle, by complex numbers."""
    turn = complex(math.cos(vehicle.heading), math.sin(vehicle.heading))
    centre = complex(vehicle.x, vehicle.y)
    found = [
        centre + turn * complex(one * length, two * width) / 2.0
        for one, two in ((1, 1), (1, -1), (-1, -1), (-1, 1))
    ]
    return {(round(place.real, 9), round(place.imag, 9)) for place in found}


def drawn(patch: Any, unit: float) -> set[tuple[float, float]]:
    return {(round(x * unit, 9) + 0.0, round(y * unit, 9) + 0.0) for x, y in patch.get_xy()}


@pytest.mark.slow
@pytest.mark.parametrize(("units", "unit"), [("us", FOOT), ("metric", 1.0)])
def test_outlines_stand_where_the_vehicles_are(units: Any, unit: float) -> None:
    run = three_cars()
    axes = plot.scene(run, units=units)
    sizes = dict(zip(NAMES, [(4.8, 1.8), (4.5, 1.7), (6.2, 2.3)], strict=True))
    for name, size in sizes.items():
        (start,), (rest,) = (by_gid(axes, f"{name}.{what}") for what in ("start", "rest"))
        for patch, state in ((start, run.at(0.0)[name]), (rest, run.rest[name])):
            wanted = corners(state, *size)
            found = drawn(patch, unit)
            for place in wanted:
                assert min(math.dist(place, other) for other in found) < 1e-6
        at_contacts = by_gid(axes, f"{name}.contact")
        later = [
            time for time, pair in zip(run.times, run.pairs, strict=True)
            if name in pair and time > 0.0
        ]  # fmt: skip
        assert len(at_contacts) == len(later)
        for patch, time in zip(at_contacts, later, strict=True):
            wanted = corners(run.at(time)[name], *size)
            assert all(
                min(math.dist(place, other) for other in drawn(patch, unit)) < 1e-6
                for place in wanted
            )


@pytest.mark.slow
def test_tracks_marks_surfaces_and_contacts_are_those_of_the_run() -> None:
    run = three_cars()
    axes = plot.scene(run, units="us")
    for name in NAMES:
        (line,) = by_gid(axes, f"{name}.track")
        np.testing.assert_allclose(line.get_xdata() * FOOT, run.paths[name].x, rtol=1e-12)
        np.testing.assert_allclose(line.get_ydata() * FOOT, run.paths[name].y, rtol=1e-12)
        marks = [np.array(xy) for xy in run.paths[name].marks.values() if np.isfinite(xy).any()]
        for places, mark in zip(marks, by_gid(axes, f"{name}.mark"), strict=True):
            x, y = np.array(mark.get_data()) * FOOT
            assert furthest_from(x, y, places[:, np.isfinite(places[0])]) < 5e-3
            assert furthest_from(*places, np.array([x, y])[:, np.isfinite(x)]) < 0.4  # a step
    (area,) = by_gid(axes, "surface.0")
    assert drawn(area, FOOT) == {(2.0, 4.0), (8.0, 4.0), (8.0, 9.0), (2.0, 9.0)}
    for number, impact in enumerate(run.impacts):
        (mark,) = by_gid(axes, f"contact.{number}")
        assert impact.point is not None
        assert mark.get_xdata()[0] * FOOT == pytest.approx(impact.point[0], abs=1e-12)
    texts = " ".join(text.get_text() for text in axes.texts)
    assert "2: Civic and Truck\nat 0.70 s" in texts
    assert "40.0 mph" in texts
    assert "standing" in texts
    assert "friction 0.3" in texts


@pytest.mark.slow
def test_a_mark_is_drawn_from_its_begin_to_its_end() -> None:
    """Also one that lies between two moments of the run's clock."""
    run = over_ice()
    marks = by_gid(plot.scene(run), "A.mark")
    assert len(marks) == 4
    for mark in marks:
        x, _ = mark.get_data()
        assert (x[0], x[-1]) == pytest.approx((30.05, 30.45), abs=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize(("units", "name"), [("us", "ft"), ("si", "m")])
def test_the_scale_bar_is_as_long_as_it_says(units: Any, name: str) -> None:
    axes = plot.scene(three_cars(), units=units)
    (bar,) = by_gid(axes, "scale")
    (text,) = [one.get_text() for one in axes.texts if one.get_text().endswith(f" {name}")]
    assert np.ptp(bar.get_xdata()) == pytest.approx(float(text.split()[0]))
    assert axes.get_aspect() == 1.0


def test_the_timeline_has_the_speeds_on_either_side_of_each_contact() -> None:
    run = three_cars()
    axes = plot.timeline(run, units="us")
    for number, (time, pair) in enumerate(zip(run.times, run.pairs, strict=True)):
        (line,) = by_gid(axes, f"contact.{number}")
        assert list(line.get_xdata()) == [time, time]
        sides = run.impacts[number].a, run.impacts[number].b
        for name, side in zip(pair, sides, strict=True):
            (speeds,) = by_gid(axes, f"{name}.speed")
            at = np.flatnonzero(speeds.get_xdata() == time)
            before, after = speeds.get_ydata()[at] * MPH
            assert before == pytest.approx(side.before.speed, abs=1e-9)
            assert after == pytest.approx(side.after.speed, abs=1e-9)
    assert axes.get_xlim()[1] > run.end
    assert axes.get_ylim()[1] * MPH > max(run.scene.movers["Camry"].vehicle.speed, 0.0)


@pytest.mark.slow
def test_names_of_contacts_stand_apart_in_the_timeline() -> None:
    """Five cars in a row that meet within a fraction of the time, in a wide and a narrow figure."""
    row = {"normal": 0, "model": "linear_central", "at": "touch", "restitution": 0.3}
    names = ["Camry", "Civic", "Truck", "Accord", "Golf"]
    movers = {
        name: Mover(
            col.Vehicle(mass=1500, vx=20.0 * (i == 0), x=5.0 * i, y=0, heading=0),
            outline=(4.5, 1.8),
            drag=0.5,
        )
        for i, name in enumerate(names)
    }
    pairs = itertools.pairwise(names)
    run = Scene(movers=movers, contacts=[Contact(*pair, **row) for pair in pairs]).run()
    assert len(run.impacts) > 5
    for wide in (8.6, 5.2):
        figure, axes = plt.subplots(figsize=(wide, 4.6))
        plot.timeline(run, axes=axes)
        figure.canvas.draw()
        boxes = [
            by_gid(axes, f"contact.{number}.name")[0].get_window_extent()
            for number in range(len(run.impacts))
        ]
        for number, box in enumerate(boxes):
            assert not any(box.overlaps(other) for other in boxes[:number])
            assert box.x1 < figure.bbox.x1


@pytest.mark.slow
def test_vehicles_without_outline_that_nothing_slows_are_drawn_too() -> None:
    axes = plot.scene(coasting())
    assert len(by_gid(axes, "<A & co>.track")) == 1
    assert not by_gid(axes, "<A & co>.rest")
    assert any("moves on" in text.get_text() for text in axes.texts)
    axes.figure.canvas.draw()
    assert plot.timeline(coasting()).get_xlim()[1] > 0.0


def test_one_vehicle_that_stands_has_room_about_it() -> None:
    parked = col.Vehicle(mass=1000, x=5, y=3, heading=0)
    axes = plot.scene(Scene(movers={"A": Mover(parked)}, contacts=[]).run())
    assert axes.get_xlim()[0] < 4.0 < 6.0 < axes.get_xlim()[1]
    assert plot.timeline(Scene(movers={"A": Mover(parked)}, contacts=[]).run()).get_ylim()[1] > 0.0


def test_what_does_not_go_with_a_run_is_refused() -> None:
    run = three_cars()
    with pytest.raises(col.InputError, match=r"outline_a is for an Impact.*Mover\(vehicle"):
        plot.scene(run, outline_a=(4.5, 1.8))
    with pytest.raises(col.InputError, match=r"plot.scene\(run.impacts\[0\], moment='after'\)"):
        plot.scene(run, moment="after")
    with pytest.raises(col.InputError, match="run must be a Run, got 3"):
        plot.timeline(3)
    with pytest.raises(col.InputError, match="units"):
        plot.timeline(run, units="imperial")
    body = col.Vehicle(mass=1000, vx=[10.0, 11.0])
    contact = Contact("A", "B", restitution=0.1, normal=0, model="linear_central")
    other = col.Vehicle(mass=1000)
    many = Scene(movers={"A": Mover(body), "B": Mover(other)}, contacts=[contact])
    with pytest.raises(col.ShapeError, match=r"plot.timeline\(run.case\(0\)\)"):
        plot.timeline(many.run())
    with pytest.raises(col.MissingInputError, match=r"plot.scene needs x, y, heading of A"):
        plot.scene(many.case(0).run())
    plot.timeline(many.case(0).run())
