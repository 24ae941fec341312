"""The answer that stands first on a report: its figures, their ranges, what they rest on, and the
words in place of letters.
"""

import html
import math
import re
import warnings

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct, uncertainty
from collisions.diagnostics import diagnose
from collisions.diagnostics.finding import is_note
from collisions.reporting import options, replay, report
from collisions.reporting.mathml import mathml
from collisions.reporting.render import Html, Markdown, Printed
from collisions.reporting.sections import _round_limit
from pages import section
from scenes import IN_POUNDS

A, B = (car.replace(name=name) for car, name in zip(IN_POUNDS, ("Accord", "Civic"), strict=True))
PLACE = {"normal": "0 deg", "point": ("0 ft", "0 ft"), "friction": 0.5}


def crash(va="30 mph", vb="25 mph", e=0.1, mu=0.5):
    place = PLACE | {"friction": mu}
    return col.eccentric(A.replace(vx=va), B.replace(vy=vb, vx="0 mph"), e, **place)


def spread(**changes):
    def model(va, e, course_b):
        impact = crash(va=va, e=e)
        return {"a.delta_v": impact.a.q.delta_v, "share": 0.4 + 0.01 * e + 0.0 * course_b}

    inputs = {
        "va": uncertainty.Normal("30 mph", "2 mph"),
        "e": uncertainty.Uniform(0.0, 0.2),
        "course_b": uncertainty.Normal("90 deg", "1 deg"),
        **changes,
    }
    return uncertainty.propagate(model, inputs, samples=64, seed=1, method="quasi_random")


def found_speeds(**known):
    known = known or {"delta_v_forward_a": crash().a.delta_v_forward, "speed_b": "25 mph"}
    known = {"course_a": "0 deg", "course_b": "90 deg", **known}
    return reconstruct.speeds(A, B, restitution=0.1, **PLACE, **known)[0]


def box(page):
    return page.split("\n## Answer\n")[1].split("\n## ")[0]


@pytest.mark.slow
def test_the_range_of_a_figure_stands_first_with_two_figures_of_its_half_width():
    known = spread()
    text = box(report(crash(), form="markdown", units="us", uncertainty=known))
    low, high = (end / 0.44704 for end in known["a.delta_v"].interval())
    assert 0.5 < (high - low) / 2 < 9.95  # so two figures end at the tenth
    assert f"- **Accord: delta-V:** {low:.1f} to {high:.1f} mph (95 %)\n" in text
    # Other figures have none, and it says so.
    other = crash().b.delta_v / 0.44704
    assert f"- **Civic: delta-V:** {other:.1f} mph\n" in text
    assert "No range is stated for the figures above that have only one number." in text
    assert "No range is stated for these figures" not in text


@pytest.mark.slow
def test_a_range_that_is_open_on_one_side_is_a_range():
    """Nothing asks for what was given."""

    def model(course_b):
        found = found_speeds(
            delta_v_forward_a=crash().a.delta_v_forward,
            delta_v_left_a=crash().a.delta_v_left,
            course_b=course_b,
            slid="bound",
        )
        sides = found.reconstruction.one_sided
        return {
            f"{label}.before.speed": uncertainty.OneSided(
                getattr(found, label).before.speed, sides[f"speed_{label}"]
            )
            for label in "ab"
        }

    inputs = {"course_b": uncertainty.Normal("90 deg", "1 deg")}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        known = uncertainty.propagate(model, inputs, samples=64, seed=1)
        result = found_speeds(
            delta_v_forward_a=crash().a.delta_v_forward,
            delta_v_left_a=crash().a.delta_v_left,
            slid="bound",
        )
    names = ["a.before.speed", "b.before.speed"]
    text = box(report(result, form="markdown", uncertainty=known, answers=names))
    assert "Civic: speed before:** at least" in text
    assert "No range is stated" not in text


