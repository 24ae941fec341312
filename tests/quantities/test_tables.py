"""Summaries: what people see of a result, in their units, against numbers converted here by pint or
by hand.
"""

from __future__ import annotations

import math
import pickle
import re
from html import unescape

import numpy as np
import pint
import pytest

import collisions as col
from collisions import plot, reconstruct, travel
from collisions.diagnostics import diagnose
from collisions.quantities import attribute_stubs
from collisions.quantities.tables import Cells
from collisions.reporting import options, replay, report
from collisions.uncertainty import Interval, Normal, Uniform, propagate

MPH, FT, LB = 0.44704, 0.3048, 0.45359237  # exact by definition


def camry(**changes):
    given = {
        "mass": "3400 lb",
        "vx": "45 mph",
        "yaw_inertia": "2100 lbf*ft*s**2",
        "x": "-7 ft",
        "y": "0.5 ft",
        "heading": 0.0,
    }
    return col.Vehicle(**{**given, "name": "Camry", **changes})


def civic(**changes):
    given = {
        "mass": "2900 lb",
        "vy": "30 mph",
        "yaw_inertia": "1700 lbf*ft*s**2",
        "x": "2.5 ft",
        "y": "-3 ft",
    }
    return col.Vehicle(**{**given, "heading": "90 deg", "name": "Civic", **changes})


def crash(a=None, b=None, **options):
    return col.eccentric(
        a or camry(),
        b or civic(),
        0.1,
        **{"normal": 0.0, "point": ("0 ft", 0.0), "friction": 0.5, **options},
    )


def lines(summary):
    """The cells of the plain table by their part and label."""
    found, part = {}, ""
    for line in str(summary).splitlines():
        label, *cells = re.split(r" {2,}", line.strip())
        if line.startswith(" "):
            found[part, label] = cells
        elif cells or len(label.split()) == 1:
            part = label
            found["", label] = cells
    return found


def test_an_impact_is_two_columns_in_the_units_of_its_inputs():
    """Speeds to 0.1 mph, angles to 1 degree, the clock hour beside the PDOF."""
    impact = crash()
    found = lines(impact.summary())
    assert found["", "Before"] == ["A (Camry)", "B (Civic)"]
    assert found["Before", "speed"] == ["45.0 mph", "30.0 mph"]
    assert found["Before", "course"] == ["0°", "90°"]
    for part, name in (
        ("total", "delta_v"),
        ("forward", "delta_v_forward"),
        ("left", "delta_v_left"),
    ):
        wanted = [f"{getattr(side, name) / MPH:.1f} mph" for side in (impact.a, impact.b)]
        assert found["Delta-V", part] == wanted
    for side, cell in zip((impact.a, impact.b), found["Delta-V", "PDOF"], strict=True):
        angle = np.degrees(side.pdof)
        assert cell == f"{angle:.0f}° ({(round(angle / 30) - 1) % 12 + 1} o'clock)"
    assert found["Contact", "closing speed"] == ["45.0 mph"]
    assert found["Contact", "regime"] == ["sticking"]
    loss = pint.Quantity(impact.energy_loss, "J").m_as("ft*lbf")
    assert found["Contact", "energy lost"] == [f"{round(loss, -3):.0f} ft·lbf"]


@pytest.mark.parametrize(
    ("given", "unit"),
    [
        ({"mass": "3400 lb", "vx": "40 mph"}, "mph"),
        ({"mass": "1500 kg", "vx": "60 km/h"}, "km/h"),
        ({"mass": "1500 kg", "vx": 20.0}, "m/s"),
        ({"mass": 1500.0, "vx": 20.0}, "m/s"),
        ({"mass": "1500 kg", "vx": "40 mph"}, "mph"),  # by the speeds, where they differ
        ({"mass": pint.Quantity(3400.0, "pound"), "vx": pint.Quantity(40.0, "mile/hour")}, "mph"),
    ],
)
def test_units_are_those_of_the_inputs(given, unit):
    impact = col.linear_central(col.Vehicle(**given), col.Vehicle(mass=1000.0), 0.2)
    assert lines(impact.summary())["Contact", "closing speed"][0].endswith(f" {unit}")
    assert lines(impact.summary("metric"))["Contact", "closing speed"][0].endswith(" km/h")


@pytest.mark.parametrize("units", ["imperial", "US", 1, True, ["us"]])
def test_units_that_are_none_are_refused(units):
    with pytest.raises(col.InputError, match=r"units must be 'si', 'metric' or 'us'"):
        crash().summary(units)


