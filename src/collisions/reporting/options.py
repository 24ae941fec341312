"""The options that a report was made with, as its record keeps them and as they are given again."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ..diagnostics import LIMITS
from ..kernels.elementwise import UNCHECKED
from ..outlines import read_outline
from ..reading import ArgumentReader

# What makes another page, and in which unit it is read; None for what is no number.
UNITS: dict[str, str | None] = {
    "title": None,
    "form": None,
    "units": None,
    "outline_a": None,
    "outline_b": None,
    "duration": "s",
    "drag": "",
    "limits": None,
    "crush_energy": "J",
    "damage_pdof_a": "rad",
    "damage_pdof_b": "rad",
    "damage_delta_v_a": "m/s",
    "damage_delta_v_b": "m/s",
    "share_a": "",
    "notes": None,
    "figures": None,
    "derivation": None,
}
EVIDENCE = tuple(name for name in UNITS if name.startswith(("crush", "damage")))


def plain_options(options: Mapping[str, Any]) -> dict[str, Any]:
    """The options with every number as a float or as the text it was given as; what cannot be read stays, to be refused."""
    found = dict(options)
    for name, unit in UNITS.items():
        if unit is not None and options[name] is not None:
            found[name] = _number(options[name], unit, name)
    if isinstance(options["limits"], Mapping):
        found["limits"] = {
            code: _number(value, LIMITS[code].unit, code) if code in LIMITS else value
            for code, value in options["limits"].items()
        }
    for name in ("outline_a", "outline_b"):
        reader = ArgumentReader()
        corners = None if options[name] is None else read_outline(reader, options[name], name)
        if corners is not None and not reader.problems:
            found[name] = [tuple(map(float, corner)) for corner in corners]
    return found


def _number(value: Any, unit: str, name: str) -> Any:
    """A float, or a text that reads as the same number here."""
    if isinstance(value, str):
        return value
    reader = ArgumentReader(trusted=(name,))
    read = reader.number(value, unit, name, UNCHECKED)
    if reader.problems or not isinstance(read, float):
        return value
    text = reader.texts.get(name)
    again = ArgumentReader()
    # A unit of another registry may be another here, or none.
    return text if text is not None and again.number(text, unit, name, UNCHECKED) == read and not again.problems else read


def kept(options: Mapping[str, Any], usual: Mapping[str, Any]) -> dict[str, Any]:
    """What a record keeps of plain options: those that are not the usual ones."""
    return {name: strict(value) for name, value in options.items() if name in UNITS and value != usual[name]}


def strict(value: Any) -> Any:
    """Only what strict JSON knows; an infinity by name."""
    if isinstance(value, Mapping):
        return {name: strict(part) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [strict(part) for part in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def given_again(record: Mapping[str, Any]) -> dict[str, Any]:
    """The options of a record as they are given to ``report``."""
    found = dict(record)
    for name in ("outline_a", "outline_b"):
        if name in found:
            found[name] = [tuple(corner) for corner in found[name]]
    if "limits" in found:
        found["limits"] = {code: math.inf if limit == "inf" else limit for code, limit in found["limits"].items()}
    return found