def test_a_wide_range_has_no_decimals():
    inputs = {"va": uncertainty.Normal("40 mph", "12 mph")}
    known = uncertainty.propagate(lambda va: {"a.before.speed": va}, inputs, method="first_order")
    half = 1.959963985 * 12.0
    text = box(report(crash(), form="markdown", units="us", uncertainty=known))
    assert f"{40 - half:.0f} to {40 + half:.0f} mph (95 %)" in text


def test_two_figures_are_those_of_the_half_width_and_not_of_the_width():
    """Half of it is 0.78 mph, so hundredths; all of it, 1.57, would end at the tenth."""
    inputs = {"va": uncertainty.Normal("30 mph", "0.4 mph")}
    known = uncertainty.propagate(lambda va: {"a.before.speed": va}, inputs, method="first_order")
    text = box(report(crash(), form="markdown", units="us", uncertainty=known))
    half = 1.959963985 * 0.4
    assert f"{30 - half:.2f} to {30 + half:.2f} mph (95 %)" in text


def test_a_note_is_no_finding_that_matters():
    """It stands among the findings, not in the box."""
    points = [car.replace(yaw_inertia=None, x=None, y=None) for car in (A, B)]
    points = points[0].replace(vx="30 mph"), points[1].replace(vy="25 mph", vx=0.0)
    impact = col.oblique_central(*points, 0.1, normal="0 deg", friction=0.5)
    notes = [finding for finding in diagnose(impact) if is_note(finding)]
    assert notes
    page = re.sub(r"\\(.)", r"\1", report(impact, form="markdown"))
    for note in notes:
        label = f"**{note.code.replace('_', ' ')}"
        assert label not in box(page)
        assert label in section(page, "Findings")


@pytest.fixture(scope="module")
def one_of_two():
    """By delta-V and energy, which two pairs of speeds share."""
    angle = math.radians(150.0)
    b = B.replace(vx=8.0 * math.cos(angle), vy=8.0 * math.sin(angle))
    truth = col.eccentric(A.replace(vx=14.0), b, 0.1, **PLACE)
    found = reconstruct.speeds(
        A, B, course_a="0 deg", course_b="150 deg", restitution=0.1, **PLACE,
        delta_v_a=truth.a.delta_v, energy_loss=truth.energy_loss,
    )  # fmt: skip
    assert len(found) == 2
    return found[0]


def test_another_answer_is_said_in_the_box_also_without_its_finding(one_of_two):
    """Once either way."""
    text = re.sub(r"\\(.)", r"\1", box(report(one_of_two, form="markdown")))
    assert "**not unique:**" in text
    assert "Not the only answer" not in text
    limits = {"not_unique": math.inf}
    text = box(report(one_of_two, form="markdown", limits=limits))
    assert "- Not the only answer: 2 impacts fit what was known.\n" in text
    assert "unique" not in text


def test_what_was_known_is_no_figure_of_the_answer(one_of_two):
    """Energy and delta-V were given; delta-V of the other vehicle was found."""
    text = box(report(one_of_two, form="markdown"))
    assert "- **Energy lost:**" not in text
    assert "- **Accord: delta-V:**" not in text
    assert "- **Civic: delta-V:**" in text


def test_no_range_is_said_before_anything_else():
    page = report(crash(), form="markdown")
    assert "No range is stated for these figures: give uncertainty= " in box(page)
    assert page.index("No range is stated") < page.index("## Inputs")
    shown = re.findall(r"^- \*\*(.*?):\*\* (.*)$", box(page), re.MULTILINE)
    assert [what for what, _ in shown][:5] == [
        "Accord: delta-V", "Civic: delta-V", "Accord: speed after", "Civic: speed after",
        "Energy lost",
    ]  # fmt: skip


def test_bounds_are_no_95_percent():
    inputs = {"va": uncertainty.Interval("28 mph", "32 mph")}
    known = uncertainty.propagate(
        lambda va: {"a.before.speed": 1.0 * va}, inputs, method="interval"
    )
    text = box(report(crash(), form="markdown", units="us", uncertainty=known))
    assert "28.0 to 32.0 mph (every value of the stated intervals)" in text
    assert "95 %" not in text


