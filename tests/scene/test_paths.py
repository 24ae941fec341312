"""Paths of a scene that are none, or that ask for what is not there: the nearest is named."""

from __future__ import annotations

import ast
import re
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.reconstruct import fit, posterior
from collisions.scene import Contact, Mover, Scene
from collisions.travel import GRAVITY, Tyres
from collisions.uncertainty import Normal, Uniform, propagate

DAMAGED = Tyres(0.7, [1, 0, 0, 0], 2.78, 1.55)


def crash(**more: Any) -> Scene:
    """A car on tyres strikes a standing one with drag at touch."""
    a = col.Vehicle(mass=1500, yaw_inertia=2600, x=-6.0, y=0.2, heading=0, vx="40 mph")
    b = col.Vehicle(mass=1250, yaw_inertia=1900, x=0.0, y=0.0, heading="80 deg")
    outline = (4.6, 1.8)
    given: dict[str, Any] = {
        "movers": {
            "A": Mover(a, outline=outline, tyres=Tyres(0.7, 0.3, 2.78, 1.55)),
            "B": Mover(b, outline=outline, drag="0.6"),
        },
        "contacts": [
            Contact("A", "B", restitution=0.1, friction=0.5, at="touch", tyres_after={"A": DAMAGED})
        ],
        "surfaces": [([(20, -5), (30, -5), (30, 5), (20, 5)], "0.3")],
    }
    return Scene(**given | more)


def in_line(**more: Any) -> Scene:
    """Two vehicles without a place, which only have speeds."""
    movers = {name: Mover(col.Vehicle(mass=1000, vx=v), **more) for name, v in (("A", 5), ("B", 0))}
    contact = Contact("A", "B", restitution=0.1, normal=0, model="linear_central")
    return Scene(movers=movers, contacts=[contact])


@pytest.mark.parametrize(
    ("path", "near"),
    [
        ("A.tyres.fricton", "A.tyres.friction"),
        ("contacts[00].friction", r"contacts\[0\].friction"),
        (f"contacts[{'9' * 5000}].friction", "near it are|"),
        ("surfaces[\u0660]", r"surfaces\[0\]"),
        ("B.tyres.friction", "A.tyres.friction"),
        ("A.vx.y", "A.vx"),
        ("C.vx", "A.vx"),
        ("surfaces[1]", r"surfaces\[0\]"),
        ("slope[2]", r"slope\[1\], slope\[0\]"),
        ("contacts[0].friction[0]", r"contacts\[0\].friction"),
        ("contacts[0].tyres_after.B.lock", r"contacts\[0\].tyres_after.A.lock"),
        ("contacts[0].tyres_after.A.loc", r"contacts\[0\].tyres_after.A.lock"),
        ("", "A.mass"),
    ],
)
def test_a_path_that_is_none_names_the_nearest(path: str, near: str) -> None:
    with pytest.raises(col.InputError, match=f"scene has no '.*'; near it are .*{near}") as caught:
        crash().replace({path: 1.0})
    assert caught.value.code == "unknown_name"
    assert caught.value.fields["argument"] == "scene"


@pytest.mark.parametrize(
    ("changes", "code", "says"),
    [
        ([("A.vx", 1.0)], "bad_shape", "a dict from paths to numbers"),
        ({1: 2.0}, "bad_shape", r"such as \{'A.*|\{1: 2.0\}"),
        ({"A.speed": 3.0, "A.vy": 1.0}, "speed_twice", "give either speed and course or vx"),
        ({"A.speed": -3.0}, "negative_speed", "A: speed must be >= 0.*turn the course"),
        ({"A.speed": np.array([1.0, -1.0])}, "negative_speed", "in every case; bound what"),
        ({"B.speed": 3.0}, "missing_course", "B stands, so its course is not known"),
        ({"A.speed": "3 m"}, "bad_units", "A: speed: '3 m' cannot be taken as m/s"),
        ({"A.drag": 0.5}, "bad_combination", "A: give tyres= or drag=, not both"),
        ({"B.drag": -1}, "negative_drag", "B: drag must be >= 0"),
        ({"A.mass": None}, "missing_mass", "A: mass is missing"),
        ({"A.tyres.lock[0]": 0.5}, "unknown_name", r"one for all; write lock, or lock=\[...\]"),
        ({"surfaces[0]": -1}, "bad_friction", r"surfaces\[0\] must be >= 0"),
        ({"slope[1]": "steep"}, "bad_units", r"slope\[1\]: cannot read 'steep'"),
        ({"contacts[0].point[0]": 1.0}, "unknown_name", "write point= in the Contact"),
        (
            {"contacts[0].tyres_after.A.lock[0]": 2.0},
            "bad_fraction",
            r"contacts\[0\]: lock\[0\] must be from 0 to 1.*write '2 %'",
        ),
    ],
)
def test_a_number_that_cannot_be_names_its_part_of_the_scene(
    changes: Any, code: str, says: str
) -> None:
    with pytest.raises(col.InputError, match=says) as caught:
        crash().replace(changes)
    assert caught.value.code == code


