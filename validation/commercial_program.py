"""Two impacts as a commercial program, PC-Crash, ran them, beside the library's impact by the law
that the program states.

Then what the vehicles do after it, which is in ``commercial/*.csv`` row by row, beside ``Scene``
(both) and ``travel.simulate`` (into the side).
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from published_records import LAWS, rounded

import collisions as col
from collisions import travel
from collisions.scene import Contact, Mover, Scene

DATA = Path(__file__).resolve().parent / "commercial"
SOURCE = "PC-Crash, in the public history of https://github.com/joe-cormier/pycrash"
PROGRAM_LAW = "kudlich-slibar"
CAR = {"mass": "3296 lb", "yaw_inertia": "1789 slug*ft**2"}
HOW = {"restitution": 0.1, "friction": 0.6}


def path_of(name: str) -> list[dict[str, float]]:
    """A run of the program, a row for each 0.1 s."""
    with open(DATA / name, newline="", encoding="utf-8") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


SIDE_CONTACT = {**HOW, "normal": f"{138.94 - 90.0} deg", "point": ("38.32 ft", "1.84 ft")}
"""The contact of the T; its plane lies along 138.94 deg."""


def side_cars() -> tuple[col.Vehicle, col.Vehicle]:
    """Both cars of the T, just before the impact."""
    a = col.Vehicle(**CAR, vx="30 mph", x="33.22 ft", y=0.0, heading=0.0)
    return a, col.Vehicle(**CAR, x="40 ft", y="10 ft", heading="90 deg")


def side_impact(law: str) -> col.Impact:
    """The T."""
    return col.eccentric(*side_cars(), **SIDE_CONTACT, law=law)


def into_the_side(law: str) -> dict[str, float]:
    """The T: both cars after it, in the units of the program."""
    impact = side_impact(law)
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


State = Callable[[float], col.Vehicle]
SIDE_FROM = 0.755
"""When the cars of the T strike each other, on the clock of the program [s]."""
TIMES = {
    "in line": (0.7, 1.0, 1.5, 2.0, 2.5, 3.0, 5.0),
    "into the side": (0.8, 1.0, 1.2, 1.4, 1.6, 2.0, 3.0, 5.0),
}
FILES = {"in line": "pccrash_30mph_inline.csv", "into the side": "pccrash_30mph_t.csv"}
LINEAR = 1 / math.radians(10)
"""Side force over load of the program, per radian and per friction: linear up to 10 degrees."""
GROUNDS = {
    "friction 0.8": (0.8, 9.5),
    "friction 0.6": (0.6, 9.5),
    "friction 0.6, slope of the program": (0.6, 0.6 * LINEAR),
}
"""Friction and cornering stiffness. The friction of the program's ground is not in the data, so two
guesses; 9.5 is the library's own stiffness.
"""


def in_line_motion() -> tuple[float, dict[str, State]]:
    """A ``Scene`` from the impact on: vehicle 1 brakes at 0.3 g, vehicle 2 rolls; and when it
    starts, on the clock of the program.

    The time is that at which vehicle 2 must have set off to be where it is in the first row after.
    The size of the wheels does not matter in a straight line.
    """
    rows = path_of(FILES["in line"])
    after = next(row for row in rows if row["vx2_mph"] > 0.0)
    before = rows[rows.index(after) - 1]
    per_second = col.Vehicle(mass=1.0, vx="1 mph").vx / col.Vehicle(mass=1.0, x="1 ft").x
    start = after["time_s"] - (after["x2_ft"] - before["x2_ft"]) / (per_second * after["vx2_mph"])
    x = before["x1_ft"] + per_second * before["vx1_mph"] * (start - before["time_s"])
    cars = (
        col.Vehicle(**CAR, vx="29.3 mph", x=f"{x} ft", y=0.0, heading=0.0),
        col.Vehicle(**CAR, x=f"{before['x2_ft']} ft", y=0.0, heading=0.0),
    )
    wheels = [travel.Tyres(0.8, lock, "9.2 ft", "5 ft") for lock in (0.3 / 0.8, 0.0)]
    names = ("vehicle 1", "vehicle 2")
    run = Scene(
        movers={
            name: Mover(car, tyres=own) for name, car, own in zip(names, cars, wheels, strict=True)
        },
        contacts=[
            Contact(*names, **HOW, normal=0.0, point=(cars[1].x, 0.0), law=PROGRAM_LAW, at=0.0)
        ],
    ).run()
    return start, {name: lambda time, name=name: run.at(time - start)[name] for name in names}


def side_wheels(friction: float, cornering: float) -> travel.Tyres:
    """The wheels of the T, whose size is a guess, rolling.

    Something has to stop a car: a drag of 0.001 of the weight, 0.1 mph in the time that is
    compared.
    """
    return travel.Tyres(friction, 0.001 / friction, "9.2 ft", "5 ft", cornering=cornering)


def side_motion(friction: float, cornering: float) -> dict[str, State]:
    """``travel.simulate`` from the impact on; so many moments because such a car comes to rest only
    after minutes.
    """
    impact = side_impact(PROGRAM_LAW)
    tyres = side_wheels(friction, cornering)
    found: dict[str, State] = {}
    for name, side in (("vehicle 1", impact.a), ("vehicle 2", impact.b)):
        path = travel.simulate(side.after, tyres, moments=50000)
        found[name] = lambda time, path=path: path.at(time - SIDE_FROM)
    return found


def side_scene(friction: float, cornering: float) -> dict[str, State]:
    """The same as one ``Scene``: the impact and the motion after it, by its names."""
    cars, names = side_cars(), ("vehicle 1", "vehicle 2")
    tyres = side_wheels(friction, cornering)
    run = Scene(
        movers={name: Mover(car, tyres=tyres) for name, car in zip(names, cars, strict=True)},
        contacts=[Contact(*names, **SIDE_CONTACT, law=PROGRAM_LAW, at=0.0)],
    ).run()
    return {name: lambda time, name=name: run.at(time - SIDE_FROM)[name] for name in names}


def scene_apart() -> dict[str, float]:
    """How far the motion by ``Scene`` is from that by ``simulate``, over all cars, grounds and
    times that are compared: the largest difference of each number.
    """
    found: dict[str, float] = {}
    for ground in GROUNDS.values():
        ours, again = side_motion(*ground), side_scene(*ground)
        for name, state in ours.items():
            for time in TIMES["into the side"]:
                one, other = place(state(time)), place(again[name](time))
                for key, value in one.items():
                    apart = abs(value - other[key])
                    if key == "heading":
                        apart = abs((apart + 180.0) % 360.0 - 180.0)
                    found[key] = max(found.get(key, 0.0), apart)
    return {key: float(f"{value:.2g}") for key, value in found.items()}


def place(vehicle: col.Vehicle) -> dict[str, float]:
    """Where a vehicle is, in the units of the program."""
    foot, mph = col.Vehicle(mass=1.0, x="1 ft").x, col.Vehicle(mass=1.0, vx="1 mph").vx
    return {
        "x": vehicle.x / foot,
        "y": vehicle.y / foot,
        "heading": math.degrees(vehicle.heading),
        "speed": math.hypot(vehicle.vx, vehicle.vy) / mph,
    }


def theirs(row: dict[str, float], number: str) -> dict[str, float]:
    """The same of a row of the program."""
    return {
        "x": row[f"x{number}_ft"],
        "y": row[f"y{number}_ft"],
        "heading": row[f"yaw{number}_deg"],
        "speed": math.hypot(row[f"vx{number}_mph"], row[f"vy{number}_mph"]),
    }


def by_time(run: str, ground: str, states: dict[str, State]) -> list[dict[str, Any]]:
    """The program's place and speed of each car, and by how much ours differ, to a hundredth."""
    rows = {row["time_s"]: row for row in path_of(FILES[run])}
    found = []
    for name, state in states.items():
        for time in TIMES[run]:
            printed = theirs(rows[time], name[-1])
            ours = place(state(time))
            differences = {key: ours[key] - printed[key] for key in printed}
            differences["heading"] = (differences["heading"] + 180.0) % 360.0 - 180.0
            found.append(
                {
                    "run": run,
                    "ground": ground,
                    "name": name,
                    "time": time,
                    "printed": {key: round(value, 2) for key, value in printed.items()},
                    "difference": {
                        key: round(value, 2) + 0.0 for key, value in differences.items()
                    },
                }
            )
    return found


def motion_after() -> list[dict[str, Any]]:
    """The motion after both impacts beside that of a ``Scene``."""
    found = by_time("in line", "0.3 g", in_line_motion()[1])
    for ground, (friction, cornering) in GROUNDS.items():
        found += by_time("into the side", ground, side_scene(friction, cornering))
    return found


def everything() -> dict[str, Any]:
    """All that the page shows of the program's runs."""
    return {
        "source": SOURCE,
        "law": PROGRAM_LAW,
        "impacts": impacts(),
        "below_the_centres": below_the_centres(),
        "braking": braking(),
        "motion": motion_after(),
        "scene_and_simulate_apart": scene_apart(),
    }
