"""Arguments of a scene, its movers and its contacts that are refused, and what the refusal says to
write; and how the three compare, show and pickle.
"""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres

InputError, MissingInputError = col.InputError, col.MissingInputError
ShapeError, UnitsError = col.ShapeError, col.UnitsError

OUTLINE = ("4.5 m", "1.8 m")
WHEELS = Tyres(0.7, 1.0, "2.7 m", "1.5 m")
CAR = col.Vehicle(mass="1500 kg", yaw_inertia=2500, x=0, y=0, heading=0, vx="36 km/h")
PARKED = col.Vehicle(mass=1200, yaw_inertia=2000, x=6, y=0, heading=0)
MOVERS = {"A": Mover(CAR, outline=OUTLINE), "B": Mover(PARKED, outline=OUTLINE)}
AREA = [(0, 0), (9, 0), (9, 9)]
EXACTLY_ONE = "give exactly one of friction=, impulse_ratio=, critical_fraction=; got "
PAIR = "must be a pair of corners, three or more (x, y) in a list, and friction; got "


def contact(*, a: Any = "A", b: Any = "B", **given: Any) -> Contact:
    return Contact(a, b, **{"restitution": 0.1, "friction": 0.5, **given})


def scene(**given: Any) -> Scene:
    return Scene(**{"movers": MOVERS, "contacts": [contact()], **given})


def check(problem: Any, kind: type[Exception], code: str, says: str) -> None:
    assert type(problem) is kind
    assert problem.code == code
    assert says in str(problem)


