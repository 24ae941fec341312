"""Scenes against independent integrations, brute force, and what does not depend on who looks."""

from __future__ import annotations

import contextlib
import itertools
import math
import os
import random
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import collisions as col
import reference_of_scenes as independent
from collisions.scene import Contact, Mover, Scene
from collisions.scene.touching import Meeting, Pair, Shape, first_touch, meeting, overlap_of
from collisions.travel import Tyres

RULE = {"at": "touch", "restitution": 0.15, "friction": 0.5}
# So many times ten scenes against an independent integration, which takes its time:
# COLLISIONS_SCENES=30 has 300 of them.
GROUPS = int(os.environ.get("COLLISIONS_SCENES", "5"))


def car(rng: random.Random, place: tuple[float, float], toward: tuple[float, float]) -> Mover:
    """A car at a place that moves about toward another."""
    mass = rng.uniform(900.0, 3000.0)
    course = math.atan2(toward[1] - place[1], toward[0] - place[0]) + rng.uniform(-0.2, 0.2)
    speed = rng.choice((0.0, rng.uniform(5.0, 25.0), rng.uniform(5.0, 25.0)))
    body = col.Vehicle(
        mass=mass,
        yaw_inertia=mass * rng.uniform(1.2, 1.5) ** 2,
        x=place[0],
        y=place[1],
        vx=speed * math.cos(course),
        vy=speed * math.sin(course),
        heading=course + rng.choice((0.0, 0.0, rng.uniform(-0.4, 0.4), math.pi / 2)),
        yaw_rate=rng.choice((0.0, rng.uniform(-2.0, 2.0))) if speed else 0.0,
    )
    tyres = Tyres(rng.uniform(0.5, 0.8), rng.choice((0.1, 0.3, 1.0)), 2.7, 1.5)
    return Mover(body, outline=(rng.uniform(4.0, 5.0), rng.uniform(1.6, 1.9)), tyres=tyres)


def drawn(seed: int, count: int = 2) -> dict[str, Mover]:
    """Cars around the middle of the scene."""
    rng = random.Random(seed)
    movers = {}
    for k in range(count):
        angle = 2.0 * math.pi * (k + rng.uniform(-0.2, 0.2)) / count
        away = rng.uniform(5.0, 9.0)
        place = (away * math.cos(angle), away * math.sin(angle))
        movers["ABCD"[k]] = car(rng, place, (rng.uniform(-1, 1), rng.uniform(-1, 1)))
    return movers


def crashes(first: int, count: int, sizes: tuple[int, ...]) -> Iterator[tuple[Any, Scene]]:
    """So many scenes in which some meet, and their movers."""
    seed = first
    while count:
        movers = drawn(seed, sizes[count % len(sizes)])
        crash = crash_of(movers)
        seed += 1
        if crash is not None:
            count -= 1
            yield movers, crash


def crash_of(movers: dict[str, Mover]) -> Scene | None:
    """The scene of all contacts that come; None without any."""
    names = list(movers)
    pairs = [(a, b) for i, a in enumerate(names) for b in names[i + 1 :]]
    while pairs:
        crash = Scene(movers=movers, contacts=[Contact(a, b, **RULE) for a, b in pairs])
        try:
            crash.run()
        except col.NoSolutionError as error:
            if error.code != "contact_missing":
                return None
            pairs.remove(error.fields["movers"])
        except (col.NoImpactError, col.InputError):
            return None
        else:
            return crash
    return None


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_a_scene_is_as_an_independent_integration_has_it(seed: int) -> None:
    movers = drawn(seed)
    contact = Contact("A", "B", **RULE)
    wanted = independent.follow(movers, contact)
    crash = Scene(movers=movers, contacts=[contact])
    if wanted is None:
        with contextlib.suppress(col.NoSolutionError, col.NoImpactError):
            assert crash.run(tolerance=1e-7).deepest[0]
        return
    run = crash.run(tolerance=1e-7)
    assert run.times[0] == pytest.approx(wanted["time"], abs=2e-6)
    impact, other = run.impacts[0], wanted["impact"]
    assert impact.normal == pytest.approx(other.normal, abs=1e-5)
    assert impact.point == pytest.approx(other.point, abs=1e-5)
    assert impact.a.delta_v == pytest.approx(other.a.delta_v, abs=1e-4)
    if len(run.impacts) > 1:
        return
    for name, mover in movers.items():
        rest, place = run.rest[name], wanted["rest"][name]
        way = 1.0 + math.hypot(place[0] - mover.vehicle.x, place[1] - mover.vehicle.y)
        assert math.hypot(rest.x - place[0], rest.y - place[1]) < 2e-3 * way
        assert abs(rest.heading - place[2]) < 5e-3


