"""What observations show: restitution and friction from motions, in-line closing speed, energy from
crush.

Forward impacts are observed and give back what they were made with; printed answers to their
digits; the rest against 50 digits.
"""

import json
import math
import pickle
import random
import re
import warnings
from dataclasses import replace
from pathlib import Path

import mpmath
import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct
from reference import EPS, evaluate
from scenes import FAMILIES, cases, solved
from strategies import other_registry

INF = math.inf
MPH = 0.44704
PUBLISHED = Path(__file__).parents[2] / "validation" / "data" / "worked_examples.json"
CASES = {case["id"]: case for case in json.loads(PUBLISHED.read_text("utf-8"))}


def number(case, kind, name):
    return CASES[case][kind][name]["value"]


def refusal(call):
    with pytest.raises(col.CollisionsError) as caught:
        call()
    return caught.value


def body(**changes):
    return col.Vehicle(**{"mass": 1000.0, **changes})


# Restitution


def test_railroad_cars():
    """L01: 0.5 m/s into one at rest, leaving with -0.025 and 0.3: 0.65 as printed, in decimals that
    floats only round.
    """
    a, b = (
        body(mass=number("L01", "inputs", f"m_{x}"), vx=number("L01", "inputs", f"v_{x}"))
        for x in "AB"
    )
    end_a = a.replace(vx=number("L01", "published_outputs", "v_A_after"))
    end_b = b.replace(vx=number("L01", "inputs", "v_B_after"))
    found = reconstruct.restitution(a, b, end_a, end_b, normal=0.0)
    assert type(found) is float
    assert found == pytest.approx(number("L01", "published_outputs", "e"), rel=4 * EPS)


@pytest.mark.parametrize(("case", "within"), [("L05", 0.05 * 2 / 14.5), ("L07", 0.005 * 2 / 40)])
def test_published_elastic_impacts(case, within):
    """Printed velocities in units of 0.1 and 0.01 m/s: each is off by up to half a unit, so e by
    both over the closing speed.
    """
    a, b = (
        body(mass=number(case, "inputs", f"m{i}"), vx=number(case, "inputs", f"u{i}")) for i in "12"
    )
    ends = [
        one.replace(vx=number(case, "published_outputs", f"v{i}"))
        for i, one in (("1", a), ("2", b))
    ]
    assert reconstruct.restitution(a, b, *ends, normal=0.0) == pytest.approx(1.0, abs=within)


def test_the_measured_rear_end():
    """L11 (GBB): delta-V of 3.1 and 3.5 mph at 5.5 mph are e = 0.2 to the printed digit."""
    a, b = body(mass=950.0, vx=5.5 * MPH), body(mass=770.0)
    ends = (
        a.replace(vx=(5.5 - number("L11", "published_outputs", "dV1")) * MPH),
        b.replace(vx=number("L11", "published_outputs", "dV2") * MPH),
    )
    assert reconstruct.restitution(a, b, *ends, normal=0.0) == pytest.approx(
        number("L11", "recomputed_outputs", "e_from_data"), abs=1e-14
    )


def test_the_speeding_car_of_a_lost_sign():
    """L03 as printed, 80 m/s before, 55 behind a van at 15 after: e = -0.5, an impact that passed
    through, and says so.
    """
    a, b = body(mass=1500.0, vx=number("L03", "published_outputs", "v1_before")), body(mass=2500.0)
    with pytest.warns(col.OutOfRangeWarning, match=r"-0\.5, below 0: .*still approach") as caught:
        found = reconstruct.restitution(
            a,
            b,
            a.replace(vx=number("L03", "published_outputs", "v1_after")),
            b.replace(vx=15.0),
            normal=0.0,
        )
    assert found == -0.5
    assert caught[0].message.code == "observed_restitution"
    assert caught[0].message.fields["value"] == -0.5
    assert caught[0].filename == __file__


def test_more_speed_than_there_was():
    """Above 1 the value comes with a warning too."""
    a, b = body(vx=10.0), body()
    with pytest.warns(col.OutOfRangeWarning, match=r"1\.2, above 1: .*contradict"):
        assert (
            reconstruct.restitution(a, b, a.replace(vx=-2.0), b.replace(vx=10.0), normal=0.0) == 1.2
        )


@pytest.mark.slow
@pytest.mark.parametrize("e", [0.0, 1.0])
def test_rounding_is_no_warning(e):
    """The velocities after are rounded; what that makes of 0 or 1 is not outside. Warnings are
    errors here.
    """
    generator = random.Random(5)
    for _ in range(200):
        va = generator.uniform(-40, 40)
        a, b = (
            body(mass=generator.uniform(700, 2500), vx=va),
            body(mass=generator.uniform(700, 2500), vx=va - generator.uniform(1e-3, 40)),
        )
        impact = col.linear_central(a, b, e)
        found = reconstruct.restitution(a, b, impact.a.after, impact.b.after, normal=0.0)
        # One rounding of each velocity after, half of one for each difference.
        assert found == pytest.approx(
            e,
            abs=4 * EPS * (abs(a.vx) + abs(b.vx) + 2 * impact.closing_speed) / impact.closing_speed,
        )
    wide = col.linear_central(
        body(vx=np.full(3, 7.1, np.float32)),
        body(mass=1300.0, vx=np.float32(0.3) * np.ones(3, np.float32)),
        e,
    )
    found = reconstruct.restitution(
        wide.a.before, wide.b.before, wide.a.after, wide.b.after, normal=0.0
    )
    assert found.dtype == np.float32
    assert np.all(abs(found - e) < 8 * 2.0**-23)


@pytest.mark.parametrize("family", FAMILIES)
def test_restitution_of_planar_impacts(family):
    """-n.U'/n.U in 50 digits from the floats that were observed: 4 eps (S_U' + e S_U) / g, the
    promise of section 5.
    """
    tried = 0
    for scene, _ in cases(family, "brach", "friction", 25):
        impact = solved("eccentric", scene)
        ends = [
            replace(one, vx=side.after.vx, vy=side.after.vy, spin=side.after.yaw_rate)
            for one, side in ((scene.a, impact.a), (scene.b, impact.b))
        ]
        before, after = evaluate(scene), motion(scene, *ends)
        exact = after[0] / before.closing
        promise = 4 * EPS * float((after[1] + abs(exact) * before.s_u) / before.closing)
        with warnings.catch_warnings():
            # Where eps S_U is a part of g, what was rounded on the way in may lie outside 0 to 1;
            # and where g is a millionth of S_U, no measurement has its digits.
            warnings.simplefilter("ignore", col.OutOfRangeWarning)
            warnings.simplefilter("ignore", col.IllConditionedWarning)
            found = reconstruct.restitution(
                impact.a.before,
                impact.b.before,
                impact.a.after,
                impact.b.after,
                normal=scene.normal,
                point=scene.point,
            )
        assert abs(float(found - exact)) <= promise, scene
        tried += 1
    assert tried >= 20


def motion(scene, a, b):
    """Separation speed at the contact in 50 digits, and its scale S_U; velocities and levers
    subtracted as floats.
    """
    with mpmath.workdps(50):
        normal = scene.normal
        if isinstance(normal, tuple):
            size = mpmath.hypot(*map(mpmath.mpf, normal))
            normal = tuple(mpmath.mpf(part) / size for part in normal)
        else:
            normal = mpmath.cos_sin(mpmath.mpf(normal))
        own = [(0.0, 0.0) if one.pivot else (one.vx, one.vy) for one in (a, b)]
        u = [mpmath.mpf(own[1][i] - own[0][i]) for i in (0, 1)]
        scale = mpmath.hypot(*u)
        for sign, one in ((-1, a), (1, b)):
            center = one.pivot or (one.x, one.y)
            rx, ry = (mpmath.mpf(scene.point[i] - center[i]) for i in (0, 1))
            u = [u[0] - sign * mpmath.mpf(one.spin) * ry, u[1] + sign * mpmath.mpf(one.spin) * rx]
            scale += abs(one.spin) * mpmath.hypot(rx, ry)
        return normal[0] * u[0] + normal[1] * u[1], scale


