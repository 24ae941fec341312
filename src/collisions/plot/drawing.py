"""``Drawing``: arrows that do not overlap each other, and labels placed clear of them."""

from __future__ import annotations

import math
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .canvas import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Place = tuple[float, float]
_Box = tuple[float, float, float, float]

_FONT = 9.5
# Of a font size: the mean width of a letter, and the height of a line.
_LETTER, _LINE = 0.6, 1.45
_TURNS = tuple(math.radians(angle) for angle in (0, 20, -20, 40, -40, 60, -60, 90, -90, 120, -120, 150, -150, 180))
# Of the larger extent: what is left free around, and the least there is of the other one.
_MARGIN, _STRIP = 0.14, 0.42
_AWAY = (5.0, 14.0, 26.0, 42.0, 60.0)
# Arrows within this sine of one line hide each other.
ALONG_ONE_LINE = 0.03
APART = 0.045  # of the size of the scene: between arrows that would hide each other
_WIDE = 0.04  # of the size of the scene: anything nearer to an arrow is beneath it


class _Label(NamedTuple):
    places: tuple[Place, ...]
    text: str
    direction: Place
    colour: str
    of: int | None


class Drawing:
    """The drawing on one Axes in data coordinates; limits and label places are settled at the end."""

    def __init__(self, axes: Axes) -> None:
        self.axes = axes
        self._labels: list[_Label] = []
        self._taken: list[Any] = []
        self._seen: list[Place] = []
        self._areas: dict[int, list[Place]] = {}

    def arrow(self, tail: Place, tip: Place, gid: str, *, colour: str = INK, width: float = 1.8, style: Any = "-") -> None:
        """An arrow whose ends are exactly these; none without a length."""
        self.include(tail, tip)
        if tail == tip:
            return
        made = self.axes.annotate(
            "",
            xy=tip,
            xytext=tail,
            arrowprops={
                "arrowstyle": "-|>,head_length=0.55,head_width=0.22",
                "mutation_scale": 13,
                "linewidth": width,
                "linestyle": style,
                "color": colour,
                "shrinkA": 0,
                "shrinkB": 0,
            },
            annotation_clip=False,
            zorder=4,
        )
        made.set_gid(gid)
        self.avoid(tail, tip)

    def line(self, one: Place, other: Place, gid: str, **style: Any) -> None:
        """A straight line."""
        self.include(one, other)
        self.axes.plot([one[0], other[0]], [one[1], other[1]], gid=gid, **style)
        self.avoid(one, other)

    def include(self, *places: Place) -> None:
        """Extend the limits to include these points."""
        self._seen.extend(places)

    def avoid(self, one: Place, other: Place, weight: int = 1) -> None:
        """No label shall cover the line between these."""
        self._taken.extend([np.linspace(one, other, 60)] * weight)

    def area(self, index: int, corners: list[Place]) -> None:
        """The convex outline of a vehicle, anticlockwise, which no label of the other one shall stand on."""
        self._areas[index] = corners

    def label(
        self,
        place: Place,
        text: str,
        direction: Place = (0.0, 1.0),
        colour: str = INK,
        *others: Place,
        of: int | None = None,
    ) -> None:
        """A text next to a place, or at an alternative one, in this direction if there is room; ``of`` names the vehicle."""
        self._labels.append(_Label((place, *others), text, direction, colour, of))

    def finish(self) -> None:
        """Settle the limits, so that everything is in view, and put the labels where there is room."""
        places = np.array(self._seen)
        low, high = places.min(axis=0), places.max(axis=0)
        middle = 0.5 * (low + high)
        half = 0.5 * (high - low) + _MARGIN * max(high - low)
        # Widened where one direction would be a thin strip.
        half = np.maximum(half, _STRIP * max(half))
        self.axes.set(xlim=(middle[0] - half[0], middle[0] + half[0]), ylim=(middle[1] - half[1], middle[1] + half[1]))
        self.axes.set_aspect("equal", adjustable="box")
        self.axes.apply_aspect()
        self._place_labels()

    def _place_labels(self) -> None:
        points = 72.0 / self.axes.figure.dpi
        in_points = self.axes.transData.transform
        lines = np.array([in_points(line) * points for line in self._taken])
        inside = np.array(self.axes.bbox.extents) * points
        boxes: list[_Box] = []
        areas = {index: np.array(in_points(corners)) * points for index, corners in self._areas.items()}
        for label in self._labels:
            foreign = [area for index, area in areas.items() if label.of not in (None, index)]
            rows = label.text.split("\n")
            size = _FONT * _LETTER * max(map(len, rows)), _FONT * _LINE * len(rows)
            along = math.atan2(label.direction[1], label.direction[0])
            near = [in_points(place) * points for place in label.places]
            tried = product(range(len(near)), _AWAY, _TURNS)
            natural = sorted(
                (0.4 * away + 3.0 * abs(turn) + 2.0 * which, i, which, away, turn)
                for i, (which, away, turn) in enumerate(tried)
            )
            best, chosen, lowest = _box(near[0], size, along, _AWAY[0]), 0, math.inf
            # From the most natural on, until none can be better than the best so far.
            for least, _, which, away, turn in natural:
                if least >= lowest:
                    break
                box = _box(near[which], size, along + turn, away)
                cost = least + _cost(box, near[which], lines, boxes, inside) + 300.0 * sum(_on(box, area) for area in foreign)
                if cost < lowest:
                    best, chosen, lowest = box, which, cost
            place, at = label.places[chosen], near[chosen]
            boxes.append(best)
            self.axes.annotate(
                label.text,
                xy=place,
                xytext=(0.5 * (best[0] + best[2]) - at[0], 0.5 * (best[1] + best[3]) - at[1]),
                textcoords="offset points",
                ha="center",
                va="center",
                fontsize=_FONT,
                color=label.colour,
                parse_math=False,
                annotation_clip=False,
                zorder=6,
                bbox={"boxstyle": "square,pad=0.05", "fc": "white", "ec": "none", "alpha": 0.75},
            )