CONTACT_REFUSALS = [
    # Names.
    ({"a": ""}, InputError, "not_a_text", "a must be the name of a vehicle of the scene, got ''"),
    ({"b": 7}, InputError, "not_a_text", "b must be the name of a vehicle of the scene, got 7"),
    ({"b": "A"}, InputError, "bad_combination", "a and b are both 'A'"),
    (
        {"a": np.array([1, 2]), "tyres_after": {"B": WHEELS}},
        InputError,
        "not_a_text",
        "a must be the name of a vehicle of the scene, got array([1, 2])",
    ),
    # Options.
    ({"plane": "edge"}, InputError, "bad_option", "plane must be one of face, crossings, got"),
    (
        {"model": ["eccentric"]},
        InputError,
        "bad_option",
        "model must be one of linear_central, oblique_central, eccentric, time_resolved, solve",
    ),
    (
        {"model": "central", "duration": "0.1 s"},
        InputError,
        "bad_option",
        "model must be one of linear_central, oblique_central, eccentric, time_resolved, solve",
    ),
    (
        {"law": None},
        InputError,
        "bad_option",
        "law must be one of brach, kudlich-slibar, stronge, got None",
    ),
    ({"incomplete": 1}, InputError, "bad_option", "incomplete must be True or False, got 1"),
    (
        {"model": "time_resolved"},
        MissingInputError,
        "one_stiffness",
        "model 'time_resolved' needs duration=, such as '100 ms'",
    ),
    (
        {"friction": None, "impulse_ratio": 0.3, "duration": 0.1},
        InputError,
        "bad_combination",
        "model 'time_resolved' works with friction= alone, got impulse_ratio=",
    ),
    (
        {"duration": 0.1, "law": "stronge"},
        InputError,
        "bad_combination",
        "model 'time_resolved' has a law of its own; leave law out",
    ),
    (
        {"duration": 0.1, "incomplete": True},
        InputError,
        "bad_combination",
        "model 'time_resolved' follows a contact to its end; leave incomplete out",
    ),
    # Times and lengths.
    ({"at": "soon"}, InputError, "bad_option", "such as '0.8 s', or 'touch', got 'soon'"),
    ({"at": "-1 s"}, InputError, "negative_time", "at must be >= 0, got '-1 s'; a scene starts"),
    ({"at": [0, 1]}, ShapeError, "bad_shape", "at is a list, and takes one value; many cases go"),
    (
        {"at": "touch", "depth": -0.1},
        InputError,
        "negative_length",
        "depth must be >= 0, got -0.1; it is the overlap along the normal",
    ),
    (
        {"at": "touch", "delay": "-30 ms"},
        InputError,
        "negative_duration",
        "delay must be >= 0, got '-30 ms'; it is counted from first touch",
    ),
    (
        {"model": "solve", "tolerance": -1},
        InputError,
        "negative_speed",
        "tolerance must be >= 0, got -1; it bounds an error",
    ),
    (
        {"model": "eccentric", "duration": "-0.1 s"},
        InputError,
        "negative_duration",
        "duration must be >= 0, got '-0.1 s'",
    ),
    # Tyres after the contact.
    (
        {"tyres_after": [WHEELS]},
        InputError,
        "bad_shape",
        "tyres_after must be a dict from names to Tyres, such as {'A': Tyres(...)}, got [Tyres(",
    ),
    (
        {"tyres_after": {"C": WHEELS}},
        InputError,
        "unknown_name",
        "tyres_after names 'C', and this contact is between 'A' and 'B'",
    ),
    (
        {"tyres_after": {"A": 0.7}},
        InputError,
        "not_tyres",
        "tyres_after['A'] must be Tyres, got float; write collisions.travel.Tyres(friction, lock,",
    ),
    # What does not go together.
    ({"friction": None}, InputError, "one_tangential", EXACTLY_ONE + "none."),
    (
        {"impulse_ratio": 0.2},
        InputError,
        "one_tangential",
        EXACTLY_ONE + "friction= and impulse_ratio=.",
    ),
    (
        {"model": "linear_central"},
        InputError,
        "bad_combination",
        "model 'linear_central' has no friction; leave it out, or use another",
    ),
    (
        {"model": "linear_central", "friction": None, "law": "stronge"},
        InputError,
        "bad_combination",
        "model 'linear_central' has no law; leave law out, or use another",
    ),
    (
        {"model": "oblique_central", "normal": 0, "point": (1, 0)},
        InputError,
        "bad_combination",
        "model 'oblique_central' has no point; leave point out, or use eccentric",
    ),
    (
        {"point": (1, 0)},
        MissingInputError,
        "missing_normal",
        "point is given without normal; give both, or neither where they come from the outlines",
    ),
    (
        {"at": "touch", "depth": 0.1, "delay": 0.02},
        InputError,
        "bad_combination",
        "give depth= or delay=, not both",
    ),
    (
        {"depth": 0.1},
        InputError,
        "bad_combination",
        "depth is counted from first touch; write at='touch' with it",
    ),
    (
        {"at": "touch", "delay": 0.02, "normal": 0, "point": (1, 0)},
        InputError,
        "bad_combination",
        "normal and point are given, so the impulse acts at first touch; leave delay out",
    ),
    (
        {"at": "touch", "depth": 0.1, "normal": 0, "model": "oblique_central"},
        InputError,
        "bad_combination",
        "normal is given, and the model has no point, so the impulse acts at first touch; leave",
    ),
    (
        {"plane": "crossings", "normal": 0},
        InputError,
        "bad_combination",
        "plane says how the normal comes from the outlines; leave it or normal out",
    ),
    ({"tolerance": 0.5}, InputError, "bad_combination", "tolerance is for model='solve'"),
    (
        {"duration": 0.1, "model": "oblique_central"},
        InputError,
        "bad_combination",
        "model 'oblique_central' takes no time; leave duration out, or use eccentric",
    ),
    (
        {"friction": None, "critical_fraction": 1, "law": "stronge"},
        InputError,
        "bad_combination",
        "law 'stronge' works with friction= alone, got critical_fraction=",
    ),
]


@pytest.mark.parametrize(("given", "kind", "code", "says"), CONTACT_REFUSALS)
def test_a_contact_refuses_with_what_to_write(
    given: dict[str, Any], kind: type[Exception], code: str, says: str
) -> None:
    with pytest.raises(col.CollisionsError) as refused:
        contact(**given)
    # One thing is wrong, and one thing is said.
    assert "problems" not in refused.value.fields
    check(refused.value, kind, code, says)


def test_a_name_that_is_a_list_in_itself_is_refused_like_any_other() -> None:
    deep: list[Any] = []
    for _ in range(5000):
        deep = [deep]
    with pytest.raises(col.InputError, match="a must be the name of a vehicle of the scene"):
        contact(a=deep, tyres_after={"A": WHEELS})


def test_a_contact_with_two_rules_and_a_law_of_one_names_the_other() -> None:
    with pytest.raises(InputError) as refused:
        contact(law="stronge", impulse_ratio=0.2)
    one, other = refused.value.fields["problems"]
    check(one, InputError, "one_tangential", EXACTLY_ONE + "friction= and impulse_ratio=.")
    says = "law 'stronge' works with friction= alone, got impulse_ratio="
    check(other, InputError, "bad_combination", says)
    assert other.fields["argument"] == "impulse_ratio"


