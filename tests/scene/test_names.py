"""A scene's numbers by their paths: replaced, listed, recorded, and asked for by studies."""

from __future__ import annotations

import json
import pickle
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct
from collisions.scene import Contact, Mover, Run, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform, propagate

OUTLINE = ("4.6 m", "1.8 m")


def crash(**more: Any) -> Scene:
    """A car that strikes another from the side, which is pushed against a parked truck."""
    camry = col.Vehicle(
        mass="1500 kg", yaw_inertia=2600, x=-2.6, y=0.2, heading=0, vx="40 mph", name="c"
    )
    civic = col.Vehicle.from_speed(
        mass=1250, yaw_inertia=1900, x=1.0, y=2.0, heading="90 deg", speed="20 mph", course="90 deg"
    )
    truck = col.Vehicle(mass=6000, yaw_inertia=25000, x=10, y=13, heading="90 deg")
    jammed = Tyres(0.7, [1, 0.05, 0.05, 0.05], "2.78 m", "1.55 m")
    return Scene(
        movers={
            "Camry": Mover(camry, outline=OUTLINE, tyres=jammed),
            "Civic": Mover(civic, outline=OUTLINE, tyres=Tyres("70 %", 0.3, "2.62 m", "1.48 m")),
            "Truck": Mover(truck, outline=("6.2 m", "2.3 m"), drag="0.6"),
        },
        contacts=[
            Contact(
                "Camry", "Civic", restitution="10 %", friction=0.5, normal="5 deg", point=("0 m", 0)
            )
        ],
        surfaces=[([(20, -5), (30, -5), (30, 5), (20, 5)], "0.3")],
        shared={"ground": ("Camry.tyres.friction", "Civic.tyres.friction")},
        **more,
    )


@pytest.mark.slow
def test_every_listed_input_can_be_replaced_and_every_result_has_a_value() -> None:
    scene = crash()
    same = scene.run()
    for path in scene.inputs():
        value = 0.5 if path.endswith(("friction", "[0]", "[1]", "[2]", "[3]", "lock")) else 1.0
        assert isinstance(scene.replace({path: value}), Scene)
    known = scene.results()
    assert {"Camry.rest.x", "impacts[0].a.delta_v_forward", "times[0]"} < known.keys()
    columns = same.to_columns()
    numbers = {path for path in known if ".marks." not in path}
    assert set(columns) == {"status", "impacts[0].status", *numbers}
    assert known["impacts[0].b.after.yaw_rate"] == "rad/s"


def test_replace_is_the_scene_with_other_numbers() -> None:
    scene = crash()
    found = scene.replace(
        {
            "Camry.speed": "30 mph",
            "Civic.course": "80 deg",
            "Camry.tyres.lock[1]": 1,
            "contacts[0].point[1]": "0.3 m",
            "contacts[0].normal": "10 deg",
            "surfaces[0]": 0.2,
            "ground": 0.6,
            "Truck.drag": 0.4,
        }
    )
    assert found.movers["Camry"].vehicle.vx == pytest.approx(30 * 0.44704, rel=1e-15)
    assert found.movers["Camry"].tyres.locks == (1.0, 1.0, 0.05, 0.05)
    assert found.movers["Civic"].vehicle.q.course.m_as("deg") == pytest.approx(80.0)
    assert found.contacts[0].point == (0.0, 0.3)
    assert found.contacts[0].as_given("normal") == "10 deg"
    assert found.surfaces[0][1] == 0.2
    assert found.movers["Civic"].tyres.friction == found.movers["Camry"].tyres.friction == 0.6
    assert scene == crash()


@pytest.mark.parametrize(
    ("path", "value", "says"),
    [
        ("Camry.vz", 1.0, r"no 'Camry.vz'; near it are Camry.v"),
        ("contacts[1].friction", 1.0, r"near it are contacts\[0\].friction"),
        ("Truck.speed", 1.0, "Truck stands, so its course is not known; write 'Truck.vx'"),
        ("Camry.mass", "3 m", "Camry: mass"),
        ("Civic.tyres.lock[0]", 1.0, "Civic: .*one for all"),
        ("contacts[0].restitution", 2.0, r"contacts\[0\]: restitution must be from 0 to 1"),
    ],
)
def test_a_path_or_number_that_cannot_be_is_refused(path: str, value: Any, says: str) -> None:
    with pytest.raises(col.InputError, match=says):
        crash().replace({path: value})


