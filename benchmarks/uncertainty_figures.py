"""The figures of the page "How sure"."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from speed_tables import drawing
from stability_tables import GREY, INK, OURS, TEXTBOOK

GREEN, RED = "#2b7a3d", "#a01040"
COLOURS = {
    "first_order": TEXTBOOK,
    "second_order": RED,
    "quasi_random": OURS,
    "latin_hypercube": GREEN,
    "monte_carlo": GREY,
    "interval": INK,
}
MARKS = {
    "quasi_random": "o",
    "latin_hypercube": "s",
    "monte_carlo": "^",
    "first_order": "D",
    "second_order": "v",
}
NAMES = {
    "first_order": "first order",
    "second_order": "second order",
    "quasi_random": "quasi-random",
    "latin_hypercube": "Latin hypercube",
    "monte_carlo": "Monte Carlo",
    "interval": "interval",
}
DRAWN = ("monte_carlo", "latin_hypercube", "quasi_random")
LOCAL = ("first_order", "second_order")
LEAST = 1e-5


def draw_all(found: dict[str, Any], folder: Path, kind: str = "svg") -> None:
    """Every figure of the page."""
    figures: dict[str, Callable[[Any, dict[str, Any]], Any]] = {
        "uncertainty_trade": trade,
        "uncertainty_cost": cost,
        "uncertainty_local": local,
        "uncertainty_sweeps": sweeps,
        "uncertainty_coverage": coverage,
    }
    blank = {
        "svg": {"Date": None, "Creator": None, "Format": None, "Type": None},
        "png": {"Software": None},
    }[kind]
    for name, draw in figures.items():
        path = folder / f"{name}.{kind}"
        with drawing() as plt:
            figure = draw(plt, found)
            figure.savefig(path, metadata=blank, dpi=110)
            plt.close(figure)
        if kind == "svg":  # browsers need no document type, and nothing should point elsewhere
            path.write_text(
                re.sub(r"<!DOCTYPE[^>]*>\s*", "", path.read_text(encoding="utf-8")),
                encoding="utf-8",
            )


def rows(found: dict[str, Any], scene: str, method: str) -> list[dict[str, Any]]:
    """What was measured of a method, by rising number of cases."""
    listed = [
        row
        for row in found["sampled"] + found["local"]
        if (row["scene"], row["method"]) == (scene, method)
    ]
    return sorted(listed, key=lambda row: row["samples"])


def _plain(axis: Any) -> None:
    axis.grid(color="#e3e3e3", lw=0.8)
    axis.set_axisbelow(True)
    axis.spines[["top", "right"]].set_visible(False)


def _shares(axis: Any) -> None:
    """An error scale in percent of the standard deviation, powers of ten written out."""
    ticks = {
        1e-5: "0.001 %",
        1e-4: "0.01 %",
        1e-3: "0.1 %",
        1e-2: "1 %",
        1e-1: "10 %",
        1.0: "100 %",
    }
    axis.set_yticks(list(ticks), list(ticks.values()))
    axis.minorticks_off()


def trade(plt: Any, found: dict[str, Any]) -> Any:
    """Error against cases: a column for each scene, a row for each figure; local methods are lines
    across.
    """
    scenes = found["scenes"]
    figure, axes = plt.subplots(4, len(scenes), figsize=(11.5, 10.6), sharex=True, sharey=True)
    labels = ("mean", "standard deviation", "lower end of 95 %", "upper end of 95 %")
    for column, scene in enumerate(scenes):
        reference = found["references"][scene["key"]]
        own = [error / reference["figures"][1] for error in reference["standard_errors"]]
        for which, axis in enumerate(axes[:, column]):
            for method in DRAWN:
                listed = rows(found, scene["key"], method)
                errors = [max(LEAST, row["error"][which]) for row in listed]
                axis.plot(
                    [row["samples"] for row in listed],
                    errors,
                    "-" + MARKS[method],
                    color=COLOURS[method],
                    ms=4.5,
                    lw=1.6,
                )
            for method, style in zip(LOCAL, ("--", ":"), strict=True):
                (row,) = rows(found, scene["key"], method)
                axis.axhline(
                    max(own[which], abs(row["error"][which])),
                    color=COLOURS[method],
                    ls=style,
                    lw=1.8,
                )
            _plain(axis)
        axes[0, column].set_title(scene["name"].replace(", ", ",\n"), fontsize=10.5)
        axes[-1, column].set_xlabel("cases")
    for axis, label in zip(axes[:, 0], labels, strict=True):
        axis.set_ylabel(label)
    first = axes[0, 0]
    first.set(xscale="log", yscale="log", ylim=(0.8 * LEAST, 2.0))
    _shares(first)
    powers = [7, 9, 11, 13, 15, 17]
    first.set_xticks([2.0**k for k in powers], [_size(2**k) for k in powers])
    figure.legend(handles=_handles(plt, trade=True), loc="upper center", ncols=5, frameon=False)
    figure.subplots_adjust(left=0.09, right=0.985, bottom=0.05, top=0.915, wspace=0.15, hspace=0.11)
    return figure


def _size(size: int) -> str:
    return str(size) if size < 1000 else f"{size / 1024:.0f}k"


def _handles(plt: Any, trade: bool) -> list[Any]:
    found = []
    for method in reversed(DRAWN):
        found.append(
            plt.Line2D(
                [],
                [],
                color=COLOURS[method],
                marker=MARKS[method],
                ms=6,
                lw=1.6,
                label=NAMES[method],
            )
        )
    for method, style in zip(LOCAL, ("--", ":"), strict=True):
        look = (
            {"ls": style, "lw": 1.8}
            if trade
            else {"ls": "", "marker": MARKS[method], "mfc": "white", "mew": 2.0, "ms": 8}
        )
        found.append(plt.Line2D([], [], color=COLOURS[method], label=NAMES[method], **look))
    return found


def cost(plt: Any, found: dict[str, Any]) -> Any:
    """The error of all four figures together against the time of a run."""
    scenes = found["scenes"]
    figure, axes = plt.subplots(1, len(scenes), figsize=(11.5, 4.3), sharex=True, sharey=True)
    for axis, scene in zip(axes, scenes, strict=True):
        for method in (*DRAWN, *LOCAL):
            listed = rows(found, scene["key"], method)
            errors = [
                math.sqrt(sum(error**2 for error in row["error"]) / len(row["error"]))
                for row in listed
            ]
            alone = method in LOCAL
            look: dict[str, Any] = (
                {"mfc": "white", "mew": 2.0, "ms": 8} if alone else {"ms": 4.5, "lw": 1.6}
            )
            axis.plot(
                [row["cost"] for row in listed],
                errors,
                ("" if alone else "-") + MARKS[method],
                color=COLOURS[method],
                **look,
            )
        axis.set_title(scene["name"].replace(", ", ",\n"), fontsize=10.5)
        axis.set_xlabel("cost of a run")
        _plain(axis)
    axes[0].set(xscale="log", yscale="log", ylim=(2e-4, 1.5))
    _shares(axes[0])
    axes[0].set_ylim(2e-4, 1.5)
    axes[0].set_ylabel("error, of the standard deviation")
    low, high = axes[0].get_xlim()
    whole = [
        times * 10**k
        for k in range(math.floor(math.log10(low)), math.ceil(math.log10(high)))
        for times in (1, 3)
    ]
    ticks = [size for size in whole if low <= size <= high]
    # Short, as the labels of whole numbers run into each other.
    axes[0].set_xticks(ticks, [f"{size // 1000}k" if size >= 1000 else f"{size}" for size in ticks])
    axes[0].minorticks_off()
    figure.legend(handles=_handles(plt, trade=False), loc="upper center", ncols=5, frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 0.92))
    return figure


def local(plt: Any, found: dict[str, Any]) -> Any:
    """What the outputs look like, and the intervals of the local methods beside the true ones."""
    figure, axes = plt.subplots(2, 2, figsize=(11.5, 7.4))
    for axis, scene in zip(axes.flat, found["scenes"], strict=True):
        reference = found["references"][scene["key"]]
        mean, std, low, high = reference["figures"]
        edges = reference["edges"]
        heights = [
            share / (b - a) * std
            for share, a, b in zip(reference["shares"], edges, edges[1:], strict=False)
        ]
        top = max(heights)
        axis.stairs(heights, edges, fill=True, color="#c3d4e8", ec=OURS, lw=0.8)
        (first,) = rows(found, scene["key"], "first_order")
        centre, width = first["figures"][:2]
        grid = [edges[0] + (edges[-1] - edges[0]) * k / 300.0 for k in range(301)]
        normal = [
            math.exp(-0.5 * ((x - centre) / width) ** 2) / (width * math.sqrt(2.0 * math.pi)) * std
            for x in grid
        ]
        axis.plot(grid, normal, color=TEXTBOOK, lw=1.8, ls="--")
        step = 0.10 * max(top, *normal)
        bars = [("reference", OURS, (mean, low, high), "")]
        for method in LOCAL:
            (row,) = rows(found, scene["key"], method)
            bars.append(
                (
                    method,
                    COLOURS[method],
                    (row["figures"][0], *row["figures"][2:]),
                    " (warned)" * row["warned"],
                )
            )
        for at, (_, colour, (centre, start, end), said) in enumerate(bars, 1):
            axis.plot([start, end], [-at * step] * 2, color=colour, lw=3, solid_capstyle="butt")
            axis.plot(centre, -at * step, "o", mfc="white", mec=colour, mew=1.8, ms=7)
            if said:
                axis.annotate(
                    "warned",
                    (end, -at * step),
                    (6, 0),
                    textcoords="offset points",
                    va="center",
                    fontsize=9,
                    color=colour,
                )
        for x in (low, high):
            axis.axvline(x, color=OURS, lw=0.8, ls=":")
        axis.axhline(0.0, color=INK, lw=0.8)
        axis.set_yticks([])
        axis.set_ylim(-3.9 * step, 1.05 * max(top, *normal))
        axis.spines[["top", "right", "left"]].set_visible(False)
        axis.set_title(scene["name"], fontsize=11)
        unit = {"yaw rate of B": "rad/s"}.get(scene["output"], "m/s")
        axis.set_xlabel(f"{scene['output']}, {unit}")
    handles = [
        plt.Rectangle((0, 0), 1, 1, fc="#c3d4e8", ec=OURS, label="reference"),
        plt.Line2D([], [], color=TEXTBOOK, lw=1.8, ls="--", label="normal curve of first order"),
    ]
    for colour, label in ((OURS, "reference"), (TEXTBOOK, "first order"), (RED, "second order")):
        handles.append(
            plt.Line2D(
                [],
                [],
                color=colour,
                lw=3,
                marker="o",
                mfc="white",
                mew=1.8,
                ms=7,
                label=f"95 %: {label}",
            )
        )
    figure.legend(handles=handles, loc="upper center", ncols=5, frameon=False, fontsize=10)
    figure.tight_layout(rect=(0, 0, 1, 0.945))
    return figure


def sweeps(plt: Any, found: dict[str, Any]) -> Any:
    """The largest error of the local methods while one input moves past the trouble; filled where
    they warned.
    """
    figure, axes = plt.subplots(1, len(found["sweeps"]), figsize=(11.5, 4.6), sharey=True)
    for axis, sweep in zip(axes, found["sweeps"], strict=True):
        for method in LOCAL:
            row, colour = sweep["methods"][method], COLOURS[method]
            places = [
                (x, y, w)
                for x, y, w in zip(sweep["x"], row["error"], row["warned"], strict=True)
                if y is not None
            ]
            axis.plot(
                [x for x, _, _ in places],
                [y for _, y, _ in places],
                color=colour,
                lw=1.2,
                alpha=0.7,
            )
            for filled in (True, False):
                xs, ys = ([place[k] for place in places if place[2] == filled] for k in (0, 1))
                axis.plot(
                    xs,
                    ys,
                    MARKS[method],
                    ms=6,
                    mec=colour,
                    mfc=colour if filled else "white",
                    mew=1.4,
                )
        axis.axhline(found["noticed"], color=INK, lw=1.0, ls="--")
        axis.set_xlabel(sweep["label"].replace(" (", "\n("))
        name = next(scene["name"] for scene in found["scenes"] if scene["key"] == sweep["scene"])
        axis.set_title(name.split(",")[0], fontsize=10.5)
        _plain(axis)
    most = max(
        max(filter(None, row["error"]))
        for sweep in found["sweeps"]
        for row in sweep["methods"].values()
    )
    axes[0].set(yscale="log", ylim=(0.004, 1.3 * most))
    _shares(axes[0])
    axes[0].set_yticks([0.01, 0.1, 1.0], ["1 %", "10 %", "100 %"])
    axes[0].set_ylim(0.004, 1.3 * most)
    axes[0].set_ylabel("largest error, of the standard deviation")
    handles = [
        plt.Line2D(
            [], [], color=COLOURS[method], marker=MARKS[method], ms=7, lw=1.2, label=NAMES[method]
        )
        for method in LOCAL
    ]
    handles += [
        plt.Line2D([], [], ls="", marker="o", mfc=INK, mec=INK, ms=7, label="warned"),
        plt.Line2D([], [], ls="", marker="o", mfc="white", mec=INK, ms=7, label="silent"),
        plt.Line2D([], [], color=INK, lw=1.0, ls="--", label="limit of the warning"),
    ]
    figure.legend(handles=handles, loc="upper center", ncols=5, frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 0.92))
    return figure


def coverage(plt: Any, found: dict[str, Any]) -> Any:
    """How often stated intervals held the truth, with the binomial error of the count."""
    from uncertainty_tables import FITTED, simulated, wilson

    groups = [
        (
            simulated(found, scene),
            [
                (NAMES[m], COLOURS[m], row["held"], row["scenes"])
                for m, row in scene["methods"].items()
            ],
        )
        for scene in found["coverage"]
    ]
    for row in found["fit"]:
        name = "fit, restitution with a prior" if row["key"] == "prior" else "fit, restitution open"
        groups.append(
            (
                name,
                [
                    (FITTED[unknown], OURS, held, row["answered"])
                    for unknown, held in row["held"].items()
                ],
            )
        )
    figure, axis = plt.subplots(
        figsize=(11.5, 0.27 * sum(len(lines) + 1.6 for _, lines in groups) + 1.0)
    )
    place, ticks = 0.0, []
    axis.axvline(95.0, color=INK, lw=1.2, ls="--", zorder=1)
    for name, lines in groups:
        axis.text(
            0.0,
            place,
            name,
            transform=axis.get_yaxis_transform(),
            fontweight="bold",
            fontsize=10.5,
            va="center",
        )
        place += 1.0
        for label, colour, held, tried in lines:
            low, high = wilson(held, tried)
            axis.plot([100.0 * low, 100.0 * high], [place, place], color=colour, lw=2.0, zorder=2)
            axis.plot(
                100.0 * held / tried, place, "o", mfc="white", mec=colour, mew=2.0, ms=8, zorder=3
            )
            ticks.append((place, label))
            place += 1.0
        place += 0.6
    axis.set_yticks([at for at, _ in ticks], [label for _, label in ticks])
    axis.set_ylim(place - 0.6, -0.8)
    axis.set_xlim(min(60.0, axis.get_xlim()[0]), 100.5)
    axis.set_xlabel("intervals of 95 percent that held the truth, percent")
    axis.grid(axis="x", color="#e3e3e3", lw=0.8)
    axis.set_axisbelow(True)
    axis.tick_params(axis="y", length=0)
    axis.spines[["top", "right", "left"]].set_visible(False)
    figure.tight_layout()
    return figure
