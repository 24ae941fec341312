"""``report``: the whole page of one result, or of several, with its figures, from the first heading
to the record.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from inspect import signature
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ..derivation.evidence import fit
from ..derivation.explain import about_ranges, explain
from ..derivation.scene import ledger, rests
from ..diagnostics import diagnose
from ..diagnostics.finding import Finding, Findings, is_note
from ..diagnostics.scene import of_impact
from ..estimate.posterior_result import PosteriorOutput
from ..impact.impact import Impact, with_vehicles
from ..impact.instant import neglected
from ..messages.errors import InputError
from ..plot.canvas import who
from ..quantities.document import Document
from ..quantities.formatting import UnitSystem
from ..quantities.settings import callers_options, computing
from ..quantities.tables import as_sentence, cells, given_texts, label_of
from ..quantities.units import Input, Pair, kinds_in_degrees, shown
from ..quantities.user_text import plain
from ..reconstruct import Fit, MomentumSolution, Posterior
from ..scene.one_run import need_one_run
from ..scene.run import Run
from ..uncertainty import Propagation
from ..uncertainty.output import outputs_part, varies
from ..vehicle.drag import USUAL_DURATION
from . import figures as drawing
from . import sections
from .answer import Figure, answer, figures_of, ranged_text, rests_on
from .checking import FILED, Checked, Form, checked, results_of
from .posterior_part import posterior, warned_of
from .record import plain_options, record_of_all
from .render import Html, Markdown, Printed, Sheet
from .run_page import report_run, units_of_run, vehicles
from .sections import EVIDENCE
from .together import Together, words_of
from .uncertainty import Spread
from .words import Names, listed

Result: TypeAlias = Impact | MomentumSolution | Fit | Posterior
_SURROGATE = re.compile("[\ud800-\udfff]")


@computing
def report(
    impact: Result | Run | list[Any],
    *,
    title: str | None = None,
    form: Form = "html",
    units: UnitSystem | None = None,
    uncertainty: Propagation | list[Propagation | None] | None = None,
    outline_a: Any = None,
    outline_b: Any = None,
    duration: Input = USUAL_DURATION,
    drag: Input = 0.7,
    limits: Mapping[str, Any] | None = None,
    crush_energy: Input | None = None,
    damage_pdof_a: Input | None = None,
    damage_pdof_b: Input | None = None,
    damage_delta_v_a: Input | Pair | None = None,
    damage_delta_v_b: Input | Pair | None = None,
    share_a: Input | None = None,
    notes: str | Mapping[str, str] | Sequence[str | Mapping[str, str]] | None = None,
    answers: Sequence[str] | None = None,
    figures: bool = True,
    derivation: bool = False,
    author: str | None = None,
    case: str | None = None,
    date: str | None = None,
    exhibit: str | None = None,
) -> Document:
    """One page about a result: the answer with its range, then inputs, results, uncertainty,
    findings, figures, assumptions, derivation, sources and the record.

    An energy gain comes before the answer. Every number comes from the result, from ``diagnose``,
    ``left_out`` or the propagation, rounded as in ``explain``; where no range is stated, the page
    says so. The page has one fact per line, and no date but the one that is given; the same
    arguments give the same page, byte for byte. From the record at its end ``reporting.replay``
    gives the impact again and ``reporting.options`` the options; with both, ``report`` makes the
    same page again.

    A ``MomentumSolution`` has neither contact nor positions, and a ``Fit`` or a ``Posterior`` has
    only unknowns and observations: their pages have only the parts that apply, and options for
    other parts are refused. The record of the last two has their numbers, but gives no impact back,
    because their model is code.

    Parameters
    ----------
    impact : Impact, MomentumSolution, Fit, Posterior or scene.Run, or list of these
        One case that was answered, of any forward or reverse solver; a scene as it went, with a
        part for each impact and where its kinetic energy went; or a list of several results,
        such as the momentum and each impact of one case: a page with one answer of all, and a part
        for each. A run stands in a list beside the posterior or fit of its scene,
        ``report([found, run])``: with a picture of the whole way and the measured places, and with
        the ranges that the samples leave of each impact.
    title : str, optional
        By default the names of the vehicles.
    form : {"html", "markdown"}
        One self-contained HTML file, to be read in a browser or printed; or Markdown, without
        figures.
    units : {"si", "metric", "us"}, optional
        By default those of the inputs, as for ``summary``.
    uncertainty : Propagation, optional
        From ``uncertainty.propagate``, of a ``Run`` with its scene as the model; for several
        results a list, with None for a result that has none. An output with the name of an answer,
        such as "b.after.vx" or "b_after_vx", also sets the rounding of that answer.
    outline_a, outline_b, duration, drag, limits
        As for ``diagnose``; the outlines are also drawn.
    crush_energy, damage_pdof_a, damage_pdof_b, damage_delta_v_a, damage_delta_v_b
        What the damage shows, as for ``diagnose``; printed among the inputs.
    share_a : float, str or Quantity [-], optional
        A's share of the energy, 0 to 1, for ``Impact.ees`` and ``max_crush_speeds``; without it
        neither is given.
    notes : str, dict or sequence of these, optional
        Your own words, each note in a paragraph of its own; or notes by input, printed beside it,
        such as where its value is from: ``{"restitution": "Low-speed tests of the same model",
        "a.mass": "Weighed"}``. "duration", "drag", "law" and the outlines that are given,
        "outline_a" and "outline_b", may have notes too; of a fit and of a posterior each reading
        and each prior, by its name, also on a page of several results.
    answers : list of str, optional
        What stands in the answer, by name and in this order: unknowns, results and outputs of a
        posterior, unknowns of a fit, outputs of ``uncertainty``, or results such as "a.delta_v". By
        default what the solver found with the delta-V, all outputs of ``uncertainty``, or of a
        posterior what ``with_result`` worked out and the speeds among its unknowns; all else that
        was found stands further down.
    figures : bool
        Whether to draw figures. They need matplotlib; without it the report says so and goes on.
    derivation : bool
        Whether to append the derivation of ``explain``.
    author, case, date, exhibit : str, optional
        Who made the page, the number or name of the case, the day, and the number of the page among
        the exhibits: printed below the title, and at the foot of every page in print.

    Returns
    -------
    Document
        The page: a ``str`` that a notebook shows as it is, and that ``.save("report.html")`` writes
        to a file.

    Raises
    ------
    InputError
        An argument that cannot be used, or an impact that was refused (code ``refused_impact``).
    ShapeError
        A batch: report one case of it.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions.reporting import report
    >>> a = col.Vehicle(mass="1100 kg", vx="80 km/h", name="Golf")
    >>> page = report(
    ...     col.linear_central(a, col.Vehicle(mass=950), 0.4), form="markdown", units="us"
    ... )
    >>> for line in page.splitlines():
    ...     if "velocity along x" in line or "delta-V |" in line:
    ...         print(line)
    | A (Golf) | velocity along x | 49.71 mph, given as 80 km/h |
    | B | velocity along x | 0 mph |
    | A (Golf) | delta-V | 32.3 mph |
    | B | delta-V | 37.3 mph |
    """
    given = dict(locals())
    from .. import __version__

    if isinstance(impact, Run):
        need_one_run(impact, "report", "impact")
        if answers is not None:
            raise InputError(
                f"answers is {shown(answers)}, and the page of a run alone has always the same "
                "answer; leave it out, or write report([found, run], `answers=...`) with what was "
                "found of its scene",
                code="bad_option",
                argument="answers",
            )
        given["units"] = units_of_run(impact, units)
        held = plain_options(given)
        changed = {name: value for name, value in held.items() if not _is_usual(name, value)}
        return report_run(impact, given, changed)
    given_results, together = results_of(impact, uncertainty)
    texts = [text for one, _ in given_results for text in given_texts(one)]
    system: Any = cells(units, texts).name
    given["units"] = system
    options = plain_options(given)
    unusual = {name: value for name, value in options.items() if not _is_usual(name, value)}
    results = given_results
    owns: list[_Own | None] = [None] * len(results)
    if together is not None:
        together = together.with_outputs(options["answers"])
        results, owns = _with_impacts(given_results, together)
    found = checked(results, options, list(unusual), together and together.run)
    printed = Printed(system, kinds_in_degrees(texts))
    sheet: Sheet = Html(printed, {}, {}) if form == "html" else Markdown(printed, {}, {})
    looked_at = {
        name: given[name]
        for name in ("outline_a", "outline_b", "duration", "drag", "limits", "units", *EVIDENCE)
    }
    parts = [
        _part(one, its, looked_at, system, own, together)
        for (one, its), own in zip(results, owns, strict=True)
    ]
    sheet.title(plain(title or _title_of_page(results, together)))
    filed = [(name, plain(options[name])) for name in FILED if options[name] is not None]
    if filed:
        sheet.file([(name.capitalize(), text) for name, text in filed])
    draws = figures and isinstance(sheet, Html) and drawing.can_draw()
    if together is None:
        _answers(sheet, parts, options, draws)
    else:
        with callers_options():
            whole = diagnose(
                together.run,
                **{name: given[name] for name in ("duration", "drag", "limits", "units")},
            )
        _answer_together(sheet, parts, together, whole, options, draws)
    for number, part in enumerate(parts, 1):
        if len(parts) > 1:
            sheet.begin_part(_heading(number, part), f"{number}.")
        _body(sheet, part, options, found, draws, alone=len(parts) == 1)
    if len(parts) > 1:
        sheet.end_parts()
        if together is not None:
            _ground(sheet, together)
        _notes(sheet, found)
    sections.sources(sheet, [(part.result, part.findings) for part in parts])
    sheet.say(f"Calculated with collisions {__version__}.")
    sheet.heading("Record")
    sheet.record(record_of_all(given_results, unusual))
    return Document(sheet.whole(__version__), form)


_USUAL = plain_options(
    {name: parameter.default for name, parameter in signature(report).parameters.items()}
)
_SEVERAL = "Results of one case"


def _is_usual(name: str, value: Any) -> bool:
    """Whether an option has its default value; one that cannot be compared, such as an array,
    counts as not.
    """
    return type(value) is type(_USUAL[name]) and bool(value == _USUAL[name])


class _Own(NamedTuple):
    """What is known of an impact of a run beside what was found of its scene."""

    together: Together
    number: int
    ranges: Mapping[str, PosteriorOutput]


class _Part(NamedTuple):
    """A result with what the page says of it."""

    result: Any
    # The same with names that a file can hold.
    readable: Any
    uncertainty: Propagation | None
    spread: Spread
    findings: Findings | None
    # None where the units of the page are those of its inputs.
    units: UnitSystem | None
    own: _Own | None


def _with_impacts(
    results: list[tuple[Any, Any]], together: Together
) -> tuple[list[tuple[Any, Any]], list[_Own | None]]:
    """The results with the impacts of a run in its place."""
    parts: list[tuple[Any, Any]] = []
    owns: list[_Own | None] = []
    for one, its in results:
        if not isinstance(one, Run):
            parts.append((together.found if isinstance(one, (Posterior, Fit)) else one, its))
            owns.append(None)
            continue
        for number, ranges in enumerate(together.ranges()):
            parts.append((one.impacts[number], None))
            owns.append(_Own(together, number, ranges))
    return parts, owns


def _title_of_page(results: Sequence[tuple[Any, Any]], together: Together | None) -> str:
    if together is not None:
        return f"The crash of {listed(together.run.scene.movers)}"
    return _title(results[0][0]) if len(results) == 1 else _SEVERAL


def _part(
    result: Any,
    uncertainty: Propagation | None,
    looked_at: Mapping[str, Any],
    system: UnitSystem,
    own: _Own | None,
    together: Together | None,
) -> _Part:
    findings = None
    words = together.words() if together is not None and result is together.found else None
    if own is not None:
        outlines = own.together.outlines_of(own.number)
        looked_at = dict(looked_at) | {f"outline_{one}": its for one, its in outlines.items()}
    if isinstance(result, (Impact, MomentumSolution)):
        # As they were given, so that it sees which have a unit.
        with callers_options():
            findings = diagnose(result, **looked_at)
    readable = _readable(result) if isinstance(result, Impact) else result
    units = None if cells(None, given_texts(result)).name == system else system
    spread = Spread(result, uncertainty, words)
    return _Part(result, readable, uncertainty, spread, findings, units, own)


def _answers(sheet: Sheet, parts: Sequence[_Part], options: Mapping[str, Any], draws: bool) -> None:
    """An energy gain, and the box that has the answers, with the scene or the momenta beside
    the only one.
    """
    for part in parts:
        if isinstance(part.result, Impact):
            sections.gain(sheet, part.result, part.result.energy_loss)
        elif isinstance(part.result, MomentumSolution):
            sections.gain(sheet, part.result, part.result.translational_energy_loss)
    sheet.open_answer()
    for number, part in enumerate(parts, 1):
        if len(parts) > 1:
            sheet.subheading(_heading(number, part))
        alone, asked = len(parts) == 1, options["answers"]
        answer(sheet, part.result, part.spread, part.uncertainty, part.findings, alone, asked)
    picture = None
    if draws and len(parts) == 1 and isinstance(sheet, Html):
        picture = drawing.beside_answer(sheet, parts[0].readable, options)
    sheet.close_answer(picture)


def _answer_together(
    sheet: Sheet,
    parts: Sequence[_Part],
    together: Together,
    whole: Findings,
    options: Mapping[str, Any],
    draws: bool,
) -> None:
    """An energy gain, and the box that has what was found with the delta-V of each impact, with the
    way of the vehicles and the places that were measured beside it.
    """
    found, run, asked = together.found, together.run, options["answers"]
    hits = [(part, part.own) for part in parts if part.own is not None]
    for part, _ in hits:
        sections.gain(sheet, part.result, part.result.energy_loss)
    sheet.open_answer()
    rows = figures_of(sheet, found, parts[together.part - 1].spread, None, asked)
    if asked is None:
        rows += [
            Figure(name, text, ranged)
            for _, own in hits
            for name, text, ranged in _delta_v(sheet, own)
        ]
    others = [part for part in parts if part.own is None and part.result is not found]
    for part in others:
        rows += figures_of(sheet, part.result, part.spread, part.uncertainty, asked)
    sheet.figures_of_answer([(row.what, row.text) for row in rows])
    sheet.say(rests_on(found, Names(found)))
    if asked is None and any(own.ranges for _, own in hits):
        sheet.say(
            f"The delta-V is that of the scene at each of the {together.samples} samples of what "
            "was found."
        )
    if any(not row.ranged for row in rows):
        sheet.say("No range is stated for the figures above that have only one number.")
    # What the ranges do not have in them stands beside them.
    for part, own in hits:
        if (left := neglected(part.result, of_scene=True)) is not None:
            what, _, _ = left.sentence.partition(";")
            sheet.say(
                plain(
                    f"Impact {own.number + 1} was {what} ({left.assumed} taken for this estimate)."
                )
            )
    lines = list(warned_of(found, asked or found.found, parts[together.part - 1].spread.named))
    judged = [one for part in parts for one in _numbered_findings(part) if not is_note(one)]
    # What a scene does not describe is a note, and limits its answer.
    judged += [one for one in whole if one.impact is None]
    lines += [(f"{label_of(one.code)}:", as_sentence(plain(one.sentence))) for one in judged]
    if lines:
        sheet.items(list(dict.fromkeys(lines)))
    picture = None
    if draws and isinstance(sheet, Html):
        caption = (
            f"From the start to rest, to scale, {together.where}."
            + " Crosses: where the vehicles were measured at rest." * bool(together.measured())
        )
        picture = drawing.drawn(
            sheet, "scene", caption, together.draw, run, units=sheet.system.name
        )
    sheet.close_answer(picture)


def _numbered_findings(part: _Part) -> Iterator[Finding]:
    """The findings of a part; those of an impact of a run with its number and time."""
    for finding in part.findings or ():
        own = part.own
        yield finding if own is None else of_impact(finding, own.together.run, own.number)


def _delta_v(sheet: Sheet, own: _Own) -> Iterator[tuple[str, str, bool]]:
    """The delta-V of both vehicles of an impact, with its range where there are samples."""
    run, number = own.together.run, own.number
    impact = run.impacts[number]
    of = f", impact {number + 1}" if len(run.impacts) > 1 else ""
    for name, side in (("a.delta_v", impact.a), ("b.delta_v", impact.b)):
        if not math.isfinite(side.before.mass):
            continue
        text, ranged = sheet.system.answer(side.delta_v, "speed"), False
        if name in own.ranges:
            text, ranged = ranged_text(sheet.system, own.ranges[name], "speed")
        yield plain(words_of(name, run.pairs[number]) + of), text, ranged


def _ground(sheet: Sheet, together: Together) -> None:
    """What the vehicles move on, where they come to rest, and where the energy went."""
    run = together.run
    vehicles(sheet, run, together.marks())
    sheet.heading("Places of rest")
    sheet.say(f"These, and the energy below, are of the run {together.where}.")
    sheet.table(rests(sheet, run))
    sheet.heading("Where the kinetic energy went")
    sheet.table(ledger(sheet, run))


def _body(
    sheet: Sheet,
    part: _Part,
    options: Mapping[str, Any],
    found: Checked,
    draws: bool,
    alone: bool,
) -> None:
    """Inputs, results, uncertainty, findings and the work of one result."""
    result, uncertainty, spread = part.result, part.uncertainty, part.spread
    sheet.deviations, sheet.ranges = spread.deviations, spread.ranges
    own, outlines, by_input = part.own, found.outlines, found.by_input
    if own is not None:
        its = own.together.outlines_of(own.number)
        outlines = {label: np.array(corners) for label, corners in its.items()}
        options = dict(options) | {f"outline_{label}": one for label, one in its.items()}
        by_input = own.together.notes_of(own.number, by_input)
    if isinstance(result, Impact):
        marks = None if own is None else own.together.marks_of(own.number)
        sections.inputs(sheet, result, options, by_input, spread, marks)
        if own is not None:
            _at_the_samples(sheet, own)
        sections.results(sheet, result, options["share_a"])
    elif isinstance(result, MomentumSolution):
        sections.momentum_inputs_and_results(sheet, result, options, found.by_input)
    elif isinstance(result, Fit):
        fit(sheet, result, found.by_input)
    else:
        posterior(sheet, result, options["answers"], found.by_input, spread.named)
    if uncertainty is not None:
        spread.write(sheet, uncertainty)
        if spread.ranges:
            sheet.say(about_ranges(uncertainty))
    if part.findings is not None:
        sections.findings(sheet, part.findings)
        sections.moves(sheet, part.findings.moves)
    if alone:
        _notes(sheet, found)
    if options["figures"]:
        drawing.figures(sheet, part.readable, spread, uncertainty, options, draws, alone)
    if isinstance(result, Impact):
        sections.assumptions(sheet, result, options, outlines, by_input)
    elif isinstance(result, MomentumSolution):
        sections.momentum_assumptions(sheet, result, options)
    if options["derivation"] and not isinstance(result, Posterior):
        sheet.heading("Derivation")
        known = uncertainty if spread.outputs else None
        sheet.working(explain(part.readable, units=part.units, uncertainty=known))


def _at_the_samples(sheet: Sheet, own: _Own) -> None:
    """What the marks say, and the ranges of an impact that the samples leave."""
    together = own.together
    words = {*together.marks_of(own.number).values()}
    told = {
        together.middle: "is what was found there, and not given",
        "from the run": "is the state with which the run of these numbers comes to this impact",
    }
    says = [f"“{word}” {what}" for word, what in told.items() if word in words]
    if says:
        text = "; ".join(says)
        sheet.say(f"{text[0]}{text[1].upper()}{text[2:]}.")
    if any(map(varies, own.ranges.values())):
        pair = together.run.pairs[own.number]
        sheet.heading("What the evidence leaves of it")
        named = {
            plain(words_of(name, pair)): output
            for name, output in own.ranges.items()
            if varies(output)
        }
        sheet.columns(outputs_part(named, cells(sheet.system.name)))
        sheet.say(
            f"From the {together.samples} samples of part {together.part}, each run through "
            f"the scene. The results below are those {together.where}."
        )


def _notes(sheet: Sheet, found: Checked) -> None:
    if found.paragraphs:
        sheet.heading("Notes")
        for paragraph in found.paragraphs:
            sheet.say(paragraph)


def _heading(number: int, part: _Part) -> str:
    title = _title(part.result)
    if part.own is not None and len(part.own.together.run.impacts) > 1:
        at = part.own.number
        lead, _, of = title.partition(" ")
        title = f"{lead} {at + 1} {of}, at {part.own.together.run.times[at]:.2f} s"
    return f"{number}. {plain(title)}"


def _title(impact: Result) -> str:
    if isinstance(impact, Impact):
        return f"Impact of {who(0, impact.a.before)} and {who(1, impact.b.before)}"
    titles = {
        Fit: "Fit to evidence",
        Posterior: "What the evidence says",
        MomentumSolution: "Planar momentum of A and B",
    }
    return titles[type(impact)]


def _readable(impact: Impact) -> Impact:
    """The same impact with vehicle names that a file can hold: lone surrogates are replaced."""
    vehicles = impact.inputs.a, impact.inputs.b
    if not any(_SURROGATE.search(vehicle.name) for vehicle in vehicles):
        return impact
    a, b = (vehicle.replace(name=plain(vehicle.name)) for vehicle in vehicles)
    return with_vehicles(impact, a, b)
