"""Two that touch too slowly for a contact and come to overlap: nothing of that is silent."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Run, Scene
from collisions.travel import GRAVITY, Tyres

LORRY, CAR = (7.5, 2.4), (4.5, 1.8)
DRIVEN = ("driven_together", "driven_through")


def body(x: float, vx: Any, mass: float = 1200.0) -> col.Vehicle:
    return col.Vehicle(mass=mass, yaw_inertia=1.5 * mass, x=x, y=0.0, heading=0.0, vx=vx)


def behind(gap: float, speeds: tuple[Any, Any], drags: tuple[Any, Any], **given: Any) -> Scene:
    """A lorry behind a car."""
    movers = {
        "Lorry": Mover(body(-6.0 - gap, speeds[0], 9000.0), outline=LORRY, drag=drags[0]),
        "Car": Mover(body(0.0, speeds[1]), outline=CAR, drag=drags[1]),
    }
    return Scene(movers=movers, **{"contacts": [], **given})


def driven(run: Run) -> list[str]:
    return [notice.sentence for notice in run.findings if notice.code in DRIVEN]


@pytest.mark.parametrize("gap", [0.0, 2e-5])
def test_one_that_is_braked_less_and_leans_on_another(gap: float) -> None:
    """Both at 5 m/s bumper to bumper: the ways to rest of both in closed form, whose difference is
    how deep they overlap; the names and the time stand with it.
    """
    run = behind(gap, (5.0, 5.0), (0.6, 0.7)).run()
    deep = 25.0 / (2.0 * GRAVITY) * (1.0 / 0.6 - 1.0 / 0.7) - gap
    (said,) = driven(run)
    assert said.startswith("Lorry and Car touch at 0")
    assert f"overlap by {deep:.2g} m at {5.0 / (0.6 * GRAVITY):.3g} s" in said
    # As far as they rest on each other nothing is said.
    assert not driven(behind(gap, (1.0, 1.0), (0.68, 0.7)).run())


def test_one_that_rolls_into_another_ever_so_slowly() -> None:
    """Nothing slows either of them, and they close by 0.01 m/s."""
    (said,) = driven(behind(0.005, (5.01, 5.0), (None, None)).run())
    assert "Lorry and Car touch at 0.5 s, too slowly for a contact" in said
    assert not driven(behind(0.005, (5.0, 5.0), (None, None)).run())
    assert not driven(behind(0.0, (5.0, 5.01), (None, None)).run())


def test_one_that_leans_on_another_on_a_slope() -> None:
    """Both are braked enough to stop; the slope pulls the lorry, and the drag of the car holds."""
    run = behind(0.0, (1.0, 1.0), (0.25, 0.9), slope=(-0.2, 0.0)).run()
    (said,) = driven(run)
    assert said.startswith("Lorry and Car touch at 0 s")
    assert "overlap by" in said


@pytest.mark.slow
def test_a_batch_counts_those_of_single_cases() -> None:
    """After a blow the lorry comes up again with less than 1 m/s, which is passed over, and goes
    into the car, in two of three cases.
    """
    drags = np.array([0.3, 0.6, 0.2])
    rule = {"restitution": 0.5, "model": "linear_central", "normal": 0.0, "at": "touch"}
    given = {"contacts": [Contact("Lorry", "Car", **rule)]}
    said = [driven(behind(0.1, (4.0, 3.0), (part, 0.7), **given).run()) for part in drags.tolist()]
    assert [len(one) for one in said] == [1, 0, 1]
    assert "do not part right after their contact" in said[0][0]
    with pytest.warns(col.OutOfRangeWarning, match="in 2 of 3 cases .* too slowly for one"):
        behind(0.1, (4.0, 3.0), (drags, 0.7), **given).run()


def test_after_a_blow_only_what_is_deeper_than_then() -> None:
    """Cars that strike and part have no such finding."""
    contact = Contact("Lorry", "Car", restitution=0.3, friction=0.5, at="touch")
    assert not driven(behind(1.0, (8.0, 5.0), (0.7, 0.7), contacts=[contact]).run())


@pytest.mark.slow
@pytest.mark.parametrize("at", [0.0, "touch"])
def test_a_batch_counts_them_after_a_contact_at_a_time_too(at: float | str) -> None:
    """A lorry that is braked less goes into the car it struck, whatever says when it struck it."""
    drags = np.array([0.1, 0.7, 0.2])
    rule = {"restitution": 0.0, "model": "linear_central", "normal": 0.0, "at": at}
    given = {"contacts": [Contact("Lorry", "Car", **rule)]}
    said = [driven(behind(0.0, (9.0, 0.0), (part, 0.7), **given).run()) for part in drags.tolist()]
    assert [len(one) for one in said] == [1, 0, 1]
    with pytest.warns(col.OutOfRangeWarning, match="in 2 of 3 cases .* do not part right after"):
        behind(0.0, (9.0, 0.0), (drags, 0.7), **given).run()


def corners(car: col.Vehicle, size: tuple[float, float]) -> Any:
    c, s = np.cos(car.heading), np.sin(car.heading)
    half = 0.5 * np.array([(1, -1), (1, 1), (-1, 1), (-1, -1)]) * size
    return np.array([car.x, car.y]) + half @ np.array([[c, s], [-s, c]])


def overlap(one: Any, other: Any) -> float:
    """By separating axes."""
    least = np.inf
    for this, that in ((one, other), (other, one)):
        for begin, end in zip(this, np.roll(this, -1, axis=0), strict=True):
            along = (end - begin) / np.hypot(*(end - begin))
            least = min(least, -np.min((that - begin) @ np.array([along[1], -along[0]])))
    return float(least)


@pytest.mark.slow
@pytest.mark.parametrize("y", [0.5, 0.6])
def test_a_lorry_that_goes_into_a_car_it_struck_and_comes_out_again(y: float) -> None:
    """At rest they overlap by no more than 0.3 m above what they did at their contact, or not at
    all.
    """
    lorry = body(-12.0, 15.0, 20000.0).replace(y=y, yaw_inertia=160000.0)
    car = body(0.0, 0.0, 1500.0).replace(heading=1.57, yaw_inertia=2600.0)
    movers = {
        "Lorry": Mover(lorry, outline=(12.0, 2.5), drag=0.4),
        "Car": Mover(car, outline=CAR, tyres=Tyres(0.7, 1.0, 2.7, 1.5)),
    }
    hit = Contact("Lorry", "Car", restitution=0.2, friction=0.4, at="touch")
    run = Scene(movers=movers, contacts=[hit]).run()
    deep = [
        overlap(corners(run.at(time)["Lorry"], (12.0, 2.5)), corners(run.at(time)["Car"], CAR))
        for time in np.linspace(run.times[0], run.end, 60)
    ]
    assert max(deep) > deep[0] + 0.8
    assert deep[-1] < deep[0] + 0.3
    (said,) = driven(run)
    assert "do not part right after their contact, and overlap by" in said


@pytest.mark.slow
def test_a_lorry_that_goes_right_through_a_car_in_a_contact_that_lasts() -> None:
    """However deep the contact itself left them."""
    movers = {
        "Lorry": Mover(body(-15.0, 22.0, 18000.0), outline=(8.0, 2.5), drag=0.1),
        "Car": Mover(body(0.0, 0.0).replace(y=0.8), outline=CAR, tyres=Tyres(0.8, 1.0, 2.7, 1.5)),
    }
    hit = Contact("Lorry", "Car", restitution=0.1, friction=0.3, at="touch", duration=0.12)
    run = Scene(movers=movers, contacts=[hit]).run()
    assert run.rest["Lorry"].x > run.rest["Car"].x + 100.0
    assert "driven_through" in [notice.code for notice in run.findings]


@pytest.mark.slow
@pytest.mark.parametrize("speed", [3.1, 3.2, 4.0])
def test_a_second_blow_does_not_take_away_the_touch_that_a_first_one_made(speed: float) -> None:
    """Cars of 4 m in line, of which C and D have met and part slowly, 0.02 m from each other. B
    strikes C, and 3 ms later A strikes B, which strikes C once more: C runs into D, whether the
    first blow drove it towards D by less than what counts as a contact again, or by more.
    """
    given: dict[str, Any] = {"normal": 0, "model": "linear_central", "restitution": 0.2}
    first = speed - 0.6 * (speed - 0.8)
    at_b = 0.8 * 0.05 - 4.0 - speed * 0.55
    at_a = 0.8 * 0.05 - 8.0 + 0.003 * first - 8.0 * 0.553
    places = {
        "A": (at_a, 8.0, 3000),
        "B": (at_b, speed, 1000),
        "C": (-1, 2, 1000),
        "D": (4, 0, 1000),
    }
    movers = {
        name: Mover(col.Vehicle(mass=mass, vx=vx, x=x, y=0, heading=0), outline=(4.0, 1.8))
        for name, (x, vx, mass) in places.items()
    }
    pairs = [("A", "B"), ("B", "C"), ("C", "D")]
    contacts = [Contact(*pair, at="touch", **given) for pair in pairs]
    run = Scene(movers=movers, contacts=contacts).run()
    at = [number for number, pair in enumerate(run.pairs) if pair == ("C", "D")]
    before = run.at(run.times[at[1]] - 1e-6)
    assert run.impacts[at[1]].closing_speed == pytest.approx(before["C"].vx - before["D"].vx)
    assert run.impacts[at[1]].closing_speed > 4.0
