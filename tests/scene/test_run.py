"""What a user asks of a run, or gets wrong: times, cases, places of rest, and records."""

from __future__ import annotations

import json
import math
import re
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Run, Scene
from collisions.travel import GRAVITY, Tyres

OUTLINE = (4.5, 1.8)
IN_LINE = {"normal": 0.0, "model": "linear_central", "at": "touch", "restitution": 0.2}
NO_ANSWER = "ignore::collisions.CollisionsWarning"


def car(mass: float, vx: Any, x: Any, **more: Any) -> Mover:
    slowed = {name: more.pop(name) for name in ("drag", "tyres") if name in more}
    given = {"y": 0.0, "heading": 0.0, **more}
    return Mover(col.Vehicle(mass=mass, vx=vx, x=x, **given), outline=OUTLINE, **slowed)


def two(vx: Any = 10.0, **more: Any) -> Scene:
    """A of 1500 kg meets B of 1000 kg, 2 m ahead; together they go at 0.6 of its speed."""
    movers = {"A": car(1500.0, vx, 0.0, **more), "B": car(1000.0, 0.0, 6.5, **more)}
    return Scene(movers=movers, contacts=[Contact("A", "B", **IN_LINE)])


# In closed form: 6 m/s of the centre of mass, and 0.2 of 10 m/s apart.
AFTER_A, AFTER_B = 6.0 - 0.4 * 0.2 * 10.0, 6.0 + 0.6 * 0.2 * 10.0


def test_at_gives_all_vehicles_before_at_and_after_a_contact() -> None:
    run = two().run()
    (time,) = run.times
    assert time == pytest.approx(0.2, rel=1e-9)
    assert run.at("100 ms")["A"].x == pytest.approx(1.0)
    assert run.at(math.nextafter(time, 0.0))["A"].vx == 10.0
    assert run.at(time)["A"].vx == pytest.approx(AFTER_A)
    later = run.at(1.2)
    assert later["B"].x == pytest.approx(6.5 + AFTER_B, rel=1e-9)
    assert later["A"].name == "A"
    assert run.at(0)["A"] == two().movers["A"].vehicle.replace(name="A")


@pytest.mark.parametrize(
    ("time", "code", "says"),
    [
        (-1, "negative_time", "a scene starts at 0"),
        (math.nan, "not_finite", "time is NaN"),
        ("inf s", "not_finite", "time must be finite"),
        ("3 m", "bad_units", "cannot be taken as s"),
        ([0.1], "bad_shape", "takes one value"),
        (np.array([0.1, 0.2]), "bad_shape", "run.paths has all moments"),
    ],
)
def test_a_time_that_cannot_be_is_refused(time: Any, code: str, says: str) -> None:
    with pytest.raises(col.InputError, match=says) as caught:
        two().run().at(time)
    assert caught.value.code == code


def test_what_nothing_slows_has_no_place_of_rest_and_the_table_says_that_it_goes_on() -> None:
    run = two().run()
    with pytest.raises(col.MissingInputError, match="give it tyres=, or drag=") as caught:
        _ = run.rest["A"]
    assert caught.value.code == "missing_drag"
    assert run.end == run.times[0]
    assert "goes on" in str(run.summary())
    assert run.energy["left"] == pytest.approx(750.0 * AFTER_A**2 + 500.0 * AFTER_B**2)
    assert run.energy["before"] == 75000.0
    assert run.energy["ground"] == 0.0
    before, after = run.momentum[0]
    assert before == pytest.approx((15000.0, 0.0))
    assert after == pytest.approx(before)


def test_places_of_rest_are_a_mapping_and_names_that_are_none_are_refused() -> None:
    run = two(drag=0.5).run()
    assert [*run.rest] == [*run.rest.keys()] == ["A", "B"]
    assert len(run.rest) == 2
    assert "A" in run.rest
    assert "Z" not in run.rest
    assert repr(run.rest) == "<places of rest of A, B>"
    with pytest.raises(KeyError, match="Z"):
        _ = run.rest["Z"]
    with pytest.raises(KeyError, match="'Z' is no mover; the movers are A, B"):
        _ = run["Z"]
    moved = run["B"]
    assert moved.rest == run.rest["B"]
    assert moved.impacts == run.impacts
    assert moved.path.x[-1] == pytest.approx(run.rest["B"].x)
    assert "B" in str(moved.summary())
    after = run.impacts[0].b.after.vx
    assert moved.rest.x == pytest.approx(6.5 + after**2 / (2.0 * 0.5 * GRAVITY))
    assert run.at(run.end + 100.0)["B"].x == moved.rest.x
    assert run.q.end.m_as("ms") == pytest.approx(1000.0 * run.end)


def test_a_run_is_equal_to_one_of_the_same_scene_and_tolerance_only() -> None:
    run = two().run()
    assert run == two().run()
    assert run != two().run(tolerance=1e-3)
    assert run != two(11.0).run()
    assert run != "a run"
    assert repr(run) == "<Run of A, B: 1 impacts>"


