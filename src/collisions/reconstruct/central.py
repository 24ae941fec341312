"""In-line impact backwards: from any three of four velocities, restitution and energy loss to the whole impact."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ..amounts import amount
from ..errors import AmbiguousSolutionError, CollisionsError
from ..impact import Impact, found_by
from ..inputs import Inputs, OnFailure
from ..kernels.contact_laws import FRICTION
from ..kernels.elementwise import POSITIVE, RESTITUTION
from ..kernels.linear import shares
from ..kernels.reverse import VELOCITIES, allowed_losses, inline_speeds, moving_apart
from ..kernels.status import EPS, Status
from ..provenance import Reconstruction
from ..quantities import show
from ..reading import ArgumentReader
from ..solving import error_of
from ..units import Input
from ..vehicle import Vehicle
from .common import Cases, exactly, input_faults, settle

_ALONG: Any = (1.0, 0.0)
_NONE: Any = 0.0
_MOST_ROUNDING = 0.01  # of e; beyond it the data tell nothing, and are not bent further
_STEP = 1e-6  # relative, for the sensitivity: between the rounding of a quotient and the curvature of a square root


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
    on_failure: OnFailure | None = None,
) -> Impact:
    """In-line impact from exactly three of four velocities, restitution and energy loss.

    Two point masses on one line, A behind B: velocities are counted along the line from A to B, so ``va > vb`` before the
    impact and ``va_after <= vb_after`` after it. All twenty combinations are solved in closed form (eqs 5 to 8 of "Application
    of Impulse Momentum Theory to Vehicle Collisions"), and the answer is that of ``linear_central`` for the state found.

    Parameters
    ----------
    mass_a, mass_b : float, str, Quantity or array [kg]
        Masses, > 0; ``inf`` for what does not move.
    va, vb : float, str, Quantity or array [m/s], optional
        Velocities before.
    va_after, vb_after : float, str, Quantity or array [m/s], optional
        Velocities after.
    restitution : float, str, Quantity or array [1], optional
        Coefficient of restitution, 0 to 1.
    energy_loss : float, str, Quantity or array [J], optional
        Energy dissipated, >= 0: what is left after restitution, not the energy absorbed at maximum crush.
    on_failure : {None, "raise", "nan"}, optional
        What a refused case of a batch does: NaN and one warning, an error, or NaN without a word.

    Returns
    -------
    Impact
        As ``linear_central`` gives it; ``reconstruction.condition`` says how well-posed the question was. Impulse and energy
        have all digits also where the closing speed is tiny: they are worked out from ``reconstruction.contact_velocity``, not
        from the rounded velocities before.

    Raises
    ------
    InputError
        An argument that cannot be used, or not exactly three of the six.
    AmbiguousSolutionError
        Two impacts fit; both are in ``solutions``.
    NoImpactError
        What was given means that the bodies did not approach.
    NoSolutionError
        What was given contradicts itself or leaves the answer open; the message says why.

    Examples
    --------
    Example 2 of the paper: 1100 kg at 80 km/h into the back of 950 kg at rest, which leaves with 60 km/h.

    >>> from collisions import reconstruct
    >>> impact = reconstruct.central("1100 kg", "950 kg", va="80 km/h", vb=0.0, vb_after="60 km/h")
    >>> round(impact.restitution, 3), round(impact.a.after.q.vx.m_as("km/h"), 2)
    (0.398, 28.18)
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
    masses = reader.number(mass_a, "kg", "mass_a", POSITIVE), reader.number(mass_b, "kg", "mass_b", POSITIVE)
    known = {name: _read(reader, value, name) for name, value in given.items()}
    reader.close()
    texts = reader.texts
    written = [
        {name: texts[key] for name, key in (("mass", f"mass_{label}"), ("vx", f"v{label}")) if key in texts} for label in "ab"
    ]
    told = {name: text for name, text in texts.items() if name not in ("mass_a", "mass_b", "va", "vb")} or None
    cases = Cases.of({**_named(masses), **known})
    eps = EPS if cases.shape is None else float(np.finfo(cases.dtype).eps)
    numbers = {name: np.asarray(value, dtype=np.float64) for name, value in {**_named(masses), **known}.items()}
    with np.errstate(all="ignore"):
        answers = _answers(numbers, eps)
        one, other = answers[0], answers[-1]
        which = np.where(one["fits"] | (~other["fits"] & (one["closing"] > 0.0)), 0, len(answers) - 1)
        found = {name: np.choose(which, [answer[name] for answer in answers]) for name in answers[0]}
        found |= _limits(numbers)
        condition = _condition(numbers, found, which, eps)
        ambiguous = _differ(answers, eps)
        status = cases.first_status(
            (
                *input_faults({**_named(masses), **known}),
                (ambiguous, Status.AMBIGUOUS),
                (found["fits"], Status.OK),
                *_faults(masses, known, found),
            )
        )
    sure = np.equal(status, Status.OK)
    origin = Reconstruction(
        method="central",
        known=tuple(known),
        condition=cases.values(np.where(sure, condition, np.nan)),
        answers=cases.whole(np.where(ambiguous, len(answers), 1)),
        contact_velocity=_without_slip(cases, np.where(sure, found["closing"], np.nan)),
    )

    def asked(answer: dict[str, Any], keep: Any) -> Inputs:
        # In line, so that nothing moves across or turns; of a state that was not found nothing is said.
        still: Any = 0.0 if np.all(keep) else cases.values(np.where(keep, 0.0, np.nan))
        a, b = (
            Vehicle(mass=mass)._moved(cases.values(np.where(keep, answer[name], np.nan)), still, still)._told(given_as)
            for mass, name, given_as in zip(masses, ("va", "vb"), written, strict=True)
        )
        e = cases.values(np.where(keep, answer["e"], np.nan))
        return Inputs("linear_central", a, b, e, _ALONG, FRICTION, _NONE, None, None, told)

    def solution(which: int) -> Impact:
        with np.errstate(all="ignore"):
            condition = cases.values(_condition(numbers, answers[which], np.intp(which), eps))
        velocity = _without_slip(cases, answers[which]["closing"])
        impact = Impact._solved(asked(answers[which], True)._changed(contact_velocity=velocity))
        one = replace(origin, condition=condition, answers=len(answers), contact_velocity=velocity)
        return found_by(one, impact.inputs, impact._raw, Status.OK)

    def error(index: tuple[int, ...]) -> CollisionsError:
        if cases.shape is None and status == Status.AMBIGUOUS:
            solutions = tuple(solution(k) for k in range(len(answers)))
            both = " or ".join(f"va = {s.a.before.vx:.6g} m/s with e = {s.restitution:.4g}" for s in solutions)
            return AmbiguousSolutionError(
                f"two impacts fit {', '.join(known)}: {both}; both are in .solutions, and a velocity of the other kind decides",
                code="ambiguous",
                solutions=solutions,
            )
        code = int(np.asarray(status)[index])
        of_case: dict[str, Any] = {name: cases.one(value, index) for name, value in {**_named(masses), **known}.items()}
        if code == Status.AMBIGUOUS:
            try:
                central(**of_case)
            except CollisionsError as both:
                return both
        given = {name: of_case[name] for name in known}
        return _error(code, {name: cases.one(value, index) for name, value in found.items()}, given)

    return settle(partial(asked, found), status, origin, on_failure, error)


def _read(reader: ArgumentReader, value: Any, name: str) -> Any:
    if name == "restitution":
        return reader.number(value, "", name, RESTITUTION)
    if name != "energy_loss":
        return reader.number(value, "m/s", name)
    return amount(reader, value, "J", name)


def _without_slip(cases: Cases, closing: Any) -> tuple[Any, Any]:
    return cases.values(closing), cases.values(0.0 * closing)


def _named(masses: tuple[Any, Any]) -> dict[str, Any]:
    return dict(zip(("mass_a", "mass_b"), masses, strict=True))


def _answers(numbers: dict[str, Any], eps: float) -> list[dict[str, Any]]:
    """What fits, one dictionary a candidate, and whether it is an impact at all."""
    share_a, share_b, reduced, fixed = shares(numbers["mass_a"], numbers["mass_b"])
    return [
        _whole(numbers, share_a, share_b, closing, separation, fixed, eps)
        for closing, separation in inline_speeds(numbers, share_a, share_b, reduced, eps)
    ]


def _limits(numbers: dict[str, Any]) -> dict[str, Any]:
    """What the velocities allow, for the messages."""
    share_a, share_b, reduced, _ = shares(numbers["mass_a"], numbers["mass_b"])
    least, most = allowed_losses(numbers, share_a, share_b, reduced)
    asked = "energy_loss" in numbers
    return {
        "least": least if asked else np.nan,
        "most": most if asked else np.nan,
        "apart": moving_apart(numbers, share_a, share_b),
    }


def _whole(
    known: dict[str, Any], share_a: Any, share_b: Any, closing: Any, separation: Any, fixed: Any, eps: float
) -> dict[str, Any]:
    """The impact of a pair of closing and separation speed."""
    total = closing + separation
    va, vb = known.get("va"), known.get("vb")
    if va is None and vb is None:
        if "va_after" in known:
            va = known["va_after"] + share_a * total
        if "vb_after" in known:
            vb = known["vb_after"] - share_b * total
    if va is None:
        va = vb + closing
    if vb is None:
        vb = va - closing
    # What rounding leaves of an e of exactly 0 or 1; the change of velocity of a heavy body tells little of the impact.
    scale = sum(abs(known[name]) for name in VELOCITIES if name in known) + abs(va) + abs(vb)
    told = {"a": share_a, "b": share_b, "": 1.0}[_needs_motion_of(known)]
    rounding = np.fmin(16.0 * eps * (1.0 + scale / (told * abs(closing))), _MOST_ROUNDING)
    e = known.get("restitution", separation / closing)
    e = np.where((e < 0.0) & (e >= -rounding), 0.0, np.where((e > 1.0) & (e <= 1.0 + rounding), 1.0, e))
    fits = (closing > 0.0) & (e >= 0.0) & (e <= 1.0) & np.isfinite(va + vb) & ~np.asarray(fixed)
    return {"va": va, "vb": vb, "e": e, "closing": closing, "fits": fits}


def _differ(answers: list[dict[str, Any]], eps: float) -> Any:
    """Whether two answers fit, which are not one that rounding has split."""
    if len(answers) == 1:
        return False
    one, other = answers
    apart = abs(one["closing"] - other["closing"]) > 64.0 * eps * abs(one["closing"])
    return one["fits"] & other["fits"] & apart


def _condition(numbers: dict[str, Any], found: dict[str, Any], which: Any, eps: float) -> Any:
    """Sum over what was given of the change of the speeds before, in closing speeds, by its own relative change."""
    total = np.zeros(())
    for name, value in numbers.items():
        answers = _answers({**numbers, name: value * (1.0 + _STEP)}, eps)
        change = sum(abs(np.choose(which, [answer[v] for answer in answers]) - found[v]) for v in ("va", "vb"))
        total = total + np.where(np.isinf(value), 0.0, change)
    condition = total / (_STEP * abs(found["closing"]))
    return np.where(np.isfinite(condition), condition, np.inf)


def _faults(masses: tuple[Any, Any], known: dict[str, Any], found: dict[str, Any]) -> list[tuple[Any, int]]:
    """Why nothing fits, the first that applies."""
    restitution: Any = known.get("restitution", 0.5)
    silent = _needs_motion_of(known)
    at_rest_a, at_rest_b = (np.isinf(mass) for mass in masses)
    return [
        (at_rest_a & at_rest_b, Status.IMMOVABLE),
        ((at_rest_a & ("a" in silent)) | (at_rest_b & ("b" in silent)), Status.INFINITE_MASS),
        (np.equal(restitution, 0.0) & (known.keys() == {"va_after", "vb_after", "restitution"}), Status.INVERSE_E0),
        (np.isnan(found["closing"]) & np.equal(known.get("energy_loss", 0.0), 0.0), Status.UNDETERMINED),
        (((found["closing"] < 0.0) & np.isfinite(found["closing"])) | found["apart"], Status.SEPARATING),
        (found["closing"] == 0.0, Status.NO_CLOSING),
        (found["e"] < 0.0, Status.NOT_SEPARATING),
        (True, Status.CONTRADICTORY),
    ]


def _needs_motion_of(known: dict[str, Any]) -> str:
    """Which body's change of velocity is asked about the impact, and tells nothing if its mass is infinite."""
    v = [name for name in VELOCITIES if name in known]
    if len(v) == 3:
        return "a" if {"va", "va_after"} <= set(v) else "b"
    return "a" if v == ["va", "va_after"] else "b" if v == ["vb", "vb_after"] else ""


def _error(status: int, found: dict[str, float], known: dict[str, float]) -> CollisionsError:
    closing, e = found["closing"], found["e"]
    given = ", ".join(f"{name} = {show(value)}" for name, value in known.items())
    along = "velocities are counted along the line from A to B, A behind"
    speed = "no approach" if np.isnan(closing) else f"a closing speed of {closing:.6g} m/s"
    texts: dict[int, str] = {
        Status.SEPARATING: f"{given} mean {speed}, so the bodies moved apart; {along}: change the signs, or exchange A and B",
        Status.NO_CLOSING: f"{given} mean a closing speed of 0, so there was no impact; {along}",
        Status.NOT_SEPARATING: f"{given} mean that the bodies still approach after the impact (restitution {e:.4g}); {along}: "
        f"one of them would pass through the other{_limit(found)}",
        Status.INVERSE_E0: f"{given}: after a plastic impact (restitution = 0) both have one velocity"
        f"{_difference(known)}, and nothing is left of the closing speed; give energy_loss, va or vb instead of restitution",
        Status.INFINITE_MASS: f"{given}: a body of infinite mass keeps its velocity, which tells nothing of the impact; give a "
        f"velocity of the other body",
        Status.IMMOVABLE: "both masses are infinite, so nothing can yield; give at least one a finite mass",
        Status.UNDETERMINED: f"{given} fit any closing speed; give another velocity",
    }
    text = texts.get(status) or _contradiction(given, found, known)
    return error_of(status, text, restitution=e, closing_speed=closing)


def _difference(known: dict[str, float]) -> str:
    """By how much the two velocities after are not one, where they are not."""
    apart = known.get("vb_after", 0.0) - known.get("va_after", 0.0)
    return f" (here vb_after - va_after is {apart:.6g} m/s, which contradicts that)" if apart else ""


def _contradiction(given: str, found: dict[str, float], known: dict[str, float]) -> str:
    """What does not go together, and by how much."""
    names = [name for name in VELOCITIES if name in known]
    if "energy_loss" not in known and len(names) == 2:
        apart = known[names[0]] - known[names[1]]
        return (
            f"{given}: with these masses and this restitution {names[0]} and {names[1]} are equal in every impact, and here "
            f"they differ by {apart:.6g} m/s"
        )
    if len(names) == 1:
        return f"{given}: an elastic impact (restitution = 1) loses no energy; give energy_loss = 0 and two velocities"
    if found["e"] > 1.0:
        return f"{given} mean a restitution of {found['e']:.6g}, above 1: the impact would gain energy; check masses and signs"
    return f"no impact fits {given}: with these masses and velocities the energy_loss cannot be as given{_limit(found)}"


def _limit(found: dict[str, float]) -> str:
    """What energy the masses and two velocities allow, where they say."""
    least, most = found["least"], found["most"]
    if np.isnan(least):
        return ""
    return f"; they allow at least {least:.6g} J" + ("" if np.isinf(most) else f" and at most {most:.6g} J")
