"""How an uncertain output is distributed: shares of the cases, their mean, and the range that holds most of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..errors import InputError
from ..uncertainty.bounds import Bounds
from ..uncertainty.output import COVERAGE, Output
from ..unit_systems import UnitSystem
from .canvas import FORCE, GREY, INK, LIGHT, Units, begin, drawable, legend_below, number, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def distribution(
    output: Output, *, coverage: float = COVERAGE, bins: int = 40, axes: Axes | None = None, units: UnitSystem = "si"
) -> Axes:
    """The cases of an output that was sampled as a histogram, with mean, median and interval, given the stated inputs.

    Parameters
    ----------
    output : Output
        One output of what ``uncertainty.propagate`` returned, by a method that samples: ``result["delta_v"]``.
    coverage : float
        Probability of the interval that is shaded, as much left out below it as above.
    bins : int
        Number of bars.
    axes : matplotlib.axes.Axes, optional
        To draw on; by default that of a new figure.
    units : "si", "metric" or "us"
        For an output that the model returned as a Quantity. Others are labelled with their name alone.

    Returns
    -------
    matplotlib.axes.Axes
        By gid: "histogram", "mean", "median", "low", "high".

    Raises
    ------
    InputError
        Not an output, one that was not sampled, one with an Interval among its inputs, or without a spread.
    MissingInputError
        Without matplotlib.

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
    labels = Units(units)
    if not isinstance(output, Output):
        raise InputError(
            f"output must be one output of what uncertainty.propagate returned, got {type(output).__name__}; write "
            f"plot.distribution(result['delta_v'])",
            code="bad_option",
            argument="output",
        )
    if isinstance(output, Bounds):
        raise InputError(
            f"{output.name!r} has no one distribution, because an Interval among the inputs says nothing of likelihood; draw "
            f"that of an end of the interval: fix the input there and propagate again",
            code="no_variance",
            argument="output",
        )
    low, high = output.interval(coverage)
    histogram = output.histogram(bins)
    axes = begin(axes, (6.5, 4.6))
    unit = output.unit
    factor = labels.factor(unit) if unit else 1.0

    def told(value: Any) -> str:
        return labels.text(value, unit) if unit else number(value)

    axes.axvspan(low * factor, high * factor, color=LIGHT, alpha=0.5, lw=0, zorder=0)
    axes.stairs(
        100.0 * histogram.shares, histogram.edges * factor, fill=True, fc="#c9d6e6", ec=INK, lw=0.9, zorder=2, gid="histogram"
    )
    median = output.quantile(0.5)
    span = f"{100.0 * coverage:.4g} % interval, {told(low)} to {told(high)}"
    for gid, value, style, colour, text in (
        ("mean", output.mean, "-", FORCE, f"mean {told(output.mean)}"),
        ("median", median, (0, (1, 1.2)), INK, f"median {told(median)}"),
        ("low", low, (0, (6, 3)), INK, span),
        ("high", high, (0, (6, 3)), INK, None),
    ):
        axes.axvline(value * factor, color=colour, lw=1.7, ls=style, zorder=4, gid=gid, label=text)
    axes.set_ylim(0.0, 1.08 * 100.0 * float(histogram.shares.max()))
    axes.set_xlabel(drawable(labels.label(output.name, unit) if unit else output.name), parse_math=False)
    axes.set_ylabel("share of the cases [%]")
    axes.set_title("given the stated inputs", fontsize=10.5, color=GREY)
    tidy(axes)
    legend_below(axes)
    return axes
