"""Every argument with a unit, of every public function: a number in SI, a text and a Quantity in
other units have the same answers.
"""

import inspect
import math
import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any, NamedTuple

import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct, scene, travel

UREG = pint.UnitRegistry()
OTHER = {
    "rad": "degree",
    "m/s": "mph",
    "kg": "lb",
    "m": "ft",
    "s": "ms",
    "J": "ft*lbf",
    "N*s": "lbf*s",
    "N*m*s": "lbf*ft*s",
    "rad/s": "degree/s",
    "kg*m**2": "lb*ft**2",
    "N/m": "lbf/inch",
    "N/m**2": "psi",
}


class In(NamedTuple):
    """An argument in SI, and its unit."""

    value: float
    unit: str


class Made(NamedTuple):
    """An argument that is made by a public function, of arguments with units."""

    by: Any
    of: dict[str, Any]


def as_number(one: In) -> Any:
    return one.value


def as_text(one: In) -> Any:
    other = UREG.Quantity(one.value, one.unit).to(OTHER[one.unit])
    return f"{other.magnitude!r} {OTHER[one.unit]}"


def as_quantity(one: In) -> Any:
    return UREG.Quantity(one.value, one.unit).to(OTHER[one.unit])


def as_batch(one: In) -> Any:
    return UREG.Quantity(np.full(3, one.value), one.unit).to(OTHER[one.unit])


def written(argument: Any, form: Any) -> Any:
    """The argument with each number in this form."""
    if isinstance(argument, In):
        return form(argument)
    if isinstance(argument, Made):
        return argument.by(**{name: written(one, form) for name, one in argument.of.items()})
    if isinstance(argument, Mapping):
        return {name: written(one, form) for name, one in argument.items()}
    if isinstance(argument, (list, tuple)):
        return type(argument)(written(one, form) for one in argument)
    return argument


def numbers(found: Any) -> list[Any]:
    """All numbers of an answer, in order; of how its inputs were written, none."""
    if isinstance(found, (bool, str)) or found is None:
        return []
    if isinstance(found, col.Impact):
        columns = {name: np.asarray(value) for name, value in found.to_columns().items()}
        found = {name: value for name, value in columns.items() if value.dtype.kind in "fi"}
    if isinstance(found, Mapping):
        return [one for value in found.values() for one in numbers(value)]
    if isinstance(found, (list, tuple)):
        return [one for value in found for one in numbers(value)]
    if is_dataclass(found):
        return numbers(
            {
                field.name: getattr(found, field.name)
                for field in fields(found)
                if "unit" in field.metadata or field.name in ("a", "b", "errors")
            }
        )
    return [found] if isinstance(found, (int, float, np.number, np.ndarray)) else []


MOTION = ("mass", "yaw_inertia", "x", "y", "heading", "vx", "vy", "yaw_rate")


def vehicle(mass, inertia, x, y, heading, vx, vy, yaw_rate):
    return Made(
        col.Vehicle,
        {
            "mass": In(mass, "kg"),
            "yaw_inertia": In(inertia, "kg*m**2"),
            "x": In(x, "m"),
            "y": In(y, "m"),
            "heading": In(heading, "rad"),
            "vx": In(vx, "m/s"),
            "vy": In(vy, "m/s"),
            "yaw_rate": In(yaw_rate, "rad/s"),
        },
    )


def along_the_normal(speed):
    of = {"mass": In(1500.0, "kg"), "speed": In(speed, "m/s"), "course": In(0.3, "rad")}
    return Made(col.Vehicle.from_speed, of)


def tyres(lock, steer):
    return Made(
        travel.Tyres,
        {
            "friction": 0.7,
            "lock": lock,
            "wheelbase": In(2.7, "m"),
            "track": In(1.5, "m"),
            "steer": In(steer, "rad"),
            "height": In(0.4, "m"),
        },
    )