def straight(seed: int) -> tuple[Pair, float]:
    """Two outlines in even motion that may pass each other closely."""
    rng = np.random.default_rng(seed)
    shapes = [
        Shape.of(Mover(col.Vehicle(mass=1.0), outline=tuple(size)).outline)
        for size in rng.uniform((3.5, 1.4), (6.0, 2.4), (2, 2))
    ]
    begin = np.zeros((2, 6))
    begin[1, :2] = rng.uniform(-8.0, 8.0, 2) + np.sign(rng.uniform(-1, 1, 2)) * 5.0
    begin[:, 2] = rng.uniform(-3.0, 3.0, 2)
    begin[1, 3:5] = -begin[1, :2] / rng.uniform(0.4, 1.0) + rng.uniform(-6.0, 6.0, 2)
    begin[:, 5] = rng.uniform(-3.0, 3.0, 2)

    def states(time: Any, cases: Any) -> tuple[Any, Any]:
        found = []
        for row in begin:
            state = np.repeat(row[:, None], len(time), axis=1)
            state[:3] += time * row[3:, None]
            found.append(state)
        return found[0], found[1]

    return Pair(
        shapes[0], shapes[1], states, lambda cases: (0.0, 0.0, 0.0, 0.0), lambda *_: math.inf
    ), 2.0


@pytest.mark.slow
def test_no_touch_is_missed_and_each_is_when_a_fine_grid_has_it() -> None:
    touched = 0
    for seed in range(80):
        pair, until = straight(seed)
        grid = np.arange(0.0, until, 2.5e-4)
        met, *_ = pair.at(grid, np.zeros(len(grid), dtype=int))
        overlaps = np.flatnonzero(met.gap <= 0.0)
        if met.gap[0] <= 0.0:
            continue
        found = first_touch(pair, np.zeros(1), np.array([until]), np.zeros(1, dtype=int))
        if len(overlaps):
            touched += 1
            at = grid[overlaps[0]]
            assert at - 2.5e-4 - 1e-9 <= found.time[0] <= at + 1e-9
        elif np.isfinite(found.time[0]):
            # A graze between two moments of the grid.
            near, *_ = pair.at(found.time, np.zeros(1, dtype=int))
            assert abs(near.gap[0]) < 1e-8
    assert touched > 25


def polygons(met: Meeting) -> list[list[tuple[float, float]]]:
    return [list(zip(*part[:, :, 0].tolist(), strict=True)) for part in (met.one, met.other)]


def test_overlaps_are_those_of_polygons_cut_edge_by_edge() -> None:
    compared = 0
    for seed in range(400):
        pair, _ = straight(seed)
        time = np.array([np.random.default_rng(seed).uniform(0.2, 1.0)])
        state_a, state_b = pair.states(time, np.zeros(1, dtype=int))
        met = meeting(pair.a, pair.b, state_a, state_b)
        one, other = polygons(met)
        area, centre = independent.area_and_centre(independent.cut(one, other))
        assert (area > 0.0) == (met.gap[0] < 0.0)
        if area > 1e-9:
            compared += 1
            found, size, _ = overlap_of(met.one, met.other)
            assert size[0] == pytest.approx(area, rel=1e-9)
            assert found[:, 0] == pytest.approx(centre, abs=1e-9)
    assert compared > 50


