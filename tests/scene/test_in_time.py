"""Contacts of a scene that are followed in time: where they begin, what they do, and where they
leave the vehicles.
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.impact.instant import neglected
from collisions.kernels.tyre import wheel_forces
from collisions.reporting import replay
from collisions.scene import Contact, Mover, Run, Scene
from collisions.scene.ledger import tyres_in_part
from collisions.travel import Tyres
from collisions.vehicle.tyres import kernel_numbers
from crashes import three_cars

WHEELS = Tyres(0.7, [1, 0.05, 0.05, 0.05], 2.7, 1.5)
CONTACT: dict[str, Any] = {"restitution": 0.2, "friction": 0.4, "duration": 0.1}


def car(**state: Any) -> col.Vehicle:
    return col.Vehicle(**{"mass": 1500, "yaw_inertia": 2600, "y": 0.0, "heading": 0.0, **state})


def in_line(e: float, duration: float, speed: float = 12.0) -> Run:
    """One car runs into another that is twice as heavy, nothing slows them, and nothing turns."""
    movers = {
        "A": Mover(car(x=-8.0, vx=speed), outline=(4.0, 1.8)),
        "B": Mover(car(x=0.0, mass=3000), outline=(4.0, 1.8)),
    }
    hit = Contact("A", "B", restitution=e, friction=0.5, at="touch", duration=duration)
    return Scene(movers=movers, contacts=[hit]).run()


@pytest.mark.parametrize("e", [0.0, 0.3, 0.8])
def test_a_spring_in_line_leaves_the_cars_where_its_closed_form_has_them(e: float) -> None:
    """Loaded as a linear spring, for a quarter of its period; unloaded by one that returns e
    squared of the work, so that they part when as much of the penetration is undone. 100 steps err
    by 3e-5 of the delta-V, and of the way.
    """
    duration, speed = 0.12, 12.0
    run = in_line(e, duration, speed)
    impact = run.impacts[0]
    assert run.times[0] == pytest.approx(4.0 / speed, rel=1e-9)
    assert impact.a.delta_v == pytest.approx(speed * (1 + e) * 2 / 3, rel=2e-4)
    # The reduced mass is 1000 kg; the way back takes e times as long as that in.
    deepest = speed * duration / (0.5 * math.pi * (1.0 + e))
    parts = run.times[0] + impact.pulse.duration
    assert impact.pulse.duration == pytest.approx(duration, rel=2e-2)
    there = run.at(parts)
    apart = there["B"].x - there["A"].x
    assert apart == pytest.approx(4.0 - (1.0 - e * e) * deepest, abs=3e-3 * deepest)
    middle = (there["A"].x + 2.0 * there["B"].x) / 3.0
    assert middle == pytest.approx((-8.0 + speed * parts) / 3.0, abs=1e-9)
    later = run.at(parts + 2.0)
    assert later["B"].x - later["A"].x - apart == pytest.approx(2.0 * e * speed, rel=2e-3, abs=1e-6)


def test_one_contact_at_the_start_is_that_of_the_solver_to_the_bit() -> None:
    a, b = car(x=-2.2, vx=15.0, y=0.3, name="A"), car(x=0.9, y=-0.9, vy=8.0, heading=1.5, name="B")
    movers = {"A": Mover(a, tyres=WHEELS), "B": Mover(b, tyres=WHEELS)}
    hit = Contact("A", "B", normal=0.0, point=(0.0, 0.1), **CONTACT)
    run = Scene(movers=movers, contacts=[hit]).run()
    given = {"normal": 0.0, "point": (0.0, 0.1), **CONTACT}
    alone = col.time_resolved(a, b, **given, tyres_a=WHEELS, tyres_b=WHEELS)
    assert run.impacts[0] == alone
    # The places given are those of maximum engagement, where the clock of the scene begins.
    assert run.at(0.0)["A"].x == a.x
    assert run.at(0.0)["A"].vx == pytest.approx(alone.a.at_compression.vx, abs=1e-12)


def test_one_at_a_touch_begins_there() -> None:
    """With normal and point given it is the solver's with the geometry of first contact."""
    movers = {
        "A": Mover(car(x=-8.0, vx=15.0, y=0.3), outline=(4.0, 1.8), tyres=WHEELS),
        "B": Mover(car(x=0.9, vy=0.0, heading=1.5), outline=(4.0, 1.8), tyres=WHEELS),
    }
    hit = Contact("A", "B", normal=0.0, point=(-0.3, 0.2), at="touch", **CONTACT)
    run = Scene(movers=movers, contacts=[hit]).run()
    impact = run.impacts[0]
    given = {"normal": 0.0, "point": (-0.3, 0.2), "geometry": "first_contact", **CONTACT}
    alone = col.time_resolved(
        impact.a.before, impact.b.before, **given, tyres_a=WHEELS, tyres_b=WHEELS
    )
    assert impact.a.delta_v == alone.a.delta_v
    ends = run.at(run.times[0] + impact.pulse.duration * (1.0 + 1e-12))
    # What the solver's curves of velocity and yaw rate add up to.
    pulse, before = alone.pulse, impact.a.before
    cos, sin = math.cos(before.heading), math.sin(before.heading)
    dx = cos * pulse.delta_v_forward_a - sin * pulse.delta_v_left_a
    dy = sin * pulse.delta_v_forward_a + cos * pulse.delta_v_left_a
    for name, curve in (
        ("x", before.vx + dx),
        ("y", before.vy + dy),
        ("heading", pulse.yaw_rate_a),
    ):
        way = float(np.trapezoid(curve, pulse.time))
        start = getattr(before, name)
        assert getattr(ends["A"], name) == pytest.approx(start + way, abs=2e-4)