def test_what_has_no_number_says_why():
    """No heading, a vehicle at rest, a refused case, a batch."""
    still = col.linear_central(col.Vehicle(mass=1500.0, vx=20.0), col.Vehicle(mass=1000.0), 0.2)
    found = lines(still.summary())
    assert [row for part, row in found if part == "Delta-V"] == ["total"]
    assert "no heading" not in str(still.summary())
    one = col.linear_central(
        col.Vehicle(mass=1500.0, vx=20.0, heading=0.0), col.Vehicle(mass=1000.0), 0.2
    )
    assert lines(one.summary())["Delta-V", "PDOF"] == ["0° (12 o'clock)", "no heading"]
    assert found["Before", "course"] == ["0°", "at rest"]
    assert ("Contact", "regime") not in found  # a linear impact has no tangent
    apart = col.linear_central(
        col.Vehicle(mass=1500.0, vx=-1.0), col.Vehicle(mass=1000.0), 0.2, on_failure="nan"
    )
    assert "Refused: " in str(apart.summary())
    assert lines(apart.summary())["Contact", "energy lost"] == ["not defined"]
    speeds = np.array([10.0, 20.0, -1.0])
    many = col.linear_central(
        col.Vehicle(mass=1500.0, vx=speeds), col.Vehicle(mass=1000.0), 0.2, on_failure="nan"
    )
    assert lines(many.summary())["Contact", "closing speed"] == ["10.00 to 20.00 m/s"]
    assert "1 of 3 cases were refused" in str(many.summary())
    assert (
        lines(many.summary())["Before", "speed"][0]
        == lines(many.a.summary())["Before", "speed"][0]
        == "10.00 to 20.00 m/s"
    )
    none = col.linear_central(
        col.Vehicle(mass=1500.0, vx=-speeds[:2]), col.Vehicle(mass=1000.0), 0.2, on_failure="nan"
    )
    assert lines(none.summary())["Before", "speed"][0] == "not defined"


def test_the_regimes_of_a_batch_are_those_of_the_cases_with_an_answer():
    a = camry(vx=np.array([15.0, -15.0]), name="")
    many = crash(a=a, on_failure="nan")
    assert list(many.refused) == [False, True]
    assert lines(many.summary())["Contact", "regime"] == [many.case(0).regime]


def test_huge_numbers_stay_in_the_units_of_the_inputs():
    heavy = col.linear_central(
        col.Vehicle(mass="1e10 lb", vx="30 mph"), col.Vehicle(mass="1e10 lb"), 0.0
    )
    found = lines(heavy.summary())["Contact", "energy lost"]
    # m v^2 / 4 with 1 lbf = 32.17405 lb ft/s^2
    assert found == [f"{1e10 * 44.0**2 / 4.0 / 32.17405:.4g} ft·lbf"]


def test_a_notebook_shows_the_same_cells_and_folds_the_rest():
    impact = crash(a=camry(name="<b>&"))
    html = impact._repr_html_()
    assert "<b>" not in html
    assert "&lt;b&gt;&amp;" in html
    shown, _, folded = html.partition("<details>")
    plain = unescape(re.sub(r"<[^>]+>", " ", shown))
    for cells in lines(impact.summary()).values():
        assert all(cell in plain for cell in cells)
    assert "momentum_residual" in folded
    assert "momentum_residual" not in shown


def test_every_result_has_a_summary_in_its_units():
    """One mechanism: whatever has names of A and B is put side by side."""
    solution = reconstruct.momentum(
        "3400 lb", "2900 lb", course_a=0.0, course_b="90 deg", course_a_after="30 deg",
        course_b_after="40 deg",
        speed_a_after="20 mph", speed_b_after="25 mph",
    )  # fmt: skip
    text = str(solution.summary())
    assert re.search(r"speed +33\.7 mph +27\.8 mph", text)
    assert re.search(r"speed after +20\.0 mph +25\.0 mph", text)
    assert re.search(r"mass +3400 lb\n", str(camry().summary()))
    assert re.search(
        r"yaw inertia +67600 lb·ft²\n", str(camry().summary())
    )  # 2100 lbf ft s2 times 32.174 lb ft/(lbf s2)
    assert re.search(r"Delta-V", str(crash().a.summary("us")))
    assert re.search(
        r"tyre delta-V bound +1\.5 mph +1\.5 mph", str(col.left_out(crash()).summary("us"))
    )  # 0.7 g for 0.1 s
    run = travel.path([(0.0, 0.0), (10.0, 0.0)], [0.0, 0.0], friction=0.7, lock=1.0)
    assert re.search(
        r"speed +42\.2 km/h", str(run.summary("metric"))
    )  # sqrt(2 * 0.7 * 9.80665 * 10) = 11.72 m/s
    choice = col.required_model(camry(), civic(), 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5)
    assert "eccentric" in str(choice.summary())