@pytest.mark.slow
def test_overlaps_are_those_of_shapely() -> None:
    """Of outlines that are no rectangles too: area, centre and how far apart they are."""
    shapely = pytest.importorskip("shapely", reason="shapely is not installed (extra: test)")
    compared = 0
    for seed in range(300):
        rng = np.random.default_rng(seed)
        shapes = []
        for _ in range(2):
            turn = np.sort(rng.uniform(0.0, math.tau, rng.integers(3, 9)))
            # Corners on an ellipse, in order, are those of a convex outline.
            corners = np.array([2.4 * np.cos(turn), 0.9 * np.sin(turn)]).T
            hull = shapely.MultiPoint(corners).convex_hull
            if np.diff(turn, append=turn[0] + math.tau).max() > 3.0 or hull.area < 0.5:
                corners = np.array([(2.0, 0.8), (-2.0, 0.8), (-2.0, -0.8), (2.0, -0.8)])
            outline = tuple(map(tuple, corners.tolist()))
            shapes.append(Shape.of(Mover(col.Vehicle(mass=1.0), outline=outline).outline))
        state = np.zeros((2, 6, 1))
        state[:, :3, 0] = rng.uniform(-1.6, 1.6, (2, 3)) * (1.0, 1.0, 2.0)
        met = meeting(shapes[0], shapes[1], state[0], state[1])
        one, other = (shapely.Polygon(part) for part in polygons(met))
        common = one.intersection(other)
        assert (common.area > 0.0) == (met.gap[0] < 0.0)
        if common.area > 1e-6:
            compared += 1
            found, size, _ = overlap_of(met.one, met.other)
            assert size[0] == pytest.approx(common.area, rel=1e-9)
            assert found[:, 0] == pytest.approx((common.centroid.x, common.centroid.y), abs=1e-8)
        elif met.gap[0] > 0.0:
            # The gap along the axes of the faces is no more than the distance.
            assert met.gap[0] <= one.distance(other) + 1e-9
    assert compared > 100


CORNERS = 120


def disc(mass: float, radius: float, x: float, y: float, vx: float) -> Mover:
    """A disc as a polygon of as many corners as make it nearly one."""
    angles = math.tau * (np.arange(CORNERS) + 0.5) / CORNERS
    outline = [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]
    inertia = 0.5 * mass * radius**2
    body = col.Vehicle(mass=mass, yaw_inertia=inertia, x=x, y=y, vx=vx, vy=0.0, heading=0.0)
    return Mover(body, outline=outline)


@pytest.mark.parametrize("aside", [0.0, 0.3, 0.8, 1.3])
@pytest.mark.parametrize(("mass", "restitution"), [(1000.0, 1.0), (2500.0, 0.4)])
def test_frictionless_discs_part_as_in_closed_form(
    aside: float, mass: float, restitution: float
) -> None:
    """Along the line of centres as two points, across it as before; to the angle between two faces
    of the polygons.
    """
    radius, other, speed, start = 0.9, 0.7, 10.0, -6.0
    hit = Contact(
        "A", "B", at="touch", restitution=restitution, friction=0.0, depth=1e-4, model="eccentric"
    )
    movers = {
        "A": disc(1000.0, radius, start, aside, speed),
        "B": disc(mass, other, 0.0, 0.0, 0.0),
    }
    run = Scene(movers=movers, contacts=[hit]).run()
    centres = radius + other
    along = math.sqrt(centres**2 - aside**2)
    near = 2.0 * math.pi / CORNERS
    assert run.times[0] == pytest.approx((-start - along) / speed, abs=near**2 * centres / speed)
    # From A to B.
    normal = np.array([along, -aside]) / centres
    closing = speed * normal[0]
    impulse = (1.0 + restitution) * closing / (1.0 / 1000.0 + 1.0 / mass)
    (impact,) = run.impacts
    for side, size, way in ((impact.a, 1000.0, -1.0), (impact.b, mass, 1.0)):
        wanted = np.array([side.before.vx, side.before.vy]) + way * impulse / size * normal
        found = np.array([side.after.vx, side.after.vy])
        assert found == pytest.approx(wanted, abs=2.0 * near * impulse / size + 1e-9)
        # A face is off the line of centres by its own half at most, which turns the disc.
        lever = near * max(radius, other)
        spin = lever * impulse / side.before.yaw_inertia
        assert abs(side.after.yaw_rate) <= 2.0 * spin
    lost = 0.5 * (1.0 - restitution**2) * closing**2 / (1.0 / 1000.0 + 1.0 / mass)
    before = 0.5 * 1000.0 * speed**2
    assert impact.energy_loss == pytest.approx(lost, abs=4.0 * near * before)


