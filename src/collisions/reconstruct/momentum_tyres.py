"""What tyres do to planar momentum while the contact lasts: read, worked out, and, where none were
given, estimated as what was left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from ..impact.doubts import NEARLY_COLLINEAR
from ..impact.pulse import passed
from ..impact.time_resolved_inputs import impulse_of, read_lasting
from ..kernels.status import Status
from ..messages.errors import InputError, MissingInputError
from ..quantities.reading import ArgumentReader
from ..vehicle.drag import GRAVITY
from ..vehicle.tyres import Tyres, lacking
from .lasting import numbers_of_times, tyre_faults

if TYPE_CHECKING:
    from .momentum_solution import MomentumSolution

# Of a plastic contact, the share of the impulse that has passed at half of its time: momentum
# knows no restitution, and one of 0.2 would make it 0.34 instead of 0.29.
PASSED_AT_HALF = passed(0.0, 0.5)
MOST_CORRECTIONS = 64
"""Each takes the force of the tyres from the motions that the one before has found; nearly all
cases need fewer than 20.
"""
# Shares of the impulse of all tyres: below the first a change of it is rounding, above the second
# it has not settled.
_MET, _SETTLED = 1e-12, 1e-9


class Lasting(NamedTuple):
    """The duration of a contact, the tyres that act in it, by vehicle, and the yaw rates after that
    were given.
    """

    duration: Any
    tyres: dict[str, Tyres]
    yaw_rates: dict[str, Any]

    @property
    def numbers(self) -> dict[str, Any]:
        """Every number by its name."""
        rates = {f"yaw_rate_{label}_after": rate for label, rate in self.yaw_rates.items()}
        wheels = {f"tyres_{label}": tyres for label, tyres in self.tyres.items()}
        return numbers_of_times({"duration": self.duration, **wheels}) | rates

    def faults(self) -> Iterator[tuple[Any, Any]]:
        """The faults of arrays, whose elements the reader does not check, with their status."""
        for rate in self.yaw_rates.values():
            yield ~np.isfinite(rate), Status.NOT_FINITE
        yield from tyre_faults(self.duration, self.tyres)

    def corrected(
        self,
        old: Mapping[str, tuple[Any, Any]],
        new: Mapping[str, tuple[Any, Any]],
        moving: Any,
    ) -> tuple[dict[str, tuple[Any, Any]], Any, Any]:
        """The newer impulses in the cases that still move; which of these move on, and which have
        not settled.

        A case that has settled stays, so that it comes out of a batch as alone.
        """
        size = sum(np.hypot(*push) for push in new.values())
        change = sum(
            np.hypot(*(now - was for now, was in zip(push, old[label], strict=True)))
            for label, push in new.items()
        )
        found = {
            label: (np.where(moving, x, old[label][0]), np.where(moving, y, old[label][1]))
            for label, (x, y) in new.items()
        }
        return found, moving & (change > _MET * size), moving & (change > _SETTLED * size)

    def impulses(
        self,
        masses: Mapping[str, Any],
        headings: Mapping[str, Any],
        velocities: Mapping[str, tuple[Any, Any]],
        single: bool,
    ) -> dict[str, tuple[Any, Any]]:
        """Impulse of the tyres of each vehicle that has some, along x and y.

        The force of the wheels before, half-way through and after the contact, by Simpson's rule.
        Before it no vehicle turns. ``velocities`` are by the names of speeds.
        """
        found = {}
        for label, tyres in self.tyres.items():
            before, after = velocities[f"speed_{label}"], velocities[f"speed_{label}_after"]
            changes = [now - was for was, now in zip(before, after, strict=True)]
            numbers = [*before, 0.0, *changes, self.yaw_rates.get(label, 0.0)]
            body = masses[label], headings[label]
            if single:
                numbers = [float(number) for number in numbers]
                body = float(body[0]), float(body[1])
            x, y, _ = impulse_of(
                tyres,
                body,
                numbers[:3],
                numbers[3:],
                (PASSED_AT_HALF, self.duration),
                single=single,
            )
            found[label] = x, y
        return found


def read_tyres(
    reader: ArgumentReader,
    duration: Any,
    tyres: tuple[Any, Any],
    yaw_rates: tuple[Any, Any],
    headings: tuple[Any, Any],
) -> Lasting | None:
    """Duration, tyres and yaw rates after, or None where the contact is taken as an instant."""
    given = {label: rate for label, rate in zip("ab", yaw_rates, strict=True) if rate is not None}
    found: dict[str, Any] = {"tyres_a": None, "tyres_b": None}
    if duration is not None or any(one is not None for one in tyres):
        found = read_lasting(reader, "momentum", None, None, duration, tyres, ", or leave it out")
    own = {label: found[f"tyres_{label}"] for label in "ab" if found[f"tyres_{label}"] is not None}
    for label, heading in zip("ab", headings, strict=True):
        if label in own and heading is None:
            text = (
                f"heading_{label} is missing, and momentum with tyres_{label} needs it: wheels "
                f"roll along it; write heading_{label}='30 deg'"
            )
            reader.refuse(
                MissingInputError(text, code="missing_heading", argument=f"heading_{label}")
            )
    rates = {}
    for label, rate in given.items():
        name = f"yaw_rate_{label}_after"
        rates[label] = reader.number(rate, "rad/s", name)
        if tyres["ab".index(label)] is None:
            text = (
                f"{name} counts for the tyres of {label.upper()} alone, and there are none: "
                f"give `duration=` and `tyres_{label}=`, or leave it out"
            )
            reader.refuse(InputError(text, code="bad_combination", argument=name))
    return Lasting(found["duration"], own, rates) if own and "duration" in found else None


def tyres_lacking(solution: MomentumSolution) -> tuple[str, ...]:
    """The vehicles, "a" and "b", whose tyres are not in the balance and could be."""
    return lacking(solution.tyres, solution.mass_a, solution.mass_b)


def lasts(solution: MomentumSolution, otherwise: float) -> float:
    """How long the contact takes for the tyres that are not in the balance."""
    return _middle(solution.duration) if solution.tyres else otherwise


class Neglect(NamedTuple):
    """How far tyres would change the speeds, or the speed and the course, that were found; the
    largest change of a velocity as a share of its speed; and the sentence for it.
    """

    changes: dict[str, float]
    share: float
    sentence: str


def _kind(name: str) -> str:
    """The kind of quantity of a speed or course."""
    return "angle" if name.startswith("course") else "speed"


def _in_words(name: str) -> str:
    """A speed or course of planar momentum in words: ``speed_a_after`` as "speed of A after"."""
    kind, label, *after = name.split("_")
    return " ".join((kind, "of", label.upper(), *after))


def neglected(
    solution: MomentumSolution, duration: float, drag: float, say: Callable[[float, str], str]
) -> Neglect | None:
    """What an answer without tyres, or without those of one vehicle, leaves out if these wheels
    slid: the change of both speeds found, or of a speed and a course, in a batch in the median;
    None of an answer with the tyres of both, and where there is none.

    ``say`` writes a number of a kind, "speed" or "angle". The duration is that of the answer, where
    it has one.
    """
    labels = tyres_lacking(solution)
    if not labels:
        return None
    duration = lasts(solution, duration)
    push_x: Any = 0.0
    push_y: Any = 0.0
    with np.errstate(all="ignore"):
        for label in labels:
            before, after = (_velocity(solution, f"speed_{label}{when}") for when in ("", "_after"))
            mass = getattr(solution, f"mass_{label}")
            x, y = sliding(mass, before, after, drag, duration)
            push_x, push_y = push_x + x, push_y + y
        moved = {"speeds": _along, "velocity": _whole, "beside": _beside}[what_is_sought(solution)]
        found = dict(moved(solution, push_x, push_y))
        changes = {name: _middle(change) for name, (change, _) in found.items()}
        shares = [_middle(share) for _, share in found.values()]
    parts = [
        f"the {_in_words(name)} would be {say(abs(change), _kind(name))} "
        f"{'more' if change > 0.0 else 'less'}"
        for name, change in changes.items()
    ]
    no_course = what_is_sought(solution) == "beside" and _mostly_none(
        solution, found[solution.unknowns[1]][0]
    )
    if no_course:
        parts = [f"no {_in_words(solution.unknowns[1])} would fit what is known"]
        shares = [math.inf]
    elif not all(map(math.isfinite, (*changes.values(), *shares))):
        return None
    medians = " (medians)" if np.ndim(solution.speed_a) else ""
    if no_course and medians:
        medians = " in half of the cases or more"
    sentence = (
        f"found as an instant, which leaves out the tyres: if all wheels slid for {duration:.3g} s "
        f"with a drag of {drag:.2g}, {' and '.join(parts)}{medians}; give duration= and "
        "tyres_a=, tyres_b="
    )
    if solution.tyres:
        (label,) = labels
        sentence = (
            f"found without the tyres of vehicle {label.upper()}: if its wheels slid for "
            f"{duration:.3g} s with a drag of {drag:.2g}, {' and '.join(parts)}{medians}; give "
            f"tyres_{label}="
        )
    return Neglect(changes, max(shares), sentence)


# Of a speed below 0.
TURN_ROUND = "backwards along its course; check the courses, or turn its course by 180 deg"


def why_it_moves(solution: MomentumSolution) -> str:
    """Why an ill-conditioned answer moves far, by what was sought."""
    one, other = solution.unknowns
    near = f"{math.degrees(NEARLY_COLLINEAR):.2g} degrees"
    match what_is_sought(solution):
        case "speeds":
            courses = " and ".join(solution.unknowns).replace("speed", "course")
            return (
                f"{courses} are within {near} of one line, and small errors of a course move both "
                "far"
            )
        case "velocity":
            return (
                f"the momenta that leave {one} and its course nearly cancel, and small errors of "
                "them move both far"
            )
        case "beside":
            return (
                f"{other} is within {near} of a right angle to that of {one}, and small errors "
                "move both far, or to the other course that fits"
            )


def _mostly_none(solution: MomentumSolution, turn: Any) -> bool:
    """Whether a course would turn to nowhere in half of the cases that have an answer."""
    there = np.isfinite(getattr(solution, solution.unknowns[1]))
    return bool(np.count_nonzero(there & np.isnan(turn)) >= max(0.5 * np.count_nonzero(there), 1))


def what_is_sought(solution: MomentumSolution) -> Literal["speeds", "velocity", "beside"]:
    """Two speeds, one velocity whole, or a speed and the course of another body beside it."""
    speed, second = solution.unknowns
    if second.startswith("speed"):
        return "speeds"
    return "velocity" if second == speed.replace("speed", "course") else "beside"


def _along(
    solution: MomentumSolution, push_x: Any, push_y: Any
) -> Iterator[tuple[str, tuple[Any, Any]]]:
    """The change of each unknown speed along its course, and that as a share of it."""
    names = solution.unknowns
    courses = [getattr(solution, name.replace("speed", "course")) for name in names]
    for name, own, other in zip(names, courses, courses[::-1], strict=True):
        across = push_x * np.sin(other) - push_y * np.cos(other)
        change = -_taken(solution, name) * across / np.sin(other - own)
        yield name, (change, abs(change / getattr(solution, name)))


def _whole(
    solution: MomentumSolution, push_x: Any, push_y: Any
) -> Iterator[tuple[str, tuple[Any, Any]]]:
    """The change of a speed and of its course, and for both that of the velocity as a share."""
    name, course = solution.unknowns
    speed, angle = getattr(solution, name), getattr(solution, course)
    by = -_taken(solution, name)
    along = by * (push_x * np.cos(angle) + push_y * np.sin(angle))
    across = by * (push_y * np.cos(angle) - push_x * np.sin(angle))
    share = np.hypot(along, across) / speed
    yield name, (np.hypot(speed + along, across) - speed, share)
    yield course, (np.arctan2(across, speed + along), share)


def _beside(
    solution: MomentumSolution, push_x: Any, push_y: Any
) -> Iterator[tuple[str, tuple[Any, Any]]]:
    """The change of a speed and of the course of another, and each as a share of its velocity; NaN
    where no course balances what is across that of the speed.
    """
    name, course = solution.unknowns
    axis, angle = getattr(solution, name.replace("speed", "course")), getattr(solution, course)
    other = course.replace("course", "speed")
    size, own, its = (
        getattr(solution, other),
        _taken(solution, name),
        _taken(solution, other),
    )
    along = push_x * np.cos(axis) + push_y * np.sin(axis)
    across = push_y * np.cos(axis) - push_x * np.sin(axis)
    # Of the two courses that balance it, the one on the side of that found.
    sine, cosine = np.sin(angle - axis), np.cos(angle - axis)
    then = sine - its * across / size
    turned = np.copysign(np.sqrt(1.0 - then * then), cosine)
    change = -own * along - own / its * size * (turned - cosine)
    turn = np.copysign(1.0, cosine) * (np.arcsin(then) - np.arcsin(sine))
    yield name, (change, abs(change / getattr(solution, name)))
    yield course, (turn, abs(turn))


def other_course(solution: MomentumSolution) -> tuple[Any, Any]:
    """Of a speed that was sought beside the course of another, both as they would be on the other
    side of the first's course, where the same balance holds without tyres.
    """
    name, course = solution.unknowns
    axis, angle = getattr(solution, name.replace("speed", "course")), getattr(solution, course)
    size = getattr(solution, course.replace("course", "speed"))
    # A refused case may have no number.
    with np.errstate(all="ignore"):
        shares = _taken(solution, name) / _taken(solution, course.replace("course", "speed"))
        speed = getattr(solution, name) + 2.0 * shares * size * np.cos(angle - axis)
        return speed, np.pi - angle + 2.0 * axis


def _taken(solution: MomentumSolution, name: str) -> Any:
    """What an impulse from outside takes from a velocity that is sought, by unit of it."""
    mass = getattr(solution, f"mass_{name[6]}")
    if name == "speed_a_after" and left_as_one(solution):
        mass = solution.mass_a + solution.mass_b
    return (-1.0 if name.endswith("after") else 1.0) / mass


def left_as_one(solution: MomentumSolution) -> bool:
    """Whether both vehicles have one velocity after, in every case of a batch."""
    pairs = (
        (getattr(solution, f"{what}_a_after"), getattr(solution, f"{what}_b_after"))
        for what in ("speed", "course")
    )
    return all(
        one is other if one is None or other is None else np.array_equal(one, other, equal_nan=True)
        for one, other in pairs
    )


def _velocity(solution: MomentumSolution, name: str) -> tuple[Any, Any]:
    """Along x and y; a vehicle at rest has no course."""
    speed, course = getattr(solution, name), getattr(solution, name.replace("speed", "course"))
    if course is None:
        return 0.0 * speed, 0.0 * speed
    return speed * np.cos(course), speed * np.sin(course)


def _middle(values: Any) -> float:
    known = np.asarray(values, dtype=np.float64)
    known = known[np.isfinite(known)]
    return float(np.median(known)) if known.size else math.nan


def sliding(
    mass: Any, before: tuple[Any, Any], after: tuple[Any, Any], drag: Any, duration: Any
) -> tuple[Any, Any]:
    """Impulse of tyres that slide against the motion of a vehicle all the while, as ``left_out``
    takes them where none were given: Simpson's rule over before, half-way and after.
    """
    x: Any = 0.0
    y: Any = 0.0
    for weight, share in ((1.0, 0.0), (4.0, PASSED_AT_HALF), (1.0, 1.0)):
        vx, vy = (was + share * (now - was) for was, now in zip(before, after, strict=True))
        speed = np.hypot(vx, vy)
        speed = np.where(speed > 0.0, speed, 1.0)
        x, y = x - weight / 6.0 * vx / speed, y - weight / 6.0 * vy / speed
    most = mass * drag * GRAVITY * duration
    return most * x, most * y
