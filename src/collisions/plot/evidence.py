"""What the evidence says: the unknowns of a posterior in pairs, and each observation beside what is
computed of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np

from ..estimate.readings import KINDS
from ..messages.errors import InputError
from ..messages.hints import hinted
from ..quantities.formatting import UnitSystem
from ..quantities.units import shown
from ..reconstruct import Fit, Posterior
from .canvas import (
    BARS,
    FORCE,
    GREY,
    INK,
    LIGHT,
    SMALLEST,
    Axes,
    Figure,
    Units,
    begin,
    check_size,
    in_lines,
    tidy,
)

_SHARES = (0.5, 0.95)  # of the samples within the two lines
_BINS = 28
_KERNEL = (1.0, 2.0, 1.0)
_MOST = 10
_NAME = 18  # characters of a name on one line


@hinted
def corner(
    posterior: Posterior, *, unknowns: Sequence[str] | None = None, units: UnitSystem | None = None
) -> Figure:
    """Corner plot of a posterior: each unknown by itself on the diagonal, each pair below it, given
    evidence and priors.

    In the panel of a pair, darker is more probable, and the contours hold 50 and 95 percent of the
    samples. A narrow slanting band means that the evidence determines the two together better than
    either alone.

    Parameters
    ----------
    posterior : Posterior
        What ``reconstruct.posterior`` returned.
    unknowns : sequence of str, optional
        Names of the unknowns or outputs to draw, in this order; by default all unknowns. At most
        ten.
    units : "si", "metric" or "us", optional
        Units of those that have one.

    Returns
    -------
    matplotlib.figure.Figure
        A new figure; its Axes by gid: "speed_a" on the diagonal, "speed_a and speed_b" below.

    Raises
    ------
    InputError
        A name that is not there or does not vary, more than ten names, or anything but a posterior.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    >>> from collisions import plot, reconstruct, uncertainty
    >>> priors = {"a": uncertainty.Normal(10.0, 2.0), "b": uncertainty.Uniform(0.0, 5.0)}
    >>> found = reconstruct.posterior(
    ...     lambda a, b: {"sum": a + b}, priors, {"sum": (12.0, 0.5)}, samples=1024, seed=1
    ... )
    >>> [axes.get_gid() for axes in plot.corner(found).axes]
    ['a', 'a and b', 'b']
    """
    labels = Units(units, posterior)
    if not isinstance(posterior, Posterior):
        raise InputError(
            "posterior must be what reconstruct.posterior returned, got "
            f"{type(posterior).__name__}",
            code="bad_option",
            argument="posterior",
        )
    given: Any = (
        list(posterior)
        if unknowns is None
        else [unknowns]
        if isinstance(unknowns, str)
        else unknowns
    )
    names = list(given) if isinstance(given, (list, tuple)) else []
    if not 1 <= len(names) <= _MOST:
        got = f"{len(names)}" if names else shown(unknowns)
        raise InputError(
            f"a corner plot shows 1 to {_MOST} unknowns, got {got}; write "
            f"unknowns=['{next(iter(posterior))}', ...]",
            code="bad_option",
            argument="unknowns",
        )
    columns = [posterior[name] for name in names]
    for one in columns:
        # A deviation of rounding alone: fewer floats than bins.
        if not one.std > np.spacing(_BINS * abs(one.mean)):
            raise InputError(
                f"{one.name!r} does not vary from sample to sample",
                code="no_spread",
                argument="unknowns",
            )
        check_size(one.name, float(np.nanmax(abs(one.values))))
        check_size(f"spread of {one.name}", one.std, SMALLEST)
    first = begin(None, (1.2 + 1.75 * len(names),) * 2)
    figure = cast(Figure, first.figure)  # made just above, so it is no part of another
    first.remove()
    grid = figure.add_gridspec(len(names), len(names))
    for row, output in enumerate(columns):
        for column, other in enumerate(columns[: row + 1]):
            axes = figure.add_subplot(grid[row, column])
            x, y = (one.values * labels.factor(one.unit) for one in (other, output))
            if column == row:
                axes.set_gid(output.name)
                axes.hist(x, _BINS, fc=BARS, ec=INK, lw=0.6, histtype="stepfilled")
                axes.set_yticks([])
            else:
                axes.set_gid(f"{other.name} and {output.name}")
                _pair(axes, x, y)
            axes.set_xlim(np.nanmin(x), np.nanmax(x))
            tidy(axes)
            axes.tick_params(
                labelbottom=row == len(columns) - 1, labelleft=column == 0 < row, labelsize=8
            )
            if row == len(columns) - 1:
                axes.set_xlabel(
                    labels.label(in_lines(other.name, _NAME), other.unit),
                    fontsize=9,
                    parse_math=False,
                )
            if column == 0 < row:
                axes.set_ylabel(
                    labels.label(in_lines(output.name, _NAME), output.unit),
                    fontsize=9,
                    parse_math=False,
                )
    figure.align_labels()
    return figure


@hinted
def residuals(found: Posterior | Fit, *, axes: Axes | None = None) -> Axes:
    """Each observation minus its computed value, divided by its stated error: where the evidence
    disagrees with the model.

    If the errors are as stated and the observations many more than the unknowns, two of three lie
    within the dark band and nineteen of twenty within the light one; with few observations more do,
    because the unknowns follow them. For a posterior, the line holds 95 percent of the computed
    values; a censored reading has no line, and its point is off the middle only where its bound is
    missed. Readings with sharp bounds, which are met, are left out.

    Parameters
    ----------
    found : Posterior or Fit
        What ``reconstruct.posterior`` or ``reconstruct.fit`` returned.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on; by default those of a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The points are the line "residuals"; for a posterior each range has the gid "range of ..."
        with the name.

    Raises
    ------
    InputError
        No observation with an error, or anything but a posterior or a fit.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    >>> from collisions import plot, reconstruct, uncertainty
    >>> found = reconstruct.fit(
    ...     lambda v: {"one": v, "two": v}, {"v": 10.0}, {"one": (10.0, 1.0), "two": (12.0, 1.0)}
    ... )
    >>> points = next(
    ...     line for line in plot.residuals(found).get_lines() if line.get_gid() == "residuals"
    ... )
    >>> [round(float(x), 3) for x in points.get_xdata()]
    [-1.0, 1.0]
    """
    if not isinstance(found, (Posterior, Fit)):
        raise InputError(
            "found must be what reconstruct.posterior or reconstruct.fit returned, got "
            f"{shown(found)}",
            code="bad_option",
            argument="found",
        )
    rows = {name: one for name, one in found.residuals.items() if one.sigma}
    if not rows:
        raise InputError(
            "no observation has an error to count its residual in; those with sharp bounds are met",
            code="no_residuals",
            argument="found",
        )
    axes = begin(axes, (6.5, 1.7 + 0.42 * len(rows)))
    for width, shade in ((2.0, 0.3), (1.0, 0.55)):
        axes.axvspan(-width, width, color=LIGHT, alpha=shade, lw=0, zorder=0)
    axes.axvline(0.0, color=INK, lw=0.9, zorder=1)
    over = [one.over_sigma for one in rows.values()]
    # Everything drawn is in view: the readings that contradict most are the ones to look at.
    reached = [*over]
    axes.plot(over, range(len(rows)), "o", color=INK, ms=7, ls="none", zorder=4, gid="residuals")
    for place, (name, one) in enumerate(rows.items()):
        if isinstance(found, Posterior) and KINDS[type(found.observed[name])].is_value:
            output = found.predicted[name]
            ends = [
                one.over_sigma + (float(output.mean) - end) / one.sigma
                for end in output.interval(0.95)
            ]
            reached += ends
            axes.plot(
                ends, [place, place], "-", color=FORCE, lw=2.2, zorder=3, gid=f"range of {name}"
            )
    axes.set_yticks(range(len(rows)), [in_lines(name, most=2) for name in rows], parse_math=False)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlim(-(most := max(3.2, 1.15 * max(map(abs, reached)))), most)
    axes.set_xlabel("observed less computed, in stated errors")
    shown_by = (
        "point and line: mean and 95 % of what is computed"
        if isinstance(found, Posterior)
        else "points: at the estimates"
    )
    axes.set_title(
        f"{shown_by}\ndark band: one stated error; light band: two", fontsize=10.5, color=GREY
    )
    tidy(axes)
    return axes


def _pair(axes: Axes, x: Any, y: Any) -> None:
    """The density of two columns, and the lines within which the shares of the samples lie."""
    known = ~(np.isnan(x) | np.isnan(y))
    counts, xs, ys = np.histogram2d(x[known], y[known], _BINS)
    # A cell and its neighbours, so that the lines are not those of chance.
    wide = np.lib.stride_tricks.sliding_window_view(np.pad(counts, 1), (3, 3))
    smooth = np.einsum("ijkl,k,l->ij", wide, _KERNEL, _KERNEL)
    falling = np.argsort(-smooth, axis=None)
    sums = np.cumsum(counts.ravel()[falling])
    levels = sorted(
        {
            float(smooth.ravel()[falling[np.searchsorted(sums, share * sums[-1])]])
            for share in _SHARES
        }
    )
    axes.pcolormesh(xs, ys, smooth.T, cmap="Greys", rasterized=True)
    middles = (0.5 * (ends[1:] + ends[:-1]) for ends in (xs, ys))
    axes.contour(*middles, smooth.T, levels, colors=[FORCE], linewidths=1.1).set_gid("shares")
