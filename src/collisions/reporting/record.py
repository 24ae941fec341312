"""The record at the end of a report, and the answer read back from it."""

from __future__ import annotations

import json
import math
import sys
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import fields
from html.parser import HTMLParser
from typing import Any

from ..errors import CollisionsError, CollisionsWarning, InputError
from ..impact import Impact
from ..quantities import unit_of
from ..reading import ArgumentReader
from ..reconstruct import Fit, MomentumSolution, momentum
from ..uncertainty import Propagation
from ..units import shown
from ..vehicle import NAMES, Vehicle
from .markdown import FENCE
from .options import UNITS, given_again, strict
from .render import RECORD
from .told import unlike

_FORMAT = "collisions report 1"
# What may have been given as a text.
_NAMES = (*(name for name in NAMES if name not in ("name", "pivot")), "pivot[0]", "pivot[1]", "speed", "course")
# A text is read again by the same rules; the velocity of a pinned vehicle may differ by 1e-9 from the one that was given.
_SAME = 2e-9
# Results that another machine gives may differ by its rounding, relative or in SI; nobody would read more.
_OFF = 1e-6
# Words about the numbers, which another version may choose otherwise.
_SENTENCES = ("choice.reason",)


def record(
    impact: Impact | MomentumSolution | Fit, version: str, options: Mapping[str, Any], uncertainty: Propagation | None
) -> str:
    """The answer, how its inputs were given, and the options of the report, as JSON."""
    whole: dict[str, Any] = {"format": _FORMAT, "version": version, "options": dict(options)}
    if uncertainty is not None:
        whole["uncertainty"] = {name: getattr(uncertainty, name) for name in ("method", "samples", "seed")}
    if isinstance(impact, Impact):
        whole["given"] = {label: dict(side.before._given or {}) for label, side in (("a", impact.a), ("b", impact.b))}
        whole["impact"] = impact.to_dict()
    elif isinstance(impact, Fit):
        whole["fit"] = impact.to_dict()
    else:
        whole["momentum"] = {"inputs": impact._given, "results": _results(impact)}
    return json.dumps(whole, indent=1, allow_nan=False)


def _results(solution: MomentumSolution) -> Any:
    """Every number of planar momentum."""
    return strict({f.name: getattr(solution, f.name) for f in fields(solution) if f.name != "_given"})


def replay(text: str) -> Impact | MomentumSolution:
    """The answer of a report, solved again from the record at its end.

    The record holds every input with all its digits. ``report`` with the same options makes the same report of it, byte for
    byte; so whoever doubts a report reads it back, makes it again and compares.

    Parameters
    ----------
    text : str
        A whole report, HTML or Markdown, as ``report`` gave it.

    Returns
    -------
    Impact or MomentumSolution
        Equal to the one reported, with the texts its inputs were given as.

    Raises
    ------
    InputError
        No report with a record, or a record that cannot be read, or whose texts and numbers differ; or the report of a ``Fit``,
        whose model is code.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions.reporting import replay, report
    >>> a = col.Vehicle(mass="1100 kg", vx="80 km/h", name="Golf")
    >>> page = report(col.linear_central(a, col.Vehicle(mass=950), 0.4), form="markdown")
    >>> report(replay(page), form="markdown") == page
    True
    """
    found = _whole(text)
    if "fit" in found:
        raise InputError(
            "text is the report of a Fit, which cannot be made again from it: its model is code. Its numbers stand in the "
            "record; to check them call reconstruct.fit with the model again",
            code="no_record",
            argument="text",
        )
    if "momentum" in found:
        return _momentum(found["momentum"])
    if not isinstance(found.get("impact"), Mapping):
        raise _bad("it has no impact")
    try:
        impact = Impact.from_dict(found["impact"])
    except CollisionsError as error:
        raise _bad(str(error)) from error
    differing = next(_differences(found["impact"]["results"], impact.to_dict()["results"]), None)
    if differing is not None:
        raise _bad(f"its inputs do not give its {differing}")
    stray = next(unlike(impact), None)
    if stray is not None:
        raise _bad(stray)
    given = found.get("given")
    if not isinstance(given, Mapping) or set(given) != {"a", "b"}:
        raise _bad("it does not say how a and b were given")
    a, b = (_told(vehicle, given[label], label) for label, vehicle in (("a", impact.inputs.a), ("b", impact.inputs.b)))
    whole = impact._with(a, b)
    return whole


