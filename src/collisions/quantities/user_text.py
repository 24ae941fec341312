"""A user's text, such as the name of a vehicle, as it may be shown."""

from __future__ import annotations

import unicodedata

# Joiners, which some scripts need; other invisible characters could change how a line reads.
_JOINERS = "\u200c\u200d"


def plain(text: str) -> str:
    """A user's text in one line and without invisible characters."""
    return visible(" ".join(text.split()))


def visible(text: str) -> str:
    """A text with a visible mark in place of each invisible character."""
    shown_as_is = _JOINERS + "\n"
    hidden = [s for s in set(text) if unicodedata.category(s)[0] == "C" and s not in shown_as_is]
    return text.translate(dict.fromkeys(map(ord, hidden), "\ufffd")) if hidden else text
