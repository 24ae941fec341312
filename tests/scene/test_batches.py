"""Cases of a batch of scenes against the same cases alone: order, times, impacts and places of
rest.
"""

from __future__ import annotations

import math
import re
import warnings
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Scene
from collisions.scene.names import inputs_of
from collisions.travel import Tyres, following
from collisions.uncertainty import Normal, propagate

COUNT = 24
RULE = {"restitution": 0.3, "friction": 0.5, "at": "touch"}


def driven(
    rng: np.random.Generator, x: float, y: float, speed: float, course: float, spread: float
) -> col.Vehicle:
    """A vehicle near a place in many cases, at speeds and courses that differ."""
    speeds = speed * rng.uniform(1.0 - spread, 1.0 + spread, COUNT)
    courses = course + rng.normal(0.0, 0.1, COUNT)
    return col.Vehicle(
        mass=rng.uniform(1000.0, 2000.0, COUNT),
        yaw_inertia=rng.uniform(1500.0, 3000.0, COUNT),
        x=x + rng.normal(0.0, 0.2, COUNT),
        y=y + rng.normal(0.0, 0.3, COUNT),
        vx=speeds * np.cos(courses),
        vy=speeds * np.sin(courses),
        heading=course + rng.normal(0.0, 0.05, COUNT),
        yaw_rate=rng.normal(0.0, 0.3, COUNT) * (speed > 0.0),
    )


def crash(seed: int) -> Scene:
    """Three cars that slide, in many cases; the second stands or drives across."""
    rng = np.random.default_rng(seed)

    def car(*place: float) -> Mover:
        body = driven(rng, *place)
        return Mover(body, outline=(4.5, 1.8), drag=rng.uniform(0.3, 0.7, COUNT))

    movers = {
        "A": car(-9.0, 0.0, 18.0, 0.0, 0.3),
        "B": car(0.0, 0.0, 0.0, 0.0, 0.0),
        "C": car(7.0, -5.0, 6.0, 0.5 * math.pi, 0.4),
    }
    return Scene(movers=movers, contacts=[Contact("A", "B", **RULE), Contact("B", "C", **RULE)])


Pairs = Sequence[tuple[str, str]]


def of_pair(pairs: Pairs, k: int) -> tuple[tuple[str, str], int]:
    """Whose impact the k-th is, and which of those two."""
    return pairs[k], list(pairs[:k]).count(pairs[k])


def usual_pairs(every: list[Pairs]) -> list[tuple[str, str]]:
    """Whose impact comes next in most of the cases that went like most so far."""
    usual: list[tuple[str, str]] = []
    like = every
    while longer := [pairs for pairs in like if len(pairs) > len(usual)] or [
        pairs for pairs in every if len(pairs) > len(usual)
    ]:
        k = len(usual)
        counts = Counter(pairs[k] for pairs in longer)
        usual.append(max(sorted(counts), key=counts.__getitem__))
        like = [pairs for pairs in longer if pairs[k] == usual[k]]
    return usual


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("seed", range(3))
def test_every_case_of_a_batch_is_as_it_is_alone(seed: int) -> None:
    scene = crash(seed)
    run = scene.run()
    columns = run.to_columns()
    alone = {i: scene.case(i).run() for i in range(COUNT) if run.status[i] == "ok"}
    usual = usual_pairs([one.pairs for one in alone.values()])
    for i in range(COUNT):
        label = run.status[i]
        if label != "ok":
            with pytest.raises(col.CollisionsError) as refused:
                scene.case(i).run()
            assert refused.value.code == label
            assert math.isnan(columns["A.rest.x"][i])
            continue
        one = alone[i]
        for path, value in one.to_columns().items():
            if path == "status":
                continue
            number = re.match(r"(?:impacts|times)\[(\d+)\]", path)
            words = path.endswith(".status")
            # In a column of impacts by number stands the one that most cases have there.
            if number and of_pair(one.pairs, int(number[1])) != of_pair(usual, int(number[1])):
                assert columns[path][i] == "" if words else math.isnan(columns[path][i]), path
                continue
            if words:
                assert columns[path][i] == value[0]
                continue
            assert columns[path][i] == pytest.approx(value[0], rel=1e-9, abs=1e-9, nan_ok=True), (
                path
            )
        assert [bool(deep[i]) for deep in run.deepest[: len(one.times)]] == [*one.deepest]
        assert [time[i] for time in run.times[: len(one.times)]] == pytest.approx(
            one.times, abs=1e-12
        )
    assert len({one.pairs for one in alone.values()}) > 1


