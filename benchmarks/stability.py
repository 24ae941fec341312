"""Rounding errors of the textbook forms and of the library, measured against the reference
evaluation of the tests.

``python benchmarks/stability.py`` writes docs/_generated/stability.json and
docs/_static/stability_forms.svg. The textbook forms live only here. Cases are seeded, results are
rounded to two significant digits, and nothing is timed: the same machine writes the same files. The
scales and promises are those of tests/kernels/test_reference.py, which is imported for them.
"""

from __future__ import annotations

import json
import math
import random
import statistics
import sys
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
for folder in (ROOT / "src", ROOT / "tests"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

import collisions as col
from kernels import test_reference as asserted
from kernels import test_reference_in_time as in_time
from reference import EPS, Answer, Body, Scene, evaluate
from scenes import (
    FAMILIES,
    INCOMPLETE,
    LAWS,
    PUSHED,
    RULES,
    answerable,
    cases,
    draw,
    solved,
    solved_together,
)

DATA = ROOT / "docs" / "_generated" / "stability.json"
PLOT = ROOT / "docs" / "_static" / "stability_forms.svg"
COUNT = 60  # for every law and tangential option: 360 a regime
DIGITS = 100

# --- Regimes --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Regime:
    """A kind of impact: its key, what a reader calls it, and the families of tests/scenes.py it is
    made of, or its own.
    """

    key: str
    name: str
    families: tuple[str, ...]


REGIMES = (
    Regime("traffic", "ordinary traffic", ("traffic",)),
    Regime("masses", "mass ratio up to 1e24", ("mass ratio 1e24",)),
    Regime("slow", "60 m/s ± 1e-9 m/s", ("60 m/s +- 1e-9",)),
    Regime("fast", "1e8 m/s + 1e-6 m/s", ("1e8 + 1e-6 m/s",)),
    Regime("barrier", "fixed barrier", ("barrier",)),
    Regime("levers", "levers of 1e-9 m and 1e9 m", ("levers 1e-9 or 1e9",)),
    Regime("inertia", "inertia times 1e-12 to 1e12", ("inertia x 1e-12..1e12",)),
    Regime("grid", "positions on a map grid", ("map grid",)),
    Regime("grazing", "grazing", ("grazing",)),
    Regime("pivot", "pivots", ("A pinned", "B pinned", "both pinned")),
    Regime("percussion", "centre of percussion", ("percussion",)),
)


def _masses(law: str, rule: str, rng: random.Random) -> Scene:
    scene = draw("traffic", law, rule, rng)
    up = rng.choice((-1.0, 1.0))
    grown = [10.0 ** (up * sign * rng.uniform(0.0, 12.0)) for sign in (1.0, -1.0)]
    a, b = (
        replace(body, mass=body.mass * factor, inertia=body.inertia * factor)
        for body, factor in zip((scene.a, scene.b), grown, strict=True)
    )
    return replace(scene, a=a, b=b)


def _percussion(law: str, rule: str, rng: random.Random) -> Scene:
    """B turns about a pivot and is struck, without friction, where the pivot feels nothing."""
    scene = draw("traffic", law, rule, rng)
    pin = (rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0))
    along, distance = rng.uniform(-math.pi, math.pi), rng.uniform(0.5, 2.0)
    c, s = math.cos(along), math.sin(along)
    b = scene.b
    reach = distance + b.inertia / (b.mass * distance)
    x, y = pin[0] + distance * c, pin[1] + distance * s
    b = replace(b, x=x, y=y, pivot=pin, vx=-b.spin * (y - pin[1]), vy=b.spin * (x - pin[0]))
    normal = along + rng.choice((-1.0, 1.0)) * math.pi / 2
    return replace(
        scene, b=b, normal=normal, point=(pin[0] + reach * c, pin[1] + reach * s), value=0.0
    )


_OWN = {"mass ratio 1e24": _masses, "percussion": _percussion}


@cache
def known(family: str, law: str, rule: str, count: int = COUNT) -> list[tuple[Scene, Answer]]:
    """Seeded scenes of a family with their reference answers."""
    if family not in _OWN:
        return cases(family, law, rule, count)
    rng = random.Random(f"{family} {law} {rule}")
    found: list[tuple[Scene, Answer]] = []
    while len(found) < count:
        scene = _OWN[family](law, rule, rng)
        answer = evaluate(scene, DIGITS)
        if answerable(answer):
            found.append((scene, answer))
    return found


