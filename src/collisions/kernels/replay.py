"""Prints a tape as numpy calls that write into buffers, so that a block of cases is worked out without temporaries."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from .buffers import Program, placed
from .tracing import CODE, Step, Tape, Traced, cast

_PAGE = 4096


@lru_cache(maxsize=64)
def record(
    kernel: Callable[..., tuple[Any, ...]],
    settings: tuple[Any, ...],
    inputs: tuple[str | None, ...],
    dtype: Any,
    outputs: tuple[Any, ...],
) -> Program:
    """Trace a kernel whose inputs are arrays of ``dtype`` (None in ``inputs``) or plain numbers (as ``float.hex`` texts).

    ``outputs`` has the dtype of each output, None for one that is not wanted; the first, the status, always is.
    """
    tape = Tape()
    operands = [tape.input(at, dtype) if text is None else float.fromhex(text) for at, text in enumerate(inputs)]
    written: dict[int, int] = {}
    with np.errstate(all="ignore"):
        for which, (answer, wanted) in enumerate(zip(kernel(*operands, *settings), outputs, strict=True)):
            if wanted is not None:
                value = tape.operand(answer, None if isinstance(answer, Traced) else wanted)
                step, index = tape.steps[value.index], value.index
                if step.function is None or index in written or step.sample.dtype != wanted:
                    index = len(tape.steps)
                    tape.steps.append(Step(cast, (value.index,), np.zeros(1, wanted)))
                written[index] = which
    return placed(tape, written, len(inputs), len(outputs))


def aligned(length: int, dtype: Any) -> Any:
    """An empty array aligned to a memory page; numpy's own alignment can make a step over it take up to twice as long."""
    dtype = np.dtype(dtype)
    whole = np.empty(length * dtype.itemsize + _PAGE, dtype=CODE)
    start = -whole.ctypes.data % _PAGE
    return whole[start : start + length * dtype.itemsize].view(dtype)


class Replay:
    """A program with its own buffers for blocks of one length: one per thread."""

    def __init__(self, program: Program, length: int) -> None:
        self.program = program
        self.length = length
        self.buffers = [aligned(length, dtype) for dtype in program.buffers]

    def __call__(self, inputs: Sequence[Any], outputs: Sequence[Any]) -> None:
        """Run one block: the inputs, with arrays cut to the block, and slices of the outputs to write to."""
        length = len(outputs[0])
        buffers = self.buffers if length == self.length else [buffer[:length] for buffer in self.buffers]
        arrays = [*inputs, *outputs, *self.program.constants, *buffers]
        for function, chosen in self.program.calls:
            function(*chosen(arrays))
        if self.program.fine is not None and arrays[self.program.fine].all():
            outputs[0].fill(0)
            return
        for function, chosen in self.program.late:
            function(*chosen(arrays))
