"""Warnings, given to the first caller outside this package; those about cases silent for whoever counts the cases."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

from .errors import CollisionsWarning

_quiet: ContextVar[bool] = ContextVar("quiet", default=False)


def warn(warning: CollisionsWarning) -> None:
    """Warn the first caller outside this package."""
    warnings.warn(warning, stacklevel=callers_level())


def warn_of_cases(warning: CollisionsWarning) -> None:
    """The same of refused cases and energy gains, unless somebody counts them."""
    if not _quiet.get():
        warn(warning)


@contextmanager
def quietly() -> Iterator[None]:
    """While this lasts, and only for the thread it is in, nothing is said of refused cases and energy gains."""
    token = _quiet.set(True)
    try:
        yield
    finally:
        _quiet.reset(token)


def callers_level() -> int:
    """The stack level of the first caller outside this package, where a warning belongs."""
    level = 1
    frame: Any = sys._getframe(1)
    package = __name__.partition(".")[0]
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame = frame.f_back
        level += 1
    return level
