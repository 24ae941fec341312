"""Runs what the library prints as JavaScript, in node or in headless Chromium,
whichever is there.
"""

import base64
import functools
import html
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pytest

_HARNESS = """
const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const cases = new Float64Array(bytes("{cases}").buffer);
const found = [];
for (let at = 0; at < cases.length; at += {width}) {{
  found.push(...Object.values(answer(cases.subarray(at, at + {width}))).map(Number));
}}
const raw = new Uint8Array(new Float64Array(found).buffer);
let text = "";
for (const byte of raw) text += String.fromCharCode(byte);
{give};
"""


@functools.cache
def engine():
    """Command of a JavaScript engine; the test is skipped where there is none."""
    for name in ("node", "chromium", "chromium-browser", "google-chrome"):
        if shutil.which(name):
            return name
    return pytest.skip("needs node or Chromium")


def answers(printed, cases):
    """What the printed ``answer`` gives for each row of cases, as rows of floats, bit for bit."""
    cases = np.ascontiguousarray(cases, dtype="<f8")
    plain = {"cases": base64.b64encode(cases.tobytes()).decode(), "width": cases.shape[1]}
    with tempfile.TemporaryDirectory() as folder:
        if engine() == "node":
            file = Path(folder, "printed.js")
            file.write_text(
                printed + _HARNESS.format(**plain, give="process.stdout.write(btoa(text))"),
                encoding="utf-8",
            )
            command = ["node", str(file)]
        else:
            file = Path(folder, "printed.html")
            script = printed + _HARNESS.format(**plain, give="document.title = btoa(text)")
            file.write_text(
                f"<!DOCTYPE html><title></title><script>{script}</script>", encoding="utf-8"
            )
            command = [
                engine(),
                *CHROMIUM,
                f"--user-data-dir={folder}/profile",
                "--dump-dom",
                file.as_uri(),
            ]
        done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120)
    found = (
        done.stdout
        if engine() == "node"
        else html.unescape(re.search("<title>(.*?)</title>", done.stdout)[1])
    )
    return np.frombuffer(base64.b64decode(found), dtype="<f8").reshape(len(cases), -1)


CHROMIUM = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
]  # fmt: skip
