"""The table of the impact models (``MODELS``): the kernel of each, its inputs and settings, and its
assumptions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

from ..kernels.central import from_closing_speed, linear_central, oblique_central
from ..kernels.contact_laws import BRACH, RULES
from ..kernels.eccentric import eccentric, from_contact_velocity, with_outside
from ..kernels.status import Answer
from ..messages.errors import InputError
from ..quantities.reading import ArgumentReader, amount
from ..quantities.settings import in_si
from .inputs import OUTSIDE, TYRES, Arguments, Inputs, body_numbers, first_case, read_inputs
from .time_resolved_inputs import (
    DOMAINS,
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
    takes : tuple of str
        Paths into ``Inputs`` of the kernel's arguments, in their order, such as "restitution" or
        "a.mass".
    options : callable
        The kernel's settings (rule, law, flags) from what ``kind_of`` gives.
    assumptions : str
        As a report says them.
    """

    name: str
    kernel: Callable[..., Any]
    takes: tuple[str, ...]
    options: Callable[..., tuple[Any, ...]]
    assumptions: str

    def settings(self, inputs: Inputs, carrying: bool) -> tuple[Any, ...]:
        """The kernel's settings; see ``kind_of``."""
        return self.options(*kind_of(inputs, carrying))

    def numbers(self, inputs: Inputs) -> tuple[Any, ...]:
        """The kernel's arguments; an unknown position or inertia is filled in so that it makes no
        torque.
        """
        found = [
            inputs.restitution,
            *inputs.normal,
            inputs.rule_value,
            *(inputs.point or (0.0, 0.0)),
        ]
        for body in (inputs.a, inputs.b):
            found += body_numbers(body, inputs.point)
        if inputs.outside_a is not None and inputs.outside_b is not None:
            found += (math.nan, math.nan, *inputs.outside_a, *inputs.outside_b)
        elif inputs.contact_velocity is not None:
            found += inputs.contact_velocity
        return tuple(map(found.__getitem__, map(_ALL.__getitem__, self.takes)))


_BODY = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y", "pivot[0]", "pivot[1]")
_CONTACT = ("restitution", "normal[0]", "normal[1]", "rule_value", "point[0]", "point[1]")
_VELOCITY = ("contact_velocity[0]", "contact_velocity[1]")
_OUTSIDE = tuple(f"outside_{label}[{i}]" for label in "ab" for i in range(3))
_OF_BODIES = (f"{label}.{name}" for label in "ab" for name in _BODY)
_ALL = {name: index for index, name in enumerate((*_CONTACT, *_OF_BODIES, *_VELOCITY, *_OUTSIDE))}
_POINT_MASS = ("mass", "vx", "vy", "yaw_rate")


def _takes(*contact: str, body: tuple[str, ...]) -> tuple[str, ...]:
    return (
        "restitution",
        "normal[0]",
        "normal[1]",
        *contact,
        *(f"{label}.{name}" for label in "ab" for name in body),
    )


LINEAR, OBLIQUE, ECCENTRIC = MODELS = (
    Model(
        "linear_central",
        linear_central,
        _takes(body=_POINT_MASS),
        lambda rule, law, pinned_a, pinned_b, carrying: (carrying,),
        "Linear central: momentum along the normal, equation (2), with restitution, which gives "
        "(5) and (6). The vehicles are point masses that move along one line; rotation and "
        "forces along the tangent are left out.",
    ),
    Model(
        "oblique_central",
        oblique_central,
        _takes("rule_value", body=_POINT_MASS),
        lambda rule, law, pinned_a, pinned_b, carrying: (rule, law, carrying),
        "Oblique central: restitution along the normal, equation (9), friction along the "
        "tangent. The vehicles are point masses; rotation is left out.",
    ),
    Model(
        "eccentric",
        eccentric,
        _takes("rule_value", "point[0]", "point[1]", body=_BODY),
        lambda rule, law, pinned_a, pinned_b, carrying: (rule, law, pinned_a, pinned_b),
        "Eccentric: momentum and angular momentum, equations (10) to (19), with restitution "
        "along the normal and friction along the tangent at one contact point; free, pinned and "
        "fixed bodies.",
    ),
)
TIME_RESOLVED = Model(
    "time_resolved",
    solve_case_in_time,
    (),
    lambda *kind: (),
    "Time-resolved: the contact is followed in small steps. A spring along the normal takes up "
    "the approach and gives back the share of its work that the restitution squared says; "
    "Coulomb friction acts along the tangent, tyres act on the ground, and places and normal "
    "move with the vehicles.",
)
BY_NAME = {model.name: model for model in (*MODELS, TIME_RESOLVED)}
# For reverse solvers, which find the closing speed and the slip to more digits than the rounded
# motions hold.
_FROM_CONTACT_VELOCITY = BY_NAME | {
    LINEAR.name: replace(
        LINEAR, kernel=from_closing_speed, takes=("contact_velocity[0]", *LINEAR.takes)
    ),
    ECCENTRIC.name: replace(
        ECCENTRIC,
        kernel=from_contact_velocity,
        takes=(*_VELOCITY, *ECCENTRIC.takes),
    ),
}
_WITH_OUTSIDE = replace(ECCENTRIC, kernel=with_outside, takes=(*_OUTSIDE, *ECCENTRIC.takes))


