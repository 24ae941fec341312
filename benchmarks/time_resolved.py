"""A contact that takes time and has tyres, integrated, against the impulse that takes none: what ``left_out`` estimates.

``python benchmarks/time_resolved.py [file.json]`` prints a table, and writes it when a file is named. Two rigid bodies in the
plane push at each other for 0.1 s with a force of a given shape in time, that of a spring which unloads along a stiffer one, as
large as it takes for the contact points to part at restitution times closing speed; Coulomb friction along the contact, tyres
that slide on the ground. Nothing here but the first column and the estimates comes from the library. Nothing is timed. Nine
scenes are listed one by one; over seeded random ones only the ratio of estimate to integration is kept, once with a friction of
0.2 to 0.8 and once of 0 to 0.1.

The contact point is carried by the mean of the two places of the bodies that met, and the normal turns by the mean of the
rotations; with a fixed wall the point is the body's and the normal the wall's. What a contact that stays with one of the
bodies would give instead is listed too: it is not known for real vehicles.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

SOURCE = Path(__file__).resolve().parent.parent / "src"
if str(SOURCE) not in sys.path:
    sys.path.insert(0, str(SOURCE))

import collisions as col
from collisions.contact_effects import left_out

DURATION = 0.1
DRAG = 0.7
GRAVITY = 9.80665
STEPS = 500
# Below these speeds friction fades out, for the tyres and for the contact [m/s].
CREEP, CONTACT_CREEP = 0.01, 0.1
WHEELS = ((1.35, 0.75), (1.35, -0.75), (-1.35, 0.75), (-1.35, -0.75))


@dataclass(frozen=True)
class Scene:
    """An impact of two bodies, A and B by their numbers: mass, inertia, vx, vy, yaw rate, x, y, heading."""

    key: str
    name: str
    a: tuple[float, ...]
    b: tuple[float, ...]
    restitution: float
    normal: float
    point: tuple[float, float]
    friction: float

    def impact(self) -> col.Impact:
        """What the impulse solver answers."""
        names = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y", "heading")
        a, b = (col.Vehicle(**dict(zip(names, body, strict=True))) for body in (self.a, self.b))
        return col.eccentric(a, b, self.restitution, normal=self.normal, point=self.point, friction=self.friction)


def rear_end(speed: float) -> Scene:
    """Two equal cars in line, the front one at rest."""
    a = (1500.0, 2600.0, speed, 0.0, 0.0, -2.2, 0.0, 0.0)
    b = (1500.0, 2600.0, 0.0, 0.0, 0.0, 2.2, 0.0, 0.0)
    return Scene(f"rear_end_{speed:g}", f"rear-end, {speed:g} m/s", a, b, 0.4, 0.0, (0.0, 0.0), 0.5)


NORTH = math.pi / 2
WALL = (math.inf, math.inf, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
SCENES = (
    rear_end(2.0),
    rear_end(5.0),
    rear_end(10.0),
    rear_end(20.0),
    Scene(
        "t_bone",
        "T-bone, 20 m/s, the other at rest",
        (1500.0, 2600.0, 20.0, 0.0, 0.0, -2.2, 0.0, 0.0),
        (1200.0, 2100.0, 0.0, 0.0, 0.0, 0.8, -1.0, NORTH),
        0.1,
        0.0,
        (0.0, 0.0),
        0.5,
    ),
    Scene(
        "t_bone_crossing",
        "T-bone, 20 m/s, the other crosses at 10 m/s",
        (1500.0, 2600.0, 20.0, 0.0, 0.0, -2.2, 0.0, 0.0),
        (1200.0, 2100.0, 0.0, 10.0, 0.0, 0.8, -1.0, NORTH),
        0.1,
        0.0,
        (0.0, 0.0),
        0.5,
    ),
    Scene(
        "offset_frontal",
        "offset frontal, 15 m/s each",
        (1500.0, 2600.0, 15.0, 0.0, 0.0, -1.9, 0.5, 0.0),
        (1300.0, 2100.0, -15.0, 0.0, 0.0, 1.8, -0.5, math.pi),
        0.1,
        0.0,
        (0.0, 0.0),
        0.5,
    ),
    Scene(
        "sideswipe",
        "oblique sideswipe, 25 m/s against 20 m/s",
        (1500.0, 2600.0, 24.6, 4.3, 0.0, -1.2, -1.0, math.radians(10.0)),
        (1300.0, 2100.0, 20.0, 0.0, 0.0, 0.8, 1.0, 0.0),
        0.2,
        NORTH,
        (0.0, 0.0),
        0.4,
    ),
    Scene(
        "wall",
        "angled wall, 15 m/s",
        (1500.0, 2600.0, 15.0, 0.0, 0.0, -1.8, 0.4, 0.0),
        WALL,
        0.1,
        math.radians(30.0),
        (0.0, 0.0),
        0.4,
    ),
)


DRAWN, SEED = 150, 20240613
FRICTION, LITTLE_FRICTION = (0.2, 0.5, 0.8), (0.0, 0.05, 0.1)


def drawn(count: int = DRAWN, frictions: tuple[float, ...] = FRICTION) -> tuple[Scene, ...]:
    """Random impacts of two cars that do not spin before, close at 2 m/s and more, up to 28 m/s, and slide at up to 16 m/s."""
    rng = random.Random(SEED)
    found: list[Scene] = []
    while len(found) < count:
        normal = rng.uniform(-math.pi, math.pi)
        n = math.cos(normal), math.sin(normal)
        bodies = []
        for sign in (-1.0, 1.0):
            along, across = -sign * rng.uniform(0.0, 14.0), rng.uniform(-8.0, 8.0) * rng.choice([0.0, 0.3, 1.0])
            reach, lever = sign * rng.uniform(0.6, 2.2), rng.uniform(-1.0, 1.0) * rng.choice([0.3, 1.0])
            mass = rng.uniform(900.0, 2200.0)
            velocity, place = ((u * n[0] - v * n[1], u * n[1] + v * n[0]) for u, v in ((along, across), (reach, lever)))
            bodies.append((mass, mass * rng.uniform(1.2, 2.0), *velocity, 0.0, *place, rng.uniform(-math.pi, math.pi)))
        e, friction = rng.uniform(0.0, 0.4), rng.choice(frictions)
        scene = Scene(f"drawn_{len(found)}", "", *bodies, e, normal, (0.0, 0.0), friction)
        try:
            closes = scene.impact().closing_speed >= 2.0
        except col.NoImpactError:
            continue
        if closes:
            found.append(scene)
    return tuple(found)


@dataclass(frozen=True)
class Physics:
    """What the integration takes into account.

    ``tyres``: None, "centre" (all of the weight slides with the centre of mass) or "wheels" (a quarter at each).
    ``carrier``: None (the geometry stays as it was at first contact), "mean", "a" or "b".
    """

    tyres: str | None = None
    carrier: str | None = None
    pulse: str = "spring"


def force_shape(pulse: str, share: float, e: Any) -> Any:
    """Force at a share of the duration, over its mean."""
    if pulse == "square":
        return 1.0
    since_peak = share * (1.0 + e) - 1.0
    falling = np.clip(since_peak / np.where(e == 0.0, 1.0, e), 0.0, 1.0)
    return 0.5 * math.pi * np.cos(0.5 * math.pi * np.where(since_peak < 0.0, since_peak, falling))


class Contact:
    """Many scenes integrated side by side, each a case of the arrays."""

    def __init__(self, scenes: tuple[Scene, ...], physics: Physics, duration: float, drag: float) -> None:
        self.physics = physics
        self.duration = duration
        self.pull = drag * GRAVITY
        # (8, 2, scenes): numbers, body A or B, scene.
        bodies = np.array([[scene.a, scene.b] for scene in scenes]).transpose(2, 1, 0)
        mass, inertia, vx, vy, yaw, x, y, self.heading = bodies
        self.fixed = np.isinf(mass)
        self.per_mass, self.per_inertia = 1.0 / mass, 1.0 / inertia
        self.start = np.array([vx, vy, yaw, np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)])
        self.e, self.angle, self.mu = (
            np.array([getattr(s, name) for s in scenes]) for name in ("restitution", "normal", "friction")
        )
        point = np.array([scene.point for scene in scenes]).T
        self.arm_x, self.arm_y = point[0] - x, point[1] - y
        on_a = {"mean": 0.5, "a": 1.0, "b": 0.0}[physics.carrier or "mean"]
        # A wall keeps its normal, and what slides along it keeps its place of contact.
        self.point_on_a = np.where(self.fixed[1], 1.0, np.where(self.fixed[0], 0.0, on_a))
        self.normal_on_a = np.where(self.fixed[1], 0.0, np.where(self.fixed[0], 1.0, on_a))
        self.closing = -self.at_contact(self.start)[0]

    def geometry(self, state: Any) -> tuple[Any, ...]:
        """The levers of both bodies, and the normal, at a moment."""
        if self.physics.carrier is None:
            return self.arm_x, self.arm_y, np.cos(self.angle), np.sin(self.angle)
        dx, dy, turn = state[3:]
        c, s = np.cos(turn), np.sin(turn)
        # Where the place of each body that met at first is now, seen from where it was.
        now_x = dx + c * self.arm_x - s * self.arm_y - self.arm_x
        now_y = dy + s * self.arm_x + c * self.arm_y - self.arm_y
        point_x = self.point_on_a * now_x[0] + (1.0 - self.point_on_a) * now_x[1]
        point_y = self.point_on_a * now_y[0] + (1.0 - self.point_on_a) * now_y[1]
        angle = self.angle + self.normal_on_a * turn[0] + (1.0 - self.normal_on_a) * turn[1]
        return self.arm_x + point_x - dx, self.arm_y + point_y - dy, np.cos(angle), np.sin(angle)

    def at_contact(self, state: Any) -> tuple[Any, ...]:
        """Velocity of B relative to A along the normal and the tangent, and the geometry."""
        rx, ry, nx, ny = where = self.geometry(state)
        vx, vy, yaw = state[:3]
        ux, uy = vx - yaw * ry, vy + yaw * rx
        dx, dy = ux[1] - ux[0], uy[1] - uy[0]
        return nx * dx + ny * dy, nx * dy - ny * dx, *where

    def rates(self, share: float, state: Any, impulse: Any) -> Any:
        """How the state changes at a share of the duration."""
        _, slip, rx, ry, nx, ny = self.at_contact(state)
        push = impulse * (force_shape(self.physics.pulse, share, self.e) / self.duration)
        along = -self.mu * push * np.tanh(slip / CONTACT_CREEP)
        on_b_x, on_b_y = push * nx - along * ny, push * ny + along * nx
        fx, fy = np.array([-on_b_x, on_b_x]), np.array([-on_b_y, on_b_y])
        vx, vy, yaw = state[:3]
        ax, ay = self.per_mass * fx, self.per_mass * fy
        turning = self.per_inertia * (rx * fy - ry * fx)
        if self.physics.tyres is not None:
            heading = self.heading + state[5]
            c, s = np.cos(heading), np.sin(heading)
            places = ((0.0, 0.0),) if self.physics.tyres == "centre" else WHEELS
            with np.errstate(invalid="ignore"):
                for ahead, left in places:
                    wx, wy = c * ahead - s * left, s * ahead + c * left
                    ux, uy = vx - yaw * wy, vy + yaw * wx
                    speed = np.hypot(ux, uy)
                    hold = np.where(self.fixed, 0.0, -self.pull / len(places) * np.tanh(speed / CREEP))
                    hold = hold / np.where(speed == 0.0, 1.0, speed)
                    ax, ay = ax + hold * ux, ay + hold * uy
                    turning = turning + np.where(
                        self.fixed, 0.0, hold * (wx * uy - wy * ux) * (self.per_inertia / self.per_mass)
                    )
        return np.array([ax, ay, turning, vx, vy, yaw])

    def run(self, impulse: Any, steps: int) -> Any:
        """The state at the end, by Runge and Kutta's fourth order in fixed steps."""
        state, h = self.start, self.duration / steps
        self.engaged, engaging = state, np.ones(self.closing.shape, dtype=bool)
        for step in range(steps):
            engaging &= self.at_contact(state)[0] < 0.0
            self.engaged = np.where(engaging, state, self.engaged)
            share, half = step / steps, 0.5 / steps
            k1 = self.rates(share, state, impulse)
            k2 = self.rates(share + half, state + 0.5 * h * k1, impulse)
            k3 = self.rates(share + half, state + 0.5 * h * k2, impulse)
            k4 = self.rates(share + 2.0 * half, state + h * k3, impulse)
            state = state + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        return state

    def solve(self, steps: int) -> Any:
        """The state at the end for the impulse along the normal at which the contact parts at e times the closing speed."""

        def missed(impulse: Any) -> tuple[Any, Any]:
            state = self.run(impulse, steps)
            return self.at_contact(state)[0] - self.e * self.closing, state

        reduced = 1.0 / self.per_mass.sum(axis=0)
        older = 0.6 * (1.0 + self.e) * self.closing * reduced
        newer = older / 0.8
        off_older, _ = missed(older)
        off, state = missed(newer)
        for _ in range(30):
            if np.all(abs(off) < 1e-7 * self.closing):
                return state
            change = off - off_older
            slope = np.where(change == 0.0, 1.0 / reduced, change / np.where(newer == older, 1.0, newer - older))
            older, newer, off_older = newer, newer - off / slope, off
            off, state = missed(newer)
        raise ArithmeticError("no impulse was found that the contact parts at")


