"""``Spread``: adds a propagation to a report: the spread of each result it covers, and a section of
its own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from ..derivation.explain import kinds_of_answers, spread_of, words_of_answers
from ..impact.impact import Impact
from ..kernels.contact_laws import RULES
from ..messages.errors import InputError
from ..quantities.formatting import typeset, with_decimals
from ..quantities.tables import as_sentence
from ..quantities.user_text import plain
from ..reconstruct import Fit, MomentumSolution, Posterior
from ..scene.run import Run
from ..uncertainty import Interval, Output, Propagation
from ..uncertainty.distribution import stated_in
from ..uncertainty.output import NO_SPREAD, NOTHING, figures, varies
from .render import Sheet
from .scene_words import result_in_words
from .words import Names

# Inputs of the library that have no unit; their number in this result is not known.
_UNITLESS = {
    f"{name}{of}"
    for name in ("restitution", "drag", "lock", "grade", "share", *RULES)
    for of in ("", "_a", "_b")
}


class Spread:
    """The outputs of a propagation that are results of the report, by the name of the result.

    ``words`` are those for the names of a posterior or fit whose scene is known.
    """

    def __init__(
        self,
        impact: Impact | MomentumSolution | Fit | Posterior | Run,
        uncertainty: Propagation | None,
        words: Mapping[str, str] | None = None,
    ) -> None:
        self.words = words or {}
        self.impact, self.names, self.propagation = impact, Names(impact), uncertainty
        self.kinds = {} if isinstance(impact, Run) else kinds_of_answers(impact)
        self.outputs, self.deviations, self.ranges = (
            ({}, {}, {})
            if uncertainty is None or isinstance(impact, Run)
            else spread_of(impact, uncertainty)
        )

    def named(self, name: str) -> str:
        """An unknown, an output or a reading in words, or by its name where there are none."""
        return plain(self.words.get(name, name))

    def heading(self, output: Output) -> str:
        """The result in words, such as "Golf: delta-V"; of any other output its name."""
        if isinstance(self.impact, Run):
            return plain(result_in_words(self.impact, output.name))
        words = words_of_answers(self.impact)
        return next(
            (self.names(words[name]) for name, answer in self.outputs.items() if answer is output),
            self.named(output.name),
        )

    def kind_of(self, output: Output) -> str | None:
        """The kind of an output that is a result of the report."""
        own = (self.kinds[name] for name, answer in self.outputs.items() if answer is output)
        return next(own, None)

    def words_of(self, uncertainty: Propagation | None) -> dict[str, str]:
        """The inputs of a propagation in words, by name."""
        return {
            name: self.names.of_input(name, *_ends(value))
            for name, value in (uncertainty.inputs if uncertainty is not None else {}).items()
        }

    def write(self, sheet: Sheet, uncertainty: Propagation) -> None:
        """Write the figures of every output and the inputs they assume."""
        sheet.heading("Uncertainty, given the stated inputs")
        for name, output in self.outputs.items():
            self._check(sheet, name, output)
        rows: list[tuple[str, str, str]] = []
        for output in uncertainty.outputs.values():
            rows += [
                (self.heading(output), what, text)
                for what, text in self._figures(sheet, output, uncertainty)
            ]
        sheet.table(rows)
        if any(name.startswith(("impacts[", "times[")) for name in uncertainty.outputs):
            sheet.say(
                "Impacts are counted in order of time in every case, and named after the "
                "vehicles that they have in the run of this report."
            )
        if any(what.startswith("variance from") for _, what, _ in rows):
            sheet.say(
                "Variance from an input: its share by itself, and in all, with its interactions "
                "with other inputs. Where the shares fall short of 100 % by more than their "
                "errors, the rest comes from interactions"
                + (
                    ", and from what the correction does not foresee."
                    if any(uncertainty.scatter.values())
                    else "."
                )
            )
        stated = [self._stated(sheet, *row) for row in uncertainty.inputs.items()]
        sheet.table([("Inputs as stated", *row) for row in stated])
        cases = (
            f"{uncertainty.samples} cases, "
            f"{f'{uncertainty.failed} without an' if uncertainty.failed else 'all with an'} "
            "answer"
        )
        seed = "" if uncertainty.seed is None else f", seed {uncertainty.seed}"
        sheet.say(
            f"± is one standard deviation. Method: {uncertainty.method.replace('_', '-')}, "
            f"{cases}{seed}. Whatever the stated inputs leave out, these figures leave out too."
        )
        if uncertainty.statements:
            sheet.stress("What belongs with these figures:")
            sheet.listed([plain(as_sentence(sentence)) for sentence in uncertainty.statements])

    def _check(self, sheet: Sheet, name: str, output: Output) -> None:
        """Warn if the result is outside the propagation's interval: one of the two then belongs to
        another case.
        """
        value: Any = self.impact
        for part in name.split("."):
            value = getattr(value, part)
        kind, (low, high) = self.kinds[name], output.interval()
        turns = (-1, 0, 1) if kind == "angle" else (0,)
        off = max(NO_SPREAD * max(abs(low), abs(high)), NOTHING.get(kind, NO_SPREAD))
        if value is None or not any(
            low - off <= value + 2.0 * math.pi * turn <= high + off for turn in turns
        ):
            text = "none" if value is None else sheet.system.answer(float(value), kind)
            sheet.stress(
                f"{self.heading(output)}, {text} in this impact, lies outside the 95 percent "
                "interval of the propagation: are both of the same case?"
            )

    def _figures(
        self, sheet: Sheet, output: Output, uncertainty: Propagation
    ) -> list[tuple[str, str]]:
        found = [
            (what, plain(text))
            for what, text in figures(output, sheet.system, self.kind_of(output))
        ]
        if output.bounds_only:
            return found
        return [*found, *_shares(output, self.words_of(uncertainty))]

    def stated(self, sheet: Sheet, name: str, kind: str, number: float) -> str:
        """What the propagation states of an input of the result, if it has one of that name whose
        values hold this number; otherwise "".
        """
        value = None if self.propagation is None else self.propagation.inputs.get(name)
        if value is None:
            return ""
        low, high = _ends(value)
        return _in_words(sheet, value, kind) if low <= number <= high else ""

    def _stated(self, sheet: Sheet, name: str, value: Any) -> tuple[str, str]:
        """An input and what was stated of it; bare numbers in the unit of the page if they are
        about the result's own input of that name.
        """
        low, high = _ends(value)
        words = self.names.of_input(name, low, high)
        if getattr(value, "unit", None) != "":
            return words, plain(str(value))
        kind, number = self.names.number_of(name)
        if name in _UNITLESS or kind in ("number", "ratio"):
            return words, typeset(str(value))
        if not low <= number <= high:
            return words, f"{value}, given without a unit"
        return words, _in_words(sheet, value, kind)


def _in_words(sheet: Sheet, value: Any, kind: str) -> str:
    """What was stated of an input of some kind; bare numbers in the unit of the page."""
    text = stated_in(value, sheet.system, kind)
    return plain(text) if value.unit != "" else typeset(text)


def _ends(value: Any) -> tuple[float, float]:
    """About the lowest and highest value of a stated input; NaN where numbers do not tell."""
    if isinstance(value, Interval):
        return value.low, value.high
    if not hasattr(value, "quantile"):
        return math.nan, math.nan
    low, high = map(value.quantile, (0.0005, 0.9995))
    return float(low), float(high)


def shares_of(output: Output) -> dict[str, float]:
    """The share of each input in the variance; empty where the method has none."""
    with suppress(InputError):
        return output.contributions
    return {}


def _shares(output: Output, words: Mapping[str, str]) -> list[tuple[str, str]]:
    """Table rows with each input's share of the variance, by itself and in total.

    One share, of one input or of one group drawn together, says nothing.
    """
    shares = shares_of(output)
    if not varies(output) or len(shares) < 2:
        return []
    whole, errors = output.total_contributions, output.contribution_standard_errors
    rows = [
        (
            f"variance from {words.get(name, plain(name))}",
            (
                f"{_share(_within(part), errors[name][0])}, in all "
                f"{_share(_within(whole[name]), errors[name][1])}"
            ),
        )
        for name, part in shares.items()
    ]
    return [*rows, ("sum of the shares", _share(sum(map(_within, shares.values()))))]


def _share(share: float, error: float = math.nan) -> str:
    """A share of the variance, with its standard error where that shows."""
    if math.isnan(share):
        return "not known"
    spread = f" ± {with_decimals(100.0 * error, 0)}" if error >= 0.005 else ""
    return f"{with_decimals(100.0 * share, 0)}{spread} %"


def _within(share: float) -> float:
    """A share limited to 0 to 1, which sampling errors may exceed."""
    return share if math.isnan(share) else min(max(share, 0.0), 1.0)
