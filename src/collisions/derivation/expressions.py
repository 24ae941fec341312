"""``Expression``: formulas that can be written in symbols or in numbers and evaluated; and the
formatting of the numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from decimal import ROUND_HALF_UP, Context, Decimal
from functools import cache
from typing import Any, NamedTuple

from ..kernels.status import EPS
from ..quantities.formatting import Numbers, decimals_of, places, with_decimals

# Numbers in SI within this of 0 are rounding, and printed as 0.
_ZERO = {"impulse": 1e-8, "angular momentum": 1e-8, "energy": 1e-8, "per mass": 1e-15}
_ZERO_OF_OTHERS = 1e-10
_FIGURES = 4
_EXACT = 1e-9  # relative: a number this near to one of six figures is that number
_ROUNDED = 4.0 * EPS  # of the terms of a sum: what is left of them is their rounding

# Printed numbers are worked out in decimals, as a pocket calculator has them: in binary a half may
# come out below itself, and be rounded down. What has no value there is NaN.
CALCULATOR = Context(prec=40, rounding=ROUND_HALF_UP, traps=[])
_NO_WORTH = Decimal("nan")
_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sqrt": math.sqrt,
    "abs": abs,
    "cos": math.cos,
    "sin": math.sin,
}
# Operator precedence of a written part: one below that of its place is put in brackets.
SUM, _PRODUCT, _POWER, ATOM = range(4)


class Unit(NamedTuple):
    """The unit of a written number: its factor from SI, and its labels with their powers."""

    scale: float = 1.0
    powers: tuple[tuple[str, float], ...] = ()

    def times(self, other: Unit, power: float) -> Unit:
        """The unit of a product with a power of a number."""
        if not other.powers:
            return self
        powers = dict(self.powers)
        for label, exponent in other.powers:
            powers[label] = powers.get(label, 0.0) + power * exponent
        found = sorted((label, exponent) for label, exponent in powers.items() if exponent)
        return Unit(self.scale * other.scale**power, tuple(found))

    @property
    def name(self) -> str:
        """The unit as a product and quotient of labels."""
        over: list[str] = []
        under: list[str] = []
        for label, power in self.powers:
            size = abs(power)
            loose = ("/" in label and len(self.powers) > 1) or ("*" in label and power < 0.0)
            base = f"({label})" if loose or (size != 1.0 and not label.isalpha()) else label
            (over if power > 0.0 else under).append(base if size == 1.0 else f"{base}**{size:g}")
        return " / ".join([" * ".join(over) or "1", *under])


class System(Numbers):
    """Formats numbers in one system of units: as results and, with more figures, in the working.

    Parameters
    ----------
    system : {"si", "metric", "us"}
    in_degrees : iterable of str
        Of "angle" and "yaw rate", the kinds that are written in degrees in "si" too.
    """

    def __init__(self, system: str, in_degrees: Iterable[str] = ()) -> None:
        super().__init__(system)
        self.in_degrees = frozenset(in_degrees)

    def _decimals_of(self, kind: str) -> int | None:
        """The decimals of a result of this kind."""
        return decimals_of(kind, self.system_of(kind))

    def unit_of(self, kind: str) -> Unit:
        """The unit of a kind of quantity."""
        return _unit(self.label(kind), self.scale(kind))

    def working(self, value: float, kind: str, more: int = 0) -> str:
        """A number in the working: exact if six figures hold it, else four or the decimals of a
        result; ``more`` adds some.
        """
        if not math.isfinite(value):
            return "not known" if math.isnan(value) else "infinite"
        number = self.converted(value, kind)
        return "0" if is_zero(value, kind) else self.figures(number, self._decimals_of(kind), more)

    def figures(self, number: float, least: int | None = None, more: int = 0) -> str:
        """A number, exact if six figures hold it, else to four figures, with ``least`` decimals and
        at most two more.
        """
        exact = f"{number:.6g}"
        near = abs(float(exact) - number) <= _EXACT * 10.0 ** -max(more - 4, 0) * abs(number)
        if near and len(exact) <= 9 and "e" not in exact:
            return exact
        decimals = _decimals(number, least) + more
        # A half is rounded up, also where it is one but for the rounding of floats.
        finer = Decimal(f"{number:.13g}")
        if finer.as_tuple().exponent == -decimals - 1:
            return f"{finer.quantize(Decimal((0, (1,), -decimals)), context=CALCULATOR):f}"
        return with_decimals(number, decimals)

    def half_unit(self, value: float, kind: str, size: float) -> Decimal:
        """Half a unit, as printed, of the last of the figures that the working promises of this
        number.

        For a number that is 0, it is that of ``size``, the size of the terms that cancelled.
        """
        scale = self.scale(kind)
        if is_zero(value, kind) and 0.0 < size < math.inf:
            promised = _decimals(size * scale, None)
        else:
            promised = _decimals(value * scale, self._decimals_of(kind))
        last = max(len(self.working(value, kind).partition(".")[2]), promised)
        return Decimal((0, (5,), -last - 1))


@cache
def _unit(label: str, scale: float) -> Unit:
    if not label:
        return NO_UNIT
    return Unit(scale, ((label[2:], -1.0),) if label.startswith("1/") else ((label, 1.0),))


def is_zero(value: float, kind: str) -> bool:
    """Whether an SI number is so small for its kind that it is rounding, and printed as 0."""
    return abs(value) <= _ZERO.get(kind, _ZERO_OF_OTHERS)


def _decimals(number: float, least: int | None) -> int:
    """Decimals of a number in the working."""
    figures = places(number, _FIGURES)
    return max(figures if least is None else max(least, min(figures, least + 2)), 0)


NO_UNIT = Unit()


@dataclass(frozen=True, slots=True)
class Pen:
    """How to write: LaTeX or plain text; in the numbers of a system of units or, without one, in
    symbols.

    Numbers are written with ``more`` figures than the working promises; ``marked`` angles carry
    their own degree sign. ``conversions`` takes down each number that converts units, with the
    units that it stands between, and ``named`` each symbol that is written as such.
    """

    latex: bool
    system: System | None = None
    more: int = 0
    marked: bool = False
    conversions: list[tuple[str, str, str]] = field(default_factory=list)
    named: list[Any] = field(default_factory=list)


class Written(NamedTuple):
    """A written part: its text and precedence; for a number, its value as printed and its unit."""

    text: str
    rank: int
    worth: Decimal = _NO_WORTH
    unit: Unit = NO_UNIT

    def within(self, rank: int, pen: Pen) -> str:
        """The text, in brackets if its precedence is lower."""
        if self.rank >= rank:
            return self.text
        return rf"\left({self.text}\right)" if pen.latex else f"({self.text})"

    def converted(self, unit: Unit, pen: Pen) -> Written:
        """The part multiplied by the factor to another unit."""
        if self.unit is unit:
            return self
        factor = unit.scale / self.unit.scale
        if abs(factor - 1.0) < 1e-9 or self.text == "0":
            return self._replace(unit=unit)
        # A number to divide by is easier to recognize than its reciprocal below 1.
        divides = factor < 1.0
        size = 1.0 / factor if divides else factor
        number = f"{size:.{6 + pen.more}g}" if size < 999999.5 else f"{size:.{pen.more}f}"
        one, other = (unit, self.unit) if divides else (self.unit, unit)
        pen.conversions.append((one.name, number, other.name))
        if pen.latex:
            times = rf" \cdot \frac{{1}}{{{number}}}" if divides else rf" \cdot {number}"
        else:
            times = f" / {number}" if divides else f" * {number}"
        worth = self.worth / Decimal(number) if divides else self.worth * Decimal(number)
        return Written(self.within(_PRODUCT, pen) + times, _PRODUCT, worth, unit)


class Expression:
    """A formula: ``value`` in SI, ``size`` of its largest terms, whether it ``lacks`` a number that
    is not known, and ``write``, its form for a pen.

    A term of 0 and a factor of 1 are not written, and one over the reciprocal of a quantity is the
    product with that quantity.
    """

    def __init__(self, value: float, size: float, *parts: Expression) -> None:
        self.value, self.size = value, size
        # A formula without a value may have lost it by itself, and not for want of a number.
        self.lacks: bool = any(one.lacks for one in parts) if parts else math.isnan(value)

    def write(self, pen: Pen) -> Written:
        """The formula in the form that the pen writes."""
        raise NotImplementedError

    def plus(self, sign: float, other: Expression) -> Expression:
        """The sum with another, or the difference where the sign is negative."""
        if other.is_literal(0.0):
            return self
        if isinstance(other, Negative):
            return self.plus(-sign, other.inner)
        if self.is_literal(0.0):
            return other if sign > 0.0 else Negative(other)
        return Sum(self, other, 1.0 if sign > 0.0 else -1.0)

    def is_literal(self, value: float) -> bool:
        """Whether this is the literal number given."""
        return isinstance(self, Literal) and self.value == value

    def squared(self) -> Expression:
        """Its square."""
        return self if self.is_literal(0.0) else Square(self)

    def __add__(self, other: Expression | float) -> Expression:
        return self.plus(1.0, _expression(other))

    def __radd__(self, other: float) -> Expression:
        return Literal(other).plus(1.0, self)

    def __sub__(self, other: Expression | float) -> Expression:
        return self.plus(-1.0, _expression(other))

    def __rsub__(self, other: float) -> Expression:
        return Literal(other).plus(-1.0, self)

    def __neg__(self) -> Expression:
        return ZERO.plus(-1.0, self)

    def __mul__(self, factor: Expression | float) -> Expression:
        other = _expression(factor)
        if self.is_literal(0.0) or other.is_literal(1.0):
            return self
        return other if other.is_literal(0.0) or self.is_literal(1.0) else Product(self, other)

    def __rmul__(self, other: float) -> Expression:
        return Literal(other) * self

    def __truediv__(self, other: Expression | float) -> Expression:
        under = _expression(other)
        if isinstance(under, Quotient) and under.over.is_literal(1.0):
            return under.under * self
        return self if self.is_literal(0.0) or under.is_literal(1.0) else Quotient(self, under)

    def __rtruediv__(self, other: float) -> Expression:
        return Quotient(Literal(other), self)


class Literal(Expression):
    """A number that is part of the formula, such as 2 in m v^2 / 2."""

    def __init__(self, value: float) -> None:
        super().__init__(float(value), abs(value))

    def write(self, pen: Pen) -> Written:
        text = f"{self.value:g}"
        return Written(text, SUM if self.value < 0.0 else ATOM, Decimal(text))


def _expression(value: Expression | float) -> Expression:
    return value if isinstance(value, Expression) else Literal(value)


class Sum(Expression):
    """The sum or difference of two terms; in numbers both in the unit of the first."""

    def __init__(self, left: Expression, right: Expression, sign: float) -> None:
        self.left, self.right, self.sign = left, right, sign
        super().__init__(left.value + sign * right.value, left.size + right.size, left, right)

    def write(self, pen: Pen) -> Written:
        left, right = self.left.write(pen), self.right.write(pen)
        right = right.converted(left.unit, pen)
        text = f"{left.text} {'+' if self.sign > 0.0 else '-'} {right.within(_PRODUCT, pen)}"
        worth = left.worth + right.worth if self.sign > 0.0 else left.worth - right.worth
        return Written(text, SUM, worth, left.unit)


class Product(Expression):
    """The product of two factors."""

    def __init__(self, left: Expression, right: Expression) -> None:
        self.left, self.right = left, right
        super().__init__(left.value * right.value, left.size * right.size, left, right)

    def write(self, pen: Pen) -> Written:
        left, right = self.left.write(pen), self.right.write(pen)
        # Between numbers of LaTeX a sign, between its symbols a small space.
        times = " * " if not pen.latex else r"\," if pen.system is None else r" \cdot "
        text = left.within(_PRODUCT, pen) + times + right.within(_PRODUCT, pen)
        return Written(text, _PRODUCT, left.worth * right.worth, left.unit.times(right.unit, 1))


class Quotient(Expression):
    """A quotient; NaN if its divisor has cancelled to 0 or to rounding, which the page says."""

    def __init__(self, over: Expression, under: Expression) -> None:
        self.over, self.under = over, under
        if abs(under.value) <= _ROUNDED * under.size:
            super().__init__(math.nan, math.nan, over, under)
        else:
            size = over.size / abs(under.value) * (under.size / abs(under.value))
            super().__init__(over.value / under.value, size, over, under)

    def write(self, pen: Pen) -> Written:
        over, under = self.over.write(pen), self.under.write(pen)
        if pen.latex:
            text = rf"\frac{{{over.text}}}{{{under.text}}}"
        else:
            text = f"{over.within(_PRODUCT, pen)} / {under.within(_POWER, pen)}"
        worth = over.worth / under.worth if under.worth else _NO_WORTH
        return Written(text, _PRODUCT, worth, over.unit.times(under.unit, -1))


class Negative(Expression):
    """The negative of an expression."""

    def __init__(self, inner: Expression) -> None:
        self.inner = inner
        super().__init__(0.0 - inner.value, inner.size, inner)

    def write(self, pen: Pen) -> Written:
        inner = self.inner.write(pen)
        return inner._replace(text="-" + inner.within(_PRODUCT, pen), rank=SUM, worth=-inner.worth)


class Square(Expression):
    """The square of an expression."""

    def __init__(self, inner: Expression) -> None:
        self.inner = inner
        super().__init__(inner.value * inner.value, inner.size * inner.size, inner)

    def write(self, pen: Pen) -> Written:
        inner = self.inner.write(pen)
        base = inner.within(ATOM, pen)
        if pen.latex and pen.system is None and "'" in base and inner.rank == ATOM:
            base = f"{{{base}}}"
        text = base + ("^2" if pen.latex else "**2")
        return Written(text, _POWER, inner.worth * inner.worth, NO_UNIT.times(inner.unit, 2))


class Function(Expression):
    """A function of one argument: a root, a magnitude, a cosine or a sine."""

    def __init__(self, name: str, inner: Expression) -> None:
        self.name, self.inner = name, inner
        # An angle of many turns has the rounding of that many.
        of_angle = max(1.0, inner.size / math.tau)
        size = (
            math.sqrt(inner.size)
            if name == "sqrt"
            else of_angle
            if name in ("cos", "sin")
            else inner.size
        )
        super().__init__(_FUNCTIONS[name](inner.value), size, inner)

    def write(self, pen: Pen) -> Written:
        if self.name in ("cos", "sin"):
            return self._of_angle(pen)
        inner = self.inner.write(pen)
        latex = rf"\sqrt{{{inner.text}}}" if self.name == "sqrt" else rf"\lvert {inner.text} \rvert"
        text = latex if pen.latex else f"{self.name}({inner.text})"
        if self.name == "abs":
            return inner._replace(text=text, rank=ATOM, worth=abs(inner.worth))
        worth = max(inner.worth, Decimal(0)).sqrt()
        return Written(text, ATOM, worth, NO_UNIT.times(inner.unit, 0.5))

    def _of_angle(self, pen: Pen) -> Written:
        degrees = pen.system is not None and pen.system.label("angle") == "deg"
        inner = self.inner.write(replace(pen, marked=True) if degrees else pen)
        angle = float(inner.worth)
        worth = _in_decimals(_FUNCTIONS[self.name](math.radians(angle) if degrees else angle))
        if not pen.latex:
            text = f"{self.name}({inner.text})"
        elif degrees and inner.rank == ATOM:
            text = rf"\{self.name} {inner.text}"
        else:
            text = rf"\{self.name}\left({inner.text}\right)"
        return Written(text, _POWER, worth=worth)


class Direction(Expression):
    """The angle of a vector from its two components, counter-clockwise from the first axis."""

    def __init__(self, x: Expression, y: Expression) -> None:
        self.x, self.y = x, y
        super().__init__(math.atan2(y.value + 0.0, x.value), math.pi, x, y)

    def write(self, pen: Pen) -> Written:
        # As calculators and computers have it, with the second component first.
        y, x = self.y.write(pen), self.x.write(pen)
        name, left, right = (
            (r"\operatorname{atan2}", r"\left(", r"\right)") if pen.latex else ("atan2", "(", ")")
        )
        text = f"{name}{left}{y.text}, {x.text}{right}"
        unit = NO_UNIT if pen.system is None else pen.system.unit_of("angle")
        angle = math.atan2(float(y.worth) + 0.0, float(x.worth))
        return Written(text, _POWER, _in_decimals(angle * unit.scale), unit)


def _in_decimals(number: float) -> Decimal:
    """What a calculator has for a float, which is 0.5 for the sine of 30 degrees."""
    return Decimal(f"{number:.15g}")


ZERO, ONE = Literal(0.0), Literal(1.0)
HALF = Quotient(ONE, Literal(2.0))


def signed_total(terms: Iterable[tuple[float, Expression]]) -> Expression:
    """The sum of terms, each with the sign before it."""
    found: Expression = ZERO
    for sign, term in terms:
        found = found.plus(sign, term)
    return found


def total(*terms: Expression) -> Expression:
    """The sum of terms."""
    return sum(terms, start=ZERO)


def root(inner: Expression) -> Expression:
    """The square root."""
    return Function("sqrt", inner)


def magnitude(x: Expression, y: Expression) -> Expression:
    """The length of a vector, without a component that is 0."""
    parts = [part for part in (x, y) if part.value] or [x]
    return (
        Function("abs", parts[0])
        if len(parts) == 1
        else root(total(*(part.squared() for part in parts)))
    )
