"""``to_record``, ``from_record`` and ``to_columns``: results as JSON that can be solved again, and
as flat columns.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Container, Iterator, Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from ..kernels.contact_laws import RULES
from ..kernels.elementwise import UNCHECKED
from ..messages.errors import InputError, Status
from ..messages.hints import nearest
from ..quantities.attributes import attributes, equal, missing_error, read_only, unit_of
from ..quantities.directions import direction
from ..quantities.formatting import KIND_OF, SI_UNITS
from ..quantities.reading import ArgumentReader
from ..quantities.strict_json import strict
from ..quantities.tables import Cells, cells
from ..quantities.units import Texts, rendered, shown
from ..vehicle.tyres import NAMES as TYRES
from ..vehicle.tyres import UNITS as TYRE_UNITS
from ..vehicle.tyres import Tyres, as_given
from ..vehicle.vehicle import DOMAINS, NAMES, Vehicle, moved, vehicle_of, with_given
from .choice import ModelChoice
from .inputs import ARGUMENTS, OUTSIDE, UNITS, Inputs
from .inputs import TYRES as TYRES_OF
from .models import read_again
from .pulse import CURVES, Pulse
from .reconstruction import (
    KNOWN,
    OF_CONTACT,
    AsRecorded,
    Reconstruction,
    number_beside,
    reads_as,
)
from .vehicle_result import VehicleResult

FORMAT = "collisions impact 2"
_LABELS = ("model", "rule", "law")
_OPTIONS = ("geometry", "steps", "incomplete")
# The arguments that not every solver takes, and what stands for one that it does not take.
OF_SOME = dict.fromkeys(name for takes in ARGUMENTS.values() for name in takes if name not in RULES)
_LEFT_OUT = {"incomplete": False}
_CHOICE = ("model", "reason", "errors", "missing", "tolerance")
_NOTHING = dict.fromkeys(NAMES)
_MOMENTS = ("before", "after", "at_compression")
_MOTION = ("vx", "vy", "yaw_rate")
_POLAR: tuple[str, ...] = ("speed", "course")
_INFINITIES = {"inf": math.inf, "-inf": -math.inf, "nan": math.nan}


def to_record(impact: Any) -> dict[str, Any]:
    """A record of an impact: its inputs, each as the text it was given as or else in SI, and every
    result in SI.
    """
    sides = {label: _side(side) for label, side in (("a", impact.a), ("b", impact.b))}
    results = {name: _result(value) for name, value in _results(impact)}
    inputs, origin = _inputs(impact.inputs), impact.reconstruction
    if origin is not None:
        # A unit may be unknown here; the number stands with the reconstruction.
        inputs["known"] = {
            name: text for name, text in inputs["known"].items() if reads_as(text, name, origin)
        }
    return {"format": FORMAT, "inputs": inputs, "results": {**results, **sides}}


def _inputs(inputs: Inputs) -> dict[str, Any]:
    texts = dict(inputs.given or {})
    text = texts.pop("normal", None)
    as_text = isinstance(text, str) and equal(
        direction(ArgumentReader(), text, "normal"), inputs.normal
    )
    return {
        **{name: getattr(inputs, name) for name in (*_LABELS, *_OPTIONS)},
        "a": vehicle_record(inputs.a),
        "b": vehicle_record(inputs.b),
        **{
            name: _given_input(texts, name, getattr(inputs, name), unit)
            for name, unit in UNITS.items()
        },
        **{name: tyres_record(getattr(inputs, name)) for name in TYRES_OF},
        "normal": text if as_text else strict(inputs.normal),
        "bare_normal": strict(inputs.bare_normal),
        "rule_value": as_written(texts.pop(inputs.rule, None), inputs.rule_value, ""),
        "tolerance": strict(inputs.tolerance),
        "contact_velocity": strict(inputs.contact_velocity),
        # The texts that are left are of what a reverse solver was given.
        "known": texts,
    }


def vehicle_record(vehicle: Vehicle) -> dict[str, Any]:
    texts = Texts(vehicle.given)
    found: dict[str, Any] = {"name": vehicle.name}
    for name in DOMAINS:
        found[name] = as_written(
            texts.get(name), getattr(vehicle, name), unit_of(Vehicle, name) or ""
        )
    found["pivot"] = vehicle.pivot and [
        as_written(texts.get(f"pivot[{i}]"), part, "m") for i, part in enumerate(vehicle.pivot)
    ]
    polar = {name: texts[name] for name in _POLAR if name in texts}
    if len(polar) == 2 and _velocity(polar) == (vehicle.vx, vehicle.vy):
        del found["vx"], found["vy"]
        found |= polar
    return found


def tyres_record(tyres: Tyres | None) -> dict[str, Any] | None:
    """The arguments of tyres, each as the text it was given as or else in SI."""
    if tyres is None:
        return None
    found: dict[str, Any] = {}
    for name in TYRES:
        text, value, unit = as_given(tyres, name), getattr(tyres, name), TYRE_UNITS[name]
        found[name] = (
            [as_written(part, one, unit) for part, one in zip(text, value, strict=True)]
            if isinstance(value, tuple)
            else as_written(text, value, unit)
        )
    return found


def tyres_of(found: Mapping[str, Any] | None) -> Tyres | None:
    """The tyres of a record, validated like a caller's."""
    if found is None:
        return None
    if found.keys() != set(TYRES):
        raise bad_record(f"tyres have {', '.join(TYRES)}, and it has {', '.join(map(str, found))}")
    values = {name: read_strict(value) for name, value in found.items()}
    return Tyres(**values)


