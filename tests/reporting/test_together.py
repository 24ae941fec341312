"""A report of what was found of a scene together with a run of that scene."""

import pickle
import re
import warnings
from dataclasses import replace

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct
from collisions.reporting import options, replay
from collisions.scene import Contact, Mover, Scene
from collisions.scene.same import differs_at
from collisions.uncertainty import Interval, Uniform, propagate

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
UNKNOWN_E = "contacts[0].restitution"
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


@pytest.mark.slow
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


@pytest.mark.slow
def test_what_was_found_is_marked_among_what_was_given(found, run):
    page = col.report([found, run], form="markdown", units="us")
    assert "These, and the energy below, are of the run at the mean of part 1." in page
    mean = found["the speed"].mean / MPH
    assert f"| A (Rover) | velocity along x | {mean:.1f} mph, mean of part 1 |" in page
    assert re.search(r"\| contact \| restitution e \| 0\.\d+, mean of part 1 \|", page)
    assert "| A (Rover) | velocity along y | 0 mph |" in page
    assert "| contact | normal, direction from A into B | 0° |" in page
    other = scene().replace({"the speed": "31 mph"}).run()
    page = col.report([found, other], form="markdown", units="us")
    assert "| A (Rover) | velocity along x | 31.0 mph, set for this run |" in page
    assert "at the mean of part 1" not in page
    said = "with the speed and restitution of the contact of Rover and Seat as set for this run"
    said += ", which is not the mean of part 1."
    assert f"These, and the energy below, are of the run {said}" in page
    assert f"The results below are those {said}" in page


@pytest.mark.slow
def test_the_picture_is_the_whole_way_with_the_measured_places(found, run):
    page = col.report([found, run])
    first = page.index("<figure>")
    assert first < page.index("</section>")
    assert "Crosses: where the vehicles were measured at rest." in page
    assert 'id="scene.Seat.measured"' in page
    assert 'id="scene.Rover.measured"' not in page


@pytest.mark.slow
def test_outlines_are_those_of_the_scene(found):
    size = (4.4, 1.7)
    whole = scene(outline=size).replace({name: found[name].mean for name in UNKNOWN}).run()
    page = col.report([found, whole], form="markdown", units="metric")
    assert "**Outline of A:** 4.4 m long and 1.7 m wide" in page


@pytest.mark.slow
def test_any_result_of_the_scene_can_be_the_answer(found, run):
    names = ["impacts[0].b.delta_v", "the speed"]
    page = col.report([found, run], form="markdown", answers=names)
    shown = re.findall(r"\*\*(.+):\*\* ", box(page).replace("\\", ""))
    assert shown == names
    assert col.report([found, run], **options(page)) == page
    with pytest.raises(col.InputError, match="answers has 'impacts"):
        col.report([found, run], answers=["impacts[3].b.delta_v"])


@pytest.mark.slow
def test_notes_can_be_by_paths_of_the_scene(found, run):
    notes = {"Rover.mass": "Weighed", "Seat.rest.x": "Police", "the speed": "As the road allows"}
    page = col.report([found, run], form="markdown", notes=notes)
    assert re.search(r"\| A \(Rover\) \| mass \| .*\. Weighed \|", page)
    assert re.search(r"\| position x of Seat at rest \| .* \| Police \|", page)
    with pytest.raises(col.InputError, match=r"notes has 'Rover\.mas', which is no input"):
        col.report([found, run], notes={"Rover.mas": "Weighed"})


@pytest.mark.slow
def test_a_fit_has_the_picture_and_the_marks_without_ranges(run):
    fitted = reconstruct.fit(
        scene(), {"the speed": Interval("10 mph", "60 mph")}, {"Seat.rest.x": ("15 ft", "2 ft")}
    )
    best = scene().replace({"the speed": fitted["the speed"].value}).run()
    page = col.report([fitted, best], form="markdown", units="us")
    assert "mph, best value of part 1 |" in page
    assert "No range is stated for the figures above that have only one number." in box(page)


@pytest.mark.slow
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
    with pytest.raises(col.InputError, match=r"answers is .* and the page of a run alone"):
        col.report(run, answers=["the speed"])
    with pytest.raises(col.InputError, match="uncertainty must be a list"):
        col.report([found, run], uncertainty=[None])


