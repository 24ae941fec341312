"""Both impact speeds from the full geometry and two of: one speed, a delta-V, the energy dissipated, both EES."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from ..amounts import amount
from ..directions import Angle, course
from ..errors import InputError, MissingInputError, OutOfRangeWarning
from ..impact import Impact
from ..inputs import Inputs, Law, read_inputs
from ..kernels.status import Status
from ..models import body_numbers, missing_numbers
from ..provenance import Reconstruction
from ..reading import ArgumentReader
from ..solving import warn_of_refusals
from ..units import Input, Pair
from ..vehicle import Vehicle
from ..warning import warn
from .common import ASK_ALONE, NUMBERS, Cases, exactly, input_faults, run_forward, split_texts
from .crossings import RestitutionOf
from .speeds_algebra import Root, Scene
from .speeds_found import in_order, joint
from .speeds_refusals import refusal


def speeds(
    a: Vehicle,
    b: Vehicle,
    *,
    course_a: Input | None,
    course_b: Input | None,
    restitution: Input | Callable[[float], float],
    normal: Input | tuple[Input, Input],
    point: Pair,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: Law = "brach",
    speed_a: Input | None = None,
    speed_b: Input | None = None,
    delta_v_a: Input | None = None,
    delta_v_b: Input | None = None,
    energy_loss: Input | None = None,
    ees_a: Input | None = None,
    ees_b: Input | None = None,
) -> tuple[Impact, ...]:
    """Impact speeds of both vehicles from where and how they met and two things that were found out.

    The model is that of ``eccentric``: levers, rotation, friction and both laws. Every pair of speeds that fits is returned.

    Parameters
    ----------
    a, b : Vehicle
        The vehicles at the moment of impact: mass, yaw inertia, position, yaw rate (heading for the PDOF). Their velocities are
        what is asked for, and replaced.
    course_a, course_b : angle [rad]
        Directions of motion before the impact; None for a vehicle whose speed is known to be 0.
    restitution : float, str, Quantity or array [1], or function
        Coefficient of restitution, or a function that gives it for a closing speed in m/s: solved together with the speeds,
        in single cases. With a number every root is found in closed form. With a function, which is much slower, they are
        looked for on a grid of 129 restitutions, between its places and where it turns or ends; two roots that the grid does
        not tell apart may be missed.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B.
    point : pair [m]
        Contact point.
    friction, impulse_ratio, critical_fraction : float, str, Quantity or array [1], optional
        Exactly one, as for ``eccentric``.
    law : {"brach", "kudlich-slibar"}, optional
        How restitution acts and what no slip means.
    speed_a, speed_b : float, str, Quantity or array [m/s], optional
        A known speed, >= 0. Exactly two of the five kinds of knowledge.
    delta_v_a, delta_v_b : float, str, Quantity or array [m/s], optional
        A known delta-V, as from an event data recorder at the centre of mass. Not both: they tell the same.
    energy_loss : float, str, Quantity or array [J], optional
        Energy dissipated, along the normal and by friction.
    ees_a, ees_b : float, str, Quantity or array [m/s], optional
        Energy equivalent speeds of both: the energy absorbed along the normal at maximum crush, before restitution.

    Returns
    -------
    tuple of Impact
        Every impact that fits, by rising closing speed. In a batch each holds one root of every case, NaN where it has none.

    Raises
    ------
    InputError
        An argument that cannot be used, or not exactly two things known.
    NoSolutionError
        Nothing fits, and the message says what the first known allows for the second; or what is known leaves the speeds
        open, or is of an infinite mass.

    Warns
    -----
    OutOfRangeWarning
        A speed came out negative: backwards along its course.
    CollisionsWarning
        Cases of a batch have no answer at all; they are NaN, and ``status`` of the first impact says why.

    Examples
    --------
    A car strikes a parked one off-centre; its recorder shows a delta-V of 6 m/s.

    >>> import collisions as col
    >>> a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.0, y=0.0)
    >>> b = col.Vehicle(mass=1300, yaw_inertia=2000, x=2.0, y=0.8)
    >>> (found,) = col.reconstruct.speeds(
    ...     a, b, course_a=0.0, course_b=None, speed_b=0.0, delta_v_a=6.0, restitution=0.1, normal=0.0, point=(0.0, 0.4),
    ...     friction=0.5)
    >>> round(found.a.before.vx, 2), round(found.a.delta_v, 12)
    (11.96, 6.0)
    """
    if (ees_a is None) != (ees_b is None):
        raise InputError(
            "give both ees_a and ees_b, or neither; that of an infinite mass is 0", code="one_ees", argument="ees_a"
        )
    given = exactly(
        {
            "speed_a": speed_a,
            "speed_b": speed_b,
            "delta_v_a": delta_v_a,
            "delta_v_b": delta_v_b,
            "energy_loss": energy_loss,
            "ees_a": ees_a,
        },
        2,
        "speeds",
    )
    reader = ArgumentReader()
    known = {name: amount(reader, value, "J" if name == "energy_loss" else "m/s", name) for name, value in given.items()}
    if "ees_a" in known:
        known["ees_b"] = amount(reader, ees_b, "m/s", "ees_b")
    courses = {}
    for label, angle in (("a", course_a), ("b", course_b)):
        if angle is not None:
            courses[label] = course(reader, angle, f"course_{label}")
        elif np.any(np.not_equal(known.get(f"speed_{label}", np.nan), 0.0)):
            reader.refuse(
                MissingInputError(
                    f"course_{label} is None, and speeds needs the course of every vehicle that moves; only a known speed of 0 "
                    f"needs none",
                    code="missing_course",
                    argument=f"course_{label}",
                )
            )
        else:
            courses[label] = Angle(0.0, False)
    for label, body in (("a", a), ("b", b)):
        if isinstance(body, Vehicle) and body.pivot is not None:
            reader.refuse(
                InputError(
                    f"{label} has a pivot, so its velocity has no course of its own; use planar",
                    code="pinned",
                    argument="pivot",
                )
            )
    inputs, _ = read_inputs(
        "eccentric",
        a,
        b,
        0.0 if callable(restitution) else restitution,
        normal,
        point,
        (friction, impulse_ratio, critical_fraction),
        law,
        [*reader.problems, *missing_numbers(a, b, point)],
        (*known.values(), *(angle.value for angle in courses.values())),
    )
    e, n, rule, bound, contact = inputs.restitution, inputs.normal, inputs.rule, inputs.rule_value, inputs.point
    everything: dict[str, Any] = {**known, "restitution": e, rule: bound, "normal[0]": n[0], "normal[1]": n[1]}
    everything |= {f"point[{i}]": part for i, part in enumerate(contact or ())}
    for label, body in (("a", a), ("b", b)):
        numbers = body_numbers(body, contact)
        everything |= {
            f"{label}.{name}": value for name, value in zip(NUMBERS, numbers, strict=True) if name not in ("vx", "vy")
        }
        if body.heading is not None:
            everything[f"{label}.heading"] = body.heading
    # A course is as precise as everything else, the other one too.
    beside = (*everything.values(), *(angle.value for angle in courses.values()))
    for label, angle in courses.items():
        everything |= {f"course_{label}[{i}]": part for i, part in enumerate(angle.beside(beside).direction)}
    cases = Cases.of(everything)
    function = RestitutionOf(restitution, cases) if callable(restitution) else None
    with np.errstate(all="ignore"):
        _refuse_pairs(given, known, a, b)
        scene = Scene({name: np.asarray(v, dtype=np.float64) for name, v in everything.items()}, rule, law, tuple(given))
        told = {**reader.texts, **(inputs.given or {})} or None
        roots = scene.roots() if function is None else joint(scene, cases, function)
        return _answers(cases, scene, in_order(cases, scene, roots), a, b, (n, rule, bound, law, contact, e, told), function)


def _refuse_pairs(given: dict[str, Any], known: dict[str, Any], a: Vehicle, b: Vehicle) -> None:
    if given.keys() == {"speed_a", "speed_b"}:
        raise InputError(
            "speed_a and speed_b are both known: that is the forward problem, use eccentric", code="too_many_knowns"
        )
    if given.keys() == {"delta_v_a", "delta_v_b"}:
        on_a, on_b = (np.multiply(body.mass, known[f"delta_v_{label}"]) for label, body in (("a", a), ("b", b)))
        # fmax passes over the NaN of infinite masses.
        apart = float(np.fmax.reduce(abs(on_a - on_b) / np.maximum(on_a, on_b), axis=None, initial=0.0))
        raise InputError(
            f"delta_v_a and delta_v_b tell the same, the impulse (here they differ by {apart:.1%}); give one of them and a "
            f"speed or an energy",
            code="same_information",
            argument="delta_v_b",
            mismatch=apart,
        )


def _answers(
    cases: Cases,
    scene: Scene,
    found: list[tuple[Root, Any]],
    a: Vehicle,
    b: Vehicle,
    contact: tuple[Any, ...],
    function: RestitutionOf | None,
) -> tuple[Impact, ...]:
    faults = input_faults(scene.numbers)
    told_nothing = [np.isinf(scene.numbers[f"{kind[-1]}.mass"]) for kind in scene.kinds if kind.startswith("delta_v")]
    faults += [(of_wall, Status.INFINITE_MASS) for of_wall in told_nothing]
    faults.append((scene.open, Status.UNDETERMINED))
    none = np.full((), np.nan)
    nothing = Root(none, none, none, none), np.zeros(cases.shape or (), dtype=bool)
    count: Any = sum((np.broadcast_to(there, cases.shape or ()).astype(np.int64) for _, there in found), np.int64(0))
    impacts: list[Impact] = []
    backward = 0.0
    for root, there in found or [nothing]:
        status = cases.first_status((*faults, (there, Status.OK), (True, Status.CONTRADICTORY)))
        if isinstance(status, int) and status != Status.OK:
            raise refusal(scene, status, function)
        origin = Reconstruction(
            method="speeds", known=scene.kinds, condition=cases.values(root.condition), answers=cases.counts(count)
        )
        asked = partial(_asked, cases, scene, root, (a, b), contact, function is None)
        impact = run_forward(asked, status, origin, None if cases.shape is None else "nan")
        for speed in (root.speed_a, root.speed_b):
            speed = np.where(impact.refused, np.nan, speed * scene.speed_unit)
            backward = min(backward, float(np.fmin.reduce(speed, axis=None, initial=0.0)))
        impacts.append(impact)
    if cases.shape is not None and np.any(impacts[0]._raw.status > Status.ENERGY_GAIN):
        warn_of_refusals(impacts[0]._raw.status, ASK_ALONE)
    if backward < 0.0:
        warn(
            OutOfRangeWarning(
                f"a speed came out as {backward:.6g} m/s: backwards along its course; check the courses, and the normal, which "
                f"must point from A into B",
                code="negative_speed",
                value=backward,
            )
        )
    return tuple(impacts)


def _asked(
    cases: Cases, scene: Scene, root: Root, bodies: tuple[Vehicle, Vehicle], contact: tuple[Any, ...], as_given: bool, keep: Any
) -> Inputs:
    """The question of the speeds of a root where they are kept, with the restitution as it was given or found."""
    n, rule, bound, law, point, e, told = contact
    moved = []
    for label, body, speed in zip("ab", bodies, root[:2], strict=True):
        speed = np.where(keep, speed * scene.speed_unit, np.nan)
        cx, cy = (scene.numbers[f"course_{label}[{i}]"] for i in range(2))
        changed = body._moved(cases.values(speed * cx + 0.0), cases.values(speed * cy + 0.0), body.yaw_rate)
        moved.append(changed._told(split_texts(body, ("vx", "vy", "speed", "course"))[0]))
    used = e if as_given else cases.values(root.restitution)
    return Inputs("eccentric", moved[0], moved[1], used, n, rule, bound, law, point, told)
