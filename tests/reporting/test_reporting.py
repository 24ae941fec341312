"""report: what stands on the page is what the pieces say, the page is one HTML that asks for
nothing, and it can be made again.
"""

import html
import json
import math
import os
import pickle
import random
import re
import subprocess
import sys
import warnings
from contextlib import nullcontext
from html.parser import HTMLParser
from pathlib import Path

import jsonschema
import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct, reference, uncertainty
from collisions.derivation import explain
from collisions.diagnostics import LIMITS, diagnose
from collisions.impact.schema import impact_schema
from collisions.quantities.formatting import typeset
from collisions.quantities.tables import label_of
from collisions.reporting import options, replay, report
from pages import section, tampered
from strategies import other_registry

mpl = pytest.importorskip("matplotlib")
mpl.use("agg")

ROOT = Path(__file__).resolve().parent.parent.parent
UREG = other_registry()
VOID = {"meta", "br", "hr", "img", "link", "input"}
# A name that tries to be markup, in HTML, in Markdown, in a formula and in an SVG file.
EVIL = '<script>alert("1")</script> | `x` **b** $\\frac$ & </pre> id="z" [l](http://x)'

HOLDS_ITSELF: list = []
HOLDS_ITSELF.append(HOLDS_ITSELF)


def golf(**changes):
    given = {
        "mass": "1500 kg",
        "yaw_inertia": 2600,
        "vx": "54 km/h",
        "x": -2.2,
        "y": 0.0,
        "heading": "0 deg",
        "name": "Golf",
    }
    return col.Vehicle(**{**given, **changes})


def polo(**changes):
    given = {
        "mass": UREG.Quantity(2600, "lb"),
        "yaw_inertia": 2100,
        "x": 0.9,
        "y": 0.1,
        "heading": "-90 deg",
        "name": "Polo",
    }
    return col.Vehicle.from_speed(speed="30 km/h", course="-90 deg", **{**given, **changes})


def crash(a=None, b=None, e=0.1, **options):
    options = (
        {"friction": 0.5} | options
        if not {"impulse_ratio", "critical_fraction"} & options.keys()
        else options
    )
    return col.eccentric(
        a or golf(), b or polo(), e, **{"normal": "10 deg", "point": (0.0, 0.0), **options}
    )


def gaining():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.EnergyGainWarning)
        return col.oblique_central(golf(), polo(), 1.0, normal=0.0, impulse_ratio=-0.9)


def pinned():
    """Example 3 of the paper."""
    a = col.Vehicle(mass="900 kg", vx="60 km/h", yaw_inertia=math.inf, x=0.0, y=4.0)
    b = col.Vehicle(mass="1000 kg", yaw_inertia="1333 kg*m**2", x=0.0, y="2 m", pivot=("0 ft", 0.0))
    return col.eccentric(a, b, 0.80, normal=0.0, point=(0.0, 4.0), friction=0.0)


def example_2():
    return reconstruct.central("1100 kg", "950 kg", va="80 km/h", vb=0.0, vb_after="60 km/h")


IMPACTS = {
    "eccentric": crash,
    "other law": lambda: crash(law="kudlich-slibar"),
    "given ratio": lambda: crash(impulse_ratio=0.1),
    "share of critical": lambda: crash(critical_fraction=0.5),
    "wall": lambda: col.linear_central(golf(heading=None), col.Vehicle.barrier(), 0.2),
    "oblique": lambda: col.oblique_central(golf(), polo(), 0.2, normal=0.2, friction=0.3),
    "pinned": pinned,
    "example 2": example_2,
    "planar": lambda: reconstruct.planar(crash().a.after, crash().b.after, normal="10 deg",
    point=(0, 0), restitution=0.1,
                                          friction=0.5, regime="sliding"),
    "solve, full": lambda: col.solve(golf(), polo(), 0.1, normal="10 deg", point=(0, 0),
    friction=0.5),
    "solve, linear": lambda: col.solve(golf(), golf(vx=0.0, x=2.2), 0.1, normal=0, point=(0, 0),
    friction=0.5, tolerance=0.1),
    "energy gain": gaining,
    "evil": lambda: crash(golf(name=EVIL), polo(name="a\u202eb\x00c\n# d 漢")),
}  # fmt: skip


@pytest.fixture(scope="module")
def impacts():
    found = {}
    for name, make in IMPACTS.items():
        try:
            found[name] = make()
        except col.AmbiguousSolutionError as error:
            found[name] = error.solutions[0]
    return found


def spread(*names, method="quasi_random", **changes):
    """Outputs of these names, all of them without one; two of an answer, one with a unit and one
    without.
    """

    def model(speed, restitution):
        with_speed = golf(vx=speed)
        answer = col.eccentric(
            with_speed,
            polo(),
            restitution,
            normal="10 deg",
            point=(0, 0),
            friction=0.5,
            on_failure="nan",
        )
        found = {
            "b.delta_v": answer.b.q.delta_v,
            "a_after_vx": answer.a.after.vx,
            "loss": answer.q.energy_loss,
            "own": 2.0 * speed,
        }
        return {name: found[name] for name in names or found}

    inputs = {
        "speed": uncertainty.Normal("54 km/h", "2 km/h"),
        "restitution": uncertainty.Uniform(0.05, 0.15),
        **changes,
    }
    options = {"samples": 64, "seed": 1} if method == "quasi_random" else {}
    return uncertainty.propagate(model, inputs, method=method, **options)


class Page(HTMLParser):
    """Elements in order, text by element, and whether every tag is closed where it should be."""

    def __init__(self, page):
        super().__init__(convert_charrefs=True)
        self.open, self.tags, self.texts, self.ids, self.urls = [], [], [], [], []
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self._look(attrs)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        # Only within SVG may an element close itself.
        assert "svg" in self.open, tag
        self.tags.append(tag)
        self._look(attrs)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append((self.open[-1] if self.open else "", data))

    def _look(self, attrs):
        names = [name for name, _ in attrs]
        assert len(set(names)) == len(names)
        self.ids += [value for name, value in attrs if name == "id"]
        self.urls += [
            value
            for name, value in attrs
            if name in ("src", "href", "xlink:href", "action", "data", "srcset")
        ]

    def of(self, tag):
        return [text for element, text in self.texts if element == tag]


def rows(page):
    """The rows of all tables of a Markdown page, without escapes."""
    lines = [
        line
        for line in page.splitlines()
        if line.startswith("| ") and not line.startswith("| --- ")
    ]
    return [
        tuple(re.sub(r"\\(.)", r"\1", part) for part in line[2:-2].split(" | ")) for line in lines
    ]


@pytest.mark.slow
@pytest.mark.parametrize("form", ["html", "markdown"])
@pytest.mark.parametrize("name", IMPACTS)
def test_a_report_made_of_what_a_report_holds_is_the_same(name, form, impacts):
    impact = impacts[name]
    # Figures are costly, and are looked at for one impact below.
    options = {"form": form, "units": "metric", "derivation": True, "figures": False}
    page = report(impact, **options)
    with pytest.warns(col.EnergyGainWarning) if name == "energy gain" else nullcontext():
        again = replay(page)
    assert again == impact
    assert [side.before.given or {} for side in (again.a, again.b)] == [
        side.before.given or {} for side in (impact.a, impact.b)
    ]
    assert report(again, **options) == page


@pytest.mark.slow
def test_other_ends_of_lines_do_no_harm(impacts):
    for form in ("html", "markdown"):
        page = report(impacts["eccentric"], form=form, figures=False)
        assert replay(page.replace("\n", "\r\n")) == impacts["eccentric"]


@pytest.mark.slow
def test_with_everything_it_is_the_same_too_and_in_another_process():
    """Neither hashes, nor settings of matplotlib, nor the record change a byte."""
    code = (
        "import sys; sys.path.insert(0, 'tests'); from reporting import test_reporting as t\n"
        "sys.stdout.buffer.write(t.everything(t.rear_end()).encode())"
    )
    page = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src"), "PYTHONHASHSEED": "1",
        "MPLBACKEND": "agg"},
    ).stdout.decode()  # fmt: skip
    with mpl.rc_context({"font.size": 17, "svg.fonttype": "path", "axes.facecolor": "red"}):
        assert everything(replay(page)) == page
        assert mpl.rcParams["font.size"] == 17
    assert Page(page).tags.count("svg") == 4


def rear_end():
    return col.linear_central(golf(), golf(vx="10 km/h", x="2.2 m", name="Passat"), 0.1)


def everything(impact):
    return report(
        impact, title="Case 7", units="metric", uncertainty=spread("b.delta_v"),
        outline_a=(4.2, 1.8), outline_b=("13 ft", 1.7, 0.2),
        duration="90 ms", drag=0.6, limits={"normal": 0.5}, share_a="50 %",
        notes=["One.", "Two <b>."], derivation=True,
    )  # fmt: skip


@pytest.fixture(scope="module")
def evil_page(impacts):
    return report(impacts["evil"], title=EVIL, notes=[EVIL, "- not a list"], derivation=True)


@pytest.mark.slow
def test_html_is_whole_and_asks_for_nothing(evil_page):
    page = Page(evil_page)
    assert page.tags[:3] == ["html", "head", "meta"]
    assert page.tags.count("svg") == 4
    assert not {"script", "link", "img", "iframe", "object", "base", "form"} & set(page.tags)
    assert len(set(page.ids)) == len(page.ids)
    assert not any(re.search(r"\s", name) for name in page.ids)
    assert all(url.startswith("#") and url[1:] in page.ids for url in page.urls)
    assert all(found in page.ids for found in re.findall(r"url\(#([^)]*)\)", evil_page))
    assert "@import" not in evil_page
    assert "default-src 'none'" in evil_page
    assert page.of("title") == page.of("h1") == [EVIL]
    assert page.of("p").count(EVIL) == 1
    assert evil_page.encode("utf-8").decode("utf-8") == evil_page


@pytest.mark.slow
@pytest.mark.parametrize("name", ["energy gain", "example 2", "solve, linear", "pinned"])
def test_html_of_other_parts_is_whole_too(name, impacts):
    Page(report(impacts[name], figures=False, derivation=True))


@pytest.mark.slow
def test_names_stay_names(impacts, evil_page):
    page = Page(evil_page)
    assert f"A ({EVIL})" in page.of("th")
    # A figure shortens long names.
    assert any(EVIL[:12] in text for text in page.of("text"))
    # What turns the reading direction, or cannot be seen, is shown as such.
    assert "B (a\ufffdb\ufffdc # d 漢)" in page.of("th")
    text = report(impacts["evil"], form="markdown").split("```json")[0]
    assert not re.search(r"(?<!\\)[<>`$]", text)
    assert {row[0] for row in rows(text.replace("\\|", "¦"))} >= {
        f"A ({EVIL})".replace("|", "¦"),
        "contact",
    }


def test_markdown_cannot_be_broken_by_a_note(impacts):
    notes = ["# head", "---", "1. one", "+ plus", "```json\n{}\n```", "= x"]
    text = report(impacts["example 2"], form="markdown", notes=notes)
    assert section(text, "Notes").strip().split("\n\n") == [
        r"\# head", r"\---", r"1\. one", r"\+ plus", r"\`\`\`json \{\} \`\`\`", r"\= x"
    ]  # fmt: skip
    assert replay(text) == impacts["example 2"]


@pytest.mark.slow
def test_parts_stand_in_order(impacts):
    text = report(
        impacts["eccentric"],
        form="markdown",
        uncertainty=spread(),
        notes="A word.",
        derivation=True,
    )
    assert re.findall(r"^##? (.*)$", text, re.MULTILINE) == [
        "Impact of A (Golf) and B (Polo)", "Answer", "Inputs", "Results",
        "Uncertainty, given the stated inputs", "Findings",
        "Notes", "Figures", "Assumptions", "Derivation", "References", "Record",
    ]  # fmt: skip
    assert f"Calculated with collisions {col.__version__}." in text
    assert "Application of Impulse Momentum Theory to Vehicle Collisions" in section(
        text, "References"
    )


