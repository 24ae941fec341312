"""Impacts to test on: seeded random scenes of the families of the numerics note, and hypothesis
strategies for realistic ones.
"""

from __future__ import annotations

import math
import random
import warnings
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from hypothesis import strategies as st

import collisions as col
from collisions.travel import Tyres
from reference import SINGULAR, Answer, Body, Scene, evaluate

LAWS = ("brach", "kudlich-slibar")
RULES = ("friction", "impulse_ratio", "critical_fraction")
NEAR_JAMMING = "impulse_ratio near jamming"
# A contact with friction that ends before compression does; and one with impulses from outside.
INCOMPLETE, PUSHED = "friction, incomplete", "friction, pushed"
FAMILIES = (
    "traffic",
    "mass ratio 1e-12..1e12",
    "60 m/s +- 1e-9",
    "1e8 + 1e-6 m/s",
    "barrier",
    "levers 1e-9 or 1e9",
    "inertia x 1e-12..1e12",
    "map grid",
    "grazing",
    "A pinned",
    "B pinned",
    "both pinned",
)


# Two cars that several files of tests let collide: both moving and turning; at rest beside each
# other; in US units and without a motion; and unlike in all their numbers, with their tyres.
TURNING = (
    col.Vehicle(mass=1500.0, yaw_inertia=2400.0, vx=15.0, vy=2.0, yaw_rate=0.1, x=-2.0, y=0.4),
    col.Vehicle(mass=1200.0, yaw_inertia=1700.0, vy=9.0, x=2.0, y=-0.2),
)
BESIDE = (
    col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.0, y=0.0),
    col.Vehicle(mass=1300.0, yaw_inertia=2000.0, x=2.0, y=0.8),
)
IN_POUNDS = (
    col.Vehicle(
        mass="3400 lb", yaw_inertia="1770 slug*ft**2", x="-6.5 ft", y="1.3 ft", heading="0 deg"
    ),
    col.Vehicle(
        mass="2900 lb", yaw_inertia="1250 slug*ft**2", x="2.6 ft", y="-4 ft", heading="90 deg"
    ),
)
UNLIKE = (
    col.Vehicle(mass=1437.0, yaw_inertia=2311.0, vx=14.0, vy=1.0, x=-2.0, y=0.4, heading=0.1),
    col.Vehicle(mass=1213.0, yaw_inertia=1877.0, vy=6.0, x=2.0, y=0.0, heading=1.3),
)
WHEELS = {
    "duration": 0.1013,
    "tyres_a": Tyres(0.6713, (0.1719, 0.2317, 0.3137, 0.4179), 2.7139, 1.5317, steer=0.0917),
    "tyres_b": Tyres(0.5713, 1.0, 2.6319, 1.4731, height=0.5179),
}


def _decade(rng: random.Random, low: float, high: float) -> float:
    return 10.0 ** rng.uniform(low, high)


def _restitution(rng: random.Random) -> float:
    return rng.choice(
        (
            0.0,
            1.0,
            rng.random(),
            0.3 * rng.random(),
            _decade(rng, -12, -1),
            1.0 - _decade(rng, -12, -1),
        )
    )


def _value(rng: random.Random, rule: str) -> float:
    if rule == "friction":
        return rng.choice((0.0, math.inf, _decade(rng, -2.0, 0.5), rng.random()))
    if rule == "impulse_ratio":
        return rng.uniform(-0.6, 0.6)
    return rng.choice((0.0, 1.0, rng.random(), rng.random()))


def jamming_ratio(scene: Scene) -> float:
    """The impulse ratio -K_nn/K_nt at which the bodies jam; the normal impulse grows without bound
    towards it. NaN without one.
    """
    answer = evaluate(replace(scene, rule="friction", value=0.0))
    return float(-answer.k_nn / answer.k_nt) if not answer.refused and answer.k_nt else math.nan


def _car(rng: random.Random, x: float, y: float) -> Body:
    mass = rng.uniform(700.0, 3000.0)
    return Body(
        mass=mass,
        inertia=mass * rng.uniform(1.0, 1.8) ** 2,
        vx=rng.uniform(-30.0, 30.0),
        vy=rng.uniform(-30.0, 30.0),
        spin=rng.choice((0.0, rng.uniform(-3.0, 3.0))),
        x=x,
        y=y,
        heading=rng.uniform(-math.pi, math.pi),
    )


