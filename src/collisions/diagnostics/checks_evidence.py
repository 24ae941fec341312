"""Findings on damage that contradicts the answer: energy, direction of force, delta-V, and the way a vehicle was turned."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..amounts import amount
from ..directions import from_radians
from ..errors import MissingInputError, ShapeError
from ..impact import Impact
from ..reading import ArgumentReader
from ..reconstruct import MomentumSolution
from ..vehicle import missing
from .case import Case, Evidence, Examined, off_by, share
from .finding import Finding

# By so much a direction of force may be off, so that a lever which it turns tells nothing.
_READ_TO = math.sin(math.radians(10.0))


def read_evidence(
    reader: ArgumentReader,
    answer: Impact | MomentumSolution,
    crush_energy: Any,
    pdof: Mapping[str, Any],
    delta_v: Mapping[str, Any],
) -> Evidence:
    """What was given of the damage, in SI."""
    energy = None if crush_energy is None else _one(reader, amount(reader, crush_energy, "J", "crush_energy"), "crush_energy")
    angles, changes = {}, {}
    for label, value in pdof.items():
        if value is not None:
            name = f"damage_pdof_{label}"
            angles[label] = _one(reader, reader.number(value, "rad", name), name)
            _need_heading(reader, answer, name, label)
    for label, value in delta_v.items():
        if value is not None:
            name = f"damage_delta_v_{label}"
            changes[label] = _one(reader, amount(reader, value, "m/s", name), name)
    return Evidence(crush_energy=energy, pdof=angles, delta_v=changes)


def _one(reader: ArgumentReader, read: Any, name: str) -> float:
    if isinstance(read, np.ndarray):
        return reader.refuse(ShapeError(f"{name} takes one value: diagnose takes one case", code="bad_shape", argument=name))
    return float(read)


def _need_heading(reader: ArgumentReader, answer: Impact | MomentumSolution, name: str, label: str) -> None:
    """A PDOF is seen from the vehicle."""
    if isinstance(answer, Impact):
        vehicle = (answer.a if label == "a" else answer.b).before
        if vehicle.heading is None:
            reader.refuse(missing(vehicle, "heading", name, label))
    elif getattr(answer, f"pdof_{label}") is None:
        reader.refuse(
            MissingInputError(
                f"the solution has no pdof_{label}, which {name} needs; give heading_{label}='30 deg' (where the vehicle "
                f"points) to reconstruct.momentum",
                code="missing_heading",
                argument=f"heading_{label}",
            )
        )


def momentum_energy(case: Examined) -> Iterator[Finding]:
    """Damage that takes another energy than the speeds lose."""
    crush = case.evidence.crush_energy
    if crush is not None:
        lost = case.energy_lost
        yield from case.above(
            "momentum_energy",
            share(abs(crush - lost), lost),
            f"the damage takes {case.words.energy(crush)} by the crush energy given, and momentum leaves "
            f"{case.words.energy(lost)} to be lost: speeds or damage are wrong",
            rounding=off_by(1.0),
        )


def pdof_off_damage(case: Examined) -> Iterator[Finding]:
    """A force from elsewhere than the damage shows."""
    for label, seen in case.evidence.pdof.items():
        who, _, pdof = case.told[label]
        if pdof is not None:
            off = abs(math.remainder(seen - pdof, math.tau))
            yield from case.above(
                "pdof_off_damage",
                off,
                f"{who} has a PDOF of {case.words.angle(pdof)}, {case.words.angle(off)} off the {case.words.angle(seen)} that "
                f"its damage shows (0 ahead, positive clockwise)",
                label,
                rounding=off_by(seen, pdof, math.tau),
            )


def delta_v_off_damage(case: Examined) -> Iterator[Finding]:
    """A delta-V other than the damage shows."""
    for label, seen in case.evidence.delta_v.items():
        who, delta_v, _ = case.told[label]
        yield from case.above(
            "delta_v_off_damage",
            share(abs(seen - delta_v), delta_v),
            f"{who} has a delta-V of {case.words.speed(delta_v)}, and its damage shows {case.words.speed(seen)}",
            label,
            rounding=off_by(1.0),
        )


def yaw_against_lever(case: Case) -> Iterator[Finding]:
    """A vehicle that turns against the force which its damage shows."""
    point = case.impact.point
    if point is None:
        return
    for label, side in case.sides:
        before, pdof = side.before, case.evidence.pdof.get(label)
        x, y = before.pivot if before.pivot is not None else (before.x, before.y)
        if pdof is None or x is None or y is None or before.heading is None:
            continue
        # The PDOF is where the force comes from, clockwise from the heading.
        c, s = from_radians(before.heading - pdof)
        arm_x, arm_y = point[0] - x, point[1] - y
        lever = arm_y * c - arm_x * s
        if abs(lever) > _READ_TO * math.hypot(arm_x, arm_y):
            yield from case.above(
                "yaw_against_lever",
                -math.copysign(1.0, lever) * side.delta_yaw_rate,
                f"{case.told[label].who} is turned by {case.words.yaw_rate(side.delta_yaw_rate)}, against the lever "
                f"({case.words.length(abs(lever))}) of a force from the {case.words.angle(pdof)} that its damage shows",
                label,
            )
