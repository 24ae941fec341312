"""Arbitrary arguments to ``reconstruct`` and ``travel``: an answer in order, or a CollisionsError;
nothing else, and no hang.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import collisions as col
from collisions import reconstruct, travel
from project.test_fuzz import (
    attempt,
    bodies,
    called_wrongly,
    check_numbers,
    examples,
    look_at_impact,
    must_answer,
)
from strategies import arrays, garbage, never_numbers, numbers, plausible, registries, values

pytestmark = pytest.mark.slow

# What each function takes: names of numbers as ``strategies`` knows them, by keyword.
MASSES = {"mass_a": "mass", "mass_b": "mass"}
CENTRAL = {
    **dict.fromkeys(("va", "vb", "va_after", "vb_after"), "vx"),
    "restitution": "restitution",
    "energy_loss": "energy_loss",
}
COURSES = dict.fromkeys(("course_a", "course_b", "course_a_after", "course_b_after"), "course")
SPEEDS = dict.fromkeys(("speed_a", "speed_b", "speed_a_after", "speed_b_after"), "speed")
IN_LINE = {"delta_v_a": "speed", "delta_v_b": "speed", "energy_loss": "energy_loss"}
KNOWN = {"speed_a": "speed", "speed_b": "speed", **IN_LINE}
PARTS = ("forward", "left")
RULES = ("friction", "impulse_ratio", "critical_fraction")
FUNCTIONS = [0.0, 1.0, -1.0, math.nan, 1e400, "0.5", None]


@pytest.fixture(scope="module", autouse=True)
def _pint_loaded() -> None:
    """The first unit loads pint, which is no example's fault."""
    registries()[0].Quantity(1.0, "km/h").to("m/s")


def one_of(draw: Any, name: str, odd: float, shapes: Any) -> Any:
    """One argument of the kind, or now and then anything."""
    if draw(st.floats(0.0, 1.0)) < odd:
        return draw(garbage())
    return draw(
        st.one_of(
            plausible(name),
            plausible(name),
            numbers(name),
            values(name, shapes),
            arrays(name, shapes),
        )
    )


@st.composite
def keywords(
    draw: Any,
    always: dict[str, str],
    count: int,
    choice: dict[str, str],
    odd: float,
    **options: Any,
) -> dict[str, Any]:
    """All of some arguments, so many of a choice, at times one fewer or more, and the options that
    were drawn.
    """
    shapes = draw(st.sampled_from((((3,),), ((3,),), ((2, 3), (3,), (2, 1)))))
    plain = draw(st.booleans())
    wanted = count + draw(st.sampled_from((0, 0, 0, 0, 0, 0, 0, 0, -1, 1)))
    names = draw(st.permutations(sorted(choice)))[: max(0, wanted)]
    found = {}
    for name, kind in (*always.items(), *((name, choice[name]) for name in names)):
        found[name] = draw(plausible(kind)) if plain else one_of(draw, kind, odd, shapes)
    for name, strategy in options.items():
        value = draw(strategy)
        if value is not None:
            found[name] = value
    if found and draw(st.floats(0.0, 1.0)) < odd:
        found[draw(st.sampled_from(sorted(found)))] = draw(garbage())
    return found


@st.composite
def contacts(draw: Any, odd: float) -> dict[str, Any]:
    """Where and by which law the bodies touch."""
    shapes = ((3,),)
    rule = draw(st.sampled_from(RULES))
    found = {
        "normal": one_of(draw, "normal", odd, shapes),
        "point": (one_of(draw, "point", odd, shapes), one_of(draw, "point", odd, shapes)),
        rule: one_of(draw, rule, odd, shapes),
        "law": draw(st.sampled_from(("brach", "kudlich-slibar"))),
    }
    if draw(st.floats(0.0, 1.0)) < odd:
        found[draw(st.sampled_from(sorted(found)))] = draw(garbage())
    return found


on_failure = st.sampled_from((None, "nan", "raise"))
odd = st.sampled_from((0.0, 0.0, 0.1))


