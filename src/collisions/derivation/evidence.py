"""``momentum`` and ``fit``: derivations of a planar-momentum result and of a fit to evidence, which
need no impact model.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from ..impact.instant import LIMITED
from ..messages.shares import chance
from ..quantities.formatting import KIND_OF, in_words, percent
from ..quantities.tables import as_sentence
from ..reconstruct import Fit, MomentumSolution
from ..reconstruct.momentum_tyres import left_as_one, what_is_sought
from .contact import pdof
from .expressions import (
    ZERO,
    Direction,
    Expression,
    Function,
    magnitude,
    root,
    signed_total,
    total,
)
from .page import Page
from .symbols import Symbol, delta_v
from .wheels import tyre_inputs

# The results of planar momentum: vehicle, description and kind.
MOMENTUM_ANSWERS = {
    "speed_a": ("A", "speed before", "speed"),
    "speed_b": ("B", "speed before", "speed"),
    "speed_a_after": ("A", "speed after", "speed"),
    "speed_b_after": ("B", "speed after", "speed"),
    "course_a": ("A", "course before", "angle"),
    "course_b": ("B", "course before", "angle"),
    "course_a_after": ("A", "course after", "angle"),
    "course_b_after": ("B", "course after", "angle"),
    "delta_v_a": ("A", "delta-V", "speed"),
    "pdof_a": ("A", "PDOF (0 from ahead, positive clockwise)", "angle"),
    "delta_v_b": ("B", "delta-V", "speed"),
    "pdof_b": ("B", "PDOF (0 from ahead, positive clockwise)", "angle"),
    "closing_speed": ("centres", "closing speed along the normal", "speed"),
    "restitution": ("centres", "restitution along the normal", "number"),
    "translational_energy_loss": ("both", "energy of translation lost", "energy"),
}
_SPEEDS, _COURSES = tuple(MOMENTUM_ANSWERS)[:4], tuple(MOMENTUM_ANSWERS)[4:8]
_ANGLE_TOL = (
    1e-9 * math.tau
)  # rounding of a difference of angles; the short way round differs by a whole turn


class _Momenta:
    """Symbols and momentum terms of planar momentum: masses, speeds and courses; a vehicle at rest
    has no course.
    """

    def __init__(self, solution: MomentumSolution) -> None:
        self.solution = solution
        self.mass = {
            "a": Symbol("m_A", solution.mass_a, "mass"),
            "b": Symbol("m_B", solution.mass_b, "mass"),
        }
        self.speed: dict[str, Symbol] = {}
        self.course: dict[str, Symbol] = {}
        for name in _SPEEDS:
            index = name[6].upper() + ("'" if name.endswith("after") else "")
            self.speed[name] = Symbol(f"v_{index}", getattr(solution, name), "speed")
            course = getattr(solution, name.replace("speed", "course"))
            if course is not None:
                # Within a turn: a difference of angles of many turns has lost the direction.
                if abs(course) > math.tau:
                    course = math.atan2(math.sin(course), math.cos(course))
                self.course[name] = Symbol(rf"\theta_{index}", course, "angle")
        self.pushes = {axis: list(self._pushes(axis)) for axis in "xy"}

    def _pushes(self, axis: str) -> Iterator[tuple[str, Symbol]]:
        """Where an impulse that is not the contact's comes from, and its part along an axis."""
        stated = getattr(self.solution, f"outside_impulse_{axis}")
        if stated is not None:
            whence = "An impulse from outside was stated"
            yield whence, Symbol(f"J_{axis}", stated, "impulse")
        for label in self.solution.tyres:
            whence = f"The tyres of {label.upper()} give an impulse while the contact lasts"
            yield whence, self.push_of_tyres(axis, label)

    def push_of_tyres(self, axis: str, label: str) -> Symbol:
        """The impulse of the tyres of a vehicle along an axis."""
        found = getattr(self.solution, f"tyre_impulse_{axis}_{label}")
        return Symbol(rf"J_{{{label.upper()}{axis}}}", found, "impulse")

    def along(self, name: str, function: str, axis: Expression = ZERO) -> Expression:
        """The component of a velocity along x, or along an axis at another angle."""
        if name not in self.course:
            return ZERO
        return self.speed[name] * Function(function, self.course[name] - axis)


