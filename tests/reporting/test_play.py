"""The page that plays a scene: what it draws and says at each moment is what the run has there."""

from __future__ import annotations

import json
import math
import re
from html.parser import HTMLParser

import numpy as np
import pytest

import collisions as col
from collisions.reporting.play import _moment
from collisions.scene import Contact, Mover, Run, Scene
from collisions.scene.frames import frames_of
from collisions.travel import Tyres
from crashes import NAMES, coasting, furthest_from, over_ice, three_cars
from javascript import moved

FOOT, MPH = 0.3048, 0.44704


def data_of(page: str) -> dict:
    """The numbers that stand in the page."""
    return json.loads(re.search(r"const data = (\{.*\});\n", page)[1])


def places(svg: str, kind: str) -> list[np.ndarray]:
    """The points of every element of a class, y upwards."""
    found = re.findall(
        rf'points="([^"]*)"[^>]* class="{kind}"|class="{kind}" points="([^"]*)"', svg
    )
    return [
        np.array([[float(one) for one in pair.split(",")] for pair in (a or b).split()]) * [1, -1]
        for a, b in found
    ]


@pytest.mark.slow
def test_every_moment_has_the_numbers_of_the_run() -> None:
    run = three_cars()
    data = data_of(col.play(run))
    frames = frames_of(run)
    assert data["times"] == frames.times.tolist()
    assert data["times"][0] == 0.0
    assert data["times"][-1] == run.end
    after = [contact["after"] for contact in data["contacts"]]
    before = {number - 1 for number in after}
    rows = ("x", "y", "heading", "vx", "vy", "yaw_rate", "speed")
    for at in [0, 1, 2, 30, *after, 100, 200, len(data["times"]) - 1]:
        states = run.at(data["times"][at])
        for name, mover in zip(NAMES, data["movers"], strict=True):
            for row in rows[:3] if at in before else rows:
                assert mover[row][at] == getattr(states[name], row), (name, row, at)
    for impact, pair, at in zip(run.impacts, run.pairs, after, strict=True):
        for side, name in zip((impact.a, impact.b), pair, strict=True):
            mover = data["movers"][NAMES.index(name)]
            for row in rows[3:]:
                assert mover[row][at - 1] == pytest.approx(getattr(side.before, row), abs=1e-12)
                assert mover[row][at] == pytest.approx(getattr(side.after, row), abs=1e-12)


def test_steps_of_time_are_equal_between_contacts() -> None:
    frames = frames_of(three_cars())
    steps = np.diff(frames.times)
    assert steps.min() == 0.0
    assert steps.max() < 0.02 + 1e-12
    assert (steps == 0.0).sum() == 3
    assert [frames.times[at] for at in frames.after] == list(three_cars().times)


@pytest.mark.slow
def test_what_is_drawn_is_what_the_run_has() -> None:
    run = three_cars()
    page = col.play(run, units="us")
    data = data_of(page)
    moments = [0, 1, 60, 150, len(data["times"]) - 1]
    seen = moved(page, *(("move", "time", at) for at in moments))[1:]
    sizes = ((4.8, 1.8), (4.5, 1.7), (6.2, 2.3))
    for at, state in zip(moments, seen, strict=True):
        time = data["times"][at]
        bodies = run.at(time)
        assert state["outputs"]["time-value"] == f"{time:.2f} s"
        assert state["aria"]["time"] == f"{time:.2f} s"
        outlines = places(state["scene"], "now")[::2]
        tracks = places(state["scene"], "track")
        for i, (name, size) in enumerate(zip(NAMES, sizes, strict=True)):
            body = bodies[name]
            turn = complex(math.cos(body.heading), math.sin(body.heading))
            middle = complex(body.x, body.y)
            for one, two in ((1, 1), (1, -1), (-1, -1), (-1, 1)):
                corner = middle + turn * complex(one * size[0], two * size[1]) / 2.0
                off = np.hypot(*(outlines[i] - [corner.real, corner.imag]).T)
                assert off.min() < 1e-9
            assert len(tracks[i]) == at + 1
            assert tracks[i][-1] == pytest.approx([body.x, body.y], abs=1e-12)
            cells = {key.partition(".")[2]: text for key, text in state["cells"].items()
                     if key.startswith(f"{i}.")}  # fmt: skip
            if at:
                assert float(cells["speed"].split()[0]) == pytest.approx(
                    body.speed / MPH, abs=0.0501
                )
                assert float(cells["yaw"].rstrip("°/s")) == pytest.approx(
                    math.degrees(body.yaw_rate), abs=0.501
                )
            assert float(cells["x"].split()[0]) == pytest.approx(body.x / FOOT, abs=0.00501)
            assert cells["x"].endswith(" ft")
            assert float(cells["heading"].rstrip("°")) == pytest.approx(
                math.degrees(body.heading), abs=0.501
            )
        assert state["scene"].count('class="contact"') == sum(
            at >= contact["after"] for contact in data["contacts"]
        )


