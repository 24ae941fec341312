"""How an uncertain output is distributed, and which input matters: its shares of the variance with
their standard errors.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from ..messages.errors import InputError
from ..messages.hints import hinted
from ..quantities.formatting import UnitSystem, with_decimals
from ..quantities.units import shown
from ..uncertainty.intervals import Bounds
from ..uncertainty.output import COVERAGE, Output
from ..uncertainty.result import Propagation
from ..uncertainty.sampled import Sampled
from .canvas import (
    BARS,
    FORCE,
    GREY,
    INK,
    LIGHT,
    MINUS,
    Axes,
    Units,
    begin,
    check_size,
    drawable,
    in_lines,
    legend_below,
    tidy,
)

_ASIDE = 0.24  # of a row: error bars, diamonds and figures from its middle


@hinted
def distribution(
    output: Output,
    *,
    coverage: float = COVERAGE,
    bins: int = 30,
    axes: Axes | None = None,
    units: UnitSystem | None = None,
) -> Axes:
    """Histogram of the sampled cases of an output, with mean, median and interval, given the stated
    inputs.

    Parameters
    ----------
    output : Output
        One output, such as ``result["delta_v"]``, of ``uncertainty.propagate`` by a method that
        samples, or of a posterior.
    coverage : float [-]
        Probability of the shaded interval, with equal tails below and above it.
    bins : int
        Number of bars. With few inputs the cases of "quasi_random" lie on lines that 40 bars or
        more may show as a comb.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on; by default those of a new figure.
    units : "si", "metric" or "us", optional
        For an output that the model returned as a Quantity. Others are labelled with their names
        alone.

    Returns
    -------
    matplotlib.axes.Axes
        By gid: "histogram", "mean", "median", "low", "high".

    Raises
    ------
    InputError
        An output that was not sampled, has an Interval among its inputs or has no spread; or
        anything but an output.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    >>> from collisions import plot, uncertainty
    >>> known = {"drag": uncertainty.Normal(0.7, 0.05), "way": uncertainty.Normal("20 m", "1 m")}
    >>> def model(drag, way):
    ...     from collisions import travel
    ...
    ...     return {"speed": travel.speed(way, drag=drag)}
    >>> result = uncertainty.propagate(model, known, method="quasi_random", samples=1024, seed=1)
    >>> plot.distribution(result["speed"]).get_ylabel()
    'share of the cases [%]'
    """
    labels = Units(units, output)
    if not isinstance(output, Output):
        raise InputError(
            "output must be one output of what uncertainty.propagate returned, got "
            f"{type(output).__name__}; write plot.distribution(result['delta_v']), and in other "
            "units plot.distribution(result['delta_v'], units='us')",
            code="bad_option",
            argument="output",
        )
    if isinstance(output, Bounds):
        raise InputError(
            f"{output.name!r} has no one distribution, because an Interval among the inputs says "
            "nothing of likelihood; draw that of an end of the interval: fix the input there "
            "and propagate again",
            code="no_variance",
            argument="output",
        )
    low, high = output.interval(coverage)
    histogram = output.histogram(bins)
    check_size(output.name, float(np.abs(histogram.edges).max()))
    axes = begin(axes, (6.5, 4.6))
    unit = output.unit
    factor = labels.factor(unit)
    axes.axvspan(low * factor, high * factor, color=LIGHT, alpha=0.5, lw=0, zorder=0)
    axes.stairs(
        100.0 * histogram.shares,
        histogram.edges * factor,
        fill=True,
        fc=BARS,
        ec=INK,
        lw=0.9,
        zorder=2,
        gid="histogram",
    )
    median = output.quantile(0.5)
    # As the tables have them.
    told = partial(labels.to_deviation, unit=unit, deviation=output.std)
    start, end = map(told, (low, high))
    span = (
        f"{100.0 * coverage:.4g} % interval, {start.removesuffix(f' {labels.name(unit)}')} to {end}"
    )
    for gid, value, style, colour, text in (
        ("mean", output.mean, "-", FORCE, f"mean {told(output.mean)}"),
        ("median", median, (0, (1, 1.2)), INK, f"median {told(median)}"),
        ("low", low, (0, (6, 3)), INK, span),
        ("high", high, (0, (6, 3)), INK, None),
    ):
        axes.axvline(value * factor, color=colour, lw=1.7, ls=style, zorder=4, gid=gid, label=text)
    axes.set_ylim(0.0, 1.08 * 100.0 * float(histogram.shares.max()))
    axes.set_xlabel(drawable(labels.label(output.name, unit)), parse_math=False)
    answered = " with an answer" if isinstance(output, Sampled) and output.failed else ""
    axes.set_ylabel(f"share of the cases{answered} [%]")
    axes.set_title(f"given {output._given()}", fontsize=10.5, color=GREY)
    tidy(axes)
    legend_below(axes)
    return axes


@hinted
def contributions(
    result: Propagation | Output,
    output: str | None = None,
    *,
    axes: Axes | None = None,
    units: UnitSystem | None = None,
) -> Axes:
    """The share of an output's variance due to each input: by itself (bar), and with its
    interactions (diamond).

    The figure for each stands beside it. To know an input exactly would remove the share of its
    bar. Horizontal lines are standard errors to either side; a local method has none. Where diamond
    and bar differ, inputs act together.

    Parameters
    ----------
    result : Propagation or Output
        What ``uncertainty.propagate`` returned, or one output of it.
    output : str, optional
        Which output; needed if there is more than one.
    axes : matplotlib.axes.Axes, optional
        Axes to draw on; by default those of a new figure.
    units : "si", "metric" or "us", optional
        Units of the standard deviation in the title, where the model returned Quantities.

    Returns
    -------
    matplotlib.axes.Axes
        Bars by gid: "share of ..." with the name of the input; the diamonds are the line "total".
        Their figures are "own of
        ..." and "total of ...".

    Raises
    ------
    InputError
        An output that is not there, an Interval among the inputs, no variance to share, or anything
        but a result.
    MissingInputError
        If matplotlib is missing.

    Examples
    --------
    >>> from collisions import plot, uncertainty
    >>> known = {
    ...     "mass": uncertainty.Normal("1200 kg", "30 kg"),
    ...     "speed": uncertainty.Normal("20 m/s", "0.5 m/s"),
    ... }
    >>> model = lambda mass, speed: {"energy": 0.5 * mass * speed**2}
    >>> axes = plot.contributions(uncertainty.propagate(model, known, method="first_order"))
    >>> [label.get_text() for label in axes.get_yticklabels()]
    ['speed', 'mass']
    """
    labels = Units(units, result)
    found = _output(result, output)
    own, total, errors = (
        found.contributions,
        found.total_contributions,
        found.contribution_standard_errors,
    )
    names = list(own)
    figures = np.array([(own[name], total[name], *errors[name]) for name in names])
    if not names or not np.all(np.isfinite(figures[:, :2])):
        raise InputError(
            f"{found.name!r} has no variance to share: it does not differ from case to case, has "
            "too few answers, or is known from one side only in some cases",
            code="no_variance",
            argument="result",
        )
    check_size(f"spread of {found.name}", found.std)
    axes = begin(axes, (6.5, 1.9 + 0.42 * len(names)))
    rows = np.arange(len(names))
    percent = 100.0 * figures
    known = np.isfinite(percent[:, 2:])
    for row, name in enumerate(names):
        axes.barh(
            row, percent[row, 0], height=0.6, fc=BARS, ec=INK, hatch="///", lw=1.0,
            gid=f"share of {name}", zorder=2,
            label=None if row else "by itself",
        )  # fmt: skip
    axes.plot(
        percent[:, 1], rows + _ASIDE, "D", ms=7, mfc="white", mec=INK, mew=1.5, ls="none",
            zorder=5, gid="total",
        label="with its interactions",
    )  # fmt: skip
    for column, aside in ((0, -_ASIDE), (1, _ASIDE)):
        if known[:, column].all():
            axes.errorbar(
                percent[:, column], rows + aside, xerr=percent[:, 2 + column], fmt="none",
                    ecolor=INK, lw=1.4, capsize=3,
                zorder=4, label=None if column else "standard error",
            )  # fmt: skip
    # Each number next to its own mark: that of the bar above, that of the diamond below.
    ends = percent[:, :2] + np.nan_to_num(percent[:, 2:])
    for row, share in enumerate(percent[:, :2]):
        for column, (what, before, aside) in enumerate(
            (("own", "", -_ASIDE), ("total", "in all ", _ASIDE))
        ):
            text = f"{before}{with_decimals(share[column], 1)} %".replace("-", MINUS)
            axes.annotate(
                text, (max(ends[row, column], 0.0), row + aside), (9, 0),
                textcoords="offset points", va="center", fontsize=9, annotation_clip=False,
                gid=f"{what} of {names[row]}",
            )  # fmt: skip
    axes.set_yticks(rows, [in_lines(name, most=2) for name in names], parse_math=False)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.axvline(0.0, color=INK, lw=0.9)
    axes.set_xlim(min(0.0, 1.1 * float(percent[:, :2].min())), 1.24 * max(float(ends.max()), 1.0))
    axes.set_xlabel("share of the variance [%]")
    spread = labels.text(found.std, found.unit) if found.unit else f"{found.std:.4g}"
    axes.set_title(
        f"{in_lines(found.name, 50)}: standard deviation {spread}\nshares sum to "
        f"{percent[:, 0].sum():.0f} %",
        fontsize=10.5,
        parse_math=False,
    )
    axes.grid(axis="x", color=GREY, alpha=0.25, lw=0.6)
    axes.set_axisbelow(True)
    tidy(axes)
    legend_below(axes, 3)
    return axes


def _output(result: Any, output: Any) -> Output:
    if isinstance(result, Output) and output is None:
        return result
    if not isinstance(result, Propagation):
        what = (
            f"{type(result).__name__}"
            if not isinstance(result, Output)
            else "an output, and a name beside it"
        )
        raise InputError(
            "result must be what uncertainty.propagate returned, or one output of it without a "
            f"name, got {what}",
            code="bad_option",
            argument="result",
        )
    if output is None:
        if len(result) != 1:
            raise InputError(
                f"result has the outputs {', '.join(map(repr, result))}; say which one: "
                f"output={next(iter(result), '')!r}",
                code="no_output",
                argument="output",
            )
        output = next(iter(result))
    if not isinstance(output, str):
        raise InputError(
            f"output must be a name, got {shown(output)}", code="no_output", argument="output"
        )
    return result[output]
