"""The contact over time: its force idealised, as areas (figures 3 and 4), or as ``time_resolved``
followed it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..impact.impact import Impact
from ..impact.pulse import compression_time, rise
from ..messages.errors import InputError
from ..messages.hints import hinted
from ..quantities.formatting import UnitSystem
from ..quantities.reading import ArgumentReader, warn_if_large
from ..quantities.units import Input, shown
from ..vehicle.drag import LONGEST_CONTACT, one_value
from .canvas import (
    COLOURS,
    FORCE,
    GREY,
    GRID,
    INK,
    SMALLEST,
    Axes,
    Units,
    begin,
    check_impact,
    check_size,
    legend_below,
    tidy,
    who,
)

_POINTS = 400


@hinted
def force_time(
    impact: Impact, duration: Input, *, axes: Axes | None = None, units: UnitSystem | None = None
) -> Axes:
    """The normal force between the vehicles against time, with areas A1 of compression and A2 of
    restitution.

    Figures 3 and 4 of "Application of Impulse Momentum Theory to Vehicle Collisions". The areas are
    the impulses of the answer. The shape is assumed: the spring pulse on which ``left_out`` also
    bases its crush, a quarter of a sine up to the end of compression and another one down, with one
    peak. Restitution then takes A2/A1 times as long as compression: as long if elastic, no time if
    plastic, as in the figure. That ratio is e, but under law "stronge", where the square of e is
    the share of the work that restitution gives back. The duration is assumed too; peak and mean
    force are inversely proportional to it, and the impulse does not determine them.

    Parameters
    ----------
    impact : Impact
        One case, of any solver.
    duration : float, str or Quantity [s]
        From first contact to separation, > 0: 0.05 to 0.15 s for cars, longer for softer contacts.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on; by default those of a new figure.
    units : "si", "metric" or "us", optional
        s, N and N·s; ms, kN and kN·s; ms, lbf and lbf·s.

    Returns
    -------
    matplotlib.axes.Axes
        Areas by gid: "A1", "A2" (absent if plastic); lines "mean force" and "end of compression".

    Raises
    ------
    InputError
        An unknown option, an impossible duration, or anything but one answered impact.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    Example 2 of the paper, in an assumed tenth of a second:

    >>> import collisions as col
    >>> from collisions import plot
    >>> a, b = col.Vehicle(mass="1100 kg", vx="80 km/h"), col.Vehicle(mass="950 kg")
    >>> axes = plot.force_time(
    ...     col.linear_central(a, b, restitution=0.398), "100 ms", units="metric"
    ... )
    >>> axes.get_ylabel()
    'normal force [kN]'
    """
    labels = Units(units, impact)
    check_impact(impact, "force_time", impulse=True)
    reader = ArgumentReader()
    time = one_value(reader, duration, "s", "duration")
    reader.close()
    if not isinstance(time, float):
        raise InputError(
            f"duration must be one finite time, got {shown(duration)}; write '100 ms'",
            code="bad_shape",
            argument="duration",
        )
    if not time > 0.0:
        raise InputError(
            f"duration must be > 0, got {shown(duration)}; it is the time from touching to "
            "parting, write '100 ms'",
            code="not_positive",
            argument="duration",
        )
    warn_if_large(duration, time, LONGEST_CONTACT, "duration", "seconds", "ms")
    check_size("duration", time, SMALLEST)
    axes = begin(axes)

    e = impact.restitution
    compression, restitution = impact.compression_impulse, impact.restitution_impulse
    turn = time * compression_time(e)
    if impact.complete:
        turn = time * compression / (compression + restitution)
    # An incomplete impact ends on the way up.
    top = min(turn, time)
    share = np.linspace(0.0, 1.0, _POINTS)
    rising = rise(share * (top / turn))
    # The height for which the polygon drawn, not only the sine, has the area A1; A2 then has its
    # own.
    highest = compression / (top * float(np.mean(0.5 * (rising[1:] + rising[:-1]))))
    peak = highest * float(rising[-1])
    in_time, in_force = labels.factor("duration"), labels.factor("N")
    for name, what, impulse, start, end, heights, hatch, shade in (
        ("A1", "compression", compression, 0.0, top, rising, "///", "#d9a7b5"),
        ("A2", "restitution", restitution, top, time, rising[::-1], "...", "#f6e9ed"),
    ):
        label = f"{name} = {labels.text(impulse, 'N*s')}, {what}"
        if end <= start or impulse <= 0.0:
            axes.fill(
                [start * in_time], [0.0], fc=shade, ec=FORCE, hatch=hatch, label=label
            )  # for the legend alone
            continue
        x, y = (start + (end - start) * share) * in_time, heights * highest * in_force
        outline = [x[0], *x, x[-1]], [0.0, *y, 0.0]
        axes.fill(
            *outline, fc=shade, ec=FORCE, lw=1.4, hatch=hatch, gid=name, label=label, zorder=2
        )
        if end - start > 0.12 * time:
            middle = start + (end - start) * (0.64 if name == "A1" else 0.36)
            axes.text(middle * in_time, 0.3 * peak * in_force, name, ha="center", va="center",
                fontsize=12, zorder=5,
                      bbox={"boxstyle": "round,pad=0.25", "fc": "white", "ec": "none"})  # fmt: skip
    mean_force = impact.normal_impulse / time
    mean = mean_force * in_force
    line: Any = {"lw": 1.4, "zorder": 4}
    text = f"mean force {labels.text(mean_force, 'N')}"
    axes.plot(
        [0.0, time * in_time],
        [mean, mean],
        color=INK,
        ls=(0, (6, 3)),
        gid="mean force",
        label=text,
        **line,
    )
    text = (
        f"{'end of compression' if impact.complete else 'cut short'}, peak {labels.text(peak, 'N')}"
    )
    axes.plot(
        [top * in_time] * 2,
        [0.0, 1.14 * peak * in_force],
        color=GREY,
        ls=":",
        gid="end of compression",
        label=text,
        **line,
    )

    axes.set(
        xlim=(-0.04 * time * in_time, 1.08 * time * in_time), ylim=(0.0, 1.14 * peak * in_force)
    )
    axes.set(xlabel=labels.label("time", "duration"), ylabel=labels.label("normal force", "N"))
    # Not under "stronge" where the slip stops or turns.
    same = impact.complete and math.isclose(restitution, e * compression, rel_tol=1e-6)
    ratio = "e = A2/A1" if same or e == 0.0 else "e"
    axes.set_title(
        f"{ratio} = {e:.3g} ({impact.kind})\nareas from the impact; shape and duration assumed",
        fontsize=10.5,
    )
    tidy(axes)
    legend_below(axes)
    return axes


@hinted
def pulse(impact: Impact, *, axes: Axes | None = None, units: UnitSystem | None = None) -> Axes:
    """Force, crush and the delta-V of both vehicles against time during the contact, one below the
    other.

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
        Its ``child_axes`` have the lines by gid: "force"; "crush"; "a.delta_v", "b.delta_v"; and in
        each "maximum engagement".

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
    >>> impact = col.time_resolved(
    ...     a, b, 0.2, normal=0, point=(0, 0), friction=0.5, duration="100 ms", drag=0.7
    ... )
    >>> axes = plot.pulse(impact, units="metric")
    >>> [panel.get_ylabel() for panel in axes.child_axes]
    ['force [kN]', 'crush [m]', 'delta-V [km/h]']
    """
    labels = Units(units, impact)
    check_impact(impact, "pulse")
    found = impact.pulse
    if found is None:
        raise InputError(
            "impact is an impulse, which takes no time; write "
            "plot.pulse(collisions.time_resolved(...)), or plot.force_time(impact, '100 ms') for "
            "an assumed shape",
            code="takes_no_time",
            argument="impact",
        )
    for name, value in (
        ("duration", found.duration),
        ("peak_force", found.peak_force),
        ("max_crush", found.max_crush),
    ):
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
                (
                    "a.delta_v",
                    found.delta_v_a,
                    COLOURS[0],
                    "-",
                    f"{names[0]}: {labels.text(impact.a.delta_v, 'm/s')}",
                ),
                (
                    "b.delta_v",
                    found.delta_v_b,
                    COLOURS[1],
                    (0, (6, 2)),
                    f"{names[1]}: {labels.text(impact.b.delta_v, 'm/s')}",
                ),
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
    axes.set_title(
        f"{labels.text(found.duration, 'duration')} of contact: {peak}\ndotted: maximum engagement",
        fontsize=10.5,
    )
    return axes
