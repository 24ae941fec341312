"""What sampling tells of one output: its figures, and the standard errors of all of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..errors import InputError
from ..quantities import OWN, derived, returns
from ..reading import is_whole
from ..units import shown
from . import angles
from .designs import REPLICATES
from .distribution import probability
from .normal import power_of_two
from .output import Histogram, Output, Shares, average, deviation

_MOST_BINS = 10000


class Sampled(Output):
    """An output that was sampled: one value for each case, in the order they were drawn, NaN where there was no answer."""

    def __init__(self, name: str, unit: str | None, values: Any, shares: Callable[[], Mapping[str, Shares]]) -> None:
        super().__init__(name, unit, shares)
        self._directions = values if unit == "rad" and angles.are_directions(values) else None
        self.values = values if self._directions is None else angles.counted(values)
        self.values.setflags(write=False)

    @property
    def failed(self) -> int:
        """Cases without an answer, which the figures leave out."""
        return int(np.count_nonzero(np.isnan(self.values)))

    def may_wrap(self) -> bool:
        """Whether it looks like an angle that jumps between pi and -pi: without a unit, or with one but on all sides."""
        found = self._answered()
        if self._directions is not None:
            return angles.point_everywhere(found) or angles.point_to_opposite_sides(found)
        return self.unit is None and angles.jump(found)

    @derived(OWN)
    def mean_standard_error(self) -> Any:
        """Standard error of the mean from sampling; of a probability at least one case in all, which nobody may have seen."""
        error = self._error(average)
        found = self._answered()
        seldom = found.size and found[0] >= 0.0 and found[-1] <= 1.0 and not np.any((found > 0.0) & (found < 1.0))
        return max(error, 1.0 / found.size) if seldom else error

    @derived(OWN)
    def std_standard_error(self) -> Any:
        """Standard error of the standard deviation from sampling."""
        return self._error(deviation)

    @returns(OWN)
    def quantile_standard_error(self, p: Any) -> Any:
        """Standard error of a quantile from sampling; NaN at 0 and 1, beyond which there is nothing to go by.

        That of the share of cases up to the quantile, by the slope of the quantiles there: how quantiles differ between the
        sequences would tell less, because each of them is even in itself.
        """
        share = probability(p)
        with np.errstate(all="ignore"):
            found = np.array([self._quantile_error(one) for one in np.ravel(share)]).reshape(np.shape(share))
        return found if found.ndim else float(found)

    def histogram(self, bins: int = 40) -> Histogram:
        """Edges, shares of the cases between them and their standard errors: for a chart."""
        if not is_whole(bins) or not 1 <= bins <= _MOST_BINS:
            raise InputError(
                f"bins must be a whole number from 1 to {_MOST_BINS}, got {shown(bins)}", code="bad_option", argument="bins"
            )
        try:
            with np.errstate(all="ignore"):
                edges = np.histogram_bin_edges(self._answered(), bins)
            apart = bool(np.all(edges[1:] > edges[:-1]))
        except ValueError:
            apart = False
        if not apart:
            raise InputError(
                f"{self.name!r} has no histogram of {bins} bins, because its values do not differ by more than rounding",
                code="no_spread",
                argument="bins",
            )

        def shares(values: Any) -> Any:
            return np.histogram(values, edges)[0] / max(1, values.size)

        return Histogram(edges, shares(self._answered()), self._error(shares))

    def _mean(self) -> Any:
        return average(self._answered())

    def _std(self) -> Any:
        return deviation(self._answered())

    def _quantile(self, p: Any) -> Any:
        with np.errstate(all="ignore"):
            found = np.quantile(self._answered(), p)
        return found if found.ndim else float(found)

    def _turn(self, turns: float) -> None:
        self.values = self.values + 2.0 * math.pi * turns
        self.values.setflags(write=False)
        self._cache.clear()

    def _answered(self) -> Any:
        """The cases with an answer, sorted."""
        if "sorted" not in self._cache:
            self._cache["sorted"] = np.sort(self.values[~np.isnan(self.values)])
        return self._cache["sorted"]

    def _quantile_error(self, share: float) -> float:
        found = self._answered()
        if not 0.0 < share < 1.0 or found.size < 2:
            return math.nan
        at = np.quantile(found, share)
        # Of points that lie evenly the shares can all be the same, and the quantile still lies anywhere between two of them.
        error = math.hypot(self._error(lambda values: np.mean(values <= at)), 0.5 / found.size)
        reach = max(error, math.sqrt(share * (1.0 - share) / found.size))
        low, high = max(0.0, share - reach), min(1.0, share + reach)
        ends = np.quantile(found, (low, high))
        return error * float(ends[1] - ends[0]) / (high - low)

    def _error(self, figure: Callable[[Any], Any]) -> Any:
        """The standard error of a figure, from how it differs between the independent sequences of points."""
        columns = [column[~np.isnan(column)] for column in self._sequences()]
        found = [figure(column) for column in columns if column.size > 1]
        if len(found) < 2:
            return figure(np.zeros(2)) * math.nan
        scale = power_of_two(found)
        error = scale * (np.std(np.divide(found, scale), axis=0, ddof=1) / math.sqrt(len(found)))
        return error if np.ndim(error) else float(error)

    def _sequences(self) -> list[Any]:
        """The cases of each independent sequence; directions as each of them alone would count them."""
        if self._directions is None:
            return [self.values[which::REPLICATES] for which in range(REPLICATES)]
        if "sequences" not in self._cache:
            alone = [angles.counted(self._directions[which::REPLICATES]) for which in range(REPLICATES)]
            middle = average(self._answered())
            turn = 2.0 * math.pi
            self._cache["sequences"] = [one + turn * np.rint((middle - np.nanmean(one)) / turn) for one in alone]
        return list(self._cache["sequences"])