@pytest.mark.parametrize("paths", [["grip", "A.tyres.friction"], ["A.tyres.friction", "grip"]])
def test_a_number_that_is_changed_twice_names_both_paths(paths: list[str]) -> None:
    scene = crash(
        surfaces=[([(20, -5), (30, -5), (30, 5)], "70 %")],
        shared={"grip": ("A.tyres.friction", "surfaces[0]")},
    )
    with pytest.raises(col.InputError, match=f"by '{paths[0]}' and by '{paths[1]}'") as caught:
        scene.replace(dict.fromkeys(paths, 0.5))
    assert caught.value.code == "bad_combination"
    once = scene.replace({"grip": "50 %"})
    assert once.movers["A"].tyres.friction == once.surfaces[0][1] == 0.5


def test_a_shared_name_needs_paths_that_are_and_of_one_kind() -> None:
    with pytest.raises(col.InputError) as caught:
        crash(shared={"g": ("A.tyres.frction",), "h": ("A.vx", "A.mass")})
    assert [one.code for one in caught.value.fields["problems"]] == [
        "unknown_name",
        "bad_combination",
    ]
    assert "shared['g'] has no 'A.tyres.frction'; near it are A.tyres.friction" in str(caught.value)
    assert "shared['h'] names inputs of several kinds: A.vx [m/s], A.mass [kg]" in str(caught.value)


@pytest.mark.parametrize(
    "second", [("B.tyres.friction", "A.tyres.friction"), ("B.tyres.friction",)]
)
def test_an_input_under_two_shared_names_is_refused_with_the_one_to_write(
    second: tuple[str, ...],
) -> None:
    """A change of either name would leave the other's numbers different."""
    scene = crash()
    movers = {
        name: Mover(mover.vehicle, outline=mover.outline, tyres=Tyres(0.7, 1, 2.7, 1.5))
        for name, mover in scene.movers.items()
    }
    surfaces = [([(20, -5), (30, -5), (30, 5)], 0.7)]
    given = {"movers": movers, "contacts": (), "surfaces": surfaces}
    groups = {"g": ("surfaces[0]", "B.tyres.friction"), "h": second}
    with pytest.raises(col.InputError, match=r"'B.tyres.friction' under 'g' and under 'h'") as told:
        Scene(**given, shared=groups)
    assert (told.value.code, told.value.argument) == ("bad_combination", "shared")
    (written,) = re.findall(r"shared=(\{.*\})", str(told.value))
    merged = ast.literal_eval(written)
    assert set(merged["g"]) == {*groups["g"], *groups["h"]}
    once = Scene(**given, shared=merged).replace({"g": 0.4})
    assert {once.surfaces[0][1], once.movers["B"].tyres.friction} == {0.4}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*two vehicles do not part:collisions.OutOfRangeWarning")
