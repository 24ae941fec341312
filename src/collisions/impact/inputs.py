"""Inputs: all arguments of a solver call in SI, the texts they were given as, and their
validation.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cached_property
from itertools import chain
from operator import attrgetter
from typing import Any, Literal, TypeAlias

import numpy as np

from ..kernels.contact_laws import FRICTION, LAWS, RULES
from ..kernels.elementwise import restitution_domain
from ..kernels.problem import Body, Contact, Problem
from ..messages.errors import InputError, MissingInputError, ShapeError, placed
from ..quantities.attributes import equal, read_only
from ..quantities.directions import direction, from_radians
from ..quantities.reading import OUTSIDE_UNITS, ArgumentReader, broadcast, is_whole, largest
from ..quantities.refusals import must_be, yes_or_no
from ..quantities.settings import units_required
from ..quantities.units import Value, has_unit, is_quantity, texts_of
from ..vehicle.tyres import NAMES as TYRE_NUMBERS
from ..vehicle.tyres import Tyres, tyres_with
from ..vehicle.vehicle import (
    DOMAINS,
    NAMES,
    Vehicle,
    error_of_missing,
    not_a_vehicle,
    numbers_of,
    vehicle_of,
    with_name,
    without_turning,
)

ModelName: TypeAlias = Literal["linear_central", "oblique_central", "eccentric", "time_resolved"]
Law: TypeAlias = Literal["brach", "kudlich-slibar", "stronge"]
OnFailure: TypeAlias = Literal["raise", "nan"]
# Arguments of an impulse: both vehicles, restitution, normal, point, values of ``RULES``, and law.
Arguments: TypeAlias = tuple[Any, Any, Any, Any, Any, tuple[Any, ...], Any]

_numbers = attrgetter(*DOMAINS)
_ALONG_X = (1.0, 0.0)
_new = object.__new__
# Units of a crush stiffness: force at no crush and its growth with crush, each for a width, and
# the width.
CRUSH_UNITS = ("N/m", "N/m**2", "m")
NO_IMPULSE = (0.0, 0.0, 0.0)
OUTSIDE = ("outside_a", "outside_b")
TYRES = ("tyres_a", "tyres_b")
_SLIP = (*RULES, "law", "incomplete")
STIFFNESSES = ("duration", "stiffness", "crush_a", "crush_b")
# Arguments of each solver beyond vehicles, restitution and normal.
ARGUMENTS = {
    "linear_central": ("incomplete",),
    "oblique_central": _SLIP,
    "eccentric": (*_SLIP, "point", *OUTSIDE, "duration", *TYRES),
    "solve": (*_SLIP, "point", *OUTSIDE, "tolerance", "duration", "drag", *TYRES),
    "time_resolved": (
        FRICTION,
        "point",
        *STIFFNESSES,
        "drag",
        "wheelbase",
        "track",
        *TYRES,
        "geometry",
        "steps",
    ),
}
# The models that need places, and the solvers that take pinned bodies.
PLACED, PINNED = ("eccentric", "time_resolved"), ("eccentric", "solve")
_TAKES = {
    name: ("law" in takes, name in PLACED, name in PINNED) for name, takes in ARGUMENTS.items()
}


@dataclass(frozen=True, eq=False)
class Inputs:
    """The arguments of a solver call in SI numbers: enough to solve it again.

    Attributes
    ----------
    model : str
        The solver: "linear_central", "oblique_central", "eccentric", "time_resolved" or "solve".
    a, b : Vehicle
        States just before contact.
    restitution : float or array [1]
    normal : tuple of float or array [1]
        Unit vector from A into B.
    rule : str
        What determines the tangential impulse: "friction", "impulse_ratio" or "critical_fraction"
        ...
    rule_value : float or array [1]
        ... and its value.
    law : str, optional
        None for the linear model.
    point : tuple of float or array [m], optional
    given : mapping, optional
        By argument, the text of what was given with a unit, and an angle of more than a turn
        without one.
    tolerance : float or array [m/s], optional
        With ``solve``, the largest error that was accepted.
    incomplete : bool
        Whether a restitution below 0 is allowed: an impact that ends before a common velocity.
    outside_a, outside_b : tuple of float or array [N*s, N*s, N*m*s], optional
        Impulse on A and on B from other things than the contact, along x and y, and about the
        centre of mass.
    contact_velocity : tuple of float or array [m/s], optional
        From a reverse solver: closing speed and slip before, to more digits than the rounded
        motions would give.
    duration, stiffness, crush_a, crush_b, drag, wheelbase, track, tyres_a, tyres_b, geometry, steps
        As for ``time_resolved``.
    """

    model: str
    a: Vehicle
    b: Vehicle
    restitution: Value = field(metadata={"unit": ""})
    normal: tuple[Value, Value]
    rule: str
    rule_value: Value
    law: str | None
    point: tuple[Value, Value] | None = field(metadata={"unit": "m"})
    given: Mapping[str, Any] | None = None
    tolerance: Value | None = None
    contact_velocity: tuple[Value, Value] | None = None
    duration: Value | None = field(default=None, metadata={"unit": "s"})
    stiffness: Value | None = field(default=None, metadata={"unit": "N/m"})
    crush_a: tuple[Value, ...] | None = field(default=None, metadata={"unit": CRUSH_UNITS})
    crush_b: tuple[Value, ...] | None = field(default=None, metadata={"unit": CRUSH_UNITS})
    drag: Value | None = field(default=None, metadata={"unit": ""})
    wheelbase: Value | None = field(default=None, metadata={"unit": "m"})
    track: Value | None = field(default=None, metadata={"unit": "m"})
    geometry: str | None = None
    steps: int | None = None
    incomplete: bool = False
    outside_a: tuple[Value, ...] | None = field(default=None, metadata={"unit": OUTSIDE_UNITS})
    outside_b: tuple[Value, ...] | None = field(default=None, metadata={"unit": OUTSIDE_UNITS})
    tyres_a: Tyres | None = None
    tyres_b: Tyres | None = None

    @cached_property
    def shape(self) -> tuple[int, ...] | None:
        """That of the arrays among the numbers; None for a single case."""
        shapes = {value.shape for value in numbers_in(self) if isinstance(value, np.ndarray)}
        # Names are for the error of arrays that do not go together.
        return shapes.pop() if len(shapes) == 1 else broadcast(named_numbers(self))

    @property
    def bare_normal(self) -> Any:
        """The normal's angle if it was a number without a unit beyond a full turn (degrees meant?);
        else None.
        """
        normal = None if self.given is None else self.given.get("normal")
        return None if isinstance(normal, str) else normal

    @property
    def texts(self) -> tuple[Any, ...]:
        """What was given with a unit, as texts, by the vehicles and tyres too."""
        found = *texts_of(self.a.given), *texts_of(self.b.given), *texts_of(self.given)
        return *found, *(text for one in self.tyres.values() for text in one.given.values())

    @property
    def pushed(self) -> bool:
        """Whether impulses other than that of the contact act in the same instant: given ones, or
        those of tyres.
        """
        return self.outside_a is not None or (self.model != "time_resolved" and bool(self.tyres))

    @property
    def tyres(self) -> dict[str, Tyres]:
        """The tyres by vehicle, "a" and "b", of those that have some."""
        return {
            label: one
            for label, one in (("a", self.tyres_a), ("b", self.tyres_b))
            if one is not None
        }

    def __eq__(self, other: object) -> bool:
        """Whether all values are equal; the texts they were given as do not count."""
        if not isinstance(other, Inputs):
            return NotImplemented
        return all(
            equal(getattr(self, f.name), getattr(other, f.name))
            for f in fields(self)
            if f.name != "given"
        )

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Arrays come out of a pickle unlocked."""
        vars(self).update(read_only(state))


