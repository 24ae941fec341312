"""The user's model, called with arrays: what it is given, and what it may answer."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Mapping
from typing import Any, TypeAlias

import numpy as np

from ..errors import CollisionsError, InputError, ShapeError
from ..reading import ArgumentReader
from ..units import is_quantity, shown, si_unit
from ..warning import quietly
from .alone import check_alone
from .distributions import pair_hints

Function: TypeAlias = Callable[..., Mapping[str, Any]]


class Model:
    """A function of named inputs, the fixed ones kept beside it; the names and units of its outputs from the first call on."""

    def __init__(self, function: Any, fixed: Mapping[str, Any]) -> None:
        if not callable(function):
            raise InputError(
                f"model must be a function of the named inputs that returns a dict of outputs, got {type(function).__name__}",
                code="bad_model",
                argument="model",
            )
        self.function = function
        self.fixed = dict(fixed)
        self.units: dict[str, str | None] = {}
        self._compared = False

    def at(self, place: Mapping[str, float]) -> Model:
        """The same model with more inputs fixed."""
        found = Model(self.function, {**self.fixed, **place})
        found._compared = self._compared
        return found

    def __call__(self, values: Mapping[str, Any], count: int, compare: bool = True) -> dict[str, Any]:
        """The outputs of the cases, as new float arrays; what is not finite has no answer and is NaN.

        The first time, a few cases are asked again alone. ``compare=False`` leaves that to another call: of calls from several
        threads always the same one is to do it.
        """
        found = self._answers(values, count)
        if compare and not self._compared:
            self._compared = check_alone(lambda case: self._answers(case, 1), values, found, count)
        return found

    def _answers(self, values: Mapping[str, Any], count: int) -> dict[str, Any]:
        for value in values.values():
            value.setflags(write=False)
        try:
            with quietly(), np.errstate(all="ignore"):
                answered = self.function(**self.fixed, **values)
        except Exception as error:
            called = (
                f"called with arrays of {count} cases for {', '.join(values) or 'nothing'}, and must work case by case: write "
                f"numpy in place of math (numpy.sqrt), numpy.where in place of if (numpy.where(x > 0, x, -x)), and let refused "
                f"cases be NaN: on_failure='nan' where the solver has it (reconstruct.speeds gives NaN by itself)"
                f"{pair_hints(self.fixed)}"
            )
            # What Python and numpy raise where an array is used as a number, or a number as a Quantity.
            if isinstance(error, (TypeError, ValueError, AttributeError)) and not isinstance(error, CollisionsError):
                told = f"{type(error).__name__}: {str(error).rstrip('.')}"
                raise InputError(f"model raised {told}. It is {called}", code="bad_model", argument="model") from error
            error.add_note(f"The model is {called}.")
            raise
        if not isinstance(answered, Mapping) or not answered:
            raise InputError(
                f"model must return a dict of named outputs, such as {{'delta_v': impact.a.delta_v}}, got "
                f"{type(answered).__name__}",
                code="bad_model",
                argument="model",
            )
        units = {name: si_unit(value, per_angle=True) if is_quantity(value) else None for name, value in answered.items()}
        if self.units and units != self.units:
            raise InputError(
                f"model returned {_listed(units)} now and {_listed(self.units)} before; it must always return the same outputs",
                code="bad_model",
                argument="model",
            )
        self.units = units
        return {name: self._read(name, value, units[name], count) for name, value in answered.items()}

    def _read(self, name: str, value: Any, unit: str | None, count: int) -> Any:
        if not isinstance(name, str):
            raise InputError(f"model must name its outputs by texts, got {shown(name)}", code="bad_model", argument="model")
        if isinstance(value, np.ndarray) and value.dtype == np.bool_:
            value = value.astype(np.float64)
        reader = ArgumentReader(trusted=(name,))
        read = reader.number(value, unit or "", name)
        reader.close()
        if np.shape(read) != (count,) and not np.size(read) == count == 1:
            raise ShapeError(
                f"output {name!r} of the model has shape {np.shape(read)} for {count} cases; it must answer every case by "
                f"itself, so an array of shape ({count},){pair_hints(self.fixed)}",
                code="bad_shape",
                argument=name,
            )
        found = np.array(read, dtype=np.float64).reshape(count)
        found[~np.isfinite(found)] = np.nan
        return found


def check_names(function: Any, names: Collection[str], argument: str, code: str) -> None:
    """Refuses inputs, or unknowns, that the model has no argument for, and arguments without one."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return
    try:
        signature.bind(**dict.fromkeys(names))
    except TypeError as error:
        raise InputError(
            f"{argument} are {', '.join(names) or 'none'}, but the model takes {signature}: {error}; name the {argument} as "
            f"the arguments of the model, and give one for each",
            code=code,
            argument=argument,
        ) from None


def _listed(units: Mapping[str, str | None]) -> str:
    return ", ".join(f"{name} [{unit}]" if unit else name for name, unit in units.items())
