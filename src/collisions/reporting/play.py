"""``play``: one HTML page that plays a scene, with the numbers of the run at every moment."""

from __future__ import annotations

import json
import math
from html import escape
from itertools import repeat
from pathlib import Path
from typing import Any

import numpy as np

from ..messages.hints import hinted
from ..plot.canvas import SMALLEST
from ..plot.run import tracks_of
from ..quantities.document import Document
from ..quantities.formatting import UnitSystem, decimals_of, typeset
from ..quantities.printed_tables import html_row
from ..quantities.tables import Cells, as_sentence, cells, given_texts, label_of
from ..quantities.user_text import plain
from ..scene.frames import Frames, frames_of
from ..scene.marks import drawn
from ..scene.mover import Mover
from ..scene.picture import COLOURS, DASHES, bar_of, from_the_front, place_of, view_of
from ..scene.run import Run, Track

_PAGE = Path(__file__).with_name("play.html")
_STATE = ("x", "y", "heading", "vx", "vy", "yaw_rate")
# What the table of states has, by the names that the script fills in, with the kinds of quantity.
_SHOWN = {"speed": "speed", "yaw": "yaw rate", "x": "length", "y": "length", "heading": "angle"}
# The least height of the view, as a share of its width, and the other way round.
_FLAT = 0.56
_LIMITS = "What this scene does not describe, and what limits the answer:"
# As a share of the larger extent of the view: the longest arrow.
_ARROW = 0.16


@hinted
def play(run: Run, *, units: UnitSystem | None = None) -> Document:
    """One offline HTML page that plays a scene: a slider of time, and a button that moves it.

    At every moment it has the outlines, the tracks and tyre marks so far, the velocities, and a
    table with speed, yaw rate, place and heading; below it the speeds over time. The findings of
    the run, such as that two vehicles are followed through each other, stand in a list, and are
    said when their time comes. The numbers are those of the run, written into the page in equal
    steps of time, with each contact twice, before and after; one that is followed in time begins
    then, and passes in the steps that follow. The browser only draws them. The page loads nothing
    from outside, and works by keyboard and with screen readers.

    Parameters
    ----------
    run : scene.Run
        A scene as it went, of one case.
    units : {"si", "metric", "us"}, optional
        Units of the page; by default those that the inputs were given in, where they agree, else
        SI.

    Returns
    -------
    Document
        The page, a ``str`` that a notebook shows and that ``.save("crash.html")`` writes to a file.

    Raises
    ------
    InputError
        Anything but one run, or numbers that cannot be drawn.
    ShapeError
        A batch: play one case of it.
    MissingInputError
        A vehicle without x, y or heading.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions.scene import Contact, Mover, Scene
    >>> a = col.Vehicle(mass=1500, yaw_inertia=2600, vx="60 km/h", x=-2.2, y=0, heading=0)
    >>> b = col.Vehicle(mass=1200, yaw_inertia=2000, x=2.2, y=0, heading=0)
    >>> crash = Scene(
    ...     movers={"Golf": Mover(a, drag=0.7), "Polo": Mover(b, drag=0.7)},
    ...     contacts=[Contact("Golf", "Polo", restitution=0.1, normal=0, point=(0, 0), friction=0)],
    ... )
    >>> page = col.play(crash.run())
    >>> page[:15], page.count('type="range"')
    ('<!DOCTYPE html>', 1)
    """
    system = cells(units, given_texts(run) if isinstance(run, Run) else ())
    tracks = tracks_of(run, "collisions.play")
    return Document(_written(run, tracks, frames_of(run), system), "html")


