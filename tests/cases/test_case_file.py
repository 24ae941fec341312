"""Case files give what the same call in Python gives; what is wrong is a line with the key and the
cure.
"""

import json
import math
import re
import subprocess
import sys
import warnings
from inspect import getdoc
from pathlib import Path

import pytest

import collisions as col
from collisions import reconstruct, travel
from collisions.__main__ import main
from collisions.cases.answers import answers
from collisions.cases.read import (
    FUNCTIONS,
    GIVES,
    SOLVERS,
    STUDIES,
    CaseError,
    parameters,
    parse_uncertain,
    read,
    read_text,
    vehicles,
)
from collisions.cases.schema import case_schema
from collisions.cases.words import DISTRIBUTIONS, in_file_words
from collisions.reporting import replay
from collisions.uncertainty import Interval, Normal, Triangular, Uniform, propagate
from fuzzing import _promptly

ROOT = Path(__file__).parents[2]
CASES = ROOT / "examples" / "cases"
REAR_END = (
    '[a]\nmass = "1100 kg"\nvx = "80 km/h"\n\n[b]\nmass = "950 kg"\n\n[linear_central]\n'
    "restitution = 0.4\n"
)
ECCENTRIC = (
    '[a]\nmass = 1500\nvx = "50 km/h"\nyaw_inertia = 2400\nx = -2.0\ny = 0.4\nheading = "0 deg"\n'
    '[b]\nmass = 1200\nyaw_inertia = 1700\nvy = "40 km/h"\nx = 0.8\ny = -1.2\nheading = "90 '
    'deg"\n[eccentric]\nrestitution = 0.1\nnormal = "0 deg"\npoint = [0, 0]\nfriction = 0.5\n'
)


def solved(text):
    """The one result of a case."""
    (found,) = answers(read_text(text.encode())).results
    return found


def problems(text):
    """What is wrong with a case, as lines."""
    with pytest.raises(CaseError) as caught:
        answers(read_text(text.encode()))
    return [f"{key}: {text}" for key, text in caught.value.problems]


def run(capsys, *arguments):
    """Exit code, output and error lines of the command."""
    code = main([*map(str, arguments)])
    found = capsys.readouterr()
    return code, found.out, found.err


LONG = 100_000


@pytest.mark.slow
@pytest.mark.parametrize(
    "form",
    [
        "1",
        " ",
        "1 ",
        "1-",
        "1 - ",
        "+-",
        "..",
        "1 .. 2 (",
        "%",
        "a",
        "a  ",
        "'",
        "('a', ",
        "['",
        "Normal(",
        "Normal((",
        "_",
        "1_",
        "{'a': ",
    ],
)
@pytest.mark.parametrize("end", ["", "!"])
def test_files_with_long_texts_are_refused_at_once(form, end):
    """Wherever the text stands. 2,000 digits took 47 s, and the time grew with the third power of
    the length.
    """
    text = (form * LONG)[:LONG] + end
    fit = REAR_END.replace('"80 km/h"', '"70 km/h .. 90 km/h"') + "[fit]\n[fit.observed]\n"
    for file, said in (
        (
            REAR_END.replace("1100 kg", f"1 {text}"),
            r"is a text of \d+ characters, .* has 200 at most, such as",
        ),
        (REAR_END + f'point = ["{text}", "1 m"]', "is not known here"),
        (ECCENTRIC.replace("point = [0, 0]", f'point = ["1 {text}", 0]'), "has 200 at most"),
        (REAR_END + f'"{text}" = 1\n', "is a key of .* characters"),
        (REAR_END.replace('"1100 kg"', f'{{ Normal = {{ mean = "{text}", sd = "1 kg" }} }}'), "."),
        (REAR_END + f"x = {text}\n", "."),
        (REAR_END + f"{text} = 1\n", "."),
        (f'{fit}"a.delta_v" = "1 {text}"\n', "has 200 at most"),
        (f'{fit}"{text}" = "20 km/h +/- 1 km/h"\n', "is a key of .* characters"),
    ):
        found = problems(file)
        assert any(re.search(said, line) for line in found), found
        assert max(map(len, found)) < 5000


@pytest.mark.parametrize(
    ("given", "meant"),
    [
        ("40-50 mph", "40 mph .. 50 mph"), ("40 - 50 mph", "40 mph .. 50 mph"),
            (" 0.4 to 0.7 ", "0.4 .. 0.7"),
        ("40 mph to 50 mph", "40 mph .. 50 mph"), ("40mph-50mph", "40 mph .. 50 mph"),
            ("-3.–4. deg", "-3. deg .. 4. deg"),
        ("40 mph    -    50 mph", "40 mph .. 50 mph"),
            ("30 deg to 45 \u00b0 ", "30 \u00b0 .. 45 \u00b0"),
        ("40...50 mph", "40 mph .. 50 mph"), ("0.2 \u2026 0.4", "0.2 .. 0.4"),
            ("-5 mph...5 mph", "-5 mph .. 5 mph"),
    ],
)  # fmt: skip
def test_what_people_write_for_a_range_is_read_for_the_cure(given, meant):
    (line,) = problems(REAR_END.replace("80 km/h", given))
    assert f'a range has two dots: write "{meant}"' in line


@pytest.mark.parametrize(
    "given", ["1e-5 kg", "1.5e-10", "12 kg*m**2 - 3", "a - b", "3 4 - 5", "\u0661-\u0662 kg"]
)
def test_what_is_no_range_is_not_taken_for_one(given):
    assert not any(
        "a range has two dots" in line for line in problems(REAR_END.replace("80 km/h", given))
    )


def test_forward_gives_what_the_call_gives():
    """The eccentric case of the README, with vx and with speed and course; to the bit."""
    a = col.Vehicle(mass=1500, yaw_inertia=2400, vx="50 km/h", x=-2.0, y=0.4, heading="0 deg")
    b = col.Vehicle(mass=1200, yaw_inertia=1700, vy="40 km/h", x=0.8, y=-1.2, heading="90 deg")
    impact = col.eccentric(a, b, 0.1, normal="0 deg", point=(0, 0), friction=0.5)
    assert solved(ECCENTRIC) == impact
    assert solved(ECCENTRIC.replace("vx = ", "course = 0.0\nspeed = ")) == impact
    assert solved(ECCENTRIC.replace('normal = "0 deg"', "normal = [1, 0]")) == impact
    pushed = solved(ECCENTRIC + 'outside_b = ["-500 N*s +/- 100 N*s", 0.0]\n')
    assert pushed == col.eccentric(
        a, b, 0.1, normal="0 deg", point=(0, 0), friction=0.5, outside_b=(-500.0, 0.0)
    )
    least = ECCENTRIC.replace("[eccentric]", '[solve]\ntolerance = "100 km/h"')
    assert solved(least) == col.solve(
        a, b, 0.1, normal="0 deg", point=(0, 0), friction=0.5, tolerance="100 km/h"
    )


def test_backwards_gives_what_the_call_gives():
    """Each of the four reverse solvers; a course that is not given is not known."""
    text = (
        '[reconstruct.central]\nmass_a = 1100\nmass_b = 950\nva = "80 km/h"\nvb = 0\nvb_after = '
        '"60 km/h"\n'
    )
    assert solved(text).restitution == pytest.approx(35 / 88, rel=1e-14)  # example 2 of the paper
    found = reconstruct.momentum(
        1500, 1200, course_a=0, course_b="90 deg", course_a_after="25 deg", course_b_after="40 deg",
        speed_a_after=travel.speed("12 m", drag=0.7), speed_b_after=9.0,
    )  # fmt: skip
    text = (
        '[reconstruct.momentum]\nmass_a = 1500\nmass_b = 1200\ncourse_a = 0\ncourse_b = "90 '
        'deg"\ncourse_a_after = "25 deg"\ncourse_b_after = "40 deg"\nspeed_b_after = 9.0\n'
        'speed_a_after = { travel.speed = { distance = "12 m", drag = 0.7 } }\n'
    )
    assert solved(text) == found
    bodies = "yaw_inertia = 2000\nx = {}\ny = 0.0\n"
    text = (
        f"[a]\nmass = 1500\n{bodies.format(-2.0)}[b]\nmass = 1300\n"
        f"{bodies.format(2.0)}[reconstruct.speeds]\ncourse_a = 0\nspeed_b = 0\ndelta_v_a = 6\n"
        "restitution = 0.1\nnormal = 0\npoint = [0, 0.4]\nfriction = 0.5\n"
    )
    impact = solved(text)
    assert (impact.a.delta_v, impact.b.before.speed) == (pytest.approx(6.0, rel=1e-13), 0.0)
    after = "".join(
        f"[{label}_after]\nmass = {side.after.mass}\nvx = {side.after.vx!r}\nvy = "
        f"{side.after.vy!r}\nyaw_rate = {side.after.yaw_rate!r}\n" + bodies.format(side.after.x)
        for label, side in (("a", impact.a), ("b", impact.b))
    )
    back = (
        solved(
            f"{after}[reconstruct.planar]\nnormal = 0\npoint = [0, 0.4]\nrestitution = 0.1\n"
            "friction = 0.5\nregime = 'sliding'\n"
        )
        if impact.regime == "sliding"
        else None
    )
    assert back is None or back.a.before.vx == pytest.approx(impact.a.before.vx, rel=1e-9)


TYRES_OF_A = (
    'duration = "100 ms"\n[{0}.tyres_a]\nfriction = 0.7\nlock = [1, 1, 0, 0]\n'
    'wheelbase = "2.7 m"\ntrack = "1.5 m"\n'
)


@pytest.mark.slow
@pytest.mark.parametrize("solver", ["eccentric", "solve", "time_resolved"])
def test_tyres_stand_in_a_table_below_that_of_their_solver(solver):
    text = ECCENTRIC.replace("[eccentric]", f"[{solver}]") + TYRES_OF_A.format(solver)
    found = solved(text)
    a, b = found.a.before, found.b.before
    tyres = col.travel.Tyres(0.7, [1, 1, 0, 0], "2.7 m", "1.5 m")
    known = {"restitution": 0.1, "normal": 0.0, "point": (0.0, 0.0), "friction": 0.5}
    by_call = getattr(col, solver)(a, b, **known, duration=0.1, tyres_a=tyres)
    assert found.b.delta_v == by_call.b.delta_v
    assert found.b.delta_v != solved(ECCENTRIC).b.delta_v
    uncertain = text.replace("friction = 0.7", 'friction = "0.6 .. 0.8"') + (
        '[propagate]\noutputs = ["b.delta_v"]\nsamples = 64\nmethod = "monte_carlo"\n'
    )
    spread = answers(read_text(uncertain.encode())).propagation
    assert [*spread.inputs] == ["tyres_a.friction"]
    assert spread["b.delta_v"].std > 0.0
    for old, new, line in (
        ("wheelbase", "wheel_base", f"{solver}.tyres_a.wheel_base: is not known here"),
        ('"2.7 m"', '"-2.7 m"', f"{solver}.tyres_a.wheelbase: must be"),
        ('track = "1.5 m"\n', "", f"{solver}.tyres_a.track: is missing"),
    ):
        assert problems(text.replace(old, new))[0].startswith(line)


