"""Impact speeds from two things known: against the forward solver, against a scan of all slips, and
every refusal.
"""

import itertools
import math
import pickle
import warnings
from functools import cache

import numpy as np
import pytest

import collisions as col
from collisions.kernels.reverse import PLACES, parabola_roots, quartic_roots
from collisions.reconstruct import momentum, speeds
from collisions.travel import Tyres
from scenes import BESIDE, LAWS, RULES
from strategies import other_registry

VALUES = {
    "friction": (0.0, 0.3, 0.8, math.inf),
    "impulse_ratio": (-0.4, 0.3),
    "critical_fraction": (0.0, 0.3, 0.7, 1.0),
}
PAIRS = [
    pair
    for pair in itertools.combinations(
        ("speed_a", "speed_b", "delta_v_a", "delta_v_b", "energy_loss", "crush"), 2
    )
    if pair not in (("speed_a", "speed_b"), ("delta_v_a", "delta_v_b"))
]
A, B = BESIDE
CONTACT = {"normal": 0.0, "point": (0.0, 0.4), "friction": 0.05}
COURSES = {"course_a": 0.1, "course_b": 2.0}
HIT = col.eccentric(
    A.replace(vx=20 * math.cos(0.1), vy=20 * math.sin(0.1)),
    B.replace(vx=10 * math.cos(2.0), vy=10 * math.sin(2.0)),
    0.1,
    **CONTACT,
)


