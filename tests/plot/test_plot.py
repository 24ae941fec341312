"""Pictures show the numbers of the result: ends of arrows, areas, bars and lines are read back from
what was drawn.
"""

import ast
import functools
import itertools
import math
import os
import random
import re
import subprocess
import sys
import warnings
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("agg")

import matplotlib.pyplot as plt
from matplotlib.figure import Figure
from matplotlib.text import Text

import collisions as col
from collisions import plot, reconstruct, travel, uncertainty
from collisions.plot import drawing
from collisions.plot.canvas import Units, in_lines, number
from scenes import cases, solved
from strategies import Nasty, other_registry

ROOT = Path(__file__).resolve().parent.parent.parent
SYSTEMS = ("si", "metric", "us")
# What one SI unit is in the units of the labels, by pint's definitions and not by the package.
UREG = other_registry()
SHOWN = {
    "si": {
        "speed": "m/s",
        "length": "m",
        "impulse": "N*s",
        "energy": "J",
        "force": "N",
        "time": "s",
    },
    "metric": {
        "speed": "km/h",
        "length": "m",
        "impulse": "kN*s",
        "energy": "kJ",
        "force": "kN",
        "time": "ms",
    },
    "us": {
        "speed": "mph",
        "length": "ft",
        "impulse": "lbf*s",
        "energy": "ft*lbf",
        "force": "lbf",
        "time": "ms",
    },
}
# Ends of arrows are sums and products of a few roundings; the reading takes differences of numbers
# of the same size.
ROUNDING = 1e-12

A = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx="60 km/h", x=-2.2, y=0.0, heading=0.0)
B = col.Vehicle(mass=1200.0, yaw_inertia=2000.0, vy="30 km/h", x=0.9, y=-0.8, heading="90 deg")
T_BONE = {"normal": 0.0, "point": (0.0, 0.0)}
IMPACTS = {
    "example 2": col.linear_central(
        col.Vehicle(mass="1100 kg", vx="80 km/h"), col.Vehicle(mass="950 kg"), 0.398
    ),
    "wall in line": col.linear_central(
        col.Vehicle(mass=1100.0, vx=20.0), col.Vehicle.barrier(), 0.2
    ),
    "oblique": col.oblique_central(
        col.Vehicle(mass=1500.0, vx=15.0, vy=3.0, x=-2.0, y=-0.3, name="van $1"),
        col.Vehicle(mass=1200.0, vy=12.0, x=2.0, y=0.8),
        0.2,
        normal=0.3,
        friction=0.3,
    ),
    "sticking": col.eccentric(A, B, 0.1, friction=0.5, **T_BONE),
    "sliding": col.eccentric(A, B, 0.1, friction=0.02, **T_BONE),
    "no slip": col.eccentric(A, B, 0.1, friction=math.inf, **T_BONE),
    "returning slip": col.eccentric(A, B, 0.3, friction=1.5, law="kudlich-slibar", **T_BONE),
    "ratio": col.eccentric(A, B, 0.0, impulse_ratio=-0.1, **T_BONE),
    "elastic": col.eccentric(A, B, 1.0, friction=0.0, **T_BONE),
    "head-on": col.eccentric(
        A.replace(y=0.3),
        col.Vehicle(mass=1800.0, yaw_inertia=3300.0, vx=-20.0, x=2.3, y=-0.5, heading="180 deg"),
        0.1,
        friction=0.5,
        **T_BONE,
    ),
    "example 3": col.eccentric(
        col.Vehicle(mass=900.0, yaw_inertia=math.inf, vx="60 km/h", x=-2.0, y=4.0),
        col.Vehicle(mass=1000.0, yaw_inertia=4000.0 / 3.0, x=0.0, y=2.0, pivot=(0.0, 0.0)),
        0.8,
        normal=0.0,
        point=(0.0, 4.0),
        friction=0.0,
    ),
    "rebound": col.eccentric(
        A, col.Vehicle.barrier(), 0.1, normal=0.1, point=(0.1, 0.3), friction=0.4
    ),
    "pinned and turning": col.eccentric(
        col.Vehicle(mass=900.0, yaw_inertia=900.0, vx="60 km/h", x=-2.0, y=4.3, heading=0.0),
        col.Vehicle(
            mass=1000.0,
            yaw_inertia=1333.0,
            x=0.3,
            y=2.0,
            yaw_rate=1.0,
            pivot=(0.0, 0.0),
            heading=1.0,
        ),
        0.2,
        normal=0.1,
        point=(0.0, 4.0),
        friction=0.3,
    ),
    "parallel arms": col.eccentric(
        col.Vehicle(mass=1000.0, yaw_inertia=1333.0, x=0.0, y=1.0, yaw_rate=-2.0, pivot=(0.0, 0.0)),
        col.Vehicle(mass=1200.0, yaw_inertia=2000.0, x=0.0, y=3.0, pivot=(0.0, 4.0)),
        0.2,
        normal=0.0,
        point=(0.0, 2.0),
        impulse_ratio=0.1,
    ),
    "wall aslant": col.eccentric(
        A.replace(vy=-3.0, yaw_rate=0.4),
        col.Vehicle.barrier(),
        0.15,
        normal="20 deg",
        point=(0.0, -0.5),
        friction=0.4,
    ),
}
# Every system of units for some of them.
UNITS = dict(zip(IMPACTS, itertools.cycle(SYSTEMS), strict=False))
DRAWN = {
    "scene": plot.scene,
    "momentum": plot.momentum,
    "impulse_plane": plot.impulse_plane,
    "force_time": lambda impact, **options: plot.force_time(impact, 0.1, **options),
    "energy": plot.energy,
}


def squared(speed, mass):
    """Energy and momentum of what is uncertain."""
    return {
        "energy": 0.5 * mass * UREG.Quantity(speed, "m/s") ** 2 * UREG.kg,
        "momentum": mass * speed,
    }


INPUTS = {"speed": uncertainty.Normal(20.0, 0.5), "mass": uncertainty.Normal(1200.0, 60.0)}
RESULT = uncertainty.propagate(squared, INPUTS, method="quasi_random", samples=2048, seed=1)


@pytest.fixture(autouse=True)
def _closed():
    # Other tests in the same process may have left figures open.
    plt.close("all")
    yield
    plt.close("all")


@functools.cache
def drawn(picture, case):
    """Each picture once, in the units of the case."""
    return DRAWN[picture](
        IMPACTS[case], units=UNITS[case], axes=Figure(layout="constrained").subplots()
    )


def factor(system, kind):
    """What an SI number is multiplied by."""
    return float(UREG.Quantity(1.0, SHOWN["si"][kind]).m_as(SHOWN[system][kind]))


def arrows(axes):
    """Tail and tip of every arrow by its name."""
    return {
        text.get_gid(): (np.array(text.xyann), np.array(text.xy))
        for text in axes.texts
        if text.get_gid() is not None and text.arrow_patch is not None
    }


def vectors(axes):
    return {name: tip - tail for name, (tail, tip) in arrows(axes).items()}


def named(axes, gid):
    """The artist of this name."""
    (found,) = [artist for artist in axes.get_children() if artist.get_gid() == gid]
    return found


def names(axes):
    return {artist.get_gid() for artist in axes.get_children() if artist.get_gid() is not None}


def area(polygon):
    """By the shoelace formula, from the corners drawn."""
    x, y = (polygon.get_xy() - polygon.get_xy().min(axis=0)).T
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def scale(axes, what):
    """How much one unit of length stands for, as it is printed."""
    found = re.search(rf"1 \w+ = ([\d.\u2009e+-]+) \S+ for {what}", axes.get_xlabel())
    return float(found.group(1).replace("\u2009", ""))


def is_sketch(axes):
    return "not all positions given: a sketch" in axes.get_xlabel()


# What they have in common


@pytest.mark.slow
@pytest.mark.parametrize("case", IMPACTS)
@pytest.mark.parametrize("picture", DRAWN)
def test_every_picture_of_every_impact_has_its_units_on_its_axes(picture, case):
    axes, system = drawn(picture, case), UNITS[case]
    kinds = {
        "scene": "length",
        "momentum": "impulse",
        "impulse_plane": "impulse",
        "force_time": "time",
        "energy": "energy",
    }
    unit = SHOWN[system][kinds[picture]].replace("*", "·")
    if (picture, system) == ("momentum", "si"):
        unit = "kg·m/s"
    if is_sketch(axes):
        assert axes.get_xlabel().startswith("x\n")
        assert axes.get_ylabel() == "y"
        return
    assert f"[{unit}]" in axes.get_xlabel()
    if picture == "force_time":
        assert axes.get_ylabel() == f"normal force [{SHOWN[system]['force']}]"
    elif picture != "energy":
        assert f"[{unit}]" in axes.get_ylabel()


@pytest.mark.slow
@pytest.mark.parametrize("picture", DRAWN)
@pytest.mark.parametrize("case", IMPACTS)
def test_every_letter_of_a_picture_can_be_read(picture, case):
    """Ticks and powers of ten too: math text would stand there as its source where formulas are
    off, as in a report.
    """
    axes = drawn(picture, case)
    axes.figure.draw_without_rendering()
    labels = "\n".join(text.get_text() for text in axes.findobj(Text)).replace("van $1", "van")
    assert labels.strip()
    assert not set(labels) & set("$\\{}")


@pytest.mark.slow
def test_a_power_of_ten_stands_at_the_end_of_its_axis():
    heavy = col.Vehicle(mass=40_000.0, vx=20.0)
    for mass, power in ((40_000.0, "×10⁶"), (1500.0, ""), (1e-8, "×10⁻⁶")):
        axes = plot.energy(col.linear_central(heavy.replace(mass=mass), heavy.replace(vx=0.0), 0.1))
        axes.figure.draw_without_rendering()
        assert axes.xaxis.get_offset_text().get_text() == power


@pytest.mark.parametrize("picture", DRAWN)
def test_axes_given_are_drawn_on_and_returned(picture):
    _, (one, other) = plt.subplots(1, 2)
    assert DRAWN[picture](IMPACTS["sticking"], axes=other) is other
    assert other.has_data()
    assert not one.has_data()
    assert len(plt.get_fignums()) == 1


def test_axes_given_are_drawn_on_by_pictures_of_an_uncertainty():
    for draw in (plot.contributions, plot.distribution):
        _, axes = plt.subplots()
        assert draw(RESULT["energy"], axes=axes) is axes
        assert axes.has_data()


@pytest.mark.parametrize("picture", DRAWN)
def test_a_batch_is_refused_with_advice(picture):
    batch = col.linear_central(
        col.Vehicle(mass=1000.0, vx=np.array([10.0, 20.0])), col.Vehicle(mass=900.0), 0.1
    )
    with pytest.raises(
        col.ShapeError, match=rf"batch of shape \(2,\), and plot.{picture} takes one case"
    ) as caught:
        DRAWN[picture](batch)
    assert caught.value.code == "bad_shape"
    assert "plot.distribution" in str(caught.value)
    assert not plt.get_fignums()


@pytest.mark.parametrize("picture", DRAWN)
def test_a_refused_impact_is_refused_with_its_reason(picture):
    refused = col.linear_central(
        col.Vehicle(mass=1000.0, vx=-10.0), col.Vehicle(mass=900.0), 0.1, on_failure="nan"
    )
    with pytest.raises(col.InputError, match="move apart along the normal") as caught:
        DRAWN[picture](refused)
    assert caught.value.code == "refused_impact"
    assert caught.value.fields["status"] == "separating"
    assert not plt.get_fignums()


@pytest.mark.parametrize("picture", DRAWN)
def test_what_is_no_impact_is_refused(picture):
    with pytest.raises(col.InputError, match=rf"plot.{picture}\(") as caught:
        DRAWN[picture](A)
    assert caught.value.code == "not_an_impact"


@pytest.mark.parametrize("picture", [*DRAWN, "contributions", "distribution"])
@pytest.mark.parametrize("given", ["SI", "imperial", 3, ["si"]])
def test_units_that_are_not_known_are_refused(picture, given):
    draw = DRAWN.get(picture) or getattr(plot, picture)
    with pytest.raises(col.InputError, match="units must be 'si', 'metric' or 'us'") as caught:
        draw(IMPACTS["sticking"], units=given)
    assert (caught.value.code, caught.value.fields["argument"]) == ("bad_option", "units")


