"""The contact as ``time_resolved`` followed it: force, crush and delta-V over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..errors import InputError
from ..formatting import UnitSystem
from ..hints import hinted
from ..impact import Impact
from .canvas import COLOURS, FORCE, GREY, GRID, INK, Units, begin, check_impact, check_size, legend_below, tidy, who

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@hinted
def pulse(impact: Impact, *, axes: Axes | None = None, units: UnitSystem | None = None) -> Axes:
    """Force, crush and the delta-V of both vehicles against time during the contact, one below the other.

    Parameters
    ----------
    impact : Impact
        One case of ``time_resolved``, or of ``solve`` where it took that model.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on, which are divided into three; by default those of a new figure.
    units : "si", "metric" or "us", optional
        s, N, m and m/s; ms, kN, m and km/h; ms, lbf, ft and mph.

    Returns
    -------
    matplotlib.axes.Axes
        Its ``child_axes`` have the lines by gid: "force"; "crush"; "a.delta_v", "b.delta_v"; and in each "maximum engagement".

    Raises
    ------
    InputError
        An unknown option, or anything but one answered impact that was followed in time.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions import plot
    >>> a = col.Vehicle(mass=1500, yaw_inertia=2600, vx="20 km/h", x=-2.2, y=0, heading=0)
    >>> b = col.Vehicle(mass=1200, yaw_inertia=2000, x=2.2, y=0.3, heading=0)
    >>> impact = col.time_resolved(a, b, 0.2, normal=0, point=(0, 0), friction=0.5, duration="100 ms", drag=0.7)
    >>> axes = plot.pulse(impact, units="metric")
    >>> [panel.get_ylabel() for panel in axes.child_axes]
    ['force [kN]', 'crush [m]', 'delta-V [km/h]']
    """
    labels = Units(units, impact)
    check_impact(impact, "pulse")
    found = impact.pulse
    if found is None:
        raise InputError(
            "impact is an impulse, which takes no time; write plot.pulse(collisions.time_resolved(...)), or "
            "plot.force_time(impact, '100 ms') for an assumed shape",
            code="takes_no_time",
            argument="impact",
        )
    for name, value in (("duration", found.duration), ("peak_force", found.peak_force), ("max_crush", found.max_crush)):
        check_size(name, value)
    axes = begin(axes, (7.0, 7.0))
    time = found.time * labels.factor("duration")
    names = who(0, impact.a.before), who(1, impact.b.before)
    panels = (
        ("force", "N", (("force", found.force, FORCE, "-", None),)),
        ("crush", "m", (("crush", found.crush, INK, "-", None),)),
        (
            "delta-V",
            "m/s",
            (
                ("a.delta_v", found.delta_v_a, COLOURS[0], "-", f"{names[0]}: {labels.text(impact.a.delta_v, 'm/s')}"),
                ("b.delta_v", found.delta_v_b, COLOURS[1], (0, (6, 2)), f"{names[1]}: {labels.text(impact.b.delta_v, 'm/s')}"),
            ),
        ),
    )
    engaged = float(time[found.crush.argmax()])
    axes.set_axis_off()
    for row, (what, unit, lines) in enumerate(panels):
        panel = axes.inset_axes((0.0, 0.70 - 0.35 * row, 1.0, 0.30))
        factor = labels.factor(unit)
        for gid, values, colour, style, label in lines:
            panel.plot(time, values * factor, color=colour, ls=style, lw=1.8, gid=gid, label=label)
        panel.axvline(engaged, color=GREY, ls=":", lw=1.2, gid="maximum engagement")
        panel.set(xlim=(0.0, 1.02 * float(time[-1])), ylabel=labels.label(what, unit))
        highest = max(float((values * factor).max()) for _, values, *_ in lines)
        panel.set_ylim(min(0.0, panel.get_ylim()[0]), 1.12 * highest)
        panel.grid(color=GRID, lw=0.6)
        panel.set_axisbelow(True)
        panel.locator_params(axis="y", nbins=5)
        tidy(panel)
        if row < len(panels) - 1:
            panel.tick_params(labelbottom=False)
    panel.set_xlabel(labels.label("time", "duration"))
    legend_below(panel)
    peak = f"peak {labels.text(found.peak_force, 'N')}, crush {labels.text(found.max_crush, 'm')}"
    axes.set_title(f"{labels.text(found.duration, 'duration')} of contact: {peak}\ndotted: maximum engagement", fontsize=10.5)
    return axes