def test_a_head_on_pair_of_discs_is_as_in_closed_form_to_the_digit() -> None:
    """Face to face, where the polygon has the normal of the discs: equal masses trade speeds."""
    hit = Contact("A", "B", at="touch", restitution=1.0, friction=0.0, depth=1e-4)
    movers = {"A": disc(1000.0, 0.9, -6.0, 0.0, 10.0), "B": disc(1000.0, 0.7, 0.0, 0.0, 0.0)}
    run = Scene(movers=movers, contacts=[hit]).run()
    (impact,) = run.impacts
    assert (impact.a.after.vx, impact.b.after.vx) == pytest.approx((0.0, 10.0), abs=1e-9)
    assert (impact.a.after.yaw_rate, impact.b.after.yaw_rate) == pytest.approx((0, 0), abs=1e-9)


def cradle(masses: list[float], speed: float, gaps: list[float], e: float) -> list[float]:
    """Last speeds of a row of bodies of which the first moves, by events one after another."""
    places = np.concatenate([[0.0], np.cumsum(gaps)])
    speeds = np.array([speed, *np.zeros(len(gaps))])
    while True:
        closing = speeds[:-1] - speeds[1:]
        with np.errstate(divide="ignore", invalid="ignore"):
            waits = np.where(closing > 1e-12, np.diff(places) / closing, np.inf)
        if not np.isfinite(waits).any():
            return speeds.tolist()
        i = int(waits.argmin())
        places = places + waits[i] * speeds
        impulse = (1.0 + e) * closing[i] / (1.0 / masses[i] + 1.0 / masses[i + 1])
        speeds[i] -= impulse / masses[i]
        speeds[i + 1] += impulse / masses[i + 1]
        places[i + 1] = places[i] + 1e-13


@pytest.mark.slow
@pytest.mark.parametrize(
    ("masses", "e"),
    [
        ([1000.0] * 5, 1.0),
        ([1600.0, 800.0, 400.0, 200.0], 1.0),
        ([1600.0, 800.0, 400.0, 200.0], 0.7),
        ([1000.0, 500.0, 4000.0], 1.0),
        ([500.0, 1000.0, 2000.0], 0.9),
    ],
)
def test_newtons_cradle_is_as_in_closed_form(masses: list[float], e: float) -> None:
    """Equal masses hand the speed on; falling ones raise it, by 2 m / (m + n) (1 + e) / 2 each."""
    gaps = [0.4 + 0.3 * i for i in range(len(masses) - 1)]
    names = "ABCDE"[: len(masses)]
    places = [0.0, *np.cumsum([4.0 + gap for gap in gaps]).tolist()]
    movers = {
        name: Mover(
            col.Vehicle(mass=mass, vx=9.0 if name == "A" else 0.0, x=x, y=0.0, heading=0.0),
            outline=(4.0, 1.8),
        )
        for name, mass, x in zip(names, masses, places, strict=True)
    }
    rule = {"normal": 0.0, "model": "linear_central", "at": "touch", "restitution": e}
    contacts = [Contact(a, b, **rule) for a, b in itertools.pairwise(names)]
    run = Scene(movers=movers, contacts=contacts).run()
    found = [body.vx for body in run.at(1e4).values()]
    assert found == pytest.approx(cradle(masses, 9.0, gaps, e), abs=1e-6)
    if masses == sorted(masses, reverse=True):
        handed = 9.0
        for one, two in itertools.pairwise(masses):
            handed *= (1.0 + e) * one / (one + two)
        assert max(found) == pytest.approx(handed, rel=1e-9)