@pytest.mark.parametrize(
    "make",
    [
        lambda: plt.subplots(),
        lambda: plt.subplots(1, 2)[1],
        lambda: plt.subplot(projection="polar"),
    ],
)
def test_what_is_not_one_axes_is_refused(make):
    with pytest.raises(col.InputError, match=r"axes must be one Axes.*subplots\(\)") as caught:
        plot.energy(IMPACTS["sticking"], axes=make())
    assert (caught.value.code, caught.value.fields["argument"]) == ("bad_option", "axes")


@pytest.mark.parametrize("picture", DRAWN)
def test_without_matplotlib_the_error_says_what_to_install(picture, monkeypatch):
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(
        col.MissingInputError, match=re.escape("python -m pip install matplotlib")
    ) as caught:
        DRAWN[picture](IMPACTS["sticking"])
    assert caught.value.code == "missing_matplotlib"
    assert isinstance(caught.value.__cause__, ImportError)


@pytest.mark.slow
def test_matplotlib_is_imported_when_something_is_drawn_and_not_before():
    code = (
        "import sys, collisions.plot; assert 'matplotlib' not in sys.modules; assert 'pint' not "
        "in sys.modules"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)


@pytest.mark.slow
def test_only_where_it_is_needed_matplotlib_is_named():
    """No import of it outside functions and TYPE_CHECKING, in any module but one that is itself
    imported when drawing.
    """
    for path in (ROOT / "src/collisions/plot").glob("*.py"):
        if path.stem == "ticks":
            continue
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.Import | ast.ImportFrom):
                modules = [alias.name for alias in node.names] + [getattr(node, "module", "") or ""]
                assert not any("matplotlib" in name for name in modules), path


@pytest.mark.parametrize("system", SYSTEMS)
def test_units_of_labels_are_those_of_pint(system):
    labels = Units(system)
    for kind, unit in SHOWN["si"].items():
        asked = "duration" if kind == "time" else unit  # a contact is in ms, any other time in s
        assert labels.factor(asked) == pytest.approx(factor(system, kind), rel=ROUNDING)
        assert labels.name(asked) == SHOWN[system][kind].replace("*", "·")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (5.473, "5.473"),
        (16.66666, "16.67"),
        (-12.0, "\u221212.00"),
        (414691.0, "414\u2009700"),
        (999.99, "1000"),
        (9999.4, "9999"),
        (0.01234567, "0.01235"),
        (9999.96, "10\u2009000"),
        (0.99996, "1.000"),
        (3e-9, "3.000e\u221209"),
        (math.inf, "infinite"),
    ],
)
def test_numbers_have_four_digits_and_no_exponent_if_it_can_be_helped(value, text):
    assert number(value) == text


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [
        (128.529, 0, "129"),
        (-128.529, 0, "\u2212129"),
        (128.5, 0, "128"),
        (12.3456, 1, "12.3"),
        (99.949, 1, "99.9"),
        (0.3, 0, "0.3000"),
    ],
)
def test_a_number_is_rounded_once(value, decimals, text):
    """From what it is, and not from its first four digits; half goes to even."""
    assert number(value, decimals) == text


@pytest.mark.parametrize(
    ("system", "value", "unit", "text"),
    [
        ("metric", 60.04 / 3.6, "m/s", "60.0 km/h"),
        ("metric", 0.001 / 3.6, "m/s", "0.001000 km/h"),
        ("metric", math.radians(157.4), "rad", "157°"),
        ("us", 2.5, "s", "2.500 s"),
        ("us", 2800.0, "kg*m**2", "66\u2009450 lb·ft²"),
        ("metric", 4500.0, "kg*m**2/s", "4.500 kN·m·s"),
        ("us", 1.0, "kg*m", "1.000 kg·m"),
        ("us", math.radians(157.4), "rad/s", "157°/s"),
        ("us", 1.0, "kg", "2.205 lb"),
        ("si", 13356.0, "N*s", "13\u2009360 N·s"),
    ],
)
def test_numbers_are_shown_with_units_as_well_as_they_can_be_known(system, value, unit, text):
    """0.1 km/h and 1 degree, but never 0 for what is not; a unit of no known kind stays."""
    assert Units(system).text(value, unit) == text


# Scene


@pytest.mark.slow
@pytest.mark.parametrize("case", IMPACTS)
def test_velocities_and_impulses_of_the_scene_are_those_of_the_result(case):
    """Read back with the scale that is printed below the picture; in a sketch by the arrows of A,
    one scale for all.
    """
    impact, system = IMPACTS[case], UNITS[case]
    axes = drawn("scene", case)
    found = vectors(axes)
    if is_sketch(axes):
        per_speed = impact.a.before.speed / np.hypot(*found["a.before"])
        per_impulse = impact.normal_impulse / np.hypot(*found["impulse.a"])
    else:
        per_speed = scale(axes, "velocities") / factor(system, "speed")
        per_impulse = scale(axes, "impulses") / factor(system, "impulse")
    # Positions are a few metres, and taken from the ends of an arrow.
    near = 1e-11
    for letter in "ab":
        side = getattr(impact, letter)
        for when in ("before", "after"):
            state = getattr(side, when)
            if state.speed == 0.0:
                assert f"{letter}.{when}" not in found
            else:
                assert found[f"{letter}.{when}"] * per_speed == pytest.approx(
                    (state.vx, state.vy), abs=near * state.speed * 1e3
                )
        size = math.hypot(impact.normal_impulse, impact.tangential_impulse)
        shown = found[f"impulse.{letter}"] * per_impulse
        assert shown == pytest.approx((side.impulse_x, side.impulse_y), abs=near * size * 1e3)
    n = found["normal"] / np.hypot(*found["normal"])
    t = found["tangent"] / np.hypot(*found["tangent"])
    assert n == pytest.approx(impact.normal, abs=1e-9)
    assert t == pytest.approx((-impact.normal[1], impact.normal[0]), abs=1e-9)
    assert axes.get_aspect() == 1.0


def test_the_scene_is_to_scale():
    """Velocities before end at the centre of mass, those after start there, impulses at the
    contact; all in feet.
    """
    axes = plot.scene(IMPACTS["sticking"], units="us")
    feet = factor("us", "length")
    ends = arrows(axes)
    for letter, place in (("a", (-2.2, 0.0)), ("b", (0.9, -0.8))):
        place = np.array(place) * feet
        assert ends[f"{letter}.before"][1] == pytest.approx(place, abs=1e-12)
        assert ends[f"{letter}.after"][0] == pytest.approx(place, abs=1e-12)
        assert np.ravel(named(axes, f"{letter}.centre").get_xydata()) == pytest.approx(place)
        assert ends[f"impulse.{letter}"][0] == pytest.approx((0.0, 0.0), abs=1e-12)
    assert np.ravel(named(axes, "contact").get_xydata()) == pytest.approx((0.0, 0.0))


def test_a_central_impulse_acts_at_the_centres_and_has_no_contact_point():
    axes = plot.scene(IMPACTS["oblique"])
    ends = arrows(axes)
    assert ends["impulse.a"][0] == pytest.approx((-2.0, -0.3))
    assert ends["impulse.b"][0] == pytest.approx((2.0, 0.8))
    assert "contact" not in names(axes)


def in_line(solver):
    """Cars that follow or meet each other, by speeds of A and B, with all of it along one line."""
    for va, vb in ((20.0, 5.0), (20.0, -15.0), (8.0, -20.0), (20.0, 0.0)):
        a, b = (
            col.Vehicle(mass=mass, yaw_inertia=2500.0, vx=vx, x=x, y=0.0)
            for mass, vx, x in ((1500.0, va, -2.2), (2300.0, vb, 2.2))
        )
        yield solver(
            a,
            b,
            0.3,
            normal=0.0,
            **({"point": (0.0, 0.0), "friction": 0.0} if solver is col.eccentric else {}),
        )


@pytest.mark.slow
@pytest.mark.parametrize("solver", [col.linear_central, col.eccentric])
def test_arrows_of_an_in_line_scene_do_not_hide_each_other(solver):
    """No two lie on one line where both are, by five points at least: wider than their heads; and
    the picture says so.
    """
    said = 0
    for impact in in_line(solver):
        axes = plot.scene(impact)
        axes.figure.draw_without_rendering()
        ends = [
            axes.transData.transform(pair) * 72.0 / axes.figure.dpi
            for pair in arrows(axes).values()
        ]
        for one, other in itertools.combinations(ends, 2):
            if max(np.ptp(one[:, 1]), np.ptp(other[:, 1])) > 1e-6:
                continue  # the tangent
            overlap = min(one[:, 0].max(), other[:, 0].max()) - max(
                one[:, 0].min(), other[:, 0].min()
            )
            assert overlap < 8.0 or abs(one[0, 1] - other[0, 1]) > 5.0
        moved = any(
            abs(tail[1]) > 1e-9 for name, (tail, _) in arrows(axes).items() if name != "tangent"
        )
        assert ("drawn side by side" in axes.get_xlabel()) == moved
        said += moved
        assert vectors(axes)["impulse.a"] == pytest.approx(-vectors(axes)["impulse.b"])
        plt.close("all")
    assert said >= 2


@pytest.mark.slow
def test_arrows_that_are_apart_stay_where_they_are():
    """Nothing is said of it, and both impulses start at the contact."""
    assert "side by side" not in drawn("scene", "sticking").get_xlabel()


def labels_beside(axis):
    """The numbers beside an axis, as they are read, and the boxes they fill."""
    texts = [text for text in axis.get_ticklabels() if text.get_text()]
    return [text.get_text() for text in texts], [text.get_window_extent() for text in texts]


def small(a, b):
    """Their impact at the origin."""
    return col.eccentric(a, b, 0.3, friction=0.3, **T_BONE)


def test_the_scene_of_small_bodies_is_small():
    """Millimetres fill the picture; and without any distance between them there still is one."""
    a = col.Vehicle(mass=1e-3, yaw_inertia=1e-9, vx=0.5, x=-0.002, y=0.0)
    b = col.Vehicle(mass=2e-3, yaw_inertia=3e-9, x=0.002, y=0.001)
    axes = plot.scene(small(a, b))
    assert 0.004 < np.ptp(axes.get_xlim()) < 0.02
    one = plot.scene(small(a.replace(x=0.0), b.replace(x=0.0, y=0.0)))
    assert 2.0 < np.ptp(one.get_xlim()) < 20.0


@pytest.mark.slow
@pytest.mark.parametrize("mass", [1e-3, 1e9])
@pytest.mark.parametrize("picture", DRAWN)
def test_numbers_beside_the_axes_are_told_apart_at_any_size(picture, mass):
    """No two alike, none longer than seven signs, and none hides another."""
    a = col.Vehicle(mass=mass, yaw_inertia=2.0 * mass, vx=15.0, x=-2.0, y=0.0)
    axes = DRAWN[picture](
        small(a, a.replace(vx=0.0, vy=3.0, x=2.0)),
        axes=Figure((5.5, 4.6), layout="constrained").subplots(),
    )
    axes.figure.draw_without_rendering()
    for axis, end in ((axes.xaxis, "x"), (axes.yaxis, "y")):
        labels, boxes = labels_beside(axis)
        assert len(set(labels)) == len(labels)
        if picture == "energy" and end == "y":
            continue
        assert max(map(len, labels)) <= 7, labels
        assert all(
            getattr(one, f"{end}1") <= getattr(other, f"{end}0")
            for one, other in itertools.pairwise(boxes)
        ), labels


@pytest.mark.slow
def test_coordinates_of_a_national_grid_are_in_full():
    """Seven digits before the point."""
    a, b = (
        col.Vehicle(mass=1500.0, vx=15.0, x=4_200_000.0, y=510_000.0),
        col.Vehicle(mass=1500.0, x=4_200_004.0, y=510_000.0),
    )
    axes = plot.scene(col.oblique_central(a, b, 0.1, normal=0.0, friction=0.2))
    axes.figure.draw_without_rendering()
    labels, boxes = labels_beside(axes.xaxis)
    assert "4200000" in labels
    assert all(one.x1 < other.x0 for one, other in itertools.pairwise(boxes))


@pytest.mark.slow
@pytest.mark.parametrize("far", [1e13, 1e17, 1e90])
def test_a_scene_whose_digits_end_before_those_of_the_vehicles_is_not_drawn(far):
    """It had no end at 1e60 m, where nothing moves two arrows apart; the report says so in its
    place.
    """
    a = A.replace(x=far - 2.0, heading=0.0)
    impact = col.eccentric(
        a, a.replace(x=far + 2.0, vx=0.0), 0.1, normal=0.0, point=(far, 0.0), friction=0.5
    )
    with pytest.raises(
        col.InputError, match=r"no picture of .* count x and y from a place near the contact"
    ) as caught:
        plot.scene(impact)
    assert caught.value.code == "out_of_range"
    assert "Not drawn: there is no picture of" in col.report(impact)


