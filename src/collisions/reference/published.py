"""``Published`` and ``Fit``: published values and formulas with source and range, and the handling
of inputs outside it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

import numpy as np

from ..messages.errors import InputError, OutOfRangeWarning
from ..messages.warning import warn_of_cases
from ..quantities.formatting import KIND_OF
from ..quantities.reading import ArgumentReader, single_number
from ..quantities.refusals import must_be
from ..quantities.tables import Sentences
from ..quantities.units import Input, Value, to_quantity

Outside: TypeAlias = Literal["warn", "refuse"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Published:
    """A published value or range.

    Parameters
    ----------
    name : str
        What the value is of.
    low, high : float
        Ends of the published range; equal for a single value.
    typical : float, optional
        The usual value, where one is stated.
    unit : str, optional
        SI unit, "" for a plain number.
    source : str
        Where it was published and where it was read.
    domain : str
        What it applies to.
    quality : str
        How good it is, in a sentence.

    Examples
    --------
    >>> from collisions import reference
    >>> friction = reference.INTER_VEHICLE_FRICTION
    >>> friction.low, friction.typical, friction.high, 1.2 in friction
    (0.3, 0.55, 1.0, False)
    """

    name: str
    low: float
    high: float
    typical: float | None = None
    unit: str = ""
    source: str
    domain: str
    quality: str

    @property
    def q(self) -> Any:
        """The same attributes, with the numbers as pint Quantities."""
        given = {name: getattr(self, name) for name in ("low", "high", "typical")}
        return replace(
            self,
            **{
                name: to_quantity(value, self.unit)
                for name, value in given.items()
                if value is not None
            },
        )

    def __contains__(self, value: Input) -> bool:
        """Whether a number in the SI unit, or with its unit, lies in the range."""
        reader = ArgumentReader()
        number = single_number(
            reader,
            reader.number(value, self.unit, "value"),
            "value",
            "must be one number; ask of each",
        )
        reader.close()
        return bool(self.low <= number <= self.high)


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """A published formula.

    Parameters
    ----------
    name : str
        What it gives.
    formula : str
        The formula as it is evaluated, in SI.
    unit : str
        SI unit of what it gives.
    ranges : dict of (float, float, str)
        By argument: lowest value, highest value and SI unit of the range for which it was found in
        use, or checked.
    source, domain, quality : str
        As for ``Published``.
    """

    name: str
    formula: str
    unit: str
    ranges: dict[str, tuple[float, float, str]]
    source: str
    domain: str
    quality: str

    @property
    def q(self) -> Any:
        """The same attributes, with the ends of the ranges as pint Quantities."""
        ranges: Any = {
            name: (to_quantity(low, unit), to_quantity(high, unit), unit)
            for name, (low, high, unit) in self.ranges.items()
        }
        return replace(self, ranges=ranges)


def check_outside(reader: ArgumentReader, outside: Any) -> None:
    """Raise unless ``outside`` is one of the choices."""
    if not isinstance(outside, str) or outside not in ("warn", "refuse"):
        reader.refuse(
            must_be(
                "outside", "'warn' (a value with a warning) or 'refuse'", outside, code="bad_option"
            )
        )


def settle(
    fit: Fit, found: Value, given: dict[str, Any], usable: Any, outside: str, say: Sentences
) -> Value:
    """The value of a fit; NaN for batch cases without one; inputs outside its ranges
    raise or warn. ``say`` writes a number.
    """
    spans = {
        name: f"{say(low, KIND_OF[unit], 4)} to {say(high, KIND_OF[unit], 4)}"
        for name, (low, high, unit) in fit.ranges.items()
    }
    ranges = ", ".join(
        span if len(spans) == 1 else f"{name} {span}" for name, span in spans.items()
    )
    beyond: Any = False
    for name, (low, high, _) in fit.ranges.items():
        beyond = beyond | (given[name] < low) | (given[name] > high)
    if not isinstance(found, np.ndarray):
        if beyond:
            _tell_of_one(fit, ranges, given, outside, say)
        return found
    lost = ~usable | (beyond if outside == "refuse" else False)
    answer = np.where(lost, np.array(math.nan, dtype=found.dtype), found)
    answer.setflags(write=False)
    counts = {
        "outside_reference": int(np.count_nonzero(beyond & ~lost)),
        "refused": int(np.count_nonzero(lost)),
    }
    if any(counts.values()):
        warn_of_cases(
            OutOfRangeWarning(
                f"{fit.name}: of {found.size} cases {counts['outside_reference']} lie outside "
                f"the range it holds for ({ranges}), and {counts['refused']} have no answer and "
                "are NaN",
                code="outside_reference",
                counts=counts,
            ),
            {
                f"{fit.name} outside the range it holds for ({ranges}) or without an answer": (
                    np.broadcast_to(beyond | lost, found.shape)
                )
            },
        )
    return answer


def _tell_of_one(
    fit: Fit, ranges: str, given: dict[str, Any], outside: str, say: Sentences
) -> None:
    where = ", ".join(
        f"{name} {say(given[name], KIND_OF[unit])}" for name, (_, _, unit) in fit.ranges.items()
    )
    text = f"{fit.name}: {where} lies outside the range it holds for, {ranges} ({fit.source})"
    if outside == "refuse":
        raise InputError(
            (f"{text}; give a measured value, or accept one from outside with `outside='warn'`"),
            code="outside_reference",
            argument=next(iter(fit.ranges)),
        )
    end = "the value is an extrapolation"
    warn_of_cases(
        OutOfRangeWarning(f"{text}; {end}", code="outside_reference", given=given),
        {f"{fit.name} outside the range it holds for, {ranges} ({fit.source}); {end}": None},
    )
