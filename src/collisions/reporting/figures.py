"""The figures of a report, each an SVG that stands on the page by itself."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Callable, Mapping
from copy import copy
from html import escape
from importlib import import_module
from typing import Any

from .. import plot
from ..impact.impact import Impact
from ..messages.errors import InputError
from ..plot.canvas import in_lines
from ..quantities.formatting import SI_UNITS
from ..quantities.user_text import visible
from ..reconstruct import Fit, MomentumSolution, Posterior
from ..uncertainty import Propagation
from ..uncertainty.output import varies
from ..uncertainty.sampled import Sampled
from .posterior_part import answers_of
from .render import Html, Markdown
from .uncertainty import Spread, shares_of

# All of one width, so that their letters are of one size: of which two stand beside each other on a
# printed page, with letters that can be read there.
_SIZES = {
    "scene": (5.2, 4.6),
    "momentum": (5.2, 5.0),
    "impulse-plane": (5.2, 5.0),
    "energy": (5.2, 3.7),
    "pulse": (5.2, 5.4),
}
_SIZE = (5.2, 3.8)
_HEAD_TO_TAIL = "Momentum before and after, head to tail."
# Nothing in a file may depend on chance or on whoever runs it; its letters stay letters, and names
# are no formulas.
_SETTINGS: Any = {"svg.hashsalt": "collisions", "svg.fonttype": "none", "text.parse_math": False}
_UNDATED = dict.fromkeys(("Creator", "Date", "Format", "Type"))
_WORDS = re.compile(r"[a-z]{2,}(?= )")
_TAG = re.compile(r"<[^<>]*>")
_ID = re.compile(r'(\bid="|url\(#|href="#)([^")]*)')


def can_draw() -> bool:
    """Whether matplotlib is there."""
    try:
        import_module("matplotlib.figure")
    except ImportError:
        return False
    return True


def figures(
    sheet: Html | Markdown,
    impact: Any,
    spread: Spread,
    uncertainty: Propagation | None,
    options: Mapping[str, Any],
    draws: bool,
    alone: bool,
) -> None:
    """The figures of the impact and of its uncertainty, or a sentence where there can be none.

    The first one of a result that stands alone is beside the answer.
    """
    without = isinstance(impact, MomentumSolution) and uncertainty is None and alone
    if isinstance(impact, Fit) or without:
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
    first = None if alone else beside_answer(sheet, impact, options)
    if first is not None:
        sheet.picture(*first)
    if isinstance(impact, Impact):
        _of_impact(sheet, impact, options["units"])
    if isinstance(impact, Posterior):
        caption = "Each observation less its computed value, in stated errors."
        _draw(sheet, "residuals", caption, plot.residuals, impact)
    _in_rows(sheet, before)
    units = options["units"]
    if isinstance(impact, Posterior):
        asked = answers_of(impact, options["answers"])
        rest = [name for name in (*impact.results, *impact.unknowns) if name not in asked]
        _of_outputs(sheet, impact, spread, None, {name: impact[name] for name in asked}, units)
        if rest:
            sheet.fold("How the rest of what was found is distributed:")
            others = {name: impact[name] for name in rest}
            _of_outputs(sheet, impact, spread, None, others, units, len(asked))
            sheet.unfold()
    elif uncertainty is not None:
        _of_outputs(sheet, impact, spread, uncertainty, uncertainty.outputs, units)
    if len(sheet.blocks) == before:
        sheet.say("None: the variance is all of one input, and no cases were drawn.")


def _in_rows(sheet: Html, start: int) -> None:
    """Set the blocks from there on side by side."""
    if sheet.blocks[start:]:
        sheet.blocks[start:] = ['<div class="figures">', *sheet.blocks[start:], "</div>"]


def beside_answer(sheet: Html, impact: Any, options: Mapping[str, Any]) -> tuple[str, str] | None:
    """The scene of an impact, or the momenta of planar momentum."""
    more = {"units": options["units"]}
    if isinstance(impact, Impact):
        more |= {name: options[name] for name in ("outline_a", "outline_b")}
        caption = "The scene from above at the moment of impact, to scale."
        return drawn(sheet, "scene", caption, plot.scene, impact, **more)
    if isinstance(impact, MomentumSolution):
        return drawn(sheet, "momentum", _HEAD_TO_TAIL, plot.momentum, impact, **more)
    return None


def _of_impact(sheet: Html, impact: Impact, units: Any) -> None:
    if impact.model != "linear_central":
        _draw(sheet, "momentum", _HEAD_TO_TAIL, plot.momentum, impact, units=units)
        if impact.pulse is not None:
            caption = "Force, crush and delta-V over the time of the contact."
            _draw(sheet, "pulse", caption, plot.pulse, impact, units=units)
        else:
            caption = "Normal and tangential impulse, with the lines that decide them."
            _draw(sheet, "impulse-plane", caption, plot.impulse_plane, impact, units=units)
    _draw(sheet, "energy", "Where the kinetic energy went.", plot.energy, impact, units=units)


def _of_outputs(
    sheet: Html,
    impact: Any,
    spread: Spread,
    uncertainty: Propagation | None,
    outputs: Mapping[str, Any],
    units: Any,
    before: int = 0,
) -> None:
    """What was drawn of each output, and the share of its variance that each input brings, side by
    side and apart from other figures; ``before`` is how many outputs had theirs.
    """
    of_posterior = isinstance(impact, Posterior)
    start = len(sheet.blocks)
    for number, output in enumerate(outputs.values(), before + 1):
        name = spread.heading(output)
        if not varies(output):
            sheet.say(f"{name} has no figures, because it is the same in every case.")
            continue
        options: dict[str, Any] = {"units": units, "words": {output.name: name}}
        drawn_of = _with_unit(output, spread.kind_of(output))
        if isinstance(output, Sampled):
            caption = f"{_begun(name)}, in the cases drawn, given {output._given()}."
            _draw(sheet, f"distribution-{number}", caption, plot.distribution, drawn_of, **options)
        if not of_posterior and len(shares_of(output)) != 1:
            caption = (
                f"{_begun(name)}, and the share of its variance that each input brings, by itself "
                "and in all."
            )
            options["inputs"] = spread.words_of(uncertainty)
            _draw(
                sheet, f"contributions-{number}", caption, plot.contributions, drawn_of, **options
            )
    _in_rows(sheet, start)


def _begun(name: str) -> str:
    """A name as it begins a sentence: with a capital if it is words, and not a symbol or a path."""
    return name[:1].upper() + name[1:] if _WORDS.match(name) else name


def _with_unit(output: Any, kind: str | None) -> Any:
    """An output that is a result of the report with its SI unit, where the model returned bare
    numbers.
    """
    if output.unit or kind is None or not SI_UNITS[kind]:
        return output
    same = copy(output)
    same.unit = SI_UNITS[kind]
    return same


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
    picture = drawn(sheet, name, caption, draw, result, words, inputs, **options)
    if picture is not None:
        sheet.picture(*picture)


def drawn(
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
        if inputs:
            (axes,) = figure.axes
            names = [label.get_text() for label in axes.get_yticklabels()]
            axes.set_yticklabels([in_lines(inputs.get(name, name)) for name in names])
        for text in figure.findobj(Text):
            found = text.get_text()
            for own, said in (words or {}).items():
                found = found.replace(own, said)
            text.set_text(visible(found))
        target = io.StringIO()
        figure.savefig(
            target, format="svg", metadata=_UNDATED, bbox_inches="tight", pad_inches=0.05
        )
    return caption, _standalone(target.getvalue(), sheet.prefix + name, caption)


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
