"""``Finding``, and ``@finding``, which declares one: a function with its limit, unit, source of the
limit and sentence.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from operator import gt, le, lt
from typing import Any, NamedTuple, get_type_hints

from ..quantities.attributes import OWN_UNIT, Quantities
from ..quantities.strict_json import strict
from ..quantities.tables import Cells, Part, Summarized, Summary
from .moves import Moves, table

_NO_PROOF = "A finding is a reason to look again, not an error; no finding is no proof."
# The source of a limit of what is a note: its count has no size to judge, and pages and tables show
# neither.
NOTE = "set here: a note"
# Sources of several limits.
_HVE = "https://github.com/edccorp/hveManuals, docs/manuals/programs/EDCRASH"
MESSAGES = f"EDCRASH manual, chapter 6 ({_HVE}/06-messages.md)"
METHOD = f"EDCRASH manual, chapter 4 ({_HVE}/04-calculation-method.md)"


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """The limit beyond which a finding appears.

    Parameters
    ----------
    default : float or None
        In ``unit``; None where it depends on the case.
    unit : str
        SI unit.
    measured : str
        What is measured, and on which side of the limit a finding appears.
    source : str
        Where the default comes from; "set here", with the reason, where nothing was found to cite.
    """

    default: float | None
    unit: str
    measured: str
    source: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Something about an impact that should be looked at.

    Parameters
    ----------
    code : str
        Label that does not change between versions; a key of ``LIMITS``, or of a run what the
        scene leaves open.
    sentence : str
        What was found, with its numbers.
    measured : float
        What was measured, in ``unit``; infinite where there is no answer to measure.
    limit : float
        The limit that it passes, in ``unit``.
    unit : str
        SI unit, "" for a plain number. ``.q`` gives both numbers as Quantities.
    vehicle : str
        "a" or "b" where the finding is about one vehicle, else "".
    impact : int, optional
        Of a run, the place of the impact in ``run.impacts``; None where it is of the scene.
    time : float, optional [s]
        Of a run, when it is.
    source : str
        Where the limit comes from.
    """

    code: str
    sentence: str
    measured: float = field(metadata={"unit": OWN_UNIT})
    limit: float = field(metadata={"unit": OWN_UNIT})
    unit: str
    vehicle: str = ""
    impact: int | None = None
    time: float | None = field(default=None, metadata={"unit": "s"})
    source: str

    @property
    def q(self) -> Any:
        """The same attributes, with ``measured`` and ``limit`` as pint Quantities."""
        return Quantities(self)


def is_note(finding: Finding) -> bool:
    """Whether a finding is only a note, without a size that passes a limit."""
    return finding.source == NOTE


def letter_of(finding: Finding) -> str:
    """The letter of the vehicle that a finding is about, in brackets; none in a run, whose
    sentences have the names.
    """
    return f" ({finding.vehicle.upper()})" if finding.vehicle and finding.impact is None else ""


class Findings(tuple[Finding, ...], Summarized):
    """A tuple of findings; ``measured`` has the codes of all checks that were made, whether they
    found anything or not, ``moves`` what would move the answer.
    """

    measured: frozenset[str]
    moves: Moves
    _system: str

    def __new__(
        cls,
        found: Iterable[Finding] = (),
        measured: Iterable[str] = (),
        units: str = "metric",
        moves: Moves | None = None,
    ) -> Findings:
        made = super().__new__(cls, found)
        made.measured, made._system = frozenset(measured), units
        made.moves = Moves((), units) if moves is None else moves
        return made

    def to_dict(self) -> dict[str, Any]:
        """Findings, checks made and moves as strict JSON, numbers in SI.

        Returns
        -------
        dict
        """
        return {
            "findings": [
                {name: strict(getattr(one, name)) for name in one.__dataclass_fields__}
                for one in self
            ],
            "measured": sorted(self.measured),
            "moves": [move.to_dict() for move in self.moves],
        }

    def summary(self, units: str | None = None) -> Summary:
        """The findings as a table; measured values and limits in ``units``, by default those of the
        sentences.
        """
        return super().summary(self._system if units is None else units)

    def _summary(self, numbers: Cells) -> Summary:
        rows = []
        for finding in self:
            of = letter_of(finding)
            sizes = (None, None) if is_note(finding) else (finding.measured, finding.limit)
            measured, limit = (numbers.text(size, finding.unit) for size in sizes)
            rows.append((f"{finding.code}{of}", finding.sentence, measured, limit))
        checks = f"{len(self.measured)} checks were made."
        title = f"{len(self) or 'No'} finding{'s' * (len(self) != 1)}"
        parts = [Part(rows, "", ("what was found", "measured", "limit"))]
        if self.moves:
            parts.append(table(self.moves, numbers))
        return Summary(title, parts, (checks, _NO_PROOF))

    def __repr__(self) -> str:
        return str(self.summary())


class Measured(NamedTuple):
    """The value that a check measured, and the sentence for it if the limit is passed.

    ``limit`` is the default of a limit that depends on the case; the value has to be above its
    limit by ``rounding``.
    """

    value: float
    sentence: str
    vehicle: str = ""
    limit: float = math.nan
    rounding: float = 0.0


class Bound(NamedTuple):
    """From which side a limit is passed, and its default, which may depend on the case."""

    passed: str
    limit: float | str
    unit: str = ""


_PASSES: dict[str, Callable[[float, float], bool]] = {"above": gt, "below": lt, "at or below": le}
above, below, at_or_below = (partial(Bound, passed) for passed in _PASSES)


@dataclass(frozen=True, slots=True)
class Check:
    """A declared finding: ``measure`` examines cases of one kind."""

    code: str
    limit: Limit
    passed: str
    kind: Any
    measure: Callable[[Any], Iterator[Measured]]

    @property
    def off(self) -> float:
        """The limit that switches the check off, as nothing passes it."""
        return math.inf if self.passed == "above" else 0.0

    def findings(self, values: Iterable[Measured], allowed: float | None) -> list[Finding]:
        """The findings of this check, vehicle A before B."""
        found = []
        for value, sentence, vehicle, limit, rounding in values:
            limit = limit if allowed is None else allowed
            if _PASSES[self.passed](value, limit + rounding):
                found.append(
                    Finding(
                        code=self.code,
                        sentence=sentence,
                        measured=float(value),
                        limit=float(limit),
                        unit=self.limit.unit,
                        vehicle=vehicle,
                        source=self.limit.source,
                    )
                )
        return sorted(found, key=lambda finding: finding.vehicle)


def finding(
    measured: str, bound: Bound, source: str
) -> Callable[[Callable[[Any], Iterator[Measured]]], Check]:
    """Declare a finding by the function that measures it: its name is the code, its annotation the
    kind of case it looks at.

    Where the limit depends on the case, every ``Measured`` has the number.
    """
    default, words = (
        (None, f" {bound.limit}") if isinstance(bound.limit, str) else (bound.limit, "")
    )
    limit = Limit(
        default=default,
        unit=bound.unit,
        measured=f"{measured}: {bound.passed}{words}",
        source=source,
    )

    def declare(measure: Callable[[Any], Iterator[Measured]]) -> Check:
        kind, _ = get_type_hints(measure).values()
        return Check(measure.__name__, limit, bound.passed, kind, measure)

    return declare
