"""The figures of the page "Validation": computed against published or measured, a panel for each
quantity.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

INK, OURS, OTHER, WRONG, GREY = "#1a1a1a", "#1f5fa8", "#b3541e", "#8a1c1c", "#9a9a9a"
MPH, FOOT = 0.44704, 0.3048
# To the unit of the panel.
UNITS = {
    "m/s": 3.6,
    "km/h": 1.0,
    "mph": 3.6 * MPH,
    "ft/s": 3.6 * FOOT,
    "ft/s left": 3.6 * FOOT,
    "rad/s": math.degrees(1.0),
    "deg/s": 1.0,
    "ft lb": 1.3558179483,
    "J": 1.0,
}
PANELS = {
    "velocity": "km/h",
    "delta-V": "km/h",
    "delta-V rearward": "km/h",
    "delta-V to the right": "km/h",
    "delta-V, in line": "km/h",
    "delta-V from the closing speed": "km/h",
    "delta-V from the other car's": "km/h",
    "yaw rate": "deg/s",
    "energy": "kJ",
    "direction": "degrees",
    "impulse, momentum or mass": "each in its own unit",
}


def factor(figure: dict[str, Any]) -> float:
    """From the unit of a figure to that of its panel."""
    if PANELS.get(figure["quantity"]) in ("km/h", "deg/s", "kJ"):
        unit = figure["unit"].removesuffix(" ccw").removesuffix(" cw").removesuffix(" left")
        return UNITS[unit] * (1e-3 if PANELS[figure["quantity"]] == "kJ" else 1.0)
    return 1.0


def style() -> dict[str, Any]:
    """What all figures of the page look like."""
    return {
        "font.size": 9,
        "font.family": "DejaVu Sans",
        "figure.facecolor": "white",
        "savefig.facecolor": "white",
        "svg.fonttype": "path",
        "svg.hashsalt": "collisions",
    }


def draw(found: dict[str, Any], name: str, path: Path) -> None:
    """One figure for one table."""
    import matplotlib as mpl

    mpl.use("agg")
    with mpl.rc_context(style()):
        _draw(found[name], name, path)


def _draw(cases: dict[str, Any], name: str, path: Path) -> None:
    import matplotlib.pyplot as plt

    quantities = [entry["quantity"] for entry in cases["statistics"]]
    rows = math.ceil(len(quantities) / 3)
    height = 2.85 * rows + 0.45
    figure, axes = plt.subplots(rows, 3, figsize=(7.6, height), squeeze=False)
    for axis, quantity in zip(axes.flat, quantities, strict=False):
        _panel(axis, quantity, cases, name)
    for axis in list(axes.flat)[len(quantities) :]:
        axis.set_visible(False)
    against = "published" if name == "agreement" else "measured"
    figure.supxlabel(against, fontsize=10)
    figure.supylabel("computed" if name != "predictions" else "predicted", fontsize=10)
    figure.legend(
        handles=_key(name),
        loc="upper center",
        ncols=4,
        frameon=False,
        fontsize=9,
        columnspacing=1.4,
    )
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.35 / height), h_pad=1.5, w_pad=1.0)
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None, dpi=110)
    plt.close(figure)


def _key(name: str) -> list[Any]:
    import matplotlib.pyplot as plt

    def of(marker: str, label: str, **look: Any) -> Any:
        return plt.Line2D([], [], ls="", marker=marker, ms=6, label=label, **look)

    filled, hollow = {"color": OURS}, {"mfc": "none", "mec": OTHER, "mew": 1.3, "color": OTHER}
    cross = {"color": WRONG, "mew": 1.8}
    band = plt.Line2D(
        [],
        [],
        color=GREY,
        lw=1,
        label="equal" if name == "agreement" else "equal; dotted: 10 % off",
    )
    if name == "agreement":
        return [
            of("o", "law of the source, or no friction", **filled),
            of("s", "the other law", **hollow),
            of("x", "misprint", **cross),
            band,
        ]
    if name == "fits":
        return [
            of("o", "brach (the law of the fit)", **filled),
            of("s", "kudlich-slibar", **hollow),
            band,
        ]
    return [of("o", "predicted", **filled), of("x", "reading doubtful", **cross), band]


def _panel(axis: Any, quantity: str, cases: dict[str, Any], name: str) -> None:
    points = [
        (case, each, factor(each))
        for case in cases["cases"]
        for each in case["figures"]
        if each["quantity"] == quantity
    ]
    seen = []
    for case, each, times in points:
        x, y = float(each["printed"]) * times, each["computed"] * times
        seen += [x, y]
        for law, entry in each.get("by_law", {}).items():
            if law != case["law"]:
                seen.append(entry["computed"] * times)
                axis.plot(
                    x,
                    entry["computed"] * times,
                    "s",
                    mfc="none",
                    mec=OTHER,
                    ms=6.5,
                    mew=1.3,
                    zorder=2,
                )
        look = (
            {"marker": "x", "color": WRONG, "mew": 1.8}
            if each["wrong"]
            else {"marker": "o", "color": OURS}
        )
        axis.plot(x, y, ls="", ms=6 if each["wrong"] else 4.5, zorder=3, **look)
    _axes(axis, quantity, seen, name)
    unit = PANELS.get(quantity)
    axis.set_title(quantity + (f"\n[{unit}]" if unit else "\n[1]"), fontsize=9, color=INK)
    axis.tick_params(labelsize=8, length=3)
    for spine in ("top", "right"):
        axis.spines[spine].set_visible(False)


def _axes(axis: Any, quantity: str, seen: list[float], name: str) -> None:
    scale: dict[str, Any]
    if quantity == "impulse, momentum or mass":
        low, high, scale = -3e3, 1e6, {"value": "symlog", "linthresh": 100.0}
    elif name == "agreement" and quantity == "yaw rate":
        low, high, scale = -5e2, 1e4, {"value": "symlog", "linthresh": 10.0}
    else:
        margin = 0.12 * (max(seen) - min(seen)) or 0.1 * abs(seen[0])
        low, high, scale = min(seen) - margin, max(seen) + margin, {"value": "linear"}
    for axis_scale, limits in ((axis.set_xscale, axis.set_xlim), (axis.set_yscale, axis.set_ylim)):
        axis_scale(**scale)
        limits(low, high)
    if scale["value"] == "linear":
        axis.locator_params(nbins=4)
    elif scale["value"] == "symlog":
        ticks = [-100, 0, 1000] if quantity == "yaw rate" else [-1e3, 0, 1e3, 1e5]
        axis.set_xticks(
            ticks, [f"{tick:,.0f}".replace("-", "−").replace(",", " ") for tick in ticks]
        )
        axis.set_yticks(
            ticks, [f"{tick:,.0f}".replace("-", "−").replace(",", " ") for tick in ticks]
        )
        axis.minorticks_off()
    axis.plot([low, high], [low, high], color=GREY, lw=1, zorder=1)
    if name != "agreement" and quantity != "restitution read":
        for part in (0.9, 1.1):
            axis.plot([low, high], [part * low, part * high], color=GREY, lw=0.9, ls=":", zorder=1)
    axis.set_box_aspect(1)
