"""``energy``: a chart of the kinetic energies before, the losses, and the energies after."""

from __future__ import annotations

import math

from ..impact.impact import Impact
from ..impact.reconstruction import pushed_by_drag
from ..messages.errors import InputError
from ..messages.hints import hinted
from ..quantities.formatting import UnitSystem
from ..vehicle.vehicle import Vehicle
from .canvas import COLOURS, FORCE, GREY, INK, Axes, Units, begin, check_impact, number, tidy, who

# Of the energy before: what is less is not told as a gain, which a reader would look into.
_NEXT_TO_NOTHING = 1e-3


@hinted
def energy(impact: Impact, *, axes: Axes | None = None, units: UnitSystem | None = None) -> Axes:
    """The energy balance: kinetic energy of A and B before, the losses along normal and tangent,
    what tyres and impulses from outside take or give, and what A and B have after.

    Every bar begins where the one above ends, so that the last ends at zero: what came in is what
    went out. Kinetic energies, and the work of an impulse from outside, depend on the frame of
    reference; the losses do not. A negative loss is energy gained, and is drawn as such.

    Parameters
    ----------
    impact : Impact
        One case, of any solver.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on; by default those of a new figure.
    units : "si", "metric" or "us", optional
        J, kJ or ft·lbf.

    Returns
    -------
    matplotlib.axes.Axes
        Bars by gid: "a.before", "b.before", "lost.normal", "lost.tangential", "lost.tyres" and
        "lost.outside" (only where tyres or an impulse from outside act), "a.after", "b.after".

    Raises
    ------
    InputError
        An unknown option, an infinite mass or inertia that moves, or anything but one answered
        impact.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    Example 2 of the paper:

    >>> import collisions as col
    >>> from collisions import plot
    >>> a, b = col.Vehicle(mass="1100 kg", vx="80 km/h"), col.Vehicle(mass="950 kg")
    >>> axes = plot.energy(col.linear_central(a, b, restitution=0.398), units="metric")
    >>> axes.get_xlabel()
    'energy [kJ]'
    """
    labels = Units(units, impact)
    check_impact(impact, "energy")
    a, b = impact.a, impact.b
    names = who(0, a.before), who(1, b.before)
    tyres = a.tyre_loss + b.tyre_loss
    work = a.outside_work + b.outside_work
    outside = (
        "lost by\nthe tyres"
        if pushed_by_drag(impact.reconstruction)
        else "lost to what\nacts from outside"
    )
    before = _kinetic(a.before, "a"), _kinetic(b.before, "b")
    rows = [
        ("a.before", f"{names[0]} before", before[0], COLOURS[0], ""),
        ("b.before", f"{names[1]} before", before[1], COLOURS[1], ""),
        ("lost.normal", "lost along\nthe normal", -impact.energy_loss_normal, FORCE, "xxx"),
        (
            "lost.tangential",
            "lost along\nthe tangent",
            -impact.energy_loss_tangential,
            FORCE,
            "...",
        ),
        *([("lost.tyres", "lost by\nthe tyres", -tyres, FORCE, "|||")] if tyres else []),
        *([("lost.outside", outside, work, FORCE, "---")] if work else []),
        ("a.after", f"{names[0]} after", -_kinetic(a.after, "a"), COLOURS[0], "///"),
        ("b.after", f"{names[1]} after", -_kinetic(b.after, "b"), COLOURS[1], "///"),
    ]
    axes = begin(axes, (7.0, 4.2))
    factor = labels.factor("J")
    total = sum(value for gid, _, value, _, _ in rows if gid.endswith("before")) * factor
    reached = 0.0
    for row, (gid, _, value, colour, hatch) in enumerate(rows):
        step = value * factor
        axes.barh(
            row,
            step,
            left=reached,
            height=0.62,
            fc=_tint(colour),
            ec=colour,
            hatch=hatch,
            lw=1.3,
            gid=gid,
            zorder=3,
        )
        end = reached + step
        if row < len(rows) - 1:
            axes.plot([end, end], [row - 0.31, row + 1.31], color=GREY, lw=0.9, ls=":", zorder=2)
        gains = gid.startswith("lost") and value > 0.0
        text = labels.text(abs(value), "J") + (" gained" if gains else "")
        if gid.startswith("lost") and 0.0 < abs(step) < _NEXT_TO_NOTHING * total:
            text = "less than 0.1 %"
        axes.annotate(
            text, (max(reached, end), row), (6, 0), textcoords="offset points", va="center",
            fontsize=9.5, color=INK,
            annotation_clip=False,
        )  # fmt: skip
        reached = end
    axes.set_yticks(range(len(rows)), [name for _, name, _, _, _ in rows], parse_math=False)
    axes.invert_yaxis()
    axes.axvline(0.0, color=INK, lw=0.9, zorder=4)
    low, high = axes.get_xlim()
    axes.set_xlim(min(0.0, low), max(high, total) + 0.22 * (max(high, total) - min(0.0, low)))
    axes.set_xlabel(labels.label("energy", "J"))
    lost = impact.energy_loss
    share = (
        f"\n{number(100.0 * abs(lost) * factor / total, 1)} % of the kinetic energy in this frame"
        if total > 0.0
        else ""
    )
    for label in axes.get_yticklabels():
        label.set_fontsize(10 if "\n" not in label.get_text() else 8.5)
    axes.set_title(
        f"Energy {'lost' if lost >= 0.0 else 'gained'}: {labels.text(abs(lost), 'J')}{share}",
        fontsize=10.5,
    )
    axes.locator_params(axis="x", nbins=5)
    tidy(axes)
    return axes


def _tint(colour: str) -> str:
    """A quarter of a colour on white: in SVG the hatching of a translucent face is lost in its
    colour.
    """
    return "#" + "".join(
        f"{255 - (255 - int(colour[at : at + 2], 16)) // 4:02x}" for at in (1, 3, 5)
    )


def _kinetic(state: Vehicle, letter: str) -> float:
    found = float(state.kinetic_energy)
    if math.isinf(found):
        raise InputError(
            f"{letter} has an infinite mass or yaw inertia and moves, so its kinetic energy is "
            "infinite in this frame; solve the impact in a frame in which it rests (take its "
            "velocity from both vehicles), which changes no loss",
            code="infinite_mass",
            argument="impact",
            vehicle=letter,
        )
    return found