def _written(run: Run, tracks: dict[str, Track], frames: Frames, system: Cells) -> str:
    """The page: the numbers of every moment as JSON, and what they are called."""
    from .. import __version__

    names = {name: plain(name) for name in tracks}
    units = {
        kind: {
            "unit": typeset(of.label(kind)),
            "scale": of.scale(kind),
            "decimals": decimals_of(kind, of.name),
        }
        for kind in ("speed", "yaw rate", "length", "angle")
        # In degrees in every system, as in every table.
        for of in [Cells("metric") if kind in ("yaw rate", "angle") else system]
    }
    view = view_of(run, frames, _FLAT)
    extent = max(view[2:])
    speeds = [np.hypot(state[3], state[4]).max() for state in frames.states.values()]
    fastest = max(max(map(float, speeds)), SMALLEST)
    contacts = [
        {
            "time": run.times[number],
            "after": frames.after[number],
            "place": place_of(run, number, frames),
            "said": _said(run, number, names, system),
        }
        for number in range(len(run.impacts))
    ]
    findings = [
        {
            "time": one.time,
            "after": _moment(frames, one.time),
            "said": plain(f"{as_sentence(label_of(one.code))[:-1]}: {as_sentence(one.sentence)}"),
        }
        for one in run._findings_in(system.name)
    ]
    data = {
        "units": units,
        "times": frames.times.tolist(),
        "movers": [
            {
                "name": names[name],
                "label": escape(names[name]),
                "colour": COLOURS[index % len(COLOURS)],
                "dash": DASHES[index % len(DASHES)],
                "outline": _outline(run.scene.movers[name]),
                "marks": _marks(run, name),
                "speed": np.hypot(*frames.states[name][3:5]).tolist(),
                **{
                    part: row.tolist()
                    for part, row in zip(_STATE, frames.states[name], strict=True)
                },
            }
            for index, name in enumerate(tracks)
        ],
        "contacts": contacts,
        "findings": findings,
        "surfaces": [
            {"corners": np.asarray(corners).tolist(), "friction": f"{float(friction):.3g}"}
            for corners, friction in run.scene.surfaces
        ],
        "view": view,
        "bar": bar_of(extent, system),
        "arrow": {"scale": _ARROW * extent / fastest},
        "caption": _caption(run, fastest, system),
    }
    buttons = "\n".join(
        f'<button type="button" id="contact-{number}" data-frame="{frames.after[number]}">'
        f"Contact {number + 1}: {escape(' and '.join(names[name] for name in pair))}</button>"
        for number, pair in enumerate(run.pairs)
    )
    listed = "\n".join(
        f'<li id="finding-{number}"><button type="button" data-frame="{one["after"]}">'
        f"{one['time']:.2f} s</button> {escape(str(one['said']))}</li>"
        for number, one in enumerate(findings)
    )
    # The script fills them in.
    rows = "\n".join(
        html_row(
            name,
            *repeat("", len(_SHOWN)),
            of_head=f' scope="row" style="color:{COLOURS[index % len(COLOURS)]}"',
            of_cells=(f' id="{index}.{part}" data-kind="{kind}"' for part, kind in _SHOWN.items()),
        )
        for index, name in enumerate(names.values())
    )
    text = _PAGE.read_text(encoding="utf-8")
    for name, part in {
        "title": escape(f"The crash of {', '.join(names.values())}"),
        "last": str(len(frames.times) - 1),
        "contacts": buttons,
        "findings": f'<p id="limits">{_LIMITS}</p>\n<ul>\n{listed}\n</ul>' if listed else "",
        "rows": rows,
        "version": __version__,
        "data": json.dumps(data, allow_nan=False).replace("<", "\\u003c"),
    }.items():
        text = text.replace(f"<!--{name}-->", part)
    return text


def _moment(frames: Frames, time: float) -> int:
    """The first moment that is not before a time; at a contact the one after it."""
    at = int(np.searchsorted(frames.times, time))
    if at < len(frames.times) and frames.times[at] == time:
        at = int(np.searchsorted(frames.times, time, side="right")) - 1
    return min(at, len(frames.times) - 1)


def _outline(mover: Mover) -> list[list[float]] | None:
    """The corners (forward, left) [m], from the front edge on."""
    if mover.outline is None:
        return None
    found: list[list[float]] = from_the_front(mover.outline).tolist()
    return found


def _marks(run: Run, name: str) -> list[dict[str, Any]]:
    """The marks by wheel, with the time at which each place was passed; None between stretches."""
    return [
        {"t": time.tolist()}
        | {
            axis: [one if math.isfinite(one) else None for one in places.tolist()]
            for axis, places in (("x", x), ("y", y))
        }
        for time, x, y in drawn(run, name).values()
    ]


def _said(run: Run, number: int, names: dict[str, str], system: Cells) -> str:
    """One sentence about an impact."""
    impact = run.impacts[number]
    each = [
        f"delta-V of {names[name]} {typeset(system.text(side.delta_v, 'm/s'))}"
        for name, side in zip(run.pairs[number], (impact.a, impact.b), strict=True)
    ]
    closing = typeset(system.text(impact.closing_speed, "m/s"))
    pair = " and ".join(names[name] for name in run.pairs[number])
    return (
        f"Contact {number + 1}, {pair} at {run.times[number]:.2f} s: closing speed {closing}, "
        f"{', '.join(each)}."
    )


def _caption(run: Run, fastest: float, system: Cells) -> str:
    marks = any(mover.tyres is not None for mover in run.scene.movers.values())
    unsized = [plain(name) for name, one in run.scene.movers.items() if one.outline is None]
    speed = typeset(system.text(fastest, "m/s"))
    return (
        "Dashed outlines: the start. Heavy edges: fronts. Arrows: velocities, the longest "
        f"{speed}." + " Grey lines: tyre marks so far." * marks
        + (f" Without an outline: {', '.join(unsized)}." if unsized else "")
    )  # fmt: skip