@pytest.mark.slow
def test_a_heading_of_rest_has_no_whole_turns(found):
    """It turns by more than a turn on its way, and rests between -180 and 180 degrees."""
    spun = scene().replace({"Rover.yaw_rate": 15.0, "the speed": found["the speed"].mean}).run()
    turned = np.degrees(spun.rest["Rover"].heading)
    assert turned > 360.0
    # As of a model that is a function, of which nothing says that it was not this scene.
    page = col.report([replace(found, _scene=None), spun], form="markdown", units="us")
    (shown,) = re.findall(r"\| Rover \| heading at rest \| (-?[\d.]+)°", page)
    assert float(shown) == pytest.approx((turned + 180.0) % 360.0 - 180.0, abs=0.06)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"Seat.drag": 0.7}, "Seat.drag"),
        ({"contacts[0].friction": 0.6}, r"contacts\[0\].friction"),
        ({"Rover.vy": "1 mph"}, "Rover.vy"),
        ({"contacts[0].normal": "1 deg"}, r"contacts\[0\].normal"),
    ],
)
def test_a_run_of_a_scene_in_which_more_was_changed_is_refused(found, changes, path):
    """The ranges would be worked out in a scene that the evidence is not of."""
    given = {name: found[name].mean for name in UNKNOWN}
    kept = scene().replace(given).run()
    fitted = reconstruct.fit(
        scene(), {"the speed": Interval("10 mph", "60 mph"), UNKNOWN_E: Interval(0.0, 0.3)}, SEEN
    )
    for one in (found, pickle.loads(pickle.dumps(found)), fitted):
        assert "Places of rest" in col.report([one, kept], form="markdown")
        with pytest.raises(col.InputError, match=f"run of another scene: {path}.* differs") as no:
            col.report([one, scene().replace({**given, **changes}).run()])
        assert no.value.code == "bad_combination"


@pytest.mark.slow
def test_what_is_no_number_of_a_scene_is_compared_too():
    whole = scene(outline=(4.5, 1.8))
    start = [*whole.contacts]
    for other in (
        scene(outline=(4.6, 1.8)),
        Scene(movers=whole.movers, contacts=start, surfaces=[([(9, 9), (10, 9), (9, 10)], 0.5)]),
        Scene(movers=whole.movers, contacts=start * 2),
        Scene(movers=whole.movers, contacts=[start[0].replace(model="solve", tolerance=1.0)]),
        Scene(movers=whole.movers, contacts=[start[0].replace(law="stronge")]),
    ):
        assert differs_at(whole, other, ["Rover.vx"])
        assert differs_at(other, whole, ["Rover.vx"])
    assert not differs_at(whole, scene(outline=(4.5, 1.8)), UNKNOWN)
    assert not differs_at(whole, scene(), UNKNOWN)
    turned = whole.replace({"contacts[0].normal": 0.3})
    assert not differs_at(whole, turned, ["contacts[0].normal", *UNKNOWN])
    faster = scene().replace({"Rover.vy": 3.0, "the speed": 1.0})
    assert not differs_at(scene(), faster, ["Rover.speed", "Rover.course"])
    assert differs_at(scene(), faster, ["the speed"]) == "Rover.vy"


@pytest.mark.slow
def test_a_report_with_what_was_found_cannot_be_made_again_from_it(found, run):
    """Its model is code."""
    with pytest.raises(col.InputError, match="the report of a Posterior, which cannot be made"):
        replay(col.report([found, run], figures=False))


@pytest.mark.slow
def test_impacts_of_a_run_are_counted_and_what_does_not_vary_is_left_out(found):
    """In line the PDOF is the same at every sample; a second impact follows when they touch."""
    one = scene(outline=(4.0, 1.7))
    wall = Mover(col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=7.0, y=0.0, heading=0.0),
                 drag=0.6, outline=(4.0, 1.7))  # fmt: skip
    again = Contact("Seat", "Third", at="touch", model="linear_central", normal=0.0,
                    restitution=0.1)  # fmt: skip
    hit = one.contacts[0].replace(at=0)
    whole = Scene(
        movers={**one.movers, "Third": wall}, contacts=[hit, again], shared=one.shared
    ).replace({name: found[name].mean for name in UNKNOWN})
    # As of a model that is a function, of which nothing says that it was not this scene.
    of_function = replace(found, _scene=None)
    page = col.report([of_function, whole.run()], form="markdown", figures=False)
    assert "delta-V of the Seat, impact 2" in box(page)
    assert "\n## 2. Impact 1 of A (Rover) and B (Seat), at 0.00 s\n" in page
    assert "\n## 3. Impact 2 of A (Seat) and B (Third), at " in page
    assert re.search(r"\| A \(Seat\) \| velocity along x \| [\d.]+ mph, from the run \|", page)
    assert "the same in every case" not in page


@pytest.mark.slow
def test_the_run_may_stand_first_and_other_results_beside_both(found, run):
    """The marks name the part that the posterior is, and every result has its part."""
    page = col.report([run, found], form="markdown", figures=False, derivation=True)
    assert "mph, mean of part 2 |" in page
    assert "\n## 2. What the evidence says\n" in page
    other = col.linear_central(col.Vehicle(mass=1500.0, vx=9.0), col.Vehicle(mass=1500.0), 0.2)
    page = col.report([found, run, other], form="markdown", figures=False)
    assert "\n## 3. Impact of A and B\n" in page
    assert "- **A: delta-V:** " in box(page)


