"""The figure of the motion after both impacts of the commercial program: ours over theirs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import commercial_program as program
import numpy as np
from validation_figures import GREY, INK, OTHER, OURS, style

COLOURS = {"friction 0.8": OTHER, "friction 0.6": OURS}


def draw(path: Path) -> None:
    """Write the figure."""
    import matplotlib as mpl

    mpl.use("agg")
    with mpl.rc_context(style()):
        _draw(path)


def _draw(path: Path) -> None:
    import matplotlib.pyplot as plt

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(7.6, 3.1))
    _in_line(left)
    rows = program.path_of(program.FILES["into the side"])
    for number in "12":
        middle.plot(
            [row[f"x{number}_ft"] for row in rows],
            [row[f"y{number}_ft"] for row in rows],
            "o", color=INK, markersize=2.5, markerfacecolor="none", markeredgewidth=0.6,
        )  # fmt: skip
    after = [row for row in rows if row["time_s"] >= program.SIDE_FROM]
    right.plot(
        [row["time_s"] for row in after],
        [row["yaw2_deg"] % 360.0 for row in after],
        "o", color=INK, markersize=2.5, markerfacecolor="none", markeredgewidth=0.6,
        label="PC-Crash",
    )  # fmt: skip
    times = np.linspace(program.SIDE_FROM, 5.0, 200)
    for ground, colour in COLOURS.items():
        states = program.side_scene(*program.GROUNDS[ground])
        for state in states.values():
            places = [program.place(state(time)) for time in times]
            middle.plot(
                [at["x"] for at in places], [at["y"] for at in places], color=colour, linewidth=1
            )
        turned = [program.place(states["vehicle 2"](time))["heading"] for time in times]
        right.plot(times, turned, color=colour, linewidth=1, label=ground)
    middle.set(title="into the side: paths", xlabel="x, ft", ylabel="y, ft", xlim=(30, 130))
    middle.set_ylim(-6, 18)
    right.set(title="heading of vehicle 2", xlabel="time, s", ylabel="deg")
    right.legend(frameon=False, fontsize=7)
    for axis in (left, middle, right):
        axis.title.set_fontsize(9)
        axis.grid(color=GREY, linewidth=0.3)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def _in_line(axis: Any) -> None:
    rows = program.path_of(program.FILES["in line"])
    start, states = program.in_line_motion()
    times = np.linspace(start, 5.0, 100)
    for number in "12":
        axis.plot(
            [row["time_s"] for row in rows],
            [row[f"x{number}_ft"] for row in rows],
            "o", color=INK, markersize=2.5, markerfacecolor="none", markeredgewidth=0.6,
        )  # fmt: skip
        places = [program.place(states[f"vehicle {number}"](time))["x"] for time in times]
        axis.plot(times, places, color=OURS, linewidth=1)
        axis.annotate(
            f"vehicle {number}", (times[70], places[70] - 9), fontsize=7, va="top", ha="center"
        )
    axis.set(title="in line", xlabel="time, s", ylabel="x, ft")
