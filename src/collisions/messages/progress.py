"""Progress of long runs: a caller's function, or a bar."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeAlias

Progress: TypeAlias = Callable[[int, int], None] | bool
_PATIENCE = 1.0  # seconds before anything is shown


def reporter(progress: Progress | None) -> Callable[[int, int], None] | None:
    """The function to call with cases done and cases in all: the caller's own, or for True a
    progress bar.
    """
    return (progress if callable(progress) else Bar()) if progress else None


def halves(report: Callable[[int, int], None] | None) -> tuple[Any, Any]:
    """A reporter for a run that goes over its cases twice: a case counts as done after its second
    time.
    """
    if report is None:
        return None, None
    return lambda done, total: report(done // 2, total), lambda done, total: report(
        (total + done) // 2, total
    )


class Bar:
    """A bar of tqdm, or a line on stderr without it, once a run has taken a second."""

    def __init__(self) -> None:
        self.started = time.monotonic()
        self.bar: Any = None

    def __call__(self, done: int, total: int) -> None:
        if self.bar is None:
            if done == total or time.monotonic() - self.started < _PATIENCE:
                return
            try:
                self.bar = import_module("tqdm.auto").tqdm(
                    total=total, unit="case", unit_scale=True
                )
            except ImportError:
                self.bar = _Line(total)
        self.bar.update(done - self.bar.n)
        if done == total:
            self.bar.close()


class _Line:
    def __init__(self, total: int) -> None:
        self.total = total
        self.n = 0

    def update(self, more: int) -> None:
        self.n += more
        print(f"\r{self.n} of {self.total} cases", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        print(file=sys.stderr)
