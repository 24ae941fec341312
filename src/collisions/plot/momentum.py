"""``momentum``: a diagram of the momenta before, the momenta after and their total,
head to tail.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from ..impact.impact import Impact
from ..impact.reconstruction import pushed_by_drag
from ..messages.errors import InputError
from ..messages.hints import hinted
from ..quantities.formatting import UnitSystem
from ..quantities.reading import need_one_case
from ..reconstruct import MomentumSolution
from .canvas import (
    COLOURS,
    FORCE,
    GREY,
    GRID,
    INK,
    SIDES,
    Axes,
    Units,
    begin,
    check_impact,
    check_size,
    in_lines,
    legend_below,
    tidy,
)
from .drawing import ALONG_ONE_LINE, Drawing, Place, beside, covers, cross

# Gap between momenta side by side, as a share of the longest: where all are, or where only some
# would hide each other.
_SIDE_BY_SIDE, _APART = 0.11, 0.04
_TRIED = 12
_NOTHING = 1e-9  # relative: a momentum or a speed this small is rounding
_TITLE = 60  # characters on one line


class _Body(NamedTuple):
    """One body: its name, whether its own momentum is drawn, its momenta in SI, and when it
    rests.
    """

    name: str
    takes_part: bool
    before: Place
    after: Place
    rests: set[str]


@hinted
def momentum(
    impact: Impact | MomentumSolution,
    *,
    axes: Axes | None = None,
    units: UnitSystem | None = None,
) -> Axes:
    """The momentum diagram: A and B before head to tail, A and B after head to tail, and their
    common total.

    Momenta along one line, as in a linear impact, are drawn side by side, because they would
    otherwise hide each other. What comes from outside, through a body of infinite mass, a pivot,
    tyres or a stated impulse, follows A and B before as an arrow of its own, and so ends where A
    and B after end; no total is drawn then. If A or B after would hide one of these arrows, both
    are drawn to one side, and thin lines join the points that coincide. A body of infinite mass
    has no momentum to draw.

    Parameters
    ----------
    impact : Impact or MomentumSolution
        One case, of any solver; of planar momentum the momenta of the centres of mass.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on; by default those of a new figure.
    units : "si", "metric" or "us", optional
        kg·m/s, kN·s or lbf·s.

    Returns
    -------
    matplotlib.axes.Axes
        Arrows by gid: "before.a", "before.b", "after.a", "after.b", and "total", or "outside" where
        something comes from outside. "begin" and "end" are the thin lines.

    Raises
    ------
    InputError
        An unknown option, two infinite masses, or anything but one answered impact.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    Example 2 of the paper:

    >>> import collisions as col
    >>> from collisions import plot
    >>> a, b = col.Vehicle(mass="1100 kg", vx="80 km/h"), col.Vehicle(mass="950 kg")
    >>> axes = plot.momentum(col.linear_central(a, b, restitution=0.398), units="metric")
    >>> axes.get_xlabel()
    'momentum along x [kN·s]'
    """
    labels = Units(units, impact)
    if isinstance(impact, MomentumSolution):
        bodies, by_whom = _of_solution(impact)
    else:
        bodies, by_whom = _of_impact(impact)
    takes_part = [body.takes_part for body in bodies]
    if not any(takes_part):
        raise InputError(
            "both vehicles have an infinite mass, so there is no momentum to draw",
            code="infinite_mass",
            argument="impact",
        )
    axes = begin(axes, (6.5, 6.2))
    factor = labels.factor("kg*m/s")
    chains = {
        when: [beside((0.0, 0.0), getattr(body, when), factor) for body in bodies]
        for when in ("before", "after")
    }
    totals = {when: beside(of_a, of_b) for when, (of_a, of_b) in chains.items()}
    outside = beside(totals["after"], totals["before"], -1.0)
    longest = max(
        math.hypot(*vector) for vector in (*chains["before"], *chains["after"], *totals.values())
    )
    open_ended = by_whom != ""

    drawing = Drawing(axes, longest)
    across = _common_normal([*chains["before"], *chains["after"]], longest)
    aside = (0.0, 0.0)
    if across is None and open_ended:
        aside = _aside(_chain((0.0, 0.0), [*chains["before"], outside]), chains["after"], longest)

    def draw(
        tail: Place,
        vector: Place,
        gid: str,
        tag: str,
        text: str,
        colour: str,
        style: Any,
        width: float = 2.0,
    ) -> None:
        length = math.hypot(*vector)
        if length <= _NOTHING * longest:
            return
        # To the right, seen along the arrow.
        side = (vector[1] / length, -vector[0] / length) if across is None else across
        start = (
            tail
            if across is None
            else beside(tail, across, -_SIDE_BY_SIDE * longest * len(drawing.arrows))
        )
        while across is None and drawing.covers(start, vector):
            start = beside(start, side, _APART * longest)
            drawing.moved = True
        drawing.arrow(start, beside(start, vector), gid, colour=colour, style=style, width=width)
        middle, *others = (
            beside(start, vector, share) for share in (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)
        )
        drawing.label(middle, tag, side, colour, *others)
        label = f"{tag}: {text} {labels.text(length / factor, 'kg*m/s')}"
        axes.plot([], [], color=colour, lw=width, ls=style, label=label)

    for when, style, prime in (("before", (0, (4, 1.5)), ""), ("after", "-", "\u2032")):
        tail: Place = (0.0, 0.0) if when == "before" else aside
        for index, vector in enumerate(chains[when]):
            tag = "AB"[index] + prime
            draw(tail, vector, f"{when}.{SIDES[index]}", tag, when, COLOURS[index], style)
            tail = beside(tail, vector)
            if takes_part[index] and math.hypot(*vector) <= _NOTHING * longest:
                still = when in bodies[index].rests
                axes.plot(
                    [],
                    [],
                    ls="none",
                    label=f"{tag}: {'at rest' if still else 'no momentum'} {when}",
                )
    if not open_ended:
        draw(
            (0.0, 0.0),
            totals["before"],
            "total",
            "total",
            "before and after",
            INK,
            (0, (1, 1.2)),
            1.6,
        )
    else:
        draw(
            totals["before"],
            outside,
            "outside",
            "outside",
            by_whom,
            FORCE,
            (0, (7, 2, 1, 2)),
        )

    if aside != (0.0, 0.0):
        for place, gid in (((0.0, 0.0), "begin"), (totals["after"], "end")):
            drawing.line(place, beside(place, aside), gid, color=GREY, lw=0.8, ls=":", zorder=1)
    drawing.include((0.0, 0.0))
    axes.plot([0.0], [0.0], "o", color=GREY, ms=4, zorder=3, gid="origin")
    axes.set(
        xlabel=labels.label("momentum along x", "kg*m/s"),
        ylabel=labels.label("momentum along y", "kg*m/s"),
    )
    for axis, along in ((axes.yaxis, (0.0, 1.0)), (axes.xaxis, (1.0, 0.0))):
        # Arrows along the other axis are drawn side by side, so distances along this one mean
        # nothing.
        axis.set_visible(across is None or math.dist(across, along) > ALONG_ONE_LINE)
    named = [
        in_lines(f"{letter}: {body.name}", _TITLE, 1)
        for letter, body in zip("AB", bodies, strict=True)
        if body.name not in ("", letter)
    ]
    together = ", ".join(named)
    title = [
        "Momenta before (dashed) and after (solid)",
        *([together] if 0 < len(together) <= _TITLE else named),
    ]
    if aside != (0.0, 0.0):
        title.append(
            "(those after are drawn side by side with those before;\nthin lines join what is one "
            "place)"
        )
    elif across is not None or drawing.moved:
        title.append("(momenta on one line are drawn side by side)")
    axes.set_title("\n".join(title), fontsize=10.5, parse_math=False)
    axes.grid(color=GRID, lw=0.6)
    axes.set_axisbelow(True)
    tidy(axes)
    legend_below(axes, 1 if open_ended else 2)
    drawing.finish()
    return axes


def _of_impact(impact: Impact) -> tuple[list[_Body], str]:
    """Both bodies of an impact, and a phrase that names what gives them momentum from outside."""
    check_impact(impact, "momentum")
    nothing = _NOTHING * impact.closing_speed
    bodies = []
    for side in (impact.a, impact.b):
        states = {"before": side.before, "after": side.after}
        rests = {
            when for when, state in states.items() if state.speed <= nothing and not state.yaw_rate
        }
        # Only the momentum that an infinite mass gives is drawn.
        before, after = (
            (0.0, 0.0) if math.isinf(state.mass) else beside((0.0, 0.0), state.momentum)
            for state in states.values()
        )
        takes_part = math.isfinite(side.before.mass)
        bodies.append(_Body(side.before.name, takes_part, before, after, rests))
    return bodies, _by_whom(impact)


def _of_solution(solution: MomentumSolution) -> tuple[list[_Body], str]:
    """Both bodies of planar momentum, which has no names, and what gives them momentum from
    outside.
    """
    need_one_case(solution, (MomentumSolution,), "plot.momentum")
    bodies = []
    for label in "ab":
        mass = getattr(solution, f"mass_{label}")
        check_size("mass", mass)
        found: list[Place] = []
        rests = set()
        for when, end in (("before", ""), ("after", "_after")):
            speed = getattr(solution, f"speed_{label}{end}")
            course = getattr(solution, f"course_{label}{end}")
            check_size("speed", speed)
            if speed == 0.0 or course is None:
                rests.add(when)
                found.append((0.0, 0.0))
            else:
                size = mass * speed
                found.append((size * math.cos(course), size * math.sin(course)))
        bodies.append(_Body("", True, found[0], found[1], rests))
    return bodies, _given_by(
        ["the tyres"] if solution.tyres else [],
        ["the impulse that was stated"] if solution.outside_impulse_x is not None else [],
    )


def _common_normal(vectors: list[Place], longest: float) -> Place | None:
    """The direction across the line all of them lie along; None if they do not."""
    chief = max(vectors, key=lambda vector: math.hypot(*vector))
    if longest == 0.0 or any(
        abs(cross(chief, v)) > ALONG_ONE_LINE * longest * math.hypot(*chief) for v in vectors
    ):
        return None
    length = math.hypot(*chief)
    across = -chief[1] / length, chief[0] / length
    return across if (across[1], across[0]) > (0.0, 0.0) else (-across[0], -across[1])


def _aside(drawn: list[tuple[Place, Place]], second: list[Place], longest: float) -> Place:
    """The offset of a chain of arrows from others at which none of it covers one of them."""
    chief = max(second, key=lambda vector: math.hypot(*vector))
    length = math.hypot(*chief)
    for step in range(_TRIED):
        far = (step + 1) // 2 * _SIDE_BY_SIDE * longest * (-1.0) ** step
        moved = (-far * chief[1] / length, far * chief[0] / length) if length else (0.0, 0.0)
        if not any(
            covers(*arrow, *other, longest) for arrow in _chain(moved, second) for other in drawn
        ):
            return moved
    return 0.0, 0.0


def _chain(start: Place, vectors: list[Place]) -> list[tuple[Place, Place]]:
    """Tail and vector of arrows head to tail; arrows of length 0 are left out."""
    found = []
    for vector in vectors:
        if vector != (0.0, 0.0):
            found.append((start, vector))
        start = beside(start, vector)
    return found


def _by_whom(impact: Impact) -> str:
    """A phrase naming the infinite masses, pivots, tyres and stated impulses that give momentum
    to the bodies drawn; "" if nothing does.
    """
    parts = []
    for index, side in enumerate((impact.a, impact.b)):
        if math.isinf(side.before.mass):
            parts.append(f"{'AB'[index]}, of infinite mass,")
        elif side.before.pivot is not None:
            parts.append(f"the pivot of {'AB'[index]}")
    sides = (impact.a, impact.b)
    pushed = any(side.outside_x or side.outside_y for side in sides)
    by_drag = pushed and pushed_by_drag(impact.reconstruction)
    return _given_by(
        parts,
        ["the tyres"] if by_drag or any(side.tyre_loss for side in sides) else [],
        ["the impulse that was stated"] if pushed and not by_drag else [],
    )


def _given_by(*parts: list[str]) -> str:
    names = [name for part in parts for name in part]
    return f"given by {' and '.join(names)}" if names else ""