@pytest.mark.parametrize(
    ("given", "kind", "code", "says"),
    [
        (
            {"vehicle": 1500},
            InputError,
            "not_a_vehicle",
            "vehicle must be a Vehicle, got int; write collisions.Vehicle(mass=...)",
        ),
        (
            {"vehicle": col.Vehicle(mass=1500, yaw_inertia=2500, x=0, y=0, pivot=(1, 0))},
            InputError,
            "pinned",
            "write vehicle.replace(pivot=None), or solve its impact by eccentric",
        ),
        (
            {"outline": ("12 km", "2 m")},
            InputError,
            "bad_outline",
            "outline is 1.2e+04 m long and 2 m wide, and may be from 0.01 to 10000 m; give metres",
        ),
        (
            {"outline": ("4.5 m", "1.8 mm")},
            InputError,
            "bad_outline",
            "outline is 4.5 m long and 0.0018 m wide, and may be from 0.01 to 10000 m",
        ),
        ({"outline": 4.5}, ShapeError, "bad_shape", "outline must be (length, width), (length,"),
        (
            {"tyres": 0.7},
            InputError,
            "not_tyres",
            "tyres must be Tyres, got float; write collisions.travel.Tyres(friction, lock,",
        ),
        (
            {"tyres": WHEELS, "drag": 0.7},
            InputError,
            "bad_combination",
            "give tyres= or drag=, not both: each says what slows the vehicle",
        ),
        ({"drag": -0.3}, InputError, "negative_drag", "drag must be >= 0, got -0.3"),
        ({"drag": "wet"}, UnitsError, "bad_units", "write 0.7, '70 %', '6.9 m/s**2'"),
    ],
)
def test_a_mover_refuses_with_what_to_write(
    given: dict[str, Any], kind: type[Exception], code: str, says: str
) -> None:
    with pytest.raises(col.CollisionsError) as refused:
        Mover(**{"vehicle": CAR, **given})
    assert "problems" not in refused.value.fields
    check(refused.value, kind, code, says)