@pytest.mark.slow
def test_a_short_contact_is_that_of_stronges_impulse() -> None:
    """The limit of the solver; the places of rest come nearer in proportion to the duration."""
    movers = {
        "A": Mover(car(x=-8.0, vx=15.0, y=0.5), outline=(4.0, 1.8), tyres=WHEELS),
        "B": Mover(car(x=0.9, heading=1.5), outline=(4.0, 1.8), tyres=WHEELS),
    }
    # With less restitution they touch again, far from the point.
    rule = {"restitution": 0.3, "friction": 0.4, "normal": 0.0, "point": (-0.9, 0.4)}

    def rest(**more: Any) -> Any:
        hit = Contact("A", "B", at="touch", **rule, **more)
        found = Scene(movers=movers, contacts=[hit]).run().rest
        return np.array([(found[name].x, found[name].y) for name in movers])

    instant = rest(law="stronge")
    off = [np.abs(rest(duration=d) - instant).max() for d in (2e-2, 2e-3, 2e-4)]
    assert off[0] > off[1] > off[2]
    assert off[1] < 0.2 * off[0]
    assert off[2] < 5e-3


@pytest.mark.slow
def test_the_way_through_a_contact_is_continuous_and_the_account_closes() -> None:
    base = three_cars().scene
    hits = [contact.replace(model=None, duration=0.1) for contact in base.contacts]
    run = Scene(movers=base.movers, contacts=hits, surfaces=base.surfaces).run()
    assert [impact.model for impact in run.impacts] == ["time_resolved"] * len(run.impacts)
    for time in run.times:
        before, after = run.at(max(time - 1e-9, 0.0)), run.at(time + 1e-9)
        for name in base.movers:
            assert math.dist(
                (before[name].x, before[name].y), (after[name].x, after[name].y)
            ) == pytest.approx(0.0, abs=1e-6)
    energy = run.energy
    kept = energy["before"] - sum(energy["contacts"]) - energy["ground"] - energy["left"]
    assert kept == pytest.approx(0.0, abs=1e-3 * energy["before"])
    for impact in run.impacts:
        assert impact.momentum_residual < 1e-9
    replayed = Run.from_dict(json.loads(json.dumps(run.to_dict())))
    assert replayed == run
    np.testing.assert_equal(replayed.to_columns(), run.to_columns())


