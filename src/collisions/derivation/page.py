"""The page: headings, sentences, equations and tables, put down once and printed as Markdown with LaTeX or as plain text."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

from .expressions import Expression, Pen, Symbol, Written, converted
from .rounding import System, powers_of

# Figures that a line may have beyond those of the working; with these it has all that there are.
_MOST = 12
_MARKS = re.compile(r"([\\`*_{}\[\]<>$|#~])")


class Page:
    """What is written, in order. ``off`` holds of each equation how far it is off its result, and the size of its terms."""

    def __init__(
        self,
        system: System,
        latex: bool,
        deviations: Mapping[str, float],
        ranges: Mapping[str, tuple[float, float]] | None = None,
    ) -> None:
        self.system, self.latex = system, latex
        self.deviations, self.ranges = dict(deviations), dict(ranges or {})
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
        """A name that somebody gave: as it is in plain text, in Markdown so that none of its signs is taken for markup."""
        plain = " ".join(text.split())
        return _MARKS.sub(r"\\\1", plain) if self.latex else plain

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
        """An answer, rounded to its standard deviation where one is known for the attribute of this name, or with its range."""
        printed = self.system.answer(value, kind, self.deviations.get(name))
        if name not in self.ranges:
            return printed
        low, high = (self.system.answer(end, kind) for end in self.ranges[name])
        return f"{printed} ({low.removesuffix(self.system.unit(kind, False))} to {high})"

    def equation(self, caption: str, left: Symbol, right: Expression) -> Symbol:
        """Symbol = formula = numbers = what the symbol is worth: the number of the result, which the formula must give."""
        printed = self.system.working(left.value, left.kind)
        (numbers,), fits = self._numbers([(right, left.value)], left.kind, right.size)
        lines = [right.write(Pen(self.latex)).text]
        if numbers not in (lines[0], printed):
            lines.append(numbers)
        lines.append(printed + self.system.unit(left.kind, self.latex))
        self._lines(caption, left.write(Pen(self.latex)).text, lines)
        self._check(caption, left, right, fits)
        return left

    def balance(self, caption: str, left: Expression, right: Expression, kind: str) -> None:
        """Formula = formula, in symbols, in numbers, and what both sides are worth."""
        symbols = Pen(self.latex)
        sides = [side.write(symbols).text for side in (left, right)]
        numbers, fits = self._numbers([(left, left.value), (right, right.value)], kind, left.size + right.size)
        values = [self.system.working(side.value, kind) for side in (left, right)]
        lines = [sides[1], f"{numbers[0]} = {numbers[1]}", f"{values[0]} = {values[1]}{self.system.unit(kind, self.latex)}"]
        self._lines(caption, sides[0], lines[:1], lines[1:])
        self._check(caption, Symbol("", "", left.value, kind), right, fits, left.size)

    def _numbers(self, sides: Sequence[tuple[Expression, float]], kind: str, size: float) -> tuple[list[str], bool]:
        """Formulas in numbers, with as many figures as it takes that they come to what is printed; and whether any do."""
        for more in range(_MOST + 1):
            found = [self._in_numbers(side, kind, more) for side, _ in sides]
            fits = all(self._comes_to(one.worth, value, kind, size) for one, (_, value) in zip(found, sides, strict=True))
            if fits:
                break
        else:
            found = [self._in_numbers(side, kind, 0) for side, _ in sides]
        for one in found:
            self.system.use(one.conversions)
        return [one.text for one in found], fits

    def _in_numbers(self, formula: Expression, kind: str, more: int) -> Written:
        pen = Pen(self.latex, self.system, more)
        return converted(formula.write(pen), self.system.scale(kind), powers_of(self.system.label(kind)), pen)

    def _comes_to(self, worth: float, value: float, kind: str, size: float) -> bool:
        """Whether printed numbers that are worth so much are, rounded, the number printed for a value."""
        if not math.isfinite(value):
            return True  # "infinite" and "not known" promise no figures
        printed = float(self.system.working(value, kind))
        # A little more than half a unit, for the rounding of what is just between two numbers.
        return abs(worth - printed) <= self.system.half_unit(value, kind, size) * (1.0 + 1e-9)

    def collected(self, caption: str, left: float, terms: Sequence[tuple[float, Symbol]], unit: str, more: int = 0) -> None:
        """Number = numbers times letters that are still unknown; the numbers belong to the units printed."""
        right = ""
        for factor, symbol in terms:
            times = r"\," if self.latex else " * "
            size = self.system.figures(abs(factor), more=more)
            part = self._letters(symbol) if size == "1" else f"{size}{times}{self._letters(symbol)}"
            mark = "-" if factor < 0.0 else "+" if right else ""
            right += f" {mark} {part}" if right else f"{mark}{part}"
        held = f"{unit}, with the unknowns in {' and '.join(self.system.label(symbol.kind) for _, symbol in terms)}"
        self._lines(f"{caption}, in {held}", self.system.figures(left, more=more), [right])

    def enough(self, rows: Sequence[tuple[float, float, float]], unknowns: tuple[Symbol, Symbol]) -> int:
        """How many more figures two equations (number, and factor of each unknown) need to have the printed solution."""
        for more in range(_MOST + 1):
            (p, a, b), (q, c, d) = ([float(self.system.figures(number, more=more)) for number in row] for row in rows)
            solved = ((p * d - q * b) / (a * d - b * c), (a * q - c * p) / (a * d - b * c))
            if all(self._comes_to(one, by.value, by.kind, by.size) for one, by in zip(solved, unknowns, strict=True)):
                return more
        return 0

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

    def _check(self, caption: str, left: Symbol, right: Expression, fits: bool, size: float = 0.0) -> None:
        """An equation whose form loses the digits that the result has kept says so, instead of seeming to be wrong."""
        self.off.append((caption, abs(left.value - right.value), size + right.size + left.size))
        if not fits:
            self.say(
                "In this form the numbers cancel, or are too far apart for it: what is printed last is the result's own, "
                "worked out in a form that keeps its digits."
            )

    def text(self) -> str:
        """The whole page."""
        return "\n\n".join(self.parts) + "\n"
