"""A record in which something else stands in any place: replay reads or refuses it, and never fails
by another exception; another input is refused or stands on the page that is made of it.
"""

import copy
import json
import math
import warnings

import pytest

import collisions as col
from collisions import reconstruct
from collisions.reporting import options, replay, report
from collisions.scene import Contact, Mover, Run, Scene
from collisions.travel import Tyres
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


def locked() -> Run:
    """Two cars of which one is told to have locked wheels after the contact."""
    movers = {
        "A": Mover(
            A.replace(name="Golf", x=-6.0), outline=(4.6, 1.8), tyres=Tyres(0.7, 0.2, 2.6, 1.5)
        ),
        "B": Mover(B.replace(vy=2.0), outline=(4.4, 1.7), drag=0.7),
    }
    hit = Contact("A", "B", at="touch", delay=0.02, tyres_after={"A": Tyres(0.7, 1.0, 2.6, 1.5)},
                  restitution=0.1, friction=0.4)  # fmt: skip
    grounds = {"both": ("A.tyres.friction", "B.drag")}
    return Scene(movers=movers, contacts=[hit], shared=grounds).run()


def in_line() -> Run:
    movers = {
        name: Mover(body.replace(vx=vx, vy=0.0, y=0.0), drag=0.5)
        for name, body, vx in (("A", A, 12.0), ("B", B, 0.0))
    }
    hit = Contact("A", "B", restitution=0.1, normal=0.0, model="linear_central")
    return Scene(movers=movers, contacts=[hit]).run()


STUCK = {**CONTACT, "friction": 2.0, "law": "kudlich-slibar"}
WHEELS = Tyres(0.7, [1.0, 0.0, 0.0, 1.0], 2.7, 1.5, steer=0.05, height=0.5)
# Of every kind of record one, with what only some have.
KINDS = ANSWERS | {
    "in line": lambda: col.linear_central(A, col.Vehicle(mass=900), 0.2),
    "incomplete": lambda: col.eccentric(A, B, -0.1, incomplete=True, **CONTACT),
    "stronge": lambda: col.oblique_central(A, B, 0.1, normal=0.2, friction=0.3, law="stronge"),
    "ratio": lambda: col.eccentric(A, B, 0.1, normal=7.0, point=(0.0, 0.0), impulse_ratio=-0.1),
    "wheels": lambda: col.eccentric(A, B, 0.1, duration="90 ms", tyres_b=WHEELS, **CONTACT),
    "pushed": lambda: col.eccentric(
        A.replace(pivot=(-2.0, 3.0), vx=0.0, yaw_rate=2.0), B, 0.1, outside_b=(9.0, 5.0), **CONTACT
    ),
    "chosen": lambda: col.solve(A, B, 0.1, tolerance=0.5, duration="90 ms", drag=0.4, **CONTACT),
    "in time": lambda: col.time_resolved(
        A, B, 0.1, crush_b=(4e4, 6e5, 1.5), drag=0.4, wheelbase=2.6, steps=20, **CONTACT
    ),
    "held": lambda: reconstruct.central(1511.0, 1279.0, va=17.3, vb=3.19, energy_loss=51300.0,
        duration=0.0973, drag_a=0.417, drag_b=0.613),
    "stuck": lambda: (lambda impact: reconstruct.planar(
        impact.a.after, impact.b.after, restitution=0.1, regime="sticking", **STUCK
    ))(col.eccentric(A, B, 0.1, **STUCK)),
    "together": lambda: reconstruct.momentum(1200.0, 1800.0, course_a="90 deg", course_b=0.0,
        course_a_after="40 deg", speed_a_after="8 m/s", together=True),
    "run": locked,
    "run in line": in_line,
}  # fmt: skip
WORDS = (
    ("brach", "kudlich-slibar", "stronge"),
    ("friction", "impulse_ratio", "critical_fraction"),
    ("linear_central", "oblique_central", "eccentric", "time_resolved", "solve"),
    ("fixed", "first_contact", "maximum_engagement"),
    ("face", "crossings"),
)


def leaves(part, path=()):
    """Every input of a record, a number or a text, with the way to it; what is empty too."""
    inside = part.items() if isinstance(part, dict) else enumerate(part)
    for key, value in inside:
        if isinstance(value, dict | list) and value:
            yield from leaves(value, (*path, key))
        elif {"inputs", "scene"} & {*path, key}:
            yield (*path, key), value


