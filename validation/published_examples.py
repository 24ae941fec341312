"""The worked examples: their inputs as the library takes them, and their published figures beside what it computes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from published_records import EXAMPLES, LAWS, Case, Figure, examples

import collisions as col

CASES = examples()
FIXED = col.Vehicle.barrier()


def given(case: str, name: str) -> str | float:
    """An input of a case as a text with its unit; what follows the unit in the source is a direction."""
    entry = CASES[case]["inputs"][name]
    unit = entry["unit"].replace("ft2", "ft**2").replace("slug ", "slug*").split(",")[0].split()[0]
    return float(entry["value"]) if unit == "-" else f"{entry['value']} {unit}"


def number(case: str, name: str) -> float:
    """An input of a case as a bare number."""
    return float(CASES[case]["inputs"][name]["value"])


def output(case: str, name: str) -> Any:
    """A figure that was worked out apart when the data were put together."""
    return CASES[case]["recomputed_outputs"][name]["value"]


def slugs(pounds: float | str) -> str:
    """A weight in pounds as a mass with the g of its source."""
    return f"{float(pounds) / 32.2!r} slug"


def figure(case: str, name: str, quantity: str, computed: float | dict[str, float], **said: Any) -> Figure:
    """A published figure of a case beside ours."""
    entry = CASES[case]["published_outputs"][name]
    unit = entry["unit"].split(",")[0].replace("-", "").strip()
    return Figure(quantity, said.pop("shown", name), unit, str(entry["value"]), computed, **said)


def case_of(name: str, figures: list[Figure], *more_records: str, **said: Any) -> Case:
    """A worked example as a case."""
    source = CASES[name]["source"]
    records = [f"{EXAMPLES}: {name}", *more_records]
    return Case(name, source["title"], records, source["url"], figures, **said)


def both_laws(solve: Callable[[str], float]) -> dict[str, float]:
    """A figure under each law."""
    return {law: solve(law) for law in LAWS}
