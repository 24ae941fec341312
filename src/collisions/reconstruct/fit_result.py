"""What a fit answers with: estimates and their errors, how each observation is met, and what stays open."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from ..errors import InputError, NoSolutionError
from ..fields import Shown, derived, show
from ..uncertainty.inputs import Normal
from ..uncertainty.standard_normal import score_of_coverage
from ..units import shown, to_quantity

BENT = 0.2  # of the half-width of a 95 percent interval
CONTRADICTION = 0.01  # chance below which evidence is said to contradict itself


class Values(dict[str, float]):
    """SI numbers by name; with their units through ``.q``, as far as they were given any."""

    __slots__ = ("units",)

    def __init__(self, values: Mapping[str, float], units: Mapping[str, str]) -> None:
        super().__init__(values)
        self.units = dict(units)

    @property
    def q(self) -> dict[str, Any]:
        """The same as Quantities; a number of an unknown unit stays a number."""
        return {name: _quantity(value, self.units[name]) for name, value in self.items()}

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (dict(self), self.units)


class _WithUnit(Shown):
    """Numbers that share one unit, which differs from one to the next."""

    __slots__ = ()
    unit: str

    @property
    def q(self) -> dict[str, Any]:
        """The numbers that have the unit as Quantities; those of an unknown unit stay numbers."""
        return {name: _quantity(getattr(self, name), self.unit) for name in self._in_unit()}

    def _in_unit(self) -> list[str]:
        return [f.name for f in fields(self) if f.metadata.get("unit") == "own"]

    def _rows(self, prefix: str = "") -> Iterator[tuple[str, str]]:
        for f in fields(self):
            value = getattr(self, f.name)
            if value is not None and f.name != "unit":
                yield prefix + f.name, show(value, self.unit if f.metadata.get("unit") == "own" else None)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Estimate(_WithUnit):
    """One unknown: its value and standard error, NaN and inf where nothing determines it; ``at_bound`` is "low" or "high"."""

    name: str
    unit: str
    value: float = field(metadata={"unit": "own"})
    standard_error: float = field(metadata={"unit": "own"})
    low: float = field(metadata={"unit": "own"})
    high: float = field(metadata={"unit": "own"})
    at_bound: str | None

    _title = "Estimate"

    @property
    def determined(self) -> bool:
        """Whether evidence or a prior tells it."""
        return math.isfinite(self.standard_error)

    def interval(self, coverage: float) -> tuple[float, float]:
        """Central range that holds the truth with this probability given the stated errors, cut off at the bounds.

        Normal theory around the estimate; the bounds themselves where nothing determines the unknown.
        """
        if isinstance(coverage, bool) or not isinstance(coverage, (int, float)) or not 0.0 < coverage < 1.0:
            raise InputError(
                f"coverage must be between 0 and 1, such as 0.95, got {shown(coverage)}",
                code="bad_fraction",
                argument="coverage",
            )
        if not self.determined:
            return self.low, self.high
        half = score_of_coverage(float(coverage)) * self.standard_error
        return max(self.low, self.value - half), min(self.high, self.value + half)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Residual(_WithUnit):
    """One observation or prior: what was stated, what the fit makes of it, and by how many sigma they differ.

    ``residual`` is observed less computed; of angles by the short way round, in (-pi, pi].
    """

    name: str
    unit: str
    observed: float = field(metadata={"unit": "own"})
    computed: float = field(metadata={"unit": "own"})
    residual: float = field(metadata={"unit": "own"})
    sigma: float = field(metadata={"unit": "own"})
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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Fit(Shown):
    """Unknowns that fit what was observed, given the stated errors.

    ``values`` are SI floats by name, NaN where nothing determines an unknown; ``fit["speed_a"]`` has value, standard error and
    interval. ``covariance`` (locked, in the order of ``names``) is that of the model's slopes at the answer, with inf and NaN
    for what is open; where an unknown is in ``at_bounds`` it is that without the bound, so the errors of all are not too small,
    and that of the unknown itself reaches to one side only. ``residuals`` and ``contributions`` go by the names of the
    observations, and "prior of x" for those of the unknowns. ``contributions[unknown][observation]`` is the share of the
    unknown's variance that the error of the observation makes. ``nonlinearity`` is by how much, relatively, a 95
    percent interval is too narrow or too wide, by the rise of chi-squared where an unknown is moved by two standard errors and
    the others are fitted again; NaN if the model refuses there. ``searches`` counts the starts by how they ended.
    """

    values: Values = field()
    names: tuple[str, ...] = field()
    units: dict[str, str] = field()
    bounds: dict[str, tuple[float, float]] = field()
    covariance: Any = field()
    residuals: dict[str, Residual] = field()
    contributions: dict[str, dict[str, float]] = field()
    chi_squared: float = field(metadata={"unit": ""})
    degrees_of_freedom: int = field(metadata={"unit": ""})
    p_value: float = field(metadata={"unit": ""})
    undetermined: tuple[Direction, ...] = field()
    at_bounds: dict[str, str] = field()
    nonlinearity: float = field(metadata={"unit": ""})
    searches: dict[str, int] = field()

    _title = "Fit to evidence"

    def __getitem__(self, name: str) -> Estimate:
        if name not in self.names:
            raise InputError(
                f"{name!r} is none of the unknowns, which are {', '.join(self.names)}", code="unknown_name", argument="name"
            )
        low, high = self.bounds[name]
        return Estimate(
            name=name,
            unit=self.units[name],
            value=self.values[name],
            standard_error=self.standard_errors[name],
            low=low,
            high=high,
            at_bound=self.at_bounds.get(name),
        )

    @property
    def standard_errors(self) -> Values:
        """By unknown; inf where nothing determines it."""
        roots = np.sqrt(np.diagonal(self.covariance)).tolist()
        return Values(dict(zip(self.names, roots, strict=True)), self.units)

    @derived()
    def correlation_matrix(self) -> Any:
        """In the order of ``names``; NaN for what is not determined."""
        errors = np.sqrt(np.diagonal(self.covariance))
        known = np.isfinite(errors)
        size = np.where(known, errors, np.nan)
        found = np.clip(self.covariance / np.outer(size, size), -1.0, 1.0)
        found[known, known] = 1.0
        return found

    @property
    def correlation(self) -> dict[tuple[str, str], float]:
        """By pair of unknowns, as ``uncertainty.propagate`` takes it beside ``inputs``."""
        self._check_determined("correlation")
        pairs = [(i, j) for i in range(len(self.names)) for j in range(i + 1, len(self.names))]
        return {(self.names[i], self.names[j]): float(self.correlation_matrix[i, j]) for i, j in pairs}

    @property
    def inputs(self) -> dict[str, Normal]:
        """By unknown, the estimate as a normal distribution within its bounds, as ``uncertainty.propagate`` takes it."""
        self._check_determined("inputs")
        return {name: self._as_normal(name) for name in self.names}

    @property
    def consistent(self) -> bool | None:
        """Whether the evidence agrees with itself and the model; None where there is no more of it than unknowns."""
        return None if math.isnan(self.p_value) else self.p_value >= CONTRADICTION

    @property
    def bend(self) -> str:
        """How far the standard errors can be relied on, in words."""
        if math.isnan(self.nonlinearity):
            return "the model refuses within two standard errors of the answer, so that the errors are not symmetric"
        return (
            f"the model bends within two standard errors of the answer: the 95 percent intervals are off by "
            f"{self.nonlinearity:.0%} of their half-width, and the standard errors are as rough"
        )

    @property
    def statements(self) -> tuple[str, ...]:
        """What has to be said with the numbers, in sentences."""
        return tuple(self._statements())

    def to_dict(self) -> dict[str, Any]:
        """Everything as strict JSON: an infinity and NaN by name."""
        unknowns = [self[name] for name in self.names]
        found = {
            "unknowns": {one.name: {f.name: getattr(one, f.name) for f in fields(one)} for one in unknowns},
            "covariance": self.covariance.tolist(),
            "residuals": {name: {f.name: getattr(one, f.name) for f in fields(one)} for name, one in self.residuals.items()},
            "undetermined": [
                {"changes": one.changes, "held_by_prior": one.held_by_prior, "sentence": one.sentence}
                for one in self.undetermined
            ],
            "statements": list(self.statements),
        }
        plain = ("contributions", "chi_squared", "degrees_of_freedom", "p_value", "at_bounds", "nonlinearity", "searches")
        strict: dict[str, Any] = _strict({"names": list(self.names), **found, **{name: getattr(self, name) for name in plain}})
        return strict

    def __str__(self) -> str:
        rows = list(self._rows())
        width = max(len(name) for name, _ in rows)
        return "\n".join([self._title, *(f"{name:<{width}}  {text}" for name, text in rows)])

    def __repr__(self) -> str:
        estimates = ", ".join(f"{name}={_with_error(self[name])}" for name in self.names)
        return (
            f"Fit({estimates}, chi_squared={self.chi_squared:.4g}, degrees_of_freedom={self.degrees_of_freedom}, "
            f"p_value={self.p_value:.3g})"
        )

    def _rows(self, prefix: str = "") -> Iterator[tuple[str, str]]:
        for name in self.names:
            bound = f", at its {self.at_bounds[name]} bound" if name in self.at_bounds else ""
            yield prefix + name, _with_error(self[name]) + bound
        for name, one in self.residuals.items():
            numbers = f"observed {show(one.observed, one.unit)}, computed {show(one.computed, one.unit)}"
            yield prefix + name, f"{numbers}, residual over sigma {one.over_sigma:+.2f}"
        yield prefix + "chi-squared", f"{self.chi_squared:.4g} with {self.degrees_of_freedom} degrees of freedom"
        for number, sentence in enumerate(self.statements, 1):
            yield f"{prefix}note {number}", sentence

    def _statements(self) -> Iterator[str]:
        if self.consistent is None:
            yield "there is no more evidence than unknowns, so that nothing checks it"
        else:
            verdict = "agrees with itself" if self.consistent else "contradicts itself, the model or the stated errors"
            yield f"the evidence {verdict}: a misfit this large or larger has a chance of {self.p_value:.2g}"
        for direction in self.undetermined:
            yield direction.sentence
        for name, side in self.at_bounds.items():
            inward = "above" if side == "low" else "below"
            yield (
                f"{name} ended on its {side} bound, beyond which the evidence pulls it: its error is not symmetric and reaches "
                f"{inward} only"
            )
        if math.isnan(self.nonlinearity) or self.nonlinearity > BENT:
            yield self.bend

    def _as_normal(self, name: str) -> Normal:
        one = self[name]
        unit = f" {one.unit}" if one.unit else ""

        def told(value: float) -> Any:
            return f"{value!r}{unit}" if unit and math.isfinite(value) else value

        ends = (told(one.low) if math.isfinite(one.low) else None, told(one.high) if math.isfinite(one.high) else None)
        return Normal(told(one.value), told(one.standard_error), truncate=None if ends == (None, None) else ends)

    def _check_determined(self, what: str) -> None:
        left = [name for name in self.names if not self[name].determined]
        if left:
            raise NoSolutionError(
                f"{what} need every unknown determined, and nothing determines {', '.join(left)}; give a prior of it (a "
                f"Normal), leave it out, or read the others from .values and .covariance",
                code="undetermined",
                unknowns=tuple(left),
            )


def _quantity(value: float, unit: str) -> Any:
    return to_quantity(value, unit) if unit else value


def _with_error(one: Estimate) -> str:
    unit = f" {one.unit}" if one.unit else ""
    if not one.determined:
        return "not determined"
    return f"{one.value:.6g} +/- {one.standard_error:.3g}{unit}"


def _strict(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _strict(part) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_strict(part) for part in value]
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else "inf" if value > 0.0 else "-inf"
    return value
