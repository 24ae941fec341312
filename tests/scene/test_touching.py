"""Outlines in motion, against what a hand works out: when a corner sweeps into a face, how fast
faces close, which face is struck, and when the impulse acts.
"""

import math

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact
from collisions.scene.follow import _closing_at, _through_crossings
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
    assert _closing_at(contact, states, normal, point)[0] == pytest.approx(closing, rel=1e-12)


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
    normal = _through_crossings(met, crossings, face)[:, 0]
    # The crossings are (0.8, 1) and (1, aside - 1).
    away = np.array([0.2, aside - 2.0])
    through = np.array([-away[1], away[0]]) / np.hypot(*away)
    assert normal == pytest.approx([1.0, 0.0] if in_line else through)