def balance(run: Any) -> float:
    energy = run.energy
    left = energy["before"] - sum(energy["contacts"]) - energy["ground"] - energy["left"]
    return float(left / energy["before"])


@pytest.mark.slow
def test_energy_closes_and_every_contact_keeps_momentum() -> None:
    for _, crash in crashes(100, 12, (2, 3, 4)):
        run = crash.run()
        assert abs(balance(run)) < 1e-3
        for before, after in run.momentum:
            size = max(abs(part) for part in before)
            assert after == pytest.approx(before, abs=1e-12 * size)


STATE = ("x", "y", "heading", "vx", "vy", "yaw_rate")


def row_of(body: col.Vehicle) -> Any:
    return np.array([getattr(body, name) for name in STATE])


@pytest.mark.slow
@pytest.mark.parametrize("group", range(GROUPS))
def test_all_ways_of_a_scene_are_as_an_independent_integration_has_them(group: int) -> None:
    """Ten scenes each, of two to four cars with one to many contacts: from every contact to the
    next, and to rest; at every contact what the outlines do, the balance of momentum, and that of
    energy over the whole.
    """
    for movers, crash in crashes(1000 + 100 * group, 10, (2, 3, 4)):
        run = crash.run(tolerance=1e-6)
        # Ten times the tolerance, as ``run`` says.
        assert abs(balance(run)) < 1e-5
        for before, after in run.momentum:
            assert after == pytest.approx(before, abs=1e-12 * max(map(abs, before)))
        for name, mover in movers.items():
            state, begin = row_of(mover.vehicle), 0.0
            for time, pair, impact in zip(run.times, run.pairs, run.impacts, strict=True):
                if name in pair:
                    side = impact.a if name == pair[0] else impact.b
                    way, _ = independent.motion(mover, state, begin, 1e-7)
                    found = row_of(side.before)
                    # A tenth of what ``simulate`` promises of the way.
                    near = 1e-4 * (1.0 + math.hypot(*state[3:]))
                    assert found == pytest.approx(way(time), rel=0, abs=near)
                    state, begin = row_of(side.after), time
            way, end = independent.motion(mover, state, begin, 1e-7)
            rest, place = run.rest[name], way(1e6 if math.isfinite(end) else begin)
            moved = 1.0 + math.hypot(place[0] - state[0], place[1] - state[1])
            assert math.hypot(rest.x - place[0], rest.y - place[1]) < 2e-3 * moved
            assert abs(rest.heading - place[2]) < 5e-3
        for time, (a, b) in zip(run.times, run.pairs, strict=True):
            # The impulse acts 0.03 s after first touch at most.
            there, before = (run.at(max(time - late, 0.0)) for late in (0.0, 0.035))
            gap = max(g for g, _ in independent.gaps(movers[a], movers[b], *states(there, a, b)))
            assert gap <= 1e-8
            if time == run.times[0] and time > 0.035:
                apart = independent.gaps(movers[a], movers[b], *states(before, a, b))
                assert max(g for g, _ in apart) > 0.0


def states(bodies: dict[str, col.Vehicle], a: str, b: str) -> tuple[Any, Any]:
    return row_of(bodies[a]), row_of(bodies[b])


def turned(movers: dict[str, Mover], angle: float) -> dict[str, Mover]:
    """The whole scene turned about the origin."""
    c, s = math.cos(angle), math.sin(angle)
    found = {}
    for name, mover in movers.items():
        v = mover.vehicle
        body = v.replace(
            x=c * v.x - s * v.y,
            y=s * v.x + c * v.y,
            vx=c * v.vx - s * v.vy,
            vy=s * v.vx + c * v.vy,
            heading=math.remainder(v.heading + angle, math.tau),
        )
        found[name] = mover.replace(vehicle=body)
    return found