def momentum_inputs(solution: MomentumSolution) -> Iterator[tuple[str, str, str, float, str]]:
    """The rows of given inputs: vehicle, description, argument, number and kind."""
    for label in "ab":
        yield label.upper(), "mass", f"mass_{label}", getattr(solution, f"mass_{label}"), "mass"
    together = left_as_one(solution)
    shared = "speed_a_after" in solution.unknowns and together
    for name in _SPEEDS:
        label, when = name[6].upper(), _when(name)
        course = name.replace("speed", "course")
        found = course in solution.unknowns or (
            course == "course_b_after" and together and "course_a_after" in solution.unknowns
        )
        if getattr(solution, course) is not None and not found:
            yield label, f"course {when}", course, getattr(solution, course), "angle"
        if name not in solution.unknowns and not (name == "speed_b_after" and shared):
            yield label, f"speed {when}", name, getattr(solution, name), "speed"
    for label in "ab":
        heading = getattr(solution, f"heading_{label}")
        if heading is not None:
            yield label.upper(), "heading", f"heading_{label}", heading, "angle"
    if solution.course_near is not None:
        (course,) = (name for name in solution.unknowns if name.startswith("course"))
        what = f"course {_when(course)}, about, of two that may fit"
        yield course[7].upper(), what, "course_near", solution.course_near, "angle"
    if solution.normal_angle is not None:
        yield "contact", "normal, direction from A into B", "normal", solution.normal_angle, "angle"
    for at, axis in enumerate("xy"):
        outside = getattr(solution, f"outside_impulse_{axis}")
        if outside is not None:
            yield (
                "both",
                f"impulse from outside, along {axis}",
                f"outside_impulse[{at}]",
                outside,
                "impulse",
            )
    if solution.duration is not None:
        yield "both", "duration, for the tyres", "duration", solution.duration, "duration"
    for label in "ab":
        rate = getattr(solution, f"yaw_rate_{label}_after")
        if rate is not None:
            yield label.upper(), "yaw rate after", f"yaw_rate_{label}_after", rate, "yaw rate"
    for what, name, value, kind in tyre_inputs(solution.tyres):
        yield "contact", what, name, value, kind


def momentum_assumption(solution: MomentumSolution) -> str:
    """What planar momentum takes for granted, in sentences."""
    found = (
        "The momentum of both vehicles together is the same before and after, along x and along "
        "y (1), (2), save for an impulse from outside that is stated. Nothing is assumed of "
        "restitution, friction or rotation."
    )
    labels = [label.upper() for label in solution.tyres]
    if not labels:
        return found
    lacking = [
        label for label in labels if getattr(solution, f"yaw_rate_{label.lower()}_after") is None
    ]
    unturned = (
        f"; after it, the yaw rate of {' and of '.join(lacking)} was not given and taken as 0"
        if lacking
        else ""
    )
    return (
        f"{found} While the contact lasts the tyres of {' and of '.join(labels)} act: the mean of "
        "their force before it, half-way through it and after it (Simpson's rule), times its "
        f"duration, is in the balance, {LIMITED}. That force follows from the velocities found, "
        "which were found again with it until it changed no more. Before the contact no vehicle "
        "turns; half-way through it 29 "
        f"percent of the change of velocity have passed, as in a plastic contact{unturned}."
    )


def momentum(page: Page, solution: MomentumSolution) -> None:
    """Two unknown speeds from courses that cross."""
    m = _Momenta(solution)
    rows = [
        (of, what, page.number(value, kind))
        for of, what, _, value, kind in momentum_inputs(solution)
    ]
    page.heading("Given")
    page.table(rows)
    page.heading("Planar momentum")
    sought, solved = {
        "speeds": ("are the two speeds along their courses", _two_speeds),
        "velocity": ("is one velocity, its speed and its course", _whole_velocity),
        "beside": ("are a speed along its course, and another course", _speed_and_course),
    }[what_is_sought(solution)]
    page.say(f"{momentum_assumption(solution)} Unknown {sought}.")
    for axis, function in (("x", "cos"), ("y", "sin")):
        _balance(page, m, axis, function)
    solved(page, m)
    page.heading("Changes of velocity and energy")
    for label in "ab":
        _delta_v(page, m, label)
    if solution.normal_angle is not None:
        _along_normal(page, m, solution.normal_angle)
    energies = [m.mass[name[6]] * speed.squared() / 2.0 for name, speed in m.speed.items()]
    loss = Symbol(r"\Delta E", solution.translational_energy_loss, "energy")
    page.equation(
        "Energy of translation lost (7)",
        loss,
        signed_total(zip((1.0, 1.0, -1.0, -1.0), energies, strict=True)),
    )
    page.heading("Answers")
    page.table(momentum_answers(page, solution))
    for sentence in solution._stated_in(page.system.name):
        page.say(as_sentence(sentence))