def _velocity(polar: Mapping[str, str]) -> tuple[Any, Any]:
    moving = Vehicle.from_speed(mass=1.0, **polar)
    return moving.vx, moving.vy


def _given_input(texts: dict[str, Any], name: str, value: Any, unit: Any) -> Any:
    """A number or a pair, or None, each number as the text it was given as; the texts used are
    taken out.
    """
    if isinstance(value, tuple):
        units = unit if isinstance(unit, tuple) else (unit,) * len(value)
        parts = enumerate(zip(value, units, strict=True))
        return [as_written(texts.pop(f"{name}[{i}]", None), part, own) for i, (part, own) in parts]
    return None if value is None else as_written(texts.pop(name, None), value, unit)


def as_written(text: Any, number: Any, unit: str) -> Any:
    """The text a number was given as if it still reads as that number, else the number; a unit may
    be unknown here.
    """
    reader = ArgumentReader()
    if (
        isinstance(text, str)
        and isinstance(number, float)
        and reader.number(text, unit, "", UNCHECKED) == number
    ):
        return text
    return strict(number)


def from_record(record: Mapping[str, Any]) -> tuple[Inputs, str | None, Reconstruction | None, Any]:
    """Read a record: inputs validated like a caller's, ``on_failure``, the reverse solver that
    found it, and its status.
    """
    try:
        if not isinstance(record["format"], str) or record["format"] != FORMAT:
            raise bad_record(f"its format is {shown(record['format'])} and not {FORMAT!r}")
        # A record of a version without tyres has none.
        found = {**dict.fromkeys(TYRES_OF), **record["inputs"]}
        model, rule, law = (found[name] for name in _LABELS)
        if rule not in RULES or not isinstance(model, str):
            raise bad_record(f"its model is {shown(model)} and its rule {shown(rule)}")
        if model not in ARGUMENTS:
            raise bad_record(f"its model is {shown(model)}; known are {', '.join(ARGUMENTS)}")
        stray = [
            name
            for name in OF_SOME
            if name not in ARGUMENTS[model] and found[name] is not _LEFT_OUT.get(name)
        ]
        if stray:
            raise bad_record(f"{model} takes no {stray[0]}")
        status = record["results"]["status"]
        status = (
            np.array(status["values"]).reshape(status["shape"])
            if isinstance(status, Mapping)
            else status
        )
        refused = any(Status(code) > Status.ENERGY_GAIN for code in np.ravel(status).tolist())
        shape = np.shape(status)
        velocity = _pair_of_cases(found["contact_velocity"], "contact_velocity", shape)
        origin = _origin(record["results"]["reconstruction"], velocity, shape)
        if origin is None and velocity is not None:
            raise bad_record("it has a contact_velocity, and no reverse solver that found one")
        a, b = (vehicle_of_record(found[label], refused and origin is not None) for label in "ab")
        given: dict[str, Any] = _texts(found["known"], origin)
        if found["bare_normal"] is not None:
            given["normal"] = _bare_normal(found)
        numbers = {
            name: read_strict(found[name])
            for name in ("normal", "rule_value", "tolerance", *UNITS, *_OPTIONS)
        }
        numbers |= {name: tyres_of(found[name]) for name in TYRES_OF}
        inputs = Inputs(
            model=model,
            a=a,
            b=b,
            rule=rule,
            law=law,
            given=given,
            contact_velocity=velocity,
            **numbers,
        )
        inputs = read_again(inputs, found=origin is not None)
        _check_texts(found, inputs, record["results"])
    except InputError:
        raise
    except Exception as error:
        raise bad_record(f"{type(error).__name__} {error}") from error
    return inputs, "nan" if refused else None, origin, status


