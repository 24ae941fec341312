"""``record``, ``replay`` and ``options``: the JSON at the end of a report, its result solved again,
and its options.
"""

from __future__ import annotations

import json
import math
import re
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields
from functools import partial
from html import unescape
from itertools import chain
from typing import Any, TypeAlias, TypeVar

from ..diagnostics import LIMITS
from ..impact.impact import Impact, with_vehicles
from ..impact.inputs import TYRES
from ..impact.records import tyres_of, tyres_record
from ..kernels.elementwise import UNCHECKED
from ..messages.errors import CollisionsError, CollisionsWarning, InputError
from ..messages.marked import type_of
from ..quantities.attributes import unit_of
from ..quantities.formatting import SI_UNITS
from ..quantities.reading import ArgumentReader
from ..quantities.refusals import must_be
from ..quantities.settings import Default, computing, units_required
from ..quantities.strict_json import strict
from ..quantities.units import Texts, of_another_registry, rendered, shown
from ..reconstruct import Fit, MomentumSolution, Posterior, momentum
from ..reconstruct.found_again import contradicted_origin
from ..scene.run import Run
from ..uncertainty import Propagation
from ..vehicle.outlines import read_outline
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import DOMAINS, Vehicle, with_given
from .render import FENCE, RECORD
from .sections import EVIDENCE, contradicted

T = TypeVar("T", bound="Impact | MomentumSolution | Run")
Result: TypeAlias = Impact | MomentumSolution | Fit | Posterior | Run
REPORT_FORMAT = "collisions report 2"
# The options that change the page, with the unit in which each is read; None for one that is not a
# number.
_UNITS: dict[str, str | None] = {
    **dict.fromkeys(
        (
            "title",
            "form",
            "units",
            "outline_a",
            "outline_b",
            "limits",
            "notes",
            "answers",
            "figures",
            "derivation",
            "author",
            "case",
            "date",
            "exhibit",
        )
    ),
    "duration": "s",
    "drag": "",
    "share_a": "",
    **{name: SI_UNITS[kind] for name, (_, _, kind) in EVIDENCE.items()},
}
# Arguments of a vehicle that may be texts.
_NUMBERS = (*DOMAINS, "pivot[0]", "pivot[1]", "speed", "course")
# The velocity of a pinned vehicle may differ by 1e-9 from the text that it was given as.
_READ_AGAIN = 2e-9
# Results of another machine may differ by its rounding, relative or in SI; a page does not show
# that many digits.
_OTHER_MACHINE = 1e-6
# Those of releases, and of what comes before and after them: "0.2.0", "1.0rc1", "0.3.0.dev2+g1a2b".
_VERSION = re.compile(
    r"[0-9]+(\.[0-9]+)*((a|b|rc)[0-9]+)?(\.post[0-9]+)?(\.dev[0-9]+)?(\+[a-z0-9]+(\.[a-z0-9]+)*)?"
)
# What a record has of the page, beside its results.
_OF_PAGE = ("format", "version", "options")
_OF_UNCERTAINTY = ("method", "samples", "seed")
_NO_OPTIONS = "its options are none that report takes"
# Sentences.
_SENTENCES = ("choice.reason", "].sentence")


def record(impact: Result, options: Mapping[str, Any], uncertainty: Propagation | None) -> str:
    """The record of one result: its inputs as given, and the options of the report, as JSON."""
    return record_of_all([(impact, uncertainty)], options)


def record_of_all(
    results: Sequence[tuple[Result, Propagation | None]], options: Mapping[str, Any]
) -> str:
    """The record of a page of one or several results."""
    from .. import __version__

    whole: dict[str, Any] = {
        "format": REPORT_FORMAT,
        "version": __version__,
        "options": strict(options),
    }
    parts = [_one_record(*part) for part in results]
    whole |= parts[0] if len(parts) == 1 else {"results": parts}
    return json.dumps(whole, indent=1, allow_nan=False)