@pytest.mark.slow
def test_a_fit_and_findings_are_tables():
    fit = reconstruct.fit(
        lambda speed: {
            "delta_v": col.linear_central(
                col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1500.0), 0.0
            ).b.delta_v
        },
        {"speed": Interval("1 m/s", "40 m/s")},
        {"delta_v": ("20 mph", "1 mph")},
    )
    assert re.search(
        r"speed +40\.0 mph +2\.0 mph +36\.1 to 43\.9 mph", str(fit.summary("us"))
    )  # twice 20 +- 1, 1.96 sigma
    assert fit._repr_html_().count("<table>") == 1
    assert repr(fit) == str(fit.summary())
    found = diagnose(
        col.linear_central(col.Vehicle(mass=1500.0, vx=20.0), col.Vehicle(mass=1000.0), 0.8),
        units="us",
    )
    assert found[0].code == "restitution"
    assert re.search(
        r"restitution +restitution 0\.8 at a closing speed of 44\.7 mph.* 0\.80 +0\.30\n",
        repr(found),
    )
    assert "<table>" in found._repr_html_()
    assert isinstance(found, tuple)
    assert repr(diagnose(crash())).startswith("No findings")
    assert "<caption>No findings</caption>" in diagnose(crash())._repr_html_()


def struck(speed, restitution=0.1):
    impact = col.linear_central(
        col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1500.0), restitution, on_failure="nan"
    )
    return {"delta_v": impact.b.q.delta_v}


@pytest.mark.slow
def test_a_propagation_needs_no_method_and_speaks_the_units_of_its_inputs():
    """Linear in the speed: 0.55 times 40 and 2 mph, and 1.96 standard deviations to each side."""
    found = propagate(struck, {"speed": Normal("40 mph", "2 mph")}, seed=1)
    assert found.method == "quasi_random"
    text = str(found.summary())
    assert re.search(r"delta_v +22\.0 ± 1\.1 mph +19\.8 to 24\.2 mph", text)
    assert re.search(r"speed +40 ± 2 mph", text)
    low, high = found["delta_v"].to("mph").interval(0.95)
    assert (low, high) == pytest.approx(
        (22.0 - 1.96 * 1.1, 22.0 + 1.96 * 1.1), abs=0.02
    )  # of 8192 points
    assert found["delta_v"].to("mph").mean == pytest.approx(22.0, abs=1e-3)
    assert found["delta_v"].to("km/h").quantile(np.array([0.5]))[0] == pytest.approx(
        22.0 * 1.609344, abs=0.01
    )
    with pytest.raises(col.UnitsError, match="cannot be taken as m/s"):
        found["delta_v"].to("lb")
    between = propagate(struck, {"speed": Interval("40 mph", "42 mph")})
    assert between.method == "interval"
    assert re.search(r"delta_v +22\.0 to 23\.1 mph", str(between.summary()))
    plain = propagate(
        lambda speed: {"v": 2.0 * speed}, {"speed": Uniform("1 m/s", "2 m/s")}, seed=1
    )["v"]
    with pytest.raises(col.InputError, match="return a Quantity"):
        plain.to("mph")


@pytest.mark.parametrize("form", ["html", "markdown", "text"])
def test_a_page_is_a_text_that_shows_and_saves_itself(form, tmp_path):
    impact = crash()
    page = (
        col.explain(impact, form=form)
        if form == "text"
        else col.report(impact, form=form, figures=False)
    )
    assert isinstance(page, str)
    path = page.save(tmp_path / "page")
    assert path.read_text(encoding="utf-8") == page
    assert b"\r" not in path.read_bytes()
    if form != "text":
        assert replay(path.read_text(encoding="utf-8")) == impact
    html = page._repr_html_()
    if form == "html":
        frame = re.fullmatch(r'<iframe srcdoc="([^"]*)"[^>]*></iframe>', html)
        assert unescape(frame[1]) == page
    else:
        assert html is None
    assert page._repr_markdown_() == (page if form == "markdown" else None)


@pytest.mark.slow
def test_a_note_stands_beside_its_input_and_comes_back_with_the_record():
    impact = crash()
    notes = {
        "restitution": "Tests of the same model, <1998>.",
        "a.mass": "Weighed.",
        "point": "From the photographs.",
    }
    page = col.report(impact, form="markdown", units="us", notes=notes)
    assert "| A (Camry) | mass | 3400 lb. Weighed. |" in page
    assert "| contact | restitution e | 0.1. Tests of the same model, \\<1998\\>. |" in page
    assert "contact point (x, y) | x: 0 ft; y: 0 ft. From the photographs. |" in page
    assert col.report(replay(page), **options(page)) == page
    html = col.report(impact, notes=notes, figures=False)
    assert "<1998>" not in html
    with pytest.raises(
        col.InputError, match=r"'mass', which is no input of this page; they are a\.mass, a\.vx"
    ):
        col.report(impact, notes={"mass": "Weighed."})
    with pytest.raises(col.InputError, match="notes must be a text that says something"):
        col.report(impact, notes={"a.mass": ""})