@pytest.mark.slow
def test_cases_of_a_batch_equal_single_runs() -> None:
    base = three_cars().scene
    hits = [contact.replace(model=None, duration=0.1) for contact in base.contacts]
    scene = Scene(movers=base.movers, contacts=hits, surfaces=base.surfaces)
    given = {"Camry.vx": np.array([17.0, 17.6, 18.4]), "contacts[0].duration": 0.09}
    with pytest.warns(col.OutOfRangeWarning):
        batch = scene.replace(given).run()
    assert list(batch.status) == ["ok"] * 3
    for case in range(3):
        alone = batch.case(case)
        for name in base.movers:
            assert batch.rest[name].x[case] == pytest.approx(alone.rest[name].x, abs=1e-9)
            assert batch.rest[name].y[case] == pytest.approx(alone.rest[name].y, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("at", [0.0, "touch"])
def test_while_a_contact_lasts_the_cars_move_as_its_curves_say(at) -> None:
    """From first touch, or from maximum engagement on; the ways are sums of the velocities."""
    movers = {
        "A": Mover(car(x=-2.2 if at == 0.0 else -6.0, vx=14.0), outline=(4.4, 1.8), tyres=WHEELS),
        "B": Mover(
            car(x=1.0, y=-0.5, vy=3.0, heading=0.5 * math.pi), outline=(4.4, 1.8), tyres=WHEELS
        ),
    }
    place = {"normal": 0.0, "point": (0.0, 0.2)} if at == 0.0 else {}
    hit = Contact("A", "B", at=at, **CONTACT, **place)
    run = Scene(movers=movers, contacts=[hit]).run()
    impact, begins = run.impacts[0], run.times[0]
    curves = impact.pulse
    # At time 0 the states are those of maximum engagement.
    engaged = float(curves.time[np.argmax(curves.crush)]) if at == 0.0 else 0.0
    for name, label, side in (("A", "a", impact.a), ("B", "b", impact.b)):
        turned = side.before.heading
        ahead, left = (getattr(curves, f"delta_v_{way}_{label}") for way in ("forward", "left"))
        vx = side.before.vx + math.cos(turned) * ahead - math.sin(turned) * left
        vy = side.before.vy + math.sin(turned) * ahead + math.cos(turned) * left
        past = curves.time >= engaged
        time, rate = curves.time[past], getattr(curves, f"yaw_rate_{label}")[past]
        seen = [run.at(begins + moment - engaged)[name] for moment in time]
        assert [one.vx for one in seen] == pytest.approx(vx[past], abs=0.01)
        assert [one.vy for one in seen] == pytest.approx(vy[past], abs=0.01)
        assert [one.yaw_rate for one in seen] == pytest.approx(rate, abs=0.01)
        for part, speed in (("x", vx[past]), ("y", vy[past]), ("heading", rate)):
            way = np.cumsum(0.5 * np.diff(time) * (speed[1:] + speed[:-1]))
            found = np.array([getattr(one, part) for one in seen])
            assert found[1:] - found[0] == pytest.approx(way, abs=2e-3)


@pytest.mark.slow
def test_a_mirrored_scene_has_a_mirrored_answer() -> None:
    """The point comes from the outlines as they lie 0.03 s after first touch, carried back."""
    wheels = Tyres(0.7, 0.3, 2.7, 1.5)

    def rest(side: float) -> Any:
        movers = {
            "A": Mover(car(x=-8.0, vx=15.0, y=0.5 * side), outline=(4.0, 1.8), tyres=wheels),
            "B": Mover(car(x=0.9, vy=3.0 * side, heading=1.4 * side), outline=(4.4, 1.8), drag=0.6),
        }
        hit = Contact("A", "B", at="touch", **CONTACT)
        found = Scene(movers=movers, contacts=[hit]).run().rest
        return [(found[name].x, side * found[name].y) for name in movers]

    np.testing.assert_allclose(rest(1.0), rest(-1.0), atol=1e-9)


def test_a_wall_stays_and_carries_the_normal() -> None:
    wall = col.Vehicle(mass=math.inf, yaw_inertia=math.inf, x=5.0, y=0.0, heading=0.0)
    movers = {
        "A": Mover(car(x=-4.0, vx=12.0, y=0.4, heading=0.1), outline=(4.0, 1.8), tyres=WHEELS),
        "Wall": Mover(wall, outline=("1 m", "4 m")),
    }
    hit = Contact("A", "Wall", at="touch", **CONTACT)
    run = Scene(movers=movers, contacts=[hit]).run()
    assert run.impacts[0].normal == pytest.approx((1.0, 0.0), abs=1e-12)
    assert run.rest["Wall"].x == 5.0
    assert run.rest["A"].vx == 0.0


@pytest.mark.slow
def test_a_row_bumper_to_bumper_is_struck_one_after_another() -> None:
    """While a contact lasts its vehicles have no other; momentum is kept, as nothing slows them."""
    movers = {
        name: Mover(car(x=4.0 * at, vx=10.0 if at == 0 else 0.0), outline=(4.0, 1.8))
        for at, name in enumerate("ABC")
    }
    hits = [Contact(*pair, at="touch", **CONTACT) for pair in ("AB", "BC")]
    run = Scene(movers=movers, contacts=hits).run()
    assert run.pairs[:2] == (("A", "B"), ("B", "C"))
    first = run.impacts[0].pulse.duration
    assert run.times[1] >= run.times[0] + first - 1e-12
    later = run.at(run.end + 1.0)
    assert sum(1500.0 * later[name].vx for name in "ABC") == pytest.approx(15000.0, rel=1e-9)
    energy = run.energy
    assert energy["before"] - sum(energy["contacts"]) == pytest.approx(energy["left"], rel=1e-3)


def test_a_contact_at_a_time_within_another_is_refused() -> None:
    movers = {name: Mover(car(x=9.0 * at, vx=9.0 - 9.0 * at)) for at, name in enumerate("ABC")}
    given = {"normal": 0.0, "point": (4.0, 0.0), **CONTACT}
    hits = [Contact("A", "B", **given), Contact("B", "C", at=0.005, **given)]
    scene = Scene(movers=movers, contacts=hits)
    with pytest.raises(
        col.NoSolutionError, match=r"is at 0.005 s, while another contact"
    ) as caught:
        scene.run()
    assert caught.value.code == "contact_meanwhile"
    with pytest.warns(col.CollisionsWarning, match="1 contact_meanwhile"):
        run = scene.replace({"contacts[1].at": np.array([0.005, 0.5])}).run()
    assert list(run.status) == ["contact_meanwhile", "ok"]


@pytest.mark.slow
@pytest.mark.parametrize("at", [0.0, "touch"])
def test_the_least_model_within_a_tolerance_may_be_that_in_time(at: Any) -> None:
    """``solve`` takes the places to be those of maximum engagement, and the vehicles go on from
    where the contact leaves them.
    """
    x = -2.0 if at == 0.0 else -6.0
    movers = {
        "A": Mover(car(x=x, vx=15.0, y=0.3), outline=(4.0, 1.8), tyres=WHEELS),
        "B": Mover(car(x=0.9, heading=1.5), outline=(4.0, 1.8), tyres=WHEELS),
    }
    place = {"normal": 0.0, "point": (0.0, 0.1)} if at == 0.0 else {}
    hit = Contact("A", "B", at=at, model="solve", tolerance=1e-3, **CONTACT, **place)
    run = Scene(movers=movers, contacts=[hit]).run()
    impact = run.impacts[0]
    assert impact.model == "time_resolved"
    ends = run.times[0] + impact.pulse.duration
    assert run.at(ends)["A"].vx == pytest.approx(impact.a.after.vx, abs=0.3)
    assert run.end > ends
    energy = run.energy
    kept = energy["before"] - sum(energy["contacts"]) - energy["ground"] - energy["left"]
    assert kept == pytest.approx(0.0, abs=1e-3 * energy["before"])


@pytest.mark.slow
def test_a_contact_whose_impulse_is_due_while_another_lasts_waits_for_its_end() -> None:
    """The struck car is touched from behind 13 ms before it is struck; the impulse of that would
    act within the contact, and acts as it ends.
    """

    def mover(x: float, vx: float) -> Mover:
        return Mover(car(x=x, y=0.1 * x, vx=vx), outline=(4.5, 1.8))

    given = {"restitution": 0.1, "friction": 0.5, "at": "touch"}
    run = Scene(
        movers={"A": mover(-8.2, 15.0), "B": mover(0.0, 0.0), "C": mover(8.0, -15.0)},
        contacts=[Contact("A", "B", duration=0.1, **given), Contact("B", "C", **given)],
    ).run()
    assert run.pairs[:2] == (("A", "B"), ("B", "C"))
    first, second = run.times[:2]
    assert first == pytest.approx((8.2 - 4.5) / 15.0, rel=1e-9)
    assert first + 0.1 > (8.0 - 4.5) / 15.0 + 0.03
    assert second == pytest.approx(first + run.impacts[0].pulse.duration, rel=1e-9)


def test_a_drag_does_not_act_during_a_contact_in_time_and_that_is_said() -> None:
    movers = {
        "A": Mover(car(x=-8.0, vx=12.0), outline=(4.0, 1.8), drag=0.7),
        "B": Mover(car(x=0.0), outline=(4.0, 1.8), drag=0.0),
    }
    hit = Contact("A", "B", restitution=0.1, friction=0.5, at="touch", duration=0.1)
    run = Scene(movers=movers, contacts=[hit]).run()
    (notice,) = [one for one in run.findings if one.code == "drag_during_contact"]
    assert "the drag of A does not act" in notice.sentence
    bare = Scene(movers=movers | {"A": movers["A"].replace(drag=0.0)}, contacts=[hit]).run()
    assert all(one.code != "drag_during_contact" for one in bare.findings)


def on_ice(tyres: Any, surfaces: Any, model: str, speed: Any = 8.0 / 3.6) -> Any:
    """A car that is struck from behind at walking pace, on wheels that its brakes hold."""
    hit = Contact(
        "A", "B", restitution=0.3, friction=0.5, normal=0.0, point=(0.0, 0.0), duration=0.12,
        model=model,
    )  # fmt: skip
    movers = {
        "A": Mover(car(x=-2.2, vx=speed), tyres=tyres),
        "B": Mover(car(x=2.2), tyres=tyres),
    }
    return Scene(movers=movers, contacts=[hit], surfaces=surfaces).run()


def around(low: float, high: float, friction: Any) -> Any:
    return [([(-90.0, low), (90.0, low), (90.0, high), (-90.0, high)], friction)]


@pytest.mark.parametrize("model", ["eccentric", "time_resolved"])
@pytest.mark.parametrize(("lock", "there"), [(1.0, 1.0), (0.3, 1.0), (0.1, 0.7)])
def test_tyres_have_the_friction_of_the_ground_while_a_contact_lasts(model, lock, there) -> None:
    """The same as tyres of that friction, whose brakes hold the same force; and no more than the
    friction on this ground can give.
    """
    run = on_ice(Tyres(0.7, lock, 2.7, 1.5), around(-9.0, 9.0, 0.1), model)
    same = on_ice(Tyres(0.1, there, 2.7, 1.5), None, model)
    assert run.impacts[0].b.delta_v == pytest.approx(same.impacts[0].b.delta_v, rel=1e-9)
    assert run.rest["B"].x == pytest.approx(same.rest["B"].x, rel=1e-4)
    taken = math.hypot(run.impacts[0].b.tyre_impulse_x, run.impacts[0].b.tyre_impulse_y)
    most = 0.1 * 1500.0 * col.travel.GRAVITY * 0.13
    assert 0.5 * there * most < taken < most
    batch = on_ice(
        Tyres(0.7, lock, 2.7, 1.5),
        around(-9.0, 9.0, np.array([0.1, 0.7])),
        model,
        np.array([8.0 / 3.6, 3.0]),
    )
    assert batch.impacts[0].b.delta_v[0] == pytest.approx(run.impacts[0].b.delta_v, rel=1e-9)


@pytest.mark.slow
def test_wheels_on_different_ground_have_the_mean_and_that_is_said() -> None:
    """The left wheels are on ice."""
    run = on_ice(Tyres(0.7, 1.0, 2.7, 1.5), around(0.0, 9.0, 0.1), "eccentric")
    assert {one.code for one in run.findings} == {"mixed_friction"}
    assert "of A stand on ground of different friction" in run.findings[0].sentence
    same = on_ice(Tyres(0.4, 1.0, 2.7, 1.5), None, "eccentric")
    assert run.impacts[0].b.delta_v == pytest.approx(same.impacts[0].b.delta_v, rel=1e-9)
    with pytest.warns(col.OutOfRangeWarning, match="in 1 of 2 cases .* different friction"):
        on_ice(Tyres(0.7, 1.0, 2.7, 1.5), around(0.0, 9.0, np.array([0.1, 0.7])), "eccentric")


@pytest.mark.slow
@pytest.mark.parametrize("model", ["eccentric", "solve"])
def test_nor_does_it_act_beside_the_impulse_of_the_tyres_of_the_other(model) -> None:
    """The struck car goes on by the velocity after the impact until the contact has passed."""
    movers = {
        "A": Mover(car(x=-8.0, vx=6.0), outline=(4.0, 1.8), tyres=Tyres(0.7, 0.3, 2.7, 1.5)),
        "B": Mover(car(x=0.0), outline=(4.0, 1.8), drag=0.7),
    }
    given = {"restitution": 0.1, "friction": 0.5, "at": "touch", "model": model, "duration": 0.1}
    more = {"tolerance": 0.05} if model == "solve" else {}
    run = Scene(movers=movers, contacts=[Contact("A", "B", **given, **more)]).run()
    if run.impacts[0].pulse is None:
        meanwhile = run.at(run.times[0] + 0.09)["B"].vx
        assert meanwhile == pytest.approx(run.impacts[0].b.after.vx, rel=1e-12)
    for findings in (run.findings, col.diagnose(run)):
        (notice,) = [one for one in findings if one.code == "drag_during_contact"]
        assert "the drag of B does not act" in notice.sentence
    if run.impacts[0].model == "eccentric":
        left = neglected(run.impacts[0], of_scene=True)
        assert left is not None
        assert left.sentence.startswith("found without the tyres of vehicle B: of delta-V")
        assert left.sentence.endswith("for 0.1 s; give that vehicle its tyres=")
        assert left.assumed == "drag"
    two = {"A": movers["A"].replace(vehicle=car(x=-8.0, vx=np.array([6.0, 7.0])))}
    batch = Scene(movers=movers | two, contacts=[Contact("A", "B", **given, **more)])
    with pytest.warns(col.OutOfRangeWarning) as caught:
        batch.run()
    said = [str(one.message) for one in caught]
    assert any("in 2 of 2 cases of the scene a drag does not act" in one for one in said)


def shunt(gap: Any, **more: Any) -> Run:
    """A runs into B, which stands, and on into C in front of it; all wheels are locked."""
    places = {"A": (-4.6, 14.0), "B": (0.0, 0.0), "C": (4.5 + gap, 0.0)}
    movers = {
        name: Mover(car(x=x, vx=vx), outline=(4.5, 1.8), tyres=Tyres(0.7, 1.0, 2.7, 1.5))
        for name, (x, vx) in places.items()
    }
    rule: dict[str, Any] = {"restitution": 0.1, "friction": 0.4, "duration": 0.15, **more}
    return Scene(
        movers=movers, contacts=[Contact("A", "B", **rule), Contact("B", "C", **rule)]
    ).run()


@pytest.mark.slow
@pytest.mark.parametrize("gap", [0.05, 0.5])
def test_the_ground_takes_no_more_than_friction_over_the_time_of_all_contacts(gap: float) -> None:
    """Contacts of one car that overlap in time: its tyres act once. Coulomb's law bounds what they
    take; of the last contact that is until its duration has passed.
    """
    run = shunt(gap, at="touch", model="eccentric")
    assert run.times[1] - run.times[0] < 0.15
    before, after = run.at(run.times[0] - 1e-6), run.at(run.times[-1])
    taken = 1500.0 * (
        sum(before[name].vx for name in "ABC") - sum(after[name].vx for name in "ABC")
    )
    least = 0.7 * 9.80665 * 1500.0 * 0.15
    assert least < taken <= 3.0 * 0.7 * 9.80665 * 1500.0 * (run.times[-1] + 0.15 - run.times[0])
    found = [one for one in run.findings if one.code == "durations_overlap"]
    second = float(run.times[1])
    assert found[0].time == second
    assert (
        f"the tyres of B act for {second - run.times[0]:.3g} s of its 0.15 s" in found[0].sentence
    )
    impulses = [run.impacts[0].b.tyre_impulse_x, run.impacts[1].a.tyre_impulse_x]
    of_b = sum(abs(one) for one in impulses) / (0.7 * 9.80665 * 1500.0)
    assert of_b <= second + 0.15 - run.times[0] + 1e-9


@pytest.mark.slow
def test_a_contact_at_the_moment_of_another_has_its_tyres_for_nothing() -> None:
    """About the maximum engagement at time 0 both last as long; a later one, of a batch, has what
    half of the first leaves of it.
    """
    movers = {
        name: Mover(car(x=x, vx=vx), tyres=Tyres(0.7, 1.0, 2.7, 1.5))
        for name, (x, vx) in {"A": (-4.0, 14.0), "B": (0.0, 0.0), "C": (5.0, 0.0)}.items()
    }
    rule: dict[str, Any] = {"restitution": 0.1, "friction": 0.4, "normal": 0.0, "duration": 0.15}
    later = np.array([0.0, 0.05, 0.0750001])
    contacts = [
        Contact("A", "B", point=(-2.0, 0.0), at=0.0, model="eccentric", **rule),
        Contact("B", "C", point=(2.5, 0.0), at=later, model="eccentric", **rule),
    ]
    with pytest.warns(col.OutOfRangeWarning, match="in 2 of 3 cases of the scene the tyres"):
        batch = Scene(movers=movers, contacts=contacts).run()
    impulses = [abs(batch.case(i).impacts[1].a.tyre_impulse_x) for i in range(3)]
    of_b = np.array(impulses) / (0.7 * 9.80665 * 1500.0)
    assert of_b == pytest.approx([0.0, 0.05 + 0.15 - 0.075, 0.15], abs=1e-6)


def in_a_row(friction: float, *speeds: float) -> dict[str, Mover]:
    """Three cars with locked wheels, 5 m from one to the next."""
    return {
        name: Mover(car(x=x, vx=vx), tyres=Tyres(friction, 1.0, 2.7, 1.5))
        for name, x, vx in zip("ABC", (-5.0, 0.0, 5.0), speeds, strict=True)
    }


@pytest.mark.parametrize(("first", "second"), [(0.04, 0.1), (0.1, 0.04), (0.1, 0.1)])
def test_contacts_about_one_moment_have_the_tyres_for_the_longest_together(
    first: float, second: float
) -> None:
    """Each has half of its time before it."""
    movers = in_a_row(0.8, 14.0, 6.0, 0.0)
    rule: dict[str, Any] = {"restitution": 0.1, "friction": 0.4, "normal": 0.0}
    rule["model"] = "eccentric"
    contacts = [
        Contact("A", "B", point=(-2.5, 0.0), duration=first, **rule),
        Contact("B", "C", point=(2.5, 0.0), duration=second, **rule),
    ]
    run = Scene(movers=movers, contacts=contacts).run()
    one, two = run.impacts
    taken = -(one.b.tyre_impulse_x + two.a.tyre_impulse_x) / (0.8 * 9.80665 * 1500.0)
    assert taken == pytest.approx(max(first, second), rel=1e-9)
    assert run.at(0.049)["B"].vx == two.a.after.vx


@pytest.mark.parametrize("slope", [0.0, -0.06, 0.06])
@pytest.mark.parametrize(
    ("model", "duration"),
    [("eccentric", None), ("eccentric", 0.01), ("eccentric", 0.05), (None, 0.04)],
)
def test_tyres_do_not_act_again_before_the_longest_duration_has_passed(
    model: Any, duration: float | None, slope: float
) -> None:
    """B is struck for 0.2 s about time 0, and strikes C at 0.02 s, for less time or none."""
    movers = in_a_row(0.8, 14.0, 6.0, 0.0)
    rule: dict[str, Any] = {"restitution": 0.1, "friction": 0.4, "normal": 0.0}
    contacts = [
        Contact("A", "B", point=(-2.5, 0.0), duration=0.2, model="eccentric", **rule),
        Contact("B", "C", point=(2.5, 0.0), at=0.02, duration=duration, model=model, **rule),
    ]
    run = Scene(movers=movers, contacts=contacts, slope=(slope, 0.0)).run(tolerance=1e-8)
    ends = 0.02 + (duration or 0.0) + 0.005
    pull = 9.80665 * math.sin(math.atan(slope))
    slowed = {time: run.at(time)["B"].vx for time in (ends, 0.0999, 0.11, 0.12)}
    # A slope pulls for the half before time 0 as well, until the end, or all within a contact in
    # time.
    twice = 2.0 if model == "eccentric" else 1.0
    assert slowed[ends] - slowed[0.0999] == pytest.approx(twice * pull * (0.0999 - ends), abs=1e-9)
    brakes = 0.8 * 9.80665 * math.cos(math.atan(slope))
    assert slowed[0.11] - slowed[0.12] == pytest.approx(0.01 * (brakes + pull), rel=1e-6)
    energy = run.energy
    closes = energy["before"] - sum(energy["contacts"]) - energy["ground"] - energy["left"]
    assert abs(closes) < 1e-7 * energy["before"]


def chosen(vx: Any, at: Any, **more: Any) -> Run:
    """A car with a wheel jammed runs into the rear corner of one that turns away from it."""
    a = car(x=-6.0, y=0.3, vx=vx, yaw_rate=0.05)
    b = car(x=0.0, heading=1.2, vx=2.0)
    movers = {
        "A": Mover(a, outline=(4.5, 1.8), tyres=Tyres(0.8, [1, 0.05, 0.05, 0.05], 2.7, 1.5)),
        "B": Mover(b, outline=(4.5, 1.8), tyres=Tyres(0.8, 0.05, 2.7, 1.5)),
    }
    place = {} if at == "touch" else {"normal": 0.0, "point": (0.0, 0.3)}
    rule: dict[str, Any] = {"restitution": 0.1, "friction": 0.5, "at": at, **place, **more}
    return Scene(movers=movers, contacts=[Contact("A", "B", **rule)]).run()


def same_way(one: Run, other: Run, number: int | None = None) -> bool:
    """Whether both vehicles come to the same places of rest, one of a case of a batch."""
    ends = [
        [getattr(run.rest[name], part) for name in "AB" for part in ("x", "y", "heading")]
        for run in (one, other)
    ]
    mine = ends[0] if number is None else [end[number] for end in ends[0]]
    return np.allclose(mine, ends[1], rtol=0.0, atol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("at", ["touch", 0.2])
@pytest.mark.parametrize(
    ("tolerance", "model"),
    [(0.001, "time_resolved"), (1.0, "eccentric"), (8.0, "linear_central")],
)
def test_the_least_model_near_enough_moves_on_as_that_model_does(
    at: Any, tolerance: float, model: str
) -> None:
    """In time from first touch; an impulse where that acts, which without a duration of its own
    leaves it to the tyres what they do.
    """
    least = chosen(12.0, at, duration=0.1, model="solve", tolerance=tolerance)
    (impact,) = least.impacts
    assert impact.model == model
    duration = 0.1 if model in ("eccentric", "time_resolved") else None
    if model.endswith("central"):
        # The model itself takes no body that turns; as that of ``solve`` it leaves it turning.
        same = chosen(12.0, at, model="solve", tolerance=100.0)
        assert same.impacts[0].model == model
    else:
        same = chosen(12.0, at, model=model, duration=duration)
    assert least.times == same.times
    assert same_way(least, same)
    assert impact.choice is None if model == "time_resolved" else impact.choice.model == model


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.OutOfRangeWarning")
def test_a_case_that_solve_refuses_at_first_touch_is_that_alone() -> None:
    """At first touch there is no contact about a maximum engagement, and it is followed in time
    from there, in a batch and alone.
    """

    def run_of(x: Any) -> Run:
        states = {
            "A": {"x": -6.735, "y": -0.3298, "heading": 0.0, "vx": 17.293},
            "B": {"x": 0.0, "y": 0.0, "heading": 0.5, "vx": 2.0805, "yaw_rate": 0.5},
            "C": {"x": x, "y": -0.1289, "heading": 0.2, "vx": 0.0},
        }
        tyres = {
            "A": Tyres(0.7, 1.0, 2.7, 1.5),
            "B": Tyres(0.8, 0.3, 2.7, 1.5),
            "C": Tyres(0.8, [1.0, 0.05, 0.05, 0.05], 2.7, 1.5),
        }
        movers = {
            name: Mover(car(**state), outline=(4.5, 1.8), tyres=tyres[name])
            for name, state in states.items()
        }
        rule: dict[str, Any] = {"at": "touch", "restitution": 0.1}
        contacts = [
            Contact("A", "B", friction=0.3, duration=0.2, model="eccentric", depth=0.3, **rule),
            Contact("B", "C", friction=0.6, duration=0.12, model="solve", tolerance=0.1, **rule),
        ]
        surfaces = [([(2, -4), (9, -4), (9, 4), (2, 4)], 0.4)]
        slope = (-0.06879, 0.02)
        return Scene(movers=movers, contacts=contacts, surfaces=surfaces, slope=slope).run()

    alone, batch = run_of(4.92246), run_of(np.array([4.92246, 5.1]))
    assert alone.impacts[1].model == "time_resolved"
    first = batch.case(0)
    assert [one.model for one in first.impacts] == [one.model for one in alone.impacts]
    for name in "ABC":
        assert batch.at(1.0)[name].x[0] == pytest.approx(alone.at(1.0)[name].x, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [0.001, 1.0, 8.0])
def test_an_impact_of_the_least_model_comes_back_from_its_record(tolerance: float) -> None:
    """It is what ``solve`` gives, or the contact in time; its reason holds where it acts."""
    impact = chosen(12.0, "touch", duration=0.1, model="solve", tolerance=tolerance).impacts[0]
    again = col.Impact.from_dict(json.loads(json.dumps(impact.to_dict())))
    assert (again.model, again.b.delta_v) == (impact.model, impact.b.delta_v)
    assert replay(col.report(impact, form="markdown")).b.delta_v == impact.b.delta_v
    if impact.choice is not None:
        assert impact.choice.errors[impact.model] <= tolerance


def test_tyres_in_a_contact_in_time_act_for_what_is_left_of_it_as_it_lasts() -> None:
    """The contact of B and C does not last exactly as long as is stated of it, because tyres act in
    it. Those of B act for all of that time but the 0.08 s that the first contact had already.
    """
    movers = in_a_row(0.7, 16.0, 12.0, 8.0)
    rule: dict[str, Any] = {"restitution": 0.1, "friction": 0.4, "normal": 0.0}
    contacts = [
        Contact("A", "B", point=(-2.5, 0.0), duration=0.2, model="eccentric", **rule),
        Contact("B", "C", point=(2.5, 0.0), at=0.02, duration=0.17, **rule),
    ]
    run = Scene(movers=movers, contacts=contacts).run()
    second = run.impacts[1]
    lasts = second.pulse.duration
    assert abs(lasts - 0.17) > 1e-3
    taken = -second.a.tyre_impulse_x / (0.7 * 9.80665 * 1500.0)
    assert taken == pytest.approx(lasts - (0.1 - 0.02), rel=1e-3)
    (found,) = [one for one in run.findings if one.code == "durations_overlap"]
    assert f"act for {taken:.3g} s" in found.sentence
    assert f"of its {lasts:.3g} s" in found.sentence


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:in . of . cases of the scene two vehicles")
@pytest.mark.parametrize("at", ["touch", 0.2])
def test_cases_of_which_each_has_its_own_least_model_are_those_alone(at: Any) -> None:
    """The faster, the more the models differ."""
    speeds = np.array([11.9, 12.0, 12.1]) if at == 0.2 else np.array([6.0, 9.0, 13.0, 18.0])
    given = {"duration": 0.1, "model": "solve"}
    tolerances = np.resize([0.001, 8.0], len(speeds))
    batch = chosen(speeds, at, tolerance=tolerances, **given)
    models = []
    for number, (speed, tolerance) in enumerate(zip(speeds, tolerances, strict=True)):
        alone = chosen(float(speed), at, tolerance=float(tolerance), **given)
        models.append(alone.impacts[0].model)
        assert same_way(batch, alone, number)
    assert len(set(models)) > 1


@pytest.mark.parametrize("share", [0.0, 0.25, 1.0])
def test_tyres_in_part_have_that_share_of_their_force_at_every_slip(share: float) -> None:
    """Rolling, braked and locked wheels that move ahead, aside and turning."""
    whole = Tyres(0.7, [1.0, 0.3, 0.0, 0.05], 2.7, 1.5)
    part = tyres_in_part(whole, share)
    for direction in ((1.0, 0.0, 0.0), (0.99, 0.02, 0.01), (0.3, 0.9, 0.1), (0.8, 0.1, -0.5)):
        forces = [
            np.array(wheel_forces(own, (own.friction,) * 4, *direction, steered=False,
                                  transfers=False))[:, :2].astype(float) * own.friction
            for own in (kernel_numbers(one.named, np) for one in (whole, part))
        ]  # fmt: skip
        assert forces[1] == pytest.approx(share * forces[0], rel=1e-12, abs=1e-15)
