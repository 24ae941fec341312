"""Arrows that would hide each other are moved apart, sideways."""

from __future__ import annotations

import math

from .drawing import Place

# All within this of one line hide each other: sine of the angle.
ALONG_ONE_LINE = 0.03


def covers(start: Place, vector: Place, other: Place, along: Place, longest: float) -> bool:
    """Whether one arrow lies on another one; ``longest`` says what counts as near."""
    length, size = math.hypot(*vector), math.hypot(*along)
    gap = start[0] - other[0], start[1] - other[1]
    if abs(cross(vector, along)) > ALONG_ONE_LINE * length * size or abs(cross(gap, along)) > 0.02 * longest * size:
        return False
    begin_at = (gap[0] * along[0] + gap[1] * along[1]) / size
    end_at = begin_at + (vector[0] * along[0] + vector[1] * along[1]) / size
    return min(max(begin_at, end_at), size) - max(min(begin_at, end_at), 0.0) > 0.02 * longest


def cross(one: Place, other: Place) -> float:
    """What one has across the other."""
    return one[0] * other[1] - one[1] * other[0]


def beside(place: Place, direction: Place, far: float) -> Place:
    """The place so far away in a direction."""
    return place[0] + far * direction[0], place[1] + far * direction[1]
