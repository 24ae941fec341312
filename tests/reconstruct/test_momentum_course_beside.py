"""momentum with a course sought beside the speed of another: against an impact of which all is
known, complex sums, a solver of its own equations, and differences of the answer.
"""

import cmath
import math
import re

import numpy as np
import pytest
from scipy.optimize import fsolve

import collisions as col
from collisions import reconstruct, reporting
from collisions.reconstruct.momentum_tyres import neglected, sliding
from collisions.travel import Tyres
from collisions.uncertainty import Normal, propagate

MASSES = {"a": 1437.0, "b": 1823.0}
LABELS = ["a", "b", "a_after", "b_after"]
PAIRS = [(x, y) for x in LABELS for y in LABELS if x != y]


def impact():
    """Motions of a real impact by the forward solver."""
    a = col.Vehicle(mass=MASSES["a"], yaw_inertia=2300, vx=17, vy=2, x=-1.8, y=-0.3)
    b = col.Vehicle(mass=MASSES["b"], yaw_inertia=3100, vx=-6, vy=12, x=1.1, y=0.4)
    end = col.eccentric(a, b, 0.15, normal=0.2, point=(0.1, 0.1), friction=0.5)
    known = {}
    for label, side in (("a", end.a), ("b", end.b)):
        for when in ("before", "after"):
            state, tail = getattr(side, when), "_after" if when == "after" else ""
            known[f"speed_{label}{tail}"] = float(state.speed)
            known[f"course_{label}{tail}"] = float(state.course)
    return end, known


END, TRUE = impact()


def without(speed, course):
    return {n: v for n, v in TRUE.items() if n not in (f"speed_{speed}", f"course_{course}")}


def momentum(known, **more):
    return reconstruct.momentum(MASSES["a"], MASSES["b"], **(known | more))


def apart(one, other):
    return math.remainder(one - other, math.tau)


def imbalance(found):
    """Momentum before less that after, as a complex number."""
    total = 0j
    for label in LABELS:
        mass = MASSES[label[0]] * (-1.0 if label.endswith("after") else 1.0)
        total += mass * cmath.rect(
            getattr(found, f"speed_{label}"), getattr(found, f"course_{label}")
        )
    return abs(total)


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize(("speed", "course"), PAIRS)
def test_an_impact_of_the_forward_solver_is_found_again(speed, course):
    found = momentum(without(speed, course), course_near=TRUE[f"course_{course}"] + 0.02)
    assert found.unknowns == (f"speed_{speed}", f"course_{course}")
    assert getattr(found, f"speed_{speed}") == pytest.approx(TRUE[f"speed_{speed}"], rel=1e-9)
    off = apart(getattr(found, f"course_{course}"), TRUE[f"course_{course}"])
    assert off == pytest.approx(0.0, abs=1e-9)
    assert found.delta_v_a == pytest.approx(END.a.delta_v, rel=1e-9)
    assert found.delta_v_b == pytest.approx(END.b.delta_v, rel=1e-9)
    angle = TRUE[f"course_{course}"] - TRUE[f"course_{speed}"]
    condition = (1.0 + abs(math.sin(angle))) / abs(math.cos(angle))
    assert found.condition == pytest.approx(condition, rel=1e-7)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize(("speed", "course"), PAIRS)
def test_without_course_near_both_fit_or_the_other_one_goes_backwards(speed, course):
    given = without(speed, course)
    other = 2.0 * TRUE[f"course_{speed}"] + math.pi - TRUE[f"course_{course}"]
    mirrored = momentum(given, course_near=other)
    assert imbalance(mirrored) < 1e-8
    assert apart(getattr(mirrored, f"course_{course}"), other) == pytest.approx(0.0, abs=1e-8)
    if getattr(mirrored, f"speed_{speed}") < 0.0:
        found = momentum(given)
        off = apart(getattr(found, f"course_{course}"), TRUE[f"course_{course}"])
        assert off == pytest.approx(0.0, abs=1e-8)
        return
    with pytest.raises(col.AmbiguousSolutionError, match=f"course_{course} = .*course_near") as e:
        momentum(given)
    assert e.value.code == "ambiguous"
    one, two = e.value.solutions
    assert imbalance(one) < 1e-8
    assert imbalance(two) < 1e-8
    for solution in (one, two):
        # Each is solved again from what it says was given.
        assert reporting.replay(col.report(solution)) == solution
        assert momentum(given, course_near=getattr(solution, f"course_{course}")) == solution


