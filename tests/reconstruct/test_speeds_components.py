"""Speeds from components of delta-V: round trips, closed forms, conditions, what is refused, and
folds of the magnitude.
"""

import json
import math
import pickle
import warnings
from functools import cache

import mpmath
import numpy as np
import pytest

import collisions as col
from collisions import travel, uncertainty
from collisions.reconstruct import speeds
from collisions.uncertainty import Normal, propagate
from scenes import LAWS

VALUES = {
    "friction": (0.0, 0.3, 0.8, math.inf),
    "impulse_ratio": (-0.4, 0.3),
    "critical_fraction": (0.0, 1.0),
}
A = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.0, y=0.0, heading=0.1)
B = col.Vehicle(mass=1300.0, yaw_inertia=2000.0, x=2.0, y=0.8, heading=1.5)
COURSES = {"course_a": 0.1, "course_b": 1.5}
CONTACT = {"normal": 0.1, "point": (0.0, 0.4)}


def body(speed, course, **fields):
    return col.Vehicle.from_speed(speed=speed, course=course, **fields)


@cache
def hits(seed=1, count=60):
    """Random cars that met: their speeds, courses, the contact and the forward answer."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < count:
        rule = ("friction", "friction", "impulse_ratio", "critical_fraction")[rng.integers(4)]
        contact = {
            "normal": rng.uniform(-0.6, 0.6),
            "point": tuple(rng.uniform((-0.4, -0.8), (0.4, 0.8)).tolist()),
        }
        contact |= {rule: float(rng.choice(VALUES[rule])), "law": LAWS[rng.integers(2)]}
        courses, both = rng.uniform(-3, 3, 2), rng.uniform(1, 25, 2)
        bodies = [
            body(
                both[i], courses[i], mass=rng.uniform(800, 3000),
                    yaw_inertia=rng.uniform(800, 4000), x=x + rng.uniform(-0.5, 0.5),
                y=rng.uniform(-1, 1), yaw_rate=rng.choice((0.0, rng.uniform(-1, 1))),
                heading=rng.uniform(-3, 3),
            )
            for i, x in enumerate((-2.0, 2.0))
        ]  # fmt: skip
        try:
            impact = col.eccentric(*bodies, rng.uniform(0.0, 0.5), **contact)
        except (col.NoImpactError, col.NoSolutionError, col.EnergyGainWarning):
            continue
        if abs(math.sin(courses[0] - courses[1])) > 0.18:  # nearer to one line is warned of
            found.append((impact, both, courses, contact))
    return found


def recorded(impact, *labels, parts=("forward", "left")):
    return {
        f"delta_v_{part}_{label}": getattr(getattr(impact, label), f"delta_v_{part}")
        for label in labels
        for part in parts
    }


def solve_back(impact, courses, contact, **known):
    a, b = (side.before.replace(vx=77.0, vy=-55.0) for side in (impact.a, impact.b))
    given = {
        "course_a": courses[0],
        "course_b": courses[1],
        "restitution": impact.restitution,
        **contact,
        **known,
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        return speeds(a, b, **given)


def off(one, other):
    return max(
        abs(getattr(getattr(one, s).before, v) - getattr(getattr(other, s).before, v))
        for s in "ab"
        for v in ("vx", "vy")
    )


KNOWNS = {
    "one recorder": lambda impact, both: recorded(impact, "a"),
    "the other recorder": lambda impact, both: recorded(impact, "b"),
    "both": lambda impact, both: recorded(impact, "a", "b"),
    "both forward": lambda impact, both: recorded(impact, "a", "b", parts=("forward",)),
    "and a speed": lambda impact, both: recorded(impact, "a") | {"speed_b": both[1]},
    "forward and a speed": lambda impact, both: (
        recorded(impact, "a", parts=("forward",)) | {"speed_b": both[1]}
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", KNOWNS)
def test_round_trips(kind):
    """The speeds come out again to rounding times the condition; where the contact slid, one of
    them must be known. Where one that stuck and one that slid fit, both are offered.
    """
    answered = 0
    for impact, both, courses, contact in hits():
        known = KNOWNS[kind](impact, both)
        sticks = impact.regime == "sticking" or contact.get("critical_fraction") == 1.0
        if "speed_b" not in known and not sticks:
            with pytest.raises(
                col.NoSolutionError, match=r"(slides|without friction).*give one of the speeds"
            ) as caught:
                solve_back(impact, courses, contact, **known)
            assert caught.value.code == "undetermined"
            continue
        if "speed_b" not in known and "friction" in contact:
            known["regime"] = "sticking"
        try:
            found = solve_back(impact, courses, contact, **known)
        except col.AmbiguousSolutionError as error:
            if contact.get("friction") != math.inf or "speed_b" not in known:
                raise
            found = error.solutions
        known.pop("regime", None)
        nearest = min(found, key=lambda root: off(root, impact))
        # Some tens of eps of what was given, as much larger as the condition says; the ratio a root
        # may hang on is not in it.
        allowed = (
            1e-12 * max(nearest.reconstruction.condition, 1.0) * (impact.closing_speed + sum(both))
        )
        assert off(nearest, impact) < allowed
        assert nearest.reconstruction.known == tuple(
            sorted(known, key=lambda name: not name.startswith("speed"))
        )
        answered += 1
    assert answered > 15


@pytest.mark.slow
def test_a_batch_is_its_cases():
    """As one by one; refused cases are NaN with their status, the others untouched."""
    sticks = [
        hit
        for hit in hits()
        if hit[0].regime == "sticking"
        and hit[3]["law"] == "kudlich-slibar"
        and "friction" in hit[3]
    ][:4]
    impacts, _, courses, contacts = zip(*sticks, strict=True)

    def together(of):
        return np.array([of(impact) for impact in impacts])

    a, b = (
        col.Vehicle(
            **{n: together(lambda i, s=s, n=n: getattr(getattr(i, s).before, n)) for n in ("mass",
            "yaw_inertia", "x", "y", "yaw_rate", "heading")}
        )
        for s in "ab"
    )  # fmt: skip
    known = {
        name: together(lambda i, name=name: recorded(i, "a", "b")[name])
        for name in recorded(impacts[0], "a", "b")
    }
    contact = {
        "normal": np.array([c["normal"] for c in contacts]),
        "point": tuple(np.array([c["point"] for c in contacts]).T),
        "law": "kudlich-slibar",
        "friction": np.array([c["friction"] for c in contacts]),
        "restitution": together(lambda i: i.restitution),
        "course_a": np.array([c[0] for c in courses]),
        "course_b": np.array([c[1] for c in courses]),
    }
    contact["regime"] = "sticking"
    with pytest.warns(col.IllConditionedWarning, match="3 of 4 cases: to stick"):
        (found,) = speeds(a, b, **contact, **known)
    for i, (impact, _, ways, one) in enumerate(sticks):
        known_here = recorded(impact, "a", "b") | {"regime": "sticking"}
        (alone,) = solve_back(impact, ways, one, **known_here)
        assert found.a.before.speed[i] == pytest.approx(alone.a.before.speed, rel=1e-13)
        assert found.reconstruction.condition[i] == pytest.approx(
            alone.reconstruction.condition, rel=1e-9
        )
    # A third of them contradictory, NaN, or of nothing.
    spoilt = known | {"delta_v_left_a": known["delta_v_left_a"] * [1.0, math.nan, 1.0, 1.0]}
    spoilt["delta_v_forward_b"] = known["delta_v_forward_b"] * [1.0, 1.0, -9.0, 1.0]
    with pytest.warns(col.CollisionsWarning, match=r"2 of 4|of 4 cases: to stick"):
        (mixed,) = speeds(a, b, **contact, **spoilt)
    assert mixed.refused.tolist() == [False, True, True, False]
    assert mixed.a.before.vx[[0, 3]].tolist() == found.a.before.vx[[0, 3]].tolist()
    assert col.Status(int(mixed.status[2])).label == "contradictory"
    single = {
        name: value.astype(np.float32)
        for name, value in (known | contact).items()
        if isinstance(value, np.ndarray)
    }
    single = contact | single | {"point": tuple(p.astype(np.float32) for p in contact["point"])}
    a32, b32 = (
        v.replace(
            **{
                n: getattr(v, n).astype(np.float32)
                for n in ("mass", "yaw_inertia", "x", "y", "yaw_rate", "heading")
            }
        )
        for v in (a, b)
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        (rough,) = speeds(a32, b32, **single)
    assert rough.a.before.vx.dtype == np.float32
    np.testing.assert_allclose(rough.a.before.speed, found.a.before.speed, rtol=1e-4)
    empty = {name: np.zeros(0) for name in ("delta_v_forward_a", "delta_v_left_a")}
    (none,) = speeds(A, B, **GIVEN, **empty)
    assert none.a.before.vx.shape == (0,)


def points(**changes):
    """Point masses that stay together: dV_a is the share of B's mass of the velocity of B relative
    to A.
    """
    masses = {"a": 1500.0, "b": 1200.0} | changes
    a, b = (
        col.Vehicle(mass=masses[s], yaw_inertia=math.inf, x=x, y=0.0, heading=h)
        for s, x, h in (("a", -2.0, 0.3), ("b", 2.0, 2.0))
    )
    return (
        a,
        b,
        {
            "course_a": 0.3,
            "course_b": 2.0,
            "restitution": 0.0,
            "normal": 0.5,
            "point": (0.0, 0.0),
            "friction": math.inf,
            "regime": "sticking",
        },
    )


def test_closed_form_and_condition_of_point_masses():
    """Relative velocity (va ua - vb ub) = -dV_a / f_b: two equations, solved and differentiated
    with 40 digits.
    """
    a, b, contact = points()
    known = {"delta_v_forward_a": -7.0, "delta_v_left_a": 4.0}
    with pytest.warns(col.IllConditionedWarning, match=r"an impulse ratio of 0\.88"):
        (found,) = speeds(a, b, **contact, **known)
    with mpmath.workdps(40):
        share = mpmath.mpf(1200) / 2700
        ways = mpmath.matrix(
            [[mpmath.cos("0.3"), -mpmath.cos(2)], [mpmath.sin("0.3"), -mpmath.sin(2)]]
        )
        axes = mpmath.matrix(
            [[mpmath.cos("0.3"), -mpmath.sin("0.3")], [mpmath.sin("0.3"), mpmath.cos("0.3")]]
        )
        per_known = -(ways**-1) * axes / share
        exact = per_known * mpmath.matrix([-7, 4])
        closing = (ways * exact).T * mpmath.matrix([mpmath.cos("0.5"), mpmath.sin("0.5")])
        condition = (
            max(abs(per_known[i, 0] * 7) + abs(per_known[i, 1] * 4) for i in range(2)) / closing[0]
        )
    # The angles are rounded to 1e-16, which moves the answers by some eps.
    assert found.a.before.speed == pytest.approx(float(exact[0]), rel=1e-14)
    assert found.b.before.speed == pytest.approx(float(exact[1]), rel=1e-14)
    assert found.reconstruction.condition == pytest.approx(float(condition), rel=1e-12)
    # With a speed known the forward component alone tells the other: one equation.
    with pytest.warns(col.IllConditionedWarning, match="this is not the impact"):
        (one,) = speeds(a, b, **contact, speed_a=float(exact[0]), delta_v_forward_a=-7.0)
    assert one.b.before.speed == pytest.approx(float(exact[1]), rel=1e-13)
    by_b = 1 / abs(math.cos(2.0 - 0.3)) / float(share)
    by_a = abs(1 / math.cos(2.0 - 0.3)) * float(exact[0])
    assert one.reconstruction.condition == pytest.approx(
        (by_b * 7 + by_a) / float(closing[0]), rel=1e-12
    )


@pytest.mark.slow
def test_two_recorders_give_the_mean_of_their_impulses():
    """The impulse is linear in the speeds of a contact that sticks, so least squares is the mean of
    both answers.
    """
    a, b = A.replace(yaw_rate=0.2), B
    hit = col.eccentric(
        body(15.0, 0.1, **fields(a)),
        body(12.0, 1.5, **fields(b)),
        0.1,
        **CONTACT,
        friction=math.inf,
    )
    of_a = {
        "delta_v_forward_a": hit.a.delta_v_forward * 1.05,
        "delta_v_left_a": hit.a.delta_v_left * 0.97,
    }
    of_b = {
        "delta_v_forward_b": hit.b.delta_v_forward * 0.96,
        "delta_v_left_b": hit.b.delta_v_left * 1.02,
    }
    given = GIVEN
    (by_a,), (by_b,), (by_both,) = (
        speeds(a, b, **given, **known) for known in (of_a, of_b, of_a | of_b)
    )
    for side in "ab":
        mean = (getattr(by_a, side).before.speed + getattr(by_b, side).before.speed) / 2
        assert getattr(by_both, side).before.speed == pytest.approx(mean, rel=1e-13)
    # Beyond the stated accuracy they are warned of, far beyond it refused.
    louder = of_a | {name: 1.3 * value for name, value in of_b.items()}
    with pytest.warns(
        col.IllConditionedWarning, match="the stated accuracy of recorders is 10%"
    ) as caught:
        speeds(a, b, **given, **louder)
    assert caught[0].message.code == "recorders_differ"
    assert caught[0].filename == __file__
    with pytest.raises(col.NoSolutionError, match="no speeds along these courses fit") as refused:
        speeds(a, b, **given, **of_a, **{name: -value for name, value in of_b.items()})
    assert refused.value.code == "contradictory"


def fields(vehicle):
    return {
        name: getattr(vehicle, name)
        for name in ("mass", "yaw_inertia", "x", "y", "yaw_rate", "heading")
    }


@pytest.mark.slow
def test_a_sliding_contact_takes_the_impulse_along_its_friction():
    """With a speed known the measured impulse is projected on the direction (1, mu): least squares
    by hand.
    """
    mu, a, b = 0.1, A, B
    hit = col.eccentric(
        body(15.0, 0.1, **fields(a)), body(12.0, 1.5, **fields(b)), 0.1, **CONTACT, friction=mu
    )
    assert hit.regime == "sliding"
    known = {
        "delta_v_forward_a": 0.96 * hit.a.delta_v_forward,
        "delta_v_left_a": 1.05 * hit.a.delta_v_left,
    }
    given = {**COURSES, **CONTACT, "restitution": 0.1, "friction": mu}
    (found,) = speeds(a, b, **given, **known, speed_b=12.0)
    assert found.regime == "sliding"
    assert found.b.before.speed == pytest.approx(12.0, rel=1e-13)
    angle = 0.1 - 0.1  # heading of A less the normal
    pn = -a.mass * (
        known["delta_v_forward_a"] * math.cos(angle) - known["delta_v_left_a"] * math.sin(angle)
    )
    pt = -a.mass * (
        known["delta_v_forward_a"] * math.sin(angle) + known["delta_v_left_a"] * math.cos(angle)
    )
    sign = math.copysign(1.0, hit.tangential_impulse)
    assert found.normal_impulse == pytest.approx((pn + sign * mu * pt) / (1 + mu * mu), rel=1e-12)
    # The pair alone: its direction only repeats the friction.
    with pytest.raises(col.NoSolutionError, match="direction only repeats the friction") as caught:
        speeds(a, b, **given, **known)
    assert caught.value.code == "undetermined"
    # Within the friction but within the accuracy of its edge, that it stuck has to be stated; a
    # ratio of 0.1 is far below any that slides between vehicles, so nothing is said then.
    inside = {
        "delta_v_forward_a": 1.05 * hit.a.delta_v_forward,
        "delta_v_left_a": hit.a.delta_v_left,
    }
    with pytest.raises(col.AmbiguousSolutionError, match="whether the contact stuck or slid"):
        speeds(a, b, **given, **inside)
    speeds(a, b, **given, **inside, regime="sticking")


@pytest.mark.slow
def test_no_speed_fits_the_components_better():
    """With one speed known, against a scan of the other by the forward solver: stuck, slid, or on
    the edge between both.
    """
    rng, edges, answered = np.random.default_rng(5), 0, 0
    frictional = [hit for hit in hits(seed=3, count=80) if 0.0 < hit[3].get("friction", 0.0) < 1.0]
    for impact, both, courses, true_contact in frictional:
        exact = recorded(impact, "a")
        # A friction that is not quite the true one, so that the answer may lie on the edge.
        contact = true_contact | {"friction": abs(impact.impulse_ratio) * rng.uniform(0.85, 1.15)}
        noise = 0.1 * impact.a.delta_v * rng.uniform(-1, 1, 2)
        known = {name: value + off for (name, value), off in zip(exact.items(), noise, strict=True)}
        others = both[1] + np.linspace(-30.0, 30.0, 6001)
        scanned = impact.b.before.replace(
            vx=others * math.cos(courses[1]), vy=others * math.sin(courses[1])
        )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            seen = col.eccentric(
                impact.a.before, scanned, impact.restitution, **contact, on_failure="nan"
            ).a
        misfits = np.hypot(*(getattr(seen, name[:-2]) - value for name, value in known.items()))
        least = np.nanmin(misfits)
        root, refusal = None, None
        try:
            root = solve_back(impact, courses, contact, **known, speed_a=both[0])[0]
        except col.NoSolutionError as error:
            refusal = error
        if refusal is not None:
            assert least > 0.25 * impact.a.delta_v, refusal
            continue
        answered += 1
        misfit = math.hypot(*(getattr(root.a, name[:-2]) - value for name, value in known.items()))
        # The scan comes within its step of the best; the answer must not be worse.
        assert misfit <= least * (1.0 + 1e-9)
        edges += abs(abs(root.critical_impulse_ratio) - contact["friction"]) < 1e-9
    assert answered > 10
    assert edges > 0


@pytest.mark.slow
def test_forward_only_leaves_backward_roots_out():
    """A root with a negative speed is one of two, or the only one: then nothing is left."""
    hit = col.eccentric(A.replace(vx=12.0), B.replace(vx=-5.0), 0.1, **CONTACT, friction=0.5)
    given = {"course_a": 0.0, "course_b": 0.0, "restitution": 0.1, **CONTACT, "friction": 0.5}
    known = {"speed_a": 12.0, "delta_v_b": hit.b.delta_v}
    with pytest.warns(col.OutOfRangeWarning, match="backwards along its course"):
        (found,) = speeds(A, B, **given, **known)
    assert found.b.before.vx == pytest.approx(-5.0, rel=1e-12)
    with pytest.raises(col.NoSolutionError, match="a vehicle goes backwards along its") as told:
        speeds(A, B, **given, **known, forward_only=True)
    assert "B would go backwards along its course at 5 m/s" in str(told.value)
    fold = fold_scene()
    with pytest.warns(col.OutOfRangeWarning, match="backwards"):
        assert len(fold(40.0)) == 2
    (ahead,) = fold(40.0, forward_only=True)
    assert ahead.b.before.speed > 47.3 / 3.6
    with pytest.warns(col.OutOfRangeWarning):
        first, second = fold(np.array([28.5, 40.0]))
    assert np.isfinite(first.b.before.speed).all()
    only, rest = fold(np.array([28.5, 40.0]), forward_only=True)
    assert only.b.before.speed.tolist() == pytest.approx(
        [first.b.before.speed[0], second.b.before.speed[1]]
    )
    assert np.isnan(rest.b.before.speed).tolist() == [False, True]


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_forward_only_is_said_and_warns_of_samples_of_two_answers():
    """Where the lower answer goes backwards in some samples alone, the first answer is the lower
    one here and the upper one there; the record and every page say that answers were left out.
    """
    fold = fold_scene()

    def codes(mean, sd, forward_only=True):
        got = uncertainty.propagate(
            lambda delta_v: {"b": fold(delta_v, forward_only=forward_only)[0].speed_b},
            {"delta_v": uncertainty.Normal(mean, sd)},
            samples=64,
            seed=1,
        )
        return " ".join(got.statements)

    left = "backwards along its course: left out"
    mixed, ahead, none = codes(29.5, 0.6), codes(40.0, 0.5), codes(36.0, 0.5, forward_only=False)
    assert "takes the other: the samples are no range of one answer" in mixed
    assert left in mixed
    assert left in ahead
    assert left not in none
    assert "no range" not in ahead + none
    (one,) = fold(40.0, forward_only=True)
    said = "one more answer fits, in which a vehicle goes backwards along its course: left out"
    assert any(said in line for line in one.statements)
    assert said.capitalize() in str(one.summary())
    again = col.Impact.from_dict(json.loads(json.dumps(one.to_dict())))
    assert again.reconstruction.left_backwards == one.reconstruction.left_backwards == 1
    assert not any("left out (" in line for line in fold(28.5, forward_only=True)[0].statements)
    for page in (col.explain(again), col.report(again)):
        assert said.capitalize() in str(page)
    altered = one.to_dict()
    for count, said in ((None, "2 answers, and it says 1"), (3, "says that 3 answers were left")):
        altered["results"]["reconstruction"]["left_backwards"] = count
        with pytest.raises(col.InputError, match=said):
            col.report(col.Impact.from_dict(altered))
    hit = col.eccentric(A.replace(vx=12.0), B.replace(vx=-5.0), 0.1, **CONTACT, friction=0.5)
    given = {"course_a": 0.0, "course_b": 0.0, "restitution": 0.1, **CONTACT, "friction": 0.5}
    known = {"delta_v_b": hit.b.delta_v, "forward_only": True}
    with pytest.raises(col.NoSolutionError, match=r"\(100 %\).*leaves those out"):
        uncertainty.propagate(
            lambda speed_a: {"b": speeds(A, B, **given, **known, speed_a=speed_a)[0].speed_b},
            {"speed_a": uncertainty.Normal(12.0, 0.1)},
            samples=64,
            seed=1,
        )


def fold_scene():
    """Point masses that stay together, of which A's delta-V is least, 28.247 km/h, where B goes at
    47.3.

    dV_a^2 = f^2 ((w - w0)^2 + q^2) with f the share of B's mass, w0 and q the parts of A's velocity
    along and across the course of B; f and q are such that 28.3 and 28.5 km/h are met 8.4 and 18.4
    km/h on either side.
    """
    share = math.sqrt((28.5**2 - 28.3**2) / (18.4**2 - 8.4**2))
    across = math.sqrt(28.3**2 / share**2 - 8.4**2)
    speed, course = math.hypot(across, 47.3), math.atan2(across, 47.3)
    a = col.Vehicle(mass=1500.0, yaw_inertia=math.inf, x=0.0, y=0.0, heading=0.0)
    b = col.Vehicle(
        mass=1500.0 * share / (1 - share), yaw_inertia=math.inf, x=2.0, y=0.0, heading=course
    )
    contact = {"restitution": 0.0, "normal": -0.9, "point": (1.0, 0.0), "friction": math.inf}

    def solve(delta_v, **options):
        known = {"speed_a": speed / 3.6, "delta_v_a": delta_v / 3.6}
        return speeds(a, b, course_a=0.0, course_b=course, **contact, **known, **options)

    return solve


@pytest.mark.slow
def test_the_magnitude_is_a_fold():
    """38.9 or 55.7 km/h at 28.3, 28.9 or 65.7 at 28.5, none at 28.2; a range that reaches it is
    warned of.
    """
    fold = fold_scene()
    for delta_v, met in ((28.3, (38.9, 55.7)), (28.5, (28.9, 65.7))):
        assert sorted(3.6 * root.b.before.speed for root in fold(delta_v)) == pytest.approx(
            met, abs=0.05
        )
    with pytest.raises(col.NoSolutionError):
        fold(28.2)

    def model(delta_v):
        return {"speed_b": 3.6 * fold(delta_v)[0].b.before.speed}

    for low, high in ((28.2, 28.4), (28.3, 28.5)):
        with pytest.warns(col.CollisionsWarning) as caught:
            uncertainty.propagate(
                model,
                {"delta_v": uncertainty.Uniform(low, high)},
                method="quasi_random",
                samples=64,
                seed=1,
            )
        assert "fold" in {warning.message.code for warning in caught}, (low, high)
    # Far from the fold, and in a plain table of cases, nothing is said.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        uncertainty.propagate(
            model,
            {"delta_v": uncertainty.Uniform(29.2, 29.4)},
            method="quasi_random",
            samples=64,
            seed=1,
        )
        fold(np.array([28.3, 28.5]))


@pytest.mark.slow
def test_an_interval_that_reaches_a_fold_is_warned_of():
    """The ends of a range through the place where two answers meet are those of
    different answers.
    """
    with pytest.warns(col.CollisionsWarning) as caught:
        uncertainty.propagate(
            lambda delta_v: {"speed_b": fold_scene()(delta_v)[0].b.before.speed},
            {"delta_v": uncertainty.Interval(28.2, 28.4)},
            method="interval",
        )
    assert "fold" in {warning.message.code for warning in caught}


@pytest.mark.slow
def test_components_have_no_fold():
    """The same crash by its components: one answer, linear through the place where the magnitude is
    least.
    """
    a, b, contact = points()

    def model(forward):
        return {
            "speed_b": speeds(a, b, **contact, delta_v_forward_a=forward, delta_v_left_a=4.0)[
                0
            ].b.before.speed
        }

    with pytest.warns(col.IllConditionedWarning, match="taken to stick") as caught:
        spread = uncertainty.propagate(
            model,
            {"forward": uncertainty.Normal(-7.0, 0.3)},
            method="quasi_random",
            samples=256,
            seed=1,
        )
    assert {warning.message.code for warning in caught} == {"may_slide"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.IllConditionedWarning)
        slope = (model(-6.0)["speed_b"] - model(-8.0)["speed_b"]) / 2
    # The sampling error of a standard deviation of a linear model by a lattice of 256.
    assert spread["speed_b"].std == pytest.approx(abs(slope) * 0.3, rel=0.01)


GIVEN = {
    **COURSES,
    **CONTACT,
    "restitution": 0.1,
    "friction": math.inf,
    "regime": "sticking",
}
PAIR = {"delta_v_forward_a": -5.0, "delta_v_left_a": 1.0}
REFUSALS = [
    ("missing_heading", col.MissingInputError, {}, {"a": A.replace(heading=None)},
        "a has no heading"),
    ("bad_combination", col.InputError, {"delta_v_b": 3.0}, {}, "delta_v_b are not taken together"),
    ("bad_combination", col.InputError, {"energy_loss": 3.0, "speed_a": 9.0}, {},
        "beside components of delta-V give a speed, energy_loss or both EES"),
    ("bad_combination", col.InputError, {"ees_a": 3.0}, {}, "energy_loss or both EES"),
    ("too_few_knowns", col.InputError, {"delta_v_left_a": None, "energy_loss": 3e4}, {},
        "delta_v_forward_a alone leaves the speeds open"),
    ("too_many_knowns", col.InputError, {"speed_a": 9.0, "speed_b": 3.0}, {}, "forward problem"),
    ("too_few_knowns", col.InputError, {"delta_v_left_a": None}, {},
        "delta_v_forward_a alone leaves the speeds open"),
    ("bad_combination", col.InputError, {"restitution": lambda g: 0.1}, {},
        "take a number for the restitution"),
    ("bad_combination", col.InputError,
        {"friction": None, "critical_fraction": 0.5, "regime": None}, {},
        "no critical_fraction between"),
    ("infinite_mass", col.NoSolutionError, {}, {"a": A.replace(mass=math.inf)},
        "that of an infinite mass"),
    ("bad_units", col.InputError, {"delta_v_left_a": "3 kg"}, {}, "delta_v_left_a"),
    ("not_finite", col.InputError, {"delta_v_left_a": math.nan}, {}, "delta_v_left_a is NaN"),
    ("one_tangential", col.InputError, {"friction": None}, {}, "friction"),
    ("parallel_headings", col.NoSolutionError, {"course_b": 0.1}, {}, "give one of the speeds"),
    ("contradictory", col.NoSolutionError, {"delta_v_forward_a": 5.0}, {},
        "fit delta_v_forward_a = 5 m/s and delta_v_left_a = 1 m/s"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("code", "kind", "changed", "bodies", "said"),
    REFUSALS,
    ids=[f"{i}-{row[0]}" for i, row in enumerate(REFUSALS)],
)
def test_refusals(code, kind, changed, bodies, said):
    """The error of its family, with what to give instead."""
    with pytest.raises(kind, match=said) as caught:
        speeds(bodies.get("a", A), B, **{**GIVEN, **PAIR, **changed})
    assert caught.value.code == code


@pytest.mark.parametrize("size", [1e-150, 1e-75, 1e75, 1e150])
def test_extremes_of_scale(size):
    """All speeds, or all masses and inertias, scaled: the same crash, or a refusal."""
    (usual,) = speeds(A, B, **GIVEN, **PAIR)
    (fast,) = speeds(A, B, **GIVEN, **{name: size * value for name, value in PAIR.items()})
    assert fast.a.before.speed == pytest.approx(size * usual.a.before.speed, rel=1e-13)
    a, b = (
        body.replace(mass=size * body.mass, yaw_inertia=size * body.yaw_inertia) for body in (A, B)
    )
    (heavy,) = speeds(a, b, **GIVEN, **PAIR)
    assert heavy.a.before.speed == pytest.approx(usual.a.before.speed, rel=1e-13)
    assert heavy.reconstruction.condition == pytest.approx(
        usual.reconstruction.condition, rel=1e-12
    )


@pytest.mark.slow
def test_texts_records_reports_and_explanations():
    """Units are read, kept beside the answer, told, and read back."""
    known = {"delta_v_forward_a": "-18 km/h", "delta_v_left_a": "3.6 km/h"}
    (found,) = speeds(A, B, **GIVEN, **known)
    (same,) = speeds(A, B, **GIVEN, **PAIR)
    assert off(found, same) < 1e-12
    assert col.Impact.from_dict(found.to_dict()) == found
    assert pickle.loads(pickle.dumps(found)) == found
    assert found.reconstruction.known == ("delta_v_forward_a", "delta_v_left_a")
    page = col.report(found, form="markdown")
    assert "delta-V forward of A" in page
    assert "-18 km/h" in page
    assert col.reporting.replay(page) == found
    text = col.explain(found, form="text")
    assert (
        "Delta-V of A was known by its components in the axes of the vehicle (forward, left)"
        in text
    )
    # Two recorders that do not quite agree are met as well as they agree.
    more = {
        "delta_v_forward_b": f"{1.04 * found.b.delta_v_forward:.9f} m/s",
        "delta_v_left_b": f"{found.b.delta_v_left:.9f} m/s",
    }
    (both,) = speeds(A, B, **GIVEN, **known, **more)
    assert col.reporting.replay(col.report(both, form="markdown")) == both


@pytest.mark.slow
def test_a_study_warns_of_readings_where_hardly_any_sample_agrees():
    """Errors that are stated make many samples differ; readings that contradict, nearly all."""
    a, b = A, B
    hit = col.eccentric(
        body(15.0, 0.1, **fields(a)),
        body(12.0, 1.5, **fields(b)),
        0.1,
        **CONTACT,
        friction=math.inf,
    )
    readings = {
        f"delta_v_{part}_{label}": getattr(getattr(hit, label), f"delta_v_{part}")
        for label in "ab"
        for part in ("forward", "left")
    }

    def study(factor):
        values = {
            name: value * (factor if name.endswith("b") else 1.0)
            for name, value in readings.items()
        }
        errors = {label: 0.06 * getattr(hit, label).delta_v for label in "ab"}
        inputs = {name: Normal(value, errors[name[-1]]) for name, value in values.items()}

        def model(**known):
            (found,) = speeds(a, b, **GIVEN, **known)
            return {"a": found.a.before.speed, "b": found.b.before.speed}

        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", col.CollisionsWarning)
            found = propagate(model, inputs, samples=512, seed=1)
        told = [one for one in found.statements if "differ from their best" in one]
        return told, {one.message.code for one in caught}

    told, codes = study(1.0)
    assert "cases" in told[0]
    assert "recorders_differ" not in codes
    told, codes = study(1.45)
    assert "cases" in told[0]
    assert "recorders_differ" in codes


def of_a_crash(**turned):
    """The components of a crash that stuck, some with the sign of a recorder's own axes."""
    hit = col.eccentric(
        body(9.0, 0.1, **fields(A)),
        body(16.0, 1.5, **fields(B)),
        0.1,
        **CONTACT,
        friction=math.inf,
    )
    return {
        f"delta_v_{part}_{label}": getattr(getattr(hit, label), f"delta_v_{part}")
        * turned.get(f"{part}_{label}", 1.0)
        for label in "ab"
        for part in ("forward", "left")
    }


