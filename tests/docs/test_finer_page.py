"""The section on finer=: its table is of a run of the script, and shows what the page says."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from scripts import benchmarks

ROOT = Path(__file__).resolve().parent.parent.parent

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (ROOT / "benchmarks").is_dir(), reason="the sdist has no benchmarks"),
]


@pytest.fixture(scope="module")
def committed():
    return json.loads((ROOT / "docs" / "_generated" / "finer.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def script():
    return benchmarks("finer")


def test_a_quick_run_has_the_columns_of_the_committed_file(committed, script, tmp_path):
    path = tmp_path / "finer.json"
    command = [sys.executable, str(ROOT / "benchmarks" / "finer.py")]
    subprocess.run(
        [*command, "--quick", "--json", str(path)], check=True, capture_output=True, timeout=1200
    )
    quick = json.loads(path.read_text(encoding="utf-8"))
    of_committed = {(row["study"], row["model"]): set(row) for row in committed["rows"]}
    for row in quick["rows"]:
        assert set(row) == of_committed[row["study"], row["model"]]
        assert row["off"] < 0.5
    for found in (quick, committed):
        assert "nan" not in script.table(found["rows"])


def test_the_rows_are_all_studies_of_both_pairs(committed, script):
    assert [(row["study"], row["model"], row["finer"]) for row in committed["rows"]] == [
        (study, *pair) for study in script.STUDIES for pair in script.PAIRS
    ]


def test_the_table_shows_what_the_page_says(committed):
    for row in committed["rows"]:
        name = row["study"], row["finer"]
        assert row["calls"] < 0.2 * row["calls_alone"], name
        if row["study"] == "posterior":
            assert 1.0 < row["calls"] < 12.5, name
            assert row["off"] < 0.3, name
            # In standard errors of the difference of both runs.
            assert row["errors"] < 2.0, name
        else:
            assert row["off"] < 0.05, name
            assert row["off"] < 0.5 * row["off_cheap"], name
