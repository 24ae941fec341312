"""Contacts at a time: the face is the one struck at first touch, in the scene or before its start;
and what is said to meet there has to meet there.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Run, Scene
from collisions.travel import Tyres

LENGTH, WIDTH = 4.4, 1.8
RULE = {"restitution": 0.1, "friction": 0.5}
STATE = ("x", "y", "heading", "vx", "vy", "yaw_rate")


def mover(tyres: Tyres | None = None, **state: Any) -> Mover:
    body = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, **state)
    return Mover(body, outline=(LENGTH, WIDTH), tyres=tyres)


def engaged(deep: float, aside: float, speeds: tuple[float, float], turn: float = 0.0) -> Scene:
    """Two cars in line that overlap by ``deep`` along and ``aside`` across, and close so."""
    c, s = math.cos(turn), math.sin(turn)
    x, y, (u, v) = deep - LENGTH, WIDTH - aside, speeds
    a = mover(x=c * x - s * y, y=s * x + c * y, heading=turn, vx=c * u - s * v, vy=s * u + c * v)
    movers = {"A": a, "B": mover(x=0.0, y=0.0, heading=turn, vx=0.0)}
    return Scene(movers=movers, contacts=[Contact("A", "B", **RULE)])


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.OutOfRangeWarning")
@pytest.mark.parametrize("turn", [0.0, 2.3])
def test_going_straight_back_the_face_that_parts_first(turn: float) -> None:
    """In closed form: along each direction they part in the overlap over the speed; whichever is
    sooner was the last to touch, and so the first face that was struck.
    """
    c, s = math.cos(turn), math.sin(turn)
    cases = itertools.product((0.1, 0.45, 0.55, 0.8), (0.5, 1.2), (15.0, 0.4), (-0.3, -1.7))
    for deep, aside, along, across in cases:
        rear = deep / along < aside / -across
        expected = (c, s) if rear else (s, -c)
        scene = engaged(deep, aside, (along, across), turn)
        (impact,) = scene.run().impacts
        assert impact.normal == pytest.approx(expected, abs=1e-12)
        swapped = Scene(
            movers={name: scene.movers[name] for name in ("B", "A")},
            contacts=[Contact("B", "A", **RULE)],
        ).run()
        assert swapped.impacts[0].normal == pytest.approx([-part for part in expected], abs=1e-12)
        many = scene.replace({"A.mass": np.array([1500.0, 1800.0])}).run()
        assert np.array(many.impacts[0].normal)[:, 0] == pytest.approx(expected, abs=1e-12)


@pytest.mark.slow
def test_an_offset_rear_end_engaged_by_more_than_its_lateral_overlap() -> None:
    """Its delta-V changes with the engagement as the states do, and not by a factor of a hundred:
    that of the rear given as the face, by `eccentric`.
    """
    for deep in (0.45, 0.55, 0.8):
        scene = engaged(deep, 0.5, (12.0, -0.3))
        (impact,) = scene.run().impacts
        a, b = (scene.movers[name].vehicle for name in "AB")
        # The centroid of the overlap of two rectangles in line.
        point = (-0.5 * LENGTH + 0.5 * deep, 0.5 * WIDTH - 0.25)
        alone = col.eccentric(a, b, 0.1, friction=0.5, normal=0.0, point=point)
        assert impact.b.delta_v == pytest.approx(alone.b.delta_v, rel=1e-9)
        assert impact.b.delta_v > 5.0


def free(rng: np.random.Generator) -> dict[str, dict[str, float]]:
    """Two cars that turn as they come up to each other."""
    course = rng.uniform(-math.pi, math.pi)
    found = {
        "A": {"x": -12.0 * math.cos(course), "y": -12.0 * math.sin(course) + rng.uniform(-1.5, 1.5),
              "heading": course + rng.normal(0.0, 0.4), "vx": 12.0 * math.cos(course),
              "vy": 12.0 * math.sin(course), "yaw_rate": rng.uniform(-1.0, 1.0)},
        "B": {"x": 0.0, "y": 0.0, "heading": rng.uniform(-math.pi, math.pi), "vx": 0.0, "vy": 0.0,
              "yaw_rate": rng.uniform(-1.0, 1.0)},
    }  # fmt: skip
    return found


def scene_of(states: dict[str, dict[str, float]], **contact: Any) -> Scene:
    movers = {name: mover(**state) for name, state in states.items()}
    return Scene(movers=movers, contacts=[Contact("A", "B", **RULE, **contact)])


@pytest.mark.slow
def test_at_a_time_and_from_the_start_it_is_the_face_of_the_touch() -> None:
    """The same contact said in three ways: so long after the touch, at that time, and at 0 of a
    scene that starts with the states there.
    """
    rng, tried = np.random.default_rng(7), 0
    for _ in range(60):
        states, delay = free(rng), rng.uniform(0.02, 0.2)
        try:
            run = scene_of(states, at="touch", delay=delay).run()
        except col.NoSolutionError:
            continue
        time, impact = run.times[0], run.impacts[0]
        if run.deepest[0]:
            continue
        tried += 1
        later = {
            name: {
                part: state[part] + time * state.get(rate, 0.0)
                for part, rate in zip(STATE, ("vx", "vy", "yaw_rate", "", "", ""), strict=True)
            }
            for name, state in states.items()
        }
        for other in (scene_of(states, at=time), scene_of(later)):
            (again,) = other.run().impacts
            assert again.normal == pytest.approx(impact.normal, abs=1e-6)
            assert again.point == pytest.approx(impact.point, abs=1e-6)
            assert again.b.delta_v == pytest.approx(impact.b.delta_v, abs=1e-6)
    assert tried > 25


@pytest.mark.slow
def test_cases_of_a_batch_at_a_time() -> None:
    """As single runs, on wheels, where some touch in the scene and others before it."""
    wheels = Tyres(0.7, 0.3, 2.6, 1.5)
    places = np.array([-6.0, -4.2, -3.7])

    def crash(x: Any) -> Scene:
        movers = {
            "A": mover(wheels, x=x, y=1.3, heading=0.0, vx=12.0, vy=-0.2),
            "B": mover(wheels, x=0.0, y=0.0, heading=0.0, vx=0.0),
        }
        first = Contact("A", "B", restitution=0.0, friction=0.0, normal=0.0, point=(-2.0, 0.6))
        hits = [Contact("A", "B", **RULE, at=0.22)]
        return Scene(movers=movers, contacts=hits if np.all(x < -LENGTH) else [first, *hits])

    run = crash(places[:1] + np.array([0.0, 0.2, -0.1])).run()
    for i in range(3):
        alone: Run = crash(float(places[0] + (0.0, 0.2, -0.1)[i])).run()
        assert alone.impacts[0].normal == pytest.approx((1.0, 0.0), abs=0.05)
        assert np.array(run.impacts[0].normal)[:, i] == pytest.approx(alone.impacts[0].normal)
        assert run.rest["B"].x[i] == pytest.approx(alone.rest["B"].x, abs=1e-6)
    # A second contact of two that are in contact since before the start: the face of the first.
    again = crash(-4.2).run()
    assert abs(again.impacts[1].normal[0]) > 0.9


def test_without_relative_motion_the_face_is_not_decided() -> None:
    """Refused with both faces, where the states are those after the contact."""
    scene = engaged(0.55, 0.5, (0.0, 0.0))
    with pytest.raises(col.InputError, match="not decided which faces met first") as caught:
        scene.run()
    assert caught.value.code == "face_undecided"
    said = str(caught.value)
    assert "(0, -1), along which they overlap by 0.5 m or (1, 0), along" in said
    assert "overlap by 0.55 m" in said
    with pytest.warns(col.CollisionsWarning, match="1 face_undecided"):
        run = scene.replace({"A.vx": np.array([0.0, 12.0])}).run()
    assert run.status.tolist() == ["face_undecided", "ok"]


def apart(gap: Any, point: Any = None, **given: Any) -> Scene:
    movers = {
        "A": mover(x=-gap - LENGTH, y=0.0, heading=0.0, vx=12.0),
        "B": mover(x=0.0, y=0.0, heading=0.0, vx=0.0),
    }
    where = {} if point is None else {"normal": 0.0, "point": point}
    return Scene(movers=movers, contacts=[Contact("A", "B", **(RULE | where | given))])


@pytest.mark.parametrize("at", [0.0, 0.1])
@pytest.mark.parametrize("point", [None, (-2.2, 0.0), (50.0, 0.0)])
def test_a_contact_between_outlines_that_are_apart_is_refused(at: float, point: Any) -> None:
    with pytest.raises(col.InputError, match=f"A and B are 1.5 m apart at {at:g} s") as caught:
        apart(1.5 + 12.0 * at, point, at=at).run()
    assert caught.value.code == "contact_missing"
    assert caught.value.fields["distance"] == pytest.approx(1.5)
    assert "or give `normal=`" not in str(caught.value)
    gaps = np.array([1.5, -0.3]) + 12.0 * at
    with pytest.warns(col.CollisionsWarning, match="1 contact_missing"):
        run = apart(gaps, None if point is None else (-2.2, 0.0), at=at).run()
    assert run.status.tolist() == ["contact_missing", "ok"]


@pytest.mark.parametrize(("gap", "refused"), [(0.45, False), (0.55, True)])
def test_outlines_and_points_are_rough(gap: float, refused: bool) -> None:
    """Half a metre is no contradiction of a normal and a point that are given."""
    for scene in (apart(gap, (-2.2, 0.0)), apart(-0.3, (-2.2, 0.9 + gap))):
        if refused:
            with pytest.raises(col.InputError):
                scene.run()
        else:
            assert len(scene.run().impacts) == 1


def test_a_point_far_from_both_outlines_is_refused() -> None:
    """Its distance from both, and the time; not where either has no outline."""
    for at, gap in ((0.0, -0.3), (0.1, 0.9), ("touch", 3.0)):
        with pytest.raises(
            col.InputError, match=r"the point \(50 m, 0 m\) of the contact"
        ) as found:
            apart(gap, (50.0, 0.0), at=at).run()
        assert found.value.code == "point_outside"
        assert "47.8 m outside that of B" in str(found.value)
    with pytest.warns(col.CollisionsWarning, match="1 point_outside"):
        run = apart(-0.3, (np.array([-2.0, 50.0]), 0.0)).run()
    assert run.status.tolist() == ["ok", "point_outside"]
    scene = apart(-0.3, (50.0, 0.0))
    bare = {**scene.movers, "A": Mover(scene.movers["A"].vehicle)}
    assert len(Scene(movers=bare, contacts=scene.contacts).run().impacts) == 1


def test_a_refusal_says_of_no_normal_that_it_was_given() -> None:
    """Two that slide along each other: the normal is that of the outlines."""
    movers = {
        "A": mover(x=0.0, y=WIDTH, heading=0.0, vx=12.0),
        "B": mover(x=0.0, y=0.0, heading=0.0, vx=0.0),
    }
    with pytest.raises(col.NoImpactError, match=r"the normal is .*\(0, -1\)") as caught:
        Scene(movers=movers, contacts=[Contact("A", "B", **RULE)]).run()
    assert "given" not in str(caught.value)
