"""The impulse plane: which impulses end compression, slip and restitution, which friction allows,
and which one it was.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ..impact.choice import until_compressed
from ..impact.impact import Impact, answer_of, solved
from ..impact.inputs import OUTSIDE, TYRES
from ..kernels.contact_laws import BRACH, IMPULSE_RATIO, LAWS
from ..kernels.status import EPS
from ..messages.hints import hinted
from ..messages.warning import quietly
from ..quantities.formatting import UnitSystem
from .canvas import (
    FORCE,
    GREY,
    INK,
    LARGEST,
    LIGHT,
    Axes,
    Units,
    begin,
    check_impact,
    legend_below,
    tidy,
)

# A no-slip impulse further out than this many times the impulse would leave nothing to see of the
# rest.
_FAR = 4.0
_NO_YIELD = (
    64.0 * EPS
)  # relative: a coefficient this small is the rounding of differences of speeds
# Each regime with the impulse in the legend, and where on the solid line it ends.
_REGIMES = {
    "frictionless": ("frictionless", "on the axis: there is no friction"),
    "sliding": ("sliding", "on the cone: the contact slides"),
    "sticking": ("sticking", "where slip ends: the contact sticks"),
    "reversing": ("reversing", "within the cone: the slip turns around"),
    "given": ("ratio given", "at the impulse ratio given"),
}
_NO_REGIME = (
    "no tangential one in this model",
    "on the axis: there is no tangential impulse in this model",
)


@hinted
def impulse_plane(
    impact: Impact, *, axes: Axes | None = None, units: UnitSystem | None = None
) -> Axes:
    """Normal against tangential impulse on B, with the lines that decide the answer.

    An impulse changes the closing speed and the slip in proportion to itself. So compression ends
    on one line, restitution on a parallel one 1 + e times as far out, and slip on a third. Friction
    keeps the impulse within a cone. Where the contact sticks, the answer lies where restitution and
    slip end together; where it slides, at the edge of the cone.

    Parameters
    ----------
    impact : Impact
        One case, of any solver.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on; by default those of a new figure.
    units : "si", "metric" or "us", optional
        N·s, kN·s or lbf·s.

    Returns
    -------
    matplotlib.axes.Axes
        Lines by gid: "end of compression", "end of restitution", "no slip", "no slip at separation"
        (only under a law that reverses slip), "friction +", "friction -", "ratio", "impulse";
        points "answer", "at compression" and "no-slip impulse". ``linear_central`` has no
        tangential impulse, and no lines of slip and friction; a contact that moves only along the
        normal, such as a wall square against a pinned gate, has no lines of slip.

    Raises
    ------
    InputError
        An unknown option, or anything but one answered impact.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions import plot
    >>> a = col.Vehicle(mass=1500, yaw_inertia=2600, vx="60 km/h", x=-2.2, y=0)
    >>> b = col.Vehicle(mass=1200, yaw_inertia=2000, vy="30 km/h", x=0.9, y=-0.8)
    >>> impact = col.eccentric(a, b, 0.1, normal=0, point=(0, 0), friction=0.5)
    >>> axes = plot.impulse_plane(impact, units="metric")
    >>> axes.get_ylabel()
    'tangential impulse Pt on B [kN·s]'
    """
    labels = Units(units, impact)
    check_impact(impact, "impulse_plane", impulse=True)
    axes = begin(axes, (7.5, 6.0))
    factor = labels.factor("N*s")
    normal, tangential = impact.normal_impulse * factor, impact.tangential_impulse * factor
    raw = answer_of(impact)
    no_slip = raw.no_slip_normal * factor, raw.no_slip_tangential * factor
    plain = impact.model == "linear_central"
    energetic = LAWS[impact.law or BRACH].followed
    shows_no_slip = (
        not plain
        and not energetic
        and no_slip[0] > 0.0
        and math.hypot(*no_slip) <= _FAR * math.hypot(normal, tangential)
    )
    seen = [(0.0, 0.0), (normal, tangential), *([no_slip] if shows_no_slip else [])]
    right = 1.3 * max(x for x, _ in seen)
    low, high = (pick(y for _, y in seen) for pick in (min, max))
    room = max(0.35 * (high - low), 0.18 * right)
    low, high = low - room, high + room

    e = impact.restitution
    k_nn, k_nt = 1.0 / impact.effective_mass, raw.coupling
    closing = impact.closing_speed * factor
    names = ["normal_impulse", "tangential_impulse"]
    compressed = [
        part * factor for part in until_compressed(impact.inputs, raw, impact.choice, names)
    ]
    ends = closing, closing + impact.separation_speed * factor
    if impact.inputs.pushed:
        # The contact began at another closing speed, so the lines go where the actual impulses
        # ended.
        ends = k_nn * compressed[0] + k_nt * compressed[1], k_nn * normal + k_nt * tangential
    cone = not plain and _draw_friction(axes, impact, right)

    def line(
        gid: str, along_n: float, along_t: float, total: float, text: str, **style: Any
    ) -> None:
        """The line along_n Pn + along_t Pt = total; not in the legend if no part of it is in the
        picture.
        """
        size = math.hypot(along_n, along_t)
        ux, uy, foot = along_n / size, along_t / size, total / size
        out = 2.0 * math.hypot(right, high - low) + abs(foot)
        x, y, dx, dy = foot * ux, foot * uy, out * uy, -out * ux
        sides = {
            along_n * corner_n + along_t * corner_t > total
            for corner_n in (0.0, right)
            for corner_t in (low, high)
        }
        axes.plot(
            [x - dx, x + dx],
            [y - dy, y + dy],
            gid=gid,
            label=text if len(sides) == 2 else None,
            **style,
        )

    end = (
        "end of restitution"
        if impact.complete
        else "end of the contact, before that of compression"
    )
    line(
        "end of compression",
        k_nn,
        k_nt,
        ends[0],
        "end of compression",
        color=INK,
        lw=1.3,
        ls=(0, (6, 3)),
    )
    line("end of restitution", k_nn, k_nt, ends[1], f"{end} (e = {e:.3g})", color=INK, lw=1.8)
    path = [(0.0, 0.0), (normal, tangential)]
    if not plain:
        k_tt = _tangential_yield(impact)
        slip = impact.slip_before * factor
        if impact.inputs.pushed:
            slip = impact.slip_after * factor - k_nt * normal - k_tt * tangential
        if energetic and impact.regime in ("sticking", "reversing"):
            path.insert(1, _where_slip_stops(impact, slip, k_nt, k_tt))
        # A contact that moves along the normal alone keeps its slip under every impulse: there is
        # no such line.
        slip_yields = closing * math.hypot(k_nt, k_tt) > _NO_YIELD * k_nn * (closing + abs(slip))
        if slip_yields:
            line(
                "no slip",
                k_nt,
                k_tt,
                -slip,
                "slip ends (sticking line)",
                color=GREY,
                lw=1.8,
                ls=(0, (1, 1.2)),
            )
        left = LAWS[impact.law or BRACH].sticking_slip(e)
        if slip_yields and left != 0.0:
            text = "slip at separation if it sticks"
            line(
                "no slip at separation",
                k_nt,
                k_tt,
                -(1.0 - left) * slip,
                text,
                color=GREY,
                lw=1.3,
                ls=(0, (5, 1.5, 1, 1.5)),
            )

    axes.plot(*zip(*path, strict=True), color=FORCE, lw=2.4, zorder=5, gid="impulse")
    if shows_no_slip:
        name = "no-slip impulse"
        axes.plot(
            *no_slip,
            "D",
            ms=11,
            mfc="none",
            mec=INK,
            mew=1.5,
            ls="none",
            zorder=6,
            gid=name,
            label=name,
        )
    point: Any = {"ms": 8, "mec": FORCE, "ls": "none"}
    text = "impulse at the end of compression" if impact.complete else "impulse at the end"
    axes.plot(
        *compressed, "o", mfc="white", mew=1.8, zorder=7, gid="at compression", label=text, **point
    )
    kind, place = _NO_REGIME if plain else _REGIMES[impact.regime]
    axes.plot(
        normal,
        tangential,
        "o",
        mfc=FORCE,
        zorder=8,
        gid="answer",
        label=f"impulse: {kind}",
        **point,
    )

    axes.axhline(0.0, color=INK, lw=0.7, zorder=1)
    axes.set(xlim=(0.0, right), ylim=(low, high))
    either = ":\nat the diamond if the contact sticks, on the cone if it slides."
    how = either if shows_no_slip and cone else f",\nhere {place}."
    axes.set_xlabel(
        f"{labels.label('normal impulse Pn on B', 'N*s')}\nThe impulse ends on the solid line{how}"
    )
    axes.set_ylabel(labels.label("tangential impulse Pt on B", "N*s"))
    pair = (
        f"Pn = {labels.text(impact.normal_impulse, 'N*s')}, Pt = "
        f"{labels.text(impact.tangential_impulse, 'N*s')}"
    )
    without_slip = (
        "is not defined: one degree of freedom"
        if math.isnan(no_slip[0])
        else "lies outside the picture"
    )
    beyond = (
        "" if plain or shows_no_slip or energetic else f"\n(the no-slip impulse {without_slip})"
    )
    axes.set_title(f"{pair}{beyond}", fontsize=10.5)
    tidy(axes)
    legend_below(axes)
    return axes


def _draw_friction(axes: Axes, impact: Impact, right: float) -> bool:
    """Draw the tangential rule, a friction cone or the given impulse ratio; whether it
    is a cone.
    """
    mu = impact.friction
    if mu is None:
        ratio = impact.impulse_ratio
        text = f"Pt/Pn = {ratio:.3g}, given"
        axes.plot(
            [0.0, right],
            [0.0, ratio * right],
            color=GREY,
            lw=1.3,
            ls=(0, (3, 2)),
            gid="ratio",
            label=text,
        )
        return False
    # A friction as good as infinite bounds nothing that can be drawn.
    if mu == 0.0 or mu * right > LARGEST:
        return False
    axes.fill(
        [0.0, right, right],
        [0.0, mu * right, -mu * right],
        fc=LIGHT,
        ec="none",
        alpha=0.45,
        zorder=0,
        gid="cone",
    )
    style: Any = {"color": GREY, "lw": 1.2, "ls": (0, (3, 2))}
    axes.plot(
        [0.0, right],
        [0.0, mu * right],
        gid="friction +",
        label=f"friction cone (friction {mu:.3g})",
        **style,
    )
    axes.plot([0.0, right], [0.0, -mu * right], gid="friction -", **style)
    return True


def _where_slip_stops(impact: Impact, slip: float, k_nt: float, k_tt: float) -> tuple[float, float]:
    """The impulse up to the corner of the path under a law in which friction acts against the slip
    as it changes.
    """
    mu = math.copysign(impact.friction or 0.0, -slip)
    if slip == 0.0 or math.isinf(mu):
        return 0.0, -slip / k_tt
    normal = -slip / (k_nt + mu * k_tt)
    return normal, mu * normal


def _tangential_yield(impact: Impact) -> float:
    """Change of slip by a unit of tangential impulse [1/kg]: read off the solver's answer to
    another impulse ratio.
    """
    if impact.model != "eccentric":
        return 1.0 / impact.effective_mass
    coupling = answer_of(impact).coupling
    # With this sign the contact cannot jam.
    ratio: Any = math.copysign(1.0, coupling)
    with quietly():
        contact: Any = {"rule": IMPULSE_RATIO, "rule_value": ratio, "law": BRACH}
        contact |= dict.fromkeys((*OUTSIDE, *TYRES, "duration"))
        other = solved(replace(impact.inputs, model="eccentric", **contact), on_failure="nan")
    slip_change = other.slip_after - other.slip_before - coupling * other.normal_impulse
    return float(np.divide(slip_change, other.tangential_impulse))