def test_the_findings_that_matter_stand_in_the_box():
    impact = crash(e=0.9)
    told = diagnose(impact, units="us")
    assert any(finding.code == "restitution" for finding in told)
    text = re.sub(r"\\(.)", r"\1", box(report(impact, form="markdown", units="us")))
    for finding in told:
        assert finding.sentence[1:].replace("of A ", "of the Accord ") in text


@pytest.mark.slow
def test_a_reverse_solution_says_from_what_and_marks_what_it_found():
    page = report(found_speeds(), form="markdown", units="us")
    assert "from the speed of the Civic before and the delta-V forward of the Accord" in box(page)
    assert "- **Accord: speed before:** 30.0 mph" in box(page)
    assert "Civic: speed before" not in box(page)
    given, found = section(page, "Inputs"), section(page, "Results")
    assert "| A (Accord) | velocity along x |" not in given
    assert "| A (Accord) | speed before | 30.0 mph, found |" in found
    assert "| B (Civic) | speed before | 25.0 mph, given |" in found
    assert "| contact | restitution | 0.10, given |" in found
    assert report(replay(page), **options(page)) == page


def test_a_restitution_that_was_found_is_part_of_the_answer():
    """Example 2 of the paper asks for it: 0.398."""
    impact = reconstruct.central("1100 kg", "950 kg", va="80 km/h", vb=0.0, vb_after="60 km/h")
    page = report(impact, form="markdown")
    assert "- **Restitution:** 0.40\n" in box(page)
    assert (
        "from the velocity of A before, the velocity of B before and the velocity of B after"
        in (box(page))
    )
    found = section(page, "Results")
    assert "| A | velocity before, along x | 80.0 km/h, given |" in found
    assert "| A | velocity before, along y | 0.0 km/h |" in found


def test_a_wide_range_rounds_the_number_before_it():
    """Of an interval from 20 to 90 mph the middle has no tenths."""
    known = uncertainty.propagate(
        lambda va: {"a.before.speed": 1.0 * va, "a.delta_v": 1.0 * va},
        {"va": uncertainty.Interval("20.04 mph", "90.04 mph")},
        method="interval",
    )
    page = report(crash(), form="markdown", units="us", uncertainty=known)
    number = crash().a.delta_v / 0.44704
    assert f"| A (Accord) | delta-V | {number:.0f} mph (20 to 90 mph) |" in section(page, "Results")


def test_a_limit_that_is_round_in_si_stays_round():
    """10 cm are 0.33 ft, and not 0.3281."""
    sheet = Markdown(Printed("us"), {}, {})
    assert _round_limit(sheet, 0.1, "length") == "0.33 ft"
    assert _round_limit(sheet, math.radians(20.0), "angle") == "20°"
    assert _round_limit(sheet, 0.005, "number") == "0.005"
    assert _round_limit(sheet, 0.253, "number") == "0.253"
    assert _round_limit(sheet, 1500.0, "mass") == "3300 lb"
    assert _round_limit(sheet, 0.2, "number") == "0.2"


@pytest.mark.slow
@pytest.mark.parametrize("bare", [False, True])
def test_evidence_stands_on_the_page_however_it_was_given(bare):
    """As a text with its unit, or as the float that a recorder's pulse has."""
    value = crash().a.delta_v_forward
    text = f"{value / 0.44704:.2f} mph"
    impact = found_speeds(delta_v_forward_a=value if bare else text, speed_b="25 mph")
    given = section(report(impact, form="markdown", units="us"), "Inputs")
    rows = re.findall(r"^\| evidence \| (.*?) \| (.*?) \|$", given, re.MULTILINE)
    (shown,) = (value for what, value in rows if what == "delta-V forward of the Accord")
    assert shown.startswith("-11.25 mph")
    assert ("speed of the Civic before", "25 mph") in rows
    whence = {"delta_v_forward_a": "Read from the recorder"}
    noted = section(report(impact, form="markdown", units="us", notes=whence), "Inputs")
    assert re.search(r"\| delta-V forward of the Accord \| .*\. Read from the recorder \|", noted)
    assert ("course of the Accord before", "0°") in rows


