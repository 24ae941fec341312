"""All that the page "Validation" shows of the blind cases."""

from __future__ import annotations

from typing import Any

from . import afterwards, backwards, compare, predict, to_rest


def everything() -> dict[str, Any]:
    """Predictions beside readings, what both say, and what was tried with the readings known."""
    predicted = predict.predictions()
    rows = compare.entries(predicted)
    speeds = backwards.rows()
    return {
        "rows": rows,
        "summaries": compare.summaries(rows),
        "self_checks": compare.self_checks(predicted),
        "without_answer": [
            {
                "test": case["title"],
                "level": level,
                "without_answer": answer["without_answer"],
                "samples": answer["samples"],
            }
            for case in predicted.values()
            for level, answer in case["levels"].items()
            if answer["without_answer"]
        ],
        "changed_since_first": compare.changed_since_first(predicted),
        "at_rest": to_rest.rows(),
        "backwards": {"rows": speeds, "summaries": backwards.summaries(speeds)},
        "afterwards": afterwards.rows(),
    }
