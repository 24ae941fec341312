"""Two impacts as a commercial program, PC-Crash, ran them, beside the library's impact by the law
that the program states.

Compared here is the impact alone. What the vehicles do after it is in ``commercial/*.csv``, row by
row; a comparison of it with ``travel.simulate`` belongs in ``motion_after``.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

from published_records import LAWS, rounded

import collisions as col
from collisions import travel

DATA = Path(__file__).resolve().parent / "commercial"
SOURCE = "PC-Crash, in the public history of https://github.com/joe-cormier/pycrash"
PROGRAM_LAW = "kudlich-slibar"
CAR = {"mass": "3296 lb", "yaw_inertia": "1789 slug*ft**2"}
HOW = {"restitution": 0.1, "friction": 0.6}


def path_of(name: str) -> list[dict[str, float]]:
    """A run of the program, a row for each 0.1 s."""
    with open(DATA / name, newline="", encoding="utf-8") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def into_the_side(law: str) -> dict[str, float]:
    """The T: both cars after it, in the units of the program; its plane of contact lies along
    138.94 deg.
    """
    a = col.Vehicle(**CAR, vx="30 mph", x="33.22 ft", y=0.0)
    b = col.Vehicle(**CAR, x="40 ft", y="10 ft", heading="90 deg")
    impact = col.eccentric(
        a, b, **HOW, normal=f"{138.94 - 90.0} deg", point=("38.32 ft", "1.84 ft"), law=law
    )
    found = {}
    for name, side in (("vehicle 1", impact.a), ("vehicle 2", impact.b)):
        found[f"{name}, speed after"] = side.after.q.speed.m_as("mph")
        found[f"{name}, direction after"] = math.degrees(math.atan2(side.after.vy, side.after.vx))
        found[f"{name}, yaw rate after"] = math.degrees(side.after.yaw_rate)
    found["delta-V of each"] = impact.b.q.delta_v.m_as("mph")
    # Both cars are alike, so both have the same energy equivalent speed if each took half of what
    # was lost.
    found["EES of each"] = (
        math.sqrt(impact.energy_loss / impact.a.before.mass) / col.Vehicle(mass=1.0, vx="1 mph").vx
    )
    return found


def in_line(law: str) -> dict[str, float]:
    """In line: the same cars, one behind the other; through both centres of mass no
    friction acts.
    """
    impact = col.eccentric(
        col.Vehicle(**CAR, vx="29.3 mph", x="-7 ft", y=0.0),
        col.Vehicle(**CAR, x="7 ft", y=0.0),
        **HOW,
        normal=0.0,
        point=(0.0, 0.0),
        law=law,
    )
    return {
        "vehicle 1, speed after": impact.a.after.q.speed.m_as("mph"),
        "vehicle 2, speed after": impact.b.after.q.speed.m_as("mph"),
    }


RUNS: dict[str, tuple[Any, dict[str, tuple[str, str]]]] = {
    "into the side": (
        into_the_side,
        {
            "vehicle 1, speed after": ("24.16", "mph"),
            "vehicle 1, direction after": ("-5.07", "deg"),
            "vehicle 1, yaw rate after": ("0.12", "deg/s"),
            "vehicle 2, speed after": ("6.31", "mph"),
            "vehicle 2, direction after": ("19.76", "deg"),
            "vehicle 2, yaw rate after": ("215.94", "deg/s"),
            "delta-V of each": ("6.31", "mph"),
            "EES of each": ("8.95", "mph"),
        },
    ),
    "in line": (
        in_line,
        {"vehicle 1, speed after": ("13.28", "mph"), "vehicle 2, speed after": ("16.02", "mph")},
    ),
}
"""Each run, with the program's answer as printed."""


def impacts() -> list[dict[str, Any]]:
    """Every figure of both runs under both laws."""
    found = []
    for run, (solve, printed) in RUNS.items():
        ours = {law: solve(law) for law in LAWS}
        for name, (text, unit) in printed.items():
            # A direction, and a yaw rate near 0, are compared by their difference.
            by_difference = "direction" in name or abs(float(text)) < 1.0
            found.append(
                {
                    "run": run,
                    "name": name,
                    "unit": unit,
                    "printed": text,
                    "by_law": {
                        law: {
                            "computed": rounded(ours[law][name]),
                            "difference": rounded(
                                ours[law][name] - float(text)
                                if by_difference
                                else 100 * (ours[law][name] / float(text) - 1)
                            ),
                        }
                        for law in LAWS
                    },
                    "measure": unit if by_difference else "%",
                }
            )
    return found


def braking() -> dict[str, Any]:
    """In line, vehicle 1 brakes at 0.3 g from the first row after the impact: where it stops."""
    rows = path_of("pccrash_30mph_inline.csv")
    start = next(row for row in rows if 0.0 < row["vx1_mph"] < 20.0)
    foot = col.Vehicle(mass=1.0, x="1 ft").x
    return {
        "from": start["time_s"],
        "printed": f"{rows[-1]['x1_ft']:.2f}",
        "computed": rounded(
            start["x1_ft"] + travel.distance(speed=f"{start['vx1_mph']} mph", drag=0.3) / foot
        ),
    }


def below_the_centres() -> float:
    """By how many percent the impulse is smaller for a contact 0.31 ft below both centres of mass,
    if the cars can pitch.

    To first order h**2 m / I, with the yaw inertia for the pitch inertia, which is not known.
    """
    car = col.Vehicle(**CAR, x="0.31 ft", y=0.0)
    return rounded(100 * car.x**2 * car.mass / car.yaw_inertia)


def motion_after() -> list[dict[str, Any]]:
    """The motion after the impact beside that of ``travel.simulate``: none is compared."""
    return []


def everything() -> dict[str, Any]:
    """All that the page shows of the program's runs."""
    return {
        "source": SOURCE,
        "law": PROGRAM_LAW,
        "impacts": impacts(),
        "below_the_centres": below_the_centres(),
        "braking": braking(),
        "motion": motion_after(),
    }
