"""Makers of refusals: what an argument must be, what was given, and what to write instead, each a
part of the error too.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..messages.errors import InputError
from .units import shown

# Of a lateral component whose sign is that of another convention.
LATERAL = (
    "recorders count lateral delta-V as positive to the right, delta_v_left is positive to the left"
)


def must_be(
    argument: str,
    allowed: str,
    given: Any,
    instead: str = "",
    *,
    code: str,
    kind: type[InputError] = InputError,
    got: str = "",
    named: str = "",
    **fields: Any,
) -> InputError:
    """The error for an argument that is not what it must be.

    ``instead`` follows with its own semicolon or colon, ``got`` says what was given in place of the
    value itself, and ``named`` is the argument as the caller wrote it, if another.
    """
    text = f"{argument} must be {allowed}, got {got or shown(given)}{instead}"
    fields = {"argument": named or argument, "given": given, "allowed": allowed} | fields
    if instead:
        fields["instead"] = instead
    if got:
        fields["got"] = got
    return kind(text, code=code, **fields)


def one_of(
    argument: str,
    choices: Iterable[Any],
    given: Any,
    instead: str = "",
    *,
    code: str,
    **fields: Any,
) -> InputError:
    """The error for an argument that is none of these choices."""
    listed = ", ".join(map(shown, choices))
    return must_be(argument, f"one of {listed}", given, instead, code=code, **fields)


def yes_or_no(argument: str, given: Any, instead: str = "", *, code: str) -> InputError:
    """The error for an argument that is neither True nor False."""
    return must_be(argument, "`True` or `False`", given, instead, code=code)
