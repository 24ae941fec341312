"""Results as plain data: nested records for strict JSON that can be asked again, and flat columns for a table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from .amounts import amount
from .directions import direction, from_radians
from .errors import InputError, Status
from .inputs import Inputs
from .kernels.contact_laws import RULES
from .model_choice import ModelChoice
from .models import MODELS, checked
from .provenance import Reconstruction
from .quantities import attributes, lock
from .reading import ArgumentReader
from .side import Side
from .units import shown
from .vehicle import NAMES, Vehicle

FORMAT = "collisions impact 1"
_NOTHING = dict.fromkeys(NAMES)
_NUMBERS = ("restitution", "normal", "rule_value", "point")
_MOTION = ("vx", "vy", "yaw_rate")
_LABELS = ("model", "rule", "law")
_GIVEN = "given_as"  # texts, and a normal of more than a turn as the number without a unit that it was
_SOLVERS = (*(model.name for model in MODELS), "solve")
_CHOICE = ("model", "reason", "errors", "missing", "tolerance")
# What a reverse solver may be told beside the contact, by its name.
_ENDS = tuple(f"{label}_after.{name}" for label in "ab" for name in ("vx", "vy", "speed", "course", "yaw_rate"))
_PAIRS = tuple(f"{name}_{label}" for name in ("speed", "course", "delta_v", "ees") for label in "ab")
_TOLD = {
    "central": ("va_after", "vb_after", "energy_loss"),
    "planar": (*_ENDS, "closing_speed", "energy_loss"),
    "speeds": (*_PAIRS, "energy_loss"),
}
_SAME = 1e-5  # between cosines and sines of one angle, also in float32
_READ = 2e-9  # relative, between a number and the text it was given as, which is read by the same rules
_INFINITIES = {"inf": math.inf, "-inf": -math.inf, "nan": math.nan}


def to_record(impact: Any) -> dict[str, Any]:
    """Inputs to ask it again from, and every result to read."""
    asked = impact.inputs
    inputs = {name: _strict(getattr(asked, name)) for name in (*_LABELS, *_NUMBERS)}
    if asked.given is not None:
        inputs[_GIVEN] = _strict(asked.given)
    results = {name: _strict(value) for name, value in _results(impact) if name not in inputs}
    return {
        "format": FORMAT,
        "inputs": {**inputs, "a": _state(asked.a), "b": _state(asked.b)},
        "results": {**results, "a": _side(impact.a), "b": _side(impact.b)},
    }


def from_record(record: Mapping[str, Any]) -> tuple[Inputs, str | None, Reconstruction | None, Any]:
    """The inputs of a record, read as a caller's are, what to do on failure, what found it, and its status."""
    try:
        if not isinstance(record["format"], str) or record["format"] != FORMAT:
            raise bad_record(f"its format is {shown(record['format'])} and not {FORMAT!r}")
        found = record["inputs"]
        question = {name: found[name] for name in _LABELS} | {name: _number(found[name]) for name in _NUMBERS}
        model, rule = question["model"], question["rule"]
        if rule not in RULES or not isinstance(model, str):
            raise bad_record(f"its model is {shown(model)} and its rule {shown(rule)}")
        if model not in _SOLVERS:
            raise bad_record(f"its model is {shown(model)}; known are {', '.join(_SOLVERS)}")
        status = record["results"]["status"]
        listed = status["values"] if isinstance(status, Mapping) else [status]
        refused = any(Status(code) > Status.ENERGY_GAIN for code in listed)
        choice = record["results"]["choice"]
        origin = record["results"]["reconstruction"]
        given = None
        if _GIVEN in found:
            # A reverse solver that gave no answer does not hold all that it was told.
            lost = np.array(listed) > Status.ENERGY_GAIN if origin is not None else np.zeros(len(listed), dtype=bool)
            lost = lost.reshape(status["shape"] if isinstance(status, Mapping) else ())
            given = _given(found[_GIVEN], question, "" if origin is None else str(origin["method"]), lost)
        if origin is not None:
            known = tuple(str(name) for name in origin["known"])
            condition, answers = _number(origin["condition"]), _count(origin.get("answers", 1))
            status = np.array(listed).reshape(status["shape"]) if isinstance(status, Mapping) else status
            velocity = _contact_velocity(origin.get("contact_velocity"), np.shape(status))
            origin = Reconstruction(
                method=str(origin["method"]), known=known, condition=condition, answers=answers, contact_velocity=velocity
            )
        vehicles = []
        for side in "ab":
            state = {name: _number(value) for name, value in found[side].items() if value is not None and name != "name"}
            vehicles.append(_vehicle({**_NOTHING, **state, "name": found[side]["name"]}, refused and origin is not None))
        reader = ArgumentReader()
        tolerance = None if choice is None else amount(reader, _number(choice["tolerance"]), "m/s", "tolerance")
        reader.close()
        point, law = question["point"], question["law"]
        a, b = vehicles
        contact = question["restitution"], question["normal"], rule, question["rule_value"]
        velocity = None if origin is None else origin.contact_velocity
        inputs = checked(Inputs(model, a, b, *contact, law, point, given, tolerance, velocity), found=origin is not None)
    except InputError:
        raise
    except Exception as error:
        raise bad_record(f"{type(error).__name__} {error}") from error
    return inputs, "nan" if refused else None, origin, status


