"""Finds the restitution when it is a function of the closing speed: roots on a grid of e, then
narrowed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..messages.errors import CollisionsError, InputError
from ..messages.warning import quietly
from ..quantities.units import shown
from .common import Cases

# Cells from 0 to 1 of the grid of restitutions with which the search begins.
_CELLS = 128
_PIECES = 16
# Repeated subdivisions of a grid cell until its pieces are as small as rounding.
_ROUNDS = 13
# Largest mismatch at a root: a jump changes sign as well, but leaves a large mismatch.
_ROOT = 1e-6
# Relative step for the slope: accurate to 1e-8 for functions that vary over some metres per second.
_STEP = 1e-4
# Closing speeds at which a function is asked both ways, alone and in an array.
_COMPARED = 16

# Cases whose grids are looked at together, so that their arrays stay small.
_BLOCK = 256

# The mismatch of each row, from restitution and case, which are arrays alike.
_Mismatch = Callable[[Any, Any], Sequence[Any]]


def crossings(mismatch: _Mismatch, count: int, least: float = 0.0) -> list[tuple[int, int, float]]:
    """Every root of each row of ``mismatch(restitution, case)`` that a grid of restitutions shows:
    case, row and root.

    NaN marks where a row has no answer. A change of sign is narrowed down, also between a grid
    point and the place where a row ends; where the mismatch comes near 0 and turns away again, its
    turning point is looked at, for two roots may hide there.
    """
    found = []
    for start in range(0, count, _BLOCK):
        found += _crossings(mismatch, np.arange(start, min(start + _BLOCK, count)), least)
    return found


def _crossings(mismatch: _Mismatch, cases: Any, least: float) -> list[tuple[int, int, float]]:
    # At -1 nothing happens.
    first = np.arange(1.0 - _CELLS if least < 0.0 else 0.0, _CELLS + 1.0) / _CELLS
    grid, of = np.tile(first, cases.size), np.repeat(cases, first.size)
    # Rows and cases in one, the cases of a row one after another.
    values = np.stack(list(mismatch(grid, of))).reshape(-1, first.size)
    signs, known = np.sign(values), np.isfinite(values)

    def brackets_of(place: Any, low: Any, high: Any) -> _Brackets:
        return _Brackets(place // cases.size, cases[place % cases.size], low, high)

    place, i = np.nonzero(signs[:, :-1] * signs[:, 1:] <= 0.0)
    brackets = [brackets_of(place, first[i], first[i + 1])]

    place, i = np.nonzero(known[:, :-1] != known[:, 1:])
    i, outside = np.where(known[place, i], (i, i + 1), (i + 1, i))
    ending = brackets_of(place, first[i], first[outside])
    brackets.append(ending._replace(high=_narrowed(mismatch, ending, _last_answer, 1).low))

    size, same = abs(values), signs[:, :-1] * signs[:, 1:] > 0.0
    place, i = np.nonzero(
        same[:, :-1] & same[:, 1:] & (size[:, 1:-1] <= np.minimum(size[:, :-2], size[:, 2:]))
    )
    around, side = brackets_of(place, first[i], first[i + 2]), signs[place, i][:, np.newaxis]
    turn = _narrowed(
        mismatch,
        around,
        lambda v: np.argmin(np.where(np.isnan(v), np.inf, side * v), axis=1) - 1,
        2,
    ).low
    brackets += [around._replace(high=turn), around._replace(low=turn)]

    whole = _Brackets(*(np.concatenate(parts) for parts in zip(*brackets, strict=True)))
    _, ends = _sampled(mismatch, whole, 1)
    changing = ends[:, 0] * ends[:, 1] <= 0.0
    found = _narrowed(mismatch, _Brackets(*(part[changing] for part in whole)), _change_of_sign, 1)
    _, rest = _sampled(mismatch, found, 1)
    roots = np.where(abs(rest[:, 0]) <= abs(rest[:, 1]), found.low, found.high)
    sure = np.min(abs(rest), axis=1, initial=np.inf) <= _ROOT
    return sorted(
        set(
            zip(
                found.case[sure].tolist(),
                found.row[sure].tolist(),
                roots[sure].tolist(),
                strict=True,
            )
        )
    )


class _Brackets(NamedTuple):
    """Intervals of restitution: for each its row, its case and both ends."""

    row: Any
    case: Any
    low: Any
    high: Any


def _sampled(mismatch: _Mismatch, brackets: _Brackets, pieces: int) -> tuple[Any, Any]:
    """Split each bracket into ``pieces``; gives the end points, and the mismatch of the bracket's
    row at them.
    """
    row, low, high = (part[:, np.newaxis] for part in (brackets.row, brackets.low, brackets.high))
    places = np.append(low + (high - low) * (np.arange(pieces) / pieces), high, axis=1)
    if not places.size:
        return places, places
    values = np.stack(list(mismatch(places.ravel(), np.repeat(brackets.case, pieces + 1)))).reshape(
        -1, *places.shape
    )
    return places, values[row, np.arange(len(row))[:, np.newaxis], np.arange(pieces + 1)]


def _narrowed(
    mismatch: _Mismatch, brackets: _Brackets, first_piece: Callable[[Any], Any], count: int
) -> _Brackets:
    """Narrow the brackets by repeated subdivision, each time to ``count`` pieces from the one
    ``first_piece`` chooses.
    """
    for _ in range(_ROUNDS):
        places, values = _sampled(mismatch, brackets, _PIECES)
        if places.size:
            first, of = np.clip(first_piece(values), 0, _PIECES - count), range(len(places))
            brackets = brackets._replace(low=places[of, first], high=places[of, first + count])
    return brackets


def _change_of_sign(values: Any) -> Any:
    signs = np.sign(values)
    return np.argmax(signs[:, :-1] * signs[:, 1:] <= 0.0, axis=1)


def _last_answer(values: Any) -> Any:
    return np.argmax(np.isnan(values), axis=1) - 1


class RestitutionOf:
    """A caller's function of the closing speed, whose values outside ``least`` to 1 are no answer.

    For a batch it is called with arrays of closing speeds if it takes these as it takes single
    ones.
    """

    def __init__(self, function: Callable[[float], Any], cases: Cases, least: float = 0.0) -> None:
        self.function, self.least = function, least
        self.refused = ""
        self.takes_arrays: bool | None = None if cases.shape is not None else False

    def __call__(self, closing: Any) -> Any:
        """Restitution at each closing speed; NaN where the function has none."""
        if self.takes_arrays is None:
            self.takes_arrays = self._same_in_arrays(closing)
        return (
            self._usable(closing, self._of_array(closing))
            if self.takes_arrays
            else self._of_each(closing)
        )

    def _same_in_arrays(self, closing: Any) -> bool:
        """Whether the function answers an array element by element."""
        try:
            e = self._of_array(closing)
        except Exception:
            return False
        # One answer for all may be right for these, and not for those of the next array.
        if e.shape != closing.shape:
            return False
        some = np.flatnonzero(np.isfinite(closing))[:: max(1, closing.size // _COMPARED)]
        usable = self._usable(closing[some], e[some])
        return bool(
            np.allclose(usable, self._of_each(closing[some]), rtol=1e-12, atol=0.0, equal_nan=True)
        )

    def _of_array(self, closing: Any) -> Any:
        with quietly():
            return np.array(self.function(closing), dtype=np.float64)

    def _usable(self, closing: Any, e: Any) -> Any:
        return np.where((closing > 0.0) & self._is_one(e), e, np.nan)

    def _of_each(self, closing: Any) -> Any:
        return np.array([self._one(float(speed)) for speed in closing])

    def slope(self, closing: Any) -> Any:
        """Derivative of the restitution by closing speed, one-sided where the function ends; NaN
        where it has no value.
        """
        places = np.stack([closing * (1.0 - _STEP), closing, closing * (1.0 + _STEP)])
        refused = self.refused
        values = self(places.ravel()).reshape(places.shape)
        # The function need not have a value on both sides of the answer.
        self.refused = refused
        known = np.isfinite(values)
        first, last = np.argmax(known, axis=0), 2 - np.argmax(known[::-1], axis=0)
        (low, start), (high, end) = (
            [np.take_along_axis(part, at[np.newaxis], axis=0)[0] for part in (places, values)]
            for at in (first, last)
        )
        return np.where(last > first, (end - start) / (high - low), np.nan)

    def _is_one(self, e: Any) -> Any:
        """Whether this is a restitution; never at -1, where nothing happens."""
        return (e >= self.least) & (e > -1.0) & (e <= 1.0)

    def _one(self, closing: float) -> float:
        if not closing > 0.0:
            return math.nan
        try:
            given = self.function(closing)
            e = math.nan if isinstance(given, (str, bytes, bool)) else float(given)
        except Exception as error:
            why = (
                str(error)
                if isinstance(error, CollisionsError)
                else f"it raised {type(error).__name__}: {error}"
            )
            self.refused = (
                f"the restitution function has no value at a closing speed of {closing:.6g} m/s: "
                f"{why}"
            )
            return math.nan
        if not self._is_one(e):
            self.refused = (
                f"restitution({closing:.6g}) gave {shown(given)}, which is not a number from "
                f"{self.least:g} to 1"
            )
            return math.nan
        return e

    def complain(self) -> None:
        """Raise if the function had no value where one was needed."""
        if self.refused:
            raise InputError(
                f"{self.refused}; the function takes closing speeds in m/s, and must hold where "
                "the answer lies",
                code="bad_restitution",
                argument="restitution",
            )