def test_shared_numbers_are_one_number() -> None:
    two = ("A.tyres.friction", "B.drag")
    with pytest.raises(col.InputError) as caught:
        crash(shared={"ground": two})
    assert caught.value.code == "bad_combination"
    assert (
        "shared['ground'] says that A.tyres.friction, B.drag are one and the same number, and these"
        " differ: A.tyres.friction is 0.7, B.drag is 0.6; state the same at each"
    ) in str(caught.value)
    scene = crash().replace({"B.drag": 0.7})
    even = Scene(movers=scene.movers, contacts=scene.contacts, shared={"ground": two})
    # Each of them changes all.
    for path in ("ground", *two):
        moved = even.replace({path: np.array([0.5, 0.6])})
        assert moved == even.replace({"ground": np.array([0.5, 0.6])})
        assert np.array_equal(moved.movers["B"].drag, moved.movers["A"].tyres.friction)
    options = {"outputs": ["A.rest.x"], "samples": 64, "seed": 1}
    first, second = (
        propagate(even, {path: Normal(0.7, 0.01)}, **options)["A.rest.x"].mean
        for path in ("B.drag", "ground")
    )
    assert first == second
    with pytest.raises(col.InputError, match=r"changed twice, by 'B.drag' and by 'ground'"):
        even.replace({"B.drag": 0.5, "ground": 0.5})
    # A speed is kept as vx and vy, which round it.
    moving = crash().replace({"A.speed": 11.1, "A.course": 0.3, "B.vx": 1.0})
    moving = moving.replace({"B.speed": 11.1, "B.course": 2.3})
    twins = Scene(movers=moving.movers, contacts=(), shared={"v": ("A.speed", "B.speed")})
    both = twins.replace({"v": "30 mph"}).movers.values()
    assert [mover.vehicle.speed for mover in both] == pytest.approx([13.4112] * 2)
    assert twins.replace({"B.speed": 12.0}).movers["A"].vehicle.speed == pytest.approx(12.0)


def test_locks_speeds_and_courses_are_replaced_beside_other_numbers() -> None:
    found = crash().replace(
        {
            "contacts[0].tyres_after.A.lock[3]": "50 %",
            "contacts[0].tyres_after.A.friction": 0.6,
            "B.speed": "10 m/s",
            "B.course": "90 deg",
            "B.mass": 1300,
            "slope[0]": 0.02,
        }
    )
    after = found.contacts[0].tyres_after["A"]
    assert after.locks == (1.0, 0.0, 0.0, 0.5)
    assert after.friction == 0.6
    body = found.movers["B"].vehicle
    assert (body.mass, body.vx, body.vy) == (1300.0, pytest.approx(0.0, abs=1e-12), 10.0)
    assert found.slope == (0.02, 0.0)
    with pytest.raises(col.InputError, match="speed and course"):
        crash().replace({"A.course": 0.1, "A.vx": 3.0})


def test_a_case_of_a_batch_has_its_own_number_of_everything() -> None:
    scene = crash().replace(
        {
            "A.vx": np.array([17.0, 18.0]),
            "B.drag": np.array([0.5, 0.6]),
            "A.tyres.friction": np.array([0.7, 0.8]),
            "contacts[0].friction": np.array([0.4, 0.5]),
            "surfaces[0]": np.array([0.3, 0.2]),
            "slope[0]": np.array([0.0, 0.01]),
        }
    )
    one = scene.case(1)
    assert scene.shape == (2,)
    assert one.shape is None
    assert one == scene.case(-1) != scene.case(0)
    assert one.movers["A"].vehicle.vx == 18.0
    assert one.movers["A"].tyres.friction == 0.8
    assert one.movers["B"].drag == 0.6
    assert one.contacts[0].friction == 0.5
    assert one.surfaces[0][1] == 0.2
    assert one.slope == (0.01, 0.0)
    assert one.contacts[0].touches
    for wrong in (2, 1.5, (0, 0)):
        with pytest.raises(col.InputError, match=r"write scene.case\(0\)") as caught:
            scene.case(wrong)
        assert caught.value.code == "bad_index"


def model(scene: Scene, *outputs: Any) -> Any:
    return scene.as_model(["A.vx"], [*outputs])


