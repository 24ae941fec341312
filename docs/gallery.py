"""The cards of the gallery: a picture for each example, drawn for the size of a card from what the
example worked out.

``python docs/gallery.py [stem ...]`` runs the examples (all, or those named) and writes their cards
again to docs/_static/gallery/. An example without a card of its own shows its first figure.
"""

from __future__ import annotations

import contextlib
import io
import math
import runpy
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
import numpy as np

import collisions as col
from collisions.plot.body import draw_body
from collisions.plot.scene import corners_of

HERE = Path(__file__).resolve().parent
FOLDER = HERE / "_static" / "gallery"
WIDTH = 1040  # pixels: twice what a card shows, so that small labels are sharp
SIZE = (5.2, 3.1)  # inches: text of ten points is as large on the card as that around it
COLOURS = ("#1f5fa8", "#b3541e", "#2f7d4f")
INK, GREY = "#1a1a1a", "#6a6a6a"
KMH = 3.6

Names = dict[str, Any]
CARDS: dict[str, Callable[[Any, Names], None]] = {}


def card(stem: str) -> Callable[[Callable[[Any, Names], None]], Callable[[Any, Names], None]]:
    """The function that follows draws the card of this example on Axes from its names."""

    def keep(draw: Callable[[Any, Names], None]) -> Callable[[Any, Names], None]:
        CARDS[stem] = draw
        return draw

    return keep


def plan(axes: Any) -> None:
    """Axes of a plan view: no frame, one scale."""
    axes.set_aspect("equal", adjustable="datalim")
    axes.axis("off")
    axes.margins(0.06)


def car(axes: Any, vehicle: Any, outline: Any, index: int, filled: float = 0.25) -> None:
    """A vehicle where it is; faint if it is not filled."""
    corners = corners_of(vehicle, outline, "outline", "a")
    draw_body(
        axes, corners, "car", COLOURS[index], metre=1.0, filled=filled, width=1.4 if filled else 0.8
    )


def arrow(axes: Any, tail: Any, vector: Any, colour: str, dashed: bool = False) -> None:
    """An arrow from here along a vector."""
    tip = tail[0] + vector[0], tail[1] + vector[1]
    axes.annotate(
        "", tip, tail,
        arrowprops={
            "arrowstyle": "-|>", "mutation_scale": 16, "lw": 2.4, "color": colour,
            "ls": (0, (3, 1.5)) if dashed else "-", "shrinkA": 0, "shrinkB": 0,
        },
        zorder=6,
    )  # fmt: skip
    axes.plot(*zip(tail, tip, strict=True), alpha=0.0)


def said(axes: Any, text: str, place: tuple[float, float] = (0.5, -0.02), **style: Any) -> None:
    """A line of the card in large letters, at shares of it."""
    given = {"ha": "center", "va": "top", "fontsize": 13, "color": INK} | style
    axes.text(*place, text, transform=axes.transAxes, **given)


def struck(axes: Any, impact: Any, outlines: Any, text: str, scale: float = 0.16) -> None:
    """An impact from above: where the vehicles are, how they came (dashed) and leave."""
    for index, (side, outline) in enumerate(zip((impact.a, impact.b), outlines, strict=True)):
        before, after, colour = side.before, side.after, COLOURS[index]
        if outline is None:
            continue
        car(axes, before, outline, index)
        at = before.x, before.y
        come = scale * before.vx, scale * before.vy
        if before.speed:
            arrow(axes, (at[0] - come[0], at[1] - come[1]), come, colour, dashed=True)
        if after.speed > 0.5:
            arrow(axes, at, (scale * after.vx, scale * after.vy), colour)
    if impact.point is not None:
        axes.plot(*impact.point, "X", ms=11, mfc=INK, mec="white", zorder=8)
    plan(axes)
    said(axes, text)


