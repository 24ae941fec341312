"""Writes impacts.json: a thousand impacts with answers from the 60-digit reference of the tests.

``python vectors/make.py [file]``. It needs mpmath alone: nothing of the library is loaded. The
inputs are seeded, and multiples of a power of two wherever they are subtracted from one another
(velocities, positions), so that the differences are exact and every program that reads doubles is
asked the same question.
"""

from __future__ import annotations

import json
import math
import random
import sys
from collections.abc import Iterator
from dataclasses import replace
from decimal import ROUND_CEILING, Context
from pathlib import Path
from typing import Any

import mpmath

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tests"))

from reference import EPS, SINGULAR, Answer, Body, Scene, evaluate

FORMAT = 1
# The laws with the tangential rules that they take, and of each pair how many impacts of a kind.
PAIRS = [(law, rule) for law in ("brach", "kudlich-slibar")
         for rule in ("friction", "impulse_ratio", "critical_fraction")]  # fmt: skip
PAIRS.append(("stronge", "friction"))
COUNTS = {
    "linear_central": {"free": 85, "barrier": 20, "incomplete": 20},
    "oblique_central": {"free": 20, "barrier": 4, "incomplete": 4},
    "eccentric": {
        "free": 32, "barrier": 12, "A pinned": 8, "B pinned": 8, "both pinned": 4, "map grid": 4,
        "incomplete": 9, "pushed": 16, "pushed and pinned": 4,
    },
}  # fmt: skip
# A decision (regime, whether they close) is the same when its input is moved by this part.
CLEAR = 1e-6
# A number of the reference below this is its rounding.
ZERO = 1e-40


# --- Questions ---------------------------------------------------------------------------------


def step(rng: random.Random, most: float, size: float) -> float:
    """A multiple of ``size``, which is a power of two, from -most to most."""
    return rng.randint(-round(most / size), round(most / size)) * size


def car(rng: random.Random) -> Body:
    """A vehicle of 700 kg to 3 t, or in one of eight a lorry of up to 40 t."""
    mass = float(rng.randint(7000, 40000) if rng.random() < 0.125 else rng.randint(700, 3000))
    return Body(
        mass=mass,
        inertia=float(round(mass * rng.uniform(1.0, 1.8) ** 2)),
        vx=step(rng, 30.0, 1 / 8),
        vy=step(rng, 30.0, 1 / 8),
        spin=rng.choice((0.0, step(rng, 3.0, 1 / 16))),
        x=step(rng, 2.5, 1 / 16),
        y=step(rng, 2.5, 1 / 16),
        heading=round(rng.uniform(-math.pi, math.pi), 2),
    )


def held(rng: random.Random, body: Body) -> Body:
    """The body as something that cannot be moved, cannot be turned, or neither."""
    still = {"vx": 0.0, "vy": 0.0, "spin": 0.0} if rng.random() < 0.7 else {}
    choices = ((math.inf, math.inf), (math.inf, body.inertia), (body.mass, math.inf))
    mass, inertia = rng.choices(choices, (2, 1, 1))[0]
    return replace(body, mass=mass, inertia=inertia, **still)


def chosen(rng: random.Random, rule: str) -> float:
    """The value of a tangential rule."""
    if rule == "friction":
        return rng.choice((0.0, math.inf, *(round(rng.uniform(0.05, 1.2), 2) for _ in range(4))))
    if rule == "impulse_ratio":
        return round(rng.uniform(-0.6, 0.6), 2)
    return rng.choice((0.0, 1.0, *(round(rng.random(), 2) for _ in range(4))))


def draw(rng: random.Random, solver: str, law: str, rule: str, kind: str) -> Scene:
    """A scene of one kind, which may have no answer."""
    a, b = car(rng), car(rng)
    point = step(rng, 0.5, 1 / 16), step(rng, 0.5, 1 / 16)
    normal: Any = round(rng.uniform(-math.pi, math.pi), 3)
    if rng.random() < 0.25:
        normal = (float(rng.randint(-9, 9)), float(rng.choice((-3, -1, 1, 4))))
    value = chosen(rng, rule)
    restitution = rng.choice((0.0, 1.0, *(round(rng.uniform(0.01, 0.99), 2) for _ in range(6))))
    if kind == "incomplete":
        restitution = -round(rng.uniform(0.05, 0.95), 2)
    if solver != "eccentric":
        a, b = (replace(body, spin=0.0, x=0.0, y=0.0, inertia=math.inf) for body in (a, b))
        point = 0.0, 0.0
    if solver == "linear_central":
        a, b = (replace(body, vy=0.0) for body in (a, b))
        normal, value = (math.copysign(1.0, a.vx - b.vx), 0.0), 0.0
    if kind == "barrier":
        b = held(rng, b)
        b = b if solver == "eccentric" else replace(b, mass=math.inf)
        a, b = rng.choice(((a, b), (b, a)))
    pins = {
        "A pinned": "a",
        "B pinned": "b",
        "both pinned": "ab",
        "pushed and pinned": "b",
    }
    for side in pins.get(kind, ""):
        pin = step(rng, 3.0, 1 / 16), step(rng, 3.0, 1 / 16)
        if side == "a":
            a = replace(a, pivot=pin)
        else:
            b = replace(b, pivot=pin)
    if kind == "map grid":
        east, north = 5e5 + step(rng, 1e4, 1 / 16), 5e6 + step(rng, 1e4, 1 / 16)
        a, b = (replace(body, x=body.x + east, y=body.y + north) for body in (a, b))
        point = point[0] + east, point[1] + north
    outside = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if kind.startswith("pushed"):
        # About what tyres do in a contact of 0.1 s, and now and then a kerb.
        most = 0.1 * min(a.mass, b.mass) * rng.choice((3.0, 7.0, 20.0))
        pushes = [tuple(float(round(rng.uniform(-most, most))) for _ in range(3)) for _ in "ab"]
        outside = pushes[0], pushes[1] if rng.random() < 0.7 else outside[1]
    return Scene(a, b, restitution, normal, point, rule, value, law, outside)