@pytest.mark.slow
@pytest.mark.parametrize("form", ["html", "markdown"])
def test_an_energy_gain_stands_first(form, impacts):
    text = report(impacts["energy gain"], form=form, units="si", figures=False)
    first = text.split("</h1>\n" if form == "html" else "\n\n")[1]
    assert first.startswith(
        '<p class="stressed">Energy gain of ' if form == "html" else "**Energy gain of "
    )
    loss = impacts["energy gain"].energy_loss
    assert loss < 0.0
    # Three figures are printed.
    assert float(re.search(r"Energy gain of ([\d.]+) J", first)[1]) == pytest.approx(
        -loss, rel=5e-3
    )
    assert "Energy gain" not in report(impacts["oblique"], form=form, figures=False)


def test_inputs_are_shown_as_given():
    metric = rows(report(crash(), form="markdown", units="metric"))
    si = rows(report(crash(), form="markdown", units="si"))
    assert ("A (Golf)", "velocity along x", "54 km/h") in metric
    assert ("A (Golf)", "velocity along x", "15 m/s, given as 54 km/h") in si
    # 2600 lb is 2600 x 0.45359237 kg.
    assert ("B (Polo)", "mass", "1179 kg, given as 2600 lb") in si
    assert ("B (Polo)", "speed", "8.333 m/s, given as 30 km/h") in si
    # Nobody reads radians who gave degrees.
    assert ("B (Polo)", "course", "-90°") in si
    assert ("A (Golf)", "yaw inertia about the centre of mass", "2600 kg·m²") in si
    assert ("B", "pivot O (x, y)", "x: 0 m, given as 0 ft; y: 0 m") in rows(
        report(pinned(), form="markdown")
    )


@pytest.mark.parametrize(("units", "other"), [("metric", False), ("si", True)])
def test_given_as_is_explained_where_it_stands(units, other):
    """And nowhere else: every input of this car and wall is in metric units."""
    car = col.Vehicle(mass="1500 kg", vx="54 km/h")
    page = report(
        col.linear_central(car, col.Vehicle.barrier(), 0.1),
        form="markdown",
        units=units,
        figures=False,
    )
    assert (", given as 54 km/h" in page, "“Given as”" in page) == (other, other)


@pytest.mark.slow
@pytest.mark.parametrize("units", ["si", "metric", "us"])
@pytest.mark.parametrize("name", ["eccentric", "oblique", "pinned", "example 2", "solve, linear"])
def test_results_are_those_of_explain(name, units, impacts):
    """The derivation is tested against the paper; here its table of answers must come back, row by
    row.
    """
    impact = impacts[name]
    text = report(impact, form="markdown", units=units)
    explained = explain(impact, units=units).split("\n## Answers\n")[1].split("\n## ")[0]
    shown = rows(section(text, "Results"))
    # Angles that were given in degrees are printed so in SI too.
    degrees = name not in ("pinned", "example 2")
    metric = rows(explain(impact, units="metric").split("\n## Answers\n")[1].split("\n## ")[0])
    origins = ("", ", found", ", given") if impact.reconstruction is not None else ("",)
    for row, in_metric in zip(rows(explained)[1:], metric[1:], strict=True):
        of, what, value = (
            in_metric
            if degrees and " rad" in row[2] + " " and not (row[2].endswith("rad/s"))
            else row
        )
        wanted = {(what, typeset(value) + origin) for origin in origins}
        assert any(row[0][0] == of[0] and row[1:] in wanted for row in shown), (of, what, value)
    assert shown[-1] == ("contact", "kind", impact.kind)


def test_ees_needs_a_share():
    impact = crash()
    assert "EES" not in report(impact, form="markdown")
    shown = {
        (row[0], row[1].split(",")[0]): row[2]
        for row in rows(report(impact, form="markdown", units="si", share_a="25 %"))
        if "if A took up 25 percent" in row[1]
    }
    # 0.01 m/s is the last digit printed.
    for name, energy in (
        ("EES (ISO 12353)", impact.energy_loss),
        ("speed of maximum crush", impact.energy_absorbed),
    ):
        for who, part, mass in (("A (Golf)", 0.25, 1500.0), ("B (Polo)", 0.75, 2600 * 0.45359237)):
            assert float(shown[who, name].split()[0]) == pytest.approx(
                math.sqrt(2 * part * energy / mass), abs=0.006
            )


def test_components_of_a_recorder_are_printed_and_kept():
    """A pair (forward, left) stands among the inputs as it was given, and goes into the report that
    is made again.
    """
    page = report(crash(), form="markdown", units="si", damage_delta_v_a=("-20 km/h", 1.5))
    assert "forward: -5.556 m/s, given as -20 km/h; left: 1.5 m/s" in page
    assert "and its damage shows 5.75 m/s from 0.264 rad" in page
    assert report(replay(page), **options(page)) == page


def in_words(source):
    """The source of a limit, with published values by the names they have under References."""
    source = source.replace(
        "reference.restitution_range", "the published range of restitution (see References)"
    )
    return re.sub(
        r"reference\.(\w+)",
        lambda found: f"“{getattr(reference, found[1]).name}” (see References)",
        source,
    )


@pytest.mark.slow
def test_every_finding_is_told(impacts):
    limits = {"tyre_impulse": 0.01}
    for name in ("pinned", "eccentric", "energy gain"):
        found = diagnose(impacts[name], limits=limits, units="si")
        assert found
        text = re.sub(
            r"\\(.)", r"\1", report(impacts[name], form="markdown", units="si", limits=limits)
        )
        for finding in found:
            assert f"**{label_of(finding.code)}" in section(text, "Findings")
            assert finding.sentence in text
            assert f"Basis of the limit: {in_words(finding.source)}." in text
        assert "- **Limit of tyre impulse:** 0.01, set for this report." in text
    assert "FIT" not in text
    pins = re.sub(r"\\(.)", r"\1", report(impacts["pinned"], form="markdown"))
    assert "Basis of the limit: the published range of restitution (see References)." in section(
        pins, "Findings"
    )
    assert "Cipriani and others, SAE 2002-01-0540" in section(pins, "References")
    none = report(pinned(), form="markdown", limits={"restitution": 0.9, "normal": 1.0})
    assert "which proves nothing by itself." in section(none, "Findings")


def test_limits_of_every_unit_can_be_shown(impacts):
    text = report(
        impacts["eccentric"],
        form="markdown",
        units="us",
        limits=dict.fromkeys(LIMITS, 1e-3),
        figures=False,
    )
    printed = section(text, "Assumptions")
    assert printed.count("set for this report.") == len(LIMITS)
    # 1 g in pounds, to four figures; and 0.001 m in feet, to two decimals and two more.
    assert "Limit of suspect mass:** 0.002205 lb" in printed
    assert "Limit of point outside:** 0.0033 ft" in printed


@pytest.mark.slow
def test_assumptions_say_what_is_left_out(impacts):
    impact = impacts["eccentric"]
    text = report(impact, form="markdown", units="si", duration="50 ms", drag=0.5)
    printed = section(text, "Assumptions")
    assert "for a contact of 0.05 s and tyres with a drag factor of 0.5" in printed
    # 0.5 x 9.80665 m/s2 x 0.05 s, two decimals.
    share = 100.0 * 0.5 * 9.80665 * 0.05 / impact.a.delta_v
    assert (
        "A (Golf)",
        "delta-V from its own tyres, upper bound",
        f"0.25 m/s ({share:.0f} percent)",
    ) in rows(printed)
    assert "**Law:** Brach" in printed
    assert f"**Tangential impulse:** {impact.regime}" in printed
    assert "**Law:** Kudlich" in report(impacts["other law"], form="markdown")
    assert "Law:" not in report(impacts["wall"], form="markdown")
    # A wall has no tyres.
    assert {
        row[0] for row in rows(section(report(impacts["wall"], form="markdown"), "Assumptions"))
    } == {
        "of",
        "contact",
        "A (Golf)",
    }


# A number that is none, in the texts that people read.
BARE = re.compile(r"(?<![\w.])[-+]?(?:nan|inf)(?![\w])")


def sideswipes():
    """Ordinary sideswipes: bodies that slide along each other and turn, so that some part before
    the contact ends.
    """
    rng = random.Random(3)
    for _ in range(60):
        turning = rng.uniform(-3.0, 3.0)
        a = col.Vehicle(
            mass=1500,
            yaw_inertia=2600,
            vx=25.0,
            vy=rng.choice((0.5, 2.0)),
            yaw_rate=turning,
            x=-1.2,
            y=-1.0,
        )
        b = col.Vehicle(
            mass=1300, yaw_inertia=2100, vx=rng.choice((0.0, 20.0)), yaw_rate=turning, x=0.8, y=1.0
        )
        normal, e = 0.5 * math.pi + rng.uniform(-0.2, 0.2), rng.choice((0.0, 0.2))
        try:
            yield col.eccentric(
                a, b, e, normal=normal, point=(0.0, 0.0), friction=rng.choice((0.0, 0.4))
            )
        except col.NoImpactError:
            continue


@pytest.mark.slow
def test_no_text_prints_a_bare_nan():
    """Where left_out has no answer for the geometry the report says so and why; so do the findings
    and the tables.
    """
    undefined = 0
    for impact in sideswipes():
        # So long that what moves from maximum engagement leaves some of them without an answer.
        left = col.left_out(impact, duration="3 s")
        page = report(impact, form="markdown", figures=False, derivation=True, duration="3 s")
        text = page.partition("```json")[0]
        texts = [
            text,
            col.explain(impact, units="metric"),
            repr(left),
            left._repr_html_(),
            *(f.sentence for f in diagnose(impact, duration="3 s")),
        ]
        assert not [one for text in texts for one in text.split("\n") if BARE.search(one)]
        printed = {
            row[0]: row[2]
            for row in rows(section(text, "Assumptions"))
            if "positions and normal" in row[1]
        }
        for label, side in (("A", left.a), ("B", left.b)):
            lost = math.isnan(side.geometry_delta_v)
            undefined += lost
            assert lost == printed[label].startswith(
                "not defined: the model has no answer with the places and the normal of other "
                "moments of the contact"
            )
    assert undefined > 4


@pytest.mark.slow
def test_a_figure_of_one_case_has_no_spread():
    """Of all the cases one has an answer: no bare nan for what cannot be known of it."""
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=10.0), col.Vehicle(mass=1200.0), 0.1)

    def asked(least):
        def model(speed):
            vehicles = col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1200.0)
            delta_v = col.linear_central(*vehicles, 0.1).b.q.delta_v * np.where(
                speed >= least, 1.0, np.nan
            )
            return {"b_delta_v": delta_v, "twice": 2.0 * delta_v.magnitude, "speed": speed}

        speed = uncertainty.Normal(10.0, 0.1)
        return uncertainty.propagate(
            model, {"speed": speed}, method="quasi_random", seed=1, samples=64
        )

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.OutOfRangeWarning)
        found = asked(np.max(asked(0.0)["speed"].values))
    assert math.isnan(found["b_delta_v"].std)
    for text in (
        repr(found),
        found._repr_html_(),
        report(impact, form="markdown", uncertainty=found, figures=False),
    ):
        text = text.partition("```json")[0]
        assert "in the one case that has an answer, so no spread is known" in text
        assert not BARE.search(text)


