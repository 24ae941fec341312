"""Both speeds of an instant, refined for a contact in which tyres act: those for which
``eccentric`` with its duration and tyres has what was known.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..impact.inputs import Inputs
from ..kernels.reverse import energy_of_speeds
from ..quantities.directions import from_radians
from ..vehicle.vehicle import moved
from .lasting import settle, slopes_at

# The second of a pair that together is one energy.
_STANDS_FOR_NONE = ("ees_b", "max_crush_speed_b")


def speeds_with_tyres(
    inputs: Inputs,
    directions: Mapping[str, tuple[Any, Any]],
    instant: tuple[Any, Any],
    known: Mapping[str, Any],
    shape: tuple[int, ...],
) -> tuple[Any, Any, Any]:
    """Speeds of A and B along their courses, and where they were found.

    ``inputs`` are those of ``eccentric`` with duration and tyres, in which the velocities count for
    nothing; ``directions`` has cosine and sine of each course by "a" and "b", ``instant`` the
    speeds that were found without tyres, below 0 for a motion backwards, ``known`` what was known,
    by the arguments of ``speeds``. Energies are those of the contact, without what the tyres take.
    More components of delta-V than are needed are met by least squares, all weighing alike as parts
    of the impulse, and a speed or an energy beside them exactly, as ``speeds`` does: the directions
    in which they are met are those of the start.
    """
    start = [np.broadcast_to(np.asarray(speed, np.float64), shape) for speed in instant]
    speed = np.hypot(*start)
    sizes = [np.where(speed > 0.0, speed, 1.0)] * 2

    def inputs_at(values: Sequence[Any]) -> Inputs:
        a, b = (
            moved(body, value * directions[label][0], value * directions[label][1], body.yaw_rate)
            for label, body, value in zip("ab", (inputs.a, inputs.b), values, strict=True)
        )
        return replace(inputs, a=a, b=b, given=None, contact_velocity=None)

    def off(tried: Inputs, answer: Any) -> list[Any]:
        """By how much each known value is missed, as a share of its size."""
        return [
            part / sizes[0]
            for name, value in known.items()
            for part in _missed(name, value, known, tried, answer, directions)
        ]

    rows = slopes_at(inputs_at, start, sizes, off)
    if len(rows) == 2:
        return _found(*settle(inputs_at, start, sizes, off))

    exact = [
        not name.startswith(("delta_v_forward", "delta_v_left"))
        for name in known
        if name not in _STANDS_FOR_NONE
    ]

    def equations(tried: Inputs, answer: Any) -> list[Any]:
        left = off(tried, answer)
        met = [one for one, alone in zip(left, exact, strict=True) if alone]
        if not met:
            return [
                sum(row[i] * one for row, one in zip(rows, left, strict=True)) for i in range(2)
            ]
        # Along what leaves the exact one as it is.
        x, y = rows[exact.index(True)]
        size = np.hypot(x, y)
        rest = sum(
            (row[1] * x - row[0] * y) / size * one
            for row, one, alone in zip(rows, left, exact, strict=True)
            if not alone
        )
        return [*met, rest][:2]

    return _found(*settle(inputs_at, start, sizes, equations))


def _found(values: Sequence[Any], settled: Any) -> tuple[Any, Any, Any]:
    return values[0], values[1], settled


def _missed(
    name: str,
    value: Any,
    known: Mapping[str, Any],
    tried: Inputs,
    answer: Any,
    directions: Mapping[str, tuple[Any, Any]],
) -> list[Any]:
    """By how much a known value is missed, as a speed: none for what another one stands for."""
    label = name[-1]
    body: Any = getattr(tried, label, None)
    if name.startswith("speed"):
        c, s = directions[label]
        return [c * body.vx + s * body.vy - value]
    if name.startswith("delta_v"):
        dvx, dvy = (getattr(answer, f"delta_{axis}_{label}") for axis in ("vx", "vy"))
        if name in ("delta_v_a", "delta_v_b"):
            return [np.hypot(dvx, dvy) - value]
        c, s = from_radians(body.heading)
        along = c * dvx + s * dvy if "forward" in name else c * dvy - s * dvx
        # A part of the impulse, as a speed of both together.
        weight = body.mass / (tried.a.mass + tried.b.mass)
        return [weight * (along - value)]
    if name in _STANDS_FOR_NONE:
        return []
    lost = answer.energy_loss
    if name.startswith("ees"):
        value = energy_of_speeds(tried.a.mass, value, tried.b.mass, known["ees_b"])
    elif name.startswith("max_crush"):
        value = energy_of_speeds(tried.a.mass, value, tried.b.mass, known["max_crush_speed_b"])
        absorbed = 0.5 * answer.closing_speed * answer.compression_impulse
        # An incomplete contact absorbs until it ends.
        lost = np.where(tried.restitution < 0.0, answer.energy_loss_normal, absorbed)
    # Energies as the speeds that they stand for.
    light = np.minimum(tried.a.mass, tried.b.mass)
    return [np.sqrt(2.0 * np.maximum(lost, 0.0) / light) - np.sqrt(2.0 * value / light)]