def test_restitution_needs_what_it_needs():
    """A body that turns needs a contact and a position; nothing is compared with an approach that
    was none.
    """
    a, b, turning = body(vx=10.0), body(), body(vx=2.0, yaw_rate=1.0)
    solve = reconstruct.restitution
    error = refusal(lambda: solve(a, b, turning, b, normal=0.0))
    assert (type(error), error.code) == (col.MissingInputError, "missing_point")
    assert "a_after turns" in str(error)
    assert "point=(x, y)" in str(error)
    error = refusal(lambda: solve(a, b, turning, b, normal=0.0, point=(1.0, 0.0)))
    assert isinstance(error, col.MissingInputError)
    for va, code in ((-1.0, "separating"), (0.0, "no_closing")):
        error = refusal(lambda va=va: solve(a.replace(vx=va), b, a, b, normal=0.0))
        assert (type(error), error.code, error.closing_speed) == (col.NoImpactError, code, va)
        assert "from A into B" in str(error)
        assert str(pickle.loads(pickle.dumps(error))) == str(error)
    assert refusal(lambda: solve(a, b, {"vx": 1.0}, b, normal=0.0)).code == "not_a_vehicle"
    assert refusal(lambda: solve(a, b, a, b, normal=(0.0, 0.0))).code == "zero_normal"


def test_many_observations():
    """Each as alone; a refused one is NaN and counted, the worst outside 0 to 1 is named."""
    va = np.array([10.0, -10.0, 10.0, np.nan, 10.0])
    after = np.array([1.0, 1.0, 8.0, 1.0, 2.0])
    with pytest.warns(col.CollisionsWarning) as caught:
        found = reconstruct.restitution(
            body(vx=va), body(), body(vx=after), body(vx=4.0), normal=0.0
        )
    assert found == pytest.approx([0.3, math.nan, -0.4, math.nan, 0.2], rel=1e-14, nan_ok=True)
    texts = [str(warning.message) for warning in caught]
    assert any("2 of 5 cases" in text for text in texts)
    assert any("-0.4" in text for text in texts)
    assert not found.flags.writeable
    with_angles = reconstruct.restitution(
        body(vx=10.0), body(), body(vx=1.0), body(vx=4.0), normal=np.array([0.0, 0.3])
    )
    assert with_angles == pytest.approx([0.3, 0.3], rel=1e-14)
    assert reconstruct.restitution(
        body(vx="36 km/h"), body(), body(vx=1.0), body(vx=4.0), normal="0 deg"
    ) == pytest.approx(0.3, rel=1e-14)


def test_both_kinds_outside_the_range_are_counted():
    """How many below 0 and above 1, each with its worst, and what each means; the values are
    returned.
    """
    with pytest.warns(col.OutOfRangeWarning) as caught:
        found = reconstruct.restitution(
            body(vx=10.0),
            body(),
            body(vx=np.array([2.7, -16.0, 3.0, 5.0, 1.0])),
            body(vx=4.0),
            normal=0.0,
        )
    assert found == pytest.approx([0.13, 2.0, 0.1, -0.1, 0.3], rel=1e-13)
    assert [w.message.fields["counts"] for w in caught] == [{"below": 1, "above": 1}]
    with pytest.warns(col.OutOfRangeWarning) as caught:
        reconstruct.restitution(
            body(vx=10.0),
            body(),
            body(vx=np.array([6.7, -16.0, 3.0, 5.0, 1.0])),
            body(vx=4.0),
            normal=0.0,
        )
    (message,) = (w.message for w in caught)
    assert message.fields == {"value": pytest.approx(-0.27), "counts": {"below": 2, "above": 1}}
    for part in (
        "3 of 5 cases",
        "2 below 0, down to -0.27: ",
        "incomplete",
        "1 above 1, up to 2: ",
        "contradict",
    ):
        assert part in str(message)


# The same bodies before and after


def observed(**changes):
    """The motions of an impact that turned both bodies, with something of them changed after it."""
    a = body(mass=1500.0, yaw_inertia=2500.0, vx=15.0, x=-2.0, y=0.3)
    b = body(mass=1200.0, yaw_inertia=1800.0, x=0.5, y=-0.4)
    impact = col.eccentric(a, b, 0.1, normal=0.0, point=(-0.5, 0.2), friction=0.3)
    ends = {"a": impact.a.after, "b": impact.b.after}
    for name, value in changes.items():
        ends[name[0]] = ends[name[0]].replace(**{name[2:]: value})
    return impact, (a, b, ends["a"], ends["b"]), {"normal": 0.0, "point": (-0.5, 0.2)}


BOTH = [reconstruct.restitution, reconstruct.friction]


@pytest.mark.parametrize("solve", BOTH)
@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"a_x": 14.0, "a_y": 5.3},
            ["a_before.x = -2 m and a_after.x = 14 m, 16 m apart", "a_after.y = 5.3 m, 5 m apart"],
        ),
        (
            {"b_y": 7.6},
            ["b_before.y = -0.4 m and b_after.y = 7.6 m, 8 m apart", "b_before.replace("],
        ),
        (
            {"a_mass": 900.0},
            [
                "a_before.mass = 1500 kg and a_after.mass = 900 kg, 600 kg apart",
                "a_before.replace(",
            ],
        ),
        ({"b_mass": INF}, ["b_after.mass = inf kg"]),
        (
            {"b_yaw_inertia": 1900.0},
            [
                (
                    "b_before.yaw_inertia = 1800 kg·m² and b_after.yaw_inertia = 1900 kg·m², 100 "
                    "kg·m² apart"
                )
            ],
        ),
        ({"a_mass": 1500.0 * (1 + 2e-9)}, ["a_before.mass = 1500 kg", "3e-06 kg apart"]),
        ({"a_x": -2.0 - 5e-9}, ["5e-09 m apart"]),
    ],
)
def test_bodies_that_became_others_are_refused(solve, changes, said):
    """Rest positions with the yaw rate at separation, or another mass, answer with a number of no
    impact at all.
    """
    _, motions, place = observed(**changes)
    error = refusal(lambda: solve(*motions, **place))
    assert (type(error), error.code) == (col.InputError, "different_bodies")
    for part in (
        *said,
        "An impulse moves nothing",
        "position at the moment of impact, not at rest",
    ):
        assert part in str(error)
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


@pytest.mark.parametrize("solve", BOTH)
def test_the_same_bodies_with_what_rounding_and_silence_leave(solve):
    """1e-9 of the mass, or of the size of the scene, is the same; what was not given is not
    compared.
    """
    impact, motions, place = observed()
    true = {reconstruct.restitution: 0.1, reconstruct.friction: abs(impact.impulse_ratio)}[solve]
    assert solve(*motions, **place) == pytest.approx(true, rel=1e-12)
    # 5e-10 of the mass or of 2 m, and a yaw inertia that is unknown after: at most as much in the
    # answer, by the lever.
    for changes in (
        {"a_mass": 1500.0 * (1 + 5e-10)},
        {"a_x": -2.0 + 1e-9},
        {"b_yaw_inertia": None},
    ):
        assert solve(*observed(**changes)[1], **place) == pytest.approx(true, rel=1e-8)
    a, b = body(vx=10.0, vy=2.0, x=0.0, y=1.0), body(x=3.0, y=1.0)
    end = col.oblique_central(a, b, 0.1, normal=0.0, friction=0.1)
    placed = end.a.after.replace(x=1e-17), end.b.after.replace(x=None, y=None)
    assert solve(a, b, *placed, normal=0.0) == pytest.approx(0.1, rel=1e-13)


@pytest.mark.parametrize("solve", BOTH)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_other_bodies_in_a_batch(solve, dtype):
    """The case of another body is NaN and counted as contradictory, its neighbours as without it;
    single precision stays.
    """
    mass = np.array([1500.0, 900.0, 1500.0, 1500.0], dtype=dtype)
    x = np.array([-2.0, -2.0, 14.0, -2.0], dtype=dtype)
    _, (a, b, after_a, after_b), place = observed()
    many = [one.replace(vx=np.full(4, one.vx, dtype=dtype)) for one in (a, b, after_a, after_b)]
    many[2] = many[2].replace(mass=mass, x=x)
    with pytest.warns(
        col.CollisionsWarning, match=r"2 of 4 cases were refused and are NaN \(2 contradictory\)"
    ):
        found = solve(*many, **place)
    assert found.dtype == dtype
    assert np.isnan(found).tolist() == [False, True, True, False]
    many[2] = many[2].replace(mass=1500.0, x=-2.0)
    assert found[[0, 3]].tolist() == solve(*many, **place)[[0, 3]].tolist()
    # A single number that differs is refused for all of them, as at every reader.
    error = refusal(lambda: solve(many[0].replace(mass=900.0), *many[1:], **place))
    assert error.code == "different_bodies"