@pytest.mark.parametrize("labels", ["a", "b", "ab"])
def test_a_lateral_sign_that_must_be_wrong_is_named(labels):
    """With that sign turned there is the answer; which is said, and never given in silence."""
    known = of_a_crash(**{f"left_{label}": -1.0 for label in labels})
    wrong = " and ".join(f"delta_v_left_{label}" for label in labels)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", col.CollisionsWarning)
        try:
            speeds(A, B, **GIVEN, **known)
            said = " ".join(str(one.message) for one in caught)
        except col.NoSolutionError as error:
            said = str(error)
    assert f"With {wrong} of the other sign" in said
    assert "positive to the right" in said
    # Of signs that fit nothing is said.
    with pytest.warns(col.IllConditionedWarning, match="to stick") as caught:
        (found,) = speeds(A, B, **GIVEN, **of_a_crash())
    assert not any("of the other sign" in str(one.message) for one in caught)
    assert found.a.before.speed == pytest.approx(9.0)


@pytest.mark.parametrize(
    ("left", "said"), [(-1.0, True), ([-1.0, -0.9, 1.1], True), ([-1.0, 0.9, 1.1], False)]
)
def test_a_lateral_sign_is_named_where_most_cases_go_backwards(left, said):
    """Also in a batch, and in a study of such readings."""
    a = A.replace(y=0.0, heading=0.0)
    b = A.replace(x=2.0, y=0.3, heading=1.57)
    known = {"course_a": 0.0, "course_b": 1.57, "restitution": 0.1, "normal": 0.0}
    known |= {"point": (0.0, 0.0), "friction": 0.5, "delta_v_forward_a": -6.0}
    many = np.array(left) if isinstance(left, list) else left
    with pytest.warns(col.OutOfRangeWarning, match="backwards along its course") as caught:
        speeds(a, b, delta_v_left_a=many, **known)
    assert (
        "With delta_v_left_a of the other sign both go forwards" in str(caught[0].message)
    ) == said
    if not isinstance(left, list):
        with pytest.warns(col.CollisionsWarning, match="With delta_v_left_a of the other sign"):
            propagate(
                lambda left: {"b": speeds(a, b, delta_v_left_a=left, **known)[0].b.before.speed},
                {"left": Normal(left, 0.1)}, samples=64, seed=1,
            )  # fmt: skip


