"""The scene from above: vehicles, velocities, the contact with its normal and tangent, and the
impulse.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..impact.impact import Impact
from ..impact.reconstruction import Reconstruction, as_bound
from ..messages.errors import InputError
from ..messages.hints import hinted
from ..quantities.formatting import UnitSystem
from ..quantities.reading import ArgumentReader
from ..quantities.units import shown
from ..scene.run import Run
from ..vehicle.outlines import in_scene, read_outline
from ..vehicle.vehicle import Vehicle, error_of_missing
from .body import draw_body
from .canvas import (
    COLOURS,
    FORCE,
    GREY,
    INK,
    SIDES,
    THIN,
    Axes,
    Units,
    begin,
    check_impact,
    size_of,
    tidy,
    who,
)
from .drawing import APART, Drawing, Place, beside
from .run import draw_run

_MOMENTS = {"before": ("before",), "after": ("after",), "both": ("before", "after")}
_TITLES = {
    "before": "Before the impact",
    "after": "After the impact, at the place of it",
    "both": "Velocities before (dashed, arriving) and after (solid, leaving)",
}
_NOTHING = 1e-9  # of the impulse: a smaller one is rounding
_SKETCHED = 2.5  # metres from the contact to a centre that has no position


@hinted
def scene(
    impact: Impact | Run,
    *,
    moment: str = "both",
    outline_a: Any = None,
    outline_b: Any = None,
    axes: Axes | None = None,
    units: UnitSystem | None = None,
) -> Axes:
    """The scene from above, to scale: an impact at its moment, or a whole run.

    Of an impact:
    velocities before point to the centre of mass, those after point away from it; the vehicles stay
    where they were, because an impulse takes no time. The impulse acts at the contact point, or in
    a central impact at the centres of mass; that of a pivot on its vehicle acts at the pivot.
    Arrows that would hide each other, as in an in-line impact, are drawn side by side; a note below
    the picture says so, and the scales of the arrows are stated there too. Positions that a central
    model does not need are never made up: without them the picture is a sketch without a scale of
    length, and says so.

    Of a run: each vehicle at the start (dashed), at its contacts (thin) and at rest (filled), the
    heavy edge its front; the tracks of the centres of mass, the marks of sliding tyres in grey, the
    contacts by number, the surfaces of another friction, and a scale bar.

    Parameters
    ----------
    impact : Impact or scene.Run
        One case, of any solver; or a scene as it went.
    moment : "before", "after" or "both"
        Which velocities of an impact are drawn; "before" leaves out the impulse.
    outline_a, outline_b : tuple or corners [m], optional
        As for ``diagnose``: (length, width), (length, width, how far the centre of mass is ahead of
        the middle), or the corners (forward, left) of a convex outline. Without it only the centre
        of mass is marked. Those of a run are those of its movers. A rectangle of the size of a car,
        a truck or a motorcycle is drawn as one, within the thin line of the outline itself.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on; by default those of a new figure.
    units : "si", "metric" or "us", optional
        m/s, m and N·s; km/h, m and kN·s; mph, ft and lbf·s. By default those of the inputs, as for
        ``summary``.

    Returns
    -------
    matplotlib.axes.Axes
        Arrows by gid: "a.before", "a.after", "b.before", "b.after", "normal", "tangent",
        "impulse.a", "impulse.b", "pivot_impulse.a", "pivot_impulse.b"; and "a.centre", "b.centre",
        "a.outline", "b.outline", "a.wall", "b.wall", "a.pivot", "b.pivot", "contact". Of a run, by
        the name of the vehicle: "Civic.track", "Civic.mark" for each tyre that left one, and the
        outlines "Civic.start", "Civic.contact", "Civic.rest"; "contact.0" and so on, "surface.0"
        and so on, and "scale".

    Raises
    ------
    InputError
        An unknown option, or anything but one answered impact or run.
    MissingInputError
        A vehicle of a run without position or heading, or an outline for such a one; or matplotlib
        is missing.

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
    labels = Units(units, impact)
    if not isinstance(moment, str) or moment not in _MOMENTS:
        raise InputError(
            f"moment must be 'before', 'after' or 'both', got {shown(moment)}",
            code="bad_option",
            argument="moment",
        )
    if isinstance(impact, Run):
        _refuse_for_runs(moment, outline_a, outline_b)
        return draw_run(impact, axes, units)
    check_impact(impact, "scene", runs=True)
    sides = impact.a, impact.b
    corners = [
        corners_of(side.before, outline, f"outline_{letter}", letter)
        for side, outline, letter in zip(sides, (outline_a, outline_b), SIDES, strict=True)
    ]
    centres, contact, sketched = _places(impact)
    if sketched and any(corners):
        lacking = next(
            i for i, side in enumerate(sides) if side.before.x is None or side.before.y is None
        )
        name = "x" if sides[lacking].before.x is None else "y"
        raise error_of_missing(
            sides[lacking].before, name, "a picture with an outline", SIDES[lacking]
        )
    axes = begin(axes, (7.5, 6.5))
    picture = Picture(axes, labels)
    at, bodies = picture.scaled(contact), [place and picture.scaled(place) for place in centres]
    outlines = [[picture.scaled(corner) for corner in outline] for outline in corners]
    pins = [side.before.pivot and picture.scaled(side.before.pivot) for side in sides]
    known = [
        place for place in (*bodies, *outlines[0], *outlines[1], *pins, at) if place is not None
    ]
    picture.include(*known)
    picture.size = size = size_of(known, labels, sketched)

    for index, (side, place, pin) in enumerate(zip(sides, bodies, pins, strict=True)):
        if place is None:
            picture.wall(at, impact.normal, index, side.before)
        else:
            picture.body(place, index, who(index, side.before), outlines[index])
        if pin is not None:
            picture.pivot(pin, index)
    moments = _MOMENTS[moment]
    speeds = [getattr(side, when).speed for side in sides for when in moments]
    speed_scale = _scale(speeds, labels.factor("m/s"), 0.55 * size)
    for when in moments if speed_scale else ():
        for index, side in enumerate(sides):
            picture.velocity(
                bodies[index] or at,
                index,
                getattr(side, when),
                when,
                labels.factor("m/s") / speed_scale,
                impact.reconstruction,
            )
    starts = [at if impact.point is not None or place is None else place for place in bodies]
    impulse_scale = picture.impulses(impact, starts, pins) if moment != "before" else 0.0
    picture.frame(at, impact.normal, marked=impact.point is not None)

    scales = [("velocities", speed_scale, "m/s"), ("impulses", impulse_scale, "N*s")]
    # A sketch has no scale of length, in which an arrow could be measured.
    stated = "; ".join(
        f"one scale for all {what}"
        if sketched
        else f"1 {labels.name('m')} = {f'{scale:,g}'.replace(',', THIN)} {labels.name(unit)} for "
        f"{what}"
        for what, scale, unit in scales
        if scale
    )
    note = "not all positions given: a sketch, places not to scale\n" if sketched else ""
    note += "arrows that would hide each other are drawn side by side\n" if picture.moved else ""
    x, y = (name if sketched else labels.label(name, "m") for name in "xy")
    axes.set(xlabel=f"{x}\n{note}{stated and f'arrows: {stated}'}".rstrip(), ylabel=y)
    axes.set_title(_TITLES[moment], fontsize=10.5)
    if sketched:
        axes.set(xticks=[], yticks=[])
    # Coordinates of a national grid have seven digits before the point, and all of them count.
    tidy(axes, (-3, 8))
    picture.finish()
    return axes


