"""Whether the motion during a contact is worth adding to the reverse solvers with tyres.

``python benchmarks/motion_backwards.py [--crashes 100] [--seed N]`` prints the table; it takes some
minutes. The crashes are those of lasting_population.py, read without any error: masses, inertias,
courses, yaw rates before, duration, tyres, restitution and friction as they are, and point, normal
and places at maximum engagement.

``tyres`` is the answer of ``speeds`` and ``planar`` with ``duration=``, ``tyres_a=``, ``tyres_b=``.
``and motion`` is that for which the same impact and besides the difference of ``time_resolved``
with moving places less with fixed ones, both without tyres, has what was known: what was known is
given less that difference, at the speeds found last, until these change by less than ``SAME``. From
the fourth time on half of the change is taken. "not settled" counts crashes that get no answer so,
though they have one without it.

An error is that of a velocity before that is sought, in km/h, the larger of both cars; of several
answers, of the nearest. By ``eccentric`` and ``time_resolved`` forwards it is that of delta-V,
as a share of it.
"""

from __future__ import annotations

import argparse
import math
import sys
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from coverage_in_crashes import OF_TYRES
from lasting_population import SEED, population

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "src"))

import collisions as col
from collisions import reconstruct
from collisions.travel import Tyres

STEPS = 50  # of a contact in time: its difference is known to far better than it helps
SAME = 0.02 / 3.6  # m/s
ROUNDS, WHOLE = 20, 3  # at most, and how many of them take the whole change
KMH = 3.6


class Moved(NamedTuple):
    """What the motion adds: changes of velocity and yaw rate, (2, 3), and energy of the contact."""

    change: Any
    loss: float


STILL = Moved(np.zeros((2, 3)), 0.0)


class Crash(NamedTuple):
    """One crash as it was, for the solvers."""

    bodies: tuple[dict[str, float], dict[str, float]]
    before: Any  # (2, 3): vx, vy, yaw rate
    after: Any
    contact: dict[str, Any]  # normal and point
    lasting: dict[str, Any]
    restitution: float
    friction: float
    loss: float
    stuck: bool

    @property
    def speeds(self) -> Any:
        """Speeds before."""
        return np.hypot(self.before[:, 0], self.before[:, 1])

    @property
    def courses(self) -> Any:
        """Courses before."""
        return np.arctan2(self.before[:, 1], self.before[:, 0])

    @property
    def change(self) -> Any:
        """Changes of velocity and yaw rate."""
        return self.after - self.before

    def vehicles(self, motion: Any = None) -> list[col.Vehicle]:
        """Both cars at maximum engagement with these motions, or with their yaw rates before."""
        motion = self.before * np.array([0.0, 0.0, 1.0]) if motion is None else motion
        names = ("vx", "vy", "yaw_rate")
        return [
            col.Vehicle(**body, **dict(zip(names, map(float, row), strict=True)))
            for body, row in zip(self.bodies, motion, strict=True)
        ]

    def moved(self, motion: Any) -> Moved:
        """What the motion during the contact adds to an impact from these motions."""
        found = [
            col.time_resolved(
                *self.vehicles(motion),
                self.restitution,
                **self.contact,
                friction=self.friction,
                duration=self.lasting["duration"],
                geometry=geometry,
                steps=STEPS,
            )
            for geometry in ("maximum_engagement", "fixed")
        ]
        moving, fixed = map(changes, found)
        return Moved(moving - fixed, found[0].energy_loss - found[1].energy_loss)


def changes(impact: col.Impact) -> Any:
    """Changes of velocity and yaw rate of both cars."""
    return np.array(
        [[s.delta_vx, s.delta_vy, s.delta_yaw_rate] for s in (impact.a, impact.b)], dtype=float
    )


def motions(impact: col.Impact) -> Any:
    """Motions before of both cars."""
    states = impact.a.before, impact.b.before
    return np.array([[s.vx, s.vy, s.yaw_rate] for s in states], dtype=float)