@pytest.mark.slow
def test_a_run_comes_back_from_its_record_to_the_bit() -> None:
    run = crash().run()
    record = json.loads(json.dumps(run.to_dict(), allow_nan=False))
    again = Run.from_dict(record)
    assert again == run
    assert again.rest["Civic"] == run.rest["Civic"]
    assert again.to_dict() == run.to_dict()
    assert Scene.from_dict(json.loads(json.dumps(run.scene.to_dict()))) == run.scene
    assert pickle.loads(pickle.dumps(run)).rest["Camry"] == run.rest["Camry"]
    record["format"] = "collisions impact 2"
    with pytest.raises(col.InputError, match=r"not what Run.to_dict\(\) gives"):
        Run.from_dict(record)


@pytest.mark.slow
def test_a_table_names_the_vehicles_in_the_units_of_the_inputs() -> None:
    text = str(crash().run().summary())
    assert "Camry and Civic" in text
    assert "40.0 mph" not in text.split("Places of rest")[1]
    assert "Places of rest" in text


DRAGGED = Scene(
    movers={
        "A": Mover(col.Vehicle(mass=1500.0, vx=20.0, x=0.0, y=0.0, heading=0.0), drag=0.5),
        "B": Mover(col.Vehicle(mass=1200.0, vx=2.0, x=4.5, y=0.0, heading=0.0), drag=0.6),
    },
    contacts=[Contact("A", "B", restitution=0.1, normal=0.0, model="linear_central")],
)


def rest_of_b(vx: Any, restitution: Any) -> Any:
    """In closed form."""
    after = 2.0 + (1.0 + restitution) * (vx - 2.0) * 1500.0 / 2700.0
    return 4.5 + after**2 / (2.0 * 0.6 * col.travel.GRAVITY)


def test_propagate_takes_a_scene_as_a_model() -> None:
    inputs = {"A.vx": Normal(20.0, 1.0), "contacts[0].restitution": Uniform(0.05, 0.15)}
    paths = ["B.rest.x", "impacts[0].b.delta_v"]
    found = propagate(DRAGGED, inputs, outputs=paths, samples=256, seed=3)
    wanted = propagate(
        lambda vx, e: {"x": rest_of_b(vx, e)},
        {"vx": Normal(20.0, 1.0), "e": Uniform(0.05, 0.15)},
        samples=256,
        seed=3,
    )
    assert found["B.rest.x"].mean == pytest.approx(wanted["x"].mean, rel=1e-12)
    assert found["B.rest.x"].std == pytest.approx(wanted["x"].std, rel=1e-9)
    assert found["impacts[0].b.delta_v"].unit == "m/s"
    with pytest.raises(col.InputError, match=r"'B.rest.z'; near it are B.rest"):
        propagate(DRAGGED, inputs, outputs=["B.rest.z"], seed=1)
    with pytest.raises(col.InputError, match="outputs must be a list of results of the Scene"):
        propagate(DRAGGED, inputs, seed=1)
    with pytest.raises(col.InputError, match=r"near it are A.v"):
        propagate(DRAGGED, {"A.vq": Normal(20.0, 1.0)}, outputs=paths, seed=1)
    with pytest.raises(col.InputError, match="outputs names results of a Scene"):
        propagate(lambda vx: {"x": vx}, {"vx": Normal(20.0, 1.0)}, outputs=["x"], seed=1)


@pytest.mark.slow
def test_fit_and_posterior_take_a_scene_as_a_model() -> None:
    place = rest_of_b(20.0, 0.1)
    found = reconstruct.fit(DRAGGED, {"A.vx": 15.0}, {"B.rest.x": Normal(place, 0.1)})
    after = reconstruct.posterior(
        DRAGGED, {"A.vx": Uniform(5.0, 40.0)}, {"B.rest.x": Normal(place, 0.1)}, seed=1
    )
    slope = (rest_of_b(20.01, 0.1) - rest_of_b(19.99, 0.1)) / 0.02
    assert found["A.vx"].value == pytest.approx(20.0, abs=0.02)
    assert after["A.vx"].mean == pytest.approx(20.0, abs=0.01)
    assert after["A.vx"].std == pytest.approx(0.1 / slope, rel=0.1)


