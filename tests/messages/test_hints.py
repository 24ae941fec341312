"""What a first-time user writes wrong, and that the message says what to write."""

import inspect
import re

import numpy as np
import pint
import pytest

import collisions as col
from collisions import plot, reconstruct, reference, travel, uncertainty
from collisions.cases.read import suggestion
from collisions.messages.hints import hinted, nearest
from collisions.quantities.attributes import Frozen, derived

A, B = col.Vehicle(mass="3400 lb", vx="30 mph"), col.Vehicle(mass="3000 lb")
CONTACT = {"normal": 0.0, "point": (0.0, 0.0)}


@pytest.mark.parametrize(
    ("given", "cure"),
    [
        (
            {"mass": 1500.0, "speed": "45 mph"},
            "Vehicle.from_speed(speed='45 mph', course='0 deg', ...)",
        ),
        ({"weight": "3400 lb"}, "write mass=, such as mass='3400 lb'"),
        ({"mass": 1500.0, "izz": 2000.0}, "write yaw_inertia="),
        ({"mass": 1500.0, "headin": 0.0}, "write heading="),
        ({"mass": 1500.0, "colour": "red"}, "it has mass, vx, vy"),
    ],
)
def test_an_argument_that_a_vehicle_does_not_have_names_the_one_it_has(given, cure):
    with pytest.raises(TypeError, match=re.escape(cure)):
        col.Vehicle(**given)


def test_a_vehicle_without_a_mass_says_what_a_mass_may_be():
    with pytest.raises(col.MissingInputError, match="give it in kg, or inf for a barrier"):
        col.Vehicle(vx=1.0)


def test_an_attribute_is_looked_up_where_it_is():
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=20.0), col.Vehicle(mass=1000.0), 0.1)
    courses = {"course_a": 0.0, "course_b": 1.5, "course_a_after": 0.5, "course_b_after": 0.6}
    solution = reconstruct.momentum(
        mass_a=1500.0, mass_b=1200.0, speed_a_after=8.0, speed_b_after=9.0, **courses
    )
    for owner, name, where in (
        (impact, "delta_v", "impact.a.delta_v or impact.b.delta_v"),
        (impact, "speed", "; write impact.a.after.speed (or .before, or impact.b)"),
        (impact.a, "speed", "before.speed or after.speed"),
        (impact.q, "delta_v", "impact.a.q.delta_v or impact.b.q.delta_v"),
        (impact.q, "speed", "impact.a.after.q.speed"),
        (impact.a.q, "speed", "before.q.speed or after.q.speed"),
        (solution, "delta_v", "; write delta_v_a or delta_v_b"),
        (solution.q, "pdof", "; write q.pdof_a or q.pdof_b"),
    ):
        with pytest.raises(AttributeError, match=re.escape(where)):
            getattr(owner, name)
        assert not hasattr(owner, name)
    for name in ("nothing", "_delta_v"):
        for owner in (impact, impact.q, solution, solution.q):
            with pytest.raises(AttributeError, match=rf"no attribute '{name}'$"):
                getattr(owner, name)


@pytest.mark.parametrize(
    ("text", "argument", "cure"),
    [
        ("1,500 kg", "mass", "'1500 kg' or '1.500 kg'"),
        ("1,234,500 g", "mass", "'1234500 g'"),
        ("12,5 m", "x", "'12.5 m'"),
        ("40 kmh", "vx", "'kmh' is written 'km/h'"),
        ("40 KM/H", "vx", "'KM/H' is written 'km/h'"),
        ("1500 Kg", "mass", "'Kg' is written 'kg'"),
        ("7'6\"", "x", "'7.5 ft' is one"),
        ("7 ft 6 in", "x", "'7.5 ft' is one"),
        ("2100 lbf-ft-s**2", "yaw_inertia", "'2100 lbf*ft*s**2'"),
        ('84"', "x", "'84 in'"),
        ("7'", "x", "'7 ft'"),
        ("3400#", "mass", "'3400 lb'"),
        ("3400 lbs.", "mass", "'3400 lbs'"),
        ("N45E", "heading", "with x to the east, north is '90 deg'"),
        ("north", "heading", "with x to the east, north is '90 deg'"),
    ],
)
def test_a_text_that_cannot_be_read_names_the_one_that_can(text, argument, cure):
    with pytest.raises(col.UnitsError, match=re.escape(cure)) as refused:
        col.Vehicle(**{"mass": 1500.0, argument: text})
    written = re.findall(r"'([^']*)'(?: is one)?", cure)[-1]
    if " " in written:  # the cure is read, to what was meant
        col.Vehicle(**{"mass": 1500.0, argument: written})
    assert refused.value.fields["argument"] == argument