def mirrored(movers: dict[str, Mover]) -> dict[str, Mover]:
    """The whole scene seen in a mirror along x."""
    found = {}
    for name, mover in movers.items():
        v = mover.vehicle
        body = v.replace(y=-v.y, vy=-v.vy, heading=-v.heading, yaw_rate=-v.yaw_rate)
        found[name] = mover.replace(vehicle=body)
    return found


@pytest.mark.slow
def test_a_scene_does_not_depend_on_axes_mirrors_or_names() -> None:
    for movers, crash in crashes(200, 5, (2, 3)):
        looks_the_same(movers, crash)


def looks_the_same(movers: dict[str, Mover], crash: Scene) -> None:
    """Turned, in a mirror, and by other names in another order."""
    run = crash.run(tolerance=1e-6)
    angle = 0.7
    other = Scene(movers=turned(movers, angle), contacts=list(crash.contacts)).run(tolerance=1e-6)
    mirror = Scene(movers=mirrored(movers), contacts=list(crash.contacts)).run(tolerance=1e-6)
    renamed = dict(reversed([(f"car {name}", mover) for name, mover in movers.items()]))
    contacts = [Contact(f"car {c.b}", f"car {c.a}", **RULE) for c in reversed(crash.contacts)]
    swapped = Scene(movers=renamed, contacts=contacts).run(tolerance=1e-6)
    c, s = math.cos(angle), math.sin(angle)
    for name, mover in movers.items():
        # Rounding takes other steps: as near as ``simulate`` says its places of rest are.
        x, y = run.rest[name].x - mover.vehicle.x, run.rest[name].y - mover.vehicle.y
        near = {"abs": 1e-3 * max(1.0, math.hypot(x, y))}
        rest, there, seen = run.rest[name], other.rest[name], mirror.rest[name]
        assert there.x == pytest.approx(c * rest.x - s * rest.y, **near)
        assert there.y == pytest.approx(s * rest.x + c * rest.y, **near)
        assert (seen.x, -seen.y) == pytest.approx((rest.x, rest.y), **near)
        assert -seen.heading == pytest.approx(rest.heading, **near)
        again = swapped.rest[f"car {name}"]
        assert (again.x, again.y) == pytest.approx((rest.x, rest.y), **near)
    for runs in (other, mirror, swapped):
        assert runs.times == pytest.approx(run.times, abs=1e-4)


def test_one_that_is_thrown_back_at_the_same_moment_is_struck_at_that_moment() -> None:
    """B stands against the heavy C: it is struck, strikes C and is thrown back into A, all at once,
    until they part; speeds by the laws of impact in line, one after another.
    """
    masses, restitution = {"A": 2000.0, "B": 1000.0, "C": 9000.0}, 0.5
    movers = {
        name: Mover(
            col.Vehicle(mass=masses[name], yaw_inertia=2e3, x=x, y=0.0, heading=0.0, vx=vx),
            outline=(4.0, 1.8),
        )
        for name, x, vx in (("A", -6.0, 10.0), ("B", 0.0, 0.0), ("C", 4.0, 0.0))
    }
    central: dict[str, Any] = {
        "restitution": restitution, "model": "linear_central", "at": "touch"
    }  # fmt: skip
    hits = [Contact("A", "B", delay=0.03, **central), Contact("B", "C", normal=0.0, **central)]
    run = Scene(movers=movers, contacts=hits).run()
    speeds, expected = {"A": 10.0, "B": 0.0, "C": 0.0}, []
    while True:
        for one, other in (("A", "B"), ("B", "C")):
            # Of two that are in contact a blow counts from 1 m/s on.
            if speeds[one] - speeds[other] >= 1.0:
                break
        else:
            break
        m, n = masses[one], masses[other]
        pushed = (1.0 + restitution) * (speeds[one] - speeds[other]) / (m + n)
        speeds[one], speeds[other] = speeds[one] - n * pushed, speeds[other] + m * pushed
        expected.append((one, other))
    assert [*run.pairs] == expected
    assert run.times == pytest.approx([0.2 + 0.03] * len(expected), abs=1e-9)
    after = run.at(1.0)
    assert {name: after[name].vx for name in "ABC"} == pytest.approx(speeds, abs=1e-9)
