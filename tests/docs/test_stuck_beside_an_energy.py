"""What the page on reverse solvers says of contacts that slid beside an energy: it is made of the
numbers that were written, and a sample of these is measured again.
"""

from __future__ import annotations

from typing import Any

import pytest

from collisions.reconstruct import speeds_components
from scripts import FOLDER, benchmarks

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="the sdist has no benchmarks")


@pytest.fixture(scope="module")
def scripts() -> tuple[Any, Any]:
    return benchmarks("stuck_beside_an_energy"), benchmarks("stuck_beside_a_speed")


def test_every_crash_is_counted_once_at_the_limit_of_the_library(scripts: Any) -> None:
    script, shared = scripts
    found = script.load()
    assert found["settings"]["threshold"] == speeds_components._BEYOND
    assert len(found["rows"]) == 2 * len(shared.ERRORS) * len(shared.THRESHOLDS)
    for row in found["rows"]:
        assert sum(row[name] for name in shared.ANSWERS) == found["settings"]["crashes"]


def test_a_lower_limit_asks_more_often_and_is_silently_wrong_less_often(scripts: Any) -> None:
    script, shared = scripts
    rows = script.load()["rows"]
    for error in shared.ERRORS:
        silent, answered = (
            [
                sum(row[name] for row in rows if (row["error"], row["threshold"]) == (error, limit))
                for limit in (0.0, 0.1, 0.5, "inf")
            ]
            for name in ("wrong in silence", "right")
        )
        assert silent == sorted(silent)
        assert answered == sorted(answered)
        assert silent[1] < silent[-1]


@pytest.mark.slow
def test_it_is_measured_again(scripts: Any) -> None:
    """Answers at the end of an accuracy may fall to either side of it."""
    script, shared = scripts
    written = script.load()["rows"]
    again = shared.measured(script.crashes(), shared.ERRORS[1:], (speeds_components._BEYOND,))
    for row in again:
        (was,) = (
            one
            for one in written
            if [one[name] for name in ("error", "threshold", "regime")]
            == [row[name] for name in ("error", "threshold", "regime")]
        )
        assert all(abs(row[name] - was[name]) <= 1 for name in shared.ANSWERS)