def test_an_outline_that_no_picture_holds_is_refused():
    """1e200 m: the squares of its places overflow."""
    with (
        pytest.warns(col.SuspectUnitsWarning),
        pytest.raises(col.InputError, match="check positions and outlines"),
    ):
        plot.scene(IMPACTS["head-on"], outline_a=(1e200, 1e200))


@pytest.mark.parametrize(
    ("moment", "drawn"),
    [
        ("before", {"a.before", "b.before"}),
        ("after", {"a.after", "b.after", "impulse.a", "impulse.b"}),
        ("both", {"a.before", "b.before", "a.after", "b.after", "impulse.a", "impulse.b"}),
    ],
)
def test_the_moment_chooses_what_is_drawn(moment, drawn):
    axes = plot.scene(IMPACTS["sticking"], moment=moment)
    assert set(arrows(axes)) == drawn | {"normal", "tangent"}
    assert moment in axes.get_title().lower() or moment == "both"
    assert ("impulses" in axes.get_xlabel()) == (moment != "before")


def test_outlines_lie_along_the_heading():
    """Length and width, and how far ahead of the middle the centre of mass is; with units."""
    turned = B.replace(heading="30 deg")
    axes = plot.scene(
        col.eccentric(A, turned, 0.1, friction=0.5, **T_BONE),
        outline_a=(4.4, 1.8),
        outline_b=("440 cm", "1.75 m", 0.2),
    )
    corners = named(axes, "a.outline").get_xy()[:4] - (-2.2, 0.0)
    assert corners == pytest.approx(np.array([(2.2, -0.9), (2.2, 0.9), (-2.2, 0.9), (-2.2, -0.9)]))
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    own = (named(axes, "b.outline").get_xy()[:4] - (0.9, -0.8)) @ np.array([[c, -s], [s, c]])
    assert own == pytest.approx(
        np.array([(2.0, -0.875), (2.0, 0.875), (-2.4, 0.875), (-2.4, -0.875)])
    )
    assert area(named(axes, "b.outline")) == pytest.approx(4.4 * 1.75)
    # The heavy edge is the front.
    assert named(axes, "a.front").get_xdata() == pytest.approx([0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("name", ["outline_a", "outline_b"])
def test_an_outline_needs_position_and_heading(name):
    with pytest.raises(col.MissingInputError, match="has no x") as caught:
        plot.scene(IMPACTS["example 2"], **{name: (4.0, 1.8)})
    assert caught.value.code == "missing_position"
    with pytest.raises(
        col.MissingInputError, match=rf"has no heading, which {name} needs"
    ) as caught:
        plot.scene(IMPACTS["oblique"], **{name: (4.0, 1.8)})
    assert caught.value.code == "missing_heading"


def test_an_outline_is_not_drawn_into_a_sketch():
    """One vehicle has its place, the other has none: together they have no scale."""
    impact = col.linear_central(
        col.Vehicle(mass=1000.0, vx=9.0, x=0.0, y=0.0, heading=0.0), col.Vehicle(mass=900.0), 0.1
    )
    with pytest.raises(col.MissingInputError, match="b has no x") as caught:
        plot.scene(impact, outline_a=(4.0, 1.8))
    assert caught.value.code == "missing_position"


@pytest.mark.parametrize("given", [4.4, (4.4,), (1.0, 2.0, 3.0, 4.0), "4.4 m", {}])
def test_an_outline_of_another_form_is_refused(given):
    with pytest.raises(
        col.ShapeError, match=r"outline_b must be \(length, width\).*corners \(forward, left\)"
    ) as caught:
        plot.scene(IMPACTS["sticking"], outline_b=given)
    assert caught.value.code == "bad_shape"


@pytest.mark.parametrize(
    ("given", "code"),
    [
        ((0.0, 1.8), "not_positive"),
        ((4.4, math.inf), "bad_outline"),
        ((4.4, "1.8 kg"), "bad_units"),
        ((4.4, [1.0]), "bad_shape"),
    ],
)
def test_sizes_that_cannot_be_are_refused(given, code):
    with pytest.raises(col.InputError, match="outline_a") as caught:
        plot.scene(IMPACTS["sticking"], outline_a=given)
    assert caught.value.code == code


def test_a_moment_that_is_not_known_is_refused():
    with pytest.raises(
        col.InputError, match="moment must be 'before', 'after' or 'both', got 'during'"
    ) as caught:
        plot.scene(IMPACTS["sticking"], moment="during")
    assert caught.value.code == "bad_option"


@pytest.mark.slow
def test_places_that_were_not_given_are_a_sketch_and_said_to_be():
    """No numbers or units on the axes, which would be made up, nor arrows measured in lengths."""
    for case in ("example 2", "wall in line"):
        axes = drawn("scene", case)
        assert is_sketch(axes)
        assert len(axes.get_xticks()) == len(axes.get_yticks()) == 0
        assert axes.get_xlabel().startswith("x\n")
        assert axes.get_xlabel().endswith(
            "\narrows: one scale for all velocities; one scale for all impulses"
        )
        assert axes.get_ylabel() == "y"
        assert (
            plot.scene(IMPACTS[case], moment="before")
            .get_xlabel()
            .endswith("\narrows: one scale for all velocities")
        )
    for case in ("oblique", "sticking", "wall aslant"):
        axes = drawn("scene", case)
        assert "sketch" not in axes.get_xlabel()
        assert "one scale" not in axes.get_xlabel()
        assert len(axes.get_xticks()) > 2


def test_what_is_met_at_the_contact_alone_is_a_wall_behind_it():
    axes = plot.scene(IMPACTS["wall aslant"])
    assert {"b.wall", "a.centre"} <= names(axes)
    assert "b.centre" not in names(axes)
    n = np.array(IMPACTS["wall aslant"].normal)
    depths = (named(axes, "b.wall").get_xy() - (0.0, -0.5)) @ n
    assert depths.min() == pytest.approx(0.0, abs=1e-9)
    assert depths.max() > 0.1


@pytest.mark.slow
def test_a_speed_that_is_known_from_one_side_is_marked_as_that():
    """A, whose speed is known, is not."""
    cars = (
        col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=x, y=0.0, heading=0.0) for x in (-2.0, 2.0)
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        (found,) = reconstruct.speeds(
            *cars,
            course_a=0.0,
            course_b=0.5 * math.pi,
            restitution=0.1,
            normal=0.0,
            point=(0.0, 0.0),
            friction=0.3,
            delta_v_forward_a=-6.0,
            delta_v_left_a=1.9,
            slid="bound",
        )
    shown = [text.get_text() for text in plot.scene(found, units="si").texts]
    assert any(re.match(r"A before: \d", text) for text in shown)
    assert any(re.match(r"B before: at least \d", text) for text in shown)
    assert any("with the least slip" in text for text in shown if text.startswith("B after"))


def test_the_pivot_is_marked():
    axes = drawn("scene", "example 3")
    assert np.ravel(named(axes, "b.pivot").get_xydata()) == pytest.approx((0.0, 0.0))
    assert "pivot of B" in [text.get_text() for text in axes.texts]


@pytest.mark.parametrize("case", ["example 3", "pinned and turning"])
def test_the_impulse_of_the_pivot_is_drawn_at_the_pivot(case):
    """In the scale of the other impulses, with its size; none before the impact, and none without a
    pivot.
    """
    side = IMPACTS[case].b
    axes = plot.scene(IMPACTS[case], units="metric")
    start, tip = arrows(axes)["pivot_impulse.b"]
    assert start == pytest.approx((0.0, 0.0), abs=1e-12)
    per_impulse = scale(axes, "impulses") * 1e3
    assert (tip - start) * per_impulse == pytest.approx(
        (side.pivot_impulse_x, side.pivot_impulse_y), rel=1e-9, abs=1e-6
    )
    size = math.hypot(side.pivot_impulse_x, side.pivot_impulse_y)
    assert f"impulse of the pivot on B\n{number(size / 1e3)} kN·s" in [
        text.get_text() for text in axes.texts
    ]
    assert not [
        name for name in arrows(plot.scene(IMPACTS[case], moment="before")) if "impulse" in name
    ]
    assert "pivot_impulse.b" not in arrows(drawn("scene", "sticking"))


LONG = "Volkswagen Transporter T5 Kombi 2.0 TDI 4Motion of a witness"


def named_long(impact):
    """The same with a name of sixty letters for each."""
    a, b = (
        side.before.replace(name=name) for side, name in ((impact.a, LONG), (impact.b, LONG[::-1]))
    )
    return col.eccentric(a, b, impact.restitution, friction=impact.friction, **T_BONE)


def in_points(axes, place):
    """As printed."""
    return axes.transData.transform(place) * 72.0 / axes.figure.dpi


@pytest.mark.slow
def test_a_slow_rebound_is_not_under_the_arrow_that_arrives():
    """Its ends are further from the line of that arrow than half a head is wide, 3 points, and from
    the mark of the centre, 5.
    """
    axes = plot.scene(IMPACTS["rebound"], outline_a=(4.4, 1.8), units="metric")
    axes.figure.draw_without_rendering()
    ends = arrows(axes)
    (_, centre), after = (in_points(axes, ends[f"a.{when}"]) for when in ("before", "after"))
    assert min(abs(after[:, 1] - centre[1])) > 3.0
    assert min(np.hypot(*(place - centre)) for place in after) > 5.0
    assert "drawn side by side" in axes.get_xlabel()


@pytest.mark.slow
def test_a_label_does_not_stand_on_the_other_vehicle():
    """What is said of A not on B, nor what is said of B on A, by a quarter of it or more."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.EnergyGainWarning)
        gain = col.eccentric(A, B, 1.0, impulse_ratio=0.5, **T_BONE)
    for impact in (
        gain,
        named_long(IMPACTS["sticking"]),
        *(IMPACTS[case] for case in ("pinned and turning", "head-on")),
    ):
        axes = plot.scene(impact, outline_a=(4.4, 1.8), outline_b=(4.2, 1.75), units="metric")
        axes.figure.draw_without_rendering()
        paths = {letter: named(axes, f"{letter.lower()}.outline").get_path() for letter in "AB"}
        to_data = axes.transData.inverted().transform
        for text in axes.texts:
            found = re.match(
                r"([AB])( |$)|impulse on ([AB])|impulse of the pivot on ([AB])|pivot of ([AB])",
                text.get_text(),
            )
            if found is None:
                continue
            own = found.group(1) or found.group(3) or found.group(4) or found.group(5)
            box = text.get_window_extent()
            other = paths["B" if own == "A" else "A"]
            inside = other.contains_points(
                to_data(list(itertools.product(*np.linspace(box.p0, box.p1, 9).T)))
            )
            assert np.mean(inside) < 0.25, text.get_text()
        plt.close(axes.figure)


@pytest.mark.slow
def test_long_names_leave_room_for_the_picture():
    """In lines of their own; the title within the figure, and no two of the energies' names on each
    other.
    """
    impact = named_long(IMPACTS["sticking"])
    bars = plot.energy(impact)
    bars.figure.draw_without_rendering()
    assert bars.bbox.width > 0.5 * bars.figure.bbox.width
    _, boxes = labels_beside(bars.yaxis)
    assert all(
        other.y1 < one.y0 + 1.0 or one.y1 < other.y0 + 1.0
        for one, other in itertools.combinations(boxes, 2)
    )
    for axes in (bars, plot.momentum(impact), plot.scene(impact), plot.force_time(impact, 0.1)):
        axes.figure.draw_without_rendering()
        title = axes.title.get_window_extent()
        assert title.x0 >= 0.0
        assert title.x1 <= axes.figure.bbox.width
        texts = [text for text in axes.texts if text.get_text()]
        wide = [
            text for text in texts if text.get_window_extent().width > 0.4 * axes.figure.bbox.width
        ]
        assert wide == []
    # What does not fit is seen to go on.
    everything = "\n".join(text.get_text() for text in plot.scene(named_long_more(impact)).texts)
    assert "\u2026" in everything


def named_long_more(impact):
    """More than three lines."""
    return col.eccentric(
        impact.a.before.replace(name=3 * LONG),
        impact.b.before,
        impact.restitution,
        friction=impact.friction,
        **T_BONE,
    )


def test_yaw_rates_say_which_way_round():
    """A turns counter-clockwise after this impact, B clockwise."""
    texts = "\n".join(
        text.get_text() for text in plot.scene(IMPACTS["sticking"], units="metric").texts
    )
    impact = IMPACTS["sticking"]
    for letter, sign in (("A", "↺"), ("B", "↻")):
        rate = getattr(impact, letter.lower()).after.yaw_rate
        assert (rate > 0.0) == (sign == "↺")
        assert f"yaw {abs(math.degrees(rate)):.0f}°/s {sign}" in texts


def test_names_are_text_and_no_formula():
    axes = drawn("scene", "oblique")
    (text,) = [text for text in axes.texts if "van $1" in text.get_text()]
    assert text.get_text() == "A (van $1)"
    assert not text.get_parse_math()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("picture", "case"),
    [
        *(
            ("scene", case)
            for case in (
                "example 2",
                "oblique",
                "sticking",
                "elastic",
                "head-on",
                "example 3",
                "wall aslant",
            )
        ),
        *(("scene", case) for case in ("rebound", "pinned and turning")),
        ("momentum", "sticking"),
        ("momentum", "pinned and turning"),
    ],
)
def test_labels_do_not_hide_each_other(picture, case):
    """As drawn: letters of two labels overlap by a point at most."""
    axes = drawn(picture, case)
    figure = axes.figure
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in axes.texts if text.get_text()]
    point = figure.dpi / 72.0
    for i, one in enumerate(boxes):
        for other in boxes[i + 1 :]:
            wide = min(one.x1, other.x1) - max(one.x0, other.x0)
            high = min(one.y1, other.y1) - max(one.y0, other.y0)
            assert min(wide, high) <= 1.0 * point, (axes.texts[i].get_text(), wide, high)


def random_crash(rng):
    """A car struck from the left by another one."""
    while True:
        course = rng.uniform(-math.pi, math.pi)
        cars = [
            col.Vehicle(
                mass=rng.uniform(900.0, 2500.0), yaw_inertia=rng.uniform(1500.0, 4500.0),
                x=side * rng.uniform(1.0, 2.3),
                y=rng.uniform(-1.5, 1.5), heading=heading, vx=speed * math.cos(heading),
                vy=speed * math.sin(heading),
                yaw_rate=rng.choice((0.0, rng.uniform(-2.0, 2.0))),
            )
            for side, heading, speed in ((-1, rng.uniform(-0.3, 0.3), rng.uniform(5.0, 30.0)),
            (1, course, rng.uniform(0.0, 25.0)))
        ]  # fmt: skip
        impact = col.eccentric(
            *cars, rng.uniform(0.0, 0.4), normal=rng.uniform(-0.5, 0.5),
            point=(0.0, rng.uniform(-0.5, 0.5)),
            friction=rng.uniform(0.0, 0.8), on_failure="nan",
        )  # fmt: skip
        if impact.ok:
            return impact


def strokes(axes):
    """The ends in pixels of every straight piece of outlines, front edges, ways, marks
    and arrows.
    """
    lines = [one for one in (*axes.patches, *axes.lines) if one.get_linestyle() != "None"]
    paths = [one.get_transform().transform_path(one.get_path()).vertices for one in lines]
    paths += [axes.transData.transform(ends) for ends in arrows(axes).values()]
    return np.concatenate([np.stack([path[:-1], path[1:]], axis=1) for path in paths])


def crossed(boxes, pieces):
    """Which boxes some straight piece passes through: it is clipped to each of them (Liang and
    Barsky).
    """
    begin, way = pieces[:, 0], pieces[:, 1] - pieces[:, 0] + 1e-12
    reach = [(boxes[:, None, k : k + 2] - begin) / way for k in (0, 2)]
    enters = np.minimum(*reach).max(axis=2)
    leaves = np.maximum(*reach).min(axis=2)
    return (np.maximum(enters, 0.0) <= np.minimum(leaves, 1.0)).any(axis=1)


def on_labels(boxes, others):
    """Which boxes lie on one of the others."""
    return (
        ((boxes[:, None, :2] < others[:, 2:]) & (boxes[:, None, 2:] > others[:, :2]))
        .all(axis=2)
        .any(axis=1)
    )


def has_room(axes, box, others, pieces):
    """Whether there is a place within 60 points of where the label stands that is clear of
    everything by five points.
    """
    inside, point = np.array(axes.bbox.extents), axes.figure.dpi / 72.0
    moves = point * np.stack(np.meshgrid(*2 * [np.arange(-60.0, 60.1, 3.0)]), axis=-1).reshape(
        -1, 2
    )
    tried = box + np.tile(moves, 2) + 5.0 * point * np.array([-1.0, -1.0, 1.0, 1.0])
    tried = tried[
        (tried[:, :2] >= inside[:2]).all(axis=1) & (tried[:, 2:] <= inside[2:]).all(axis=1)
    ]
    tried = tried[~on_labels(tried, others)]
    return bool((~crossed(tried, pieces)).any())


def covering(axes):
    """How many labels there are, and the texts of those that cover a line or another label although
    there is room.
    """
    axes.figure.draw_without_rendering()
    texts = [text for text in axes.texts if text.get_text()]
    boxes, pieces = np.array([text.get_window_extent().extents for text in texts]), strokes(axes)
    found = []
    for i, text in enumerate(texts):
        one, others = boxes[i : i + 1], np.delete(boxes, i, axis=0)
        if (crossed(one, pieces) | on_labels(one, others)).any() and has_room(
            axes, boxes[i], others, pieces
        ):
            found.append(text.get_text())
    return len(texts), found


FIGURES = ((4.5, 4.0), (6.0, 5.0), (7.5, 6.5), (11.0, 5.0))
OUTLINES = {"outline_a": (4.4, 1.8), "outline_b": (4.2, 1.75)}


@pytest.mark.slow
def test_labels_leave_outlines_fronts_arrows_and_each_other_alone():
    """Also after the figure has changed its size, when they are placed anew."""
    figure = Figure((11.0, 5.0), layout="constrained")
    axes = plot.scene(
        IMPACTS["sticking"], **OUTLINES, axes=figure.subplots(1, 2)[0], units="metric"
    )
    assert covering(axes) == (11, [])
    figure.set_size_inches(6.0, 5.0)
    assert covering(axes)[1] == []


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_labels_of_random_scenes_leave_everything_else_alone(seed):
    """At four sizes of the figure, before and after its layout is settled."""
    rng = random.Random(seed)
    for picture in ("scene", "scene", "path"):
        impact = random_crash(rng)
        axes = Figure(rng.choice(FIGURES), layout=rng.choice(("constrained", None))).subplots()
        if picture == "scene":
            plot.scene(impact, **OUTLINES, axes=axes, units=rng.choice(SYSTEMS))
        else:
            ways = [
                travel.simulate(side.after, travel.Tyres(0.7, 0.4, 2.7, 1.5))
                for side in (impact.a, impact.b)
            ]
            plot.path(*ways, **OUTLINES, axes=axes, units=rng.choice(SYSTEMS))
        assert covering(axes)[1] == []


# Momentum


@pytest.mark.slow
@pytest.mark.parametrize("case", IMPACTS)
def test_arrows_of_the_momentum_diagram_are_the_momenta(case):
    impact, system = IMPACTS[case], UNITS[case]
    found = vectors(drawn("momentum", case))
    per_unit = 1.0 / factor(system, "impulse")
    size = max(math.hypot(*vector) for vector in found.values()) * per_unit
    for letter in "ab":
        for when in ("before", "after"):
            state = getattr(getattr(impact, letter), when)
            if math.isinf(state.mass) or state.speed == 0.0:
                assert f"{when}.{letter}" not in found
            else:
                shown = found[f"{when}.{letter}"] * per_unit
                assert shown == pytest.approx(
                    (state.mass * state.vx, state.mass * state.vy), abs=ROUNDING * size
                )


@pytest.mark.parametrize(
    "case", ["example 2", "oblique", "sticking", "sliding", "ratio", "elastic", "head-on"]
)
def test_free_vehicles_keep_their_total_momentum(case):
    """The two chains end where the total ends: equation 2 of the paper."""
    found = vectors(drawn("momentum", case))
    zero = np.zeros(2)
    for when in ("before", "after"):
        chain = found.get(f"{when}.a", zero) + found.get(f"{when}.b", zero)
        assert chain == pytest.approx(found["total"], rel=1e-10, abs=1e-9)
    assert "outside" not in found


def test_momenta_are_head_to_tail():
    """Where none lies on another they start at the origin, and B where A ends."""
    ends = arrows(drawn("momentum", "sticking"))
    for when in ("before", "after"):
        assert ends[f"{when}.a"][0] == pytest.approx((0.0, 0.0))
        assert ends[f"{when}.b"][0] == pytest.approx(ends[f"{when}.a"][1])
        assert ends[f"{when}.b"][1] == pytest.approx(ends["total"][1])


def crossing(**changes):
    """Two cars that cross, and leave with known speeds."""
    given = {"course_a": "0 deg", "course_b": "90 deg", "course_a_after": "35 deg"}
    given |= {"course_b_after": "50 deg", "speed_a_after": "10 m/s", "speed_b_after": "11 m/s"}
    return col.reconstruct.momentum("1500 kg", "1300 kg", **(given | changes))


def test_the_solution_of_planar_momentum_has_its_diagram():
    """The momenta after are known; those before are the total along each course."""
    solution = crossing()
    found = vectors(plot.momentum(solution, units="si"))
    after = {
        "a": 15000.0 * np.array([math.cos(math.radians(35)), math.sin(math.radians(35))]),
        "b": 14300.0 * np.array([math.cos(math.radians(50)), math.sin(math.radians(50))]),
    }
    total = after["a"] + after["b"]
    for letter, momentum in after.items():
        assert found[f"after.{letter}"] == pytest.approx(momentum, rel=1e-9)
    assert found["total"] == pytest.approx(total, rel=1e-9)
    assert found["before.a"] == pytest.approx((total[0], 0.0), rel=1e-9, abs=1e-6)
    assert found["before.b"] == pytest.approx((0.0, total[1]), rel=1e-9, abs=1e-6)


@pytest.mark.slow
def test_an_impulse_that_was_stated_is_an_arrow_of_its_own():
    """Of planar momentum and of an impact; then there is no common total."""
    axes = plot.momentum(crossing(outside_impulse=(-400.0, 100.0)), units="si")
    found = vectors(axes)
    assert found["outside"] == pytest.approx((-400.0, 100.0), rel=1e-9)
    assert "total" not in found
    assert any("given by the impulse that was stated" in text for text in in_legend(axes))
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, vx=15.0, x=-2.0, y=0.0)
    b = col.Vehicle(mass=1300.0, yaw_inertia=2000.0, vy=10.0, x=2.0, y=0.3)
    impact = col.eccentric(
        a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5, outside_a=(-300.0, 50.0, 0.0)
    )
    found = vectors(plot.momentum(impact, units="si"))
    assert found["outside"] == pytest.approx((-300.0, 50.0), rel=1e-9)
    assert "total" not in found


def test_a_vehicle_of_planar_momentum_at_rest_has_no_arrow():
    axes = plot.momentum(
        col.reconstruct.momentum(
            1500.0, 1300.0, course_a=0.0, course_b=0.5 * math.pi, course_a_after=0.6,
            speed_a_after=10.0, speed_b_after=0.0,
        )
    )  # fmt: skip
    assert "after.b" not in vectors(axes)
    assert "B\u2032: at rest after" in in_legend(axes)
    many = crossing(speed_a_after=np.array([9.0, 10.0]))
    with pytest.raises(col.ShapeError, match="takes one case"):
        plot.momentum(many)


@pytest.mark.parametrize("case", ["example 2", "wall in line", "head-on", "example 3", "sliding"])
def test_momenta_along_one_line_do_not_hide_each_other(case):
    """Two that are parallel are apart, or follow each other."""
    axes = drawn("momentum", case)
    ends = list(arrows(axes).values())
    size = max(np.hypot(*(tip - tail)) for tail, tip in ends)
    for i, (tail, tip) in enumerate(ends):
        along = (tip - tail) / np.hypot(*(tip - tail))
        for other_tail, other_tip in ends[i + 1 :]:
            gaps = [
                along[0] * (p - tail)[1] - along[1] * (p - tail)[0] for p in (other_tail, other_tip)
            ]
            reach = sorted(float(along @ (p - tail)) for p in (other_tail, other_tip))
            overlap = min(reach[1], np.hypot(*(tip - tail))) - max(reach[0], 0.0)
            assert max(map(abs, gaps)) > 0.01 * size or overlap < 0.021 * size
    assert axes.get_title().endswith("\n(momenta on one line are drawn side by side)")


@pytest.mark.parametrize(
    ("names", "lines"),
    [
        (("middle", "front"), ["A: middle, B: front"]),
        (("A", "B"), []),
        (("", "front"), ["B: front"]),
        (("A", "front"), ["B: front"]),
        (("a" * 40, "b" * 40), ["A: " + "a" * 40, "B: " + "b" * 40]),
    ],
)
def test_the_title_of_momenta_names_the_vehicles_that_have_names(names, lines):
    a, b = (vehicle.replace(name=name) for vehicle, name in zip((A, B), names, strict=True))
    title = plot.momentum(col.eccentric(a, b, 0.1, friction=0.5, **T_BONE)).get_title()
    assert title.split("\n")[1:] == lines


LOCKED = travel.Tyres(0.8, 1.0, 2.7, 1.5)
WITH_TYRES = {"duration": 0.12, "tyres_a": LOCKED, "tyres_b": LOCKED}
PUSHED = {"outside_b": (300.0, 2500.0, 100.0)}


def acted_on(**more):
    """Two slow cars at right angles, on which more than each other acts."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.1, y=0.0, heading=0.0, vx=6.0)
    b = col.Vehicle(mass=1250.0, yaw_inertia=1900.0, x=0.9, y=0.0, heading="90 deg", vy=3.0)
    return col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.1), friction=0.3, **more)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("impact", "shown"),
    [
        (lambda: acted_on(**WITH_TYRES), {"lost.tyres"}),
        (lambda: acted_on(**PUSHED), {"lost.outside"}),
        (lambda: acted_on(**WITH_TYRES, **PUSHED), {"lost.tyres", "lost.outside"}),
        (lambda: reconstruct.central(1500.0, 1500.0, vb=0.0, vb_after=1.2, restitution=0.1,
            duration=0.1, drag_b=0.7), {"lost.outside"}),
    ],
)  # fmt: skip
def test_what_tyres_and_outside_impulses_take_or_give_has_a_bar(impact, shown):
    """So that what came in is what went out, and the last bar ends at zero."""
    impact = impact()
    axes = plot.energy(impact, units="si")
    bars = {bar.get_gid(): bar for bar in axes.patches if bar.get_gid()}
    assert {"lost.tyres", "lost.outside"} & bars.keys() == shown
    total = impact.a.before.kinetic_energy + impact.b.before.kinetic_energy
    last = bars["b.after"]
    assert last.get_x() + last.get_width() == pytest.approx(0.0, abs=1e-9 * total)
    if "lost.outside" in shown:
        work = impact.a.outside_work + impact.b.outside_work
        assert bars["lost.outside"].get_width() == pytest.approx(work, rel=1e-9)
    named = [label.get_text() for label in axes.get_yticklabels()]
    by_drag = impact.reconstruction is not None
    assert ("lost by\nthe tyres" in named) == (by_drag or "lost.tyres" in shown)


