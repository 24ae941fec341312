"""The scene from above: vehicles, velocities, the contact with its normal and tangent, and the impulse."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..impact import Impact
from ..outlines import placed, read_outline
from ..reading import ArgumentReader
from ..side import Side
from ..unit_systems import UnitSystem
from ..units import shown
from ..vehicle import Vehicle, missing
from .canvas import COLOURS, FORCE, GREY, INK, LARGEST, SIDES, THIN, Units, answered, begin, tidy, who
from .drawing import Drawing, Place
from .lanes import APART, Lanes, beside

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MOMENTS = {"before": ("before",), "after": ("after",), "both": ("before", "after")}
_TITLES = {
    "before": "Before the impact",
    "after": "After the impact, at the place of it",
    "both": "Velocities before (dashed, arriving) and after (solid, leaving)",
}
_RESOLVED = 1e-12  # of the coordinates: a picture smaller than this is made of their rounding
_NOTHING = 1e-9  # of the impulse: what rounding leaves of none
_SKETCHED = 2.5  # metres from the contact to a centre that has no position


def scene(
    impact: Impact,
    *,
    moment: str = "both",
    outline_a: Any = None,
    outline_b: Any = None,
    axes: Axes | None = None,
    units: UnitSystem = "si",
) -> Axes:
    """The scene from above at the moment of impact, to scale.

    Velocities before point to the centre of mass, those after away from it; the vehicles stand where they were, because an
    impulse takes no time. The impulse acts at the contact point, in a central impact at the centres of mass; that of a pivot on
    its vehicle acts at the pivot. Arrows that would hide each other, as those of an in-line impact, are drawn side by side,
    which is said below the picture. The scales of the arrows are stated below the picture. Positions that a central model has
    no need of are never made up: without them the picture is a sketch, and says so.

    Parameters
    ----------
    impact : Impact
        A single one of any solver.
    moment : "before", "after" or "both"
        Whose velocities are drawn; the impulse is left out before.
    outline_a, outline_b : tuple or corners [m], optional
        As for ``diagnose``: (length, width), (length, width, how far the centre of mass is ahead of the middle), or convex
        corners (forward, left). Without it only the centre of mass is marked.
    axes : matplotlib.axes.Axes, optional
        To draw on; by default that of a new figure.
    units : "si", "metric" or "us"
        m/s, m and N s; km/h, m and kN s; mph, ft and lbf s.

    Returns
    -------
    matplotlib.axes.Axes
        Arrows by gid: "a.before", "a.after", "b.before", "b.after", "normal", "tangent", "impulse.a", "impulse.b",
        "pivot_impulse.a", "pivot_impulse.b"; and "a.centre", "b.centre", "a.outline", "b.outline", "a.wall", "b.wall",
        "a.pivot", "b.pivot", "contact".

    Raises
    ------
    InputError
        Not a single answered impact, or an option that is not known.
    MissingInputError
        An outline for a vehicle without position or heading; or matplotlib is missing.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions import plot
    >>> a = col.Vehicle(mass=1500, yaw_inertia=2600, vx="60 km/h", x=-2.2, y=0, heading=0)
    >>> b = col.Vehicle(mass=1200, yaw_inertia=2000, x=0.9, y=-0.8, heading="90 deg")
    >>> impact = col.eccentric(a, b, 0.1, normal=0, point=(0, 0), friction=0.5)
    >>> axes = plot.scene(impact, outline_a=(4.4, 1.8), outline_b=("14 ft", "1.75 m"), units="us")
    >>> axes.get_ylabel()
    'y [ft]'
    """
    labels = Units(units)
    if not isinstance(moment, str) or moment not in _MOMENTS:
        raise InputError(
            f"moment must be 'before', 'after' or 'both', got {shown(moment)}", code="bad_option", argument="moment"
        )
    impact = answered(impact, "scene")
    sides = impact.a, impact.b
    corners = [
        _corners(side.before, outline, f"outline_{letter}", letter)
        for side, outline, letter in zip(sides, (outline_a, outline_b), SIDES, strict=True)
    ]
    centres, contact, sketched = _places(impact)
    if sketched and any(corners):
        lacking = next(i for i, side in enumerate(sides) if side.before.x is None or side.before.y is None)
        name = "x" if sides[lacking].before.x is None else "y"
        raise missing(sides[lacking].before, name, "a picture with an outline", SIDES[lacking])
    length = labels.factor("m")

    def scaled(place: Place) -> Place:
        return place[0] * length, place[1] * length

    axes = begin(axes, (7.5, 6.5))
    drawing = Drawing(axes)
    known = [scaled(place) for place in centres if place is not None]
    known += [scaled(corner) for rectangle in corners for corner in rectangle]
    known += [scaled(side.before.pivot) for side in sides if side.before.pivot is not None]
    known.append(scaled(contact))
    size = max(max(place[i] for place in known) - min(place[i] for place in known) for i in (0, 1))
    farthest = max(abs(part) for place in known for part in place)
    if max(size, 4.0 * length) < _RESOLVED * farthest or size > LARGEST:
        raise InputError(
            f"there is no picture of {labels.text(size / length, 'm')} that lies {labels.text(farthest / length, 'm')} from "
            f"the origin of its coordinates; count x and y from a place near the contact, and check positions and outlines",
            code="out_of_range",
            argument="impact",
        )
    # Where all is in one place, or as good as, nothing tells the size of the bodies.
    if sketched or size <= 1e-6 * farthest:
        size = max(size, 4.0 * length)
    drawing.include(*known)

    n, at = impact.normal, scaled(contact)
    speed_scale = _scale([state.speed for side in sides for state in _states(side, moment)], labels.factor("m/s"), 0.55 * size)
    impulse = math.hypot(impact.normal_impulse, impact.tangential_impulse)
    pulls = [math.hypot(side.pivot_impulse_x, side.pivot_impulse_y) for side in sides]
    impulse_scale = _scale([impulse, *pulls], labels.factor("N*s"), 0.3 * size) if moment != "before" else 0.0
    for index, side in enumerate(sides):
        place = centres[index]
        if place is None:
            _draw_wall(drawing, at, n, index, size, side)
        else:
            _draw_body(drawing, scaled(place), index, side, [scaled(corner) for corner in corners[index]], labels)
        if side.before.pivot is not None:
            pin = scaled(side.before.pivot)
            axes.plot(*pin, "^", ms=10, mfc="white", mec=COLOURS[index], mew=1.6, zorder=5, gid=f"{SIDES[index]}.pivot")
            drawing.avoid(pin, pin)
            drawing.label(pin, f"pivot of {'AB'[index]}", (0.0, -1.0), COLOURS[index], of=index)
    wheres = [at if place is None else scaled(place) for place in centres]
    lanes = Lanes(size)
    for when in _MOMENTS[moment]:
        for index, side in enumerate(sides):
            if speed_scale:
                share = labels.factor("m/s") / speed_scale
                _draw_velocity(drawing, wheres[index], index, getattr(side, when), when, labels, share, lanes)
    if impulse_scale:
        share = labels.factor("N*s") / impulse_scale
        starts = [at if impact.point is not None or place is None else scaled(place) for place in centres]
        arrows: list[tuple[Place, Place]] = [
            (start, (float(side.impulse_x) * share, float(side.impulse_y) * share))
            for start, side in zip(starts, sides, strict=True)
        ]
        # Both the same way, so that they still are seen to be equal and opposite.
        for index, (start, vector) in enumerate(lanes.free(arrows)):
            tip = start[0] + vector[0], start[1] + vector[1]
            drawing.arrow(start, tip, f"impulse.{SIDES[index]}", colour=FORCE, width=2.6)
            drawing.label(tip, f"impulse on {'AB'[index]}\n{labels.text(impulse, 'N*s')}", vector, FORCE, of=index)
        for index, side in enumerate(sides):
            if pulls[index] > _NOTHING * impulse and side.before.pivot is not None:
                pull = float(side.pivot_impulse_x) * share, float(side.pivot_impulse_y) * share
                ((start, pull),) = lanes.free([(scaled(side.before.pivot), pull)])
                tip = beside(start, pull, 1.0)
                drawing.arrow(start, tip, f"pivot_impulse.{SIDES[index]}", colour=FORCE, width=1.6)
                told = f"impulse of the pivot on {'AB'[index]}\n{labels.text(pulls[index], 'N*s')}"
                drawing.label(tip, told, pull, FORCE, of=index)
    _draw_frame(drawing, at, n, lanes, marked=impact.point is not None)

    scales = [("velocities", speed_scale, "m/s"), ("impulses", impulse_scale, "N*s")]
    step = labels.name("m")
    told = "; ".join(
        f"{what}: 1 {step} = {f'{scale:,g}'.replace(',', THIN)} {labels.name(unit)}" for what, scale, unit in scales if scale
    )
    note = "not all positions given: a sketch, places not to scale\n" if sketched else ""
    note += "arrows that would hide each other are drawn side by side\n" if lanes.moved else ""
    axes.set_xlabel(f"{labels.label('x', 'm')}\n{note}{told and f'arrows: {told}'}".rstrip())
    axes.set_ylabel(labels.label("y", "m"))
    axes.set_title(_TITLES[moment], fontsize=10.5)
    if sketched:
        axes.set(xticks=[], yticks=[])
    # Coordinates of a national grid have seven digits before the point, and all of them count.
    tidy(axes, (-3, 8))
    drawing.finish()
    return axes


def _states(side: Side, moment: str) -> list[Vehicle]:
    return [getattr(side, when) for when in _MOMENTS[moment]]


def _places(impact: Impact) -> tuple[list[Place | None], Place, bool]:
    """Both centres of mass, None for what only its contact is known of; the contact; and whether they are only a sketch."""
    states = impact.a.before, impact.b.before
    given: list[Place | None] = [
        None if state.x is None or state.y is None else (float(state.x), float(state.y)) for state in states
    ]
    if impact.point is not None:
        return given, (float(impact.point[0]), float(impact.point[1])), False
    one, other = given
    if one is not None and other is not None:
        return given, (0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])), False
    nx, ny = impact.normal
    sketch: list[Place | None] = [
        None if math.isinf(state.mass) else (far * nx, far * ny)
        for state, far in zip(states, (-_SKETCHED, _SKETCHED), strict=True)
    ]
    return sketch, (0.0, 0.0), True


def _corners(vehicle: Vehicle, outline: Any, name: str, letter: str) -> list[Place]:
    """The outline of a vehicle in the scene, from its front edge on; empty without one."""
    if outline is None:
        return []
    reader = ArgumentReader()
    read = read_outline(reader, outline, name)
    reader.close()
    forward = read[:, 0] + np.roll(read[:, 0], -1)
    x, y, corners = placed(np.roll(read, -int(np.argmax(forward)), axis=0), vehicle, letter)
    return [(x + float(ahead), y + float(left)) for ahead, left in corners]


def _scale(values: list[float], factor: float, reach: float) -> float:
    """How much one unit of length stands for: 1, 2 or 5 times a power of ten, so that the longest stays within the reach."""
    largest = max(values) * factor
    if largest == 0.0:
        return 0.0
    least = largest / reach
    power = 10.0 ** math.floor(math.log10(least))
    return next(power * step for step in (1.0, 2.0, 5.0, 10.0) if power * step >= least)


def _draw_frame(drawing: Drawing, at: Place, n: Place, lanes: Lanes, marked: bool) -> None:
    """The line of impact, the normal and the tangent, and the contact point where the model has one."""
    t, size = (-n[1], n[0]), lanes.size
    # Through both centres of mass where these lie on it.
    for vector, reach, name in ((n, 0.42 if marked else 0.62, "normal"), (t, 0.28, "tangent")):
        while lanes.hides(beside(at, vector, reach * size), (0.06 * size * vector[0], 0.06 * size * vector[1])):
            reach += APART
        tip = at[0] + reach * size * vector[0], at[1] + reach * size * vector[1]
        tail = at[0] - reach * size * vector[0], at[1] - reach * size * vector[1]
        drawing.line(
            tail, tip, f"line of the {name}", color=GREY, lw=0.9, ls=(0, (6, 3)) if name == "normal" else ":", zorder=1
        )
        head = at[0] + (reach + 0.06) * size * vector[0], at[1] + (reach + 0.06) * size * vector[1]
        drawing.arrow(tip, head, name, colour=GREY, width=1.2)
        drawing.label(head, f"{name[0]} ({name})", vector, INK)
    if marked:
        drawing.axes.plot(*at, "X", ms=9, mfc=INK, mec="white", zorder=7, gid="contact")
        drawing.label(at, "contact", (-n[0] - t[0], -n[1] - t[1]))


def _draw_wall(drawing: Drawing, at: Place, n: Place, index: int, size: float, side: Side) -> None:
    """A body without a place is met along the tangent: a hatched edge."""
    away = 1.0 if index else -1.0
    along = -n[1] * 0.32 * size, n[0] * 0.32 * size
    deep = away * 0.05 * size * n[0], away * 0.05 * size * n[1]
    one, other = (at[0] - along[0], at[1] - along[1]), (at[0] + along[0], at[1] + along[1])
    drawing.axes.fill(
        [one[0], other[0], other[0] + deep[0], one[0] + deep[0]],
        [one[1], other[1], other[1] + deep[1], one[1] + deep[1]],
        fc="white", ec=COLOURS[index], hatch="////", lw=1.2, zorder=1, gid=f"{SIDES[index]}.wall",
    )  # fmt: skip
    drawing.include(one, other)
    drawing.avoid(one, other)
    corner = one[0] + deep[0], one[1] + deep[1]
    drawing.label(corner, who(index, side.before), (away * n[0], away * n[1]), COLOURS[index], of=index)


def _draw_body(drawing: Drawing, place: Place, index: int, side: Side, corners: list[Place], labels: Units) -> None:
    letter, colour = SIDES[index], COLOURS[index]
    if corners:
        # The front edge is the heavy one.
        drawing.axes.fill(
            [x for x, _ in corners],
            [y for _, y in corners],
            fc=f"{colour}14",
            ec=colour,
            lw=1.4,
            zorder=2,
            gid=f"{letter}.outline",
        )
        drawing.area(index, corners)
        (x0, y0), (x1, y1) = corners[:2]
        drawing.axes.plot([x0, x1], [y0, y1], color=colour, lw=4, solid_capstyle="butt", zorder=3, gid=f"{letter}.front")
        for one, other in zip(corners, [*corners[1:], corners[0]], strict=True):
            drawing.avoid(one, other)
    marker = "os"[index]
    drawing.axes.plot(*place, marker, ms=7, mfc="white", mec=colour, mew=2.0, zorder=7, gid=f"{letter}.centre")
    drawing.avoid(place, place)
    drawing.label(place, who(index, side.before), (0.0, 1.0), colour, of=index)


def _draw_velocity(
    drawing: Drawing, place: Place, index: int, state: Vehicle, when: str, labels: Units, share: float, lanes: Lanes
) -> None:
    """The velocity before ends at the centre of mass, the one after starts there."""
    letter, colour = SIDES[index], COLOURS[index]
    text = f"{'AB'[index]} {when}: {labels.text(state.speed, 'm/s')}"
    if state.yaw_rate:
        text += f"\nyaw {labels.text(abs(state.yaw_rate), 'rad/s')} {'↺' if state.yaw_rate > 0.0 else '↻'}"
    vector = float(state.vx) * share, float(state.vy) * share
    start = (place[0] - vector[0], place[1] - vector[1]) if when == "before" else place
    ((start, vector),) = lanes.free([(start, vector)])
    tip = start[0] + vector[0], start[1] + vector[1]
    style: Any = (0, (4, 2)) if when == "before" else "-"
    drawing.arrow(start, tip, f"{letter}.{when}", colour=colour, style=style, width=2.0)
    away = (0.0, -1.0) if not state.speed else vector if when == "after" else (-vector[0], -vector[1])
    if state.speed or state.yaw_rate or not math.isinf(state.mass):
        drawing.label(start if when == "before" else tip, text, away, colour, of=index)
