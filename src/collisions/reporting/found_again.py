"""Works out again how well-posed a reverse solution was, so that what a record says of it can be
held against it.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from operator import attrgetter
from typing import Any

from ..impact.impact import Impact
from ..impact.inputs import TYRES
from ..impact.provenance import KNOWN, Reconstruction
from ..kernels.contact_laws import BRACH, RULES
from ..messages.errors import AmbiguousSolutionError, CollisionsError
from ..reconstruct import central, planar, speeds

# What is worked out from an answer that was rounded differs in its later digits; a changed record
# differs in its first ones.
_SAME_CONDITION = 0.01
_METHODS = ("central", "planar", "speeds")
_AS_ARGUMENTS = {"contact_duration": "duration"}
_AS_RESULTS = {"restitution": "restitution"} | dict.fromkeys(RULES, "inputs.rule_value")


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
    if not float(origin.condition) >= 0.0 or not float(origin.answers) >= 1.0:
        yield (
            f"its reconstruction has a condition of {origin.condition} and {origin.answers} "
            "answers, which no solution has"
        )
        return
    again = _again(impact, origin)
    if again is None:
        return
    if not math.isclose(again.condition, origin.condition, rel_tol=_SAME_CONDITION):
        yield (
            f"its inputs give a condition of {again.condition:.6g}, and it says "
            f"{origin.condition:.6g}"
        )
    if origin.known != again.known:
        yield (
            f"its reconstruction was given {', '.join(origin.known)}, and solving again takes "
            f"{', '.join(again.known)}"
        )
    if again.answers != origin.answers:
        yield f"its inputs have {again.answers} answers, and it says {origin.answers}"
    if again.one_sided != origin.one_sided:
        yield (
            f"its inputs leave the speeds known by {again.one_sided or 'both sides'}, and it says "
            f"{origin.one_sided or 'both sides'}"
        )


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
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = _solved_again(impact, origin)
    except AmbiguousSolutionError as error:
        found = error.solutions
    except (CollisionsError, TypeError):
        # A known value that the method does not take; such a record was refused above, or is of an
        # older version.
        return None
    near = [
        one.reconstruction
        for one in found
        if _is_same(one, impact) and one.reconstruction is not None
    ]
    return near[0] if near else None


def _solved_again(impact: Impact, origin: Reconstruction) -> tuple[Any, ...]:
    """The reverse solver's answers to what the impact shows of its known values."""
    paths = _AS_RESULTS | {name: known.path for name, known in KNOWN.items() if known.path}
    known = {name: attrgetter(paths[name])(impact) for name in origin.known if name in paths}
    inputs = impact.inputs
    contact: dict[str, Any] = {"normal": inputs.normal, "point": inputs.point}
    contact |= {"law": inputs.law or BRACH, "incomplete": inputs.incomplete}
    if len(known) < len(origin.known):
        return ()
    wheels = {name: getattr(inputs, name) for name in ("duration", *TYRES)}
    if origin.method == "central":
        known = {_AS_ARGUMENTS.get(name, name): value for name, value in known.items()}
        return (central(inputs.a.mass, inputs.b.mass, **known, incomplete=inputs.incomplete),)
    if origin.method == "planar":
        return (planar(impact.a.after, impact.b.after, **known, **contact, **wheels),)
    if any(name.startswith(("delta_v_forward", "delta_v_left")) for name in known):
        slid = None if origin.one_sided is None else "bound"
        contact |= {"regime": origin.regime, "slid": slid}
    courses = {f"course_{label}": getattr(inputs, label).course for label in "ab"}
    more: dict[str, Any] = {**courses, **contact, **known, inputs.rule: inputs.rule_value}
    return speeds(inputs.a, inputs.b, restitution=inputs.restitution, **more, **wheels)


def _is_same(one: Impact, other: Impact) -> bool:
    """Whether two impacts have the same speeds before, to what the condition leaves of
    the digits.
    """
    scale = abs(other.closing_speed)
    pairs = ((getattr(one.inputs, label), getattr(other.inputs, label)) for label in "ab")
    return all(math.hypot(a.vx - b.vx, a.vy - b.vy) <= 1e-6 * scale for a, b in pairs)
