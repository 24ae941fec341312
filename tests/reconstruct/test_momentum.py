"""Planar momentum backwards: all pairs of unknown speeds, what they depend on, and every refusal
and warning.

The reference is the balance m_a s_a h_a + m_b s_b h_b + J = m_a s_a' h_a' + m_b s_b' h_b' itself,
two equations solved at 50 digits with the very floats that the package got. The accuracy promised
is that of numerics, section 5, row "headings".
"""

import copy
import dataclasses
import itertools
import math
import pickle
import random
import re
import warnings

import mpmath
import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct
from collisions.kernels.status import EPS
from strategies import other_registry

mp = mpmath.MPContext()
mp.dps = 50

SPEEDS = ("speed_a", "speed_b", "speed_a_after", "speed_b_after")
COURSES = ("course_a", "course_b", "course_a_after", "course_b_after")
PAIRS = list(itertools.combinations(SPEEDS, 2))
TOGETHER_PAIRS = list(itertools.combinations(SPEEDS[:3], 2))
FAMILIES = ("traffic", "mass ratio 1e-12..1e12", "nearly collinear", "degrees")


def course_of(speed):
    return speed.replace("speed", "course")


def bodies_of(speed, together):
    """The masses that move at this speed, and the sign of their momentum in the balance."""
    joined = together and speed == "speed_a_after"
    return ("mass_a", "mass_b") if joined else (f"mass_{speed[6]}",), -1 if speed.endswith(
        "after"
    ) else 1


def balanced(x, unknowns, together=False):
    """Both unknown speeds at 50 digits, angles in radians: Cramer's rule on the two components of
    the balance.
    """
    columns, rest = (
        [],
        [mp.mpf(x.get("outside_impulse_x", 0)), mp.mpf(x.get("outside_impulse_y", 0))],
    )
    for speed in SPEEDS[: 3 if together else 4]:
        masses, sign = bodies_of(speed, together)
        mass = sign * sum(mp.mpf(x[name]) for name in masses)
        column = [mass * mp.cos(x[course_of(speed)]), mass * mp.sin(x[course_of(speed)])]
        if speed in unknowns:
            columns.append(column)
        else:
            rest = [part + mp.mpf(x[speed]) * c for part, c in zip(rest, column, strict=True)]
    (a, c), (b, d) = columns
    det = a * d - b * c
    return (b * rest[1] - d * rest[0]) / det, (c * rest[0] - a * rest[1]) / det


def draw(family, rng, pair=PAIRS[0]):
    """Masses, courses and speeds of an impact: two velocities and an impulse. Degrees where the
    family says so.
    """
    m = {"mass_a": rng.uniform(700.0, 3000.0), "mass_b": rng.uniform(700.0, 3000.0)}
    if family == "mass ratio 1e-12..1e12":
        m["mass_b"] = m["mass_a"] * 10.0 ** rng.uniform(-12, 12)
    u = [[rng.uniform(-30.0, 30.0) for _ in "xy"] for _ in "ab"]
    reduced = min(m.values())
    impulse = [reduced * rng.uniform(-10.0, 10.0) for _ in "xy"]
    w = [
        [part - j / m["mass_a"] for part, j in zip(u[0], impulse, strict=True)],
        [part + j / m["mass_b"] for part, j in zip(u[1], impulse, strict=True)],
    ]
    scene = dict(m)
    for name, (vx, vy) in zip(SPEEDS, (*u, *w), strict=True):
        scene[name] = math.hypot(vx, vy)
        scene[course_of(name)] = (
            math.degrees(math.atan2(vy, vx)) if family == "degrees" else math.atan2(vy, vx)
        )
    if family == "nearly collinear":
        apart = rng.choice((-1, 1)) * 10.0 ** rng.uniform(-6, -1) + rng.choice((0.0, math.pi))
        scene[course_of(pair[1])] = scene[course_of(pair[0])] + apart
    return scene


def quietly(call, *ignored):
    """The answer without the warnings that a test is not about."""
    with warnings.catch_warnings():
        for kind in ignored or (col.CollisionsWarning,):
            warnings.simplefilter("ignore", kind)
        return call()


def solve(scene, unknowns, family="traffic", **options):
    """A scene put to the solver, without what is asked for."""
    known = {name: value for name, value in scene.items() if name not in unknowns}
    if options.get("together"):
        known = {
            name: value
            for name, value in known.items()
            if name not in ("speed_b_after", "course_b_after")
        }
    if family == "degrees":
        known |= {name: f"{known[name]!r} deg" for name in COURSES if name in known}
    known |= {name: known.pop(name) for name in ("mass_a", "mass_b")}
    return reconstruct.momentum(**known, **options)


def in_radians(scene, family):
    """The scene at 50 digits."""
    factor = mp.pi / 180 if family == "degrees" else 1
    return {
        name: mp.mpf(value) * (factor if name in COURSES else 1) for name, value in scene.items()
    }


def promise(scene, wanted, other, family, together=False, impulse=(0.0, 0.0)):
    """8 eps [(sum of the known momenta over the own mass) / |sin| + 3 |cot| |s|], numerics section
    5.
    """
    x = in_radians(scene, family)
    gamma = x[course_of(other)] - x[course_of(wanted)]
    own = sum(scene[name] for name in bodies_of(wanted, together)[0])
    known = math.hypot(*impulse) / own
    for speed in SPEEDS[: 3 if together else 4]:
        if speed not in (wanted, other):
            known += (
                sum(scene[name] for name in bodies_of(speed, together)[0]) / own * abs(scene[speed])
            )
    answer = balanced(
        {**x, "outside_impulse_x": impulse[0], "outside_impulse_y": impulse[1]},
        (wanted, other),
        together,
    )
    index = 0 if SPEEDS.index(wanted) < SPEEDS.index(other) else 1
    exact = answer[index]
    return exact, float(
        8 * EPS * (known / abs(mp.sin(gamma)) + 3 * abs(mp.cot(gamma)) * abs(exact))
    )


# A crossing that loses energy: a going east, b north.
CROSSING = {
    "mass_a": 1500.0, "mass_b": 1200.0, "course_a": 0.0, "course_b": math.pi / 2,
    "course_a_after": 0.9, "course_b_after": 0.6, "speed_a_after": 9.0, "speed_b_after": 8.0,
}  # fmt: skip


def crossing(**changes):
    """The crossing with changes; None leaves an argument out."""
    return reconstruct.momentum(**{**CROSSING, **changes})


# Answers


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("pair", PAIRS, ids="+".join)
def test_every_pair_of_unknowns(family, pair):
    """Against the balance at 50 digits, to the promise of numerics section 5; 40 scenes each,
    single and as a batch.
    """
    rng = random.Random(f"{family} {pair}")
    scenes = [draw(family, rng, pair) for _ in range(40)]
    columns = {name: np.array([scene[name] for scene in scenes]) for name in scenes[0]}
    if family == "degrees":
        columns |= {
            name: pint.get_application_registry().Quantity(columns[name], "deg") for name in COURSES
        }
    batch = quietly(lambda: solve(columns, pair))
    for i, scene in enumerate(scenes):
        single = quietly(lambda scene=scene: solve(scene, pair, family))
        assert single.unknowns == batch.unknowns == pair
        for name, other in (pair, pair[::-1]):
            exact, bound = promise(scene, name, other, family)
            for ours in (getattr(single, name), getattr(batch, name)[i]):
                assert abs(mp.mpf(float(ours)) - exact) <= bound, (
                    name,
                    float(ours),
                    mp.nstr(exact, 17),
                    bound,
                )


