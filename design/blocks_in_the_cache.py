"""How should a kernel run over many cases: whole arrays, blocks, or blocks whose steps are replayed
in the same buffers?

    python design/blocks_in_the_cache.py

A formula of some hundred array operations on whole arrays moves every intermediate result through
memory, and numpy allocates each anew. In blocks the intermediates stay in the cache. Replayed, they
are a handful of buffers, given to numpy as ``out=``. Every input is an array here and all answers
are written; what the library takes of a naive formula by itself is measured in
``benchmarks/batch_speed.py``.

What it showed (2 cores, Python 3.11, numpy 2, a million cases), against whole arrays: blocks of
8192 take 0.48, replayed 0.17; blocks of 65536, which no longer fit the cache of a core, 0.92 and
0.28; blocks of 1024, where the calls themselves weigh, 0.60 replayed. Decided:
``engine/replay.py``, in blocks of 8192. The kernel stays a plain formula: its steps are recorded
from one run.
"""

from functools import partial

import numpy as np
from measuring import QUICK, batch_speed, compare

from collisions.engine.buffers import slice_memory
from collisions.engine.flattening import flattened, form_of, numbers_of
from collisions.engine.replay import record, replay
from collisions.kernels.eccentric import eccentric
from collisions.kernels.problem import Body, Contact, Problem
from collisions.kernels.status import EPS, Answer

CASES = 20_000 if QUICK else 1_000_000
SETTINGS = ("friction", "brach", EPS)
TYPES = {"status": np.dtype(np.uint8), "sticks": np.dtype(bool)}
KINDS = tuple(TYPES.get(name, np.dtype(float)) for name in Answer._fields)


def problem():
    """The cases of the benchmark."""
    scene = batch_speed.scenes(CASES)
    names = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y")
    a, b = (Body(*(scene[side][name] for name in names)) for side in "ab")
    normal = np.cos(scene["normal"]), np.sin(scene["normal"])
    contact = Contact(scene["restitution"], normal, scene["friction"], tuple(scene["point"]))
    return Problem(contact, a, b)


ARGUMENTS = (problem(),)
KERNEL = flattened(eccentric, form_of(ARGUMENTS))


def as_it_is(given, outputs):
    """The kernel itself on a block."""
    for output, answer in zip(outputs, KERNEL(*given, *SETTINGS), strict=True):
        output[...] = answer


def run(given, outputs, length, one):
    """All cases, block after block, each worked out by ``one``."""
    with np.errstate(all="ignore"):
        for start in range(0, CASES, length):
            block = slice(start, min(start + length, CASES))
            one(
                [value if isinstance(value, float) else value[block] for value in given],
                [output[block] for output in outputs],
            )


if __name__ == "__main__":
    given = numbers_of(ARGUMENTS)
    _, outputs = slice_memory(CASES, KINDS)
    texts = tuple(value.hex() if isinstance(value, float) else None for value in given)
    program = record(KERNEL, SETTINGS, texts, np.dtype(float), KINDS)
    ways = {"whole arrays": partial(run, given, outputs, CASES, as_it_is)}
    for length in (8192, 65536):
        ways[f"blocks of {length}"] = partial(run, given, outputs, length, as_it_is)
    for length in (1024, 8192, 65536):
        ways[f"blocks of {length}, replayed"] = partial(
            run, given, outputs, length, partial(replay, program)
        )
    print(f"{CASES} cases, of whole arrays:")
    compare(ways, "whole arrays", rounds=3)
