"""What a contact that takes time needs beyond an impulse: read, and handed with the other inputs to
the kernel.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from ..kernels.contact_laws import BRACH
from ..kernels.elementwise import AT_LEAST_ZERO, POSITIVE_FINITE, select
from ..kernels.status import Answer, Passed, Status, WithTyres
from ..messages.errors import InputError, MissingInputError, NoImpactError, ShapeError
from ..quantities.attributes import read_only
from ..quantities.directions import from_radians
from ..quantities.reading import ArgumentReader, is_whole, warn_if_large, warn_if_small
from ..quantities.tables import said
from ..quantities.units import shown
from ..vehicle.drag import GRAVITY, read_drag, read_duration
from ..vehicle.tyres import LARGEST, Tyres, kernel_numbers, not_tyres
from ..vehicle.vehicle import Vehicle, error_of_missing
from .inputs import (
    CRUSH_UNITS,
    NO_IMPULSE,
    OUTSIDE,
    STIFFNESSES,
    TYRES,
    Inputs,
    body_numbers,
    named_numbers,
    read_inputs,
)
from .pulse import passed

Geometry: TypeAlias = Literal["maximum_engagement", "first_contact", "fixed"]
# Domains of its numbers: some have to be above 0, and the others may be 0.
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
# In metres: no damage is so wide, so a bare number beyond is in another unit.
WIDEST_DAMAGE = 10.0
# A and B in N/m and N/m**2: any car has about ten times as much, and the numbers of tables in
# pounds and inches, or in N/cm, are below.
_SOFTEST = 1e3, 1e4
# In N/m, of both vehicles together: cars have above ten times as much, and numbers meant in kN/m or
# lbf/in are below.
_SOFTEST_SPRING = 1e4
_TABLES = ("lbf/in", "N/cm"), ("lbf/in**2", "N/cm**2")
# Cases of a block; fewer than so many are faster one by one.
_BLOCK, _FEW = 1024, 128
_STIFFNESS = (
    "`duration='100 ms'`, `stiffness='800 kN/m'`, or `crush_a=('60 kN/m', '700 "
    "kN/m**2', '1.5 m')` with or without crush_b"
)


def read_contact_time(
    a: Any, b: Any, restitution: Any, normal: Any, point: Any, friction: Any, extra: dict[str, Any]
) -> Inputs:
    """The inputs of ``time_resolved``; ``extra`` are those beyond an impulse, by name."""
    reader = ArgumentReader()
    if friction is None:
        text = (
            "friction `|is None|is not given`, and time_resolved needs it; there is "
            "no default, because it decides cases: write `friction=0.5`, or "
            "`friction=0` for a frictionless contact"
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
    found |= read_tyres(reader, "time_resolved", a, b, extra)
    times = {
        name: value for name, value in extra.items() if name not in _SIZES or value is not None
    }
    if found["tyres_a"] is None and found["tyres_b"] is None:
        found |= _SIZES
    elif times["drag"] is None or (type(times["drag"]) is float and times["drag"] == 0.0):
        del times["drag"]
    found |= read_times(reader, times)
    arguments = a, b, restitution, normal, point, (friction, None, None), BRACH
    given_numbers = [found.get(name) for name in DOMAINS]
    beside = [
        part
        for value in given_numbers
        for part in (value if isinstance(value, tuple) else (value,))
    ]
    beside += [
        part
        for label in "ab"
        if found[f"tyres_{label}"]
        for part in found[f"tyres_{label}"].named.values()
    ]
    inputs = read_inputs("time_resolved", arguments, reader.problems, beside)
    given = {**(inputs.given or {}), **reader.texts} or None
    return replace(inputs, given=given, **found)


def read_tyres(
    reader: ArgumentReader, model: str, a: Any, b: Any, extra: dict[str, Any]
) -> dict[str, Any]:
    """The tyres of both vehicles, where given; they stand in place of a drag, and their wheels
    along the heading.
    """
    found: dict[str, Any] = {}
    for label, vehicle in (("a", a), ("b", b)):
        name = f"tyres_{label}"
        found[name] = extra.get(name)
        if found[name] is None:
            continue
        if not isinstance(found[name], Tyres):
            reader.refuse(not_tyres(name, found[name]))
            found[name] = None
        elif (
            isinstance(vehicle, Vehicle)
            and vehicle.heading is None
            and not np.all(np.isinf(vehicle.mass))
        ):
            reader.refuse(error_of_missing(vehicle, "heading", f"{model} with {name}", label))
    stray = {name: extra.get(name) for name in ("drag", *_SIZES)}
    stray = {
        name: given
        for name, given in stray.items()
        if not (given is None or (type(given) is float and given == 0.0))
    }
    if stray and any(tyres is not None for tyres in found.values()):
        text = (
            f"give {' and '.join(stray)} or tyres, not both: tyres_a and tyres_b have friction, "
            "braking, wheelbase and track of the wheels of each vehicle; one without tyres is "
            "not held"
        )
        reader.refuse(InputError(text, code="bad_combination", argument=next(iter(stray))))
    return found


def read_least_time(
    reader: ArgumentReader, a: Any, b: Any, duration: Any, drag: Any, tyres: tuple[Any, Any]
) -> dict[str, Any]:
    """Duration and drag or tyres as ``solve`` takes them, all optional: without a duration no
    contact takes time.
    """
    found = read_tyres(
        reader, "solve", a, b, {**dict(zip(TYRES, tyres, strict=True)), "drag": drag}
    )
    if duration is None:
        what = f"drag = {shown(drag)} needs" if drag is not None else "tyres need"
        text = (
            f"{what} a duration, in which the tyres act; write `duration='100 ms'`, or "
            "leave them out"
        )
        reader.refuse(InputError(text, code="one_stiffness", argument="duration"))
    given = {
        name: value for name, value in (("duration", duration), ("drag", drag)) if value is not None
    }
    return found | (read_times(reader, given) if "duration" in given else {})


def timed(inputs: Inputs, steps: int = _STEPS) -> Inputs:
    """What ``solve`` was given as inputs of ``time_resolved``."""
    drag: Any = 0.0 if inputs.drag is None and not inputs.tyres else inputs.drag
    own: dict[str, Any] = {"law": None, "tolerance": None, "given": None, "contact_velocity": None}
    own |= {**({} if inputs.tyres else _SIZES), "geometry": "maximum_engagement"}
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
            found[name] = read_duration(
                reader, value, "a contact that takes no time is eccentric's"
            )
        elif name.startswith("crush"):
            found[name] = _read_crush(reader, value, name)
        else:
            found[name] = reader.number(
                value, {"stiffness": "N/m"}.get(name, "m"), name, domains[0]
            )
            if name == "stiffness":
                meaning = "N/m, softer than any car"
                warn_if_small(value, found[name], _SOFTEST_SPRING, name, meaning, "kN/m", "lbf/in")
            if name in LARGEST:
                warn_if_large(value, found[name], LARGEST[name], name, "metres", "cm", "in")
    return found


def _read_crush(reader: ArgumentReader, value: Any, name: str) -> Any:
    """A, B and the width of a crush stiffness."""
    if not isinstance(value, tuple) or len(value) != 3:
        text = (
            f"{name} must be `(A, B, width)`, such as `('60 kN/m', '700 kN/m**2', '1.5 "
            f"m')`, got {shown(value)}"
        )
        return reader.refuse(ShapeError(text, code="bad_shape", argument=name))
    found = tuple(
        reader.number(part, unit, f"{name}[{at}]", domain)
        for at, (part, unit, domain) in enumerate(
            zip(value, CRUSH_UNITS, DOMAINS[name], strict=True)
        )
    )
    warn_if_soft(value[:2], found[:2], (f"{name}[0]", f"{name}[1]"))
    warn_if_large(value[2], found[2], WIDEST_DAMAGE, f"{name}[2]", "metres of width", "cm", "in")
    return found


def warn_if_soft(given: Sequence[Any], read: Sequence[Any], names: Sequence[str]) -> None:
    """Warns of crush stiffness coefficients A and B without a unit, if no car has as small ones."""
    for value, number, limit, name, unit, others in zip(
        given, read, _SOFTEST, names, CRUSH_UNITS, _TABLES, strict=False
    ):
        warn_if_small(value, number, limit, name, f"{unit}, softer than any car", *others)


def crushes(inputs: Inputs) -> dict[str, tuple[Any, ...]]:
    """A, B and width of the crush stiffness, by vehicle, "a" and "b", of those that have one."""
    found = {"a": inputs.crush_a, "b": inputs.crush_b}
    return {label: crush for label, crush in found.items() if crush is not None}


def residual_crushes(inputs: Inputs, peak_force: Any) -> dict[str, Any]:
    """Crush that is left, by vehicle, in CRASH's meaning: 0 where the largest crush was not
    beyond A/B.
    """
    found = {}
    for label, (begins, growth, width) in crushes(inputs).items():
        left = (peak_force / width - begins) / growth
        # 0 without a sign, and NaN where there is no answer.
        found[label] = select(left > 0.0, left, abs(0.0 * left))
    return found


def wheels_numbers(inputs: Inputs, label: str, cut: Callable[[Any], Any]) -> Any:
    """The tyres of a vehicle as the kernels take them; where there is only a drag, those of wheels
    that slide.
    """
    from ..kernels.tyre import Tyres as Numbers

    tyres = getattr(inputs, f"tyres_{label}")
    if tyres is not None:
        return tyres_numbers(tyres, cut)
    drag, *sizes = (
        0.0 if one is None else cut(one) for one in (inputs.drag, inputs.wheelbase, inputs.track)
    )
    return Numbers((1.0,) * 4, drag, 0.0, *(0.5 * size for size in sizes))


def tyres_numbers(tyres: Tyres, cut: Callable[[Any], Any]) -> Any:
    """These tyres as the kernels take them."""
    named = {name: cut(value) for name, value in tyres.named.items()}
    return kernel_numbers(
        named, np if any(isinstance(value, np.ndarray) for value in named.values()) else math
    )


def wheels_that_roll(tyres: Tyres) -> Any:
    """The settings of the kernel for these tyres."""
    from ..kernels.contact_step import Rolling

    return Rolling(tyres.steered, tyres.transfers)


def with_tyres(inputs: Inputs, solve: Callable[[Inputs, bool], Any]) -> Any:
    """The answer of an impulse, with that of the tyres during its contact as one from outside.

    Solved twice: without the tyres for the motion before and after, between which their force is
    taken, and with what they give. ``solve`` solves inputs, quietly or not.
    """
    bare = _alike(inputs, tyres_a=None, tyres_b=None, duration=None, given=None)
    first = solve(bare, True)
    pushes = {label: held_impulse(inputs, first, label) for label in "ab"}
    with np.errstate(all="ignore"):
        # A case that has no answer without tyres is refused for that.
        refused = first.status > Status.ENERGY_GAIN
        outside: dict[str, Any] = {
            name: tuple(
                own + select(refused, 0.0, more)
                for own, more in zip(
                    getattr(inputs, name) or NO_IMPULSE, pushes[name[-1]], strict=True
                )
            )
            for name in OUTSIDE
        }
        if inputs.shape is not None:
            # As precise as what they are worked out from, and one for each case also where only
            # the tyres of a barrier differ.
            from ..quantities.precision import precision

            dtype = precision(named_numbers(inputs).values())
            outside = {
                name: tuple(
                    np.broadcast_to(np.asarray(part, dtype), inputs.shape) for part in parts
                )
                for name, parts in outside.items()
            }
    try:
        raw = solve(_alike(inputs, tyres_a=None, tyres_b=None, duration=None, **outside), False)
    except NoImpactError as error:
        if inputs.shape is not None or first.status > Status.ENERGY_GAIN:
            raise
        speed = said(first.closing_speed, "speed", inputs.texts)
        raise NoImpactError(
            f"no impact: the vehicles approach at {speed}, and their tyres, by their mean force "
            "over the duration, would part them before: follow the contact in time, by "
            "time_resolved",
            code=error.code,
            closing_speed=first.closing_speed,
        ) from None
    with np.errstate(all="ignore"):
        return beside_tyres(inputs, raw, pushes)


def beside_tyres(inputs: Inputs, raw: Any, pushes: Mapping[str, tuple[Any, Any, Any]]) -> Any:
    """The answer with what the tyres did in it: their impulses, moments and losses."""
    found: dict[str, Any] = {}
    answered = 0.0 * raw.normal_impulse
    for label, body, (dvx, dvy, dw) in (
        ("a", inputs.a, (raw.delta_vx_a, raw.delta_vy_a, raw.delta_yaw_rate_a)),
        ("b", inputs.b, (raw.delta_vx_b, raw.delta_vy_b, raw.delta_yaw_rate_b)),
    ):
        x, y, yaw = (part + answered for part in pushes[label])
        found[f"tyre_impulse_x_{label}"] = x
        found[f"tyre_impulse_y_{label}"] = y
        found[f"tyre_moment_{label}"] = yaw
        means = body.vx + 0.5 * dvx, body.vy + 0.5 * dvy, body.yaw_rate + 0.5 * dw
        found[f"tyre_loss_{label}"] = answered - (x * means[0] + y * means[1] + yaw * means[2])
    if inputs.shape is not None:
        found = {name: np.asarray(value, raw.delta_vx_a.dtype) for name, value in found.items()}
    # A single Answer has its fields in this order.
    if isinstance(raw, Answer):
        return WithTyres(*raw, **found)
    return WithTyres(*(getattr(raw, name) for name in Answer._fields), **read_only(found))


def _alike(inputs: Inputs, **changes: Any) -> Inputs:
    """The inputs with some changed; a single case stays one."""
    other = replace(inputs, **changes)
    if inputs.shape is None:
        vars(other)["shape"] = None
    return other


def held_impulse(
    inputs: Inputs, answer: Any, label: str, stops: float | None = None
) -> tuple[Any, Any, Any]:
    """Impulse of the tyres of one vehicle during the contact, and its moment about the centre of
    mass; ``stops`` as for ``kernels.held``, where not as always.
    """
    tyres, body = inputs.tyres.get(label), getattr(inputs, label)
    if tyres is None or body.heading is None:
        return NO_IMPULSE
    changes = [getattr(answer, f"delta_{name}_{label}") for name in ("vx", "vy", "yaw_rate")]
    if inputs.shape is None:
        half = passed(inputs.restitution, 0.5)
    else:
        # Refused cases of a batch are looked at like all others.
        with np.errstate(all="ignore"):
            half = passed(inputs.restitution, 0.5)
    return impulse_of(
        tyres,
        (body.mass, body.heading),
        (body.vx, body.vy, body.yaw_rate),
        changes,
        (half, inputs.duration),
        single=inputs.shape is None,
        stops=stops,
    )


def impulse_of(
    tyres: Tyres,
    body: tuple[Any, Any],
    before: Sequence[Any],
    changes: Sequence[Any],
    times: tuple[Any, Any],
    *,
    single: bool,
    stops: float | None = None,
) -> tuple[Any, Any, Any]:
    """The same from mass and heading of a body, its motion before and what the contact changes of
    it, and of the times the share of the change at half of the duration, and that.
    """
    from ..kernels import held as kernel

    mass, heading = body
    numbers = [mass, *from_radians(heading), *before, *changes, *times, GRAVITY]
    numbers.append(kernel.STOPS if stops is None else stops)
    if single:
        own = kernel_numbers(tyres.named)
    else:
        # Here too.
        with np.errstate(all="ignore"):
            own = tyres_numbers(tyres, lambda value: value)
    numbers += [*own.locks, *own[1:]]
    settings = tyres.steered, tyres.transfers
    found = _held_function(*settings)(numbers) if single else None
    if found is None:
        with np.errstate(all="ignore"):
            found = kernel.held(
                *(value if single else np.asarray(value, np.float64) for value in numbers),
                *settings,
            )
    return tuple(found)


@lru_cache(maxsize=8)
def _held_function(steered: bool, transfers: bool) -> Callable[[Any], Any]:
    """``held`` compiled for plain floats."""
    from ..engine.floats import compile_for_floats
    from ..kernels.held import NUMBERS, held

    return compile_for_floats(held, tuple(f"[{at}]" for at in range(NUMBERS)), (steered, transfers))


def read_lasting(
    reader: ArgumentReader,
    model: str,
    a: Any,
    b: Any,
    duration: Any,
    tyres: tuple[Any, Any],
    otherwise: str = ", or use time_resolved",
) -> dict[str, Any]:
    """Duration and tyres of an impulse with those of its wheels: both, or neither. ``otherwise`` is
    what to do instead of giving tyres.
    """
    given = dict(zip(TYRES, tyres, strict=True))
    found = read_tyres(reader, model, a, b, given)
    if duration is None:
        text = "tyres need a duration, over which they act; write `duration='100 ms'`"
        reader.refuse(MissingInputError(text, code="one_stiffness", argument="duration"))
        return found
    if all(one is None for one in tyres):
        text = (
            f"{model} takes a duration for tyres_a and tyres_b alone, and neither was given; "
            f"give travel.Tyres{otherwise}"
        )
        reader.refuse(InputError(text, code="bad_combination", argument="duration"))
    return found | read_times(reader, {"duration": duration})


def solve_case_in_time(inputs: Inputs, cut: Callable[[Any], Any] | None = None) -> Passed:
    """Step through one case of plain numbers, every step kept; or through one of a batch, which
    ``cut`` takes from arrays.
    """
    if cut is not None:
        return follow_case(inputs, cut, None)
    from ..kernels.time_resolved import Noted
    from .recorded import curve_of, motions_of, own_axes, start_of

    rows = Noted()
    found = follow_case(inputs, lambda value: value, rows)
    if found.history is not None:
        motions = motions_of(rows, found, start_of(inputs, lambda value: value))
        own = [
            part
            for label, body in (("a", inputs.a), ("b", inputs.b))
            for part in (
                (None, None)
                if body.heading is None
                else own_axes(curve_of(motions, label, found.engaged_time), body.heading)
            )
        ]
        found = found._replace(history=(*found.history, *own))
    read_only(found.history)
    return found


def follow_case(inputs: Inputs, cut: Callable[[Any], Any], rows: Any) -> Passed:
    """Step through one case; ``rows`` keeps what moved in every step."""
    # A twentieth of the import of the package, and impulses need none of it.
    from ..engine.float_loops import compile_loop
    from ..kernels import time_resolved as kernel

    try:
        return kernel.time_resolved(
            **kernel_arguments(inputs, cut),
            run=partial(kernel.float_run, compiled=compile_loop),
            note=rows,
        )
    except ArithmeticError:
        return Passed(Status.OUT_OF_RANGE)


def solve_cases_in_time(inputs: Inputs, cases: Any, progress: Any) -> Passed:
    """Step through the cases of a batch, in blocks or, if they are few, one by one; a refused one
    is NaN.
    """
    from ..engine.blocks import each_block, flat
    from ..engine.float_loops import compile_loop
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
                found = kernel.time_resolved(
                    **kernel_arguments(inputs, cut),
                    run=partial(kernel.block_run, compiled=compile_loop),
                )
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
    return Passed(**{name: read_only(output.reshape(shape)) for name, output in outputs.items()})


def kernel_arguments(inputs: Inputs, cut: Any) -> dict[str, Any]:
    """The arguments of the kernel; ``cut`` takes those of a block from every array."""
    from ..kernels import time_resolved as kernel

    contact = inputs.point or (0.0, 0.0)
    spring = cut(inputs.stiffness if inputs.duration is None else inputs.duration)
    if spring is None:
        # The force is the same on both, so that what each gives way adds up.
        growths = [
            growth * width
            for _, growth, width in (map(cut, crush) for crush in crushes(inputs).values())
        ]
        spring = growths[0] if len(growths) == 1 else growths[0] / (1.0 + growths[0] / growths[1])
    bodies = []
    for body in (inputs.a, inputs.b):
        heading = None if body.heading is None else from_radians(cut(body.heading))
        bodies.append((*map(cut, body_numbers(body, inputs.point)[:7]), heading))
    wheels = [
        kernel.wheels_of(body.heading, 0.0 if inputs.drag is None else inputs.drag)
        if tyres is None
        else wheels_that_roll(tyres)
        for body, tyres in ((inputs.a, inputs.tyres_a), (inputs.b, inputs.tyres_b))
    ]
    return {
        "restitution": cut(inputs.restitution),
        "normal": tuple(map(cut, inputs.normal)),
        "friction": cut(inputs.rule_value),
        "point": tuple(map(cut, contact)),
        "gravity": GRAVITY,
        "tyres": tuple(wheels_numbers(inputs, label, cut) for label in "ab"),
        "spring": spring,
        "bodies": tuple(bodies),
        "settings": kernel.Settings(
            inputs.geometry or "maximum_engagement",
            inputs.steps or _STEPS,
            inputs.duration is not None,
            *wheels,
        ),
    }
