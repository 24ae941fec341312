"""The table of the impact models (``MODELS``): the kernel of each, its inputs and settings, and its
assumptions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any

import numpy as np

from ..engine.flattening import flattened, form_of, numbers_of
from ..kernels.central import (
    linear_approximation,
    linear_central,
    oblique_approximation,
    oblique_central,
)
from ..kernels.contact_laws import BRACH, RULES
from ..kernels.eccentric import eccentric
from ..kernels.problem import Body, Contact, Problem
from ..kernels.status import Answer
from ..messages.errors import InputError
from ..quantities.reading import ArgumentReader, amount
from ..quantities.settings import given_with_unit, in_si, units_required
from .inputs import (
    ARGUMENTS,
    PINNED,
    Arguments,
    Inputs,
    first_case,
    problem_of,
    read_inputs,
)
from .time_resolved_inputs import (
    read_contact_time,
    read_lasting,
    read_least_time,
    solve_case_in_time,
)


@dataclass(frozen=True, eq=False, slots=True)
class Model:
    """One model of an impact.

    Parameters
    ----------
    name : str
        That of its solver.
    kernel : callable
        Its formulas.
    takes : Problem, optional
        What the kernel takes of a problem: in place of each number its path into ``Inputs``, such
        as "restitution" or "a.mass"; None for what it does not take. None of a kernel that reads
        the inputs itself.
    ruled : bool
        Whether rule and law are its settings.
    without : frozenset of str
        The arguments of ``solve`` that it does not take and that may be given all the same: what
        comes of leaving them out is predicted, or they have no part in an answer.
    assumptions : str
        As a report says them.
    """

    name: str
    kernel: Callable[..., Any]
    takes: Problem | None
    ruled: bool
    without: frozenset[str]
    assumptions: str

    @property
    def paths(self) -> frozenset[str]:
        """Those in ``takes``."""
        return frozenset() if self.takes is None else frozenset(numbers_of(self.takes))

    def problem(self, inputs: Inputs) -> Problem:
        """What the kernel is given; an unknown position or inertia is filled in so that it makes no
        torque.
        """
        whole = problem_of(inputs)
        found: Problem = whole if self.takes is _WHOLE else _taken(self.takes, whole)
        return found

    def settings(self, inputs: Inputs) -> tuple[Any, ...]:
        """The kernel's settings."""
        return (inputs.rule, inputs.law) if self.ruled else ()

    def answer(self, inputs: Inputs) -> Any:
        """What the kernel answers: of one case, or of all cases of a batch at once."""
        return self.kernel(self.problem(inputs), *self.settings(inputs))

    def beyond(self, inputs: Inputs) -> list[str]:
        """What was given that the model does not take, so that it cannot stand for the impact; a
        pivot is named "pivot".
        """
        names, pinned = _not_taken(self.name, self.without), self.name in PINNED
        if pinned and not names:
            # The model that takes everything, which every single case asks.
            return []
        rule = inputs.rule
        found = [
            name
            for name in names
            if name == rule
            or ((value := getattr(inputs, name, None)) is not None and value is not False)
        ]
        turns = inputs.a.pivot is not None or inputs.b.pivot is not None
        return found if pinned or not turns else ["pivot", *found]


@cache
def _not_taken(name: str, without: frozenset[str]) -> tuple[str, ...]:
    """The arguments of ``solve`` that a model neither takes nor may be left without."""
    allowed = {*ARGUMENTS[name], *without}
    return tuple(name for name in ARGUMENTS["solve"] if name not in allowed)


def _taken(takes: Any, parts: Any) -> Any:
    """The parts of a problem that a model takes, of those that are given."""
    found = [
        None
        if path is None or part is None
        else _taken(path, part)
        if isinstance(path, tuple)
        else part
        for path, part in zip(takes, parts, strict=True)
    ]
    return tuple(found) if type(takes) is tuple else type(takes)(*found)


def _body(label: str) -> Body:
    names = "mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y"
    return Body._make([*(f"{label}.{name}" for name in names), _pair(f"{label}.pivot")])


def _pair(path: str) -> tuple[str, str]:
    return f"{path}[0]", f"{path}[1]"


def _triple(path: str) -> tuple[str, ...]:
    return tuple(f"{path}[{at}]" for at in range(3))