BARE = Mover(PARKED)
SCENE_REFUSALS = [
    (
        {"movers": list(MOVERS.values())},
        InputError,
        "bad_shape",
        "movers must be a dict from names to Movers, such as {'Camry': Mover(camry)}, got [Mover(",
    ),
    ({"movers": {}}, InputError, "bad_shape", "such as {'Camry': Mover(camry)}, got {}"),
    (
        {"movers": {**MOVERS, 3: BARE}},
        InputError,
        "bad_name",
        "movers has the name 3; names are texts of one line without dots and brackets, and not one",
    ),
    ({"movers": {**MOVERS, "a\nb": BARE}}, InputError, "bad_name", r"movers has the name 'a\nb'"),
    ({"movers": {**MOVERS, " ": BARE}}, InputError, "bad_name", "movers has the name ' '"),
    ({"movers": {**MOVERS, "a.b": BARE}}, InputError, "bad_name", "movers has the name 'a.b'"),
    ({"movers": {**MOVERS, "slope": BARE}}, InputError, "bad_name", "movers has the name 'slope'"),
    (
        {"movers": {**MOVERS, "C": CAR}},
        InputError,
        "not_a_mover",
        "movers['C'] must be a Mover, got Vehicle; write Mover(vehicle, outline=..., tyres=...)",
    ),
    (
        {"movers": {"A": MOVERS["A"], "B": Mover(CAR.replace(vx=np.ones((2, 2))))}},
        ShapeError,
        "bad_shape",
        "have the shape (2, 2), and must have one axis, over the cases, of one or more; give",
    ),
    (
        {"slope": (np.zeros(0), 0)},
        ShapeError,
        "bad_shape",
        "have the shape (0,), and must have one axis, over the cases, of one or more",
    ),
    # Contacts.
    (
        {"contacts": contact()},
        ShapeError,
        "bad_shape",
        "a list of Contacts, such as [Contact('Camry', 'Civic', ...)], got Contact(",
    ),
    (
        {"contacts": [("A", "B")]},
        InputError,
        "not_a_contact",
        "contacts[0] must be a Contact, got tuple; write Contact('Camry', 'Civic', restitution=",
    ),
    (
        {"contacts": [contact(b="C")]},
        InputError,
        "unknown_name",
        "contacts[0] names 'C', and the movers are A, B",
    ),
    (
        {
            "movers": {**MOVERS, "A": MOVERS["A"].replace(drag=0.3)},
            "contacts": [contact(tyres_after={"A": WHEELS})],
        },
        InputError,
        "bad_combination",
        "contacts[0] gives 'A' tyres, which moves by a drag before; give its Mover tyres= too",
    ),
    (
        {"movers": {**MOVERS, "B": BARE}, "contacts": [contact(at="touch")]},
        MissingInputError,
        "missing_outline",
        "'B' has no outline; give outline=(length, width) to its Mover, or a time as at=",
    ),
    (
        {"contacts": [contact(at="touch"), contact(a="B", b="A", at="touch")]},
        InputError,
        "rule_twice",
        "contacts[1] is a second rule at 'touch' for B and A; leave it out",
    ),
    (
        {"contacts": [contact(model="eccentric", duration="0.1 s")]},
        InputError,
        "missing_tyres",
        "neither A nor B has tyres; give tyres= to a Mover, or leave duration out",
    ),
    # Areas.
    ({"surfaces": 0.3}, ShapeError, "bad_shape", f"surfaces[0] {PAIR}0.3"),
    ({"surfaces": [(AREA[:2], 0.3)]}, ShapeError, "bad_shape", f"surfaces[0] {PAIR}([(0, 0), (9,"),
    ({"surfaces": [(AREA, 0.3), AREA]}, ShapeError, "bad_shape", f"surfaces[1] {PAIR}[(0, 0)"),
    (
        {"surfaces": [([*AREA, (np.array([0.0, 1.0]), 9)], 0.3)]},
        ShapeError,
        "bad_shape",
        "surfaces[0] has an array among its corners; they are the same for every case",
    ),
    (
        {"surfaces": [([(3, -9), (23, 9), (23, -9), (3, 9)], 0.2)]},
        InputError,
        "bad_outline",
        "surfaces[0] has sides that cross, from corner 0 to 1 and from 2 to 3; give its corners",
    ),
    (
        {"surfaces": [([(k, k * k) for k in range(1001)], 0.2)]},
        InputError,
        "bad_outline",
        "surfaces[0] has 1001 corners, and an area has at most 1000; leave out those without",
    ),
    # A third and a fourth way through one place; a border that goes around twice.
    (
        {"surfaces": [([(3, -9), (13, 0), (23, 9), (33, -9), (13, 0), (3, 9)], 0.2)]},
        InputError,
        "bad_outline",
        "surfaces[0] has sides that cross at (13, 0) m, from corner 0 to 2 and from 3 to 5; give",
    ),
    (
        {"surfaces": [([(3, -9), (23, 9), (23, -9), (13, 0), (13, 0), (3, 9)], 0.2)]},
        InputError,
        "bad_outline",
        "surfaces[0] has sides that cross at (13, 0) m, from corner 0 to 1 and from 2 to 5; give",
    ),
    (
        {"surfaces": [([(3, -9), (23, -9), (23, 9), (3, 9)] * 2, 0.2)]},
        InputError,
        "bad_outline",
        "surfaces[0] goes twice along one line, from corner 0 to 1 and from 4 to 5; give",
    ),
    (
        {"surfaces": [([(0, 0), (5, 5), (9, 9)], 0.2)]},
        InputError,
        "bad_outline",
        "surfaces[0] encloses no area; give its corners",
    ),
    # Of which no product is a number.
    (
        {"surfaces": [([(1.9e33, 2.5), (5.0, -3.5), (-1e308, 3.1), (0.0, -1.5)], 0.2)]},
        InputError,
        "bad_outline",
        "surfaces[0] encloses no area; give its corners",
    ),
    ({"slope": (0.1,)}, ShapeError, "bad_shape", "slope must be a pair"),
    ({"slope": (1e200, 0.0)}, InputError, "out_of_range", "slope[0] must be between -100 and 100"),
    (
        {"surfaces": [(AREA, -0.3)]},
        InputError,
        "bad_friction",
        "the friction of surfaces[0] must be >= 0, got -0.3; it acts against the sliding whichever",
    ),
    # The order.
    (
        {"order": "AB"},
        ShapeError,
        "bad_shape",
        "order must be a list of pairs of names, such as [('A', 'B')], got 'AB'",
    ),
    ({"order": [("A", "B", "A")]}, ShapeError, "bad_shape", "such as [('A', 'B')], got [('A',"),
    ({"order": [("A", 2)]}, ShapeError, "bad_shape", "such as [('A', 'B')], got [('A', 2)]"),
    (
        {"order": [("A", "B"), ("B", "C")]},
        InputError,
        "unknown_name",
        "order has 'B' and 'C', and no contact is between these two",
    ),
    # Shared inputs.
    (
        {"shared": {"speed": "A.vx"}},
        ShapeError,
        "bad_shape",
        "such as {'ground': ('A.tyres.friction', 'B.tyres.friction')}, got {'speed': 'A.vx'}",
    ),
    ({"shared": [("A.vx",)]}, ShapeError, "bad_shape", "shared must be a dict from new names to"),
    (
        {"shared": {"B": ("A.vx",)}},
        InputError,
        "bad_name",
        "shared has the name 'B', which is taken",
    ),
    (
        {"shared": {"times": ("A.vx",)}},
        InputError,
        "bad_name",
        "shared has the name 'times', which is taken",
    ),
    *(
        (
            {"shared": {path: ("A.vx",)}},
            InputError,
            "bad_name",
            f"shared has the name {path!r}, which is taken; give the numbers that are one and the",
        )
        for path in (
            "A.vx",
            "A.speed",
            "B.rest.x",
            "contacts[0].friction",
            "times[0]",
            "end",
            "end - times[0]",
            "times[0]-contacts[0].impact.time",
            " A.vx",
        )
    ),
]