@pytest.mark.parametrize("together", [False, True])
@pytest.mark.parametrize("pushed", [False, True])
def test_the_tyres_of_planar_momentum_are_in_its_picture(together, pushed):
    """What they give follows A and B before, and ends where A and B after end."""
    more = {"outside_impulse": (2000.0, -1500.0)} if pushed else {}
    after = {"course_a_after": 0.4, "speed_a_after": 8.0}
    if not together:
        after |= {"course_b_after": 0.7, "speed_b_after": 9.0}
    found = reconstruct.momentum(1500.0, 1250.0, course_a=0.0, course_b=1.5, heading_a=0.0,
        heading_b=1.5, together=together, **after, **WITH_TYRES, **more)  # fmt: skip
    axes = plot.momentum(found, units="si")
    arrows = vectors(axes)
    assert "total" not in arrows
    given = [
        getattr(found, f"tyre_impulse_{axis}_a") + getattr(found, f"tyre_impulse_{axis}_b") + more
        for axis, more in zip("xy", more.get("outside_impulse", (0.0, 0.0)), strict=True)
    ]
    assert arrows["outside"] == pytest.approx(given, rel=1e-7)
    (text,) = [one for one in in_legend(axes) if one.startswith("outside")]
    stated = " and the impulse that was stated" if pushed else ""
    assert text.startswith(f"outside: given by the tyres{stated} ")


