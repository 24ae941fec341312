"""A report of what was found of a scene together with a run of that scene."""

import re

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct
from collisions.reporting import options
from collisions.scene import Contact, Mover, Scene
from collisions.uncertainty import Interval, Uniform

MPH = 0.44704


def scene(name="Rover", outline=None, mass=1500.0):
    """A car that runs into another one, which stands: in line, along x."""
    moves = col.Vehicle(mass=mass, yaw_inertia=2500.0, vx="30 mph", x=-4.5, y=0.0, heading=0.0)
    stands = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=0.0, y=0.0, heading=0.0)
    movers = {
        name: Mover(moves, drag=0.5, outline=outline),
        "Seat": Mover(stands, drag=0.6, outline=outline),
    }
    hit = Contact(name, "Seat", normal=0.0, point=(-2.25, 0.0), restitution=0.1, friction=0.5)
    return Scene(movers=movers, contacts=[hit], shared={"the speed": (f"{name}.vx",)})


UNKNOWN = {"the speed": Uniform("10 mph", "60 mph"), "contacts[0].restitution": Uniform(0.0, 0.3)}
# Half and some of the speed, and half less some: 7.4 and 6 m/s, that is 4.6 and 3.7 m to rest.
SEEN = {
    "Seat.rest.x": ("15.3 ft", "1 ft"),
    "Seat.rest.y": ("0 ft", "1 ft"),
    "Rover.rest.x": ("-2.6 ft", "0.5 ft"),
}


@pytest.fixture(scope="module")
def found():
    return reconstruct.posterior(scene(), UNKNOWN, SEEN, samples=512, seed=1)


@pytest.fixture(scope="module")
def run(found):
    return scene().replace({name: found[name].mean for name in UNKNOWN}).run()


def box(page):
    return page.split("\n## Answer\n")[1].split("\n## ")[0]


def test_the_answer_has_the_speeds_and_the_ranges_of_the_delta_v(found, run):
    """In line, with equal masses: (1 + e) / 2 of the speed, at each sample."""
    page = col.report([found, run], form="markdown")
    figures = dict(re.findall(r"\*\*(.+):\*\* (.+) mph \(95 %\)", box(page)))
    assert list(figures) == ["the speed", "delta-V of the Rover", "delta-V of the Seat"]
    drawn = 0.5 * (1.0 + found.draws["contacts[0].restitution"]) * found.draws["the speed"]
    low, high = (float(end) for end in figures["delta-V of the Rover"].split(" to "))
    assert [low, high] == pytest.approx(np.quantile(drawn, [0.025, 0.975]) / MPH, abs=0.06)
    assert "No range is stated" not in box(page)
    assert re.search(r"\| PDOF of the Seat .* \| 180 ± |\| closing speed \| .* mph \|", page)


def test_what_was_found_is_marked_among_what_was_given(found, run):
    page = col.report([found, run], form="markdown", units="us")
    mean = found["the speed"].mean / MPH
    assert f"| A (Rover) | velocity along x | {mean:.1f} mph, mean of part 1 |" in page
    assert re.search(r"\| contact \| restitution e \| 0\.\d+, mean of part 1 \|", page)
    assert "| A (Rover) | velocity along y | 0 mph |" in page
    assert "| contact | normal, direction from A into B | 0° |" in page
    other = scene().replace({"the speed": "31 mph"}).run()
    page = col.report([found, other], form="markdown", units="us")
    assert "| A (Rover) | velocity along x | 31.0 mph, set for this run |" in page


def test_the_picture_is_the_whole_way_with_the_measured_places(found, run):
    page = col.report([found, run])
    first = page.index("<figure>")
    assert first < page.index("</section>")
    assert "Crosses: where the vehicles were measured at rest." in page
    assert 'id="scene.Seat.measured"' in page
    assert 'id="scene.Rover.measured"' not in page


def test_outlines_are_those_of_the_scene(found):
    size = (4.4, 1.7)
    whole = scene(outline=size).replace({name: found[name].mean for name in UNKNOWN}).run()
    page = col.report([found, whole], form="markdown", units="metric")
    assert "**Outline of A:** 4.4 m long and 1.7 m wide" in page


def test_any_result_of_the_scene_can_be_the_answer(found, run):
    names = ["impacts[0].b.delta_v", "the speed"]
    page = col.report([found, run], form="markdown", answers=names)
    shown = re.findall(r"\*\*(.+):\*\* ", box(page).replace("\\", ""))
    assert shown == names
    assert col.report([found, run], **options(page)) == page
    with pytest.raises(col.InputError, match="answers has 'impacts"):
        col.report([found, run], answers=["impacts[3].b.delta_v"])


def test_notes_can_be_by_paths_of_the_scene(found, run):
    notes = {"Rover.mass": "Weighed", "Seat.rest.x": "Police", "the speed": "As the road allows"}
    page = col.report([found, run], form="markdown", notes=notes)
    assert re.search(r"\| A \(Rover\) \| mass \| .*\. Weighed \|", page)
    assert re.search(r"\| Seat.rest.x \| .* \| Police \|", page)
    with pytest.raises(col.InputError, match=r"notes has 'Rover\.mas', which is no input"):
        col.report([found, run], notes={"Rover.mas": "Weighed"})


def test_a_fit_has_the_picture_and_the_marks_without_ranges(run):
    fitted = reconstruct.fit(
        scene(), {"the speed": Interval("10 mph", "60 mph")}, {"Seat.rest.x": ("15 ft", "2 ft")}
    )
    best = scene().replace({"the speed": fitted["the speed"].value}).run()
    page = col.report([fitted, best], form="markdown", units="us")
    assert "mph, best value of part 1 |" in page
    assert "No range is stated for the figures above that have only one number." in box(page)


def test_a_run_of_another_scene_and_two_runs_are_refused(found, run):
    with pytest.raises(col.InputError, match=r"'the speed', which the scene of its run does not"):
        col.report([found, Scene(movers=scene().movers, contacts=scene().contacts).run()])
    movers = {"Other" if name == "Seat" else name: one for name, one in scene().movers.items()}
    hit = scene().contacts[0].replace(b="Other")
    shared = {"the speed": ("Rover.vx",)}
    other = Scene(movers=movers, contacts=[hit], shared=shared).run()
    with pytest.raises(col.InputError, match=r"'Seat\.rest\.x', which the scene"):
        col.report([found, other])
    with pytest.raises(col.InputError, match="goes with one posterior or fit of the same scene"):
        col.report([found, run, run])
    with pytest.raises(col.InputError, match="uncertainty must be a list"):
        col.report([found, run], uncertainty=[None])
