"""The picture that a notebook shows of a run: what is drawn is what the run has."""

import math
import xml.etree.ElementTree as Tree

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Scene
from crashes import NAMES, coasting, three_cars

SVG = "{http://www.w3.org/2000/svg}"
SIZES = dict(zip(NAMES, [(4.8, 1.8), (4.5, 1.7), (6.2, 2.3)], strict=True))


def drawn(run):
    """The SVG element of what a notebook shows."""
    html = run._repr_html_()
    return Tree.fromstring(html[: html.index("</svg>") + len("</svg>")])


def places(element):
    """The points of an element, y upwards, as complex numbers."""
    pairs = [map(float, pair.split(",")) for pair in element.get("points").split()]
    return np.array([complex(x, -y) for x, y in pairs])


def corners(body, length, width):
    turn, centre = np.exp(1j * body.heading), complex(body.x, body.y)
    signs = ((1, 1), (1, -1), (-1, -1), (-1, 1))
    return [centre + turn * complex(a * length, b * width) / 2.0 for a, b in signs]


def test_outlines_stand_at_the_start_and_at_rest() -> None:
    run = three_cars()
    area, *outlines = drawn(run).findall(f"{SVG}polygon")
    assert len(outlines) == 6
    assert sorted(places(area), key=lambda at: (at.real, at.imag)) == [
        2 + 4j,
        2 + 9j,
        8 + 4j,
        8 + 9j,
    ]
    for number, name in enumerate(NAMES):
        states = run.at(0.0)[name], run.rest[name]
        for outline, state in zip(outlines[2 * number :], states, strict=False):
            for corner in corners(state, *SIZES[name]):
                assert np.abs(places(outline) - corner).min() < 0.01


def test_fronts_are_heavy() -> None:
    run = three_cars()
    lines = drawn(run).findall(f"{SVG}polyline")
    widths = [float(line.get("stroke-width")) for line in lines]
    fronts = [line for line, width in zip(lines, widths, strict=True) if width > 1.5 * min(widths)]
    fronts = [places(line) for line in fronts if len(places(line)) == 2][:6]
    for number, name in enumerate(NAMES):
        ahead = run.at(0.0)[name], run.rest[name]
        for front, state in zip(fronts[2 * number :], ahead, strict=False):
            middle = complex(state.x, state.y) + 0.5 * SIZES[name][0] * np.exp(1j * state.heading)
            assert abs(front.mean() - middle) < 0.01


def test_tracks_are_those_of_the_run() -> None:
    run = three_cars()
    lines = [places(one) for one in drawn(run).findall(f"{SVG}polyline")]
    tracks = [line for line in lines if len(line) > 2]
    for name, line in zip(NAMES, tracks, strict=True):
        way = run.paths[name].x + 1j * run.paths[name].y
        steps = np.arange(len(way))
        dense = np.interp(np.arange(0.0, len(way) - 1.0, 0.05), steps, way)
        assert all(np.abs(dense - place).min() < 0.02 for place in line)
        assert abs(line[0] - way[0]) < 0.01
        assert abs(line[-1] - way[-1]) < 0.01


def test_impacts_the_bar_and_the_words() -> None:
    run = three_cars()
    svg = drawn(run)
    spots = svg.findall(f"{SVG}circle")
    for spot, impact in zip(spots, run.impacts, strict=True):
        assert float(spot.get("cx")) == pytest.approx(impact.point[0], abs=0.01)
        assert -float(spot.get("cy")) == pytest.approx(impact.point[1], abs=0.01)
    said = [one.text for one in svg.findall(f"{SVG}text")]
    assert said == ["1", "2", "3", *NAMES, "20 ft"]
    bar = places(svg.findall(f"{SVG}polyline")[-1])
    assert abs(bar[1] - bar[0]) == pytest.approx(20 * 0.3048, abs=0.02)
    label = svg.get("aria-label")
    rest = run.rest["Civic"]
    assert f"Civic comes to rest at x {rest.x / 0.3048:.2f} ft, y {rest.y / 0.3048:.2f} ft" in label
    assert "impact 2 is that of Civic and Truck at 0.70 s" in label


@pytest.mark.slow
def test_nothing_is_outside_the_view_and_it_is_small() -> None:
    for run in (three_cars(), coasting()):
        html = run._repr_html_()
        svg = drawn(run)
        left, top, wide, high = map(float, svg.get("viewBox").split())
        for one in (*svg.findall(f"{SVG}polygon"), *svg.findall(f"{SVG}polyline")):
            at = places(one)
            assert left <= at.real.min() <= at.real.max() <= left + wide
            assert top <= -at.imag.max() <= -at.imag.min() <= top + high
        assert html.index("</svg>") < 10_000
        assert html == run._repr_html_()


def test_names_are_no_markup_and_what_moves_on_says_so() -> None:
    html = coasting()._repr_html_()
    assert "<A" not in html
    said = [one.text for one in drawn(coasting()).findall(f"{SVG}text")]
    assert "<A & co> moves on" in said
    assert "moves on past" in drawn(coasting()).get("aria-label")


def test_what_has_no_places_and_a_batch_have_their_table_alone() -> None:
    contact = Contact("A", "B", restitution=0.0, normal=0, model="linear_central")
    for speed in (10.0, [10.0, 11.0]):
        a, b = col.Vehicle(mass=1500, vx=speed), col.Vehicle(mass=1000)
        run = Scene(movers={"A": Mover(a), "B": Mover(b)}, contacts=[contact]).run()
        html = run._repr_html_()
        assert "svg" not in html
        assert html == run.summary()._repr_html_()
    far = col.Vehicle(mass=1500, x=1e12, y=0, heading=0)
    alone = Scene(movers={"A": Mover(far, outline=(4, 2))}, contacts=[]).run()
    assert "svg" not in alone._repr_html_()


def test_labels_stand_apart() -> None:
    """Two vehicles that rest in the same place have their names beside each other."""
    a, b = (col.Vehicle(mass=1500, x=x, y=0, heading=0, vx=0) for x in (0.0, 4.6))
    movers = {name: Mover(one, outline=(4.5, 1.8)) for name, one in (("Left", a), ("Right", b))}
    svg = drawn(Scene(movers=movers, contacts=[]).run())
    one, other, _ = svg.findall(f"{SVG}text")
    size = float(svg.get("font-size"))
    away = math.hypot(
        float(one.get("x")) - float(other.get("x")), float(one.get("y")) - float(other.get("y"))
    )
    assert away > size