def test_the_two_forms_come_up():
    """Of the pairs above some are ambiguous and some are not."""
    outcomes = set()
    for pair in PAIRS:
        try:
            momentum(without(*pair))
            outcomes.add("one")
        except col.AmbiguousSolutionError:
            outcomes.add("two")
    assert outcomes == {"one", "two"}


def test_by_hand():
    """A at 5 m/s, B along x; both of 1000 kg leave as one along x + i y: 3000 + 4000i of it is A's
    or 3000 less of it.
    """
    given = {"course_b": 0.0, "speed_a": 5.0, "together": True}
    leave = {"speed_a_after": abs(5 + 2j), "course_a_after": cmath.phase(5 + 2j)}
    with pytest.raises(col.AmbiguousSolutionError) as caught:
        reconstruct.momentum(1000, 1000, **given, **leave)
    courses = [s.course_a for s in caught.value.solutions]
    speeds = [s.speed_b for s in caught.value.solutions]
    assert courses == pytest.approx([cmath.phase(3 + 4j), cmath.phase(-3 + 4j)], abs=1e-12)
    assert speeds == pytest.approx([7.0, 13.0], rel=1e-12)


@pytest.mark.slow
def test_a_common_course_after_beside_a_speed_before():
    common = (MASSES["a"] * 15.0 + MASSES["b"] * 11.0j) / sum(MASSES.values())
    given = {"course_a": 0.0, "course_b": "90 deg", "speed_b": 11.0, "together": True}
    found = momentum(given, speed_a_after=abs(common))
    assert found.speed_a == pytest.approx(15.0, rel=1e-9)
    assert found.course_a_after == found.course_b_after
    assert found.course_a_after == pytest.approx(cmath.phase(common), abs=1e-9)
    derived = str(col.explain(found))
    assert "does not" not in derived.partition("## Notes")[0]
    assert "B | course after" not in derived.partition("## Planar")[0]
    assert reporting.replay(col.report(found)) == found


@pytest.mark.parametrize(("speed", "course"), [("b", "a"), ("a", "a_after"), ("b_after", "b")])
def test_sensitivities_are_differences_of_the_answer(speed, course):
    near = {"course_near": TRUE[f"course_{course}"]}
    start = {"mass_a": MASSES["a"], "mass_b": MASSES["b"], **without(speed, course),
             "outside_impulse_x": 300.0, "outside_impulse_y": -200.0}  # fmt: skip

    def solved(**changed):
        numbers = start | changed
        push = numbers.pop("outside_impulse_x"), numbers.pop("outside_impulse_y")
        return reconstruct.momentum(**numbers, outside_impulse=push, **near)

    found = solved()
    for answer, row in found.sensitivity.items():
        assert row.keys() == start.keys()
        for name, value in row.items():
            step = 1e-5 * max(1.0, abs(start[name]))
            low, high = (
                getattr(solved(**{name: start[name] + by}), answer) for by in (-step, step)
            )
            assert value == pytest.approx((high - low) / (2.0 * step), rel=1e-5, abs=1e-8)