# The numbers and pairs with their units: records and their schema list each by name.
UNITS: dict[str, Any] = {f.name: f.metadata["unit"] for f in fields(Inputs) if "unit" in f.metadata}


_parts = attrgetter("restitution", "rule_value", "normal", *UNITS, "contact_velocity")


def numbers_in(inputs: Inputs) -> list[Any]:
    """Every number of the inputs, in the order of ``named_numbers``, without their names."""
    found: list[Any] = []
    for value in _parts(inputs):
        if isinstance(value, tuple):
            found += value
        elif value is not None:
            found.append(value)
    for vehicle in (inputs.a, inputs.b):
        found += [value for value in _numbers(vehicle) if value is not None]
        found += vehicle.pivot or ()
    for tyres in inputs.tyres.values():
        found += tyres.named.values()
    return found


def named_numbers(inputs: Inputs) -> dict[str, Any]:
    """Every number of the inputs by the name the caller knows it by."""
    values = {
        "restitution": inputs.restitution,
        inputs.rule: inputs.rule_value,
        "normal": inputs.normal,
    }
    values |= {name: getattr(inputs, name) for name in (*UNITS, "contact_velocity")}
    found: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, tuple):
            found |= {f"{name}[{i}]": part for i, part in enumerate(value)}
        elif value is not None:
            found[name] = value
    for label, vehicle in (("a", inputs.a), ("b", inputs.b)):
        found |= {f"{label}.{name}": value for name, value in numbers_of(vehicle).items()}
    for label, tyres in inputs.tyres.items():
        found |= {f"tyres_{label}.{name}": value for name, value in tyres.named.items()}
    return found


