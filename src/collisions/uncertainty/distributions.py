"""``Uniform``, ``Triangular``, ``Samples``, and bounds alone: ``Interval`` for an input,
``Censored`` for a reading.
"""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np

from ..messages.errors import InputError, MissingInputError, ShapeError
from ..messages.hints import hinted
from ..quantities.attributes import read_only
from ..quantities.refusals import must_be
from ..quantities.units import Input
from .distribution import (
    Distribution,
    Statement,
    check_order,
    from_numbers,
    narrowest,
    read_alike,
    show,
)
from .normal import power_of_two
from .normal_family import LogNormal, Normal

__all__ = [
    "Censored",
    "Distribution",
    "Interval",
    "LogNormal",
    "Normal",
    "Samples",
    "Triangular",
    "Uniform",
]


class Uniform(Distribution):
    """A quantity equally likely to lie anywhere between two bounds: a claim in itself, which
    ``Interval`` does not make.

    Parameters
    ----------
    low, high : float, str or Quantity
        The bounds, ``low`` < ``high``. SI, or both with a unit.

    Raises
    ------
    InputError
        Bounds not in order.
    UnitsError
        One bound with a unit and one without, or units of different kinds.

    Examples
    --------
    A reading to the nearest 5 degrees.

    >>> Uniform("42.5 deg", "47.5 deg")
    Uniform(low=42.5 deg, high=47.5 deg)
    """

    __slots__ = ()

    _words = "{low} to {high}, all values equally likely"

    @hinted
    def __init__(self, low: Input, high: Input) -> None:
        (start, end), unit = read_alike({"low": low, "high": high})
        self._make(unit, low=start, high=end)

    def _derive(self, low: float, high: float) -> None:
        check_order(low, high, unit=self.unit)
        self._describe(
            0.5 * low + 0.5 * high, (high - low) / math.sqrt(12.0), 0.0, 1.8, (low, high)
        )

    def _at(self, below: Any, above: Any) -> Any:
        low, high = self.support
        width = high - low
        # The form, from the lower end or from the upper one, that keeps the digits.
        return np.where(below <= above, low + width * below, high - width * above)


class Triangular(Distribution):
    """A quantity between two bounds with a most likely value, from which the density falls in
    straight lines to either bound.

    Parameters
    ----------
    low, mode, high : float, str or Quantity
        ``low`` <= ``mode`` <= ``high`` and ``low`` < ``high``. SI, or all with a unit.

    Raises
    ------
    InputError
        Values not in order.
    UnitsError
        Some values with a unit and some without, or units of different kinds.

    Examples
    --------
    >>> Triangular(0.6, 0.7, 0.75).quantile(0.5)
    0.6866025403784438
    """

    __slots__ = ("mode",)

    _words = "{low} to {high}, most likely {mode}"

    mode: float

    @hinted
    def __init__(self, low: Input, mode: Input, high: Input) -> None:
        (start, middle, end), unit = read_alike({"low": low, "mode": mode, "high": high})
        self._make(unit, low=start, mode=middle, high=end)

    def _derive(self, low: float, mode: float, high: float) -> None:
        check_order(low, high, unit=self.unit)
        if not low <= mode <= high:
            least, most, given = (show(value, self.unit) for value in (low, high, mode))
            raise InputError(
                f"mode must be from low to high, {least} to {most}, got {given}",
                code="bad_range",
                argument="mode",
            )
        self._set(mode=mode)
        width = high - low
        if math.isinf(width):
            raise self._beyond_floats()
        left, right = (mode - low) / width, (high - mode) / width
        square = (left * left + left * right + right * right) / 18.0
        skewness = (
            (right - left)
            * (2.0 * left + right)
            * (left + 2.0 * right)
            / (270.0 * square * math.sqrt(square))
        )
        self._describe(
            low + width * (1.0 + left) / 3.0, width * math.sqrt(square), skewness, 2.4, (low, high)
        )

    def _at(self, below: Any, above: Any) -> Any:
        low, high = self.support
        width = high - low
        left, right = (self.mode - low) / width, (high - self.mode) / width
        rising, falling = low + width * np.sqrt(left * below), high - width * np.sqrt(right * above)
        return np.clip(np.where(below <= left, rising, falling), low, high)


