"""``case_schema``: the JSON schema of case files for editors, from the signatures and docstrings of
the public functions.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from inspect import Parameter
from typing import Any, get_args

from ..quantities.json_schema import TEXT, Schema, array_of, closed, described, schema_of
from ..reporting import report
from ..reporting.what_if import SLIDERS, what_if
from ..scene import Contact, Mover, Scene
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle
from .crash import OF_MOVER, OF_SCENE, OF_SURFACE
from .read import FUNCTIONS, SOLVERS, STUDIES, descriptions, parameters, vehicles
from .words import DISTRIBUTIONS

_NUMBER: Schema = {"$ref": "#/$defs/number"}
_PAIR: Schema = {"$ref": "#/$defs/pair"}
# By annotation; editors of TOML know draft 7 only, in which nothing may stand beside a reference.
_ONE: Schema = {"allOf": [_NUMBER]}
_NUMBERS: Schema = {"anyOf": [_NUMBER, _PAIR]}
_TYPES: dict[str, Schema] = {
    "str": TEXT,
    "bool": {"type": "boolean"},
    "int": {"type": "integer"},
    "Any": {},
    "Tyres": {"$ref": "#/$defs/tyres"},
    "Input": _ONE,
    "Pair": {"allOf": [_PAIR]},
    "Impulse": {"allOf": [_PAIR]},
    "tuple[Input, Input]": {"allOf": [_PAIR]},
    "tuple[Input, Input, Input]": {"allOf": [_PAIR]},
    "Sequence[Input]": {"allOf": [_PAIR]},
    "Sequence[str]": array_of(TEXT),
    "Segments": _NUMBERS,
    "Input | Pair": _NUMBERS,
    "Input | tuple[Input, Input]": _NUMBERS,
    "Input | Sequence[Input]": _NUMBERS,
    "Input | Callable[[float], float]": _ONE,
}


def case_schema() -> Schema:
    """The JSON schema (draft 7, which editors of TOML know) of a case file."""
    tables: Schema = {
        label: {"$ref": "#/$defs/vehicle"} for f in SOLVERS.values() for label in vehicles(f)
    }
    reverse: Schema = {}
    for name, function in (SOLVERS | STUDIES).items():
        module, _, own = name.rpartition(".")
        (reverse if module else tables)[own] = _arguments(function)
    tables["propagate"]["properties"]["outputs"] = array_of(TEXT)
    tables |= _tables_of_scenes()
    tables["observed"] = {
        "type": "object",
        "description": "what was observed, by name: of [posterior], or of [fit] if it is there",
    }
    pair = array_of({"type": ["number", "string"]}, 2)
    tables |= {
        "reconstruct": _object(reverse),
        "report": _arguments(report),
        "what_if": _object(
            {
                "ranges": _object(dict.fromkeys(SLIDERS, pair))
                | {"description": descriptions(what_if)["ranges"]}
            }
        ),
        "answer": {
            "type": "integer",
            "minimum": 1,
            "description": "which of several answers of the solver to take, counted from 1",
        },
    }
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "$id": "urn:collisions:case",
        "title": "Case of collisions",
        **_object(tables),
        "$defs": {
            "number": {
                "description": (
                    'A number in SI, or a text: "50 km/h", "50 km/h +/- 3 km/h", "0.4 .. 0.7"; '
                    "or a function."
                ),
                "anyOf": [{"type": ["number", "string"]}, {"$ref": "#/$defs/function"}],
            },
            "pair": array_of(_NUMBER),
            "vehicle": _object(_of_vehicles()),
            "tyres": _arguments(Tyres),
            "function": _nested(
                {
                    name: _arguments(one, plain=name in DISTRIBUTIONS)
                    for name, one in FUNCTIONS.items()
                }
            ),
        },
    }


def _of_vehicles() -> Schema:
    found: Schema = _arguments(Vehicle)["properties"]
    found |= _arguments(Vehicle.from_speed)["properties"]
    return found


def _tables_of_scenes() -> Schema:
    """The tables of a whole crash: of some a file has several."""
    tyres = {"$ref": "#/$defs/tyres"}
    mover = _of_vehicles() | _arguments(Mover)["properties"]
    mover = {name: one for name, one in mover.items() if name not in ("pivot", "vehicle")}
    for name in OF_MOVER:
        mover.setdefault(name, TEXT)
    contact = _arguments(Contact)["properties"]
    contact["tyres_after"] |= {"type": "object", "additionalProperties": tyres}
    own = _arguments(Scene)["properties"]
    scene = {name: own.get(name, {}) for name in OF_SCENE}
    scene["order"] |= array_of(array_of(TEXT))
    scene["shared"] |= {"type": "object", "additionalProperties": array_of(TEXT)}
    scene["tolerance"] = described({"type": "number"}, descriptions(Scene.run)["tolerance"])
    corners = array_of({"$ref": "#/$defs/pair"}) | {"minItems": 3}
    corners = described(corners, "corners of the area in order [m]")
    surface = dict(zip(OF_SURFACE, (corners, {"allOf": [_NUMBER]}), strict=True))
    return {
        "mover": array_of(_object(mover)),
        "contact": array_of(_object(contact)),
        "surface": array_of(_object(surface)),
        "scene": _object(scene),
    }


def _arguments(function: Callable[..., Any], plain: bool = False) -> Schema:
    """The table of the arguments of a function; the vehicles of a solver stand in tables of their
    own.
    """
    takes = {
        name: one for name, one in parameters(function).items() if name not in vehicles(function)
    }
    return _object({name: {} if plain else _argument(one, function) for name, one in takes.items()})


def _argument(parameter: Parameter, function: Callable[..., Any]) -> Schema:
    """The schema of an argument by its annotation; what may be None is left out in a file."""
    kinds = str(parameter.annotation).removesuffix(" | None")
    known = _TYPES | _choices(kinds, function)
    try:
        found = schema_of(kinds, known)
    except KeyError:  # a part that a file cannot give
        found = _NUMBERS if "Input" in kinds else {}
    return described(found, descriptions(function).get(parameter.name, ""))


def _choices(name: str, function: Callable[..., Any]) -> dict[str, Schema]:
    """The schema of an alias for some texts, such as Law."""
    alias = getattr(sys.modules[function.__module__], name, None) if name.isidentifier() else None
    texts = get_args(alias)
    return {name: {"enum": list(texts)}} if texts and all(isinstance(t, str) for t in texts) else {}


def _nested(tables: Schema) -> Schema:
    """One table inside tables by the parts of its name, such as travel.speed."""
    found: Schema = {}
    for name, table in tables.items():
        *outer, last = name.split(".")
        inside = found
        for part in outer:
            inside = inside.setdefault(part, _object({}))["properties"]
        inside[last] = table
    return _object(found) | {"minProperties": 1, "maxProperties": 1}


def _object(properties: Schema) -> Schema:
    return closed(properties, ())
