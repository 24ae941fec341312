"""Uncertain inputs: ``Uniform``, ``Triangular``, ``Samples``, and ``Interval``, which only bounds a quantity."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from numbers import Number
from typing import Any

import numpy as np

from ..errors import InputError, ShapeError, UnitsError
from ..hints import hinted
from ..kernels.elementwise import UNCHECKED
from ..quantities import lock
from ..reading import ArgumentReader
from ..units import Input, is_quantity, si_unit
from .distribution import Distribution, Stated, check_order, from_numbers, read_alike, show
from .normal import power_of_two
from .normal_family import LogNormal, Normal

__all__ = ["Distribution", "Interval", "LogNormal", "Normal", "Samples", "Triangular", "Uniform", "read_input"]


class Uniform(Distribution):
    """A quantity equally likely to lie anywhere between two bounds: a claim in itself, which ``Interval`` does not make.

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
        self._describe(0.5 * low + 0.5 * high, (high - low) / math.sqrt(12.0), 0.0, 1.8, (low, high))

    def _at(self, below: Any, above: Any) -> Any:
        low, high = self.support
        width = high - low
        # The form, from the lower end or from the upper one, that keeps the digits.
        return np.where(below <= above, low + width * below, high - width * above)


class Triangular(Distribution):
    """A quantity between two bounds with a most likely value, from which the density falls in straight lines to either bound.

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
            raise self._too_large()
        left, right = (mode - low) / width, (high - mode) / width
        square = (left * left + left * right + right * right) / 18.0
        skewness = (right - left) * (2.0 * left + right) * (left + 2.0 * right) / (270.0 * square * math.sqrt(square))
        self._describe(low + width * (1.0 + left) / 3.0, width * math.sqrt(square), skewness, 2.4, (low, high))

    def _at(self, below: Any, above: Any) -> Any:
        low, high = self.support
        width = high - low
        left, right = (self.mode - low) / width, (high - self.mode) / width
        rising, falling = low + width * np.sqrt(left * below), high - width * np.sqrt(right * above)
        return np.clip(np.where(below <= left, rising, falling), low, high)


class Samples(Distribution):
    """A quantity known from values that were measured or drawn elsewhere, all equally likely.

    The empirical distribution, with no values between the given ones or beyond. ``sd`` is that of the values themselves,
    with their number as the divisor, not an estimate for the population they came from.

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
        """Quantities that were measured together: each draw takes the same row of all, which keeps their dependence.

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
                f"joint needs columns of one length, one value of each in a row; got {listed or 'none'}", code="bad_shape"
            )
        group = os.urandom(8).hex() if len(columns) > 1 else None
        return {
            name: from_numbers(cls, unit, {"rows": _checked(column, name), "group": group})
            for name, ((column,), unit) in columns.items()
        }

    def _derive(self, rows: Any, group: str | None) -> None:
        ordered = lock(np.sort(rows))
        self._set(rows=lock(rows), group=group, _sorted=ordered)
        with np.errstate(over="ignore", invalid="ignore"):
            away = rows - rows[0]
            scale = power_of_two(away)
            away /= scale
            mean = float(np.mean(away))
            away -= mean
            sd = float(np.sqrt(np.mean(away**2)))
            away /= sd
            moments = float(rows[0]) + scale * mean, scale * sd, float(np.mean(away**3)), float(np.mean(away**4))
        self._describe(*moments, support=(float(ordered[0]), float(ordered[-1])))

    def __hash__(self) -> int:
        return hash((type(self), self.unit, self.group, self.rows.tobytes()))

    def __repr__(self) -> str:
        joint = ", joint" if self.group is not None else ""
        return f"Samples({self.rows.size} values, mean={show(self.mean, self.unit)}, sd={show(self.sd, self.unit)}{joint})"

    def __str__(self) -> str:
        low, high = (show(end, self.unit) for end in self.support)
        return f"one of {self.rows.size} values from {low} to {high}"

    def _at(self, below: Any, above: Any) -> Any:
        return self._sorted[np.minimum(np.floor(below * self.rows.size).astype(np.intp), self.rows.size - 1)]


def _checked(rows: Any, argument: str) -> Any:
    """A fresh row of finite values that are not all the same."""
    if rows.ndim != 1:
        raise ShapeError(f"{argument} must be one row of values, got shape {rows.shape}", code="bad_shape", argument=argument)
    if not np.all(np.isfinite(rows)):
        raise InputError(
            f"{argument}: value {int(np.argmin(np.isfinite(rows)))} is not a finite number; leave out what was not measured",
            code="not_finite",
            argument=argument,
        )
    if rows.size < 2 or rows.min() == rows.max():
        raise InputError(
            f"{argument} must hold at least two different values, got {rows.size}{' that are all the same' * (rows.size > 1)}; "
            f"of a quantity that is known exactly give the number itself",
            code="no_spread",
            argument=argument,
        )
    return rows.astype(np.float64)


class Interval(Stated):
    """Two bounds between which a quantity lies, and nothing more: no value is said to be likelier than another.

    Not a distribution: it is never sampled as if it were uniform. Mixed with distributions, it gives bounds on quantiles.

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