def test_published_values_stand_beside_restitution_and_friction():
    """Above 15 mph no published restitution is higher than 0.3; friction by McHenry, 0.3 to 1; each
    with its source.
    """
    page = col.report(crash(), form="markdown", units="us")
    assert (
        "| contact | restitution published for such a closing speed | 0 to 0.3 (EDCRASH manual, "
        "to 0.25; tests, to 0.253; rounded up) |" in page
    )
    friction = "0.3 to 1, typically 0.55 (McHenry and McHenry, SAE 970947)"
    assert f"| contact | friction published between vehicle bodies | {friction} |" in page
    assert "For comparison with the friction: inter-vehicle friction; McHenry" in page
    assert "friction published" not in col.report(crash(friction=0.0), form="markdown")
    assert "| A (Camry) | delta-V forward | -20.0 mph |" in page
    assert "| A (Camry) | delta-V to the left (recorders count to the right) | 8.5 mph |" in page


def test_columns_in_units_have_them_in_their_names():
    speeds = np.array([10.0, 20.0])
    many = crash(a=camry(vx=speeds), point=(0.0, 0.0))
    plain, us = many.to_columns(), many.to_columns(units="us")
    assert len(us) == len(plain)
    assert us["a.delta_v [mph]"] == pytest.approx(np.array(plain["a.delta_v"]) / MPH, rel=1e-15)
    assert us["a.before.mass [lb]"] == pytest.approx([3400.0, 3400.0], rel=1e-14)
    assert us["point.x [ft]"] == [0.0, 0.0]
    assert us["a.before.x [ft]"] == pytest.approx([-7.0, -7.0], rel=1e-14)
    assert us["a.pdof [deg]"] == pytest.approx(np.degrees(plain["a.pdof"]), rel=1e-14)
    assert us["a.before.yaw_inertia [lb*ft**2]"][0] == pytest.approx(
        plain["a.before.yaw_inertia"][0] / (LB * FT**2), rel=1e-14
    )
    assert us["restitution"] == plain["restitution"]
    assert us["status"] == plain["status"]
    assert many.to_columns(columns=["b.delta_v", "status"]) == {
        name: plain[name] for name in ("b.delta_v", "status")
    }
    assert list(many.to_columns(units="metric", columns="b.delta_v")) == ["b.delta_v [km/h]"]
    with pytest.raises(
        col.InputError, match=r"no column 'b\.deltav'; write for example b\.delta_v"
    ):
        many.to_columns(columns=["b.deltav"])
    with pytest.raises(col.InputError, match="units must be"):
        many.to_columns(units="imperial")


def test_the_names_of_q_for_editors_are_those_it_has():
    """Completion at run time, and the lists that editors and type checkers read."""
    impact = crash()
    solution = reconstruct.momentum(
        1500.0,
        1200.0,
        course_a=0.0,
        course_b=1.5,
        course_a_after=0.4,
        course_b_after=0.7,
        speed_a_after=9.0,
        speed_b_after=9.0,
    )
    run = travel.path([(0.0, 0.0), (10.0, 0.0)], [0.0, 0.0], friction=0.7, lock=1.0)
    for result in (impact.a.before, impact.a, impact, solution, run):
        listed = getattr(attribute_stubs, f"{type(result).__name__}Quantities")
        names = {
            name
            for name in (*vars(listed), *getattr(listed, "__annotations__", ()))
            if not name.startswith("_")
        }
        assert names == set(dir(result.q))
        assert "summary" not in names


def test_bare_functions_have_a_way_to_quantities():
    """sqrt(2 * 0.7 * 9.80665 * 18.288) = 15.8456 m/s, 35.446 mph."""
    assert travel.q.speed("60 ft", drag=0.7).m_as("mph") == pytest.approx(35.4455, abs=1e-3)
    assert travel.q.distance("35.4455 mph", drag=0.7).m_as("ft") == pytest.approx(60.0, abs=1e-3)
    assert travel.q.time("60 ft", drag=0.7).m_as("s") == pytest.approx(
        15.8456 / (0.7 * 9.80665), rel=1e-5
    )
    # In line: B gains (1 + e) * g * m_a / (m_a + m_b).
    closing = reconstruct.q.inline_closing_speed(1500.0, 1500.0, 0.0, delta_v_b="10 mph")
    assert closing.m_as("mph") == pytest.approx(20.0, rel=1e-12)


