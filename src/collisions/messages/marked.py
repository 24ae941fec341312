"""Marked sentences: code in a message stands between backquotes, so that a case file can have it in
its own words.

``"write `friction=0`"`` is printed without the marks. ``"`|a dict|a table`"`` has the words for a
caller in Python, and those for anyone else.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def plain(text: str) -> str:
    """The sentence as a caller in Python reads it."""
    return _translated(text, lambda code: code, False) if "`" in text else text


def in_other_words(text: str, words: Callable[[str], str]) -> str:
    """The sentence for anyone else: what these words make of its code."""
    return _translated(text, words, True)


def as_code(text: str) -> str:
    """A text, marked as code."""
    return f"`{text.translate(_OF_THE_TEXT)}`" if text else ""


def type_of(value: Any) -> str:
    """What kind of value was given, for a message."""
    name = type(value).__name__
    return f"`|{name}|{_KINDS.get(name, name)}`"


def a_type_of(value: Any) -> str:
    """The same with its article."""
    name = type(value).__name__
    return f"`|a {name}|{_KINDS.get(name, name)}`"


# What stands for these signs where they are no marks.
_OF_THE_TEXT, _BACK = str.maketrans("`|", "\0\1"), str.maketrans("\0\1", "`|")
_KINDS = dict.fromkeys(("list", "tuple"), "a list") | {
    "dict": "a table",
    "str": "a text",
    "bool": "true or false",
    "int": "a number",
    "float": "a number",
}


def _translated(text: str, words: Callable[[str], str], other_words: bool) -> str:
    parts = text.split("`")
    # A lone mark is a backquote in a name of the caller's.
    found = parts if len(parts) % 2 else [*parts[:-2], "`".join(parts[-2:])]
    for at in range(1, len(found), 2):
        before, *ways = found[at].split("|")
        if not before and len(ways) == 2:
            found[at] = ways[other_words].translate(_BACK)
        else:
            found[at] = words(found[at].translate(_BACK))
    return "".join(found)
