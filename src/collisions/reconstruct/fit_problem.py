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
from .least_squares import Problem, spread
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


class FitInputs(NamedTuple):
    """The inputs of a fit; ``rows`` are the observations in their order, then the priors."""

    model: Model
    unknowns: dict[str, Unknown]
    rows: tuple[Observation, ...]

    def numbers_of(self, part: str) -> Any:
        """The "start", "scale", "low" or "high" of every unknown, or whether it has a "prior"."""
        found = [getattr(unknown, part) for unknown in self.unknowns.values()]
        return np.array([one is not None for one in found] if part == "prior" else found)

    def starts(self, count: int) -> Any:
        """Where to start: all over the bounds, or around the start as far as its scale, or three deviations of the prior."""
        start, low, high = (self.numbers_of(part) for part in ("start", "low", "high"))
        span = np.where(self.numbers_of("prior"), _PRIOR_SPAN, 1.0) * self.numbers_of("scale")
        points = spread(count, np.maximum(low, start - span), np.minimum(high, start + span))
        points[0] = start
        return points

    def computed(self, points: Any) -> Any:
        """The model's value for each row at these points (k, n), in SI; a refused point is NaN in all observations."""
        answered = self.model({name: np.array(points[:, j]) for j, name in enumerate(self.unknowns)}, len(points))
        found = np.stack(observed_columns([row.name for row in self.rows if not row.is_prior], answered), axis=1)
        found = np.where(np.all(np.isfinite(found), axis=1, keepdims=True), found, np.nan)
        return np.concatenate([found, points[:, self.numbers_of("prior")]], axis=1)

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
    known = dict(read_each(reader, unknowns, "unknowns", "20.0", _unknown))
    measured = read_each(reader, observed, "observed", "Normal('30 km/h', '2 km/h')", read_value)
    reader.close()
    rows = [Observation(name, value) for name, value in measured]
    rows += [Observation(name, unknown.prior, is_prior=True) for name, unknown in known.items() if unknown.prior]
    inputs = FitInputs(Model(model, {}), known, tuple(rows))
    check_names(model, known, "unknowns", "bad_model")
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
            f"an Interval (bounds that weigh nothing), or a number to start from; reconstruct.posterior takes every "
            f"distribution{range_hint(given)}",
            code="bad_prior",
        )
    (start,), unit = read_alike({label: given})
    return Unknown(unit, start, abs(start) or 1.0, -math.inf, math.inf, None)
