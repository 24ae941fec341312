"""Every design note still runs, and the list of them is whole."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

DESIGN = Path(__file__).resolve().parent.parent.parent / "design"
NOTES = sorted(path.name for path in DESIGN.glob("*.py") if path.stem != "measuring")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not DESIGN.is_dir(), reason="this copy has no design notes"),
]


@pytest.mark.parametrize("note", NOTES)
def test_a_note_runs_and_says_what_it_found(note, tmp_path):
    """From anywhere, without a warning; what it measures is not looked at."""
    done = subprocess.run(
        [sys.executable, "-W", "error", str(DESIGN / note), "--quick"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONIOENCODING": "utf-8"},
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=1200,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert len(done.stdout.splitlines()) > 2


def test_every_note_is_listed_with_its_command():
    """In the README of the folder and in its own docstring; each says what it showed and what was
    decided.
    """
    listed = (DESIGN / "README.md").read_text(encoding="utf-8")
    for note in NOTES:
        text = (DESIGN / note).read_text(encoding="utf-8")
        assert f"`python design/{note}`" in listed
        assert f"\n    python design/{note}\n" in text
        assert "What it showed" in text
        assert "Decided" in text