def delta_v(
    physics: Physics, scenes: tuple[Scene, ...] = SCENES, steps: int = STEPS, duration: float = DURATION, drag: float = DRAG
) -> Any:
    """Changes of velocity and yaw rate over the contact, of shape (x y yaw, A or B, scenes)."""
    contact = Contact(scenes, physics, duration, drag)
    return contact.solve(steps)[:3] - contact.start[:3]


def engaged(scenes: tuple[Scene, ...], steps: int = STEPS) -> tuple[Scene, ...]:
    """The scenes with the geometry of maximum engagement and the velocities of first contact."""
    contact = Contact(scenes, Physics(carrier="mean"), DURATION, DRAG)
    contact.solve(steps)
    rx, ry, nx, ny = contact.geometry(contact.engaged)
    found = []
    for case, scene in enumerate(scenes):
        bodies = []
        for side, body in enumerate((scene.a, scene.b)):
            dx, dy, turn = (float(part) for part in contact.engaged[3:, side, case])
            bodies.append((*body[:5], body[5] + dx, body[6] + dy, body[7] + turn))
        # A place of its own for each body would do; a wall does not move, so that the lever of A is where the point is.
        point = (bodies[0][5] + float(rx[0, case]), bodies[0][6] + float(ry[0, case]))
        normal = math.atan2(ny[case], nx[case])
        found.append(replace(scene, a=bodies[0], b=bodies[1], point=point, normal=normal))
    return tuple(found)