def crashes(n: int, seed: int) -> Iterator[Crash]:
    """The crashes of the population."""
    drawn = population(n, seed)
    k, c = drawn.crashes, drawn.contacts
    for i in range(n):
        bodies = tuple(
            {
                "mass": float(k.mass[j, i]),
                "yaw_inertia": float(k.inertia[j, i]),
                "x": float(c.x[j, i]),
                "y": float(c.y[j, i]),
                "heading": float(c.heading[j, i]),
            }
            for j in range(2)
        )
        tyres = [
            Tyres(
                float(k.ground[i]),
                [float(lock) for lock in np.minimum(k.lock[j, :, i], 1.0)],
                **{name: float(getattr(k, name)[j, i]) for name in OF_TYRES},
            )
            for j in range(2)
        ]
        yield Crash(
            bodies=(bodies[0], bodies[1]),
            before=np.stack([k.vx[:, i], k.vy[:, i], k.yaw_rate[:, i]], axis=1),
            after=c.after[:, 3:6, i],
            contact={"normal": float(c.normal[i]), "point": tuple(map(float, c.point[:, i]))},
            lasting={"duration": float(c.duration[i]), "tyres_a": tyres[0], "tyres_b": tyres[1]},
            restitution=float(k.restitution[i]),
            friction=float(k.friction[i]),
            loss=float(c.lost_along[i] + c.heat[i]),
            stuck=bool(c.stuck[i]),
        )


def nearest(crash: Crash, found: Any) -> Any:
    """Of several answers the motions before that are nearest to the truth."""
    return min(map(motions, found), key=lambda one: float(np.abs(one - crash.before)[:, :2].sum()))


def by_speeds(crash: Crash, known: dict[str, Any], **more: Any) -> Any:
    """Motions before by ``speeds``."""
    a, b = crash.courses
    with_friction = {"friction": crash.friction} | more
    found = reconstruct.speeds(
        *crash.vehicles(),
        course_a=a,
        course_b=b,
        restitution=crash.restitution,
        **crash.contact,
        **crash.lasting,
        **known,
        **with_friction,
    )
    return nearest(crash, found)


def components(crash: Crash, labels: str, moved: Moved) -> dict[str, Any]:
    """Components of delta-V at the centres of mass, in axes that do not turn."""
    known: dict[str, Any] = {"axes": "fixed"}
    for j, label in enumerate("ab"):
        if label in labels:
            vx, vy, _ = crash.change[j] - moved.change[j]
            heading = crash.bodies[j]["heading"]
            c, s = math.cos(heading), math.sin(heading)
            known[f"delta_v_forward_{label}"] = c * vx + s * vy
            known[f"delta_v_left_{label}"] = c * vy - s * vx
    return known


def both_recorders(crash: Crash, moved: Moved) -> Any:
    """Components of both cars, where the contact is stated to have stuck."""
    known = components(crash, "ab", moved)
    return by_speeds(crash, known, friction=math.inf, regime="sticking")


def one_recorder(crash: Crash, moved: Moved) -> Any:
    """Components of A and its speed, friction known."""
    return by_speeds(crash, components(crash, "a", moved) | {"speed_a": float(crash.speeds[0])})


def size_of_a(crash: Crash, moved: Moved) -> float:
    """Delta-V of A, less what the motion adds to it."""
    return float(np.hypot(*(crash.change - moved.change)[0, :2]))


def delta_v_and_speed(crash: Crash, moved: Moved) -> Any:
    """Delta-V of A and the speed of B, friction known."""
    known = {"delta_v_a": size_of_a(crash, moved), "speed_b": float(crash.speeds[1])}
    return by_speeds(crash, known)


def delta_v_and_energy(crash: Crash, moved: Moved) -> Any:
    """Delta-V of A and the energy of the contact, friction known."""
    known = {"delta_v_a": size_of_a(crash, moved), "energy_loss": crash.loss - moved.loss}
    return by_speeds(crash, known)


def by_planar(crash: Crash, moved: Moved) -> Any:
    """Motions after and the energy of the contact, friction known."""
    try:
        found: Any = [
            reconstruct.planar(
                *crash.vehicles(crash.after - moved.change),
                energy_loss=crash.loss - moved.loss,
                friction=crash.friction,
                **crash.contact,
                **crash.lasting,
            )
        ]
    except col.AmbiguousSolutionError as several:
        found = several.solutions
    return nearest(crash, found)


