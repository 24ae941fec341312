"""What may ``import collisions`` load?

    python design/lazy_imports.py

Every script pays the import, and most need only the solvers and plain numbers, some only vehicles
and units. Each line is processor time of a fresh interpreter, the best of three.
``benchmarks/speed.py`` measures the import against its budget; here is what each part would add.

What it showed (2 cores, Python 3.11, numpy 2, pint 0.25): the package adds a tenth to importing
numpy, the solvers less than another, ``uncertainty`` a half, ``report`` one and a half to two; pint
alone costs two more, and a first unit, for which pint builds its registry, three to four. Decided:
pint when a unit first appears; the solvers, the upper half of the package, ``engine/batch.py``,
``records.py``, the thread pool, the choice of a model, the contact in time and the printer of
kernels when they are first used. What is left is for the most part Python making the classes that
every call needs.
"""

import subprocess
import sys

import measuring

BASE = "import numpy"
ADDED = {
    "collisions": "import collisions",
    "... and solvers": "import collisions.impact.solvers",
    "... and a batch": "import collisions.impact.solvers, collisions.engine.batch",
    "... and reconstruct": "import collisions.reconstruct",
    "... and uncertainty": "import collisions.uncertainty",
    "... and diagnose, explain": "import collisions.diagnostics, collisions.derivation",
    "... and report": "import collisions.reporting",
    "... and pint": "import collisions, pint",
    "... and a first unit": "import collisions; collisions.Vehicle(mass='1500 kg')",
}
TIMED = (
    "import sys, time; sys.path.insert(0, {!r}); t = time.process_time(); {}; "
    "print(time.process_time() - t)"
)


def seconds(code):
    """A fresh interpreter that runs the code and prints how long it took."""
    code = TIMED.format(str(measuring.ROOT / "src"), code)
    return float(
        subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            encoding="utf-8",
            check=True,
        ).stdout
    )


if __name__ == "__main__":
    best = {}
    for _ in range(1 if measuring.QUICK else 3):
        for name, code in {"numpy": BASE, **ADDED}.items():
            best[name] = min(best.get(name, 1e9), seconds(code))
    print("of importing numpy:")
    for name, time in best.items():
        print(f"  {name:30s} {time / best['numpy']:6.2f}")
