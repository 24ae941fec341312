"""The report of a whole scene: the answer with its picture, each impact, findings, the ledger of
energy and the record.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from .. import plot
from ..derivation.explain import OF_VEHICLE, explain
from ..derivation.scene import ledger, rests
from ..derivation.wheels import wheel_rows
from ..diagnostics import diagnose
from ..diagnostics.finding import Findings, is_note
from ..messages.errors import CollisionsError, InputError
from ..quantities.document import Document
from ..quantities.reading import ArgumentReader
from ..quantities.settings import callers_options
from ..quantities.tables import as_sentence, cells, given_texts, label_of
from ..quantities.units import kinds_in_degrees, shown
from ..quantities.user_text import plain
from ..scene.contact import NO_POINT, USUAL_DELAY
from ..scene.results import result_of, results_of
from ..scene.run import Run
from ..uncertainty import Propagation
from ..vehicle.tyres import Tyres
from . import figures as drawing
from . import sections
from .answer import ranged_text
from .checking import FILED, check_alone
from .posterior_part import warned_of
from .record import record
from .render import Html, Markdown, Printed, Sheet
from .scene_words import contact_in_words, input_in_words
from .sections import EVIDENCE
from .uncertainty import Spread

# What is said of one impact, and not of a scene.
_OF_ONE = ("outline_a", "outline_b", "share_a", *EVIDENCE)
# The state of a vehicle, with the kind of each part, and what no table of inputs has of it.
_STATE = {
    "x": "length",
    "y": "length",
    "heading": "angle",
    "speed": "speed",
    "course": "angle",
    "yaw_rate": "yaw rate",
}
_AT_THE_START = {"speed": "speed", "course": "course"}
# A centre of mass this near [m] to the middle of its outline is in it.
_CENTRED = 1e-9
_LOOKED_AT = ("duration", "drag", "limits", "units")


def report_run(run: Run, given: Mapping[str, Any], unusual: Mapping[str, Any]) -> Document:
    """The page of one run; ``given`` has the arguments of ``report`` with its units known,
    ``unusual`` those that are not at their defaults, as the record holds them.
    """
    from .. import __version__

    paragraphs, uncertainty = _checked(given), given["uncertainty"]
    texts = given_texts(run)
    system = given["units"]
    printed = Printed(system, kinds_in_degrees(texts))
    sheet: Sheet = (Html if given["form"] == "html" else Markdown)(printed, {}, {})
    with callers_options():
        found = diagnose(run, **{name: given[name] for name in _LOOKED_AT} | {"units": system})
    draws = given["figures"] and isinstance(sheet, Html) and drawing.can_draw()
    names = ", ".join(run.scene.movers)
    sheet.title(plain(given["title"] or f"The crash of {names}"))
    filed = [(name, plain(given[name])) for name in FILED if given[name] is not None]
    if filed:
        sheet.file([(name.capitalize(), text) for name, text in filed])
    spread = Spread(run, uncertainty)
    for impact in run.impacts:
        sections.gain(sheet, impact, impact.energy_loss)
    _answer(sheet, run, found, draws, spread, uncertainty)
    _start(sheet, run)
    vehicles(sheet, run)
    for number, (time, pair, impact) in enumerate(
        zip(run.times, run.pairs, run.impacts, strict=True)
    ):
        title = f"Impact {number + 1}: {' and '.join(pair)} at {time:.2f} s"
        sheet.begin_part(plain(title), f"{number + 1}.")
        sections.gain(sheet, impact, impact.energy_loss)
        sections.inputs(sheet, impact, dict.fromkeys(EVIDENCE), {})
        sections.results(sheet, impact, None)
        sections.assumptions(sheet, impact, given, {}, {})
    sheet.end_parts()
    sheet.heading("Places of rest")
    sheet.table(rests(sheet, run))
    sheet.heading("Where the kinetic energy went")
    sheet.table(ledger(sheet, run))
    sheet.say(
        "What the ground took is worked out from the forces along the way, and not as the rest: "
        "the last line says how far the account closes."
    )
    if uncertainty is not None:
        spread.write(sheet, uncertainty)
    sections.findings(sheet, found)
    sections.moves(sheet, found.moves)
    if paragraphs:
        sheet.heading("Notes")
        for paragraph in paragraphs:
            sheet.say(paragraph)
    _figures(sheet, run, system, given["figures"], draws)
    if given["derivation"]:
        sheet.heading("Derivation")
        own = None if cells(None, texts).name == system else system
        sheet.working(explain(run, units=own))
    sections.sources(
        sheet,
        [
            (impact, [one for one in found if one.impact == number])
            for number, impact in enumerate(run.impacts)
        ],
    )
    sheet.say(f"Calculated with collisions {__version__}.")
    sheet.heading("Record")
    sheet.record(record(run, unusual, uncertainty))
    return Document(sheet.whole(__version__), given["form"])


def units_of_run(run: Run, units: Any) -> Any:
    """The units of the page: those asked for, or of the inputs."""
    return cells(units, given_texts(run)).name


def _checked(given: Mapping[str, Any]) -> list[str]:
    """The notes as paragraphs; one error names every option that cannot be used."""
    reader = ArgumentReader()

    def refuse(argument: str, text: str, code: str = "bad_option") -> None:
        reader.refuse(InputError(text, code=code, argument=argument))

    for name in _OF_ONE:
        if given[name] is not None:
            refuse(
                name,
                f"{name} is for one impact, and this is a run; leave it out, or write "
                f"report(run.impacts[0], {name}=...) for the impact that it is of",
            )
    # A run has neither answers nor shares to choose, and its notes are texts alone.
    check_alone(reader, {**given, "answers": None, "share_a": None, "notes": None})
    if given["uncertainty"] is not None and not isinstance(given["uncertainty"], Propagation):
        refuse(
            "uncertainty",
            "uncertainty must be what uncertainty.propagate returned for the scene, got "
            f"{type(given['uncertainty']).__name__}",
        )
    notes = given["notes"]
    listed = [] if notes is None else list(notes) if isinstance(notes, (list, tuple)) else [notes]
    for note in listed:
        if not isinstance(note, str) or not plain(note):
            refuse(
                "notes",
                f"notes must be a text that says something, got {shown(note)}: the report of a run "
                "has notes that are texts",
                "not_a_text",
            )
    reader.close()
    return [plain(note) for note in listed]


def _answer(
    sheet: Sheet,
    run: Run,
    found: Findings,
    draws: bool,
    spread: Spread,
    uncertainty: Propagation | None,
) -> None:
    """The box that has what was asked for with its range, the speeds before, what each impact did,
    and where all came to rest.
    """
    sheet.open_answer()
    outputs = {} if uncertainty is None else uncertainty.outputs
    known, ranged = results_of(run.scene, len(run.impacts)), {}
    for name, output in outputs.items():
        kind = spread.kind_of(output)
        text, has_range = ranged_text(sheet.system, output, kind)
        words = spread.heading(output)
        ranged[name] = (words, text) if has_range else None
        low, high = output.interval()
        value = result_of(run, name) if known.get(name, "rad") != "rad" else math.nan
        if value < low or value > high:
            sheet.stress(
                f"{words} of this run lies outside the 95 percent interval of the "
                "propagation: are both of the same scene?"
            )
    rows = [row for row in ranged.values() if row is not None]
    for name, mover in run.scene.movers.items():
        speed = mover.vehicle.speed
        text = sheet.system.answer(speed, "speed") if speed else "standing"
        rows.append((f"{plain(name)} at the start", text))
    for number, (time, pair, impact) in enumerate(
        zip(run.times, run.pairs, run.impacts, strict=True)
    ):
        for label, name, side in zip("ab", pair, (impact.a, impact.b), strict=True):
            if ranged.get(f"impacts[{number}].{label}.delta_v") is not None:
                continue
            what = f"delta-V of {plain(name)}, impact {number + 1} ({time:.2f} s)"
            rows.append((what, sheet.system.answer(side.delta_v, "speed")))
    rows += [
        (f"{plain(name)} at rest, x and y", _rest(sheet, run, name)) for name in run.scene.movers
    ]
    sheet.figures_of_answer(rows)
    says = "Calculated forward from the stated start, from contact to contact until all rest. "
    if any(row is not None for row in ranged.values()):
        says += "No range is stated for the figures above that have only one number."
    else:
        says += (
            "No range is stated for these figures: uncertainty.propagate and "
            "reconstruct.posterior take the scene with the errors of its inputs."
        )
    sheet.say(says)
    lines = [] if uncertainty is None else list(warned_of(uncertainty))
    lines += [
        (f"{label_of(finding.code)}:", as_sentence(plain(finding.sentence)))
        for finding in found
        if not is_note(finding) or finding.impact is None
    ]
    if lines:
        sheet.items(lines)
    picture = None
    if draws and isinstance(sheet, Html):
        caption = (
            "The scene from above, to scale: vehicles at the start, at the contacts and at rest."
        )
        picture = drawing.drawn(sheet, "scene", caption, plot.scene, run, units=sheet.system.name)
    sheet.close_answer(picture)


def _rest(sheet: Sheet, run: Run, name: str) -> str:
    try:
        rest = run.rest[name]
    except CollisionsError:
        return f"none: {run._why_no_rest(name)}"
    if rest.x is None or rest.y is None:
        return "not known"
    return ", ".join(sheet.system.answer(float(part), "length") for part in (rest.x, rest.y))


def _start(sheet: Sheet, run: Run) -> None:
    """The state of each vehicle at the start, in full."""
    rows = []
    for name, mover in run.scene.movers.items():
        body, of = mover.vehicle, plain(name)
        texts: Mapping[str, Any] = body.given or {}
        for part, kind in _STATE.items():
            value = getattr(body, part)
            if value is None:
                text = "not given"
            elif math.isnan(value):
                text = "none: it stands"
            else:
                text = sheet.as_given(float(value), kind, texts.get(part))
            rows.append((of, _AT_THE_START.get(part) or OF_VEHICLE[part][0], text))
    sheet.heading("At the start")
    sheet.table(rows)


def vehicles(sheet: Sheet, run: Run, marks: Mapping[str, str] | None = None) -> None:
    """What each vehicle moves on, the surfaces, and how contacts are placed; ``marks`` are words
    behind numbers that were not given, by their paths.
    """
    rows = []
    marked = {path: f", {word}" for path, word in (marks or {}).items()}

    def wheels(of: str, tyres: Tyres, path: str, when: str = "") -> Iterator[tuple[str, str, str]]:
        for part, what, value, kind in wheel_rows(tyres):
            word, size = marked.get(f"{path}.{part}", ""), float(value)
            text = sheet.system.answer(size, kind) if word else sheet.number(size, kind)
            yield of, f"{what}{when}", text + word

    for name, mover in run.scene.movers.items():
        of = plain(name)
        if mover.vehicle.name not in ("", name):
            rows.append((of, "name of the vehicle", plain(mover.vehicle.name)))
        if mover.outline is not None:
            rows += ((of, what, text) for what, text in _outline(sheet, mover.outline))
        if mover.drag is not None:
            drag, word = float(mover.drag), marked.get(f"{name}.drag", "")
            text = sheet.system.answer(drag, "number") if word else sheet.number(drag, "number")
            rows.append((of, "drag factor", text + word))
        if mover.tyres is not None:
            rows += wheels(of, mover.tyres, f"{name}.tyres")
        if mover.drag is None and mover.tyres is None:
            rows.append((of, "slowed by", "nothing"))
    for number, contact in enumerate(run.scene.contacts):
        when = f", after {plain(contact_in_words(run.scene, number))}"
        for name, tyres in contact.tyres_after.items():
            rows += wheels(plain(name), tyres, f"contacts[{number}].tyres_after.{name}", when)
    for number, (corners, friction) in enumerate(run.scene.surfaces):
        of = f"surface {number + 1}"
        rows.append((of, "corners", _corners(sheet, corners)))
        rows.append((of, "friction", sheet.number(float(friction), "number")))
    slopes = [float(part) for part in run.scene.slope]
    if any(slopes):
        rows.append(("ground", "slope along x, y", ", ".join(f"{part:.4g}" for part in slopes)))
    for name, paths in run.scene.shared.items():
        listed = "; ".join(plain(input_in_words(run.scene, path)) for path in paths)
        rows.append((plain(name), "one and the same number", listed))
    sheet.heading("Vehicles and ground")
    sheet.table(rows)
    rows = [
        row
        for number in range(len(run.scene.contacts))
        for row in _placed(sheet, run, number, marked)
    ]
    if run.scene.order is not None:
        claimed = ", then ".join(f"{one} and {other}" for one, other in run.scene.order)
        rows.append(("order", "as claimed", plain(claimed)))
    if rows:
        sheet.heading("How each contact is placed")
        sheet.table(rows)


def _outline(sheet: Sheet, outline: Any) -> Iterator[tuple[str, str]]:
    """The size of an outline, and where the centre of mass lies in it; of one that is no rectangle
    its corners.
    """
    length, width = (sheet.number(float(size), "length") for size in np.ptp(outline, axis=0))
    yield "outline", f"{length} by {width}"
    ends = np.array([outline.min(axis=0), outline.max(axis=0)])
    if len(outline) != 4 or not np.all((outline == ends[0]) | (outline == ends[1])):
        yield (
            "corners of the outline from the centre of mass, forward and left",
            _corners(sheet, outline),
        )
        return
    off = [
        f"{sheet.number(abs(float(part)), 'length')} {sides[int(part < 0.0)]}"
        for part, sides in zip(
            -ends.mean(axis=0),
            (("ahead of", "behind"), ("to the left of", "to the right of")),
            strict=True,
        )
        if abs(float(part)) > _CENTRED
    ]
    if off:
        yield "centre of mass", f"{' and '.join(off)} the middle of the outline"


def _corners(sheet: Sheet, corners: Any) -> str:
    return "; ".join(
        f"({', '.join(sheet.number(float(part), 'length') for part in corner)})"
        for corner in np.asarray(corners).tolist()
    )


def _placed(
    sheet: Sheet, run: Run, number: int, marked: Mapping[str, str]
) -> Iterator[tuple[str, str, str]]:
    """When a contact of the scene acts, and where its normal and its point come from; ``marked``
    are words behind numbers that were not given, by their paths.
    """
    contact = run.scene.contacts[number]
    of = plain(contact_in_words(run.scene, number))

    def given(name: str, kind: str) -> str:
        value = float(getattr(contact, name))
        if word := marked.get(f"contacts[{number}].{name}"):
            return sheet.system.answer(value, kind) + word
        return sheet.as_given(value, kind, contact.given.get(name))

    yield of, "when", "whenever the outlines touch" if contact.touches else given("at", "time")
    known = "given, printed with each impact"
    if contact.touches:
        what = "normal and point are taken" if contact.in_time else "the impulse acts"
        if not contact.from_outlines:
            yield of, what, "at first touch"
        elif contact.depth is not None:
            along = "the normal" if contact.normal is not None else "the normal of the face struck"
            yield of, f"{what} at a depth of overlap along {along}", given("depth", "length")
        else:
            delay = f"{sheet.number(float(USUAL_DELAY), 'time')}, the default"
            text = delay if contact.delay is None else given("delay", "time")
            yield of, f"{what} after first touch by", text
    normal = {
        "face": "that of the face struck at first touch",
        "crossings": "across the line through the points where the outlines cross",
    }[contact.plane]
    yield of, "normal", normal if contact.normal is None else known
    if contact.model not in NO_POINT:
        point = "the centroid of the overlap of the outlines"
        yield of, "point", point if contact.point is None else known


def _figures(sheet: Sheet, run: Run, units: str, wanted: bool, draws: bool) -> None:
    if not wanted:
        return
    sheet.heading("Figures")
    if not isinstance(sheet, Html):
        sheet.say("The figures are in the HTML form of this report.")
    elif not draws:
        sheet.say(
            "None: matplotlib cannot be imported here. Install it with: python -m pip install "
            "matplotlib"
        )
    else:
        caption = "Speeds over time, with the contacts."
        picture = drawing.drawn(sheet, "timeline", caption, plot.timeline, run, units=units)
        if picture is not None:
            sheet.picture(*picture)