def test_reverse_and_choice_are_told(impacts):
    text = report(impacts["example 2"], form="markdown")
    assert ("B", "velocity before, along x", "0.0 km/h, given") in rows(section(text, "Results"))
    assert ("contact", "restitution", "0.40, found") in rows(section(text, "Results"))
    assert not any(row[1] == "restitution e" for row in rows(section(text, "Inputs")))
    assert (
        "Known besides masses and geometry: velocity of A before, velocity of B before, velocity "
        "of B after" in text
    )
    assert "Condition " in section(text, "How the rest was found")
    assert "$" not in text.split("```json")[0]
    chosen = report(impacts["solve, linear"], form="markdown")
    assert "Taken: linear\\_central." in section(chosen, "Why this model")
    assert "Why this model" not in report(impacts["eccentric"], form="markdown")


@pytest.mark.slow
def test_uncertainty_is_told():
    impact, known = crash(), spread()
    text = report(impact, form="markdown", units="si", uncertainty=known)
    part = section(text, "Uncertainty, given the stated inputs")
    output = known["b.delta_v"]
    # Two figures of the standard deviation.
    assert (
        "Polo: delta-V",
        "mean ± standard deviation",
        f"{output.mean:.2f} ± {output.std:.2f} m/s",
    ) in rows(part)
    low, high = output.interval()
    assert ("Polo: delta-V", "95 percent interval", f"{low:.2f} to {high:.2f} m/s") in rows(part)
    shares = (output.contributions["speed"], output.total_contributions["speed"])
    alone, in_all = (
        f"{100 * share:.0f} ± {100 * error:.0f} %"
        for share, error in zip(shares, output.contribution_standard_errors["speed"], strict=True)
    )
    assert ("Polo: delta-V", "variance from speed", f"{alone}, in all {in_all}") in rows(part)
    assert any(row[:2] == ("own", "mean ± standard deviation") for row in rows(part))
    assert "64 cases, all with an answer, seed 1" in part
    assert "54 ± 2 km/h" in part
    # The answers of that name are rounded to it, also under the other spelling.
    assert ("B (Polo)", "delta-V", f"{impact.b.delta_v:.2f} ± {output.std:.2f} m/s") in rows(
        section(text, "Results")
    )
    spread_of_a = known["a_after_vx"].std
    assert any(
        f"± {spread_of_a:.2f} m/s" in row[2]
        for row in rows(section(text, "Results"))
        if row[1] == "velocity after, along x"
    )
    assert "lies outside" not in text


def test_a_range_with_a_share_is_reported_as_it_was_stated():
    """Also where bare numbers are written in the units of the page."""

    def model(speed_a, restitution):
        impact = col.linear_central(
            col.Vehicle(mass=1500.0, vx=speed_a), col.Vehicle(mass=1200.0), restitution
        )
        return {"b.delta_v": impact.b.q.delta_v}

    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=10.0), col.Vehicle(mass=1200.0), 0.1)
    between = uncertainty.Normal.between
    known = {
        "speed_a": between(9.5, 10.5, 0.95),
        "restitution": between("9 percent", "11 percent", 0.9),
    }
    found = uncertainty.propagate(model, known, method="first_order")
    text = report(impact, form="markdown", units="metric", uncertainty=found, figures=False)
    part = section(text, "Uncertainty, given the stated inputs")
    assert "34.2 to 37.8 km/h (95 percent), normal" in part
    assert "(90 percent), normal" in part


@pytest.mark.slow
def test_an_uncertainty_of_another_case_is_seen():
    text = report(crash(golf(vx="30 km/h")), form="markdown", uncertainty=spread())
    assert "of the propagation: are both of the same case?" in text
    assert re.search(r"Polo: delta-V, \d+\.\d+ \S+ in this impact, lies outside", text)


@pytest.mark.slow
def test_intervals_and_local_methods():
    interval = spread("b.delta_v", restitution=uncertainty.Interval(0.05, 0.15))
    ranges = report(crash(), form="markdown", uncertainty=interval)
    part = section(ranges, "Uncertainty, given the stated inputs")
    assert "mean, wherever in the intervals the truth is" in part
    assert "variance from" not in part
    local = spread("b.delta_v", method="first_order")
    assert ", seed" not in section(
        report(crash(), form="markdown", uncertainty=local), "Uncertainty, given the stated inputs"
    )
    page = Page(report(rear_end(), uncertainty=local))
    # A local method has contributions, and nothing that was drawn.
    assert page.tags.count("svg") == 2 + 1
    pictured = Page(report(rear_end(), uncertainty=interval))
    assert any("Not drawn: " in text for text in pictured.of("p"))


@pytest.mark.slow
def test_figures_show_this_impact(impacts):
    drawn = Page(
        report(impacts["eccentric"], units="metric", outline_a=(4.2, 1.8), outline_b=(4.0, 1.7))
    )
    assert drawn.tags.count("svg") == 4
    assert {"scene.a.outline", "scene.b.outline", "scene.contact", "energy.figure_1"} <= set(
        drawn.ids
    )
    assert any("54.0 km/h" in text for text in drawn.of("text"))
    assert "svg" not in Page(report(impacts["wall"], figures=False)).tags
    assert "The figures are in the HTML form" in report(impacts["wall"], form="markdown")


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in IMPACTS if name != "evil"])
def test_every_letter_of_a_figure_can_be_read(name, impacts):
    """Math text would stand on the page as its source: formulas are off there, as names
    are none.
    """
    spreads = spread("b.delta_v", "own") if name == "eccentric" else None
    printed = Page(report(impacts[name], uncertainty=spreads)).of("text")
    assert (
        sum(bool(re.fullmatch(r"\u2212?[\d.]+", text)) for text in printed) >= 4
    )  # the axis of energy alone
    assert not set("".join(printed)) & set("$\\{}")


@pytest.mark.slow
def test_figures_leave_nothing_open_and_the_least_are_two(impacts):
    import matplotlib.pyplot as plt

    before = plt.get_fignums()
    assert Page(report(impacts["wall"])).tags.count("svg") == 2
    assert plt.get_fignums() == before


def test_without_matplotlib_the_rest_is_there(impacts, monkeypatch):
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    text = report(impacts["eccentric"])
    assert "svg" not in Page(text).tags
    assert "python -m pip install matplotlib" in html.unescape(text)
    assert replay(text) == impacts["eccentric"]


@pytest.mark.slow
def test_importing_it_does_not_import_matplotlib_or_pint():
    code = "import sys, collisions.reporting; assert not {'matplotlib', 'pint'} & set(sys.modules)"
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)


def test_the_derivation_is_that_of_explain(impacts):
    impact = impacts["pinned"]
    page = report(impact, derivation=True, figures=False)
    steps = explain(impact)
    assert page.count("<math ") >= steps.count("$$") // 2 > 20
    assert "<code>" not in page
    # Every number of the formulas, in order: 1.5 of a formula is one <mn>.
    numbers = re.findall(r"<mn>([\d.]+)</mn>", page)
    formulas = re.findall(r"\$\$(.+?)\$\$|(?<![\\$])\$([^$]+?)\$", steps, re.DOTALL)
    assert numbers == re.findall(r"\d+(?:\.\d+)?", " ".join(map("".join, formulas)))
    text = report(impact, form="markdown", units="si", derivation=True)
    assert explain(impact, units="si").split("\n## Given\n")[1].split("\n## ")[0].strip() in text


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        ({"form": "pdf"}, "bad_option", "form must be one of 'html', 'markdown', got 'pdf'"),
        (
            {"units": "imperial"},
            "bad_option",
            "units must be 'si', 'metric' or 'us', got 'imperial'",
        ),
        ({"figures": "no"}, "bad_option", "figures must be True or False"),
        ({"derivation": 1}, "bad_option", "derivation must be True or False"),
        ({"title": 7}, "not_a_text", "title must be a text that says something, got 7"),
        ({"title": "  "}, "not_a_text", "title must be"),
        (
            {"notes": 7},
            "not_a_text",
            "notes must be a text, a list of texts, or a dict of them by input, got int",
        ),
        (
            {"notes": ["a", None]},
            "not_a_text",
            "notes must be a text that says something, got None",
        ),
        ({"uncertainty": {"energy_loss": 3.0}}, "bad_option", "explain(impact, uncertainty=...)"),
        ({"share_a": 1.5}, "bad_fraction", "share_a"),
        ({"outline_a": 3.0}, "bad_shape", "outline_a must be"),
        ({"duration": "3 m"}, "bad_units", "duration"),
        ({"limits": {"nothing": 1.0}}, "unknown_finding", "there is no finding 'nothing'"),
    ],
)
def test_refusals_of_options(change, code, said, impacts):
    with pytest.raises(col.InputError, match=re.escape(said)) as caught:
        report(impacts["eccentric"], **{"form": "markdown", **change})
    assert caught.value.code == code


def test_refusals_of_impacts():
    with pytest.raises(col.ShapeError, match=re.escape("write report(impact.case(0))")) as caught:
        report(col.linear_central(golf(vx=[10.0, 12.0]), col.Vehicle(mass=900), 0.1))
    assert caught.value.code == "bad_shape"
    refused = col.linear_central(golf(vx=-1.0), col.Vehicle(mass=900), 0.1, on_failure="nan")
    with pytest.raises(col.InputError, match="the bodies move apart along the normal") as caught:
        report(refused)
    assert (caught.value.code, caught.value.fields["status"]) == ("refused_impact", "separating")
    for other in (None, 7.0, crash().to_dict()):
        with pytest.raises(col.InputError, match="impact must be an Impact") as caught:
            report(other)
        assert caught.value.code == "not_an_impact"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            lambda r: r["impact"]["inputs"]["a"].update(vx="64 km/h"),
            "a.vx was given as '64 km/h', which is 15.0 in",
        ),
        (
            lambda r: r["impact"]["inputs"]["b"].update(course="90 deg"),
            "b.vy was given as '30 km/h at 90 deg'",
        ),
        (
            lambda r: r["impact"]["inputs"]["b"].update(heading="-80 deg"),
            "b.heading was given as '-80 deg'",
        ),
        (
            lambda r: r["other_texts"]["a"].update(vx="64 km/h"),
            "a.vx was given as '64 km/h', which is not its number, 15.0 m/s",
        ),
        (lambda r: r["other_texts"]["b"].update(course="90 deg"), "b.course was given as '90 deg'"),
        (lambda r: r["other_texts"]["a"].update(mass="5 m"), "a.mass was given as '5 m', which is"),
        (lambda r: r["other_texts"]["a"].update(mass="abc"), "a.mass was given as 'abc', which is"),
        (lambda r: r["other_texts"]["a"].update(mass="65"), "a.mass was given as '65', which is"),
        (lambda r: r["other_texts"]["b"].update(speed="40 km/h"), "b.speed was given as '40 km/h'"),
        (
            lambda r: r["other_texts"]["a"].update(tyres="4"),
            "a has no 'tyres' that could have been given",
        ),
        (lambda r: r["other_texts"]["a"].update({"pivot[0]": "1 m"}), "a has no 'pivot[0]'"),
        (lambda r: r["other_texts"]["a"].update({"mass[0]": "1 kg"}), "a has no 'mass[0]'"),
        (lambda r: r["other_texts"].update(b=[1]), "how b was given is no dict"),
        (lambda r: r.pop("other_texts"), "how else a and b were given"),
        (lambda r: r.update(format="x"), "not of the format 'collisions report 2'"),
        (lambda r: r.update(impact=3), "it has no impact"),
        (
            lambda r: r["impact"]["inputs"].update(model="none"),
            "record is not what Impact.to_dict() gives",
        ),
        (lambda r: r["impact"]["inputs"]["a"].update(mass=-5.0), "mass"),
    ],
)
def test_a_record_that_was_changed_is_refused(change, said):
    with pytest.raises(col.InputError, match=re.escape(said)):
        replay(tampered(report(crash(), form="markdown"), change))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            lambda r: r["impact"]["inputs"].update(restitution=0.2),
            "its inputs do not give its restitution, 0.1, but 0.2",
        ),
        (
            lambda r: r["impact"]["results"].update(energy_loss=3.0),
            "its inputs do not give its energy_loss, 3.0, but 89100",
        ),
        (
            lambda r: r["impact"]["results"]["b"].update(delta_v=12.0),
            "its inputs do not give its b.delta_v, 12.0, but 11.0",
        ),
        (
            lambda r: r["impact"]["results"].update(kind="plastic"),
            "its inputs do not give its kind, 'plastic', but 'elastoplastic'",
        ),
    ],
)
def test_results_of_a_record_must_be_those_of_its_inputs(change, said):
    """Whoever changes an input or a result alone is found out."""
    page = report(
        col.linear_central(col.Vehicle(mass=900, vx=20.0), col.Vehicle(mass=900), 0.1),
        form="markdown",
    )
    with pytest.raises(col.InputError, match=re.escape(said)) as caught:
        replay(tampered(page, change))
    assert (caught.value.code, caught.value.fields["argument"]) == ("bad_record", "text")
    # What another machine may round is let through.
    assert (
        replay(
            tampered(page, lambda r: r["impact"]["results"].update(energy_loss=89100.000001))
        ).energy_loss
        == 89100.0
    )


