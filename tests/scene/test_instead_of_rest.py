"""What to give in place of places of rest where two vehicles are driven together, as the warning
says: it leads back to the speeds.
"""

import math
import warnings

import pytest

import collisions as col
from collisions.reconstruct import fit
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Interval, Normal, propagate

TRUE = {"A.vx": 14.0, "B.vy": 9.0}
UNKNOWN = {"A.vx": Interval(5.0, 30.0), "B.vy": Interval(3.0, 25.0)}


def crossing() -> Scene:
    a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.3, y=0.3, heading=0, vx=14)
    b = col.Vehicle(mass=1500, yaw_inertia=2500, x=0.85, y=0, heading=math.pi / 2, vx=0, vy=9)
    tyres = Tyres(0.7, 0.3, 2.7, 1.5)
    movers = {
        name: Mover(one, outline=(4.5, 1.8), tyres=tyres) for name, one in (("A", a), ("B", b))
    }
    hit = Contact("A", "B", restitution=0.1, friction=0.5, normal=0.0, point=(0.0, 0.0))
    return Scene(movers=movers, contacts=[hit])


@pytest.mark.slow
def test_speeds_and_courses_after_the_impact_lead_back() -> None:
    """The readings are of ``eccentric`` on the same two vehicles."""
    crash = crossing()
    assert [one.code for one in crash.run().findings] == ["driven_together"]
    before = [mover.vehicle for mover in crash.movers.values()]
    impact = col.eccentric(*before, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5)
    read = {
        f"impacts[0].{label}.after.{what}": (getattr(side.after, what), error)
        for label, side in (("a", impact.a), ("b", impact.b))
        for what, error in (("speed", 0.5), ("course", 0.05))
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.OutOfRangeWarning)
        found = fit(crash, UNKNOWN, read)
    for name, speed in TRUE.items():
        assert found[name].value == pytest.approx(speed, abs=1e-3)


def test_places_of_rest_have_the_warning_with_its_way_round() -> None:
    """A lorry that is braked less strikes a car in line and leans on it until both rest."""
    movers = {
        name: Mover(
            col.Vehicle(mass=mass, yaw_inertia=2500, x=x, y=0.0, heading=0.0, vx=vx),
            outline=(4.5, 1.8),
            drag=drag,
        )
        for name, mass, x, vx, drag in (("Lorry", 9e3, -4.6, 12.0, 0.1), ("Car", 1.2e3, 0, 0, 0.8))
    }
    hit = Contact(
        "Lorry", "Car", restitution=0.0, friction=0.5, normal=0.0, point=(-2.25, 0), at="touch"
    )
    crash, speed = Scene(movers=movers, contacts=[hit]), {"Lorry.vx": Normal(12.0, 0.1)}
    with pytest.warns(col.OutOfRangeWarning, match=r"such as 'impacts\[0\]\.a\.after\.course'"):
        propagate(crash, speed, outputs=["Car.rest.x"], samples=64, seed=1)
