"""Works out again how well-posed a reverse solution was, so that what a record says of it can be
held against it.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import Any, get_args

import numpy as np

from ..impact.impact import Impact
from ..impact.inputs import TYRES
from ..impact.reconstruction import (
    KNOWN,
    OF_CONTACT,
    AsRecorded,
    Reconstruction,
)
from ..kernels.contact_laws import BRACH, FRICTION, RULES
from ..messages.errors import CollisionsError, InputError
from ..quantities.settings import in_si
from ..vehicle.vehicle import Vehicle
from .central import central
from .planar import Regime, planar
from .speeds import speeds

# A condition that is worked out again from an answer differs by the errors of its differences, and
# the more the greater it is itself, as it multiplies the rounding of the answer; never by more.
_SAME_CONDITION, _BY_ROUNDING, _MOST_APART = 1e-4, 1e-12, 0.01
# Of the contact velocity: as of motions that a machine with other rounding finds again.
_SAME_VELOCITY = 1e-6
# More than the rounding of angles in degrees, which a record has in radians.
_TIE = 1e-12
_METHODS = ("central", "planar", "speeds")
_MOTION = ("vx", "vy", "yaw_rate")
_AS_ARGUMENTS = {"contact_duration": "duration"}
_OF_B = ("ees_b", "max_crush_speed_b")
_AS_RESULTS = {"restitution": "restitution"} | dict.fromkeys(RULES, "inputs.rule_value")


def need_found_again(impact: Any) -> None:
    """Refuse an impact from a record whose reverse solution is not the one that the record says."""
    origin = impact.reconstruction if isinstance(impact, Impact) else None
    if isinstance(origin, AsRecorded):
        for contradiction in contradicted_origin(impact):
            raise InputError(
                f"impact was read from a record that contradicts itself: {contradiction}; the "
                f"record was changed, or is of another version. Write `reconstruct.{origin.method}"
                "(...)` again with what is known",
                code="bad_record",
                argument="impact",
            )


def contradicted_origin(impact: Impact) -> Iterator[str]:
    """What the record of a reverse solution says of its method, its condition or the number of
    answers that is not so.
    """
    origin = impact.reconstruction
    if origin is None:
        return
    if origin.method not in _METHODS:
        yield (
            f"its reconstruction names the method {origin.method!r}, which is none of "
            f"{', '.join(_METHODS)}"
        )
        return
    strange = [name for name in origin.known if name not in _taken(origin.method)]
    if strange:
        yield f"its reconstruction was given {strange[0]!r}, which {origin.method} does not take"
        return
    if not all(
        isinstance(value, float | int) and value >= least
        for value, least in ((origin.condition, 0.0), (origin.answers, 1))
    ):
        yield (
            f"its reconstruction has a condition of {origin.condition} and {origin.answers} "
            "answers, which no solution has"
        )
        return
    again = _again(impact, origin)
    if again is None:
        yield "what it says was given to its reverse solver does not lead to its speeds"
        return
    # Of a restitution that was a function of the impact the record has the number only.
    by_function = origin.method == "speeds" and "restitution" in origin.found
    found = (*again.found, *(("restitution",) if by_function else ()))
    if found != tuple(origin.found):
        yield (
            f"solving it again finds {', '.join(found) or 'nothing'}, and it says "
            f"{', '.join(origin.found) or 'nothing'}"
        )
    # A function adds to the condition how steep it is.
    if not (by_function or _same_condition(again, origin) or _at_a_tie(impact, origin)):
        yield (
            f"its inputs give a condition of {again.condition:.6g}, and it says "
            f"{origin.condition:.6g}"
        )
    said = {_along_axes(name) for name in origin.given}
    unsaid = said ^ {_along_axes(name) for name in again.given}
    if unsaid:
        does = "says" if unsaid & said else "does not say"
        yield f"it {does} what {min(unsaid)} was given to its reverse solver"
    for name, value in {**again.given, **_given_inputs(impact, origin)}.items():
        if name in origin.given and not _same_number(origin.given[name], value):
            yield (
                f"it says that {name} was given to its reverse solver as "
                f"{origin.given[name]!r}, and its inputs have {value!r}"
            )
    if origin.known != again.known:
        yield (
            f"its reconstruction was given {', '.join(origin.known)}, and solving again takes "
            f"{', '.join(again.known)}"
        )
    for name in OF_CONTACT.values():
        stands, found_with = getattr(origin, name), getattr(again, name)
        if stands != found_with:
            yield (
                f"its reconstruction has a {name} of {stands}, and its solver was given "
                f"{'none' if found_with is None else found_with}"
            )
    if again.regime != origin.regime:
        ways = (origin.regime or "open", again.regime or "open")
        yield (
            f"it says that how the contact ended was {ways[0]}, and solving it again takes it as "
            f"{ways[1]}"
        )
    if again.answers != origin.answers:
        yield f"its inputs have {again.answers} answers, and it says {origin.answers}"
    if again.left_backwards != origin.left_backwards:
        yield (
            f"it says that {origin.left_backwards} answers were left out in which a vehicle goes "
            f"backwards, and solving it again leaves out {again.left_backwards}"
        )
    if again.one_sided != origin.one_sided:
        yield (
            f"its inputs leave the speeds known by {again.one_sided or 'both sides'}, and it says "
            f"{origin.one_sided or 'both sides'}"
        )
    one, other = (math.nan if each.misfit is None else each.misfit for each in (origin, again))
    if not np.isclose(one, other, rtol=_SAME_CONDITION, atol=_SAME_VELOCITY, equal_nan=True):
        says = (
            "does not say how far what was known is from the answer"
            if origin.misfit is None
            else f"says that what was known is {origin.misfit:.6g} of the impulse from the answer"
        )
        finds = "none" if again.misfit is None else f"{again.misfit:.6g}"
        yield f"it {says}, and solving it again finds {finds}"
    pairs = (origin.slip_if_stuck or (), again.slip_if_stuck or ())
    scale = _SAME_VELOCITY * abs(impact.closing_speed)
    if len(pairs[0]) != len(pairs[1]) or not all(
        math.isclose(*ends, rel_tol=_SAME_VELOCITY, abs_tol=scale)
        for ends in zip(*pairs, strict=True)
    ):
        said_of, found_of = (
            "no contact that may have stuck" if not pair else f"a slip from {pair[0]} to {pair[1]}"
            for pair in pairs
        )
        yield f"it says {said_of}, and solving it again finds {found_of}"
    if not _same_velocity(impact, origin.contact_velocity, again.contact_velocity):
        pair = origin.contact_velocity
        velocity = "none" if pair is None else " and ".join(f"{float(one):.6g}" for one in pair)
        yield (
            f"its contact_velocity is {velocity}, and the impact closes with "
            f"{impact.closing_speed:.6g} m/s and slips with {impact.slip_before:.6g} m/s"
        )


def _same_velocity(impact: Impact, stands: Any, found: Any) -> bool:
    """Whether a closing speed and a slip are there if the reverse solver finds them, and are those
    of the impact, which leaves out what is not that of its motions.
    """
    if stands is None or found is None:
        return stands is found
    own = impact.closing_speed, impact.slip_before
    apart = _SAME_VELOCITY * math.fsum(map(abs, own))
    return all(abs(one - other) <= apart for one, other in zip(stands, own, strict=True))


def _given_inputs(impact: Impact, origin: Reconstruction) -> dict[str, Any]:
    """The inputs of the impact that its reverse solver was given and did not change, by name: how
    the answer was found need not show them, such as the friction of a contact that stuck.
    """
    inputs = impact.inputs
    of_contact = {"restitution": inputs.restitution, inputs.rule: inputs.rule_value}
    stay = {name: value for name, value in of_contact.items() if name not in origin.found}
    if origin.method == "central":
        stay |= {"va": inputs.a.vx, "vb": inputs.b.vx}
    return stay


def _same_number(given: float, stands: float) -> bool:
    """Whether a number that was given is one that stands elsewhere, but for rounding, in a case of
    a batch of float32 to its digits.
    """
    if math.isnan(given):
        return math.isnan(stands)
    with np.errstate(over="ignore"):
        return math.isclose(given, stands, rel_tol=_TIE) or float(np.float32(given)) == stands


def _same_condition(one: Reconstruction, other: Reconstruction) -> bool:
    apart = min(_SAME_CONDITION + _BY_ROUNDING * one.condition, _MOST_APART)
    return math.isclose(one.condition, other.condition, rel_tol=apart)


def _at_a_tie(impact: Impact, origin: Reconstruction) -> bool:
    """Whether rounding of the components of delta-V decides which condition an answer has: one that
    just sticks is also one that just slides, and each has its own.
    """
    for more in (1.0 + _TIE, 1.0 - _TIE):
        nudged = {
            name: value * more if "_forward_" in name else value
            for name, value in origin.given.items()
        }
        again = _again(impact, replace(origin, given=nudged))
        if again is not None and _same_condition(again, origin):
            return True
    return False


def _along_axes(name: str) -> str:
    """The name of a motion after that stands for a speed and a course after."""
    return name.replace("_after.speed", "_after.vx").replace("_after.course", "_after.vy")


def _taken(method: str) -> set[str]:
    """What a reverse solver can have been given, as its reconstruction names it."""
    own = {
        "central": {"va", "vb", "restitution"},
        "planar": {"restitution", *RULES},
        "speeds": {"restitution", *RULES},
    }
    return own[method] | {name for name, known in KNOWN.items() if method in known.methods}


def _again(impact: Impact, origin: Reconstruction) -> Reconstruction | None:
    """The same solution found again from the answer; None where what is left of it does not give it
    back.

    Of an answer at a fold, of an infinite range, or near the rounding of its inputs, nothing can be
    worked out again.
    """
    near: list[Reconstruction] = []
    # A record of planar does not say how the contact was asked to have ended.
    asked: Sequence[dict[str, Any]] = ({},)
    if origin.method == "planar":
        asked = [{"regime": regime} for regime in (None, *get_args(Regime))]
    for options in asked:
        try:
            with warnings.catch_warnings(), in_si():
                warnings.simplefilter("ignore")
                found = _solved_again(impact, origin, **options)
        except CollisionsError as error:
            # Several answers, or the ends of a range of them.
            found = error.solutions
        except (TypeError, LookupError):
            # A known value that the method does not take, or half of one.
            continue
        near += [
            one.reconstruction
            for one in found
            if _is_same(one, impact) and one.reconstruction is not None
        ]
        if any(one.answers == origin.answers for one in near):
            break
    # Of several, the one that leads to what the record says.
    return max(near, key=lambda one: one.answers == origin.answers, default=None)


def _solved_again(impact: Impact, origin: Reconstruction, **options: Any) -> tuple[Any, ...]:
    """The reverse solver's answers to the numbers that it was given."""
    paths = _AS_RESULTS | {name: known.path for name, known in KNOWN.items() if known.path}
    inputs, given = impact.inputs, dict(origin.given)
    recorded = {name for name in origin.known if name.startswith("recorder_")}
    known: dict[str, Any] = {}
    for name in set(origin.known) - recorded:
        # A recorder reads in place of the delta-V of the centre of mass.
        reading = name.replace("delta_v", "reading")
        known[name] = next(
            (given[one] for one in (reading, name) if one in given),
            attrgetter(paths[name])(impact) if name in paths else None,
        )
    if None in known.values():
        return ()
    # Of what was known of both vehicles A's name stands for both.
    known |= {name: given[name] for name in _OF_B if name in given}
    contact: dict[str, Any] = {"normal": inputs.normal, "point": inputs.point}
    contact |= {"law": inputs.law or BRACH, "incomplete": inputs.incomplete}
    wheels = {name: getattr(inputs, name) for name in ("duration", *TYRES)}
    if origin.method == "central":
        known = {_AS_ARGUMENTS.get(name, name): value for name, value in known.items()}
        return (central(inputs.a.mass, inputs.b.mass, **known, incomplete=inputs.incomplete),)
    if origin.method == "planar":
        # What is worked out after it may be rounded to where another answer, or none, is found.
        after_a, after_b = (
            getattr(impact, label).after.replace(
                **{
                    part: given[name]
                    for part in _MOTION
                    if (name := f"{label}_after.{part}") in given
                }
            )
            for label in "ab"
        )
        return (planar(after_a, after_b, **known, **contact, **wheels, **options),)
    if any(name.startswith(("delta_v_forward", "delta_v_left")) for name in known):
        slid = None if origin.one_sided is None else "bound"
        contact |= {"regime": origin.regime, "slid": slid}
    if recorded:
        contact |= _recorders(given, recorded)
        wheels["duration"] = given.get("recorder_duration", inputs.duration)
    # One that stands needs no course.
    bodies = {name: given.get(name) for name in ("course_a", "course_b")}
    contact["forward_only"] = origin.left_backwards is not None
    # A friction that was found was given as infinite, or as one that may have been greater.
    rule_value = given.get(FRICTION, math.inf) if FRICTION in origin.found else inputs.rule_value
    more: dict[str, Any] = {**bodies, **contact, **known, **options, inputs.rule: rule_value}
    return speeds(inputs.a, inputs.b, restitution=inputs.restitution, **more, **wheels)