def in_legend(axes):
    """The texts of the legend."""
    return [text.get_text() for text in axes.get_legend().get_texts()]


@pytest.mark.parametrize(
    ("b", "before", "after"),
    [
        (col.Vehicle(mass=1500.0), "B: at rest before", "A\u2032: at rest after"),
        (col.Vehicle.barrier(), None, None),
    ],
)
def test_the_legend_of_momenta_says_who_is_at_rest(b, before, after):
    """An elastic impact stops A by a vehicle of its mass; a barrier has no momentum to speak of."""
    texts = in_legend(plot.momentum(col.linear_central(col.Vehicle(mass=1500.0, vx=20.0), b, 1.0)))
    assert [text for text in texts if "rest" in text or "no momentum" in text] == [
        text for text in (before, after) if text
    ]


def test_who_turns_on_the_spot_is_not_at_rest():
    impact = col.eccentric(A, B.replace(vy=0.0, yaw_rate=1.0), 0.1, friction=0.5, **T_BONE)
    assert "B: no momentum before" in in_legend(plot.momentum(impact))


def test_what_a_pivot_gives_closes_the_diagram():
    """The impulse of the pivot on B is 3.65 kN s in Example 3."""
    impact = IMPACTS["example 3"]
    found = vectors(plot.momentum(impact, units="metric"))
    assert found["outside"] == pytest.approx(
        (impact.b.pivot_impulse_x / 1e3, impact.b.pivot_impulse_y / 1e3), abs=1e-12
    )
    assert math.hypot(*found["outside"]) == pytest.approx(3.65, abs=0.005)
    before, after = (
        sum(
            side.before.momentum[0] if when == "before" else side.after.momentum[0]
            for side in (impact.a, impact.b)
        )
        / 1e3
        for when in ("before", "after")
    )
    assert before + found["outside"][0] == pytest.approx(after)


def test_the_diagram_of_a_pinned_body_is_closed():
    """A, B and what the pivot gives are head to tail, A' and B' too, and both begin and end at one
    place, or are joined there.
    """
    axes = drawn("momentum", "pinned and turning")
    ends = arrows(axes)
    assert set(ends) == {"before.a", "before.b", "after.a", "after.b", "outside"}
    near = {"abs": 1e-9 * np.hypot(*ends["before.a"][1])}
    assert ends["before.a"][0] == pytest.approx((0.0, 0.0))
    for one, other in (("before.a", "before.b"), ("before.b", "outside"), ("after.a", "after.b")):
        assert ends[one][1] == pytest.approx(ends[other][0], **near)
    aside = ends["after.a"][0]
    assert ends["after.b"][1] - ends["outside"][1] == pytest.approx(aside, **near)
    assert np.hypot(*aside) > 0.0
    assert named(axes, "begin").get_xydata()[1] == pytest.approx(aside, **near)
    assert named(axes, "end").get_xydata() == pytest.approx(
        np.array([ends["outside"][1], ends["after.b"][1]]), **near
    )
    assert axes.get_title().endswith(
        "side by side with those before;\nthin lines join what is one place)"
    )
    dashes = [
        line._unscaled_dash_pattern
        for line in axes.get_lines()
        if not line.get_label().startswith("_")
    ]
    colours = [
        line.get_color() for line in axes.get_lines() if not line.get_label().startswith("_")
    ]
    assert len({(str(dash), colour) for dash, colour in zip(dashes, colours, strict=True)}) == 5


def test_a_pinned_body_whose_momenta_are_apart_needs_no_lines():
    """Both chains from the origin."""
    axes = drawn("momentum", "wall aslant")
    ends = arrows(axes)
    assert ends["after.a"][0] == pytest.approx((0.0, 0.0))
    assert ends["after.a"][1] == pytest.approx(ends["outside"][1])
    assert not {"begin", "end"} & names(axes)


def test_what_a_wall_gives_closes_the_diagram():
    impact = IMPACTS["wall aslant"]
    axes = plot.momentum(impact, units="si")
    found = vectors(axes)
    assert found["outside"] == pytest.approx((impact.a.impulse_x, impact.a.impulse_y))
    assert (
        "given by B, of infinite mass"
        in [text.get_text() for text in axes.get_legend().get_texts()][-1]
    )


def test_two_infinite_masses_have_no_momentum_to_draw():
    """A can turn: the impact has an answer, but no momentum."""
    a = col.Vehicle(mass=math.inf, yaw_inertia=2000.0, yaw_rate=1.0, x=0.0, y=-2.0)
    impact = col.eccentric(
        a, col.Vehicle.barrier(), 0.2, normal="180 deg", point=(0.0, 0.0), friction=0.0
    )
    with pytest.raises(col.InputError, match="both vehicles have an infinite mass") as caught:
        plot.momentum(impact)
    assert caught.value.code == "infinite_mass"


# Impulse plane


