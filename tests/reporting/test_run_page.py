"""The report of a whole scene: its numbers are those of the run, and it can be made again from its
record.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from html import unescape
from typing import Any

import pytest

import collisions as col
from collisions.reporting import options, replay
from collisions.reporting.scene_words import input_in_words, result_in_words
from collisions.reporting.words import Names
from collisions.scene import Contact, Mover, Run, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform, propagate
from crashes import NAMES, coasting, three_cars

FOOT, MPH = 0.3048, 0.44704


@pytest.mark.slow
def test_the_answer_comes_first_with_the_numbers_of_the_run() -> None:
    run = three_cars()
    page = col.report(run, form="markdown", units="us")
    answer = page[: page.index("## Vehicles and ground")]
    assert page.startswith("# The crash of Camry, Civic, Truck\n\n## Answer\n")
    assert "**Camry at the start:** 40.0 mph" in answer
    assert "**Truck at the start:** standing" in answer
    for number, (impact, pair) in enumerate(zip(run.impacts, run.pairs, strict=True), 1):
        for side, name in zip((impact.a, impact.b), pair, strict=True):
            (found,) = re.findall(
                rf"delta-V of {name}, impact {number} \S+ s.?\):\*\* ([\d.]+) mph", answer
            )
            assert float(found) == pytest.approx(side.delta_v / MPH, abs=0.0501)
    for name in NAMES:
        x, y = re.search(
            rf"{name} at rest, x and y:\*\* (-?[\d.]+) ft, (-?[\d.]+) ft", answer
        ).groups()
        assert float(x) == pytest.approx(run.rest[name].x / FOOT, abs=0.00501)
        assert float(y) == pytest.approx(run.rest[name].y / FOOT, abs=0.00501)
    assert "No range is stated" in answer


@pytest.mark.slow
def test_each_impact_the_ledger_and_the_findings_have_their_parts() -> None:
    run = three_cars()
    page = col.report(run, form="markdown", units="us")
    headings = re.findall(r"^#+ (.*)$", page, flags=re.MULTILINE)
    order = [
        "Impact 1: Camry and Civic at 0.00 s",
        "Impact 2: Civic and Truck at 0.70 s",
        "Impact 3: Camry and Civic at 0.93 s",
        "Places of rest",
        "Where the kinetic energy went",
        "Findings",
        "Record",
    ]
    assert [one for one in headings if one in order] == order
    assert page.count("## Results") == 3
    for finding in col.diagnose(run, units="us"):
        assert finding.sentence.split(": ", 1)[1][:30] in page
    for area in ("| surface 1 | friction | 0.3 |", "| Camry | outline | 15.75 ft by 5.906 ft |"):
        assert area in page


@pytest.mark.slow
def test_every_vehicle_has_its_state_at_the_start() -> None:
    """In the units of the page, and as it was given where that is another."""
    run = three_cars()
    page = col.report(run, form="markdown", units="us")
    start = page[page.index("## At the start") : page.index("## Vehicles and ground")]
    for name, mover in run.scene.movers.items():
        body = mover.vehicle
        for what, value, unit in (
            ("position x of the centre of mass", body.x / FOOT, " ft"),
            ("position y of the centre of mass", body.y / FOOT, " ft"),
            ("heading", math.degrees(body.heading), "°"),
            ("speed", body.speed / MPH, " mph"),
            ("yaw rate", math.degrees(body.yaw_rate), "°/s"),
        ):
            found = re.search(rf"\| {name} \| {what} \| (-?[\d.]+){unit}", start)
            assert float(found[1]) == pytest.approx(value, rel=1e-3, abs=1e-3), (name, what)
    assert "| Truck | course | none: it stands |" in start
    assert "| Camry | course | 0° |" in start
    bare = col.report(coasting(), form="markdown", figures=False)
    assert "| B | course | none: it stands |" in bare


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.OutOfRangeWarning")
def test_ranges_stand_under_words_and_not_under_paths() -> None:
    run = three_cars()
    inputs = {
        "Camry.vx": Normal("40 mph", "1 mph"),
        "contacts[0].friction": Uniform(0.45, 0.55),
        "Civic.tyres.friction": Normal(0.7, 0.02),
    }
    outputs = ["impacts[0].a.delta_v", "times[0]", "Camry.marks.front_left.end.x"]
    spread = propagate(run.scene, inputs, outputs=outputs, samples=64, seed=1)
    page = col.report(run, uncertainty=spread, form="markdown", figures=False)
    # A finding advises to observe a path.
    lines = page[: page.index("## Record")].splitlines()
    said = "\n".join(line for line in lines if "do not part right after their" not in line)
    assert not re.search(r"contacts\\?\[|impacts\\?\[|times\\?\[|\.vx|tyres\.|marks\.", said)
    assert "**delta-V of Camry, impact 1 (0.00 s):**" in said
    assert said.count("**delta-V of Camry, impact 1") == 1
    assert "| Inputs as stated | velocity along x of Camry at the start | 40 ± 1 mph |" in said
    assert "variance from friction of the contact of Camry and Civic at 0.00 s |" in said
    assert "x of the end of the mark of the front left wheel of Camry" in said
    assert "named after the vehicles that they have in the run of this report" in said


def test_every_path_of_a_scene_has_words() -> None:
    """That no part of the path is left in; those of one scene are all different."""
    scene = three_cars().scene
    after = {"Civic": Tyres(0.7, [1, 1, 0, 0], 2.6, 1.5, height=0.5)}
    hit = Contact(
        "Camry", "Truck", restitution=0.1, impulse_ratio=0.2, depth=0.1, at="touch", duration=0.1,
        model="eccentric",
    )  # fmt: skip
    scene = Scene(
        movers={
            **scene.movers,
            "Van": Mover(col.Vehicle(mass=1.0, x=90, y=0, heading=0, vx=1), drag=0.5),
        },
        contacts=[*scene.contacts, hit, scene.contacts[0].replace(at=9.0, tyres_after=after)],
        surfaces=list(scene.surfaces),
        slope=(0.0, 0.01),
    )
    run = three_cars()
    inputs = {path: input_in_words(scene, path) for path in scene.inputs()}
    results = {path: result_in_words(run, path) for path in run.scene.results()}
    for found in (inputs, results):
        assert len(set(found.values())) == len(found)
        for path, words in found.items():
            assert not re.search(r"[\[\]_]|\w\.[a-z]", words), path
    assert inputs["contacts[0].restitution"].startswith("restitution of the contact of Camry and")
    assert results["impacts[1].b.after.speed"] == "speed of Truck after, impact 2 (0.70 s)"
    assert result_in_words(run, "impacts[7].a.delta_v") == "delta-V of A, impact 8"
    assert result_in_words(run, "anything") == "anything"
    first = "the first impact in the contact of Civic and Truck"
    for path, words in {
        "contacts[1].impact.Truck.delta_v": f"delta-V of Truck, {first}",
        "contacts[1].impact.closing_speed": f"closing speed of {first}",
        "contacts[1].impact.Civic.ees(0.4)": f"EES of Civic with 0.4 of the energy lost, {first}",
        "end - contacts[1].impact.time": f"time between {first} and the moment at which all rest",
    }.items():
        assert result_in_words(run, path) == words


@pytest.mark.slow
def test_the_page_can_be_made_again_from_its_record() -> None:
    run = three_cars()
    given = {"author": "J. Doe", "case": "2026-11", "derivation": True, "notes": ["Seen <b>."]}
    page = col.report(run, **given)
    assert replay(page) == run
    assert options(page) == {**given, "units": "us"}
    assert col.report(replay(page), **options(page)) == page
    assert page.count("<svg") == 2
    assert "<b>" not in page
    assert "Seen &lt;b&gt;." in page
    assert not re.search(r'(src|href)="(?!#)', page)


@pytest.mark.slow
def test_a_record_that_was_changed_is_refused() -> None:
    run = coasting()
    page = col.report(run, form="markdown", figures=False)
    assert replay(page) == run
    record = json.loads(page[page.index("```json\n") + 8 : page.rindex("```")])
    columns = record["run"]["columns"]
    name = next(one for one in columns if one.endswith("delta_v"))
    columns[name] = [2.0 * value for value in columns[name]]
    head = page[: page.index("```json\n") + 8]
    changed = f"{head}{json.dumps(record)}\n```\n"
    with pytest.raises(col.InputError, match="its inputs do not give its"):
        replay(changed)


def leaves(part: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], Any]]:
    """The values of a record with the way to each."""
    if isinstance(part, (dict, list)):
        for key, one in part.items() if isinstance(part, dict) else enumerate(part):
            yield from leaves(one, (*path, key))
    else:
        yield path, part


@pytest.mark.slow
def test_every_number_of_the_impacts_in_a_record_is_held_against_the_scene() -> None:
    """The inputs of an impact, which follow from the scene, as well as what came of it."""
    run = coasting()
    page = col.report(run, form="markdown", figures=False)
    head = page[: page.index("```json\n") + 8]
    record = json.loads(page[len(head) : page.rindex("```")])
    changed = 0
    for path, value in leaves(record["run"]):
        if path[0] in ("scene", "columns", "tolerance") or isinstance(value, (str, bool)):
            continue
        # Rounding of another machine passes, as of a number that is 0 but for rounding.
        if value is None or 0.0 < abs(value) < 1e-5:
            continue
        for other in (2.0 * value or 1.0, value * (1.0 + 1e-4) + 2e-6):
            part = record["run"]
            for key in path[:-1]:
                part = part[key]
            part[path[-1]] = other
            where = re.escape(
                "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in path)[1:]
            )
            with pytest.raises(col.InputError, match=f"its inputs do not give its {where}, "):
                replay(f"{head}{json.dumps(record)}\n```\n")
            part[path[-1]] = value
            changed += 1
    assert changed > 200
    assert replay(f"{head}{json.dumps(record)}\n```\n") == run


@pytest.mark.slow
def test_a_record_without_its_impacts_and_one_with_other_words_of_a_finding_are_refused() -> None:
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-6.0, y=0.3, vx=14.0, heading=0.0)
    b = col.Vehicle(mass=1200.0, yaw_inertia=1900.0, x=0.0, y=0.0, heading="90 deg")
    movers = {
        "A": Mover(a, outline=(4.4, 1.8), drag=0.4),
        "B": Mover(b, outline=(4.2, 1.7), drag=0.7),
    }
    hit = Contact("A", "B", restitution=0.1, friction=0.4, at="touch", depth=9.0)
    run = Scene(movers=movers, contacts=[hit]).run()
    page = col.report(run, form="markdown", figures=False)
    head = page[: page.index("```json\n") + 8]
    record = json.loads(page[len(head) : page.rindex("```")])
    assert record["run"]["findings"]
    finding, version = record["run"]["findings"][0], record["version"]
    said = finding["sentence"]
    for words in ("All is well.", 1.0, None):
        finding["sentence"] = words
        with pytest.raises(col.InputError, match=r"give its findings\[0\]\.sentence, "):
            replay(f"{head}{json.dumps(record)}\n```\n")
    # Another version may word it differently, and a number is no wording.
    record["version"] = "0.1.0"
    with pytest.raises(col.InputError, match=r"give its findings\[0\]\.sentence, "):
        replay(f"{head}{json.dumps(record)}\n```\n")
    finding["sentence"] = "In other words."
    assert replay(f"{head}{json.dumps(record)}\n```\n") == run
    finding["sentence"], record["version"] = said, version
    assert replay(f"{head}{json.dumps(record)}\n```\n") == run
    del record["run"]["impacts"]
    with pytest.raises(col.InputError, match="its inputs do not give its impacts, which is miss"):
        replay(f"{head}{json.dumps(record)}\n```\n")


def test_html_of_what_moves_on_and_has_a_name_like_markup() -> None:
    page = col.report(coasting(), figures=False)
    assert "<A & co>" not in page
    assert "<A & co>" in unescape(page)
    assert "none: nothing slows it" in page
    assert "slowed by" in page


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.OutOfRangeWarning")
def test_options_of_one_impact_are_refused_together() -> None:
    with pytest.raises(col.CollisionsError) as caught:
        col.report(
            three_cars(), outline_a=(4.5, 1.8), share_a=0.5, notes={"a.mass": "Weighed"}, form="pdf"
        )
    text = str(caught.value)
    for part in (
        "outline_a is for one impact",
        "share_a is for one",
        "notes that are texts",
        "form",
    ):
        assert part in text
    many = three_cars().scene.replace({"Camry.vx": [17.0, 18.0]}).run(tolerance=1e-3)
    with pytest.raises(col.ShapeError, match=r"report\(run.case\(0\)\)"):
        col.report(many)


@pytest.mark.slow
def test_a_propagation_of_the_scene_has_its_ranges_in_the_answer() -> None:
    """What was asked for comes first, with its range; the inputs are printed as stated."""
    run = slid()
    inputs = {"A.vx": Normal("12 m/s", "0.5 m/s"), "contacts[0].restitution": Uniform(0.05, 0.2)}
    words = {
        "B.rest.x": "position x of B at rest",
        "impacts[0].b.delta_v": f"delta-V of B, impact 1 ({run.times[0]:.2f} s)",
    }
    names = list(words)
    # B brakes harder than A behind it, which runs into it again where they part slowly.
    with pytest.warns(col.OutOfRangeWarning, match="do not part right after their contact"):
        spread = propagate(run.scene, inputs, outputs=names, samples=64, seed=0)
    page = col.report(run, form="markdown", uncertainty=spread)
    answer = page[: page.index("## Vehicles")]
    for name in names:
        low, high = spread[name].interval()
        found = re.search(rf"{re.escape(words[name])}:\*\* ([\d.]+) to ([\d.]+)", answer)
        assert found is not None
        assert float(found[1]) == pytest.approx(low, abs=0.06)
        assert float(found[2]) == pytest.approx(high, abs=0.06)
    assert answer.count("delta-V of B, impact 1") == 1
    assert "delta-V of A, impact 1" in answer
    assert "No range is stated for the figures above that have only one number." in answer
    part = page[page.index("## Uncertainty") : page.index("## Findings")]
    assert "| Inputs as stated | velocity along x of A at the start | 12 ± 0.5 m/s |" in part
    assert "0.05 to 0.2, all values equally likely |" in part
    assert "64 cases, all with an answer, seed 0" in part
    assert "do not part right after their contact" in part
    assert replay(page) == run
    other = run.scene.replace({"A.vx": 20.0}).run()
    assert "lies outside the 95 percent interval" in col.report(
        other, form="markdown", uncertainty=spread
    )


@pytest.mark.parametrize(
    ("given", "code", "says"),
    [
        ({"uncertainty": 0.1}, "bad_option", "uncertainty must be what uncertainty.propagate"),
        ({"form": "pdf"}, "bad_option", "form must be one of 'html', 'markdown', got 'pdf'"),
        ({"form": 3}, "bad_option", "form must be one of"),
        ({"figures": 1}, "bad_option", "figures must be True or False, got 1"),
        ({"derivation": "yes"}, "bad_option", "derivation must be True or False, got 'yes'"),
        ({"title": ""}, "not_a_text", "title must be a text that says something"),
        ({"author": 7}, "not_a_text", "author must be a text that says something, got 7"),
        ({"notes": ["", "Seen"]}, "not_a_text", "has notes that are texts"),
        ({"outline_a": (4.5, 1.8)}, "bad_option", r"report\(run.impacts\[0\], outline_a=...\)"),
    ],
)
def test_an_option_that_cannot_be_is_refused(given: Any, code: str, says: str) -> None:
    with pytest.raises(col.InputError, match=says) as caught:
        col.report(coasting(), **given)
    assert caught.value.code == code


def slid(**more: Any) -> Run:
    """A car on drag runs into one on tyres, on a slope."""
    a = col.Vehicle(mass=1500, x=-4, y=0, heading=0, vx=12)
    b = col.Vehicle(mass=1000, x=2, y=0, heading=0, yaw_inertia=1500)
    contact = Contact("A", "B", restitution=0.1, normal=0, model="linear_central", at="touch")
    return Scene(
        movers={
            "A": Mover(a, outline=(4.5, 1.8), drag=0.5),
            "B": Mover(b, outline=(4.5, 1.8), tyres=Tyres(0.7, 1.0, 2.7, 1.5)),
        },
        contacts=[contact],
        slope=(0.02, 0.0),
        **more,
    ).run()


@pytest.mark.slow
def test_the_page_has_drag_slope_title_and_who_filed_it() -> None:
    page = col.report(
        slid(),
        form="markdown",
        title="Rear end",
        author="J. Doe",
        case="2026-11",
        notes="Road was wet.",
        derivation=True,
    )
    assert page.startswith("# Rear end\n")
    assert "J. Doe" in page
    assert "2026-11" in page
    assert "## Notes\n\nRoad was wet." in page
    assert "| A | drag factor | 0.5 |" in page
    assert "| ground | slope along x, y | 0.02, 0 |" in page
    assert "## Derivation" in page
    assert "The figures are in the HTML form of this report." in page
    assert "## Figures" not in col.report(slid(), form="markdown", figures=False)


SIDE_ON = {"restitution": 0.1, "friction": 0.5}


def side_on(*, outline: Any = (4.5, 1.8), order: Any = None, **contact: Any) -> Run:
    """A car that strikes another in its side, of which the outline is given."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-6.0, y=0.2, heading=0.0, vx=12.0)
    b = col.Vehicle(mass=1200.0, yaw_inertia=1900.0, x=0.0, y=0.0, heading=1.57)
    movers = {"A": Mover(a, outline=(4.5, 1.8), drag=0.7), "B": Mover(b, outline=outline, drag=0.7)}
    hit = Contact("A", "B", **{"at": "touch", **SIDE_ON, **contact})
    return Scene(movers=movers, contacts=[hit], order=order).run()