def _bare_normal(found: Mapping[str, Any]) -> Any:
    """The angle that the normal was given as, a number, which must have its direction."""
    reader = ArgumentReader()
    bare = reader.number(read_strict(found["bare_normal"]), "", "bare_normal")
    reader.close()
    fits = not isinstance(found["normal"], str)
    if fits and np.shape(bare) != np.shape(read_strict(found["normal"][0])):
        raise bad_record(
            f"its bare_normal has the shape {np.shape(bare)}, which is not that of its normal"
        )
    if fits:
        # To the digits of float32. The angle of a refused case may have no direction.
        with np.errstate(invalid="ignore"):
            near = 1e-6 * (1.0 + np.abs(bare))
            turned = np.cos(bare), np.sin(bare)
            fits = all(
                np.all((np.abs(np.subtract(one, part)) <= near) | ~np.isfinite(bare))
                for one, part in zip(turned, read_strict(found["normal"]), strict=True)
            )
    if not fits:
        raise bad_record("its bare_normal is not the angle of its normal")
    return bare


def _check_texts(found: Mapping[str, Any], inputs: Inputs, results: Mapping[str, Any]) -> None:
    """Refuse a text that reads as another number here than it did where the record was written:
    units can be redefined.
    """
    written = [
        (name, found[name], getattr(inputs, name), results[name])
        for name in ("normal", *UNITS)
        if name in results
    ]
    for label, name in zip("ab", OUTSIDE, strict=True):
        then = [results[label][f"outside_{part}"] for part in ("x", "y", "yaw")]
        written.append((name, found[name], getattr(inputs, name) or (), then))
    for label, vehicle in (("a", inputs.a), ("b", inputs.b)):
        texts = {name: text for name, text in found[label].items() if name != "name"}
        if _POLAR[0] in texts:
            texts["vx"] = texts["vy"] = " at ".join(map(texts.pop, _POLAR))
        before = results[label]["before"]
        written += [
            (f"{label}.{name}", text, getattr(vehicle, name), before[name])
            for name, text in texts.items()
        ]
    for name, texts, numbers, then in written:
        pair = isinstance(numbers, tuple)
        for i, number in enumerate(numbers if pair else (numbers,)):
            text, was = (
                (texts[i] if isinstance(texts, list) else texts),
                read_strict(then[i] if pair else then),
            )
            # An angle in radians may come out by the last bit of another machine's sine.
            if (
                isinstance(text, str)
                and text not in _INFINITIES
                and not math.isclose(number, was, rel_tol=1e-12)
            ):
                raise bad_record(
                    f"{name} was given as {shown(text)}, which is {was!r} in its results but "
                    f"{number!r} here; the text was changed (to solve with another value write "
                    "again()), or its unit means something else in this registry"
                )


def _origin(found: Any, velocity: Any, shape: tuple[int, ...]) -> Reconstruction | None:
    if found is None:
        return None
    known = tuple(str(name) for name in found["known"])
    condition: Any = read_only(read_strict(found["condition"]))
    answers = _count(found["answers"])
    if np.asarray(condition).dtype.kind not in "fi":
        raise bad_record(f"its condition is {shown(found['condition'])}, which is no number")
    method = str(found["method"])
    return AsRecorded(
        method=method,
        known=known,
        condition=condition,
        answers=answers,
        contact_velocity=velocity,
        regime=_stated(found.get("regime")),
        one_sided=_sides(found.get("one_sided")),
        left_backwards=_count_or_none(found.get("left_backwards")),
        slip_if_stuck=_pair_of_cases(found.get("slip_if_stuck"), "slip_if_stuck", shape),
        misfit=_number_if_known(found.get("misfit"), "misfit", False),
        found=tuple(str(name) for name in found["found"]),
        given=_given_numbers(found["given"]),
        **{
            name: _number_if_known(found.get(name), name, known_as in known)
            for known_as, name in OF_CONTACT.items()
        },
    )