@pytest.mark.slow
def test_all_places_of_rest_are_followed_at_once_and_are_those_of_each_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    wheels = Tyres(0.7, [1.0, 0.1, 0.1, 0.1], 2.78, 1.55)
    a = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, x=-2.3, y=0.0, heading=0.0, vx=14.0, vy=0.0)
    b = col.Vehicle(mass=1200.0, yaw_inertia=1700.0, x=0.9, y=-0.6, heading=1.5, vx=0.0, vy=9.0)
    scene = Scene(
        movers={"A": Mover(a, tyres=wheels), "B": Mover(b, tyres=wheels)},
        contacts=[Contact("A", "B", restitution=0.1, friction=0.5, normal=0.0, point=(0.0, -0.2))],
    )
    calls: list[int] = []

    def counted(motion: Any, *given: Any) -> Any:
        calls.append(motion.start.shape[1])
        return follow(motion, *given)

    follow = following.follow
    monkeypatch.setattr(following, "follow", counted)
    speeds = {"A.vx": np.linspace(8.0, 20.0, 60)}
    paths = [f"{name}.rest.{part}" for name in "AB" for part in ("x", "y", "heading")]
    both = scene.as_model(["A.vx"], paths)(**speeds)
    assert calls == [120]
    for path in paths:
        # Of one alone the other is not followed.
        calls.clear()
        alone = scene.as_model(["A.vx"], [path])(**speeds)
        np.testing.assert_array_equal(alone[path].magnitude, both[path].magnitude)
        assert calls == [60]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize(
    ("seed", "duration", "cases"),
    # Among them some in which last digits of a contact grew: where steps ended at an edge, and
    # where wheels nearly stood or rolled.
    [
        pytest.param(0, 0.1, [3, 8, 21], marks=pytest.mark.slow),
        (1, None, [5, 7, 18]),
        pytest.param(1, 0.1, [8, 10], marks=pytest.mark.slow),
        pytest.param(2, None, [14, 20], marks=pytest.mark.slow),
    ],
)
def test_over_areas_a_case_of_a_batch_rests_where_it_does_alone(
    seed: int, duration: float | None, cases: list[int]
) -> None:
    """Cars that turn, struck one after another, and cross edges of two areas obliquely."""
    rng = np.random.default_rng(seed)

    def car(*place: float, lock: Any) -> Mover:
        body = driven(rng, *place)
        tyres = Tyres(rng.uniform(0.5, 0.8, COUNT), lock, 2.7, 1.5)
        return Mover(body, outline=(4.5, 1.8), tyres=tyres)

    movers = {
        "A": car(-9.0, 0.0, 18.0, 0.0, 0.3, lock=[1.0, 0.1, 0.1, 0.1]),
        "B": car(0.0, 0.0, 0.0, 0.0, 0.0, lock=1.0),
        "C": car(7.0, -5.0, 6.0, 0.5 * math.pi, 0.4, lock=0.3),
    }
    surfaces = [
        ([(3, -6), (9, -8), (10, 4), (4, 9)], 0.25),
        ([(-1, 3), (20, 7), (18, 14), (0, 12)], rng.uniform(0.2, 0.5, COUNT)),
    ]
    contacts = [Contact(*pair, **RULE, duration=duration) for pair in ("AB", "BC")]
    scene = Scene(movers=movers, contacts=contacts, surfaces=surfaces)
    run = scene.run()
    for i in cases:
        alone = scene.case(i).run()
        for name in movers:
            for part in ("x", "y", "heading"):
                found = getattr(run.rest[name], part)[i]
                assert abs(found - getattr(alone.rest[name], part)) <= 1e-9, (i, name, part)


