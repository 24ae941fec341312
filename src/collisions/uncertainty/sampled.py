"""``Sampled``: an output with its value in every case, from which its figures are worked out."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cached_property, partial
from itertools import combinations
from typing import Any

import numpy as np

from ..messages.errors import InputError
from ..messages.shares import in_percent
from ..quantities.attributes import (
    OWN_UNIT,
    derived,
    returns,
)
from ..quantities.reading import is_whole
from ..quantities.refusals import must_be
from . import turns as angles
from .designs import REPLICATES
from .distribution import probability
from .normal import power_of_two
from .output import Histogram, Output, Shares
from .probability import Again, Condition, holds_of_one

_OF_A_JUMP = 4.0  # times the standard error: twice as far as two errors should reach
# Gaps between values that one is compared with, and how many times as wide a jump is: of values
# that are spread by chance one in five thousand is, and such a gap is little beside their scatter.
_NEXT_TO, _MANY_TIMES = 8, 15.0
_MOST_BINS = 10000


class Sampled(Output):
    """An output that was sampled: one value for each case, in the order they were drawn, NaN where
    there was no answer.
    """

    # For each case 1 (at least its value), -1 (at most) or 0; None where all are known both ways.
    _sides: Any = None

    def __init__(
        self,
        name: str,
        unit: str | None,
        values: Any,
        shares: Callable[[], Mapping[str, Shares]],
        turns: float = 0.0,
    ) -> None:
        super().__init__(name, unit)
        self._all_shares = shares
        self._directions = values if unit == "rad" and angles.are_directions(values) else None
        self._turned = bool(turns)
        counted = values if self._directions is None else angles.counted(values)
        self.values = counted + 2.0 * math.pi * turns if turns else counted
        self.values.setflags(write=False)

    @property
    def failed(self) -> int:
        """Cases without an answer, which the figures leave out."""
        return int(np.count_nonzero(np.isnan(self.values)))

    def _given(self) -> str:
        if not self.failed:
            return self.given
        return f"{self.given}, and an answer: {in_percent(self.failed, self.values.size)} have none"

    def turned(self, turns: float) -> Sampled:
        """The same directions plus this many turns.

        Parameters
        ----------
        turns : float [-]
            Whole turns to add.

        Returns
        -------
        Output
            Of the same directions, in radians that differ by these turns.
        """
        values = self.values if self._directions is None else self._directions
        return Sampled(self.name, self.unit, values, self._all_shares, turns) if turns else self

    def may_wrap(self) -> bool:
        """Whether it looks like an angle that jumps between pi and -pi, if without a unit, or
        between 0 and a full turn; or has directions to all sides.

        Returns
        -------
        bool
            Whether it looks like one.
        """
        return self._wraps() is not None

    def _wraps(self) -> str | None:
        """Where it looks like an angle that jumps, or that it has directions to all sides."""
        found = self._answered
        if self._directions is None:
            return angles.jump_of(found, self.unit)
        all_round = angles.point_everywhere(found) or angles.point_to_opposite_sides(found)
        return angles.ALL_ROUND if all_round else None

    @derived(OWN_UNIT)
    def mean_standard_error(self) -> Any:
        """Standard error of the mean due to sampling; of a probability, at least one over the
        number of cases, and beside a jump at least that of one case on its other side.
        """
        error, found = self._error(average), self._answered
        if np.isin(found, (0.0, 1.0)).all():
            return max(error, self._one_case())
        # Points that lie evenly can be as many on either side of a jump in every sequence, which
        # then do not scatter by it.
        return max(error, _jump(found / found.size))

    @derived(OWN_UNIT)
    def std_standard_error(self) -> Any:
        """Standard error of the standard deviation due to sampling."""
        # Its divisor, one less than the cases, is that of independent ones; even points need none.
        return math.hypot(self._error(deviation), 0.5 * self._std() / self._answered.size)

    @returns(OWN_UNIT)
    def quantile_standard_error(self, p: Any) -> Any:
        """Standard error of a quantile due to sampling; NaN at 0 and 1, beyond which there is
        nothing to go by.

        The standard error of the share of cases up to the quantile, times the slope of the
        quantiles there. How the quantiles differ between the sequences would tell less, because
        each sequence is evenly spread in itself. Beside a jump of the answers that lies within two
        errors of that share, it is at least half the way to the other side. Where some cases are
        known from one side only, it is of the same values as the quantile, with these cases at
        infinity: NaN where the quantile is infinite itself, and infinite where, within two errors
        of its share, it may be.

        Parameters
        ----------
        p : float or array [-]
            Probability, from 0 to 1.

        Returns
        -------
        float or array
            In the unit of the output.
        """
        share = probability(p)
        with np.errstate(all="ignore"):
            found = np.array([self._quantile_error(one) for one in np.ravel(share)]).reshape(
                np.shape(share)
            )
        return found if found.ndim else float(found)

    def histogram(self, bins: int = 30) -> Histogram:
        """Edges, the shares of the cases between them and their standard errors, for a chart.

        Parameters
        ----------
        bins : int
            Number of bars.

        Returns
        -------
        Histogram
            Edges, shares and standard errors of the shares.
        """
        if not is_whole(bins) or not 1 <= bins <= _MOST_BINS:
            raise must_be("bins", f"a whole number from 1 to {_MOST_BINS}", bins, code="bad_option")
        try:
            with np.errstate(all="ignore"):
                edges = np.histogram_bin_edges(self._answered, bins)
            apart = bool(np.all(edges[1:] > edges[:-1]))
        except ValueError:
            apart = False
        if not apart:
            raise InputError(
                f"{self.name!r} has no histogram of {bins} bins, because its values do not "
                "differ by more than rounding",
                code="no_spread",
                argument="bins",
            )

        def shares(values: Any) -> Any:
            return np.histogram(values, edges)[0] / max(1, values.size)

        return Histogram(edges, shares(self._answered), self._error(shares))

    def probability(self, condition: Condition) -> tuple[float, float]:
        """The probability that a condition holds, and its standard error from sampling; see
        ``Output.probability``.

        Parameters
        ----------
        condition : function
            Called with the array of this output, one number for each sample that has an answer, in
            the unit of the output. Returns one boolean for each.

        Returns
        -------
        probability, standard_error : float [-]
            Between 0 and 1.

        Raises
        ------
        InputError
            A condition that does not return a boolean for every sample, or that samples known from
            one side only leave open.
        """
        held = holds_of_one(condition, self.name, self._asked_of(self.values), self._sides)

        def again(values: Callable[[Any], Any]) -> Any:
            return holds_of_one(condition, self.name, self._asked_of(values(self)))

        return self._share(held, again)

    def _asked_of(self, values: Any) -> Any:
        """The values that a condition is asked of: directions as the model gives them, from -pi to
        pi, unless they were turned by the caller.
        """
        if self._directions is None or self._turned:
            return values
        return self._directions if values is self.values else angles.folded(values, math.pi)

    def _share(self, held: Any, again: Again | None = None) -> tuple[float, float]:
        """The share of the samples in which a condition was found to hold, and its error; ``again``
        asks the condition of other values of the outputs that it is on.
        """
        found = self._like("condition", held)
        return float(found.mean), float(found.mean_standard_error)

    def _like(self, name: str, values: Any) -> Sampled:
        """Another quantity of the same samples."""
        return Sampled(name, None, values, dict)

    def _mean(self) -> Any:
        return average(self._answered)

    def _std(self) -> Any:
        return deviation(self._answered)

    def _quantile(self, p: Any) -> Any:
        found = _quantiles(self._answered, p)
        return found if found.ndim else float(found)

    def _shares(self) -> Shares:
        return self._all_shares()[self.name]

    def __getstate__(self) -> dict[str, Any]:
        # The shares worked out now: a pickle cannot hold the user's model.
        return {**self.__dict__, "_all_shares": partial(dict, self._all_shares())}

    @cached_property
    def _answered(self) -> Any:
        """The cases with an answer, sorted; one NaN without any, of which every figure is NaN."""
        found = np.sort(self.values[~np.isnan(self.values)])
        return found if found.size else np.array([np.nan])

    def _one_case(self) -> float:
        """The share of one case: what is more seldom, those that there are do not show."""
        return 1.0 / float(self._answered.size)

    def _quantile_error(self, share: float) -> float:
        found = self._answered
        if not 0.0 < share < 1.0 or found.size < 2:
            return math.nan
        at = float(_quantiles(found, share))
        # The shares of points that lie evenly can all be the same, and the quantile still lies
        # anywhere between two of them.
        error = math.hypot(
            self._error(lambda values: np.mean(values <= at)), 0.5 * self._one_case()
        )
        width = max(error, math.sqrt(share * (1.0 - share) / found.size))
        low, high = max(0.0, share - width), min(1.0, share + width)
        ends = _quantiles(found, (low, high))
        within = found[slice(*np.searchsorted(found, ends))]
        steps = error / (high - low) * np.diff(np.concatenate((ends[:1], within, ends[1:])))
        by_slope = float(np.sum(steps))
        # A slope tells nothing of a jump, on the other side of which the quantile may lie: what is
        # two errors of the share away then lies farther off than the slope without its largest
        # step explains.
        ends = _quantiles(found, (max(0.0, share - 2.0 * error), min(1.0, share + 2.0 * error)))
        far = float(max(ends[1] - at, at - ends[0]))
        if far > _OF_A_JUMP * (by_slope - float(np.max(steps))):
            return max(by_slope, 0.5 * far)
        return by_slope

    def _error(self, figure: Callable[[Any], Any]) -> Any:
        """The standard error of a figure, from how it differs between the independent sequences of
        points.
        """
        columns = [column[~np.isnan(column)] for column in self._sequences]
        found = [figure(column) for column in columns if column.size > 1]
        if len(found) < 2:
            return figure(np.zeros(2)) * math.nan
        scale = power_of_two(found)
        error = scale * (np.std(np.divide(found, scale), axis=0, ddof=1) / math.sqrt(len(found)))
        return error if np.ndim(error) else float(error)

    @cached_property
    def _sequences(self) -> list[Any]:
        """The cases of each independent sequence; directions unwrapped as each sequence alone would
        be.
        """
        if self._directions is None:
            return [self.values[which::REPLICATES] for which in range(REPLICATES)]
        counted = [
            angles.counted(self._directions[which::REPLICATES]) for which in range(REPLICATES)
        ]
        middle, turn = average(self._answered), 2.0 * math.pi
        return [one + turn * np.rint((middle - np.nanmean(one)) / turn) for one in counted]


def _jump(values: Any) -> float:
    """The largest gap of sorted values that is many times as wide as those next to it, on the side
    where more values lie. It is looked for where a multiple of the number of sequences lies below:
    only there can each sequence have as many beyond it.
    """
    gaps = np.diff(values)
    last = gaps.size + 1 - REPLICATES
    place = np.arange(REPLICATES - 1, last, REPLICATES)
    if not place.size:
        return 0.0
    sums = np.concatenate(([0.0], np.cumsum(gaps)))
    begin = np.where(place < gaps.size // 2, place + 1, place - _NEXT_TO)
    beside = (sums[begin + _NEXT_TO] - sums[begin]) / _NEXT_TO
    return float(np.max(gaps[place], where=gaps[place] > _MANY_TIMES * beside, initial=0.0))


def correlations(outputs: Mapping[str, Sampled]) -> dict[tuple[str, str], float]:
    """Correlation of every pair, over the cases with an answer for both; NaN where one of them does
    not vary, or is known from one side only in some of these.
    """
    found: dict[tuple[str, str], float] = {}
    for one, other in combinations(outputs, 2):
        columns = [outputs[name].values for name in (one, other)]
        both = ~np.isnan(columns[0]) & ~np.isnan(columns[1])
        pair = [values[both] / power_of_two(values[both]) for values in columns]
        sides = (outputs[name]._sides for name in (one, other))
        unknown = np.count_nonzero(both) < 2 or any(
            one_sided is not None and np.any(one_sided[both]) for one_sided in sides
        )
        with np.errstate(all="ignore"):
            found[one, other] = math.nan if unknown else float(np.corrcoef(*pair)[0, 1])
    return found


def average(values: Any) -> float:
    """The mean, also of numbers whose sum would leave the range of floats."""
    scale = power_of_two(values)
    return float(np.mean(values / scale)) * scale


def deviation(values: Any) -> float:
    """The standard deviation, with one degree of freedom fewer than values; their squares may leave
    the range of floats.
    """
    scale = power_of_two(values)
    return float(np.std(values / scale, ddof=1)) * scale if len(values) > 1 else math.nan


def _quantiles(values: Any, p: Any) -> Any:
    """Quantiles of sorted values, in the shape of ``p``."""
    with np.errstate(all="ignore"):
        # Between two values numpy takes their difference, which may leave the range of floats.
        scale = 0.5 if np.isinf(values[-1] - values[0]) else 1.0
        # Raveled: numpy takes two dimensions at most.
        return np.quantile(scale * values, np.ravel(p)).reshape(np.shape(p)) / scale
