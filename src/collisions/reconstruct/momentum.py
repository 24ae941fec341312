"""Planar momentum backwards ("360-degree momentum"): two unknown speeds from masses, courses and the other two."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np

from ..amounts import amount
from ..arguments import check_options
from ..directions import Angle, between, course, direction
from ..errors import (
    CollisionsError,
    EnergyGainWarning,
    IllConditionedWarning,
    InputError,
    MissingInputError,
    NoSolutionError,
    OutOfRangeWarning,
    Status,
)
from ..fields import hypot, show
from ..kernels import codes
from ..kernels.crossing import Term, change_of_speed, course_change, unknown_speed
from ..quiet import warn_of_cases
from ..units import POSITIVE, Door, Input, Pair, callers_level, shown
from ..vehicle import angle_of
from .momentum_solution import MomentumSolution, Sensitivity
from .outcome import Cases, exactly, raise_or_warn

_SPEEDS = ("speed_a", "speed_b", "speed_a_after", "speed_b_after")
_COURSES = ("course_a", "course_b", "course_a_after", "course_b_after")
_NEARLY_COLLINEAR = math.radians(10.0)


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
    on_failure: str | None = None,
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
    door = Door()
    masses = {name: door.number(value, "kg", name, POSITIVE) for name, value in (("mass_a", mass_a), ("mass_b", mass_b))}
    known = {
        name: amount(door, value, "m/s", name, "turn its course by 180 deg")
        for name, value in speeds.items()
        if value is not None
    }
    angles = {name: course(door, value, name) for name, value in courses.items() if value is not None}
    headings = {
        name: course(door, value, name).direction
        for name, value in (("heading_a", heading_a), ("heading_b", heading_b))
        if value is not None
    }
    impulse = None if outside_impulse is None else door.pair(outside_impulse, "N*s", "outside_impulse")
    along = None if normal is None else direction(door, normal, "normal")
    door.close()
    cases = Cases.of(
        {
            **masses,
            **known,
            **{name: angle.value for name, angle in angles.items()},
            **{f"{name}[{i}]": part for name, pair in headings.items() for i, part in enumerate(pair)},
            **{f"outside_impulse[{i}]": part for i, part in enumerate(impulse or ())},
            **{f"normal[{i}]": part for i, part in enumerate(along or ())},
        }
    )
    with np.errstate(all="ignore"):
        unlike = np.logical_or(_share(known, "speed"), _share(angles, "course")) if together else False
        terms = _terms(masses, known, angles, together)
        exactly({name: True if term.speed is not None else None for name, term in terms.items()}, len(terms) - 2, "momentum")
        _need_courses(terms)
        return _solve(cases, terms, masses, angles, headings, impulse, along, unlike, together, on_failure)


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
    return (abs(sine) <= _blur(one, other, codes.EPS)) & (cosine > 0.0)


def _blur(one: Angle, other: Angle, eps: float) -> Any:
    """What rounding leaves open of the angle between two courses; whole degrees leave nothing but their conversion."""
    return 4.0 * eps * (1.0 + sum(0.0 if angle.in_degrees else abs(angle.radians) for angle in (one, other)))


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


def _solve(
    cases: Cases,
    terms: dict[str, Term],
    masses: dict[str, Any],
    angles: dict[str, Angle],
    headings: dict[str, tuple[Any, Any]],
    impulse: tuple[Any, Any] | None,
    along: tuple[Any, Any] | None,
    unlike: Any,
    together: bool,
    on_failure: Any,
) -> MomentumSolution:
    known = {name: term for name, term in terms.items() if term.speed is not None}
    (first, one), (second, other) = ((name, term) for name, term in terms.items() if term.speed is None)
    cosine, sine = between(one.course, other.course)
    eps = float(np.finfo(np.float64 if cases.shape is None else cases.dtype).eps)
    everything = [
        *masses.values(),
        *(term.speed for term in known.values()),
        *(angle.value for angle in angles.values()),
        *(impulse or ()),
        *(part for vector in (*headings.values(), along or ()) for part in vector),
    ]
    unfit = np.logical_or.reduce(np.broadcast_arrays(*(~np.isfinite(value) for value in everything)))
    negative = np.logical_or.reduce(np.broadcast_arrays(False, *(np.less(term.speed, 0.0) for term in known.values())))
    endless = np.logical_or(*(np.isposinf(mass) for mass in masses.values()))
    light = np.logical_or(*(np.less_equal(mass, 0.0) for mass in masses.values()))
    nowhere = np.logical_or.reduce(
        np.broadcast_arrays(False, *((v[0] == 0.0) & (v[1] == 0.0) for v in (*headings.values(), along) if v is not None))
    )
    full = {name: term.speed for name, term in terms.items()}
    full[first] = unknown_speed(list(known.values()), impulse, one, other, between)
    full[second] = unknown_speed(list(known.values()), impulse, other, one, between)
    if together:
        full["speed_b_after"] = full["speed_a_after"]
    solution = _solution(full, masses, angles, headings, along)
    condition = np.divide(1.0 + abs(cosine), abs(sine))
    # What rounding makes of the answers, as speeds of the lighter vehicle.
    flow = sum(masses[f"mass_{name[6]}"] * abs(full[name]) for name in _SPEEDS)
    rounding = 16.0 * eps * condition * (flow / np.minimum(*masses.values()))
    loss, worth = solution["translational_energy_loss"], sum(abs(full[name]) for name in _SPEEDS)
    gains = -loss > 4.0 * rounding * np.minimum(*masses.values()) * worth
    status = cases.verdict(
        (
            (endless, codes.INFINITE_MASS),
            (light, codes.NOT_POSITIVE),
            (unfit, codes.NOT_FINITE),
            (nowhere, codes.ZERO_NORMAL),
            (negative | unlike, codes.CONTRADICTORY),
            (abs(sine) <= _blur(one.course, other.course, eps), codes.PARALLEL_HEADINGS),
            (~np.isfinite(full[first] + full[second] + loss), codes.OUT_OF_RANGE),
            (gains & (impulse is None), codes.ENERGY_GAIN),
        )
    )

    def error(index: tuple[int, ...]) -> CollisionsError:
        outcome = Status(int(np.asarray(status)[index]))
        if outcome is Status.PARALLEL_HEADINGS:
            return NoSolutionError(
                f"the courses of {first} and {second} are parallel, so momentum cannot tell them apart; for an in-line impact "
                f"use reconstruct.central or reconstruct.inline_closing_speed, for one with known geometry reconstruct.speeds",
                code="parallel_headings",
            )
        if outcome is Status.INFINITE_MASS:
            return NoSolutionError(
                "a mass is inf, and the momentum of a body that does not move tells nothing; for an impact on a barrier use "
                "reconstruct.central, reconstruct.planar or reconstruct.speeds",
                code="infinite_mass",
            )
        why = outcome.sentence
        if outcome is Status.CONTRADICTORY:
            why = (
                "a known speed is below 0 (turn its course by 180 deg), or vehicles that leave together have two speeds or two "
                "courses"
            )
        return InputError(f"momentum: {why}", code=outcome.label)

    if cases.shape is None:
        if status > codes.ENERGY_GAIN and on_failure != "nan":
            raise error(())
    else:
        raise_or_warn(status, on_failure, error)
    sure = np.less_equal(status, codes.ENERGY_GAIN)
    full = {name: np.where(sure, speed, np.nan) for name, speed in full.items()}
    solution = {name: None if value is None else np.where(sure, value, np.nan) for name, value in solution.items()}
    sensitivity = _sensitivity(cases, terms, full, masses, impulse, (first, one), (second, other), sure)
    _warn_of_speeds(cases, sure, full, (first, second), abs(sine), condition, sensitivity, rounding)
    _warn_of_physics(cases, np.equal(status, codes.ENERGY_GAIN), solution, rounding)
    found: dict[str, Any] = {name: cases.values(mass) for name, mass in masses.items()}
    for name in _COURSES:
        found[name] = cases.values(angles[name].radians) if name in angles else None
    for name in _SPEEDS:
        found[name] = cases.values(full[name])
    for name, value in solution.items():
        found[name] = None if value is None else cases.values(value)
    return MomentumSolution(
        **found,
        condition=cases.values(np.where(sure, condition, np.nan)),
        sensitivity=sensitivity,
        unknowns=(first, second),
        status=Status(status) if isinstance(status, int) else status,
    )


def _solution(
    full: dict[str, Any],
    masses: dict[str, Any],
    angles: dict[str, Angle],
    headings: dict[str, tuple[Any, Any]],
    along: tuple[Any, Any] | None,
) -> dict[str, Any]:
    """What follows from all speeds and courses."""
    velocity = {}
    for name in _SPEEDS:
        angle = angles.get(name.replace("speed", "course"))
        c, s = (0.0, 0.0) if angle is None else angle.direction
        velocity[name] = full[name] * c, full[name] * s
    found: dict[str, Any] = {"closing_speed": None, "restitution": None}
    loss: Any = 0.0
    for side in "ab":
        (ux, uy), (wx, wy) = velocity[f"speed_{side}"], velocity[f"speed_{side}_after"]
        dx, dy = wx - ux, wy - uy
        found[f"delta_v_{side}"] = hypot(dx, dy)
        loss = loss - 0.5 * masses[f"mass_{side}"] * (dx * (ux + wx) + dy * (uy + wy))
        pdof = None
        if f"heading_{side}" in headings:
            hx, hy = headings[f"heading_{side}"]
            pdof = angle_of(-(hx * dx + hy * dy), hx * dy - hy * dx)
        found[f"pdof_{side}"] = pdof
    found["translational_energy_loss"] = loss
    if along is not None:
        (ax, ay), (bx, by) = velocity["speed_a"], velocity["speed_b"]
        (cx, cy), (ex, ey) = velocity["speed_a_after"], velocity["speed_b_after"]
        closing = along[0] * (ax - bx) + along[1] * (ay - by)
        parting = along[0] * (ex - cx) + along[1] * (ey - cy)
        found["closing_speed"] = closing
        found["restitution"] = parting / np.where(closing > 0.0, closing, np.nan)
    return found


def _sensitivity(
    cases: Cases,
    terms: dict[str, Term],
    full: dict[str, Any],
    masses: dict[str, Any],
    impulse: tuple[Any, Any] | None,
    first: tuple[str, Term],
    second: tuple[str, Term],
    sure: Any,
) -> Sensitivity:
    """Derivatives of both answers by every input, from the balance itself."""
    found = Sensitivity()
    for (name, wanted), (_, other) in ((first, second), (second, first)):
        row: dict[str, Any] = {}
        for side in "ab":
            parts = [
                term.sign * (full[label] * between(term.course, other.course)[1])
                for label, term in terms.items()
                if term.course is not None and (label[6] == side or term.mass is not masses[f"mass_{label[6]}"])
            ]
            row[f"mass_{side}"] = sum(parts)
        for label, term in terms.items():
            if term.course is None:
                continue
            if term.speed is not None:
                row[label] = term.sign * term.mass * between(term.course, other.course)[1]
            row[label.replace("speed", "course")] = course_change(term, full[label], other, between)
        if impulse is not None:
            c, s = other.course.direction
            row["outside_impulse_x"], row["outside_impulse_y"] = s, -c
        found[name] = {
            label: cases.values(np.where(sure, change_of_speed(cross, wanted, other, between), np.nan))
            for label, cross in row.items()
        }
    return found


def _warn_of_speeds(
    cases: Cases,
    sure: Any,
    full: dict[str, Any],
    unknowns: tuple[str, str],
    sine: Any,
    condition: Any,
    sensitivity: Sensitivity,
    rounding: Any,
) -> None:
    """Says how little the answers may be worth, once for a batch."""
    level = callers_level()
    near = sure & (sine < math.sin(_NEARLY_COLLINEAR))
    if np.any(near):
        worst = float(np.max(np.where(near, condition, 0.0)))
        degrees = math.degrees(math.asin(float(np.min(np.where(near, sine, 1.0)))))
        numbers = "; ".join(_most(answer, row, near) for answer, row in sensitivity.items())
        warnings.warn(
            IllConditionedWarning(
                f"{_count(near, cases)}the courses of {' and '.join(unknowns)} are {degrees:.2g} degrees from one line "
                f"(condition {worst:.3g}): {numbers}; an in-line method may tell more",
                code="nearly_collinear",
                condition=worst,
            ),
            stacklevel=level,
        )
    for name in unknowns:
        # What rounding leaves of 0 is no motion backwards.
        backward = sure & (full[name] < -rounding)
        if np.any(backward):
            least = float(np.min(np.where(backward, full[name], 0.0)))
            warnings.warn(
                OutOfRangeWarning(
                    f"{_count(backward, cases)}{name} = {least:.6g} m/s: backwards along its course; check the courses, or "
                    f"turn this one by 180 deg",
                    code="negative_speed",
                    value=least,
                ),
                stacklevel=level,
            )


def _most(answer: str, row: dict[str, Any], near: Any) -> str:
    """The course that an answer depends on most, and by how much."""
    moves = {name: float(np.max(np.where(near, abs(value), 0.0))) for name, value in row.items() if name.startswith("course")}
    name = max(moves, key=moves.__getitem__)
    return f"{answer} moves by {moves[name] * math.pi / 180.0:.3g} m/s per degree of {name}"


def _warn_of_physics(cases: Cases, gains: Any, solution: dict[str, Any], rounding: Any) -> None:
    """Says where the answers are no impact, once for a batch."""
    level = callers_level()
    if np.any(gains):
        most = -float(np.min(np.where(gains, solution["translational_energy_loss"], 0.0)))
        warn_of_cases(
            EnergyGainWarning(
                f"{_count(gains, cases)}the vehicles leave with {most:.6g} J more than they came with, which no impact gives; "
                f"check courses and speeds",
                code="energy_gain",
                gain=most,
            )
        )
    closing, e = solution["closing_speed"], solution["restitution"]
    if closing is None:
        return
    apart = closing <= 0.0
    if np.any(apart):
        least = float(np.min(np.where(apart, closing, 0.0)))
        warnings.warn(
            OutOfRangeWarning(
                f"{_count(apart, cases)}the centres do not approach along the normal, which must point from A into B: closing "
                f"speed {least:.6g} m/s, so there is no restitution",
                code="separating",
                closing_speed=least,
            ),
            stacklevel=level,
        )
    slack = rounding / closing
    outside = (e < -slack) | (e > 1.0 + slack)
    if np.any(outside):
        worst = float(np.min(np.where(outside, e, np.inf)))
        worst = worst if worst < 0.0 else float(np.max(np.where(outside, e, 0.0)))
        warnings.warn(
            OutOfRangeWarning(
                f"{_count(outside, cases)}the restitution of the centres along the normal is {worst:.4g}, outside 0 to 1: "
                f"check the normal, courses and speeds, or ask reconstruct.restitution with the contact point",
                code="observed_restitution",
                value=worst,
            ),
            stacklevel=level,
        )


def _count(lanes: Any, cases: Cases) -> str:
    return "" if cases.shape is None else f"{int(np.count_nonzero(np.broadcast_to(lanes, cases.shape)))} cases: "