@pytest.mark.slow
def test_results_are_asked_for_by_their_paths() -> None:
    scene = in_line(drag=0.5)
    found = model(scene, "end", "times[0]", "impacts[0].b.delta_v", "impacts[0].a.after.speed")(
        **{"A.vx": "36 km/h"}
    )
    assert found["times[0]"].m == 0.0
    assert found["impacts[0].b.delta_v"].m_as("m/s") == pytest.approx(5.5)
    assert found["impacts[0].a.after.speed"].m_as("m/s") == pytest.approx(4.5)
    assert found["end"].m_as("s") == pytest.approx(5.5 / (0.5 * GRAVITY))


@pytest.mark.parametrize(
    ("path", "near"),
    [
        ("impacts[0].a.delta_w", r"impacts\[0\].a.delta_v"),
        ("impacts[00].a.delta_v", r"impacts\[0\].a.delta_v"),
        ("impacts[\u0660].a.delta_v", r"impacts\[0\].a.delta_v"),
        ("impacts[99999999999].a.delta_v", r"impacts\[0\].a.delta_v"),
        (f"impacts[{'9' * 5000}].a.delta_v", "A"),
        (f"times[{'9' * 5000}]", "A"),
        ("B.rest.z", "B.rest"),
        ("C.rest.x", ".rest.x"),
        (3, "A.rest.x"),
    ],
)
def test_a_result_that_is_none_names_the_nearest(path: Any, near: str) -> None:
    with pytest.raises(col.InputError, match=f"outputs has no .*near it are .*{near}") as caught:
        model(in_line(), path)
    assert caught.value.code == "unknown_name"
    with pytest.raises(col.InputError, match=r"near it are A\.v"):
        in_line().as_model(["A.vq"], ["end"])


@pytest.mark.parametrize("share", ["0_1", "\u0660.\u0664", "0,4", "nan", "1e999", "1.5", "x"])
def test_a_share_of_the_energy_is_read_as_any_number_is(share: str) -> None:
    path = f"contacts[0].impact.B.ees({share})"
    with pytest.raises(col.InputError, match=re.escape(path) + ": share"):
        model(in_line(), path)
    both = [f"contacts[0].impact.B.ees({one})" for one in ("0.4", "40 %")]
    one, other = model(in_line(), *both)(**{"A.vx": 5.0}).values()
    assert one == other


def test_anything_may_stand_where_a_path_is_wanted() -> None:
    """What cannot be written is named by its kind."""

    class Mute:
        def __repr__(self) -> str:
            raise RuntimeError("no")

    for path in (Mute(), 10**5000, ["A.vx", Mute()]):
        with pytest.raises(col.InputError, match=r"has no a (Mute|int|list); near it are"):
            in_line().as_model([path], ["end"])


@pytest.mark.parametrize(
    ("path", "code", "says"),
    [
        ("times[4]", "unknown_name", r"times\[4\]: this scene has 1 impact, counted from 0"),
        ("impacts[4].energy_loss", "unknown_name", "this scene has 1 impact"),
        ("A.rest.x", "missing_input", "A.rest.x has no value.*such as a heading, a position"),
        ("impacts[0].a.after.x", "missing_input", "has no value"),
    ],
)
def test_a_result_that_a_run_does_not_have_says_why(path: str, code: str, says: str) -> None:
    ask = model(in_line(drag=0.5), path)
    with pytest.raises(col.CollisionsError, match=says) as caught:
        ask(**{"A.vx": 5.0})
    assert caught.value.code == code
    with pytest.raises(col.MissingInputError, match="nothing slows it") as lacks:
        model(in_line(), "A.rest.x")(**{"A.vx": 5.0})
    assert lacks.value.code == "missing_drag"


def test_columns_leave_out_what_has_no_value_and_name_their_units() -> None:
    run = in_line(drag=0.5).run()
    columns = run.to_columns(units="us")
    assert columns["impacts[0].b.delta_v [mph]"] == pytest.approx([2.75 / 0.44704])
    assert columns["status"] == ["ok"]
    assert not any(name.startswith("A.rest.x") for name in columns)
    with pytest.raises(col.InputError, match="units must be 'si', 'metric' or 'us', got 'uk'"):
        run.to_columns(units="uk")


