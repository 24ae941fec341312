"""What a fit answers with: estimates and their errors, how each observation is met, and what stays open."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from ..errors import InputError, NoSolutionError
from ..quantities import Shown, derived, show
from ..uncertainty.distributions import Normal
from .fit_parts import Direction, Estimate, Residual, Values

BENT = 0.2  # of the half-width of a 95 percent interval
# Chances of the misfit below which evidence is said to agree with itself weakly, and to contradict itself.
WEAK, CONTRADICTION = 0.05, 0.01


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
    the others are fitted again (where a bound is nearer, moved there); NaN if the model refuses there. ``reaches`` has the
    unknowns that ended on a bound on which the model turns round, so that its slopes tell no error: the value up to which
    chi-squared rises by no more than 4 while the others are fitted again. The standard error of such an unknown is half of the
    way there, and the covariance of the others is that with it on its bound. ``searches`` counts the starts by how they ended;
    ``around`` are those among them that were added around an answer that few found.
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
    reaches: dict[str, float] = field()
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
            reach=self.reaches.get(name),
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
        """Whether a misfit this large has a chance of 0.01 or more; None where there is no more evidence than unknowns."""
        return None if math.isnan(self.p_value) else self.p_value >= CONTRADICTION

    @property
    def _chance(self) -> str:
        """The chance of a misfit this large or larger, in two digits that round it past neither 0.05 nor 0.01."""
        text = f"{self.p_value:.2g}"
        for limit in (WEAK, CONTRADICTION):
            if self.p_value < limit <= float(text):
                return f"just below {limit:g}"
        return text

    @property
    def told_by_bounds(self) -> tuple[str, ...]:
        """The unknowns whose standard error exceeds the width of their bounds."""
        widths = {name: high - low for name, (low, high) in self.bounds.items()}
        return tuple(name for name in self.names if widths[name] < self.standard_errors[name] < math.inf)

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
        counts = ("chi_squared", "degrees_of_freedom", "p_value", "nonlinearity", "searches")
        plain = {name: getattr(self, name) for name in ("contributions", "at_bounds", "reaches", *counts)}
        strict: dict[str, Any] = _strict({"names": list(self.names), **found, **plain})
        return strict

    def __str__(self) -> str:
        rows = list(self._rows())
        width = max(len(name) for name, _ in rows)
        return "\n".join([self._title, *(f"{name:<{width}}  {text}" for name, text in rows)])

    def __repr__(self) -> str:
        estimates = ", ".join(f"{name}={_with_error(self[name])}" for name in self.names)
        return (
            f"Fit({estimates}, chi_squared={self.chi_squared:.4g}, degrees_of_freedom={self.degrees_of_freedom}, "
            f"p_value={'not defined' if math.isnan(self.p_value) else f'{self.p_value:.3g}'}, errors given the stated errors)"
        )

    def _rows(self, prefix: str = "") -> Iterator[tuple[str, str]]:
        for name in self.names:
            bound = f", at its {self.at_bounds[name]} bound" if name in self.at_bounds else ""
            yield prefix + name, _with_error(self[name]) + bound
        yield f"{prefix}errors", "+/- is one standard error, given the stated errors of the observations and priors"
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
            verdict = "agrees with itself"
            if not self.consistent:
                verdict = "contradicts itself, the model or the stated errors"
            elif self.p_value < WEAK:
                verdict = "agrees only weakly with itself, the model and the stated errors"
            yield f"the evidence {verdict}: a misfit this large or larger has a chance of {self._chance}"
        for direction in self.undetermined:
            yield direction.sentence
        for name, side in self.at_bounds.items():
            inward = "above" if side == "low" else "below"
            if name in self.reaches:
                yield (
                    f"{name} ended on its {side} bound, where the model turns round: its error reaches {inward} only, and two "
                    f"errors, at the rise of chi-squared by 4 or the other bound, to {show(*self._reach(name))}"
                )
            else:
                yield (
                    f"{name} ended on its {side} bound, beyond which the evidence pulls it: its error is not symmetric and "
                    f"reaches {inward} only"
                )
        for name in self.told_by_bounds:
            yield (
                f"the standard error of {name}, {self.standard_errors[name]:.3g}, exceeds the width of its bounds: they tell "
                f"its range, not the evidence"
            )
        if self.searches["around"]:
            yield (
                f"few searches ended at this answer, so that {self.searches['around']} more were begun around it; a better one "
                f"may still lie between them, which narrower bounds would show"
            )
        if math.isnan(self.nonlinearity) or self.nonlinearity > BENT:
            yield self.bend

    def _reach(self, name: str) -> tuple[float, str | None]:
        return self.reaches[name], self.units[name] or None

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