def chart(axes: Any, x: str, y: str = "") -> None:
    """Axes of a chart: few ticks, large letters."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.locator_params(nbins=4)
    axes.tick_params(labelsize=11)
    axes.set_xlabel(x, fontsize=12)
    axes.set_ylabel(y, fontsize=12)


def ranges(axes: Any, rows: list[tuple[str, float, float]], unit: str) -> None:
    """Ranges one above the other, each with its name and its ends."""
    start = 0.75 * min(low for _, low, _ in rows)
    for row, (name, low, high) in enumerate(rows[::-1]):
        colour = COLOURS[(len(rows) - 1 - row) % len(COLOURS)]
        axes.plot([low, high], [row, row], lw=11, color=colour, solid_capstyle="butt", alpha=0.8)
        span = f"{low:.0f} to {high:.0f}" if high > low else f"{low:.0f}"
        if high <= low:
            axes.plot([low], [row], "o", ms=11, color=colour)
        axes.text(start, row + 0.2, f"{name}: {span} {unit}", fontsize=12, color=INK, va="bottom")
    axes.set_xlim(start, 1.15 * max(high for _, _, high in rows))
    axes.set_ylim(-0.5, len(rows) - 0.2)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    chart(axes, unit)


def histogram(axes: Any, values: Any, x: str, text: str) -> None:
    """How often each value came, with the range of 95 in 100."""
    low, high = np.quantile(values, [0.025, 0.975])
    axes.hist(values, bins=60, color="#c9d6e6")
    axes.axvspan(low, high, color=COLOURS[0], alpha=0.12)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    chart(axes, x)
    axes.set_title(text.format(low=low, high=high), fontsize=13)


@card("barrier")
def _(axes: Any, names: Names) -> None:
    impact = names["corners"][0.3]
    along = np.array([-math.sin(math.radians(70)), math.cos(math.radians(70))])
    at = np.array(impact.point)
    wall = np.array([at - 3.2 * along, at + 3.2 * along])
    axes.plot(*wall.T, color=INK, lw=5, solid_capstyle="butt")
    struck(axes, impact, (names["OUTLINE"], None), "a corner against a slanted wall")


@card("chain_of_three")
def _(axes: Any, names: Names) -> None:
    run, found, size = names["run"], names["found"], (4.4, 1.8)
    moments = ((0.0, "hit"), (run.times[1], "second hit"), (run.end, "at rest"))
    for row, (time, what) in enumerate(moments):
        states = run.at(time)
        for index, name in enumerate(names["cars"]):
            car(axes, states[name].replace(y=-3.4 * row), size, index, 0.12 + 0.08 * row)
        axes.text(-7.5, -3.4 * row, what, ha="right", va="center", fontsize=12)
    axes.plot([-14], [0], alpha=0)
    plan(axes)
    low, high = (end * KMH for end in found["speed of the van"].interval())
    said(axes, f"the van, left: {low:.0f} to {high:.0f} km/h")


@card("crossroads")
def _(axes: Any, names: Names) -> None:
    outline = names["OUTLINE"]
    struck(axes, names["impact"], (outline, outline), "an oncoming car turns left")


@card("eccentric_types")
def _(axes: Any, names: Names) -> None:
    a, b = names["A"], names["TYPES"]["front door"][0]
    impact = col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5)
    struck(axes, impact, (names["OUTLINE"], names["OUTLINE"]), "front into a door, and three more")


@card("example_2_backwards")
def _(axes: Any, names: Names) -> None:
    truth = names["TRUTH"]
    for y, a, b, when in (
        (1.0, truth["va"], truth["vb"], "before: what is sought"),
        (-1.8, truth["va_after"], truth["vb_after"], "after: what was found"),
    ):
        for index, (x, speed) in enumerate(((-4.2, a), (1.6, b))):
            vehicle = col.Vehicle(mass=1000, x=x, y=y, heading=0.0)
            car(axes, vehicle, (4.2, 1.7), index, 0.25 if y < 0 else 0.12)
            label = f"{speed * KMH:.0f} km/h"
            axes.text(x, y + 1.25, label, ha="center", fontsize=12, color=COLOURS[index])
        axes.text(4.6, y, when.replace(": ", ":\n"), fontsize=11, va="center", color=GREY)
    axes.plot([9.5], [0], alpha=0)
    plan(axes)


@card("in_line_by_momentum_and_ees")
def _(axes: Any, names: Names) -> None:
    rows = [
        (f"EES {label}", KMH * impact.closing_speed, KMH * impact.closing_speed)
        for label, (impact, *_) in names["judged"].items()
    ]
    ranges(axes, rows, "km/h")


@card("intersection_reconstruction")
def _(axes: Any, names: Names) -> None:
    result = names["result"]
    rows = [
        (name, *(KMH * end for end in result[name].interval(0.95))) for name in names["answers"]
    ]
    ranges(axes, rows, "km/h")


@card("million_cases")
def _(axes: Any, names: Names) -> None:
    text = "a million cases: {low:.0f} to {high:.0f} km/h"
    histogram(axes, names["answered"] * KMH, "delta-V of B [km/h]", text)


@card("paper_examples")
def _(axes: Any, names: Names) -> None:
    impact = names["impact"]
    a, b = impact.a.before, impact.b.before
    axes.plot([0], [0], "^", ms=13, mfc="white", mec=COLOURS[1], mew=2, zorder=7)
    bar = col.Vehicle(mass=1, x=b.x, y=b.y, heading=math.pi / 2)
    for index, (vehicle, size) in enumerate(((a, (1.9, 1.0)), (bar, (4.0, 0.4)))):
        placed = vehicle.replace(heading=0.0) if index == 0 else vehicle
        corners = corners_of(placed, size, "outline", "a")
        axes.fill(*zip(*corners, strict=True), fc=COLOURS[index], alpha=0.25)
        axes.fill(*zip(*corners, strict=True), fc="none", ec=COLOURS[index], lw=1.6)
    arrow(axes, (a.x - 3.6, a.y), (2.5, 0.0), COLOURS[0], dashed=True)
    turn = np.linspace(math.pi / 2, 0.9, 30)
    axes.plot(4.6 * np.cos(turn), 4.6 * np.sin(turn), color=COLOURS[1], lw=2.2)
    plan(axes)
    said(axes, "the paper's three examples, to the digit")


@card("pivoted_vehicle")
def _(axes: Any, names: Names) -> None:
    many = names["many"]
    push = np.asarray(many.b.pivot_impulse_x) / 1000.0
    axes.axhline(0.0, color=GREY, lw=1)
    axes.plot(names["heights"], push, color=COLOURS[1], lw=3)
    axes.plot([names["percussion"]], [0.0], "o", ms=10, color=INK)
    axes.annotate(
        "no push\non the pivot", (names["percussion"], 0.0), (14, 22),
        textcoords="offset points", fontsize=12,
    )  # fmt: skip
    chart(axes, "height of the blow [m]", "kN·s")


@card("pole_from_crush")
def _(axes: Any, names: Names) -> None:
    run, found = names["run"], names["found"]
    for time, filled in ((0.0, 0.0), (run.end, 0.25)):
        car(axes, run.at(time)["Car"], (4.4, 1.8), 0, filled)
    axes.plot([0], [0], "o", ms=15, color=INK, zorder=7)
    axes.text(0.35, 0.1, "pole", fontsize=12)
    start = run.at(0.0)["Car"]
    arrow(axes, (start.x - 3.2, start.y + 1.2), (2.0, 0.0), COLOURS[0], dashed=True)
    plan(axes)
    low, high = (end * KMH for end in found["speed of the car"].interval())
    said(axes, f"from its dent and where it stands:\n{low:.0f} to {high:.0f} km/h")


@card("pole_after_side_impact")
def _(axes: Any, names: Names) -> None:
    run, found = names["run"], names["found"]
    sizes = {"Hatchback": (4.2, 1.75), "Saloon": (4.6, 1.8)}
    for time, filled in ((0.0, 0.0), (run.times[1], 0.12), (run.end, 0.25)):
        states = run.at(time)
        for index, (name, size) in enumerate(sizes.items()):
            if name == "Hatchback" or time != run.times[1]:
                car(axes, states[name], size, index, filled)
    for index, name in enumerate(sizes):
        axes.plot(run.paths[name].x, run.paths[name].y, color=COLOURS[index], lw=1.4, ls="--")
    axes.plot([5.0], [2.3], "o", ms=11, color=INK, zorder=9)
    axes.text(5.3, 2.5, "pole", fontsize=12)
    plan(axes)
    low, high = (end * KMH for end in found["Hatchback.speed"].interval(0.95))
    said(axes, f"the hatchback, from where all stood: {low:.0f} to {high:.0f} km/h")


@card("pole_impact")
def _(axes: Any, names: Names) -> None:
    impact = names["impact"]
    axes.add_patch(plt.Circle((0.0, 0.0), names["RADIUS"], color=INK, zorder=9))
    struck(axes, impact, (("4.4 m", "1.8 m"), None), "sideways into a pole")


@card("published_solutions")
def _(axes: Any, names: Names) -> None:
    ours, printed = [], []
    for _, one, other, unit, _ in names["CHECKS"]:
        if unit == "mph" and other > 0.5:
            ours.append(one)
            printed.append(other)
    axes.plot([0, max(printed)], [0, max(printed)], color=GREY, lw=1)
    axes.plot(printed, ours, "o", ms=9, color=COLOURS[0])
    chart(axes, "printed delta-V [mph]", "here [mph]")


@card("rear_end_from_recorder")
def _(axes: Any, names: Names) -> None:
    rows = [
        (f"restitution {label}".replace("falls with the speed", "by speed"), value, value)
        for label, value in names["in_line"].items()
    ]
    ranges(axes, rows, "km/h")


@card("sideswipe")
def _(axes: Any, names: Names) -> None:
    outlines = (("4.5 m", "1.8 m"), ("4.4 m", "1.75 m"))
    struck(axes, names["scrape"], outlines, "two cars scrape past", 0.2)


@card("study_over_processes")
def _(axes: Any, names: Names) -> None:
    text = "one study, many processes:\n{low:.0f} to {high:.0f} km/h"
    a, b, restitution = names["drawn"](20000, seed=8)
    found = names["solve"](col.Vehicle(**a), col.Vehicle(**b), restitution).a.delta_v * KMH
    histogram(axes, found[np.isfinite(found)], "delta-V of A [km/h]", text)


@card("study_with_dask")
def _(axes: Any, names: Names) -> None:
    for row in range(3):
        for column in range(6):
            axes.add_patch(
                plt.Rectangle(
                    (column, row), 0.86, 0.8, fc=COLOURS[0], alpha=0.25 + 0.1 * (row + column % 3)
                )
            )
    axes.annotate(
        "", (8.0, 1.4), (6.2, 1.4), arrowprops={"arrowstyle": "-|>", "lw": 3, "color": INK}
    )
    axes.text(8.2, 1.4, "answers,\nblock by block", fontsize=13, va="center")
    axes.plot([0, 11.5], [0, 2.8], alpha=0)
    plan(axes)
    said(axes, "blocks of cases on dask workers")


@card("table_of_cases")
def _(axes: Any, names: Names) -> None:
    report = names["report"]
    heads = ["case", "delta-V of B", "status"]
    cells = []
    for case, row in report.iterrows():
        found = row["delta-V b [km/h]"]
        text = f"{found:.1f} km/h" if math.isfinite(found) else "none"
        cells.append([str(case), text, str(row["status"])])
    table = axes.table(cells, colLabels=heads, loc="center", cellLoc="center", edges="horizontal")
    table.auto_set_font_size(False)
    table.set_fontsize(11)
    table.scale(1.05, 2.0)
    axes.axis("off")


@card("three_cars")
def _(axes: Any, names: Names) -> None:
    run = names["run"]
    for row, time in enumerate((0.0, run.times[0], run.times[1], run.end)):
        states = run.at(time)
        for index, name in enumerate(names["NAMES"]):
            state = states[name].replace(y=-2.6 * row)
            car(axes, state, (names["LENGTH"], 1.8), index, 0.12 + 0.06 * row)
        axes.text(-17.5, -2.6 * row, f"{time:.2f} s", ha="right", va="center", fontsize=12)
    axes.plot([-23], [0], alpha=0)
    plan(axes)


@card("truck_against_car")
def _(axes: Any, names: Names) -> None:
    outlines = (("4 m", "1.8 m"), ("8 m", "2.5 m"))
    struck(axes, names["impact"], outlines, "a car against a truck")


@card("two_accounts")
def _(axes: Any, names: Names) -> None:
    for index, (key, who) in enumerate(
        (("driver_a", "as driver A says"), ("driver_b", "as driver B says"))
    ):
        values = names[key].draws["speed_a"] * KMH
        axes.hist(values, bins=40, color=COLOURS[index], alpha=0.55, label=who, density=True)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    chart(axes, "speed of A [km/h]")
    axes.legend(fontsize=12, frameon=False, loc="upper left")


@card("two_accounts_of_a_chain")
def _(axes: Any, names: Names) -> None:
    for row, (name, scene) in enumerate(names["scenes"].items()):
        for index, mover in enumerate(scene.movers.values()):
            state = mover.vehicle
            car(axes, state.replace(y=-3.6 * row), (names["LONG"], 1.8), index, 0.2)
            if state.speed:
                tail = (state.x - 1.6, -3.6 * row)
                arrow(axes, tail, (0.2 * state.speed, 0.0), COLOURS[index])
        axes.text(2.8, -3.6 * row, name.replace(" ", "\n", 1), va="center", fontsize=12)
    axes.plot([9.0], [0], alpha=0)
    plan(axes)
    log = names["found"].log_bayes_factors["hatchback stood", "hatchback came first"]
    factor = float(f"{math.exp(log):.1g}")
    said(axes, f"the first fits better, by a factor of about {factor:.0f}")


@card("us_units")
def _(axes: Any, names: Names) -> None:
    outlines = (("15 ft", "5.8 ft"), ("15.7 ft", "5.8 ft"))
    delta_v = names["impact"].b.q.delta_v.to("mph")
    struck(axes, names["impact"], outlines, f"delta-V {delta_v:.1f~P} in a staged crash", 0.2)


def draw(script: Path) -> None:
    """Run an example and draw its card, or keep its first figure."""
    with contextlib.redirect_stdout(io.StringIO()):
        main = (
            "__main__" if script.stem not in ("study_over_processes", "study_with_dask") else "card"
        )
        names = runpy.run_path(str(script), run_name=main)
    first = plt.get_fignums()[:1]
    if script.stem in CARDS:
        figure, axes = plt.subplots(figsize=SIZE, layout="constrained")
        CARDS[script.stem](axes, names)
    elif first:
        figure = plt.figure(first[0])
    else:
        print(f"{script.stem}: no picture")
        return
    figure.savefig(
        FOLDER / f"{script.stem}.png",
        dpi=WIDTH / figure.get_size_inches()[0],
        metadata={"Software": None},
    )
    plt.close("all")
    print(script.stem)


def main(stems: list[str]) -> None:
    """Those named, or all."""
    FOLDER.mkdir(exist_ok=True)
    for script in sorted((HERE.parent / "examples").glob("*.py")):
        if not stems or script.stem in stems:
            draw(script)


if __name__ == "__main__":
    main(sys.argv[1:])