@pytest.mark.slow
def test_a_number_beyond_floats_is_no_number_of_the_record():
    """JSON holds whole numbers of any size; wherever one stands it is refused, and named as what
    the inputs do not give.
    """
    page = report(crash(), form="markdown")
    for huge in (10**400, -(10**400)):
        with pytest.raises(col.InputError, match="its inputs do not give its energy_loss"):
            replay(
                tampered(page, lambda r, huge=huge: r["impact"]["results"].update(energy_loss=huge))
            )
        for part in ("inputs", "results"):
            for name in tuple(json.loads(json.dumps(crash().to_dict()))[part]):
                with pytest.raises(col.InputError):
                    replay(
                        tampered(
                            page,
                            lambda r, huge=huge, part=part, name=name: r["impact"][part].update(
                                {name: huge}
                            ),
                        )
                    )


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (None, "not_a_text"), ("", "no_record"), ("# A page\n", "no_record"),
            ("<html></html>", "no_record"),
        ("```json\n{\n```", "bad_record"), ("```json\n[]\n```", "bad_record"),
            (f"```json\n{'[' * 100_000}\n```", "bad_record"),
    ],
)  # fmt: skip
def test_what_is_no_report_is_refused(text, code):
    for read in (replay, options):
        with pytest.raises(col.InputError) as caught:
            read(text)
        assert caught.value.code == code
        assert "options are none" not in str(caught.value)


@pytest.mark.slow
@pytest.mark.parametrize("unit", ["slugfest", "slug14"])
def test_a_unit_of_another_registry_is_kept_as_it_was_written(unit):
    registry = pint.UnitRegistry()
    registry.define(f"{unit} = 14.6 kg")
    a, b = golf(mass=registry.Quantity(100.0, unit)), col.Vehicle(mass=900)
    impact = col.linear_central(a, b, 0.1)
    page = report(impact, form="markdown")
    assert ("A (Golf)", "mass", f"1460 kg, given as 100.0 {unit}") in rows(page)
    assert report(replay(page), form="markdown") == page


@pytest.mark.slow
def test_a_record_can_be_read_where_the_unit_of_another_registry_is_known(monkeypatch):
    registry = pint.UnitRegistry()
    registry.define("slugfest = 14.6 kg")
    mass = registry.Quantity(100.0, "slugfest")
    impact = col.linear_central(golf(mass=mass), col.Vehicle(mass=900), 0.1)
    page = report(impact, form="markdown")
    known = pint.UnitRegistry()
    known.define("slugfest = 14.6 kg")
    monkeypatch.setattr(pint.application_registry, "_registry", known)
    assert replay(page) == impact


# Inputs stand on the page as they were given.


def in_texts():
    """The scene of ``crash`` with units on every number of the contact."""
    return col.eccentric(
        golf(),
        polo(),
        "10 %",
        normal="10 deg",
        point=("1 in", UREG.Quantity(2.0, "inch")),
        friction="0.5",
    )


@pytest.mark.slow
def test_the_contact_is_shown_as_given():
    """In SI and in the units of the page; what reads the same is not said twice."""
    si, us = (rows(report(in_texts(), form="markdown", units=units)) for units in ("si", "us"))
    assert ("contact", "normal, direction from A into B", "10°") in si
    assert ("contact", "normal, direction from A into B", "10°") in us
    # An inch is 0.0254 m and a twelfth of a foot.
    assert ("contact", "contact point (x, y)", "0.0254 m, 0.0508 m, given as 1 in, 2.0 inch") in si
    assert (
        "contact",
        "contact point (x, y)",
        "0.0833 ft, 0.1667 ft, given as 1 in, 2.0 inch",
    ) in us
    assert ("contact", "restitution e", "0.1, given as 10 %") in si
    for rule in ("impulse_ratio", "critical_fraction"):
        page = report(crash(**{rule: "10 %"}), form="markdown")
        assert ("contact", rule.replace("_", " "), "0.1, given as 10 %") in rows(page)
        assert report(replay(page), **options(page)) == page


def test_no_value_is_said_to_be_si_that_was_not():
    """Also one of a batch, of which the unit is kept but no text."""
    many = col.linear_central(
        golf(vx=UREG.Quantity([36.0, 54.0], "km/h")), col.Vehicle(mass=900), "20 %"
    )
    page = report(many.case(0), form="markdown")
    assert "SI numbers" not in page
    assert ("A (Golf)", "velocity along x", "36 km/h") in rows(page)
    # What was one number for all cases keeps its text.
    assert ("A (Golf)", "mass", "1500 kg") in rows(page)
    assert ("contact", "restitution e", "0.2, given as 20 %") in rows(page)


def test_the_schema_is_a_new_dict_in_every_part():
    """It may be changed, as its docstring says: the next one is whole."""
    parts, written = [impact_schema()], json.dumps(impact_schema())
    for part in parts:
        parts += [
            one
            for one in (part.values() if isinstance(part, dict) else part)
            if isinstance(one, (dict, list))
        ]
    for part in parts:
        part.clear()
    assert json.dumps(impact_schema()) == written


@pytest.mark.slow
@pytest.mark.parametrize("make", ["in_texts", "solved", "of a batch"])
def test_texts_go_with_the_impact(make):
    """Through solve, pickle, record and a case of a batch; the impact is that of its numbers."""
    given = {"normal": "10 deg", "point[0]": "1 in", "restitution": "10 %"}
    contact = {"normal": "10 deg", "point": ("1 in", 0.0), "friction": 0.5}
    plain = {"normal": math.radians(10.0), "point": (0.0254, 0.0), "friction": 0.5}
    if make == "in_texts":
        impact, same = (
            col.eccentric(golf(), polo(), e, **where)
            for e, where in (("10 %", contact), (0.1, plain))
        )
    elif make == "solved":
        impact, same = (
            col.solve(golf(), polo(), e, **where) for e, where in (("10 %", contact), (0.1, plain))
        )
    else:
        impact = col.eccentric(golf(vx=[15.0, 16.0]), polo(), "10 %", **contact).case(0)
        same = col.eccentric(golf(vx=15.0), polo(), 0.1, **plain)
    assert impact.b.delta_v == pytest.approx(same.b.delta_v, rel=1e-12)
    record = json.loads(json.dumps(impact.to_dict()))
    jsonschema.validate(record, impact_schema())
    inputs = record["inputs"]
    assert (inputs["restitution"], inputs["normal"], inputs["point"]) == (
        "10 %",
        "10 deg",
        ["1 in", 0.0],
    )
    for one in (impact, pickle.loads(pickle.dumps(impact)), col.Impact.from_dict(record)):
        assert one == impact
        assert one.inputs.given == given
        assert json.loads(json.dumps(one.to_dict())) == record
    assert same.inputs.given is None
    assert same.to_dict()["inputs"]["restitution"] == 0.1
    assert replay(report(impact, form="markdown")) == impact


def solved_backwards():
    """What each reverse solver was given, in texts."""
    central = reconstruct.central("2425 lb", "2094 lb", va="50 mph", vb="0 mph", vb_after="37 mph")
    end = crash(friction=0.02)
    after = {
        label: side.after.replace(vx=f"{side.after.vx!r} m/s")
        for label, side in (("a", end.a), ("b", end.b))
    }
    contact = {"normal": "10 deg", "point": (0, 0), "friction": 0.5}
    planar = reconstruct.planar(
        after["a"],
        after["b"],
        closing_speed=f"{end.closing_speed:.12g} m/s",
        regime="sliding",
        **(contact | {"friction": 0.02}),
    )
    (speeds, *_) = reconstruct.speeds(golf(), polo(), course_a="0 deg", course_b="-90 deg",
        speed_b="30 km/h",
                                      delta_v_a="5 m/s", restitution="10 %", **contact)  # fmt: skip
    return {"central": central, "planar": planar, "speeds": speeds}


@pytest.mark.slow
@pytest.mark.parametrize("solver", ["central", "planar", "speeds"])
def test_what_a_reverse_solver_was_given_stands_on_its_report(solver):
    """As text; and the texts of what stayed as it was given, the mass."""
    impact = solved_backwards()[solver]
    page = report(impact, form="markdown", units="si")
    shown = rows(page)
    wanted = {
        # A pound is 0.45359237 kg and a mile per hour 0.44704 m/s.
        "central": [("A", "mass", "1100 kg, given as 2425 lb"),
        ("A", "velocity along x", "22.352 m/s, given as 50 mph"),
                    ("evidence", "velocity of B after", "16.54 m/s, given as 37 mph")],
        "planar": [("A (Golf)", "mass", "1500 kg"),
        ("evidence", "closing speed",
            f"{impact.closing_speed:.4g} m/s, given as {impact.closing_speed:.12g} m/s")],
        "speeds": [("A (Golf)", "mass", "1500 kg"),
        ("evidence", "speed of the Polo before", "8.333 m/s, given as 30 km/h"),
                   ("evidence", "course of the Polo before", "-90°"),
                       ("evidence", "delta-V of the Golf", "5 m/s"),
                   ("contact", "restitution e", "0.1, given as 10 %")],
    }  # fmt: skip
    for row in wanted[solver]:
        assert row in shown, row
    assert "given as" in section(page, "Inputs")
    again = replay(page)
    assert again == impact
    assert report(again, form="markdown", units="si") == page


@pytest.mark.parametrize(
    ("solver", "name", "text", "said"),
    [
        (
            "central",
            "vb_after",
            "40 mph",
            "vb_after was given as '40 mph', which is not its number, 16.540",
        ),
        ("planar", "closing_speed", "10 m/s", "closing_speed was given as '10 m/s'"),
        ("planar", "a_after.vx", "1 m/s", "a_after.vx was given as '1 m/s'"),
        ("speeds", "course_b", "-80 deg", "course_b was given as '-80 deg'"),
        ("speeds", "delta_v_a", "6 m/s", "delta_v_a was given as '6 m/s'"),
        ("speeds", "energy_loss", "6 J", "energy_loss was given as '6 J'"),
        ("speeds", "tyres", "4", "it has no 'tyres' that could have been given"),
    ],
)
def test_texts_that_a_reverse_solver_was_given_must_come_out(solver, name, text, said):
    page = report(solved_backwards()[solver], form="markdown")
    with pytest.raises(col.InputError, match=re.escape(said)):
        replay(tampered(page, lambda r: r["impact"]["inputs"]["known"].update({name: text})))


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.SuspectUnitsWarning")
def test_a_normal_without_a_unit_is_the_angle_of_the_normal():
    """A record cannot say that "5 deg" was given as a bare 1.0, nor as another angle."""
    for normal in ("5 deg", 7.0):
        page = report(crash(golf(), normal=normal), form="markdown")
        forged = tampered(page, lambda r: r["impact"]["inputs"].update({"bare_normal": 1.0}))
        with pytest.raises(col.InputError, match="bare_normal is not the angle of its normal"):
            replay(forged)
    # Of one normal there are not two angles.
    forged = tampered(page, lambda r: r["impact"]["inputs"].update({"bare_normal": [7.0, 7.0]}))
    with pytest.raises(col.InputError, match="bare_normal has the shape"):
        replay(forged)
    assert replay(page).inputs.bare_normal == 7.0