@pytest.mark.parametrize("solve", BOTH)
def test_refusals_name_the_vehicle_that_is_meant(solve):
    """By the name of the argument, all at once; also the one without a position, and the state of a
    refused case.
    """
    a, b = body(vx=10.0), body()
    error = refusal(lambda: solve(a, b, None, b, normal=0.0))
    assert (error.code, error.fields["argument"]) == ("not_a_vehicle", "a_after")
    assert "a_after must be a Vehicle, got NoneType" in str(error)
    text = str(refusal(lambda: solve(3, b, a, "b", normal=(0.0, 0.0))))
    for part in (
        "\n- a_before must be a Vehicle, got int",
        "\n- b_after must be a Vehicle, got str",
        "\n- normal",
    ):
        assert part in text
    error = refusal(lambda: solve(a, b, a, body(yaw_rate=1.0), normal=0.0, point=(0.0, 0.0)))
    assert (type(error), error.fields["vehicle"]) == (col.MissingInputError, "b_after")
    assert str(error).startswith("b_after has no x")
    refused = col.linear_central(b, a, 0.1, on_failure="nan")
    error = refusal(lambda: solve(a, b, refused.b.after, refused.a.after, normal=0.0))
    assert (type(error), error.code) == (col.InputError, "not_finite")
    assert "NaN" in str(error)
    with pytest.warns(col.CollisionsWarning, match="1 of 2 cases"):
        ends = col.linear_central(body(vx=np.array([10.0, -10.0])), b, 0.1)
    with pytest.warns(col.CollisionsWarning, match=r"1 of 2 cases .*1 not_finite"):
        found = solve(a, b, ends.a.after, ends.b.after, normal=0.0)
    expected = {reconstruct.restitution: 0.1, reconstruct.friction: 0.0}[solve]
    assert found == pytest.approx([expected, math.nan], rel=1e-13, nan_ok=True)


# Friction


def slid(model, rng, friction):
    a = body(
        mass=rng.uniform(800, 2500),
        vx=rng.uniform(5, 20),
        vy=rng.uniform(-20, 20),
        yaw_inertia=2000.0,
        x=-1.5,
        y=rng.uniform(-0.5, 0.5),
    )
    b = body(
        mass=rng.choice([INF, rng.uniform(800, 2500)]),
        yaw_inertia=1800.0,
        x=2.0,
        y=rng.uniform(-0.5, 0.5),
    )
    if model == "oblique_central":
        return col.oblique_central(a, b, 0.2, normal=0.1, friction=friction)
    return col.eccentric(a, b, 0.2, normal=0.1, point=(0.0, 0.0), friction=friction)


@pytest.mark.slow
@pytest.mark.parametrize("model", ["oblique_central", "eccentric"])
def test_the_friction_of_sliding_impacts(model):
    """The coefficient itself, whichever way it slid; if the contact came to stick, the ratio that
    was enough.

    The velocities after are rounded, up to 20 m/s against a change of a few: 32 eps times their
    ratio.
    """
    rng = random.Random(3)
    regimes = set()
    for _ in range(60):
        mu = rng.uniform(0.05, 0.9)
        impact = slid(model, rng, mu)
        found = reconstruct.friction(
            impact.a.before,
            impact.b.before,
            impact.a.after,
            impact.b.after,
            normal=impact.normal,
            point=(0.0, 0.0),
        )
        worst = 40.0 / min(side.delta_v for side in (impact.a, impact.b) if side.delta_v)
        assert found == pytest.approx(abs(impact.impulse_ratio), abs=32 * EPS * worst)
        if impact.regime == "sliding":
            assert found == pytest.approx(mu, abs=32 * EPS * worst)
        else:
            assert found <= mu * (1 + 1e-12)
        regimes.add((impact.regime, impact.tangential_impulse > 0))
    assert {("sliding", True), ("sliding", False)} <= regimes


def test_momentum_that_does_not_balance():
    """A tenth may be measurement; more is warned of with its size. The answer is the mean that
    errors of velocity weigh least.
    """
    a, b = body(vx=10.0), body(mass=2000.0)
    after_a, after_b = a.replace(vx=4.0, vy=-1.0), b.replace(vx=2.0, vy=0.6)
    with pytest.warns(col.IllConditionedWarning, match="differ by 3[0-9]%") as caught:
        found = reconstruct.friction(a, b, after_a, after_b, normal=0.0)
    # (-6, -1) from A is 6000 and 1000 N s, (2, 0.6) from B 4000 and 1200; weights 1/1000^2 and
    # 1/2000^2.
    assert found == pytest.approx(
        (1000 / 1e6 + 1200 / 4e6) / (6000 / 1e6 + 4000 / 4e6), rel=8 * EPS
    )
    assert caught[0].message.code == "momentum_mismatch"
    assert caught[0].message.fields["mismatch"] == pytest.approx(
        math.hypot(2000, 200) / math.hypot(6000, 1000), rel=8 * EPS
    )
    assert caught[0].filename == __file__
    # 5 percent passes in silence.
    assert reconstruct.friction(a, b, a.replace(vx=4.0), b.replace(vx=2.85), normal=0.0) == 0.0


def test_friction_is_refused():
    """A pivot adds an impulse of its own; bodies must approach, and must have been pushed apart."""
    a, b = body(vx=10.0), body()
    pinned = col.Vehicle(mass=1000.0, yaw_inertia=1300.0, x=2.0, y=0.0, pivot=(0.0, 0.0))
    solve = reconstruct.friction
    for bodies, label in (
        ((pinned, b, a, b), "a_before"),
        ((a, pinned, a, b), "b_before"),
        ((a, b, pinned, b), "a_after"),
        ((a, b, a, pinned), "b_after"),
    ):
        error = refusal(lambda bodies=bodies: solve(*bodies, normal=0.0))
        assert (type(error), error.code) == (col.InputError, "pinned")
        assert f"{label} has a pivot" in str(error)
    error = refusal(lambda: solve(a, b, a.replace(vx=12.0), b, normal=0.0))
    assert (type(error), error.code) == (col.NoImpactError, "not_pushed")
    assert "from A into B" in str(error)
    assert refusal(lambda: solve(a, b, a, b, normal=0.0)).code == "not_pushed"
    assert refusal(lambda: solve(b, a, b, a, normal=0.0)).code == "separating"
    with pytest.warns(col.CollisionsWarning, match="2 of 3 cases"):
        many = solve(
            body(vx=np.array([10.0, -10.0, 10.0])),
            b,
            body(vx=np.array([5.0, 5.0, 20.0]), vy=-1.0),
            body(vx=5.0, vy=1.0),
            normal=0.0,
        )
    assert many == pytest.approx([0.2, math.nan, math.nan], nan_ok=True)


# In-line closing speed


def cipriani(v):
    """Low-speed fit of SAE 2002-01-0540 as quoted in restitution.csv, closing speed in m/s."""
    x = math.log10(v)
    return 0.47477 - 0.26139 * x + 0.03382 * x**2 - 0.11639 * x**3


def test_the_fit_is_the_one_that_was_quoted():
    """Its values at 2 and 15 mph as tabulated, to four digits."""
    for mph, e in ((2, 0.4876), (3, 0.4418), (5, 0.3826), (7, 0.3394), (10, 0.2871), (15, 0.2161)):
        assert cipriani(mph * MPH) == pytest.approx(e, abs=5e-5)


