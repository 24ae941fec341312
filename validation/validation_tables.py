"""The tables and figures of the page "Validation", made from the numbers that validation/run.py
wrote.
"""

from __future__ import annotations

import json
import re
from decimal import Decimal
from pathlib import Path
from typing import Any

from collisions.quantities.printed_tables import Part, in_markdown

ROOT = Path(__file__).resolve().parent.parent
DATA = ROOT / "docs" / "_generated" / "validation.json"
TITLES = {
    "blind": "Table 1. Blind predictions of measured crashes",
    "predictions": "Table 2. Untuned predictions in line",
    "agreement": "Table 3. Agreement with other people's solutions",
    "fits": "Table 4. Fits to measured tests",
}
UNITS = {"%": "%", "deg": "°", "1": ""}
NONE = "–"


def load() -> dict[str, Any]:
    """The numbers."""
    return json.loads(DATA.read_text(encoding="utf-8"))


def table(head: list[str], rows: list[list[str]], left: int = 1) -> str:
    """A Markdown table; the columns after the first ``left`` are on the right."""
    sides = [*["---"] * left, *["---:"] * (len(head) - left)]
    part = Part([tuple(row) for row in rows], columns=tuple(head))
    return in_markdown(part, lambda cell: cell.replace("|", "\\|"), sides)


def minus(text: str) -> str:
    """A minus sign that is one."""
    return re.sub(r"-(?=\d)", "−", text)


def like(value: float, printed: str, more: int = 1) -> str:
    """A computed figure with so many decimals more than the printed one."""
    return minus(f"{value:.{max(0, -int(Decimal(printed).as_tuple().exponent)) + more}f}")


def off(value: float | None, measure: str) -> str:
    """A difference with its sign."""
    if value is None:
        return NONE
    digits = 3 if abs(value) < 0.1 else 2 if abs(value) < 10 else 1
    text = f"{value:+.{digits}f}"
    text = minus(text if float(text) else text[1:])
    return text + (f"\u00a0{UNITS[measure]}" if measure == "%" else UNITS[measure])


def size(value: float | None, measure: str) -> str:
    """A difference without a sign."""
    return off(value, measure).lstrip("+−")


def mark(figure: dict[str, Any], word: str) -> str:
    """What to say of a figure in the last column."""
    if figure["wrong"]:
        return f"**{word}**: {figure['wrong']}"
    return figure["remark"]


def agreement(found: dict[str, Any]) -> str:
    """Table 3, figure by figure, and under it why those beyond print differ."""
    rows, reasons = [], []
    for case in found["agreement"]["cases"]:
        for figure in case["figures"]:
            other = NONE
            if "by_law" in figure:
                law = next(law for law in figure["by_law"] if law != case["law"])
                other = like(figure["by_law"][law]["computed"], figure["printed"])
            name = f"{case['key']} `{figure['name']}`"
            rows.append(
                [
                    name,
                    figure["unit"],
                    minus(figure["printed"]),
                    like(figure["computed"], figure["printed"]),
                    off(figure["difference"], figure["measure"]),
                    "misprint" if figure["wrong"] else "yes" if figure["within_print"] else "no",
                    other,
                ]
            )
            if figure["remark"] and not figure["wrong"]:
                reasons.append(f"- {name}: {figure['remark']}.")
    head = [
        "case and figure",
        "unit",
        "printed",
        "computed",
        "difference",
        "within print",
        "the other law",
    ]
    return "\n\n".join(
        [table(head, rows, left=2), "Where it is not within print:", "\n".join(reasons)]
    )


def measured(cases: dict[str, Any]) -> str:
    """Measured tests, reading by reading, under both laws."""
    rows = []
    for case in cases["cases"]:
        for figure in case["figures"]:
            laws = figure.get("by_law")
            brach = laws["brach"] if laws else figure
            other = laws["kudlich-slibar"] if laws else None
            rows.append(
                [
                    case["key"],
                    figure["name"],
                    figure["unit"],
                    minus(figure["printed"]),
                    like(brach["computed"], figure["printed"]),
                    off(brach["difference"], figure["measure"]),
                    like(other["computed"], figure["printed"]) if other else NONE,
                    off(other["difference"], figure["measure"]) if other else NONE,
                ]
            )
    head = [
        "test",
        "reading",
        "unit",
        "measured",
        "brach",
        "difference",
        "kudlich-slibar",
        "difference",
    ]
    return table(head, rows, left=3)


def predictions(found: dict[str, Any]) -> str:
    """Table 2, reading by reading."""
    rows = []
    for case in found["predictions"]["cases"]:
        for figure in case["figures"]:
            used = (
                "nothing"
                if "other car" in figure["quantity"]
                else case["inputs"].partition(" (")[0]
            )
            ours = like(figure["computed"], figure["printed"])
            rows.append([
                case["key"], figure["name"], figure["unit"], used, minus(figure["printed"]), ours,
                off(figure["difference"], figure["measure"]), mark(figure, "doubtful"),
            ])  # fmt: skip
    head = [
        "test",
        "reading",
        "unit",
        "taken from elsewhere",
        "measured",
        "predicted",
        "difference",
        "remark",
    ]
    return table(head, rows, left=4).replace("---: |\n", "--- |\n", 1)


