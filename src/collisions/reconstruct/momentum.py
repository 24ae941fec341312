"""``momentum``: two unknown speeds, or a speed and a course, from planar momentum ("360-degree"),
masses and the other courses and speeds.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import replace
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from ..impact.doubts import NEARLY_COLLINEAR
from ..impact.inputs import OnFailure
from ..impact.run import check_options
from ..kernels.reverse import Term, unknown_speed
from ..kernels.status import EPS, Status
from ..messages.errors import (
    AmbiguousSolutionError,
    CollisionsError,
    CollisionsWarning,
    EnergyGainWarning,
    IllConditionedWarning,
    InputError,
    MissingInputError,
    NoSolutionError,
    OutOfRangeWarning,
)
from ..messages.hints import hinted
from ..messages.warning import quietly, warn_of_cases
from ..quantities.attributes import format_value, hypot, in_units_of
from ..quantities.directions import Angle, angle_of, course, direction
from ..quantities.reading import ArgumentReader, amount
from ..quantities.refusals import yes_or_no
from ..quantities.tables import Sentences, said
from ..quantities.units import Input, Pair, is_quantity, magnitude, texts_of
from ..vehicle.tyres import Tyres
from .common import (
    Cases,
    exactly,
    input_faults,
    raise_or_warn,
    read_masses,
    state_instant,
    state_other,
    warn_of_condition,
)
from .momentum_others import other_velocity
from .momentum_solution import MomentumSolution, Sensitivity
from .momentum_tyres import MOST_CORRECTIONS, TURN_ROUND, Lasting, read_tyres, why_it_moves
from .momentum_vector import NEARLY_CANCELLING, Beside, Whole, sought_course, without_course

_SPEEDS = ("speed_a", "speed_b", "speed_a_after", "speed_b_after")
_COURSES = ("course_a", "course_b", "course_a_after", "course_b_after")
# What stands in a record after all courses.
_AFTER_COURSES = ("together", "outside_impulse", "duration", "tyres_a", "tyres_b", "normal")
# Of a course that is sought beside the speed of another: along with its course, and against it.
_SIDES = (1.0, -1.0)
_NO_COSINE = (
    8.0 * EPS
)  # of the cosine of a right angle: rounding of the courses, in radians, and of their difference


@hinted
def momentum(
    mass_a: Input,
    mass_b: Input,
    *,
    course_a: Input | None = None,
    course_b: Input | None = None,
    course_a_after: Input | None = None,
    course_b_after: Input | None = None,
    speed_a: Input | None = None,
    speed_b: Input | None = None,
    speed_a_after: Input | None = None,
    speed_b_after: Input | None = None,
    heading_a: Input | None = None,
    heading_b: Input | None = None,
    course_near: Input | None = None,
    together: bool = False,
    normal: Input | tuple[Input, Input] | None = None,
    outside_impulse: Pair | None = None,
    duration: Input | None = None,
    tyres_a: Tyres | None = None,
    tyres_b: Tyres | None = None,
    yaw_rate_a_after: Input | None = None,
    yaw_rate_b_after: Input | None = None,
    on_failure: OnFailure | None = None,
) -> MomentumSolution:
    """Two unknown speeds of an impact from planar momentum, with all courses known; or one speed
    and one course.

    The linear momentum of two bodies in the road plane is conserved (eqs 1 and 2 of "Application of
    Impulse Momentum Theory to Vehicle Collisions"), apart from a stated outside impulse. Nothing is
    assumed about restitution, friction or rotation. The method is good where the courses cross; the
    nearer they come to one line, the less momentum tells, whatever the algorithm.

    A contact of 0.1 s gives tyres the time to take about a tenth of the momentum that the impact
    moves. With ``duration`` and ``tyres_a``, ``tyres_b`` their impulse is in the balance: the force
    of the wheels before the contact, half-way through it and after it (Simpson's rule), times the
    duration, as ``eccentric`` takes it. It follows from the velocities that are found, so they are
    found again with it until it changes no more; where it does not settle, the case is refused.
    Before the contact no vehicle turns, and half-way through it 29 percent of the change of
    velocity have passed, as in a plastic contact.

    Parameters
    ----------
    mass_a, mass_b : float, str, Quantity or array [kg]
        Masses, > 0 and finite.
    course_a, course_b, course_a_after, course_b_after : float, str, Quantity or array [rad]
        Directions of motion, counter-clockwise from +x; a vehicle at rest (speed 0) needs none.
    speed_a, speed_b, speed_a_after, speed_b_after : float, str, Quantity or array [m/s]
        The known speeds, >= 0; leave out the two that are sought. Or leave out one speed and one
        course. If both are of one vehicle, they are what the other momenta leave. If the course is
        that of another vehicle, or of the other end, whose speed is known, two courses may fit:
        along with the motion whose speed is sought, and against it.
    heading_a, heading_b : float, str, Quantity or array [rad], optional
        Directions in which the vehicles pointed, for the PDOF.
    course_near : float, str, Quantity or array [rad], optional
        About where the course lies that is sought beside the speed of another: of two that fit, the
        nearer is the answer. Without it, one in which no vehicle goes backwards comes before one
        in which a vehicle does.
    together : bool, optional
        Whether the vehicles leave as one: give the common course, and the common speed if it is
        known, for either or both. With both speeds and courses before, neither: the common speed
        and course after are then found.
    normal : angle [rad] or tuple (nx, ny), optional
        Direction from A into B for the closing speed and restitution, which are those of the
        centres of mass.
    outside_impulse : pair [N*s], optional
        Impulse of a kerb, or of anything else from outside, on both vehicles together, during the
        impact. That of tyres is worked out where ``tyres_a`` or ``tyres_b`` are given.
    duration : float, str, Quantity or array [s], optional
        How long the contact lasts, > 0, for the tyres: 0.05 to 0.15 s for cars.
    tyres_a, tyres_b : travel.Tyres, optional
        The wheels of each vehicle, which then needs its heading; one without has no tyre forces,
        and ``.statements`` say what they would change.
        The answer is the one to which the balance without tyres leads. Of one velocity before,
        sought whole, others are looked for where the vehicle is so slow that its tyres turn it.
    yaw_rate_a_after, yaw_rate_b_after : float, str, Quantity or array [rad/s], optional
        Yaw rates just after, counter-clockwise, for the slip of the wheels; 0 if not given, which
        ``explain`` and ``report`` then say. They count for nothing but the tyres.
    on_failure : {None, "raise", "nan"}, optional
        What to do with a refused case of a batch.

    Returns
    -------
    MomentumSolution
        All eight courses and speeds, delta-V, PDOF, ``condition`` = (1 + abs(cos)) / abs(sin) of
        the angle between the courses of the unknown speeds (1 at right angles), and the
        ``sensitivity`` of each answer to each input. With a speed and its course unknown the
        condition is the sum of the other momenta over what they leave; with the course of another,
        (1 + abs(sin)) / abs(cos) of the angle between the two. With tyres, delta-V, the
        restitution and the energy lost have their part in them, and the PDOF, which is that of the
        contact, has not; ``tyre_impulse_x_a`` and so on say which impulse that was, and the
        sensitivities are those with that impulse as it is. An ``outside_impulse`` stands for both
        vehicles, so the part of each is not known: it is in its delta-V and in its PDOF.

    Raises
    ------
    InputError
        An argument that cannot be used, or not exactly two unknown speeds, or one and one course.
    AmbiguousSolutionError
        Two courses fit that are sought beside the speed of another; both are in ``solutions``.
    MissingInputError
        The course of a moving vehicle was not given, or what tyres need: a duration, a heading.
    NoSolutionError
        The courses of the two unknown speeds are parallel, or the momenta cancel that an unknown
        course is to be found from; or a known speed is too small on any course; or the impulse of
        the tyres does not settle.

    Warns
    -----
    IllConditionedWarning
        The courses of the two unknown speeds are within 10 degrees of one line, or the momenta
        nearly cancel that an unknown course is to be found from, or a course is found within 10
        degrees of a right angle to that of the unknown speed. Or the closing speed along ``normal``
        is below a millionth of the speeds.
    OutOfRangeWarning
        A speed came out negative: backwards along its course. Or, along ``normal``, the restitution
        is outside 0 to 1, or the vehicles did not approach and it is NaN. Or, with tyres, another
        velocity before fits too.
    EnergyGainWarning
        The vehicles leave with more energy than they had before, by more than an impulse from
        outside can bring: its size times the greatest of all speeds.

    Examples
    --------
    A car going south and one going east meet at right angles (course sheet, published answers 63.2
    and 55.62 km/h).

    >>> from collisions import reconstruct
    >>> found = reconstruct.momentum(
    ...     1200,
    ...     1800,
    ...     course_a="270 deg",
    ...     course_b="0 deg",
    ...     course_a_after="-30 deg",
    ...     course_b_after="-40 deg",
    ...     speed_a_after="30 km/h",
    ...     speed_b_after="50 km/h",
    ... )
    >>> round(found.q.speed_a.m_as("km/h"), 2), round(found.q.speed_b.m_as("km/h"), 2)
    (63.21, 55.62)
    >>> round(found.q.sensitivity["speed_a"]["course_b_after"].m_as("km/h/deg"), 2)
    -1.0

    The same cars, had they stayed together: where to, and how fast.

    >>> found = reconstruct.momentum(
    ...     1200,
    ...     1800,
    ...     course_a="270 deg",
    ...     course_b="0 deg",
    ...     speed_a="63.2 km/h",
    ...     speed_b="55.6 km/h",
    ...     together=True,
    ... )
    >>> round(found.q.speed_a_after.m_as("km/h"), 1), round(found.q.course_a_after.m_as("deg"), 1)
    (41.9, -37.2)

    The same where the contact takes 0.1 s, B rolls, and A brakes with all wheels locked:

    >>> from collisions.travel import Tyres
    >>> lasting = reconstruct.momentum(
    ...     1200,
    ...     1800,
    ...     course_a="270 deg",
    ...     course_b="0 deg",
    ...     course_a_after="-30 deg",
    ...     course_b_after="-40 deg",
    ...     speed_a_after="30 km/h",
    ...     speed_b_after="50 km/h",
    ...     heading_a="270 deg",
    ...     heading_b="0 deg",
    ...     duration="100 ms",
    ...     tyres_a=Tyres(0.7, 1.0, "2.6 m", "1.5 m"),
    ...     tyres_b=Tyres(0.7, 0.0, "2.7 m", "1.5 m"),
    ... )
    >>> round(lasting.q.speed_a.m_as("km/h"), 2), round(lasting.q.speed_b.m_as("km/h"), 2)
    (68.54, 56.02)
    """
    if not isinstance(together, bool):
        raise yes_or_no("together", together, code="bad_option")
    check_options(on_failure)
    speeds = dict(zip(_SPEEDS, (speed_a, speed_b, speed_a_after, speed_b_after), strict=True))
    courses = dict(zip(_COURSES, (course_a, course_b, course_a_after, course_b_after), strict=True))
    courses |= {"heading_a": heading_a, "heading_b": heading_b, "course_near": course_near}
    reader = ArgumentReader()
    numbers = read_masses(reader, mass_a, mass_b)
    for name, value in speeds.items():
        if value is not None:
            numbers[name] = amount(reader, value, "m/s", name, "turn its course by 180 deg")
    angles = {
        name: course(reader, value, name) for name, value in courses.items() if value is not None
    }
    numbers |= {name: angle.value for name, angle in angles.items()}
    if outside_impulse is not None:
        x, y = reader.pair(outside_impulse, "N*s", "outside_impulse")
        numbers |= {"outside_impulse[0]": x, "outside_impulse[1]": y}
    if normal is not None:
        x, y = direction(reader, normal, "normal", numbers.values())
        numbers |= {"normal[0]": x, "normal[1]": y}
    lasting = read_tyres(
        reader,
        duration,
        (tyres_a, tyres_b),
        (yaw_rate_a_after, yaw_rate_b_after),
        (heading_a, heading_b),
    )
    reader.close()
    cases = Cases.of(numbers if lasting is None else numbers | lasting.numbers)
    numbers = {
        name: value.astype(cases.dtype) if isinstance(value, np.ndarray) else value
        for name, value in numbers.items()
    }
    angles = {name: angle._replace(value=numbers[name]) for name, angle in angles.items()}
    given: dict[str, Any] = {
        name: reader.texts.get(name, value) for name, value in numbers.items() if "[" not in name
    }
    if together:
        given["together"] = True
    if outside_impulse is not None:
        given["outside_impulse"] = [
            reader.texts.get(name, numbers[name]) for name in numbers if name.startswith("outside")
        ]
    if lasting is not None:
        given |= {
            name: reader.texts.get(name, value)
            for name, value in lasting.numbers.items()
            if "." not in name
        }
        given |= {f"tyres_{label}": tyres for label, tyres in lasting.tyres.items()}
    if normal is not None and cases.shape is None:
        given["normal"] = (
            [*map(_as_given, normal)] if isinstance(normal, tuple) else _as_given(normal)
        )
    with np.errstate(all="ignore"):
        unlike = (
            np.logical_or(_share(numbers, "speed"), _share(angles, "course")) if together else False
        )
        terms = _terms(numbers, angles, together)
        sought = sought_course(terms)
        if sought is None:
            if sum(term.speed is None for term in terms.values()) == 1:
                # Courses that are missing are what is wrong, not one speed too many.
                _need_courses(terms)
            exactly({name: term.speed for name, term in terms.items()}, len(terms) - 2, "momentum")
        _need_courses({name: term for name, term in terms.items() if name != sought})
        if course_near is not None and (sought is None or terms[sought].speed is None):
            raise InputError(
                "course_near decides between two courses of a vehicle whose speed is known, and no "
                "such course is sought here; leave it out",
                code="bad_combination",
                argument="course_near",
            )
        impulse, normal = (
            (numbers[f"{name}[0]"], numbers[f"{name}[1]"]) if f"{name}[0]" in numbers else None
            for name in ("outside_impulse", "normal")
        )
        if lasting is None:
            state_instant("momentum")
        else:
            masses = numbers["mass_a"], numbers["mass_b"]
            state_other("momentum", lasting.tyres, masses)
        known = _Known(cases, numbers, angles, terms, impulse, normal, unlike, lasting)
        return in_units_of(
            _solve(known, given if cases.shape is None else None, on_failure),
            texts_of(reader.texts),
        )


def _as_given(value: Any) -> str | float:
    """The value as text or a number; a Quantity becomes text with all its digits."""
    if is_quantity(value):
        return f"{float(magnitude(value))!r} {value.units}"
    return value if isinstance(value, str) else float(value)


def _share(given: dict[str, Any], kind: str) -> Any:
    """Give both vehicles the value of their common motion; where two were given and differ, refuse
    (in a batch: mark).
    """
    names = [f"{kind}_a_after", f"{kind}_b_after"]
    found = [given[name] for name in names if name in given]
    if not found:
        return False
    one, other = found[0], found[-1]
    unlike: Any = (
        np.logical_not(_same_course(one, other)) if kind == "course" else np.not_equal(one, other)
    )
    if np.ndim(unlike) == 0 and unlike:
        both = " and ".join(
            format_value(value.radians.item() if isinstance(value, Angle) else value)
            for value in found
        )
        raise InputError(
            f"{names[0]} and {names[1]} differ ({both}), which vehicles that leave together "
            "cannot; give one of them",
            code="contradictory",
            argument=names[1],
        )
    given.update(dict.fromkeys(names, one))
    return unlike


def _same_course(one: Angle, other: Angle) -> Any:
    cosine, sine = one.to(other)
    return (abs(sine) <= _angle_rounding(one, other, EPS)) & (cosine > 0.0)


def _angle_rounding(one: Angle, other: Angle, eps: float) -> Any:
    """Rounding error of the angle between two courses; courses in whole degrees only have the error
    of their conversion.
    """
    return (
        4.0
        * eps
        * (
            1.0
            + sum(0.0 if angle.in_degrees else abs(angle.within_turns) for angle in (one, other))
        )
    )


def _terms(numbers: dict[str, Any], angles: dict[str, Angle], together: bool) -> dict[str, Term]:
    """The moving bodies by the name of their speed; two that leave together are one."""
    terms = {}
    for name, course_name in zip(_SPEEDS, _COURSES, strict=True):
        mass, sign = numbers[f"mass_{name[6]}"], -1.0 if name.endswith("after") else 1.0
        terms[name] = Term(sign, mass, numbers.get(name), angles.get(course_name))
    if together:
        del terms["speed_b_after"]
        terms["speed_a_after"] = terms["speed_a_after"]._replace(
            mass=numbers["mass_a"] + numbers["mass_b"]
        )
    return terms


def _need_courses(terms: dict[str, Term]) -> None:
    if missing := without_course(terms):
        wanted = ", ".join(name.replace("speed", "course") for name in missing)
        raise MissingInputError(
            f"{wanted} not given, and momentum needs the course of every vehicle that moves; "
            "only a speed of 0 needs none",
            code="missing_course",
            argument=wanted,
        )


class _Known(NamedTuple):
    """The known numbers, courses and headings by argument, the moving bodies, the cases in which
    common values differ, and to which side a course is taken where two fit (``Beside``).
    """

    cases: Cases
    numbers: dict[str, Any]
    angles: dict[str, Angle]
    terms: dict[str, Term]
    impulse: tuple[Any, Any] | None
    normal: tuple[Any, Any] | None
    unlike: Any
    lasting: Lasting | None
    side: Any = None

    def velocities(self, speeds: dict[str, Any]) -> dict[str, tuple[Any, Any]]:
        """Velocities along x and y by the names of speeds; a vehicle at rest has no course."""
        found = {}
        for name, course_name in zip(_SPEEDS, _COURSES, strict=True):
            c, s = self.angles[course_name].direction if course_name in self.angles else (0.0, 0.0)
            found[name] = speeds[name] * c, speeds[name] * s
        return found

    def balanced(
        self, pushes: list[tuple[Any, Any]]
    ) -> tuple[_Known, dict[str, Any], Whole | Beside | None]:
        """All speeds by name, those found with impulses from outside; where a course is sought
        beside a speed, both, and what is known with that course.
        """
        found = {name: term.speed for name, term in self.terms.items()}
        known, turning = self, self.turning(pushes)
        if turning is not None:
            found[turning.speed_of] = turning.speed
            turned = dict.fromkeys(self.turned(turning), Angle(turning.angle, False))
            known = self._replace(angles=self.angles | turned)
        else:
            x: Any = sum(push for push, _ in pushes)
            y: Any = sum(push for _, push in pushes)
            impulse = (x, y) if pushes else None
            (first, one), (second, other) = self.unknown
            found[first] = unknown_speed(self.terms.values(), impulse, one, other)
            found[second] = unknown_speed(self.terms.values(), impulse, other, one)
        found.setdefault("speed_b_after", found["speed_a_after"])
        return known, found, turning

    def turning(self, pushes: list[tuple[Any, Any]]) -> Whole | Beside | None:
        """The speed and the course that are sought, if a course is, with impulses from outside."""
        name = sought_course(self.terms)
        if name is None:
            return None
        if self.terms[name].speed is None:
            return Whole(self.terms, name, pushes)
        return Beside(self.terms, (self.unknown[0][0], name), pushes, self.side)

    def turned(self, turning: Whole | Beside) -> list[str]:
        """The courses that are found; vehicles that leave together have one."""
        if len(self.terms) == 3 and turning.course_of == "speed_a_after":
            return ["course_a_after", "course_b_after"]
        return [turning.course_of.replace("speed", "course")]

    def tyre_impulses(self, speeds: dict[str, Any]) -> dict[str, tuple[Any, Any]]:
        """What the tyres of each vehicle give while the contact lasts."""
        if self.lasting is None:
            return {}
        return self.lasting.impulses(
            {label: self.numbers[f"mass_{label}"] for label in "ab"},
            {
                label: self.angles[name].radians
                for label in "ab"
                if (name := f"heading_{label}") in self.angles
            },
            self.velocities(speeds),
            self.cases.shape is None,
        )

    @property
    def unknown(self) -> list[tuple[str, Term]]:
        """The terms of unknown speed with the names of their speeds."""
        return [(name, term) for name, term in self.terms.items() if term.speed is None]


class _Balance(NamedTuple):
    """What is known with a course that was found, all speeds, that course and its speed, the
    impulses of the tyres, and where they have not settled.
    """

    known: _Known
    speeds: dict[str, Any]
    turning: Whole | Beside | None
    tyres: dict[str, tuple[Any, Any]]
    unsettled: Any

    @property
    def condition(self) -> Any:
        """The growth of errors in the answer."""
        if self.turning is not None:
            return self.turning.condition
        (_, one), (_, other) = self.known.unknown
        cosine, sine = one.course.to(other.course)
        return np.divide(1.0 + abs(cosine), abs(sine))

    @property
    def rounding(self) -> Any:
        """Rounding error of the results, as a speed of the lighter vehicle."""
        numbers = self.known.numbers
        flow = sum(numbers[f"mass_{name[6]}"] * abs(self.speeds[name]) for name in _SPEEDS)
        lighter = np.minimum(numbers["mass_a"], numbers["mass_b"])
        growth = 1.0 if isinstance(self.turning, Whole) else self.condition
        return 16.0 * self.known.cases.eps * growth * (flow / lighter)


def _balance(known: _Known, stated: list[tuple[Any, Any]]) -> _Balance:
    """The balance of momentum solved, with the tyres until they change no more."""
    found, speeds, turning = known.balanced(stated)
    if known.lasting is None:
        return _Balance(found, speeds, turning, {}, False)
    tyres: dict[str, tuple[Any, Any]] = dict.fromkeys(known.lasting.tyres, (0.0, 0.0))
    moving: Any = True
    unsettled: Any = False
    for _ in range(MOST_CORRECTIONS):
        tyres, moving, unsettled = known.lasting.corrected(
            tyres, found.tyre_impulses(speeds), moving
        )
        found, speeds, turning = known.balanced([*tyres.values(), *stated])
        if not np.any(moving):
            break
    return _Balance(found, speeds, turning, tyres, unsettled)


def _sided(known: _Known, stated: list[tuple[Any, Any]]) -> tuple[_Known, Any, Any]:
    """What is known with the side of a course that is sought beside the speed of another, where
    both sides fit, and where one was lost as the tyres were worked out: then the other is no more
    than one of the answers.
    """
    both = [_balance(known._replace(side=side), stated) for side in _SIDES]
    found = [one.turning for one in both if isinstance(one.turning, Beside)]
    fits = [
        one.possible & np.logical_not(balance.unsettled)
        for one, balance in zip(found, both, strict=True)
    ]
    if "course_near" in known.angles:
        near = known.angles["course_near"]
        # The cosine falls as the angle grows, to either side.
        one, other = (near.to(Angle(turning.angle, False))[0] for turning in found)
        takes = [fits[0] & (~fits[1] | (one >= other)), fits[1] & (~fits[0] | (other >= one))]
    else:
        ahead = [
            fit & (turning.speed >= -balance.rounding)
            for fit, turning, balance in zip(fits, found, both, strict=True)
        ]
        some = ahead[0] | ahead[1]
        takes = [np.where(some, go, fit) for go, fit in zip(ahead, fits, strict=True)]
    several = takes[0] & takes[1] & ~found[0].at_an_end
    side = np.where(takes[1] & ~takes[0], _SIDES[1], _SIDES[0])
    lost = np.not_equal(*fits) if known.lasting is not None else np.False_
    return known._replace(side=float(side) if known.cases.shape is None else side), several, lost


def _solve(known: _Known, given: dict[str, Any] | None, on_failure: Any) -> MomentumSolution:
    """Solve one case or many; raises for a refused single case."""
    cases, impulse, normal = known.cases, known.impulse, known.normal
    masses = known.numbers["mass_a"], known.numbers["mass_b"]
    stated = [] if impulse is None else [impulse]
    asked, several, lost = known, np.False_, np.False_
    sought = sought_course(known.terms)
    if sought is not None and known.terms[sought].speed is not None and known.side is None:
        known, several, lost = _sided(known, stated)
    balance = _balance(known, stated)
    known, speeds, turning, tyres, unsettled = balance
    unsettled = unsettled | lost
    condition, rounding = balance.condition, balance.rounding
    if turning is not None:
        first, second = turning.speed_of, turning.course_of.replace("speed", "course")
    else:
        (first, one), (second, other) = known.unknown
    # What makes the balance itself unable to tell.
    undetermined: list[tuple[Any, Status]] = []
    if isinstance(turning, Beside):
        undetermined = [(~turning.possible, Status.CONTRADICTORY), (several, Status.AMBIGUOUS)]
    elif turning is not None:
        undetermined = [(turning.speed <= rounding, Status.UNDETERMINED)]
    else:
        sine = one.course.to(other.course)[1]
        undetermined = [
            (
                abs(sine) <= _angle_rounding(one.course, other.course, cases.eps),
                Status.PARALLEL_HEADINGS,
            )
        ]
    outcome = _outcome(known, speeds, tyres)
    lighter = np.minimum(*masses)
    loss = outcome["translational_energy_loss"]
    sizes = [abs(speeds[name]) for name in _SPEEDS]
    # An impulse from outside does no more work than on a vehicle that moves along it all the while.
    work = 0.0 if impulse is None else np.hypot(*impulse) * reduce(np.maximum, sizes)
    gains = -loss > 4.0 * rounding * lighter * sum(sizes) + work
    status = cases.first_status(
        (
            *((np.isposinf(mass), Status.INFINITE_MASS) for mass in masses),
            (normal is not None and (normal[0] == 0.0) & (normal[1] == 0.0), Status.ZERO_NORMAL),
            *input_faults(known.numbers),
            *(() if known.lasting is None else known.lasting.faults()),
            (known.unlike, Status.CONTRADICTORY),
            *undetermined,
            (unsettled, Status.UNDETERMINED),
            (cases.beyond(sum(speeds[name] for name in _SPEEDS) + loss), Status.OUT_OF_RANGE),
            (gains, Status.ENERGY_GAIN),
        )
    )

    def refusal(index: tuple[int, ...]) -> CollisionsError:
        outcome = Status(int(np.asarray(status)[index]))
        if isinstance(turning, Beside) and outcome in (Status.CONTRADICTORY, Status.AMBIGUOUS):
            if outcome is Status.AMBIGUOUS and cases.shape is None:
                return _both(asked, given or {}, second)
            least = float(np.broadcast_to(turning.least, np.shape(status))[index])
            if (
                outcome is Status.AMBIGUOUS
                or not np.broadcast_to(turning.possible | known.unlike, np.shape(status))[index]
            ):
                return _beside_refusal(outcome, first, second, least, (given or {}).values())
        return _refusal(
            outcome, first, second, bool(np.broadcast_to(unsettled, np.shape(status))[index])
        )

    raise_or_warn(status, on_failure, refusal)
    sure = np.less_equal(status, Status.ENERGY_GAIN)
    found = {"mass_a": masses[0], "mass_b": masses[1]} | {
        name: angle.radians for name, angle in known.angles.items()
    }
    if normal is not None:
        found["normal_angle"] = angle_of(*normal)
    if impulse is not None:
        found["outside_impulse_x"], found["outside_impulse_y"] = impulse
    answers = {**speeds, **outcome, "condition": condition}
    if turning is not None:
        answers |= dict.fromkeys(known.turned(turning), turning.angle)
        by_input = turning.sensitivity(outside=impulse is not None)
    else:
        by_input = _sensitivity(known, answers)
    if known.lasting is not None:
        found["duration"] = known.lasting.duration
        found |= {
            f"yaw_rate_{label}_after": rate for label, rate in known.lasting.yaw_rates.items()
        }
        for label, push in tyres.items():
            names = (f"tyre_impulse_{axis}_{label}" for axis in "xy")
            answers |= dict(zip(names, push, strict=True))
    found |= {name: np.where(sure, value, np.nan) for name, value in answers.items()}
    solution = MomentumSolution(
        **{name: cases.values(value) for name, value in found.items()},
        sensitivity=Sensitivity(
            {
                name: {label: cases.where(sure, moved) for label, moved in row.items()}
                for name, row in by_input.items()
            }
        ),
        unknowns=(first, second),
        status=Status(status) if isinstance(status, int) else status,
        given=given,
        tyres_a=None if known.lasting is None else known.lasting.tyres.get("a"),
        tyres_b=None if known.lasting is None else known.lasting.tyres.get("b"),
    )
    _warn(known, sure, np.equal(status, Status.ENERGY_GAIN), found, solution, rounding, turning)
    return solution


def _both(known: _Known, given: dict[str, Any], course: str) -> CollisionsError:
    """The error for a single case in which two courses fit, with both answers."""
    solutions = []
    with quietly():
        for side in _SIDES:
            one = _solve(known._replace(side=side), given, None)
            # By itself each is the answer to the same with its own course stated.
            stated: Any = float(getattr(one, course))
            # Where the call has it, so that a record of it is the same.
            first = {name: given[name] for name in given if name not in _AFTER_COURSES}
            last = {name: given[name] for name in given if name in _AFTER_COURSES}
            ordered = {**first, "course_near": stated, **last}
            solutions.append(replace(one, given=ordered, course_near=stated))
    say = Sentences(given.values())
    speed = solutions[0].unknowns[0]
    courses = say.apart([getattr(one, course) for one in solutions], "angle")
    each = " or ".join(
        f"{course} = {lies} with {speed} = {say(getattr(one, speed), 'speed')}"
        for lies, one in zip(courses, solutions, strict=True)
    )
    return AmbiguousSolutionError(
        f"two answers fit: {each}`|; both are in .solutions|`; what decides is `course_near=`, "
        f"about where {course} lies",
        code=Status.AMBIGUOUS.label,
        solutions=tuple(solutions),
    )


def _beside_refusal(
    status: Status, speed: str, course: str, least: float, texts: Collection[Any]
) -> CollisionsError:
    """The error for a case in which no course fits beside an unknown speed, or both do."""
    if status is Status.AMBIGUOUS:
        return AmbiguousSolutionError(
            f"two courses fit {course}; give `course_near=`, about where it lies",
            code=status.label,
        )
    known = course.replace("course", "speed")
    enough = Sentences(texts).at_least(least, "speed")
    return NoSolutionError(
        f"no {course} fits: across the course of {speed} the other momenta ask for a {known} of "
        f"{enough} or more; check it and the other courses and speeds, or "
        f"give `{course}=` and leave {known} open",
        code=status.label,
    )


def _refusal(status: Status, first: str, second: str, unsettled: bool) -> CollisionsError:
    """The error for a case with these unknowns."""
    if status is Status.PARALLEL_HEADINGS:
        return NoSolutionError(
            f"the courses of {first} and {second} are parallel, so momentum cannot tell them "
            "apart; for an in-line impact use reconstruct.central or "
            "reconstruct.inline_closing_speed, for one with known geometry reconstruct.speeds",
            code="parallel_headings",
        )
    if status is Status.UNDETERMINED and unsettled:
        return NoSolutionError(
            f"{first} and {second} do not settle while the tyres act: small changes of them turn "
            "the force of the wheels too far; check the courses, or leave out duration, tyres_a "
            "and tyres_b, and the answer is that of an instant",
            code="undetermined",
        )
    if status is Status.UNDETERMINED:
        return NoSolutionError(
            f"the other momenta cancel, so {first} is 0 and there is no {second}; give "
            f"`{first}=0` and leave two other speeds open",
            code="undetermined",
        )
    if status is Status.INFINITE_MASS:
        return NoSolutionError(
            "a mass is inf, and a body that no impulse slows down has no balance of momentum; "
            "for an impact on a barrier use reconstruct.central, reconstruct.planar or "
            "reconstruct.speeds",
            code="infinite_mass",
        )
    why = status.sentence
    if status is Status.CONTRADICTORY:
        why = (
            "a known speed is below 0 (turn its course by 180 deg), or vehicles that leave "
            "together have two speeds or two courses"
        )
    return InputError(f"momentum: {why}", code=status.label)


def _outcome(
    known: _Known, speeds: dict[str, Any], tyres: Mapping[str, tuple[Any, Any]]
) -> dict[str, Any]:
    """The solution from all speeds and courses, and the impulses of the ``tyres`` by vehicle."""
    velocity = known.velocities(speeds)
    found: dict[str, Any] = {}
    loss: Any = 0.0
    for side in "ab":
        (ux, uy), (wx, wy) = velocity[f"speed_{side}"], velocity[f"speed_{side}_after"]
        dx, dy = wx - ux, wy - uy
        found[f"delta_v_{side}"] = hypot(dx, dy)
        mass = known.numbers[f"mass_{side}"]
        loss = loss - 0.5 * mass * (dx * (ux + wx) + dy * (uy + wy))
        if f"heading_{side}" in known.angles:
            hx, hy = known.angles[f"heading_{side}"].direction
            if side in tyres:
                # The force is that of the contact, without what the tyres do.
                dx, dy = (
                    change - push / mass for change, push in zip((dx, dy), tyres[side], strict=True)
                )
            found[f"pdof_{side}"] = angle_of(-(hx * dx + hy * dy), hx * dy - hy * dx)
    found["translational_energy_loss"] = loss
    if known.normal is not None:
        nx, ny = known.normal
        (ax, ay), (bx, by), (cx, cy), (ex, ey) = (velocity[name] for name in _SPEEDS)
        closing = nx * (ax - bx) + ny * (ay - by)
        parting = nx * (ex - cx) + ny * (ey - cy)
        found["closing_speed"] = closing
        found["restitution"] = parting / np.where(closing > 0.0, closing, np.nan)
    return found


def _sensitivity(known: _Known, speeds: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Derivatives of both unknown speeds by every input, from the momentum balance itself."""
    found: dict[str, dict[str, Any]] = {}
    moving = {name: term for name, term in known.terms.items() if term.course is not None}
    unknown = [(name, term) for name, term in known.terms.items() if term.speed is None]
    for (name, wanted), (_, other) in (unknown, unknown[::-1]):
        # Cosine and sine from each course to that of the other unknown, with which the balance is
        # crossed.
        turns = {label: term.course.to(other.course) for label, term in moving.items()}
        row: dict[str, Any] = {}
        for side in "ab":
            # Vehicles that leave together have one term.
            own = [
                label
                for label in moving
                if side == label[6] or (label == "speed_a_after" and len(known.terms) == 3)
            ]
            row[f"mass_{side}"] = sum(
                moving[label].sign * (speeds[label] * turns[label][1]) for label in own
            )
        for label, term in moving.items():
            cosine, sine = turns[label]
            if term.speed is not None:
                row[label] = term.sign * term.mass * sine
            row[label.replace("speed", "course")] = (
                -term.sign * term.mass * (speeds[label] * cosine)
            )
        if known.impulse is not None:
            c, s = other.course.direction
            row["outside_impulse_x"], row["outside_impulse_y"] = s, -c
        across = wanted.mass * turns[name][1]
        largest = {label: abs(term.mass * speeds[label]) for label, term in moving.items()}
        for label, most in largest.items():
            # What the cosine of a right angle leaves is rounding, and no sensitivity.
            course = label.replace("speed", "course")
            row[course] = np.where(abs(row[course]) <= _NO_COSINE * most, 0.0, row[course])
        found[name] = {
            label: np.divide(-wanted.sign * cross, across) + 0.0 for label, cross in row.items()
        }
    return found


def _warn(
    known: _Known,
    sure: Any,
    gains: Any,
    found: dict[str, Any],
    solution: MomentumSolution,
    rounding: Any,
    turning: Whole | Beside | None,
) -> None:
    """Warn where the solution is ill-conditioned or not a possible impact."""
    texts = (solution.given or {}).values()

    def say(
        kind: type[CollisionsWarning],
        where: Any,
        text: str,
        code: str,
        of: str,
        sentence: str,
        **field: Any,
    ) -> None:
        if np.any(where):
            ((name, values),) = field.items()
            values = np.broadcast_to(values, np.shape(where))[where]
            worst = float(values[np.argmax(abs(values))])
            number = said(worst, of, texts) if of else worst
            warning = kind(
                known.cases.how_many(where) + text.format(number), code=code, **{name: worst}
            )
            warn_of_cases(warning, {sentence: known.cases.each(where)})

    near: Any = False
    if turning is not None:
        cancels = isinstance(turning, Whole)
        sentence = why_it_moves(solution)
        say(
            IllConditionedWarning,
            sure & (found["condition"] > NEARLY_CANCELLING),
            f"{sentence} (condition {{:.3g}})",
            "momenta_cancel" if cancels else "nearly_across",
            "",
            sentence,
            condition=found["condition"],
        )
    else:
        one, other = (known.terms[name].course for name in solution.unknowns)
        sine = abs(one.to(other)[1])
        near = sure & (sine < math.sin(NEARLY_COLLINEAR))
    if np.any(near):
        degrees = math.degrees(math.asin(float(np.min(np.where(near, sine, 1.0)))))
        numbers = "; ".join(
            _largest_by_degree(answer, row, near, texts)
            for answer, row in solution.sensitivity.items()
        )
        sentence = why_it_moves(solution)
        courses = f"{' and '.join(solution.unknowns).replace('speed', 'course')} are"
        text = (
            f"{courses} {degrees:.2g} degrees from one line (condition {{:.3g}}): {numbers}; an "
            "in-line method may tell more"
        )
        say(
            IllConditionedWarning,
            near,
            text,
            "nearly_collinear",
            "",
            sentence,
            condition=found["condition"],
        )
    # A velocity that is sought whole is never backwards along its course.
    speeds = [name for name in solution.unknowns if name.startswith("speed")]
    for name in speeds if not isinstance(turning, Whole) else ():
        text, sentence = f"{name} = {{}}: {TURN_ROUND}", f"{name} is below 0, {TURN_ROUND}"
        # A negative speed within rounding of 0 is not a backward motion.
        say(
            OutOfRangeWarning,
            sure & (found[name] < -rounding),
            text,
            "negative_speed",
            "speed",
            sentence,
            value=found[name],
        )
    other = other_velocity(solution) if known.lasting is not None else None
    if other is not None:
        there = np.isfinite(other.apart[0])
        name = solution.unknowns[0]
        warning = OutOfRangeWarning(
            known.cases.how_many(there) + other.sentence(solution, Sentences(texts)),
            code="another_fits",
            value=float(np.nanmax(other.apart[0])),
        )
        sentence = f"{name} is so slow that with its tyres another velocity fits too"
        warn_of_cases(warning, {sentence: known.cases.each(there)})
    text = (
        "the vehicles leave with {} more than they came with, which no impact gives; check "
        "courses and speeds"
    )
    sentence = (
        "the vehicles leave with more energy than they came with, which no impact gives; check "
        "courses and speeds"
    )
    say(
        EnergyGainWarning,
        gains,
        text,
        "energy_gain",
        "energy",
        sentence,
        gain=-found["translational_energy_loss"],
    )
    if known.normal is None:
        return
    closing, e = found["closing_speed"], found["restitution"]
    sentence = "the centres do not approach along the normal, which must point from A into B"
    text = f"{sentence}: closing speed {{}}, so there is no restitution"
    say(
        OutOfRangeWarning,
        closing <= 0.0,
        text,
        "separating",
        "speed",
        sentence,
        closing_speed=closing,
    )
    speeds = sum(abs(found[name]) for name in _SPEEDS)
    warn_of_condition(
        known.cases.where(np.isfinite(e), np.divide(speeds, closing)),
        "the courses and speeds",
        "the restitution by more than 1",
        "the normal is not that of this impact",
    )
    slack = rounding / closing
    what = "the restitution of the centres along the normal is"
    cure = (
        "outside 0 to 1: check the normal, courses and speeds, or ask reconstruct.restitution "
        "with the contact point"
    )
    wrong = (e < -slack) | (e > 1.0 + slack)
    say(
        OutOfRangeWarning,
        wrong,
        f"{what} {{:.4g}}, {cure}",
        "observed_restitution",
        "",
        f"{what} {cure}",
        value=e,
    )


def _largest_by_degree(answer: str, row: dict[str, Any], near: Any, texts: Collection[Any]) -> str:
    """The course to which a speed is most sensitive, and the sensitivity per degree."""
    moves = {
        name: float(np.max(np.where(near, abs(value), 0.0)))
        for name, value in row.items()
        if name.startswith("course")
    }
    name = max(moves, key=moves.__getitem__)
    return (
        f"{answer} changes by {said(moves[name] * math.pi / 180.0, 'speed', texts, 3)} per "
        f"degree of {name}"
    )