def test_a_pair_of_texts_is_asked_whether_it_is_a_range():
    with pytest.raises(
        col.InputError,
        match=r"write Uniform\('40 mph', '50 mph'\) or Interval\('40 mph', '50 mph'\)",
    ):
        propagate(struck, {"speed": ("40 mph", "50 mph")})


def test_a_printed_propagation_is_its_table():
    found = propagate(struck, {"speed": Normal("40 mph", "2 mph")}, samples=64, seed=1)
    assert str(found) == str(found.summary())
    assert "22.0 ± 1.1 mph" in str(found)


@pytest.mark.slow
def test_results_keep_the_units_of_their_inputs():
    """Also where a result holds numbers alone: a vehicle after, a batch, what is left out, and all
    of them unpickled.
    """
    a = col.Vehicle(
        mass="3400 lb",
        yaw_inertia="1800 slug*ft**2",
        vx="30 mph",
        x="-7 ft",
        y="0 ft",
        heading="0 deg",
    )
    b = col.Vehicle(mass=1300.0, yaw_inertia=2000.0, vy=10.0, x=0.9, y=-0.9, heading=1.5)
    contact = {"normal": "0 deg", "point": (0.0, 0.0), "friction": 0.5}
    impact = col.eccentric(a, b, 0.1, **contact)
    many = col.eccentric(a.replace(vx=np.array([12.0, 14.0])), b, 0.1, **contact)
    again = col.linear_central(
        impact.a.after.replace(vy=0.0, yaw_rate=0.0), col.Vehicle(mass=1500.0), 0.1
    )
    of_vehicles = [
        impact.a.after,
        impact.b.at_compression,
        many.b.after,
        many.case(1).a.after,
        again.b.after,
    ]
    for result in (
        *of_vehicles,
        *map(pickle.loads, map(pickle.dumps, of_vehicles)),
        impact.a.after.replace(vx=1.0),
    ):
        assert "mph" in str(result.summary())
        assert "m/s" not in str(result.summary())
    left = col.left_out(impact)
    for result in (left, left.a, pickle.loads(pickle.dumps(left)), col.left_out(many)):
        assert "lbf·s" in str(result.summary())
        assert "N·s" not in str(result.summary())
    assert "mph" in str(col.diagnose(impact, limits={"tyre_impulse": 0.01}))
    assert plot.energy(impact).get_xlabel() == "energy [ft·lbf]"
    assert report(impact, form="markdown", figures=False) == report(
        impact, form="markdown", figures=False, units="us"
    )


def test_an_array_with_a_unit_speaks_it():
    quantity = pint.get_application_registry().Quantity
    cars = col.Vehicle(mass=quantity([3000.0, 3450.0], "lb"), vx=quantity([30.0, 35.0], "mph"))
    assert str(cars.summary()).splitlines()[2] == "speed   30.0 to 35.0 mph"
    assert cars.given == {}
    # What the library itself returns in m/s does not outvote the pounds that were typed.
    mixed = col.Vehicle(mass="3400 lb", vx=travel.q.speed("60 ft", drag=0.7))
    assert "mph" in str(mixed.summary())


def test_a_run_out_speaks_the_units_of_its_survey():
    places = [("0 ft", "0 ft"), ("16 ft", "4 ft"), ("30 ft", "12 ft")]
    run = travel.path(places, ["0 deg", "40 deg", "80 deg"], friction=0.7, lock=0.3)
    assert "mph" in str(run.summary())
    vehicle = col.Vehicle(
        mass="3400 lb", yaw_inertia=2500.0, x="0 ft", y=0.0, heading=0.0, vx=10.0, vy=1.0
    )
    rolled = travel.simulate(vehicle, travel.Tyres(0.7, 0.5, 2.7, 1.5), moments=2)
    assert "3400 lb" in str(rolled.rest.summary())


