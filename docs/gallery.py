"""The small pictures of the gallery: the first figure that each example draws.

``python docs/gallery.py [stem ...]`` runs the examples (all, or those named) and writes them again
to docs/_static/gallery/.
"""

import contextlib
import io
import runpy
import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt

HERE = Path(__file__).resolve().parent
FOLDER = HERE / "_static" / "gallery"
WIDTH = 1040  # pixels: twice what a card shows, so that small labels are sharp


def draw(script: Path) -> None:
    """Run an example and keep its first figure, if it draws one."""
    with contextlib.redirect_stdout(io.StringIO()):
        runpy.run_path(str(script), run_name="__main__")
    numbers = plt.get_fignums()
    if numbers:
        figure = plt.figure(numbers[0])
        figure.savefig(
            FOLDER / f"{script.stem}.png",
            dpi=WIDTH / figure.get_size_inches()[0],
            metadata={"Software": None},
        )
    plt.close("all")
    print(f"{script.stem}: {len(numbers)} figures")


def main(stems: list[str]) -> None:
    """Those named, or all."""
    FOLDER.mkdir(exist_ok=True)
    for script in sorted((HERE.parent / "examples").glob("*.py")):
        if not stems or script.stem in stems:
            draw(script)


if __name__ == "__main__":
    main(sys.argv[1:])