def test_a_list_of_texts_names_the_quantity_to_write():
    """Also of a distribution of measured values, which has no unit of its own."""
    with pytest.raises(col.UnitsError, match=re.escape("pint.Quantity([40, 50.5], 'mph')")):
        col.Vehicle(mass=1500.0, vx=["40 mph", "50.5 mph"])
    for other, cure in (
        (["x", "y"], "pint.Quantity([...], 'mph')"),  # no numbers that were not given
        (["40 mph", "x"], "pint.Quantity([40, ...], 'mph')"),
        (np.array(["40 mph", "50.5 mph"]), "pint.Quantity([40, 50.5], 'mph')"),
        (
            np.array([pint.Quantity(40, "mph"), 50.5], dtype=object),
            "pint.Quantity([40, ...], 'mph')",
        ),
        (["40 mph", 3.0], "pint.Quantity([40, ...], 'mph')"),  # what 3.0 was meant in is not known
        (["60 mph", "88 ft/s"], "pint.Quantity([60, 60], 'mph')"),
        (["40 mph", ["50 mph"]], "pint.Quantity([40, ...], 'mph')"),
    ):
        with pytest.raises(col.InputError, match=re.escape(cure)) as caught:
            col.Vehicle(mass=1500.0, vx=other)
        assert caught.value.code == (
            "not_a_number" if isinstance(other, np.ndarray) else "bad_units"
        )
    with pytest.raises(
        col.UnitsError,
        match=r"put the unit on the whole: pint\.Quantity\(\[30, 31\], 'mph'\), or give numbers "
        r"in SI$",
    ):
        uncertainty.Samples(["30 mph", "31 mph"])
    with pytest.raises(
        col.UnitsError, match=r"friction is a list with '0.6' in it; give numbers, without quotes"
    ):
        col.eccentric(A, B, 0.1, friction=[0.5, "0.6"], **CONTACT)
    with pytest.raises(col.UnitsError, match=re.escape("pint.Quantity([3400, ...], 'lb')")):
        col.Vehicle(mass=["3400 lb", 1500])
    with pytest.raises(
        col.UnitsError,
        match=r"cannot read '0,5': a number has no comma here, write '0\.5'; give numbers",
    ):
        col.eccentric(A, B, 0.1, friction=["0,5", "0.6"], **CONTACT)
    for masses in (
        ["3400 lb", "3,500 lb"],
        ["3400 lb", " 3,500 lb"],
        np.array(["3400 lb", "3,500 lb"]),
    ):
        with pytest.raises(
            col.InputError, match=re.escape("pint.Quantity([3400, 3500], 'lb')")
        ) as caught:
            col.Vehicle(mass=masses)
        assert (
            f"{masses[1]}': a number has no comma here, write '3500 lb' or '3.500 lb'; put"
            in str(caught.value)
        )
    assert col.Vehicle(mass=1500.0, vx=pint.Quantity([40, 50.5], "mph")).vx[1] == pytest.approx(
        50.5 * 0.44704
    )


def test_an_attribute_that_cannot_be_worked_out_says_why():
    """Python asks ``__getattr__`` also when the attribute is there and raises an AttributeError
    itself.
    """

    class Answer(Frozen):
        @derived()
        def slope(self):
            return (1).slope_of_a_number

    with pytest.raises(AttributeError, match="'int' object has no attribute 'slope_of_a_number'"):
        _ = Answer().slope


@pytest.mark.parametrize(
    "given",
    ["2100 lb-ft-s2", "2100 ft-lb-sec^2", "2100 slug ft2", "2100 slug-ft^2", "2100 lb*ft*s2"],
)
def test_what_a_refused_yaw_inertia_is_told_to_write_can_be_read(given):
    with pytest.raises(col.UnitsError, match=r"raised by \*\*, '([^']*)'") as caught:
        col.Vehicle(mass=1500.0, yaw_inertia=given)
    cure = re.search(r"raised by \*\*, '([^']*)'", str(caught.value))[1]
    assert col.Vehicle(mass=1500.0, yaw_inertia=cure).yaw_inertia == pytest.approx(
        2847.22, rel=1e-5
    )  # 2100 slug ft2