def test_what_is_left_out_is_what_a_small_push_moves():
    found = momentum(without("b", "a"), course_near=TRUE["course_a"])
    drag = 1e-4
    push = np.zeros(2)
    for label, mass in MASSES.items():
        before, after = (
            [
                trig(TRUE[f"course_{label}{when}"]) * TRUE[f"speed_{label}{when}"]
                for trig in (math.cos, math.sin)
            ]
            for when in ("", "_after")
        )
        push += sliding(mass, before, after, drag, 0.1)
    pushed = momentum(
        without("b", "a"), course_near=TRUE["course_a"], outside_impulse=(push[0], push[1])
    )
    changes = neglected(found, 0.1, drag, lambda value, _: str(value)).changes
    assert changes["speed_b"] == pytest.approx(pushed.speed_b - found.speed_b, rel=1e-3)
    assert changes["course_a"] == pytest.approx(pushed.course_a - found.course_a, rel=1e-3)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_with_tyres_its_own_equations_are_met():
    """All wheels locked: their friction against the motion, by Simpson's rule."""
    times = {"duration": 0.11, "tyres_a": Tyres(0.7, 1.0, 2.7, 1.5),
             "tyres_b": Tyres(0.6, 1.0, 2.6, 1.5)}  # fmt: skip
    given = without("b", "a")

    def missed(unknown):
        motions = given | {"speed_b": unknown[0], "course_a": unknown[1]}
        half, total = 1.0 - math.cos(0.25 * math.pi), 0j
        for label, mass in MASSES.items():
            before, after = (
                cmath.rect(motions[f"speed_{label}{when}"], motions[f"course_{label}{when}"])
                for when in ("", "_after")
            )
            middle = before + half * (after - before)
            first, second, third = (v / abs(v) for v in (before, middle, after))
            friction = times[f"tyres_{label}"].friction
            mean = (first + 4.0 * second + third) / 6.0
            total += mass * (after - before) + friction * mass * 9.80665 * 0.11 * mean
        return total.real, total.imag

    expected = fsolve(missed, [TRUE["speed_b"], TRUE["course_a"]], xtol=1e-13)
    more = times | {"heading_a": 0.1, "heading_b": 1.7, "course_near": TRUE["course_a"]}
    found = momentum(given, **more)
    assert [found.speed_b, found.course_a] == pytest.approx(expected, rel=1e-8)
    assert abs(found.speed_b - TRUE["speed_b"]) > 0.1
    assert "does not" not in str(col.explain(found)).partition("## Notes")[0]
    assert reporting.replay(col.report(found)) == found


def test_batches_are_as_alone_and_studies_go_through_it():
    given = without("b", "a")
    speeds = np.array([TRUE["speed_a"], TRUE["speed_a"] + 0.7, 0.3, TRUE["speed_a"] + 3.0])
    near = TRUE["course_a"]
    with pytest.warns(col.CollisionsWarning):
        many = momentum(given | {"speed_a": speeds}, course_near=near)
    for i in (0, 1, 3):
        alone = momentum(given | {"speed_a": float(speeds[i])}, course_near=near)
        assert many.course_a[i] == pytest.approx(alone.course_a, rel=1e-13)
        assert many.speed_b[i] == pytest.approx(alone.speed_b, rel=1e-13)
        assert many.sensitivity["speed_b"]["mass_a"][i] == pytest.approx(
            alone.sensitivity["speed_b"]["mass_a"], rel=1e-12
        )
    assert many.status[2] == col.Status.CONTRADICTORY
    assert math.isnan(many.speed_b[2])
    unsaid = momentum(given | {"speed_a": speeds[:2]}, on_failure="nan")
    assert list(unsaid.status) == [col.Status.AMBIGUOUS] * 2
    with pytest.raises(col.AmbiguousSolutionError, match="course_near"):
        momentum(given | {"speed_a": speeds[:2]}, on_failure="raise")

    def model(speed):
        one = momentum(given | {"speed_a": speed}, course_near=near)
        return {"speed_b": one.q.speed_b}

    result = propagate(model, {"speed": Normal(TRUE["speed_a"], 0.05)}, samples=256, seed=1)[
        "speed_b"
    ]
    slope = momentum(given, course_near=near).sensitivity["speed_b"]["speed_a"]
    assert result.mean == pytest.approx(TRUE["speed_b"], abs=0.05)
    assert result.std == pytest.approx(0.05 * abs(slope), rel=0.2)


def test_too_slow_on_any_course():
    given = without("b", "a")
    with pytest.raises(col.NoSolutionError, match=r"no course_a fits.*give `?course_a=") as caught:
        momentum(given | {"speed_a": 0.3})
    assert caught.value.code == "contradictory"
    least = float(re.search(r"speed_a of ([\d.]+) m/s or more", str(caught.value))[1])
    with pytest.raises(col.NoSolutionError):
        momentum(given | {"speed_a": 0.999 * least})
    with pytest.warns(col.IllConditionedWarning, match="right angle") as warned:
        momentum(given | {"speed_a": 1.001 * least}, course_near=math.pi / 4)
    assert "nearly_across" in {one.message.code for one in warned}


def test_course_near_has_to_decide_something():
    with pytest.raises(col.InputError, match="leave it out") as caught:
        momentum(
            {n: v for n, v in TRUE.items() if n not in ("speed_a", "speed_b")}, course_near=0.1
        )
    assert (caught.value.code, caught.value.argument) == ("bad_combination", "course_near")
    with pytest.raises(col.InputError, match="leave it out"):
        momentum(without("a", "a"), course_near=0.1)


