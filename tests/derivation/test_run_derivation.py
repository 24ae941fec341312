"""The derivation of a whole scene has that of every impact, and its ledger adds up."""

from __future__ import annotations

import math
import re

import pytest

import collisions as col
from collisions.scene import Mover, Scene
from collisions.travel import Tyres
from crashes import coasting, three_cars

FT_LBF = 1.3558179483314004
FOOT = 0.3048


def steps(page: str) -> str:
    """What a page has between its title and its notes, without marks of headings."""
    body = page[page.index("\n") : page.index("## Notes")]
    return re.sub(r"^#+ ", "", body, flags=re.MULTILINE).strip()


@pytest.mark.slow
def test_each_impact_is_derived_as_it_is_alone() -> None:
    run = three_cars()
    whole = col.explain(run, units="metric")
    at = 0
    for impact in run.impacts:
        alone = steps(col.explain(impact, units="metric"))
        found = re.sub(r"^#+ ", "", whole, flags=re.MULTILINE).find(alone)
        assert found > at
        at = found


@pytest.mark.slow
def test_the_ledger_adds_up_as_it_is_printed() -> None:
    run = three_cars()
    page = col.explain(run, units="us", form="text")
    ledger = page[page.index("Where the kinetic energy went") : page.index("What the ground")]
    numbers = [float(number) for number in re.findall(r" (\d+) ft\*lbf", ledger)]
    start, *taken = numbers
    assert len(taken) == 5
    assert math.fsum(taken) == pytest.approx(start, abs=4.0)
    # Of two cars at 40 and 20 mph, by hand.
    by_hand = 0.5 * 0.45359237 * 0.44704**2 * (3400 * 40**2 + 2750 * 20**2) / FT_LBF
    assert start == pytest.approx(by_hand, abs=0.5)
    assert float(re.search(r"([\d.e-]+) percent", ledger)[1]) < 0.1


@pytest.mark.slow
def test_a_vehicle_at_rest_without_a_heading_takes_no_energy(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Nor does the account print what is no number where an energy is not known."""
    tyres = Tyres(0.7, 1.0, 2.7, 1.5)
    moving = col.Vehicle(mass=1500, yaw_inertia=2500, vx=15.0, x=0.0, y=0.0, heading=0.0)
    standing = col.Vehicle(mass=1300, yaw_inertia=2000, x=50.0, y=8.0)
    movers = {"A": Mover(moving, tyres=tyres), "B": Mover(standing, tyres=tyres)}
    run = Scene(movers=movers, contacts=[]).run()
    energy = run.energy
    assert energy["ground"] == pytest.approx(energy["before"], rel=1e-5)
    assert " percent of that at the start" in col.explain(run)
    monkeypatch.setattr(type(run), "energy", property(lambda _: energy | {"ground": math.nan}))
    page = col.explain(run)
    assert "not accounted for | not known" in page
    assert "nan" not in page.split()


@pytest.mark.slow
def test_places_of_rest_are_those_of_the_run() -> None:
    run = three_cars()
    page = col.explain(run, units="us", form="text")
    rests = page[page.index("Places of rest") : page.index("Where the kinetic")]
    found = re.findall(r"(\w+) +position (\w) at rest +(-?[\d.]+) ft", rests)
    assert len(found) == 6
    for name, axis, number in found:
        assert float(number) == pytest.approx(getattr(run.rest[name], axis) / FOOT, abs=5.1e-3)


def test_both_forms_and_what_is_refused() -> None:
    page = col.explain(coasting())
    assert "none: nothing slows it" in page
    assert r"\<A & co\>" in page
    assert "## Impact 1: " in page
    assert "\n### Given" in page
    text = col.explain(coasting(), form="text")
    assert "<A & co> as A and B as B, at 0.00 s\n----" in text
    with pytest.raises(col.InputError, match=r"explain\(run.impacts\[0\], uncertainty=...\)"):
        col.explain(coasting(), uncertainty={"energy_loss": 1.0})
    with pytest.raises(col.InputError, match="form"):
        col.explain(coasting(), form="latex")


@pytest.mark.slow
def test_what_limits_a_run_stands_before_its_impacts() -> None:
    """In the units of the page, and every finding once."""
    run = three_cars()
    assert run.findings
    page = col.explain(run, units="us", form="text")
    before = page[: page.index("Impact 1:")]
    assert "What the scene does not describe, or limits its answer:" in before
    for found in run._findings_in("us"):
        assert f"- {found.sentence}." in before
    level = Scene(
        movers={"A": Mover(col.Vehicle(mass=1500.0, vx=5.0, x=0.0, y=0.0, heading=0.0), drag=0.7)},
        contacts=[],
    ).run()
    assert "limits its answer" not in col.explain(level, form="text")