def draw(family: str, law: str, rule: str, rng: random.Random) -> Scene:
    """One scene of a family, closing along its normal; it may still be one that is refused for
    another reason.

    With ``NEAR_JAMMING`` as the rule four of five given ratios come up to 1e-9 of the one at which
    the bodies jam; the others are of the other sign and up to 1000.
    """
    if rule == NEAR_JAMMING:
        while math.isnan(limit := jamming_ratio(scene := draw(family, law, "impulse_ratio", rng))):
            pass
        near = limit * (1.0 - _decade(rng, -9, 0))
        return replace(
            scene, value=near if rng.random() < 0.8 else -math.copysign(_decade(rng, -2, 3), limit)
        )
    if rule == INCOMPLETE:
        return replace(
            draw(family, law, "friction", rng),
            restitution=-rng.choice((rng.random(), _decade(rng, -12, -1), 0.95)),
        )
    if rule == PUSHED:
        scene = draw(family, law, "friction", rng)
        # Of the size of the impulse that would stop one body at the contact: most of these do not
        # part the bodies before.
        speed = abs(_closing(scene))
        size = (
            min(mass for mass in (scene.a.mass, scene.b.mass, 1e300))
            * speed
            * 10.0 ** rng.uniform(-3.0, 0.0)
        )
        push = [tuple(size * rng.uniform(-1.0, 1.0) for _ in range(3)) for _ in range(2)]
        return replace(scene, outside=(push[0], push[1] if rng.random() < 0.7 else (0.0, 0.0, 0.0)))
    a = _car(rng, rng.uniform(-2.5, 2.5), rng.uniform(-2.5, 2.5))
    b = _car(rng, rng.uniform(-2.5, 2.5), rng.uniform(-2.5, 2.5))
    point = (rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5))
    angle = rng.uniform(-math.pi, math.pi)
    if family == "mass ratio 1e-12..1e12":
        factor = _decade(rng, -12, 12)
        b = replace(b, mass=a.mass * factor, inertia=a.inertia * factor * rng.uniform(0.5, 2.0))
    elif family == "60 m/s +- 1e-9":
        a = replace(
            a,
            vx=60.0 + rng.uniform(-1e-9, 1e-9),
            vy=rng.uniform(-1e-9, 1e-9),
            spin=rng.choice((0.0, 1e-9)),
        )
        b = replace(b, vx=60.0 + rng.uniform(-1e-9, 1e-9), vy=rng.uniform(-1e-9, 1e-9), spin=0.0)
    elif family == "1e8 + 1e-6 m/s":
        a = replace(
            a,
            vx=1e8 + rng.uniform(-1e-6, 1e-6),
            vy=1e8 * rng.choice((0.0, 1.0)) + rng.uniform(-1e-6, 1e-6),
            spin=0.0,
        )
        b = replace(b, vx=1e8, vy=a.vy + rng.uniform(-1e-6, 1e-6), spin=rng.choice((0.0, 1e-6)))
    elif family == "barrier":
        fixed = rng.choice(
            ((math.inf, math.inf), (math.inf, math.inf), (math.inf, b.inertia), (b.mass, math.inf))
        )
        still = dict.fromkeys(("vx", "vy", "spin"), 0.0) if rng.random() < 0.7 else {}
        b = replace(b, mass=fixed[0], inertia=fixed[1], **still)
        if rng.random() < 0.5:
            a, b = b, a
    elif family == "levers 1e-9 or 1e9":
        size_a, size_b = rng.choice(
            ((1e-9, 1.0), (1e9, 1.0), (1e-9, 1e9), (1e-9, 1e-9), (1e9, 1e9))
        )
        point = (0.0, 0.0)
        a = replace(
            a, x=a.x * size_a, y=a.y * size_a, spin=a.spin / size_a if size_a > 1.0 else a.spin
        )
        b = replace(
            b, x=b.x * size_b, y=b.y * size_b, spin=b.spin / size_b if size_b > 1.0 else b.spin
        )
    elif family == "inertia x 1e-12..1e12":
        a = replace(a, inertia=a.inertia * _decade(rng, -12, 12))
        b = replace(b, inertia=b.inertia * rng.choice((1.0, _decade(rng, -12, 12))))
    elif family == "map grid":
        east, north = 5e5 + rng.uniform(-1e4, 1e4), 5e6 + rng.uniform(-1e4, 1e4)
        a, b = (replace(body, x=body.x + east, y=body.y + north) for body in (a, b))
        point = (point[0] + east, point[1] + north)
    elif family == "grazing":
        # Turn the normal until the closing speed is a small part of the speed of the contact.
        ux = (b.vx - a.vx) - b.spin * (point[1] - b.y) + a.spin * (point[1] - a.y)
        uy = (b.vy - a.vy) + b.spin * (point[0] - b.x) - a.spin * (point[0] - a.x)
        angle = math.atan2(uy, ux) + math.pi / 2 + _decade(rng, -13, -1)
    else:
        for which in {"A pinned": "a", "B pinned": "b", "both pinned": "ab"}.get(family, ""):
            pin = (rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0))
            if which == "a":
                a = _pinned(a, pin)
            else:
                b = _pinned(b, pin)
    # An angle in half of the families, a vector of any length in the others.
    turned = math.remainder(angle + math.pi, math.tau)
    as_angle = FAMILIES.index(family) % 2 == 0
    size = _decade(rng, -3, 3)
    choices: list[Any] = (
        [angle, turned]
        if as_angle
        else [(size * math.cos(z), size * math.sin(z)) for z in (angle, turned)]
    )
    scene = Scene(a, b, _restitution(rng), choices[0], point, rule, _value(rng, rule), law)
    return scene if _closing(scene) > 0.0 else replace(scene, normal=choices[1])


