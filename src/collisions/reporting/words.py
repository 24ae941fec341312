"""Words in place of letters and arguments: the names of the vehicles, and what an argument of the
library means.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import Any

from ..derivation.evidence import momentum_inputs
from ..derivation.explain import impact_inputs
from ..impact.impact import Impact
from ..impact.reconstruction import KNOWN
from ..quantities.formatting import KIND_OF
from ..quantities.user_text import plain
from ..reconstruct import MomentumSolution
from ..scene.run import Run
from .scene_words import about, input_in_words

# Longer names would break tables and figures; the letter stands for them there.
_SHORT = 24
_OF = re.compile(r"\b(of )([AB])\b")
_LEAD = re.compile(r"^([AB])(?=: )")
# What the paper calls them, by the argument they stand for.
_SYMBOLS = {"e": "restitution", "mu": "friction", "μ": "friction"}


class Names:
    """The vehicles of a result by their letters, and its inputs by their arguments, in words."""

    def __init__(self, result: Any) -> None:
        self._names = {"A": "A", "B": "B"}
        self._inputs: dict[str, tuple[str, str, float]] = {}
        if isinstance(result, Impact):
            for letter, side in (("A", result.a), ("B", result.b)):
                name = plain(side.before.name)
                if name and len(name) <= _SHORT:
                    self._names[letter] = name
            if len(set(self._names.values())) == 1:
                self._names = {"A": "A", "B": "B"}
            self._inputs = dict(_of_impact(result))
        elif isinstance(result, MomentumSolution):
            for of, what, name, number, kind in momentum_inputs(result):
                words = what if of not in "AB" else about(what, of)
                self._inputs[name] = words, kind, number
        elif isinstance(result, Run):
            numbers = dict(result.scene._numbers())
            for path, unit in result.scene.inputs().items():
                first = result.scene.shared.get(path, (path,))[0]
                number = float(numbers.get(first, math.nan))
                words = plain(input_in_words(result.scene, path))
                self._inputs[path] = words, KIND_OF.get(unit, "number"), number

    def of(self, letter: str) -> str:
        """The name of a vehicle, or its letter."""
        return self._names.get(letter, letter)

    def __call__(self, text: str) -> str:
        """A text with the vehicles' names in place of their letters."""
        text = _LEAD.sub(lambda found: self._names[found[1]], text)
        return _OF.sub(lambda found: found[1] + with_article(self._names[found[2]]), text)

    def number_of(self, name: str) -> tuple[str, float]:
        """Kind and number of an input of the result; "" and NaN if the result has none of
        that name.
        """
        _, kind, number = self._inputs.get(self._argument(name), ("", "", math.nan))
        return kind, number

    def of_input(self, name: str, low: float, high: float) -> str:
        """An input of a propagation in words, if its name is an argument of the library; a symbol
        such as e only if the values stated for it hold the one of this result.
        """
        words, kind, number = self._inputs.get(self._argument(name), ("", "", math.nan))
        if name in _SYMBOLS or name in ("va", "vb"):
            near = kind != "" and low <= number <= high
            return f"{self(words)} ({plain(name)})" if near else plain(name)
        known = words or (KNOWN[name].what if name in KNOWN else "")
        return self(known) if known else plain(name)

    def _argument(self, name: str) -> str:
        if name in ("va", "vb"):
            return f"speed_{name[1]}"
        # As a case file has it.
        label, _, part = name.partition(".")
        if name not in self._inputs and part and label in ("a", "b"):
            return f"{part}_{label}"
        return _SYMBOLS.get(name, name)


def with_article(name: str) -> str:
    """A vehicle by its name in a sentence: a word with its article, letters and numbers without."""
    return f"the {name}" if len(name) > 1 and name.isalpha() else name


def _of_impact(impact: Impact) -> Iterable[tuple[str, tuple[str, str, float]]]:
    for of, what, names, numbers, kind in impact_inputs(impact):
        parts = ("",) if len(names) == 1 else (", along x", ", along y")
        for name, number, part in zip(names, numbers, parts, strict=True):
            if of == "contact":
                words = "restitution" if name == "restitution" else what.partition(" (")[0]
                yield name, (f"{words}{part}", kind, number)
            else:
                words = about(what.partition(" (")[0], of)
                yield f"{name}_{of.lower()}", (f"{words}{part}", kind, number)
    for label, vehicle in (("a", impact.a.before), ("b", impact.b.before)):
        before = f"of {label.upper()} before"
        yield f"speed_{label}", (f"speed {before}", "speed", float(vehicle.speed))
        yield f"course_{label}", (f"course {before}", "angle", float(vehicle.course))


def listed(parts: Iterable[str]) -> str:
    """A list in a sentence."""
    *most, last = parts
    return f"{', '.join(most)} and {last}" if most else last