def _one_record(impact: Result, uncertainty: Propagation | None) -> dict[str, Any]:
    whole: dict[str, Any] = {}
    if uncertainty is not None:
        whole["uncertainty"] = {name: getattr(uncertainty, name) for name in _OF_UNCERTAINTY}
    if isinstance(impact, Impact):
        whole["impact"] = impact.to_dict()
        inputs = whole["impact"]["inputs"]
        whole["other_texts"] = {
            label: _other_texts(vehicle, inputs[label])
            for label, vehicle in (("a", impact.inputs.a), ("b", impact.inputs.b))
        }
    elif isinstance(impact, Run):
        whole["run"] = impact.to_dict()
    elif isinstance(impact, (Fit, Posterior)):
        whole[type(impact).__name__.lower()] = impact.to_dict()
    else:
        given = {
            name: tyres_record(value) if isinstance(value, Tyres) else value
            for name, value in (impact.given or {}).items()
        }
        whole["momentum"] = {"inputs": given, "results": _results(impact)}
    return whole


def plain_options(given: Mapping[str, Any]) -> dict[str, Any]:
    """The options with numbers as floats or the texts given; a value that cannot be read is kept,
    for the reader to refuse.
    """
    found = {name: value for name, value in given.items() if name in _UNITS}
    found |= {
        name: _number(given[name], unit, name) for name, unit in _UNITS.items() if unit is not None
    }
    # A default gives way to what the impact itself has, and 0.1 that was given does not.
    found |= {name: given[name] for name in found if isinstance(given[name], Default)}
    if isinstance(given["limits"], Mapping):
        found["limits"] = {
            code: _number(value, LIMITS[code].unit, code) if code in LIMITS else value
            for code, value in given["limits"].items()
        }
    for name in ("outline_a", "outline_b"):
        reader = ArgumentReader()
        corners = None if given[name] is None else read_outline(reader, given[name], name)
        if corners is not None and not reader.problems:
            found[name] = [tuple(map(float, corner)) for corner in corners]
    return found


def _number(value: Any, unit: str, name: str) -> Any:
    """A number as a float, or as its text if that reads as the same number here; of
    several a list.
    """
    if isinstance(value, (tuple, list)):
        return [
            part if isinstance(part, (tuple, list)) else _number(part, unit, name) for part in value
        ]
    if value is None or isinstance(value, str):
        return value
    reader = ArgumentReader(trusted=(name,))
    read = reader.number(value, unit, name, UNCHECKED)
    if reader.problems or not isinstance(read, float):
        return value
    text = reader.texts.get(name)
    # A unit of another registry may differ here, or not exist.
    return (
        text
        if text is not None and ArgumentReader().number(text, unit, name, UNCHECKED) == read
        else read
    )


def _other_texts(vehicle: Vehicle, inputs: Mapping[str, Any]) -> dict[str, str]:
    """The vehicle's texts that the record of the impact does not hold, because they do not read as
    the number here.
    """
    texts = Texts(vehicle.given)
    return {name: text for name, text in texts.items() if _argument(inputs.get, name) != text}


def _argument(find: Callable[[str], Any], name: str) -> Any:
    """The value for an argument, or for one component such as "pivot[0]"."""
    field, _, index = name.partition("[")
    value = find(field)
    return value[int(index[0])] if index and value is not None else value


def _results(solution: MomentumSolution) -> Any:
    """The fields of a planar-momentum result."""
    return strict(
        {
            f.name: getattr(solution, f.name)
            for f in fields(solution)
            if f.name not in ("given", *TYRES)
        }
    )