def inputs_of(run: Run, units: Any = None) -> dict[str, str]:
    """What the table of contacts says of the only one, and what is said of B."""
    page = col.report(run, form="markdown", units=units, derivation=False, figures=False)
    before = page[page.index("## Vehicles and ground") : page.index("## Impact 1")]
    rows = re.findall(
        r"^\| (?:the contact of A and B|B|order.*?) \| (.+?) \| (.+?) \|$", before, re.M
    )
    return dict(rows)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("contact", "row"),
    [
        ({}, ("the impulse acts after first touch by", "0.03 s, the default")),
        ({"delay": "40 ms"}, ("the impulse acts after first touch by", "0.04 s, given as 40 ms")),
        (
            {"depth": "0.2 m"},
            (
                "the impulse acts at a depth of overlap along the normal of the face struck",
                "0.6562 ft, given as 0.2 m",
            ),
        ),
        (
            {"depth": 0.3048, "normal": 0.0},
            ("the impulse acts at a depth of overlap along the normal", "1 ft"),
        ),
        (
            {"duration": 0.1, "delay": 0.05},
            ("normal and point are taken after first touch by", "0.05 s"),
        ),
        ({"normal": 0.0, "point": (-0.9, 0.2)}, ("the impulse acts", "at first touch")),
        ({"normal": 0.0, "point": (-0.9, 0.2)}, ("point", "given, printed with each impact")),
        ({}, ("when", "whenever the outlines touch")),
        ({"at": "0.5 s"}, ("when", "0.5 s")),
        ({}, ("normal", "that of the face struck at first touch")),
        (
            {"plane": "crossings"},
            ("normal", "across the line through the points where the outlines cross"),
        ),
        ({"normal": 0.0}, ("normal", "given, printed with each impact")),
        ({}, ("point", "the centroid of the overlap of the outlines")),
    ],
)
def test_the_page_says_how_a_contact_is_placed(contact: Any, row: tuple[str, str]) -> None:
    what, text = row
    assert inputs_of(side_on(**contact), "us")[what] == text


