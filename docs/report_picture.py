"""The picture of the first page of a report, as it comes out of the printer.

``python docs/report_picture.py`` prints the report of the page "A report" with Chromium, and writes
its first page again to docs/_static/report_page.png. It needs pdftoppm, of poppler-utils.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE / "_ext")]

from look import browser

from pages import names_of

TARGET = HERE / "_static" / "report_page"
DOTS = "110"  # to an inch


def main() -> None:
    """Print the report, and keep its first page."""
    chromium = browser()
    if chromium is None:
        raise SystemExit("no browser here")
    page = names_of("report", until="Several results on one page")["page"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        html, pdf = page.save(folder / "report.html"), folder / "report.pdf"
        command = [
            chromium, "--headless", "--no-sandbox", "--disable-gpu", "--disable-sync",
            "--no-first-run", "--no-pdf-header-footer", f"--user-data-dir={folder / 'profile'}",
            f"--print-to-pdf={pdf}", html.as_uri(),
        ]  # fmt: skip
        subprocess.run(command, check=True, capture_output=True, timeout=180)
        first = ["pdftoppm", "-png", "-r", DOTS, "-f", "1", "-l", "1", "-singlefile"]
        subprocess.run([*first, str(pdf), str(TARGET)], check=True)


if __name__ == "__main__":
    main()
