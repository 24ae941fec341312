"""What ``propagate`` is asked: its inputs sorted by kind, its options, and the tolerance of every output."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from ..errors import InputError
from ..reading import ArgumentReader, is_whole
from ..units import shown
from .designs import DESIGNS, REPLICATES
from .distributions import Distribution, Interval, read_input
from .sampling import MOST_SAMPLES

LOCAL = ("first_order", "second_order")
METHODS = (*LOCAL, *DESIGNS, "interval")
_LEAST = 4 * REPLICATES


class Inputs(NamedTuple):
    """All inputs as stated; those with a distribution, the bounds of the intervals, and the fixed ones in SI."""

    stated: dict[str, Any]
    drawn: dict[str, Distribution]
    intervals: dict[str, tuple[float, float]]
    fixed: dict[str, Any]


def read_inputs(inputs: Any) -> Inputs:
    """The inputs by kind."""
    if not isinstance(inputs, Mapping) or not all(isinstance(name, str) for name in inputs):
        raise InputError(
            f"inputs must be a dict of what is known by name, such as {{'speed': Normal(15.0, 0.5)}}, got "
            f"{type(inputs).__name__}",
            code="bad_inputs",
            argument="inputs",
        )
    read = {name: read_input(name, value) for name, value in inputs.items()}
    drawn = {name: value for name, value in read.items() if isinstance(value, Distribution)}
    intervals = {name: (value.low, value.high) for name, value in read.items() if isinstance(value, Interval)}
    fixed = {name: value for name, value in read.items() if name not in drawn and name not in intervals}
    return Inputs(read, drawn, intervals, fixed)


def check_options(method: Any, samples: Any, tolerance: Any, seed: Any, threads: Any, progress: Any) -> None:
    """Refuses what is no option, or none of this method."""

    def refuse(argument: str, allowed: str, given: Any) -> None:
        raise InputError(f"{argument} must be {allowed}, got {shown(given)}", code="bad_option", argument=argument)

    def whole(value: Any, least: int) -> bool:
        return is_whole(value) and bool(value >= least)

    if not isinstance(method, str) or method not in METHODS:
        refuse("method", f"one of {', '.join(METHODS)}", method)
    draws = method in DESIGNS
    if samples is not None and tolerance is not None:
        raise InputError("give samples= or tolerance=, not both", code="bad_option", argument="tolerance")
    for name, value in (("samples", samples), ("tolerance", tolerance)):
        if value is not None and not draws:
            raise InputError(f"{name} is for methods that draw; method={method!r} does not", code="bad_option", argument=name)
    if samples is not None and not (whole(samples, _LEAST) and samples <= MOST_SAMPLES):
        refuse("samples", f"a whole number from {_LEAST} to {MOST_SAMPLES}", samples)
    if seed is not None and not whole(seed, 0):
        refuse("seed", "a whole number from 0, or None", seed)
    if not whole(threads, 1):
        refuse("threads", "a whole number from 1", threads)
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        refuse("progress", "a function of (done, total), or True for a bar", progress)


def read_tolerances(tolerance: Any, units: Mapping[str, str | None]) -> dict[str, float]:
    """The tolerance of every output it was given for, in the unit of the output."""
    given = tolerance if isinstance(tolerance, Mapping) else dict.fromkeys(units, tolerance)
    if not given:
        raise InputError(
            f"tolerance names no output; the model returned {', '.join(units)}", code="bad_tolerance", argument="tolerance"
        )
    reader = ArgumentReader(trusted=tuple(f"tolerance[{name!r}]" for name in given))
    found: dict[str, float] = {}
    for name, value in given.items():
        if name not in units:
            raise InputError(
                f"tolerance names {name!r}, which is no output; the model returned {', '.join(units)}",
                code="bad_tolerance",
                argument="tolerance",
            )
        found[name] = reader.number(value, units[name] or "", f"tolerance[{name!r}]")
    reader.close()
    for name, value in found.items():
        if not isinstance(value, float) or not value > 0.0:
            raise InputError(
                f"tolerance must be a number > 0, got {shown(value)} for {name}", code="bad_tolerance", argument="tolerance"
            )
    return found
