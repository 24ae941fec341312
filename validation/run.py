"""Predicts every blind case, solves every published one, writes docs/_generated/validation.json and
the figures, and prints.

Run with ``python validation/run.py``; ``--blind`` prints the blind cases alone and writes nothing.
It takes half a minute, nearly all of it for the contacts in time, and needs the library and, for
the figures, matplotlib.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import agreement
import blind_tables
import commercial_figure
import commercial_program
import measured_fits
import other_lists
import untuned_predictions
import validation_figures
import validation_tables as tables
from blind import page
from published_records import record_names, table_of

DOCS = HERE.parent / "docs"


def homes(found: dict[str, Any]) -> dict[str, str]:
    """Where every record is; refuses one that is nowhere or in two places."""
    placed = [
        (record, name)
        for name in ("agreement", "fits", "predictions")
        for case in found[name]["cases"]
        for record in case["records"]
    ]
    placed += [
        (record, "nothing published")
        for case in found["nothing_published"]
        for record in case["records"]
    ]
    placed += [
        (record, "inputs only") for entry in found["inputs_only"] for record in entry["records"]
    ]
    counts = Counter(record for record, _ in placed)
    wrong = {
        name: counts[name]
        for name in {*record_names(), *counts}
        if counts[name] != 1 or name not in record_names()
    }
    if wrong:
        raise AssertionError(f"records that are not in exactly one place: {wrong}")
    return dict(sorted(placed))


def published() -> dict[str, Any]:
    """All that the page shows but the blind cases."""
    found: dict[str, Any] = {
        "agreement": table_of(agreement.cases()),
        "fits": {
            **table_of(measured_fits.cases()),
            "tabulated": measured_fits.tabulated(),
            "refitted": measured_fits.refitted(),
            "held_out": table_of(measured_fits.held_out()),
        },
        "predictions": table_of(untuned_predictions.cases()),
        "nothing_published": other_lists.nothing_published(),
        "inputs_only": other_lists.inputs_only(),
        "not_computed": other_lists.not_computed(),
        "slips": other_lists.slips(),
        "commercial": commercial_program.everything(),
    }
    found["records"] = homes(found)
    return found


def main() -> None:
    """Write and print, or print the blind cases alone."""
    if sys.argv[1:] == ["--blind"]:
        found = {"blind": page.everything(), "commercial": commercial_program.everything()}
        print(blind_tables.everything(found))
        return
    if sys.argv[1:]:
        sys.exit("python validation/run.py takes --blind or nothing")
    found = {"blind": page.everything(), **published()}
    (DOCS / "_generated" / "validation.json").write_text(
        json.dumps(found, indent=1, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8"
    )
    for name in ("agreement", "fits", "predictions"):
        validation_figures.draw(found, name, DOCS / "_static" / f"validation_{name}.svg")
    commercial_figure.draw(DOCS / "_static" / "validation_commercial.svg")
    print(
        tables.TITLES["blind"], blind_tables.everything(found), tables.everything(found), sep="\n\n"
    )


if __name__ == "__main__":
    main()
