"""Prints a tape as numpy calls that write into buffers, so that a block of cases is worked out without temporaries."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from .buffers import Program, carved, placed
from .tracing import Step, Tape, Traced, cast

# Memory of runs that have ended, for the next ones: new pages would cost as much as some of the calls.
_SPARE: list[Any] = []
_MOST_SPARE, _LARGEST_SPARE = 4, 4 * 2**20


def input_kind(value: Any) -> str | None:
    """What ``record`` has to know of an input: None for an array, the text of a 0 or a 1, which shorten a kernel, or ""."""
    return None if isinstance(value, np.ndarray) else value.hex() if value in (0.0, 1.0) else ""


@lru_cache(maxsize=64)
def record(
    kernel: Callable[..., tuple[Any, ...]],
    settings: tuple[Any, ...],
    inputs: tuple[str | None, ...],
    dtype: Any,
    outputs: tuple[Any, ...],
) -> Program:
    """Trace a kernel whose inputs are arrays of ``dtype`` or plain numbers, each of its ``input_kind``.

    ``outputs`` has the dtype of each output, None for one that is not wanted; the first, the status, always is.
    """
    tape = Tape()
    operands = [
        float.fromhex(kind) if kind else tape.input(at, dtype) if kind is None else tape.input(at, np.float64, ())
        for at, kind in enumerate(inputs)
    ]
    written: dict[int, int] = {}
    constants: dict[int, Any] = {}
    with np.errstate(all="ignore"):
        for which, (answer, wanted) in enumerate(zip(kernel(*operands, *settings), outputs, strict=True)):
            if wanted is not None and which and not isinstance(answer, Traced):
                constants[which] = answer
            elif wanted is not None:
                value = tape.operand(answer, None if isinstance(answer, Traced) else wanted)
                step, index = tape.steps[value.index], value.index
                if step.function is None or index in written or step.sample.dtype != wanted or not step.sample.ndim:
                    index = len(tape.steps)
                    tape.steps.append(Step(cast, (value.index,), np.zeros(1, wanted)))
                written[index] = which
    return placed(tape, written, len(inputs), len(outputs), constants)


class Replay:
    """A program with its own buffers for blocks of one length: one per thread. ``close`` gives their memory back."""

    def __init__(self, program: Program, length: int) -> None:
        self.program = program
        self.length = length
        # Taking from a list and putting back is safe between threads, and in a call within a call.
        spare = _SPARE.pop() if _SPARE else None
        self.memory, self.buffers = carved(length, program.buffers, spare)
        self.numbers = [np.empty((), dtype) for dtype in program.numbers]

    def close(self) -> None:
        """Give the memory back."""
        if len(_SPARE) < _MOST_SPARE and self.memory.size <= _LARGEST_SPARE:
            _SPARE.append(self.memory)

    def __call__(self, inputs: Sequence[Any], outputs: Sequence[Any]) -> bool:
        """Run one block: the inputs, with arrays cut to the block, and slices of the wanted outputs to write to.

        Gives whether all its cases are fine.
        """
        length = len(outputs[0])
        buffers = self.buffers if length == self.length else [buffer[:length] for buffer in self.buffers]
        arrays = [*map(np.asarray, inputs), *outputs, *self.program.constants, *self.numbers, *buffers]
        for which, value in self.program.outputs.items():
            if outputs[which] is not None:
                outputs[which].fill(value)
        for function, chosen in self.program.calls:
            function(*chosen(arrays))
        if self.program.fine is not None and arrays[self.program.fine].all():
            outputs[0].fill(0)
            return True
        for function, chosen in self.program.late:
            function(*chosen(arrays))
        return False
