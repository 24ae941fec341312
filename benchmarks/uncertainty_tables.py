"""The tables of the page "How sure", made from the numbers that benchmarks/uncertainty.py wrote."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from speed_tables import percent
from stability_tables import number, table

DATA = Path(__file__).resolve().parent.parent / "docs" / "_generated" / "uncertainty.json"
DEFAULT = 8192  # cases that ``propagate`` draws if nothing is said
FIGURE_NAMES = ("mean", "standard deviation", "lower end", "upper end")
METHOD_NAMES = {
    "first_order": "first order",
    "second_order": "second order",
    "quasi_random": "quasi-random",
    "latin_hypercube": "Latin hypercube",
    "monte_carlo": "Monte Carlo",
    "interval": "interval",
}
FITTED = {"speed_a": "speed of A", "speed_b": "speed of B", "restitution": "restitution"}


def load() -> dict[str, Any]:
    """The numbers."""
    return json.loads(DATA.read_text(encoding="utf-8"))


def count(value: float) -> str:
    """A whole number, its thousands apart by spaces at which no line is broken."""
    return f"{value:,.0f}".replace(",", "\N{NO-BREAK SPACE}")


def names(found: dict[str, Any]) -> dict[str, str]:
    """Of the scenes."""
    return {scene["key"]: scene["name"] for scene in found["scenes"]}


def chosen(found: dict[str, Any]) -> int:
    """The size nearest to what is drawn by default."""
    return min(
        {row["samples"] for row in found["sampled"]}, key=lambda size: abs(math.log(size / DEFAULT))
    )


def of(found: dict[str, Any], scene: str, method: str, samples: int) -> dict[str, Any]:
    """One row of sampling."""
    return next(
        row
        for row in found["sampled"]
        if (row["scene"], row["method"], row["samples"]) == (scene, method, samples)
    )


def machine(found: dict[str, Any]) -> str:
    """On what it was measured, and against what."""
    said = found["machine"]
    cases = {row["cases"] for row in found["references"].values()}
    return (
        f"Measured on {said['cores']} cores ({said['processor']}, {said['system']}), Python "
        f"{said['python']}, numpy {said['numpy']}, against {count(max(cases))} plain cases a "
        "scene."
    )


def scenes(found: dict[str, Any]) -> str:
    """The four scenes by the reference."""
    lines = []
    for scene in found["scenes"]:
        reference = found["references"][scene["key"]]
        mean, std, low, high = reference["figures"]
        lines.append(
            [
                scene["name"],
                scene["output"],
                f"{mean:.4g}",
                f"{std:.3g}",
                f"{low:.4g} to {high:.4g}",
                percent(reference["failed"] / reference["cases"]),
            ]
        )
    return table(
        [
            "scene",
            "output",
            "mean",
            "standard deviation",
            "95 percent interval",
            "without an answer",
        ],
        lines,
    )


def choices(found: dict[str, Any]) -> str:
    """Every method at what it takes by default: errors and cost."""
    size, lines = chosen(found), []
    for key, name in names(found).items():
        rows = [row for row in found["local"] if row["scene"] == key]
        rows += [
            of(found, key, method, size)
            for method in ("quasi_random", "latin_hypercube", "monte_carlo")
        ]
        for row in rows:
            lines.append(
                [
                    name,
                    METHOD_NAMES[row["method"]] + (", warned" if row.get("warned") else ""),
                    count(row["samples"]),
                    *(
                        percent(error).replace(" ", "\N{NO-BREAK SPACE}")
                        for error in error_sizes(found, row)
                    ),
                    count(float(f"{row['cost']:.2g}")),
                ]
            )
    head = ["scene", "method", "cases", *FIGURE_NAMES, "cost of a run"]
    return table(head, lines).replace("| --- | ---: | ---: |", "| --- | --- | ---: |", 1)


def error_sizes(found: dict[str, Any], row: dict[str, Any]) -> list[float]:
    """The sizes of the errors of a row: of a local method not below what the reference itself
    leaves open.
    """
    if "seeds" in row:
        return row["error"]
    reference = found["references"][row["scene"]]
    own = [error / reference["figures"][1] for error in reference["standard_errors"]]
    return [max(abs(error), least) for error, least in zip(row["error"], own, strict=True)]


def local_cost(found: dict[str, Any]) -> str:
    """How often a local method runs the model, and what a run of it costs of one of the default
    size.
    """
    cases = [row["samples"] for row in found["local"]]
    shares = [
        row["cost"] / of(found, row["scene"], "quasi_random", chosen(found))["cost"]
        for row in found["local"]
    ]
    return (
        f"In the scenes below a local method asks the model for {count(min(cases))} to "
        f"{count(max(cases))} cases, most of them for its check of itself. It costs "
        f"{number(min(shares))} to {number(max(shares))} times as much as a quasi-random run of "
        f"{count(chosen(found))} cases."
    )


def worth(found: dict[str, Any]) -> str:
    """How many plain cases one quasi-random case replaces."""
    sizes = sorted({row["samples"] for row in found["sampled"]})
    lines = []
    for key, name in names(found).items():
        for figure, pick in (
            ("mean", (0,)),
            ("standard deviation", (1,)),
            ("ends of the interval, the worse", (2, 3)),
        ):
            cells = [
                number(min(of(found, key, "quasi_random", size)["worth"][i] for i in pick))
                for size in sizes
            ]
            lines.append([name, figure, *cells])
    text = table(["scene", "figure", *(f"{count(size)} cases" for size in sizes)], lines)
    return text.replace("| --- | ---: |", "| --- | --- |", 1)


def equal(found: dict[str, Any]) -> str:
    """What the default number of quasi-random cases does in plain ones."""
    size = chosen(found)
    rows = [of(found, key, "quasi_random", size) for key in names(found)]
    lines = []
    for figure, pick in (
        ("the mean", (0,)),
        ("the standard deviation", (1,)),
        ("an end of the interval", (2, 3)),
    ):
        each = [size * row["worth"][i] for row in rows for i in pick]
        lines.append(
            f"{count(float(f'{min(each):.2g}'))} to {count(float(f'{max(each):.2g}'))} for {figure}"
        )
    return (
        f"Over the four scenes {count(size)} quasi-random cases do what this many plain ones do: "
        + ", ".join(lines)
        + "."
    )


def parts(found: dict[str, Any]) -> str:
    """What a run spends its time on."""
    sizes = sorted({chosen(found), max(row["samples"] for row in found["sampled"])})
    lines = []
    for key, name in names(found).items():
        for size in sizes:
            row = of(found, key, "quasi_random", size)
            lines.append([name, count(size), *(f"{100.0 * part:.0f} %" for part in row["parts"])])
    return table(["scene", "cases", "drawing", "physics", "statistics"], lines)


def stated(found: dict[str, Any]) -> str:
    """How often the stated standard errors hold the reference, over scenes and seeds."""
    sizes = sorted({row["samples"] for row in found["sampled"]})
    lines = []
    for method in ("quasi_random", "latin_hypercube", "monte_carlo"):
        for figure, pick in (
            ("mean", (0,)),
            ("standard deviation", (1,)),
            ("ends of the interval", (2, 3)),
        ):
            cells = []
            for size in sizes:
                each = [
                    of(found, key, method, size)["within"][i] for key in names(found) for i in pick
                ]
                cells.append(f"{100.0 * sum(each) / len(each):.0f} %")
            lines.append([METHOD_NAMES[method], figure, *cells])
    text = table(["method", "figure", *(f"{count(size)} cases" for size in sizes)], lines)
    return text.replace("| --- | ---: |", "| --- | --- |", 1)


def lowest(found: dict[str, Any]) -> str:
    """Whether the lowest share that ``stated`` lists of a mean or a standard deviation may be
    chance.
    """
    grouped: dict[Any, list[Any]] = {}
    for row in found["sampled"]:
        grouped.setdefault((row["method"], row["samples"]), []).append(row)
    shares = []
    for rows in grouped.values():
        runs = sum(row["seeds"] for row in rows)
        shares += [
            (round(sum(row["seeds"] * row["within"][i] for row in rows)), runs) for i in (0, 1)
        ]
    held, runs = min(shares, key=lambda share: share[0] / share[1])
    chance = sum(math.comb(runs, k) * 0.95**k * 0.05 ** (runs - k) for k in range(held + 1))
    once = f"once in {float(f'{1.0 / chance:.1g}'):.0f} shares"
    return (
        f"The lowest share of a mean or a standard deviation is {held} of {runs} runs. Where the "
        f"true share is 95 percent, chance alone gives so few about {once}, and the table has "
        f"{len(shares)} of these."
    )


def agreement(found: dict[str, Any]) -> str:
    """How far the sampling methods are from the reference, in the standard errors of the
    comparison.
    """
    large = [row for row in found["sampled"] if row["samples"] >= chosen(found)]
    offsets = [abs(offset) for row in large for offset in row["offset"]]
    beyond = sum(offset > 2.0 for offset in offsets) / len(offsets)
    return (
        f"From {count(min(row['samples'] for row in large))} cases on, the means over seeds "
        f"differ from the reference by {max(offsets):.1f} standard errors of the comparison at "
        f"most, and by more than 2 in {percent(beyond)} of {len(offsets)} comparisons. The "
        "reference has an error of its own, the same in all of them."
    )


def local(found: dict[str, Any]) -> str:
    """What the local methods err by, and whether they said so."""
    lines = []
    for row in found["local"]:
        lines.append(
            [
                names(found)[row["scene"]],
                METHOD_NAMES[row["method"]],
                *(f"{100.0 * error:+z.1f} %" for error in row["error"]),
                "warned" if row["warned"] else "silent",
            ]
        )
    text = table(["scene", "method", *FIGURE_NAMES, "it was"], lines)
    return text.replace("| --- | ---: |", "| --- | --- |", 1)


def judged(found: dict[str, Any]) -> Iterator[tuple[str, str, float, bool]]:
    """Every place where a local method gave an answer: where, method, largest error, whether it
    warned.
    """
    for row in found["local"]:
        yield names(found)[row["scene"]], row["method"], max(map(abs, row["error"])), row["warned"]
    for sweep in found["sweeps"]:
        label, _, unit = sweep["label"].split(" (")[0].partition(", ")
        for method, row in sweep["methods"].items():
            for x, error, warned in zip(sweep["x"], row["error"], row["warned"], strict=True):
                if error is not None:
                    yield f"{label}: {number(x)} {unit}".rstrip(), method, error, warned


def refused(found: dict[str, Any]) -> int:
    """At how many places a local method refused, because the model has a kink or a jump at the
    mean.
    """
    return sum(
        row["error"].count(None) for sweep in found["sweeps"] for row in sweep["methods"].values()
    )


def silence(found: dict[str, Any]) -> str:
    """Whether the warning came wherever it had to."""
    places = list(judged(found))
    limit = found["noticed"]
    wrong = [place for place in places if place[2] > limit]
    silent = sorted((place for place in wrong if not place[3]), key=lambda place: -place[2])
    needless = [place for place in places if place[3] and place[2] <= limit]
    text = (
        f"In {len(wrong)} of {len(places)} places of the chart and the table a local method errs "
        f"by more than {limit:g} standard deviations in one of its figures. It warned in "
        f"{len(wrong) - len(silent)} of these"
    )
    if silent:
        where, method, error, _ = silent[0]
        text += (
            f", and was silent in {len(silent)}: at worst it errs by {error:.2g} "
            f"({METHOD_NAMES[method]}, {where})"
        )
    else:
        most = max((place[2] for place in places if not place[3]), default=0.0)
        text += f". The largest error without a warning is {most:.2g} standard deviations"
    text += f". It warned in {len(needless)} places where the error is smaller than that limit."
    if refused(found):
        text += f" In {refused(found)} more places it refused: the model has a kink at the mean."
    return text


def coverage(found: dict[str, Any]) -> str:
    """How often stated intervals held the truth."""
    lines = []
    for scene in found["coverage"]:
        for method, row in scene["methods"].items():
            low, high = wilson(row["held"], row["scenes"])
            lines.append(
                [
                    simulated(found, scene),
                    METHOD_NAMES[method],
                    count(row["scenes"]),
                    (
                        f"{100.0 * row['held'] / row['scenes']:.1f} % ({100.0 * low:.1f} to "
                        f"{100.0 * high:.1f})"
                    ),
                    f"{100.0 * row['below'] / row['scenes']:.1f} %",
                    f"{100.0 * row['above'] / row['scenes']:.1f} %",
                    f"{row['width']:.3g}",
                    *(
                        warnings_of(row)
                        if method in ("first_order", "second_order")
                        else ("–", "–")
                    ),
                ]
            )
    head = [
        "simulated scene",
        "method",
        "scenes",
        "held the truth",
        "truth below",
        "truth above",
        "mean width",
        "warned",
        "held where silent",
    ]
    return table(head, lines).replace("| --- | ---: |", "| --- | --- |", 1)


def warnings_of(row: dict[str, Any]) -> tuple[str, str]:
    """How often a local method warned, and how often its interval held the truth where
    it did not.
    """
    silent = row["scenes"] - row["warned"]
    refused = f", refused {row['refused']}" if row["refused"] else ""
    held = f"{100.0 * row['held_unwarned'] / silent:.0f} %" if silent else "–"
    return f"{100.0 * row['warned'] / row['scenes']:.0f} %{refused}", held


def simulated(found: dict[str, Any], scene: dict[str, Any]) -> str:
    """What a simulated scene is called."""
    return names(found)[scene["key"]] + (
        "" if scene["off"] == 1.0 else f", errors {scene['off']:g} times as stated"
    )


def fit(found: dict[str, Any]) -> str:
    """How often the intervals of a fit held the unknowns."""
    lines = []
    for row in found["fit"]:
        for unknown, held in row["held"].items():
            low, high = wilson(held, row["answered"])
            known = "restitution with a prior" if row["key"] == "prior" else "restitution open"
            lines.append(
                [
                    known,
                    FITTED[unknown],
                    f"{row['answered']} of {row['scenes']}",
                    (
                        f"{100.0 * held / row['answered']:.1f} % ({100.0 * low:.1f} to "
                        f"{100.0 * high:.1f})"
                    ),
                    f"{row['standard_error'][unknown]:.2g}",
                    f"{100.0 * row['rough'] / row['answered']:.0f} %",
                ]
            )
    head = [
        "evidence",
        "unknown",
        "answered",
        "held the truth",
        "median standard error",
        "warned that its errors are rough",
    ]
    return table(head, lines).replace("| --- | ---: |", "| --- | --- |", 1)


def wilson(held: int, tried: int) -> tuple[float, float]:
    """The 95 percent interval of a share that was counted, by Wilson's score."""
    z = 1.959964
    share, square = held / tried, z * z / tried
    middle, half = (
        share + 0.5 * square,
        z * math.sqrt(share * (1.0 - share) / tried + 0.25 * square / tried),
    )
    return max(0.0, (middle - half) / (1.0 + square)), min(1.0, (middle + half) / (1.0 + square))


def summary(found: dict[str, Any]) -> str:
    """The headlines, for people at a terminal."""
    lines = [machine(found), agreement(found), equal(found), silence(found)]
    for scene in found["coverage"]:
        held = ", ".join(
            f"{method} {100.0 * row['held'] / row['scenes']:.1f} %"
            for method, row in scene["methods"].items()
        )
        lines.append(f"  {simulated(found, scene)}: {held}")
    for row in found["fit"]:
        held = ", ".join(
            f"{name} {100.0 * value / row['answered']:.1f} %" for name, value in row["held"].items()
        )
        lines.append(f"  fit, {row['key']}: {held}")
    return "\n".join(lines)
