"""Stuck or slid, from components of delta-V: both branches, what decides, the family that begins
where the contact just stuck, and ranges that hold whichever it was.
"""

import json
import math
import pickle
import re
import warnings

import jsonschema
import numpy as np
import pytest

import collisions as col
from collisions import reconstruct, reference, reporting, uncertainty
from collisions.diagnostics import diagnose
from collisions.impact.reconstruction import side_of
from collisions.reconstruct import speeds
from collisions.travel import Tyres
from scenes import IN_POUNDS

MPH = 0.44704
A, B = IN_POUNDS
MET = {
    "course_a": "0 deg",
    "course_b": "90 deg",
    "restitution": 0.1,
    "normal": "0 deg",
    "point": ("0 ft", "0 ft"),
}


def crossing(speed_b=25.0, friction=0.45):
    """The crossing of the README at 30 mph, solved forward."""
    hit = {name: MET[name] for name in ("normal", "point")}
    a, b = A.replace(vx=30.0 * MPH, vy=0.0), B.replace(vx=0.0, vy=speed_b * MPH)
    return col.eccentric(a, b, 0.1, **hit, friction=friction)


def recorded(impact, labels="a"):
    return {
        f"delta_v_{part}_{label}": getattr(getattr(impact, label), f"delta_v_{part}")
        for label in labels
        for part in ("forward", "left")
    }


def back(labels="a", impact=None, **known):
    return speeds(A, B, **{**MET, **recorded(impact or crossing(), labels), **known})


def mph(impact):
    return [side.before.speed / MPH for side in (impact.a, impact.b)]


def codes(caught):
    return [warning.message.code for warning in caught]


@pytest.mark.parametrize("labels", ["a", "b", "ab"])
@pytest.mark.parametrize("friction", [math.inf, 0.6])
def test_neither_is_assumed(labels, friction):
    """The truth is 30 and 25 mph, slid at 0.45; a contact that stuck says 10.8. Both are offered,
    and that of the slid one is the end of what it may have been.
    """
    with pytest.raises(col.AmbiguousSolutionError, match="stuck or slid") as caught:
        back(labels, friction=friction)
    error = caught.value
    assert error.code == "ambiguous"
    for said in ("ratio of 0.45", "the speed of B is at least 10.8359 mph", "regime='sticking'",
                 "slid='bound'"):  # fmt: skip
        assert said in str(error)
    stuck, slid = error.solutions
    assert (stuck.regime, slid.regime) == ("sticking", "sliding")
    assert stuck.reconstruction.regime == "sticking"
    assert stuck.reconstruction.one_sided is None
    assert slid.reconstruction.one_sided == {"speed_a": 0, "speed_b": 1}
    assert slid.friction == pytest.approx(0.45, rel=1e-12)
    for found in (stuck, slid):
        assert mph(found) == pytest.approx([30.0, 10.836], abs=1e-3)
    assert mph(slid) == pytest.approx(mph(stuck), rel=1e-10)


@pytest.mark.slow
def test_a_stated_contact_is_taken_at_its_word_and_the_doubt_is_said():
    """From a ratio of 0.3 on, the least friction published between vehicles."""
    with pytest.warns(
        col.IllConditionedWarning, match=r"needs an impulse ratio of 0\.45"
    ) as caught:
        (stuck,) = back(friction=math.inf, regime="sticking")
    assert codes(caught) == ["may_slide"]
    assert "If it slid, the speed of B is at least 10.8359 mph" in str(caught[0].message)
    (finding,) = (one for one in diagnose(stuck, units="us") if one.code == "may_slide")
    assert finding.measured == pytest.approx(0.45, rel=1e-12)
    assert finding.limit == reference.INTER_VEHICLE_FRICTION.low == 0.3
    assert "if it slid, the speed of B is at least 10.8 mph" in finding.sentence
    assert "if it slid, the speed of B is at least" in col.report(stuck, form="markdown")
    # A contact that needs less of a ratio stuck without a word.
    gentle = crossing(-3.0, math.inf)
    assert abs(gentle.impulse_ratio) < 0.3
    (quiet,) = back(impact=gentle, course_b="-90 deg", friction=math.inf, regime="sticking")
    assert mph(quiet) == pytest.approx([30.0, 3.0], rel=1e-12)
    assert "may_slide" not in {one.code for one in diagnose(quiet)}


TYRES = {f"tyres_{label}": Tyres(0.7, 0.0, 2.7, 1.5) for label in "ab"} | {"duration": 0.1}


@pytest.mark.parametrize("lasting", [{}, pytest.param(TYRES, marks=pytest.mark.slow)])
@pytest.mark.parametrize("beside", ["energy_loss", "ees_a", "speed_a", "speed_b"])
def test_the_doubt_is_said_whatever_else_is_known(beside, lasting):
    """That it stuck is stated, and beside it an energy or a speed of the contact that slid is
    known, or of one that stuck: in a single case, in a batch and in a study.
    """
    slid = crossing()
    of = {
        "energy_loss": slid.energy_loss,
        "ees_a": (0.5 * slid.energy_loss / A.mass * 2.0) ** 0.5,
        "speed_a": 29.0 * MPH,
        "speed_b": 11.0 * MPH,
    }[beside]
    known = {beside: of, "friction": math.inf, "regime": "sticking", **lasting}
    if beside == "ees_a":
        known["ees_b"] = (0.5 * slid.energy_loss / B.mass * 2.0) ** 0.5

    def told(solve):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            return solve(), {one.message.code: str(one.message) for one in caught}

    (stuck,), said = told(lambda: back(**known))
    assert stuck.regime == "sticking"
    assert re.search(r"If it slid, .*(at least|not the impact)", said["may_slide"])
    (finding,) = (one for one in diagnose(stuck) if one.code == "may_slide")
    assert re.search(r"; if it slid, .*(at least|not the impact)", finding.sentence)
    _, said = told(lambda: back(**known | {beside: np.array([of, 1.001 * of])}))
    assert "2 cases" in said["may_slide"] or "2 of 2" in said["may_slide"]
    study, said = told(
        lambda: uncertainty.propagate(
            lambda value: {"speed": back(**known | {beside: value})[0].b.before.speed},
            {"value": uncertainty.Normal(of, 0.001 * of)},
            samples=64,
            seed=1,
        )
    )
    assert "may_slide" in said
    (text,) = (one for one in study.statements if "taken to stick" in one)
    assert "slid='bound'" not in text  # it is not taken beside these
    assert ("one end of a family" in text) == (not beside.startswith("speed"))