@cache
def forward_scenes(seed, count, rules=RULES, turning=True):
    """Random cars that meet: both speeds, both courses, the contact and the forward answer."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < count:
        rule = rules[rng.integers(len(rules))]
        contact = {
            "normal": rng.uniform(-0.6, 0.6),
            "point": tuple(rng.uniform((-0.4, -0.8), (0.4, 0.8)).tolist()),
        }
        contact |= {rule: float(rng.choice(VALUES[rule])), "law": LAWS[rng.integers(2)]}
        bodies, courses = [], rng.uniform(-3, 3, 2)
        for x, course in zip((-2.0, 2.0), courses, strict=True):
            bodies.append(
                col.Vehicle.from_speed(
                    speed=rng.uniform(1, 25),
                    course=course,
                    mass=rng.uniform(800, 3000),
                    yaw_inertia=rng.uniform(800, 4000),
                    x=x + rng.uniform(-0.5, 0.5),
                    y=rng.uniform(-1, 1),
                    yaw_rate=rng.choice((0.0, rng.uniform(-1, 1))) if turning else 0.0,
                )
            )
        try:
            impact = col.eccentric(*bodies, rng.uniform(0.0, 0.5), **contact)
        except (col.NoImpactError, col.NoSolutionError, col.EnergyGainWarning):
            continue
        if abs(math.sin(courses[0] - courses[1])) > 0.1:
            found.append((impact, courses, contact))
    return found


def knowledge(impact, pair, share=0.4):
    """The named two, from a forward answer."""
    found = {}
    for kind in pair:
        if kind == "crush":
            found["max_crush_speed_a"], found["max_crush_speed_b"] = impact.max_crush_speeds(share)
        elif kind == "ees":
            found["ees_a"], found["ees_b"] = impact.ees(share)
        elif kind.startswith("speed"):
            found[kind] = getattr(impact, kind[-1]).before.speed
        else:
            found[kind] = (
                getattr(impact, kind[-1]).delta_v
                if kind.startswith("delta_v")
                else impact.energy_loss
            )
    return found


def solve_back(impact, courses, contact, **known):
    """Speeds for the vehicles of a forward answer, whose own velocities must not matter."""
    a, b = (side.before.replace(vx=77.0, vy=-55.0) for side in (impact.a, impact.b))
    given = {
        "course_a": float(courses[0]),
        "course_b": float(courses[1]),
        "restitution": impact.restitution,
        **contact,
        **known,
    }
    with warnings.catch_warnings():
        # A root backwards along its course, or with an energy gain, is one nevertheless.
        warnings.simplefilter("ignore", col.CollisionsWarning)
        return speeds(a, b, **given)


def attempt(solver, *inputs, **given):
    """What a reverse solver answers, and its refusal: one of them is None."""
    try:
        return solver(*inputs, **given), None
    except col.NoSolutionError as refusal:
        return None, refusal


def off(one, other):
    """Largest difference of a velocity before."""
    return max(
        abs(getattr(getattr(one, s).before, v) - getattr(getattr(other, s).before, v))
        for s in "ab"
        for v in ("vx", "vy")
    )


def check_roots(found, known, courses, contact):
    """Each runs forward to what was known, along the courses; none twice; by rising
    closing speed.
    """
    for root in found:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.EnergyGainWarning)
            again = col.eccentric(root.a.before, root.b.before, root.restitution, **contact)
        # Newton's method ends within rounding of a root; a double one at the square root of it.
        for kind, value in known.items():
            if kind == "max_crush_speed_b":
                continue
            if kind == "max_crush_speed_a":
                absorbed = sum(
                    0.5 * getattr(root, s).before.mass * known[f"max_crush_speed_{s}"] ** 2
                    for s in "ab"
                )
                assert again.energy_absorbed == pytest.approx(absorbed, rel=1e-9)
            elif kind.startswith("speed"):
                side = getattr(again, kind[-1]).before
                assert math.hypot(side.vx, side.vy) == pytest.approx(value, rel=1e-12)
            else:
                seen = (
                    getattr(again, kind[-1]).delta_v
                    if kind.startswith("delta_v")
                    else again.energy_loss
                )
                assert seen == pytest.approx(value, rel=1e-9), kind
        for side, course in zip((root.a, root.b), courses, strict=True):
            across = side.before.vx * math.sin(course) - side.before.vy * math.cos(course)
            assert abs(across) <= 1e-12 * (1 + abs(side.before.vx) + abs(side.before.vy))
    closing = [root.closing_speed for root in found]
    assert closing == sorted(closing)
    for one, other in itertools.pairwise(found):
        assert off(one, other) > 1e-7 * other.closing_speed


def roots_of_a_scan(impact, courses, contact, known):
    """How many roots a scan shows: forward over a fine row of speeds, or of slips, and changes of
    sign counted.

    With a speed known, the other one runs from -200 to 200 m/s. Without, every slip per closing
    speed is tried, at the size that gives the first of the two known; velocities at the contact are
    linear in the speeds, so two forward answers give them.
    """
    one = {"speed_a": "speed_b", "speed_b": "speed_a"}
    fixed = next((kind for kind in known if kind in one), None)
    other = [kind for kind in known if kind not in ("max_crush_speed_b", fixed)]

    def run(speed_a, speed_b):
        a, b = (
            side.before.replace(vx=speed * math.cos(course), vy=speed * math.sin(course))
            for side, speed, course in zip(
                (impact.a, impact.b), (speed_a, speed_b), courses, strict=True
            )
        )
        return col.eccentric(a, b, impact.restitution, on_failure="nan", **contact)

    def seen(found, kind):
        if kind == "max_crush_speed_a":
            return found.energy_absorbed / sum(
                0.5 * getattr(impact, s).before.mass * known[f"ees_{s}"] ** 2 for s in "ab"
            )
        value = (
            getattr(found, kind[-1]).delta_v ** 2
            if kind.startswith("delta_v")
            else found.energy_loss
        )
        return value / (known[kind] ** 2 if kind.startswith("delta_v") else known[kind])

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        if fixed:
            row = np.linspace(-200.0, 200.0, 10001)
            value = np.full_like(row, known[fixed])
            excess = (
                seen(run(*((value, row) if fixed == "speed_a" else (row, value))), other[0]) - 1.0
            )
        else:
            # Without yaw rates all answers scale: any direction in the plane of the speeds, made as
            # long as the first demands.
            angle = np.linspace(-math.pi, math.pi, 10001)
            found = run(np.cos(angle), np.sin(angle))
            excess = seen(found, other[1]) / seen(found, other[0]) - 1.0
    return int(np.sum(excess[:-1] * excess[1:] < 0.0))


# Against the forward solver


@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_the_true_speeds_are_found(pair):
    """Among the roots, to 1e-9 of the speeds times the condition that comes with them; undetermined
    only where the slip is open.
    """
    answered = 0
    for impact, courses, contact in forward_scenes(11, 10):
        known = knowledge(impact, pair)
        found, refusal = attempt(solve_back, impact, courses, contact, **known)
        if refusal is not None:
            assert refusal.code == "undetermined", (impact, contact, refusal)
            assert not {"speed_a", "speed_b"} & set(pair)
            slipless = impact.tangential_impulse == 0.0
            assert slipless or set(pair) in ({"delta_v_a", "crush"}, {"delta_v_b", "crush"}), (
                contact
            )
            continue
        check_roots(found, known, courses, contact)
        best = min(found, key=lambda root: off(root, impact))
        assert off(best, impact) <= 1e-9 * (1 + best.reconstruction.condition) * 25, (
            impact,
            contact,
        )
        assert best.reconstruction.method == "speeds"
        answered += 1
    assert answered >= 2


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize(
    "pair",
    [("speed_a", "delta_v_b"), ("speed_b", "energy_loss"), ("delta_v_a", "energy_loss")],
    ids="-".join,
)
def test_no_root_is_missed(rule, pair):
    """As many as a scan of 10001 forward answers shows, or more: two within a step of it show as
    none.
    """
    shown = 0
    for impact, courses, contact in forward_scenes(5, 10, (rule,), turning=False):
        known = knowledge(impact, pair)
        found, refusal = attempt(solve_back, impact, courses, contact, **known)
        if refusal is not None:
            assert refusal.code == "undetermined"
            continue
        within = [root for root in found if max(root.a.before.speed, root.b.before.speed) < 200.0]
        scanned = roots_of_a_scan(impact, courses, contact, known)
        assert len(within) >= scanned, (impact, contact)
        shown += scanned
    assert shown >= 6


@pytest.mark.slow
def test_two_roots_close_together():
    """With a share of the critical ratio, two roots may be a few percent apart and nearer: both are
    there.
    """
    found = []
    for impact, courses, contact in forward_scenes(3, 60, ("critical_fraction",)):
        if 0.0 < contact["critical_fraction"] < 1.0:
            roots = solve_back(
                impact, courses, contact, **knowledge(impact, ("delta_v_a", "energy_loss"))
            )
            assert min(off(root, impact) for root in roots) < 1e-6
            found += [
                one.closing_speed / other.closing_speed for one, other in itertools.pairwise(roots)
            ]
    assert max(found) > 0.97


@pytest.mark.slow
def test_a_parked_car_needs_no_course():
    """A course of None goes with a known speed of 0; a barrier too."""
    impact = col.eccentric(A.replace(vx=12.0), B, 0.1, **CONTACT)
    for pair in (("speed_b", "delta_v_a"), ("speed_b", "energy_loss"), ("speed_b", "crush")):
        (found,) = speeds(
            A, B, course_a=0.0, course_b=None, restitution=0.1, **CONTACT, **knowledge(impact, pair)
        )
        assert found.a.before.vx == pytest.approx(12.0, rel=1e-12)
        assert found.b.before.speed == 0.0
    wall = col.Vehicle.barrier()
    impact = col.eccentric(A.replace(vx=12.0), wall, 0.1, **CONTACT)
    known = {
        "speed_b": 0.0,
        "max_crush_speed_a": math.sqrt(2 * impact.energy_absorbed / A.mass),
        "max_crush_speed_b": 0.0,
    }
    (found,) = speeds(A, wall, course_a=0.0, course_b=None, restitution=0.1, **CONTACT, **known)
    assert found.a.before.vx == pytest.approx(12.0, rel=1e-12)
    (found,) = speeds(
        A,
        wall,
        course_a=0.0,
        course_b=None,
        restitution=0.1,
        **CONTACT,
        speed_b=0.0,
        delta_v_a=impact.a.delta_v,
    )
    assert found.a.before.vx == pytest.approx(12.0, rel=1e-12)


@pytest.mark.slow
def test_dissipated_and_absorbed_energy_differ_by_restitution():
    """Without friction the energy dissipated is 1 - e**2 of that absorbed at maximum crush, which
    the speeds of maximum crush stand for.
    """
    contact = {**CONTACT, "friction": 0.0}
    for e in (0.0, 0.1, 0.4):
        impact = col.eccentric(A.replace(vx=12.0), B, e, **contact)
        absorbed = impact.energy_loss / (1 - e * e)
        ees = math.sqrt(2 * absorbed / (A.mass + B.mass))
        known = {"speed_b": 0.0, "max_crush_speed_a": ees, "max_crush_speed_b": ees}
        (found,) = speeds(A, B, course_a=0.0, course_b=None, restitution=e, **contact, **known)
        assert found.a.before.vx == pytest.approx(12.0, rel=1e-13)


@pytest.mark.slow
def test_both_ees_are_the_energy_lost():
    """By ISO 12353 they stand for the energy dissipated: the roots are those of that energy,
    whatever the share.
    """
    for impact, courses, contact in forward_scenes(3, 12):
        if impact.energy_loss < 0.2 * impact.energy_absorbed:
            continue
        for other in ("speed_a", "delta_v_b"):
            by_energy, refusal = attempt(
                solve_back, impact, courses, contact, **knowledge(impact, (other, "energy_loss"))
            )
            by_ees, also = attempt(
                solve_back, impact, courses, contact, **knowledge(impact, (other, "ees"), share=0.7)
            )
            if by_energy is None:
                assert also.code == refusal.code
                continue
            assert len(by_ees) == len(by_energy)
            # The energy of both is rounded in its last digits, which friction at its least loss
            # takes the square root of.
            assert min(off(one, impact) for one in by_ees) < 1e-6
            assert by_ees[0].reconstruction.known == (other, "ees_a")
    # Taken for the speeds of maximum crush at e = 0.3 they read 5 percent low: sqrt(1 - e^2).
    impact = col.eccentric(A.replace(vx=12.0), B, 0.3, **{**CONTACT, "friction": 0.0})
    given = {
        "course_a": 0.0,
        "course_b": None,
        "restitution": 0.3,
        **{**CONTACT, "friction": 0.0},
        "speed_b": 0.0,
    }
    ees = dict(zip(("max_crush_speed_a", "max_crush_speed_b"), impact.ees(0.5), strict=True))
    (low,) = speeds(A, B, **given, **ees)
    assert low.a.before.vx == pytest.approx(12.0 * math.sqrt(1 - 0.09), rel=1e-12)


def test_parallel_courses():
    """One speed tells the other; without one only the closing speed is found, and the error says
    so.
    """
    impact = col.eccentric(A.replace(vx=20.0), B.replace(vx=8.0), 0.1, **CONTACT)
    given = {"course_a": 0.0, "course_b": 0.0, "restitution": 0.1, **CONTACT}
    (found,) = speeds(A, B, **given, speed_a=20.0, delta_v_b=impact.b.delta_v)
    assert found.b.before.vx == pytest.approx(8.0, rel=1e-12)
    with pytest.raises(col.NoSolutionError, match=r"parallel.*give one of the speeds") as caught:
        speeds(A, B, **given, delta_v_a=impact.a.delta_v, energy_loss=impact.energy_loss)
    assert caught.value.code == "parallel_headings"


TYRES = {"duration": 0.1, "tyres_a": Tyres(0.7, 0.3, 2.6, 1.5)}


@pytest.mark.parametrize("tyres", [{}, pytest.param(TYRES, marks=pytest.mark.slow)])
@pytest.mark.parametrize("more", [{}, {"energy_loss": ...}, {"slid": "bound"}])
@pytest.mark.parametrize("course_b", [0.0, math.pi])
def test_parallel_courses_beside_components(tyres, more, course_b):
    """The evidence is that of an impact, so nothing contradicts; in a batch as alone."""
    a, b = A.replace(vx=20.0, heading=0.0), B.replace(vx=8.0 * math.cos(course_b), vy=0.0)
    impact = col.eccentric(a, b, 0.1, **CONTACT, **tyres)
    known = {
        "delta_v_forward_a": impact.a.delta_v_forward,
        "delta_v_left_a": impact.a.delta_v_left,
        **({"energy_loss": impact.energy_loss} if "energy_loss" in more else more),
    }
    given = {"restitution": 0.1, **CONTACT, **tyres}
    with pytest.raises(col.NoSolutionError, match=r"parallel.*give one of the speeds") as alone:
        speeds(a, b, course_a=0.0, course_b=course_b, **given, **known)
    assert alone.value.code == "parallel_headings"
    with pytest.warns(col.CollisionsWarning):
        found = speeds(a, b, course_a=0.0, course_b=np.array([course_b, 1.0]), **given, **known)
    assert col.Status(found[0].status[0]).label == "parallel_headings"


def test_a_slip_that_stays_open():
    """Where the contact slides, delta-V and speeds of maximum crush tell of the closing speed
    alone.
    """
    assert HIT.regime == "sliding"
    for pair in (("delta_v_a", "crush"), ("delta_v_b", "crush")):
        with pytest.raises(col.NoSolutionError, match="leave the slip open") as caught:
            speeds(A, B, **COURSES, restitution=0.1, **CONTACT, **knowledge(HIT, pair))
        assert caught.value.code == "undetermined"


def test_a_negative_speed_is_said():
    """Backwards along its course: the value is returned, and warned of."""
    impact = col.eccentric(A.replace(vx=12.0), B.replace(vx=-5.0), 0.1, **CONTACT)
    known = {"speed_a": 12.0, "delta_v_b": impact.b.delta_v}
    with pytest.warns(
        col.OutOfRangeWarning, match=r"-5 m/s: backwards.* check the courses, and the normal"
    ) as caught:
        (found,) = speeds(A, B, course_a=0.0, course_b=0.0, restitution=0.1, **CONTACT, **known)
    assert len(caught) == 1
    assert caught[0].message.code == "negative_speed"
    assert caught[0].filename == __file__
    assert found.b.before.vx == pytest.approx(-5.0, rel=1e-12)


@pytest.mark.slow
def test_a_parked_car_does_not_go_backwards():
    """Its speed is found as 0 but for rounding, to either side."""
    rng, below = np.random.default_rng(3), 0
    for _ in range(20):
        a = A.replace(vx=rng.uniform(5.0, 25.0), heading=0.1)
        b = B.replace(vx=0.0, heading=1.2)
        contact = {"normal": rng.uniform(-0.3, 0.3), "point": (0.0, rng.uniform(-0.4, 0.4))}
        contact |= {"restitution": 0.1, "friction": math.inf}
        hit = col.eccentric(a, b, **contact)
        known = {
            f"delta_v_{way}_a": getattr(hit.a, f"delta_v_{way}") for way in ("forward", "left")
        }
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            (found,) = speeds(
                a, b, course_a=0.0, course_b=1.2, regime="sticking", **contact, **known
            )
        assert "negative_speed" not in {one.message.code for one in caught}
        along = found.b.before.vx * math.cos(1.2) + found.b.before.vy * math.sin(1.2)
        assert along == pytest.approx(0.0, abs=1e-12)
        below += along < 0.0
    assert below > 0


# Restitution that depends on the closing speed


def falling(closing):
    """A restitution that falls as the closing speed rises."""
    return 0.05 + 0.45 * math.exp(-closing / 6.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    "pair",
    [
        ("speed_a", "delta_v_b"),
        *(
            pytest.param(pair, marks=pytest.mark.slow)
            for pair in (("speed_b", "energy_loss"), ("speed_b", "crush"))
        ),
        pytest.param(("delta_v_a", "energy_loss"), marks=pytest.mark.slow),
    ],
)
def test_restitution_as_a_function(pair):
    """Every root has the restitution of its own closing speed, and the true one is among them."""
    checked = 0
    for known_e, courses, contact in forward_scenes(2, 3, ("friction", "impulse_ratio")):
        impact = col.eccentric(
            known_e.a.before, known_e.b.before, falling(known_e.closing_speed), **contact
        )
        if pair[0].startswith("delta") and (
            impact.tangential_impulse == 0.0 or impact.energy_loss < 0.0
        ):
            continue
        known = knowledge(impact, pair)
        found = solve_back(impact, courses, contact, **known, restitution=falling)
        for root in found:
            assert root.restitution == pytest.approx(falling(root.closing_speed), abs=1e-9)
        check_roots(found, known, courses, contact)
        assert min(off(root, impact) for root in found) < 1e-6
        checked += 1
    assert checked >= 2


def low_speed(**known):
    return speeds(A, B, course_a=0.0, course_b=None, speed_b=0.0, **{**CONTACT, **known})


@pytest.mark.slow
def test_a_jump_of_the_function_is_no_root():
    """A table with a step has a change of sign there, but no closing speed with its own
    restitution.
    """
    above = low_speed(delta_v_a=2.0, restitution=0.4)[0].closing_speed
    below = low_speed(delta_v_a=2.0, restitution=0.1)[0].closing_speed
    assert above < below
    with pytest.raises(col.NoSolutionError) as caught:
        low_speed(delta_v_a=2.0, restitution=lambda g: 0.1 if g < 0.5 * (above + below) else 0.4)
    assert caught.value.code == "contradictory"
    both = low_speed(delta_v_a=2.0, restitution=lambda g: 0.4 if g < 0.5 * (above + below) else 0.1)
    assert [root.restitution for root in both] == pytest.approx([0.4, 0.1], abs=1e-12)


def test_functions_that_cannot_be_used():
    """Values out of range, or an exception of its own, are quoted with the closing speed; shares
    are refused.
    """
    with pytest.raises(col.InputError, match=r"gave 1\.5, which is not .*from 0 to 1") as caught:
        low_speed(delta_v_a=2.0, restitution=lambda g: 1.5)
    assert (caught.value.code, caught.value.fields["argument"]) == (
        "bad_restitution",
        "restitution",
    )
    with pytest.raises(col.InputError, match=r"raised KeyError: 'nothing'") as caught:
        low_speed(delta_v_a=2.0, restitution=lambda g: {}["nothing"])
    assert caught.value.code == "bad_restitution"
    with pytest.raises(col.InputError, match="solved together") as caught:
        low_speed(delta_v_a=2.0, restitution=falling, friction=None, critical_fraction=0.5)
    assert caught.value.code == "bad_combination"


def in_arrays(closing):
    """The same as ``falling``, of arrays too."""
    return 0.05 + 0.45 * np.exp(-closing / 6.0)


def published(closing):
    """That of the published fit, NaN beyond its range."""
    return col.reference.restitution(closing, outside="refuse")


@pytest.mark.slow
@pytest.mark.parametrize(
    "function",
    [
        in_arrays,
        *(pytest.param(one, marks=pytest.mark.slow) for one in (falling, published)),
    ],
)
@pytest.mark.parametrize(
    "pair",
    [("speed_b", "delta_v_a"), pytest.param(("delta_v_b", "energy_loss"), marks=pytest.mark.slow)],
    ids=str,
)
def test_a_function_in_a_batch(function, pair):
    """Every root of every case as one by one; a case without one is NaN, and its neighbours are
    untouched.
    """
    contact = {**CONTACT, "friction": 0.5}
    e_true = [float(np.asarray(function(g))) for g in (3.0, 4.5, 6.0)]
    hits = []
    for closing, e in zip((3.0, 4.5, 6.0), e_true, strict=True):
        hit = solve_forward(closing, e, contact)
        assert hit.closing_speed == pytest.approx(closing, rel=1e-9)
        hits.append(hit)
    one_by_one = [knowledge(hit, pair) for hit in hits]
    together = {
        name: np.array([[*(known[name] for known in one_by_one), -1.0]]) for name in one_by_one[0]
    }
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        found = speeds(A, B, **COURSES, restitution=function, **contact, **together)
    assert any("1 of 4 cases" in str(one.message) for one in said)
    assert found[0].a.before.vx.shape == (1, 4)
    assert found[0].refused.tolist() == [[False, False, False, True]]
    assert all(np.array_equal(np.isnan(root.restitution), root.refused) for root in found)
    for i, (hit, known) in enumerate(zip(hits, one_by_one, strict=True)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            alone = speeds(A, B, **COURSES, restitution=function, **contact, **known)
        answers = [root for root in found if not root.refused[0, i]]
        assert len(answers) == len(alone) == found[0].reconstruction.answers[0, i]
        for root, single in zip(answers, alone, strict=True):
            # Both end within rounding of the root, by a restitution narrowed to rounding.
            assert root.a.before.speed[0, i] == pytest.approx(single.a.before.speed, rel=1e-9)
            assert root.restitution[0, i] == pytest.approx(single.restitution, rel=1e-9)
            assert root.reconstruction.condition[0, i] == pytest.approx(
                single.reconstruction.condition, rel=1e-5
            )
        assert min(abs(root.a.before.speed[0, i] - hit.a.before.speed) for root in answers) < 1e-6


def solve_forward(closing, e, contact):
    """The impact of A and B along ``COURSES`` at this closing speed, both equally fast but for
    that.
    """
    ways = [(math.cos(course), math.sin(course)) for course in COURSES.values()]
    approach = ways[0][0] - ways[1][0]  # the normal is along x, and nothing turns before
    speed = closing / approach
    return col.eccentric(
        A.replace(vx=speed * ways[0][0], vy=speed * ways[0][1]),
        B.replace(vx=speed * ways[1][0], vy=speed * ways[1][1]),
        e,
        **contact,
    )


@pytest.mark.slow
def test_a_function_under_propagate():
    """The restitution belongs to each sample's own closing speed."""
    contact = {**CONTACT, "friction": 0.5}

    def model(delta_v):
        known = {"speed_b": 0.0, "delta_v_a": delta_v}
        (found,) = speeds(
            A, B, course_a=0.0, course_b=None, restitution=in_arrays, **contact, **known
        )
        return {
            "speed": found.a.before.speed,
            "off": found.restitution - in_arrays(found.closing_speed),
        }

    spread = col.uncertainty.propagate(
        model,
        {"delta_v": col.uncertainty.Normal(4.0, 0.2)},
        method="quasi_random",
        samples=64,
        seed=1,
    )
    assert abs(spread["off"].mean) < 1e-9
    assert spread.failed == 0
    slope = float(
        (model(np.array([4.001]))["speed"] - model(np.array([3.999]))["speed"])[0] / 0.002
    )
    assert spread["speed"].std == pytest.approx(abs(slope) * 0.2, rel=0.05)