VARIANTS = {
    "fixed": Physics(),
    "tyres": Physics(tyres="centre"),
    "wheels": Physics(tyres="wheels"),
    "moving": Physics(carrier="mean"),
    "moving_with_a": Physics(carrier="a"),
    "moving_with_b": Physics(carrier="b"),
    "moving_square": Physics(carrier="mean", pulse="square"),
    "all": Physics(tyres="wheels", carrier="mean"),
}


def of_impacts(scenes: tuple[Scene, ...]) -> Any:
    """The same of the impulse solver."""
    names = ("delta_vx", "delta_vy", "delta_yaw_rate")
    impacts = [scene.impact() for scene in scenes]
    return np.array([[[getattr(getattr(impact, side), name) for impact in impacts] for side in "ab"] for name in names])


def measure(scenes: tuple[Scene, ...] = SCENES, steps: int = STEPS) -> dict[str, Any]:
    """Every scene: delta-V of the impulse, what each physics makes of it, and what ``left_out`` estimates of that."""
    impulse = of_impacts(scenes)
    found = {name: delta_v(physics, scenes, steps) for name, physics in VARIANTS.items()}
    found["engaged"] = of_impacts(engaged(scenes, steps))
    estimates = [left_out(scene.impact(), duration=DURATION, drag=DRAG) for scene in scenes]
    rows = []
    for case, scene in enumerate(scenes):
        for side, label in enumerate("ab"):
            size = float(np.hypot(*impulse[:2, side, case]))
            if size == 0.0:
                continue
            row: dict[str, Any] = {"scene": scene.key, "name": scene.name, "side": label, "delta_v": _rounded(size)}
            # The engaged geometry is to be near to what it stands for, the integration with moving geometry.
            for name, values in found.items():
                reference = found["moving"] if name == "engaged" else impulse
                dx, dy, turn = (values - reference)[:, side, case]
                row[name] = {
                    "delta_v": _rounded(math.hypot(dx, dy)),
                    "share": _rounded(math.hypot(dx, dy) / size),
                    "magnitude": _rounded(float(np.hypot(*values[:2, side, case])) / size - 1.0),
                    "delta_yaw_rate": _rounded(float(turn)),
                }
            estimate = getattr(estimates[case], label)
            names = ("tyre_delta_v_bound", "tyre_delta_v", "geometry_delta_v", "rotation")
            row["left_out"] = {name: _rounded(getattr(estimate, name)) for name in names}
            row["left_out"]["mutual_crush"] = _rounded(estimates[case].mutual_crush)
            rows.append(row)
    return {
        "duration": DURATION,
        "drag": DRAG,
        "steps": steps,
        "halving_the_step": _rounded(convergence(scenes, steps)),
        "frictions": {"drawn": list(FRICTION), "drawn_with_little_friction": list(LITTLE_FRICTION)},
        "drawn": estimates_of_drawn(),
        "drawn_with_little_friction": estimates_of_drawn(frictions=LITTLE_FRICTION),
        "rows": rows,
    }