@pytest.mark.slow
def test_a_batch_is_every_case_by_itself() -> None:
    rng = np.random.default_rng(5)
    count = 8
    changes = {
        "Camry.vx": rng.normal(18.0, 1.0, count),
        "ground": rng.uniform(0.6, 0.8, count),
        "contacts[0].friction": rng.uniform(0.3, 0.6, count),
    }
    with pytest.warns(col.OutOfRangeWarning, match="in 1 of 8 cases .* no contact says"):
        batch = crash().replace(changes).run()
    for i in range(0, count, 3):
        one = crash().replace({path: float(value[i]) for path, value in changes.items()}).run()
        assert batch.case(i) == one
        for name in ("Camry", "Civic", "Truck"):
            for part in ("x", "y", "heading"):
                many, few = getattr(batch.rest[name], part), getattr(one.rest[name], part)
                assert many[i] == pytest.approx(few, abs=1e-9)
        assert batch.impacts[0].a.delta_v[i] == pytest.approx(one.impacts[0].a.delta_v, abs=1e-12)
        assert batch.paths["Camry"].x[40, i] == pytest.approx(one.paths["Camry"].x[40], abs=1e-9)


@pytest.mark.slow
def test_cases_of_a_batch_go_in_orders_of_their_own() -> None:
    row = {"normal": 0.0, "model": "linear_central", "at": "touch", "restitution": 0.2}
    middle = np.array([5.5, 8.5, 5.5, 8.5, 100.0])

    def mover(mass: float, vx: float, x: Any) -> Mover:
        return Mover(col.Vehicle(mass=mass, vx=vx, x=x, y=0.0, heading=0.0), outline=(4.5, 1.8))

    scene = Scene(
        movers={
            "A": mover(1500.0, 16.0, 0.0),
            "B": mover(1200.0, 8.0, middle),
            "C": mover(1400.0, 0.0, 14.0),
        },
        contacts=[Contact("A", "B", **row), Contact("B", "C", **row)],
    )
    with pytest.warns(col.CollisionsWarning, match="1 of 5 cases of the scene have no answer"):
        run = scene.run()
    assert run.status.tolist() == ["ok"] * 4 + ["contact_missing"]
    with pytest.raises(col.InputError, match="in another order in some cases"):
        len(run.impacts)
    with pytest.warns(
        col.CollisionsWarning, match="of other contacts.* than in most cases"
    ) as said:
        columns = run.to_columns()
    assert said[0].message.code == "several_orders"
    for i in range(4):
        one = scene.case(i).run()
        assert [run.times[k][i] for k in range(len(one.times))] == pytest.approx(one.times)
        for k, (impact, pair) in enumerate(zip(one.impacts, one.pairs, strict=True)):
            found = columns[f"impacts[{k}].a.delta_v"][i]
            # Two cases go in each order; the first contact of the list decides.
            usual = (("A", "B"), ("B", "C"))[k % 2]
            assert np.isnan(found) == (pair != usual)
            assert np.isnan(columns[f"times[{k}]"][i]) == (pair != usual)
            if pair == usual:
                assert found == pytest.approx(impact.a.delta_v, rel=1e-12)
        for rule, pair in enumerate((("A", "B"), ("B", "C"))):
            k = one.pairs.index(pair)
            path = f"contacts[{rule}].impact"
            found = columns[f"{path}.{pair[1]}.delta_v"][i]
            assert found == pytest.approx(one.impacts[k].b.delta_v, rel=1e-12)
            assert columns[f"{path}.time"][i] == pytest.approx(one.times[k], rel=1e-12)
    assert np.isnan(run.times[0][4])
    with pytest.raises(col.NoSolutionError, match="does not come"):
        run.case(4)


@pytest.mark.slow
def test_places_of_rest_on_tyres_can_be_propagated_whatever_is_drawn() -> None:
    inputs = {"Camry.vx": Normal(18.0, 1.0), "ground": Uniform(0.6, 0.8)}
    scene = Scene(movers=crash().movers, contacts=crash().contacts, shared=crash().shared)
    for seed in range(3):
        # In some the Camry runs into the Civic again, of which only their contact at 0 is said.
        with pytest.warns(col.OutOfRangeWarning, match="no contact says what happens"):
            found = propagate(
                scene, inputs, outputs=["Camry.rest.x", "Civic.rest.y"], samples=128, seed=seed
            )
        assert found.failed == 0
        assert found["Civic.rest.y"].std > 0.5


def test_a_word_in_place_of_a_time_stays_a_word() -> None:
    assert Contact("A", "B", restitution=0.1, friction=0.5, at="touch").q.at == "touch"
    assert Contact("A", "B", restitution=0.1, friction=0.5, at="2 s").q.at.m_as("ms") == 2000.0
