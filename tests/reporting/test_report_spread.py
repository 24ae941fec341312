"""What a report says of a propagation: cases without an answer, bounds without shares, and inputs
whose unit is not known.
"""

import re

import numpy as np
import pytest

import collisions as col
from collisions.uncertainty import Interval, Normal, propagate

IMPACT = col.linear_central(
    col.Vehicle(mass=1500.0, vx=20.0), col.Vehicle(mass=1500.0), restitution=0.2
)


def page_of(known, impact=IMPACT):
    return col.report(impact, form="markdown", units="metric", uncertainty=known, figures=False)


def text_of(page, name):
    """What stands beside a name in a table."""
    found = [line for line in page.replace("\\_", "_").splitlines() if f"| {name} |" in line]
    assert len(found) == 1, found
    return found[0].split(" | ")[-1].removesuffix(" |").replace("\u2009", "")


@pytest.mark.slow
def test_the_cases_without_an_answer_are_counted():
    """A speed below none is refused: of a normal one of 20 +/- 10, the share below 0."""
    with pytest.warns(col.OutOfRangeWarning, match="had no answer"):
        known = propagate(
            lambda speed_a: {"a.delta_v": np.where(speed_a > 0.0, 0.6 * speed_a, np.nan)},
            {"speed_a": Normal(20.0, 10.0)},
            samples=4096,
            seed=1,
        )
    assert known.failed == pytest.approx(0.02275 * known.samples, rel=0.1)
    assert f"{known.samples} cases, {known.failed} without an answer" in page_of(known)
    whole = propagate(
        lambda speed_a: {"a.delta_v": 0.6 * speed_a}, {"speed_a": Normal(20.0, 1.0)}, seed=1
    )
    assert f"{whole.samples} cases, all with an answer" in page_of(whole)


@pytest.mark.slow
def test_bounds_have_no_shares_of_a_variance():
    """Two inputs of which only their ranges are known: no variance is spoken of."""
    known = propagate(
        lambda speed_a, restitution: {"a.delta_v": 0.5 * (1.0 + restitution) * speed_a},
        {"speed_a": Interval(18.0, 22.0), "restitution": Interval(0.1, 0.3)},
    )
    page = page_of(known)
    assert "variance from" not in page
    normal = propagate(
        lambda speed_a, restitution: {"a.delta_v": 0.5 * (1.0 + restitution) * speed_a},
        {"speed_a": Normal(20.0, 1.0), "restitution": Normal(0.2, 0.02)},
        seed=1,
    )
    # (1/20)^2 to (0.02/1.2)^2: nine tenths and one.
    page = page_of(normal)
    assert re.match(r"90( ± \d+)? %", text_of(page, "variance from speed of A before"))
    assert re.match(r"10( ± \d+)? %", text_of(page, "variance from restitution"))
    assert text_of(page, "sum of the shares") == "100 %"


@pytest.mark.parametrize(("mean", "known"), [(20.0, True), (16.8, True), (16.6, False)])
def test_a_bare_input_is_in_the_units_of_the_page_where_it_may_be_that_of_the_impact(mean, known):
    """Speed A is 20 m/s. A distribution of 1 m/s around a mean 3.2 deviations away may be about it
    (99.9 of 100 values are nearer than 3.29), one 3.4 away is taken for another number.
    """
    spread = propagate(
        lambda speed_a: {"a.delta_v": 0.6 * speed_a}, {"speed_a": Normal(mean, 1.0)}, seed=1
    )
    stated = text_of(page_of(spread), "speed of A before")
    if known:
        assert float(stated.split(" ")[0]) == pytest.approx(3.6 * mean, rel=1e-3)
        assert stated.endswith(" 3.6 km/h")
    else:
        assert stated.endswith("given without a unit")
        assert f"{mean:g}" in stated


@pytest.mark.slow
def test_figures_of_bare_numbers_have_the_unit_of_the_result():
    """A model that returns SI floats: the figures are in mph as the tables are, not in m/s without
    a unit.
    """
    known = propagate(
        lambda speed_a, restitution: {
            "a.delta_v": 0.5 * (1.0 + restitution) * speed_a,
            "x": speed_a,
        },
        {"speed_a": Normal(20.0, 1.0), "restitution": Normal(0.2, 0.02)},
        seed=1,
    )
    assert known["a.delta_v"].unit is None
    page = col.report(IMPACT, form="html", units="us", uncertainty=known)
    assert page.count("A: delta-V [mph]") == 1
    assert f"mean {known['a.delta_v'].mean / 0.44704:.1f} mph" in page
    assert "standard deviation 1.4 mph" in page
    assert ">x<" in page  # What is no result of it stays as it was.
