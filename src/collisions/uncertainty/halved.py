"""``Halved``: what to measure next, by how much narrower each range were with half the error of one
input.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ..messages.errors import InputError
from ..messages.warning import Note
from ..quantities.strict_json import strict
from ..quantities.tables import Cells, Part, Summarized, Summary, as_sentence, given_texts
from ..quantities.units import shown, to_quantity
from .distribution import Distribution, from_numbers
from .distributions import Interval, Samples

if TYPE_CHECKING:
    from .result import Propagation

# A warning of more of the cases of a row by this share is said of that row again.
_MORE = 0.05


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Halved(Summarized):
    """The width of every output's range now, and if the error of one input were halved;
    ``halved["drag"]["speed"]`` is one of them.

    Inputs come in the order of what they gain: first the one whose half error makes some range
    narrower by the largest share.

    Attributes
    ----------
    now : dict
        By output, the width of its range as the inputs are stated [unit of the output].
    widths : dict
        By input, then by output: the width with half the error of that input [unit of the output].
    units : dict
        By output, its SI unit; None where the model returned plain numbers.
    coverage : float or None
        Probability that a range holds [-]; None for the whole range, by ``method="interval"``.
    samples : int
        Cases drawn for each range; by a method that does not draw, cases it took.
    without_answer_now : float
        The share without an answer to at least one output, of the cases drawn from the inputs and
        searched between bounds, as the inputs are stated [-]; the widths say nothing of these.
    without_answer : dict
        By input, that share with half the error of that input [-]. Widths of rather different
        shares are of different cases.
    statements : tuple of str
        What else was warned of the widths now, and of those of a row where it is not of all: such
        as that a local method differs from the model with half the error of that input.
    """

    now: dict[str, float]
    widths: dict[str, dict[str, float]]
    units: dict[str, str | None]
    coverage: float | None
    samples: int
    without_answer_now: float
    without_answer: dict[str, float]
    statements: tuple[str, ...] = ()
    given: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> dict[str, float]:
        if not isinstance(name, str) or name not in self.widths:
            raise InputError(
                f"{shown(name)} is none of the uncertain inputs, which are "
                f"{', '.join(self.widths)}",
                code="unknown_name",
                argument="name",
            )
        return self.widths[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.widths)

    def __len__(self) -> int:
        return len(self.widths)

    @property
    def q(self) -> dict[str, dict[str, Any]]:
        """Widths by input and output as Quantities; plain numbers where the model returned them."""
        return {
            name: {output: self._with_unit(output, width) for output, width in row.items()}
            for name, row in self.widths.items()
        }

    def to_dict(self) -> dict[str, Any]:
        """All widths as strict JSON.

        Returns
        -------
        dict
            Plain values that ``json.dumps`` writes; infinity and NaN as texts.
        """
        names = (
            "coverage",
            "samples",
            "units",
            "now",
            "widths",
            "without_answer_now",
            "without_answer",
        )
        found: dict[str, Any] = strict({name: getattr(self, name) for name in names})
        return found | {"statements": list(self.statements)}

    def _with_unit(self, output: str, width: float) -> Any:
        unit = self.units[output]
        return width if unit is None else to_quantity(width, unit)

    def _summary(self, numbers: Cells) -> Summary:
        def written(output: str, width: float) -> str:
            unit = self.units[output]
            return f"{width:.4g}" if unit is None else numbers.text(width, unit)

        rows = [("now", *(written(output, width) for output, width in self.now.items()))]
        for name, row in self.widths.items():
            cells = [
                f"{written(output, width)} ({_change(width, self.now[output])})"
                for output, width in row.items()
            ]
            rows.append((name, *cells))
        what = "whole range" if self.coverage is None else f"{self.coverage:.0%} range"
        least = min((_least_share(row, self.now) for row in self.widths.values()), default=1.0)
        note = (
            "Each row has the error of that input halved, as if better measurements had the same "
            f"mean. {'The first row gains the most' if least < 1.0 else 'None makes one narrower'}."
        )
        notes = [note]
        without = [("now", self.without_answer_now), *self.without_answer.items()]
        if any(share for _, share in without):
            shares = ", ".join(f"{name} {100.0 * share:.3g}%" for name, share in without)
            notes.append(f"Cases without an answer, which the widths leave out: {shares}.")
        notes += map(as_sentence, self.statements)
        return Summary(
            f"Width of the {what} if the error of one input were halved",
            [Part(rows, columns=tuple(self.now))],
            notes,
        )

    def _texts(self) -> tuple[str, ...]:
        return self.given


def widths_if_halved(
    run: Callable[[Mapping[str, Any]], Propagation], now: Propagation, samples: int
) -> Halved:
    """What ``Propagation.if_halved`` answers; ``run`` propagates other statements of the inputs in
    the same way, with so many cases.
    """
    widths, without, said = {}, {}, {}
    known = {_without_counts(note): note.fields.get("share") for note in now.notes if note.warning}
    for name, one in now.inputs.items():
        if isinstance(one, (Distribution, Interval)):
            found = run({**now.inputs, name: with_half_the_error(one)})
            widths[name], without[name] = _widths(found), found._unanswered
            said[name] = tuple(_warned_of(found, known))
    at_present = _widths(now)
    order = sorted(widths, key=lambda name: _least_share(widths[name], at_present))
    return Halved(
        now=at_present,
        widths={name: widths[name] for name in order},
        units={name: output.unit for name, output in now.outputs.items()},
        coverage=None if now.method == "interval" else 0.95,
        samples=samples,
        without_answer_now=now._unanswered,
        without_answer={name: without[name] for name in order},
        statements=(
            *(f"as stated, {sentence}" for sentence in _warned_of(now)),
            *(
                f"with half the error of {name}, {sentence}"
                for name in order
                for sentence in said[name]
            ),
        ),
        given=tuple(given_texts(now)),
    )


def _warned_of(
    found: Propagation, known: Mapping[tuple[str, str], Any] = MappingProxyType({})
) -> Iterator[str]:
    """What was warned of these widths, but for what is ``known`` of as large a share of the cases,
    and cases without an answer, which are counted in each row.
    """
    for note in found.notes:
        if note.code == "not_local":
            if note.fields["differences"]:
                # Its size is another in each row.
                yield note.statement.partition(". ")[0]
        elif note.warning and note.code != "failed_cases":
            said = _without_counts(note)
            share, before = note.fields.get("share"), known.get(said)
            more = share is not None and before is not None and share > before + _MORE
            if said not in known or more:
                yield note.statement


def _without_counts(note: Note) -> tuple[str, str]:
    """The code of a warning and what it says, without of how many cases."""
    return note.code, re.sub(r"^\d+ of \d+ cases \([^)]*\)", "", note.statement)


def with_half_the_error(stated: Distribution | Interval) -> Distribution | Interval:
    """The same statement with every value moved halfway to the mean, or to the middle of an
    interval.
    """
    if isinstance(stated, Interval):
        middle, quarter = 0.5 * stated.low + 0.5 * stated.high, 0.25 * (stated.high - stated.low)
        ends = {"low": middle - quarter, "high": middle + quarter}
        return from_numbers(Interval, stated.unit, ends)
    if isinstance(stated, Samples):
        # Rows in their order, so that joint samples are drawn together as before.
        rows = stated.mean + 0.5 * (stated.rows - stated.mean)
        return from_numbers(Samples, stated.unit, {"rows": rows, "group": stated.group})
    return from_numbers(_Halfway, stated.unit, {"whole": stated})


class _Halfway(Distribution):
    """A distribution with every value moved halfway to its mean."""

    __slots__ = ("_whole",)

    _words = "{whole}, with half the error"
    _whole: Distribution

    def _derive(self, whole: Distribution) -> None:
        self._set(_whole=whole)
        low, high = (self._moved(end) for end in whole.support)
        self._describe(whole.mean, 0.5 * whole.sd, whole.skewness, whole.kurtosis, (low, high))

    def _moved(self, value: Any) -> Any:
        return self._whole.mean + 0.5 * (value - self._whole.mean)

    def _scored(self, z: Any) -> Any:
        return self._moved(self._whole._scored(z))

    def _at(self, below: Any, above: Any) -> Any:
        return self._moved(self._whole._at(below, above))


def _widths(found: Propagation) -> dict[str, float]:
    """The width of the range of each output."""
    ends = {name: output.interval() for name, output in found.outputs.items()}
    return {name: high - low for name, (low, high) in ends.items()}


def _least_share(widths: Mapping[str, float], now: Mapping[str, float]) -> float:
    """The smallest share of the present widths that is left of any."""
    shares = [_share(width, now[name]) for name, width in widths.items()]
    return min((share for share in shares if not math.isnan(share)), default=1.0)


def _share(width: float, now: float) -> float:
    """What is left of a width: of one that is infinite nothing, or all of it; NaN of none."""
    if now == math.inf:
        return math.nan if math.isnan(width) else float(width == math.inf)
    return width / now if now > 0.0 else math.nan


def _change(width: float, now: float) -> str:
    """The percentage by which a range is narrower or wider than now."""
    share = _share(width, now)
    if math.isnan(share):
        return "no change known"
    if now == math.inf and width < math.inf:
        return "no longer infinite"
    if share == math.inf:
        return "infinite"
    percent = round(100.0 * (share - 1.0))
    return f"{percent:+d} %" if percent else "same"