def _pinned(body: Body, pin: tuple[float, float]) -> Body:
    return replace(
        body, pivot=pin, vx=-body.spin * (body.y - pin[1]), vy=body.spin * (body.x - pin[0])
    )


def _closing(scene: Scene) -> float:
    n = (
        scene.normal
        if isinstance(scene.normal, tuple)
        else (math.cos(scene.normal), math.sin(scene.normal))
    )
    total = 0.0
    for body, sign in ((scene.a, 1.0), (scene.b, -1.0)):
        center = body.pivot or (body.x, body.y)
        vx, vy = (0.0, 0.0) if body.pivot else (body.vx, body.vy)
        ux, uy = (
            vx - body.spin * (scene.point[1] - center[1]),
            vy + body.spin * (scene.point[0] - center[0]),
        )
        total += sign * (n[0] * ux + n[1] * uy)
    return total


def answerable(answer: Answer) -> bool:
    """Whether the reference answered, and not so near a singular contact that rounding decides
    about the refusal.

    Nor where what is promised of the impulse is more than a float can hold: an infinite promise is
    none.
    """
    if answer.refused or math.isinf(float(answer.spread)):
        return False
    trace = answer.k_nn + answer.k_tt - answer.a.a - answer.b.a
    return answer.k_nn > 4 * SINGULAR * trace and answer.det > 4 * SINGULAR * trace * trace


@cache
def cases(family: str, law: str, rule: str, count: int) -> list[tuple[Scene, Answer]]:
    """Answerable scenes of a family with their reference answers; the same ones in every run."""
    rng = random.Random(f"{family} {law} {rule}")
    found: list[tuple[Scene, Answer]] = []
    while len(found) < count:
        scene = draw(family, law, rule, rng)
        answer = evaluate(scene)
        if answerable(answer):
            found.append((scene, answer))
    return found


# --- From a scene to the package ------------------------------------------------------------------


def vehicle(body: Body, **changes: Any) -> col.Vehicle:
    """The Vehicle of a body."""
    given = {
        "mass": body.mass, "yaw_inertia": body.inertia, "vx": body.vx, "vy": body.vy,
        "yaw_rate": body.spin,
        "x": body.x, "y": body.y, "heading": body.heading, "pivot": body.pivot,
    }  # fmt: skip
    if body.pivot is not None:
        given["vx"] = given["vy"] = 0.0
    return col.Vehicle(**{**given, **changes})


def solved(model: str, scene: Scene, **changes: Any) -> col.Impact:
    """A scene put to one of the solvers; that the model gains energy is not what these tests are
    about.
    """
    solver = getattr(col, model)
    arguments: dict[str, Any] = {"normal": scene.normal}
    if model != "linear_central":
        arguments |= {scene.rule: scene.value, "law": scene.law}
    if model == "eccentric":
        arguments["point"] = scene.point
        if np.any(np.asarray(scene.outside) != 0.0):
            arguments |= {"outside_a": scene.outside[0], "outside_b": scene.outside[1]}
    if np.any(np.less(scene.restitution, 0.0)):
        arguments["incomplete"] = True
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.EnergyGainWarning)
        return solver(
            vehicle(scene.a), vehicle(scene.b), scene.restitution, **{**arguments, **changes}
        )


