"""The picture of the first page: the crash of the page "One crash" on four wheels, at the speeds in
the middle of the answer, with its ranges and the places where samples of it come to rest.
"""

from __future__ import annotations

import contextlib
import io

import matplotlib.pyplot as plt
from IPython.display import Image

from pages import names_of

MPH, FOOT = 0.44704, 0.3048
COLOURS = {"Accord": "#1f5fa8", "Civic": "#b3541e"}


def draw() -> Image:
    """The picture."""
    with contextlib.redirect_stdout(io.StringIO()):
        names = names_of("one_crash", until="The same case in metric units")
    axes, found = names["axes"], names["found"]
    said = []
    for name, colour in COLOURS.items():
        x, y = (found.predicted[f"{name}.rest.{axis}"].values / FOOT for axis in "xy")
        axes.plot(x[::16], y[::16], ".", color=colour, ms=3.5, alpha=0.5, zorder=5.5)
        low, high = (end / MPH for end in found[f"speed of the {name}"].interval(0.95))
        said.append(f"{name}: {low:.0f} to {high:.0f} mph")
    axes.set_title(f"{',  '.join(said)}  (95 %)", fontsize=15, fontweight="bold", pad=14)
    axes.set_xlabel(
        "x [ft]\ncrosses: where the police measured the cars at rest; dots: where they stop at the "
        "speeds of the range;\ngrey: tyre marks at the speeds in its middle"
    )
    figure = axes.figure
    figure.set_size_inches(10.0, 6.4)
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=150, bbox_inches="tight")
    plt.close("all")  # also what else the page draws, which would follow the picture here
    return Image(drawn.getvalue())