def test_the_report_tells_both_parts_of_a_point_apart():
    """And has the vehicle's own numbers in words."""
    text = ECCENTRIC.replace("[0, 0]", '["0 m +/- 0.1 m", "0.2 m +/- 0.1 m"]')
    text = text.replace("mass = 1500", 'mass = "1500 kg +/- 30 kg"')
    text += '[propagate]\noutputs = ["a.delta_v"]\nsamples = 64\n'
    page = answers(read_text(text.encode())).report("markdown")
    for words in ("contact point, along x", "contact point, along y", "mass of A"):
        assert page.count(f"| A: delta-V | variance from {words} |") == 1
        assert page.count(f"| Inputs as stated | {words} |") == 1


@pytest.mark.slow
def test_the_report_says_what_is_stated_of_tyres():
    """Beside each of their numbers; of a list all of them in their order, as it is beside each."""
    text = ECCENTRIC + TYRES_OF_A.format("eccentric").replace("= 0.7", '= "0.6 .. 0.8"').replace(
        "[1, 1, 0, 0]", '[1, 1, 0, "0.1 .. 0.3"]'
    )
    page = answers(read_text(text.encode())).report("markdown")
    assert "| 0.7. Stated as 0.6 to 0.8, all values equally likely |" in page
    stated = "Stated of all 4, in order: 1; 1; 0; 0.1 to 0.3, all values equally likely |"
    assert page.count(stated) == 4
    whole = " ".join(page.split())
    assert "tyres of A: braking of the rear right wheel | 0.1 to 0.3" in whole


def test_a_solver_without_tyres_takes_no_table_of_them():
    text = REAR_END + TYRES_OF_A.format("linear_central")
    assert any(line.startswith("linear_central.tyres_a: is not known") for line in problems(text))


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("50 km/h +/- 3 km/h", Normal("50 km/h", "3 km/h")),
        ("50 km/h±3 km/h", Normal("50 km/h", "3 km/h")),
        ("50 km/h +- 3 km/h", Normal("50 km/h", "3 km/h")),
        ("0.4 .. 0.7", Uniform(0.4, 0.7)),
        ("0.4..0.7", Uniform(0.4, 0.7)),
        ("-5 deg .. 5 deg", Uniform("-5 deg", "5 deg")),
        ("1400 kg .. 1600 kg (95 %)", Normal.between("1400 kg", "1600 kg", 0.95)),
        ("0.5 +/- 0.1 (90 %)", Normal.between(0.4, 0.6, 0.9)),
        (" 0.5 +/- 0.1 (90 %) ", Normal.between(0.4, 0.6, 0.9)),
    ],
)
def test_texts_of_what_is_not_known_exactly(text, wanted):
    """As written; nothing else is one."""
    found = parse_uncertain(text)
    assert type(found) is type(wanted)
    assert found.unit == wanted.unit
    assert found.quantile(0.1) == pytest.approx(wanted.quantile(0.1), rel=1e-14)
    assert parse_uncertain("50 km/h") is None


@pytest.mark.parametrize(
    "text",
    [
        "50 +/- 3 km/h",
        "0.7 .. 0.4",
        "5 kg +/- 1 m",
        "1 .. 2 .. 3",
        "0...1",
        "5 +/- ",
        "1 .. 2 (100 %)",
        "1 +/- 0",
        "0.4 .. 0.7 (95)",
    ],
)
def test_texts_that_are_refused(text):
    """Never read as something near it."""
    (line,) = problems(REAR_END.replace("0.4", f'"{text}"'))
    assert line.startswith("linear_central.restitution: ")


@pytest.mark.slow
def test_the_nominal_case_has_what_was_written():
    """A text keeps its unit beside its error, and the middle stands for a range."""
    impact = solved(
        REAR_END.replace("80 km/h", "80 km/h +/- 2 km/h").replace("0.4", '"0.2 .. 0.4"')
    )
    assert impact.a.before.given["vx"] == "80 km/h"
    assert impact.restitution == pytest.approx(0.3, rel=1e-15)
    assert solved(REAR_END.replace("80 km/h", "35 mph .. 45 mph")).a.before.given["vx"] == "40 mph"
    assert solved(REAR_END.replace("80 km/h", "35 mph .. 80 km/h")).a.before.vx == pytest.approx(
        (35 * 0.44704 + 80 / 3.6) / 2
    )
    turned = solved(ECCENTRIC.replace('"0 deg"\npoint', '"-90 deg +/- 5 deg"\npoint'))
    assert turned.normal == (0.0, -1.0)


def test_propagation_is_that_of_the_same_model():
    """Same seed, same figures; one normal, one uniform, one triangular input."""
    text = REAR_END.replace("80 km/h", "80 km/h +/- 2 km/h").replace("0.4", '"0.2 .. 0.4"')
    text = text.replace('"950 kg"', "{ Triangular = { low = 900, mode = 950, high = 1100 } }")
    found = answers(
        read_text(f"{text}[propagate]\nmethod = 'quasi_random'\nseed = 3\nsamples = 256\n".encode())
    ).propagation

    def model(vx, mass, e):
        impact = col.linear_central(
            col.Vehicle(mass=1100, vx=vx), col.Vehicle(mass=mass), e, on_failure="nan"
        )
        return {
            "a.delta_v": impact.a.q.delta_v,
            "b.delta_v": impact.b.q.delta_v,
            "energy_loss": impact.q.energy_loss,
        }

    inputs = {
        "vx": Normal("80 km/h", "2 km/h"),
        "mass": Triangular(900, 950, 1100),
        "e": Uniform(0.2, 0.4),
    }
    wanted = propagate(model, inputs, method="quasi_random", seed=3, samples=256)
    assert list(found) == list(wanted)
    for name in wanted:
        assert (found[name].mean, found[name].std) == (wanted[name].mean, wanted[name].std)
    assert set(found.inputs) == {"a.vx", "b.mass", "restitution"}


def test_a_warning_of_few_cases_is_among_the_statements_of_the_record():
    """Without loss along the normal an impact gains energy where the ratio is above 0, here beyond
    three standard deviations: one case of 740, too few to warn of.
    """
    text = ECCENTRIC.replace("restitution = 0.1", "restitution = 1")
    text = text.replace("friction = 0.5", 'impulse_ratio = "-0.3 +/- 0.1"')
    text += '[propagate]\nmethod = "quasi_random"\nseed = 1\noutputs = ["b.delta_v"]\n'
    found = answers(read_text(text.encode())).to_dict()
    (stated,) = found["uncertainty"]["statements"]
    cases, _, rest = stated.partition(" of 8192 cases ")
    assert int(cases) == pytest.approx(8192 * 0.5 * math.erfc(3.0 / math.sqrt(2.0)), abs=2)
    assert "the impact gains energy" in rest
    assert found["warnings"] == []


@pytest.mark.slow
def test_bounds_alone_give_bounds():
    """Intervals are no distributions, and nothing is drawn from them."""
    text = REAR_END.replace("0.4", "{ Interval = { low = 0.2, high = 0.4 } }")
    found = answers(read_text(text.encode())).propagation
    assert found.method == "interval"
    assert found["b.delta_v"].interval() == pytest.approx(
        [80 / 3.6 * 1100 / 2050 * (1 + e) for e in (0.2, 0.4)], rel=1e-9
    )
    assert isinstance(found.inputs["restitution"], Interval)


def test_one_road_under_both_cars():
    """Rows of a correlation name keys of the file; the example has the range of the README."""
    found = answers(read(CASES / "run_out.toml")).propagation
    low, high = found["speed_a"].interval(0.95)
    assert (round(3.6 * low), round(3.6 * high)) == (67, 80)


def test_fit_of_what_was_observed():
    """The speed that gives the delta-V in closed form: dv m/(m_a (1 + e))."""
    text = (
        REAR_END.replace('"80 km/h"', '"10 m/s .. 30 m/s"')
        + '[fit.observed]\n"b.delta_v" = "15 m/s +/- 0.5 m/s"\n'
    )
    found = solved(text)
    assert found["a.vx"].value == pytest.approx(15 * 2050 / 1100 / 1.4, rel=1e-9)
    assert "a.vx" in answers(read_text(text.encode())).text()


@pytest.mark.slow
def test_posterior_of_what_was_observed():
    """A flat prior cut by a reading and by a bound: the mean of a normal distribution, truncated;
    in closed form.
    """
    text = (
        REAR_END.replace('"80 km/h"', '"0 m/s .. 40 m/s"')
        + "[posterior]\nsamples = 2048\n[posterior.observed]\n"
    )
    text += '"b.delta_v" = "15 m/s +/- 0.5 m/s"\n"a.before.vx" = "15 m/s .. 20 m/s"\n'
    factor = 1100 / 2050 * 1.4
    middle, sd = 15 / factor, 0.5 / factor
    cut = (20 - middle) / sd
    wanted = middle - sd * math.exp(-0.5 * cut * cut) / math.sqrt(math.tau) / (
        0.5 * (1 + math.erf(cut / math.sqrt(2)))
    )
    found = solved(text)["a.vx"]
    assert abs(found.mean - wanted) < 5 * found.mean_standard_error
    censored = text.replace('"15 m/s .. 20 m/s"', '{ Censored = { high = "20 m/s" } }')
    found = solved(censored)["a.vx"]
    assert abs(found.mean - wanted) < 5 * found.mean_standard_error
    found = answers(read_text(text.encode()))
    assert "a.vx" in found.text()
    (record,) = found.to_dict()["results"]
    assert json.dumps(record, allow_nan=False)
    # As at the end of its report.
    assert record.keys() == {"format", "version", "options", "posterior"}


@pytest.mark.slow
def test_report_of_a_posterior(tmp_path, capsys):
    """From a file to a page in one command: what was found, observed and known before, what is
    known exactly, figures.
    """
    file, page = tmp_path / "case.toml", tmp_path / "page.html"
    text = REAR_END.replace('"80 km/h"', '"0 km/h .. 150 km/h"').replace("0.4", '"0.2 .. 0.4"')
    text += (
        '[posterior]\nsamples = 1024\n[posterior.observed]\n"b.delta_v" = "54 km/h +/- 2 km/h"\n'
        '"a.before.speed" = "40 mph .. 60 mph"\n'
    )
    file.write_text(text + '[report]\nnotes = "Own words."\n', encoding="utf-8")
    code, said, _ = run(capsys, file, "--report", page)
    assert code == 0
    whole = page.read_text(encoding="utf-8")
    found = solved(text)
    mean, sd = 3.6 * found["a.vx"].mean, 3.6 * found["a.vx"].std
    for part in (
        f"{mean:.1f} ± {sd:.1f} km/h",
        "at least 40 mph, at most 60 mph",
        "0.2 to 0.4, all values equally likely",
    ):
        assert part in said
        assert part in whole
    assert "54 ± 2 km/h" in said
    assert "<td>54 km/h</td><td>2 km/h</td>" in whole
    assert "restitution" in whole
    assert "Own words." in whole
    assert "The case is linear_central, with a.mass = 1100 kg, b.mass = 950 kg." in whole
    assert whole.count("<figure>") == 3  # the residuals, and both unknowns
    with pytest.raises(col.InputError, match="report of a Posterior"):
        replay(whole)
    assert run(capsys, file, "--what-if", page)[0] == 2
    file.write_text(text + "[report]\nderivation = true\n", encoding="utf-8")
    assert (
        "report.derivation: derivation is for an Impact" in run(capsys, file, "--report", page)[2]
    )


