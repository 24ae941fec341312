"""How far a contact that slid must reach from one that stuck to count as another answer, measured:
``speeds`` from the components of one recorder and the speed of one car, with ``friction=inf``.

``python benchmarks/stuck_beside_a_speed.py`` prints the tables and writes
docs/_generated/stuck_beside_a_speed.json, in a few minutes. ``--crashes N`` draws so many that
stuck and so many that slid, ``--json PATH`` writes there, ``--list`` prints the crashes that are
answered wrong in silence with the threshold of the library.

Crashes of two cars are solved forward with ``eccentric``. One car's recorder and one car's speed
are read with normal errors of 5 % and then of 2 % of each reading; all else is known as it is. An
answer is right where the speed sought is within ``NEAR`` of the truth. One that is wrong is silent
if it came without a warning. Among the ambiguous are those for which the contact that stuck, which
a larger threshold would give alone, is right.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import warnings
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
if str(ROOT / "src") not in sys.path:
    sys.path.insert(0, str(ROOT / "src"))

import collisions as col
from collisions import reconstruct
from collisions.reconstruct import speeds_components

DATA = ROOT / "docs" / "_generated" / "stuck_beside_a_speed.json"
SEED = 20261127
CRASHES = 300  # that stuck, and as many that slid
ERRORS = (0.05, 0.02)  # standard deviations, as shares of each reading
THRESHOLDS = (0.0, 0.02, 0.05, 0.1, 0.2, 0.5, math.inf)  # of the closing speed
NEAR = 3.0  # m/s
ANSWERS = (
    "right", "wrong, warned", "wrong in silence", "ambiguous", "ambiguous, stuck right", "refused",
)  # fmt: skip
Numbers = dict[str, Any]


class Crash(NamedTuple):
    """One crash as it was: its impact, what is known of it without error, whose recorder and whose
    speed were read, and by how much more than the truth, in standard deviations.
    """

    impact: col.Impact
    known: dict[str, Any]
    recorder: str
    speed: str
    errors: Any

    @property
    def sought(self) -> str:
        """The car whose speed is sought."""
        return "b" if self.speed == "a" else "a"

    def side(self, label: str) -> Any:
        """One car of the impact."""
        return getattr(self.impact, label)

    def off(self, answer: col.Impact) -> float:
        """How far an answer is from the truth, in m/s."""
        one, other = (getattr(each, self.sought).before.speed for each in (answer, self.impact))
        return float(abs(one - other))

    def read(self, error: float) -> dict[str, Any]:
        """What ``speeds`` is given."""
        of = self.side(self.recorder)
        truths = {
            f"delta_v_forward_{self.recorder}": of.delta_v_forward,
            f"delta_v_left_{self.recorder}": of.delta_v_left,
            f"speed_{self.speed}": self.side(self.speed).before.speed,
        }
        factors = 1.0 + error * self.errors
        read = {
            name: float(truth * factor)
            for (name, truth), factor in zip(truths.items(), factors, strict=True)
        }
        return {**self.known, **read, "friction": math.inf}


def crashes(count: int = CRASHES, seed: int = SEED) -> list[Crash]:
    """So many that stuck and so many that slid, in the order in which they were drawn."""
    draw = np.random.default_rng(seed)
    found: list[Crash] = []
    left = {"sticking": count, "sliding": count}
    while any(left.values()):
        course = draw.choice([-1.0, 1.0]) * draw.uniform(0.5, 2.6)
        cars = [
            col.Vehicle.from_speed(
                speed=draw.uniform(6.0, 25.0),
                course=along,
                heading=along + draw.normal(0.0, 0.05),
                mass=(mass := draw.uniform(1000.0, 2200.0)),
                yaw_inertia=mass * draw.uniform(1.4, 2.0),
                x=x,
                y=draw.normal(0.0, 0.8),
                yaw_rate=draw.normal(0.0, 0.1),
            )
            for along, x in ((0.0, -1.8), (course, 1.8))
        ]
        known = {
            "restitution": draw.uniform(0.0, 0.4),
            "normal": draw.uniform(-0.6, 0.6),
            "point": tuple(draw.normal(0.0, 0.4, 2)),
        }
        friction = draw.uniform(0.3, 0.9)
        whose, errors = draw.integers(2, size=2), draw.normal(size=3)
        impact = col.eccentric(*cars, **known, friction=friction, on_failure="nan")
        if not impact.ok or impact.closing_speed < 3.0 or not left.get(impact.regime):
            continue
        left[impact.regime] -= 1
        courses = {f"course_{label}": car.course for label, car in zip("ab", cars, strict=True)}
        recorder, speed = ("ab"[one] for one in whose)
        found.append(Crash(impact, known | courses, recorder, speed, errors))
    return found


def answered(crash: Crash, error: float) -> str:
    """How ``speeds`` answers one crash, as one of ``ANSWERS``."""
    given = crash.impact.inputs
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            found = reconstruct.speeds(given.a, given.b, **crash.read(error))
        except col.AmbiguousSolutionError as refusal:
            stuck = [one for one in refusal.solutions if one.regime == "sticking"]
            right = bool(stuck) and min(map(crash.off, stuck)) <= NEAR
            return "ambiguous, stuck right" if right else "ambiguous"
        except col.CollisionsError:
            return "refused"
    if min(map(crash.off, found)) <= NEAR:
        return "right"
    return "wrong, warned" if caught else "wrong in silence"


def measured(drawn: Sequence[Crash], errors: Any = ERRORS, thresholds: Any = THRESHOLDS) -> Any:
    """A row by error, threshold and how the contact ended: how many were answered how."""
    kept = speeds_components._BEYOND
    rows: list[Numbers] = []
    try:
        for error in errors:
            for threshold in thresholds:
                speeds_components._BEYOND = threshold
                counts = {regime: Counter[str]() for regime in ("sticking", "sliding")}
                for crash in drawn:
                    counts[crash.impact.regime][answered(crash, error)] += 1
                rows += [
                    {
                        "error": error,
                        "threshold": threshold if math.isfinite(threshold) else "inf",
                        "regime": regime,
                        **{name: count[name] for name in ANSWERS},
                    }
                    for regime, count in counts.items()
                ]
    finally:
        speeds_components._BEYOND = kept
    return rows


def load(data: Path = DATA) -> Numbers:
    """What was written."""
    found: Numbers = json.loads(data.read_text(encoding="utf-8"))
    return found


def written(drawn: Sequence[Crash], crashes_of_each: int, data: Path) -> Numbers:
    """What is measured of these crashes, written."""
    found = {
        "settings": {
            "crashes": crashes_of_each,
            "seed": SEED,
            "near": NEAR,
            "threshold": speeds_components._BEYOND,
        },
        "rows": measured(drawn),
    }
    data.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    return found


def table(found: Numbers) -> str:
    """The rows as a table of Markdown."""
    lines = [
        f"| error | threshold | contact | {' | '.join(ANSWERS)} |",
        f"|---|---|---|{'---|' * len(ANSWERS)}",
    ]
    for row in found["rows"]:
        cells = " | ".join(str(row[name]) for name in ANSWERS)
        contact = {"sticking": "stuck", "sliding": "slid"}[row["regime"]]
        lines.append(f"| {row['error']:.0%} | {row['threshold']} | {contact} | {cells} |")
    return "\n".join(lines)


def summary(found: Numbers) -> str:
    """The table of the page: both ways of ending a contact together."""
    near, count = found["settings"]["near"], 2 * found["settings"]["crashes"]
    kinds = ANSWERS[:1], ANSWERS[2:3], ANSWERS[3:5], ANSWERS[4:5]
    heads = (
        f"within {near:g} m/s",
        "further off in silence",
        "ambiguous",
        "of these, one that stuck is right",
    )
    lines = [
        f"| errors of readings | beyond, of the closing speed | {' | '.join(heads)} |",
        f"|---|---|{'---|' * len(heads)}",
    ]
    for error in ERRORS:
        for threshold in dict.fromkeys(row["threshold"] for row in found["rows"]):
            rows = [
                row
                for row in found["rows"]
                if (row["error"], row["threshold"]) == (error, threshold)
            ]
            cells = " | ".join(str(sum(row[one] for row in rows for one in kind)) for kind in kinds)
            how_far = "the best alone" if threshold == "inf" else f"{threshold:g}"
            if threshold == found["settings"]["threshold"]:
                how_far = f"**{how_far}**"
            lines.append(f"| {error:.0%} | {how_far} | {cells} |")
    return "\n".join([*lines, "", f"Each row has {count} crashes, half of which slid."])


def listed(drawn: list[Crash]) -> str:
    """The crashes that are answered wrong in silence with the threshold of the library."""
    lines = []
    for i, crash in enumerate(drawn):
        for error in ERRORS:
            if answered(crash, error) != "wrong in silence":
                continue
            given = crash.impact.inputs
            found, *others = reconstruct.speeds(given.a, given.b, **crash.read(error))
            truth, answer = (
                getattr(one, crash.sought).before.speed for one in (crash.impact, found)
            )
            lines.append(
                f"{i}: {error:.0%}, {crash.impact.regime} answered as {found.regime}, "
                f"{truth:.2f} m/s answered as {answer:.2f}, {1 + len(others)} answers, "
                f"condition {found.reconstruction.condition:.2f}"
            )
    return "\n".join(lines)


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--crashes", type=int, default=CRASHES)
    parser.add_argument("--json", type=Path, default=DATA)
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    drawn = crashes(options.crashes)
    if options.list:
        sys.stdout.write(listed(drawn) + "\n")
        return
    found = written(drawn, options.crashes, options.json)
    sys.stdout.write(table(found) + "\n")


if __name__ == "__main__":
    main()