@pytest.mark.slow
@pytest.mark.parametrize("pair", PAIRS, ids="+".join)
def test_round_trip(pair):
    """A scene that was made forward comes back: what the rounding of its own speeds and courses is
    worth, condition times.
    """
    rng = random.Random(f"round trip {pair}")
    for _ in range(40):
        scene = draw("traffic", rng)
        found = quietly(lambda scene=scene: solve(scene, pair))
        scale = sum(scene[name] for name in SPEEDS) * 3000.0 / 700.0
        for name in SPEEDS:
            # Each of four speeds and courses is off by its rounding: 8 eps of the momentum, and the
            # promise as much again.
            assert getattr(found, name) == pytest.approx(
                scene[name], rel=0, abs=32 * EPS * found.condition * scale
            )


@pytest.mark.slow
@pytest.mark.parametrize("pair", TOGETHER_PAIRS, ids="+".join)
def test_together(pair):
    """Vehicles that leave as one: three speeds in the balance, one known."""
    rng = random.Random(f"together {pair}")
    for _ in range(40):
        scene = draw("traffic", rng)
        found = quietly(lambda scene=scene: solve(scene, pair, together=True))
        for name, other in (pair, pair[::-1]):
            exact, bound = promise(scene, name, other, "traffic", together=True)
            assert abs(mp.mpf(getattr(found, name)) - exact) <= bound
        assert found.speed_a_after == found.speed_b_after
        assert found.course_a_after == found.course_b_after


def test_outside_impulse():
    """An impulse of a kerb enters the balance; as Quantities too."""
    rng = random.Random("kerb")
    for pair in PAIRS:
        scene, push = draw("traffic", rng), (rng.uniform(-9e3, 9e3), rng.uniform(-9e3, 9e3))
        found = quietly(
            lambda scene=scene, push=push, pair=pair: solve(scene, pair, outside_impulse=push)
        )
        in_kilo = (f"{push[0] / 1000!r} kN*s", f"{push[1] / 1000!r} kN*s")
        again = quietly(
            lambda scene=scene, push=in_kilo, pair=pair: solve(scene, pair, outside_impulse=push)
        )
        for name, other in (pair, pair[::-1]):
            exact, bound = promise(scene, name, other, "traffic", impulse=push)
            assert abs(mp.mpf(getattr(found, name)) - exact) <= bound
            assert abs(getattr(again, name) - getattr(found, name)) <= 2 * bound


@pytest.mark.slow
@pytest.mark.parametrize("pair", PAIRS, ids="+".join)
@pytest.mark.parametrize("model", ["oblique_central", "eccentric"])
def test_what_a_forward_solver_gave(model, pair):
    """Courses and speeds of an impact with friction: the other two speeds, delta-V, PDOF,
    restitution and energy of it.
    """
    rng = random.Random(f"{model} {pair}")
    count = 0
    while count < 15:
        a, b = (
            col.Vehicle(
                mass=rng.uniform(800, 2500), vx=rng.uniform(-25, 25), vy=rng.uniform(-25, 25),
                yaw_inertia=rng.uniform(1e3, 4e3),
                x=x, y=rng.uniform(-1, 1), heading=rng.uniform(-3, 3),
            )
            for x in (-1.5, 1.5)
        )  # fmt: skip
        e, normal, friction = rng.uniform(0.05, 0.9), rng.uniform(-0.4, 0.4), rng.uniform(0.05, 0.6)
        place = {"point": (0.0, 0.2)} if model == "eccentric" else {}
        impact = quietly(
            lambda a=a, b=b, e=e, n=normal, mu=friction, p=place: getattr(col, model)(
                a, b, e, normal=n, friction=mu, on_failure="nan", **p
            )
        )
        if impact.status != col.Status.OK:
            continue
        count += 1
        moments = dict(
            zip(
                SPEEDS,
                (impact.a.before, impact.b.before, impact.a.after, impact.b.after),
                strict=True,
            )
        )
        known = {course_of(name): body.course for name, body in moments.items()}
        known |= {name: body.speed for name, body in moments.items() if name not in pair}
        found = quietly(
            lambda a=a, b=b, known=known, n=normal: reconstruct.momentum(
                a.mass, b.mass, heading_a=a.heading, heading_b=b.heading, normal=n, **known
            )
        )
        # Rounding of the six inputs, condition times, in speeds of the lighter vehicle.
        slack = (
            64
            * EPS
            * found.condition
            * sum(body.speed for body in moments.values())
            * max(a.mass, b.mass)
            / min(a.mass, b.mass)
        )
        for name, body in moments.items():
            assert getattr(found, name) == pytest.approx(body.speed, rel=0, abs=slack)
        for side in "ab":
            half = getattr(impact, side)
            assert getattr(found, f"delta_v_{side}") == pytest.approx(
                half.delta_v, rel=0, abs=2 * slack
            )
            apart = math.remainder(getattr(found, f"pdof_{side}") - half.pdof, math.tau)
            assert abs(apart) <= 4 * slack / half.delta_v + 8 * EPS
        loss = sum(
            0.5 * half.before.mass * (half.before.speed**2 - half.after.speed**2) for half in (
            impact.a, impact.b)
        )  # fmt: skip
        energy_slack = 4 * slack * sum(body.mass * body.speed for body in moments.values())
        assert found.translational_energy_loss == pytest.approx(loss, rel=0, abs=energy_slack)
        n = math.cos(normal), math.sin(normal)
        closing = sum(part * (u - v) for part, u, v in ((n[0], a.vx, b.vx), (n[1], a.vy, b.vy)))
        assert found.closing_speed == pytest.approx(closing, rel=0, abs=4 * slack)
        if model == "oblique_central":
            assert found.restitution == pytest.approx(e, rel=0, abs=8 * slack / closing)
            assert found.translational_energy_loss == pytest.approx(
                impact.energy_loss, rel=0, abs=energy_slack
            )
            for half, pdof in ((impact.a, found.pdof_a), (impact.b, found.pdof_b)):
                assert math.degrees(pdof) == pytest.approx(half.q.pdof.m_as("deg"), abs=1e-6)


def test_negative_answers_are_returned():
    """Backwards along its course: the sign stays, and a warning says so with the number."""
    with pytest.warns(
        col.OutOfRangeWarning, match=r"speed_a = -10\.8\d* m/s: backwards along its course"
    ) as caught:
        found = crossing(course_a=math.pi)
    (warning,) = caught
    assert warning.filename == __file__
    assert warning.message.code == "negative_speed"
    assert found.speed_a == warning.message.fields["value"] < 0.0
    turned = crossing()
    assert found.speed_a == pytest.approx(-turned.speed_a, rel=8 * EPS)
    assert found.delta_v_a == pytest.approx(turned.delta_v_a, rel=16 * EPS)


