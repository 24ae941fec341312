"""What was observed, read and weighed: values with errors, intervals and one-sided readings of a
model's outputs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

from ..messages.errors import (
    CollisionsError,
    InputError,
    NoSolutionError,
    SuspectUnitsWarning,
    UnitsError,
    placed,
)
from ..messages.marked import as_code, type_of
from ..messages.warning import Note
from ..quantities.reading import ArgumentReader
from ..uncertainty.distribution import (
    GivenUnit,
    Statement,
    from_numbers,
    missing_unit,
    read_alike,
    show,
)
from ..uncertainty.distributions import Censored, Interval, Normal
from ..uncertainty.model import Model, check_names, check_units, function_of
from .readings import KINDS, Reading

T = TypeVar("T")


class Observation(NamedTuple):
    """One observed output of the model by name, or the prior stated for an unknown."""

    name: str
    reading: Reading
    is_prior: bool = False

    @classmethod
    def of(cls, name: str, value: Any, is_prior: bool = False) -> Observation:
        """An observation of what was stated, weighed as its kind is."""
        return cls(name, KINDS[type(value)](name, value), is_prior)

    def is_angle(self, returned: str | None) -> bool:
        """Whether it is an angle, judged by its unit or that of what the model returns; other units
        must agree.
        """
        observed = self.reading.value.unit
        if returned is not None and returned != observed:
            if observed or isinstance(observed, GivenUnit):
                stated = getattr(observed, "written", observed)
                gives = f"in {returned}" if returned else "as a plain number"
                raise UnitsError(
                    f"observed {self.name} is in {observed or stated}, but the model returns it "
                    f"{gives}; one of them is another quantity",
                    code="bad_units",
                    argument="observed",
                )
            if problem := missing_unit(f"observed[{self.name!r}]", observed, returned):
                raise problem
        return "rad" in (observed, returned)


def bare_angle_notes(
    rows: Sequence[Observation], units: Mapping[str, str | None]
) -> Iterator[Note]:
    """Readings of angles that were given as numbers without a unit and are more than a turn."""
    for row in rows:
        value = row.reading.value
        if row.is_prior or units[row.name] != "rad" or value.unit:
            continue
        ends = getattr(value, "low", None), getattr(value, "high", None)
        known = (value.given_mean,) if isinstance(value, Normal) else ends
        # A bound that is no number that can be squared stands for none.
        sizes = [abs(one) for one in known if one is not None]
        worst = max((one for one in sizes if one * one < math.inf), default=0.0)
        if worst > math.tau:
            yield Note(
                SuspectUnitsWarning,
                f"observed {row.name} is {worst:.6g} without a unit, and is read as radians, more "
                f"than a turn; if degrees were meant, write '{worst:.6g} deg'",
                code="suspect_units",
                fields={"argument": "observed", "value": worst},
            )


def observed_columns(names: Sequence[str], answered: Mapping[str, Any]) -> list[Any]:
    """The outputs that were observed; refused if the model does not return one."""
    absent = [name for name in names if name not in answered]
    if absent:
        raise InputError(
            f"observed names {', '.join(absent)}, which the model does not return; it returns "
            f"{', '.join(answered)}",
            code="unknown_output",
            argument="observed",
        )
    return [answered[name] for name in names]


def read_evidence(
    model: Any,
    unknowns: Any,
    observed: Any,
    example: str,
    read_unknown: Callable[[str, Any], T],
    read_observed: Callable[[str, Any], Statement],
) -> tuple[Model, dict[str, T], list[Observation]]:
    """The model, what is known before of each unknown, and the observations; one error names all
    that cannot be used.
    """
    reader = ArgumentReader()
    known = _read_each(reader, unknowns, "unknowns", example, read_unknown)
    readings = _read_each(
        reader, observed, "observed", "`Normal('30 km/h', '2 km/h')`", read_observed
    )
    reader.close()
    model = function_of(model, known, readings, "observed")
    check_units(model, {name: unit_stated(one) for name, one in known.items()}, "unknowns")
    called = Model(model, {})
    check_names(model, known, "unknowns", "bad_model")
    return called, known, [Observation.of(name, value) for name, value in readings.items()]


def unit_stated(unknown: Any) -> str:
    """The unit in which an unknown was stated: that of a prior, or the first of what ``fit`` reads
    of one.
    """
    unit: str = unknown[0] if isinstance(unknown, tuple) else unknown.unit
    return unit


def _read_each(
    reader: ArgumentReader, given: Any, argument: str, example: str, read: Callable[[str, Any], T]
) -> dict[str, T]:
    """Read each entry of a dict, by name; an error names its entry."""
    if (
        not isinstance(given, Mapping)
        or not given
        or not all(isinstance(key, str) for key in given)
    ):
        got = "an empty one" if isinstance(given, Mapping) and not given else type_of(given)
        raise InputError(
            f"{argument} must be `|a dict|a table` by names, such as `{{'speed_a': "
            f"{example}}}`, got {got}",
            code="bad_type",
            argument=argument,
        )
    found: dict[str, T] = {}
    for name, value in given.items():
        label = f"{argument}[{name!r}]"
        try:
            found[name] = read(label, value)
        except InputError as problem:
            place = "" if str(problem).startswith(label) else label
            reader.refuse(placed(problem, place, argument=label))
    return found


def read_reading(label: str, given: Any) -> Statement:
    """An observation of a posterior: a value with its error, an interval, or a censored reading."""
    if isinstance(given, Interval):
        return from_numbers(
            Censored, given.unit, {"low": given.low, "high": given.high, "error": None}
        )
    if isinstance(given, Statement) and not isinstance(given, Normal) and type(given) in KINDS:
        return given
    return read_value(label, given)


def read_value(label: str, given: Any) -> Normal:
    """An observed value with its error."""
    if isinstance(given, (tuple, list)) and len(given) == 2:
        (_, sigma), unit = read_alike(
            dict(zip((f"{label} value", f"{label} error"), given, strict=True))
        )
        if not sigma > 0.0:
            raise InputError(
                f"{as_code(label)} error must be > 0, got {show(sigma, unit)}; give the "
                "pair `(value, error)`, the error as a standard deviation. What is known "
                "exactly is written into the model",
                code="not_positive",
            )
        given = Normal(*given)
    if not isinstance(given, Normal):
        kind = (
            "a number without its error"
            if isinstance(given, (int, float, str))
            else f"of type {type_of(given)}"
        )
        raise InputError(
            f"{as_code(label)} is {kind}; give `Normal(value, error)` or the pair "
            "`(value, error)`, the error as a standard deviation. Of a range write "
            "`Normal.between(low, high, coverage)`; an Interval, or a Censored "
            "reading of one bound, is weighed by `reconstruct.posterior`",
            code="bad_observation",
        )
    if given.truncate is not None:
        raise InputError(
            f"{as_code(label)} is truncated at {given.truncate}, which the error of a "
            "measurement is not; leave `truncate=` out, bounds belong to unknowns",
            code="bad_observation",
        )
    return given


def refused_everywhere(
    model: Model, points: int, at: Mapping[str, float], units: Mapping[str, str], advice: str
) -> NoSolutionError:
    """The error if the model has no answer anywhere, with its own reason if a single case gives
    one.
    """
    reason = "; call the model there with `on_failure='raise'` to see why"
    try:
        model.function(**at)
    except CollisionsError as error:
        reason = f": {error.inner}"
    except Exception:
        # A model of arrays need not take floats; an error about that says nothing about the scene.
        pass
    return NoSolutionError(
        f"the model refuses all {points} points tried for the unknowns, among them "
        f"{listed(at, units)}{reason}. Give {advice}",
        code="refused",
        points=points,
        at=dict(at),
    )


def listed(values: Mapping[str, float], units: Mapping[str, str]) -> str:
    """Values by name, for a sentence, each in the unit that it was given in."""

    def text(name: str, value: float) -> str:
        unit = units.get(name)
        return f"= {show(value, unit) if unit else f'{value:.6g}'}"

    return ", ".join(
        f"{name} {'undetermined' if math.isnan(value) else text(name, value)}"
        for name, value in values.items()
    )