def _number_if_known(found: Any, name: str, known: bool) -> Any:
    """What was known of a contact with a duration, a number or a batch; None where it was not."""
    number = read_strict(found)
    given = isinstance(number, np.ndarray) or _is_number(number)
    if not (given or (number is None and not known)):
        raise bad_record(
            f"{name} of its reconstruction is {shown(found)}, and is {'' if known else 'not '}"
            "among what was known"
        )
    return float(number) if _is_number(number) else read_only(number)


def _given_numbers(found: Any) -> dict[str, Any]:
    """The numbers that a reverse solver was given, by name."""
    if not isinstance(found, Mapping):
        raise bad_record(f"{shown(found)} is not what a reverse solver was given, by name")
    numbers = {str(name): read_strict(value) for name, value in found.items()}
    for name, number in numbers.items():
        if not (isinstance(number, np.ndarray) or _is_number(number)):
            raise bad_record(f"{name}, which a reverse solver was given, is {shown(number)}")
    return {
        name: read_only(number) if isinstance(number, np.ndarray) else float(number)
        for name, number in numbers.items()
    }


def _stated(found: Any) -> str | None:
    if found not in (None, "sticking", "sliding"):
        raise bad_record(f"a contact is stated to be sticking or sliding, not {shown(found)}")
    return None if found is None else str(found)


def _sides(found: Any) -> dict[str, Any] | None:
    """Which way the truth may lie from each speed: 1, -1 or 0, or a batch of these."""
    if found is None:
        return None
    if not isinstance(found, Mapping) or {*found} != {"speed_a", "speed_b"}:
        raise bad_record(f"{shown(found)} does not say on which side each speed may lie")
    sides = {name: _count(value) for name, value in found.items()}
    if not all(np.isin(side, (-1, 0, 1)).all() for side in sides.values()):
        raise bad_record(f"{shown(found)} has a side that is neither 1, -1 nor 0")
    return sides


def _pair_of_cases(pair: Any, name: str, shape: tuple[int, ...]) -> Any:
    """Two numbers that a reverse solver found, such as closing speed and slip before: one of each,
    or one for every case; None where it found none.
    """
    if pair is None:
        return None
    numbers = tuple(map(read_strict, pair)) if isinstance(pair, list | tuple) else ()
    if len(numbers) != 2 or not all(
        isinstance(part, np.ndarray) or _is_number(part) for part in numbers
    ):
        raise bad_record(f"its {name} is {shown(pair)}, which are no numbers")
    if any(np.shape(part) != shape for part in numbers):
        raise bad_record(f"its {name} is not that of its cases")
    return read_only(
        tuple(part if isinstance(part, np.ndarray) else float(part) for part in numbers)
    )


def _texts(known: Mapping[str, Any], origin: Reconstruction | None) -> dict[str, str]:
    stray = known.keys() - {
        name for name, one in KNOWN.items() if origin is not None and origin.method in one.methods
    }
    if stray:
        raise bad_record(f"it has no {shown(min(stray))} that could have been given")
    if not all(isinstance(text, str) for text in known.values()):
        raise bad_record("what its reverse solver was given is no dict of texts")
    for name, text in known.items():
        if origin is not None and not reads_as(text, name, origin):
            number, unit = number_beside(origin, name), SI_UNITS[KNOWN[name].kind]
            then = f", {shown(number)} {unit}".rstrip() if number is not None else " here"
            raise bad_record(
                f"{name} was given as {shown(text)}, which is not its number{then}; the text was "
                "changed (to solve with another value call the reverse solver again), or its unit "
                "means something else in this registry"
            )
    return dict(known)