def test_a_batch_has_nan_for_an_impact_that_a_case_does_not_have() -> None:
    scene = in_line(drag=0.5).replace({"A.vx": np.array([5.0, -5.0])})
    with pytest.warns(col.CollisionsWarning, match="1 of 2 cases"):
        run = scene.run()
    columns = run.to_columns()
    assert columns["impacts[0].b.delta_v"][0] == pytest.approx(2.75)
    assert np.isnan(columns["impacts[0].b.delta_v"][1])
    assert run.status.tolist()[0] == "ok"
    assert np.isnan(run.impacts[0].b.delta_v).tolist() == [False, True]


def crossing(**options: Any) -> Scene:
    """Two cars, of which the second was given no speed."""
    one = col.Vehicle(mass=1500, yaw_inertia=2500, vx="50 km/h", x=0, y=0, heading=0)
    other = col.Vehicle(mass=1500, yaw_inertia=2500, x="4 m", y=0, heading=0)
    return Scene(
        movers={"Explorer": Mover(one, drag=0.6), "Jetta": Mover(other, drag=0.6)},
        contacts=[
            Contact("Explorer", "Jetta", restitution=0.1, friction=0.5, normal=0, point=(2, 0))
        ],
        **options,
    )


def test_the_speed_of_what_stands_says_how_to_build_it() -> None:
    said = r"has no 'Jetta.speed'; Jetta stands.*Vehicle.from_speed\(speed=\.\.\., course=\.\.\.\)"
    with pytest.raises(col.InputError, match=rf"shared\['speed'\] {said}"):
        crossing(shared={"speed": ("Jetta.speed",)})
    with pytest.raises(col.InputError, match=r"Vehicle.from_speed\(speed=\.\.\., course=\.\.\.\)"):
        crossing().replace({"Jetta.speed": 5.0})


@pytest.mark.parametrize(
    ("path", "instead"),
    [
        ("Explorer.delta_v", "write 'contacts[0].impact.Explorer.delta_v'"),
        ("Jetta.after.speed", "write 'contacts[0].impact.Jetta.after.speed'"),
        ("Jetta.delta_v_right", "write 'contacts[0].impact.Jetta.delta_v_left' with the opposite"),
        ("contacts[0].b.delta_v", "write 'contacts[0].impact.Jetta.delta_v'"),
        ("contacts[0].Jetta.delta_v", "write 'contacts[0].impact.Jetta.delta_v'"),
        ("contacts[0].impact.b.delta_v", "write 'contacts[0].impact.Jetta.delta_v'"),
        ("impacts[0].Jetta.delta_v", "write 'contacts[0].impact.Jetta.delta_v'"),
        ("contacts[0].energy_loss", "write 'contacts[0].impact.energy_loss'"),
        ("Jetta.ees", "write 'contacts[0].impact.Jetta.ees(0.5)', with the share"),
        ("impacts[0].a.delta_v_right", "write 'impacts[0].a.delta_v_left' with the opposite sign"),
    ],
)
def test_a_result_by_another_name_is_pointed_to(path: str, instead: str) -> None:
    unknowns = {"Explorer.speed": Uniform("20 km/h", "90 km/h")}
    with pytest.raises(col.InputError) as caught:
        posterior(crossing(), unknowns, {path: ("3 m/s", "1 m/s")})
    assert str(caught.value).startswith(f"observed has no {path!r}; {instead}")
    assert caught.value.argument == "observed"
    with pytest.raises(col.InputError) as caught:
        propagate(crossing(), unknowns, outputs=[path])
    assert str(caught.value).startswith(f"outputs has no {path!r}; {instead}")
    assert caught.value.argument == "outputs"


