"""Answers of a case file: results, what follows from its uncertain numbers, warnings; as text, as JSON and as a report."""

from __future__ import annotations

import json
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import reduce
from inspect import signature
from typing import Any

import numpy as np

from .case_file import FORWARD, SOLVERS, STUDIES, Call, Case, CaseError, ends, nearest
from .errors import CollisionsWarning
from .impact import Impact
from .quantities import unit_of
from .reconstruct import MomentumSolution, Posterior
from .reporting import report
from .reporting.record import record
from .units import shown, to_quantity
from .what_if import starts, what_if

# The parts of a report that are not printed, by their first words.
_LEFT_OUT = ("Inputs", "The contact, and", "Assumptions", "Notes", "Figures", "Derivation", "References", "Record")


@dataclass(frozen=True)
class Answers:
    """The results of a case, what follows from its uncertain numbers, and the texts of the warnings so far."""

    case: Case
    results: tuple[Any, ...]
    propagation: Any
    warnings: list[str]

    def report(self, form: str, units: str | None = None, figures: bool = True) -> str:
        """The report of the one result; ``units`` in place of those of the file."""
        return self._page(self._one(), form, units, figures)

    def what_if(self, units: str | None = None) -> str:
        """The page with sliders: over the ranges of the file, or over what it says of its uncertain numbers."""
        one, found = self._one(), self.case.ranges
        if not found and isinstance(one, Impact):
            known = starts(one)
            named = ((_slider(key), uncertain.stated) for key, uncertain in self.case.uncertain.items())
            found = {name: ends(stated) for name, stated in named if name in known}
            if not found:
                text = 'is not there, and nothing else says what to move; write it, such as speed_a = ["30 km/h", "80 km/h"]'
                raise CaseError(("what_if.ranges", text))
        shown_in = units or self.case.report.get("units", "metric")
        page = Call("what_if", what_if, {"impact": one, "ranges": found, "units": shown_in})
        with _noting(self.warnings):
            whole: str = page({})
        return whole

    def _one(self) -> Any:
        """The one result that a page is of."""
        if len(self.results) > 1:
            text = f"{len(self.results)} answers fit, and a page is of one; write answer = 1 or another at the top of the file"
            raise CaseError(("answer", text), refused=True, code="ambiguous")
        return self.results[0]

    def text(self, units: str | None = None) -> str:
        """The results, the uncertainty and the findings, as in the report."""
        found: list[str] = []
        for number, result in enumerate(self.results, 1):
            if isinstance(result, Posterior):
                return f"{result}\n"
            page = self._page(result, "markdown", units, figures=False)
            head, *sections = page.split("\n## ")
            gain = [line for line in head.splitlines() if line.startswith("**")]
            parts = [f"## {part}" for part in sections if not part.startswith(_LEFT_OUT)]
            title = [f"# Answer {number} of {len(self.results)}"] if len(self.results) > 1 else []
            found += map(_aligned, [*title, *gain, *parts])
        return "\n\n".join(part.strip() for part in found) + "\n"

    def to_dict(self) -> dict[str, Any]:
        """Everything in plain values for other tools: each result as the record at the end of a report."""
        from . import __version__

        return {
            "results": [
                result.to_dict()
                if isinstance(result, Posterior)
                else json.loads(record(result, __version__, {}, self.propagation))
                for result in self.results
            ],
            "uncertainty": None if self.propagation is None else self.propagation.to_dict(),
            "warnings": self.warnings,
        }

    def _page(self, result: Any, form: str, units: str | None, figures: bool) -> str:
        options = {"units": "metric", **self.case.report, **({} if units is None else {"units": units})}
        options |= {} if figures else {"figures": False}
        page = Call("report", report, {**options, "form": form, "uncertainty": self.propagation, "impact": result})
        with _noting(self.warnings):
            whole: str = page({})
        return whole


def _slider(key: str) -> str:
    """The name by which ``what_if`` knows a key of the file."""
    label, _, name = key.rpartition(".")
    return f"{name}_{label}" if label else key.replace("[0]", "_x").replace("[1]", "_y")


def answers(case: Case) -> Answers:
    """Solve a case, and do what it asks of its uncertain numbers."""
    noted: list[str] = []
    with _noting(noted):
        if case.study in ("", "propagate"):
            results = _results(case)
            propagation = _propagated(case, results) if case.uncertain else None
        else:
            model = _model(case, case.options["observed"], 0, 1)
            unknowns = {name: one.stated for name, one in case.uncertain.items()}
            study = Call(case.study, STUDIES[case.study], {"model": model, "unknowns": unknowns, **case.options})
            results, propagation = (study({}),), None
    return Answers(case, results, propagation, noted)


