"""What a path asks for of a run: by contact and vehicle the same two whatever the order; by its
number the impact of the scene as written, and never a mix of vehicles.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.reconstruct import fit, posterior
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform, propagate

BUMP: dict[str, Any] = {"normal": 0, "model": "linear_central", "at": "touch"}
MASSES = {"rear": 1500.0, "middle": 1200.0, "front": 1400.0}
LENGTH, GAP, E = 4.4, 1.5, 0.2
MIDDLE = 9.0
# Faster than this the rear car comes to the middle one before that comes to the front one: both
# close the same gap, the middle one at 9 m/s.
TURN = 2.0 * MIDDLE


def row(rear: Any = 24.0, **more: Any) -> Scene:
    """Three cars in line that nothing slows, of which the front one stands."""
    step = LENGTH + GAP
    movers = {
        name: Mover(
            col.Vehicle(mass=MASSES[name], vx=vx, x=x, y=0, heading=0), outline=(LENGTH, 1.8)
        )
        for name, vx, x in (
            ("rear", rear, -2 * step), ("middle", MIDDLE, -step), ("front", 0.0, 0.0)
        )
    }  # fmt: skip
    contacts = [
        Contact("rear", "middle", restitution=E, **BUMP),
        Contact("middle", "front", restitution=E, **BUMP),
    ]
    return Scene(**({"movers": movers, "contacts": contacts} | more))


def delta_v_of_front(rear: Any) -> Any:
    """Of the front car in its first impact, by momentum and restitution."""
    a, b, c = MASSES.values()
    pushed = MIDDLE + (1.0 + E) * a / (a + b) * (rear - MIDDLE)
    return (1.0 + E) * b / (b + c) * np.where(rear > TURN, pushed, MIDDLE)


def delta_v_of_middle(rear: Any) -> Any:
    """Of the middle car in its first impact with the rear one."""
    a, b, c = MASSES.values()
    slowed = MIDDLE - (1.0 + E) * c / (b + c) * MIDDLE
    return (1.0 + E) * a / (a + b) * (rear - np.where(rear > TURN, MIDDLE, slowed))


RANGE = {"rear.vx": Uniform("13 m/s", "25 m/s")}
FRONT, MID = "contacts[1].impact.front.delta_v_forward", "contacts[0].impact.middle.delta_v"
ASKED: dict[str, Any] = {"samples": 256, "seed": 1}


@pytest.mark.slow
def test_a_path_by_contact_follows_its_vehicles_whatever_the_order() -> None:
    speeds = np.array([13.0, 15.0, 17.0, 19.0, 24.0])
    times = ["contacts[0].impact.time", "contacts[1].impact.time"]
    model = row().as_model(["rear.vx"], [FRONT, MID, "contacts[1].impact.closing_speed", *times])
    found = model(**{"rear.vx": speeds})
    assert found[FRONT].m_as("m/s") == pytest.approx(delta_v_of_front(speeds), rel=1e-9)
    assert found[MID].m_as("m/s") == pytest.approx(delta_v_of_middle(speeds), rel=1e-9)
    assert (found[times[0]] < found[times[1]]).tolist() == (speeds > TURN).tolist()
    for at, speed in enumerate(speeds.tolist()):
        one = model(**{"rear.vx": speed})
        assert {path: value[at].m for path, value in found.items()} == pytest.approx(
            {path: value.m for path, value in one.items()}, rel=1e-12
        )
    study = propagate(row(), RANGE, outputs=[FRONT], **ASKED)
    assert study.failed == 0
    assert not study.statements


@pytest.mark.slow
def test_a_contact_that_comes_again_has_its_first_impact() -> None:
    run = row(14.0).run()
    assert run.pairs[:3] == (("middle", "front"), ("rear", "middle"), ("middle", "front"))
    columns = run.to_columns()
    assert columns[FRONT] == [run.impacts[0].b.delta_v_forward]
    assert columns["contacts[0].impact.time"] == [run.times[1]]
    assert columns["impacts[2].b.delta_v_forward"] == [run.impacts[2].b.delta_v_forward]
    # A study by the number of the second does not offer the first in its place.
    with pytest.warns(col.CollisionsWarning):
        found = propagate(row(14.0), RANGE, outputs=["impacts[2].b.delta_v"], **ASKED)
    text = " ".join(found.statements)
    assert "is the first of these two in every case, which is not this one" in text


@pytest.mark.slow
def test_an_impact_by_its_number_is_that_of_the_scene_as_written_or_nothing() -> None:
    path = "impacts[0].b.delta_v"
    speeds = np.array([14.0, 20.0, 24.0])
    for rear, pair, wanted in (
        (24.0, "rear and middle", delta_v_of_middle),
        (14.0, "middle and front", delta_v_of_front),
    ):
        model = row(rear).as_model(["rear.vx"], [path, "times[0]"])
        with pytest.warns(col.CollisionsWarning, match=f"another than that of {pair}") as said:
            found = model(**{"rear.vx": speeds})
        assert said[0].message.code == "several_orders"
        same = (speeds > TURN) == (rear > TURN)
        for value in found.values():
            assert np.isnan(value.m).tolist() == (~same).tolist()
        assert found[path].m_as("m/s")[same] == pytest.approx(wanted(speeds[same]), rel=1e-9)
        # And so does each case alone.
        for speed, good in zip(speeds.tolist(), same.tolist(), strict=True):
            if good:
                assert model(**{"rear.vx": speed})[path].m == pytest.approx(wanted(speed))
                continue
            with pytest.raises(
                col.NoSolutionError, match=r"write 'contacts\[[01]\].impact\.[mf]"
            ) as e:
                model(**{"rear.vx": speed})
            assert e.value.code == "several_orders"


@pytest.mark.slow
def test_a_study_counts_the_cases_in_which_an_impact_is_another() -> None:
    with pytest.warns(col.CollisionsWarning) as said:
        found = propagate(row(), RANGE, outputs=["impacts[0].b.delta_v"], **ASKED)
    codes = {warning.message.code for warning in said}
    assert codes == {"several_orders", "failed_cases"}
    # Those of the draws below 18 m/s.
    assert found.failed == pytest.approx(256 * (TURN - 13.0) / 12.0, abs=2)
    text = " ".join(found.statements)
    assert f"{found.failed} of 256 cases" in text
    assert "impacts[0] of the scene as written is that of rear and middle (contacts[0])" in text
    low, high = found["impacts[0].b.delta_v"].quantile([0.0, 1.0])
    assert delta_v_of_middle(TURN + 1e-9) < low < high < delta_v_of_middle(25.0)


@pytest.mark.slow
def test_evidence_is_not_matched_with_another_vehicle_in_silence() -> None:
    """10 m/s read on the front car: by its contact the speed comes back, and by the number of its
    impact the result says which vehicles that is.
    """
    reading = Normal(float(delta_v_of_front(22.0)), 0.2)
    truth = posterior(row(), RANGE, {FRONT: reading}, samples=512, seed=1)
    assert truth["rear.vx"].mean == pytest.approx(22.0, abs=4.0 * truth["rear.vx"].std)
    with pytest.warns(col.CollisionsWarning, match="is that of rear and middle") as said:
        found = posterior(row(), RANGE, {"impacts[0].b.delta_v": reading}, samples=512, seed=1)
    assert said[0].message.code == "one_order"
    text = " ".join(found.statements)
    assert "impacts[0] of the scene as written is that of rear and middle" in text
    assert "counts as impossible where it is evidence" in text
    best = fit(row(22.5), {"rear.vx": "22.5 m/s"}, {FRONT: reading})
    assert best["rear.vx"].value == pytest.approx(22.0, abs=1e-6)


@pytest.mark.slow
def test_levels_are_compared_by_the_same_impact() -> None:
    path = "impacts[0].b.delta_v"
    with pytest.warns(col.CollisionsWarning, match="another than that of rear and middle"):
        found = row().required({path: "1 m/s"}, RANGE)
    assert found.answered < found.draws
    assert row().required({FRONT: "1 m/s"}, RANGE).answered == 32


@pytest.mark.slow
def test_an_impact_that_is_no_certain_one_is_refused_with_its_contacts() -> None:
    # As written the rear car stands, and comes to no contact.
    for path, written in (
        ("impacts[0].b.delta_v", r"'contacts\[0\].impact.middle.delta_v' or 'contacts\[1\]"),
        ("times[0]", r"'contacts\[0\].impact.time' or 'contacts\[1\].impact.time'"),
    ):
        with pytest.raises(col.InputError, match=f"cannot be said which.*Write {written}") as e:
            propagate(row(0.0), RANGE, outputs=[path], **ASKED)
        assert (e.value.code, e.value.argument) == ("several_orders", "outputs")
    with pytest.raises(col.InputError, match="observed has 'impacts") as e:
        posterior(row(0.0), RANGE, {"impacts[0].b.delta_v": ("9 m/s", "1 m/s")})
    assert e.value.argument == "observed"
    with pytest.raises(col.InputError, match="tolerances has 'impacts"):
        row().required({"impacts[9].b.delta_v": "1 m/s"}, RANGE)
    found = propagate(row(0.0), RANGE, outputs=[FRONT], **ASKED)
    assert found.failed == 0
    stated = row(0.0, order=[("rear", "middle"), ("middle", "front")] * 2)
    assert stated.as_model(["rear.vx"], ["impacts[0].b.delta_v"])


@pytest.mark.slow
def test_one_contact_or_the_first_at_the_start_needs_no_word() -> None:
    """Which contact an impact is then holds whatever is drawn."""
    step = LENGTH + GAP
    struck = row(
        contacts=[
            Contact("rear", "middle", restitution=E, normal=0, model="linear_central"),
            Contact("middle", "front", restitution=E, **BUMP),
        ]
    ).replace({"rear.x": -step - LENGTH})
    paths = ["impacts[0].b.delta_v", "impacts[1].b.delta_v"]
    found = propagate(struck, RANGE, outputs=paths, **ASKED)
    assert not found.statements
    for path, other in zip(paths, (MID, FRONT), strict=True):
        same = propagate(struck, RANGE, outputs=[other], **ASKED)
        assert found[path].mean == same[other].mean


def test_a_scene_without_contacts_has_no_impact() -> None:
    lone = row(contacts=[], movers={"rear": row().movers["rear"]})
    with pytest.raises(col.InputError, match="this scene has 0 impacts"):
        lone.as_model([], ["impacts[0].a.delta_v"])()
    with pytest.raises(col.NoSolutionError, match=r"as impacts\[0\] does not come"):
        propagate(lone, RANGE, outputs=["times[0]"], **ASKED)


@pytest.mark.slow
def test_the_time_between_two_events() -> None:
    """Both first contacts: the way that is left, over the speed that is."""
    speeds = np.array([19.0, 24.0])
    path = "contacts[1].impact.time - contacts[0].impact.time"
    found = row().as_model(["rear.vx"], [path, "times[1]-times[0]"])(**{"rear.vx": speeds})
    first = GAP / (speeds - MIDDLE)
    pushed = MIDDLE + (1.0 + E) * MASSES["rear"] / (1500.0 + 1200.0) * (speeds - MIDDLE)
    wanted = (GAP - MIDDLE * first) / pushed
    for value in found.values():
        assert value.m_as("s") == pytest.approx(wanted, abs=1e-9)
    for wrong in ("times[1] - rear.vx", "end - ", "times[0] - contacts[7].impact.time"):
        with pytest.raises(col.InputError, match="outputs has no"):
            row().as_model(["rear.vx"], [wrong])
    car = col.Vehicle(mass=1500, vx=12, x=0, y=0, heading=0)
    braked = row(movers=dict(row().movers) | {"lone": Mover(car.replace(y=50), drag=0.5)})
    end = braked.as_model([], ["end - times[0]", "end", "times[0]"])()
    assert end["end - times[0]"] == end["end"] - end["times[0]"]


@pytest.mark.slow
def test_the_ees_of_a_vehicle_has_its_share_of_the_energy_lost() -> None:
    """By hand: the energy lost is (1 - e^2) m u^2 / 2 with the reduced mass."""
    a, b = MASSES["rear"], MASSES["middle"]
    lost = 0.5 * (1.0 - E * E) * a * b / (a + b) * (24.0 - MIDDLE) ** 2
    for path, mass, share in (
        ("contacts[0].impact.rear.ees(0.4)", a, 0.4),
        ("contacts[0].impact.middle.ees(60 %)", b, 0.6),
        ("impacts[0].a.ees(0.4)", a, 0.4),
        ("impacts[0].b.ees( 0.25 )", b, 0.25),
    ):
        found = row().as_model(["rear.vx"], [path])(**{"rear.vx": 24.0})[path]
        assert found.m_as("m/s") == pytest.approx(math.sqrt(2.0 * share * lost / mass), rel=1e-9)
    seen = {"contacts[0].impact.middle.ees(0.6)": ("25 km/h", "2 km/h")}
    assert posterior(row(), RANGE, seen, samples=512, seed=1)["rear.vx"].unit == "m/s"
    with pytest.raises(col.InputError, match=r"ees\(0\.5\)' for half of it"):
        row().as_model([], ["impacts[0].a.ees()"])
    with pytest.raises(col.InputError, match="share must be from 0 to 1"):
        row().as_model([], ["impacts[0].a.ees(1.2)"])


@pytest.mark.slow
def test_the_ends_of_tyre_marks_are_listed_as_results() -> None:
    car = col.Vehicle(mass=1500, yaw_inertia=2500, vx=15, x=0, y=0, heading=0)
    skid = Scene(movers={"A": Mover(car, tyres=Tyres(0.7, 1, 2.7, 1.5))}, contacts=[])
    listed = [path for path in skid.results() if ".marks." in path]
    assert len(listed) == 16
    found = skid.as_model([], listed)()
    assert found["A.marks.front_left.begin.y"].m_as("m") == pytest.approx(0.75, abs=1e-6)
    assert found["A.marks.rear_right.end.x"].m_as("m") > 10.0
    assert not [path for path in row().results() if ".marks." in path]
