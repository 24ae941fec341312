"""Outlines in motion, against what a hand works out: when a corner sweeps into a face, how fast
faces close, which face is struck, and when the impulse acts.
"""

import math

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Scene
from collisions.scene.placing import closing_at, through_crossings
from collisions.scene.touching import (
    Meeting,
    Pair,
    Shape,
    closing_of,
    engaged,
    first_touch,
    meeting,
    overlap_of,
    struck_face,
)
from reference_of_scenes import gaps

SQUARE = Shape.of([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])
CASE = np.array([0])


BAR = Shape.of([(2.0, 0.1), (-2.0, 0.1), (-2.0, -0.1), (2.0, -0.1)])


def evenly(a, b, shapes=(SQUARE, SQUARE)):
    """A pair, of squares if not said, that moves on evenly: x, y, heading, vx, vy and yaw rate of
    each.
    """

    def state(start, time):
        x, y, heading, vx, vy, rate = (np.full(np.shape(time), part) for part in start)
        return np.array([x + vx * time, y + vy * time, heading + rate * time, vx, vy, rate])

    def states(time, cases):
        return state(a, np.asarray(time)), state(b, np.asarray(time))

    # Nothing is said of how fast they may come together: steps follow from the accelerations.
    unbound = np.full(1, math.inf)
    return Pair(
        *shapes, states, lambda cases: np.zeros((4, len(cases))), lambda cases, *both: unbound
    )


@pytest.mark.parametrize("spins", ["a", "b"])
def test_a_corner_that_only_begins_to_approach_is_not_missed(spins):
    """At the start its velocity is along the face; it comes nearer by the turning of its way alone:
    sqrt(2) cos(angle) = distance.
    """
    still, spinning = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (2.2, 0.0, 0.0, 0.0, 0.0, 3.0)
    pair = evenly(spinning, still) if spins == "a" else evenly(still, spinning)
    touch = first_touch(pair, np.zeros(1), np.full(1, 2.0), CASE)
    # The corner at 135 degrees points straight at the other square after 45 more.
    angle = math.radians(45.0) - math.acos(1.2 / math.sqrt(2.0))
    assert touch.time[0] == pytest.approx(angle / 3.0, abs=1e-6)
    assert touch.closing[0] == pytest.approx(
        3.0 * math.sqrt(2.0) * math.sin(math.radians(45.0) - angle), rel=1e-4
    )


@pytest.mark.parametrize("spins", ["a", "b"])
def test_the_far_end_of_a_bar_is_not_missed(spins):
    """It begins slowly and comes round in a second; the near end has just gone past."""
    heading, rate, far = math.radians(10.0), 3.0, 2.001
    bar, square = (1.0 + far, 0.0, heading, 0.0, 0.0, rate), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if spins == "a":
        pair = evenly(bar, square, (BAR, SQUARE))
    else:
        pair = evenly(square, bar, (SQUARE, BAR))
    touch = first_touch(pair, np.zeros(1), np.full(1, 5.0), CASE)
    # The corner that leads, from where it is to where it is the distance of the face away.
    reach, corner = math.hypot(2.0, 0.1), math.atan2(0.1, 2.0)
    turned = math.pi - math.acos(far / reach) - (heading + corner)
    assert touch.time[0] == pytest.approx(turned / rate, abs=1e-6)


