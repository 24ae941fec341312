"""``why_this_model``, ``state_before``, ``evidence_of``: the choice of the model, how a reverse
solver found the state before, and what it was given.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from operator import attrgetter
from typing import Any, NamedTuple

from ..impact.doubts import apart_in_words, shares_apart
from ..impact.impact import Impact
from ..impact.instant import LIMITED
from ..impact.reconstruction import (
    KNOWN,
    bounds_of,
    how_many,
    known_in_words,
    number_beside,
    number_of_text,
)
from ..kernels.central import shares
from ..kernels.reverse import energy_of_speeds
from ..quantities.tables import as_sentence
from ..reconstruct.speeds_components import COMPONENTS
from ..reference import RECORDER_ACCURACY
from ..vehicle.drag import GRAVITY
from .expressions import HALF, ONE, ZERO, Expression, root
from .models import Lever, impulse_in_scene_axes
from .page import Page
from .symbols import AFTER, Symbol, Symbols

# A reverse solver's result agrees with its inputs within this, relative to the speeds or energies
# of the impact.
COMES_OUT = 1e-6
_VELOCITIES = ("va", "vb", "va_after", "vb_after")


class Evidence(NamedTuple):
    """Something that a reverse solver was given besides masses, geometry and contact.

    ``number`` is in SI, None of what is no number; ``text`` as it was given, if with a unit;
    ``answer`` the same number of the impact that was found, if it has one.
    """

    name: str
    what: str
    kind: str
    number: float | None
    text: str | None
    answer: float | None

    @property
    def differs(self) -> bool:
        """Whether the impact that was found has another number: components of delta-V are met as
        well as they agree, and a speed below 0 turns its course round.
        """
        if self.number is None or self.answer is None:
            return False
        apart = self.number - self.answer
        apart = math.remainder(apart, math.tau) if self.kind == "angle" else apart
        return abs(apart) > COMES_OUT * max(1.0, abs(self.answer))


def evidence_of(impact: Impact) -> list[Evidence]:
    """What a reverse solver was given besides the contact and the vehicles, in its order."""
    origin = impact.reconstruction
    if origin is None:
        return []
    texts: Mapping[str, Any] = impact.inputs.given or {}
    numbers = origin.given
    still = [label for label in "ab" if math.isinf(getattr(impact.inputs, label).mass)]
    found = []
    for name in dict.fromkeys([*numbers, *texts, *origin.known]):
        # Restitution and friction stand with the contact, va and vb with their vehicle. What
        # nothing moves has no motion after.
        beside = name not in KNOWN or name in ("va", "vb")
        if beside or any(name.startswith(f"{label}_after") for label in still):
            continue
        known, text, number = KNOWN[name], texts.get(name), numbers.get(name)
        if number is None and known.path.startswith("reconstruction."):
            number = number_beside(origin, name)
        elif number is None and text is not None:
            number = number_of_text(text, name)
        elif number is None and "_axes_" not in name:
            # The place of a recorder, whose parts are there, and the delta-V of the centre of mass,
            # to which its readings were carried over.
            continue
        answer = float(attrgetter(known.path)(impact)) if known.path else None
        found.append(Evidence(name, known.what, known.kind, number, text, answer))
    return found


def found_inputs(impact: Impact) -> set[str]:
    """The inputs of the model that a reverse solver found, by their names in ``notes``."""
    found: set[str] = set()
    for name in impact.found:
        quantity, label = (name[:-2], name[-1]) if name[-2:] in ("_a", "_b") else (name, "")
        names = ("vx", "vy", "speed") if quantity == "speed" else (quantity,)
        found |= {f"{label}.{one}" if label else one for one in names}
    return found


def why_this_model(page: Page, impact: Impact) -> None:
    """Write why ``solve`` chose the model."""
    choice = impact.choice
    if choice is None:
        return
    page.heading("Why this model")
    limit = page.number(choice.tolerance, "speed")
    full = (
        "the contact followed in time"
        if len(choice.errors) > 2 and "no answer" not in choice.reason
        else "the eccentric model"
    )
    page.say(
        "The least model was taken whose predicted error, times 1.15, is within the accepted "
        f"{limit}, against {full}. The error is that of the delta-V vector together with radius "
        f"of gyration times yaw rate, for the worse of both vehicles. Taken: {choice.model}."
    )
    if choice.tolerance == 0.0 or " m/s" not in choice.reason:
        page.say(f"Reason: {choice.reason.partition(': ')[2] or choice.reason}.")
    page.say("Predicted errors:")
    errors = [f"{name}: {page.number(error, 'speed')}" for name, error in choice.errors.items()]
    page.listed([line.replace("_", r"\_") if page.latex else line for line in errors])


def state_before(page: Page, s: Symbols) -> None:
    """Write how the state before was found; for a reverse solver unknown here, only
    what was known.
    """
    origin = s.impact.reconstruction
    if origin is None:
        return
    what_was_known(page, s.impact)
    if origin.method == "central":
        _central(page, s, origin.known)
    elif origin.method == "planar":
        _planar(page, s, origin.known[0])
    elif origin.method == "speeds":
        _speeds(page, s, origin.known)
    for sentence in s.impact.statements:
        page.say(as_sentence(sentence))
    differ = any(
        one.differs for one in evidence_of(s.impact) if one.name in (*COMPONENTS, "energy_loss")
    )
    if "ees_a" in origin.known:
        differ = differ or not _is_known_energy(s)
    as_well = ", as well as the readings agree with each other" if differ else ""
    page.say(
        "What follows is the same impact solved forwards; it must reproduce what was known"
        f"{as_well}."
    )
    if any(name.startswith("recorder_") for name in origin.known):
        page.say(
            "Delta-V is there that of the centre of mass in the axes of the heading given. "
            "Readings of a recorder away from it, or in axes that turn, differ from that, and are "
            "not worked out again."
        )
        for label in "ab":
            read = any(name in COMPONENTS and name[-1] == label for name in origin.known)
            if read and f"recorder_{label}" not in origin.known:
                page.say(f"The recorder of {label.upper()} is taken at the centre of mass.")


def what_was_known(page: Page, impact: Impact) -> None:
    """Write which reverse solver found the state before, from what, its condition, and whether it
    is the only solution.
    """
    origin = impact.reconstruction
    if origin is None:
        return
    page.heading("How the rest was found")
    page.say(
        f"Solved backwards by reconstruct.{origin.method}. Known besides masses and geometry: "
        f"{', '.join(known_in_words(origin.known))}."
    )
    page.say(
        f"Condition {page.system.answer(origin.condition, 'number')}: a relative error in what "
        "was given may become this many times as large in the speeds before, relative to the "
        "closing speed."
    )
    if origin.method == "speeds" and "restitution" in origin.found:
        page.say(
            "The restitution was a function of the closing speed, and how steep it is adds to the "
            "condition. Only its value stands here, so that the condition, and whether it is named "
            "among the findings, can be checked with the function alone."
        )
    if origin.answers > 1:
        page.stress(
            f"Not the only answer: {how_many(origin.answers)} fit what was known, and this is "
            "one of them. Nothing here tells which of them happened; look at the others too, "
            "and rule them out by other evidence."
        )
    if (share := shares_apart(impact)) > RECORDER_ACCURACY.high:
        page.stress(as_sentence(apart_in_words(impact, share)))
    if origin.regime is not None:
        ended = {"sticking": "stuck", "sliding": "slid to its end"}[origin.regime]
        page.say(f"That the contact {ended} was stated; what was known does not tell.")
    speeds = {
        name: page.system.answer(getattr(impact, name), "speed") for name in ("speed_a", "speed_b")
    }
    bounds = bounds_of(origin.one_sided or {}, speeds)
    if bounds:
        page.stress(
            "Known from one side only: the contact slid, or may have, and what was known leaves "
            f"open how fast. {as_sentence(' and '.join(bounds))} The numbers of this impact are "
            "those of the least slip."
        )


def _central(page: Page, s: Symbols, known: tuple[str, ...]) -> None:
    """Write an in-line impact from three of six known values."""
    (a, b), e, g, r = s.bodies, s.e, s.closing, s.separation
    v = dict(
        zip(
            _VELOCITIES,
            (a.straight(), b.straight(), a.straight(AFTER), b.straight(AFTER)),
            strict=True,
        )
    )
    given = [name for name in _VELOCITIES if name in known]
    if "contact_duration" in known:
        _while_held(page, s, v, given, known)
        return
    if len(given) == 3:
        _last_velocity(page, s, v, *set(_VELOCITIES).difference(given))
        page.equation(
            "Restitution, as in (9)", e, (v["vb_after"] - v["va_after"]) / (v["va"] - v["vb"])
        )
        return
    share = _shares(page, s)
    if len(given) == 1:
        page.equation(
            "Closing speed, from (8)", g, root(2.0 * s.loss / (s.mass * (1.0 - e.squared())))
        )
    elif "restitution" in known:
        difference, per_closing = _relation(v, share, given, ONE, e)
        page.equation("Closing speed, from (5), (6) and (9)", g, difference / per_closing)
    else:
        page.say(
            f"With the closing speed {page.symbol(g)} and the separation speed {page.symbol(r)} "
            f"= e g there are two equations; {page.shown(g)} and {page.shown(r)} solve them:"
        )
        page.balance(
            "From both known velocities, (5) and (6)", *_relation(v, share, given, g, r), "speed"
        )
        page.balance(
            "From the known energy (8)",
            s.loss,
            HALF * s.mass * (g.squared() - r.squared()),
            "energy",
        )
        page.equation("Restitution", e, r / g)
    for name, other_name, sign in (("va", "vb", 1.0), ("vb", "va", -1.0)):
        if name in given:
            continue
        if other_name not in given and f"{name}_after" in given:
            found = v[f"{name}_after"].plus(sign, share[name[1]] * ((1.0 + e) * g))
        else:
            found = v[other_name].plus(sign, g)
        page.equation(f"Velocity of {name[1].upper()} before", v[name], found)


def _shares(page: Page, s: Symbols) -> dict[str, Symbol]:
    """Write the share of each vehicle in a change of their relative velocity."""
    a, b = s.bodies
    share_a, share_b, *_ = shares(a.start.mass, b.start.mass)
    share = {"a": Symbol("f_A", share_a, "number"), "b": Symbol("f_B", share_b, "number")}
    for symbol, own, other in ((share["a"], a, b), (share["b"], b, a)):
        caption = f"Share of {own.label} in the change of relative velocity"
        if a.fixed or b.fixed:
            share_of_all = ZERO if own.fixed else ONE
            page.fact(
                f"{caption}, as one mass is infinite: {page.shown(symbol)}.", (symbol, share_of_all)
            )
        else:
            page.equation(caption, symbol, other.mass / (a.mass + b.mass))
    return share


def _impulses_of_drags(page: Page, s: Symbols) -> None:
    """Write the impulse of the tyres of each vehicle, from the drags and the duration given."""
    origin = s.impact.reconstruction
    assert origin is not None
    lasts: Any = origin.duration
    duration = Symbol(r"\Delta t", lasts, "time")
    gravity = Symbol("a_g", GRAVITY, "acceleration")
    page.say(
        f"Tyres act during the contact, {page.shown(duration)}, against the way from A to B: drag "
        "times weight times duration is an impulse from outside."
    )
    page.equation("Standard gravity", gravity, gravity)
    for body in s.bodies:
        drag, push = getattr(origin, f"drag_{body.label.lower()}"), body.pushed("x")
        if drag is None or body.fixed:
            why = (
                f"{body.label} has an infinite mass"
                if body.fixed
                else f"No drag of {body.label} was given"
            )
            page.fact(f"{why}: {page.shown(push)}.", (push, ZERO))
            continue
        factor = Symbol(f"D_{body.label}", drag, "number")
        pulled = -(factor * body.mass * gravity * duration)
        page.equation(f"Impulse of the drag of {body.label}", push, pulled)


def _while_held(
    page: Page, s: Symbols, v: dict[str, Symbol], given: list[str], known: tuple[str, ...]
) -> None:
    """Write an in-line impact in which tyres act, by velocities with half of what they do."""
    (a, b), e, g, r = s.bodies, s.e, s.closing, s.separation
    _impulses_of_drags(page, s)
    page.say("Such an impulse slows a vehicle by:")
    slowed = {}
    for body in (a, b):
        push = body.pushed("x")
        by = -(push / body.mass) if push.value else ZERO
        slowed[body.label.lower()] = page.let(
            f"Slowing of {body.label} by its tyres", f"s_{body.label}", "speed", by
        )
    half = HALF * (slowed["b"] - slowed["a"])
    page.say(
        "Velocities with half of it already taken before, and half of it not yet taken after, are "
        "those of an impact without tyres: momentum and energy balance as in (2) and (8)."
    )
    without = {
        name: velocity.plus(1.0 if name.endswith("after") else -1.0, HALF * slowed[name[1]])
        for name, velocity in v.items()
    }
    closing = page.let("Closing speed of these", "g_0", "speed", g + half)
    parting = page.let("Separation speed of these", "r_0", "speed", r + half)
    share = _shares(page, s)
    page.say(
        f"The closing speed {page.symbol(g)} and the separation speed {page.symbol(r)} = e g "
        f"solve what was known: {page.shown(g)} and {page.shown(r)}."
    )
    for pair in pairwise(given):
        sides = _relation(without, share, [*pair], closing, parting)
        page.balance("From two known velocities, (5) and (6)", *sides, "speed")
    if "energy_loss" in known:
        lost = HALF * s.mass * (closing.squared() - parting.squared())
        page.balance("From the known energy (8)", s.loss, lost, "energy")
    page.equation("Restitution", e, r / g)
    for name, other, sign in (("va", "vb", 1.0), ("vb", "va", -1.0)):
        if name in given:
            continue
        if other not in given and f"{name}_after" in given:
            passed = share[name[1]] * (closing + parting)
            found = (v[f"{name}_after"] + slowed[name[1]]).plus(sign, passed)
        else:
            found = v[other].plus(sign, g)
        page.equation(f"Velocity of {name[1].upper()} before", v[name], found)


def _last_velocity(page: Page, s: Symbols, v: Mapping[str, Symbol], missing: str) -> None:
    """Write the fourth velocity, from momentum or from a body at rest that nothing moves."""
    a, b = s.bodies
    if a.fixed or b.fixed:
        text = (
            "A mass is infinite, so the velocity of that body is the same before and after. "
            f"{page.shown(v[missing])}."
        )
        kept = "a" if a.fixed else "b"
        page.fact(text, (v[f"v{kept}_after"], v[f"v{kept}"]))
        return
    before, after = (a.mass * v[f"va{when}"] + b.mass * v[f"vb{when}"] for when in ("", "_after"))
    page.balance("Momentum is conserved (2)", before, after, "impulse")
    own, other = (a, b) if missing[1] == "a" else (b, a)
    here, there = ("_after", "") if missing.endswith("after") else ("", "_after")
    of_other = f"v{other.label.lower()}"
    found = v[missing[:2] + there] + other.mass / own.mass * (
        v[of_other + there] - v[of_other + here]
    )
    page.equation(
        f"Velocity of {own.label} {'after' if here else 'before'}, from it", v[missing], found
    )


def _relation(
    v: Mapping[str, Expression],
    share: Mapping[str, Symbol],
    given: list[str],
    g: Expression,
    r: Expression,
) -> tuple[Expression, Expression]:
    """Write the difference of two known velocities in terms of the closing speed g and the
    separation speed r.
    """
    first, second = given
    difference = v[first] - v[second] if first == "va" else v[second] - v[first]
    if second == "vb":
        return difference, g
    if first == "va_after":
        return difference, r
    own, other = share[first[1]], share[second[1]]
    return difference, own * (g + r) if own is other else own * g - other * r


def _planar(page: Page, s: Symbols, kind: str) -> None:
    """Write a planar impact reversed in time."""
    e, g, r = s.e, s.closing, s.separation
    levers = Lever(s.impact, "A"), Lever(s.impact, "B")
    page.say(
        "Reversed in time, an impact is an impact: from the motions after come the separation "
        "speed and the slip after at the contact, from these the impulse, and taken off the "
        "motions after it leaves those before."
    )
    for body in levers:
        if body.pinned or body.turns or not body.fixed:
            body.at_contact(page, AFTER, f"Velocity of {body.label} at the contact after")
    page.equation("Separation speed", r, s.relative("n", AFTER, True))
    if kind == "restitution":
        page.equation("Closing speed (11)", g, r / e)
    else:
        by_energy = "The energy lost was known; the closing speed that goes with it is"
        page.say(
            f"{'The closing speed was known:' if kind == 'closing_speed' else by_energy} "
            f"{page.shown(g)}."
        )
        page.equation("Restitution (11)", e, r / g)
    if kind == "energy_loss":
        by_tangential = HALF * (s.tangential.unless_zero() * (s.slip + s.slip_after))
        page.equation(
            "The energy that these lose", s.loss, HALF * (g - r) * s.normal - by_tangential
        )
    page.say(
        f"The regime is {s.impact.regime}, with the impulse {page.shown(s.normal)} and "
        f"{page.shown(s.tangential)} on B: of all that the law allows it is the one that leads "
        "to these motions after."
    )
    impulse_in_scene_axes(page, s)
    if s.impact.inputs.tyres:
        page.say(
            "The tyres act meanwhile, with the mean of their force before, half-way through and "
            f"after the contact times its duration, {LIMITED}. That follows from the motions which "
            "are sought: "
            "those of the instant were refined, by Newton's method, until the contact with its "
            "tyres, solved forwards, ends in the motions after."
        )
        for body in levers:
            if body.outside is not None:
                page.say(
                    f"The {body.whence} on {body.label}: {page.shown(body.pushed('x'))}, "
                    f"{page.shown(body.pushed('y'))}, with {page.shown(body.moment)}."
                )
    for body in levers:
        if not body.pinned and not body.fixed:
            for axis in "xy":
                found = body.along(axis, AFTER).plus(-body.sign, s.impulse(axis) / body.mass)
                if body.outside is not None:
                    found = found - body.pushed(axis) / body.mass
                page.equation(
                    f"Velocity of {body.label} before, along {axis}", body.along(axis), found
                )
        if body.turns:
            found = body.spin(AFTER) - body.torque(s) / body.resistance
            page.equation(f"Yaw rate of {body.label} before", body.spin(), found)


def _speeds(page: Page, s: Symbols, known: tuple[str, ...]) -> None:
    """Write speeds from two of: speeds, delta-V, energy."""
    page.say(
        f"Within one regime of the contact (here {s.impact.regime}) the impulse is linear in "
        "both speeds, and energies are quadratic. Each regime was solved for the two that were "
        "known, and a pair of speeds was kept if the impact, solved forwards, is in that "
        "regime."
    )
    if s.impact.inputs.tyres:
        page.say(
            "Then they were refined, by Newton's method, until the contact with its tyres, solved "
            "forwards, meets what was known so; delta-V is that of contact and tyres."
        )
    for body in s.bodies:
        label = body.label
        if f"speed_{label.lower()}" in known:
            speed = Symbol(rf"\lvert v_{label} \rvert", body.start.speed, "speed")
            by_components = root(body.along("x").squared() + body.along("y").squared())
            page.equation(f"Speed of {label} before, known", speed, by_components)
        components = [
            name for name in ("forward", "left") if f"delta_v_{name}_{label.lower()}" in known
        ]
        if components:
            page.say(
                f"Delta-V of {label} was known by its components in the axes of the vehicle "
                f"({', '.join(components)}): in each regime the speeds follow from them by least "
                "squares, all weighing alike as parts of the impulse."
            )
        if f"delta_v_{label.lower()}" in known and not body.fixed:
            by_impulse = root(s.normal.squared() + s.tangential.squared()) / body.mass
            if body.outside is not None:
                by_impulse = root(body.delta_v("x").squared() + body.delta_v("y").squared())
            page.equation(f"Delta-V of {label}, known", body.delta_v(), by_impulse)
    for name, what in (
        ("energy_loss", "energy lost"),
        ("ees_a", "energy of both EES, the one lost"),
    ):
        if name not in known:
            continue
        if _is_known_energy(s):
            page.say(f"The {what}, known: {page.shown(s.loss)}.")
        else:
            stuck = (
                "The contact stuck, so that the components of delta-V alone tell its speeds, and it"
            )
            page.say(
                f"The {what.partition(',')[0]} was given as "
                f"{page.number(_known_energy(s.impact), 'energy')}. "
                f"{stuck if s.impact.regime == 'sticking' else 'This impact'} loses "
                f"{page.shown(s.loss)}."
            )
    if "max_crush_speed_a" in known:
        page.say(
            "Energy of both speeds of maximum crush, known, which is absorbed along the normal: "
            f"{page.shown(s.absorbed)}."
        )


def _known_energy(impact: Impact) -> float:
    """The energy that ``speeds`` was given, or that both EES stand for."""
    origin = impact.reconstruction
    assert origin is not None
    given = origin.given
    if "ees_a" not in given:
        return float(given["energy_loss"])
    masses = impact.inputs.a.mass, impact.inputs.b.mass
    return float(energy_of_speeds(masses[0], given["ees_a"], masses[1], given["ees_b"]))


def _is_known_energy(s: Symbols) -> bool:
    """Whether the impact loses the energy that ``speeds`` was given."""
    return math.isclose(_known_energy(s.impact), s.loss.value, rel_tol=COMES_OUT)
