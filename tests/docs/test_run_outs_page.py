"""The page "Run-outs": its numbers, a sample of its scenes worked out again, and the world in which
ranges are tried.
"""

import math
from pathlib import Path

import numpy as np
import pytest

import collisions as col
from collisions import travel
from scripts import benchmarks

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def scripts():
    """The scripts that write the numbers, and the tables made of them."""
    return benchmarks("run_outs", "run_out_coverage", "run_out_tables")


@pytest.mark.slow
def test_the_tables_are_made_of_the_numbers_that_were_written(scripts):
    """Every row is there, and what is bold is below 95 %."""
    _, coverage, tables = scripts
    found, covered = tables.load("run_outs.json"), tables.load("run_out_coverage.json")
    rows = covered["rows"]
    assert tables.ladder(found).count("\n") == 1 + len(found["ladder"]["rows"])
    assert tables.promise(found).count("\n") == 4
    assert found["promise"]["scenes"] + found["promise"]["refused"] == 1000
    assert sum(row["cars"] + row["refused"] for row in rows if row["kind"] == "all") == 5 * 200
    assert tables.coverage(covered).count("\n") == 1 + 5
    assert 0.0 < covered["off"]["speed"] < 0.1
    assert 0.0 < covered["off"]["yaw_rate"] < 1.0
    for row in rows:
        assert (row["low"], row["high"]) == pytest.approx(
            coverage.binomial(row["held"], row["cars"]), abs=1e-3
        )


def test_stated_ranges_hold_cars_whose_wheels_spin(scripts):
    """No interval lies below 95 %, and over all outputs 94 % or more are held."""
    _, coverage, tables = scripts
    rows = tables.load("run_out_coverage.json")["rows"]
    assert all(row["refused"] == 0 for row in rows)
    assert min(row["high"] for row in rows) >= coverage.LEAST
    whole = [row for row in rows if row["kind"] == "all"]
    held, cars = (sum(row[name] for row in whole) for name in ("held", "cars"))
    assert held >= coverage.POOLED * cars
    assert tables.pooled({"rows": rows}) == f"{100.0 * held / cars:.1f} %"


@pytest.mark.parametrize(
    ("hits", "count", "low", "high"),
    [(10, 10, 0.6915, 1.0), (0, 10, 0.0, 0.3085), (50, 100, 0.3983, 0.6017)],
)
def test_binomial_intervals_are_those_of_clopper_and_pearson(scripts, hits, count, low, high):
    """At 95 %, from their tables (scipy's beta quantiles)."""
    found = scripts[1].binomial(hits, count, 0.95)
    assert found == pytest.approx((low, high), abs=2e-4)


@pytest.mark.slow
def test_the_default_tolerance_keeps_its_promise_over_a_sample(scripts):
    """60 of the scenes of the benchmark, with areas and without."""
    found = scripts[0].promise(60, 11)
    assert found["scenes"] == 60
    for name in ("place", "heading", "time"):
        assert found[name]["largest"] < scripts[0].PROMISED, name


@pytest.mark.slow
def test_the_world_of_spinning_wheels_knows_locked_ones(scripts):
    """With all wheels locked it is a skid in closed form; half the step comes to the same rest."""
    coverage = scripts[1]
    car = coverage.cars(8, np.random.default_rng(3))
    car["lock"][:, 0], car["yaw_rate"][0] = 1.0, 0.0
    rest = coverage.integrated(car)["rest"]
    way = car["speed"][0] ** 2 / (2.0 * coverage.GRAVITY * car["friction"][0])
    assert math.hypot(rest[0, 0], rest[1, 0]) == pytest.approx(way, rel=2e-3)
    start = col.Vehicle(
        mass=coverage.MASS,
        yaw_inertia=coverage.INERTIA,
        x=0.0,
        y=0.0,
        heading=0.0,
        vx=car["speed"] * np.cos(car["course"]),
        vy=car["speed"] * np.sin(car["course"]),
        yaw_rate=car["yaw_rate"],
    )
    tyres = travel.Tyres(car["friction"], list(car["lock"]), coverage.WHEELBASE, coverage.TRACK)
    apart = []
    for rotating in (coverage.ROTATING, 0.0):
        ours = travel.simulate(start, tyres, rotating_mass=rotating, moments=2).rest
        apart.append(np.hypot(ours.x - rest[0], ours.y - rest[1]) / np.hypot(rest[0], rest[1]))
    # Another tyre: a brush rolls off a little before its brake holds it. Wheels that turn weigh 3 %
    # of the car, and that much of the way is missing without them.
    assert np.max(apart[0]) < 0.06
    assert np.median(apart[0]) < 0.012 < 0.02 < np.median(apart[1])
