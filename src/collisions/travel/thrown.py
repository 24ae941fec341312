"""``throw_speed`` and ``throw_bounds`` of a person who was thrown and slid to rest: Searle's
equations.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..kernels.elementwise import select
from ..messages.errors import NoSolutionError
from ..messages.hints import hinted
from ..quantities.attributes import hypot, math_or_numpy
from ..quantities.reading import ArgumentReader, at_least_zero
from ..quantities.refusals import must_be
from ..quantities.tables import Sentences
from ..quantities.units import Input, Value, has_unit, texts_of
from ..vehicle.drag import GRAVITY, one_value, read_friction
from .surfaces import in_one_precision, out_of_range, read_length, settle

_QUARTER = 0.5 * math.pi
_ROUNDING = 1e-12


@hinted
def throw_speed(distance: Input, *, friction: Input, angle: Input, height: Input = 0.0) -> Value:
    """Speed [m/s] at which a body was thrown at a known angle, from how far it flew and slid.

    The body flies without air resistance, comes down on level ground, and slides or tumbles to
    rest. What friction takes of its speed along the ground as it lands is ``friction`` times what
    the ground takes of its fall, in one landing or in several bounces::

        v = sqrt(2 * friction * GRAVITY * (distance - friction * height))
            / (cos(angle) + friction * sin(angle))

    Parameters
    ----------
    distance : float, str, Quantity or array [m]
        From where the body was thrown to where it lies, in plan, >= 0.
    friction : float, str, Quantity or array [-]
        Of the body on the ground, over the slide and in landing, > 0.
    angle : float, str, Quantity or array [rad]
        Of the throw above the level, between -90 and 90 degrees.
    height : float, str, Quantity or array [m]
        Of the centre of mass at the throw above that of the body as it slides, >= 0.

    Returns
    -------
    float or array [m/s]
        Speed of the throw; NaN for a case of a batch that cannot be answered.

    Raises
    ------
    InputError
        Naming every argument that cannot be used.
    NoSolutionError
        The body comes down so steeply that friction would stop it where it lands (code
        "stops_at_landing"); or nothing would stop it (code "never_stops").

    Warns
    -----
    CollisionsWarning
        How many cases of a batch cannot be answered, and why.
    SuspectUnitsWarning
        A bare number that is probably in another unit.

    Notes
    -----
    It is the speed of the person, not that of the car: a person who was struck off-centre, or who
    left the bonnet before it had taken them along, was slower than the car, and one who was carried
    was thrown later than struck. J. A. Searle and A. Searle, "The Trajectories of Pedestrians,
    Motorcycles, Motorcyclists, etc., Following a Road Accident", SAE 831622 (1983); with a height,
    J. A. Searle, "The Physics of Throw Distance in Accident Reconstruction", SAE 930659 (1993).

    Examples
    --------
    Thrown 20 degrees upwards, 60 ft:

    >>> round(throw_speed("60 ft", friction=0.66, angle="20 deg") / 0.44704, 1)
    29.5
    """
    reader, given = _read(distance, friction, height)
    given["angle"] = _read_angle(reader, angle)
    reader.close()
    ((far,), (rubbed,), (high,), (up,)), named, shape = in_one_precision(
        {name: [value] for name, value in given.items()}
    )
    with np.errstate(all="ignore"):
        cos, sin = math_or_numpy(up).cos(up), math_or_numpy(up).sin(up)
        level = _level(far, rubbed, high)
        found = level / select(cos + rubbed * sin > 0.0, cos + rubbed * sin, math.nan)
        falls = hypot(found * sin, _root(2.0 * GRAVITY * high))
        # A throw at the edge slides by rounding alone.
        slides = found * cos >= rubbed * falls * (1.0 - _ROUNDING)
        off = [("bad_angle", abs(up) >= _QUARTER)]
        say = Sentences(texts_of(reader.texts))
        answer: Value = _settled(found, named, shape, (far, rubbed, slides), off, say)
    return answer


@hinted
def throw_bounds(distance: Input, *, friction: Input, height: Input = 0.0) -> tuple[Value, Value]:
    """Least and greatest speed [m/s] at which a body was thrown, at an angle that nobody knows.

    Both are of ``throw_speed``: the least at the angle whose tangent is the friction, the greatest
    at the level. Between them is every throw upwards that is flatter than twice that angle (67
    degrees at a friction of 0.66) and slides after it landed; a steeper one, or one downwards, may
    be faster::

        greatest = sqrt(2 * friction * GRAVITY * (distance - friction * height))
        least    = greatest / sqrt(1 + friction**2)

    Parameters
    ----------
    distance, friction, height
        As for ``throw_speed``.

    Returns
    -------
    least, greatest : float or array [m/s]
        NaN for a case of a batch that cannot be answered.

    Raises
    ------
    InputError
        Naming every argument that cannot be used.
    NoSolutionError
        The distance is less than ``2 * friction * height``: thrown level, the body would stop where
        it lands (code "stops_at_landing"); or nothing would stop it (code "never_stops").

    Warns
    -----
    CollisionsWarning, SuspectUnitsWarning
        As for ``throw_speed``.

    Notes
    -----
    The model, its limits and its sources are those of ``throw_speed``. The bounds are those of the
    angle alone: distance and friction have errors of their own, which ``propagate`` adds. Above a
    friction of 1, or somewhat less with a height, the least speed is a bound that no throw reaches.

    Examples
    --------
    A pedestrian lies 60 ft from where he was struck. Friction 0.66:

    >>> [round(speed / 0.44704, 1) for speed in throw_bounds("60 ft", friction=0.66)]
    [28.7, 34.4]
    """
    reader, given = _read(distance, friction, height)
    reader.close()
    ((far,), (rubbed,), (high,)), named, shape = in_one_precision(
        {name: [value] for name, value in given.items()}
    )
    with np.errstate(all="ignore"):
        greatest = _level(far, rubbed, high)
        slides = far >= 2.0 * rubbed * high * (1.0 - _ROUNDING)
        both = greatest / math_or_numpy(rubbed).hypot(1.0, rubbed), greatest
        say = Sentences(texts_of(reader.texts))
        bounds: tuple[Value, Value] = _settled(both, named, shape, (far, rubbed, slides), [], say)
    return bounds


def _read(distance: Any, friction: Any, height: Any) -> tuple[ArgumentReader, dict[str, Any]]:
    """The numbers of a throw by name, and what reads them."""
    reader = ArgumentReader()
    given = {
        "distance": read_length(reader, distance, "distance"),
        "friction": read_friction(reader, friction, "friction"),
    }
    read = one_value(reader, height, "m", "height")
    why = "it is that of the throw above the slide"
    given["height"] = at_least_zero(reader, read, height, "height", "negative_length", why)
    return reader, given


def _read_angle(reader: ArgumentReader, value: Any) -> Any:
    """An angle above the level, within a quarter turn."""
    read = one_value(reader, value, "rad", "angle")
    if isinstance(read, float) and not abs(read) < _QUARTER:
        bare = not isinstance(value, str) and not has_unit(value)
        meant = f"{read:g}" if bare and abs(read) < 90.0 else "20"
        return reader.refuse(
            must_be(
                "angle",
                "between -90 and 90 degrees",
                value,
                f"; a bare number is in radians: for degrees write '{meant} deg'",
                code="bad_angle",
            )
        )
    return read


def _level(distance: Any, friction: Any, height: Any) -> Any:
    """The speed of a level throw, without squares that overflow; NaN where it would not slide."""
    return _root(2.0 * GRAVITY * friction) * _root(distance - friction * height)


def _root(value: Any) -> Any:
    """Square root, NaN below 0."""
    if isinstance(value, float):
        return math.sqrt(value) if value >= 0.0 else math.nan
    return np.sqrt(value)


def _settled(
    found: Any,
    named: dict[str, Any],
    shape: tuple[int, ...] | None,
    ground: tuple[Any, Any, Any],
    checks: list[tuple[str, Any]],
    say: Sentences,
) -> Any:
    """The answer; a single one that is none is refused, in a batch it is NaN and counted."""
    distance, friction, slides = ground
    first = found[-1] if isinstance(found, tuple) else found
    if shape is not None:
        checks = [
            *checks,
            ("never_stops", (friction == 0.0) & (distance > 0.0)),
            ("out_of_range", np.isinf(first)),
            ("stops_at_landing", ~np.asarray(slides)),
        ]
        return settle(found, named, shape, checks)
    if friction == 0.0 and distance > 0.0:
        raise NoSolutionError(
            "friction is 0, so the body never comes to rest; give the friction of a body on the "
            "ground, such as 0.66",
            code="never_stops",
        )
    if math.isinf(first):
        raise out_of_range()
    if not slides:
        raise NoSolutionError(
            "a body that was thrown so came down steeply enough to stop where it landed, before "
            f"{say(distance, 'length')}, and these equations are for one that slides; check "
            "distance, friction, height and angle",
            code="stops_at_landing",
        )
    return found
