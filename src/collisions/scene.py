"""The least model that a scene requires, and its answer: linear central, oblique central or eccentric."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from .amounts import amount
from .answering import answer, concluded, numbers_of, solved, value_checks
from .arguments import Law, OnFailure, check_options, read
from .door import Door, broadcast
from .eccentric import body_numbers, lacking, missing_numbers
from .errors import InputError
from .impact import SOLVERS, Asked, Impact
from .kernels import codes
from .kernels.eccentric import eccentric as eccentric_kernel
from .kernels.oblique import oblique_central as oblique_kernel
from .kernels.shortfall import ECCENTRIC, LACKING, LINEAR, Known, least_model, linear_carried
from .progress import Progress, halves, reporter
from .provenance import MODELS, Again, ModelChoice
from .units import Input, Pair
from .vehicle import Vehicle

_LINEAR, _OBLIQUE, _ECCENTRIC = MODELS


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
    does depends on yaw inertia, position and point; where one is not known, and a lever may matter, so is the error. A lever
    of 16 eps of the coordinates, and of 0.1 mm at most, is rounding, and does not matter.

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
    return _chosen(question, 1, None)[0]


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

    The model is chosen by ``required_model``, in a batch for every case by itself, and each case is solved by its model. What
    that model cannot hold, such as spin or motion across the normal, is carried through. Bodies that are known not to approach
    are refused whatever else is missing.

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
        As for ``eccentric``; MissingInputError if a required model lacks something, in a batch for the first such case.

    Examples
    --------
    Square from behind, along the line of both centres: nobody needs a yaw inertia for that.

    >>> import collisions as col
    >>> a, b = col.Vehicle(mass=1500, vx=10.0, x=-2.0, y=0.0), col.Vehicle(mass=1200, x=2.0, y=0.0)
    >>> impact = col.solve(a, b, 0.2, normal=0.0, point=(0.0, 0.0), friction=0.5, tolerance="0.1 km/h")
    >>> impact.model, round(impact.b.delta_v, 3)
    ('linear_central', 6.667)
    """
    check_options(on_failure, threads, progress)
    question = _read(a, b, restitution, normal, point, friction, impulse_ratio, critical_fraction, law, tolerance)
    asked, choice = question.asked, question.given
    report = reporter(progress)
    if choice is None:
        predicting, report = halves(report)
        choice, which, lacks = _chosen(question, threads, predicting)
        if np.any(lacks):
            _refuse_without(a, b, point, lacks)
    else:
        choice = _taken_again(choice, asked)
        which = choice._which
    if isinstance(which, np.ndarray):
        impact = concluded(asked, _solved_by_model(asked, which, threads, report), on_failure, choice)
    else:
        model = _model(which, asked)
        impact = answer(*model, tuple(asked), question.plain, None, on_failure, threads, report)
        impact._cache["choice"] = choice._where_answered(impact.refused)
    return impact


SOLVERS["solve"] = solve


class _Question(NamedTuple):
    """What was asked, what is accepted (or which choice is to be taken again), and what the eccentric model would lack."""

    asked: Asked
    tolerance: Any
    given: ModelChoice | None
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
    given = tolerance.choice if isinstance(tolerance, Again) else None
    limit = amount(door, tolerance, "m/s", "tolerance") if given is None else given.tolerance
    if isinstance(limit, np.ndarray) and limit.size and not (limit.min() >= 0.0 and limit.max() < math.inf):
        _refuse_first(door, limit)
    e, n, rule, bound, contact, plain, texts = read(
        a, b, restitution, normal, point, friction, impulse_ratio, critical_fraction, law, door.problems
    )
    missing = [f"{label}.{name}" for label, name in lacking(a, b)] + (["point"] if contact is None else [])
    return _Question(Asked("solve", a, b, e, n, rule, bound, law, contact, texts), limit, given, tuple(missing), plain)