def _recorders(given: Mapping[str, float], names: Collection[str]) -> dict[str, Any]:
    """Places and axes of recorders, as arguments of ``speeds``."""
    found: dict[str, Any] = {
        name: (given[f"recorder_forward_{name[-1]}"], given[f"recorder_left_{name[-1]}"])
        for name in ("recorder_a", "recorder_b")
        if name in names and f"recorder_forward_{name[-1]}" in given
    }
    axes = [name.removeprefix("recorder_axes_") for name in names if "_axes_" in name]
    return found | ({"axes": axes[0]} if axes else {})


def _is_same(one: Impact, other: Impact) -> bool:
    """Whether two impacts have the same motions before and after, to what the condition leaves of
    the digits; a yaw rate by the speed that it makes at the radius of gyration.
    """
    scale = abs(other.closing_speed)
    sides = [(getattr(one, label), getattr(other, label)) for label in "ab"]
    pairs = [pair for a, b in sides for pair in ((a.before, b.before), (a.after, b.after))]
    return all(
        math.hypot(a.vx - b.vx, a.vy - b.vy, _around(b) * (a.yaw_rate - b.yaw_rate)) <= 1e-6 * scale
        for a, b in pairs
    )


def _around(body: Vehicle) -> float:
    """The radius of gyration [m]; 0 where it is not known, or either is infinite."""
    inertia, mass = body.yaw_inertia, body.mass
    return math.sqrt(inertia / mass) if inertia is not None and math.isfinite(inertia) else 0.0