@pytest.mark.slow
def test_two_answers_are_told_apart():
    """Both are printed; a report or a range needs to know which."""
    body = "yaw_inertia = {}\nx = {}\ny = {}\n"
    text = (
        f"[a]\nmass = 1500\n{body.format(2500, -2, 0)}[b]\nmass = 1300\n"
        f"{body.format(2000, 2, 0.8)}[reconstruct.speeds]\ncourse_a = 0\ncourse_b = '90 deg'\n"
        "energy_loss = 120000\ndelta_v_a = 6\nrestitution = 0.1\nnormal = 0\npoint = [0, 0.4]\n"
        "friction = 0.5\n"
    )
    both = answers(read_text(text.encode()))
    assert len(both.results) == 2
    assert "Answer 2 of 2" in both.text()
    with pytest.raises(CaseError, match="write answer = 1"):
        both.report("html")
    assert solved("answer = 2\n" + text) == both.results[1]
    assert problems("answer = 3\n" + text) == [
        "answer: is 3, and 2 fit; write a number from 1 to 2"
    ]
    vague = text.replace("delta_v_a = 6", 'delta_v_a = "5.9 m/s .. 6.1 m/s"')
    assert problems(vague)[0].startswith("answer: is not given, and 2 answers fit")
    found = answers(
        read_text(
            (
                "answer = 2\n"
                + vague
                + "[propagate]\nmethod = 'monte_carlo'\nseed = 1\nsamples = 64\n"
            ).encode()
        )
    )
    mean = found.propagation["a.before.speed"].mean
    assert mean == pytest.approx(
        both.results[1].a.before.speed, rel=0.02
    )  # 6 moves by 1.7 percent, and the answer by less
    # A fit follows the one that is asked for too, here to the delta-V as it is stated.
    stated = text.replace("delta_v_a = 6", 'delta_v_a = "6 m/s +/- 0.05 m/s"')
    for number, root in enumerate(both.results, 1):
        speed = f'{root.a.before.speed!r} m/s +/- 0.01 m/s"\n'
        asked = stated + f'[fit]\n[observed]\n"a.before.speed" = "{speed}'
        assert problems(asked)[0].startswith("answer: is not given, and 2 answers fit")
        assert problems("answer = 3\n" + asked) == [
            "answer: is 3, and 2 fit; write a number from 1 to 2"
        ]
        (fitted,) = answers(read_text(f"answer = {number}\n{asked}".encode())).results
        assert fitted["delta_v_a"].value == pytest.approx(6.0, abs=1e-3)


def test_an_answer_that_is_not_there_is_refused_for_every_study():
    """One answer fits, and the second is asked for."""
    text = (
        'answer = 2\n[a]\nmass = 1500\nvx = "10 m/s +/- 1 m/s"\n[b]\nmass = 1300\n'
        "[linear_central]\nrestitution = 0.1\n"
    )
    for study in ("[propagate]\n", '[fit]\n[observed]\n"a.delta_v" = "4 m/s +/- 0.5 m/s"\n'):
        assert problems(text + study) == ["answer: is 2, and 1 fit; write a number from 1 to 1"]


@pytest.mark.slow
def test_cases_with_another_number_of_answers_are_no_cases_without():
    """Three fit as it is stated; where two have vanished, which the third is cannot be told."""
    text = (
        "answer = 1\n[a]\nmass = 1500\nyaw_inertia = 2600\nheading = 0\nx = -2.2\ny = 0.2\n"
        "[b]\nmass = 1200\nyaw_inertia = 2100\nheading = '90 deg'\nx = 0.9\ny = -0.5\n"
        "[reconstruct.speeds]\ncourse_a = 0\ncourse_b = '66.728 deg'\nspeed_b = 22.257\n"
        "restitution = 0.27867\nnormal = '-40.982 deg'\npoint = [0, 0]\nfriction = 0.97226\n"
        "energy_loss = '53.58 kJ +/- {} kJ'\n"
        "[propagate]\noutputs = ['a.before.speed']\nsamples = 256\nseed = 1\n"
    )
    assert problems(text.format(3))[0].startswith(
        "reconstruct.speeds: has fewer answers in some cases than in the stated one (1 for 3), and "
        "which is which cannot be told there; narrow what is uncertain"
    )
    fine = answers(read_text(text.format(0.001).encode()))
    assert fine.propagation["a.before.speed"].mean == pytest.approx(
        fine.results[0].a.before.speed, rel=0.05
    )


@pytest.mark.slow
def test_the_answer_that_was_asked_for_is_warned_of_alone():
    """Of two answers B goes backwards in the second: the first is not warned of, alone or over its
    errors.
    """
    text = (
        "[a]\nmass = 1542\nyaw_inertia = 2400\nx = -1.98\ny = 0.4\nheading = 0\nyaw_rate = 0.35\n"
        "[b]\nmass = 1315\nyaw_inertia = 1700\nx = 0.8\ny = -1.2\nheading = '90 deg'\n"
        "[reconstruct.speeds]\ncourse_a = 0\ncourse_b = '90 deg'\nrestitution = 0.1\nnormal = 0\n"
        "point = [0, 0]\nfriction = 0.5\nenergy_loss = 77960\ndelta_v_a = {}\n"
    )
    for stated in ("5.63", '"5.63 m/s +/- 0.1 m/s"'):
        for answer, warned in ((1, 0), (2, 1)):
            case = f"answer = {answer}\n" + text.format(stated)
            found = answers(read_text(case.encode()))
            assert (found.results[0].b.before.vy < 0.0) == bool(warned)
            backwards = [line for line in found.warnings if "backwards along its course" in line]
            assert len(backwards) == warned


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("restitution", "restitutoin",
            "linear_central.restitutoin: is not known here; did you mean restitution?"),
        ("vx", "speeed", "a.speeed: is not known here; did you mean speed?"),
        ("[b]", "[c]", "c: is not known here"),
        ("linear_central", "linear_centrl",
            "linear_centrl: is not known here; did you mean linear_central?"),
        ("linear_central", "reconstruct.centrall",
            "reconstruct.centrall: is not known here; did you mean reconstruct.central?"),
        ('mass = "1100 kg"\n', "", "a.mass: is missing; give it: Mass, > 0"),
        ('vx = "80 km/h"', "course = 0.0",
            "a.speed: is missing; give it: Speed of the centre of mass, >= 0 [m/s]"),
        ("1100 kg", "1100 kgg", "a.mass: '1100 kgg' cannot be taken as kg"),
        ('"1100 kg"', "1100 kg",
            ("a.mass: is not TOML: Expected newline or end of document after a statement (at "
             "line 2, column 13), 'mass = 1100 kg'; write mass = \"1100 kg\"")),
        ("0.4", "0,4",
            ("linear_central.restitution: is not TOML: Expected newline or end of document "
             "after a statement (at line 9, column 16), 'restitution = 0,4'; a decimal has a "
             "point: write restitution = 0.4")),
        ('"1100 kg"', "[0x" + "f" * 5000 + "]",
            "a.mass[0]: is a whole number of more than 64 bits"),
        ('"1100 kg"', "9" * 5000, "a.mass: is not TOML: Too many digits (at line 2), 'mass = 9999"),
        ("1100 kg", "1e400 kg", "a.mass: mass is too large: '1e400 kg'"),
        ('"950 kg"', "1e400",
            ("b.mass: has the number 1e400, which is larger than 1.7e308; look for a slipped "
             "digit, or write inf")),
        ('"950 kg"', "2024-05-01",
            ('b.mass: is a date or a time, 2024-05-01; write a number, or a text in quotes: '
             '"2024-05-01"')),
        ('"950 kg"', "true",
            ("b.mass: must be a number or a text, such as 1100 (kg), '1100 kg' or '2425 lb', "
             "got true")),
        ("0.4\n", "0.4\nanswer = 1\n",
            ("linear_central.answer: stands inside the table [linear_central]; move this line "
             "above the first table of the file")),
        ("0.4\n", '0.4\n[report]\nday = "1 May"\n',
            "report.day: is not known here; write one of title, units, "),
        ("[a]", "[A]", "A: is not known here; did you mean a?"),
        ("80 km/h", "50 mph .. 40 mph",
            "a.vx: low and high must be in rising order, got 50 mph and 40 mph"),
        ("0.4", "{ Censored = { low = 0.1 } }",
            ("linear_central.restitution: is a reading with one bound, which only an "
             "observation may be")),
        ("0.4", "{ Censored = {} }",
            ("linear_central.restitution.Censored.low: a censored reading needs a bound; "
             "write { Censored = { low = ... } } for at least")),
        ("0.4", "{ Normal = { mean = 0.1, sd = 0.1, truncate = 3 } }",
            ("linear_central.restitution.Normal.truncate: must be a pair [low, high], where "
             "-inf or inf leaves a side open, got 3")),
        ("0.4", '"1 .. 2 (150 %)"',
            ("linear_central.restitution: coverage must be more than 0 and less than 1, such "
             "as 0.95, got '150 %'; a range that cannot be left is \"low .. high\", or { "
             "Interval = { low = ..., high = ... } }")),
        ("0.4\n", '0.4\n[fit.observed]\n"a.delta_v" = 3\n',
            "fit: has nothing to find; write what is sought as a range"),
        ("0.4\n", '"0.1 .. 0.3"\n[fit.observed]\n"a.delta_v" = 3\n',
            ('fit.observed."a.delta_v": observed."a.delta_v" is a number without its error; '
             'give "value +/- error" or the pair [value, error]')),
        ("restitution = 0.4", "restitution = 0.1\nnormal = [1, 2, 3]",
            "linear_central.normal: must be an angle or a list [x, y], got 3 components"),

        ("80 km/h", "-80 km/h",
            ("linear_central: no impact: the bodies move apart along the normal, closing "
             "speed -80 km/h; the normal is [1, 0], and must point from A into B; if A and B "
             "were meant the other way round, exchange them or write normal = [-1, 0]")),
        ("0.4", "1.4", "linear_central.restitution: must be from 0 to 1, got 1.4"),
        ("0.4", "[0.4, 0.5]", "linear_central.restitution: takes one value"),
        ("0.4", "{ travel.sped = { distance = 1 } }",
            "linear_central.restitution: is a table that names no function"),
        ("0.4", "{ Uniform = { low = 1 } }", "linear_central.restitution.Uniform.high: is missing"),
        ("0.4\n", '0.4\n[report]\nunit = "us"\n',
            "report.unit: is not known here; did you mean units?"),
        ("0.4\n", '"0.1 .. 0.4"\n[propagate]\noutputs = ["a.deltav"]\n',
            "propagate.outputs: 'a.deltav' is no number of the answer; did you mean a.delta_v?"),
        ("0.4\n", '"0.1 .. 0.4"\n[propagate]\noutputs = ["a.before.name"]\n',
            ("propagate.outputs: 'a.before.name' is no number of the answer; did you mean "
             "a.before.mass?")),
        ("0.4\n", '"0.2 +/- 0.01"\n[propagate]\nmethod = "interval"\n',
            "restitution: restitution = { Normal = { mean = 0.2, sd = 0.01 } } has no bounds"),
        ("0.4\n", '"0.1 .. 0.3"\n[posterior.observed]\na.delta_v = "20 km/h +/- 1 km/h"\n',
            'posterior.observed."a": has its name without quotes; write "a.delta_v" = '),
        ("0.4\n", '0.4\n[what_if.ranges]\nsped_a = [1, 40]\n',
            "what_if.ranges.sped_a: is not known here; did you mean speed_a?"),
        ('vx = "80 km/h"', 'speed = "80 km/h +/- 60 km/h"\ncourse = 0',
            "a.speed: speed must be >= 0, got -"),
        ('vx = "80 km/h"', 'vx = "80 km/h"\nheading = "N"',
            "a.heading: cannot read 'N': angles are counted"),
        ('mass = "1100 kg"', 'name = 3\nmass = "1100 kg"',
            "a.name: must be a text, got a number; put it in quotes"),
        ("0.4\n", '"0.1 .. 0.4"\n[propagate]\noutputs = ["a.pdof"]\n',
            "propagate.outputs: 'a.pdof' is not known: "),
        ("0.4\n", '"0.1 .. 0.4"\n[propagate]\noutputs = ["normal"]\n',
            "propagate.outputs: 'normal' is no number of the answer"),
        ("0.4\n", '"0.1 .. 0.4"\n[propagate]\ncorrelation = [1]\n',
            "propagate.correlation: takes rows such as"),
        ("0.4\n", '0.4\n[eccentric]\n',
            ": has the tables [linear_central], [eccentric]; leave one of them"),
        ("0.4\n", f"0.4\n[propagate]\nseed = {2**63}\n",
            "propagate.seed: is a whole number of more than 64 bits"),
        ("0.4", '"50 +/- 3 km/h"',
            ("linear_central.restitution: cannot read '50 +/- 3 km/h': both numbers need the "
             "same unit; write for example '50 km/h +/- 3 km/h'")),
        ("80 km/h", "50 km/h +- 3",
            ("a.vx: cannot read '50 km/h +- 3': both numbers need the same unit; write for "
             "example '50 km/h +- 3 km/h'")),
        ("80 km/h", "50 km/h +/- 5 %",
            ("a.vx: cannot read '50 km/h +/- 5 %': both numbers need the same unit; write for "
             "example '50 km/h +/- 3 km/h'")),
        ("80 km/h", "40..50 mph",
            ("a.vx: cannot read '40..50 mph': both numbers need the same unit; write for "
             "example '40 mph .. 50 mph'")),
        ("80 km/h", "40-50 mph",
            "a.vx: cannot read '40-50 mph'; a range has two dots: write \"40 mph .. 50 mph\""),
        ("80 km/h", "0.4...0.7", "a.vx: cannot read '0.4...0.7'; a range has two dots"),
        ("80 km/h", "\u221280 km/h",
            "a.vx: cannot read '\u221280 km/h': a minus is typed as a hyphen, '-80 km/h'"),
        ("0.4", '"0.4 to 0.7"',
            ("linear_central.restitution: cannot read '0.4 to 0.7'; a range has two dots: "
             "write \"0.4 .. 0.7\"")),
        ("vx", 'speed = "50 km/h"\ncourse = 0\nvx',
            "a: has its velocity in two ways; leave vx and vy, or speed and course"),
        ('vx = "80 km/h"', 'speed = "80 km/h"',
            ("a.course: is missing; give it: Direction in which it moves, counter-clockwise "
             "from the x axis of the scene [rad], such as 1.57 (rad) or '90 deg'")),
        ('"80 km/h"', "\u201c80 km/h\u201d",
            ("a.vx: is not TOML: Invalid value (at line 3, column 6), 'vx = \u201c80 "
             "km/h\u201d'; write straight quotes")),
        ("[b]", "[a]",
            (": is not TOML: Cannot declare [a] twice (at line 5, column 3), '[a]'; a file is "
             "of one case")),
        (REAR_END, "", ": has no table of a solver; write one of [linear_central], "),
    ],
)  # fmt: skip
def test_what_is_wrong_is_a_line_with_the_key_and_the_cure(old, new, line):
    """Nothing is passed over, and nothing is read as something else."""
    found = problems(REAR_END.replace(old, new, 1))
    assert found[0].startswith(line), found
    assert all("\n" not in one for one in found)


