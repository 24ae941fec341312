"""Curves of recorders in a scene against the motion of their places, added up independently; as
evidence; and what is refused.
"""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, propagate

WHEELS = Tyres(0.7, [1.0, 0.1, 0.1, 0.1], 2.7, 1.5)
HIT = {"restitution": 0.1, "friction": 0.5, "duration": 0.12}
PLACES = {"A": (0.5, 0.2), "B": (0.4, -0.3)}
TIMES = (0.02, 0.05, 0.075, 0.1)


def crash(**changes: Any) -> Scene:
    """A drives into the side of B, which both then turn fast."""

    def car(**given: Any) -> col.Vehicle:
        usual = {"mass": 1500.0, "yaw_inertia": 2400.0, "y": 0.0, "heading": 0.0, "vx": 0.0}
        return col.Vehicle(**(usual | {"vy": 0.0} | given))

    a = car(x=-8.0, y=0.9, vx=16.0, yaw_rate=0.4)
    b = car(x=0.9, vy=7.0, heading=1.45)
    movers = {
        "A": Mover(a, outline=(4.0, 1.8), tyres=WHEELS),
        "B": Mover(b, outline=(4.4, 1.8), tyres=WHEELS),
    }
    return Scene(movers=movers, contacts=[Contact("A", "B", at="touch", **(HIT | changes))])


@pytest.mark.slow
def test_a_bare_time_in_a_path_is_warned_of_once() -> None:
    """Where the path is read, and not again whenever it is looked at or worked out."""
    asked = "contacts[0].impact.B.recorded(40).forward"
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = propagate(crash(), {"A.vx": Normal(16.0, 0.5)}, outputs=[asked], samples=64, seed=1)
    (one,) = [one.message for one in caught if one.category is col.SuspectUnitsWarning]
    assert "write '40 ms'" in str(one)
    assert not any("time" in one for one in found.statements)


def path(name: str, time: float, part: str) -> str:
    ahead, left = PLACES[name]
    return f"contacts[0].impact.{name}.recorded({1e3 * time:g} ms, {ahead} m, {left} m).{part}"


def added_up(run: Any, name: str) -> dict[float, tuple[float, float]]:
    """What accelerometers at the place of a recorder add up to, in the axes of the car: the
    acceleration of the centre of mass, turned by the yaw since first contact; what the place gains
    as the yaw rate changes; and its centripetal acceleration.
    """
    (ahead, left), side, pulse = PLACES[name], name.lower(), run.impacts[0].pulse
    curves = (getattr(pulse, f"{part}_{side}") for part in ("delta_v_forward", "delta_v_left"))
    step = 1e-6
    clock = np.arange(0.0, max(TIMES) + step, step)
    forward, aside = (np.gradient(np.interp(clock, pulse.time, one), step) for one in curves)
    rate = np.interp(clock, pulse.time, getattr(pulse, f"yaw_rate_{side}"))
    faster = np.gradient(rate, step)
    turned = np.cumsum(rate) * step
    c, s = np.cos(turned), np.sin(turned)
    along = c * forward + s * aside - faster * left - rate**2 * ahead
    across = c * aside - s * forward + faster * ahead - rate**2 * left
    shown = [np.cumsum(one) * step for one in (along, across)]
    return {t: tuple(float(np.interp(t, clock, one)) for one in shown) for t in TIMES}


@pytest.mark.slow
def test_a_sample_is_what_accelerometers_at_the_place_of_the_recorder_add_up_to() -> None:
    run = crash().run()
    paths = [path(name, t, part) for name in PLACES for t in TIMES for part in ("forward", "left")]
    values = crash().as_model([], paths)()
    most = 0.0
    for name in PLACES:
        expected = added_up(run, name)
        for time in TIMES:
            found = [values[path(name, time, part)].m_as("m/s") for part in ("forward", "left")]
            assert found == pytest.approx(expected[time], abs=2e-4), (name, time)
            centre = getattr(run.impacts[0], name.lower()).recorded(time)
            most = max(most, math.dist(found, centre))
    assert most > 0.5  # m/s, from where the recorders sit