@pytest.mark.parametrize(("given", "kind", "code", "says"), SCENE_REFUSALS)
def test_a_scene_refuses_with_what_to_write(
    given: dict[str, Any], kind: type[Exception], code: str, says: str
) -> None:
    with pytest.raises(col.CollisionsError) as refused:
        scene(**given)
    assert "problems" not in refused.value.fields
    check(refused.value, kind, code, says)


@pytest.mark.parametrize("tolerance", [1, 1e-11, np.array([1e-5, 1e-4])])
def test_the_tolerance_of_a_run_is_one_small_number(tolerance: Any) -> None:
    says = "tolerance must be one number from 1e-10 to 0.01, got "
    with pytest.raises(col.CollisionsError) as refused:
        scene().run(tolerance=tolerance)
    check(refused.value, InputError, "bad_option", says)
    with pytest.raises(col.CollisionsError) as refused:
        scene().as_model(["A.vx"], ["impacts[0].a.delta_v"], tolerance=tolerance)
    check(refused.value, InputError, "bad_option", says)


def whole() -> Scene:
    """A scene with something in every argument."""
    return Scene(
        movers={
            "A": Mover(CAR, outline=OUTLINE, tyres=WHEELS),
            "B": Mover(PARKED, outline=[(2, 1), (-2, 1), (-2, -1), (2, -1)], drag="50 %"),
            "C": Mover(col.Vehicle(mass=9000, x=60, y=0)),
        },
        contacts=[
            contact(at="touch", tyres_after={"A": WHEELS}),
            contact(a="B", b="C", at="2 s", normal=0, point=("58 m", 0)),
        ],
        surfaces=[(AREA, "30 %")],
        slope=("2 %", 0),
        order=[("A", "B")],
        shared={"speed": ("A.vx",)},
    )


def test_a_pickled_scene_is_equal_and_keeps_the_texts() -> None:
    one = whole()
    two = pickle.loads(pickle.dumps(one))
    assert two == one
    assert repr(two) == repr(one)
    assert two.movers["A"].vehicle.given == {"mass": "1500 kg", "vx": "36 km/h"}
    assert two.to_dict() == one.to_dict()
    assert two.contacts[1].as_given("point") == ("58 m", 0.0)
    assert two.contacts[0] == one.contacts[0]
    assert two.movers["B"] == one.movers["B"]


@pytest.mark.parametrize(
    "other",
    [
        whole().replace({"A.vx": 11}),
        whole().replace({"contacts[0].friction": 0.4}),
        whole().replace({"surfaces[0]": 0.4}),
        whole().replace({"slope[1]": 0.01}),
        scene(),
    ],
)
def test_a_scene_is_another_where_one_number_is(other: Scene) -> None:
    assert whole() != other
    assert whole() != other.to_dict()


