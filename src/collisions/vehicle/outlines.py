"""Outlines of vehicles: read as arguments, placed in the scene, and how deep two of
them overlap.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..kernels.elementwise import POSITIVE
from ..messages.errors import InputError, ShapeError
from ..quantities.directions import from_radians
from ..quantities.reading import ArgumentReader, warn_if_large
from ..quantities.units import has_unit, is_quantity, shown
from .vehicle import Vehicle, needed

# A corner whose sine is within this of 0 is straight, not a dent.
_STRAIGHT = 1e-9
# In metres: no road vehicle is larger, so a bare number beyond is in another unit.
_LIKELY = (("length", 30.0), ("width", 3.5))
# In metres: sums of larger ones leave the range of floats.
_LARGEST = 1e306


def read_outline(reader: ArgumentReader, given: Any, argument: str) -> Any:
    """Corners (forward, left) from the centre of mass, counter-clockwise: from length and width, or
    from corners.
    """
    try:
        corners = _read(reader, given, argument)
        if corners is None or np.all(np.abs(corners) <= _LARGEST):
            return corners
        raise InputError(
            f"{argument} has a corner {np.max(np.abs(corners)):.3g} m from the centre of "
            f"mass, and may be {_LARGEST:g} m large at most; give metres, such as `(4.5, "
            "1.8)`",
            code="out_of_range",
            argument=argument,
        )
    except InputError as problem:
        reader.refuse(problem)
        return None


def _read(reader: ArgumentReader, given: Any, argument: str) -> Any:
    """The corners; None if the reader refused a number."""
    count = len(reader.problems)
    whole = given.magnitude if is_quantity(given) else given
    pairs = isinstance(given, (tuple, list)) and all(
        isinstance(part, (tuple, list)) and len(part) == 2 for part in given
    )
    if isinstance(whole, np.ndarray) and whole.ndim == 2 and whole.shape[1] == 2:
        read = reader.number(given, "m", argument)
        parts = [] if is_quantity(given) else given.reshape(-1).tolist()
    elif pairs and given:
        read = [reader.pair(part, "m", f"{argument}[{i}]") for i, part in enumerate(given)]
        parts = [part for corner in given for part in corner]
    elif isinstance(given, tuple) and len(given) in (2, 3):
        return _rectangle(reader, given, argument)
    else:
        raise _bad_shape(given, argument)
    if len(reader.problems) > count:
        return None
    if isinstance(read, list) and any(
        isinstance(number, np.ndarray) for corner in read for number in corner
    ):
        raise _bad_shape(given, argument)
    return _polygon(np.array(read, dtype=np.float64), parts, argument)


def _bad_shape(given: Any, argument: str) -> ShapeError:
    return ShapeError(
        f"{argument} must be `(length, width)`, `|(|[`length, width, how far the centre of mass is "
        "ahead of the middle`|)|]`, or at least three corners `(forward, left)` from the centre of "
        f"mass; got {shown(given)}",
        code="bad_shape",
        argument=argument,
    )


def _rectangle(reader: ArgumentReader, given: tuple[Any, ...], argument: str) -> Any:
    """The corners of a rectangle; None if the reader refused a number."""
    count = len(reader.problems)
    length, width = (
        reader.number(value, "m", f"{argument}[{i}] ({name})", POSITIVE)
        for i, (name, value) in enumerate(zip(("length", "width"), given, strict=False))
    )
    ahead = reader.number(given[2], "m", f"{argument}[2] (offset)") if len(given) == 3 else 0.0
    if len(reader.problems) > count:
        return None
    if any(isinstance(value, np.ndarray) for value in (length, width, ahead)):
        raise _bad_shape(given, argument)
    if not abs(ahead) < 0.5 * length < math.inf or math.isinf(width):
        raise InputError(
            f"{argument}: the centre of mass, {ahead:.6g} m ahead of the middle, is not within a "
            f"length of {length:.6g} m and a width of {width:.6g} m; both must be finite, and "
            "the offset less than half the length",
            code="bad_outline",
            argument=argument,
        )
    for value, read, (name, limit) in zip(given, (length, width), _LIKELY, strict=False):
        warn_if_large(value, read, limit, f"{argument} ({name})", "metres", "in", "mm")
    front, back, side = 0.5 * length - ahead, -0.5 * length - ahead, 0.5 * width
    return np.array([(front, side), (back, side), (back, -side), (front, -side)])


def _polygon(corners: Any, parts: Sequence[Any], argument: str) -> Any:
    """The corners of a convex polygon, with a warning if their ``parts`` without a unit make a
    vehicle that is too large.
    """
    if not np.any(np.abs(corners) > _LARGEST):  # refused for its size later
        corners = _convex(corners, argument)
    for axis, (name, limit) in enumerate(_LIKELY):
        bare = [float(part) for part in parts[axis::2] if not has_unit(part)]
        if bare:
            warn_if_large(
                None, max(bare) - min(bare), limit, f"{argument} ({name})", "metres", "in", "mm"
            )
    return corners


def _convex(corners: Any, argument: str) -> Any:
    """The corners counter-clockwise; refused if there is a dent or no area."""
    problem = ""
    if len(corners) < 3:
        problem = "has fewer than three corners"
    elif not np.all(np.isfinite(corners)):
        problem = "has a corner that is not finite"
    else:
        edges, lengths = _edges(corners)
        sines = _cross(edges, np.roll(edges, -1, axis=0))
        if np.all(sines <= _STRAIGHT) and np.any(sines < -_STRAIGHT):
            return _convex(corners[::-1], argument)
        angles = np.arctan2(edges[:, 1], edges[:, 0])
        around = np.sum((np.roll(angles, -1) - angles) % (2.0 * math.pi))
        if not np.any(sines > _STRAIGHT):
            problem = "has no area"
        elif np.any(sines < -_STRAIGHT) or not np.all(lengths) or around > 3.0 * math.pi:
            problem = "has a dent, a corner twice, or sides that cross"
    if problem:
        raise InputError(
            f"{argument} {problem}; give corners `(forward, left)` one after another around a "
            "convex outline, such as `[(2.2, 0.8), (-2.3, 0.9), (-2.3, -0.9), (2.2, -0.8)]`",
            code="bad_outline",
            argument=argument,
        )
    return corners


class Placed(NamedTuple):
    """An outline in the scene: its centre of mass, and the corners relative to it, which a distant
    origin cannot round.
    """

    x: float
    y: float
    corners: Any


def in_scene(outline: Any, vehicle: Vehicle, label: str, after: float = 0.0) -> Placed:
    """The outline at this time after the impact."""
    x, y, heading = (
        needed(vehicle, name, f"outline_{label}", label) for name in ("x", "y", "heading")
    )
    turn = vehicle.yaw_rate * after
    if vehicle.pivot is None:
        x, y = x + vehicle.vx * after, y + vehicle.vy * after
    else:
        px, py = vehicle.pivot
        c, s = from_radians(turn)
        x, y = px + c * (x - px) - s * (y - py), py + s * (x - px) + c * (y - py)
    c, s = from_radians(heading + turn)
    return Placed(
        x,
        y,
        np.stack(
            [c * outline[:, 0] - s * outline[:, 1], s * outline[:, 0] + c * outline[:, 1]], axis=1
        ),
    )


def distance_outside(outline: Placed, point: tuple[float, float]) -> float:
    """How far a point is from a convex polygon; 0 inside."""
    edges, lengths = _edges(outline.corners)
    to_point = np.array([point[0] - outline.x, point[1] - outline.y]) - outline.corners
    if np.all(_cross(edges, to_point) >= 0.0):
        return 0.0
    along = np.clip(np.sum(to_point * edges, axis=1), 0.0, lengths)
    return float(np.min(np.hypot(*(to_point - along[:, np.newaxis] * edges).T)))


def overlap(one: Placed, other: Placed) -> float:
    """Penetration depth of two convex polygons: the shortest shift that would separate them;
    negative for a gap.
    """
    least = math.inf
    apart = np.array([other.x - one.x, other.y - one.y])
    for outline in (one, other):
        for ex, ey in _edges(outline.corners)[0]:
            axis = np.array([ey, -ex])
            first, second, between = one.corners @ axis, other.corners @ axis, float(apart @ axis)
            ahead, behind = (
                float(first.max() - second.min()) - between,
                float(second.max() - first.min()) + between,
            )
            least = min(least, ahead, behind)
    return least


def _edges(corners: Any) -> tuple[Any, Any]:
    """The directions of the edges, (0, 0) between equal corners, and their lengths."""
    largest = float(np.max(np.abs(corners))) or 1.0
    # Scaled to numbers up to 1, whose differences cannot overflow.
    edges = np.roll(corners / largest, -1, axis=0) - corners / largest
    lengths = np.hypot(*edges.T)
    return edges / np.where(lengths == 0.0, 1.0, lengths)[:, np.newaxis], lengths * largest


def _cross(one: Any, other: Any) -> Any:
    return one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
