"""A study says once that its reverse solver leaves out what a contact that lasts does."""

import math
import warnings

import pytest

import collisions as col
from collisions import reconstruct
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform, propagate

WHEELS = {
    "duration": 0.1,
    "tyres_a": Tyres(0.7, 1.0, 2.7, 1.5),
    "tyres_b": Tyres(0.7, 0.0, 2.7, 1.5),
}
CONTACT = {"normal": 0.0, "point": (0.0, 0.0)}
A = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.0, y=0.2, heading=0.0)
B = col.Vehicle(mass=1300, yaw_inertia=2000, x=0.9, y=-0.5, heading="80 deg")
AFTER = {
    "a_after": A.replace(vx=6.0, vy=3.0, yaw_rate=0.4),
    "b_after": B.replace(vx=7.0, vy=9.0, yaw_rate=-0.6),
}


def by_momentum(value, **more):
    found = reconstruct.momentum(
        1500,
        1300,
        course_a=0.0,
        course_b="80 deg",
        course_a_after="20 deg",
        course_b_after="50 deg",
        speed_a_after=value,
        speed_b_after=9.0,
        **({"heading_a": 0.0, "heading_b": "80 deg"} if more else {}),
        **more,
    )
    return found.speed_a


def by_speeds(value, **more):
    (found,) = reconstruct.speeds(
        A,
        B,
        course_a=0.0,
        course_b="80 deg",
        restitution=0.1,
        friction=0.5,
        speed_b=5.0,
        delta_v_a=value,
        **CONTACT,
        **more,
    )
    return found.a.before.speed


def by_planar(value, **more):
    found = reconstruct.planar(
        AFTER["a_after"].replace(vx=value),
        AFTER["b_after"],
        closing_speed=9.0,
        impulse_ratio=0.2,
        **CONTACT,
        **more,
    )
    return found.a.before.vx


def by_central(value, **more):
    found = reconstruct.central(1500, 1300, va=value, vb=2.0, restitution=0.1, **drags(more))
    return found.b.after.vx


def by_inline_closing_speed(value, **more):
    return reconstruct.inline_closing_speed(1500, 1300, 0.1, delta_v_b=value, **drags(more))


def drags(wheels):
    names = {"duration": "duration", "tyres_a": "drag_a", "tyres_b": "drag_b"}
    return {names[name]: 0.1 if name == "duration" else 0.7 for name in wheels}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("solve", "mean"),
    [
        (by_momentum, 8.0),
        (by_speeds, 6.0),
        (by_planar, 6.0),
        (by_central, 12.0),
        (by_inline_closing_speed, 6.0),
    ],
)
def test_a_study_of_instants_says_so_once_and_warns_of_nothing(solve, mean):
    of_one = {name: WHEELS[name] for name in ("duration", "tyres_a")}
    for more in ({}, of_one, WHEELS):
        with warnings.catch_warnings():
            warnings.simplefilter("error", col.CollisionsWarning)
            found = propagate(
                lambda value, more=more: {"speed": solve(value, **more)},
                {"value": Normal(mean, 0.05)},
                samples=64,
                seed=1,
            )
        assert math.isfinite(found["speed"].mean)
        said = [one for one in found.statements if "as an instant" in one]
        assert len(said) == (0 if more else 1)
        other = [one for one in found.statements if "without the tyres of vehicle B" in one]
        assert len(other) == (1 if more == of_one else 0)
        moving = [one for one in found.statements if "point and normal move on" in one]
        assert len(moving) == (1 if more and solve in (by_speeds, by_planar) else 0)
        if said:
            assert said[0].startswith(f"{solve.__name__.removeprefix('by_')} found every case")
            assert "duration=" in said[0]
            assert "64" not in said[0]


def test_one_case_that_is_no_study_states_its_own():
    impact = reconstruct.central(1500, 1300, va=12.0, vb=2.0, restitution=0.1)
    assert impact.statements[0].startswith("found as an instant")


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("solver", [col.eccentric, col.solve], ids=["eccentric", "solve"])
def test_a_posterior_over_an_instant_says_so_whoever_chose_it(solver):
    """solve without a duration chooses among instants, with the same answer."""

    def model(vx):
        found = solver(A.replace(vx=vx), B.replace(vy=8.0), 0.1, **CONTACT, friction=0.5,
                       on_failure="nan")  # fmt: skip
        return {"delta_v": found.a.delta_v}

    found = reconstruct.posterior(
        model, {"vx": Uniform(5.0, 15.0)}, {"delta_v": (4.77, 0.3)}, samples=512, seed=1
    )
    assert any("every case as an instant, which leaves out the" in one for one in found.statements)