@pytest.mark.slow
@pytest.mark.filterwarnings(NO_ANSWER)
def test_a_batch_says_which_cases_have_no_answer_and_is_nan_there() -> None:
    run = two(np.array([10.0, 11.0, 0.0])).run()
    assert run.status.tolist() == ["ok", "ok", "contact_missing"]
    assert run.times[0] == pytest.approx([0.2, 2.0 / 11.0, math.nan], nan_ok=True)
    assert run.deepest[0].tolist() == [False] * 3
    assert run.findings == ()
    assert repr(run) == "<Run of A, B: 1 impacts, 3 cases>"
    assert "3 cases, 1 of them without an answer." in str(run.summary())
    assert run.at(0.1)["A"].x == pytest.approx([1.0, 1.1, math.nan], nan_ok=True)
    each = run.at(np.array([0.1, 0.05, 0.1]))["A"].x
    assert each == pytest.approx([1.0, 0.55, math.nan], nan_ok=True)
    at_contact = run.at(run.times[0])["B"].vx
    assert at_contact == pytest.approx([AFTER_B, 1.1 * AFTER_B, math.nan], nan_ok=True)
    assert np.isnan(run.rest["A"].x).all()
    assert np.isnan(run.paths["A"].x[:, 2]).all()
    assert np.isfinite(run.paths["A"].x[:, :2]).all()
    momentum = run.momentum[0][1][0]
    assert momentum == pytest.approx([15000.0, 16500.0, math.nan], nan_ok=True)
    assert Run.from_dict(json.loads(json.dumps(run.to_dict(), allow_nan=False))) == run
    assert run.to_columns(units="us")["times[0] [s]"][1] == pytest.approx(2.0 / 11.0)


@pytest.mark.filterwarnings(NO_ANSWER)
@pytest.mark.parametrize(
    ("ask", "code", "says"),
    [
        (lambda run: run.energy, "bad_shape", r"write run.case\(0\).energy"),
        (lambda run: run.case(3), "bad_index", r"below 3, got 3; write run.case\(0\)"),
        (lambda run: run.case("a"), "bad_index", "a whole number below 3, got 'a'"),
        (lambda run: run.scene.case(3), "bad_index", r"write scene.case\(0\)"),
        (lambda run: run.case(0).case(0), "bad_shape", "run is one case"),
        (lambda run: run.case(2), "contact_missing", "A and B are 2 m apart"),
        (lambda run: run.at(np.array([0.1, 0.2])), "bad_shape", "one for each case"),
        (lambda run: run.at(np.array([0.1, -1.0, 0.1])), "negative_time", ">= 0"),
        (lambda run: run.at(np.array([0.1, math.inf, 0.1])), "not_finite", "every case"),
    ],
)
def test_what_a_batch_does_not_have_says_what_to_write(ask: Any, code: str, says: str) -> None:
    run = two(np.array([10.0, 11.0, 0.0])).run()
    with pytest.raises(col.CollisionsError, match=says) as caught:
        ask(run)
    assert caught.value.code == code


@pytest.mark.slow
@pytest.mark.filterwarnings(NO_ANSWER)
@pytest.mark.parametrize(
    ("drag", "code"),
    [(math.nan, "not_finite"), (math.inf, "not_finite"), (-0.1, "negative_drag")],
)
def test_a_drag_that_cannot_be_leaves_its_case_without_an_answer(drag: float, code: str) -> None:
    run = two(drag=np.array([0.5, drag])).run()
    assert run.status.tolist() == ["ok", code]
    assert run.rest["A"].x[0] == pytest.approx(two(drag=0.5).run().rest["A"].x, rel=1e-12)
    assert math.isnan(run.rest["A"].x[1])
    assert math.isnan(run.at(0.1)["A"].x[1])


def test_a_bare_slope_in_percent_is_warned_of() -> None:
    body = col.Vehicle(mass=1500.0, vx=10.0, x=0.0, y=0.0, heading=0.0)
    for slope, said in (
        ((5.0, 0.0), "slope[0] = 5 is read as the rise over the run"),
        ((0.0, -2), "slope[1] = -2"),
    ):
        with pytest.warns(col.SuspectUnitsWarning, match=re.escape(said)):
            Scene(movers={"A": Mover(body, drag=0.5)}, contacts=[], slope=slope)
    Scene(movers={"A": Mover(body, drag=0.5)}, contacts=[], slope=("5 %", "-2 %"))


def test_an_impact_that_some_cases_do_not_have_has_a_model_in_all() -> None:
    """As integers, where there is no impact too, and with no number there."""
    rule = Contact("A", "B", model="solve", normal=0.0, point=(3.0, 0.0), tolerance=0.1, **AT_TOUCH)
    a = car(1500.0, np.array([9.0, 1.0, 9.5]), 0.0, drag=0.5)
    scene = Scene(movers={"A": a, "B": car(1000.0, 0.0, 6.5, drag=0.5)}, contacts=[rule])
    with pytest.warns(col.CollisionsWarning, match="1 contact_missing"):
        run = scene.run()
    (impact,) = run.impacts
    assert impact.choice.model.dtype.kind == "U"
    assert np.isnan(impact.a.kinetic_energy_change).tolist() == [False, True, False]
    assert str(impact)


@pytest.mark.slow
@pytest.mark.filterwarnings(NO_ANSWER)
@pytest.mark.parametrize(
    ("name", "wrong", "code"),
    [
        ("delay", math.nan, "not_finite"),
        ("delay", -0.01, "negative_duration"),
        ("depth", math.inf, "not_finite"),
        ("depth", -0.1, "negative_length"),
        ("at", -1.0, "negative_time"),
        ("at", math.nan, "not_finite"),
    ],
)
def test_a_number_of_a_contact_that_cannot_be_leaves_its_case_without_an_answer(
    name: str, wrong: float, code: str
) -> None:
    movers = {
        "A": car(1500.0, 10.0, 0.0, yaw_inertia=2400.0),
        "B": car(1000.0, 0.0, 6.5, yaw_inertia=1500.0, heading=0.2, y=0.3),
    }
    given = {"restitution": 0.1, "friction": 0.5, "at": "touch"}
    good = {"delay": 0.01, "depth": 0.05, "at": 0.24}[name]

    def run_of(value: Any) -> Run:
        return Scene(movers=movers, contacts=[Contact("A", "B", **{**given, name: value})]).run()

    many, one = run_of(np.array([good, wrong])), run_of(good)
    assert many.status.tolist() == ["ok", code]
    assert many.times[0][0] == pytest.approx(one.times[0], rel=1e-12)
    assert math.isnan(many.times[0][1])
    assert many.at(1.0)["B"].yaw_rate[0] == pytest.approx(one.at(1.0)["B"].yaw_rate, rel=1e-9)


