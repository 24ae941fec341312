"""The table of ranges in crashes that last: its numbers, and what is bold in it."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

pytestmark = pytest.mark.skipif(
    not (ROOT / "benchmarks").is_dir(), reason="the sdist has no benchmarks"
)


@pytest.fixture(scope="module")
def tables():
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        import coverage_tables
    finally:
        sys.path.pop(0)
    return coverage_tables


@pytest.mark.slow
def test_the_table_is_made_of_the_numbers_that_were_written(tables):
    """Every cell of every route; the exact binomial interval of what held."""
    stats = pytest.importorskip("scipy.stats")
    found = tables.load()
    rows = tables.coverage(found).splitlines()
    cells = [(route, cell, row) for route, all_ in found["lasting"].items()
             for cell, row in all_.items()]  # fmt: skip
    assert len(rows) == 2 + len(cells)
    for line, (route, cell, row) in zip(rows[2:], cells, strict=True):
        assert line.startswith(f"| **{route}** |" if cell == "all" else f"| – {cell} |")
        assert f"| {row['crashes']}: {row['refused']}, {row['warned']} |" in line
        assert (f" of {row['ranges']} |" in line) == (row["ranges"] > 0)
        assert row["ranges"] == row["held"] + row["above"] + row["below"]
        if row["ranges"]:
            exact = stats.binomtest(row["held"], row["ranges"]).proportion_ci(0.998, "exact")
            assert row["interval"] == pytest.approx((exact.low, exact.high), abs=1e-9)
            share = f"{100 * row['held'] / row['ranges']:.1f} %"
            assert (f"**{share}**" in line) == (exact.high < 0.95)
    for route, of in found["lasting"].items():
        parts = [row for cell, row in of.items() if cell != "all"]
        assert of["all"]["crashes"] == sum(row["crashes"] for row in parts) <= 150, route
