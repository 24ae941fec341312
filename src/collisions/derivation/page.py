"""The page: headings, sentences, equations and tables, put down once and printed as Markdown with LaTeX or as plain text."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

from .expressions import Expression, Pen, Symbol, converted
from .rounding import System, powers_of

_MARKS = re.compile(r"([\\`*_{}\[\]<>$|#~])")


class Page:
    """What is written, in order. ``off`` holds of each equation how far it is off its result, and the size of its terms."""

    def __init__(self, system: System, latex: bool, deviations: Mapping[str, float]) -> None:
        self.system, self.latex = system, latex
        self.deviations = dict(deviations)
        self.parts: list[str] = []
        self.off: list[tuple[str, float, float]] = []

    def title(self, text: str) -> None:
        """The heading of the page."""
        self.parts.append(f"# {text}" if self.latex else f"{text.upper()}\n{'=' * len(text)}")

    def heading(self, text: str) -> None:
        """The heading of a part."""
        self.parts.append(f"## {text}" if self.latex else f"{text}\n{'-' * len(text)}")

    def say(self, text: str) -> None:
        """A sentence or more."""
        self.parts.append(text)

    def stress(self, text: str) -> None:
        """What must not be read over."""
        self.parts.append(f"**{text}**" if self.latex else f"!! {text}")

    def table(self, head: tuple[str, str, str], rows: Sequence[tuple[str, str, str]]) -> None:
        """A table of three columns."""
        if self.latex:
            lines = [head, ("---", "---", "---"), *rows]
            self.parts.append("\n".join(f"| {' | '.join(line)} |" for line in lines))
            return
        wide = [max(len(row[i]) for row in (head, *rows)) for i in range(3)]
        lines = [head, ("-" * wide[0], "-" * wide[1], "-" * wide[2]), *rows]
        self.parts.append(
            "\n".join("  ".join(part.ljust(width) for part, width in zip(r, wide, strict=True)).rstrip() for r in lines)
        )

    def listed(self, lines: Sequence[str]) -> None:
        """A list."""
        self.parts.append("\n".join(f"- {line}" for line in lines))

    def name(self, text: str) -> str:
        """A name that somebody gave, so that none of its signs is taken for markup."""
        plain = " ".join(text.split())
        return _MARKS.sub(r"\\\1", plain) if self.latex else plain.replace("\\", "/").replace("$", "S")

    def letter(self, symbol: Symbol) -> str:
        """A symbol within a sentence."""
        return f"${symbol.latex}$" if self.latex else symbol.text

    def number(self, value: float, kind: str) -> str:
        """A number of the working within a sentence, with its unit."""
        label = self.system.label(kind)
        return self.system.working(value, kind) + (f" {label}" if label and math.isfinite(value) else "")

    def shown(self, symbol: Symbol) -> str:
        """A symbol and its number within a sentence."""
        return f"{self.letter(symbol)} = {self.number(symbol.value, symbol.kind)}"

    def answer(self, name: str, value: float, kind: str) -> str:
        """An answer, rounded to its standard deviation where one is known for the attribute of this name."""
        return self.system.answer(value, kind, self.deviations.get(name))

    def equation(self, caption: str, left: Symbol, right: Expression) -> Symbol:
        """Symbol = formula = numbers = what the symbol is worth: the number of the result, which the formula must give."""
        pen = Pen(self.latex, self.system)
        label = self.system.label(left.kind)
        numbers = converted(right.write(pen), self.system.scale(left.kind), powers_of(label), pen).text
        printed = self.system.working(left.value, left.kind)
        lines = [right.write(Pen(self.latex)).text]
        if numbers not in (lines[0], printed):
            lines.append(numbers)
        lines.append(printed + self.system.unit(left.kind, self.latex))
        self._lines(caption, left.write(Pen(self.latex)).text, lines)
        self._check(caption, left, right)
        return left

    def balance(self, caption: str, left: Expression, right: Expression, kind: str) -> None:
        """Formula = formula, in symbols, in numbers, and what both sides are worth."""
        symbols, pen = Pen(self.latex), Pen(self.latex, self.system)
        scale, powers = self.system.scale(kind), powers_of(self.system.label(kind))
        sides = [side.write(symbols).text for side in (left, right)]
        numbers = [converted(side.write(pen), scale, powers, pen).text for side in (left, right)]
        values = [self.system.working(side.value, kind) for side in (left, right)]
        lines = [sides[1], f"{numbers[0]} = {numbers[1]}", f"{values[0]} = {values[1]}{self.system.unit(kind, self.latex)}"]
        self._lines(caption, sides[0], lines[:1], lines[1:])
        self._check(caption, Symbol("", "", left.value, kind), right, left.size)

    def collected(self, caption: str, left: float, terms: Sequence[tuple[float, Symbol]], unit: str) -> None:
        """Number = numbers times letters that are still unknown; the numbers belong to the units printed."""
        right = ""
        for factor, symbol in terms:
            times = r"\," if self.latex else " * "
            size = self.system.figures(abs(factor))
            part = self._letters(symbol) if size == "1" else f"{size}{times}{self._letters(symbol)}"
            mark = "-" if factor < 0.0 else "+" if right else ""
            right += f" {mark} {part}" if right else f"{mark}{part}"
        held = f"{unit}, with the unknowns in {' and '.join(self.system.label(symbol.kind) for _, symbol in terms)}"
        self._lines(f"{caption}, in {held}", self.system.figures(left), [right])

    def _letters(self, symbol: Symbol) -> str:
        return symbol.latex if self.latex else symbol.text

    def _lines(self, caption: str, left: str, chain: Sequence[str], below: Sequence[str] = ()) -> None:
        if self.latex:
            body = " \\\\\n".join([f"{left} &= {chain[0]}", *(f"&= {line}" for line in chain[1:])])
            body = " \\\\\n".join([body, *(line.replace(" = ", " &= ", 1) for line in below)])
            whole = body if "\\\\" not in body else f"\\begin{{aligned}}\n{body}\n\\end{{aligned}}"
            self.parts.append(f"{caption}:\n\n$$\n{whole.replace('&=', '=') if whole is body else whole}\n$$")
            return
        pad = " " * (len(left) + 2)
        lines = [f"  {left} = {chain[0]}", *(f"{pad} = {line}" for line in chain[1:]), *(f"  {line}" for line in below)]
        self.parts.append("\n".join([f"{caption}:", *lines]))

    def _check(self, caption: str, left: Symbol, right: Expression, size: float = 0.0) -> None:
        """An equation whose form loses the digits that the result has kept says so, instead of seeming to be wrong."""
        apart = abs(left.value - right.value)
        self.off.append((caption, apart, size + right.size + left.size))
        if not apart <= self.system.half_unit(left.value, left.kind):
            self.say(
                "In this form the numbers cancel, or are too far apart for it: what is printed last is the result's own, "
                "worked out in a form that keeps its digits."
            )

    def text(self) -> str:
        """The whole page."""
        return "\n\n".join(self.parts) + "\n"
