"""The table of a recorder's report: columns by their heads, in SI, from CSV of three kinds."""

from __future__ import annotations

import csv
import io
import re
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from typing import Any

import numpy as np

from ..messages.errors import InputError
from ..quantities.reading import ArgumentReader
from ..quantities.units import shown

_LARGEST_FILE = 1_000_000  # bytes
_LONGEST_CELL = 200  # characters
_EXAMPLE = "time [ms],longitudinal [km/h],lateral [km/h]"
_CALLED = {"time": "time", "delta_v_forward": "longitudinal", "delta_v_left": "lateral"}
# Each column with its SI unit, and the words of a head that name it.
_COLUMNS = {
    "time": ("s", {"time", "t"}),
    "delta_v_forward": ("m/s", {"longitudinal", "long", "forward"}),
    "delta_v_left": ("m/s", {"lateral", "lat", "left", "right"}),
}
# The other words that leave a column what its name says. A head with any other word, number or
# sign may mean something else, such as an acceleration, a share or the opposite sign.
_SPEEDS, _CHANGES = {"speed", "v", "velocity"}, {"change", "delta", "dv", "deltav", "δv", "δ"}
_OF_DELTA_V = _SPEEDS | _CHANGES | {"axis", "crash", "cumulative", "of", "pulse", "recorded"}
_OF_SIGNS = {"is", "pos", "positive", "the", "to"}
_UNDERSTOOD = {
    "time": set(),
    "delta_v_forward": _OF_DELTA_V | _OF_SIGNS | {"x"},
    "delta_v_left": _OF_DELTA_V | _OF_SIGNS | {"from", "y"},
}
_MARKS = set(",.:;/_+=()[]")
_SIDES = {"49 CFR 563": "right", "ISO 8855": "left"}
# Standards that a head may name, by the side to which lateral is positive in them.
_STANDARDS = {
    r"\b(?:49\s+cfr\s+(?:part\s+)?|part\s+)563\b": "right",
    r"\bsae(?:\s+j\s?(?:211|1733))?\b": "right",
    r"\biso(?:\s+8855)?\b": "left",
}
# How reports write units, in lower case.
_UNITS = {
    **dict.fromkeys(("mph", "mi/h", "mi/hr"), "mph"),
    **dict.fromkeys(("km/h", "km/hr", "kmh", "kmph", "kph"), "km/h"),
    **dict.fromkeys(("m/s", "m/sec"), "m/s"),
    **dict.fromkeys(("ft/s", "ft/sec", "fps"), "ft/s"),
    **dict.fromkeys(("ms", "msec", "msecs", "milliseconds"), "ms"),
    **dict.fromkeys(("s", "sec", "secs", "seconds"), "s"),
}
# What stands for a number that the recorder does not have.
_NOT_AVAILABLE = {"sna", "n/a", "na", "not available", "data not available", "signal not available"}
# float() would read more: "1_0" as 10, digits of other scripts, "infinity".
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
# Of a number whose mark, a point or a comma, may be one of thousands.
_MAYBE_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:[.,][0-9]{3})+")
_WITH_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?")


def read_table(reader: ArgumentReader, path: str, polarity: str) -> dict[str, Any]:
    """Time and delta-V of a file in SI, by argument of ``recorded_pulse``.

    The lateral one is left out where the file has no such column, or none with numbers.
    """
    try:
        heads, rows, comma = _cells(_text(path))
        columns = _by_name(reader, heads, polarity)
        numbers = _numbers(rows, {name: at for name, (at, _) in columns.items()}, comma)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        text = f"time: the file {path!r} cannot be used: {why}; write {_EXAMPLE}, or give arrays"
        raise InputError(text, code="bad_file", argument="time") from None
    return {
        name: reader.number(f"1 {columns[name][1]}", _COLUMNS[name][0], f"unit of {name}") * column
        for name, column in numbers.items()
    }


def _text(path: str) -> str:
    with open(path, "rb") as file:
        data = file.read(_LARGEST_FILE + 1)
    if len(data) > _LARGEST_FILE:
        raise ValueError("it is larger than 1 MB, and the table of a pulse is a page")
    try:
        text = data.decode(
            "utf-16" if data.startswith((BOM_UTF16_LE, BOM_UTF16_BE)) else "utf-8-sig"
        )
    except UnicodeDecodeError:
        raise ValueError("it is no text in UTF-8; save it as CSV in UTF-8") from None
    if "\0" in text:
        raise ValueError("it holds NUL characters, so it is no text; save it as CSV in UTF-8")
    return text


