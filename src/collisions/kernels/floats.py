"""Prints a tape as one plain Python function of floats, which answers a single case."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from .elementwise import larger
from .status import Answer, Status
from .tracing import TextTape, statements

WRITTEN: dict[Any, str] = {
    np.add: "({} + {})",
    np.subtract: "({} - {})",
    np.multiply: "({} * {})",
    np.true_divide: "({} / {})",
    np.negative: "(-{})",
    np.absolute: "abs({})",
    np.fmax: "larger({}, {})",
    np.sqrt: "({} ** 0.5)",
    np.greater: "({} > {})",
    np.greater_equal: "({} >= {})",
    np.less: "({} < {})",
    np.less_equal: "({} <= {})",
    np.equal: "({} == {})",
    np.not_equal: "({} != {})",
    np.logical_not: "(not {})",
    np.bitwise_and: "({} and {})",
    np.bitwise_or: "({} or {})",
    np.bitwise_xor: "({} != {})",
    np.where: "({1} if {0} else {2})",
}


def compile_for_floats(
    kernel: Callable[..., tuple[Any, ...]], takes: tuple[str, ...], settings: tuple[Any, ...]
) -> Callable[[Any], Any]:
    """A kernel with these settings compiled to one plain function, which reads its numbers at the paths in ``takes``.

    Of a kernel that gives an ``Answer`` it answers only cases whose status is plainly OK. For any other case, and where Python
    raises, as in a division by 0, it returns None, and the caller runs the kernel itself.
    """
    tape = TextTape()
    with np.errstate(all="ignore"):
        numbers = [tape.input(which, np.float64) for which in range(len(takes))]
        given = kernel(*numbers, *settings)
        answers = [tape.operand(answer).index for answer in given]
    fine = tape.fine(answers[0]) if isinstance(given, Answer) else tape.operand(True).index
    if fine is None:
        raise ValueError(f"{kernel.__name__} does not end by choosing whether its case is fine")
    wanted = [fine, *(answers[1:] if isinstance(given, Answer) else answers)]
    paths = [path if path.startswith(("a.", "b.")) else f"inputs.{path}" for path in takes]
    lines, (condition, *found) = statements(tape, wanted, paths, WRITTEN, _constant, kernel.__name__)
    returned = f"new(Answer, (OK, {', '.join(found)}))" if isinstance(given, Answer) else f"({', '.join(found)})"
    body = "\n        ".join(["a = inputs.a", "b = inputs.b", *lines, f"if {condition}:"])
    source = (
        f"def function(inputs):\n    try:\n        {body}\n            return {returned}\n"
        f"    except (ArithmeticError, TypeError, ValueError):\n        pass\n    return None\n"
    )
    names: dict[str, Any] = {"larger": larger, "OK": Status.OK, "Answer": Answer, "new": tuple.__new__}
    exec(compile(source, f"<{kernel.__name__} of floats>", "exec"), names)
    compiled: Callable[[Any], Any] = names["function"]
    return compiled


def _constant(value: Any) -> str:
    return repr(value) if math.isfinite(value) else f"float('{value}')"
