"""In a batch every output of a refused case is NaN, or None, its status or no text; and a case is
refused exactly as it is alone.

Every number of every call is spoilt in turn, each way in a case of its own of one batch; what
refuses it is found by solving each case alone. Outputs are found by their names, so that a new one
is looked at too.
"""

from __future__ import annotations

import inspect
import math
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cache
from operator import attrgetter
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import collisions as col
from collisions import reconstruct, reference, travel
from collisions.engine.blocks import BLOCK
from collisions.impact.vehicle_result import VehicleResult
from collisions.quantities.attributes import attributes

INF, NAN = math.inf, math.nan
GAIN = col.Status.ENERGY_GAIN
# What every number is spoilt with; what a factor spoils is often no more than another case, which
# then must be answered.
SPOILT = (NAN, INF, -INF, 0.0, -1.0, 2.0, 1e300)
FACTORS = (-1.0, 0.1, 10.0)


@dataclass(frozen=True)
class Call:
    """A call of numbers by name, numbers that it answers, and changes of these that refuse it in
    ways of their own.
    """

    function: Callable[..., Any]
    base: Mapping[str, float]
    changes: tuple[Mapping[str, float], ...] = ()
    # What may stand in a refused case, because it was given for it.
    echoes: tuple[str, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    # Numbers that stay single because the call decides by them what else it needs.
    single: tuple[str, ...] = ()


# ---- the calls ----
CAR_A = {
    "a.mass": 1500.0,
    "a.vx": 15.0,
    "a.vy": 2.0,
    "a.yaw_rate": 0.1,
    "a.yaw_inertia": 2500.0,
    "a.x": -2.0,
    "a.y": 0.3,
    "a.heading": 0.1,
}
CAR_B = {
    "b.mass": 1300.0,
    "b.vx": -3.0,
    "b.vy": 1.0,
    "b.yaw_rate": -0.2,
    "b.yaw_inertia": 2000.0,
    "b.x": 2.0,
    "b.y": -0.4,
    "b.heading": 2.0,
}
CONTACT = {"restitution": 0.2, "normal": 0.1, "point[0]": 0.1, "point[1]": 0.2}
RULES = {"friction": 0.4, "impulse_ratio": 0.1, "critical_fraction": 0.5}
LAWS = ("brach", "kudlich-slibar")
OTHERWISE: dict[str, dict[str, Any]] = {
    "stronge": {"law": "stronge"},
    "stronge, incomplete": {"law": "stronge", "incomplete": True},
    "incomplete": {"incomplete": True},
    "pushed": {"outside_a": (300.0, -100.0, 50.0), "outside_b": (0.0, 200.0, 0.0)},
}


def body(numbers: Mapping[str, Any], label: str) -> col.Vehicle:
    """The vehicle whose numbers begin so."""
    own = {
        name.removeprefix(f"{label}."): value
        for name, value in numbers.items()
        if name.startswith(f"{label}.")
    }
    pivot = pair(own, "pivot")
    return col.Vehicle(**own, pivot=pivot)


def pair(numbers: dict[str, Any], name: str) -> Any:
    """Both parts of a place, taken out of the numbers; None without it."""
    parts = [numbers.pop(f"{name}[{i}]", None) for i in range(2)]
    return None if parts[0] is None else tuple(parts)


def rest_of(numbers: Mapping[str, Any], *labels: str) -> dict[str, Any]:
    """The arguments that are no part of these vehicles."""
    found = {name: value for name, value in numbers.items() if name.partition(".")[0] not in labels}
    for name in ("point", "normal"):
        if f"{name}[0]" in found:
            found[name] = pair(found, name)
    return found


def forward(model: str) -> Callable[..., Any]:
    """A solver of the state before."""

    def call(**numbers: Any) -> Any:
        given = rest_of(numbers, "a", "b")
        return getattr(col, model)(
            body(numbers, "a"), body(numbers, "b"), given.pop("restitution"), **given
        )

    return call


def on_tyres(**numbers: Any) -> Any:
    """An impact during which A's tyres act."""
    tyres = {
        name.removeprefix("tyres_a."): numbers.pop(name)
        for name in list(numbers)
        if name.startswith("tyres_a.")
    }
    return forward("eccentric")(**numbers, tyres_a=travel.Tyres(**tyres))


def left_out(**numbers: Any) -> Any:
    """What the impulse leaves out of such an impact."""
    own = {name: numbers.pop(name) for name in ("duration", "drag")}
    return col.left_out(forward("eccentric")(**numbers), **own)


def methods(**numbers: Any) -> Any:
    """What the methods of an impact give."""
    share, place = numbers.pop("share_a"), pair(numbers, "place")
    impact = forward("eccentric")(**numbers)
    return {
        "ees": impact.ees(share),
        "crush": impact.max_crush_speeds(share),
        "a": impact.a.delta_v_at(place),
        "b": impact.b.delta_v_at(place),
    }


def central(**numbers: Any) -> Any:
    return reconstruct.central(numbers.pop("mass_a"), numbers.pop("mass_b"), **numbers)


def planar(**numbers: Any) -> Any:
    return reconstruct.planar(body(numbers, "a"), body(numbers, "b"), **rest_of(numbers, "a", "b"))


def speeds(**numbers: Any) -> Any:
    return reconstruct.speeds(body(numbers, "a"), body(numbers, "b"), **rest_of(numbers, "a", "b"))


def momentum(**numbers: Any) -> Any:
    for name in ("outside_impulse", "normal"):
        if f"{name}[0]" in numbers:
            numbers[name] = pair(numbers, name)
    return reconstruct.momentum(**numbers)


def observed(name: str) -> Callable[..., Any]:
    """Restitution or friction that four motions show."""

    def call(**numbers: Any) -> Any:
        labels = ("a_before", "b_before", "a_after", "b_after")
        return getattr(reconstruct, name)(
            *(body(numbers, label) for label in labels), **rest_of(numbers, *labels)
        )

    return call


def inline(**numbers: Any) -> Any:
    return reconstruct.inline_closing_speed(**numbers)


def crush(**numbers: Any) -> Any:
    lists = {
        name: [numbers.pop(f"{name}[{i}]") for i in range(count)]
        for name, count in (("widths", 2), ("depths", 3))
    }
    return reconstruct.crush_energy(**lists, **numbers)


def along(function: Callable[..., Any], segments: int) -> Callable[..., Any]:
    """Travel over one surface, or over several."""

    def call(**numbers: Any) -> Any:
        if not segments:
            return function(**numbers)
        lists = {
            name: [numbers.pop(f"{name}[{i}]") for i in range(segments)]
            for name in ("distance", "drag", "grade")
        }
        return function(**lists, **numbers)

    return call


def path(**numbers: Any) -> Any:
    points = [(numbers.pop(f"x[{i}]"), numbers.pop(f"y[{i}]")) for i in range(3)]
    return travel.path(points, [numbers.pop(f"heading[{i}]") for i in range(3)], **numbers)


def simulate(**numbers: Any) -> Any:
    vehicle = col.Vehicle(
        **{name: numbers.pop(name) for name in (*BODY_AT_REST, "vx", "vy", "yaw_rate")}
    )
    slope = numbers.pop("slope[0]", 0.0), numbers.pop("slope[1]", 0.0)
    rest = travel.simulate(vehicle, travel.Tyres(**numbers), slope=slope, moments=2).rest
    return {"x": rest.x, "y": rest.y, "heading": rest.heading, "speed": rest.speed}


BODY_AT_REST = ("mass", "yaw_inertia", "x", "y", "heading")
STATE = tuple(
    f"{side}.{when}.{name}"
    for side in "ab"
    for when in ("before", "after", "at_compression")
    for name in ("mass", "yaw_inertia", "x", "y", "heading", "pivot[0]", "pivot[1]")
)
MOTION = tuple(
    f"{side}.before.{name}"
    for side in "ab"
    for name in (
        "vx",
        "vy",
        "yaw_rate",
        "speed",
        "course",
        "momentum[0]",
        "momentum[1]",
        "kinetic_energy",
    )
)
PLACE = ("normal[0]", "normal[1]", "normal_angle", "point[0]", "point[1]")
FORWARD = (*STATE, *MOTION, *PLACE, "restitution", "friction")
IN_LINE = (
    "a.before.mass",
    "b.before.mass",
    *(f"{side}.{when}.mass" for side in "ab" for when in ("after", "at_compression")),
    "normal[0]",
    "normal[1]",
    "normal_angle",
    "friction",
)
GIVEN = {
    "va": 20.0,
    "vb": 2.0,
    "va_after": 9.6,
    "vb_after": 15.0,
    "restitution": 0.3,
    "energy_loss": 98280.0,
}
STILL = dict.fromkeys(("a.vx", "a.vy", "a.yaw_rate", "b.vx", "b.vy", "b.yaw_rate"), 0.0)
FIXED = {"a.mass": INF, "b.mass": INF, "a.yaw_inertia": INF, "b.yaw_inertia": INF}
JAMMED = {
    **STILL,
    "a.vx": 20.0,
    "a.yaw_inertia": 135.0,
    "a.x": 0.0,
    "a.y": 0.0,
    "b.mass": INF,
    "b.yaw_inertia": INF,
    "normal": 0.0,
    "point[0]": 2.0,
    "point[1]": -1.5,
}


def calls() -> Iterator[tuple[str, Call]]:
    """All of them, by name."""
    free = {**CAR_A, **CAR_B, **CONTACT}
    special = (STILL, FIXED)
    flat = {
        name: 0.0 if name.endswith("yaw_rate") else value
        for name, value in free.items()
        if "point" not in name
    }
    straight = {name: 0.0 if name.endswith(".vy") else value for name, value in flat.items()}
    yield (
        "linear_central",
        Call(forward("linear_central"), {**straight, "normal": 0.0}, special, FORWARD),
    )
    yield (
        "linear_central, vector",
        Call(
            forward("linear_central"),
            {
                **{k: v for k, v in straight.items() if k != "normal"},
                "normal[0]": 2.0,
                "normal[1]": 0.0,
            },
            ({"normal[0]": 0.0},),
            FORWARD,
        ),
    )
    for rule, bound in RULES.items():
        yield (
            f"oblique_central, {rule}",
            Call(forward("oblique_central"), {**flat, rule: bound}, special, FORWARD),
        )
        for law in LAWS:
            jammed = ({**JAMMED, "impulse_ratio": -2.0},) if rule == "impulse_ratio" else ()
            pulls = (
                ({**PULLS, rule: INF if rule == "friction" else 0.5},)
                if rule != "impulse_ratio"
                else ()
            )
            yield (
                f"eccentric, {rule}, {law}",
                Call(
                    forward("eccentric"),
                    {**free, rule: bound},
                    (*special, *jammed, *pulls),
                    FORWARD,
                    {"law": law},
                ),
            )
        for name, options in OTHERWISE.items() if rule == "friction" else ():
            echoes = (
                *FORWARD,
                *(f"{side}.outside_{axis}" for side in "ab" for axis in ("x", "y", "yaw")),
            )
            yield (
                f"eccentric, {name}",
                Call(forward("eccentric"), {**free, rule: bound}, special, echoes, options),
            )
        for tolerance in (0.0, 0.3, 100.0):
            inputs = {**free, rule: bound, "tolerance": tolerance}
            yield (
                f"solve, {rule}, {tolerance}",
                Call(
                    forward("solve"),
                    inputs,
                    special,
                    (*FORWARD, "choice.tolerance"),
                    single=("tolerance",),
                ),
            )
        yield (
            f"required_model, {rule}",
            Call(
                forward("required_model"),
                {**free, rule: bound, "tolerance": 0.3},
                special,
                ("tolerance",),
                single=("tolerance",),
            ),
        )
        pinned = {
            **free,
            "b.vx": 0.0,
            "b.vy": 0.0,
            "b.pivot[0]": 2.5,
            "b.pivot[1]": 1.5,
            rule: bound,
        }
        yield (
            f"eccentric, pinned, {rule}",
            Call(
                forward("eccentric"),
                pinned,
                ({"b.vx": 3.0}, {"a.mass": INF, "a.yaw_inertia": INF, "a.yaw_rate": 0.0}),
                FORWARD,
            ),
        )
    wheels = {"friction": 0.7, "lock": 0.3, "wheelbase": 2.7, "track": 1.5, "height": 0.5}
    yield (
        "eccentric, with tyres",
        Call(
            on_tyres,
            {**free, "friction": 0.4, "duration": 0.1}
            | {f"tyres_a.{name}": value for name, value in wheels.items()},
            ({"tyres_a.height": 2.0},),
            FORWARD,
        ),
    )
    held = {**STILL, "a.vx": 0.4, "duration": 0.3, "drag": 0.7, "restitution": 0.3}
    timed = {**free, "friction": 0.4, "duration": 0.1, "drag": 0.7}
    yield (
        "time_resolved, first_contact",
        Call(
            forward("time_resolved"),
            timed,
            (*special, held, {"drag": -0.1}),
            FORWARD,
            {"geometry": "first_contact", "steps": 25},
        ),
    )
    spinning = {**STILL, "a.vx": 3.0, "a.yaw_rate": 15.0, "duration": 0.5}
    yield (
        "time_resolved",
        Call(forward("time_resolved"), timed, (spinning,), FORWARD, {"steps": 25}),
    )
    yield (
        "left_out",
        Call(left_out, {**free, "friction": 0.4, "duration": 0.1, "drag": 0.7}, special),
    )
    yield (
        "methods",
        Call(
            methods,
            {**free, "friction": 0.4, "share_a": 0.6, "place[0]": 1.0, "place[1]": 0.5},
            special,
            single=("share_a", "place[0]", "place[1]"),
        ),
    )
    names = list(GIVEN)
    for i in range(6):
        for j in range(i):
            for k in range(j):
                known = {names[at]: GIVEN[names[at]] for at in (k, j, i)}
                echoes = (*IN_LINE, *(["restitution"] if "restitution" in known else []))
                yield (
                    f"central, {', '.join(known)}",
                    Call(
                        central,
                        {"mass_a": 1500.0, "mass_b": 1200.0, **known},
                        ({"mass_a": INF, "mass_b": INF},),
                        echoes,
                    ),
                )
    backwards = (*STATE, *PLACE, "friction")
    after = {"a.vx": 3.0, "a.vy": 1.6, "b.vx": 6.0, "b.vy": 1.9}
    for rule, bound in {**RULES, "friction": 0.05}.items():
        for law in LAWS:
            for kind, value in (
                ("restitution", 0.2),
                ("closing_speed", 12.0),
                ("energy_loss", 9e3),
            ):
                if rule == "critical_fraction" and kind == "energy_loss":
                    continue
                inputs = {
                    **{name: part for name, part in free.items() if name != "restitution"},
                    **after,
                    rule: bound,
                    kind: value,
                }
                echoes = (*backwards, *(["restitution"] if kind == "restitution" else []))
                yield (
                    f"planar, {rule}, {law}, {kind}",
                    Call(planar, inputs, (STILL, FIXED), echoes, {"law": law}),
                )
    yawing = tuple(f"{side}.before.yaw_rate" for side in "ab")
    pairs = (
        {"speed_b": 5.0, "delta_v_a": 6.0},
        {"speed_b": 0.0, "delta_v_a": 6.0},
        {"speed_a": 15.0, "energy_loss": 9e4},
        {"delta_v_b": 7.0, "energy_loss": 6e4},
        {"speed_b": 4.0, "ees_a": 6.0, "ees_b": 5.0},
        {"speed_b": 4.0, "max_crush_speed_a": 6.0, "max_crush_speed_b": 5.0},
    )
    still = {name: value for name, value in free.items() if not name.endswith((".vx", ".vy"))}
    # The slowest of all, so each pair has one rule.
    for known, rule, law in zip(pairs, (*RULES, *RULES), (*LAWS, *LAWS, LAWS[0]), strict=False):
        inputs = {**still, rule: RULES[rule], **known, "course_a": 0.1, "course_b": 2.2}
        echoes = (*backwards, *yawing, "restitution")
        yield (
            f"speeds, {rule}, {', '.join(known)}",
            Call(speeds, inputs, (FIXED,), echoes, {"law": law}),
        )
    courses = {"course_a": 0.1, "course_b": 1.7, "course_a_after": 0.9, "course_b_after": 0.5}
    going = {"speed_a": 15.0, "speed_b": 12.0, "speed_a_after": 9.0, "speed_b_after": 8.0}
    balance = {"mass_a": 1500.0, "mass_b": 1300.0, **courses}
    echoes = (
        "mass_a",
        "mass_b",
        *courses,
        "heading_a",
        "heading_b",
        "normal_angle",
        "outside_impulse_x",
        "outside_impulse_y",
    )
    parallel = ({"course_a": 1.7}, {"course_a_after": 0.5})
    for one, other in (
        ("speed_a", "speed_b"),
        ("speed_a_after", "speed_b_after"),
        ("speed_a", "speed_b_after"),
    ):
        known = {name: speed for name, speed in going.items() if name in (one, other)}
        yield f"momentum, {one}, {other}", Call(momentum, {**balance, **known}, parallel, echoes)
    whole = {
        "speed_a_after": 9.0,
        "speed_b_after": 8.0,
        "heading_a": 0.2,
        "heading_b": 1.8,
        "normal": 0.4,
        "outside_impulse[0]": 200.0,
        "outside_impulse[1]": -100.0,
    }
    yield "momentum, everything", Call(momentum, {**balance, **whole}, parallel, echoes)
    yield (
        "momentum, vector",
        Call(
            momentum,
            {
                **balance,
                "speed_a_after": 9.0,
                "speed_b_after": 8.0,
                "normal[0]": 1.0,
                "normal[1]": 0.2,
            },
            parallel,
            echoes,
        ),
    )
    yield (
        "momentum, together",
        Call(
            momentum,
            {name: value for name, value in balance.items() if name != "course_b_after"}
            | {"speed_b": 12.0},
            ({"course_a": 0.9},),
            echoes,
            {"together": True},
        ),
    )
    seen = {}
    for when, motion in (
        ("before", {"a": (15.0, 2.0, 0.1), "b": (-3.0, 1.0, -0.2)}),
        ("after", {"a": (3.0, 1.5, 0.5), "b": (6.0, 1.9, 0.4)}),
    ):
        for label, numbers in motion.items():
            car = {name[2:]: value for name, value in (CAR_A if label == "a" else CAR_B).items()}
            seen |= {
                f"{label}_{when}.{name}": value
                for name, value in {
                    **car,
                    **dict(zip(("vx", "vy", "yaw_rate"), numbers, strict=True)),
                }.items()
            }
    at = {name: value for name, value in CONTACT.items() if name != "restitution"}
    unturned = {name: value for name, value in seen.items() if not name.endswith("yaw_rate")}
    for name in ("restitution", "friction"):
        yield (
            name,
            Call(observed(name), {**seen, **at}, ({f"{side}_before.vx": 0.0 for side in "ab"},)),
        )
        yield f"{name}, unturned", Call(observed(name), {**unturned, "normal": 0.1})
    pins = {f"b_{moment}.{name}": 0.0 for moment in ("before", "after") for name in ("vx", "vy")}
    pins |= {
        f"b_{moment}.pivot[{i}]": part
        for moment in ("before", "after")
        for i, part in enumerate((2.5, 1.5))
    }
    others = (
        {"b_before.vx": 3.0},
        {"b_after.vy": 3.0},
        {"b_before.yaw_inertia": INF, "b_after.yaw_inertia": INF},
    )
    yield "restitution, pinned", Call(observed("restitution"), {**seen, **at, **pins}, others)
    for kind in (
        {"delta_v_a": 6.0},
        {"delta_v_b": 6.0},
        {"energy_loss": 5e4},
        {"ees_a": 6.0, "ees_b": 5.0},
    ):
        numbers = {"mass_a": 1500.0, "mass_b": 1300.0, "restitution": 0.2, **kind}
        yield (
            f"inline_closing_speed, {next(iter(kind))}",
            Call(inline, numbers, ({"mass_a": INF, "mass_b": INF}, {"restitution": 1.0})),
        )
    profile = {
        "widths[0]": 0.4,
        "widths[1]": 0.5,
        "depths[0]": 0.2,
        "depths[1]": 0.3,
        "depths[2]": 0.1,
    }
    yield (
        "crush_energy",
        Call(
            crush,
            {**profile, "stiffness_a": 4e4, "stiffness_b": 6e5, "force_angle": 0.2},
            ({"force_angle": 0.5 * math.pi}, {"force_angle": 2.0}),
        ),
    )
    stiff = {"stiffness_a": 9e5, "stiffness_b": 5e5}
    yield (
        "crush_share",
        Call(reconstruct.crush_share, stiff, (dict.fromkeys(stiff, INF), {"stiffness_a": 0.0})),
    )
    damaged = {"energy": 9e4, "mass_a": 1500.0, "mass_b": 1300.0, "gamma_a": 0.8, "gamma_b": 0.9}
    yield (
        "crush_delta_v",
        Call(
            reconstruct.crush_delta_v, damaged, ({"mass_a": INF, "mass_b": INF}, {"gamma_a": 1.5})
        ),
    )
    surface = {"distance": 20.0, "drag": 0.7, "grade": 0.05, "end_speed": 3.0}
    several = {
        f"{name}[{i}]": value / (i + 1.0)
        for name, value in surface.items()
        if name != "end_speed"
        for i in range(2)
    } | {"end_speed": 3.0}
    downhill = (
        {"drag": 0.0, "grade": -0.4, "end_speed": 1.0},
        {"drag": 0.0, "grade": 0.0, "end_speed": 0.0},
        {"drag": 1e308},
    )
    for name in ("speed", "time"):
        yield name, Call(along(getattr(travel, name), 0), surface, downhill)
        yield (
            f"{name}, several",
            Call(
                along(getattr(travel, name), 2), several, ({"drag[1]": 1e308}, {"drag[0]": 1e308})
            ),
        )
    yield (
        "distance",
        Call(
            along(travel.distance, 0),
            {"speed": 15.0, "drag": 0.7, "grade": 0.05, "end_speed": 3.0},
            downhill,
        ),
    )
    thrown = {"distance": 20.0, "friction": 0.66, "height": 1.0}
    low = ({"height": 40.0}, {"distance": 1e308, "friction": 1e308})
    yield "throw_bounds", Call(lambda **given: travel.throw_bounds(**given)[1], thrown, low)
    yield "throw_speed", Call(travel.throw_speed, {**thrown, "angle": 0.3}, low)
    places = {
        "x[0]": 0.0,
        "x[1]": 6.0,
        "x[2]": 15.0,
        "y[0]": 0.0,
        "y[1]": -1.6,
        "y[2]": -2.3,
        "heading[0]": 0.0,
        "heading[1]": 0.9,
        "heading[2]": 2.0,
    }
    ground = {"friction": 0.7, "lock": 0.3, "grade": 0.02, "end_speed": 2.0}
    yield (
        "path",
        Call(
            path,
            {**places, **ground},
            ({"heading[1]": 4.0}, {"x[1]": 0.0, "y[1]": 0.0}, {"friction": 1e308}),
        ),
    )
    car = {
        "mass": 1500.0,
        "yaw_inertia": 2400.0,
        "x": 1.0,
        "y": 2.0,
        "heading": 0.3,
        "vx": 6.0,
        "vy": 1.0,
        "yaw_rate": 1.0,
    }
    size = {"wheelbase": 2.7, "track": 1.5, "height": 0.5}
    wheels = {"friction": 0.7, "lock": 1.0, "steer": 0.1, **size, "slope[0]": 0.01, "slope[1]": 0.0}
    yield (
        "simulate",
        Call(
            simulate,
            {**car, **wheels},
            ({"friction": 0.0}, {"slope[0]": 0.9}, {"height": 2.0}, {"mass": math.inf}),
        ),
    )
    yield (
        "reference.restitution",
        Call(
            reference.restitution,
            {"closing_speed": 3.0},
            ({"closing_speed": 30.0}, {"closing_speed": 0.01}),
        ),
    )
    yield "reference.restitution_range", Call(reference.restitution_range, {"closing_speed": 3.0})
    yield (
        "reference.yaw_inertia",
        Call(reference.yaw_inertia, {"mass": 1500.0, "wheelbase": 2.7, "length": 4.5}),
    )
    yield (
        "reference.yaw_inertia, width",
        Call(reference.yaw_inertia, {"mass": 1500.0, "length": 4.5, "width": 1.8}),
    )


def pulling() -> dict[str, float]:
    """Found by search: levers and slip such that a contact without slip would need a pull."""
    generator = np.random.default_rng(3)
    for _ in range(10_000):
        ax, ay, bx, by, vy = (float(number) for number in generator.uniform(-2.5, 2.5, 5))
        changes = {
            **STILL,
            "a.vx": 0.2,
            "a.vy": 8.0 * vy,
            "a.x": ax,
            "a.y": ay,
            "b.x": bx,
            "b.y": by,
            "a.yaw_inertia": 400.0,
            "b.yaw_inertia": 400.0,
            "restitution": 0.1,
            "normal": 0.0,
            "point[0]": 0.0,
            "point[1]": 0.0,
        }
        impact = forward("eccentric")(**{**CAR_A, **CAR_B, **CONTACT, "friction": 0.0, **changes})
        if math.isinf(impact.critical_impulse_ratio):
            return changes
    raise AssertionError("none found")


PULLS = pulling()
CALLS = dict(calls())


# ---- what comes back ----
ARGUMENTS = {"share_a": 0.5, "point": (1.0, 2.0)}
ARGUMENTS |= {"time": 0.03, "forward": 0.4, "left": -0.1, "axes": "turning"}
# Of the whole call, not of a case of it.
WHOLE = (
    "model",
    "law",
    "name",
    "method",
    "reason",
    "missing",
    "known",
    "found",
    "unknowns",
    "choice",
    "reconstruction",
    "left_backwards",
)


def outputs(found: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Every output by the way to it: fields, what is worked out, and what methods give."""
    dot = f"{name}." if name else ""
    if isinstance(found, Mapping):
        for key, value in found.items():
            yield from outputs(value, f"{dot}{key}")
    elif isinstance(found, tuple):
        for i, part in enumerate(found):
            yield from outputs(part, f"{name}[{i}]")
    elif isinstance(found, (col.Impact, VehicleResult)) or is_dataclass(found):
        kind = type(found)
        given = (
            [f.name for f in fields(found) if not f.name.startswith("_") and f.name != "given"]
            if is_dataclass(found)
            else []
        )
        for key in (
            *given,
            *attributes(kind),
            *(["model"] if isinstance(found, col.ModelChoice) else []),
        ):
            try:
                value = getattr(found, key)
            except col.MissingInputError:
                assert isinstance(found, col.Vehicle), f"{dot}{key} is not given"
                continue
            yield from outputs(value, dot + key)
        for key, member in vars(kind).items():
            if (
                inspect.isfunction(member)
                and hasattr(member, "unit")
                and not isinstance(found, col.Vehicle)
            ):
                arguments = {
                    part: ARGUMENTS[part] for part in list(inspect.signature(member).parameters)[1:]
                }
                if key == "recorded" and found._inputs.model != "time_resolved":
                    continue  # an impulse takes no time
                yield from outputs(getattr(found, key)(**arguments), f"{dot}{key}()")
    else:
        yield name, found


def at(value: Any, shape: tuple[int, ...], case: int) -> Any:
    """What an output is in one case."""
    return (
        np.broadcast_to(value, shape).reshape(-1)[case].item()
        if isinstance(value, np.ndarray)
        else value
    )


def is_nothing(value: Any) -> bool:
    """Whether this is the null of its kind."""
    return value is None or value == "" or (isinstance(value, float) and math.isnan(value))


def of_all_cases(named: Iterable[tuple[str, Any]]) -> Iterator[tuple[str, Any]]:
    """Outputs but for the slip of a contact that may have stuck, a pair in a batch with one such
    case and none in a case that is none.
    """
    return (pair for pair in named if not pair[0].startswith("reconstruction.slip_if_stuck"))


def check_case(
    label: str,
    found: Any,
    shape: tuple[int, ...],
    case: int,
    echoes: tuple[str, ...],
    whole: list[tuple[str, Any]] | None = None,
) -> None:
    """No output of a refused case says anything but how it was refused; ``whole`` are the outputs
    of all cases, where they are at hand.
    """
    for name, value in whole or outputs(found):
        value, last = at(value, shape, case), name.rpartition(".")[2].partition("[")[0]
        what = f"{label}: {name} is {value!r} in a refused case"
        if last == "status":
            assert value > GAIN, what
        elif last in ("ok", "refused", "complete"):
            assert value is (last == "refused"), what
        elif last == "answers":
            status = int(at(np.asarray(found.status), shape, case))
            assert value == 0 or (value > 1 and "AMBIGUOUS" in col.Status(status).name), what
        elif name not in echoes and last not in WHOLE:
            assert is_nothing(value), what


def quietly(call: Callable[[], Any]) -> Any:
    """The answer, or the refusal, of a call of which nothing is said."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", col.CollisionsWarning)
        return call()


@cache
def columns_of(name: str) -> list[dict[str, float]]:
    """Every case of a call: as it is, and spoilt in every way."""
    call = CALLS[name]
    base = call.base
    found = [dict(base)]
    for number, value in base.items():
        if number not in call.single:
            found += [
                {**base, number: worse}
                for worse in (*SPOILT, *(factor * value for factor in FACTORS))
                if worse != value
            ]
    if name == "simulate":
        # Each way to rest is integrated: a third of them, of every number some.
        found = found[::3]
    return found + [{**base, **changes} for changes in call.changes]


@cache
def alone(name: str, case: int) -> Any:
    """The answer to one case of a call, or the error that refuses it."""
    call = CALLS[name]
    try:
        return quietly(lambda: call.function(**columns_of(name)[case], **call.options))
    except col.CollisionsError as error:
        return error


def together(
    call: Call,
    columns: list[dict[str, float]],
    varied: set[str] | None = None,
    shape: Any = -1,
    kind: Any = float,
) -> Any:
    """The answer to all cases at once; numbers that are not varied stay single."""
    numbers: dict[str, Any] = dict(call.base)
    for name in call.base:
        if name not in call.single and (varied is None or name in varied):
            with np.errstate(over="ignore"):
                numbers[name] = (
                    np.array([case[name] for case in columns]).astype(kind).reshape(shape)
                )
    return quietly(lambda: call.function(**numbers, **call.options))


def parts(found: Any) -> list[Any]:
    """The answers that have refused cases of their own: the roots of ``speeds``, else the answer
    itself.
    """
    return (
        list(found)
        if isinstance(found, tuple) and found and isinstance(found[0], col.Impact)
        else [found]
    )


def at_rest(impact: Any, output: str) -> bool:
    """Whether this is the course of a vehicle at rest, to which rounding may give one."""
    return (
        output.endswith(".course")
        and attrgetter(output.removesuffix("course") + "speed")(impact) < 1e-12
    )


def check(name: str, chosen: Sequence[int], found: Any, shape: tuple[int, ...]) -> tuple[int, int]:
    """Looks at these cases of a call in the answer to all of them; gives how many were answered and
    how many refused.
    """
    call, columns = CALLS[name], columns_of(name)
    answered = refused = 0
    # Of all cases at once, and once for all: some follow every case again.
    wholes = [list(outputs(part)) for part in parts(found)]
    for number, case in enumerate(chosen):
        one = alone(name, case)
        is_refused = isinstance(one, col.CollisionsError)
        answered, refused = answered + (not is_refused), refused + is_refused
        here = (
            f"{name}, "
            f"{ ({key: value for key, value in columns[case].items() if value != call.base[key]}) }"
        )
        for place, (part, whole) in enumerate(zip(parts(found), wholes, strict=True)):
            status = at(
                np.asarray(getattr(part, "status", GAIN if not is_refused else GAIN + 1)),
                shape,
                number,
            )
            if place == 0:
                assert (status > GAIN) == is_refused, (
                    f"{here}: {col.Status(status).label}, and alone {one!r}"
                )
            if status > GAIN:
                check_case(here, part, shape, number, call.echoes, whole)
            elif place == 0:
                for (output, value), (same, value_alone) in zip(
                    of_all_cases(whole), of_all_cases(outputs(parts(one)[0])), strict=True
                ):
                    assert output == same
                    if isinstance(value_alone, np.ndarray) or at_rest(parts(one)[0], output):
                        # a history of the contact, which a batch does not keep; a course that is
                        # none
                        continue
                    value = at(value, shape, number)
                    assert is_nothing(value) == is_nothing(value_alone), (
                        f"{here}: {output} is {value!r}, alone {value_alone!r}"
                    )
    return answered, refused


# Of the many ways to call a solver these are for every run; the rest is slow.
EVERY_RUN = (
    "linear_central",
    "oblique_central, friction",
    "eccentric, friction, brach",
    "eccentric, pinned, friction",
    "solve, friction, 0.3",
    "planar, friction, brach, restitution",
    "speeds, friction, speed_b, delta_v_a",
    "central, va, vb, restitution",
    "central, va, va_after, energy_loss",
    "restitution",
    "friction",
)
LONG = (
    "linear_central", "oblique_central", "eccentric", "solve", "planar", "speeds", "central",
    "restitution", "friction", "simulate",
    "time_resolved",
)  # fmt: skip


def of_calls(names: Iterable[str]) -> Any:
    """A test of each of these calls, of which the long ones are slow."""
    return pytest.mark.parametrize(
        "name",
        [
            pytest.param(
                name,
                marks=pytest.mark.slow if name.startswith(LONG) and name not in EVERY_RUN else (),
            )
            for name in names
        ],
    )


every_call = of_calls(CALLS)


@pytest.mark.slow
@every_call
def test_every_output_of_a_refused_case(name: str) -> None:
    """Each number of the call spoilt in turn, all in one batch; refused exactly where the case
    alone is.
    """
    columns = columns_of(name)
    answered, refused = check(
        name, range(len(columns)), together(CALLS[name], columns), (len(columns),)
    )
    assert answered
    assert refused


@pytest.mark.slow
def test_a_start_that_is_hard_to_find_is_found_beside_others() -> None:
    """Each case of a batch is corrected by what it did itself, however many others are left."""
    columns = columns_of("time_resolved")
    (case,) = (number for number, one in enumerate(columns) if one["duration"] == 1.0)
    found = together(CALLS["time_resolved"], columns)
    assert found.status[case] == col.Status.OK
    assert found.closing_speed[case] == pytest.approx(
        alone("time_resolved", case).closing_speed, rel=1e-9
    )


@pytest.mark.slow
@settings(max_examples=150, deadline=None, derandomize=True, database=None)
@given(st.data(), st.sampled_from(sorted(CALLS)))
def test_some_cases_beside_single_numbers(data: Any, name: str) -> None:
    """Whatever is an array and whatever stays single, in a batch of one dimension or of two."""
    columns = columns_of(name)
    chosen = [0, *data.draw(st.lists(st.integers(0, len(columns) - 1), min_size=1, max_size=5))]
    some = [columns[case] for case in chosen]
    varied = {
        number for number, value in some[0].items() if any(case[number] != value for case in some)
    }
    others = sorted(set(some[0]) - varied)
    varied |= set(data.draw(st.lists(st.sampled_from(others), max_size=3))) if others else set()
    if not varied - set(CALLS[name].single):
        return
    shape = data.draw(st.sampled_from(((len(some),), (1, len(some)), (len(some), 1))))
    check(name, chosen, together(CALLS[name], some, varied, shape=shape), shape)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [np.float32, np.float64])