@computing
def replay(text: str) -> Impact | MomentumSolution | Run | list[Impact | MomentumSolution]:
    """The answer of a report, solved again from the record at its end.

    The record holds every input with all its digits. ``report`` with the same options makes the
    same report from it, byte for byte, so whoever doubts a report can read it back, make it again
    and compare.

    Parameters
    ----------
    text : str
        A whole report, HTML or Markdown, as ``report`` gave it.

    Returns
    -------
    Impact, MomentumSolution or scene.Run, or list of the first two
        Equal to the one reported, with the texts in which its inputs were given; a list of all for
        a page of several results.

    Raises
    ------
    InputError
        A text without a record, or a record that cannot be read, in which a name stands twice or is
        one that nothing reads, whose inputs do not give its results, or whose texts and numbers
        differ; or the report of a ``Fit`` or a ``Posterior``, whose model is code.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions.reporting import replay, report
    >>> a = col.Vehicle(mass="1100 kg", vx="80 km/h", name="Golf")
    >>> page = report(col.linear_central(a, col.Vehicle(mass=950), 0.4), form="markdown")
    >>> report(replay(page), form="markdown") == page
    True
    """
    from .. import __version__

    found = _whole(text)
    if not (isinstance(version := found.get("version"), str) and _VERSION.fullmatch(version)):
        raise _bad(f"its version is {rendered(version)}")
    # Another version may word a sentence differently, and have other names.
    as_here = version == __version__
    asked = found.get("options")
    if as_here and not (isinstance(asked, Mapping) and asked.keys() <= _UNITS.keys()):
        raise _bad(_NO_OPTIONS)
    part = {name: one for name, one in found.items() if name not in _OF_PAGE}
    if "run" in found:
        return _with_known_names(_run(found["run"], as_here), part, as_here)
    if "results" not in found:
        return _with_known_names(_replayed(part, as_here), part, as_here)
    parts = part.pop("results")
    if part or not isinstance(parts, list) or not all(isinstance(one, Mapping) for one in parts):
        raise _bad("its results are no list of records, or it has others beside them")
    return [_with_known_names(_replayed(one, as_here), one, as_here) for one in parts]


def _with_known_names(result: T, part: Mapping[str, Any], as_here: bool) -> T:
    """The result of a part of a record, refused if that has what nothing reads."""
    if as_here:
        # What else a vehicle was given as is read here where the session knows the unit.
        again = _one_record(result, None) | {"other_texts": part.get("other_texts")}
        if "uncertainty" in part:
            again["uncertainty"] = dict.fromkeys(_OF_UNCERTAINTY)
            if not isinstance(part["uncertainty"], Mapping):
                raise _bad("its uncertainty has no method, samples and seed")
        if unknown := next(_unknown(part, again, ""), None):
            raise _bad(f"it has {unknown}, which no record of such a result has")
    return result


def _unknown(recorded: Any, found: Any, name: str) -> Iterator[str]:
    """The names that only the record has."""
    if isinstance(recorded, Mapping) and isinstance(found, Mapping):
        for key, part in recorded.items():
            path = f"{name}.{key}" if name else str(key)
            if key not in found:
                yield path
            else:
                yield from _unknown(part, found[key], path)
    elif isinstance(recorded, list) and isinstance(found, (list, tuple)):
        for i, (one, other) in enumerate(zip(recorded, found, strict=False)):
            yield from _unknown(one, other, f"{name}[{i}]")


