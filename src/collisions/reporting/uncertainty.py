"""``Spread``: adds a propagation to a report: the spread of each result it covers, and a section of
its own.
"""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any

from ..derivation.evidence import momentum_inputs
from ..derivation.explain import impact_inputs, kinds_of_answers, spread_of, words_of_answers
from ..impact.impact import Impact
from ..kernels.contact_laws import RULES
from ..messages.errors import InputError
from ..quantities.formatting import SI_UNITS, Numbers, typeset, with_decimals
from ..quantities.tables import as_sentence
from ..reconstruct import Fit, MomentumSolution, Posterior
from ..uncertainty import Interval, Output, Propagation
from ..uncertainty.distribution import GivenUnit, from_numbers
from ..uncertainty.result import NO_SPREAD, NOTHING, figures, varies
from .render import Sheet, plain

# Kind and number of inputs of the library that have no unit, and so are no more in SI than in any
# other units; their number in this result is not known.
_UNITLESS = {
    f"{name}{of}": ("number", math.nan)
    for name in ("restitution", "drag", "lock", "grade", "share", *RULES)
    for of in ("", "_a", "_b")
}


class Spread:
    """The outputs of a propagation that are results of the report, by the name of the result."""

    def __init__(
        self, impact: Impact | MomentumSolution | Fit | Posterior, uncertainty: Propagation | None
    ) -> None:
        self.impact = impact
        self.kinds = kinds_of_answers(impact)
        self.outputs, self.deviations, self.ranges = (
            ({}, {}, {}) if uncertainty is None else spread_of(impact, uncertainty)
        )

    def heading(self, output: Output) -> str:
        """The result in words, such as "A: delta-V"; of any other output its name."""
        words = words_of_answers(self.impact)
        return next(
            (words[name] for name, answer in self.outputs.items() if answer is output),
            plain(output.name),
        )

    def write(self, sheet: Sheet, uncertainty: Propagation) -> None:
        """Write the figures of every output and the inputs they assume."""
        sheet.heading("Uncertainty, given the stated inputs")
        for name, output in self.outputs.items():
            self._check(sheet, name, output)
        rows: list[tuple[str, str, str]] = []
        for output in uncertainty.outputs.values():
            rows += [
                (self.heading(output), what, text) for what, text in self._figures(sheet, output)
            ]
        sheet.table(rows)
        if any(what.startswith("variance from") for _, what, _ in rows):
            sheet.say(
                "Variance from an input: its share by itself, and in all, with its interactions "
                "with other inputs. Where the shares fall short of 100 % by more than their "
                "errors, the rest comes from interactions."
            )
        known = _UNITLESS | _inputs(self.impact)
        stated = [
            (plain(name), _stated(sheet.system, value, *known.get(name, ())))
            for name, value in uncertainty.inputs.items()
        ]
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
            sheet.stress("What was warned of:")
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

    def _figures(self, sheet: Sheet, output: Output) -> list[tuple[str, str]]:
        own = next(
            (self.kinds[name] for name, answer in self.outputs.items() if answer is output), None
        )
        found = [(what, plain(text)) for what, text in figures(output, sheet.system, own)]
        return found if output.bounds_only else [*found, *_shares(output)]


def _inputs(result: Any) -> dict[str, tuple[str, float]]:
    """Kind and number of the inputs of a result, by the names of arguments: "mass_a", "speed_a",
    "restitution".
    """
    if isinstance(result, MomentumSolution):
        return {name: (kind, number) for _, _, name, number, kind in momentum_inputs(result)}
    found = {
        name if of == "contact" else f"{name}_{of.lower()}": (kind, number)
        for of, _, names, numbers, kind in impact_inputs(result)
        for name, number in zip(names, numbers, strict=True)
    }
    for label, vehicle in (("a", result.a.before), ("b", result.b.before)):
        found |= {
            f"speed_{label}": ("speed", vehicle.speed),
            f"course_{label}": ("angle", vehicle.course),
        }
    return found


def _stated(system: Numbers, value: Any, kind: str = "", number: float = math.nan) -> str:
    """An input as stated; bare numbers in the unit of the page if they are about the result's own
    input of that name.
    """
    if getattr(value, "unit", None) != "":
        return plain(str(value))
    low, high = (
        (value.low, value.high)
        if isinstance(value, Interval)
        else map(value.quantile, (0.0005, 0.9995))
    )
    if kind != "number" and not low <= number <= high:
        return f"{value}, in SI units"
    if SI_UNITS[kind]:
        unit = GivenUnit(SI_UNITS[kind])
        unit.written, unit.factor = system.label(kind), 1.0 / system.scale(kind)
        value = from_numbers(type(value), unit, value._parts, value._range)
    return typeset(str(value))


def shares_of(output: Output) -> dict[str, float]:
    """The share of each input in the variance; empty where the method has none."""
    with suppress(InputError):
        return output.contributions
    return {}


def _shares(output: Output) -> list[tuple[str, str]]:
    """Table rows with each input's share of the variance, by itself and in total.

    One share, of one input or of one group drawn together, says nothing.
    """
    shares = shares_of(output)
    if not varies(output) or len(shares) < 2:
        return []
    whole, errors = output.total_contributions, output.contribution_standard_errors
    rows = [
        (
            f"variance from {plain(name)}",
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
