"""A question answered: one case at once, or many in blocks, and what is said of those that were refused or gain energy."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from .arguments import TANGENTIAL_DOMAINS, check_options
from .door import FINITE, NOT_NEGATIVE, POSITIVE, UNIT_INTERVAL, broadcast
from .errors import CollisionsError, CollisionsWarning, EnergyGainWarning, InputError, Status
from .impact import Asked, Impact, build, unanswered
from .kernels import checks, codes
from .kernels.select import verdict
from .progress import reporter
from .quiet import warn_of_cases
from .vehicle import DOMAINS

if TYPE_CHECKING:
    from .kernels.batch import Check
    from .provenance import ModelChoice

# What finds the motion that a model cannot hold, and the values it looks at.
Scope: TypeAlias = tuple[Callable[..., Any], tuple[Any, ...]]

# A NamedTuple made from a tuple costs a third of one made from arguments.
_as_asked: Callable[..., Asked] = tuple.__new__
# By domain: what is wrong with a value, its status, and what tells that an array has none.
_FAULTS: dict[str, tuple[tuple[tuple[int, Callable[..., Any]], ...], Callable[..., bool]]] = {
    FINITE: (((codes.NOT_FINITE, checks.not_finite),), checks.all_finite),
    POSITIVE: (
        ((codes.NOT_FINITE, checks.not_a_number), (codes.NOT_POSITIVE, checks.not_positive)),
        checks.all_positive,
    ),
    UNIT_INTERVAL: (((codes.BAD_FRACTION, checks.outside_unit_interval),), checks.all_in_unit_interval),
    NOT_NEGATIVE: (((codes.BAD_FRICTION, checks.negative),), checks.all_not_negative),
}


def answer(
    kernel: Callable[..., tuple[Any, ...]],
    inputs: tuple[Any, ...],
    settings: tuple[Any, ...],
    asked: tuple[Any, ...],
    plain: bool,
    scope: Scope | None,
    on_failure: Any,
    threads: Any,
    progress: Any,
) -> Impact:
    """The Impact of one case or of a batch: the kernel called with its inputs and its settings.

    ``scope`` finds the motion that the model cannot hold; every other value has been checked at the door.
    """
    if on_failure is not None or type(threads) is not int or threads != 1 or progress is not None:
        check_options(on_failure, threads, progress)
    question = _as_asked(Asked, asked)
    if not (plain and question.a._given is None and question.b._given is None):
        shape = broadcast(dict(numbers_of(question)))
        if shape is not None:
            raw = solved(kernel, inputs, settings, question, scope, shape, threads, progress)
            return concluded(question, raw, on_failure)
    raw = kernel(*inputs, *settings)
    fault = scope[0](*scope[1]) if scope is not None else codes.OK
    if fault or raw[0]:
        raw = (fault or raw[0], *raw[1:])
        if raw[0] > codes.ENERGY_GAIN:
            if on_failure != "nan":
                # Cases that are answered never come here, and the import of the package need not wait for it.
                from .refusals import refusal

                raise refusal(question, raw)
            raw = unanswered(raw[0])
        else:
            gain = -raw[codes.OUTPUTS.index("energy_loss")]
            _warn_of_gain(f"the impact gains {gain:.6g} J of energy", gain)
    return build(question, raw)


def solved(
    kernel: Callable[..., tuple[Any, ...]],
    inputs: tuple[Any, ...],
    settings: tuple[Any, ...],
    asked: Asked,
    scope: Scope | None,
    shape: tuple[int, ...],
    threads: int,
    progress: Any,
) -> Any:
    """The outputs of the cases of a batch."""
    # Adds a twentieth to the import of the package, and single cases never come here.
    from .kernels.batch import Scoped, precision, solve_lanes

    dtype = precision(value for _, value in numbers_of(asked))
    eps = float(np.finfo(dtype).eps)
    if scope is not None:
        kernel = Scoped(kernel, scope[0], len(inputs), len(scope[1]))
        inputs = (*inputs, *scope[1])
    checked = value_checks(asked, eps)
    return solve_lanes(kernel, (*settings, eps), inputs, checked, shape, dtype, threads, reporter(progress))


def concluded(asked: Asked, raw: Any, on_failure: Any, choice: ModelChoice | None = None) -> Impact:
    """The Impact of a batch, after what is to be said of its refused and its gaining cases."""
    impact, status = build(asked, raw), raw[0]
    if choice is not None:
        impact._cache["choice"] = choice._where_answered(impact.refused)
    if np.any(status > codes.ENERGY_GAIN):
        if on_failure == "raise":
            raise _first_refusal(impact)
        if on_failure is None:
            warn_of_refusals(status)
    gaining = status == codes.ENERGY_GAIN
    if gaining.any():
        most = float(-raw[codes.OUTPUTS.index("energy_loss")][gaining].min())
        _warn_of_gain(f"{int(gaining.sum())} of {status.size} cases gain energy, up to {most:.6g} J", most)
    return impact


def first_refused(status: Any) -> tuple[tuple[int, ...], str]:
    """Where in a batch the first refused case stands, and how a message says so."""
    index = tuple(int(i) for i in np.argwhere(status > codes.ENERGY_GAIN)[0])
    return index, f"case {index if len(index) != 1 else index[0]}: "


def warn_of_refusals(status: Any, advice: str = "see .status, or on_failure='raise'") -> None:
    """One warning that counts the refused cases of a batch by their kind."""
    refused = int(np.count_nonzero(status > codes.ENERGY_GAIN))
    kinds = {
        Status(int(code)).label: int(np.count_nonzero(status == code)) for code in np.unique(status[status > codes.ENERGY_GAIN])
    }
    listed = ", ".join(f"{count} {label}" for label, count in kinds.items())
    text = f"{refused} of {status.size} cases were refused and are NaN ({listed}); {advice}"
    warn_of_cases(CollisionsWarning(text, code="refused_cases", counts=kinds))


def numbers_of(asked: Asked) -> list[tuple[str, Any]]:
    """Every number of the question by the name the caller knows it by."""
    found = [("restitution", asked.restitution), (asked.rule, asked.bound)]
    found += [(f"normal[{i}]", part) for i, part in enumerate(asked.normal)]
    if asked.point is not None:
        found += [(f"point[{i}]", part) for i, part in enumerate(asked.point)]
    for label, vehicle in (("a", asked.a), ("b", asked.b)):
        found += [(f"{label}.{name}", getattr(vehicle, name)) for name in DOMAINS]
        if vehicle.pivot is not None:
            found += [(f"{label}.pivot[{i}]", part) for i, part in enumerate(vehicle.pivot)]
    return found


def value_checks(asked: Asked, eps: float) -> list[Check]:
    """What the door checks of scalars, for the arrays of the question: the vehicles first, which are made first."""
    from .kernels.batch import Check

    found: list[Check] = []

    def add(passes: Callable[..., bool] | None, values: tuple[Any, ...], *findings: tuple[int, Callable[..., Any]]) -> None:
        found.append(Check(lambda *block: verdict(*((at_fault(*block), code) for code, at_fault in findings)), values, passes))

    def add_array(value: Any, domain: str) -> None:
        if isinstance(value, np.ndarray):
            findings, passes = _FAULTS[domain]
            add(passes, (value,), *findings)

    for vehicle in (asked.a, asked.b):
        for name, domain in DOMAINS.items():
            add_array(getattr(vehicle, name), domain)
        if vehicle.pivot is not None:
            for part in vehicle.pivot:
                add_array(part, FINITE)
            inertia = () if vehicle.yaw_inertia is None else (vehicle.yaw_inertia,)
            add(None, (vehicle.mass, *inertia), (codes.PINNED_INFINITE, checks.either_infinite))
            motion = (vehicle.vx, vehicle.vy, vehicle.yaw_rate, vehicle.x, vehicle.y, *vehicle.pivot)
            if vehicle.x is not None and vehicle.y is not None:
                # In float64, too, a velocity in float32 is no closer.
                own = checks.rounding(eps, vehicle.vx, vehicle.vy)
                add(None, motion, (codes.PINNED_VELOCITY, partial(checks.not_about_pivot, eps=own)))
    if isinstance(asked.restitution, np.ndarray):
        add(checks.all_in_unit_interval, (asked.restitution,), (codes.BAD_RESTITUTION, checks.outside_unit_interval))
    if any(isinstance(part, np.ndarray) for part in asked.normal):
        for part in asked.normal:
            add_array(part, FINITE)
        add(checks.all_with_length, asked.normal, (codes.ZERO_NORMAL, checks.without_length))
    for part in asked.point or ():
        add_array(part, FINITE)
    add_array(asked.bound, TANGENTIAL_DOMAINS[asked.rule])
    return found


def _first_refusal(impact: Impact) -> CollisionsError:
    """The error of the first refused case, found by asking for it alone."""
    index, place = first_refused(impact.status)
    try:
        impact.case(index)
    except CollisionsError as error:
        return type(error)(place + str(error), code=error.code, **error.fields)
    outcome = Status(impact.status[index])
    return InputError(place + outcome.sentence, code=outcome.label)


def _warn_of_gain(what: str, gain: float) -> None:
    text = (
        f"{what}: this restitution and tangential impulse cannot occur together without a source of energy; lower the "
        f"restitution or the ratio, or take law='kudlich-slibar' with friction="
    )
    warn_of_cases(EnergyGainWarning(text, code="energy_gain", gain=gain))
