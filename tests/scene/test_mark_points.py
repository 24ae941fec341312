"""Points of a tyre mark as evidence: distances against brute force on a track made by other code,
and what a posterior and a fit make of them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform, propagate

WHEELS = {
    "front_left": (1.4, 0.76),
    "front_right": (1.4, -0.76),
    "rear_left": (-1.4, 0.76),
    "rear_right": (-1.4, -0.76),
}


def spun(lock: Any = 1.0, **more: Any) -> Scene:
    """A car that turns as it slides."""
    body = {"vx": 14.0, "vy": 2.0, "yaw_rate": 2.5, "heading": 0.3} | more
    car = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, x=3.0, y=1.0, **body)
    return Scene(movers={"A": Mover(car, tyres=Tyres(0.7, lock, 2.8, 1.52))}, contacts=[])


def crash(**changes: Any) -> Scene:
    """Two cars of which both turn after their contact; one rolls on its right wheels."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, x=-2.4, y=0.2, heading=0.0, vx=17.0)
    b = col.Vehicle(
        mass=1250.0, yaw_inertia=1900.0, x=0.9, y=0.8, heading=np.pi / 2, vx=0.0, vy=9.0
    )
    scene = Scene(
        movers={
            "A": Mover(a, tyres=Tyres(0.7, 1.0, 2.8, 1.52)),
            "B": Mover(b, tyres=Tyres(0.7, [1.0, 0.02, 0.5, 0.02], 2.8, 1.52)),
            "C": Mover(a.replace(x=50.0), drag=0.5),
        },
        contacts=[
            Contact("A", "B", restitution=0.1, friction=0.5, normal=0.0, point=(0.0, 0.3)),
        ],
    )
    return scene.replace(changes)


def track_of(scene: Scene, name: str, wheel: str, moments: int = 6001) -> tuple[Any, Any]:
    """Where a wheel goes, from the states at many times, by geometry of this file."""
    run = scene.run()
    ahead, left = WHEELS[wheel]
    places = []
    for time in np.linspace(0.0, run.end, moments):
        car = run.at(time)[name]
        c, s = np.cos(car.heading), np.sin(car.heading)
        places.append((car.x + c * ahead - s * left, car.y + s * ahead + c * left))
    x, y = np.array(places).T
    return x, y


def asked(scene: Scene, paths: Any) -> Any:
    found = scene.as_model([], list(paths))()
    return np.array([distance.m_as("m") for distance in found.values()])


def paths_of(name: str, wheel: str, points: Any) -> list[str]:
    return [f"{name}.marks.{wheel}.distance({x!r}, {y!r})" for x, y in points.tolist()]


@pytest.mark.slow
@pytest.mark.parametrize("wheel", WHEELS)
def test_a_distance_is_that_to_the_nearest_place_of_the_track(wheel: str) -> None:
    """Of a wheel that is locked, which marks all the way; on the side that the next steps of the
    wheel have it on.
    """
    x, y = track_of(spun(), "A", wheel)
    rng = np.random.default_rng(4)
    at = rng.integers(50, len(x) - 1500, 12)
    points = np.array([x[at], y[at]]).T + rng.normal(0.0, 0.3, (12, 2))
    found = asked(spun(), paths_of("A", wheel, points))
    for (px, py), distance in zip(points, found, strict=True):
        apart = np.hypot(x - px, y - py)
        nearest = int(apart.argmin())
        assert abs(distance) == pytest.approx(apart[nearest], abs=4e-3)
        dx, dy = (part[nearest + 1] - part[nearest - 1] for part in (x, y))
        if abs(distance) > 0.02:
            assert (distance > 0.0) == (dx * (py - y[nearest]) - dy * (px - x[nearest]) > 0.0)


def test_beyond_an_end_of_a_mark_the_distance_is_from_that_end() -> None:
    """A car that skids straight on, to where its speed ends."""
    scene = spun(vx=14.0, vy=0.0, yaw_rate=0.0, heading=0.0)
    way = 14.0**2 / (2.0 * 0.7 * col.travel.GRAVITY)
    end, side = 3.0 + 1.4 + way, 1.0 + 0.76
    points = np.array([(4.4 - 3.0, side + 4.0), (end + 0.3, side - 0.4), (9.0, side - 0.1)])
    found = asked(scene, paths_of("A", "front_left", points))
    assert found == pytest.approx([5.0, -0.5, -0.1], rel=1e-6)