@pytest.mark.parametrize("given", ["30 to 35 mph", "30-35 mph", "35 +/- 2 mph", "35 ± 2 mph"])
def test_a_range_in_place_of_a_number_is_named(given):
    with pytest.raises(
        col.UnitsError, match=r"this is a range; ranges go to collisions\.uncertainty\.propagate"
    ):
        col.Vehicle(mass=1500.0, vx=given)


def test_metres_per_hour_are_no_miles_per_hour():
    with pytest.raises(col.UnitsError, match="write 'mph' for miles"):
        col.Vehicle(mass=1500.0, vx="35 m/h")


def test_a_name_of_a_part_says_where_it_is():
    with pytest.raises(AttributeError, match=r"write collisions\.uncertainty\.Normal$"):
        _ = col.Normal
    with pytest.raises(
        AttributeError,
        match=r"write collisions\.plot\.momentum or collisions\.reconstruct\.momentum$",
    ):
        _ = col.momentum
    assert not hasattr(col, "Vehicel")


@pytest.mark.parametrize(
    ("call", "cure"),
    [
        (
            lambda: uncertainty.Normal("30 mph", std="2 mph"),
            "Normal has no argument 'std'; write sd=",
        ),
        (
            lambda: uncertainty.LogNormal(mu=3.0, sd=1.0),
            "LogNormal has no argument 'mu'; write mean=",
        ),
        (
            lambda: uncertainty.Uniform(lower=0.6, upper=0.8),
            "Uniform has no argument 'lower'; write low=",
        ),
        (lambda: uncertainty.Triangular(0.6, likely=0.7, high=0.8), "write mode="),
        (
            lambda: col.eccentric(A, B, 0.1, mu=0.5, **CONTACT),
            "eccentric() has no argument 'mu'; write friction=",
        ),
        (
            lambda: col.eccentric(A, B, e=0.1, friction=0.5, **CONTACT),
            "eccentric() has no argument 'e'; write restitution=",
        ),
        (lambda: col.eccentric(A, B, 0.1, normal=0.0, poi=(0, 0)), "write point="),
        (lambda: col.solve(A, B, cor=0.1), "solve() has no argument 'cor'; write restitution="),
        (
            lambda: col.linear_central(A, B, 0.1, friction=0.5),
            "oblique_central and eccentric have it",
        ),
        (lambda: col.oblique_central(A, B, 0.1, normal=0.0, point=(0, 0)), "eccentric has it"),
        (
            lambda: reconstruct.speeds(A, B, v_a=1.0),
            "speeds() has no argument 'v_a'; write speed_a=",
        ),
        (lambda: travel.speed("40 ft", mu=0.7), "speed() has no argument 'mu'; write drag="),
        (
            lambda: travel.speed("40 ft", drag=0.7, colour=1),
            "it has distance, drag, grade, end_speed",
        ),
        (lambda: col.diagnose(None, unit="us"), "diagnose() has no argument 'unit'; write units="),
    ],
)
def test_an_argument_that_a_function_does_not_have_names_the_one_it_has(call, cure):
    with pytest.raises(TypeError, match=re.escape(cure)) as refused:
        call()
    assert refused.value.__suppress_context__ or refused.value.__context__ is None


PUBLIC = {
    f"{module.__name__}.{name}": getattr(module, name)
    for module in (col, plot, reconstruct, reference, travel, uncertainty)
    for name in module.__all__
    if inspect.isfunction(getattr(module, name))
    and inspect.signature(getattr(module, name)).parameters
}


@pytest.mark.parametrize("name", PUBLIC)
def test_an_argument_in_capitals_is_the_one_that_is_meant(name):
    """The A of speed_A is not B."""
    function = PUBLIC[name]
    for argument, one in inspect.signature(function).parameters.items():
        if one.kind in (one.VAR_POSITIONAL, one.VAR_KEYWORD):
            continue
        for written in {argument.upper(), f"{argument[:-1]}{argument[-1].upper()}"} - {argument}:
            with pytest.raises(TypeError, match=rf"'{written}'; write {argument}="):
                function(**{written: 1.0})


