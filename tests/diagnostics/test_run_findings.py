"""The findings of a whole scene: those of each impact, told apart, and what the scene leaves
open.
"""

from __future__ import annotations

import math
import re
from typing import Any

import pytest

import collisions as col
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from crashes import three_cars


@pytest.mark.slow
def test_each_impact_has_its_own_findings_with_its_number_and_time() -> None:
    run = three_cars()
    found = col.diagnose(run, units="us")
    for number, (impact, pair, time) in enumerate(
        zip(run.impacts, run.pairs, run.times, strict=True)
    ):
        outlines = {}
        if number == 0:  # whose normal and point were given
            outlines = {"outline_a": (4.8, 1.8), "outline_b": (4.5, 1.7)}
        alone = col.diagnose(impact, units="us", **outlines)
        here = [one for one in found if one.impact == number]
        assert [one.code for one in here] == [one.code for one in alone]
        for one, other in zip(here, alone, strict=True):
            where = f"impact {number + 1}, {' and '.join(pair)} at {time:.2f} s: "
            assert one.sentence == where + other.sentence
            assert (one.measured, one.limit, one.vehicle) == (
                pytest.approx(other.measured, rel=1e-12), other.limit, other.vehicle
            )  # fmt: skip
            assert one.time == time
        assert alone.measured <= found.measured
    # The front of the Camry is at -0.2 m and the side of the Civic at 0.15 m.
    (gap,) = [one for one in found if one.code == "outlines_gap"]
    assert gap.measured == pytest.approx(0.35, abs=1e-9)


@pytest.mark.slow
def test_what_the_scene_leaves_open_comes_last() -> None:
    scene = three_cars().scene
    run = Scene(
        movers=scene.movers, contacts=scene.contacts[:2], surfaces=[([*scene.surfaces[0][0]], 0.3)]
    ).run()
    (notice,) = run.findings
    last = col.diagnose(run)[-1]
    assert (last.code, last.sentence, last.time) == (notice.code, notice.sentence, notice.time)
    assert last.code == "touch_without_contact"
    assert last.impact is None


@pytest.mark.slow
@pytest.mark.parametrize("given", ["90 deg", math.pi / 2.0])
def test_no_unit_is_asked_of_what_the_scene_worked_out(given: Any) -> None:
    """A car that is struck, at 100 mph, spins by more than a turn before it meets a truck."""
    camry, civic, truck = three_cars().scene.movers.values()
    movers = {
        "Camry": camry.replace(vehicle=camry.vehicle.replace(vx="100 mph")),
        "Civic": civic.replace(vehicle=civic.vehicle.replace(heading=given, y=0.6)),
        "Truck": truck.replace(vehicle=truck.vehicle.replace(x=14.0, y=9.0)),
    }
    hit = Contact("Camry", "Civic", restitution=0.1, friction=0.5, normal=0.0, point=(0.0, -0.6))
    then = Contact("Civic", "Truck", restitution=0.2, friction=0.4, at="touch")
    run = Scene(movers=movers, contacts=[hit, then]).run()
    impact = run.impacts[1]
    turned = impact.a.before.heading - run.impacts[0].b.before.heading
    assert abs(turned) > 2.0 * math.pi
    found = col.diagnose(run)
    assert not [one for one in found if one.code.startswith("suspect") and "meant?" in one.sentence]
    assert "suspect_angle" in found.measured


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_a_unit_is_asked_of_what_was_given_to_a_scene() -> None:
    """Degrees, km/h and degrees/s as bare numbers, of a car that has come some way since."""

    def mover(**state: Any) -> Mover:
        body = {"mass": 1500, "yaw_inertia": 2600, "y": 0.0, "heading": 0.0} | state
        return Mover(col.Vehicle(**body))

    contact = Contact("A", "B", restitution=0.1, friction=0.5, normal=0.0, point=(0.0, 0.0), at=0.1)
    a, b = mover(x=-12.0, vx=90.0, heading=90.0), mover(x=1.0, yaw_rate=25.0)
    run = Scene(movers={"A": a, "B": b}, contacts=[contact]).run()
    said = {one.code: one.sentence for one in col.diagnose(run)}
    assert (
        "vehicle A has a heading of 90 rad, 14.3 turns; were degrees meant?"
        in said["suspect_angle"]
    )
    assert "goes at 90 m/s before; were km/h or mph meant?" in said["suspect_speed"]
    assert "turns at 25 rad/s before; were degrees/s meant?" in said["suspect_yaw_rate"]


def test_limits_count_for_every_impact() -> None:
    codes = ("outlines_gap", "point_outside", "tyre_impulse", "friction_gain")
    found = col.diagnose(three_cars(), limits=dict.fromkeys(codes, float("inf")))
    assert not {one.code for one in found} & set(codes)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.OutOfRangeWarning")
def test_evidence_of_one_impact_is_refused() -> None:
    run = three_cars()
    with pytest.raises(col.InputError, match=r"diagnose\(run.impacts\[0\], crush_energy=...\)"):
        col.diagnose(run, crush_energy="10 kJ")
    with pytest.raises(col.InputError, match="outlines of their movers"):
        col.diagnose(run, outline_b=(4.5, 1.8))
    with pytest.raises(col.InputError, match="units"):
        col.diagnose(run, units="imperial")
    many = run.scene.replace({"Camry.vx": [17.0, 18.0]}).run(tolerance=1e-3)
    with pytest.raises(col.ShapeError, match=r"diagnose\(run.case\(0\)\)"):
        col.diagnose(many)
    with pytest.raises(col.ShapeError, match=r"explain\(run.case\(0\)\)"):
        col.explain(many)


@pytest.mark.slow
def test_what_would_move_each_impact_is_that_of_the_impact() -> None:
    """In order of the impacts, with the names of the vehicles, in the report too."""
    run = three_cars()
    found = col.diagnose(run)
    wanted = []
    for number, (impact, pair) in enumerate(zip(run.impacts, run.pairs, strict=True), 1):
        own = col.diagnose(impact).moves
        wanted += [
            (f"impact {number}, {pair[0]} as A and {pair[1]} as B: {move.what}", move.share)
            for move in own
        ]
    assert [(move.what, move.share) for move in found.moves] == wanted
    page = col.report(run, form="markdown", figures=False)
    assert page.count("change of the delta-V of A, of B") == sum(
        math.isfinite(move.share) for move in found.moves
    )


@pytest.mark.slow
def test_movers_called_by_the_letters_of_the_other_are_told_apart() -> None:
    """A mover named B that is the first of its contact is "A (named B)", and findings of a run
    have no letters of their own.
    """
    tyres = Tyres(0.7, 0.3, 2.7, 1.5)
    first, second = (
        Mover(
            col.Vehicle(mass=1500, yaw_inertia=2500, x=x, y=0.3, vx=vx, heading=0.0),
            outline=(4.5, 1.8),
            tyres=tyres,
        )
        for x, vx in ((-6.0, 14.0), (0.0, 0.0))
    )
    touch = Contact("B", "A", restitution=0.1, friction=0.5, at="touch")
    run = Scene(movers={"B": first, "A": second}, contacts=[touch]).run()
    found = col.diagnose(run, limits={"tyre_impulse": 0.0})
    text = " ".join(f"{found} {found.moves} {col.explain(run)}".split())
    assert not re.search(r"B \(A\)|A \(B\)", text)
    assert "A (named B)" in text
    assert "impact 1, “B” as A and “A” as B" in text
    assert not any(re.match(r"\s*\w+ \([AB]\)", line) for line in str(found).splitlines())