@pytest.mark.slow
def test_marks_grow_to_those_of_the_run() -> None:
    run = three_cars()
    page = col.play(run)
    last = len(data_of(page)["times"]) - 1
    first, at_end = moved(page, ("move", "time", last))
    gap = np.full((1, 2), np.nan)
    stretches = places(at_end["scene"], "mark")
    x, y = np.concatenate([part for one in stretches for part in (one, gap)]).T
    tracks = [np.array(mark).T for name in NAMES for mark in run.paths[name].marks.values()]
    of_run = np.concatenate([part for one in tracks for part in (one, gap)]).T
    # From the one to the other: places lie on the lines, within a step of the run's clock.
    assert furthest_from(x, y, of_run[:, np.isfinite(of_run[0])]) < 5e-3
    assert furthest_from(*of_run, np.array([x, y])[:, np.isfinite(x)]) < 0.4
    assert np.nanmax(np.hypot(np.diff(x), np.diff(y))) < 0.5
    assert not any(len(stretch) > 3 for stretch in places(first["scene"], "mark"))


@pytest.mark.slow
def test_a_mark_is_drawn_from_its_begin_to_its_end() -> None:
    page = col.play(over_ice())
    last = len(data_of(page)["times"]) - 1
    (_, at_end) = moved(page, ("move", "time", last))
    marks = places(at_end["scene"], "mark")
    assert len(marks) == 4
    for mark in marks:
        assert (mark[0, 0], mark[-1, 0]) == pytest.approx((30.05, 30.45), abs=1e-5)


@pytest.mark.slow
def test_what_is_said_of_contacts() -> None:
    run = three_cars()
    page = col.play(run, units="us")
    second = data_of(page)["contacts"][1]["after"]
    start, before, after = moved(page, ("move", "time", second - 1), ("move", "time", second))
    assert start["status"] == "Right before contact 1."
    assert before["status"] == "Right before contact 2."
    impact = run.impacts[1]
    assert after["status"] == (
        "Contact 2, Civic and Truck at 0.70 s: "
        f"closing speed {impact.closing_speed / MPH:.1f} mph, "
        f"delta-V of Civic {impact.a.delta_v / MPH:.1f} mph, "
        f"delta-V of Truck {impact.b.delta_v / MPH:.1f} mph."
    )
    assert "Camry" in after["said"]


