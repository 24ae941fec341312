"""Refusals, and warnings of solvers, name values in the units that the inputs were given in; fields
of an error stay SI.
"""

import math
import random
import re

import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct as rc
from collisions.quantities.tables import Sentences

MPH, FTLBF = 0.44704, 1.3558179483314004
SI = re.compile(r"\d ?(?:m/s|rad|J|N|kg|m)\b")
ORIGIN = ("0 ft", "0 ft")


def a(**more):
    return col.Vehicle(
        **({"mass": "3400 lb", "yaw_inertia": "60000 lb*ft**2", "x": "-7 ft", "y": "0 ft"} | more)
    )


def b(**more):
    return col.Vehicle(
        **({"mass": "2900 lb", "yaw_inertia": "45000 lb*ft**2", "x": "7 ft", "y": "1 ft"} | more)
    )


CONTACT = {"normal": "0 deg", "point": ORIGIN, "friction": 0.1}
REFUSED = {
    "separating": (lambda: col.linear_central(a(vx="-35 mph"), b(), 0.1), "closing speed -35 mph"),
    "eccentric": (lambda: col.eccentric(a(vx="-35 mph"), b(), 0.1, **CONTACT),
    "closing speed -35 mph"),
    "solve": (lambda: col.solve(a(vx="-35 mph"), b(), 0.1, **CONTACT, tolerance="1 mph"),
    "closing speed -35 mph"),
    "in time": (
        lambda: col.time_resolved(a(vx="-35 mph"), b(), 0.1, **CONTACT, duration="100 ms"),
        "closing speed -35 mph",
    ),
    "spinning": (
        lambda: col.oblique_central(a(vx="35 mph", yaw_rate="20 deg/s"), b(), 0.1, normal="0 deg",
        friction=0.3),
        "yaw_rate = 20°/s",
    ),
    "across": (lambda: col.linear_central(a(vx="35 mph", vy="5 mph"), b(), 0.1),
    "moves at 5 mph across"),
    "pushed apart": (
        lambda: col.eccentric(
            a(vx="5 mph"), b(), 0.1, **CONTACT, outside_a=("-3000 lbf*s", "0 lbf*s", "0 lbf*ft*s"),
            outside_b=("0 lbf*s", "0 lbf*s", "0 lbf*ft*s"),
        ),
        "which approach at 5 mph",
    ),
    "central, apart": (
        lambda: rc.central("3400 lb", "2900 lb", va="10 mph", vb="20 mph", restitution=0.1),
        "va = 10 mph, vb = 20 mph, restitution = 0.1 mean a closing speed of -10 mph",
    ),
    "central, energy": (
        lambda: rc.central("3400 lb", "2900 lb", va="30 mph", vb="20 mph",
        energy_loss="500000 ft*lbf"),
        "energy_loss = 500000 ft·lbf: with these masses",
    ),
    "central, plastic": (
        lambda: rc.central("3400 lb", "2900 lb", va_after="10 mph", vb_after="12 mph",
        restitution=0.0),
        "vb_after - va_after is 2 mph",
    ),
    "central, two": (
        lambda: rc.central("3400 lb", "2900 lb", vb="5 mph", va_after="16.1905 mph",
        energy_loss="31391 ft*lbf"),
        "mph with e",
    ),
    "planar, together": (
        lambda: rc.planar(a(vx="30 mph"), b(), restitution=0.1, **CONTACT),
        "separation speed -30 mph along the normal",
    ),
    "planar, faster": (
        lambda: rc.planar(a(vx="3 mph"), b(vx="9 mph", vy="4 mph"), closing_speed="2 mph",
        **CONTACT),
        "separation speed 6 mph, slip after 4 mph, closing_speed=2 mph",
    ),
    "observed": (
        lambda: rc.restitution(a(vx="3 mph"), b(vx="9 mph"), a(), b(), normal="0 deg",
        point=ORIGIN),
        "closing speed -6 mph along the normal",
    ),
    "speeds": (
        lambda: rc.speeds(
            a(), b(), course_a="0 deg", course_b="180 deg", speed_b="60 mph",
                energy_loss="1 ft*lbf", restitution=0.1,
            forward_only=True, **CONTACT,
        ),
        "that fits speed_b = 60 mph and energy_loss = 1 ft·lbf a vehicle",
    ),
    # 1.8 = g (1 + e) / 2 with 0.3 below 3 m/s and 0.1 above.
    "inline": (
        lambda: rc.inline_closing_speed("2000 lb", "2000 lb", lambda v: 0.3 if v < 3 else 0.1,
        delta_v_a=f"{1.8 / MPH} mph"),
        f"at closing speeds of {3.6 / 1.3 / MPH:.6g} mph and {3.6 / 1.1 / MPH:.6g} mph",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", sorted(REFUSED))
def test_a_refusal_speaks_the_units_of_the_inputs(name):
    """mph, feet and degrees; no number in SI."""
    call, said = REFUSED[name]
    with pytest.raises(col.CollisionsError) as caught:
        call()
    assert said in str(caught.value)
    assert not SI.search(str(caught.value)), str(caught.value)


@pytest.mark.slow
def test_the_fields_stay_si():
    for name in ("separating", "eccentric", "solve", "in time"):
        with pytest.raises(col.NoImpactError) as caught:
            REFUSED[name][0]()
        assert caught.value.closing_speed == pytest.approx(-35 * MPH, rel=1e-12)
    with pytest.raises(col.CollisionsError) as caught:
        REFUSED["planar, together"][0]()
    assert caught.value.fields["separation_speed"] == pytest.approx(-30 * MPH, rel=1e-12)


@pytest.mark.parametrize(
    ("speed", "said"), [("-35 km/h", "-35 km/h"), (-10.0, "-10 m/s"), ("-10 m/s", "-10 m/s")]
)
def test_the_other_systems(speed, said):
    """Bare numbers are SI."""
    body = {"mass": 1500.0} if isinstance(speed, float) else {"mass": "1500 kg"}
    with pytest.raises(col.NoImpactError, match=f"closing speed {said};"):
        col.linear_central(col.Vehicle(vx=speed, **body), col.Vehicle(**body), 0.1)


def test_degrees_beside_metres_per_second():
    a = col.Vehicle(mass="1500 kg", vx="10 m/s", yaw_rate="20 deg/s")
    with pytest.raises(col.InputError, match="yaw_rate = 20°/s"):
        col.oblique_central(a, col.Vehicle(mass="900 kg"), 0.1, normal=0.0, friction=0.1)
    with pytest.raises(col.InputError, match=r"yaw_rate = 0\.3 rad/s"):
        col.oblique_central(
            a.replace(yaw_rate=0.3), col.Vehicle(mass="900 kg"), 0.1, normal=0.0, friction=0.1
        )


def test_the_first_refused_case_of_a_batch():
    fast = col.Vehicle(mass="3400 lb", vx=np.array([10.0, -20.0]))
    with pytest.raises(col.NoImpactError, match=r"^case 1: .*closing speed -44\.7387 mph"):
        col.linear_central(fast, col.Vehicle(mass="2900 lb", vx="0 mph"), 0.1, on_failure="raise")


def test_a_gain_of_energy_is_in_the_units_too():
    contact = {"normal": "0 deg", "point": ORIGIN, "impulse_ratio": 2.0}
    with pytest.warns(col.EnergyGainWarning, match=r"gains \S+ ft·lbf of energy") as caught:
        col.eccentric(a(vx="30 mph"), b(y="0 ft"), 0.9, **contact)
    gain = float(re.search(r"gains (\S+) ft", str(caught[0].message))[1])
    assert caught[0].message.fields["gain"] == pytest.approx(gain * FTLBF, rel=1e-5)


def test_a_number_beyond_the_unit_stays_si():
    """1e308 m/s are more mph than a float holds: the message is not an error of its own."""
    say = Sentences(["35 mph"])
    assert say(1e308, "speed") == "1e+308 m/s"
    assert say(-0.0, "speed") == "0 mph"
    assert say(35 * MPH, "speed") == "35 mph"


def test_numbers_near_each_other_are_written_apart():
    """With as many figures as that takes, in the unit that they are printed in; equal ones, and a
    number alone, stay short.
    """
    say = Sentences(["10 mph"])
    assert say.apart([10 * MPH, 12 * MPH], "speed") == ["10 mph", "12 mph"]
    near = [10 * MPH, 10.0000001 * MPH]
    assert say.apart(near, "speed") == ["10 mph", "10.0000001 mph"]
    assert say.apart([0.03432, 0.03432], "number", 4) == ["0.03432", "0.03432"]
    one = 0.1
    assert len(set(say.apart([one, np.nextafter(one, 1.0)], "number"))) == 2


@pytest.mark.slow
@pytest.mark.parametrize("texts", [["35 mph"], ["10 km/h"], []])
@pytest.mark.parametrize("kind", ["speed", "energy", "length"])
def test_a_bound_is_rounded_to_the_side_on_which_it_is_allowed(texts, kind):
    """Read back it is within, by a unit of its last figure at most."""
    say, generator = Sentences(texts), random.Random(2)
    for figures in (3, 6, 7):
        for _ in range(50):
            value = generator.uniform(1.0, 9.0) * 10.0 ** generator.randint(-3, 7)
            unit = {"speed": "m/s", "energy": "J", "length": "m"}[kind]
            least, most = (
                pint.Quantity(one.replace("·", "*")).m_as(unit)
                for one in (say.at_least(value, kind, figures), say.at_most(value, kind, figures))
            )
            assert value <= least <= value * (1.0 + 10.0 ** (1 - figures))
            assert value >= most >= value * (1.0 - 10.0 ** (1 - figures))
    assert say.at_most(math.inf, kind) == say(math.inf, kind)


def test_following_a_bound_leads_on():
    """An energy at the bound that the refusal names is taken."""
    known = {"va": "31.7 mph", "vb": "4.2 mph"}
    with pytest.raises(col.NoSolutionError, match="they allow at least") as caught:
        col.reconstruct.central("3300 lb", "2750 lb", **known, energy_loss="1e7 ft*lbf")
    most = re.search(r"at most ([0-9.e+]+) ft·lbf", str(caught.value))[1]
    found = col.reconstruct.central(
        "3300 lb", "2750 lb", **known, energy_loss=f"{most} ft*lbf", on_failure=None
    )
    assert 0.0 <= found.restitution < 0.01