def test_a_number_that_four_figures_do_not_hold_is_shown_in_full():
    """What somebody typed; a number that was worked out has its digits in the record."""
    shown = rows(
        report(
            crash(golf(mass=1234.567, heading=math.pi / 7.0), e=0.1234567),
            form="markdown",
            units="us",
        )
    )
    assert ("A (Golf)", "mass", "2722 lb, exactly 1234.567 kg") in shown
    assert ("contact", "restitution e", "0.1235, exactly 0.1234567") in shown
    assert ("A (Golf)", "heading", "25.71°") in shown
    # 2600 kg m2 is what was typed, and no number of six figures in these units.
    assert ("B (Polo)", "mass", "2600 lb") in shown


# What the damage shows.


@pytest.mark.slow
def test_damage_that_contradicts_stands_on_the_page():
    """All that diagnose takes, among the inputs as given, and the findings they make."""
    evidence = {
        "crush_energy": "20 kJ", "damage_pdof_a": "40 deg", "damage_pdof_b": -1.0,
        "damage_delta_v_a": UREG.Quantity(50.0, "km/hour"),
        "damage_delta_v_b": 3.0,
    }  # fmt: skip
    page = report(crash(), form="markdown", units="si", **evidence)
    given = rows(section(page, "Inputs"))
    assert ("damage", "crush energy, both vehicles", "20000 J, given as 20 kJ") in given
    assert ("damage of A", "PDOF that the damage shows", "40°") in given
    assert ("damage of B", "PDOF that the damage shows", "-57.30°, exactly -1 rad") in given
    assert any(
        row[:2] == ("damage of A", "delta-V that the damage or the recorder shows")
        and "given as 50 km/h" in row[2]
        for row in given
    )
    found = {finding.code for finding in diagnose(crash(), **evidence)}
    assert {"momentum_energy", "pdof_off_damage", "delta_v_off_damage"} <= found
    printed = re.sub(r"\\(.)", r"\1", section(page, "Findings"))
    for code in found:
        assert f"**{label_of(code)}" in printed
    assert report(replay(page), **options(page)) == page


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"crush_energy": -1.0}, "negative_energy"),
        ({"damage_pdof_a": "3 m"}, "bad_units"),
        ({"damage_delta_v_b": [1.0]}, "bad_shape"),
        ({"drag": HOLDS_ITSELF}, "bad_shape"),
        ({"damage_delta_v_b": (HOLDS_ITSELF, HOLDS_ITSELF)}, "bad_shape"),
    ],
)
def test_evidence_is_refused_as_by_diagnose(change, code):
    with pytest.raises(col.InputError) as caught:
        report(crash(), form="markdown", **change)
    assert caught.value.code == code


def test_only_what_was_measured_is_counted():
    """Of point masses without outlines, evidence and reconstruction: what needs those is named as
    not made.
    """
    impact = col.oblique_central(
        golf(heading=None), polo(heading=None, x=4.0), 0.1, normal=0, friction=0.5
    )
    limits = dict.fromkeys([finding.code for finding in diagnose(impact)], math.inf)
    text = section(report(impact, form="markdown", limits=limits), "Findings").replace("\\", "")
    made = int(re.search(r"None of the (\d+) checks that were made found anything", text)[1])
    others = set(re.search(r"or are switched off\.\n\n(.*)\.", text)[1].split(", "))
    codes = (
        "near_collinear", "restitution_negative", "speed_backwards", "momentum_energy",
        "pdof_off_damage", "delta_v_off_damage", "delta_v_pair",
        "yaw_against_lever", "outlines_overlap", "outlines_gap", "outlines_interpenetrate",
        "point_outside", "ill_conditioned",
        "not_unique", *limits,
    )  # fmt: skip
    assert others >= {label_of(code) for code in codes}
    assert made == len(LIMITS) - len(others) == len(diagnose(impact, limits=limits).measured)
    with_outlines = diagnose(crash(), outline_a=(4.2, 1.8), outline_b=(4.0, 1.7), crush_energy=1.0)
    assert with_outlines.measured >= {"outlines_overlap", "point_outside", "momentum_energy"}
    assert pickle.loads(pickle.dumps(with_outlines)).measured == with_outlines.measured


# Uncertainty: what an interval leaves open, and what is only rounding.


def sliding(speed):
    """A contact that slides whatever the speed, so that the direction of its impulse stays."""
    answer = col.eccentric(
        golf(vx=speed), polo(), 0.1, normal="10 deg", point=(0, 0), friction=0.02
    )
    return {"impulse_ratio": answer.impulse_ratio, "a.pdof": answer.a.q.pdof}


@pytest.mark.slow
def test_an_interval_has_a_range_and_no_deviation():
    """The deviation within leaves out how far the interval goes."""
    inputs = {
        "speed": uncertainty.Interval("40 km/h", "70 km/h"),
        "restitution": uncertainty.Uniform(0.05, 0.15),
    }

    def model(speed, restitution):
        answer = crash(golf(vx=speed), e=restitution, on_failure="nan")
        return {
            "b.delta_v": answer.b.q.delta_v,
            "energy_loss": answer.q.energy_loss,
            "own": speed + restitution,
        }

    known = uncertainty.propagate(model, inputs, method="quasi_random", samples=64, seed=1)
    page = report(crash(), form="markdown", units="si", uncertainty=known, derivation=True)
    low, high = known["b.delta_v"].interval()
    assert high - low > 10.0 * max(known["b.delta_v"].std)
    assert not re.search(r"± [\d(]", page.split("```json")[0])
    assert page.count("m/s (") >= 2
    assert (
        "B (Polo)",
        "delta-V",
        f"{crash().b.delta_v:.1f} m/s ({low:.1f} to {high:.1f} m/s)",
    ) in rows(section(page, "Results"))
    # Two figures of half the width end at the first decimal.
    assert 1.0 < 0.5 * (high - low) < 9.95


@pytest.mark.slow
@pytest.mark.parametrize(("away", "centred"), [(0.09, True), (0.11, False), (-0.11, False)])
def test_a_deviation_stands_only_beside_the_mean_of_its_propagation(away, centred):
    """A tenth of the deviation off, ± would name another middle than the propagation has: its range
    is given.
    """
    impact = crash()
    mean = impact.closing_speed + 0.5 * away
    drawn = {"speed": uncertainty.Normal(mean, 0.5)}
    known = uncertainty.propagate(
        lambda speed: {"closing_speed": speed}, drawn, method="first_order"
    )
    low, high = mean - 0.98, mean + 0.98  # 1.96 deviations
    number = f"{impact.closing_speed:.2f}"
    stated = f"{number} ± 0.50 m/s" if centred else f"{number} m/s ({low:.2f} to {high:.2f} m/s)"
    page = report(impact, form="markdown", units="si", uncertainty=known)
    assert ("contact", "closing speed", stated) in rows(section(page, "Results"))
    steps = explain(impact, units="si", uncertainty=known)
    assert ("A range in brackets holds 95 percent of the propagation" in page) is not centred
    assert ("A range in brackets holds 95 percent of the propagation" in steps) is not centred
    assert stated in steps


@pytest.mark.slow
def test_intervals_alone_have_no_mean():
    inputs = {
        "speed": uncertainty.Interval("50 km/h", "58 km/h"),
        "restitution": uncertainty.Interval(0.05, 0.15),
    }
    known = uncertainty.propagate(lambda **given: {
    "b.delta_v": crash(golf(vx=given["speed"]), e=given["restitution"]).b.q.delta_v},
                                  inputs, method="interval")  # fmt: skip
    part = section(
        report(crash(), form="markdown", units="si", uncertainty=known),
        "Uncertainty, given the stated inputs",
    )
    low, high = known["b.delta_v"].interval()
    assert (
        "Polo: delta-V",
        "range, wherever in the intervals the truth is",
        f"{low:.2f} to {high:.2f} m/s",
    ) in rows(part)
    assert "mean" not in part
    assert "95 percent" not in part


@pytest.mark.slow
@pytest.mark.parametrize("method", ["quasi_random", "monte_carlo", "first_order"])
def test_rounding_is_no_deviation(method):
    """Of a ratio that is always the friction: no dust for digits, no shares of nothing, and no
    alarm.
    """
    options = {} if method == "first_order" else {"samples": 64, "seed": 1}
    known = uncertainty.propagate(
        sliding, {"speed": uncertainty.Normal("54 km/h", "1 km/h")}, method=method, **options
    )
    impact = crash(friction=0.02)
    page = report(impact, uncertainty=known, form="markdown", units="metric")
    part = section(page, "Uncertainty, given the stated inputs")
    assert [row[1:] for row in rows(part) if row[0] == "impulse ratio"] == [
        ("the same in every case", f"{impact.impulse_ratio:.3f}")
    ]
    assert "nan" not in part
    assert not re.search(r"\d\.\d{6}", part)
    assert "lies outside" not in page
    assert ("contact", "impulse ratio", f"{impact.impulse_ratio:.3f}") in rows(
        section(page, "Results")
    )
    drawn = Page(report(rear_end(), uncertainty=known))
    assert "impulse ratio has no figures, because it is the same in every case." in drawn.of("p")


@pytest.mark.slow
def test_shares_stay_within_0_and_100_percent():
    """A small sample puts some of them outside, by less than their error."""
    inputs = {
        "speed": uncertainty.Normal("54 km/h", "9 km/h"),
        "nothing": uncertainty.Normal(0.0, 1e-3),
    }

    def model(speed, nothing):
        return {
            "b.delta_v": crash(golf(vx=speed + 0.0 * nothing)).b.q.delta_v,
            "own": speed + nothing,
        }

    known = uncertainty.propagate(model, inputs, method="monte_carlo", samples=200, seed=3)
    shares = [share for name in known for share in known[name].contributions.values()]
    assert any(share > 1.005 or share < 0.0 for share in shares)
    part = section(
        report(crash(), form="markdown", units="si", uncertainty=known),
        "Uncertainty, given the stated inputs",
    )
    printed = [row[2] for row in rows(part) if row[1].startswith("variance")]
    assert printed
    for text in printed:
        share = r"(\d|[1-9]\d|100)( ± \d+)? %"
        assert re.fullmatch(f"{share}, in all {share}", text), text


# The page is made again from itself.


@pytest.mark.slow
def test_the_options_of_a_page_are_in_its_record():
    given = {
        "title": "Case 7", "units": "us", "outline_a": (4.2, 1.8),
        "outline_b": (("13 ft", 1.0), (-2.0, 1.0), (-2.0, -1.0)),
        "duration": UREG.Quantity(90.0, "ms"), "drag": 0.6,
        "limits": {"normal": math.inf, "pdof_off_damage": "20 deg"}, "share_a": "50 %",
        "notes": ["One.", "Two <b>."], "derivation": True, "damage_pdof_a": "10 deg",
        "crush_energy": 81e3,
    }  # fmt: skip
    for form in ("html", "markdown"):
        page = report(crash(), form=form, figures=False, **given)
        found = options(page)
        assert found.keys() == given.keys() | {"figures"} | (
            {"form"} if form == "markdown" else set()
        )
        assert found["limits"] == given["limits"]
        assert report(replay(page), **found) == page
    assert options(report(crash(), figures=False)) == {"units": "metric", "figures": False}
    drawn = uncertainty.propagate(lambda speed: {"own": speed},
    {"speed": uncertainty.Normal(15.0, 1.0)}, samples=64,
                                  method="quasi_random", seed=5)  # fmt: skip
    _, _, rest = report(crash(), form="markdown", uncertainty=drawn).partition("```json\n")
    assert json.loads(rest.partition("```")[0])["uncertainty"] == {
        "method": "quasi_random",
        "samples": 64,
        "seed": 5,
    }


