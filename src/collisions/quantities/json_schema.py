"""JSON schemas of records and files: ``schema_of`` makes that of a declared type, with which every
field, argument and attribute is described.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Mapping
from typing import Any, TypeAlias

Schema: TypeAlias = dict[str, Any]
TEXT: Schema = {"type": "string"}
NULL: Schema = {"type": "null"}
# A comma or a bar within brackets belongs to the part that has them.
_BAR = re.compile(r" \| (?![^\[]*\])")


def schema_of(declared: str, types: Mapping[str, Schema]) -> Schema:
    """The schema of a type as it is declared, such as "Value | None" or "Literal['a', 'b']".

    ``types`` has the schema of every name: of the whole, or of each part of a union. A part that it
    does not have is a KeyError.
    """
    if declared in types:
        return dict(types[declared])
    parts = [_part(part, types) for part in _BAR.split(declared)]
    return parts[0] if len(parts) == 1 else {"anyOf": parts}


def _part(declared: str, types: Mapping[str, Schema]) -> Schema:
    if declared.startswith("Literal["):
        return {"enum": list(ast.literal_eval(f"({declared[8:-1]},)"))}
    return NULL if declared == "None" else dict(types[declared])


def described(schema: Schema, text: str = "", unit: str | Iterable[str] | None = None) -> Schema:
    """The schema with what is said of it, and its unit; without either as it is."""
    if unit is not None:
        units = unit or "1" if isinstance(unit, str) else ", ".join(unit)
        text = f"{text} [{units}]".lstrip()
    return {**schema, "description": text} if text else schema


def or_null(schema: Schema, text: str = "") -> Schema:
    """Either this or null."""
    return described({"anyOf": [schema, NULL]}, text)


def array_of(item: Schema, length: int | None = None) -> Schema:
    """An array of items of one kind, of this length if it is given."""
    found: Schema = {"type": "array", "items": item}
    return found if length is None else found | {"minItems": length, "maxItems": length}


def closed(properties: Schema, needed: Iterable[str] | None = None) -> Schema:
    """An object with these properties and no other; without ``needed`` with all of them."""
    names = list(properties if needed is None else needed)
    return {
        "type": "object",
        "properties": properties,
        **({"required": names} if names else {}),
        "additionalProperties": False,
    }