@pytest.mark.slow
def test_a_function_that_leaves_the_slip_open():
    """A sliding contact with delta-V and speeds of maximum crush: undetermined for a function as
    for a number.
    """
    impact = col.eccentric(HIT.a.before, HIT.b.before, falling(HIT.closing_speed), **CONTACT)
    with pytest.raises(col.NoSolutionError) as caught:
        speeds(
            A,
            B,
            **COURSES,
            restitution=falling,
            **CONTACT,
            **knowledge(impact, ("delta_v_a", "crush")),
        )
    assert caught.value.code == "undetermined"


# How well-posed


def sensitivity(ask, known):
    """Finite differences of the whole call: what relative changes of each known move, of the speed
    they move most.
    """
    step, moved = 1e-4, np.zeros(2)
    # Those of both vehicles are wrong together.
    pairs = {f"{name}_a": (f"{name}_a", f"{name}_b") for name in ("max_crush_speed", "ees")}
    names = [
        pairs.get(kind, (kind,)) for kind in known if kind not in ("max_crush_speed_b", "ees_b")
    ]
    middle = ask(**known)
    for group in names:
        ends = [
            ask(**{**known, **{name: known[name] * (1 + change) for name in group}})
            for change in (step, -step)
        ]
        moved += [
            abs(one - other) / (2 * step)
            for one, other in zip(
                *((found.a.before.vx, found.b.before.vx) for found in ends), strict=True
            )
        ]
    (ca, cb) = math.cos(COURSES["course_a"]), math.cos(COURSES["course_b"])
    return max(moved[0] / abs(ca), moved[1] / abs(cb)) / middle.closing_speed


