"""Some cases of a batch, or one of them, as a question of their own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .door import is_whole
from .errors import InputError, ShapeError
from .units import shown
from .vehicle import NAMES, Vehicle

if TYPE_CHECKING:
    from .impact import Asked


def part_of(whole: Any, take: Callable[[Any], Any]) -> Any:
    """A question, or what is known of its answer, with ``take`` put to every array in it."""
    if isinstance(whole, np.ndarray):
        return take(whole)
    if isinstance(whole, Vehicle):
        part = Vehicle._of_numbers({name: part_of(getattr(whole, name), take) for name in NAMES})
        return part._told(whole._given)
    if isinstance(whole, Mapping):
        return {name: part_of(value, take) for name, value in whole.items()}
    if isinstance(whole, tuple):
        parts = [part_of(value, take) for value in whole]
        return type(whole)(*parts) if hasattr(whole, "_fields") else tuple(parts)
    if is_dataclass(whole) and not isinstance(whole, type):
        return type(whole)(**{f.name: part_of(getattr(whole, f.name), take) for f in fields(whole)})
    return whole


def question_of(asked: Asked, take: Callable[[Any], Any]) -> Asked:
    """The question put to some cases; what is wrong with a vehicle of one case is said of that vehicle."""

    def taken(label: str, value: Any) -> Any:
        try:
            return part_of(value, take)
        except InputError as error:
            who = f"{label} ({value.name})" if value.name else label
            raise type(error)(f"{who}: {error}", code=error.code, **{**error.fields, "vehicle": label}) from None

    return type(asked)(**{name: taken(name, value) for name, value in asked._asdict().items()})


def place_of(index: Any, shape: tuple[int, ...] | None) -> tuple[int, ...]:
    """An index of one case of a batch of this shape, checked; None is the shape of what is no batch."""
    if shape is None:
        raise ShapeError(
            "impact is one case, and case() takes one of a batch; use it as it is", code="bad_shape", argument="index"
        )
    place = index if isinstance(index, tuple) else (index,)
    whole = all(map(is_whole, place))
    if not whole or len(place) != len(shape) or not all(-size <= at < size for at, size in zip(place, shape, strict=True)):
        wanted = f"a whole number below {shape[0]}" if len(shape) == 1 else f"{len(shape)} whole numbers in a tuple"
        raise InputError(
            f"index must be that of one case in a batch of shape {shape}, {wanted}, got {shown(index)}; write impact.case("
            f"{', '.join(['0'] * len(shape)) if len(shape) == 1 else tuple([0] * len(shape))})",
            code="bad_index",
            argument="index",
        )
    return tuple(int(at) for at in place)
