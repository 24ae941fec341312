"""The balance of planar momentum: both unknown speeds, what follows from them, and how far every input moves them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ..directions import Angle, angle_of, between
from ..errors import CollisionsError, InputError, NoSolutionError, Status
from ..kernels.reverse import Term, change_of_speed, course_change, unknown_speed
from ..quantities import hypot
from .common import Cases, raise_or_warn
from .momentum_solution import MomentumSolution, Sensitivity
from .momentum_warnings import warn_of_physics, warn_of_speeds

_SPEEDS = ("speed_a", "speed_b", "speed_a_after", "speed_b_after")
_COURSES = ("course_a", "course_b", "course_a_after", "course_b_after")


class Question(NamedTuple):
    """What is known, in numbers.

    ``terms`` are the moving bodies by the name of their speed, ``along`` the normal, ``unlike`` where what two vehicles that
    leave together have in common was given twice and differs.
    """

    terms: dict[str, Term]
    masses: dict[str, Any]
    angles: dict[str, Angle]
    headings: dict[str, Angle]
    impulse: tuple[Any, Any] | None
    along: tuple[Any, Any] | None
    unlike: Any
    together: bool


def solve(cases: Cases, question: Question, on_failure: Any) -> MomentumSolution:
    """The answer, or the refusal, of one case or of many."""
    terms, masses, impulse = question.terms, question.masses, question.impulse
    known = [term for term in terms.values() if term.speed is not None]
    (first, one), (second, other) = ((name, term) for name, term in terms.items() if term.speed is None)
    cosine, sine = between(one.course, other.course)
    eps = float(np.finfo(np.float64 if cases.shape is None else cases.dtype).eps)
    full = {name: term.speed for name, term in terms.items()}
    full[first] = unknown_speed(known, impulse, one, other, between)
    full[second] = unknown_speed(known, impulse, other, one, between)
    if question.together:
        full["speed_b_after"] = full["speed_a_after"]
    solution = _solution(full, question)
    condition = np.divide(1.0 + abs(cosine), abs(sine))
    # What rounding makes of the answers, as speeds of the lighter vehicle.
    flow = sum(masses[f"mass_{name[6]}"] * abs(full[name]) for name in _SPEEDS)
    rounding = 16.0 * eps * condition * (flow / np.minimum(*masses.values()))
    loss, worth = solution["translational_energy_loss"], sum(abs(full[name]) for name in _SPEEDS)
    gains = -loss > 4.0 * rounding * np.minimum(*masses.values()) * worth
    status = cases.first_status(
        (
            *_faults(question),
            (abs(sine) <= blur(one.course, other.course, eps), Status.PARALLEL_HEADINGS),
            (cases.beyond(full[first] + full[second] + loss), Status.OUT_OF_RANGE),
            (gains & (impulse is None), Status.ENERGY_GAIN),
        )
    )

    def error(index: tuple[int, ...]) -> CollisionsError:
        return _error(Status(int(np.asarray(status)[index])), first, second)

    if cases.shape is None:
        if status > Status.ENERGY_GAIN and on_failure != "nan":
            raise error(())
    else:
        raise_or_warn(status, on_failure, error)
    sure = np.less_equal(status, Status.ENERGY_GAIN)
    full = {name: np.where(sure, speed, np.nan) for name, speed in full.items()}
    solution = {name: None if value is None else np.where(sure, value, np.nan) for name, value in solution.items()}
    sensitivity = _sensitivity(cases, question, full, (first, one), (second, other), sure)
    warn_of_speeds(cases, sure, full, (first, second), abs(sine), condition, sensitivity, rounding)
    warn_of_physics(cases, np.equal(status, Status.ENERGY_GAIN), solution, rounding)
    found: dict[str, Any] = {name: cases.values(mass) for name, mass in masses.items()}
    for name in _COURSES:
        found[name] = cases.values(question.angles[name].radians) if name in question.angles else None
    for name, heading in question.headings.items():
        found[name] = cases.values(heading.radians)
    if question.along is not None:
        found["normal_angle"] = cases.values(angle_of(*question.along))
    for name, part in zip(("outside_impulse_x", "outside_impulse_y"), question.impulse or (), strict=False):
        found[name] = cases.values(part)
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


def blur(one: Angle, other: Angle, eps: float) -> Any:
    """What rounding leaves open of the angle between two courses; whole degrees leave nothing but their conversion."""
    return 4.0 * eps * (1.0 + sum(0.0 if angle.in_degrees else abs(angle.radians) for angle in (one, other)))


def _faults(question: Question) -> list[tuple[Any, int]]:
    """What is wrong with values that the reader does not look into: those of arrays."""
    masses, vectors = question.masses, [] if question.along is None else [question.along]
    speeds = [term.speed for term in question.terms.values() if term.speed is not None]
    everything = [
        *masses.values(),
        *speeds,
        *(angle.value for angle in (*question.angles.values(), *question.headings.values())),
        *(question.impulse or ()),
        *(part for vector in vectors for part in vector),
    ]
    return [
        (np.logical_or(*(np.isposinf(mass) for mass in masses.values())), Status.INFINITE_MASS),
        (np.logical_or(*(np.less_equal(mass, 0.0) for mass in masses.values())), Status.NOT_POSITIVE),
        (_any(~np.isfinite(value) for value in everything), Status.NOT_FINITE),
        (_any((x == 0.0) & (y == 0.0) for x, y in vectors), Status.ZERO_NORMAL),
        (_any(np.less(speed, 0.0) for speed in speeds) | question.unlike, Status.CONTRADICTORY),
    ]


def _any(findings: Iterable[Any]) -> Any:
    return np.logical_or.reduce(np.broadcast_arrays(False, *findings))


def _error(outcome: Status, first: str, second: str) -> CollisionsError:
    """The refusal of a case; ``first`` and ``second`` are what was asked for."""
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


def _solution(full: dict[str, Any], question: Question) -> dict[str, Any]:
    """What follows from all speeds and courses."""
    velocity = {}
    for name in _SPEEDS:
        angle = question.angles.get(name.replace("speed", "course"))
        c, s = (0.0, 0.0) if angle is None else angle.direction
        velocity[name] = full[name] * c, full[name] * s
    found: dict[str, Any] = {"closing_speed": None, "restitution": None}
    loss: Any = 0.0
    for side in "ab":
        (ux, uy), (wx, wy) = velocity[f"speed_{side}"], velocity[f"speed_{side}_after"]
        dx, dy = wx - ux, wy - uy
        found[f"delta_v_{side}"] = hypot(dx, dy)
        loss = loss - 0.5 * question.masses[f"mass_{side}"] * (dx * (ux + wx) + dy * (uy + wy))
        pdof = None
        if f"heading_{side}" in question.headings:
            hx, hy = question.headings[f"heading_{side}"].direction
            pdof = angle_of(-(hx * dx + hy * dy), hx * dy - hy * dx)
        found[f"pdof_{side}"] = pdof
    found["translational_energy_loss"] = loss
    if question.along is not None:
        nx, ny = question.along
        (ax, ay), (bx, by) = velocity["speed_a"], velocity["speed_b"]
        (cx, cy), (ex, ey) = velocity["speed_a_after"], velocity["speed_b_after"]
        closing = nx * (ax - bx) + ny * (ay - by)
        parting = nx * (ex - cx) + ny * (ey - cy)
        found["closing_speed"] = closing
        found["restitution"] = parting / np.where(closing > 0.0, closing, np.nan)
    return found


def _sensitivity(
    cases: Cases,
    question: Question,
    full: dict[str, Any],
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
                for label, term in question.terms.items()
                if term.course is not None and (label[6] == side or term.mass is not question.masses[f"mass_{label[6]}"])
            ]
            row[f"mass_{side}"] = sum(parts)
        for label, term in question.terms.items():
            if term.course is None:
                continue
            if term.speed is not None:
                row[label] = term.sign * term.mass * between(term.course, other.course)[1]
            row[label.replace("speed", "course")] = course_change(term, full[label], other, between)
        if question.impulse is not None:
            c, s = other.course.direction
            row["outside_impulse_x"], row["outside_impulse_y"] = s, -c
        found[name] = {
            label: cases.values(np.where(sure, change_of_speed(cross, wanted, other, between), np.nan))
            for label, cross in row.items()
        }
    return found
