"""Areas of other friction as callers give them: corners and friction, read and checked."""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import combinations
from typing import Any, TypeAlias

import numpy as np

from ..messages.errors import InputError, ShapeError
from ..quantities.reading import ArgumentReader
from ..quantities.units import shown
from ..vehicle.drag import read_friction

Place: TypeAlias = tuple[float, float]

# Directions within this angle [rad] are one.
_ONE_WAY = 1e-9
# Of the square of its extent: below it an area is rounding.
_NO_AREA = 1e-12
# Whether the sides of an area cross takes a time that grows with the square of their number.
_MOST_CORNERS = 1000
_AROUND = (
    "give its corners `(x, y)` one after another around it, such as "
    "`[(20, -5), (30, -5), (30, 5), (20, 5)]`"
)


def read_areas(reader: ArgumentReader, surfaces: Any) -> list[tuple[tuple[Place, ...], Any]]:
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
        if len(corners) > _MOST_CORNERS:
            text = (
                f"surfaces[{i}] has {len(corners)} corners, and an area has at most "
                f"{_MOST_CORNERS}; leave out those without which its edge is the same"
            )
            reader.refuse(InputError(text, code="bad_outline", argument="surfaces"))
            continue
        places = tuple(
            reader.pair(place, "m", f"surfaces[{i}][0][{j}]") for j, place in enumerate(corners)
        )
        if any(isinstance(part, np.ndarray) for place in places for part in place):
            text = f"surfaces[{i}] has an array among its corners; they are the same for every case"
            reader.refuse(ShapeError(text, code="bad_shape", argument="surfaces"))
            continue
        if wrong := _no_area(places):
            text = f"surfaces[{i}] {wrong}; {_AROUND}"
            reader.refuse(InputError(text, code="bad_outline", argument="surfaces"))
            continue
        name = f"surfaces[{i}]"
        areas.append((places, read_friction(reader, area[1], name, f"the friction of {name}")))
    return areas


@lru_cache(maxsize=64)
def _no_area(corners: tuple[Place, ...]) -> str:
    """Why corners are not those of an area; "" if they are. Sides may touch, and go there and back
    along one line, as around a hole.
    """
    if not all(math.isfinite(part) for place in corners for part in place):
        return ""  # refused by its number
    # In a unit of about its size, a power of two, which changes no digit: no product overflows.
    _, power = math.frexp(max(abs(part) for place in corners for part in place))
    corners = tuple((math.ldexp(x, -power), math.ldexp(y, -power)) for x, y in corners)
    count = len(corners)
    sides = [(i, (i + 1) % count) for i in range(count)]
    for one, other in combinations(sides, 2):
        (p, q), (r, s) = ((corners[i], corners[j]) for i, j in (one, other))
        ends = _side(p, q, r), _side(p, q, s)
        if ends[0] * ends[1] < 0 and _side(r, s, p) * _side(r, s, q) < 0:
            return f"has sides that cross, from corner {_listed(one, other)}"
        # What lies within an area counts by how often its sides go around it: twice is not at all.
        if ends == (0, 0) and p != q and _share(p, q, r, s):
            return f"goes twice along one line, from corner {_listed(one, other)}"
    for place in dict.fromkeys(corners):
        for one, other in combinations(_through(corners, place), 2):
            if _interleaved(place, *(corners[i] for i in (*one, *other))):
                x, y = (math.ldexp(part, power) for part in place)
                return (
                    f"has sides that cross at ({x:g}, {y:g}) m, from corner {_listed(one, other)}"
                )
    (x0, y0), ahead = corners[0], (*corners[1:], corners[0])
    area = 0.5 * abs(
        math.fsum(
            (x - x0) * (v - y0) - (u - x0) * (y - y0)
            for (x, y), (u, v) in zip(corners, ahead, strict=True)
        )
    )
    extent = max(max(parts) - min(parts) for parts in zip(*corners, strict=True))
    return "" if area > _NO_AREA * extent * extent else "encloses no area"


def _listed(one: tuple[int, int], other: tuple[int, int]) -> str:
    return f"{one[0]} to {one[1]} and from {other[0]} to {other[1]}"


def _side(p: Place, q: Place, place: Place) -> int:
    """On which side of the line from p to q a place lies: 1, -1 or 0."""
    found = (q[0] - p[0]) * (place[1] - p[1]) - (q[1] - p[1]) * (place[0] - p[0])
    return (found > 0.0) - (found < 0.0)


def _share(p: Place, q: Place, r: Place, s: Place) -> bool:
    """Whether two sides in one line, from p to q and from r to s, share a part of it and go the
    same way.
    """
    x, y = q[0] - p[0], q[1] - p[1]
    along = [x * (place[0] - p[0]) + y * (place[1] - p[1]) for place in (r, s)]
    return along[0] < along[1] and along[1] > 0.0 and along[0] < x * x + y * y


def _through(corners: tuple[Place, ...], place: Place) -> list[tuple[int, int]]:
    """The corners before and after a place, each time that the sides come through it."""
    count, found = len(corners), []
    for i, corner in enumerate(corners):
        ahead = (i + 1) % count
        if corner == place:
            # A corner that is given twice in a row is one.
            if corners[i - 1] != place:
                while corners[ahead] == place and ahead != i:
                    ahead = (ahead + 1) % count
                found.append(((i - 1) % count, ahead))
        elif corners[ahead] != place and _side(corner, corners[ahead], place) == 0:
            ways = (
                (corner[0] - place[0]) * (corners[ahead][0] - place[0])
                + (corner[1] - place[1]) * (corners[ahead][1] - place[1])
            )  # fmt: skip
            if ways < 0.0:
                found.append((i, ahead))
    return found


def _interleaved(place: Place, *ends: Place) -> bool:
    """Whether, around a place, just one of the last two of four others lies between the first
    two; not where two lie in one direction.
    """
    angles = [math.atan2(end[1] - place[1], end[0] - place[0]) for end in ends]
    turned = [(angle - angles[0]) % math.tau for angle in angles[1:]]
    alike = any(
        abs(math.remainder(one - other, math.tau)) < _ONE_WAY
        for one, other in combinations(angles, 2)
    )
    return not alike and (turned[1] < turned[0]) != (turned[2] < turned[0])