@contextmanager
def _noting(texts: list[str]) -> Iterator[None]:
    """Within this context warnings are no warnings, but are added to the texts, each once."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", CollisionsWarning)
        yield
    found = dict.fromkeys(" ".join(str(one.message).split()) for one in caught)
    texts += [text for text in found if text not in texts]


def _results(case: Case) -> tuple[Any, ...]:
    """All that the solver gives, or the one answer that was asked for."""
    found = case.call({})
    results = found if isinstance(found, tuple) else (found,)
    if case.answer is None:
        return results
    if case.answer > len(results):
        raise CaseError(("answer", f"is {shown(case.answer)}, and {len(results)} fit; write a number from 1 to {len(results)}"))
    return (results[case.answer - 1],)


def _propagated(case: Case, results: tuple[Any, ...]) -> Any:
    """What follows for the outputs that were asked for, or for the first that a reader looks for."""
    if len(results) > 1:
        text = f"is not given, and {len(results)} answers fit; write answer = 1 or another at the top of the file"
        raise CaseError(("answer", text), refused=True, code="ambiguous")
    options = dict(case.options)
    outputs = options.pop("outputs", _usual(case, results[0]))
    if not isinstance(outputs, tuple) or not outputs or not all(isinstance(name, str) for name in outputs):
        raise CaseError(("propagate.outputs", 'must be a list of names of answers, such as ["a.delta_v", "energy_loss"]'))
    roots = case.call({})
    model = _model(case, outputs, (case.answer or 1) - 1, len(roots) if isinstance(roots, tuple) else 1)
    inputs = {name: one.stated for name, one in case.uncertain.items()}
    return Call("propagate", STUDIES["propagate"], {"model": model, "inputs": inputs, **options})({})


def _model(case: Case, outputs: Any, which: int, count: int) -> Any:
    """The case as a function of its uncertain numbers, which gives these outputs as Quantities."""
    takes = signature(SOLVERS[case.solver]).parameters
    options = {"on_failure": "nan"} if "on_failure" in takes else {}

    def model(**values: Any) -> dict[str, Any]:
        found = case.call(values, **options)
        roots = found if isinstance(found, tuple) else (found,)
        if any(not np.all(root.refused) for root in roots[count:]):
            text = "has more answers in some cases than in the stated one; narrow what is uncertain, or give what decides"
            raise CaseError((case.solver, text), refused=True, code="ambiguous")
        # Where roots have met and gone, those left cannot be told apart.
        all_there = True if count == 1 else np.False_ if len(roots) < count else ~roots[count - 1].refused
        shape = np.broadcast_shapes(*map(np.shape, values.values()))
        return {name: _output(roots[min(which, len(roots) - 1)], name, all_there, shape) for name in outputs}

    return model


def _output(result: Any, name: str, there: Any, shape: tuple[int, ...]) -> Any:
    """A number of a result by its path, as a Quantity for each case; NaN where the result is not there."""
    path, _, last = name.rpartition(".")
    owner = reduce(lambda whole, part: getattr(whole, part, None), filter(None, path.split(".")), result)
    value, unit = getattr(owner, last, None), unit_of(type(owner), last)
    if unit is None or isinstance(value, tuple):
        names = result.to_columns() if isinstance(result, Impact) else result.__dataclass_fields__
        raise CaseError((name, f"is no number of the answer; {nearest(name, names)}"))
    if value is None:
        why = owner._missing(last) if hasattr(owner, "_missing") else "this case has none"
        raise CaseError((name, f"is not known: {why}"))
    return to_quantity(np.broadcast_to(np.where(there, value, np.nan), shape), unit)


def _usual(case: Case, result: Any) -> tuple[str, ...]:
    """The outputs where the file names none: what was sought of a reverse solver, and what people ask of an impact."""
    if isinstance(result, MomentumSolution):
        return (*result.unknowns, "delta_v_a", "delta_v_b")
    found = ("a.delta_v", "b.delta_v", "energy_loss")
    return found if case.solver in FORWARD else ("a.before.speed", "b.before.speed", *found)


def _aligned(text: str) -> str:
    """Markdown as a text: the columns of its tables as wide as their longest cells, without marks and lines of dashes."""
    lines = [
        [re.sub(r"\\(.)", r"\1", part.strip()) for part in (re.split(r"(?<!\\)\|", line)[1:-1] if line[:1] == "|" else [line])]
        for line in text.splitlines()
        if not line.startswith("| ---")
    ]
    wide = [max((len(row[at]) for row in lines if len(row) > 1), default=0) for at in range(3)]
    return "\n".join("  ".join(map(str.ljust, row, wide)).rstrip() if len(row) > 1 else row[0] for row in lines)