def test_the_low_speed_delta_v():
    """A 5 km/h delta-V between equal cars: 9.1 km/h with a fixed 0.1 (10/1.1), 7.2 with the
    low-speed fit.
    """
    fixed = reconstruct.inline_closing_speed(1500, 1500, 0.1, delta_v_a="5 km/h")
    assert fixed * 3.6 == pytest.approx(10 / 1.1, rel=4 * EPS)
    assert round(fixed * 3.6, 1) == 9.1
    jointly = reconstruct.inline_closing_speed(1500, 1500, cipriani, delta_v_a="5 km/h")
    assert round(jointly * 3.6, 1) == 7.2
    with mpmath.workdps(50):
        # g (1 + e(g)) / 2 = delta-V, by another method than bisection.

        def mismatch(g):
            x = mpmath.log10(g)
            e = (
                mpmath.mpf(0.47477)
                - mpmath.mpf(0.26139) * x
                + mpmath.mpf(0.03382) * x**2
                - mpmath.mpf(0.11639) * x**3
            )
            return g * (1 + e) / 2 - mpmath.mpf(5) / mpmath.mpf(3.6)

        exact = mpmath.findroot(mismatch, 2)
    assert jointly == pytest.approx(float(exact), rel=1e-13)
    assert col.linear_central(
        body(vx=jointly), body(), cipriani(jointly)
    ).a.delta_v == pytest.approx(5 / 3.6, rel=1e-13)


@pytest.mark.slow
def test_closing_speed_of_forward_impacts():
    """Every kind of knowledge of random in-line impacts gives their closing speed again, barriers
    too.
    """
    rng = random.Random(9)
    for i in range(200):
        mass_a, mass_b = (
            rng.uniform(700, 2500),
            rng.choice([rng.uniform(700, 2500), 10 ** rng.uniform(-9, 15), INF]),
        )
        if i % 2:
            mass_a, mass_b = mass_b, mass_a
        g, e = rng.uniform(0.1, 40), rng.uniform(0.0, 0.99)
        impact = col.linear_central(body(mass=mass_a, vx=g), body(mass=mass_b), e)
        solve = reconstruct.inline_closing_speed
        # Promises of section 5: 4 eps of delta-V, 6 of the loss (halved by the root), and as much
        # again on the way back; the loss gives the closing speed no better than e gives 1 - e.
        for name, side, mass in (("delta_v_a", impact.a, mass_a), ("delta_v_b", impact.b, mass_b)):
            if math.isfinite(mass):
                assert solve(mass_a, mass_b, e, **{name: side.delta_v}) == pytest.approx(
                    g, rel=8 * EPS
                )
        assert solve(mass_a, mass_b, e, energy_loss=impact.energy_loss) == pytest.approx(
            g, rel=8 * EPS / (1 - e)
        )
        share = 0.0 if math.isinf(mass_a) else 1.0 if math.isinf(mass_b) else rng.random()
        names = ("max_crush_speed_a", "max_crush_speed_b")
        crush = dict(zip(names, impact.max_crush_speeds(share), strict=True))
        for other in (e, 0.0, lambda v: 0.3):
            # Absorbed at maximum crush, before restitution: e does not matter.
            assert solve(mass_a, mass_b, other, **crush) == pytest.approx(g, rel=12 * EPS)
        ees_a, ees_b = impact.ees(share)
        assert solve(mass_a, mass_b, e, ees_a=ees_a, ees_b=ees_b) == pytest.approx(
            g, rel=12 * EPS / (1 - e)
        )


def test_absorbed_is_not_dissipated():
    """At e = 0.3 taking the absorbed energy for the dissipated one is 4.8 percent of speed too
    much: 1 / sqrt(1 - 0.09).
    """
    impact = col.linear_central(body(vx=15.0), body(mass=1500.0), 0.3)
    found = reconstruct.inline_closing_speed(1000, 1500, 0.3, energy_loss=impact.energy_absorbed)
    assert found / 15.0 == pytest.approx(1 / math.sqrt(0.91), rel=1e-14)
    assert impact.energy_loss == pytest.approx(0.91 * impact.energy_absorbed, rel=1e-14)


def test_a_function_is_met_more_than_once():
    """Every closing speed is given; 1.8 = g (1 + e) / 2 with 0.3 below 3 m/s and 0.1 above."""
    with pytest.raises(
        col.AmbiguousSolutionError, match=r"2\.76923 m/s and 3\.27273 m/s"
    ) as caught:
        reconstruct.inline_closing_speed(1000, 1000, lambda v: 0.3 if v < 3 else 0.1, delta_v_a=1.8)
    assert caught.value.solutions == pytest.approx((3.6 / 1.3, 3.6 / 1.1), rel=1e-12)
    assert caught.value.code == "ambiguous"
    # The other way about no closing speed has its restitution; the jump is no answer.
    error = refusal(
        lambda: reconstruct.inline_closing_speed(
            1000, 1000, lambda v: 0.1 if v < 3 else 0.3, delta_v_a=1.8
        )
    )
    assert (type(error), error.code) == (col.NoSolutionError, "contradictory")


@pytest.mark.slow
def test_a_function_in_a_batch_of_inline_impacts():
    """As one by one; where two closing speeds fit, none does, or an input is wrong, the case is NaN
    and counted.
    """
    solve = reconstruct.inline_closing_speed

    def two_steps(v):
        return 0.3 if v < 3 else 0.1

    delta_v = np.array([[1.0, 1.8, 2.5, -1.0, math.nan]])
    with pytest.warns(col.CollisionsWarning, match="3 of 5 cases"):
        found = solve(1000, 1000, two_steps, delta_v_a=delta_v)
    assert found.shape == (1, 5)
    assert found[0, [0, 2]].tolist() == [
        solve(1000, 1000, two_steps, delta_v_a=dv) for dv in (1.0, 2.5)
    ]
    assert np.isnan(found[0, [1, 3, 4]]).all()
    for function in (
        lambda v: 0.3 / (1 + v),
        lambda v: col.reference.restitution(v, outside="refuse"),
    ):
        many = np.linspace(0.8, 2.5, 300)
        found = solve(1000, np.linspace(900, 1400, 300), function, delta_v_a=many)
        for i in (0, 7, 255, 256, 299):
            alone = solve(
                1000, float(np.linspace(900, 1400, 300)[i]), function, delta_v_a=float(many[i])
            )
            assert found[i] == pytest.approx(alone, rel=1e-12)
    # A function that answers an array by one number, which is right for the cases asked first, is
    # asked of each case.
    many = np.append(np.full(256, 1.0), [0.9, 1.5, 2.0, 2.5])
    found = solve(1000, 1000, lambda v: 0.3 if np.all(v < 3) else 0.1, delta_v_a=many)
    assert found[256:].tolist() == [solve(1000, 1000, two_steps, delta_v_a=dv) for dv in many[256:]]
    assert solve(1000, 1000, two_steps, delta_v_a=np.zeros(0)).shape == (0,)
    assert (
        solve(1000, 1000, two_steps, delta_v_a=np.array([1.0], dtype=np.float32)).dtype
        == np.float32
    )


def only_slow(v):
    if v > 3.0:
        raise ValueError("fitted below 3 m/s")
    return 0.4


def test_the_range_of_a_function_is_checked():
    """It may fail where it is not needed; where the answer would lie, its own words are in the
    error.
    """
    found = reconstruct.inline_closing_speed(1000, 1000, only_slow, delta_v_a=1.5)
    assert found == pytest.approx(3.0 / 1.4, rel=1e-12)
    error = refusal(lambda: reconstruct.inline_closing_speed(1000, 1000, only_slow, delta_v_a=15.0))
    assert (type(error), error.code) == (col.InputError, "bad_restitution")
    assert "raised ValueError: fitted below 3 m/s" in str(error)
    # The cubic falls below 0 at highway speed.
    error = refusal(
        lambda: reconstruct.inline_closing_speed(1500, 1500, cipriani, delta_v_a="120 km/h")
    )
    assert error.code == "bad_restitution"
    assert "not a number from 0 to 1" in str(error)


@pytest.mark.parametrize(
    ("function", "said"),
    [
        (lambda v: None, "raised TypeError"),
        (lambda v: math.nan, "gave nan"),
        (lambda v: 1.3, "gave 1.3"),
        (lambda v: -0.1, "gave -0.1"),
        (lambda v: 1 / 0, "raised ZeroDivisionError"),
        (lambda: 0.1, "raised TypeError"),
    ],
)
def test_a_function_that_gives_nonsense(function, said):
    """An InputError that shows where it was called and what came."""
    error = refusal(lambda: reconstruct.inline_closing_speed(1000, 1000, function, delta_v_a=1.8))
    assert (type(error), error.code) == (col.InputError, "bad_restitution")
    assert said in str(error)
    assert "closing speeds in m/s" in str(error)


