"""The time of an import, or of what people do first, against the import of numpy, each in a process
of its own; and ratios of times.
"""

from __future__ import annotations

import compileall
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
if str(ROOT / "src") not in sys.path:
    sys.path.insert(0, str(ROOT / "src"))

import speed_errors
import speed_rivals

Times = dict[str, list[float]]


def ratio(times: Times, one: str, other: str) -> dict[str, float]:
    """What one costs of the other: the median of the rounds and their quartiles."""
    each = [x / y for x, y in zip(times[one], times[other], strict=True)]
    low, median, high = statistics.quantiles(each, n=4, method="inclusive")
    return {
        "median": speed_errors.rounded(median),
        "low": speed_errors.rounded(low),
        "high": speed_errors.rounded(high),
    }


MODULES = ("numpy", "collisions", "collisions.impact.solvers", "pint", "numba", "pymunk")


# What people do first, in a process that has imported nothing.
FIRST = {
    "new": "from collisions.__main__ import main; main(['new'])",
    "texts": (
        "import collisions as col; "
        "a = col.Vehicle(mass='3500 lb', yaw_inertia='2000 slug*ft**2', vx='30 mph', x='-7 ft',"
        " y=0); "
        "b = col.Vehicle(mass='1200 kg', yaw_inertia='1700 kg*m**2', vy='40 km/h', x='0.6 m',"
        " y='-0.4 m'); "
        "col.eccentric(a, b, 0.1, normal='10 deg', point=(0, 0), friction=0.5).a.delta_v"
    ),
}
TIMED = (
    "import sys, time; t = time.perf_counter(); {0}; t = time.perf_counter() - t; "
    "print(t, 'pint' in sys.modules)"
)


def imports(count: int, modules: tuple[str, ...] = MODULES) -> dict[str, Any]:
    """The best import of so many, or the best of ``FIRST``, each in a process of its own, against
    the import of numpy; whether pint was loaded.

    The package is compiled first, as it is where it was installed.
    """
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(
            ROOT / "src" / "collisions",
            Path(folder) / "collisions",
            ignore=shutil.ignore_patterns("__pycache__"),
        )
        assert compileall.compile_dir(folder, quiet=1)
        path = os.pathsep.join([folder, *filter(None, [os.environ.get("PYTHONPATH")])])
        environment = {**os.environ, "PYTHONPATH": path}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        return _imports(count, modules, environment)


def _imports(count: int, modules: tuple[str, ...], environment: dict[str, str]) -> dict[str, Any]:
    names = [name for name in modules if name in FIRST or speed_rivals.installed(name)]
    found: Times = {name: [] for name in names}
    loaded = {}
    for turn in range(count + 1):
        for name in names[:: -1 if turn % 2 else 1]:
            printed = subprocess.run(
                [sys.executable, "-c", TIMED.format(FIRST.get(name, f"import {name}"))],
                env=environment,
                capture_output=True,
                text=True,
                encoding="utf-8",
                check=True,
            ).stdout.split()[-2:]
            if turn:  # the first one may have to compile
                found[name].append(float(printed[0]))
            loaded[name] = printed[1] == "True"
    rows = {}
    for name in dict.fromkeys((*MODULES, *modules)):
        rows[name] = None
        if name in found:
            best = speed_errors.rounded(min(found[name]) / min(found["numpy"]))
            rows[name] = {"best": best, **ratio(found, name, "numpy"), "loads_pint": loaded[name]}
    return {"best_of": count, "to": "numpy", "rows": rows}