class Samples(Distribution):
    """A quantity known from values that were measured or drawn elsewhere, all equally likely.

    The empirical distribution, with no values between the given ones or beyond. ``sd`` is that of
    the values themselves, with their number as the divisor, not an estimate for the population they
    came from.

    Parameters
    ----------
    values : array, sequence or Quantity
        At least two values that are not all the same; SI, or one Quantity with its unit.

    Attributes
    ----------
    rows : array
        The values in the given order [SI], locked.
    group : str or None
        A text shared by all Samples that are drawn together; None for one drawn alone.

    Raises
    ------
    InputError
        Too few values, or values that are all the same or not finite.

    Examples
    --------
    Drag factors of four skid tests.

    >>> drag = Samples([0.68, 0.71, 0.74, 0.71])
    >>> drag
    Samples(4 values, mean=0.71, sd=0.02121)
    >>> drag.quantile(0.9)
    0.74
    """

    __slots__ = ("_sorted", "group", "rows")

    rows: Any
    group: str | None
    _sorted: Any

    @hinted
    def __init__(self, values: Any) -> None:
        (rows,), unit = read_alike({"values": values}, arrays=True)
        self._make(unit, rows=_checked(rows, "values"), group=None)

    @classmethod
    def joint(cls, /, **values: Any) -> dict[str, Samples]:
        """Quantities that were measured together: each draw takes the same row of all, which keeps
        their dependence.

        Parameters
        ----------
        **values : array, sequence or Quantity
            One column for each input, all of the same length. Each has its own unit.

        Returns
        -------
        dict
            The Samples by name, to be passed to ``propagate`` as they are.

        Raises
        ------
        ShapeError
            Columns of different lengths.

        Examples
        --------
        >>> tests = Samples.joint(drag=[0.68, 0.71, 0.74], speed=[14.9, 15.2, 15.1])
        >>> tests["drag"].group == tests["speed"].group
        True
        """
        columns = {name: read_alike({name: column}, arrays=True) for name, column in values.items()}
        lengths = {name: np.size(column) for name, ((column,), _) in columns.items()}
        if not columns or len(set(lengths.values())) > 1:
            listed = ", ".join(f"{name} {length}" for name, length in lengths.items())
            raise ShapeError(
                "joint needs columns of one length, one value of each in a row; got "
                f"{listed or 'none'}",
                code="bad_shape",
            )
        group = os.urandom(8).hex() if len(columns) > 1 else None
        return {
            name: from_numbers(cls, unit, {"rows": _checked(column, name), "group": group})
            for name, ((column,), unit) in columns.items()
        }

    def _derive(self, rows: Any, group: str | None) -> None:
        ordered = read_only(np.sort(rows))
        self._set(rows=read_only(rows), group=group, _sorted=ordered)
        with np.errstate(over="ignore", invalid="ignore"):
            away = rows - rows[0]
            scale = power_of_two(away)
            away /= scale
            mean = float(np.mean(away))
            away -= mean
            sd = float(np.sqrt(np.mean(away**2)))
            away /= sd
            moments = (
                float(rows[0]) + scale * mean,
                scale * sd,
                float(np.mean(away**3)),
                float(np.mean(away**4)),
            )
        self._describe(*moments, support=(float(ordered[0]), float(ordered[-1])))

    def __hash__(self) -> int:
        return hash((type(self), self.unit, self.group, self.rows.tobytes()))

    def __repr__(self) -> str:
        joint = ", joint" if self.group is not None else ""
        return (
            f"Samples({self.rows.size} values, mean={show(self.mean, self.unit)}, "
            f"sd={show(self.sd, self.unit)}{joint})"
        )

    def __str__(self) -> str:
        low, high = (show(end, self.unit, narrowest(*self.support)) for end in self.support)
        return f"one of {self.rows.size} values from {low} to {high}"

    def _at(self, below: Any, above: Any) -> Any:
        return self._sorted[
            np.minimum(np.floor(below * self.rows.size).astype(np.intp), self.rows.size - 1)
        ]


