"""``solve_with_simplest`` and ``ModelChoice``: the simplest model that a scene allows within a
tolerance, and the reason.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any, cast

import numpy as np

from ..engine.flattening import flattened, form_of, numbers_of
from ..engine.floats import compile_for_floats
from ..kernels.contact_laws import BRACH, FRICTION, LAWS
from ..kernels.elementwise import larger, select
from ..kernels.model_error import ECCENTRIC, LACKING, Known, least_model
from ..kernels.status import EPS, Passed, Status, WithTyres
from ..messages.errors import InputError, placed
from ..messages.progress import halves, reporter
from ..messages.warning import quietly
from ..quantities.attributes import Shown, derived, equal, math_or_numpy, read_only
from ..quantities.formatting import Numbers
from ..quantities.reading import ArgumentReader, broadcast
from ..quantities.tables import Cells, Summary, all_numbers, sided
from ..quantities.units import Value, to_quantity
from .inputs import (
    OUTSIDE,
    Inputs,
    ModelName,
    errors_of_missing,
    first_case,
    missing_inputs,
    named_numbers,
    part_of,
    part_of_inputs,
)
from .models import CANDIDATES, TIME_RESOLVED, model_of, paths_of, read_again, variant_of
from .models import ECCENTRIC as FULL
from .run import cases_of, check_options, raise_or_warn, solve_cases, solve_inputs
from .time_resolved_inputs import timed

_NAMES = (*(model.name for model in CANDIDATES), TIME_RESOLVED.name)
_LINEAR, _OBLIQUE, _ECCENTRIC, _IN_TIME = _NAMES
# The number of the model that takes time, and the steps in which it is followed to tell what the
# others leave out.
_LAST, _ROUGH = len(CANDIDATES), 25
# Safety factor on an error against that.
_MARGIN = 1.15
_SI = Numbers("si")
# How what a model does not take is said: as beyond it, and after "takes no".
_SAID = {
    "pivot": ("a body that turns about a pivot", "body with a pivot"),
    "outside": ("an impulse from outside", "impulse from outside"),
    "tyres": ("what tyres do during the contact", "tyres"),
}


class ByModel(Mapping[str, Any]):
    """A read-only dict by model name; ``.q`` has the numbers as Quantities."""

    __slots__ = ("_unit", "_values")

    def __init__(self, values: Mapping[str, Any], unit: str | None = None) -> None:
        self._values = read_only(dict(values))
        self._unit = unit

    @property
    def q(self) -> Any:
        """The same with units."""
        return (
            self
            if self._unit is None
            else {name: to_quantity(value, self._unit) for name, value in self.items()}
        )

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mapping):
            return NotImplemented
        return equal(self, other)

    def __reduce__(self) -> tuple[Any, ...]:
        return ByModel, (self._values, self._unit)

    def __repr__(self) -> str:
        return repr(self._values)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ModelChoice(Shown):
    """Which model a scene requires, and why.

    Attributes
    ----------
    model : str or array of str
        "linear_central", "oblique_central", "eccentric" or, with a duration, "time_resolved"; for a
        refused case "eccentric".
    tolerance : float or array [m/s]
        Largest error that was accepted.
    """

    _title = "Model required"

    tolerance: Value = field(metadata={"unit": "m/s"})
    # The number of the model chosen, the errors of the central ones, and what the eccentric one
    # lacks.
    _which: Any
    _predicted: tuple[Any, ...]
    _missing: tuple[str, ...]
    # Whether that lack left the errors unknown, what no central model can hold, and which cases
    # were refused.
    _lacks: bool
    _beyond: str
    _refused: Any = False
    # Where the errors are those against a contact that takes time; and why it is no candidate.
    _timed: Any = False
    _untimed: str = ""

    def __post_init__(self) -> None:
        if isinstance(self._which, np.ndarray):
            read_only((self._which, self._predicted, self._refused, self._timed))

    @property
    def model(self) -> ModelName:
        """The name, or the names of a batch, made from the numbers that are kept, as names take
        fifty times the room.
        """
        which = self._which
        found = (
            read_only(np.array(_NAMES).take(which))
            if isinstance(which, np.ndarray)
            else _NAMES[which]
        )
        return cast(ModelName, found)

    @derived()
    def reason(self) -> str:
        """Why, in a sentence, its speeds in m/s; ``summary`` says it in other units."""
        return _reason(self)

    def _reason_in(self, numbers: Numbers) -> str:
        """The reason, its speeds in these units."""
        return _reason(self, numbers)

    @property
    def _keeps_all(self) -> bool:
        """Whether a single case has the fullest of the models that it was chosen from."""
        return bool(self._which == (_LAST if self._timed else ECCENTRIC))

    @derived()
    def errors(self) -> Mapping[str, Value]:
        """Predicted error [m/s] of each cheaper model, by its name.

        It is the hypotenuse of the error of the delta-V vector and of the radius of gyration times
        that of the change of yaw rate, for the vehicle for which it is larger. NaN where it cannot
        be estimated or the case is refused; infinite where only that model has no answer.
        """
        answered = (
            error if self._refused is False else select(self._refused, math.nan, error)
            for error in self._predicted
        )
        return ByModel(dict(zip(_NAMES, answered, strict=False)), "m/s")

    @derived()
    def missing(self) -> Mapping[str, tuple[str, ...]]:
        """What each model still needs, by its name, such as "a.yaw_inertia" or "point"."""
        last = {_IN_TIME: self._missing} if len(self._predicted) == _LAST else {}
        return ByModel({_LINEAR: (), _OBLIQUE: (), _ECCENTRIC: self._missing, **last})

    def _summary(self, numbers: Cells) -> Summary:
        values = (
            (name, self._reason_in(numbers) if name == "reason" else value, unit)
            for name, value, unit in self._values()
        )
        return Summary(self._title, [*sided(values, numbers), all_numbers(self._rows())])

    def _values(self, prefix: str = "") -> Iterator[tuple[str, Any, str | None]]:
        yield prefix + "model", self.model, None
        yield prefix + "reason", self.reason, None
        yield from ((f"{prefix}errors.{name}", error, "m/s") for name, error in self.errors.items())
        yield from (
            (f"{prefix}missing.{name}", ", ".join(needed), None)
            for name, needed in self.missing.items()
            if needed
        )
        yield prefix + "tolerance", self.tolerance, "m/s"


def choose(inputs: Inputs, threads: int = 1, progress: Any = None) -> tuple[ModelChoice, Any]:
    """Choose a model; also gives where the eccentric one is required and lacks an input."""
    a, b = inputs.a, inputs.b
    tolerance: Any = inputs.tolerance
    shape = (
        inputs.shape
        if isinstance(tolerance, float)
        else broadcast({"tolerance": tolerance, **named_numbers(inputs)})
    )
    missing = tuple(f"{label}.{name}" for label, name in missing_inputs(a, b))
    missing += () if inputs.point is not None else ("point",)
    # Both central models take the same forces and bodies, and the eccentric one all that they do.
    beyond = CANDIDATES[0].beyond(inputs)
    if beyond and (nobody := FULL.beyond(inputs)):
        text = f"no model that solve chooses from takes {' and '.join(nobody)}; leave it out"
        raise InputError(text, code="bad_combination", argument=nobody[0])
    which, *predicted = _predicted(inputs, missing, not beyond, shape, threads, progress)
    lacks = which == LACKING
    choice = ModelChoice(
        tolerance=tolerance,
        _which=min(which, ECCENTRIC) if shape is None else np.minimum(which, ECCENTRIC, out=which),
        _predicted=(predicted[0], predicted[1]),
        _missing=missing,
        _lacks=bool(np.any(lacks)) if shape else lacks,
        _beyond=_said(beyond[0])[0] if beyond else "",
    )
    return (choice, lacks) if inputs.duration is None else _with_time(inputs, choice, lacks)


def _said(name: str) -> tuple[str, str]:
    """How an input that a model does not take is said."""
    return _SAID.get(name.removesuffix("_a").removesuffix("_b"), (name, name))


def _with_time(inputs: Inputs, choice: ModelChoice, lacks: Any) -> tuple[ModelChoice, Any]:
    """The choice with a contact that takes time as the last candidate, and the errors of the others
    against it.
    """
    why = ""
    if inputs.rule != FRICTION:
        why = f"{_IN_TIME} takes friction, and {inputs.rule} was given"
    elif inputs.law != BRACH:
        why = f"{_IN_TIME} has a law of its own, and {inputs.law} was given"
    elif too_much := TIME_RESOLVED.beyond(inputs):
        why = f"{_IN_TIME} takes no {_said(too_much[0])[1]}"
    elif np.any(np.less(inputs.restitution, 0.0)):
        why = f"{_IN_TIME} takes no incomplete impact"
    elif np.all(lacks):
        why = f"{_IN_TIME} needs {', '.join(choice._missing)}"
    if why:
        return replace(choice, _untimed=why), lacks
    with quietly():
        rough = solve_inputs(TIME_RESOLVED, timed(inputs, _ROUGH), on_failure="nan")
        answers = [solve_inputs(model, inputs, on_failure="nan") for model in CANDIDATES]
    with np.errstate(all="ignore"):
        errors = tuple(_apart(inputs, answer, rough) for answer in answers)
        # Followed roughly it may have no answer where in more steps it has one; then nothing is
        # known of the others.
        steps = (rough.status == Status.NO_START) | (rough.status == Status.COARSE_STEPS)
        unsure = steps | (rough.status == Status.ENDLESS_CONTACT)
        answered = ((rough.status <= Status.ENERGY_GAIN) | unsure) & (lacks ^ True)
        tolerance: Any = inputs.tolerance
        which: Any = _LAST
        for number, error in reversed(tuple(enumerate(errors))):
            which = select((tolerance > 0.0) & (_MARGIN * error <= tolerance), number, which)
        which = select(answered, select(unsure, _LAST, which), choice._which)
        errors = tuple(select(unsure, math.nan, error) for error in errors)
        # Where it has no answer the errors are those of the central models, against the eccentric
        # one.
        known = (*choice._predicted, math.nan)
        errors = tuple(select(answered, new, old) for new, old in zip(errors, known, strict=True))
    if isinstance(choice._which, np.ndarray):
        shape = choice._which.shape
        which, *errors_of = (np.broadcast_to(one, shape).copy() for one in (which, *errors))
        which, errors = which.astype(np.uint8), tuple(errors_of)
    unknown = (which == _LAST) if choice._missing else False
    untimed = (
        ""
        if answered is not False
        else f"{_IN_TIME} has no answer: {Status(rough.status).sentence}"
    )
    beyond = "" if answered is not False else choice._beyond
    return replace(
        choice, _beyond=beyond, _which=which, _predicted=errors, _timed=answered, _untimed=untimed
    ), lacks | unknown


def _apart(inputs: Inputs, answer: Any, other: Any) -> Any:
    """How far two answers are apart, in m/s, for the worse of both bodies; infinite where the first
    is none.
    """
    worst: Any = 0.0
    for label, body in (("a", inputs.a), ("b", inputs.b)):
        dx, dy, dw = (
            getattr(answer, name) - getattr(other, name)
            for name in (f"delta_vx_{label}", f"delta_vy_{label}", f"delta_yaw_rate_{label}")
        )
        inertia = math.inf if body.yaw_inertia is None else body.yaw_inertia
        moves = (dw != 0.0) & (math_or_numpy(body.mass).isfinite(body.mass))
        radius = select(moves, inertia / select(moves, body.mass, 1.0), 0.0) ** 0.5
        turning = select(moves, radius * dw, 0.0)
        worst = larger(worst, (dx * dx + dy * dy + turning * turning) ** 0.5)
    return select((answer.status <= Status.ENERGY_GAIN) & (worst == worst), worst, math.inf)


def where_answered(choice: ModelChoice, refused: Any) -> ModelChoice:
    """The same with NaN errors in refused cases."""
    return choice if refused is False or not np.any(refused) else replace(choice, _refused=refused)


def part_of_choice(choice: ModelChoice, take: Any) -> ModelChoice:
    """The choice for some cases of a batch, or for one of them."""
    part: ModelChoice = part_of(choice, take)
    return replace(part, _lacks=bool(choice._missing))


def refuse_incomplete(inputs: Inputs, lacks: Any) -> None:
    """Raise for all missing inputs, in a batch for the first case that needs them."""
    place = first_case(lacks)[1] if isinstance(lacks, np.ndarray) else ""
    reader = ArgumentReader()
    for error in errors_of_missing(inputs.a, inputs.b, inputs.point):
        reader.problems.append(placed(error, place))
    reader.close()


def solve_with_simplest(
    inputs: Inputs,
    on_failure: Any,
    threads: Any,
    progress: Any,
    choice: ModelChoice | None = None,
) -> tuple[Any, ModelChoice]:
    """Solve by the simplest model, chosen case by case in a batch, and give the choice; ``choice``
    if it was made before.
    """
    check_options(on_failure, threads, progress)
    report = reporter(progress)
    if choice is None:
        predicting, report = halves(report)
        choice, lacks = choose(inputs, threads, predicting)
        if lacks is not False and np.any(lacks):
            refuse_incomplete(inputs, lacks)
    which = choice._which
    if not isinstance(which, np.ndarray):
        if which == _LAST:
            return solve_inputs(TIME_RESOLVED, timed(inputs), on_failure, threads, report), choice
        return solve_inputs(CANDIDATES[which], inputs, on_failure, threads, report), choice
    shape = broadcast({"which": which, **named_numbers(inputs)}) or ()
    late, which = which == _LAST, np.minimum(which, ECCENTRIC)
    used = [model for at, model in enumerate(CANDIDATES) if np.any(which == at)] or [FULL]
    models, numbers = (used, None) if len(used) == 1 else (CANDIDATES, which)
    raw = solve_cases(models, numbers, inputs, shape, threads, report)
    if inputs.tyres:
        raw = _held(inputs, raw, np.broadcast_to(which == ECCENTRIC, shape), threads)
    if np.any(late):
        raw = _in_time(
            inputs, raw, replace(choice, _which=which), np.broadcast_to(late, shape), threads
        )

    def one(take: Any) -> Any:
        case = read_again(part_of_inputs(inputs, take))
        return solve_with_simplest(case, None, 1, None, part_of_choice(chosen, take))

    chosen = choice
    raise_or_warn(inputs, raw, on_failure, one)
    return raw, choice


def _held(inputs: Inputs, raw: Any, some: Any, threads: int) -> WithTyres:
    """The answers of a batch with those of some cases, of the eccentric model, with what their
    tyres do.
    """
    found: dict[str, Any] = {}
    for name in WithTyres._fields:
        value = getattr(raw, name, 0.0 * raw.normal_impulse)
        found[name] = np.array(np.broadcast_to(value, some.shape), dtype=np.asarray(value).dtype)
    if np.any(some):
        part = part_of_inputs(inputs, lambda value: np.broadcast_to(value, some.shape)[some])
        with quietly():
            held = solve_inputs(
                FULL, replace(part, model=_ECCENTRIC, tolerance=None), "nan", threads
            )
        for name, value in found.items():
            value[some] = getattr(held, name)
    return WithTyres(**read_only(found))


def _in_time(inputs: Inputs, raw: Any, choice: ModelChoice, late: Any, threads: int) -> Passed:
    """The answers of a batch with those of its late cases followed in time; the others have no
    duration, force or crush.

    ``choice`` is that of an impulse for all cases, which gave the answers.
    """
    some = part_of_inputs(timed(inputs), lambda value: np.broadcast_to(value, late.shape)[late])
    passed = solve_inputs(TIME_RESOLVED, some, "nan", threads)
    found: dict[str, Any] = {
        "separation_speed": inputs.restitution * raw.closing_speed,
        "energy_absorbed": 0.5 * raw.closing_speed * raw.compression_impulse,
    }
    names = [f"{name}_{label}" for label in "ab" for name in ("vx", "vy", "yaw_rate")]
    changes = [f"delta_{name}" for name in names]
    *at_compression, impulse, loss = until_compressed(
        inputs, raw, choice, [*changes, "normal_impulse", "energy_loss_normal"]
    )
    found |= {
        f"compression_{name}": value for name, value in zip(names, at_compression, strict=True)
    }
    if LAWS[inputs.law or BRACH].followed:
        found["separation_speed"] = select(
            choice._which == 0, found["separation_speed"], raw.separation_speed
        )
        found |= {"compression_impulse": impulse, "energy_absorbed": loss}
    nothing = 0.0 * raw.normal_impulse
    found |= {
        name: getattr(raw, name, nothing) for name in Passed._fields if name.startswith("tyre")
    }
    for name in Passed._fields[:-1]:
        value = found.get(name, getattr(raw, name, math.nan))
        kind = (
            raw.status.dtype
            if name == "status"
            else np.bool_
            if name == "sticks"
            else raw.closing_speed.dtype
        )
        found[name] = np.array(np.broadcast_to(value, late.shape), dtype=kind)
        found[name][late] = getattr(passed, name)
    return Passed(**read_only(found))


def until_compressed(
    inputs: Inputs, answer: Any, choice: ModelChoice | None, names: Sequence[str]
) -> list[Any]:
    """These outputs at the end of compression, which an incomplete impact does not outlast.

    Until then any impact passes as the plastic one, which under an energetic law is not in
    proportion to the whole; but for impulses from outside and of tyres, which are.
    """
    e, found = inputs.restitution, [getattr(answer, name) for name in names]
    refused = answer.status > Status.ENERGY_GAIN
    if LAWS[inputs.law or BRACH].followed:
        early = 1.0 / (1.0 + select(e > 0.0, e, 0.0 * e))
        plastic = _plastic(inputs, answer, choice, early)
        ends = (plastic.status <= Status.ENERGY_GAIN) & (
            plastic.normal_impulse <= answer.normal_impulse
        )
        late = (ends ^ True) & (refused ^ True)
        if inputs.pushed and np.any(late):
            # With a part of the impulses from outside the compression does not end within the
            # contact; where they come first, it does.
            plastic = _plastic(inputs, answer, choice, select(late, 1.0, early))
        # The plastic one may answer where the restitution itself was refused.
        compressed = [select(refused, math.nan, getattr(plastic, name)) for name in names]
    else:
        compressed = [value / (1.0 + e) for value in found]
    pairs = zip(found, compressed, strict=True)
    return (
        [select(e < 0.0, whole, part) for whole, part in pairs] if inputs.incomplete else compressed
    )


def _plastic(inputs: Inputs, answer: Any, choice: ModelChoice | None, share: Any) -> Any:
    """The answer to the same contact without restitution, with a share of what acts from outside;
    NaN where it is refused.
    """
    pushed = _as_pushed(inputs, answer, share)
    plastic = replace(inputs, restitution=0.0 * inputs.restitution, given=None, **pushed)
    with quietly():
        if choice is None:
            return solve_inputs(model_of(plastic), plastic, on_failure="nan")
        return solve_with_simplest(plastic, "nan", 1, None, choice)[0]


def _as_pushed(inputs: Inputs, answer: Any, share: Any) -> dict[str, Any]:
    """A share of the impulses from outside, with what tyres did during an impulse in place of
    those: the same contact up to another moment would else be given that of its own motion.
    """
    tyres = bool(inputs.tyres) and hasattr(answer, "tyre_impulse_x_a")
    found: dict[str, Any] = dict.fromkeys(("tyres_a", "tyres_b", "duration")) if tyres else {}
    for name in OUTSIDE:
        given = getattr(inputs, name)
        if tyres:
            parts = "tyre_impulse_x", "tyre_impulse_y", "tyre_moment"
            pushes = [getattr(answer, f"{part}_{name[-1]}") for part in parts]
            given = [one + more for one, more in zip(given or (0.0,) * 3, pushes, strict=True)]
        if given is not None:
            found[name] = tuple(share * part for part in given)
    return found


@lru_cache(maxsize=64)
def _float_function(central: bool, *variant: Any) -> Callable[[dict[str, Any]], Any]:
    """``least_model`` compiled for plain floats of which none is missing."""
    known = Known((True, True), (True, True), complete=True, central=central)
    arguments = paths_of(FULL, *variant), "tolerance"
    kernel = flattened(least_model, form_of(arguments))
    rule, law, *_ = variant
    return compile_for_floats(kernel, tuple(numbers_of(arguments)), (rule, law, known, EPS))


def _predicted(
    inputs: Inputs,
    missing: tuple[str, ...],
    central: bool,
    shape: tuple[int, ...] | None,
    threads: int,
    progress: Any,
) -> Any:
    """The model's number, and the errors of the central models; infinite where these do not take
    all that was given.
    """
    a, b, placed, tolerance = inputs.a, inputs.b, inputs.point is not None, inputs.tolerance
    if shape is None and not missing:
        found = _float_function(central, *variant_of(inputs))(vars(inputs))
        if found is not None:
            return found
    known = Known(
        places=(
            placed and a.x is not None and a.y is not None,
            placed and b.x is not None and b.y is not None,
        ),
        inertias=(a.yaw_inertia is not None, b.yaw_inertia is not None),
        complete=not missing,
        central=central,
    )
    problem = FULL.problem(inputs)
    if shape is None:
        return least_model(problem, tolerance, inputs.rule, cast(str, inputs.law), known, EPS)
    # Batches only, so the float precision is found as for batches of one model.
    from ..engine.batch import least_models

    cases, eps = cases_of(inputs, shape, threads)
    limit: Any = tolerance
    if cases.dtype == np.float32:
        # A tolerance too large for float32 accepts any float32 error.
        most = float(np.finfo(cases.dtype).max)
        limit = np.minimum(limit, most) if isinstance(limit, np.ndarray) else min(limit, most)
    settings = inputs.rule, inputs.law, known, eps
    return least_models((problem, limit), settings, cases, progress)


def _reason(choice: ModelChoice, system: Numbers = _SI) -> str:
    """The reason for the choice, in a sentence."""
    which, errors, tolerance, timed = (
        choice._which,
        choice._predicted,
        choice.tolerance,
        choice._timed,
    )
    if isinstance(which, np.ndarray):
        counts = ((name, int(np.count_nonzero(which == at))) for at, name in enumerate(_NAMES))
        listed = ", ".join(f"{count} {name}" for name, count in counts if count)
        return f"of {which.size} cases {listed or 'none'}: each the least within its tolerance"
    if choice._untimed and not timed:
        bare = replace(choice, _untimed="", _predicted=errors[:2])
        return f"{_reason(bare, system)}; {choice._untimed}"

    def speed(value: float) -> str:
        return f"{system.converted(value, 'speed'):.3g}{system.unit('speed')}"

    def would(at: int) -> str:
        return (
            f"{_NAMES[at]} "
            f"{'has no answer' if errors[at] == math.inf else f'would err by {speed(errors[at])}'}"
        )

    model, accepted = _NAMES[which], f", and {speed(tolerance)} is accepted"
    fullest = _LAST if timed else ECCENTRIC
    if which != fullest:
        how = "over this duration it errs by about" if timed else "it errs by"
        others = f"; {would(0)}" if which and not timed else ""
        return f"{model}: {how} {speed(errors[which])}{accepted}{others}"
    nearest = errors[fullest - 1]
    if tolerance == 0.0:
        why = f"a tolerance of 0 asks for the {'fullest' if timed else 'full'} model"
    elif choice._beyond:
        why = f"{choice._beyond} is beyond the central models"
    elif not math.isnan(nearest):
        why = would(fullest - 1) + (
            "" if nearest == math.inf else f"{' over this duration' if timed else ''}{accepted}"
        )
        if nearest <= tolerance:
            why += f", which has to be {_MARGIN:g} times that, as the error is known roughly"
    elif timed:
        why = f"in {_ROUGH} steps it has no answer, so what the others err by is not known"
    elif choice._lacks:
        why = (
            f"the error of a central model cannot be estimated without {', '.join(choice._missing)}"
        )
    else:
        why = "there is no answer that a cheaper one could come near to"
    return f"{model}: {why}"
