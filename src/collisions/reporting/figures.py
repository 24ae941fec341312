"""The figures of a report, as SVG that is the same for the same impact and can stand within a page."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from html import escape
from importlib import import_module
from typing import Any

from .. import plot
from ..errors import InputError
from ..formatting import UnitSystem
from ..impact import Impact
from ..uncertainty import Propagation
from ..uncertainty.result import Sampled
from .blocks import Block, Paragraph, Picture, plain, visible
from .known import varies

_SIZES = {"scene": (7.5, 6.5), "momentum": (6.5, 6.2), "impulse-plane": (7.5, 6.0), "energy": (7.0, 4.2)}
_SIZE = (6.5, 4.6)
# Nothing in a file may depend on chance or on whoever runs it; its letters stay letters, and names are no formulas.
_SETTINGS: Any = {"svg.hashsalt": "collisions", "svg.fonttype": "none", "text.parse_math": False}
_UNDATED = dict.fromkeys(("Creator", "Date", "Format", "Type"))
_TAG = re.compile(r"<[^>]*>")
_ID = re.compile(r'(\bid="|url\(#|href="#)([^")]*)')


def figures(impact: Any, uncertainty: Propagation | None, outline_a: Any, outline_b: Any, units: UnitSystem) -> Iterator[Block]:
    """The figures of the impact and of its uncertainty, or a sentence where there can be none."""
    try:
        import_module("matplotlib.figure")
    except ImportError:
        yield Paragraph("None: matplotlib cannot be imported here. Install it with: pip install 'collisions[plot]'")
        return
    if isinstance(impact, Impact):
        yield from _of_impact(impact, outline_a, outline_b, units)
    for number, output in enumerate(() if uncertainty is None else uncertainty.outputs.values(), 1):
        name = plain(output.name)
        if not varies(output):
            yield Paragraph(f"{name}: no figures, because it is the same in every case.")
            continue
        if isinstance(output, Sampled):
            caption = f"{name}: the cases drawn, given the stated inputs."
            yield _drawn(f"distribution-{number}", caption, partial(plot.distribution, output, units=units))
        caption = f"{name}: the share of its variance that each input brings, by itself and in all."
        yield _drawn(f"contributions-{number}", caption, partial(plot.contributions, output, units=units))


def _of_impact(impact: Impact, outline_a: Any, outline_b: Any, units: UnitSystem) -> Iterator[Block]:
    scene = partial(plot.scene, impact, units=units, outline_a=outline_a, outline_b=outline_b)
    yield _drawn("scene", "The scene from above at the moment of impact.", scene)
    if impact.model != "linear_central":
        yield _drawn("momentum", "Momentum before and after, head to tail.", partial(plot.momentum, impact, units=units))
        yield _drawn(
            "impulse-plane",
            "Normal and tangential impulse, with the lines that decide them.",
            partial(plot.impulse_plane, impact, units=units),
        )
    yield _drawn("energy", "Where the kinetic energy went.", partial(plot.energy, impact, units=units))


def _drawn(name: str, caption: str, draw: Callable[..., Any]) -> Block:
    """One figure, drawn with nobody's settings but these; a sentence where its numbers give none."""
    from matplotlib import rc_context, rcdefaults, rcParams
    from matplotlib.figure import Figure
    from matplotlib.text import Text

    with rc_context(), warnings.catch_warnings():
        rcdefaults()
        rcParams.update(_SETTINGS)
        # A name may have letters that this font lacks, and the font of whoever reads the page has.
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")
        figure = Figure(figsize=_SIZES.get(name, _SIZE), layout="constrained")
        try:
            draw(axes=figure.add_subplot())
        except InputError as error:
            return Paragraph(f"{caption} Not drawn: {error}.")
        for text in figure.findobj(Text):
            text.set_text(visible(text.get_text()))
        target = io.StringIO()
        figure.savefig(target, format="svg", metadata=_UNDATED, bbox_inches="tight", pad_inches=0.05)
    return Picture(caption, _within_a_page(target.getvalue(), name, caption))


def _within_a_page(svg: str, name: str, caption: str) -> str:
    """The svg element alone, its ids told apart from those of other figures, its style left to the page."""
    svg = visible(svg[svg.index("<svg") :].rstrip())
    svg = re.sub(r"\n\s*<defs>\s*<style[^>]*>[^<]*</style>\s*</defs>", "", svg, count=1)

    def told_apart(tag: re.Match[str]) -> str:
        return _ID.sub(lambda found: f"{found[1]}{name}.{found[2].replace(' ', '-')}", tag[0])

    label = f'<svg role="img" aria-label="{escape(caption)}"'
    return _TAG.sub(told_apart, svg).replace("<svg", label, 1)