@pytest.mark.slow
def test_a_mark_is_where_the_tyre_uses_90_percent_of_the_friction() -> None:
    """On both sides of a contact, and with gaps: against all places of the track that mark."""
    scene = crash()
    run = scene.run()
    rng = np.random.default_rng(2)
    for wheel in WHEELS:
        x, y = run["B"].path.marks[wheel]
        good = np.isfinite(x)
        assert 0 < good.sum() < len(x), wheel
        step = np.nanmax(np.hypot(np.diff(x), np.diff(y)))
        at = rng.choice(np.flatnonzero(good), 6)
        points = np.array([x[at], y[at]]).T + rng.normal(0.0, 1.0, (6, 2))
        found = asked(scene, paths_of("B", wheel, points))
        for (px, py), distance in zip(points, found, strict=True):
            brute = np.nanmin(np.hypot(x - px, y - py))
            assert abs(distance) == pytest.approx(brute, abs=1.5 * step)


@pytest.mark.slow
def test_a_mark_ends_where_the_wheel_leaves_off_and_not_at_the_last_moment_before() -> None:
    """The distance from an end that moves with the speed moves evenly with it."""
    scene = crash()
    x, y = scene.run()["B"].path.marks["front_right"]
    last = np.flatnonzero(np.isfinite(x))[-1]
    path = paths_of("B", "front_right", np.array([[x[last] + 2.0, y[last] + 6.0]]))
    speeds = np.linspace(8.9, 9.1, 41)
    found = scene.as_model(["B.vy"], path)(**{"B.vy": speeds})[path[0]].m_as("m")
    steps = np.abs(np.diff(found))
    assert steps.max() < 0.05


@pytest.mark.slow
@pytest.mark.parametrize("width", [2.0, 1.0, 0.3, 0.04])
def test_a_mark_on_a_strip_of_ice_is_as_long_as_the_strip(width: float) -> None:
    """A brake that 0.3 of the friction holds locks its wheel where there is a seventh of it."""
    ice = [([(30.05, -5), (30.05 + width, -5), (30.05 + width, 5), (30.05, 5)], 0.1)]
    car = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=0.0, y=0.0, heading=0.0, vx=25.0)
    mover = Mover(car, tyres=Tyres(0.7, 0.3, 2.7, 1.5))
    scene = Scene(movers={"A": mover}, contacts=[], surfaces=ice)
    ends = [f"A.marks.front_left.{end}.{axis}" for end in ("begin", "end") for axis in "xy"]
    middle = f"A.marks.front_left.distance({30.05 + 0.5 * width!r} m, 0.85 m)"
    expected = pytest.approx([30.05, 0.75, 30.05 + width, 0.75, 0.1], abs=1e-5)
    assert asked(scene, [*ends, middle]) == expected
    batch = scene.as_model(["A.vx"], [*ends, middle])(**{"A.vx": np.array([24.0, 25.0, 27.0])})
    for case in range(3):
        assert [part.m_as("m")[case] for part in batch.values()] == expected


def used(friction: float, lock: float, wheel: tuple[float, float], car: Any) -> Any:
    """The share of the friction that a wheel uses, and its place, by the law that ``Tyres`` has
    and by geometry of this file: the brake, then Fiala's side force of a cornering of 9.5.
    """
    c, s = np.cos(car.heading), np.sin(car.heading)
    x, y = c * wheel[0] - s * wheel[1], s * wheel[0] + c * wheel[1]
    vx, vy = car.vx - car.yaw_rate * y, car.vy + car.yaw_rate * x
    forward, left = c * vx + s * vy, c * vy - s * vx
    along = min(lock, abs(forward) / np.hypot(forward, left))
    slip = min(1.0, 9.5 * abs(left / forward) / (3.0 * friction))
    across = min(np.sqrt(1.0 - along * along), 1.0 - (1.0 - slip) ** 3)
    return np.hypot(along, across), car.x + x, car.y + y


