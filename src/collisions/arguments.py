"""The arguments the solvers share: read and checked."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

from .directions import direction, from_radians
from .door import FINITE, NOT_NEGATIVE, UNIT_INTERVAL, Door, largest
from .errors import InputError
from .fields import lock
from .kernels import codes
from .units import has_unit, is_quantity, shown
from .vehicle import Vehicle, not_a_vehicle

Law: TypeAlias = Literal["brach", "kudlich-slibar"]
OnFailure: TypeAlias = Literal["raise", "nan"]

# A NamedTuple made from a tuple costs a third of one made from arguments.
_as_read: Callable[..., Read] = tuple.__new__
_ALONG_X = (1.0, 0.0)
TANGENTIAL_DOMAINS = {codes.FRICTION: NOT_NEGATIVE, codes.IMPULSE_RATIO: FINITE, codes.CRITICAL_FRACTION: UNIT_INTERVAL}


class Read(NamedTuple):
    """The shared arguments as numbers; ``plain`` if all of them are floats, ``given`` as for ``Asked``."""

    restitution: Any
    normal: tuple[Any, Any]
    rule: str
    bound: Any
    point: tuple[Any, Any] | None
    plain: bool
    given: dict[str, Any] | None


def read(
    a: Vehicle,
    b: Vehicle,
    restitution: Any,
    normal: Any,
    point: Any,
    friction: Any,
    impulse_ratio: Any,
    critical_fraction: Any,
    law: Any,
    known: Sequence[InputError] = (),
    beside: Iterable[Any] = (),
) -> Read:
    """The shared arguments as numbers. What the door would hand on unchanged passes at once; the door names what is wrong.

    ``beside`` has the numbers of the question that are not among these arguments.
    """
    if (
        type(a) is type(b) is Vehicle
        and type(restitution) is float
        and 0.0 <= restitution <= 1.0
        and type(friction) is float
        and friction >= 0.0
        and impulse_ratio is critical_fraction is None
        and type(law) is str
        and (law == codes.BRACH or law == codes.KUDLICH_SLIBAR)
        and not known
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
        if type(normal) is float and normal == 0.0:
            return _as_read(Read, (restitution, _ALONG_X, codes.FRICTION, friction, point, True, None))
        if type(normal) is float and -6.0 < normal < 6.0:
            return _as_read(Read, (restitution, from_radians(normal), codes.FRICTION, friction, point, True, None))
    door = Door()
    door.problems.extend(known)
    for label, vehicle in (("a", a), ("b", b)):
        if not isinstance(vehicle, Vehicle):
            door.refuse(not_a_vehicle(label, vehicle))
    e = door.number(restitution, "", "restitution", UNIT_INTERVAL)
    contact = None if point is None else door.pair(point, "m", "point")
    rule, bound = _tangential(door, (friction, impulse_ratio, critical_fraction))
    vehicles = (number for vehicle in (a, b) if isinstance(vehicle, Vehicle) for number in vehicle._numbers())
    unit = direction(door, normal, "normal", chain((e, bound, *(contact or ())), vehicles, beside))
    if not isinstance(law, str) or law not in codes.LAWS:
        door.refuse(
            InputError(
                f"law must be 'brach' (no slip at separation) or 'kudlich-slibar' (no slip at the end of compression), "
                f"got {shown(law)}",
                code="bad_law",
                argument="law",
            )
        )
    door.close()
    # Of a vector only the direction counts.
    texts = {name: text for name, text in door.texts.items() if not name.startswith("normal[")}
    given = {**texts, **_beyond_a_turn(normal)}
    return Read(e, unit, rule, bound, contact, np.ndarray not in map(type, (e, bound, *unit, *(contact or ()))), given or None)


def _beyond_a_turn(normal: Any) -> dict[str, Any]:
    """A normal given without a unit as an angle of more than a turn, which may have been meant in degrees."""
    if isinstance(normal, tuple) or has_unit(normal):
        return {}
    radians: Any = np.array(normal.magnitude if is_quantity(normal) else normal, dtype=np.float64)
    return {"normal": lock(radians) if radians.ndim else float(radians)} if largest(radians) > math.tau else {}


def _tangential(door: Door, values: tuple[Any, Any, Any]) -> tuple[str, Any]:
    """Which of the three ways to say what happens along the tangent was used, and its value."""
    given = [(rule, value) for rule, value in zip(codes.RULES, values, strict=True) if value is not None]
    if len(given) == 1:
        rule, value = given[0]
        return rule, door.number(value, "", rule, TANGENTIAL_DOMAINS[rule])
    found = "none" if not given else " and ".join(f"{name}=" for name, _ in given)
    door.refuse(
        InputError(
            f"give exactly one of friction=, impulse_ratio=, critical_fraction=; got {found}. There is no default, because "
            f"it decides cases: friction=0 is a frictionless contact, friction=inf one that never slips",
            code="one_tangential",
            argument="friction",
        )
    )
    return codes.FRICTION, math.nan


def pivots(model: str, a: Any, b: Any) -> Sequence[InputError]:
    """The refusals of pinned bodies, which the central models cannot hold."""
    if type(a) is type(b) is Vehicle and a.pivot is None and b.pivot is None:
        return ()
    return [
        InputError(
            f"{label} has a pivot, which {model} cannot hold; use eccentric, which needs yaw_inertia, x, y and point",
            code="pinned",
            argument="pivot",
        )
        for label, vehicle in (("a", a), ("b", b))
        if getattr(vehicle, "pivot", None) is not None
    ]


def check_options(on_failure: Any, threads: Any = 1, progress: Any = None) -> None:
    """Refuses an option that no solver knows."""
    if on_failure is not None and not (isinstance(on_failure, str) and on_failure in ("raise", "nan")):
        raise InputError(
            f"on_failure must be None, 'raise' or 'nan', got {shown(on_failure)}", code="bad_option", argument="on_failure"
        )
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
        raise InputError(f"threads must be a whole number from 1, got {shown(threads)}", code="bad_option", argument="threads")
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        raise InputError(
            f"progress must be a function of (done, total), or True for a bar, got {type(progress).__name__}",
            code="bad_option",
            argument="progress",
        )