def test_a_number_with_a_hyphen_is_no_range():
    """A power of ten and a negative exponent of a unit are read as they stand."""
    assert (
        solved(REAR_END.replace("80 km/h", "2e1 m/s").replace("950 kg", "95e+1 kg")).a.before.vx
        == 20.0
    )
    assert solved(REAR_END.replace("80 km/h", "200E-1 m*s**-1")).a.before.vx == 20.0


def test_a_point_is_two_numbers():
    """What is wrong with a pair is said in words of a file."""
    for point in ('"0 m, 0 m"', "[0, 0, 0]", "3"):
        (line,) = problems(ECCENTRIC.replace("[0, 0]", point))
        assert re.fullmatch(
            r'eccentric.point: takes two numbers in brackets, got .*; write for example \["1.2 '
            r'm", "-0.4 m"\]',
            line,
        )
    assert 'such as ["1.2 m"' in problems(ECCENTRIC.replace("point = [0, 0]\n", ""))[0]


def test_a_vehicle_that_lacks_something_is_named():
    """The key is that of the file, not of the function."""
    assert problems(ECCENTRIC.replace("yaw_inertia = 1700\n", "").replace("x = -2.0\n", "")) == [
        (
            "a.x: a has no x, which eccentric needs; give x = '2.5 m' (the centre of mass at the "
            "moment of impact)"
        ),
        (
            "b.yaw_inertia: b has no yaw_inertia, which eccentric needs; give yaw_inertia = "
            "'1800 kg*m**2', or inf for a body that does not rotate"
        ),
    ]


@pytest.mark.parametrize("distance", ['"-12 m"', '"12 kg"', '"5 m .. 4 m"'])
def test_what_is_wrong_inside_a_function_is_named_with_its_table(distance):
    """Whether it shows when the file is read or when the case is solved."""
    (line,) = problems(
        '[reconstruct.momentum]\nmass_a = 1500\nmass_b = 1200\ncourse_a = 0\ncourse_b = "90 '
        'deg"\ncourse_a_after = "25 deg"\ncourse_b_after = "40 deg"\nspeed_b_after = 9\n'
        f"speed_a_after = {{ travel.speed = {{ distance = {distance}, drag = 0.7 }} }}\n"
    )
    assert line.startswith("reconstruct.momentum.speed_a_after.travel.speed.distance: ")


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["paper_example_3", "intersection_with_recorder", "us_units", "run_out"]
)
def test_each_example_makes_its_report(name, tmp_path, capsys):
    """From a file to a report in one command; the record in it is that of the result."""
    page = tmp_path / "report.html"
    code, text, complaints = run(capsys, CASES / f"{name}.toml", "--report", page)
    assert (code, complaints) == (0, "")
    assert "Impact of" in text or "Planar momentum" in text
    whole = page.read_text(encoding="utf-8")
    assert whole.count("<figure>") >= 2
    assert replay(whole) == answers(read(CASES / f"{name}.toml")).results[0]


def test_the_examples_have_their_published_answers():
    """Example 3 of the paper, exactly; test 4474 as printed; the speed of the README's recorder
    within its range.
    """
    (paper,) = answers(read(CASES / "paper_example_3.toml")).results
    assert paper.b.after.yaw_rate == pytest.approx(-405 / 74, rel=1e-13)
    assert paper.a.after.vx == pytest.approx(950 / 111, rel=1e-13)
    (us,) = answers(read(CASES / "us_units.toml")).results
    assert [side.q.delta_v.m_as("mph") for side in (us.a, us.b)] == pytest.approx(
        [28.7, 40.5], abs=0.2
    )


@pytest.mark.parametrize("option", ["--report", "--what-if", "--play"])
def test_a_file_to_write_is_named_once(option, tmp_path, capsys):
    """Of two one would not be written, without a word."""
    files = [tmp_path / name for name in ("one.md", "two.md")]
    with pytest.raises(SystemExit) as ended:
        main([str(CASES / "run_out.toml"), *(str(part) for one in files for part in (option, one))])
    assert ended.value.code == 2
    assert f"{option} is given twice, and takes one file" in capsys.readouterr().err
    assert not any(one.exists() for one in files)