@pytest.mark.slow
def test_rounding_of_zero_is_not_backwards():
    """A vehicle that stood comes out as a rounding of 0, of either sign, which no warning is made
    of.
    """
    rng = random.Random("stood")
    residues = []
    for _ in range(100):
        m, theta, phi = (
            (rng.uniform(700, 3000), rng.uniform(700, 3000)),
            rng.uniform(-3, 3),
            rng.uniform(-1, 1),
        )
        v, j = (20 * math.cos(theta), 20 * math.sin(theta)), rng.uniform(1e3, 9e3)
        jx, jy = j * math.cos(theta + phi), j * math.sin(theta + phi)
        w = (v[0] - jx / m[0], v[1] - jy / m[0]), (jx / m[1], jy / m[1])
        found = quietly(
            lambda m=m, theta=theta, w=w: reconstruct.momentum(
                *m, course_a=theta, course_b=theta + 1.0,
                course_a_after=math.atan2(w[0][1], w[0][0]),
                course_b_after=math.atan2(w[1][1], w[1][0]),
                speed_a_after=math.hypot(*w[0]), speed_b_after=math.hypot(*w[1]),
            ),
            col.EnergyGainWarning,
        )  # fmt: skip
        residues.append(found.speed_b)
    assert min(residues) < 0.0 < max(residues)
    assert max(map(abs, residues)) < 1e-12


# How firmly they stand


def inputs_of(scene, pair, together):
    """Names of everything the answers depend on."""
    speeds = SPEEDS[: 3 if together else 4]
    return [
        "mass_a",
        "mass_b",
        *(name for name in speeds if name not in pair),
        *map(course_of, speeds),
    ]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pair", "together"), [(p, False) for p in PAIRS] + [(p, True) for p in TOGETHER_PAIRS]
)
def test_sensitivities_are_derivatives(pair, together):
    """Of both answers by every input, against central differences of the balance at 50 digits.

    A step of 1e-15 leaves 1e-30 of the third derivative, so what is allowed is the package's
    rounding: that of the answers used, 8 eps times condition, and of one more division by the sine.
    """
    rng = random.Random(f"sensitivity {pair} {together}")
    step = mp.mpf(10) ** -15
    for _ in range(10):
        scene, push = draw("traffic", rng), (rng.uniform(-5e3, 5e3), rng.uniform(-5e3, 5e3))
        found = quietly(
            lambda scene=scene, push=push: solve(
                scene, pair, together=together, outside_impulse=push
            )
        )
        x = in_radians(scene, "traffic") | {
            "outside_impulse_x": mp.mpf(push[0]),
            "outside_impulse_y": mp.mpf(push[1]),
        }
        names = [*inputs_of(scene, pair, together), "outside_impulse_x", "outside_impulse_y"]
        gamma = x[course_of(pair[1])] - x[course_of(pair[0])]
        sine = float(abs(mp.sin(gamma)))
        lightest = min(scene["mass_a"], scene["mass_b"])
        speeds = sum(abs(getattr(found, name)) for name in SPEEDS)
        momentum = (scene["mass_a"] + scene["mass_b"]) * speeds + math.hypot(*push)
        for i, answer in enumerate(pair):
            assert sorted(found.sensitivity[answer]) == sorted(names)
            own = sum(scene[name] for name in bodies_of(answer, together)[0])
            scales = {
                "mass": momentum / lightest,
                "speed": 2 * max(scene["mass_a"], scene["mass_b"]),
                "course": momentum,
                "outside": 1.0,
            }
            for name in names:
                up, down = ({**x, name: x[name] + way * step} for way in (1, -1))
                slope = (balanced(up, pair, together)[i] - balanced(down, pair, together)[i]) / (
                    2 * step
                )
                allowed = 32 * EPS * found.condition * scales[name.partition("_")[0]] / (own * sine)
                assert abs(mp.mpf(found.sensitivity[answer][name]) - slope) <= allowed, (
                    answer,
                    name,
                )


@pytest.mark.parametrize(
    "name",
    [
        "mass_a",
        "mass_b",
        "speed_a_after",
        "speed_b_after",
        *COURSES,
        "outside_impulse_x",
        "outside_impulse_y",
    ],
)
@pytest.mark.parametrize("answer", ["speed_a", "speed_b"])
def test_sensitivities_per_unit_and_per_degree(name, answer):
    """What ``.q`` says happens when one argument is changed: per kg, per m/s, per N s, and per
    degree of a course.
    """
    units = {"mass": "m/s/kg", "speed": "", "course": "m/s/deg", "outside": "m/s/(N*s)"}
    kind = name.partition("_")[0]
    step = {"mass": 1.0, "speed": 0.01, "course": 0.01, "outside": 1.0}[kind]

    def at(way):
        if kind == "outside":
            push = [0.0, 0.0]
            push["xy".index(name[-1])] = way * step
            return getattr(crossing(outside_impulse=tuple(push)), answer)
        if kind == "course":
            return getattr(
                crossing(**{name: f"{math.degrees(CROSSING[name]) + way * step!r} deg"}), answer
            )
        return getattr(crossing(**{name: CROSSING[name] + way * step}), answer)

    found = crossing(outside_impulse=(0.0, 0.0)).q.sensitivity[answer][name]
    assert (
        found.units == pint.get_application_registry().parse_units(units[kind] or "dimensionless")
        or not units[kind]
    )
    # A step of 0.01 degrees or 1 kg: its square is 3e-8 or 7e-7; the difference rounds to 1e-15 of
    # 20 m/s over the step.
    assert found.m_as(units[kind] or "") == pytest.approx(
        (at(1) - at(-1)) / (2 * step), rel=1e-6, abs=4e-12
    )
    assert crossing().sensitivity[answer].get("outside_impulse_x") is None


@pytest.mark.parametrize(
    ("apart", "value"),
    [
        (90.0, 1.0),
        (30.0, 2 + math.sqrt(3)),
        (150.0, 2 + math.sqrt(3)),
        (-90.0, 1.0),
        (60.0, math.sqrt(3)),
    ],
)
def test_condition(apart, value):
    """(1 + |cos|) / |sin|: 1 at right angles, the cotangent of half the angle between the lines."""
    found = quietly(lambda: crossing(course_a="20 deg", course_b=f"{20 + apart!r} deg"))
    assert found.condition == pytest.approx(value, rel=8 * EPS)


@pytest.mark.parametrize("base", [0, 90, 180, 270, -90, 37])
@pytest.mark.parametrize("apart", [9.99, -9.99, 170.01, -170.01, 189.99, 3.0, 359.0, 1e-5])
def test_nearly_collinear_warns_with_the_numbers(base, apart):
    """Within 10 degrees of one line: how near, the condition, and how far a degree of the course
    that matters most goes.
    """
    with pytest.warns(col.CollisionsWarning) as caught:
        found = crossing(course_a=f"{base} deg", course_b=f"{base + apart!r} deg")
    (warning,) = (w.message for w in caught if isinstance(w.message, col.IllConditionedWarning))
    text = str(warning)
    assert warning.code == "nearly_collinear"
    assert warning.fields["condition"] == found.condition
    near = abs(math.remainder(apart, 180.0))
    stated = re.search(
        r"course_a and course_b are (\S+) degrees from one line \(condition (\S+)\)", text
    )
    assert float(stated[1]) == pytest.approx(near, rel=0.05)
    assert float(stated[2]) == pytest.approx(found.condition, rel=0.005)
    for answer in ("speed_a", "speed_b"):
        most, name = re.search(
            rf"{answer} changes by (\S+) m/s per degree of (course_\w+)", text
        ).groups()
        row = {
            key: abs(value.m_as("m/s/deg"))
            for key, value in found.q.sensitivity[answer].items()
            if key.startswith("course")
        }
        assert row[name] == max(row.values())
        assert float(most) == pytest.approx(row[name], rel=0.005)
    assert "in-line" in text


