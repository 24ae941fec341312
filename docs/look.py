"""Looks at pages in a browser: ``python docs/look.py docs/_build/html`` fails on raw markup, errors
in outputs, a page or cell that scrolls sideways, labels of a figure that cover one another, a page
of pictures without one, and no answer. Without Chromium it says so and passes.

Looked at are a report, the view of a notebook, and pages of the documentation, at 1400 and 800
pixels.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tempfile
from html import unescape
from pathlib import Path

WIDTHS = (1400, 800)
PAGES = ("index", "start_here", "three_impacts", "glossary", "plots", "report")
ILLUSTRATED = ("plots",)  # of these pages, whose cells draw
RAW = re.compile(r"\$\\math|\\mathdefault|\\\*|ERROR:|<(?:table|div|span)\b")
SECONDS = 180
# Loads the page in a frame of some width and writes what it measures into the page that is dumped.
MEASURE = """<!DOCTYPE html><meta charset="utf-8">
<iframe id="page" style="width:%(width)dpx;height:3000px;border:0" src="%(url)s"></iframe>
<pre id="found"></pre><script>
document.getElementById("page").onload = event => {
  const page = event.target.contentDocument, covered = [];
  for (const figure of page.querySelectorAll("figure svg")) {
    const labels = [...figure.querySelectorAll("text")].map(text => [text.textContent.trim(), \
text.getBoundingClientRect()]);
    for (const [i, [one, a]] of labels.entries()) for (const [other, b] of labels.slice(i + 1)) {
      const x = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const y = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (one && other && x > 3 && y > 0.4 * Math.min(a.height, b.height)) covered.push(one + " / \
" + other);
    }
  }
  const cells = [...page.querySelectorAll(".cell pre, .output pre")];
  const wide = cells.filter(pre => pre.scrollWidth > pre.clientWidth + 1);
  const printed = [...page.querySelectorAll(".cell_output pre, .output pre")].map(pre => \
pre.textContent);
  const clone = page.body.cloneNode(true);
  clone.querySelectorAll("script, style, pre, code, details, math").forEach(node => node.remove());
  document.getElementById("found").textContent = JSON.stringify({
    scrolls: page.documentElement.scrollWidth - page.documentElement.clientWidth, covered: \
covered, text: clone.textContent,
    pictures: page.querySelectorAll(".cell_output img, .cell_output svg").length,
    wide: wide.map(pre => pre.textContent.split("\\n").reduce((one, other) => other.length > \
one.length ? other : one).trim()),
    errors: printed.flatMap(text => text.split("\\n")).filter(line => line.includes("ERROR:"))});
};
</script>"""


def browser() -> str | None:
    """The Chromium that is here."""
    return next(
        filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
    )


def made(folder: Path) -> list[Path]:
    """A report, and what a notebook shows of results, each as a page in this folder."""
    import collisions as col
    from collisions.uncertainty import Normal, propagate

    inertia = {"yaw_inertia": "2100 lbf*ft*s**2"}
    a = col.Vehicle(
        mass="3400 lb", vx="45 mph", x="-7 ft", y="0.5 ft", heading="0 deg", name="Camry", **inertia
    )
    b = col.Vehicle(
        mass="2900 lb",
        vy="30 mph",
        x="2.5 ft",
        y="-3 ft",
        heading="90 deg",
        name="Civic",
        **inertia,
    )

    def crash(speed: object) -> col.Impact:
        contact = {"normal": "0 deg", "point": ("0 ft", "0 ft"), "friction": 0.5}
        return col.eccentric(a.replace(vx=speed), b, 0.1, on_failure="nan", **contact)

    impact = crash("45 mph")
    spread = propagate(
        lambda speed: {"b.delta_v": crash(speed).b.q.delta_v},
        {"speed": Normal("45 mph", "2 mph")},
        samples=1024,
        seed=1,
    )
    outlines = {"outline_a": ("15.7 ft", "5.9 ft"), "outline_b": ("13.8 ft", "5.7 ft")}
    views = (impact, impact.a, a, spread, col.diagnose(impact), col.left_out(impact))
    notebook = "<!DOCTYPE html><meta charset='utf-8'><body>" + "<hr>".join(
        view._repr_html_() for view in views
    )
    (folder / "notebook.html").write_text(notebook, encoding="utf-8")
    page = col.report(
        impact,
        units="us",
        uncertainty=spread,
        notes={"restitution": "Published tests."},
        **outlines,
    )
    return [page.save(folder / "report.html"), folder / "notebook.html"]


def look(chromium: str, page: Path, width: int, folder: Path) -> list[str]:
    """What is wrong with a page at this width."""
    frame = folder / "frame.html"
    frame.write_text(MEASURE % {"width": width, "url": page.resolve().as_uri()}, encoding="utf-8")
    command = [
        chromium, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
        "--no-first-run", "--disable-sync",
        "--disable-background-networking", "--disable-component-update",
        "--allow-file-access-from-files",
        f"--window-size={width + 40},1200", "--virtual-time-budget=8000", "--dump-dom",
    ]  # fmt: skip
    for profile in ("profile", "another"):
        run = [*command, f"--user-data-dir={folder / profile}", frame.as_uri()]
        try:
            dump = subprocess.run(
                run, capture_output=True, text=True, encoding="utf-8", timeout=SECONDS, check=True
            ).stdout
            break
        except subprocess.TimeoutExpired:
            continue
    else:
        return [f"could not be measured: twice no answer from the browser within {SECONDS} seconds"]
    found = re.search(r'<pre id="found">(.*?)</pre>', dump, re.DOTALL)
    if found is None or not found[1]:
        return ["could not be measured"]
    measured = json.loads(unescape(found[1]))
    faults = (
        [f"scrolls sideways by {measured['scrolls']} pixels"] if measured["scrolls"] > 1 else []
    )
    if page.stem in ILLUSTRATED and not measured["pictures"]:
        faults.append("has no picture, though its cells draw")
    faults += [f"a label covers another: {pair}" for pair in measured["covered"]]
    faults += [f"a cell scrolls sideways: {line!r}" for line in measured["wide"]]
    faults += [f"an error in an output: {line.strip()!r}" for line in measured["errors"]]
    return faults + [f"raw markup: {raw[0]!r}" for raw in RAW.finditer(measured["text"])]


def main(built: Path) -> int:
    """Look at all pages; gives the exit code."""
    chromium = browser()
    if chromium is None:
        print("no browser here: nothing was looked at")
        return 0
    wrong = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        pages = [*made(folder), *(built / f"{page}.html" for page in PAGES)]
        for page in pages:
            for width in WIDTHS:
                for fault in look(chromium, page, width, folder):
                    print(f"{page.name} at {width} pixels: {fault}")
                    wrong += 1
    print(f"{len(pages)} pages looked at, {wrong} faults")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
