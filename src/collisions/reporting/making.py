"""``report``: the whole page of one result with its figures, from the first heading to
the record.
"""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from html import escape
from importlib import import_module
from inspect import signature
from typing import Any, Literal, TypeAlias, get_args

from .. import plot
from ..derivation.evidence import fit, momentum_inputs
from ..derivation.explain import NOT_EXPLAINED, about_ranges, explain, impact_inputs, no_uncertainty
from ..diagnostics import diagnose
from ..impact.impact import Impact, with_vehicles
from ..kernels.elementwise import UNIT_INTERVAL
from ..messages.errors import InputError
from ..plot.canvas import in_lines, who
from ..quantities.document import Document
from ..quantities.formatting import UnitSystem
from ..quantities.reading import ArgumentReader, need_one_case, single_number
from ..quantities.settings import callers_options, computing
from ..quantities.tables import cells
from ..quantities.units import Input, Pair, kinds_in_degrees, shown
from ..reconstruct import Fit, MomentumSolution, Posterior
from ..uncertainty import Propagation
from ..uncertainty.result import Sampled, varies
from ..vehicle.drag import USUAL_DURATION
from ..vehicle.outlines import read_outline
from . import sections
from .answer import answer
from .record import plain_options, record
from .render import Html, Markdown, Printed, plain, visible
from .sections import EVIDENCE
from .uncertainty import Spread, shares_of

Form: TypeAlias = Literal["html", "markdown"]
_SURROGATE = re.compile("[\ud800-\udfff]")
# Options that do not apply to these results.
_OTHER_PARTS: dict[type, tuple[str, ...]] = {
    MomentumSolution: ("outline_a", "outline_b", "share_a"),
    Fit: ("outline_a", "outline_b", "share_a", "duration", "drag", "limits", *EVIDENCE),
}
_OTHER_PARTS[Posterior] = (*_OTHER_PARTS[Fit], "derivation")
# All of one width, so that their letters are of one size.
_SIZES = {
    "scene": (6.5, 5.6),
    "momentum": (6.5, 6.2),
    "impulse-plane": (6.5, 5.6),
    "energy": (6.5, 4.2),
    "pulse": (6.5, 6.5),
}
_SIZE = (6.5, 4.6)
# What a page is filed under.
_FILED = ("case", "author", "date")
# Nothing in a file may depend on chance or on whoever runs it; its letters stay letters, and names
# are no formulas.
_SETTINGS: Any = {"svg.hashsalt": "collisions", "svg.fonttype": "none", "text.parse_math": False}
_UNDATED = dict.fromkeys(("Creator", "Date", "Format", "Type"))
_TAG = re.compile(r"<[^<>]*>")
_ID = re.compile(r'(\bid="|url\(#|href="#)([^")]*)')