def test_one_output_alone_is_shown_in_the_units_of_the_inputs():
    found = propagate(
        lambda speed: {"twice": 2.0 * travel.q.speed("60 ft", drag=0.7) + 0.0 * speed},
        {"speed": Normal(1.0, 0.1)},
    )
    assert "m/s" in str(found["twice"])
    found = propagate(
        lambda speed: {"a": col.Vehicle(mass=1.0, vx=speed).q.speed},
        {"speed": Normal("30 mph", "2 mph")},
        seed=1,
    )
    assert re.search(r"a +30\.0 ± 2\.0 mph +26\.1 to 33\.9 mph", str(found["a"]))
    assert "30.0 ± 2.0 mph" in found["a"]._repr_html_()
    assert plot.distribution(found["a"]).get_xlabel() == "a [mph]"
    assert repr(found["a"].to("km/h")) == (
        "<a, given the stated inputs; mean ± standard deviation: 48.3 ± 3.2 km/h; 95 percent "
        "interval: 42.0 to 54.6 km/h>"
    )
    assert "48.3 ± 3.2 km/h" in found["a"].to("km/h")._repr_html_()
    with pytest.raises(
        col.InputError, match=r"in other units plot.distribution\(result\['delta_v'\], units='us'\)"
    ):
        plot.distribution(found["a"].to("km/h"))
    assert str(Uniform("10 deg", "20 deg")) == "10 to 20°, all values equally likely"


def test_figures_in_a_unit_asked_for_are_in_that_unit_whatever_their_kind():
    def model(jerk):
        return {
            "jerk": jerk * col.quantities.units.to_quantity(1.0, "m/s**3"),
            "course": jerk * col.quantities.units.to_quantity(1.0, "rad"),
        }

    found = propagate(model, {"jerk": Uniform(0.25, 0.75)}, seed=1)
    assert "mean ± standard deviation: 1.64 ± 0.47 ft/s³; 95 percent" in repr(
        found["jerk"].to("ft/s**3")
    )
    assert "mean ± standard deviation: 28.6 ± 8.3°; 95 percent" in repr(found["course"].to("deg"))


def test_figures_of_plain_numbers_say_why_they_have_no_unit():
    def model(speed):
        return {"delta_v": struck(speed)["delta_v"], "bare": 0.5 * speed}

    note = "Without a unit, as the model returned plain numbers: bare."
    found = propagate(model, {"speed": Normal("40 mph", "2 mph")}, seed=1)
    assert found.summary().notes == found["bare"].summary().notes == (note,)
    assert note in str(found)
    assert found["delta_v"].summary().notes == ()


def test_a_plain_table_is_at_most_88_wide():
    found = col.diagnose(
        crash(), limits=dict.fromkeys(("normal", "tyre_impulse", "normal_yaw"), 1e-3)
    )
    assert len(found) > 2
    assert max(map(len, str(found).splitlines())) <= 88


def test_planar_momentum_says_what_a_degree_of_each_course_does():
    known = {
        "course_a_after": "30 deg",
        "course_b_after": "40 deg",
        "speed_a_after": "20 mph",
        "speed_b_after": "25 mph",
    }
    solution = reconstruct.momentum("3400 lb", "2900 lb", course_a=0.0, course_b="90 deg", **known)
    off = reconstruct.momentum(
        "3400 lb",
        "2900 lb",
        course_a=0.0,
        course_b="90 deg",
        **known | {"course_b_after": "41 deg"},
    )
    shown = lines(solution.summary())["Change per degree of", "course of B after"]
    changes = [
        (getattr(off, name) - getattr(solution, name)) / MPH for name in ("speed_a", "speed_b")
    ]
    assert [float(cell.removesuffix(" mph")) for cell in shown] == pytest.approx(
        changes, abs=0.05 + 0.01
    )  # rounded, and a slope


def test_a_batch_of_planar_momentum_is_shown_in_the_units_of_its_inputs():
    """Without the case whose courses are parallel."""
    courses = {"course_a": "0 deg", "course_b": pint.Quantity(np.array([90.0, 80.0, 0.0]), "deg")}
    courses |= {
        "course_a_after": "20 deg",
        "course_b_after": "40 deg",
        "speed_a_after": "17 mph",
        "speed_b_after": "20 mph",
    }
    many = reconstruct.momentum("3400 lb", "3000 lb", **courses, on_failure="nan")
    # Momentum along both axes by hand: 17 sin 20 + (30/34) 20 sin 40 = (30/34) v_b
    by_hand = 34 / 30 * 17 * np.sin(np.radians(20)) + 20 * np.sin(np.radians(40))
    assert "80 to 90°" in str(many.summary())
    assert f"{by_hand:.1f} to {by_hand / np.sin(np.radians(80)):.1f} mph" in str(many.summary())


def test_the_reason_for_a_model_is_in_the_units_of_the_inputs():
    a, b = camry(name=""), civic(name="")
    choice = col.required_model(
        a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5, tolerance="2 mph"
    )
    error = choice.errors["oblique_central"] / MPH
    table = " ".join(str(choice.summary()).split())
    assert f"would err by {error:.3g} mph, and 2 mph is accepted" in table
    assert " m/s" not in table
    assert " m/s" in choice.reason  # as data it stays in SI
    taken = col.solve(
        a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5, tolerance="2 mph"
    ).choice
    assert str(taken.summary()) == str(choice.summary())


