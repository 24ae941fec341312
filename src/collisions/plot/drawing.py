"""``Drawing``: arrows that do not overlap each other, and labels placed clear of them."""

from __future__ import annotations

import math
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from .canvas import INK, Axes

Place = tuple[float, float]

_FONT = 9.5
# As shares of the larger extent: the margin left free all round, and the least width and height.
# Labels are wide, so a narrow picture has less room for them than a flat one.
_MARGIN, _LEAST = 0.14, (0.7, 0.42)
# Points: a cell of the map of what is drawn, what stays free around a label, and what is mapped
# beyond the Axes.
_CELL, _CLEAR, _BEYOND = 2.0, 3.0, 120.0
# What a cell costs a label that covers it: of a line, by its width; of another label; beyond the
# Axes.
_LINE, _LABEL, _OUTSIDE = 40.0, 100.0, 30.0
_FOREIGN = 100.0  # the cost of lying wholly on the other vehicle
_LONGEST = 5000.0  # points of a line that are mapped
_RING = np.stack(
    [np.cos(np.linspace(0.0, math.tau, 13)), np.sin(np.linspace(0.0, math.tau, 13))], axis=1
)
_NEAR, _FAR, _TURN = (
    5.0,
    0.4,
    3.0,
)  # points that are too near, and the cost of a point and of a radian away
_NEARBY = 80.0  # points around its places in which a label is looked for first
# Arrows within this sine of one line hide each other.
ALONG_ONE_LINE = 0.03
APART = 0.045  # of the size of the scene: between arrows that would hide each other
_TICKS, _FEWEST_TICKS = 6, 2  # along x
# Of arrow heads: the scale, the length at a scale of 1, the smallest scale, and the share of a
# short arrow, which shows its shaft too.
_HEAD, _HEAD_LENGTH, _SMALLEST_HEAD, _OF_SHORT = 13.0, 0.55, 4.0, 0.5
_WIDE = 0.04  # of the size of the scene: anything nearer to an arrow is beneath it


class _Label(NamedTuple):
    places: tuple[Place, ...]
    direction: Place
    of: int | None
    text: Any


