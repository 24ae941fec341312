"""Formulas that are printed with their symbols and with their numbers, and can be worked out: one tree for all three."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from .rounding import Conversion, Powers, System, powers_of

_FUNCTIONS: dict[str, Callable[[float], float]] = {"sqrt": math.sqrt, "abs": abs, "cos": math.cos, "sin": math.sin}
# How firmly a written part holds together: what is looser than its place wants is put in brackets.
_SUM, _PRODUCT, _POWER, _ATOM = range(4)


class Pen(NamedTuple):
    """How to write: as LaTeX or as plain text, with the numbers of a system of units or, without one, with symbols.

    Numbers are written with ``more`` figures than the working promises; ``marked`` angles carry their own degree sign.
    """

    latex: bool
    system: System | None = None
    more: int = 0
    marked: bool = False


class Written(NamedTuple):
    """A written part: its text, how firmly it holds together, and by what the SI value was multiplied to print it.

    ``worth`` is what the numbers of the text come to as they are printed, and ``conversions`` are those among them.
    """

    text: str
    rank: int
    scale: float = 1.0
    powers: Powers = ()
    worth: float = math.nan
    conversions: tuple[Conversion, ...] = ()

    def within(self, rank: int, pen: Pen) -> str:
        """The text, in brackets where it is looser than that."""
        if self.rank >= rank:
            return self.text
        return rf"\left({self.text}\right)" if pen.latex else f"({self.text})"


class Expression:
    """A formula: what it is worth in SI, how large its terms are, and how it is written."""

    value: float
    size: float

    def write(self, pen: Pen) -> Written:
        """The formula as the pen has it."""
        raise NotImplementedError

    def __add__(self, other: Expression | float) -> Expression:
        return Sum(self, of(other), 1.0)

    def __radd__(self, other: float) -> Expression:
        return Sum(of(other), self, 1.0)

    def __sub__(self, other: Expression | float) -> Expression:
        return Sum(self, of(other), -1.0)

    def __rsub__(self, other: float) -> Expression:
        return Sum(of(other), self, -1.0)

    def __mul__(self, other: Expression | float) -> Expression:
        return Product(self, of(other))

    def __rmul__(self, other: float) -> Expression:
        return Product(of(other), self)

    def __truediv__(self, other: Expression | float) -> Expression:
        return Quotient(self, of(other))

    def __rtruediv__(self, other: float) -> Expression:
        return Quotient(of(other), self)

    def __neg__(self) -> Expression:
        return Negative(self)

    def squared(self) -> Expression:
        """Its square."""
        return Square(self)


class Symbol(Expression):
    """A quantity with a letter: what it is, and what it is worth in SI."""

    def __init__(self, latex: str, text: str, value: float, kind: str) -> None:
        self.latex, self.text, self.kind = latex, text, kind
        self.value = float(value)
        self.size = abs(self.value)

    def write(self, pen: Pen) -> Written:
        """Its letter, or its number."""
        if pen.system is None:
            return Written(self.latex if pen.latex else self.text, _ATOM)
        printed = pen.system.working(self.value, self.kind, pen.more)
        rank = _SUM if printed.startswith("-") else _ATOM
        worth = float(printed) if math.isfinite(self.value) else self.value
        label = pen.system.label(self.kind)
        if pen.marked and self.kind == "angle":
            printed += r"^\circ" if pen.latex else f" {label}"
        return Written(printed, rank, pen.system.scale(self.kind), powers_of(label), worth)


class Literal(Expression):
    """A number that belongs to the formula."""

    def __init__(self, value: float) -> None:
        self.value = value
        self.size = abs(value)

    def write(self, pen: Pen) -> Written:
        """The number itself."""
        return Written(f"{self.value:g}", _ATOM, worth=self.value)


class Sum(Expression):
    """Two terms, added or subtracted; in numbers both in the unit of the first."""

    def __init__(self, left: Expression, right: Expression, sign: float) -> None:
        self.left, self.right, self.sign = left, right, sign
        self.value = left.value + sign * right.value
        self.size = left.size + right.size

    def write(self, pen: Pen) -> Written:
        """Both terms with the sign between them."""
        left, right = self.left.write(pen), self.right.write(pen)
        if pen.system is not None:
            right = converted(right, left.scale, left.powers, pen)
        mark = "+" if self.sign > 0.0 else "-"
        text = f"{left.text} {mark} {right.within(_PRODUCT, pen)}"
        worth = left.worth + self.sign * right.worth
        return Written(text, _SUM, left.scale, left.powers, worth, left.conversions + right.conversions)


class Product(Expression):
    """Two factors."""

    def __init__(self, left: Expression, right: Expression) -> None:
        self.left, self.right = left, right
        self.value = left.value * right.value
        self.size = left.size * right.size

    def write(self, pen: Pen) -> Written:
        """Both factors; between numbers with a sign, between letters of LaTeX with a small space."""
        left, right = self.left.write(pen), self.right.write(pen)
        times = " * " if not pen.latex else r"\," if pen.system is None else r" \cdot "
        text = left.within(_PRODUCT, pen) + times + right.within(_PRODUCT, pen)
        scale, powers = left.scale * right.scale, multiplied(left.powers, right.powers, 1)
        return Written(text, _PRODUCT, scale, powers, left.worth * right.worth, left.conversions + right.conversions)


class Quotient(Expression):
    """One over another."""

    def __init__(self, over: Expression, under: Expression) -> None:
        self.over, self.under = over, under
        # What has cancelled to nothing gives no number, and the page says so.
        lost = under.value == 0.0
        self.value = math.nan if lost else over.value / under.value
        self.size = math.nan if lost else over.size / abs(under.value) * (under.size / abs(under.value))

    def write(self, pen: Pen) -> Written:
        """A fraction."""
        over, under = self.over.write(pen), self.under.write(pen)
        if pen.latex:
            text = rf"\frac{{{over.text}}}{{{under.text}}}"
        else:
            text = f"{over.within(_PRODUCT, pen)} / {under.within(_POWER, pen)}"
        scale, powers = over.scale / under.scale, multiplied(over.powers, under.powers, -1)
        worth = over.worth / under.worth if under.worth else math.nan
        return Written(text, _PRODUCT, scale, powers, worth, over.conversions + under.conversions)


class Negative(Expression):
    """With the other sign."""

    def __init__(self, inner: Expression) -> None:
        self.inner = inner
        self.value, self.size = 0.0 - inner.value, inner.size

    def write(self, pen: Pen) -> Written:
        """A minus sign before it."""
        inner = self.inner.write(pen)
        return inner._replace(text="-" + inner.within(_PRODUCT, pen), rank=_SUM, worth=-inner.worth)


class Square(Expression):
    """To the power of two."""

    def __init__(self, inner: Expression) -> None:
        self.inner = inner
        self.value, self.size = inner.value * inner.value, inner.size * inner.size

    def write(self, pen: Pen) -> Written:
        """With an exponent."""
        inner = self.inner.write(pen)
        held = inner.within(_ATOM, pen)
        if pen.latex and "'" in held and pen.system is None and inner.rank == _ATOM:
            held = f"{{{held}}}"
        text = held + ("^2" if pen.latex else "**2")
        powers = multiplied((), inner.powers, 2)
        return Written(text, _POWER, inner.scale**2, powers, inner.worth * inner.worth, inner.conversions)


class Function(Expression):
    """A function of one argument: a root, a magnitude, a cosine or a sine."""

    def __init__(self, name: str, inner: Expression) -> None:
        self.name, self.inner = name, inner
        self.value = _FUNCTIONS[name](inner.value)
        self.size = math.sqrt(inner.size) if name == "sqrt" else 1.0 + inner.size if name in ("cos", "sin") else inner.size

    def write(self, pen: Pen) -> Written:
        """With its argument in brackets, under the root sign or between bars."""
        if self.name in ("cos", "sin"):
            return self._of_angle(pen)
        inner = self.inner.write(pen)
        shape = rf"\sqrt{{{inner.text}}}" if self.name == "sqrt" else rf"\lvert {inner.text} \rvert"
        text = shape if pen.latex else f"{self.name}({inner.text})"
        if self.name == "abs":
            return inner._replace(text=text, rank=_ATOM, worth=abs(inner.worth))
        halved = tuple((label, power / 2) for label, power in inner.powers)
        worth = math.sqrt(max(inner.worth, 0.0))
        return Written(text, _ATOM, math.sqrt(inner.scale), halved, worth, inner.conversions)

    def _of_angle(self, pen: Pen) -> Written:
        degrees = pen.system is not None and pen.system.label("angle") == "deg"
        inner = self.inner.write(pen._replace(marked=degrees))
        worth = _FUNCTIONS[self.name](math.radians(inner.worth) if degrees else inner.worth)
        if not pen.latex:
            return Written(f"{self.name}({inner.text})", _POWER, worth=worth)
        held = inner.text if degrees and inner.rank == _ATOM else rf"\left({inner.text}\right)"
        return Written(rf"\{self.name} {held}" if held is inner.text else rf"\{self.name}{held}", _POWER, worth=worth)


class Direction(Expression):
    """The angle of a vector from its two components, counter-clockwise from the first axis."""

    def __init__(self, x: Expression, y: Expression) -> None:
        self.x, self.y = x, y
        self.value = math.atan2(y.value + 0.0, x.value)
        self.size = math.pi

    def write(self, pen: Pen) -> Written:
        """As calculators and computers have it, with the second component first."""
        y, x = self.y.write(pen), self.x.write(pen)
        name, left, right = (r"\operatorname{atan2}", r"\left(", r"\right)") if pen.latex else ("atan2", "(", ")")
        text = f"{name}{left}{y.text}, {x.text}{right}"
        if pen.system is None:
            return Written(text, _POWER)
        scale, worth = pen.system.scale("angle"), math.atan2(y.worth + 0.0, x.worth)
        label = pen.system.label("angle")
        return Written(text, _POWER, scale, powers_of(label), worth * scale, y.conversions + x.conversions)


def of(value: Expression | float) -> Expression:
    """An expression as it is, a number as one."""
    return value if isinstance(value, Expression) else Literal(float(value))


HALF = Quotient(Literal(1.0), Literal(2.0))


def total(*terms: Expression) -> Expression:
    """The sum of terms."""
    found = terms[0]
    for term in terms[1:]:
        found = found + term
    return found


def over(what: Expression, by: Expression) -> Expression:
    """One over another; over the reciprocal of a quantity, the product with that quantity."""
    if isinstance(what, Negative):
        return -over(what.inner, by)
    if isinstance(by, Quotient) and isinstance(by.over, Literal) and by.over.value == 1.0:
        return by.under * what
    return what / by


def root(inner: Expression) -> Expression:
    """The square root."""
    return Function("sqrt", inner)


def converted(written: Written, scale: float, powers: Powers, pen: Pen) -> Written:
    """A written part times what turns it into another unit."""
    assert pen.system is not None
    factor = scale / written.scale
    if abs(factor - 1.0) < 1e-9 or written.text == "0":
        return written._replace(scale=scale, powers=powers)
    conversion = pen.system.conversion(factor, written.powers, powers, pen.more)
    divides, number = conversion.divides, conversion.number
    held = written.within(_PRODUCT, pen)
    if pen.latex:
        text = rf"{held} \cdot \frac{{1}}{{{number}}}" if divides else rf"{held} \cdot {number}"
    else:
        text = f"{held} / {number}" if divides else f"{held} * {number}"
    worth = written.worth / float(number) if divides else written.worth * float(number)
    return Written(text, _PRODUCT, scale, powers, worth, (*written.conversions, conversion))


def multiplied(left: Powers, right: Powers, power: int) -> Powers:
    """The powers of units of a product."""
    found = dict(left)
    for label, exponent in right:
        found[label] = found.get(label, 0.0) + power * exponent
    return tuple((label, exponent) for label, exponent in sorted(found.items()) if exponent)