@pytest.mark.parametrize(
    ("written", "cure"),
    [
        ("speed_after_a", "write speed_a_after="),
        ("speedA", "write speed_a="),
        ("a_course", "write course_a="),
        ("mass_1", "write mass_a="),
        ("heading2", "write heading_b="),
        ("yaw_rate_after_A", "write yaw_rate_a_after="),
        # What says no vehicle is none that is picked.
        ("mass_c", "write mass_a= or mass_b="),
        ("course_afterb", "write course_a_after= or course_b_after="),
    ],
)
def test_a_hint_never_names_the_other_vehicle(written, cure):
    with pytest.raises(TypeError, match=rf"'{written}'; {cure}$"):
        reconstruct.momentum(1500.0, 1200.0, **{written: 1.0})


def test_what_says_one_vehicle_is_none_of_the_other_in_files_and_reports():
    observed = ["b.delta_v", "a.delta_v", "b.yaw_rate"]
    assert suggestion("delta_v_a", observed) == "did you mean a.delta_v?"
    impact = col.linear_central(col.Vehicle(mass=1000.0, vx=10.0), col.Vehicle(mass=1000.0), 0.1)
    with pytest.raises(col.InputError, match=r"near it are a_delta_v, a\.delta_v, a_delta_vy$"):
        col.report(impact, answers=["delta_v_a"])
    # Where nothing of it is near, what the other one has is.
    assert nearest("B.tyres.friction", ["A.tyres.friction", "B.mass"], 3, 0.5) == [
        "A.tyres.friction"
    ]


def test_a_hint_at_what_points_the_other_way_says_so():
    with pytest.raises(TypeError, match=r"write delta_v_left_a=, with the other sign$"):
        reconstruct.speeds(A, B, delta_v_right_a=1.0)


@pytest.mark.parametrize("name", PUBLIC)
def test_every_public_function_says_what_arguments_it_has(name):
    names = list(inspect.signature(PUBLIC[name]).parameters)
    assert "unknown" not in names
    with pytest.raises(
        TypeError,
        match=rf"{name.rpartition('.')[2]}\(\) has no argument 'qqq'; it has {', '.join(names)}$",
    ):
        PUBLIC[name](qqq=1.0)


def test_other_type_errors_stay_as_they_are():
    @hinted
    def half(value):
        return value / 2

    with pytest.raises(TypeError, match="unsupported operand"):
        half(value="x")
    with pytest.raises(TypeError, match="missing 1 required keyword-only argument: 'drag'"):
        travel.speed("40 ft")


@pytest.mark.parametrize(
    "solver", [col.linear_central, col.oblique_central, col.eccentric, col.time_resolved, col.solve]
)
def test_a_solver_without_a_restitution_asks_for_it(solver):
    with pytest.raises(
        col.InputError, match=r"restitution must be a number.*such as 0.4; it was not given"
    ):
        solver(A, B)


@pytest.mark.parametrize("given", ["30 mph", "30 blorks", pint.Quantity(30, "mph"), object()])
def test_a_refusal_does_not_show_the_errors_of_other_packages(given):
    for call in (lambda: col.Vehicle(mass=given), lambda: uncertainty.Normal(given, "2 kg")):
        with pytest.raises(col.InputError) as refused:
            call()
        assert refused.value.__cause__ is None
        assert refused.value.__suppress_context__ or refused.value.__context__ is None


def test_what_is_none_for_want_of_a_heading_says_so():
    impact = col.linear_central(A, B, 0.1)
    for name in ("pdof", "pdof_clock", "delta_v_forward", "delta_v_left"):
        assert getattr(impact.a, name) is None
        with pytest.raises(
            col.MissingInputError,
            match=f"a has no heading, which {name} needs; give heading='30 deg'",
        ):
            getattr(impact.a.q, name)
        with pytest.raises(
            col.MissingInputError,
            match=f"a has no heading, which {name} needs; give heading='30 deg'",
        ):
            impact.to_columns(columns=[f"a.{name}"])
    with pytest.raises(
        col.InputError, match=r"columns: a\.moment_arm has no value in this impact; leave it out"
    ):
        impact.to_columns(columns=["a.moment_arm"])
    with pytest.raises(col.InputError, match=r"columns: point has no value in this impact"):
        impact.to_columns(columns=["point"])
    with pytest.raises(
        col.InputError, match=r"there is no column 'a\.delta'; write for example a\.delta_v"
    ):
        impact.to_columns(columns=["a.delta"])
    headed = col.linear_central(A.replace(heading="0 deg"), B, 0.1)
    assert headed.a.q.pdof_clock == 12
    assert headed.to_columns(columns=["a.pdof_clock"]) == {"a.pdof_clock": [12]}