def _contact_velocity(pair: Any, shape: tuple[int, ...]) -> Any:
    """Closing speed and slip before as a reverse solver found them, one each or one for every case."""
    if pair is None:
        return None
    closing, slip = (_number(part) if isinstance(part, Mapping) else float(_number(part)) for part in pair)
    if not np.shape(closing) == np.shape(slip) == shape:
        raise bad_record("its contact_velocity is not that of its cases")
    return closing, slip


def _given(record: Mapping[str, Any], question: Mapping[str, Any], method: str, lost: Any) -> dict[str, Any]:
    """How the inputs were given; what is told of the contact must give its numbers, but in cases that are lost."""
    given = {str(name): text if isinstance(text, str) else lock(_number(text)) for name, text in record.items()}
    if not all(isinstance(text, str) for name, text in given.items() if name != "normal"):
        raise bad_record("how its inputs were given is no dict of texts")
    numbers = {"restitution": (question["restitution"], ""), "normal": (question["normal"], "rad")}
    if question["law"] is not None:
        numbers[question["rule"]] = question["rule_value"], ""
    numbers |= {f"point[{i}]": (part, "m") for i, part in enumerate(question["point"] or ())}
    stray = [name for name in given if name not in numbers and name not in _TOLD.get(method, ())]
    if stray:
        raise bad_record(f"it has no {shown(stray[0])} that could have been given")
    for name, text in given.items():
        if name not in numbers:
            continue
        reader = ArgumentReader()
        number, kind = numbers[name]
        unit = ""
        if name != "normal":
            read: Any = reader.number(text, kind, name)
        elif isinstance(text, str):
            read = direction(reader, text, name)
        else:
            read, unit = from_radians(text), " rad"
        # A unit of another registry cannot be read here.
        if reader.problems:
            continue
        off = _SAME if name == "normal" else 0.0
        parts = zip(read, number, strict=True) if name == "normal" else [(read, number)]
        if not all(np.all(np.isclose(*both, rtol=_READ, atol=off, equal_nan=True) | lost) for both in parts):
            raise bad_record(f"its {name}, {shown(number)}, is not that of {shown(text)}{unit}, as which it was given")
    return given


def _vehicle(state: dict[str, Any], lost: bool) -> Vehicle:
    """A vehicle again; the reader takes no NaN, which is the motion of one that was looked for and not found."""
    unknown = state.keys() - set(NAMES)
    if unknown:
        raise bad_record(f"a vehicle has no {min(unknown)!r}")
    motion = [state[name] for name in _MOTION]
    if not lost or any(isinstance(part, np.ndarray) for part in motion):
        return Vehicle._of_numbers(state)
    return Vehicle._of_numbers(state | dict.fromkeys(_MOTION, 0.0))._moved(*map(float, motion))


