"""Prints a tape as one plain Python function of floats, which answers one case."""

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
    kernel: Callable[..., tuple[Any, ...]],
    takes: tuple[str, ...],
    settings: tuple[Any, ...],
    refused: bool = False,
) -> tuple[Callable[[Any], Any], frozenset[int]]:
    """A kernel with these settings compiled to one plain function, which reads its numbers at the
    paths in ``takes``.

    A path is such as "restitution", "a.mass" or "normal[0]" of a dict, or "[3]" of a sequence. Of a
    kernel that gives an ``Answer`` it answers only cases whose status is plainly OK; with
    ``refused`` those of any status, of which a refused one has its status, closing speed, coupling
    and effective mass. For any other case, and where Python raises, as in a division by 0, it
    returns None, and the caller runs the kernel itself. Beside the function stands which of the
    numbers it reads to find out whether a case has an answer.
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
    if refused:
        wanted = [tape.operand(True).index, *answers]
    paths = [
        f"inputs[{path!r}]" if path.isidentifier() else f"inputs{path}" if path[0] == "[" else path
        for path in takes
    ]
    heads = dict.fromkeys(
        path.partition(".")[0].partition("[")[0] for path in takes if not path.isidentifier()
    )
    lines, (condition, *found) = statements(tape, wanted, paths, WRITTEN, constant, kernel.__name__)
    if isinstance(given, Answer):
        found[:refused] = [f"Status({found[0]})" if refused else "OK"]
    returned = f"new(made, ({', '.join(found)}))"
    read = [f"{head} = inputs[{head!r}]" for head in heads if head]
    body = "\n        ".join([*read, *lines, f"if {condition}:"])
    source = (
        f"def function(inputs):\n    try:\n        {body}\n            return {returned}\n"
        f"    except (ArithmeticError, TypeError, ValueError):\n        pass\n    return None\n"
    )
    return made_of(source, kernel.__name__, type(given)), judged_by(tape.steps, ok)


def made_of(source: str, name: str, kind: type = tuple) -> Callable[..., Any]:
    names: dict[str, Any] = {
        "larger": larger,
        "OK": Status.OK,
        "Status": Status,
        "made": kind,
        "new": tuple.__new__,
        "sqrt": math.sqrt,
        "inf": math.inf,
        "nan": math.nan,
    }
    exec(compile(source, f"<{name} of floats>", "exec"), names)
    made: Callable[..., Any] = names["function"]
    return made


def constant(value: Any) -> str:
    """A number as it is written in the function, which knows ``inf`` and ``nan`` by name."""
    return repr(int(value) if isinstance(value, Status) else value)