@pytest.mark.parametrize(
    ("degrees", "cell"),
    [
        ([-174.0, 174.0], "174 to 186°"),
        ([170.0, -100.0, 175.0, math.nan], "170 to 260°"),
        ([-90.0, 90.0], "-90 to 90°"),
        ([-20.0, 100.0], "-20 to 100°"),
        ([-120.0, 0.0, 120.0], "-120 to 120°"),
        ([10.0, 350.0], "-10 to 10°"),
        ([200.0, 300.0], "200 to 300°"),
        ([0.0, 720.0], "0 to 720°"),
        ([-180.0, 180.0], "180°"),
        ([-174.0], "-174°"),
    ],
)
@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_directions_of_a_batch_are_shown_by_the_shortest_arc(degrees, cell, kind):
    """A rotation over time goes from its least to its greatest value."""
    numbers, values = Cells("metric"), np.radians(np.array(degrees)).astype(kind)
    for name in (
        "course",
        "heading",
        "pdof",
        "course_b_after",
        "heading_a",
        "normal_angle",
        "straight_course",
    ):
        assert numbers.text(values, "rad", name) == cell
    assert numbers.text((values, values), "rad", "crab_angles") == f"{cell}, {cell}"
    known = [one for one in degrees if not math.isnan(one)]
    plain = f"{min(known):.0f} to {max(known):.0f}°" if len(known) > 1 else cell
    for name in ("a.rotation", "rotation", "course_error", ""):
        assert numbers.text(values, "rad", name) == plain
    numbers.over_time = True
    assert numbers.text(values, "rad", "heading") == plain


def test_tables_show_courses_and_pdof_across_180_degrees():
    """atan(1/10) is 5.7 degrees; struck from behind, B's PDOF is to both sides of 180 degrees."""
    v = np.array([-1.0, 1.0])
    assert "course  174 to 186°" in str(col.Vehicle(mass=1000.0, vx=-10.0, vy=v).summary())
    a, b = (
        col.Vehicle(mass=1000.0, vx=10.0, heading=0.0),
        col.Vehicle(mass=1000.0, vx=1.0, vy=v, heading=0.0),
    )
    many = col.oblique_central(a, b, 0.1, normal=0.0, friction=0.1)
    assert np.ptp(np.degrees(many.b.pdof)) > 340.0
    assert re.search(r"PDOF +-6 to 6° +174 to 186°", str(many.summary()))
    courses = {"course_a": pint.Quantity(np.array([178.0, -178.0]), "deg"), "course_b": "90 deg"}
    courses |= {
        "course_a_after": "150 deg",
        "course_b_after": "120 deg",
        "speed_a_after": 9.0,
        "speed_b_after": 9.0,
    }
    assert re.search(
        r"course +178 to 182° +90°", str(reconstruct.momentum(1500.0, 1200.0, **courses).summary())
    )


def test_a_path_over_time_shows_how_far_it_turned():
    vehicle = col.Vehicle(
        mass=1500.0,
        yaw_inertia=2500.0,
        x=0.0,
        y=0.0,
        heading="-170 deg",
        vx=15.0,
        vy=0.0,
        yaw_rate=4.0,
    )
    path = travel.simulate(vehicle, travel.Tyres(0.7, 1.0, 2.7, 1.5), moments=4)
    low, high = np.degrees([path.heading.min(), path.heading.max()])
    assert f"{low:.0f} to {high:.0f}°" in str(path.summary())


def test_a_table_of_planar_momentum_says_in_words_what_became_of_it():
    """Parallel courses are refused; two vehicles thrown apart at 180 degrees to each other gain
    energy.
    """
    known = {"course_a": 0.0, "course_b": "90 deg", "speed_a_after": 20.0, "speed_b_after": 20.0}
    solved = known | {"course_a_after": "30 deg", "course_b_after": "40 deg"}
    gain = known | {"course_a_after": "-60 deg", "course_b_after": "120 deg"}
    whole = reconstruct.momentum(1500.0, 1200.0, **solved).summary()
    assert not re.search(r"^ok\b", str(whole), re.MULTILINE)
    assert all(note.startswith("Found as an instant") for note in whole.notes)
    assert ("ok", "True") in whole.parts[-1].rows
    with pytest.warns(col.CollisionsWarning):
        gained = reconstruct.momentum(1500.0, 1200.0, **gain).summary()
    assert gained.notes[0] == "Solved, but the model ends with more energy than it began with."
    refused = reconstruct.momentum(1500.0, 1200.0, **solved | {"course_b": 0.0}, on_failure="nan")
    assert refused.summary().notes == (f"Refused: {refused.status.sentence}.",)
    both = {"course_a_after": pint.Quantity(np.array([30.0, -60.0, 30.0]), "deg")}
    both |= {"course_b_after": pint.Quantity(np.array([40.0, 120.0, 40.0]), "deg")}
    both |= {"course_b": pint.Quantity(np.array([90.0, 90.0, 0.0]), "deg")}
    with pytest.warns(col.CollisionsWarning):
        many = reconstruct.momentum(1500.0, 1200.0, **solved | both, on_failure="nan").summary()
    assert [note[:28] for note in many.notes][:2] == [
        "1 of 3 cases were refused, f",
        "1 of 3 cases end with more e",
    ]


