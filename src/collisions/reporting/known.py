"""What a propagation says of the impact: the answers it knows the spread of, and its own table."""

from __future__ import annotations

import math
from typing import Any

from ..derivation.explain import kinds_of_answers
from ..errors import InputError
from ..formatting import KIND_OF, SI_UNITS
from ..impact import Impact
from ..reconstruct import Fit, MomentumSolution
from ..uncertainty import Output, Propagation
from ..units import shown
from .blocks import Sheet, plain

# A spread of less than this part of the mean, or than what rounding leaves of nothing in SI, is none.
_ROUNDING, _NOTHING = 1e-10, {"impulse": 1e-8, "angular momentum": 1e-8, "energy": 1e-8}


class Known:
    """The outputs of a propagation that are answers of the impact, by the name of the answer."""

    def __init__(self, impact: Impact | MomentumSolution | Fit, uncertainty: Propagation | None) -> None:
        self.impact = impact
        self.outputs: dict[str, Output] = {}
        kinds = kinds_of_answers(impact)
        self.kind_of = kinds.__getitem__
        paths = {name.replace(".", "_"): name for name in kinds} | {name: name for name in kinds}
        for output in () if uncertainty is None else uncertainty.outputs.values():
            name = paths.get(output.name)
            if name is not None and output.unit in (None, SI_UNITS[self.kind_of(name)]):
                self.outputs[name] = output

    @property
    def deviations(self) -> dict[str, float]:
        """Standard deviations; what an interval leaves open has none, only ranges."""
        found = {name: _both(output.std) for name, output in self.outputs.items()}
        return {
            name: std[0]
            for name, std in found.items()
            if len(std) == 1 and math.isfinite(std[0]) and varies(self.outputs[name], self.kind_of(name))
        }

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """What an interval among the inputs leaves open."""
        return {name: output.interval() for name, output in self.outputs.items() if len(_both(output.std)) > 1}

    def tell(self, sheet: Sheet, uncertainty: Propagation) -> None:
        """The figures of every output, what they are given, and whether they are of this impact."""
        sheet.heading("Uncertainty, given the stated inputs")
        for name, output in self.outputs.items():
            self._stray(sheet, name, output)
        rows: list[tuple[str, str, str]] = []
        for output in uncertainty.outputs.values():
            rows += [(plain(output.name), what, text) for what, text in self._figures(sheet, output, uncertainty.method)]
        sheet.table(("of", "quantity", "value"), rows)
        if any(what.startswith("share of the variance") for _, what, _ in rows):
            sheet.say(
                "By itself an input brings its share without what it does together with others; in all, with that. "
                "Where the shares by themselves fall short of 100 percent by more than their errors, the rest comes of inputs "
                "together."
            )
        stated = [(plain(name), "stated as", plain(shown(value, 1000))) for name, value in uncertainty.inputs.items()]
        sheet.table(("of", "quantity", "value"), [("Inputs as stated", name, text) for name, _, text in stated])
        cases = f"{uncertainty.samples} cases, {uncertainty.failed} without an answer"
        seed = "" if uncertainty.seed is None else f", seed {uncertainty.seed}"
        sheet.say(f"By {uncertainty.method}: {cases}{seed}. What the inputs leave out, these figures do.")
        if uncertainty.failed:
            sheet.say("Cases without an answer are left out: the figures hold given that there is one.")
        if uncertainty.interrupted:
            sheet.stress("The run was stopped before its end; the figures are those of the cases done.")

    def _figures(self, sheet: Sheet, output: Output, method: str) -> list[tuple[str, str]]:
        name = next((name for name, own in self.outputs.items() if own is output), None)
        kind = self.kind_of(name) if name is not None else None if output.unit is None else KIND_OF.get(output.unit)
        if kind is None:
            return [("figures", plain(output.row()[1])), *self._shares(output)]
        mean, std, (low, high) = _both(output.mean), _both(output.std), output.interval()

        def number(value: float) -> str:
            return sheet.system.answer(value, kind, None)

        found = []
        if method == "interval":
            return [("range, wherever in the intervals the truth is", f"{number(low)} to {number(high)}")]
        if len(mean) == 1 and math.isnan(std[0]):
            return [("in the one case that has an answer, so no spread is known", number(mean[0]))]
        if len(mean) == 1 and not varies(output, kind):
            return [("the same in every case", number(mean[0]))]
        if len(mean) == 1:
            found.append(("mean ± standard deviation", sheet.system.answer(mean[0], kind, std[0])))
            found.append(("95 percent interval", _ends(sheet, low, high, kind, std[0])))
        else:
            found.append(("mean, wherever in the intervals the truth is", f"{number(mean[0])} to {number(mean[1])}"))
            found.append(("range that holds 95 percent", f"{number(low)} to {number(high)}"))
        return [*found, *self._shares(output)]

    @staticmethod
    def _shares(output: Output) -> list[tuple[str, str]]:
        try:
            shares = output.contributions
        except InputError:
            return []
        if not varies(output):
            return []
        whole, errors = output.total_contributions, output.contribution_standard_errors
        found = [
            (
                f"share of the variance by {plain(name)}",
                f"{_percent(_within(part), errors[name][0])} by itself, "
                f"{_percent(_within(whole[name]), errors[name][1])} in all",
            )
            for name, part in shares.items()
        ]
        return [*found, ("sum of the shares by themselves", _percent(sum(map(_within, shares.values()))))]

    def _stray(self, sheet: Sheet, name: str, output: Output) -> None:
        """The answer must lie where the propagation says it does, or one of the two is of something else."""
        value: Any = self.impact
        for part in name.split("."):
            value = getattr(value, part)
        low, high = output.interval()
        turns = (-1, 0, 1) if self.kind_of(name) == "angle" else (0,)
        off = max(_ROUNDING * max(abs(low), abs(high)), _NOTHING.get(self.kind_of(name), _ROUNDING))
        if value is None or not any(low - off <= value + 2.0 * math.pi * turn <= high + off for turn in turns):
            told = "none" if value is None else sheet.system.answer(float(value), self.kind_of(name))
            sheet.stress(
                f"{name} of this impact, {told}, lies outside the 95 percent interval of the propagation: are both of the same "
                f"case?"
            )


def varies(output: Output, kind: str = "") -> bool:
    """Whether an output is another in other cases, by more than rounding."""
    return bool(max(_both(output.std)) > max(_ROUNDING * max(map(abs, _both(output.mean))), _NOTHING.get(kind, _ROUNDING)))


def _percent(share: float, error: float = math.nan) -> str:
    """A share of the variance, with its standard error where that shows."""
    if math.isnan(share):
        return "not known"
    told = f"{100.0 * share:.0f}"
    return f"{told} ± {100.0 * error:.0f} percent" if error >= 0.005 else f"{told} percent"


def _within(share: float) -> float:
    """A share, which sampling may put outside of 0 to 1."""
    return share if math.isnan(share) else min(max(share, 0.0), 1.0)


def _both(figure: Any) -> tuple[float, ...]:
    """One figure, or the ends of its range."""
    return tuple(map(float, figure)) if isinstance(figure, tuple) else (float(figure),)


def _ends(sheet: Sheet, low: float, high: float, kind: str, deviation: float) -> str:
    """The ends of an interval with the digits of the mean."""
    first, second = (sheet.system.answer(end, kind, deviation).partition(" ± ")[0] for end in (low, high))
    label = sheet.system.unit(kind)
    return f"{first.removesuffix(label)} to {second.removesuffix(label)}{label}"
