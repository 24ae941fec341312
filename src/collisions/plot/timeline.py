"""``timeline``: the speeds of all vehicles of a scene over time, with its contacts."""

from __future__ import annotations

import numpy as np

from ..messages.hints import hinted
from ..quantities.formatting import UnitSystem
from ..scene.picture import COLOURS
from ..scene.run import Run
from .canvas import GREY, INK, Axes, Units, begin, in_lines, legend_below, tidy
from .run import STYLES, contact_name, tracks_of

_ROOM = 0.13  # of the height, above the lines, for the contacts
# Points: the least gap between the names of two contacts, and how wide a letter is at most.
_GAP, _LETTER = 10.0, 5.6


@hinted
def timeline(run: Run, *, axes: Axes | None = None, units: UnitSystem | None = None) -> Axes:
    """The speeds of all vehicles of a scene over time, from the start to rest, with its contacts
    marked.

    A speed is that of the centre of mass. It jumps at a contact, since an impulse takes no time.

    Parameters
    ----------
    run : scene.Run
        A scene as it went, of one case.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on; by default those of a new figure.
    units : "si", "metric" or "us", optional
        m/s, km/h or mph. By default those of the inputs, as for ``summary``.

    Returns
    -------
    matplotlib.axes.Axes
        By gid: the speed of a vehicle by its name, such as "Civic.speed"; "contact.0" and so on.

    Raises
    ------
    InputError
        An unknown option, or anything but one run.
    ShapeError
        A batch: draw one case of it.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions import plot
    >>> from collisions.scene import Contact, Mover, Scene
    >>> a = col.Vehicle(mass=1500, yaw_inertia=2600, vx="60 km/h", x=-2.2, y=0, heading=0)
    >>> b = col.Vehicle(mass=1200, yaw_inertia=2000, x=2.2, y=0, heading=0)
    >>> crash = Scene(
    ...     movers={"Golf": Mover(a, drag=0.7), "Polo": Mover(b, drag=0.7)},
    ...     contacts=[Contact("Golf", "Polo", restitution=0.1, normal=0, point=(0, 0), friction=0)],
    ... )
    >>> axes = plot.timeline(crash.run(), units="metric")
    >>> axes.get_ylabel()
    'speed [km/h]'
    """
    labels, tracks = Units(units, run), tracks_of(run, "plot.timeline", placed=False)
    axes = begin(axes, (8.6, 4.6))
    factor = labels.factor("m/s")
    most, end = 0.0, 0.0
    for index, (name, track) in enumerate(tracks.items()):
        speed = np.hypot(track.vx, track.vy) * factor
        axes.plot(
            track.time, speed,
            color=COLOURS[index % len(COLOURS)], ls=STYLES[index % len(STYLES)], lw=1.9, zorder=3,
            label=in_lines(name), gid=f"{name}.speed",
        )  # fmt: skip
        most, end = max(most, float(speed.max())), max(end, float(track.time[-1]))
    top, last = (most or 1.0) * (1.0 + _ROOM), end or 1.0
    axes.set(xlim=(-0.02 * last, 1.04 * last), ylim=(0.0, top))
    second = axes.get_window_extent().width / axes.figure.dpi * 72.0 / (1.06 * last)
    rows: list[list[tuple[float, float]]] = []
    for number, (time, pair) in enumerate(zip(run.times, run.pairs, strict=True)):
        axes.axvline(time, color=GREY, lw=1.0, ls=":", zorder=2, gid=f"contact.{number}")
        text = f"{contact_name(number, pair)}, {time:.2f} s"
        wide = (_GAP + _LETTER * max(map(len, text.splitlines()))) / second
        # To the left of its line where it would end beyond the axes.
        side = -1.0 if time + wide > 1.04 * last and time > 0.5 * last else 1.0
        ends = sorted((time, time + side * wide))
        row = _row(rows, (ends[0], ends[1]), len(text.splitlines()))
        axes.annotate(
            text,
            (time, top), (side * 4, -2 - 13 * row), textcoords="offset points", va="top",
            ha="left" if side > 0.0 else "right", fontsize=9, color=INK, annotation_clip=False,
            parse_math=False, zorder=5, gid=f"contact.{number}.name",
            bbox={"boxstyle": "square,pad=0.1", "fc": "white", "ec": "none", "alpha": 0.8},
        )  # fmt: skip
    axes.set(xlabel=labels.label("time", "s"), ylabel=labels.label("speed", "m/s"))
    axes.set_title("Speeds from the start to rest, and the contacts", fontsize=10.5)
    tidy(axes)
    legend_below(axes, min(len(tracks), 4))
    return axes


def _row(rows: list[list[tuple[float, float]]], span: tuple[float, float], lines: int) -> int:
    """The first row from which so many lines have room for a name between these times; it is taken
    then.
    """

    def free(at: int) -> bool:
        return all(span[1] <= one or other <= span[0] for one, other in rows[at])

    row = 0
    while not all(free(at) for at in range(row, min(row + lines, len(rows)))):
        row += 1
    rows += [[] for _ in range(row + lines - len(rows))]
    for at in range(row, row + lines):
        rows[at].append(span)
    return row