@pytest.mark.slow
def test_a_unit_that_only_another_registry_has_is_kept_as_its_number():
    registry = pint.UnitRegistry()
    registry.define("blink = 0.3 s")
    page = report(crash(), form="markdown", duration=registry.Quantity(0.5, "blink"))
    assert options(page)["duration"] == 0.15
    assert report(replay(page), **options(page)) == page


@pytest.mark.parametrize("wrong", [3, {"tyres": 4}, {"outline_a": 3}, {"limits": 3}])
def test_options_that_report_does_not_take_are_refused(wrong):
    page = tampered(report(crash(), form="markdown"), lambda r: r.update(options=wrong))
    with pytest.raises(col.InputError, match="its options are none that report takes") as caught:
        options(page)
    assert caught.value.code == "bad_record"


@pytest.mark.slow
def test_a_byte_order_mark_does_no_harm():
    """Editors put one before the first letter."""
    for form in ("html", "markdown"):
        assert replay("\ufeff" + report(crash(), form=form, figures=False)) == crash()


def test_bad_records_name_the_text():
    page = report(crash(), form="markdown")
    for change in (
        lambda r: r["impact"]["inputs"]["a"].update(vx=-99.0),
        lambda r: r["impact"]["inputs"]["a"].update(mass=-5.0),
    ):
        with pytest.raises(col.InputError) as caught:
            replay(tampered(page, change))
        assert (caught.value.code, caught.value.fields["argument"]) == ("bad_record", "text")


@pytest.mark.slow
def test_a_name_with_half_a_letter_can_be_written():
    """A lone surrogate stands for no sign; the record keeps it."""
    impact = crash(golf(name="\ud800x"))
    page = report(impact, derivation=True, uncertainty=spread("b.delta_v"))
    assert Page(page.encode("utf-8").decode("utf-8")).tags.count("svg") >= 4
    assert replay(page).a.before.name == "\ud800x"
    assert report(impact, form="markdown", derivation=True).encode("utf-8")


@pytest.mark.parametrize("share", [[0.5], [0.5, 0.6]])
def test_a_share_of_many_cases_is_refused(share):
    with pytest.raises(col.ShapeError, match="share_a takes one value") as caught:
        report(crash(), share_a=share)
    assert caught.value.code == "bad_shape"


@pytest.mark.slow
def test_sticking_and_sliding_say_what_is_so():
    """The ratio has the sign of the slip; under "kudlich-slibar" slip ends, and may come back."""
    one_way, other_way = crash(friction=0.02), crash(golf(vy=-12.0), friction=0.02)
    assert one_way.regime == other_way.regime == "sliding"
    assert one_way.impulse_ratio * other_way.impulse_ratio < 0.0
    for impact in (one_way, other_way):
        assert "the impulse ratio has the size of the friction given" in report(
            impact, form="markdown"
        )
    back = crash(law="kudlich-slibar")
    assert back.slip_after * back.slip_before < 0.0
    ends = "slip ends during the contact, with less than the friction given"
    assert f"{ends}, and comes back." in report(back, form="markdown")
    for impact in (crash(), crash(law="kudlich-slibar", e=0.0)):
        assert impact.regime == "sticking"
        assert f"{ends}." in report(impact, form="markdown")


# Every row of the inputs is true.


def test_a_velocity_that_was_worked_out_says_of_what():
    """That of a pinned body of its yaw rate, and that of speed and course of these, which both
    stand there.
    """
    pin = {"x": 0.0, "y": 2.0, "pivot": (0.0, 0.0), "yaw_inertia": 1333.0, "yaw_rate": 0.5}
    a = col.Vehicle(mass=900, vx=20.0, yaw_inertia=2000.0, x=-2.0, y=4.0)
    hung = rows(
        report(
            col.eccentric(
                a, col.Vehicle(mass=1000, **pin), 0.1, normal=0, point=(0, 4), friction=0
            ),
            form="markdown",
        )
    )
    # 0.5 rad/s x 2 m, to the left of the arm.
    assert ("B", "velocity along x", "-1 m/s, worked out from yaw rate and pivot") in hung
    b = col.Vehicle.from_speed(
        speed="30 km/h", course=-0.5 * math.pi, mass=1200, yaw_inertia=2100, x=0.9, y=0.1
    )
    shown = rows(report(crash(b=b), form="markdown", units="metric"))
    assert ("B", "speed", "30 km/h") in shown
    assert ("B", "course", "-90°") in shown
    assert ("B", "velocity along y", "-30 km/h, worked out from speed and course") in shown


def test_half_a_place_as_text_says_which_half():
    """The other half keeps the digits that were typed."""
    shown = rows(report(crash(point=(0.123456789, "2 in")), form="markdown"))
    printed = "x: 0.1235 m, exactly 0.123456789 m; y: 0.0508 m, given as 2 in"
    assert ("contact", "contact point (x, y)", printed) in shown


@pytest.mark.slow
@pytest.mark.parametrize(
    "contact", [{"normal": (3.0, 4.0)}, {"normal": 6.2}, {"e": UREG.Quantity(10, "percent")}]
)
def test_no_row_is_said_to_be_as_it_was_given(contact):
    """What is kept of it is a number, of a normal its direction."""
    page = report(crash(**contact), form="markdown")
    assert "Any other was given so" not in page
    assert "The record at the end has every digit." in page


@pytest.mark.slow
def test_shares_of_a_corrected_model_say_what_is_no_input():
    """Where a correction leaves something; not where every case was asked of the finer model."""
    inputs = {"one": uncertainty.Normal(0.0, 1.0), "other": uncertainty.Normal(0.0, 1.0)}
    said = "the rest comes from interactions, and from what the correction does not foresee."
    for samples, left in ((1024, True), (256, False)):
        known = uncertainty.propagate(
            lambda one, other: {"sum": one + other},
            inputs,
            finer=lambda one, other: {"sum": one + other + 0.3 * np.sin(40.0 * one)},
            samples=samples,
            seed=2,
        )
        page = report(crash(), form="markdown", units="si", uncertainty=known)
        assert (said in page) is left
        assert ("the rest comes from interactions." in page) is not left


@pytest.mark.slow
def test_shares_of_inputs_that_act_together():
    """A product of two with mean 0: each has nothing by itself, and everything in all."""
    inputs = {"one": uncertainty.Normal(0.0, 1.0), "other": uncertainty.Normal(0.0, 1.0)}
    known = uncertainty.propagate(
        lambda one, other: {"product": one * other},
        inputs,
        method="quasi_random",
        samples=2048,
        seed=2,
    )
    part = section(
        report(crash(), form="markdown", units="si", uncertainty=known),
        "Uncertainty, given the stated inputs",
    )
    shown = {row[1]: row[2] for row in rows(part) if row[0] == "product"}
    for name in inputs:
        alone, in_all = re.findall(r"(\d+)(?: ± \d+)? %", shown[f"variance from {name}"])
        # Four standard errors, about 5 percent each.
        assert int(alone) < 20
        assert int(in_all) > 80
    assert int(shown["sum of the shares"].removesuffix(" %")) < 40
    assert "by more than their errors, the rest comes from interactions" in part
    # Sums have none: by themselves and in all are the same, and the shares make up the whole.
    linear = uncertainty.propagate(
        lambda one, other: {"sum": one + other}, inputs, method="first_order"
    )
    shown = rows(
        section(
            report(crash(), form="markdown", uncertainty=linear),
            "Uncertainty, given the stated inputs",
        )
    )
    assert ("sum", "variance from one", "50 %, in all 50 %") in shown
    assert ("sum", "sum of the shares", "100 %") in shown


def test_a_pivot_is_no_force_that_is_left_out(impacts):
    """And its tyres are an estimate, since where they act on its levers is not known."""
    printed = section(report(impacts["pinned"], form="markdown"), "Assumptions")
    assert "the forces of the tyres and all others but the pivot's are left out" in printed
    assert "(estimates, except what is marked as a bound)" in printed
    assert ("A", "delta-V from its own tyres, upper bound") in {row[:2] for row in rows(printed)}
    assert ("B", "delta-V from its own tyres, about") in {row[:2] for row in rows(printed)}
    free = section(report(impacts["eccentric"], form="markdown"), "Assumptions")
    assert "the forces of the tyres and all others are left out" in free


# A record is whole, and its words are no part of what is compared.


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda results: results.pop("energy_loss"), "energy_loss, which is missing"),
        (lambda results: results["a"].pop("delta_v"), "a.delta_v, which is missing"),
        (lambda results: results["a"]["after"].pop("vx"), "a.after.vx, which is missing"),
        (lambda results: results.update(blame=1.0), "blame, which no impact has"),
        (lambda results: results["b"].update(injury=1.0), "b.injury, which no impact has"),
    ],
)
def test_results_of_a_record_are_all_there_and_no_others(change, said):
    page = tampered(report(crash(), form="markdown"), lambda r: change(r["impact"]["results"]))
    with pytest.raises(col.InputError, match=re.escape(said)) as caught:
        replay(page)
    assert caught.value.code == "bad_record"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"mass": ', '"mass": "2200 kg", "mass": ', "it has 'mass' twice"),
        ('"delta_v": ', '"delta_v": 1.0, "delta_v": ', "it has 'delta_v' twice"),
        ('"impact": ', '"statements": ["All is well."], "impact": ', "it has statements, which no"),
        ('"inputs": ', '"checked": true, "inputs": ', "it has impact.checked, which no record of"),
    ],
)
def test_a_record_has_no_name_twice_and_none_that_nothing_reads(old, new, said):
    """A reader of the page sees them, and other readers of JSON take the first of two."""
    page = report(crash(), form="markdown")
    with pytest.raises(col.InputError, match=re.escape(said)) as caught:
        replay(page.replace(old, new, 1))
    assert caught.value.code == "bad_record"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"version": None}, "its version is None"),
        ({"version": {"a": 1}}, "its version is {'a': 1}"),
        *(
            ({"version": text}, f"its version is {text!r}")
            for text in ("", "0.2.0x", "x", "0.2.", "0.2.0 ", "0.2.0\n", "0..2", "\u0660.2")
        ),
        ({"options": {"checked": True}}, "its options are none that report takes"),
        ({"options": "form"}, "its options are none that report takes"),
        ({"uncertainty": {"checked": True}}, "it has uncertainty.checked, which no record of"),
        ({"uncertainty": True}, "its uncertainty has no method, samples and seed"),
    ],
)
def test_what_a_record_has_beside_its_results_is_what_a_page_has(change, said):
    page = report(crash(), form="markdown")
    with pytest.raises(col.InputError, match=re.escape(said)) as caught:
        replay(tampered(page, lambda r: r.update(change)))
    assert caught.value.code == "bad_record"


def test_the_reason_of_a_choice_may_be_worded_otherwise_by_another_version(impacts):
    """Its numbers may not."""
    impact = impacts["solve, linear"]
    page = report(impact, form="markdown")
    worded = tampered(page, lambda r: r["impact"]["results"]["choice"].update(reason="Another."))
    with pytest.raises(col.InputError, match=r"its inputs do not give its choice\.reason"):
        replay(worded)
    for other in ("0.1.0", "1.0", "0.3.0rc1", "0.3.0.dev12+g1a2b3c4.d20260101", "1.0.post1"):
        assert replay(tampered(worded, lambda r, other=other: r.update(version=other))) == impact
    with pytest.raises(col.InputError, match=r"its inputs do not give its choice\.errors"):
        replay(
            tampered(
                page,
                lambda r: r["impact"]["results"]["choice"]["errors"].update(linear_central=3.0),
            )
        )


