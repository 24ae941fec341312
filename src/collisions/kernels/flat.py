"""A kernel printed as one plain Python function of floats: what it does, without the calls and choices on the way.

The kernel is recorded on a tape and printed expression by expression, so that the formulas are stated once and the bits are the
same. The function answers the cases in which nothing is unusual; for any other it gives None, and the kernel itself decides.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from .replay import CONSTANT, INPUT, Tape, Traced
from .status import Answer, Status

_WRITTEN = {
    np.add: "({} + {})",
    np.subtract: "({} - {})",
    np.multiply: "({} * {})",
    np.true_divide: "({} / {})",
    np.negative: "(-{})",
    np.absolute: "abs({})",
    np.sqrt: "sqrt({})",
    np.greater: "({} > {})",
    np.greater_equal: "({} >= {})",
    np.less: "({} < {})",
    np.less_equal: "({} <= {})",
    np.equal: "({} == {})",
    np.not_equal: "({} != {})",
    np.bitwise_and: "({} and {})",
    np.bitwise_or: "({} or {})",
    np.bitwise_xor: "({} != {})",
    np.where: "({1} if {0} else {2})",
}


class _FloatTape(Tape):
    """A tape whose choices stay choices."""

    def choose(self, condition: Any, yes: Any, no: Any) -> Traced:
        operands = tuple(self.operand(value) for value in (condition, yes, no))
        return self.keep(np.where, operands, np.where(*(operand.sample for operand in operands)))


@lru_cache(maxsize=64)
def flat(kernel: Callable[..., Answer], takes: tuple[str, ...], settings: tuple[Any, ...]) -> Callable[[Any], Answer | None]:
    """The function of inputs that a kernel with these settings is; it reads its numbers where ``takes`` says."""
    tape = _FloatTape()
    with np.errstate(all="ignore"):
        numbers = [tape.input(which, np.float64) for which in range(len(takes))]
        answers = [tape.operand(answer) for answer in kernel(*numbers, *settings)]
    fine, ok, _ = tape.made[answers[0].index][1]
    if tape.cells[ok].which != Status.OK:
        raise ValueError(f"{kernel.__name__} does not end by choosing whether its case is fine")
    wanted = [fine, *(answer.index for answer in answers[1:])]
    uses: dict[int, int] = dict.fromkeys(wanted, 1)
    for index in sorted(tape.made, reverse=True):
        if index in uses:
            for operand in tape.made[index][1]:
                uses[operand] = uses.get(operand, 0) + 1
    names: dict[int, str] = {}
    lines: list[str] = []
    read: set[int] = set()

    def name_of(index: int) -> str:
        cell = tape.cells[index]
        if cell.place == INPUT:
            read.add(cell.which)
            return f"x{cell.which}"
        if cell.place == CONSTANT:
            value = cell.which.item() if isinstance(cell.which, (np.ndarray, np.generic)) else cell.which
            return repr(value) if math.isfinite(value) else f"float('{value}')"
        return names[index]

    for index in sorted(uses.keys() & tape.made.keys()):
        function, operands = tape.made[index]
        parts = [name_of(operand) for operand in operands]
        negated = function is np.bitwise_xor and parts[1] == "True"
        written = f"(not {parts[0]})" if negated else _WRITTEN[function].format(*parts)
        if uses[index] == 1 and index not in wanted:
            names[index] = written
        else:
            names[index] = f"v{index}"
            lines.append(f"v{index} = {written}")
    returned = ", ".join(["OK", *(name_of(index) for index in wanted[1:])])
    condition = name_of(fine)
    first = ["a = inputs.a", "b = inputs.b", *(f"x{which} = {_reached(takes[which])}" for which in sorted(read))]
    body = "\n        ".join([*first, *lines])
    source = (
        f"def flat(inputs):\n    try:\n        {body}\n        if not {condition}:\n            return None\n"
        f"    except (ArithmeticError, TypeError, ValueError):\n        return None\n"
        f"    return new(Answer, ({returned}))\n"
    )
    found: dict[str, Any] = {"sqrt": math.sqrt, "OK": Status.OK, "Answer": Answer, "new": tuple.__new__}
    exec(compile(source, f"<{kernel.__name__} of floats>", "exec"), found)
    function_made: Callable[[Any], Answer | None] = found["flat"]
    return function_made


def _reached(name: str) -> str:
    return name if name.startswith(("a.", "b.")) else f"inputs.{name}"
