"""``OneSidedOutput``: the figures of an output of which some cases are known from one side only."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from ..messages.errors import InputError
from ..messages.shares import in_percent
from ..messages.warning import Note
from ..quantities.attributes import OWN_UNIT, derived
from ..quantities.formatting import Numbers
from ..quantities.strict_json import strict
from . import turns as angles
from .output import COVERAGE, Histogram, Output, Shares
from .sampled import Sampled

_PERCENT = f"{100.0 * (0.5 + 0.5 * COVERAGE):g}"


def range_in_words(low: float, high: float, text: Callable[[float], str], percent: str) -> str:
    """A range of which an end may be infinite, its numbers written by ``text``."""
    if math.isnan(low + high) and not math.isinf(low):
        return "no case has an answer"
    if math.isinf(low) and math.isinf(high):
        return f"open on both sides at {100.0 * COVERAGE:g} {percent}"
    if math.isinf(high):
        return f"at least {text(low)}, {_PERCENT} {percent}"
    if math.isinf(low):
        return f"at most {text(high)}, {_PERCENT} {percent}"
    return f"{text(low)} to {text(high)}, {100.0 * COVERAGE:g} {percent}"


class OneSidedOutput(Sampled):
    """A sampled output of which some cases only say "at least", or "at most".

    Such a case counts as minus or plus infinity wherever that leaves the range wider: a low end is
    the quantile of the cases with those of "at most" at minus infinity, a high end that with those
    of "at least" at infinity. So an end is infinite where their share decides it.

    Attributes
    ----------
    sides : array of int [-]
        For each case 1 (at least its value), -1 (at most) or 0 (known both ways).
    """

    def __init__(
        self,
        name: str,
        unit: str | None,
        values: Any,
        sides: Any,
        shares: Callable[[], Mapping[str, Shares]],
    ) -> None:
        super().__init__(name, unit, values, shares)
        # What is unbounded is no direction on a circle.
        self._directions = None
        self.values, self.sides = values, sides
        self._sides = sides
        sides.setflags(write=False)

    def may_wrap(self) -> bool:
        """Whether its values lie near pi and near -pi: they are numbers on a line, as "at least"
        means nothing round a circle.

        Returns
        -------
        bool
            Whether they do.
        """
        return self._wraps() is not None

    def _wraps(self) -> str | None:
        angle = self.unit in (None, "rad") and angles.jump(self._answered)
        return angles.ONE_SIDED if angle else None

    def shares_of_sides(self) -> tuple[float, float]:
        """Shares of the cases with an answer that say "at least", and "at most".

        Returns
        -------
        tuple of two floats
            Both shares.
        """
        sides = self.sides[~np.isnan(self.values)]
        return float(np.mean(sides > 0)), float(np.mean(sides < 0))

    @derived(OWN_UNIT)
    def mean_standard_error(self) -> Any:
        """NaN: without a mean it has no error."""
        return math.nan

    @derived(OWN_UNIT)
    def std_standard_error(self) -> Any:
        """NaN: without a standard deviation it has no error."""
        return math.nan

    def histogram(self, bins: int = 30) -> Histogram:
        """None: the cases known from one side have no place in it.

        Parameters
        ----------
        bins : int
            Number of bars.

        Returns
        -------
        Histogram
            Never.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(
            f"{self.name!r} has no histogram, because some of its cases are known from one "
            "side only; look at its interval(), or find a distribution with "
            "`reconstruct.posterior` and a prior",
            code="one_sided",
            argument=self.name,
        )

    def row(self) -> tuple[str, str]:
        """Name and range as text.

        Returns
        -------
        tuple of two texts
            The name, and the range.
        """
        unit = f" {self.unit}" if self.unit else ""
        return self.name, self._range(lambda value: f"{value:.6g}{unit}", "percent")

    def _own_figures(self, numbers: Numbers, kind: str) -> list[tuple[str, str]] | None:
        """The range, in words and numbers, for a table."""
        text = self._range(lambda value: numbers.answer(value, kind), "%")
        return [("range, known from one side in some cases", text)]

    def record(self) -> dict[str, Any]:
        """The figures as plain values that strict JSON can hold, with the shares of the cases that
        say "at least" and "at most".

        Returns
        -------
        dict
            Plain values that ``json.dumps`` writes; infinity and NaN as texts.
        """
        found = super().record()
        at_least, at_most = self.shares_of_sides()
        more: dict[str, Any] = strict({"at_least": at_least, "at_most": at_most})
        return found | more

    def _range(self, text: Callable[[float], str], percent: str) -> str:
        return range_in_words(*self.interval(), text, percent)

    def _mean(self) -> Any:
        return math.nan

    def _std(self) -> Any:
        return math.nan

    def _shares(self) -> Shares:
        return Shares({}, {}, {}, {})

    def _quantile(self, p: Any) -> Any:
        """Below a half that of the low ends, above that of the high ends; at a half NaN where these
        differ.
        """
        known = ~np.isnan(self.values)
        if not np.any(known):
            return p * math.nan
        share = np.asarray(p, dtype=np.float64)
        low, high = (_quantiles(self._counted(side)[known], share) for side in (-1, 1))
        middle = np.where(low == high, low, np.nan)
        found = np.where(share < 0.5, low, np.where(share > 0.5, high, middle))
        return found if found.ndim else float(found)

    def _quantile_error(self, share: float) -> float:
        if not math.isfinite(self._quantile(share)):
            return math.nan
        counted = self._counted(-1 if share < 0.5 else 1)
        error = self._like(self.name, counted)._quantile_error(share)
        # Within two errors of the share the quantile may be infinite.
        return math.inf if math.isnan(error) and 0.0 < share < 1.0 else error

    def _counted(self, side: int) -> Any:
        """The values, those of cases that this side leaves open at infinity."""
        return np.where(np.sign(self.sides) == side, side * np.inf, self.values)


def _quantiles(values: Any, share: Any) -> Any:
    """Quantiles of values that may be infinite: between a finite and an infinite one the latter."""
    at = np.ravel(share)
    with np.errstate(invalid="ignore"):
        found = np.quantile(values, at)
        # Between infinite values numpy takes their difference, which is NaN.
        if np.any(values == np.inf):
            found = np.where(np.isnan(found), np.quantile(values, at, method="higher"), found)
        elif np.any(values == -np.inf):
            found = np.where(np.isnan(found), np.quantile(values, at, method="lower"), found)
    return found.reshape(share.shape)


def one_sided_notes(outputs: Mapping[str, Output]) -> Iterator[Note]:
    """What the cases known from one side mean for each output."""
    for name, output in outputs.items():
        if not isinstance(output, OneSidedOutput):
            continue
        for share, word, end in zip(
            output.shares_of_sides(), ("at least", "at most"), ("high", "low"), strict=True
        ):
            if share > 0.0:
                yield Note(
                    None,
                    f"in {in_percent(share, 1.0)} of the cases {name} is known from one side "
                    f"only, as {word} its value: the {end} end of a range is infinite where "
                    "these decide it, and mean and standard deviation do not exist. "
                    "`reconstruct.posterior` with a prior for it has two sides",
                    code="one_sided",
                    fields={"output": name, "share": share},
                )