def steep(closing):
    """A restitution that falls by a third of itself over one metre per second."""
    return 0.5 * math.exp(-closing / 3.0)


@pytest.mark.slow
@pytest.mark.parametrize("restitution", [0.1, steep], ids=["number", "steep"])
@pytest.mark.parametrize("pair", [("speed_a", "delta_v_b"), ("speed_b", "energy_loss"),
    ("speed_a", "crush"), ("speed_b", "ees"), ("delta_v_b", "ees"),
    ("delta_v_b", "energy_loss")], ids="-".join)  # fmt: skip
def test_the_condition_is_that_of_the_whole_call(pair, restitution):
    """With finite differences of answers, whose curvature leaves 1e-8 and rounding 1e-12 / 1e-4 of
    them: to 1e-5.

    At low speed, where a function of the closing speed is steep.
    """
    start = [
        side.before.replace(vx=side.before.vx / 8, vy=side.before.vy / 8) for side in (HIT.a, HIT.b)
    ]
    closing = HIT.closing_speed / 8
    impact = col.eccentric(
        *start, restitution(closing) if callable(restitution) else restitution, **CONTACT
    )
    known = knowledge(impact, pair)

    def ask(**given):
        found = solve_back(
            impact, list(COURSES.values()), CONTACT, **given, restitution=restitution
        )
        return min(found, key=lambda root: off(root, impact))

    assert ask(**known).reconstruction.condition == pytest.approx(sensitivity(ask, known), rel=1e-5)


@pytest.mark.slow
def test_the_slope_of_the_function_counts():
    """With the published example of a falling restitution the condition is not that of the same
    restitution as a number.
    """
    function = low_speed(delta_v_a=2.0, restitution=lambda g: 0.5 * math.exp(-g / 1.5))[0]
    number = low_speed(delta_v_a=2.0, restitution=function.restitution)[0]
    assert number.closing_speed == pytest.approx(function.closing_speed, rel=1e-9)
    assert number.reconstruction.condition == pytest.approx(1.0, rel=1e-9)
    # de/dg / (1 + e) = -e / 1.5 / (1 + e), and delta-V is as (1 + e) g.
    e, g = function.restitution, function.closing_speed
    assert function.reconstruction.condition == pytest.approx(
        1.0 / (1.0 - e / 1.5 / (1.0 + e) * g), rel=1e-6
    )


@pytest.mark.slow
def test_the_slope_at_the_end_of_a_function():
    """Where the function ends the slope is taken to the side that is there; where it holds at one
    place only there is none.
    """
    whole = low_speed(delta_v_a=2.0, restitution=steep)[0]
    below = low_speed(
        delta_v_a=2.0,
        restitution=lambda g: steep(g) if g <= whole.closing_speed * (1 + 1e-9) else math.nan,
    )[0]
    # A one-sided difference over 1e-4 of the closing speed.
    assert below.reconstruction.condition == pytest.approx(whole.reconstruction.condition, rel=1e-3)


# Refused