def statistics(cases: dict[str, Any], aside: str = "") -> str:
    """Bias, median and worst of every quantity; where figures were set aside, with them in a second
    table.
    """
    head = ["quantity", "figures", "bias", "median", "worst", "worst of"]
    rows = [
        [entry["quantity"], *_summary(entry["sound"], entry["measure"])]
        for entry in cases["statistics"]
    ]
    if not aside:
        return table(head, rows)
    rows = [
        [*row, str(entry["set_aside"])]
        for row, entry in zip(rows, cases["statistics"], strict=True)
    ]
    every = [
        [entry["quantity"], *_summary(entry["all"], entry["measure"])]
        for entry in cases["statistics"]
        if entry["set_aside"]
    ]
    tables = [
        table([*head, f"{aside}, left out"], rows),
        "With what is left out there:",
        table(head, every),
    ]
    return "\n\n".join(tables)


def _summary(entry: dict[str, Any], measure: str) -> list[str]:
    return [
        str(entry["figures"]),
        off(entry["bias"], measure),
        size(entry["median"], measure),
        off(entry["worst"], measure),
        entry["worst_of"] or NONE,
    ]


def laws(cases: dict[str, Any]) -> str:
    """Both laws on the same figures: those of cases where friction acts."""
    rows = [
        [entry["quantity"], law, *_summary(summary, entry["measure"])]
        for entry in cases["statistics"]
        for law, summary in entry["laws"].items()
        if summary["figures"]
    ]
    return table(
        ["quantity", "law", "figures", "bias", "median", "worst", "worst of"], rows, left=2
    )


def sources(cases: dict[str, Any]) -> str:
    """What every case is and where it is from."""
    lines = []
    for case in cases["cases"]:
        said = " ".join(
            [f"Inputs: {case['inputs']}.", *case["notes"]] if case["inputs"] else case["notes"]
        )
        title = re.sub(
            r"^(\d{4} (?:BMW|[A-Z][a-z]+))(?=[A-Z\d])", r"\1 ", case["title"]
        )  # "FordFusion" in the sheet
        lines.append(
            f"- **{case['key']}**: {title}. {said} Source: `{case['source']}`".replace("..", ".")
        )
    return "\n".join(lines)


def tabulated(found: dict[str, Any]) -> str:
    """The delta-V that the sheet tabulates beside ours."""
    rows = [
        [
            row["key"],
            row["printed"],
            like(row["computed"], row["printed"]),
            off(row["difference"], "%"),
            f"**misprint**: {row['wrong']}" if row["wrong"] else "",
        ]
        for row in found["fits"]["tabulated"]["rows"]
    ]
    return table(["test", "tabulated, ft/s", "computed", "difference", "remark"], rows).replace(
        "---: |\n", "--- |\n", 1
    )


def refitted(found: dict[str, Any]) -> str:
    """The fits that ended at e = 0, with e free below it."""
    rows = [
        [
            row["key"],
            minus(f"{row['restitution']:.2f}"),
            f"{row['percent']:.0f} %",
            f"{row['misfit_at_0']:.2f}",
            f"{row['misfit']:.2f}",
        ]
        for row in found["fits"]["refitted"]
    ]
    return table(
        [
            "test",
            "restitution",
            "of the critical ratio",
            "misfit of the sheet's fit, ft/s",
            "misfit, ft/s",
        ],
        rows,
    )


def nothing_published(found: dict[str, Any]) -> str:
    """Cases without a published answer."""
    rows = [
        [
            f"{case['key']} `{figure['name']}`",
            case["why"],
            figure["unit"],
            figure["apart"],
            like(figure["computed"], figure["apart"], 0),
            off(figure["difference"], "%"),
        ]
        for case in found["nothing_published"]
        for figure in case["figures"]
    ]
    return table(
        ["case and figure", "what it is", "unit", "worked out apart", "computed", "difference"],
        rows,
        left=3,
    )


def inputs_only(found: dict[str, Any]) -> str:
    """Records that are no cases."""
    return table(
        ["records", "what it is"],
        [
            ["; ".join(record.partition(": ")[2] for record in entry["records"]), entry["what"]]
            for entry in found["inputs_only"]
        ],
        left=2,
    )


def not_computed(found: dict[str, Any]) -> str:
    """Figures that are compared in no table."""
    names = ("record", "what", "given", "why")
    return table(
        ["record", "figure", "given", "why it is in no table"],
        [
            [
                re.sub(r"^([\w.]+):", r"`\1`:", entry["record"]),
                *(minus(entry[name]) for name in names[1:]),
            ]
            for entry in found["not_computed"]
        ],
        left=4,
    )


