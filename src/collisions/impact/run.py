"""Solves validated inputs: single cases, or batches in blocks, with errors and warnings for refused
cases and energy gains.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from operator import add, attrgetter
from typing import Any

import numpy as np

from ..kernels.contact_laws import BRACH, LAWS, RULES
from ..kernels.elementwise import (
    FINITE,
    Domain,
    all_with_length,
    either_infinite,
    not_about_pivot,
    restitution_domain,
    rounding,
    without_length,
)
from ..kernels.status import Answer, Passed, Status
from ..messages.errors import (
    CollisionsError,
    CollisionsWarning,
    EnergyGainWarning,
    InputError,
    NoImpactError,
    NoSolutionError,
    placed,
)
from ..messages.progress import reporter
from ..messages.warning import in_study, quietly, state_of_cases, warn_of_cases
from ..quantities.attributes import read_only
from ..quantities.refusals import must_be
from ..quantities.tables import Sentences, said
from ..vehicle.tyres import DOMAINS as TYRE_DOMAINS
from ..vehicle.tyres import Tyres, could_lift
from ..vehicle.vehicle import DOMAINS, with_name
from .inputs import NO_IMPULSE, Inputs, first_case, numbers_in, part_of_inputs
from .models import TIME_RESOLVED, Model, float_function, model_of, read_again, variant_of
from .time_resolved_inputs import DOMAINS as TIME_DOMAINS
from .time_resolved_inputs import (
    beside_tyres,
    held_impulse,
    solve_case_in_time,
    solve_cases_in_time,
    with_tyres,
)

_REFUSED_CASES = "refused_cases"
# A contact that gives back this much of its closing speed may gain by the error of ordinary steps.
_NEARLY_ALL = 0.999
_REFUSED = Answer(*[False if name == "sticks" else math.nan for name in Answer._fields])


def solve_inputs(
    model: Model,
    inputs: Inputs,
    on_failure: Any = None,
    threads: Any = 1,
    progress: Any = None,
) -> Any:
    """Run a model on one case or a batch, with its warnings and errors."""
    if on_failure is not None or progress is not None or type(threads) is not int or threads != 1:
        check_options(on_failure, threads, progress)
    if inputs.tyres_a is not None or inputs.tyres_b is not None:
        if model.name == "eccentric":
            if inputs.shape is None:
                found = _single_with_tyres(model, inputs)
                if found is not None:
                    return found

            def solve(one: Inputs, quiet: bool) -> Any:
                quiet = quiet or inputs.shape is not None
                with quietly() if quiet else nullcontext():
                    failing = "nan" if quiet else on_failure
                    return solve_inputs(model, one, failing, threads, progress)

            raw: Any = with_tyres(inputs, solve)
            if inputs.shape is not None:
                raw = _where_tyres_hold(inputs, raw)
                raise_or_warn(inputs, raw, on_failure)
            return raw
        if model is not TIME_RESOLVED:
            inputs = replace(inputs, tyres_a=None, tyres_b=None, duration=None)
    if inputs.shape is not None:
        if model is TIME_RESOLVED:
            raw = solve_cases_in_time(
                inputs, cases_of(inputs, inputs.shape, threads)[0], reporter(progress)
            )
        else:
            raw = solve_cases((model,), None, inputs, inputs.shape, threads, progress)
        raise_or_warn(inputs, raw, on_failure)
        return raw
    if model is TIME_RESOLVED:
        raw = solve_case_in_time(inputs)
    else:
        variant, given = variant_of(inputs), vars(inputs)
        raw = float_function(model, *variant)(given)
        if raw is not None:
            return raw
        raw = float_function(model, *variant, refused=True)(given) or model.answer(inputs)
    if raw.status > Status.ENERGY_GAIN:
        if on_failure != "nan":
            raise refusal(inputs, raw)
        return (
            Passed(raw.status) if model is TIME_RESOLVED else _REFUSED._replace(status=raw.status)
        )
    if raw.status == Status.ENERGY_GAIN:
        gained = said(-raw.energy_loss, "energy", inputs.texts)
        _warn_of_gain(f"the impact gains {gained} of energy", -raw.energy_loss, None, inputs)
    return raw


def _single_with_tyres(model: Model, inputs: Inputs) -> Any:
    """``with_tyres`` of one case in plain floats; None where its status is not plainly OK."""
    variant, given = variant_of(inputs), vars(inputs)
    first = float_function(model, *variant)(given)
    if first is None:
        return None
    pushes = {label: held_impulse(inputs, first, label) for label in "ab"}
    outside = {
        f"outside_{label}": tuple(map(add, getattr(inputs, f"outside_{label}") or NO_IMPULSE, push))
        for label, push in pushes.items()
    }
    raw = float_function(model, *variant[:-2], True, False)({**given, **outside})
    return None if raw is None else beside_tyres(inputs, raw, pushes)


def solve_cases(
    models: Sequence[Model],
    which: Any,
    inputs: Inputs,
    shape: tuple[int, ...],
    threads: int,
    progress: Any,
) -> Any:
    """Solve a batch; ``which`` has the number of each case's model, None if there is only one."""
    # Adds a twentieth to the import of the package, and single cases never come here.
    from ..engine.batch import call_of, solve_cases

    cases, eps = cases_of(inputs, shape, threads)
    calls = [
        call_of(model.kernel, (model.problem(inputs),), (*model.settings(inputs), eps))
        for model in models
    ]
    return solve_cases(calls, which, cases, reporter(progress))