def vehicle_of_record(found: Mapping[str, Any], lost: bool = False) -> Vehicle:
    """A vehicle from its record; NaN, the motion that a reverse solver did not find, bypasses the
    reader.
    """
    state = {
        name: value if name == "name" else read_strict(value)
        for name, value in found.items()
        if value is not None
    }
    polar = {name: state.pop(name) for name in _POLAR if name in state}
    unknown = state.keys() - set(NAMES)
    if unknown:
        raise bad_record(f"a vehicle has no {min(unknown)!r}")
    if polar:
        state |= zip(("vx", "vy"), _velocity(polar), strict=True)
    motion = [state[name] for name in _MOTION]
    if lost and not any(isinstance(part, (np.ndarray, str)) for part in motion):
        vx, vy, yaw_rate = map(float, motion)
        return moved(vehicle_of(_NOTHING | state | dict.fromkeys(_MOTION, 0.0)), vx, vy, yaw_rate)
    vehicle = vehicle_of(_NOTHING | state)
    return with_given(vehicle, {**(vehicle.given or {}), **polar}) if polar else vehicle


def to_columns(impact: Any, units: Any = None, wanted: Any = None) -> dict[str, list[Any]]:
    """One list per number, named by its path in the record; every list has one value per case."""
    system = None if units is None else cells(units)
    names = None if wanted is None else _listed(wanted)
    found = _numbers(impact, names)
    if names is None:
        names = list(found)
    elif any(not isinstance(name, str) or name not in found for name in names):
        raise _no_column(impact, names)
    return dict(_column(name, *found[name], system, np.shape(impact.status)) for name in names)


def _numbers(impact: Any, names: Collection[Any] | None) -> dict[str, tuple[Any, str | None]]:
    """Every number of an impact by the name of its column, with its unit; or those of these names,
    as an answer that is not asked for takes time, and stays with the impact.
    """
    needed: Container[str] | None = None
    if names is not None:
        paths = [name.split(".") for name in names if isinstance(name, str)]
        needed = {".".join(path[:end]) for path in paths for end in range(1, len(path) + 1)}
    found: dict[str, tuple[Any, str | None]] = {}
    for name, value in _results(impact, needed):
        _add(found, name, value, unit_of(type(impact), name))
    if needed is None or "status" in needed:
        found["status"] = np.array([status.label for status in Status])[impact.status], None
    found[impact.inputs.rule] = impact.inputs.rule_value, ""
    for label, side in (("a", impact.a), ("b", impact.b)):
        for moment in _MOMENTS:
            if needed is not None and f"{label}.{moment}" not in needed:
                continue
            vehicle = getattr(side, moment)
            for name in NAMES:
                _add(
                    found,
                    f"{label}.{moment}.{name}",
                    getattr(vehicle, name),
                    unit_of(Vehicle, name),
                )
        for name, value in _results(side, needed, f"{label}."):
            _add(found, f"{label}.{name}", value, unit_of(VehicleResult, name))
    return found


def _listed(wanted: Any) -> list[Any]:
    """The names that were asked for, of one column or of several."""
    # An array of no dimensions is one thing, though it has the methods of a collection.
    several = isinstance(wanted, Collection | Iterator) and getattr(wanted, "ndim", 1) != 0
    return list(wanted) if several and not isinstance(wanted, str) else [wanted]


def _no_column(impact: Any, names: Sequence[Any]) -> InputError:
    """The error for the first of these names that no column has."""
    found = _numbers(impact, None)
    name = next(one for one in names if not isinstance(one, str) or one not in found)
    if isinstance(name, str):
        side, _, inner = name.rpartition(".")
        owner = getattr(impact, side) if side in ("a", "b") else impact
        if inner in attributes(type(owner)):
            text = f"columns: {name} has no value in this impact; leave it out"
            problem = missing_error(owner, inner) if isinstance(owner, VehicleResult) else None
            return problem or InputError(text, code="unknown_name", argument="columns")
    near = nearest(rendered(name), found, 3, 0.6) or list(found)[:3]
    return InputError(
        f"columns: there is no column {shown(name)}; write for example "
        f"{', '.join(near)}, without a unit",
        code="unknown_name",
        argument="columns",
    )


def _column(
    name: str, value: Any, unit: str | None, system: Cells | None, shape: tuple[int, ...]
) -> tuple[str, list[Any]]:
    """A column with its name, in a system of units if one is given."""
    numbers = np.asarray(value)
    if system is not None and unit:
        kind = KIND_OF.get(unit)
        with np.errstate(over="ignore"):
            numbers = numbers if kind is None else numbers * system.scale(kind)
        name = f"{name} [{unit if kind is None else system.label(kind)}]"
    return name, np.broadcast_to(numbers, shape).reshape(-1).tolist()