def _momentum(whole: Any) -> MomentumSolution:
    """Planar momentum again, by the arguments of a record."""
    try:
        inputs, told = dict(whole["inputs"]), whole["results"]
        pairs = {name: tuple(value) for name, value in inputs.items() if isinstance(value, list)}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", CollisionsWarning)  # given when it was solved
            solution = momentum(**(inputs | pairs), on_failure="nan")
    except (CollisionsError, LookupError, TypeError, ValueError) as error:
        raise _bad(str(error)) from error
    differing = next(_differences(told, json.loads(json.dumps(_results(solution)))), None)
    if differing is not None:
        raise _bad(f"its inputs do not give its {differing}")
    return solution


def options(text: str) -> dict[str, Any]:
    """The options that a report was made with, to be given to ``report`` again with what ``replay`` gives.

    Parameters
    ----------
    text : str
        A whole report, HTML or Markdown, as ``report`` gave it.

    Returns
    -------
    dict
        By argument of ``report``, what was not left at its default. ``uncertainty`` is missing: a propagation holds a model,
        which is code, and the record has only its method, number of cases and seed.

    Raises
    ------
    InputError
        No report with a record, or a record that cannot be read.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions.reporting import options, replay, report
    >>> impact = col.linear_central(col.Vehicle(mass=1100, vx="80 km/h"), col.Vehicle(mass=950), 0.4)
    >>> page = report(impact, form="markdown", units="metric", duration="90 ms")
    >>> options(page)
    {'form': 'markdown', 'units': 'metric', 'duration': '90 ms'}
    >>> report(replay(page), **options(page)) == page
    True
    """
    found = _whole(text).get("options", {})
    try:
        if found.keys() <= UNITS.keys():
            return given_again(found)
    except (AttributeError, TypeError):
        pass
    raise _bad("its options are none that report takes")


def _whole(text: Any) -> Mapping[str, Any]:
    """The record of a report."""
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
    return found


def _differences(told: Any, found: Any, name: str = "") -> Iterator[str]:
    """Results of the record that its inputs do not give, by more than another machine may round; all must be there."""
    scale = max((abs(number) for number in _floats(found)), default=0.0)
    yield from _apart(told, found, name, max(_OFF, 1e-12 * scale))


def _floats(found: Any) -> Iterator[float]:
    if isinstance(found, Mapping):
        found = list(found.values())
    if isinstance(found, list):
        for part in found:
            yield from _floats(part)
    elif isinstance(found, float):
        yield found


def _apart(told: Any, found: Any, name: str, off: float) -> Iterator[str]:
    if isinstance(told, Mapping) and isinstance(found, Mapping):
        for key in dict.fromkeys([*found, *told]):
            path = f"{name}.{key}" if name else str(key)
            if key not in told:
                yield f"{path}, which is missing"
            elif key not in found:
                yield f"{path}, which no impact has"
            elif path not in _SENTENCES:
                yield from _apart(told[key], found[key], path, off)
    elif isinstance(told, list) and isinstance(found, list) and len(told) == len(found):
        for i, (one, other) in enumerate(zip(told, found, strict=True)):
            yield from _apart(one, other, f"{name}[{i}]", off)
    elif isinstance(told, (int, float)) and isinstance(found, float):
        # JSON may hold whole numbers beyond any float.
        if not (abs(told) <= sys.float_info.max and math.isclose(told, found, rel_tol=_OFF, abs_tol=off)):
            yield f"{name}, {told!r}, but {found!r}"
    elif told != found:
        yield f"{name}, {shown(told)}, but {shown(found)}"


def _record_in(text: str) -> str:
    text = text.removeprefix("\ufeff").replace("\r\n", "\n")
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
        reader = ArgumentReader()
        read = reader.number(text, unit, name)
        # A unit of another registry cannot be read here, and somebody at rest has no course.
        if reader.problems or math.isnan(number) or read == number:
            continue
        apart = math.remainder(read - number, 2.0 * math.pi) if unit == "rad" else read - number
        size = {"rad": 2.0 * math.pi, "m/s": vehicle.speed}.get(unit, abs(number))
        if not abs(apart) <= _SAME * size:
            raise _bad(f"{label}.{name} was given as {shown(text)}, which is not its number, {number!r} {unit}")
    return vehicle._told(dict(texts))


def _value(vehicle: Vehicle, name: str) -> Any:
    """The number of an argument, or of one of the two of a place."""
    field, _, index = name.partition("[")
    value = getattr(vehicle, field)
    return value[int(index[0])] if index and value is not None else value


def _bad(why: str) -> InputError:
    return InputError(
        f"the record of the report cannot be used: {why}; take the report as it was made", code="bad_record", argument="text"
    )