@pytest.mark.slow
def test_a_speed_with_its_course_marks_both_parts_of_the_velocity():
    """Of a vehicle whose speed was found, along 10 degrees, and the normal of its contact."""
    start = scene().replace({"Rover.course": "10 deg"})
    unknown = {"Rover.speed": Uniform("20 mph", "40 mph"),
               "contacts[0].normal": Uniform("-5 deg", "5 deg")}  # fmt: skip
    seen = {"Seat.rest.x": ("15 ft", "1 ft"), "Seat.rest.y": ("0 ft", "0.3 ft")}
    with warnings.catch_warnings():
        # The readings say little of the normal.
        warnings.simplefilter("ignore", col.IllConditionedWarning)
        some = reconstruct.posterior(start, unknown, seen, samples=512, seed=1)
    middle = start.replace({name: some[name].mean for name in unknown}).run()
    page = col.report([some, middle], form="markdown", units="us", figures=False)
    for along in "xy":
        assert re.search(rf"\| velocity along {along} \| [\d.]+ mph, mean of part 1 \|", page)
    assert re.search(r"normal, direction from A into B \| -?[\d.]+°, mean of part 1 \|", page)


def test_unknowns_and_readings_of_the_scene_stand_in_words(found, run):
    """No path of the scene is left above the record; a name of the reader's own stays."""
    page = col.report([found, run], form="markdown", title="Seat belt")
    said = page[: page.index("## Record")]
    assert not re.search(r"contacts|impacts|\.rest|\.vx", said)
    assert "| restitution of the contact of Rover and Seat | 0 to 0.3, all values" in said
    assert "| position x of Seat at rest | 15.3 ft | 1 ft |" in said
    assert "| the speed | 10 to 60 mph, all values" in said
    # Without the run nobody can say what a path is of.
    alone = col.report(found, form="markdown")
    assert "Seat.rest.x" in alone


def test_what_an_instant_leaves_out_stands_beside_the_ranges(found, run):
    """By the figures of ``left_out``, for the vehicle that it is more for."""
    said = box(col.report([found, run], form="markdown"))
    estimate = col.left_out(run.impacts[0], duration="0.1 s")
    share = max(estimate.a.tyre_share, estimate.b.tyre_share)
    what = "Impact 1 was found as an instant: of delta-V that leaves out about"
    assert f"{what} {100.0 * share:.0f} percent for tyres" in said
    assert "taken for this estimate" in said


def leaning() -> Scene:
    """A lorry that is braked less strikes a car in line and leans on it until both rest; named by
    letters, the other way round than in the contact.
    """
    movers = {
        name: Mover(
            col.Vehicle(mass=mass, yaw_inertia=2500, x=x, y=0.0, heading=0.0, vx=vx),
            outline=(4.5, 1.8),
            drag=drag,
        )
        for name, mass, x, vx, drag in (("A", 1200, 0.0, 0.0, 0.8), ("B", 9000, -4.6, 12.0, 0.1))
    }
    hit = Contact("B", "A", restitution=0.0, friction=0.5, normal=0.0, point=(-2.25, 0), at="touch")
    return Scene(movers=movers, contacts=[hit])


@pytest.mark.slow
def test_what_was_warned_of_the_samples_stands_in_the_answer():
    """How many samples are followed through each other, beside what the run itself shows; on the
    page of the posterior alone it follows the answer.
    """
    prior = {"B.vx": Uniform("8 m/s", "16 m/s")}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        samples = reconstruct.posterior(
            leaning(), prior, {"A.rest.x": ("9 m", "1 m")}, samples=512, seed=1
        )
        spread = propagate(leaning(), prior, outputs=["A.rest.x"], samples=64, seed=1)
    run = leaning().replace({"B.vx": samples["B.vx"].mean}).run()
    (counted,) = [one for one in samples.statements if " of 512 cases" in one]
    pages = [
        (col.report([samples, run], form="markdown"), f"- **driven through:** {counted}"),
        (
            col.report(run, uncertainty=spread, form="markdown"),
            "- **driven through:** 64 of 64 cases",
        ),
    ]
    for page, told in pages:
        # Markdown has a backslash before each bracket.
        assert told in box(page).replace("\\", "")
        (notice,) = run.findings
        assert notice.sentence in box(page)
        assert "- **delta-V of A" in box(page)
        assert "delta-V of the A" not in page
    alone = col.report(samples, form="markdown")
    assert alone[: alone.index("## Record")].replace("\\", "").count(counted) == 1


@pytest.mark.slow
def test_findings_of_an_impact_in_the_answer_say_which(found, run):
    page = col.report([found, run], form="markdown", limits={"tyre_impulse": 0.0})
    told = re.findall(r"- \*\*tyre impulse:\*\* (.*)", box(page))
    assert told
    assert all(one.startswith("Impact 1, Rover and Seat at 0.00 s: ") for one in told)
