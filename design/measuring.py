"""What the notes share: where the package and its benchmarks are, and times of calls that run in
turn.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "src"), str(ROOT / "benchmarks")]

col, batch_speed, speed = (import_module(name) for name in ("collisions", "batch_speed", "speed"))

# To see that a note runs; its numbers then mean nothing.
QUICK = "--quick" in sys.argv[1:]


def compare(calls: dict[str, Callable[[], Any]], to: str, rounds: int = 21) -> None:
    """Print what each call costs of one of them: the median of the rounds, and the half of them
    around it.
    """
    works = {name: speed.Work(name, call) for name, call in calls.items()}
    times = speed.timed(works, 3 if QUICK else rounds, 0.0005 if QUICK else 0.01)
    for name in calls:
        found = speed.ratio(times, name, to)
        print(f"  {name:62s} {found['median']:8.3g}   ({found['low']:.3g} to {found['high']:.3g})")