# Planar momentum and fits


def crossed(**changes):
    """Two cars at right angles, with every kind of argument."""
    given = {
        "course_a": "270 deg",
        "course_b": 0.0,
        "course_a_after": "-30 deg",
        "course_b_after": UREG.Quantity(-40, "deg"),
        "speed_a_after": "30 km/h",
        "speed_b_after": UREG.Quantity(50, "km/h"),
        "heading_a": "-90 deg",
        "normal": (-1, "-2"),
        "outside_impulse": (300.0, "-0.1 kN*s"),
    }
    return reconstruct.momentum("1200 kg", 1800, **(given | changes))


MOMENTA = {
    "all": crossed,
    "plain": lambda: crossed(normal=None, outside_impulse=None),
    "normal of one angle": lambda: crossed(
        normal="-20 deg", outside_impulse=UREG.Quantity([0.3, 0.1], "kN*s")
    ),
    "bare normal": lambda: crossed(normal=-0.3),
    "together": lambda: reconstruct.momentum(
        1200,
        1800,
        course_a="90 deg",
        course_b=0.0,
        course_a_after="40 deg",
        speed_a_after="8 m/s",
        together=True,
    ),
    "energy gain": lambda: crossed(
        speed_a_after="90 km/h", course_a_after="150 deg", outside_impulse=None
    ),
}


def momentum_of(name):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        return MOMENTA[name]()


@pytest.mark.slow
@pytest.mark.parametrize("form", ["html", "markdown"])
@pytest.mark.parametrize("name", MOMENTA)
def test_planar_momentum_has_a_report_that_can_be_made_again(name, form):
    for units in ("si", "metric", "us"):
        page = report(
            momentum_of(name),
            form=form,
            units=units,
            derivation=True,
            damage_delta_v_a="9 m/s",
            title="Crossing",
        )
        again = replay(page)
        assert isinstance(again, reconstruct.MomentumSolution)
        assert report(again, **options(page)) == page
        if form == "html":
            assert Page(page).tags.count("svg") == 1
    if name == "energy gain":
        assert page.index("Energy gain of") < page.index("Inputs")


@pytest.mark.slow
def test_inputs_and_answers_of_planar_momentum_are_shown():
    """The answers are those of explain, the sensitivities those of the solution with its units."""
    solution = crossed()
    page = report(solution, form="markdown", units="metric")
    found = rows(page)
    assert ("B", "speed after", "50 km/h") in found
    assert ("A", "course before", "270°") in found
    assert ("contact", "normal, direction from A into B", "-116.6°") in found
    assert ("both", "impulse from outside, along y", "-0.1 kN·s") in found
    printed = explain(solution, units="metric")
    assert {
        (of, what, typeset(value))
        for of, what, value in rows(printed[printed.index("## Answers") :])
    } <= set(found)
    moved = solution.q.sensitivity["speed_a"]["course_b_after"].m_as("km/h/deg")
    assert ("speed of A before", "moved by course of B after", f"{moved:+.3g} km/h per °") in found
    assert f"{len(diagnose(solution).measured)} checks" in section(page, "Findings")
    known = uncertainty.propagate(
        lambda speed: {"speed_a": crossed(speed_a_after=speed, on_failure="nan").q.speed_a},
        {"speed": uncertainty.Normal("30 km/h", "3 km/h")},
        method="first_order",
    )
    page = report(solution, form="html", units="metric", uncertainty=known)
    assert any(" ± 1.5 km/h" in text for text in Page(page).of("td"))
    # One input and nothing drawn: its share of the variance is no figure.
    assert "None: the variance is all of one input, and no cases were drawn." in Page(page).of("p")
    assert Page(page).tags.count("svg") == 1
    assert "A: speed before" in Page(page).of("caption")


@pytest.mark.slow
def test_samples_drawn_together_are_told_without_shares():
    """A joint group has all variance; bare numbers are SI, and in the unit of the page where their
    input is the impact's.
    """
    impact = crash(golf(vx=15.0))
    values = np.linspace(14.0, 16.0, 64)
    columns = {
        "speed_a": values,
        "normal": values / 15.0 * impact.normal_angle,
        "restitution": values / 150.0,
        "speed_b": values,
    }
    known = uncertainty.propagate(
        lambda speed_a, **_: {"a.before.speed": 1.0 * speed_a, "impulse_ratio": speed_a / 1000.0,
        "own": speed_a},
        uncertainty.Samples.joint(**columns),
        method="quasi_random", samples=64, seed=1,
    )  # fmt: skip
    page = report(impact, form="markdown", units="metric", uncertainty=known)
    shown = rows(section(page, "Uncertainty, given the stated inputs"))
    assert {of for of, *_ in shown} == {
        "of",
        "Golf: speed before",
        "impulse ratio",
        "own",
        "Inputs as stated",
    }
    assert not any("variance" in what or "shares" in what for _, what, _ in shown)
    stated = {what: text for of, what, text in shown if of == "Inputs as stated"}
    assert stated["speed of the Golf before"] == "one of 64 values from 50.4 km/h to 57.6 km/h"
    assert stated["normal, direction from A into B"] == "one of 64 values from 9.333° to 10.67°"
    assert stated["restitution"] == "one of 64 values from 0.09333 to 0.1067"
    # That of B is another: whether this one is a speed is not known.
    assert (
        stated["speed of the Polo before"] == "one of 64 values from 14 to 16, given without a unit"
    )
    drawn = Page(report(impact, units="metric", uncertainty=known))
    assert any(
        ". Golf: speed before, in the cases drawn" in text for text in drawn.of("figcaption")
    )
    assert any("Golf: speed before" in text for text in drawn.of("text"))
    assert not any("share of its variance" in text for text in drawn.of("figcaption"))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"mass_a": "1200 kg"', '"mass_a": "1300 kg"', "its inputs do not give its mass_a"),
        ('"mass_b": 1800.0', '"mass_c": 1800.0', "mass_c"),
        ('"mass_b": 1800.0', '"mass_b": "1800 km"', "mass_b"),
        ('"delta_v_a": 1', '"delta_v_a": 2', "its inputs do not give its delta_v_a"),
        ('"inputs": {', '"inputs": 3, "other": {', "cannot be used"),
        ('"momentum": {', '"momentum": 3, "other": {', "cannot be used"),
    ],
)
def test_a_record_of_planar_momentum_that_was_changed_is_refused(old, new, said):
    page = report(crossed(), form="markdown")
    assert page.count(old) >= 1
    with pytest.raises(col.InputError, match=re.escape(said)) as caught:
        replay(page.replace(old, new, 1))
    assert caught.value.code == "bad_record"


def fitted():
    speeds = {
        "speed_golf": uncertainty.Interval("0 km/h", "150 km/h"),
        "speed <b>": uncertainty.Normal("52 km/h", "5 km/h"),
    }

    def model(**speed):
        return {"east": 1800 * speed["speed <b>"], "south": 1200 * speed["speed_golf"]}

    return reconstruct.fit(
        model, speeds, {"east": ("27.8 kN*s", "1300 N*s"), "south": (21e3, 1300.0)}
    )


@pytest.mark.slow
@pytest.mark.parametrize("form", ["html", "markdown"])
def test_a_fit_has_a_report(form):
    found = fitted()
    page = report(found, form=form, units="metric", notes="One.", derivation=True)
    assert report(found, **options(page)) == page
    if form == "html":
        record = "".join(text for text in Page(page).of("pre") if "collisions report 2" in text)
        assert "speed <b>" in Page(page).of("caption")
    else:
        record = page.rpartition("```json\n")[2].rpartition("```")[0]
        for name, one in found.residuals.items():
            assert (
                name,
                "stated less computed, over the standard error",
                f"{one.over_sigma:+.2f}",
            ) in rows(page)
        assert (
            "speed_golf",
            "estimate",
            f"{3.6 * found['speed_golf'].value:.1f} ± 3.9 km/h",
        ) in rows(page)
        assert ("east", "observed", "27.8 kN·s ± 1.3 kN·s") in rows(page)
    assert json.loads(record)["fit"] == json.loads(json.dumps(found.to_dict()))
    with pytest.raises(col.InputError, match="its model is code") as caught:
        replay(page)
    assert caught.value.code == "no_record"


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["outline_a", "share_a", "drag", "duration", "limits", "crush_energy", "damage_pdof_a"]
)
def test_options_that_an_answer_has_no_part_for_are_refused(name):
    given = {"outline_a": (4.0, 1.8), "limits": {"restitution": 0.9}}.get(name, 0.4)
    for answer in (fitted(), crossed()) if name in ("outline_a", "share_a") else (fitted(),):
        with pytest.raises(col.InputError, match=f"{name} is for an Impact") as caught:
            report(answer, **{name: given})
        assert (caught.value.code, caught.value.fields["argument"]) == ("bad_option", name)
    with pytest.raises(col.InputError, match="standard errors of its unknowns"):
        report(fitted(), uncertainty=spread("own", method="first_order"))


@pytest.mark.parametrize("outline", [np.array([[0, 4], [200, 0]]), np.zeros((4, 2)), [(1.0, 2.0)]])
def test_an_outline_of_momentum_is_refused_whatever_it_is(outline):
    """An array is not compared with what is usual."""
    found = reconstruct.momentum(
        1000.0,
        1200.0,
        course_a=0.0,
        course_b=1.5,
        course_a_after=0.5,
        course_b_after=0.7,
        speed_a_after=10.0,
        speed_b_after=8.0,
    )
    with pytest.raises(col.InputError, match="outline_a is for an Impact"):
        report(found, outline_a=outline)


@pytest.mark.slow
def test_each_vehicle_has_one_table_and_the_evidence_is_not_called_stated():
    """Rows of A and B may alternate; the evidence is computed."""
    found = col.reconstruct.momentum(
        1500, 1300, course_a=0.0, course_b="90 deg", course_a_after="35 deg",
        course_b_after="50 deg",
        speed_a_after=10.0, speed_b_after=11.0,
    )  # fmt: skip
    page = report(found)
    inputs = page[page.index("Inputs</h2>") : page.index("Results</h2>")]
    assert re.findall('<th scope="col">(.*?)</th>', inputs) == ["A", "B"]
    assert "<caption>" not in inputs
    priors, seen = {"x": col.uncertainty.Uniform(0.0, 1.0)}, {"x": col.uncertainty.Normal(0.5, 0.1)}
    text = report(
        col.reconstruct.posterior(lambda x: {"x": x}, priors, seen, samples=512, seed=1),
        form="markdown",
        figures=False,
    )
    (line,) = [line for line in text.splitlines() if "log evidence" in line]
    assert "stated" not in line


def published(impact, what):
    """The published values that a page has beside one of its inputs."""
    page = report(impact, form="markdown")
    return re.findall(rf"\| \w+ \| {what} published [^|]* \| ([^|]*) \|", page), page


@pytest.mark.slow
def test_the_published_drag_stands_beside_the_drag_with_its_source(impacts):
    """The manual of Baker, travelled dry asphalt: 0.60 to 0.80 below 30 mph, 0.55 to 0.70 above."""
    impact = impacts["eccentric"]
    found, page = published(impact, "drag")
    text = (
        "0.6 to 0.8 below 30 mph, 0.55 to 0.7 from there on (Baker, Traffic Accident "
        "Investigation Manual)"
    )
    assert found == [text]
    assert "| contact | drag of the tyres taken | 0.7 |" in page
    assert "drag published for locked wheels on travelled dry asphalt" in page
    assert (
        "For comparison with the drag: drag factor, travelled dry asphalt, above 30 mph; Baker"
        in page
    )
    place = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5}
    a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=20.0, x=-2.2, y=0.0, heading=0.0)
    b = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, x=2.2, y=0.0, heading=0.0)
    followed = col.time_resolved(a, b, 0.1, **place, duration="100 ms", drag=0.7, geometry="fixed")
    assert published(followed, "drag")[0] == [text]