@pytest.mark.parametrize("apart", [10.01, -10.01, 169.99, 190.01, 90.0])
def test_far_enough_from_one_line_does_not_warn(apart):
    """Beyond 10 degrees nothing is said of it."""
    found = quietly(
        lambda: crossing(course_a="90 deg", course_b=f"{90 + apart!r} deg"),
        col.OutOfRangeWarning,
        col.EnergyGainWarning,
    )
    assert found.condition < 11.5


PARALLEL = [
    ("90 deg", "90 deg"), ("90 deg", "270 deg"), ("0 deg", "360 deg"), ("0 deg", "180 deg"),
        ("-90 deg", "270 deg"),
    ("0.5 turn", "180 deg"), ("90 deg", math.pi / 2), (math.pi / 2, "-90 deg"),
        ("270 deg", -math.pi / 2), ("0 deg", 0.0),
    (0.0, math.pi), (0.3, 0.3), (0.3, 0.3 + math.pi), (0.3, 0.3 - math.pi),
        (-2.0, -2.0 + math.tau), ("37.3 deg", "217.3 deg"),
]  # fmt: skip


@pytest.mark.parametrize(("one", "other"), PARALLEL)
@pytest.mark.parametrize("pair", PAIRS, ids="+".join)
def test_parallel_courses_raise(pair, one, other):
    """Also against each other, in any spelling: momentum cannot tell two speeds on one line apart,
    and others can.
    """
    scene = {
        **CROSSING,
        "speed_a": 12.0,
        "speed_b": 11.0,
        course_of(pair[0]): one,
        course_of(pair[1]): other,
    }
    with pytest.raises(col.NoSolutionError, match="parallel") as caught:
        solve(scene, pair)
    assert caught.value.code == "parallel_headings"
    for part in (
        *pair,
        "reconstruct.central",
        "reconstruct.inline_closing_speed",
        "reconstruct.speeds",
    ):
        assert part in str(caught.value)


def test_parallel_after_many_turns():
    """Courses in radians are no better known than their own rounding, which grows with the turns
    counted in.
    """
    for turns in range(1, 200, 7):
        with pytest.warns(col.SuspectUnitsWarning), pytest.raises(col.NoSolutionError) as caught:
            crossing(course_a=0.3, course_b=0.3 + math.pi * turns + 40 * math.pi)
        assert caught.value.code == "parallel_headings"


def test_parallel_and_still_raises():
    """Nothing moves and the courses are one: still no division by zero."""
    with pytest.raises(col.NoSolutionError) as caught:
        reconstruct.momentum(
            300.0, 300.0, course_a=0.0, course_b=0.0, speed_a_after=0.0, speed_b_after=0.0
        )
    assert caught.value.code == "parallel_headings"


@pytest.mark.parametrize(
    "courses", [("90 deg", "90.0000001 deg"), ("90 deg", math.pi / 2 + 1e-9), (0.3, 0.3 + 1e-12)]
)
def test_next_to_parallel_answers(courses):
    """What can be told apart is answered, to the promise; the difference of two courses is exact
    there.
    """
    scene = {**CROSSING, "course_a": courses[0], "course_b": courses[1]}
    found = quietly(lambda: solve(scene, PAIRS[0]))
    x = {
        **CROSSING,
        **{
            name: mp.mpf(float(c[:-4])) * mp.pi / 180 if isinstance(c, str) else mp.mpf(c)
            for name, c in zip(COURSES, courses, strict=False)
        },
    }
    gamma = float(x["course_b"] - x["course_a"])
    # Where a degree meets a radian the first is rounded to one: 2 eps of a right angle, over the
    # angle between them.
    mixed = 2 * EPS / gamma if isinstance(courses[0], str) != isinstance(courses[1], str) else 0.0
    for ours, exact in zip((found.speed_a, found.speed_b), balanced(x, PAIRS[0]), strict=True):
        assert abs(ours - exact) <= (8 * EPS * 20.0 / gamma) * 3 + mixed * abs(exact)
    assert found.condition == pytest.approx(2 / gamma, rel=1e-6 + mixed)


# What else can be given


def test_a_vehicle_at_rest_needs_no_course():
    """Speed 0: the same answer with any course or none; it has no row in the sensitivities and None
    as course.
    """
    known = {
        "course_a": 0.0,
        "course_a_after": 0.4,
        "course_b_after": -0.3,
        "speed_b": 0.0,
        "speed_a": 20.0,
    }
    found = reconstruct.momentum(1500, 1200, **known)
    assert found.course_b is None
    assert found.q.course_b is None
    assert "course_b" not in repr(found).replace("course_b_after", "")
    for row in found.sensitivity.values():
        assert not {"course_b", "speed_b"} & set(row)
    for course in (1.1, "90 deg"):
        other = reconstruct.momentum(1500, 1200, **known, course_b=course)
        assert (other.speed_a_after, other.speed_b_after) == (
            found.speed_a_after,
            found.speed_b_after,
        )
        assert other.sensitivity["speed_a_after"]["course_b"] == 0.0
    batch = reconstruct.momentum(1500, 1200, **{**known, "speed_b": np.zeros(3)})
    assert batch.speed_b_after.tolist() == pytest.approx([found.speed_b_after] * 3, rel=4 * EPS)


@pytest.mark.parametrize(
    ("changes", "names"),
    [
        ({"course_a_after": None}, ["course_a_after"]),
        ({"course_b": None}, ["course_b"]),
        ({"course_a": None, "course_b_after": None}, ["course_a", "course_b_after"]),
        ({"course_b_after": None, "speed_b_after": np.array([0.0, 1.0])}, ["course_b_after"]),
    ],
)
def test_missing_courses(changes, names):
    """Every course that is missing is named; only a speed of 0 needs none."""
    with pytest.raises(col.MissingInputError, match="only a speed of 0 needs none") as caught:
        crossing(**changes)
    assert caught.value.code == "missing_course"
    assert caught.value.fields["argument"] == ", ".join(names)


JOINED = {
    "mass_a": 1500.0,
    "mass_b": 1200.0,
    "course_a": 0.0,
    "course_b": "90 deg",
    "together": True,
}


