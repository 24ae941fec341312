"""Results as plain data: nested records for strict JSON that can be solved again, and flat columns for a table."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .arguments import ask
from .eccentric import eccentric
from .errors import InputError, Status
from .fields import attributes
from .impact import Asked, Impact
from .linear import linear_central
from .oblique import oblique_central
from .side import Side
from .vehicle import Vehicle

_FORMAT = "collisions impact 1"
_SOLVERS: dict[str, Callable[..., Impact]] = {
    "linear_central": linear_central,
    "oblique_central": oblique_central,
    "eccentric": eccentric,
}
_STATE = ("mass", "vx", "vy", "yaw_rate", "yaw_inertia", "x", "y", "heading", "pivot", "name")
_NAMED_INFINITIES = {"inf": math.inf, "-inf": -math.inf, "nan": math.nan}


def impact_to_dict(impact: Impact) -> dict[str, Any]:
    """Inputs to solve it again from, and every result to read."""
    asked = impact._asked
    inputs = {name: _plain(getattr(asked, name)) for name in asked._fields if name not in ("a", "b")}
    results = {name: _plain(value) for name, value in _results(impact, Impact) if name not in asked._fields}
    return {
        "format": _FORMAT,
        "inputs": {**inputs, "a": _state(asked.a), "b": _state(asked.b)},
        "results": {**results, "a": _side(impact.a), "b": _side(impact.b)},
    }


def impact_from_dict(record: Mapping[str, Any]) -> Impact:
    """Asks the solver again what the record says it was asked."""
    try:
        if record["format"] != _FORMAT:
            raise InputError(
                f"record['format'] must be {_FORMAT!r}, got {record['format']!r}", code="bad_record", argument="record"
            )
        inputs = record["inputs"]
        solver = _SOLVERS[inputs["model"]]
        sides: dict[str, Any] = {
            side: Vehicle(**{name: _number(value) for name, value in inputs[side].items() if value is not None})
            for side in "ab"
        }
        numbers: dict[str, Any] = {name: _number(inputs[name]) for name in ("restitution", "normal", "bound", "point")}
        asked = Asked(model=inputs["model"], rule=inputs["rule"], law=inputs["law"], **sides, **numbers)
        options = {"on_failure": "nan"} if np.any(np.asarray(_number(record["results"]["status"])) > Status.ENERGY_GAIN) else {}
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"record is not what Impact.to_dict() gives: {type(error).__name__} {error}", code="bad_record", argument="record"
        ) from error
    return ask(solver, asked, **options)


def impact_to_columns(impact: Impact) -> dict[str, list[Any]]:
    """One list a number, named by the path that leads to it; every list has one value a case."""
    columns: dict[str, Any] = {}
    for name, value in _results(impact, Impact):
        _add(columns, name, value)
    for label, side in (("a", impact.a), ("b", impact.b)):
        for moment in ("before", "after", "at_compression"):
            vehicle = getattr(side, moment)
            for name in _STATE:
                _add(columns, f"{label}.{moment}.{name}", getattr(vehicle, name))
        for name, value in _results(side, Side):
            _add(columns, f"{label}.{name}", value)
    shape = np.shape(impact._raw[0])
    return {name: np.broadcast_to(np.asarray(value), shape).reshape(-1).tolist() for name, value in columns.items()}


def _add(columns: dict[str, Any], name: str, value: Any) -> None:
    if isinstance(value, tuple):
        for part, axis in zip(value, "xy", strict=True):
            columns[f"{name}.{axis}"] = part
    elif value is not None:
        columns[name] = value.label if isinstance(value, Status) else value


def _results(owner: Any, kind: type[Any]) -> list[tuple[str, Any]]:
    found = [(name, getattr(owner, name)) for name in attributes(kind)]
    return [(name, value) for name, value in found if not isinstance(value, (Vehicle, Side))]


def _side(side: Side) -> dict[str, Any]:
    found = {name: _plain(value) for name, value in _results(side, Side)}
    return {**found, "after": _state(side.after), "at_compression": _state(side.at_compression)}


def _state(vehicle: Vehicle) -> dict[str, Any]:
    return {name: _plain(getattr(vehicle, name)) for name in _STATE}


def _plain(value: Any) -> Any:
    """Only what strict JSON knows: an infinity and NaN by name, an array with its precision, a pair as a list."""
    if isinstance(value, np.ndarray):
        return {
            "dtype": str(value.dtype),
            "shape": list(value.shape),
            "values": [_plain(v) for v in value.reshape(-1).tolist()],
        }
    if isinstance(value, tuple):
        return [_plain(part) for part in value]
    if isinstance(value, Status):
        return int(value)
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else "inf" if value > 0.0 else "-inf"
    return value


def _number(value: Any) -> Any:
    """What ``_plain`` wrote, read again."""
    if isinstance(value, list):
        return tuple(_number(part) for part in value)
    if isinstance(value, Mapping):
        numbers = [_number(part) for part in value["values"]]
        return np.array(numbers, dtype=value["dtype"]).reshape(value["shape"])
    return _NAMED_INFINITIES.get(value, value) if isinstance(value, str) else value