@pytest.mark.slow
def test_samples_are_those_of_the_impact_and_of_cases_of_a_batch() -> None:
    speeds = np.array([12.0, 16.0, 13.0])
    paths = [path("B", time, "left") for time in TIMES]
    paths.append("impacts[0].a.recorded(0.05).forward")
    paths.append("contacts[0].impact.A.recorded(0.05).forward")
    model = crash().as_model(["A.vx"], paths)
    many = model(**{"A.vx": speeds})
    for i, speed in enumerate(speeds):
        run = crash().replace({"A.vx": speed}).run()
        impact = run.impacts[0]
        _, left = impact.b.recorded(np.array(TIMES), forward=0.4, left=-0.3)
        expected = [*left, *[impact.a.recorded(0.05)[0]] * 2]
        alone = model(**{"A.vx": float(speed)})
        for one, value in zip(paths, expected, strict=True):
            assert alone[one].m_as("m/s") == pytest.approx(value, abs=1e-12)
            assert many[one].m_as("m/s")[i] == pytest.approx(value, abs=1e-9)


@pytest.mark.slow
def test_samples_of_a_curve_are_evidence_of_speeds_and_of_the_duration() -> None:
    true = {"A.vx": 14.0, "contacts[0].duration": 0.1}
    paths = [path("B", time, part) for time in TIMES for part in ("forward", "left")]
    read = crash().as_model(list(true), paths)(**true)
    observed = {one: (f"{value.m_as('m/s')} m/s", "0.1 m/s") for one, value in read.items()}
    guesses = {"A.vx": "16 m/s", "contacts[0].duration": "120 ms"}
    found = col.reconstruct.fit(crash(), guesses, observed)
    assert found["A.vx"].value == pytest.approx(14.0, rel=1e-3)
    assert found["contacts[0].duration"].value == pytest.approx(0.1, rel=2e-3)


@pytest.mark.slow
def test_an_impact_is_followed_once_for_all_samples_of_a_recorder(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from collisions.impact import vehicle_result

    calls: list[Any] = []
    recorded = vehicle_result.recorded

    def counted(*given: Any) -> Any:
        calls.append(given)
        return recorded(*given)

    monkeypatch.setattr(vehicle_result, "recorded", counted)
    paths = [path("B", time, part) for time in TIMES for part in ("forward", "left")]
    crash().as_model([], paths)()
    assert len(calls) == 1


@pytest.mark.parametrize(
    ("ending", "message"),
    [
        ("B.recorded", r"without a time .* 'contacts\[0\].impact.B.recorded\(40 ms, 0.4 m"),
        ("B.recorded(40 ms)", r"write 'contacts\[0\].impact.B.recorded\(40 ms\).forward' or"),
        ("B.recorded(40 ms).right", "positive to the left; write"),
        ("B.recorded(40 ms, 0.4 m).left", "with 2 numbers; write the time after first contact"),
        ("B.recorded(40 m).left", "time: '40 m' cannot be taken as s"),
        ("B.recorded(40 ms, 400, 0).left", r"within 20 m .*\(were millimetres meant"),
        ("b.recorded(40 ms).left", r"write 'contacts\[0\].impact.B.recorded\(40 ms\).left'"),
    ],
)
def test_a_path_of_a_curve_that_is_none_is_refused(ending: str, message: str) -> None:
    with pytest.raises(col.CollisionsError, match=message):
        crash().as_model([], [f"contacts[0].impact.{ending}"])


@pytest.mark.parametrize("model", [{"duration": None}, {"model": "eccentric"}])
def test_a_contact_of_an_instant_has_no_curve(model: dict[str, Any]) -> None:
    whole = (
        r"write `?duration=`?, such as '100 ms', in its .* 'contacts\[0\].impact.B.delta_v_left'"
    )
    with pytest.raises(col.InputError, match=whole) as refused:
        crash(**model).as_model([], [path("B", 0.05, "left")])
    assert refused.value.code == "no_pulse"
    with pytest.raises(col.InputError, match="no contact of this scene is followed in time"):
        crash(**model).as_model([], ["impacts[0].a.recorded(50 ms).left"])


@pytest.mark.slow
def test_only_contacts_in_time_are_within_a_tolerance_of_a_curve() -> None:
    found = crash().required({path("B", 0.05, "left"): "0.5 m/s"})
    assert found.level.contacts == "in time"
    for cost in found.costs:
        lasts = cost.level.contacts == "in time"
        assert all(math.isfinite(part) == lasts for part in cost.differences.values())


@pytest.mark.slow
def test_a_sample_stands_in_words_in_a_report() -> None:
    from collisions.reporting.scene_words import result_in_words

    assert result_in_words(crash().run(), path("B", 0.05, "left")) == (
        "B: delta-V to the left (recorders count to the right) after 50 ms, recorded 0.4 m ahead "
        "of its centre of mass and -0.3 m to its left, the first impact in the contact of A and B"
    )
