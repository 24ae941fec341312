"""``posterior``: what the evidence says, as a part of a report: what was found, each reading beside
its computed value, and, folded, all that this rests on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from operator import attrgetter
from typing import Any

from ..estimate.fit_result import notes_of as notes_of_fit
from ..estimate.posterior_result import notes_of
from ..estimate.worked_out import in_words
from ..messages.warning import Note
from ..quantities.formatting import KIND_OF, number_with_unit, rounded, typeset
from ..quantities.printed_tables import Part
from ..quantities.tables import as_sentence, cells, label_of
from ..quantities.user_text import plain
from ..reconstruct import Fit, Posterior
from ..uncertainty import Propagation
from ..uncertainty.distribution import Statement, stated_in
from ..uncertainty.distributions import Normal
from ..uncertainty.output import outputs_part
from .render import Sheet

_OF_NUMBER = "0123456789.e+-"
_NOTES: Mapping[type, Callable[[Any], Iterable[Note]]] = {
    Posterior: notes_of,
    Fit: notes_of_fit,
    Propagation: attrgetter("notes"),
}


def answers_of(found: Posterior, answers: Sequence[str] | None) -> list[str]:
    """The names that the answer is about: those asked for; else what was worked out and the speeds
    among the unknowns; else all unknowns.
    """
    if answers is not None:
        return [name for name in answers if name in found._outputs]
    speeds = [name for name, one in found.unknowns.items() if one.unit == "m/s"]
    return [*found.results, *speeds] or list(found.unknowns)


def posterior(
    sheet: Sheet,
    found: Posterior,
    answers: Sequence[str] | None = None,
    notes: Mapping[str, str] | None = None,
    named: Callable[[str], str] = plain,
) -> None:
    """Write what was found, the evidence, and what both rest on; ``named`` gives the words for a
    name.
    """
    said = notes or {}
    sheet.listed([plain(as_sentence(_said(one, found, named))) for one in found.statements])
    asked = answers_of(found, answers)
    sheet.heading("Found")
    numbers = cells(sheet.system.name)
    sheet.columns(outputs_part({named(name): found[name] for name in asked}, numbers))
    if found.results_from:
        sheet.heading("How it was worked out")
        sheet.columns(
            Part(
                [(named(name), plain(in_words(text))) for name, text in found.results_from.items()],
                columns=("how",),
            )
        )
    sheet.heading("Evidence")
    sheet.columns(_readings(sheet, found, said, named))
    sheet.say(
        "Computed is the mean over all that the evidence leaves; off by is the reading less that, "
        "and in brackets that in stated errors."
    )
    sources = [
        (named(name), plain(typeset(source)))
        for name, one in found.observed.items()
        for source in filter(None, one.source.split("; "))
    ]
    if sources:
        sheet.columns(Part(sources, columns=("what the reading was worked out from",)))
    rest = [name for name in found._outputs if name not in asked and name not in found.observed]
    if rest:
        sheet.fold("Also found:")
        sheet.columns(outputs_part({named(name): found[name] for name in rest}, numbers))
        sheet.unfold()
    sheet.fold("What was stated before the evidence, and how well that predicts it:")
    sheet.columns(
        Part(
            [
                (named(name), _with(plain(_stated(sheet, one, unit)), said.get(name)))
                for name, one in found.priors.items()
                for unit in [found.unknowns[name].unit or ""]
            ],
            columns=("as it was stated",),
        )
    )
    sheet.say(
        "Natural logarithm of the probability of all readings together (the log evidence), and "
        f"the error of sampling: {found.log_evidence:.4g} ± {found.log_evidence_error:.2g}. It "
        "means something only beside that of another account of the same readings."
    )
    sheet.unfold()
    sheet.say(f"Given the evidence and the priors ({found.samples} samples), seed {found.seed}.")


def warned_of(
    found: Posterior | Fit | Propagation,
    asked: Sequence[str] = (),
    named: Callable[[str], str] = plain,
) -> Iterator[tuple[str, str]]:
    """What was warned of, as the answer has it: a label and a sentence. That nothing determines an
    unknown belongs there if the answer is about it.
    """
    for note in _NOTES[type(found)](found):
        of_others = note.code == "undetermined" and not any(name in note.sentence for name in asked)
        if note.warning is not None and not of_others:
            sentence = note.statement
            if not isinstance(found, Propagation):
                sentence = _said(sentence, found, named)
            yield f"{label_of(note.code)}:" if note.code else "", plain(as_sentence(sentence))


def _said(sentence: str, found: Posterior | Fit, named: Callable[[str], str]) -> str:
    """A sentence with words in place of names; the longest names first, as one may begin
    another.
    """
    for name in sorted({*found.found, *found.residuals}, key=len, reverse=True):
        if named(name) != plain(name):
            sentence = sentence.replace(name, named(name))
    return sentence


def _readings(
    sheet: Sheet, found: Posterior, notes: Mapping[str, str], named: Callable[[str], str]
) -> Part:
    """Each reading beside what is computed for it."""
    rows: list[tuple[str, ...]] = []
    for name, one in found.observed.items():
        residual = found.residuals[name]
        reading, error = _reading(sheet, one, residual.unit)
        spread = float(found.predicted[name].std)
        off = _number(sheet, residual.residual, residual.unit, spread, bare=True)
        off = f"+{off}" if residual.residual > 0.0 else off
        off += f" ({rounded(residual.over_sigma, 2)})" if residual.sigma else ""
        computed = _number(sheet, residual.computed, residual.unit, spread)
        rows.append((named(name), reading, error, computed, off, plain(notes.get(name, ""))))
    heads = ("reading", "stated error", "computed", "off by", "where it is from")
    if any(row[-1] for row in rows):
        return Part(rows, columns=heads)
    return Part([row[:-1] for row in rows], columns=heads[:-1])


def _number(sheet: Sheet, value: float, unit: str, deviation: float, bare: bool = False) -> str:
    """A number of a reading, rounded to its deviation, which stands behind it unless it is
    ``bare``; one of a unit of its own to four figures.
    """
    kind = KIND_OF.get(unit, sheet.system.unlisted)
    if kind is None:
        return number_with_unit(f"{value:.4g}", unit)
    if bare:
        return sheet.system.span(value, value, kind, deviation)
    return sheet.system.answer(value, kind, deviation)


def _reading(sheet: Sheet, one: Statement, unit: str) -> tuple[str, str]:
    """What was read, and its error, as they were stated; of bounds their text."""
    text = plain(_stated(sheet, one, unit))
    if not isinstance(one, Normal):
        return text, ""
    value, _, error = text.partition(" ± ")
    return value + error.lstrip(_OF_NUMBER), error


def _stated(sheet: Sheet, one: Statement, unit: str = "") -> str:
    """A statement in the unit in which it was made, or of bare numbers in that of the page."""
    kind = KIND_OF.get(unit, "")
    return stated_in(one, sheet.system, kind) if kind else str(one)


def _with(text: str, note: str | None) -> str:
    return f"{text}. {note}" if note else text


def names_of_notes(found: Posterior) -> Iterator[str]:
    """What a note can stand beside: each reading, and what was stated of each unknown."""
    yield from found.observed
    yield from found.priors
