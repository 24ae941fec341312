"""The least model that a scene requires, and its answer: linear central, oblique central or eccentric."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .amounts import amount
from .arguments import Law, OnFailure, answer, concluded, numbers_of, read, solved
from .eccentric import body_numbers, lacking, missing_numbers
from .fields import lock, numeric
from .impact import SOLVERS, Asked, Impact
from .kernels import codes
from .kernels.eccentric import eccentric as eccentric_kernel
from .kernels.linear import linear_central as linear_kernel
from .kernels.oblique import oblique_central as oblique_kernel
from .kernels.select import select
from .kernels.shortfall import shortfalls_of
from .progress import Progress
from .provenance import MODELS, ModelChoice
from .units import Door, Input, Pair, broadcast
from .vehicle import Vehicle

_LINEAR, _OBLIQUE, _ECCENTRIC = MODELS
# What a predicted error counts for, so that an answer stays within the tolerance where a prediction falls short.
_MARGIN = 1.15


def required_model(
    a: Vehicle,
    b: Vehicle,
    restitution: Input,
    *,
    normal: Input | Pair,
    point: Pair | None,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: Law = "brach",
    tolerance: Input = 0.0,
) -> ModelChoice:
    """The least model whose answer stays within a tolerance of the eccentric one.

    Candidates are the linear central model (which carries through what moves across the normal), the oblique central model and
    the eccentric one. The error of a candidate is, for the worse of both vehicles, hypot of the error of its delta-V vector and
    of radius of gyration times the error of its change of yaw rate. It is worked out from the impulse at the contact, without
    the rest of the eccentric answer, and a candidate is taken if 1.15 times its error is within the tolerance. What a lever
    does depends on yaw inertia, position and point; where one is not known, and a lever may matter, so is the error.

    Parameters
    ----------
    a, b, restitution, normal, point, friction, impulse_ratio, critical_fraction, law
        As for ``eccentric``; yaw inertias, positions and the point may be left None.
    tolerance : float, str, Quantity or array [m/s]
        Largest error that is accepted, >= 0; 0 is always the eccentric model.

    Returns
    -------
    ModelChoice
        The model, the reason in a sentence, the error of each cheaper model, and what each model still needs.

    Raises
    ------
    InputError
        An argument that cannot be used.

    Examples
    --------
    A rear-end impact 0.4 m off the line of both centres. A delta-V alone would not show what the lever does:

    >>> import collisions as col
    >>> a = col.Vehicle(mass=1500, vx=10.0, yaw_inertia=2400, x=-2.0, y=0.4)
    >>> b = col.Vehicle(mass=1200, yaw_inertia=1700, x=2.0, y=0.0)
    >>> choice = col.required_model(a, b, 0.2, normal=0.0, point=(0.0, 0.4), friction=0.0, tolerance=0.5)
    >>> choice.model, round(choice.errors["linear_central"], 2)
    ('eccentric', 2.14)
    """
    question = _read(a, b, restitution, normal, point, friction, impulse_ratio, critical_fraction, law, tolerance)
    return _chosen(question)[0]


def solve(
    a: Vehicle,
    b: Vehicle,
    restitution: Input,
    *,
    normal: Input | Pair,
    point: Pair | None,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: Law = "brach",
    tolerance: Input = 0.0,
    on_failure: OnFailure | None = None,
    threads: int = 1,
    progress: Progress | None = None,
) -> Impact:
    """Solve an impact with the least model that stays within a tolerance of the eccentric one.

    The model is chosen by ``required_model``, in a batch for every case by itself, and each case is solved by its model.

    Parameters
    ----------
    a, b, restitution, normal, point, friction, impulse_ratio, critical_fraction, law, on_failure, threads, progress
        As for ``eccentric``; what the required model does not need may be left None.
    tolerance : float, str, Quantity or array [m/s]
        Largest error that is accepted, as for ``required_model``.

    Returns
    -------
    Impact
        With the model used in ``model`` and how it was chosen in ``choice``.

    Raises
    ------
    InputError, NoImpactError, NoSolutionError
        As for ``eccentric``; MissingInputError if a required model lacks something.

    Examples
    --------
    Square from behind, along the line of both centres: nobody needs a yaw inertia for that.

    >>> import collisions as col
    >>> a, b = col.Vehicle(mass=1500, vx=10.0, x=-2.0, y=0.0), col.Vehicle(mass=1200, x=2.0, y=0.0)
    >>> impact = col.solve(a, b, 0.2, normal=0.0, point=(0.0, 0.0), friction=0.5, tolerance="0.1 km/h")
    >>> impact.model, round(impact.b.delta_v, 3)
    ('linear_central', 6.667)
    """
    question = _read(a, b, restitution, normal, point, friction, impulse_ratio, critical_fraction, law, tolerance)
    choice, which = _chosen(question)
    if question.missing and np.any(np.equal(which, MODELS.index(_ECCENTRIC))):
        door = Door()
        door.problems.extend(missing_numbers(a, b, point))
        door.close()
    asked = question.asked
    if isinstance(choice.model, str):
        kernel, inputs, settings = _kernel(choice.model, asked)
        impact = answer(kernel, inputs, settings, tuple(asked), question.plain, None, on_failure, threads, progress)
    else:
        impact = concluded(asked, _solved_by_model(asked, which, threads, progress), on_failure)
    impact._cache["choice"] = choice
    return impact


SOLVERS["solve"] = solve


class _Question(NamedTuple):
    """What was asked, what is accepted, and what the eccentric model would lack."""

    asked: Asked
    tolerance: Any
    missing: tuple[str, ...]
    plain: bool


def _read(
    a: Any,
    b: Any,
    restitution: Any,
    normal: Any,
    point: Any,
    friction: Any,
    impulse_ratio: Any,
    critical_fraction: Any,
    law: Any,
    tolerance: Any,
) -> _Question:
    door = Door()
    limit = amount(door, tolerance, "m/s", "tolerance")
    e, n, rule, bound, contact, plain = read(
        a, b, restitution, normal, point, friction, impulse_ratio, critical_fraction, law, door.problems
    )
    missing = [f"{label}.{name}" for label, name in lacking(a, b)] + (["point"] if contact is None else [])
    return _Question(Asked("solve", a, b, e, n, rule, bound, law, contact), limit, tuple(missing), plain)


def _kernel(model: str, asked: Asked) -> tuple[Any, tuple[Any, ...], tuple[Any, ...]]:
    """The kernel of a model, its inputs and its settings; motion that a central model cannot hold is carried through."""
    a, b, e, n, bound = asked.a, asked.b, asked.restitution, asked.normal, asked.bound
    if model == _ECCENTRIC:
        bodies = (*body_numbers(a, asked.point), *body_numbers(b, asked.point))
        pinned = a.pivot is not None, b.pivot is not None
        return eccentric_kernel, (e, *n, bound, *(asked.point or ()), *bodies), (asked.rule, asked.law, *pinned)
    velocities = (a.mass, a.vx, a.vy, b.mass, b.vx, b.vy)
    if model == _OBLIQUE:
        return oblique_kernel, (e, *n, bound, *velocities), (asked.rule, asked.law)
    return linear_kernel, (e, *n, *velocities), ()


def _chosen(question: _Question) -> tuple[ModelChoice, Any]:
    """The choice, and which of ``MODELS`` it is, by number."""
    asked, tolerance = question.asked, question.tolerance
    shape = broadcast({"tolerance": tolerance, **dict(numbers_of(asked))})
    with np.errstate(all="ignore"):
        errors = _errors(asked)
        which: Any = MODELS.index(_ECCENTRIC)
        for name in (_OBLIQUE, _LINEAR):
            which = select((_MARGIN * errors[name] <= tolerance) & (tolerance > 0.0), MODELS.index(name), which)
    if shape is not None:
        which = np.broadcast_to(np.asarray(which, dtype=np.uint8), shape)
        errors = {name: lock(np.array(np.broadcast_to(error, shape))) for name, error in errors.items()}
    choice = ModelChoice(
        model=MODELS[which] if shape is None else lock(np.array(MODELS).take(which)),
        reason=_reason(which, errors, question),
        errors=errors,
        missing={_LINEAR: (), _OBLIQUE: (), _ECCENTRIC: question.missing},
        tolerance=tolerance,
    )
    return choice, which


def _errors(asked: Asked) -> dict[str, Any]:
    """What the central models err by; NaN where a lever or a yaw inertia that is not known would tell."""
    bodies = (asked.a, asked.b)
    if any(body.pivot is not None for body in bodies):
        return {_LINEAR: math.inf, _OBLIQUE: math.inf}
    contact = asked.point or (0.0, 0.0)
    numbers: list[Any] = [asked.restitution, *asked.normal, asked.bound, *contact]
    for body in bodies:
        placed = asked.point is not None and body.x is not None and body.y is not None
        place = (body.x, body.y) if placed else contact
        inertia = math.inf if body.yaw_inertia is None else body.yaw_inertia
        numbers += [body.mass, inertia, body.vx, body.vy, body.yaw_rate, *place, 0.0, 0.0]
    linear, oblique, *torques = _shortfalls(asked, numbers)
    unknown: Any = False
    for body, torque in zip(bodies, torques, strict=True):
        if asked.point is None or body.x is None or body.y is None:
            # Without a place the lever is open; it does not matter to a body that cannot turn.
            inertia = math.inf if body.yaw_inertia is None else body.yaw_inertia
            turns: Any = True if body.yaw_inertia is None else np.isfinite(inertia)
            fixed = np.isinf(body.mass) & np.isinf(inertia)
            moves = np.not_equal(body.yaw_rate, 0.0)
            unknown = unknown | ((turns | moves) & np.logical_not(fixed & np.logical_not(moves)))
        elif body.yaw_inertia is None:
            # No torque on a body that could not turn: none on one that can.
            unknown = unknown | np.not_equal(torque, 0.0)
    if isinstance(linear, float) and isinstance(oblique, float) and np.ndim(unknown) == 0:
        return {_LINEAR: math.nan, _OBLIQUE: math.nan} if unknown else {_LINEAR: linear, _OBLIQUE: oblique}
    return {name: select(unknown, np.nan, error) for name, error in ((_LINEAR, linear), (_OBLIQUE, oblique))}


def _shortfalls(asked: Asked, numbers: list[Any]) -> Any:
    """What the kernel says of one case, or of many in blocks; torques only where something follows from them."""
    settings = asked.rule, asked.law or ""
    if numeric(*numbers) is math:
        return shortfalls_of(*numbers, *settings)
    from .kernels.batch import precision, work_out

    wanted = True, True, asked.a.yaw_inertia is None, asked.b.yaw_inertia is None
    shape = np.broadcast_shapes(*map(np.shape, numbers))
    return work_out(shortfalls_of, settings, numbers, wanted, shape, precision(numbers))


def _reason(which: Any, errors: dict[str, Any], question: _Question) -> str:
    """Why, in a sentence."""
    tolerance = question.tolerance
    if not isinstance(which, int):
        counts = ((name, int(np.count_nonzero(which == at))) for at, name in enumerate(MODELS))
        listed = ", ".join(f"{count} {name}" for name, count in counts if count)
        return f"of {which.size} cases {listed or 'none'}: each the least within its tolerance"
    model, cheaper = MODELS[which], MODELS[:which]
    told = [f"{name} would err by {errors[name]:.3g} m/s" for name in cheaper]
    if model != _ECCENTRIC:
        others = f"; {told[0]}" if told else ""
        return f"{model}: it errs by {errors[model]:.3g} m/s, and {tolerance:.3g} m/s are accepted{others}"
    if tolerance == 0.0:
        return f"{model}: a tolerance of 0 asks for the full model"
    if question.asked.a.pivot is not None or question.asked.b.pivot is not None:
        return f"{model}: a body that turns about a pivot is beyond the central models"
    if math.isnan(errors[_OBLIQUE]) and question.missing:
        return f"{model}: without {', '.join(question.missing)} nothing tells what a central model would err by"
    if math.isnan(errors[_OBLIQUE]):
        return f"{model}: there is no answer that a cheaper one could come near to"
    return f"{model}: {told[1]}, and {tolerance:.3g} m/s are accepted"


def _solved_by_model(asked: Asked, which: Any, threads: int, progress: Any) -> Any:
    """The outputs of a batch, every case worked out by its own model."""
    places = [np.flatnonzero(which == at) for at in range(len(MODELS))]
    for name, lanes in zip(MODELS, places, strict=True):
        if lanes.size == which.size and (lanes.size or name == _ECCENTRIC):
            return solved(*_kernel(name, asked), asked, None, which.shape, threads, progress)
    from .kernels.batch import FIRST, Answers

    def joined(names: Sequence[str], progress: Any = None) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for name, lanes in zip(MODELS, places, strict=True):
            if lanes.size:
                part = solved(*_kernel(name, asked), asked, None, which.shape, threads, progress, lanes)
                for output in names:
                    answers = part[codes.AT[output]]
                    found.setdefault(output, np.empty(which.shape, dtype=answers.dtype)).flat[lanes] = answers
        lock(found)
        return found

    return Answers(joined, joined(FIRST, progress))
