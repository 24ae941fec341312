"""The arguments the solvers share: read and checked; then one case is solved, or many."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Literal, TypeAlias

import numpy as np

from .directions import direction
from .errors import CollisionsError, CollisionsWarning, EnergyGainWarning, InputError, ShapeError, Status
from .impact import Asked, Impact, build
from .kernels import checks, codes
from .kernels.batch import Check, solve_lanes
from .kernels.select import verdict
from .refusals import refusal
from .units import FINITE, NOT_NEGATIVE, POSITIVE, UNIT_INTERVAL, Door, callers_level
from .vehicle import DOMAINS, Vehicle

Law: TypeAlias = Literal["brach", "kudlich-slibar"]
OnFailure: TypeAlias = Literal["raise", "nan"]
Progress: TypeAlias = Callable[[int, int], None]

_TANGENTIAL_DOMAINS = {codes.FRICTION: NOT_NEGATIVE, codes.IMPULSE_RATIO: FINITE, codes.CRITICAL_FRACTION: UNIT_INTERVAL}
_VALUE_CHECKS: dict[str, tuple[tuple[int, Callable[..., Any]], ...]] = {
    FINITE: ((codes.NOT_FINITE, checks.not_finite),),
    POSITIVE: ((codes.NOT_FINITE, checks.not_a_number), (codes.NOT_POSITIVE, checks.not_positive)),
}
_BOUND_CHECKS = {
    codes.FRICTION: (codes.BAD_FRICTION, checks.negative),
    codes.IMPULSE_RATIO: (codes.NOT_FINITE, checks.not_finite),
    codes.CRITICAL_FRACTION: (codes.BAD_FRACTION, checks.outside_unit_interval),
}


def read(
    a: Vehicle, b: Vehicle, restitution: Any, normal: Any, point: Any, tangential: tuple[Any, Any, Any], law: Any
) -> tuple[Any, tuple[Any, Any], str, Any, tuple[Any, Any] | None]:
    """Restitution, unit normal, tangential rule and its value, and contact point, as floats or arrays.

    Plain floats that need no conversion pass at once; anything else goes through the door, which names all that is wrong.
    """
    given = [(rule, value) for rule, value in zip(codes.RULES, tangential, strict=True) if value is not None]
    quick = (
        type(a) is type(b) is Vehicle
        and type(restitution) is float
        and 0.0 <= restitution <= 1.0
        and len(given) == 1
        and type(given[0][1]) is float
        and 0.0 <= given[0][1] <= 1.0
        and law in codes.LAWS
        and (point is None or (type(point) is tuple and len(point) == 2 and type(point[0]) is type(point[1]) is float))
        and (point is None or math.isfinite(point[0] + point[1]))
    )
    if quick and type(normal) is float and -6.0 < normal < 6.0:
        return restitution, (math.cos(normal), math.sin(normal)), given[0][0], given[0][1], point
    door = Door()
    for label, vehicle in (("a", a), ("b", b)):
        if not isinstance(vehicle, Vehicle):
            door.refuse(
                InputError(
                    f"{label} must be a Vehicle, got {type(vehicle).__name__}; write collisions.Vehicle(mass=...)",
                    code="not_a_vehicle",
                    argument=label,
                )
            )
    unit = direction(door, normal, "normal")
    if quick and not door.problems:
        return restitution, unit, given[0][0], given[0][1], point
    e = door.number(restitution, "", "restitution", UNIT_INTERVAL)
    contact = None if point is None else door.pair(point, "m", "point")
    rule, bound = codes.FRICTION, math.nan
    if len(given) == 1:
        rule = given[0][0]
        bound = door.number(given[0][1], "", rule, _TANGENTIAL_DOMAINS[rule])
    else:
        found = "none" if not given else " and ".join(f"{name}=" for name, _ in given)
        door.refuse(
            InputError(
                f"give exactly one of friction=, impulse_ratio=, critical_fraction=; got {found}. There is no default, because "
                f"it decides cases: friction=0 is a frictionless contact, friction=inf one that never slips",
                code="one_tangential",
                argument="friction",
            )
        )
    if law not in codes.LAWS:
        door.refuse(
            InputError(
                f"law must be 'brach' (no slip at separation) or 'kudlich-slibar' (no slip at the end of compression), "
                f"got {law!r}",
                code="bad_law",
                argument="law",
            )
        )
    door.close()
    return e, unit, rule, bound, contact


def refuse_pivots(model: str, a: Vehicle, b: Vehicle) -> None:
    """The central models know no constraint."""
    for label, vehicle in (("a", a), ("b", b)):
        if vehicle.pivot is not None:
            raise InputError(
                f"{label} has a pivot, which {model} cannot hold; use eccentric, which needs yaw_inertia, x, y and point",
                code="pinned",
                argument="pivot",
            )


def answer(
    solver: Callable[..., Impact],
    kernel: Callable[..., tuple[Any, ...]],
    asked: Asked,
    inputs: tuple[Any, ...],
    scope: Sequence[Check],
    on_failure: Any,
    threads: Any,
    progress: Any,
) -> Impact:
    """The Impact of one case or of a batch. ``scope`` are the checks of the model, the values having been checked at the door."""
    if on_failure is not None or threads != 1 or progress is not None:
        _check_options(on_failure, threads, progress)
    a, b = asked.a, asked.b
    if (a._given is not None or b._given is not None or np.ndarray in map(type, inputs)) and (shape := _shape(asked)) is not None:
        return _batch(solver, kernel, asked, inputs, scope, shape, on_failure, threads, progress)
    raw = kernel(*inputs)
    if scope:
        fault = verdict(*((condition(*values), code) for code, condition, values in scope))
        if fault:
            raw = (fault, *raw[1:])
    if raw[0]:
        if raw[0] > codes.ENERGY_GAIN:
            if on_failure != "nan":
                raise refusal(asked, raw)
            raw = (raw[0], *(False if name == "sticks" else math.nan for name in codes.OUTPUTS[1:]))
        else:
            loss = raw[codes.OUTPUTS.index("energy_loss")]
            _warn_of_gain(f"the impact gains {-loss:.6g} J of energy", -loss)
    return build(asked, raw)


def ask(solver: Callable[..., Impact], asked: Asked, **options: Any) -> Impact:
    """The same question again, to the same solver."""
    arguments: dict[str, Any] = {"normal": asked.normal, **options}
    if asked.law is not None:
        arguments |= {asked.rule: asked.bound, "law": asked.law}
    if asked.point is not None:
        arguments["point"] = asked.point
    return solver(asked.a, asked.b, asked.restitution, **arguments)


def _batch(
    solver: Callable[..., Impact],
    kernel: Callable[..., tuple[Any, ...]],
    asked: Asked,
    inputs: tuple[Any, ...],
    scope: Sequence[Check],
    shape: tuple[int, ...],
    on_failure: Any,
    threads: int,
    progress: Any,
) -> Impact:
    arrays = [value for _, value in _values(asked) if isinstance(value, np.ndarray)]
    dtype = np.float32 if all(array.dtype == np.float32 for array in arrays) else np.float64
    eps = float(np.finfo(dtype).eps)
    scope = [
        (code, partial(condition, eps=eps) if condition in (checks.transverse, checks.not_about_pivot) else condition, values)
        for code, condition, values in (*_value_checks(asked), *scope)
    ]
    raw = solve_lanes(partial(kernel, eps=eps), inputs, scope, shape, dtype, threads, progress)
    status = raw[0]
    refused = int(np.count_nonzero(status > codes.ENERGY_GAIN))
    if refused:
        if on_failure == "raise":
            raise _first_refusal(solver, asked, status)
        _warn_of_refusals(status, refused)
    gaining = status == codes.ENERGY_GAIN
    if gaining.any():
        most = float(-raw[codes.OUTPUTS.index("energy_loss")][gaining].min())
        _warn_of_gain(f"{int(gaining.sum())} of {status.size} cases gain energy, up to {most:.6g} J", most)
    return build(asked, raw)


def _values(asked: Asked) -> list[tuple[str, Any]]:
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


def _shape(asked: Asked) -> tuple[int, ...] | None:
    """The shape all arrays broadcast to; None when there is none, so that the case is a single one."""
    arrays = [(name, value) for name, value in _values(asked) if isinstance(value, np.ndarray)]
    if not arrays:
        return None
    try:
        return np.broadcast_shapes(*(value.shape for _, value in arrays))
    except ValueError:
        shapes = ", ".join(f"{name} {value.shape}" for name, value in arrays)
        raise ShapeError(f"these arrays do not broadcast together: {shapes}", code="bad_shape") from None


def _value_checks(asked: Asked) -> list[Check]:
    """What the door checks of scalars, for the arrays of the question."""
    found: list[Check] = []
    for label, value in _values(asked):
        if not isinstance(value, np.ndarray):
            continue
        if label == "restitution":
            found.append((codes.BAD_RESTITUTION, checks.outside_unit_interval, (value,)))
        elif label == asked.rule:
            code, condition = _BOUND_CHECKS[asked.rule]
            found.append((code, condition, (value,)))
        else:
            domain = DOMAINS.get(label.partition(".")[2], FINITE)
            found += [(code, condition, (value,)) for code, condition in _VALUE_CHECKS[domain]]
    if any(isinstance(part, np.ndarray) for part in asked.normal):
        found.append((codes.ZERO_NORMAL, checks.without_length, asked.normal))
    for vehicle in (asked.a, asked.b):
        if vehicle.pivot is not None:
            found.append((codes.PINNED_INFINITE, checks.either_infinite, (vehicle.mass, vehicle.yaw_inertia)))
            motion = (vehicle.vx, vehicle.vy, vehicle.yaw_rate, vehicle.x, vehicle.y)
            found.append((codes.PINNED_VELOCITY, checks.not_about_pivot, (*motion, *vehicle.pivot)))
    return found


def _first_refusal(solver: Callable[..., Impact], asked: Asked, status: Any) -> CollisionsError:
    """The error of the first refused case, found by asking for it alone."""
    index = tuple(int(i) for i in np.argwhere(status > codes.ENERGY_GAIN)[0])
    place = f"case {index if len(index) != 1 else index[0]}: "

    def lane(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(lane(part) for part in value)
        return float(np.broadcast_to(value, status.shape)[index]) if isinstance(value, np.ndarray) else value

    try:
        one = asked._replace(
            **{name: lane(getattr(asked, name)) for name in ("restitution", "normal", "bound", "point")},
            **{side: vehicle.replace(**{n: lane(getattr(vehicle, n)) for n in (*DOMAINS, "pivot")})
               for side, vehicle in (("a", asked.a), ("b", asked.b))},
        )  # fmt: skip
        ask(solver, one)
    except CollisionsError as error:
        return type(error)(place + str(error), code=error.code, **error.fields)
    outcome = Status(status[index])
    return InputError(place + outcome.sentence, code=outcome.label)


def _warn_of_refusals(status: Any, refused: int) -> None:
    kinds = {Status(int(code)).label: int(np.count_nonzero(status == code)) for code in np.unique(status[status > codes.ENERGY_GAIN])}
    listed = ", ".join(f"{count} {label}" for label, count in kinds.items())
    warnings.warn(
        CollisionsWarning(
            f"{refused} of {status.size} cases were refused and are NaN ({listed}); see .status, or on_failure='raise'",
            code="refused_cases",
            counts=kinds,
        ),
        stacklevel=callers_level(),
    )


def _warn_of_gain(what: str, gain: float) -> None:
    warnings.warn(
        EnergyGainWarning(
            f"{what}: this restitution and tangential impulse cannot occur together without a source of energy; lower the "
            f"restitution or the ratio, or take law='kudlich-slibar' with friction=",
            code="energy_gain",
            gain=gain,
        ),
        stacklevel=callers_level(),
    )


def _check_options(on_failure: Any, threads: Any, progress: Any) -> None:
    if on_failure not in (None, "raise", "nan"):
        raise InputError(
            f"on_failure must be None, 'raise' or 'nan', got {on_failure!r}", code="bad_option", argument="on_failure"
        )
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
        raise InputError(f"threads must be a whole number from 1, got {threads!r}", code="bad_option", argument="threads")
    if progress is not None and not callable(progress):
        raise InputError(
            f"progress must be a function of (done, total), got {type(progress).__name__}", code="bad_option", argument="progress"
        )
