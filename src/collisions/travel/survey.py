"""The survey of a path: points, headings and their errors as arguments, and a smooth path through
them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from itertools import pairwise
from typing import Any

import numpy as np

from ..messages.errors import InputError, MissingInputError, ShapeError
from ..quantities.directions import Angle
from ..quantities.reading import ArgumentReader, at_least_zero
from ..quantities.refusals import must_be
from ..quantities.settings import in_si, units_required
from ..quantities.units import has_unit, is_quantity
from ..vehicle.drag import one_value

# What a heading may turn by from one point to the next.
HALF_TURN = math.pi * (1.0 + 1e-9)
# A share of the window: with this standard deviation, weights that fall off as a normal density err
# in the slope at the end of a path as equal weights within the window do, by the errors of the
# points and by a bend that changes along the way alike.
_SPREAD = 0.384
# The first lengths are those of the chords between the points, which errors of a dense survey make
# too long.
_PASSES = 3


def _parts(
    reader: ArgumentReader, value: Any, unit: str, name: str, row: tuple[int, ...]
) -> list[Any] | None:
    """The entries of a list, or the rows of an array if each has the shape ``row``; None for
    anything else.
    """
    if isinstance(value, (list, tuple)):
        return list(value)
    count = len(reader.problems)
    read = reader.number(value, unit, name)
    got = read.shape if isinstance(read, np.ndarray) else ()
    if got and got[1:] == row:
        rows: list[Any] = read.tolist()
        return rows
    if len(reader.problems) == count:
        what = f"an array of shape {got}" if got else "one number"
        text = (
            f"{name} is {what}; give a list with one for each point, or an array of shape "
            f"{'(n, 2)' if row else '(n,)'}"
        )
        reader.refuse(ShapeError(text, code="bad_shape", argument=name))
    return None


def _as_read(value: Any) -> AbstractContextManager[None]:
    """Within this context the entries of an array, which was read as a whole, need no unit."""
    return nullcontext() if isinstance(value, (list, tuple)) else in_si()


def read_points(reader: ArgumentReader, points: Any) -> list[tuple[Any, Any]] | None:
    """The positions, at least two and of a single case no two in a row alike; None if they could
    not be read.
    """
    parts = _parts(reader, points, "m", "points", (2,))
    if parts is None:
        return None
    wrong = len(reader.problems)
    places = []
    with _as_read(points):
        for i, part in enumerate(parts):
            name = f"points[{i}]"
            if not _is_pair(part):
                text = "a pair `(x, y)`"
                reader.refuse(must_be(name, text, part, code="bad_shape", kind=ShapeError))
                continue
            places.append(reader.pair(part, "m", name))
    if len(reader.problems) > wrong:
        return None
    if len(places) < 2:
        text = (
            f"points holds {len(places)}, and a path needs at least two: separation first, the "
            "end of the run-out last"
        )
        reader.refuse(ShapeError(text, code="too_few_points", argument="points"))
        return None
    for i, (before, after) in enumerate(pairwise(places)):
        if all(isinstance(part, float) for part in (*before, *after)) and before == after:
            reader.refuse(
                InputError(
                    f"points[{i}] and points[{i + 1}] are the same place `({before[0]:.6g}, "
                    f"{before[1]:.6g})`, which has no course; leave one out",
                    code="coincident_points",
                    argument="points",
                )
            )
    return places


def _is_pair(value: Any) -> bool:
    whole = value.magnitude if is_quantity(value) else value
    if isinstance(whole, np.ndarray):
        return whole.ndim == 1 and len(whole) == 2
    return isinstance(whole, (list, tuple)) and len(whole) == 2


def read_headings(reader: ArgumentReader, headings: Any, count: int | None) -> list[Angle]:
    """One heading for each point; ``count`` is None if the points could not be read."""
    # Counted on through turns, headings grow beyond the size at which the reader suspects degrees;
    # it looks at the first alone.
    reader.trusted = () if units_required.get() else ("headings",)
    parts = _parts(reader, headings, "rad", "headings", ())
    if parts is None:
        return []
    # An array was read as a whole; of a list each has a unit where one is required.
    listed = isinstance(headings, (list, tuple))
    if not (listed and units_required.get()):
        first = 1 if listed or not has_unit(headings) else 0
        reader.trusted = [f"headings[{i}]" for i in range(first, len(parts))]
    wrong = len(reader.problems)
    with _as_read(headings):
        angles = [_read_heading(reader, part, f"headings[{i}]") for i, part in enumerate(parts)]
    if len(reader.problems) > wrong:
        return []
    turned = [in_radians(angle) for angle in angles]
    if count is not None and len(turned) != count:
        text = (
            f"headings holds {len(turned)} and points holds {count}; give one heading for each "
            "point"
        )
        reader.refuse(ShapeError(text, code="bad_shape", argument="headings"))
    for i, (before, after) in enumerate(pairwise(turned)):
        if not (isinstance(before, float) and isinstance(after, float)):
            continue
        turn = after - before
        if abs(turn) > HALF_TURN:
            part = headings[i + 1] if isinstance(headings, (list, tuple)) else headings
            bare = not (isinstance(part, str) or is_quantity(part))
            radians = (
                f"; bare numbers are radians, so write degrees as '{after:.6g} deg'" if bare else ""
            )
            reader.refuse(
                InputError(
                    f"headings[{i}] to headings[{i + 1}] turn by {math.degrees(turn):.6g} deg, "
                    "and at most half a turn can be told: count headings on without a jump at a "
                    "full turn (350 deg, then 370 deg), and give points between for a faster "
                    f"spin{radians}",
                    code="turns_too_far",
                    argument="headings",
                )
            )
            break
    return angles


def in_radians(heading: Angle) -> Any:
    """Degrees to radians; a float stays a float."""
    return heading.value * (math.pi / 180.0) if heading.in_degrees else heading.value


def _read_heading(reader: ArgumentReader, value: Any, name: str) -> Angle:
    if isinstance(value, (list, tuple)):
        return Angle(one_value(reader, value, "rad", name), False)
    return Angle(*reader.angle(value, name))


def read_errors(reader: ArgumentReader, point: Any, heading: Any) -> dict[str, list[Any]]:
    """The standard errors of the survey, both or none."""
    given = {"point_error": (point, "m"), "heading_error": (heading, "rad")}
    read = {}
    for name, (value, unit) in given.items():
        if value is not None:
            error = one_value(reader, value, unit, name)
            read[name] = [
                at_least_zero(
                    reader, error, value, name, "negative_length", "it is a standard deviation"
                )
            ]
    if len(read) == 1:
        (one,) = read
        (other,) = given.keys() - read
        text = f"{other} is missing beside {one}; give 0 if those readings are exact"
        reader.refuse(MissingInputError(text, code="missing_error", argument=other))
    return read if len(read) == 2 else {}


def smooth(columns: Sequence[Sequence[Any]], window: Any, kind: Any) -> tuple[list[list[Any]], Any]:
    """x, y and heading at every point of a smooth path, and the weight of every point for the
    tangents at the first.
    """
    given, spread = _stacked(columns, window)
    found, spread = given, _SPREAD * spread
    for _ in range(_PASSES):
        steps = np.hypot(*np.diff(found[:2], axis=1))
        lengths = np.concatenate([0.0 * steps[:1], np.cumsum(steps, axis=0)])
        weights = [_weights(lengths, i, spread) for i in range(len(lengths))]
        found = np.stack(
            [_parabola(lengths, given, weight, i)[0] for i, weight in enumerate(weights)], axis=1
        )
    return [list(row) for row in _rows(found, kind)], (lengths, weights[0])


def slopes(columns: Sequence[Sequence[Any]], at: Any, weights: Any, kind: Any) -> list[Any]:
    """Slope of each column over ``at``, at the first point."""
    (*values, at), _ = _stacked([*columns, at])
    weights = weights.reshape(len(at), *(1,) * (at.ndim - weights.ndim), *weights.shape[1:])
    return _rows(_parabola(at, np.array(values), weights, 0)[1], kind)


def _stacked(columns: Sequence[Sequence[Any]], beside: Any = 0.0) -> tuple[Any, Any]:
    """An array of columns, points and cases, and another number of the same cases."""
    *parts, last = np.broadcast_arrays(*(part for column in columns for part in column), beside)
    return np.array(parts, dtype=float).reshape(len(columns), len(columns[0]), *last.shape), last


def _rows(found: Any, kind: Any) -> list[Any]:
    """The rows of an array in the precision of a batch; lists of floats, or floats, of a single
    case.
    """
    return list(found.astype(kind)) if kind is not None else list(found.tolist())


def _weights(lengths: Any, i: int, spread: Any) -> Any:
    """The weight of every point for the parabola at point i; two more points count, however far
    away they are.
    """
    last = len(lengths) - 1
    if last < 3:
        return np.ones_like(lengths)
    far = np.maximum(
        lengths[i] - lengths[max(min(i - 1, last - 2), 0)],
        lengths[min(max(i + 1, 2), last)] - lengths[i],
    )
    # Divided before it is squared, which might overflow.
    return np.exp(-0.5 * ((lengths - lengths[i]) / np.maximum(spread, 0.25 * far)) ** 2)


def _parabola(at: Any, values: Any, weights: Any, i: int) -> tuple[Any, Any]:
    """Value and slope at point i of the parabola of weighted least squares; ``values`` has the
    points on its second axis.

    By polynomials that are orthogonal over the points, and from point i: coordinates of a map lose
    no digits.
    """
    if len(at) == 3:
        # By divided differences, which lose no digits however unequal the two ways are.
        j, k = (other for other in range(3) if other != i)
        first = (values[:, j] - values[:, i]) / (at[j] - at[i])
        second = ((values[:, k] - values[:, j]) / (at[k] - at[j]) - first) / (at[k] - at[i])
        return values[:, i], first - second * (at[j] - at[i])
    size = at[-1]
    t = (at - at[i]) / size
    rise = values - values[:, i : i + 1]
    total = weights.sum(axis=0)
    mean = (weights * t).sum(axis=0) / total
    one = t - mean
    square = (weights * one * one).sum(axis=0)
    skew = (weights * one * one * one).sum(axis=0) / square
    two = one * (one - skew) - square / total
    first = (weights * one * rise).sum(axis=1) / square
    second = (
        (weights * two * rise).sum(axis=1) / (weights * two * two).sum(axis=0)
        if len(at) > 2
        else 0.0 * first
    )
    # Through three points or two it passes, whatever the rounding.
    value = (
        (weights * rise).sum(axis=1) / total - first * mean + second * two[i]
        if len(at) > 3
        else 0.0
    )
    return values[:, i] + value, (first - second * (2.0 * mean + skew)) / size
