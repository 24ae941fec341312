"""``warn`` attributes a warning to the caller's own line; ``quietly`` silences warnings about
refused cases.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeAlias

from .errors import CollisionsWarning

# Of samples of one: what a warning says without its numbers, its class and code, and how many cases
# it is of.
Noted: TypeAlias = tuple[str, type[CollisionsWarning], str, int]
_quiet: ContextVar[bool] = ContextVar("quiet", default=False)
_sampling: ContextVar[list[Noted] | None] = ContextVar("sampling", default=None)


def warn(warning: CollisionsWarning) -> None:
    """Warn at the line of the first caller outside this package."""
    level, package = 1, __name__.partition(".")[0]
    frame: Any = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame = frame.f_back
        level += 1
    warnings.warn(warning, stacklevel=level)


def warn_of_cases(warning: CollisionsWarning, count: int = 0, sentence: str = "") -> None:
    """Warn of what some cases show, unless within ``quietly``; of samples of one case, number and
    sentence are noted.
    """
    noted = _sampling.get()
    if not _quiet.get():
        warn(warning)
    elif sentence and noted is not None:
        noted.append((sentence, type(warning), warning.code, count))


def warn_of_samples(warning: CollisionsWarning) -> None:
    """Warn of what matters only where the cases are samples of one case: within
    ``quietly(noted)``.
    """
    if _sampling.get() is not None:
        warn(warning)


@contextmanager
def quietly(noted: list[Noted] | None = None) -> Iterator[None]:
    """Within this context, in this thread only, ``warn_of_cases`` is silent; with ``noted`` they
    are samples of one case.
    """
    token, sampled = _quiet.set(True), _sampling.set(noted)
    try:
        yield
    finally:
        _quiet.reset(token)
        _sampling.reset(sampled)
