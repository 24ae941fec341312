"""What an impulse leaves out, by ``time_resolved``; and how near ``left_out`` comes to it, which
estimates the same.

``python benchmarks/time_resolved.py [file.json]`` prints a table, and writes it when a file is
named. Contacts of 0.1 s with locked wheels at 0.7 are followed with tyres, with moving places, with
both and with neither; nothing is timed. Nine scenes are listed one by one; over seeded random ones
only the ratio of the estimate to the change is kept, once with a friction of 0.2 to 0.8 and once of
0 to 0.1. What the steps err by is tested against closed forms and an independent integration.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

SOURCE = Path(__file__).resolve().parent.parent / "src"
if str(SOURCE) not in sys.path:
    sys.path.insert(0, str(SOURCE))

import collisions as col

DURATION = 0.1
DRAG = 0.7
STEPS = 200
NAMES = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y", "heading")
# "tyres" slide with the centre of mass, as left_out has them, "wheels" each by itself.
VARIANTS: dict[str, dict[str, Any]] = {
    "fixed": {"geometry": "fixed"},
    "tyres": {"geometry": "fixed", "drag": DRAG},
    "wheels": {"geometry": "fixed", "drag": DRAG},
    "moving": {"geometry": "first_contact"},
    "engaged": {"geometry": "maximum_engagement"},
    "all": {"geometry": "first_contact", "drag": DRAG},
}


@dataclass(frozen=True)
class Scene:
    """An impact of two bodies, A and B by their numbers: mass, inertia, vx, vy, yaw rate, x, y,
    heading.
    """

    key: str
    name: str
    a: tuple[float, ...]
    b: tuple[float, ...]
    restitution: float
    normal: float
    point: tuple[float, float]
    friction: float

    def vehicles(self, **changes: Any) -> list[col.Vehicle]:
        """Both bodies."""
        return [
            col.Vehicle(**dict(zip(NAMES, body, strict=True)) | changes)
            for body in (self.a, self.b)
        ]

    def impact(self, **options: Any) -> col.Impact:
        """What the impulse solver answers."""
        contact = {"normal": self.normal, "point": self.point, "friction": self.friction, **options}
        return col.eccentric(*self.vehicles(), self.restitution, **contact)

    def passed(self, variant: str, steps: int = STEPS) -> col.Impact:
        """The contact followed in time."""
        bodies = self.vehicles(**({"heading": None} if variant == "tyres" else {}))
        contact = {
            "normal": self.normal,
            "point": self.point,
            "friction": self.friction,
            **VARIANTS[variant],
        }
        return col.time_resolved(
            *bodies, self.restitution, **contact, duration=DURATION, steps=steps
        )


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


def drawn(
    count: int = DRAWN, frictions: tuple[float, ...] = FRICTION, seed: int = SEED
) -> tuple[Scene, ...]:
    """Random impacts of two cars that do not spin before, close at 2 m/s and more, up to 28 m/s,
    and slide at up to 16 m/s.
    """
    rng = random.Random(seed)
    found: list[Scene] = []
    while len(found) < count:
        normal = rng.uniform(-math.pi, math.pi)
        n = math.cos(normal), math.sin(normal)
        bodies = []
        for sign in (-1.0, 1.0):
            along, across = (
                -sign * rng.uniform(0.0, 14.0),
                rng.uniform(-8.0, 8.0) * rng.choice([0.0, 0.3, 1.0]),
            )
            reach, lever = (
                sign * rng.uniform(0.6, 2.2),
                rng.uniform(-1.0, 1.0) * rng.choice([0.3, 1.0]),
            )
            mass = rng.uniform(900.0, 2200.0)
            velocity, place = (
                (u * n[0] - v * n[1], u * n[1] + v * n[0])
                for u, v in ((along, across), (reach, lever))
            )
            bodies.append(
                (
                    mass,
                    mass * rng.uniform(1.2, 2.0),
                    *velocity,
                    0.0,
                    *place,
                    rng.uniform(-math.pi, math.pi),
                )
            )
        e, friction = rng.uniform(0.0, 0.4), rng.choice(frictions)
        scene = Scene(f"drawn_{len(found)}", "", *bodies, e, normal, (0.0, 0.0), friction)
        try:
            closes = scene.impact().closing_speed >= 2.0
        except col.NoImpactError:
            continue
        if closes:
            found.append(scene)
    return tuple(found)


def changes(impacts: list[col.Impact]) -> Any:
    """Changes of velocity and yaw rate, of shape (x y yaw, A or B, scenes)."""
    names = ("delta_vx", "delta_vy", "delta_yaw_rate")
    return np.array(
        [
            [[getattr(getattr(impact, side), name) for impact in impacts] for side in "ab"]
            for name in names
        ]
    )


def measure(scenes: tuple[Scene, ...] = SCENES, steps: int = STEPS) -> dict[str, Any]:
    """Every scene: delta-V of the impulse, what each of what it leaves out changes, and what
    ``left_out`` estimates of that.

    The row "fixed" is against the law that steps without tyres and motion come to, all others
    against "fixed".
    """
    found = {name: changes([scene.passed(name, steps) for scene in scenes]) for name in VARIANTS}
    impulse = changes([scene.impact() for scene in scenes])
    against = dict.fromkeys(VARIANTS, found["fixed"])
    against["fixed"] = changes([scene.impact(law="stronge") for scene in scenes])
    against["all"] = impulse
    given = {"duration": DURATION, "drag": DRAG}
    estimates = [
        col.left_out(scene.impact(), **given, geometry="first_contact") for scene in scenes
    ]
    engaged = [col.left_out(scene.impact(), **given) for scene in scenes]
    rows = []
    for case, scene in enumerate(scenes):
        for side, label in enumerate("ab"):
            size = float(np.hypot(*impulse[:2, side, case]))
            if size == 0.0:
                continue
            row: dict[str, Any] = {
                "scene": scene.key,
                "name": scene.name,
                "side": label,
                "delta_v": _rounded(size),
            }
            for name, values in found.items():
                dx, dy, turn = (values - against[name])[:, side, case]
                row[name] = {
                    "delta_v": _rounded(math.hypot(dx, dy)),
                    "share": _rounded(math.hypot(dx, dy) / size),
                    "magnitude": _rounded(float(np.hypot(*values[:2, side, case])) / size - 1.0),
                    "delta_yaw_rate": _rounded(float(turn)),
                }
            estimate = getattr(estimates[case], label)
            names = ("tyre_delta_v_bound", "tyre_delta_v", "geometry_delta_v", "rotation")
            row["left_out"] = {name: _rounded(getattr(estimate, name)) for name in names}
            row["left_out"]["engaged_delta_v"] = _rounded(
                getattr(engaged[case], label).geometry_delta_v
            )
            row["left_out"]["mutual_crush"] = _rounded(estimates[case].mutual_crush)
            rows.append(row)
    finer = changes([scene.passed("all", 2 * steps) for scene in scenes])
    moved, size = (np.hypot(*values[:2]) for values in (finer - found["all"], finer))
    return {
        "duration": DURATION,
        "drag": DRAG,
        "steps": steps,
        "halving_the_step": _rounded(float(np.max(moved[size > 0.0] / size[size > 0.0]))),
        "frictions": {"drawn": list(FRICTION), "drawn_with_little_friction": list(LITTLE_FRICTION)},
        "drawn": estimates_of_drawn(),
        "drawn_with_little_friction": estimates_of_drawn(frictions=LITTLE_FRICTION),
        "rows": rows,
    }


# A change of delta-V that matters: of so much of it, and of so many m/s.
MATTERS, AT_LEAST = 0.02, 0.05
QUANTILES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)


def ratios_of_drawn(
    count: int = DRAWN,
    steps: int = STEPS,
    frictions: tuple[float, ...] = FRICTION,
    seed: int = SEED,
) -> dict[str, tuple[Any, int]]:
    """What ``left_out`` estimates over the change in time, for random impacts, where that matters;
    and how many are NaN.
    """
    scenes = drawn(count, frictions, seed)
    size = np.hypot(*changes([scene.impact() for scene in scenes])[:2])
    fixed = changes([scene.passed("fixed", steps) for scene in scenes])
    found = {}
    for name, field in (
        ("tyres", "tyre_delta_v"),
        ("moving", "geometry_delta_v"),
        ("engaged", "geometry_delta_v"),
    ):
        geometry = VARIANTS[name]["geometry"] if name == "moving" else "maximum_engagement"
        estimates = [
            col.left_out(one.impact(), duration=DURATION, drag=DRAG, geometry=geometry)
            for one in scenes
        ]
        moved = np.hypot(*(changes([scene.passed(name, steps) for scene in scenes]) - fixed)[:2])
        estimate = np.array(
            [[getattr(getattr(one, side), field) for one in estimates] for side in "ab"]
        )
        there = (moved > MATTERS * size) & (moved > AT_LEAST) & np.isfinite(estimate)
        found[name] = estimate[there] / moved[there], int(np.isnan(estimate).sum())
    return found


def outside(ratio: Any) -> float:
    """The share that is off by more than a factor of 1.5."""
    return float(np.mean((ratio > 1.5) | (ratio < 1.0 / 1.5)))


def estimates_of_drawn(frictions: tuple[float, ...] = FRICTION) -> dict[str, Any]:
    """Where these ratios lie."""
    found: dict[str, Any] = {"impacts": DRAWN, "matters": MATTERS}
    for name, (ratio, missing) in ratios_of_drawn(frictions=frictions).items():
        found[name] = {
            "vehicles": ratio.size,
            "quantiles": [_rounded(float(np.quantile(ratio, at))) for at in QUANTILES],
            "outside_1.5": _rounded(outside(ratio)),
            "no_estimate": missing,
        }
    return found


def _rounded(value: float) -> float:
    # The rounding of one platform is not that of another.
    return 0.0 if abs(value) < 1e-6 else float(f"{value:.3g}")


def table(found: dict[str, Any]) -> str:
    """What is measured, as a text: changes of delta-V in m/s, those of its magnitude in percent."""
    head = (
        "delta-V",
        "tyres",
        "wheels",
        "left_out",
        "bound",
        "moving",
        "left_out",
        "engaged",
        "left_out",
        "magnitude",
    )
    lines = [f"{'scene':<48}" + "".join(f"{text:>10}" for text in head)]
    for row in found["rows"]:
        estimate = row["left_out"]
        numbers = [
            row["delta_v"],
            *(row[name]["delta_v"] for name in ("tyres", "wheels")),
            *(estimate[name] for name in ("tyre_delta_v", "tyre_delta_v_bound")),
            row["moving"]["delta_v"],
            estimate["geometry_delta_v"],
            row["engaged"]["delta_v"],
            estimate["engaged_delta_v"],
        ]
        text = "".join(f"{number:10.3f}" for number in numbers)
        lines.append(
            f"{row['name']:<46}{row['side']:<2}{text}{100.0 * row['moving']['magnitude']:9.1f}%"
        )
    worst = max(row["fixed"]["share"] for row in found["rows"])
    lines.append(
        f"without tyres, with fixed geometry: within {worst:.1g} of the impulse; half the step: "
        f"{found['halving_the_step']:.1g}"
    )
    for key, frictions in found["frictions"].items():
        for name in ("tyres", "moving", "engaged"):
            spread = found[key][name]
            low, high = spread["quantiles"][1], spread["quantiles"][-2]
            lines.append(
                f"{found[key]['impacts']} random impacts, friction {frictions[0]:g} to "
                f"{frictions[-1]:g}, {name}: estimate / change in time {low:.2f} to {high:.2f} "
                f"for 9 in 10 of {spread['vehicles']} vehicles, outside a factor of 1.5 "
                f"{100.0 * spread['outside_1.5']:.1f}%"
            )
    return "\n".join(lines)


def main() -> None:
    """Measure, print, and write the numbers where a file is named."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n\n")[0])
    parser.add_argument("file", nargs="?", type=Path, help="where to write the numbers as JSON")
    options = parser.parse_args()
    found = measure()
    print(table(found))
    if options.file is not None:
        options.file.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