@every_call
def test_many_cases_and_float32(name: str, kind: Any) -> None:
    """More cases than a block, whose outputs are worked out when they are read; in float32 more is
    beyond floats.
    """
    call, columns = CALLS[name], columns_of(name)
    columns = [
        *columns,
        *({**call.base, number: large} for number in call.base for large in (1e18, 3e38)),
    ]
    # What solves by eigenvalues or integrates takes too long for so many.
    few = "speeds" in name or name.startswith(("simulate", "time_resolved"))
    repeats = 1 if few else BLOCK // len(columns) + 2
    found = together(call, columns * repeats, kind=kind)
    shape = (len(columns) * repeats,)
    for part in parts(found):
        taken = {
            output: np.broadcast_to(value, shape)[: len(columns)]
            for output, value in outputs(part)
            if isinstance(value, np.ndarray)
        }
        if not hasattr(part, "status"):
            # A number that its precision cannot hold is no answer; of a model that has none the
            # error is infinite.
            for output, value in taken.items():
                assert (
                    value.dtype.kind != "f"
                    or output.startswith("errors.")
                    or not np.isinf(value).any()
                ), output
            continue
        for case in np.flatnonzero(part.status[: len(columns)] > GAIN):
            for output, value in taken.items():
                last = output.rpartition(".")[2].partition("[")[0]
                if output not in call.echoes and last not in (
                    *WHOLE,
                    "status",
                    "ok",
                    "refused",
                    "complete",
                    "answers",
                ):
                    assert is_nothing(value[case].item()), (
                        f"{name}, {columns[case]}: {output} is {value[case]!r}"
                    )


