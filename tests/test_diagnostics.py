"""Findings: each made to appear and to vanish, its measure against a number worked out by hand, limits, and refusals."""

import math
import random
import re
import warnings

import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct, reference
from collisions.diagnostics import LIMITS, Finding, diagnose
from scenes import FAMILIES, LAWS, RULES, draw, solved

CAR = {"mass": 1500.0, "yaw_inertia": 2600.0, "heading": 0.0}
OTHER = {"mass": 1200.0, "yaw_inertia": 2100.0, "heading": math.pi / 2}


def square(a=None, b=None, restitution=0.1, **contact):
    """Two cars with nothing odd about them: A to the right, B to the left of the scene, through both centres, no friction."""
    a = col.Vehicle(**{**CAR, "vx": 20.0, "vy": 8.0, "x": -2.2, "y": 0.0, **(a or {})})
    b = col.Vehicle(**{**OTHER, "vx": 0.0, "vy": 8.0, "x": 0.9, "y": 0.0, **(b or {})})
    return col.eccentric(a, b, restitution, **{"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5, **contact})


def central(a=None, b=None, restitution=0.1, **contact):
    """The same by the central model."""
    a = col.Vehicle(**{**CAR, "vx": 20.0, "vy": 8.0, "x": -2.2, "y": 0.0, **(a or {})})
    b = col.Vehicle(**{**OTHER, "vx": 0.0, "vy": 8.0, "x": 0.9, "y": 0.0, **(b or {})})
    return col.oblique_central(a, b, restitution, **{"normal": 0.0, "friction": 0.5, **contact})


def of(code, impact, **options):
    """The findings of one code."""
    return [finding for finding in diagnose(impact, **options) if finding.code == code]


def test_nothing_is_said_of_an_ordinary_impact():
    """Not even with outlines."""
    assert diagnose(square()) == ()
    assert diagnose(square(), outline_a=(4.4, 1.8), outline_b=(4.4, 1.8)) == ()


def silent(make):
    """An impact whose energy gain was said when it was made."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.EnergyGainWarning)
        return make()


def planar(restitution):
    """Backwards from the end of a slide."""
    end = square(restitution=restitution, b={"vy": -8.0}, friction=0.1)
    contact = {"normal": 0.0, "point": (0.0, 0.0), "restitution": restitution, "friction": 0.1}
    return reconstruct.planar(end.a.after, end.b.after, **contact)


def least(yaw_rate, tolerance=9.0):
    """By solve, whose tolerance lets the linear model through while A turns."""
    a = col.Vehicle(**CAR, vx=20.0, x=-2.2, y=0.0, yaw_rate=yaw_rate)
    b = col.Vehicle(**OTHER, x=0.9, y=0.5)
    return col.solve(a, b, 0.0, normal=0.0, point=(0.0, 0.5), friction=0.0, tolerance=tolerance)


SLIDING = {"vy": -8.0}
RECTANGLES = {"outline_a": (4.4, 1.8), "outline_b": (4.4, 1.8)}
# By code: an impact that shows it and one that does not, with the arguments of diagnose.
CASES = {
    "energy_gain": (
        lambda: (silent(lambda: square(b=SLIDING, friction=None, impulse_ratio=-1.5)), {}),
        lambda: (square(b=SLIDING, friction=None, impulse_ratio=0.1), {}),
    ),
    "momentum_energy": (
        lambda: (square(a={"vx": 1e9 + 20.0}, b={"vx": 1e9}), {}),
        lambda: (square(a={"vx": 1e5 + 20.0}, b={"vx": 1e5}), {}),
    ),
    "restitution": (lambda: (square(restitution=0.31), {}), lambda: (square(restitution=0.29), {})),
    "impulse_ratio": (
        lambda: (square(b=SLIDING, friction=None, critical_fraction=1.0, restitution=0.0), {"limits": {"impulse_ratio": 0.99}}),
        lambda: (square(b=SLIDING, friction=None, critical_fraction=1.0, restitution=0.0), {}),
    ),
    "jamming": (
        lambda: (silent(lambda: square(a={"y": 2.5}, b={"vy": 28.0}, friction=None, impulse_ratio=-1.0)), {}),
        lambda: (silent(lambda: square(a={"y": 2.5}, b={"vy": 28.0}, friction=None, impulse_ratio=-0.5)), {}),
    ),
    "contact_points_approach": (lambda: (least(-1.0), {}), lambda: (least(1.0), {})),
    "outlines_interpenetrate": (
        lambda: (square(b={"y": -1.0}, a={"vy": 0.0}, friction=0.0, restitution=0.0), RECTANGLES),
        lambda: (square(restitution=0.1), RECTANGLES),
    ),
    "yaw_against_lever": (lambda: (square(b={"y": 0.1, "vy": -8.0}), {}), lambda: (square(b={"y": 0.1, "vy": 20.0}), {})),
    "impulse_off_normal": (
        lambda: (square(b={"vy": -60.0}, friction=1.1), {}),
        lambda: (square(b={"vy": -60.0}, friction=0.9), {}),
    ),
    "point_outside": (
        lambda: (square(), {"outline_a": (4.0, 1.8)}),
        lambda: (square(), {"outline_a": (4.3, 1.8)}),
    ),
    "near_collinear": (
        lambda: (square(b={"vx": -10.0, "vy": -2.5}, a={"vy": 8.0}), {}),
        lambda: (square(b={"vx": -10.0, "vy": -1.5}, a={"vy": 8.0}), {}),
    ),
    "ill_conditioned": (lambda: (planar(0.1), {}), lambda: (planar(0.2), {})),
    "tyre_impulse": (lambda: (square(a={"vx": 3.0}), {}), lambda: (square(a={"vx": 3.0}), {"duration": "10 ms"})),
    "model": (lambda: (central(a={"y": 1.0}), {}), lambda: (central(), {})),
    "law": (
        lambda: (square(b=SLIDING, restitution=0.3, friction=math.inf), {}),
        lambda: (square(b=SLIDING, restitution=0.0, friction=math.inf), {}),
    ),
    "normal": (
        lambda: (square(b=SLIDING, friction=0.1), {}),
        lambda: (square(b=SLIDING, friction=math.inf, law="kudlich-slibar"), {}),
    ),
    "friction_low": (lambda: (square(b=SLIDING, friction=0.29), {}), lambda: (square(friction=0.1), {})),
    "ratio_high": (
        lambda: (square(b={"vy": -60.0}, friction=2.0), {}),
        lambda: (square(b={"vy": -60.0}, friction=0.8), {}),
    ),
    "suspect_mass": (
        lambda: (square(a={"mass": 1.5, "yaw_inertia": 2.6}), {}),
        lambda: (square(a={"mass": 60.0, "yaw_inertia": 100.0}), {}),
    ),
    "suspect_heavy": (
        lambda: (square(b={"mass": 1e6, "yaw_inertia": 1e7}), {}),
        lambda: (square(b={"mass": math.inf, "yaw_inertia": math.inf, "vy": 0.0}), {}),
    ),
    "suspect_speed": (lambda: (square(a={"vx": 80.0}), {}), lambda: (square(a={"vx": 60.0}), {})),
    "suspect_yaw_rate": (lambda: (square(a={"yaw_rate": "25 rad/s"}), {}), lambda: (square(a={"yaw_rate": 15.0}), {})),
    "suspect_inertia_low": (lambda: (square(a={"yaw_inertia": 2.6}), {}), lambda: (square(a={"yaw_inertia": 260.0}), {})),
    "suspect_inertia_high": (
        lambda: (square(a={"yaw_inertia": 61700.0}), {}),
        lambda: (square(a={"yaw_inertia": math.inf}), {}),
    ),
    "suspect_lever": (lambda: (square(a={"x": -12.0}), {}), lambda: (square(a={"x": -9.0}), {})),
}


def test_every_code_has_its_case():
    """And every case a code."""
    assert list(CASES) == sorted(CASES, key=list(LIMITS).index)
    assert set(CASES) == set(LIMITS)


@pytest.mark.parametrize("code", LIMITS)
def test_every_finding_appears(code):
    """Beyond its limit, with all that it promises."""
    impact, options = CASES[code][0]()
    findings = of(code, impact, **options)
    assert findings
    for finding in findings:
        assert isinstance(finding, Finding)
        assert (finding.unit, finding.source) == (LIMITS[code].unit, LIMITS[code].source)
        below = finding.measured < finding.limit
        assert below == (code in ("near_collinear", "friction_low", "suspect_mass", "suspect_inertia_low"))
        assert finding.measured != finding.limit
        assert len(finding.sentence) > 30
        assert finding.vehicle in ("", "a", "b")
        assert {"energy_gain": 0.0}.get(code, finding.limit) >= 0.0


@pytest.mark.parametrize("code", LIMITS)
def test_every_finding_vanishes(code):
    """Where there is nothing to it."""
    impact, options = CASES[code][1]()
    assert of(code, impact, **options) == []


@pytest.mark.parametrize("code", LIMITS)
def test_every_limit_is_respected(code):
    """Just beyond what was measured nothing is found, just within it is; an infinite one (0 from below) switches it off."""
    impact, options = CASES[code][0]()
    found = of(code, impact, **options)
    (low, high) = (min(f.measured for f in found), max(f.measured for f in found))
    below = found[0].measured < found[0].limit
    off = 0.0 if below else math.inf
    assert of(code, impact, **{**options, "limits": {code: off}}) == []
    if math.isfinite(high):
        beyond, within = (low * 0.999, high * 1.001) if below else (high * 1.001, low * 0.999)
        assert of(code, impact, **{**options, "limits": {code: beyond}}) == []
        assert len(of(code, impact, **{**options, "limits": {code: within}})) >= len(found)
        assert all(f.limit == within for f in of(code, impact, **{**options, "limits": {code: within}}))


def test_findings_stand_in_the_order_of_the_table():
    """An energy gain first, the vehicles by letter."""
    impact, _ = CASES["energy_gain"][0]()
    findings = diagnose(impact)
    assert findings[0].code == "energy_gain"
    order = list(LIMITS)
    assert [f.code for f in findings] == sorted((f.code for f in findings), key=order.index)
    slow, _ = CASES["tyre_impulse"][0]()
    assert [f.vehicle for f in of("tyre_impulse", slow)] == ["a", "b"]
    assert diagnose(impact) == findings


# What is measured


def test_energy_and_momentum_by_hand():
    """The gain is that of the kinetic energies, to their rounding: 1e-15 of 1 MJ."""
    impact, _ = CASES["energy_gain"][0]()
    states = (impact.a.after.kinetic_energy + impact.b.after.kinetic_energy) - (
        impact.a.before.kinetic_energy + impact.b.before.kinetic_energy
    )
    (finding,) = of("energy_gain", impact)
    assert finding.measured == pytest.approx(states, rel=1e-12)
    impact, _ = CASES["momentum_energy"][0]()
    assert "kinetic energies before and after" in of("momentum_energy", impact)[0].sentence


def test_an_infinite_mass_that_moves_has_no_energy_to_compare():
    """A wall that comes along: nothing is measured but momentum."""
    b = {"mass": math.inf, "yaw_inertia": math.inf, "vx": -5.0, "vy": 0.0}
    assert of("momentum_energy", square(b=b)) == []


def test_restitution_is_held_against_the_reference():
    """0.4 is high at 20 m/s and at 5, not at 1.5 m/s."""
    for speed, found in ((20.0, True), (5.0, True), (1.5, False)):
        impact = square(a={"vx": speed}, restitution=0.4)
        findings = of("restitution", impact)
        assert bool(findings) == found
        if found:
            assert findings[0].limit == reference.restitution_range(speed)[1]
    assert of("restitution", square(restitution=0.8), limits={"restitution": 0.7})[0].limit == 0.7


def test_the_share_of_the_critical_ratio():
    """Twice the critical ratio is 2; against the slip it is infinite."""
    critical = square(b=SLIDING).critical_impulse_ratio
    (finding,) = of("impulse_ratio", square(b=SLIDING, friction=None, impulse_ratio=2.0 * critical))
    assert finding.measured == pytest.approx(2.0, rel=1e-12)
    (finding,) = of("impulse_ratio", square(b=SLIDING, friction=None, impulse_ratio=-0.2))
    assert finding.measured == math.inf
    assert "check its sign" in finding.sentence
    assert of("impulse_ratio", square(b=SLIDING, friction=math.inf)) == []
    # Without slip any ratio starts one.
    assert of("impulse_ratio", square(friction=None, impulse_ratio=0.2))[0].measured == math.inf


def test_jamming_is_the_share_of_the_ratio_that_jams():
    """By the matrix of the contact: K_nn + r K_nt = 0 at the ratio that jams; rounding of a few terms."""
    impact, options = CASES["jamming"][0]()
    a = impact.a.before
    lever, along = -(a.y), 2.2  # of the point from A: (2.2, -2.5)
    inertia_a = a.yaw_inertia
    k_nn = 1 / 1500 + 1 / 1200 + lever**2 / inertia_a
    k_nt = -lever * along / inertia_a
    (finding,) = of("jamming", impact, **options)
    assert finding.measured == pytest.approx(-impact.impulse_ratio * k_nt / k_nn, rel=1e-12)
    with pytest.raises(col.NoSolutionError) as jams:
        square(a={"y": 2.5}, friction=None, impulse_ratio=-1.001 * k_nn / k_nt)
    assert jams.value.code == "ratio_jams"


def test_contact_points_by_hand():
    """The centres end at one speed; A turns by -1 rad/s with a lever of 0.5 m."""
    (finding,) = of("contact_points_approach", least(-1.0))
    assert finding.measured == pytest.approx(0.5, rel=1e-12)


def test_outlines_that_run_into_each_other():
    """In line with restitution they part; slid along and turned, a corner comes in; a gap is none."""
    (finding,) = of("outlines_interpenetrate", *[CASES["outlines_interpenetrate"][0]()[0]], **RECTANGLES)
    assert "0.1 s after separation" in finding.sentence
    apart = {"outline_a": (3.0, 1.8), "outline_b": (3.0, 1.0)}
    assert of("outlines_interpenetrate", square(), **apart) == []
    # One outline alone can meet nothing.
    impact = CASES["outlines_interpenetrate"][0]()[0]
    assert of("outlines_interpenetrate", impact, outline_a=(4.4, 1.8)) == []


def test_yaw_against_the_lever_is_what_the_normal_alone_would_not_do():
    """Frictionless it turns the other way."""
    impact, _ = CASES["yaw_against_lever"][0]()
    (finding,) = of("yaw_against_lever", impact)
    assert finding.vehicle == "b"
    assert finding.measured == abs(impact.b.delta_yaw_rate)
    without = square(b={"y": 0.1, "vy": -8.0}, friction=0.0)
    assert without.b.delta_yaw_rate * impact.b.delta_yaw_rate < 0.0
    assert of("yaw_against_lever", without) == []


def test_a_pinned_body_turns_about_its_pivot():
    """Its lever is from there."""
    b = {"pivot": (0.9, -2.0), "vy": 0.0, "vx": 0.0}
    assert of("yaw_against_lever", square(b=b, friction=0.0)) == []
    assert diagnose(square(b=b), **RECTANGLES) is not None


def test_the_angle_between_impulse_and_normal():
    """The arc tangent of the ratio; with the PDOF and its convention where there is a heading."""
    impact, _ = CASES["impulse_off_normal"][0]()
    (finding,) = of("impulse_off_normal", impact)
    assert finding.measured == pytest.approx(math.atan(1.1), rel=1e-12)
    assert f"PDOF of {math.degrees(impact.a.pdof):.1f} degrees" in finding.sentence
    assert "positive clockwise" in finding.sentence
    assert finding.q.measured.to("degree").magnitude == pytest.approx(math.degrees(math.atan(1.1)), rel=1e-12)
    plain = square(a={"heading": None}, b={"heading": None, "vy": -60.0}, friction=1.1)
    assert "PDOF" not in of("impulse_off_normal", plain)[0].sentence


def test_near_collinear_is_head_on_too():
    """Ten degrees from either course, and ten themselves; a vehicle at rest has no course."""
    for speed, turn in ((15.0, 0.0), (-15.0, 180.0)):
        for off, found in ((9.9, True), (10.1, False)):
            course = math.radians(turn + off)
            b = {"vx": 15.0 * math.cos(course), "vy": 15.0 * math.sin(course)}
            findings = of("near_collinear", square(a={"vx": 20.0, "vy": 0.0}, b=b))
            assert bool(findings) == found, (speed, off)
            if found:
                assert findings[0].measured == pytest.approx(math.radians(off), rel=1e-9)
    assert of("near_collinear", square(a={"vy": 0.0}, b={"vy": 0.0})) == []
    line = square(a={"vx": 20.0, "vy": 0.0}, b={"vx": 5.0, "vy": 0.0})
    assert of("near_collinear", line)[0].measured == 0.0
    assert of("near_collinear", line, limits={"near_collinear": "0 deg"}) == []


def test_the_tyres_are_those_of_left_out():
    """The same share, for the duration and drag that were given."""
    slow, _ = CASES["tyre_impulse"][0]()
    left = col.left_out(slow, duration="80 ms", drag=0.5)
    found = of("tyre_impulse", slow, duration="80 ms", drag=0.5)
    assert [f.measured for f in found] == [left.a.tyre_share_bound, left.b.tyre_share_bound]


def test_a_model_of_which_nothing_is_known():
    """Infinite, and it says what is missing; without levers in either vehicle there is nothing to know."""
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=20.0), col.Vehicle(mass=1200.0), 0.1)
    (finding,) = of("model", impact)
    assert finding.measured == math.inf
    assert "a.yaw_inertia" in finding.sentence
    fixed = [col.Vehicle(mass=mass, vx=vx, yaw_inertia=math.inf) for mass, vx in ((1500.0, 20.0), (1200.0, 0.0))]
    assert of("model", col.linear_central(*fixed, 0.1)) == []


def test_the_error_of_a_model_is_that_of_required_model():
    """With the point that solve was given, relative to the smaller delta-V."""
    impact = least(0.0)
    assert impact.model == "linear_central"
    contact = {"normal": 0.0, "point": (0.0, 0.5), "friction": 0.0}
    choice = col.required_model(impact.a.before, impact.b.before, 0.0, **contact)
    smaller = min(impact.a.delta_v, impact.b.delta_v)
    assert of("model", impact)[0].measured == pytest.approx(choice.errors["linear_central"] / smaller, rel=1e-15)
    assert of("model", least(0.0, tolerance=0.0)) == []


def test_the_other_law_and_the_turned_normal_are_solved_again():
    """By the worse vehicle: magnitude of delta-V, and yaw times the radius of gyration."""
    impact, _ = CASES["law"][0]()
    other = square(b=SLIDING, restitution=0.3, friction=math.inf, law="kudlich-slibar")
    moved = []
    for one, two in ((impact.a, other.a), (impact.b, other.b)):
        radius = math.sqrt(one.before.yaw_inertia / one.before.mass)
        step = math.hypot(two.delta_v - one.delta_v, radius * (two.delta_yaw_rate - one.delta_yaw_rate))
        moved.append(step / one.delta_v)
    assert of("law", impact)[0].measured == pytest.approx(max(moved), rel=1e-12)
    assert "'kudlich-slibar' instead of 'brach'" in of("law", impact)[0].sentence


def test_no_answer_under_a_turned_normal_is_infinite():
    """Bodies that hardly close along the normal part when it is turned."""
    impact = square(a={"vx": 1.0, "vy": 20.0}, b={"vy": 0.0}, friction=0.3)
    (finding,) = of("normal", impact)
    assert finding.measured == math.inf
    assert "no answer" in finding.sentence


def test_a_reconstruction_is_diagnosed_as_the_impact_it_is():
    """With its condition."""
    impact = planar(0.1)
    (finding,) = of("ill_conditioned", impact)
    assert finding.measured == impact.reconstruction.condition
    assert "reconstruct.planar" in finding.sentence
    in_line = reconstruct.central("1100 kg", "950 kg", va="80 km/h", vb=0.0, vb_after="60 km/h")
    assert [f.code for f in diagnose(in_line)] == ["restitution", "model"]


@pytest.mark.parametrize("family", FAMILIES)
def test_extreme_scenes_are_diagnosed_too(family):
    """Every answer has findings that are whole, within the limits' order, whatever its size; nothing is refused."""
    rng = random.Random(f"diagnose {family}")
    answered = 0
    for _ in range(12):
        for law in LAWS:
            for rule in RULES:
                impact = solved("eccentric", draw(family, law, rule, rng), on_failure="nan")
                if impact.refused:
                    continue
                answered += 1
                for finding in diagnose(impact, **RECTANGLES):
                    assert not math.isnan(finding.measured)
                    assert finding.limit >= 0.0
                    assert "nan" not in finding.sentence
                gains = [finding.code for finding in diagnose(impact)][:1] == ["energy_gain"]
                assert gains == (not impact.ok)
    assert answered > 25


# Outlines


def test_outlines_may_be_given_in_any_form():
    """Length and width, with the centre of mass off the middle, or corners either way round; units, pint, numpy."""
    registry = pint.get_application_registry()
    corners = [(1.9, 0.9), (-2.1, 0.9), (-2.1, -0.9), (1.9, -0.9)]
    for outline in (
        (4.0, 1.8, 0.1),
        ("400 cm", 1.8, "10 cm"),
        corners,
        tuple(corners[::-1]),
        [("190 cm", 0.9), *corners[1:]],
        np.array(corners),
        registry.Quantity(np.array(corners) * 100.0, "cm"),
    ):
        (finding,) = of("point_outside", square(), outline_a=outline)
        # The point is 2.2 m ahead of A.
        assert finding.measured == pytest.approx(0.3, rel=1e-12)
    assert of("point_outside", square(), outline_a=[(2.3, 0.0), (-2.0, 0.9), (-2.0, -0.9)]) == []


def test_the_outline_turns_with_the_vehicle():
    """The side of B, which heads along y, is towards A."""
    assert of("point_outside", square(), outline_b=(4.4, 1.8)) == []
    (finding,) = of("point_outside", square(b={"heading": 0.0}), outline_b=(1.2, 4.4))
    assert finding.vehicle == "b"
    assert finding.measured == pytest.approx(0.3, rel=1e-12)


# Refusals


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        ({"impact": 3.0}, "not_an_impact", "impact must be an Impact, got float"),
        ({"impact": None}, "not_an_impact", "write diagnose(collisions.eccentric(...))"),
        ({"limits": {"nonsense": 1.0}}, "unknown_finding", "there is no finding 'nonsense'; known are energy_gain"),
        ({"limits": {3: 1.0}}, "unknown_finding", "there is no finding 3"),
        ({"limits": [("law", 1.0)]}, "bad_limit", "limits must be a dict"),
        ({"limits": {"law": -0.1}}, "bad_limit", "limits['law'] must be >= 0"),
        ({"limits": {"law": math.nan}}, "bad_limit", "limits['law'] must be >= 0"),
        ({"limits": {"law": "5 m"}}, "bad_units", "limits['law']"),
        ({"limits": {"near_collinear": "5 m"}}, "bad_units", "cannot be taken as rad"),
        ({"limits": {"law": np.ones(2)}}, "bad_shape", "limits['law'] takes one value"),
        ({"outline_a": 4.4}, "bad_shape", "outline_a must be (length, width)"),
        ({"outline_a": [4.4, 1.8]}, "bad_shape", "outline_a must be (length, width)"),
        ({"outline_a": (4.4,)}, "bad_shape", "at least three corners"),
        ({"outline_b": (4.4, np.ones(2))}, "bad_shape", "outline_b must be"),
        ({"outline_b": [(0.0, 1.0), (1.0, np.ones(2)), (2.0, 0.0)]}, "bad_shape", "outline_b must be"),
        ({"outline_a": (4.4, -1.8)}, "not_positive", "outline_a[1] (width) must be > 0"),
        ({"outline_a": (4.4, "1.8 kg")}, "bad_units", "outline_a[1] (width)"),
        ({"outline_a": (4.4, 1.8, 2.3)}, "bad_outline", "is not within a length of 4.4 m"),
        ({"outline_a": (math.inf, 1.8)}, "bad_outline", "both must be finite"),
        ({"outline_a": [(0.0, 1.0), (1.0, 0.0)]}, "bad_outline", "fewer than three corners"),
        ({"outline_a": [(0, 0), (1, 1), (2, 2)]}, "bad_outline", "has no area"),
        ({"outline_a": np.array([(0, 0), (1, 1), (np.nan, 2)])}, "bad_outline", "not finite"),
        ({"outline_a": [(2, 1), (0, 0.2), (-2, 1), (-2, -1), (2, -1)]}, "bad_outline", "has a dent"),
        ({"outline_a": [(2, 1), (-2, -1), (2, -1), (-2, 1)]}, "bad_outline", "sides that cross"),
        ({"outline_a": [(2, 1), (2, 1), (-2, 1), (-2, -1)]}, "bad_outline", "a corner twice"),
        ({"duration": -0.1}, "negative_duration", "duration must be >= 0"),
        ({"drag": "x"}, "bad_units", "drag"),
        ({"duration": np.array([0.1, 0.2])}, "bad_shape", "diagnose takes one case"),
    ],
)
def test_refusals(options, code, said):
    """Each names the argument and what to write."""
    options = {"impact": square(), **options}
    with pytest.raises(col.InputError, match=re.escape(said)) as caught:
        diagnose(options.pop("impact"), **options)
    assert caught.value.code == code


