"""A record in which something else stands in any place: replay reads or refuses it, and never fails
by another exception.
"""

import copy
import json
import math
import warnings

import pytest

import collisions as col
from collisions import reconstruct
from collisions.reporting import replay, report
from pages import GONE, put, tampered

A = col.Vehicle(mass="1500 kg", yaw_inertia=2500, vx=12, x=-2.0, y=0.6, heading="0 deg")
B = col.Vehicle(mass=1200, yaw_inertia=1800, vy=9, x=0.9, y=-1.0, heading="90 deg")
CONTACT = {"normal": 0.2, "point": (0.0, 0.0), "friction": 0.3}
AHEAD = col.eccentric(A, B, 0.1, **CONTACT)
COURSES = {"course_a": 0.0, "course_b": "90 deg"}
ANSWERS = {
    "impact": lambda: AHEAD,
    "central": lambda: reconstruct.central(1100.0, 950.0, va=22.0, vb=0.0, vb_after=16.0),
    "planar": lambda: reconstruct.planar(AHEAD.a.after, AHEAD.b.after, restitution=0.1, **CONTACT),
    "speeds": lambda: reconstruct.speeds(
        A, B, restitution=0.1, energy_loss=AHEAD.energy_loss, speed_b=9.0, **COURSES, **CONTACT
    )[0],
    "momentum": lambda: reconstruct.momentum(
        1500.0,
        1200.0,
        **COURSES,
        course_a_after=AHEAD.a.after.course,
        course_b_after=AHEAD.b.after.course,
        speed_a_after=AHEAD.a.after.speed,
        speed_b_after=AHEAD.b.after.speed,
    ),
}
OTHERS = [None, "x", "", 0, 1, -1, True, 1e308, math.nan, 10**400, [], [1], {}, {"a": 1}, GONE]


def places(record, path=()):
    """The way to every object, list and value below a record."""
    inside = record.items() if isinstance(record, dict) else enumerate(record)
    for key, value in inside:
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


@pytest.mark.slow
@pytest.mark.parametrize("name", ANSWERS)
def test_anything_in_any_place_is_read_or_refused(name):
    page = report(ANSWERS[name](), form="markdown")
    whole: dict = {}
    tampered(page, whole.update)
    refused = 0
    for path in places(whole):
        for other in OTHERS:
            record = put(copy.deepcopy(whole), path, other)

            def change(old, record=record):
                old.clear()
                old.update(record)

            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", col.CollisionsWarning)
                    replay(tampered(page, change))
            except col.CollisionsError:
                refused += 1
            except Exception as error:
                raise AssertionError(f"{path} as {json.dumps(str(other))[:40]}") from error
    # Nearly all: what is read is what no answer rests on, such as the version.
    assert refused > 500


def test_tyres_of_momentum_that_are_none_are_refused():
    page = report(ANSWERS["momentum"](), form="markdown")
    with pytest.raises(col.InputError) as caught:
        replay(tampered(page, lambda record: record["momentum"]["inputs"].update(tyres_a=True)))
    assert caught.value.code == "bad_record"