# --- The textbook forms ---------------------------------------------------------------------------


def textbook(scene: Scene) -> dict[str, float]:
    """The outputs of an impact as a textbook works them out, in double precision.

    Coordinates and velocities are turned into normal and tangent axes, then subtracted. The closing
    speed is n.u1 - n.u2. The impulse that stops the slip divides by K_nn K_tt - K_nt^2. The
    velocity of B follows from the momentum balance. Delta-V is v' - v. The energy loss is the
    difference of the kinetic energies (eq 7). The PDOF is an arc cosine.
    """
    with np.errstate(all="ignore"):
        return {path: float(value) for path, value in _textbook(scene).items()}


def _textbook(scene: Scene) -> dict[str, Any]:
    num = np.float64
    if isinstance(scene.normal, tuple):
        nx, ny = (
            num(part) / np.sqrt(num(scene.normal[0]) ** 2 + num(scene.normal[1]) ** 2)
            for part in scene.normal
        )
    else:
        nx, ny = np.cos(num(scene.normal)), np.sin(num(scene.normal))

    def turned(x: Any, y: Any) -> tuple[Any, Any]:
        return nx * x + ny * y, nx * y - ny * x

    e, value = num(scene.restitution), num(scene.value)
    point = turned(*map(num, scene.point))
    halves = []
    for body in (scene.a, scene.b):
        mass, inertia, w = num(body.mass), num(body.inertia), num(body.spin)
        pinned = body.pivot is not None
        hold = body.pivot or (body.x, body.y)
        place = turned(num(hold[0]), num(hold[1]))
        rn, rt = point[0] - place[0], point[1] - place[1]
        arm = num(body.x) - num(hold[0]), num(body.y) - num(hold[1])
        about = inertia + mass * (arm[0] ** 2 + arm[1] ** 2) if pinned else inertia
        v = (-w * arm[1], w * arm[0]) if pinned else (num(body.vx), num(body.vy))
        vn, vt = (num(0.0), num(0.0)) if pinned else turned(*v)
        u = vn - w * rt, vt + w * rn
        halves.append((mass, about, w, pinned, rn, rt, arm, v, u))
    (m_a, i_a, _, pin_a, rn_a, rt_a, _, v_a, u_a), (m_b, i_b, _, pin_b, rn_b, rt_b, _, v_b, u_b) = (
        halves
    )
    closing, slip = u_a[0] - u_b[0], u_b[1] - u_a[1]
    a = (num(0.0) if pin_a else 1 / m_a) + (num(0.0) if pin_b else 1 / m_b)
    k_nn = a + rt_a**2 / i_a + rt_b**2 / i_b
    k_tt = a + rn_a**2 / i_a + rn_b**2 / i_b
    k_nt = -rn_a * rt_a / i_a - rn_b * rt_b / i_b

    wanted_n, wanted_t = (1 + e) * closing, -(1 + e if scene.law == "kudlich-slibar" else 1) * slip
    det = k_nn * k_tt - k_nt**2
    ns, ts = (k_tt * wanted_n - k_nt * wanted_t) / det, (k_nn * wanted_t - k_nt * wanted_n) / det
    ratio = {"impulse_ratio": value, "critical_fraction": value * ts / ns if value else value}.get(
        scene.rule, num(0.0) if value == 0 else np.sign(ts) * value
    )
    if (
        scene.rule == "friction"
        and value > 0
        and ns > 0
        and (np.isinf(value) or abs(ts) <= value * ns)
    ):
        pn, pt = ns, ts
    else:
        pn = wanted_n / (k_nn + ratio * k_nt)
        pt = ratio * pn
    px, py = nx * pn - ny * pt, ny * pn + nx * pt

    found: dict[str, Any] = {
        "closing_speed": closing, "slip_before": slip, "normal_impulse": pn,
        "tangential_impulse": pt,
        "compression_impulse": pn / (1 + e), "restitution_impulse": e * pn / (1 + e),
    }  # fmt: skip
    after: list[Any] = []
    loss = num(0.0)
    ended_n = []
    for side, body, sign, (mass, about, w, pinned, rn, rt, arm, v, _) in zip(
        "ab", (scene.a, scene.b), (-1, 1), halves, strict=True
    ):
        ended_w = w + sign * (rn * pt - rt * pn) / about
        fx, fy = sign * px, sign * py
        if pinned:
            ended = -ended_w * arm[1], ended_w * arm[0]
        elif side == "b" and not pin_a:
            ended = tuple((m_a * v_a[i] + m_b * v_b[i] - m_a * after[0][i]) / m_b for i in (0, 1))
        else:
            ended = v[0] + fx / mass, v[1] + fy / mass
        after.append(ended)
        dvx, dvy = ended[0] - v[0], ended[1] - v[1]
        inertia = about if pinned else num(body.inertia)
        moving = num(0.0) if pinned else mass
        before_energy, after_energy = (
            (0 if pinned else moving * (x[0] ** 2 + x[1] ** 2) / 2) + inertia * spin**2 / 2
            for x, spin in ((v, w), (ended, ended_w))
        )
        loss = loss + before_energy - after_energy
        ended_n.append((num(0.0) if pinned else turned(*ended)[0]) - ended_w * rt)
        c, s = np.cos(num(body.heading)), np.sin(num(body.heading))
        ahead, aside = c * fx + s * fy, c * fy - s * fx
        bearing = np.arccos(np.clip(-ahead / np.sqrt(ahead**2 + aside**2), -1.0, 1.0))
        found |= {
            f"{side}.delta_vx": dvx, f"{side}.delta_vy": dvy, f"{side}.delta_yaw_rate": ended_w - w,
            f"{side}.after.vx": ended[0], f"{side}.after.vy": ended[1],
            f"{side}.after.yaw_rate": ended_w,
            f"{side}.impulse_x": fx, f"{side}.impulse_y": fy,
            f"{side}.pdof": -bearing if aside < 0 else bearing,
            f"{side}.pivot_impulse_x": mass * dvx - fx if pinned else num(0.0),
            f"{side}.pivot_impulse_y": mass * dvy - fy if pinned else num(0.0),
        }  # fmt: skip
    found |= {
        "energy_loss": loss,
        "separation_speed": ended_n[1] - ended_n[0],
        "momentum_residual": num(0.0),
    }
    return found