@pytest.mark.slow
def test_cars_that_stop_on_an_edge_do_so_in_a_batch_and_alone() -> None:
    """Straight, and turning onto it; some up to the last digits before or beyond it."""
    friction, speed, edge = 0.7, 12.0, 1.35
    way = speed**2 / (2.0 * col.travel.GRAVITY * friction)
    # Where front wheels of a car come to rest at the end of a straight slide.
    place = -way - np.array([0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-3, -1e-3] * 2)
    turns = np.repeat([0.0, 0.6], 9)
    body = col.Vehicle(
        mass=1400.0, yaw_inertia=2200.0, x=place, y=0.0, heading=0.0, vx=speed, vy=0.0,
        yaw_rate=turns,
    )  # fmt: skip
    scene = Scene(
        movers={"A": Mover(body, tyres=Tyres(friction, 1.0, 2.0 * edge, 1.5))},
        contacts=[],
        surfaces=[([(edge, -9), (30, -9), (30, 9), (edge, 9)], 0.2)],
    )
    run = scene.run()
    for i, turning in enumerate(turns):
        alone = scene.case(i).run().rest["A"]
        for part in ("x", "y", "heading"):
            assert abs(getattr(run.rest["A"], part)[i] - getattr(alone, part)) <= 1e-9, (i, part)
        if not turning:
            beyond = max(place[i] + way, 0.0)
            # The front wheels, with half of the load, are on the slippery side for what is left.
            longer = beyond * (friction / (0.5 * friction + 0.5 * 0.2) - 1.0)
            assert alone.x - place[i] - way == pytest.approx(longer, abs=2e-5)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("rules", [slice(0, 1), slice(1, 2), slice(0, 0)], ids=["AB", "BC", "none"])
def test_what_limits_a_case_is_that_of_the_case_alone(rules: slice) -> None:
    """Touches that no contact describes or that are passed over, and what is driven together."""
    for seed in range(2):
        whole = crash(seed)
        scene = Scene(movers=whole.movers, contacts=whole.contacts[rules])
        run = scene.run()
        found = run._followed.told
        for i in np.flatnonzero(run.status == "ok").tolist():
            codes = [one.code for one in scene.case(i).run().findings]
            assert found.undescribed[i] == ("touch_without_contact" in codes)
            assert found.passed_over[i] == ("touch_passed_over" in codes)
            assert found.driven[i] == any(code.startswith("driven") for code in codes)