@pytest.mark.slow
@pytest.mark.parametrize("lock", [0.1, 0.3, 0.6])
def test_a_mark_ends_where_the_use_of_friction_falls_below_90_percent(lock: float) -> None:
    scene = spun(lock, vx=25.0, vy=-3.0, yaw_rate=1.4)
    paths = [f"A.marks.front_left.end.{axis}" for axis in "xy"]
    ends = [one.m_as("m") for one in scene.as_model([], paths, tolerance=1e-9)().values()]
    run = scene.run(tolerance=1e-9)
    times = np.linspace(0.0, 0.98 * run.end, 2001)
    for _ in range(2):
        found = [used(0.7, lock, WHEELS["front_left"], run.at(time)["A"]) for time in times]
        last = int(np.flatnonzero([use >= 0.9 for use, _, _ in found])[-1])
        assert last < len(times) - 1
        times = np.linspace(times[last], times[last + 1], 101)
    assert ends == pytest.approx(found[last][1:], abs=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("model", ["time_resolved", "eccentric"])
@pytest.mark.parametrize("duration", [0.1, 0.2])
def test_wheels_mark_while_a_contact_lasts(duration: float, model: str) -> None:
    """A, with locked wheels, runs into the side of a car on wheels that roll, and pushes it aside
    from where it stands.
    """
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-6.0, y=0.0, heading=0.0, vx=16.0)
    b = col.Vehicle(mass=1200.0, yaw_inertia=2000.0, x=0.85, y=0.0, heading=np.pi / 2)
    movers = {
        "A": Mover(a, outline=(4.6, 1.8), tyres=Tyres(0.7, 1.0, 2.7, 1.5)),
        "B": Mover(b, outline=(4.4, 1.7), tyres=Tyres(0.7, 0.02, 2.7, 1.5)),
    }
    hit = Contact(
        "A", "B", restitution=0.15, friction=0.5, at="touch", duration=duration, model=model
    )
    scene = Scene(movers=movers, contacts=[hit])
    run = scene.run()
    places = []
    for part in (0.2, 0.5, 0.8):
        car = run.at(run.times[0] + part * duration)["A"]
        c, s = np.cos(car.heading), np.sin(car.heading)
        places.append((car.x + 1.35 * c - 0.75 * s, car.y + 1.35 * s + 0.75 * c))
    found = asked(scene, paths_of("A", "front_left", np.array(places)))
    assert found == pytest.approx(0.0, abs=2e-3)
    begin = asked(scene, ["B.marks.front_left.begin.x", "B.marks.rear_right.begin.x"])
    assert begin == pytest.approx([0.1, 1.6], abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("case", range(3))
def test_a_batch_has_the_distances_of_its_cases(case: int) -> None:
    scene = crash()
    points = np.array([(3.0, 4.0), (5.0, 2.0)])
    paths = [path for wheel in WHEELS for path in paths_of("B", wheel, points)]
    speeds = np.array([12.0, 17.0, 21.0])
    many = scene.as_model(["A.vx"], paths)(**{"A.vx": speeds})
    alone = asked(scene.replace({"A.vx": speeds[case]}), paths)
    found = np.array([many[path].m_as("m")[case] for path in paths])
    assert found == pytest.approx(alone, abs=1e-6)


@pytest.mark.slow
def test_wheels_that_leave_no_mark_have_no_distance() -> None:
    """One case is an error, and a batch NaN; where another contact gives tyres, they mark."""
    rolling = spun(lock=0.1, vx=10.0, vy=0.0, yaw_rate=0.0, heading=0.0)
    path = "A.marks.rear_left.distance(5 m, 2 m)"
    with pytest.raises(col.NoSolutionError, match="the rear left wheel of A leaves no mark: all"):
        asked(rolling, [path])
    found = rolling.as_model(["A.tyres.lock"], [path])(**{"A.tyres.lock": np.array([0.1, 1.0])})
    distances = found[path].m_as("m")
    assert np.isnan(distances[0])
    assert distances[1] == pytest.approx(2.0 - (1.0 + 0.76), abs=1e-6)
    with pytest.raises(col.NoSolutionError, match="leaves no mark"):
        reconstruct.posterior(
            rolling, {"A.vx": Uniform(8.0, 12.0)}, {path: Normal(0.0, 0.1)}, samples=512, seed=1
        )


def test_a_wheel_marks_with_the_tyres_that_a_contact_gives() -> None:
    a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, x=-2.0, y=0.0, heading=0.0, vx=15.0)
    b = a.replace(x=2.5, vx=0.0)
    hit = Contact(
        "A",
        "B",
        restitution=0.1,
        normal=0.0,
        model="linear_central",
        tyres_after={"B": Tyres(0.7, 1.0, 2.8, 1.52)},
    )
    scene = Scene(movers={"A": Mover(a, drag=0.5), "B": Mover(b)}, contacts=[hit])
    assert asked(scene, ["B.marks.front_right.distance(5, -0.86)"]) == pytest.approx([-0.1])
    with pytest.raises(col.MissingInputError, match="A leaves no marks, as it has no tyres"):
        scene.mark_points("A", "front_left", [(1.0, 1.0)], 0.1)


