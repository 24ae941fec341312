"""The inputs of an uncertainty: what is known of a quantity, as a distribution or as nothing but two bounds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from numbers import Number
from typing import Any

import numpy as np

from ..errors import InputError, ShapeError, UnitsError
from ..kernels.elementwise import UNCHECKED
from ..reading import ArgumentReader
from ..units import Input, is_quantity, si_unit
from .distribution import Distribution, Stated, check_order, read_alike
from .normal_family import LogNormal, Normal
from .samples import Samples

__all__ = ["Distribution", "Interval", "LogNormal", "Normal", "Samples", "Triangular", "Uniform", "read_input"]


class Uniform(Distribution):
    """A quantity that is as likely anywhere between two bounds: a claim of its own, which ``Interval`` does not make.

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
    Uniform(low=0.7418 rad, high=0.829 rad)
    """

    __slots__ = ()

    def __init__(self, low: Input, high: Input) -> None:
        (start, end), unit = read_alike({"low": low, "high": high})
        self._make(unit, start, end)

    def _make(self, unit: str, *parts: Any) -> None:
        low, high = parts
        check_order(low, high, unit=unit)
        self._set(unit=unit, support=(low, high))
        self._describe(0.5 * low + 0.5 * high, (high - low) / math.sqrt(12.0), 0.0, 1.8, (low, high))

    def _parts(self) -> dict[str, Any]:
        return {"low": self.support[0], "high": self.support[1]}

    def _at(self, below: Any, above: Any) -> Any:
        low, high = self.support
        width = high - low
        return _chosen(below <= above, low + width * below, high - width * above)


class Triangular(Distribution):
    """A quantity between two bounds with a most likely value, from which the likelihood falls in straight lines.

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

    mode: float

    def __init__(self, low: Input, mode: Input, high: Input) -> None:
        (start, middle, end), unit = read_alike({"low": low, "mode": mode, "high": high})
        self._make(unit, start, middle, end)

    def _make(self, unit: str, *parts: Any) -> None:
        low, mode, high = parts
        check_order(low, high, unit=unit)
        if not low <= mode <= high:
            raise InputError(
                f"mode must be from low to high, {low:.6g} to {high:.6g}, got {mode:.6g}", code="bad_range", argument="mode"
            )
        self._set(unit=unit, mode=mode, support=(low, high))
        width = high - low
        if math.isinf(width):
            raise self._too_large()
        left, right = (mode - low) / width, (high - mode) / width
        square = (left * left + left * right + right * right) / 18.0
        skewness = (right - left) * (2.0 * left + right) * (left + 2.0 * right) / (270.0 * square * math.sqrt(square))
        self._describe(low + width * (1.0 + left) / 3.0, width * math.sqrt(square), skewness, 2.4, (low, high))

    def _parts(self) -> dict[str, Any]:
        return {"low": self.support[0], "mode": self.mode, "high": self.support[1]}

    def _at(self, below: Any, above: Any) -> Any:
        low, high = self.support
        width = high - low
        left, right = (self.mode - low) / width, (high - self.mode) / width
        rising, falling = low + width * np.sqrt(left * below), high - width * np.sqrt(right * above)
        value = np.clip(_chosen(below <= left, rising, falling), low, high)
        return value if isinstance(below, np.ndarray) else float(value)


class Interval(Stated):
    """Two bounds between which a quantity lies, and nothing else: no value is said to be likelier than another.

    Not a distribution: it is never sampled as if it were uniform. Mixed with distributions it gives bounds on quantiles.

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

    low: float
    high: float

    def __init__(self, low: Input, high: Input) -> None:
        (start, end), unit = read_alike({"low": low, "high": high})
        self._make(unit, start, end)

    def _make(self, unit: str, *parts: Any) -> None:
        low, high = parts
        check_order(low, high, unit=unit)
        self._set(unit=unit, low=low, high=high)

    def _parts(self) -> dict[str, Any]:
        return {"low": self.low, "high": self.high}


def read_input(name: str, value: Any) -> Any:
    """What a model is to be called with: a stated input or another object as it is, a number or a text as an SI float.

    Raises
    ------
    InputError
        A boolean, NaN, an array or a list of numbers, or a text that is no number with a unit.

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
            f"and put them together in the model",
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
    """What to write for pairs of numbers in order, which as inputs are places in the scene, if they were meant as ranges."""
    return "".join(
        f". {name} is the pair {value!r} in every case{hint}" for name, value in fixed.items() if (hint := range_hint(value))
    )


def range_hint(value: Any) -> str:
    """What to write for a pair of numbers in order, or of texts, if it was meant as a range; "" for others."""
    kinds = {type(part) for part in value} if isinstance(value, (tuple, list)) and len(value) == 2 else {None}
    rising = kinds == {str} or (kinds <= {int, float} and value[0] < value[1])
    return f"; if a range was meant, write Uniform{tuple(value)!r} or Interval{tuple(value)!r}" if rising else ""


def _chosen(lower: Any, rising: Any, falling: Any) -> Any:
    """The one of two forms that keeps its digits at this end."""
    return np.where(lower, rising, falling) if isinstance(lower, np.ndarray) else rising if lower else falling