@pytest.mark.slow
def test_the_command(tmp_path, capsys):
    """Its output in each form, the units, and the exit codes."""
    file = tmp_path / "case.toml"
    file.write_text(REAR_END, encoding="utf-8")
    code, text, complaints = run(capsys, file)
    assert (code, complaints) == (0, "")
    assert re.search(r"^  total +51\.9 km/h +60\.1 km/h$", text, re.MULTILINE), (
        text
    )  # 80 * 1.4 * 950 / 2050, and of 1100
    assert "mph" in run(capsys, file, "--units", "us")[1]
    code, text, _ = run(capsys, file, "--json")
    record = json.loads(text)
    assert (code, record["warnings"], record["uncertainty"]) == (0, [], None)
    assert col.Impact.from_dict(record["results"][0]["impact"]) == solved(REAR_END)
    page = tmp_path / "page.md"
    assert run(capsys, file, "--report", page)[0] == 0
    assert replay(page.read_text(encoding="utf-8")) == solved(REAR_END)
    for name in (file, tmp_path, tmp_path / "page", tmp_path / "page.pdf"):
        code, text, complaints = run(capsys, file, "--report", name)
        assert (code, text, complaints) == (
            2, "", (f"{file}: --report cannot write {name}; give a name of its own, which ends in "
                    ".html or .md\n")
        )  # fmt: skip
    assert file.read_text(encoding="utf-8") == REAR_END
    page = tmp_path / "page.html"
    assert run(capsys, file, "--report", page, "--what-if", page)[0] == 2
    assert run(capsys, file, "--report", tmp_path / "none" / "page.html")[2].startswith(
        f"{file}: cannot write "
    )
    assert run(capsys, tmp_path / "none.toml")[0::2] == (
        2, (f"{tmp_path / 'none.toml'}: cannot be read (No such file or directory); give the "
            "path of a case file, or start from what 'new' prints\n"),
    )  # fmt: skip
    file.write_text(REAR_END.replace("80 km/h", "-80 km/h"), encoding="utf-8")
    code, text, complaints = run(capsys, file)
    assert (code, text, complaints.count("\n")) == (1, "", 1)
    assert complaints.startswith(f"{file}: linear_central: no impact: ")
    code, text, _ = run(capsys, file, "--json")
    assert (code, json.loads(text)["code"], json.loads(text)["errors"][0]["key"]) == (
        1,
        "separating",
        "linear_central",
    )
    # Refused, it still says what was odd in it.
    file.write_text(
        REAR_END.replace("80 km/h", "-80 km/h").replace('"950 kg"', '"950 kg"\nheading = 90'),
        encoding="utf-8",
    )
    code, text, complaints = run(capsys, file)
    warned, refused = complaints.splitlines()
    assert (code, text) == (1, "")
    assert warned.startswith(f"{file}: warning: heading = 90 is read as rad")
    assert refused.startswith(f"{file}: linear_central: no impact: ")
    code, text, _ = run(capsys, file, "--json")
    assert json.loads(text)["warnings"] == [warned.removeprefix(f"{file}: warning: ")]
    file.write_text(REAR_END + "[report]\nduration = 100\n", encoding="utf-8")
    code, text, complaints = run(capsys, file)
    assert (code, complaints.startswith(f"{file}: warning: "), text.startswith("Impact of A")) == (
        0,
        True,
        True,
    )
    with pytest.raises(SystemExit, match="2"):
        main(["--nothing"])


@pytest.mark.slow
def test_new_prints_a_case_that_runs(tmp_path, capsys):
    """As it is, without a warning; in a process of its own."""
    code, text, _ = run(capsys, "new")
    assert code == 0
    file = tmp_path / "case.toml"
    file.write_text(text, encoding="utf-8")
    command = [sys.executable, "-W", "error", "-m", "collisions", str(file)]
    found = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    assert (found.returncode, found.stderr) == (0, "")
    assert "a.delta_v" in found.stdout
    assert max(map(len, text.splitlines())) < 80


@pytest.mark.slow
def test_the_schema_is_that_of_the_functions(capsys):
    """Every argument, every solver; what it refuses is refused, and the examples pass."""
    jsonschema = pytest.importorskip("jsonschema")
    import tomllib

    schema = json.loads(run(capsys, "schema")[1])
    assert schema == case_schema()
    check = jsonschema.Draft7Validator(schema)
    check.check_schema(schema)
    for path in (
        *CASES.glob("*.toml"),
        ROOT / "src" / "collisions" / "cases" / "case_template.toml",
    ):
        assert not [
            error.message
            for error in check.iter_errors(tomllib.loads(path.read_text(encoding="utf-8")))
        ], path
    for text in (
        REAR_END.replace("vx", "vxx"),
        REAR_END.replace("restitution", "e"),
        REAR_END.replace('"1100 kg"', "true"),
        ECCENTRIC.replace("point = [0, 0]", "point = 3"),
        ECCENTRIC.replace("friction = 0.5", 'friction = 0.5\nlaw = "newton"'),
        "[reconstruct.speeds]\nregime = 'stuck'\n",
    ):
        assert list(check.iter_errors(tomllib.loads(text)))
    tables = schema["properties"] | {
        f"reconstruct.{name}": one
        for name, one in schema["properties"]["reconstruct"]["properties"].items()
    }
    for name, function in (SOLVERS | STUDIES).items():
        listed = {
            key for key in parameters(function) if parameters(function)[key].annotation != "Vehicle"
        }
        assert set(tables[name]["properties"]) - {"outputs"} == listed - {"outputs"}
    assert tables["eccentric"]["properties"]["law"]["enum"][:2] == ["brach", "kudlich-slibar"]
    assert (
        "Coefficient of restitution"
        in tables["eccentric"]["properties"]["restitution"]["description"]
    )
    assert DISTRIBUTIONS.keys() <= schema["$defs"]["function"]["properties"].keys()


def test_the_text_is_that_of_any_editor():
    """Line ends of Windows, marks of the encoding, and what PowerShell makes of the output of
    ``new``.
    """
    text = REAR_END.replace("[a]", '[a]\nname = "Käfer"')
    wanted = solved(text)
    for data in (
        text.encode("utf-8-sig"),
        text.replace("\n", "\r\n").encode(),
        text.replace("\n", "\r\n").encode("utf-16"),
    ):
        assert answers(read_text(data)).results == (wanted,)
    for data in (text.encode("latin-1"), text.encode("utf-16")[:-1]):
        with pytest.raises(CaseError, match="is no text in UTF-8; save it with this encoding"):
            read_text(data)


@pytest.mark.slow
@pytest.mark.parametrize("text", ["x = {}{}", "{} = 1", "[{}]\nx = 1"])
def test_what_is_nested_too_deeply_is_refused(text):
    """Lists in lists, and keys and heads of tables of many parts; fewer than here are read by some
    versions of Python. A file of any length is refused at once.
    """
    for depth in (3000, 450_000):
        key = [".".join(part * depth) for part in ("a", ["'a'"], ['"\\""'])]
        for parts in [("[" * depth, "]" * depth)] if "{}{}" in text else [(one,) for one in key]:
            with pytest.raises(CaseError, match=r"nested too deeply|larger than 1 MB"), _promptly():
                read_text(text.format(*parts).encode())


@pytest.mark.parametrize(
    ("marked", "said", "in_a_file"),
    [
        ("write `friction=0`, or give `impulse_ratio=`", "write friction=0, or give impulse_ratio=",
            "write friction = 0, or give impulse_ratio"),
        ("write `normal=(-1, 0)`, got `(1, 0)`", "write normal=(-1, 0), got (1, 0)",
            "write normal = [-1, 0], got [1, 0]"),
        ("got `'a=(1, 2), None'` and `incomplete=True`", "got 'a=(1, 2), None' and incomplete=True",
            "got 'a=(1, 2), None' and incomplete = true"),
        ("`crush_a=('60 kN/m', '1 m')` or `duration='9 ms'`",
            "crush_a=('60 kN/m', '1 m') or duration='9 ms'",
            "crush_a = ['60 kN/m', '1 m'] or duration = '9 ms'"),
        ("as by `Normal(mean, sd, truncate=(low, high))`",
            "as by Normal(mean, sd, truncate=(low, high))",
            "as by { Normal = { mean = ..., sd = ..., truncate = [low, high] } }"),
        ("write `Censored(low=...)`", "write Censored(low=...)",
            "write { Censored = { low = ... } }"),
        ("write `Normal.between(low, high, 0.95)`", "write Normal.between(low, high, 0.95)",
            'write "low .. high (95 %)"'),
        ("such as `Normal('50 km/h', '10 km/h')`", "such as Normal('50 km/h', '10 km/h')",
            'such as "50 km/h +/- 10 km/h"'),
        ("of `Uniform(low, high)`", "of Uniform(low, high)", 'of "low .. high"'),
        ("such as `{'tyre_impulse': 0.2}`, got `{'a': {'b': [True]}}`",
            "such as {'tyre_impulse': 0.2}, got {'a': {'b': [True]}}",
            "such as {tyre_impulse = 0.2}, got {a = {b = [true]}}"),
        ("`observed['a.delta_v']` and `unknowns['a.vx']`",
            "observed['a.delta_v'] and unknowns['a.vx']", 'observed."a.delta_v" and a.vx'),
        ("`reconstruct.fit` or `reconstruct.speeds`", "reconstruct.fit or reconstruct.speeds",
            "[fit] or reconstruct.speeds"),
        ("a number`|, an array or a Quantity| or a text`", "a number, an array or a Quantity",
            "a number or a text"),
        ("so`|; both are in .solutions|`", "so; both are in .solutions", "so"),
        ("got `'a|b', ('c', ...`", "got 'a|b', ('c', ...", "got 'a|b', ('c', ..."),
        ("the mark ` of a name", "the mark ` of a name", "the mark ` of a name"),
    ],
)  # fmt: skip
def test_code_in_messages_is_said_in_words_of_files(marked, said, in_a_file):
    """What Python writes as calls, arguments and tuples are tables, keys and lists; texts that were
    given stay.
    """
    assert (str(col.InputError(marked)), in_file_words(marked)) == (said, in_a_file)


@pytest.mark.parametrize("text", ["`", "``", "a`b`c", "`|x|y`", "5 `kg`"])
def test_backquotes_of_a_user_are_no_marks(text):
    """They are shown as they were given, in Python and in a file."""
    with pytest.raises(col.UnitsError) as caught:
        col.Vehicle(mass=text)
    assert f"cannot read {text!r}" in str(caught.value)
    assert f"cannot read {text!r}" in problems(REAR_END.replace("1100 kg", text))[0]


def test_the_cures_of_messages_work_in_a_file():
    """What is to be written is read: a truncation with one open end, in the place of None, and a
    pair in brackets.
    """
    cured = REAR_END.replace("0.4", "{ Normal = { mean = 0.1, sd = 0.2, truncate = [0, inf] } }")
    (found,) = read_text(cured.encode()).uncertain.values()
    assert found.stated.truncate == (0.0, None)
    assert problems(cured.replace("[0, inf]", "[inf, 1]"))[0].startswith(
        "linear_central.restitution.Normal.truncate[0]: truncate[0] must be finite, got inf; "
        "write -inf for a lower end"
    )
    whole = answers(read_text((REAR_END + "[report]\nlimits = 3\n").encode()))
    with pytest.raises(
        CaseError,
        match=re.escape(
            "report.limits: limits must be a table from code to limit, such as {tyre_impulse = 0.2}"
        ),
    ):
        whole.text()
    least = REAR_END.replace("linear_central", "solve")
    assert (
        "solve.normal: is missing; give it: Direction from A into B at the contact"
        in problems(least)[0]
    )


@pytest.mark.slow
def test_a_study_warns_once_with_the_number_of_its_cases():
    """A speed that comes out backwards in each call of the study is one line; without a study it
    has the units of the file.
    """
    text = (
        '[reconstruct.momentum]\nmass_a = "3400 lb"\nmass_b = "2900 lb"\ncourse_a = "0 deg"\n'
        'course_b = "20 deg .. 60 deg"\ncourse_a_after = "25 deg +/- 3 deg"\ncourse_b_after = '
        '"-40 deg +/- 10 deg"\nspeed_a_after = "20 mph"\nspeed_b_after = "25 mph +/- 4 mph"\n'
    )
    whole = answers(read_text(text.encode()))
    whole.text()
    negative = int((whole.propagation["speed_b"].values < 0.0).sum())
    assert 0 < negative < 8192
    assert [line for line in whole.warnings if "backwards" in line] == [
        (
            f"{negative} of 8192 cases ({100 * negative / 8192:.3g} %): speed_b is below 0, "
            "backwards along its course; check the courses, or turn its course by 180 deg"
        )
    ]
    alone = re.sub(r"20 deg \.\. 60", "40", re.sub(r" \+/- [^\"]*", "", text))
    (line,) = answers(read_text(alone.encode())).warnings
    speed = solved(alone).q.speed_b.m_as("mph")
    assert line.startswith(f"speed_b = {speed:.6g} mph: backwards along its course")


