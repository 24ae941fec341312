"""The derivation of planar momentum: two unknown speeds from courses that cross."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..reconstruct import MomentumSolution
from .changes import alpha_of, delta, magnitude, seen_from
from .expressions import Direction, Expression, Function, Symbol, total
from .page import Page
from .symbols import letter

_SPEEDS = ("speed_a", "speed_b", "speed_a_after", "speed_b_after")


def inputs(solution: MomentumSolution) -> Iterator[tuple[str, str, str, float, str]]:
    """What was given: of what, in words, by which argument, its number and its kind."""
    for label in "ab":
        yield label.upper(), "mass", f"mass_{label}", getattr(solution, f"mass_{label}"), "mass"
    shared = "speed_a_after" in solution.unknowns and _together(solution)
    for name in _SPEEDS:
        label, when = name[6].upper(), "after" if name.endswith("after") else "before"
        course = name.replace("speed", "course")
        if getattr(solution, course) is not None:
            yield label, f"course {when}", course, getattr(solution, course), "angle"
        if name not in solution.unknowns and not (name == "speed_b_after" and shared):
            yield label, f"speed {when}", name, getattr(solution, name), "speed"
    for label in "ab":
        heading = getattr(solution, f"heading_{label}")
        if heading is not None:
            yield label.upper(), "heading", f"heading_{label}", heading, "angle"
    if solution.normal_angle is not None:
        yield "contact", "normal, direction from A into B", "normal", solution.normal_angle, "angle"
    for at, axis in enumerate("xy"):
        outside = getattr(solution, f"outside_impulse_{axis}")
        if outside is not None:
            yield "both", f"impulse from outside, along {axis}", f"outside_impulse[{at}]", outside, "impulse"


def momentum(page: Page, solution: MomentumSolution) -> None:
    """Write it down."""
    speeds, courses, moving = {}, {}, []
    for name in _SPEEDS:
        label, mark = name[6].upper(), "'" if name.endswith("after") else ""
        speeds[name] = letter(f"v_{label}{mark}", f"v{mark}_{label}", getattr(solution, name), "speed")
        course = getattr(solution, name.replace("speed", "course"))
        if course is not None:
            courses[name] = letter(rf"\theta_{label}{mark}", f"theta{mark}_{label}", course, "angle")
            moving.append(name)
    masses = {"a": letter("m_A", "m_A", solution.mass_a, "mass"), "b": letter("m_B", "m_B", solution.mass_b, "mass")}
    rows = [(of, what, page.number(value, kind)) for of, what, _, value, kind in inputs(solution)]
    page.heading("Given")
    page.table(("of", "quantity", "value"), rows)
    page.heading("Planar momentum")
    page.say(
        "The momentum of both vehicles together is the same before and after, along x and along y (1), (2). Nothing is assumed "
        "of restitution, friction or rotation. Unknown are the two speeds along their courses."
    )
    push: list[Symbol] = []
    for axis, function in (("x", "cos"), ("y", "sin")):
        sides = [
            [
                masses[name[6]] * speeds[name] * Function(function, courses[name])
                for name in moving
                if after == name.endswith("after")
            ]
            for after in (False, True)
        ]
        left, right = (total(*terms) if terms else letter("0", "0", 0.0, "impulse") for terms in sides)
        outside = getattr(solution, f"outside_impulse_{axis}")
        if outside is not None:
            j = letter(f"J_{axis}", f"J_{axis}", outside, "impulse")
            page.say(f"An impulse from outside was stated; along {axis} it is {page.shown(j)}.")
            left = left + j
            push.append(j)
        page.balance(f"Momentum along {axis} (2)", left, right, "impulse")
    first, second = solution.unknowns
    page.say(
        f"Counted across the course of one unknown speed, the balance holds the other one alone. This gives "
        f"{page.letter(speeds[first])} and {page.letter(speeds[second])}."
    )
    for name, across in ((first, second), (second, first)):
        _solved(page, solution, speeds, courses, masses, name, courses[across], push)
    one, other = courses[first], courses[second]
    condition = letter(r"\kappa", "kappa", solution.condition, "number")
    angle = one - other
    page.equation(
        "Condition, from the angle between both courses (1 at right angles)",
        condition,
        (1.0 + Function("abs", Function("cos", angle))) / Function("abs", Function("sin", angle)),
    )
    _changes(page, solution, speeds, courses)


def _solved(
    page: Page,
    solution: MomentumSolution,
    speeds: dict[str, Symbol],
    courses: dict[str, Symbol],
    masses: dict[str, Symbol],
    name: str,
    across: Symbol,
    push: list[Symbol],
) -> None:
    """One of both speeds, by the balance counted across the course of the other."""
    mass: Expression = masses[name[6]]
    own = [name]
    if name.endswith("after") and _together(solution):
        own, mass = ["speed_a_after", "speed_b_after"], masses["a"] + masses["b"]
    ends = name.endswith("after")
    found: Expression | None = None
    # What is on the other side of the balance counts forwards, what is on the side of the unknown backwards.
    others = [other for other in courses if other not in own and courses[other].value != across.value and speeds[other].value]
    for other in sorted(others, key=lambda other: other.endswith("after") == ends):
        term = masses[other[6]] * speeds[other] * Function("sin", courses[other] - across)
        forwards = other.endswith("after") != ends
        found = (term if forwards else -term) if found is None else found + term if forwards else found - term
    if push:
        j_x, j_y = push
        moment = j_y * Function("cos", across) - j_x * Function("sin", across)
        found = (moment if ends else -moment) if found is None else found + moment if ends else found - moment
    if found is None:
        page.say(f"Nothing else has momentum across it: {page.shown(speeds[name])}.")
        return
    label = page.letter(across)
    page.equation(
        f"Speed of {name[6].upper()} {'after' if ends else 'before'}, by the momentum across {label}",
        speeds[name],
        found / (mass * Function("sin", courses[name] - across)),
    )


def _together(solution: MomentumSolution) -> bool:
    """Whether the vehicles left as one."""
    return bool(solution.speed_a_after == solution.speed_b_after and solution.course_a_after == solution.course_b_after)


def _changes(page: Page, solution: MomentumSolution, speeds: dict[str, Symbol], courses: dict[str, Symbol]) -> None:
    """What follows from all speeds."""
    page.heading("Changes of velocity and energy")
    for label in "ab":
        _delta_v(page, solution, speeds, courses, label)
    if solution.normal_angle is not None:
        _along_normal(page, solution, speeds, courses)
    loss = letter(r"\Delta E", "dE", solution.translational_energy_loss, "energy")
    terms: list[Expression] = []
    for name, speed in speeds.items():
        mass = letter(f"m_{name[6].upper()}", f"m_{name[6].upper()}", getattr(solution, f"mass_{name[6]}"), "mass")
        terms.append(mass * speed.squared() / 2.0)
    page.equation("Energy of translation lost (7)", loss, terms[0] + terms[1] - terms[2] - terms[3])
    page.heading("Answers")
    rows = [
        (
            name[6].upper(),
            "speed " + ("after" if name.endswith("after") else "before"),
            page.answer(name, speeds[name].value, "speed"),
        )
        for name in solution.unknowns
    ]
    for label in "ab":
        rows.append((label.upper(), "delta-V", page.answer(f"delta_v_{label}", getattr(solution, f"delta_v_{label}"), "speed")))
        pdof = getattr(solution, f"pdof_{label}")
        if pdof is not None and not math.isnan(pdof):
            rows.append((label.upper(), "PDOF (0 from ahead, positive clockwise)", page.answer(f"pdof_{label}", pdof, "angle")))
    if solution.closing_speed is not None:
        rows.append(
            ("centres", "closing speed along the normal", page.answer("closing_speed", solution.closing_speed, "speed"))
        )
    if solution.restitution is not None and not math.isnan(solution.restitution):
        rows.append(("centres", "restitution along the normal", page.answer("restitution", solution.restitution, "number")))
    rows.append(("both", "energy of translation lost", page.answer("translational_energy_loss", loss.value, "energy")))
    page.table(("of", "quantity", "value"), rows)


def _delta_v(page: Page, solution: MomentumSolution, speeds: dict[str, Symbol], courses: dict[str, Symbol], label: str) -> None:
    """Delta-V of one vehicle, and its direction seen from the vehicle where that had a heading."""
    name = label.upper()
    parts: list[Symbol] = []
    for axis, function in (("x", "cos"), ("y", "sin")):
        ends = (f"speed_{label}_after", f"speed_{label}")
        change = _difference(*(speeds[end] * Function(function, courses[end]) if end in courses else None for end in ends))
        part = delta(name, axis, change.value)
        page.equation(f"Delta-V of {name} along {axis} (definition)", part, change)
        parts.append(part)
    page.equation(f"Delta-V of {name} (definition)", delta(name, "", getattr(solution, f"delta_v_{label}")), magnitude(*parts))
    heading, pdof = getattr(solution, f"heading_{label}"), getattr(solution, f"pdof_{label}")
    if heading is None or math.isnan(pdof):
        return
    alpha = alpha_of(name, math.atan2(parts[1].value + 0.0, parts[0].value))
    page.equation(f"Direction of the delta-V of {name} (definition)", alpha, Direction(*parts))
    seen_from(page, name, heading, alpha, pdof)


def _difference(end: Expression | None, start: Expression | None) -> Expression:
    """One less the other, of which one that is None does not move."""
    if end is None:
        return letter("0", "0", 0.0, "speed") if start is None else -start
    return end if start is None else end - start


def _along_normal(page: Page, solution: MomentumSolution, speeds: dict[str, Symbol], courses: dict[str, Symbol]) -> None:
    """Closing speed and restitution of the centres of mass."""
    assert solution.normal_angle is not None
    phi = letter(r"\varphi", "phi", solution.normal_angle, "angle")
    before_a, before_b, after_a, after_b = (
        speeds[name] * Function("cos", courses[name] - phi) if name in courses else None for name in _SPEEDS
    )
    approach, departure = _difference(before_a, before_b), _difference(after_b, after_a)
    closing = letter("g", "g", solution.closing_speed, "speed")
    parting = letter("r", "r", departure.value, "speed")
    page.equation(f"Closing speed of the centres along the normal {page.letter(phi)} (definition)", closing, approach)
    page.equation("Separation speed (definition)", parting, departure)
    if solution.restitution is not None and not math.isnan(solution.restitution):
        page.equation("Restitution (9)", letter("e", "e", solution.restitution, "number"), parting / closing)


NAMES = (*_SPEEDS, "delta_v_a", "delta_v_b", "pdof_a", "pdof_b", "closing_speed", "restitution", "translational_energy_loss")


def kind_of(name: str) -> str:
    """The kind of quantity of an answer."""
    words = {"pdof": "angle", "restitution": "number", "translational": "energy"}
    return words.get(name.partition("_")[0], "speed")
