"""What is written in the pictures of a contact over time: each number is that of the answer, and
each label goes with its line.
"""

import numpy as np
import pytest

import collisions as col
from collisions import plot

plt = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture(autouse=True)
def closed():
    """No figure stays open."""
    yield
    plt.close("all")


def by_gid(axes):
    return {one.get_gid(): one for one in axes.get_children() if one.get_gid() is not None}


def plain(text):
    """Without the thin spaces between thousands."""
    return text.replace("\u2009", "")


def legend_of(axes):
    return [plain(text.get_text()) for text in axes.get_legend().get_texts()]


@pytest.fixture(scope="module")
def central():
    """1000 kg at 10 m/s into 1000 kg at rest, e = 0.25: impulses of 5000 and 1250 N*s."""
    return col.linear_central(col.Vehicle(mass=1000.0, vx=10.0), col.Vehicle(mass=1000.0), 0.25)


@pytest.fixture(scope="module")
def followed():
    """A heavy and a light car in line, so that their delta-V differ by their masses."""
    a = col.Vehicle(mass=2000.0, yaw_inertia=3500.0, vx=10.0, x=-2.2, y=0.0, heading=0.0)
    b = col.Vehicle(mass=1000.0, yaw_inertia=1800.0, x=2.2, y=0.0, heading=0.0)
    return col.time_resolved(a, b, 0.3, normal=0.0, point=(0.0, 0.0), friction=0.0, duration=0.1)


@pytest.mark.slow
def test_the_legend_of_the_force_has_the_impulses_and_forces_of_the_answer(central):
    """Compression takes 0.08 s of 0.1 s; a quarter of a sine of 5000 N*s over it has a peak of pi/2
    of its mean.
    """
    axes = plot.force_time(central, 0.1, units="si")
    assert legend_of(axes) == [
        "A1 = 5000 N·s, compression",
        "A2 = 1250 N·s, restitution",
        "mean force 62500 N",
        f"end of compression, peak {round(np.pi / 2 * 5000.0 / 0.08, -1):.0f} N",
    ]


@pytest.mark.slow
def test_the_legend_of_a_pulse_has_the_delta_v_of_each_vehicle(followed):
    """A's is half of B's, as A has twice the mass: 10 * 1.3 / 3 m/s and twice that."""
    axes = plot.pulse(followed, units="metric")
    force, crush, delta_v = axes.child_axes
    assert legend_of(delta_v) == ["A: 15.6 km/h", "B: 31.2 km/h"]
    lines = {line.get_gid(): line for line in delta_v.get_lines()}
    assert lines["a.delta_v"].get_ydata()[-1] == pytest.approx(3.6 * 13.0 / 3.0, rel=1e-3)
    assert lines["b.delta_v"].get_ydata()[-1] == pytest.approx(3.6 * 26.0 / 3.0, rel=1e-3)
    handles = axes.child_axes[2].get_legend().legend_handles
    assert [one.get_color() for one in handles] == [
        lines[f"{label}.delta_v"].get_color() for label in "ab"
    ]
    assert by_gid(force)["force"].get_ydata().max() == pytest.approx(
        followed.pulse.peak_force / 1000.0, rel=1e-3
    )
    assert by_gid(crush)["crush"].get_ydata().max() == pytest.approx(
        followed.pulse.max_crush, rel=1e-3
    )


@pytest.mark.slow
def test_the_title_of_a_pulse_has_its_duration_its_peak_and_its_crush(followed):
    pulse = followed.pulse
    first, _ = plain(plot.pulse(followed, units="si").get_title()).split("\n")
    words = first.replace(",", "").split()
    assert words[1:5] == ["s", "of", "contact:", "peak"]
    assert words[6:8] == ["N", "crush"]
    written = [float(words[place]) for place in (0, 5, 8)]
    exact = [pulse.duration, pulse.peak_force, pulse.max_crush]
    assert written == pytest.approx(exact, rel=5e-3)


@pytest.mark.slow
def test_maximum_engagement_is_where_the_crush_is_greatest(followed):
    """In every panel, also where the force has been at its greatest for a while."""
    axes = plot.pulse(followed, units="si")
    pulse = followed.pulse
    at = pulse.time[np.argmax(pulse.crush)]
    assert 0.0 < at < pulse.duration
    for panel in axes.child_axes:
        assert by_gid(panel)["maximum engagement"].get_xdata() == pytest.approx([at, at])
