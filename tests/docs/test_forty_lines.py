"""Three jobs go from raw numbers to a filed report in at most forty lines each, imports included;
what shows pictures or checks stands after them.
"""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MOST = 40
JOBS = ("docs/one_crash.md", "examples/chain_of_three.py", "examples/pole_from_crush.py")
CELL = re.compile(r"^```\{code-cell\} ipython3\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SAVED = '.save("report.html")'


def code_of(path):
    """The code of a page or an example, down to the line that saves the report."""
    text = (ROOT / path).read_text(encoding="utf-8")
    if path.endswith(".md"):
        text = "\n".join(cell[1] for cell in CELL.finditer(text))
    lines = text.splitlines()
    return lines[: next(n for n, line in enumerate(lines) if line.endswith(SAVED)) + 1]


@pytest.mark.parametrize("path", JOBS)
def test_a_job_takes_forty_lines(path):
    """From the first import on: lines that are neither blank nor a comment."""
    lines = [line for line in code_of(path) if line.strip() and not line.startswith("#")]
    assert lines[0].startswith("import ")
    assert not any(line.strip().startswith("#") for line in lines)
    assert len(lines) <= MOST


@pytest.mark.parametrize("path", JOBS)
def test_its_lines_are_those_of_the_formatter(path):
    """No line has more on it than the formatter leaves there, and none is a workaround."""
    lines = [line for line in code_of(path) if not line.startswith("#")]
    code = "\n".join(lines) + "\n"
    assert ";" not in code
    formatted = subprocess.run(
        [sys.executable, "-m", "ruff", "format", "--isolated", "--line-length=88", "-"],
        input=code,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    if "No module named ruff" in formatted.stderr:
        pytest.skip("ruff is not installed")
    bare = [line for line in code.splitlines() if line.strip()]
    assert [line for line in formatted.stdout.splitlines() if line.strip()] == bare