def look_at(found: Any) -> None:
    """Everything that is given back: impacts in full, numbers that are none only where the case was
    refused.
    """
    if isinstance(found, col.AmbiguousSolutionError | col.NoSolutionError):
        for solution in getattr(found, "solutions", ()):
            look_at(solution)
    elif isinstance(found, tuple):
        for part in found:
            look_at(part)
    elif isinstance(found, col.Impact):
        look_at_impact(found)
        assert found.reconstruction is not None
        condition = np.asarray(found.reconstruction.condition, dtype=float)
        assert (np.isnan(condition) | (condition >= 0.0)).all()
    elif isinstance(found, float):
        assert math.isfinite(found)


def answer_of(label: str, call: Any) -> Any:
    """The answer or the refusal, looked at."""
    found = attempt(label, lambda: called_wrongly(call))
    must_answer(f"what {label} gave", lambda: look_at(found))
    return found


@examples(2)
@given(st.data(), odd)
def test_central_of_anything(data: Any, oddity: float) -> None:
    """Any three of the six, or more, or fewer."""
    given_to = data.draw(keywords(MASSES, 3, CENTRAL, oddity, on_failure=on_failure))
    answer_of("central", lambda: reconstruct.central(**given_to))


@examples(2)
@given(st.data(), odd)
def test_momentum_of_anything(data: Any, oddity: float) -> None:
    """Any two speeds, with and without what goes with them."""
    given_to = data.draw(
        keywords(
            {**MASSES, **COURSES},
            2,
            SPEEDS,
            oddity,
            on_failure=on_failure,
            together=st.sampled_from((None, None, True)),
            heading_a=st.sampled_from((None, 0.3)),
            normal=st.sampled_from((None, 0.3, (1.0, 2.0))),
            outside_impulse=st.one_of(
                st.none(), st.tuples(numbers("outside_impulse"), values("outside_impulse", ((3,),)))
            ),
        )
    )
    for name in sorted(COURSES):
        if data.draw(st.integers(0, 9)) == 0:
            given_to.pop(name, None)
    found = answer_of("momentum", lambda: reconstruct.momentum(**given_to))
    if isinstance(found, reconstruct.MomentumSolution):
        status = np.asarray(found.status)
        refused = status > col.Status.ENERGY_GAIN
        for name in (*found.unknowns, "delta_v_a", "delta_v_b", "condition"):
            must_answer(
                name,
                lambda name=name: check_numbers(
                    name, getattr(found, name), refused, status.shape, False
                ),
            )
            must_answer(f"q.{name}", lambda name=name: getattr(found.q, name))
        must_answer("sensitivity", lambda: found.sensitivity.q)
        must_answer("repr", lambda: repr(found) + found._repr_html_())


def some_function(value: Any) -> Any:
    """A caller's function of the closing speed that gives this, or raises it."""

    def restitution(closing: float) -> Any:
        if value is None:
            raise RuntimeError("no")
        return value if value != 0.0 else 1.0 / (1.0 + closing)

    return restitution


@examples(2)
@given(st.data(), odd)
def test_the_in_line_shortcut_of_anything(data: Any, oddity: float) -> None:
    """One delta-V, an energy or two EES; restitution a number or a function."""
    given_to = data.draw(keywords({**MASSES, "restitution": "restitution"}, 1, IN_LINE, oddity))
    if data.draw(st.integers(0, 3)) == 0:
        given_to["restitution"] = some_function(data.draw(st.sampled_from(FUNCTIONS)))
    answer_of("inline_closing_speed", lambda: reconstruct.inline_closing_speed(**given_to))


@examples(2)
@given(st.data(), bodies(), bodies(), odd)
def test_planar_of_anything(data: Any, a: col.Vehicle, b: col.Vehicle, oddity: float) -> None:
    """Any end state, law and one of the three knowns; origins that are answered lead to the end
    they came from.
    """
    choice = {"restitution": "restitution", "closing_speed": "speed", "energy_loss": "energy_loss"}
    regime = st.sampled_from((None, None, "sliding", "sticking", "given", "frictionless", "bad"))
    given_to = data.draw(
        keywords({}, 1, choice, oddity, on_failure=on_failure, regime=regime)
    ) | data.draw(contacts(oddity))
    answer_of("planar", lambda: reconstruct.planar(a, b, **given_to))


