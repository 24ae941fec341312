"""Shared by all pictures: matplotlib, the Axes, the units of the labels, and the check that the
impact is solved.
"""

from __future__ import annotations

import math
import re
import textwrap
from typing import TYPE_CHECKING, Any, TypeAlias

from ..impact.impact import Impact
from ..messages.errors import InputError, MissingInputError
from ..quantities.formatting import (
    KIND_OF,
    SI_UNITS,
    decimals_of,
    in_words,
    number_with_unit,
    places,
    typeset,
    with_decimals,
)
from ..quantities.printed_tables import path_parted
from ..quantities.reading import need_one_case
from ..quantities.tables import Summarized, cells, given_texts
from ..quantities.units import shown
from ..vehicle.vehicle import Vehicle, named

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure

# Types of matplotlib by name, as it is imported when something is drawn.
Axes: TypeAlias = "matplotlib.axes.Axes"
Figure: TypeAlias = "matplotlib.figure.Figure"

INK, GREY, LIGHT = "#1a1a1a", "#6a6a6a", "#d0d0d0"
SIDES = ("a", "b")
COLOURS = ("#1f5fa8", "#b3541e")
FORCE = "#a01040"
BARS, GRID = "#c9d6e6", "#e2e2e2"
THIN, MINUS = "\u2009", "\u2212"  # between thousands, and before a number
_WIDTH = 26  # characters of a name on one line
_PART = "\x1f "  # where a path may break
_MOST_DECIMALS = 6
SMALLEST, LARGEST = 1e-100, 1e100
_RESOLVED = 1e-12  # of the coordinates: a picture smaller than this is made of their rounding


class Units:
    """The units a picture is labelled in, by kind of quantity or by SI unit; others, and no unit,
    stay as they are.
    """

    def __init__(self, system: Any, of: Summarized | None = None) -> None:
        self._system = cells(system, given_texts(of) if isinstance(of, Summarized) else ())

    def factor(self, unit: str | None) -> float:
        """The factor from this SI unit to the unit shown."""
        kind = _kind(unit)
        return 1.0 if kind is None else self._system.scale(kind)

    def name(self, unit: str | None) -> str:
        """The name of the unit shown for this SI unit."""
        kind = _kind(unit)
        return typeset((unit or "") if kind is None else self._system.label(kind))

    def label(self, what: str, unit: str | None) -> str:
        """The label of an axis: its quantity and unit."""
        return f"{what} [{self.name(unit)}]" if unit else what

    def text(self, value: float, unit: str | None) -> str:
        """A number in this SI unit with the unit it is shown in."""
        kind = _kind(unit)
        decimals = None if kind is None else decimals_of(kind, self._system.name)
        text = number(value * self.factor(unit), _MOST_DECIMALS if decimals is None else decimals)
        return number_with_unit(text, self.name(unit)) if math.isfinite(value) else text

    def to_deviation(self, value: float, unit: str | None, deviation: float) -> str:
        """A number in this SI unit, rounded to its standard deviation as tables have it."""
        kind = _kind(unit) if unit else "number"
        if kind is None or not math.isfinite(value):
            return self.text(value, unit)
        return self._system.span(value, value, kind, deviation).replace("-", MINUS)


def _kind(unit: str | None) -> str | None:
    if not unit:
        return None
    return unit if unit in SI_UNITS else KIND_OF.get(unit)


def number(value: float, decimals: int = _MOST_DECIMALS) -> str:
    """Four figures, without an exponent where people expect none, and no more decimals than these
    unless all would be 0.
    """
    size = abs(value)
    if not math.isfinite(value):
        return in_words(value)
    if size != 0.0 and not 1e-4 <= size < 1e9:
        text = f"{value:.3e}"
    else:
        wanted = 0 if size == 0.0 else places(value, 4)
        thousands = THIN if size >= 9999.5 else ""
        text = with_decimals(
            value, min(wanted, decimals) if size >= 0.5 * 10.0**-decimals else wanted, thousands
        )
    return text.replace("-", MINUS)


def check_impact(impact: Impact, function: str, impulse: bool = False, runs: bool = False) -> None:
    """Raise unless it is a single solved impact with numbers that can be drawn, and an impulse
    where one is needed; ``runs`` says that the function takes a ``Run`` too.
    """
    spread = ", or draw a spread with plot.distribution(propagate(...)['...'])"
    need_one_case(impact, (Impact,), f"plot.{function}", many=spread, runs=runs)
    for side in (impact.a, impact.b):
        check_size("mass", side.before.mass if math.isfinite(side.before.mass) else 0.0)
        for state in (side.before, side.after):
            for name in ("vx", "vy", "yaw_rate", "x", "y"):
                check_size(name, getattr(state, name) or 0.0)
    check_size("energy_loss", impact.energy_loss)
    for name in ("closing_speed", "normal_impulse"):
        check_size(name, getattr(impact, name), least=SMALLEST)
    if impulse and impact.pulse is not None:
        raise InputError(
            f"impact was followed in time, and {function} draws an impulse; write "
            "plot.pulse(impact)",
            code="takes_time",
            argument="impact",
        )


