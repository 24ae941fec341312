"""Vehicles that a slope speeds up: those with a drag that is less than it, and those on wheels that
roll.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Run, Scene
from collisions.travel import GRAVITY, Tyres

OUTLINE = (4.5, 1.8)
LOCKED = Tyres(0.7, 1.0, 2.7, 1.5)
ROLLS = Tyres(0.7, 0.0, 2.7, 1.5)
IN_LINE = {"restitution": 0.1, "normal": 0.0, "model": "linear_central", "at": "touch"}


def car(vx: Any, x: Any, *, outline: Any = OUTLINE, slowed: Any = None, **state: Any) -> Mover:
    given = {"y": 0.0, "heading": 0.0, "vy": 0.0, **state}
    body = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=x, vx=vx, **given)
    return Mover(body, outline=outline, **(slowed or {}))


def missing(run: Run) -> float:
    """The energy that is not accounted for, over that at the start."""
    energy = run.energy
    spent = sum(energy["contacts"]) + energy["ground"] + energy["left"]
    return abs(energy["before"] - spent) / energy["before"]


def gain(fall: Any, drag: Any = 0.0) -> Any:
    """Of a block on an inclined plane, along it."""
    angle = np.arctan(fall)
    return GRAVITY * (np.sin(angle) - drag * np.cos(angle))


@pytest.mark.parametrize("drag", [0.07, 0.0601, 0.06, 0.0599, 0.05, 0.02, 0.0])
@pytest.mark.parametrize("course", [0.0, 2.0])
def test_a_block_on_a_plane_that_falls(drag: float, course: float) -> None:
    """Its place in plan, its speed along the plane and its energy; it turns on where it is not
    slowed.
    """
    c, s = math.cos(course), math.sin(course)
    state = {"vy": 5.0 * s, "heading": 0.3, "yaw_rate": 0.2}
    scene = Scene(
        movers={"A": car(5.0 * c, 0.0, outline=None, slowed={"drag": drag}, **state)},
        contacts=[],
        slope=(-0.06 * c, -0.06 * s),
    )
    found, time, rate = scene.run().at(3.0)["A"], 3.0, gain(0.06, drag)
    way = (5.0 * time + 0.5 * rate * time * time) * math.cos(math.atan(0.06))
    assert (found.x, found.y) == pytest.approx((way * c, way * s), rel=1e-12)
    speed = 5.0 + rate * time
    assert (found.vx, found.vy) == pytest.approx((speed * c, speed * s), rel=1e-12)
    assert found.yaw_rate == pytest.approx(0.2 * min(speed / 5.0, 1.0), rel=1e-9)
    assert found.heading == pytest.approx(
        0.3 + 0.2 * time * min(0.5 * (1.0 + speed / 5.0), 1.0), rel=1e-9
    )


def test_cases_that_a_slope_slows_and_speeds_up_are_those_alone() -> None:
    drags, falls = np.array([0.3, 0.05, 0.0, 0.1, 0.0]), np.array([0.1, 0.1, 0.1, 0.1, 0.0])

    def run_of(drag: Any, fall: Any) -> Run:
        mover = car(6.0, 0.0, outline=None, slowed={"drag": drag}, yaw_rate=0.4)
        return Scene(movers={"A": mover}, contacts=[], slope=(-fall, 0.0)).run()

    many = run_of(drags, falls)
    assert many.status.tolist() == ["ok"] * 5
    time = 2.0
    speed = np.maximum(6.0 + gain(falls, drags) * time, 0.0)
    assert many.at(time)["A"].vx == pytest.approx(speed, rel=1e-12)
    assert np.isfinite(many.rest["A"].x).tolist() == [True, False, False, False, False]
    for case in range(5):
        alone = run_of(drags[case], falls[case]).at(time)["A"]
        for part in ("x", "vx", "heading", "yaw_rate"):
            assert getattr(many.at(time)["A"], part)[case] == pytest.approx(getattr(alone, part))


@pytest.mark.parametrize("drag", [0.02, 0.0])
def test_without_a_place_of_rest_the_slope_is_named(drag: float) -> None:
    mover = car(5.0, 0.0, slowed={"drag": drag})
    run = Scene(movers={"A": mover}, contacts=[], slope=(-0.06, 0.0)).run()
    with pytest.raises(col.MissingInputError, match=r"slope falls by 0.06 .* give a drag= above"):
        _ = run.rest["A"]
    page = col.report(run, figures=False, form="markdown")
    assert f"none: the slope falls by 0.06 along its way, and its drag is {drag:g}" in page
    # What is not on the ground is not on a slope either.
    free = Scene(movers={"A": car(5.0, 0.0)}, contacts=[], slope=(-0.06, 0.0)).run()
    assert free.at(3.0)["A"].vx == 5.0


@pytest.mark.slow
@pytest.mark.parametrize("slowed", [{"drag": 0.02}, {"tyres": Tyres(0.7, 0.02 / 0.7, 2.7, 1.5)}])
def test_a_car_that_rolls_down_into_another(slowed: dict[str, Any]) -> None:
    """Time and closing speed by kinematics along the road; all energy is accounted for."""
    movers = {"A": car(5.0, 0.0, slowed=slowed), "B": car(0.0, 40.0, slowed={"tyres": LOCKED})}
    after = {"A": LOCKED} if "tyres" in slowed else None

    def run_of(slope: Any) -> Run:
        rule = Contact("A", "B", tyres_after=after, **IN_LINE)
        return Scene(movers=movers, contacts=[rule], slope=(slope, 0.0)).run()

    run = run_of(-0.06)
    rate, way = gain(0.06, 0.02), 35.5 / math.cos(math.atan(0.06))
    speed = math.sqrt(25.0 + 2.0 * rate * way)
    assert run.times[0] == pytest.approx((speed - 5.0) / rate, rel=1e-6)
    assert run.impacts[0].closing_speed == pytest.approx(speed, rel=1e-6)
    assert run.impacts[0].b.delta_v == pytest.approx(0.55 * speed, rel=1e-6)
    assert missing(run) < 1e-6
    if after is None:
        return
    # With both wheels locked after it, by which they come to rest.
    stops = (0.45 * speed) ** 2 / (2.0 * -gain(0.06, 0.7)) * math.cos(math.atan(0.06))
    assert run.rest["A"].x == pytest.approx(35.5 + stops, rel=1e-6)
    falls = np.array([0.06, 0.1, 0.0])
    many, level = run_of(-falls), run_of(0.0)
    assert many.status.tolist() == ["ok"] * 3
    assert many.times[0] == pytest.approx([run.times[0], run_of(-0.1).times[0], level.times[0]])
    assert many.rest["A"].x[0] == pytest.approx(run.rest["A"].x, abs=1e-9)


@pytest.mark.slow
def test_two_that_gain_speed_differently() -> None:
    """A begins behind and slower, and its drag is less: it comes to B where both ways are one."""
    movers = {"A": car(3.0, 0.0, slowed={"drag": 0.01}), "B": car(6.0, 24.5, slowed={"drag": 0.05})}
    scene = Scene(
        movers=movers | {"C": car(0.0, -20.0, slowed={"drag": 0.5})},
        contacts=[Contact("A", "B", **IN_LINE)],
        slope=(-0.06, 0.0),
    )
    run = scene.run()
    # 20 m in plan, of an acceleration of 4 % of what presses on the road.
    more, way = gain(0.06, 0.01) - gain(0.06, 0.05), 20.0 / math.cos(math.atan(0.06))
    assert run.times[0] == pytest.approx((3.0 + math.sqrt(9.0 + 2.0 * more * way)) / more, rel=1e-9)
    # A is the slower one after it, and has the smaller drag: it comes to B again and again.
    assert missing(run) < 1e-9


@pytest.mark.parametrize("restitution", [0.0, 1.0])
def test_a_contact_that_lasts_on_a_slope_that_speeds_both_up(restitution: float) -> None:
    """The momentum of both grows by what the slope pulls while they touch, and by that less the
    drags before and after; the energy closes.
    """
    rule = Contact(
        "A", "B", restitution=restitution, friction=0.0, normal=0.0, at="touch", duration=0.12
    )
    movers = {"A": car(8.0, 0.0, slowed={"drag": 0.03}), "B": car(2.0, 9.0, slowed={"drag": 0.02})}
    run = Scene(movers=movers, contacts=[rule], slope=(-0.08, 0.0)).run()
    begin, lasts, end = run.times[0], run.impacts[0].pulse.duration, 4.0
    assert begin + lasts < end
    free = gain(0.08, 0.02) + gain(0.08, 0.03)
    momentum = 10.0 + free * (end - lasts) + 2.0 * gain(0.08) * lasts
    found = run.at(end)
    assert found["A"].vx + found["B"].vx == pytest.approx(momentum, rel=1e-6)
    assert missing(run) < 1e-6


@pytest.mark.slow
def test_what_stops_uphill_and_rolls_back_is_refused_before_it_is_struck() -> None:
    """It stops after 0.9 s and would then roll back, also where only the impact is asked for."""

    def closing(slowed: Any, vx: Any) -> Any:
        movers = {"A": car(vx, -30.0, slowed={"drag": 0.5}), "B": car(2.0, 0.0, slowed=slowed)}
        scene = Scene(movers=movers, contacts=[Contact("A", "B", **IN_LINE)], slope=(0.2, 0.0))
        path = "contacts[0].impact.closing_speed"
        return scene.as_model(["A.vx"], [path])(**{"A.vx": vx})[path].magnitude

    for slowed in ({"drag": 0.02}, {"tyres": ROLLS.replace(lock=0.02)}):
        early = closing(slowed, 60.0)
        assert early > 50.0
        with pytest.raises(
            col.NoSolutionError, match=r"B.* too steep for its (drag|wheels)"
        ) as why:
            closing(slowed, 24.0)
        assert why.value.code == "never_stops"
        with pytest.warns(col.CollisionsWarning, match="1 of 2 cases .*1 never_stops"):
            many = closing(slowed, np.array([24.0, 60.0]))
        assert many == pytest.approx([math.nan, early], nan_ok=True, rel=1e-9)


@pytest.mark.slow
def test_one_that_rolls_back_meanwhile_is_refused_and_a_level_case_beside_it_is_not() -> None:
    """It stops uphill within a second, and could roll anywhere until the others meet. On the level
    it stands.
    """
    movers = {
        "A": car(10.0, 0.0, slowed={"drag": 0.7}),
        "B": car(0.0, 10.0, slowed={"drag": 0.1}),
        "C": car(0.5, 60.0, slowed={"drag": 0.02}),
    }
    hits = [Contact("A", "B", **IN_LINE)]
    asked = ["contacts[0].impact.closing_speed"]
    scene = Scene(movers=movers, contacts=hits, slope=(np.array([0.0, 0.05]), 0.0))
    with pytest.warns(col.CollisionsWarning, match="never_stops"):
        (found,) = scene.as_model([], asked)().values()
    (alone,) = scene.case(0).as_model([], asked)().values()
    assert found.m_as("m/s")[0] == pytest.approx(alone.m_as("m/s"), rel=1e-12)
    assert math.isnan(found.m_as("m/s")[1])
    with pytest.raises(col.NoSolutionError) as refused:
        scene.case(1).as_model([], asked)()
    assert refused.value.code == "never_stops"


@pytest.mark.slow
def test_a_case_that_rolls_back_before_two_contacts_has_the_reason_that_it_has_alone() -> None:
    """The contact of the other two does not come either."""
    movers = {
        "A": car(np.array([4.0, 30.0]), 0.0, slowed={"drag": 0.02}),
        "B": car(0.0, 20.0, slowed={"tyres": LOCKED}),
        "C": car(0.0, 60.0, slowed={"tyres": LOCKED}),
    }
    pairs = [("A", "B"), ("B", "C")]
    hits = [Contact(*pair, **IN_LINE) for pair in pairs]
    scene = Scene(movers=movers, contacts=hits, slope=(0.1, 0.0))
    with pytest.warns(col.CollisionsWarning, match="have no answer"):
        assert scene.run().status[0] == "never_stops"
    with pytest.raises(col.NoSolutionError) as refused:
        scene.case(0).run()
    assert refused.value.code == "never_stops"
    assert str(refused.value).startswith("A")


@pytest.mark.slow
def test_a_car_that_rolls_down_is_refused_where_its_rest_is_asked_for() -> None:
    movers = {
        "A": car(8.0, -10.0, slowed={"tyres": ROLLS}),
        "B": car(0.0, 5.0, slowed={"tyres": LOCKED}),
    }

    def scene(after: Any, slope: Any = -0.05) -> Scene:
        rule = Contact("A", "B", tyres_after=after, **IN_LINE)
        return Scene(movers=movers, contacts=[rule], slope=(slope, 0.0))

    with pytest.raises(col.NoSolutionError, match="A: it does not come to rest, as the slope"):
        scene(None).run()
    path = "contacts[0].impact.closing_speed"
    speed = math.sqrt(64.0 + 2.0 * gain(0.05) * 10.5 / math.cos(math.atan(0.05)))
    # A then rolls on against B, which limits other answers.
    with pytest.warns(col.CollisionsWarning, match="do not part right after their contact"):
        found = scene(None).as_model([], [path])()[path].magnitude
    assert found == pytest.approx(speed, rel=1e-6)
    # One case of a batch whose wheels go on without end is no reason to lose the others.
    lock = np.array([0.0, 1.0])
    some = scene({"A": LOCKED.replace(lock=lock)})
    with (
        pytest.warns(col.CollisionsWarning, match="1 of 2 cases .*1 never_stops"),
        pytest.warns(col.CollisionsWarning, match="do not part right after their contact"),
    ):
        run = some.run()
    alone = scene({"A": LOCKED}).run()
    assert run.status.tolist() == ["never_stops", "ok"]
    assert run.rest["A"].x == pytest.approx([math.nan, alone.rest["A"].x], nan_ok=True)
    assert run.rest["B"].x[1] == pytest.approx(alone.rest["B"].x, abs=1e-9)
    with pytest.warns(col.CollisionsWarning, match="in 1 of 2 cases"):
        both = some.as_model([], [path])()[path].magnitude
    assert both == pytest.approx([speed] * 2, rel=1e-6)


@pytest.mark.slow
def test_a_wheel_that_rolls_on_leaves_the_third_car_behind() -> None:
    """The search for a touch ends where one that gains speed has passed all others."""
    rule = Contact("A", "B", tyres_after={"A": LOCKED}, **IN_LINE)
    movers = {
        "A": car(8.0, -10.0, slowed={"tyres": ROLLS}),
        "B": car(0.0, 60.0, slowed={"tyres": LOCKED}),
        "C": car(0.0, 5.0, slowed={"tyres": LOCKED}, y=6.0),
        "D": car(0.0, -40.0, slowed={"tyres": LOCKED}),
    }
    run = Scene(movers=movers, contacts=[rule], slope=(-0.05, 0.0)).run()
    speed = math.sqrt(64.0 + 2.0 * gain(0.05) * 65.5 / math.cos(math.atan(0.05)))
    assert run.impacts[0].closing_speed == pytest.approx(speed, rel=1e-6)
    assert not run.findings


@pytest.mark.slow
def test_what_nothing_slows_goes_on_from_a_contact_that_lasts_to_the_next() -> None:
    lasts = {"restitution": 0.1, "friction": 0.0, "normal": 0.0, "at": "touch", "duration": 0.1}
    movers = {"A": car(10.0, -10.0), "B": car(0.0, 0.0), "C": car(0.0, 60.0)}
    contacts = [Contact("A", "B", **lasts), Contact("B", "C", **IN_LINE)]
    run = Scene(movers=movers, contacts=contacts).run()
    # Of equal masses the struck one has 1.1 halves of the speed.
    assert run.impacts[1].closing_speed == pytest.approx(5.5, rel=1e-3)