def test_a_range_of_directions_in_degrees_is_no_suspect_number():
    """What the study hands on in radians was written with its unit."""
    text = (
        ECCENTRIC.replace('normal = "0 deg"', 'normal = "358 deg .. 370 deg"')
        + "[propagate]\nmethod = 'quasi_random'\nsamples = 64\n"
    )
    assert answers(read_text(text.encode())).warnings == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "wanted"),
    [
        ("intersection_with_recorder.toml",
            ["| A (Saloon) | mass | 1500 kg. Stated as 1500 ± 50 kg |",
                ("2364.147 kg·m². Worked out by reference.yaw_inertia from mass 1500 kg; "
                 "length 4.6 m; wheelbase 2.7 m |"),
                 ("| contact | restitution e | 0.125. Stated as 0.05 to 0.2, all values "
                        "equally likely |"),
                        "| evidence | delta-V of the Saloon | 20.9 km/h. Stated as 20.9 ± 1 km/h |",
                        "| evidence | course of the Hatchback before | 90°. Stated as 90 ± 2° |"]),
        ("run_out.toml",
            [("| A | speed after | 46.21 km/h. Worked out by travel.speed from distance 12 m; "
              "drag 0.6 to 0.8, all values equally likely |"),
              "| B | course after | 40°. Stated as 40 ± 3° |"]),
    ],
)  # fmt: skip
def test_a_report_states_the_inputs_as_the_file_does(file, wanted):
    """The middle of a range is no exact input: its range stands beside it, and beside evidence what
    it was worked out from.
    """
    page = answers(read(CASES / file)).report("markdown").replace("\\_", "_")
    for line in wanted:
        assert line in page, line


def test_a_velocity_that_a_reverse_solver_finds_is_not_passed_over():
    """Of ``speeds`` the vehicles have none; what is known of their motion stands in its table."""
    text = (
        (CASES / "intersection_with_recorder.toml")
        .read_text(encoding="utf-8")
        .replace("[b]\n", '[b]\nspeed = "40 km/h"\ncourse = 1.5\nvx = 3\n')
    )
    lines = problems(text)
    assert (
        "b.speed: is what reconstruct.speeds finds; leave it out, and write speed_b in "
        "[reconstruct.speeds] if it is known" in lines
    )
    assert (
        "b.vx: is what reconstruct.speeds finds; leave it out, and write course_b in "
        "[reconstruct.speeds] if it is known" in lines
    )


def test_the_page_says_which_solver_takes_vehicles():
    """The row of the tables of vehicles names each solver that has none, or has others."""
    (row,) = [
        line
        for line in (ROOT / "docs" / "case_files.md").read_text(encoding="utf-8").splitlines()
        if line.startswith("| `[a]`, `[b]` |")
    ]
    none = {name for name, solver in SOLVERS.items() if vehicles(solver) == []}
    others = {name for name, solver in SOLVERS.items() if vehicles(solver) not in ([], ["a", "b"])}
    assert (none, others) == (
        {"reconstruct.central", "reconstruct.momentum"},
        {"reconstruct.planar"},
    )
    assert all(f"`{name}`" in row for name in none | others)


@pytest.mark.slow
def test_notes_of_the_file_stand_beside_what_it_states():
    """Both, of the same input and in paragraphs; what the page has no row for is a
    paragraph too.
    """
    text = (
        REAR_END.replace("80 km/h", "80 km/h +/- 2 km/h")
        .replace("vx", "course = 0\nspeed")
        .replace("[b]", '[b]\nyaw_inertia = "1 kg*m**2 .. 2 kg*m**2"')
    )
    text += (
        '[report]\nnotes = ["Own words.", { restitution = "From tests", "a.speed" = "By the '
        'recorder" }]\n'
    )
    page = answers(read_text(text.encode())).report("markdown")
    assert "| A | speed | 80 km/h. Stated as 80 ± 2 km/h. By the recorder |" in page
    assert "| contact | restitution e | 0.4. From tests |" in page
    assert "\nOwn words.\n" in page
    evidence = (
        "[a]\nmass = 1100\ncourse = 0\nspeed = { travel.speed = { distance = 12, drag = 0.7 } }\n"
        + REAR_END[REAR_END.index("[b]") :]
    )
    assert "a.speed: Worked out by travel.speed from distance 12 m; drag 0.7." in answers(
        read_text(evidence.encode())
    ).report("markdown")


@pytest.mark.slow
def test_both_pages_or_none(tmp_path, capsys):
    """A page that cannot be made or written leaves neither, says so, and the results are printed
    all the same.
    """
    file, page, sliders = tmp_path / "case.toml", tmp_path / "page.md", tmp_path / "sliders.html"
    file.write_text(REAR_END, encoding="utf-8")
    code, said, complaints = run(capsys, file, "--report", page, "--what-if", sliders)
    assert (code, said.startswith("Impact of A")) == (2, True)
    assert complaints.startswith(f"{file}: what_if.ranges: is not there")
    code, said, _ = run(capsys, file, "--report", page, "--what-if", sliders, "--json")
    assert (code, json.loads(said)["errors"][0]["key"], len(json.loads(said)["results"])) == (
        2,
        "what_if.ranges",
        1,
    )
    file.write_text(REAR_END + "[what_if.ranges]\nrestitution = [0.1, 0.5]\n", encoding="utf-8")
    sliders.mkdir()
    code, said, complaints = run(capsys, file, "--report", page, "--what-if", sliders)
    assert (code, said.startswith("Impact of A")) == (2, True)
    assert f"cannot write {sliders} (Is a directory), and nothing was written" in complaints
    assert sorted(path.name for path in tmp_path.iterdir()) == ["case.toml", "sliders.html"]
    sliders.rmdir()
    own = page.with_name("page.md.part")
    own.write_text("of the user", encoding="utf-8")
    assert run(capsys, file, "--report", page, "--what-if", sliders)[0] == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "case.toml",
        "page.md",
        "page.md.part",
        "sliders.html",
    ]
    assert own.read_text(encoding="utf-8") == "of the user"


def link_or_skip(link, target):
    """A symbolic link, which Windows lets only some users make."""
    try:
        link.symlink_to(target)
    except (OSError, NotImplementedError) as error:
        pytest.skip(f"no symbolic link can be made here: {error}")


def test_one_file_by_two_names(tmp_path, capsys):
    """Neither page is written over the other, nor over the case; by a link neither."""
    file, page = tmp_path / "case.toml", tmp_path / "page.html"
    file.write_text(REAR_END + "[what_if.ranges]\nrestitution = [0.1, 0.5]\n", encoding="utf-8")

    def refused(other):
        code, _, complaints = run(capsys, file, "--report", page, "--what-if", other)
        said = f"{file}: --what-if cannot write {other}; give a name of its own"
        assert (code, complaints.startswith(said)) == (2, True)

    refused(tmp_path / "none" / ".." / "page.html")
    link, over = tmp_path / "link.html", tmp_path / "over.html"
    link_or_skip(link, page)
    refused(link)
    link_or_skip(over, file)
    assert run(capsys, file, "--report", over)[0] == 2
    assert "linear_central" in file.read_text(encoding="utf-8")


def test_a_key_that_stops(tmp_path, capsys, monkeypatch):
    """Ctrl-C ends with a line."""
    file = tmp_path / "case.toml"
    file.write_text(REAR_END, encoding="utf-8")

    def stopped(case):
        raise KeyboardInterrupt

    monkeypatch.setattr("collisions.cases.answers.answers", stopped)
    assert run(capsys, file) == (130, "", "stopped; nothing more was written\n")


@pytest.mark.slow
def test_new_has_the_units_that_are_asked_for(tmp_path, capsys):
    """In US units no metric one, in the same tables with the same keys; other options
    are refused.
    """
    file, texts = tmp_path / "case.toml", {}
    for units in ("metric", "si", "us"):
        code, texts[units], _ = run(capsys, "new", "--units", units)
        assert code == 0
        file.write_text(texts[units], encoding="utf-8")
        case = read(file)
        assert case.report["units"] == units
        assert len(case.uncertain) == 5
        assert answers(case).warnings == []
    assert texts["metric"] == run(capsys, "new")[1]
    assert not re.search(r"\d (km/h|kg|m)\b", texts["us"])
    keys = [
        [line.partition(" =")[0] for line in text.splitlines() if line[:1] != "#"]
        for text in texts.values()
    ]
    assert keys[0] == keys[1] == keys[2]
    assert max(map(len, texts["us"].splitlines())) < 80
    assert run(capsys, "new", "--report", "page.html") == (
        2,
        "",
        "new: takes --units and --scene; leave out --report\n",
    )
    assert run(capsys, "schema", "--units", "us") == (
        2,
        "",
        "schema: takes no options; leave out --units\n",
    )


def test_nothing_is_evaluated():
    """Texts that Python or pint would work out are refused as what they are."""
    for text in ("__import__('os')", "2*3", "9**9**9 kg", "1e3+1"):
        assert problems(REAR_END.replace("1100 kg", text))[0].startswith("a.mass: ")
    assert math.isinf(solved(REAR_END.replace('"950 kg"', "inf")).b.before.mass)


def test_every_solver_has_its_table():
    """A solver that is added is a table of case files too; so is a study of uncertain numbers."""
    answers_of = {"Impact", "MomentumSolution", "tuple[Impact, ...]"}
    solvers = {name: getattr(col, name) for name in col.__all__} | {
        f"reconstruct.{name}": getattr(reconstruct, name) for name in reconstruct.__all__
    }
    found = {
        name
        for name, one in solvers.items()
        if getattr(one, "__annotations__", {}).get("return") in answers_of
    }
    assert found == set(SOLVERS)
    assert all(SOLVERS[name] is solvers[name] for name in found)


def test_a_case_in_us_units_is_answered_in_them(tmp_path, capsys):
    text = (
        '[a]\nmass = "3400 lb"\nvx = "30 mph"\n\n[b]\nmass = "2900 lb"\n\n[linear_central]\n'
        "restitution = 0.1\n"
    )
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    assert main([str(tmp_path / "case.toml")]) == 0
    assert "30.0 mph" in capsys.readouterr().out