def test_what_is_stated_of_an_input_has_its_kind() -> None:
    crash, seen = crossing(), {"Jetta.rest.x": ("9 m", "1 m")}
    wrong = Uniform("5 ft", "50 ft")
    for call in (
        lambda: posterior(crash, {"Explorer.vx": wrong}, seen),
        lambda: fit(crash, {"Explorer.vx": wrong}, seen),
        lambda: fit(crash, {"Explorer.vx": "20 ft"}, seen),
        lambda: propagate(crash, {"Explorer.vx": wrong}, outputs=["Jetta.rest.x"]),
        lambda: propagate(crash, {"Explorer.vx": "20 ft"}, outputs=["Jetta.rest.x"]),
    ):
        with pytest.raises(col.UnitsError, match=r"\['Explorer.vx'\] is stated in ft.*'80 km/h'"):
            call()
    slowed = {"Jetta.drag": Uniform("5 m/s**2", "7 m/s**2")}
    with pytest.raises(col.UnitsError, match=r"Jetta\.drag is a plain number"):
        propagate(crash, slowed, outputs=["Jetta.rest.x"])
    with col.options(require_units=True):
        for bare in (Uniform(5, 30), Normal(20, 2)):
            with pytest.raises(col.UnitsError, match="require_units=True"):
                posterior(crash, {"Explorer.vx": bare}, seen)


@pytest.mark.slow
def test_a_bare_prior_has_the_unit_of_its_input() -> None:
    found = posterior(
        crossing(),
        {"Explorer.vx": Uniform(5, 30), "Jetta.drag": Normal(0.6, 0.05)},
        {"Jetta.rest.x": ("9 m", "1 m")},
        samples=512,
        seed=1,
    )
    assert (found["Explorer.vx"].unit, found["Jetta.drag"].unit) == ("m/s", None)
    assert "67.11 mph, all values equally likely" in str(found.summary("us"))
    assert found["Explorer.vx"].mean == pytest.approx(found.inputs()["Explorer.vx"].mean)


@pytest.mark.slow
def test_what_stands_is_said_where_its_motion_is_asked_for() -> None:
    """And of no parked car, whose motion nobody asks for."""
    asked = "contacts[0].impact.Jetta.before.speed"
    said = "Jetta stands at the start: no speed above 0 was given for it"

    def statements(crash: Scene, result: str, *names: str) -> str:
        unknowns = {name: Uniform("5 m/s", "30 m/s") for name in names}
        return " ".join(propagate(crash, unknowns, outputs=[result], samples=64).statements)

    assert said in statements(crossing(), asked, "Explorer.vx")
    assert said in statements(crossing(), "impacts[0].b.before.vy", "Explorer.vx")
    for parked in ("Jetta.rest.x", "contacts[0].impact.Explorer.before.speed"):
        assert "stands" not in statements(crossing(), parked, "Explorer.vx")
    assert "stands" not in statements(crossing().replace({"Jetta.vy": 1.0}), asked, "Explorer.vx")
    assert "stands" not in statements(crossing(), asked, "Explorer.vx", "Jetta.vy")
    both = crossing(shared={"speed": ("Jetta.vy",)})
    assert "stands" not in statements(both, asked, "Explorer.vx", "speed")
    seen = {"Jetta.rest.x": ("9 m", "1 m"), asked: ("0 m/s", "1 m/s")}
    unknowns = {"Explorer.vx": Uniform("5 m/s", "30 m/s")}
    assert said in " ".join(posterior(crossing(), unknowns, seen, samples=512).statements)


@pytest.mark.parametrize("speed", [Uniform("0 m/s", "10 m/s"), Uniform(0.0, 10.0)])
def test_the_speed_of_what_stands_is_refused_as_an_unknown_whatever_its_unit(speed: Any) -> None:
    crash, seen = crossing(), {"Jetta.rest.x": ("9 m", "1 m")}
    for call in (
        lambda: posterior(crash, {"Jetta.speed": speed}, seen),
        lambda: propagate(crash, {"Jetta.speed": speed}, outputs=["Jetta.rest.x"], samples=64),
        lambda: fit(crash, {"Jetta.speed": "3 m/s" if speed.unit else 3.0}, seen),
        lambda: crash.required({"Jetta.rest.x": "1 m"}, {"Jetta.speed": speed}),
        lambda: crash.as_model(["Jetta.speed"], ["Jetta.rest.x"]),
    ):
        with pytest.raises(col.InputError, match=r"write 'Jetta\.vx' and 'Jetta\.vy'") as caught:
            call()
        assert caught.value.code == "missing_course"
    both = {"Jetta.speed": speed, "Jetta.course": Uniform("80 deg", "100 deg")}
    found = propagate(crash, both, outputs=["Jetta.rest.y"], samples=64, seed=1)
    assert found["Jetta.rest.y"].mean > 1.0
    with pytest.raises(col.UnitsError, match=r"Jetta.speed is of another kind"):
        propagate(crash, both | {"Jetta.speed": Uniform("1 m", "2 m")}, outputs=["Jetta.rest.y"])


