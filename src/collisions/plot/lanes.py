"""Arrows that would hide each other are moved apart, sideways."""

from __future__ import annotations

import math

from .drawing import Place

# All within this of one line hide each other: sine of the angle.
ALONG_ONE_LINE = 0.03
APART = 0.045  # of the size of the scene: between arrows that would hide each other
_WIDE = 0.04  # of the size of the scene: what is nearer to an arrow is beneath it


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


def off_line(place: Place, start: Place, vector: Place) -> float:
    """How far a place is from an arrow."""
    length = math.hypot(*vector)
    along = vector[0] / length, vector[1] / length
    way = (place[0] - start[0]) * along[0] + (place[1] - start[1]) * along[1]
    nearest = beside(start, along, min(max(way, 0.0), length))
    return math.hypot(place[0] - nearest[0], place[1] - nearest[1])


class Lanes:
    """The arrows drawn so far, so that none is drawn on another one."""

    def __init__(self, size: float) -> None:
        self.size = size
        self.moved = False
        self._drawn: list[tuple[Place, Place]] = []

    def hides(self, start: Place, vector: Place) -> bool:
        """Whether an arrow would lie on one of them."""
        return any(covers(start, vector, *other, self.size) or self._buries(start, vector, *other) for other in self._drawn)

    def _buries(self, start: Place, vector: Place, other: Place, along: Place) -> bool:
        """Whether the shorter of two arrows lies wholly beneath the line and the head of the longer."""
        if math.hypot(*vector) > math.hypot(*along):
            start, vector, other, along = other, along, start, vector
        return all(off_line(place, other, along) < _WIDE * self.size for place in (start, beside(start, vector, 1.0)))

    def free(self, arrows: list[tuple[Place, Place]]) -> list[tuple[Place, Place]]:
        """The arrows, start and vector, all moved as far down, or to the right, as it takes."""
        length = max(math.hypot(*vector) for _, vector in arrows)
        if length == 0.0:
            return arrows
        vx, vy = max((vector for _, vector in arrows), key=lambda vector: math.hypot(*vector))
        aside = (-vy / length, vx / length) if (vx, vy) < (0.0, 0.0) else (vy / length, -vx / length)
        found, lane = arrows, 0
        while any(self.hides(start, vector) for start, vector in found if vector != (0.0, 0.0)):
            lane += 1
            found = [(beside(start, aside, lane * APART * self.size), vector) for start, vector in arrows]
        self.moved = self.moved or lane > 0
        self._drawn += [(start, vector) for start, vector in found if vector != (0.0, 0.0)]
        return found
