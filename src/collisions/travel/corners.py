"""Areas of other friction as callers give them: corners and friction, read and checked."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np

from ..messages.errors import InputError, ShapeError
from ..quantities.reading import ArgumentReader
from ..quantities.units import shown
from ..vehicle.drag import read_friction

# Of the square of its extent: below it an area is rounding.
_NO_AREA = 1e-12
_AROUND = (
    "give its corners `(x, y)` one after another around it, such as "
    "`[(20, -5), (30, -5), (30, 5), (20, 5)]`"
)


def read_areas(
    reader: ArgumentReader, surfaces: Any
) -> list[tuple[tuple[tuple[float, float], ...], Any]]:
    """Corners and friction of each area; refuses corners that enclose none, or whose sides cross,
    as those of an exchanged pair do.
    """
    areas = []
    for i, area in enumerate(surfaces if isinstance(surfaces, (list, tuple)) else [surfaces]):
        corners = area[0] if isinstance(area, (list, tuple)) and len(area) == 2 else None
        if not isinstance(corners, (list, tuple)) or len(corners) < 3:
            text = (
                f"surfaces[{i}] must be a pair of corners, three or more `(x, y)` in a list, "
                f"and friction; got {shown(area)}"
            )
            reader.refuse(ShapeError(text, code="bad_shape", argument="surfaces"))
            continue
        places = tuple(
            reader.pair(place, "m", f"surfaces[{i}][0][{j}]") for j, place in enumerate(corners)
        )
        if any(isinstance(part, np.ndarray) for place in places for part in place):
            text = f"surfaces[{i}] has an array among its corners; they are the same for every case"
            reader.refuse(ShapeError(text, code="bad_shape", argument="surfaces"))
            continue
        if wrong := _no_area(np.array(places)):
            text = f"surfaces[{i}] {wrong}; {_AROUND}"
            reader.refuse(InputError(text, code="bad_outline", argument="surfaces"))
            continue
        areas.append((places, read_friction(reader, area[1], f"surfaces[{i}]")))
    return areas


def _no_area(corners: Any) -> str:
    """Why corners are not those of an area; "" if they are. Sides may touch, as around a hole."""
    if not np.all(np.isfinite(corners)):
        return ""  # refused by its number
    ends = np.roll(corners, -1, axis=0)
    for i, j in combinations(range(len(corners)), 2):
        (p, q), (r, s) = (corners[i], ends[i]), (corners[j], ends[j])
        if _side(p, q, r) * _side(p, q, s) < 0.0 and _side(r, s, p) * _side(r, s, q) < 0.0:
            after_i, after_j = ((k + 1) % len(corners) for k in (i, j))
            return f"has sides that cross, from corner {i} to {after_i} and from {j} to {after_j}"
    x, y = (corners - corners[0]).T
    area = 0.5 * abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    extent = float(np.max(np.ptp(corners, axis=0)))
    return "" if area > _NO_AREA * extent * extent else "encloses no area"


def _side(p: Any, q: Any, place: Any) -> float:
    """On which side of the line from p to q a place lies: 1, -1 or 0."""
    return float(np.sign((q[0] - p[0]) * (place[1] - p[1]) - (q[1] - p[1]) * (place[0] - p[0])))
