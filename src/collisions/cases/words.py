"""Messages of the library in the words of a case file, with keys, tables and lists for arguments,
calls and tuples.
"""

from __future__ import annotations

import json
import re
from datetime import date, datetime, time
from inspect import signature
from typing import Any

from .. import uncertainty
from ..quantities.units import shown

DISTRIBUTIONS = {
    name: getattr(uncertainty, name)
    for name in ("Normal", "LogNormal", "Uniform", "Triangular", "Samples", "Interval", "Censored")
}
_LONGEST = 80  # characters of a value in a message
_CALL = re.compile(rf"\b({'|'.join(DISTRIBUTIONS)})(\.between)?\(((?:[^()]|\([^()]*\))*)\)")
# An argument and what it is given, up to the comma behind it.
_ARGUMENT = re.compile(r"(?:(\w+)=)?('[^']*'|\([^()]*\)|\[[^\]]*\]|[^,]+)(?:, |$)")
# What holds texts in quotes, which the rest leaves alone: items of a dict, tuples of texts, names
# of texts.
_WITH_TEXTS = (
    (r"(?:(?<=\{)|(?<=, ))'([\w.]+)': ", r"\1 = "),
    (r"=\(((?:'[^']*'(?:, )?)+)\)", r" = [\1]"),
    (r"\bgot \(('[^']*'(?:, '[^']*')*),?\)", r"got [\1]"),
    (r"\b(?:unknowns|inputs)\['([^']*)'\]", r"\1"),
    (r"\bContact\('([^']*)', '([^']*)', \.\.\.\)", r'[[contact]] with a = "\1", b = "\2"'),
    (r"\b(observed|limits|tolerance)\['([^']*)'\]", r'\1."\2"'),
    (
        r"; put the unit on the whole: .*?, or give numbers in SI",
        "; write numbers in SI, or texts with their units",
    ),
)
_QUOTED = re.compile(r"('[^']*'|\"[^\"]*\")")
_PART = r"(?:-?[\d.]+(?:e[-+]\d+)?|-?inf|n?[xy]|low|high|value|error|length|width|forward|left)"
_PYTHON = (
    # Pairs of numbers, or of one that a message names.
    (rf"(?<!\w)\(({_PART}(?:, {_PART})+)\)", r"[\1]"),
    (r"\((length, width, how [^()]*)\)", r"[\1]"),
    (r"\b([a-z_]\w*)=(?=[\w\[{-]|\.\d)", r"\1 = "),
    (r"\b([a-z_]\w*)=", r"\1"),
    (r"\bTrue\b", "true"),
    (r"\bFalse\b", "false"),
    (r"\bmay be left None\b", "may be left out"),
    (r"\bis None\b", "is not given"),
    (r"\branges go to collisions\.uncertainty\.propagate\b", "this key takes one number"),
    (r"\breconstruct\.(fit|posterior)\b", r"[\1]"),
    (r"\b(give|in|to) (its|a|the) Mover\b", r"\1 \2 [[mover]]"),
    (r"\b(give|in|to) (its|a|the) Contact\b", r"\1 \2 [[contact]]"),
    (r"\bgive its Mover (\w+)= too", r"give its [[mover]] \1 too"),
    (r"\bor use Vehicle\.barrier\(\)", "or leave out the pivot"),
    (r"\bis written into the model\b", "is written as a number"),
    (r"\ban array or a list\b", "a list"),
    (
        r"; (?:all|both) are in \.solutions\b|\bAll are in \.solutions; |\.solutions holds "
        r".*?\. (?=[A-Z])",
        "",
    ),
    (r"; many cases go in a numpy array\b", ""),
    (r"\bNone leaves a side open\b", "-inf or inf leaves a side open"),
    (
        r"\bwrite None for an end that is open\b",
        "write -inf for a lower end that is open, inf for an upper one",
    ),
    (r", or None\b", ""),
    (r", an array or a Quantity\b", " or a text"),
    (r"\bgot (?:int|float)$", "got a number; put it in quotes"),
    (r"\bgot dict\b", "got a table"),
    (r"\bgot (?:tuple|list)\b", "got a list"),
    (r" of type (?:bool|str|int|float|list|tuple|dict|date|time|datetime)\b", ""),
    (r"\ba dict (from|of|by|such)\b", r"a table \1"),
    (r"\ba (?:dict|tuple)\b", "a list"),
)


def as_in_file(value: Any) -> str:
    """A value as a case file has it, shortened."""
    if isinstance(value, dict):
        text = f"{{ {', '.join(f'{key} = {as_in_file(part)}' for key, part in value.items())} }}"
    elif isinstance(value, (tuple, list)):
        text = f"[{', '.join(map(as_in_file, value))}]"
    elif isinstance(value, str):
        text = shown(value, _LONGEST)
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
    """A message with tables for calls, lists for tuples, and ``key = value`` for arguments; texts
    in quotes stay.
    """
    text = _CALL.sub(_distribution, text)
    for pattern, file in _WITH_TEXTS:
        text = re.sub(pattern, file, text)
    parts = _QUOTED.split(text)
    for at in range(0, len(parts), 2):
        if at + 1 < len(parts):
            parts[at] = re.sub(r"(\w)=$", r"\1 = ", parts[at])
        for pattern, file in _PYTHON:
            parts[at] = re.sub(pattern, file, parts[at])
    return "".join(parts)


def _distribution(call: re.Match[str]) -> str:
    """The call of a distribution as a text, or as a table."""
    name, between, inside = call.groups()
    given = [(key or "", value.strip("'")) for key, value in _ARGUMENT.findall(inside)]
    bare = [value for key, value in given if not key]
    if name == "Normal" and between and len(bare) == 3:
        return f'"{bare[0]} .. {bare[1]} (95 %)"'
    if name in ("Normal", "Uniform") and len(bare) == len(given) == 2:
        return f'"{bare[0]} {"+/-" if name == "Normal" else ".."} {bare[1]}"'
    names = list(signature(DISTRIBUTIONS[name]).parameters)
    named = [
        f"{key or names[at]} = {'...' if value in (key, *names) else value}"
        for at, (key, value) in enumerate(given)
    ]
    return f"{{ {name} = {{ {', '.join(named)} }} }}"