@pytest.mark.slow
def test_pages_and_findings_have_it():
    found = momentum(without("b", "a"), course_near="5 deg", heading_b=0.1)
    assert not [one for one in col.diagnose(found) if one.code == "near_collinear"]
    derived = str(col.explain(found))
    assert "course before, about, of two that may fit | 5°" in derived
    assert "does not" not in derived.partition("## Notes")[0]
    page = str(col.report(found))
    assert "from the angle between the unknown course and that of the unknown speed" in page
    assert reporting.replay(page) == found


def test_a_course_exactly_across_has_an_infinite_condition_and_a_derivation():
    """The balance across A's course gives the speed of B that leaves it no way but across."""
    known = {
        "mass_a": 1500.0, "mass_b": 1200.0, "course_a": 0.0, "course_a_after": math.radians(20.0),
        "course_b_after": math.radians(50.0), "speed_a_after": 8.0, "speed_b_after": 9.0,
    }  # fmt: skip
    across = 1500.0 * 8.0 * math.sin(math.radians(20.0)) + 1200.0 * 9.0 * math.sin(
        math.radians(50.0)
    )
    with pytest.warns(col.IllConditionedWarning, match="right angle"):
        found = reconstruct.momentum(**known, speed_b=across / 1200.0)
    along = 1500.0 * 8.0 * math.cos(math.radians(20.0)) + 1200.0 * 9.0 * math.cos(
        math.radians(50.0)
    )
    assert found.speed_a == pytest.approx(along / 1500.0, rel=1e-7)
    assert found.condition == math.inf
    assert "the condition is infinite" in str(col.explain(found))


@pytest.mark.slow
def test_a_side_that_is_lost_while_the_tyres_are_worked_out_is_refused():
    """Of a slow car the tyres decide where it came from: along the other side the balance does not
    settle, though the truth lies there, so the one that settles is no answer.
    """
    spun = {"heading_b": 2.3244, "yaw_rate_b_after": 3.2542}
    given = {
        "duration": 0.14069,
        "tyres_a": Tyres(0.6644, [0.18986, 0.26565, 0.94248, 0.0], 2.6, 1.5),
        "tyres_b": Tyres(0.4949, [0.17833, 0.95912, 1.0, 1.0], 2.6, 1.5),
        "heading_a": 2.6982, "yaw_rate_a_after": 2.9529, **spun,
        "speed_b": 1.5451, "course_a": 2.6982, "speed_a_after": 13.4121, "course_a_after": 2.4288,
    }  # fmt: skip
    masses = 2924.55, 1758.07
    truth = reconstruct.momentum(*masses, **given, speed_a=18.4432, course_b=2.3244)
    given |= {"speed_b_after": truth.speed_b_after, "course_b_after": truth.course_b_after}
    for near in ({}, {"course_near": 2.3244}):
        with pytest.raises(col.NoSolutionError, match="do not settle while the tyres act"):
            reconstruct.momentum(*masses, **given, **near)


@pytest.mark.parametrize("wheels", [{}, {"duration": 0.1, "tyres_a": Tyres(0.7, 0.5, 2.6, 1.5)}])
def test_both_answers_have_the_record_of_the_call_that_decides(wheels):
    """So that the page made again from the record is the same, byte for byte."""
    aimed = {"heading_a": "-100 deg"} if wheels else {}
    given = {"speed_a": "75 km/h", "speed_a_after": "30 km/h", "speed_b_after": "50 km/h"}
    courses = {"course_b": "0 deg", "course_a_after": "-30 deg", "course_b_after": "-40 deg"}
    with pytest.raises(col.AmbiguousSolutionError) as caught:
        reconstruct.momentum(
            1200.0, 1800.0, **given, **courses, **aimed, **wheels, outside_impulse=(1.0, 2.0)
        )
    for one in caught.value.solutions:
        page = str(col.report(one, form="markdown"))
        assert str(col.report(reporting.replay(page), form="markdown")) == page


def test_a_momentum_that_underflows_is_refused():
    """Mass times speed is 0 in double precision, so its course is nothing to be found."""
    known = {"mass_a": 300.0, "mass_b": 5e-324, "speed_a": 1.0, "speed_b": 0.5, "together": True}
    with pytest.raises(col.NoSolutionError) as refused:
        reconstruct.momentum(**known, course_a=0.0, course_a_after=0.0)
    assert refused.value.code == "contradictory"
