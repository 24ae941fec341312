"""``warn`` attributes a warning to the caller's own line; ``quietly`` silences warnings about refused cases."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

from .errors import CollisionsWarning

_quiet: ContextVar[bool] = ContextVar("quiet", default=False)
_sampling: ContextVar[bool] = ContextVar("sampling", default=False)


def warn(warning: CollisionsWarning) -> None:
    """Warn at the line of the first caller outside this package."""
    warnings.warn(warning, stacklevel=callers_level())


def warn_of_cases(warning: CollisionsWarning) -> None:
    """Warn of refused cases or energy gains, unless within ``quietly``."""
    if not _quiet.get():
        warn(warning)


def warn_of_samples(warning: CollisionsWarning) -> None:
    """Warn of what matters only where the cases are samples of one: within ``quietly(samples=True)``."""
    if _sampling.get():
        warn(warning)


@contextmanager
def quietly(samples: bool = False) -> Iterator[None]:
    """Within this context, in this thread only, ``warn_of_cases`` is silent; with ``samples`` the cases are samples of one."""
    token, sampled = _quiet.set(True), _sampling.set(samples)
    try:
        yield
    finally:
        _quiet.reset(token)
        _sampling.reset(sampled)


def callers_level() -> int:
    """The ``stacklevel`` of the first caller outside this package, where a warning belongs."""
    level = 1
    frame: Any = sys._getframe(1)
    package = __name__.partition(".")[0]
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame = frame.f_back
        level += 1
    return level
