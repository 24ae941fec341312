"""The paths from an impact to rest: the vehicles of ``travel.simulate`` along them, and the marks
of their tyres.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..messages.errors import InputError
from ..messages.hints import hinted
from ..quantities.formatting import UnitSystem
from ..quantities.units import shown
from ..travel import SimulatedPath
from ..vehicle.vehicle import Vehicle
from .canvas import COLOURS, INK, Axes, Units, begin, size_of, tidy, who
from .drawing import Place, beside
from .scene import Picture, corners_of

_BETWEEN = 3  # outlines on the way, at equal parts of it
_ROOM = 2.0  # m, shown about a vehicle at rest


@hinted
def path(
    path_a: SimulatedPath,
    path_b: SimulatedPath | None = None,
    *,
    outline_a: Any = None,
    outline_b: Any = None,
    axes: Axes | None = None,
    units: UnitSystem | None = None,
) -> Axes:
    """The path of one or two vehicles from separation to rest, seen from above and to scale, with
    their tyre marks.

    Each is drawn at separation, three times along its path and, filled, at rest; the heavy edge is
    its front. The line is the path of the centre of mass; the grey lines are the marks of sliding
    tyres. Survey points can be drawn on the same Axes.

    Parameters
    ----------
    path_a, path_b : SimulatedPath
        From ``travel.simulate``, one case each; the second may be left out.
    outline_a, outline_b : tuple or corners [m], optional
        As for ``scene``. Without it only the centre of mass is marked, at separation and at rest.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on; by default those of a new figure.
    units : "si", "metric" or "us", optional
        m or ft.

    Returns
    -------
    matplotlib.axes.Axes
        By gid: "a.path", "b.path"; "a.mark", "b.mark" for each tyre that left one; "a.separation",
        "b.separation"; and at rest "a.centre", "b.centre", "a.outline", "b.outline".

    Raises
    ------
    InputError
        An unknown option, or a path that is not that of one answered case.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions import plot, travel
    >>> car = col.Vehicle(
    ...     mass=1500, yaw_inertia=2400, x=0, y=0, heading=0, vx="50 km/h", yaw_rate="150 deg/s"
    ... )
    >>> tyres = travel.Tyres(friction=0.7, lock=0.3, wheelbase=2.7, track=1.5)
    >>> axes = plot.path(travel.simulate(car, tyres), outline_a=(4.4, 1.8), units="metric")
    >>> axes.get_xlabel()
    'x [m]'
    """
    labels = Units(units, path_a)
    if path_b is None and outline_b is not None:
        raise InputError(
            "outline_b has no path_b to go with; give both", code="bad_option", argument="outline_b"
        )
    given = {"a": (path_a, outline_a)} | ({} if path_b is None else {"b": (path_b, outline_b)})
    ways = {letter: _one(way, f"path_{letter}") for letter, (way, _) in given.items()}
    corners = {
        letter: [
            corners_of(stop, outline, f"outline_{letter}", letter) for stop in _stops(ways[letter])
        ]
        for letter, (_, outline) in given.items()
    }
    axes = begin(axes, (7.5, 6.5))
    picture, metre = Picture(axes, labels), labels.factor("m")
    for index, (letter, way) in enumerate(ways.items()):
        colour, name = COLOURS[index], "AB"[index]
        line = _places(way.x * metre, way.y * metre)
        # A vehicle takes up some room, wherever it goes.
        picture.include(
            *line, *(beside(line[-1], (side, side), _ROOM * metre) for side in (-1.0, 1.0))
        )
        axes.plot(
            *np.transpose(line),
            color=colour,
            lw=1.2,
            ls=("-", (0, (6, 2)))[index],
            zorder=3,
            gid=f"{letter}.path",
        )
        for mark in way.marks:
            x, y = (part * metre for part in mark)
            slid = np.isfinite(x)
            if slid.any():
                axes.plot(x, y, color=INK, lw=1.6, alpha=0.45, zorder=1, gid=f"{letter}.mark")
                picture.include(*_places(x[slid], y[slid]))
        *passed, at_rest = (
            [picture.scaled(corner) for corner in outline] for outline in corners[letter]
        )
        for outline in filter(None, passed):
            picture.outline(index, outline, f"{letter}.passing outline", 0.0, 0.7)
        axes.plot(
            *line[0],
            "os"[index],
            ms=5,
            mfc=colour,
            mec=colour,
            zorder=6,
            gid=f"{letter}.separation",
        )
        back = line[0][0] - line[-1][0], line[0][1] - line[-1][1]
        picture.label(line[0], f"{name} at separation", back, colour, of=index)
        moves = way.end.speed or way.end.yaw_rate
        stays = "at the end" if moves else "at rest"
        picture.body(line[-1], index, f"{who(index, way.end)} {stays}", at_rest)
    axes.set(xlabel=labels.label("x", "m"), ylabel=labels.label("y", "m"))
    axes.set_title("From separation to rest", fontsize=10.5)
    tidy(axes, (-3, 8))
    picture.finish()
    return axes


def _one(way: Any, name: str) -> SimulatedPath:
    """The path of a single case that can be drawn."""
    if not isinstance(way, SimulatedPath):
        raise InputError(
            f"{name} must be a path of travel.simulate, got {shown(way)} of type "
            f"{type(way).__name__}; write plot.path(travel.simulate(impact.a.after, tyres), "
            "travel.simulate(impact.b.after, tyres))",
            code="bad_option",
            argument=name,
        )
    if way.x.ndim != 1:
        raise InputError(
            f"{name} has many cases, and a picture is of one; simulate that one alone",
            code="bad_shape",
            argument=name,
        )
    size_of(_places(way.x, way.y), Units("si"), sketched=True)
    return way


def _places(x: Any, y: Any) -> list[Place]:
    """The places with these coordinates."""
    return list(zip(x.tolist(), y.tolist(), strict=True))


def _stops(way: SimulatedPath) -> list[Vehicle]:
    """The vehicle at separation, at equal parts of its way, and at rest."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(way.x), np.diff(way.y)))])
    parts = np.linspace(0.0, along[-1], _BETWEEN + 2)[:-1]
    places = [
        [float(np.interp(part, along, values)) for part in parts]
        for values in (way.x, way.y, way.heading)
    ]
    # Less than a turn, or a vehicle that spun would be asked whether degrees were meant.
    turned = (
        (x, y, math.remainder(heading, math.tau)) for x, y, heading in zip(*places, strict=True)
    )
    return [*(way.end.replace(x=x, y=y, heading=heading) for x, y, heading in turned), way.end]