def bad_record(why: str) -> InputError:
    return InputError(
        f"record is not what Impact.to_dict() gives: {why}", code="bad_record", argument="record"
    )


def _add(found: dict[str, tuple[Any, str | None]], name: str, value: Any, unit: str | None) -> None:
    if isinstance(value, tuple):
        for part, axis in zip(value, "xy", strict=True):
            found[f"{name}.{axis}"] = part, unit
    elif isinstance(value, Reconstruction):
        found[f"{name}.condition"] = value.condition, ""
        found[f"{name}.answers"] = value.answers, None
        for inner, own in (("duration", "s"), ("drag_a", ""), ("drag_b", "")):
            if getattr(value, inner) is not None:
                found[f"{name}.{inner}"] = getattr(value, inner), own
        sides = value.one_sided or {}
        found |= {f"{name}.one_sided.{speed}": (side, None) for speed, side in sides.items()}
    elif isinstance(value, Pulse):
        numbers = {f.name: getattr(value, f.name) for f in fields(value) if f.name not in CURVES}
        found |= {
            f"{name}.{inner}": (part, unit_of(Pulse, inner))
            for inner, part in numbers.items()
            if part is not None
        }
    elif isinstance(value, ModelChoice):
        found[f"{name}.tolerance"] = value.tolerance, "m/s"
        found |= {f"{name}.errors.{model}": (error, "m/s") for model, error in value.errors.items()}
    elif value is not None:
        found[name] = value, unit


def _results(
    owner: Any, needed: Container[str] | None = None, of: str = ""
) -> list[tuple[str, Any]]:
    """What was answered, by name; of that only what is needed, by its path."""
    found = [
        (name, getattr(owner, name))
        for name in attributes(type(owner))
        if needed is None or f"{of}{name}" in needed
    ]
    return [
        (name, value) for name, value in found if not isinstance(value, (Vehicle, VehicleResult))
    ]


def _side(side: VehicleResult) -> dict[str, Any]:
    moments = {moment: getattr(side, moment) for moment in _MOMENTS}
    states = {
        moment: {name: strict(getattr(vehicle, name)) for name in NAMES}
        for moment, vehicle in moments.items()
    }
    return {**states, **{name: _result(value) for name, value in _results(side)}}


def _result(value: Any) -> Any:
    """A result as strict JSON: a choice, a reconstruction and a pulse by their parts."""
    if isinstance(value, ModelChoice):
        return {name: strict(getattr(value, name)) for name in _CHOICE}
    if isinstance(value, (Reconstruction, Pulse)):
        return {f.name: strict(getattr(value, f.name)) for f in fields(value)}
    return strict(value)


def _count_or_none(value: Any) -> Any:
    """A number of answers, or one for each case; None where none were left out."""
    if value is None:
        return None
    count = _count(value)
    if not np.all(np.asarray(count) >= 0):
        raise bad_record(f"{shown(value)} is no number of answers")
    return count


def _count(value: Any) -> Any:
    """An integer, or a batch of them, as ``strict`` wrote it."""
    if isinstance(value, Mapping):
        counts = [_count(count) for count in value["values"]]
        return read_only(np.array(counts, dtype=np.int64).reshape(value["shape"]))
    if value == "inf":
        return math.inf
    if type(value) is not int:  # int() would read "1_0" as 10, and cut 2.7 to 2
        raise bad_record(f"{shown(value)} is no whole number")
    return value


def _is_number(value: Any) -> bool:
    return isinstance(value, (float, int)) and not isinstance(value, bool)


def read_strict(value: Any) -> Any:
    """The value that ``strict`` wrote; a text with a unit stays a text."""
    if isinstance(value, list):
        return tuple(read_strict(part) for part in value)
    if isinstance(value, Mapping):
        if value["dtype"] not in ("float32", "float64"):
            raise bad_record(f"an array of {shown(value['dtype'])} is none that to_dict writes")
        numbers = [read_strict(part) for part in value["values"]]
        # numpy would read the text "1_0" as 10, True as 1 and None as NaN.
        if wrong := [part for part in numbers if not _is_number(part)]:
            raise bad_record(f"{shown(wrong[0])} in an array is no number")
        return np.array(numbers, dtype=value["dtype"]).reshape(value["shape"])
    return _INFINITIES.get(value, value) if isinstance(value, str) else value