A = vehicle(1500.0, 2500.0, -1.9, -0.3, 0.1, 14.0, 1.0, 0.1)
B = vehicle(1300.0, 2100.0, 1.1, 0.9, 1.7, 1.0, 9.0, -0.2)
STRAIGHT = {
    label: Made(col.Vehicle, {name: one for name, one in made.of.items() if name != "yaw_rate"})
    for label, made in (("a", A), ("b", B))
}
PARKED = {
    label: Made(col.Vehicle, {name: one for name, one in made.of.items() if name[0] in "myxh"})
    for label, made in (("a", A), ("b", B))
}
STRUCK = col.eccentric(
    written(A, as_number),
    written(B, as_number),
    0.1,
    normal=0.3,
    point=(0.1, 0.2),
    friction=0.1,
)
A_AFTER, B_AFTER = (
    vehicle(*(getattr(side.after, name) for name in MOTION)) for side in (STRUCK.a, STRUCK.b)
)
CONTACT = {"normal": In(0.3, "rad"), "point": (In(0.1, "m"), In(0.2, "m"))}
PUSH_A = (In(40.0, "N*s"), In(-30.0, "N*s"), In(20.0, "N*m*s"))
PUSH_B = (In(-20.0, "N*s"), In(50.0, "N*s"), In(-10.0, "N*m*s"))
LASTING = {
    "duration": In(0.09, "s"),
    "tyres_a": tyres([1.0, 0.0, 0.3, 0.2], 0.05),
    "tyres_b": tyres(0.1, -0.03),
}
COURSES = {"course_a": In(0.07, "rad"), "course_b": In(1.4, "rad")}
COURSES_AFTER = {"course_a_after": In(0.4, "rad"), "course_b_after": In(0.75, "rad")}
AFTER = {"speed_a_after": In(7.0, "m/s"), "speed_b_after": In(9.5, "m/s")}
MASSES = {"mass_a": In(1500.0, "kg"), "mass_b": In(1300.0, "kg")}
IN_LINE = {**MASSES, "va": In(15.0, "m/s"), "vb": In(5.0, "m/s")}
TURNING = {"yaw_rate_a_after": In(1.2, "rad/s"), "yaw_rate_b_after": In(-0.9, "rad/s")}
SPEEDS = {**PARKED, **COURSES, **CONTACT, "restitution": 0.1}
WHEELS = {
    "heading_a": In(0.1, "rad"),
    "heading_b": In(1.7, "rad"),
    **TURNING,
    **LASTING,
}
TOUCH = {
    "a": "A",
    "b": "B",
    "at": "touch",
    "restitution": 0.1,
    "friction": 0.5,
    "normal": In(0.3, "rad"),
}
SURVEY = {
    "points": [(In(x, "m"), In(y, "m")) for x, y in ((0.0, 0.0), (4.0, 0.5), (8.0, 1.5))],
    "headings": [In(angle, "rad") for angle in (0.0, 0.5, 0.9)],
}
KNOWN = {
    "delta_v_forward_a": In(-5.0, "m/s"),
    "delta_v_left_a": In(1.0, "m/s"),
    "speed_a": In(14.0, "m/s"),
}


def of_an_impact(function):
    """The function of an impact that is the same each time, and of the arguments in question."""

    def call(**arguments):
        found = function(STRUCK, **arguments)
        return (
            {one.code: (one.measured, one.limit) for one in found}
            if function is col.diagnose
            else found
        )

    return call


def crash(*, movers, contact, slope, surfaces):
    """A scene of two movers and one contact, run."""
    found = scene.Scene(
        movers={label: scene.Mover(**mover) for label, mover in movers.items()},
        contacts=[scene.Contact("A", "B", **contact)],
        slope=slope,
        surfaces=surfaces,
    ).run()
    return numbers(found.to_columns())