def on_line(line, x, y):
    """How far a place is from a drawn line, in parts of the impulse."""
    (x0, x1), (y0, y1) = line.get_data()
    length = math.hypot(x1 - x0, y1 - y0)
    return abs((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / length / math.hypot(x, y)


@pytest.mark.slow
@pytest.mark.parametrize("law", ["brach", "kudlich-slibar"])
@pytest.mark.parametrize("family", ["traffic", "barrier", "A pinned", "B pinned", "both pinned"])
def test_lines_of_the_impulse_plane_are_those_of_the_reference(family, law):
    """K and no-slip impulse from 60 digits: on each line the closing speed or the slip is what the
    line says.
    """
    for scene, answer in cases(family, law, "friction", 2):
        if answer.regime not in ("sliding", "sticking"):
            continue
        axes = plot.impulse_plane(solved("eccentric", scene))
        k_nn, k_nt, k_tt = (float(part) for part in (answer.k_nn, answer.k_nt, answer.k_tt))
        c, slip, e = float(answer.closing), float(answer.slip), scene.restitution
        wanted = {
            "end of compression": (k_nn, k_nt, c),
            "end of restitution": (k_nn, k_nt, (1.0 + e) * c),
            "no slip": (k_nt, k_tt, -slip),
        }
        if law == "kudlich-slibar" and e > 0.0:
            wanted["no slip at separation"] = (k_nt, k_tt, -(1.0 + e) * slip)
        assert ("no slip at separation" in names(axes)) == (len(wanted) == 4)
        for name, (along_n, along_t, total) in wanted.items():
            for x, y in named(axes, name).get_xydata():
                # Rounding of the kernel, of the difference the yield is read from, and of the ends
                # of the line.
                size = abs(along_n * x) + abs(along_t * y) + abs(total)
                assert along_n * x + along_t * y == pytest.approx(total, abs=1e-9 * size), (
                    name,
                    scene,
                )
        plt.close(axes.figure)


@pytest.mark.slow
@pytest.mark.parametrize("case", IMPACTS)
def test_the_answer_is_where_the_lines_put_it(case):
    impact, system = IMPACTS[case], UNITS[case]
    axes = drawn("impulse_plane", case)
    (x,), (y,) = named(axes, "answer").get_data()
    per_unit = 1.0 / factor(system, "impulse")
    assert (x * per_unit, y * per_unit) == pytest.approx(
        (impact.normal_impulse, impact.tangential_impulse), rel=ROUNDING
    )
    assert on_line(named(axes, "end of restitution"), x, y) < 1e-10
    (x1,), (y1,) = named(axes, "at compression").get_data()
    assert on_line(named(axes, "end of compression"), x1, y1) < 1e-10
    assert x1 * per_unit == pytest.approx(impact.compression_impulse)
    if impact.regime == "sticking":
        last = "no slip" if impact.law == "brach" else "no slip at separation"
        assert on_line(named(axes, last), x, y) < 1e-10
        assert on_line(named(axes, "no slip"), x1, y1) < 1e-10 or impact.law == "brach"
    if impact.regime == "sliding":
        edge = "friction +" if y > 0.0 else "friction -"
        assert on_line(named(axes, edge), x, y) < 1e-10
    low, high = axes.get_ylim()
    assert axes.get_xlim()[0] == 0.0
    assert x < axes.get_xlim()[1]
    assert low < y < high


def test_the_friction_cone_has_the_slope_of_the_friction():
    axes = drawn("impulse_plane", "sticking")
    for name, slope in (("friction +", 0.5), ("friction -", -0.5)):
        (x0, x1), (y0, y1) = named(axes, name).get_data()
        assert (y1 - y0) / (x1 - x0) == pytest.approx(slope)
    assert any("friction 0.5" in text.get_text() for text in axes.get_legend().get_texts())


@pytest.mark.parametrize(
    ("case", "lines"),
    [("no slip", 0), ("elastic", 0), ("example 2", 0), ("ratio", 0), ("sliding", 2)],
)
def test_there_is_a_cone_only_where_friction_bounds_the_impulse(case, lines):
    axes = drawn("impulse_plane", case)
    assert len([name for name in names(axes) if name.startswith("friction")]) == lines
    assert ("ratio" in names(axes)) == (case == "ratio")
    assert ("no slip" in names(axes)) == (case != "example 2")


def test_a_friction_as_good_as_infinite_has_no_cone():
    """Its edges would lie beyond what floats hold."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        axes = plot.impulse_plane(col.eccentric(A, B, 0.1, friction=1e308, **T_BONE))
    assert not [name for name in names(axes) if name.startswith("friction")]
    assert "cone" not in axes.get_xlabel()


@pytest.mark.parametrize(
    ("case", "ends"),
    [
        ("sticking", ":\nat the diamond if the contact sticks, on the cone if it slides."),
        ("grazing", ",\nhere on the cone: the contact slides."),
        ("ratio", ",\nhere at the impulse ratio given."),
        ("elastic", ",\nhere on the axis: there is no friction."),
        ("no slip", ",\nhere where slip ends: the contact sticks."),
        ("stronge", ",\nhere where slip ends: the contact sticks."),
        ("turning around", ",\nhere within the cone: the slip turns around."),
    ],
)
def test_the_impulse_plane_speaks_of_nothing_that_is_out_of_the_picture(case, ends):
    """The caption of the diamond and the cone, the legend of the lines, and the title of a no-slip
    impulse not drawn.
    """
    corner = {"normal": "70 deg", "point": (2.3, 0.9), "friction": 0.3}
    others = {
        "grazing": lambda: col.eccentric(
            A.replace(x=0.0, vx="80 km/h"), col.Vehicle.barrier(), 0.1, **corner
        ),
        "stronge": lambda: col.eccentric(A, B, 0.1, friction=0.5, law="stronge", **T_BONE),
        "turning around": lambda: col.eccentric(
            A, B.replace(vy=-0.5), 0.1, friction=0.1, law="stronge", normal=0.0, point=(0.0, -1.5)
        ),
    }
    axes = plot.impulse_plane(others[case]() if case in others else IMPACTS[case])
    assert axes.get_xlabel().endswith(f"\nThe impulse ends on the solid line{ends}")
    assert ("\n(the no-slip impulse lies outside the picture)" in axes.get_title()) == (
        case == "grazing"
    )
    assert any("slip ends" in text for text in in_legend(axes)) == (case != "grazing")
    box, line = axes.get_window_extent(), named(axes, "no slip")
    assert line.get_transform().transform_path(line.get_path()).intersects_bbox(
        box, filled=False
    ) == (case != "grazing")


def test_the_impulse_plane_of_a_collinear_impact_says_how_it_is_read():
    ends = ",\nhere on the axis: there is no tangential impulse in this model."
    for case in ("example 2", "wall in line"):
        axes = drawn("impulse_plane", case)
        assert axes.get_xlabel().endswith(f"\nThe impulse ends on the solid line{ends}")
        x, y = named(axes, "answer").get_data()
        assert y == [0.0]
        assert named(axes, "end of restitution").get_xdata() == pytest.approx([x[0], x[0]])


@pytest.mark.slow
@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0])
@pytest.mark.parametrize("slip", [0.0, 30.0])
def test_a_contact_that_moves_along_the_normal_alone_has_no_lines_of_slip(angle, slip):
    """A wall squarely on a pinned gate: no impulse changes the slip, whatever rounding leaves of
    the coefficients.
    """
    (c, s), far = (math.cos(angle), math.sin(angle)), 300.0
    gate = col.Vehicle(mass=1000.0, yaw_inertia=1333.0, x=far - s, y=far + c, pivot=(far, far))
    wall = col.Vehicle.barrier(
        vx=5.0 * c - slip * s, vy=5.0 * s + slip * c, x=far - 5.0 * c, y=far - 5.0 * s
    )
    for contact in (
        {"friction": 0.0},
        {"impulse_ratio": 0.3},
        {"impulse_ratio": 0.3, "law": "kudlich-slibar"},
    ):
        impact = col.eccentric(
            wall, gate, 0.2, normal=angle, point=(far - 2.0 * s, far + 2.0 * c), **contact
        )
        axes = plot.impulse_plane(impact)
        assert names(axes).isdisjoint({"no slip", "no slip at separation", "no-slip impulse"})
        assert "end of restitution" in names(axes)
        assert "one degree of freedom" in axes.get_title()


@pytest.mark.slow
def test_the_plane_of_a_model_that_solve_chose_is_that_of_the_model():
    """Re-asked for another ratio, the choice itself might be another."""
    chosen = col.solve(A, B, 0.1, friction=0.5, tolerance=1e9, **T_BONE)
    assert chosen.model != "eccentric"
    plot.impulse_plane(chosen)
    whole = col.solve(A, B, 0.1, friction=0.5, **T_BONE)
    one, other = (
        named(plot.impulse_plane(impact), "no slip").get_xydata()
        for impact in (whole, IMPACTS["sticking"])
    )
    assert one == pytest.approx(other)


@pytest.mark.slow
def test_an_energy_gain_is_not_warned_of_again():
    with pytest.warns(col.EnergyGainWarning):
        gaining = col.eccentric(A, B, 1.0, impulse_ratio=0.5, **T_BONE)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plot.impulse_plane(gaining)
        axes = plot.energy(gaining, units="metric")
    assert axes.get_title().startswith(f"Energy gained: {-gaining.energy_loss / 1e3:.1f} kJ")
    assert any(text.get_text().endswith("gained") for text in axes.texts)


# Force against time


@pytest.mark.slow
@pytest.mark.parametrize("case", IMPACTS)
def test_areas_are_the_impulses(case):
    """To rounding, from the corners that were drawn; their ratio is the restitution."""
    impact, system = IMPACTS[case], UNITS[case]
    axes = drawn("force_time", case)
    per_area = 1.0 / (factor(system, "force") * factor(system, "time"))
    assert area(named(axes, "A1")) * per_area == pytest.approx(
        impact.compression_impulse, rel=ROUNDING
    )
    if impact.restitution == 0.0:
        assert "A2" not in names(axes)
    else:
        second = area(named(axes, "A2")) * per_area
        assert second == pytest.approx(impact.restitution_impulse, rel=ROUNDING)
        assert second / (area(named(axes, "A1")) * per_area) == pytest.approx(
            impact.restitution, rel=ROUNDING
        )


def test_areas_whose_ratio_is_not_the_restitution_are_the_impulses():
    """Where slip stops or turns, e squared is the share of the work that is given back, and the
    impulse of restitution is not e times that of compression.
    """
    a = col.Vehicle(mass=2113, yaw_inertia=3593, vx=6.25, vy=-0.5, x=-2.2, y=0.44)
    b = col.Vehicle(mass=1500, yaw_inertia=2550, vx=2.25, vy=-7.94, x=2.2, y=-0.93)
    impact = col.eccentric(a, b, 0.2, normal=0.0, point=(0, 0), friction=0.87, law="stronge")
    axes = plot.force_time(impact, 0.1, units="si")
    first, second = (area(named(axes, name)) for name in ("A1", "A2"))
    assert first == pytest.approx(impact.compression_impulse, rel=ROUNDING)
    assert second == pytest.approx(impact.restitution_impulse, rel=ROUNDING)
    assert first + second == pytest.approx(
        named(axes, "mean force").get_ydata()[0] * 0.1, rel=ROUNDING
    )
    assert second / first == pytest.approx(0.264, abs=1e-3)
    assert "A2/A1" not in axes.get_title()


@pytest.mark.slow
@pytest.mark.parametrize(("restitution", "turn"), [(0.0, 0.1), (0.25, 0.08), (1.0, 0.05)])
def test_restitution_takes_its_part_of_the_time(restitution, turn):
    """Figure 3: as long as compression if elastic, shorter if elastoplastic, no time if plastic."""
    impact = col.linear_central(
        col.Vehicle(mass=1000.0, vx=10.0), col.Vehicle(mass=1000.0), restitution
    )
    axes = plot.force_time(impact, 0.1)
    first = named(axes, "A1").get_xy()
    assert (first[:, 0].min(), first[:, 0].max()) == pytest.approx((0.0, turn))
    assert named(axes, "end of compression").get_xdata()[0] == pytest.approx(turn)
    if restitution:
        second = named(axes, "A2").get_xy()
        assert (second[:, 0].min(), second[:, 0].max()) == pytest.approx((turn, 0.1))
        # One peak for both.
        assert second[:, 1].max() == pytest.approx(first[:, 1].max(), rel=1e-12)
    assert impact.kind in axes.get_title()
    # A quarter of a sine has the mean 2/pi of its height; the polygon differs by (pi/2/399)**2 / 12
    # = 1.3e-6.
    assert first[:, 1].max() == pytest.approx(
        0.5 * math.pi * impact.compression_impulse / turn, rel=2e-6
    )


@pytest.mark.slow
@pytest.mark.parametrize("restitution", [0.0, 0.1, 0.25, 1.0])
def test_the_pulse_that_is_drawn_is_the_one_that_left_out_assumes(restitution):
    """Bodies moved by the force in the picture, Newton's law in steps: where they are, and how far
    they went into each other.

    The polygon is off by 1.3e-6 of the sine, and the trapezoids of 400 corners by as much again.
    """
    a, b = col.Vehicle(mass=1000.0, vx=10.0), col.Vehicle(mass=1500.0, vx=-3.0)
    impact = col.linear_central(a, b, restitution)
    corners = [
        named(plot.force_time(impact, 0.12), name).get_xy()[1:-2]
        for name in ("A1", "A2")[: 1 + (restitution > 0.0)]
    ]
    time, force = np.concatenate(corners).T

    def summed(values):
        return np.concatenate([[0.0], np.cumsum(np.diff(time) * 0.5 * (values[1:] + values[:-1]))])

    passed = summed(force)
    way_a, way_b = summed(10.0 - passed / 1000.0), summed(-3.0 + passed / 1500.0)
    found = col.left_out(impact, duration=0.12)
    assert found.mutual_crush == pytest.approx(np.max(way_a - way_b), rel=5e-6)
    assert found.residual_crush == pytest.approx(way_a[-1] - way_b[-1], abs=5e-6)
    assert (found.a.displacement_x, found.b.displacement_x) == pytest.approx(
        (way_a[-1], way_b[-1]), abs=5e-6
    )


@pytest.mark.slow
def test_the_mean_force_is_the_impulse_over_the_duration():
    impact = IMPACTS["example 2"]
    axes = plot.force_time(impact, 0.12, units="si")
    assert named(axes, "mean force").get_ydata()[0] == pytest.approx(impact.normal_impulse / 0.12)
    assert "assumed" in axes.get_title()


@pytest.mark.parametrize(
    ("given", "code"),
    [
        (0.0, "not_positive"),
        (-0.1, "not_positive"),
        (math.inf, "not_finite"),
        (math.nan, "not_finite"),
        (np.array([0.1, 0.2]), "bad_shape"),
        ([0.1], "bad_shape"),
        ("0.1 m", "bad_units"),
        (True, "not_a_number"),
    ],
)
def test_a_duration_that_cannot_be_is_refused(given, code):
    with pytest.raises(col.InputError, match="duration") as caught:
        plot.force_time(IMPACTS["example 2"], given)
    assert caught.value.code == code
    # An infinite one is refused, so it is not offered.
    assert "inf allowed" not in str(caught.value)
    assert not plt.get_fignums()


@pytest.mark.slow
def test_a_duration_in_milliseconds_is_suspected():
    with pytest.warns(col.SuspectUnitsWarning, match="'100 ms'"):
        plot.force_time(IMPACTS["example 2"], 100.0)
    plot.force_time(IMPACTS["example 2"], "2 s")


# Energy


@pytest.mark.slow
@pytest.mark.parametrize("case", IMPACTS)
def test_bars_are_the_energies_and_what_came_in_went_out(case):
    impact, system = IMPACTS[case], UNITS[case]
    axes = drawn("energy", case)
    per_unit = 1.0 / factor(system, "energy")
    bars = {bar.get_gid(): bar for bar in axes.patches if bar.get_gid()}

    def energy(state):
        """By hand."""
        if math.isinf(state.mass):
            return 0.0
        turning = 0.0 if state.yaw_rate == 0.0 else 0.5 * state.yaw_inertia * state.yaw_rate**2
        return 0.5 * state.mass * (state.vx**2 + state.vy**2) + turning

    total = energy(impact.a.before) + energy(impact.b.before)
    for name, wanted in {
        "a.before": energy(impact.a.before),
        "b.before": energy(impact.b.before),
        "lost.normal": -impact.energy_loss_normal,
        "lost.tangential": -impact.energy_loss_tangential,
        "a.after": -energy(impact.a.after),
        "b.after": -energy(impact.b.after),
    }.items():
        assert bars[name].get_width() * per_unit == pytest.approx(
            wanted, rel=1e-12, abs=1e-12 * total
        )
    ordered = list(bars.values())
    for one, other in itertools.pairwise(ordered):
        assert other.get_x() == pytest.approx(
            one.get_x() + one.get_width(), abs=1e-9 * total / per_unit
        )
    # Kinetic energies and losses are worked out apart from each other: what is left over is
    # rounding.
    assert (ordered[-1].get_x() + ordered[-1].get_width()) * per_unit == pytest.approx(
        0.0, abs=1e-12 * total
    )


def test_a_moving_wall_has_no_finite_energy_and_the_refusal_says_what_to_do():
    wall = col.Vehicle.barrier(vx=-2.0)
    impact = col.linear_central(col.Vehicle(mass=1000.0, vx=10.0), wall, 0.1)
    with pytest.raises(
        col.InputError,
        match=r"b has an infinite mass or yaw inertia and moves.*frame in which it rests",
    ) as caught:
        plot.energy(impact)
    assert caught.value.code == "infinite_mass"
    assert not plt.get_fignums()
    # The other pictures need no energy.
    plot.momentum(impact)
    plot.scene(impact)


def test_bars_differ_in_more_than_colour():
    """In an SVG file too, where hatching on a face that is seen through would have the colour of
    the face.
    """
    drawn_bars = [bar for bar in drawn("energy", "sticking").patches if bar.get_gid()]
    assert all(bar.get_facecolor()[3] == 1.0 for bar in drawn_bars if bar.get_hatch())
    bars = {bar.get_gid(): bar.get_hatch() for bar in drawn_bars}
    assert bars["lost.normal"] != bars["lost.tangential"]
    assert not bars["a.before"]
    assert bars["a.after"] not in (bars["lost.normal"], bars["lost.tangential"], "")


def test_lines_differ_in_more_than_colour():
    for draw in (plot.impulse_plane, plot.momentum):
        axes = draw(IMPACTS["returning slip"])
        handles = [
            line
            for line in axes.get_lines()
            if not line.get_label().startswith("_") and line.get_linestyle() != "None"
        ]
        if draw is plot.impulse_plane:
            styles = [(str(line._unscaled_dash_pattern), line.get_linewidth()) for line in handles]
            assert len(set(styles)) == len(styles)
        else:
            tags = [line.get_label().partition(":")[0] for line in handles]
            assert set(tags) <= {text.get_text() for text in axes.texts}


# Uncertainty


def test_bars_are_the_contributions():
    found = RESULT["energy"]
    axes = plot.contributions(RESULT, "energy")
    bars = {bar.get_gid(): bar.get_width() for bar in axes.patches if bar.get_gid()}
    assert bars == pytest.approx(
        {f"share of {name}": 100.0 * share for name, share in found.contributions.items()}
    )
    assert [text.get_text() for text in axes.get_yticklabels()] == list(found.contributions)
    wanted = [100.0 * found.total_contributions[name] for name in found.contributions]
    assert named(axes, "total").get_xdata() == pytest.approx(wanted)
    segments = [
        np.diff(segment[:, 0])[0] / 2
        for group in axes.collections
        for segment in group.get_segments()
    ]
    errors = [
        100.0 * found.contribution_standard_errors[name][which]
        for which in (0, 1)
        for name in found.contributions
    ]
    assert segments == pytest.approx(errors)
    assert axes.get_xlabel() == "share of the variance [%]"


@pytest.mark.parametrize(("system", "unit"), [("si", "J"), ("metric", "kJ"), ("us", "ft·lbf")])
def test_pictures_of_an_output_have_its_unit(system, unit):
    spread = RESULT["energy"].std * factor(system, "energy")
    title = plot.contributions(RESULT, "energy", units=system).get_title()
    assert title.startswith(f"energy: standard deviation {number(spread)} {unit}")
    assert plot.distribution(RESULT["energy"], units=system).get_xlabel() == f"energy [{unit}]"


@pytest.mark.slow
def test_each_share_has_its_figure_beside_its_own_mark():
    """Inputs that act together: bar and diamond are far apart, and each figure is nearer to its
    own; none is minus nothing.
    """

    def product(a, b, c):
        return {"y": a * b + 0.3 * c}

    known = {
        name: uncertainty.Normal(mean, 1.0) for name, mean in (("a", 0.3), ("b", 0.2), ("c", 0.0))
    }
    result = uncertainty.propagate(product, known, method="quasi_random", samples=2048, seed=1)
    axes = plot.contributions(result)
    axes.figure.draw_without_rendering()
    found = result["y"]
    boxes = []
    for name in found.contributions:
        own, total = 100.0 * found.contributions[name], 100.0 * found.total_contributions[name]
        labels = [named(axes, f"{which} of {name}") for which in ("own", "total")]
        assert [label.get_text() for label in labels] == [f"{own:.1f} %", f"in all {total:.1f} %"]
        errors = [100.0 * error for error in found.contribution_standard_errors[name]]
        assert [label.xy[0] for label in labels] == pytest.approx(
            [own + errors[0], total + errors[1]]
        )
        boxes += [label.get_window_extent() for label in labels]
    for one, other in itertools.combinations(boxes, 2):
        assert (
            min(
                min(one.x1, other.x1) - max(one.x0, other.x0),
                min(one.y1, other.y1) - max(one.y0, other.y0),
            )
            <= 1.0
        )
    idle = uncertainty.propagate(
        lambda a, b: {"y": a + 1e-9 * b},
        {"a": known["a"], "b": known["b"]},
        method="quasi_random",
        samples=256,
        seed=1,
    )
    assert not any("\u22120.0" in text.get_text() for text in plot.contributions(idle).texts)


def test_an_output_without_a_unit_is_not_given_one():
    assert plot.distribution(RESULT["momentum"], units="us").get_xlabel() == "momentum"
    assert (
        plot.contributions(RESULT["momentum"], units="us")
        .get_title()
        .startswith("momentum: standard deviation 13")
    )


def test_a_local_method_has_no_standard_errors_and_none_are_drawn():
    local = uncertainty.propagate(squared, INPUTS, method="first_order")
    axes = plot.contributions(local, "energy")
    assert not axes.collections
    assert "standard error" not in [text.get_text() for text in axes.get_legend().get_texts()]
    with pytest.raises(col.InputError, match="nothing was sampled") as caught:
        plot.distribution(local["energy"])
    assert caught.value.code == "not_sampled"


@pytest.mark.parametrize("system", SYSTEMS)
def test_the_histogram_and_its_lines_are_those_of_the_output(system):
    found = RESULT["energy"]
    axes = plot.distribution(found, coverage=0.9, bins=25, units=system)
    kilo = factor(system, "energy")
    values, edges, _ = named(axes, "histogram").get_data()
    assert values.sum() == pytest.approx(100.0)
    counts = np.histogram(found.values * kilo, edges)[0]
    assert len(values) == 25
    # An edge may fall on the other side of a value when both are multiplied.
    assert values == pytest.approx(100.0 * counts / counts.sum(), abs=100.0 * 1.5 / counts.sum())
    low, high = np.quantile(found.values, (0.05, 0.95)) * kilo
    for name, wanted in {
        "low": low,
        "high": high,
        "mean": found.values.mean() * kilo,
        "median": np.median(found.values) * kilo,
    }.items():
        assert named(axes, name).get_xdata()[0] == pytest.approx(wanted, rel=1e-9)
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert any(text.startswith("90 % interval") for text in texts)


def test_which_output_must_be_said_if_there_are_several():
    with pytest.raises(col.InputError, match="'energy', 'momentum'; say which one") as caught:
        plot.contributions(RESULT)
    assert caught.value.code == "no_output"
    with pytest.raises(col.InputError, match="there is no output 'speed'") as caught:
        plot.contributions(RESULT, "speed")
    assert caught.value.code == "no_output"
    single = uncertainty.propagate(
        lambda speed: {"double": 2.0 * speed}, {"speed": INPUTS["speed"]}, method="first_order"
    )
    assert plot.contributions(single).get_title().startswith("double")


@pytest.mark.parametrize("given", [None, IMPACTS["sticking"], {"speed": 1.0}, 3.0])
def test_what_is_no_result_of_a_propagation_is_refused(given):
    with pytest.raises(col.InputError, match=r"uncertainty\.propagate returned"):
        plot.contributions(given)
    with pytest.raises(col.InputError, match=r"plot.distribution\(result\['delta_v'\]\)"):
        plot.distribution(given)
    with pytest.raises(col.InputError, match="without a name"):
        plot.contributions(RESULT["energy"], "energy")
    with pytest.raises(col.InputError, match="output must be a name"):
        plot.contributions(RESULT, 3)


@pytest.mark.slow
def test_an_interval_has_neither_shares_nor_one_distribution():
    mixed = uncertainty.propagate(
        squared,
        INPUTS | {"mass": uncertainty.Interval(1100.0, 1300.0)},
        method="quasi_random",
        samples=256,
        seed=1,
    )
    for draw in (plot.contributions, plot.distribution):
        with pytest.raises(col.InputError, match="says nothing of likelihood") as caught:
            draw(mixed["energy"])
        assert caught.value.code == "no_variance"


def test_what_does_not_vary_has_no_variance_to_share():
    fixed = uncertainty.propagate(
        lambda speed: {"one": 0.0 * speed + 1.0}, {"speed": INPUTS["speed"]}, method="first_order"
    )
    with pytest.raises(col.InputError, match="'one' has no variance to share") as caught:
        plot.contributions(fixed)
    assert caught.value.code == "no_variance"


HALF = "\ud800"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["energy", "momentum", "scene"])
def test_half_a_letter_in_a_name_is_drawn_as_a_sign(name):
    """No font has it, and matplotlib cannot be given it."""
    a = col.Vehicle(mass=1500.0, vx=20.0, x=0.0, y=0.0, name=f"car {HALF}")
    axes = getattr(plot, name)(
        col.linear_central(a, col.Vehicle(mass=1200.0, x=3.0, y=0.0, name=HALF * 40), 0.1)
    )
    axes.figure.draw_without_rendering()


def test_a_momentum_beyond_floats_is_refused():
    """Each component is a float, their magnitude is not, and no arrow would be drawn."""
    impact = col.oblique_central(
        col.Vehicle(mass=9.2e306, vx=14.0, vy=14.0),
        col.Vehicle(mass=0.9),
        0.7,
        normal=0.0,
        friction=0.0,
    )
    with pytest.raises(col.InputError, match=r"mass = 9\.2e\+306 cannot be drawn") as refused:
        plot.momentum(impact)
    assert refused.value.code == "out_of_range"


def test_a_distribution_beyond_what_axes_hold_is_refused():
    """In mph the largest values would be infinite."""
    known = {"v": uncertainty.Normal(7e306, 3e305), "w": uncertainty.Normal(1.0, 0.1)}
    found = uncertainty.propagate(lambda v, w: {"speed": v * w}, known, seed=1, samples=64)
    with pytest.raises(col.InputError, match=r"^speed = .* cannot be drawn"):
        plot.distribution(found["speed"])
    with pytest.raises(col.InputError, match=r"^spread of speed = .* cannot be drawn"):
        plot.contributions(found, "speed")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mass", "speed", "duration", "argument"),
    [(1e-320, 1e-3, 0.1, "normal_impulse"), (1500.0, 1e-300, 0.1, "closing_speed"),
        (1500.0, 1e152, 0.1, "vx"), (1500.0, 20.0, 1e-308, "duration")],
)  # fmt: skip
def test_what_is_too_large_or_too_small_to_be_drawn_is_refused(mass, speed, duration, argument):
    """The impact has its numbers; its picture would need axes beyond the range of floats."""
    impact = col.linear_central(
        col.Vehicle(mass=mass, vx=speed, x=0.0, y=0.0), col.Vehicle(mass=mass, x=3.0, y=0.0), 0.3
    )
    with pytest.raises(col.InputError, match=f"{argument} = .* cannot be drawn") as refused:
        plot.force_time(impact, duration)
    assert refused.value.code == "out_of_range"
    for mass, speed in ((1e45, 1e20), (1e-45, 1e-20)):
        a, b = col.Vehicle(mass=mass, vx=speed, x=0.0, y=0.0), col.Vehicle(mass=mass, x=3.0, y=0.0)
        for draw in (plot.energy, plot.impulse_plane, plot.momentum, plot.scene):
            draw(col.linear_central(a, b, 0.3)).figure.draw_without_rendering()


# --- evidence


@pytest.fixture(scope="module")
def two_speeds():
    """A posterior of a sum and a difference."""
    known = {"x": uncertainty.Normal("20 m/s", "3 m/s"), "y": uncertainty.Uniform(0.0, 10.0)}
    seen = {"s": (25.0, 0.5), "d": uncertainty.Censored(low=12.0)}
    return reconstruct.posterior(
        lambda x, y: {"s": x + y, "d": x - y}, known, seen, samples=1024, seed=1
    )


@pytest.mark.slow
def test_a_corner_has_each_unknown_and_each_pair(two_speeds):
    """In the units asked for; the lines hold their share of the samples."""
    figure = plot.corner(two_speeds, units="metric")
    alone, pair, _ = figure.axes
    assert [axes.get_gid() for axes in figure.axes] == ["x", "x and y", "y"]
    assert pair.get_xlabel() == "x [km/h]"
    assert pair.get_ylabel() == "y"
    assert alone.get_xlim() == pytest.approx(pair.get_xlim())
    x, y = 3.6 * two_speeds["x"].values, two_speeds["y"].values
    (lines,) = [one for one in pair.collections if one.get_gid() == "shares"]
    for path, share in zip(lines.get_paths(), (0.95, 0.5), strict=True):
        # 1,024 samples on 28 x 28 cells: a line passes between the middles of cells of a hundredth
        # of the samples each.
        assert np.mean(path.contains_points(np.stack([x, y], axis=1))) == pytest.approx(
            share, abs=0.08
        )
    assert len(plot.corner(two_speeds, unknowns=["s", "y", "x"]).axes) == 6
    assert len(plot.corner(two_speeds, unknowns="x").axes) == 1
    plt.close("all")


@pytest.mark.slow
def test_no_residual_and_no_range_is_cut_off():
    # The reading is ten of its errors from the prior, of the same error: half way, five of them
    # with 1.4 to either side.
    prior = {"s": uncertainty.Normal(15.0, 1.0)}
    with pytest.warns(col.CollisionsWarning):
        found = reconstruct.posterior(
            lambda s: {"s": s}, prior, {"s": (25.0, 1.0)}, samples=512, seed=1
        )
    axes = plot.residuals(found)
    low, high = axes.get_xlim()
    drawn = [x for line in axes.get_lines() if line.get_gid() for x in line.get_xdata()]
    assert len(drawn) == 3
    assert max(map(abs, drawn)) > 6.0
    assert low < min(drawn) <= max(drawn) < high


@pytest.mark.slow
def test_residuals_stand_where_they_are(two_speeds):
    """Observed less computed over the error; a sharp bound has none. Of a fit the points alone."""
    axes = plot.residuals(two_speeds)
    by_gid = {line.get_gid(): line for line in axes.get_lines()}
    assert [label.get_text() for label in axes.get_yticklabels()] == ["s"]
    assert by_gid["residuals"].get_xdata() == pytest.approx(
        [2.0 * (25.0 - two_speeds.predicted["s"].mean)], abs=1e-9
    )
    low, high = two_speeds.predicted["s"].interval(0.95)
    assert sorted(by_gid["range of s"].get_xdata()) == pytest.approx(
        [2.0 * (25.0 - high), 2.0 * (25.0 - low)], abs=1e-9
    )
    fitted = reconstruct.fit(
        lambda v: {"p": v, "q": v}, {"v": 10.0}, {"p": (10.0, 1.0), "q": (12.0, 1.0)}
    )
    (points,) = [
        line for line in plot.residuals(fitted).get_lines() if line.get_gid() == "residuals"
    ]
    assert points.get_xdata() == pytest.approx([-1.0, 1.0], abs=1e-6)
    assert plot.distribution(two_speeds["x"]).get_title() == "given the evidence and the priors"
    plt.close("all")


@pytest.mark.slow
def test_axes_that_held_a_scene_take_another_picture(two_speeds):
    """clear() leaves the equal scales; a range of 1e-6 by 1e3 is a needle on them, whose width is 0
    in pixels.
    """
    a, b = col.Vehicle(mass=1500.0, vx=20.0, x=-2.0, y=0.0), col.Vehicle(mass=1200.0, x=2.0, y=0.0)
    axes = plot.momentum(col.linear_central(a, b, 0.1))
    assert axes.get_aspect() == 1.0
    axes.clear()
    axes.set(xlim=(0.0, 1e-300), ylim=(0.0, 1.0))
    axes.apply_aspect()
    assert plot.distribution(two_speeds["x"], axes=axes).get_aspect() == "auto"
    plt.close("all")


@pytest.mark.slow
def test_evidence_that_cannot_be_drawn(two_speeds):
    sharp = reconstruct.posterior(
        lambda x: {"x": x, "one": 1.0 + 0.0 * x, "rounded": 7.64092 + 1e-15 * x},
        {"x": uncertainty.Uniform(0, 1)},
        {"x": uncertainty.Interval(0.1, 0.2)},
        samples=512,
        seed=1,
    )
    for call, code in (
        (lambda: plot.corner(3.0), "bad_option"),
        (lambda: plot.corner(two_speeds, unknowns=[]), "bad_option"),
        (lambda: plot.corner(two_speeds, unknowns=Nasty()), "bad_option"),
        (lambda: plot.corner(two_speeds, unknowns=3), "bad_option"),
        (lambda: plot.corner(two_speeds, unknowns=np.array(3.0)), "bad_option"),
        (lambda: plot.corner(two_speeds, unknowns=["z"]), "unknown_name"),
        (lambda: plot.corner(two_speeds, unknowns=[["x"]]), "unknown_name"),
        (lambda: plot.corner(sharp, unknowns=["one"]), "no_spread"),
        (lambda: plot.corner(sharp, unknowns=["rounded"]), "no_spread"),
        (lambda: plot.residuals(3.0), "bad_option"),
        (lambda: plot.residuals(sharp), "no_residuals"),
    ):
        with pytest.raises(col.InputError) as refused:
            call()
        assert refused.value.code == code


@pytest.mark.slow
@pytest.mark.parametrize("units", SYSTEMS)
def test_the_way_to_rest_is_drawn_where_it_was(units):
    """Way, marks and both outlines in the units of the axes; the one at rest is filled and stands
    where the vehicle rests.
    """
    ways = [
        travel.simulate(side.after, travel.Tyres(0.7, 0.4, 2.7, 1.5))
        for side in (IMPACTS["sticking"].a, IMPACTS["sticking"].b)
    ]
    axes = plot.path(*ways, outline_a=(4.4, 1.8), outline_b=(4.1, 1.7), units=units)
    metre = UREG("1 m").m_as(SHOWN[units]["length"])
    drawn = {}
    for artist in axes.get_children():
        drawn.setdefault(artist.get_gid(), []).append(artist)
    for letter, way, (length, width) in zip("ab", ways, ((4.4, 1.8), (4.1, 1.7)), strict=True):
        (line,) = drawn[f"{letter}.path"]
        np.testing.assert_allclose(
            line.get_xydata(), metre * np.column_stack([way.x, way.y]), rtol=ROUNDING, atol=ROUNDING
        )
        marked = [mark for mark in way.marks if np.isfinite(mark[0]).any()]
        assert marked
        for artist, mark in zip(drawn[f"{letter}.mark"], marked, strict=True):
            np.testing.assert_allclose(
                artist.get_xydata(), metre * np.column_stack(mark), rtol=ROUNDING, atol=ROUNDING
            )
        (rest,) = drawn[f"{letter}.outline"]
        c, s = math.cos(way.rest.heading), math.sin(way.rest.heading)
        corners = [
            (0.5 * length * i, 0.5 * width * j) for i, j in ((1, -1), (1, 1), (-1, 1), (-1, -1))
        ]
        placed = [
            (way.rest.x + c * along - s * across, way.rest.y + s * along + c * across)
            for along, across in corners
        ]
        found = rest.get_xy()[:-1]
        for place in placed:
            assert np.min(np.hypot(*(found - metre * np.array(place)).T)) < 1e-9
        assert len(drawn[f"{letter}.passing outline"]) == 4
    assert axes.get_xlabel() == f"x [{SHOWN[units]['length']}]"


def test_a_way_is_drawn_in_the_units_of_its_vehicle():
    car = col.Vehicle(
        mass="3300 lb", yaw_inertia="57000 lb*ft**2", x="0 ft", y="0 ft", heading=0, vx="30 mph"
    )
    way = travel.simulate(car, travel.Tyres(0.7, 0.3, 2.7, 1.5))
    assert plot.path(way).get_xlabel() == "x [ft]"
    assert plot.path(way, units="metric").get_xlabel() == "x [m]"


def test_a_way_that_cannot_be_drawn_and_one_without_length():
    """Another object, a batch, an outline without a path; a vehicle that stands is shown with room
    about it.
    """
    still = travel.simulate(A.replace(vx=0.0), travel.Tyres(0.7, 1.0, 2.7, 1.5))
    axes = plot.path(still)
    assert axes.get_xlim()[1] - axes.get_xlim()[0] >= 4.0
    many = travel.simulate(A.replace(vx=np.array([3.0, 4.0])), travel.Tyres(0.7, 1.0, 2.7, 1.5))
    for arguments, options, code, said in (
        ((IMPACTS["sticking"],), {}, "bad_option", "travel.simulate"),
        ((still, A), {}, "bad_option", "path_b"),
        ((many,), {}, "bad_shape", "many cases"),
        ((still,), {"outline_b": (4.0, 1.7)}, "bad_option", "path_b"),
    ):
        with pytest.raises(col.InputError, match=said) as caught:
            plot.path(*arguments, **options)
        assert caught.value.code == code


@pytest.mark.slow
def test_a_label_is_placed_as_if_the_whole_picture_were_searched():
    # The search ends early where what lies farther away cannot cost less; here every cell is tried.
    generator = random.Random(7)
    for _ in range(30):
        room = drawing._Room(
            np.array([0.0, 0.0, generator.uniform(80, 500), generator.uniform(80, 500)])
        )
        for _ in range(generator.randrange(40)):
            ends = np.array(
                [[generator.uniform(-50, 550), generator.uniform(-50, 550)] for _ in range(2)]
            )
            room.draw(ends, 40.0 * generator.choice([0.8, 1.2, 2.0]))
        size = np.array([generator.uniform(10, 150), generator.uniform(8, 40)])
        places = np.array(
            [
                [generator.uniform(0, 500), generator.uniform(0, 500)]
                for _ in range(generator.choice([1, 3]))
            ]
        )
        direction = generator.uniform(-1, 1), 1.0
        columns, rows = np.minimum(np.ceil((size + 6.0) / 2.0).astype(int), room.cost.shape[::-1])
        windows = np.lib.stride_tricks.sliding_window_view(room.cost, (rows, columns))
        x, y = (
            np.convolve(part, np.ones(n) / n, "valid")
            for part, n in ((room.x, columns), (room.y, rows))
        )
        away = [
            drawing._away(x - at[0], y[:, None] - at[1], size, direction) + 2.0 * i
            for i, at in enumerate(places)
        ]
        least = (windows.sum(axis=(2, 3)) + np.min(away, axis=0)).min()
        before = room.cost.copy()
        (at_x, at_y), _ = room.best(size, places, direction, [])
        column, row = (int(np.argmin(abs(part - at))) for part, at in ((x, at_x), (y, at_y)))
        found = (
            before[row : row + rows, column : column + columns].sum()
            + np.min(away, axis=0)[row, column]
        )
        assert found == pytest.approx(least, rel=1e-9)


def test_a_long_path_breaks_between_its_parts():
    """And not within a word; a text whose words are short breaks between them as ever."""
    assert in_lines("impacts[0].a.delta_v_forward") == "impacts[0].a.\ndelta_v_forward"
    assert in_lines("impacts[0].energy_absorbed") == "impacts[0].energy_absorbed"
    assert in_lines("of the car that was struck first") == "of the car that was struck\nfirst"
    assert in_lines("x" * 30) == "x" * 26 + "\n" + "x" * 4
