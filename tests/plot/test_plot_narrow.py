"""Pictures of motion along y, which are narrow: numbers, labels and short arrows can be read."""

import itertools

import matplotlib as mpl
import pytest

mpl.use("agg")

from matplotlib.figure import Figure

import collisions as col
from collisions import plot

UP = {"yaw_inertia": 2600.0, "heading": "90 deg"}


def head_on(speed_b):
    a = col.Vehicle(mass=1600.0, vy="40 mph", vx="-3 mph", x=0.0, y=-2.4, **UP)
    b = col.Vehicle(mass=1300.0, vy=speed_b, x=0.3, y=2.4, **UP)
    return col.eccentric(a, b, 0.1, normal="90 deg", point=(0.1, 0.0), friction=0.5)


def drawn(picture, speed_b):
    figure = Figure(figsize=(5.2, 5.0), layout="constrained")
    axes = picture(head_on(speed_b), axes=figure.add_subplot(), units="us")
    figure.draw_without_rendering()
    return axes


@pytest.mark.slow
@pytest.mark.parametrize("speed_b", ["10 mph", "-45 mph"])
def test_the_numbers_along_a_narrow_axis_stand_apart(speed_b):
    axes = drawn(plot.momentum, speed_b)
    low, high = axes.get_xlim()
    ticks = [
        tick.label1.get_window_extent()
        for tick in axes.xaxis.get_major_ticks()
        if low <= tick.get_loc() <= high
    ]
    assert len(ticks) >= 2
    for left, right in itertools.pairwise(sorted(ticks, key=lambda extent: extent.x0)):
        assert left.x1 + 2.0 < right.x0


@pytest.mark.slow
@pytest.mark.parametrize("picture", [plot.momentum, plot.scene])
@pytest.mark.parametrize("speed_b", ["10 mph", "-45 mph"])
def test_no_label_stands_on_the_axis(picture, speed_b):
    axes = drawn(picture, speed_b)
    edge = axes.bbox.x0
    for text in axes.texts:
        if text.get_text():
            extent = text.get_window_extent()
            assert not extent.x0 < edge < extent.x1, text.get_text()


@pytest.mark.slow
def test_a_short_arrow_has_a_shaft():
    axes = drawn(plot.scene, "-45 mph")
    short = 0
    for text in axes.texts:
        patch = text.arrow_patch
        if patch is None:
            continue
        (x0, y0), (x1, y1) = axes.transData.transform([text.xyann, text.xy])
        length = ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5 * 72.0 / axes.figure.dpi
        head = 0.55 * patch.get_mutation_scale()
        assert head <= max(0.7 * length, 2.3), text.get_gid()
        short += head < 7.0
    assert short