@pytest.mark.slow
@every_call
def test_a_single_case_that_is_not_to_raise(name: str) -> None:
    """With on_failure="nan" a refused case alone is as one of a batch."""
    call = CALLS[name]
    if name.partition(",")[0] not in NOT_TO_RAISE:
        return
    given_back = 0
    for number, case in enumerate(columns_of(name)):
        if isinstance(alone(name, number), col.CollisionsError):
            try:
                found = quietly(
                    lambda case=case: call.function(**case, **call.options, on_failure="nan")
                )
            except col.InputError:
                continue  # an argument that cannot be used is refused all the same
            check_case(f"{name}, {case}", found, (), 0, call.echoes)
            given_back += 1
    assert given_back


@of_calls(name for name in CALLS if name != "simulate")
def test_columns_of_refused_cases(name: str) -> None:
    """In a table too, which impacts have."""
    call, columns = CALLS[name], columns_of(name)
    for impact in parts(together(call, columns)):
        if isinstance(impact, col.Impact):
            refused = np.flatnonzero(impact.refused)
            allowed = {output.replace("[0]", ".x").replace("[1]", ".y") for output in call.echoes}
            for key, column in impact.to_columns().items():
                last = key.rpartition(".")[2]
                if key not in allowed and last not in (
                    *WHOLE,
                    *RULES,
                    "status",
                    "ok",
                    "refused",
                    "complete",
                    "answers",
                ):
                    assert all(is_nothing(column[case]) for case in refused), f"{name}: {key}"


