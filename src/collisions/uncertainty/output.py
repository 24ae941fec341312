"""``Output``: one number of a study with mean, spread, quantiles, their standard errors, and shares
of variance by input; and how its figures are written.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..messages.errors import InputError
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
from ..quantities.reading import ArgumentReader
from ..quantities.refusals import must_be
from ..quantities.strict_json import strict
from ..quantities.tables import (
    Cells,
    Part,
    Summarized,
    Summary,
    all_numbers,
)
from ..quantities.units import rendered, unit_as_written
from .distribution import probability
from .probability import Condition

COVERAGE = 0.95
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


def ends_of(figure: Any) -> tuple[float, ...]:
    """One figure, or the ends of its range."""
    return tuple(map(float, figure)) if isinstance(figure, tuple) else (float(figure),)


def _ranked(shares: Mapping[str, float]) -> dict[str, float]:
    return dict(
        sorted(shares.items(), key=lambda item: -item[1] if item[1] == item[1] else math.inf)
    )