@computing
def report(
    impact: Impact | MomentumSolution | Fit | Posterior,
    *,
    title: str | None = None,
    form: Form = "html",
    units: UnitSystem | None = None,
    uncertainty: Propagation | None = None,
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
    figures: bool = True,
    derivation: bool = False,
    author: str | None = None,
    case: str | None = None,
    date: str | None = None,
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
    impact : Impact, MomentumSolution, Fit or Posterior
        One case that was answered, of any forward or reverse solver.
    title : str, optional
        By default the names of the vehicles.
    form : {"html", "markdown"}
        One self-contained HTML file, to be read in a browser or printed; or Markdown, without
        figures.
    units : {"si", "metric", "us"}, optional
        By default those of the inputs, as for ``summary``.
    uncertainty : Propagation, optional
        From ``uncertainty.propagate``. An output with the name of an answer, such as "b.after.vx"
        or "b_after_vx", also sets the rounding of that answer.
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
        "outline_a" and "outline_b", may have notes too.
    figures : bool
        Whether to draw figures. They need matplotlib; without it the report says so and goes on.
    derivation : bool
        Whether to append the derivation of ``explain``.
    author, case, date : str, optional
        Who made the page, the number or name of the case, and the day: printed below the title,
        and at the foot of every page in print.

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

    need_one_case(
        impact, (Impact, MomentumSolution, Fit, Posterior), "report", instead=NOT_EXPLAINED
    )
    system: Any = cells(units, impact._texts()).name
    given["units"] = system
    options = plain_options(given)
    paragraphs, by_input, outlines = _checked(impact, options, uncertainty)
    looked_at = {
        name: given[name]
        for name in ("outline_a", "outline_b", "duration", "drag", "limits", "units", *EVIDENCE)
    }
    spread = Spread(impact, uncertainty)
    sheet = (Html if form == "html" else Markdown)(
        _printed(impact, system), spread.deviations, spread.ranges
    )
    sheet.title(plain(title or _title(impact)))
    filed = [(name, plain(options[name])) for name in _FILED if options[name] is not None]
    if filed:
        sheet.file([(name.capitalize(), text) for name, text in filed])
    # As they were given, so that it sees which have a unit.
    with callers_options():
        findings = None if isinstance(impact, (Fit, Posterior)) else diagnose(impact, **looked_at)
    readable = _readable(impact) if isinstance(impact, Impact) else impact
    draws = figures and isinstance(sheet, Html) and _can_draw()
    _first(sheet, impact, readable, spread, uncertainty, findings, options, draws)
    if isinstance(impact, Impact):
        sections.inputs(sheet, impact, options, by_input)
        sections.results(sheet, impact, options["share_a"])
    elif isinstance(impact, MomentumSolution):
        sections.momentum_inputs_and_results(sheet, impact, options, by_input)
    elif isinstance(impact, Fit):
        fit(sheet, impact)
    else:
        sections.posterior(sheet, impact)
    if uncertainty is not None:
        spread.write(sheet, uncertainty)
        if spread.ranges:
            sheet.say(about_ranges(uncertainty))
    if findings is not None:
        sections.findings(sheet, findings)
    if paragraphs:
        sheet.heading("Notes")
        for paragraph in paragraphs:
            sheet.say(paragraph)
    if figures:
        _figures(sheet, readable, spread, uncertainty, options, draws)
    if isinstance(impact, Impact):
        sections.assumptions(sheet, impact, options, outlines, by_input)
    elif isinstance(impact, MomentumSolution):
        sections.momentum_assumptions(sheet, impact)
    if derivation and not isinstance(readable, Posterior):
        sheet.heading("Derivation")
        known = uncertainty if spread.outputs else None
        # Without a system named, what was given in degrees stays so.
        own = None if cells(None, impact._texts()).name == system else system
        sheet.working(explain(readable, units=own, form="markdown", uncertainty=known))
    if findings is not None and isinstance(impact, (Impact, MomentumSolution)):
        sections.sources(sheet, impact, findings)
    sheet.say(f"Calculated with collisions {__version__}.")
    sheet.heading("Record")
    unusual = {name: value for name, value in options.items() if not _is_usual(name, value)}
    sheet.record(record(impact, unusual, uncertainty))
    return Document(sheet.whole(__version__), form)


def _printed(impact: Any, system: str) -> Printed:
    """How the page writes its numbers: angles in degrees wherever an input was given so."""
    texts = [text for text in impact._texts() if isinstance(text, str)]
    return Printed(system, kinds_in_degrees(texts))


def _first(
    sheet: Html | Markdown,
    impact: Any,
    readable: Any,
    spread: Spread,
    uncertainty: Propagation | None,
    findings: Any,
    options: Mapping[str, Any],
    draws: bool,
) -> None:
    """An energy gain, and the box that has the answer, with the scene or the momenta beside it."""
    if isinstance(impact, Impact):
        sections.gain(sheet, impact, impact.energy_loss)
    elif isinstance(impact, MomentumSolution):
        sections.gain(sheet, impact, impact.translational_energy_loss)
    sheet.open_answer()
    answer(sheet, impact, spread, uncertainty, findings)
    picture = None
    if draws and isinstance(sheet, Html):
        if isinstance(impact, Impact):
            outlines = {name: options[name] for name in ("outline_a", "outline_b")}
            caption = "The scene from above at the moment of impact, to scale."
            more = {"units": options["units"], **outlines}
            picture = _drawn(sheet, "scene", caption, plot.scene, readable, **more)
        elif isinstance(impact, MomentumSolution):
            caption = "Momentum before and after, head to tail."
            more = {"units": options["units"]}
            picture = _drawn(sheet, "momentum", caption, plot.momentum, readable, **more)
    sheet.close_answer(picture)


_USUAL = plain_options(
    {name: parameter.default for name, parameter in signature(report).parameters.items()}
)


def _is_usual(name: str, value: Any) -> bool:
    """Whether an option has its default value; one that cannot be compared, such as an array,
    counts as not.
    """
    return type(value) is type(_USUAL[name]) and bool(value == _USUAL[name])


def _checked(
    impact: Any, options: Mapping[str, Any], uncertainty: Any
) -> tuple[list[str], dict[str, str], dict[str, Any]]:
    """The notes, as paragraphs and by input, and the outlines by vehicle; one error names every
    option that cannot be used.
    """
    reader = ArgumentReader()

    def refuse(argument: str, text: str, code: str = "bad_option") -> None:
        reader.refuse(InputError(text, code=code, argument=argument))

    form, notes, share_a = (options[name] for name in ("form", "notes", "share_a"))
    if not isinstance(form, str) or form not in get_args(Form):
        refuse(
            "form", f"form must be one of {', '.join(map(repr, get_args(Form)))}, got {shown(form)}"
        )
    parts = (
        notes
        if isinstance(notes, (list, tuple))
        else [notes]
        if isinstance(notes, (str, Mapping))
        else []
    )
    paragraphs = [part for part in parts if not isinstance(part, Mapping)]
    beside = {
        name: text for part in parts if isinstance(part, Mapping) for name, text in part.items()
    }
    # For an impulse, duration and drag are not inputs but options of the page, as the outlines are.
    own = ["duration", "drag"] if isinstance(impact, Impact) and impact.pulse is None else []
    own += (name for name in ("outline_a", "outline_b") if options[name] is not None)
    known = list(dict.fromkeys([*inputs_of(impact), *own]))
    for name in [name for name in beside if name not in known]:
        refuse(
            "notes",
            f"notes has {shown(name)}, which is no input of this page; they are {', '.join(known)}",
        )
    texts = [(name, options[name]) for name in ("title", *_FILED) if options[name] is not None]
    for name, text in [*texts, *(("notes", text) for text in (*paragraphs, *beside.values()))]:
        if not isinstance(text, str) or not plain(text):
            refuse(
                name, f"{name} must be a text that says something, got {shown(text)}", "not_a_text"
            )
    if notes is not None and not isinstance(notes, (str, list, tuple, Mapping)):
        refuse(
            "notes",
            "notes must be a text, a list of texts, or a dict of them by input, got "
            f"{type(notes).__name__}",
            "not_a_text",
        )
    for name in ("figures", "derivation"):
        if not isinstance(options[name], bool):
            refuse(name, f"{name} must be True or False, got {shown(options[name])}")
    if uncertainty is not None and not isinstance(uncertainty, Propagation):
        refuse(
            "uncertainty",
            "uncertainty must be what uncertainty.propagate returned, got "
            f"{type(uncertainty).__name__}; standard deviations by name go to explain(impact, "
            "uncertainty=...)",
        )
    kind = type(impact)
    for name in _OTHER_PARTS.get(kind, ()):
        if not _is_usual(name, options[name]):
            refuse(
                name,
                f"{name} is for an Impact, and a {kind.__name__} has no part for it; leave it "
                "out, or report the impact itself",
            )
    if kind in (Fit, Posterior) and isinstance(uncertainty, Propagation):
        reader.refuse(no_uncertainty(kind.__name__))
    outlines = {
        label: read_outline(reader, options[f"outline_{label}"], f"outline_{label}")
        for label in "ab"
        if options[f"outline_{label}"] is not None
    }
    if share_a is not None:
        share = reader.number(share_a, "", "share_a", UNIT_INTERVAL)
        single_number(reader, share, "share_a", "takes one value: a report is of one case")
    reader.close()
    return (
        [plain(paragraph) for paragraph in paragraphs],
        {name: plain(text) for name, text in beside.items()},
        outlines,
    )


def inputs_of(impact: Impact | MomentumSolution | Fit | Posterior) -> list[str]:
    """The inputs that a note can stand beside, by name."""
    if isinstance(impact, Impact):
        found = [sections.key_of(of, names) for of, _, names, _, _ in impact_inputs(impact)]
        for label, vehicle in (("a", impact.a.before), ("b", impact.b.before)):
            found += [f"{label}.{name}" for name, _ in sections.speed_rows(vehicle)]
        found += (
            []
            if impact.law is None or impact.model in ("linear_central", "time_resolved")
            else ["law"]
        )
        return [*found, *(impact.inputs.given or {}).keys() - set(found)]
    rows = momentum_inputs(impact) if isinstance(impact, MomentumSolution) else ()
    return [name.partition("[")[0] for _, _, name, _, _ in rows]


def _title(impact: Impact | MomentumSolution | Fit | Posterior) -> str:
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


def _can_draw() -> bool:
    try:
        import_module("matplotlib.figure")
    except ImportError:
        return False
    return True


def _figures(
    sheet: Html | Markdown,
    impact: Any,
    spread: Spread,
    uncertainty: Propagation | None,
    options: Mapping[str, Any],
    draws: bool,
) -> None:
    """The figures of the impact and of its uncertainty, or a sentence where there can be none."""
    if isinstance(impact, Fit) or (isinstance(impact, MomentumSolution) and uncertainty is None):
        return
    sheet.heading("Figures")
    if not isinstance(sheet, Html):
        sheet.say("The figures are in the HTML form of this report.")
        return
    if not draws:
        sheet.say(
            "None: matplotlib cannot be imported here. Install it with: python -m pip install "
            "matplotlib"
        )
        return
    before = len(sheet.blocks)
    if isinstance(impact, Impact):
        _of_impact(sheet, impact, options["units"])
    if isinstance(impact, Posterior):
        caption = "Each observation less its computed value, in stated errors."
        _draw(sheet, "residuals", caption, plot.residuals, impact)
    _of_outputs(sheet, impact, spread, uncertainty, options["units"])
    pictures = sheet.blocks[before:]
    if pictures:
        sheet.blocks[before:] = ['<div class="figures">', *pictures, "</div>"]
    else:
        sheet.say("None: the variance is all of one input, and no cases were drawn.")


def _of_impact(sheet: Html, impact: Impact, units: Any) -> None:
    if impact.model != "linear_central":
        caption = "Momentum before and after, head to tail."
        _draw(sheet, "momentum", caption, plot.momentum, impact, units=units)
        if impact.pulse is not None:
            caption = "Force, crush and delta-V over the time of the contact."
            _draw(sheet, "pulse", caption, plot.pulse, impact, units=units)
        else:
            caption = "Normal and tangential impulse, with the lines that decide them."
            _draw(sheet, "impulse-plane", caption, plot.impulse_plane, impact, units=units)
    _draw(sheet, "energy", "Where the kinetic energy went.", plot.energy, impact, units=units)


def _of_outputs(
    sheet: Html, impact: Any, spread: Spread, uncertainty: Propagation | None, units: Any
) -> None:
    """What was drawn of each output, and the share of its variance that each input brings."""
    of_posterior = isinstance(impact, Posterior)
    outputs = {} if uncertainty is None else uncertainty.outputs
    for number, output in enumerate((impact.unknowns if of_posterior else outputs).values(), 1):
        name = spread.heading(output)
        if not varies(output):
            sheet.say(f"{name} has no figures, because it is the same in every case.")
            continue
        drawn: dict[str, Any] = {"units": units, "words": {output.name: name}}
        if isinstance(output, Sampled):
            caption = f"{name}, in the cases drawn, given {output.given}."
            _draw(sheet, f"distribution-{number}", caption, plot.distribution, output, **drawn)
        if not of_posterior and len(shares_of(output)) != 1:
            caption = (
                f"{name}, and the share of its variance that each input brings, by itself and in "
                "all."
            )
            drawn["inputs"] = spread.words_of(uncertainty)
            _draw(sheet, f"contributions-{number}", caption, plot.contributions, output, **drawn)


def _draw(
    sheet: Html,
    name: str,
    caption: str,
    draw: Callable[..., Any],
    result: Any,
    words: Mapping[str, str] | None = None,
    inputs: Mapping[str, str] | None = None,
    **options: Any,
) -> None:
    """Write one figure, or a sentence if the numbers allow none."""
    picture = _drawn(sheet, name, caption, draw, result, words, inputs, **options)
    if picture is not None:
        sheet.picture(*picture)


def _drawn(
    sheet: Html,
    name: str,
    caption: str,
    draw: Callable[..., Any],
    result: Any,
    words: Mapping[str, str] | None = None,
    inputs: Mapping[str, str] | None = None,
    **options: Any,
) -> tuple[str, str] | None:
    """Caption and SVG of one figure, drawn with default matplotlib settings, with words for its
    name and for those of the inputs; None after a sentence if the numbers allow none.
    """
    from matplotlib import rc_context, rcdefaults, rcParams
    from matplotlib.figure import Figure
    from matplotlib.text import Text

    with rc_context(), warnings.catch_warnings():
        rcdefaults()
        rcParams.update(_SETTINGS)
        # A name may have letters that this font lacks, but that the reader's font has.
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")
        figure = Figure(figsize=_SIZES.get(name, _SIZE), layout="constrained")
        try:
            draw(result, axes=figure.add_subplot(), **options)
        except InputError as error:
            sheet.say(f"{caption} Not drawn: {error}.")
            return None
        for text in figure.findobj(Text):
            found = text.get_text()
            if inputs and found in inputs:
                found = in_lines(inputs[found])
            for own, said in (words or {}).items():
                found = found.replace(own, said)
            text.set_text(visible(found))
        target = io.StringIO()
        figure.savefig(
            target, format="svg", metadata=_UNDATED, bbox_inches="tight", pad_inches=0.05
        )
    return caption, _standalone(target.getvalue(), name, caption)


def _standalone(svg: str, name: str, caption: str) -> str:
    """The svg element of a figure, its ids made unique on the page and its style left
    to the page.
    """
    svg = visible(svg[svg.index("<svg") :].rstrip())
    svg = re.sub(r"\n\s*<defs>\s*<style[^>]*>[^<]*</style>\s*</defs>", "", svg, count=1)

    def with_name(tag: re.Match[str]) -> str:
        return _ID.sub(lambda found: f"{found[1]}{name}.{found[2].replace(' ', '-')}", tag[0])

    label = f'<svg role="img" aria-label="{escape(caption)}"'
    return _TAG.sub(with_name, svg).replace("<svg", label, 1)
