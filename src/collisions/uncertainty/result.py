"""``Propagation``: every output with mean, spread, quantiles, their standard errors, and shares of
variance by input.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from ..messages.errors import InputError, OutOfRangeWarning
from ..messages.shares import in_percent
from ..messages.warning import Note
from ..quantities.attributes import (
    OWN_UNIT,
    Derived,
    Quantities,
    derived,
    equal,
    format_value,
    returns,
)
from ..quantities.formatting import KIND_OF, Numbers
from ..quantities.reading import ArgumentReader, is_whole
from ..quantities.refusals import must_be
from ..quantities.strict_json import strict
from ..quantities.tables import (
    Cells,
    Part,
    Summarized,
    Summary,
    all_numbers,
    as_sentence,
    given_texts,
)
from ..quantities.units import rendered, shown, unit_as_written
from . import turns as angles
from .designs import REPLICATES
from .distribution import probability
from .halved import Halved
from .normal import power_of_two
from .probability import Again, Condition, holds, holds_of_one

COVERAGE = 0.95
_OF_A_JUMP = 4.0  # times the standard error: twice as far as two errors should reach
# Gaps between values that one is compared with, and how many times as wide a jump is: of values
# that are spread by chance one in five thousand is, and such a gap is little beside their scatter.
_NEXT_TO, _MANY_TIMES = 8, 15.0
_MOST_BINS = 10000
# From so many cases on, the share of the variance that one of them has at most: of a normal output
# it is 3 % of 256 cases, and less of more.
_MANY, _MOST_OF_ONE = 256, 0.1
# Heads of figures that are none.
_ONE_ANSWER = "in the one case that has an answer, so no spread is known"
_NO_ANSWER = "no case has an answer"


# A smaller spread, relative to the mean or in SI for results that should be 0, is rounding.
NO_SPREAD, NOTHING = 1e-10, {"impulse": 1e-8, "angular momentum": 1e-8, "energy": 1e-8}


class Shares(NamedTuple):
    """Each input's share of the variance of an output, by itself and with its interactions, and the
    standard errors of both.

    By input. Correlated inputs, and joint samples, cannot be told apart and share one entry:
    "mass_a & mass_b".
    """

    first: dict[str, float]
    total: dict[str, float]
    first_error: dict[str, float]
    total_error: dict[str, float]


class Histogram(NamedTuple):
    """Shares of the cases between the edges of the bins, with their standard errors."""

    edges: Any
    shares: Any
    standard_errors: Any

    def __eq__(self, other: object) -> bool:
        return equal(tuple(self), tuple(other)) if isinstance(other, Histogram) else NotImplemented

    def __ne__(self, other: object) -> bool:
        return not self == other


class Output(Summarized):
    """One named output of a propagation, given the stated inputs.

    Values are bare numbers: SI where the model returned Quantities, otherwise in whatever unit the
    model returned. With an ``Interval`` among the inputs, every figure is a pair: the least and the
    greatest value it may have, wherever in the interval the truth lies.

    Directions, that is angles returned with a unit that all lie in [-pi, pi] (-180 to 180 degrees,
    not 0 to 360, whose jump at a full turn draws a warning only), are counted round the
    circle from the point opposite their mean, and so may lie beyond pi or -pi. The mean, in (-pi,
    pi], is the direction for which the mean square of the angular distances is least; the standard
    deviation is the root of this mean square; quantiles and intervals are those of the directions
    so counted. For a direction with a normal error far smaller than half a turn, these are its
    ordinary mean and standard deviation.
    """

    given = "the stated inputs"
    texts: tuple[str, ...] = ()
    """Texts by which the units of its summary are chosen."""

    # What every kind of output works out in its own way.
    _mean: Callable[[], Any]
    _std: Callable[[], Any]
    _quantile: Callable[[Any], Any]
    _shares: Callable[[], Shares]

    def __init__(self, name: str, unit: str | None) -> None:
        self.name = name
        self.unit = unit

    @property
    def q(self) -> Any:
        """The same attributes as pint Quantities; only where the model returned Quantities."""
        self._check_unit()
        return Quantities(self)

    def to(self, unit: str) -> InUnit:
        """The same attributes as plain numbers in this unit; only where the model returned
        Quantities.

        Parameters
        ----------
        unit : str
            A unit of the same kind, such as ``"mph"``.

        Returns
        -------
        Output
            With every figure in that unit.

        Examples
        --------
        >>> import collisions as col
        >>> from collisions.uncertainty import Normal, propagate
        >>> def struck(speed):
        ...     impact = col.linear_central(
        ...         col.Vehicle(mass="3400 lb", vx=speed), col.Vehicle(mass="2900 lb"), 0.1
        ...     )
        ...     return {"delta_v": impact.b.q.delta_v}
        >>> delta_v = propagate(struck, {"speed": Normal("30 mph", "2 mph")}, seed=1)["delta_v"]
        >>> [round(end, 1) for end in delta_v.to("mph").interval(0.95)]
        [15.5, 20.1]
        """
        self._check_unit()
        return InUnit(self, unit)

    def _check_unit(self) -> None:
        if self.unit is None:
            raise InputError(
                f"{self.name!r} has no unit, because the model returned plain numbers; return a "
                "Quantity: impact.a.q.delta_v in place of impact.a.delta_v, and of what a function "
                "gives as a number, travel.q.speed(...) in place of travel.speed(...)",
                code="no_unit",
                argument=self.name,
            )

    def __setattr__(self, name: str, value: Any) -> None:
        if isinstance(getattr(type(self), name, None), Derived):
            raise AttributeError(f"{name} is worked out and cannot be set")
        object.__setattr__(self, name, value)

    @property
    def bounds_only(self) -> bool:
        """Whether nothing but bounds is known of it."""
        return False

    def _own_figures(self, numbers: Numbers, kind: str) -> list[tuple[str, str]] | None:
        """What a table says of an output whose figures are of another kind; None for others."""
        return None

    @derived(OWN_UNIT)
    def mean(self) -> Any:
        """Expected value."""
        return self._mean()

    @derived(OWN_UNIT)
    def std(self) -> Any:
        """Standard deviation."""
        return self._std()

    @derived(OWN_UNIT)
    def mean_standard_error(self) -> Any:
        """Standard error of the mean due to sampling; NaN for a local method, which does not sample
        or know its error.
        """
        return math.nan

    @derived(OWN_UNIT)
    def std_standard_error(self) -> Any:
        """Standard error of the standard deviation due to sampling; NaN for a local method."""
        return math.nan

    @returns(OWN_UNIT)
    def quantile(self, p: Any) -> Any:
        """The value that is not exceeded with probability p, a number from 0 to 1 or an array of
        them.

        Parameters
        ----------
        p : float or array [-]
            Probability, from 0 to 1.

        Returns
        -------
        float or array
            In the unit of the output.
        """
        return self._quantile(probability(p))

    @returns(OWN_UNIT)
    def quantile_standard_error(self, p: Any) -> Any:
        """Standard error of a quantile due to sampling; NaN for a local method.

        Parameters
        ----------
        p : float or array [-]
            Probability, from 0 to 1.

        Returns
        -------
        float or array
            In the unit of the output.
        """
        return probability(p) * math.nan

    @returns(OWN_UNIT)
    def interval(self, coverage: float = COVERAGE) -> tuple[float, float]:
        """The range (low, high) that holds the value with this probability and leaves equal
        probabilities below and above.

        Parameters
        ----------
        coverage : float [-]
            Probability that the range holds, between 0 and 1.

        Returns
        -------
        tuple of two floats
            Both ends, in the unit of the output.

        Examples
        --------
        >>> from collisions import uncertainty
        >>> speed = uncertainty.propagate(
        ...     lambda speed: {"energy": 0.5 * 1200.0 * speed**2},
        ...     {"speed": uncertainty.Normal(20.0, 0.5)},
        ...     method="first_order",
        ... )
        >>> [round(end / 1000.0) for end in speed["energy"].interval(0.95)]
        [216, 264]
        """
        share = probability(coverage, "coverage")
        if not isinstance(share, float):
            raise must_be("coverage", "one number", coverage, code="bad_fraction")
        low, high = self._quantile(np.array([0.5 - 0.5 * share, 0.5 + 0.5 * share]))
        return float(low), float(high)

    @property
    def contributions(self) -> dict[str, float]:
        """Share of the variance due to each input alone, largest first; the rest, up to 1, is
        interaction, and with ``finer=`` what its correction does not foresee (``scatter``). Cases
        without an answer are left out, and so are those that lose it where an input is drawn again.
        """
        return _ranked(self._shares().first)

    @property
    def total_contributions(self) -> dict[str, float]:
        """Share of the variance due to each input with all its interactions: what is left when
        the others are known.
        """
        return _ranked(self._shares().total)

    @property
    def contribution_standard_errors(self) -> dict[str, tuple[float, float]]:
        """Standard errors of the contribution and of the total contribution of each input; NaN
        for a local method.
        """
        found = self._shares()
        return {
            name: (found.first_error[name], found.total_error[name])
            for name in _ranked(found.total)
        }

    def histogram(self, bins: int = 30) -> Histogram:
        """Edges, the shares of the cases between them and their standard errors, for a chart; only
        after sampling.

        Parameters
        ----------
        bins : int
            Number of bars.

        Returns
        -------
        Histogram
            Edges, shares and standard errors of the shares.
        """
        raise InputError(
            f"{self.name!r} has no histogram, because nothing was sampled; take "
            "`method='quasi_random'`",
            code="not_sampled",
            argument="method",
        )

    def probability(self, condition: Condition) -> tuple[float, float]:
        """The probability that a condition holds, and its standard error; only after sampling.

        The share of the samples, of those that have an answer. The standard error is that of
        sampling, and no statement on the inputs. Directions are asked of as the model gives them,
        from -pi to pi, also where mean and range are counted beyond. A sample that is known from
        one side only counts where the condition says the same of its bound and of all that lies
        beyond, which is looked at in eighty places and at infinity.

        Parameters
        ----------
        condition : function
            Called with the array of this output, one number for each sample that has an answer, in
            the unit of the output (SI where the model returned Quantities; through ``to("mph")`` in
            that unit). Returns one boolean for each.

        Returns
        -------
        probability, standard_error : float [-]
            Between 0 and 1. If the condition holds in no sample or in every one, the error is 1
            over their number.

        Raises
        ------
        InputError
            A condition that does not return a boolean for every sample (code "bad_condition"), or
            that holds in some place where a sample known from one side only may lie and not in
            another (code "one_sided"); or nothing was sampled, or an ``Interval`` is among the
            inputs (code "not_sampled").
        NoSolutionError
            No sample has an answer.

        Examples
        --------
        >>> from collisions.uncertainty import Normal, propagate
        >>> found = propagate(
        ...     lambda speed: {"energy": 0.5 * 1200.0 * speed**2},
        ...     {"speed": Normal(20.0, 0.5)},
        ...     seed=1,
        ... )
        >>> chance, error = found["energy"].probability(lambda energy: energy > 252_150.0)
        >>> round(chance, 3), error < 0.002
        (0.159, True)
        """
        raise InputError(
            f"{self.name!r} has no samples in which a condition could hold; take "
            "`method='quasi_random'`, which draws them",
            code="not_sampled",
            argument="method",
        )

    def row(self) -> tuple[str, str]:
        """Name and figures as text.

        Returns
        -------
        tuple of two texts
            The name, and the figures.
        """
        low, high = self.interval()
        unit = f" {self.unit}" if self.unit else ""
        mean, std = format_value(self.mean), format_value(self.std)
        if math.isnan(self.mean):
            return self.name, _NO_ANSWER
        if math.isnan(self.std):
            return self.name, f"{mean}{unit} {_ONE_ANSWER}"
        return self.name, f"{mean} ± {std}{unit}, 95 percent from {low:.6g} to {high:.6g}{unit}"

    def record(self) -> dict[str, Any]:
        """The figures as plain values that strict JSON can hold.

        Returns
        -------
        dict
            Plain values that ``json.dumps`` writes; infinity and NaN as texts.
        """
        shares = {
            "contributions": self.contributions,
            "total_contributions": self.total_contributions,
        }
        found: dict[str, Any] = strict(self._basics() | shares)
        return found

    def __repr__(self) -> str:
        name, text = self.row()
        return f"<{name}: {text}, given {self._given()}>"

    def __str__(self) -> str:
        return str(self.summary())

    def _summary(self, numbers: Cells) -> Summary:
        parts = [outputs_part({self.name: self}, numbers), all_numbers([self.row()])]
        return Summary(f"Given {self._given()}", parts, bare_notes([self]))

    def _given(self) -> str:
        """What the figures are given, for a title."""
        return self.given

    def _texts(self) -> tuple[str, ...]:
        return self.texts

    def _basics(self) -> dict[str, Any]:
        return {
            "unit": self.unit,
            "mean": self.mean,
            "std": self.std,
            "mean_standard_error": self.mean_standard_error,
            "std_standard_error": self.std_standard_error,
            "interval_95": self.interval(),
        }


class InUnit(Quantities):
    """An output's attributes and the results of its methods as plain numbers in a unit that was
    asked for.
    """

    __slots__ = ("_numbers",)

    def __init__(self, owner: Output, unit: str) -> None:
        super().__init__(owner)
        reader = ArgumentReader()
        # A text or a unit of pint; anything else is refused by how it is written.
        name = (
            f"{unit}"
            if isinstance(unit, str) or hasattr(unit, "dimensionality")
            else rendered(unit)
        )
        factor = reader.number(f"1 {name}", owner.unit or "", "unit")
        reader.close()
        self._numbers = _OneUnit(
            unit_as_written(f"1 {unit}" if isinstance(unit, str) else unit), factor
        )

    def probability(self, condition: Condition) -> tuple[float, float]:
        """As ``Output.probability``, of a condition on values in this unit."""
        factor = self._numbers.factor
        asked = (lambda values: condition(values / factor)) if callable(condition) else condition
        found: tuple[float, float] = self._owner.probability(asked)
        return found

    def __repr__(self) -> str:
        text = "; ".join(
            f"{what}: {figure}" for what, figure in figures(self._owner, self._numbers)
        )
        return f"<{self._owner.name}, given {self._owner._given()}; {text}>"

    def _repr_html_(self) -> str:
        summary: Summary = self._owner._summary(self._numbers)
        return summary._repr_html_()

    def _with_unit(self, value: Any, unit: str) -> Any:
        factor = self._numbers.factor
        return (
            tuple(part / factor for part in value) if isinstance(value, tuple) else value / factor
        )


class _OneUnit(Cells):
    """Writes numbers for a table in one unit, whatever their kind."""

    unlisted = "number"

    def __init__(self, unit: str, factor: float) -> None:
        super().__init__("si")
        self.written, self.factor = unit, factor

    def label(self, kind: str) -> str:
        return self.written

    def scale(self, kind: str) -> float:
        return 1.0 / self.factor


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


def unanswered_notes(outputs: Mapping[str, Sampled]) -> Iterator[Note]:
    """That some cases have none of these outputs, whose figures are of the others."""
    for name, output in outputs.items():
        failed, count = output.failed, output.values.size
        if failed == count:
            # It has no figures that could mislead.
            yield Note(None, f"none of the {count} samples has {name!r}, and it has no figures")
        elif failed:
            sentence = (
                f"{failed} of {count} samples ({in_percent(failed, count)}) have no {name!r}, "
                "and its figures are of the others: they hold only where there is one"
            )
            fields = {"failed": failed, "output": name}
            yield Note(OutOfRangeWarning, sentence, code="failed_cases", fields=fields)


def wraps_of(outputs: Mapping[str, Sampled]) -> dict[str, str]:
    """By name of the outputs that look like an angle that jumps, or point to all sides, which."""
    wraps = {name: output._wraps() for name, output in outputs.items()}
    return {name: where for name, where in wraps.items() if where is not None}


def tail_notes(outputs: Mapping[str, Output]) -> Iterator[Note]:
    """That mean and standard deviation of an output rest on few cases far out."""
    for name, output in outputs.items():
        if not isinstance(output, Sampled) or output._sides is not None:
            continue
        values = output._answered
        varies = output._std() > NO_SPREAD * float(np.max(abs(values)))
        # A yes or no has a probability, whose error says how few cases it rests on.
        if values.size < _MANY or not varies or np.isin(values, (0.0, 1.0)).all():
            continue
        apart = values - average(values)
        squares = (apart / power_of_two(apart)) ** 2
        share = float(np.max(squares) / np.sum(squares))
        if share > _MOST_OF_ONE:
            yield Note(
                None,
                f"one of {values.size} cases has {100.0 * share:.0f} % of the variance of {name}: "
                "its mean and standard deviation, and their standard errors, rest on few cases far "
                "out; read its range",
            )


def wrap_notes(wrapped: Mapping[str, str]) -> Iterator[Note]:
    """That means of these outputs mean nothing, or little."""
    for kind, text, cure in (
        (
            angles.AT_HALF_TURN,
            "has values near pi and near -pi: if it is an angle, its mean means nothing",
            ". Return it with its unit (impact.a.q.pdof), so that it is known to be one",
        ),
        (
            angles.ONE_SIDED,
            (
                "has values near pi and near -pi, and some are known from one side only: if it is "
                "a direction, the ends of its range mean nothing"
            ),
            (
                ". Return how far it is from a direction near the middle of them, between -180 and "
                "180 deg, as by `(angle - middle + 180) % 360 - 180`"
            ),
        ),
        (
            angles.AT_FULL_TURN,
            (
                "has values near 0 and near a full turn, 2 pi, and few somewhere between: if it is "
                "a direction, its mean means nothing"
            ),
            (
                ". Return it with its unit and between -180 and 180 deg, as by `(angle + 180) % "
                "360 - 180`, so that it is counted round the circle"
            ),
        ),
        (
            angles.ALL_ROUND,
            (
                "has directions so far round the circle from one another that its mean tells "
                "little: the mean errs by more than their spread shows, or another one far from "
                "it is about as good"
            ),
            "",
        ),
    ):
        names = tuple(name for name, where in wrapped.items() if where == kind)
        if names:
            yield Note(
                OutOfRangeWarning,
                f"{', '.join(names)} {text}",
                cure,
                "may_wrap",
                {"outputs": names},
            )


@dataclass(eq=False, repr=False)
class Propagation(Summarized):
    """The outputs of a model given the stated inputs; ``result["delta_v"]`` is one of them.

    Attributes
    ----------
    method : str
        The method that was used.
    inputs : dict
        What was stated: distributions, intervals, and fixed values.
    samples : int
        Number of cases the model was called with.
    failed : int
        Number of cases without an answer for at least one output, for example because there was no
        impact. The figures leave them out, and hold given that there is an answer.
    seed : int or None
        The seed that reproduces the result to the bit; None where nothing was drawn.
    interrupted : bool
        Whether the run was stopped before its end; the figures are then those of the cases done.
    notes : tuple
        What ``statements`` say, each with the warning it is, if any, its ``code``, and the number
        and share of the cases.
    calls : dict
        With a finer model, how many cases were asked of "model" and of "finer"; empty without.
    scatter : dict
        With a finer model, by output, the standard deviation of what its correction does not
        foresee, in cross-validation.
    """

    method: str
    inputs: dict[str, Any]
    outputs: dict[str, Output]
    samples: int
    failed: int
    seed: int | None = None
    interrupted: bool = False
    notes: tuple[Note, ...] = ()
    calls: dict[str, int] = field(default_factory=dict)
    scatter: dict[str, float] = field(default_factory=dict)
    # The share without an answer of the cases drawn from the inputs or searched between bounds:
    # ``samples`` counts those for derivatives too, which all have one.
    _unanswered: float = math.nan
    _run_halved: Callable[[], Halved] | None = None
    _halved: Halved | None = None

    def __post_init__(self) -> None:
        for output in self.outputs.values():
            output.texts = tuple(given_texts(self))

    def __getstate__(self) -> dict[str, Any]:
        # Without what would run the user's model again, which a pickle cannot hold.
        return {**self.__dict__, "_run_halved": None}

    def __getitem__(self, name: str) -> Output:
        if not isinstance(name, str) or name not in self.outputs:
            raise InputError(
                f"there is no output {shown(name)}; the model returned {', '.join(self.outputs)}",
                code="no_output",
                argument="name",
            )
        return self.outputs[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.outputs)

    def __len__(self) -> int:
        return len(self.outputs)

    @property
    def correlation(self) -> dict[tuple[str, str], float]:
        """Correlation of every pair of outputs, over the cases with an answer for both; NaN where
        one of them does not vary, or is known from one side only in some of these. Only after
        sampling.
        """
        return correlations(
            {name: output for name, output in self.outputs.items() if isinstance(output, Sampled)}
        )

    def probability(self, condition: Callable[[Mapping[str, Any]], Any]) -> tuple[float, float]:
        """The probability that a condition on several outputs holds, and its standard error; only
        after sampling.

        Parameters
        ----------
        condition : function
            Called with a dict of arrays, one number per sample: the outputs by name, each in its
            unit, SI where the model returned Quantities; directions from -pi to pi. Returns one
            boolean per sample. Samples without an answer to an output that it reads are left out.

        Returns
        -------
        probability, standard_error : float [-]
            Between 0 and 1. If the condition holds in no sample or in every one, the error is 1
            over their number.

        Raises
        ------
        InputError
            A condition that does not return a boolean for every sample (code "bad_condition"), or
            that samples known from one side only leave open (code "one_sided"); or nothing was
            sampled, or an ``Interval`` is among the inputs (code "not_sampled").
        NoSolutionError
            No sample has an answer to all outputs that the condition reads.

        Examples
        --------
        Which of two cars was the faster one, from the lengths of their skids:

        >>> from collisions import travel
        >>> from collisions.uncertainty import Normal, Uniform, propagate
        >>> def skids(drag, length_a, length_b):
        ...     speed_a, speed_b = (travel.speed(x, drag=drag) for x in (length_a, length_b))
        ...     return {"speed_a": speed_a, "speed_b": speed_b}
        >>> lengths = {"length_a": Normal("31 m", "1 m"), "length_b": Normal("30 m", "1 m")}
        >>> found = propagate(skids, {"drag": Uniform(0.6, 0.8)} | lengths, seed=1)
        >>> chance, error = found.probability(lambda at: at["speed_a"] > at["speed_b"])
        >>> round(chance, 2), error < 0.01
        (0.76, True)
        """
        samples = {name: one for name, one in self.outputs.items() if isinstance(one, Sampled)}
        for name, output in self.outputs.items():
            if name not in samples:
                return output.probability(condition)
        sides = {name: one._sides for name, one in samples.items() if one._sides is not None}
        held = holds(
            condition, {name: one._asked_of(one.values) for name, one in samples.items()}, sides
        )

        def again(values: Callable[[Any], Any]) -> Any:
            columns = {name: one._asked_of(values(one)) for name, one in samples.items()}
            return holds(condition, columns)

        return next(iter(samples.values()))._share(held, again)

    def if_halved(self) -> Halved:
        """What to measure next: how wide the range of every output would be if the error of one
        input were halved.

        The model is run once more for each uncertain input, by the same method and with the same
        draws, at most 8,192, with each value of that input moved halfway to its mean; of an
        ``Interval``, halfway to its middle. Two measurements that agree with what is stated leave
        seven tenths of an error, four leave half. Where the better measurement would itself lie
        off the mean the range moves with it, and in a model that bends may become somewhat wider
        or narrower than stated here. The answer is kept, so a second call costs nothing. What is
        warned of these runs is not raised, but stands in ``statements`` and below the table.

        Returns
        -------
        Halved
            By input, the width of each output's 95 percent range [unit of the output]; by
            ``method="interval"``, of the whole range. And the share of the cases without an answer
            in each row, which the widths leave out.

        Raises
        ------
        InputError
            The propagation comes from a pickle, which does not hold the model (code "no_model").

        Examples
        --------
        >>> from collisions import travel
        >>> from collisions.uncertainty import Normal, propagate
        >>> found = propagate(
        ...     lambda drag, skid: {"speed": travel.speed(skid, drag=drag)},
        ...     {"drag": Normal(0.7, 0.05), "skid": Normal("25 m", "0.5 m")},
        ...     method="first_order",
        ... )
        >>> widths = found.if_halved()
        >>> round(widths.now["speed"], 2)
        2.69
        >>> {name: round(widths[name]["speed"], 2) for name in widths}
        {'drag': 1.49, 'skid': 2.62}
        """
        if self._halved is None:
            if self._run_halved is None:
                raise InputError(
                    "this propagation comes from a pickle, which does not hold its model, and what "
                    "half an error leaves takes new runs of it; call if_halved() before it is "
                    "pickled, or propagate again",
                    code="no_model",
                )
            self._halved = self._run_halved()
        return self._halved

    @property
    def statements(self) -> tuple[str, ...]:
        """What belongs with the figures, as sentences: every warning that this library gave while
        the model worked, by how many cases, and what is to be said of the method. What is warned of
        in fewer than 0.5 percent of the cases (95 percent where it is that readings differ) stands
        here alone and is not raised; that cases have no answer is raised of any. What a study
        within the model states is here too. Other warnings that the model gives are not here.
        """
        return tuple(note.statement for note in self.notes)

    def to_dict(self) -> dict[str, Any]:
        """Figures of all outputs and the inputs they are given, as nested plain values that strict
        JSON can hold.

        Returns
        -------
        dict
            Plain values that ``json.dumps`` writes; infinity and NaN as texts.
        """
        return {
            "method": self.method,
            "inputs": {name: rendered(value, 1000) for name, value in self.inputs.items()},
            "samples": self.samples,
            "failed": self.failed,
            "seed": self.seed,
            "interrupted": self.interrupted,
            "calls": dict(self.calls),
            "scatter": strict(self.scatter),
            "statements": list(self.statements),
            "outputs": {name: output.record() for name, output in self.outputs.items()},
        }

    def __repr__(self) -> str:
        lines = "\n".join(f"  {name}: {text}" for name, text in self._rows())
        cases = f"{self.samples} cases, {self.failed} without an answer"
        return f"<Propagation by {self.method}, {cases}; given the stated inputs\n{lines}>"

    def __str__(self) -> str:
        return str(self.summary())

    def _summary(self, numbers: Cells) -> Summary:
        title = (
            f"Given the stated inputs ({self.method}, {self.samples} cases, {self.failed} "
            "without an answer)"
        )
        stated = Part(
            [(name, str(value)) for name, value in self.inputs.items()], "Inputs as stated"
        )
        parts = [outputs_part(self.outputs, numbers), stated, all_numbers(self._rows())]
        return Summary(
            title, parts, [*map(as_sentence, self.statements), *bare_notes(self.outputs.values())]
        )

    def _texts(self) -> Iterator[str]:
        return units_of(self.inputs)

    def _rows(self) -> Iterator[tuple[str, str]]:
        return (output.row() for output in self.outputs.values())


def figures(output: Output, numbers: Numbers, kind: str | None = None) -> list[tuple[str, str]]:
    """What is known of an output, in words and numbers, for a table; ``kind`` is that of numbers
    without a unit.
    """
    kind = kind or KIND_OF.get(output.unit or "", numbers.unlisted)
    if kind is None:
        return [("figures", output.row()[1])]
    mean, std, (low, high) = ends_of(output.mean), ends_of(output.std), output.interval()
    ends = numbers.span(low, high, kind)
    if output.bounds_only:
        return [("range, wherever in the intervals the truth is", ends)]
    if (own := output._own_figures(numbers, kind)) is not None:
        return own
    if len(mean) > 1:
        return [
            ("mean, wherever in the intervals the truth is", numbers.span(mean[0], mean[1], kind)),
            ("range that holds 95 percent", ends),
        ]
    if math.isnan(std[0]):
        head = _NO_ANSWER if math.isnan(mean[0]) else _ONE_ANSWER
        return [(head, numbers.answer(mean[0], kind))]
    if not varies(output, kind):
        return [("the same in every case", numbers.answer(mean[0], kind))]
    return [
        ("mean ± standard deviation", numbers.answer(mean[0], kind, std[0])),
        ("95 percent interval", numbers.span(low, high, kind, std[0])),
    ]


def varies(output: Output, kind: str = "") -> bool:
    """Whether an output varies between cases by more than rounding."""
    size = max(map(abs, ends_of(output.mean)))
    return max(ends_of(output.std)) > max(NO_SPREAD * size, NOTHING.get(kind, NO_SPREAD))


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


def outputs_part(outputs: Mapping[str, Output], numbers: Cells, heading: str = "") -> Part:
    """The figures of outputs as rows of a summary."""
    rows = [(name, dict(figures(output, numbers))) for name, output in outputs.items()]
    heads = tuple(dict.fromkeys(head for _, row in rows for head in row))
    return Part(
        [(name, *(row.get(head, "") for head in heads)) for name, row in rows], heading, heads
    )


def bare_notes(outputs: Iterable[Output]) -> list[str]:
    """The sentence below the figures of outputs of which the model returned bare numbers."""
    bare = [output.name for output in outputs if output.unit is None]
    return (
        [f"Without a unit, as the model returned plain numbers: {', '.join(bare)}."] if bare else []
    )


def units_of(stated: Mapping[str, Any]) -> Iterator[str]:
    """The units that inputs were given in, each as a text."""
    return (
        f"1 {value.unit.written}"
        for value in stated.values()
        if hasattr(getattr(value, "unit", ""), "written")
    )


def ends_of(figure: Any) -> tuple[float, ...]:
    """One figure, or the ends of its range."""
    return tuple(map(float, figure)) if isinstance(figure, tuple) else (float(figure),)


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


def _ranked(shares: Mapping[str, float]) -> dict[str, float]:
    return dict(
        sorted(shares.items(), key=lambda item: -item[1] if item[1] == item[1] else math.inf)
    )
