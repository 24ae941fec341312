"""report: the whole page of one answer."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from inspect import signature
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from ..contact_effects import left_out
from ..derivation.evidence import fit
from ..derivation.explain import NOT_EXPLAINED, explain, no_uncertainty
from ..derivation.expressions import System
from ..derivation.page import Page
from ..diagnostics import diagnose
from ..errors import InputError, ShapeError
from ..formatting import UnitSystem, bad_system
from ..impact import Impact
from ..kernels.elementwise import UNIT_INTERVAL
from ..outlines import read_outline
from ..plot.canvas import who
from ..reading import ArgumentReader, need_one_case
from ..reconstruct import Fit, MomentumSolution
from ..uncertainty import Propagation
from ..units import Input, shown
from . import sections
from .blocks import Heading, Paragraph, Record, Sheet, Working, plain
from .figures import figures as pictures
from .known import Known
from .markdown import markdown
from .options import EVIDENCE, kept, plain_options
from .record import record
from .render import html

Form: TypeAlias = Literal["html", "markdown"]
_FORMS = get_args(Form)
_SURROGATE = re.compile("[\ud800-\udfff]")


def report(
    impact: Impact | MomentumSolution | Fit,
    *,
    title: str | None = None,
    form: Form = "html",
    units: UnitSystem = "si",
    uncertainty: Propagation | None = None,
    outline_a: Any = None,
    outline_b: Any = None,
    duration: Input = 0.1,
    drag: Input = 0.7,
    limits: Mapping[str, Any] | None = None,
    crush_energy: Input | None = None,
    damage_pdof_a: Input | None = None,
    damage_pdof_b: Input | None = None,
    damage_delta_v_a: Input | None = None,
    damage_delta_v_b: Input | None = None,
    share_a: Input | None = None,
    notes: str | Sequence[str] | None = None,
    figures: bool = True,
    derivation: bool = False,
) -> str:
    """One page about an answer: inputs, assumptions, results, uncertainty, findings, figures, sources and the record.

    An energy gain stands first. Every number comes from the result, from ``diagnose``, ``left_out`` or the propagation, by the
    rounding of ``explain``. The same arguments give the same page, byte for byte, one fact a line, without a date; from the
    record at its end ``reporting.replay`` gives the impact again and ``reporting.options`` the options, and ``report`` of both
    the same page.

    A ``MomentumSolution`` knows neither contact nor places, and a ``Fit`` only unknowns and what was observed: their pages have
    the parts that they have, and options of other parts are refused. The record of a ``Fit`` has its numbers, but no impact
    comes back from it, because its model is code.

    Parameters
    ----------
    impact : Impact, MomentumSolution or Fit
        One case that was answered, of any forward or reverse solver.
    title : str, optional
        By default the names of the vehicles.
    form : {"html", "markdown"}
        One HTML file that asks for nothing from outside, to be read in a browser or printed; or Markdown, without figures.
    units : {"si", "metric", "us"}
        As for ``explain``.
    uncertainty : Propagation, optional
        Of ``uncertainty.propagate``. Outputs with the name of an answer, such as "b.after.vx" or "b_after_vx", also round it.
    outline_a, outline_b, duration, drag, limits
        As for ``diagnose``; the first two are also drawn.
    crush_energy, damage_pdof_a, damage_pdof_b, damage_delta_v_a, damage_delta_v_b
        What the damage shows, as for ``diagnose``; printed among the inputs.
    share_a : float, str or Quantity, optional
        A's share of the energy absorbed, 0 to 1, for ``Impact.ees``; without it no EES is given.
    notes : str or sequence of str, optional
        Your own words, each in a paragraph of its own.
    figures : bool
        Whether to draw. They need matplotlib; where it is missing the report says so and goes on.
    derivation : bool
        Whether to append what ``explain`` says, in HTML as plain text.

    Returns
    -------
    str
        The page.

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
    >>> page = report(col.linear_central(a, col.Vehicle(mass=950), 0.4), form="markdown", units="us")
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

    need_one_case(impact, (Impact, MomentumSolution, Fit), "report", instead=NOT_EXPLAINED)
    readable = _readable(impact) if isinstance(impact, Impact) else impact
    options = plain_options(given)
    duration, drag, limits, share_a = (options[name] for name in ("duration", "drag", "limits", "share_a"))
    reader = ArgumentReader()
    _option(reader, "form", form, _FORMS)
    problem = bad_system(units)
    if problem is not None:
        reader.refuse(problem)
    heading = "" if title is None else _text(reader, "title", title)
    words = [_text(reader, "notes", note) for note in ([notes] if isinstance(notes, str) else _listed(reader, notes))]
    for name, value in (("figures", figures), ("derivation", derivation)):
        if not isinstance(value, bool):
            reader.refuse(InputError(f"{name} must be True or False, got {shown(value)}", code="bad_option", argument=name))
    if uncertainty is not None and not isinstance(uncertainty, Propagation):
        reader.refuse(
            InputError(
                f"uncertainty must be what uncertainty.propagate returned, got {type(uncertainty).__name__}; standard "
                f"deviations by name go to explain(impact, uncertainty=...)",
                code="bad_option",
                argument="uncertainty",
            )
        )
    _refuse_other_parts(reader, impact, options)
    outlines = {
        label: read_outline(reader, options[f"outline_{label}"], f"outline_{label}")
        for label in "ab"
        if options[f"outline_{label}"] is not None
    }
    if share_a is not None and isinstance(reader.number(share_a, "", "share_a", UNIT_INTERVAL), np.ndarray):
        reader.refuse(ShapeError("share_a takes one value: a report is of one case", code="bad_shape", argument="share_a"))
    reader.close()
    evidence = {name: options[name] for name in EVIDENCE}
    looked_at = {name: options[name] for name in ("outline_a", "outline_b", "duration", "drag", "limits", "units")}
    known = Known(impact, uncertainty)
    sheet = Sheet(Page(System(units), False, known.deviations, known.ranges))
    sheet.title(heading or _title(impact))
    findings = None if isinstance(impact, Fit) else diagnose(impact, **looked_at, **evidence)
    if isinstance(impact, Impact):
        sections.gain(sheet, impact, impact.energy_loss)
        sections.inputs(sheet, impact, evidence)
        sections.assumptions(sheet, impact, left_out(impact, duration=duration, drag=drag), outlines, limits)
        sections.results(sheet, impact, share_a)
    elif isinstance(impact, MomentumSolution):
        sections.gain(sheet, impact, impact.translational_energy_loss)
        sections.momentum(sheet, impact, evidence)
    else:
        fit(sheet, impact)
    if uncertainty is not None:
        known.tell(sheet, uncertainty)
    if findings is not None:
        sections.findings(sheet, findings)
    if words:
        sheet.heading("Notes")
        for note in words:
            sheet.say(note)
    if figures and (isinstance(impact, Impact) or uncertainty is not None):
        sheet.heading("Figures")
        sheet.blocks += (
            pictures(readable, uncertainty, options["outline_a"], options["outline_b"], units)
            if form == "html"
            else [Paragraph("The figures are in the HTML form of this report.")]
        )
    if derivation:
        sheet.heading("Derivation")
        spread = uncertainty if known.ranges else known.deviations
        text = explain(readable, units=units, form="text" if form == "html" else form, uncertainty=spread or None)
        sheet.blocks.append(Working(text if form == "html" else text.replace("\n## ", "\n### ").partition("\n")[2].lstrip()))
    if findings is not None:
        sections.sources(sheet, findings)
    sheet.say(f"Worked out by collisions {__version__}.")
    sheet.blocks += [Heading("Record"), Record(record(impact, __version__, kept(options, _USUAL), uncertainty))]
    return html(sheet.blocks, __version__) if form == "html" else markdown(sheet.blocks)