def other_inputs(value):
    """Others that may stand in the place of an input."""
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int | float):
        # A number that is 0 but for rounding may be another of these.
        return [1.02 * value + 0.01, *([-value] if abs(value) > 1e-9 else [])]
    if isinstance(value, str):
        words = [other for some in WORDS if value in some for other in some if other != value]
        number, _, unit = value.partition(" ")
        more = f"{1.02 * float(number):.6g} {unit}" if number.isdigit() else f"{value}x"
        return [*words, more]
    if value in ({}, []):
        return [{"vx": "3 m/s"}, {"both": ["A.vx", "B.vx"]}, ["A"]]
    return [0.25, "0.25", "brach", "fixed", [1.0, 2.0], [1.0, 2.0, 3.0], True, 30]


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_another_input_is_refused_or_stands_on_the_page(name):
    """Of an input on which no result depends the page made again shows that it is another."""
    with warnings.catch_warnings():
        # A normal without a unit, of more than a turn, is kept as it was given.
        warnings.simplefilter("ignore", col.SuspectUnitsWarning)
        page = report(KINDS[name](), form="markdown", figures=False)
    text, record = page.partition("```json\n")[::2]
    whole = json.loads(record.partition("```")[0])
    asked = 0
    for path, value in leaves(whole):
        if "results" in path or "columns" in path:
            continue
        for other in other_inputs(value):
            changed = put(copy.deepcopy(whole), path, other)
            forged = f"{text}```json\n{json.dumps(changed, indent=1)}\n```\n"
            asked += 1
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", col.CollisionsWarning)
                try:
                    again = replay(forged)
                except col.CollisionsError:
                    continue
                made = report(again, **options(forged))
            assert made == page or made.partition("```json\n")[0] != text, (path, value, other)
    assert asked > 8


@pytest.mark.slow
@pytest.mark.parametrize("name", ["central", "stuck", "speeds"])
def test_a_contact_velocity_is_that_of_the_impact(name):
    """Also where it was changed in all its places: one that is not that of the motions is left out
    of the impact, so that nothing else would show it.
    """
    impact = KINDS[name]()
    page = report(impact, form="markdown", figures=False)
    found = impact.reconstruction.contact_velocity
    others = [[1.0, 2.0]]
    if found is not None:
        closing, slip = found
        others += [None, [closing, slip + 1e-3], [closing * (1.0 - 1e-4), slip]]
    for other in others:

        def change(record, other=other):
            record["impact"]["inputs"]["contact_velocity"] = other
            record["impact"]["results"]["reconstruction"]["contact_velocity"] = other

        with pytest.raises(col.InputError, match="its contact_velocity is ") as caught:
            replay(tampered(page, change))
        assert caught.value.code == "bad_record"
    assert replay(page) == impact


def test_a_record_of_an_impact_that_was_given_has_no_contact_velocity():
    record = AHEAD.to_dict()
    record["inputs"]["contact_velocity"] = [15.0, 0.0]
    with pytest.raises(col.InputError, match="no reverse solver that found one") as caught:
        col.Impact.from_dict(record)
    assert caught.value.code == "bad_record"


def places(record, path=()):
    """The way to every object, list and value below a record."""
    inside = record.items() if isinstance(record, dict) else enumerate(record)
    for key, value in inside:
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [name for name in KINDS if name not in ("chosen", "in time", "run", "run in line")]
)
def test_anything_in_any_place_is_read_or_refused(name):
    """But for those that are slow to solve again. Of the values each third stands in a place, and
    each in every third place.
    """
    with warnings.catch_warnings():
        # The normal of one is more than a turn.
        warnings.simplefilter("ignore", col.SuspectUnitsWarning)
        page = report(KINDS[name](), form="markdown", figures=False)
    whole: dict = {}
    tampered(page, whole.update)
    refused = 0
    for number, path in enumerate(places(whole)):
        for other in OTHERS[number % 3 :: 3]:
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
    assert refused > 150


def test_tyres_of_momentum_that_are_none_are_refused():
    page = report(ANSWERS["momentum"](), form="markdown")
    with pytest.raises(col.InputError) as caught:
        replay(tampered(page, lambda record: record["momentum"]["inputs"].update(tyres_a=True)))
    assert caught.value.code == "bad_record"