def test_a_page_of_sliders_is_refused_with_tyres_in_words_of_the_file():
    """Its reader writes no code."""
    tyres = "[eccentric.tyres_b]\nfriction = 0.7\nlock = 0.1\nwheelbase = 2.6\ntrack = 1.5\n"
    text = ECCENTRIC.replace("restitution = 0.1", 'restitution = 0.1\nduration = "100 ms"') + tyres
    found = answers(read_text(text.encode()))
    with pytest.raises(CaseError, match="leave the duration and the tables of tyres out") as e:
        found.what_if()
    assert "impact.again" not in str(e.value)


def test_sliders_of_what_is_uncertain_stay_where_the_solver_can_go():
    """Three deviations of a normal restitution reach below 0, where no slider may be."""
    text = ECCENTRIC.replace("restitution = 0.1", 'restitution = "0.1 +/- 0.15"')
    page = answers(read_text(text.encode())).what_if()
    low, high = re.search('id="restitution" min="(.*?)" max="(.*?)"', page).groups()
    assert float(low) == 0.0
    assert float(high) == pytest.approx(0.55)


def test_the_share_of_a_normal_distribution_leaves_its_unit():
    """What is stated in lb is given back in lb; two standard deviations are 95.45 percent (tables
    of the normal).
    """
    found = parse_uncertain("3300 lb +/- 90 lb (95 %)")
    assert str(found) == "3210 to 3390 lb (95 percent), normal"
    assert found.sd == pytest.approx(90 / 1.959964 * 0.45359237, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    "study", ["", '[posterior.observed]\n"a.delta_v" = "20 km/h +/- 2 km/h"\n']
)
def test_directions_about_a_turn_with_their_unit_are_not_suspected(study):
    """360 deg is no bare number, however it is drawn from; the variances are drawn of it too."""
    text = ECCENTRIC.replace(
        'vy = "40 km/h"', 'speed = "2 km/h"\ncourse = "350 deg .. 370 deg"'
    ).replace('"90 deg"', "0.0")
    found = answers(read_text((text + study).encode()))
    found.text()
    assert not [one for one in found.warnings if "is read as" in one]


def test_a_study_of_nothing_says_so():
    """The table is not passed over in silence; the case has its answer all the same."""
    found = answers(read_text((ECCENTRIC + "[propagate]\nsamples = 64\n").encode()))
    assert found.propagation is None
    assert found.results == (solved(ECCENTRIC),)
    assert found.warnings == [
        (
            '[propagate] has nothing to propagate; write a number with its error, such as "50 '
            'km/h +/- 3 km/h"'
        )
    ]
    assert answers(read_text(ECCENTRIC.encode())).warnings == []


def test_a_range_without_units_is_refused_where_a_unit_is_needed():
    """As one number in a text is; of a share it is read."""
    for key, range_, said in (
        ("speed", "50 .. 60", "50 to 60"),
        ("course", "6.5 .. 7", "6.5 to 7"),
        ("mass", "3300 +/- 90", "3300 ± 90"),
    ):
        text = ECCENTRIC.replace('vx = "50 km/h"', "speed = 14.0\ncourse = 0.0")
        text = re.sub(rf"^{key} = .*$", f'{key} = "{range_}"', text, count=1, flags=re.MULTILINE)
        assert problems(text)[0].startswith(
            f"a.{key}: {said} has no unit; write one plain number and one unit, such as"
        )
    friction = re.sub("^friction = .*$", 'friction = "0.4 .. 0.7"', ECCENTRIC, flags=re.MULTILINE)
    (one,) = read_text(friction.encode()).uncertain.values()
    assert one.nominal == "0.55"


@pytest.mark.slow
def test_a_slider_for_what_an_impact_leaves_as_it_was(tmp_path, capsys):
    """The mass of [a_after] is that before; its speed is not."""
    impact = solved(ECCENTRIC)
    text = (
        ECCENTRIC.replace("[eccentric]", "[reconstruct.planar]")
        .replace("[a]", "[a_after]")
        .replace("[b]", "[b_after]")
    )
    a, b = impact.a.after, impact.b.after
    text = text.replace("mass = 1500", 'mass = "1500 kg +/- 40 kg"').replace(
        'vx = "50 km/h"', f"vx = {a.vx!r}\nvy = {a.vy!r}\nyaw_rate = {a.yaw_rate!r}"
    )
    text = text.replace(
        'vy = "40 km/h"',
        f'vx = {b.vx!r}\nvy = "{b.vy!r} m/s +/- 0.1 m/s"\nyaw_rate = {b.yaw_rate!r}',
    )
    page = answers(read_text(text.encode())).what_if()
    assert re.findall(r'<input type="range" id="(\w+)"', page) == ["mass_a"]


def test_what_is_wrong_with_the_command_is_one_line(capsys):
    """As with every mistake."""
    for arguments in ([], ["case.toml", "--units", "imperial"], ["case.toml", "other.toml"]):
        with pytest.raises(SystemExit) as caught:
            main(arguments)
        assert caught.value.code == 2
        assert len(capsys.readouterr().err.splitlines()) == 1


def test_the_schema_knows_the_sliders():
    """Those that the reader takes, as pairs."""
    ranges = case_schema()["properties"]["what_if"]["properties"]["ranges"]
    assert ranges["additionalProperties"] is False
    assert {"speed_a", "heading_b", "normal", "point_x", "friction"} <= ranges["properties"].keys()


def test_the_text_says_what_stands_for_a_range():
    """The results of the middle are called so, before they are given."""
    first, *_ = (
        answers(read_text(REAR_END.replace("0.4", '"0.2 .. 0.4"').encode())).text().splitlines()
    )
    assert first.startswith("Of what is not known exactly the mean")
    assert answers(read_text(REAR_END.encode())).text().startswith("Impact of A and B")


def test_the_units_of_a_file_are_those_of_its_answer_unless_the_command_says_otherwise(
    tmp_path, capsys
):
    """Its numbers are in km/h; [report] asks for US units, and --units goes before that."""
    file = tmp_path / "case.toml"
    file.write_text(REAR_END + '[report]\nunits = "us"\n', encoding="utf-8")
    code, said, _ = run(capsys, file)
    assert code == 0
    assert "mph" in said
    assert "km/h" not in said
    said = run(capsys, file, "--units", "metric")[1]
    assert "km/h" in said
    assert "mph" not in said


def test_an_answer_by_number_does_not_decide_what_is_refused_as_ambiguous():
    text = (
        "answer = 1\n[reconstruct.central]\nmass_a = 1100\nmass_b = 950\nvb = 0.0\n"
        "va_after = 7.83\nenergy_loss = 106e3\n"
    )
    with pytest.raises(CaseError) as refused:
        answers(read_text(text.encode()))
    (key, says), (other, why) = refused.value.problems
    assert (key, other) == ("reconstruct.central", "answer")
    assert "what decides is va or vb_after" in says
    assert "needs another number that decides" in why


@pytest.mark.parametrize("wrong", ["0", "false", "[]", "{}", '""', '"imperial"'])
def test_units_of_a_report_that_are_none_are_refused(wrong, tmp_path, capsys):
    file = tmp_path / "case.toml"
    file.write_text(f"{REAR_END}[report]\nunits = {wrong}\n", encoding="utf-8")
    code, _, said = run(capsys, file)
    assert code == 2
    assert "units" in said


@pytest.mark.parametrize(
    ("option", "said"),
    [
        ("title = 5", "report.title: must be a text that says something, got 5"),
        ("title = {}", "report.title: must be a text that says something, got {}"),
        ("author = ''", "report.author: must be a text that says something, got ''"),
        ("date = 2024-05-01", "report.date: is a date or a time"),
        ("notes = 5", "report.notes: must be a text, a list of texts, or a table of them by input"),
        ("notes = [5]", "report.notes: must be a text that says something, got 5"),
        ("figures = 1", "report.figures: must be true or false, got 1"),
        ("derivation = 'no'", "report.derivation: must be true or false, got 'no'"),
        ("share_a = 2", "report.share_a: must be"),
        ("answers = 'a.delta_v'", "report.answers: must be a list of names of what was found"),
    ],
)
def test_options_that_no_report_can_use_are_refused_also_where_none_is_written(
    option, said, tmp_path, capsys
):
    file = tmp_path / "case.toml"
    file.write_text(f"{REAR_END}[report]\n{option}\n", encoding="utf-8")
    code, text, complaints = run(capsys, file)
    assert (code, text) == (2, "")
    assert complaints.startswith(f"{file}: {said}")
    assert complaints.count("\n") == 1
    assert run(capsys, file, "--report", tmp_path / "page.html")[2] == complaints


def test_shares_of_a_variance_begin_with_the_largest_and_tell_those_below_five_percent():
    """Of equal masses, one at rest, delta-V is (1 + e) vx / 2: an error of 10 % in vx and one of 2
    % in 1 + e, so shares of 100 and 4 out of 104.
    """
    text = (
        '[a]\nmass = 1000\nvx = "20 m/s +/- 2 m/s"\n\n[b]\nmass = 1000\n\n[linear_central]\n'
        'restitution = "0.25 +/- 0.025"\n\n[propagate]\nmethod = "first_order"\n'
        'outputs = ["a.delta_v"]\n'
    )
    (line,) = [
        one
        for one in answers(read_text(text.encode())).text().splitlines()
        if one.startswith("Variance of")
    ]
    assert re.findall(r"([\w.]+) (\d+)", line.split(": ")[1]) == [
        ("a.vx", "96"),
        ("restitution", "4"),
    ]


def test_sliders_of_what_is_uncertain_reach_three_deviations_or_its_bounds():
    """Of a normal distribution three to either side, of a range its ends; a restitution ends at
    1.
    """
    text = ECCENTRIC.replace('vx = "50 km/h"', 'vx = "14 m/s +/- 1.5 m/s"')
    text = text.replace("mass = 1200", 'mass = "1100 kg .. 1350 kg"')
    text = text.replace("restitution = 0.1", 'restitution = "0.8 +/- 0.1"')
    page = answers(read_text(text.encode())).what_if("si")
    ends = {
        name: (float(low), float(high))
        for name, low, high in re.findall('id="(\\w+)" min="(.*?)" max="(.*?)"', page)
    }
    assert ends == {
        "vx_a": pytest.approx((9.5, 18.5)),
        "mass_b": pytest.approx((1100.0, 1350.0)),
        "restitution": pytest.approx((0.5, 1.0)),
    }


GIVEN_BY = {
    "m/s": "{ travel.speed = { distance = 12, drag = 0.7 } }",
    "kg*m**2": "{ reference.yaw_inertia = { mass = 1500, length = 4.6, wheelbase = 2.7 } }",
}
MISPLACED = [
    ("a.mass", "mass = 1500", "m/s", "kg"),
    ("a.yaw_inertia", "yaw_inertia = 2400", "m/s", "kg*m**2"),
    ("a.x", "x = -2.0", "m/s", "m"),
    ("a.heading", 'heading = "0 deg"', "m/s", "rad"),
    ("a.vx", 'vx = "50 km/h"', "kg*m**2", "m/s"),
    ("eccentric.restitution", "restitution = 0.1", "m/s", "a plain number"),
    ("eccentric.point[0]", "point = [0", "kg*m**2", "m"),
    ("eccentric.normal", 'normal = "0 deg"', "m/s", "rad"),
]


