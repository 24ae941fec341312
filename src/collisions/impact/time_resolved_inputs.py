"""What a contact that takes time needs beyond an impulse: read, and handed with the other inputs to
the kernel.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from ..kernels.contact_laws import BRACH
from ..kernels.elementwise import AT_LEAST_ZERO, POSITIVE_FINITE
from ..kernels.status import Passed, Status
from ..messages.errors import InputError, MissingInputError, ShapeError
from ..quantities.attributes import lock
from ..quantities.directions import from_radians
from ..quantities.reading import ArgumentReader, is_whole
from ..quantities.units import shown
from ..vehicle.drag import GRAVITY, read_drag, read_duration
from .inputs import CRUSH_UNITS, STIFFNESSES, Inputs, body_numbers, read_inputs

Geometry: TypeAlias = Literal["maximum_engagement", "first_contact", "fixed"]
# Of its numbers, those that have to be above 0; the others may be 0.
DOMAINS = {
    "duration": (POSITIVE_FINITE,),
    "stiffness": (POSITIVE_FINITE,),
    "crush_a": (AT_LEAST_ZERO, POSITIVE_FINITE, POSITIVE_FINITE),
    "crush_b": (AT_LEAST_ZERO, POSITIVE_FINITE, POSITIVE_FINITE),
    "drag": (AT_LEAST_ZERO,),
    "wheelbase": (POSITIVE_FINITE,),
    "track": (POSITIVE_FINITE,),
}
# A step of a car's contact is then 2 ms or 1 us.
_FEWEST, _MOST = 10, 100_000
_STEPS = 100
_SIZES = {"wheelbase": 2.7, "track": 1.5}
# Cases of a block; fewer than so many are faster one by one.
_BLOCK, _FEW = 1024, 128
_STIFFNESS = (
    "duration='100 ms', stiffness='800 kN/m', or crush_a=('60 kN/m', '700 kN/m**2', '1.5 m') "
    "with or without crush_b"
)


def read_contact_time(
    a: Any, b: Any, restitution: Any, normal: Any, point: Any, friction: Any, extra: dict[str, Any]
) -> Inputs:
    """The inputs of ``time_resolved``; ``extra`` are those beyond an impulse, by name."""
    reader = ArgumentReader()
    if friction is None:
        text = (
            "friction is None, and time_resolved needs it; there is no default, because it "
            "decides cases: write friction=0.5, or friction=0 for a frictionless contact"
        )
        reader.refuse(MissingInputError(text, code="one_tangential", argument="friction"))
        friction = 0.0
    found = {name: extra[name] for name in ("geometry", "steps")}
    if not isinstance(found["geometry"], str) or found["geometry"] not in get_args(Geometry):
        known = ", ".join(map(repr, get_args(Geometry)))
        text = f"geometry must be one of {known}, got {shown(found['geometry'])}"
        reader.refuse(InputError(text, code="bad_option", argument="geometry"))
    if not is_whole(found["steps"]) or not _FEWEST <= found["steps"] <= _MOST:
        text = (
            f"steps must be a whole number from {_FEWEST} to {_MOST}, got {shown(found['steps'])}"
        )
        reader.refuse(InputError(text, code="bad_option", argument="steps"))
    else:
        found["steps"] = int(found["steps"])
    found |= read_times(
        reader,
        {name: value for name, value in extra.items() if name not in _SIZES or value is not None},
    )
    found = _SIZES | found
    arguments = a, b, restitution, normal, point, (friction, None, None), BRACH
    beside = [
        part
        for name in DOMAINS
        for part in (found[name] if isinstance(found[name], tuple) else (found[name],))
    ]
    inputs = read_inputs("time_resolved", arguments, reader.problems, beside)
    given = {**(inputs.given or {}), **reader.texts} or None
    return replace(inputs, given=given, **found)


def read_least_time(reader: ArgumentReader, duration: Any, drag: Any) -> dict[str, Any]:
    """Duration and drag as ``solve`` takes them, both optional: without a duration there is no
    contact that takes time.
    """
    if duration is None and drag is not None:
        text = (
            f"drag = {shown(drag)} needs a duration, in which the tyres slide; write "
            "duration='100 ms', or leave drag out"
        )
        reader.refuse(InputError(text, code="one_stiffness", argument="duration"))
    given = {
        name: value for name, value in (("duration", duration), ("drag", drag)) if value is not None
    }
    return read_times(reader, given) if "duration" in given else {}


def timed(inputs: Inputs, steps: int = _STEPS) -> Inputs:
    """What ``solve`` was given as inputs of ``time_resolved``."""
    drag: Any = 0.0 if inputs.drag is None else inputs.drag
    own: dict[str, Any] = {"law": None, "tolerance": None, "given": None, "contact_velocity": None}
    own |= {**_SIZES, "geometry": "maximum_engagement"}
    return replace(inputs, model="time_resolved", drag=drag, steps=steps, **own)


def read_times(reader: ArgumentReader, extra: dict[str, Any]) -> dict[str, Any]:
    """The numbers in ``extra`` that say how a contact passes; one kind of stiffness has to be among
    them.
    """
    found: dict[str, Any] = dict.fromkeys(extra.keys() & DOMAINS.keys())
    kinds = [name for name in STIFFNESSES if extra.get(name) is not None]
    if not kinds or (len(kinds) > 1 and kinds != ["crush_a", "crush_b"]):
        text = (
            f"give one of {_STIFFNESS}; got {' and '.join(kinds) or 'none'}. It says how long "
            "the contact takes"
        )
        reader.refuse(InputError(text, code="one_stiffness", argument="duration"))
    for name, domains in DOMAINS.items():
        value = extra.get(name)
        if name not in extra or (value is None and name in STIFFNESSES):
            continue
        if name == "drag":
            found[name] = read_drag(reader, value, name)
        elif name == "duration":
            found[name] = read_duration(reader, value)
            if isinstance(found[name], float) and found[name] == 0.0:
                text = (
                    f"duration must be > 0, got {shown(value)}; a contact that takes no time is "
                    "eccentric's"
                )
                reader.refuse(InputError(text, code="not_positive", argument=name))
        elif name.startswith("crush"):
            found[name] = _read_crush(reader, value, name)
        else:
            found[name] = reader.number(
                value, {"stiffness": "N/m"}.get(name, "m"), name, domains[0]
            )
    return found


def _read_crush(reader: ArgumentReader, value: Any, name: str) -> Any:
    """A, B and the width of a crush stiffness."""
    if not isinstance(value, tuple) or len(value) != 3:
        text = (
            f"{name} must be (A, B, width), such as ('60 kN/m', '700 kN/m**2', '1.5 m'), got "
            f"{shown(value)}"
        )
        return reader.refuse(ShapeError(text, code="bad_shape", argument=name))
    return tuple(
        reader.number(part, unit, f"{name}[{at}]", domain)
        for at, (part, unit, domain) in enumerate(
            zip(value, CRUSH_UNITS, DOMAINS[name], strict=True)
        )
    )


def solve_case_in_time(inputs: Inputs, cut: Callable[[Any], Any] | None = None) -> Passed:
    """Step through one case of plain numbers, every step kept; or through one of a batch, which
    ``cut`` takes from arrays.
    """
    # A twentieth of the import of the package, and impulses need none of it.
    from ..engine.floats import compile_loop
    from ..kernels import time_resolved as kernel

    note: list[tuple[float, ...]] | None = [] if cut is None else None
    try:
        found = kernel.time_resolved(
            **_arguments(inputs, cut or (lambda value: value)),
            run=partial(kernel.float_run, compiled=compile_loop),
            note=note,
        )
    except ArithmeticError:
        return Passed(Status.OUT_OF_RANGE)
    lock(found.history)
    return found


def solve_cases_in_time(inputs: Inputs, cases: Any, progress: Any) -> Passed:
    """Step through the cases of a batch, in blocks or, if they are few, one by one; a refused one
    is NaN.
    """
    from ..engine.blocks import each_block, flat
    from ..kernels import time_resolved as kernel

    shape, size = cases.shape, cases.size
    kinds = {"status": np.dtype(np.uint8), "sticks": np.dtype(np.bool_)}
    names = [name for name in Passed._fields if name != "history"]
    outputs = {name: np.empty(size, kinds.get(name, cases.dtype)) for name in names}
    length = 1 if size <= _FEW else _BLOCK

    def solve(start: int) -> int:
        block = slice(start, min(start + length, size))

        def cut(value: Any) -> Any:
            if not isinstance(value, np.ndarray):
                return value
            return (
                float(flat(value, shape)[start])
                if length == 1
                else flat(value, shape)[block].astype(np.float64)
            )

        with np.errstate(all="ignore"):
            faults = [check.fault(*map(cut, check.values)) for check in reversed(cases.checks)]
            if length > 1:
                found = kernel.time_resolved(**_arguments(inputs, cut), run=kernel.block_run)
            elif any(faults):
                found = Passed(Status.OK)
            else:
                found = solve_case_in_time(inputs, cut)
            for name in names:
                outputs[name][block] = getattr(found, name)
            status = outputs["status"][block]
            for fault in faults:
                np.copyto(status, fault, where=np.not_equal(fault, Status.OK), casting="unsafe")
            if cases.dtype == np.float32:
                beyond = np.logical_or.reduce(
                    [np.isinf(outputs[name][block]) for name in names[1:]]
                )
                status[beyond & (status == Status.OK)] = Status.OUT_OF_RANGE
        refused = status > Status.ENERGY_GAIN
        for name in names[1:]:
            outputs[name][block][refused] = False if name == "sticks" else np.nan
        return len(status)

    each_block(solve, range(0, size, length), size, cases.threads, progress)
    return Passed(**{name: lock(output.reshape(shape)) for name, output in outputs.items()})


def _arguments(inputs: Inputs, cut: Any) -> dict[str, Any]:
    """The arguments of the kernel; ``cut`` takes those of a block from every array."""
    from ..kernels import time_resolved as kernel

    contact = inputs.point or (0.0, 0.0)
    kind = (
        "duration"
        if inputs.duration is not None
        else "stiffness"
        if inputs.stiffness is not None
        else "crush"
    )
    if kind == "crush":
        parts = []
        for crush in (inputs.crush_a, inputs.crush_b):
            force, growth, width = (math.inf, math.inf, 1.0) if crush is None else map(cut, crush)
            parts += [force * width, growth * width]
        stiffness: tuple[Any, ...] = tuple(parts)
    else:
        stiffness = (cut(inputs.duration if kind == "duration" else inputs.stiffness),)
    bodies = []
    for body in (inputs.a, inputs.b):
        heading = None if body.heading is None else from_radians(cut(body.heading))
        bodies.append((*map(cut, body_numbers(body, inputs.point)[:7]), heading))
    wheels = (kernel.wheels_of(body.heading, inputs.drag) for body in (inputs.a, inputs.b))
    return {
        "restitution": cut(inputs.restitution),
        "normal": tuple(map(cut, inputs.normal)),
        "friction": cut(inputs.rule_value),
        "point": tuple(map(cut, contact)),
        "deceleration": cut(inputs.drag) * GRAVITY,
        "wheelbase": cut(inputs.wheelbase),
        "track": cut(inputs.track),
        "stiffness": stiffness,
        "bodies": tuple(bodies),
        "settings": kernel.Settings(
            inputs.geometry or "maximum_engagement", inputs.steps or _STEPS, kind, *wheels
        ),
    }
