"""Findings on choices: a model too small for the scene, the law, and the direction of the normal."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from ..directions import from_degrees
from ..impact import Impact
from ..kernels import codes
from ..quiet import quietly
from ..scene import required_model
from .case import Case, kmh
from .finding import Finding

_TURN = 10.0  # degrees


def model(case: Case) -> Iterator[Finding]:
    """A central model where a lever or a slip matters."""
    impact = case.impact
    if impact.model == "eccentric":
        return
    asked, a, b = impact._asked, impact.a.before, impact.b.before
    point: Any = impact.point
    between = ""
    places: Any = (a.x, a.y, b.x, b.y)
    if point is None and None not in places:
        point = 0.5 * (places[0] + places[2]), 0.5 * (places[1] + places[3])
        between = ", with the contact point taken half-way between the centres"
    options: dict[str, Any] = {
        asked.rule: asked.bound,
        "normal": impact.normal,
        "point": point,
        "law": asked.law or codes.BRACH,
    }
    choice = required_model(a, b, impact.restitution, **options)
    error = choice.errors[impact.model]
    if math.isnan(error):
        missing = choice.missing["eccentric"]
        why = f"{', '.join(missing)} would tell" if missing else "the eccentric model has no answer here"
        sentence = f"nothing tells what {impact.model} errs by: {why}"
        yield from case.above("model", math.inf, sentence)
        return
    delta_v = min((side.delta_v for _, side in case.sides if side.delta_v > 0.0), default=math.inf)
    yield from case.above(
        "model",
        error / delta_v,
        f"{impact.model} is predicted to err by {kmh(error)}{between}, against a delta-V of {kmh(delta_v)}: take eccentric",
    )


def law(case: Case) -> Iterator[Finding]:
    """An answer that hangs on what restitution and no slip are taken to mean."""
    impact = case.impact
    if impact.law is None or impact.model == "linear_central":
        return
    other = next(name for name in codes.LAWS if name != impact.law)
    moved = _moved(impact, law=other)
    if math.isinf(moved):
        sentence = f"under the law {other!r} there is no answer"
    else:
        sentence = f"delta-V and yaw move by {moved:.0%} of delta-V if the law is {other!r} instead of {impact.law!r}"
    yield from case.above("law", moved, sentence)


def normal(case: Case) -> Iterator[Finding]:
    """An answer that hangs on the direction of the normal."""
    impact = case.impact
    if impact._asked.model == "linear_central":
        return
    nx, ny = impact.normal
    turned = []
    for angle in (-_TURN, _TURN):
        c, s = from_degrees(angle)
        turned.append((_moved(impact, normal=(c * nx - s * ny, s * nx + c * ny)), angle))
    moved, angle = max(turned)
    if math.isinf(moved):
        sentence = f"with the normal turned by {angle:+.0f} degrees there is no answer"
    else:
        sentence = f"delta-V and yaw move by {moved:.0%} of delta-V if the normal is turned by {angle:+.0f} degrees"
    yield from case.above("normal", moved, sentence)


def _moved(impact: Impact, **changes: Any) -> float:
    """How far the magnitude of delta-V and, times the radius of gyration, the yaw rate move; for the worse vehicle."""
    with quietly():
        again = impact._again(**changes)
    if again.refused:
        return math.inf
    worst = 0.0
    for old, new in ((impact.a, again.a), (impact.b, again.b)):
        if old.delta_v == 0.0:
            continue
        inertia, mass = old.before.yaw_inertia, old.before.mass
        turns = inertia is not None and not math.isinf(inertia) and not math.isinf(mass)
        radius = math.sqrt(inertia / mass) if turns and inertia is not None else 0.0
        step = math.hypot(new.delta_v - old.delta_v, radius * (new.delta_yaw_rate - old.delta_yaw_rate))
        worst = max(worst, step / old.delta_v)
    return worst