CALLS: dict[str, tuple[Any, dict[str, Any]]] = {
    "linear_central": (
        col.linear_central,
        {
            "a": along_the_normal(14.0),
            "b": along_the_normal(3.0),
            "restitution": 0.2,
            "normal": In(0.3, "rad"),
        },
    ),
    "oblique_central": (
        col.oblique_central,
        {**STRAIGHT, "restitution": 0.2, "normal": In(0.3, "rad"), "friction": 0.4},
    ),
    "eccentric": (
        col.eccentric,
        {
            "a": A,
            "b": B,
            "restitution": 0.2,
            "friction": 0.4,
            **CONTACT,
            **LASTING,
            "outside_a": PUSH_A,
            "outside_b": PUSH_B,
        },
    ),
    "solve": (
        col.solve,
        {
            "a": A,
            "b": B,
            "restitution": 0.2,
            "friction": 0.4,
            **CONTACT,
            **LASTING,
            "tolerance": In(0.5, "m/s"),
        },
    ),
    "required_model": (
        col.required_model,
        {
            "a": A,
            "b": B,
            "restitution": 0.2,
            "friction": 0.4,
            **CONTACT,
            **LASTING,
            "tolerance": In(0.5, "m/s"),
        },
    ),
    "time_resolved, tyres": (
        col.time_resolved,
        {"a": A, "b": B, "restitution": 0.2, "friction": 0.4, **CONTACT, **LASTING},
    ),
    "time_resolved, drag": (
        col.time_resolved,
        {
            "a": A,
            "b": B,
            "restitution": 0.2,
            "friction": 0.4,
            **CONTACT,
            "drag": 0.6,
            "stiffness": In(9e5, "N/m"),
            "wheelbase": In(2.6, "m"),
            "track": In(1.4, "m"),
        },
    ),
    "time_resolved, crush": (
        col.time_resolved,
        {
            "a": A,
            "b": B,
            "restitution": 0.2,
            "friction": 0.4,
            **CONTACT,
            "crush_a": (In(50e3, "N/m"), In(400e3, "N/m**2"), In(1.5, "m")),
            "crush_b": (In(60e3, "N/m"), In(500e3, "N/m**2"), In(1.4, "m")),
        },
    ),
    "left_out": (of_an_impact(col.left_out), LASTING),
    "diagnose": (
        of_an_impact(col.diagnose),
        {
            "duration": In(0.09, "s"),
            "crush_energy": In(60e3, "J"),
            "damage_pdof_a": In(0.2, "rad"),
            "damage_pdof_b": In(-1.3, "rad"),
            "damage_delta_v_a": In(4.0, "m/s"),
            "damage_delta_v_b": In(5.0, "m/s"),
        },
    ),
    "from_speed": (
        col.Vehicle.from_speed,
        {"mass": In(1500.0, "kg"), "speed": In(14.0, "m/s"), "course": In(0.4, "rad")},
    ),
    "a pivot": (
        col.Vehicle,
        {
            "mass": In(1500.0, "kg"),
            "yaw_inertia": In(2500.0, "kg*m**2"),
            "x": In(1.0, "m"),
            "y": In(2.0, "m"),
            "yaw_rate": In(0.5, "rad/s"),
            "pivot": (In(0.0, "m"), In(1.0, "m")),
        },
    ),
    "central": (
        reconstruct.central,
        {**MASSES, "vb": In(5.0, "m/s"), "vb_after": In(9.0, "m/s"), "va_after": In(8.5, "m/s")},
    ),
    "central, forwards": (
        reconstruct.central,
        {
            **IN_LINE,
            "energy_loss": In(30e3, "J"),
            "heading_a": In(0.1, "rad"),
            "heading_b": In(3.0, "rad"),
        },
    ),
    "central, in time": (
        reconstruct.central,
        {
            **MASSES,
            "va_after": In(8.5, "m/s"),
            "vb_after": In(9.0, "m/s"),
            "vb": In(4.0, "m/s"),
            "duration": In(0.1, "s"),
            "drag_a": 0.7,
            "drag_b": 0.1,
        },
    ),
    "momentum": (reconstruct.momentum, {**MASSES, **COURSES, **COURSES_AFTER, **AFTER}),
    "momentum, tyres": (
        reconstruct.momentum,
        {**MASSES, **COURSES, **COURSES_AFTER, **AFTER, **WHEELS, "normal": In(0.3, "rad")},
    ),
    "momentum, tyres and a course": (
        reconstruct.momentum,
        {
            **MASSES,
            "course_b": In(1.4, "rad"),
            **COURSES_AFTER,
            **AFTER,
            **WHEELS,
            "speed_b": In(9.0, "m/s"),
        },
    ),
    "momentum, a course beside a speed": (
        reconstruct.momentum,
        {
            **MASSES,
            "course_b": In(1.4, "rad"),
            **COURSES_AFTER,
            **AFTER,
            "speed_a": In(13.0, "m/s"),
            "course_near": In(0.1, "rad"),
            "outside_impulse": (In(100.0, "N*s"), In(-200.0, "N*s")),
        },
    ),
    "planar": (
        reconstruct.planar,
        {"a_after": A_AFTER, "b_after": B_AFTER, **CONTACT, "restitution": 0.1, "friction": 0.1},
    ),
    "planar, tyres": (
        reconstruct.planar,
        {
            "a_after": A_AFTER,
            "b_after": B_AFTER,
            **CONTACT,
            **LASTING,
            "energy_loss": In(60e3, "J"),
            "friction": 0.1,
        },
    ),
    "planar, closing speed": (
        reconstruct.planar,
        {
            "a_after": A_AFTER,
            "b_after": B_AFTER,
            **CONTACT,
            "closing_speed": In(12.0, "m/s"),
            "friction": 0.1,
        },
    ),
    "restitution": (
        reconstruct.restitution,
        {"a_before": A, "b_before": B, "a_after": A_AFTER, "b_after": B_AFTER, **CONTACT},
    ),
    "friction": (
        reconstruct.friction,
        {"a_before": A, "b_before": B, "a_after": A_AFTER, "b_after": B_AFTER, **CONTACT},
    ),
    "speeds": (
        reconstruct.speeds,
        {**SPEEDS, "friction": 0.5, "speed_b": In(9.0, "m/s"), "delta_v_a": In(5.0, "m/s")},
    ),
    "speeds, tyres": (
        reconstruct.speeds,
        {
            **SPEEDS,
            **LASTING,
            "friction": 0.5,
            "speed_b": In(9.0, "m/s"),
            "energy_loss": In(60e3, "J"),
        },
    ),
    "speeds, EES": (
        reconstruct.speeds,
        {
            **SPEEDS,
            "friction": 0.5,
            "speed_b": In(9.0, "m/s"),
            "ees_a": In(5.5, "m/s"),
            "ees_b": In(6.0, "m/s"),
        },
    ),
    "speeds, speeds of maximum crush": (
        reconstruct.speeds,
        {
            **SPEEDS,
            "friction": 0.5,
            "speed_b": In(9.0, "m/s"),
            "max_crush_speed_a": In(5.5, "m/s"),
            "max_crush_speed_b": In(6.0, "m/s"),
        },
    ),
    "speeds, recorders": (
        reconstruct.speeds,
        {
            **SPEEDS,
            **KNOWN,
            **LASTING,
            "friction": math.inf,
            "recorder_a": (In(0.4, "m"), In(-0.1, "m")),
            "slid": "bound",
        },
    ),
    "speeds, both recorders": (
        reconstruct.speeds,
        {
            **SPEEDS,
            "delta_v_forward_b": In(2.0, "m/s"),
            "delta_v_left_b": In(-5.0, "m/s"),
            "recorder_b": (In(-0.4, "m"), In(0.2, "m")),
            "duration": In(0.08, "s"),
            "friction": math.inf,
            "regime": "sticking",
        },
    ),
    "inline_closing_speed": (
        reconstruct.inline_closing_speed,
        {
            **MASSES,
            "restitution": 0.2,
            "delta_v_b": In(5.0, "m/s"),
            "duration": In(0.1, "s"),
            "drag_a": 0.0,
            "drag_b": 0.3,
        },
    ),
    "inline_closing_speed, a": (
        reconstruct.inline_closing_speed,
        {**MASSES, "restitution": 0.2, "delta_v_a": In(5.0, "m/s")},
    ),
    "inline_closing_speed, energy": (
        reconstruct.inline_closing_speed,
        {**MASSES, "restitution": 0.2, "energy_loss": In(50e3, "J")},
    ),
    "inline_closing_speed, EES": (
        reconstruct.inline_closing_speed,
        {**MASSES, "restitution": 0.2, "ees_a": In(5.0, "m/s"), "ees_b": In(6.0, "m/s")},
    ),
    "inline_closing_speed, speeds of maximum crush": (
        reconstruct.inline_closing_speed,
        {
            **MASSES,
            "restitution": 0.2,
            "max_crush_speed_a": In(5.0, "m/s"),
            "max_crush_speed_b": In(6.0, "m/s"),
        },
    ),
    "crush_energy": (
        reconstruct.crush_energy,
        {
            "widths": In(1.5, "m"),
            "depths": [In(depth, "m") for depth in (0.2, 0.3, 0.4, 0.3)],
            "stiffness_a": In(50e3, "N/m"),
            "stiffness_b": In(400e3, "N/m**2"),
            "force_angle": In(0.3, "rad"),
        },
    ),
    "crush_delta_v": (reconstruct.crush_delta_v, {"energy": In(50e3, "J"), **MASSES}),
    "crush_share": (
        reconstruct.crush_share,
        {"stiffness_a": In(9e5, "N/m"), "stiffness_b": In(7e5, "N/m")},
    ),
    "recorded_pulse": (
        reconstruct.recorded_pulse,
        {
            "time": In(np.array([0.0, 0.02, 0.05, 0.1]), "s"),
            "delta_v_forward": In(np.array([0.0, -1.0, -4.0, -5.0]), "m/s"),
            "delta_v_left": In(np.array([0.0, 0.2, 0.6, 1.0]), "m/s"),
            "polarity": "ISO 8855",
            "forward": In(0.4, "m"),
            "left": In(0.1, "m"),
        },
    ),
    "speed": (
        travel.speed,
        {"distance": In(20.0, "m"), "drag": 0.7, "grade": 0.02, "end_speed": In(3.0, "m/s")},
    ),
    "time": (
        travel.time,
        {"distance": In(20.0, "m"), "drag": 0.7, "grade": 0.02, "end_speed": In(3.0, "m/s")},
    ),
    "distance": (
        travel.distance,
        {"speed": In(20.0, "m/s"), "drag": 0.7, "end_speed": In(3.0, "m/s")},
    ),
    "throw_speed": (
        travel.throw_speed,
        {
            "distance": In(20.0, "m"),
            "friction": 0.6,
            "angle": In(0.1, "rad"),
            "height": In(1.0, "m"),
        },
    ),
    "throw_bounds": (
        travel.throw_bounds,
        {"distance": In(20.0, "m"), "friction": 0.6, "height": In(1.0, "m")},
    ),
    "path": (
        travel.path,
        {
            **SURVEY,
            "friction": 0.7,
            "lock": 0.3,
            "end_speed": In(2.0, "m/s"),
            "window": In(5.0, "m"),
            "point_error": In(0.1, "m"),
            "heading_error": In(0.05, "rad"),
        },
    ),
    "path, tyres": (travel.path, {**SURVEY, "tyres": LASTING["tyres_a"]}),
    "simulate": (
        travel.simulate,
        {
            "vehicle": A_AFTER,
            "tyres": LASTING["tyres_a"],
            "until": In(0.8, "s"),
            "surfaces": [
                (
                    [
                        (In(1.0, "m"), In(-3.0, "m")),
                        (In(4.0, "m"), In(-3.0, "m")),
                        (In(4.0, "m"), In(9.0, "m")),
                        (In(1.0, "m"), In(9.0, "m")),
                    ],
                    0.3,
                )
            ],
            "slope": (0.02, -0.03),
            "moments": 11,
        },
    ),
    "Contact": (
        scene.Contact,
        {
            **TOUCH,
            "depth": In(0.3, "m"),
            "duration": In(0.08, "s"),
            "model": "solve",
            "tolerance": In(0.4, "m/s"),
        },
    ),
    "Contact, delay": (scene.Contact, {**TOUCH, "delay": In(0.04, "s")}),
    "Mover": (
        scene.Mover,
        {
            "vehicle": A,
            "outline": [
                (In(x, "m"), In(y, "m")) for x, y in ((2.0, 0.8), (-2.0, 0.8), (0.0, -0.8))
            ],
        },
    ),
    "a scene": (
        crash,
        {
            "movers": {
                "A": {"vehicle": A, "tyres": LASTING["tyres_a"]},
                "B": {"vehicle": B, "tyres": LASTING["tyres_b"]},
            },
            "contact": {
                "restitution": 0.1,
                "friction": 0.5,
                **CONTACT,
                "at": In(0.0, "s"),
                "duration": In(0.08, "s"),
            },
            "slope": (0.01, 0.02),
            "surfaces": None,
        },
    ),
}
IDS = list(CALLS)
# Of these a batch has another answer, or none.
SINGLE = {
    "required_model",
    "diagnose",
    "recorded_pulse",
    "Mover",
    "crush_energy",
    "path",
    "path, tyres",
    "a scene",
    "simulate",
}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("form", [as_text, as_quantity, as_batch])
@pytest.mark.parametrize("name", IDS)
def test_the_unit_of_an_argument_does_not_change_the_answer(name, form):
    """To the rounding of the conversion, which grows by the condition of the problem."""
    function, arguments = CALLS[name]
    if name in (SINGLE if form is as_batch else {"recorded_pulse"} if form is as_text else ()):
        pytest.skip("takes single cases, or lists of them")
    # Steps in time may be parted elsewhere.
    within = 1e-6 if name in ("simulate", "a scene") else 1e-9
    wanted = numbers(function(**written(arguments, as_number)))
    found = numbers(function(**written(arguments, form)))
    assert len(wanted) == len(found) > 0
    for one, other in zip(found, wanted, strict=True):
        one, other = np.broadcast_arrays(one, other)
        size = np.max(np.nan_to_num(np.abs(other)), initial=1.0)
        np.testing.assert_allclose(one, other, rtol=within, atol=within * size)