@pytest.mark.parametrize(
    "after",
    [
        {"course_b_after": "35 deg", "speed_b_after": 8.0},
        {"course_a_after": "35 deg", "speed_b_after": 8.0},
        {
            "course_a_after": "35 deg",
            "course_b_after": "395 deg",
            "speed_a_after": 8.0,
            "speed_b_after": 8.0,
        },
        {"course_a_after": "35 deg", "course_b_after": math.radians(35), "speed_a_after": 8.0},
    ],
)
def test_together_takes_the_common_motion_of_either(after):
    """For one vehicle, the other, or both if they agree, in any spelling."""
    plain = reconstruct.momentum(**JOINED, course_a_after="35 deg", speed_a_after=8.0)
    found = reconstruct.momentum(**JOINED, **after)
    assert (found.speed_a, found.speed_b) == pytest.approx(
        (plain.speed_a, plain.speed_b), rel=8 * EPS
    )
    assert found.speed_a == pytest.approx(2700 / 1500 * 8 * math.cos(math.radians(35)), rel=8 * EPS)
    assert found.speed_a_after == found.speed_b_after == 8.0
    assert found.course_b_after == found.course_a_after


@pytest.mark.parametrize(
    ("after", "argument"),
    [
        (
            {"course_a_after": "35 deg", "course_b_after": "36 deg", "speed_a_after": 8.0},
            "course_b_after",
        ),
        (
            {"course_a_after": "35 deg", "course_b_after": "215 deg", "speed_a_after": 8.0},
            "course_b_after",
        ),
        ({"course_a_after": "35 deg", "speed_a_after": 8.0, "speed_b_after": 8.1}, "speed_b_after"),
    ],
)
def test_together_refuses_two_motions(after, argument):
    """Two courses (also opposite ones) or speeds of what moves as one contradict each other."""
    with pytest.raises(col.InputError, match="leave together cannot; give one of them") as caught:
        reconstruct.momentum(**JOINED, **after)
    assert caught.value.code == "contradictory"
    assert caught.value.fields["argument"] == argument


def test_together_refuses_two_motions_case_by_case():
    """In a batch only the case that contradicts itself."""
    after = {
        "course_a_after": "35 deg",
        "speed_a_after": np.array([8.0, 8.0, 8.0]),
        "speed_b_after": np.array([8.0, 8.1, 8.0]),
    }
    with pytest.warns(col.CollisionsWarning, match="1 contradictory"):
        found = reconstruct.momentum(**JOINED, **after)
    assert found.status.tolist() == [0, col.Status.CONTRADICTORY, 0]
    assert np.isnan(found.speed_a).tolist() == [False, True, False]
    with pytest.raises(col.ShapeError, match=r"speed_a_after \(3,\), speed_b_after \(2,\)"):
        reconstruct.momentum(**JOINED, **{**after, "speed_b_after": np.array([8.0, 8.0])})


def test_common_speed_asked_for():
    """One speed before and the courses: the other speed before and the common one."""
    plain = reconstruct.momentum(**JOINED, course_a_after="35 deg", speed_a_after=8.0)
    found = reconstruct.momentum(**JOINED, course_a_after="35 deg", speed_a=plain.speed_a)
    assert found.unknowns == ("speed_b", "speed_a_after")
    assert (found.speed_b, found.speed_b_after) == pytest.approx((plain.speed_b, 8.0), rel=16 * EPS)


def test_together_is_true_or_false():
    with pytest.raises(col.InputError, match="together must be True or False, got 1") as caught:
        crossing(together=1)
    assert caught.value.code == "bad_option"


@pytest.mark.parametrize("side", ["a", "b"])
@pytest.mark.parametrize(
    ("heading", "pdof"), [("0 deg", 0.0), ("90 deg", 90.0), ("180 deg", 180.0), ("-90 deg", -90.0)]
)
def test_pdof_is_clockwise_from_ahead(side, heading, pdof):
    """A vehicle is slowed in its course to the east: the force comes from the east, right of one
    that points north.
    """
    other = "b" if side == "a" else "a"
    known = {
        f"course_{side}": 0.0, f"speed_{side}": 20.0, f"course_{side}_after": 0.0,
        f"course_{other}": "90 deg", f"speed_{other}": 0.0, f"course_{other}_after": "90 deg",
        f"heading_{side}": heading,
    }  # fmt: skip
    if side == "a":
        known["course_b_after"] = "1 deg"
    else:
        known["course_a_after"] = "1 deg"
    with pytest.warns(col.IllConditionedWarning):
        found = reconstruct.momentum(1500, 1200, **known)
    # Momentum across is that of one vehicle alone: nothing moves, so the other leaves with 0 and
    # this one as it came.
    assert getattr(found, f"speed_{other}_after") == pytest.approx(0.0, abs=1e-13)
    known = {
        **known,
        f"speed_{side}_after": 12.0,
        f"course_{other}_after": "0 deg",
        f"course_{other}": "90 deg",
    }
    del known[f"speed_{other}"]
    found = reconstruct.momentum(1500, 1200, **known)
    assert getattr(found, f"pdof_{side}") == pytest.approx(math.radians(pdof), abs=1e-12)
    assert getattr(found, f"pdof_{other}") is None


def test_pdof_of_no_impulse():
    """Without a change of velocity there is no direction."""
    found = reconstruct.momentum(
        1500, 1200, course_a=0.0, course_a_after=0.0, speed_a=10.0, speed_a_after=10.0,
        course_b="90 deg", course_b_after="0 deg",
        heading_a=0.0, heading_b=0.3,
    )  # fmt: skip
    assert found.delta_v_a == found.delta_v_b == 0.0
    assert math.isnan(found.pdof_a)
    assert math.isnan(found.pdof_b)


def test_normal_gives_closing_speed_and_restitution():
    """Angle, vector of any length: the motion of the centres along it, as reconstruct.restitution
    finds it.
    """
    found = crossing(normal="-50 deg")
    moments = [
        col.Vehicle.from_speed(
            mass=getattr(found, f"mass_{name[6]}"),
            speed=getattr(found, name),
            course=getattr(found, course_of(name)),
        )
        for name in SPEEDS
    ]
    assert found.restitution == pytest.approx(
        reconstruct.restitution(*moments, normal="-50 deg"), rel=1e-12
    )
    c, s = math.cos(math.radians(-50)), math.sin(math.radians(-50))
    assert found.closing_speed == pytest.approx(c * found.speed_a - s * found.speed_b, rel=1e-14)
    assert found.q.closing_speed.check("[speed]")
    vector = crossing(normal=(3 * c, 3 * s))
    assert vector.restitution == pytest.approx(found.restitution, rel=1e-12)
    assert crossing().closing_speed is None
    assert crossing().restitution is None


def test_vehicles_that_leave_together_show_no_restitution():
    """The common motion parts from nothing: exactly 0 along any normal."""
    found = reconstruct.momentum(**JOINED, course_a_after="35 deg", speed_a_after=8.0, normal=-0.3)
    assert found.restitution == 0.0


@pytest.mark.parametrize(
    ("normal", "worst"), [("80 deg", "separating"), ("30 deg", "observed_restitution")]
)
def test_normal_that_shows_no_impact(normal, worst):
    """Centres that do not approach along it have no restitution; one outside 0 to 1 is returned;
    both are said.
    """
    with pytest.warns(col.OutOfRangeWarning) as caught:
        found = crossing(normal=normal)
    (warning,) = (w.message for w in caught)
    assert warning.code == worst
    if worst == "separating":
        assert "must point from A into B" in str(warning)
        assert f"{found.closing_speed:.6g} m/s" in str(warning)
        assert found.closing_speed < 0.0
        assert math.isnan(found.restitution)
    else:
        assert f"{found.restitution:.4g}, outside 0 to 1" in str(warning)
        assert not 0.0 <= found.restitution <= 1.0


