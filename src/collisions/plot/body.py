"""A vehicle seen from above within its outline: body, wheels, glass and front, for the eye; what is
calculated with is the outline.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from .canvas import INK, Axes
from .drawing import Place

# Shapes as shares of half the length and half the width, of the left side from the front back.
_CAR = (
    (1.0, 0.0), (1.0, 0.55), (0.97, 0.75), (0.9, 0.9), (0.76, 0.97), (0.55, 1.0), (-0.6, 1.0),
    (-0.84, 0.96), (-0.95, 0.86), (-0.99, 0.7), (-1.0, 0.5), (-1.0, 0.0),
)  # fmt: skip
_GLASS = (
    ((0.485, 0.0), (0.47, 0.45), (0.42, 0.8), (0.16, 0.68), (0.19, 0.4), (0.2, 0.0)),
    ((-0.58, 0.0), (-0.57, 0.4), (-0.54, 0.66), (-0.76, 0.74), (-0.8, 0.4), (-0.81, 0.0)),
)
_CYCLE = (
    (0.8, 0.0), (0.78, 0.2), (0.5, 0.3), (0.2, 0.5), (-0.2, 0.46), (-0.6, 0.34), (-0.86, 0.2),
    (-0.88, 0.0),
)  # fmt: skip
_BOX = ((1.0, 0.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, 0.0))
_CABIN = ((1.0, 0.0), (1.0, 0.7), (0.9, 0.95), (0.8, 1.0), (-1.0, 1.0), (-1.0, 0.0))
_BARS = ((0.58, 0.0), (0.56, 0.2), (0.44, 1.0), (0.36, 1.0), (0.46, 0.0))
_CAB, _GAP = 2.1, 0.25  # m: the cab of a truck, and the gap behind it
_AXLE = 0.58  # of the length: the wheelbase where none is known
# The size of a wheel [m].
_LONG, _WIDE = 0.64, 0.21
# Lengths and widths [m] of what is drawn as a car, a truck or a motorcycle; other outlines stay
# plain.
_SIZES = {
    "car": ((2.5, 5.7), (1.3, 2.15)),
    "truck": ((5.0, 20.0), (1.9, 2.7)),
    "motorcycle": ((1.6, 2.9), (0.45, 1.25)),
}
_SQUARE = 1e-6  # of the length: a rectangle to rounding


class Rectangle(NamedTuple):
    """A rectangle in the plane: its middle, its directions, and half its length and width."""

    middle: Place
    forward: Place
    left: Place
    length: float
    width: float

    def at(self, ahead: float, aside: float) -> Place:
        """The place so far ahead of the middle and to the left of it."""
        return (
            self.middle[0] + ahead * self.forward[0] + aside * self.left[0],
            self.middle[1] + ahead * self.forward[1] + aside * self.left[1],
        )

    def shape(self, shares: Any) -> list[Place]:
        """The corners of a shape that is given as shares, mirrored on the right side."""
        mirrored = [(ahead, -aside) for ahead, aside in reversed(shares) if aside]
        return [
            self.at(ahead * self.length, aside * self.width)
            for ahead, aside in (*shares, *mirrored)
        ]


def rectangle(corners: list[Place]) -> Rectangle | None:
    """The rectangle of these corners, front right first and anticlockwise; None if they are
    none.
    """
    if len(corners) != 4:
        return None
    right, left, back, other = corners
    long, wide = math.dist(left, back), math.dist(right, left)
    off = math.hypot(
        right[0] + back[0] - left[0] - other[0], right[1] + back[1] - left[1] - other[1]
    )
    if not min(long, wide) > 0.0 or off > _SQUARE * long:
        return None
    forward = (left[0] - back[0]) / long, (left[1] - back[1]) / long
    aside = (left[0] - right[0]) / wide, (left[1] - right[1]) / wide
    if abs(forward[0] * aside[0] + forward[1] * aside[1]) > _SQUARE:
        return None
    middle = 0.5 * (right[0] + back[0]), 0.5 * (right[1] + back[1])
    return Rectangle(middle, forward, aside, 0.5 * long, 0.5 * wide)


def kind_of(found: Rectangle | None, metre: float) -> str | None:
    """What has this length and width: "car", "truck" or "motorcycle"; None for anything else."""
    if found is None:
        return None
    long, wide = 2.0 * found.length / metre, 2.0 * found.width / metre
    return next(
        (
            kind
            for kind, ((shortest, longest), (least, most)) in _SIZES.items()
            if shortest <= long <= longest and least <= wide <= most
        ),
        None,
    )


def draw_body(
    axes: Axes,
    corners: list[Place],
    gid: str,
    colour: str,
    *,
    metre: float,
    filled: float,
    width: float,
    dashed: bool = False,
    wheels: tuple[Place, float, float] | None = None,
    above: float = 2.0,
) -> None:
    """Draw the vehicle of an outline, front edge first, with the outline and its front.

    ``wheels`` has the centre of mass, wheelbase and track, where they are known. What is named
    ``gid`` is the outline itself; of the rest only lines count where labels look for room.
    """
    from matplotlib.colors import to_rgba

    def part(what: str) -> str:
        return gid.replace("outline", what) if "outline" in gid else f"{gid} {what}"

    found = rectangle(corners)
    kind = kind_of(found, metre)
    style = "--" if dashed else "-"
    front: Any = {"color": colour, "lw": 3.0 * width, "solid_capstyle": "butt", "zorder": above + 1}
    if found is None or kind is None:
        shade = to_rgba(colour, filled)
        axes.fill(*_xy(corners), fc=shade, ec=colour, lw=width, ls=style, zorder=above, gid=gid)
        axes.plot(*_xy(corners[:2]), **front, gid=part("front"))
        return
    # The outline that is calculated with stays in sight beside the round corners.
    thin: Any = {"ec": to_rgba(colour, 0.4), "lw": 0.5 * width, "ls": "-"}
    axes.fill(*_xy(corners), fc="none", zorder=above, gid=gid, **thin)
    shown = 1.0 if filled else 0.3
    line: Any = {"ec": colour, "lw": width, "ls": style}
    bare: Any = {"ec": "none", "ls": "none"}
    for place in _wheels(found, kind, metre, wheels):
        tread = Rectangle(
            place, found.forward, found.left, 0.5 * _LONG * metre, 0.5 * _WIDE * metre
        )
        black = to_rgba(INK, 0.7 * shown)
        axes.fill(*_xy(tread.shape(_BOX)), fc=black, zorder=above + 0.35, gid=part("wheel"), **bare)
    shapes, glass = _PARTS[kind](found, metre)
    for shape in shapes:
        if filled:
            axes.fill(*_xy(shape), fc=(1.0, 1.0, 1.0, 0.75), zorder=above + 0.2, **bare)
        shade = to_rgba(colour, filled)
        axes.fill(*_xy(shape), fc=shade, zorder=above + 0.3, gid=part("body"), **line)
    for shape in glass:
        shade = to_rgba(colour, 0.6 * shown)
        axes.fill(*_xy(shape), fc=shade, zorder=above + 0.4, gid=part("glass"), **bare)
    share = 0.12 if kind == "motorcycle" else 0.55
    ends = [found.at(found.length, side * share * found.width) for side in (-1.0, 1.0)]
    axes.plot(*_xy(ends), **front, gid=part("front"))


def _xy(places: list[Place]) -> tuple[list[float], list[float]]:
    return [x for x, _ in places], [y for _, y in places]


def _wheels(
    found: Rectangle, kind: str, metre: float, known: tuple[Place, float, float] | None
) -> list[Place]:
    """The middles of the wheels: where they are known, or where such a vehicle has them."""
    if kind == "motorcycle":
        far = found.length - 0.5 * _LONG * metre
        return [found.at(far, 0.0), found.at(-far, 0.0)]
    if known is None:
        middle, base = found.middle, 2.0 * _AXLE * found.length
        track = 2.0 * found.width - 1.2 * _WIDE * metre
    else:
        middle, base, track = known
    about = found._replace(middle=middle)
    return [about.at(one * 0.5 * base, two * 0.5 * track) for one in (1, -1) for two in (1, -1)]


def _car(found: Rectangle, metre: float) -> tuple[list[Any], list[Any]]:
    return [found.shape(_CAR)], [found.shape(shares) for shares in _GLASS]


def _truck(found: Rectangle, metre: float) -> tuple[list[Any], list[Any]]:
    """A cab with its windscreen, and what it carries."""
    cab = min(_CAB * metre, 0.7 * found.length)
    gap, low = found.length - cab, -found.length
    cabin = found._replace(middle=found.at(found.length - 0.5 * cab, 0.0), length=0.5 * cab)
    load_end = gap - _GAP * metre
    load = found._replace(
        middle=found.at(0.5 * (load_end + low), 0.0), length=0.5 * (load_end - low)
    )
    screen = ((0.93, 0.0), (0.9, 0.8), (0.55, 0.74), (0.58, 0.0))
    return [cabin.shape(_CABIN), load.shape(_BOX)], [cabin.shape(screen)]


def _motorcycle(found: Rectangle, metre: float) -> tuple[list[Any], list[Any]]:
    return [found.shape(_CYCLE)], [found.shape(_BARS)]


_PARTS = {"car": _car, "truck": _truck, "motorcycle": _motorcycle}