@pytest.mark.slow
def test_what_differs_from_components_is_named():
    """The components alone agree: it is the energy that does not."""
    with pytest.warns(col.IllConditionedWarning, match="energy_loss and delta_v_forward_a"):
        (found,) = back(friction=math.inf, energy_loss=0.7 * back(
            friction=math.inf, slid="bound")[0].energy_loss)  # fmt: skip
    (finding,) = (one for one in diagnose(found) if one.code == "components_differ")
    assert "the energy" in finding.sentence
    assert "the delta-V forward of A" in finding.sentence


@pytest.mark.slow
@pytest.mark.parametrize("friction", [math.inf, 1.0, 0.6, 0.5, 0.45, 0.3])
def test_no_friction_says_10_8_mph_in_silence(friction):
    """Whatever friction is given: refused, or a warning, or a bound that the truth keeps."""
    if friction == 1.0:  # more than twice the ratio
        with pytest.warns(col.IllConditionedWarning, match="If it slid, the speed of B is"):
            back(friction=friction)
    else:
        with pytest.raises(col.NoSolutionError) as refused:
            back(friction=friction)
        assert refused.value.code in ("ambiguous", "undetermined")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        (bound,) = back(friction=friction, slid="bound")
    assert bound.reconstruction.one_sided == {"speed_a": 0, "speed_b": 1}
    assert mph(bound)[1] < 25.0


@pytest.mark.slow
def test_what_settles_it():
    """A speed, if it is one that the slip shows in; a friction that is less than the ratio, or more
    than twice it.
    """
    # The speed of B is not that of a contact that stuck, so it slid at the ratio of the components.
    (found,) = back(friction=math.inf, speed_b="25 mph")
    assert mph(found) == pytest.approx([30.0, 25.0], rel=1e-12)
    assert (found.regime, found.friction) == ("sliding", pytest.approx(0.45, rel=1e-12))
    # One that is settles the other way: no doubt is said, though the ratio is above 0.3.
    stuck = crossing(10.0, math.inf)
    assert abs(stuck.impulse_ratio) > 0.3
    (found,) = back(impact=stuck, friction=math.inf, speed_b="10 mph")
    assert mph(found) == pytest.approx([30.0, 10.0], rel=1e-12)
    # The speed of A is the same at every slip.
    with pytest.raises(col.AmbiguousSolutionError):
        back(friction=math.inf, speed_a="30 mph")
    with pytest.raises(col.NoSolutionError, match="give the speed of the other vehicle"):
        back(friction=0.45, speed_a="30 mph")
    (bound,) = back(friction=0.45, speed_a="30 mph", slid="bound")
    assert bound.reconstruction.one_sided == {"speed_a": 0, "speed_b": 1}
    # Stated to have slid, with friction or at the ratio shown.
    for friction in (0.45, math.inf):
        (found,) = back(friction=friction, speed_b="25 mph", regime="sliding")
        assert mph(found) == pytest.approx([30.0, 25.0], rel=1e-12)
        with pytest.raises(col.NoSolutionError, match="or write slid='bound'") as caught:
            back(friction=friction, regime="sliding")
        assert caught.value.code == "undetermined"
    with pytest.raises(col.NoSolutionError, match=r"ratio of 0\.45, and friction=0\.3") as caught:
        back(friction=0.3, regime="sticking")
    assert caught.value.code == "contradictory"
    # Less than half of the friction; of the least published where there is none.
    gentle = crossing(-10.0, math.inf)
    assert 0.0 < abs(gentle.impulse_ratio) < 0.15
    given = {"impact": gentle, "course_b": "-90 deg"}
    for friction in (math.inf, 0.3):
        (found,) = back(**given, friction=friction)
        assert mph(found) == pytest.approx([30.0, 10.0], rel=1e-12)
        (found,) = back(**given, friction=friction, slid="bound")
        assert found.reconstruction.one_sided == {"speed_a": 0, "speed_b": 0}


@pytest.mark.slow
def test_an_energy_settles_it():
    """What sliding costs beyond the loss of a contact that stuck tells how far it slid: from
    energies of the forward solver, and of both EES.
    """
    stuck = crossing(10.0, math.inf)
    for friction in (math.inf, 0.45):
        for true in (11.0, 15.0, 25.0, 40.0):
            slid = crossing(true)
            assert slid.regime == "sliding"
            ees_a, ees_b = slid.ees(0.4)
            for known in ({"energy_loss": slid.energy_loss}, {"ees_a": ees_a, "ees_b": ees_b}):
                (found,) = back(friction=friction, **known)
                assert mph(found) == pytest.approx([30.0, true], rel=1e-9)
                assert found.friction == pytest.approx(0.45, rel=1e-12)
                assert found.regime == "sliding"
        # A contact that stuck, which would be in doubt: its energy is less than that of any slide.
        (found,) = back(impact=stuck, friction=math.inf, energy_loss=0.95 * stuck.energy_loss)
        assert mph(found) == pytest.approx([30.0, 10.0], rel=1e-12)
        assert "may_slide" not in {one.code for one in diagnose(found)}
    (found,) = back(friction=math.inf, energy_loss=crossing().energy_loss, slid="bound")
    assert found.reconstruction.one_sided == {"speed_a": 0, "speed_b": 0}
    with pytest.raises(col.NoSolutionError, match="fit energy_loss = 7786") as caught:
        back(friction=math.inf, energy_loss=0.2 * stuck.energy_loss)
    assert caught.value.code == "contradictory"
    with pytest.warns(col.IllConditionedWarning) as said:
        back(friction=math.inf, energy_loss=crossing().energy_loss, regime="sticking")
    assert sorted(codes(said)) == ["may_slide", "recorders_differ"]
    (differ,) = (str(one.message) for one in said if one.message.code == "recorders_differ")
    assert "energy_loss and delta_v_forward_a" in differ
    losses = np.array([crossing().energy_loss, crossing(15.0).energy_loss, 1.0])
    with pytest.warns(col.CollisionsWarning, match="1 of 3"):
        (many,) = back(friction=math.inf, energy_loss=losses)
    assert many.b.before.speed[:2] / MPH == pytest.approx([25.0, 15.0], rel=1e-9)
    assert many.refused.tolist() == [False, False, True]
    # One percent of the energy moves the speeds by as much as the condition has it.
    (more,) = back(friction=math.inf, energy_loss=1.01 * slid.energy_loss)
    (true,) = back(friction=math.inf, energy_loss=slid.energy_loss)
    moved = max(abs(a - b) for a, b in zip(mph(more), mph(true), strict=True)) * MPH
    assert moved < 0.01 * true.reconstruction.condition * true.closing_speed