INLINE = [
    ("too_few_knowns", (1, 1, 0.1), {}, ["exactly 1", "delta_v_a", "energy_loss"]),
    (
        "too_many_knowns",
        (1, 1, 0.1),
        {"delta_v_a": 1, "delta_v_b": 1},
        ["got 2 (delta_v_a, delta_v_b)", "leave out 1"],
    ),
    ("too_many_knowns", (1, 1, 0.1), {"energy_loss": 1, "ees_a": 1, "ees_b": 1}, ["leave out 1"]),
    ("one_ees", (1, 1, 0.1), {"ees_a": 1}, ["both ees_a and ees_b"]),
    ("one_ees", (1, 1, 0.1), {"ees_b": 1}, ["both ees_a and ees_b"]),
    (
        "negative_speed",
        (1, 1, 0.1),
        {"delta_v_a": -1},
        ["delta_v_a must be >= 0, got -1", "magnitude"],
    ),
    (
        "negative_speed",
        (1, 1, 0.1),
        {"ees_a": 1, "ees_b": "-1 km/h"},
        ["ees_b must be >= 0, got '-1 km/h'"],
    ),
    ("negative_energy", (1, 1, 0.1), {"energy_loss": -1}, ["energy_loss must be >= 0"]),
    (
        "bad_restitution",
        (1, 1, 1.1),
        {"delta_v_a": 1},
        ["restitution must be from 0 to 1, got 1.1"],
    ),
    ("not_positive", (0, 1, 0.1), {"delta_v_a": 1}, ["mass_a must be > 0"]),
    ("not_finite", (1, 1, 0.1), {"delta_v_a": INF}, ["delta_v_a must be finite"]),
    ("bad_units", (1, 1, 0.1), {"energy_loss": "5 m/s"}, ["energy_loss: '5 m/s'"]),
    ("undetermined", (1, 1, 1.0), {"ees_a": 5, "ees_b": 5}, ["loses no energy", "give a delta-V"]),
    ("undetermined", (1, 1, 1.0), {"energy_loss": 5}, ["loses no energy", "give a delta-V"]),
    (
        "infinite_mass",
        (INF, 1, 0.1),
        {"delta_v_a": 5},
        ["delta_v_a is that of an infinite mass", "other vehicle"],
    ),
    (
        "infinite_mass",
        (1, INF, cipriani),
        {"delta_v_b": 5},
        ["delta_v_b is that of an infinite mass"],
    ),
    ("immovable", (INF, INF, 0.1), {"energy_loss": 5}, ["both masses are infinite"]),
    ("immovable", (INF, INF, cipriani), {"energy_loss": 5}, ["both masses are infinite"]),
    (
        "contradictory",
        (INF, 1, 0.1),
        {"ees_a": 5, "ees_b": 5},
        ["an infinite mass has an equivalent speed of 0"],
    ),
    (
        "contradictory",
        (1, 1, lambda v: 1.0),
        {"energy_loss": 5},
        ["no closing speed has the restitution"],
    ),
    ("bad_shape", (np.ones(3), np.ones(2), 0.1), {"delta_v_a": 5}, ["mass_a (3,), mass_b (2,)"]),
]


@pytest.mark.parametrize(
    ("code", "arguments", "known", "said"),
    INLINE,
    ids=[f"{i}-{row[0]}" for i, row in enumerate(INLINE)],
)
def test_inline_refusals(code, arguments, known, said):
    """The error of its family, naming the argument or what to give instead."""
    error = refusal(lambda: reconstruct.inline_closing_speed(*arguments, **known))
    assert error.code == code
    unsolved = code in ("undetermined", "infinite_mass", "immovable", "contradictory")
    assert isinstance(error, col.NoSolutionError if unsolved else col.InputError)
    for part in said:
        assert part in str(error)


def test_inline_batches():
    """As alone, case by case; negative, NaN and impossible cases are NaN and counted, never
    answered with a sign or a square.
    """
    solve = reconstruct.inline_closing_speed
    mass = np.array([[900.0], [INF]])
    found = solve(mass, 1200.0, 0.2, delta_v_b=np.array([1.0, 2.0, 3.0]))
    assert found.shape == (2, 3)
    for i in range(2):
        for j in range(3):
            assert found[i, j] == pytest.approx(
                solve(float(mass[i, 0]), 1200.0, 0.2, delta_v_b=j + 1.0), rel=4 * EPS
            )
    for known in (
        {"delta_v_a": np.array([2.0, -2.0, np.nan])},
        {"ees_a": np.array([2.0, -2.0, np.nan]), "ees_b": 1.0},
        {"energy_loss": np.array([2.0, -2.0, np.nan])},
    ):
        with pytest.warns(col.CollisionsWarning, match="2 of 3 cases"):
            assert np.isnan(solve(1000.0, 1000.0, 0.1, **known)).tolist() == [False, True, True]
    with pytest.warns(col.CollisionsWarning, match="3 of 4 cases"):
        found = solve(np.array([1.0, 0.0, np.nan, INF]), 1.0, 0.1, delta_v_a=1.0)
    assert np.isnan(found).tolist() == [False, True, True, True]
    assert found[0] == solve(1.0, 1.0, 0.1, delta_v_a=1.0)
    single = solve(1000.0, 1000.0, 0.1, delta_v_a=np.ones(2, np.float32))
    assert single.dtype == np.float32
    assert not single.flags.writeable
    other = other_registry()
    assert solve(
        "1 t", other.Quantity(1000.0, "kg"), 0.1, delta_v_a=other.Quantity(3.6, "km/h")
    ) == pytest.approx(2 / 1.1, rel=4 * EPS)


# Crush


def crush_exactly(gaps, depths, a, b):
    """The integral of A C + B C^2 / 2 + A^2 / (2 B) over a piecewise linear profile, by quadrature
    in 30 digits.
    """
    with mpmath.workdps(30):
        a, b = mpmath.mpf(a), mpmath.mpf(b)

        def taken_up(depth):
            return a * depth + b * depth**2 / 2 + a**2 / (2 * b)

        total = mpmath.mpf(0)
        for gap, one, two in zip(gaps, depths, depths[1:], strict=False):
            one, two = mpmath.mpf(one), mpmath.mpf(two)
            total += mpmath.mpf(gap) * mpmath.quad(
                lambda x, one=one, two=two: taken_up(one + (two - one) * x), [0, 1]
            )
        return total


@pytest.mark.slow
@pytest.mark.parametrize("count", [2, 3, 4, 6, 11])
def test_any_number_of_depths(count):
    """Against the integral, with one width and with a list; every term is positive, so some eps for
    each depth and gap.
    """
    rng = random.Random(count)
    for _ in range(4):
        depths = [rng.choice([0.0, rng.uniform(0.0, 0.9)]) for _ in range(count)]
        width, a, b = rng.uniform(0.5, 2.0), rng.uniform(0.0, 8e4), rng.uniform(1e5, 2e6)
        even = [width / (count - 1)] * (count - 1)
        uneven = [rng.uniform(0.0, 0.5) for _ in range(count - 1)]
        for widths, gaps in ((width, even), (uneven, uneven)):
            found = reconstruct.crush_energy(widths, depths, a, b)
            assert isinstance(found, float)
            assert found == pytest.approx(
                float(crush_exactly(gaps, depths, a, b)), rel=(6 + count) * EPS
            )


@pytest.mark.parametrize("count", [2, 4, 6])
def test_the_formulas_of_the_crash_programs(count):
    """CRASH3 for 2, 4 and 6 depths, as printed: L/5 (A/2 (C1 + 2C2 + ... + C6) + B/6 (C1^2 + 2C2^2
    + ... + C1C2 + ...) + 5G).
    """
    c = [0.1, 0.22, 0.35, 0.41, 0.3, 0.05][:count]
    a, b, width, gaps = 38e3, 640e3, 1.6, count - 1
    inner = range(1, gaps)
    linear = c[0] + c[-1] + 2 * sum(c[i] for i in inner)
    square = (
        c[0] ** 2
        + c[-1] ** 2
        + 2 * sum(c[i] ** 2 for i in inner)
        + sum(c[i] * c[i + 1] for i in range(gaps))
    )
    printed = width / gaps * (a / 2 * linear + b / 6 * square + gaps * a**2 / (2 * b))
    assert reconstruct.crush_energy(width, c, a, b) == pytest.approx(printed, rel=16 * EPS)