def test_no_sign_is_named_where_none_helps():
    known = of_a_crash(forward_b=-1.0)
    with pytest.raises(col.NoSolutionError) as refused:
        speeds(A, B, **GIVEN, **known)
    assert "of the other sign" not in str(refused.value)


def test_a_warning_of_a_batch_says_of_how_many_cases():
    """Each beside cases that do not warn."""
    known = {"course_a": 0.1, "delta_v_forward_a": -6.0, "delta_v_left_a": 1.0, "restitution": 0.1}
    known |= {"friction": math.inf, "regime": "sticking", **CONTACT}

    def warned(course_b, forward_b):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", col.CollisionsWarning)
            speeds(A, B, **known, course_b=course_b, delta_v_forward_b=forward_b)
        return {one.message.code: str(one.message) for one in caught}

    cases = ((0.12, 3.0), (1.5, 3.0), (1.5, 1.0), (1.5, 1.0))
    alone = [warned(*case) for case in cases]
    together = warned(*map(np.array, zip(*cases, strict=True)))
    for code in ("nearly_collinear", "recorders_differ"):
        count = sum(code in one for one in alone)
        assert 0 < count < 4
        assert together[code].startswith(f"{count} of 4 cases: ")


@pytest.mark.slow
@pytest.mark.parametrize("energy", ["energy_loss", "ees"])
@pytest.mark.parametrize("friction", ["as it was", math.inf])
def test_the_condition_beside_an_energy_is_that_of_the_whole_call(friction, energy):
    """Of contacts that slid: both speeds are moved by each known value, by finite differences, and
    by the EES of both together.
    """
    met = 0
    for a, b, e, contact, impact in slid_hits():
        known = {
            "delta_v_forward_a": impact.a.delta_v_forward,
            "delta_v_left_a": impact.a.delta_v_left,
            energy: impact.energy_loss if energy == "energy_loss" else 1.0,
        }
        of_both = dict(zip(("ees_a", "ees_b"), impact.ees(0.4), strict=True))
        courses = {"course_a": impact.a.before.course, "course_b": impact.b.before.course}
        given = contact | ({} if friction != math.inf else {"friction": math.inf})

        def found(known, a=a, b=b, e=e, rest=courses | given, wanted=impact, of_both=of_both):
            known = dict(known)
            share = known.pop("ees", 1.0)
            if energy == "ees":
                known |= {name: share * value for name, value in of_both.items()}
            answers = speeds(a, b, restitution=e, **rest, **known)
            return min(answers, key=lambda one: abs(one.a.before.speed - wanted.a.before.speed))

        moved = np.zeros(2)
        for name, value in known.items():
            up, down = (found({**known, name: value * (1.0 + step)}) for step in (1e-6, -1e-6))
            moved += [
                abs(getattr(up, side).before.speed - getattr(down, side).before.speed) / 2e-6
                for side in "ab"
            ]
        condition = found(known).reconstruction.condition
        assert condition == pytest.approx(max(moved) / impact.closing_speed, rel=1e-4)
        met += 1
    assert met > 15