@pytest.mark.slow
def test_each_published_restitution_has_its_source():
    """By the closing speed: nothing below 2 mph, the fit up to 15 mph, a rule and tests above."""
    for speed, source in {
        "1 mph": "none: no value is published for so low a speed",
        ("3 mph"): (
            "0 to 0.54 (Cipriani and others, SAE 2002-01-0540, plus half the range of SAE 931842)"
        ),
        "40 mph": "0 to 0.3 (EDCRASH manual, to 0.25; tests, to 0.253; rounded up)",
    }.items():
        impact = col.linear_central(
            col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1500.0), 0.2
        )
        assert published(impact, "restitution")[0] == [source]


@pytest.mark.slow
def test_notes_stand_beside_drag_duration_outlines_and_law():
    a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=20.0, x=-2.2, y=0.0, heading=0.0)
    b = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, x=2.2, y=0.0, heading=0.0)
    place = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5}
    impact, outline = col.eccentric(a, b, 0.1, **place), ("4.2 m", "1.8 m")
    notes = {
        "drag": "Measured.",
        "duration": "Of the recorder.",
        "outline_a": "By the maker.",
        "law": "The usual one.",
    }
    page = report(impact, form="markdown", outline_a=outline, notes=notes)
    assert "| contact | duration taken | 0.1 s. Of the recorder. |" in page
    assert "| contact | drag of the tyres taken | 0.7. Measured. |" in page
    assert (
        "- **Outline of A:** 4.2 m long and 1.8 m wide, about the centre of mass. By the maker.\n"
        in page
    )
    assert "| contact | law of restitution | Brach. The usual one. |" in page
    assert report(replay(page), **options(page)) == page
    with pytest.raises(col.InputError, match="'outline_b', which is no input of this page"):
        report(impact, outline_a=outline, notes={"outline_b": "By the maker."})
    followed = col.time_resolved(a, b, 0.1, **place, duration="100 ms", drag=0.7, geometry="fixed")
    page = report(
        followed, form="markdown", notes={"drag": "Measured.", "duration": "Of the recorder."}
    )
    assert re.search(r"\| nominal duration \| [^|]*100 ms\. Of the recorder\. \|", page)
    assert "| drag of the tyres | 0.7. Measured. |" in page
    with pytest.raises(col.InputError, match="'law', which is no input of this page"):
        report(followed, notes={"law": "None here."})


@pytest.mark.slow
def test_delta_v_in_the_axes_of_the_vehicle_takes_the_spread_of_its_propagation(impacts):
    """As a recorder counts it: the row has the ±, the heading is in words, and explain derives what
    it prints.
    """
    impact, names = impacts["eccentric"], ("a.delta_v_forward", "a.delta_v_left")
    values = {name: getattr(impact.a, name[2:]) for name in names}
    known = uncertainty.propagate(
        lambda factor: {name: factor * value for name, value in values.items()},
        {"factor": uncertainty.Normal(1.0, 0.1)},
    )
    page = report(impact, form="markdown", units="us", uncertainty=known)
    working = col.explain(impact, units="us", form="text", uncertainty=known)
    for what in ("delta-V forward", "delta-V to the left (recorders count to the right)"):
        (text,) = (
            text
            for of, row, text in rows(section(page, "Results"))
            if of.startswith("A") and row == what
        )
        assert "±" in text
        assert (f"Golf: {what}", "mean ± standard deviation", text) in rows(page)
        assert what in working
        assert text in working
    assert "delta_v_forward" not in section(page, "Uncertainty, given the stated inputs")
    assert "Delta-V of A forward, from its heading psi_A (definition):" in working
    assert "Delta-V of A to its left (definition):" in working


def test_a_page_of_planar_momentum_compares_no_duration(impacts):
    """Momentum has none; the page of an impact tells what is left out in one."""
    source = "For comparison with the duration"
    assert source not in report(crossed(), form="markdown")
    assert source in section(report(impacts["eccentric"], form="markdown"), "References")


def test_the_basis_of_a_limit_is_no_name_in_python():
    """It is what the list of references calls the published value, which stands there with its
    source.
    """
    page = report(crash(friction=0.01), form="markdown", duration="3 s")
    told, listed = section(page, "Findings"), section(page, "References")
    assert "reference." not in told
    for name in (reference.INTER_VEHICLE_FRICTION.name, reference.CONTACT_DURATION.name):
        assert f"“{name}” (see References)" in told
        assert f"- {name}: " in listed


def test_numbers_that_have_no_unit_are_not_said_to_be_in_si_units():
    """A drag factor; what an input of another name is, nobody can tell."""
    inputs = {"drag": uncertainty.Interval(0.6, 0.8), "friction_b": uncertainty.Interval(0.3, 0.5)}
    inputs["distance"] = uncertainty.Interval(19.0, 21.0)
    known = uncertainty.propagate(
        lambda drag, friction_b, distance: {"own": drag + friction_b + distance}, inputs
    )
    stated = {
        what: text
        for of, what, text in rows(report(crossed(), form="markdown", uncertainty=known))
        if "stated" in of
    }
    assert stated["drag"] == "0.6 to 0.8, no distribution assumed"
    assert stated["friction_b"] == "0.3 to 0.5, no distribution assumed"
    assert stated["distance"] == "19 to 21, no distribution assumed, given without a unit"


def test_a_conversion_with_all_its_digits_is_not_repeated_as_given():
    """A Quantity that was worked out is written by nobody; one with few digits is repeated, as a
    text is.
    """
    worked_out, typed = pint.Quantity(50.0 / 3.0, "m/s"), pint.Quantity(12.5, "m/s")
    found = rows(
        report(crossed(speed_a_after=worked_out, speed_b_after=typed), form="markdown", units="us")
    )
    assert ("A", "speed after", "37.28 mph") in found
    assert ("B", "speed after", "27.96 mph, given as 12.5 m/s") in found


def test_an_input_that_does_not_move_a_speed_has_a_zero_without_a_sign():
    """Along the course of A after, which is that of B before, momentum tells nothing about A."""
    found = rows(
        report(crossed(course_a_after="0 deg", outside_impulse=None), form="markdown", units="us")
    )
    assert ("speed of A before", "moved by speed of A after", "0 mph per mph") in found
    assert not any(text.startswith(("+0 ", "-0 ")) for *_, text in found)


@pytest.mark.slow
def test_what_is_left_out_is_that_of_the_duration_of_the_impact():
    """Unless another is given, 0.1 s too; both are remade from the record."""
    tyres = {f"tyres_{label}": col.travel.Tyres(0.7, 0.3, 2.7, 1.5) for label in "ab"}
    place = {"normal": 0.2, "point": (0.0, 0.0), "friction": 0.3}
    drags = {"duration": 0.0837, "drag_a": 0.5, "drag_b": 0.6}
    for impact in (
        col.eccentric(A, B, 0.1, **place, duration=0.0837, **tyres),
        col.eccentric(A, B, 0.1, **place, duration=0.0837, tyres_a=tyres["tyres_a"]),
        reconstruct.central(1511, 1279, va=17.3, vb=3.19, restitution=0.1, **drags),
    ):
        for asked, taken in (({}, 0.0837), ({"duration": 0.1}, 0.1), ({"duration": "90 ms"}, 0.09)):
            page = report(impact, form="markdown", units="si", figures=False, **asked)
            assert f"| contact | duration taken | {taken} s |" in page
            moved = col.left_out(impact, duration=taken).a.displacement_x
            assert f"| A | travel during the contact (x, y) | {moved:.2f} m, " in page
            assert report(replay(page), **options(page)) == page


def _planar():
    ahead = col.eccentric(A, B, 0.3, normal=0.2, point=(0.0, 0.0), friction=0.3)
    return reconstruct.planar(
        ahead.a.after,
        ahead.b.after,
        restitution=0.3,
        friction=0.3,
        normal=0.2,
        point=(0.0, 0.0),
        regime=ahead.regime,
    )


def _found():
    yield reconstruct.central(1100.0, 950.0, va=22.0, vb=0.0, vb_after=16.0)
    yield _planar()
    known = {
        "course_a": 0.0,
        "course_b": math.pi / 2,
        "restitution": 0.1,
        "speed_b": 9.0,
        "energy_loss": 60000.0,
    }
    yield from reconstruct.speeds(A, B, **known, normal=0.2, point=(0.0, 0.0), friction=0.3)


A = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, vx=12.0, x=-2.0, y=0.6, heading=0.0)
B = col.Vehicle(mass=1200.0, yaw_inertia=1800.0, vy=9.0, x=0.9, y=-1.0, heading=math.pi / 2)


@pytest.mark.slow
@pytest.mark.parametrize(
    "changed",
    [
        {"condition": 2.0},
        {"condition": 50.0},
        {"condition": []},
        {"answers": 10**400},
        {"answers": 99},
        {"method": "guess"},
        {"known": ["restitution", "energy_loss", "va"]},
        {"found": ["friction"]},
        {"found": ["speed_a", "speed_b", "speed_a"]},
        {"found": ["speed_b", "speed_a"]},
    ],
)
def test_what_a_record_says_of_its_reconstruction_is_worked_out_again(changed):
    for impact in _found():
        page = report(impact, form="markdown")
        assert report(replay(page), **options(page)) == page
        with pytest.raises(col.InputError):
            replay(
                tampered(page, lambda r: r["impact"]["results"]["reconstruction"].update(changed))
            )


def _found_from_recorders():
    """From a recorder off the centre of mass, its place known; and one whose friction was found."""
    ahead = col.eccentric(A, B, 0.1, normal=0.2, point=(0.0, 0.0), friction=0.3)
    contact = {"normal": 0.2, "point": (0.0, 0.0), "restitution": 0.1}
    contact |= {"course_a": 0.0, "course_b": math.pi / 2}
    yield from reconstruct.speeds(
        A,
        B,
        delta_v_forward_a=ahead.a.delta_v_forward,
        delta_v_left_a=ahead.a.delta_v_left,
        recorder_a=(0.4, 0.0),
        speed_b=9.0,
        duration=0.1,
        friction=math.inf,
        **contact,
    )
    yield from reconstruct.speeds(
        A, B, delta_v_a=ahead.a.delta_v, speed_b=9.0, friction=0.3, **contact
    )


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.01, -0.01, 3e-4])
def test_a_condition_is_held_to_the_digits_that_are_printed(share):
    """Of well-posed answers, whose conditions are below 100."""
    for impact in _found():
        condition = impact.reconstruction.condition
        assert condition < 100.0
        page = report(impact, form="markdown")
        changed = {"condition": condition * (1.0 + share)}
        with pytest.raises(col.InputError, match="give a condition of"):
            replay(
                tampered(
                    page,
                    lambda r, new=changed: r["impact"]["results"]["reconstruction"].update(new),
                )
            )


@pytest.mark.slow
def test_each_number_that_a_record_was_given_leads_to_its_speeds():
    """Whatever of them is changed, the record is refused."""
    tried = 0
    for impact in (*_found(), *_found_from_recorders()):
        page = report(impact, form="markdown")
        assert report(replay(page), **options(page)) == page
        for name in impact.reconstruction.given:

            def change(record, name=name):
                given = record["impact"]["results"]["reconstruction"]["given"]
                given[name] = 1.02 * given[name] + 0.01

            with pytest.raises(col.InputError):
                replay(tampered(page, change))
            tried += 1
    assert tried > 20