# Energy


def test_energy_gain_warns():
    """Returned as it is, with the joules, a status, and ok False."""
    gaining = {
        "course_a": 0.0,
        "course_b": "90 deg",
        "speed_a_after": 20.0,
        "speed_b_after": 20.0,
        "course_a_after": "-60 deg",
        "course_b_after": "120 deg",
    }
    with pytest.warns(col.CollisionsWarning) as caught:
        found = reconstruct.momentum(1500, 1200, **gaining)
    (warning,) = (w.message for w in caught if isinstance(w.message, col.EnergyGainWarning))
    assert warning.code == "energy_gain"
    expected = 0.5 * 1500 * (20**2 - found.speed_a**2) + 0.5 * 1200 * (20**2 - found.speed_b**2)
    assert (
        warning.fields["gain"]
        == -found.translational_energy_loss
        == pytest.approx(expected, rel=1e-14)
    )
    assert f"{expected:.6g} J" in str(warning)
    assert found.status is col.Status.ENERGY_GAIN
    assert not found.ok
    assert math.isfinite(found.speed_a)


def test_an_outside_impulse_may_bring_energy():
    """With an impulse from outside a gain is no contradiction, and nothing is said of it."""
    scene = {
        "course_a": 0.0,
        "course_b": "90 deg",
        "speed_a": 10.0,
        "speed_b": 10.0,
        "course_a_after": 0.3,
        "course_b_after": 1.2,
    }
    found = reconstruct.momentum(1500, 1200, **scene, outside_impulse=(9e3, 9e3))
    assert found.translational_energy_loss < 0.0
    assert found.ok
    assert found.status is col.Status.OK


@pytest.mark.parametrize("pair", PAIRS, ids="+".join)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_rounding_is_no_energy_gain_and_no_restitution_above_1(pair, dtype):
    """Elastic impacts without friction lose nothing and have e = 1: what rounding makes of that, in
    either precision, is not said.
    """
    rng = np.random.default_rng(7)
    n = 400
    a, b = (
        col.Vehicle(
            mass=rng.uniform(800, 2500, n),
            vx=rng.uniform(-25, 25, n) + shift,
            vy=rng.uniform(-25, 25, n),
        )
        for shift in (30, -30)
    )
    normal = rng.uniform(-0.3, 0.3, n)
    impact = col.oblique_central(a, b, 1.0, normal=normal, friction=0.0)
    moments = dict(
        zip(SPEEDS, (impact.a.before, impact.b.before, impact.a.after, impact.b.after), strict=True)
    )
    known = {course_of(name): np.asarray(body.course) for name, body in moments.items()}
    known |= {name: np.asarray(body.speed) for name, body in moments.items() if name not in pair}
    known = {name: value.astype(dtype) for name, value in known.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.IllConditionedWarning)
        found = reconstruct.momentum(
            a.mass.astype(dtype), b.mass.astype(dtype), normal=normal.astype(dtype), **known
        )
    assert found.ok.all()
    assert (found.restitution > 1.0).any()
    assert (found.translational_energy_loss < 0.0).any()


# Bad input


@pytest.mark.parametrize(
    ("call", "code", "says"),
    [
        (lambda: crossing(speed_a=5.0), "too_many_knowns",
            ["takes exactly 2 of speed_a, speed_b, speed_a_after, speed_b_after", "got 3",
                "leave out 1"]),
        (lambda: crossing(speed_a=5.0, speed_b=5.0), "too_many_knowns", ["got 4", "leave out 2"]),
        (lambda: crossing(speed_a_after=None), "too_few_knowns",
            ["got 1 (speed_b_after)", "give 1 of speed_a, speed_b, speed_a_after"]),
        (lambda: crossing(speed_a_after=None, speed_b_after=None), "too_few_knowns",
            ["got 0 (none)", "give 2"]),
        (lambda: crossing(together=True, course_b_after=None, speed_b_after=None, speed_a=5.0),
            "too_many_knowns", ["exactly 1 of speed_a, speed_b, speed_a_after"]),
        (lambda: crossing(speed_a_after=-9.0), "negative_speed",
            ["speed_a_after must be >= 0, got -9.0", "turn its course by 180 deg"]),
        (lambda: crossing(speed_a_after="-9 km/h"), "negative_speed", ["'-9 km/h'"]),
        (lambda: crossing(mass_a=0.0), "not_positive", ["mass_a must be > 0"]),
        (lambda: crossing(mass_b=-5.0), "not_positive", ["mass_b", "-5.0"]),
        (lambda: crossing(mass_b=math.nan), "not_finite", ["mass_b is NaN"]),
        (lambda: crossing(course_b=math.nan), "not_finite", ["course_b is NaN"]),
        (lambda: crossing(course_b=math.inf), "not_finite", ["course_b must be finite"]),
        (lambda: crossing(speed_a_after=math.inf), "not_finite", ["speed_a_after must be finite"]),
        (lambda: crossing(outside_impulse=(1.0, math.nan)), "not_finite",
            ["outside_impulse[1] is NaN"]),
        (lambda: crossing(outside_impulse=3.0), "bad_shape",
            ["outside_impulse must be a pair (x, y)"]),
        (lambda: crossing(normal=[1.0, 0.0]), "bad_shape", ["(nx, ny)", "np.array"]),
        (lambda: crossing(normal=(0.0, 0.0)), "zero_normal", ["normal has no length"]),
        (lambda: crossing(heading_a=math.nan), "not_finite", ["heading_a is NaN"]),
        (lambda: crossing(on_failure="ignore"), "bad_option", ["on_failure", "'raise'", "'nan'"]),
        (lambda: crossing(speed_a_after=1e200), "out_of_range", ["not a finite number"]),
        (lambda: crossing(speed_a_after=1e308, mass_a=1e5), "out_of_range",
            ["not a finite number"]),
        (lambda: crossing(speed_a_after=np.ones(3), course_b=np.ones(4)), "bad_shape",
            ["speed_a_after (3,)", "course_b (4,)"]),
        (lambda: crossing(mass_a="1500 N"), "bad_units", ["mass_a", "weight"]),
        (lambda: crossing(course_a="90 km/h"), "bad_units", ["course_a"]),
        (lambda: crossing(speed_a_after=True), "not_a_number", ["speed_a_after"]),
        (lambda: crossing(mass_a=-1.0, speed_a_after=-9.0, course_b=math.nan), "several",
            ["mass_a", "speed_a_after", "course_b"]),
    ],
)  # fmt: skip
def test_bad_input(call, code, says):
    """The error, its code, and what it tells; all wrong arguments in one."""
    with pytest.raises(col.InputError) as caught:
        call()
    for part in says:
        assert part in str(caught.value)
    assert caught.value.code == code or code == "several"
    twin = pickle.loads(pickle.dumps(caught.value))
    assert (type(twin), str(twin), twin.code) == (
        type(caught.value),
        str(caught.value),
        caught.value.code,
    )


@pytest.mark.parametrize("which", ["mass_a", "mass_b"])
def test_infinite_mass(which):
    """The momentum of a barrier tells nothing; the message names what can be used."""
    with pytest.raises(
        col.NoSolutionError,
        match=r"reconstruct\.central, reconstruct\.planar or reconstruct\.speeds",
    ) as caught:
        crossing(**{which: math.inf})
    assert caught.value.code == "infinite_mass"