# --- What is measured -----------------------------------------------------------------------------


@dataclass(frozen=True)
class Promise:
    """A row of the promises: the output, the number of eps, the scale in words and symbols, and the
    names measured for it.
    """

    key: str
    output: str
    eps: int
    scale: str
    names: tuple[str, ...]


PROMISES = (
    Promise(
        "central P",
        "central: delta-V, impulse and its two parts, effective mass",
        4,
        "the value",
        (),
    ),
    Promise("central loss", "central: energy loss", 6, "the value", ()),
    Promise("central speeds", "central: closing speed, separation speed", 1, "the value", ()),
    Promise("central v", "central: velocity after", 5, "|v| + |Δv|", ()),
    Promise("closing", "closing speed, slip before", 4, "S_U", ("closing_speed", "slip_before")),
    Promise("P", "impulse and its two parts", 8, "κ S_P", ("P", "Pc", "Pr", "impulse")),
    Promise("delta-V", "delta-V", 8, "a κ S_P", ("delta_v",)),
    Promise("v", "velocity after", 8, "|v| + a κ S_P", ("after.v",)),
    Promise("dw", "change of the yaw rate", 8, "b |r| κ S_P", ("delta_yaw_rate",)),
    Promise("w", "yaw rate after", 8, "|ω| + b |r| κ S_P", ("after.yaw_rate",)),
    Promise(
        "loss", "energy loss", 8, "|loss_n| + |loss_t| + κ S_P max(S_U, |s'|)", ("energy_loss",)
    ),
    Promise("pivot", "impulse of a pivot", 8, "|R| + (1 + m d b |r|) κ S_P", ("pivot_impulse",)),
    Promise("pdof", "PDOF", 8, "π/2 + κ S_P / |P|, in rad", ("pdof",)),
    Promise("sum dv", "sum of m Δv", 4, "|P|", ("sum m dv", "momentum_residual")),
    Promise("sum v", "sum of m (v' - v)", 1, "sum of m (|v| + |v'|)", ("sum m (v' - v)",)),
    Promise(
        "turn",
        "angular momentum about the contact",
        8,
        "the sizes of its terms",
        ("angular momentum",),
    ),
)
OF_NAME = {name: promise for promise in PROMISES for name in promise.names}
# What the tables and the chart compare.
COMPARED = ("closing", "P", "stick", "delta-V", "v", "w", "loss", "pivot", "pdof")