def _refuse_first(door: Door, tolerances: Any) -> None:
    """Refuses the first of these that would be refused alone."""
    at = tuple(int(i) for i in np.argwhere(~np.isfinite(tolerances) | (tolerances < 0.0))[0])
    value, place = float(tolerances[at]), at[0] if len(at) == 1 else at
    code = "negative_speed" if math.isfinite(value) else "not_finite"
    text = f"tolerance must be finite and >= 0 in every case, got {value:g} in case {place}; 0 asks for the full model"
    door.refuse(InputError(text, code=code, argument="tolerance"))


def _refuse_without(a: Vehicle, b: Vehicle, point: Any, lacks: Any) -> None:
    """Names all that is missing, in a batch for the first case that needs it."""
    place = ""
    if isinstance(lacks, np.ndarray):
        at = tuple(int(i) for i in np.unravel_index(int(np.argmax(lacks)), lacks.shape))
        place = f"case {at if len(at) != 1 else at[0]}: "
    door = Door()
    for error in missing_numbers(a, b, point):
        door.problems.append(type(error)(place + str(error), code=error.code, **error.fields))
    door.close()


def _model(which: int, asked: Asked) -> tuple[Any, tuple[Any, ...], tuple[Any, ...]]:
    """The kernel of a model, its inputs and its settings; motion that a central model cannot hold is carried through."""
    a, b, e, n, bound = asked.a, asked.b, asked.restitution, asked.normal, asked.bound
    if which == ECCENTRIC:
        pinned = a.pivot is not None, b.pivot is not None
        return eccentric_kernel, (e, *n, bound, *_contact_numbers(asked)), (asked.rule, asked.law, *pinned)
    velocities = (a.mass, a.vx, a.vy, b.mass, b.vx, b.vy)
    if which == LINEAR:
        return linear_carried, (e, *n, *velocities), ()
    return oblique_kernel, (e, *n, bound, *velocities), (asked.rule, asked.law)


def _contact_numbers(asked: Asked) -> tuple[Any, ...]:
    """Point and bodies; what is not known is filled in so that it makes no torque."""
    contact = asked.point or (0.0, 0.0)
    numbers: list[Any] = [*contact]
    for body in (asked.a, asked.b):
        mass, inertia, vx, vy, spin, x, y, *pivot = body_numbers(body, contact)
        if asked.point is None:
            x, y = contact
        numbers += [mass, math.inf if inertia is None else inertia, vx, vy, spin, x, y, *pivot]
    return tuple(numbers)


def _chosen(question: _Question, threads: int, progress: Any) -> tuple[ModelChoice, Any, Any]:
    """The choice, which of ``MODELS`` it is, by number, and whether that lacks something."""
    asked, tolerance = question.asked, question.tolerance
    shape = broadcast({"tolerance": tolerance, **dict(numbers_of(asked))})
    which, linear, oblique = _predicted(question, shape, threads, progress)
    lacks = which == LACKING
    if shape is None:
        which = min(which, ECCENTRIC)
    else:
        np.minimum(which, ECCENTRIC, out=which)
    choice = ModelChoice(
        reason=_reason(which, linear, oblique, lacks, question),
        errors={_LINEAR: linear, _OBLIQUE: oblique},
        missing={_LINEAR: (), _OBLIQUE: (), _ECCENTRIC: question.missing},
        tolerance=tolerance,
        _which=which,
    )
    return choice, which, lacks


