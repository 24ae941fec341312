"""A model run on drawn cases, block after block, until there are enough of them."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from .designs import REPLICATES, Design
from .draw import Joint
from .model import Model
from .sampled import Sampled

BLOCK = 16384
FIRST_BLOCK = 1024
MOST_SAMPLES = 2**24


class Sample:
    """The cases of a run: outputs by name, one value a case, as many as are done."""

    def __init__(self, model: Model, joint: Joint, design: Design, threads: int) -> None:
        self.model = model
        self.joint = joint
        self.design = design
        self.threads = threads
        self.done = 0
        self.interrupted = False
        self._outputs: dict[str, Any] = {}
        self._lock = threading.Lock()

    def extend(self, samples: int, progress: Callable[[int, int], None] | None = None) -> None:
        """Go on to this many cases in all; on a KeyboardInterrupt keep the cases up to the first that is missing."""
        blocks = _blocks(self.done, samples)
        self._grow(samples)
        try:
            for stop in self._each(blocks):
                self.done = stop
                if progress is not None:
                    progress(stop, samples)
        except KeyboardInterrupt:
            self.interrupted = True
            if self.done < 2 * REPLICATES:
                raise
        self._outputs = {name: values[: self.done] for name, values in self._outputs.items()}

    def outputs(self) -> dict[str, Any]:
        """Values by output, NaN where there is no answer."""
        return {name: values[: self.done] for name, values in self._outputs.items()}

    def failed(self) -> int:
        """Cases without an answer to at least one output."""
        return int(np.count_nonzero(np.any([np.isnan(values) for values in self.outputs().values()], axis=0)))

    def _each(self, blocks: list[tuple[int, int]]) -> Iterator[int]:
        """Every block worked out; how far the unbroken row of them reaches, in order."""
        if self.threads == 1 or len(blocks) < 2:
            for block in blocks:
                yield self._work(block)
            return
        from concurrent.futures import ThreadPoolExecutor

        with ThreadPoolExecutor(self.threads) as pool:
            try:
                yield from pool.map(self._work, blocks)
            except BaseException:
                pool.shutdown(wait=True, cancel_futures=True)
                raise

    def _work(self, block: tuple[int, int]) -> int:
        start, stop = block
        # Case i is place i // REPLICATES of sequence i % REPLICATES, so that any beginning holds as much of each.
        first, last = start // REPLICATES, -(-stop // REPLICATES)
        points = self.design(first, last).reshape(self.joint.dimensions, -1)
        offset = start - first * REPLICATES
        with np.errstate(all="ignore"):
            values = self.joint.values(points[:, offset : offset + stop - start])
        answers = self.model(values, stop - start, compare=start == 0)
        with self._lock:
            for name, values in answers.items():
                if name not in self._outputs:
                    self._outputs[name] = np.full(self._size, math.nan)
                self._outputs[name][start:stop] = values
        return stop

    def _grow(self, samples: int) -> None:
        self._size = samples
        for name, values in self._outputs.items():
            larger = np.full(samples, math.nan)
            larger[: self.done] = values[: self.done]
            self._outputs[name] = larger


def _blocks(start: int, stop: int) -> list[tuple[int, int]]:
    """From start to stop, the first ones smaller, so that a slow model soon tells how far it is and can be stopped."""
    found, size = [], BLOCK if start else min(FIRST_BLOCK, BLOCK)
    while start < stop:
        found.append((start, min(start + size, stop)))
        start, size = found[-1][1], min(2 * size, BLOCK)
    return found


def enough(sample: Sample, units: Mapping[str, str | None], tolerance: Mapping[str, float]) -> bool:
    """Whether the standard errors of mean, standard deviation and both ends of the 95 percent interval are all below it."""
    for name, most in tolerance.items():
        output = Sampled(name, units[name], sample.outputs()[name].copy(), dict)
        errors = [output.mean_standard_error, output.std_standard_error, *output.quantile_standard_error([0.025, 0.975])]
        if not max(errors) <= most:
            return False
    return True