@pytest.mark.slow
def test_sides_are_those_of_what_is_open():
    """With a speed that settles it, asked for a bound or not: nothing is one-sided."""
    rng = np.random.default_rng(9)
    for _ in range(10):
        cars, both, known, friction, impact = slid_at_random(rng)
        given = {**known, **recorded(impact), "speed_b": both[1], "friction": friction}
        bodies = [col.Vehicle(**car) for car in cars]
        (found,) = speeds(*bodies, **given, slid="bound")
        (same,) = speeds(*bodies, **given)
        assert found == same
        assert found.reconstruction.one_sided == {"speed_a": 0, "speed_b": 0}


def test_a_friction_far_from_the_ratio_has_a_bound_and_is_warned_of():
    """Projected on the friction, the impulse is shorter: least squares by hand."""
    with pytest.warns(col.IllConditionedWarning, match=r"friction=0\.3 differs") as caught:
        (found,) = back(friction=0.3, slid="bound")
    assert codes(caught) == ["friction_differs"]
    assert caught[0].message.fields["value"] == pytest.approx(
        math.sin(math.atan(0.45) - math.atan(0.3)) / math.cos(math.atan(0.45) - math.atan(0.3)),
        rel=1e-9,
    )
    true = crossing()
    along = (true.normal_impulse - 0.3 * true.tangential_impulse) / (1.0 + 0.3**2)
    assert found.normal_impulse == pytest.approx(along, rel=1e-9)


@pytest.mark.slow
def test_a_friction_that_differs_is_counted_in_batches_and_studies_too():
    """As recorders that differ are: where hardly any sample agrees, something is wrong; where many
    do, the stated errors are enough to say why.
    """
    with pytest.warns(col.IllConditionedWarning, match=r"^1 of 3 cases: a contact that") as caught:
        back(friction=np.array([0.45, 0.3, 0.44]), slid="bound")
    assert codes(caught) == ["friction_differs"]

    def told(friction):
        def model(friction):
            (found,) = back(friction=friction, slid="bound")
            return {"b": found.b.before.speed}

        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", col.CollisionsWarning)
            found = uncertainty.propagate(model, {"friction": friction}, samples=256, seed=2)
        said = [one for one in found.statements if "a contact that slides with" in one]
        codes = [one.message.code for one in caught]
        # The model hands a bound on as a value, in all samples.
        assert codes.count("bound_as_value") == 1
        return said, [code for code in codes if code != "bound_as_value"]

    # The ratio is 0.45, and 10 percent less than it, across the impulse, is a friction of 0.335.
    said, raised = told(uncertainty.Uniform(0.25, 0.33))
    assert said[0].startswith("256 of 256 cases")
    assert raised == ["friction_differs"]
    said, raised = told(uncertainty.Uniform(0.3, 0.45))
    assert said
    assert raised == []


@pytest.mark.slow
def test_the_finding_and_the_derivation_say_what_the_call_warns_of():
    """Also read from a record, and with recorders away from the centres of mass."""
    with pytest.warns(col.IllConditionedWarning) as caught:
        (found,) = back(friction=0.3, slid="bound")
    share = caught[0].message.fields["value"]
    for one in (found, col.Impact.from_dict(found.to_dict())):
        findings = {each.code: each for each in col.diagnose(one)}
        assert findings["components_differ"].measured == pytest.approx(share, rel=1e-9)
        assert "the friction, one of them, a course" in findings["components_differ"].sentence
        assert findings["one_sided"].measured == 1.0
        assert "by 13 percent of the impulse" in str(col.explain(one))
        page = str(col.report(one, form="markdown", figures=False))
        answer = page.partition("## Inputs")[0]
        assert re.search(r"A: speed before:\*\* \d", answer)
        assert re.search(r"B: speed before:\*\* at least \d", answer)
        assert re.search(r"Energy lost:\*\* at least \d", answer)
        assert "with the least slip" in page.partition("## Results")[2].partition("## ")[0]
        assert "13 percent" in answer
    assert "in this answer" in str(col.explain(found))


def test_more_slip_changes_what_is_open_and_nothing_else():
    """Two members of a family: both cars faster along their courses, closing as before."""
    a = {"mass": 1500.0, "yaw_inertia": 2500.0, "x": -2.0, "y": 0.0, "heading": 0.0}
    b = {"mass": 1300.0, "yaw_inertia": 2200.0, "x": 2.0, "y": 0.2, "heading": 1.2}

    def hit(more):
        cars = (
            col.Vehicle.from_speed(**a, speed=23.0 + more * math.cos(1.2), course=0.0),
            col.Vehicle.from_speed(**b, speed=33.0 + more, course=1.2),
        )
        found = col.eccentric(*cars, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.15)
        assert found.regime == "sliding"
        return {name: value[0] for name, value in found.to_columns().items()}

    one, other = hit(0.0), hit(1.0)
    open_ = reconstruct.Reconstruction(
        method="speeds", known=(), condition=1.0, one_sided={"speed_a": 1, "speed_b": 1}
    )
    for name, value in one.items():
        if not isinstance(value, float) or name.startswith("reconstruction"):
            continue
        change = other[name] - value
        side = side_of(open_, name)
        if side == 0:
            assert change == pytest.approx(0.0, abs=1e-9 * max(1.0, abs(value))), name
        elif side is not None:
            assert change > 0.0, name


def slid_at_random(rng):
    """A contact that slides, of random cars; its speeds and what is known of it."""
    while True:
        friction = rng.uniform(0.2, 0.7)
        known = {
            "course_a": rng.uniform(-0.3, 0.3),
            "course_b": rng.uniform(0.8, 2.4),
            "restitution": rng.uniform(0.0, 0.3),
            "normal": rng.uniform(-0.5, 0.5),
            "point": (0.0, rng.uniform(-0.6, 0.6)),
            "law": ("brach", "kudlich-slibar")[rng.integers(2)],
        }
        cars = [
            {
                "mass": rng.uniform(900.0, 2500.0),
                "yaw_inertia": rng.uniform(1200.0, 4000.0),
                "x": x,
                "y": rng.uniform(-1.0, 1.0),
                "heading": rng.uniform(-3.0, 3.0),
                "yaw_rate": rng.uniform(-0.5, 0.5),
            }
            for x in (-2.0, 1.5)
        ]
        both = rng.uniform(5.0, 25.0, 2)
        impact = solved(cars, both, known, friction)
        if impact is not None and impact.regime == "sliding":
            return cars, both, known, friction, impact


def solved(cars, both, known, friction):
    ways = [known[f"course_{label}"] for label in "ab"]
    bodies = [
        col.Vehicle(vx=speed * math.cos(way), vy=speed * math.sin(way), **car)
        for way, speed, car in zip(ways, both, cars, strict=True)
    ]
    hit = {name: known[name] for name in ("normal", "point", "law")}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", col.EnergyGainWarning)
            return col.eccentric(*bodies, known["restitution"], **hit, friction=friction)
    except (col.CollisionsError, col.EnergyGainWarning):
        return None


