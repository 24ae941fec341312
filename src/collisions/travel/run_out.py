"""``path``: speed at separation of a vehicle that yawed as it slid, from positions
along its path.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..kernels.elementwise import UNIT_INTERVAL, select
from ..messages.errors import InputError, MissingInputError, OutOfRangeWarning
from ..messages.hints import hinted
from ..messages.warning import warn
from ..quantities.attribute_stubs import RunOutQuantities
from ..quantities.attributes import Shown, derived, hypot, in_units_of, math_or_numpy
from ..quantities.directions import angle_of
from ..quantities.reading import ArgumentReader
from ..quantities.tables import Sentences
from ..quantities.units import Input, Pair, Texts, Value, texts_of
from ..vehicle.drag import one_value, read_friction
from ..vehicle.tyres import LOCKS, Tyres, lifts, not_tyres, refuse_lifting
from .legs import Wheels, legs_of
from .surfaces import (
    Segments,
    durations_along,
    for_each,
    in_one_precision,
    out_of_range,
    read_grade,
    read_length,
    read_speed,
    settle,
    speeds_along,
)
from .survey import HALF_TURN, in_radians, read_errors, read_headings, read_points, slopes, smooth

_QUARTER_TURN = 0.5 * math.pi * (1.0 + 1e-9)
# Distance of a wheel from the centre of mass [m]; its speed from the yaw, over that of the vehicle,
# above which it matters: of wheels that nearly roll, by how much it rises with the lock, and at
# most. Yawing takes more from the drag of wheels that are braked less.
_WHEEL_ARM, _MOST_YAW = 1.5, 0.5
_YAW_OF_ROLLING, _YAW_BY_LOCK = 0.3, 0.5
_FULL_LOCK = (_MOST_YAW - _YAW_OF_ROLLING) / _YAW_BY_LOCK
# Numbers that the errors are worked out from together: few calls of numpy, and memory that is kept
# small.
_AT_ONCE = 200_000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class RunOut(Shown):
    """A vehicle that slid and yawed from separation to where its speed is known, computed backward
    by ``path``.

    Attributes
    ----------
    speed : float or array [m/s]
        Speed at separation, along the slope.
    course : float or array [rad]
        Direction of motion at separation, the tangent of the path, in (-pi, pi].
    yaw_rate : float or array [rad/s]
        Yaw rate at separation, positive counter-clockwise.
    time : float or array [s]
        From the first point to the last, along the slope of every segment.
    distance : float or array [m]
        Along the path, in plan.
    straight_course : float or array [rad]
        Direction from the first point to the last, in (-pi, pi]; NaN where they coincide.
    speeds : tuple of float or array [m/s]
        Speed at every point, along the slope.
    crab_angles : tuple of float or array [rad]
        For every segment, heading minus course, in (-pi, pi]: positive where the vehicle points to
        the left of its path.
    drags : tuple of float or array
        For every segment, the drag factor that results from friction, lock and crab angle; with
        ``rotating_mass``, less what the wheels that turn take of it.
    speed_error, course_error, yaw_rate_error : float or array, optional [m/s], [rad], [rad/s]
        Standard errors of the three, from those of the positions and headings alone; None if these
        were not given.
    """

    _title = "Run-out"

    if TYPE_CHECKING:

        @property
        def q(self) -> RunOutQuantities: ...

    speed: Value = field(metadata={"unit": "m/s"})
    course: Value = field(metadata={"unit": "rad"})
    yaw_rate: Value = field(metadata={"unit": "rad/s"})
    time: Value = field(metadata={"unit": "s"})
    distance: Value = field(metadata={"unit": "m"})
    straight_course: Value = field(metadata={"unit": "rad"})
    speeds: tuple[Value, ...] = field(metadata={"unit": "m/s"})
    crab_angles: tuple[Value, ...] = field(metadata={"unit": "rad"})
    drags: tuple[Value, ...] = field(metadata={"unit": ""})
    speed_error: Value | None = field(default=None, metadata={"unit": "m/s"})
    course_error: Value | None = field(default=None, metadata={"unit": "rad"})
    yaw_rate_error: Value | None = field(default=None, metadata={"unit": "rad/s"})

    @derived("rad")
    def course_difference(self) -> Value:
        """Course at separation minus that of the straight line to rest [rad], in (-pi, pi]: the
        error of using the line.
        """
        difference: Value = _wrapped(self.course - self.straight_course)
        return difference


@hinted
def path(
    points: Sequence[Pair] | Input,
    headings: Segments,
    *,
    friction: Segments | None = None,
    lock: Segments | None = None,
    tyres: Tyres | None = None,
    rotating_mass: Input = 0.0,
    grade: Segments = 0.0,
    end_speed: Input = 0.0,
    window: Input = "7 m",
    point_error: Input | None = None,
    heading_error: Input | None = None,
) -> RunOut:
    """Speed, course and yaw rate at separation of a vehicle that yawed as it slid, from positions
    along its path.

    A vehicle whose wheels roll freely slows little while it points along its path and much while it
    slides broadside, so no single percentage of the friction fits a spin. Here each segment between
    two positions has its own drag, from its crab angle (mean heading minus course) and from how far
    the wheels are braked::

        along = min(lock, |cos(crab)|)
        drag  = friction * (along * |cos(crab)| + sqrt(1 - along**2) * |sin(crab)|)

    With ``tyres``, each segment has the drag of four wheels, each with its own lock and the slip of
    its own place on the vehicle, to which the yaw adds, and with the side force of ``Tyres``.

    A list runs over positions or segments, and so does one array for all points or all headings.
    For many cases at once, give arrays in place of the single numbers: ``[(xs, ys), ...]``,
    ``[angles, ...]``, ``friction=factors``; they broadcast.

    Parameters
    ----------
    points : sequence of pairs, array or Quantity of shape (n, 2) [m]
        Positions of the centre of mass in plan, at least two, in order of travel: from separation
        to where the speed is ``end_speed``. They are joined by straight lines.
    headings : sequence, array or Quantity, one for each point [rad]
        Where the vehicle points, counted on through full turns and never reduced: 0, 100, 200, 290
        deg for one that turned 290 deg to the left, 0, -70 deg for one that turned 70 deg to the
        right. From one point to the next, at most half a turn; give more points for a faster spin.
    friction : float, str, Quantity or array [-], or a list with one for each segment
        Friction of locked tyres on the ground, >= 0. With ``tyres`` that of the ground, by default
        theirs.
    lock : float, str, Quantity or array [-], or a list with one for each segment
        Braking of the wheels, from damage, brakes or an engaged gear, as a fraction of what locks
        them: 0 if all roll freely, 1 if all are locked. One for the vehicle, where its wheels are
        not told apart; needed without ``tyres``.
    tyres : Tyres, optional
        The four wheels, in place of ``lock``: for wheels that are braked unequally, for small crab
        angles, and for a vehicle that yaws.
    rotating_mass : float, str, Quantity or array [-]
        What the rotation of the wheels adds to the mass, as in ``simulate``; a locked wheel adds
        nothing.
    grade : float, str, Quantity or array [-], or a list with one for each segment
        Rise over run, positive uphill in the direction of travel.
    end_speed : float, str, Quantity or array [m/s]
        Speed at the last point, 0 at rest.
    window : float, str, Quantity or array [m]
        Length of the path over which the survey is smoothed: a longer one makes errors of the
        points count less, a shorter one follows a changing bend better. 0 takes in hardly more than
        the nearest three points.
    point_error : float, str, Quantity or array, optional [m]
        Standard deviation of each coordinate of every point, independent of the others: 0.06 m if
        each is within 0.1 m.
    heading_error : float, str, Quantity or array, optional [rad]
        Standard deviation of every heading, independent of the others. Give both errors or neither.

    Returns
    -------
    RunOut
        Course and yaw rate are tangents, at the first point, of least-squares parabolas: through
        the positions over the length of the path, and through the headings over time. With two
        points they are those of the straight line. A case of a batch that cannot be answered is
        NaN.

    Raises
    ------
    InputError
        Naming every argument that cannot be used.
    MissingInputError
        One of ``point_error`` and ``heading_error`` without the other; neither ``tyres`` nor
        ``friction`` and ``lock``.
    NoSolutionError
        No initial speed leads to this end.

    Warns
    -----
    CollisionsWarning
        How many cases of a batch cannot be answered, and why.
    OutOfRangeWarning
        More than a quarter turn between two points, where one crab angle stands for all of it.
        Without ``tyres``, a yaw rate at separation above 0.5 times the speed over 1.5 m, or, with a
        ``lock`` below 0.4, above 0.3 + lock/2 times it: the speed comes out 4 to 9 % too high
        there, in single ones by up to 12 %, and beyond it soon more.
    SuspectUnitsWarning
        A bare friction above 1.5, grade beyond 0.5 or heading beyond a turn, which is probably in
        another unit.

    Notes
    -----
    The drag is that of the wheels of ``Tyres``, which ``simulate`` has too: a wheel that is braked
    by a moment rolls until its brake can hold it, so the force along it is that of the brake, or
    less where it is locked, and what the friction circle leaves acts across it. The integrated spin
    of a wheel gives the same. Side forces are taken to be all that the circle leaves, as they are
    from a crab angle of some degrees on: a vehicle that points along its path, whose headings were
    read with errors of some degrees, comes out too fast. All wheels are taken to slip as the centre
    of mass does, which leaves out what yawing adds to the slip of each wheel; steering and load
    transfer are left out too. ``tyres`` have all of these, of the turn per way from point to point.
    In ``simulate``, which includes the yawing, the drag along the path is lower, by a fraction that
    grows as r**2, with r the yaw rate times 1.5 m over the speed, both at separation: 0.35 r**2
    with locked wheels, and with wheels that are braked 0.3 to 0.9 r**2, mostly 0.4 to 0.5. The
    speed is too high by half of that: at r = 0.45 by 3 to 5.5 % with locked wheels, the more the
    larger the radius of gyration (of the 0.35, it is 1.26 m), by 3 to 7 % with a lock of 0.4, and
    at the limit of the warning mostly by 4 to 9 % with any lock, for a large radius of gyration by
    up to 12 %.

    A wheel that turns has the spin of one that rolls, with ``rotating_mass``. Where ``lock`` or
    ``friction`` changes from one segment to the next, the spin of a wheel that locks is taken by
    its brake, which changes no speed. What the ground gives to a wheel that is released is left
    out, as in ``simulate``: where all four are, the speed is too low by up to ``rotating_mass``.

    Positions and headings are smoothed first, each by a weighted least-squares parabola about its
    point (local regression, Cleveland, J. Am. Stat. Assoc. 74 (1979) 829, here of degree 2): chords
    between the points of a dense survey would be too long, and their directions would scatter. The
    weights fall off along the path as a normal density with a standard deviation of 0.384 windows,
    so that no point enters or leaves abruptly; at the end of a path this is as good as equal
    weights over the window. Two more points always count, however far apart they are, since a
    parabola takes three. Where the curvature changes by k per metre, the course is off by about 0.1
    k window**2. ``course_error`` does not include this, nor does ``speed_error`` include the errors
    of ``friction`` and ``lock``: those are for ``uncertainty.propagate``. Errors are propagated to
    first order, by computing again with each one added and subtracted; they are infinite where no
    speed is left.

    Chaining segments backward from rest, each with the drag of its mean crab angle, is the reverse
    trajectory of Struble and Struble, Automotive Accident Reconstruction, 2nd edition, chapter 4.
    If ``lock`` is read as the share of wheels that are locked while the others roll, the drag is
    friction times the sum of lock and (1 - lock) sin(crab), which is lower by at most 0.12 times
    the friction. On soft ground, the drag measured near broadside exceeds what such formulas give
    (Christoffersen and others, SAE 950139).

    Examples
    --------
    A car spun 160 deg to the left on nearly free wheels and came to rest after 20 m. Its course at
    separation was 12 deg to the right of the straight line to rest, and full friction throughout
    would make it 7 % faster:

    >>> from collisions.travel import path, speed
    >>> places = [(0, 0), (6, -1.6), (12, -2.3), (20, -2.5)]
    >>> run = path(places, ["0 deg", "55 deg", "110 deg", "160 deg"], friction=0.7, lock=0.2)
    >>> [round(drag, 2) for drag in run.drags]
    [0.57, 0.7, 0.57]
    >>> v, w = run.q.speed.to("km/h"), run.q.yaw_rate.to("deg/s")
    >>> print(f"{v:.1f~P}, {w:.0f~P}, {run.q.course_difference.to('deg'):.1f~P}")
    56.0 km/h, 138 deg/s, -12.0 deg
    >>> round(speed(run.distance, drag=0.7) * 3.6, 1)
    60.0
    >>> errors = {"point_error": "0.1 m", "heading_error": "5 deg"}
    >>> run = path(
    ...     places, ["0 deg", "55 deg", "110 deg", "160 deg"], friction=0.7, lock=0.2, **errors
    ... )
    >>> print(f"{run.q.speed_error.to('km/h'):.1f~P}, {run.q.course_error.to('deg'):.1f~P}")
    0.6 km/h, 2.3 deg
    """
    reader = ArgumentReader()
    _refuse_combination(reader, friction, lock, tyres)
    places = read_points(reader, points)
    headed = read_headings(reader, headings, None if places is None else len(places))
    legs = None if places is None else len(places) - 1
    surveyed = Texts(reader.texts)
    wheels = tyres.named if isinstance(tyres, Tyres) else {}
    if friction is None:
        frictions = [wheels.get("friction", math.nan)] * (legs or 1)
    else:
        frictions = for_each(reader, friction, "friction", legs, read_friction)
    locks = for_each(reader, 0.0 if lock is None else lock, "lock", legs, _read_lock)
    rotating = one_value(reader, rotating_mass, "", "rotating_mass", UNIT_INTERVAL)
    grades = for_each(reader, grade, "grade", legs, read_grade)
    end = read_speed(reader, end_speed, "end_speed")
    length = read_length(reader, window, "window")
    errors = read_errors(reader, point_error, heading_error)
    reader.close()
    if tyres is not None:
        for mu in frictions:
            refuse_lifting(wheels, mu, texts_of(tyres.given))
    placed: dict[str, Any] = {f"points[{i}]": place for i, place in enumerate(places or ())}
    arguments = {
        "headings": [angle.value for angle in headed],
        "friction": frictions,
        "lock": locks,
        "grade": grades,
    }
    beside = {"end_speed": [end], "window": [length], "rotating_mass": [rotating], **errors}
    of_tyres = {f"tyres.{name}": [value] for name, value in wheels.items()}
    lists, named, shape = in_one_precision(placed | arguments | of_tyres | beside)
    count = len(placed)
    points, (values, frictions, locks, grades) = lists[:count], lists[count : count + 4]
    numbers = [value for (value,) in lists[count + 4 :]]
    flat = dict(zip(wheels, numbers, strict=False))
    end, length, rotating, *read = numbers[len(wheels) :]
    kind = next(
        (value.dtype for part in lists for value in part if isinstance(value, np.ndarray)), None
    )

    none = isinstance(rotating, float) and rotating == 0.0
    four = None if tyres is None else (tyres, flat)
    ground = _Ground(
        frictions,
        locks,
        grades,
        Wheels(four, None if none else rotating),
        Sentences(texts_of(surveyed)),
    )
    run_out = partial(_run_out, ground=ground, end=end, window=length)
    with np.errstate(all="ignore"):
        turned = [
            in_radians(angle._replace(value=value))
            for angle, value in zip(headed, values, strict=True)
        ]
        found, gaps = run_out(points, turned, kind=kind)
        if errors:
            of_places, of_headings = read
            found |= _errors(run_out, points, turned, of_places, of_headings, shape or (), kind)
        answered = found["time"] + found["distance"] + found["yaw_rate"]
        if shape is not None:
            checks = [
                ("coincident_points", np.equal(x0, x1) & np.equal(y0, y1))
                for (x0, y0), (x1, y1) in pairwise(points)
            ]
            checks += [
                ("turns_too_far", abs(after - before) > HALF_TURN)
                for before, after in pairwise(turned)
            ]
            checks += _checks_of_tyres(flat, frictions)
            checks += [("contradictory", np.isnan(answer)) for answer in (*gaps, answered)]
            checks += [("out_of_range", np.isinf(answer)) for answer in (*gaps, answered)]
            checks += [("out_of_range", np.less_equal(gap, 0.0)) for gap in gaps]
            checks += [("out_of_range", np.isnan(found["course"]))]
            found = settle(found, named, shape, checks)
        elif not (min(gaps) > 0.0 and math.isfinite(answered + found["course"])):
            raise out_of_range()
        _warn_of_wide_segments(turned, locks)
        if tyres is None:
            _warn_of_fast_yaw(found["yaw_rate"], found["speed"], locks[0])
    return in_units_of(RunOut(**found), texts_of(surveyed))


class _Ground(NamedTuple):
    """What slows a vehicle on each segment: friction, lock, grade, its wheels; and how an error
    writes its numbers.
    """

    frictions: Sequence[Any]
    locks: Sequence[Any]
    grades: Sequence[Any]
    wheels: Wheels
    say: Sentences


def _run_out(
    points: Sequence[Sequence[Any]],
    headings: Sequence[Any],
    ground: _Ground,
    end: Any,
    window: Any,
    kind: Any,
) -> tuple[dict[str, Any], list[Any]]:
    """The fields of the run-out from plain numbers, one case or many, and what has to be positive
    and finite of each segment: its duration, and whether it adds to the way and the time before it.
    """
    surveyed = *map(list, zip(*points, strict=True)), list(headings)
    (xs, ys, turned), (at, weights) = smooth(surveyed, window, kind)
    places = list(zip(xs, ys, strict=True))
    steps = [(x1 - x0, y1 - y0) for (x0, y0), (x1, y1) in pairwise(places)]
    lengths: list[Any] = [hypot(dx, dy) for dx, dy in steps]
    turns = [after - before for before, after in pairwise(turned)]
    crabs = [
        _wrapped(before + 0.5 * turn - math_or_numpy(dx, dy).atan2(dy, dx))
        for (dx, dy), before, turn in zip(steps, turned, turns, strict=False)
    ]
    legs = legs_of(ground.frictions, ground.locks, ground.grades, crabs, turns, lengths)
    drags = [ground.wheels.drag(leg) for leg in legs]
    heavier = ground.wheels.heavier(legs, drags)
    drops = [drag + rise for drag, rise in zip(drags, ground.grades, strict=True)]
    longer = [length * more for length, more in zip(lengths, heavier, strict=True)]
    speeds = speeds_along(longer, drops, end, _leg, ground.say)
    between = [(one * two) ** 0.5 for one, two in pairwise(heavier)]
    factors = [heavier[0], *between, heavier[-1]]
    speeds = [speed / factor**0.5 for speed, factor in zip(speeds, factors, strict=True)]
    durations = durations_along(lengths, ground.grades, speeds)
    times = list(accumulate(durations, initial=0.0))
    # Beside a way or a time that is so much longer a segment is lost, and with it the tangent.
    adds = [
        select(one > other, 1.0, 0.0) for sums in (list(at), times) for other, one in pairwise(sums)
    ]
    found = {
        "speed": speeds[0],
        "course": angle_of(*slopes(surveyed[:2], at, weights, kind)),
        "yaw_rate": slopes(surveyed[2:], times, weights, kind)[0],
        "time": sum(durations),
        "distance": sum(lengths),
        "straight_course": angle_of(points[-1][0] - points[0][0], points[-1][1] - points[0][1]),
        "speeds": tuple(speeds),
        "crab_angles": tuple(crabs),
        "drags": tuple(drags),
    }
    return found, durations + adds


def _refuse_combination(reader: ArgumentReader, friction: Any, lock: Any, tyres: Any) -> None:
    """Refuses wheels that are told twice, or not at all."""
    if tyres is not None:
        if not isinstance(tyres, Tyres):
            reader.refuse(not_tyres("tyres", tyres))
        if lock is not None:
            text = "lock is given beside tyres, which have the lock of every wheel; leave it out"
            reader.refuse(InputError(text, code="bad_combination", argument="lock"))
        return
    for name, value in (("friction", friction), ("lock", lock)):
        if value is None:
            text = f"{name} is missing; give it, or tyres=travel.Tyres(...)"
            reader.refuse(MissingInputError(text, code=f"missing_{name}", argument=name))


def _checks_of_tyres(flat: dict[str, Any], frictions: Sequence[Any]) -> list[tuple[str, Any]]:
    """What of the numbers of tyres cannot be, case by case of a batch."""
    checks = [
        ("not_positive", ~np.greater(flat[name], 0.0))
        for name in ("wheelbase", "track", "cornering")
        if name in flat
    ]
    for name in ("lock", *LOCKS):
        if name in flat:
            checks.append(("bad_fraction", np.less(flat[name], 0.0) | np.greater(flat[name], 1.0)))
    if "height" in flat:
        checks.append(("negative_length", np.less(flat["height"], 0.0)))
        checks += [("wheel_lifts", lifts(flat, mu)) for mu in frictions]
    return checks


def _errors(
    run_out: Any,
    points: Sequence[Any],
    turned: Sequence[Any],
    place: Any,
    heading: Any,
    shape: tuple[int, ...],
    kind: Any,
) -> dict[str, Any]:
    """Standard errors of speed, course and yaw rate, by computing again with each reading off by
    its error, either way.
    """
    squares = dict.fromkeys(("speed", "course", "yaw_rate"), np.zeros(shape))
    readings = 3 * len(points)
    for group in np.array_split(
        np.arange(readings), math.ceil(readings * len(points) * math.prod(shape) / _AT_ONCE) or 1
    ):
        which = np.repeat(group, 2).reshape(-1, *(1 for _ in shape))
        off = np.resize([1.0, -1.0], which.shape)
        x, y, turn = (
            [off * error * (which == i) for i in range(first, readings, 3)]
            for first, error in enumerate((place, place, heading))
        )
        places = [(px + dx, py + dy) for (px, py), dx, dy in zip(points, x, y, strict=True)]
        found, _ = run_out(
            places,
            [angle + change for angle, change in zip(turned, turn, strict=True)],
            kind=np.float64,
        )
        for name, square in squares.items():
            change = found[name][0::2] - found[name][1::2]
            change = _wrapped(change) if name == "course" else change
            squares[name] = square + np.sum(np.square(0.5 * change), axis=0)
    errors = {
        f"{name}_error": np.where(np.isnan(square), np.inf, np.sqrt(square))
        for name, square in squares.items()
    }
    return {
        name: float(error) if kind is None else error.astype(kind) for name, error in errors.items()
    }


def _wrapped(angle: Any) -> Any:
    """The angle in (-pi, pi]."""
    if isinstance(angle, float):
        rest: Any = math.remainder(angle, 2.0 * math.pi)
    else:
        rest = angle - 2.0 * math.pi * np.rint(angle / (2.0 * math.pi))
    return select(rest <= -math.pi, math.pi, rest + 0.0)


def _leg(i: int) -> str:
    return f"points[{i}] to points[{i + 1}]"


def _read_lock(reader: ArgumentReader, value: Any, name: str) -> Any:
    return one_value(reader, value, "", name, UNIT_INTERVAL)


def _warn_of_wide_segments(turned: Sequence[Any], locks: Sequence[Any]) -> None:
    turns = [abs(after - before) for before, after in pairwise(turned)]
    each = [
        np.greater(turn, _QUARTER_TURN) & np.less(part, 1.0)
        for turn, part in zip(turns, locks, strict=True)
    ]
    wide = [i for i, cases in enumerate(each) if np.any(cases)]
    if wide:
        named = ", ".join(_leg(i) for i in wide)
        warn(
            OutOfRangeWarning(
                f"{named}: the vehicle turns by more than 90 deg there, and one crab angle "
                "stands for all of it; give points between",
                code="wide_segment",
                segments=tuple(wide),
            ),
            np.any(np.broadcast_arrays(*each), axis=0),
        )


def _warn_of_fast_yaw(yaw_rate: Any, speed: Any, lock: Any) -> None:
    most = np.minimum(_YAW_OF_ROLLING + _YAW_BY_LOCK * lock, _MOST_YAW)
    fast = np.greater(abs(yaw_rate) * _WHEEL_ARM, most * speed)
    if np.any(fast):
        warn(
            OutOfRangeWarning(
                f"the yaw alone makes the wheels slip at more than {_MOST_YAW:g} of the speed at "
                f"separation (with a lock below {_FULL_LOCK:g}, {_YAW_OF_ROLLING:g} + lock/2), "
                "which the drag here leaves out: the speed may be 4 to 12 % too high there, more "
                "beyond; travel.simulate has the slip of each wheel",
                code="fast_yaw",
                cases=int(np.count_nonzero(fast)),
            ),
            fast,
        )
