"""What is known of one output: mean, spread, quantiles, each with its standard error, and where the spread comes from."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..errors import InputError
from ..quantities import OWN, Quantities, derived, returns, show
from ..units import shown
from .distribution import probability
from .normal import power_of_two

COVERAGE = 0.95


class Shares(NamedTuple):
    """The share of an output's variance that each input has: by itself, and with all it takes part in; standard errors of both.

    By input, largest total first; correlated inputs, and joint samples, cannot be told apart and share one: "mass_a & mass_b".
    """

    first: dict[str, float]
    total: dict[str, float]
    first_error: dict[str, float]
    total_error: dict[str, float]


class Histogram(NamedTuple):
    """Shares of the cases between edges, with their standard errors."""

    edges: Any
    shares: Any
    standard_errors: Any


class Output:
    """One named output of a propagation, given the stated inputs.

    Values are bare numbers: SI where the model returned Quantities, otherwise in whatever unit the model returned. With an
    ``Interval`` among the inputs every figure is a pair: the least and the most it may be, wherever in the interval the truth
    lies.

    Directions, which are angles with their unit that all lie from -pi to pi, are counted round the circle from the point
    opposite their mean, and so may pass pi. The mean is the direction to which the mean square of the way round is the least,
    in (-pi, pi]; the standard deviation is the root of this mean square; quantiles and intervals are those of the directions
    so counted. Of a normal error of a direction that is far less than half a turn these are its mean and standard deviation.
    """

    def __init__(self, name: str, unit: str | None, shares: Callable[[], Mapping[str, Shares]]) -> None:
        self.name = name
        self.unit = unit
        self._shares = shares
        self._cache: dict[str, Any] = {}

    @property
    def q(self) -> Any:
        """The same attributes as pint Quantities; only where the model returned Quantities."""
        if self.unit is None:
            raise InputError(
                f"{self.name!r} has no unit, because the model returned plain numbers; return a Quantity such as "
                f"impact.a.q.delta_v",
                code="no_unit",
                argument=self.name,
            )
        return Quantities(self)

    @derived(OWN)
    def mean(self) -> Any:
        """Expected value."""
        return self._mean()

    @derived(OWN)
    def std(self) -> Any:
        """Standard deviation."""
        return self._std()

    @derived(OWN)
    def mean_standard_error(self) -> Any:
        """Standard error of the mean from sampling; NaN for a local method, which has none and does not know its error."""
        return math.nan

    @derived(OWN)
    def std_standard_error(self) -> Any:
        """Standard error of the standard deviation from sampling; NaN for a local method."""
        return math.nan

    @returns(OWN)
    def quantile(self, p: Any) -> Any:
        """The value that is not exceeded with probability p, a number from 0 to 1 or an array of them."""
        return self._quantile(probability(p))

    @returns(OWN)
    def quantile_standard_error(self, p: Any) -> Any:
        """Standard error of a quantile from sampling; NaN for a local method."""
        return probability(p) * math.nan

    @returns(OWN)
    def interval(self, coverage: float = COVERAGE) -> tuple[float, float]:
        """The range (low, high) that holds the value with this probability, as much below it as above.

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
        share = _one_probability(coverage)
        low, high = self._quantile(np.array([0.5 - 0.5 * share, 0.5 + 0.5 * share]))
        return float(low), float(high)

    @property
    def contributions(self) -> dict[str, float]:
        """By input, the share of the variance that it has by itself; what is left to 1 is interaction. Largest first."""
        return _ranked(self._shares()[self.name].first)

    @property
    def total_contributions(self) -> dict[str, float]:
        """By input, the share of the variance that would go if it were known: with all interactions it is in."""
        return _ranked(self._shares()[self.name].total)

    @property
    def contribution_standard_errors(self) -> dict[str, tuple[float, float]]:
        """By input, the standard errors of its contribution and of its total contribution; NaN for a local method."""
        found = self._shares()[self.name]
        return {name: (found.first_error[name], found.total_error[name]) for name in _ranked(found.total)}

    def histogram(self, bins: int = 40) -> Histogram:
        """Edges, shares of the cases between them and their standard errors: for a chart; only from sampling."""
        raise InputError(
            f"{self.name!r} has no histogram, because nothing was sampled; take method='quasi_random'",
            code="not_sampled",
            argument="method",
        )

    def row(self) -> tuple[str, str]:
        """Name and figures as a text."""
        low, high = self.interval()
        unit = f" {self.unit}" if self.unit else ""
        if math.isnan(self.std):
            return self.name, f"{show(self.mean)}{unit} in the one case that has an answer, so no spread is known"
        return self.name, f"{show(self.mean)} ± {show(self.std)}{unit}, 95 percent from {low:.6g} to {high:.6g}{unit}"

    def record(self) -> dict[str, Any]:
        """The figures as plain values that strict JSON can hold."""
        found: dict[str, Any] = {"unit": self.unit, "mean": self.mean, "std": self.std}
        found["mean_standard_error"] = self.mean_standard_error
        found["std_standard_error"] = self.std_standard_error
        found["interval_95"] = list(self.interval())
        found["contributions"] = self.contributions
        found["total_contributions"] = self.total_contributions
        return {name: _plain(value) for name, value in found.items()}

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_shares": _Told(self._shares())}

    def __repr__(self) -> str:
        name, text = self.row()
        return f"<{name}: {text}, given the stated inputs>"

    def _mean(self) -> Any:
        raise NotImplementedError

    def _std(self) -> Any:
        raise NotImplementedError

    def _quantile(self, p: Any) -> Any:
        raise NotImplementedError

    def _turn(self, turns: float) -> None:
        """Counts directions by so many turns more."""


class _Told:
    """Shares worked out before, for a pickle, which cannot hold the user's model."""

    def __init__(self, shares: Mapping[str, Shares]) -> None:
        self.shares = shares

    def __call__(self) -> Mapping[str, Shares]:
        return self.shares


def _one_probability(coverage: Any) -> float:
    found = probability(coverage, "coverage")
    if not isinstance(found, float):
        raise InputError(f"coverage must be one number, got {shown(coverage)}", code="bad_fraction", argument="coverage")
    return found


def average(values: Any) -> float:
    """The mean, of numbers whose sum may leave the range of floats too."""
    scale = power_of_two(values)
    return float(np.mean(values / scale)) * scale


def deviation(values: Any) -> float:
    """The standard deviation with one degree of freedom less than values, whose squares may leave the range of floats."""
    scale = power_of_two(values)
    return float(np.std(values / scale, ddof=1)) * scale if len(values) > 1 else math.nan


def _ranked(shares: Mapping[str, float]) -> dict[str, float]:
    return dict(sorted(shares.items(), key=lambda item: -item[1] if item[1] == item[1] else math.inf))


def _plain(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if isinstance(value, list):
        return [_plain(part) for part in value]
    return {name: _plain(part) for name, part in value.items()} if isinstance(value, dict) else value
