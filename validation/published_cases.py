"""The runner: reads the published cases, and compares what the library computes of them with what
was printed.

A solution turns the inputs of a case into figures, by their names in its record (``solution``); a
solution backwards turns printed figures of the end into inputs (``backwards``). Each is compared to
half a unit in the last printed digit, unless the record itself gives another tolerance (``within``)
with its reason (``remark``). Where a record says that the print is wrong (``wrong``), the figure
must differ from it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from published_records import EXAMPLES, LAWS, Case, Figure, examples, half_unit

import collisions as col

CASES = examples()
FIXED = col.Vehicle.barrier()
KINDS = ("published_outputs", "recomputed_outputs", "inputs")

Number = float | dict[str, float]
Figures = dict[str, Number]


def given(case: str, name: str) -> str | float:
    """An input of a case as a text with its unit; what follows the unit in the source is a
    direction.
    """
    entry = CASES[case]["inputs"][name]
    unit = entry["unit"].replace("ft2", "ft**2").replace("slug ", "slug*").split(",")[0].split()[0]
    return float(entry["value"]) if unit == "-" else f"{entry['value']} {unit}"


def number(case: str, name: str) -> float:
    """An input of a case as a bare number."""
    return float(CASES[case]["inputs"][name]["value"])


def output(case: str, name: str, kind: str = "recomputed_outputs") -> Any:
    """A figure of a case as it was printed, or as it was worked out apart when the data were put
    together.
    """
    return CASES[case][kind][name]["value"]


def slugs(pounds: float | str) -> str:
    """A weight in pounds as a mass with the g = 32.2 ft/s2 of its source."""
    return f"{float(pounds) / 32.2!r} slug"


def by_law(solve: Callable[[str], dict[str, float]]) -> dict[str, dict[str, float]]:
    """The figures of a case, each under both laws."""
    found = {law: solve(law) for law in LAWS}
    return {name: {law: found[law][name] for law in LAWS} for name in found[LAWS[0]]}


def law_of(case: str) -> str:
    """The law that the source of a case follows."""
    return "kudlich-slibar" if case == "E07" else "brach"


def numbers(case: str, solve: Callable[[str], Figures]) -> dict[str, float]:
    """The figures of a solution under the law of its source."""
    law = law_of(case)
    return {
        name: value[law] if isinstance(value, dict) else value
        for name, value in solve(case).items()
    }


# Comparisons


@dataclass(frozen=True)
class Comparison:
    """A figure of a record beside ours. ``wrong``: the print is known to be wrong, so that
    agreement would be the error.
    """

    case: str
    what: str
    printed: str
    ours: float
    within: float
    wrong: bool = False

    @property
    def good(self) -> bool:
        """Whether ours is the printed figure or, where that is wrong, is not."""
        agrees = abs(self.ours - float(self.printed)) <= self.within * (1 + 1e-9)
        return agrees != self.wrong


SOLUTIONS: dict[str, list[Callable[[str], Figures]]] = {}
SPREADS: dict[tuple[str, str], Callable[[str], dict[str, float]]] = {}
BACKWARDS: list[Backwards] = []


def solution(*cases: str) -> Callable[[Any], Any]:
    """Register a function of the case's name that computes figures of it; the first of a case is
    that of the page.
    """

    def register(solve: Any) -> Any:
        for case in cases:
            SOLUTIONS.setdefault(case, []).append(solve)
        return solve

    return register


def spread(*cases: str, kind: str = "published_outputs") -> Callable[[Any], Any]:
    """Register what rounding of the inputs is worth in figures of a case, for those of one kind."""

    def register(solve: Any) -> Any:
        SPREADS.update({(case, kind): solve for case in cases})
        return solve

    return register


def comparison(case: str, kind: str, name: str, ours: float, extra: float = 0.0) -> Comparison:
    """A figure of a worked example beside ours."""
    entry = CASES[case][kind][name]
    printed = str(entry["value"])
    half = float(entry.get("half_unit", half_unit(printed)))
    wrong = "wrong" in entry
    if "magnitude" in entry["unit"]:
        ours = abs(ours)
    # A wrong print must be missed by two units of its last digit.
    within = 4 * half if wrong else float(entry.get("within", half)) + extra
    return Comparison(case, f"{kind.partition('_')[0]} {name}", printed, ours, within, wrong)


def comparisons(case: str) -> Iterator[Comparison]:
    """Every figure of a worked example that is computed, against its print and against what was
    worked out apart.
    """
    spreads = {kind: SPREADS[case, kind](case) for kind in KINDS if (case, kind) in SPREADS}
    for solve in SOLUTIONS[case]:
        figures = numbers(case, solve)
        for name in figures:
            kinds = [kind for kind in KINDS if name in CASES[case][kind]]
            if not kinds:
                raise AssertionError(f"{case} has no figure {name!r} to compare with")
            for kind in kinds:
                # A print may follow from a step of its source, which was computed as a figure of
                # its own.
                ours = figures[CASES[case][kind][name].get("computed_as", name)]
                yield comparison(case, kind, name, ours, spreads.get(kind, {}).get(name, 0.0))


# Backwards


@dataclass(frozen=True)
class Backwards:
    """A way back from printed figures of the end to inputs of a case.

    ``most`` bounds, by input, what half a unit of every printed figure that goes in may be worth: a
    comparison within more would say nothing. ``expected`` has the inputs that the record does not
    name.
    """

    case: str
    kind: str
    figures: tuple[str, ...]
    solve: Callable[..., dict[str, float]]
    most: dict[str, float]
    expected: dict[str, float]
    wrong: bool

    def printed(self) -> list[Any]:
        """The figures that go in, as they were printed."""
        values = [output(self.case, name, self.kind) for name in self.figures]
        return [
            each for value in values for each in (value if isinstance(value, list) else [value])
        ]

    def comparisons(self) -> Iterator[Comparison]:
        """Every input found beside the one of the record."""
        found = Printed(lambda *figures: self.solve(self.case, *figures), *self.printed())
        for name, most in self.most.items():
            expected = self.expected[name] if name in self.expected else number(self.case, name)
            if not found.spread[name] < most:
                raise AssertionError(
                    f"{self.case} {name}: the print is worth {found.spread[name]:g}, more than "
                    f"{most:g}"
                )
            what = (
                f"{name} from {self.kind.partition('_')[0]} {', '.join(self.figures)} "
                f"({self.solve.__name__})"
            )
            yield Comparison(
                self.case, what, repr(expected), found.value[name], found.within(name), self.wrong
            )


class Printed:
    """A function of printed figures: its values, and what half a unit in the last digit of each,
    all together, is worth.
    """

    def __init__(self, function: Callable[..., dict[str, float]], *figures: Decimal | str) -> None:
        exact = [float(figure) for figure in figures]
        self.value = function(*exact)
        self.spread = dict.fromkeys(self.value, 0.0)
        for i, figure in enumerate(figures):
            moved = function(*exact[:i], exact[i] + half_unit(str(figure)), *exact[i + 1 :])
            for name, value in moved.items():
                self.spread[name] += abs(value - self.value[name])

    def within(self, name: str) -> float:
        """How far the value may be from the expected one: the spread, and a tenth of it for its
        curvature.
        """
        return 1.1 * self.spread[name] + 1e-9 * abs(self.value[name])


def backwards(
    *cases: str,
    figures: Iterable[str],
    most: dict[str, float],
    kinds: Iterable[str] = ("recomputed_outputs",),
    expected: dict[str, float] | None = None,
    wrong: bool = False,
) -> Callable[[Any], Any]:
    """Register a function of the case's name and its printed figures that finds inputs
    of the case.
    """

    def register(solve: Any) -> Any:
        BACKWARDS.extend(
            Backwards(case, kind, tuple(figures), solve, most, expected or {}, wrong)
            for case in cases
            for kind in kinds
        )
        return solve

    return register


# The page


def figure(case: str, name: str, computed: Number, quantity: str = "") -> Figure:
    """A published figure of a case beside ours, as the page shows it."""
    entry = CASES[case]["published_outputs"][name]
    unit = entry["unit"].split(",")[0].replace("-", "").strip()
    half = entry.get("half_unit")
    return Figure(
        quantity or entry["quantity"],
        name,
        unit,
        str(entry["value"]),
        computed,
        remark=entry.get("remark", ""),
        wrong=entry.get("wrong", ""),
        half_unit=None if half is None else float(half),
    )


def case_of(
    name: str, figures: list[Figure], *more_records: str, notes: Iterable[str] = ()
) -> Case:
    """A worked example as a case of the page."""
    source = CASES[name]["source"]
    records = [f"{EXAMPLES}: {name}", *more_records]
    return Case(
        name, source["title"], records, source["url"], figures, law=law_of(name), notes=list(notes)
    )