def sizes(answer: Answer) -> dict[str, float]:
    """Sizes of the values whose plain relative error is of interest."""
    found = {"energy_loss": abs(float(answer.loss)), "P": math.hypot(answer.pn, answer.pt)}
    for side in "ab":
        half = getattr(answer, side)
        found |= {
            f"{side}.delta_v": math.hypot(half.dvx, half.dvy),
            f"{side}.after.yaw_rate": abs(float(half.w)),
        }
    return found


class Found(NamedTuple):
    """An error, the scale it is promised relative to, and the size of the value where a plain
    relative error is meaningful.
    """

    key: str
    error: float
    scale: float
    size: float | None


def measured(
    scene: Scene, answer: Answer, outputs: dict[str, float], balances: bool = True
) -> Iterator[Found]:
    """The errors of an answer. Errors and scales are those of the tests; a value far below its
    scale has no relative error.
    """
    size = sizes(answer)
    for measure in asserted.PROMISES:
        if measure is asserted.balances and not balances:
            continue
        for name, error, bound in measure(scene, answer, outputs):
            promise = OF_NAME.get(name.removeprefix("a.").removeprefix("b."))
            if promise is not None:
                scale = bound / (promise.eps * EPS)
                value = size.get(name, 0.0)
                yield Found(
                    promise.key, error, scale, value if value and value >= 0.01 * scale else None
                )


def in_eps(error: float, scale: float) -> float:
    """An error in eps of a scale; nothing of nothing is right."""
    if error == 0.0:
        return 0.0
    return error / scale / EPS if scale else math.inf


def rounded(value: float) -> float | None:
    """Two significant digits; None if there is none."""
    return float(f"{value:.1e}") if math.isfinite(value) else None


def answers(
    family: str, law: str, rule: str
) -> Iterator[tuple[Scene, Answer, list[dict[str, float]], dict[str, float]]]:
    """Scenes and reference answers, the library's outputs alone and in a batch, and the
    textbook's.
    """
    group = known(family, law, rule)
    together = asserted._outputs(solved_together("eccentric", [scene for scene, _ in group]))
    for index, (scene, answer) in enumerate(group):
        alone = asserted._outputs(solved("eccentric", scene))
        yield (
            scene,
            answer,
            [alone, {path: values[index] for path, values in together.items()}],
            textbook(scene),
        )


class Worst:
    """The worst errors so far, in eps of their scales and relative to the values, and how often
    there was no number at all.
    """

    def __init__(self) -> None:
        self.scaled: dict[str, float] = {}
        self.relative: dict[str, float] = {}
        self.missing: dict[str, int] = {}

    def note(self, found: list[Found], sticks: bool) -> None:
        """Take in the errors of one answer."""
        missing = set()
        for key, error, scale, size in found:
            for place in (key, "stick") if key == "P" and sticks else (key,):
                self.scaled.setdefault(place, 0.0)
                if not math.isfinite(error):
                    missing.add(place)
                    continue
                self.scaled[place] = max(self.scaled[place], in_eps(error, scale))
                if size is not None:
                    self.relative[place] = max(self.relative.get(place, 0.0), error / size)
        for place in missing:
            self.missing[place] = self.missing.get(place, 0) + 1


