"""What the time steps of ``time_resolved`` err by: the table "Contacts followed in steps" of the
page "Numerical stability".

``python benchmarks/steps.py`` measures it at 100, 200 and 400 steps and writes
docs/_generated/steps.json; ``--json PATH`` writes there. What it is compared with is that of
tests/impact/test_time_resolved.py: closed forms against a barrier, an impact worked out from event
to event, and another integration (Runge and Kutta's). The scenes are seeded, and nothing is timed.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
for folder in (ROOT / "src", ROOT / "tests"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

import collisions as col
from collisions.kernels.time_resolved import _NEAR
from impact import test_time_resolved as asserted

DATA = ROOT / "docs" / "_generated" / "steps.json"
STEPS = (100, 200, 400)
RESTITUTIONS = (0.0, 1e-3, 0.05, 0.3, 0.7, 1.0)
FRICTIONS = (0.05, 0.2, 0.5, 0.8, 1.5)
COUNT = 2000
Errors = list[list[float]]


def barrier() -> Errors:
    """The worst of largest force, crush and duration of a linear spring against a wall, for every
    restitution.
    """
    mass, speed, stiffness = 1500.0, 10.0, 400e3
    frequency = math.sqrt(stiffness / mass)
    car = col.Vehicle(mass=mass, yaw_inertia=2600.0, vx=speed, x=-2.0, y=0.0)
    found = []
    for e in RESTITUTIONS:
        row = []
        for steps in STEPS:
            spring = {"stiffness": stiffness, "steps": steps, **asserted.STRAIGHT}
            pulse = col.time_resolved(car, asserted.WALL, e, **spring).pulse
            wanted = (
                speed / frequency,
                speed * mass * frequency,
                (1.0 + e) * math.pi / 2 / frequency,
            )
            pairs = zip((pulse.max_crush, pulse.peak_force, pulse.duration), wanted, strict=True)
            row.append(max(abs(one / other - 1.0) for one, other in pairs))
        found.append(row)
    return found


def fixed() -> Errors:
    """The change of both motions without tyres or moving places, against the same worked out from
    event to event.
    """
    found = []
    for a, b, e, contact in asserted.scenes(COUNT, 3, FRICTIONS):
        wanted, _ = asserted.by_events(a, b, e, **contact)
        given = {"geometry": "fixed", "duration": 0.1, **contact}
        found.append(
            [asserted.off(_change(a, b, e, steps=steps, **given), wanted) for steps in STEPS]
        )
    return found


def sliding(geometry: str) -> Errors:
    """The same with tyres and moving places, against the other integration, from first contact or
    maximum engagement.
    """
    found = []
    for a, b, e, normal, friction in asserted.SLIDING.values():
        contact: dict[str, Any] = {"normal": normal, "point": (0.0, 0.0), "friction": friction}
        apart = asserted.Apart(a, b, e, contact, 1e6, 0.7)
        engaged, end = apart.run(2e-4)
        wanted = []
        for at, body in ((0, a), (4, b)):
            gained = end[at] - complex(body.vx, body.vy)
            radius = math.sqrt(body.yaw_inertia / body.mass)
            wanted += [gained.real, gained.imag, radius * (end[at + 1] - body.yaw_rate)]
        if geometry == "maximum_engagement":
            _, point, turned, *_ = apart.contact(engaged)
            a, b = (
                body.replace(
                    x=engaged[at].real, y=engaged[at].imag, heading=body.heading + engaged[at + 1]
                )
                for at, body in ((2, a), (6, b))
            )
            contact |= {
                "normal": math.atan2(turned.imag, turned.real),
                "point": (point.real, point.imag),
            }
        given = {"geometry": geometry, "stiffness": 1e6, "drag": 0.7, **contact}
        found.append(
            [
                asserted.off(_change(a, b, e, steps=steps, **given), np.array(wanted))
                for steps in STEPS
            ]
        )
    return found


def _change(a: col.Vehicle, b: col.Vehicle, e: float, **given: Any) -> Any:
    return asserted.change(col.time_resolved(a, b, e, **given))


def measured() -> dict[str, Any]:
    """Every row: the median and the worst error by the number of steps, to two digits."""
    rows = (
        ("barrier", "barrier, linear spring: force, crush, duration", barrier()),
        (
            "fixed",
            "fixed geometry without tyres, against energetic restitution, of delta-V",
            fixed(),
        ),
        (
            "sliding",
            "moving geometry and tyres, sliding throughout, of delta-V",
            sliding("first_contact"),
        ),
        ("engaged", "the same from positions at maximum engagement", sliding("maximum_engagement")),
    )
    found = []
    for key, name, errors in rows:
        row: dict[str, Any] = {"key": key, "name": name, "cases": len(errors)}
        for label, reduced in (
            ("median", np.median(errors, axis=0)),
            ("worst", np.max(errors, axis=0)),
        ):
            row[label] = [float(f"{error:.2g}") for error in reduced]
        found.append(row)
    return {"steps": list(STEPS), "start": _NEAR, "rows": found}


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", type=Path, default=DATA)
    options = parser.parse_args()
    found = measured()
    options.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    for row in found["rows"]:
        print(row["key"], row["cases"], "median", row["median"], "worst", row["worst"])


if __name__ == "__main__":
    main()