class Drawing:
    """The drawing on one Axes in data coordinates; labels go where there is room when it is
    rendered, at its size then.

    ``size`` is that of the whole scene, by which distances of arrows are judged.
    """

    def __init__(self, axes: Axes, size: float = 0.0) -> None:
        self.axes, self.size = axes, size
        self.moved = False
        self._labels: list[_Label] = []
        self.arrows: list[tuple[Place, Place, float]] = []
        self._made: list[tuple[Any, float]] = []
        self._seen: list[Place] = []
        self._areas: dict[int, list[Place]] = {}
        self._found: tuple[Any, list[Place]] = (None, [])

    def arrow(
        self, tail: Place, tip: Place, gid: str, *, colour: str, width: float, style: Any = "-"
    ) -> None:
        """An arrow whose ends are exactly these; none without a length."""
        self.include(tail, tip)
        if tail == tip:
            return
        made = self.axes.annotate(
            "",
            xy=tip,
            xytext=tail,
            arrowprops={
                "arrowstyle": f"-|>,head_length={_HEAD_LENGTH},head_width=0.22",
                "mutation_scale": _HEAD,
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
        self._made.append((made, math.dist(tail, tip)))
        self.arrows.append((tail, tip, width))

    def covers(self, start: Place, vector: Place) -> bool:
        """Whether a new arrow would lie on one that was drawn."""
        return any(
            covers(start, vector, tail, beside(tip, tail, -1.0), self.size)
            for tail, tip, _ in self.arrows
        )

    def hides(self, start: Place, vector: Place) -> bool:
        """Whether a new arrow would lie on one that was drawn, or one of the two
        beneath the other.
        """
        return self.covers(start, vector) or any(
            _buries((start, beside(start, vector)), (tail, tip), _WIDE * self.size)
            for tail, tip, _ in self.arrows
        )

    def free(self, arrows: list[tuple[Place, Place]]) -> list[tuple[Place, Place]]:
        """The new arrows, start and vector, all moved as far down, or to the right, as it takes to
        hide none.
        """
        vx, vy = max((vector for _, vector in arrows), key=lambda vector: math.hypot(*vector))
        length = math.hypot(vx, vy)
        if length == 0.0:
            return arrows
        aside = (
            (-vy / length, vx / length) if (vx, vy) < (0.0, 0.0) else (vy / length, -vx / length)
        )
        found, steps = arrows, 0
        while any(self.hides(start, vector) for start, vector in found if vector != (0.0, 0.0)):
            steps += 1
            found = [
                (beside(start, aside, steps * APART * self.size), vector)
                for start, vector in arrows
            ]
        self.moved = self.moved or steps > 0
        return found

    def line(self, one: Place, other: Place, gid: str, **style: Any) -> None:
        """A straight line."""
        self.include(one, other)
        self.axes.plot([one[0], other[0]], [one[1], other[1]], gid=gid, **style)

    def include(self, *places: Place) -> None:
        """Extend the limits to include these points."""
        self._seen.extend(places)

    def area(self, index: int, corners: list[Place]) -> None:
        """The convex outline of a vehicle, anticlockwise, which no label of the other one shall
        stand on.
        """
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
        """A text next to a place, or at an alternative one, in this direction if there is room;
        ``of`` names the vehicle.
        """
        made = self.axes.annotate(
            text,
            xy=place,
            xytext=(0.0, 0.0),
            textcoords=partial(self._where, len(self._labels)),
            ha="center",
            va="center",
            fontsize=_FONT,
            color=colour,
            parse_math=False,
            annotation_clip=False,
            zorder=6,
            bbox={"boxstyle": "square,pad=0.05", "fc": "white", "ec": "none", "alpha": 0.75},
        )
        self._labels.append(_Label((place, *others), direction, of, made))

    def finish(self) -> None:
        """Settle the limits, so that everything is in view."""
        places = np.array(self._seen)
        low, high = places.min(axis=0), places.max(axis=0)
        middle = 0.5 * (low + high)
        half = 0.5 * (high - low) + _MARGIN * max(high - low)
        # Widened where one direction would be a thin strip.
        half = np.maximum(half, np.array(_LEAST) * max(half))
        self.axes.set(
            xlim=(middle[0] - half[0], middle[0] + half[0]),
            ylim=(middle[1] - half[1], middle[1] + half[1]),
        )
        self.axes.set_aspect("equal", adjustable="box")
        self.axes.apply_aspect()
        # As many numbers as stand beside each other, of a narrow picture fewer.
        most = round(_TICKS * half[0] / max(half))
        self.axes.locator_params(axis="x", nbins=max(most, _FEWEST_TICKS))
        extent = max(self.axes.bbox.size) * 72.0 / self.axes.figure.dpi
        for made, length in self._made:
            points = extent * length / (2.0 * max(half))
            scale = _OF_SHORT * points / _HEAD_LENGTH
            made.arrowprops["mutation_scale"] = min(max(scale, _SMALLEST_HEAD), _HEAD)

    def _where(self, index: int, renderer: Any) -> Any:
        """Where a label is rendered; all of them are placed anew when the size of the picture or
        its limits change.
        """
        from matplotlib.transforms import Affine2D

        axes = self.axes
        size = (*axes.bbox.extents, *axes.viewLim.extents, axes.figure.dpi)
        if self._found[0] != size:
            self._found = size, self._places(renderer)
        return Affine2D().translate(*self._found[1][index])

    def _places(self, renderer: Any) -> list[Place]:
        """The middle of every label in pixels: each where it costs least, in their order."""
        from matplotlib.text import Text

        pixels = self.axes.figure.dpi / 72.0

        def to_points(places: Any) -> Any:
            return self.axes.transData.transform(places) / pixels

        extent: Any = np.array(self.axes.bbox.extents) / pixels
        room = _Room(extent)
        # The axes themselves, on which no label shall stand.
        room.draw(extent[[[0, 3], [0, 1], [2, 1]]], _LINE)
        for tail, tip, width in self.arrows:
            room.draw(to_points([tail, tip]), _LINE * width)
        for artist in (*self.axes.lines, *self.axes.patches):
            drawn: Any = artist
            path = drawn.get_transform().transform_path(drawn.get_path()).vertices / pixels
            if artist in self.axes.lines and drawn.get_marker() not in (
                "None",
                "none",
                "",
                " ",
                None,
            ):
                room.draw(path[:, None] + 0.5 * drawn.get_markersize() * _RING, _LINE)
            if drawn.get_linestyle() not in ("None", "none", "", " "):
                room.draw(path, _LINE * drawn.get_linewidth())
        areas = {index: room.within(to_points(corners)) for index, corners in self._areas.items()}
        found: dict[int, Place] = {}
        taken: dict[int, tuple[slice, slice]] = {}
        # Once more, as those placed later leave room that the earlier ones did not know of.
        for i, label in 2 * list(enumerate(self._labels)):
            if i in taken:
                room.cost[taken[i]] -= _LABEL
            # The extent of the text alone: the annotation's own asks for the place.
            size = np.array(Text.get_window_extent(label.text, renderer).size) / pixels
            foreign = [area for index, area in areas.items() if label.of not in (None, index)]
            found[i], taken[i] = room.best(size, to_points(label.places), label.direction, foreign)
        return [(x * pixels, y * pixels) for x, y in found.values()]


class _Room:
    """What is drawn on some Axes, as the cost of covering each cell of a map in points."""

    def __init__(self, extent: Any) -> None:
        self.corner = extent[:2] - _BEYOND
        shape = np.ceil((extent[2:] - extent[:2] + 2.0 * _BEYOND) / _CELL).astype(int)[::-1]
        edge = round(_BEYOND / _CELL)
        self.cost = np.full(shape, _OUTSIDE)
        self.cost[edge:-edge, edge:-edge] = 0.0
        self.y, self.x = (self.corner[1 - i] + _CELL * (np.arange(shape[i]) + 0.5) for i in (0, 1))

    def draw(self, path: Any, cost: float) -> None:
        """A line through these points, or lines if there are several rows of them; gaps where one
        is not finite.
        """
        begin, end = (part.reshape(-1, 2) for part in (path[..., :-1, :], path[..., 1:, :]))
        whole = np.isfinite(begin + end).all(axis=1)
        begin, way = begin[whole], (end - begin)[whole]
        count = np.minimum(np.hypot(*way.T), _LONGEST).astype(int) + 2
        share = (np.arange(count.sum()) - np.repeat(count.cumsum() - count, count)) / np.repeat(
            count - 1, count
        )
        cells = (
            np.repeat(begin, count, axis=0)
            + share[:, None] * np.repeat(way, count, axis=0)
            - self.corner
        ) // _CELL
        column, row = cells[
            ((cells >= 0.0) & (cells < self.cost.shape[::-1])).all(axis=1)
        ].T.astype(int)
        np.maximum.at(self.cost, (row, column), cost)

    def within(self, corners: Any) -> Any:
        """Which cells lie within a convex area whose corners run anticlockwise."""
        inside = np.ones(self.cost.shape, dtype=bool)
        for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            inside &= (x1 - x0) * (self.y[:, None] - y0) - (y1 - y0) * (self.x - x0) > 0.0
        return inside

    def best(
        self, size: Any, places: Any, direction: Place, foreign: list[Any]
    ) -> tuple[Place, tuple[slice, slice]]:
        """The middle of a label of this size next to one of the places, and the cells that it
        covers: these are taken.
        """
        columns, rows = np.minimum(
            np.ceil((size + 2.0 * _CLEAR) / _CELL).astype(int), self.cost.shape[::-1]
        )
        covered = _sums(self.cost, rows, columns)
        for area in foreign:
            covered += _FOREIGN * _sums(area, rows, columns) / (rows * columns)
        x, y = (_sums(part[None], 1, n)[0] / n for part, n in ((self.x, columns), (self.y, rows)))
        # What lies farther from every place costs at least the way there, so the search ends where
        # that is too much.
        reach, least, beyond = _NEARBY, math.inf, 0.0
        while beyond <= least:
            (low_x, high_x), (low_y, high_y) = (
                _around(at, places[:, i], reach) for i, at in ((0, x), (1, y))
            )
            window = slice(low_y, high_y), slice(low_x, high_x)
            near_x, near_y = x[window[1]], y[window[0]][:, None]
            away = (
                _away(near_x - at[0], near_y - at[1], size, direction) + 2.0 * i
                for i, at in enumerate(places)
            )
            cost = covered[window] + np.min(list(away), axis=0)
            if cost.size:
                row, column = np.unravel_index(np.argmin(cost), cost.shape)
                least = cost[row, column]
            beyond = _FAR * (reach - 0.5 * max(size)) if cost.size < covered.size else math.inf
            reach *= 2.0
        row, column = row + low_y, column + low_x
        # Above each other one label keeps clear of the other, not both; side by side they would
        # read as one line.
        cells = slice(row + 1, row + rows - 1), slice(max(column - 1, 0), column + columns + 1)
        self.cost[cells] += _LABEL
        return (float(x[column]), float(y[row])), cells


def _around(cells: Any, places: Any, reach: float) -> tuple[int, int]:
    """The range of ascending cells that lie within reach of the places."""
    ends = np.searchsorted(cells, [places.min() - reach, places.max() + reach])
    return int(ends[0]), int(ends[1])


def _sums(cells: Any, rows: int, columns: int) -> Any:
    """The sums over every window of so many cells."""
    total = np.zeros((cells.shape[0] + 1, cells.shape[1] + 1))
    inner = total[1:, 1:]
    np.cumsum(cells, axis=0, dtype=float, out=inner)
    np.cumsum(inner, axis=1, out=inner)
    return (
        total[rows:, columns:]
        - total[:-rows, columns:]
        - total[rows:, :-columns]
        + total[:-rows, :-columns]
    )


def _away(x: Any, y: Any, size: Any, direction: Place) -> Any:
    """What it costs a label that its middle lies there from its place: too near, far, or in another
    direction.
    """
    far = np.hypot(np.maximum(abs(x) - 0.5 * size[0], 0.0), np.maximum(abs(y) - 0.5 * size[1], 0.0))
    turn = abs(
        (np.arctan2(y, x) - math.atan2(direction[1], direction[0]) + math.pi) % math.tau - math.pi
    )
    return _FAR * far + 20.0 * np.maximum(_NEAR - far, 0.0) + _TURN * turn


def covers(start: Place, vector: Place, other: Place, along: Place, longest: float) -> bool:
    """Whether one arrow lies on another one; distances are judged relative to ``longest``."""
    length, size = math.hypot(*vector), math.hypot(*along)
    gap = start[0] - other[0], start[1] - other[1]
    if (
        abs(cross(vector, along)) > ALONG_ONE_LINE * length * size
        or abs(cross(gap, along)) > 0.02 * longest * size
    ):
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


def _buries(one: tuple[Place, Place], other: tuple[Place, Place], wide: float) -> bool:
    """Whether the shorter of two arrows, tail and tip, lies wholly beneath the line and the head of
    the longer.
    """
    shorter, longer = sorted((one, other), key=lambda ends: math.dist(*ends))
    return all(_off_line(place, *longer) < wide for place in shorter)


def _off_line(place: Place, tail: Place, tip: Place) -> float:
    """The distance of a point from an arrow."""
    length = math.dist(tail, tip)
    along = (tip[0] - tail[0]) / length, (tip[1] - tail[1]) / length
    way = (place[0] - tail[0]) * along[0] + (place[1] - tail[1]) * along[1]
    return math.dist(place, beside(tail, along, min(max(way, 0.0), length)))