# A change of delta-V that matters: of so much of it, and of so many m/s.
MATTERS, AT_LEAST = 0.02, 0.05
QUANTILES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)


def estimates_of_drawn(count: int = DRAWN, steps: int = 200, frictions: tuple[float, ...] = FRICTION) -> dict[str, Any]:
    """The ratio of what ``left_out`` estimates to what is integrated, over random impacts, where the change matters."""
    scenes = drawn(count, frictions)
    impulse = of_impacts(scenes)
    size = np.hypot(*impulse[:2])
    estimates = [left_out(scene.impact(), duration=DURATION, drag=DRAG) for scene in scenes]
    found: dict[str, Any] = {"impacts": count, "matters": MATTERS}
    for name, field in (("tyres", "tyre_delta_v"), ("moving", "geometry_delta_v")):
        moved = np.hypot(*(delta_v(VARIANTS[name], scenes, steps) - impulse)[:2])
        estimate = np.array([[getattr(getattr(one, side), field) for one in estimates] for side in "ab"])
        there = (moved > MATTERS * size) & (moved > AT_LEAST) & np.isfinite(estimate)
        ratio = estimate[there] / moved[there]
        found[name] = {
            "vehicles": int(there.sum()),
            "quantiles": [_rounded(float(np.quantile(ratio, at))) for at in QUANTILES],
            "outside_1.5": _rounded(float(np.mean((ratio > 1.5) | (ratio < 1.0 / 1.5)))),
            "no_estimate": int(np.isnan(estimate).sum()),
        }
    return found


