"""Checks the arguments of a report: one error names every option that cannot be used."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, NamedTuple, TypeAlias, get_args

from ..derivation.evidence import momentum_inputs
from ..derivation.explain import (
    NOT_EXPLAINED,
    impact_inputs,
    key_of,
    names_of_answers,
    no_uncertainty,
)
from ..impact.impact import Impact
from ..kernels.elementwise import UNIT_INTERVAL
from ..messages.errors import InputError
from ..messages.hints import nearest
from ..messages.marked import type_of
from ..quantities.reading import ArgumentReader, need_one_case, single_number
from ..quantities.refusals import must_be, one_of, yes_or_no
from ..quantities.units import shown
from ..quantities.user_text import plain
from ..reconstruct import Fit, MomentumSolution, Posterior
from ..reconstruct.found_again import need_found_again
from ..scene.run import Run
from ..uncertainty import Propagation
from ..vehicle.outlines import read_outline
from . import sections
from .posterior_part import names_of_notes
from .sections import EVIDENCE
from .together import Together, together_of

Form: TypeAlias = Literal["html", "markdown"]
# What a page is filed under.
FILED = ("exhibit", "case", "author", "date")
_MOST_NEAR = 3
_RESULTS = (Impact, MomentumSolution, Fit, Posterior)
# Options of one impact.
_OF_ONE = ("outline_a", "outline_b", "share_a", *EVIDENCE)
# Options that do not apply to these results.
_OTHER_PARTS: dict[type, tuple[str, ...]] = {
    MomentumSolution: ("outline_a", "outline_b", "share_a"),
    Fit: ("outline_a", "outline_b", "share_a", "duration", "drag", "limits", *EVIDENCE),
}
_OTHER_PARTS[Posterior] = (*_OTHER_PARTS[Fit], "derivation")


class Checked(NamedTuple):
    """The notes, as paragraphs and by input, and the outlines by vehicle."""

    paragraphs: list[str]
    by_input: dict[str, str]
    outlines: dict[str, Any]


def results_of(impact: Any, uncertainty: Any) -> tuple[list[tuple[Any, Any]], Together | None]:
    """Each result of a report with its propagation, if any; and what was found of a scene with its
    run, if the list has one.
    """
    if not isinstance(impact, list):
        need_one_case(impact, _RESULTS, "report", instead=NOT_EXPLAINED, runs=True)
        need_found_again(impact)
        return [(impact, uncertainty)], None
    if not impact:
        raise InputError(
            "impact is an empty list; give the results that the page is about",
            code="not_an_impact",
            argument="impact",
        )
    together = together_of(impact)
    for one in impact:
        if not isinstance(one, Run):
            need_one_case(one, _RESULTS, "report", instead=NOT_EXPLAINED, runs=True)
            need_found_again(one)
    if uncertainty is None:
        return [(one, None) for one in impact], together
    if not isinstance(uncertainty, list) or len(uncertainty) != len(impact):
        raise InputError(
            f"uncertainty must be a list of {len(impact)} for as many results, each what "
            "uncertainty.propagate returned or None, got "
            + (
                f"a list of {len(uncertainty)}"
                if isinstance(uncertainty, list)
                else type(uncertainty).__name__
            ),
            code="bad_option",
            argument="uncertainty",
        )
    pairs = list(zip(impact, uncertainty, strict=True))
    if any(isinstance(one, Run) and its is not None for one, its in pairs):
        raise InputError(
            "uncertainty has a propagation for a run that stands beside what was found of its "
            "scene, from which its ranges come; write None in its place",
            code="bad_option",
            argument="uncertainty",
        )
    return pairs, together


def check_alone(reader: ArgumentReader, options: Mapping[str, Any]) -> None:
    """Refuse the options that no page can use, whatever results it is about."""
    form, notes, answers = (options[name] for name in ("form", "notes", "answers"))
    if not isinstance(form, str) or form not in get_args(Form):
        reader.refuse(one_of("form", get_args(Form), form, code="bad_option"))
    named = isinstance(answers, (list, tuple)) and answers
    if answers is not None and not (named and all(isinstance(name, str) for name in answers)):
        listed = "a list of names of what was found, such as `['speed of the Golf']`"
        reader.refuse(must_be("answers", listed, answers, code="bad_option"))
    texts = [(name, options[name]) for name in ("title", *FILED) if options[name] is not None]
    for part in _notes_of(options):
        several = part.values() if isinstance(part, Mapping) else (part,)
        texts += (("notes", text) for text in several)
    for name, text in texts:
        if not isinstance(text, str) or not plain(text):
            reader.refuse(must_be(name, "a text that says something", text, code="not_a_text"))
    if notes is not None and not isinstance(notes, (str, list, tuple, Mapping)):
        allowed = "a text, a list of texts, or `|a dict|a table` of them by input"
        reader.refuse(must_be("notes", allowed, notes, code="not_a_text", got=type_of(notes)))
    for name in ("figures", "derivation"):
        if not isinstance(options[name], bool):
            reader.refuse(yes_or_no(name, options[name], code="bad_option"))
    if options["share_a"] is not None:
        share = reader.number(options["share_a"], "", "share_a", UNIT_INTERVAL)
        single_number(reader, share, "share_a", "takes one value: a report is of one case")


def _notes_of(options: Mapping[str, Any]) -> list[Any]:
    """The notes, one or several; none where they are no notes."""
    notes = options["notes"]
    if isinstance(notes, (list, tuple)):
        return list(notes)
    return [notes] if isinstance(notes, (str, Mapping)) else []


def checked(
    results: Sequence[tuple[Any, Any]],
    options: Mapping[str, Any],
    unusual: Sequence[str],
    run: Run | None = None,
) -> Checked:
    """What the options say; one error names every one that cannot be used."""
    reader = ArgumentReader()

    def refuse(argument: str, text: str, code: str = "bad_option") -> None:
        reader.refuse(InputError(text, code=code, argument=argument))

    check_alone(reader, options)
    parts = _notes_of(options)
    paragraphs = [part for part in parts if not isinstance(part, Mapping)]
    beside = {
        name: text for part in parts if isinstance(part, Mapping) for name, text in part.items()
    }
    several = len(results) > 1
    known = _can_have_notes(results, options)
    if run is not None:
        known += [name for name in run.scene.inputs() if name not in known]
    for name in [name for name in beside if name not in known]:
        instead = (
            f"they are {', '.join(known)}"
            if known
            else "a page of several results has notes that are texts alone, but for those of the "
            "readings and priors of a fit or posterior; write `notes=['Weighed']`"
        )
        refuse("notes", f"notes has {shown(name)}, which is no input of this page; {instead}")
    _check_answers(refuse, options["answers"], results)
    for one, uncertainty in results:
        if uncertainty is not None and not isinstance(uncertainty, Propagation):
            refuse(
                "uncertainty",
                "uncertainty must be what uncertainty.propagate returned, got "
                f"{type(uncertainty).__name__}; standard deviations by name go to "
                "explain(impact, `uncertainty=...`)",
            )
        if isinstance(one, (Fit, Posterior)) and isinstance(uncertainty, Propagation):
            reader.refuse(no_uncertainty(type(one).__name__))
    kinds = [type(one) for one, _ in results]
    for name in unusual:
        if all(name in _OTHER_PARTS.get(kind, ()) for kind in kinds):
            refuse(
                name,
                f"{name} is for an Impact, and a {kinds[0].__name__} has no part for it; leave it "
                "out, or report the impact itself",
            )
        elif several and name in _OF_ONE:
            refuse(
                name,
                f"{name} is of one impact, and this page has {len(results)} results; leave it "
                "out, or report that impact alone",
            )
    outlines = {
        label: read_outline(reader, options[f"outline_{label}"], f"outline_{label}")
        for label in "ab"
        if options[f"outline_{label}"] is not None
    }
    reader.close()
    return Checked(
        [plain(paragraph) for paragraph in paragraphs],
        {name: plain(text) for name, text in beside.items()},
        outlines,
    )


def _can_have_notes(results: Sequence[tuple[Any, Any]], options: Mapping[str, Any]) -> list[str]:
    """What a note can stand beside, by name: the inputs of a result that stands alone, and the
    readings and priors of each.
    """
    impact = results[0][0]
    if len(results) > 1:
        evidence = [one for one, _ in results if isinstance(one, (Fit, Posterior))]
        return list(dict.fromkeys(name for one in evidence for name in inputs_of(one)))
    # For an impulse, duration and drag are not inputs but options of the page, as the outlines are.
    own = ["duration", "drag"] if isinstance(impact, Impact) and impact.pulse is None else []
    own += (name for name in ("outline_a", "outline_b") if options[name] is not None)
    return list(dict.fromkeys([*inputs_of(impact), *own]))


def _check_answers(
    refuse: Callable[[str, str], None], answers: Any, results: Sequence[tuple[Any, Any]]
) -> None:
    """Refuse names of answers that none of the results has."""
    if not isinstance(answers, (list, tuple)):
        return
    known: dict[str, None] = {}
    for one, uncertainty in results:
        if isinstance(one, Posterior):
            known |= dict.fromkeys(one._outputs)
        elif isinstance(one, Fit):
            known |= dict.fromkeys(one.names)
        else:
            if isinstance(uncertainty, Propagation):
                known |= dict.fromkeys(uncertainty.outputs)
            known |= dict.fromkeys(names_of_answers(one))
    for name in answers:
        if isinstance(name, str) and name not in known:
            near = nearest(name, known, _MOST_NEAR, 0.5) or list(known)[:_MOST_NEAR]
            refuse(
                "answers",
                f"answers has {shown(name)}, which nothing on this page is called; near it are "
                f"{', '.join(near)}",
            )


def inputs_of(impact: Impact | MomentumSolution | Fit | Posterior) -> list[str]:
    """The inputs that a note can stand beside, by name."""
    if isinstance(impact, Posterior):
        return list(dict.fromkeys(names_of_notes(impact)))
    if isinstance(impact, Fit):
        return list(impact.residuals)
    if isinstance(impact, Impact):
        found = [key_of(of, names) for of, _, names, _, _ in impact_inputs(impact)]
        for label, vehicle in (("a", impact.a.before), ("b", impact.b.before)):
            found += [f"{label}.{name}" for name, _ in sections.speed_rows(vehicle)]
        found += (
            []
            if impact.law is None or impact.model in ("linear_central", "time_resolved")
            else ["law"]
        )
        more = [*(impact.inputs.given or {}), *sections.evidence_names(impact)]
        return list(dict.fromkeys([*found, *more]))
    rows = momentum_inputs(impact) if isinstance(impact, MomentumSolution) else ()
    return [name.partition("[")[0] for _, _, name, _, _ in rows]
