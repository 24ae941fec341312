"""Findings on choices: a model too small for the scene, the law, and the direction of the normal."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from ..directions import from_degrees
from ..impact import Impact
from ..kernels.contact_laws import BRACH, LAWS
from ..side import Side
from ..solvers import required_model
from ..warning import quietly
from .case import Case, named, share
from .finding import Finding

_TURN = 10.0  # degrees
_SEEN = 0.1  # rad/s; a difference of yaw rates below this shows in no rest position


def model(case: Case) -> Iterator[Finding]:
    """A central model where a lever or a slip matters."""
    impact = case.impact
    if impact.model == "eccentric":
        return
    inputs, a, b = impact.inputs, impact.a.before, impact.b.before
    point: Any = impact.point
    between = ""
    places: Any = (a.x, a.y, b.x, b.y)
    if point is None and None not in places:
        point = 0.5 * (places[0] + places[2]), 0.5 * (places[1] + places[3])
        between = ", with the contact point taken half-way between the centres"
    options: dict[str, Any] = {
        inputs.rule: inputs.rule_value,
        "normal": impact.normal,
        "point": point,
        "law": inputs.law or BRACH,
    }
    choice = required_model(a, b, impact.restitution, **options)
    error = choice.errors[impact.model]
    if math.isnan(error):
        missing = choice.missing["eccentric"]
        told = f"nothing tells what {impact.model} errs by"
        if missing:
            yield from case.above("model_unknown", len(missing), f"{told}: {', '.join(missing)} would tell")
        else:
            yield from case.above("model", math.inf, f"{told}: the eccentric model has no answer here")
        return
    delta_v = min((side.delta_v for _, side in case.sides if side.delta_v > 0.0), default=math.inf)
    yield from case.above(
        "model",
        error / delta_v,
        f"{impact.model} is predicted to err by {case.words.speed(error)}{between}, against a delta-V of "
        f"{case.words.speed(delta_v)}: take eccentric",
    )


def law(case: Case) -> Iterator[Finding]:
    """An answer that hangs on what restitution and no slip are taken to mean."""
    impact = case.impact
    if impact.law is None or impact.model == "linear_central":
        return
    others = [name for name in LAWS if name != impact.law]
    answers = [(f"under the law {other!r} instead of {impact.law!r}", _again(impact, law=other)) for other in others]
    yield from _told(case, "law", answers)


def normal(case: Case) -> Iterator[Finding]:
    """An answer that hangs on the direction of the normal."""
    impact = case.impact
    if impact.inputs.model == "linear_central":
        return
    nx, ny = impact.normal
    turned = []
    for angle in (-_TURN, _TURN):
        c, s = from_degrees(angle)
        how = f"with the normal turned by {'+' if angle > 0.0 else ''}{case.words.angle(math.radians(angle))}"
        turned.append((how, _again(impact, normal=(c * nx - s * ny, s * nx + c * ny))))
    yield from _told(case, "normal", turned)


def _again(impact: Impact, **changes: Any) -> Impact:
    """The question again; what is to be said of it was said the first time."""
    with quietly():
        return impact._again(**changes)


def _told(case: Case, code: str, answers: list[tuple[str, Impact]]) -> Iterator[Finding]:
    """The worst of what other answers make of delta-V and of yaw."""
    moves = [
        (how, label, old, new)
        for how, answer in answers
        if not answer.refused
        for (label, old), new in zip(case.sides, (answer.a, answer.b), strict=True)
    ]
    lost = [how for how, answer in answers if answer.refused]
    if lost:
        yield from case.above(code, math.inf, f"{lost[0]} there is no answer")
    elif moves:
        how, label, old, new = max(moves, key=lambda move: _vector(*move[2:]))
        moved = _vector(old, new)
        yield from case.above(
            code,
            moved,
            f"{how} delta-V of {named(label, old)} moves by {case.words.percent(moved)} of itself, from "
            f"{case.words.speed(old.delta_v)} to {case.words.speed(new.delta_v)}, and its direction by "
            f"{case.words.angle(_turn(old, new))}",
            label,
        )
    if moves:
        how, label, old, new = max(moves, key=lambda move: _yaw(*move[2:]))
        was, now = (side.delta_yaw_rate for side in (old, new))
        both_turn = min(abs(was), abs(now)) > _SEEN
        other_way = ", the other way" if both_turn and was * now < 0.0 else ""
        yield from case.above(
            f"{code}_yaw",
            _yaw(old, new),
            f"{how} the impact turns {named(label, old)} by {case.words.yaw_rate(now)} instead of "
            f"{case.words.number(was, 'yaw rate')}{other_way}",
            label,
        )


def _vector(old: Side, new: Side) -> float:
    """Length of the change of delta-V, as a share of it; none for a body that nothing moves."""
    length = math.hypot(new.delta_vx - old.delta_vx, new.delta_vy - old.delta_vy)
    return share(length, old.delta_v) if old.delta_v > 0.0 else 0.0


def _turn(old: Side, new: Side) -> float:
    """Angle between both delta-Vs."""
    was, now = (math.atan2(side.delta_vy, side.delta_vx) for side in (old, new))
    return abs(math.remainder(now - was, math.tau))


def _yaw(old: Side, new: Side) -> float:
    """Difference of both changes of yaw rate, as a share of the larger; above 1 with the other sign."""
    was, now = old.delta_yaw_rate, new.delta_yaw_rate
    step = abs(now - was)
    return share(step, max(abs(was), abs(now))) if step > _SEEN else 0.0
