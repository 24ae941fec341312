"""What the pictures of evidence say of themselves is what they draw: bands, ranges and shares."""

import numpy as np
import pytest

from collisions import plot, reconstruct
from collisions.uncertainty import Normal

plt = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture(autouse=True)
def closed():
    """No figure stays open."""
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def read_once():
    """A speed of 20 +/- 2 m/s, read as 23 +/- 1: 22.4 with a variance of 0.8."""
    return reconstruct.posterior(
        lambda v, w: {"v": v},
        {"v": Normal(20.0, 2.0), "w": Normal(0.0, 1.0)},
        {"v": (23.0, 1.0)},
        samples=8192,
        seed=1,
    )


@pytest.mark.slow
def test_the_dark_band_is_one_stated_error_and_the_light_one_two(read_once):
    axes = plot.residuals(read_once)
    bands = sorted(
        (box.x0, box.x1, -patch.get_alpha())
        for patch in axes.patches
        for box in [patch.get_extents().transformed(axes.transData.inverted())]
    )
    assert [band[:2] for band in bands] == [
        pytest.approx((-2.0, 2.0), abs=1e-9),
        pytest.approx((-1.0, 1.0), abs=1e-9),
    ]
    light, dark = (-band[2] for band in bands)
    assert light < dark
    assert axes.get_title() == (
        "point and line: mean and 95 % of what is computed\n"
        "dark band: one stated error; light band: two"
    )


@pytest.mark.slow
def test_the_line_of_a_reading_holds_95_percent_of_what_is_computed(read_once):
    """From 0.6 the mean, 1.96 * sqrt(0.8) to either side, in stated errors of 1."""
    axes = plot.residuals(read_once)
    by_gid = {line.get_gid(): line for line in axes.get_lines()}
    half = 1.959964 * np.sqrt(0.8)
    assert by_gid["residuals"].get_xdata() == pytest.approx([0.6], abs=0.05)
    assert sorted(by_gid["range of v"].get_xdata()) == pytest.approx(
        [0.6 - half, 0.6 + half], abs=0.1
    )


@pytest.mark.slow
def test_the_outer_contour_of_a_pair_holds_95_percent_and_the_inner_one_half(read_once):
    """Of 8,192 samples on 28 cells to a side, a share is known to a few percent of the whole."""
    pair = next(axes for axes in plot.corner(read_once).axes if axes.get_gid() == "v and w")
    (lines,) = [one for one in pair.collections if one.get_gid() == "shares"]
    points = np.stack([read_once["v"].values, read_once["w"].values], axis=1)
    shares = [np.mean(path.contains_points(points)) for path in lines.get_paths()]
    assert sorted(shares) == pytest.approx([0.5, 0.95], abs=0.03)