def read_input(name: str, value: Any) -> Any:
    """The input for a model: a stated input or other object as it is, a number or a text as an SI float.

    Raises
    ------
    InputError
        A boolean, NaN, an array or a list of numbers, or a text that is not a number with a unit.

    Examples
    --------
    >>> read_input("speed", "36 km/h"), read_input("restitution", 0.4), read_input("point", (2.1, 0.3))
    (10.0, 0.4, (2.1, 0.3))
    """
    if isinstance(value, (tuple, list)) and any(
        isinstance(part, (str, Distribution, Interval)) or is_quantity(part) for part in value
    ):
        raise InputError(
            f"{name} is a {type(value).__name__} with a unit or a distribution in it; give each part as an input of its own, "
            f"and put them together in the model{range_hint(value)}",
            code="bad_inputs",
            argument=name,
        )
    if isinstance(value, list) and value and all(isinstance(part, (Number, np.generic)) for part in value):
        raise ShapeError(
            f"{name} is a list of {len(value)} number{'s' * (len(value) > 1)}; measured values are given as Samples(values), "
            f"the parts of a point as a tuple, and what the model needs as an array is written into the model itself",
            code="bad_shape",
            argument=name,
        )
    if not (isinstance(value, (str, Number, np.generic)) or is_quantity(value) or hasattr(value, "__array__")):
        return value
    try:
        unit = si_unit(value, name)
    except UnitsError as error:
        if not isinstance(value, str):
            raise
        raise UnitsError(
            f"{error}; a text that is no quantity, such as the name of a law, is written into the model itself",
            code=error.code,
            **error.fields,
        ) from None
    reader = ArgumentReader()
    number = reader.number(value, unit, name, UNCHECKED)
    reader.close()
    if isinstance(number, np.ndarray):
        raise ShapeError(
            f"{name} is an array of shape {number.shape}; measured values are given as Samples(values), and what the model "
            f"needs as an array is written into the model itself",
            code="bad_shape",
            argument=name,
        )
    if math.isnan(number):
        raise InputError(
            f"{name} is NaN; give a number, or a distribution of what is not known", code="not_finite", argument=name
        )
    return number


def pair_hints(fixed: Mapping[str, Any]) -> str:
    """Hints for inputs that are pairs of numbers in order: they are read as points, but may be meant as ranges."""
    return "".join(
        f". {name} is the pair {value!r} in every case{hint}" for name, value in fixed.items() if (hint := range_hint(value))
    )


def range_hint(value: Any) -> str:
    """A hint for a pair of numbers or texts in order that may be meant as a range; "" for others."""
    kinds = {type(part) for part in value} if isinstance(value, (tuple, list)) and len(value) == 2 else {None}
    rising = kinds == {str} or (kinds <= {int, float} and value[0] < value[1])
    return f"; if a range was meant, write Uniform{tuple(value)!r} or Interval{tuple(value)!r}" if rising else ""
