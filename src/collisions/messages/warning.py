"""Warnings: given at the caller's own line, silenced, or counted over the samples of a study and
stated with its result.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, NamedTuple

from .errors import CollisionsWarning
from .marked import plain

# A warning of fewer samples than this share is stated with the result, but not raised, unless it
# has a share of its own.
SELDOM = 0.005
# Codes of the warnings that say why cases have no answer.
NO_ANSWER = frozenset({"refused_cases", "several_orders", "stuck_or_slid", "friction_differs"})
# Of the statement that what comes in another order has no answer.
ONE_ORDER = "one_order"


class Noted(NamedTuple):
    """A warning raised while a model was called: what it says without its numbers, and the cases of
    that call it is of.

    ``cases`` is None where it is of all of them. It is raised where it is of this share of all
    samples at ``least``.
    """

    sentence: str
    warning: type[CollisionsWarning]
    code: str
    cases: int | None
    least: float = SELDOM


class Note(NamedTuple):
    """A statement about a result; one that is also a warning has a ``code``, and its ``rest``
    follows the sentence, which is marked as that of an error is.
    """

    warning: type[CollisionsWarning] | None
    sentence: str
    rest: str = ""
    code: str = ""
    fields: Mapping[str, Any] = {}  # never changed; a read-only view could not be pickled

    @property
    def statement(self) -> str:
        """The sentence as a caller in Python reads it."""
        return plain(self.sentence)


_quiet: ContextVar[bool] = ContextVar("quiet", default=False)
_sampling: ContextVar[list[Noted] | None] = ContextVar("sampling", default=None)


def warn(warning: CollisionsWarning, cases: int | None = None) -> None:
    """Warn at the line of the first caller outside this package; within a study it is noted, as of
    so many cases, or of all.
    """
    noted = _sampling.get()
    if noted is not None:
        noted.append(Noted(warning.marked, type(warning), warning.code, cases))
        return
    level, package = 1, __name__.partition(".")[0]
    frame: Any = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame = frame.f_back
        level += 1
    warnings.warn(warning, stacklevel=level)


def warn_of_cases(
    warning: CollisionsWarning, parts: Mapping[str, int | None], least: float = SELDOM
) -> None:
    """Warn of what some cases show; nothing within ``quietly()``.

    Within a study the ``parts`` are noted instead: what is said of how many cases, without numbers
    that belong to one of them; and raised where it is said of this share of all at ``least``.
    """
    noted = _sampling.get()
    if noted is not None:
        noted += (
            Noted(sentence, type(warning), warning.code, count, least)
            for sentence, count in parts.items()
        )
    elif not _quiet.get():
        warn(warning)


def in_study() -> bool:
    """Whether a model is called for the samples of a study, whose warnings are noted."""
    return _sampling.get() is not None


def state_of_study(sentence: str, code: str) -> None:
    """State something of the model of a study, once in its result, without a warning; nothing
    outside a study.
    """
    noted = _sampling.get()
    if noted is not None:
        noted.append(Noted(sentence, CollisionsWarning, code, None, math.inf))


def warn_of_samples(warning: CollisionsWarning) -> None:
    """Note what matters only where the cases are samples of one case: within a study."""
    if _sampling.get() is not None:
        warn(warning)


@contextmanager
def quietly(noted: list[Noted] | None = None) -> Iterator[None]:
    """Within this context, in this thread only, ``warn_of_cases`` is silent; with ``noted`` the
    cases are those of a study.
    """
    token, sampled = _quiet.set(True), _sampling.set(noted)
    try:
        yield
    finally:
        _quiet.reset(token)
        _sampling.reset(sampled)


def notes_of_samples(noted: Iterable[Noted], total: int) -> tuple[Note, ...]:
    """What was noted over all samples of a study: each warning once, with the number and the share
    of the samples it is of.
    """
    counts: dict[tuple[str, type[CollisionsWarning], str, float], int] = {}
    for sentence, kind, code, count, least in noted:
        key = sentence, kind, code, least
        counts[key] = counts.get(key, 0) + (total if count is None else count)
    notes = []
    for (sentence, kind, code, least), found in counts.items():
        cases = min(found, total)
        share = cases / total
        # What is never raised is said of the model rather than of its samples.
        of = f"{cases} of {total} cases ({100.0 * share:.3g} %): "
        of = "" if total == 1 or least > 1.0 else of
        raised = kind if share >= least else None
        notes.append(
            Note(raised, of + sentence, code=code, fields={"cases": cases, "share": share})
        )
    return tuple(sorted(notes, key=lambda note: -note.fields["cases"]))


def warn_of(notes: Iterable[Note]) -> None:
    """Give each warning among the notes, one for each code."""
    raised = [note for note in notes if note.warning]
    for note in {note.code: note for note in raised}.values():
        alike = [one for one in raised if one.code == note.code]
        assert note.warning is not None
        warn(
            note.warning(
                "; ".join(one.sentence for one in alike) + note.rest,
                code=note.code,
                **alike[0].fields,
            )
        )