class _Loads(HTMLParser):
    """What a page would load."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[tuple[str, str]] = []

    def handle_starttag(self, tag, attrs) -> None:
        self.found += [
            (tag, key) for key, _ in attrs if key in ("src", "href", "data", "srcset", "action")
        ]


@pytest.mark.slow
def test_the_page_loads_nothing_and_saves(tmp_path) -> None:
    page = col.play(three_cars())
    loads = _Loads()
    loads.feed(page)
    assert not loads.found
    assert "<!--" not in page.replace("<!DOCTYPE", "")
    assert "default-src 'none'" in page
    assert page.save(tmp_path / "crash.html").read_text(encoding="utf-8") == page
    assert page == col.play(three_cars())


@pytest.mark.slow
def test_names_are_no_markup_and_what_moves_on_goes_on_for_a_second() -> None:
    run = coasting()
    page = col.play(run)
    assert "<A & co>" not in page
    data = data_of(page)
    assert data["movers"][0]["label"] == "&lt;A &amp; co&gt;"
    assert data["times"][-1] == run.times[0] + 1.0
    assert data["movers"][1]["x"][-1] == pytest.approx(2.0 + 6.0 * 1.0)
    (state,) = moved(page)
    assert "&lt;A &amp; co&gt;" in state["scene"]


def through() -> Run:
    """A car pushes another one through a third, of which no contact says anything."""
    place = {"A": -10.0, "B": 0.0, "C": 6.5}
    movers = {
        name: Mover(
            col.Vehicle(mass=1500, yaw_inertia=2500, x=x, y=0.0, heading=0.0, vx=15.0 * (x < 0)),
            outline=(4.5, 1.8),
            tyres=Tyres(0.7, 0.3, 2.7, 1.5),
        )
        for name, x in place.items()
    }
    hit = Contact("A", "B", restitution=0.1, friction=0.5, at="touch")
    return Scene(movers=movers, contacts=[hit]).run()


@pytest.mark.slow
def test_findings_are_listed_and_said_when_their_time_comes() -> None:
    run = through()
    assert [one.movers for one in run.findings] == [("B", "C"), ("A", "C")]
    page = col.play(run)
    report = col.report(run, form="markdown")
    data = data_of(page)
    listed = re.findall(r'<li id="finding-\d">(.*)</li>', page)
    assert len(listed) == len(run.findings)
    for notice, text, found in zip(run.findings, listed, data["findings"], strict=True):
        assert notice.sentence in text
        assert f"{notice.time:.2f} s</button>" in text
        assert notice.sentence in report
        assert data["times"][found["after"] - 1] < notice.time <= data["times"][found["after"]]
    first, second = (one["after"] for one in data["findings"])
    moments = [first - 1, first, second - 1, second, len(data["times"]) - 1]
    states = moved(page, *(("move", "time", at) for at in moments))[1:]
    said = [[one.sentence in state["status"] for one in run.findings] for state in states]
    assert said == [[False, False], [True, False], [True, False], [False, True], [False, True]]


@pytest.mark.slow
def test_a_finding_at_a_contact_comes_after_it_and_a_page_without_any_has_no_list() -> None:
    bare = over_ice()
    assert not bare.findings
    assert "<li id=" not in col.play(bare)
    run = three_cars()
    frames = frames_of(run)
    assert [_moment(frames, time) for time in run.times] == frames.after
    assert _moment(frames, 0.5 * (frames.times[5] + frames.times[6])) == 6
    assert _moment(frames, 1e9) == len(frames.times) - 1


@pytest.mark.slow
def test_names_do_not_stand_in_each_other() -> None:
    """Both come to rest in one place, within 0.7 m."""
    page = col.play(through())
    last = moved(page, ("move", "time", len(data_of(page)["times"]) - 1))[1]
    at = [
        (float(x), float(y))
        for x, y in re.findall(r'<text class="name" x="([-\d.]+)" y="([-\d.]+)"', last["scene"])
    ]
    size = max(data_of(page)["view"][2:]) / 100.0
    assert len(at) == 3
    assert math.dist(at[0], at[2]) > 2.1 * size


@pytest.mark.slow
def test_numbers_of_contacts_at_one_moment_stand_in_a_row() -> None:
    """Of three cars in a row with little between them, the first two meet again at once."""
    movers = {
        name: Mover(
            col.Vehicle(mass=1500, yaw_inertia=2400, x=x, y=0.0, heading=0.0, vx=vx, vy=0.0),
            outline=(4.5, 1.8),
            drag=0.6,
        )
        for name, x, vx in (("A", 0.0, 18.0), ("B", 6.0, 0.0), ("C", 11.0, 0.0))
    }
    rule = {"restitution": 0.1, "friction": 0.5, "at": "touch"}
    run = Scene(
        movers=movers, contacts=[Contact("A", "B", **rule), Contact("B", "C", **rule)]
    ).run()
    shown = moved(col.play(run), ("move", "time", 1))[1]["speeds"]
    found = re.findall(r'<text class="number" x="([.0-9]+)"[^>]*>([^<]+)<', shown)
    assert [text for _, text in found] == ["1", "2, 3"]
    assert float(found[1][0]) - float(found[0][0]) > 14.0


@pytest.mark.slow
def test_angles_are_in_degrees_in_every_system() -> None:
    for units in ("si", "metric", "us"):
        data = data_of(col.play(three_cars(), units=units))
        assert data["units"]["angle"]["unit"] == "°"
        assert data["units"]["yaw rate"]["unit"] == "°/s"
        assert data["units"]["angle"]["scale"] == pytest.approx(180.0 / math.pi)


def test_what_cannot_be_played_is_refused() -> None:
    with pytest.raises(col.InputError, match=r"write collisions.play\(scene.run\(\)\)"):
        col.play(three_cars().scene)
    with pytest.raises(col.InputError, match="units"):
        col.play(three_cars(), units="imperial")