def test_a_refused_impact_has_no_blank_cell():
    apart = {"a": col.Vehicle(mass=1500.0, vx=-5.0), "b": col.Vehicle(mass=1500.0, vx=1.0)}
    impact = col.oblique_central(
        **apart, restitution=0.1, normal=0.0, friction=0.5, on_failure="nan"
    )
    assert lines(impact.summary())["Contact", "regime"] == ["not known"]


def test_a_fit_without_degrees_of_freedom_shows_no_chi_squared():
    def fitted(**evidence):
        return reconstruct.fit(
            lambda speed: dict.fromkeys(evidence, speed),
            {"speed": Interval(1.0, 40.0)},
            dict.fromkeys(evidence, (20.0, 1.0)),
        )

    assert "chi-squared" not in str(fitted(one=0).summary())
    assert "with 1 degree of freedom" in str(fitted(one=0, two=0).summary())


def test_a_name_that_would_change_how_a_line_reads_is_shown_as_such() -> None:
    """A mark that turns the reading direction, a code of a terminal, a new line."""
    a, b = col.Vehicle(mass=1500.0, vx=10.0, name="\u202eGolf"), col.Vehicle(mass=1200.0)
    summary = col.linear_central(a, b.replace(name="P\x1b[31m\nx"), 0.1).summary()
    for text in (str(summary), summary._repr_html_()):
        assert "\ufffdGolf" in text
        assert "P\ufffd[31m x" in text
        assert "\u202e" not in text


def test_what_is_said_beside_the_numbers_of_an_impact_found_backwards_stands_in_its_summary() -> (
    None
):
    """That it is one of three, and what an instant leaves out."""
    found = reconstruct.speeds(
        col.Vehicle(mass=1500.0, yaw_inertia=2600.0, heading=0.0, x=-2.2, y=0.2),
        col.Vehicle(mass=1200.0, yaw_inertia=2100.0, heading="90 deg", x=0.9, y=-0.5),
        course_a=0.0,
        course_b="66.728 deg",
        energy_loss=53580.0,
        speed_b=22.257,
        restitution=0.27867,
        normal="-40.982 deg",
        point=(0.0, 0.0),
        friction=0.97226,
    )
    text = " ".join(str(found[1].summary()).split())
    assert "Not the only answer: 3 impacts fit what was known." in text
    assert len(found[1].statements) == 1
    assert "Found as an instant: of delta-V that leaves out about" in text


@pytest.mark.slow
def test_the_help_of_summary_says_which_summaries_have_radians_in_si():
    """A course of a study, a posterior, a fit and an impact, in every system of units."""

    def model(course):
        moved = col.Vehicle.from_speed(mass=1000.0, speed=10.0, course=course)
        return {"course": moved.q.course}

    stated = {"course": Normal("30 deg", "2 deg")}
    spread = propagate(model, stated, samples=64, seed=1)
    found = reconstruct.posterior(model, stated, {"course": ("30 deg", "2 deg")}, seed=1)
    fitted = reconstruct.fit(model, stated, {"course": ("30 deg", "2 deg")})
    told = re.sub(r"\s+", " ", type(spread).summary.__doc__)
    assert (
        "but for SI in the summary of a ``Propagation``, a ``Posterior`` or an ``Output``" in told
    )
    for one, radians in (
        (spread, True),
        (spread["course"], True),
        (found, True),
        (found["course"], True),
        (fitted, False),
        (fitted["course"], False),
        (col.Vehicle(mass=1000.0, vx=1.0, heading=0.5), False),
    ):
        # What was stated stays as it was given, in degrees.
        assert bool(re.search(r"\brad\b", str(one.summary("si")))) is radians
        for units in ("metric", "us"):
            assert "°" in str(one.summary(units))
            assert not re.search(r"\brad\b", str(one.summary(units)))