def regime(which: Regime) -> dict[str, Any]:
    """Worst errors of a regime."""
    ours, theirs = Worst(), Worst()
    count = 0
    for family in which.families:
        for law in LAWS:
            for rule in RULES:
                for scene, answer, library, book in answers(family, law, rule):
                    count += 1
                    sticks = answer.regime == "sticking"
                    for outputs in library:
                        ours.note(list(measured(scene, answer, outputs)), sticks)
                    theirs.note(list(measured(scene, answer, book, balances=False)), sticks)
    table = {}
    for key in COMPARED:
        if key not in ours.scaled or (key == "pivot" and which.key not in ("pivot", "percussion")):
            continue
        missing = theirs.missing.get(key, 0)
        table[key] = {
            # The worst number it gave; none if it never gave one.
            "textbook": None if missing == count else rounded(theirs.scaled[key]),
            "textbook_no_answer": rounded(missing / count),
            "library": math.inf if key in ours.missing else rounded(ours.scaled[key]),
        }
        if key in ("P", "delta-V", "loss"):
            table[key] |= {f"{who}_relative": rounded(
                worst.relative[key]) if key in worst.relative else None
                           for who, worst in (("textbook", theirs), ("library", ours))}  # fmt: skip
    return {
        "key": which.key,
        "name": which.name,
        "cases": count,
        "compared": table,
        "promised": {
            key: None if key in ours.missing else rounded(found)
            for key, found in ours.scaled.items()
        },
    }


def central() -> dict[str, float]:
    """Worst errors of linear_central over the cases of the tests, in eps of the scales of its
    promises.
    """
    scenes = asserted.linear_cases()
    together = asserted._outputs(solved_together("linear_central", scenes))
    worst = {promise.key: 0.0 for promise in PROMISES if promise.key.startswith("central")}

    def note(key: str, error: float, scale: float) -> None:
        worst[key] = max(worst[key], in_eps(error, scale))

    for index, scene in enumerate(scenes):
        answer = evaluate(scene, 400)
        whole = 1 + answer.pn.context.mpf(scene.restitution)
        alone = asserted._outputs(solved("linear_central", scene))
        for outputs in (alone, {path: values[index] for path, values in together.items()}):
            for key, path, exact in (
                ("central speeds", "closing_speed", answer.closing),
                ("central speeds", "separation_speed", scene.restitution * answer.closing),
                ("central P", "normal_impulse", answer.pn),
                ("central P", "compression_impulse", answer.pn / whole),
                ("central P", "restitution_impulse", scene.restitution * answer.pn / whole),
                ("central P", "effective_mass", 1 / answer.k_nn),
                ("central P", "a.delta_vx", answer.a.dvx),
                ("central P", "b.delta_vx", answer.b.dvx),
                ("central loss", "energy_loss", 0 if scene.restitution == 1.0 else answer.loss),
            ):
                note(key, asserted.apart((outputs[path], exact)), abs(float(exact)))
            for side in "ab":
                half = getattr(answer, side)
                error = asserted.apart(
                    (outputs[f"{side}.after.vx"], half.vx), (outputs[f"{side}.after.vy"], half.vy)
                )
                note("central v", error, float(half.speed + abs(half.dvx)))
    return {key: rounded(found) for key, found in worst.items()}


# --- What no algorithm can undo -------------------------------------------------------------------


def nudged(scene: Scene) -> Iterator[Scene]:
    """The scene with one of its data changed by one eps, for each of them. Levers and relative
    velocity are the data.
    """

    def beyond(value: float, size: float) -> float:
        return value + max(EPS * size, math.ulp(value))

    speed = math.hypot(scene.b.vx - scene.a.vx, scene.b.vy - scene.a.vy)
    for side in "ab":
        body = getattr(scene, side)
        changed = [
            replace(body, **{name: getattr(body, name) * (1 + EPS)})
            for name in ("mass", "inertia", "spin")
        ]
        hold = body.pivot or (body.x, body.y)
        lever = math.dist(hold, scene.point)
        for moved in ((beyond(hold[0], lever), hold[1]), (hold[0], beyond(hold[1], lever))):
            changed.append(
                replace(body, pivot=moved) if body.pivot else replace(body, x=moved[0], y=moved[1])
            )
        if not body.pivot:
            changed += [
                replace(body, vx=beyond(body.vx, speed)),
                replace(body, vy=beyond(body.vy, speed)),
            ]
        yield from (replace(scene, **{side: other}) for other in changed)
    yield replace(scene, normal=beyond(scene.normal, 1.0))
    yield replace(scene, restitution=scene.restitution * (1 - EPS))
    if scene.rule == "impulse_ratio":
        yield replace(scene, value=scene.value * (1 + EPS))