def cases_of(inputs: Inputs, shape: tuple[int, ...], threads: int) -> tuple[Any, float]:
    """The batch as the kernels take it, and the rounding of its precision."""
    from ..engine.batch import Batch
    from ..quantities.precision import precision

    dtype = precision(numbers_in(inputs))
    eps = float(np.finfo(dtype).eps)
    return Batch(_value_checks(inputs, eps), shape, dtype, threads), eps


def check_options(on_failure: Any, threads: Any = 1, progress: Any = None) -> None:
    """Raise for an option that no solver knows."""
    if on_failure is not None and not (
        isinstance(on_failure, str) and on_failure in ("raise", "nan")
    ):
        raise must_be("on_failure", "None, 'raise' or 'nan'", on_failure, code="bad_option")
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
        raise must_be("threads", "a whole number from 1", threads, code="bad_option")
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        text = (
            "progress must be a function of (done, total), or `True` for a bar, got "
            f"{type(progress).__name__}"
        )
        raise InputError(text, code="bad_option", argument="progress")


def refusal(inputs: Inputs, raw: Answer | Passed) -> CollisionsError:
    """The error for a refused single case."""
    bodies = (("a", inputs.a), ("b", inputs.b))
    for side, body in bodies:
        for name in DOMAINS:
            if getattr(body, name) != getattr(body, name):
                return InputError(
                    f"{side}.{name} is NaN: the state of a case that was refused",
                    code="not_finite",
                    argument=name,
                )
    status: Status = raw.status
    nx, ny = inputs.normal
    say = Sentences(inputs.texts)
    values: dict[str, Any] = {
        "closing_speed": say(raw.closing_speed, "speed"),
        "model": inputs.model,
    }
    values |= {"rule": inputs.rule, "value": inputs.rule_value}
    values |= {"nx": nx, "ny": ny, "opposite_x": 0.0 - nx, "opposite_y": 0.0 - ny}
    extra: dict[str, Any] = {}
    match status:
        case Status.SEPARATING | Status.GRAZING:
            extra["closing_speed"] = raw.closing_speed
            if raw.closing_speed > 0.0:
                text = (
                    "no impact: the impulses from outside part the bodies, which approach at "
                    f"{values['closing_speed']}"
                )
                check = "check the signs of outside_a and outside_b"
                if LAWS[inputs.law or BRACH].followed and inputs.restitution >= 0.0:
                    why = (
                        f"so `law={inputs.law!r}` finds no compression that it could give back "
                        "a part of"
                    )
                    return error_of(
                        status, f"{text}, {why}; {check}, or take `law={BRACH!r}`", **extra
                    )
                return error_of(status, f"{text}, by more than restitution does; {check}", **extra)
        case Status.RATIO_JAMS:
            coupling = raw.coupling
            limit = (
                -1.0 / (raw.effective_mass * coupling)
                if coupling
                else math.copysign(math.inf, inputs.rule_value)
            )
            values |= {"limit": limit, "side": "less" if limit > 0.0 else "greater"}
            extra["limit"] = limit
        case Status.SPINNING:
            turning = [(side, body) for side, body in bodies if body.yaw_rate != 0.0]
            rates = [
                f"{with_name(side, body)} has yaw_rate = {say(body.yaw_rate, 'yaw rate')}"
                for side, body in turning
            ]
            values["motion"] = " and ".join(rates)
            extra["argument"] = "yaw_rate"
        case Status.TRANSVERSE:
            across = [(side, nx * body.vy - ny * body.vx) for side, body in bodies]
            moving = [(side, say(speed, "speed")) for side, speed in across if speed != 0.0]
            values["motion"] = ", ".join(
                f"{side} moves at {speed} across it" for side, speed in moving
            )
            extra["argument"] = "normal"
    return error_of(status, status.message.format(**values), **extra)


