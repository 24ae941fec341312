"""Planar momentum backwards ("360-degree momentum"): two unknown speeds from masses, courses and the other two."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ..amounts import amount
from ..directions import Angle, between, course, direction
from ..errors import InputError, MissingInputError
from ..inputs import OnFailure
from ..kernels.elementwise import POSITIVE
from ..kernels.reverse import Term
from ..kernels.status import EPS
from ..quantities import show
from ..reading import ArgumentReader
from ..solving import check_options
from ..units import Input, Pair, is_quantity, magnitude, shown
from .common import Cases, exactly
from .momentum_balance import Question, blur, solve
from .momentum_solution import MomentumSolution


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
    together: bool = False,
    normal: Input | tuple[Input, Input] | None = None,
    outside_impulse: Pair | None = None,
    on_failure: OnFailure | None = None,
) -> MomentumSolution:
    """Two unknown speeds of an impact from planar momentum, with all courses known.

    Linear momentum of two bodies in the road plane is conserved (eqs 1 and 2 of "Application of Impulse Momentum Theory to
    Vehicle Collisions"), save for an impulse from outside that is stated. Nothing is assumed of restitution, friction or
    rotation. Good where the courses cross; the nearer they come to one line the less momentum tells, whatever the algorithm.

    Parameters
    ----------
    mass_a, mass_b : float, str, Quantity or array [kg]
        Masses, > 0 and finite.
    course_a, course_b, course_a_after, course_b_after : float, str, Quantity or array [rad]
        Directions of motion, counter-clockwise from +x; a vehicle at rest (speed 0) needs none.
    speed_a, speed_b, speed_a_after, speed_b_after : float, str, Quantity or array [m/s]
        The known speeds, >= 0: leave out the two that are asked for.
    heading_a, heading_b : float, str, Quantity or array [rad], optional
        Where the vehicles pointed, for the PDOF.
    together : bool, optional
        The vehicles leave as one: give the common course, and the common speed if it is known, for either of them or both.
    normal : angle [rad] or tuple (nx, ny), optional
        Direction from A into B along which closing speed and restitution are worked out, from the motion of the centres.
    outside_impulse : pair [N*s], optional
        Impulse of tyres or a kerb on both vehicles together, during the impact.
    on_failure : {None, "raise", "nan"}, optional
        What a refused case of a batch does.

    Returns
    -------
    MomentumSolution
        All eight courses and speeds, delta-V, PDOF, ``condition`` = (1 + abs(cos)) / abs(sin) of the angle between the courses
        of the unknown speeds (1 at right angles), and the ``sensitivity`` of each answer to each input.

    Raises
    ------
    InputError
        An argument that cannot be used, or not exactly two unknown speeds.
    MissingInputError
        The course of a moving vehicle was not given.
    NoSolutionError
        The courses of the two unknown speeds are parallel.

    Warns
    -----
    IllConditionedWarning
        They are within 10 degrees of one line.
    OutOfRangeWarning
        A speed came out negative: backwards along its course. Along ``normal`` the restitution is outside 0 to 1, or the
        vehicles did not approach, which leaves it NaN.
    EnergyGainWarning
        The vehicles leave with more energy than they came with.

    Examples
    --------
    A car going south and one going east meet at right angles (course sheet, published answers 63.2 and 55.62 km/h).

    >>> from collisions import reconstruct
    >>> found = reconstruct.momentum(
    ...     1200, 1800, course_a="270 deg", course_b="0 deg", course_a_after="-30 deg", course_b_after="-40 deg",
    ...     speed_a_after="30 km/h", speed_b_after="50 km/h")
    >>> round(found.q.speed_a.m_as("km/h"), 2), round(found.q.speed_b.m_as("km/h"), 2)
    (63.21, 55.62)
    >>> round(found.q.sensitivity["speed_a"]["course_b_after"].m_as("km/h/deg"), 2)
    -1.0
    """
    if not isinstance(together, bool):
        raise InputError(f"together must be True or False, got {shown(together)}", code="bad_option", argument="together")
    check_options(on_failure)
    speeds = {"speed_a": speed_a, "speed_b": speed_b, "speed_a_after": speed_a_after, "speed_b_after": speed_b_after}
    courses = {
        "course_a": course_a,
        "course_b": course_b,
        "course_a_after": course_a_after,
        "course_b_after": course_b_after,
    }
    reader = ArgumentReader()
    masses = {name: reader.number(value, "kg", name, POSITIVE) for name, value in (("mass_a", mass_a), ("mass_b", mass_b))}
    known = {
        name: amount(reader, value, "m/s", name, "turn its course by 180 deg")
        for name, value in speeds.items()
        if value is not None
    }
    angles = {name: course(reader, value, name) for name, value in courses.items() if value is not None}
    headings = {
        name: course(reader, value, name)
        for name, value in (("heading_a", heading_a), ("heading_b", heading_b))
        if value is not None
    }
    impulse = None if outside_impulse is None else reader.pair(outside_impulse, "N*s", "outside_impulse")
    numbers = {
        **masses,
        **known,
        **{name: angle.value for name, angle in (*angles.items(), *headings.items())},
        **{f"outside_impulse[{i}]": part for i, part in enumerate(impulse or ())},
    }
    along = None if normal is None else direction(reader, normal, "normal", numbers.values())
    reader.close()
    cases = Cases.of({**numbers, **{f"normal[{i}]": part for i, part in enumerate(along or ())}})
    numbers = cases.alike(numbers)
    masses, known = ({name: numbers[name] for name in names} for names in (masses, known))
    angles, headings = (
        {name: angle._replace(value=numbers[name]) for name, angle in known_angles.items()}
        for known_angles in (angles, headings)
    )
    impulse = None if impulse is None else (numbers["outside_impulse[0]"], numbers["outside_impulse[1]"])
    given: dict[str, Any] | None = None
    if cases.shape is None:
        read = masses | known | {name: angle.value for name, angle in (angles | headings).items()}
        given = {name: reader.texts.get(name, value) for name, value in read.items()} | ({"together": True} if together else {})
        if impulse is not None:
            given["outside_impulse"] = [reader.texts.get(f"outside_impulse[{i}]", part) for i, part in enumerate(impulse)]
        if normal is not None:
            given["normal"] = [*map(_as_given, normal)] if isinstance(normal, tuple) else _as_given(normal)
    with np.errstate(all="ignore"):
        unlike = np.logical_or(_share(known, "speed"), _share(angles, "course")) if together else False
        terms = _terms(masses, known, angles, together)
        exactly({name: True if term.speed is not None else None for name, term in terms.items()}, len(terms) - 2, "momentum")
        _need_courses(terms)
        found = solve(cases, Question(terms, masses, angles, headings, impulse, along, unlike, together), on_failure)
    return found if given is None else replace(found, _given=given)


def _as_given(value: Any) -> str | float:
    """A text or a number; a Quantity as a text with all its digits."""
    if is_quantity(value):
        return f"{float(magnitude(value))!r} {value.units}"
    return value if isinstance(value, str) else float(value)


def _share(given: dict[str, Any], kind: str) -> Any:
    """Makes what is common to both vehicles after the impact known for both; where two differ, they contradict each other."""
    names = [f"{kind}_a_after", f"{kind}_b_after"]
    found = [given[name] for name in names if name in given]
    if not found:
        return False
    unlike: Any = False
    if len(found) == 2:
        unlike = np.logical_not(_same_course(*found)) if kind == "course" else np.not_equal(*found)
        if np.ndim(unlike) == 0 and unlike:
            raise InputError(
                f"{names[0]} and {names[1]} differ ({_shown(found[0])} and {_shown(found[1])}), which vehicles that leave "
                f"together cannot; give one of them",
                code="contradictory",
                argument=names[1],
            )
    given.update(dict.fromkeys(names, found[0]))
    return unlike


def _same_course(one: Angle, other: Angle) -> Any:
    cosine, sine = between(one, other)
    return (abs(sine) <= blur(one, other, EPS)) & (cosine > 0.0)


def _shown(value: Any) -> str:
    return show(value.radians.item() if isinstance(value, Angle) and np.ndim(value.radians) == 0 else value)


def _terms(masses: dict[str, Any], known: dict[str, Any], angles: dict[str, Angle], together: bool) -> dict[str, Term]:
    """The moving bodies, by the name of their speed."""
    before = {
        name: Term(1.0, masses[f"mass_{name[6]}"], known.get(name), angles.get(f"course_{name[6]}"))
        for name in ("speed_a", "speed_b")
    }
    if together:
        both = masses["mass_a"] + masses["mass_b"]
        return {**before, "speed_a_after": Term(-1.0, both, known.get("speed_a_after"), angles.get("course_a_after"))}
    after = {
        name: Term(-1.0, masses[f"mass_{name[6]}"], known.get(name), angles.get(f"course_{name[6]}_after"))
        for name in ("speed_a_after", "speed_b_after")
    }
    return {**before, **after}


def _need_courses(terms: dict[str, Term]) -> None:
    missing = [name for name, term in terms.items() if term.course is None and np.any(np.not_equal(term.speed, 0.0))]
    if missing:
        wanted = ", ".join(name.replace("speed", "course") for name in missing)
        raise MissingInputError(
            f"{wanted} not given, and momentum needs the course of every vehicle that moves; only a speed of 0 needs none",
            code="missing_course",
            argument=wanted,
        )