KNOWN = {"speed_a": 20.0, "delta_v_b": HIT.b.delta_v}
REFUSED = [
    ("too_few_knowns", col.InputError, {"delta_v_b": None}, "give 1 of"),
    ("too_many_knowns", col.InputError, {"energy_loss": 5e4}, "leave out 1"),
    ("too_many_knowns", col.InputError, {"delta_v_b": None, "speed_b": 10.0}, "eccentric"),
    ("same_information", col.InputError, {"speed_a": None, "delta_v_b": None, "energy_loss": 1e3,
        "ees_a": 5.0, "ees_b": 5.0}, "tell the same, the energy dissipated"),
    ("one_ees", col.InputError, {"delta_v_b": None, "max_crush_speed_b": 10.0},
        "both max_crush_speed_a and max_crush_speed_b"),
    ("same_information", col.InputError, {"speed_a": None, "delta_v_a": 1.1 * HIT.a.delta_v},
        "differ by 9.1%"),
    ("missing_course", col.MissingInputError, {"course_b": None}, "course_b is None"),
    ("missing_course", col.MissingInputError, {"course_a": None}, "course_a is None"),
    ("negative_speed", col.InputError, {"speed_a": -3.0}, "speed_a must be >= 0, got -3.0"),
    ("negative_energy", col.InputError, {"delta_v_b": None, "energy_loss": -3.0},
        "energy_loss must be >= 0"),
    ("bad_restitution", col.InputError, {"restitution": 1.5}, "1.5"),
    ("missing_inertia", col.MissingInputError, {"a": A.replace(yaw_inertia=None)},
        "a has no yaw_inertia"),
    ("pinned", col.InputError, {"b": B.replace(pivot=(3.0, 0.0))},
        "b has a pivot, so its velocity has no course of its own; use planar"),
    ("bad_shape", col.ShapeError, {"course_a": (0.0, 1.0)},
        "course_a is a tuple, and a course is an angle; many angles go in a numpy array"),
    ("bad_shape", col.ShapeError, {"course_b": [0.0, 1.0]},
        "course_b is a list, and a course is an angle; many angles go in a numpy array"),
    ("bad_option", col.InputError, {"forward_only": np.array([True, False])},
        "forward_only must be True or False, got array"),
    ("infinite_mass", col.NoSolutionError, {"b": col.Vehicle.barrier(), "course_b": None,
        "speed_a": None, "speed_b": 0.0},
        ("delta_v_b is that of an infinite mass, whose motion tells nothing of the impact; "
         "give delta_v_a")),
    ("contradictory", col.NoSolutionError, {"course_a": math.pi, "course_b": math.pi / 2},
        "check the courses, and the normal, which must point from A into B"),
    ("contradictory", col.NoSolutionError, {"friction": None, "impulse_ratio": 50.0},
        "with this restitution, impulse_ratio and geometry"),
    ("contradictory", col.NoSolutionError,
        {"speed_a": None, "delta_v_b": None, "energy_loss": 1e3, "max_crush_speed_a": 5.0,
            "max_crush_speed_b": 5.0, "restitution": 1.0, "friction": 0.0},
            ("fit energy_loss = 1000 J and max_crush_speed_a = 5 m/s and max_crush_speed_b = "
             "5 m/s with")),
    ("contradictory", col.NoSolutionError, {"speed_a": None, "delta_v_b": 0.0,
        "energy_loss": 0.0}, "fit delta_v_b = 0 m/s and energy_loss = 0 J with"),
    ("contradictory", col.NoSolutionError, {"speed_a": None, "delta_v_b": 0.0,
        "energy_loss": 1e3}, "or give another known in place of one of these"),
    ("contradictory", col.NoSolutionError, {"speed_a": 200.0, "delta_v_b": 0.5,
        "course_b": math.pi / 2},
        ("no speeds along these courses fit speed_a = 200 m/s and delta_v_b = 0.5 m/s with "
         "this restitution, friction")),
]  # fmt: skip


@pytest.mark.parametrize(
    ("code", "kind", "changes", "words"),
    REFUSED,
    ids=[f"{i}-{row[0]}" for i, row in enumerate(REFUSED)],
)
def test_refusals(code, kind, changes, words):
    """The class, the code, and what the message names."""
    given = {"a": A, "b": B, "restitution": 0.1, **COURSES, **CONTACT, **KNOWN, **changes}
    places = {name: given.pop(name) for name in ("a", "b")}
    given = {
        name: value
        for name, value in given.items()
        if value is not None or name.startswith("course")
    }
    with pytest.raises(kind) as caught:
        speeds(**places, **given)
    assert caught.value.code == code
    assert words in str(caught.value)
    assert type(pickle.loads(pickle.dumps(caught.value))) is type(caught.value)


@pytest.mark.slow
def test_a_function_is_refused_as_its_number():
    """A constant function is the number: nothing fits, though with another restitution any slip
    would.
    """
    for restitution in (0.3, lambda g: 0.3):
        with pytest.raises(
            col.NoSolutionError, match=r"fit delta_v_a = 2 m/s and energy_loss = 3000 J"
        ) as caught:
            speeds(
                A,
                B,
                **COURSES,
                **CONTACT,
                law="kudlich-slibar",
                restitution=restitution,
                delta_v_a=2.0,
                energy_loss=3e3,
            )
        assert caught.value.code == "contradictory"


@pytest.mark.parametrize("size", [1e-150, 1e-100, 1e-30, 1e30, 1e75, 1e100])
def test_very_small_and_very_large_speeds(size):
    """Speeds scale with what is known, energies with its square; nothing in between overflows or
    vanishes.
    """
    for pair in (("speed_a", "delta_v_b"), ("delta_v_b", "energy_loss"), ("speed_b", "crush")):
        known = knowledge(HIT, pair)
        plain = solve_back(HIT, list(COURSES.values()), CONTACT, **known)
        scaled = {
            kind: value * size * (size if kind == "energy_loss" else 1.0)
            for kind, value in known.items()
        }
        found = solve_back(HIT, list(COURSES.values()), CONTACT, **scaled)
        # Only rounding: the condition times a few eps.
        assert [root.closing_speed / size for root in found] == pytest.approx(
            [root.closing_speed for root in plain], rel=1e-11
        )
        assert [root.reconstruction.condition for root in found] == pytest.approx(
            [root.reconstruction.condition for root in plain], rel=1e-6
        )


@pytest.mark.slow
def test_speeds_beyond_floats():
    """Where the energy of the answer overflows that is said, alone and in a batch."""
    with pytest.raises(col.InputError) as caught:
        low_speed(delta_v_a=6e200, restitution=0.1)
    assert caught.value.code == "out_of_range"
    with pytest.warns(col.CollisionsWarning, match=r"1 of 2 cases .*\(1 out_of_range\)"):
        (found,) = low_speed(delta_v_a=np.array([6.0, 6e200]), restitution=0.1)
    assert found.status.tolist() == [col.Status.OK, col.Status.OUT_OF_RANGE]
    assert np.isnan(found.reconstruction.condition).tolist() == [False, True]


def test_a_course_is_an_angle_to_momentum_too():
    """Courses and headings as tuples or lists are refused, arrays of angles answered."""
    given = {
        "course_a": 0.0,
        "course_b": 1.5,
        "course_a_after": 0.5,
        "course_b_after": 0.7,
        "speed_a_after": 8.0,
        "speed_b_after": 9.0,
    }
    for name, value in (
        ("course_a", (0.0, 1.0)),
        ("course_b_after", [0.5, 0.6]),
        ("heading_a", (1.0, 0.0)),
        ("heading_b", [0.1]),
    ):
        noun = name.partition("_")[0]
        with pytest.raises(
            col.ShapeError,
            match=f"{name} is a .*, and a {noun} is an angle; many angles go in a numpy array",
        ) as caught:
            momentum(1500.0, 1300.0, **{**given, name: value})
        assert (caught.value.code, caught.value.fields["argument"]) == ("bad_shape", name)
    found = momentum(
        1500.0,
        1300.0,
        **{**given, "course_a": np.array([0.0, 0.1])},
        heading_a=np.array([0.0, 0.2]),
    )
    assert found.speed_a.shape == found.pdof_a.shape == (2,)


# Close to a restitution of 1


ALONG_AND_ACROSS = {
    "course_a": 0.0,
    "course_b": 1.57,
    "speed_a": 20.0,
    "normal": 0.0,
    "point": (0.0, 0.4),
}