# Batches

CASES = {
    "mass_a": [1500.0, math.inf, 1500.0, 1500.0, 1500.0, -math.inf, 1500.0, 1500.0, 1500.0,
    1500.0, 1500.0],
    "course_b": [1.5, 1.5, 0.0, 1.5, math.nan, 1.5, 1.5, 1.5, 1.5, 1.5, 1.7],
    "speed_a_after": [9.0, 9.0, 9.0, -9.0, 9.0, 9.0, 1e200, 9.0, 9.0, 9.0, 10.0],
    "heading_a": [0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, math.nan, 0.1, 0.1, 0.2],
}  # fmt: skip
NORMALS = ([1.0] * 8 + [0.0, math.inf, 1.0], [0.1] * 8 + [0.0, 0.1, -0.2])
LANE_STATUS = [
    "ok", "infinite_mass", "parallel_headings", "contradictory", "not_finite", "not_positive",
    "out_of_range", "not_finite",
    "zero_normal", "not_finite", "ok",
]  # fmt: skip
ANSWERS = (
    *SPEEDS,
    "delta_v_a",
    "delta_v_b",
    "pdof_a",
    "closing_speed",
    "restitution",
    "translational_energy_loss",
    "condition",
)


def cases(keep=slice(None), **options):
    """A batch with every refusal between two cases that can be answered."""
    columns = {name: np.array(values)[keep] for name, values in CASES.items()}
    return crossing(**columns, normal=tuple(np.array(part)[keep] for part in NORMALS), **options)


def test_refused_cases_of_a_batch():
    """NaN and a status each, one warning that counts them, neighbours bit for bit as in a batch of
    their own.
    """
    with pytest.warns(col.CollisionsWarning, match="9 of 11 cases were refused") as caught:
        found = cases()
    assert len(caught) == 1
    assert [col.Status(code).label for code in found.status] == LANE_STATUS
    good = np.array(LANE_STATUS) == "ok"
    assert found.ok.tolist() == good.tolist()
    alone = cases(keep=good)
    for name in ANSWERS:
        values = getattr(found, name)
        assert np.isnan(values[~good]).all(), name
        assert values[good].tolist() == getattr(alone, name).tolist(), name
    for answer, row in found.sensitivity.items():
        for name, values in row.items():
            assert np.isnan(values[~good]).all()
            assert values[good].tolist() == alone.sensitivity[answer][name].tolist()


def test_batch_agrees_with_single_cases():
    """The cases one by one, to a few eps; their refusals with the same label."""
    found = cases(on_failure="nan")
    for i, label in enumerate(LANE_STATUS):
        one = {name: values[i] for name, values in CASES.items()}
        normal = tuple(part[i] for part in NORMALS)
        if label == "ok":
            single = crossing(**one, normal=normal)
            for name in ANSWERS:
                assert getattr(found, name)[i] == pytest.approx(
                    getattr(single, name), rel=64 * EPS
                ), name
                assert type(getattr(single, name)) is float
        elif label == "contradictory":
            with pytest.raises(col.InputError, match="must be >= 0"):
                crossing(**one, normal=normal)
        else:
            with pytest.raises(col.CollisionsError) as caught:
                crossing(**one, normal=normal)
            assert caught.value.code == label


@pytest.mark.parametrize(
    ("first", "kind"),
    [(1, col.NoSolutionError), (2, col.NoSolutionError), (3, col.InputError), (8, col.InputError)],
)
def test_a_batch_may_raise(first, kind):
    """on_failure="raise" names the case and says what a single one says."""
    with pytest.raises(kind, match="case 1") as caught:
        cases(keep=[0, first, 10], on_failure="raise")
    assert caught.value.code == LANE_STATUS[first]
    if LANE_STATUS[first] == "contradictory":
        assert "turn its course by 180 deg" in str(caught.value)


def test_a_single_case_may_be_nan():
    """on_failure="nan" answers a refused case with NaN and its status, without a word."""
    found = crossing(course_b=0.0, on_failure="nan")
    assert found.status is col.Status.PARALLEL_HEADINGS
    assert not found.ok
    assert math.isnan(found.speed_a)
    assert math.isnan(found.condition)
    assert math.isnan(found.sensitivity["speed_a"]["mass_a"])


def test_warnings_of_a_batch_count_their_cases():
    """One warning of a kind, with the number of cases and the worst of them."""
    with pytest.warns(col.CollisionsWarning) as caught:
        found = crossing(
            course_b=np.array([1.5, 0.05, 0.1, 1.5]), course_a=np.array([0.0, 0.0, 0.0, math.pi])
        )
    by_code = {w.message.code: w.message for w in caught}
    negatives = int((found.speed_a < 0).any()) + int((found.speed_b < 0).any())
    assert by_code.keys() - {"energy_gain"} == {"nearly_collinear", "negative_speed"}
    assert len(caught) == len(by_code) - 1 + negatives
    assert str(by_code["nearly_collinear"]).startswith("2 of 4 cases: ")
    assert by_code["nearly_collinear"].fields["condition"] == found.condition[1]
    assert by_code["negative_speed"].fields["value"] == min(
        found.speed_a.min(), found.speed_b.min()
    )


def test_shapes_broadcast():
    """A column of masses against a row of courses."""
    found = crossing(
        mass_a=np.array([[1000.0], [1500.0]]),
        course_b=np.array([1.3, 1.5, 1.7]),
        on_failure="raise",
    )
    for name in (*SPEEDS, *COURSES, "mass_a", "condition", "status", "ok"):
        assert getattr(found, name).shape == (2, 3), name
    assert found.sensitivity["speed_b"]["course_a"].shape == (2, 3)
    single = crossing(mass_a=1000.0, course_b=1.7)
    assert found.speed_b[0, 2] == pytest.approx(single.speed_b, rel=8 * EPS)
    with pytest.raises(ValueError, match="read-only"):
        found.speed_b[0, 0] = 1.0


def test_single_precision():
    """float32 in, float32 out, right to its own eps times condition; parallel where its pi cannot
    be told from a half turn.
    """
    single = {name: np.array([value, value], dtype=np.float32) for name, value in CROSSING.items()}
    found = reconstruct.momentum(
        **single, heading_a=np.float32(0.1), normal=np.array([0.2, 0.2], dtype=np.float32)
    )
    exact = crossing(normal=0.2)
    for name in (
        *SPEEDS,
        *COURSES,
        "delta_v_a",
        "closing_speed",
        "restitution",
        "condition",
        "translational_energy_loss",
    ):
        assert getattr(found, name).dtype == np.float32, name
        assert getattr(found, name) == pytest.approx(getattr(exact, name), rel=4e-5), (
            name
        )  # 64 eps of float32, twice
    assert found.sensitivity["speed_a"]["course_b"].dtype == np.float32
    assert crossing(mass_a=np.array([1500.0, 1500.0])).speed_a.dtype == np.float64
    single["course_a"][1], single["course_b"][1] = 0.0, np.pi
    with pytest.warns(col.CollisionsWarning, match="1 parallel_headings"):
        found = reconstruct.momentum(**single)
    assert found.status.tolist() == [0, col.Status.PARALLEL_HEADINGS]