def _box(at: Any, size: tuple[float, float], angle: float, distance: float) -> _Box:
    """Where a text of this size lies whose edge is this far away in this direction."""
    c, s = math.cos(angle), math.sin(angle)
    away = min(0.5 * size[0] / max(abs(c), 1e-9), 0.5 * size[1] / max(abs(s), 1e-9)) + distance
    x, y = at[0] + away * c, at[1] + away * s
    return x - 0.5 * size[0], y - 0.5 * size[1], x + 0.5 * size[0], y + 0.5 * size[1]


def _cost(box: _Box, at: Any, lines: Any, boxes: list[_Box], inside: Any) -> float:
    """How bad this place for a label is: over lines or other labels, on the far side of a line, or outside."""
    left, low, right, high = box
    x, y = lines[..., 0], lines[..., 1]
    crossed = np.count_nonzero((x > left - 2.0) & (x < right + 2.0) & (y > low - 2.0) & (y < high + 2.0))
    covered = sum(
        max(0.0, min(right, other[2]) - max(left, other[0])) * max(0.0, min(high, other[3]) - max(low, other[1]))
        for other in boxes
    )
    over = max(0.0, inside[0] - left) + max(0.0, right - inside[2]) + max(0.0, inside[1] - low) + max(0.0, high - inside[3])
    behind = np.count_nonzero(_crosses(at, (0.5 * (left + right), 0.5 * (low + high)), lines[:, 0], lines[:, -1]))
    return 8.0 * int(crossed) + 5.0 * covered + 20.0 * float(over) + 25.0 * int(behind)


def _on(box: _Box, area: Any) -> float:
    """The share of a label's area that lies on a convex area with its corners anticlockwise."""
    across, up = np.meshgrid(np.linspace(box[0], box[2], 7), np.linspace(box[1], box[3], 3))
    inside = np.ones(across.shape, dtype=bool)
    for (x0, y0), (x1, y1) in zip(area, np.roll(area, -1, axis=0), strict=True):
        inside &= (x1 - x0) * (up - y0) - (y1 - y0) * (across - x0) > 0.0
    return float(np.mean(inside))