def check_size(name: str, value: float, least: float = 0.0) -> None:
    """Raise if a number is too large, or smaller than ``least``, for axes to be laid out."""
    if not least <= abs(value) <= LARGEST:
        raise InputError(
            f"{name} = {value:.3g} cannot be drawn: a picture shows what is between {SMALLEST:g} "
            f"and {LARGEST:g} in SI; look for a wrong unit or a slipped digit",
            code="out_of_range",
            argument=name,
        )


def size_of(known: list[tuple[float, float]], labels: Units, sketched: bool) -> float:
    """The larger extent of the places, or of vehicles where all the places coincide."""
    size = max(max(place[i] for place in known) - min(place[i] for place in known) for i in (0, 1))
    farthest = max(abs(part) for place in known for part in place)
    length = labels.factor("m")
    if max(size, 4.0 * length) < _RESOLVED * farthest or size > LARGEST:
        raise InputError(
            f"there is no picture of {labels.text(size / length, 'm')} that lies "
            f"{labels.text(farthest / length, 'm')} from the origin of its coordinates; count x "
            "and y from a place near the contact, and check positions and outlines",
            code="out_of_range",
            argument="impact",
        )
    return max(size, 4.0 * length) if sketched or size <= 1e-6 * farthest else size


def who(index: int, vehicle: Vehicle) -> str:
    """The letter of a vehicle, and its name if that says more, in short lines."""
    letter = "AB"[index]
    if vehicle.name in ("", letter):
        return letter
    return in_lines(f"{letter} ({named(vehicle.name)})")


def drawable(text: str) -> str:
    """The text with a mark in place of each lone surrogate, which no font has."""
    return text.encode("utf-16", "surrogatepass").decode("utf-16", "replace")


def in_lines(text: str, width: int = _WIDTH, most: int = 3) -> str:
    """A text broken into lines of this length; the rest after so many lines is cut off
    with a mark.
    """
    text = drawable(text)
    if len(text) <= width:
        return text
    # A path too long for a line breaks between its parts rather than within a word.
    parted = re.sub(rf"\S{{{width + 1},}}", lambda path: path_parted(path[0], _PART), text)
    lines = textwrap.wrap(parted, width, max_lines=most, placeholder="\u2026")
    return "\n".join(line.replace(_PART, "").replace(_PART[0], "") for line in lines)


def begin(axes: Any, size: tuple[float, float] = (7.0, 5.0)) -> Axes:
    """The given Axes, or new ones in a new figure."""
    try:
        import matplotlib.axes
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise MissingInputError(
            f"collisions.plot needs matplotlib, which cannot be imported ({error}); write: "
            "python -m pip install matplotlib",
            code="missing_matplotlib",
            argument="matplotlib",
        ) from error
    if axes is None:
        made: Axes = plt.subplots(figsize=size, layout="constrained")[1]
        return made
    if not isinstance(axes, matplotlib.axes.Axes) or axes.name != "rectilinear":
        raise InputError(
            f"axes must be one Axes with x and y, got {shown(axes)} of type "
            f"{type(axes).__name__}; write figure, axes = matplotlib.pyplot.subplots() and give "
            "axes",
            code="bad_option",
            argument="axes",
        )
    # Axes that held a scene are still of equal scales, which clear() leaves: other pictures would
    # be needles.
    axes.set_aspect("auto")
    axes.apply_aspect()
    return axes


def tidy(axes: Axes, in_full: tuple[int, int] = (-3, 6)) -> None:
    """Hide unneeded spines; write tick labels in full, or with a power of ten at the axis's end
    outside this range.
    """
    from matplotlib.ticker import ScalarFormatter

    from .ticks import PlainTicks

    axes.spines[["top", "right"]].set_visible(False)
    for axis in (axes.xaxis, axes.yaxis):
        if isinstance(axis.get_major_formatter(), ScalarFormatter):
            axis.set_major_formatter(PlainTicks(in_full))


def legend_below(axes: Axes, columns: int = 2) -> None:
    """A legend under the labels of the x axis, where it hides nothing."""
    from matplotlib.transforms import ScaledTranslation

    # In points, so that it keeps clear of them on small Axes too.
    below = 30 + 14 * (axes.get_xlabel().count("\n") + 1)
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        bbox_transform=axes.transAxes
        + ScaledTranslation(0.0, -below / 72.0, axes.figure.dpi_scale_trans),
        borderaxespad=0.0,
        ncols=columns,
        frameon=False,
        fontsize=9,
        handlelength=3.4,
    )