def _checked(rows: Any, argument: str) -> Any:
    """A fresh row of finite values that are not all the same."""
    if rows.ndim != 1:
        raise ShapeError(
            f"{argument} must be one row of values, got shape {rows.shape}",
            code="bad_shape",
            argument=argument,
        )
    if not np.all(np.isfinite(rows)):
        raise InputError(
            f"{argument}: value {int(np.argmin(np.isfinite(rows)))} is not a finite number; "
            "leave out what was not measured",
            code="not_finite",
            argument=argument,
        )
    if rows.size < 2 or rows.min() == rows.max():
        raise InputError(
            f"{argument} must hold at least two different values, got "
            f"{rows.size}{' that are all the same' * (rows.size > 1)}; of a quantity that is "
            "known exactly give the number itself",
            code="no_spread",
            argument=argument,
        )
    return rows.astype(np.float64)


class Interval(Statement):
    """Two bounds between which a quantity lies, and nothing more: no value is said to be likelier
    than another.

    Not a distribution: it is never sampled as if it were uniform. Mixed with distributions, it
    gives bounds on quantiles.

    Parameters
    ----------
    low, high : float, str or Quantity
        The bounds, ``low`` < ``high``. SI, or both with a unit.

    Attributes
    ----------
    low, high : float
        The bounds in SI.
    unit : str
        Their SI unit, "" when none was given.

    Raises
    ------
    InputError
        Bounds not in order.
    UnitsError
        One bound with a unit and one without, or units of different kinds.

    Examples
    --------
    >>> Interval("1400 kg", "1650 kg")
    Interval(low=1400 kg, high=1650 kg)
    """

    __slots__ = ("high", "low")

    _words = "{low} to {high}, no distribution assumed"

    low: float
    high: float

    @hinted
    def __init__(self, low: Input, high: Input) -> None:
        (start, end), unit = read_alike({"low": low, "high": high})
        self._make(unit, low=start, high=end)

    def _derive(self, low: float, high: float) -> None:
        check_order(low, high, unit=self.unit)
        self._set(low=low, high=high)


class Censored(Statement):
    """A reading known only to lie above a bound, below one, or between two.

    A recorder that ended early would have read at least what it had reached; a speed class or a
    display in steps gives two values with the reading between them. As evidence, it is weighted by
    the probability that a reading falls within the bounds, where readings are normally distributed
    about the truth with the standard deviation ``error``. Without an error, the truth itself lies
    within the bounds, and an observation ``Interval(low, high)`` says the same.

    Parameters
    ----------
    low, high : float, str or Quantity, optional
        The bounds, ``low`` < ``high``; give at least one. SI, or all with a unit.
    error : float, str or Quantity, optional
        Standard deviation of the reading, > 0, in the same unit; without it the bounds are sharp.

    Raises
    ------
    InputError
        No bound, bounds not in order, or an error not above 0.
    UnitsError
        Some numbers with a unit and some without, or units of different kinds.

    Examples
    --------
    The recorder lost power after a delta-V of 28 km/h; its standard deviation is 1 km/h.

    >>> Censored(low="28 km/h", error="1 km/h")
    Censored(low=28 km/h, error=1 km/h)
    """

    __slots__ = ("error", "high", "low")

    low: float | None
    high: float | None
    error: float | None

    @hinted
    def __init__(
        self, low: Input | None = None, high: Input | None = None, error: Input | None = None
    ) -> None:
        (start, end, sigma), unit = read_alike({}, {"low": low, "high": high, "error": error})
        self._make(unit, low=start, high=end, error=sigma)

    def _derive(self, low: float | None, high: float | None, error: float | None) -> None:
        if low is None and high is None:
            raise MissingInputError(
                "a censored reading needs a bound; write `Censored(low=...)` for at least, "
                "`Censored(high=...)` for at most",
                code="missing_bound",
                argument="low",
            )
        if low is not None and high is not None:
            check_order(low, high, unit=self.unit)
        if error is not None and not error > 0.0:
            raise must_be(
                "error",
                "> 0",
                error,
                "; leave it out where the bounds are sharp",
                code="not_positive",
                got=show(error, self.unit),
            )
        self._set(low=low, high=high, error=error)

    def __str__(self) -> str:
        bounds = (("at least", self.low), ("at most", self.high), ("±", self.error))
        within = min(narrowest(self.low, self.high), narrowest(0.0, self.error))
        return ", ".join(
            f"{word} {show(value, self.unit, within)}"
            for word, value in bounds
            if value is not None
        )