def _refuse_for_runs(moment: str, outline_a: Any, outline_b: Any) -> None:
    """Refuse the options that are for one impact."""
    given = {"outline_a": outline_a, "outline_b": outline_b}
    for name in (name for name, outline in given.items() if outline is not None):
        raise InputError(
            f"{name} is for an Impact; the vehicles of a run have the outlines of their movers: "
            "write Mover(vehicle, outline=...)",
            code="bad_option",
            argument=name,
        )
    if moment != "both":
        raise InputError(
            "moment is for an Impact, and a run is drawn from the start to rest; write "
            f"plot.scene(run.impacts[0], moment={moment!r}) for one of its impacts",
            code="bad_option",
            argument="moment",
        )


def _places(impact: Impact) -> tuple[list[Place | None], Place, bool]:
    """Both centres of mass (None if unknown), the contact, and whether they are only a sketch."""
    states = impact.a.before, impact.b.before
    given: list[Place | None] = [
        None if state.x is None or state.y is None else (state.x, state.y) for state in states
    ]
    if impact.point is not None:
        return given, impact.point, False
    one, other = given
    if one is not None and other is not None:
        return given, (0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])), False
    nx, ny = impact.normal
    sketch: list[Place | None] = [
        None if math.isinf(state.mass) else (far * nx, far * ny)
        for state, far in zip(states, (-_SKETCHED, _SKETCHED), strict=True)
    ]
    return sketch, (0.0, 0.0), True


