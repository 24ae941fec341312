"""Why this model, and for a reverse problem: what was known, and how the state before was found from it."""

from __future__ import annotations

from ..impact import Impact
from ..kernels.linear import shares
from ..provenance import Reconstruction
from .eccentric import Lever
from .expressions import HALF, Expression, Symbol, root
from .page import Page
from .pinned import impulse_in_scene_axes
from .symbols import AFTER, Body, Contact, bodies, letter

_CENTRAL = {
    "va": "velocity of A before",
    "vb": "velocity of B before",
    "va_after": "velocity of A after",
    "vb_after": "velocity of B after",
    "restitution": "restitution",
    "energy_loss": "energy lost",
}
_KNOWN = {
    "speed_a": "speed of A before",
    "speed_b": "speed of B before",
    "delta_v_a": "delta-V of A",
    "delta_v_b": "delta-V of B",
    "energy_loss": "energy lost",
    "ees_a": "EES of both",
}


def chosen(page: Page, impact: Impact) -> None:
    """How ``solve`` came to the model."""
    choice = impact.choice
    if choice is None:
        return
    page.heading("Why this model")
    limit = page.number(choice.tolerance, "speed")
    cheaper = [f"{name}: {page.number(error, 'speed')}" for name, error in choice.errors.items()]
    page.say(
        f"The least model was taken whose predicted error, times 1.15, is within the accepted {limit}, against the eccentric "
        f"model. The error is that of the delta-V vector together with radius of gyration times yaw rate, for the worse of "
        f"both vehicles. Taken: {choice.model}."
    )
    if choice.tolerance == 0.0 or " m/s" not in choice.reason:
        page.say(f"Reason: {choice.reason.partition(': ')[2] or choice.reason}.")
    page.say("Predicted errors:")
    page.listed([line.replace("_", r"\_") if page.latex else line for line in cheaper])


def found(page: Page, impact: Impact) -> None:
    """How a reverse solver came to the state before."""
    origin = impact.reconstruction
    if origin is None:
        return
    told(page, origin)
    {"central": _central, "planar": _planar, "speeds": _speeds}.get(origin.method, _forward)(page, impact, origin.known)
    page.say("What follows is the same impact forwards, from the state that was found; it ends in what was known.")


def told(page: Page, origin: Reconstruction) -> None:
    """Which reverse solver found the state before, from what, how well-posed that was, and whether it is the only answer."""
    page.heading("How the state before was found")
    words = _CENTRAL if origin.method == "central" else _KNOWN
    known = ", ".join(words.get(name, name.replace("_", " ")) for name in origin.known)
    page.say(f"Backwards, by reconstruct.{origin.method}: known beside masses and geometry were {known}.")
    page.say(
        f"Condition {page.system.answer(origin.condition, 'number')}: by so much a relative error of what was given may be "
        "larger in the speeds before, taken relative to the closing speed."
    )
    if origin.answers > 1:
        page.stress(
            f"Not the only answer: {origin._fitting} fit what was known, and this is one of them. Nothing here tells "
            "which of them happened; look at the others too, and rule them out by other evidence."
        )


def _forward(page: Page, impact: Impact, known: tuple[str, ...]) -> None:
    """Of a solver that is not known here nothing is shown but the forward derivation."""