def _crosses(start: Any, end: Any, tails: Any, tips: Any) -> Any:
    """Which of the lines the line to a label crosses, except those that begin where it starts."""
    way, lines, gap = np.subtract(end, start), tips - tails, tails - start
    turn = way[0] * lines[:, 1] - way[1] * lines[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        on_way = (gap[:, 0] * lines[:, 1] - gap[:, 1] * lines[:, 0]) / turn
        on_line = (gap[:, 0] * way[1] - gap[:, 1] * way[0]) / turn
    return (on_way > 0.05) & (on_way < 1.0) & (on_line > 0.0) & (on_line < 1.0)


def covers(start: Place, vector: Place, other: Place, along: Place, longest: float) -> bool:
    """Whether one arrow lies on another one; distances are judged relative to ``longest``."""
    length, size = math.hypot(*vector), math.hypot(*along)
    gap = start[0] - other[0], start[1] - other[1]
    if abs(cross(vector, along)) > ALONG_ONE_LINE * length * size or abs(cross(gap, along)) > 0.02 * longest * size:
        return False
    begin_at = (gap[0] * along[0] + gap[1] * along[1]) / size
    end_at = begin_at + (vector[0] * along[0] + vector[1] * along[1]) / size
    return min(max(begin_at, end_at), size) - max(min(begin_at, end_at), 0.0) > 0.02 * longest


def cross(one: Place, other: Place) -> float:
    """The cross product of two plane vectors."""
    return one[0] * other[1] - one[1] * other[0]


def beside(place: Place, direction: Place, far: float = 1.0) -> Place:
    """The point at this distance in a direction, or at the tip of a vector from there."""
    return place[0] + far * direction[0], place[1] + far * direction[1]


def off_line(place: Place, start: Place, vector: Place) -> float:
    """The distance of a point from an arrow."""
    length = math.hypot(*vector)
    along = vector[0] / length, vector[1] / length
    way = (place[0] - start[0]) * along[0] + (place[1] - start[1]) * along[1]
    nearest = beside(start, along, min(max(way, 0.0), length))
    return math.hypot(place[0] - nearest[0], place[1] - nearest[1])


class Arrows:
    """The arrows drawn so far, which new ones must not cover; ``size`` is that of the whole scene."""

    def __init__(self) -> None:
        self.size = 0.0
        self.moved = False
        self._drawn: list[tuple[Place, Place]] = []

    def hides(self, start: Place, vector: Place) -> bool:
        """Whether an arrow would lie on one of them."""
        return any(covers(start, vector, *other, self.size) or self._buries(start, vector, *other) for other in self._drawn)

    def _buries(self, start: Place, vector: Place, other: Place, along: Place) -> bool:
        """Whether the shorter of two arrows lies wholly beneath the line and the head of the longer."""
        if math.hypot(*vector) > math.hypot(*along):
            start, vector, other, along = other, along, start, vector
        return all(off_line(place, other, along) < _WIDE * self.size for place in (start, beside(start, vector)))

    def free(self, arrows: list[tuple[Place, Place]]) -> list[tuple[Place, Place]]:
        """The arrows, start and vector, all moved as far down, or to the right, as it takes."""
        length = max(math.hypot(*vector) for _, vector in arrows)
        if length == 0.0:
            return arrows
        vx, vy = max((vector for _, vector in arrows), key=lambda vector: math.hypot(*vector))
        aside = (-vy / length, vx / length) if (vx, vy) < (0.0, 0.0) else (vy / length, -vx / length)
        found, steps = arrows, 0
        while any(self.hides(start, vector) for start, vector in found if vector != (0.0, 0.0)):
            steps += 1
            found = [(beside(start, aside, steps * APART * self.size), vector) for start, vector in arrows]
        self.moved = self.moved or steps > 0
        self._drawn += [(start, vector) for start, vector in found if vector != (0.0, 0.0)]
        return found