@pytest.mark.parametrize("text", [False, True])
def test_the_motions_after_that_planar_was_given_stand_on_its_page(text):
    """They are what it rests on, as texts or as the numbers of another result."""
    end = crash()
    after = {label: getattr(end, label).after for label in "ab"}
    if text:
        after = {
            label: state.replace(vx=f"{state.vx / 0.44704:.9g} mph")
            for label, state in after.items()
        }
    found = reconstruct.planar(
        after["a"], after["b"], normal="0 deg", point=(0.0, 0.0), restitution=0.1, friction=0.5,
        regime="sliding",
    )  # fmt: skip
    page = report(found, form="markdown", units="us")
    assert "from the motions of both vehicles after, the restitution and the friction" in box(page)
    shown = dict(re.findall(r"\| evidence \| (.*?) \| ([-\d.]+)", section(page, "Inputs")))
    for name, side in (("Accord", end.a), ("Civic", end.b)):
        state = side.after
        for what, value in (
            ("velocity along x", state.vx / 0.44704),
            ("velocity along y", state.vy / 0.44704),
            ("yaw rate", math.degrees(state.yaw_rate)),
        ):
            assert float(shown[f"{what} of the {name} after"]) == pytest.approx(value, rel=1e-3)
    assert report(replay(page), **options(page)) == page


def test_the_box_has_no_names_of_functions():
    """Several impacts fit what planar was given; the finding says so, and once."""
    end = crash()
    found = reconstruct.planar(
        end.a.after, end.b.after, normal="0 deg", point=(0.0, 0.0), restitution=0.1, friction=0.5,
        regime="sliding",
    )  # fmt: skip
    text = box(report(found, form="markdown", units="us"))
    assert "reconstruct." not in text.lower()
    assert "Solving backwards: one percent in what was given" in text
    if found.reconstruction.answers > 1:
        assert text.count("that fit what was") == 1


@pytest.mark.slow
def test_courses_that_were_given_as_numbers_stand_on_the_page():
    found = reconstruct.speeds(
        A, B, course_a=0.0, course_b=0.5 * math.pi, restitution=0.1, speed_b="25 mph",
        delta_v_forward_a=crash().a.delta_v_forward, **PLACE,
    )[0]  # fmt: skip
    given = section(report(found, form="markdown", units="us"), "Inputs")
    assert "| evidence | course of the Accord before | 0° |" in given
    assert "| evidence | course of the Civic before | 90° |" in given


@pytest.mark.slow
def test_inputs_of_a_propagation_are_in_words():
    page = report(crash(), form="markdown", units="us", uncertainty=spread())
    part = section(page, "Uncertainty, given the stated inputs")
    assert "variance from speed of the Accord before (va)" in part
    assert "variance from restitution (e)" in part
    assert "variance from course of the Civic before |" in part
    assert "course\\_b" not in part
    # An e that does not hold the restitution of this impact is another e.
    other = spread(e=uncertainty.Uniform(0.5, 0.6))
    part = section(
        report(crash(), form="markdown", units="us", uncertainty=other),
        "Uncertainty, given the stated inputs",
    )
    assert "restitution" not in part
    assert "| variance from e |" in part


def test_a_yaw_inertia_in_us_units_is_in_slugs():
    """1 slug ft2 is 1.3558179 kg m2 (NIST SP 811)."""
    given = section(report(crash(), form="markdown", units="us"), "Inputs")
    assert "| A (Accord) | yaw inertia about the centre of mass | 1770 slug·ft² |" in given
    bare = col.eccentric(
        A.replace(vx="30 mph", yaw_inertia=2711.6358), B.replace(vy="25 mph"), 0.1, **PLACE
    )
    assert "| 2000 slug·ft²" in section(report(bare, form="markdown", units="us"), "Inputs")


