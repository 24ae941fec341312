"""Directions as numbers on a line: the circle is cut where there are none, so that those on both sides of pi stand together."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

_TURN = 2.0 * math.pi
_EMPTY = 0.25 * _TURN  # less than this is no gap to cut in
_ROUNDING = 1e-9
_NEAR_PI = 2.0


def are_directions(angles: Any) -> bool:
    """Whether all lie from -pi to pi, as a course and a PDOF do; a rotation of more than that counts its turns."""
    return not np.any(np.abs(angles) > math.pi * (1.0 + _ROUNDING))


def cut(angles: Any) -> float | None:
    """The middle of the widest gap between directions; None for what is no direction, or points everywhere."""
    found = np.sort(angles[~np.isnan(angles)])
    if not found.size or not are_directions(found):
        return None
    gaps = np.diff(found, append=found[0] + _TURN)
    # As they are if that is as good.
    widest = len(gaps) - 1 if gaps[-1] >= gaps.max() else int(np.argmax(gaps))
    if gaps[widest] < _EMPTY:
        return None
    where = float(found[widest] + 0.5 * gaps[widest])
    return where + _TURN if float(np.mean(folded(found, where))) <= -math.pi + _ROUNDING else where


def folded(angles: Any, where: float | None) -> Any:
    """Directions within the turn that ends at this cut; those that already are stay as they are to the bit."""
    return angles if where is None else angles - _TURN * np.ceil((angles - where) / _TURN)


def beside(angles: Any, middle: float) -> Any:
    """Directions within half a turn of one of them."""
    return folded(angles, middle + math.pi) if are_directions(angles) else angles


def jump(values: Any) -> bool:
    """Whether numbers without a unit look like directions around pi: within half a turn, at both of its ends, few between."""
    found = values[~np.isnan(values)]
    if not found.size or not are_directions(found) or not (found.min() <= -_NEAR_PI and found.max() >= _NEAR_PI):
        return False
    # Of directions to all sides a third lies there, of a quantity about 0 more.
    return bool(np.mean(np.abs(found) < 1.0) < 0.16)


def point_everywhere(angles: Any) -> bool:
    """Whether there are directions close to pi and to -pi, and no gap to cut in."""
    answered = angles[~np.isnan(angles)]
    if not answered.size or cut(answered) is not None or not are_directions(answered):
        return False
    return bool(answered.min() < -0.75 * math.pi and answered.max() > 0.75 * math.pi)