def _grazing(rng: random.Random, part: float) -> Scene:
    scene = draw("traffic", "brach", "friction", rng)
    a, b = replace(scene.a, spin=0.0), replace(scene.b, spin=0.0)
    angle = math.atan2(b.vy - a.vy, b.vx - a.vx) + math.pi / 2 + part
    return replace(scene, a=a, b=b, normal=angle, value=0.0)


def _near_its_limit(rng: random.Random, part: float) -> Scene:
    while True:
        scene = replace(draw("traffic", "brach", "impulse_ratio", rng), value=0.0)
        answer = evaluate(scene)
        if not answer.refused and abs(answer.k_nn) < 3 * abs(answer.k_nt):
            return replace(scene, value=float(-answer.k_nn / answer.k_nt) * (1.0 - part))


def _parallel(rng: random.Random, part: float) -> Scene:
    """Two bodies on pivots whose levers are almost parallel, with a contact that never slips."""
    while True:
        scene = draw("both pinned", "brach", "friction", rng)
        along, size = rng.uniform(-math.pi, math.pi), rng.uniform(1.0, 3.0)
        pins = [
            (scene.point[0] - length * math.cos(angle), scene.point[1] - length * math.sin(angle))
            for length, angle in ((size, along), (rng.uniform(1.0, 3.0), along + part))
        ]
        a, b = (
            replace(body, pivot=pin) for body, pin in zip((scene.a, scene.b), pins, strict=True)
        )
        spins = rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0)
        scene = replace(
            scene, a=replace(a, spin=spins[0]), b=replace(b, spin=spins[1]), value=math.inf
        )
        scene = replace(scene, normal=rng.uniform(-math.pi, math.pi))
        if evaluate(scene).regime == "sticking":
            return scene


# Of the library and of the exact answer, and the measure of the tests whose first entry has its
# promise.
_IMPULSE = (("normal_impulse", "pn"), ("tangential_impulse", "pt")), asserted.impulses
_LOSS = (("energy_loss", "loss"),), asserted.losses
CONDITIONS = (
    (
        "kappa_g",
        "grazing: closing speed against speed of the contact",
        _grazing,
        lambda k: k.s_u / k.closing,
        _IMPULSE,
    ),
    (
        "kappa_mu",
        "given impulse ratio near the limit where bodies jam",
        _near_its_limit,
        lambda k: k.kappa_mu,
        _IMPULSE,
    ),
    ("kappa_mu loss", "the energy loss of the same", _near_its_limit, lambda k: k.kappa_mu, _LOSS),
    (
        "kappa_s",
        "sticking contact of two pivots with almost parallel levers",
        _parallel,
        lambda k: k.kappa_s,
        _IMPULSE,
    ),
)


def conditions(count: int = 40) -> list[dict[str, Any]]:
    """For growing condition numbers: the error of the library's answer, and what one eps in the
    data does to the exact one.
    """
    found = []
    for key, name, make, kappa, (pairs, promise) in CONDITIONS:
        rows = []
        for decade in (0, 2, 4, 6, 8, 10, 12):
            rng = random.Random(f"{key.split()[0]} {decade}")
            kappas, ours, exact, promises, ratio = [], 0.0, 0.0, 0.0, 0.0
            while len(kappas) < count:
                scene = make(rng, 0.5 * 10.0**-decade)
                answer = evaluate(scene, DIGITS)
                if not answerable(answer):
                    continue
                kappas.append(float(kappa(answer)))
                size = math.hypot(*(getattr(answer, exact) for _, exact in pairs))
                outputs = asserted._outputs(solved("eccentric", scene))
                error = asserted.apart(
                    *((outputs[path], getattr(answer, exact)) for path, exact in pairs)
                )
                ours = max(ours, error / size)
                promises = max(promises, promise(scene, answer, outputs)[0][2] / EPS / size)
                moved = 0.0
                for other in nudged(scene):
                    there = evaluate(other, DIGITS)
                    if not there.refused:
                        moved += math.hypot(
                            *(getattr(there, exact) - getattr(answer, exact) for _, exact in pairs)
                        )
                exact = max(exact, moved / size)
                ratio = max(ratio, error / moved)
            rows.append(
                {
                    "kappa": rounded(statistics.median(kappas)),
                    "library": rounded(ours / EPS),
                    "one_eps": rounded(exact / EPS),
                    "promise": rounded(promises),
                    "library_over_one_eps": rounded(ratio),
                }
            )
        found.append({"key": key, "name": name, "rows": rows})
    return found


