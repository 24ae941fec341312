"""``speed``, ``distance`` and ``time`` of a vehicle that slows along a line."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..kernels.elementwise import select
from ..messages.errors import NoSolutionError, ShapeError
from ..messages.hints import hinted
from ..quantities.reading import ArgumentReader
from ..quantities.tables import Sentences
from ..quantities.units import Input, Value, texts_of
from ..vehicle.drag import GRAVITY, read_drag
from .surfaces import (
    Segments,
    durations_along,
    for_each,
    in_one_precision,
    out_of_range,
    read_grade,
    read_length,
    read_speed,
    settle,
    speeds_along,
)


@hinted
def speed(
    distance: Segments, *, drag: Segments, grade: Segments = 0.0, end_speed: Input = 0.0
) -> Value:
    """Speed [m/s] at the start of a distance over which a vehicle slows.

    The drag takes a known amount of energy over each surface, so the speeds are chained backward
    from the end::

        v_start**2 = v_end**2 + 2 * GRAVITY * (drag + grade) * distance

    A list or tuple for ``distance`` is for several surfaces in order of travel; drag and grade are
    then one value for all, or a list of the same length. An array is for many cases; arrays
    broadcast, and may be the entries of a list.

    Parameters
    ----------
    distance : float, str, Quantity, array or list of these [m]
        Horizontal distance, >= 0.
    drag : float, str, Quantity, array or list of these [-]
        Drag factor, >= 0: a plain number such as 0.7, or a deceleration on the level such as ``"6.9
        m/s**2"``.
    grade : float, str, Quantity, array or list of these [-]
        Rise over run, positive uphill in the direction of travel; ``"-4 %"`` is downhill.
    end_speed : float, str, Quantity or array [m/s]
        Speed at the end of the distance, >= 0; 0 at rest.

    Returns
    -------
    float or array [m/s]
        Speed at the start along the slope, >= 0; NaN for a case of a batch that cannot be answered.

    Raises
    ------
    InputError
        Naming every argument that cannot be used.
    NoSolutionError
        No initial speed leads to this end: the ground would have had to take more energy than there
        was.

    Warns
    -----
    CollisionsWarning
        How many cases of a batch cannot be answered, and why.
    SuspectUnitsWarning
        A bare drag above 1.5 or a bare grade beyond 0.5, which is probably in another unit.

    Notes
    -----
    The vehicle is a point mass on a straight line or a gentle bend, and each surface has the same
    drag at every speed: load transfer, air resistance and the build-up time of the brakes are left
    out. A vehicle that spins has a different drag at every crab angle: see ``path``. On a slope at
    the angle atan(grade), the load and with it the drag are reduced by the factor cos(atan(grade)),
    and the distance in plan is shorter than that along the slope by the same factor, so the balance
    is exact. Speeds in plan are lower by that factor.

    Examples
    --------
    A slide of 66 ft to rest on asphalt with a drag factor of 0.65; a course sheet that rounds to 30
    f d gives 35.87 mph:

    >>> round(speed("66 ft", drag=0.65) / 0.44704, 2)
    35.82

    12 m on asphalt, then 8 m up a grass bank, into a tree at 20 km/h:

    >>> round(
    ...     speed([12.0, "8 m"], drag=[0.7, 0.45], grade=[0, "10 %"], end_speed="20 km/h") * 3.6, 1
    ... )
    60.4
    """
    return _over_surfaces(
        distance, drag, grade, end_speed, lambda lengths, grades, speeds: speeds[0]
    )


@hinted
def distance(speed: Input, *, drag: Input, grade: Input = 0.0, end_speed: Input = 0.0) -> Value:
    """Distance [m] over which a vehicle goes from one speed to another on one surface; the inverse
    of ``speed``.

    The energy balance is that of ``speed``, with the same limits::

        distance = (speed**2 - end_speed**2) / (2 * GRAVITY * (drag + grade))

    Parameters
    ----------
    speed : float, str, Quantity or array [m/s]
        Speed at the start, >= 0.
    drag : float, str, Quantity or array [-]
        Drag factor, >= 0, or a deceleration on the level.
    grade : float, str, Quantity or array [-]
        Rise over run, positive uphill in the direction of travel.
    end_speed : float, str, Quantity or array [m/s]
        Speed at the end, >= 0; above ``speed`` on a downhill grade that the drag does not hold.

    Returns
    -------
    float or array [m]
        Distance in plan, >= 0; NaN for a case of a batch that cannot be answered.

    Raises
    ------
    InputError
        Naming every argument that cannot be used.
    NoSolutionError
        The vehicle never reaches the end speed, or keeps it over any distance.

    Warns
    -----
    CollisionsWarning, SuspectUnitsWarning
        As for ``speed``.

    Examples
    --------
    The table of stopping distances in the Code of Virginia, section 46.2-880, gives 119 ft of
    braking from 50 mph:

    >>> round(distance("50 mph", drag=0.7) / 0.3048, 1)
    119.4
    """
    reader = ArgumentReader()
    start = read_speed(reader, speed, "speed")
    slowing = read_drag(reader, drag, "drag")
    slope = read_grade(reader, grade, "grade")
    end = read_speed(reader, end_speed, "end_speed")
    reader.close()
    lists, named, shape = in_one_precision(
        {"speed": [start], "drag": [slowing], "grade": [slope], "end_speed": [end]}
    )
    (start,), (slowing,), (slope,), (end,) = lists
    with np.errstate(all="ignore"):
        drop = slowing + slope
        change = start - end
        if isinstance(drop, float) and isinstance(change, float):
            _check_ends(start, end, drop, Sentences(texts_of(reader.texts)))
        # A change that the ground works against would need a negative distance.
        fits = (
            ((change > 0.0) & (drop > 0.0))
            | ((change < 0.0) & (drop < 0.0))
            | ((change == 0.0) & (drop != 0.0))
        )
        rate = select(drop == 0.0, math.nan, 2.0 * GRAVITY * drop)
        # A rate that overflows would give a distance of 0.
        found = select(abs(rate) < math.inf, change / rate * (start + end) + 0.0, math.inf)
        answer: Value = _answer(select(fits, found, math.nan), named, shape)
    return answer


@hinted
def time(
    distance: Segments, *, drag: Segments, grade: Segments = 0.0, end_speed: Input = 0.0
) -> Value:
    """Time [s] that a vehicle takes to cover a distance.

    The speeds at both ends of each surface are those of ``speed``, with the same limits; in
    between, the deceleration is constant, so the mean speed is half their sum, over the length of
    the slope::

        time = sum(2 * distance * sqrt(1 + grade**2) / (v_start + v_end))

    Parameters
    ----------
    distance, drag, grade, end_speed
        As for ``speed``: one surface, a list of surfaces, or arrays of many cases.

    Returns
    -------
    float or array [s]
        Time from the start to the end, >= 0; NaN for a case of a batch that cannot be answered.

    Raises
    ------
    InputError
        Naming every argument that cannot be used.
    NoSolutionError
        No initial speed leads to this end.

    Warns
    -----
    CollisionsWarning, SuspectUnitsWarning
        As for ``speed``.

    Examples
    --------
    >>> round(time("66 ft", drag=0.65), 2)
    2.51
    """
    return _over_surfaces(
        distance, drag, grade, end_speed, lambda *along: sum(durations_along(*along), start=0.0)
    )


def _over_surfaces(
    length: Any, drag: Any, grade: Any, end_speed: Any, figure: Callable[..., Any]
) -> Value:
    """What ``figure`` makes of the lengths and grades of all surfaces, and of the speeds at their
    ends.
    """
    reader = ArgumentReader()
    listed = isinstance(length, (list, tuple))
    if listed and not length:
        reader.refuse(
            ShapeError(
                "distance is an empty list; give at least one segment",
                code="bad_shape",
                argument="distance",
            )
        )
    count = (len(length) or None) if listed else 0
    lengths = for_each(reader, length, "distance", count, read_length)
    drags = for_each(reader, drag, "drag", count, read_drag)
    grades = for_each(reader, grade, "grade", count, read_grade)
    end = read_speed(reader, end_speed, "end_speed")
    reader.close()
    arguments = {"end_speed": [end], "distance": lengths, "drag": drags, "grade": grades}
    ((end,), lengths, drags, grades), named, shape = in_one_precision(arguments)
    segment, say = "distance[{}]" if listed else "distance", Sentences(texts_of(reader.texts))
    with np.errstate(all="ignore"):
        drops = [slowing + slope for slowing, slope in zip(drags, grades, strict=True)]
        found: Value = _answer(
            figure(lengths, grades, speeds_along(lengths, drops, end, segment.format, say)),
            named,
            shape,
        )
    return found


def _check_ends(start: float, end: float, drop: float, say: Sentences) -> None:
    """Raise if one speed does not lead to the other."""
    if start > end and drop <= 0.0:
        what = "stops" if end == 0.0 else f"slows to {say(end, 'speed')}"
        raise NoSolutionError(
            f"the vehicle never {what}: drag + grade is {drop:.6g}, which does not slow it; "
            "correct the sign of the grade, or the drag",
            code="never_stops",
        )
    if start < end and drop >= 0.0:
        raise NoSolutionError(
            f"end_speed {say(end, 'speed')} is above speed {say(start, 'speed')}, and drag + grade "
            f"is {drop:.6g}, which does not speed the vehicle up; exchange the two, or correct the "
            "sign of the grade",
            code="contradictory",
        )
    if start == end and drop == 0.0:
        raise NoSolutionError(
            f"drag + grade is 0, so the vehicle keeps its {say(start, 'speed')} over any distance",
            code="any_distance",
        )


def _answer(found: Any, named: dict[str, Any], shape: tuple[int, ...] | None) -> Any:
    """The result: a single non-finite one is refused, in a batch such cases are NaN and counted by
    reason in one warning.
    """
    if shape is None:
        if not math.isfinite(found):
            raise out_of_range()
        return found
    return settle(
        found, named, shape, [("out_of_range", np.isinf(found)), ("contradictory", np.isnan(found))]
    )
