"""A finding, and how the limits of a call are read."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import InputError, ShapeError
from ..kernels.elementwise import UNCHECKED
from ..quantities import OWN, Quantities
from ..reading import ArgumentReader
from ..units import shown
from .limits import LIMITS

# The reader's word for a number that no domain bounds: an infinite limit switches a finding off.


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Something about an impact that should be looked at.

    Parameters
    ----------
    code : str
        Label that does not change between versions; a key of ``LIMITS``.
    sentence : str
        What was found, with its numbers.
    measured : float
        What was measured, in ``unit``; infinite where there is no answer to measure.
    limit : float
        What it passes, in ``unit``.
    unit : str
        SI unit, "" for a plain number. ``.q`` has both as Quantities.
    vehicle : str
        "a" or "b" where it is about one of them, else "".
    source : str
        Where the limit is from.
    """

    code: str
    sentence: str
    measured: float = field(metadata={"unit": OWN})
    limit: float = field(metadata={"unit": OWN})
    unit: str
    vehicle: str = ""
    source: str

    @property
    def q(self) -> Any:
        """The same attributes, measured and limit as pint Quantities."""
        return Quantities(self)


class Findings(tuple[Finding, ...]):
    """Findings, a tuple like any other, with the codes of all that was measured, found or not."""

    measured: frozenset[str]

    def __new__(cls, found: Iterable[Finding] = (), measured: Iterable[str] = ()) -> Findings:
        made = super().__new__(cls, found)
        made.measured = frozenset(measured)
        return made


def read_limits(given: Any, reader: ArgumentReader) -> dict[str, float | None]:
    """The limits of a call: the defaults, and what the caller has instead; units allowed."""
    limits = {code: limit.default for code, limit in LIMITS.items()}
    if given is None:
        return limits
    if not isinstance(given, Mapping):
        reader.refuse(
            InputError(
                f"limits must be a dict from code to limit, such as {{'tyre_impulse': 0.2}}; got {type(given).__name__}",
                code="bad_limit",
                argument="limits",
            )
        )
        return limits
    for code, value in given.items():
        name = f"limits[{code!r}]"
        if code not in LIMITS:
            reader.refuse(
                InputError(
                    f"{name}: there is no finding {shown(code)}; known are {', '.join(LIMITS)}",
                    code="unknown_finding",
                    argument="limits",
                )
            )
            continue
        count = len(reader.problems)
        read = reader.number(value, LIMITS[code].unit, name, UNCHECKED)
        if len(reader.problems) > count:
            continue
        if isinstance(read, np.ndarray):
            reader.refuse(ShapeError(f"{name} takes one value", code="bad_shape", argument="limits"))
        elif not read >= 0.0:
            reader.refuse(
                InputError(
                    f"{name} must be >= 0 (inf switches it off), got {shown(value)}", code="bad_limit", argument="limits"
                )
            )
        else:
            limits[code] = read
    return limits