@pytest.mark.slow
def test_a_number_that_is_not_given_yet_has_the_unit_of_what_it_is() -> None:
    """The height of tyres moves the load to the front wheels; without it there is none."""
    car = col.Vehicle(mass=1500, yaw_inertia=2600, x=0, y=0, heading=0.3, vx=15)
    lone = Scene(movers={"A": Mover(car, tyres=Tyres(0.7, [1, 1, 0, 0], 2.7, 1.5))}, contacts=[])
    given: dict[str, Any] = {"outputs": ["A.rest.x"], "samples": 64, "seed": 1}
    stated = propagate(lone, {"A.tyres.height": Uniform("0.3 m", "0.8 m")}, **given)
    bare = propagate(lone, {"A.tyres.height": Uniform(0.3, 0.8)}, **given)
    assert stated["A.rest.x"].mean == bare["A.rest.x"].mean
    model = lone.as_model(["A.tyres.height"], ["A.rest.x"])
    tyres = Tyres(0.7, [1, 1, 0, 0], 2.7, 1.5, height=0.5)
    alone = Scene(movers={"A": Mover(car, tyres=tyres)}, contacts=[]).run().rest["A"].x
    assert model(**{"A.tyres.height": "50 cm"})["A.rest.x"].m == alone
    assert abs(alone - lone.run().rest["A"].x) > 0.1
    with pytest.raises(col.UnitsError, match=r"A.tyres.height.* is of another kind"):
        propagate(lone, {"A.tyres.height": Uniform("1 s", "2 s")}, **given)
    with pytest.raises(col.UnitsError, match=r"contacts\[0\].duration.* is of another kind"):
        propagate(crash(), {"contacts[0].duration": Uniform("1 m", "2 m")}, **given)
    found = lone.required({"A.rest.x": "5 m"}, {"A.tyres.height": Uniform("0.3 m", "0.8 m")})
    assert found.answered == 32


def test_why_cases_of_a_scene_have_no_answer_is_stated_once() -> None:
    """Of speeds from -5 to 15 m/s a quarter part from the car that stands."""
    with pytest.warns(col.OutOfRangeWarning, match="16 of 64 cases"):
        found = propagate(
            in_line(),
            {"A.vx": Uniform("-5 m/s", "15 m/s")},
            outputs=["impacts[0].a.delta_v"],
            samples=64,
            seed=1,
        )
    assert [one for one in found.statements if "separating" in one] == [
        "16 of 64 cases (25 %): without an answer, as separating"
    ]


@pytest.mark.slow
def test_a_study_without_an_answer_names_the_causes_by_their_number() -> None:
    one = {"Explorer.vx": Normal("20 m/s", "1 m/s")}
    asked = {"outputs": ["impacts[2].a.before.speed"], "samples": 64, "seed": 1}
    with pytest.raises(col.NoSolutionError) as caught:
        propagate(crossing(), one, **asked)
    said = r"64 of 64 cases (100 %): without an answer, as impacts[2] does not come"
    assert str(caught.value).endswith(f"It said: {said}")
    # Of the draws most are behind the other car, and some pass it by.
    wide = {"A.x": Uniform(2.0, 100.0), "A.y": Uniform(-0.5, 9.5)}
    asked["outputs"] = ["contacts[0].impact.B.before.speed", "impacts[1].energy_loss"]
    with pytest.raises(col.NoSolutionError) as caught:
        propagate(crash(), wide, **asked)
    listed = str(caught.value).partition("It said: ")[2]
    many = [int(part.split(" of 64 ")[0]) for part in listed.split("; ")]
    assert many == sorted(many, reverse=True)
    assert len(many) > 1
    assert "contact_missing" in listed
    assert "stands" not in listed