def _two_speeds(page: Page, m: _Momenta) -> None:
    """The two unknown speeds, each across the course of the other, and their condition."""
    first, second = m.solution.unknowns
    page.say(
        "Counted across the course of one unknown speed, the balance holds the other one alone. "
        f"This gives {page.symbol(m.speed[first])} and {page.symbol(m.speed[second])}."
    )
    for name, across in ((first, second), (second, first)):
        _solved(page, m, name, m.course[across])
    angle = m.course[first] - m.course[second]
    cosine, sine = (Function("abs", Function(function, angle)) for function in ("cos", "sin"))
    condition = Symbol(r"\kappa", m.solution.condition, "number")
    page.equation(
        "Condition, from the angle between both courses (1 at right angles)",
        condition,
        (1.0 + cosine) / sine,
    )


def _speed_and_course(page: Page, m: _Momenta) -> None:
    """A course by the momentum across that of the unknown speed, and that speed by the momentum
    along it; their condition.
    """
    name, sought = m.solution.unknowns
    other = sought.replace("course", "speed")
    axis, course = m.course[name], m.course[other]
    of, when, speed = other[6].upper(), _when(other), m.speed[other]
    page.say(
        f"Counted across the course of {page.symbol(m.speed[name])}, the balance holds the course "
        f"{page.symbol(course)} alone. Two fit, along with that course and against it; which of "
        "them was taken was stated, or follows from the other being backwards along its course."
        if m.solution.course_near is None
        else f"Counted across the course of {page.symbol(m.speed[name])}, the balance holds the "
        f"course {page.symbol(course)} alone. Two may fit, along with that course and against it; "
        "the one nearer to what was stated is taken."
    )
    turn = course.value - axis.value
    # Of both parts the rounding is that of the whole.
    whole = abs(speed.value)
    across = Symbol(f"v_{{{of}n}}", speed.value * math.sin(turn), "speed", size=whole)
    left, mass = _others(m, other, "sin", axis)
    page.equation(f"Velocity of {of} {when} across {page.symbol(axis)}", across, left / mass)
    along = Symbol(f"v_{{{of}t}}", speed.value * math.cos(turn), "speed", size=whole)
    page.equation(
        f"Velocity of {of} {when} along {page.symbol(axis)}",
        along,
        signed_total([(math.cos(turn), root(speed.squared() - across.squared()))]),
    )
    c, s = Function("cos", axis), Function("sin", axis)
    page.equation(
        f"Course of {of} {when}", course, Direction(along * c - across * s, along * s + across * c)
    )
    left, mass = _others(m, name, "cos", axis)
    page.equation(
        f"Speed of {name[6].upper()} {_when(name)}, by the momentum along {page.symbol(axis)}",
        m.speed[name],
        left / mass,
    )
    if math.isinf(m.solution.condition):
        page.say("Both courses are at right angles, but for rounding: the condition is infinite.")
        return
    cosine, sine = (Function("abs", Function(one, course - axis)) for one in ("cos", "sin"))
    page.equation(
        "Condition, from the angle between both courses (1 in line)",
        Symbol(r"\kappa", m.solution.condition, "number"),
        (1.0 + sine) / cosine,
    )


