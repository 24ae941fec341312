"""One answer under examination, with what was given about it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ..contact_effects import LeftOut
from ..impact import Impact
from ..kernels.status import EPS
from ..reconstruct import MomentumSolution
from ..side import Side
from ..vehicle import Vehicle
from .finding import Finding
from .limits import LIMITS
from .words import Words

# A ratio that comes out of an answer and rounds to its limit has not passed it.
RATIO_OFF_BY = 1e-9


class Told(NamedTuple):
    """What an answer says of a vehicle that damage may contradict."""

    who: str
    delta_v: float
    pdof: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Evidence:
    """What the damage says, apart from the answer: its energy, and by vehicle label direction of force and delta-V."""

    crush_energy: float | None
    pdof: dict[str, float]
    delta_v: dict[str, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Examined:
    """What every answer has to be held against: evidence and limits."""

    limits: dict[str, float | None]
    evidence: Evidence
    energy_lost: float
    told: dict[str, Told]
    duration: float
    drag: float
    words: Words
    measured: set[str] = field(default_factory=set)

    def above(
        self,
        code: str,
        measured: float,
        sentence: str,
        vehicle: str = "",
        limit: float = math.nan,
        rounding: float = 0.0,
    ) -> Iterator[Finding]:
        """The finding, if what was measured is above its limit by more than its rounding.

        ``limit`` is the default of a limit that depends on the case.
        """
        allowed = self._limit(code, limit, off=math.inf)
        if measured > allowed + rounding:
            yield self._finding(code, measured, allowed, sentence, vehicle)

    def below(self, code: str, measured: float, sentence: str, vehicle: str = "", *, or_at: bool = False) -> Iterator[Finding]:
        """The finding, if what was measured is below its limit, or at it where that counts."""
        allowed = self._limit(code, math.nan, off=0.0)
        if measured < allowed or (or_at and measured == allowed > 0.0):
            yield self._finding(code, measured, allowed, sentence, vehicle)

    def _limit(self, code: str, otherwise: float, off: float) -> float:
        """The limit that holds; what is held against one that it cannot pass counts as not measured."""
        given = self.limits[code]
        if given != off:
            self.measured.add(code)
        return otherwise if given is None else given

    @staticmethod
    def _finding(code: str, measured: float, limit: float, sentence: str, vehicle: str) -> Finding:
        return Finding(
            code=code,
            sentence=sentence,
            measured=float(measured),
            limit=float(limit),
            unit=LIMITS[code].unit,
            vehicle=vehicle,
            source=LIMITS[code].source,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Case(Examined):
    """An impact, the outlines by vehicle label, and what the impulse leaves out."""

    impact: Impact
    outlines: dict[str, Any]
    left_out: LeftOut

    @property
    def sides(self) -> tuple[tuple[str, Side], tuple[str, Side]]:
        """Both vehicles with their labels."""
        return ("a", self.impact.a), ("b", self.impact.b)


@dataclass(frozen=True, slots=True, kw_only=True)
class Balance(Examined):
    """A reconstruction by planar momentum."""

    solution: MomentumSolution


def off_by(*sizes: float) -> float:
    """What a few sums and differences of numbers of these sizes may be off by: 16 eps of all of them together."""
    return 16.0 * EPS * sum(map(abs, sizes))


def outline_off_by(outline: Any, vehicle: Vehicle, after: float = 0.0) -> float:
    """What the corners may be off by where they were placed; a heading is known to eps of itself."""
    x, y, heading = (getattr(vehicle, name) for name in ("x", "y", "heading"))
    turned = float(np.max(np.abs(outline))) * (1.0 + abs(heading) + abs(vehicle.yaw_rate * after))
    return off_by(x, y, vehicle.speed * after, turned)


def named(label: str, side: Side) -> str:
    """The vehicle as a sentence calls it."""
    name = side.before.name
    return f"vehicle {label.upper()} ({name})" if name else f"vehicle {label.upper()}"


def share(part: float, whole: float) -> float:
    """The quotient; infinite where there is nothing to compare with, or no number to compare."""
    if part == 0.0:
        return 0.0
    return part / whole if whole > 0.0 and math.isfinite(part) else math.inf