@pytest.mark.slow
def test_a_refusal_has_numbers_in_the_units_of_the_priors() -> None:
    crash = crossing().replace({"contacts[0].normal": "180 deg"})
    with pytest.raises(col.NoSolutionError, match=r"among them Explorer.vx = 42\.5 mph"):
        posterior(
            crash, {"Explorer.vx": Uniform("5 mph", "80 mph")}, {"Jetta.rest.x": ("9 m", "1 m")}
        )


def test_a_text_of_an_input_or_a_reading_needs_its_unit() -> None:
    """A bare number is in SI; a text is not read as if it were, and percent are no speed."""
    scene, seen = crossing(), {"Jetta.rest.x": ("9 m", "1 m")}
    wanted = ["Jetta.rest.x"]
    for text in (Uniform("5", "25"), Normal("20", "2"), Normal("20 %", "2 %")):
        for call in (
            lambda text=text: posterior(scene, {"Explorer.vx": text}, seen),
            lambda text=text: fit(scene, {"Explorer.vx": text}, seen),
            lambda text=text: propagate(scene, {"Explorer.vx": text}, outputs=wanted),
            lambda text=text: scene.required({"Jetta.rest.x": "1 m"}, {"Explorer.vx": text}),
        ):
            with pytest.raises(
                col.UnitsError, match=r"\['Explorer.vx'\] (= '.*' has no unit|is stated in %)"
            ):
                call()
    for call in (
        lambda: fit(scene, {"Explorer.vx": "20"}, seen),
        lambda: propagate(
            scene, {"Explorer.vx": "20", "Jetta.drag": Uniform(0.6, 0.8)}, outputs=wanted
        ),
    ):
        with pytest.raises(col.UnitsError, match=r"\['Explorer.vx'\] = '20' has no unit"):
            call()
    prior = {"Explorer.vx": Uniform("5 m/s", "25 m/s")}
    for call in (posterior, fit):
        with pytest.raises(col.UnitsError, match=r"observed\['Jetta.rest.x'\] = '9' has no unit"):
            call(scene, prior, {"Jetta.rest.x": ("9", "1")})
    slowed = propagate(
        scene, {"Jetta.drag": Uniform("0.6", "0.8")}, outputs=wanted, samples=64, seed=1
    )
    assert slowed.samples == 64


@pytest.mark.slow
def test_units_that_are_required_are_required_of_readings_and_tolerances() -> None:
    """As of everything else in a scene that has a dimension."""
    scene, prior = crossing(), {"Explorer.vx": Uniform("5 m/s", "25 m/s")}
    with col.options(require_units=True):
        for call in (posterior, fit):
            with pytest.raises(col.UnitsError, match=r"observed\['Jetta.rest.x'\].*require_units"):
                call(scene, prior, {"Jetta.rest.x": (8, 0.3)})
        with pytest.raises(col.UnitsError, match=r"unknowns\['Explorer.vx'\].*require_units"):
            scene.required({"Jetta.rest.x": "1 m"}, {"Explorer.vx": Uniform(5, 25)})
        for tolerance in (0.5, {"Jetta.rest.x": 0.5}):
            with pytest.raises(col.UnitsError, match=r"tolerance\['Jetta.rest.x'\].*require_units"):
                propagate(scene, prior, outputs=["Jetta.rest.x"], tolerance=tolerance, seed=1)
        propagate(scene, prior, outputs=["Jetta.rest.x"], tolerance="0.5 m", seed=1)


def test_a_refused_mover_is_not_missed_by_its_contacts() -> None:
    """One line, about its name; the contact names it rightly."""
    a, b = (Mover(col.Vehicle(mass=1000, vx=v)) for v in (5, 0))
    contact = Contact("A", "Po.lo", restitution=0.1, normal=0, model="linear_central")
    with pytest.raises(col.InputError, match=r"has the name 'Po.lo'") as caught:
        Scene(movers={"A": a, "Po.lo": b}, contacts=[contact])
    assert "and the movers are" not in str(caught.value)
    with pytest.raises(col.InputError, match=r"names 'Po.lo', and the movers are A, Polo"):
        Scene(movers={"A": a, "Polo": b}, contacts=[contact])