def _replayed(found: Mapping[str, Any], as_here: bool) -> Impact | MomentumSolution:
    """One result solved again from its part of the record."""
    if kind := next((kind for kind in ("fit", "posterior") if kind in found), ""):
        raise InputError(
            f"text is the report of a {kind.capitalize()}, which cannot be made again from it: "
            "its model is code. Its numbers stand in the record; to check them call "
            f"reconstruct.{kind} with the model again",
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
    _check(found["impact"]["results"], impact.to_dict()["results"], as_here)
    for contradiction in chain(contradicted(impact), contradicted_origin(impact)):
        raise _bad(contradiction)
    texts = found.get("other_texts")
    if not isinstance(texts, Mapping) or set(texts) != {"a", "b"}:
        raise _bad("it does not say how else a and b were given")
    a, b = (
        _with_texts(vehicle, texts[label], label)
        for label, vehicle in (("a", impact.inputs.a), ("b", impact.inputs.b))
    )
    return with_vehicles(impact, a, b)


def _run(whole: Any, as_here: bool) -> Run:
    """A scene run again from a record."""
    try:
        run = Run.from_dict(whole)
    except (CollisionsError, LookupError, TypeError) as error:
        raise _bad(str(error)) from error
    # All that follows from the scene: its impacts too, with the states in which they come.
    recorded, found = (
        {name: part for name, part in record.items() if name != "scene"}
        for record in (whole, json.loads(json.dumps(run.to_dict())))
    )
    _check(recorded, found, as_here)
    return run


def _momentum(whole: Any) -> MomentumSolution:
    """Planar momentum solved again from a record."""
    try:
        inputs, results = dict(whole["inputs"]), whole["results"]
        pairs: dict[str, Any] = {
            name: tuple(value) for name, value in inputs.items() if isinstance(value, list)
        }
        pairs |= {name: tyres_of(inputs[name]) for name in TYRES if name in inputs}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", CollisionsWarning)  # given when it was solved
            solution = momentum(**(inputs | pairs), on_failure="nan")
    except (CollisionsError, AttributeError, LookupError, TypeError, ValueError) as error:
        raise _bad(str(error)) from error
    _check(results, json.loads(json.dumps(_results(solution))))
    return solution


def _with_texts(vehicle: Vehicle, texts: Any, label: str) -> Vehicle:
    """The vehicle with these texts added; a text must agree with its number, unless its unit is of
    another registry.
    """
    if not isinstance(texts, Mapping) or not all(isinstance(text, str) for text in texts.values()):
        raise _bad(f"what it says of how {label} was given is no dict of texts")
    for name, text in texts.items():
        if name not in _NUMBERS or not isinstance(
            number := _argument(partial(getattr, vehicle), name), float
        ):
            raise _bad(f"{label} has no {shown(name)} that could have been given")
        reader = ArgumentReader()
        unit = unit_of(Vehicle, name.partition("[")[0]) or ""
        read = reader.number(text, unit, name, UNCHECKED)
        apart = math.remainder(read - number, math.tau) if unit == "rad" else read - number
        agrees = not reader.problems and not abs(apart) > _READ_AGAIN * max(1.0, abs(number))
        if not agrees and not of_another_registry(text):
            raise _bad(
                f"{label}.{name} was given as {shown(text)}, which is not its number, {number!r} "
                f"{unit}"
            )
    return with_given(vehicle, dict(vehicle.given or {}) | dict(texts))


def options(text: str) -> dict[str, Any]:
    """The options of a report, to be passed to ``report`` again with the result of ``replay``.

    Parameters
    ----------
    text : str
        A whole report, HTML or Markdown, as ``report`` gave it.

    Returns
    -------
    dict
        By argument of ``report``, every option that was not left at its default. ``uncertainty`` is
        missing: a propagation holds a model, which is code, and the record has only its method,
        number of cases and seed.

    Raises
    ------
    InputError
        A text without a record, or a record that cannot be read.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions.reporting import options, replay, report
    >>> impact = col.linear_central(
    ...     col.Vehicle(mass=1100, vx="80 km/h"), col.Vehicle(mass=950), 0.4
    ... )
    >>> page = report(impact, form="markdown", units="metric", duration="90 ms")
    >>> options(page)
    {'form': 'markdown', 'units': 'metric', 'duration': '90 ms'}
    >>> report(replay(page), **options(page)) == page
    True
    """
    whole = _whole(text)
    try:
        found = dict(whole.get("options", {}))
        known = found.keys() <= _UNITS.keys()
        for name in {"outline_a", "outline_b"} & found.keys():
            # In metres, which they have to say where units are required.
            found[name] = [
                tuple(f"{part!r} m" for part in corner) if units_required.get() else tuple(corner)
                for corner in found[name]
            ]
        if "limits" in found:
            found["limits"] = {
                code: math.inf if limit == "inf" else limit
                for code, limit in found["limits"].items()
            }
    except (AttributeError, TypeError, ValueError):
        known = False
    if not known:
        raise _bad(_NO_OPTIONS)
    return found


def _whole(text: Any) -> Mapping[str, Any]:
    """The parsed record at the end of a report."""
    if not isinstance(text, str):
        raise must_be(
            "text",
            "the text of a report",
            text,
            "; write replay(open(path, encoding='utf-8').read())",
            code="not_a_text",
            got=type_of(text),
        )
    text = text.removeprefix("\ufeff").replace("\r\n", "\n")
    if text.lstrip().startswith("<"):
        inside = (
            unescape(text.rpartition(f'<pre id="{RECORD}">')[2].partition("</pre>")[0])
            if RECORD in text
            else ""
        )
    else:
        inside = text.rpartition(FENCE)[2].rpartition("```")[0] if FENCE in text else ""
    if not inside.strip():
        raise InputError(
            "text has no record of an impact at its end; give the whole text of a report as "
            "report(...) returned it",
            code="no_record",
            argument="text",
        )
    try:
        found = json.loads(inside, object_pairs_hook=_once)
    except InputError:
        raise
    except (ValueError, RecursionError) as error:
        raise _bad(f"it is no JSON ({error})") from error
    if not isinstance(found, Mapping) or found.get("format") != REPORT_FORMAT:
        raise _bad(f"it is not of the format {REPORT_FORMAT!r}")
    return found


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A dict of JSON in which no name stands twice, as other readers may take the first."""
    found: dict[str, Any] = {}
    for name, value in pairs:
        if name in found:
            raise _bad(f"it has {shown(name)} twice")
        found[name] = value
    return found


def _check(recorded: Any, found: Any, as_worded: bool = True) -> None:
    """Raise if the record's results are incomplete or differ from those of its inputs by more than
    rounding may; sentences, unless ``as_worded``, may be any texts.
    """
    scale = max((abs(number) for number in _floats(found)), default=0.0)
    off = max(_OTHER_MACHINE, 1e-12 * scale)
    differing = next(_differences(recorded, found, "", off, as_worded), None)
    if differing is not None:
        raise _bad(f"its inputs do not give its {differing}")


def _floats(found: Any) -> Iterator[float]:
    if isinstance(found, (Mapping, list)):
        for part in found.values() if isinstance(found, Mapping) else found:
            yield from _floats(part)
    elif isinstance(found, float):
        yield found


def _differences(
    recorded: Any, found: Any, name: str, off: float, as_worded: bool
) -> Iterator[str]:
    if isinstance(recorded, Mapping) and isinstance(found, Mapping):
        for key in dict.fromkeys([*found, *recorded]):
            path = f"{name}.{key}" if name else str(key)
            if key not in recorded:
                yield f"{path}, which is missing"
            elif key not in found:
                yield f"{path}, which no impact has"
            else:
                yield from _differences(recorded[key], found[key], path, off, as_worded)
    elif isinstance(recorded, list) and isinstance(found, list) and len(recorded) == len(found):
        for i, (one, other) in enumerate(zip(recorded, found, strict=True)):
            yield from _differences(one, other, f"{name}[{i}]", off, as_worded)
    elif not as_worded and name.endswith(_SENTENCES) and isinstance(recorded, str):
        return
    elif isinstance(recorded, (int, float)) and isinstance(found, float):
        # JSON may hold whole numbers beyond any float.
        if not (
            abs(recorded) <= sys.float_info.max
            and math.isclose(recorded, found, rel_tol=_OTHER_MACHINE, abs_tol=off)
        ):
            yield f"{name}, {recorded!r}, but {found!r}"
    elif recorded != found:
        yield f"{name}, {rendered(recorded)}, but {rendered(found)}"


def _bad(why: str) -> InputError:
    return InputError(
        f"the record of the report cannot be used: {why}; take the report as it was made",
        code="bad_record",
        argument="text",
    )
