"""The published records as files, what a comparison with one of their figures is, and the
statistics of many.
"""

from __future__ import annotations

import csv
import json
import statistics
from collections.abc import Iterable
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path
from typing import Any

DATA = Path(__file__).resolve().parent / "data"
LAWS = ("brach", "kudlich-slibar")
PERCENT, DEGREES, ABSOLUTE = "%", "deg", "1"
# Angles are compared by their difference, and so is a restitution: a percentage of a number near 0
# says nothing.
MEASURES = {"direction": DEGREES, "restitution read": ABSOLUTE}
EXAMPLES, OBLIQUE, OVERLAP, IN_LINE, RESTITUTION = (
    "worked_examples.json",
    "nhtsa_oblique.csv",
    "small_overlap_barrier.csv",
    "inline_and_barrier_tests.csv",
    "restitution.csv",
)


def rows_of(name: str) -> list[dict[str, str]]:
    """The rows of a table."""
    with open(DATA / name, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def examples() -> dict[str, dict[str, Any]]:
    """The worked examples by their name; numbers keep the digits they were printed with."""
    text = (DATA / EXAMPLES).read_text(encoding="utf-8")
    return {case["id"]: case for case in json.loads(text, parse_float=Decimal, parse_int=Decimal)}


def record_names() -> list[str]:
    """Every record of every file, by one name each."""
    named = ("data_set", "closing_speed", "closing_speed_unit")
    return [
        *(f"{EXAMPLES}: {name}" for name in examples()),
        *(
            f"{OBLIQUE}: {row['nhtsa_test']} vehicle {row['vehicle_no']}"
            for row in rows_of(OBLIQUE)
        ),
        *(f"{OVERLAP}: {row['test_id']}" for row in rows_of(OVERLAP)),
        *(f"{IN_LINE}: {row['test']} vehicle {row['vehicle_no']}" for row in rows_of(IN_LINE)),
        *(
            " ".join(filter(None, (f"{RESTITUTION}:", *(row[name] for name in named))))
            for row in rows_of(RESTITUTION)
        ),
    ]


def rounded(value: float) -> float:
    """Ten digits: more than any source has, and fewer than platforms differ in."""
    return float(f"{value:.10g}")


def half_unit(digits: str) -> float:
    """Half a unit in the last digit of a number as it was printed."""
    return 0.5 * 10.0 ** int(Decimal(digits).as_tuple().exponent)


@dataclass
class Figure:
    """One printed or measured number, and what the library computes for it.

    ``computed`` is one number, or one for each law where friction acts. ``wrong`` says what is
    wrong with the print, or why the reading is doubtful; ``remark`` why a difference of more than
    half a unit of the last printed digit is none of the library.
    """

    quantity: str
    name: str
    unit: str
    printed: str
    computed: float | dict[str, float]
    remark: str = ""
    wrong: str = ""
    half_unit: float | None = None

    def entry(self, law: str) -> dict[str, Any]:
        """What the page shows of it."""
        both = self.computed if isinstance(self.computed, dict) else None
        ours = rounded(both[law] if both is not None else self.computed)  # type: ignore[arg-type]
        half = half_unit(self.printed) if self.half_unit is None else self.half_unit
        measure = MEASURES.get(self.quantity, PERCENT)
        within = abs(ours - float(self.printed)) <= half * (1 + 1e-9)
        found: dict[str, Any] = {
            "quantity": self.quantity,
            "name": self.name,
            "unit": self.unit,
            "printed": self.printed,
            "computed": ours,
            "measure": measure,
            "difference": difference(ours, self.printed, measure),
            "within_print": within,
            "remark": "" if within else self.remark,
            "wrong": self.wrong,
        }
        if both is not None:
            found["by_law"] = {
                each: {
                    "computed": rounded(value),
                    "difference": difference(rounded(value), self.printed, measure),
                }
                for each, value in both.items()
            }
        return found


def difference(ours: float, printed: str, measure: str) -> float:
    """Computed less printed; in percent of the print, above 0 where the computed figure is the
    larger in size.
    """
    theirs = float(printed)
    return rounded(100.0 * (ours / theirs - 1.0) if measure == PERCENT else ours - theirs)


@dataclass
class Case:
    """A case of one table: the records it is made of, where they come from, and its figures."""

    key: str
    title: str
    records: list[str]
    source: str
    figures: list[Figure]
    law: str = "brach"
    inputs: str = ""
    notes: list[str] = field(default_factory=list)

    def entry(self) -> dict[str, Any]:
        """What the page shows of it."""
        both = any(isinstance(figure.computed, dict) for figure in self.figures)
        return {
            "key": self.key,
            "title": self.title,
            "records": self.records,
            "source": self.source,
            "inputs": self.inputs,
            "law": self.law if both else None,
            "notes": self.notes,
            "figures": [figure.entry(self.law) for figure in self.figures],
        }


def summary(named: Iterable[tuple[str, float]]) -> dict[str, Any]:
    """Bias, median and worst of some differences; nothing of none."""
    pairs = list(named)
    if not pairs:
        return {"figures": 0, "bias": None, "median": None, "worst": None, "worst_of": None}
    worst_of, worst = max(pairs, key=lambda pair: abs(pair[1]))
    return {
        "figures": len(pairs),
        "bias": rounded(statistics.fmean(value for _, value in pairs)),
        "median": rounded(statistics.median(abs(value) for _, value in pairs)),
        "worst": worst,
        "worst_of": worst_of,
    }


def table_of(cases: list[Case]) -> dict[str, Any]:
    """The cases of a table with their statistics by quantity, with and without what is misprinted
    or doubtful.
    """
    entries = [case.entry() for case in cases]
    flat = [
        (f"{case['key']}: {figure['name']}", figure)
        for case in entries
        for figure in case["figures"]
    ]
    found = []
    for quantity in dict.fromkeys(figure["quantity"] for _, figure in flat):
        mine = [(name, figure) for name, figure in flat if figure["quantity"] == quantity]
        sound = [(name, figure) for name, figure in mine if not figure["wrong"]]
        both = [(name, figure) for name, figure in sound if "by_law" in figure]
        found.append(
            {
                "quantity": quantity,
                "measure": MEASURES.get(quantity, PERCENT),
                "within_print": sum(figure["within_print"] for _, figure in sound),
                "set_aside": len(mine) - len(sound),
                "sound": summary((name, figure["difference"]) for name, figure in sound),
                "all": summary((name, figure["difference"]) for name, figure in mine),
                "laws": {
                    law: summary(
                        (name, figure["by_law"][law]["difference"]) for name, figure in both
                    )
                    for law in LAWS
                },
            }
        )
    return {"cases": entries, "statistics": found}