def _cells(text: str) -> tuple[list[str], list[list[str]], bool]:
    """The heads, the rows that are not empty, and whether cells may have decimal commas."""
    first = next((line for line in text.splitlines() if line.strip()), "")
    bare = re.sub(r'"[^"]*"', "", first)
    separator = next((mark for mark in "\t;," if mark in bare), ",")
    try:
        # With its own line ends, which may stand within quotes.
        table = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
        heads, *rows = [
            [cell.strip() for cell in row] for row in table if any(cell.strip() for cell in row)
        ] or [[]]
    except csv.Error as error:
        raise ValueError(f"it is no table ({error})") from None
    if not heads:
        raise ValueError("it is empty")
    for number, row in enumerate([heads, *rows], 1):
        if long := next((cell for cell in row if len(cell) > _LONGEST_CELL), ""):
            raise ValueError(
                f"row {number} has a cell of {len(long)} characters, and may have {_LONGEST_CELL}"
            )
    # A separator at the end of every line makes a column of nothing.
    while (
        heads
        and not heads[-1]
        and all(len(row) < len(heads) or not row[len(heads) - 1] for row in rows)
    ):
        heads, rows = heads[:-1], [row[: len(heads) - 1] for row in rows]
    for number, row in enumerate(rows, 2):
        if len(row) != len(heads):
            quotes = f"a head with {shown(separator)} stands in quotes, and nothing above the heads"
            raise ValueError(
                f"row {number} has {len(row)} cells under {len(heads)} heads; it needs rows as "
                f"long; {quotes}"
            )
    return heads, rows, separator != ","


def _by_name(reader: ArgumentReader, heads: list[str], polarity: str) -> dict[str, tuple[int, str]]:
    """Place and unit of each column, in the order of the arguments, by the words of its head."""
    found: dict[str, tuple[int, str]] = {}
    for at, head in enumerate(heads):
        said, units = _parts(head)
        sides = {to for pattern, to in _STANDARDS.items() if re.search(pattern, said)}
        said = re.sub("|".join(_STANDARDS), " ", said)
        words = _words(said)
        names = [name for name, (_, own) in _COLUMNS.items() if own & set(words)]
        if len(names) == 1:
            _need_understood(head, words, names[0], _same_unit(units))
        else:
            may = " or ".join(_CALLED[name] for name in names)
            others = [] if names else _strange(words, "delta_v_left", set())
            says = f", and says {', '.join(map(repr, others))}" if others else ""
            raise ValueError(
                f"the head {shown(head)} may be "
                f"{may or 'neither time, longitudinal nor lateral'}{says}; each names one, and "
                "other columns are to be left out"
            )
        name = names[0]
        if name in found:
            raise ValueError(
                f"the heads {shown(heads[found[name][0]])} and {shown(head)} are both "
                f"{_CALLED[name]}"
            )
        sides |= _sides(words)
        if sides and sides != {_SIDES[polarity]}:
            raise ValueError(
                f"the head {shown(head)} says {' or '.join(sorted(sides))}, and by "
                f"`polarity={polarity!r}` lateral is positive to the {_SIDES[polarity]}"
            )
        found[name] = at, _unit(units, head)
    if missing := [_CALLED[name] for name in ("time", "delta_v_forward") if name not in found]:
        raise ValueError(
            f"it has no column whose head says {missing[0]!r}; its heads are "
            f"{', '.join(map(shown, heads))}"
        )
    return {name: found[name] for name in _COLUMNS if name in found}


def _parts(head: str) -> tuple[str, list[str]]:
    """What a head says beside its units, in lower case; and what stands in its brackets, round or
    square, as a unit.
    """
    groups: list[tuple[int, int]] = []
    depth = start = 0
    for at, mark in enumerate(head):
        if mark in "[(":
            start, depth = start if depth else at + 1, depth + 1
        elif mark in "])" and depth:
            depth -= 1
            if not depth:
                groups.append((start, at))
    # What is no unit may be said in brackets; where none is, the last is refused as one.
    units = [
        one
        for one in groups
        if any(mark in head[slice(*one)] for mark in "[(") or _is_unit(head, one)
    ] or groups[-1:]
    said = list(head)
    for start, end in units:
        said[start - 1 : end + 1] = " " * (end + 2 - start)
    return "".join(said).lower(), [head[slice(*one)].strip() for one in units]


def _is_unit(head: str, place: tuple[int, int]) -> bool:
    unit = _UNITS.get((text := head[slice(*place)].strip()).lower(), text)
    return any(_reads(unit, wanted) for wanted, _ in _COLUMNS.values())


def _words(said: str) -> list[str]:
    """Words, numbers and signs in turn, without marks that mean nothing."""
    # A hyphen joins two words, as in delta-V; elsewhere it is a minus.
    joined = re.sub(r"(?<=[^\W\d_])[-\u2010\u2011](?=[^\W\d_])", " ", said)
    found = re.findall(r"[^\W\d_]+|\d+(?:[.,]\d+)?|[^\w\s]|_", joined)
    return [word for word in found if word not in _MARKS]


def _strange(words: list[str], name: str, unit: set[str]) -> list[str]:
    """What is not known to belong to the head of a column, each once."""
    known = _COLUMNS[name][1] | _UNDERSTOOD[name] | unit
    return list(dict.fromkeys(word for word in words if word not in known))


