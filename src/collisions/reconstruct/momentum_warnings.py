"""What planar momentum warns of, once for a batch: courses near one line, motion backwards, and answers that are no impact."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..errors import EnergyGainWarning, IllConditionedWarning, OutOfRangeWarning
from ..warning import warn, warn_of_cases
from .common import Cases
from .momentum_solution import Sensitivity

_NEARLY_COLLINEAR = math.radians(10.0)


def warn_of_speeds(
    cases: Cases,
    sure: Any,
    full: dict[str, Any],
    unknowns: tuple[str, str],
    sine: Any,
    condition: Any,
    sensitivity: Sensitivity,
    rounding: Any,
) -> None:
    """Says how little the answers may be worth."""
    near = sure & (sine < math.sin(_NEARLY_COLLINEAR))
    if np.any(near):
        worst = float(np.max(np.where(near, condition, 0.0)))
        degrees = math.degrees(math.asin(float(np.min(np.where(near, sine, 1.0)))))
        numbers = "; ".join(_most(answer, row, near) for answer, row in sensitivity.items())
        warn(
            IllConditionedWarning(
                f"{_count(near, cases)}the courses of {' and '.join(unknowns)} are {degrees:.2g} degrees from one line "
                f"(condition {worst:.3g}): {numbers}; an in-line method may tell more",
                code="nearly_collinear",
                condition=worst,
            )
        )
    for name in unknowns:
        # What rounding leaves of 0 is no motion backwards.
        backward = sure & (full[name] < -rounding)
        if np.any(backward):
            least = float(np.min(np.where(backward, full[name], 0.0)))
            warn(
                OutOfRangeWarning(
                    f"{_count(backward, cases)}{name} = {least:.6g} m/s: backwards along its course; check the courses, or "
                    f"turn this one by 180 deg",
                    code="negative_speed",
                    value=least,
                )
            )


def warn_of_physics(cases: Cases, gains: Any, solution: dict[str, Any], rounding: Any) -> None:
    """Says where the answers are no impact."""
    if np.any(gains):
        most = -float(np.min(np.where(gains, solution["translational_energy_loss"], 0.0)))
        warn_of_cases(
            EnergyGainWarning(
                f"{_count(gains, cases)}the vehicles leave with {most:.6g} J more than they came with, which no impact gives; "
                f"check courses and speeds",
                code="energy_gain",
                gain=most,
            )
        )
    closing, e = solution["closing_speed"], solution["restitution"]
    if closing is None:
        return
    apart = closing <= 0.0
    if np.any(apart):
        least = float(np.min(np.where(apart, closing, 0.0)))
        warn(
            OutOfRangeWarning(
                f"{_count(apart, cases)}the centres do not approach along the normal, which must point from A into B: closing "
                f"speed {least:.6g} m/s, so there is no restitution",
                code="separating",
                closing_speed=least,
            )
        )
    slack = rounding / closing
    outside = (e < -slack) | (e > 1.0 + slack)
    if np.any(outside):
        worst = float(np.min(np.where(outside, e, np.inf)))
        worst = worst if worst < 0.0 else float(np.max(np.where(outside, e, 0.0)))
        warn(
            OutOfRangeWarning(
                f"{_count(outside, cases)}the restitution of the centres along the normal is {worst:.4g}, outside 0 to 1: "
                f"check the normal, courses and speeds, or ask reconstruct.restitution with the contact point",
                code="observed_restitution",
                value=worst,
            )
        )


def _most(answer: str, row: dict[str, Any], near: Any) -> str:
    """The course that an answer depends on most, and by how much."""
    moves = {name: float(np.max(np.where(near, abs(value), 0.0))) for name, value in row.items() if name.startswith("course")}
    name = max(moves, key=moves.__getitem__)
    return f"{answer} moves by {moves[name] * math.pi / 180.0:.3g} m/s per degree of {name}"


def _count(lanes: Any, cases: Cases) -> str:
    return "" if cases.shape is None else f"{int(np.count_nonzero(np.broadcast_to(lanes, cases.shape)))} cases: "