def test_vehicles_of_one_name_keep_their_letters():
    a, b = A.replace(vx="30 mph", name="Golf"), B.replace(vy="25 mph", name="Golf")
    text = box(report(col.eccentric(a, b, 0.1, **PLACE), form="markdown", units="us"))
    assert "- **A: delta-V:**" in text


@pytest.mark.slow
def test_a_page_is_filed_under_case_author_and_date():
    filed = {"exhibit": "12", "case": 'No. 7 "<b>\\', "author": "J. Doe"}
    filed["date"] = "25 November 2026"
    page = report(crash(), figures=False, **filed)
    line = f"Exhibit: 12 · Case: {filed['case']} · Author: J. Doe · Date: 25 November 2026"
    assert f'<p class="filed">{html.escape(line)}</p>' in page
    (foot,) = re.findall(r'@bottom-left \{ content: "([^"]*)"', page)
    assert "".join(chr(int(code, 16)) for code in re.findall(r"\\([0-9a-f]{6})", foot)) == line
    assert options(page) == {"figures": False, "units": "us", **filed}
    assert report(replay(page), **options(page)) == page
    plain = report(crash(), figures=False)
    assert '<p class="filed">' not in plain
    assert plain == report(crash(), figures=False)
    for name in filed:
        with pytest.raises(col.InputError, match=f"{name} must be a text that says something"):
            report(crash(), figures=False, **{name: 7})


@pytest.mark.slow
def test_figures_are_numbered():
    """From the one beside the answer on, without a gap, also on a page of several results."""
    pages = (report(crash()), report([crash(), crash()]))
    for page in pages:
        numbers = [int(number) for number in re.findall(r"<figcaption>Figure (\d+)\. ", page)]
        assert numbers == list(range(1, page.count("<figure>") + 1))
    assert "<figcaption>Figure 1. The scene from above" in pages[0]


@pytest.mark.slow
def test_a_fit_and_a_posterior_answer_with_their_intervals():
    seen = {"y": ("10 m/s", "0.5 m/s")}
    start = {"x": uncertainty.Uniform("0 m/s", "50 m/s")}
    fitted = reconstruct.fit(lambda x: {"y": x}, {"x": uncertainty.Interval(0.0, 50.0)}, seen)
    assert "- **x:** 9.02 to 10.98" in box(report(fitted, form="markdown", units="si"))
    likely = reconstruct.posterior(
        lambda x: {"y": x}, start, {"y": uncertainty.Normal("10 m/s", "0.5 m/s")},
        samples=2048, seed=1,
    )  # fmt: skip
    text = box(report(likely, form="markdown", units="si", figures=False))
    low, high = map(
        float, re.search(r"\*\*x:\*\* ([\d.]+) to ([\d.]+) m/s \(95 %\)", text).groups()
    )
    # Uniform before and normal errors: normal around what was seen, 1.96 standard errors.
    assert low == pytest.approx(9.02, abs=0.1)
    assert high == pytest.approx(10.98, abs=0.1)


@pytest.mark.slow
def test_what_follows_from_a_posterior_stands_first_in_the_answer():
    """v0^2 = v1^2 + 2 g drag d, in the units of the page, and below it from what."""
    likely = reconstruct.posterior(
        lambda x: {"y": x}, {"x": uncertainty.Uniform("0 mph", "50 mph")},
        {"y": ("20 mph", "0.1 mph")}, samples=512, seed=1,
    )  # fmt: skip
    braked = likely.with_result(
        "speed before the skid", col.travel.speed, "m/s",
        distance="30 ft", drag=0.7, end_speed=likely["x"],
    )  # fmt: skip
    page = report(braked, form="markdown", figures=False)
    text = box(page)
    low, high = map(
        float, re.search(r"\*\*speed before the skid:\*\* ([\d.]+) to ([\d.]+) mph", text).groups()
    )
    assert text.index("speed before the skid") < text.index("**x:**")
    exact = math.sqrt(20.0**2 + 2.0 * 0.7 * 9.80665 * 30.0 * 0.3048 / 0.44704**2)
    assert low < exact < high
    assert "Speed before the skid was worked out from that." in text
    assert "by travel.speed: distance = 30 ft, drag = 0.7, end speed = x" in page
    figures = report(braked)
    assert "Speed before the skid, in the cases drawn" in figures


