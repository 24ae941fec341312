"""Prints a tape as one plain Python function of floats, which answers one case, or repeats a step
of one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..kernels.elementwise import larger
from ..kernels.status import Answer, Status
from .buffers import judged_by
from .tracing import TextTape, statements

WRITTEN: dict[Any, str] = {
    np.add: "({} + {})", np.subtract: "({} - {})", np.multiply: "({} * {})",
    np.true_divide: "({} / {})",
    np.negative: "(-{})", np.absolute: "abs({})", np.fmax: "larger({}, {})", np.sqrt: "sqrt({})",
    np.greater: "({} > {})", np.greater_equal: "({} >= {})", np.less: "({} < {})",
    np.less_equal: "({} <= {})",
    np.equal: "({} == {})", np.not_equal: "({} != {})", np.logical_not: "(not {})",
    np.bitwise_and: "({} and {})",
    np.bitwise_or: "({} or {})", np.bitwise_xor: "({} != {})", np.where: "({1} if {0} else {2})",
}  # fmt: skip


def compile_for_floats(
    kernel: Callable[..., tuple[Any, ...]], takes: tuple[str, ...], settings: tuple[Any, ...]
) -> Callable[[Any], Any]:
    """The function of ``compiled`` alone."""
    return compiled(kernel, takes, settings)[0]


def compiled(
    kernel: Callable[..., tuple[Any, ...]], takes: tuple[str, ...], settings: tuple[Any, ...]
) -> tuple[Callable[[Any], Any], frozenset[int]]:
    """A kernel with these settings compiled to one plain function, which reads its numbers at the
    paths in ``takes``.

    A path is such as "restitution", "a.mass" or "normal[0]" of a dict, or "[3]" of a sequence. Of a
    kernel that gives an ``Answer`` it answers only cases whose status is plainly OK. For any other
    case, and where Python raises, as in a division by 0, it returns None, and the caller runs the
    kernel itself. Beside the function stands which of the numbers it reads to find that out.
    """
    tape = TextTape()
    with np.errstate(all="ignore"):
        numbers = [tape.input(which, np.float64) for which in range(len(takes))]
        given = kernel(*numbers, *settings)
        answers = [tape.operand(answer).index for answer in given]
    ok = tape.ok(answers[0]) if isinstance(given, Answer) else tape.operand(True).index
    if ok is None:
        raise ValueError(
            f"{kernel.__name__} does not end by choosing whether its case has an answer"
        )
    wanted = [ok, *(answers[1:] if isinstance(given, Answer) else answers)]
    paths = [
        f"inputs[{path!r}]" if path.isidentifier() else f"inputs{path}" if path[0] == "[" else path
        for path in takes
    ]
    heads = dict.fromkeys(
        path.partition(".")[0].partition("[")[0] for path in takes if not path.isidentifier()
    )
    lines, (condition, *found) = statements(
        tape, wanted, paths, WRITTEN, _constant, kernel.__name__
    )
    returned = f"new(made, ({', '.join((['OK'] if isinstance(given, Answer) else []) + found)}))"
    read = [f"{head} = inputs[{head!r}]" for head in heads if head]
    body = "\n        ".join([*read, *lines, f"if {condition}:"])
    source = (
        f"def function(inputs):\n    try:\n        {body}\n            return {returned}\n"
        f"    except (ArithmeticError, TypeError, ValueError):\n        pass\n    return None\n"
    )
    return _made(source, kernel.__name__, type(given)), judged_by(tape.steps, ok)


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
    lines, found = statements(tape, wanted, held + state, WRITTEN, _constant, step.__name__)
    whole = f"({', '.join(state)},)"
    ends = ["if note is not None:", f"    note({whole})", f"if not {state[-1]}:", "    break"]
    body = "\n        ".join([*lines, f"{whole} = ({', '.join(found)},)", *ends])
    source = (
        f"def function(fixed, moving, most, note=None):\n    ({', '.join(held)},) = fixed\n    "
        f"{whole} = moving\n    for _ in range(most):\n        {body}\n    return {whole}\n"
    )
    return _made(source, step.__name__)


def _made(source: str, name: str, kind: type = tuple) -> Callable[..., Any]:
    names: dict[str, Any] = {
        "larger": larger,
        "OK": Status.OK,
        "made": kind,
        "new": tuple.__new__,
        "sqrt": math.sqrt,
    }
    exec(compile(source, f"<{name} of floats>", "exec"), names)
    made: Callable[..., Any] = names["function"]
    return made


def _constant(value: Any) -> str:
    value = int(value) if isinstance(value, Status) else value
    return repr(value) if math.isfinite(value) else f"float('{value}')"