def to_columns(impact: Any) -> dict[str, list[Any]]:
    """One list a number, named by the path that leads to it; every list has one value a case."""
    columns: dict[str, Any] = {}
    for name, value in _results(impact):
        _add(columns, name, value)
    columns["status"] = np.array([status.label for status in Status])[impact._raw.status]
    columns[impact.inputs.rule] = impact.inputs.rule_value
    for label, side in (("a", impact.a), ("b", impact.b)):
        for moment in ("before", "after", "at_compression"):
            vehicle = getattr(side, moment)
            for name in NAMES:
                _add(columns, f"{label}.{moment}.{name}", getattr(vehicle, name))
        for name, value in _results(side):
            _add(columns, f"{label}.{name}", value)
    shape = np.shape(impact._raw.status)
    return {name: np.broadcast_to(np.asarray(value), shape).reshape(-1).tolist() for name, value in columns.items()}


def bad_record(why: str) -> InputError:
    return InputError(f"record is not what Impact.to_dict() gives: {why}", code="bad_record", argument="record")


def _add(columns: dict[str, Any], name: str, value: Any) -> None:
    if isinstance(value, tuple):
        for part, axis in zip(value, "xy", strict=True):
            columns[f"{name}.{axis}"] = part
    elif isinstance(value, Reconstruction):
        columns[f"{name}.condition"] = value.condition
        columns[f"{name}.answers"] = value.answers
    elif isinstance(value, ModelChoice):
        columns[f"{name}.tolerance"] = value.tolerance
        columns |= {f"{name}.errors.{model}": error for model, error in value.errors.items()}
    elif value is not None:
        columns[name] = value


def _results(owner: Any) -> list[tuple[str, Any]]:
    found = [(name, getattr(owner, name)) for name in attributes(type(owner))]
    return [(name, value) for name, value in found if not isinstance(value, (Vehicle, Side))]


def _side(side: Side) -> dict[str, Any]:
    found = {name: _strict(value) for name, value in _results(side)}
    return {**found, "after": _state(side.after), "at_compression": _state(side.at_compression)}


def _state(vehicle: Vehicle) -> dict[str, Any]:
    return {name: _strict(getattr(vehicle, name)) for name in NAMES}


def _strict(value: Any) -> Any:
    """Only what strict JSON knows: an infinity and NaN by name, an array with its precision, a pair as a list."""
    if isinstance(value, np.ndarray):
        return {
            "dtype": str(value.dtype),
            "shape": list(value.shape),
            "values": [_strict(v) for v in value.reshape(-1).tolist()],
        }
    if isinstance(value, tuple):
        return [_strict(part) for part in value]
    if isinstance(value, Status):
        return int(value)
    if isinstance(value, ModelChoice):
        return {name: _strict(getattr(value, name)) for name in _CHOICE}
    if isinstance(value, Reconstruction):
        return {f.name: _strict(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, Mapping):
        return {name: _strict(part) for name, part in value.items()}
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else "inf" if value > 0.0 else "-inf"
    return value


def _count(value: Any) -> Any:
    """A whole number, or a batch of them, as ``_strict`` wrote it."""
    if isinstance(value, Mapping):
        return lock(np.array([int(count) for count in value["values"]], dtype=np.int64).reshape(value["shape"]))
    return math.inf if value == "inf" else int(value)


def _number(value: Any) -> Any:
    """What ``_strict`` wrote, read again."""
    if isinstance(value, list):
        return tuple(_number(part) for part in value)
    if isinstance(value, Mapping):
        if value["dtype"] not in ("float32", "float64"):
            raise bad_record(f"an array of {shown(value['dtype'])} is none that to_dict writes")
        numbers = [_number(part) for part in value["values"]]
        return np.array(numbers, dtype=value["dtype"]).reshape(value["shape"])
    return _INFINITIES.get(value, value) if isinstance(value, str) else value
