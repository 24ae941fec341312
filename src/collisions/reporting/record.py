"""The record at the end of a report, and the impact read back from it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from html.parser import HTMLParser
from typing import Any

from ..door import Door
from ..errors import InputError
from ..fields import unit_of
from ..impact import Impact
from ..units import shown
from ..vehicle import NAMES, Vehicle
from .markdown import FENCE
from .web import RECORD

_FORMAT = "collisions report 1"
# What may have been given as a text.
_NAMES = (*(name for name in NAMES if name not in ("name", "pivot")), "pivot[0]", "pivot[1]", "speed", "course")
# A text is read again by the same rules; the velocity of a pinned vehicle may differ by 1e-9 from the one that was given.
_SAME = 2e-9


def record(impact: Impact, version: str) -> str:
    """The impact and how its vehicles were given, as JSON."""
    given = {label: dict(side.before._given or {}) for label, side in (("a", impact.a), ("b", impact.b))}
    whole = {"format": _FORMAT, "version": version, "given": given, "impact": impact.to_dict()}
    return json.dumps(whole, indent=1, allow_nan=False)


def replay(text: str) -> Impact:
    """The impact of a report, solved again from the record at its end.

    The record holds every input with all its digits. ``report`` with the same options makes the same report of it, byte for
    byte; so whoever doubts a report reads it back, makes it again and compares.

    Parameters
    ----------
    text : str
        A whole report, HTML or Markdown, as ``report`` gave it.

    Returns
    -------
    Impact
        Equal to the one reported, with the texts its vehicles were given as.

    Raises
    ------
    InputError
        No report with a record, or a record that cannot be read, or whose texts and numbers differ.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions.reporting import replay, report
    >>> a = col.Vehicle(mass="1100 kg", vx="80 km/h", name="Golf")
    >>> page = report(col.linear_central(a, col.Vehicle(mass=950), 0.4), form="markdown")
    >>> report(replay(page), form="markdown") == page
    True
    """
    if not isinstance(text, str):
        raise InputError(
            f"text must be the text of a report, got {type(text).__name__}; write replay(open(path, encoding='utf-8').read())",
            code="not_a_text",
            argument="text",
        )
    inside = _record_in(text)
    try:
        found = json.loads(inside)
    except (ValueError, RecursionError) as error:
        raise _bad(f"it is no JSON ({error})") from error
    if not isinstance(found, Mapping) or found.get("format") != _FORMAT:
        raise _bad(f"it is not of the format {_FORMAT!r}")
    if not isinstance(found.get("impact"), Mapping):
        raise _bad("it has no impact")
    impact = Impact.from_dict(found["impact"])
    given = found.get("given")
    if not isinstance(given, Mapping) or set(given) != {"a", "b"}:
        raise _bad("it does not say how a and b were given")
    rebuild, (asked, raw, provenance) = impact.__reduce__()
    a, b = (_told(vehicle, given[label], label) for label, vehicle in (("a", asked.a), ("b", asked.b)))
    whole: Impact = rebuild(asked._replace(a=a, b=b), raw, provenance)
    return whole


def _record_in(text: str) -> str:
    text = text.replace("\r\n", "\n")
    if text.lstrip().startswith("<"):
        finder = _Finder()
        finder.feed(text)
        finder.close()
        found = "".join(finder.parts)
    else:
        found = text.rpartition(FENCE)[2].rpartition("```")[0] if FENCE in text else ""
    if not found.strip():
        raise InputError(
            "text has no record of an impact at its end; give the whole text of a report as report(...) returned it",
            code="no_record",
            argument="text",
        )
    return found


class _Finder(HTMLParser):
    """Collects the text of the element that holds the record."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.parts: list[str] = []
        self.inside = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "pre" and ("id", RECORD) in attrs:
            self.inside, self.parts = True, []

    def handle_endtag(self, tag: str) -> None:
        if tag == "pre":
            self.inside = False

    def handle_data(self, data: str) -> None:
        if self.inside:
            self.parts.append(data)


def _told(vehicle: Vehicle, texts: Any, label: str) -> Vehicle:
    """The vehicle with the texts it was given as, which must give its numbers."""
    if not isinstance(texts, Mapping) or not all(isinstance(text, str) for text in texts.values()):
        raise _bad(f"what it says of how {label} was given is no dict of texts")
    for name, text in texts.items():
        if name not in _NAMES or not isinstance(number := _value(vehicle, name), float):
            raise _bad(f"{label} has no {shown(name)} that could have been given")
        unit = unit_of(Vehicle, name.partition("[")[0]) or ""
        door = Door()
        read = door.number(text, unit, name)
        # A unit of another registry cannot be read here, and somebody at rest has no course.
        if door.problems or math.isnan(number) or read == number:
            continue
        apart = math.remainder(read - number, 2.0 * math.pi) if unit == "rad" else read - number
        size = {"rad": 2.0 * math.pi, "m/s": vehicle.speed}.get(unit, abs(number))
        if not abs(apart) <= _SAME * size:
            raise _bad(f"{label}.{name} was given as {shown(text)}, which is not its number, {number!r} {unit}")
    told: Vehicle = object.__new__(Vehicle)
    told.__setstate__({**vehicle.__getstate__(), "_given": dict(texts)})
    return told


def _value(vehicle: Vehicle, name: str) -> Any:
    """The number of an argument, or of one of the two of a place."""
    field, _, index = name.partition("[")
    value = getattr(vehicle, field)
    return value[int(index[0])] if index and value is not None else value


def _bad(why: str) -> InputError:
    return InputError(
        f"the record of the report cannot be used: {why}; take the report as it was made", code="bad_record", argument="text"
    )
