"""``time_resolved`` against its steps in 40 digits: what is promised of its rounding; and contacts
followed to the places given.
"""

import cmath
import math
import random
import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import collisions as col
from reference import EPS, evaluate
from reference_in_time import follow_in_time
from scenes import draw, vehicle

# In eps of a scale: speeds of V = |v_A| + |v_B| + |w_A| |r_A| + |w_B| |r_B| and the change itself;
# impulses of |P| + m V with the lighter mass, losses of that times V.
PROMISES = {"delta-V": 16, "change of yaw rate, times |r|": 16, "impulse": 16, "loss": 16}
FAMILIES = ("traffic", "mass ratio 1e-12..1e12", "barrier", "map grid")
# Steps of a nominal duration, and contacts of each geometry of a family.
STEPS, COUNT = 25, 10
SIZE = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y", "heading")


@cache
def contacts(family, moves, count=COUNT, steps=STEPS):
    """Seeded scenes of a family with duration, drag and the reference; no restitution so small that
    nothing of it is left.
    """
    rng, found = random.Random(f"{family} in time {moves}"), []
    while len(found) < count:
        scene = draw(family, "stronge", "friction", rng)
        e = rng.choice((0.0, 1.0, rng.uniform(0.05, 1.0), rng.uniform(0.05, 0.3)))
        scene, duration, drag = (
            replace(scene, restitution=e),
            rng.uniform(0.05, 0.15),
            rng.choice((0.0, 0.7)),
        )
        followed = follow_in_time(scene, duration, drag, steps, moves)
        if followed is not None and evaluate(scene).refused is None:
            found.append((scene, duration, drag, followed))
    return found


def errors(scene, followed, case):
    """Of every output that is promised the error in eps of its scale; ``case`` gives an output by
    its path.
    """
    arms = [
        math.hypot(scene.point[0] - body.x, scene.point[1] - body.y) for body in (scene.a, scene.b)
    ]
    speed = sum(
        math.hypot(body.vx, body.vy) + abs(body.spin) * arm
        for body, arm in zip((scene.a, scene.b), arms, strict=True)
    )
    impulse, loss = complex(followed.impulse), float(followed.loss_n + followed.loss_t)
    momentum = min(scene.a.mass, scene.b.mass) * speed
    found = [
        (
            "impulse",
            abs(complex(case("b.impulse_x"), case("b.impulse_y")) - impulse),
            abs(impulse) + momentum,
        ),
        ("loss", abs(case("energy_loss") - loss), abs(loss) + (abs(impulse) + momentum) * speed),
    ]
    for label, arm, (change, turn) in zip("ab", arms, followed.changes, strict=True):
        change, turn = complex(change), float(turn)
        got = complex(case(f"{label}.delta_vx"), case(f"{label}.delta_vy"))
        found.append(("delta-V", abs(got - change), speed + abs(change)))
        turned = abs(case(f"{label}.delta_yaw_rate") - turn)
        found.append(("change of yaw rate, times |r|", turned * arm, speed + abs(turn) * arm))
    return [(name, error / (scale * EPS)) for name, error, scale in found]


def output(impact, path):
    """The value at a path such as "a.delta_vx"."""
    for name in path.split("."):
        impact = getattr(impact, name)
    return impact


def alone(scene, duration, drag, moves, steps=STEPS):
    """The answer of the package to one contact."""
    geometry = "first_contact" if moves else "fixed"
    contact = {
        "normal": scene.normal,
        "point": scene.point,
        "friction": scene.value,
        "duration": duration,
        "drag": drag,
    }
    bodies = vehicle(scene.a), vehicle(scene.b)
    return col.time_resolved(*bodies, scene.restitution, **contact, geometry=geometry, steps=steps)


def together(found, moves):
    """The same of all of them in one call."""
    scenes = [scene for scene, *_ in found]

    def column(values):
        values = list(values)
        return (
            tuple(map(column, zip(*values, strict=True)))
            if isinstance(values[0], tuple)
            else np.array(values)
        )

    fields = {"yaw_inertia": "inertia", "yaw_rate": "spin"}
    bodies = [
        col.Vehicle(
            **{
                name: column(getattr(getattr(one, side), fields.get(name, name)) for one in scenes)
                for name in SIZE
            }
        )
        for side in "ab"
    ]
    contact = {name: column(getattr(one, name) for one in scenes) for name in ("normal", "point")}
    times = {name: column(row[at] for row in found) for name, at in (("duration", 1), ("drag", 2))}
    e, friction = (
        column(getattr(one, name) for one in scenes) for name in ("restitution", "value")
    )
    geometry = "first_contact" if moves else "fixed"
    return col.time_resolved(
        *bodies, e, **contact, **times, friction=friction, geometry=geometry, steps=STEPS
    )