def error_of(status: int, text: str, **fields: Any) -> CollisionsError:
    """The error for a status, of the class that its ``about`` names."""
    outcome = Status(status)
    kind = {"impact": NoImpactError, "solution": NoSolutionError, "input": InputError}[
        outcome.about
    ]
    return kind(text, code=outcome.label, **fields)


def raise_or_warn(
    inputs: Inputs,
    raw: Any,
    on_failure: Any,
    one: Callable[[Callable[[Any], Any]], Any] | None = None,
) -> None:
    """Raise for, or warn of, the refused cases of a batch; warn of energy gains. ``one`` solves a
    single case.
    """
    status = raw.status
    worst = status.max(initial=Status.OK)
    if worst == Status.OK:
        return
    if worst > Status.ENERGY_GAIN:
        if on_failure == "raise":
            raise _first_refusal(inputs, status, one)
        if on_failure is None:
            warn_of_refusals(status)
    gaining = status == Status.ENERGY_GAIN
    if gaining.any():
        most, count = float(-raw.energy_loss[gaining].min()), int(gaining.sum())
        largest = said(most, "energy", inputs.texts)
        _warn_of_gain(
            f"{count} of {status.size} cases gain energy, up to {largest}", most, gaining, inputs
        )


def warn_of_refusals(status: Any, advice: str = "see .status, or `on_failure='raise'`") -> None:
    """One warning that counts the refused cases of a batch by their kind."""
    refused = int(np.count_nonzero(status > Status.ENERGY_GAIN))
    kinds = {
        Status(int(code)).label: int(np.count_nonzero(status == code))
        for code in np.unique(status[status > Status.ENERGY_GAIN])
    }
    listed = ", ".join(f"{count} {label}" for label, count in kinds.items())
    text = f"{refused} of {status.size} cases were refused and are NaN ({listed}); {advice}"
    warning = CollisionsWarning(text, code=_REFUSED_CASES, counts=kinds)
    warn_of_cases(warning, _refused_by_kind(status))


def state_refusals(status: Any) -> None:
    """State of a study the refused cases of ``on_failure="nan"`` by their kind, without a
    warning.
    """
    if in_study():
        state_of_cases(_refused_by_kind(status), _REFUSED_CASES)


def _refused_by_kind(status: Any) -> dict[str, Any]:
    """What is said of a study where a solver refuses cases, with where each kind is."""
    status = np.asarray(status)
    return {
        f"refused by a solver, as {Status(code).label}": status == code
        for code in np.unique(status[status > Status.ENERGY_GAIN]).tolist()
    }


_of_vehicle = attrgetter(*DOMAINS)
_of_time = attrgetter(*TIME_DOMAINS)


def _value_checks(inputs: Inputs, eps: float) -> list[Any]:
    """The reader's checks of scalars, as checks of the input arrays; vehicles come first, as they
    are made first.
    """
    from ..engine.batch import Check

    found: list[Check] = []

    def add_arrays(domain: Domain, *values: Any) -> None:
        for value in values:
            if isinstance(value, np.ndarray):
                found.append(Check(domain.faults, (value,), domain.holds, domain is FINITE))

    for vehicle in (inputs.a, inputs.b):
        for domain, value in zip(DOMAINS.values(), _of_vehicle(vehicle), strict=True):
            if isinstance(value, np.ndarray):
                add_arrays(domain, value)
        if vehicle.pivot is not None:
            add_arrays(FINITE, *vehicle.pivot)
            inertia = () if vehicle.yaw_inertia is None else (vehicle.yaw_inertia,)
            found.append(
                Check(((either_infinite, Status.PINNED_INFINITE),), (vehicle.mass, *inertia))
            )
            motion = (
                vehicle.vx,
                vehicle.vy,
                vehicle.yaw_rate,
                vehicle.x,
                vehicle.y,
                *vehicle.pivot,
            )
            if vehicle.x is not None and vehicle.y is not None:
                # A float32 velocity is no more accurate in float64.
                own = rounding(eps, vehicle.vx, vehicle.vy)
                found.append(
                    Check(((partial(not_about_pivot, eps=own), Status.PINNED_VELOCITY),), motion)
                )
    add_arrays(restitution_domain(inputs.incomplete), inputs.restitution)
    if any(isinstance(part, np.ndarray) for part in inputs.normal):
        add_arrays(FINITE, *inputs.normal)
        found.append(
            Check(
                ((without_length, Status.ZERO_NORMAL),),
                inputs.normal,
                all_with_length,
                implied=True,
            )
        )
    add_arrays(FINITE, *(inputs.point or ()), *(inputs.outside_a or ()), *(inputs.outside_b or ()))
    add_arrays(RULES[inputs.rule].domain, inputs.rule_value)
    return [*found, *_lasting_checks(inputs)]


