"""What the page "The whole crash: scenes" states of touches, on both sides of each limit."""

from itertools import pairwise

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres

BODY = {"mass": 1000.0, "yaw_inertia": 1500.0, "heading": 0.0, "y": 0.0}
OUTLINE = (4.0, 2.0)


def car(x, vx=0.0, **more):
    """A car of 4 m along x, which nothing slows."""
    return Mover(col.Vehicle(**{**BODY, "x": x, "vx": vx, **more}), outline=OUTLINE)


def touching(one, other, restitution=0.0, **how):
    """A rule for their touches; without friction, at once where nothing else is said."""
    return Contact(
        one, other, restitution=restitution, friction=0.0, at="touch", **{"delay": 0.01, **how}
    )


@pytest.mark.parametrize(("closing", "counts"), [(0.018, False), (0.022, True)])
def test_a_touch_counts_that_closes_by_two_centimetres_a_second(closing, counts):
    scene = Scene(movers={"A": car(0.0, closing), "B": car(4.01)}, contacts=[touching("A", "B")])
    if counts:
        assert len(scene.run().impacts) == 1
        return
    with pytest.raises(col.NoSolutionError) as caught:
        scene.run()
    assert caught.value.code == "contact_missing"


@pytest.mark.parametrize("gap", [0.03, 0.07])
def test_a_car_that_comes_back_from_a_wall_meets_the_other_anew(gap):
    """A stops against B, which goes on to the wall and back, at the same speed both ways."""
    wall = Mover(col.Vehicle.barrier(x=6.0 + gap + 1.0, y=0.0, heading=0.0), outline=("2 m", "8 m"))
    scene = Scene(
        movers={"A": car(0.0, 10.0), "B": car(4.0), "wall": wall},
        contacts=[
            touching("A", "B", 1.0, normal=(1.0, 0.0), point=(2.0, 0.0), delay=None),
            touching("B", "wall", 1.0, normal=(1.0, 0.0), point=(6.0, 0.0), delay=None),
        ],
    )
    run = scene.run()
    assert run.pairs[:3] == (("A", "B"), ("B", "wall"), ("A", "B"))
    ways = [later - sooner for sooner, later in pairwise(run.times[:3])]
    assert ways == pytest.approx([gap / 10.0] * 2, rel=1e-6)


def test_a_corner_that_turns_into_another_car_is_a_touch():
    """B turns and goes slowly along the face of A, which stands: the contact points close by the
    turning of B alone.
    """
    turning = car(4.1, vy=0.01, yaw_rate=3.0)
    scene = Scene(movers={"A": car(0.0), "B": turning}, contacts=[touching("A", "B")])
    (impact, *_) = scene.run().impacts
    assert impact.a.after.vx < 0.0 < impact.b.after.vx
    assert impact.b.after.yaw_rate < 3.0


@pytest.mark.parametrize(("angle", "refused"), [(0.8, True), (1.2, False)])
def test_faces_within_a_degree_meet_flat(angle, refused):
    """At bare first touch the point is then refused, as the last digit of a heading decides it."""
    other = car(4.3, heading=f"{angle} deg")
    scene = Scene(
        movers={"A": car(0.0, 10.0), "B": other}, contacts=[touching("A", "B", delay=0.0)]
    )
    if not refused:
        assert len(scene.run().impacts) == 1
        return
    with pytest.raises(col.InputError) as caught:
        scene.run()
    assert caught.value.code == "bare_touch"


@pytest.mark.parametrize(("later", "noted"), [(0.45, False), (0.55, True)])
def test_a_contact_at_a_time_is_that_of_a_touch_half_a_second_before(later, noted):
    """Later than that, the touch is one that no contact describes."""
    scene = Scene(
        movers={"A": car(0.0, 1.0), "B": car(4.5)},
        contacts=[
            Contact(
                "A", "B", restitution=0.0, friction=0.0, normal=(1.0, 0.0), point=(2.5, 0.0),
                at=0.5 + later,
            )
        ],
    )  # fmt: skip
    run = scene.run()
    codes = [finding.code for finding in col.diagnose(run)]
    assert ("touch_without_contact" in codes) is noted
    assert run.times[0] == pytest.approx(0.5 + later)


@pytest.mark.slow
@pytest.mark.parametrize("after", [0.05, 0.2, 0.4, 0.6])
@pytest.mark.parametrize(
    ("push", "hold"), [(0.02, 1.0), (0.02, 0.3), (0.5, 0.5)], ids=["pushes", "presses", "parts"]
)
def test_a_fly_that_hits_one_of_two_in_contact_changes_nothing(push, hold, after):
    """Nor does it make another impact of them, whether they part or are driven together."""
    a, b = (
        Mover(
            col.Vehicle(**{**BODY, "x": x, "y": y, "vx": vx}),
            outline=OUTLINE,
            tyres=Tyres(0.7, lock, 2.6, 1.5),
        )
        for x, y, vx, lock in ((0.0, 0.3, 12.0, push), (5.0, 0.0, 0.0, hold))
    )
    rule = touching("A", "B", 0.1)
    alone = Scene(movers={"A": a, "B": b}, contacts=[rule]).run()
    fly = Mover(col.Vehicle(mass=1e-6, yaw_inertia=1.0, x=50.0, y=0.0, vx=-200.0))
    at = alone.times[0] + after
    hit = Contact("A", "fly", restitution=0.0, friction=0.0, normal=0.0, point=(50, 0), at=at)
    run = Scene(movers={"A": a, "B": b, "fly": fly}, contacts=[rule, hit]).run()
    assert [pair for pair in run.pairs if "fly" not in pair] == [*alone.pairs]
    for name in ("A", "B"):
        assert run.rest[name].x == pytest.approx(alone.rest[name].x, abs=1e-3)
        assert run.rest[name].y == pytest.approx(alone.rest[name].y, abs=1e-3)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("described", [True, False])
def test_two_that_come_nearer_for_longer_than_is_looked_at_are_refused(described: bool) -> None:
    """A creeps down a slope that its drag hardly holds, for 800 s until it is at B."""

    def creeps(gap: object) -> Scene:
        a, b = (
            col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=x, y=0.2, vx=vx, heading=0.0)
            for x, vx in ((-4.3 - gap, 0.5), (0.0, 0.0))
        )
        movers = {
            "A": Mover(a, outline=(4.4, 1.8), drag=0.0100001),
            "B": Mover(b, outline=(4.2, 1.7), drag=0.7),
        }
        hit = Contact("A", "B", restitution=0.1, friction=0.4, at="touch")
        return Scene(movers=movers, contacts=[hit] if described else [], slope=(-0.01, 0.0))

    with pytest.raises(col.NoSolutionError, match="and still come nearer") as caught:
        creeps(400.0).run()
    assert caught.value.code == "touch_undecided"
    both = creeps(np.array([400.0, 10.0])).run()
    assert both.status.tolist() == ["touch_undecided", "ok"]


def test_a_car_that_stops_within_no_time_stands_from_then_on() -> None:
    """Nor is there an overflow on the way, at a time that is 1e308 times as long."""
    body = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=1.0, y=2.0, heading=0.0, vx=1e-309)
    moving = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=9.0, y=9.0, heading=0.0, vx=20.0)
    movers = {
        name: Mover(one, outline=(4.5, 1.8), drag=0.6) for name, one in (("A", body), ("B", moving))
    }
    run = Scene(movers=movers, contacts=[]).run()
    later = run.at(3.0)["A"]
    assert (later.x, later.y, later.vx) == (1.0, 2.0, 0.0)
    assert "<svg" in str(col.play(run))
