"""The sections of a report: inputs, assumptions, results, findings and sources."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from .. import reference
from ..derivation import reverse
from ..derivation.evidence import momentum_answers, momentum_assumption, momentum_inputs
from ..derivation.explain import impact_answers, impact_inputs, key_of
from ..derivation.reverse import COMES_OUT, evidence_of, found_inputs
from ..diagnostics import LIMITS, Finding
from ..diagnostics.diagnosis import read_limits
from ..diagnostics.finding import Findings, is_note, letter_of
from ..diagnostics.moves import Moves
from ..impact.impact import Impact
from ..impact.instant import LIMITED, found_backwards, neglected
from ..impact.left_out import LeftOutVehicle, left_out, tyres_held, tyres_lacking
from ..impact.models import BY_NAME
from ..impact.reconstruction import number_of_text
from ..impact.run import gain_of_steps
from ..kernels.contact_laws import FRICTION, LAWS
from ..messages.errors import Status
from ..plot.canvas import who
from ..quantities.formatting import (
    KIND_OF,
    SI_UNITS,
    percent,
    places,
    typeset,
    with_decimals,
)
from ..quantities.reading import ArgumentReader
from ..quantities.tables import Sentences, as_sentence, label_of
from ..quantities.units import Input
from ..quantities.user_text import plain
from ..reconstruct import MomentumSolution
from ..reconstruct.momentum_solution import TYRES_HELD
from ..reconstruct.momentum_tyres import neglected as momentum_neglect
from ..reconstruct.momentum_tyres import what_is_sought
from ..vehicle.drag import read_drag, read_duration
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle, named
from .render import Sheet, given_as
from .uncertainty import Spread
from .words import Names

# End states that still approach by up to a hundredth of the closing speed are taken to stay
# together.
_TOGETHER = 0.02
# Components of delta-V are measured: if more are given than are needed, they are met only as well
# as they agree.
_COMPONENTS, _RECORDED = ("delta_v_forward", "delta_v_left"), 0.3
# The state before by its words among the results, as its names in ``notes``.
_BEFORE = {
    "velocity before, along x": "vx",
    "velocity before, along y": "vy",
    "speed before": "speed",
    "yaw rate before": "yaw_rate",
}
_DEGREE = math.degrees(1.0)
# In the units of the page: what moves a speed by less moves it only by the rounding of a sine.
_ROUNDING = 1e-12
# What the damage shows, by the option that says it: what it is of, in words, and its kind.
EVIDENCE = {
    "crush_energy": ("damage", "crush energy, both vehicles", "energy"),
    "damage_pdof_a": ("A", "PDOF that the damage shows", "angle"),
    "damage_pdof_b": ("B", "PDOF that the damage shows", "angle"),
    "damage_delta_v_a": ("A", "delta-V that the damage or the recorder shows", "speed"),
    "damage_delta_v_b": ("B", "delta-V that the damage or the recorder shows", "speed"),
}
_REGIMES = {
    "frictionless": "none: the contact is frictionless",
    "sliding": (
        "the contact slips to the end, and the impulse ratio has the size of the friction given"
    ),
    "sticking": "slip ends during the contact, with less than the friction given",
    "reversing": (
        "slip stops during the contact and goes on the other way, against which friction then acts"
    ),
    "given": "by the ratio that was given, not by a law of friction",
}
_GEOMETRIES = {
    "maximum_engagement": (
        "those given are of maximum engagement; the start of the contact was found from them, and "
        "places and normal move with the vehicles."
    ),
    "first_contact": "those given are of first contact; places and normal move with the vehicles.",
    "fixed": "places and normal stay as given during the contact.",
}
_TYRES = (
    "their mean force before, half-way through and after the contact, times its duration, acts "
    f"as an impulse from outside, {LIMITED}; wheels roll, brake and steer, with the force that "
    "they have on the way to rest."
)
_OWN = "delta-V from its own tyres"
_RANGE = (
    reference.RESTITUTION_FIT,
    reference.RESTITUTION_LOW_SPEED,
    reference.RESTITUTION,
    reference.RESTITUTION_OBLIQUE,
    reference.RESTITUTION_SMALL_OVERLAP,
)
# A published value in the source of a limit.
_PUBLISHED = re.compile(r"reference\.(\w+)")
# Below and above 30 mph.
_DRAG = tuple(
    value
    for value in reference.DRAG_FACTORS
    if value.name.startswith("drag factor, travelled dry asphalt,")
)


def gain(sheet: Sheet, impact: Impact | MomentumSolution, loss: float) -> None:
    """Write the warning of an energy gain, before anything else."""
    if impact.status == Status.ENERGY_GAIN:
        steps = gain_of_steps(impact.inputs) if isinstance(impact, Impact) else ""
        why = steps or (
            f"{impact.status.sentence}, which no impact gives. The inputs do not go together; the "
            "numbers are shown as they are"
        )
        sheet.stress(f"Energy gain of {sheet.system.answer(-loss, 'energy')}: {why}.")


def inputs(
    sheet: Sheet,
    impact: Impact,
    options: Mapping[str, Any],
    notes: Mapping[str, str],
    spread: Spread | None = None,
    marks: Mapping[str, str] | None = None,
) -> None:
    """Write the inputs with the texts they were given as, and the choice of the model or how the
    state was found; ``marks`` are words behind those that were not given, by their names.
    """
    marked = marks or {}
    found_names = found_inputs(impact)
    sheet.heading("Inputs")
    vehicles = {"A": impact.a.before, "B": impact.b.before}
    rows: list[tuple[str, str, str]] = []
    for of, quantity, names, numbers, kind in impact_inputs(impact):
        vehicle = vehicles.get(of)
        if key_of(of, names) in found_names and names[0] != FRICTION:
            continue
        texts = (impact.inputs.given if vehicle is None else vehicle.given) or {}
        if names[0].startswith("tyres_"):
            wheels = impact.inputs.tyres.items()
            texts = {
                f"tyres_{label}.{one}": text
                for label, own in wheels
                for one, text in own.given.items()
            }
        name = (
            f"{of} ({plain(named(vehicle.name))})"
            if vehicle is not None and vehicle.name not in ("", of)
            else of
        )
        note = notes.get(key_of(of, names))
        value = _input(sheet, impact, vehicle, dict(zip(names, numbers, strict=True)), kind, texts)
        own = "" if vehicle is None else f"{of.lower()}."
        words = [marked.get(own + one, "") for one in names]
        if any(words):
            value = _found(sheet, numbers, words, kind)
        # Found of a contact that slid: the impulse ratio, which the results have too.
        value += ", found" if key_of(of, names) in found_names else ""
        rows.append((name, quantity, _with(value, note)))
        rows += [(name, what, text) for what, text in _published(impact, names[0])]
        if vehicle is not None and quantity == "mass":
            for what, number in speed_rows(vehicle):
                if f"{of.lower()}.{what}" in found_names:
                    continue
                found = (
                    ""
                    if number is None
                    else sheet.number(number, "speed" if what == "speed" else "angle")
                )
                text = (
                    plain(texts[what])
                    if number is None
                    else given_as(found, texts.get(what, found))
                )
                rows.append((name, what, _with(text, notes.get(f"{of.lower()}.{what}"))))
    in_line = impact.reconstruction is not None and impact.reconstruction.method == "central"
    if impact.law is not None and impact.model in ("oblique_central", "eccentric") and not in_line:
        rows.append(("contact", "law of restitution", _with(impact.law.title(), notes.get("law"))))
    if impact.inputs.incomplete:
        rows.append(("contact", "restitution below 0 (incomplete impact)", "allowed"))
    rows += _known(sheet, impact, notes, spread)
    rows += _damage(sheet, options)
    sheet.table(rows)
    if any("given as" in text for *_, text in rows):
        sheet.say(
            "“Given as” repeats the text of an input that was given in another unit than that of "
            "this page."
        )
    if found_names:
        sheet.say("The rest was found, and stands under Results.")
    sheet.say("The record at the end has every digit.")


def _with(value: str, note: str | None) -> str:
    """What is printed of an input, and the note beside it."""
    return f"{value}. {note}" if note else value


def _found(sheet: Sheet, numbers: Sequence[float], words: Sequence[str], kind: str) -> str:
    """One number or both of a place of which some were found, rounded as results are."""
    texts = [
        f"{sheet.system.answer(float(number), kind)}, {word}"
        if word
        else sheet.number(number, kind)
        for number, word in zip(numbers, words, strict=True)
    ]
    if len(texts) == 1:
        return texts[0]
    return "; ".join(f"{axis}: {text}" for axis, text in zip("xy", texts, strict=True))


def _published(impact: Impact, name: str) -> Iterator[tuple[str, str]]:
    """Rows of published values, with their source, beside a restitution, a friction or a drag."""
    if name == "restitution":
        yield "restitution published for such a closing speed", _restitution(impact.closing_speed)
    elif name == "drag":
        below, above = (f"{value.low:g} to {value.high:g}" for value in _DRAG)
        text = f"{below} below 30 mph, {above} from there on ({_short(_DRAG[0])})"
        yield "drag published for locked wheels on travelled dry asphalt", text
    elif name == FRICTION and 0.0 < impact.inputs.rule_value < math.inf:
        found = reference.INTER_VEHICLE_FRICTION
        text = f"{found.low:g} to {found.high:g}, typically {found.typical:g} ({_short(found)})"
        yield "friction published between vehicle bodies", text


def _restitution(closing_speed: float) -> str:
    """The published range of the restitution at a closing speed, and its source."""
    low, high = reference.restitution_range(closing_speed)
    slowest, fastest, _ = reference.RESTITUTION_FIT.ranges["closing_speed"]
    if closing_speed < slowest:
        return "none: no value is published for so low a speed"
    if closing_speed <= fastest:
        whence = (
            f"{_short(reference.RESTITUTION_FIT)}, plus half the range of "
            f"{_short(reference.RESTITUTION_LOW_SPEED)}"
        )
    else:
        rule, tests = (
            reference.RESTITUTION,
            (reference.RESTITUTION_OBLIQUE, reference.RESTITUTION_SMALL_OVERLAP),
        )
        whence = (
            f"{_short(rule)}, to {rule.high:g}; tests, to {max(test.high for test in tests):g}; "
            "rounded up"
        )
    return f"{low:.2g} to {high:.2g} ({whence})"


def _short(value: reference.Published | reference.Fit) -> str:
    """Author and work of a source, short enough for a table."""
    return re.split(r", as |, chapter|, abstract| \(", value.source)[0]


def _input(
    sheet: Sheet,
    impact: Impact,
    vehicle: Vehicle | None,
    numbers: Mapping[str, float],
    kind: str,
    texts: Mapping[str, Any],
) -> str:
    """One number or both of a place, and how they were given."""
    value = ", ".join(sheet.number(number, kind) for number in numbers.values())
    written = [texts[name] for name in numbers if isinstance(texts.get(name), str)]
    if len(written) == len(numbers):
        return given_as(value, ", ".join(written))
    if kind == "speed" and vehicle is not None and vehicle.pivot is not None:
        return f"{value}, worked out from yaw rate and pivot"
    if kind == "speed" and texts.keys() & {"speed", "course"}:
        return f"{value}, worked out from speed and course"
    if "normal" in numbers and impact.inputs.bare_normal is not None:
        return f"{value}, given as {impact.inputs.bare_normal:.6g} without a unit"
    each = [
        sheet.as_given(float(number), kind, texts.get(name)) for name, number in numbers.items()
    ]
    return (
        "; ".join(f"{axis}: {part}" for axis, part in zip("xy", each, strict=True))
        if written
        else ", ".join(each)
    )


def speed_rows(vehicle: Vehicle) -> Iterator[tuple[str, float | None]]:
    """Speed and course if the velocity was given by them; at rest there is no course, except as a
    text that was given.
    """
    texts: Mapping[str, Any] = vehicle.given or {}
    for name, value in (("speed", vehicle.speed), ("course", vehicle.course)):
        if not math.isnan(value) and texts.keys() & {"speed", "course"}:
            yield name, value
        elif name in texts:
            yield name, None


def _known(
    sheet: Sheet, impact: Impact, notes: Mapping[str, str], spread: Spread | None
) -> Iterator[tuple[str, str, str]]:
    """Table rows with what a reverse solver was given, as texts or as numbers, and what was stated
    of it.
    """
    names = Names(impact)
    for one in evidence_of(impact):
        if one.number is None and one.text is None:
            # Which axes a recorder's are is stated in words.
            value = "stated" if "_axes_" in one.name else "kept only in what was found from it"
        else:
            value = sheet.as_given(one.number, one.kind, one.text)
        if one.differs and one.number is not None and one.answer is not None:
            answer = sheet.number(one.answer, one.kind)
            if answer != sheet.number(one.number, one.kind):
                value += f"; {answer} in this answer"
        if one.number is not None and spread is not None:
            stated = spread.stated(sheet, one.name, one.kind, one.number)
            if stated and stated not in notes.get(one.name, ""):
                value += f"; stated as {stated}"
        yield "evidence", names(one.what), _with(value, notes.get(one.name))


def evidence_names(impact: Impact) -> list[str]:
    """What a reverse solver was given besides the contact and the vehicles, by name."""
    return [one.name for one in evidence_of(impact)]


def contradicted(impact: Impact) -> Iterator[str]:
    """The known inputs of a reverse solver, texts and numbers, that the impact contradicts."""
    sides = (impact.a, impact.b)
    speeds = impact.closing_speed + sum(
        state.speed for side in sides for state in (side.before, side.after)
    )
    turning = sum(abs(side.before.yaw_rate) + abs(side.after.yaw_rate) for side in sides)
    together = _TOGETHER if impact.restitution == 0.0 else 0.0
    allowed = {
        "speed": COMES_OUT * speeds + together * impact.closing_speed,
        "energy": COMES_OUT * (abs(impact.energy_absorbed) + abs(impact.energy_loss)),
        "yaw rate": COMES_OUT * turning + _TOGETHER,
        "angle": COMES_OUT + together,
        **dict.fromkeys(("time", "number"), COMES_OUT),
    }
    evidence = evidence_of(impact)
    if impact.regime == "sticking" and any(
        one.name.startswith((*_COMPONENTS, "reading")) for one in evidence
    ):
        # Beside components an energy of a contact that stuck is met as well as they agree with it;
        # it goes as the square of the impulse.
        allowed["energy"] = 2.0 * _RECORDED * abs(impact.energy_loss)
    for one in evidence:
        unit = SI_UNITS[one.kind]
        by_text = None if one.text is None else number_of_text(one.text, one.name)
        for given, as_given in ((by_text, repr(one.text)), (one.number, f"{one.number!r} {unit}")):
            if given is None or one.answer is None:
                continue
            # A speed may come out negative, with the opposite course; at rest there is no course.
            apart = given - one.answer
            apart = math.remainder(apart, math.pi) if one.kind == "angle" else apart
            measured = one.name.startswith(_COMPONENTS)
            if abs(apart) > (
                _RECORDED * max(side.delta_v for side in sides) if measured else allowed[one.kind]
            ):
                yield (
                    f"{one.name} was given as {as_given}, but the {one.what} is {one.answer!r} "
                    f"{unit}"
                )


def momentum_assumptions(
    sheet: Sheet, solution: MomentumSolution, options: Mapping[str, Any]
) -> None:
    """Write what planar momentum rests on, and what it leaves out."""
    sheet.heading("Assumptions")
    together = " The vehicles leave together." if "together" in (solution.given or {}) else ""
    sheet.say(f"{momentum_assumption(solution)}{together}")
    say = Sentences(solution._texts(), sheet.system.name)
    for sentence in (
        *_momentum_neglect(sheet, solution, options),
        *solution._second_course(say),
        *solution._pushed(),
    ):
        sheet.say(as_sentence(sentence))


def momentum_inputs_and_results(
    sheet: Sheet, solution: MomentumSolution, options: Mapping[str, Any], notes: Mapping[str, str]
) -> None:
    """Write inputs and results of planar momentum, and how far each input moves them."""
    given: dict[str, Any] = {}
    for name, value in (solution.given or {}).items():
        if isinstance(value, Tyres):
            given |= {f"{name}.{one}": text for one, text in value.given.items()}
            continue
        given |= (
            {f"{name}[{at}]": part for at, part in enumerate(value)}
            if isinstance(value, list)
            else {name: value}
        )
    sheet.heading("Inputs")
    rows = []
    for of, what, name, number, kind in momentum_inputs(solution):
        text, note = given.get(name), notes.get(name.partition("[")[0])
        value = sheet.as_given(number, kind, text if isinstance(text, str) else None)
        rows.append((of, what, _with(value, note)))
    sheet.table([*rows, *_damage(sheet, options)])
    sheet.heading("Results")
    what = {
        "speeds": "from the angle between the courses of the unknown speeds",
        "velocity": "the sum of the other momenta over what they leave",
        "beside": "from the angle between the unknown course and that of the unknown speed",
    }[what_is_sought(solution)]
    rows = [
        *momentum_answers(sheet, solution),
        ("both", f"condition, {what}", f"{solution.condition:.3g}"),
    ]
    system = sheet.system
    for answer, row in solution.sensitivity.items():
        turns = answer.startswith("course")
        of_answer = _DEGREE if turns else system.scale("speed")
        label = "°" if turns else f" {typeset(system.label('speed'))}"
        for name, value in row.items():
            kind = {"mass": "mass", "speed": "speed", "course": "angle", "outside": "impulse"}[
                name.partition("_")[0]
            ]
            # Nobody errs by a radian: per degree in every system.
            scale, unit = (
                (_DEGREE, "°")
                if kind == "angle"
                else (system.scale(kind), typeset(system.label(kind)))
            )
            by = value * of_answer / scale
            text = "0" if abs(by) < _ROUNDING else f"{by:+.3g}"
            moved = f"{text}{label} per {unit}"
            rows.append((_in_words(answer), f"moved by {_in_words(name)}", moved))
    sheet.table(rows)
    if solution.tyres:
        sheet.say(as_sentence(TYRES_HELD))


def _momentum_neglect(
    sheet: Sheet, solution: MomentumSolution, options: Mapping[str, Any]
) -> Iterator[str]:
    """What planar momentum without tyres leaves out, for the duration and drag of the report."""
    reader = ArgumentReader()
    time = read_duration(reader, options["duration"])
    drag = read_drag(reader, options["drag"], "drag")
    found = momentum_neglect(solution, time, drag, sheet.system.answer)
    if found is not None:
        yield found.sentence


def _in_words(name: str) -> str:
    """An argument of planar momentum in words."""
    kind, label, *rest = name.split("_")
    if kind == "outside":
        return f"impulse from outside, along {rest[0]}"
    return f"{kind} of {label.upper()}{'' if kind == 'mass' else ' after' if rest else ' before'}"


def _damage(sheet: Sheet, options: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """Table rows with the PDOF and delta-V that the damage shows."""
    for name, (of, what, kind) in EVIDENCE.items():
        given = options[name]
        if given is not None:
            pair = isinstance(given, (tuple, list))
            texts = []
            for part in given if pair else (given,):
                read = ArgumentReader(trusted=(name,)).number(part, SI_UNITS[kind], name)
                texts.append(sheet.as_given(read, kind, part if isinstance(part, str) else None))
            shown = f"forward: {texts[0]}; left: {texts[1]}" if pair else texts[0]
            yield of if of == "damage" else f"damage of {of}", what, shown


def assumptions(
    sheet: Sheet,
    impact: Impact,
    options: Mapping[str, Any],
    outlines: Mapping[str, Any],
    notes: Mapping[str, str],
) -> None:
    """Write the model and its law, the conventions, and numbers for what an impulse neglects, or
    how the contact passed.
    """
    found = (
        left_out(impact, duration=options["duration"], drag=options["drag"])
        if impact.pulse is None
        else None
    )
    reverse.why_this_model(sheet, impact)
    if impact.reconstruction is not None:
        reverse.what_was_known(sheet, impact)
        neglect = None if found is None else neglected(impact, found)
        if neglect is not None:
            sheet.say(as_sentence(neglect.sentence))
        for sentence in found_backwards(impact):
            sheet.say(as_sentence(sentence))
    sheet.heading("Assumptions")
    lines = [("Model:", BY_NAME[impact.model].assumptions)]
    if impact.model != "linear_central":
        if impact.pulse is None:
            lines.append(
                ("Law:", f"{str(impact.law).title()}: {LAWS[str(impact.law)].assumption}.")
            )
        back = (
            impact.regime == "sticking"
            and sheet.system.working(abs(impact.slip_after), "speed") != "0"
        )
        ends = ", and comes back" if back else ""
        lines.append(("Tangential impulse:", f"{impact.regime}: {_REGIMES[impact.regime]}{ends}."))
    vehicles = (impact.a.before, impact.b.before)
    held, lacking = tyres_held(impact), tyres_lacking(impact)
    whose, other = "both vehicles", ""
    if held and lacking:
        whose = plain(who("ab".index(lacking[0]), getattr(impact.inputs, lacking[0])))
        other = f" The tyres of {whose} were not given, and do not act."
    pivots = " but the pivot's" if any(vehicle.pivot is not None for vehicle in vehicles) else ""
    outside = (
        ", unless an impulse from outside is given" if impact.inputs.outside_a is not None else ""
    )
    if found is None:
        lines.append(("Places:", _GEOMETRIES[impact.inputs.geometry or "maximum_engagement"]))
        wheels = "no tyre acts on the ground while the contact lasts."
        if impact.inputs.tyres:
            wheels = (
                "wheels roll, brake and steer, with the force that they have on the way to rest."
                f"{other}"
            )
        elif impact.inputs.drag:
            wheels = "every wheel slides with the drag given, whichever way it moves."
        lines.append(("Tyres:", wheels))
        if impact.inputs.drag and any(vehicle.heading is None for vehicle in vehicles):
            lines.append(
                (
                    "Tyres:",
                    (
                        "a vehicle without a heading is held at its centre of mass, where tyres "
                        "cannot turn it."
                    ),
                )
            )
    else:
        left = "the forces of the tyres"
        if impact.inputs.tyres and impact.model == "eccentric":
            lines.append(("Tyres:", _TYRES + other))
            left = "other forces of the ground"
        instant = (
            "it acts in an instant, along one normal that points from A into B. Positions, "
            f"masses and inertias do not change while it acts; {left} and all others{pivots} are "
            f"left out{outside}."
        )
        lines.append(("Impulse:", instant))
    lines.append(
        (
            "Axes:",
            (
                "x and y lie in the road plane; angles and yaw are positive counter-clockwise, "
                "seen from above."
            ),
        )
    )
    for label, corners in outlines.items():
        outline = _outline(sheet, [(float(ahead), float(left)) for ahead, left in corners])
        lines.append(
            (
                f"Outline of {label.upper()}:",
                f"{outline}. {notes.get(f'outline_{label}', '')}".rstrip(),
            )
        )
    for code, value in read_limits(options["limits"], ArgumentReader()).items():
        if value is not None and value != LIMITS[code].default:
            lines.append(
                (
                    f"Limit of {label_of(code)}:",
                    f"{sheet.number(value, KIND_OF[LIMITS[code].unit])}, set for this report.",
                )
            )
    sheet.items(lines)
    if found is None:
        _pulse(sheet, impact)
        return
    time, drag = f"{float(found.duration):g} s", f"{float(found.drag):g}"
    bounded = any(
        vehicle.pivot is None and math.isfinite(float(vehicle.mass)) for vehicle in vehicles
    )
    but = ", except what is marked as a bound" if bounded else ""
    if impact.model != "eccentric":
        held = ()
    tyres = f"and tyres with a drag factor of {drag}"
    if held:
        tyres = "beside the tyres, which are in it"
        if lacking:
            tyres = f"with tyres of {whose} that have a drag factor of {drag}, beside those in it"
    assumed = not held or bool(lacking)
    sheet.fold(f"What the model leaves out, for a contact of {time} {tyres} (estimates{but}):")
    crush = "not known: the impact is incomplete"
    if impact.complete:
        crush = sheet.system.answer(float(found.mutual_crush), "length")
    rows = [
        ("contact", "duration taken", _with(time, notes.get("duration"))),
        *(
            [
                ("contact", "drag of the tyres taken", _with(drag, notes.get("drag"))),
                *(("contact", what, text) for what, text in _published(impact, "drag")),
            ]
            if assumed
            else []
        ),
        ("contact", "maximum mutual crush", crush),
        (
            "contact",
            "sliding along the contact",
            sheet.system.answer(float(found.contact_slide), "length"),
        ),
    ]
    for index, (vehicle, side) in enumerate(zip(vehicles, (found.a, found.b), strict=True)):
        if math.isfinite(float(vehicle.mass)):
            rows += [
                (plain(who(index, vehicle)), what, text)
                for what, text in _left_out(
                    sheet, side, impact.model, vehicle, whose if assumed else ""
                )
                if not ("ab"[index] in held and what.startswith(_OWN))
            ]
    sheet.table(rows)
    sheet.unfold()


def _pulse(sheet: Sheet, impact: Impact) -> None:
    """Write how a time-resolved contact passed."""
    found, answer = impact.pulse, sheet.system.answer
    if found is None:
        return
    rows = [
        ("contact", "duration", answer(float(found.duration), "duration")),
        ("contact", "largest force along the normal", answer(float(found.peak_force), "force")),
        ("contact", "mutual crush, at its most", answer(float(found.max_crush), "length")),
    ]
    for index, left in enumerate((found.residual_crush_a, found.residual_crush_b)):
        if left is not None:
            text = (
                answer(float(left), "length")
                if left > 0.0
                else "none: the force stays below that which leaves some"
            )
            rows.append(
                (plain(who(index, (impact.a, impact.b)[index].before)), "residual crush", text)
            )
    for index, (side, most) in enumerate(
        ((impact.a, found.peak_acceleration_a), (impact.b, found.peak_acceleration_b))
    ):
        if math.isfinite(float(side.before.mass)):
            name = plain(who(index, side.before))
            rows.append(
                (
                    name,
                    "largest acceleration of the centre of mass",
                    answer(float(most), "acceleration"),
                )
            )
            if impact.inputs.drag or impact.inputs.tyres:
                held = (
                    answer(float(part), "impulse")
                    for part in (side.tyre_impulse_x, side.tyre_impulse_y)
                )
                rows.append((name, "impulse of the tyres (x, y)", ", ".join(held)))
                rows.append(
                    (name, "energy lost by the tyres", answer(float(side.tyre_loss), "energy"))
                )
    sheet.say("How the contact passed:")
    sheet.table(rows)


def _left_out(
    sheet: Sheet,
    side: LeftOutVehicle,
    model: str,
    vehicle: Vehicle,
    whose: str,
) -> Iterator[tuple[str, str]]:
    """Rows of one vehicle; ``whose`` tyres were left out, if any."""
    # Tyres of a body that turns about a pivot act on it by their levers, which are not known.
    own = "upper bound" if vehicle.pivot is None else "about"
    way = (
        sheet.system.answer(float(part), "length")
        for part in (side.displacement_x, side.displacement_y)
    )
    yield "travel during the contact (x, y)", ", ".join(way)
    if model == "eccentric":
        yield "rotation during the contact", sheet.system.answer(float(side.rotation), "angle")
    own_tyres = f"{_OWN}, {own}", ""
    all_tyres = f"change of delta-V by the tyres of {whose}", "speeds that the tyres leave"
    later = (
        "places and the normal of other moments of the contact, in which the bodies part as a rule"
    )
    moved = (
        "change of delta-V as positions and normal move on from those of maximum engagement",
        later,
    )
    for (what, other), change, share in (
        *([(own_tyres, side.tyre_delta_v_bound, side.tyre_share_bound)] if whose else []),
        *([(all_tyres, side.tyre_delta_v, side.tyre_share)] if whose else []),
        (moved, side.geometry_delta_v, side.geometry_share),
    ):
        if change is not None and share is not None:
            part = "" if math.isnan(float(share)) else f" ({percent(float(share))})"
            part = (
                f": the model has no answer with the {other}" if math.isnan(float(change)) else part
            )
            yield what, sheet.system.answer(float(change), "speed") + part
    if side.geometry_yaw_rate is not None and not math.isnan(float(side.geometry_yaw_rate)):
        turn = sheet.system.answer(float(side.geometry_yaw_rate), "yaw rate")
        yield "change of the yaw rate after, for the same reason", turn


def _outline(sheet: Sheet, corners: Sequence[tuple[float, float]]) -> str:
    """An outline in words: length and width of a rectangle about the centre of mass, else its
    corners.
    """
    length, width = (max(corner[i] for corner in corners) for i in (0, 1))
    if set(corners) == {(ahead, left) for ahead in (length, -length) for left in (width, -width)}:
        long, wide = (sheet.number(2.0 * half, "length") for half in (length, width))
        return f"{long} long and {wide} wide, about the centre of mass"
    places = "; ".join(
        ", ".join(sheet.number(part, "length") for part in corner) for corner in corners
    )
    return f"corners (forward, left) from the centre of mass: {places}"


def results(sheet: Sheet, impact: Impact, share_a: Input | None) -> None:
    """Write the results, with the EES for a stated share."""
    rows = list(impact_answers(sheet, impact))
    if share_a is not None:
        share = ArgumentReader().number(share_a, "", "share_a")
        of = f"if A took up {100.0 * share:.6g} percent of the energy"
        for what, speeds in (
            (f"EES (ISO 12353), {of} lost", impact.ees(share_a)),
            (f"speed of maximum crush, {of} absorbed", impact.max_crush_speeds(share_a)),
        ):
            for label, speed in zip("AB", speeds, strict=True):
                last = max(at for at, row in enumerate(rows) if row[0] == label) + 1
                rows.insert(last, (label, what, sheet.system.answer(float(speed), "speed")))
    rows.append(("contact", "kind", impact.kind))
    names = {"A": who(0, impact.a.before), "B": who(1, impact.b.before)}
    sheet.heading("Results")
    found = found_inputs(impact)
    sheet.table(
        [
            (plain(names.get(of, of)), what, text + _origin(impact, found, of, what))
            for of, what, text in rows
        ]
    )


def _origin(impact: Impact, found: set[str], of: str, what: str) -> str:
    """Whether a number of the state before was given or found, on the page of a reverse solver."""
    if impact.reconstruction is None:
        return ""
    if what == "restitution":
        return ", found" if "restitution" in found else ", given"
    name = _BEFORE.get(what)
    # In line nothing moves along y: that is the model, and neither given nor found.
    if name is None or (name == "vy" and impact.reconstruction.method == "central"):
        return ""
    return ", found" if f"{of.lower()}.{name}" in found else ", given"


def findings(sheet: Sheet, found: Findings) -> None:
    """Write the findings, each but a note with measure and limit; also the checks that were made,
    and those that were not.
    """
    sheet.heading("Findings")
    others = [label_of(code) for code in LIMITS if code not in found.measured]
    if not found:
        sheet.say(
            f"None of the {len(found.measured)} checks that were made found anything, which "
            "proves nothing by itself."
        )
        _not_made(sheet, others)
        return
    lines = []
    for finding in found:
        of = letter_of(finding)
        sentence = plain(finding.sentence).rstrip(".")
        end = "" if sentence.endswith("?") else "."
        judged = ""
        if not is_note(finding):
            kind = KIND_OF[finding.unit]
            measured = sheet.number(finding.measured, kind)
            limit = _round_limit(sheet, finding.limit, kind)
            judged = f" Measured {measured}, limit {limit}. Basis of the limit: {_basis(finding)}."
        lines.append((f"{label_of(finding.code)}{of}:", f"{sentence}{end}{judged}"))
    sheet.items(lines)
    sheet.say(
        f"{len(found.measured)} checks were made. A finding is a reason to look again, not an "
        "error."
    )
    _not_made(sheet, others)


def moves(sheet: Sheet, found: Moves) -> None:
    """Write what would move the answer, largest first."""
    if not found:
        return
    sheet.say(
        "What would move this answer, the larger of both ways; the share is that of the vehicle's "
        "own delta-V, of A or of B, whichever is larger:"
    )
    rows = []
    for move in found:
        if math.isinf(move.share):
            rows.append((plain(move.what), "change", "there is no answer then"))
            continue
        for what, changes, kind in (
            ("delta-V", (move.delta_v_a, move.delta_v_b), "speed"),
            ("yaw rate after", (move.yaw_rate_a, move.yaw_rate_b), "yaw rate"),
        ):
            known = [change for change in changes if change is not None]
            if known:
                text = ", ".join(sheet.system.answer(change, kind) for change in known)
                text += f" ({percent(move.share)})" if kind == "speed" else ""
                rows.append((plain(move.what), f"change of the {what} of A, of B", text))
    sheet.table(rows)


def _round_limit(sheet: Sheet, limit: float, kind: str) -> str:
    """A limit in the units of the page; one that is round in SI has no more digits there."""
    number = sheet.system.converted(limit, kind)
    if not math.isfinite(limit) or number == 0.0 or float(f"{limit:.2g}") != limit:
        return sheet.number(limit, kind)
    figures = places(number, 2)
    rounded = with_decimals(number, figures)
    if figures > 0:
        rounded = rounded.rstrip("0").rstrip(".")
    return rounded + sheet.system.unit(kind)


def _not_made(sheet: Sheet, others: Sequence[str]) -> None:
    """Name the checks that were not made, for those who ask."""
    if others:
        sheet.fold(
            f"{len(others)} checks were not made: they lack an input, do not apply or are "
            "switched off.",
            printed=False,
        )
        sheet.say(f"{', '.join(others)}.")
        sheet.unfold()


def sources(sheet: Sheet, parts: Sequence[tuple[Any, Sequence[Finding] | None]]) -> None:
    """Write the sources of equations, limits and comparable values, each once."""
    lines = [line for result, found in parts for line in _sources(result, found or ())]
    if lines:
        sheet.heading("References")
        sheet.listed(list(dict.fromkeys(lines)))


def _sources(impact: Any, found: Sequence[Finding]) -> Iterator[str]:
    if not isinstance(impact, (Impact, MomentumSolution)):
        return
    yield (
        '"Application of Impulse Momentum Theory to Vehicle Collisions"; a number such as (5) is '
        "an equation of it."
    )
    if isinstance(impact, Impact):
        values = [("restitution", value) for value in _RANGE]
        if any(_published(impact, impact.inputs.rule)):
            values.append(("friction", reference.INTER_VEHICLE_FRICTION))
        values += [
            ("drag", value)
            for value in _DRAG
            if impact.pulse is None or impact.inputs.drag is not None
        ]
        for what, value in values:
            yield f"For comparison with the {what}: {value.name}; {value.source}. {value.quality}"
    for finding in found:
        for name in _PUBLISHED.findall(finding.source):
            for value in _RANGE if name == "restitution_range" else (getattr(reference, name),):
                yield f"{value.name}: {value.source}. {value.quality}"
    if isinstance(impact, Impact):
        duration = reference.CONTACT_DURATION
        ends = f"{duration.low:g} to {duration.high:g} s"
        yield (
            f"For comparison with the duration: {duration.name}, {ends}; {duration.source}. "
            f"{duration.quality}"
        )


def _basis(finding: Finding) -> str:
    """Where the limit comes from, with what the list of references calls a published value in place
    of its name in Python.
    """
    words = {"restitution_range": "the published range of restitution"}
    return _PUBLISHED.sub(
        lambda found: (
            f"{words.get(found[1]) or f'“{getattr(reference, found[1]).name}”'} (see References)"
        ),
        finding.source,
    )
