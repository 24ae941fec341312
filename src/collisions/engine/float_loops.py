"""Prints a tape as a plain Python function of floats that repeats a step of one case."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .floats import WRITTEN, constant, made_of
from .tracing import TextTape, statements


def compile_loop(
    step: Callable[..., tuple[Any, ...]],
    fixed: tuple[Any, ...],
    moving: tuple[Any, ...],
    settings: tuple[Any, ...],
) -> Callable[..., Any]:
    """A step compiled to a function of floats (fixed, moving, most, note) that repeats it, and
    gives what moves at the end.

    ``fixed`` and ``moving`` are the NamedTuple types of what the step is given and of what it gives
    again; their numbers go in and out as flat tuples, of which the fields "sticks" and "active" are
    truths. It ends where the last one is false, or after ``most`` steps; ``note`` gets the numbers
    after each.
    """
    tape, kinds = TextTape(), (*fixed, *moving)
    fields = [field for kind in kinds for field in kind._fields]
    truths = ("sticks", "active")
    numbers = iter(
        [
            tape.input(at, np.bool_ if field in truths else np.float64)
            for at, field in enumerate(fields)
        ]
    )
    with np.errstate(all="ignore"):
        given = [kind(*(next(numbers) for _ in kind._fields)) for kind in kinds]
        wanted = [tape.operand(value).index for part in step(*given, *settings) for value in part]
    held = [f"f{at}" for at in range(len(fields) - len(wanted))]
    state = [f"s{at}" for at in range(len(wanted))]
    lines, found = statements(tape, wanted, held + state, WRITTEN, constant, step.__name__)
    whole = f"({', '.join(state)},)"
    ends = ["if note is not None:", f"    note({whole})", f"if not {state[-1]}:", "    break"]
    body = "\n        ".join([*lines, f"{whole} = ({', '.join(found)},)", *ends])
    source = (
        f"def function(fixed, moving, most, note=None):\n    ({', '.join(held)},) = fixed\n    "
        f"{whole} = moving\n    for _ in range(most):\n        {body}\n    return {whole}\n"
    )
    return made_of(source, step.__name__)