def clear(scene: Scene, answer: Answer) -> bool:
    """Whether there is an answer, and none of its decisions hangs on the last digits."""
    if answer.refused or answer.closing < 1e-3 * answer.s_u:
        return False
    trace = answer.k_nn + answer.k_tt - answer.a.a - answer.b.a
    if answer.det <= 1e6 * SINGULAR * trace * trace or not math.isfinite(float(answer.spread)):
        return False
    near = [replace(scene, value=scene.value * (1 + part)) for part in (-CLEAR, CLEAR)]
    near.append(replace(scene, restitution=scene.restitution * (1 - CLEAR)))
    return all(regime(evaluate(other)) == regime(answer) for other in near)


def regime(answer: Answer) -> str:
    """The regime. A slip that the reference works out as 0 but for its rounding has stopped."""
    if answer.regime in ("sliding", "reversing") and abs(answer.slip_after) < ZERO:
        return "sticking"
    return answer.regime


def questions() -> Iterator[tuple[str, str, Scene, Answer]]:
    """Every impact with its solver, its kind, and its answer."""
    for solver, counts in COUNTS.items():
        for law, rule in PAIRS if solver != "linear_central" else [("brach", "friction")]:
            for kind, count in counts.items():
                rng, found = random.Random(f"{solver} {law} {rule} {kind}"), 0
                while found < count:
                    scene = draw(rng, solver, law, rule, kind)
                    answer = evaluate(scene)
                    if clear(scene, answer):
                        found += 1
                        yield solver, kind, scene, answer


# --- Accuracy: section "What is promised" of docs/numerical_stability.md -------------------------


def length(*parts: Any) -> float:
    """Length of a vector."""
    return math.hypot(*(float(part) for part in parts))


def planar(scene: Scene, answer: Answer) -> dict[str, float]:
    """What is promised of an answer of ``oblique_central`` and ``eccentric``, by its name."""
    spread = answer.spread
    moving = max(answer.s_u + answer.s_push, abs(answer.slip_after), abs(answer.separation))
    lost = abs(answer.loss_n) + abs(answer.loss_t) + spread * moving
    found = {
        "closing_speed": 4 * answer.s_u,
        "slip_before": 4 * answer.s_u,
        "impulse": 8 * spread,
        "energy_loss": 8 * lost,
    }
    for side, body, (jx, jy, yaw) in zip("ab", (scene.a, scene.b), scene.outside, strict=True):
        half = getattr(answer, side)
        push = length(jx, jy)
        spun = half.b * (half.r * spread + abs(yaw) + (half.arm * push if body.pivot else 0))
        moved = half.arm * spun if body.pivot else half.a * (spread + push)
        turned = math.pi / 2 + float(spread) / length(answer.pn, answer.pt)
        found |= {
            f"{side}.delta_v": 8 * moved,
            f"{side}.velocity": 8 * (half.speed + moved),
            f"{side}.delta_yaw_rate": 8 * spun,
            f"{side}.yaw_rate": 8 * (abs(body.spin) + spun),
            f"{side}.pdof": 8 * turned,
        }
        if body.pivot:
            lever = body.mass * half.arm * half.b
            size = length(half.pivot_x, half.pivot_y) + push * (2 + lever * half.arm)
            size += abs(yaw) * lever + (1 + lever * half.r) * spread
            found[f"{side}.pivot_impulse"] = 8 * size
    return {name: float(EPS * value) for name, value in found.items()}


def in_line(scene: Scene, answer: Answer) -> dict[str, float]:
    """What is promised of an answer of ``linear_central``, relative to the answer itself."""
    found = {"closing_speed": answer.closing, "impulse": 4 * answer.pn}
    found["energy_loss"] = 6 * abs(answer.loss) if abs(scene.restitution) < 1 else 0
    for side in "ab":
        half = getattr(answer, side)
        found |= {
            f"{side}.delta_v": 4 * abs(half.dvx),
            f"{side}.velocity": 5 * (half.speed + abs(half.dvx)),
            f"{side}.pdof": 8 * math.pi / 2,
        }
    return {name: float(EPS * value) for name, value in found.items()}


