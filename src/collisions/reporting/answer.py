"""``answer``: what a report says first: the figures that were asked for with their range, what they
rest on, and the findings that matter.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from operator import attrgetter
from typing import Any, NamedTuple

from ..derivation.explain import kinds_of_answers, names_of_answers, words_of_answers
from ..diagnostics.finding import Finding, is_note
from ..impact.impact import Impact
from ..impact.reconstruction import as_bound, how_many, known_in_words
from ..quantities.formatting import KIND_OF, Numbers
from ..quantities.tables import as_sentence, label_of
from ..quantities.user_text import plain
from ..reconstruct import Fit, MomentumSolution, Posterior
from ..uncertainty import Output, Propagation
from ..uncertainty.output import figures
from .posterior_part import answers_of, warned_of
from .render import Sheet
from .uncertainty import Spread
from .words import Names, listed

_NO_RANGE = (
    "give uncertainty= what uncertainty.propagate makes of the errors of the inputs, and each "
    "figure has its range here."
)


class Figure(NamedTuple):
    """One figure of an answer: what it is, its text, and whether that is a range."""

    what: str
    text: str
    ranged: bool


def answer(
    sheet: Sheet,
    result: Impact | MomentumSolution | Fit | Posterior,
    spread: Spread,
    uncertainty: Propagation | None,
    found: Sequence[Finding] | None,
    alone: bool,
    asked: Sequence[str] | None = None,
) -> None:
    """Write the figures, of those asked for by name if any were, what they rest on and the
    findings, into the box that is open.
    """
    names = spread.names
    shown = figures_of(sheet, result, spread, uncertainty, asked)
    sheet.figures_of_answer([(figure.what, figure.text) for figure in shown])
    sheet.say(rests_on(result, names))
    bare = [figure for figure in shown if not figure.ranged]
    if bare and len(bare) == len(shown):
        sheet.say(f"No range is stated for these figures{f': {_NO_RANGE}' if alone else '.'}")
    elif bare:
        sheet.say("No range is stated for the figures above that have only one number.")
    told = [finding for finding in found or () if not is_note(finding)]
    lines = [
        (f"{label_of(finding.code)}:", as_sentence(names(_in_words(finding.sentence))))
        for finding in told
    ]
    if uncertainty is not None:
        lines += warned_of(uncertainty)
    # On a page of its own the list of all that a posterior states follows the answer.
    if isinstance(result, Fit) or (isinstance(result, Posterior) and not alone):
        lines += warned_of(result, asked or result.found, spread.named)
    origin = result.reconstruction if isinstance(result, Impact) else None
    said = any(finding.code == "not_unique" for finding in told)
    if origin is not None and origin.answers > 1 and not said:
        lines.insert(
            0, ("", f"Not the only answer: {how_many(origin.answers)} fit what was known.")
        )
    if lines:
        sheet.items(lines)


def figures_of(
    sheet: Sheet,
    result: Any,
    spread: Spread,
    uncertainty: Propagation | None,
    asked: Sequence[str] | None,
) -> list[Figure]:
    """The figures of an answer: those asked for by name, or those that a reader looks for."""
    return list(_figures(sheet, result, spread, uncertainty, asked))


def _figures(
    sheet: Sheet,
    result: Any,
    spread: Spread,
    uncertainty: Propagation | None,
    asked: Sequence[str] | None,
) -> Iterator[Figure]:
    system = sheet.system
    if isinstance(result, Fit):
        for name in (
            result.names if asked is None else [one for one in asked if one in result.names]
        ):
            yield Figure(plain(name), _estimate(system, result[name]), True)
        return
    outputs: dict[str, Output] = {}
    if isinstance(result, Posterior):
        outputs = {name: result[name] for name in answers_of(result, asked)}
    elif uncertainty is not None:
        outputs = dict(uncertainty.outputs)
        if asked is not None:
            outputs = {name: outputs[name] for name in asked if name in outputs}
    for output in outputs.values():
        text, ranged = ranged_text(system, output, spread.kind_of(output))
        own = spread.kind_of(output) is not None
        heading = spread.heading(output)
        yield Figure(_begun(heading) if own else heading, text, ranged)
    if isinstance(result, Posterior):
        return
    words, kinds = words_of_answers(result), kinds_of_answers(result)
    spelled = names_of_answers(result)
    wanted = (
        _asked(result)
        if asked is None
        else (spelled[name] for name in asked if name in spelled and name not in outputs)
    )
    for name in wanted:
        value = attrgetter(name)(result)
        if name not in spread.outputs and value is not None and math.isfinite(value):
            text = system.answer(float(value), kinds[name])
            if isinstance(result, Impact):
                text = as_bound(result.reconstruction, name, text)
            yield Figure(_begun(spread.names(words[name])), text, False)


def _in_words(sentence: str) -> str:
    """The sentence of a finding without names of functions and models."""
    sentence = re.sub(r"\breconstruct\.\w+", "solving backwards", plain(sentence))
    return re.sub(r"\b(linear|oblique)_(central)\b", r"\1-\2", sentence)


def _begun(text: str) -> str:
    """Words as they begin a line."""
    return text[:1].upper() + text[1:]


def _asked(result: Impact | MomentumSolution) -> Iterator[str]:
    """The results that a reader looks for, by name: those that the solver found, and the
    delta-V.
    """
    names = names_of_answers(result)
    yield from (names[name] for name in result.found if name in names)
    if isinstance(result, MomentumSolution):
        yield from ("delta_v_a", "delta_v_b")
        return
    origin = result.reconstruction
    known = () if origin is None else origin.known
    sides = [
        label
        for label, side in (("a", result.a), ("b", result.b))
        if math.isfinite(side.before.mass)
    ]
    for label in sides:
        if f"delta_v_{label}" not in known:
            yield f"{label}.delta_v"
    if origin is None:
        yield from (f"{label}.after.speed" for label in sides)
    if "energy_loss" not in known:
        yield "energy_loss"


def ranged_text(system: Numbers, output: Output, kind: str | None) -> tuple[str, bool]:
    """The range of an output, to two figures of its half-width; what there is where it has none."""
    kind = kind or KIND_OF.get(output.unit or "", system.unlisted)
    low, high = output.interval()
    rows = figures(output, system, kind)
    if kind is None or not math.isfinite(low + high) or rows[-1][0].startswith(("the same", "in ")):
        # An end that is infinite is a range all the same: "at least 12 m/s".
        return plain(rows[-1][1]), kind is None or math.inf in (-low, high)
    means = "every value of the stated intervals" if output.bounds_only else "95 %"
    return f"{system.span(low, high, kind, 0.5 * (high - low))} ({means})", True


def _estimate(system: Numbers, one: Any) -> str:
    """The 95 percent interval of an unknown of a fit."""
    if not one.determined:
        return "not determined"
    low, high = one.interval(0.95)
    kind = KIND_OF.get(one.unit, "number")
    unit = "" if one.unit in KIND_OF else f" {one.unit}"
    return f"{system.span(low, high, kind, 0.5 * (high - low))}{unit} (95 %)"


def rests_on(result: Any, names: Names) -> str:
    """What an answer rests on, in one sentence."""
    if isinstance(result, Fit):
        count = len(result.residuals)
        return (
            f"The values that fit {count} observations and prior values best, each weighed by its "
            "stated error."
        )
    if isinstance(result, Posterior):
        worked = ""
        if result.results:
            verb = "was" if len(result.results) == 1 else "were"
            named = _begun(listed(map(plain, result.results)))
            worked = f" {named} {verb} worked out from that."
        count = len(result.observed)
        what, them = (
            ("one observation leaves", "it")
            if count == 1
            else (f"{count} observations leave", "them")
        )
        return f"What {what} of the ranges that were stated before {them}.{worked}"
    if isinstance(result, MomentumSolution):
        outside = "" if result.outside_impulse_x is None else " and the stated impulse from outside"
        return (
            "Worked back by the momentum of both vehicles, from their masses, courses and the "
            f"speeds that were known{outside}; nothing is assumed of restitution or friction."
        )
    origin, model = result.reconstruction, result.model.replace("_", "-")
    if origin is None:
        return (
            f"Worked out forwards by momentum and restitution ({model} impact), from the "
            "velocities before, the masses and the contact that were given."
        )
    known = [f"the {names(words)}" for words in known_in_words(origin.known)]
    if origin.method == "planar":
        known.insert(0, "the motions of both vehicles after")
    return (
        f"Worked back by momentum and restitution ({model} impact), from {listed(known)}, with "
        "the masses and the contact that were given."
    )