def test_what_a_drag_cannot_stop_is_refused_or_is_a_case_without_an_answer() -> None:
    def standing(yaw_rate: Any = 0.0, slope: Any = 0.0) -> Run:
        body = col.Vehicle(mass=1500.0, x=1.0, y=0.0, heading=0.0, yaw_rate=yaw_rate)
        return Scene(movers={"A": Mover(body, drag=0.4)}, contacts=[], slope=(slope, 0.0)).run()

    for given, says in (({"yaw_rate": 1.0}, "turns on the spot"), ({"slope": 0.45}, "too steep")):
        with pytest.raises(col.NoSolutionError, match=f"{says}.*give it tyres=") as caught:
            standing(**given)
        assert caught.value.code == "never_stops"
        ((name, value),) = given.items()
        with pytest.warns(col.CollisionsWarning, match="1 of 2 cases .*1 never_stops"):
            run = standing(**{name: np.array([value, 0.1 * (name == "slope")])})
        assert run.status.tolist() == ["never_stops", "ok"]
        assert run.rest["A"].x == pytest.approx([math.nan, 1.0], nan_ok=True)
    with pytest.warns(col.CollisionsWarning, match="1 of 1 cases"):
        assert standing(np.array([1.0])).status.tolist() == ["never_stops"]


@pytest.mark.slow
def test_a_car_that_rolls_on_after_a_contact_is_where_its_speed_takes_it() -> None:
    """On wheels that nothing brakes: after its slip has faded, evenly on; it has no rest."""

    def run_of(lock: Any) -> Run:
        tyres = Tyres(0.7, lock, 2.6, 1.5)
        movers = {
            "A": car(1500.0, 14.0, -6.0, yaw_inertia=2400.0, y=0.4, tyres=tyres),
            "B": car(1200.0, 0.0, 0.0, yaw_inertia=1700.0, heading=1.57, tyres=tyres),
        }
        given = {"restitution": 0.1, "friction": 0.5, "at": "touch"}
        return Scene(movers=movers, contacts=[Contact("A", "B", **given)]).run()

    run = run_of(0.0)
    early, late = run.at(20.0)["A"], run.at(30.0)["A"]
    assert late.speed == pytest.approx(early.speed, rel=1e-6)
    assert late.x - early.x == pytest.approx(10.0 * late.vx, rel=1e-6)
    with pytest.raises(col.CollisionsError):
        _ = run.rest["A"]
    with pytest.warns(col.OutOfRangeWarning, match="in 2 of 2 cases .* through or into each other"):
        many = run_of(np.array([0.0, 0.3]))
    assert many.status.tolist() == ["ok", "ok"]
    assert many.at(20.0)["A"].x[0] == pytest.approx(early.x, abs=0.02)
    assert many.at(20.0)["A"].vx[1] == 0.0


def test_cars_that_do_not_fit_on_their_outlines_are_refused_case_by_case() -> None:
    scene = two().replace({"B.x": np.array([6.5, 3.0])})
    with pytest.warns(col.CollisionsWarning, match="1 overlap_at_start"):
        run = scene.run()
    assert run.status.tolist() == ["ok", "overlap_at_start"]
    with pytest.raises(col.InputError, match=r"overlap by 1.5 m at the start.*correct x, y"):
        run.case(1)


def test_a_contact_at_a_time_has_to_find_its_vehicles_together() -> None:
    scene = Scene(
        movers={
            "A": car(1500.0, 10.0, 0.0, yaw_inertia=2400.0),
            "B": car(1000.0, 0.0, 6.5, yaw_inertia=1500.0),
        },
        contacts=[Contact("A", "B", restitution=0.1, friction=0.5, at=0.1)],
    )
    with pytest.raises(col.InputError, match=r"1 m apart at 0.1 s.*write at='touch'") as caught:
        scene.run()
    assert caught.value.code == "contact_missing"
    with pytest.warns(col.CollisionsWarning, match="1 contact_missing"):
        run = scene.replace({"contacts[0].at": np.array([0.21, 0.1])}).run()
    assert run.status.tolist() == ["ok", "contact_missing"]
    assert run.times[0] == pytest.approx([0.21, math.nan], nan_ok=True)
    bare = Scene(
        movers=dict(scene.movers, B=Mover(scene.movers["B"].vehicle)), contacts=scene.contacts
    )
    with pytest.raises(col.MissingInputError, match=r"B has no outline.*give outline=") as lacks:
        bare.run()
    assert lacks.value.code == "missing_outline"


def test_the_order_of_contacts_is_held_to_case_by_case() -> None:
    scene = Scene(
        movers=two().movers,
        contacts=[Contact("A", "B", **IN_LINE)],
        order=[("A", "B")],
    )
    assert scene.run().pairs == (("A", "B"),)
    wrong = Scene(
        movers=two(np.array([10.0, 11.0])).movers,
        contacts=scene.contacts,
        order=[("A", "B"), ("A", "B")],
    )
    with pytest.warns(col.CollisionsWarning, match="2 other_order"):
        assert wrong.run().status.tolist() == ["other_order"] * 2


