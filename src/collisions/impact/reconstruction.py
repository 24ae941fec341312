"""``Reconstruction``: which reverse solver found an impact, from what, and how well-conditioned
that was.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from ..kernels.contact_laws import FRICTION
from ..kernels.elementwise import UNCHECKED, select
from ..kernels.status import Status
from ..quantities.attributes import equal, read_only
from ..quantities.directions import course
from ..quantities.formatting import SI_UNITS
from ..quantities.reading import ArgumentReader
from ..quantities.units import Value
from ..vehicle.drag import read_drag
from .inputs import part_of


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reconstruction:
    """How a reverse solver found an impact.

    Of an impact that ``Impact.from_dict`` read it is an ``AsRecorded``: what its record says, as it
    stands there. ``diagnose``, ``explain``, ``report`` and ``reporting.replay`` work it out again,
    and refuse a record that says otherwise.

    Parameters
    ----------
    method : str
        Name of the function of ``collisions.reconstruct``.
    known : tuple of str
        What it was given in addition to masses and geometry.
    condition : float or array [1]
        How well-posed the problem was: the factor by which relative errors of the inputs may grow
        in the speeds before the impact, taken relative to the closing speed. 10 means that one
        percent may become ten. It leaves out errors of friction, restitution, normal and courses,
        but has those of a friction that components of delta-V show beside a known speed.
        For ``planar`` it is the factor that restitution brings in, (1 + e)/e where e was given, or,
        where larger, the jump between the two directions of sliding divided by the slip.
    answers : int or array of int
        How many impacts fit what was given, this one included; infinite at the end of a range of
        them. For a refused case the number that fit if there are several, otherwise 0.
    contact_velocity : tuple of float or array [m/s], optional
        Closing speed and slip before, as found. The motions before are rounded to their own size,
        so their small differences would hold fewer digits.
    regime : str, optional
        Of ``speeds``: "sticking" or "sliding" if the caller stated how the contact ended.
    one_sided : dict of str to int or array of int, optional
        Of ``speeds(..., slid="bound")``: for "speed_a" and "speed_b" which way the truth may lie
        from the speed found, if the contact slid: +1 at least that speed, -1 at most, 0 where it is
        known both ways. A speed is a size here, also of a vehicle that goes backwards.
    left_backwards : int or array of int, optional
        Of ``speeds(..., forward_only=True)``: how many more answers there are, in which a vehicle
        goes backwards along its course; ``answers`` are those that were not left out.
    slip_if_stuck : tuple of float or array [m/s], optional
        Of ``planar``: where the slip after is so small that it may be none, the least and the
        greatest slip before of a contact that stuck, infinite where friction holds any; NaN for
        other cases of a batch.
    misfit : float or array [1], optional
        Of ``speeds`` from components of delta-V: how far those that were given are from those of
        the answer, as a share of the impulse, or half the relative difference of a known energy
        where that is more; 0 where one impact fits all of them.
    found : tuple of str
        What was found of the state before and of the contact, by name: "speed_a", "speed_b", and
        where they were sought "course_a", "yaw_rate_a", "restitution", "friction" and so on. In a
        batch "friction" was found of some cases, and ``case`` says of which.
    given : dict of str to float or array
        Numbers of ``known``, and of the courses or motions that came with them, as they were given
        [SI]. A reading of a recorder away from the centre of mass is "reading_forward_a" and so
        on.

        .. versionadded:: 0.2.0
    duration, drag_a, drag_b : float or array [s, -, -], optional
        Of ``central``: how long the contact lasts, and the drags of the tyres meanwhile; None
        where not given.
    """

    method: str
    known: tuple[str, ...]
    condition: Value
    answers: Any = 1
    contact_velocity: tuple[Value, Value] | None = None
    regime: str | None = None
    one_sided: Mapping[str, Any] | None = None
    left_backwards: Any = None
    slip_if_stuck: tuple[Value, Value] | None = None
    misfit: Value | None = None
    found: tuple[str, ...] = ()
    given: Mapping[str, Any] = field(default_factory=dict)
    duration: Value | None = None
    drag_a: Value | None = None
    drag_b: Value | None = None

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Reconstruction):
            return NotImplemented
        return all(equal(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))


def from_components(known: Collection[str]) -> bool:
    """Whether what a reverse solver was given has components of delta-V."""
    return any(name.startswith(("delta_v_forward", "delta_v_left")) for name in known)


class AsRecorded(Reconstruction):
    """What a record says of how its impact was found, as it stands there.

    An impact cannot work it out again, as reverse solvers end in the forward one.
    """

    __slots__ = ()


# What each reverse solver finds, unless it was given.
_SOUGHT = {
    "central": ("speed_a", "speed_b", "restitution"),
    "planar": (
        *(f"{name}_{label}" for label in "ab" for name in ("speed", "course", "yaw_rate")),
        "restitution",
    ),
    "speeds": ("speed_a", "speed_b"),
}


def found_from(method: str, known: Collection[str]) -> tuple[str, ...]:
    """What a reverse solver found, by name, from what it was given."""
    taken = {f"speed_{name[1]}" if name in ("va", "vb") else name for name in known}
    return tuple(name for name in _SOUGHT.get(method, ()) if name not in taken)


class Known(NamedTuple):
    """An input of a reverse solver besides the contact: description, kind, path in the result, and
    the solvers that take it.

    The path is empty for what is not a number of the result; the text of ``va`` and ``vb`` is that
    of a vehicle before.
    """

    what: str
    kind: str
    path: str
    methods: tuple[str, ...]


_CENTRAL = ("central",)
KNOWN = {
    "energy_loss": Known("energy lost", "energy", "energy_loss", ("central", "planar", "speeds")),
    "closing_speed": Known("closing speed", "speed", "closing_speed", ("planar",)),
    "contact_duration": Known(
        "duration of the contact with its tyres", "time", "reconstruction.duration", _CENTRAL
    ),
    "recorder_axes_turning": Known("axes that turn with the car", "angle", "", ("speeds",)),
    "recorder_axes_fixed": Known("axes of the heading, which stay", "angle", "", ("speeds",)),
    "recorder_duration": Known(
        "duration of the contact, in which recorders turn", "time", "", ("speeds",)
    ),
}
for _label in "ab":
    _of, _planar, _speeds = f" of {_label.upper()}", ("planar",), ("speeds",)
    for _name, _what, _kind in (
        ("vx", "velocity along x", "speed"),
        ("vy", "velocity along y", "speed"),
        ("speed", "speed", "speed"),
        ("course", "course", "angle"),
        ("yaw_rate", "yaw rate", "yaw rate"),
    ):
        KNOWN[f"{_label}_after.{_name}"] = Known(
            f"{_what}{_of} after", _kind, f"{_label}.after.{_name}", _planar
        )
    KNOWN |= {
        f"v{_label}": Known(f"velocity{_of} before", "speed", f"{_label}.before.vx", ()),
        f"v{_label}_after": Known(
            f"velocity{_of} after", "speed", f"{_label}.after.vx", ("central",)
        ),
        f"drag_{_label}": Known(
            f"drag{_of} while the contact lasts",
            "number",
            f"reconstruction.drag_{_label}",
            _CENTRAL,
        ),
        f"speed_{_label}": Known(f"speed{_of} before", "speed", f"{_label}.before.speed", _speeds),
        f"course_{_label}": Known(
            f"course{_of} before", "angle", f"{_label}.before.course", _speeds
        ),
        f"delta_v_{_label}": Known(f"delta-V{_of}", "speed", f"{_label}.delta_v", _speeds),
        f"delta_v_forward_{_label}": Known(
            f"delta-V forward{_of}", "speed", f"{_label}.delta_v_forward", _speeds
        ),
        f"delta_v_left_{_label}": Known(
            f"delta-V to the left{_of}", "speed", f"{_label}.delta_v_left", _speeds
        ),
        f"recorder_{_label}": Known(
            f"place of the recorder{_of}, from which readings are carried over to the centre of "
            "mass",
            "length",
            "",
            _speeds,
        ),
        # Beside the result, whose delta-V is that of the centre of mass, as they were given.
        f"recorder_forward_{_label}": Known(
            f"recorder{_of}, ahead of the centre of mass", "length", "", _speeds
        ),
        f"recorder_left_{_label}": Known(
            f"recorder{_of}, left of the centre of mass", "length", "", _speeds
        ),
        f"reading_forward_{_label}": Known(
            f"delta-V forward{_of}, as its recorder reads it", "speed", "", _speeds
        ),
        f"reading_left_{_label}": Known(
            f"delta-V to the left{_of}, as its recorder reads it", "speed", "", _speeds
        ),
        f"ees_{_label}": Known(f"EES{_of} (ISO 12353)", "speed", "", _speeds),
        f"max_crush_speed_{_label}": Known(f"speed of maximum crush{_of}", "speed", "", _speeds),
    }

# What stands with the reconstruction itself, by the name under which it was known.
OF_CONTACT = {
    name: one.path.removeprefix("reconstruction.")
    for name, one in KNOWN.items()
    if one.path.startswith("reconstruction.")
}


def pushed_by_drag(origin: Reconstruction | None) -> bool:
    """Whether the impulses from outside are those of tyres, worked out from a drag."""
    return origin is not None and origin.duration is not None


def number_of_text(text: str, name: str) -> float | None:
    """The number [SI] of a text that a reverse solver was given; None if it cannot be read, as its
    unit belongs to another registry, or is of another kind.
    """
    reader, kind = ArgumentReader(), KNOWN[name].kind
    if kind == "angle":
        read = course(reader, text, name).radians
    elif name.startswith("drag_"):
        read = read_drag(reader, text, name)
    else:
        read = reader.number(text, SI_UNITS[kind], name, UNCHECKED)
    return None if reader.problems else float(read)


def number_beside(origin: Reconstruction, name: str) -> Any:
    """The number [SI] that stands beside a text of what a reverse solver was given, or those of a
    batch; None where there is none.
    """
    own = KNOWN[name].path.partition("reconstruction.")[2]
    return getattr(origin, own) if own else origin.given.get(name)


def reads_as(text: str, name: str, origin: Reconstruction) -> bool:
    """Whether a text that a reverse solver was given is the number beside it, but for rounding."""
    read, number = number_of_text(text, name), number_beside(origin, name)
    if read is None or number is None:
        return False
    numbers = np.asarray(number)
    # Beside arrays of float32 a number is rounded to their digits.
    within = 1e-6 if numbers.dtype == np.float32 else 1e-12
    apart = math.inf if math.isinf(read) else np.abs(read - numbers.astype(np.float64))
    size = abs(read)
    if KNOWN[name].kind == "angle":
        apart, size = np.abs(np.mod(apart + math.pi, math.tau) - math.pi), max(1.0, size)
    same = (numbers == read) | (np.asarray(apart) <= within * size) & math.isfinite(read)
    # A refused case of a batch may have no number.
    return bool(np.all(same | np.isnan(numbers)))


# Known for both vehicles at once, under the name of the one of A.
_OF_BOTH = {
    "ees_a": "EES of both vehicles (ISO 12353)",
    "max_crush_speed_a": "speeds of maximum crush of both vehicles",
}
_WITH_A = tuple(f"{name.removesuffix('_a')}_b" for name in _OF_BOTH)


def known_in_words(names: Iterable[str]) -> list[str]:
    """What a reverse solver was given, in words: "delta-V of A"."""
    return [
        _OF_BOTH.get(name) or (KNOWN[name].what if name in KNOWN else name.replace("_", " "))
        for name in names
        if name not in _WITH_A
    ]


def part_of_origin(
    origin: Reconstruction, take: Callable[[Any], Any], rule_value: Any
) -> Reconstruction:
    """That of some cases of a batch: a friction that was found of others alone was given here."""
    part: Reconstruction = part_of(origin, take)
    if part.slip_if_stuck is not None and np.all(np.isnan(part.slip_if_stuck)):
        part = replace(part, slip_if_stuck=None)
    if FRICTION not in origin.found or not isinstance(rule_value, np.ndarray):
        return part
    given = np.asarray(origin.given.get(FRICTION, math.inf), dtype=rule_value.dtype)
    if np.any(take(rule_value != given)):
        return part
    return replace(
        part,
        found=tuple(name for name in part.found if name != FRICTION),
        given={name: number for name, number in part.given.items() if name != FRICTION},
    )


def origin_where_answered(origin: Reconstruction, status: Any) -> Reconstruction:
    """The reconstruction with refused cases blanked: NaN condition, and no count of solutions
    unless there were several.
    """
    refused = status > Status.ENERGY_GAIN
    if not np.any(refused):
        return origin
    several = np.isin(status, (Status.AMBIGUOUS, Status.AMBIGUOUS_INVERSE))
    condition, answers = (
        select(refused, math.nan, origin.condition),
        select(refused > several, 0, origin.answers),
    )
    left, misfit = origin.left_backwards, origin.misfit
    velocity, slips = (
        pair and read_only(tuple(select(refused, math.nan, part) for part in pair))
        for pair in (origin.contact_velocity, origin.slip_if_stuck)
    )
    sides = origin.one_sided and {
        name: read_only(select(refused, 0, side)) for name, side in origin.one_sided.items()
    }
    return replace(
        origin,
        condition=read_only(condition),
        answers=read_only(answers),
        contact_velocity=velocity,
        slip_if_stuck=slips,
        misfit=None if misfit is None else read_only(select(refused, math.nan, misfit)),
        left_backwards=None if left is None else read_only(select(refused, 0, left)),
        one_sided=sides,
    )


# What changes with the slip of an impact whose impulse stays: of the contact, of a vehicle in its
# states, and of a vehicle in the impact.
_OF_SLIP = frozenset(
    ("relative_speed", "slip_before", "slip_after", "critical_impulse_ratio", "common_velocity")
)
_OF_STATES = frozenset(("vx", "vy", "speed", "momentum", "kinetic_energy"))
_OF_VEHICLES = frozenset(("kinetic_energy_change", "tyre_loss"))
_LOSSES = frozenset(("energy_loss", "energy_loss_tangential"))


def side_of(origin: Reconstruction | None, path: str) -> Any:
    """Which way the truth may lie from a number of an impact that was found, by its path: +1 at
    least, -1 at most, 0 where it is known; None where it is that of the least slip, and more would
    change it by nobody knows how much.
    """
    sides = {} if origin is None else origin.one_sided or {}
    if not any(map(np.any, sides.values())):
        return 0
    parts = path.split(".")
    own = sides.get(f"speed_{parts[0]}")
    if own is not None and not np.any(own):
        return 0  # the speed of this vehicle is known
    if parts[1:] == ["before", "speed"]:
        return own
    if path in _LOSSES:
        # Friction does more work over more slip.
        return reduce(np.maximum, map(np.abs, sides.values()))
    moves = parts[-1] in _OF_STATES or (parts[-1] == "course" and "before" not in parts)
    open_ = path in _OF_SLIP or parts[-1] in _OF_VEHICLES or (len(parts) == 3 and moves)
    return None if open_ else 0


def as_bound(origin: Reconstruction | None, path: str, text: str) -> str:
    """The text of a number of a single impact that was found, with which way the truth may lie."""
    side = side_of(origin, path)
    if side is None:
        return f"{text} with the least slip"
    return {1: "at least ", -1: "at most "}.get(side, "") + text


def how_many(answers: float) -> str:
    """How many impacts fit: "3 impacts" or "a whole range of impacts"."""
    return "a whole range of impacts" if answers == math.inf else f"{answers} impacts"


# What follows if a contact that was taken to stick slid, where no bound of a speed does.
NOT_THIS = "this is not the impact"


def bounds_of(sides: Mapping[str, int], speeds: Mapping[str, str]) -> list[str]:
    """What is known of each speed of a single case in which the contact may have slid: "the speed
    of B is at least 4.8 m/s". ``speeds`` has their numbers as texts.
    """
    words = {1: "at least", -1: "at most"}
    return [
        f"the speed of {name[-1].upper()} is {words[side]} {speeds[name]}"
        for name, side in sides.items()
        if side
    ]