def problem_of(inputs: Inputs) -> Problem:
    """The inputs as the kernels take them.

    A contact velocity is that of the motions alone, and left out where something else acts.
    """
    contact = Contact(
        inputs.restitution, inputs.normal, inputs.rule_value, inputs.point or (0.0, 0.0)
    )
    a, b = (
        Body._make((*body_numbers(body, inputs.point)[:7], body.pivot))
        for body in (inputs.a, inputs.b)
    )
    if inputs.outside_a is not None and inputs.outside_b is not None:
        return Problem(contact, a, b, outside=(inputs.outside_a, inputs.outside_b))
    return Problem(contact, a, b, contact_velocity=inputs.contact_velocity)


def body_numbers(body: Vehicle, contact: tuple[Value, Value] | None) -> tuple[Any, ...]:
    """The numbers of one body; what is not known of its inertia and position is filled in so that
    it makes no torque.
    """
    placed = contact is not None and body.x is not None and body.y is not None
    place = (body.x, body.y) if placed else contact or (0.0, 0.0)
    inertia = math.inf if body.yaw_inertia is None else body.yaw_inertia
    return body.mass, inertia, body.vx, body.vy, body.yaw_rate, *place, *(body.pivot or (0.0, 0.0))


def part_of_inputs(inputs: Inputs, take: Callable[[Any], Any]) -> Inputs:
    """The inputs of some cases: ``take`` is applied to every array."""

    def taken(label: str, value: Any) -> Any:
        try:
            return part_of(value, take)
        except InputError as error:
            who = with_name(label, value) if isinstance(value, Vehicle) else label
            raise placed(error, who, vehicle=label[-1]) from None

    return Inputs(**{f.name: taken(f.name, getattr(inputs, f.name)) for f in fields(inputs)})


def part_of(whole: Any, take: Callable[[Any], Any]) -> Any:
    """The same object with ``take`` applied to every array in it."""
    if isinstance(whole, np.ndarray):
        return take(whole)
    if isinstance(whole, Vehicle):
        return vehicle_of(
            {name: part_of(getattr(whole, name), take) for name in NAMES}, given=whole.given
        )
    if isinstance(whole, Tyres):
        return tyres_with(
            {name: part_of(getattr(whole, name), take) for name in TYRE_NUMBERS}, whole
        )
    if isinstance(whole, Mapping):
        return {name: part_of(value, take) for name, value in whole.items()}
    if isinstance(whole, tuple):
        return tuple(part_of(value, take) for value in whole)
    if is_dataclass(whole) and not isinstance(whole, type):
        return type(whole)(**{f.name: part_of(getattr(whole, f.name), take) for f in fields(whole)})
    return whole


def first_case(holds: Any) -> tuple[tuple[int, ...], str]:
    """Index of the first case of a batch in which a condition holds, and how a message names it."""
    index = tuple(int(i) for i in np.argwhere(holds)[0])
    return index, f"case {index if len(index) != 1 else index[0]}"


def index_of(index: Any, shape: tuple[int, ...] | None, of: str = "impact") -> tuple[int, ...]:
    """The index of one case of a batch, checked against its shape (None where there is one case
    only); ``of`` is what a caller has.
    """
    if shape is None:
        raise ShapeError(
            f"{of} is one case, and case() takes one of a batch; use it as it is",
            code="bad_shape",
            argument="index",
        )
    place = index if isinstance(index, tuple) else (index,)
    whole = all(map(is_whole, place))
    if (
        not whole
        or len(place) != len(shape)
        or not all(-size <= at < size for at, size in zip(place, shape, strict=True))
    ):
        wanted = (
            f"a whole number below {shape[0]}"
            if len(shape) == 1
            else f"{len(shape)} whole numbers in a tuple"
        )
        first = "0" if len(shape) == 1 else str((0,) * len(shape))
        raise must_be(
            "index",
            f"that of one case in a batch of shape {shape}, {wanted}",
            index,
            f"; write {of}.case({first})",
            code="bad_index",
        )
    return tuple(int(at) for at in place)


