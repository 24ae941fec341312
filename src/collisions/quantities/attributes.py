"""``@derived(unit)`` declares an attribute with its SI unit; ``.q`` gives it as a Quantity,
``format_value`` with its unit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import Field, fields
from functools import partial, wraps
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Never, ParamSpec, TypeVar, overload

import numpy as np

from ..messages.errors import MissingInputError, Status
from .formatting import in_words
from .tables import Cells, Summarized, Summary, all_numbers, sided
from .units import Texts, Value, to_quantity

T = TypeVar("T")
P = ParamSpec("P")
F = TypeVar("F", bound=Callable[..., Any])
# A declared unit that stands for the ``unit`` of the object itself, known only when the object is
# made.
OWN_UNIT = "own"


class Derived(Generic[T]):
    """A read-only attribute with its unit, computed at first use and cached.

    The value is cached in the owner's ``__dict__``, if it has one, where Python finds it before
    this descriptor. Assignment is refused by the owner.
    """

    def __init__(self, unit: str | None, work_out: Callable[[Any], T]) -> None:
        self.unit = unit
        self.work_out = work_out
        self.name: str = work_out.__name__
        self.__doc__ = work_out.__doc__

    @overload
    def __get__(self, owner: None, kind: type[Any]) -> Derived[T]: ...
    @overload
    def __get__(self, owner: object, kind: type[Any] | None = None) -> T: ...
    def __get__(self, owner: Any, kind: type[Any] | None = None) -> Any:
        if owner is None:
            return self
        kept = getattr(owner, "__dict__", None)
        if kept and type(getattr(kept.get("_answer"), "status", None)) is Status:
            value = self.work_out(owner)
        else:
            # Refused cases are NaN or infinite; numpy need not warn of them again.
            with np.errstate(all="ignore"):
                value = read_only(self.work_out(owner))
        # The first of several threads that worked it out keeps its own: all see one object.
        return value if kept is None else kept.setdefault(self.name, value)

    if TYPE_CHECKING:
        # ``Never`` has no values, so type checkers refuse every assignment.
        def __set__(self, owner: Any, value: Never) -> None: ...


class SuggestsNames:
    """Base of results that say where an attribute is that they do not have."""

    __slots__ = ()

    # Where the attributes of something within the result are found: a missing name is looked up
    # there.
    _elsewhere: ClassVar[Mapping[type[Any], str]] = {}

    if not TYPE_CHECKING:  # with it type checkers would take any name

        def __getattr__(self, name: str) -> Any:
            if hasattr(type(self), name):
                # Working it out raised an AttributeError, which is raised again.
                return object.__getattribute__(self, name)
            raise _no_attribute(self, name, name)


class Frozen(SuggestsNames):
    """Base of results that cannot be changed."""

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"an answer is frozen: {name} of {type(self).__name__} cannot be set")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(
            f"an answer is frozen: {name} of {type(self).__name__} cannot be deleted"
        )


def _no_attribute(owner: SuggestsNames, name: str, written: str) -> AttributeError:
    """The error for an attribute that an object does not have, with where it is and how it is
    written there.
    """
    places = [
        where.format(written)
        for kind, where in owner._elsewhere.items()
        if name[:1] != "_" and hasattr(kind, name)
    ]
    # What the object has of each vehicle.
    places += [f"{written}_a or {written}_b"] if hasattr(type(owner), f"{name}_a") else []
    hint = f"; write {places[0]}" if places else ""
    return AttributeError(
        f"{type(owner).__name__!r} object has no attribute {name!r}{hint}", name=name, obj=owner
    )


def derived(unit: str | None = None) -> Callable[[Callable[[Any], T]], Derived[T]]:
    """Declare a computed attribute with its SI unit."""
    return partial(Derived, unit)


def returns(unit: str) -> Callable[[F], F]:
    """Declare the SI unit of the return value of a method, or of a property, below its own
    decorator.
    """

    def declare(method: F) -> F:
        vars(method)["unit"] = unit
        return method

    return declare


def unit_of(kind: type[Any], name: str) -> str | None:
    """The declared SI unit of an attribute; None for names, labels and other objects."""
    declared = getattr(kind, "__dataclass_fields__", {}).get(name)
    if declared is not None:
        unit: str | None = declared.metadata.get("unit")
        return unit
    member = getattr(kind, name, None)
    unit = getattr(getattr(member, "fget", member), "unit", None)
    return unit


class NoQuantityError(MissingInputError, AttributeError):
    """An attribute is None as an input is missing. Also an AttributeError, so that ``hasattr`` and
    completion pass over it.
    """

    name: Any = None  # Otherwise Python would suggest another attribute.


def missing_error(owner: Any, name: str) -> MissingInputError | None:
    """The error that names the missing input for which an attribute is None, from the method
    ``_missing`` of its object; None without such a method, or where no input is missing.
    """
    if not hasattr(owner, "_missing"):
        return None
    problem: MissingInputError | None = owner._missing(name)
    return problem


class Quantities:
    """The owner's attributes and the results of its methods as Quantities.

    ``missing_error`` names the missing input of an attribute that is None.
    """

    __slots__ = ("_owner",)

    def __init__(self, owner: Any) -> None:
        self._owner = owner

    def __getattr__(self, name: str) -> Any:
        if name == "q" or name.startswith("__"):
            raise AttributeError(f"{name!r} is no quantity")
        try:
            value = getattr(self._owner, name)
        except AttributeError:
            if not isinstance(self._owner, SuggestsNames) or hasattr(type(self._owner), name):
                raise
            raise _no_attribute(self._owner, name, f"q.{name}") from None
        unit = unit_of(type(self._owner), name)
        if unit == OWN_UNIT:
            unit = self._owner.unit
        if callable(value):
            if unit is None:
                raise AttributeError(
                    f"{name} gives no quantity; call it on the object itself, without .q"
                )
            return lambda *args, **kwargs: self._with_unit(value(*args, **kwargs), unit)
        if value is None and (problem := missing_error(self._owner, name)) is not None:
            raise NoQuantityError(problem.marked, code=problem.code, **problem.fields)
        if value is None or unit is None:
            return _within(value)
        return self._with_unit(value, unit)

    def _with_unit(self, value: Any, unit: str) -> Any:
        return to_quantity(value, unit)

    def __dir__(self) -> list[str]:
        kind = type(self._owner)
        names = [name for name in dir(kind) if name != "q" and not name.startswith("_")]
        return [
            name
            for name in names
            if unit_of(kind, name) is not None or not callable(getattr(kind, name))
        ]

    def __repr__(self) -> str:
        return f"<Quantities of {self._owner!r}>"


def _within(value: Any) -> Any:
    """The Quantities of an object that has some, also of each in a tuple or a mapping; any other
    value as it is.
    """
    if (found := getattr(value, "q", None)) is not None:
        return found
    if isinstance(value, tuple):
        parts = [_within(part) for part in value]
        same = all(one is other for one, other in zip(parts, value, strict=True))
        return value if same else tuple(parts)
    if isinstance(value, Mapping):
        named = {name: _within(part) for name, part in value.items()}
        same = all(part is value[name] for name, part in named.items())
        return value if same else MappingProxyType(named)
    return value


def in_quantities(function: Callable[P, Any], unit: str) -> Callable[P, Any]:
    """The same function with its result as a Quantity."""

    @wraps(function)
    def with_unit(*args: P.args, **options: P.kwargs) -> Any:
        return to_quantity(function(*args, **options), unit)

    return with_unit


def read_only(value: Any) -> Any:
    """The value with its arrays made read-only, also those in a tuple or a dict."""
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
    elif isinstance(value, (tuple, dict)):
        for part in value.values() if isinstance(value, dict) else value:
            read_only(part)
    return value


def attributes(kind: type[Any]) -> list[str]:
    """Names of the derived attributes, in the order of their definition."""
    return [name for name, member in vars(kind).items() if isinstance(member, Derived)]


def math_or_numpy(*values: Any) -> Any:
    """``math`` for numbers; ``numpy`` if any of these values is an array, or an operand of a
    recording.
    """
    return math if all(isinstance(value, (float, int)) for value in values) else np


def hypot(x: Value, y: Value) -> Value:
    """Length of a vector, without squares that may overflow."""
    length: Value = math_or_numpy(x, y).hypot(x, y)
    return length


def format_value(value: Any, unit: str | None = None) -> str:
    """A value for people: six digits and the unit; an array by its shape and range."""
    suffix = f" {unit}" if unit else ""
    if isinstance(value, tuple):
        return "(" + ", ".join(format_value(part) for part in value) + ")" + suffix
    if isinstance(value, np.ndarray):
        if value.dtype.kind == "f" and value.size:
            if np.all(np.isnan(value)):
                return f"array{value.shape} {in_words(math.nan)}"
            return f"array{value.shape} {np.nanmin(value):.6g} to {np.nanmax(value):.6g}{suffix}"
        return f"array{value.shape}{suffix}"
    if isinstance(value, float):
        return in_words(value) if math.isnan(value) else f"{value:.6g}{suffix}"
    if isinstance(value, Status):
        return value.sentence
    return str(value)


def equal(one: Any, other: Any) -> bool:
    """Equality by value for numbers, arrays, pairs, mappings and None, NaN equal to itself."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(
            equal(value, other[name]) for name, value in one.items()
        )
    if isinstance(one, tuple) or isinstance(other, tuple):
        return (
            isinstance(one, tuple)
            and isinstance(other, tuple)
            and len(one) == len(other)
            and all(map(equal, one, other))
        )
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        if one is None or other is None or np.shape(one) != np.shape(other):
            return False
        one, other = np.asarray(one), np.asarray(other)
        return bool(np.array_equal(one, other, equal_nan="f" in one.dtype.kind + other.dtype.kind))
    return bool(one == other) or (one != one and other != other)


