"""The small picture of a run from above that a notebook shows, as SVG; and what it shares with the
other pictures of a run.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..quantities.formatting import typeset
from ..quantities.tables import Cells
from .frames import Frames, frames_of

if TYPE_CHECKING:
    from .run import Run

# Colours of vehicles in their order, again from the first after the last; lines differ in black
# and white, by these parts of their dashes.
COLOURS = ("#1f5fa8", "#b3541e", "#2f7d4f", "#7a3d8f", "#8a6d00", "#a01040")
DASHES: tuple[tuple[float, ...], ...] = ((), (6.0, 2.0), (6.0, 2.0, 1.0, 2.0), (2.0, 1.5))
# As shares of the larger extent of the view: its margin and the longest scale bar.
_MARGIN, _BAR = 0.06, 0.2
_LEAST = 8.0  # m, of the view
_FLAT = 0.3  # of its width: the least height of the view, and the other way round
_ROOM = 2.5  # m, about a vehicle without an outline
_LARGEST = 1e7  # m: what is farther is not drawn
_INK = "#1a1a1a"
# Hundredths of the view: the letters, about how wide one is, and the step of a track.
_LETTER, _WIDE, _STEP = 2.6, 0.58, 0.5


def from_the_front(outline: Any) -> Any:
    """The corners (forward, left) [m] of an outline from its front edge on, which is drawn
    heavy.
    """
    ahead = outline[:, 0] + np.roll(outline[:, 0], -1)
    return np.roll(outline, -int(np.argmax(ahead)), axis=0)


def view_of(run: Run, frames: Frames, least: float) -> list[float]:
    """Left, top, width and height of what is seen [m], y downwards as in SVG; neither is less than
    this share of the other.
    """
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for name, state in frames.states.items():
        reach = run.scene.movers[name].reach or _ROOM
        low = np.minimum(low, state[:2].min(axis=1) - reach)
        high = np.maximum(high, state[:2].max(axis=1) + reach)
    middle, extent = 0.5 * (low + high), np.maximum(high - low, 0.0)
    most = max(float(extent.max()), _LEAST)
    half = np.maximum(0.5 * extent + _MARGIN * most, 0.5 * least * most)
    return [
        float(number)
        for number in (middle[0] - half[0], -(middle[1] + half[1]), 2.0 * half[0], 2.0 * half[1])
    ]


def place_of(run: Run, number: int, frames: Frames) -> list[float]:
    """The point of an impact, or of a central one the middle between both vehicles."""
    point = run.impacts[number].point
    if point is not None:
        return [float(point[0]), float(point[1])]
    at = frames.after[number]
    one, other = (frames.states[name][:2, at] for name in run.pairs[number])
    middle: list[float] = (0.5 * (one + other)).tolist()
    return middle


def bar_of(extent: float, system: Cells) -> dict[str, Any]:
    """A scale bar: 1, 2 or 5 times a power of ten of the unit of length."""
    most = _BAR * extent * system.scale("length")
    power = 10.0 ** math.floor(math.log10(most))
    length = next(power * step for step in (5.0, 2.0, 1.0) if power * step <= most)
    text = f"{length:g} {typeset(system.label('length'))}"
    return {"length": length / system.scale("length"), "text": text}


def small_picture(run: Run, system: Cells) -> str:
    """Tracks, outlines at the start and at the end, impacts and a scale bar as an SVG element; ""
    of a run without places, or whose places are too far apart.
    """
    frames = frames_of(run)
    drawn = [
        one
        for name, state in frames.states.items()
        for one in state[: 2 if run.scene.movers[name].outline is None else 3]
    ]
    if not all(np.isfinite(one).all() and np.abs(one).max() < _LARGEST for one in drawn):
        return ""
    return _Drawing(run, frames, system).whole()


class _Drawing:
    """The parts of a picture, in metres, with y downwards."""

    def __init__(self, run: Run, frames: Frames, system: Cells) -> None:
        self.run, self.frames, self.system = run, frames, system
        self.view = view_of(run, frames, _FLAT)
        self.size = max(self.view[2:]) / 100.0
        self.decimals = max(0, 1 - math.floor(math.log10(self.size)))
        # What labels keep clear of: left, top, right and bottom.
        self.taken: list[tuple[float, float, float, float]] = []

    def whole(self) -> str:
        """The element, with what it shows in words."""
        run, size, movers = self.run, self.size, self.run.scene.movers
        parts = [
            self.element("polygon", points=np.asarray(corners, dtype=float), fill="#e6e6e6")
            for corners, _ in run.scene.surfaces
        ]
        for index, name in enumerate(movers):
            parts += self.vehicle(index, name)
        for number in range(len(run.impacts)):
            place = place_of(run, number, self.frames)
            parts.append(self.spot(place, 0.8, fill=_INK, stroke="#fff", stroke_width=0.25 * size))
            parts.append(self.label(str(number + 1), [(place[0], place[1])], _INK))
        for index, name in enumerate(movers):
            said = name if _rests(run, name) else f"{name} moves on"
            parts.append(self.label(said, self.corners(name, -1), _colour(index)))
        bar = bar_of(100.0 * size, self.system)
        x, y = self.view[0] + 2.5 * size, -(self.view[1] + self.view[3] - 2.5 * size)
        ends = [(x, y), (x + bar["length"], y)]
        parts.append(self.element("polyline", points=ends, stroke=_INK, stroke_width=0.5 * size))
        parts.append(self.words(x, -y - size, bar["text"], _INK, "start"))
        return self.element(
            "svg",
            "".join(parts),
            xmlns="http://www.w3.org/2000/svg",
            role="img",
            aria_label=self.said(),
            viewBox=" ".join(map(self.number, self.view)),
            style="display:block;width:100%;max-width:560px;max-height:380px;background:#fff",
            font_family="sans-serif",
            font_size=_LETTER * size,
        )

    def vehicle(self, index: int, name: str) -> list[str]:
        """Its track, and its outlines at the start and at the end."""
        size, colour = self.size, _colour(index)
        dashes = " ".join(self.number(0.5 * size * part) for part in DASHES[index % len(DASHES)])
        line: dict[str, Any] = {"fill": "none", "stroke": colour, "stroke_width": 0.35 * size}
        found = [self.element("polyline", points=self.track(name), stroke_dasharray=dashes, **line)]
        filled = {"fill": colour, "fill_opacity": ".16"}
        for at, look in ((0, {"stroke_opacity": ".5"}), (-1, filled)):
            corners = self.corners(name, at)
            if len(corners) == 1:
                found.append(self.spot(corners[0], 0.7, **line | look))
                continue
            found.append(self.element("polygon", points=corners, **line | look))
            front = line | {"stroke_width": 0.8 * size}
            found.append(self.element("polyline", points=corners[:2], **front))
        xs, ys = zip(*self.corners(name, -1), strict=True)
        self.taken.append((min(xs), -max(ys), max(xs), -min(ys)))
        return found

    def track(self, name: str) -> list[tuple[float, float]]:
        """The way of a vehicle without places that are too near to see."""
        x, y = self.frames.states[name][:2].tolist()
        found = [(x[0], y[0])]
        for place in zip(x, y, strict=True):
            if math.dist(place, found[-1]) > _STEP * self.size:
                found.append(place)
        return [*found, (x[-1], y[-1])]

    def corners(self, name: str, at: int) -> list[tuple[float, float]]:
        """The corners of a vehicle at one of the moments, from its front edge on; without an
        outline its place.
        """
        x, y, heading = self.frames.states[name][:3, at].tolist()
        outline = self.run.scene.movers[name].outline
        if outline is None:
            return [(x, y)]
        c, s = math.cos(heading), math.sin(heading)
        return [
            (x + c * forward - s * side, y + s * forward + c * side)
            for forward, side in from_the_front(outline).tolist()
        ]

    def label(self, text: str, places: Sequence[tuple[float, float]], colour: str) -> str:
        """Words beside places, on the side where they cover least."""
        tall = _LETTER * self.size
        wide = _WIDE * tall * (len(text) + 1)
        xs, ys = zip(*places, strict=True)
        x, y, room = 0.5 * (min(xs) + max(xs)), -0.5 * (min(ys) + max(ys)), 1.2 * self.size
        over, under = -max(ys) - room, -min(ys) + room + 0.75 * tall
        left, right = min(xs) - room - 0.5 * wide, max(xs) + room + 0.5 * wide
        around = [(x, over), (x, under), (right, y + 0.35 * tall), (left, y + 0.35 * tall)]
        around += [(x, over - 1.1 * tall), (x, under + 1.1 * tall)]
        boxes = [
            (one - 0.5 * wide, line - 0.8 * tall, one + 0.5 * wide, line + 0.2 * tall)
            for one, line in around
        ]
        at = min(range(len(boxes)), key=lambda one: (self.covered(boxes[one]), one))
        self.taken.append(boxes[at])
        return self.words(*around[at], text, colour, "middle")

    def covered(self, box: tuple[float, float, float, float]) -> float:
        """How much a box covers of what is taken or is out of view."""
        left, upper, wide, high = self.view
        out = (box[2] - box[0]) * (box[3] - box[1]) - _common(
            box, (left, upper, left + wide, upper + high)
        )
        return out + sum(_common(box, one) for one in self.taken)

    def words(self, x: float, y: float, text: str, colour: str, anchor: str) -> str:
        """A text with a white edge, so that it can be read above lines."""
        return self.element(
            "text", _escaped(text), x=x, y=y, text_anchor=anchor, fill=colour, stroke="#fff",
            stroke_width=0.6 * self.size, paint_order="stroke",
        )  # fmt: skip

    def spot(self, place: Sequence[float], radius: float, **look: Any) -> str:
        """A small circle."""
        return self.element("circle", cx=place[0], cy=-place[1], r=radius * self.size, **look)

    def element(self, tag: str, inside: str = "", points: Any = (), **attributes: Any) -> str:
        """An element with its attributes, of which those that are empty are left out."""
        joined = " ".join(f"{self.number(float(x))},{self.number(-float(y))}" for x, y in points)
        said = "".join(
            f' {name.replace("_", "-")}="{_escaped(self.number(value))}"'
            for name, value in ({"points": joined} | attributes).items()
            if value != ""
        )
        return f"<{tag}{said}>{inside}</{tag}>"

    def number(self, value: float | str) -> str:
        """A number with the decimals that can be seen; words as they are."""
        return f"{value:.{self.decimals}f}" if isinstance(value, float) else value

    def said(self) -> str:
        """What the picture shows, in words."""
        run, said = self.run, []
        for name in run.scene.movers:
            x, y = (
                typeset(self.system.text(float(part), "m"))
                for part in self.frames.states[name][:2, -1]
            )
            does = "comes to rest at" if _rests(run, name) else "moves on past"
            said.append(f"{name} {does} x {x}, y {y}")
        for number, (time, pair) in enumerate(zip(run.times, run.pairs, strict=True), 1):
            said.append(f"impact {number} is that of {' and '.join(pair)} at {time:.2f} s")
        return f"The scene from above. {'; '.join(said)}."


def _common(one: Sequence[float], other: Sequence[float]) -> float:
    """The area that two boxes have in common."""
    wide = min(one[2], other[2]) - max(one[0], other[0])
    high = min(one[3], other[3]) - max(one[1], other[1])
    return max(0.0, wide) * max(0.0, high)


def _escaped(text: str) -> str:
    from html import escape

    return escape(text)


def _colour(index: int) -> str:
    return COLOURS[index % len(COLOURS)]


def _rests(run: Run, name: str) -> bool:
    """Whether a vehicle comes to rest."""
    with np.errstate(all="ignore"):
        return math.isfinite(run._followed.courses[name].rests[0])