def plain_inputs(
    model: str,
    a: Any,
    b: Any,
    restitution: Any,
    normal: Any,
    point: Any,
    tangential: tuple[Any, ...],
    law: Any,
) -> Inputs | None:
    """The inputs if all are plain floats in order, which need no reader; else None."""
    lawful, placed, pinned = _TAKES[model]
    friction = tangential[0]
    if (
        type(a) is type(b) is Vehicle
        and (
            a.given is b.given is None
            or np.ndarray not in map(type, chain(numbers_of(a).values(), numbers_of(b).values()))
        )
        and type(restitution) is type(friction) is type(normal) is float
        and 0.0 <= restitution <= 1.0
        and friction >= 0.0
        and -6.0 < normal < 6.0
        and tangential[1] is tangential[2] is None
        and (not lawful or (type(law) is str and law in LAWS))
        and not units_required.get()
        and (pinned or a.pivot is b.pivot is None)
        and (not placed or not errors_of_missing(a, b, point))
        and (
            point is None
            or (
                type(point) is tuple
                and len(point) == 2
                and type(point[0]) is type(point[1]) is float
                and math.isfinite(point[0] + point[1])
            )
        )
    ):
        # What ``Inputs(...)`` does, in a third of its time: a frozen dataclass sets a field through
        # object.
        inputs: Inputs = _new(Inputs)
        found = inputs.__dict__
        found["model"] = model
        found["a"] = a
        found["b"] = b
        found["restitution"] = restitution
        found["normal"] = _ALONG_X if normal == 0.0 else from_radians(normal)
        found["rule"] = FRICTION
        found["rule_value"] = friction
        found["law"] = law if lawful else None
        found["point"] = point
        found["shape"] = None
        return inputs
    return None


def read_inputs(
    model: str,
    arguments: Arguments,
    problems: Sequence[InputError] = (),
    beside: Iterable[Any] = (),
    incomplete: Any = False,
    outside_a: Any = None,
    outside_b: Any = None,
) -> Inputs:
    """Validate the arguments of a solver.

    Missing inputs, and inputs that the model cannot represent, are refused; one error names all
    that cannot be used, with the ``problems`` that were found before. Of the values of ``RULES``
    one must be given. ``beside`` has the numbers that are not among these arguments, with which the
    normal shares its precision.
    """
    if not problems and incomplete is False and outside_a is outside_b is None:
        plain = plain_inputs(model, *arguments)
        if plain is not None:
            return plain
    a, b, restitution, normal, point, tangential, law = arguments
    reader = ArgumentReader()
    reader.problems.extend(problems)
    if model in PLACED:
        reader.problems.extend(errors_of_missing(a, b, point, model))
    if model not in PINNED:
        reader.problems.extend(_pinned(model, a, b))
    for label, vehicle in (("a", a), ("b", b)):
        if not isinstance(vehicle, Vehicle):
            reader.refuse(not_a_vehicle(label, vehicle))
    check_flag(reader, "incomplete", incomplete)
    e = reader.number(restitution, "", "restitution", restitution_domain(incomplete))
    contact = None if point is None else reader.pair(point, "m", "point")
    rule, value = _tangential(reader, tangential)
    vehicles = (
        number
        for vehicle in (a, b)
        if isinstance(vehicle, Vehicle)
        for number in numbers_of(vehicle).values()
    )
    pushes: dict[str, Any] = dict(zip(OUTSIDE, (outside_a, outside_b), strict=True))
    if outside_a is not None or outside_b is not None:
        pushes = {
            name: NO_IMPULSE if given is None else reader.impulse(given, name)
            for name, given in pushes.items()
        }
    of_contact = (
        e,
        value,
        *(contact or ()),
        *(pushes["outside_a"] or ()),
        *(pushes["outside_b"] or ()),
    )
    unit: Any = direction(reader, normal, "normal", chain(of_contact, vehicles, beside))
    lawful, _, _ = _TAKES[model]
    if lawful and (not isinstance(law, str) or law not in LAWS):
        known = " or ".join(f"{name!r} ({known.no_slip})" for name, known in LAWS.items())
        reader.refuse(must_be("law", known, law, code="bad_law"))
    elif lawful and LAWS[law].followed and rule != FRICTION:
        text = (
            f"law {law!r} works with `friction=` alone, got `{rule}=`: it finds the impulse "
            "ratio from the slip as it changes"
        )
        reader.refuse(InputError(text, code="bad_combination", argument=rule))
    reader.close()
    # Only the direction of a vector counts.
    given = {
        name: text for name, text in reader.texts.items() if not name.startswith("normal[")
    } | _beyond_a_turn(normal)
    more: dict[str, Any] = {"incomplete": incomplete, **pushes}
    return Inputs(
        model, a, b, e, unit, rule, value, law if lawful else None, contact, given or None, **more
    )