def same_fields(one: Any, other: Any) -> bool:
    """Equality of two dataclasses of one kind by the values of their fields, which may
    be arrays.
    """
    return type(one) is type(other) and all(
        equal(getattr(one, f.name), getattr(other, f.name)) for f in fields(one)
    )


class Shown(SuggestsNames, Summarized):
    """Base of result dataclasses: shown with units as text and as a table, with ``.q``; arrays stay
    locked when unpickled.
    """

    __slots__ = ("_inputs_as_texts",)

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    _title: ClassVar[str]

    def _texts(self) -> Iterable[Any]:
        return getattr(self, "_inputs_as_texts", ())

    @property
    def q(self) -> Any:
        """The same attributes as pint Quantities of the application registry."""
        return Quantities(self)

    def __eq__(self, other: object) -> bool:
        return same_fields(self, other) if isinstance(other, Shown) else NotImplemented

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (
            type(self),
            {f.name: getattr(self, f.name) for f in fields(self)},
            tuple(self._texts()),
        )

    def __repr__(self) -> str:
        return (
            f"{type(self).__name__}({', '.join(f'{name}={text}' for name, text in self._rows())})"
        )

    def _summary(self, numbers: Cells) -> Summary:
        return Summary(self._title, [*sided(self._values(), numbers), all_numbers(self._rows())])

    def _values(self, prefix: str = "") -> Iterator[tuple[str, Any, str | None]]:
        """Name, value and SI unit of every attribute that has one or is yes or no; of results
        within it by their own names.
        """
        for name in (*(f.name for f in fields(self)), *attributes(type(self))):
            value, unit = getattr(self, name), unit_of(type(self), name)
            if isinstance(value, Shown):
                yield from value._values(f"{name}.")
            elif value is not None and (unit is not None or isinstance(value, bool)):
                yield prefix + name, value, unit

    def _rows(self, prefix: str = "") -> Iterator[tuple[str, str]]:
        for name, value, unit in self._values(prefix):
            yield name, format_value(value, unit)


def texts_given(result: Shown) -> Texts:
    """The texts by argument that were kept beside a dataclass as it was made."""
    kept: Any = getattr(result, "_inputs_as_texts", Texts())
    return Texts(kept)


def in_units_of(result: T, texts: Iterable[Any]) -> T:
    """A result that was just made, with the texts in whose units its summary is to be."""
    object.__setattr__(result, "_inputs_as_texts", tuple(texts))
    return result


def _restored(kind: type[Any], values: dict[str, Any], texts: Iterable[Any] = ()) -> Any:
    """An unpickled result; pickle restores arrays writable, so they are locked again."""
    return in_units_of(kind(**read_only(values)), texts)
