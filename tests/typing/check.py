"""Asks mypy and pyright about the callers in this folder: each must refuse the lines that end in "#
refused", and no other.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
FILES = sorted(path for path in HERE.glob("*.py") if path.name != Path(__file__).name)


def output_of(*command: str) -> str:
    """What a checker prints; a checker that fails itself prints nothing that can be read below."""
    run = subprocess.run(
        [sys.executable, "-m", *command],
        cwd=HERE.parents[1],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    if run.returncode not in (0, 1):
        raise SystemExit(f"{command[0]} failed:\n{run.stdout}{run.stderr}")
    return run.stdout


def of_mypy() -> dict[tuple[str, int], str]:
    """What ``mypy --strict`` says of each line."""
    found = re.findall(
        r"^(.+?):(\d+): error: (.*)$", output_of("mypy", "--strict", *map(str, FILES)), re.MULTILINE
    )
    return {(Path(path).name, int(line)): text for path, line, text in found}


def of_pyright() -> dict[tuple[str, int], str]:
    """What pyright says of each line; files ask for its strict mode themselves."""
    report = json.loads(
        output_of("pyright", "--outputjson", "--pythonpath", sys.executable, *map(str, FILES))
    )
    errors = (note for note in report["generalDiagnostics"] if note["severity"] == "error")
    return {
        (Path(note["file"]).name, note["range"]["start"]["line"] + 1): note["message"]
        for note in errors
    }


def main() -> int:
    """Print every line on which a checker differs from what stands there."""
    lines = [
        (path.name, number, line)
        for path in FILES
        for number, line in enumerate(path.read_text("utf-8").splitlines(), 1)
    ]
    wanted = {(name, number) for name, number, line in lines if line.endswith("# refused")}
    differ = 0
    for checker, found in (("mypy", of_mypy()), ("pyright", of_pyright())):
        for name, number in sorted(wanted ^ found.keys()):
            differ += 1
            print(f"{name}:{number}: {checker}: {found.get((name, number), 'is not refused')}")
        print(f"{checker}: {len(FILES)} files, {len(wanted)} calls to refuse, {len(found)} refused")
    return 1 if differ else 0


if __name__ == "__main__":
    raise SystemExit(main())