@pytest.mark.slow
def test_beside_an_energy_a_contact_that_stuck_has_the_condition_of_one_that_slid():
    """Where no friction is known: a little more energy makes it slide, and moves both speeds."""
    a = body(26.74, 0.002, mass=2420, yaw_inertia=1723, x=-0.1, y=-4.05, heading=0.0)
    b = body(18.33, -0.624, mass=1100, yaw_inertia=3888, x=3.52, y=-3.83, heading=-0.62)
    contact = {"normal": 0.097, "point": (2.128, -4.493)}
    hit = col.eccentric(a, b, 0.155, friction=0.684, **contact)
    assert hit.regime == "sticking"

    def found(energy=1.0, forward=1.0, left=1.0):
        (one,) = speeds(
            a, b, course_a=0.002, course_b=-0.624, restitution=0.155, friction=math.inf,
            energy_loss=energy * hit.energy_loss,
            delta_v_forward_a=forward * hit.a.delta_v_forward,
            delta_v_left_a=left * hit.a.delta_v_left, **contact,
        )  # fmt: skip
        return one

    moved = 0.0
    for changed in ({"energy": 1.00001}, {"forward": 0.99999}, {"left": 0.99999}):
        more = found(**changed)
        assert more.regime == "sliding"
        moved += abs(more.b.before.speed - hit.b.before.speed) / 1e-5
    condition = found().reconstruction.condition
    assert found().regime == "sticking"
    assert condition == pytest.approx(moved / hit.closing_speed, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("with_tyres", [False, True])
@pytest.mark.parametrize(
    ("factor", "said"),
    [
        (0.39, "contradictory"), (0.41, "recorders_differ"), (0.79, "recorders_differ"),
        (0.81, None), (1.19, None), (1.21, "recorders_differ"), (1.59, "recorders_differ"),
        (1.61, "contradictory"),
    ],
)  # fmt: skip
def test_what_an_energy_may_differ_by_beside_a_contact_that_stuck(factor, said, with_tyres):
    """A fifth without a word of it, and three fifths at most, while the components alone tell the
    speeds. That it stuck at this ratio is stated, and warned of.
    """
    hit = col.eccentric(
        body(9.0, 0.1, **fields(A)), body(16.0, 1.5, **fields(B)), 0.1, **CONTACT, friction=math.inf
    )
    given = GIVEN | {"regime": "sticking", "energy_loss": factor * hit.energy_loss}
    if with_tyres:
        none = travel.Tyres(1e-9, 0, 1.2, 1.3)
        given |= {"duration": 0.1, "tyres_a": none, "tyres_b": none}
    known = {f"delta_v_{part}_a": getattr(hit.a, f"delta_v_{part}") for part in ("forward", "left")}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        if said == "contradictory":
            with pytest.raises(col.NoSolutionError) as refused:
                speeds(A, B, **given, **known)
            assert refused.value.code == said
            return
        (found,) = speeds(A, B, **given, **known)
    codes = {one.message.code for one in caught}
    assert codes == ({"may_slide", said} if said else {"may_slide"})
    assert found.a.before.speed == pytest.approx(9.0, abs=1e-6)
    assert found.b.before.speed == pytest.approx(16.0, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("rule", ["friction", "impulse_ratio"])
@pytest.mark.parametrize("beside", ["energy_loss", "ees"])
@pytest.mark.parametrize("more", [{}, {"slid": "bound"}])
def test_without_friction_an_energy_tells_no_slip(rule, beside, more):
    """Crashes that differ by a slip alone have the same delta-V and the same energy."""
    contact = {"normal": 0.1, "point": (0.0, 0.1), rule: 0.0}
    a = A.replace(x=-2.2, y=0.0, heading=0.0, vx=15.0)
    b = B.replace(x=0.8, y=-0.3, heading=math.pi / 2, vy=2.0)
    one = col.eccentric(a, b, 0.1, **contact)
    faster = a.replace(vx=15.0 + 9.0 * math.tan(0.1))
    other = col.eccentric(faster, b.replace(vy=11.0), 0.1, **contact)
    known = recorded_of(one.a)
    known |= dict(zip(("ees_a", "ees_b"), one.ees(0.5), strict=True)) if beside == "ees" else {}
    known |= {"energy_loss": one.energy_loss} if beside == "energy_loss" else {}
    assert other.a.delta_v_forward == pytest.approx(one.a.delta_v_forward, rel=1e-12)
    assert other.a.delta_v_left == pytest.approx(one.a.delta_v_left, rel=1e-12)
    assert other.energy_loss == pytest.approx(one.energy_loss, rel=1e-12)
    if rule == "impulse_ratio" and more:
        return
    given = {"course_a": 0.0, "course_b": math.pi / 2, "restitution": 0.1, **contact, **more}
    with pytest.raises(col.NoSolutionError, match=r"^without friction") as no:
        speeds(a, b, **given, **known)
    assert no.value.code == "undetermined"
    if rule == "friction":
        with pytest.warns(col.CollisionsWarning):
            found = speeds(a, b, **given | {"friction": np.array([0.0, 0.0, 0.3])}, **known)
        assert [col.Status(one).label for one in found[0].status[:2]] == ["undetermined"] * 2


def test_the_condition_where_a_contact_just_stuck_is_that_of_one_that_slid():
    """B goes nearly across the normal, so that readings 3 percent too high end where the contact
    just sticks; whatever B's speed, one that slid has them within 4 percent.
    """
    contact = {"normal": -0.4513487, "point": (0.1045588, 0.354146), "friction": 0.5}
    a = A.replace(mass=1376.3224, yaw_inertia=2118.8744, x=-2.5046583, y=0.2884091, heading=0.0)
    b = B.replace(
        mass=1654.9681, yaw_inertia=1986.1717, x=1.9163995, y=0.3554871, heading=-2.0066279
    )
    read = {"delta_v_forward_b": -3.179111, "delta_v_left_b": 6.612796}
    (found,) = speeds(
        a, b, course_a=0.0, course_b=-2.0066279, restitution=0.0204363, **contact, **read,
        speed_a=15.567944,
    )  # fmt: skip
    for speed in (0.06, 8.62, 16.0):
        struck = b.replace(vx=speed * math.cos(b.heading), vy=speed * math.sin(b.heading))
        side = col.eccentric(a.replace(vx=15.567944), struck, 0.0204363, **contact).b
        off = [getattr(side, name[:-2]) - value for name, value in read.items()]
        assert math.hypot(*off) < 0.04 * side.delta_v
    # 8 m/s for 3 percent of a closing speed of 14 m/s are a factor of 20 at the least.
    assert found.reconstruction.condition > 20.0
    assert "ill_conditioned" in [one.code for one in col.diagnose(found)]


@pytest.mark.slow
def recorded_of(side):
    """Both components of delta-V of A, as its recorder has them."""
    return {"delta_v_forward_a": side.delta_v_forward, "delta_v_left_a": side.delta_v_left}


def test_with_hardly_any_friction_an_energy_leaves_both():
    """A contact that stuck and one that slid lose the same to four digits."""
    contact = {"normal": 0.1, "point": (0.0, 0.1), "friction": 1e-6}
    a = A.replace(x=-2.2, y=0.0, heading=0.0, vx=15.0)
    b = B.replace(x=0.8, y=-0.3, heading=math.pi / 2, vy=2.0)
    true = col.eccentric(a, b, 0.1, **contact)
    given = {"course_a": 0.0, "course_b": math.pi / 2, "restitution": 0.1, **contact}
    known = recorded_of(true.a)
    with pytest.raises(col.AmbiguousSolutionError) as either:
        speeds(a, b, **given, **known, energy_loss=true.energy_loss)
    found = [(one.a.before.speed, one.b.before.speed) for one in either.value.solutions]
    assert any(pair == pytest.approx((15.0, 2.0), abs=1e-3) for pair in found)
    with pytest.raises(col.AmbiguousSolutionError, match="If it stuck, the speed of A is") as both:
        speeds(a, b, **given, **known, energy_loss=true.energy_loss, slid="bound")
    assert len(both.value.solutions) == len(either.value.solutions)
    # With a known speed it is the other speed that stays open.
    across = {**contact, "friction": 0.0, "normal": 0.0}
    hit = col.eccentric(a, b, 0.1, **across).a
    with pytest.raises(col.NoSolutionError, match="give the speed of the other vehicle"):
        speeds(a, b, **given | across, speed_a=15.0, **recorded_of(hit))
    # With a hundredth the energy of the slip shows, and decides.
    contact["friction"] = 0.01
    true = col.eccentric(a, b, 0.1, **contact)
    known = recorded_of(true.a)
    (only,) = speeds(a, b, **given | contact, **known, energy_loss=true.energy_loss)
    assert (only.a.before.speed, only.b.before.speed) == pytest.approx((15.0, 2.0), rel=1e-9)


@cache
def slid_hits(count=25):
    """Random cars that met at an angle and slid far from sticking, with what they met with."""
    rng, hits_ = np.random.default_rng(7), []
    while len(hits_) < count:
        a, b = (
            body(
                rng.uniform(5, 25), course, mass=rng.uniform(1000, 2300),
                yaw_inertia=rng.uniform(1500, 3500), x=x, y=rng.uniform(-0.5, 0.5), heading=course,
            )
            for course, x in ((rng.uniform(-0.3, 0.3), -1.8), (rng.uniform(1.0, 2.2), 1.5))
        )  # fmt: skip
        contact = {
            "normal": rng.uniform(-0.5, 0.5),
            "point": (rng.uniform(-0.2, 0.2), 0.0),
            "friction": rng.uniform(0.1, 0.4),
        }
        e = rng.uniform(0.05, 0.3)
        try:
            impact = col.eccentric(a, b, e, **contact)
        except (col.NoImpactError, col.NoSolutionError):
            continue
        if abs(impact.slip_after) > 0.2 * impact.closing_speed:
            hits_.append((a, b, e, contact, impact))
    return hits_


@pytest.mark.slow
@pytest.mark.parametrize("speed", [13.7, 15.0, 16.0, 18.0])
def test_a_small_ratio_beside_a_known_speed_does_not_say_that_it_stuck(speed):
    """A contact that slid at 0.12: the one that stuck fits within the accuracy of recorders, with
    another speed of B, and what slid reaches further.
    """
    a = col.Vehicle(mass=2000, yaw_inertia=3130, x=-2.0, y=0.6, heading=0.265)
    b = col.Vehicle(mass=1570, yaw_inertia=2675, x=1.2, y=0.29, heading=1.79)
    where = {"normal": -0.046, "point": (-0.144, -0.032)}
    cars = (
        one.replace(vx=fast * math.cos(course), vy=fast * math.sin(course))
        for one, fast, course in ((a, 21.5, 0.265), (b, speed, 1.79))
    )
    truth = col.eccentric(*cars, 0.157, friction=0.12, **where)
    known = {
        "delta_v_forward_b": truth.b.delta_v_forward,
        "delta_v_left_b": truth.b.delta_v_left,
        "speed_a": 21.5,
    }
    rest = {"course_a": 0.265, "course_b": 1.79, "restitution": 0.157, "friction": math.inf}
    with pytest.raises(col.AmbiguousSolutionError, match="stuck or slid") as open_:
        speeds(a, b, **rest, **known, **where)
    stuck, slid = open_.value.solutions
    assert stuck.b.before.speed < speed - 1.0
    assert slid.b.before.speed == pytest.approx(speed, rel=1e-9)
    (bound,) = speeds(a, b, **rest, **known, **where, slid="bound")
    assert bound.b.before.speed < speed
    assert bound.reconstruction.one_sided == {"speed_a": 0, "speed_b": 1}
