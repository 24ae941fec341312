"""``central``: reconstructs an in-line impact from any three of four velocities, restitution and
energy loss.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..impact.impact import Impact
from ..impact.inputs import Inputs, OnFailure, check_flag
from ..impact.reconstruction import Reconstruction
from ..impact.run import error_of
from ..kernels.central import shares
from ..kernels.contact_laws import BRACH, FRICTION
from ..kernels.elementwise import restitution_domain
from ..kernels.reverse import (
    VELOCITIES,
    allowed_losses,
    inline_speeds,
    moved_by_rounding,
    moving_apart,
)
from ..kernels.status import Status
from ..messages.errors import AmbiguousSolutionError, CollisionsError
from ..messages.hints import hinted
from ..quantities.reading import ArgumentReader
from ..quantities.tables import Sentences
from ..quantities.units import Input
from ..vehicle.vehicle import Vehicle, moved
from .common import (
    DRAGS,
    Cases,
    drag_faults,
    exactly,
    finish,
    input_faults,
    read_amounts,
    read_drags,
    read_masses,
    run_forward,
    slowed_by,
    state_instant,
    state_other,
    warn_of_condition,
)

_ALONG_X: Any = (1.0, 0.0)
_FRICTIONLESS: Any = 0.0
_MOST_ROUNDING = 0.01  # of e: the largest excess beyond 0 and 1 that is taken for rounding
_KINDS = {
    "energy_loss": "energy",
    "duration": "time",
    **dict.fromkeys(("restitution", "drag_a", "drag_b"), "number"),
}
_IN_TEXTS = {"duration": "contact_duration"}
# The texts of these are kept with the vehicles.
_OF_VEHICLES = ("mass_a", "mass_b", "va", "vb", "heading_a", "heading_b")
# relative, for the sensitivity: between the rounding of a quotient and the curvature of a square
# root
_STEP = 1e-6
_STILL = 1e-9  # of the speeds: below, a vehicle that is held does not move backwards


class Candidate(NamedTuple):
    """A candidate solution: velocities before, restitution, closing speed, how far rounding may
    move the restitution, and whether it is a possible impact.
    """

    va: Any
    vb: Any
    restitution: Any
    closing: Any
    rounding: Any
    fits: Any


@hinted
def central(
    mass_a: Input,
    mass_b: Input,
    *,
    va: Input | None = None,
    vb: Input | None = None,
    va_after: Input | None = None,
    vb_after: Input | None = None,
    restitution: Input | None = None,
    energy_loss: Input | None = None,
    heading_a: Input | None = None,
    heading_b: Input | None = None,
    incomplete: bool = False,
    duration: Input | None = None,
    drag_a: Input | None = None,
    drag_b: Input | None = None,
    on_failure: OnFailure | None = None,
) -> Impact:
    """In-line impact from exactly three of four velocities, restitution and energy loss.

    Two point masses move on one line, A behind B. Velocities are positive in the direction from A
    to B, so ``va > vb`` before the impact and ``va_after <= vb_after`` after it, unless the impact
    was incomplete. All twenty combinations are solved in closed form (eqs 5 to 8 of "Application of
    Impulse Momentum Theory to Vehicle Collisions"), and the result is that of ``linear_central``
    for the state found.

    With ``duration`` and a drag of one vehicle or both, tyres act as impulses from outside, drag x
    weight x duration, against a motion from A towards B that neither vehicle leaves: as where A
    runs into the rear of B, which may stand before. The result is then that of ``eccentric`` with
    these as ``outside_a`` and ``outside_b``, for two bodies of infinite yaw inertia at the contact,
    which is taken as the origin; where they are does not matter.

    Parameters
    ----------
    mass_a, mass_b : float, str, Quantity or array [kg]
        Masses, > 0; ``inf`` for a body that keeps its velocity, such as a wall.
    va, vb : float, str, Quantity or array [m/s], optional
        Velocities before the impact.
    va_after, vb_after : float, str, Quantity or array [m/s], optional
        Velocities after the impact.
    restitution : float, str, Quantity or array [1], optional
        Coefficient of restitution, 0 to 1.
    energy_loss : float, str, Quantity or array [J], optional
        Energy dissipated, >= 0: what remains lost after restitution, not the energy absorbed at
        maximum crush.
    heading_a, heading_b : float, str, Quantity or array [rad], optional
        Where each vehicle points, counter-clockwise from the line from A to B: 0 for a car struck
        from behind or that strikes with its front, "180 deg" for one met head-on. They decide
        nothing; delta-V forward and PDOF need them.
    incomplete : bool, optional
        Whether the restitution may be negative (above -1), as for ``linear_central``. Both
        velocities before and the energy loss then leave its sign open, and there are two answers.
    duration : float, str, Quantity or array [s], optional
        How long the contact lasts, > 0, for the drags: 0.05 to 0.15 s for cars.
    drag_a, drag_b : float, str, Quantity or array [-], optional
        Drag factor of the tyres of a vehicle while the contact lasts, >= 0, or a deceleration: 0.7
        is locked wheels on a dry road. A vehicle without has no tyre forces, and ``.statements``
        say what they would change. Velocities after are those with their part, and an energy loss
        is that of the contact alone. They do not slow an infinite mass.
    on_failure : {None, "raise", "nan"}, optional
        What to do with a refused case of a batch: NaN and one warning, an error, or NaN without a
        warning.

    Returns
    -------
    Impact
        As ``linear_central`` returns it; ``reconstruction.condition`` says how well conditioned the
        problem was. Impulse and energy keep all their digits even where the closing speed is tiny:
        they are computed from ``reconstruction.contact_velocity``, not from the rounded velocities
        before.

    Raises
    ------
    InputError
        An argument that cannot be used, or not exactly three of the six.
    AmbiguousSolutionError
        Two impacts fit; both are in ``solutions``.
    NoImpactError
        The values given mean that the bodies did not approach.
    NoSolutionError
        The values given contradict each other or leave the answer open; the message says why. Or a
        vehicle with a drag moves from B towards A, before or after.

    Examples
    --------
    Example 2 of the paper: 1100 kg at 80 km/h strikes the rear of 950 kg at rest, which leaves at
    60 km/h.

    >>> from collisions import reconstruct
    >>> impact = reconstruct.central("1100 kg", "950 kg", va="80 km/h", vb=0.0, vb_after="60 km/h")
    >>> round(impact.restitution, 3), round(impact.a.after.q.vx.m_as("km/h"), 2)
    (0.398, 28.18)

    The same where B stood with its wheels locked, in a contact of 0.1 s:

    >>> impact = reconstruct.central(
    ...     "1100 kg",
    ...     "950 kg",
    ...     va="80 km/h",
    ...     vb=0.0,
    ...     vb_after="60 km/h",
    ...     duration="100 ms",
    ...     drag_b=0.7,
    ... )
    >>> round(impact.restitution, 3), round(impact.a.after.q.vx.m_as("km/h"), 2)
    (0.424, 26.05)
    """
    given = exactly(
        {
            "va": va,
            "vb": vb,
            "va_after": va_after,
            "vb_after": vb_after,
            "restitution": restitution,
            "energy_loss": energy_loss,
        },
        3,
        "central",
    )
    reader = ArgumentReader()
    numbers = read_masses(reader, mass_a, mass_b)
    for name, value in given.items():
        if name in VELOCITIES:
            numbers[name] = reader.number(value, "m/s", name)
        elif name == "restitution":
            numbers[name] = reader.number(value, "", name, restitution_domain(incomplete))
        else:
            numbers |= read_amounts(reader, {name: value})
    headings = {
        label: None if heading is None else reader.number(heading, "rad", f"heading_{label}")
        for label, heading in (("a", heading_a), ("b", heading_b))
    }
    check_flag(reader, "incomplete", incomplete)
    numbers |= read_drags(reader, duration, {"drag_a": drag_a, "drag_b": drag_b})
    reader.close()
    pointing = {
        f"heading_{label}": heading for label, heading in headings.items() if heading is not None
    }
    with np.errstate(all="ignore"):
        cases = Cases.of(numbers | pointing)
        # A vehicle, as eccentric has it, knows no duration of its own.
        texts = {_IN_TEXTS.get(name, name): text for name, text in reader.texts.items()}
        return _answer(cases, numbers, pointing, tuple(given), texts, on_failure, incomplete)


def _answer(
    cases: Cases,
    numbers: dict[str, Any],
    headings: dict[str, Any],
    known: tuple[str, ...],
    texts: dict[str, str],
    on_failure: Any,
    incomplete: bool,
) -> Impact:
    arrays = {name: np.asarray(value, dtype=np.float64) for name, value in numbers.items()}
    candidates = _candidates(arrays, cases.eps, incomplete)
    one, other = candidates[0], candidates[-1]
    which = np.where(one.fits | (~other.fits & (one.closing > 0.0)), 0, len(candidates) - 1)
    found = Candidate(*(np.choose(which, parts) for parts in zip(*candidates, strict=True)))
    apart = abs(one.closing - other.closing) > 64.0 * cases.eps * abs(one.closing)
    # Of two roots that rounding brings together, one may be at 0 in place of below it.
    alike = np.fmax(np.sqrt(64.0 * cases.eps), one.rounding + other.rounding)
    apart = apart | (abs(one.restitution - other.restitution) > alike)
    ambiguous = one.fits & other.fits & apart
    lasting = [name for name in ("duration", *DRAGS) if name in arrays]
    held = bool(lasting)
    status = cases.first_status(
        (
            *input_faults(arrays, incomplete),
            *drag_faults(arrays),
            (ambiguous, Status.AMBIGUOUS),
            (found.fits, Status.OK),
            *_faults(arrays, found),
        )
    )

    def origin_of(found: Candidate, which: Any, count: Any, where: Any = True) -> Reconstruction:
        condition = _condition(arrays, found, which, cases.eps, incomplete)
        given = {name: numbers[name] for name in known}
        velocity = () if held else (found.closing, 0.0 * found.closing)
        names = (*known, *(_IN_TEXTS.get(name, name) for name in lasting))
        origin = cases.reconstruction(
            "central", names, condition, count, velocity, where, given=given
        )
        return replace(origin, **{name: cases.values(arrays[name]) for name in lasting})

    def inputs_of(found: Candidate, keep: Any) -> Inputs:
        # In line, so that nothing moves across or turns; no warnings for states that were not
        # found.
        still: Any = 0.0 if np.all(keep) else cases.where(keep, 0.0)
        bodies = []
        place: dict[str, Any] = {"yaw_inertia": math.inf, "x": 0.0, "y": 0.0} if held else {}
        for label, speed in (("a", found.va), ("b", found.vb)):
            own = (("mass", f"mass_{label}"), ("vx", f"v{label}"), ("heading", f"heading_{label}"))
            given = {name: texts[key] for name, key in own if key in texts}
            body = Vehicle(
                mass=numbers[f"mass_{label}"], heading=headings.get(f"heading_{label}"), **place
            )
            bodies.append(moved(body, cases.where(keep, speed), still, still, given))
        a, b = bodies
        e = cases.where(keep, found.restitution)
        others = {name: text for name, text in texts.items() if name not in _OF_VEHICLES} or None
        rule = _ALONG_X, FRICTION, _FRICTIONLESS
        if not held:
            contact = e, *rule, None, None, others
            return Inputs("linear_central", a, b, *contact, incomplete=incomplete)
        pushes: dict[str, Any] = {
            f"outside_{label}": (cases.values(-_mass(arrays, label) * slowed), 0.0, 0.0)
            for label, slowed in slowed_by(arrays).items()
        }
        more = {"point": (0.0, 0.0), "given": others, "incomplete": incomplete} | pushes
        return Inputs("eccentric", a, b, e, _ALONG_X, FRICTION, _FRICTIONLESS, BRACH, **more)

    def refusal() -> CollisionsError:
        say = Sentences(texts.values())
        if status != Status.AMBIGUOUS:
            return _refusal(status, found, arrays, incomplete, say)
        solutions = tuple(
            run_forward(
                partial(inputs_of, one), Status.OK, origin_of(one, np.intp(i), len(candidates))
            )
            for i, one in enumerate(candidates)
        )
        return _ambiguous(known, solutions, say)

    def solve_case(index: tuple[int, ...]) -> Impact:
        of_case: dict[str, Any] = {
            name: cases.one(value, index) for name, value in (arrays | headings).items()
        }
        return central(**of_case, incomplete=incomplete)

    origin = origin_of(
        found, which, np.where(ambiguous, len(candidates), 1), np.equal(status, Status.OK)
    )
    impact = finish(partial(inputs_of, found), status, origin, on_failure, refusal, solve_case)
    warn_of_condition(origin.condition, " and ".join(origin.known))
    if not held:
        wheels = "`drag_a=` and `drag_b=`, where A runs into the rear of B"
        state_instant("central", f"`duration=`, {wheels}")
    else:
        masses = arrays["mass_a"], arrays["mass_b"]
        state_other("central", [name[-1] for name in lasting[1:]], masses, "drag")
    return impact


def _mass(known: dict[str, Any], label: str) -> Any:
    """The mass of a vehicle; of an infinite one, which no tyres slow, 0."""
    mass = known[f"mass_{label}"]
    return np.where(np.isinf(mass), 0.0, mass)


def _half_slowed(known: dict[str, Any]) -> tuple[dict[str, Any], Any]:
    """The known values with velocities as momentum knows them, half of the slowing taken from those
    before and added to those after; and half of what it adds to the approach.
    """
    half = _half_of(known)
    found = dict(known)
    for name in VELOCITIES:
        if name in known:
            found[name] = known[name] + (1.0 if name.endswith("after") else -1.0) * half[name[1]]
    return found, half["b"] - half["a"]


def _half_of(known: dict[str, Any]) -> dict[str, Any]:
    return {label: 0.5 * slowed for label, slowed in slowed_by(known).items()}


def _against(known: dict[str, Any], found: Candidate) -> Any:
    """Whether a vehicle whose tyres slow it moves from B towards A, before or after."""
    against: Any = np.zeros((), dtype=bool)
    share_a, share_b, *_ = shares(known["mass_a"], known["mass_b"])
    if "duration" not in known:
        return against
    slowed = slowed_by(known)
    passed = (1.0 + found.restitution) * found.closing + slowed["b"] - slowed["a"]
    after = {"a": found.va - share_a * passed, "b": found.vb + share_b * passed}
    for label, before in (("a", found.va), ("b", found.vb)):
        end = after[label] - slowed[label]
        rounding = _STILL * (abs(before) + found.closing) + found.rounding * found.closing
        backwards = (before < -rounding) | (end < -rounding)
        against = against | ((slowed[label] > 0.0) & backwards)
    return against


def _candidates(given: dict[str, Any], eps: float, incomplete: bool) -> list[Candidate]:
    """The one or two candidates that agree with the known values, possible or not."""
    known, more = _half_slowed(given)
    share_a, share_b, reduced, fixed = shares(known["mass_a"], known["mass_b"])
    # The change of velocity of a heavy body says little about the impact.
    share = {"a": share_a, "b": share_b, "": 1.0}[_only_changing(known)]
    found = []
    half = _half_of(given)
    slowed = half["a"] + half["b"]
    pairs = inline_speeds(known, share_a, share_b, reduced, eps, incomplete, more, slowed)
    for closing, separation in pairs:
        pair, pushed = (closing, separation), closing + separation > 0.0
        va, vb = known.get("va"), known.get("vb")
        if va is None and vb is None:
            total = closing + separation
            va = known["va_after"] + share_a * total if "va_after" in known else None
            vb = known["vb_after"] - share_b * total if "vb_after" in known else None
        va = vb + closing if va is None else va
        vb = va - closing if vb is None else vb
        if "duration" in given:
            va, vb = va + half["a"], vb + half["b"]
            closing, separation = closing - more, separation - more
        # Rounding may move an e of exactly 0 or 1.
        scale = sum(abs(known[name]) for name in VELOCITIES if name in known) + abs(va) + abs(vb)
        e = separation / closing
        rounding = 16.0 * eps * (1.0 + scale / (share * abs(closing)))
        # The roots of an energy are moved by more, and by its square root where they meet.
        parts = moved_by_rounding(known, share_a, share_b, reduced, eps, pair, scale)
        rounding = rounding + (parts[1] + abs(e) * parts[0]) / abs(closing)
        rounding = np.fmin(rounding, _MOST_ROUNDING)
        e = np.where(
            (e < 0.0) & (e >= -rounding), 0.0, np.where((e > 1.0) & (e <= 1.0 + rounding), 1.0, e)
        )
        e = known.get("restitution", e)
        least = (e > -1.0) if incomplete else (e >= 0.0)
        fits = (closing > 0.0) & least & (e <= 1.0) & np.isfinite(va + vb) & ~np.asarray(fixed)
        if len(pairs) > 1:
            # One of two may be that of no contact, in which tyres alone part the bodies.
            fits = fits & pushed
        one = Candidate(va, vb, e, closing, rounding, fits)
        found.append(one._replace(fits=fits & ~_against(given, one)))
    return found


def _condition(
    numbers: dict[str, Any], found: Candidate, which: Any, eps: float, incomplete: bool
) -> Any:
    """Condition: sum over the known values of the change in the speeds before, in closing speeds,
    per relative change.
    """
    total = np.zeros(())
    for name, value in numbers.items():
        beside = _candidates({**numbers, name: value * (1.0 + _STEP)}, eps, incomplete)
        change = sum(abs(np.choose(which, [one[i] for one in beside]) - found[i]) for i in range(2))
        total = total + np.where(np.isinf(value), 0.0, change)
    condition = total / (_STEP * abs(found.closing))
    return np.where(np.isfinite(condition), condition, np.inf)


def _only_changing(known: dict[str, Any]) -> str:
    """The body whose change of velocity is the only information on the impact; it says nothing if
    its mass is infinite.
    """
    return next((label for label in "ab" if {f"v{label}", f"v{label}_after"} <= known.keys()), "")


def _faults(given: dict[str, Any], found: Candidate) -> list[tuple[Any, int]]:
    """The reasons why no candidate fits; the first that applies counts."""
    known, _ = _half_slowed(given)
    share_a, share_b, *_ = shares(known["mass_a"], known["mass_b"])
    fixed = {label: np.isinf(known[f"mass_{label}"]) for label in "ab"}
    plastic_end = np.equal(known.get("restitution", 0.5), 0.0) & (
        {"va_after", "vb_after"} <= known.keys()
    )
    apart = moving_apart(known, share_a, share_b)
    return [
        (fixed["a"] & fixed["b"], Status.IMMOVABLE),
        (fixed.get(_only_changing(known), False), Status.INFINITE_MASS),
        (plastic_end, Status.INVERSE_E0),
        (
            np.isnan(found.closing) & np.equal(known.get("energy_loss", 0.0), 0.0),
            Status.UNDETERMINED,
        ),
        (((found.closing < 0.0) & np.isfinite(found.closing)) | apart, Status.SEPARATING),
        (found.closing == 0.0, Status.NO_CLOSING),
        (found.restitution < 0.0, Status.NOT_SEPARATING),
        (True, Status.CONTRADICTORY),
    ]


def _refusal(
    status: int, found: Candidate, numbers: dict[str, Any], incomplete: bool, say: Sentences
) -> CollisionsError:
    closing, e = float(found.closing), float(found.restitution)
    known = {name: float(value) for name, value in numbers.items() if not name.startswith("mass")}
    given = ", ".join(
        f"{name} = {say(value, _KINDS.get(name, 'speed'))}" for name, value in known.items()
    )
    along = "velocities are counted along the line from A to B, A behind"
    if status == Status.CONTRADICTORY and np.any(_against(numbers, found)):
        speeds = f"va = {say(found.va.item(), 'speed')} and vb = {say(found.vb.item(), 'speed')}"
        return error_of(
            status,
            f"{given} mean {speeds}, and a vehicle that its tyres hold would move from B towards "
            "A, before the impact or after it, where they hold it the other way; leave out its "
            "drag, or give what tyres did as outside_a and outside_b of eccentric",
            restitution=e,
            closing_speed=closing,
        )
    match status:
        case Status.SEPARATING:
            speed = (
                "no approach"
                if np.isnan(closing)
                else f"a closing speed of {say(closing, 'speed')}"
            )
            text = (
                f"{given} mean {speed}, so the bodies moved apart; {along}: change the signs, or "
                "exchange A and B"
            )
        case Status.NO_CLOSING:
            text = f"{given} mean a closing speed of 0, so there was no impact; {along}"
        case Status.NOT_SEPARATING:
            text = (
                f"{given} mean that the bodies still approach after the impact (restitution "
                f"{e:.4g}): one of them would pass through the other; "
                f"{along}{_allowed_losses(numbers, incomplete, say)}"
            )
            if not incomplete and e > -1.0:
                text += (
                    "; if they passed or tore before they had a common velocity, write "
                    "`incomplete=True`"
                )
        case Status.INVERSE_E0:
            apart = known["vb_after"] - known["va_after"]
            differs = (
                f" (here vb_after - va_after is {say(apart, 'speed')}, which contradicts that)"
                if apart
                else ""
            )
            text = (
                f"{given}: after a plastic impact (restitution = 0) both have one "
                f"velocity{differs}, and nothing is left of the closing speed; give energy_loss, "
                "va or vb instead of restitution"
            )
        case Status.INFINITE_MASS:
            text = (
                f"{given}: a body of infinite mass keeps its velocity, which tells nothing of "
                "the impact; give a velocity of the other body"
            )
        case Status.IMMOVABLE:
            text = "both masses are infinite, so nothing can yield; give at least one a finite mass"
        case Status.UNDETERMINED:
            text = f"{given} fit any closing speed; give another velocity"
        case _:
            text = _contradiction(given, known, e, numbers, incomplete, say)
    return error_of(status, text, restitution=e, closing_speed=closing)


def _ambiguous(
    known: tuple[str, ...], solutions: tuple[Impact, ...], say: Sentences
) -> CollisionsError:
    """The error for a single case that two impacts fit: it names what they differ in."""
    speeds = {
        name: [float(getattr(getattr(one, name[1]), when).vx) for one in solutions]
        for name in VELOCITIES
        for when in ["after" if name.endswith("after") else "before"]
        if name not in known
    }
    # Both speeds before may be known, and a wall has the same speed after.
    speeds = {name: found for name, found in speeds.items() if len(set(found)) > 1}
    parts = [
        [f"{name} = {text}" for text in say.apart(found, "speed")]
        for name, found in list(speeds.items())[:1]
    ]
    restitutions = [float(one.restitution) for one in solutions]
    parts.append([f"e = {text}" for text in say.apart(restitutions, "number", 4)])
    both = " or ".join(" with ".join(part) for part in zip(*parts, strict=True))
    return AmbiguousSolutionError(
        f"two impacts fit {', '.join(known)}: {both}`|; both are in .solutions|`; what decides is "
        f"{' or '.join((*speeds, 'restitution'))} in place of energy_loss",
        code="ambiguous",
        solutions=solutions,
    )


def _contradiction(
    given: str,
    known: dict[str, float],
    e: float,
    numbers: dict[str, Any],
    incomplete: bool,
    say: Sentences,
) -> str:
    """The contradiction between the known values, and its size."""
    names = [name for name in VELOCITIES if name in known]
    if "energy_loss" not in known and len(names) == 2:
        apart = known[names[0]] - known[names[1]]
        return (
            f"{given}: with these masses and this restitution {names[0]} and {names[1]} are "
            f"equal in every impact, and here they differ by {say(apart, 'speed')}"
        )
    if len(names) == 1:
        return (
            f"{given}: an elastic impact (restitution = 1) loses no energy; give energy_loss = 0 "
            "and two velocities"
        )
    if e > 1.0:
        return (
            f"{given} mean a restitution of {e:.6g}, above 1: the impact would gain energy; "
            "check masses and signs"
        )
    return (
        f"no impact fits {given}: with these masses and velocities the energy_loss cannot be as "
        f"given{_allowed_losses(numbers, incomplete, say)}"
    )


def _allowed_losses(numbers: dict[str, Any], incomplete: bool, say: Sentences) -> str:
    """The range of energy losses that the masses and two velocities allow with e from 0 to 1, if an
    energy was given.
    """
    share_a, share_b, reduced, _ = shares(numbers["mass_a"], numbers["mass_b"])
    least, most = allowed_losses(numbers, share_a, share_b, reduced)
    held = "duration" in numbers
    if "energy_loss" not in numbers or np.isnan(least) or incomplete or held:
        return ""
    top = "" if np.isinf(most) else f" and at most {say.at_most(float(most), 'energy')}"
    return f"; they allow at least {say.at_least(float(least), 'energy')}{top}"
