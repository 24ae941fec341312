"""Prints a tape as a JavaScript function, which a page can call without Python."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .floats import WRITTEN
from .tracing import TextTape, statements

_WRITTEN = WRITTEN | {
    np.absolute: "Math.abs({})",
    np.fmax: "fmax({}, {})",
    np.sqrt: "Math.sqrt({})",
    np.equal: "({} === {})",
    np.not_equal: "({} !== {})",
    np.logical_not: "!{}",
    np.bitwise_and: "({} && {})",
    np.bitwise_or: "({} || {})",
    np.bitwise_xor: "({} !== {})",
    np.where: "({} ? {} : {})",
    np.cos: "Math.cos({})",
    np.sin: "Math.sin({})",
    np.hypot: "Math.hypot({}, {})",
    np.arctan2: "Math.atan2({}, {})",
    np.floor: "Math.floor({})",
    np.fmod: "({} % {})",
    np.remainder: "remainder({}, {})",
}
# What JavaScript has no operator for: the larger of two that passes over NaN, and a remainder of
# the divisor's sign.
_HELPERS = """\
const fmax = (a, b) => (a >= b || b !== b ? a : b);
const remainder = (a, b) => { const r = a % b; return r !== 0 && r < 0 !== b < 0 ? r + b : r; };
"""


def javascript(function: Callable[..., Mapping[str, Any]], inputs: int) -> str:
    """A function of so many numbers as JavaScript: ``answer(x)`` gives an object of its outputs for
    the array ``x``.
    """
    tape = TextTape()
    with np.errstate(all="ignore"):
        outputs = function(*(tape.input(which, np.float64) for which in range(inputs)))
        wanted = [tape.operand(value).index for value in outputs.values()]
    names = [f"x[{which}]" for which in range(inputs)]
    lines, found = statements(
        tape, wanted, names, _WRITTEN, _constant, getattr(function, "__name__", "the function")
    )
    body = "".join(f"  const {line};\n" for line in lines)
    pairs = ", ".join(f'"{name}": {text}' for name, text in zip(outputs, found, strict=True))
    return f"{_HELPERS}function answer(x) {{\n{body}  return {{ {pairs} }};\n}}\n"


def _constant(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(int(value))
    if math.isfinite(value):
        return f"({value!r})" if math.copysign(1.0, value) < 0.0 else repr(value)
    return "NaN" if math.isnan(value) else "Infinity" if value > 0.0 else "(-Infinity)"
