"""The survey of a path as arguments: points, headings and their errors."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from ..directions import Angle
from ..drag import one_value
from ..errors import InputError, MissingInputError, ShapeError
from ..reading import ArgumentReader, at_least_zero
from ..units import is_quantity, shown

# What a heading may turn by from one point to the next.
HALF_TURN = math.pi * (1.0 + 1e-9)


def _parts(reader: ArgumentReader, value: Any, unit: str, name: str, shape: str) -> list[Any] | None:
    """The entries of a list, or the rows of an array of shape (n,) or (n, 2); None for anything else."""
    if isinstance(value, (list, tuple)):
        return list(value)
    count = len(reader.problems)
    read = reader.number(value, unit, name)
    got = read.shape if isinstance(read, np.ndarray) else ()
    if len(got) == shape.count("n") + shape.count("2") and got[1:] in ((), (2,)):
        rows: list[Any] = read.tolist()
        return rows
    if len(reader.problems) == count:
        what = f"an array of shape {got}" if got else "one number"
        text = f"{name} is {what}; give a list with one for each point, or an array of shape {shape}"
        reader.refuse(ShapeError(text, code="bad_shape", argument=name))
    return None


def read_points(reader: ArgumentReader, points: Any) -> list[tuple[Any, Any]] | None:
    """The positions, at least two and of a single case no two in a row alike; None if they could not be read."""
    parts = _parts(reader, points, "m", "points", "(n, 2)")
    if parts is None:
        return None
    wrong = len(reader.problems)
    places = []
    for i, part in enumerate(parts):
        name = f"points[{i}]"
        if not _is_pair(part):
            reader.refuse(ShapeError(f"{name} must be a pair (x, y), got {shown(part)}", code="bad_shape", argument=name))
            continue
        places.append(reader.pair(part, "m", name))
    if len(reader.problems) > wrong:
        return None
    if len(places) < 2:
        text = f"points holds {len(places)}, and a path needs at least two: separation first, the end of the run-out last"
        reader.refuse(ShapeError(text, code="too_few_points", argument="points"))
        return None
    for i, (before, after) in enumerate(pairwise(places)):
        if all(isinstance(part, float) for part in (*before, *after)) and before == after:
            reader.refuse(
                InputError(
                    f"points[{i}] and points[{i + 1}] are the same place ({before[0]:.6g}, {before[1]:.6g}), which has no "
                    f"course; leave one out",
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
    # Counted on through turns, headings grow beyond the size at which the reader suspects degrees; it looks at the first alone.
    reader.trusted = ("headings",)
    parts = _parts(reader, headings, "rad", "headings", "(n,)")
    if parts is None:
        return []
    reader.trusted = [f"headings[{i}]" for i in range(1, len(parts))]
    wrong = len(reader.problems)
    angles = [_read_heading(reader, part, f"headings[{i}]") for i, part in enumerate(parts)]
    if len(reader.problems) > wrong:
        return []
    turned = [in_radians(angle) for angle in angles]
    if count is not None and len(turned) != count:
        text = f"headings holds {len(turned)} and points holds {count}; give one heading for each point"
        reader.refuse(ShapeError(text, code="bad_shape", argument="headings"))
    for i, (before, after) in enumerate(pairwise(turned)):
        if not (isinstance(before, float) and isinstance(after, float)):
            continue
        turn = after - before
        if abs(turn) > HALF_TURN:
            part = headings[i + 1] if isinstance(headings, (list, tuple)) else headings
            bare = not (isinstance(part, str) or is_quantity(part))
            radians = f"; bare numbers are radians, so write degrees as '{after:.6g} deg'" if bare else ""
            reader.refuse(
                InputError(
                    f"headings[{i}] to headings[{i + 1}] turn by {math.degrees(turn):.6g} deg, and at most half a turn can be "
                    f"told: count headings on without a jump at a full turn (350 deg, then 370 deg), and give points between "
                    f"for a faster spin{radians}",
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
            read[name] = [at_least_zero(reader, error, value, name, "negative_length", "it is a standard deviation")]
    if len(read) == 1:
        (one,) = read
        (other,) = given.keys() - read
        text = f"{other} is missing beside {one}; give 0 if those readings are exact"
        reader.refuse(MissingInputError(text, code="missing_error", argument=other))
    return read if len(read) == 2 else {}
