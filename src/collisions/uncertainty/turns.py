"""Directions as numbers on a line: the circle is cut opposite their mean, so that directions near
pi and -pi stay together.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

_TURN = 2.0 * math.pi
_EMPTY = 0.25 * _TURN  # narrower gaps are not cut in, as only some of many points were looked at
_OPPOSITE = _TURN / 16.0  # on either side of the point opposite the mean
_ANGLE_TOL = 1e-9  # rounding of an angle
_NEAR_PI = 2.0
_BESIDE_PI = math.pi / 12.0  # of pi: an angle that jumps there has values as near on either side
_SECTORS = 12  # of a turn, whose shares of the values are compared
_CHANCE = 4.0  # standard deviations of a difference of two counts, beyond which it is none
_ALONE = 4.0  # times the next widest: a gap in the values of a grid that is a jump
# Where numbers jump, also such as are known from one side only, or that directions point to all
# sides or to opposite ones.
AT_HALF_TURN, AT_FULL_TURN, ALL_ROUND = "half turn", "full turn", "all round"
ONE_SIDED = "one-sided"


def are_directions(angles: Any) -> bool:
    """Whether all values lie within -pi to pi, as a course and a PDOF do; larger ones are rotations
    that count their turns.
    """
    return not np.any(np.abs(angles) > math.pi * (1.0 + _ANGLE_TOL))


def counted(angles: Any) -> Any:
    """Unwrap directions about their mean, where their spread is least, for every row along the last
    axis.

    Their mean, in (-pi, pi], is then the direction with the least mean square of the angular
    distances: the intrinsic mean (T. Hotz and S. Huckemann, "Intrinsic means on the circle", Annals
    of the Institute of Statistical Mathematics 67 (2015)). Those that need no turn stay as they are
    to the bit, and so do values that are not directions.
    """
    if not are_directions(angles) or not angles.size:
        return angles
    ordered = np.sort(angles, axis=-1)  # NaN come last
    answered = ~np.isnan(ordered)
    count = np.maximum(np.count_nonzero(answered, axis=-1, keepdims=True), 1)
    summed = np.cumsum(np.where(answered, ordered, 0.0), axis=-1)
    mean = summed[..., -1:] / count
    # The change of the variance if the first n values get one more turn, in units of 2 turns over
    # the count.
    first = np.arange(1, angles.shape[-1] + 1)
    change = np.where(
        first < count, summed - mean * first + math.pi * first * (1.0 - first / count), 0.0
    )
    best = np.argmin(change, axis=-1, keepdims=True)
    moved = np.take_along_axis(change, best, -1) < -_ANGLE_TOL * count
    last = np.where(moved, np.take_along_axis(ordered, best, -1), -math.inf)
    mean = mean + np.where(moved, (best + 1) * _TURN / count, 0.0)
    down = np.where(
        mean > math.pi + _ANGLE_TOL, 1.0, np.where(mean <= -math.pi + _ANGLE_TOL, -1.0, 0.0)
    )
    turns = np.where(angles <= last, 1.0, 0.0) - down
    return np.where(turns == 0.0, angles, angles + _TURN * turns)


def cut(angles: Any) -> float | None:
    """The middle of the widest gap between directions; None for values that are not directions, or
    without a wide gap.
    """
    found = np.sort(angles[~np.isnan(angles)])
    if not found.size or not are_directions(found):
        return None
    gaps = np.diff(found, append=found[0] + _TURN)
    # If the gap across pi is as wide, the directions stay as they are.
    widest = len(gaps) - 1 if gaps[-1] >= gaps.max() else int(np.argmax(gaps))
    if gaps[widest] < _EMPTY:
        return None
    where = float(found[widest] + 0.5 * gaps[widest])
    return where + _TURN if float(np.mean(folded(found, where))) <= -math.pi + _ANGLE_TOL else where


def turns_to(angles: Any, where: float | None) -> Any:
    """The turns by which directions are moved into the turn that ends at this cut; none without a
    cut.
    """
    return 0.0 if where is None else -np.ceil((angles - where) / _TURN)


def folded(angles: Any, where: float | None) -> Any:
    """Directions moved into the turn that ends at this cut; those in it already stay
    bit for bit.
    """
    return angles if where is None else angles + _TURN * turns_to(angles, where)


def beside(angles: Any, middle: float) -> Any:
    """Directions moved to within half a turn of ``middle``."""
    return folded(angles, middle + math.pi) if are_directions(angles) else angles


def jump(values: Any) -> bool:
    """Whether numbers without a unit look like directions around pi: within half a turn, many near
    both ends, few between.
    """
    found = values[~np.isnan(values)]
    if (
        not found.size
        or not are_directions(found)
        or not (found.min() <= _BESIDE_PI - math.pi and found.max() >= math.pi - _BESIDE_PI)
    ):
        return False
    # A third of directions to all sides lies within 1 of 0; more of a quantity spread about 0.
    return bool(np.mean(np.abs(found) < 1.0) < 0.16)


def jump_at_full_turn(values: Any, *, drawn: bool) -> bool:
    """Whether numbers look like directions around 0 that jump to a full turn: within 0 to a turn,
    some beyond half of it, and more at either end than somewhere between.

    A quantity above 0 whose density only falls, and a rotation that takes any value, are not.
    Values on a grid, which are not ``drawn``, have no density: there one gap between both ends
    tells.
    """
    found = values[~np.isnan(values)]
    rounding = _TURN * _ANGLE_TOL
    if not found.size or are_directions(found):
        return False
    if not (found.min() >= -rounding and found.max() <= _TURN + rounding):
        return False
    if not drawn:
        found = np.sort(found)
        gaps = np.sort(np.diff(found, prepend=found[0]))[-2:]
        near = math.pi - _NEAR_PI
        at_ends = found[0] <= near and found[-1] >= _TURN - near
        return bool(at_ends and gaps[1] >= _EMPTY and gaps[1] > _ALONE * gaps[0])
    counts, _ = np.histogram(np.clip(found, 0.0, _TURN), _SECTORS, (0.0, _TURN))
    least = int(counts.min())
    ends = int(counts[0]), int(counts[-1])
    return all(end - least > _CHANCE * math.sqrt(end + least) for end in ends)


def jump_of(values: Any, unit: str | None, *, drawn: bool = True) -> str | None:
    """Where an output that is not counted round the circle looks like an angle that jumps: at half
    a turn, if without a unit, or at a full turn.
    """
    if unit is None and jump(values):
        return AT_HALF_TURN
    angle = unit in (None, "rad")
    return AT_FULL_TURN if angle and jump_at_full_turn(values, drawn=drawn) else None


def point_everywhere(values: Any) -> bool:
    """Whether so many unwrapped directions are opposite their mean that it loses its meaning: half
    as many as if evenly spread.

    The error of the mean is then twice what their spread suggests (Hotz and Huckemann), and the
    mean soon has no meaning.
    """
    return (
        float(np.mean(np.abs(values - np.mean(values)) > math.pi - _OPPOSITE)) > _OPPOSITE / _TURN
    )


def point_to_opposite_sides(values: Any) -> bool:
    """Whether another mean of unwrapped directions, an eighth of a turn away or more, fits to a
    tenth of their variance.
    """
    count = values.size
    first = np.arange(1, count + 1)
    ahead = np.cumsum(np.sort(values - np.mean(values)))
    # If the first n values get one more turn, the mean moves by n / count turns.
    change = (2.0 * _TURN / count) * (ahead + math.pi * first * (1.0 - first / count))
    far = (first >= 0.125 * count) & (first <= 0.875 * count)
    return bool(np.any(change[far] < 0.1 * np.var(values)))
