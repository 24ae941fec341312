"""``Page``: headings, sentences, equations and tables, printed as Markdown with LaTeX or as plain
text.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from decimal import Decimal, localcontext

from ..messages.errors import InternalError
from ..quantities.document import Document
from ..quantities.formatting import clock, typeset
from ..quantities.printed_tables import Part, in_markdown, ruled
from ..quantities.user_text import plain
from ..uncertainty.one_sided_output import range_in_words
from .expressions import CALCULATOR, Direction, Expression, Pen, System, is_zero
from .symbols import Symbol

# The most figures a line may add to those of the working; with them it has every digit of a float.
_MOST = 12
# The share of its largest term by which a formula may differ from the result. Rounding stays far
# below the first (1e-9 in ordinary scenes); from there both numbers are printed. Beyond the second
# one of the two is wrong.
_DIFFERS, _WRONG = 1e-6, 1e-3
# The columns of every table.
HEAD = ("of", "quantity", "value")
_MARKS = re.compile(r"([\\`*_{}\[\]<>$|#~])")


class Page:
    """The parts written so far, and the printed conversion factors by the units they convert."""

    def __init__(
        self,
        system: System,
        latex: bool,
        deviations: Mapping[str, float],
        ranges: Mapping[str, tuple[float, float]],
    ) -> None:
        self.system, self.latex, self.deviations, self.ranges = system, latex, deviations, ranges
        self.parts: list[str] = []
        self.answered: list[str] = []  # names of the answers written so far
        self.conversions: dict[tuple[str, str], str] = {}
        self._deeper = False
        self._values: dict[str, float] = {}  # of each symbol that was written

    def title(self, text: str) -> None:
        """The heading of the page."""
        self.parts.append(f"# {text}" if self.latex else f"{text.upper()}\n{'=' * len(text)}")

    def heading(self, text: str) -> None:
        """The heading of a part."""
        if self._deeper:
            self.parts.append(f"### {text}" if self.latex else f"{text}\n{'.' * len(text)}")
        else:
            self.parts.append(f"## {text}" if self.latex else f"{text}\n{'-' * len(text)}")

    @contextmanager
    def one_level_down(self) -> Iterator[None]:
        """What is written meanwhile has its headings one level below that of a part, and symbols of
        its own.
        """
        self._deeper, outer, self._values = True, self._values, {}
        try:
            yield
        finally:
            self._deeper, self._values = False, outer

    def say(self, text: str) -> None:
        """Write one or more sentences."""
        self.parts.append(text)

    def stress(self, text: str) -> None:
        """Write a sentence with emphasis."""
        self.parts.append(f"**{text}**" if self.latex else f"!! {text}")

    def table(self, rows: Iterable[tuple[str, str, str]]) -> None:
        """Write a table: subject, quantity, value."""
        body = list(rows)
        if self.latex:
            body = [(subject, quantity, typeset(value)) for subject, quantity, value in body]
        self.parts.append((in_markdown if self.latex else ruled)(Part(body, columns=HEAD)))

    def listed(self, lines: Sequence[str]) -> None:
        """A list."""
        self.parts.append("\n".join(f"- {line}" for line in lines))

    def name(self, text: str) -> str:
        """A user's name: unchanged in plain text, escaped in Markdown so that none of its
        characters is markup.
        """
        shown = plain(text)
        return _MARKS.sub(r"\\\1", shown) if self.latex else shown

    def symbol(self, symbol: Symbol) -> str:
        """A symbol within a sentence."""
        self._stands_for_one(symbol)
        return f"${symbol.latex}$" if self.latex else symbol.text

    def _stands_for_one(self, symbol: Symbol) -> None:
        """Refuse a symbol that stands for another value elsewhere on the page."""
        name = symbol.latex if self.latex else symbol.text
        value = self._values.setdefault(name, symbol.value)
        apart = abs(value - symbol.value)
        size = max(symbol.size, abs(value))
        if value != symbol.value and apart > _WRONG * size and not is_zero(apart, symbol.kind):
            what = f"{name} stands for {value:.6g} and for {symbol.value:.6g}, in SI"
            raise _defect(what, what, apart / size)

    def _unit(self, kind: str) -> str:
        """The unit behind a number, with the space before it."""
        label = self.system.label(kind)
        if not label or not self.latex:
            return self.system.unit(kind)
        return rf"\ \mathrm{{{label.replace('**2', '^2').replace('*', chr(92) + ',')}}}"

    def number(self, value: float, kind: str) -> str:
        """A number of the working within a sentence, with its unit."""
        return self.system.working(value, kind) + (
            self.system.unit(kind) if math.isfinite(value) else ""
        )

    def shown(self, symbol: Symbol) -> str:
        """A symbol and its number within a sentence."""
        return f"{self.symbol(symbol)} = {self.number(symbol.value, symbol.kind)}"

    def answer(self, name: str, value: float, kind: str) -> str:
        """An answer, rounded to its standard deviation where one is known for the attribute of this
        name; or with its range, and rounded to two figures of half its width.
        """
        self.answered.append(name)
        if name not in self.ranges:
            printed = self.system.answer(value, kind, self.deviations.get(name))
            return printed + clock(name, value)
        low, high = self.ranges[name]
        if not math.isfinite(low + high):
            bound = range_in_words(low, high, lambda end: self.system.answer(end, kind), "%")
            return f"{self.system.answer(value, kind)} ({bound})"
        half = 0.5 * (high - low)
        beside = value
        if kind == "angle":
            # On the turn of its range, which may go on beyond half a turn.
            beside += math.tau * round((low + half - value) / math.tau)
        printed = self.system.span(beside, beside, kind, half)
        ends = (self.system.span(end, end, kind, half) for end in (low, high))
        ranged = f"({next(ends).removesuffix(self.system.unit(kind))} to {next(ends)})"
        return f"{printed} {ranged}{clock(name, value)}"

    def equation(self, caption: str, left: Symbol, right: Expression) -> None:
        """Write symbol = formula = numbers = value: the result's own number, which the formula must
        give.

        A formula that is the symbol itself, as the magnitude of one component is, is not repeated.
        """
        differs = self._compared(caption, left, right, left.kind)
        printed = self.system.working(left.value, left.kind)
        (numbers,), fits = self._in_numbers([(right, left.value)], left.kind, right.size)
        symbol, formula = self._in_symbols(left), self._in_symbols(right)
        lines = [formula] * (formula not in (symbol, printed)) + [numbers] * (
            numbers not in (formula, printed)
        )
        self._lines(
            caption, symbol, [*lines, printed + self._unit(left.kind)], fits=fits or bool(differs)
        )
        self._say_difference(differs)

    def let(self, caption: str, latex: str, kind: str, formula: Expression) -> Symbol:
        """Write what a new symbol stands for; gives the symbol."""
        symbol = Symbol(latex, formula.value, kind, size=formula.size)
        self.equation(caption, symbol, formula)
        return symbol

    def balance(self, caption: str, left: Expression, right: Expression, kind: str) -> None:
        """Write a balance, formula = formula: in symbols, in numbers, and the value of
        both sides.
        """
        differs = self._compared(caption, left, right, kind)
        sides = (left, right)
        numbers, fits = self._in_numbers(
            [(side, side.value) for side in sides], kind, left.size + right.size
        )
        values = " = ".join(self.system.working(side.value, kind) for side in sides) + self._unit(
            kind
        )
        below = [" = ".join(numbers), values]
        self._lines(
            caption, self._in_symbols(left), [self._in_symbols(right)], below, fits or bool(differs)
        )
        self._say_difference(differs)

    def fact(self, text: str, *equal: tuple[Symbol, Expression]) -> None:
        """Write a sentence that says of each of these symbols that it has the value beside it."""
        differs = [self._compared(text, symbol, value, symbol.kind) for symbol, value in equal]
        self.say(text)
        for difference in differs:
            self._say_difference(difference)

    def check(self, caption: str, left: Symbol, right: Expression) -> None:
        """Compare a number of the result with a formula for it that the page need not show."""
        self._say_difference(self._compared(caption, left, right, left.kind))

    def at_most(self, low: Expression, high: Expression) -> None:
        """Compare what the next sentence rests on: the first is not above the second."""
        size = max(low.size, high.size)
        if low.value - high.value > _WRONG * size:
            one, other = (f"{self._in_symbols(side)} = {side.value:.6g}" for side in (low, high))
            what = f"that {one} is at most {other}, in SI"
            raise _defect(what, f"{what}, which it is not", (low.value - high.value) / size)

    def collected(
        self,
        caption: str,
        row: tuple[float, float, float],
        symbols: tuple[Symbol, Symbol],
        kind: str,
        more: int = 0,
    ) -> None:
        """Write number = numbers times unknown symbols; the numbers are in the units printed."""
        parts = [
            factor * self.system.converted(by.value, by.kind)
            for factor, by in zip(row[1:], symbols, strict=True)
        ]
        largest = max(map(abs, (row[0], *parts)))
        share = abs(row[0] - sum(parts)) / largest if largest else 0.0
        if share > _WRONG:
            raise _defect(
                caption, f"{caption}: the sides are {row[0]:.9g} and {sum(parts):.9g}", share
            )
        times, right = r"\," if self.latex else " * ", ""
        for factor, symbol in zip(row[1:], symbols, strict=True):
            name, size = self._in_symbols(symbol), self.system.figures(abs(factor), more=more)
            part = name if size == "1" else f"{size}{times}{name}"
            mark = "-" if factor < 0.0 else "+" if right else ""
            right += f" {mark} {part}" if right else f"{mark}{part}"
        unknown = " and ".join(self.system.label(symbol.kind) for symbol in symbols)
        left = self.system.figures(row[0], more=more)
        self._lines(
            f"{caption}, in {self.system.label(kind)}, with the unknowns in {unknown}",
            left,
            [right],
        )

    def figures_to_solve(
        self, rows: Sequence[tuple[float, float, float]], unknowns: tuple[Symbol, Symbol]
    ) -> int:
        """The additional figures that two linear equations need for their printed numbers to have
        the printed solution.
        """
        for more in range(_MOST + 1):
            (p, a, b), (q, c, d) = (
                [Decimal(self.system.figures(number, more=more)) for number in row] for row in rows
            )
            with localcontext(CALCULATOR):
                solved = ((p * d - q * b) / (a * d - b * c), (a * q - c * p) / (a * d - b * c))
                if all(
                    self._comes_to(one, by.value, by.kind, by.size)
                    for one, by in zip(solved, unknowns, strict=True)
                ):
                    return more
        return 0

    def text(self) -> Document:
        """The whole page."""
        return Document("\n\n".join(self.parts) + "\n", "markdown" if self.latex else "text")

    def _compared(self, caption: str, left: Expression, right: Expression, kind: str) -> str:
        """Compare both sides of an equation: a sentence where they differ by more than rounding
        does, else "".

        Where they differ by more than digits that cancelled can explain, the result or its
        derivation is wrong.
        """
        share = _share_apart(left, right, kind)
        if not share > _DIFFERS:
            return ""
        for more in range(_MOST + 1):
            result, own = (self.system.working(side.value, kind, more) for side in (left, right))
            if result != own:
                break
        more = min(more + 2, _MOST)
        result, own = (
            self.system.working(side.value, kind, more) + self.system.unit(kind)
            for side in (left, right)
        )
        if share > _WRONG:
            raise _defect(
                caption, f"{caption}: the result has {result}, its formula gives {own}", share
            )
        return (
            f"The two sides differ: the number of the result is {result}, and the formula, "
            f"worked out with all digits, gives {own}. That is {share:.1e} of the largest term, "
            "more than the rounding of an ordinary impact."
        )

    def _say_difference(self, difference: str) -> None:
        if difference:
            self.stress(difference)

    def _in_symbols(self, formula: Expression) -> str:
        pen = Pen(self.latex)
        with localcontext(CALCULATOR):
            text = formula.write(pen).text
        for symbol in pen.named:
            self._stands_for_one(symbol)
        return text

    def _in_numbers(
        self, sides: Sequence[tuple[Expression, float]], kind: str, size: float
    ) -> tuple[list[str], bool]:
        """Formulas in numbers with enough figures that they give the printed value; and whether any
        do.
        """
        for more in (*range(_MOST + 1), 0):
            pen = Pen(self.latex, self.system, more)
            unit = self.system.unit_of(kind)
            with localcontext(CALCULATOR):
                found = [side.write(pen).converted(unit, pen) for side, _ in sides]
                fits = all(
                    self._comes_to(one.worth, value, kind, size)
                    for one, (_, value) in zip(found, sides, strict=True)
                )
            if fits:
                break
        for one, number, other in pen.conversions:
            self.conversions[one, other] = max(
                self.conversions.get((one, other), ""), number, key=len
            )
        return [one.text for one in found], fits

    def _comes_to(self, worth: Decimal, value: float, kind: str, size: float) -> bool:
        """Whether the value of printed numbers, rounded half up, is the number printed for a
        value.
        """
        if not math.isfinite(value):
            return True  # "infinite" and "not known" promise no figures
        printed = Decimal(self.system.working(value, kind))
        half = self.system.half_unit(value, kind, size)
        away = printed - worth if printed < 0 else worth - printed
        return -half <= away < half and (away > -half or printed != 0)

    def _lines(
        self,
        caption: str,
        left: str,
        chain: Sequence[str],
        below: Sequence[str] = (),
        fits: bool = True,
    ) -> None:
        """Lines with the left side once, its equals below each other, and other equations
        ``below``.
        """
        if not self.latex:
            pad = " " * (len(left) + 2)
            lines = [
                f"  {left} = {chain[0]}",
                *(f"{pad} = {line}" for line in chain[1:]),
                *(f"  {line}" for line in below),
            ]
            self.parts.append("\n".join([f"{caption}:", *lines]))
        else:
            lines = [f"{left} &= {chain[0]}", *(f"&= {line}" for line in chain[1:])]
            lines += [line.replace(" = ", " &= ", 1) for line in below]
            formula = "\\begin{aligned}\n" + " \\\\\n".join(lines) + "\n\\end{aligned}"
            formula = formula if len(lines) > 1 else lines[0].replace("&=", "=")
            self.parts.append(f"{caption}:\n\n$$\n{formula}\n$$")
        if not fits:
            # Otherwise the line would seem to be wrong.
            self.say(
                "In this form the numbers cancel, or are too far apart for it: what is printed "
                "last is the result's own, worked out in a form that keeps its digits."
            )


def _share_apart(left: Expression, right: Expression, kind: str) -> float:
    """The difference of two sides over their largest term; NaN if a formula has no value, as its
    divisor cancelled.
    """
    off = left.value - right.value
    if (
        left.value == right.value
        or is_zero(off, kind)
        or (math.isnan(left.value) and math.isnan(right.value))
    ):
        return 0.0
    if math.isfinite(right.value) and not math.isfinite(left.value):
        return math.inf
    if right.lacks and not math.isnan(left.value):
        return math.inf  # a result of numbers that are not known
    if isinstance(right, Direction):
        # One direction has many angles.
        off = math.remainder(off, math.tau)
    return math.nan if math.isnan(off) else abs(off) / max(left.size, right.size)


def _defect(equation: str, what: str, share: float) -> InternalError:
    return InternalError(
        f"this result and its derivation contradict each other: {what}. They differ by "
        f"{share:.2g} of the largest term, and rounding does not do that: it is a defect of this "
        "library, in the result or in its derivation. Use neither of them, and report it with "
        "the record of the result, result.to_dict()",
        code="contradicts_derivation",
        equation=equation,
        share=share,
    )