def convergence(scenes: tuple[Scene, ...] = SCENES, steps: int = STEPS) -> float:
    """The most that half the step changes a delta-V, as a share of it, with all the physics."""
    once, twice = (delta_v(VARIANTS["all"], scenes, count) for count in (steps, 2 * steps))
    size = np.hypot(twice[0], twice[1])
    change = np.hypot(*(twice - once)[:2])
    return float(np.max(np.where(size > 0.0, change / np.where(size > 0.0, size, 1.0), 0.0)))


def _rounded(value: float) -> float:
    # The rounding of one platform is not that of another.
    return 0.0 if abs(value) < 1e-6 else float(f"{value:.3g}")


def table(found: dict[str, Any]) -> str:
    """What is measured, as a text: changes of delta-V in m/s, those of its magnitude in percent."""
    head = (
        "scene",
        "",
        "delta-V",
        "tyres",
        "wheels",
        "left_out",
        "bound",
        "moving",
        "with A",
        "with B",
        "left_out",
        "engaged",
        "magnitude",
    )
    lines = [f"{head[0]:<46}{head[1]:<2}" + "".join(f"{text:>10}" for text in head[2:])]
    for row in found["rows"]:
        estimate = row["left_out"]
        numbers = [
            row["delta_v"],
            *(row[name]["delta_v"] for name in ("tyres", "wheels")),
            *(estimate[name] for name in ("tyre_delta_v", "tyre_delta_v_bound")),
            *(row[name]["delta_v"] for name in ("moving", "moving_with_a", "moving_with_b")),
            estimate["geometry_delta_v"],
            row["engaged"]["delta_v"],
        ]
        text = "".join(f"{number:10.3f}" for number in numbers)
        lines.append(f"{row['name']:<46}{row['side']:<2}{text}{100.0 * row['moving']['magnitude']:9.1f}%")
    worst = max(row["fixed"]["share"] for row in found["rows"])
    lines.append(
        f"without tyres, with fixed geometry: within {worst:.1g} of the impulse; half the step: {found['halving_the_step']:.1g}"
    )
    for key, frictions in found["frictions"].items():
        for name in ("tyres", "moving"):
            spread = found[key][name]
            low, high = spread["quantiles"][1], spread["quantiles"][-2]
            lines.append(
                f"{found[key]['impacts']} random impacts, friction {frictions[0]:g} to {frictions[-1]:g}, {name}: estimate / "
                f"integrated {low:.2f} to {high:.2f} for 9 in 10 of {spread['vehicles']} vehicles, outside a factor of 1.5 "
                f"{100.0 * spread['outside_1.5']:.1f}%"
            )
    return "\n".join(lines)


def main() -> None:
    """Measure, print, and write the numbers where a file is named."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("file", nargs="?", type=Path, help="where to write the numbers as JSON")
    options = parser.parse_args()
    found = measure()
    print(table(found))
    if options.file is not None:
        options.file.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
