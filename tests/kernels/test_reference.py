"""The promises of section 5 of the numerics note, output by output, against a reference in 60
digits, over its extremes.

Every bound is the promise itself, in eps = 2^-52 of the scale the note names. One case is solved
alone (math) and in a batch (numpy).
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest

import collisions as col
from reference import EPS, Answer, Body, Scene, evaluate
from scenes import (
    FAMILIES,
    INCOMPLETE,
    LAWS,
    NEAR_JAMMING,
    PUSHED,
    RULES,
    answerable,
    cases,
    draw,
    solved,
    solved_together,
)

COUNT = 100
FLAT_COUNT = 40
GROUPS = [
    (family, law, rule)
    for family in FAMILIES
    for law in LAWS
    for rule in (*RULES, NEAR_JAMMING, INCOMPLETE, PUSHED)
]
GROUPS += [
    (family, "stronge", rule) for family in FAMILIES for rule in ("friction", INCOMPLETE, PUSHED)
]


def _slow_unless(every_run: bool) -> Any:
    return () if every_run else pytest.mark.slow


# Friction under "brach" in every family, and what is usual in traffic, are for every run; the rest
# is slow.
group = pytest.mark.parametrize(
    ("family", "law", "rule"),
    [
        pytest.param(
            *one,
            marks=_slow_unless(
                one[1:] == ("brach", "friction") or (one[0] == "traffic" and one[2] in RULES)
            ),
        )
        for one in GROUPS
    ],
)
rules = pytest.mark.parametrize(
    "rule", [pytest.param(rule, marks=_slow_unless(rule == "friction")) for rule in RULES]
)


def families(names: Sequence[str]) -> Any:
    """These families under each law, as is the rest of a group."""
    pairs = [
        pytest.param(name, law, marks=_slow_unless(name == "traffic" or law == "brach"))
        for name in names
        for law in LAWS
    ]
    return pytest.mark.parametrize(("family", "law"), pairs)


way = pytest.mark.parametrize("way", ["alone", "in a batch"])

_READ = (
    "closing_speed", "slip_before", "slip_after", "separation_speed", "normal_impulse",
    "tangential_impulse",
    "compression_impulse", "restitution_impulse", "effective_mass", "energy_loss",
    "momentum_residual", "common_velocity",
)  # fmt: skip
_READ_SIDE = (
    "delta_vx", "delta_vy", "delta_yaw_rate", "after.vx", "after.vy", "after.yaw_rate",
    "impulse_x", "impulse_y",
    "pivot_impulse_x", "pivot_impulse_y", "pdof",
)  # fmt: skip


def _followed(thing: Any, path: str) -> Any:
    for part in path.split("."):
        thing = getattr(thing, part)
    return thing


PATHS = (*_READ, *(f"{side}.{path}" for side in "ab" for path in _READ_SIDE))


def _outputs(impact: col.Impact) -> dict[str, Any]:
    """Every output a promise is about, as plain floats or lists of them."""
    found = {path: _followed(impact, path) for path in PATHS}
    return {
        path: value.tolist() if isinstance(value, np.ndarray) else value
        for path, value in found.items()
    }


@cache
def _answers(
    model: str, family: str, law: str, rule: str, way: str
) -> list[tuple[Scene, Answer, dict[str, float]]]:
    """Scenes of a family, the reference answers, and those of the package."""
    known = (
        cases(family, law, rule, COUNT)
        if model == "eccentric"
        else oblique_cases(family, law, rule)
    )
    if way == "alone":
        found = [_outputs(solved(model, scene)) for scene, _ in known]
    else:
        columns = _outputs(solved_together(model, [scene for scene, _ in known]))
        found = [{path: values[i] for path, values in columns.items()} for i in range(len(known))]
    return [(scene, answer, outputs) for (scene, answer), outputs in zip(known, found, strict=True)]


@cache
def oblique_cases(family: str, law: str, rule: str) -> list[tuple[Scene, Answer]]:
    """The scenes of a family as point masses: no spin, and contact where the centres of
    mass are.
    """

    def point_mass(body: Body) -> Body:
        return replace(body, spin=0.0, x=0.0, y=0.0, pivot=None)

    found = []
    for scene, _ in cases(family, law, rule, COUNT)[:FLAT_COUNT]:
        flat = replace(scene, a=point_mass(scene.a), b=point_mass(scene.b), point=(0.0, 0.0))
        answer = evaluate(flat)
        if answer.refused == "separating":
            turned = (
                tuple(-part for part in flat.normal)
                if isinstance(flat.normal, tuple)
                else flat.normal - math.pi
            )
            flat = replace(flat, normal=turned)
            answer = evaluate(flat)
        if not answer.refused:
            found.append((flat, answer))
    return found


# --- Measuring ------------------------------------------------------------------------------------


def apart(*pairs: tuple[float, Any]) -> float:
    """Length of the vector between outputs and reference values, subtracted in its digits; NaN
    counts as infinitely far.
    """
    if any(math.isnan(value) for value, _ in pairs):
        return math.inf
    return math.hypot(*(float(known - value) for value, known in pairs))


Measured = list[tuple[str, float, float]]  # output, error, what is promised


def check(
    answers: list[tuple[Scene, Answer, dict[str, float]]],
    measure: Callable[[Scene, Answer, dict[str, float]], Measured],
) -> None:
    """Fail with the worst case, how far it is beyond the promise, and the scene that gives it."""
    worst, story = 0.0, "nothing was measured"
    assert answers, story
    for scene, answer, outputs in answers:
        for output, error, promise in measure(scene, answer, outputs):
            if error > promise * worst:
                worst = float(error / promise) if promise else math.inf
                story = f"{output} is off by {worst:.3g} of what is promised: {scene}"
    assert worst <= 1.0, story


def closing_and_slip(scene: Scene, answer: Answer, outputs: dict[str, float]) -> Measured:
    """Closing speed and slip: 4 eps S_U; separation: the closing speed times e, and one rounding.

    Under "stronge" 8 eps kappa (S_U + S_J), what the impulse leaves of the speeds of the contact.
    """
    promise = 4 * EPS * float(answer.s_u)
    parting = promise + EPS * float(answer.closing)
    if scene.law == "stronge":
        parting = 8 * EPS * float(answer.kappa * (answer.s_u + answer.s_push))
    return [
        ("closing_speed", apart((outputs["closing_speed"], answer.closing)), promise),
        ("slip_before", apart((outputs["slip_before"], answer.slip)), promise),
        (
            "separation_speed",
            apart((outputs["separation_speed"], answer.separation)),
            parting,
        ),
    ]


def impulses(scene: Scene, answer: Answer, outputs: dict[str, float]) -> Measured:
    """The impulse and its two parts: 8 eps kappa S_P, the vector as a whole and in scene axes."""
    promise = 8 * EPS * float(answer.spread)
    found = [
        (
            "P",
            apart(
                (outputs["normal_impulse"], answer.pn), (outputs["tangential_impulse"], answer.pt)
            ),
            promise,
        ),
        ("Pc", apart((outputs["compression_impulse"], answer.compression)), promise),
        ("Pr", apart((outputs["restitution_impulse"], answer.pn - answer.compression)), promise),
    ]
    for side in "ab":
        half = getattr(answer, side)
        pairs = (
            (outputs[f"{side}.impulse_x"], half.impulse_x),
            (outputs[f"{side}.impulse_y"], half.impulse_y),
        )
        found.append((f"{side}.impulse", apart(*pairs), promise))
    return found


def velocities(scene: Scene, answer: Answer, outputs: dict[str, float]) -> Measured:
    """v' : 8 eps (|v| + a kappa S_P), w' : 8 eps (|w| + b |r| kappa S_P); for pinned bodies a is
    read as d b |r|.

    delta-V is v' of the body seen from a frame in which it stood before: the same promise without
    |v|.
    """
    found = []
    for side in "ab":
        half, body = getattr(answer, side), getattr(scene, side)
        jx, jy, yaw = scene.outside["ab".index(side)]
        spun = float(
            half.b
            * (
                half.r * answer.spread
                + abs(yaw)
                + (half.arm if body.pivot else 0) * math.hypot(jx, jy)
            )
        )
        moved = (
            float(half.arm) * spun
            if body.pivot
            else float(half.a * (answer.spread + math.hypot(jx, jy)))
        )
        dv = apart((outputs[f"{side}.delta_vx"], half.dvx), (outputs[f"{side}.delta_vy"], half.dvy))
        v = apart((outputs[f"{side}.after.vx"], half.vx), (outputs[f"{side}.after.vy"], half.vy))
        found += [
            (f"{side}.delta_v", dv, 8 * EPS * moved),
            (f"{side}.after.v", v, 8 * EPS * (float(half.speed) + moved)),
            (
                f"{side}.delta_yaw_rate",
                apart((outputs[f"{side}.delta_yaw_rate"], half.dw)),
                8 * EPS * spun,
            ),
            (
                f"{side}.after.yaw_rate",
                apart((outputs[f"{side}.after.yaw_rate"], half.w)),
                8 * EPS * (abs(body.spin) + spun),
            ),
        ]
    return found


def losses(scene: Scene, answer: Answer, outputs: dict[str, float]) -> Measured:
    """Energy loss, against the difference of the kinetic energies: 8 eps (|loss_n| + |loss_t| +
    kappa S_P max(S_U, |s'|)).

    The loss is -P.U - P.K P/2, so an error of P changes it by -U'.dP, and the contact parts with U'
    = (e g, s'). Near jamming the slip after is about kappa times S_U. The exact loss moves by more
    where the data move by one eps (benchmarks/stability.py).
    """
    moving = max(answer.s_u + answer.s_push, abs(answer.slip_after), abs(answer.separation))
    promise = 8 * EPS * float(abs(answer.loss_n) + abs(answer.loss_t) + answer.spread * moving)
    return [("energy_loss", apart((outputs["energy_loss"], answer.loss)), promise)]


def pivots(scene: Scene, answer: Answer, outputs: dict[str, float]) -> Measured:
    """Impulse of the pivot: 8 eps (|R| + (1 + m d b |r|) kappa S_P); exactly 0 without a pivot."""
    found = []
    for side in "ab":
        half, body = getattr(answer, side), getattr(scene, side)
        error = apart(
            (outputs[f"{side}.pivot_impulse_x"], half.pivot_x),
            (outputs[f"{side}.pivot_impulse_y"], half.pivot_y),
        )
        promise = 0.0
        if body.pivot:
            jx, jy, yaw = scene.outside["ab".index(side)]
            pushed = math.hypot(jx, jy) * float(2 + body.mass * half.arm**2 * half.b) + abs(
                yaw
            ) * float(body.mass * half.arm * half.b)
            size = math.hypot(half.pivot_x, half.pivot_y) + pushed
            promise = (
                8
                * EPS
                * (size + float((1 + body.mass * half.arm * half.b * half.r) * answer.spread))
            )
        found.append((f"{side}.pivot_impulse", error, promise))
    return found


def directions(scene: Scene, answer: Answer, outputs: dict[str, float]) -> Measured:
    """PDOF: 8 eps (pi/2 + kappa S_P / |P|) rad, counted the short way round."""
    promise = 8 * EPS * (math.pi / 2 + float(answer.spread) / math.hypot(answer.pn, answer.pt))
    whole_turn = 2 * answer.pn.context.pi
    found = []
    for side in "ab":
        turn = abs(getattr(answer, side).pdof - outputs[f"{side}.pdof"])
        error = float(min(turn, abs(whole_turn - turn)))
        found.append((f"{side}.pdof", math.inf if math.isnan(error) else error, promise))
    return found


def balances(scene: Scene, answer: Answer, outputs: dict[str, float]) -> Measured:
    """Sum of m dv: 4 eps |P|; sum of m (v' - v): 1 eps of its terms; angular momentum about c: 8
    eps of its terms.

    Summed here in fractions, so that only what the package returned is measured; over free finite
    bodies. A term of the angular momentum is |r| m |dv| or I |dw|: taken by components it would
    depend on how the scene axes lie.
    """
    size = math.hypot(outputs["normal_impulse"], outputs["tangential_impulse"])
    size += sum(math.hypot(jx, jy) for jx, jy, _ in scene.outside)
    found = [("momentum_residual", outputs["momentum_residual"], 4 * EPS * size)]
    bodies = [(side, getattr(scene, side)) for side in "ab"]
    if any(body.pivot is not None or math.isinf(body.mass) for _, body in bodies):
        return found
    left: dict[str, Fraction] = {name: Fraction(0) for name in ("dvx", "dvy", "vx", "vy", "turn")}
    speeds = turns = 0.0
    rotating = not any(math.isinf(body.inertia) for _, body in bodies)
    for side, body in bodies:
        mass = Fraction(body.mass)
        changes = {axis: Fraction(outputs[f"{side}.delta_v{axis}"]) for axis in "xy"}
        push = dict(
            zip(("x", "y", "yaw"), map(Fraction, scene.outside["ab".index(side)]), strict=True)
        )
        for axis in "xy":
            left[f"dv{axis}"] += mass * changes[axis] - push[axis]
            left[f"v{axis}"] -= push[axis]
            left[f"v{axis}"] += mass * (
                Fraction(outputs[f"{side}.after.v{axis}"]) - Fraction(getattr(body, f"v{axis}"))
            )
        ended = math.hypot(outputs[f"{side}.after.vx"], outputs[f"{side}.after.vy"])
        speeds += body.mass * (math.hypot(body.vx, body.vy) + ended)
        if rotating:
            lever_x, lever_y = body.x - scene.point[0], body.y - scene.point[1]
            spun = Fraction(body.inertia) * Fraction(outputs[f"{side}.delta_yaw_rate"])
            left["turn"] += (
                mass * (Fraction(lever_x) * changes["y"] - Fraction(lever_y) * changes["x"]) + spun
            )
            left["turn"] -= (
                Fraction(lever_x) * push["y"] - Fraction(lever_y) * push["x"] + push["yaw"]
            )
            turns += math.hypot(lever_x, lever_y) * body.mass * math.hypot(
                *map(float, changes.values())
            ) + abs(float(spun))
    found.append(("sum m dv", math.hypot(left["dvx"], left["dvy"]), 4 * EPS * size))
    found.append(("sum m (v' - v)", math.hypot(left["vx"], left["vy"]), EPS * speeds))
    if rotating:
        found.append(("angular momentum", abs(float(left["turn"])), 8 * EPS * turns))
    return found


PROMISES = [closing_and_slip, impulses, velocities, losses, pivots, directions, balances]
promised = pytest.mark.parametrize("measure", PROMISES, ids=lambda measure: measure.__name__)


@group
@way
@promised
def test_eccentric_keeps_its_promises(
    family: str, law: str, rule: str, way: str, measure: Any
) -> None:
    """Every output of the eccentric model is within its promise of the reference in every family,
    alone and in a batch.
    """
    check(_answers("eccentric", family, law, rule, way), measure)


@families(FAMILIES)
@way
def test_slip_after_is_exact_where_the_contact_sticks(family: str, law: str, way: str) -> None:
    """A sticking contact ends with a slip of exactly 0 ("brach") or exactly -e times the initial
    one ("kudlich-slibar").
    """
    kept = 0
    for scene, answer, outputs in _answers("eccentric", family, law, "friction", way):
        if answer.regime == "sticking" and math.isinf(scene.value):
            wanted = 0.0 if law == "brach" else -scene.restitution * outputs["slip_before"]
            assert outputs["slip_after"] == wanted, scene
            kept += 1
    assert kept > 0


FLAT_FAMILIES = [
    family
    for family in FAMILIES
    if "pinned" not in family and family not in ("levers 1e-9 or 1e9", "map grid")
]


@pytest.mark.slow
@families(FLAT_FAMILIES)
@rules
@way
def test_oblique_central_keeps_its_promises(family: str, law: str, rule: str, way: str) -> None:
    """The oblique central model is within the planar promises, whose kappa is 1 for bodies that do
    not turn.
    """
    answers = _answers("oblique_central", family, law, rule, way)
    for measure in PROMISES:
        check(answers, measure)


# --- The ends of the range ------------------------------------------------------------------------

# Powers of mass, length and speed of what an impact is worked out from and answers with: m, r, v, m
# v, m v^2, m r^2, w, 1/(m r), v/(m r).
PRODUCTS = (
    (1, 0, 0),
    (0, 1, 0),
    (0, 0, 1),
    (1, 0, 1),
    (1, 0, 2),
    (1, 2, 0),
    (0, -1, 1),
    (-1, -1, 0),
    (-1, -1, 1),
)


def in_other_units(scene: Scene, mass: float, length: float, speed: float) -> Scene:
    """The scene with its masses, lengths and speeds so many times as large."""

    def grown(body: Body) -> Body:
        return replace(
            body, mass=body.mass * mass, inertia=body.inertia * mass * length * length,
            vx=body.vx * speed, vy=body.vy * speed,
            spin=body.spin * speed / length, x=body.x * length, y=body.y * length,
        )  # fmt: skip

    return replace(
        scene,
        a=grown(scene.a),
        b=grown(scene.b),
        point=(scene.point[0] * length, scene.point[1] * length),
    )


def sized(rng: random.Random, rule: str, most: float) -> tuple[Scene, float]:
    """A scene of ordinary traffic in units drawn from 1e-most to 1e+most, and the decade of its
    largest or smallest product.
    """
    powers = [rng.uniform(-most, most) if rng.random() < 0.6 else 0.0 for _ in range(3)]
    decade = max(
        abs(sum(power * times for power, times in zip(powers, product, strict=True)))
        for product in PRODUCTS
    )
    scene = draw("traffic", rng.choice(LAWS), rule, rng)
    return in_other_units(scene, *(10.0**power for power in powers)), decade


# A bare yaw rate of 1e100 rad/s is suspected to be in degrees, rightly.
unsuspected = pytest.mark.filterwarnings("ignore::collisions.SuspectUnitsWarning")


@pytest.mark.slow
@unsuspected
@pytest.mark.parametrize("rule", RULES)
def test_the_promises_hold_over_the_range(rule: str) -> None:
    """While every product is within 1e-150 to 1e150; of the ten decades left, the scenes themselves
    span those.
    """
    rng = random.Random(f"range {rule}")
    found, widest = [], 0.0
    while len(found) < 150:
        scene, decade = sized(rng, rule, 140.0)
        answer = evaluate(scene) if decade <= 140.0 else None
        if answer is not None and answerable(answer):
            found.append((scene, answer, _outputs(solved("eccentric", scene))))
            widest = max(widest, decade)
    assert widest > 130.0
    for measure in PROMISES:
        check(found, measure)


@pytest.mark.slow
@unsuspected
@pytest.mark.parametrize("rule", RULES)
def test_what_overflows_is_refused(rule: str) -> None:
    """Beyond the range no answer holds an infinity or a NaN, but for the direction of no impulse;
    what underflows is not noticed.
    """
    rng = random.Random(f"overflow {rule}")
    refused = answered = 0
    for _ in range(400):
        scene, _ = sized(rng, rule, 300.0)
        sizes = [size for body in (scene.a, scene.b) for size in (body.mass, body.inertia)]
        others = [
            value
            for body in (scene.a, scene.b)
            for value in (body.vx, body.vy, body.spin, body.x, body.y)
        ]
        if min(sizes) == 0.0 or not all(map(math.isfinite, (*sizes, *others, *scene.point))):
            continue
        try:
            outputs = _outputs(solved("eccentric", scene))
        except col.CollisionsError as error:
            refused += error.code == "out_of_range"
            continue
        answered += 1
        for path, value in outputs.items():
            nothing = (
                path.endswith("pdof") and outputs["a.impulse_x"] == outputs["a.impulse_y"] == 0.0
            )
            assert math.isfinite(value) or nothing, (path, scene)
    assert refused > 20
    assert answered > 100


@pytest.mark.slow
def test_closing_is_decided_by_the_sign_that_is_computed() -> None:
    """Where the exact closing speed is beyond 4 eps S_U the decision is right; nearer than that it
    is sometimes the other one.
    """
    rng = random.Random("sign")
    wrong = 0
    for _ in range(400):
        scene = draw("grazing", "brach", "friction", rng)
        ux, uy = (scene.b.vx - scene.a.vx, scene.b.vy - scene.a.vy)
        a, b = replace(scene.a, spin=0.0), replace(scene.b, spin=0.0)
        angle = math.atan2(uy, ux) + math.pi / 2 + rng.uniform(-4.0, 4.0) * EPS
        scene = replace(scene, a=a, b=b, normal=angle, rule="friction", value=0.0)
        status = solved("eccentric", scene, on_failure="nan").status
        exact = evaluate(scene).closing
        closes = status.label not in ("separating", "grazing")
        if closes != (exact > 0):
            wrong += 1
            assert abs(exact) <= 4 * EPS * math.hypot(ux, uy), scene
    assert wrong > 0


# --- The linear model -----------------------------------------------------------------------------


@cache
def linear_cases() -> list[Scene]:
    """Bodies on the x axis over the families that a linear impact can have; half of them point the
    other way.

    The masses span 1e100, so their kinetic energies need 400 digits before their difference has
    any.
    """
    rng = random.Random("linear")
    found = []
    for i in range(600):
        kind = ("traffic", "mass ratio", "60 +- 1e-9", "1e8 + 1e-6", "barrier", "tiny", "huge")[
            i % 7
        ]
        mass_a, mass_b = rng.uniform(700.0, 3000.0), rng.uniform(700.0, 3000.0)
        va, vb = rng.uniform(-40.0, 40.0), rng.uniform(-40.0, 40.0)
        if kind == "mass ratio":
            mass_b = mass_a * 10.0 ** rng.uniform(-12, 12)
        elif kind == "60 +- 1e-9":
            va, vb = 60.0 + rng.uniform(0.0, 1e-9), 60.0 - rng.uniform(0.0, 1e-9)
        elif kind == "1e8 + 1e-6":
            va, vb = 1e8 + 1e-6 * rng.random(), 1e8 - 1e-6 * rng.random()
        elif kind == "barrier":
            mass_b, vb = math.inf, rng.choice((0.0, vb))
            if rng.random() < 0.5:
                mass_a, mass_b, va, vb = mass_b, mass_a, vb, va
        elif kind == "tiny":
            mass_a, va, vb = mass_a * 1e-100, va * 1e-50, vb * 1e-50
        elif kind == "huge":
            mass_a, va, vb = mass_a * 1e100, va * 1e20, vb * 1e20
        if va == vb:
            continue
        e = rng.choice(
            (
                0.0,
                1.0,
                rng.random(),
                10.0 ** rng.uniform(-12, -1),
                1.0 - 10.0 ** rng.uniform(-12, -1),
            )
        )
        normal = (1.0, 0.0) if va > vb else (-1.0, 0.0)
        a, b = Body(mass_a, math.inf, vx=va), Body(mass_b, math.inf, vx=vb)
        found.append(Scene(a, b, e, normal, (0.0, 0.0), "friction", 0.0, "brach"))
    return found


@way
def test_linear_central_keeps_its_promises(way: str) -> None:
    """Central dv, J, Jc, Jr and reduced mass 4 eps relative, loss 6, separation and closing 1, v' 5
    eps (|v| + |dv|).
    """
    scenes = linear_cases()
    if way == "alone":
        found = [_outputs(solved("linear_central", scene)) for scene in scenes]
    else:
        columns = _outputs(solved_together("linear_central", scenes))
        found = [{path: values[i] for path, values in columns.items()} for i in range(len(scenes))]

    def measure(scene: Scene, answer: Answer, outputs: dict[str, float]) -> Measured:
        whole = 1 + answer.pn.context.mpf(scene.restitution)
        relative = [
            ("closing_speed", answer.closing, 1),
            ("separation_speed", scene.restitution * answer.closing, 1),
            ("normal_impulse", answer.pn, 4),
            ("compression_impulse", answer.pn / whole, 4),
            ("restitution_impulse", scene.restitution * answer.pn / whole, 4),
            ("effective_mass", 1 / answer.k_nn, 4),
            ("energy_loss", answer.loss, 6),
            ("a.delta_vx", answer.a.dvx, 4),
            ("b.delta_vx", answer.b.dvx, 4),
        ]
        found = [
            (path, apart((outputs[path], known)), times * EPS * abs(float(known)))
            for path, known, times in relative
        ]
        # At e = 1 the loss is exactly 0, which is asked for below; the reference finds the rounding
        # of its 400 digits.
        found = [item for item in found if item[0] != "energy_loss" or scene.restitution != 1.0]
        for side in "ab":
            half = getattr(answer, side)
            error = apart(
                (outputs[f"{side}.after.vx"], half.vx), (outputs[f"{side}.after.vy"], half.vy)
            )
            found.append((f"{side}.after.v", error, 5 * EPS * float(half.speed + abs(half.dvx))))
        return found

    check(
        [
            (scene, evaluate(scene, 400), outputs)
            for scene, outputs in zip(scenes, found, strict=True)
        ],
        measure,
    )
    for scene, outputs in zip(scenes, found, strict=True):
        if scene.restitution == 1.0:
            assert outputs["energy_loss"] == 0.0, scene


# --- The switch between sticking and sliding ------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
def test_values_are_continuous_across_the_stick_slide_switch(law: str) -> None:
    """With the friction within 2 ulp of the critical ratio the label is anybody's, the values keep
    their promises.
    """
    rng = random.Random(f"switch {law}")
    found, labels = [], set()
    for scene, answer in cases("traffic", law, "friction", COUNT):
        if answer.no_slip is None or answer.no_slip[0] <= 0 or answer.no_slip[1] == 0:
            continue
        critical = float(abs(answer.critical))
        for _ in range(rng.randrange(3)):
            critical = math.nextafter(critical, rng.choice((0.0, math.inf)))
        edge = replace(scene, value=critical)
        impact = solved("eccentric", edge)
        known = evaluate(edge)
        labels.add((impact.regime, known.regime))
        found.append((edge, known, _outputs(impact)))
    assert len(found) > COUNT // 2
    assert len(labels) > 1
    for measure in (impulses, velocities, losses):
        check(found, measure)


# --- The reference itself -------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("law", LAWS)
def test_sixty_digits_are_enough(family: str, law: str) -> None:
    """The reference agrees with itself at 120 digits to 1e-6 of an eps, so its own rounding is not
    measured.
    """
    for rule in RULES:
        for scene, answer in cases(family, law, rule, COUNT)[:10]:
            better = evaluate(scene, 120)
            assert better.regime == answer.regime
            loss_scale = abs(better.loss_n) + abs(better.loss_t) + better.spread * better.s_u
            for got, wanted, scale in (
                (answer.pn, better.pn, better.spread),
                (answer.pt, better.pt, better.spread),
                (answer.loss, better.loss, loss_scale),
                (answer.a.dw, better.a.dw, better.a.b * better.a.r * better.spread),
            ):
                assert abs(got - wanted) <= 1e-6 * EPS * scale, scene


@families(FAMILIES)
@rules
def test_kelvin_gives_the_kinetic_energy_difference(family: str, law: str, rule: str) -> None:
    """In the reference eq 7 (energy before minus after) equals (1-e) g Pn/2 - Pt (s+s')/2, as
    section 1 says.
    """
    for scene, answer in cases(family, law, rule, COUNT)[:20]:
        scale = abs(answer.loss_n) + abs(answer.loss_t) + answer.spread * answer.s_u
        assert abs(answer.loss - (answer.loss_n + answer.loss_t)) <= 1e-6 * EPS * scale, scene
