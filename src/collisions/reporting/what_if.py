"""``what_if``: one HTML page with a slider for each input, whose physics is the recorded kernel
printed as JavaScript.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from html import escape
from itertools import repeat
from operator import attrgetter
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

from ..engine.javascript import javascript
from ..impact.impact import Impact, build
from ..impact.models import BY_NAME, CANDIDATES, MODELS
from ..impact.reconstruction import KNOWN, Reconstruction
from ..kernels.contact_laws import RULES
from ..kernels.elementwise import FINITE, NOT_NEGATIVE, POSITIVE, restitution_domain
from ..messages.errors import InputError, Status
from ..messages.hints import hinted, parted
from ..plot.canvas import who
from ..quantities.directions import angle_of, direction, from_degrees
from ..quantities.document import Document
from ..quantities.formatting import SI_UNITS, UnitSystem, decimals_of, in_words, typeset
from ..quantities.printed_tables import html_row
from ..quantities.reading import OUTSIDE_UNITS, ArgumentReader, mixed_units, need_one_case
from ..quantities.tables import Cells, as_sentence, cells, given_texts, said
from ..quantities.units import Input, Texts, has_unit, shown
from ..quantities.user_text import plain
from ..vehicle.outlines import read_outline
from ..vehicle.vehicle import NAMES, Vehicle, moved

_PAGE = Path(__file__).with_name("what_if.html")
# The inputs that may have a slider, with their kinds: of the contact, and of a vehicle.
_CONTACT = {
    "restitution": "number",
    "normal": "angle",
    "point_x": "length",
    "point_y": "length",
} | dict.fromkeys(RULES, "number")
_BODY = {
    "speed": "speed", "course": "angle", "vx": "speed", "vy": "speed", "yaw_rate": "yaw rate",
    "mass": "mass",
    "yaw_inertia": "inertia", "x": "length", "y": "length", "heading": "angle",
}  # fmt: skip
SLIDERS = (*_CONTACT, *(f"{name}_{label}" for label in "ab" for name in _BODY))
_DOMAINS = {
    "speed": NOT_NEGATIVE, "mass": POSITIVE, "yaw_inertia": POSITIVE,
    **{name: rule.domain for name, rule in RULES.items()},
}  # fmt: skip
_WORDS = {"vx": "velocity along x", "vy": "velocity along y"}
# What the page shows and draws, by its path in an Impact and in a VehicleResult; the kinds of what
# it shows stand in the page.
_OF_EACH = (
    "before.speed", "after.speed", "delta_v", "pdof", "delta_yaw_rate", "before.x", "before.y",
    "before.heading", "before.vx",
    "before.vy", "after.vx", "after.vy", "impulse_x", "impulse_y",
)  # fmt: skip
_PATHS = (
    "closing_speed",
    "energy_loss",
    *(f"{label}.{name}" for label in "ab" for name in _OF_EACH),
)
_TO_DEGREES = 180.0 / math.pi
# The class of a table with a column for each vehicle, in its colour.
_SIDES = ' class="sides"'


# The results that evidence may be given of, with their kinds.
_SHOWN = {
    **{
        f"{label}.{name}": kind
        for label in "ab"
        for name, kind in (
            ("before.speed", "speed"),
            ("after.speed", "speed"),
            ("delta_v", "speed"),
            ("pdof", "angle"),
            ("delta_yaw_rate", "yaw rate"),
        )
    },
    "closing_speed": "speed",
    "energy_loss": "energy",
}
_RESULTS = {
    "before.speed": "speed before",
    "after.speed": "speed after",
    "delta_v": "delta-V",
    "pdof": "PDOF",
    "delta_yaw_rate": "change of yaw rate",
    "closing_speed": "closing speed",
    "energy_loss": "energy lost",
}


class Slider(NamedTuple):
    """One input of the page: angles in degrees, everything else in SI."""

    name: str
    kind: str
    low: float
    high: float
    start: float


class Evidence(NamedTuple):
    """What was observed of one result, in SI; both ends are the same where no range was given, and
    the path is empty where the page does not work it out.
    """

    words: str
    kind: str
    path: str
    low: float
    high: float


@hinted
def what_if(
    impact: Impact,
    ranges: Mapping[str, tuple[Input, Input]],
    *,
    outline_a: Any = None,
    outline_b: Any = None,
    observed: Mapping[str, Input | tuple[Input, Input]] | None = None,
    units: UnitSystem | None = None,
) -> Document:
    """One offline HTML page with a slider for each of these inputs, which redraws the scene,
    delta-V, PDOF, yaw and energy.

    At every move the page solves the impact again by the same model, also one that ``solve`` chose
    where the sliders start and need not take elsewhere (the page says so): the kernel itself,
    recorded and printed as JavaScript, so that both give the same numbers (sine, cosine and
    arctangent are the browser's). It loads nothing from outside, and works by keyboard and with
    screen readers.
    Inputs without a slider stand on it as given. For an impact that a reverse solver found, it
    computes forward from the motions found, and what it was found from stands, as it was given,
    beside what follows from the sliders; EES, speeds of maximum crush, and readings of a recorder
    away from the centre of mass or along turning axes, stand alone.

    Parameters
    ----------
    impact : Impact
        A single answered case of any solver; the sliders start at its values.
    ranges : dict
        Ends (low, high) of each slider by the name of the input, both with a unit or both in SI, on
        either side of the value in the impact. For a vehicle, however it was given: ``speed_a``,
        ``course_a``, or ``vx_a``, ``vy_a``; ``mass_a``, ``yaw_rate_a``, ``yaw_inertia_a``, ``x_a``,
        ``y_a``, ``heading_a``, and the same with ``_b``. For the contact: ``restitution``,
        ``normal``, ``point_x``, ``point_y``, and whichever of ``friction``, ``impulse_ratio`` and
        ``critical_fraction`` was given.
    outline_a, outline_b
        As for ``diagnose``, for the drawing; without it a vehicle with a heading is drawn 4.5 m by
        1.8 m, and the page says so.
    observed : dict, optional
        Evidence to be compared with the result of the same name: a number, or the ends (low, high)
        of its range in rising order, both with a unit or both in SI, outside which the page marks
        the result. Names
        are ``a.delta_v``, ``a.pdof``, ``a.delta_yaw_rate``, ``a.before.speed``, ``a.after.speed``,
        the same of ``b``, ``closing_speed`` and ``energy_loss``.
    units : {"si", "metric", "us"}, optional
        Units of the page; by default those that the inputs were given in, where they agree, else
        SI.

    Returns
    -------
    Document
        The page, a ``str`` that a notebook shows and that ``.save("page.html")`` writes to a file.

    Raises
    ------
    InputError
        A name that the model of this impact does not use, ends in the wrong order, a value of the
        impact outside them, or evidence of something that the page does not show.
    UnitsError
        One end of a range with a unit and one without, or a unit of another kind.
    ShapeError
        A batch: take one case of it.

    Examples
    --------
    >>> import collisions as col
    >>> a, b = col.Vehicle(mass="1500 kg", vx="50 km/h"), col.Vehicle(mass="1200 kg")
    >>> page = col.what_if(
    ...     col.linear_central(a, b, 0.2),
    ...     {"speed_a": ("30 km/h", "80 km/h"), "restitution": (0.0, 0.4)},
    ... )
    >>> page[:15], page.count('<input type="range"')
    ('<!DOCTYPE html>', 2)
    """
    need_one_case(impact, (Impact,), "what_if")
    system = cells(units, given_texts(impact))
    if BY_NAME.get(impact.model) not in MODELS:
        raise InputError(
            f"what_if has no page for {impact.model}; solve the case by eccentric",
            code="bad_option",
            argument="impact",
        )
    if impact.inputs.tyres and impact.model == "eccentric":
        raise InputError(
            "what_if has no page for an impact with tyres, whose force it would not work out "
            "again; write impact.again(tyres_a=None, tyres_b=None, duration=None), with what "
            "they give as outside_a and outside_b",
            code="bad_option",
            argument="impact",
        )
    sliders = _sliders(impact, ranges)
    evidence = _evidence(impact, observed)
    reader, given = ArgumentReader(), {"a": outline_a, "b": outline_b}
    read = {
        label: None if one is None else read_outline(reader, one, f"outline_{label}")
        for label, one in given.items()
    }
    reader.close()
    outlines = {
        label: None if corners is None else corners.tolist() for label, corners in read.items()
    }

    def page(*values: Any) -> dict[str, Any]:
        given = dict(zip((slider.name for slider in sliders), values, strict=True))
        return results(impact, given, [one.path for one in evidence if one.path])

    printed = javascript(page, len(sliders))
    return Document(_written(impact, sliders, evidence, outlines, printed, system), "html")


def results(impact: Impact, given: Mapping[str, Any], more: Iterable[str] = ()) -> dict[str, Any]:
    """The numbers of the page for these values of its sliders, and ``more`` of these paths: floats,
    arrays, or operands of a recording.
    """
    was = impact.inputs
    a, b = (_body(getattr(was, label), label, given) for label in "ab")
    normal = from_degrees(given["normal"]) if "normal" in given else was.normal
    point = was.point and (given.get("point_x", was.point[0]), given.get("point_y", was.point[1]))
    contact = {"normal": normal, "point": point, "rule_value": given.get(was.rule, was.rule_value)}
    contact |= {
        "restitution": given.get("restitution", was.restitution),
        "contact_velocity": None,
        "tolerance": None,
    }
    inputs = replace(was, model=impact.model, a=a, b=b, **contact)
    models = MODELS if impact.choice is None else CANDIDATES
    (model,) = (one for one in models if one.name == inputs.model)
    raw = model.answer(inputs)
    answer = build(inputs, raw)
    found = {"status": raw.status, "nx": normal[0], "ny": normal[1]} | {
        path: attrgetter(path)(answer) for path in dict.fromkeys((*_PATHS, *more))
    }
    found |= {} if point is None else {"px": point[0], "py": point[1]}
    return {name: value for name, value in found.items() if value is not None}


def _body(vehicle: Vehicle, label: str, given: Mapping[str, Any]) -> Vehicle:
    """The vehicle with the values of its sliders."""
    changed = {name: given[f"{name}_{label}"] for name in _BODY if f"{name}_{label}" in given}
    body: Any = SimpleNamespace(**{name: getattr(vehicle, name) for name in NAMES} | changed)
    if changed.keys() & {"speed", "course"}:
        cx, cy = from_degrees(changed["course"]) if "course" in changed else _heading_for(vehicle)
        speed = changed.get("speed", vehicle.speed)
        body.vx, body.vy = speed * cx, speed * cy
    if "heading" in changed:
        body.heading = changed["heading"] * (math.pi / 180.0)
    return moved(body, body.vx, body.vy, body.yaw_rate)


def _heading_for(vehicle: Vehicle) -> tuple[Any, Any]:
    """The direction in which the vehicle moves; for one at rest, the course as it was given."""
    if vehicle.speed > 0.0:
        return vehicle.vx / vehicle.speed, vehicle.vy / vehicle.speed
    return direction(ArgumentReader(), Texts(vehicle.given)["course"], "course")


def starts(impact: Impact) -> dict[str, Any]:
    """The value of each input that may have a slider, angles in degrees; NaN where only its range
    is known.
    """
    inputs, takes = impact.inputs, BY_NAME[impact.model].paths
    found = {"restitution": inputs.restitution, "normal": impact.normal_angle}
    if "rule_value" in takes:
        found[inputs.rule] = inputs.rule_value
    if "point[0]" in takes and inputs.point is not None:
        found |= {"point_x": inputs.point[0], "point_y": inputs.point[1]}
    for label, body in (("a", inputs.a), ("b", inputs.b)):
        free = ("speed", "course", "vx", "vy") if body.pivot is None else ()
        names = [
            *free,
            *(name for name in _BODY if f"{label}.{name}" in takes and name not in ("vx", "vy")),
            "heading",
        ]
        found |= {
            f"{name}_{label}": getattr(body, name)
            for name in names
            if getattr(body, name) is not None
        }
        if not body.speed > 0.0 and free and "course" in (body.given or {}):
            found[f"course_{label}"] = angle_of(*_heading_for(body))
    return {
        name: _TO_DEGREES * value if _kind(name) == "angle" else value
        for name, value in found.items()
    }


def _kind(name: str) -> str:
    return (_CONTACT | _BODY)[parted(name)[0]]


def _sliders(impact: Impact, ranges: Any) -> list[Slider]:
    """The sliders; one error names every range that cannot be used."""
    reader, known, found = ArgumentReader(), starts(impact), []

    def refuse(text: str, argument: str = "ranges", code: str = "bad_inputs") -> None:
        reader.refuse(InputError(text, code=code, argument=argument))

    if not isinstance(ranges, Mapping) or not ranges:
        example = "`{'speed_a': ('40 km/h', '70 km/h')}`"
        refuse(
            f"ranges must be `|a dict|a table` of `(low, high)` by input, such as {example}, got "
            f"{shown(ranges)}"
        )
        ranges = {}
    for name, ends in ranges.items():
        if name not in known:
            refuse(
                f"{shown(name)} is no input of this {impact.model} that could be moved; take "
                f"some of {', '.join(known)}"
            )
            continue
        count = len(reader.problems)
        _refuse_mixed(reader, name, ends)
        numbers = (
            [_end(reader, name, end, impact) for end in ends]
            if isinstance(ends, (tuple, list))
            else []
        )
        if len(reader.problems) > count:
            continue
        if len(numbers) != 2 or not all(
            isinstance(end, float) and math.isfinite(end) for end in numbers
        ):
            refuse(
                f"{name} must be a pair of finite numbers `(low, high)`, got {shown(ends)}",
                name,
                "bad_range",
            )
            continue
        (low, high), kind = numbers, _kind(name)
        middle = 0.5 * low + 0.5 * high
        start = middle if math.isnan(known[name]) else known[name]
        if kind == "angle":
            start += 360.0 * round((middle - start) / 360.0)
        if not (low < high and low <= start <= high):
            now = (
                f"{start:.10g}°" if kind == "angle" else said(start, kind, given_texts(impact), 10)
            )
            bare = (
                ""
                if kind == "number" or has_unit(ends[0])
                else f", in {'rad' if kind == 'angle' else SI_UNITS[kind]}"
            )
            text = (
                f"{name} must be a pair `(low, high)` in rising order around {now}, got "
                f"{shown(ends)}{bare}"
            )
            refuse(text, name, "bad_range")
        found.append(Slider(name, kind, low, high, start))
    for label in "ab":
        moving = [name for name in ("vx", "vy", "speed", "course") if f"{name}_{label}" in ranges]
        if {"vx", "vy"} & set(moving) and {"speed", "course"} & set(moving):
            text = (
                f"the velocity of {label} is moved in two ways, by {' and '.join(moving)}; take "
                "vx and vy, or speed and course"
            )
            refuse(text, code="speed_twice")
        if moving == ["speed"] and math.isnan(known.get(f"course_{label}", 0.0)):
            text = (
                f"{label} is at rest, so its course is not known; give course_{label} a range too"
            )
            refuse(text, f"course_{label}", "missing_course")
    reader.close()
    return found


def _evidence(impact: Impact, observed: Any) -> list[Evidence]:
    """What was observed, and of an impact that a reverse solver found, what it was found from; one
    error names all that cannot be compared.
    """
    reader, found = ArgumentReader(), []
    if observed is not None and not isinstance(observed, Mapping):
        example = "`{'a.delta_v': ('20 km/h', '24 km/h')}`"
        text = f"observed must be a dict by result, such as {example}, got {shown(observed)}"
        reader.refuse(InputError(text, code="bad_inputs", argument="observed"))
        observed = None
    for path, given in (observed or {}).items():
        kind = _SHOWN.get(path) if isinstance(path, str) else None
        if kind is None:
            text = f"observed: the page has no {shown(path)}; take some of {', '.join(_SHOWN)}"
            reader.refuse(InputError(text, code="unknown_name", argument="observed"))
            continue
        pair = isinstance(given, (tuple, list))
        ends = given if pair else (given, given)
        name = f"observed[{path!r}]"
        count = len(reader.problems)
        _refuse_mixed(reader, name, ends)
        numbers = [_observed(reader, kind, end, name) for end in ends]
        if len(reader.problems) > count:
            continue
        if len(numbers) != 2 or not all(isinstance(number, float) for number in numbers):
            text = f"{name} must be a number or a pair of numbers `(low, high)`, got {shown(given)}"
            reader.refuse(InputError(text, code="bad_range", argument=name))
            continue
        if pair and not numbers[0] < numbers[1]:
            text = f"{name} must be a pair `(low, high)` in rising order, got {shown(given)}"
            reader.refuse(InputError(text, code="bad_range", argument=name))
            continue
        side, _, result = path.partition(".")
        words = f"{_RESULTS[result]} of {side.upper()}" if result else _RESULTS[path]
        found.append(Evidence(words, kind, path, *numbers))
    reader.close()
    of_origin = () if impact.reconstruction is None else _found_from(impact.reconstruction)
    return [*found, *(one for one in of_origin if not one.path or one.path not in (observed or {}))]


def _found_from(origin: Reconstruction) -> Iterator[Evidence]:
    """What an impact was found from, as it was given, from which the answer may differ."""
    for name, value in origin.given.items():
        # Courses before are inputs of the page.
        if name not in KNOWN or name.startswith(("course_", "recorder_")):
            continue
        what, kind, path, _ = KNOWN[name]
        # What is stated of the contact and not an output of it stays as it was.
        stated = path.startswith("reconstruction.")
        if isinstance(value, float) and math.isfinite(value) and not stated:
            yield Evidence(what, kind, path, value, value)


def _refuse_mixed(reader: ArgumentReader, name: str, ends: Any) -> None:
    """Refuse a range of which one end has a unit and the other none."""
    if isinstance(ends, (tuple, list)) and len(ends) == 2:
        by_name = {f"{name} {end}": value for end, value in zip(("low", "high"), ends, strict=True)}
        if (mixed := mixed_units(by_name, name)) is not None:
            reader.refuse(mixed)


def _observed(reader: ArgumentReader, kind: str, given: Any, name: str) -> Any:
    """One end of what was observed, in SI; angles in radians."""
    if kind != "angle":
        return reader.number(given, SI_UNITS[kind], name)
    value, degrees = reader.angle(given, name)
    return value / _TO_DEGREES if degrees and isinstance(value, float) else value


def _fixed(impact: Impact, sliders: Sequence[Slider], system: Cells) -> list[tuple[str, list[str]]]:
    """The inputs without a slider as rows of texts: of both vehicles, or of the contact."""
    moved_here = {slider.name for slider in sliders}
    values = starts(impact)
    for label in "ab":
        # A velocity stands as it is moved, or by speed and course.
        by_parts = {f"vx_{label}", f"vy_{label}"} & moved_here
        for name in ("speed", "course") if by_parts else ("vx", "vy"):
            values.pop(f"{name}_{label}", None)

    def text(name: str) -> str:
        value, kind = values.get(name, math.nan), _kind(name)
        if name in moved_here:
            return "moved"
        own, label = parted(name)
        texts = (getattr(impact.inputs, label) if label else impact.inputs).given or {}
        if isinstance(texts.get(own), str):
            return typeset(texts[own])
        if math.isnan(value):
            return "–"
        if math.isinf(value):
            return in_words(value)
        # An input has six figures, more than a result.
        number = value if kind == "angle" else system.converted(value, kind)
        return f"{number:.6g}" + ("°" if kind == "angle" else system.unit(kind))

    rows = [
        (_WORDS.get(name, name.replace("_", " ")), [text(name)])
        for name in _CONTACT
        if name in values and name not in moved_here
    ]
    for name in _BODY:
        both = [f"{name}_{label}" for label in "ab"]
        if any(one in values and one not in moved_here for one in both):
            rows.append((_WORDS.get(name, name.replace("_", " ")), [text(one) for one in both]))
    inputs = impact.inputs
    if inputs.law is not None:
        rows.append(("law", [inputs.law]))
    for label in "ab":
        outside = getattr(inputs, f"outside_{label}")
        if outside is not None and any(outside):
            parts = ", ".join(
                system.text(part, unit) for part, unit in zip(outside, OUTSIDE_UNITS, strict=True)
            )
            rows.append((f"impulse from outside on {label.upper()}", [parts]))
    return rows


def _chosen(impact: Impact, system: Cells) -> str:
    """Where ``solve`` took a smaller model for the start, which need not do elsewhere."""
    if impact.choice is None or impact.choice._keeps_all:
        return ""
    timed = impact.inputs.duration is not None
    fuller = "" if timed else "; for a page without that error take eccentric"
    return (
        f" The model was chosen by solve for where the sliders start "
        f"({impact.choice._reason_in(system)}). The page keeps it: how far it errs elsewhere is "
        f"not worked out, and solve may take another model there{fuller}."
    )


def _table(caption: str, heads: Sequence[str], rows: Iterable[str], kind: str = "") -> str:
    """An HTML table, or nothing where it has no rows."""
    body = "\n".join(rows)
    cells_of_head = "".join(f'<th scope="col">{escape(head)}</th>' for head in heads)
    return body and (
        f"<table{kind}>\n<caption>{caption}</caption>\n<thead><tr>{cells_of_head}</tr></thead>\n"
        f"<tbody>\n{body}\n</tbody>\n</table>"
    )


def _end(reader: ArgumentReader, name: str, given: Any, impact: Impact) -> Any:
    """One end of a range, in degrees or SI."""
    kind = _kind(name)
    if kind == "angle":
        value, in_degrees = reader.angle(given, name)
        return value if in_degrees or not isinstance(value, float) else _TO_DEGREES * value
    domains = _DOMAINS | {"restitution": restitution_domain(impact.inputs.incomplete)}
    return reader.number(given, SI_UNITS[kind], name, domains.get(parted(name)[0], FINITE))


def _written(
    impact: Impact,
    sliders: list[Slider],
    evidence: list[Evidence],
    outlines: Mapping[str, Any],
    printed: str,
    system: Cells,
) -> str:
    """The page: its sliders as HTML, what else the script needs as JSON, and the printed kernel."""
    from .. import __version__

    bodies = {"a": impact.inputs.a, "b": impact.inputs.b}
    names = {label: plain(who(at, body)) for at, (label, body) in enumerate(bodies.items())}
    units = {
        kind: {
            "unit": typeset(system.label(kind)),
            "scale": system.scale(kind),
            "decimals": decimals_of(kind, system.name),
        }
        for kind in SI_UNITS
    }
    inputs = []
    for name, kind, *numbers in sliders:
        own, label = parted(name)
        words = escape(
            _WORDS.get(own, own.replace("_", " ")) + (f" of {names[label]}" if label else "")
        )
        scale = system.scale(kind) / (_TO_DEGREES if kind == "angle" else 1.0)
        low, high, start = (repr(number * scale) for number in numbers)
        ends = f"{float(low):.6g} to {float(high):.6g}"
        inputs.append(
            f'<p><label for="{name}">{words} '
            f'<small>{ends}{system.unit(kind)}</small></label><output for="{name}" '
            f'id="{name}-value" aria-hidden="true"></output><input type="range" id="{name}" '
            f'min="{low}" max="{high}" value="{start}" step="any" data-kind="{kind}" '
            f'data-start="{numbers[2]!r}" data-factor="{1.0 / scale!r}"></p>'
        )
    data = {
        "units": units,
        "sentences": {int(status): status.sentence for status in Status},
        "names": names,
        "outlines": outlines,
        "fixed": {label: math.isinf(body.mass) for label, body in bodies.items()},
    }
    seen = []
    for one in evidence:
        bounds = f' data-low="{one.low!r}" data-high="{one.high!r}"' if one.low < one.high else ""
        # The script fills in what the model gives now.
        now = f' id="seen.{one.path}" data-path="{one.path}" data-kind="{one.kind}"{bounds}'
        given = system.span(one.low, one.high, one.kind)
        if one.path:
            seen.append(html_row(one.words, given, "", of_cells=("", now)))
        else:
            seen.append(html_row(one.words, given, "not worked out here"))
    not_moved = [
        html_row(what, *texts, of_cells=repeat(" colspan=2" if len(texts) == 1 else ""))
        for what, texts in _fixed(impact, sliders, system)
    ]
    text = _PAGE.read_text(encoding="utf-8")
    statements = (plain(as_sentence(one)) for one in impact.statements)
    stated = (*impact._bounds(system), *statements)
    said = "".join(f"<p>{escape(typeset(one))}</p>" for one in stated)
    heading = (
        "As given, not moved" if impact.reconstruction is None else "Given or found, not moved"
    )
    for name, part in {
        "evidence": _table("Evidence", ("observed", "reading", "now"), seen),
        "fixed": said + _table(heading, ("input", names["a"], names["b"]), not_moved, _SIDES),
        "title": escape(f"What if: {names['a']} and {names['b']}"),
        "model": escape(f"{BY_NAME[impact.model].assumptions}{_chosen(impact, system)}"),
        "inputs": "\n".join(inputs),
        "a": escape(names["a"]),
        "b": escape(names["b"]),
        "version": __version__,
        "kernel": printed,
        "data": json.dumps(data).replace("<", "\\u003c"),
    }.items():
        text = text.replace(f"<!--{name}-->", part)
    return text