def _central(page: Page, impact: Impact, known: tuple[str, ...]) -> None:
    """In-line impact: three of six known."""
    a, b = bodies(impact)
    contact = Contact(impact)
    e, g = contact.e, contact.closing
    names = ("va", "vb", "va_after", "vb_after")
    v = dict(zip(names, (a.straight(), b.straight(), a.straight(AFTER), b.straight(AFTER)), strict=True))
    given = [name for name in names if name in known]
    separation = letter("r", "r", impact.separation_speed, "speed")
    if len(given) == 3:
        (missing,) = set(names) - set(given)
        _last_velocity(page, (a, b), v, missing)
        page.equation("Restitution, as in (9)", e, (v["vb_after"] - v["va_after"]) / (v["va"] - v["vb"]))
        return
    share_a, share_b, *_ = shares(a.start.mass, b.start.mass)
    f_a, f_b = letter("f_A", "f_A", share_a, "number"), letter("f_B", "f_B", share_b, "number")
    for share, own, other in ((f_a, a, b), (f_b, b, a)):
        if own.fixed or other.fixed:
            page.say(f"Share of {own.label} in the change of relative velocity, as one mass is infinite: {page.shown(share)}.")
        else:
            page.equation(f"Share of {own.label} in the change of relative velocity", share, other.mass / (a.mass + b.mass))
    squares = g.squared() - separation.squared()
    mass = contact.mass
    if len(given) == 1:
        page.equation("Closing speed, from (8)", g, root(2.0 * contact.loss / (mass * (1.0 - e.squared()))))
    elif "restitution" in known:
        page.equation("Closing speed, from (5), (6) and (9)", g, _closing(v, given, e, f_a, f_b))
    else:
        page.say(
            f"With the closing speed {page.letter(g)} and the separation speed {page.letter(separation)} = e g there are two "
            f"equations; {page.shown(g)} and {page.shown(separation)} solve them:"
        )
        left, right = _relation(v, given, g, separation, f_a, f_b)
        page.balance("From both known velocities, (5) and (6)", left, right, "speed")
        page.balance("From the known energy (8)", contact.loss, HALF * mass * squares, "energy")
        page.equation("Restitution", e, separation / g)
    _others(page, v, given, (1.0 + e) * g, f_a, f_b, g)


def _last_velocity(page: Page, pair: tuple[Body, Body], v: dict[str, Symbol], missing: str) -> None:
    """The fourth velocity from momentum, or from the rest of a body that nothing moves."""
    a, b = pair
    own, other = (a, b) if missing[1] == "a" else (b, a)
    if own.fixed or other.fixed:
        page.say(f"A mass is infinite, so the velocity of that body is the same before and after. {page.shown(v[missing])}.")
        return
    label = missing[1]
    opposite = "b" if label == "a" else "a"
    partner = f"v{label}" if missing.endswith("after") else f"v{label}_after"
    change = v[f"v{opposite}"] - v[f"v{opposite}_after"]
    if not missing.endswith("after"):
        change = v[f"v{opposite}_after"] - v[f"v{opposite}"]
    a_terms = (a.mass * v["va"], a.mass * v["va_after"])
    b_terms = (b.mass * v["vb"], b.mass * v["vb_after"])
    page.balance("Momentum is conserved (2)", a_terms[0] + b_terms[0], a_terms[1] + b_terms[1], "impulse")
    words = f"Velocity of {own.label} {'after' if missing.endswith('after') else 'before'}, from it"
    page.equation(words, v[missing], v[partner] + other.mass / own.mass * change)


def _closing(v: dict[str, Symbol], given: list[str], e: Symbol, f_a: Symbol, f_b: Symbol) -> Expression:
    """The closing speed from two velocities and the restitution."""
    match tuple(given):
        case ("va", "vb"):
            return v["va"] - v["vb"]
        case ("va", "va_after"):
            return (v["va"] - v["va_after"]) / (f_a * (1.0 + e))
        case ("vb", "vb_after"):
            return (v["vb_after"] - v["vb"]) / (f_b * (1.0 + e))
        case ("va", "vb_after"):
            return (v["va"] - v["vb_after"]) / (f_a - f_b * e)
        case ("vb", "va_after"):
            return (v["va_after"] - v["vb"]) / (f_b - f_a * e)
    return (v["vb_after"] - v["va_after"]) / e


def _relation(
    v: dict[str, Symbol], given: list[str], g: Symbol, r: Symbol, f_a: Symbol, f_b: Symbol
) -> tuple[Expression, Expression]:
    """What two velocities say of closing and separation speed."""
    match tuple(given):
        case ("va", "vb"):
            return v["va"] - v["vb"], g
        case ("va", "va_after"):
            return v["va"] - v["va_after"], f_a * (g + r)
        case ("vb", "vb_after"):
            return v["vb_after"] - v["vb"], f_b * (g + r)
        case ("va", "vb_after"):
            return v["va"] - v["vb_after"], f_a * g - f_b * r
        case ("vb", "va_after"):
            return v["va_after"] - v["vb"], f_b * g - f_a * r
    return v["vb_after"] - v["va_after"], r