def check_flag(reader: ArgumentReader, name: str, given: Any) -> None:
    """Refuse an option that is no bool."""
    if not isinstance(given, bool):
        reader.refuse(yes_or_no(name, given, code="bad_option"))


def missing_inputs(a: Any, b: Any) -> list[tuple[str, str]]:
    """Vehicle and field of each input that the eccentric model needs and that is None; a fixed body
    needs no position.
    """
    found: list[tuple[str, str]] = []
    for label, body in (("a", a), ("b", b)):
        if type(body) is not Vehicle or _is_complete(body):
            continue
        inertia = 0.0 if body.yaw_inertia is None else body.yaw_inertia
        # Element by element: with an empty array among them, a plain number still says that the
        # body moves.
        fixed = (
            np.all(np.isinf(body.mass))
            and np.all(np.isinf(inertia))
            and without_turning(body.yaw_rate)
        )
        needed = ("yaw_inertia",) if fixed else ("yaw_inertia", "x", "y")
        found += [(label, name) for name in needed if getattr(body, name) is None]
    return found


def errors_of_missing(a: Any, b: Any, point: Any, model: str = "eccentric") -> Sequence[InputError]:
    """One error for each input that a model with places needs and that was not given."""
    if point is not None and _is_complete(a) and _is_complete(b):
        return ()
    found = [
        error_of_missing(a if label == "a" else b, name, model, label)
        for label, name in missing_inputs(a, b)
    ]
    if point is None:
        text = (
            f"point `|is None|is not given`, and {model} needs it; give the scene "
            "point `(x, y)` at which the impulse acts"
        )
        found.insert(0, MissingInputError(text, code="missing_point", argument="point"))
    return found


def _pinned(model: str, a: Any, b: Any) -> Sequence[InputError]:
    """One error for each pinned body, which the central models cannot represent."""
    cure = "use eccentric, which needs yaw_inertia, x, y and point"
    if model == "time_resolved":
        cure = "give an infinite mass at the pivot, with the yaw inertia about it, or use eccentric"
    return [
        InputError(
            f"{label} has a pivot, which {model} cannot hold; {cure}",
            code="pinned",
            argument="pivot",
        )
        for label, vehicle in (("a", a), ("b", b))
        if getattr(vehicle, "pivot", None) is not None
    ]


def _is_complete(body: Any) -> bool:
    return (
        type(body) is Vehicle
        and body.yaw_inertia is not None
        and body.x is not None
        and body.y is not None
    )


def _beyond_a_turn(normal: Any) -> dict[str, Any]:
    """The ``given`` entry of a normal without a unit and beyond a full turn, where degrees may have
    been meant; else empty.
    """
    if isinstance(normal, tuple) or has_unit(normal):
        return {}
    radians: Any = np.array(normal.magnitude if is_quantity(normal) else normal, dtype=np.float64)
    return (
        {"normal": read_only(radians) if radians.ndim else float(radians)}
        if largest(radians) > math.tau
        else {}
    )


def one_rule(names: Iterable[str], given: Iterable[str]) -> str:
    """The refusal of none or several of these names of what friction does, of which one is due."""
    found = " and ".join(f"`{name}=`" for name in given) or "none"
    return (
        f"give exactly one of {', '.join(f'`{name}=`' for name in names)}; got {found}. There is "
        "no default, because it decides cases: `friction=0` is a frictionless contact, "
        "`friction=inf` one that never slips"
    )


def _tangential(reader: ArgumentReader, values: tuple[Any, ...]) -> tuple[str, Any]:
    """The one tangential rule that was given (a friction bound, an impulse ratio or the like), and
    its value.
    """
    taken = dict(zip(RULES.values(), values, strict=False))
    given = [(rule, value) for rule, value in taken.items() if value is not None]
    if len(given) == 1:
        rule, value = given[0]
        return rule.name, reader.number(value, "", rule.name, rule.domain)
    text = one_rule([rule.name for rule in taken], [rule.name for rule, _ in given])
    return FRICTION, reader.refuse(InputError(text, code="one_tangential", argument="friction"))