def kind_of(inputs: Inputs, carrying: bool) -> tuple[str, str | None, bool, bool, bool]:
    """Rule, law, whether A and B are pinned, and whether motion outside the model is carried
    through, as ``solve`` does.
    """
    return inputs.rule, inputs.law, inputs.a.pivot is not None, inputs.b.pivot is not None, carrying


@cache
def float_function(model: Model, *kind: Any) -> Callable[[Mapping[str, Any]], Answer | None]:
    """The kernel of a model compiled for plain floats, of ``vars(inputs)``; None where the kernel
    itself has to decide.
    """
    # Like all that not every caller needs, loaded at its first use.
    from ..engine.floats import compile_for_floats

    return compile_for_floats(model.kernel, model.takes, model.options(*kind))


def model_of(inputs: Inputs) -> Model:
    """The model that the inputs name; in the form that starts from the contact velocity where a
    reverse solver found it.
    """
    table = BY_NAME if inputs.contact_velocity is None else _FROM_CONTACT_VELOCITY
    return in_form(table[inputs.model], inputs)


def in_form(model: Model, inputs: Inputs) -> Model:
    """The model, in the form that takes impulses from outside where there are some; only the
    eccentric one can hold them.
    """
    return model if inputs.outside_a is None else _WITH_OUTSIDE


def read_lasting_impulse(
    arguments: Arguments, duration: Any, tyres: tuple[Any, Any], **more: Any
) -> Inputs:
    """Read the arguments of ``eccentric`` with tyres."""
    reader = ArgumentReader()
    times = read_lasting(reader, ECCENTRIC.name, *arguments[:2], duration, tyres)
    inputs = read_inputs(ECCENTRIC.name, arguments, reader.problems, **more)
    return replace(inputs, given={**(inputs.given or {}), **reader.texts} or None, **times)


def read_for_solve(
    arguments: Arguments,
    tolerance: Any,
    duration: Any,
    drag: Any,
    tyres: tuple[Any, Any],
    **more: Any,
) -> Inputs:
    """Read the arguments of ``solve``."""
    reader = ArgumentReader()
    times = {}
    if not (duration is None and drag is None and tyres == (None, None)):
        times = read_least_time(reader, *arguments[:2], duration, drag, tyres)
    if not (type(tolerance) is float and 0.0 <= tolerance < math.inf):
        tolerance = _read_tolerance(reader, tolerance)
    inputs = read_inputs("solve", arguments, reader.problems, **more)
    # Nobody else has these inputs yet.
    vars(inputs)["tolerance"] = tolerance
    if times:
        texts = {name: text for name, text in reader.texts.items() if name in times}
        inputs = replace(inputs, given={**(inputs.given or {}), **texts} or None, **times)
    return inputs


def read_again(inputs: Inputs, found: bool = False) -> Inputs:
    """Inputs with changed values, which may be of any form a caller may give; read again like a
    caller's arguments.

    Inputs that a reverse solver ``found`` have a restitution of NaN where it found none.
    """
    tangential = tuple(inputs.rule_value if name == inputs.rule else None for name in RULES)
    e = inputs.restitution
    unknown = found and type(e) is float and e != e
    contact = 0.0 if unknown else e, inputs.normal, inputs.point
    more = {name: getattr(inputs, name) for name in ("incomplete", *OUTSIDE)}
    arguments = (
        inputs.a,
        inputs.b,
        *contact,
        tangential,
        BRACH if inputs.law is None else inputs.law,
    )
    tyres = inputs.tyres_a, inputs.tyres_b
    with in_si():
        if inputs.model == TIME_RESOLVED.name:
            extra = {
                name: getattr(inputs, name) for name in (*DOMAINS, *TYRES, "geometry", "steps")
            }
            again = read_contact_time(inputs.a, inputs.b, *contact, inputs.rule_value, extra)
        elif inputs.model == "solve":
            again = read_for_solve(
                arguments, inputs.tolerance, inputs.duration, inputs.drag, tyres, **more
            )
        elif inputs.model == ECCENTRIC.name and (
            tyres != (None, None) or inputs.duration is not None
        ):
            again = read_lasting_impulse(arguments, inputs.duration, tyres, **more)
        else:
            again = read_inputs(inputs.model, arguments, **more)
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
