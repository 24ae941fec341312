"""Warnings: given at the caller's own line, silenced, or counted over the samples of a study and
stated with its result.
"""

from __future__ import annotations

import math
import re
import sys
import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from .errors import CollisionsWarning
from .marked import plain
from .shares import in_percent

# A warning of fewer samples than this share is stated with the result, but not raised, unless it
# has a share of its own.
SELDOM = 0.005
# A share that none exceeds: what is stated with the number of samples, and never raised.
STATED = 2.0
# Codes of the warnings that say why cases have no answer.
NO_ANSWER = frozenset(
    {"refused_cases", "several_orders", "stuck_or_slid", "friction_differs", "only_backwards"}
)
# Of the warning that samples are known from one side only, which outputs that say so need not have.
BOUND = "bound_as_value"
# Of a statement for those alone who work back through a model from what was observed.
WORKED_BACK = "worked_back"
# Of the statement that what comes in another order has no answer.
ONE_ORDER = "one_order"
# Of the statement that evidence agrees with itself.
AGREES = "agrees"
# Of what a study within the model of another states without a warning.
INNER = "inner_study"
# Before each sentence of such a study, and before one of many that differ in their numbers.
_WITHIN = "in a study within the model, "
_WITHIN_SEVERAL = "in several studies within the model, of which one says: "
# Numbers, but for those in names, such as contacts[0] and speed_1.
_NUMBERS = re.compile(r"(?<![\w\[.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w\]])")


class Said(NamedTuple):
    """A warning while a model was called: what it says without its numbers, and where it holds.

    ``where`` is a boolean for each case of the solver's own call; None for a call of plain numbers.
    It is raised where it is of this share of all samples at ``least``, and never above 1; at 0,
    always, and at infinity never, it is said of the study and not of cases.
    """

    sentence: str
    warning: type[CollisionsWarning]
    code: str
    where: Any
    least: float = SELDOM


class Noted(NamedTuple):
    """A warning of one call of a model: of how many of its cases at the least, and how many times
    it was given without saying of which cases.
    """

    sentence: str
    warning: type[CollisionsWarning]
    code: str
    least: float
    cases: int
    uncounted: int


# The cases of each call of a model, and what was noted of them.
Calls: TypeAlias = list[tuple[int, list[Noted]]]


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


# A thread or process that a model starts has a context of its own, in which no study is known,
# unless it runs in a copy of that of the model. Who started a thread cannot be known: one without
# such a copy may be anybody's.
_quiet: ContextVar[bool] = ContextVar("quiet", default=False)
_sampling: ContextVar[list[Said] | None] = ContextVar("sampling", default=None)
_answer: ContextVar[int | None] = ContextVar("answer", default=None)


def _note(
    sentences: Mapping[str, Any], kind: type[CollisionsWarning], code: str, least: float
) -> bool:
    """Note the sentences, each with where it holds; whether this is within a study."""
    said = _sampling.get()
    if said is None:
        return False
    said += (Said(sentence, kind, code, where, least) for sentence, where in sentences.items())
    return True


def warn(warning: CollisionsWarning, where: Any = None, sentence: str = "") -> None:
    """Warn at the line of the first caller outside this package.

    Within a study the sentence is noted in place of it: what it says without numbers that differ
    from call to call, and in which cases, as in ``Said``.
    """
    if _note({sentence or warning.marked: where}, type(warning), warning.code, SELDOM):
        return
    _give(warning)


def _give(warning: CollisionsWarning) -> None:
    """Warn at the line of the first caller outside this package."""
    level, package = 1, __name__.partition(".")[0]
    frame: Any = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame = frame.f_back
        level += 1
    warnings.warn(warning, stacklevel=level)


def warn_of_cases(
    warning: CollisionsWarning, parts: Mapping[str, Any], least: float = SELDOM
) -> None:
    """Warn of what some cases show; nothing within ``quietly()``.

    Within a study the ``parts`` are noted instead: what is said without numbers that belong to one
    case, and where, as in ``Said``; and raised where it is said of this share of all at ``least``.
    """
    if not _note(parts, type(warning), warning.code, least) and not _quiet.get():
        _give(warning)


def in_study() -> bool:
    """Whether a model is called for the samples of a study, whose warnings are noted."""
    return _sampling.get() is not None


def state_of_study(sentence: str, code: str) -> None:
    """State something of the model of a study, once in its result, without a warning; nothing
    outside a study.
    """
    _note({sentence: None}, CollisionsWarning, code, math.inf)


def state_of_cases(parts: Mapping[str, Any], code: str) -> None:
    """State something of some cases of a study, with their number and without a warning, in parts
    as ``warn_of_cases`` has them; nothing outside a study.
    """
    _note(parts, CollisionsWarning, code, STATED)


def warn_of_samples(warning: CollisionsWarning) -> None:
    """Note what is said of the samples of a study together, not of some of them."""
    _note({warning.marked: None}, type(warning), warning.code, 0.0)


@contextmanager
def quietly(said: list[Said] | None = None) -> Iterator[None]:
    """Within this context, in this thread only, ``warn_of_cases`` is silent; with ``said`` the
    cases are those of a study, and its warnings go there.
    """
    token, sampled = _quiet.set(True), _sampling.set(said)
    try:
        yield
    finally:
        _quiet.reset(token)
        _sampling.reset(sampled)


@contextmanager
def of_answer(at: int | None) -> Iterator[None]:
    """Within this context, in this thread only, a solver warns of that one of its several answers
    alone, counted from 0; of all for None.
    """
    token = _answer.set(at)
    try:
        yield
    finally:
        _answer.reset(token)