def test_crush_of_a_barrier_test_gives_its_speed():
    """Even crush in which the speed rises in a straight line with depth, v = b0 + b1 C (Campbell,
    SAE 740565), is m v^2 / 2.

    A = m b0 b1 / w and B = m b1^2 / w: at 0.4 m, 2.5 + 30 x 0.4 = 14.5 m/s.
    """
    mass, width, b0, b1 = 1400.0, 1.7, 2.5, 30.0
    found = reconstruct.crush_energy(width, [0.4] * 6, mass * b0 * b1 / width, mass * b1**2 / width)
    assert found == pytest.approx(mass * 14.5**2 / 2, rel=1e-14)


@pytest.mark.parametrize("degrees", [0, 10, -30, 45])
def test_the_force_angle(degrees):
    """1 + tan^2, which is 1 / cos^2: exactly 2 at 45 degrees, without a warning up to there;
    degrees or radians.
    """
    straight = reconstruct.crush_energy(1.5, [0.3, 0.1], 4e4, 6e5)
    for angle in (f"{degrees} deg", math.radians(degrees), pint.Quantity(degrees, "deg")):
        found = reconstruct.crush_energy(1.5, [0.3, 0.1], 4e4, 6e5, force_angle=angle)
        assert found == pytest.approx(
            straight * (1 + math.tan(math.radians(degrees)) ** 2), rel=8 * EPS
        )


@pytest.mark.parametrize("angle", ["45.1 deg", "-60 deg", math.radians(80)])
def test_a_force_angle_beyond_45_degrees(angle):
    """The value, and a warning that names the angle."""
    with pytest.warns(col.OutOfRangeWarning, match="more than 45 deg") as caught:
        found = reconstruct.crush_energy(1.5, [0.3, 0.1], 4e4, 6e5, force_angle=angle)
    assert caught[0].message.code == "force_angle"
    assert repr(angle) in str(caught[0].message)
    assert caught[0].filename == __file__
    cosine = math.cos(math.radians(float(angle.split()[0])) if isinstance(angle, str) else angle)
    assert found == pytest.approx(
        reconstruct.crush_energy(1.5, [0.3, 0.1], 4e4, 6e5) / cosine**2, rel=32 * EPS
    )


CRUSH = [
    (
        "bad_angle",
        (1.5, [0.3, 0.3], 4e4, 6e5),
        {"force_angle": "90 deg"},
        ["force_angle", "less than 90 deg", "'90 deg'"],
    ),
    ("bad_angle", (1.5, [0.3, 0.3], 4e4, 6e5), {"force_angle": math.pi / 2}, ["less than 90 deg"]),
    (
        "bad_angle",
        (1.5, [0.3, 0.3], 4e4, 6e5),
        {"force_angle": "-100 deg"},
        ["less than 90 deg", "'-100 deg'"],
    ),
    (
        "bad_shape",
        (1.5, [0.3], 4e4, 6e5),
        {},
        ["depths must be a list or an array of at least two", "got list of 1"],
    ),
    ("bad_shape", (1.5, np.array([0.3]), 4e4, 6e5), {}, ["got ndarray of 1", "[0.2, 0.35, 0.1]"]),
    ("bad_shape", (1.5, "0.3 m", 4e4, 6e5), {}, ["depths must be a list or an array", "got str"]),
    (
        "bad_shape",
        (1.5, np.ones((5, 2)), 4e4, 6e5),
        {},
        ["depths is an array of shape (5, 2)", "list(depths.T)"],
    ),
    (
        "bad_shape",
        (np.ones((5, 1)), [0.3, 0.2], 4e4, 6e5),
        {},
        ["widths is an array of shape (5, 1)", "list(widths.T)"],
    ),
    (
        "bad_shape",
        ([1.0, 1.0], [0.3, 0.2], 4e4, 6e5),
        {},
        ["widths has 2 values and depths 2", "1 in all"],
    ),
    (
        "bad_shape",
        (np.ones(3), [np.ones(2), 0.2], 4e4, 6e5),
        {},
        ["widths has 3 values and depths 2", "one array per gap"],
    ),
    (
        "bad_shape",
        ([np.ones(3)], [np.ones(2), 0.2], 4e4, 6e5),
        {},
        ["depths[0] (2,)", "widths[0] (3,)"],
    ),
    ("negative_length", (1.5, [0.3, -0.1], 4e4, 6e5), {}, ["depths[1] must be >= 0, got -0.1"]),
    ("negative_length", (-1.5, [0.3, 0.1], 4e4, 6e5), {}, ["widths must be >= 0"]),
    ("negative_length", ([-1.5], [0.3, 0.1], 4e4, 6e5), {}, ["widths[0] must be >= 0"]),
    (
        "negative_length",
        (1.5, np.array([0.3, -0.1]), 4e4, 6e5),
        {},
        ["depths[1] must be >= 0, got -0.1"],
    ),
    ("negative_stiffness", (1.5, [0.3, 0.1], -1, 6e5), {}, ["stiffness_a must be >= 0, got -1"]),
    ("not_positive", (1.5, [0.3, 0.1], 4e4, 0), {}, ["stiffness_b must be > 0, got 0"]),
    ("not_finite", (1.5, [0.3, math.nan], 4e4, 6e5), {}, ["depths[1] is NaN"]),
    ("not_finite", (1.5, np.array([0.3, math.nan]), 4e4, 6e5), {}, ["depths[1] is NaN"]),
    ("not_finite", (1.5, [0.3, 0.1], 4e4, INF), {}, ["stiffness_b must be finite"]),
    ("not_a_number", (1.5, np.array(["0.3", "0.1"]), 4e4, 6e5), {}, ["depths is an array of <U3"]),
    (
        "bad_units",
        (1.5, pint.Quantity([0.3, 0.1], "kg"), 4e4, 6e5),
        {},
        ["depths: [0.3 0.1] kilogram cannot be taken as m"],
    ),
    ("bad_units", (1.5, [0.3, "4 kg"], 4e4, 6e5), {}, ["depths[1]"]),
    ("bad_units", (1.5, [0.3, 0.1], "200 lb/in", 6e5), {}, ["stiffness_a", "lbf/in"]),
    ("out_of_range", (1.5, ["1e200 m", 0.1], 4e4, 6e5), {}, ["not a finite number"]),
]


@pytest.mark.parametrize(
    ("code", "arguments", "rest", "said"),
    CRUSH,
    ids=[f"{i}-{row[0]}" for i, row in enumerate(CRUSH)],
)
def test_crush_refusals(code, arguments, rest, said):
    """An InputError that names the argument, what was given and what to write."""
    error = refusal(lambda: reconstruct.crush_energy(*arguments, **rest))
    assert error.code == code
    assert isinstance(error, col.ShapeError if code == "bad_shape" else col.InputError)
    for part in said:
        assert part in str(error)
    every = refusal(
        lambda: reconstruct.crush_energy("x", [0.3, -0.3], -1, 0, force_angle="100 deg")
    )
    for name in ("widths", "depths[1]", "stiffness_a", "stiffness_b", "force_angle"):
        assert f"- {name}" in str(every)


@pytest.mark.slow
def test_a_crush_energy_says_what_it_was_worked_out_from():
    given = ("5 ft", ["11 in", "13 in", "9 in"], "300 lbf/in", "60 lbf/in**2")
    as_given = (
        "by crush_energy: width 5 ft, depths 11 in, 13 in, 9 in, A 300 lbf/in, B 60 lbf/in**2"
    )
    front = reconstruct.crush_energy(*given, name="front of the Accord")
    side = reconstruct.crush_energy(
        [0.5, 0.4], np.array([0.1, 0.3, 0.2]), 4e4, "600 kN/m**2", force_angle="20 deg"
    )
    said = (
        "by crush_energy: widths 0.5 m, 0.4 m, depths 0.1 m, 0.3 m, 0.2 m, A 40000 N/m, "
        "B 600 kN/m**2, force at 20 deg"
    )
    assert front.source == f"front of the Accord, {as_given}"
    assert side.source == said
    assert (front + side).source == sum([front, side]).source == f"{front.source}; {said}"
    assert reconstruct.q.crush_energy(*given).magnitude.source == as_given
    metres = pint.UnitRegistry().Quantity([10.0, 20.0], "cm")
    assert "depths 10 cm, 20 cm," in reconstruct.crush_energy(1, metres, 1e4, 1e5).source
    # A number without a source leaves a sum without one: it would say less than the number is.
    for plain in (0.5 * front, front + 1.0, 1.0 + front, np.float64(1.0) + front):
        assert not hasattr(plain, "source")


