"""The answer of a propagation: its outputs by name, what it was made from, and what failed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..errors import InputError
from ..quantities import table
from ..units import shown
from .normal import power_of_two
from .output import Output
from .sampled import Sampled


class Propagation:
    """The outputs of a model given the stated inputs; ``result["delta_v"]`` is one of them.

    Attributes
    ----------
    method : str
        How it was worked out.
    inputs : dict
        What was stated: distributions, intervals, and fixed values.
    samples : int
        Cases the model was asked for.
    failed : int
        Cases among them without an answer to at least one output, such as no impact at all: left out of the figures, which
        hold given that there is an answer.
    seed : int or None
        What reproduces the result to the bit; None where nothing was drawn.
    interrupted : bool
        Whether the run was stopped before its end; the figures are those of the cases done.
    """

    def __init__(
        self,
        method: str,
        inputs: Mapping[str, Any],
        outputs: Mapping[str, Output],
        samples: int,
        failed: int,
        seed: int | None = None,
        interrupted: bool = False,
    ) -> None:
        self.method = method
        self.inputs = dict(inputs)
        self.outputs = dict(outputs)
        self.samples = samples
        self.failed = failed
        self.seed = seed
        self.interrupted = interrupted

    def __getitem__(self, name: str) -> Output:
        try:
            return self.outputs[name]
        except KeyError:
            raise InputError(
                f"there is no output {name!r}; the model returned {', '.join(self.outputs)}", code="no_output", argument="name"
            ) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self.outputs)

    def __len__(self) -> int:
        return len(self.outputs)

    @property
    def correlation(self) -> dict[tuple[str, str], float]:
        """Correlation of every pair of outputs, over the cases that answer both; only from sampling."""
        sampled = {name: output.values for name, output in self.outputs.items() if isinstance(output, Sampled)}
        found: dict[tuple[str, str], float] = {}
        for i, one in enumerate(sampled):
            for other in list(sampled)[i + 1 :]:
                both = ~np.isnan(sampled[one]) & ~np.isnan(sampled[other])
                pair = [values[both] / power_of_two(values[both]) for values in (sampled[one], sampled[other])]
                with np.errstate(all="ignore"):
                    matrix = np.corrcoef(*pair) if np.count_nonzero(both) > 1 else None
                found[one, other] = math.nan if matrix is None else float(matrix[0, 1])
        return found

    def to_dict(self) -> dict[str, Any]:
        """Figures of all outputs, and what they are given, as nested plain values that strict JSON can hold."""
        return {
            "method": self.method,
            "inputs": {name: shown(value, 1000) for name, value in self.inputs.items()},
            "samples": self.samples,
            "failed": self.failed,
            "seed": self.seed,
            "interrupted": self.interrupted,
            "outputs": {name: output.record() for name, output in self.outputs.items()},
        }

    def __repr__(self) -> str:
        lines = "\n".join(f"  {name}: {text}" for name, text in self._rows())
        cases = f"{self.samples} cases, {self.failed} without an answer"
        return f"<Propagation by {self.method}, {cases}; given the stated inputs\n{lines}>"

    def _repr_html_(self) -> str:
        title = f"Given the stated inputs ({self.method}, {self.samples} cases, {self.failed} without an answer)"
        return table(title, self._rows())

    def _rows(self) -> Iterator[tuple[str, str]]:
        return (output.row() for output in self.outputs.values())