def with_units(function: Any) -> dict[str, str]:
    """The arguments of a function whose docstring gives them a unit."""
    found = {}
    for line in (inspect.getdoc(function) or "").splitlines():
        heads = re.match(r"([\w, *]+) : .*\[(.+)\]$", line)
        if heads:
            found |= dict.fromkeys(heads[1].replace("*", "").split(", "), heads[2])
    taken = inspect.signature(function).parameters
    return {name: unit for name, unit in found.items() if name in taken and unit not in ("-", "1")}


def test_no_argument_with_a_unit_is_forgotten():
    """Every one that a public docstring gives a unit is in a call above."""
    asked: dict[str, set[str]] = {}

    def ask(function, arguments):
        for name, one in arguments.items():
            asked.setdefault(getattr(function, "__name__", ""), set()).add(name)
            if isinstance(one, Made):
                ask(one.by, one.of)

    for name, (function, arguments) in CALLS.items():
        ask(function, arguments)
        asked.setdefault(name, set()).update(arguments)
    asked["Contact"] |= {*CALLS["a scene"][1]["contact"]}
    missing = [
        f"{name}({argument}= [{unit}])"
        for module in (col, reconstruct, travel, scene)
        for name in module.__all__
        for function in [getattr(module, name)]
        if callable(function)
        and name not in ("ModelChoice", "Reconstruction", "RunOut", "SimulatedPath")
        if not (inspect.isclass(function) and issubclass(function, Exception))
        for argument, unit in with_units(function).items()
        if argument not in asked.get(name, set())
    ]
    assert not missing
