"""Levels of a scene: what each is made of, how far it is from the finest, and which is enough."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform, propagate

WHEELS = Tyres(0.7, [1, 1, 0.1, 0.1], 2.7, 1.5)
PLACE: dict[str, Any] = {"normal": 0, "point": (0, 0)}


def crash(tyres: Any = WHEELS, speed: float = 15.0, **contact: Any) -> Scene:
    a = col.Vehicle(mass=1500, yaw_inertia=2600, vx=speed, x=-2.2, y=0.3, heading=0)
    b = col.Vehicle(mass=1200, yaw_inertia=2000, x=2.2, y=0, heading=0)
    on = {"drag": 0.6} if tyres is None else {"tyres": tyres}
    hit = Contact("A", "B", **{"restitution": 0.1, "friction": 0.5, **PLACE, **contact})
    return Scene(movers={"A": Mover(a, **on), "B": Mover(b, **on)}, contacts=[hit])


UNKNOWNS = {"A.vx": Normal(15.0, 1.0), "B.tyres.friction": Uniform(0.6, 0.8)}


@pytest.mark.slow
def test_levels_are_the_same_crash_from_the_cheapest_to_the_finest() -> None:
    found = crash(duration=0.08, model="eccentric").required({"A.rest.x": 0.3})
    names = [(one.level.contacts, one.level.motion) for one in found.costs]
    assert names == [
        ("instant", "drag"),
        ("in time", "drag"),
        ("instant", "wheels"),
        ("with tyres", "wheels"),
        ("in time", "wheels"),
    ]
    instant, in_time = found.costs[0].level.scene, found.finest.scene
    assert instant.contacts[0].model == "eccentric"
    assert instant.contacts[0].duration is None
    assert instant.movers["A"].tyres is None
    assert in_time.contacts[0].model == "time_resolved"
    assert in_time.contacts[0].duration == 0.08
    assert in_time.movers["A"].tyres == WHEELS
    assert found.costs[3].level.scene.contacts[0].duration == 0.08
    assert found.costs[-1].differences == {"A.rest.x": 0.0}
    assert found.costs[-1].within


@pytest.mark.slow
def test_the_differences_are_those_of_runs_of_the_draws() -> None:
    """By hand: each level is propagated for the same draws; 31 of 32 do not exceed the figure."""
    scene = crash()
    found = scene.required({"A.rest.x": "0.3 m", "impacts[0].b.delta_v": "0.2 m/s"}, UNKNOWNS)
    assert (found.draws, found.answered) == (32, 32)
    for one in found.costs[2:4]:
        model = one.level.as_model(list(UNKNOWNS), list(found.units))
        finest = found.finest.as_model(list(UNKNOWNS), list(found.units))
        # Other draws of the same distributions, many more of them.
        rng = np.random.default_rng(1)
        drawn = {
            "A.vx": rng.normal(15.0, 1.0, 128),
            "B.tyres.friction": rng.uniform(0.6, 0.8, 128),
        }
        for path, unit in found.units.items():
            off = np.abs(model(**drawn)[path].m_as(unit) - finest(**drawn)[path].m_as(unit))
            wanted = float(np.quantile(off, 0.95))
            # The margin is for what 32 draws leave open: a quarter.
            assert 0.8 * wanted < one.differences[path] < 1.9 * wanted


def test_the_cheapest_level_within_the_tolerances_is_taken() -> None:
    scene = crash()
    wide = scene.required({"impacts[0].b.delta_v": "5 m/s"})
    assert wide.level.name == "contacts instant, motion by drag"
    near = scene.required({"impacts[0].b.delta_v": "0.1 m/s"})
    assert near.level.name == "contacts with tyres, motion on wheels"
    none = scene.required({"impacts[0].b.delta_v": "1e-9 m/s"})
    assert none.level == none.finest
    assert "at the stated values alone" in " ".join(near.statements)
    assert "factor of 3" in " ".join(near.statements)
    assert "taken as 0.1 s" in " ".join(near.statements)


@pytest.mark.slow
def test_a_drag_is_that_of_locked_wheels_on_a_straight_way() -> None:
    """And, with the front ones alone, that which the energy along the way gives."""
    locked = crash(Tyres(0.7, 1, 2.7, 1.5)).required({"A.rest.x": 1.0})
    assert locked.level.drags == pytest.approx({"A": 1.0, "B": 1.0}, abs=0.02)
    half = crash(Tyres(0.7, [1, 1, 0, 0], 2.7, 1.5)).required({"A.rest.x": 1.0})
    assert 0.45 < half.level.drags["A"] < 0.75


@pytest.mark.slow
def test_without_tyres_the_motion_is_as_given() -> None:
    # Nothing slows the vehicles while the finest level follows their contact.
    with pytest.warns(col.OutOfRangeWarning, match="a drag does not act"):
        found = crash(None).required({"B.rest.x": "0.5 m"})
    assert [one.level.contacts for one in found.costs] == ["instant", "in time"]
    assert {one.level.motion for one in found.costs} == {"as given"}
    assert found.finest.scene.movers["A"].drag == 0.6


@pytest.mark.slow
def test_a_contact_that_cannot_be_followed_in_time_stays_as_it_is() -> None:
    found = crash(friction=None, impulse_ratio=0.2).required({"B.rest.x": "0.5 m"})
    assert [one.level.contacts for one in found.costs] == ["instant", "instant"]
    assert "the model of contacts[0] is that given" in " ".join(found.statements)
    assert found.finest.scene.contacts[0].impulse_ratio == 0.2


@pytest.mark.slow
def test_a_level_is_a_model_with_the_inputs_of_its_scene() -> None:
    """Friction of tyres is an input of the level by drag too, which scales the drag."""
    found = crash().required({"B.rest.x": 0.3})
    cheap = found.costs[0].level
    inputs = {"B.tyres.friction": Uniform(0.6, 0.8)}
    spread = propagate(cheap, inputs, outputs=["B.rest.x"], samples=64, seed=0)
    at = cheap.as_model(["B.tyres.friction"], ["B.rest.x"])
    near, far = (at(**{"B.tyres.friction": mu})["B.rest.x"].m for mu in (0.8, 0.6))
    assert near < spread["B.rest.x"].mean < far
    # The way from the contact to rest is inversely proportional to the friction.
    start = 2.2
    assert (far - start) / (near - start) == pytest.approx(0.8 / 0.6, rel=1e-9)
    assert cheap.results() == cheap.given.results()


@pytest.mark.slow
def test_draws_without_an_answer_count_against_a_level() -> None:
    """A truck that is reached on rolling wheels only: the level by drag has no second contact."""
    a = col.Vehicle(mass=1500, yaw_inertia=2600, vx=12, x=-2.2, y=0, heading=0)
    b = col.Vehicle(mass=1200, yaw_inertia=2000, x=2.2, y=0, heading=0)
    c = col.Vehicle(mass=6000, yaw_inertia=20000, x=13.0, y=0, heading=0)
    rolling, locked = Tyres(0.7, 0.1, 2.7, 1.5), Tyres(0.7, 1, 2.7, 1.5)
    row = {"restitution": 0.1, "friction": 0.5}
    scene = Scene(
        movers={
            "A": Mover(a, outline=(4.4, 1.8), tyres=locked),
            "B": Mover(b, outline=(4.4, 1.8), tyres=rolling),
            "C": Mover(c, outline=(6.0, 2.3), tyres=locked),
        },
        contacts=[
            Contact("A", "B", normal=0, point=(0, 0), **row),
            Contact("B", "C", at="touch", **row),
        ],
    )
    speeds = {"A.vx": Uniform("4 m/s", "12 m/s")}
    # What a contact in time leaves of their crush, B and C keep.
    found = scene.required({"C.rest.x": "0.2 m"}, speeds)
    assert found.answered < found.draws
    assert f"{found.draws - found.answered} of 32 draws have no answer" in " ".join(
        found.statements
    )


@pytest.mark.slow
def test_it_is_shown_and_recorded() -> None:
    found = crash().required({"A.rest.x": "1 ft", "A.rest.heading": "5 deg"}, UNKNOWNS)
    text = str(found.summary("us"))
    assert "contacts with tyres, motion on wheels" in text
    assert "in 95% of 32 draws, times 1.35" in text
    record = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert record["tolerances"]["A.rest.x"] == pytest.approx(0.3048)
    assert record["tolerances"]["A.rest.heading"] == pytest.approx(math.radians(5))
    assert len(record["levels"]) == 5
    assert all(one["seconds"] > 0.0 for one in record["levels"])
    assert repr(found.level).startswith("<Level: contacts")


@pytest.mark.parametrize(
    ("given", "code", "says"),
    [
        (({},), "bad_shape", "tolerances must be a dict from results"),
        (({"A.rest.z": 1},), "unknown_name", "near it are A.rest"),
        (({"A.rest.x": "1 kg"},), "bad_units", "cannot be taken as m"),
        (({"A.rest.x": 0.0},), "not_positive", "must be > 0"),
        (({"A.rest.x": np.array([0.1, 0.2])},), "bad_shape", "must be one number, got an array"),
        (({"A.rest.x": 1}, {}), "bad_inputs", "unknowns must be a dict from inputs"),
        (({"A.rest.x": 1}, {"A.vx": 3.0}), "bad_inputs", "unknowns must be a dict"),
        (({"A.rest.x": 1}, {"A.v": Normal(3, 1)}), "unknown_name", "near it are A.v"),
        (({"A.rest.x": 1}, {"A.vx": Normal("3 m", "1 m")}), "bad_units", "is stated in m, and"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(given: Any, code: str, says: str) -> None:
    with pytest.raises(col.InputError, match=says) as caught:
        crash().required(*given)
    assert caught.value.code == code


@pytest.mark.slow
@pytest.mark.parametrize(("names", "outputs"), [(["A.vx"], 1e38), ("A.vx", ["A.rest.x"])])
def test_a_model_takes_lists_of_paths(names: Any, outputs: Any) -> None:
    for model in (crash(), crash().required({"A.rest.x": 1.0}).level):
        with pytest.raises(col.InputError, match="must be a list of paths") as caught:
            model.as_model(names, outputs)
        assert caught.value.code == "bad_shape"


def test_numbers_of_draws_and_batches_are_refused() -> None:
    with pytest.raises(col.InputError, match="draws must be a whole number from 32"):
        crash().required({"A.rest.x": 1}, UNKNOWNS, draws=8)
    batch = crash().replace({"A.vx": np.array([14.0, 15.0])})
    with pytest.raises(col.InputError, match=r"write scene.case\(0\).required"):
        batch.required({"A.rest.x": 1})


def driven_through() -> Scene:
    """A striker that rolls on through the car it struck, which turns."""
    fast = col.Vehicle(mass=2000, yaw_inertia=3500, x=-8, y=0, heading=0, vx=15)
    slow = col.Vehicle(mass=1000, yaw_inertia=1500, x=0, y=0.3, heading=1.5)
    return Scene(
        movers={
            "A": Mover(fast, outline=(4.5, 1.8), tyres=Tyres(0.7, 0.2, 2.7, 1.5)),
            "B": Mover(slow, outline=(4.2, 1.7), tyres=Tyres(0.7, 1.0, 2.6, 1.5)),
        },
        contacts=[Contact("A", "B", restitution=0.0, friction=0.3, at="touch")],
    )


@pytest.mark.slow
@pytest.mark.parametrize("unknowns", [None, {"A.speed": Normal(15.0, 1.0)}])
def test_the_levels_say_that_vehicles_are_driven_through_each_other(unknowns: Any) -> None:
    """As `propagate` says it of the same draws; what one level has by its drag is stated alone."""
    scene = driven_through()
    assert "driven_through" in [one.code for one in scene.run().findings]
    with pytest.warns(col.OutOfRangeWarning) as warned:
        found = scene.required({"B.rest.x": "0.3 m"}, unknowns, tolerance=1e-3)
    assert [one.message.code for one in warned] == ["driven_through"]
    (note,) = [one for one in found.notes if "do not part" in one]
    assert note.startswith("at every level" if unknowns is None else "in 32 of 32 draws at every")
    assert "do not part right after their" in str(found)
    assert note in found.to_dict()["statements"]
    (drag,) = [one for one in found.notes if "a drag does not act" in one]
    assert "'contacts in time, motion by drag'" in drag


@pytest.mark.slow
def test_a_scene_as_a_model_warns_of_one_case_as_of_many() -> None:
    model = driven_through().as_model(["A.speed"], ["B.rest.x"])
    with pytest.warns(col.OutOfRangeWarning) as many:
        model(**{"A.speed": np.array([15.0, 15.5])})
    with pytest.warns(col.OutOfRangeWarning) as one:
        model(**{"A.speed": 15.0})
    assert [warning.message.code for warning in one] == ["driven_through"]
    assert [warning.message.code for warning in many] == ["driven_through"]


def test_a_scene_as_a_model_warns_of_a_touch_that_no_contact_describes() -> None:
    a = col.Vehicle(mass=1500, yaw_inertia=2600, vx=15, x=-10, y=0, heading=0)
    b = col.Vehicle(mass=1200, yaw_inertia=2000, x=0, y=0, heading=0)
    movers = {name: Mover(one, outline=(4.5, 1.8), drag=0.7) for name, one in (("A", a), ("B", b))}
    with pytest.warns(col.OutOfRangeWarning) as warned:
        Scene(movers=movers, contacts=[]).as_model([], ["A.rest.x"])()
    assert [warning.message.code for warning in warned] == ["touch_without_contact"]