def test_a_scene_is_shown_by_its_movers_and_contacts() -> None:
    text = repr(whole())
    assert text.startswith("Scene(movers=A, B, C, contacts[0]=Contact(a='A', b='B', at='touch'")
    assert text.endswith("surfaces=1)")
    assert repr(scene()) == f"Scene(movers=A, B, contacts[0]={contact()!r})"


def test_a_summary_of_a_scene_has_a_row_for_each_mover_and_contact() -> None:
    rows = [line.split() for line in str(whole().summary()).splitlines()]
    assert rows[2:5] == [
        ["A", "1500", "kg", "36.0", "km/h", "0°", "tyres"],
        ["B", "1200", "kg", "0.0", "km/h", "0°", "drag"],
        ["C", "9000", "kg", "0.0", "km/h", "–", "nothing"],
    ]
    assert rows[6:] == [
        ["A", "and", "B", "touch", "eccentric", "0.10"],
        ["B", "and", "C", "2.00", "s", "eccentric", "0.10"],
    ]


def test_a_summary_of_a_mover_has_its_outline_and_what_slows_it() -> None:
    tyred, dragged = whole().movers["A"], whole().movers["B"]
    rows = [line.split() for line in str(tyred.summary()).splitlines()]
    assert ["outline", "4.50", "m", "by", "1.80", "m"] in rows
    assert rows[rows.index(["Tyres"]) + 1] == ["friction", "0.70"]
    rows = [line.split() for line in str(dragged.summary()).splitlines()]
    assert rows[-2:] == [["outline", "4.00", "m", "by", "2.00", "m"], ["drag", "0.50"]]
    assert "outline" not in str(Mover(PARKED, drag=0.5).summary())


def test_a_mover_is_shown_by_what_it_was_given() -> None:
    tyred, dragged = whole().movers["A"], whole().movers["B"]
    assert repr(tyred).endswith(f"tyres={WHEELS!r})")
    assert repr(dragged).endswith("outline=[(2, 1), (-2, 1), (-2, -1), (2, -1)], drag=0.5)")
    assert repr(Mover(PARKED)) == f"Mover(vehicle={PARKED!r})"


def test_a_summary_of_a_contact_has_its_numbers() -> None:
    lines = str(contact(at="touch", depth="10 cm").summary()).splitlines()
    rows = [["Contact"], ["restitution", "0.10"], ["depth", "0.10", "m"], ["friction", "0.50"]]
    assert [line.split() for line in lines] == rows


def test_a_contact_names_its_rule() -> None:
    assert contact().rule == "friction"
    assert contact(friction=None, critical_fraction=1).rule == "critical_fraction"
    assert contact(friction=None, model="linear_central", normal=0).rule is None


def test_a_mover_reaches_to_its_farthest_corner() -> None:
    assert Mover(CAR, outline=[(2, -1.5), (-1, 1), (-2, 0)]).reach == 2.5
    assert Mover(CAR).reach == 0.0


def test_a_case_of_a_batch_is_a_scene_with_its_numbers() -> None:
    speeds = np.array([8.0, 9.0, 10.0])
    batch = whole().replace({"A.vx": speeds})
    assert batch.shape == (3,)
    assert batch.case(1) == whole().replace({"A.vx": 9.0})
    with pytest.raises(col.CollisionsError) as refused:
        batch.case(3)
    says = "one case in a batch of shape (3,), a whole number below 3, got 3; write scene.case(0)"
    check(refused.value, InputError, "bad_index", says)
    with pytest.raises(col.CollisionsError) as refused:
        whole().case(0)
    says = "scene is one case, and case() takes one of a batch; use it as it is"
    check(refused.value, ShapeError, "bad_shape", says)


def test_the_inputs_of_a_scene_are_listed_with_their_units() -> None:
    listed = whole().inputs()
    assert listed["A.vx"] == "m/s"
    assert listed["A.tyres.friction"] == listed["B.drag"] == listed["surfaces[0]"] == ""
    assert listed["contacts[1].at"] == "s"
    assert "C.drag" not in listed


