"""Samples: a quantity known from the user's own values, alone or together with others."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from ..errors import InputError, ShapeError
from ..quantities import lock
from .distribution import Distribution, read_alike, show
from .normal import power_of_two


class Samples(Distribution):
    """A quantity known from values that were measured or drawn elsewhere, each as likely as the others.

    The empirical distribution: nothing is put between the values or beyond them. ``sd`` is that of the values themselves,
    with their number as the divisor, not an estimate of that of a population they came from.

    Parameters
    ----------
    values : array, sequence or Quantity
        At least two values that are not all the same; SI, or one Quantity with its unit.

    Attributes
    ----------
    rows : array
        The values in the given order [SI], locked.
    group : str or None
        What those have in common that are drawn together; None when drawn alone.

    Raises
    ------
    InputError
        Values that are too few, all the same, or not finite.

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

    def __init__(self, values: Any) -> None:
        (rows,), unit = read_alike({"values": values}, arrays=True)
        self._make(unit, _checked(rows, "values"), None)

    @classmethod
    def joint(cls, /, **values: Any) -> dict[str, Samples]:
        """Quantities that were measured together: a draw takes the same row of each, so that what binds them is kept.

        Parameters
        ----------
        **values : array, sequence or Quantity
            One column for each input; all of one length. Each has a unit of its own.

        Returns
        -------
        dict
            The Samples by name, to be given to ``propagate`` as they are.

        Raises
        ------
        ShapeError
            Columns that are not of one length.

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
        made = {}
        for name, ((column,), unit) in columns.items():
            made[name] = object.__new__(cls)
            made[name]._make(unit, _checked(column, name), group)
        return made

    def _make(self, unit: str, *parts: Any) -> None:
        rows, group = parts
        rows = lock(rows)
        ordered = lock(np.sort(rows))
        self._set(unit=unit, rows=rows, group=group, _sorted=ordered)
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

    def _parts(self) -> dict[str, Any]:
        return {"rows": self.rows, "group": self.group}

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self.unit == other.unit and self.group == other.group and np.array_equal(self.rows, other.rows)

    def __hash__(self) -> int:
        return hash((type(self), self.unit, self.group, self.rows.tobytes()))

    def __repr__(self) -> str:
        joint = ", joint" if self.group is not None else ""
        return f"Samples({self.rows.size} values, mean={show(self.mean, self.unit)}, sd={show(self.sd, self.unit)}{joint})"

    def _at(self, below: Any, above: Any) -> Any:
        places = np.minimum(np.floor(np.asarray(below) * self.rows.size).astype(np.intp), self.rows.size - 1)
        found = self._sorted[places]
        return found if isinstance(below, np.ndarray) else float(found)


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