@pytest.mark.slow
def test_the_family_begins_at_the_bound():
    """Against the forward solver: beyond the bound, on the side that is named, every pair of speeds
    gives the same components; before it none does, or a car goes backwards. The true speeds lie on
    that side.
    """
    rng = np.random.default_rng(8)
    for _ in range(40):
        cars, both, known, friction, impact = slid_at_random(rng)
        bodies = [col.Vehicle(**car) for car in cars]
        given = {**known, **recorded(impact)}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            (end,) = speeds(*bodies, **given, friction=friction, slid="bound", regime="sliding")
        start = np.array([signed(end, label, known) for label in "ab"])
        sides = end.reconstruction.one_sided
        for side, way in zip(("speed_a", "speed_b"), both - start, strict=True):
            assert sides[side] == np.sign(way) or abs(way) < 1e-8, (sides, both, start)
        for share, same in ((0.5, True), (1.5, True), (-0.02, False)):
            if share < 0.0 and min(start) == 0.0:
                assert min(start + share * (both - start)) < 0.0
                continue
            there = solved(cars, start + share * (both - start), known, friction)
            if there is None:  # no closing speed there, or with a speed below 0 a gain of energy
                continue
            moved = abs(np.subtract(*(list(recorded(i).values()) for i in (there, impact)))).max()
            assert (moved < 1e-9) == same, (share, moved)


def signed(impact, label, known):
    before, course = getattr(impact, label).before, known[f"course_{label}"]
    return before.vx * math.cos(course) + before.vy * math.sin(course)


@pytest.mark.slow
def test_a_batch_is_its_cases():
    """As one by one, with the sides of each; those that stay open are NaN, and said to be."""
    friction = np.array([0.3, 0.45, 0.6, 1.0, 0.0])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        (many,) = back(friction=friction, slid="bound")
        for i, one in enumerate(friction[:4]):
            (alone,) = back(friction=one, slid="bound")
            assert many.b.before.speed[i] == pytest.approx(alone.b.before.speed, rel=1e-12)
            assert many.case(i).reconstruction.one_sided == alone.reconstruction.one_sided
    # Without friction nothing tells of the slip, not even a bound.
    assert many.refused.tolist() == [False] * 4 + [True]
    assert many.reconstruction.one_sided["speed_b"].tolist() == [1, 1, 1, 1, 0]
    with pytest.warns(col.CollisionsWarning) as caught:
        (left,) = back(friction=np.array([0.3, 0.45, 0.6]))
    assert {"refused_cases", "stuck_or_slid"} <= set(codes(caught))
    assert [col.Status(int(code)).label for code in left.status] == [
        "undetermined", "undetermined", "ambiguous"
    ]  # fmt: skip
    assert left.reconstruction.answers.tolist() == [0, 0, 2]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("friction", "more"),
    [
        (0.4, {"slid": "bound"}),
        (np.array([0.4, 0.45]), {"slid": "bound"}),
        (math.inf, {"speed_b": 6.0}),
    ],
)
def test_a_case_that_stuck_has_the_friction_that_was_given(friction, more):
    """Beside one that slid at a ratio that the components show."""
    a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.0, y=0.3, heading=0.0)
    b = col.Vehicle(mass=1300, yaw_inertia=2100, x=1.5, y=-0.585, heading=1.4)
    met = {"restitution": 0.1, "normal": 0.15826, "point": (0.0, 0.0)}
    courses = {"course_a": 0.0, "course_b": 1.2364}
    components = {
        "delta_v_forward_a": np.array([-5.84322, -5.78948]),
        "delta_v_left_a": np.array([0.50421, 0.91524]),
    }
    if "speed_b" in more:
        # Within two percent of what a contact that slides at 0.2 shows, and one that sticks.
        components = {
            "delta_v_forward_a": np.array([-6.406, -7.95]),
            "delta_v_left_a": np.array([0.253, 2.186]),
        }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        (many,) = speeds(a, b, **courses, **met, **components, friction=friction, **more)
        slid, stuck = many.case(0), many.case(1)
    assert (slid.regime, stuck.regime) == ("sliding", "sticking")
    given = float(np.broadcast_to(friction, 2)[1])
    assert slid.friction == pytest.approx(abs(slid.impulse_ratio), rel=1e-9)
    assert "friction" in slid.reconstruction.found
    assert stuck.friction == given
    assert "friction" not in {*stuck.reconstruction.found, *stuck.reconstruction.given}
    assert "friction" not in stuck.to_dict()["results"]["reconstruction"]["found"]
    report = col.report(stuck, form="markdown", figures=False)
    reporting.replay(report)
    for page in (col.explain(stuck, form="text"), report):
        (line,) = (row for row in page.splitlines() if "friction (bound" in row)
        assert "found" not in line
    rows = col.explain(slid, form="text").splitlines()
    assert "found" in next(row for row in rows if "friction (bound" in row)