def test_a_crush_energy_is_a_float_in_everything():
    energy = reconstruct.crush_energy(1.5, [0.3, 0.1], 4e4, 6e5)
    plain = float(energy)
    assert type(plain) is float
    assert isinstance(energy, float)
    assert energy == plain
    assert hash(energy) == hash(plain)
    assert repr(energy) == repr(plain)
    assert json.dumps([energy]) == json.dumps([plain])
    again = pickle.loads(pickle.dumps(energy))
    assert (again, again.source) == (energy, energy.source)
    assert np.array([energy, energy]).dtype == np.float64
    assert np.array_equal(energy + np.array([1.0, 2.0]), plain + np.array([1.0, 2.0]))
    assert col.Vehicle(mass=energy).mass == plain
    assert type(col.Vehicle(mass=energy).mass) is float


def test_crush_in_units_and_batches():
    """US units as in the CRASH sheets; arrays among the arguments, refused cases NaN, single
    precision stays.
    """
    solve = reconstruct.crush_energy
    us = solve("60 in", ["10 in", "14 in"], "200 lbf/in", "65 lbf/in**2")
    # 60 (200 x 12 + 65 (100 + 140 + 196) / 6 + 200^2 / 130) inch pounds.
    assert us == pytest.approx(
        60 * (2400 + 65 * 436 / 6 + 4e4 / 130) * 0.45359237 * 9.80665 * 0.0254, rel=16 * EPS
    )
    deep = np.array([0.1, -0.1, 0.3, np.nan])
    with pytest.warns(col.CollisionsWarning, match="2 of 4 cases"):
        many = solve(1.5, [deep, 0.2], 4e4, 6e5)
    for i in (0, 2):
        assert many[i] == pytest.approx(solve(1.5, [float(deep[i]), 0.2], 4e4, 6e5), rel=8 * EPS)
    assert np.isnan(many).tolist() == [False, True, False, True]
    angles = np.radians([0.0, 30.0, 90.0, 120.0])
    with pytest.warns(col.CollisionsWarning, match="2 of 4 cases"):
        assert np.isnan(solve(1.5, [0.3, 0.2], 4e4, 6e5, force_angle=angles)).tolist() == [
            False,
            False,
            True,
            True,
        ]
    with pytest.warns(col.CollisionsWarning, match="1 of 2 cases .*not_positive"):
        assert np.isnan(solve(1.5, [0.3, 0.2], 4e4, np.array([6e5, 0.0]))).tolist() == [False, True]
    single = solve([np.ones(2, np.float32)], [0.3, 0.2], 4e4, 6e5)
    assert single.dtype == np.float32
    assert single[0] == pytest.approx(solve(1.0, [0.3, 0.2], 4e4, 6e5), rel=2.0**-23)


def test_an_array_is_a_profile_like_a_list():
    """What stands in a list, a tuple, an array or a Quantity of one dimension is one case, for
    widths as for depths.
    """
    solve = reconstruct.crush_energy
    depths, widths = [0.12, 0.25, 0.38], [0.7, 0.4]
    even, uneven = solve(1.1, depths, 4e4, 6e5), solve(widths, depths, 4e4, 6e5)
    assert even != uneven
    for kind in (
        tuple,
        np.array,
        lambda values: pint.Quantity(np.array(values), "m"),
        lambda values: pint.Quantity(values, "m"),
    ):
        for found, expected in (
            (solve(1.1, kind(depths), 4e4, 6e5), even),
            (solve(kind(widths), depths, 4e4, 6e5), uneven),
            (solve(kind(widths), kind(depths), 4e4, 6e5), uneven),
        ):
            assert isinstance(found, float)
            assert found == expected
    # 100 is exact, and a centimetre is a rounding of a hundredth.
    assert solve(1.1, pint.Quantity([12.0, 25.0, 38.0], "cm"), 4e4, 6e5) == pytest.approx(
        even, rel=8 * EPS
    )
    rows = np.array([[0.12, 0.25, 0.38], [0.2, 0.1, 0.0]])
    many = solve([np.array([0.7, 0.6]), 0.4], list(rows.T), 4e4, 6e5)
    assert many.tolist() == [uneven, solve([0.6, 0.4], rows[1], 4e4, 6e5)]


def test_speeds_beyond_floats_are_refused():
    """Closing and separation that overflow have no quotient."""
    far = col.Vehicle(mass=1.0, yaw_rate=-3.0, yaw_inertia=math.inf, x=0.0, y=-6e307)
    near = far.replace(yaw_rate=-18.0, y=-1e307)
    still = col.Vehicle(mass=1.0, yaw_inertia=math.inf)
    with pytest.raises(col.InputError) as caught:
        reconstruct.restitution(far, near, still, still, normal=0.0, point=(1.0, 1.0))
    assert caught.value.code == "out_of_range"


def test_a_coordinate_nothing_needs_still_says_how_many_cases():
    """An array where a wall was before makes a batch, although its place does not matter."""
    a, wall = (
        col.Vehicle(mass=1200.0, vx=10.0, yaw_inertia=1800.0, x=0.0, y=0.0),
        col.Vehicle.barrier(),
    )
    listed = col.Vehicle(mass=math.inf, yaw_inertia=math.inf, y=np.zeros(3))
    found = reconstruct.restitution(
        a, listed, a.replace(vx=-1.0), wall, normal=0.0, point=(0.0, 0.0)
    )
    assert found.tolist() == [0.1, 0.1, 0.1]


@pytest.mark.parametrize("size", [(), (2,)])
def test_a_body_that_does_not_turn_may_be_anywhere(size):
    """Its distance from the contact would be beyond the largest number."""
    far = {"yaw_inertia": 2000.0, "x": np.full(size, -1e308)[()], "y": 0.0}
    a, b = col.Vehicle(mass=1500.0, vx=10.0, **far), col.Vehicle(mass=1500.0)
    found = reconstruct.restitution(
        a, b, a.replace(vx=4.0), b.replace(vx=6.0), normal=0.0, point=(1e308, 1e308)
    )
    assert np.array_equal(found, np.full(size, 0.2))


@pytest.mark.parametrize(
    ("widths", "depths", "said"),
    [
        (60, [5, 10], ["depths = 10", "widths = 60"]),
        (1.5, [12, 25], ["depths = 25"]),
        ("1.5 m", np.array([120.0, 250.0]), ["depths = 250"]),
        ([1500, "0.8 m"], [0.1, 0.2, "30 cm"], ["widths = 1500"]),
        (150, [0.1, 0.2, 0.1], ["widths = 150"]),
        (48, np.full(6, 0.2), ["widths = 48"]),
        ([9.0, 9.5, 9.0], [0.1, 0.2, 0.2, 0.1], ["widths = 9.5"]),
        (
            pint.Quantity(60, "in"),
            [pint.Quantity(5, "in"), np.array([10.0, 11.0])],
            ["depths = 11"],
        ),
    ],
)
def test_crush_in_inches_or_centimetres_is_suspected(widths, depths, said):
    """Numbers without a unit are metres, and no car is crushed by two; one warning for each
    argument.
    """
    with pytest.warns(col.SuspectUnitsWarning) as caught:
        reconstruct.crush_energy(widths, depths, "35 kN/m", "450 kN/m**2")
    assert [str(one.message).partition(" is read as metres")[0] for one in caught] == said


def test_crush_with_units_is_beyond_suspicion():
    """The same in inches, pounds and inches, and in metres: 60 in wide, 5 in and 10 in deep."""
    us = reconstruct.crush_energy("60 in", ["5 in", "10 in"], "200 lbf/in", "65 lbf/in**2")
    # 60 (200 * 7.5 + 65 (25 + 50 + 100) / 6 + 200**2 / 130) lbf*in, and one is 0.112984829... J by
    # the definition of the pound.
    whole = 60 * (200 * 7.5 + 65 * 175 / 6 + 200**2 / 130)
    assert us == pytest.approx(whole * 0.45359237 * 9.80665 * 0.0254, rel=1e-13)


