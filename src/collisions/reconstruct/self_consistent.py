"""A number that depends on the answer it leads to: found where the two agree."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..errors import InputError

_STEPS = 60


def crossings(mismatch: Callable[[Any], Any], grid: Any) -> list[tuple[int, float]]:
    """Every root of each row of ``mismatch(values)`` that the grid shows: row and root.

    NaN marks where a row has no answer. A sign change is bisected, also between the grid and the place where a row ends;
    where the mismatch comes near 0 and turns away again, its turning point is looked at, for two roots may hide there. A
    pole is found too: the caller tells it from a root by what it leads to.
    """
    found: list[tuple[int, float]] = []
    for row, values in enumerate(mismatch(grid)):

        def at(x: float, row: int = row) -> float:
            return float(mismatch(np.array([x]))[row][0])

        brackets = [(grid[i], grid[i + 1]) for i in range(len(grid) - 1) if values[i] * values[i + 1] < 0.0]
        for i in range(len(grid) - 1):
            for inside, outside in ((i, i + 1), (i + 1, i)):
                if np.isfinite(values[inside]) and np.isnan(values[outside]):
                    end = _end_of_row(at, grid[inside], grid[outside])
                    if at(end) * values[inside] < 0.0:
                        brackets.append((min(end, grid[inside]), max(end, grid[inside])))
        for i in range(1, len(grid) - 1):
            here, sides = abs(values[i]), (abs(values[i - 1]), abs(values[i + 1]))
            if here <= min(sides) and values[i - 1] * values[i] > 0.0 and values[i] * values[i + 1] > 0.0:
                turn = _turning_point(at, grid[i - 1], grid[i + 1], float(np.sign(values[i])))
                if at(turn) * values[i] < 0.0:
                    brackets += [(grid[i - 1], turn), (turn, grid[i + 1])]
        found += [(row, float(x)) for x, value in zip(grid, values, strict=True) if value == 0.0]
        found += [(row, _bisected(at, float(low), float(high))) for low, high in brackets]
    return found


def _bisected(at: Callable[[float], float], low: float, high: float) -> float:
    falling = at(low) > 0.0
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if (at(middle) > 0.0) == falling:
            low = middle
        else:
            high = middle
    return low


def _end_of_row(at: Callable[[float], float], inside: float, outside: float) -> float:
    """The last place towards ``outside`` that has an answer."""
    for _ in range(_STEPS):
        middle = 0.5 * (inside + outside)
        if np.isnan(at(middle)):
            outside = middle
        else:
            inside = middle
    return inside


def _turning_point(at: Callable[[float], float], low: float, high: float, sign: float) -> float:
    """Where the magnitude is least between two places, or where it first changes sign."""
    for _ in range(_STEPS):
        one, other = low + (high - low) / 3.0, high - (high - low) / 3.0
        a, b = sign * at(one), sign * at(other)
        if a < 0.0 or b < 0.0:
            return one if a < b else other
        low, high = (low, other) if a < b else (one, high)
    return 0.5 * (low + high)


class RestitutionOf:
    """A caller's function of the closing speed, whose values outside 0 to 1 are no answer."""

    def __init__(self, function: Callable[[float], Any]) -> None:
        self.function = function
        self.refused = ""

    def __call__(self, closing: Any) -> Any:
        """Restitution at each closing speed; NaN where the function has none."""
        return np.array([self._one(float(speed)) for speed in closing])

    def _one(self, closing: float) -> float:
        if not closing > 0.0:
            return float("nan")
        try:
            e = float(self.function(closing))
        except Exception as error:
            self.refused = f"restitution({closing:.6g}) raised {type(error).__name__}: {error}"
            return float("nan")
        if not 0.0 <= e <= 1.0:
            self.refused = f"restitution({closing:.6g}) gave {e:.6g}, which is not from 0 to 1"
            return float("nan")
        return e

    def complain(self) -> None:
        """Refuses a function that had no value where one was needed."""
        if self.refused:
            raise InputError(
                f"{self.refused}: the function takes closing speeds in m/s, and must hold where the answer lies",
                code="bad_restitution",
                argument="restitution",
            )