@pytest.mark.slow
def test_a_contact_without_end_leaves_its_case_without_an_answer() -> None:
    walls = {
        name: Mover(col.Vehicle.barrier(x=x, y=0.0, heading=0.0), outline=OUTLINE)
        for name, x in (("left", -10.0), ("right", 10.0))
    }
    rule = IN_LINE | {"restitution": np.array([0.9, 1.0])}
    scene = Scene(
        movers={"A": car(1000.0, 5.0, 0.0, drag=0.0), **walls},
        contacts=[Contact("left", "A", **rule), Contact("A", "right", **rule)],
    )
    # Below 1 m/s a pair is passed over: the other case goes through a wall in the end.
    with (
        pytest.warns(col.OutOfRangeWarning, match="through or into each other"),
        pytest.warns(col.CollisionsWarning, match="1 never_ends"),
    ):
        run = scene.run()
    assert run.status[1] == "never_ends"
    with pytest.raises(col.NoSolutionError, match="a lower restitution") as caught:
        run.case(1)
    assert caught.value.code == "never_ends"


@pytest.mark.slow
def test_a_contact_with_tyres_in_it_is_in_a_batch_as_alone() -> None:
    def body(vx: Any, x: float) -> Mover:
        tyres = Tyres(0.7, 1.0, 2.7, 1.5)
        return car(1500.0, vx, x, yaw_inertia=2400.0, tyres=tyres)

    def run_of(vx: Any) -> Run:
        rule = {"restitution": 0.1, "friction": 0.5, "normal": 0.0, "point": (0.0, 0.2)}
        contact = Contact("A", "B", model="eccentric", duration=0.1, **rule)
        return Scene(movers={"A": body(vx, -2.3), "B": body(0.0, 2.3)}, contacts=[contact]).run()

    many, one = run_of(np.array([9.0, 12.0])), run_of(12.0)
    assert many.impacts[0].b.delta_v[1] == pytest.approx(one.impacts[0].b.delta_v, rel=1e-12)
    assert many.rest["B"].x[1] == pytest.approx(one.rest["B"].x, abs=1e-9)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda record: None, "TypeError"),
        (lambda record: {}, "KeyError 'format'"),
        (lambda record: record | {"format": "collisions scene 9"}, "'collisions scene 1'"),
        (lambda record: {k: v for k, v in record.items() if k != "movers"}, "KeyError 'movers'"),
        (lambda record: record | {"movers": "abc"}, "TypeError"),
        (lambda record: record | {"movers": record["movers"][:1] * 2}, "it has 'A' twice"),
        (lambda record: record | {"shared": []}, "AttributeError"),
        (lambda record: record | {"surfaces": [{"corners": [1], "friction": 0.3}]}, "TypeError"),
        (lambda record: record | {"contacts": [{"a": "A"}]}, "a contact has a, b, restitution"),
    ],
)
def test_a_record_of_a_scene_that_was_altered_is_refused(change: Any, says: str) -> None:
    record = json.loads(json.dumps(two().to_dict()))
    with pytest.raises(col.InputError, match=says) as caught:
        Scene.from_dict(change(record))
    assert caught.value.code == "bad_record"
    assert str(caught.value).startswith("record is not what Scene.to_dict() gives: ")


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"format": "collisions scene 1"}, "bad_record"),
        ({"scene": None}, "bad_record"),
        ({"tolerance": -1}, "not_positive"),
        ({"tolerance": "fine"}, "bad_units"),
    ],
)
def test_a_record_of_a_run_that_was_altered_is_refused(change: Any, code: str) -> None:
    record = json.loads(json.dumps(two().run().to_dict()))
    with pytest.raises(col.InputError) as caught:
        Run.from_dict(record | change)
    assert caught.value.code == code
    with pytest.raises(col.InputError, match=r"Run.to_dict\(\) gives: KeyError 'scene'"):
        Run.from_dict({"format": record["format"]})


def test_a_record_reads_like_a_callers_numbers() -> None:
    record = json.loads(json.dumps(two().to_dict()))
    record["contacts"][0]["restitution"] = 3.0
    with pytest.raises(
        col.InputError, match=r"restitution must be from 0 to 1, got 3\.0"
    ) as caught:
        Scene.from_dict(record)
    assert caught.value.code == "bad_restitution"


@pytest.mark.slow
def test_a_record_has_the_number_where_its_text_reads_as_another() -> None:
    # A registry of one's own may count its units otherwise than the one that reads the record.
    pint = pytest.importorskip("pint")
    own = pint.UnitRegistry()
    own.define("foot = 0.3047 m")
    own.define("percent = 0.011")
    feet, share = own.Quantity(3.0, "foot"), own.Quantity(40.0, "percent")
    tyres = Tyres(share, 0.3, own.Quantity(9.0, "foot"), 1.5)
    base = two(tyres=tyres, yaw_inertia=2400.0)
    contact = Contact(
        "A",
        "B",
        restitution=own.Quantity(10.0, "percent"),
        friction=share,
        normal=0.0,
        point=(feet, 0.0),
        model="solve",
        tolerance=own.Quantity(1.0, "foot/second"),
        at="touch",
    )
    area = [(20, -5), (30, -5), (30, 5), (20, 5)]
    scene = Scene(
        movers={**base.movers, "C": car(1000.0, 0.0, 60.0, drag=share)},
        contacts=[contact],
        surfaces=[(area, share)],
        slope=(own.Quantity(1.0, "percent"), 0.0),
    )
    assert contact.point[0] == 3.0 * 0.3047
    record = json.loads(json.dumps(scene.to_dict()))
    assert record["contacts"][0]["point"][0] == contact.point[0]
    assert record["contacts"][0]["tolerance"] == contact.tolerance
    again = Scene.from_dict(record)
    assert again == scene
    assert again.contacts[0].tolerance == contact.tolerance
    assert again.movers["A"].tyres.wheelbase == tyres.wheelbase
    assert again.movers["C"].drag == scene.movers["C"].drag
    assert again.surfaces[0][1] == scene.surfaces[0][1]
    assert again.slope == scene.slope


