"""``Model``: the user's function. Its fixed inputs are read, it is called with arrays of cases, and
its outputs are checked.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Collection, Iterable, Mapping
from numbers import Number
from types import FunctionType
from typing import Any, Protocol, TypeAlias

import numpy as np

from ..kernels.elementwise import UNCHECKED
from ..messages.errors import CollisionsError, InputError, ShapeError, UnitsError, placed, reworded
from ..messages.marked import as_code
from ..messages.warning import Calls, Said, noted_in_call, quietly
from ..quantities.reading import ArgumentReader
from ..quantities.settings import in_si
from ..quantities.units import example, is_quantity, shown, si_unit
from . import turns
from .distribution import GivenUnit, missing_unit
from .distributions import Distribution, Interval
from .one_sided import Answers, OneSided

Function: TypeAlias = Callable[..., Mapping[str, Any]]


class ByPaths(Protocol):
    """A model with many inputs and results by name, such as a ``scene.Scene``."""

    def as_model(self, names: list[str], outputs: list[str]) -> Function:
        """The function of some of its inputs that returns some of its results."""

    def results(self) -> Mapping[str, str]:
        """The names of its results, with their units."""


AnyModel: TypeAlias = Function | ByPaths

_LOW_CASES = 4  # asked again together: as alone, a threshold of those few divides them
# A share of the width of the middle half of the answers, or of all where that has none: an
# iteration that goes on until every case has converged ends a little differently for one case. A
# smaller difference, whatever its cause, changes no digit that anyone reads.
_UNNOTICED = 1e-6
_ROUNDINGS = 64.0 * float(
    np.finfo(np.float64).eps
)  # of an answer: numpy adds in another order for one number than for many


class Model:
    """A function of named inputs and its fixed inputs; the names and units of its outputs from the
    first call on.
    """

    def __init__(self, function: Any, fixed: Mapping[str, Any], one_sided: bool = False) -> None:
        if not callable(function):
            raise _bad_model(
                "model must be a function of the named inputs that returns a dict of outputs, "
                f"got {type(function).__name__}"
            )
        self.function = function
        self.fixed = dict(fixed)
        # What is the same in all cases of a run and another in the next: it reaches the function as
        # an array, so that a warning of it is of all these cases.
        self.place: Mapping[str, float] = {}
        self.units: dict[str, str | None] = {}
        self.noted: Calls = []
        self.cases = 0  # asked so far, but for those asked again as a check
        # Whether its outputs may be OneSided.
        self.one_sided = one_sided
        # A scene answers case by case, as its own tests show; but a motion on tyres is followed in
        # steps of its own, which rounding may change within the tolerance it is followed in.
        self._checked = getattr(function, "answers_by_case", False)

    def at(self, place: Mapping[str, float]) -> Model:
        """The model with intervals at one place between their bounds."""
        found = Model(self.function, self.fixed, self.one_sided)
        found._checked, found.noted, found.place = self._checked, self.noted, place
        return found

    def __call__(self, values: Mapping[str, Any], count: int, check: bool = True) -> Answers:
        """The outputs of the cases as new float arrays; NaN where the model's value is not finite.

        The first time, a few cases are computed again on their own. ``check=False`` leaves that to
        another call: among calls from several threads, it is always the same one that does it.
        Warnings about cases are kept in ``noted``.
        """
        found = self._answers(values, count, self.noted)
        self.cases += count
        if check and not self._checked:
            self._checked = check_elementwise(
                lambda cases, count: self._answers(cases, count, []), values, found
            )
        return found

    def _answers(self, values: Mapping[str, Any], count: int, noted: Calls) -> Answers:
        values = {**values, **{name: np.full(count, one) for name, one in self.place.items()}}
        for value in values.values():
            value.setflags(write=False)
        said: list[Said] = []
        try:
            with quietly(said), in_si(), np.errstate(all="ignore"):
                answered = self.function(**self.fixed, **values)
            noted.append((count, noted_in_call(said, count)))
        except Exception as error:
            called = (
                f"called with arrays of {count} cases for {', '.join(values) or 'nothing'}, and "
                "must work case by case: write numpy in place of math (numpy.sqrt), "
                "numpy.where in place of if (numpy.where(x > 0, x, -x)), and let refused cases "
                "be NaN: `on_failure='nan'` where the solver has it (reconstruct.speeds gives "
                f"NaN by itself){pair_hints(self.fixed)}"
            )
            # Raised by Python and numpy where an array is used as a number, or a number as a
            # Quantity.
            if isinstance(error, (TypeError, ValueError, AttributeError)) and not isinstance(
                error, CollisionsError
            ):
                raise _bad_model(f"model raised {described(error)}. It is {called}") from error
            error.add_note(f"The model is {called}.")
            raise
        if not isinstance(answered, Mapping) or not answered:
            got = "an empty one" if isinstance(answered, Mapping) else type(answered).__name__
            raise _bad_model(
                "model must return a dict of named outputs, such as `{'delta_v': "
                f"impact.a.q.delta_v}}`, got {got}"
            )
        sides = {
            name: value.sides for name, value in answered.items() if isinstance(value, OneSided)
        }
        answered = {
            name: value.values if isinstance(value, OneSided) else value
            for name, value in answered.items()
        }
        units = {
            name: si_unit(value, per_angle=True) if is_quantity(value) else None
            for name, value in answered.items()
        }
        if self.units and units != self.units:
            raise _bad_model(
                f"model returned {_listed(units)} now and {_listed(self.units)} before; it must "
                "always return the same outputs"
            )
        self.units = units
        outputs = {
            name: self._read(name, value, units[name], count) for name, value in answered.items()
        }
        return Answers(
            outputs,
            {name: self._sides(name, one, count) for name, one in sides.items() if np.any(one)},
        )

    def _sides(self, name: str, sides: Any, count: int) -> Any:
        if not self.one_sided:
            raise InputError(
                f"output {name!r} of the model is OneSided, which is for uncertainty.propagate "
                "with a method that draws, without Interval inputs, tolerance and finer; return "
                "a number for every case here",
                code="one_sided",
                argument=name,
            )
        return np.array(np.broadcast_to(sides, (count,)), dtype=np.int8)

    def _read(self, name: str, value: Any, unit: str | None, count: int) -> Any:
        if not isinstance(name, str):
            raise _bad_model(f"model must name its outputs by texts, got {shown(name)}")
        if isinstance(value, np.ndarray) and value.dtype == np.bool_:
            value = value.astype(np.float64)
        reader = ArgumentReader(trusted=(name,))
        read = reader.number(value, unit or "", name)
        reader.close()
        if np.shape(read) != (count,) and not np.size(read) == count == 1:
            constant = "; leave out what is the same in every case" if not np.ndim(read) else ""
            raise ShapeError(
                f"output {name!r} of the model has shape {np.shape(read)} for {count} cases; it "
                "must answer every case by itself, so an array of shape "
                f"({count},){constant}{pair_hints(self.fixed)}",
                code="bad_shape",
                argument=name,
            )
        found = np.array(read, dtype=np.float64).reshape(count)
        found[~np.isfinite(found)] = np.nan
        return found


def scene_among(*models: Any) -> Any:
    """The first of some models, if it is one with many inputs and outputs by name, such as a
    ``Scene``; None if it is a function.
    """
    first = next((one for one in models if one is not None), None)
    return first if hasattr(first, "as_model") else None


def function_of(model: Any, names: Iterable[str], outputs: Any, argument: str) -> Any:
    """The function of a model that has many inputs and outputs by name, such as a ``Scene``, for
    some of them; any other model as it is.

    Such a model has ``as_model(names, outputs)``; it works out what is asked for alone, so the
    outputs have to be named.
    """
    if scene_among(model) is None:
        if outputs is not None and argument == "outputs":
            raise InputError(
                "outputs names results of a Scene, and model is a function, which returns its own; "
                "leave outputs out",
                code="bad_option",
                argument="outputs",
            )
        return model
    listed = isinstance(outputs, (list, tuple)) and all(isinstance(one, str) for one in outputs)
    if argument != "observed" and (not listed or not outputs):
        known = ", ".join(list(model.results())[:3])
        raise InputError(
            f"outputs must be a list of results of the {type(model).__name__}, such as {known}; "
            f"got {shown(outputs)}",
            code="bad_outputs",
            argument="outputs",
        )
    try:
        return model.as_model(list(names), list(outputs))
    except InputError as error:
        # What is an output to the model is something else to its caller.
        if error.argument != "outputs":
            raise
        text = error.marked.replace("outputs", argument, 1)
        raise placed(reworded(error, text), "", argument=argument) from None


def units_taken(model: Any) -> Mapping[str, str]:
    """The SI units of the inputs of a model that says them, as that of a ``Scene`` does."""
    found: Mapping[str, str] = getattr(getattr(model, "function", model), "units_of_inputs", {})
    return found


def check_units(function: Any, units: Mapping[str, str | None], argument: str) -> None:
    """Refuse inputs stated in a unit of another kind than the model takes, where it says what it
    takes; it is called with plain numbers, which would hide that.
    """
    compare_units(units, units_taken(function), argument)


def compare_units(units: Mapping[str, str | None], taken: Mapping[str, str], argument: str) -> None:
    """Refuse what is stated in another unit than the one ``taken``, by name, or in none where it
    has to have one.
    """
    reader = ArgumentReader()
    for name, unit in units.items():
        wanted = taken.get(name)
        label = f"{argument}[{name!r}]"
        if wanted is None or unit is None or unit == wanted:
            continue
        if unit or isinstance(unit, GivenUnit):
            written = unit.written if isinstance(unit, GivenUnit) else unit
            what = "is of another kind" if wanted else "is a plain number"
            text = (
                f"{as_code(label)} is stated in {written}, and {name} {what}; write numbers such "
                f"as {example(wanted)}"
            )
            reader.refuse(UnitsError(text, code="bad_units", argument=label))
        elif problem := missing_unit(label, unit, wanted):
            reader.refuse(problem)
    reader.close()


def count_failed(answers: Mapping[str, Any]) -> int:
    """Cases without an answer to at least one output."""
    return int(np.count_nonzero(np.any([np.isnan(values) for values in answers.values()], axis=0)))


def read_input(name: str, value: Any) -> Any:
    """The input for a model: a stated input or other object as it is, a number or a text as an SI
    float.

    Raises
    ------
    InputError
        A boolean, NaN, an array or a list of numbers, or a text that is not a number with a unit.

    Examples
    --------
    >>> (
    ...     read_input("speed", "36 km/h"),
    ...     read_input("restitution", 0.4),
    ...     read_input("point", (2.1, 0.3)),
    ... )
    (10.0, 0.4, (2.1, 0.3))
    """
    if isinstance(value, (tuple, list)) and any(
        isinstance(part, (str, Distribution, Interval)) or is_quantity(part) for part in value
    ):
        raise InputError(
            f"{name} is a {type(value).__name__} with a unit or a distribution in it; give each "
            f"part as an input of its own, and put them together in the model{range_hint(value)}",
            code="bad_inputs",
            argument=name,
        )
    if (
        isinstance(value, list)
        and value
        and all(isinstance(part, (Number, np.generic)) for part in value)
    ):
        raise ShapeError(
            f"{name} is a list of {len(value)} number{'s' * (len(value) > 1)}; measured "
            "values are given as `Samples(values)`, the parts of a point as a tuple, and "
            "what the model needs as an array is written into the model itself",
            code="bad_shape",
            argument=name,
        )
    if not (
        isinstance(value, (str, Number, np.generic))
        or is_quantity(value)
        or hasattr(value, "__array__")
    ):
        return value
    try:
        unit = si_unit(value, name)
    except UnitsError as error:
        if not isinstance(value, str):
            raise
        raise reworded(
            error,
            f"{error.marked}; a text that is no quantity, such as the name of a law, is written "
            "into the model itself",
        ) from None
    reader = ArgumentReader()
    number = reader.number(value, unit, name, UNCHECKED)
    reader.close()
    if isinstance(number, np.ndarray):
        raise ShapeError(
            f"{name} is an array of shape {number.shape}; measured values are given as "
            "`Samples(values)`, and what the model needs as an array is written into the "
            "model itself",
            code="bad_shape",
            argument=name,
        )
    if math.isnan(number):
        raise InputError(
            f"{name} is NaN; give a number, or a distribution of what is not known",
            code="not_finite",
            argument=name,
        )
    return number


def pair_hints(fixed: Mapping[str, Any]) -> str:
    """Hints for inputs that are pairs of numbers in order: they are read as points, but may be
    meant as ranges.
    """
    return "".join(
        f". {name} is the pair {value!r} in every case{hint}"
        for name, value in fixed.items()
        if (hint := range_hint(value))
    )


def range_hint(value: Any) -> str:
    """A hint for a pair of numbers or texts in order that may be meant as a range; ""
    for others.
    """
    kinds = (
        {type(part) for part in value}
        if isinstance(value, (tuple, list)) and len(value) == 2
        else {None}
    )
    rising = kinds == {str} or (kinds <= {int, float} and value[0] < value[1])
    return (
        f"; if a range was meant, write Uniform{tuple(value)!r} or Interval{tuple(value)!r}"
        if rising
        else ""
    )


def check_names(function: Any, names: Collection[str], argument: str, code: str) -> None:
    """Raise for inputs (or unknowns) that are not arguments of the model, and for arguments without
    an input.
    """
    if type(function) is FunctionType and not vars(function):
        # Most models are plain functions: to find their signature can take longer than to call
        # them.
        made = function.__code__
        if {*made.co_varnames[: made.co_argcount + made.co_kwonlyargcount]} == {
            *names
        } and not made.co_posonlyargcount:
            return
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return
    try:
        signature.bind(**dict.fromkeys(names))
    except TypeError as error:
        raise InputError(
            f"{argument} are {', '.join(names) or 'none'}, but the model takes {signature}: "
            f"{error}; name the {argument} as the arguments of the model, and give one for each",
            code=code,
            argument=argument,
        ) from None


def check_elementwise(
    answer: Callable[[Mapping[str, Any], int], Mapping[str, Any]],
    values: Mapping[str, Any],
    answers: Mapping[str, Any],
) -> bool:
    """Raise if the model treats cases differently on their own than among others; False if these
    cases cannot show it.

    ``answer`` takes some cases and their number. Cases that are all the same show nothing, those
    without an answer little, and those in rising order no sort.
    """
    if not any(np.any(column != column[0]) for column in values.values()):
        return False
    total = len(next(iter(answers.values())))
    compared = False
    for places in _revealing_cases(answers):
        cases = _cases(values, places)
        answered = not all(np.isnan(column[places]).all() for column in answers.values())
        company = "alone" if len(places) == 1 else f"among {len(places)} of them"
        try:
            found = answer(cases, len(places))
        except Exception as error:
            if not answered:
                continue
            raise _bad_model(
                f"model answers a case ({_numbers_of(cases)}) among others, but not {company}, "
                f"as arrays of {'one number' if len(places) == 1 else f'{len(places)} numbers'}: "
                f"{described(error.__cause__ or error)}. Every case must be worked out by "
                "itself, however many there are"
            ) from error
        compared |= answered
        for name, column in answers.items():
            for place, few in zip(places, found[name].tolist(), strict=True):
                many = float(column[place])
                if _agree(many, few, column) or _jumps(
                    answer, values, place, name, (many, few), column
                ):
                    continue
                batched_text, single_text = (
                    "no answer" if math.isnan(one) else f"{one:.9g}" for one in (many, few)
                )
                raise _bad_model(
                    f"model mixes cases: among {total} cases it answers {name!r} with "
                    f"{batched_text} for {_numbers_of(_cases(values, [place]))}, and with "
                    f"{single_text} for that case {company}. Every case must be worked out by "
                    "itself. In place of what is taken over all cases, such as x.mean(), "
                    "x.max(), x[0], a running sum, a sort or an if on the whole array, write a "
                    "number into the model, or numpy.where. Random numbers drawn in the model "
                    "do this too: give what is random as an argument of its own, with its "
                    "distribution",
                    output=name,
                )
    return compared and any(np.any(column[1:] < column[:-1]) for column in values.values())


def _revealing_cases(answers: Mapping[str, Any]) -> list[list[int]]:
    """Cases to ask again, those of each list in one call.

    They are the greatest of the first output and two without an answer, each alone, and together a
    few of the least of the first output and of the last. The ends differ most from all cases
    together, each in its own way: alone, a case is its own mean and its own extreme; among the
    least, there is none of the great ones. A call costs as much as some hundred cases, so there are
    few.
    """
    found: list[list[int]] = []
    refused: list[int] = []
    least: list[list[int]] = []
    for column in answers.values():
        missing = np.flatnonzero(np.isnan(column))
        refused += missing[[0, -1]].tolist() if missing.size else []
        if missing.size < column.size:
            few = max(1, min(_LOW_CASES, (column.size - missing.size) // 2))
            found = found or [[int(np.nanargmax(column))]]
            # Backwards, so that what goes on from case to case begins elsewhere.
            least.append(np.sort(np.argpartition(column, few - 1)[:few])[::-1].tolist())
    found += least[:1] + [few for few in least[-1:] if few != least[0]]
    return found + [[place] for place in dict.fromkeys(refused[:2])]


def _jumps(
    answer: Callable[[Mapping[str, Any], int], Mapping[str, Any]],
    values: Mapping[str, Any],
    place: int,
    name: str,
    answers: tuple[float, float],
    column: Any,
) -> bool:
    """Whether the model jumps at a case: alone, and a few roundings away, it has both answers, and
    the same when asked again.

    For many cases numpy may take another path than for few, whose last bits differ; at a jump they
    decide.
    """
    many, few = answers
    case = _cases(values, [place])

    def alone(**moved: Any) -> float:
        return float(
            answer({**{key: value.copy() for key, value in case.items()}, **moved}, 1)[name][0]
        )

    try:
        if not all(_agree(few, alone(), column) for _ in range(2)):
            return False
        moves = {key: _ROUNDINGS * float(np.max(np.abs(value))) for key, value in values.items()}
        return any(
            _agree(many, alone(**{key: case[key] + by}), column)
            for key in moves
            for by in (moves[key], -moves[key])
        )
    except Exception:
        return False


def _cases(values: Mapping[str, Any], places: list[int]) -> dict[str, Any]:
    return {name: column[places] for name, column in values.items()}


def _numbers_of(cases: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} = {float(value[0]):.9g}" for name, value in cases.items())


def _agree(batched: float, single: float, answers: Any) -> bool:
    """Whether a case's value in a batch and by itself agree up to rounding or the convergence of an
    iteration.
    """
    if math.isnan(batched) or math.isnan(single):
        return math.isnan(batched) and math.isnan(single)
    away, roundings = abs(batched - single), _ROUNDINGS * max(abs(batched), abs(single))
    if away <= roundings:
        return True
    if turns.are_directions(np.array([batched, single])):
        away = min(
            away, abs(away - 2.0 * math.pi)
        )  # a direction may come out at either end of its turn
    with np.errstate(all="ignore"):
        low, high = np.nanquantile(answers, (0.25, 0.75))
        if low == high:  # as of a speed that is mostly 0
            low, high = np.nanmin(answers), np.nanmax(answers)
        return bool(away <= roundings + (_UNNOTICED * high - _UNNOTICED * low))


def _bad_model(text: str, **fields: Any) -> InputError:
    return InputError(text, code="bad_model", argument="model", **fields)


def described(error: BaseException) -> str:
    """What was raised in the caller's function, for a message that goes on."""
    return f"{type(error).__name__}: {str(error).rstrip('.')}"


def _listed(units: Mapping[str, str | None]) -> str:
    return ", ".join(f"{name} [{unit}]" if unit else name for name, unit in units.items())