def grid() -> dict[str, Any]:
    """What rounding positions to a map grid does to the exact answer, and what the library adds."""
    moved, added, plain = 0.0, 0.0, 0.0
    for law in LAWS:
        for scene, answer in known("traffic", law, "friction"):
            shifted = replace(
                scene,
                a=replace(scene.a, x=scene.a.x + 5e5, y=scene.a.y + 5e6),
                b=replace(scene.b, x=scene.b.x + 5e5, y=scene.b.y + 5e6),
                point=(scene.point[0] + 5e5, scene.point[1] + 5e6),
            )
            there = evaluate(shifted)
            if there.refused or there.regime != answer.regime:
                continue
            change = math.hypot(there.pn - answer.pn, there.pt - answer.pt)
            moved = max(moved, change / float(answer.spread) / EPS)
            plain = max(plain, change / math.hypot(answer.pn, answer.pt))
            impact = solved("eccentric", shifted)
            error = asserted.apart(
                (impact.normal_impulse, there.pn), (impact.tangential_impulse, there.pt)
            )
            added = max(added, error / float(there.spread) / EPS)
    return {
        "ulp": rounded(math.ulp(5e6)),
        "ulp_in_eps_of_1_m": rounded(math.ulp(5e6) / EPS),
        "ulp_float32": float(np.spacing(np.float32(5e6))),
        "exact_change": rounded(moved),
        "exact_change_relative": rounded(plain),
        "library": rounded(added),
    }


# --- float32 --------------------------------------------------------------------------------------


FLOAT32 = ("P", "delta-V", "loss", "w")


def _single(scene: Scene) -> Scene:
    def short(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(short, value))
        return float(np.float32(value)) if isinstance(value, float) else value

    bodies = (
        Body(**{f.name: short(getattr(body, f.name)) for f in fields(Body)})
        for body in (scene.a, scene.b)
    )
    return Scene(*bodies, *(short(getattr(scene, f.name)) for f in fields(Scene)[2:]))


def float32() -> dict[str, Any]:
    """Batches of float32 in ordinary traffic, against the exact answer for the float32 inputs."""
    eps = float(np.finfo(np.float32).eps)
    scaled: dict[str, float] = {}
    plain: dict[str, list[float]] = {}
    labels = count = 0

    def batch(scenes: list[Scene]) -> col.Impact:
        def column(values: Any) -> Any:
            values = list(values)
            if values[0] is None:
                return None
            if isinstance(values[0], tuple):
                return tuple(column(part) for part in zip(*values, strict=True))
            return np.array(values, dtype=np.float32)

        bodies = [
            Body(
                **{
                    f.name: column(getattr(getattr(scene, side), f.name) for scene in scenes)
                    for f in fields(Body)
                }
            )
            for side in "ab"
        ]
        rest = {
            name: column(getattr(scene, name) for scene in scenes)
            for name in ("restitution", "normal", "point", "value")
        }
        return solved("eccentric", replace(scenes[0], a=bodies[0], b=bodies[1], **rest))

    for law in LAWS:
        for rule in RULES:
            group = []
            for scene, _ in known("traffic", law, rule):
                short = _single(scene)
                answer = evaluate(short)
                if answerable(answer):
                    group.append((short, answer))
            impact = batch([scene for scene, _ in group])
            assert impact.normal_impulse.dtype == np.float32
            columns = asserted._outputs(impact)
            for index, (scene, answer) in enumerate(group):
                count += 1
                labels += impact.regime[index] != answer.regime
                outputs = {path: values[index] for path, values in columns.items()}
                for key, error, scale, _ in measured(scene, answer, outputs):
                    if key in FLOAT32:
                        scaled[key] = max(
                            scaled.get(key, 0.0), error / scale / eps if error else 0.0
                        )
                size = sizes(answer)
                for measure in (asserted.impulses, asserted.velocities, asserted.losses):
                    for name, error, _ in measure(scene, answer, outputs):
                        # A loss of nothing is only 60 digits near to nothing in the reference.
                        if size.get(name, 0.0) > 1e-30 * size["P"]:
                            key = OF_NAME[name.removeprefix("a.").removeprefix("b.")].key
                            plain.setdefault(key, []).append(error / size[name])
    return {
        "eps": rounded(eps),
        "cases": count,
        "other_regime": int(labels),
        "outputs": [
            {
                "key": key,
                "worst_in_eps": rounded(scaled[key]),
                "median_relative": rounded(statistics.median(plain[key])),
                "p99_relative": rounded(float(np.quantile(plain[key], 0.99))),
                "worst_relative": rounded(max(plain[key])),
            }
            for key in FLOAT32
        ],
    }