@pytest.mark.parametrize(
    ("latex", "written"),
    [
        ("m_A", "<msub><mi>m</mi><mrow><mi>A</mi></mrow></msub>"),
        (r"\frac{1}{2}", "<mfrac><mrow><mn>1</mn></mrow><mrow><mn>2</mn></mrow></mfrac>"),
        ("x^2", "<msup><mi>x</mi><mrow><mn>2</mn></mrow></msup>"),
        (
            "v_{A}'",
            "<msubsup><mi>v</mi><mrow><mrow><mi>A</mi></mrow></mrow><mrow><mo>′</mo></mrow>"
            "</msubsup>",
        ),
        (r"\left(-1.5\right)", "<mrow><mo>(</mo><mo>−</mo><mn>1.5</mn><mo>)</mo></mrow>"),
        (
            r"2\ \mathrm{km/h}",
            '<mn>2</mn><mspace width="0.35em"></mspace><mrow><mi mathvariant="normal">km</mi>'
            '<mtext>/</mtext><mi mathvariant="normal">h</mi></mrow>',
        ),
    ],
)
def test_formulas_are_mathml(latex, written):
    assert mathml(latex) == f'<math displaystyle="true">{written}</math>'


def test_a_formula_that_cannot_be_read_stays_as_it_is():
    for latex in (r"\unknown{<x>}", r"\frac{1}", r"\left(1"):
        assert mathml(latex) == f"<code>{html.escape(latex)}</code>"


def test_lines_below_each_other_are_aligned_at_their_sign():
    text = mathml("\n\\begin{aligned}\na &= b \\\\\n&= 2\n\\end{aligned}\n")
    assert text.count("<mtr>") == 2
    assert text.count("<mtd>") == 4
    assert "<mtd></mtd><mtd><mo>=</mo><mn>2</mn></mtd>" in text


def test_what_moves_no_speed_but_by_rounding_is_0():
    """The sine of pi is 1e-16 in floats, and that is no sensitivity."""
    found = reconstruct.momentum(
        1500.0, 1300.0, course_a=0.0, course_b=0.5 * math.pi, course_a_after=math.pi / 3.0,
        course_b_after=math.pi / 4.0, speed_a_after=np.pi, speed_b_after=7.0,
    )  # fmt: skip
    text = report(found, form="markdown", units="us")
    assert not re.search(r"e-1\d mph per", text)
    assert "mph per °" in text


# Several results on one page.


