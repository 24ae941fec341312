"""``explain``: the derivation of a result, step by step, with its numbers and the equations of the
paper.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from operator import attrgetter
from typing import Any, Literal, TypeAlias, get_args

from ..impact.impact import Impact
from ..impact.inputs import PLACED
from ..impact.reconstruction import as_bound, pushed_by_drag
from ..impact.run import error_of, gain_of_steps
from ..kernels.contact_laws import RULES
from ..messages.errors import InputError, Status
from ..quantities.document import Document
from ..quantities.formatting import SI_UNITS, UnitSystem, check_system
from ..quantities.reading import ArgumentReader, at_least_zero, need_one_case, single_number
from ..quantities.settings import callers_options, computing
from ..quantities.tables import given_texts
from ..quantities.units import kinds_in_degrees, shown, system_given
from ..reconstruct import Fit, MomentumSolution, Posterior
from ..reconstruct.found_again import need_found_again
from ..scene.one_run import need_one_run
from ..scene.run import Run
from ..uncertainty.distributions import Interval
from ..uncertainty.output import Output, ends_of, varies
from ..uncertainty.result import Propagation
from ..vehicle.vehicle import Vehicle, named
from .contact import impulse_and_energy, motions, normal
from .evidence import MOMENTUM_ANSWERS, fit, momentum, momentum_answers
from .expressions import System
from .models import eccentric, linear, oblique, time_resolved
from .page import Page
from .reverse import evidence_of, found_inputs, state_before, why_this_model
from .scene import scene_steps
from .symbols import Symbols
from .wheels import tyre_inputs

Form: TypeAlias = Literal["markdown", "text"]
_Ranges: TypeAlias = dict[str, tuple[float, float]]
# In N*s: products of it with lengths and speeds keep all their digits.
_LEAST_IMPULSE = 1e-290
# In standard deviations: how far an answer may differ from the mean of its propagation.
_OFF_CENTRE = 0.1
# The hint for a result that is a bare number.
NOT_EXPLAINED = (
    ". The work behind a number of crush_energy or travel, or a RunOut, is not written out: its "
    "formula is in help(collisions.reconstruct.crush_energy), "
    "help(collisions.travel.speed), help(collisions.travel.path)"
)
_MODELS = {
    "linear_central": linear,
    "oblique_central": oblique,
    "eccentric": eccentric,
    "time_resolved": time_resolved,
}

_CRUSH = "crush stiffness A of {0}; crush stiffness B of {0}; width of the crush of {0}"
_IN_TIME = {
    "duration": ("nominal duration", ("duration",)),
    "stiffness": ("stiffness of both vehicles together", ("stiffness",)),
    "crush_a": (_CRUSH.format("A"), ("stiffness", "crush stiffness", "length")),
    "crush_b": (_CRUSH.format("B"), ("stiffness", "crush stiffness", "length")),
    "drag": ("drag of the tyres", ("number",)),
    "wheelbase": ("wheelbase of both vehicles", ("length",)),
    "track": ("track of both vehicles", ("length",)),
}
OF_VEHICLE = {
    "mass": ("mass", "mass"),
    "vx": ("velocity along x", "speed"),
    "vy": ("velocity along y", "speed"),
    "yaw_rate": ("yaw rate", "yaw rate"),
    "yaw_inertia": ("yaw inertia about the centre of mass", "inertia"),
    "x": ("position x of the centre of mass", "length"),
    "y": ("position y of the centre of mass", "length"),
    "heading": ("heading", "angle"),
}
_SIDE = {
    "before.vx": ("velocity before, along x", "speed"),
    "before.vy": ("velocity before, along y", "speed"),
    "before.speed": ("speed before", "speed"),
    "before.yaw_rate": ("yaw rate before", "yaw rate"),
    "after.vx": ("velocity after, along x", "speed"),
    "after.vy": ("velocity after, along y", "speed"),
    "after.speed": ("speed after", "speed"),
    "after.course": ("course after", "angle"),
    "after.yaw_rate": ("yaw rate after", "yaw rate"),
    "delta_v": ("delta-V", "speed"),
    "delta_v_forward": ("delta-V forward", "speed"),
    "delta_v_left": ("delta-V to the left (recorders count to the right)", "speed"),
    "delta_vx": ("delta-V along x", "speed"),
    "delta_vy": ("delta-V along y", "speed"),
    "delta_yaw_rate": ("change of yaw rate", "yaw rate"),
    "pdof": ("PDOF (0 from ahead, positive clockwise)", "angle"),
    "outside_work": ("work of the impulse from outside", "energy"),
    "tyre_loss": ("energy taken by the tyres", "energy"),
    "pivot_impulse_x": ("impulse of the pivot, along x", "impulse"),
    "pivot_impulse_y": ("impulse of the pivot, along y", "impulse"),
}
_CONTACT = {
    "closing_speed": ("closing speed", "speed"),
    "separation_speed": ("separation speed", "speed"),
    "slip_before": ("slip before", "speed"),
    "slip_after": ("slip after", "speed"),
    "restitution": ("restitution", "number"),
    "normal_impulse": ("normal impulse", "impulse"),
    "tangential_impulse": ("tangential impulse", "impulse"),
    "impulse_ratio": ("impulse ratio", "ratio"),
    "energy_absorbed": ("energy absorbed along the normal at the end of compression", "energy"),
    "energy_loss": ("energy lost", "energy"),
}
_OF_FRICTION = ("slip_before", "slip_after", "tangential_impulse", "impulse_ratio")
# The results of an impact: vehicle or contact, description and kind.
IMPACT_ANSWERS = {
    f"{label}.{name}": (label.upper(), *row) for label in "ab" for name, row in _SIDE.items()
}
IMPACT_ANSWERS |= {name: ("contact", *row) for name, row in _CONTACT.items()}


@computing
def explain(
    impact: Impact | MomentumSolution | Fit | Run,
    *,
    units: UnitSystem | None = None,
    form: Form = "markdown",
    uncertainty: Propagation | Mapping[str, Any] | None = None,
) -> Document:
    """The derivation of an answer, step by step, with its numbers.

    Every line has a formula, the same formula with numbers, and the number of the result. Nothing
    is solved again; every formula is worked out with all digits and compared with the result. From
    a difference of 1e-6 of the largest term on, which ordinary impacts do not reach by far, both
    numbers are printed; beyond 1e-3 there is no page, but an error. Equation numbers, such as (5),
    are those of "Application of Impulse Momentum Theory to Vehicle Collisions". An energy gain
    comes first.

    The working prints a number in full if six figures hold it, else to four figures (with all that
    stand before the decimal point; small speeds, angles, lengths and ratios have two decimals more
    than an answer). Where a line needs more figures than that to give the result printed below it,
    its numbers have more: keyed into a pocket calculator as printed, and rounded, a half up, every
    line gives its result; where one cannot, the page says so. The answers at the end are rounded:
    speeds to 0.1 km/h, 0.1 mph or 0.01 m/s, angles to 1 degree or 0.01 rad, yaw rates to 1 deg/s or
    0.01 rad/s, restitution to 0.01, impulse ratios to 0.001, impulses and energies to three
    figures; or to two figures of their standard deviation where that is known.

    Parameters
    ----------
    impact : Impact, MomentumSolution, Fit or scene.Run
        One case, of any forward or reverse solver. For a ``Run`` the page has every impact in
        order, the places of rest, and where the kinetic energy went; the motion in between, which
        is integrated step by step, is not written out. For a ``Fit`` it has the misfit of every
        observation, the estimates and the sources of their errors, but not the model, which is
        code. The work behind a number that ``crush_energy`` or ``travel`` returned is not written
        out; for their formulas see ``help(collisions.travel.speed)`` and so on.
    units : {"si", "metric", "us"}, optional
        By default those that the inputs were given in, as for ``summary``; otherwise SI, with the
        angles in degrees that were given so. "si": m/s, rad, rad/s, J. "metric": km/h, deg, deg/s,
        kJ. "us": mph, lb, ft, deg, deg/s, ft*lbf. Conversion factors within a line are listed at
        the end.
    form : {"markdown", "text"}, optional
        Markdown with LaTeX between dollar signs, or plain text.
    uncertainty : Propagation, or dict of float, str or Quantity, optional
        Standard deviations by the name of the answer, such as "b.after.vx" or "energy_loss";
        "b_after_vx" means the same. What was given, as the restitution of a forward impact, is no
        answer and is refused. From a propagation, the outputs with such a name are taken, as
        SI if the model returned plain numbers. With an ``Interval`` among its inputs an answer gets
        its range, because a standard deviation would leave the interval out. The ``statements`` of
        the propagation, such as that cases have no answer, stand in the notes below the answers. A
        ``Fit`` has standard errors of its own.

    Returns
    -------
    Document
        The derivation, a ``str`` that a notebook shows as a page and that ``.save(path)`` writes to
        a file. The same arguments give the same page.

    Raises
    ------
    ShapeError
        A batch: explain one case of it.
    InputError, NoImpactError, NoSolutionError
        An argument that cannot be used, or an impact that was refused (the status says why), or
        whose normal impulse is so near 0 (1e-290 N*s) that its numbers have lost digits.
    InternalError
        The result and a formula for it contradict each other, by more than 1e-3 of the largest
        term: a defect of the library, of which neither the result nor its derivation may be used.

    Examples
    --------
    Example 2 of the paper, which asks for the restitution and the velocity of the striking car:

    >>> import collisions as col
    >>> from collisions.derivation import explain
    >>> impact = col.reconstruct.central(
    ...     "1100 kg", "950 kg", va="80 km/h", vb=0.0, vb_after="60 km/h"
    ... )
    >>> page = explain(impact, form="text")
    >>> print(page[page.index("Restitution") : page.index("Found as")].rstrip())
    Restitution, as in (9):
      e = (v'_B - v'_A) / (v_A - v_B)
        = (60 - 28.182) / (80 - 0)
        = 0.3977
    """
    if units is not None:
        check_system(units)
    if not isinstance(form, str) or form not in get_args(Form):
        raise InputError(
            f"form must be one of {', '.join(map(repr, get_args(Form)))}, got {shown(form)}",
            code="bad_option",
            argument="form",
        )
    if isinstance(impact, Run):
        need_one_run(impact, "explain", "impact")
        if uncertainty is not None:
            raise no_uncertainty("Run")
        return _run(impact, units, form)
    need_one_case(
        impact,
        (Impact, MomentumSolution, Fit),
        "explain",
        instead=NOT_EXPLAINED,
        runs=True,
        refused=error_of,
    )
    need_found_again(impact)
    if isinstance(impact, Fit) and uncertainty is not None:
        raise no_uncertainty()
    system = _system(units, given_texts(impact))
    deviations: Mapping[str, float] = {}
    ranges: _Ranges = {}
    if uncertainty is not None:
        with callers_options():
            deviations, ranges = _spread(uncertainty, impact, _printed(impact, system))
    page = Page(system, form == "markdown", deviations, ranges)
    if isinstance(impact, Fit):
        page.title("Fit to evidence, step by step")
        fit(page, impact)
    elif isinstance(impact, MomentumSolution):
        page.title("Planar momentum, step by step")
        _energy_gain(page, impact.status, impact.translational_energy_loss)
        momentum(page, impact)
    else:
        page.title("The impact, step by step")
        _with_gain(page, impact)
    _notes(page, uncertainty, of_impact=not isinstance(impact, Fit))
    return page.text()


def _run(run: Run, units: UnitSystem | None, form: Form) -> Document:
    page = Page(_system(units, given_texts(run)), form == "markdown", {}, {})
    page.title("The scene, step by step")
    scene_steps(page, run, _with_gain)
    _notes(page, None, of_impact=True)
    return page.text()


def _with_gain(page: Page, impact: Impact) -> None:
    if 0.0 < abs(impact.normal_impulse) < _LEAST_IMPULSE:
        raise InputError(
            f"explain cannot write out an impact with a normal impulse of "
            f"{impact.normal_impulse:.3g} N*s: numbers so near 0 have lost digits, and their "
            "formulas do not hold; give masses and speeds of vehicles",
            code="out_of_range",
            argument="impact",
        )
    _energy_gain(page, impact.status, impact.energy_loss, gain_of_steps(impact.inputs))
    _impact(page, impact)


def _system(units: UnitSystem | None, texts: Sequence[str]) -> System:
    """How numbers are written: in the system named or, for None, as the inputs were given."""
    if units is not None:
        return System(units)
    return System(system_given(texts), kinds_in_degrees(texts))


def no_uncertainty(kind: str = "Fit") -> InputError:
    """The error for an ``uncertainty`` given with a result that has errors of its own, or with a
    run, of whose impacts it would have to say of which it is.
    """
    if kind == "Run":
        return InputError(
            "uncertainty is of one impact, and this is a run; write "
            "explain(run.impacts[0], uncertainty=...) for the first",
            code="bad_option",
            argument="uncertainty",
        )
    return InputError(
        f"uncertainty is none of a {kind}, which has the standard errors of its unknowns; leave "
        "it out, or explain the impact at the values found, with a propagation of "
        f"{kind.lower()}.inputs",
        code="bad_option",
        argument="uncertainty",
    )


def kinds_of_answers(result: Impact | MomentumSolution | Fit | Posterior) -> Mapping[str, str]:
    """The results that an uncertainty may be given for, by name, with their kind."""
    return {name: kind for name, (_, _, kind) in _answers(result).items()}


def words_of_answers(result: Impact | MomentumSolution | Fit | Posterior) -> Mapping[str, str]:
    """The same results in words, such as "A: delta-V"."""
    return {
        name: f"{of}: {what}" if of in "AB" else what
        for name, (of, what, _) in _answers(result).items()
    }


def _answers(result: Any) -> Mapping[str, tuple[str, str, str]]:
    return MOMENTUM_ANSWERS if isinstance(result, MomentumSolution) else IMPACT_ANSWERS


def _impact(page: Page, impact: Impact) -> None:
    s = Symbols(impact)
    page.heading("Given" if impact.reconstruction is None else "What was given and found")
    _inputs(page, impact)
    normal(page, s)
    why_this_model(page, impact)
    state_before(page, s)
    _MODELS[impact.model](page, s)
    motions(page, s)
    impulse_and_energy(page, s)
    page.heading("Answers")
    page.table(impact_answers(page, impact))


_PLACES = ("yaw_inertia", "x", "y", "yaw_rate")


def impact_inputs(
    impact: Impact,
) -> Iterator[tuple[str, str, tuple[str, ...], tuple[float, ...], str]]:
    """The rows of given inputs: A, B or the contact, description, argument, number and kind."""
    origin = impact.reconstruction
    # With drags it is worked out as an impact at places that nobody gave.
    in_line = origin is not None and origin.method == "central"
    for label, vehicle in (("A", impact.a.before), ("B", impact.b.before)):
        for name, (what, kind) in OF_VEHICLE.items():
            value = getattr(vehicle, name)
            if in_line and name in _PLACES:
                continue
            if value is not None and not (name == "yaw_rate" and value == 0.0):
                yield label, what, (name,), (value,), kind
        if vehicle.pivot is not None:
            yield label, "pivot O (x, y)", ("pivot[0]", "pivot[1]"), vehicle.pivot, "length"
    yield "contact", "normal, direction from A into B", ("normal",), (impact.normal_angle,), "angle"
    # With ``solve`` the model taken may leave out some of what decided which was taken.
    placed = impact.inputs.model in (*PLACED, "solve") and not in_line
    if impact.inputs.point is not None and placed:
        yield (
            "contact",
            "contact point (x, y)",
            ("point[0]", "point[1]"),
            impact.inputs.point,
            "length",
        )
    yield "contact", "restitution e", ("restitution",), (impact.restitution,), "number"
    for label, pushed in (("a", impact.inputs.outside_a), ("b", impact.inputs.outside_b)):
        if pushed is not None and any(pushed):
            what, name = f"impulse on {label.upper()} from outside", f"outside_{label}"
            if pushed_by_drag(origin):
                what += ", worked out from its drag"
            yield (
                "contact",
                f"{what} (x, y)",
                (f"{name}[0]", f"{name}[1]"),
                (pushed[0], pushed[1]),
                "impulse",
            )
            yield (
                "contact",
                f"{what}, about its centre of mass",
                (f"{name}[2]",),
                (pushed[2],),
                "angular momentum",
            )
    if impact.inputs.model != "linear_central" and not in_line:
        rule = impact.inputs.rule
        yield "contact", RULES[rule].meaning, (rule,), (impact.inputs.rule_value,), "number"
    if impact.inputs.model != "eccentric":
        for name, (what, kinds) in _IN_TIME.items():
            given = getattr(impact.inputs, name)
            for at, part in enumerate(
                given if isinstance(given, tuple) else () if given is None else (given,)
            ):
                names = (f"{name}[{at}]" if isinstance(given, tuple) else name,)
                yield "contact", what.split("; ")[at], names, (part,), kinds[at]
    elif impact.inputs.tyres:
        yield (
            "contact",
            "duration, for the tyres",
            ("duration",),
            (impact.inputs.duration or 0.0,),
            "duration",
        )
    if impact.inputs.model in (*PLACED, "solve"):
        for what, name, value, kind in tyre_inputs(impact.inputs.tyres):
            yield "contact", what, (name,), (value,), kind


def key_of(of: str, names: Sequence[str]) -> str:
    """The name of an input in ``notes``, such as "a.mass" or "restitution"; one name for both parts
    of a place.
    """
    name = names[0].partition("[")[0]
    return name if of == "contact" else f"{of.lower()}.{name}"


def _inputs(page: Page, impact: Impact) -> None:
    """Write the table of inputs."""
    vehicles = {"A": impact.a.before.name, "B": impact.b.before.name}
    bare = impact.inputs.bare_normal
    rows = []
    found = found_inputs(impact)
    for of, what, names, numbers, kind in impact_inputs(impact):
        text = ", ".join(page.number(number, kind) for number in numbers)
        text += ", found" if key_of(of, names) in found else ""
        if "normal" in names and bare is not None:
            text += f", given as {bare:.6g} without a unit"
        name = vehicles.get(of, "")
        letter = of if name in ("", of) else f"{of} ({page.name(named(name))})"
        rows.append((letter, what, text))
    if impact.law is not None and impact.model not in ("linear_central", "time_resolved"):
        rows.append(("contact", "law of restitution", impact.law.title()))
    for one in evidence_of(impact):
        if one.number is not None:
            text = page.number(one.number, one.kind)
            if one.differs and one.answer is not None:
                answer = page.number(one.answer, one.kind)
                text += f"; {answer} in this answer" if answer != text else ""
            rows.append(("evidence", one.what, text))
    page.table(rows)


def impact_answers(page: Page, impact: Impact) -> Iterator[tuple[str, str, str]]:
    """The rows of results, rounded."""
    for name, (of, what, kind) in IMPACT_ANSWERS.items():
        side = impact.a if of == "A" else impact.b
        left_out = (
            impact.reconstruction is None and (".before." in name or name == "restitution"),
            impact.model not in PLACED and name.endswith("yaw_rate"),
            impact.model == "linear_central" and name in _OF_FRICTION,
            impact.inputs.outside_a is None and ".outside" in name,
            name.endswith(".tyre_loss") and not side.tyre_loss,
            side.before.pivot is None and ".pivot" in name,
            _says_nothing(side.before, name),
            name.endswith("after.course") and page.system.working(side.after.speed, "speed") == "0",
        )
        value = None if any(left_out) else attrgetter(name)(impact)
        if value is not None and (of == "contact" or not math.isnan(value)):
            text = page.answer(name, value, kind)
            yield of, what, as_bound(impact.reconstruction, name, text)


def _says_nothing(body: Vehicle, name: str) -> bool:
    """Whether a result is that of a body that nothing moves, or turns, and says nothing therefore:
    the delta-V of a wall has no size and no direction.
    """
    part = name.partition(".")[2]
    if part == "delta_yaw_rate":
        return body.yaw_inertia is None or math.isinf(body.yaw_inertia)
    return part.startswith(("delta_v", "pdof")) and math.isinf(body.mass)


def _energy_gain(page: Page, status: Any, loss: float, steps: str = "") -> None:
    """Write the warning of an energy gain, before anything else; ``steps`` says why one that was
    followed in time has it.
    """
    if status == Status.ENERGY_GAIN:
        why = "which no impact gives. The inputs do not go together; the numbers are shown as they"
        page.stress(
            f"Energy gain: the vehicles leave with {page.system.answer(-loss, 'energy')} more "
            f"than they came with{f': {steps}' if steps else f', {why} are'}."
        )


def _notes(page: Page, uncertainty: Any, of_impact: bool) -> None:
    """Write the notes on rounding, units and signs."""
    page.heading("Notes")
    lines = [
        (
            "Every step was worked out with all digits. A number that needs at most six figures "
            "is printed in full, any other with four, but never with fewer than stand before its "
            "decimal point; a speed, angle, length or ratio has at most two decimals more than "
            "the answers. Where the numbers of a line need more figures than that to give the "
            "result printed below them, they have more. So every line, worked out from its "
            "printed numbers and rounded like its result, gives that result; where a line "
            "cannot, the page says so below it. The answers are rounded."
        ),
    ]
    if of_impact:
        lines[:0] = [
            (
                'Equation numbers are those of "Application of Impulse Momentum Theory to '
                'Vehicle Collisions"; its vehicles 1 and '
                "2 are A and B here."
            )
        ]
        lines.append(
            "x and y are axes of the road plane; angles and yaw are positive counter-clockwise, "
            "seen from above."
        )
    if page.ranges:
        lines.append(about_ranges(uncertainty))
    if page.conversions:
        conversions = "; ".join(
            f"1 {one} = {number} {other}" for (one, other), number in page.conversions.items()
        )
        lines.append(f"Numbers that convert units: {conversions.replace('**', '^')}.")
    if page.latex:
        lines = [line.replace("*", r"\*") for line in lines]
    if isinstance(uncertainty, Propagation):
        # As they are: a name of an output or an option has no capital.
        lines += [
            f"Of the propagation: {page.name(one.rstrip('.'))}." for one in uncertainty.statements
        ]
    page.listed(lines)


def about_ranges(uncertainty: Propagation) -> str:
    """What a range in brackets behind an answer means."""
    if not any(isinstance(stated, Interval) for stated in uncertainty.inputs.values()):
        return (
            "A range in brackets holds 95 percent of the propagation. The number before it is "
            "the answer for the inputs used here, and not the mean of the propagation, which is "
            "too far from it for a ±, or not known."
        )
    held = (
        "every value"
        if uncertainty.method == "interval"
        else "95 percent, wherever in the interval the truth lies"
    )
    return (
        "A range in brackets is no ±: an interval is among the inputs, and of its values none "
        f"is said to be likelier than another. The range holds {held}."
    )


def spread_of(
    result: Any, uncertainty: Propagation
) -> tuple[dict[str, Output], dict[str, float], _Ranges]:
    """The outputs of a propagation that are results, by the name of the result, and their standard
    deviations in SI or ranges.

    What has the name of a result and another unit is none. A result that is not the middle of a
    distribution has a range.
    """
    kinds = kinds_of_answers(result)
    known = names_of_answers(result)
    named = [(known[name], output) for name, output in uncertainty.outputs.items() if name in known]
    outputs = {
        name: output for name, output in named if output.unit in (None, SI_UNITS[kinds[name]])
    }
    deviations: dict[str, float] = {}
    ranges: _Ranges = {}
    for name, output in outputs.items():
        if not _is_mean(result, name, kinds[name], output):
            ranges[name] = output.interval()
        elif varies(output, kinds[name]) and math.isfinite(output.std):
            deviations[name] = float(output.std)
    return outputs, deviations, ranges


def names_of_answers(result: Any) -> dict[str, str]:
    """The names of results by what may be written for each, such as "b_after_vx" for "b.after.vx",
    and by what every reverse answer has, "speed_a" and "speed_b".
    """
    names = _answers(result)
    found = {spelled: name for name in names for spelled in (name, name.replace(".", "_"))}
    speeds = {f"speed_{label}": f"{label}.before.speed" for label in "ab"}
    return {one: name for one, name in speeds.items() if name in names} | found


def _is_mean(result: Any, name: str, kind: str, output: Output) -> bool:
    """Whether an answer is the mean of its propagation, but for a tenth of the deviation: only then
    is it the middle of a ±.
    """
    mean, std = ends_of(output.mean), ends_of(output.std)
    value = attrgetter(name)(result)
    # With an interval among the inputs there are two deviations, and neither includes the width of
    # the interval.
    if len(std) > 1 or value is None or not math.isfinite(mean[0]):
        return False
    off = abs(value - mean[0])
    off = min(off, abs(off - math.tau)) if kind == "angle" else off
    return not off > _OFF_CENTRE * std[0] or not varies(output, kind)


def _printed(result: Any, system: System) -> list[str]:
    """The names of the answers that stand on the page of this result."""
    page = Page(system, False, {}, {})
    rows = momentum_answers if isinstance(result, MomentumSolution) else impact_answers
    for _ in rows(page, result):
        pass
    return page.answered


def _spread(
    uncertainty: Any, result: Any, printed: Sequence[str]
) -> tuple[dict[str, float], _Ranges]:
    """Standard deviations in SI by result, of a propagation or as they were given; or ranges. None
    is of what is not printed.
    """
    kinds = kinds_of_answers(result)
    if isinstance(uncertainty, Propagation):
        outputs, deviations, ranges = spread_of(result, uncertainty)
        if outputs.keys().isdisjoint(printed):
            given = (
                name if output.unit is None else f"{name} [{output.unit}]"
                for name, output in uncertainty.outputs.items()
            )
            raise _unknown(", ".join(given), printed)
        return deviations, ranges
    if not isinstance(uncertainty, Mapping):
        raise InputError(
            "uncertainty must be a Propagation, or a dict of standard deviations by name, got "
            f"{type(uncertainty).__name__}",
            code="bad_option",
            argument="uncertainty",
        )
    known = {name: of for name, of in names_of_answers(result).items() if of in printed}
    stray = [shown(name) for name in uncertainty if name not in known]
    if stray:
        raise _unknown(", ".join(stray), printed)
    reader = ArgumentReader()
    found = {}
    for name, value in uncertainty.items():
        read = reader.number(value, SI_UNITS[kinds[known[name]]], name)
        read = single_number(
            reader, read, f"the standard deviation of {name}", "must be one number", name
        )
        found[known[name]] = at_least_zero(
            reader, read, value, name, "negative_deviation", "give the standard deviation"
        )
    reader.close()
    return found, {}


def _unknown(given: str, printed: Sequence[str]) -> InputError:
    return InputError(
        f"uncertainty names no answer of this derivation: {given}; the answers are "
        f"{', '.join(printed)}",
        code="no_output",
        argument="uncertainty",
    )