_USUAL = {name: parameter.default for name, parameter in signature(report).parameters.items()}


# What no page of these answers has a part for.
_OTHER_PARTS: dict[type, tuple[str, ...]] = {
    MomentumSolution: ("outline_a", "outline_b", "share_a"),
    Fit: ("outline_a", "outline_b", "share_a", "duration", "drag", "limits", *EVIDENCE),
}


def _refuse_other_parts(reader: ArgumentReader, impact: Any, options: Mapping[str, Any]) -> None:
    kind = type(impact)
    for name in _OTHER_PARTS.get(kind, ()):
        if options[name] != _USUAL[name]:
            told = (
                f"{name} is for an Impact, and a {kind.__name__} has no part for it; leave it out, or report the impact itself"
            )
            reader.refuse(InputError(told, code="bad_option", argument=name))
    if kind is Fit and isinstance(options["uncertainty"], Propagation):
        reader.refuse(no_uncertainty())


def _title(impact: Impact | MomentumSolution | Fit) -> str:
    if isinstance(impact, Impact):
        return plain(f"Impact of {who(0, impact.a.before)} and {who(1, impact.b.before)}")
    return "Fit to evidence" if isinstance(impact, Fit) else "Planar momentum of A and B"


def _readable(impact: Impact) -> Impact:
    """The same impact with names that a file can hold, where one has half a letter."""
    if not any(map(_SURROGATE.search, (impact.a.before.name, impact.b.before.name))):
        return impact
    a, b = (vehicle._told(None) for vehicle in (impact.inputs.a, impact.inputs.b))
    for vehicle in (a, b):
        vehicle.__setstate__({"name": plain(vehicle.name)})
    named = impact._with(a, b)
    return named


def _option(reader: ArgumentReader, argument: str, value: Any, allowed: tuple[str, ...]) -> None:
    if not isinstance(value, str) or value not in allowed:
        reader.refuse(
            InputError(
                f"{argument} must be one of {', '.join(map(repr, allowed))}, got {shown(value)}",
                code="bad_option",
                argument=argument,
            )
        )


def _listed(reader: ArgumentReader, notes: Any) -> Sequence[Any]:
    if notes is None:
        return []
    if not isinstance(notes, (list, tuple)):
        reader.refuse(
            InputError(
                f"notes must be a text, or a list of texts, got {type(notes).__name__}", code="not_a_text", argument="notes"
            )
        )
        return []
    return notes


def _text(reader: ArgumentReader, argument: str, text: Any) -> str:
    if not isinstance(text, str) or not plain(text):
        reader.refuse(
            InputError(
                f"{argument} must be a text that says something, got {shown(text)}", code="not_a_text", argument=argument
            )
        )
        return ""
    return plain(text)