@pytest.mark.parametrize("loss", [1.0, 1e-3, 1e-6])
@pytest.mark.parametrize(
    "known", [{"speed_a": 20.0}, {"speed_a": None, "delta_v_a": 20.0}], ids=["speed_a", "delta_v_a"]
)
def test_an_elastic_contact_without_friction_loses_nothing(known, loss):
    """Analytic: 0 J whatever the speeds, so a loss contradicts it, be it small; here 32 eps of
    impulse times speeds is 1e-8 J.
    """
    given = {**ALONG_AND_ACROSS, **known, "restitution": 1.0, "friction": 0.0, "energy_loss": loss}
    with pytest.raises(col.NoSolutionError) as caught:
        speeds(A, B, **{name: value for name, value in given.items() if value is not None})
    assert caught.value.code == "contradictory"


ELASTIC = [
    {"restitution": 1.0, "friction": 0.0},
    {"restitution": 1.0, "impulse_ratio": 0.0},
    {"restitution": 1.0, "friction": 0.5, "law": "kudlich-slibar"},
    {"restitution": 1.0, "friction": math.inf, "law": "kudlich-slibar"},
    {"restitution": 1.0, "critical_fraction": 1.0, "law": "kudlich-slibar"},
]


@pytest.mark.slow
@pytest.mark.parametrize("loss", [0.0, 1e-12, 5e-10])
@pytest.mark.parametrize("known", [{"speed_a": 20.0}, {"delta_v_a": 20.0},
    {"max_crush_speed_a": 5.0, "max_crush_speed_b": 5.0}],
        ids=lambda known: next(iter(known)))  # fmt: skip
@pytest.mark.parametrize("elastic", ELASTIC, ids=str)
def test_a_loss_within_rounding_tells_nothing(elastic, known, loss):
    """Where a range of speeds loses 0 J, so does every speed of it within the 1e-9 J that eps of
    1e5 J and more comes to.
    """
    given = {**ALONG_AND_ACROSS, **elastic, "energy_loss": loss}
    del given["speed_a"]
    with pytest.raises(
        col.NoSolutionError,
        match=r"many speeds along these courses lead to energy_loss = .* as far as rounding lets "
        r"it tell",
    ) as caught:
        speeds(A, B, **given, **known)
    assert caught.value.code == "undetermined"
    (found,) = open_in_a_batch(**{**given, **known, "energy_loss": np.array([loss, loss])})
    assert found.status.tolist() == [col.Status.UNDETERMINED] * 2


