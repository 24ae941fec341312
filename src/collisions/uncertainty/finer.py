"""A finer model beside the one that is sampled: it takes the same inputs and returns the same
outputs.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from ..messages.errors import CollisionsError, InputError, placed
from .model import Model, check_names
from .one_sided import Answers


class FinerModel(Model):
    """The function given as ``finer=``, whose errors say that it is this one."""

    def __init__(self, function: Any, fixed: Mapping[str, Any]) -> None:
        try:
            super().__init__(function, fixed)
        except InputError as error:
            raise _of_finer(error) from None

    def __call__(self, values: Mapping[str, Any], count: int, check: bool = True) -> Answers:
        """The outputs of the cases, as those of any model."""
        try:
            return super().__call__(values, count, check)
        except CollisionsError as error:
            raise _of_finer(error) from error

    def check_inputs(self, names: Collection[str], argument: str, code: str) -> None:
        """Raise unless it takes the inputs of the other model."""
        try:
            check_names(self.function, names, argument, code)
        except InputError as error:
            raise _of_finer(error) from None

    def check_outputs(self, model: Model) -> None:
        """Raise unless it returns the outputs of the other model, in the same units."""
        if self.units == model.units:
            return
        differing = [
            f"{name} is {_unit(self.units, name)} of finer and {_unit(model.units, name)} of model"
            for name in dict.fromkeys([*model.units, *self.units])
            if name not in self.units
            or name not in model.units
            or self.units[name] != model.units[name]
        ]
        if not differing:
            return
        raise InputError(
            f"finer must return the outputs of model, in the same units: {'; '.join(differing)}",
            code="different_outputs",
            argument="finer",
        )


def _unit(units: Mapping[str, str | None], name: str) -> str:
    """What a model returns by this name."""
    if name not in units:
        return "no output"
    return f"in {units[name]}" if units[name] else "a plain number"


def _of_finer(error: CollisionsError) -> CollisionsError:
    """The same error, saying that the model meant is the finer one."""
    of_model = error.fields.get("argument") == "model"
    found = placed(error, "finer", **({"argument": "finer"} if of_model else {}))
    for note in getattr(error, "__notes__", ()):
        found.add_note(note)
    return found
