"""Reads the blind cases, and checks that none of their files has changed since it was fixed.

A case is a case file of the library. Of the texts that stand for numbers two are uncertain: "a +/-
b (95 %)", a normal distribution, and "a .. b", any value in between alike. All else is exact.
"""

from __future__ import annotations

import hashlib
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from collisions.uncertainty import Distribution, Normal, Uniform

HERE = Path(__file__).resolve().parent
HASHES = HERE / "inputs.sha256"
HALF_95 = 1.959963984540054  # standard deviations on each side of the mean that hold 95 percent
_NORMAL = re.compile(r"(\S+)(?: (\S+))? \+/- (\S+)(?: (\S+))? \(95 %\)")
_UNIFORM = re.compile(r"(\S+(?: \S+)?) \.\. (\S+(?: \S+)?)")


class ChangedInputError(AssertionError):
    """An input is not the one that was fixed before the measurements were read."""


def input_files(folder: Path = HERE) -> list[Path]:
    """Everything a prediction is made from."""
    return [
        *sorted((folder / "cases").glob("*.toml")),
        folder / "contact_in_time.toml",
        *sorted((folder / "sources").glob("*.csv")),
    ]


def hashes(folder: Path = HERE) -> str:
    """One line a file, as sha256sum writes them; line ends count as line feeds."""
    lines = []
    for path in input_files(folder):
        content = path.read_bytes().replace(b"\r\n", b"\n")
        lines.append(
            f"{hashlib.sha256(content).hexdigest()}  {path.relative_to(folder).as_posix()}\n"
        )
    return "".join(lines)


def check(folder: Path = HERE) -> None:
    """Refuse inputs that are not those that were fixed."""
    fixed = set((folder / HASHES.name).read_text(encoding="utf-8").splitlines())
    found = set(hashes(folder).splitlines())
    if fixed != found:
        names = sorted({line.partition("  ")[2] for line in fixed ^ found})
        raise ChangedInputError(
            f"inputs of blind cases that are not those of {HASHES.name}: {', '.join(names)}; a "
            "blind input is never changed"
        )


def number(text: Any) -> Any:
    """The distribution that a text states; anything else as it is."""
    if not isinstance(text, str):
        return text
    if found := _NORMAL.fullmatch(text):
        mean, unit, half, half_unit = found.groups(default="")
        return Normal(f"{mean} {unit}".strip(), f"{float(half) / HALF_95!r} {half_unit}".strip())
    if found := _UNIFORM.fullmatch(text):
        return Uniform(*found.groups())
    if "+/-" in text or ".." in text:
        raise ValueError(f"{text!r} is neither 'a +/- b (95 %)' nor 'a .. b'")
    return text


def middle(stated: Distribution | str) -> float:
    """The mean of what is stated, in SI."""
    if isinstance(stated, str):
        unit = stated.partition(" ")[2]
        stated = Normal(stated, f"1 {unit}")
    return float(stated.mean)


def flat(table: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Every number of nested tables and lists under its dotted name."""
    for name, value in table.items():
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{name}.")
        elif isinstance(value, list):
            yield from ((f"{prefix}{name}.{at}", number(part)) for at, part in enumerate(value))
        else:
            yield f"{prefix}{name}", number(value)


def case(path: Path) -> tuple[str, dict[str, Distribution | Any]]:
    """The title of a case and its numbers by name, those of the contact in time with them."""
    text = tomllib.loads(path.read_text(encoding="utf-8"))
    extra = tomllib.loads((HERE / "contact_in_time.toml").read_text(encoding="utf-8"))
    tables = {name: text[name] for name in ("a", "b", "eccentric")} | {"contact_in_time": extra}
    title = text["report"]["title"].removesuffix(", from inputs alone")
    return title, {name: value for name, value in flat(tables) if not name.endswith(".name")}


def cases() -> dict[str, tuple[str, dict[str, Distribution | Any]]]:
    """Every case by the name of its file."""
    return {path.stem: case(path) for path in sorted((HERE / "cases").glob("*.toml"))}
