"""Points of a tyre mark as evidence: how far a place is from the mark that a wheel leaves in a run,
and where the mark begins and ends, in every case of a batch.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..kernels.elementwise import POSITIVE_FINITE
from ..messages.errors import InputError, MissingInputError, NoSolutionError, ShapeError
from ..messages.marked import type_of
from ..quantities.reading import ArgumentReader
from ..quantities.units import is_quantity, magnitude, shown
from ..travel.simulate import MARKS
from ..uncertainty.distributions import Normal
from ..vehicle.tyres import WHEELS as IN_WORDS
from .ledger import OnTyres, on_tyres

if TYPE_CHECKING:
    from .motion import Leg
    from .run import Run
    from .scene import Scene

WHEELS = tuple(wheel.replace(" ", "_") for wheel in IN_WORDS)
# Places along the mark of one motion, and of the way while a contact lasts: a wheel that turns
# within a few metres is a millimetre or a few from the chords between them, and a survey some
# centimetres.
_PLACES, _IN_CONTACT = 101, 21
# How near to rest a motion is followed, as a share of its time.
_BEFORE_REST = 1e-6
# of the time from one place to the next, until it is known where a mark begins or ends
_HALVINGS = 24
# Stretches of a mark that are nearer to each other [s] are one.
_NO_GAP = 1e-9
# Cases that are worked out together, which keeps memory small.
_BLOCK = 256
_DISTANCE = re.compile(r"distance\(([^,]*),([^,]*)\)")
_END = re.compile(r"(begin|end)\.([xy])")
_MARK = re.compile(r"([^.\[\]]+)\.marks(?:\.([^.(]*)\.?(.*))?")


class OfMark(NamedTuple):
    """What is asked for of the mark of a wheel, which has its number: the "distance" of a place (x,
    y) [m] from it; or where it has its "begin" or "end", with (1, 0) for x and (0, 1) for y.
    """

    name: str
    wheel: int
    what: str
    x: float
    y: float


def of_mark(scene: Scene, path: str, argument: str) -> OfMark | None:
    """What a path asks for of a mark; None for any other path, and an error for one that nothing
    can answer.
    """
    found = _MARK.fullmatch(path)
    if not found or found[1] not in scene.movers:
        return None
    name, wheel, what = found[1], found[2], found[3] or ""
    _check_wheel(scene, name, WHEELS[0] if wheel is None else wheel, argument)
    if end := _END.fullmatch(what):
        axis = float(end[2] == "x")
        return OfMark(name, WHEELS.index(wheel), end[1], axis, 1.0 - axis)
    distance = _DISTANCE.fullmatch(what)
    if distance is None:
        text = (
            f"{argument} has no {path!r}; of a mark there are begin.x, begin.y, end.x, end.y and "
            f"the distance of a place, such as '{name}.marks.{wheel or WHEELS[0]}.distance(12.3 m, "
            "4.5 m)'"
        )
        raise InputError(text, code="unknown_name", argument=argument)
    reader = ArgumentReader()
    x, y = (
        _number(reader, text.strip(), f"{path}: {axis}")
        for axis, text in zip("xy", distance.groups(), strict=True)
    )
    reader.close()
    return OfMark(name, WHEELS.index(wheel), "distance", x, y)


def _number(reader: ArgumentReader, text: str, label: str) -> float:
    try:
        given: Any = float(text)
    except ValueError:
        given = text
    return float(reader.number(given, "m", label))


def _check_wheel(scene: Scene, name: str, wheel: Any, argument: str) -> None:
    """Refuse a wheel that is none, and a vehicle without tyres."""
    if not isinstance(wheel, str) or wheel not in WHEELS:
        raise InputError(
            f"{argument} has no wheel {shown(wheel)}; write one of {', '.join(WHEELS)}",
            code="unknown_name",
            argument=argument,
        )
    after = any(name in contact.tyres_after for contact in scene.contacts)
    if scene.movers[name].tyres is None and not after:
        raise _no_tyres(name)


def _no_tyres(name: str) -> MissingInputError:
    return MissingInputError(
        f"{name} leaves no marks, as it has no tyres; give it `tyres=` in its `|Mover|[[mover]]`",
        code="missing_tyres",
        argument=name,
    )


# Evidence


def evidence_of(
    scene: Scene, name: Any, wheel: Any, points: Any, error: Any, begins: Any, ends: Any
) -> dict[str, Normal]:
    """What was observed of a mark, by path: the distance of each surveyed point from it, and both
    coordinates of one where it begins or ends.
    """
    if not isinstance(name, str) or name not in scene.movers:
        raise InputError(
            f"name has no vehicle {shown(name)}; write one of {', '.join(scene.movers)}",
            code="unknown_name",
            argument="name",
        )
    _check_wheel(scene, name, wheel, "wheel")
    reader = ArgumentReader()
    for label, given in (("begins", begins), ("ends", ends)):
        if not isinstance(given, bool):
            text = f"{label} must be True or False, got {shown(given)}"
            reader.refuse(InputError(text, code="bad_option", argument=label))
    sigma = reader.number(error, "m", "error", POSITIVE_FINITE)
    if isinstance(sigma, np.ndarray):
        text = f"error must be one number for all points, got an array of shape {sigma.shape}"
        reader.refuse(ShapeError(text, code="bad_shape", argument="error"))
    read = list(_read_points(reader, points))
    for number, point in enumerate(read):
        if (before := read.index(point)) < number:
            text = f"points[{number}] is points[{before}] again; leave one of them out"
            reader.refuse(InputError(text, code="bad_combination", argument="points"))
    if begins is True and ends is True and len(read) == 1:
        text = "points has one point, where the mark cannot both begin and end; give two or more"
        reader.refuse(ShapeError(text, code="bad_shape", argument="points"))
    reader.close()
    with_unit = isinstance(error, str) or is_quantity(error)
    mark, spread = f"{name}.marks.{wheel}", error if with_unit else f"{float(sigma)!r} m"
    found: dict[str, Normal] = {}
    for number, (x, y) in enumerate(read):
        end = (
            "begin"
            if begins and not number
            else "end"
            if ends and number == len(read) - 1
            else None
        )
        if end is None:
            found[f"{mark}.distance({x}, {y})"] = Normal("0 m", spread)
        else:
            found |= {f"{mark}.{end}.x": Normal(x, spread), f"{mark}.{end}.y": Normal(y, spread)}
    return found


def _read_points(reader: ArgumentReader, points: Any) -> Iterator[tuple[str, str]]:
    """The coordinates of each surveyed point as they stand in a path."""
    whole = magnitude(points) if is_quantity(points) else points
    listed: Any = points
    if isinstance(whole, np.ndarray):
        listed = list(points) if whole.ndim == 2 and whole.shape[1] == 2 else None
    if not isinstance(listed, (list, tuple)) or not listed:
        shape = (
            f"an array of shape {whole.shape}" if isinstance(whole, np.ndarray) else shown(points)
        )
        text = (
            "points must be a list of one or more pairs `(x, y)`, such as [(12.3, 4.5), "
            f"('13.1 m', '4.9 m')], or an array of shape (points, 2); got {shape} of type "
            f"{type_of(points)}"
        )
        reader.refuse(ShapeError(text, code="bad_shape", argument="points"))
        return
    for number, point in enumerate(listed):
        label = f"points[{number}]"
        before = len(reader.problems)
        pair = reader.pair(point, "m", label)
        if len(reader.problems) > before:
            continue
        if any(isinstance(part, np.ndarray) for part in pair):
            text = f"{label} has an array in it; write one pair `(x, y)` for each point"
            reader.refuse(ShapeError(text, code="bad_shape", argument="points"))
            continue
        yield _written(pair[0], point[0]), _written(pair[1], point[1])


def _written(value: Any, given: Any) -> str:
    """A coordinate in a path: the text that it was given as, or metres, to 0.1 mm."""
    return given.strip() if isinstance(given, str) else f"{round(float(value), 4)!r} m"


# Distances


def answers(run: Run, asked: Sequence[OfMark]) -> list[Any]:
    """What is asked for of marks [m]. A distance is how far the place is to the left of the mark,
    in the direction in which the wheel left it, and negative to the right. Arrays over the cases,
    NaN where the wheel leaves no mark or the case has no answer; of a single case floats, and an
    error in place of NaN.
    """
    by_name: dict[str, list[int]] = {}
    for at, one in enumerate(asked):
        by_name.setdefault(one.name, []).append(at)
    found = np.empty((len(asked), run._followed.count))
    for name, mine in by_name.items():
        found[mine] = _of_one_vehicle(run, name, [asked[at] for at in mine])
    if not run._followed.single:
        return list(found)
    for one, value in zip(asked, found[:, 0].tolist(), strict=True):
        if math.isnan(value):
            raise NoSolutionError(
                f"the {IN_WORDS[one.wheel]} wheel of {one.name} leaves no mark: all the way it "
                f"rolls, or uses less than {MARKS:.0%} of the friction; give the lock that made "
                "it leave one, or the wheel that did",
                code="no_mark",
            )
    return [float(value) for value in found[:, 0]]


def drawn(run: Run, name: str) -> dict[str, tuple[Any, Any, Any]]:
    """The marks of one vehicle in a run of a single case, by wheel: time [s], x and y [m] along
    them, from where each begins to where it ends; x and y are NaN between stretches. A wheel that
    leaves none is not in it.
    """
    course, every = run._followed.courses[name], range(len(WHEELS))
    if not any(tyres is not None for tyres in course.wheels):
        return {}
    ways: dict[str, list[Any]] = {wheel: [] for wheel in WHEELS}
    for start, _, lines in _lines(run, name, every):
        for way, line in zip(ways.values(), lines, strict=True):
            pieces = np.array(line)[:, np.isfinite(line.x)]
            for begin, on in zip(pieces[:3].T, pieces[3:].T, strict=True):
                begin[0] += start[0]
                # One that rolls on when all others are at rest is drawn no further than these.
                if begin[0] >= run.end:
                    break
                if on[0] > run.end - begin[0]:
                    on *= (run.end - begin[0]) / on[0]
                if not way or begin[0] - way[-1][0] > _NO_GAP:
                    # A stretch ends here and another begins.
                    way += [np.array([one[0], np.nan, np.nan]) for one in way[-1:]] + [begin]
                way.append(begin + on)
    return {wheel: tuple(np.array(way).T) for wheel, way in ways.items() if way}


def _of_one_vehicle(run: Run, name: str, asked: Sequence[OfMark]) -> Any:
    """What is asked for of the marks of one vehicle, (asked, cases)."""
    followed = run._followed
    course, count = followed.courses[name], followed.count
    if not any(tyres is not None for tyres in course.wheels):
        raise _no_tyres(name)
    nearest = np.full((len(asked), count), np.inf)
    found = np.full((len(asked), count), np.nan)
    wheels = sorted({one.wheel for one in asked})
    # Of each case in order of time.
    for _, cases, lines in _lines(run, name, wheels):
        for at, one in enumerate(asked):
            line, before = lines[wheels.index(one.wheel)], found[at, cases]
            if one.what == "distance":
                square, new = _to_line(line, one.x, one.y)
                better = square < nearest[at, cases]
                nearest[at, cases] = np.where(better, square, nearest[at, cases])
            else:
                new = one.x * line.end(one.what, 0) + one.y * line.end(one.what, 1)
                better = np.isnan(before) if one.what == "begin" else np.isfinite(new)
            found[at, cases] = np.where(better, new, before)
    found[:, (followed.told.failed != "") | (course.failed != "")] = np.nan
    return found


class _Line(NamedTuple):
    """The pieces of a mark: when and where each begins and how it goes on, NaN where there is none,
    each of (pieces, cases).
    """

    time: Any
    x: Any
    y: Any
    takes: Any
    along: Any
    across: Any

    def end(self, which: str, axis: int) -> Any:
        """A coordinate of where the mark begins or ends in each case, NaN where there is none."""
        good = np.isfinite(self.x)
        last = which == "end"
        piece = len(good) - 1 - good[::-1].argmax(axis=0) if last else good.argmax(axis=0)
        places = (self.x, self.y)[axis] + last * (self.along, self.across)[axis]
        return np.take_along_axis(places, piece[None], axis=0)[0]


def _lines(run: Run, name: str, wheels: Sequence[int]) -> Iterator[tuple[Any, Any, list[_Line]]]:
    """The marks of some wheels, motion by motion: when it starts, the cases that they are of, and
    the lines.
    """
    course = run._followed.courses[name]
    legs = course.settled()
    for number, leg in enumerate(legs):
        if leg.tyres is None:
            continue
        next_start = np.full(course.count, np.inf)
        for later in reversed(legs[number + 1 :]):
            next_start[later.which] = later.start
        until = next_start[leg.which] - leg.start
        # A contact may come before the motion after another has begun.
        moving = np.flatnonzero(((leg.place >= 0) | (leg.hold > 0.0)) & (until > 0.0))
        for begin in range(0, len(moving), _BLOCK):
            some = moving[begin : begin + _BLOCK]
            lines = _lines_of(run, name, leg, some, until[some], wheels)
            yield leg.start[some], leg.which[some], lines


def _lines_of(
    run: Run, name: str, leg: Leg, some: Any, until: Any, wheels: Sequence[int]
) -> list[_Line]:
    """The marks of some wheels in one motion of some of its cases, until a time of each; while a
    contact lasts, too.
    """
    hold = np.minimum(leg.hold[some], until)
    ends, last = until.copy(), np.isinf(until)
    ends[last] = hold[last]
    moments = [hold * np.linspace(0.0, 1.0, _IN_CONTACT)[:, None]] if np.any(hold) else []
    on = np.flatnonzero(leg.place[some] >= 0)
    if leg.followed is not None and len(on):
        place, rests = leg.place[some[on]], last[on]
        # At rest a wheel uses no friction, and until then as much as in the moment before.
        ends[on] += np.where(rests, (1.0 - _BEFORE_REST) * leg.followed.ends(place), 0.0)
        after = np.zeros((_PLACES, len(some)))
        after[:, on] = _moments((ends - hold)[on], rests)
        moments.append(hold + after)
        # No step goes over an edge of a surface, and steps are short where the motion bends: what
        # marks for a moment has the middle of one.
        steps = leg.followed.steps(place)
        middles = np.zeros((len(steps) - 1, len(some)))
        middles[:, on] = 0.5 * (steps[1:] + steps[:-1])
        moments.append(np.minimum(hold + middles, ends))
    times = np.sort(np.concatenate(moments), axis=0)
    found = _seen(run, name, leg, some, times, np.arange(len(some)))
    return [_line(run, name, leg, some, times, found, wheel) for wheel in wheels]


def _seen(run: Run, name: str, leg: Leg, some: Any, times: Any, columns: Any) -> OnTyres:
    """What the tyres do at times (..., columns) of some cases, of which these are the columns."""
    assert leg.tyres is not None
    case = np.broadcast_to(some[columns], times.shape).ravel()
    states = leg.at(leg.start[case] + times.ravel(), case)
    mover, ground = run.scene.movers[name], run._followed.ground
    return on_tyres(leg.tyres, mover, ground, states, leg.which[case])


def _moments(ends: Any, last: Any) -> Any:
    """Moments of motions from their start to their end [s], (moments, cases): in equal steps of
    time, or to rest, which is the ``last`` of a case, in those of the way of an even deceleration.
    """
    share = np.linspace(0.0, 1.0, _PLACES)[:, None]
    return ends * np.where(last, 1.0 - np.sqrt(1.0 - share), share)


def _line(
    run: Run, name: str, leg: Leg, some: Any, times: Any, found: OnTyres, wheel: int
) -> _Line:
    """The mark of a wheel by its places at times of (moments, cases): as far as it uses enough of
    the friction.
    """
    marks = found.use[wheel].reshape(times.shape) >= MARKS
    way = np.stack([times, *found.places[wheel].reshape(2, *times.shape)])
    begin, end = way[:, :-1].copy(), way[:, 1:].copy()
    piece, case = np.nonzero(marks[1:] != marks[:-1])
    # Where it begins or leaves off, between two moments.
    low, high = times[piece, case], times[piece + 1, case]
    begins = marks[piece + 1, case]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        early = (_seen(run, name, leg, some, middle, case).use[wheel] >= MARKS) != begins
        low, high = np.where(early, middle, low), np.where(early, high, middle)
    turn = np.stack([high, *_seen(run, name, leg, some, high, case).places[wheel]])
    begin[:, piece, case] = np.where(begins, turn, begin[:, piece, case])
    end[:, piece, case] = np.where(begins, end[:, piece, case], turn)
    none = np.where(marks[1:] | marks[:-1], 0.0, np.nan)
    return _Line(*(begin + none), *(end - begin))


def _to_line(line: _Line, x: float, y: float) -> tuple[Any, Any]:
    """The squared distance of a place from the nearest piece in each case, infinite without one;
    and the distance, positive to the left.
    """
    px, py = x - line.x, y - line.y
    # A place so far away that a square leaves the range of floats is nearest to nothing.
    with np.errstate(over="ignore", invalid="ignore"):
        length = line.along * line.along + line.across * line.across
        share = (px * line.along + py * line.across) / np.where(length > 0.0, length, 1.0)
        share = np.clip(share, 0.0, 1.0)
        square = (px - share * line.along) ** 2 + (py - share * line.across) ** 2
    square = np.where(np.isnan(square), np.inf, square)
    nearest = square.argmin(axis=0)[None]
    least = np.take_along_axis(square, nearest, axis=0)[0]
    with np.errstate(over="ignore", invalid="ignore"):
        left = np.take_along_axis(line.along * py - line.across * px, nearest, axis=0)[0]
    return least, np.where(left < 0.0, -1.0, 1.0) * np.sqrt(least)
