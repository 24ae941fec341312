"""``FitInputs``: unknowns with their prior knowledge, observations with their errors, and the model as a numeric function."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, TypeVar

import numpy as np

from ..errors import InputError, UnitsError
from ..reading import ArgumentReader
from ..uncertainty.distribution import read_alike, show
from ..uncertainty.distributions import Distribution, Interval, Normal, Uniform, range_hint
from ..uncertainty.model import Model, check_names
from ..units import is_quantity
from .least_squares import Problem

T = TypeVar("T")

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


class Stated(NamedTuple):
    """An observation or a prior: a row of the least squares."""

    name: str
    value: Normal
    is_prior: bool


class FitInputs(NamedTuple):
    """The inputs of a fit; ``rows`` are the observations in their order, then the priors."""

    model: Model
    unknowns: dict[str, Unknown]
    rows: tuple[Stated, ...]

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
        observed = [row.name for row in self.rows if not row.is_prior]
        absent = [name for name in observed if name not in answered]
        if absent:
            raise InputError(
                f"observed names {', '.join(absent)}, which the model does not return; it returns {', '.join(answered)}",
                code="unknown_output",
                argument="observed",
            )
        found = np.stack([answered[name] for name in observed], axis=1)
        found = np.where(np.all(np.isfinite(found), axis=1, keepdims=True), found, np.nan)
        return np.concatenate([found, points[:, self.has_prior]], axis=1)

    def problem(self) -> Problem:
        """The least-squares problem, in units of standard deviations."""
        sigma = np.array([row.value.given_sd for row in self.rows])
        return Problem(
            evaluate=lambda points: self.computed(points) / sigma,
            target=np.array([row.value.given_mean for row in self.rows]) / sigma,
            period=np.where([self._is_angle(row) for row in self.rows], math.tau / sigma, np.nan),
            low=self.numbers_of("low"),
            high=self.numbers_of("high"),
            scale=self.numbers_of("scale"),
        )

    def _is_angle(self, row: Stated) -> bool:
        """Whether an observation is an angle, judged by its unit."""
        returned, observed = self.model.units.get(row.name), row.value.unit
        if row.is_prior:
            return False
        if returned and observed and returned != observed:
            raise UnitsError(
                f"observed {row.name} is in {observed}, but the model returns it in {returned}; one of them is another "
                f"quantity",
                code="bad_units",
                argument="observed",
            )
        return "rad" in (observed, returned)


def read_fit_inputs(model: Any, unknowns: Any, observed: Any) -> FitInputs:
    """The arguments of a fit through the reader: one error names all that cannot be used."""
    reader = ArgumentReader()
    known = _each(reader, unknowns, "unknowns", "20.0", _unknown)
    measured = _each(reader, observed, "observed", "Normal('30 km/h', '2 km/h')", _observation)
    reader.close()
    rows = [Stated(name, value, False) for name, value in measured]
    rows += [Stated(name, unknown.prior, True) for name, unknown in known if unknown.prior]
    inputs = FitInputs(Model(model, {}), dict(known), tuple(rows))
    check_names(model, inputs.names, "unknowns", "bad_model")
    # Two cases, because a model that takes numbers would answer an array of one.
    inputs.computed(np.tile(inputs.numbers_of("start"), (2, 1)))
    return inputs


def _each(
    reader: ArgumentReader, given: Any, argument: str, example: str, read: Callable[[str, Any], T]
) -> list[tuple[str, T]]:
    """Read each entry of a dict, by name; an error names its entry."""
    if not isinstance(given, Mapping) or not given or not all(isinstance(key, str) for key in given):
        got = "an empty one" if isinstance(given, Mapping) and not given else type(given).__name__
        raise InputError(
            f"{argument} must be a dict by names, such as {{'speed_a': {example}}}, got {got}",
            code="bad_type",
            argument=argument,
        )
    found = []
    for name, value in given.items():
        label = f"{argument}[{name!r}]"
        try:
            found.append((name, read(label, value)))
        except InputError as problem:
            text = str(problem) if str(problem).startswith(label) else f"{label}: {problem}"
            reader.refuse(type(problem)(text, code=problem.code, **{**problem.fields, "argument": label}))
    return found


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


def _observation(label: str, given: Any) -> Normal:
    if isinstance(given, (tuple, list)) and len(given) == 2:
        (_, sigma), unit = read_alike(dict(zip((f"{label} value", f"{label} error"), given, strict=True)))
        if not sigma > 0.0:
            raise InputError(
                f"{label} error must be > 0, got {show(sigma, unit)}; give the pair (value, error), the error as a standard "
                f"deviation. What is known exactly is written into the model",
                code="not_positive",
            )
        given = Normal(*given)
    if not isinstance(given, Normal):
        kind = "a number without its error" if isinstance(given, (int, float, str)) else f"of type {type(given).__name__}"
        raise InputError(
            f"{label} is {kind}; give Normal(value, error) or the pair (value, error), the error as a standard deviation. Of a "
            f"range write Normal.between(low, high, coverage)",
            code="bad_observation",
        )
    if given.truncate is not None:
        raise InputError(
            f"{label} is truncated at {given.truncate}, which the error of a measurement is not; leave truncate= out, bounds "
            f"belong to unknowns",
            code="bad_observation",
        )
    return given