@pytest.mark.parametrize("place", [{}, {"x": 2.0}])
@pytest.mark.parametrize("answered", [0, 1])
def test_a_refused_case_may_lack_a_position(place: dict[str, float], answered: int) -> None:
    """A central model needs none, and what is refused for its restitution never comes
    to need one.
    """
    a = col.Vehicle(mass=1000.0, vx=10.0, yaw_inertia=1500.0, x=-2.0, y=0.0)
    spins, e = np.array([0.0, 1.0])[1 - answered :], np.array([0.2, NAN])[1 - answered :]
    b = col.Vehicle(mass=1000.0, yaw_inertia=INF, yaw_rate=spins, **place)
    contact = {"normal": 0.0, "friction": 0.2, "point": (0.0, 0.0), "tolerance": 1.0}
    impact = col.solve(a, b, e, **contact, on_failure="nan")
    assert impact.refused.tolist() == [False, True][1 - answered :]
    needs = (f"choice.missing.eccentric[{i}]" for i in range(2))
    check_case("solve", impact, (answered + 1,), answered, (*FORWARD, "choice.tolerance", *needs))
    check_case(
        "left_out",
        quietly(lambda: col.left_out(impact)),
        (answered + 1,),
        answered,
        ("duration", "drag"),
    )
    columns = impact.to_columns()
    for name in ("common_velocity", "a.kinetic_energy_change", "b.kinetic_energy_change"):
        assert math.isnan(columns[name][answered])
    assert "common_velocity" in impact._repr_html_()
    assert col.Impact.from_dict(impact.to_dict()) == impact
    if answered:
        # Momentum: both masses are 1000 kg, and B takes up half of (1 + e) 10 m/s; e is 0.2.
        assert impact.common_velocity[0] == pytest.approx(5.0, rel=1e-15)
        assert impact.b.kinetic_energy_change[0] == pytest.approx(0.5 * 1000.0 * 6.0**2, rel=1e-15)