def _whole_velocity(page: Page, m: _Momenta) -> None:
    """The velocity that the other momenta leave, and their sum over it."""
    name = m.solution.unknowns[0]
    shared = name == "speed_a_after" and left_as_one(m.solution)
    own = ("speed_a_after", "speed_b_after") if shared else (name,)
    mass: Expression = m.mass["a"] + m.mass["b"] if shared else m.mass[name[6]]
    when, label = _when(name), name[6].upper()
    parts = []
    for axis, function in (("x", "cos"), ("y", "sin")):
        terms: list[tuple[float, Expression]] = [
            (
                -1.0 if _when(other) == when else 1.0,
                m.mass[other[6]] * m.speed[other] * Function(function, course),
            )
            for other, course in m.course.items()
            if other not in own and m.speed[other].value
        ]
        terms += [(1.0 if when == "after" else -1.0, push) for _, push in m.pushes[axis]]
        left = signed_total(sorted(terms, key=lambda term: -term[0]))
        value = m.speed[name].value * getattr(math, function)(m.course[name].value)
        part = Symbol(f"v_{{{label}{axis}}}", value, "speed")
        page.equation(f"Velocity of {label} {when} along {axis}", part, left / mass)
        parts.append(part)
    x, y = parts
    page.equation(f"Speed of {label} {when}", m.speed[name], magnitude(x, y))
    page.equation(f"Course of {label} {when}", m.course[name], Direction(x, y))
    others = [
        m.mass[other[6]] * m.speed[other]
        for other in m.course
        if other not in own and m.speed[other].value
    ]
    for (_, x), (_, y) in zip(m.pushes["x"], m.pushes["y"], strict=True):
        others.append(magnitude(x, y))
    condition = Symbol(r"\kappa", m.solution.condition, "number")
    page.equation(
        "Condition, the sum of the other momenta over what they leave",
        condition,
        total(*others) / (mass * m.speed[name]),
    )


def _balance(page: Page, m: _Momenta, axis: str, function: str) -> None:
    """The balance of momentum along an axis."""
    left, right = (
        total(
            *(
                m.mass[name[6]] * m.speed[name] * Function(function, m.course[name])
                for name in m.course
                if _when(name) == when
            )
        )
        for when in ("before", "after")
    )
    for whence, push in m.pushes[axis]:
        page.say(f"{whence}; along {axis} it is {page.shown(push)}.")
        left = left + push
    page.balance(f"Momentum along {axis} (2)", left, right, "impulse")


def _solved(page: Page, m: _Momenta, name: str, across: Symbol) -> None:
    """One of the two speeds, from momentum across the course of the other."""
    when = _when(name)
    found, mass = _others(m, name, "sin", across)
    if found is ZERO:
        page.fact(
            f"Nothing else has momentum across it: {page.shown(m.speed[name])}.",
            (m.speed[name], ZERO),
        )
        return
    caption = f"Speed of {name[6].upper()} {when}, by the momentum across {page.symbol(across)}"
    page.equation(caption, m.speed[name], found / (mass * Function("sin", m.course[name] - across)))


def _others(m: _Momenta, name: str, function: str, axis: Symbol) -> tuple[Expression, Expression]:
    """What all others leave of the momentum of a body across an axis ("sin") or along it ("cos"),
    and the mass of that body.
    """
    mass: Expression = m.mass[name[6]]
    own, when = [name], _when(name)
    if when == "after" and left_as_one(m.solution):
        own, mass = ["speed_a_after", "speed_b_after"], m.mass["a"] + m.mass["b"]
    # Terms on the other side of the balance count as positive, those on the side of the unknown as
    # negative.
    terms: list[tuple[float, Expression]] = [
        (
            -1.0 if _when(other) == when else 1.0,
            m.mass[other[6]] * m.speed[other] * Function(function, course - axis),
        )
        for other, course in m.course.items()
        if other not in own
        and m.speed[other].value
        and not (function == "sin" and course.value == axis.value)
    ]
    found = signed_total(sorted(terms, key=lambda term: -term[0]))
    c, s = Function("cos", axis), Function("sin", axis)
    for (_, x), (_, y) in zip(m.pushes["x"], m.pushes["y"], strict=True):
        push = y * c - x * s if function == "sin" else x * c + y * s
        found = found.plus(1.0 if when == "after" else -1.0, push)
    return found, mass