@pytest.mark.slow
def test_the_page_has_the_order_that_is_claimed() -> None:
    assert inputs_of(side_on(order=[("A", "B")]))["as claimed"] == "A and B"
    assert "as claimed" not in inputs_of(side_on())


@pytest.mark.parametrize(
    ("outline", "says"),
    [
        ((4.2, 1.7), None),
        ((4.2, 1.7, 0.2), "0.2 m ahead of the middle of the outline"),
        ((4.2, 1.7, -0.25), "0.25 m behind the middle of the outline"),
        (
            [(2.0, 0.75), (-2.2, 0.75), (-2.2, -0.95), (2.0, -0.95)],
            "0.1 m ahead of and 0.1 m to the left of the middle of the outline",
        ),
    ],
)
def test_the_page_says_where_the_centre_of_mass_lies_in_an_outline(outline: Any, says: Any) -> None:
    rows = inputs_of(side_on(outline=outline))
    assert rows["outline"] == "4.2 m by 1.7 m"
    assert rows.get("centre of mass") == says


@pytest.mark.slow
def test_the_page_has_the_corners_of_an_outline_that_is_no_rectangle() -> None:
    rows = inputs_of(
        side_on(outline=[(2.0, 0.0), (1.5, 0.8), (-2.0, 0.8), (-2.0, -0.8), (1.5, -0.8)])
    )
    (corners,) = (text for what, text in rows.items() if what.startswith("corners of the outline"))
    assert corners.startswith("(2 m, 0 m); (1.5 m, 0.8")
    assert corners.count(";") == 4