_WHOLE = Problem(
    Contact("restitution", _pair("normal"), "rule_value", _pair("point")),
    _body("a"),
    _body("b"),
    outside=(_triple("outside_a"), _triple("outside_b")),
    contact_velocity=_pair("contact_velocity"),
)
_POINT_MASSES = _WHOLE._replace(
    **{
        label: body._replace(yaw_inertia=None, x=None, y=None, pivot=None)
        for label, body in (("a", _WHOLE.a), ("b", _WHOLE.b))
    },
    contact=_WHOLE.contact._replace(point=None),
    outside=None,
    contact_velocity=None,
)
_LEFT_TO_SOLVE = frozenset({"tolerance", "duration", "drag"})
_PREDICTED = _LEFT_TO_SOLVE | {"point"}

LINEAR, OBLIQUE, ECCENTRIC = MODELS = (
    Model(
        "linear_central",
        linear_central,
        _POINT_MASSES._replace(
            contact=_WHOLE.contact._replace(rule_value=None, point=None),
            # A closing speed only: nothing slips.
            contact_velocity=("contact_velocity[0]", None),
        ),
        False,
        _PREDICTED | {*RULES, "law"},
        "Linear central: momentum along the normal, equation (2), with restitution, which gives "
        "(5) and (6). The vehicles are point masses that move along one line; rotation and "
        "forces along the tangent are left out.",
    ),
    Model(
        "oblique_central",
        oblique_central,
        _POINT_MASSES,
        True,
        _PREDICTED,
        "Oblique central: restitution along the normal, equation (9), friction along the "
        "tangent. The vehicles are point masses; rotation is left out.",
    ),
    Model(
        "eccentric",
        eccentric,
        _WHOLE,
        True,
        _LEFT_TO_SOLVE,
        "Eccentric: momentum and angular momentum, equations (10) to (19), with restitution "
        "along the normal and friction along the tangent at one contact point; free, pinned and "
        "fixed bodies.",
    ),
)
# The models that ``solve`` chooses from: motion that one cannot represent it carries through
# unchanged, as the error of that is predicted.
CANDIDATES = (
    replace(LINEAR, kernel=linear_approximation),
    replace(OBLIQUE, kernel=oblique_approximation),
    ECCENTRIC,
)
TIME_RESOLVED = Model(
    "time_resolved",
    solve_case_in_time,
    None,
    False,
    # It has its own law; an incomplete impact is one by its restitution.
    frozenset({"tolerance", "law", "incomplete"}),
    "Time-resolved: the contact is followed in small steps. A spring along the normal takes up "
    "the approach and gives back the share of its work that the restitution squared says; "
    "Coulomb friction acts along the tangent.",
)
BY_NAME = {model.name: model for model in (*MODELS, TIME_RESOLVED)}


# Those of ``ARGUMENTS`` that ``Arguments`` holds.
_IN_ARGUMENTS = {*RULES, "law", "point"}
# The parts of a problem that not every impact has.
_OPTIONAL = ("a.pivot", "b.pivot", "outside", "contact_velocity")


def variant_of(inputs: Inputs) -> tuple[str, str | None, bool, bool, bool, bool]:
    """What of the inputs decides which operations a kernel does: rule, law, and of each of
    ``_OPTIONAL`` whether it is there. Written out, as every single case asks it.
    """
    outside = inputs.outside_a is not None
    return (
        inputs.rule,
        inputs.law,
        inputs.a.pivot is not None,
        inputs.b.pivot is not None,
        outside,
        inputs.contact_velocity is not None and not outside,
    )


def paths_of(model: Model, rule: str, law: str | None, *there: bool) -> Any:
    """What the kernel takes, as in ``Model.takes``, of what is given in this ``variant_of``."""
    found: Any = model.takes
    for path, given in zip(_OPTIONAL, there, strict=True):
        found = found if given else _without(found, path)
    return found


def _without(parts: Any, path: str) -> Any:
    """The same parts with None at a path."""
    name, _, inner = path.partition(".")
    return parts._replace(**{name: _without(getattr(parts, name), inner) if inner else None})


@cache
def float_function(
    model: Model, *variant: Any, refused: bool = False
) -> Callable[[Mapping[str, Any]], Answer | None]:
    """The kernel of a model compiled for plain floats, of ``vars(inputs)``; None where the kernel
    itself has to decide, which with ``refused`` is hardly anywhere.
    """
    # Like all that not every caller needs, loaded at its first use.
    from ..engine.floats import compiled

    arguments = (paths_of(model, *variant),)
    kernel = flattened(model.kernel, form_of(arguments))
    settings = variant[:2] if model.ruled else ()
    return compiled(kernel, tuple(numbers_of(arguments)), settings, refused)[0]


def model_of(inputs: Inputs) -> Model:
    """The model that the inputs name."""
    return BY_NAME[inputs.model]