@pytest.mark.parametrize(("key", "line", "gives", "needs"), MISPLACED)
@pytest.mark.parametrize("study", ["", "[propagate]\n", "[posterior]\nsamples = 512\n"])
def test_what_a_function_gives_has_to_be_of_the_kind_that_is_needed(key, line, gives, needs, study):
    """A speed is no mass: its unit is checked as that of a text is."""
    name = line.partition(" = ")[0]
    value = f"[{GIVEN_BY[gives]}" if "[" in line else GIVEN_BY[gives]
    text = ECCENTRIC.replace(line, f"{name} = {value}", 1)
    if study:
        text = text.replace("mass = 1200", 'mass = "1100 kg .. 1300 kg"') + study
    if "posterior" in study:
        text += '[observed]\n"a.delta_v" = "25 km/h +/- 5 km/h"\n'
    (found,) = problems(text)
    assert found.startswith(f"{key}: ")
    assert f"which gives {gives}, and cannot be taken as {needs}" in found


def test_a_function_within_a_function_and_ranges_in_it_are_checked_too():
    """Whatever stands inside: the key of the argument is named."""
    mass = 'mass = { travel.speed = { distance = "12 m .. 13 m", drag = 0.7 } }'
    (found,) = problems(ECCENTRIC.replace("mass = 1500", mass))
    assert found.startswith("a.mass: mass is worked out by travel.speed, which gives m/s")
    inner = GIVEN_BY["kg*m**2"]
    speed = f"vx = {{ travel.speed = {{ distance = {inner}, drag = 0.7 }} }}"
    (found,) = problems(ECCENTRIC.replace('vx = "50 km/h"', speed))
    assert found.startswith("a.vx.travel.speed.distance: distance is worked out by reference.yaw")
    end = (
        f"vx = {{ travel.speed = {{ distance = 12, drag = 0.7, end_speed = {GIVEN_BY['m/s']} }} }}"
    )
    before = travel.speed(12, drag=0.7, end_speed=travel.speed(12, drag=0.7))
    assert solved(ECCENTRIC.replace('vx = "50 km/h"', end)).a.before.vx == before


def test_a_number_that_a_function_gives_is_not_shown_as_given():
    """It was worked out: in the record it is a number, and it does not choose the units."""
    text = ECCENTRIC.replace("yaw_inertia = 2400", f"yaw_inertia = {GIVEN_BY['kg*m**2']}")
    found = solved(text.replace('"50 km/h"', '"30 mph"').replace('"40 km/h"', '"25 mph"'))
    assert isinstance(found.to_dict()["inputs"]["a"]["yaw_inertia"], float)
    assert "mph" in str(found.summary())


def test_the_unit_of_each_function_is_that_of_its_docstring():
    """By what it says that it returns."""
    assert GIVES.keys() == FUNCTIONS.keys() - DISTRIBUTIONS.keys()
    for name, unit in GIVES.items():
        returns = getdoc(FUNCTIONS[name]).partition("Returns\n-------\n")[2].partition("\n")[0]
        assert returns == f"float or array [{unit}]"


OBSERVED = [
    '"25 +/- 1"', '["25", "1"]', '["25", 1]', '"25 .. 26"', '"24 .. 26 (95 %)"',
    '{ Normal = { mean = "25", sd = "1" } }', '{ Interval = { low = "5", high = "26" } }',
    '{ Censored = { high = 5, error = "1" } }',
]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("reading", OBSERVED)
@pytest.mark.parametrize("study", ["posterior", "fit"])
def test_a_reading_as_a_text_needs_its_unit(study, reading):
    """The same text of an input is refused; a bare number is in SI."""
    text = REAR_END.replace('"80 km/h"', '"50 km/h +/- 10 km/h"')
    (found,) = problems(f'{text}[{study}]\n[observed]\n"a.delta_v" = {reading}\n')
    assert found.startswith(f'{study}.observed."a.delta_v": ')
    kind = "is weighed by [posterior]" in found and study == "fit"
    assert kind or re.search(r"'\d+' has no unit; write for example '80 km/h'", found)
    bare = solved(f'{text}[{study}]\n[observed]\n"a.delta_v" = [7, 1]\n')
    assert solved(f'{text}[{study}]\n[observed]\n"a.delta_v" = "7 m/s +/- 1 m/s"\n') is not bare


@pytest.mark.slow
def test_a_reading_of_a_plain_number_needs_no_unit():
    """A restitution has none, and may be in percent."""
    text = REAR_END.replace('"80 km/h"', '"50 km/h +/- 10 km/h"').replace("0.4", '"0.1 .. 0.5"')
    for reading in ('"0.3 +/- 0.05"', '"30 % +/- 5 %"', '["0.3", "0.05"]'):
        end = f"[posterior]\nsamples = 512\n[observed]\nrestitution = {reading}\n"
        assert solved(text + end)["restitution"].mean == pytest.approx(0.3, abs=0.03)
    end = '[posterior]\nsamples = 512\n[observed]\nrestitution = "3 km/h +/- 1 km/h"\n'
    assert "the model returns it as a plain number" in problems(text + end)[0]
    percent = end.replace("restitution", '"a.delta_v"').replace("km/h", "%")
    assert "is in %, but the model returns it in m/s" in problems(text + percent)[0]


@pytest.mark.parametrize("study", ["propagate", "posterior", "fit"])
@pytest.mark.parametrize(
    "speed", ['"40 .. 60"', '"40 +/- 2"', '{ Uniform = { low = "40", high = "60" } }']
)
def test_an_uncertain_number_as_a_text_needs_its_unit_in_every_study(study, speed):
    """Only a study that solves the case with what stands for it refused it."""
    text = f"{REAR_END.replace(chr(34) + '80 km/h' + chr(34), speed)}[{study}]\n"
    if study != "propagate":
        text += '[observed]\n"a.delta_v" = "25 km/h +/- 1 km/h"\n'
    (found,) = problems(text)
    assert re.match(r"a\.vx: 40 (to|±) 6?0?2? ?has no unit; write", found)


@pytest.mark.parametrize("study", ["propagate", "posterior"])
@pytest.mark.parametrize(
    ("line", "text", "key", "wanted"),
    [
        ('vx = "50 km/h"', 'vx = "0.4 m .. 0.7 m"', "a.vx: 0.4 to 0.7 m", "m/s"),
        ("point = [0", 'point = ["0.4 kg .. 0.7 kg"', "eccentric.point[0]: 0.4 to 0.7 kg", "m"),
    ],
)
def test_a_range_in_a_wrong_unit_is_not_said_to_have_none(study, line, text, key, wanted):
    """It has one, and the message says of which kind it should be."""
    file = f"{ECCENTRIC.replace(line, text)}[{study}]\n"
    file += '[observed]\n"a.delta_v" = "9 m/s +/- 1 m/s"\n' if study == "posterior" else ""
    (found,) = problems(file)
    assert found.startswith(f"{key} cannot be taken as {wanted} (")
    assert "; write for example" in found
    assert "has no unit" not in found


@pytest.mark.parametrize("study", STUDIES)
def test_a_wrong_key_of_a_study_is_answered_with_keys_that_a_file_may_have(study):
    """Each once; a finer model is a function, which a file cannot give."""
    text = REAR_END.replace('"80 km/h"', '"50 km/h +/- 10 km/h"')
    end = "" if study == "propagate" else '[observed]\n"a.delta_v" = "7 m/s +/- 1 m/s"\n'
    for key in ("foo", "finer", "finer_samples"):
        found = problems(f"{text}[{study}]\n{key} = 1\n{end}")[0]
        assert found.startswith(f"{study}.{key}: is not known here")
        listed = re.findall(r"\w+", found.partition("write one of ")[2])
        assert len(listed) == len(set(listed))
        assert not {"finer", "finer_samples"} & {*listed}


@pytest.mark.slow
def test_output_that_nobody_reads_ends_quietly(tmp_path):
    """As in `| head`, which closes the pipe when it has enough."""
    file = tmp_path / "case.toml"
    file.write_text(REAR_END, encoding="utf-8")
    command = [sys.executable, "-m", "collisions", str(file), "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as started:
        started.stdout.close()
        assert started.stderr.read() == b""
    assert started.returncode == 141


SLID = (
    '[a]\nmass = "1500 kg"\nyaw_inertia = "2500 kg*m**2"\nx = "-2 m"\ny = 0\nheading = 0\n'
    '[b]\nmass = "1300 kg"\nyaw_inertia = "2200 kg*m**2"\nx = "2 m"\ny = "0.2 m"\n'
    'heading = "90 deg"\n[reconstruct.speeds]\ncourse_a = 0\ncourse_b = "90 deg"\n'
    'delta_v_forward_a = "-6 m/s +/- 0.3 m/s"\ndelta_v_left_a = "1.9 m/s"\nslid = "bound"\n'
    'friction = "0.28 .. 0.34"\nrestitution = 0.1\nnormal = 0\npoint = [0, 0]\n'
)


@pytest.mark.slow
def test_what_is_known_from_one_side_has_a_range_with_one_end():
    """As `propagate` gives the same model with `OneSided`; what more slip leaves as it is has two
    ends, and what it changes by nobody knows how much is refused.
    """
    more = '[propagate]\nsamples = 512\noutputs = ["b.before.speed", "a.delta_v", "energy_loss"]\n'
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = answers(read_text((SLID + more).encode()))
    assert found.propagation["b.before.speed"].interval()[1] == math.inf
    assert found.propagation["energy_loss"].interval()[1] == math.inf
    low, high = found.propagation["a.delta_v"].interval()
    assert low < found.results[0].a.delta_v < high < math.inf
    assert "at least" in found.text("us").partition("Given the stated inputs")[2]
    for name in ("b.after.speed", "slip_before", "b.kinetic_energy_change"):
        (line,) = problems(SLID + f'[propagate]\noutputs = ["{name}"]\n')
        assert line.startswith(f"propagate.outputs: '{name}' is open, as the contact slid")
    (line,) = problems(SLID + '[posterior.observed]\n"b.before.speed" = "8 m/s +/- 1 m/s"\n')
    assert "known from one side only" in line


@pytest.mark.slow
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no disk that is always full")
@pytest.mark.parametrize("arguments", [["new"], [str(CASES / "us_units.toml")]])
def test_a_disk_that_is_full_is_named(arguments):
    with open("/dev/full", "w") as full:
        found = subprocess.run(
            [sys.executable, "-m", "collisions", *arguments],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
        )
    assert found.returncode == 2
    assert found.stderr == "cannot write the output (No space left on device)\n"