@examples()
@given(st.data(), bodies(), bodies(), odd)
def test_speeds_of_anything(data: Any, a: col.Vehicle, b: col.Vehicle, oddity: float) -> None:
    """Two vehicles and two things known of them, single cases and batches, restitution a number or
    a function.
    """
    given_to = data.draw(keywords({"restitution": "restitution"}, 2, KNOWN, oddity)) | data.draw(
        contacts(oddity)
    )
    for name in ("course_a", "course_b"):
        given_to[name] = data.draw(
            st.one_of(plausible("course"), values("course", ((3,),)), st.none())
        )
    if data.draw(st.integers(0, 9)) == 0:
        given_to["restitution"] = some_function(data.draw(st.sampled_from(FUNCTIONS)))
    if data.draw(st.integers(0, 5)) == 0:
        given_to |= {"ees_a": data.draw(numbers("speed")), "ees_b": data.draw(numbers("speed"))}
        for name in sorted(given_to.keys() & KNOWN.keys())[1:]:
            del given_to[name]
    if data.draw(st.integers(0, 2)) == 0:
        side = data.draw(st.sampled_from("ab"))
        for name in KNOWN:
            given_to.pop(name, None)
        given_to |= {f"delta_v_{part}_{side}": data.draw(numbers("vx")) for part in PARTS}
        given_to |= {
            "regime": data.draw(st.sampled_from((None, "sticking", "sliding", "bad"))),
            "slid": data.draw(st.sampled_from((None, "bound", "bad"))),
        }
    answer_of("speeds", lambda: reconstruct.speeds(a, b, **given_to))


@examples()
@given(st.data(), bodies(), bodies(), bodies(), bodies(), odd)
def test_what_motions_show_of_anything(
    data: Any, a: Any, b: Any, c: Any, d: Any, oddity: float
) -> None:
    """Restitution and friction from four vehicles, one of them at times no vehicle at all."""
    place = data.draw(contacts(oddity))
    where = {"normal": place["normal"]} | (
        {"point": place["point"]} if data.draw(st.booleans()) else {}
    )
    motions = [a, b, c, d]
    if data.draw(st.integers(0, 9)) == 0:
        motions[data.draw(st.integers(0, 3))] = data.draw(garbage())
    for function in (reconstruct.restitution, reconstruct.friction):
        answer_of(function.__name__, lambda function=function: function(*motions, **where))


@examples()
@given(st.data(), odd)
def test_crush_energy_of_anything(data: Any, oddity: float) -> None:
    """A profile of any length."""
    count = data.draw(st.integers(0, 5))
    shapes = ((3,),)
    depths = [one_of(data.draw, "width", oddity, shapes) for _ in range(count)]
    widths = [
        one_of(data.draw, "width", oddity, shapes)
        for _ in range(max(0, count + data.draw(st.sampled_from((-1, -1, 0)))))
    ]
    given_to = {"widths": widths, "depths": depths}
    for name in given_to:
        if data.draw(st.integers(0, 5)) == 0:
            given_to[name] = one_of(data.draw, "width", oddity, shapes)
    stiffness = [one_of(data.draw, name, oddity, shapes) for name in ("stiffness_a", "stiffness_b")]
    angle = one_of(data.draw, "angle", oddity, shapes)
    found = answer_of(
        "crush_energy",
        lambda: reconstruct.crush_energy(*given_to.values(), *stiffness, force_angle=angle),
    )
    assert (
        isinstance(found, col.CollisionsError)
        or (np.asarray(found) >= 0.0).all()
        or np.isnan(found).any()
    )