def read_eccentric(
    arguments: Arguments,
    duration: Any = None,
    tyres_a: Any = None,
    tyres_b: Any = None,
    **more: Any,
) -> Inputs:
    """Read the arguments of ``eccentric``."""
    if duration is tyres_a is tyres_b is None:
        return read_inputs(ECCENTRIC.name, arguments, **more)
    reader = ArgumentReader()
    times = read_lasting(reader, ECCENTRIC.name, *arguments[:2], duration, (tyres_a, tyres_b))
    inputs = read_inputs(ECCENTRIC.name, arguments, reader.problems, **more)
    times["given"] = {**(inputs.given or {}), **reader.texts} or None
    if vars(inputs).get("shape", ()) is None and _single(times["duration"], tyres_a, tyres_b):
        # Nobody else has these inputs yet, and they stay those of one case.
        vars(inputs).update(times)
        return inputs
    return replace(inputs, **times)


def _single(duration: Any, *tyres: Any) -> bool:
    """Whether a duration and tyres are those of one case."""
    numbers = [value for one in tyres if one is not None for value in one.named.values()]
    return type(duration) is float and not any(isinstance(value, np.ndarray) for value in numbers)


def read_for_solve(
    arguments: Arguments,
    tolerance: Any,
    duration: Any = None,
    drag: Any = None,
    tyres_a: Any = None,
    tyres_b: Any = None,
    **more: Any,
) -> Inputs:
    """Read the arguments of ``solve``."""
    reader = ArgumentReader()
    times = {}
    if not (duration is drag is tyres_a is tyres_b is None):
        times = read_least_time(reader, *arguments[:2], duration, drag, (tyres_a, tyres_b))
    as_it_is = type(tolerance) is float and 0.0 <= tolerance < math.inf
    if not as_it_is or units_required.get():
        tolerance = _read_tolerance(reader, tolerance)
    inputs = read_inputs("solve", arguments, reader.problems, **more)
    # Nobody else has these inputs yet.
    vars(inputs)["tolerance"] = tolerance
    if times:
        texts = {name: text for name, text in reader.texts.items() if name in times}
        inputs = replace(inputs, given={**(inputs.given or {}), **texts} or None, **times)
    return inputs


def _read_time_resolved(arguments: Arguments, **more: Any) -> Inputs:
    a, b, restitution, normal, point, (friction, *_), _ = arguments
    return read_contact_time(a, b, restitution, normal, point, friction, more)


# Each takes what every solver takes, and by name what ``ARGUMENTS`` has of its solver beside that.
_READERS: dict[str, Callable[..., Inputs]] = {
    LINEAR.name: partial(read_inputs, LINEAR.name),
    OBLIQUE.name: partial(read_inputs, OBLIQUE.name),
    ECCENTRIC.name: read_eccentric,
    TIME_RESOLVED.name: _read_time_resolved,
    "solve": read_for_solve,
}


def read_again(inputs: Inputs, found: bool = False, changed: Collection[str] = ()) -> Inputs:
    """Inputs with ``changed`` values, which may be of any form a caller may give; read again like a
    caller's arguments.

    Inputs that a reverse solver ``found`` have a restitution of NaN where it found none.
    """
    tangential = tuple(inputs.rule_value if name == inputs.rule else None for name in RULES)
    e = inputs.restitution
    unknown = found and type(e) is float and e != e
    arguments = (
        inputs.a,
        inputs.b,
        0.0 if unknown else e,
        inputs.normal,
        inputs.point,
        tangential,
        BRACH if inputs.law is None else inputs.law,
    )
    beside = (name for name in ARGUMENTS[inputs.model] if name not in _IN_ARGUMENTS)
    with in_si(but=changed), given_with_unit(inputs.given or {}):
        again = _READERS[inputs.model](
            arguments, **{name: getattr(inputs, name) for name in beside}
        )
    return replace(
        again,
        restitution=e if unknown else again.restitution,
        given={**(again.given or {}), **(inputs.given or {})} or None,
        contact_velocity=inputs.contact_velocity,
    )


def _read_tolerance(reader: ArgumentReader, tolerance: Any) -> Any:
    """The tolerance of ``solve``; for an array, the error names the first element that a single
    call would refuse.
    """
    limit = amount(reader, tolerance, "m/s", "tolerance")
    if (
        isinstance(limit, np.ndarray)
        and limit.size
        and not (limit.min() >= 0.0 and limit.max() < math.inf)
    ):
        at, place = first_case(~np.isfinite(limit) | (limit < 0.0))
        value = float(limit[at])
        code = "negative_speed" if math.isfinite(value) else "not_finite"
        text = (
            f"tolerance must be finite and >= 0 in every case, got {value:g} in {place}; 0 asks "
            "for the full model"
        )
        reader.refuse(InputError(text, code=code, argument="tolerance"))
    return limit