def misprints(found: dict[str, Any]) -> str:
    """Every printed figure that is wrong, with what is wrong and what the library computes."""
    rows = [
        [
            f"{case['key']} `{figure['name']}`",
            minus(figure["printed"]),
            like(figure["computed"], figure["printed"]),
            figure["unit"],
            figure["wrong"],
        ]
        for case in found["agreement"]["cases"]
        for figure in case["figures"]
        if figure["wrong"]
    ]
    rows = [[row[0], row[3], *row[1:3], row[4]] for row in rows]
    return table(
        ["case and figure", "unit", "printed", "computed", "what is wrong"], rows, left=2
    ).replace("---: |\n", "--- |\n", 1)


def slips(found: dict[str, Any]) -> str:
    """Other slips of the sources."""
    return table(
        ["where", "what is wrong", "what is used instead"],
        [[entry["where"], entry["what"], entry["instead"]] for entry in found["slips"]],
        left=3,
    )


def of(cases: dict[str, Any], quantity: str) -> dict[str, Any]:
    """The statistics of a quantity."""
    return next(entry for entry in cases["statistics"] if entry["quantity"] == quantity)


def counts(cases: dict[str, Any]) -> dict[str, int]:
    """How many cases, figures, figures within print and figures set aside a table has."""
    stats = cases["statistics"]
    return {
        "cases": len(cases["cases"]),
        "figures": sum(entry["all"]["figures"] for entry in stats),
        "sound": sum(entry["sound"]["figures"] for entry in stats),
        "within": sum(entry["within_print"] for entry in stats),
        "aside": sum(entry["set_aside"] for entry in stats),
    }


def where_records_are(found: dict[str, Any]) -> str:
    """How many records of each file are in which table or list."""
    places = {
        "predictions": "table 2",
        "agreement": "table 3",
        "fits": "table 4",
        "nothing published": "nothing published",
        "inputs only": "inputs only",
    }
    files = list(dict.fromkeys(record.partition(":")[0] for record in found["records"]))
    rows = []
    for file in files:
        mine = [
            home for record, home in found["records"].items() if record.partition(":")[0] == file
        ]
        rows.append([f"`{file}`", *(str(mine.count(place)) for place in places), str(len(mine))])
    every = list(found["records"].values())
    rows.append(["all", *(str(every.count(place)) for place in places), str(len(every))])
    return table(["file", *places.values(), "records"], rows)


def headlines(found: dict[str, Any]) -> str:
    """The tables after the first in one sentence each; never one number for all."""
    one, two, three = (counts(found[name]) for name in ("agreement", "fits", "predictions"))
    guess = of(found["predictions"], "delta-V from the closing speed")["sound"]
    lines = [
        (
            f"2. **Untuned predictions in line**: {three['cases']} tests, {three['figures']} "
            f"figures (some from the same readings), of which {three['aside']} are doubtful. "
            f"Delta-V from the closing speed, {guess['figures']} readings: {spread(guess)}."
        ),
        (
            f"3. **Agreement with other people's solutions**: {one['cases']} cases, "
            f"{one['figures']} figures. {one['within']} agree to half a unit of their last "
            f"printed digit, {one['sound'] - one['within']} differ by more for a reason that is "
            f"given there, and {one['aside']} are misprints. {both_of(found['agreement'])}"
        ),
        (
            f"4. **Fits to measured tests**: {two['cases']} tests, {two['figures']} figures. "
            f"Barrier tests: {both_of(found['fits'])} With the tuned inputs of the other nine "
            "tests instead of its own, a test is missed by much more. "
            f"{both_of(found['fits']['held_out'])}"
        ),
    ]
    return "\n".join(lines)


def spread(entry: dict[str, Any]) -> str:
    """Bias, median and worst of a quantity in words."""
    return (
        f"bias {off(entry['bias'], '%')}, median {size(entry['median'], '%')}, worst "
        f"{off(entry['worst'], '%')}"
    )


def both_of(cases: dict[str, Any]) -> str:
    """Delta-V and yaw rate of a table in words."""
    return (
        f"Delta-V {spread(of(cases, 'delta-V')['sound'])}; yaw rate "
        f"{spread(of(cases, 'yaw rate')['sound'])}."
    )


def everything(found: dict[str, Any]) -> str:
    """All tables as text, but those of ``blind_tables``."""
    one, two, three = found["agreement"], found["fits"], found["predictions"]
    held_out = two["held_out"]
    parts = [
        headlines(found), TITLES["predictions"], predictions(found), statistics(three, "doubtful"),
        TITLES["agreement"], agreement(found), statistics(one, "misprints"), laws(one),
        TITLES["fits"], measured(two), statistics(two), laws(two),
        "The delta-V that the sheet tabulates", tabulated(found),
        "Held out: each test with the tuned inputs of the other nine", measured(held_out),
        laws(held_out),
        "Nothing published", nothing_published(found), "Inputs only", inputs_only(found),
        "Not computed", not_computed(found),
        "Misprints", misprints(found), "Other slips", slips(found), where_records_are(found),
    ]  # fmt: skip
    return "\n\n".join(parts)