@pytest.mark.parametrize("listed", [[1], [None], [b"A.vx"], [["A.vx"]], np.array([1, 2])])
@pytest.mark.parametrize("argument", ["names", "outputs"])
def test_paths_that_are_no_texts_are_refused(listed: Any, argument: str) -> None:
    given: dict[str, Any] = {"names": ["A.vx"], "outputs": ["end"], argument: listed}
    with pytest.raises(InputError, match=f"{argument} has no .*; near it are") as refused:
        scene().as_model(**given)
    assert (refused.value.code, refused.value.argument) == ("unknown_name", argument)


def test_a_run_is_no_list_of_paths() -> None:
    run = Scene(movers={"A": Mover(CAR, drag=0.7)}, contacts=[]).run()
    for given in ((run, ["end"]), (["A.vx"], run)):
        with pytest.raises(InputError, match="must be a list of paths"):
            scene().as_model(*given)  # type: ignore[arg-type]


def test_paths_of_an_object_that_raises_are_refused() -> None:
    class Broken:
        def __iter__(self) -> Any:
            raise RuntimeError("no")

    for given in ((Broken(), ["end"]), (["A.vx"], Broken())):
        with pytest.raises(InputError, match="must be a list of paths"):
            scene().as_model(*given)


def test_paths_may_come_one_by_one() -> None:
    """Both are asked for again later."""
    moving = Scene(movers={"A": Mover(CAR, drag=0.7)}, contacts=[])
    model = moving.as_model((one for one in ["A.vx"]), (one for one in ["end"]))  # type: ignore[arg-type]
    assert model(**{"A.vx": 7.0})["end"].magnitude > 0.0


@pytest.mark.parametrize("name", [{}, None, 5, "mass", "given", "replace"])
def test_what_is_no_argument_was_not_given(name: Any) -> None:
    for part, known in ((MOVERS["A"], "'outline'"), (contact(), "'restitution'")):
        with pytest.raises(InputError, match="name must be one of") as refused:
            part.as_given(name)
        check(refused.value, InputError, "unknown_name", known)
        assert refused.value.argument == "name"


@pytest.mark.slow
def test_two_that_graze_each_other_for_years_are_given_up() -> None:
    """What turns and nothing slows is struck by a car, which comes to rest beside it: their corners
    touch at every turn, while a drift of 1e-8 m/s parts them.
    """
    turns = Mover(
        col.Vehicle(
            mass=1e12, yaw_inertia=2.6e12, x=0, y=0, heading=0.55, vx=0, vy=0, yaw_rate=-0.473
        ),
        outline=[(0.35, 0.99), (-1.45, 0.75), (-0.84, -0.92), (-0.19, -1.0), (2.15, -0.21)],
    )
    car = Mover(
        col.Vehicle(
            mass=1500, yaw_inertia=2250, x=7.4, y=0.35, heading=math.pi, vx=-6.6, vy=0, yaw_rate=0
        ),
        outline=[(2.18, 0.14), (-1.61, 0.68), (0.73, -0.94)],
        drag=0.5,
    )
    rule = Contact("A", "B", model="solve", restitution=0.17, friction=0.9, at="touch", delay=0.25)
    crash = Scene(movers={"A": turns, "B": car}, contacts=[rule])
    with pytest.raises(col.NoSolutionError, match="again and again") as refused:
        crash.run()
    assert refused.value.code == "never_ends"
    with pytest.warns(col.CollisionsWarning):
        several = crash.replace({"B.vx": [-6.6, -6.61]}).run()
    assert list(several.status) == ["never_ends"] * 2


def test_a_kinetic_energy_beyond_floats_is_refused_or_a_case_without_an_answer() -> None:
    """But not that of a wall that moves, which is infinite."""

    def run(vx: Any, **heavy: Any) -> Any:
        body = col.Vehicle(x=0.0, y=0.0, heading=0.0, vx=vx, **{"mass": 1500.0, **heavy})
        return Scene(movers={"A": Mover(body, drag=0.5)}, contacts=[]).run()

    with pytest.raises(InputError, match="kinetic energy of A is not a finite number") as refused:
        run(1e155)
    assert refused.value.code == "out_of_range"
    with pytest.warns(col.CollisionsWarning, match="1 not_finite"):
        found = run(np.array([10.0, 1e155]))
    assert found.status.tolist() == ["ok", "not_finite"]
    assert run(10.0, mass=math.inf, yaw_inertia=math.inf).status == "ok"
