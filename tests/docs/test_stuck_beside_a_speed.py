"""What the page on reverse solvers says of contacts that slid beside a known speed: it is made of
the numbers that were written, and a sample of these is measured again.
"""

from __future__ import annotations

from typing import Any

import pytest

from collisions.reconstruct import speeds_components
from scripts import FOLDER, benchmarks

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="the sdist has no benchmarks")


@pytest.fixture(scope="module")
def script() -> Any:
    return benchmarks("stuck_beside_a_speed")


def test_every_crash_is_counted_once(script: Any) -> None:
    found = script.load()
    assert len(found["rows"]) == 2 * len(script.ERRORS) * len(script.THRESHOLDS)
    for row in found["rows"]:
        assert sum(row[name] for name in script.ANSWERS) == found["settings"]["crashes"]
    assert script.table(found).count("\n") == len(found["rows"]) + 1


def test_what_the_page_says(script: Any) -> None:
    """The threshold is that of the library; a lower one asks more often, a higher one finds few."""
    found = script.load()
    assert found["settings"]["threshold"] == speeds_components._BEYOND
    for error in script.ERRORS:
        silent, needless = (
            [
                sum(
                    row[name]
                    for row in found["rows"]
                    if (row["error"], row["threshold"]) == (error, threshold)
                )
                for threshold in (0.0, 0.1, 0.5)
            ]
            for name in ("wrong in silence", "ambiguous, stuck right")
        )
        assert silent == sorted(silent)
        assert needless[0] > 1.3 * needless[1] > 1.3 * needless[2]
        (line,) = (
            one for one in script.summary(found).splitlines() if f"{error:.0%} | **0.1**" in one
        )
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        assert (cells[3], cells[5]) == (str(silent[1]), str(needless[1]))


@pytest.mark.slow
def test_it_is_measured_again(script: Any) -> None:
    """Answers at the end of an accuracy may fall to either side of it."""
    found = script.load()
    kept = speeds_components._BEYOND
    again = script.measured(script.crashes(), script.ERRORS[:1], (kept,))
    assert kept == speeds_components._BEYOND
    for row in again:
        (was,) = (
            one
            for one in found["rows"]
            if [one[name] for name in ("error", "threshold", "regime")]
            == [row[name] for name in ("error", "threshold", "regime")]
        )
        assert all(abs(row[name] - was[name]) <= 1 for name in script.ANSWERS)
