"""``FitInputs``: unknowns with their prior knowledge, observations with their errors, and the model as a numeric function."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..errors import InputError
from ..reading import ArgumentReader
from ..uncertainty.distribution import read_alike
from ..uncertainty.distributions import Distribution, Interval, Normal, Uniform, range_hint
from ..uncertainty.model import Model, check_names
from ..units import is_quantity
from .least_squares import Problem
from .observations import Observation, observed_columns, read_each, read_value

_PRIOR_SPAN = 3.0  # standard deviations of a prior within which searches start


class Unknown(NamedTuple):
    """Prior knowledge of one unknown: a start, a scale, bounds, and a prior if any."""

    unit: str
    start: float
    scale: float
    low: float
    high: float
    prior: Normal | None

    @property
    def box(self) -> tuple[float, float]:
        """The interval in which searches start: the bounds, or the scale about the start."""
        span = (_PRIOR_SPAN if self.prior else 1.0) * self.scale
        return max(self.low, self.start - span), min(self.high, self.start + span)


class FitInputs(NamedTuple):
    """The inputs of a fit; ``rows`` are the observations in their order, then the priors."""

    model: Model
    unknowns: dict[str, Unknown]
    rows: tuple[Observation, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the unknowns."""
        return tuple(self.unknowns)

    @property
    def has_prior(self) -> Any:
        """For each unknown, whether it has a prior."""
        return np.array([unknown.prior is not None for unknown in self.unknowns.values()])

    @property
    def is_prior(self) -> Any:
        """For each row, whether it is a prior."""
        return np.array([row.is_prior for row in self.rows])

    def numbers_of(self, part: str) -> Any:
        """The "start", "scale", "low" or "high" of every unknown."""
        return np.array([getattr(unknown, part) for unknown in self.unknowns.values()])

    @property
    def box(self) -> tuple[Any, Any]:
        """The corners of the box in which searches start."""
        low, high = np.array([unknown.box for unknown in self.unknowns.values()]).T
        return low, high

    def computed(self, points: Any) -> Any:
        """The model's value for each row at these points (k, n), in SI; a refused point is NaN in all observations."""
        answered = self.model({name: np.array(points[:, j]) for j, name in enumerate(self.names)}, len(points))
        found = np.stack(observed_columns([row.name for row in self.rows if not row.is_prior], answered), axis=1)
        found = np.where(np.all(np.isfinite(found), axis=1, keepdims=True), found, np.nan)
        return np.concatenate([found, points[:, self.has_prior]], axis=1)

    def problem(self) -> Problem:
        """The least-squares problem, in units of standard deviations."""
        sigma = np.array([row.sigma for row in self.rows])
        angles = [not row.is_prior and row.is_angle(self.model.units[row.name]) for row in self.rows]
        return Problem(
            evaluate=lambda points: self.computed(points) / sigma,
            target=np.array([row.apart(0.0, False) for row in self.rows]) / sigma,
            period=np.where(angles, math.tau / sigma, np.nan),
            low=self.numbers_of("low"),
            high=self.numbers_of("high"),
            scale=self.numbers_of("scale"),
        )


def read_fit_inputs(model: Any, unknowns: Any, observed: Any) -> FitInputs:
    """The arguments of a fit through the reader: one error names all that cannot be used."""
    reader = ArgumentReader()
    known = read_each(reader, unknowns, "unknowns", "20.0", _unknown)
    measured = read_each(reader, observed, "observed", "Normal('30 km/h', '2 km/h')", read_value)
    reader.close()
    rows = [Observation(name, value) for name, value in measured]
    rows += [Observation(name, unknown.prior, is_prior=True) for name, unknown in known if unknown.prior]
    inputs = FitInputs(Model(model, {}), dict(known), tuple(rows))
    check_names(model, inputs.names, "unknowns", "bad_model")
    # Two cases, because a model that takes numbers would answer an array of one.
    inputs.computed(np.tile(inputs.numbers_of("start"), (2, 1)))
    return inputs


def _unknown(label: str, given: Any) -> Unknown:
    if isinstance(given, Normal):
        low, high = given.support
        return Unknown(given.unit, min(max(given.given_mean, low), high), given.given_sd, low, high, given)
    if isinstance(given, (Uniform, Interval)):
        low, high = given.support if isinstance(given, Uniform) else (given.low, given.high)
        return Unknown(given.unit, 0.5 * (low + high), high - low, low, high, None)
    if isinstance(given, Distribution) or not (isinstance(given, (int, float, str, np.number)) or is_quantity(given)):
        raise InputError(
            f"{label} is of type {type(given).__name__}; give a Normal (what is known before, with its weight), a Uniform or "
            f"an Interval (bounds that weigh nothing), or a number to start from. Least squares weighs what is normally "
            f"distributed: write Normal.between(low, high, 0.95, truncate=(low, high)) if that says it as "
            f"well{range_hint(given)}",
            code="bad_prior",
        )
    (start,), unit = read_alike({label: given})
    return Unknown(unit, start, abs(start) or 1.0, -math.inf, math.inf, None)