# --- Beyond the first laws ------------------------------------------------------------------------

LATER = {
    'law="stronge"': [("stronge", "friction")],
    "incomplete": [(law, INCOMPLETE) for law in (*LAWS, "stronge")],
    "impulses from outside": [(law, PUSHED) for law in (*LAWS, "stronge")],
}


def later() -> list[dict[str, Any]]:
    """Worst errors of what came after the first laws, over all families, in eps of the scales of
    the promises.
    """
    found = []
    for name, kinds in LATER.items():
        worst, count = Worst(), 0
        for family in FAMILIES:
            for law, rule in kinds:
                for scene, answer, library, _ in answers(family, law, rule):
                    count += 1
                    for outputs in library:
                        worst.note(list(measured(scene, answer, outputs)), sticks=False)
        seen = {
            key: None if key in worst.missing else rounded(error)
            for key, error in worst.scaled.items()
        }
        found.append({"name": name, "cases": count, "seen": seen})
    return found


def steps() -> dict[str, Any]:
    """The rounding of ``time_resolved`` against its steps in 40 digits, by family."""
    rows = []
    for family in in_time.FAMILIES:
        worst: dict[str, float] = {}
        for moves in (False, True):
            for scene, duration, drag, followed in in_time.contacts(family, moves):
                one = in_time.alone(scene, duration, drag, moves)
                for name, error in in_time.errors(scene, followed, partial(in_time.output, one)):
                    worst[name] = max(worst.get(name, 0.0), error)
        rows.append(
            {"family": family, "seen": {name: rounded(error) for name, error in worst.items()}}
        )
    return {
        "steps": in_time.STEPS,
        "cases": 2 * in_time.COUNT,
        "promises": in_time.PROMISES,
        "rows": rows,
    }


# --- Everything -----------------------------------------------------------------------------------


def measure() -> dict[str, Any]:
    """All that the page shows."""
    regimes = [regime(which) for which in REGIMES]
    seen = central()
    for found in regimes:
        for key, worst in found["promised"].items():
            if key == "stick":
                continue
            seen[key] = max(seen.get(key, 0.0), math.inf if worst is None else worst)
    return {
        "eps": EPS,
        "regimes": regimes,
        "promises": [
            {
                "key": p.key,
                "output": p.output,
                "eps": p.eps,
                "scale": p.scale,
                "seen": rounded(seen[p.key]),
            }
            for p in PROMISES
        ],
        "conditions": conditions(),
        "grid": grid(),
        "float32": float32(),
        "later": later(),
        "in_time": steps(),
    }


def main() -> None:
    """Measure, write the numbers, draw the chart."""
    from stability_tables import draw_forms

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        found = measure()
    DATA.parent.mkdir(exist_ok=True)
    DATA.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    draw_forms(found, PLOT)
    print(f"wrote {DATA.relative_to(ROOT)} and {PLOT.relative_to(ROOT)}")
    for promise in found["promises"]:
        if promise["seen"] is None or promise["seen"] > promise["eps"]:
            sys.exit(f"not kept: {promise}")
    bounds = {promise["key"]: promise["eps"] for promise in found["promises"]}
    for row in found["later"]:
        for key, error in row["seen"].items():
            if error is None or error > bounds[key]:
                sys.exit(f"not kept: {key} of {row['name']}")


if __name__ == "__main__":
    main()