@pytest.mark.parametrize(
    ("given", "kind", "says"),
    [
        (
            ("D", "front_left", [(1, 2)], 0.1),
            col.InputError,
            "no vehicle 'D'; write one of A, B, C",
        ),
        (("C", "front_left", [(1, 2)], 0.1), col.MissingInputError, "C leaves no marks"),
        (("A", "left", [(1, 2)], 0.1), col.InputError, "no wheel 'left'; write one of front_left"),
        (("A", 0, [(1, 2)], 0.1), col.InputError, "no wheel 0; write one of front_left"),
        (("A", "front_left", [], 0.1), col.ShapeError, "one or more pairs"),
        (("A", "front_left", 3.0, 0.1), col.ShapeError, "one or more pairs"),
        (("A", "front_left", np.zeros((2, 3)), 0.1), col.ShapeError, r"array of shape \(2, 3\)"),
        (("A", "front_left", [1.0, 2.0], 0.1), col.ShapeError, r"points\[0\] must be a pair"),
        (("A", "front_left", [(1, 2, 3)], 0.1), col.ShapeError, r"points\[0\] must be a pair"),
        (("A", "front_left", [(1, 2), (1, [2, 3])], 0.1), col.InputError, r"points\[1\]"),
        (("A", "front_left", [(1, "2 kg")], 0.1), col.InputError, r"points\[0\]\[1\]"),
        (("A", "front_left", [(1, 2), (3, 4), (1, 2)], 0.1), col.InputError, "is points.0. again"),
        (("A", "front_left", [(1, 2)], 0.0), col.InputError, "error must be > 0"),
        (("A", "front_left", [(1, 2)], np.ones(2)), col.ShapeError, "error must be one number"),
        (("A", "front_left", [(1, 2)], "3 s"), col.InputError, "error"),
        ((["A"], "front_left", [(1, 2)], 0.1), col.InputError, "no vehicle"),
    ],
)
def test_evidence_that_cannot_be_is_refused(given: Any, kind: type, says: str) -> None:
    with pytest.raises(kind, match=says):
        crash().mark_points(*given)


@pytest.mark.parametrize(
    ("path", "says"),
    [
        ("A.marks", "of a mark there are begin.x, begin.y, end.x"),
        ("A.marks.front_left", "of a mark there are begin.x, begin.y, end.x"),
        ("A.marks.front_left.distance(1)", "of a mark there are begin.x"),
        ("A.marks.front_left.distance(1, 2, 3)", "of a mark there are begin.x"),
        ("A.marks.third.distance(1, 2)", "outputs has no wheel 'third'"),
        ("A.marks.front_left.distance(1, 2 kg)", "y"),
        ("A.marks.front_left.distance(1, nan)", "y"),
        ("C.marks.front_left.distance(1, 2)", "C leaves no marks"),
        ("D.marks.front_left.distance(1, 2)", "near it are"),
    ],
)
def test_a_path_to_a_mark_that_is_none_is_refused(path: str, says: str) -> None:
    with pytest.raises(col.InputError, match=says):
        crash().as_model([], [path])


def test_ends_of_a_mark_are_said_by_true_or_false() -> None:
    scene = crash()
    with pytest.raises(col.InputError, match="begins must be True or False, got 1"):
        scene.mark_points("A", "front_left", [(1, 2)], 0.1, begins=1)  # type: ignore[arg-type]
    with pytest.raises(col.ShapeError, match="cannot both begin and end; give two or more"):
        scene.mark_points("A", "front_left", [(1, 2)], 0.1, begins=True, ends=True)


@pytest.mark.slow
def test_where_a_mark_begins_and_ends_is_compared_by_both_coordinates() -> None:
    scene = crash()
    points = [("10 ft", 2), (3, 4), (5, 6)]
    seen = scene.mark_points("B", "front_left", points, "0.1 m", begins=True, ends=True)
    mark = "B.marks.front_left"
    assert list(seen) == [
        f"{mark}.begin.x",
        f"{mark}.begin.y",
        f"{mark}.distance(3.0 m, 4.0 m)",
        f"{mark}.end.x",
        f"{mark}.end.y",
    ]
    assert seen[f"{mark}.begin.x"].mean == pytest.approx(3.048)
    assert seen[f"{mark}.end.y"].mean == 6.0
    found = dict(zip(seen, asked(scene, seen), strict=True))
    x, y = track_of(scene, "B", "front_left", 101)
    begin, end = (
        (found[f"{mark}.{part}.x"], found[f"{mark}.{part}.y"]) for part in ("begin", "end")
    )
    assert begin == pytest.approx((x[0], y[0]), abs=1e-9)
    assert end == pytest.approx((x[-1], y[-1]), abs=1e-3)