@pytest.mark.slow
@pytest.mark.parametrize("moves", [False, True], ids=["fixed", "moving"])
@pytest.mark.parametrize("family", FAMILIES)
def test_rounding_is_within_its_promise(monkeypatch, family, moves):
    """Every contact by itself, and as a case of a block of arrays."""
    monkeypatch.setattr("collisions.impact.time_resolved_inputs._FEW", 0)
    monkeypatch.setattr("collisions.kernels.time_resolved._LEAST", 0)
    found = contacts(family, moves)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        many = together(found, moves)
        for at, (scene, duration, drag, followed) in enumerate(found):
            one = alone(scene, duration, drag, moves)
            ways = (
                (lambda path, one=one: output(one, path)),
                (lambda path, at=at: output(many, path)[at]),
            )
            for case in ways:
                for name, error in errors(scene, followed, case):
                    assert error <= PROMISES[name], (name, error, scene, duration, drag)
            # Momentum with the tyres, in their own sizes.
            pushed = one.a.impulse_x, one.a.impulse_y, one.a.tyre_impulse_x, one.a.tyre_impulse_y
            pushed += one.b.tyre_impulse_x, one.b.tyre_impulse_y
            assert one.momentum_residual <= 4 * EPS * math.hypot(*pushed)


@pytest.mark.slow
def test_forty_digits_are_enough():
    """Another ten change nothing that a float could show."""
    for scene, duration, drag, followed in contacts("traffic", moves=True)[:3]:
        finer = follow_in_time(scene, duration, drag, STEPS, True, digits=50)
        assert abs(complex(finer.impulse - followed.impulse)) <= 1e-25 * abs(
            complex(followed.impulse)
        )


@pytest.mark.slow
def test_the_start_is_found_from_the_places_of_maximum_engagement():
    """From places that the reference reached the package finds the start, and what comes of it:
    sliding, sticking, with tyres.

    Both take 100 steps, of nominal durations that differ as the levers do, so they are off by what
    the steps err: most by 1e-4, those where a slip or a tyre stops by the step times that. What
    turns by half a radian may have more than one start.
    """
    off = []
    for scene, duration, drag, followed in contacts("traffic", True, 16, 100):
        if abs(followed.engaged[4] - 1) > 0.5 or followed.time > 1.5 * duration:
            continue
        moved, places = [], []
        for body, way, turn in (
            (scene.a, *followed.engaged[:2]),
            (scene.b, *followed.engaged[2:4]),
        ):
            way, turn = complex(way), complex(turn)
            x, y, heading = body.x + way.real, body.y + way.imag, body.heading + cmath.phase(turn)
            places.append(
                complex(x, y) + turn * complex(scene.point[0] - body.x, scene.point[1] - body.y)
            )
            moved.append(vehicle(body, x=x, y=y, heading=heading))
        at = (
            complex(*scene.normal)
            if isinstance(scene.normal, tuple)
            else cmath.rect(1.0, scene.normal)
        )
        normal, point = at * complex(followed.engaged[4]), 0.5 * sum(places)
        first = alone(scene, duration, drag, True, 100)
        stiffness = (
            first.effective_mass * (0.5 * math.pi * (1.0 + scene.restitution) / duration) ** 2
        )
        contact = {
            "normal": (normal.real, normal.imag),
            "point": (point.real, point.imag),
            "friction": scene.value,
        }
        found = col.time_resolved(
            *moved, scene.restitution, **contact, stiffness=stiffness, drag=drag
        )
        size = max(abs(complex(change)) for change, _ in followed.changes)
        off.append(abs(found.closing_speed / float(followed.closing) - 1.0))
        for side, (change, _) in zip((found.a, found.b), followed.changes, strict=True):
            off.append(abs(complex(side.delta_vx, side.delta_vy) - complex(change)) / size)
    assert len(off) >= 30
    assert np.median(off) < 2e-4
    assert np.quantile(off, 0.9) < 1e-3
    assert max(off) < 1e-2
