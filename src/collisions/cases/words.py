"""Values, and the code in messages of the library, as a case file has them: keys, tables and lists
for arguments, calls and tuples.
"""

from __future__ import annotations

import ast
import json
from datetime import date, datetime, time
from inspect import signature
from typing import Any

from .. import uncertainty
from ..messages.marked import in_other_words
from ..quantities.units import rendered
from ..uncertainty.distribution import Statement

# All that can be stated of a quantity.
DISTRIBUTIONS: dict[str, Any] = {
    name: kind
    for name, kind in vars(uncertainty).items()
    if name in uncertainty.__all__ and isinstance(kind, type) and issubclass(kind, Statement)
    if kind is not uncertainty.Distribution
}
_STUDIES = ("fit", "posterior")  # functions of ``reconstruct`` that are tables of a file
_LONGEST = 80  # characters of a value in a message


def as_in_file(value: Any) -> str:
    """A value as a case file has it, shortened."""
    if isinstance(value, dict):
        text = f"{{ {', '.join(f'{key} = {as_in_file(part)}' for key, part in value.items())} }}"
    elif isinstance(value, (tuple, list)):
        text = f"[{', '.join(map(as_in_file, value))}]"
    elif isinstance(value, str):
        text = rendered(value, _LONGEST)
    elif isinstance(value, int) and abs(value) >= 2**64:
        text = hex(value)  # Python writes no more than 4300 decimal digits.
    elif isinstance(value, (datetime, date, time)):
        text = value.isoformat()
    else:
        text = (
            json.dumps(value, ensure_ascii=False).replace("Infinity", "inf").replace("NaN", "nan")
        )
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


def in_file_words(text: str) -> str:
    """A marked message with its code as a case file has it."""
    return in_other_words(text, _code)


def _code(code: str) -> str:
    """Arguments of a call in Python, or a value, as keys and values of a file."""
    try:
        call = ast.parse(f"_({code.removesuffix('=')})", mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return code  # what was given, shortened
    assert isinstance(call, ast.Call)
    parts = [_value(part, code) for part in call.args]
    return ", ".join(parts + [f"{one.arg} = {_value(one.value, code)}" for one in call.keywords])


def _value(node: ast.expr, code: str) -> str:
    """A value in Python as one of a file."""
    match node:
        case ast.Constant(value=bool(value)):
            return as_in_file(value)
        case ast.Constant(value=value) if value is ...:
            return "..."
        case ast.Constant(value=None):
            return "nothing"
        case ast.Tuple(elts=parts) | ast.List(elts=parts):
            return f"[{', '.join(_value(part, code) for part in parts)}]"
        case ast.Dict(keys=keys, values=values):
            pairs = zip(keys, values, strict=True)
            return f"{{{', '.join(f'{_key(k)} = {_value(v, code)}' for k, v in pairs)}}}"
        case ast.Attribute(value=ast.Name(id="reconstruct"), attr=name) if name in _STUDIES:
            return f"[{name}]"
        case ast.Subscript(value=ast.Name(id=table), slice=ast.Constant(value=str(key))):
            return key if table in ("inputs", "unknowns") else f'{table}."{key}"'
        case ast.Call(func=ast.Name(id=name)) if name in DISTRIBUTIONS:
            return _distribution(node, name)
        case ast.Call(func=ast.Attribute(value=ast.Name(id="Normal"), attr="between")):
            low, high = (_bare(end) for end in node.args[:2])
            return f'"{low} .. {high} (95 %)"'
        case _:
            return ast.unparse(node)


def _key(node: ast.expr | None) -> str:
    return str(node.value) if isinstance(node, ast.Constant) else ast.unparse(node or ast.Name("_"))


def _bare(node: ast.expr) -> str:
    """A value within a text."""
    return str(node.value) if isinstance(node, ast.Constant) else ast.unparse(node)


def _distribution(call: ast.Call, name: str) -> str:
    """The call of a distribution as a text, or as a table."""
    if name in ("Normal", "Uniform") and len(call.args) == 2 and not call.keywords:
        one, other = map(_bare, call.args)
        return f'"{one} {"+/-" if name == "Normal" else ".."} {other}"'
    names = list(signature(DISTRIBUTIONS[name]).parameters)
    given = [*zip(names, call.args, strict=False)] + [(k.arg, k.value) for k in call.keywords]
    # A name stands for a value that is not known here, as mean does in Normal(mean, sd).
    parts = [
        f"{key} = {'...' if isinstance(value, ast.Name) else _value(value, name)}"
        for key, value in given
    ]
    return f"{{ {name} = {{ {', '.join(parts)} }} }}"
