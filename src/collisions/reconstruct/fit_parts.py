"""The parts of the answer of a fit: numbers by name, one unknown, one observation, one direction that stays open."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from ..errors import InputError
from ..quantities import OWN, Shown, show
from ..uncertainty.normal import score_of_coverage
from ..units import shown, to_quantity

TWO_ERRORS = 2.0


class Values(dict[str, float]):
    """SI numbers by name; with their units through ``.q``, as far as they were given any."""

    __slots__ = ("units",)

    def __init__(self, values: Mapping[str, float], units: Mapping[str, str]) -> None:
        super().__init__(values)
        self.units = dict(units)

    @property
    def q(self) -> dict[str, Any]:
        """The same as Quantities; a number of an unknown unit stays a number."""
        return {name: quantity(value, self.units[name]) for name, value in self.items()}

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (dict(self), self.units)


class WithUnit(Shown):
    """Numbers that share one unit, which differs from one to the next."""

    __slots__ = ()
    unit: str

    @property
    def q(self) -> dict[str, Any]:
        """The numbers that have the unit as Quantities; those of an unknown unit stay numbers."""
        return {name: quantity(getattr(self, name), self.unit) for name in self._in_unit()}

    def _in_unit(self) -> list[str]:
        return [f.name for f in fields(self) if f.metadata.get("unit") == OWN and getattr(self, f.name) is not None]

    def _rows(self, prefix: str = "") -> Iterator[tuple[str, str]]:
        for f in fields(self):
            value = getattr(self, f.name)
            if value is not None and f.name != "unit":
                yield prefix + f.name, show(value, self.unit if f.metadata.get("unit") == OWN else None)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Estimate(WithUnit):
    """One unknown: its value and standard error, NaN and inf where nothing determines it; ``at_bound`` is "low" or "high".

    ``reach`` is None but where the model turns round on the bound: then it is the end of the range of two standard errors.
    """

    name: str
    unit: str
    value: float = field(metadata={"unit": OWN})
    standard_error: float = field(metadata={"unit": OWN})
    low: float = field(metadata={"unit": OWN})
    high: float = field(metadata={"unit": OWN})
    at_bound: str | None
    reach: float | None = field(default=None, metadata={"unit": OWN})

    _title = "Estimate"

    @property
    def determined(self) -> bool:
        """Whether evidence or a prior tells it."""
        return math.isfinite(self.standard_error)

    def interval(self, coverage: float) -> tuple[float, float]:
        """Central range that holds the truth with this probability given the stated errors, cut off at the bounds.

        Normal theory around the estimate; the bounds themselves where nothing determines the unknown. From a bound on which the
        model turns round to ``reach`` for any coverage up to that of two standard errors (0.9545), and the bounds above it.
        """
        if isinstance(coverage, bool) or not isinstance(coverage, (int, float)) or not 0.0 < coverage < 1.0:
            raise InputError(
                f"coverage must be between 0 and 1, such as 0.95, got {shown(coverage)}",
                code="bad_fraction",
                argument="coverage",
            )
        score = score_of_coverage(float(coverage))
        if not self.determined or (self.reach is not None and score > TWO_ERRORS):
            return self.low, self.high
        if self.reach is not None:
            return min(self.value, self.reach), max(self.value, self.reach)
        half = score * self.standard_error
        return max(self.low, self.value - half), min(self.high, self.value + half)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Residual(WithUnit):
    """One observation or prior: what was stated, what the fit makes of it, and by how many sigma they differ.

    ``residual`` is observed less computed; of angles by the short way round, in (-pi, pi].
    """

    name: str
    unit: str
    observed: float = field(metadata={"unit": OWN})
    computed: float = field(metadata={"unit": OWN})
    residual: float = field(metadata={"unit": OWN})
    sigma: float = field(metadata={"unit": OWN})
    over_sigma: float
    is_prior: bool

    _title = "Residual"


@dataclass(frozen=True, slots=True, kw_only=True)
class Direction:
    """A change of the unknowns that the evidence does not tell: that of each in SI, all moving together.

    ``held_by_prior`` says whether what was stated before settles it; otherwise nothing does.
    """

    changes: dict[str, float]
    held_by_prior: bool

    @property
    def unknowns(self) -> tuple[str, ...]:
        """Those that take part."""
        return tuple(self.changes)

    @property
    def sentence(self) -> str:
        """The same in words."""
        if len(self.changes) == 1:
            what = f"{self.unknowns[0]} is not determined by the evidence"
        else:
            first, *rest = self.changes
            moves = ", ".join(f"{name} by {self.changes[name] / self.changes[first]:+.4g}" for name in rest)
            what = f"the evidence cannot tell a change of {first} by +1 together with {moves} (SI)"
        return what + (", which rests on what was stated before" if self.held_by_prior else ", and nothing else tells it")


def quantity(value: float, unit: str) -> Any:
    """With its unit, or the number itself where that is not known."""
    return to_quantity(value, unit) if unit else value