def test_a_record_keeps_texts_that_read_as_the_number() -> None:
    rule = {"restitution": "10 %", "friction": "50 %", "normal": "5 deg", "point": ("1 ft", 0)}
    scene = Scene(
        movers={"A": car(1500.0, 9.0, 0.0, drag="22.5 ft/s**2"), "B": car(1000.0, 0.0, 6.5)},
        contacts=[Contact("A", "B", at="100 ms", **rule)],
        slope=("2 %", 0),
    )
    record = json.loads(json.dumps(scene.to_dict()))
    (contact,) = record["contacts"]
    assert {name: contact[name] for name in ("restitution", "friction", "normal", "at")} == {
        "restitution": "10 %",
        "friction": "50 %",
        "normal": "5 deg",
        "at": "100 ms",
    }
    assert contact["point"] == ["1 ft", 0.0]
    assert record["movers"][0]["drag"] == scene.movers["A"].as_given("drag")
    assert record["slope"] == ["2 %", 0.0]
    assert Scene.from_dict(record) == scene


AT_TOUCH = {"restitution": 0.1, "friction": 0.5, "at": "touch"}


def row(gap: float = 0.0) -> dict[str, Mover]:
    """A at 10 m/s, 2 m behind B, which stands behind C."""
    places = {"A": 0.0, "B": 6.5, "C": 11.0 + gap}
    return {
        name: car(1000.0, 10.0 if name == "A" else 0.0, x, yaw_inertia=2000.0)
        for name, x in places.items()
    }


def pushed(contact: Contact, **movers: Mover) -> Run:
    one = row()
    return Scene(movers={"A": one["A"], "B": one["B"], **movers}, contacts=[contact]).run()


@pytest.mark.parametrize(("a", "b", "normal"), [("A", "B", "5 deg"), ("B", "A", "185 deg")])
def test_a_stated_normal_has_its_point_from_the_overlap(a: str, b: str, normal: str) -> None:
    run = pushed(Contact(a, b, normal=normal, **AT_TOUCH))
    # 30 ms after first touch A is 0.3 m in: the middle is half of that beyond the rear of B.
    assert run.times[0] == pytest.approx(0.23)
    assert run.impacts[0].point == pytest.approx((4.25 + 0.15, 0.0), abs=1e-9)
    sign = 1.0 if a == "A" else -1.0
    wanted = (sign * math.cos(math.radians(5.0)), sign * math.sin(math.radians(5.0)))
    assert run.impacts[0].normal == pytest.approx(wanted)
    many = pushed(Contact("A", "B", normal=np.array([0.0, 0.1]), **AT_TOUCH))
    assert many.impacts[0].point[0] == pytest.approx([4.4, 4.4])
    assert many.impacts[0].normal[1] == pytest.approx([0.0, math.sin(0.1)])


@pytest.mark.slow
def test_a_normal_along_which_nothing_closes_has_no_contact() -> None:
    with pytest.raises(col.NoSolutionError, match=r"touch at 0\.2 s, and do not close") as caught:
        pushed(Contact("A", "B", normal=3.1, **AT_TOUCH))
    assert caught.value.code == "contact_missing"
    with pytest.warns(col.CollisionsWarning, match="1 contact_missing"):
        run = pushed(Contact("A", "B", normal=np.array([0.0, 3.1]), **AT_TOUCH))
    assert run.times[0] == pytest.approx([0.23, math.nan], nan_ok=True)


def test_a_bare_touch_of_two_faces_is_a_case_without_an_answer() -> None:
    with pytest.warns(col.CollisionsWarning, match="1 bare_touch"):
        run = pushed(Contact("A", "B", delay=np.array([0.02, 0.0]), **AT_TOUCH))
    assert run.status.tolist() == ["ok", "bare_touch"]


def test_what_a_solver_refuses_names_the_contact_its_vehicles_and_the_time() -> None:
    bare = Scene(movers=two().movers, contacts=[Contact("A", "B", **AT_TOUCH)])
    says = r"contacts\[0\], A and B at 0.23 s: .*(\n.*)*has no yaw_inertia"
    with pytest.raises(col.MissingInputError, match=says) as caught:
        bare.run()
    assert caught.value.code == "missing_inertia"
    solved = pushed(Contact("A", "B", model="solve", **AT_TOUCH))
    # In line, of equal masses: half of 1.1 times the closing speed.
    assert solved.impacts[0].b.delta_v == pytest.approx(5.5)


@pytest.mark.slow
def test_cars_bumper_to_bumper_push_on_a_delay_after_they_are_driven_together() -> None:
    rules = [Contact("A", "B", **AT_TOUCH), Contact("B", "C", **AT_TOUCH)]
    run = Scene(movers=row(), contacts=rules).run()
    assert run.pairs[:2] == (("A", "B"), ("B", "C"))
    assert run.times[:2] == pytest.approx((0.23, 0.26))
    # B goes 5.5 m/s for 30 ms, and the middle of the overlap is half of that into C.
    assert run.impacts[1].point == pytest.approx((8.75 + 0.5 * 5.5 * 0.03, 0.0), abs=1e-6)
    apart = Scene(movers=row(0.055), contacts=rules).run()
    assert apart.times[1] == pytest.approx(0.23 + 0.01 + 0.03)
    still = {name: mover for name, mover in row().items() if name != "A"}
    with pytest.raises(col.NoSolutionError, match="B and C do not part and meet again") as caught:
        Scene(movers=still, contacts=[rules[1]]).run()
    assert caught.value.code == "contact_missing"