def _when(name: str) -> str:
    return "after" if name.endswith("after") else "before"


def _delta_v(page: Page, m: _Momenta, label: str) -> None:
    """Delta-V of one vehicle, and its direction seen from the vehicle where that had a heading."""
    name = label.upper()
    parts = []
    for axis, function in (("x", "cos"), ("y", "sin")):
        change = m.along(f"speed_{label}_after", function) - m.along(f"speed_{label}", function)
        parts.append(delta_v(name, axis, change.value))
        page.equation(f"Delta-V of {name} along {axis} (definition)", parts[-1], change)
    x, y = parts
    size = getattr(m.solution, f"delta_v_{label}")
    page.equation(f"Delta-V of {name} (definition)", delta_v(name, "", size), magnitude(x, y))
    heading, found = getattr(m.solution, f"heading_{label}"), getattr(m.solution, f"pdof_{label}")
    if heading is None or math.isnan(found):
        return
    caption, pushed = f"Direction of the delta-V of {name} (definition)", list[Expression](parts)
    if label in m.solution.tyres:
        caption = (
            f"Direction of the impulse of the contact on {name}: its change of momentum without "
            "the impulse of its tyres (definition)"
        )
        pushed = [
            m.mass[label] * change - m.push_of_tyres(axis, label)
            for axis, change in zip("xy", parts, strict=True)
        ]
    along, across = pushed
    direction = math.atan2(across.value + 0.0, along.value)
    pdof(page, name, caption, direction, Direction(along, across), heading, found)


def _along_normal(page: Page, m: _Momenta, normal_angle: float) -> None:
    """Closing speed and restitution of the centres of mass."""
    phi = Symbol(r"\varphi", normal_angle, "angle")
    before_a, before_b, after_a, after_b = (m.along(name, "cos", phi) for name in _SPEEDS)
    closing = Symbol("g", m.solution.closing_speed, "speed")
    caption = f"Closing speed of the centres along the normal {page.symbol(phi)} (definition)"
    page.equation(caption, closing, before_a - before_b)
    parting = page.let("Separation speed (definition)", "r", "speed", after_b - after_a)
    if _is_known(m.solution.restitution):
        page.equation(
            "Restitution (9)", Symbol("e", m.solution.restitution, "number"), parting / closing
        )


def _is_known(value: float | None) -> bool:
    return value is not None and not math.isnan(value)


def momentum_answers(page: Page, solution: MomentumSolution) -> Iterator[tuple[str, str, str]]:
    """The rows of results."""
    for name, (of, what, kind) in MOMENTUM_ANSWERS.items():
        value = getattr(solution, name)
        if _is_known(value) and (name in solution.unknowns or name not in (*_SPEEDS, *_COURSES)):
            yield of, what, page.answer(name, value, kind)
    for label in solution.tyres:
        for axis in "xy":
            push = getattr(solution, f"tyre_impulse_{axis}_{label}")
            yield label.upper(), f"impulse of the tyres, along {axis}", page.number(push, "impulse")


def fit(page: Page, found: Fit, notes: Mapping[str, str] | None = None) -> None:
    """Residual of each observation, and what the observations determine of the unknowns; ``notes``
    stand beside the observations of their names.
    """
    page.heading("Given")
    page.table(_given(page, found, notes or {}))
    page.say(
        "Each ± is one standard error, as it was stated. The model, a function of whoever asked, "
        "is not on this page; its computed values are those at the answer."
    )
    page.heading("Misfit")
    page.table(_misfit(page, found))
    ratios = [
        _residual(page, found, number, name) for number, name in enumerate(found.residuals, 1)
    ]
    chi_squared = Symbol(r"\chi^2", found.chi_squared, "number")
    page.equation(
        "Chi-squared, which the answer makes least",
        chi_squared,
        total(*(ratio.squared() for ratio in ratios)),
    )
    page.listed([page.name(sentence) + "." for sentence in found.statements])
    page.heading("Answers")
    page.table([row for name in found.names for row in _unknown(page, found, name)])
    page.say(
        "Each ± is one standard error, as far as the model is straight there, and each range holds "
        "95 percent, given the stated errors; where the model bends it is that in which "
        "chi-squared rises by less than 3.84. They are not widened by the misfit."
    )