def _same_unit(units: list[str]) -> set[str]:
    """The words of which each says the same unit as that in brackets."""
    given = {_UNITS.get(unit.lower(), unit) for unit in units}
    return {word for word, unit in _UNITS.items() if {unit} == given}


def _need_understood(head: str, words: list[str], name: str, unit: set[str]) -> None:
    """Refuse a head that says more than what its column has to be."""
    strange = _strange(words, name, unit)
    if name == "delta_v_left" and "from" in words and not _sides(words):
        strange.append("from")  # what it came from may be meant, or where it counts from
    if name != "time" and not strange and not _CHANGES & set(words):
        strange = [word for word in words if word in _SPEEDS]
    if strange:
        is_to_be = {
            "time": "time since the event began, rising from row to row",
            "delta_v_forward": "cumulative delta-V, positive forward",
            "delta_v_left": "cumulative delta-V, positive to the side of `polarity`",
        }[name]
        raise ValueError(
            f"the head {shown(head)} says {', '.join(map(repr, strange))}, which is not "
            f"understood, and the column has to be {is_to_be}; if it is, write "
            f"'{_CALLED[name]} [unit]' as its head"
        )


def _sides(words: list[str]) -> set[str]:
    """The sides to which a head says that lateral is positive."""
    sides = set(words) & {"left", "right"}
    text = " ".join(word for word in words if word != "the")
    if "from" in words or len(sides) == 2:  # as 49 CFR 563 has it, "left to right"
        to = {side for side in sides if f"to {side}" in text}
        return to or (set() if "from" in words else sides)
    return sides


def _unit(groups: list[str], head: str) -> str:
    """The unit in the brackets of a head, as this library writes it."""
    units = [_UNITS.get(group.lower(), group) for group in groups]
    if any(mark in unit for unit in units for mark in "[("):
        raise ValueError(
            f"the head {shown(head)} has two units; keep one of them, and its number in each cell"
        )
    if len(units) != 1:
        many = "has two units" if units else "has no unit"
        raise ValueError(f"the head {shown(head)} {many}, and needs one, its unit in brackets")
    return units[0]


def _reads(unit: str, wanted: str) -> bool:
    reader = ArgumentReader()
    reader.number(f"1 {unit}", wanted, "unit")
    return not reader.problems


def _numbers(rows: list[list[str]], places: dict[str, int], comma: bool) -> dict[str, Any]:
    """The columns as written, without what the recorder does not have.

    That may be a whole lateral column, and rows at the end.
    """
    parts = [name for name in places if name != "time"]
    missing = {
        name: [row[places[name]].lower() in _NOT_AVAILABLE for row in rows] for name in parts
    }
    if len(parts) == 2 and rows and all(missing["delta_v_left"]):
        parts, missing = parts[:1], {parts[0]: missing[parts[0]]}
    count = len(rows)
    while count and all(missing[name][count - 1] for name in parts):
        count -= 1
    for name in parts:
        if True in missing[name][:count]:
            at = missing[name].index(True)
            raise ValueError(
                f"{_CALLED[name]} is not available in row {at + 2}, and the table is read only "
                "where a whole column, or all of the last rows, are not; leave out the rows or "
                "the column that cannot be used"
            )
    cells = {name: [row[places[name]] for row in rows[:count]] for name in ("time", *parts)}
    texts = [cell for column in cells.values() for cell in column]
    commas = [cell for cell in texts if _WITH_COMMA.fullmatch(cell)]
    if commas and (points := [cell for cell in texts if "." in cell]):
        raise ValueError(
            f"{commas[0]!r} has a decimal comma and {points[0]!r} a point; write one of them "
            "throughout"
        )
    if commas and not comma:
        raise ValueError(
            f"{commas[0]!r} has a decimal comma, for which semicolons or tabs have to separate "
            "the columns"
        )
    for name, column in cells.items():
        _need_one_reading(name, column)
    return {
        name: np.array([_float(cell, at) for at, cell in enumerate(column, 2)])
        for name, column in cells.items()
    }


def _need_one_reading(name: str, column: list[str]) -> None:
    """Refuse a mark before three digits in a column whose other numbers do not show that it is a
    decimal one: that of thousands looks the same.
    """
    marked = {at: cell for at, cell in enumerate(column, 2) if set(cell) & {".", ","}}
    whole = [cell for cell in column if cell.strip("+-").isdecimal()]
    if marked and whole and all(map(_MAYBE_THOUSANDS.fullmatch, marked.values())):
        at, cell = next(iter(marked.items()))
        raise ValueError(
            f"{cell!r} in row {at} of {_CALLED[name]} may have a mark of thousands, as "
            f"{whole[0]!r} has no decimals; write all numbers of a column with as many decimals"
        )


def _float(cell: str, row: int) -> float:
    text = cell.replace(",", ".") if _WITH_COMMA.fullmatch(cell) else cell
    if _NUMBER.fullmatch(text) is None:
        raise ValueError(
            f"could not convert {shown(cell)} in row {row}; a cell is a number, such as -12.5, "
            "or SNA"
        )
    return float(text)