def test_faces_that_meet_flat_close_as_fast_as_their_faster_corner():
    """One that yaws brings one end of its face on and takes the other back."""
    pair = evenly((0.0, 0.0, 0.0, 3.0, 0.0, 0.5), (2.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    met, state_a, state_b = pair.at(np.zeros(1), CASE)
    axis = np.array([[1.0], [0.0]])
    assert closing_of(met, axis, state_a, state_b)[0] == pytest.approx(3.0 + 0.5 * 1.0)


@pytest.mark.parametrize(("turn", "most"), [(0.5, 0.5), (-0.5, 1.0)])
def test_faces_that_meet_flat_close_over_the_stretch_in_which_they_overlap(turn, most):
    """The other begins half a metre from the middle: what the face does beyond is of no account."""
    pair = evenly((0.0, 0.0, 0.0, 3.0, 0.0, turn), (2.0, 1.5, 0.0, 0.0, 0.0, 0.0))
    met, state_a, state_b = pair.at(np.zeros(1), CASE)
    axis = np.array([[1.0], [0.0]])
    assert closing_of(met, axis, state_a, state_b)[0] == pytest.approx(3.0 - turn * most)


@pytest.mark.parametrize("turns", ["a", "b"])
@pytest.mark.parametrize(("rate", "aside"), [(0.0, 0.4), (-1.0, 0.4), (2.0, 0.4), (2.0, -0.7)])
def test_a_corner_closes_on_the_part_of_a_turning_face_that_it_comes_to(turns, rate, aside):
    """The face comes on with 3 m/s less what its turning takes back so far from the middle."""
    facing = (0.0, 0.0, -rate, 3.0, 0.0, rate)
    corner = (4.0 + math.sqrt(2.0), aside, math.pi / 4.0, 0.0, 0.0, 0.0)
    pair = evenly(facing, corner) if turns == "a" else evenly(corner, facing)
    touch = first_touch(pair, np.zeros(1), np.full(1, 3.0), CASE)
    # After one second it stands square before the corner.
    assert touch.time[0] == pytest.approx(1.0, abs=1e-8)
    assert touch.closing[0] == pytest.approx(3.0 - rate * aside, rel=1e-6)


def free_pairs(count):
    """Pairs of cars that run at each other and turn: positions, headings and their rates."""
    rng = np.random.default_rng(5)
    for _ in range(count):
        states = []
        for x, speed in ((-6.0, rng.uniform(2.0, 12.0)), (0.0, rng.uniform(-4.0, 1.0))):
            place = [x, rng.uniform(-1.0, 1.0), rng.uniform(-3.0, 3.0)]
            states.append([*place, speed, rng.uniform(-1.0, 1.0), rng.uniform(-3.0, 3.0)])
        yield np.array(states), rng.uniform([3.8, 1.6], [5.0, 2.0], (2, 2))


@pytest.mark.slow
def test_a_touch_closes_as_fast_as_the_gap_between_the_outlines():
    """Of pairs that move freely, one by one and in a batch: by differences of the gap along
    separating axes, just before it is used up.
    """
    keys = ("x", "y", "heading", "vx", "vy", "yaw_rate")
    found = []

    def scene(states, sizes):
        movers = {}
        for name, state, size in zip("AB", states, sizes, strict=True):
            body = col.Vehicle(
                mass=1500.0, yaw_inertia=2500.0, **dict(zip(keys, state, strict=True))
            )
            movers[name] = Mover(body, outline=tuple(size))
        return Scene(movers=movers, contacts=[])

    for states, sizes in free_pairs(60):
        movers = scene(states, sizes).movers

        def gap(time, movers=movers, states=states):
            places = [np.array([*(one[:3] + time * one[3:]), *one[3:]]) for one in states]
            return max(each for each, _ in gaps(movers["A"], movers["B"], *places))

        if gap(0.0) <= 0.01:
            continue
        followed = scene(states, sizes).run()._followed
        for pair in followed._pairs:
            for _, (time,), (closing,) in pair.touched[:1]:
                own = (gap(time - 2e-6) - gap(time - 1e-6)) / 1e-6
                assert gap(time) == pytest.approx(0.0, abs=1e-8)
                assert closing == pytest.approx(own, rel=1e-3, abs=1e-4)
                found.append((states, closing))
    assert len(found) > 20
    # All of them at once, with outlines of one size.
    size = np.array([[4.4, 1.8], [4.4, 1.8]])
    every = np.array([states for states, _ in found])
    one_by_one = [scene(states, size).run()._followed for states in every]
    with pytest.warns(col.CollisionsWarning):
        batch = scene(np.moveaxis(every, 0, -1), size).run()._followed
    of_batch = {}
    for cases, _, closings in batch._pairs[0].touched:
        for case, closing in zip(cases.tolist(), closings.tolist(), strict=True):
            of_batch.setdefault(case, []).append(closing)
    for case, single in enumerate(one_by_one):
        alone = [float(closing[0]) for _, _, closing in single._pairs[0].touched]
        assert of_batch.get(case, []) == pytest.approx(alone, rel=1e-9)


@pytest.mark.slow
def test_the_rule_is_applied_again_from_a_closing_speed_of_the_outlines_of_1_m_s():
    """Two cars part, turning, and touch again as one is struck from behind; where and how fast by
    differences of the gap along the run.
    """
    mass, inertia = (1447.5, 1849.9, 2161.1), (2497.3, 2834.1, 3680.9)
    starts = (
        {"x": -7.0, "y": 0.5334, "heading": -0.014, "vx": 13.27},
        {"x": 0.0, "y": 0.0, "heading": 1.4843, "vy": 4.8821},
        {"x": 3.0666, "y": 4.1746, "heading": -1.1798},
    )
    sizes = (4.457, 1.726), (4.662, 1.831), (4.025, 1.874)

    def crash(drag):
        movers = {
            name: Mover(
                col.Vehicle(mass=mass[i], yaw_inertia=inertia[i], **starts[i]),
                outline=sizes[i],
                drag=(0.3584, 0.2093, drag)[i],
            )
            for i, name in enumerate("ABC")
        }
        contacts = [
            Contact("A", "B", restitution=0.2278, friction=0.2571, at="touch"),
            Contact("B", "C", restitution=0.2192, friction=0.5109, at="touch"),
        ]
        return Scene(movers=movers, contacts=contacts)

    drags = np.array([0.05, 0.08, 0.14, 0.19, 0.22, 0.24])
    again, fast = [], []
    for drag in drags.tolist():
        run = crash(drag).run()
        b, c = run.scene.movers["B"], run.scene.movers["C"]

        def gap(time, run=run, b=b, c=c):
            states = [
                np.array([body.x, body.y, body.heading])
                for body in (run.at(time)[name] for name in "BC")
            ]
            return max(each for each, _ in gaps(b, c, *states))

        begin = run.times[run.pairs.index(("B", "C"))] + 0.3
        after = next(time for time in np.arange(begin, 3.0, 0.005) if gap(time) < 0.0)
        low, high = after - 0.005, after
        for _ in range(40):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if gap(middle) < 0.0 else (middle, high)
        rate = (gap(low - 2e-4) - gap(low - 1e-4)) / 1e-4
        assert abs(rate - 1.0) < 0.15
        again.append(run.pairs.count(("B", "C")) == 2)
        fast.append(bool(rate >= 1.0))
    assert again == fast
    assert 0 < sum(fast) < len(fast)
    batch = crash(drags).run()
    many = [batch.case(i).pairs.count(("B", "C")) for i in range(len(drags))]
    assert [one == 2 for one in many] == fast


@pytest.mark.parametrize(("vx", "vy"), [(-3.0, -1.0), (-1.0, -3.0)])
def test_of_two_faces_at_a_corner_that_with_less_overlap_is_struck(vx, vy):
    """Corner on corner, square to each other: the way in is along the face passed sideways."""
    pair = evenly((0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (2.0, 2.0, 0.0, vx, vy, 0.0))
    which = struck_face(pair, np.zeros(1), np.full(1, 0.1), CASE)
    axis = pair.at(np.zeros(1), CASE)[0].axis(which)[:, 0]
    assert axis == pytest.approx([0.0, 1.0] if abs(vy) < abs(vx) else [1.0, 0.0])


@pytest.mark.parametrize("spins", ["a", "b"])
def test_contact_points_close_by_the_turning_of_either_car(spins):
    """As the velocities of both vehicles at the point have it, along the normal."""
    a = col.Vehicle(mass=1.0, x=0.3, y=-0.2, vx=2.0, vy=0.5, yaw_rate=1.5 * (spins == "a"))
    b = col.Vehicle(mass=1.0, x=3.1, y=0.7, vx=-1.0, vy=0.2, yaw_rate=-2.5 * (spins == "b"))
    point, normal = (1.9, 0.9), (0.8, -0.6)
    states = {
        name: np.array([[one.x], [one.y], [0.0], [one.vx], [one.vy], [one.yaw_rate]])
        for name, one in (("A", a), ("B", b))
    }
    contact = Contact("A", "B", restitution=0.1, friction=0.5, at="touch")
    (of_a, of_b) = (one.velocity_at(point) for one in (a, b))
    closing = sum((p - q) * n for p, q, n in zip(of_a, of_b, normal, strict=True))
    assert closing_at(contact, states, normal, point)[0] == pytest.approx(closing, rel=1e-12)


def along_x(met: Meeting, some):
    """The normal of the face struck, of each of some cases."""
    return np.array([[1.0], [0.0]])


PASSING = ((0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (2.0, 1.0, 0.0, -1.0, 2.0, 0.0))
"""The depth along x is the time, the overlap in y is 1 less twice the time."""


def test_a_pair_that_parts_first_is_taken_at_its_deepest():
    """Where neither overlap is less than the other, after a third of a second."""
    due, parted, _ = engaged(evenly(*PASSING), along_x, np.zeros(1), CASE, np.full(1, 0.6), None)
    assert parted[0]
    assert due[0] == pytest.approx(1.0 / 3.0, abs=1e-6)


@pytest.mark.slow
def test_a_depth_is_counted_along_the_normal():
    """Not along the direction in which the pair is about to part."""
    due, parted, _ = engaged(evenly(*PASSING), along_x, np.zeros(1), CASE, None, np.full(1, 0.45))
    assert not parted[0]
    assert due[0] == pytest.approx(0.45, abs=1e-9)


@pytest.mark.parametrize(("aside", "in_line"), [(0.005, True), (0.05, False)])
def test_outlines_whose_sides_are_in_line_have_no_plane_of_crossings(aside, in_line):
    """Within a centimetre the crossings are the ends of two faces, and the face's normal stays;
    beyond, the plane goes through them: here from corner to corner of the overlap.
    """
    a, b = ((x, y, 0.0, 0.0, 0.0, 0.0) for x, y in ((0.0, 0.0), (1.8, aside)))
    met = meeting(SQUARE, SQUARE, *(np.array(state)[:, None] for state in (a, b)))
    _, area, crossings = overlap_of(met.one, met.other)
    assert area[0] == pytest.approx(0.2 * (2.0 - aside))
    face = np.array([[1.0], [0.0]])
    normal = through_crossings(met, crossings, face)[:, 0]
    # The crossings are (0.8, 1) and (1, aside - 1).
    away = np.array([0.2, aside - 2.0])
    through = np.array([-away[1], away[0]]) / np.hypot(*away)
    assert normal == pytest.approx([1.0, 0.0] if in_line else through)
