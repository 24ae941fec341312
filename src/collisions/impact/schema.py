"""``impact_schema``: the JSON schema of an impact's record, generated from the attributes so that
the two cannot disagree.
"""

from __future__ import annotations

from copy import deepcopy
from dataclasses import Field, fields
from inspect import getdoc
from typing import Any, get_args

from ..kernels.contact_laws import LAWS, RULES
from ..messages.errors import Status
from ..quantities.attributes import attributes
from ..quantities.json_schema import (
    NULL,
    TEXT,
    array_of,
    closed,
    described,
    or_null,
    schema_of,
)
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle
from .impact import Impact
from .inputs import ARGUMENTS, PLACED, TYRES, UNITS, Inputs
from .models import BY_NAME
from .pulse import Pulse
from .reconstruction import Reconstruction
from .records import FORMAT, OF_SOME
from .time_resolved_inputs import Geometry
from .vehicle_result import VehicleResult

__all__ = ["impact_schema"]

_MODELS = list(BY_NAME)
_VALUE, _PAIR, _GIVEN = ({"$ref": f"#/$defs/{name}"} for name in ("value", "pair", "given"))
_NUMBER = {"$ref": "#/$defs/number"}


def _pair(value: dict[str, Any]) -> dict[str, Any]:
    return {
        "description": "The x and the y part.",
        "type": "array",
        "prefixItems": [value, value],
        "items": False,
        "minItems": 2,
    }


# By declared type: of results, in which a field of any type is an array over time that a batch has
# not; and of inputs, which may be texts.
_RESULTS: dict[str, dict[str, Any]] = {
    "Value": _VALUE,
    "Any": {"anyOf": [_VALUE, NULL]},
    "tuple[Value, Value]": _PAIR,
    "str": TEXT,
    "Law": TEXT,
    **{
        name: {"$ref": f"#/$defs/{key}"}
        for name, key in (
            ("ModelChoice", "choice"),
            ("Reconstruction", "reconstruction"),
            ("Pulse", "pulse"),
            ("Vehicle", "vehicle"),
            ("VehicleResult", "side"),
        )
    },
}
_GIVEN_AS: dict[str, dict[str, Any]] = {
    "Value": _GIVEN,
    "str": TEXT,
    "tuple[Value, Value]": _pair(_GIVEN),
    "tuple[Value, ...]": array_of(_GIVEN, 3),
    "tuple[Value, Value, Value, Value]": array_of(_GIVEN, 4),
}


def impact_schema() -> dict[str, Any]:
    """The JSON schema (draft 2020-12) of the record from ``Impact.to_dict``, as a new dict that may
    be changed.

    It covers every solver, single cases, batches and refused cases. Infinity and NaN appear in a
    record as the texts "inf", "-inf" and "nan", because JSON has no number for them. It does not
    say that the arrays of a batch go together, nor that the results are those of the inputs;
    ``Impact.from_dict`` checks the former and works out the latter anew.

    Returns
    -------
    dict
        The schema.

    Examples
    --------
    >>> schema = impact_schema()
    >>> schema["properties"]["format"]
    {'const': 'collisions impact 2'}
    >>> schema["$defs"]["vehicle"]["properties"]["mass"]
    {'$ref': '#/$defs/value', 'description': '[kg]'}
    """
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": f"urn:{FORMAT.replace(' ', ':')}",
        "title": "Record of an impact",
        "description": (
            "What Impact.to_dict() gives: inputs to solve again from, and every result; SI, "
            "angles in radians."
        ),
        **closed(
            {"format": {"const": FORMAT}, "inputs": _inputs(), "results": _attributes(Impact)}
        ),
        "$defs": {
            "number": {
                "description": "A number; an infinity and NaN by name.",
                "anyOf": [{"type": "number"}, {"enum": ["inf", "-inf", "nan"]}],
            },
            "value": {
                "description": "A number, or one for each case of a batch, in the order of C.",
                "anyOf": [_NUMBER, _batch(_NUMBER, {"enum": ["float32", "float64"]})],
            },
            "given": {
                "description": (
                    "A number or a batch in SI, or the text with a unit that it was given as."
                ),
                "anyOf": [_VALUE, TEXT],
            },
            "pair": _pair(_VALUE),
            "vehicle": _fields(Vehicle, _RESULTS),
            "vehicle_inputs": _vehicle_inputs(),
            "side": _attributes(VehicleResult),
            "choice": closed(
                {
                    "model": _each({"enum": _MODELS}),
                    "reason": TEXT,
                    "errors": _by_model(_VALUE),
                    "missing": _by_model({"type": "array", "items": TEXT}),
                    "tolerance": {**_VALUE, "description": "[m/s]"},
                }
            ),
            "tyres": _fields(Tyres, _GIVEN_AS),
            "pulse": _fields(Pulse, _RESULTS),
            "reconstruction": closed(
                {f.name: _RECONSTRUCTION[f.name] for f in fields(Reconstruction)},
            ),
        },
    }
    return deepcopy(schema)