def solved_together(model: str, scenes: list[Scene]) -> col.Impact:
    """Scenes of one kind put to a solver as one batch, every input an array."""

    def column(values: Any) -> Any:
        values = list(values)
        if values[0] is None:
            return None
        if isinstance(values[0], tuple):
            return tuple(np.array(part) for part in zip(*values, strict=True))
        return np.array(values)

    def stacked(bodies: list[Body]) -> Body:
        return Body(
            **{
                name: column(getattr(body, name) for body in bodies)
                for name in Body.__dataclass_fields__
            }
        )

    whole = replace(
        scenes[0],
        a=stacked([scene.a for scene in scenes]),
        b=stacked([scene.b for scene in scenes]),
        **{
            name: column(getattr(scene, name) for scene in scenes)
            for name in ("restitution", "normal", "point", "value")
        },
        outside=tuple(column(scene.outside[k] for scene in scenes) for k in (0, 1)),
    )
    return solved(model, whole)


# --- Realistic scenes for hypothesis --------------------------------------------------------------
#
# Velocities are multiples of 1/64 m/s and positions of 1/32 m, so that shifts by other such
# multiples are exact and a test of invariance is about the solver and not about the rounding of its
# inputs.

SPEEDS = st.integers(-2560, 2560).map(lambda k: k / 64.0)
PLACES = st.integers(-96, 96).map(lambda k: k / 32.0)
SPINS = st.one_of(st.just(0.0), st.integers(-256, 256).map(lambda k: k / 64.0))
MASSES = st.floats(500.0, 40000.0)
GYRATION = st.floats(0.8, 2.5)
ANGLES = st.floats(-3.1, 3.1)
RESTITUTIONS = st.one_of(st.sampled_from((0.0, 1.0)), st.floats(0.0, 1.0), st.floats(0.0, 0.4))
VALUES = {
    "friction": st.one_of(st.sampled_from((0.0, math.inf)), st.floats(0.01, 2.0)),
    "impulse_ratio": st.floats(-0.5, 0.5),
    "critical_fraction": st.one_of(st.sampled_from((0.0, 1.0)), st.floats(0.01, 1.0)),
}
CONSTRAINTS = ("free", "A fixed", "B fixed", "A pinned", "B pinned")


@st.composite
def bodies(draw: Any, constraint: str = "free", turning: bool = True) -> Body:
    """A car, a fixed body at rest, or a car that can only turn about a pin."""
    mass = draw(MASSES)
    body = Body(
        mass=mass,
        inertia=mass * draw(GYRATION) ** 2,
        vx=draw(SPEEDS),
        vy=draw(SPEEDS),
        spin=draw(SPINS) if turning else 0.0,
        x=draw(PLACES),
        y=draw(PLACES),
        heading=draw(ANGLES),
    )
    if constraint == "fixed":
        return replace(body, mass=math.inf, inertia=math.inf, vx=0.0, vy=0.0, spin=0.0)
    return _pinned(body, (draw(PLACES), draw(PLACES))) if constraint == "pinned" else body


@st.composite
def impacts(
    draw: Any,
    constraint: str = "free",
    law: str = "brach",
    rule: str = "friction",
    value: float | None = None,
    turning: bool = True,
) -> Scene:
    """A closing scene. The normal is turned round where it would not close; what the law still
    refuses is left to the test.
    """
    which, _, kind = constraint.partition(" ")
    a = draw(bodies(kind if which == "A" else "free", turning))
    b = draw(bodies(kind if which == "B" else "free", turning))
    point = (draw(PLACES), draw(PLACES))
    angle = draw(ANGLES)
    found = draw(VALUES[rule]) if value is None else value
    scene = Scene(a, b, draw(RESTITUTIONS), angle, point, rule, found, law)
    if _closing(scene) <= 0.0:
        scene = replace(scene, normal=angle - math.copysign(math.pi, angle))
    if rule == "impulse_ratio" and value is None and draw(st.booleans()):
        limit = jamming_ratio(scene)
        # Beyond, products with a ratio leave the range of floats, and the answer is refused for
        # that.
        if abs(limit) < 1e6:
            return replace(scene, value=limit * (1.0 - 10.0 ** -draw(st.floats(0.0, 9.0))))
    return scene