def test_a_star_that_goes_around_twice_is_no_outline():
    """Every corner turns left, and yet its sides cross."""
    star = [(math.cos(4 * math.pi * k / 5), math.sin(4 * math.pi * k / 5)) for k in range(5)]
    with pytest.raises(col.InputError, match="sides that cross"):
        diagnose(square(), outline_a=star)


def test_all_wrong_arguments_are_named_at_once():
    """One line each."""
    with pytest.raises(col.InputError, match="3 arguments cannot be used") as caught:
        diagnose(square(), outline_a=4.4, limits={"nonsense": 1.0, "law": -1.0})
    for name in ("outline_a", "nonsense", "law"):
        assert name in str(caught.value)


def test_a_batch_and_a_refused_case_are_refused():
    """With what to do instead."""
    with pytest.raises(
        col.ShapeError, match=re.escape("batch of shape (2,), and diagnose takes one case: ask the solver again")
    ):
        diagnose(square(a={"vx": np.array([20.0, 21.0])}))
    with pytest.raises(col.InputError, match="nothing to diagnose: the bodies move apart") as caught:
        diagnose(square(a={"vx": -20.0}, on_failure="nan"))
    assert caught.value.code == "refused_impact"


@pytest.mark.parametrize(("name", "code"), [("heading", "missing_heading")])
def test_an_outline_needs_to_be_placed(name, code):
    """The vehicle and the outline are named."""
    with pytest.raises(col.MissingInputError, match=f"a has no {name}, which outline_a needs") as caught:
        diagnose(square(a={name: None}), outline_a=(4.4, 1.8))
    assert caught.value.code == code
    with pytest.raises(col.MissingInputError, match="b has no x, which outline_b needs"):
        diagnose(square(b={"x": None, "y": None, "mass": math.inf, "yaw_inertia": math.inf, "vy": 0.0}), outline_b=(1.0, 1.0))


def test_no_warning_is_repeated():
    """What the solver said of an energy gain is not said again."""
    impact, _ = CASES["energy_gain"][0]()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        diagnose(impact)


@pytest.mark.parametrize("code", LIMITS)
def test_every_limit_says_where_it_is_from(code):
    """A source, or that it was set here and why."""
    limit = LIMITS[code]
    assert limit.source.startswith("set here: ") or re.search(r"EDCRASH|reference\.|paper|Coulomb", limit.source)
    assert re.search(r"above|below", limit.measured)
    assert (limit.default is None) == (code == "restitution")