def _others(
    page: Page, v: dict[str, Symbol], given: list[str], change: Expression, f_a: Symbol, f_b: Symbol, g: Symbol
) -> None:
    """The velocities before that were not known."""
    for name, other, label in (("va", "vb", "A"), ("vb", "va", "B")):
        if name in given:
            continue
        caption = f"Velocity of {label} before"
        if other in given:
            page.equation(caption, v[name], v[other] + g if label == "A" else v[other] - g)
        elif f"{name}_after" in given:
            own, way = (f_a, 1.0) if label == "A" else (f_b, -1.0)
            after = v[f"{name}_after"]
            page.equation(caption, v[name], after + own * change if way > 0.0 else after - own * change)
        else:
            page.equation(caption, v[name], v[other] + g if label == "A" else v[other] - g)


def _planar(page: Page, impact: Impact, known: tuple[str, ...]) -> None:
    """Time reversed, an impact is an impact."""
    a, b = bodies(impact)
    contact = Contact(impact)
    separation = letter("r", "r", impact.separation_speed, "speed")
    page.say(
        "Reversed in time, an impact is an impact: from the motions after come the separation speed and the slip after at the "
        "contact, from these the impulse, and taken off the motions after it leaves those before."
    )
    for body in (a, b):
        if body.start.pivot is not None or body.turns or not body.fixed:
            Lever(body).at_contact(page, AFTER, f"Velocity of {body.label} at the contact after")
    page.equation("Separation speed", separation, b.along("n", AFTER, True) - a.along("n", AFTER, True))
    e, g, kind = contact.e, contact.closing, known[0]
    if kind == "restitution":
        page.equation("Closing speed (11)", g, separation / e)
    elif kind == "closing_speed":
        page.say(f"The closing speed was known: {page.shown(g)}.")
        page.equation("Restitution (11)", e, separation / g)
    else:
        page.say(f"The energy lost was known; the closing speed that goes with it is {page.shown(g)}.")
        page.equation("Restitution (11)", e, separation / g)
        if contact.tangential.value != 0.0:
            slips = contact.tangential * (contact.slip + contact.slip_after)
            right = HALF * (g - separation) * contact.normal - HALF * slips
        else:
            right = HALF * (g - separation) * contact.normal
        page.equation("The energy that these lose", contact.loss, right)
    page.say(
        f"The regime is {impact.regime}, with the impulse {page.shown(contact.normal)} and {page.shown(contact.tangential)} on "
        "B: of all that the law allows it is the one that leads to these motions after."
    )
    impulse_in_scene_axes(page, contact)
    for body in (a, b):
        if body.start.pivot is None and not body.fixed:
            for axis in "xy":
                change = contact.impulse(axis) / body.mass
                after = body.along(axis, AFTER)
                page.equation(
                    f"Velocity of {body.label} before, along {axis}",
                    body.along(axis),
                    after - change if body.sign > 0.0 else after + change,
                )
        lever = Lever(body)
        if lever.turns:
            page.equation(
                f"Yaw rate of {body.label} before", body.spin(), body.spin(AFTER) - lever.torque(contact) / lever.inertia
            )


def _speeds(page: Page, impact: Impact, known: tuple[str, ...]) -> None:
    """Two of speeds, delta-V and energy."""
    contact = Contact(impact)
    page.say(
        f"Within one regime of the contact (here {impact.regime}) the impulse is linear in both speeds, and energies are "
        "quadratic. Each regime was solved for the two that were known, and a pair of speeds was kept if the impact, solved "
        "forwards, is in that regime. For this one:"
    )
    for body in bodies(impact):
        x, y = body.along("x"), body.along("y")
        label, side = body.label.lower(), body.side
        if f"speed_{label}" in known:
            speed = letter(rf"\lvert v_{body.label} \rvert", f"|v_{body.label}|", side.before.speed, "speed")
            page.equation(f"Speed of {body.label} before, known", speed, root(x.squared() + y.squared()))
        if f"delta_v_{label}" in known and not body.fixed:
            pn, pt = contact.normal, contact.tangential
            delta = letter(rf"\Delta v_{body.label}", f"dv_{body.label}", side.delta_v, "speed")
            page.equation(f"Delta-V of {body.label}, known", delta, root(pn.squared() + pt.squared()) / body.mass)
    if "energy_loss" in known:
        page.say(f"The energy lost, known: {page.shown(contact.loss)}.")
    if "ees_a" in known:
        absorbed = letter("E_c", "E_c", impact.energy_absorbed, "energy")
        page.equation(
            "Energy of both EES, known, absorbed along the normal", absorbed, HALF * contact.closing * contact.compression
        )