class Route(NamedTuple):
    """What is known, of which crashes, and the cars whose speeds are sought."""

    name: str
    solve: Callable[[Crash, Moved], Any]
    fits: Callable[[Crash], bool]
    sought: tuple[int, ...]


ROUTES = (
    Route("both recorders, stuck", both_recorders, lambda one: one.stuck, (0, 1)),
    Route("one recorder and its speed, stuck", one_recorder, lambda one: one.stuck, (1,)),
    Route("one recorder and its speed, slid", one_recorder, lambda one: not one.stuck, (1,)),
    Route("delta-V of A and speed of B", delta_v_and_speed, lambda _: True, (0,)),
    Route("delta-V of A and energy", delta_v_and_energy, lambda _: True, (0, 1)),
    Route("planar and energy, slid", by_planar, lambda one: not one.stuck, (0, 1)),
)


def tried(route: Route, crash: Crash) -> tuple[float, float] | None:
    """Errors of the answer with tyres and of that with motion, NaN where it does not settle; None
    where there is none with tyres.
    """
    sought = list(route.sought)

    def error(found: Any) -> float:
        return float(np.hypot(*(found - crash.before)[sought, :2].T).max()) * KMH

    try:
        found = route.solve(crash, STILL)
    except col.CollisionsError:
        return None
    first = error(found)
    moved = STILL
    try:
        for count in range(ROUNDS):
            now = crash.moved(found)
            share = 1.0 if count < WHOLE else 0.5
            moved = Moved(*(old + share * (new - old) for old, new in zip(moved, now, strict=True)))
            new = route.solve(crash, moved)
            if np.hypot(*(new - found)[:, :2].T).max() < SAME:
                return first, error(new)
            found = new
    except col.CollisionsError:
        pass
    return first, math.nan


def forwards(crash: Crash) -> tuple[float, float, float] | None:
    """Errors of delta-V as a share: with tyres, and the motion, and by the contact in time."""
    cars = crash.vehicles(crash.before)
    given = {**crash.contact, **crash.lasting, "friction": crash.friction}
    try:
        tyres = changes(col.eccentric(*cars, crash.restitution, **given))
        moving = tyres + crash.moved(crash.before).change
        timed = changes(col.time_resolved(*cars, crash.restitution, steps=STEPS, **given))
    except col.CollisionsError:
        return None
    size = np.hypot(*crash.change[:, :2].T)
    one, two, three = (
        float((np.hypot(*(found - crash.change)[:, :2].T) / size).max())
        for found in (tyres, moving, timed)
    )
    return one, two, three


def spread(values: Any) -> str:
    """Median and 90th percentile."""
    return f"{np.median(values):7.2f}{np.quantile(values, 0.9):7.2f}"


def main() -> None:
    """Print the table."""
    as_written = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=as_written)
    parser.add_argument("--crashes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=SEED, help="another draws other crashes")
    options = parser.parse_args()
    warnings.simplefilter("ignore", col.CollisionsWarning)
    drawn = list(crashes(options.crashes, options.seed))
    ahead = np.array([one for one in map(forwards, drawn) if one is not None])
    print("forwards, delta-V, %, median and 90th percentile")
    for name, errors in zip(("tyres", "and motion", "contact in time"), ahead.T, strict=True):
        print(f"  {name:16}{spread(100.0 * errors)}  of {len(ahead)}")
    print(
        "\nbackwards, speed, km/h          crashes  not settled |  tyres: median, 90 %  | "
        "and motion: median, 90 %  | better in"
    )
    for route in ROUTES:
        found = [tried(route, one) for one in drawn if route.fits(one)]
        errors = np.array([one for one in found if one is not None])
        settled = errors[np.isfinite(errors[:, 1])]
        better = np.count_nonzero(settled[:, 1] < settled[:, 0])
        print(
            f"{route.name:34}{len(errors):5d}{len(errors) - len(settled):13d} |"
            f"{spread(settled[:, 0]):>22} |{spread(settled[:, 1]):>26} |"
            f"{better:5d} of {len(settled)}",
            flush=True,
        )


if __name__ == "__main__":
    main()