@pytest.mark.parametrize("given", ["1e400 lb", "1e400 kg", "-2e308 kg", "1" + "0" * 50 + "e300 kg"])
def test_a_text_that_no_float_holds_is_not_infinite(given):
    with pytest.raises(col.InputError, match="mass is too large: "):
        col.Vehicle(mass=given)
    assert col.Vehicle(mass="inf kg").mass == float("inf")
    assert col.Vehicle(mass="1e300 kg").mass == 1e300


def test_a_page_saved_where_there_is_no_folder_names_the_folder(tmp_path):
    page = col.explain(col.linear_central(A, B, 0.1))
    missing = tmp_path / "cases" / "17"
    with pytest.raises(
        FileNotFoundError, match=re.escape(f"there is no folder {str(missing)!r}; make it first")
    ) as refused:
        page.save(missing / "page.md")
    assert refused.value.filename == str(missing / "page.md")
    with pytest.raises(
        IsADirectoryError,
        match=re.escape(f"name a file in it, such as {str(tmp_path / 'report.md')!r}"),
    ):
        page.save(tmp_path)
    missing.mkdir(parents=True)
    assert page.save(missing / "page.md").read_text(encoding="utf-8") == page


@pytest.mark.parametrize(
    ("form", "kind", "suffix"), [("markdown", "Markdown", ".md"), ("text", "plain text", ".txt")]
)
@pytest.mark.parametrize("ending", [".html", ".HTM"])
def test_only_a_page_of_html_is_saved_under_the_name_of_one(form, kind, suffix, ending, tmp_path):
    impact = col.linear_central(A, B, 0.1)
    said = (
        f"path ends in {ending}, but this page is {kind}, not HTML; write "
        f"save({str(tmp_path / f'v1.2{suffix}')!r})"
    )
    for make in (col.explain, col.report) if form == "markdown" else (col.explain,):
        page = make(impact, form=form)
        with pytest.raises(col.InputError, match=re.escape(said)) as refused:
            page.save(str(tmp_path / f"v1.2{ending}"))
        assert refused.value.code == "bad_option"
        assert not list(tmp_path.iterdir())
    assert col.report(impact, figures=False).save(tmp_path / f"v1.2{ending}").is_file()


@pytest.mark.parametrize(
    ("form", "ending", "said"),
    [
        (
            "html",
            ".pdf",
            (
                "this page is HTML, not PDF; write save({html!r}), open that in a browser and "
                "print it to a PDF"
            ),
        ),
        (
            "html",
            ".PDF",
            (
                "this page is HTML, not PDF; write save({html!r}), open that in a browser and "
                "print it to a PDF"
            ),
        ),
        ("html", ".docx", "this page is HTML; write save({html!r})"),
        ("html", ".md", "this page is HTML, not Markdown; write save({html!r})"),
        ("html", ".txt", "this page is HTML, not plain text; write save({html!r})"),
        (
            "markdown",
            ".pdf",
            (
                "this page is Markdown, not PDF; write save({md!r}); to print, write "
                "collisions.report(...).save({html!r}), open"
            ),
        ),
        ("markdown", ".json", "this page is Markdown; write save({md!r})"),
        (
            "text",
            ".pdf",
            (
                "this page is plain text, not PDF; write save({txt!r}); to print, write "
                "collisions.report(...).save({html!r}), open"
            ),
        ),
        ("text", ".md", "this page is plain text, not Markdown; write save({txt!r})"),
    ],
)
def test_a_page_is_saved_only_under_an_ending_of_its_form(form, ending, said, tmp_path):
    impact = col.linear_central(A, B, 0.1)
    pages = [col.explain(impact, form=form)] if form != "html" else []
    if form == "html":
        pages = [
            col.report(impact, figures=False),
            col.what_if(impact, {"restitution": (0.0, 0.4)}),
        ]
    names = {suffix: str(tmp_path / f"r.{suffix}") for suffix in ("html", "md", "txt")}
    for page in pages:
        with pytest.raises(
            col.InputError, match=re.escape(f"path ends in {ending}, but {said.format(**names)}")
        ) as refused:
            page.save(tmp_path / f"r{ending}")
        assert (refused.value.code, refused.value.fields["argument"]) == ("bad_option", "path")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["report", "case 1.2", "Golf vs. Polo", "r.HTM", ".page", "no. 7"])
