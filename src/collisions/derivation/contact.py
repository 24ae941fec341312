"""The steps that the models of an impact share: velocities, the tangential impulse, energy, and
what the motions give.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ..impact.impact import answer_of
from ..impact.inputs import PLACED
from ..kernels.contact_laws import CRITICAL_FRACTION, FRICTION, IMPULSE_RATIO, RULES, STRONGE
from .expressions import (
    HALF,
    ZERO,
    Direction,
    Expression,
    Function,
    Sum,
    magnitude,
    root,
    signed_total,
    total,
)
from .page import Page
from .symbols import AFTER, BEFORE, Body, Symbol, Symbols, delta_v


class Mobility(NamedTuple):
    """What an impulse does to the velocity of B relative to A at the contact; the coupling is None
    for point masses.

    ``push`` is what the impulses from outside add to the closing speed and to the slip.
    """

    normal: Expression
    tangential: Expression
    coupling: Expression | None
    push: tuple[Expression, Expression] = (ZERO, ZERO)


def normal(page: Page, s: Symbols) -> None:
    """The components of the normal, which the formulas need unless it is the x axis."""
    if s.impact.normal == (1.0, 0.0):
        return
    if 0.0 in s.impact.normal:
        page.say(f"Components of the normal: {page.shown(s.nx)} and {page.shown(s.ny)}.")
        return
    phi = Symbol(r"\varphi", s.impact.normal_angle, "angle")
    page.equation(
        f"Normal along x, from its direction {page.symbol(phi)}", s.nx, Function("cos", phi)
    )
    page.equation("Normal along y", s.ny, Function("sin", phi))


def velocity_before(page: Page, body: Body, s: Symbols) -> None:
    """The velocity of the centre of mass before, along n and t."""
    n, t, x, y = (body.along(direction) for direction in "ntxy")
    if body.start.speed == 0.0:
        text = f"The velocity of {body.label} before is 0: {page.shown(n)} and {page.shown(t)}."
        page.fact(text, (n, ZERO), (t, ZERO))
        return
    page.equation(f"Velocity of {body.label} before, along the normal", n, s.dot(x, y))
    page.equation(f"Velocity of {body.label} before, along the tangent", t, s.cross(x, y))


def velocity_after(
    page: Page, body: Body, s: Symbols, periods: Sequence[tuple[str, str, str, Symbol]]
) -> None:
    """The velocity of the centre of mass after: along n by periods (caption, start, end, impulse),
    along t, x and y.
    """
    n, t, x, y = (body.along(direction, AFTER) for direction in "ntxy")
    if body.fixed:
        text = (
            f"{body.label} has an infinite mass and keeps its velocity: {page.shown(n)} and "
            f"{page.shown(t)}."
        )
        page.fact(text, (n, body.along("n")), (t, body.along("t")))
        return
    for caption, start, end, impulse in periods:
        found = body.along("n", start).plus(body.sign, impulse / body.mass)
        page.equation(
            caption,
            body.along("n", end),
            found if body.outside is None else found + body.pushed("n") / body.mass,
        )
    along_t = f"Velocity of {body.label} after, along the tangent"
    found = body.along("t").plus(body.sign, s.tangential.unless_zero() / body.mass)
    if body.outside is not None:
        found = found + body.pushed("t") / body.mass
    page.equation(along_t if isinstance(found, Sum) else f"{along_t}, as before", t, found)
    if s.impact.normal == (1.0, 0.0):
        same = " and ".join(
            f"{page.symbol(one)} = {page.shown(other)}" for one, other in ((x, n), (y, t))
        )
        page.fact(
            f"The normal is the x axis and the tangent the y axis, so {same}.", (x, n), (y, t)
        )
    else:
        page.equation(f"Velocity of {body.label} after, along x", x, s.scene("x", n, t))
        page.equation(f"Velocity of {body.label} after, along y", y, s.scene("y", n, t))


def impulses(page: Page, s: Symbols, k: Mobility) -> None:
    """Both components of the impulse on B, and its parts of both periods."""
    steps = STEPS.get(s.law.name, _as_found) if s.law.followed else _by_rule
    compressed = steps(page, s, k)
    if not s.impact.complete:
        page.at_most(s.separation, ZERO)
        page.say(
            "The impact is incomplete: it ends in the period of deformation, while the contact "
            "points still approach."
        )
        return
    if compressed is s.compression:
        page.say(f"Of that, {page.shown(compressed)} is of the period of deformation, area A1.")
    else:
        page.equation(
            "Impulse of the period of deformation, area A1",
            s.compression,
            compressed or s.normal / (1.0 + s.e),
        )
    restored = s.normal - s.compression if s.law.followed else s.e * s.compression
    page.equation("Impulse of the period of restitution (10), area A2", s.restitution, restored)


def _as_found(page: Page, s: Symbols, k: Mobility) -> Expression | None:
    """The impulse under a law that follows the contact and whose steps are not written here: from
    the separation speed and the impulse ratio that it came to.
    """
    page.say(
        f"The contact was followed as its impulse builds up, and {s.law.derivation}. It came to "
        f"{page.shown(s.separation)}, the speed at which the contact points part, and "
        f"{page.shown(s.ratio)}, tangential over normal impulse."
    )
    resistance = k.normal if k.coupling is None else k.normal + s.ratio * k.coupling
    parting = s.closing + k.push[0] + s.separation
    page.equation("Normal impulse, by which they part so", s.normal, parting / resistance)
    page.equation("Tangential impulse", s.tangential, s.ratio * s.normal)
    return s.compression


def _by_energy(page: Page, s: Symbols, k: Mobility) -> Expression | None:
    """The impulse under the law "stronge"; without friction it is that of any rule."""
    if s.impact.inputs.rule_value != 0.0:
        return _until_slip_stops(page, s, k)
    _by_rule(page, s, k)
    return _until_compressed(page, s, k, s.closing / k.normal)


def _until_slip_stops(page: Page, s: Symbols, k: Mobility) -> Expression | None:
    """The impulse by the work of compression, with friction against the slip as it changes; gives
    its normal component until the end of compression.
    """
    page.say(
        "Friction acts against the slip as it is at each moment, and the slip may stop before "
        f"the contact ends. Restitution gives back {page.symbol(s.e)} squared of the work that "
        "compression takes along the normal."
    )
    mu, coupling = Symbol(r"\mu", s.impact.inputs.rule_value, "number"), k.coupling or ZERO
    g, slip, e = s.closing + k.push[0], s.slip + k.push[1], s.e
    if k.push[0] is not ZERO:
        e = page.let(
            "Restitution for the closing speed that impulses from outside leave",
            "e_o",
            "number",
            s.e * s.closing / g,
        )
    endless, rests, way = math.isinf(mu.value), slip.value == 0.0, -1.0 if slip.value > 0.0 else 1.0
    first: Expression = ZERO
    first_t: Expression = ZERO
    soft: Expression = ZERO
    w, stops = g, True
    if endless and not rests:
        first_t = page.let(
        "Impulse along the tangent that stops the slip, at once as friction has no bound", "T_1",
        "impulse",
                           -(slip / k.tangential))  # fmt: skip
        w = page.let("Closing speed then", "w", "speed", g - coupling * first_t)
    elif not rests:
        soft = page.let(
        "While it slides, the closing speed falls, for each unit of normal impulse, by", "k_1",
        "per mass",
                        k.normal + ZERO.plus(way, mu * coupling))  # fmt: skip
        rate = page.let(
            "and the slip changes by",
            "l_1",
            "per mass",
            coupling + ZERO.plus(way, mu * k.tangential),
        )
        stops = rate.value * slip.value < 0.0
        if stops:
            first = page.let(
                "Normal impulse at which the slip would stop", "P_1", "impulse", -(slip / rate)
            )
            w = page.let("Closing speed then (below 0: they part)", "w", "speed", g - soft * first)
            first_t = ZERO.plus(way, mu * first)
            stops = w.value > -max(e.value, 0.0) * g.value or soft.value < 0.0
    if not stops:
        page.at_most(ZERO, ZERO.plus(-way, s.slip_after))
        page.say("The slip goes on to the end, so the impulse ratio stays.")
        page.equation("Normal impulse", s.normal, (1.0 + e) * g / soft)
        page.equation("Tangential impulse", s.tangential, ZERO.plus(way, mu * s.normal))
        return _until_compressed(page, s, k, g / soft)
    holds = s.impact.regime == "sticking" or abs(coupling.value) <= mu.value * k.tangential.value
    if holds and not endless:
        page.at_most(Function("abs", coupling), mu * k.tangential)
    ratio = (
        -(coupling / k.tangential)
        if holds
        else ZERO.plus(-1.0 if coupling.value > 0.0 else 1.0, mu)
    )
    then = "it sticks" if holds else "it slides on, the way that the normal impulse pushes it"
    ratio = page.let(
        f"Once the slip has stopped {then}: impulse ratio from there", "\\mu_2", "number", ratio
    )
    soft_2 = page.let(
        "The closing speed then falls, for each unit of normal impulse, by",
        "k_2",
        "per mass",
        k.normal + ratio * coupling,
    )
    if w.value > 0.0:
        worked = first * (g + w) / 2.0 + w.squared() / (2.0 * soft_2)
        before = first + w / soft_2
    else:
        worked, before = g.squared() / (2.0 * soft), g / soft
    # With impulses from outside, or where the contact ends before, it is not the energy absorbed.
    name = "E_c" if k.push[0] is ZERO and s.impact.complete else "W_c"
    work = page.let("Work of compression along the normal", name, "energy", worked)
    if w.value > 0.0 and e.value * math.sqrt(2.0 * soft_2.value * work.value) <= -w.value:
        page.say(
            "Of that work so much is still to be done when the contact ends that the slip has "
            "not stopped then."
        )
        done = (1.0 - e.squared()) * work
        still = page.let(
            "Closing speed at the end", "w'", "speed", root(g.squared() - 2.0 * soft * done)
        )
        page.equation("Normal impulse", s.normal, 2.0 * done / (g + still))
        page.equation("Tangential impulse", s.tangential, ZERO.plus(way, mu * s.normal))
        return None
    inside = (
        e.squared() * 2.0 * work if w.value > 0.0 else e.squared() * 2.0 * work - w.squared() / soft
    )
    parts = root(soft_2 * inside) if w.value > 0.0 else root(w.squared() + soft_2 * inside)
    page.equation(
        "Speed at which the contact points part", s.separation, -parts if e.value < 0.0 else parts
    )
    page.equation("Normal impulse", s.normal, first + (w + s.separation) / soft_2)
    page.equation("Tangential impulse", s.tangential, first_t + ratio * (s.normal - first))
    return _until_compressed(page, s, k, before)


def _until_compressed(
    page: Page, s: Symbols, k: Mobility, alone: Expression | None
) -> Expression | None:
    """The normal impulse until the end of compression: ``alone``, where nothing acts from
    outside.
    """
    if k.push[0] is ZERO:
        return alone
    if s.impact.complete:
        page.say(
            "By the end of compression a part of the impulses from outside has acted, taken as "
            f"1/(1 + {page.symbol(s.e)}) of them, or all where that leaves no such end within the "
            "contact. The same contact with that part is followed up to there."
        )
    return s.compression


# What ``explain`` writes of the laws that follow the contact.
STEPS = {STRONGE: _by_energy}


def _by_rule(page: Page, s: Symbols, k: Mobility) -> None:
    """Both components of the impulse on B, by the tangential rule that was given."""
    rule, value = s.impact.inputs.rule, s.impact.inputs.rule_value
    change = (1.0 + s.e) * s.closing + k.push[0]
    if math.isnan(s.critical.value):
        page.say(
            "The contact has one degree of freedom, so the impulse that just stops the slip and "
            "the critical impulse ratio are not defined."
        )
    if rule == IMPULSE_RATIO:
        stated = Symbol(r"\mu_P", value, "number")
        text = (
            f"The impulse ratio was given: {page.shown(s.ratio)}, tangential over normal, signed."
        )
        page.fact(text, (s.ratio, stated))
    elif rule not in (FRICTION, CRITICAL_FRACTION):
        given = (
            f"The {RULES[rule].meaning} was given: {page.name(rule)} = "
            f"{page.number(value, 'number')}"
        )
        page.say(
            f"{given}. With the impulse that just stops the slip it makes the impulse ratio "
            f"{page.shown(s.ratio)}."
        )
    elif value == 0.0:
        why = {
            FRICTION: "Without friction the impulse is along the normal alone, as in the paper",
            CRITICAL_FRACTION: "A critical fraction of 0 leaves no tangential impulse",
        }
        page.fact(f"{why[rule]}: {page.shown(s.tangential)}.", (s.tangential, ZERO))
        page.equation("Normal impulse", s.normal, change / k.normal)
        return
    else:
        no_slip = Symbol("N_s", answer_of(s.impact).no_slip_normal, "impulse")
        no_slip_t = Symbol("T_s", answer_of(s.impact).no_slip_tangential, "impulse")
        _without_slip(page, s, k, no_slip, no_slip_t)
        if rule == CRITICAL_FRACTION:
            fraction = Symbol("f", value, "number")
            page.say(
                f"The critical fraction was given: {page.shown(fraction)} of the ratio that just "
                "stops the slip."
            )
            page.equation("Impulse ratio", s.ratio, fraction * s.critical)
        elif _sticks(page, s, no_slip, no_slip_t):
            page.equation("Normal impulse", s.normal, no_slip)
            page.equation("Tangential impulse", s.tangential, no_slip_t)
            return
    resistance = k.normal if k.coupling is None else k.normal + s.ratio * k.coupling
    page.equation("Normal impulse", s.normal, change / resistance)
    page.equation("Tangential impulse", s.tangential, s.ratio * s.normal)


def _without_slip(page: Page, s: Symbols, k: Mobility, normal: Symbol, tangential: Symbol) -> None:
    """The impulse that stops the slip."""
    page.say(
        f"The impulse that just stops the slip has the components {page.symbol(normal)} and "
        f"{page.symbol(tangential)}: with it, {s.law.derivation}."
    )
    change = (1.0 + s.e) * s.closing + k.push[0]
    stopped = (1.0 - s.law.sticking_slip(s.e)) * s.slip + k.push[1]
    if k.coupling is None:
        page.equation("Its normal component", normal, change / k.normal)
        page.equation("Its tangential component", tangential, -(stopped / k.tangential))
    else:
        page.say("Both are found from two equations at once:")
        page.balance(
            "Along the normal", k.normal * normal + k.coupling * tangential, change, "speed"
        )
        page.balance(
            "Along the tangent", k.coupling * normal + k.tangential * tangential, -stopped, "speed"
        )
        determinant = k.normal * k.tangential - k.coupling.squared()
        cramer_n = (k.tangential * change + k.coupling * stopped) / determinant
        cramer_t = -((k.normal * stopped + k.coupling * change) / determinant)
        page.equation("Solved for the normal component (Cramer's rule)", normal, cramer_n)
        page.equation("Solved for the tangential component", tangential, cramer_t)
    if normal.value > 0.0:
        page.equation("The critical impulse ratio", s.critical, tangential / normal)


def _sticks(page: Page, s: Symbols, normal: Symbol, tangential: Symbol) -> bool:
    """Whether the contact sticks under a friction bound, and why; if not, with its
    impulse ratio.
    """
    mu = Symbol(r"\mu", s.impact.inputs.rule_value, "number")
    sticks: bool = s.impact.regime == "sticking"
    allowed = f"The friction allows |{page.symbol(s.ratio)}| up to {page.shown(mu)}"
    if sticks and math.isinf(mu.value):
        page.at_most(ZERO, normal)
        page.say(
            "The friction has no bound and this impulse pushes, so the contact sticks: it is the "
            "impulse."
        )
    elif sticks:
        page.at_most(ZERO, normal)
        page.at_most(Function("abs", tangential), mu * normal)
        page.say(
            f"{allowed}. The critical ratio is within that and the impulse pushes, so the "
            "contact sticks: it is the impulse."
        )
    else:
        pulls = f"the impulse without slip would have to pull ({page.shown(normal)})"
        why = "the critical ratio is beyond it" if normal.value > 0.0 else pulls
        if normal.value > 0.0:
            page.at_most(mu * normal, Function("abs", tangential))
        page.at_most(ZERO, tangential if s.ratio.value >= 0.0 else -tangential)
        page.say(
            f"{allowed}, and {why}, so the contact slides. The impulse ratio is the bound with "
            f"the sign of {page.symbol(tangential)} ({page.number(tangential.value, 'impulse')})."
        )
        page.equation("Impulse ratio", s.ratio, mu if s.ratio.value >= 0.0 else -mu)
    return sticks


def energy(page: Page, s: Symbols) -> None:
    """The loss along the normal and along the tangent."""
    page.heading("Energy")
    if s.law.followed and s.tangential.value != 0.0:
        # The sum needs no path, its parts do.
        whole = HALF * (s.closing - s.separation) * s.normal - HALF * s.tangential * (
            s.slip + s.slip_after
        )
        page.equation(
            "Energy lost, by the impulse at the mean of the contact velocities", s.loss, whole
        )
        text = (
            f"Of that the work of friction takes {page.shown(s.loss_t)}, the normal "
            f"{page.shown(s.loss_n)}."
        )
        page.fact(text, (s.loss, s.loss_n + s.loss_t))
    else:
        page.equation(
            "Energy lost along the normal, (8) at the contact",
            s.loss_n,
            HALF * (1.0 - s.e) * s.closing * s.normal,
        )
        if s.tangential.value != 0.0:
            work = -(HALF * s.tangential * (s.slip + s.slip_after))
            page.equation(
                "Energy lost along the tangent, to the mean of both slips", s.loss_t, work
            )
            page.equation("Energy lost", s.loss, s.loss_n + s.loss_t)
        else:
            page.equation("Energy lost, as nothing is lost along the tangent", s.loss, s.loss_n)
    kinetic_energies(page, s)


def kinetic_energies(page: Page, s: Symbols, lost: Symbol | None = None) -> None:
    """The loss as the difference of the kinetic energies, where those are finite."""
    states = [
        (body, when, *_kinetic_energy(body, when)) for body in s.bodies for when in (BEFORE, AFTER)
    ]
    if any(math.isnan(value) for _, _, value, _ in states):
        page.say(
            "A body turns whose yaw inertia is not known, and so its kinetic energy is not: (7) "
            "is no check here."
        )
        return
    if any(math.isinf(value) for _, _, value, _ in states):
        page.say(
            "A body of infinite mass or inertia that moves has no finite kinetic energy: (7) is "
            "no check here."
        )
        _works(page, s)
        return
    terms: list[tuple[float, Symbol]] = []
    for body, when, value, formula in states:
        if body.fixed and not value:
            page.say(
                f"{body.label} has an infinite mass and rests {when}, so it has no kinetic energy."
            )
            continue
        sign, prime = (1.0, "") if when == BEFORE else (-1.0, "'")
        symbol = Symbol(f"T_{body.label}{prime}", value, "energy")
        terms.append((sign, symbol))
        if formula is ZERO:
            page.fact(f"{body.label} rests {when}: {page.shown(symbol)}.", (symbol, ZERO))
        else:
            turning = ", of translation and rotation" if body.state(when).yaw_rate else ""
            page.equation(f"Kinetic energy of {body.label} {when}{turning}", symbol, formula)
    works = _works(page, s)
    terms += [(1.0, work) for work in works]
    before_first = sorted(terms, key=lambda term: -term[0])
    with_work = ", with that work" if works else ""
    page.equation(
        f"Check: kinetic energies before less those after (7){with_work}",
        lost or s.loss,
        signed_total(before_first),
    )


def _works(page: Page, s: Symbols) -> list[Symbol]:
    return [_work(page, body) for body in s.bodies if body.outside is not None]


def _work(page: Page, body: Body) -> Symbol:
    """Write the work of the impulse from outside and of tyres on a body, and what of it is the
    tyres'.
    """
    assert body.outside is not None
    label, side = body.label, body.side
    speeds = [HALF * (body.axis(axis) + body.axis(axis, AFTER)) for axis in "xy"]
    turning = HALF * (body.spin() + body.spin(AFTER))

    def at_mean(x: Symbol, y: Symbol, moment: Symbol) -> Expression:
        work = x * speeds[0] + y * speeds[1]
        return work + moment * turning if moment.value else work

    moment = Symbol(rf"\mathrm{{M}}_{label}", body.outside[2], "angular momentum")
    caption = f"Work of the {body.whence} on {label}, at the mean of its velocities"
    formula = at_mean(body.pushed("x"), body.pushed("y"), moment)
    work = page.let(caption, f"W_{label}", "energy", formula)
    if "tyres" not in body.whence:
        return work
    of_tyres: Expression = -work
    if "outside" in body.whence:
        given = Symbol(rf"W_{{{label}Q}}", side.outside_work, "energy")
        parts = [
            Symbol(rf"\mathrm{{Q}}_{{{label}{axis}}}", getattr(side, f"outside_{axis}"), kind)
            for axis, kind in (("x", "impulse"), ("y", "impulse"), ("yaw", "angular momentum"))
        ]
        shown = ", ".join(page.shown(part) for part in parts)
        page.say(f"Of that impulse the one given from outside is {shown}.")
        page.equation(f"Its work on {label}", given, at_mean(*parts))
        of_tyres = given - work
    page.equation(
        f"Energy taken by the tyres of {label}",
        Symbol(rf"W_{{{label}T}}", side.tyre_loss, "energy"),
        of_tyres,
    )
    return work


def _kinetic_energy(body: Body, when: str) -> tuple[float, Expression]:
    """Its value, NaN for a body that turns and whose yaw inertia is not known; and its formula,
    ZERO for a body at rest.
    """
    state = body.state(when)
    squares = total(*(body.axis(axis, when).unless_zero().squared() for axis in "xy"))
    # A central model leaves the yaw rate as it was.
    spin = body.spin(when if body.impact.model in PLACED else BEFORE).unless_zero()
    formula = HALF * body.mass * squares + HALF * body.inertia * spin.squared()
    known = state.yaw_inertia is not None or not state.yaw_rate
    return float(state.kinetic_energy) if known else math.nan, formula


def motions(page: Page, s: Symbols) -> None:
    """What follows from the motions of both vehicles, each from its definition."""
    page.heading("Delta-V, direction of the force, and motion after")
    page.say(
        "Delta-V is the change of velocity of the centre of mass. The PDOF is where the impulse "
        "on a vehicle comes from, seen from that vehicle: 0 from ahead, positive clockwise. "
        "Directions are counted counter-clockwise from the x axis."
    )
    for axis in "xy":
        page.check(
            f"Impulse on B, along {axis}", s.impulse(axis), s.scene(axis, s.normal, s.tangential)
        )
    # The impulse on a body of infinite mass is known from the other body.
    for body in sorted(s.bodies, key=lambda body: body.fixed):
        if body.fixed:
            page.fact(
                f"{body.label} has an infinite mass, so its delta-V is 0.", (body.delta_v(), ZERO)
            )
        else:
            _delta_v(page, s, body)
        _pdof(page, s, body)
        _speed_and_course(page, body)
        if s.impact.model in PLACED and math.isfinite(body.start.yaw_inertia or math.inf):
            page.equation(
                f"Change of the yaw rate of {body.label} (definition)",
                body.spin_change(),
                body.spin(AFTER) - body.spin(),
            )


def impulse_and_energy(page: Page, s: Symbols) -> None:
    """The impulse ratio and the energy absorbed, which the steps before need not have had."""
    page.heading("Impulse ratio and energy absorbed")
    if s.impact.model != "linear_central" and s.normal.value != 0.0:
        page.equation("Impulse ratio (definition)", s.ratio, s.tangential / s.normal)
    if s.impact.pulse is not None:
        page.say(
            "The separation speed and the energy absorbed are of the last step and of that of "
            f"deepest engagement: {page.shown(s.separation)}, {page.shown(s.absorbed)}."
        )
    elif not s.impact.complete:
        page.fact(
            "The contact ends before the end of compression, so the energy absorbed is that lost "
            f"along the normal: {page.shown(s.absorbed)}.",
            (s.absorbed, s.loss_n),
        )
    elif s.law.followed and s.impact.inputs.pushed:
        # An impulse from outside does work along the normal too.
        page.say(
            "Energy absorbed along the normal by the end of compression, by the same contact "
            f"followed until then: {page.shown(s.absorbed)}."
        )
    elif s.law.followed:
        page.balance(
            "Energy absorbed along the normal by the end of compression, of which the part e "
            "squared is given back",
            (1.0 - s.e.squared()) * s.absorbed,
            s.loss_n,
            "energy",
        )
    else:
        page.equation(
            "Energy absorbed along the normal by the end of compression",
            s.absorbed,
            HALF * s.closing * s.compression,
        )


def _delta_v(page: Page, s: Symbols, body: Body) -> None:
    label, parts = body.label, (body.delta_v("x"), body.delta_v("y"))
    for axis, part in zip("xy", parts, strict=True):
        before, after = body.axis(axis), body.axis(axis, AFTER)
        if before.value == 0.0 and after.value == 0.0:
            text = (
                f"{label} does not move along {axis}, before or after: {page.shown(after)} and "
                f"{page.shown(part)}."
            )
            page.fact(text, (part, ZERO))
        else:
            page.equation(f"Delta-V of {label} along {axis} (definition)", part, after - before)
        if not body.pinned and s.impact.pulse is None:
            # From the velocities it has their rounding; from the impulse it has none but its own.
            pushed = ZERO.plus(body.sign, s.impulse(axis)) + (
                body.pushed(axis) if body.outside else ZERO
            )
            page.check(
                f"Delta-V of {label} along {axis}, from the impulse", part, pushed / body.mass
            )
    page.equation(f"Delta-V of {label} (definition)", body.delta_v(), magnitude(*parts))
    if body.start.heading is not None:
        psi = Symbol(rf"\psi_{label}", body.start.heading, "angle")
        along, across = Function("cos", psi), Function("sin", psi)
        forward = delta_v(label, "f", body.side.delta_v_forward)
        left = delta_v(label, "l", body.side.delta_v_left)
        caption = f"Delta-V of {label} forward, from its heading {page.symbol(psi)} (definition)"
        page.equation(caption, forward, parts[0] * along + parts[1] * across)
        page.equation(
            f"Delta-V of {label} to its left (definition)",
            left,
            parts[1] * along - parts[0] * across,
        )


def _pdof(page: Page, s: Symbols, body: Body) -> None:
    side, label = body.side, body.label
    if body.start.heading is None or side.pdof is None or math.isnan(side.pdof):
        return
    other = s.b if label == "A" else s.a
    other_push = s.impact.pulse is not None or s.impact.inputs.pushed
    if not body.fixed and not body.pinned and not other_push:
        caption = f"Direction of the impulse on {label}, which is that of its delta-V (definition)"
        pushed = Direction(body.delta_v("x"), body.delta_v("y"))
    else:
        caption = f"Direction of the impulse on {label}, opposite to that on {other.label} (1)"
        by_delta_v = not (other.fixed or other.pinned or body.pinned or other_push)
        x, y = (other.delta_v(axis) if by_delta_v else s.impulse(axis) for axis in "xy")
        pushed = Direction(x, y) if label == "B" and not by_delta_v else Direction(-x, -y)
    pdof(page, label, caption, side.impulse_direction, pushed, body.start.heading, side.pdof)


def pdof(
    page: Page,
    label: str,
    caption: str,
    direction: float,
    pushed: Expression,
    heading: float,
    found: float,
) -> None:
    """The PDOF, from the heading and the direction of the impulse, which a caption and a formula
    give.
    """
    alpha, psi = (
        Symbol(rf"\alpha_{label}", direction, "angle"),
        Symbol(rf"\psi_{label}", heading, "angle"),
    )
    page.equation(caption, alpha, pushed)
    turns = round((found - (psi.value - alpha.value)) / math.pi)
    caption = (
        f"PDOF of {label}: against the impulse, clockwise from its heading {page.symbol(psi)} "
        "(definition)"
    )
    symbol = Symbol(rf"\mathrm{{PDOF}}_{label}", found, "angle")
    page.equation(
        caption, symbol, (psi - alpha).plus(turns, abs(turns) * Symbol(r"\pi", math.pi, "angle"))
    )


def _speed_and_course(page: Page, body: Body) -> None:
    """Speed and course after."""
    state, label = body.state(AFTER), body.label
    speed = Symbol(rf"\lvert v_{label}' \rvert", state.speed, "speed")
    if page.system.working(state.speed, "speed") == "0":
        page.say(f"{label} is at rest after: {page.shown(speed)}, and no course.")
        return
    # A body that keeps its velocity keeps the symbols of the velocity before.
    x, y = (body.axis(axis, BEFORE if body.fixed else AFTER) for axis in "xy")
    page.equation(f"Speed of {label} after (definition)", speed, magnitude(x, y))
    course = Symbol(rf"\theta_{{{label}}}'", state.course, "angle")
    page.equation(f"Course of {label} after (definition)", course, Direction(x, y))