@pytest.mark.slow
@pytest.mark.parametrize(
    "known",
    [
        {"friction": 0.45, "slid": "bound"},
        {"friction": math.inf, "slid": "bound"},
        {"friction": math.inf, "slid": "bound", "regime": "sliding"},
        {"friction": math.inf, "regime": "sticking"},
        {"friction": math.inf, "speed_b": "25 mph"},
        {"friction": math.inf, "energy_loss": "60 kJ"},
        {"friction": np.array([0.3, 0.45]), "slid": "bound"},
    ],
    ids=str,
)
def test_records_reports_and_explanations(known):
    """What was stated, and the sides, are written down, told, and read back."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.IllConditionedWarning)
        (found,) = back(**known)
    record = json.loads(json.dumps(found.to_dict()))
    jsonschema.validate(record, col.impact_schema())
    for again in (col.Impact.from_dict(record), pickle.loads(pickle.dumps(found))):
        assert again == found
        assert again.reconstruction == found.reconstruction
    for name, value in (("regime", "loose"), ("one_sided", {"speed_a": 2, "speed_b": 0}),
                        ("one_sided", [1, 0])):  # fmt: skip
        spoilt = json.loads(json.dumps(record))
        spoilt["results"]["reconstruction"][name] = value
        with pytest.raises(col.InputError, match="record is not"):
            col.Impact.from_dict(spoilt)
    one_sided = "slid" in known
    columns = found.to_columns()
    assert ("reconstruction.one_sided.speed_b" in columns) == one_sided
    table = str(found.summary())
    assert ("known from one side" in table or "at least" in table) == one_sided
    if np.ndim(known["friction"]):
        return
    page = col.report(found, form="markdown")
    assert reporting.replay(page) == found
    for text in (page, col.explain(found, form="text")):
        assert ("speed of B is at least" in text.replace("if it slid, the s", "")) == one_sided
        assert ("was stated" in text) == ("regime" in known)
    # A side that its inputs do not have is noticed.
    if one_sided:
        changed = page.replace('"speed_b": 1', '"speed_b": -1')
        assert changed != page
        with pytest.raises(col.CollisionsError, match="leave the speeds known by"):
            reporting.replay(changed)


REFUSALS = [
    ("bad_option", {"regime": "stuck"}, "regime must be 'sticking' or 'sliding', or None"),
    ("bad_option", {"slid": True}, "slid must be 'bound', or None"),
    ("bad_option", {"slid": np.array(["bound"])}, "slid must be 'bound', or None"),
    ("bad_combination", {"regime": "sticking", "slid": "bound"}, "leave out one of them"),
    ("bad_combination", {"friction": None, "impulse_ratio": 0.3, "slid": "bound"},
        "is for components of delta-V with friction"),
    ("bad_combination", {"delta_v_forward_a": None, "delta_v_left_a": None, "delta_v_a": 5.0,
        "speed_b": 3.0, "regime": "sliding"}, "is for components of delta-V with friction"),
]  # fmt: skip


@pytest.mark.parametrize(("code", "changed", "said"), REFUSALS)
def test_refusals(code, changed, said):
    """What is not among the choices, or goes with nothing that was given."""
    given = {**MET, **recorded(crossing()), "friction": 0.45, **changed}
    with pytest.raises(col.InputError, match=said) as caught:
        speeds(A, B, **given)
    assert caught.value.code == code


def crossed(rng):
    """A crash of two cars, friction and restitution from what is known of them; what is read of it
    with errors, as inputs.
    """
    read = {"normal": 0.07, "x": 0.1, "y": 0.1, "course_a": 0.035, "course_b": 0.035}
    while True:
        true = {
            "normal": rng.uniform(-0.45, 0.45), "x": 0.0, "y": rng.uniform(-0.6, 0.6),
            "course_a": 0.0, "course_b": rng.uniform(0.9, 2.2),
        }  # fmt: skip
        known = {
            **{name: true[name] for name in ("normal", "course_a", "course_b")},
            "point": (true["x"], true["y"]),
            "restitution": float(np.clip(rng.normal(0.12, 0.06), 0.0, 0.4)),
            "law": "brach",
        }
        cars = [
            {"mass": (mass := rng.uniform(1100.0, 2000.0)),
             "yaw_inertia": mass * rng.uniform(1.5, 1.9),
             "x": x, "y": y, "heading": heading}
            for x, y, heading in (
                (-2.0, rng.uniform(-0.5, 0.5), 0.0), (1.2, rng.uniform(-1.5, 1.5), 1.5)
            )
        ]  # fmt: skip
        both = rng.uniform(8.0, 20.0, 2)
        impact = solved(cars, both, known, float(np.clip(rng.normal(0.45, 0.08), 0.2, 0.8)))
        if impact is None or impact.closing_speed < 4.0:
            continue
        inputs = {
            name: uncertainty.Normal(rng.normal(true[name], error), error)
            for name, error in read.items()
        }
        inputs["restitution"] = uncertainty.Normal(0.12, 0.06, truncate=(0.0, 0.4))
        for name, value in recorded(impact).items():
            shown = value * rng.uniform(0.9, 1.1)
            inputs[name] = uncertainty.Uniform(*sorted((shown / 1.1, shown / 0.9)))
        return [col.Vehicle(**car) for car in cars], both, inputs, impact.regime


@pytest.mark.slow
@pytest.mark.parametrize("route", ["known", "published", "not known", "stated"])
def test_silent_ranges_hold_whether_it_stuck_or_slid(route):
    """Instant crashes, stuck and slid, with the errors that an analyst and a recorder make: stated
    95 % ranges that come without a warning, one-sided ones included, hold.
    """
    rng, count = np.random.default_rng(11), 60
    held = {"sticking": [], "sliding": []}
    ranged, warned = 0, {"sticking": 0, "sliding": 0}
    frictions = {
        "known": uncertainty.Normal(0.45, 0.08, truncate=(0.2, 0.8)),
        "published": uncertainty.Uniform(0.3, 1.0),
    }
    options = {"regime": "sticking"} if route == "stated" else {"slid": "bound"}
    for number in range(count):
        bodies, both, inputs, regime = crossed(rng)
        inputs["friction"] = frictions.get(route, math.inf)

        def model(x, y, bodies=bodies, **given):
            (found,) = speeds(*bodies, point=(x, y), **given, **options)
            sides = found.reconstruction.one_sided or dict.fromkeys(("speed_a", "speed_b"), 0)
            return {
                name: uncertainty.OneSided(getattr(found, name[-1]).before.speed, side)
                for name, side in sides.items()
            }

        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ranges = uncertainty.propagate(model, inputs, samples=256, seed=number)
        ends = [ranges[name].interval() for name in ("speed_a", "speed_b")]
        ranged += any(math.isfinite(low) or math.isfinite(high) for low, high in ends)
        if caught:
            warned[regime] += 1
            assert route != "stated" or "may_slide" in codes(caught)
            continue
        held[regime] += [low <= true <= high for (low, high), true in zip(ends, both, strict=True)]
    assert ranged == count
    if route == "stated":
        # Said of every contact that slid, and of no more than two in three that stuck.
        assert not held["sliding"]
        assert held["sticking"].count(True) >= 0.9 * len(held["sticking"]) > 0
        return
    assert sum(warned.values()) <= 0.2 * count
    for regime, found in held.items():
        # Of n ranges that hold 95 times in 100, fewer do once in 500 draws.
        least = 0.95 - 2.88 * math.sqrt(0.95 * 0.05 / len(found))
        assert np.mean(found) >= least, (regime, np.mean(found), len(found))


@pytest.mark.slow
def test_a_friction_that_the_components_contradict_says_to_leave_it_to_them():
    """A contact that slid at 0.02, told by A's components and its speed, with 0.05 to 0.9 stated.

    Left to the components, every case has an answer, and the range holds the truth.
    """
    a = col.Vehicle.from_speed(
        mass=1500, yaw_inertia=2500, speed=14.0, course=0.0, heading=0.0, x=-2.0, y=0.3
    )
    b = col.Vehicle.from_speed(
        mass=1200, yaw_inertia=1900, speed=11.0, course=1.4, heading=1.4, x=0.9, y=-0.5
    )
    hit = {"normal": 0.1, "point": (0.0, 0.0)}
    impact = col.eccentric(a, b, 0.1, friction=0.02, **hit)
    known = {**recorded(impact), "course_a": 0.0, "course_b": 1.4, "restitution": 0.1, **hit}
    advice = "Write `?friction=inf, slid='bound'`?, which takes the ratio"
    with pytest.raises(col.NoSolutionError, match=advice):
        speeds(a, b, **known, speed_a=14.0, friction=0.6)

    def study(friction, **settings):
        def model(speed_a, **values):
            (found,) = speeds(a, b, **known, speed_a=speed_a, **values, **settings)
            return {"b": found.b.before.speed}

        inputs = {"speed_a": uncertainty.Normal(14.0, 0.3), "friction": friction}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", col.CollisionsWarning)
            found = uncertainty.propagate(model, inputs, samples=256, seed=2)
        return found, {one.message.code: str(one.message) for one in caught}

    found, told = study(uncertainty.Uniform(0.05, 0.9))
    assert found.failed > 100
    assert f"{found.failed} of 256" in told["friction_differs"]
    assert "Bound inputs" not in told["failed_cases"]
    found, told = study(math.inf, slid="bound")
    assert not found.failed
    assert not told
    low, high = found["b"].interval(0.95)
    assert low < 11.0 < high


# A contact that slid one way, of which the forward part of A and the left part of B lie nearly
# along one line, so that they hardly tell which.
EITHER_A = col.Vehicle(
    mass=1500, yaw_inertia=2500, x=-2, y=-0.825192, vx=17.01, vy=7.05873, heading=0.393349,
    yaw_rate=0.210468,
)  # fmt: skip
EITHER_B = col.Vehicle(
    mass=1300, yaw_inertia=2000, x=1, y=0.86515, vx=-2.57397, vy=4.91946, heading=2.05285,
    yaw_rate=-0.144013,
)  # fmt: skip
EITHER = {"normal": -0.15334484, "point": (0, 0.0485109)}


def either_way(factor, **options):
    """The speeds from two components, the forward one read by this factor."""
    impact = col.eccentric(EITHER_A, EITHER_B, 0.14125, **EITHER, friction=0.15)
    assert impact.regime == "sliding"
    return speeds(
        EITHER_A, EITHER_B, course_a=EITHER_A.course, course_b=EITHER_B.course,
        restitution=0.14125, regime="sliding",
        delta_v_forward_a=impact.a.delta_v_forward * factor,
        delta_v_left_b=impact.b.delta_v_left, **EITHER, **options,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.15, math.inf])
@pytest.mark.parametrize("factor", [0.98, 1.0, 1.01, 1.02, 1.05])
def test_a_bound_of_which_the_direction_is_not_known_is_not_stated(factor, friction):
    """The truth is on the stated sides of one of both solutions, never of one given alone."""
    with pytest.raises(col.AmbiguousSolutionError, match="in which direction") as caught:
        either_way(factor, friction=friction, slid="bound")
    sides = [one.reconstruction.one_sided for one in caught.value.solutions]
    assert sides == [{"speed_a": 1, "speed_b": -1}, {"speed_a": -1, "speed_b": 1}]
    first = caught.value.solutions[0]
    assert first.a.before.speed <= EITHER_A.speed
    assert first.b.before.speed >= EITHER_B.speed
    assert "at least" in str(caught.value)
    assert "one of the speeds" in str(caught.value)


@pytest.mark.slow
def test_cases_of_a_batch_without_a_direction_are_refused():
    with pytest.warns(col.CollisionsWarning) as caught:
        (found,) = either_way(np.array([1.0, 1.02, 0.5]), friction=0.15, slid="bound")
    assert list(found.refused) == [True, True, False]
    assert "slid_either_way" in [warning.message.code for warning in caught]
    assert list(found.reconstruction.one_sided["speed_a"]) == [0, 0, -1]


@pytest.mark.slow
def test_beside_a_speed_a_contact_that_slid_has_the_ratio_that_is_shown():
    """It fits exactly, while the one that stuck misses the components by what recorders may."""
    for draw in range(400):
        of = np.random.default_rng(draw)
        a = EITHER_A.replace(vx=of.uniform(8, 20), vy=0.0, y=of.normal(0, 0.7), yaw_rate=0.0)
        b = EITHER_B.replace(vx=0.0, vy=of.uniform(5, 20), y=of.normal(0, 1.0), yaw_rate=0.0)
        contact = {"normal": of.uniform(-0.4, 0.4), "point": (0, 0.1)}
        impact = col.eccentric(a, b, 0.1, **contact, friction=1.0, on_failure="nan")
        if not impact.ok or impact.regime != "sliding":
            continue
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                speeds(
                    a, b, course_a=a.course, course_b=b.course, restitution=0.1, **contact,
                    friction=math.inf, speed_b=b.speed,
                    delta_v_forward_a=impact.a.delta_v_forward,
                    delta_v_left_a=impact.a.delta_v_left,
                )  # fmt: skip
        except col.AmbiguousSolutionError as error:
            solutions = error.solutions
            break
    assert solutions[1].a.before.speed == pytest.approx(a.speed, rel=1e-6)


@pytest.mark.slow
def test_beside_a_speed_the_refusal_has_the_speeds_of_both_with_their_ratios():
    a = col.Vehicle(mass=1361, yaw_inertia=2299, x=0, y=0, heading=-0.1523)
    b = col.Vehicle(mass=1585, yaw_inertia=3470, x=3.4151, y=-1.2449, heading=-0.1409)
    with pytest.raises(col.AmbiguousSolutionError) as caught:
        speeds(
            a, b, course_a=-0.1728, course_b=-0.1974, restitution=0.1404, normal=-0.6065,
            point=(1.8875, -0.56), friction=math.inf, speed_b=3.8356,
            delta_v_forward_a=-12.413, delta_v_left_a=1.8387,
        )  # fmt: skip
    stuck, slid = caught.value.solutions
    said = str(caught.value)
    assert (
        f"have an impulse ratio of {abs(stuck.impulse_ratio):.2f}, and `friction=inf` does not say "
        f"that it stuck. If it stuck, the speed of A is {stuck.a.before.speed:.6g} m/s and that of "
        f"B 3.8356 m/s; if it slid at a ratio of {abs(slid.impulse_ratio):.2f}, the speed of A is "
        f"{slid.a.before.speed:.6g} m/s and that of B 3.8356 m/s; that of A may then be from "
    ).replace("`", "") in said.replace("`", "")
    assert f"{abs(stuck.impulse_ratio):.2f}" != f"{abs(slid.impulse_ratio):.2f}"
    assert "with one of the speeds" not in said  # one is given


FAR = {
    "course_a": -0.1265, "course_b": 1.8415, "restitution": 0.229, "normal": 0.2967,
    "point": (1.449, -0.778), "speed_a": 11.565, "delta_v_forward_b": -1.952,
    "delta_v_left_b": -3.597, "friction": math.inf,
}  # fmt: skip
FAR_CARS = (
    col.Vehicle(mass=2088, yaw_inertia=3179, x=0, y=0, heading=-0.111, yaw_rate=0.268),
    col.Vehicle(mass=1602, yaw_inertia=2287, x=3.027, y=0.824, heading=1.866, yaw_rate=-0.086),
)


def misfit_of(speed_b, friction):
    """What a forward contact at this speed of B misses both components by, of its own, and
    whether it slid.
    """
    a, b = FAR_CARS
    impact = col.eccentric(
        a.replace(vx=11.565 * math.cos(-0.1265), vy=11.565 * math.sin(-0.1265)),
        b.replace(vx=speed_b * math.cos(1.8415), vy=speed_b * math.sin(1.8415)),
        0.229, normal=FAR["normal"], point=FAR["point"], friction=friction,
    )  # fmt: skip
    off = [getattr(impact.b, name[:-2]) - FAR[name] for name in FAR if name.startswith("delta")]
    return math.hypot(*off) / impact.b.delta_v, impact.regime == "sliding"


@pytest.mark.slow
def test_beside_a_speed_all_that_slid_and_fit_count_and_not_the_best_alone():
    """The best that slid lies next to the one that stuck, and others that fit far from it."""
    with pytest.raises(col.AmbiguousSolutionError, match="whether the contact stuck") as caught:
        speeds(*FAR_CARS, **FAR)
    stuck, slid = caught.value.solutions
    assert (stuck.regime, slid.regime) == ("sticking", "sliding")
    assert stuck.b.before.speed == pytest.approx(8.361, abs=1e-3)
    (found,) = speeds(*FAR_CARS, **FAR, slid="bound")
    assert found.b.before.speed == pytest.approx(stuck.b.before.speed, rel=1e-12)
    assert found.reconstruction.one_sided == {"speed_a": 0, "speed_b": 1}
    assert misfit_of(20.8, 0.545)[0] < 0.04
    assert misfit_of(20.8, 0.545)[1]
    # The ends that are stated: forward contacts on a grid of ratios fit up to there and no further.
    least, most = (
        float(word) for word in str(caught.value).partition("may then be from ")[2].split()[:4:3]
    )
    ratios = np.linspace(0.35, 0.7, 176)

    def fits(speed):
        return any(miss <= 0.1 and slips for miss, slips in (misfit_of(speed, r) for r in ratios))

    assert [fits(least * 0.99), fits(least * 1.01)] == [False, True]
    assert [fits(most * 0.99), fits(most * 1.01)] == [True, False]


@pytest.mark.slow
def test_a_batch_beside_a_speed_has_the_sides_of_its_cases():
    left = np.array([-3.597, -1.2, -3.597])
    forward = np.array([-1.952, -1.952, -0.5])
    cases = {**FAR, "delta_v_left_b": left, "delta_v_forward_b": forward, "slid": "bound"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        (found,) = speeds(*FAR_CARS, **cases)
        for i in range(3):
            own = {**cases, "delta_v_left_b": left[i], "delta_v_forward_b": forward[i]}
            (alone,) = speeds(*FAR_CARS, **own)
            assert found.b.before.speed[i] == pytest.approx(alone.b.before.speed, rel=1e-12)
            side = found.reconstruction.one_sided["speed_b"][i]
            assert side == alone.reconstruction.one_sided["speed_b"]


@pytest.mark.slow
def test_beside_a_speed_there_is_no_bound_where_the_one_that_stuck_goes_backwards():
    """Two crashes, at 11.1 m/s with readings off by some percent, and at 22.39 m/s with exact ones:
    the speeds of those that slid rise from backwards to faster forwards, so that a size has no
    side.
    """
    noisy = (
        col.Vehicle(
            mass=1847.729571, yaw_inertia=3528.311724, x=0, y=0, heading=-0.07836,
            yaw_rate=0.053004,
        ),
        col.Vehicle(
            mass=2082.78471, yaw_inertia=4551.805123, x=3.704804, y=0.38907, heading=4.419801,
            yaw_rate=0.241927,
        ),
    )  # fmt: skip
    exact = (
        col.Vehicle(mass=1167, yaw_inertia=1680.48, x=-1.527, y=-0.512, heading=0.293),
        col.Vehicle(
            mass=2235, yaw_rate=-0.392, yaw_inertia=3486.6, x=1.911, y=-0.341, heading=-1.79819
        ),
    )
    where = {"normal": -0.228, "point": (0.09, 0.005), "restitution": 0.117}
    courses = {"course_a": 0.293, "course_b": 4.485}
    truth = col.eccentric(
        *(
            one.replace(vx=fast * math.cos(course), vy=fast * math.sin(course))
            for one, fast, course in zip(exact, (23.59, 22.39), courses.values(), strict=True)
        ),
        friction=0.084,
        **where,
    )
    readings = {
        "delta_v_forward_a": truth.a.delta_v_forward, "delta_v_left_a": truth.a.delta_v_left,
        "speed_a": 23.59,
    }  # fmt: skip
    for cars, known in (
        (noisy, {
            "course_a": -0.10367, "course_b": 4.413577, "restitution": 0.308045,
            "normal": -0.307991, "point": (1.732086, 0.163863), "speed_a": 11.788906,
            "delta_v_forward_b": -1.595525, "delta_v_left_b": 6.128532,
        }),
        (exact, {**where, **courses, **readings}),
    ):  # fmt: skip
        with pytest.raises(col.AmbiguousSolutionError, match="B would go backwards") as open_:
            speeds(*cars, **known, friction=math.inf, slid="bound")
        assert [one.regime for one in open_.value.solutions] == ["sticking", "sliding"]
    assert open_.value.solutions[1].b.before.speed == pytest.approx(22.39, rel=1e-9)


def crashes_beside_a_speed(count):
    """Crashes with the friction high enough to stick or slide, and what is known of each: both
    components of one car and the speed of one.
    """
    of, found = np.random.default_rng(60), []
    while len(found) < count:
        heading = of.choice([-1, 1]) * of.uniform(0.5, 2.6)
        a = EITHER_A.replace(vx=of.uniform(6, 25), vy=0.0, y=of.normal(0, 0.7), yaw_rate=0.0)
        speed = of.uniform(6, 25)
        b = EITHER_B.replace(
            heading=heading, vx=speed * math.cos(heading), vy=speed * math.sin(heading),
            y=of.normal(0, 1.0), yaw_rate=0.0,
        )  # fmt: skip
        contact = {"normal": of.uniform(-0.5, 0.5), "point": tuple(of.normal(0, 0.4, 2))}
        restitution, friction = of.uniform(0, 0.4), of.uniform(0.3, 0.9)
        impact = col.eccentric(a, b, restitution, **contact, friction=friction, on_failure="nan")
        if not impact.ok or impact.closing_speed < 3.0:
            continue
        label, known = of.choice(["a", "b"]), of.choice(["a", "b"])
        speeds_of = {"a": a.speed, "b": b.speed}
        found.append((impact, "ab".replace(known, ""), [a, b], {
            "course_a": a.course, "course_b": b.course, "restitution": restitution, **contact,
            f"speed_{known}": speeds_of[known], **recorded(impact, label), "friction": math.inf,
        }))  # fmt: skip
    return found


@pytest.mark.slow
def test_one_that_stuck_with_a_misfit_does_not_silence_one_that_slid_without():
    """Forward crashes, exact readings: the truth is the answer or one of those that are offered."""
    slid = ambiguous = 0
    for impact, sought, cars, known in crashes_beside_a_speed(120):
        try:
            offered = speeds(*cars, **known)
        except col.AmbiguousSolutionError as error:
            offered, ambiguous = error.solutions, ambiguous + 1
        slid += impact.regime == "sliding"
        truth = getattr(impact, sought).before.speed
        nearest = min(abs(getattr(one, sought).before.speed - truth) for one in offered)
        assert nearest <= 2e-3 * impact.closing_speed
    assert slid >= 15
    assert ambiguous >= 5


def moved_forwards(impact, sought, cars, known):
    """What the components and the known speed move the one ``sought`` by, each by the whole of
    itself: by the forward solver, in which the friction is sought too.
    """
    given = next(name for name in known if name.startswith("speed"))
    read = [name for name in known if name.startswith("delta_v")]
    contact = {name: known[name] for name in ("restitution", "normal", "point")}

    def components(speed, friction, given_speed):
        moving = [
            car.replace(vx=one * math.cos(course), vy=one * math.sin(course))
            for car, one, course in zip(
                cars,
                (speed, given_speed) if sought == "a" else (given_speed, speed),
                (known["course_a"], known["course_b"]),
                strict=True,
            )
        ]
        there = col.eccentric(*moving, **contact, friction=friction)
        return np.array([getattr(getattr(there, one[-1]), one[:-2]) for one in read])

    at = getattr(impact, sought).before.speed, abs(impact.impulse_ratio), known[given]
    slopes = []
    for i in range(3):
        step = 1e-6 * at[i]
        high, low = ([*at[:i], at[i] + way * step, *at[i + 1 :]] for way in (1, -1))
        slopes.append((components(*high) - components(*low)) / (2 * step))
    row = np.linalg.inv(np.column_stack(slopes[:2]))[0]
    return sum(abs(row * [known[one] for one in read])) + abs(row @ slopes[2]) * known[given]


@pytest.mark.slow
def test_beside_a_speed_the_condition_has_the_error_of_the_ratio_that_is_shown():
    grows = []
    for impact, sought, cars, known in crashes_beside_a_speed(120):
        # Beside the end of sliding a step of differences may stick.
        if impact.regime != "sliding" or abs(impact.slip_after) < 1e-3:
            continue
        (found,) = speeds(*cars, **known, regime="sliding")
        exact = moved_forwards(impact, sought, cars, known) / impact.closing_speed
        assert found.reconstruction.condition == pytest.approx(exact, rel=1e-5)
        # A friction that is stated has no error of what was read.
        stated = {**known, "friction": abs(impact.impulse_ratio), "regime": "sliding"}
        (with_friction,) = speeds(*cars, **stated)
        grows.append(exact / with_friction.reconstruction.condition)
    assert len(grows) >= 15
    assert max(grows) > 1.5


@pytest.mark.slow
def test_beside_a_speed_a_bound_lies_on_the_side_of_the_one_that_slid():
    """The truth is the bound or lies where that says."""
    open_ = 0
    for impact, sought, cars, known in crashes_beside_a_speed(120):
        (found,) = speeds(*cars, **known, slid="bound")
        beyond = getattr(impact, sought).before.speed - getattr(found, sought).before.speed
        side = found.reconstruction.one_sided[f"speed_{sought}"]
        if side:
            open_ += 1
            assert side * beyond >= -2e-3 * impact.closing_speed
        else:
            assert abs(beyond) <= 2e-3 * impact.closing_speed
    assert open_ >= 5


@pytest.mark.slow
def test_beside_a_known_speed_nothing_is_said_of_the_friction_if_it_slid():
    """Two cars that slid at 0.56, which beside the speed of A a contact that sticks at 0.48 shows:
    friction was more than that, and the other speed another one.
    """
    a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.0, y=-0.2, heading=0.0)
    b = col.Vehicle(mass=1200, yaw_inertia=1800, x=2.0, y=0.5, heading=-1.7026)
    courses = {"course_a": 0.0, "course_b": -1.7026}
    contact = {"normal": -0.23, "point": (0.0, 0.2), "restitution": 0.1}
    before = [
        col.Vehicle.from_speed(
            mass=one.mass, yaw_inertia=one.yaw_inertia, x=one.x, y=one.y, heading=one.heading,
            speed=speed, course=one.heading,
        )
        for one, speed in ((a, 13.3), (b, 24.1))
    ]  # fmt: skip
    hit = col.eccentric(*before, friction=0.56, **contact)
    assert hit.regime == "sliding"
    known = recorded(hit, "b") | {"speed_a": 13.3, "friction": math.inf, "regime": "sticking"}
    known |= courses | contact
    with pytest.warns(col.IllConditionedWarning) as caught:
        (found,) = speeds(a, b, **known)
    (said,) = (str(one.message) for one in caught if one.message.code == "may_slide")
    assert said.endswith("If it slid, this is not the impact")
    (finding,) = (one for one in diagnose(found) if one.code == "may_slide")
    assert finding.sentence.endswith("if it slid, this is not the impact")
    assert abs(found.impulse_ratio) < 0.56
    # Nor is it one end of a family, in a batch and in a study.
    with pytest.warns(col.IllConditionedWarning) as caught:
        speeds(a, b, **known | {"speed_a": np.array([13.3, 13.4])})
    assert all("family" not in str(one.message) for one in caught)
    assert any("this is not the impact" in str(one.message) for one in caught)


def test_a_page_of_sliders_says_what_is_a_bound():
    """And that speeds which do not move were found."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        (end,) = back(friction=0.45, slid="bound")
    page = str(col.what_if(end, {"restitution": (0.0, 0.3)}))
    assert "The contact slid, or may have: the speed of B is at least" in page
    assert "Given or found, not moved" in page