@st.composite
def segments(draw: Any, name: str, count: int, oddity: float) -> Any:
    """One value, or one for each surface."""
    shapes = ((3,),)
    if draw(st.booleans()):
        return one_of(draw, name, oddity, shapes)
    return [
        one_of(draw, name, oddity, shapes)
        for _ in range(max(0, count + draw(st.sampled_from((0, 0, 0, 0, 1, -1)))))
    ]


@examples(2)
@given(st.data(), odd)
def test_straight_travel_of_anything(data: Any, oddity: float) -> None:
    """Speed, time and distance over surfaces; what is answered is not negative."""
    count = data.draw(st.integers(1, 3))
    ground = {name: data.draw(segments(name, count, oddity)) for name in ("drag", "grade")}
    ground["end_speed"] = one_of(data.draw, "speed", oddity, ((3,),))
    length = data.draw(segments("distance", count, oddity))
    start = one_of(data.draw, "speed", oddity, ((3,),))
    for name, first in (("speed", length), ("time", length), ("distance", start)):
        found = answer_of(
            name, lambda name=name, first=first: getattr(travel, name)(first, **ground)
        )
        if not isinstance(found, col.CollisionsError) and found is not None:
            assert (np.asarray(found)[~np.isnan(found)] >= 0.0).all()


@examples(2)
@given(st.data(), odd)
def test_paths_of_anything(data: Any, oddity: float) -> None:
    """Positions, headings and surfaces of a run-out."""
    count = data.draw(st.integers(0, 4))
    points: Any = [
        tuple(one_of(data.draw, "point", oddity, ((3,),)) for _ in "xy") for _ in range(count)
    ]
    if data.draw(st.booleans()):
        points = data.draw(st.one_of(arrays("point", ((2, 2), (3, 2), (3,))), garbage()))
        count = len(points) if isinstance(points, np.ndarray) and points.ndim else count
    headings = data.draw(segments("heading", count, oddity))
    ground = {
        name: data.draw(segments(name, max(1, count - 1), oddity))
        for name in ("friction", "lock", "grade")
    }
    ground["end_speed"] = one_of(data.draw, "speed", oddity, ((3,),))
    found = answer_of("path", lambda: travel.path(points, headings, **ground))
    if isinstance(found, travel.RunOut):
        refused = np.isnan(found.speed)
        for name in ("speed", "course", "yaw_rate", "time", "distance"):
            check_numbers(name, getattr(found, name), refused, np.shape(refused), finite=True)
        must_answer("repr", lambda: repr(found) + found._repr_html_() + str(found.q.speed))


@examples()
@given(
    never_numbers(),
    st.sampled_from(
        ("va", "mass_a", "energy_loss", "speed_a", "course_a", "drag", "distance", "lock", "depths")
    ),
)
def test_what_is_never_a_number_backwards(value: Any, name: str) -> None:
    """Refused wherever a number is wanted."""
    calls = {
        "central": (
            reconstruct.central,
            {"mass_a": 1.0, "mass_b": 1.0, "va": 2.0, "energy_loss": 0.1, "vb": 0.0},
        ),
        "momentum": (
            reconstruct.momentum,
            {
                "mass_a": 1.0,
                "mass_b": 1.0,
                "course_a": 0.0,
                "course_b": 1.0,
                "speed_a": 1.0,
                "speed_b": 2.0,
            }
            | {"course_a_after": 0.2, "course_b_after": 0.4},
        ),
        "path": (
            travel.path,
            {"points": [(0, 0), (1, 0)], "headings": [0.0, 0.1], "friction": 0.7, "lock": 0.3},
        ),
        "time": (travel.time, {"distance": 5.0, "drag": 0.7}),
        "crush_energy": (
            reconstruct.crush_energy,
            {"widths": 1.0, "depths": [0.1, 0.2], "stiffness_a": 1e4, "stiffness_b": 1e5},
        ),
    }
    for label, (function, plain) in calls.items():
        if name in plain:
            spoiled = plain | {name: [value, 0.2] if name == "depths" else value}
            found = attempt(label, lambda function=function, spoiled=spoiled: function(**spoiled))
            assert isinstance(found, col.InputError), f"{name} of {label} was taken as {found!r}"