@pytest.mark.slow
def test_every_reason_of_refusal_is_met() -> None:
    """No status is left out of the table."""
    seen = {0}
    for name, call in CALLS.items():
        for part in parts(together(call, columns_of(name))):
            seen |= set(np.unique(getattr(part, "status", 0)).tolist())
    assert {status.label for status in col.Status if status > GAIN} == {
        col.Status(code).label for code in seen if code > GAIN
    }


NOT_TO_RAISE = (
    "linear_central",
    "oblique_central",
    "eccentric",
    "solve",
    "time_resolved",
    "central",
    "planar",
    "momentum",
)
# Of the public functions those that take one case, or none.
ONE_CASE = {
    col: {"diagnose", "explain", "impact_schema", "play", "report", "what_if"},
    reconstruct: {"fit", "recorded_pulse", "posterior", "compare"},
    reference: {"drag_factor", "restitution_by_overlap"},
    travel: set(),
}


@pytest.mark.parametrize("module", ONE_CASE, ids=lambda module: module.__name__)
def test_every_public_function_is_called(module: ModuleType) -> None:
    """A new function has to be put into the table, or among those that take one case."""
    public = {name for name in module.__all__ if inspect.isfunction(getattr(module, name))}
    prefix = "reference." if module is reference else ""
    covered = {name.partition(",")[0] for name in CALLS}
    assert {name for name in public if prefix + name in covered} == public - ONE_CASE[module]
    for name in public:
        assert ("on_failure" in inspect.signature(getattr(module, name)).parameters) == (
            name in NOT_TO_RAISE
        )


def test_a_mean_is_that_of_the_answered_cases() -> None:
    """A fifth is refused, as the bodies would not part: a restitution of 0 there would lower the
    mean by a fifth.
    """

    def model(vb: Any) -> dict[str, Any]:
        return {
            "e": reconstruct.central(
                1500.0, 1200.0, va=20.0, vb=vb, vb_after=12.0, on_failure="nan"
            ).restitution
        }

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        found = col.uncertainty.propagate(
            model,
            {"vb": col.uncertainty.Uniform(0.0, 2.5)},
            method="quasi_random",
            samples=8192,
            seed=1,
        )
    # 1 + e = (12 - vb) / (5/9 (20 - vb)), which is 1 at vb = 2, and its mean from 0 to there.
    assert found["e"].mean == pytest.approx(0.9 * (2.0 + 8.0 * math.log(0.9)) - 1.0, rel=1e-3)
    assert found["e"].failed == pytest.approx(0.2 * 8192, abs=5)