def answer_counts(at: int) -> bool:
    """Whether what is said of this of several answers, counted from 0, is to be warned of."""
    return _answer.get() in (None, at)


@contextmanager
def of_some(where: Any, but: Collection[str] = ()) -> Iterator[None]:
    """Within this context what is noted of a study is of these of all cases: of those among them
    that it is of, if it was said with a number for each of them. What has one of the codes ``but``
    is dropped.
    """
    said = _sampling.get()
    if said is None:
        yield
        return
    mine: list[Said] = []
    token = _sampling.set(mine)
    try:
        yield
    finally:
        _sampling.reset(token)
        for one in mine:
            if one.code in but:
                continue
            whole = np.array(where)
            own = _by_case(one.where, int(np.count_nonzero(where)))
            if own is not None:
                whole[where] = own
            elif one.where is not None:
                whole &= np.any(one.where)
            said.append(one._replace(where=whole))


def noted_in_call(said: Iterable[Said], count: int) -> list[Noted]:
    """What was said while a model was called with so many cases: each warning once, of the cases
    it is of.

    Those are known of arrays with a number for each case, and where there is one case. A call of
    plain numbers may be of one case of a loop or stand for all of them, and one of other arrays of
    anything: nothing but how often it warned is known.
    """
    found: dict[tuple[Any, ...], tuple[Any, int]] = {}
    for sentence, kind, code, where, least in said:
        key = sentence, kind, code, least
        cases, uncounted = found.get(key, (np.zeros(count, dtype=bool), 0))
        own = _by_case(where, count)
        found[key] = (cases, uncounted + 1) if own is None else (cases | own, uncounted)
    return [
        Noted(sentence, kind, code, least, int(np.count_nonzero(cases)), uncounted)
        for (sentence, kind, code, least), (cases, uncounted) in found.items()
    ]


def _by_case(where: Any, count: int) -> Any:
    """In which cases of a call of a model it holds; None where that is not known."""
    shape = np.shape(where)
    if count == 1:
        return where is None or bool(np.any(where))
    if shape.count(count) != 1:
        return None
    return np.any(where, axis=tuple(i for i, size in enumerate(shape) if size != count))


def notes_of_samples(calls: Calls, *, worked_back: bool = False) -> tuple[Note, ...]:
    """What was noted over all samples of a study: each warning once, with the number and the share
    of the samples it is of where those are known. ``worked_back`` says that the study works back
    through its model.
    """
    total = sum(count for count, _ in calls)
    found: dict[tuple[Any, ...], tuple[int, int]] = {}
    sentences: dict[tuple[Any, ...], set[str]] = {}
    for _, noted in calls:
        for sentence, kind, code, least, cases, uncounted in noted:
            if code == WORKED_BACK and not worked_back:
                continue
            key = _but_for_numbers(sentence), kind, code, least
            known, more = found.get(key, (0, 0))
            found[key] = known + cases, more + uncounted
            sentences.setdefault(key, set()).add(sentence)
    notes = []
    for key, (cases, uncounted) in found.items():
        _, kind, code, least = key
        # The same one whatever thread came first.
        sentence = min(sentences[key])
        if len(sentences[key]) > 1:
            sentence = _WITHIN_SEVERAL + sentence.removeprefix(_WITHIN)
        # A share that is not known may be any.
        at_most = 1.0 if uncounted else cases / total
        of = f"{cases} of {total} cases ({in_percent(cases, total)}): "
        fields: dict[str, Any] = {"cases": cases, "share": at_most}
        if least in (0.0, math.inf):
            of, fields = "", {}
        elif uncounted and cases < total:
            of = _of_uncounted(cases, uncounted, total)
            fields = {"cases": None, "share": None, "times": uncounted}
        of = "" if total == 1 else of
        note = Note(kind if at_most >= least else None, of + sentence, code=code, fields=fields)
        notes.append((at_most, note))
    return tuple(note for _, note in sorted(notes, key=lambda pair: -pair[0]))


def leave_to_outer(calls: Calls) -> None:
    """Note of the study whose model this one is in, if any, what is said for those alone that work
    back through a model: this one does not.
    """
    for _, noted in calls:
        for one in noted:
            if one.code == WORKED_BACK:
                state_of_study(_WITHIN + one.sentence, one.code)


def _but_for_numbers(sentence: str) -> str:
    """A sentence of a study within a model without its numbers, which differ from study to study;
    any other as it is.
    """
    return _NUMBERS.sub("0", sentence) if sentence.startswith(_WITHIN) else sentence


def _of_uncounted(cases: int, times: int, total: int) -> str:
    """Of how many cases something is said where that is not known."""
    many = (
        f"{times} warning{'s' * (times > 1)} that {'do' if times > 1 else 'does'} not say of which"
    )
    if cases:
        return f"at least {cases} of {total} cases, and {many}, so the share is not known: "
    return f"{many} of {total} cases, which may be all: "


def warn_of(notes: Iterable[Note]) -> None:
    """Give each warning among the notes, one for each code. Within the model of another study all
    of them are noted of that, but that evidence agrees with itself.
    """
    notes = tuple(notes)
    if in_study():
        for note in notes:
            if note.warning:
                sentence = f"{_WITHIN}{note.sentence}{note.rest}"
                _note({sentence: None}, note.warning, note.code, SELDOM)
            elif note.code != AGREES:
                state_of_study(_WITHIN + note.sentence, INNER)
        return
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
