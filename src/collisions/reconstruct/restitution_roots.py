"""Finds the restitution when it is a function of the closing speed: roots on a grid of e, then
narrowed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..messages.errors import CollisionsError, InputError
from ..messages.warning import of_some, quietly
from ..quantities.settings import in_si
from ..quantities.units import shown
from .common import Cases
from .grid_roots import Narrowing, roots_on_grid

# Cells from 0 to 1 of the grid of restitutions with which the search begins.
_CELLS = 128
# Largest mismatch at a root: a jump changes sign as well, but leaves a large mismatch.
_ROOT = 1e-6
# Relative step for the slope: accurate to 1e-8 for functions that vary over some metres per second.
_STEP = 1e-4
# Closing speeds at which a function is asked both ways, alone and in an array.
_COMPARED = 16


def crossings(
    mismatch: Callable[[Any, Any], Sequence[Any]], count: int, least: float = 0.0
) -> list[tuple[int, int, float]]:
    """Every root of each row of ``mismatch(restitution, case)`` that a grid of restitutions shows:
    case, row and root.
    """
    # At -1 nothing happens.
    grid = np.arange(1.0 - _CELLS if least < 0.0 else 0.0, _CELLS + 1.0) / _CELLS
    return roots_on_grid(mismatch, count, grid, Narrowing(_ROOT))


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
        with quietly([]), in_si():
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
            with quietly([]), in_si():
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

    def warn_at(self, closing: Any) -> None:
        """Ask the function at the closing speeds of an answer, NaN where there is none: what it
        warns of there is so of the answer, and not of speeds that were tried on the way.
        """
        closing = np.asarray(closing)
        answered = np.isfinite(closing)
        if self.takes_arrays:
            self._warn_of(closing[answered], answered)
            return
        for index in zip(*np.nonzero(np.atleast_1d(answered)), strict=True):
            only = np.zeros(answered.shape, dtype=bool)
            only[index if answered.ndim else ()] = True
            self._warn_of(float(closing[only][0]), only)

    def _warn_of(self, closing: Any, cases: Any) -> None:
        """Ask the function at the closing speeds of these cases."""
        with of_some(cases), in_si():
            try:
                self.function(closing)
            except Warning:
                raise
            except Exception:
                return  # it has a value within rounding of here

    def complain(self) -> None:
        """Raise if the function had no value where one was needed."""
        if self.refused:
            raise InputError(
                f"{self.refused}; the function takes closing speeds in m/s, and must hold where "
                "the answer lies",
                code="bad_restitution",
                argument="restitution",
            )