def open_in_a_batch(**given):
    """The answer of a batch, refused or not."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        return speeds(A, B, **given)


@pytest.mark.slow
def test_a_loss_within_rounding_tells_nothing_to_a_function():
    """A constant function of 1 leaves open what the number does."""
    given = {**ALONG_AND_ACROSS, "friction": 0.5, "law": "kudlich-slibar", "energy_loss": 5e-10}
    for restitution in (1.0, lambda g: 1.0):
        with pytest.raises(col.NoSolutionError) as caught:
            speeds(A, B, **given, restitution=restitution)
        assert caught.value.code == "undetermined"


def test_a_course_across_the_normal_leaves_its_speed_open():
    """Without friction that speed has no part in the impact: with another delta-V nothing fits,
    with its own everything.
    """
    given = {
        "course_a": 0.0,
        "course_b": "90 deg",
        "restitution": 0.1,
        "normal": 0.0,
        "point": (0.0, 0.4),
        "friction": 0.0,
    }
    own = col.eccentric(
        A.replace(vx=20.0), B.replace(vy=5.0), 0.1, normal=0.0, point=(0.0, 0.4), friction=0.0
    ).b.delta_v
    for delta_v, code in ((own, "undetermined"), (1.01 * own, "contradictory")):
        with pytest.raises(col.NoSolutionError) as caught:
            speeds(A, B, **given, speed_a=20.0, delta_v_b=delta_v)
        assert caught.value.code == code


@pytest.mark.slow
@pytest.mark.parametrize("short", [0.0, 1e-12, 1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("friction", [0.0, 0.5])
@pytest.mark.parametrize(
    "first", [{"speed_a": 20.0}, {"delta_v_a": 20.0}], ids=["speed_a", "delta_v_a"]
)
def test_every_root_loses_what_was_given(first, friction, law, short):
    """Single and in a batch: run forward, to 64 eps of the energies exchanged, and the same roots
    in both.
    """
    losses = [0.0, 1e-9, 1e-6, 1e-3, 1.0, 1e3]
    given = {**ALONG_AND_ACROSS, "restitution": 1.0 - short, "friction": friction, "law": law}
    del given["speed_a"]
    many = open_in_a_batch(**given, **first, energy_loss=np.array(losses))
    answered = 0
    for i, loss in enumerate(losses):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            alone, refusal = attempt(speeds, A, B, **given, **first, energy_loss=loss)
        here = [root.closing_speed[i] for root in many if np.isfinite(root.closing_speed[i])]
        if refusal is not None:
            assert here == []
            assert col.Status(int(many[0].status[i])).label == refusal.code
            continue
        # Beyond 1e5 m/s, and near grazing, a root holds to its condition times eps.
        close = [
            1e-12 * (1.0 + root.reconstruction.condition) * root.closing_speed for root in alone
        ]
        for root, one, within in zip(alone, here, close, strict=True):
            assert one == pytest.approx(root.closing_speed, abs=within)
            speed = root.a.before.speed + root.b.before.speed
            impulse = A.mass * root.a.delta_v
            lost = (short + friction) * impulse * speed
            assert abs(root.energy_loss - loss) <= 64 * 2.0**-52 * (
                lost + loss * (1.0 + root.reconstruction.condition * speed)
            )
            answered += 1
    # A delta-V without friction tells the closing speed, and so the loss.
    assert answered > 0 or friction == 0.0


@pytest.mark.slow
def test_a_loss_touching_its_least_is_found():
    """A share of the critical ratio with a restitution of 1 loses 0 J where sticking takes no
    tangential impulse, more to both sides.
    """
    given = {
        **ALONG_AND_ACROSS,
        "restitution": 1.0,
        "critical_fraction": 0.5,
        "law": "kudlich-slibar",
    }
    (found,) = speeds(A, B, **given, energy_loss=0.0)
    # The square root of eps of the speeds, where two roots meet.
    assert found.tangential_impulse == pytest.approx(0.0, abs=1e-6 * found.normal_impulse)
    assert found.energy_loss == pytest.approx(0.0, abs=1e-9)


# Batches, units and records


@pytest.mark.parametrize(
    ("known", "wrong"),
    [
        ({"speed_a": 20.0, "delta_v_b": np.array([7.0, -7.0])}, -1),
        ({"speed_a": 20.0, "delta_v_a": np.array([-7.0, 7.0])}, 0),
        ({"speed_a": np.array([20.0, -20.0]), "delta_v_b": 7.0}, -1),
        ({"speed_b": np.array([-10.0, 10.0]), "delta_v_b": 7.0}, 0),
        ({"speed_a": 20.0, "energy_loss": np.array([6e4, -6e4])}, -1),
        (
            {"speed_a": 20.0, "max_crush_speed_a": np.array([7.0, -7.0]), "max_crush_speed_b": 7.0},
            -1,
        ),
        (
            {"speed_a": 20.0, "max_crush_speed_a": 7.0, "max_crush_speed_b": np.array([-7.0, 7.0])},
            0,
        ),
    ],
    ids=[
        "delta_v_b",
        "delta_v_a",
        "speed_a",
        "speed_b",
        "energy_loss",
        "max_crush_speed_a",
        "max_crush_speed_b",
    ],
)
def test_negative_lanes_are_refused(known, wrong):
    """As contradictory, counted in one warning; the case beside it is answered as by itself."""
    given = {**COURSES, "restitution": 0.1, **CONTACT}
    right = {name: abs(float(np.ravel(value)[0])) for name, value in known.items()}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = speeds(A, B, **given, **known)
        alone = speeds(A, B, **given, **right)
    counted = [one.message for one in caught if one.category is col.CollisionsWarning]
    assert [one.fields["counts"] for one in counted] == [{"contradictory": 1}]
    case = 1 + wrong
    for root, single in zip(found, alone, strict=True):
        assert np.ravel(root.status)[wrong] == col.Status.CONTRADICTORY
        assert np.isnan(root.closing_speed[wrong])
        assert np.isnan(root.a.after.vx[wrong])
        assert np.isnan(root.reconstruction.condition[wrong])
        assert root.closing_speed[case] == pytest.approx(single.closing_speed, rel=1e-12)


@pytest.mark.slow
def test_a_batch_says_what_it_refused():
    """One warning for cases without any root, at the caller's line; none where every case has one,
    be it not two.
    """
    given = {**COURSES, "restitution": 0.1, **CONTACT}
    with pytest.warns(
        col.CollisionsWarning,
        match=r"1 of 2 cases .*\(1 contradictory\); asked alone, each says why",
    ) as caught:
        found = speeds(
            A, B, **given, delta_v_b=HIT.b.delta_v, energy_loss=np.array([HIT.energy_loss, 1e3])
        )
    assert len(found) == 2
    assert len(caught) == 1
    assert caught[0].filename == __file__
    with pytest.warns(col.CollisionsWarning, match=r"2 of 2 cases .*\(2 contradictory\)"):
        (found,) = speeds(A, B, **given, delta_v_b=HIT.b.delta_v, energy_loss=np.array([1e3, 2e3]))
    assert np.isnan(found.closing_speed).all()
    with pytest.warns(col.CollisionsWarning, match=r"1 of 2 cases .*\(1 infinite_mass\)"):
        (found,) = speeds(A, B.replace(mass=np.array([1300.0, math.inf])), **given, **KNOWN)
    assert found.status.tolist() == [col.Status.OK, col.Status.INFINITE_MASS]
    # Two roots in one case and one in the other: both have an answer, so nothing but the backward
    # one is said.
    stuck = {"normal": 0.0, "point": (0.0, 0.4), "critical_fraction": 1.0}
    with pytest.warns(col.OutOfRangeWarning, match="backwards") as caught:
        found = speeds(
            A,
            B,
            **COURSES,
            restitution=0.1,
            **stuck,
            speed_a=20.0,
            energy_loss=np.array([1.8e5, 3e5]),
        )
    assert len(caught) == 1
    assert [np.isfinite(root.closing_speed).tolist() for root in found] == [
        [True, True],
        [True, False],
    ]


# Roots of parabolas and quartics


def test_parabolas():
    """Against the roots they are made from; a double root, a line, and none at all."""
    rng = np.random.default_rng(4)
    one, other = np.sort(rng.uniform(-3.0, 3.0, (2, 50)), axis=0)
    low, high = parabola_roots([2.0 * (x - one) * (x - other) for x in (-1.5, 0.0, 1.5)], 1.5)
    assert low == pytest.approx(one, abs=1e-13)
    assert high == pytest.approx(other, abs=1e-13)
    with np.errstate(all="ignore"):
        assert [float(x) for x in parabola_roots([x * x for x in (-1.0, 0.0, 1.0)], 1.0)] == [
            0.0,
            0.0,
        ]
        assert [float(x) for x in parabola_roots([x - 0.5 for x in (-1.0, 0.0, 1.0)], 1.0)] == [
            0.5,
            0.5,
        ]
        assert np.isnan(parabola_roots([x * x + 1.0 for x in (-1.0, 0.0, 1.0)], 1.0)).all()


def test_quartics():
    """Against the roots they are made from; what is not real, not known or 0 everywhere is NaN and
    touches no neighbour.
    """
    rng = np.random.default_rng(4)
    made = np.sort(rng.uniform(-2.0, 2.0, (50, 4)), axis=1)
    apart = np.min(np.diff(made, axis=1), axis=1)
    values = [np.prod(2.0 * place - made, axis=1) for place in PLACES]
    found = np.sort(np.stack(quartic_roots(values, 2.0)), axis=0).T
    # A root moves by the rounding of the values over its derivative, the product of its distances.
    assert np.all(abs(found - made)[apart > 0.05] < 1e-9)
    with np.errstate(all="ignore"):
        cases = [
            np.array([place**4 - 1.0, place**4 + 1.0, 0.0, math.nan, math.inf, place**4 - 1.0])
            for place in PLACES
        ]
        answers = np.stack(quartic_roots(cases, 1.0))
    assert np.sum(np.isfinite(answers), axis=0).tolist() == [2, 0, 0, 0, 0, 2]
    assert np.nanmax(answers[:, 5]) == pytest.approx(1.0, abs=1e-12)


def test_a_share_of_the_critical_ratio_at_no_speed():
    """Zero, or nearly zero, of everything that is known leaves a quartic of zeros: refused, not an
    error of numpy.
    """
    given = {**COURSES, "restitution": 0.1, **CONTACT, "friction": None, "critical_fraction": 0.5}
    for known in (
        {"speed_a": 2.2e-313, "delta_v_b": 0.0},
        {"speed_b": 0.0, "delta_v_a": 0.0},
        {"delta_v_a": 0.0, "energy_loss": 0.0},
    ):
        with pytest.raises(col.NoSolutionError) as caught:
            speeds(A, B, **given, **known)
        assert caught.value.code == "contradictory"


@pytest.mark.slow
@pytest.mark.parametrize("rule", [{"friction": 0.5}, {"critical_fraction": 0.6}])
@pytest.mark.parametrize(
    "pair",
    [("speed_a", "delta_v_b"), ("speed_a", "energy_loss"), ("delta_v_a", "energy_loss")],
    ids="-".join,
)
def test_a_batch_is_as_its_cases(pair, rule):
    """Every case as alone, by rising closing speed; a NaN, or what fits nothing, leaves its
    neighbours untouched.
    """
    contact = {**{name: CONTACT[name] for name in ("normal", "point")}, **rule}
    impact = col.eccentric(HIT.a.before, HIT.b.before, 0.1, **contact)
    known = knowledge(impact, pair)
    factors = np.array([1.0, 1.02, np.nan, 1.05, 1e-6, 0.99])
    many = {name: (value * factors if name == pair[1] else value) for name, value in known.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        found = speeds(A, B, **COURSES, restitution=0.1, **contact, **many)
        for i, factor in enumerate(factors):
            here = [root.closing_speed[i] for root in found if np.isfinite(root.closing_speed[i])]
            assert here == sorted(here)
            if np.isnan(factor):
                assert here == []
                assert found[0].status[i] == col.Status.NOT_FINITE
                continue
            given = {
                **COURSES,
                "restitution": 0.1,
                **contact,
                **known,
                pair[1]: float(known[pair[1]] * factor),
            }
            alone, refusal = attempt(speeds, A, B, **given)
            if refusal is not None:
                assert here == []
                assert col.Status(int(found[0].status[i])).label == refusal.code
                continue
            assert here == pytest.approx([root.closing_speed for root in alone], rel=1e-9)
    assert np.sum(np.isfinite(found[0].closing_speed)) >= 3


@pytest.mark.slow
def test_a_contact_that_sticks_in_a_batch_of_shares_has_each_answer_once():
    """With a share of 1 among others, sticking and sliding with that share have the same roots."""
    for hit, courses, contact in forward_scenes(12, 10, ("critical_fraction",)):
        for other in ("crush", "delta_v_b", "energy_loss"):
            known = knowledge(hit, ("speed_a", other))
            alone, _ = attempt(
                solve_back, hit, courses, {**contact, "critical_fraction": 1.0}, **known
            )
            many, _ = attempt(
                solve_back,
                hit,
                courses,
                {**contact, "critical_fraction": np.array([0.3, 1.0])},
                **known,
            )
            assert sum(root.status[1] == 0 for root in many) == len(alone or ())


def test_units_single_precision_and_records():
    """Texts and Quantities are the same numbers; float32 stays float32; a record replays."""
    (found,) = speeds(A, B, **COURSES, restitution=0.1, **CONTACT, **KNOWN)
    assert off(found, HIT) < 1e-12
    delta_v = other_registry().Quantity(HIT.b.delta_v * 3.6, "km/h")
    degrees = {name: f"{math.degrees(value)!r} deg" for name, value in COURSES.items()}
    (same,) = speeds(
        A, B, **degrees, restitution=0.1, **CONTACT, speed_a="72 km/h", delta_v_b=delta_v
    )
    assert off(same, found) < 1e-12
    assert off(col.Impact.from_dict(found.to_dict()), found) == 0.0
    assert off(pickle.loads(pickle.dumps(found)), found) == 0.0
    assert found.reconstruction.known == ("speed_a", "delta_v_b")
    single = speeds(
        A, B, **COURSES, restitution=np.array([0.1, 0.2], dtype=np.float32), **CONTACT, **KNOWN
    )
    assert all(root.a.before.vx.dtype == np.float32 for root in single)


@pytest.mark.slow
@pytest.mark.parametrize("turned", [0.0, math.pi / 2, -math.pi / 2, 0.7])
@pytest.mark.parametrize("known", ["delta_v_a", "delta_v_b", "crush", "energy_loss"])
@pytest.mark.parametrize("law", LAWS)
def test_a_right_angle_in_radians(turned, known, law):
    """The cosine of pi/2 is 6e-17: no impact at 1e16 m/s is an answer, and none makes the right one
    doubtful.
    """
    c, s = math.cos(turned), math.sin(turned)

    def place(body, x, y):
        return body.replace(x=c * x - s * y, y=s * x + c * y)

    a, b = place(A, -2.0, 0.0), place(B, 2.0, 0.0)
    contact = {
        "restitution": 0.1,
        "normal": turned,
        "point": (-s * 0.4, c * 0.4),
        "friction": 0.5,
        "law": law,
    }
    courses = {"course_a": turned, "course_b": turned + math.pi / 2}
    hit = col.eccentric(a.replace(vx=10 * c, vy=10 * s), b.replace(vx=-3 * s, vy=3 * c), **contact)
    given = {"speed_a": 10.0}
    if known == "crush":
        given |= dict(
            zip(("max_crush_speed_a", "max_crush_speed_b"), hit.max_crush_speeds(0.5), strict=True)
        )
    else:
        given[known] = (
            hit.energy_loss if known == "energy_loss" else getattr(hit, known[-1]).delta_v
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = speeds(a, b, **courses, **given, **contact)
    impacts = found if isinstance(found, tuple) else (found,)
    assert max(one.b.before.speed for one in impacts) < 100.0
    # Through a quotient by the change of the observation, which is of the order of 1 here.
    assert min(abs(one.b.before.speed - 3.0) for one in impacts) < 1e-9


def test_a_batch_of_no_cases_has_no_answers():
    a = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, x=-2.0, y=0.4)
    b = col.Vehicle(mass=1200.0, yaw_inertia=1700.0, x=0.8, y=-1.2)
    known = {"course_a": 0.0, "course_b": 1.5, "speed_b": 8.0, "delta_v_a": np.array([])}
    found = col.reconstruct.speeds(
        a, b, restitution=0.1, normal=0.0, point=(0.0, 0.0), friction=0.5, **known
    )
    assert all(one.status.shape == one.a.delta_v.shape == (0,) for one in found)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("near", ["anywhere", "between sticking and sliding", "elastic"])
def test_no_answer_is_among_the_candidates_that_are_not_polished(near, monkeypatch):
    """The same answers to the last bit, or the same refusal, as with every candidate polished:
    alone and in a batch.
    """
    rng, cases = np.random.default_rng(4), []
    for impact, courses, contact in forward_scenes(11, 30, ("friction",)):
        e, bodies, pairs = impact.restitution, (impact.a.before, impact.b.before), PAIRS
        if near == "elastic":
            # The loss is rounding beside the energies before and after.
            e, contact, pairs = (
                1.0 - rng.integers(1, 9) * 2.0**-53,
                {**contact, "friction": 0.0},
                [pair for pair in PAIRS if "energy_loss" in pair],
            )
        elif near != "anywhere":
            stuck, _ = attempt(col.eccentric, *bodies, e, **{**contact, "friction": math.inf})
            ratio = abs(stuck.tangential_impulse / stuck.normal_impulse) if stuck else 0.0
            contact = {
                **contact,
                "friction": ratio
                * (1.0 + rng.choice((-1.0, 0.0, 1.0)) * 10.0 ** -rng.uniform(1, 16)),
            }
        hit = col.eccentric(*bodies, e, **contact)
        cases.append((hit, courses, contact, knowledge(hit, pairs[rng.integers(len(pairs))])))

    def answers():
        found = []
        for (hit, courses, contact, known), many in itertools.product(cases, (False, True)):
            given = (
                {name: np.array([value, value]) for name, value in known.items()} if many else known
            )
            roots, refusal = attempt(solve_back, hit, courses, contact, **given)
            speeds = [
                np.ravel((root.a.before.speed, root.b.before.speed, root.status)).tolist()
                for root in roots or ()
            ]
            found.append((speeds, str(refusal)))
        return str(found)

    some = answers()
    monkeypatch.setattr("collisions.reconstruct.speeds_algebra._UNPOLISHED", math.inf)
    assert answers() == some


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_a_function_of_restitution_loses_no_answer_beside_a_fold():
    """Two answers whose restitutions differ by 3e-4, both in the cell of the search in which the
    answers of that branch end: what B gains turns there, by a scan of B's speed.
    """
    a = col.Vehicle(mass=2808, yaw_inertia=3329, x=-2.245, y=-0.29, vx=19.44, vy=3.25)
    b = col.Vehicle(mass=1631, yaw_inertia=1841, x=1.554, y=-0.866)
    course = -1.716
    way = np.array([math.cos(course), math.sin(course)])
    contact = {"normal": -0.06, "point": (-0.047, -0.416), "friction": 0.209}

    def restitution(closing):
        return 0.5 * np.exp(-0.2 * closing)

    def gained(speed):
        moved = b.replace(vx=speed * way[0], vy=speed * way[1])
        closing = (a.vx - moved.vx) * math.cos(-0.06) + (a.vy - moved.vy) * math.sin(-0.06)
        return col.eccentric(a, moved, restitution(closing), **contact).b.delta_v

    scanned = np.linspace(-3.0, 4.0, 141)
    least = min(gained(one) for one in scanned)
    for more in (1e-4, 1e-3, 1e-2):
        known = least + more
        found = speeds(
            a,
            b,
            course_a=a.course,
            course_b=course,
            speed_a=a.speed,
            delta_v_b=known,
            restitution=restitution,
            **contact,
        )
        along = sorted(one.b.before.vx * way[0] + one.b.before.vy * way[1] for one in found)
        crossed = sum(
            (gained(low) - known) * (gained(high) - known) < 0.0
            for low, high in itertools.pairwise(scanned)
        )
        assert crossed == sum(-3.0 < one < 4.0 for one in along) == 2
        assert [gained(one) for one in along] == pytest.approx([known] * len(along), rel=1e-7)


@pytest.mark.parametrize("friction", [0.3, math.inf])
@pytest.mark.parametrize("known", [{"delta_v_a": 2.0}, {"delta_v_b": 2.0}])
def test_a_double_root_is_one_answer(friction, known):
    """The struck car stood: both roots are there, with an infinite condition."""
    a = col.Vehicle(mass=1000, yaw_inertia=1500, x=-2.0, y=0.0, heading=0.0)
    b = col.Vehicle(mass=1000, yaw_inertia=1500, x=2.0, y=0.0, heading=math.pi / 2)
    found = col.reconstruct.speeds(
        a,
        b,
        course_a=0.0,
        course_b="90 deg",
        restitution=0.0,
        normal=0.0,
        point=(0.0, 0.0),
        friction=friction,
        speed_a=4.0,
        **known,
    )
    assert len(found) == 1
    assert found[0].b.before.speed == pytest.approx(0.0, abs=1e-9)