def test_a_wall_takes_no_energy_by_the_ground_and_stays() -> None:
    wall = Mover(col.Vehicle.barrier(x=10.0, y=0.0, heading=0.0), outline=OUTLINE)
    run = Scene(
        movers={"A": car(1500.0, 10.0, 0.0, drag=0.5), "W": wall},
        contacts=[Contact("A", "W", **IN_LINE)],
    ).run()
    assert run.rest["W"].x == 10.0
    path = run.paths["W"]
    assert set(path.x) == {10.0}
    assert "marks" not in repr(path)
    energy = run.energy
    kept = energy["before"] - sum(energy["contacts"]) - energy["ground"] - energy["left"]
    assert kept == pytest.approx(0.0, abs=1e-6 * energy["before"])
    assert energy["left"] == pytest.approx(0.0, abs=1e-9)


def test_a_scene_without_a_contact_ends_as_it_begins_where_nothing_slows() -> None:
    run = Scene(movers={"A": car(1500.0, 10.0, 0.0)}, contacts=[]).run()
    assert run.end == 0.0
    assert run.impacts == ()
    assert run.paths["A"].time.tolist() == [0.0]
    assert run.at(3.0)["A"].x == 30.0


@pytest.mark.parametrize("tolerance", ["0.05 m/s", "3 m/s"])
def test_the_tolerance_of_a_contact_is_that_of_solve(tolerance: str) -> None:
    """A larger one lets a smaller model pass, as where the same impact is solved by itself."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.0, y=0.3, heading=0.0, vx=12.0)
    b = col.Vehicle(mass=1300.0, yaw_inertia=2100.0, x=2.0, y=-0.2, heading=0.0)
    where: dict[str, Any] = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.4}
    alone = col.solve(a, b, 0.1, **where, tolerance=tolerance)
    contact = Contact("A", "B", restitution=0.1, **where, model="solve", tolerance=tolerance)
    movers = {"A": Mover(a, drag=0.5), "B": Mover(b, drag=0.5)}
    (impact,) = Scene(movers=movers, contacts=[contact]).run().impacts
    assert impact.model == alone.model
    assert impact.model == ("linear_central" if tolerance == "3 m/s" else "eccentric")
    assert impact.b.delta_v == pytest.approx(alone.b.delta_v, rel=1e-12)


DRIVEN = {"normal": 0.0, "model": "linear_central", "at": "touch", "restitution": 0.05}


def braked(mass: float, x: float, drag: float, speed: float = 0.0) -> Mover:
    vehicle = col.Vehicle(mass=mass, vx=speed, x=x, y=0.0, heading=0.0)
    return Mover(vehicle, outline=(4.6, 1.8), drag=drag)


@pytest.mark.slow
def test_a_striker_that_is_braked_less_is_found_to_go_through_the_struck_car() -> None:
    """What pushes without a blow is not followed: single cases say so, batches count them."""
    crash = Scene(
        movers={"pickup": braked(2359.0, -4.9, 0.1, 13.4), "sedan": braked(1497.0, 0.0, 0.7)},
        contacts=[Contact("pickup", "sedan", **DRIVEN)],
    )
    run = crash.run()
    assert run.rest["pickup"].x > run.rest["sedan"].x
    (notice,) = run.findings
    assert notice.code == "driven_through"
    assert notice.movers == ("pickup", "sedan")
    assert "pickup and sedan do not part right after their contact" in notice.sentence
    alike = crash.replace({"pickup.drag": 0.7})
    assert not alike.run().findings
    with pytest.warns(col.OutOfRangeWarning, match="in 1 of 2 cases") as warned:
        crash.replace({"pickup.drag": np.array([0.1, 0.7])}).run()
    assert warned[0].message.code == "driven_through"


def test_a_little_more_push_is_an_overlap_at_rest() -> None:
    crash = Scene(
        movers={"pickup": braked(2359.0, -4.9, 0.55, 9.0), "sedan": braked(1497.0, 0.0, 0.7)},
        contacts=[Contact("pickup", "sedan", **(DRIVEN | {"restitution": 0.0}))],
    )
    run = crash.run()
    overlap = run.rest["pickup"].x + 4.6 - run.rest["sedan"].x
    assert 0.3 < overlap < 1.8
    (notice,) = run.findings
    assert notice.code == "driven_together"
    assert f"overlap by {overlap:.2g} m" in notice.sentence


@pytest.mark.slow
def test_a_touch_that_was_ahead_and_slow_is_looked_for_again_after_another_impact() -> None:
    """Of three cars in line: the first would touch the second again at below 1 m/s, but the second
    is stopped by the third before that, and is struck at 6 m/s.
    """
    crash = Scene(
        movers={
            "A": braked(2359.0, -4.88, 0.37, 18.8),
            "B": braked(1497.0, 0.0, 0.49),
            "C": braked(1950.0, 6.4, 0.49),
        },
        contacts=[Contact("A", "B", **DRIVEN), Contact("B", "C", **DRIVEN)],
    )
    for restitution in (0.03, 0.04, 0.05, 0.06):
        changes = {f"contacts[{i}].restitution": restitution for i in range(2)}
        run = crash.replace(changes).run()
        assert [(hit.a.before.name, hit.b.before.name) for hit in run.impacts[:3]] == [
            ("A", "B"), ("B", "C"), ("A", "B"),
        ]  # fmt: skip
        assert run.rest["A"].x < run.rest["B"].x < run.rest["C"].x


@pytest.mark.slow
def test_what_is_said_of_a_scene_is_in_the_units_of_its_vehicles() -> None:
    """Distances and closing speeds of refusals and findings, in feet and mph where these were
    given.
    """
    bodies = {
        "A": col.Vehicle(mass="3300 lb", vx="30 mph", x="-40 ft", y="0 ft", heading="0 deg"),
        "B": col.Vehicle(mass="2800 lb", vx="0 mph", x="0 ft", y="0 ft", heading="0 deg"),
    }
    movers = {
        name: Mover(body, outline=("15 ft", "6 ft"), drag=0.7) for name, body in bodies.items()
    }
    (notice,) = Scene(movers=movers, contacts=[]).run().findings
    assert "closing by 19.4 mph, and no contact" in notice.sentence
    far = movers | {
        "B": Mover(bodies["B"].replace(x="150 ft"), outline=("15 ft", "6 ft"), drag=0.7)
    }
    with pytest.raises(col.NoSolutionError, match=r"are 13\d ft apart at their closest"):
        Scene(movers=far, contacts=[Contact("A", "B", **IN_LINE)]).run()


@pytest.mark.slow
def test_findings_of_a_scene_follow_the_units_that_are_asked_for() -> None:
    """In every place that has them; the finding itself stays in those of its vehicles."""
    lorry = col.Vehicle(mass=2e4, yaw_inertia=9e4, x=-12.0, y=0.4, heading=0.0, vx=15.0)
    struck = col.Vehicle(mass=1200.0, yaw_inertia=1900.0, x=0.0, y=0.0, heading=1.57)
    parked = struck.replace(y=-4.0, x=6.0)
    movers = {
        "Lorry": Mover(lorry, outline=(12.0, 2.5), drag=0.4),
        "Car": Mover(struck, outline=(4.5, 1.8), drag=0.7),
        "Parked": Mover(parked, outline=(4.5, 1.8), drag=0.7),
    }
    hit = Contact("Lorry", "Car", restitution=0.2, friction=0.4, at="touch")
    run = Scene(movers=movers, contacts=[hit]).run()
    numbers = {}
    for notice in run.findings:
        said = re.search(r"(closing|overlap) by ([0-9.]+) ?(m/s|m)\b", notice.sentence)
        if said:
            numbers[notice.sentence[: said.end(1)]] = float(said[2]), said[3]
    assert {kind for _, kind in numbers.values()} == {"m", "m/s"}
    known = {
        "si": {"m": ("m", 1.0), "m/s": ("m/s", 1.0)},
        "metric": {"m": ("m", 1.0), "m/s": ("km/h", 3.6)},
        "us": {"m": ("ft", 1.0 / 0.3048), "m/s": ("mph", 1.0 / 0.44704)},
    }
    for units, kinds in known.items():
        pages = (
            " ".join(run.summary(units).notes),
            " ".join(one.sentence for one in col.diagnose(run, units=units)),
            str(col.report(run, units=units, form="markdown")).split("```json")[0],
            str(col.play(run, units=units)),
        )
        for page in pages:
            for begin, (value, kind) in numbers.items():
                unit, scale = kinds[kind]
                shown = re.search(rf"{re.escape(begin)} by ([0-9.]+)[ \u202f\u00a0]?{unit}\b", page)
                assert shown, (units, begin)
                # Both are rounded, a depth to two figures.
                assert float(shown[1]) == pytest.approx(value * scale, rel=0.06)


def sliding(vx: float, slope: Any = 0.0, **slowed: Any) -> Scene:
    body = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=0.0, y=0.0, heading=0.0, vx=vx, vy=0.0)
    return Scene(movers={"A": Mover(body, **slowed)}, contacts=[], slope=(slope, 0.0))


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"slope": -0.4, "drag": 0.3}, "the slope falls by 0.4 along its way, and its drag is 0.3"),
        ({"drag": 0.0}, "a drag of 0 slows nothing"),
        ({"tyres": Tyres(0.7, 0.0, 2.7, 1.5)}, "its wheels roll freely straight on"),
        ({}, r"nothing slows it; give it tyres=, or drag="),
    ],
)
def test_without_a_place_of_rest_it_says_why(given: dict[str, Any], says: str) -> None:
    with pytest.raises(col.MissingInputError, match=f"A has no place of rest, as {says}") as caught:
        _ = sliding(10.0, **given).run().rest["A"]
    assert caught.value.code == "missing_drag"


def test_wheels_that_do_not_hold_on_a_slope_are_said_to_be_too_weak_for_it() -> None:
    """And are not told to take the lock that they have."""
    for speed in (-3.0, 0.0, 3.0):
        with pytest.raises(col.NoSolutionError, match=r"the slope of 0.15 is too steep") as caught:
            sliding(speed, 0.15, tyres=Tyres(0.7, 0.02, 2.7, 1.5)).run()
        assert "0.02" not in str(caught.value)


def test_what_slides_up_a_slope_does_not_rest_where_its_drag_cannot_hold_it() -> None:
    """At a drag of 0.3 it would slide back from where it stops on 40 %, as wheels would."""
    with pytest.raises(col.NoSolutionError, match="A stops on a slope that is too steep") as caught:
        sliding(10.0, 0.4, drag=0.3).run()
    assert caught.value.code == "never_stops"
    # Where it is struck before that, nothing is wrong with the impact.
    scene = sliding(10.0, 0.4, drag=0.3)
    wall = Mover(col.Vehicle(mass=math.inf, x=5.0, y=0.0, heading=0.0, vx=0.0, vy=0.0))
    central = {"restitution": 0.0, "normal": 0.0, "model": "linear_central"}
    crash = Scene(
        movers={**scene.movers, "wall": wall},
        contacts=[Contact("A", "wall", at=0.2, **central)],
        slope=(0.4, 0.0),
    )
    model = crash.as_model(["A.vx"], ["impacts[0].a.delta_v"])
    assert model(**{"A.vx": 10.0})["impacts[0].a.delta_v"].magnitude > 8.0
    slopes = np.array([0.4, 0.2])
    with pytest.warns(col.CollisionsWarning, match="1 of 2 cases .*1 never_stops"):
        run = sliding(10.0, slopes, drag=0.3).run()
    # Level gravity less the part across the road, along the road, in plan.
    angle = math.atan(0.2)
    way = 100.0 / (2.0 * GRAVITY * math.cos(angle) * (0.3 + 0.2))
    assert run.rest["A"].x == pytest.approx([math.nan, way * math.cos(angle)], nan_ok=True)


def test_each_part_of_a_mapping_or_a_tuple_with_a_unit_is_a_quantity() -> None:
    run = two(drag=0.5).run()
    energy = run.q.energy
    assert [*energy] == ["before", "contacts", "ground", "left"]
    in_kilojoules = {
        name: [part.m_as("kJ") for part in (taken if isinstance(taken, tuple) else (taken,))]
        for name, taken in energy.items()
    }
    # Its drag slows A over the 2 m to the touch. Of the kinetic energy left, the share of the mass
    # of B would be lost to a contact without restitution.
    braked = 1500.0 * 0.5 * GRAVITY * 2.0
    lost = (75000.0 - braked) * 0.4 * (1.0 - 0.2**2)
    assert in_kilojoules["before"] == [75.0]
    assert in_kilojoules["contacts"] == pytest.approx([lost / 1000.0], rel=1e-6)
    assert in_kilojoules["ground"] == pytest.approx([75.0 - lost / 1000.0], rel=1e-6)
    assert in_kilojoules["left"] == [0.0]
    with pytest.raises(TypeError):
        energy["before"] = 0.0
    ((before, _),) = run.q.momentum
    assert before[0].m_as("kN*s") == pytest.approx(1.5 * math.sqrt(2.0 * (75000.0 - braked) / 1500))
    assert [time.m_as("ms") for time in run.q.times] == [1000.0 * time for time in run.times]
    assert run.scene.movers["A"].q.reach.m_as("cm") == pytest.approx(50.0 * math.hypot(*OUTLINE))
    wheels = Tyres(0.7, (0.1, 0.2, 0.3, 0.4), 2.6, 1.5).q
    assert [one.m_as("percent") for one in wheels.locks] == pytest.approx([10, 20, 30, 40])


@pytest.mark.slow
def test_an_impact_that_gains_energy_is_said_wherever_the_run_is_shown() -> None:
    """By a ratio of impulses that no friction gives; the status of the run is that it was run."""
    bodies = {
        "A": {"mass": 1500.0, "yaw_inertia": 2400.0, "x": -2.0, "y": 0.4, "heading": 0.0,
              "vx": np.array([10.0, 12.0])},
        "B": {"mass": 1200.0, "yaw_inertia": 1700.0, "x": 0.8, "y": -1.2, "heading": "90 deg",
              "vy": "40 km/h"},
    }  # fmt: skip
    movers = {name: Mover(col.Vehicle(**body)) for name, body in bodies.items()}
    rule: dict[str, Any] = {"restitution": 0.1, "normal": 0.0, "point": (0.0, 0.0), "at": 0.0}
    contact = Contact("A", "B", impulse_ratio=2.5, **rule)
    with pytest.warns(col.EnergyGainWarning):
        batch = Scene(movers=movers, contacts=[contact]).run()
    assert batch.to_columns()["impacts[0].status"] == ["energy_gain", "energy_gain"]
    with pytest.warns(col.EnergyGainWarning):
        single = batch.case(0)
    assert single.to_columns()["impacts[0].status"] == ["energy_gain"]
    (found,) = [one for one in single.findings if one.code == "energy_gain"]
    assert found.sentence.startswith("the impact of A and B at 0 s ends with more energy than it")
    assert "ends with more energy than it began with" in str(single.summary())
    assert "ends with more energy than it began with" in col.play(single)
    assert [one.code for one in col.diagnose(single)].count("energy_gain") == 1
    text = col.report(single, form="markdown")
    assert text.index("Energy gain of") < text.index("## Answer")
    assert "ends with more energy than it began with" in str(single.impacts[0].summary())
    good = two().run()
    assert good.to_columns()["impacts[0].status"] == ["ok"]
    assert not [one for one in good.findings if one.code == "energy_gain"]


@pytest.mark.slow
def test_the_status_of_an_impact_is_empty_in_cases_without_it() -> None:
    """B is reached in the second case alone."""
    rule: dict[str, Any] = {"restitution": 0.1, "friction": 0.5, "at": "touch"}
    movers = {
        name: car(1500.0, vx, x, yaw_inertia=2400.0, drag=0.7)
        for name, vx, x in (("A", np.array([5.0, 15.0]), 0.0), ("B", 0.0, 8.0))
    }
    with pytest.warns(col.CollisionsWarning, match="1 contact_missing"):
        batch = Scene(movers=movers, contacts=[Contact("A", "B", **rule)]).run()
    columns = batch.to_columns()
    assert columns["status"] == ["contact_missing", "ok"]
    assert columns["impacts[0].status"] == ["", "ok"]


@pytest.mark.slow
def test_a_blow_drives_two_together_that_close_already() -> None:
    """C brakes harder than B, which has struck it and is pushed on into it, when C strikes D: that
    is a blow for B too.
    """
    movers = {
        name: car(mass, vx, x, drag=drag)
        for name, mass, vx, x, drag in (
            ("B", 1000.0, 10.0, 0.0, 0.1),
            ("C", 1000.0, 8.0, 5.0, 0.8),
            ("D", 3000.0, 0.0, 13.0, 0.8),
        )
    }
    rules = [Contact(*pair, **{**IN_LINE, "restitution": 0.0}) for pair in ("BC", "CD")]
    run = Scene(movers=movers, contacts=rules).run()
    assert run.pairs[:3] == (("B", "C"), ("C", "D"), ("B", "C"))
    _, second, third, *_ = run.impacts
    assert run.times[1] == run.times[2]
    assert run.at(run.times[1] - 1e-9)["B"].vx - second.a.before.vx > 1.0
    assert third.closing_speed == pytest.approx(third.a.before.vx - second.a.after.vx, rel=1e-12)