def promises(solver: str, scene: Scene, answer: Answer) -> dict[str, float]:
    """What is promised of every answer that this solver has, by its name."""
    if solver == "linear_central":
        return in_line(scene, answer)
    found = planar(scene, answer)
    turning = {f"{side}.{name}" for side in "ab" for name in ("delta_yaw_rate", "yaw_rate")}
    return (
        found
        if solver == "eccentric"
        else {name: found[name] for name in found if name not in turning}
    )


# --- Text ----------------------------------------------------------------------------------------


class Written(float):
    """A number that is written with the digits it was given."""

    def __new__(cls, text: str) -> Written:
        made = super().__new__(cls, text)
        made.text = text
        return made

    def __repr__(self) -> str:
        return self.text


def digits(value: Any) -> Written:
    """A number of the reference in 17 significant digits; what is 0 but for its rounding is 0."""
    shown = value if abs(value) > ZERO else mpmath.mpf(0)
    return Written(mpmath.nstr(shown, 17, min_fixed=-4, max_fixed=17))


def rounded_up(value: float) -> Written:
    """What is allowed, in two digits and not less."""
    upwards = Context(prec=2, rounding=ROUND_CEILING)
    return Written(f"{upwards.create_decimal_from_float(value):.1e}" if value else "0")


def plain(value: float) -> Any:
    """An input: whole numbers without a point, and "Infinity", as JSON has no number for it."""
    if math.isinf(value):
        return "Infinity"
    return int(value) if value == int(value) else value


def body(given: Body, solver: str) -> dict[str, Any]:
    """What a solver asks of a body."""
    found = {"mass": plain(given.mass)}
    if solver == "eccentric":
        found["yaw_inertia"] = plain(given.inertia)
    if given.pivot is None:
        found["vx"] = plain(given.vx)
        if solver != "linear_central":
            found["vy"] = plain(given.vy)
    if solver == "eccentric":
        found |= {
            "yaw_rate": plain(given.spin),
            "x": plain(given.x),
            "y": plain(given.y),
        }
    if given.pivot is not None:
        found["pivot"] = [plain(part) for part in given.pivot]
    return found | {"heading": plain(given.heading)}


def answers(answer: Answer, promised: dict[str, float]) -> dict[str, Any]:
    """Every answer that is promised, as a list: its numbers, and the error allowed."""
    values = {
        "closing_speed": (answer.closing,),
        "slip_before": (answer.slip,),
        "impulse": (answer.pn, answer.pt),
        "energy_loss": (answer.loss,),
    }
    for side in "ab":
        half = getattr(answer, side)
        values |= {
            f"{side}.delta_v": (half.dvx, half.dvy),
            f"{side}.velocity": (half.vx, half.vy),
            f"{side}.delta_yaw_rate": (half.dw,),
            f"{side}.yaw_rate": (half.w,),
            f"{side}.pdof": (half.pdof,),
            f"{side}.pivot_impulse": (half.pivot_x, half.pivot_y),
        }
    found: dict[str, Any] = {"regime": regime(answer), "a": {}, "b": {}}
    for name, numbers in values.items():
        if name in promised:
            side, _, inner = name.rpartition(".")
            owner = found[side] if side else found
            owner[inner] = [*map(digits, numbers), rounded_up(promised[name])]
    return found


def told(number: int, solver: str, kind: str, scene: Scene, answer: Answer) -> dict[str, Any]:
    """One impact as it is written."""
    given: dict[str, Any] = {
        "id": number, "kind": kind, "solver": solver, "a": body(scene.a, solver),
        "b": body(scene.b, solver), "restitution": plain(scene.restitution),
    }  # fmt: skip
    if scene.restitution < 0:
        given["incomplete"] = True
    normal = scene.normal
    turned = isinstance(normal, tuple)
    given["normal"] = [plain(part) for part in normal] if turned else plain(normal)
    if solver == "eccentric":
        given["point"] = [plain(part) for part in scene.point]
    if solver != "linear_central":
        given |= {scene.rule: plain(scene.value), "law": scene.law}
    for side, push in zip("ab", scene.outside, strict=True):
        if any(push):
            given[f"outside_{side}"] = [plain(part) for part in push]
    promised = promises(solver, scene, answer)
    return given | {"answer": answers(answer, promised)}


def text() -> str:
    """The whole file, an impact a line."""
    lines = [_json(told(number, *asked)) for number, asked in enumerate(questions(), 1)]
    return f'{{"format":{FORMAT},"impacts":[\n' + ",\n".join(lines) + "\n]}\n"


def _json(value: Any) -> str:
    """JSON without blanks, in which numbers of the reference keep their digits."""
    if isinstance(value, dict):
        return (
            "{"
            + ",".join(f"{json.dumps(name)}:{_json(part)}" for name, part in value.items())
            + "}"
        )
    if isinstance(value, list):
        return "[" + ",".join(map(_json, value)) + "]"
    return repr(value) if isinstance(value, Written) else json.dumps(value)


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "impacts.json"
    target.write_text(text(), encoding="utf-8", newline="\n")
