"""What is known of one output where an input is an interval: the range of every figure over what the interval allows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..errors import InputError
from ..quantities import OWN, derived, returns
from . import angles
from .output import COVERAGE, Output, Shares


class Bounds(Output):
    """An output with an interval among its inputs: the range of every figure over what the interval allows."""

    def __init__(self, name: str, unit: str | None, cases: list[Output], end: float | None = None) -> None:
        super().__init__(name, unit, dict)
        self.cases = cases
        # One turn for the means of all directions, the one that ends there, or the figures could not be compared.
        for case in cases if end is not None else []:
            turns = round((float(angles.folded(case.mean, end)) - case.mean) / (2.0 * math.pi))
            if turns:
                case._turn(turns)

    @derived(OWN)
    def mean_standard_error(self) -> Any:
        """The largest standard error among the means."""
        return max(case.mean_standard_error for case in self.cases)

    @derived(OWN)
    def std_standard_error(self) -> Any:
        """The largest standard error among the standard deviations."""
        return max(case.std_standard_error for case in self.cases)

    @returns(OWN)
    def quantile_standard_error(self, p: Any) -> Any:
        """The largest standard error among the quantiles."""
        return np.max([case.quantile_standard_error(p) for case in self.cases], axis=0)

    @returns(OWN)
    def interval(self, coverage: float = COVERAGE) -> tuple[float, float]:
        """The range (low, high) that holds the value with at least this probability wherever in the interval the truth lies."""
        ends = [case.interval(coverage) for case in self.cases]
        return min(low for low, _ in ends), max(high for _, high in ends)

    @property
    def contributions(self) -> dict[str, float]:
        """Refused: an interval says nothing of likelihood, so there is no variance to share."""
        raise InputError(
            f"{self.name!r} has no variance to share, because an Interval among the inputs says nothing of likelihood; give it "
            f"a distribution, or compare the bounds with and without it",
            code="no_variance",
            argument=self.name,
        )

    @property
    def total_contributions(self) -> dict[str, float]:
        """Refused, like ``contributions``."""
        return self.contributions

    @property
    def contribution_standard_errors(self) -> dict[str, tuple[float, float]]:
        """Refused, like ``contributions``."""
        return dict.fromkeys(self.contributions, (math.nan, math.nan))

    def row(self) -> tuple[str, str]:
        """Name and figures as a text."""
        low, high = self.interval()
        unit = f" {self.unit}" if self.unit else ""
        least, most = self.mean
        if (least, most) == (low, high):
            return self.name, f"between {low:.6g} and {high:.6g}{unit}"
        return self.name, f"mean between {least:.6g} and {most:.6g}{unit}, 95 percent within {low:.6g} to {high:.6g}{unit}"

    def record(self) -> dict[str, Any]:
        """The figures as plain values that strict JSON can hold."""
        return {
            "unit": self.unit,
            "mean": list(self.mean),
            "std": list(self.std),
            "interval_95": list(self.interval()),
        }

    def _mean(self) -> Any:
        return _range(case.mean for case in self.cases)

    def _std(self) -> Any:
        return _range(case.std for case in self.cases)

    def _quantile(self, p: Any) -> Any:
        found = np.array([case.quantile(p) for case in self.cases])
        low, high = found.min(axis=0), found.max(axis=0)
        return (low, high) if np.ndim(low) else (float(low), float(high))


class Known(Output):
    """An output worked out once, with nothing uncertain about it: one place of an interval."""

    def __init__(self, name: str, unit: str | None, value: float) -> None:
        super().__init__(name, unit, lambda: {name: Shares({}, {}, {}, {})})
        self.value = value

    def _mean(self) -> Any:
        return self.value

    def _std(self) -> Any:
        return 0.0

    def _quantile(self, p: Any) -> Any:
        return self.value + 0.0 * p


def _range(figures: Any) -> tuple[float, float]:
    found = list(figures)
    return min(found), max(found)