def _lasting_checks(inputs: Inputs) -> list[Any]:
    """The same of how the contact lasts, and of the tyres."""
    from ..engine.batch import Check

    found = tyre_checks(inputs.tyres)
    for given, domains in zip(_of_time(inputs), TIME_DOMAINS.values(), strict=True):
        if given is None:
            continue
        parts = given if isinstance(given, tuple) else (given,)
        for part, domain in zip(parts, domains, strict=False):
            if isinstance(part, np.ndarray):
                found.append(Check(domain.faults, (part,), domain.holds))
    return found


def tyre_checks(tyres_of: Mapping[str, Tyres]) -> list[Any]:
    """The same of the tyres of each vehicle."""
    from ..engine.batch import Check

    found = []
    for tyres in tyres_of.values():
        for name, value in tyres.named.items():
            domain = TYRE_DOMAINS[name.partition("[")[0]]
            if isinstance(value, np.ndarray):
                found.append(Check(domain.faults, (value,), domain.holds))
        lifted = (
            tyres.friction,
            0.0 if tyres.height is None else tyres.height,
            tyres.wheelbase,
            tyres.track,
        )
        if any(isinstance(value, np.ndarray) for value in lifted):
            found.append(Check(((could_lift, Status.WHEEL_LIFTS),), lifted))
    return found


def _where_tyres_hold(inputs: Inputs, raw: Any) -> Any:
    """The answers of a batch with NaN where a number of the tyres cannot be used, or what they give
    is beyond all numbers.
    """
    with np.errstate(all="ignore"):
        status = raw.status.copy()
        for check in reversed(_lasting_checks(inputs)):
            fault = np.broadcast_to(check.fault(*check.values), status.shape)
            np.copyto(status, fault, where=np.not_equal(fault, Status.OK), casting="unsafe")
    refused = status > Status.ENERGY_GAIN
    if not refused.any():
        return raw
    found = {
        name: np.where(refused, name != "sticks" and math.nan, getattr(raw, name))
        for name in raw._fields[1:]
    }
    kinds = {name: value.astype(getattr(raw, name).dtype) for name, value in found.items()}
    return raw._replace(status=read_only(status), **read_only(kinds))


def _first_refusal(
    inputs: Inputs, status: Any, one: Callable[[Callable[[Any], Any]], Any] | None
) -> CollisionsError:
    """The error of the first refused case, found by solving it by itself."""
    index, place = first_case(status > Status.ENERGY_GAIN)

    def take(value: Any) -> Any:
        return np.broadcast_to(value, status.shape)[index].item()

    try:
        case = read_again(part_of_inputs(inputs, take))
        solve_inputs(model_of(case), case) if one is None else one(take)
    except CollisionsError as error:
        return placed(error, place)
    outcome = Status(status[index])
    return InputError(f"{place}: {outcome.sentence}", code=outcome.label)


def gain_of_steps(inputs: Inputs) -> str:
    """Why a contact that was followed in steps gains energy, which its inputs do not; "" for
    another.
    """
    if inputs.model != TIME_RESOLVED.name:
        return ""
    nearly_all = np.any(np.asarray(inputs.restitution) >= _NEARLY_ALL)
    cure = f"take a restitution below {_NEARLY_ALL}, or give" if nearly_all else "give"
    return (
        "that is the error of the steps, where the contact gives back nearly all it took; "
        f"{cure} more steps than {inputs.steps}"
    )


def _warn_of_gain(what: str, gain: float, where: Any, inputs: Inputs) -> None:
    why = gain_of_steps(inputs) or (
        "this restitution and tangential impulse cannot occur together without a source of energy; "
        "lower the restitution or the ratio, or take `law='kudlich-slibar'` with `friction=`"
    )
    warning = EnergyGainWarning(f"{what}: {why}", code="energy_gain", gain=gain)
    warn_of_cases(warning, {f"the impact gains energy: {why}": where})
