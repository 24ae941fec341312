"""Warnings about cases, silent for whoever counts the cases themselves."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from .errors import CollisionsWarning
from .units import callers_level

_quiet: ContextVar[bool] = ContextVar("quiet", default=False)


@contextmanager
def quietly() -> Iterator[None]:
    """While this lasts, and only for the thread it is in, nothing is said of refused cases and energy gains."""
    token = _quiet.set(True)
    try:
        yield
    finally:
        _quiet.reset(token)


def warn_of_cases(warning: CollisionsWarning) -> None:
    """Warn the first caller outside this package."""
    if not _quiet.get():
        warnings.warn(warning, stacklevel=callers_level())