def test_a_place_that_nothing_gives_is_not_known() -> None:
    movers = {
        name: Mover(col.Vehicle(mass=1000, vx=speed), drag=0.5)
        for name, speed in (("A", 5), ("B", 0))
    }
    contact = Contact("A", "B", restitution=0.1, normal=0, model="linear_central")
    run = Scene(movers=movers, contacts=[contact]).run()
    page = col.report(run, form="markdown", figures=False)
    assert "**A at rest, x and y:** not known" in page
    assert "**B at the start:** standing" in page


@pytest.mark.slow
def test_html_has_both_figures_or_says_how_to_have_them(monkeypatch: pytest.MonkeyPatch) -> None:
    run = slid()
    assert col.report(run).count("<svg") == 2
    monkeypatch.setattr("collisions.reporting.figures.can_draw", lambda: False)
    page = unescape(col.report(run))
    assert "<svg" not in page
    assert "None: matplotlib cannot be imported here. Install it with: python -m pip" in page


@pytest.mark.slow
def test_a_run_among_other_results_is_refused_with_its_own_page() -> None:
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=10.0), col.Vehicle(mass=1200.0), 0.1)
    with pytest.raises(col.InputError, match=r"write report\(run\)"):
        col.report([impact, slid()])


@pytest.mark.parametrize("names", [("van", "car"), ("a", "b")])
def test_inputs_of_a_scene_have_words_whatever_its_movers_are_called(names):
    """Also where they are called as the vehicles of a case file."""
    movers = {
        name: Mover(
            col.Vehicle(mass=1500.0, vx=vx, x=x, y=0.0, heading=0.0), outline=(4.5, 1.8), drag=0.3
        )
        for name, vx, x in zip(names, (9.0, 0.0), (-6.0, 0.0), strict=True)
    }
    hit = Contact(*names, normal=0.0, model="linear_central", at="touch", restitution=0.1)
    words = Names(Scene(movers=movers, contacts=[hit]).run())
    for path in (f"{names[0]}.mass", f"{names[1]}.x", f"{names[0]}.drag"):
        assert words.of_input(path, -1e9, 1e9) != path
        assert words.number_of(path)[0] != ""