def _predicted(question: _Question, shape: tuple[int, ...] | None, threads: int, progress: Any) -> tuple[Any, Any, Any]:
    """Which model by number, and the errors of the central ones; infinite beside a pivot, which they cannot hold."""
    asked = question.asked
    pinned = asked.a.pivot is not None, asked.b.pivot is not None
    known = Known(
        places=(
            asked.point is not None and asked.a.x is not None and asked.a.y is not None,
            asked.point is not None and asked.b.x is not None and asked.b.y is not None,
        ),
        inertias=(asked.a.yaw_inertia is not None, asked.b.yaw_inertia is not None),
        all=not question.missing,
        pinned=pinned,
    )
    inputs = (asked.restitution, *asked.normal, asked.bound, *_contact_numbers(asked), question.tolerance)
    if shape is None:
        return least_model(*inputs, asked.rule, asked.law, known, codes.EPS)
    # As for batches of one model: single cases never come here.
    from .kernels.mixed import least_models

    dtype = _precision(question)
    eps = float(np.finfo(dtype).eps)
    settings = asked.rule, asked.law, known, eps
    # What is beyond float32 accepts every error that a float32 can have.
    most = float(np.finfo(dtype).max)
    tolerance = question.tolerance
    tolerance = np.minimum(tolerance, most) if isinstance(tolerance, np.ndarray) else min(tolerance, most)
    return least_models(settings, (*inputs[:-1], tolerance), value_checks(asked, eps), shape, dtype, threads, progress)


def _precision(question: _Question) -> Any:
    """What a batch is worked out in."""
    from .kernels.batch import precision

    return precision(value for _, value in numbers_of(question.asked))


def _taken_again(choice: ModelChoice, asked: Asked) -> ModelChoice:
    """The choice for some cases of a batch, or for one of them, with a reason that is about these."""
    which, errors, missing = choice._which, choice.errors, choice.missing[_ECCENTRIC]
    question = _Question(asked, choice.tolerance, choice, missing, False)
    reason = _reason(which, errors[_LINEAR], errors[_OBLIQUE], bool(missing), question)
    return ModelChoice(reason=reason, errors=errors, missing=choice.missing, tolerance=choice.tolerance, _which=which)


def _reason(which: Any, linear: Any, oblique: Any, lacks: Any, question: _Question) -> str:
    """Why, in a sentence."""
    tolerance = question.tolerance
    if not isinstance(which, int):
        counts = ((name, int(np.count_nonzero(which == at))) for at, name in enumerate(MODELS))
        listed = ", ".join(f"{count} {name}" for name, count in counts if count)
        return f"of {which.size} cases {listed or 'none'}: each the least within its tolerance"
    model, errors = MODELS[which], (linear, oblique)
    told = [
        f"{name} has no answer" if error == math.inf else f"{name} would err by {error:.3g} m/s"
        for name, error in zip(MODELS[:which], errors, strict=False)
    ]
    if which != ECCENTRIC:
        others = f"; {told[0]}" if told else ""
        return f"{model}: it errs by {errors[which]:.3g} m/s, and {tolerance:.3g} m/s are accepted{others}"
    if tolerance == 0.0:
        return f"{model}: a tolerance of 0 asks for the full model"
    if question.asked.a.pivot is not None or question.asked.b.pivot is not None:
        return f"{model}: a body that turns about a pivot is beyond the central models"
    if math.isnan(oblique) and lacks:
        return f"{model}: without {', '.join(question.missing)} nothing tells what a central model would err by"
    if math.isnan(oblique):
        return f"{model}: there is no answer that a cheaper one could come near to"
    accepted = "" if math.isinf(oblique) else f", and {tolerance:.3g} m/s are accepted"
    return f"{model}: {told[1]}{accepted}"


def _solved_by_model(asked: Asked, which: Any, threads: int, progress: Any) -> Any:
    """The outputs of a batch, every case worked out by its own model."""
    shape = broadcast({"which": which, **dict(numbers_of(asked))}) or ()
    for at in range(len(MODELS)):
        if np.all(which == at):
            return solved(*_model(at, asked), asked, None, shape, threads, progress)
    from .kernels.batch import precision
    from .kernels.mixed import Model, solve_mixed

    dtype = precision(value for _, value in numbers_of(asked))
    eps = float(np.finfo(dtype).eps)
    models = []
    for at in range(len(MODELS)):
        kernel, inputs, settings = _model(at, asked)
        models.append(Model(kernel, (*settings, eps), inputs))
    return solve_mixed(models, which, value_checks(asked, eps), shape, dtype, threads, progress)
