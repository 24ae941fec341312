"""What a fit is asked: unknowns with what is known of them, observations with their errors, and the model as numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..errors import CollisionsError, InputError, NoSolutionError, UnitsError
from ..reading import ArgumentReader
from ..uncertainty.distribution import read_alike, show
from ..uncertainty.distributions import Distribution, Interval, Normal, Uniform, range_hint
from ..uncertainty.model import Model, check_names
from ..units import is_quantity
from .least_squares import Problem

_TURN = 2.0 * math.pi
_REACH = 3.0  # standard deviations of a prior within which searches start


class Unknown(NamedTuple):
    """What is known of one unknown before: a place to start, how far it may be from there, bounds, and a prior if any."""

    name: str
    unit: str
    start: float
    scale: float
    low: float
    high: float
    prior: Normal | None

    @property
    def box(self) -> tuple[float, float]:
        """Where searches start: the bounds, or as far as the scale reaches."""
        reach = (_REACH if self.prior else 1.0) * self.scale
        return max(self.low, self.start - reach), min(self.high, self.start + reach)


class Question(NamedTuple):
    """A fit in numbers; rows are the observations in their order, then the priors."""

    model: Model
    unknowns: tuple[Unknown, ...]
    observed: dict[str, Normal]
    problem: Problem

    @property
    def names(self) -> tuple[str, ...]:
        """Of the unknowns."""
        return tuple(unknown.name for unknown in self.unknowns)

    @property
    def stated(self) -> list[tuple[str, Normal, bool]]:
        """Name, value and whether it is a prior, of every row."""
        priors = [(unknown.name, unknown.prior, True) for unknown in self.unknowns if unknown.prior]
        return [*((name, value, False) for name, value in self.observed.items()), *priors]

    @property
    def with_prior(self) -> list[int]:
        """Which unknowns have a prior."""
        return [j for j, unknown in enumerate(self.unknowns) if unknown.prior]

    def computed(self, points: Any) -> Any:
        """What the model makes of each observation at these points (k, n), in SI; a refused point is NaN throughout."""
        values = {name: np.array(points[:, j]) for j, name in enumerate(self.names)}
        answered = self.model(values, len(points))
        absent = [name for name in self.observed if name not in answered]
        if absent:
            raise InputError(
                f"observed names {_listed(absent)}, which the model does not return; it returns {_listed(answered)}",
                code="unknown_output",
                argument="observed",
            )
        found = np.stack([answered[name] for name in self.observed], axis=1)
        return np.where(np.all(np.isfinite(found), axis=1, keepdims=True), found, np.nan)

    def angles(self) -> list[bool]:
        """Of the observations, whether each is known to be an angle."""
        for name, value in self.observed.items():
            unit = self.model.units.get(name)
            if unit and value.unit and unit != value.unit:
                raise UnitsError(
                    f"observed {name} is in {value.unit}, but the model returns it in {unit}; one of them is another quantity",
                    code="bad_units",
                    argument="observed",
                )
        return ["rad" in (value.unit, self.model.units.get(name)) for name, value in self.observed.items()]


def read_question(model: Any, unknowns: Any, observed: Any) -> Question:
    """The question through the reader: one error names every wrong argument."""
    reader = ArgumentReader()
    seen = {name: _unknown(reader, name, given) for name, given in _entries(unknowns, "unknowns", "20.0").items()}
    told = {
        name: _observation(reader, name, given)
        for name, given in _entries(observed, "observed", "Normal('30 km/h', '2 km/h')").items()
    }
    reader.close()
    sought = tuple(unknown for unknown in seen.values() if unknown)
    measured = {name: value for name, value in told.items() if value}
    low, high, scale = (np.array([getattr(unknown, part) for unknown in sought]) for part in ("low", "high", "scale"))

    def evaluate(points: Any) -> Any:
        return np.concatenate([question.computed(points), points[:, question.with_prior]], axis=1) / sigma

    question = Question(Model(model, {}), sought, measured, Problem(evaluate, low, low, low, high, scale))
    rows = [value for _, value, _ in question.stated]
    sigma = np.array([row.given_sd for row in rows])
    check_names(model, question.names, "unknowns", "bad_model")
    # Two cases tell a model that takes arrays from one that takes numbers; one would not.
    question.computed(np.array([[unknown.start for unknown in sought]] * 2))
    angles = [*question.angles(), *[False] * len(question.with_prior)]
    return question._replace(
        problem=question.problem._replace(
            target=np.array([row.given_mean for row in rows]) / sigma, period=np.where(angles, _TURN / sigma, np.nan)
        )
    )


def refused_everywhere(question: Question, tried: int) -> NoSolutionError:
    """The model answers nowhere that was looked at, and why not if it says so for a single case."""
    at = {unknown.name: unknown.start for unknown in question.unknowns}
    where = ", ".join(f"{name} = {value:.6g}" for name, value in at.items())
    reason = "; call the model there with on_failure='raise' to be told why"
    try:
        question.model.function(**at)
    except CollisionsError as error:
        reason = f": {error}"
    except Exception:
        # A model of arrays need not take floats, and why it does not is no reason of the scene.
        pass
    return NoSolutionError(
        f"the model refuses all {tried} points tried for the unknowns, among them {where}{reason}. Give bounds or starts of "
        f"the unknowns within which the impact happens",
        code="refused",
        points=tried,
        at=at,
    )


def _entries(given: Any, argument: str, value: str) -> Mapping[str, Any]:
    if not isinstance(given, Mapping) or not given or not all(isinstance(key, str) for key in given):
        shown = "an empty one" if isinstance(given, Mapping) and not given else f"{type(given).__name__}"
        raise InputError(
            f"{argument} must be a dict by names, such as {{'speed_a': {value}}}, got {shown}",
            code="bad_type",
            argument=argument,
        )
    return given


def _unknown(reader: ArgumentReader, name: str, given: Any) -> Unknown | None:
    label = f"unknowns[{name!r}]"
    if isinstance(given, Normal):
        low, high = (
            math.inf * side if end is None else end for side, end in zip((-1, 1), given.truncate or (None, None), strict=True)
        )
        start = min(max(given.given_mean, low), high)
        return Unknown(name, given.unit, start, given.given_sd, low, high, given)
    if isinstance(given, (Uniform, Interval)):
        low, high = given.support if isinstance(given, Uniform) else (given.low, given.high)
        return Unknown(name, given.unit, 0.5 * (low + high), high - low, low, high, None)
    if isinstance(given, Distribution) or not (isinstance(given, (int, float, str, np.number)) or is_quantity(given)):
        reader.refuse(
            InputError(
                f"{label} is of type {type(given).__name__}; give a Normal (what is known before, with its weight), a Uniform "
                f"or an Interval (bounds that weigh nothing), or a number to start from. Least squares weighs what is "
                f"normally distributed: write Normal.between(low, high, 0.95, truncate=(low, high)) if that says it as "
                f"well{range_hint(given)}",
                code="bad_prior",
                argument=label,
            )
        )
        return None
    number = _told(reader, label, lambda: read_alike({label: given}))
    if number is None:
        return None
    (start,), unit = number
    return Unknown(name, unit, start, abs(start) or 1.0, -math.inf, math.inf, None)


def _observation(reader: ArgumentReader, name: str, given: Any) -> Normal | None:
    label = f"observed[{name!r}]"
    if isinstance(given, (tuple, list)) and len(given) == 2:
        ends = dict(zip((f"{label} value", f"{label} error"), given, strict=True))
        numbers = _told(reader, label, lambda: read_alike(ends))
        if numbers is None:
            return None
        (value, error), unit = numbers
        if not error > 0.0:
            reader.refuse(
                InputError(
                    f"{label} error must be > 0, got {show(error, unit)}; give the pair (value, error), the error as a "
                    f"standard deviation. What is known exactly is written into the model",
                    code="not_positive",
                    argument=label,
                )
            )
            return None
        given = Normal._of(unit, value, error, None)
    if not isinstance(given, Normal):
        kind = "a number without its error" if isinstance(given, (int, float, str)) else f"of type {type(given).__name__}"
        reader.refuse(
            InputError(
                f"{label} is {kind}; give Normal(value, error) or the pair (value, error), the error as a standard deviation. "
                f"Of a range write Normal.between(low, high, coverage)",
                code="bad_observation",
                argument=label,
            )
        )
        return None
    if given.truncate is not None:
        reader.refuse(
            InputError(
                f"{label} is truncated at {given.truncate}, which the error of a measurement is not; leave truncate= out, "
                f"bounds belong to unknowns",
                code="bad_observation",
                argument=label,
            )
        )
        return None
    return given


def _told(reader: ArgumentReader, label: str, read: Callable[[], Any]) -> Any:
    """What reading gives, or None after its refusal with the place where it stands."""
    try:
        return read()
    except InputError as problem:
        text = str(problem) if str(problem).startswith(label) else f"{label}: {problem}"
        reader.refuse(type(problem)(text, code=problem.code, **{**problem.fields, "argument": label}))
        return None


def _listed(names: Any) -> str:
    return ", ".join(names) or "nothing"
