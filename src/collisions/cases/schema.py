"""``case_schema``: the JSON schema of case files for editors, from the signatures and docstrings of
the public functions.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from inspect import Parameter
from typing import Any, get_args

from ..reporting import report
from ..reporting.what_if import SLIDERS, what_if
from ..scene import Contact, Mover, Scene
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle
from .crash import OF_MOVER, OF_SCENE, OF_SURFACE
from .read import FUNCTIONS, SEVERAL, SOLVERS, STUDIES, descriptions, parameters, vehicles
from .words import DISTRIBUTIONS

_NUMBER = {"$ref": "#/$defs/number"}
_PLAIN = {"str": "string", "bool": "boolean", "int": "integer"}


def case_schema() -> dict[str, Any]:
    """The JSON schema (draft 7, which editors of TOML know) of a case file."""
    tables: dict[str, Any] = {
        label: {"$ref": "#/$defs/vehicle"} for f in SOLVERS.values() for label in vehicles(f)
    }
    reverse: dict[str, Any] = {}
    for name, function in (SOLVERS | STUDIES).items():
        module, _, own = name.rpartition(".")
        (reverse if module else tables)[own] = _arguments(function)
    tables["propagate"]["properties"]["outputs"] = {"type": "array", "items": {"type": "string"}}
    tables |= _tables_of_scenes()
    tables["observed"] = {
        "type": "object",
        "description": "what was observed, by name: of [posterior], or of [fit] if it is there",
    }
    pair = {"type": "array", "items": {"type": ["number", "string"]}, "minItems": 2, "maxItems": 2}
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
            "description": "which answer to take where there are several, counted from 1",
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
            "pair": {"type": "array", "items": _NUMBER},
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


def _of_vehicles() -> dict[str, Any]:
    found: dict[str, Any] = _arguments(Vehicle)["properties"]
    found |= _arguments(Vehicle.from_speed)["properties"]
    return found


def _tables_of_scenes() -> dict[str, Any]:
    """The tables of a whole crash: of some a file has several."""
    tyres = {"$ref": "#/$defs/tyres"}
    mover = _of_vehicles() | _arguments(Mover)["properties"] | {"tyres": tyres}
    mover = {name: one for name, one in mover.items() if name not in ("pivot", "vehicle")}
    for name in OF_MOVER:
        mover.setdefault(name, {"type": "string"})
    contact = _arguments(Contact)["properties"]
    contact["tyres_after"] |= {"type": "object", "additionalProperties": tyres}
    texts = {"type": "array", "items": {"type": "string"}}
    own = _arguments(Scene)["properties"]
    scene = {name: own.get(name, {}) for name in OF_SCENE}
    scene["order"] |= {"type": "array", "items": texts}
    scene["shared"] |= {"type": "object", "additionalProperties": texts}
    scene["tolerance"] = {
        "type": "number",
        "description": descriptions(Scene.run)["tolerance"],
    }
    corners = {
        "type": "array",
        "items": {"$ref": "#/$defs/pair"},
        "minItems": 3,
        "description": "corners of the area in order [m]",
    }
    surface = dict(zip(OF_SURFACE, (corners, {"allOf": [_NUMBER]}), strict=True))
    return {
        "mover": {"type": "array", "items": _object(mover)},
        "contact": {"type": "array", "items": _object(contact)},
        "surface": {"type": "array", "items": _object(surface)},
        "scene": _object(scene),
    }


def _arguments(function: Callable[..., Any], plain: bool = False) -> dict[str, Any]:
    """The table of the arguments of a function; the vehicles of a solver stand in tables of their
    own.
    """
    takes = {
        name: one for name, one in parameters(function).items() if name not in vehicles(function)
    }
    return _object({name: {} if plain else _argument(one, function) for name, one in takes.items()})


def _argument(parameter: Parameter, function: Callable[..., Any]) -> dict[str, Any]:
    """The schema of an argument by its annotation."""
    kind = str(parameter.annotation).removesuffix(" | None")
    text = descriptions(function).get(parameter.name, "")
    found: dict[str, Any] = {"description": text} if text else {}
    if kind in _PLAIN:
        return found | {"type": _PLAIN[kind]}
    choices = (
        get_args(getattr(sys.modules[function.__module__], kind, None))
        if kind.isidentifier()
        else ()
    )
    if choices and all(isinstance(choice, str) for choice in choices):
        return found | {"enum": list(choices)}
    if any(name in kind for name in SEVERAL):
        return found | {"anyOf": [_NUMBER, {"$ref": "#/$defs/pair"}]}
    return found | ({"allOf": [_NUMBER]} if "Input" in kind else {})


def _nested(tables: dict[str, Any]) -> dict[str, Any]:
    """One table inside tables by the parts of its name, such as travel.speed."""
    found: dict[str, Any] = {}
    for name, table in tables.items():
        *outer, last = name.split(".")
        inside = found
        for part in outer:
            inside = inside.setdefault(part, _object({}))["properties"]
        inside[last] = table
    return _object(found) | {"minProperties": 1, "maxProperties": 1}


def _object(properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "additionalProperties": False}
