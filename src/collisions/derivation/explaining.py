"""explain: an answer written down step by step, with the numbers of the result and the equations of the paper."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal, TypeAlias, get_args

from ..amounts import at_least_zero
from ..errors import InputError, ShapeError, Status
from ..impact import Impact
from ..one_case import need_one_case
from ..reading import ArgumentReader
from ..reconstruct import Fit, MomentumSolution
from ..solving import error_of
from ..uncertainty.result import Propagation
from ..unit_systems import SI_UNITS, UnitSystem, bad_system
from ..units import shown
from . import answers, momentum
from .central import linear
from .changes import changes
from .eccentric import eccentric
from .fit import fit
from .oblique import oblique
from .page import Page
from .reverse import chosen, found
from .rounding import System

Form: TypeAlias = Literal["markdown", "text"]
_FORMS = get_args(Form)
# What to do about a result that holds no more than its number.
NOT_EXPLAINED = (
    ". A number of crush_energy or travel, or a RunOut, does not hold what it was worked out from: its formula is in "
    "help(collisions.reconstruct.crush_energy), help(collisions.travel.speed), help(collisions.travel.path)"
)
_MODELS = {"linear_central": linear, "oblique_central": oblique, "eccentric": eccentric}


def explain(
    impact: Impact | MomentumSolution | Fit,
    *,
    units: UnitSystem = "si",
    form: Form = "markdown",
    uncertainty: Propagation | Mapping[str, Any] | None = None,
) -> str:
    """The derivation of an answer with the numbers in it, step by step.

    Every line is a formula, the same with numbers, and the number of the result: nothing is solved again, and a formula that
    did not give the result's number would say so. Equation numbers, as (5), are those of "Application of Impulse Momentum
    Theory to Vehicle Collisions". An energy gain is told first.

    The working keeps a number as it is if six figures hold it, else four figures (all that stand before the decimal point; of
    small speeds, angles, lengths and ratios two decimals more than an answer has). Where a line needs more figures than that to
    give the result printed below it, its numbers have more: keyed into a pocket calculator as printed, and rounded, every line
    gives its result, and where one cannot, the page says so below it. The answers at the end are rounded: speeds to 0.1 km/h,
    0.1 mph or 0.01 m/s, angles to 1 degree or 0.01 rad, yaw rates to 1 deg/s or 0.01 rad/s, ratios to 0.01, impulses and
    energies to three figures; or to two figures of their standard deviation where that is known.

    Parameters
    ----------
    impact : Impact, MomentumSolution or Fit
        One case, of any forward or reverse solver. Of a ``Fit`` the misfit of every observation, the estimates and what their
        errors come of; its model is code, which stands on no page. The numbers of ``crush_energy`` and ``travel`` do not hold
        what they were worked out from; their formulas are in ``help(collisions.travel.speed)`` and so on.
    units : {"si", "metric", "us"}, optional
        "si": m/s, rad, rad/s, J. "metric": km/h, deg, deg/s, kJ. "us": mph, lb, ft, deg, deg/s, ft*lbf. Numbers that convert
        units within a line are listed at the end.
    form : {"markdown", "text"}, optional
        Markdown with LaTeX between dollar signs, or plain text.
    uncertainty : Propagation, or dict of float, str or Quantity, optional
        Standard deviations by the name of the answer, such as "b.after.vx" or "energy_loss"; "b_after_vx" means the same. Of a
        propagation those outputs are taken that have such a name, as SI if the model returned plain numbers. With an
        ``Interval`` among its inputs an answer gets its range: a standard deviation would leave the interval out. A ``Fit`` has
        standard errors of its own.

    Returns
    -------
    str
        The derivation; the same for the same arguments.

    Raises
    ------
    ShapeError
        A batch: explain one case of it.
    InputError, NoImpactError, NoSolutionError
        An argument that cannot be used, or an impact that was refused (the status says why).

    Examples
    --------
    Example 2 of the paper, as it was asked there: the restitution, and the velocity of the striking car.

    >>> import collisions as col
    >>> from collisions.derivation import explain
    >>> impact = col.reconstruct.central("1100 kg", "950 kg", va="80 km/h", vb=0.0, vb_after="60 km/h")
    >>> page = explain(impact, form="text")
    >>> print(page[page.index("Restitution"):page.index("What follows")].rstrip())
    Restitution, as in (9):
      e = (v'_B - v'_A) / (v_A - v_B)
        = (16.667 - 7.8283) / (22.222 - 0)
        = 0.3977
    """
    problem = bad_system(units)
    if problem is not None:
        raise problem
    _allowed("form", form, _FORMS)
    need_one_case(impact, (Impact, MomentumSolution, Fit), "explain", instead=NOT_EXPLAINED, refused=error_of)
    system = System(units)
    if isinstance(impact, Fit):
        if uncertainty is not None:
            raise no_uncertainty()
        page = Page(system, form == "markdown", {})
        page.title("Fit to evidence, step by step")
        fit(page, impact)
    elif isinstance(impact, MomentumSolution):
        page = Page(system, form == "markdown", *_spread(uncertainty, momentum.NAMES, momentum.kind_of))
        page.title("Planar momentum, step by step")
        _gain(page, impact.status, impact.translational_energy_loss)
        momentum.momentum(page, impact)
    else:
        page = _of_impact(impact, system, form, uncertainty)
    _notes(page, uncertainty, of_impact=not isinstance(impact, Fit))
    return page.text()


def no_uncertainty() -> InputError:
    """The refusal of other errors than those that a fit has."""
    return InputError(
        "uncertainty is none of a Fit, which has the standard errors of its unknowns; leave it out, or explain the impact at "
        "the values found, with a propagation of fit.inputs",
        code="bad_option",
        argument="uncertainty",
    )


def _of_impact(impact: Impact, system: System, form: str, uncertainty: Any) -> Page:
    page = Page(system, form == "markdown", *_spread(uncertainty, answers.NAMES, answers.kind_of))
    page.title("The impact, step by step")
    _gain(page, impact.status, impact.energy_loss)
    page.heading("Given" if impact.reconstruction is None else "The contact, and the state before as it was found")
    answers.given(page, impact)
    answers.direction(page, impact)
    chosen(page, impact)
    found(page, impact)
    _MODELS[impact.model](page, impact)
    changes(page, impact)
    answers.answers(page, impact)
    return page


def _gain(page: Page, status: Any, loss: float) -> None:
    """An energy gain comes before anything else."""
    if status == Status.ENERGY_GAIN:
        page.stress(
            f"Energy gain: the vehicles leave with {page.system.answer(-loss, 'energy')} more than they came with, which no "
            "impact gives. The inputs do not go together; the numbers are shown as they are."
        )


def _notes(page: Page, uncertainty: Any, of_impact: bool) -> None:
    """What the numbers are."""
    page.heading("Notes")
    lines = [
        "Every step was worked out with all digits. A number is printed as it is if six figures hold it, else with four "
        "figures; but with all those before its decimal point, and a speed, angle, length or ratio with at most two decimals "
        "more than an answer has. Where the numbers of a line need more figures than that to give the result printed below "
        "them, they have more. So every line, worked out from its printed numbers and rounded like its result, gives that "
        "result; where a line cannot, the page says so below it. The answers are rounded.",
    ]
    if of_impact:
        lines[:0] = [
            'Equation numbers are those of "Application of Impulse Momentum Theory to Vehicle Collisions"; its vehicles 1 and '
            "2 are A and B here."
        ]
        lines.append("x and y are axes of the road plane; angles and yaw are positive counter-clockwise, seen from above.")
    if page.ranges:
        held = "every value" if uncertainty.method == "interval" else "95 percent, wherever in the interval the truth lies"
        lines.append(
            "A range in brackets is no ±: an interval is among the inputs, and of its values none is said to be likelier than "
            f"another. The range holds {held}."
        )
    if page.system.conversions:
        lines.append("Numbers that convert units: " + "; ".join(page.system.conversions).replace("**", "^") + ".")
    page.listed(lines if not page.latex else [line.replace("*", r"\*") for line in lines])


def _allowed(argument: str, value: Any, allowed: tuple[str, ...]) -> None:
    if not isinstance(value, str) or value not in allowed:
        raise InputError(
            f"{argument} must be one of {', '.join(map(repr, allowed))}, got {shown(value)}",
            code="bad_option",
            argument=argument,
        )


def _spread(uncertainty: Any, names: tuple[str, ...], kind_of: Any) -> tuple[dict[str, float], dict[str, tuple[float, float]]]:
    """Standard deviations in SI, by the name of the answer; or ranges, where there is no distribution to have a deviation."""
    if uncertainty is None:
        return {}, {}
    known = {**{name.replace(".", "_"): name for name in names}, **{name: name for name in names}}
    if isinstance(uncertainty, Propagation):
        outputs = {known[name]: uncertainty[name] for name in uncertainty if name in known}
        if not outputs:
            raise _unknown(", ".join(uncertainty), names)
        # With an interval among the inputs there are two deviations, and how far the interval goes is in neither.
        open_ended = {name for name, output in outputs.items() if isinstance(output.std, tuple)}
        return (
            {name: float(output.std) for name, output in outputs.items() if name not in open_ended},
            {name: outputs[name].interval() for name in outputs if name in open_ended},
        )
    if not isinstance(uncertainty, Mapping):
        raise InputError(
            f"uncertainty must be a Propagation, or a dict of standard deviations by name, got {type(uncertainty).__name__}",
            code="bad_option",
            argument="uncertainty",
        )
    stray = [shown(name) for name in uncertainty if name not in known]
    if stray:
        raise _unknown(", ".join(stray), names)
    reader = ArgumentReader()
    found = {}
    for name, value in uncertainty.items():
        read = reader.number(value, SI_UNITS[kind_of(known[name])], name)
        found[known[name]] = at_least_zero(reader, read, value, name, "negative_deviation", "give the standard deviation")
    reader.close()
    for name, value in found.items():
        if not isinstance(value, float) or not math.isfinite(value):
            raise ShapeError(f"the standard deviation of {name} must be one number", code="bad_shape", argument=name)
    return found, {}


def _unknown(given: str, names: tuple[str, ...]) -> InputError:
    return InputError(
        f"uncertainty names no answer of this derivation: {given}; the answers are {', '.join(names)}",
        code="no_output",
        argument="uncertainty",
    )