def test_names_without_an_ending_of_another_form_stay(name, tmp_path):
    page = col.report(col.linear_central(A, B, 0.1), figures=False)
    assert page.save(tmp_path / name).read_text(encoding="utf-8") == page


def test_a_vehicle_named_by_its_letter_is_not_named_twice():
    with pytest.raises(col.MissingInputError, match="a has no heading"):
        _ = col.linear_central(A.replace(name="A"), B, 0.1).a.q.pdof
    with pytest.raises(col.MissingInputError, match=r"a \(Ford\) has no heading"):
        _ = col.linear_central(A.replace(name="Ford"), B, 0.1).a.q.pdof


def test_a_range_of_a_slider_that_leaves_out_the_value_shows_both():
    impact = col.linear_central(A, B, 0.1)
    for ends in ((0.1, 0.1), (0.3, 0.2), (0.2, 0.3)):
        with pytest.raises(
            col.InputError, match=re.escape(f"(low, high) in rising order around 0.1, got {ends}")
        ):
            col.what_if(impact, {"restitution": ends})
    with pytest.raises(col.InputError, match=r"around 30 mph, got \('31 mph', '40 mph'\)"):
        col.what_if(impact, {"speed_a": ("31 mph", "40 mph")})


@pytest.mark.parametrize("given", ["50000 ft-lb", "50000 ft-lbs", "50000 ft lb", "50000 ft*pounds"])
def test_pounds_of_an_energy_are_a_force(given):
    with pytest.raises(col.UnitsError) as refused:
        reconstruct.crush_delta_v(given, 1500.0, 1500.0)
    cure = re.search(r"'([^']*lbf)'", str(refused.value))[1]
    joule = 50000 * 0.3048 * 0.45359237 * 9.80665  # exact by definition
    assert reconstruct.crush_delta_v(cure, 1500.0, 1500.0) == pytest.approx(
        reconstruct.crush_delta_v(joule, 1500.0, 1500.0)
    )
    with pytest.raises(col.UnitsError, match="'300 lbf/in'"):
        reconstruct.crush_energy(1.0, [0.1, 0.2], stiffness_a="300 lb/in", stiffness_b=1e5)


def test_arguments_that_have_no_place_are_named():
    with pytest.raises(
        TypeError, match="Vehicle takes its arguments by name, as in mass='3400 lb': mass, vx"
    ):
        col.Vehicle("3400 lb")
    with pytest.raises(
        TypeError,
        match="speed\\(\\) takes 1 positional argument but 2 were given; write the others by "
        "name, such as drag=",
    ):
        travel.speed("40 ft", 0.7)
    with pytest.raises(TypeError, match=r"^Normal missing 1 required positional argument: 'sd'$"):
        uncertainty.Normal("30 mph")
    with pytest.raises(TypeError, match="options has no argument 'units'; it has require_units"):
        col.options(units="us")


def test_the_ends_of_a_range_are_shown_in_their_unit():
    with pytest.raises(
        col.InputError, match="in rising order, got 40 mph and 30 mph; exchange them"
    ):
        uncertainty.Uniform("40 mph", "30 mph")
    with pytest.raises(
        col.InputError, match=r"mode must be from low to high, 30 mph to 40 mph, got 45 mph"
    ):
        uncertainty.Triangular("30 mph", "45 mph", "40 mph")


def test_what_holds_the_value_that_is_meant_says_so():
    impact = col.eccentric(
        A.replace(yaw_inertia=2000.0, x=-2.0, y=0.0),
        col.Vehicle.barrier(),
        0.1,
        friction=0.5,
        **CONTACT,
    )
    with pytest.raises(
        col.InputError,
        match=r"b_after must be a Vehicle, got VehicleResult; write its .before or .after",
    ):
        reconstruct.restitution(A, B, A, impact.b, **CONTACT)
    with pytest.raises(
        col.InputError, match=r"mass_a must be a number.*write its mass, such as a\.mass"
    ):
        reconstruct.momentum(
            A, 1500.0, course_a=0.0, course_b=1.0, course_a_after=0.5, course_b_after=0.5
        )