# The result


def test_units_of_arguments():
    """Quantities of another registry and texts are the same numbers."""
    ureg = other_registry()
    found = crossing(
        mass_a=ureg.Quantity(1500.0 / 0.45359237, "lb"), mass_b="1.2 t",
        course_b=ureg.Quantity(90.0, "deg"),
        course_a_after=f"{math.degrees(0.9)!r} deg", speed_a_after="32.4 km/h",
        speed_b_after=ureg.Quantity(8.0 / 0.44704, "mph"),
    )  # fmt: skip
    plain = crossing()
    for name in (*SPEEDS, *COURSES, "mass_a", "mass_b"):
        assert getattr(found, name) == pytest.approx(getattr(plain, name), rel=1e-14), name


def test_right_angles_in_degrees_are_exact():
    """At exact right angles each speed is one component, without a trace of the other."""
    found = reconstruct.momentum(
        1000,
        1000,
        course_a="0 deg",
        course_b="90 deg",
        course_a_after="360 deg",
        course_b_after="450 deg",
        speed_a_after=3.0,
        speed_b_after=4.0,
    )
    assert (found.speed_a, found.speed_b, found.condition) == (3.0, 4.0, 1.0)


def test_attributes_with_units():
    """``.q`` has every attribute in its unit, texts show it, and repr leaves out what was not asked
    for.
    """
    found = crossing(heading_a="10 deg", normal=0.1)
    assert found.q.speed_a.m_as("km/h") == pytest.approx(3.6 * found.speed_a, rel=1e-15)
    assert found.q.course_b.m_as("deg") == pytest.approx(90.0, rel=1e-15)
    assert found.q.mass_a.check("[mass]")
    assert found.q.translational_energy_loss.check("[energy]")
    assert found.q.condition.check("[]")
    with pytest.raises(
        col.MissingInputError,
        match=r"pdof_b needs a heading, which was not given; write heading_b='30 deg'",
    ):
        _ = found.q.pdof_b
    with pytest.raises(
        col.MissingInputError,
        match=r"restitution needs a normal, which was not given; write normal=",
    ):
        _ = crossing().q.restitution
    assert found.q.outside_impulse_x is None
    assert found.q.unknowns == ("speed_a", "speed_b")
    text = repr(found)
    assert text.startswith("MomentumSolution(")
    assert f"speed_a={found.speed_a:.6g} m/s" in text
    assert "pdof_a" in text
    assert "pdof_b" not in text
    html = found._repr_html_()
    assert "Planar momentum" in html
    assert f"{found.speed_a:.6g} m/s" in html


def test_frozen_and_pickled():
    """An answer cannot be changed, and comes back from a pickle and a copy with all it holds."""
    found = crossing(heading_a=0.1, normal=0.1)
    with pytest.raises(dataclasses.FrozenInstanceError):
        found.speed_a = 1.0
    for twin in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        for field in dataclasses.fields(found):
            assert getattr(twin, field.name) == getattr(found, field.name), field.name
        assert (
            twin.q.sensitivity["speed_a"]["course_b"] == found.q.sensitivity["speed_a"]["course_b"]
        )
        assert repr(twin) == repr(found)
    batch = pickle.loads(pickle.dumps(crossing(mass_a=np.array([1000.0, 1200.0]))))
    assert not batch.speed_a.flags.writeable
    assert not batch.sensitivity["speed_a"]["course_b"].flags.writeable


def test_sensitivities_of_a_batch_are_equal_by_value():
    """Not as arrays are, which have no truth value."""
    knowns = {
        "course_b": 1.5,
        "course_a_after": 0.5,
        "course_b_after": 0.7,
        "speed_a_after": 10.0,
        "speed_b_after": 8.0,
    }
    one, twin = (
        reconstruct.momentum(1000.0, 1200.0, course_a=np.array([0.0, 0.1]), **knowns).sensitivity
        for _ in range(2)
    )
    single = reconstruct.momentum(1000.0, 1200.0, course_a=0.0, **knowns).sensitivity
    assert one == twin
    assert one.__ne__(twin) is False
    assert one != single
    assert single != one


@pytest.mark.parametrize("course", ["0 deg", 0.0, "360 deg", math.tau])
def test_what_a_right_angle_leaves_is_no_sensitivity(course):
    """Turning the course of A does not move A's own speed where B's is across it: exactly 0, and
    nothing that rounding left.
    """
    found = reconstruct.momentum(
        1500, 1300, course_a=course, course_b="90 deg", course_a_after="25 deg",
        course_b_after="40 deg", speed_a_after=10.0,
        speed_b_after=12.0,
    )  # fmt: skip
    assert found.sensitivity["speed_a"]["course_a"] == 0.0
    assert found.sensitivity["speed_b"]["course_b"] == 0.0
    assert math.copysign(1.0, found.sensitivity["speed_a"]["course_a"]) == 1.0
    # d v_B / d course_a = -v_A / 1 at right angles, in closed form: m_B v_B = momentum across A's
    # course.
    moved = -1500 * found.speed_a / 1300
    assert found.sensitivity["speed_b"]["course_a"] == pytest.approx(moved, rel=1e-12)


def test_a_report_has_sensitivities_per_degree():
    """In SI too, without powers of ten."""
    import collisions as col

    found = reconstruct.momentum(
        1500, 1300, course_a=0.0, course_b="90 deg", course_a_after="25 deg",
        course_b_after="40 deg", speed_a_after=10.0,
        speed_b_after=12.0,
    )  # fmt: skip
    rows = [
        line
        for line in col.report(found, form="markdown", units="si").splitlines()
        if "moved by course" in line
    ]
    assert len(rows) == 8
    assert all(line.endswith(" m/s per ° |") for line in rows)
    assert sum(" 0 m/s per" in line for line in rows) == 2
    assert not any("e-1" in line for line in rows)


def test_an_impulse_from_outside_excuses_no_more_energy_than_it_can_bring():
    """Its size times the greatest speed, whatever that of its work was."""
    courses = {"course_a": "-45 deg", "course_b": "45 deg", "course_a_after": "60 deg"}
    known = {**courses, "course_b_after": "-60 deg", "speed_a_after": 20.0, "speed_b_after": 20.0}
    with pytest.warns(col.EnergyGainWarning) as caught:
        gain = -reconstruct.momentum(1000.0, 1000.0, **known).translational_energy_loss
    assert caught[0].message.fields["gain"] == gain > 0.0
    for size in (0.0, 1e-6, 100.0):
        with pytest.warns(col.EnergyGainWarning):
            reconstruct.momentum(1000.0, 1000.0, **known, outside_impulse=(0.0, size))
    # A car that is pushed from 10 to 15 m/s while it meets another.
    push = 1000.0 * 5.0
    given = {"course_a": 0.0, "course_b": 1.5, "course_a_after": 0.0, "course_b_after": 1.5}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = reconstruct.momentum(
            1000.0, 1000.0, **given, speed_a=10.0, speed_b=5.0, outside_impulse=(push, 0.0)
        )
    assert found.speed_a_after == pytest.approx(15.0)
    assert found.translational_energy_loss < 0.0
