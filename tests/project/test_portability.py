"""What differs between systems is said in the code: encodings and line ends of files, and nothing
that follows the locale.
"""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

import collisions

SOURCE = Path(collisions.__file__).resolve().parent
CASE = """\
[a]
mass = "1500 kg"
vx = "50 km/h"
name = "Škoda Citroën 車"
[b]
mass = 1200
[linear_central]
restitution = "0.1 .. 0.3"
[propagate]
method = "interval"
"""
DIFFERS = ("sep", "altsep", "linesep", "fork")  # of os
# An environment in which a file without an encoding is one of ASCII.
ASCII = {"PYTHONUTF8": "0", "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0"}
# Saves a report, and makes it again from the file alone.
ROUND_TRIP = """
import locale, sys
import collisions as col
from collisions.reporting import options, replay, report

assert (sys.argv[1] == "ascii") == (locale.getpreferredencoding(False).lower() != "utf-8")
a = col.Vehicle(mass="1500 kg", vx="50 km/h", name="\\u0160koda \\u8eca")
impact = col.linear_central(a, col.Vehicle(mass=1200.0), 0.25)
report(impact, title="\\u00e9tude").save("saved.html")
with open("saved.html", encoding="utf-8") as file:
    text = file.read()
assert report(replay(text), **options(text)) == text
"""


def mode(call):
    """The mode of a call of ``open``, as a function or as a method of a path."""
    after_the_path = 0 if isinstance(call.func, ast.Attribute) else 1
    given = [keyword.value for keyword in call.keywords if keyword.arg == "mode"] + call.args[
        after_the_path : after_the_path + 1
    ]
    return given[0].value if given else "r"


def of_a_call(call, only_closed):
    """What is wrong with a call; a file that is only opened and closed has no text."""
    name = getattr(call.func, "attr", getattr(call.func, "id", ""))
    if name in ("strftime", "setlocale", "localeconv"):
        return f"{name} follows the locale"
    said = {keyword.arg for keyword in call.keywords}
    wanted = set()
    if name == "open" and "b" not in mode(call) and not only_closed:
        wanted = {"encoding"} if mode(call) == "r" else {"encoding", "newline"}
    elif name == "read_text" and isinstance(call.func, ast.Attribute):
        wanted = {"encoding"}
    elif name == "write_text":
        wanted = {"encoding", "newline"}
    elif name in ("run", "Popen", "check_output") and said & {"text", "universal_newlines"}:
        wanted = {"encoding"}
    return f"{name} without {', '.join(sorted(wanted - said))}" if wanted - said else None


def faults(text):
    """Lines that leave to the system what it does, each with what is wrong."""
    found = []
    nodes = list(ast.walk(ast.parse(text)))
    closed = {
        id(node.value) for node in nodes if isinstance(node, ast.Attribute) and node.attr == "close"
    }
    for node in nodes:
        wrong = None
        if isinstance(node, ast.Call):
            wrong = of_a_call(node, id(node) in closed)
        elif (
            isinstance(node, ast.Attribute)
            and node.attr in DIFFERS
            and getattr(node.value, "id", "") == "os"
        ):
            wrong = f"os.{node.attr} differs between systems"
        elif isinstance(node, ast.Constant) and str(node.value).startswith(
            ("/tmp/", "/dev/", "C:\\")
        ):
            wrong = f"{node.value} is a place of one system"
        if wrong:
            found.append((node.lineno, wrong))
    return sorted(found)


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("open(name)", "open without encoding"),
        ("open(name, 'w', encoding='utf-8')", "open without newline"),
        ("path.open('a').write('')", "open without encoding, newline"),
        ("path.read_text()", "read_text without encoding"),
        ("path.write_text(text, encoding='utf-8')", "write_text without newline"),
        ("subprocess.run(command, text=True)", "run without encoding"),
        ("time.strftime('%x')", "strftime follows the locale"),
        ("os.linesep", "os.linesep differs between systems"),
        ("'/tmp/page.html'", "/tmp/page.html is a place of one system"),
        ("open(name, 'rb')", None),
        ("path.open('a').close()", None),
        ("open(name, encoding='utf-8')", None),
        ("path.write_text(text, encoding='utf-8', newline='\\n')", None),
        ("read_text(data)", None),
    ],
)
def test_a_fault_is_seen(line, fault):
    """By the check below, which passes over what is the same on all systems."""
    assert [text for _, text in faults(line)] == ([] if fault is None else [fault])


@pytest.mark.slow
def test_no_module_leaves_encoding_or_line_ends_to_the_system():
    """Of all files that the package reads or writes as text."""
    modules = sorted(SOURCE.rglob("*.py"))
    assert len(modules) > 100
    found = [
        f"{path.relative_to(SOURCE)}:{line}: {text}"
        for path in modules
        for line, text in faults(path.read_text("utf-8"))
    ]
    assert found == []


def run(command, folder, settings):
    """What Python prints, in bytes, in the environment of a system."""
    library = os.pathsep.join([str(SOURCE.parent), os.environ.get("PYTHONPATH", "")])
    given = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("LC_", "LANG", "PYTHON"))
    }
    given |= {"PYTHONPATH": library, "MPLBACKEND": "agg", **settings}
    done = subprocess.run(
        [sys.executable, *command], cwd=folder, env=given, capture_output=True, timeout=1200
    )
    assert done.returncode == 0, done.stderr.decode(errors="replace")
    return done.stdout


def answered(folder, settings):
    """All that the command prints and writes for a case."""
    folder.mkdir()
    (folder / "case.toml").write_text(CASE, encoding="utf-8", newline="\n")
    printed = run(
        ["-m", "collisions", "case.toml", "--report", "report.html", "--what-if", "page.html"],
        folder,
        settings,
    )
    return {
        "printed": printed.replace(b"\r\n", b"\n"),
        **{name: (folder / name).read_bytes() for name in ("report.html", "page.html")},
    }


@pytest.mark.slow
def test_a_case_is_the_same_where_the_system_writes_ascii(tmp_path):
    """As does Windows, or a server whose encoding is not UTF-8: the same bytes on screen and in the
    pages, LF at line ends.
    """
    found = answered(tmp_path / "ascii", ASCII)
    assert found == answered(tmp_path / "utf8", {"PYTHONUTF8": "1"})
    for content in found.values():
        assert "Škoda Citroën 車".encode() in content
        assert b"\r" not in content


@pytest.mark.slow
def test_a_report_is_saved_and_replayed_where_the_system_writes_ascii(tmp_path):
    """With names outside ASCII; the file is the one that a system of UTF-8 writes."""
    pages = []
    for name, settings in (("ascii", ASCII), ("utf-8", {"PYTHONUTF8": "1"})):
        folder = tmp_path / name
        folder.mkdir()
        run(["-c", ROUND_TRIP, name], folder, settings)
        pages.append((folder / "saved.html").read_bytes())
    assert pages[0] == pages[1]
    assert "Škoda 車".encode() in pages[0]
