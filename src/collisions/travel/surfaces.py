"""Surfaces one after another: lengths, drags, grades and speeds read, and the balance of energy
backward along them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from ..kernels.elementwise import select
from ..messages.errors import (
    CollisionsError,
    CollisionsWarning,
    InputError,
    NoSolutionError,
    ShapeError,
)
from ..messages.warning import warn_of_cases
from ..quantities.attributes import hypot, math_or_numpy, read_only
from ..quantities.reading import ArgumentReader, at_least_zero, broadcast, warn_if_large, widened
from ..quantities.refusals import must_be
from ..quantities.tables import Sentences
from ..quantities.units import Input
from ..vehicle.drag import GRAVITY, one_value

Segments: TypeAlias = Input | Sequence[Input]
_Reader: TypeAlias = Callable[[ArgumentReader, Any, str], Any]

# No road is steeper: beyond, a bare number is in another unit.
_STEEPEST_GRADE = 0.5
# Nothing drives on ground that is nearly upright.
_STEEPEST = 100.0
# Refusal codes of negative single numbers by argument; the elements of arrays are checked here.
_BELOW_ZERO = {
    "distance": "negative_distance",
    "drag": "negative_drag",
    "duration": "negative_duration",
    "speed": "negative_speed",
    "end_speed": "negative_speed",
    "friction": "bad_friction",
    "height": "negative_length",
    "lock": "bad_fraction",
    "rotating_mass": "bad_fraction",
    "window": "negative_distance",
    "point_error": "negative_length",
    "heading_error": "negative_length",
}


def for_each(
    reader: ArgumentReader, value: Any, name: str, count: int | None, read: _Reader
) -> list[Any]:
    """Broadcast a value to one number per segment.

    ``count`` is 0 for one surface, not given as a list, and None if the segments could not be read.
    """
    if not isinstance(value, (list, tuple)):
        one = read(reader, value, name)
        return [one] * (count or 1)
    if count is None or len(value) == count > 0:
        return [read(reader, part, f"{name}[{i}]") for i, part in enumerate(value)]
    kind = type(value).__name__
    if count:
        text = (
            f"{name} is a {kind} of {len(value)}, and there are {count} segments; give one value "
            "for all, or one for each"
        )
    else:
        text = (
            f"{name} is a {kind}, one value for each segment, and distance is one surface; give "
            "distance as a list too, or many cases as a numpy array"
        )
    reader.refuse(ShapeError(text, code="bad_shape", argument=name))
    return [math.nan] * (count or 1)


def read_length(reader: ArgumentReader, value: Any, name: str) -> Any:
    """A length along the path [m], >= 0."""
    read = one_value(reader, value, "m", name)
    return at_least_zero(
        reader, read, value, name, "negative_distance", "it is counted along the way travelled"
    )


def read_speed(reader: ArgumentReader, value: Any, name: str) -> Any:
    """A speed along the path [m/s], >= 0."""
    read = one_value(reader, value, "m/s", name)
    return at_least_zero(
        reader, read, value, name, "negative_speed", "it is counted along the way travelled"
    )


def read_grade(reader: ArgumentReader, value: Any, name: str) -> Any:
    """The rise over the run, with a warning if a bare number is steeper than any road."""
    read = one_value(reader, value, "", name)
    warn_if_large(value, read, _STEEPEST_GRADE, name, "the rise over the run", "%")
    return read


def read_slope(reader: ArgumentReader, value: Any) -> tuple[Any, Any]:
    """The rises over the run along x and y, with a warning as for a grade; infinite, and so without
    an answer, in a case of a batch that is too steep.
    """
    rises = []
    for i, read in enumerate(reader.pair(value, "", "slope")):
        given = value[i] if isinstance(value, (tuple, list)) and len(value) == 2 else value
        name, steep = f"slope[{i}]", np.abs(read) > _STEEPEST
        if np.ndim(read):
            read = np.where(steep, np.inf, read).astype(read.dtype)
        elif steep:
            text = f"between -{_STEEPEST:g} and {_STEEPEST:g}, the rise over the run"
            reader.refuse(must_be(name, text, given, code="out_of_range"))
            continue
        warn_if_large(given, read, _STEEPEST_GRADE, name, "the rise over the run", "%")
        rises.append(read)
    x, y = rises if len(rises) == 2 else (math.nan, math.nan)
    return x, y


def in_one_precision(
    arguments: Mapping[str, Sequence[Any]],
) -> tuple[list[list[Any]], dict[str, Any], tuple[int, ...] | None]:
    """The numbers of each argument, widened to the precision of all; every number by name; and the
    shape of a batch.
    """
    named: dict[str, Any] = {}
    for name, parts in arguments.items():
        one_for_all = all(part is parts[0] for part in parts)
        named |= (
            {name: parts[0]}
            if one_for_all
            else {f"{name}[{i}]": part for i, part in enumerate(parts)}
        )
    shape = broadcast(named)
    values = iter(widened([part for parts in arguments.values() for part in parts]))
    return [[next(values) for _ in parts] for parts in arguments.values()], named, shape


def speeds_along(
    lengths: Sequence[Any],
    drops: Sequence[Any],
    end: Any,
    name: Callable[[int], str],
    say: Sentences,
) -> list[Any]:
    """Speed at every point, start to end, chained backward; NaN in the cases of a batch that
    contradict themselves. ``name`` and ``say`` write a segment and a number for an error.
    """
    speeds = [end]
    for i in range(len(lengths) - 1, -1, -1):
        after = speeds[-1]
        gained = _root(2.0 * GRAVITY * abs(drops[i])) * _root(lengths[i])
        # Downhill beyond the drag: the root of the difference of squares, without the squares that
        # overflow.
        falling = _root(after - gained) * _root(after + gained)
        before = select(drops[i] >= 0.0, hypot(after, gained), falling)
        # A vehicle that nothing slows does not come to rest, unless it has not moved.
        before = select((drops[i] <= 0.0) & (after == 0.0) & (lengths[i] > 0.0), math.nan, before)
        if isinstance(before, float) and not math.isfinite(before):
            raise _contradiction(name(i), drops[i], after, gained, say)
        speeds.append(before)
    return speeds[::-1]


def _root(value: Any) -> Any:
    """Square root, NaN below 0."""
    if isinstance(value, float):
        return math.sqrt(value) if value >= 0.0 else math.nan
    return np.sqrt(value)


def _contradiction(
    where: str, drop: float, after: float, gained: float, say: Sentences
) -> CollisionsError:
    """Why no speed before a segment leads to the speed after it."""
    if drop > 0.0 or math.isinf(gained):
        return out_of_range()
    if drop == 0.0:
        return NoSolutionError(
            f"{where}: drag + grade is 0, so nothing slows the vehicle there, and it is to come "
            "to rest; correct what slows it, or give an end_speed",
            code="contradictory",
            missing=0.0,
        )
    missing = (after - gained) * (after + gained)
    return NoSolutionError(
        f"{where}: drag + grade is {drop:.6g}, so the vehicle speeds up there, from rest already "
        f"to {say.at_least(gained, 'speed')}, and is to end at {say(after, 'speed')}; the square "
        "of its speed before would be negative. Correct the sign of the grade, the drag, or the "
        "end_speed",
        code="contradictory",
        missing=missing,
    )


def durations_along(
    lengths: Sequence[Any], grades: Sequence[Any], speeds: Sequence[Any]
) -> list[Any]:
    """Time over each segment, along its slope: at a constant deceleration the mean speed is half
    the sum.
    """
    found = []
    for plan, grade, before, after in zip(lengths, grades, speeds, speeds[1:], strict=False):
        length = plan * math_or_numpy(grade).hypot(1.0, grade)
        double = before + after
        duration = 2.0 * length / select(double == 0.0, math.nan, double)
        # A speed that overflowed would make the duration 0, which looks like a result.
        found.append(select(length == 0.0, 0.0, select(double == math.inf, math.inf, duration)))
    return found


def out_of_range() -> InputError:
    """The error for a single case with a result that is not finite."""
    return InputError(
        "the answer is not a finite number: the arguments are too large or too small for floats",
        code="out_of_range",
    )


def settle(
    found: Any, named: Mapping[str, Any], shape: tuple[int, ...], checks: Iterable[tuple[str, Any]]
) -> Any:
    """A locked batch, or a dict or tuple of some, NaN where an argument is refused or a check
    holds; one warning counts why.
    """
    reasons = [("not_finite", ~np.isfinite(value)) for value in named.values()]
    for name, value in named.items():
        code = _BELOW_ZERO.get(name.partition("[")[0])
        if code is not None:
            reasons.append((code, np.less(value, 0.0)))
        if code == "bad_fraction":
            reasons.append((code, np.greater(value, 1.0)))
    answered = np.ones(shape, dtype=bool)
    why: dict[str, Any] = {}
    for code, cases in (*reasons, *checks):
        hit = answered & cases
        if hit.any():
            why[code] = why.get(code, False) | hit
            answered &= ~hit
    counts = {code: int(np.count_nonzero(hit)) for code, hit in why.items()}
    if why:
        listed = ", ".join(f"{count} {code}" for code, count in counts.items())
        warn_of_cases(
            CollisionsWarning(
                f"{sum(counts.values())} of {answered.size} cases cannot be answered and are NaN "
                f"({listed})",
                code="refused_cases",
                counts=counts,
            ),
            {f"without an answer on the ground, as {code}": hit for code, hit in why.items()},
        )

    def settled(answer: Any) -> Any:
        if isinstance(answer, dict):
            return {name: settled(part) for name, part in answer.items()}
        if isinstance(answer, tuple):
            return tuple(map(settled, answer))
        if counts:
            return select(answered, answer, np.nan)
        # A large batch has most answers in its shape already, and a second copy of them would take
        # as much memory again.
        return answer if np.shape(answer) == shape else np.array(np.broadcast_to(answer, shape))

    return read_only(settled(found))
