"""Runs what the library prints as JavaScript, in node or in headless Chromium, whichever is there;
whole pages in node.
"""

import base64
import functools
import html
import json
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
        done = subprocess.run(
            command, capture_output=True, text=True, encoding="utf-8", check=True, timeout=1200
        )
    found = (
        done.stdout
        if engine() == "node"
        else html.unescape(re.search("<title>(.*?)</title>", done.stdout)[1])
    )
    return np.frombuffer(base64.b64decode(found), dtype="<f8").reshape(len(cases), -1)


# As much of a browser as the page asks for: elements by id, sliders that hold their value within
# their ends, and events.
_BROWSER = """
const pageText = require("fs").readFileSync(0, "utf8");
const attributes = (tag) => Object.fromEntries([...tag.matchAll(/ ([\\w-]+)="([^"]*)"/g)].map(([, \
name, text]) => [name, text]));
const byId = {}, listeners = {}, timers = [];
for (const [tag, name] of pageText.matchAll(/<(\\w+)[^>]* id="[^"]*"[^>]*>/g)) {
  const given = attributes(tag), set = {};
  const dataset = Object.fromEntries(Object.entries(given).filter(([key]) => \
key.startsWith("data-")).map(([key, text]) => [key.slice(5), text]));
  const one = { name, id: given.id, type: given.type, min: given.min, max: given.max, dataset, \
set, textContent: "", innerHTML: "" };
  one.outerHTML = tag + "</" + name + ">";
  one.setAttribute = (key, text) => { set[key] = text; };
  let held = given.value;
  const within = (text) => String(Math.min(Math.max(Number(text), Number(given.min)), \
Number(given.max)));
  Object.defineProperty(one, "value", { get: () => held, set: (text) => { held = Number(text) === \
Number(within(text)) ? String(text) : within(text); } });
  Object.defineProperty(one, "valueAsNumber", { get: () => Number(held) });
  one.reset = () => { held = given.value; };
  byId[given.id] = one;
}
const every = Object.values(byId);
const form = { addEventListener: (kind, call) => { listeners[kind] = call; } };
globalThis.document = {
  getElementById: (id) => byId[id],
  querySelector: (what) => (what === "form" ? form : null),
  querySelectorAll: (what) => every.filter((one) => (what === "input" ? one.name === "input" : \
one.name === "td" && one.dataset.kind)),
};
globalThis.setTimeout = (call) => timers.push(call);
globalThis.clearTimeout = (at) => { if (at) timers[at - 1] = () => {}; };
const texts = (kind) => Object.fromEntries(every.filter((one) => one.name === kind).map((one) => \
[one.id, one.textContent]));
const seen = () => {
  timers.splice(0).forEach((call) => call());
  timers.splice(0).forEach((call) => call());
  return {
    cells: texts("td"), outputs: texts("output"), status: byId.status.textContent, said: \
byId.said.textContent, caption: byId.caption.textContent,
    scene: byId.scene.innerHTML, viewBox: byId.scene.set.viewBox,
    speeds: byId.speeds ? byId.speeds.innerHTML : "",
    values: Object.fromEntries(every.filter((one) => one.name === "input").map((one) => [one.id, \
one.valueAsNumber])),
    aria: Object.fromEntries(every.filter((one) => one.name === "input").map((one) => [one.id, \
one.set["aria-valuetext"]])),
  };
};
(0, eval)(pageText.slice(pageText.indexOf("<script>") + 8, pageText.lastIndexOf("</script>")));
const states = [seen()];
for (const [what, id, given, more] of JSON.parse(process.argv[2])) {
  const target = byId[id];
  if (what === "move") { target.value = given; listeners.input({ target }); }
  if (what === "press") listeners.keydown({ target, key: given, preventDefault: () => {}, ...more \
});
  if (what === "reset") { every.filter((one) => one.name === "input").forEach((one) => \
one.reset()); listeners.reset({}); }
  states.push(seen());
}
process.stdout.write(JSON.stringify(states));
"""


def moved(page, *events):
    """What a page with sliders shows at first and after each event: ("move", id, value), ("press",
    id, key, more), ("reset",).

    Its own script runs in node, with a stand-in for the few things of a browser that it uses.
    """
    if not shutil.which("node"):
        pytest.skip("needs node")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "browser.js")
        file.write_text(_BROWSER, encoding="utf-8")
        command = ["node", str(file), json.dumps(events)]
        done = subprocess.run(
            command,
            input=page,
            capture_output=True,
            text=True,
            check=False,
            timeout=1200,
            encoding="utf-8",
        )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


CHROMIUM = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
]  # fmt: skip