def _given(page: Page, found: Fit, notes: Mapping[str, str]) -> Iterator[tuple[str, str, str]]:
    for one in found.residuals.values():
        value = f"{_number(page, one.observed, one.unit)} ± {_number(page, one.sigma, one.unit)}"
        value += f". {notes[one.name]}" if one.name in notes else ""
        yield page.name(one.name), "known before" if one.is_prior else "observed", value
    for name, ends in found.bounds.items():
        if any(map(math.isfinite, ends)):
            yield (
                page.name(name),
                "bounds",
                " to ".join(_number(page, end, found.units[name]) for end in ends),
            )


def _misfit(page: Page, found: Fit) -> Iterator[tuple[str, str, str]]:
    for name, one in found.residuals.items():
        yield page.name(name), "computed at the answer", _number(page, one.computed, one.unit)
        yield (
            page.name(name),
            "stated less computed, over the standard error",
            f"{one.over_sigma:+.2f}",
        )
    yield "all", "chi-squared", f"{found.chi_squared:.4g}"
    freedom = "degrees of freedom (observations and priors less the unknowns they determine)"
    yield "all", freedom, str(found.degrees_of_freedom)
    p_value = found.p_value
    yield (
        "all",
        "chance of such a chi-squared or a larger one",
        in_words(p_value) if math.isnan(p_value) else chance(p_value),
    )
    yield (
        "all",
        "by how much so many standard errors are off, as the model bends",
        percent(found.nonlinearity),
    )


def _residual(page: Page, found: Fit, number: int, name: str) -> Symbol:
    """One residual, over its standard error."""
    one = found.residuals[name]
    kind = KIND_OF.get(one.unit, "number")
    y, f, sigma, d = (
        Symbol(f"{latex}_{{{number}}}", value, kind)
        for latex, value in (
            ("y", one.observed),
            ("f", one.computed),
            (r"\sigma", one.sigma),
            ("d", one.residual),
        )
    )
    difference = y - f
    if abs(difference.value - d.value) > _ANGLE_TOL and one.unit == "rad":
        page.say(
            f"From the computed {page.shown(f)} to the stated {page.shown(y)} the short way "
            f"round is {page.shown(d)}."
        )
        difference = d
    ratio = Symbol(f"r_{{{number}}}", one.over_sigma, "number")
    page.equation(
        f"{number}, {page.name(name)}: stated less computed, over the standard error",
        ratio,
        difference / sigma,
    )
    return ratio


def _unknown(page: Page, found: Fit, name: str) -> Iterator[tuple[str, str, str]]:
    """Estimate, range, sources of error and correlations of one unknown."""
    one, at = found[name], found.names.index(name)
    of = page.name(name)
    if not one.determined:
        yield of, "estimate", "not determined"
        return
    bound = f", at its {one.at_bound} bound" if one.at_bound else ""
    unit = f" {page.system.label(KIND_OF[one.unit]) if one.unit in KIND_OF else one.unit}".rstrip()
    ends = (
        _number(page, end, one.unit, one.standard_error).partition(" ± ")[0]
        for end in one.interval(0.95)
    )
    low, high = (end.removesuffix(unit) for end in ends)
    yield of, "estimate", _number(page, one.value, one.unit, one.standard_error) + bound
    yield of, "95 percent interval", f"{low} to {high}{unit}"
    for by, share in found.contributions[name].items():
        yield of, f"share of the variance by {page.name(by)}", percent(share)
    correlations = found.correlation_matrix[at, at + 1 :].tolist()
    for other, correlation in zip(found.names[at + 1 :], correlations, strict=True):
        if math.isfinite(correlation):
            yield of, f"correlation with {page.name(other)}", f"{correlation:.2f}"


def _number(page: Page, value: float, unit: str, deviation: float | None = None) -> str:
    """A number of the working or, with its standard error, of a result; a unit of unknown kind is
    kept.
    """
    kind = KIND_OF.get(unit, "number")
    text = (
        page.number(value, kind)
        if deviation is None
        else page.system.answer(value, kind, deviation)
    )
    return text if unit in KIND_OF else f"{text} {unit}".rstrip()