def test_speeds_of_maximum_crush_or_what_remains_lead_from_a_crush_energy_to_the_speeds():
    """In line through both centres and without friction, 1 - e^2 of it remains, and the speeds
    follow from the energies by hand: E = m v^2 / 2 of the reduced mass.
    """
    e, energies, masses = 0.3, (20e3, 30e3), (1500.0, 1200.0)
    reduced = masses[0] * masses[1] / sum(masses)
    closing = math.sqrt(2.0 * sum(energies) / reduced)
    a, b = (
        col.Vehicle(mass=mass, yaw_inertia=2000.0, x=x, y=0.0)
        for mass, x in zip(masses, (-2.0, 2.0), strict=True)
    )
    contact = {"normal": 0.0, "point": (0.0, 0.0), "restitution": e, "friction": 0.0}
    courses = {"course_a": 0.0, "course_b": 0.0, "speed_b": 5.0}
    crushes = (
        math.sqrt(2.0 * energy / mass) for energy, mass in zip(energies, masses, strict=True)
    )
    by_crush = dict(zip(("max_crush_speed_a", "max_crush_speed_b"), crushes, strict=True))
    for known in (by_crush, {"energy_loss": (1.0 - e**2) * sum(energies)}):
        (found,) = reconstruct.speeds(a, b, **courses, **contact, **known)
        assert found.a.before.speed == pytest.approx(5.0 + closing, rel=1e-9)
    # And delta-V from damage is 1/(1 + e) of its delta-V.
    up_to_common = reconstruct.crush_delta_v(sum(energies), *masses)
    for side, part in zip((found.a, found.b), up_to_common, strict=True):
        assert side.delta_v == pytest.approx((1.0 + e) * part, rel=1e-9)


@pytest.mark.parametrize(
    ("a", "b", "said"),
    [
        (250, 50, ["stiffness_a = 250", "stiffness_b = 50"]),
        (438.0, "34.5 N/cm**2", ["stiffness_a = 438"]),
        (pint.Quantity(250, "lbf/in"), 50.0, ["stiffness_b = 50"]),
        (np.array([0.0, 4e4, 300.0, 250.0]), 5e5, ["stiffness_a = 250"]),
        (0.0, "50 lbf/in**2", []),
        (0.0, 1e5, []),
        ("250 lbf/in", "50 lbf/in**2", []),
        ("250 N/m", "50 N/m**2", []),
    ],
)
def test_stiffness_as_tables_in_pounds_and_inches_print_it_is_suspected(a, b, said):
    """Read as N/m the front of a car would hold no more than a hand, and its damage would say next
    to nothing.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        reconstruct.crush_energy("60 in", ["12 in", "12 in"], a, b)
    assert {one.category for one in caught} <= {col.SuspectUnitsWarning}
    assert [str(one.message).partition(" is read as N/m")[0] for one in caught] == said
    # What it says to write can be written, and is beyond suspicion.
    for one in caught:
        written = re.findall(r"'(.*?)'", str(one.message))
        assert len(written) == 2
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for text in written:
                given = {"stiffness_a": "40 kN/m", "stiffness_b": "600 kN/m**2"}
                given[one.message.fields["argument"]] = text
                assert reconstruct.crush_energy("60 in", ["12 in", "12 in"], **given) > 0.0


def test_two_springs_in_series_share_the_energy_as_their_inverse_stiffness():
    """One force F: each takes F**2 / (2 k). With A + B C and A**2 / (2 B), (A w + B w C)**2 / (2 B
    w) where crushed evenly.
    """
    share = reconstruct.crush_share("900 kN/m", "500 kN/m")
    force = 3e5
    taken = force**2 / (2 * 9e5), force**2 / (2 * 5e5)
    assert share == pytest.approx(taken[0] / sum(taken), rel=1e-15)
    width, (front_a, front_b), (side_a, side_b) = 1.4, (6e4, 7e5), (3e4, 4e5)
    deep = 0.35
    deeper = (front_a + front_b * deep - side_a) / side_b  # where both press alike
    front = reconstruct.crush_energy(width, [deep, deep], front_a, front_b)
    side = reconstruct.crush_energy(width, [deeper, deeper], side_a, side_b)
    assert reconstruct.crush_share(front_b * width, side_b * width) == pytest.approx(
        front / (front + side), rel=1e-14
    )
    assert reconstruct.crush_share(math.inf, 5e5) == 0.0
    assert reconstruct.crush_share(5e5, math.inf) == 1.0
    # Their quotient and their sum overflow.
    assert reconstruct.crush_share(1e308, 1e308) == 0.5
    assert reconstruct.crush_share(1e300, 1e-300) == 0.0
    with pytest.warns(col.CollisionsWarning, match="1 immovable, 1 not_positive") as caught:
        many = reconstruct.crush_share(
            np.array([9e5, math.inf, 0.0]), np.array([5e5, math.inf, 5e5])
        )
    assert len(caught) == 1
    np.testing.assert_array_equal(many, [share, math.nan, math.nan])
    assert reconstruct.crush_share(np.float32([9e5]), 5e5).dtype == np.float32
    for call in (reconstruct.crush_share, lambda a, b: reconstruct.crush_delta_v(9e4, a, b)):
        with pytest.raises(col.ShapeError):
            call(np.ones(2), np.ones(3))


def test_the_share_is_that_of_a_contact_followed_in_time():
    """Two crush stiffnesses in series: their work up to maximum engagement, integrated by
    time_resolved, divides so.
    """
    a, b = (
        col.Vehicle(mass=1500.0, yaw_inertia=2500.0, vx=14.0, x=-2.0, y=0.0),
        col.Vehicle(mass=1200.0, yaw_inertia=2000.0, x=2.0, y=0.0),
    )
    stiff, soft = 9e5, 5e5
    both = stiff * soft / (stiff + soft)
    impact = col.time_resolved(
        a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5, stiffness=both
    )
    force = impact.pulse.peak_force
    share = reconstruct.crush_share(stiff, soft)
    assert force**2 / (2.0 * stiff) == pytest.approx(
        share * impact.energy_absorbed, rel=1e-3
    )  # 100 steps


def test_delta_v_from_damage():
    """Plastic and central it is that of the common velocity; a wall; an arm that takes all;
    refusals; batches.
    """
    impact = col.linear_central(
        col.Vehicle(mass=1500.0, vx=14.0), col.Vehicle(mass=1200.0, vx=-3.0), 0.0
    )
    found = reconstruct.crush_delta_v(impact.energy_loss, 1500.0, 1200.0)
    assert found == pytest.approx((impact.a.delta_v, impact.b.delta_v), rel=1e-14)
    assert reconstruct.crush_delta_v("50 kJ", 1000.0, math.inf) == (10.0, 0.0)
    assert reconstruct.crush_delta_v("50 kJ", math.inf, 1000.0) == (0.0, 10.0)
    assert reconstruct.crush_delta_v(5e4, 1000.0, 1000.0, gamma_b=0.0) == (0.0, 0.0)
    assert reconstruct.q.crush_delta_v(5e4, 1000.0, math.inf)[0].m_as("km/h") == pytest.approx(
        36.0, rel=1e-14
    )
    with pytest.raises(col.NoSolutionError) as caught:
        reconstruct.crush_delta_v(5e4, math.inf, math.inf)
    assert caught.value.code == "immovable"
    for arguments, code in (
        ((-1.0, 1.0, 1.0), "negative_energy"),
        ((1.0, 0.0, 1.0), "not_positive"),
        ((1e308, 1e-3, 1.0), "out_of_range"),
    ):
        with pytest.raises(col.InputError) as caught:
            reconstruct.crush_delta_v(*arguments)
        assert caught.value.code == code
    with pytest.raises(col.InputError, match="gamma_a must be from 0 to 1"):
        reconstruct.crush_delta_v(1.0, 1.0, 1.0, gamma_a=1.5)
    with pytest.warns(col.CollisionsWarning, match="1 bad_fraction, 1 contradictory"):
        of_a, of_b = reconstruct.crush_delta_v(
            np.array([5e4, -1.0, 5e4]), 1000.0, 1000.0, gamma_a=np.array([1.0, 1.0, 2.0])
        )
    np.testing.assert_allclose([of_a[0], of_b[0]], math.sqrt(50.0), rtol=1e-15)
    assert np.isnan([of_a[1:], of_b[1:]]).all()
