"""Case files of whole crashes give what the same scene in Python gives; what is wrong is a line
with the key and the cure.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.__main__ import main
from collisions.cases.answers import answers
from collisions.cases.crash import OF_MOVER, OF_SCENE
from collisions.cases.crash_answers import found_run, run_at
from collisions.cases.read import CaseError, parameters, read, read_text
from collisions.cases.schema import case_schema
from collisions.reporting import replay
from collisions.scene import Contact, Mover, Run, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform, propagate

CASES = Path(str(col.__file__)).parent / "cases"
ROW = """\
[[mover]]
name = "A"
mass = "1500 kg"
speed = "50 km/h"
course = "0 deg"
heading = 0
x = "-6 m"
y = 0
outline = ["4.2 m", "1.8 m"]
drag = 0.7

[[mover]]
name = "B"
mass = "1200 kg"
heading = 0
x = "0 m"
y = 0
outline = ["4 m", "1.7 m"]
drag = 0.7

[[contact]]
a = "A"
b = "B"
at = "touch"
restitution = 0.1
normal = 0
model = "linear_central"
"""


def row() -> Scene:
    """The same in Python."""
    a = col.Vehicle.from_speed(mass="1500 kg", speed="50 km/h", course=0, heading=0, x="-6 m", y=0)
    b = col.Vehicle(mass="1200 kg", heading=0, x="0 m", y=0)
    hit = Contact("A", "B", at="touch", restitution=0.1, normal=0, model="linear_central")
    return Scene(
        movers={
            "A": Mover(a, outline=("4.2 m", "1.8 m"), drag=0.7),
            "B": Mover(b, outline=("4 m", "1.7 m"), drag=0.7),
        },
        contacts=[hit],
    )


def solved(text: str) -> Any:
    (found,) = answers(read_text(text.encode())).results
    return found


def problems(text: str) -> list[str]:
    with pytest.raises(CaseError) as caught:
        answers(read_text(text.encode()))
    return [f"{key}: {said}" for key, said in caught.value.problems]


def test_a_file_gives_what_the_scene_gives() -> None:
    run = solved(ROW)
    assert run == row().run()
    assert run.rest["B"].x == row().run().rest["B"].x


@pytest.mark.slow
def test_every_part_of_a_scene_has_its_table() -> None:
    tyres = "[mover.tyres]\nfriction = 0.8\nlock = [1, 1, 0, 0]\nwheelbase = 2.6\ntrack = 1.5\n"
    text = ROW.replace("drag = 0.7\n", tyres).replace("heading = 0\n", "heading = 0\nname = ''\n")
    text = text.replace("name = ''\n", "yaw_inertia = 2000\n")
    text += (
        "[contact.tyres_after.B]\nfriction = 0.8\nlock = 1\nwheelbase = 2.6\ntrack = 1.5\n"
        '[[surface]]\ncorners = [["30 m", -5], [40, -5], [40, 5]]\nfriction = 0.3\n'
        '[scene]\nslope = ["1 %", 0]\ntolerance = 1e-4\norder = [["A", "B"], ["A", "B"]]\n'
        'shared = { ground = ["A.tyres.friction", "B.tyres.friction"] }\n'
    )
    run = solved(text)
    whole, wheels = row(), Tyres(0.8, [1, 1, 0, 0], 2.6, 1.5)
    scene = Scene(
        movers={
            name: Mover(
                mover.vehicle.replace(yaw_inertia=2000), outline=mover.outline, tyres=wheels
            )
            for name, mover in whole.movers.items()
        },
        contacts=[whole.contacts[0].replace(tyres_after={"B": Tyres(0.8, 1, 2.6, 1.5)})],
        surfaces=[([("30 m", -5), (40, -5), (40, 5)], 0.3)],
        slope=("1 %", 0),
        order=[("A", "B"), ("A", "B")],
        shared={"ground": ("A.tyres.friction", "B.tyres.friction")},
    )
    assert run == scene.run(tolerance=1e-4)


@pytest.mark.slow
def test_uncertain_numbers_have_the_paths_of_the_scene() -> None:
    """As ``propagate`` takes them; those that are shared are one."""
    text = ROW.replace('"50 km/h"', '"50 km/h +/- 3 km/h"').replace(
        "drag = 0.7", 'drag = "0.6 .. 0.8"'
    )
    text = text.replace("restitution = 0.1", 'restitution = "0.05 .. 0.2"')
    text += (
        '[scene.shared]\nroad = ["A.drag", "B.drag"]\n[propagate]\nsamples = 64\n'
        'outputs = ["B.rest.x", "impacts[0].b.delta_v"]\n'
    )
    found = answers(read_text(text.encode()))
    assert list(found.case.uncertain) == ["A.speed", "contacts[0].restitution", "road"]
    scene = row()
    scene = Scene(
        movers=scene.movers, contacts=scene.contacts, shared={"road": ("A.drag", "B.drag")}
    )
    inputs = {
        "A.speed": Normal("50 km/h", "3 km/h"),
        "contacts[0].restitution": Uniform(0.05, 0.2),
        "road": Uniform(0.6, 0.8),
    }
    names = ["B.rest.x", "impacts[0].b.delta_v"]
    wanted = propagate(scene, inputs, outputs=names, samples=64, seed=0)
    for name in names:
        assert found.propagation[name].mean == pytest.approx(wanted[name].mean, rel=1e-12)
    page = found.report("markdown")
    assert replay(page) == run_at(found.case, {})
    assert "road | 0.6 to 0.8" in page
    assert "speed of A at the start: Stated as 50 ± 3 km/h." in page
    assert re.search(r"position x of B at rest:\*\* [\d.]+ to [\d.]+ m \(95 %\)", page)


@pytest.mark.slow
def test_an_area_and_a_slope_that_are_not_known_exactly() -> None:
    text = ROW + (
        '[[surface]]\ncorners = [[2, -5], [9, -5], [9, 5]]\nfriction = "0.2 .. 0.4"\n'
        '[scene]\nslope = ["1 % .. 2 %", 0]\n'
    )
    assert list(read_text(text.encode()).uncertain) == ["surfaces[0]", "slope[0]"]
    page = answers(read_text((text + "[propagate]\nsamples = 64\n").encode())).report("markdown")
    notes = page[page.index("## Notes") : page.index("## Figures")]
    assert "\nfriction of surface 1: Stated as 0.2 to 0.4" in notes
    assert "\nslope of the ground along x, y: Stated of both, in order: 1 to 2 %" in notes


@pytest.mark.slow
def test_without_outputs_delta_v_and_places_of_rest_are_asked_for() -> None:
    text = ROW.replace("restitution = 0.1", 'restitution = "0.05 .. 0.2"')
    found = answers(read_text((text + "[propagate]\nsamples = 64\n").encode()))
    assert list(found.propagation.outputs) == [
        "impacts[0].a.delta_v",
        "impacts[0].b.delta_v",
        "A.rest.x",
        "A.rest.y",
        "B.rest.x",
        "B.rest.y",
    ]


OBSERVED = '[observed]\n"A.rest.x" = "-0.11 m +/- 0.3 m"\n"B.rest.x" = "8.15 m +/- 0.3 m"\n'
SOUGHT = ROW.replace('"50 km/h"', '"10 mph .. 90 mph"').replace("= 0.1", '= "0.05 .. 0.3"')


@pytest.mark.slow
def test_points_of_a_mark_are_observed_by_their_paths() -> None:
    """A car that skids straight on, whose front left wheel is 0.75 m from its middle."""
    tyres = "[mover.tyres]\nfriction = 0.7\nlock = 1\nwheelbase = 2.6\ntrack = 1.5\n"
    skid = ROW[: ROW.index("[[mover]]", 1)].replace("drag = 0.7\n", tyres)
    skid = skid.replace("heading = 0\n", "heading = 0\nyaw_inertia = 2000\n")
    text = skid.replace('"50 km/h"', '"40 km/h +/- 10 km/h"') + (
        '[fit]\n[observed]\n"A.marks.front_left.distance(3 m, 0.8 m)" = "0 m +/- 0.1 m"\n'
        '"A.marks.front_left.end.x" = "9.35 m +/- 0.1 m"\n'
    )
    found = solved(text)
    way = 9.35 + 6.0 - 1.3
    assert found["A.speed"].value == pytest.approx(
        (2.0 * 0.7 * col.travel.GRAVITY * way) ** 0.5, rel=1e-3
    )
    wrong = text.replace("front_left.end", "left.end")
    assert "no wheel 'left'; write one of front_left" in problems(wrong)[0]


@pytest.mark.slow
def test_what_was_observed_leads_back_by_fit_or_posterior() -> None:
    fit = answers(read_text((SOUGHT + OBSERVED + "[fit]\n").encode()))
    (found,) = fit.results
    run, which = found_run(fit.case, found)
    assert "fit" in which
    assert run.rest["A"].x == pytest.approx(-0.11, abs=0.02)
    assert run.rest["B"].x == pytest.approx(8.15, abs=0.02)
    many = answers(read_text((SOUGHT + OBSERVED + "[posterior]\nsamples = 512\n").encode()))
    (after,) = many.results
    assert abs(after["A.speed"].mean - found["A.speed"].value) < 2.0 * after["A.speed"].std
    run, which = found_run(many.case, after)
    assert "nearest to the medians" in which
    assert np.isclose(after.draws["A.speed"], run.scene.movers["A"].vehicle.vx).any()
    assert "The case is a scene, with A.course = '0 deg', A.mass = '1500 kg'" in many.report(
        "markdown"
    )


@pytest.mark.slow
def test_the_same_table_of_observations_holds_for_one_impact() -> None:
    text = (
        '[a]\nmass = 1500\nvx = "10 m/s .. 20 m/s"\n[b]\nmass = 1200\n[linear_central]\n'
        'restitution = 0.1\n[fit]\n[observed]\n"b.delta_v" = "9 m/s +/- 0.3 m/s"\n'
    )
    inside = text.replace("[observed]", "[fit.observed]")
    assert solved(text)["a.vx"].value == solved(inside)["a.vx"].value
    assert problems(inside + "[observed]\n") == [
        "observed: stands beside [fit.observed]; leave out one of these tables",
    ]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("speed = ", "spede = ", "A.spede: is not known here; did you mean speed?"),
        ('mass = "1200 kg"\n', "", "B.mass: is missing; give it: Mass"),
        ('name = "B"\n', "", "mover[1].name: is missing; give the vehicle a name of its own"),
        ('name = "B"', "name = 2", "mover[1].name: must be a text in quotes, got 2"),
        ('name = "B"', 'name = "A"', "mover[1].name: is 'A', as that of another mover"),
        ('b = "B"', 'b = "C"', "contacts[0].b: contacts[0] names 'C', and the movers are A, B"),
        ("restitution = 0.1\n", "", "contacts[0].restitution: is missing; give it: Coefficient"),
        ("restitution = 0.1", "restitution = 1.2", "contacts[0].restitution: must be"),
        ('"linear_central"', '"linear"', "contacts[0].model: must be one of"),
        ("drag = 0.7", "drag = -1", "A.drag: must be >= 0"),
        ("drag = 0.7", "tyres = 1", "A.tyres: must be a table of arguments, got 1"),
        ("drag = 0.7", "pivot = [0, 0]", "A.pivot: is not known here"),
        ("[[contact]]", "[contact]", "contact: must be tables, one for each"),
        ("[[contact]]", "tyres_after = 1\n[[contact]]", "B.tyres_after: is not known here"),
        ("restitution = 0.1", "restitution = 0.1\ntyres_after = 1", "contacts[0].tyres_after"),
        ('x = "-6 m"', 'x = "-3 m"', 'write [[contact]] with a = "A", b = "B" at 0'),
        ("outline = [", "# [", "give outline = [length, width] to its [[mover]]"),
        ('"50 km/h"', '"5 km/h"', "scene: contacts[0] does not come: A and B are"),
        ("[[contact]]", "[eccentric]\n[[contact]]", "eccentric: stands beside [[mover]]"),
        ("[[contact]]", "[[surface]]\nfriction = 1\n[[contact]]", "surfaces[0].corners: is"),
        ("[[contact]]", "[scene]\nslop = 1\n[[contact]]", "scene.slop: is not known here; did you"),
        ("[[contact]]", "[scene]\nslope = 1\n[[contact]]", "scene.slope: takes two numbers"),
        ("[[contact]]", "[observed]\n[[contact]]", "posterior: has nothing to find"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_a_line_with_the_key_and_the_cure(old: str, new: str, said: str) -> None:
    assert old in ROW
    found = problems(ROW.replace(old, new, 1))
    assert any(said in line for line in found), found


def test_what_a_scene_shares_is_stated_alike() -> None:
    text = ROW.replace("drag = 0.7", 'drag = "0.6 .. 0.8"', 1)
    (line,) = problems(text + '[scene.shared]\nroad = ["A.drag", "B.drag"]\n')
    assert line.startswith("scene.shared.road: says that A.drag, B.drag are one and the same")
    assert "write the same text at each" in line
    assert "(nothing uncertain of B.drag)" in line


def test_a_shared_name_that_is_a_path_is_refused() -> None:
    (line,) = problems(ROW + '[scene.shared]\n"A.vx" = ["A.drag", "B.drag"]\n')
    assert "shared has the name 'A.vx', which is taken" in line


def test_a_surface_whose_sides_cross_is_refused() -> None:
    corners = "[[3, -9], [23, 9], [23, -9], [3, 9]]"
    (line,) = problems(ROW + f"[[surface]]\ncorners = {corners}\nfriction = 0.3\n")
    assert "surfaces[0] has sides that cross, from corner 0 to 1 and from 2 to 3" in line
    assert "(20" not in line


@pytest.mark.parametrize(
    ("table", "key"),
    [('[propagate]\noutputs = ["B.rest.z"]\n', "propagate.outputs"),
     ('[observed]\n"B.rest.z" = "4 m +/- 1 m"\n', "posterior.observed")],
)  # fmt: skip
def test_a_result_that_is_none_is_named_with_the_nearest(table: str, key: str) -> None:
    (line,) = problems(SOUGHT + table)
    assert line.startswith(f"{key}: the scene has no 'B.rest.z'; near it are B.rest.")


@pytest.mark.slow
def test_an_impact_by_its_number_is_that_of_the_file_as_written() -> None:
    """Three cars in a row: below 18 m/s the rear one comes second."""
    movers = "".join(
        f'[[mover]]\nname = "{name}"\nmass = "{mass} kg"\nvx = {vx}\nheading = 0\nx = {x}\ny = 0\n'
        'outline = ["4.4 m", "1.8 m"]\n'
        for name, mass, vx, x in (
            ("rear", 1500, '"13 m/s .. 25 m/s"', -11.8),
            ("middle", 1200, 9.0, -5.9),
            ("front", 1400, 0.0, 0.0),
        )
    )
    hits = "".join(
        f'[[contact]]\na = "{a}"\nb = "{b}"\nat = "touch"\nrestitution = 0.2\nnormal = 0\n'
        'model = "linear_central"\n'
        for a, b in (("rear", "middle"), ("middle", "front"))
    )
    study = '[propagate]\nsamples = 64\noutputs = ["{}"]\n'
    found = answers(read_text((movers + hits + study.format("impacts[0].b.delta_v")).encode()))
    assert "another than that of rear and middle" in " ".join(found.propagation.statements)
    assert found.propagation.failed == pytest.approx(64 * 5 / 12, abs=1)
    # Of the middle car, struck by one that is 9 m/s faster or more.
    least = (1.0 + 0.2) * 1500 / 2700 * 9.0
    assert found.propagation["impacts[0].b.delta_v"].quantile(0.0) > least
    path = "contacts[1].impact.front.delta_v"
    found = answers(read_text((movers + hits + study.format(path)).encode()))
    assert found.propagation.failed == 0


@pytest.mark.slow
def test_the_command_plays_a_scene(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, page = tmp_path / "crash.toml", tmp_path / "crash.html"
    file.write_text(ROW, encoding="utf-8")
    assert main([str(file), "--play", str(page), "--units", "us"]) == 0
    assert page.read_text(encoding="utf-8") == col.play(row().run(), units="us")
    assert "Places of rest" in capsys.readouterr().out
    file.write_text(SOUGHT + OBSERVED + "[fit]\n", encoding="utf-8")
    assert main([str(file), "--play", str(page)]) == 0
    assert "the page plays the scene of the values of the fit" in capsys.readouterr().err
    file.write_text("[a]\nmass = 1\nvx = 1\n[b]\nmass = 1\n[linear_central]\nrestitution = 0\n")
    assert main([str(file), "--play", str(page)]) == 2
    assert "play: plays a scene, and this file is of one impact" in capsys.readouterr().err
    assert main([str(file), "--scene"]) == 2
    assert "--scene goes with 'new'" in capsys.readouterr().err


@pytest.mark.slow
def test_json_of_a_scene_is_the_record_of_its_report(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "crash.toml"
    file.write_text(ROW, encoding="utf-8")
    assert main([str(file), "--json"]) == 0
    (result,) = json.loads(capsys.readouterr().out)["results"]
    assert Run.from_dict(result["run"]) == row().run()


def test_a_scene_without_headings_cannot_be_played() -> None:
    """The refusal speaks of the file, not of Python."""
    without = re.sub(r"(?m)^(heading|outline|at) = .*\n", "", ROW)
    found = answers(read_text(without.encode()))
    with pytest.raises(CaseError) as refused:
        found.play()
    ((key, text),) = refused.value.problems
    assert key == "play"
    assert re.fullmatch(
        r"a picture needs heading of \w+; write what is missing into its table", text
    )


@pytest.mark.slow
def test_the_example_of_places_of_rest_has_the_speed_of_a_slide() -> None:
    """By hand: both slid at the same drag, so momentum gives the speed before."""
    path = Path(__file__).parents[2] / "examples" / "cases" / "rest_positions.toml"
    (found,) = answers(read(path)).results
    after = [np.sqrt(2.0 * 0.65 * 9.80665 * slid) for slid in (1.9 + 2.4, 10.6 - 2.25)]
    by_hand = after[0] + 1250 / 1550 * after[1]
    assert found["Camry.speed"].mean == pytest.approx(by_hand, abs=0.25)
    low, high = found["Camry.speed"].interval()
    assert low < by_hand < high
    assert found.consistent


@pytest.mark.slow
def test_new_prints_a_scene_that_runs(capsys: pytest.CaptureFixture[str]) -> None:
    """In all units, with the same keys, without a finding that something is not described."""
    jsonschema = pytest.importorskip("jsonschema")
    import tomllib

    check = jsonschema.Draft7Validator(case_schema())
    texts = {}
    for units in ("metric", "si", "us"):
        assert main(["new", "--scene", "--units", units]) == 0
        texts[units] = text = capsys.readouterr().out
        assert not list(check.iter_errors(tomllib.loads(text)))
        assert max(map(len, text.splitlines())) < 80
        found = answers(read_text(text.replace("samples = 512", "samples = 64").encode()))
        assert found.case.report["units"] == units
        assert found.warnings == []
        assert found.results[0].findings == ()
        assert len(found.results[0].impacts) >= 2
    assert not re.search(r"\d (km/h|kg|m)\b", texts["us"])
    keys = [
        [line.partition(" =")[0] for line in text.splitlines() if line[:1] != "#"]
        for text in texts.values()
    ]
    assert keys[0] == keys[1] == keys[2]


def test_the_schema_has_the_arguments_of_each_table() -> None:
    jsonschema = pytest.importorskip("jsonschema")
    import tomllib

    schema = case_schema()
    check = jsonschema.Draft7Validator(schema)
    assert not list(check.iter_errors(tomllib.loads(SOUGHT + OBSERVED)))
    for wrong in (
        ROW.replace("drag", "dragg"),
        ROW.replace("normal", "norm"),
        ROW + "[scene]\na=1",
    ):
        assert list(check.iter_errors(tomllib.loads(wrong)))
    tables = schema["properties"]
    keys = {name: set(tables[name]["items"]["properties"]) for name in ("mover", "contact")}
    assert keys["contact"] == set(parameters(Contact))
    assert set(OF_MOVER) <= keys["mover"]
    assert keys["mover"] - set(OF_MOVER) == {*parameters(col.Vehicle.from_speed), "vx", "vy"} - {
        "pivot", "name",
    }  # fmt: skip
    assert set(tables["scene"]["properties"]) == set(OF_SCENE)


@pytest.mark.slow
def test_a_refusal_within_another_is_in_the_words_of_the_file() -> None:
    """The reason that the scene gives stands in that of the posterior."""
    text = ROW.replace('at = "touch"\n', "at = 0\n").replace('"50 km/h"', '"40 km/h .. 60 km/h"')
    text += '\n[observed]\n"B.rest.x" = "5 m +/- 1 m"\n[posterior]\nsamples = 512\n'
    with pytest.raises(CaseError) as refused:
        answers(read_text(text.encode()))
    ((_, said),) = refused.value.problems
    assert "are 1.9 m apart at 0 s" in said
    assert "write at = 'touch'" in said


@pytest.mark.parametrize(
    ("key", "line", "needs"),
    [
        ("A.mass", 'mass = "1500 kg"', "kg"),
        ("A.x", 'x = "-6 m"', "m"),
        ("A.heading", "heading = 0", "rad"),
        ("A.drag", "drag = 0.7", "a plain number"),
    ],
)
@pytest.mark.parametrize("distance", ['"12 m"', '"12 m .. 13 m"'])
@pytest.mark.parametrize("study", ["", "[propagate]\nsamples = 512\n", "[posterior]\nseed = 1\n"])
def test_a_function_of_another_kind_is_refused(
    key: str, line: str, needs: str, distance: str, study: str
) -> None:
    """A speed is neither a mass nor a place, whatever is asked."""
    name = line.partition(" = ")[0]
    speed = f"{name} = {{ travel.speed = {{ distance = {distance}, drag = 0.7 }} }}"
    text = ROW.replace(line, speed, 1)
    if study:
        text = text.replace('mass = "1200 kg"', 'mass = "1100 kg .. 1300 kg"') + study
    if "posterior" in study:
        text += '[observed]\n"B.rest.x" = "8 m +/- 1 m"\n'
    (found,) = problems(text)
    assert found.startswith(f"{key}: ")
    assert f"worked out by travel.speed, which gives m/s, and cannot be taken as {needs}" in found
