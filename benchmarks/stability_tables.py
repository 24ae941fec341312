"""The tables and the chart of the page "Numerical stability", made from the numbers that
benchmarks/stability.py wrote.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

from collisions.quantities.printed_tables import Part, in_markdown

DATA = Path(__file__).resolve().parent.parent / "docs" / "_generated" / "stability.json"
NAMES = {
    "closing": "closing speed",
    "P": "impulse",
    "stick": "impulse, sticking",
    "delta-V": "delta-V",
    "v": "velocity after",
    "w": "yaw rate after",
    "loss": "energy loss",
    "pivot": "impulse of a pivot",
    "pdof": "PDOF",
}
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
INK, OURS, TEXTBOOK, GREY = "#1a1a1a", "#1f5fa8", "#b3541e", "#777777"


def load() -> dict[str, Any]:
    """The numbers."""
    return json.loads(DATA.read_text(encoding="utf-8"))


def number(value: float | None) -> str:
    """Two digits, powers of ten written out."""
    if value is None:
        return "none"
    if value == 0 or 0.01 <= abs(value) < 1000:
        return f"{value:.2g}" if abs(value) < 99.5 else f"{value:.0f}"
    digits, power = f"{value:.1e}".split("e")
    return f"{digits}×10{str(int(power)).translate(SUPERSCRIPT)}"


def table(head: list[str], rows: list[list[str]]) -> str:
    """A Markdown table whose columns of numbers are on the right."""
    sides = ["---", *["---:"] * (len(head) - 1)]
    part = Part([tuple(row) for row in rows], columns=tuple(head))
    return in_markdown(part, lambda cell: cell.replace("|", "\\|"), sides)


def symbols(text: str) -> str:
    """Subscripts as a reader expects them: S_P becomes a formula, ranges of two numbers get their
    word.
    """
    return re.sub(r"\b(S|loss)_(\w)\b", lambda hit: f"{hit[1]}<sub>{hit[2]}</sub>", text).replace(
        "..", " to "
    )


def promises(found: dict[str, Any]) -> str:
    """Every promise, and the worst error seen."""
    return table(
        ["output", "promise, in eps", "of this scale", "worst seen, in eps"],
        [
            [row["output"], str(row["eps"]), symbols(row["scale"]), number(row["seen"])]
            for row in found["promises"]
        ],
    )


def later(found: dict[str, Any]) -> str:
    """The worst errors of what came after the first laws, row by row of the promises."""
    rows = [
        [
            promise["output"],
            str(promise["eps"]),
            *(number(kind["seen"].get(promise["key"])) for kind in found["later"]),
        ]
        for promise in found["promises"]
        if promise["key"] in found["later"][0]["seen"]
    ]
    names = [
        f"`{kind['name']}`" if "=" in kind["name"] else kind["name"] for kind in found["later"]
    ]
    return table(["output", "promise, in eps", *names], rows)


def in_time(found: dict[str, Any]) -> str:
    """The rounding of contacts in steps, by family."""
    of_steps = found["in_time"]
    names = list(of_steps["promises"])
    rows = [["promise", *(str(eps) for eps in of_steps["promises"].values())]]
    rows += [
        [symbols(row["family"]), *(number(row["seen"][name]) for name in names)]
        for row in of_steps["rows"]
    ]
    return table(["worst seen, in eps", *names], rows)


def load_steps() -> dict[str, Any]:
    """What contacts in steps err by, as benchmarks/steps.py wrote it."""
    return json.loads(DATA.with_name("steps.json").read_text(encoding="utf-8"))


def of_steps(found: dict[str, Any]) -> str:
    """The error of the steps at 100 and at 200 of them, and by what it falls from the one to the
    other.
    """
    rows = []
    for row in found["rows"]:
        ends = [f"{number(row['median'][at])}, {number(row['worst'][at])}" for at in (0, 1)]
        rows.append(
            [row["name"], str(row["cases"]), *ends, f"{row['median'][0] / row['median'][1]:.1f}"]
        )
    head = [
        "what",
        "cases",
        "median and worst error at 100 steps",
        "at 200 steps",
        "the median falls by",
    ]
    return table(head, rows)


def start_of_steps(found: dict[str, Any]) -> str:
    """How near the start is found."""
    return (
        "The start is sought until the positions at maximum engagement are met to "
        f"{number(found['start'])} of closing speed times duration; where that fails the case is "
        "refused (`no_start`). Momentum including the tyres, and kinetic energies including "
        "both losses, balance to rounding."
    )


def forms(found: dict[str, Any], keys: list[str]) -> str:
    """For every regime: the worst error of the textbook form beside that of the library, in eps of
    the scale.
    """
    rows = []
    for regime in found["regimes"]:
        row = [regime["name"]]
        for key in keys:
            entry = regime["compared"].get(key)
            if entry is None:
                row += ["–", "–"]
                continue
            textbook, without = number(entry["textbook"]), entry["textbook_no_answer"]
            if 0.0 < without < 1.0:
                textbook += f" (none: {100 * without:.2g} %)"
            row += [textbook, number(entry["library"])]
        if any(cell != "–" for cell in row[1:]):
            rows.append(row)
    return table(
        ["regime", *(f"{NAMES[key]}, {who}" for key in keys for who in ("textbook", "library"))],
        rows,
    )


def relative(found: dict[str, Any]) -> str:
    """For every regime: the worst relative error of the value itself."""
    rows = []
    keys = ("loss", "delta-V", "P")
    for regime in found["regimes"]:
        entries = [regime["compared"][key] for key in keys]
        rows.append(
            [
                regime["name"],
                *(
                    number(entry[f"{who}_relative"])
                    for entry in entries
                    for who in ("textbook", "library")
                ),
            ]
        )
    return table(
        ["regime", *(f"{NAMES[key]}, {who}" for key in keys for who in ("textbook", "library"))],
        rows,
    )


def conditions(found: dict[str, Any], key: str) -> str:
    """How the error of the impulse, or of the energy loss, grows with one of the
    condition numbers.
    """
    rows = next(entry["rows"] for entry in found["conditions"] if entry["key"] == key)
    return table(
        [
            "condition number",
            "exact answer moves",
            "library is off",
            "worst case of off / moves",
            "promise",
        ],
        [
            [
                number(row[name])
                for name in ("kappa", "one_eps", "library", "library_over_one_eps", "promise")
            ]
            for row in rows
        ],
    )


def grid(found: dict[str, Any]) -> str:
    """What the map grid does to positions."""
    entry = found["grid"]
    return table(
        ["positions near 5×10⁶ m", ""],
        [
            ["step of the grid of positions", f"{number(entry['ulp'])} m"],
            ["the same, in eps of a lever of 1 m", number(entry["ulp_in_eps_of_1_m"])],
            [
                "exact impulse moves when positions are put on the grid, in eps of κ S<sub>P</sub>",
                number(entry["exact_change"]),
            ],
            ["the same, relative to the impulse", number(entry["exact_change_relative"])],
            ["the library adds, in eps of κ S<sub>P</sub>", number(entry["library"])],
            ["step of the grid in float32", f"{number(entry['ulp_float32'])} m"],
        ],
    )


def float32(found: dict[str, Any]) -> str:
    """What float32 gives in ordinary traffic."""
    return table(
        [
            "output",
            "worst, in float32 eps of the scale",
            "median relative error",
            "99 % are below",
            "worst relative error",
        ],
        [
            [
                NAMES[row["key"]],
                *(
                    number(row[name])
                    for name in (
                        "worst_in_eps",
                        "median_relative",
                        "p99_relative",
                        "worst_relative",
                    )
                ),
            ]
            for row in found["float32"]["outputs"]
        ],
    )


def draw_forms(found: dict[str, Any], path: Path) -> None:
    """Digits lost by the textbook forms and by the library: regimes as rows, an output in each
    panel.
    """
    import matplotlib as mpl

    mpl.use("agg")
    style = {
        "font.size": 10, "font.family": "DejaVu Sans", "figure.facecolor": "white",
        "savefig.facecolor": "white",
        "svg.fonttype": "path", "svg.hashsalt": "collisions",
    }  # fmt: skip
    with mpl.rc_context(style):
        _draw(found, path)


def _draw(found: dict[str, Any], path: Path) -> None:
    import matplotlib.pyplot as plt

    panels = {
        "loss": "energy loss\n(eq 7: difference of energies)",
        "delta-V": "delta-V\n(v' − v)",
        "P": "impulse\n(levers by n·c − n·x; Cramer)",
        "closing": "closing speed\n(n·u₁ − n·u₂)",
    }
    regimes, all_digits, end = found["regimes"], -math.log10(found["eps"]), 33.0
    figure, axes = plt.subplots(1, len(panels), figsize=(12.0, 5.4), sharey=True, sharex=True)
    for axis, (key, title) in zip(axes, panels.items(), strict=True):
        axis.axvspan(all_digits, end + 2, color="#f3e3dc", zorder=0, lw=0)
        for row, regime in enumerate(regimes):
            entry = regime["compared"][key]
            ours = math.log10(max(entry["library"], 1.0))
            theirs = None if entry["textbook"] is None else math.log10(max(entry["textbook"], 1.0))
            if theirs is not None:
                axis.plot([ours, theirs], [row, row], color="#c9c9c9", lw=2, zorder=1)
                axis.plot(theirs, row, "s", color=TEXTBOOK, ms=7, zorder=2)
            if entry["textbook_no_answer"] >= 0.01:
                axis.plot(end, row, "x", color=TEXTBOOK, ms=7, mew=2, zorder=2, clip_on=False)
            axis.plot(ours, row, "o", color=OURS, ms=7, zorder=3)
        axis.set_title(title, fontsize=10, color=INK)
        axis.set_xlim(-1.2, end + 2)
        axis.set_xticks([0, 8, 16, 24, 32])
        axis.grid(axis="x", color="#e3e3e3", lw=0.8)
        axis.set_axisbelow(True)
        axis.tick_params(length=0)
        for spine in axis.spines.values():
            spine.set_visible(False)
    axes[0].set_yticks(range(len(regimes)), [regime["name"] for regime in regimes])
    axes[0].set_ylim(len(regimes) - 0.4, -0.6)
    figure.supxlabel(
        "decimal digits lost in the worst case (shaded: more than double precision has)",
        fontsize=10,
    )
    marks = [
        plt.Line2D([], [], ls="", marker="o", color=OURS, ms=7, label="library"),
        plt.Line2D([], [], ls="", marker="s", color=TEXTBOOK, ms=7, label="textbook form"),
        plt.Line2D(
            [],
            [],
            ls="",
            marker="x",
            color=TEXTBOOK,
            ms=7,
            mew=2,
            label="textbook form gives no number in some or all cases",
        ),
    ]
    figure.legend(handles=marks, loc="upper center", ncols=3, frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 0.94))
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None, dpi=110)
    plt.close(figure)