def corners_of(vehicle: Vehicle, outline: Any, name: str, letter: str) -> list[Place]:
    """The outline of a vehicle in the scene, from its front edge on; empty without one."""
    if outline is None:
        return []
    reader = ArgumentReader()
    read = read_outline(reader, outline, name)
    reader.close()
    forward = read[:, 0] + np.roll(read[:, 0], -1)
    x, y, corners = in_scene(np.roll(read, -int(np.argmax(forward)), axis=0), vehicle, letter)
    return [(x + float(ahead), y + float(left)) for ahead, left in corners]


def _scale(values: list[float], factor: float, most: float) -> float:
    """The magnitude per unit of length: 1, 2 or 5 times a power of ten, so that the longest is at
    most ``most``.
    """
    largest = max(values) * factor
    if largest == 0.0:
        return 0.0
    least = largest / most
    power = 10.0 ** math.floor(math.log10(least))
    return next(power * step for step in (1.0, 2.0, 5.0, 10.0) if power * step >= least)


class Picture(Drawing):
    """The parts of a scene, drawn in the units of its labels."""

    def __init__(self, axes: Axes, labels: Units) -> None:
        super().__init__(axes)
        self.labels = labels

    def scaled(self, place: Place) -> Place:
        """A place in metres in the unit of the axes."""
        return place[0] * self.labels.factor("m"), place[1] * self.labels.factor("m")

    def wall(self, at: Place, n: Place, index: int, vehicle: Vehicle) -> None:
        """Draw a body of unknown position as a hatched edge along the tangent."""
        away, size = 1.0 if index else -1.0, self.size
        along = -n[1] * 0.32 * size, n[0] * 0.32 * size
        deep = away * 0.05 * size * n[0], away * 0.05 * size * n[1]
        one, other = beside(at, along, -1.0), beside(at, along)
        edge = [one, other, beside(other, deep), beside(one, deep)]
        self.axes.fill(
            *zip(*edge, strict=True),
            fc="white", ec=COLOURS[index], hatch="////", lw=1.2, zorder=1,
            gid=f"{SIDES[index]}.wall",
        )  # fmt: skip
        self.include(one, other)
        self.label(
            edge[-1], who(index, vehicle), (away * n[0], away * n[1]), COLOURS[index], of=index
        )

    def body(self, place: Place, index: int, name: str, corners: list[Place]) -> None:
        """The centre of mass with its name, and the outline where it was given, its front edge the
        heavy one.
        """
        letter, colour = SIDES[index], COLOURS[index]
        if corners:
            self.outline(index, corners, f"{letter}.outline", 0.08)
            self.area(index, corners)
        self.axes.plot(
            *place,
            "os"[index],
            ms=7,
            mfc="white",
            mec=colour,
            mew=2.0,
            zorder=7,
            gid=f"{letter}.centre",
        )
        self.label(place, name, (0.0, 1.0), colour, of=index)

    def outline(
        self, index: int, corners: list[Place], gid: str, filled: float, width: float = 1.4
    ) -> None:
        """The vehicle of an outline, filled with this share of its colour, and its front."""
        self.include(*corners)
        draw_body(
            self.axes,
            corners,
            gid,
            COLOURS[index],
            metre=self.labels.factor("m"),
            filled=filled,
            width=width,
        )

    def pivot(self, pin: Place, index: int) -> None:
        """Where a body is pinned."""
        self.axes.plot(
            *pin,
            "^",
            ms=10,
            mfc="white",
            mec=COLOURS[index],
            mew=1.6,
            zorder=5,
            gid=f"{SIDES[index]}.pivot",
        )
        self.label(pin, f"pivot of {'AB'[index]}", (0.0, -1.0), COLOURS[index], of=index)

    def velocity(
        self,
        place: Place,
        index: int,
        state: Vehicle,
        when: str,
        share: float,
        origin: Reconstruction | None,
    ) -> None:
        """The velocity before ends at the centre of mass, the one after starts there."""
        speed = self.labels.text(state.speed, "m/s")
        speed = as_bound(origin, f"{SIDES[index]}.{when}.speed", speed)
        text = f"{'AB'[index]} {when}: {speed}"
        if state.yaw_rate:
            text += (
                f"\nyaw {self.labels.text(abs(state.yaw_rate), 'rad/s')} "
                f"{'↺' if state.yaw_rate > 0.0 else '↻'}"
            )
        before = when == "before"
        vector: Place = (state.vx * share, state.vy * share)
        ((start, vector),) = self.free([(beside(place, vector, -1.0) if before else place, vector)])
        tip = beside(start, vector)
        style: Any = (0, (4, 2)) if before else "-"
        self.arrow(
            start, tip, f"{SIDES[index]}.{when}", colour=COLOURS[index], style=style, width=2.0
        )
        away = (0.0, -1.0) if not state.speed else (-vector[0], -vector[1]) if before else vector
        if state.speed or state.yaw_rate or not math.isinf(state.mass):
            self.label(start if before else tip, text, away, COLOURS[index], of=index)

    def impulses(self, impact: Impact, starts: list[Place], pins: list[Place | None]) -> float:
        """Draw the impulse on both from these places, and that of each pivot; gives how much one
        unit of length stands for.
        """
        sides = impact.a, impact.b
        impulse = math.hypot(impact.normal_impulse, impact.tangential_impulse)
        pulls = [math.hypot(side.pivot_impulse_x, side.pivot_impulse_y) for side in sides]
        factor = self.labels.factor("N*s")
        scale = _scale([impulse, *pulls], factor, 0.3 * self.size)
        if not scale:
            return 0.0
        share = factor / scale
        vectors = [(side.impulse_x * share, side.impulse_y * share) for side in sides]
        # Both are scaled alike, so that they are still seen to be equal and opposite.
        for index, (start, vector) in enumerate(self.free(list(zip(starts, vectors, strict=True)))):
            text = f"impulse on {'AB'[index]}\n{self.labels.text(impulse, 'N*s')}"
            self._impulse(start, vector, f"impulse.{SIDES[index]}", text, index, 2.6)
        for index, (side, pull, pin) in enumerate(zip(sides, pulls, pins, strict=True)):
            if pull > _NOTHING * impulse and pin is not None:
                vector = side.pivot_impulse_x * share, side.pivot_impulse_y * share
                ((start, vector),) = self.free([(pin, vector)])
                text = f"impulse of the pivot on {'AB'[index]}\n{self.labels.text(pull, 'N*s')}"
                self._impulse(start, vector, f"pivot_impulse.{SIDES[index]}", text, index, 1.6)
        return scale

    def _impulse(
        self, start: Place, vector: Place, gid: str, text: str, index: int, width: float
    ) -> None:
        tip = beside(start, vector)
        self.arrow(start, tip, gid, colour=FORCE, width=width)
        self.label(tip, text, vector, FORCE, of=index)

    def frame(self, at: Place, n: Place, marked: bool) -> None:
        """The line of impact, the normal and the tangent, and the contact point where the model has
        one.
        """
        t, size = (-n[1], n[0]), self.size
        styles: Any = (
            (n, 0.42 if marked else 0.62, "normal", (0, (6, 3))),
            (t, 0.28, "tangent", ":"),
        )
        # Through both centres of mass where these lie on it.
        for vector, out, name, style in styles:
            while self.hides(
                beside(at, vector, out * size), (0.06 * size * vector[0], 0.06 * size * vector[1])
            ):
                out += APART
            tip, tail, head = (beside(at, vector, far * size) for far in (out, -out, out + 0.06))
            self.line(tail, tip, f"line of the {name}", color=GREY, lw=0.9, ls=style, zorder=1)
            self.arrow(tip, head, name, colour=GREY, width=1.2)
            self.label(head, f"{name[0]} ({name})", vector, INK)
        if marked:
            self.axes.plot(*at, "X", ms=9, mfc=INK, mec="white", zorder=7, gid="contact")
            self.label(at, "contact", (-n[0] - t[0], -n[1] - t[1]))