def _inputs() -> dict[str, Any]:
    """The inputs of every solver."""
    vehicle = {"$ref": "#/$defs/vehicle_inputs"}
    question = closed(
        {
            "model": {"enum": sorted(ARGUMENTS), "description": "The solver that was called."},
            "rule": {"enum": list(RULES), "description": "What was said of the tangent, ..."},
            "law": {"enum": [*LAWS, None]},
            "a": vehicle,
            "b": vehicle,
            **{name: _field(Inputs.__dataclass_fields__[name], _GIVEN_AS) for name in UNITS},
            **{
                name: or_null({"$ref": "#/$defs/tyres"}, "The wheels of a vehicle.")
                for name in TYRES
            },
            "geometry": {
                "enum": [*get_args(Geometry), None],
                "description": "Of time_resolved: what the positions are.",
            },
            "steps": {
                "type": ["integer", "null"],
                "description": "Of time_resolved: steps a nominal duration.",
            },
            "normal": {
                "anyOf": [_PAIR, TEXT],
                "description": "Unit vector from A into B, or its angle as given.",
            },
            "bare_normal": or_null(
                _VALUE,
                "The normal as an angle of more than a turn that was given without a unit [rad].",
            ),
            "rule_value": {**_GIVEN, "description": "... and its value."},
            "tolerance": or_null(_VALUE, "Of solve [m/s]."),
            "incomplete": {
                "type": "boolean",
                "description": "Whether a restitution below 0 was allowed.",
            },
            "contact_velocity": or_null(
                _PAIR, "Closing speed and slip before as a reverse solver found them [m/s]."
            ),
            "known": {
                "type": "object",
                "additionalProperties": TEXT,
                "description": "What a reverse solver was given with a unit, by its argument.",
            },
        }
    )
    return question | {"allOf": [_of_solver(name, takes) for name, takes in ARGUMENTS.items()]}


def _of_solver(name: str, takes: tuple[str, ...]) -> dict[str, Any]:
    """The inputs of one solver: none that it does not take, and those that it needs."""
    needed = {"law": TEXT} if "law" in takes else {}
    needed |= {"point": {"type": "array"}} if name in PLACED else {}
    properties = {
        argument: {"enum": [None, False]} for argument in sorted(OF_SOME.keys() - takes)
    } | needed
    return {"if": {"properties": {"model": {"const": name}}}, "then": {"properties": properties}}


def _attributes(kind: type[Any]) -> dict[str, Any]:
    """Every attribute of an impact or a side: by its name in ``_LISTED`` or its declared type,
    described by its docstring.
    """
    found = {}
    for name in attributes(kind):
        attribute = vars(kind)[name]
        declared = attribute.work_out.__annotations__["return"]
        first = (getdoc(attribute) or "").partition("\n\n")[0].replace("\n", " ")
        found[name] = {
            **(_LISTED[name] if name in _LISTED else schema_of(declared, _RESULTS)),
            "description": first,
        }
    return closed(found)


def _vehicle_inputs() -> dict[str, Any]:
    """The fields of a vehicle as they were given; speed and course may stand in place
    of vx and vy.
    """
    found = _fields(Vehicle, _GIVEN_AS)["properties"]
    needed = [name for name in found if name not in ("vx", "vy")]
    return {
        **closed(found | {"speed": TEXT, "course": TEXT}, needed),
        "oneOf": [{"required": ["vx", "vy"]}, {"required": ["speed", "course"]}],
        "dependentRequired": {"speed": ["course"], "course": ["speed"]},
    }


def _fields(kind: type[Any], types: dict[str, dict[str, Any]]) -> dict[str, Any]:
    """An object with the fields of a dataclass."""
    return closed({f.name: _field(f, types) for f in fields(kind)})


def _field(field: Field[Any], types: dict[str, dict[str, Any]]) -> dict[str, Any]:
    """The schema of a field with its unit."""
    return described(schema_of(str(field.type), types), unit=field.metadata.get("unit"))


def _by_model(value: dict[str, Any]) -> dict[str, Any]:
    return {"type": "object", "propertyNames": {"enum": _MODELS}, "additionalProperties": value}


def _batch(value: dict[str, Any], dtype: dict[str, Any]) -> dict[str, Any]:
    """A batch: a flat list of one value per case, and the shape."""
    size = {"type": "integer", "minimum": 0}
    return closed(
        {
            "dtype": dtype,
            "shape": {"type": "array", "items": size},
            "values": {"type": "array", "items": value},
        }
    )


def _each(value: dict[str, Any]) -> dict[str, Any]:
    """A label, a count or a truth value, or one for each case of a batch."""
    return {"anyOf": [value, _batch(value, TEXT)]}


_LISTED = {
    "model": _each({"enum": [*_MODELS, "solve"]}),
    "kind": _each({"enum": ["elastic", "elastoplastic", "plastic", "incomplete", ""]}),
    "regime": _each({"enum": ["frictionless", "sliding", "sticking", "reversing", "given", ""]}),
    "status": _each({"enum": [int(status) for status in Status]}),
    "ok": _each({"type": "boolean"}),
    "complete": _each({"type": "boolean"}),
    "refused": _each({"type": "boolean"}),
    "pdof_clock": {"anyOf": [{"type": "integer", "minimum": 1, "maximum": 12}, _VALUE, NULL]},
}
_RECONSTRUCTION = {
    "method": TEXT,
    "known": {"type": "array", "items": TEXT},
    "condition": _VALUE,
    "answers": _each({"anyOf": [{"type": "integer", "minimum": 0}, {"const": "inf"}]}),
    "contact_velocity": {"anyOf": [_PAIR, NULL]},
    "regime": {"enum": ["sticking", "sliding", None]},
    "one_sided": {
        "anyOf": [
            closed({name: _each({"enum": [1, -1, 0]}) for name in ("speed_a", "speed_b")}),
            NULL,
        ]
    },
    "left_backwards": {"anyOf": [_each({"type": "integer", "minimum": 0}), NULL]},
    "slip_if_stuck": {"anyOf": [_PAIR, NULL]},
    "misfit": {"anyOf": [_VALUE, NULL]},
    "found": {"type": "array", "items": TEXT},
    "given": {"type": "object", "additionalProperties": _VALUE},
    **{name: {"anyOf": [_VALUE, NULL]} for name in ("duration", "drag_a", "drag_b")},
}
