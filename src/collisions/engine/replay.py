"""Prints a tape as numpy calls that write into buffers, so that a block of cases is worked out
without temporaries.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from .buffers import Program, allocate, slice_memory
from .tracing import Step, Tape, Traced, cast

# Buffers of blocks that are done, for the next ones: new pages would cost as much as some of the
# calls.
_BUFFER_POOL: list[tuple[Any, int, Any, list[Any]]] = []
_MOST_POOLED, _LARGEST_POOLED = 4, 4 * 2**20


def input_kind(value: Any) -> str | None:
    """What ``record`` has to know of an input: None for an array, the text of a 0 or a 1, which
    shorten a kernel, or "".
    """
    return None if isinstance(value, np.ndarray) else value.hex() if value in (0.0, 1.0) else ""


@lru_cache(maxsize=64)
def record(
    kernel: Callable[..., tuple[Any, ...]],
    settings: tuple[Any, ...],
    inputs: tuple[str | None, ...],
    dtype: Any,
    outputs: tuple[Any, ...],
) -> Program:
    """Trace a kernel whose inputs are arrays of ``dtype`` or plain numbers, each of its
    ``input_kind``.

    ``outputs`` has the dtype of each output, None for one that is not wanted; the first, the
    status, always is.
    """
    tape = Tape()
    operands = [
        float.fromhex(kind)
        if kind
        else tape.input(at, dtype)
        if kind is None
        else tape.input(at, np.float64, ())
        for at, kind in enumerate(inputs)
    ]
    written: dict[int, int] = {}
    constants: dict[int, Any] = {}
    with np.errstate(all="ignore"):
        for which, (answer, wanted) in enumerate(
            zip(kernel(*operands, *settings), outputs, strict=True)
        ):
            if wanted is not None and which and not isinstance(answer, Traced):
                constants[which] = answer
            elif wanted is not None:
                value = tape.operand(answer, None if isinstance(answer, Traced) else wanted)
                step, index = tape.steps[value.index], value.index
                if (
                    step.function is None
                    or index in written
                    or step.sample.dtype != wanted
                    or not step.sample.ndim
                ):
                    index = len(tape.steps)
                    tape.steps.append(Step(cast, (value.index,), np.zeros(1, wanted)))
                written[index] = which
    return allocate(tape, written, len(inputs), len(outputs), constants)


def replay(program: Program, inputs: Sequence[Any], outputs: Sequence[Any]) -> bool:
    """Run one block: the inputs, with arrays cut to the block, and slices of the wanted outputs to
    write to, None for others.

    Gives whether all its cases have answers.
    """
    # Taking from a list and putting back is safe between threads, and in a call within a call; to
    # look first would not be.
    try:
        owner, length, memory, buffers = _BUFFER_POOL.pop()
    except IndexError:
        owner, length, memory, buffers = None, 0, None, []
    if owner is not program or length != len(outputs[0]):
        length = len(outputs[0])
        memory, buffers = slice_memory(length, program.buffers, memory)
    numbers = [np.empty((), dtype) for dtype in program.numbers]
    arrays = [*map(np.asarray, inputs), *outputs, *program.constants, *numbers, *buffers]
    for function, chosen in program.calls:
        function(*chosen(arrays))
    ok = program.ok is not None and bool(arrays[program.ok].all())
    if ok:
        outputs[0].fill(0)
    else:
        for function, chosen in program.late:
            function(*chosen(arrays))
    if len(_BUFFER_POOL) < _MOST_POOLED and memory.size <= _LARGEST_POOLED:
        _BUFFER_POOL.append((program, length, memory, buffers))
    return ok