def crossed():
    return reconstruct.momentum(
        "3400 lb", "2900 lb", course_a="0 deg", course_b="90 deg", course_a_after="35 deg",
        course_b_after="50 deg", speed_a_after="22 mph", speed_b_after="25 mph",
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("form", ["markdown", "html"])
def test_a_case_of_several_results_is_one_page(form):
    known = spread()
    results, ranges = [crossed(), found_speeds(), crash()], [None, None, known]
    given = {"form": form, "units": "us", "derivation": True, "figures": False, "notes": "One."}
    page = report(results, uncertainty=ranges, title="Elm and Main", **given)
    again = replay(page)
    assert again == results
    assert report(again, **options(page), uncertainty=ranges) == page
    if form == "html":
        return
    heads = re.findall(r"^(#+ .*)$", page, re.MULTILINE)
    assert [head for head in heads if head.startswith("## ")] == [
        "## Answer", "## 1. Planar momentum of A and B",
        "## 2. Impact of A (Accord) and B (Civic)", "## 3. Impact of A (Accord) and B (Civic)",
        "## Notes", "## References", "## Record",
    ]  # fmt: skip
    assert heads.count("### Inputs") == heads.count("### Derivation") == 3
    first = box(page)
    assert first.index("A: speed before") < first.index("Accord: speed before")
    assert "(95 %)" in first.split("### 3. ")[1]
    assert "(95 %)" not in first.split("### 3. ")[0]
    # What each rests on, and what stands by itself in each part.
    assert first.count("Worked back") == 2
    assert page.count("is an equation of it.") == 1


@pytest.mark.slow
def test_figures_of_several_results_have_ids_of_their_own():
    page = report([crossed(), crash()], units="us")
    ids = re.findall(r'<[^<>]*\bid="([^"]*)"', page)
    assert len(set(ids)) == len(ids)
    assert {"1.momentum.figure_1", "2.scene.figure_1", "2.momentum.figure_1"} <= set(ids)


@pytest.mark.parametrize(
    ("results", "given", "said"),
    [
        ([], {}, "impact is an empty list"),
        ([3.0], {}, "impact must be an Impact"),
        (2, {"outline_a": (4.2, 1.8)}, "outline_a is of one impact, and this page has 2 results"),
        (2, {"damage_pdof_b": 0.3}, "damage_pdof_b is of one impact"),
        (2, {"notes": {"a.mass": "Weighed"}}, "notes that are texts alone"),
        (2, {"uncertainty": [None]}, "uncertainty must be a list of 2 for as many results"),
        (2, {"uncertainty": 3}, "uncertainty must be a list of 2"),
        (2, {"uncertainty": [None, 3]}, "uncertainty must be what uncertainty.propagate returned"),
    ],
)
def test_what_a_page_of_several_does_not_take_is_refused(results, given, said):
    results = [crash(), crossed()] if results == 2 else results
    with pytest.raises(col.InputError, match=re.escape(said)):
        report(results, **given)


@pytest.mark.slow
def test_a_record_of_several_that_was_changed_is_refused():
    page = report([crash(), crossed()], form="markdown")
    with pytest.raises(col.InputError, match="its inputs do not give its"):
        replay(page.replace('"delta_v_a": ', '"delta_v_a": 1'))
    with pytest.raises(col.InputError, match="its results are no list of records"):
        replay(page.replace('"results": [\n  {', '"results": {"x": [{}]}, "other": [{', 1))


def test_subjects_of_which_the_same_is_said_share_a_table():
    """Both vehicles beside each other, one fact of many below its name, and others apart."""
    sheet = Html(Printed("si"), {}, {})
    sheet.table(
        [
            ("A (Golf)", "mass", "1 kg"), ("contact", "kind", "elastic"), ("B", "mass", "2 kg"),
            ("B", "speed", "3 m/s"), ("x", "stated", "4"), ("y", "stated", "5"),
            ("p", "mean", "6"), ("p", "range", "7"), ("q", "mean", "8"), ("q", "range", "9"),
        ]
    )  # fmt: skip
    text = "\n".join(sheet.blocks)
    assert text.count("<table>") == 4
    heads = re.findall(r'<th scope="col">(.*?)</th>', text)
    assert heads == ["A (Golf)", "B", "p", "q"]
    assert '<tr><th scope="row">mass</th><td>1 kg</td><td>2 kg</td></tr>' in text
    assert '<tr><th scope="row">speed</th><td></td><td>3 m/s</td></tr>' in text
    assert re.findall("<caption>(.*?)</caption>", text) == ["contact", "stated"]
    assert '<tr><th scope="row">y</th><td>5</td></tr>' in text
    assert '<tr><th scope="row">range</th><td>7</td><td>9</td></tr>' in text