@pytest.mark.slow
def test_a_mark_with_gaps_begins_with_its_first_piece_and_ends_with_its_last() -> None:
    """Of many cases, of which some leave none; against the marks of the runs."""
    scene = crash()
    paths = [f"B.marks.front_right.{part}.{axis}" for part in ("begin", "end") for axis in "xy"]
    values = {"A.vx": np.array([12.0, 17.0, 21.0])}
    found = scene.as_model(["A.vx"], paths)(**values)
    for case, speed in enumerate(values["A.vx"]):
        x, y = scene.replace({"A.vx": speed}).run()["B"].path.marks["front_right"]
        good = np.flatnonzero(np.isfinite(x))
        step = np.nanmax(np.hypot(np.diff(x), np.diff(y)))
        for part, at in (("begin", good[0]), ("end", good[-1])):
            px, py = (found[f"B.marks.front_right.{part}.{axis}"].m_as("m")[case] for axis in "xy")
            assert np.hypot(px - x[at], py - y[at]) <= 1.5 * step


@pytest.mark.slow
def test_points_may_have_units_or_be_an_array() -> None:
    scene = crash()
    texts = scene.mark_points("A", "front_left", [("10 ft", "2.5 m")], "1 ft")
    assert list(texts) == ["A.marks.front_left.distance(10 ft, 2.5 m)"]
    assert next(iter(texts.values())).sd == pytest.approx(0.3048)
    ureg = pint.get_application_registry()
    whole = scene.mark_points("A", "front_left", ureg.Quantity([[10.0, 2.0]], "ft"), "0.1 m")
    assert asked(scene, whole) == pytest.approx(
        asked(scene, ["A.marks.front_left.distance(10 ft, 2 ft)"]), abs=1e-9
    )
    plain = scene.mark_points("A", "front_left", np.array([[3.0, 2.5]]), 0.1)
    assert list(plain) == ["A.marks.front_left.distance(3.0 m, 2.5 m)"]


@pytest.mark.slow
def test_a_distance_is_a_result_wherever_one_is_asked_for() -> None:
    scene = crash()
    path = "B.marks.front_left.distance(4 m, 4 m)"
    found = propagate(scene, {"A.vx": Normal(17.0, 0.5)}, outputs=[path], samples=256, seed=1)
    assert found[path].unit == "m"
    assert found[path].std > 0.0
    assert found.failed == 0
    # By drag no wheel leaves a mark, so that level never does.
    levels = scene.required({path: "0.5 m"})
    assert np.isinf(levels.costs[0].differences[path])
    assert levels.finest.motion == "wheels"


def surveyed(scene: Scene, sigma: float, seed: int) -> dict[str, Normal]:
    """Points of two marks with noise, of which the last are their ends."""
    rng = np.random.default_rng(seed)
    found: dict[str, Normal] = {}
    for wheel in ("front_left", "rear_right"):
        x, y = track_of(scene, "A", wheel, 1001)
        at = np.linspace(0, 1000, 6).astype(int)
        points = np.array([x[at], y[at]]).T + rng.normal(0.0, sigma, (6, 2))
        found |= scene.mark_points("A", wheel, points, sigma, ends=True)
    return found


@pytest.mark.slow
def test_fit_finds_the_speed_that_left_the_marks() -> None:
    """Of a car that slides straight on, whose way from its speed is known in closed form."""
    scene = spun(vy=0.0, yaw_rate=0.0, heading=0.2)
    found = reconstruct.fit(scene, {"A.vx": 11.0}, surveyed(scene, 0.05, 3))["A.vx"]
    # Two ends, each to 0.05 m, of a way that grows by v / (friction g) a m/s.
    slope = 14.0 / (0.7 * col.travel.GRAVITY)
    assert found.standard_error == pytest.approx(0.05 / np.sqrt(2.0) / slope, rel=0.02)
    assert abs(found.value - 14.0) < 3.0 * found.standard_error


@pytest.mark.slow
def test_a_posterior_finds_the_motion_that_left_the_marks() -> None:
    """Of a car alone, from two marks with their ends."""
    scene = spun()
    priors = {
        "A.vx": Uniform(8.0, 25.0),
        "A.vy": Uniform(-4.0, 8.0),
        "A.yaw_rate": Uniform(-5.0, 5.0),
    }
    found = reconstruct.posterior(scene, priors, surveyed(scene, 0.1, 7), samples=512, seed=1)
    for path, true in {"A.vx": 14.0, "A.vy": 2.0, "A.yaw_rate": 2.5}.items():
        low, high = found[path].interval(0.99)
        assert low < true < high, path
        assert found[path].std < 0.2, path
    assert found.p_value > 0.01
