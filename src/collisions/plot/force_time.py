"""The force of the contact against time, idealised: compression and restitution as areas A1 and A2 (figures 3 and 4)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import pulse
from ..drag import LONGEST_CONTACT, one_value
from ..errors import InputError
from ..formatting import UnitSystem
from ..hints import hinted
from ..impact import Impact
from ..reading import ArgumentReader, warn_if_large
from ..units import Input, shown
from .canvas import FORCE, GREY, INK, SMALLEST, Units, begin, check_impact, check_size, legend_below, only_of_an_impulse, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_POINTS = 400


@hinted
def force_time(impact: Impact, duration: Input, *, axes: Axes | None = None, units: UnitSystem | None = None) -> Axes:
    """The normal force between the vehicles against time, with areas A1 of compression and A2 of restitution, e = A2/A1.

    Figures 3 and 4 of "Application of Impulse Momentum Theory to Vehicle Collisions". The areas are the impulses of the answer.
    The shape is assumed: the spring pulse on which ``left_out`` also bases its crush, a quarter of a sine up to the end of
    compression and another one down, with one peak. Restitution then takes e times as long as compression: as long if elastic,
    no time if plastic, as in the figure. The duration is assumed too; peak and mean force are inversely proportional to it, and
    the impulse does not determine them.

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
    >>> axes = plot.force_time(col.linear_central(a, b, restitution=0.398), "100 ms", units="metric")
    >>> axes.get_ylabel()
    'normal force [kN]'
    """
    labels = Units(units, impact)
    check_impact(impact, "force_time")
    only_of_an_impulse(impact, "force_time")
    reader = ArgumentReader()
    time = one_value(reader, duration, "s", "duration")
    reader.close()
    if not isinstance(time, float):
        raise InputError(
            f"duration must be one finite time, got {shown(duration)}; write '100 ms'", code="bad_shape", argument="duration"
        )
    if not time > 0.0:
        raise InputError(
            f"duration must be > 0, got {shown(duration)}; it is the time from touching to parting, write '100 ms'",
            code="not_positive",
            argument="duration",
        )
    warn_if_large(duration, time, LONGEST_CONTACT, "duration", "seconds", "ms")
    check_size("duration", time, SMALLEST)
    axes = begin(axes)

    e = impact.restitution
    compression, restitution = impact.compression_impulse, impact.restitution_impulse
    turn = time * pulse.compression_time(e)
    # An incomplete impact ends on the way up.
    top = min(turn, time)
    share = np.linspace(0.0, 1.0, _POINTS)
    rise = pulse.rise(share * (top / turn))
    # The height for which the polygon drawn, not only the sine, has the area A1; A2 then has its own.
    highest = compression / (top * float(np.mean(0.5 * (rise[1:] + rise[:-1]))))
    peak = highest * float(rise[-1])
    in_time, in_force = labels.factor("duration"), labels.factor("N")
    for name, what, impulse, start, end, heights, hatch, shade in (
        ("A1", "compression", compression, 0.0, top, rise, "///", "#d9a7b5"),
        ("A2", "restitution", restitution, top, time, rise[::-1], "...", "#f6e9ed"),
    ):
        label = f"{name} = {labels.text(impulse, 'N*s')}, {what}"
        if end <= start or impulse <= 0.0:
            axes.fill([start * in_time], [0.0], fc=shade, ec=FORCE, hatch=hatch, label=label)  # for the legend alone
            continue
        x, y = (start + (end - start) * share) * in_time, heights * highest * in_force
        outline = [x[0], *x, x[-1]], [0.0, *y, 0.0]
        axes.fill(*outline, fc=shade, ec=FORCE, lw=1.4, hatch=hatch, gid=name, label=label, zorder=2)
        if end - start > 0.12 * time:
            middle = start + (end - start) * (0.64 if name == "A1" else 0.36)
            axes.text(middle * in_time, 0.3 * peak * in_force, name, ha="center", va="center", fontsize=12, zorder=5,
                      bbox={"boxstyle": "round,pad=0.25", "fc": "white", "ec": "none"})  # fmt: skip
    mean_force = impact.normal_impulse / time
    mean = mean_force * in_force
    line: Any = {"lw": 1.4, "zorder": 4}
    text = f"mean force {labels.text(mean_force, 'N')}"
    axes.plot([0.0, time * in_time], [mean, mean], color=INK, ls=(0, (6, 3)), gid="mean force", label=text, **line)
    text = f"{'end of compression' if impact.complete else 'cut short'}, peak {labels.text(peak, 'N')}"
    axes.plot(
        [top * in_time] * 2, [0.0, 1.14 * peak * in_force], color=GREY, ls=":", gid="end of compression", label=text, **line
    )

    axes.set(xlim=(-0.04 * time * in_time, 1.08 * time * in_time), ylim=(0.0, 1.14 * peak * in_force))
    axes.set_xlabel(labels.label("time", "duration"))
    axes.set_ylabel(labels.label("normal force", "N"))
    ratio = "e = A2/A1" if impact.complete else "e"
    axes.set_title(f"{ratio} = {e:.3g} ({impact.kind})\nareas from the impact; shape and duration assumed", fontsize=10.5)
    tidy(axes)
    legend_below(axes)
    return axes