@pytest.mark.slow
def test_what_an_impact_warns_of_is_counted_by_the_cases_of_a_study() -> None:
    """Cases of a scene come to their second and third impact in parts of their own."""
    asked: list[dict[str, Any]] = []

    def in_line(speed: Any, first: Any, second: Any) -> Scene:
        movers = {
            name: Mover(
                col.Vehicle(mass=1500, yaw_inertia=2500, vx=vx, x=x, y=y, heading=0.0),
                outline=(4.5, 1.8),
                drag=0.5,
            )
            for name, vx, x, y in (("A", speed, -6.0, 0.3), ("B", 0, 0, 0), ("C", 0, 7, -0.4))
        }
        rules = (("A", "B", first), ("B", "C", second))
        return Scene(
            movers=movers,
            contacts=[
                Contact(a, b, at="touch", restitution=0.2, impulse_ratio=ratio)
                for a, b, ratio in rules
            ],
        )

    def model(**values: Any) -> dict[str, Any]:
        if np.size(values["speed"]) > 4:  # fewer are asked again as a check
            asked.append(values)
        return {"rest": in_line(**values).run().rest["C"].x}

    spread = {"speed": Normal(15.0, 2.0), "first": Normal(0.0, 0.5), "second": Normal(0.0, 0.5)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        found = propagate(model, spread, samples=64, seed=1)
    (values,) = asked
    gains = 0
    for case in zip(*values.values(), strict=True):
        with warnings.catch_warnings(record=True) as caught, suppress(col.CollisionsError):
            warnings.simplefilter("always")
            in_line(**dict(zip(values, map(float, case), strict=True))).run()
        gains += any(one.category is col.EnergyGainWarning for one in caught)
    (note,) = [one for one in found.notes if one.code == "energy_gain"]
    assert note.fields["cases"] == gains > 32
    assert note.statement.startswith(f"{gains} of 64 cases (")


@pytest.mark.parametrize("lock", ["one", "each"])
def test_a_lock_that_cannot_be_leaves_a_case_without_an_answer(lock: str) -> None:
    """Beyond 0 to 1 or not known: alone it is refused, and it is not at rest where it started."""
    locks = np.array([0.5, 1.2, -0.1, 1.0, math.nan])
    tyres = Tyres(0.7, 1.0 if lock == "one" else [1.0] * 4, 2.62, 1.48)
    body = col.Vehicle(mass=1250, yaw_inertia=1900, x=0.0, y=0.0, heading=math.pi / 2, vy=9.0)
    scene = Scene(movers={"B": Mover(body, tyres=tyres)}, contacts=[])
    paths = ["B.tyres.lock"] if lock == "one" else [f"B.tyres.lock[{i}]" for i in range(4)]
    with pytest.warns(col.CollisionsWarning, match="3 of 5 cases"):
        run = scene.replace(dict.fromkeys(paths, locks)).run()
    codes = ["ok", "bad_fraction", "bad_fraction", "ok", "not_finite"]
    assert list(run.status) == codes
    assert np.isnan(run["B"].rest.y).tolist() == [code != "ok" for code in codes]
    # Locked wheels: v^2 / (2 mu g).
    assert run["B"].rest.y[3] == pytest.approx(9.0**2 / (2.0 * 0.7 * 9.80665), rel=1e-3)
    with pytest.raises(col.InputError, match="from 0 to 1, got"):
        scene.replace(dict.fromkeys(paths, 1.2))


SPOILT = (math.nan, math.inf, -math.inf, -1.0)


def spoilt() -> dict[str, Scene]:
    """Scenes with every kind of input: touch, tyres before and after, time, areas and a slope."""
    a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-8, y=0.2, heading=0.1, vx=14, vy=0.5,
                    yaw_rate=0.1)  # fmt: skip
    b = a.replace(mass=1250, yaw_inertia=1900, x=0, y=-1, heading=1.5, vx=0.3, vy=9)
    c = a.replace(mass=1600, x=9, y=5, heading=2, vx=-1, vy=-1)
    wheels, rolling = (
        Tyres(0.7, [1, 0.5, 0, 0], 2.62, 1.48, steer=0.05, height=0.5),
        Tyres(0.7, 0.4, 2.62, 1.48),
    )
    long, rule = (4.5, 1.8), {"restitution": 0.1, "friction": 0.5}
    cars = {"A": Mover(a, outline=long, tyres=wheels), "B": Mover(b, outline=long, tyres=rolling)}
    by_time = {"at": 0.4, "normal": 0.1, "point": (-1.5, 0.0)}
    area = [((0, -5), (5, -5), (5, 5), (0, 5)), 0.3]
    return {
        "touch": Scene(
            movers=cars | {"C": Mover(c, outline=long, drag=0.5)},
            contacts=[Contact("A", "B", at="touch", delay=0.02, **rule)],
        ),
        "time": Scene(
            movers={"A": Mover(a, tyres=wheels), "B": Mover(b, drag=0.6)},
            contacts=[Contact("A", "B", **by_time, **rule)],
        ),
        "lasting": Scene(
            movers=cars,
            contacts=[Contact("A", "B", at="touch", duration=0.1, **rule)],
            slope=(0.02, 0.01),
        ),
        "area": Scene(movers={"A": Mover(a, tyres=rolling)}, contacts=[], surfaces=[tuple(area)]),
    }


def number_at(scene: Scene, path: str) -> float:
    """The number of an input, by its path, which is written as in Python."""
    owners: dict[str, Any] = {"contacts": scene.contacts, "slope": scene.slope}
    owners["surfaces"] = [friction for _, friction in scene.surfaces]
    for name, mover in scene.movers.items():
        body = {part: getattr(mover.vehicle, part) for part in mover.vehicle.__slots__}
        owners[name] = SimpleNamespace(**body, tyres=mover.tyres, drag=mover.drag)
    return float(eval(path, owners))


@pytest.mark.slow
@pytest.mark.parametrize("name", spoilt())
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_what_a_single_scene_refuses_has_no_answer_in_a_batch(name: str) -> None:
    """Every input with values that cannot be, or only just, each in a case of its own."""
    scene = spoilt()[name]
    # Polar ones are those of the velocities once more, and the normal is an angle of a tuple.
    paths = [
        path for path in inputs_of(scene) if not path.endswith((".speed", ".course", ".normal"))
    ]
    pairs = [(path, value) for path in paths for value in SPOILT]
    columns = {
        path: np.array([value if of == path else number_at(scene, path) for of, value in pairs])
        for path in paths
    }
    status = scene.replace(columns).run().status
    refused = 0
    for (path, value), code in zip(pairs, status, strict=True):
        try:
            scene.replace({path: value})
        except col.CollisionsError:
            assert code != "ok", (path, value)
            refused += 1
    assert refused > 20
    assert np.count_nonzero(status == "ok") > 5
