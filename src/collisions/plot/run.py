"""The picture of a whole scene: outlines at the start, at contacts and at rest, tracks, tyre marks
and surfaces, with a scale bar.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..messages.errors import CollisionsError, MissingInputError
from ..quantities.formatting import UnitSystem
from ..scene.marks import drawn
from ..scene.one_run import need_one_run
from ..scene.picture import COLOURS, DASHES, from_the_front
from ..scene.run import Run, Track
from .body import draw_body
from .canvas import GREY, INK, Axes, Units, begin, check_size, in_lines, size_of, tidy
from .drawing import Drawing, Place, beside

# Lines of vehicles in their order, as COLOURS.
STYLES: tuple[Any, ...] = tuple((0, dashes) if dashes else "-" for dashes in DASHES)
_ROOM = 2.0  # m, shown about a vehicle without an outline
_MARKS = "; grey lines: tyre marks"
_BAR = 0.22  # of the width: the longest scale bar


class Stop(NamedTuple):
    """Where a vehicle is at one moment: its centre of mass, its corners from the front on, and its
    centre, wheelbase and track if it has tyres.
    """

    place: Place
    corners: list[Place]
    wheels: tuple[Place, float, float] | None


def draw_run(run: Run, axes: Axes | None, units: UnitSystem | None) -> Axes:
    """Draw a run from above, to scale."""
    labels, tracks = Units(units, run), tracks_of(run, "plot.scene")
    marks = {name: drawn(run, name) for name in tracks}
    metre = labels.factor("m")
    axes = begin(axes, (8.6, 7.0))
    drawing = Drawing(axes)
    _surfaces(run, drawing, labels)
    for index, (name, track) in enumerate(tracks.items()):
        colour, style = COLOURS[index % len(COLOURS)], STYLES[index % len(STYLES)]
        line = np.array([track.x, track.y]) * metre
        drawing.include(*zip(*line.tolist(), strict=True))
        axes.plot(*line, color=colour, lw=1.2, ls=style, zorder=3, gid=f"{name}.track")
        for _, x, y in marks[name].values():
            axes.plot(
                x * metre, y * metre, color=INK, lw=1.6, alpha=0.4, zorder=1, gid=f"{name}.mark"
            )
            slid = np.isfinite(x)
            drawing.include(
                *zip((x[slid] * metre).tolist(), (y[slid] * metre).tolist(), strict=True)
            )
    for index, name in enumerate(tracks):
        _stops(run, name, index, drawing, labels)
    for number, (time, pair, impact) in enumerate(
        zip(run.times, run.pairs, run.impacts, strict=True)
    ):
        if impact.point is not None:
            at = float(impact.point[0]) * metre, float(impact.point[1]) * metre
        else:
            stops = [_stop_at(run, name, time, metre).place for name in pair]
            at = 0.5 * (stops[0][0] + stops[1][0]), 0.5 * (stops[0][1] + stops[1][1])
        drawing.include(at)
        axes.plot(*at, "X", ms=8, mfc=INK, mec="white", zorder=8, gid=f"contact.{number}")
        drawing.label(at, f"{contact_name(number, pair)}\nat {time:.2f} s", (1.0, 1.0))
    marked = _MARKS * any(marks.values())
    note = f"outlines: dashed at the start, thin at contacts, filled at the end{marked}"
    axes.set(xlabel=f"{labels.label('x', 'm')}\n{note}", ylabel=labels.label("y", "m"))
    names = in_lines(", ".join(tracks), 70, 2)
    axes.set_title(f"{names}: from the start to rest", fontsize=10.5, parse_math=False)
    tidy(axes, (-3, 8))
    drawing.finish()
    _scale_bar(axes, labels)
    return axes


def contact_name(number: int, pair: tuple[str, str]) -> str:
    """The number of an impact, counted from 1, and its two vehicles."""
    return in_lines(f"{number + 1}: {' and '.join(pair)}")


def tracks_of(run: Any, function: str, placed: bool = True) -> dict[str, Track]:
    """The tracks of all vehicles by name, of one case whose numbers can be drawn; ``placed`` where
    each needs a place.
    """
    run = need_one_run(run, function)
    for name, mover in run.scene.movers.items():
        lacking = [one for one in ("x", "y", "heading") if getattr(mover.vehicle, one) is None]
        if lacking and placed:
            raise MissingInputError(
                f"`|{function} needs|a picture needs` {', '.join(lacking)} of {name}; "
                f"`|write Vehicle({', '.join(f'{one}=...' for one in lacking)})"
                "|write what is missing into its table`",
                code=f"missing_{lacking[0]}",
                argument=f"{name}.{lacking[0]}",
            )
    tracks = dict(run.paths)
    for track in tracks.values():
        for part in (*(("x", "y") if placed else ()), "vx", "vy", "yaw_rate", "time"):
            check_size(part, float(np.max(np.abs(getattr(track, part)))))
    if placed:
        ends = [(track.x[at], track.y[at]) for track in tracks.values() for at in (0, -1)]
        size_of([(float(x), float(y)) for x, y in ends], Units("si"), sketched=True)
    return tracks


def stop_of(run: Run, name: str, time: float) -> tuple[float, float, float]:
    """Place and heading of a vehicle at a moment of the clock [m, rad]."""
    track = run.paths[name]
    at = int(np.searchsorted(track.time, time, side="right")) - 1
    return float(track.x[at]), float(track.y[at]), float(track.heading[at])


def _stop_at(run: Run, name: str, time: float, metre: float) -> Stop:
    x, y, heading = stop_of(run, name, time)
    outline = run.scene.movers[name].outline
    corners: list[Place] = []
    if outline is not None:
        c, s = math.cos(heading), math.sin(heading)
        corners = [
            ((x + c * forward - s * left) * metre, (y + s * forward + c * left) * metre)
            for forward, left in from_the_front(outline).tolist()
        ]
    place, tyres = (x * metre, y * metre), run.scene.movers[name].tyres
    if tyres is None:
        return Stop(place, corners, None)
    return Stop(place, corners, (place, float(tyres.wheelbase) * metre, float(tyres.track) * metre))


def rests_at(run: Run, name: str) -> bool:
    """Whether a vehicle comes to rest."""
    try:
        _ = run.rest[name]
    except CollisionsError:
        return False
    return True


def _stops(run: Run, name: str, index: int, drawing: Drawing, labels: Units) -> None:
    """The outlines of one vehicle at the start, at its contacts and at rest, with what they are."""
    metre, colour = labels.factor("m"), COLOURS[index % len(COLOURS)]
    axes, body, room = drawing.axes, run.scene.movers[name].vehicle, _ROOM * metre
    times = [time for time, pair in zip(run.times, run.pairs, strict=True) if name in pair]
    start, last = _stop_at(run, name, 0.0, metre), _stop_at(run, name, math.inf, metre)
    moves = math.dist(start.place, last.place) > 0.02 * metre or start.corners != last.corners
    for stop in (_stop_at(run, name, time, metre) for time in times if time > 0.0):
        _outline(drawing, stop, colour, f"{name}.contact", 0.0, 0.8, room, metre)
    if moves:
        _outline(drawing, start, colour, f"{name}.start", 0.0, 1.2, room, metre, dashed=True)
    _outline(drawing, last, colour, f"{name}.rest", 0.16, 1.4, room, metre)
    if last.corners:
        drawing.area(index, last.corners)
    short = in_lines(name)
    back = start.place[0] - last.place[0], start.place[1] - last.place[1]
    if moves or body.speed:
        speed = labels.text(body.speed, "m/s") if body.speed else "standing"
        drawing.label(
            start.place,
            f"{short} at the start,\n{speed}",
            back if moves else (0.0, -1.0),
            colour,
        )
    what = "at rest" if rests_at(run, name) else "moves on"
    drawing.label(last.place, f"{short} {what}", (-back[0], -back[1]), colour, of=index)
    axes.plot(*start.place, "o", ms=4, mfc=colour, mec=colour, zorder=6, gid=f"{name}.start centre")
    axes.plot(
        *last.place,
        "s",
        ms=6,
        mfc="white",
        mec=colour,
        mew=1.8,
        zorder=7,
        gid=f"{name}.rest centre",
    )


def _outline(
    drawing: Drawing,
    stop: Stop,
    colour: str,
    gid: str,
    filled: float,
    width: float,
    room: float,
    metre: float,
    dashed: bool = False,
) -> None:
    """The vehicle of an outline with its front, or room for a vehicle that has none."""
    if not stop.corners:
        drawing.include(*(beside(stop.place, (side, side), room) for side in (-1.0, 1.0)))
        return
    drawing.include(*stop.corners)
    draw_body(
        drawing.axes,
        stop.corners,
        gid,
        colour,
        metre=metre,
        filled=filled,
        width=width,
        dashed=dashed,
        wheels=stop.wheels,
        above=4.0,
    )


def _surfaces(run: Run, drawing: Drawing, labels: Units) -> None:
    """The areas of another friction, hatched in grey, each with its friction."""
    metre = labels.factor("m")
    for number, (corners, friction) in enumerate(run.scene.surfaces):
        places = [(float(x) * metre, float(y) * metre) for x, y in np.asarray(corners).tolist()]
        drawing.axes.fill(
            *zip(*places, strict=True),
            fc="#f1f1f1", ec="#c4c4c4", hatch="..", lw=0.8, zorder=0, gid=f"surface.{number}",
        )  # fmt: skip
        middle = np.mean(places, axis=0)
        drawing.include((float(middle[0]), float(middle[1])))
        drawing.label(
            (float(middle[0]), float(middle[1])), f"friction {float(friction):.3g}", colour=GREY
        )


def _scale_bar(axes: Axes, labels: Units) -> None:
    """A bar of 1, 2 or 5 times a power of ten of the unit, at the lower left."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    most = _BAR * (right - left)
    power = 10.0 ** math.floor(math.log10(most))
    length = next(power * step for step in (5.0, 2.0, 1.0) if power * step <= most)
    x, y = left + 0.03 * (right - left), low + 0.035 * (high - low)
    tall = 0.008 * (high - low)
    axes.plot(
        [x, x, x, x + length, x + length, x + length],
        [y + tall, y - tall, y, y, y - tall, y + tall],
        color=INK, lw=1.8, solid_capstyle="butt", solid_joinstyle="miter", zorder=9, gid="scale",
    )  # fmt: skip
    axes.annotate(
        f"{length:g} {labels.name('m')}", (x + 0.5 * length, y), (0, 5),
        textcoords="offset points", ha="center", va="bottom", fontsize=9, color=INK, zorder=9,
    )  # fmt: skip
