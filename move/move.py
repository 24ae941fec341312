"""Moves a checkout of the old, flat layout into rooms: ``python move.py TREE``; nothing is committed.

Run it on a clean checkout. What it cannot place, or does not find where it expects it, it says on a line that begins with "!!".
"""

from __future__ import annotations

import ast
import io
import re
import subprocess
import sys
import textwrap
import tokenize
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from rooms import DOCSTRINGS, FILES, MERGES, NEW_TESTS, SPLITS, TESTS  # noqa: E402

TREE = Path(sys.argv[1]).resolve()
SRC, TEST = TREE / "src/collisions", TREE / "tests"
RUFF = [str(Path(sys.executable).parent / "ruff")]
STAY = {"__init__.py", "__main__.py", "py.typed"}
problems: list[str] = []


def problem(text: str) -> None:
    problems.append(text)
    print("!!", text)


def git(*words: str) -> str:
    return subprocess.run(["git", "-C", str(TREE), *words], check=True, capture_output=True, text=True).stdout


def module_of(rel: str) -> str:
    parts = rel.removesuffix(".py").split("/")
    return ".".join(["collisions", *(parts[:-1] if parts[-1] == "__init__" else parts)])


# --- what there is, and where it goes ----------------------------------------------------------------------------------------
if (SRC / "engine").exists():
    sys.exit("this tree has rooms already")
if git("status", "--porcelain").strip():
    problem("the checkout is not clean")
tracked = git("ls-files").splitlines()
old_src = [f.removeprefix("src/collisions/") for f in tracked if f.startswith("src/collisions/")]
final = {rel: FILES.get(rel, rel) for rel in old_src}
for rel in FILES:
    if rel not in final:
        print("   not in this tree:", rel)
for rel in old_src:
    if "/" not in rel and rel not in STAY and rel not in FILES:
        problem(f"{rel} is new and stays at the root: give it a room in rooms.py")
for one, other in MERGES.items():
    if one in final:
        final[one] = final[other]

MODULES = {module_of(rel): module_of(new) for rel, new in final.items() if rel.endswith(".py")}
PACKAGES = {name for rel, name in ((rel, module_of(rel)) for rel in old_src) if rel.endswith("__init__.py")}
NAMES: dict[tuple[str, str], str] = {}  # (old module, name) -> new module, where a name leaves its file
for rel, parts in SPLITS.items():
    for new, (_, names) in parts.items():
        NAMES |= {(module_of(rel), name): module_of(new) for name in names}


def bound(rel: str) -> set[str]:
    """The names that a file binds at its top."""
    found: set[str] = set()
    for node in ast.parse((SRC / rel).read_text()).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            found.add(node.name)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            found |= {(a.asname or a.name).split(".")[0] for a in node.names}
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                found |= {n.id for n in ast.walk(target) if isinstance(n, ast.Name)}
    return found


IN_PACKAGE = {module_of(rel): bound(rel) for rel in old_src if rel.endswith("__init__.py")}
# "from . import contact" of a package is the module itself.
for package, names in IN_PACKAGE.items():
    rel = "/".join(package.split(".")[1:] + ["__init__.py"])
    for node in ast.parse((SRC / rel).read_text()).body:
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module is None:
            names -= {a.name for a in node.names}


def target(module: str, name: str) -> tuple[str, str]:
    """New module and name of ``from module import name``; a submodule becomes (its package, its stem)."""
    whole = f"{module}.{name}"
    if whole in MODULES and name not in IN_PACKAGE.get(module, ()):
        new = MODULES[whole]
        return (new.rpartition(".")[0], new.rpartition(".")[2])
    return NAMES.get((module, name)) or MODULES[module], name


def dotted(text: str) -> str:
    """A dotted name that begins with collisions, as it is now called."""
    parts = text.split(".")
    if len(parts) > 2 and parts[1] == "errors" and parts[2] in IN_PACKAGE["collisions"]:
        return ".".join(["collisions", *parts[2:]])  # as a traceback shows them
    at = "collisions"
    for count in range(2, len(parts) + 1):
        here = ".".join(parts[:count])
        if here not in MODULES or parts[count - 1] in IN_PACKAGE.get(at, ()):
            rest = parts[count - 1 :]
            return ".".join([NAMES.get((at, rest[0])) or MODULES[at], *rest])
        at = here
    return MODULES[at]


def relative(module: str, owner: str, is_package: bool) -> str:
    """A module as an import of ``owner`` (a new module of the package) names it."""
    base, to = owner.split("."), module.split(".")
    base = base if is_package else base[:-1]
    same = 0
    while same < min(len(base), len(to)) and base[same] == to[same]:
        same += 1
    return "." * (len(base) - same + 1) + ".".join(to[same:])


def rewritten(text: str, old: str | None, new: str | None, package: bool, label: str) -> str:
    """Python code with its imports of the package as they are now; relative where ``old`` is a module of the package."""
    tree = ast.parse(text)
    lines = text.splitlines(keepends=True)
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line.encode()))
    data = text.encode()
    edits: list[tuple[int, int, str]] = []
    names_now = {n.id for n in ast.walk(tree) if isinstance(n, ast.Name)} | {
        a.asname or a.name for n in ast.walk(tree) if isinstance(n, (ast.Import, ast.ImportFrom)) for a in n.names
    } | {n.arg for n in ast.walk(tree) if isinstance(n, ast.arg)} | {
        n.name for n in ast.walk(tree) if isinstance(n, (ast.FunctionDef, ast.ClassDef))}
    renamed: dict[str, str] = {}
    for node in ast.walk(tree):
        start = end = 0
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            start, end = starts[node.lineno - 1] + node.col_offset, starts[node.end_lineno - 1] + node.end_col_offset
        if isinstance(node, ast.ImportFrom):
            if node.level:
                if old is None:
                    continue
                base = old.split(".") if package else old.split(".")[:-1]
                base = base[: len(base) - node.level + 1]
                module = ".".join(base + (node.module.split(".") if node.module else []))
            else:
                module = node.module or ""
            if module.split(".")[0] != "collisions":
                continue
            if module not in MODULES:
                problem(f"{label}: unknown module {module}")
                continue
            groups: dict[str, list[str]] = {}
            for alias in node.names:
                home, name = target(module, alias.name)
                if home == new and not package:
                    continue  # merged into this file
                kept = alias.asname or alias.name
                if name != alias.name and alias.asname is None:
                    if name in names_now or name in renamed.values():
                        written = f"{name} as {kept}"
                    else:
                        renamed[kept] = name
                        written = name
                else:
                    written = name if alias.asname is None else f"{name} as {kept}"
                groups.setdefault(home, []).append(written)
            indent = re.match(r"\s*", lines[node.lineno - 1])[0]
            found = []
            for home, words in groups.items():
                said = relative(home, new, package) if new is not None else home
                one = f"from {said} import {', '.join(words)}"
                found.append(one)
            edits.append((start, end, f"\n{indent}".join(found)))
        elif isinstance(node, ast.Import):
            if any(a.name.split(".")[0] == "collisions" for a in node.names):
                words = [
                    (dotted(a.name) if a.name.split(".")[0] == "collisions" else a.name) + (f" as {a.asname}" if a.asname else "")
                    for a in node.names
                ]
                edits.append((start, end, f"import {', '.join(words)}"))
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in ("col", "collisions"):
            whole = f"collisions.{node.attr}"
            if whole in MODULES and MODULES[whole] != whole and node.attr not in IN_PACKAGE["collisions"]:
                at = starts[node.lineno - 1] + node.col_offset
                to = starts[node.end_lineno - 1] + node.end_col_offset
                edits.append((at, to, node.value.id + MODULES[whole].removeprefix("collisions")))
    if renamed:
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and node.id in renamed:
                at = starts[node.lineno - 1] + node.col_offset
                edits.append((at, at + len(node.id.encode()), renamed[node.id]))
    for start, end, said in sorted(edits, reverse=True):
        data = data[:start] + said.encode() + data[end:]
    return data.decode()


DOTTED = re.compile(r"(?<![\w./-])collisions(?:\.[A-Za-z_]\w*)+")
FROM = re.compile(r"^(\s*(?:>>> |\.\.\. )?)from (collisions(?:\.\w+)*) import ([\w, ]+)$", re.MULTILINE)
RUN = re.compile(r"(?<=; )from (collisions(?:\.\w+)*) import (\w+)")


def texts(text: str) -> str:
    """Imports in doctests, pages and texts, and dotted names of modules anywhere, as they are now."""

    def statement(found: re.Match[str]) -> str:
        lead, module, names = found.groups()
        if module not in MODULES:
            return found[0]
        groups: dict[str, list[str]] = {}
        for word in names.split(","):
            name, _, alias = word.strip().partition(" as ")
            if not re.fullmatch(r"\w+", name):
                return found[0]
            home, now = target(module, name)
            kept = alias or name
            groups.setdefault(home, []).append(now if now == kept else f"{now} as {kept}")
        return "\n".join(f"{lead}from {home} import {', '.join(words)}" for home, words in groups.items())

    def name(found: re.Match[str]) -> str:
        before = found.string[: found.start()]
        if re.search(r"(?:^|\n)\s*(?:>>> |\.\.\. )?(?:from|import) $", before[-60:]):
            return found[0]
        return dotted(found[0])

    return DOTTED.sub(name, FROM.sub(statement, text))


def in_strings(text: str) -> str:
    """``texts`` of the strings and comments of Python code; its statements are for ``rewritten``."""
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    kinds = {tokenize.STRING, tokenize.COMMENT, getattr(tokenize, "FSTRING_MIDDLE", -1)}
    for token in reversed(list(tokenize.generate_tokens(io.StringIO(text).readline))):
        if token.type in kinds:
            start, end = starts[token.start[0] - 1] + token.start[1], starts[token.end[0] - 1] + token.end[1]
            said = texts(text[start:end])
            if said != text[start:end]:
                text = text[:start] + said + text[end:]
    return text


# --- where tests go ----------------------------------------------------------------------------------------------------------
test_files = [f.removeprefix("tests/") for f in tracked if re.fullmatch(r"tests/test_\w+\.py", f)]
test_new: dict[str, str] = {}
for room, listed in TESTS.items():
    for word in listed.split():
        one, _, other = word.partition(">")
        test_new[f"test_{one}.py"] = f"{room}/test_{other or one}.py"
for rel in test_files:
    if rel not in test_new:
        stem = rel.removeprefix("test_").removesuffix(".py")
        room = next((room for pattern, room in NEW_TESTS if re.search(pattern, stem)), None)
        if room is None:
            problem(f"tests/{rel} is new: put in tests/project")
        prefix = f"test_{room}_" if room in ("uncertainty", "reconstruct") else "test_"
        test_new[rel] = f"{room or 'project'}/test_{rel.removeprefix(prefix).removeprefix('test_')}"
        print("   new test:", rel, "->", test_new[rel])
test_new = {rel: new for rel, new in test_new.items() if rel in test_files}
TEST_MODULES = {rel.removesuffix(".py"): new.removesuffix(".py").replace("/", ".") for rel, new in test_new.items()}


def deeper(text: str) -> str:
    """Paths that a test finds from its own place, one folder further down."""
    text = re.sub(r"Path\(__file__\)((?:\.resolve\(\))?)\.parents\[(\d+)\]", lambda m: f"Path(__file__){m[1]}.parents[{int(m[2]) + 1}]", text)
    return re.sub(r"Path\(__file__\)((?:\.resolve\(\))?)\.parent\b(?!s)", r"Path(__file__)\1.parent.parent", text)


def test_imports(text: str) -> str:
    """``from test_x import y`` where the other test has a room."""
    names = "|".join(sorted(TEST_MODULES, key=len, reverse=True))
    text = re.sub(rf"^(\s*)from ({names}) import", lambda m: f"{m[1]}from {TEST_MODULES[m[2]]} import", text, flags=re.MULTILINE)
    return re.sub(
        rf"^(\s*)import ({names})( as \w+)?$",
        lambda m: f"{m[1]}from {TEST_MODULES[m[2]].rpartition('.')[0]} import {TEST_MODULES[m[2]].rpartition('.')[2]}{m[3] or ''}",
        text, flags=re.MULTILINE,
    )


# Paths of files, wherever they are named.
paths = {f"tests/{rel}": f"tests/{new}" for rel, new in test_new.items()}
source_paths = {rel: new for rel, new in final.items() if rel != new}
SOURCE_PATH = re.compile(
    r"(?:(src/collisions/)|(?<![\w/.]))(" + "|".join(re.escape(rel) for rel in sorted(source_paths, key=len, reverse=True)) + r")(?![\w/])"
)
TEST_PATH = re.compile(r"\btests/(test_\w+\.py)\b")
BARE_TEST = re.compile(r"(?<![\w/])(test_\w+)\.py\b")
# Names of scripts elsewhere that are also names of moved files.
OTHERS = {Path(f).name for f in tracked if f.startswith(("benchmarks/", "validation/", "docs/", "design/", "examples/"))}


def file_names(text: str, everywhere: bool) -> str:
    """Names of moved files; of those without a folder only on pages about the package (``everywhere``)."""
    text = TEST_PATH.sub(lambda m: "tests/" + test_new.get(m[1], m[1]), text)

    def one(found: re.Match[str]) -> str:
        lead, rel = found[1] or "", found[2]
        if not lead and "/" not in rel and (not everywhere or rel in OTHERS):
            return found[0]
        return lead + source_paths[rel]

    return SOURCE_PATH.sub(one, text)


# --- new contents, by the new path -------------------------------------------------------------------------------------------
contents: dict[str, str] = {}
PAGES = ("docs/architecture.md", "docs/extending.md", "docs/design_notes.md", "CONTRIBUTING.md")
TEXT = (".py", ".md", ".toml", ".html", ".css", ".json", ".csv", ".c", "")
moved: list[tuple[str, str]] = []
for path in tracked:
    now = path
    if path.startswith("src/collisions/"):
        rel = path.removeprefix("src/collisions/")
        now = f"src/collisions/{final[rel]}"
    elif path.startswith("tests/") and path.removeprefix("tests/") in test_new:
        now = "tests/" + test_new[path.removeprefix("tests/")]
    if now != path:
        moved.append((path, now))
    file = TREE / path
    if file.suffix not in (".py", ".md", ".toml") and path not in (".ci/run", "docs/_generated/speed.json"):
        continue
    text = file.read_text(encoding="utf-8")
    if path == "CHANGELOG.md":
        continue
    if path.endswith(".py"):
        text = in_strings(text)
        if path.startswith("src/"):
            old = module_of(rel)
            try:
                text = rewritten(text, old, MODULES[old], rel.endswith("__init__.py"), path)
            except SyntaxError as error:
                problem(f"{path}: {error}")
        else:
            text = test_imports(rewritten(text, None, None, False, path))
            if path.startswith("tests/") and now != path:
                text = deeper(text)
    text = file_names(text if path.endswith(".py") else texts(text), path in PAGES)
    contents[path] = text

# --- splits and merges, on the rewritten texts -------------------------------------------------------------------------------


def spans(text: str) -> list[tuple[ast.stmt, int, int]]:
    """The statements of a module with their first and last line, comments before and docstrings behind them included."""
    tree, lines = ast.parse(text), text.splitlines()
    found, last = [], 0
    for node in tree.body:
        first = min([node.lineno, *(d.lineno for d in getattr(node, "decorator_list", ()))])
        while first - 1 > last and lines[first - 2].startswith("#"):
            first -= 1
        is_doc = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and found and isinstance(found[-1][0], (ast.Assign, ast.AnnAssign))
        if is_doc:
            found[-1] = (found[-1][0], found[-1][1], node.end_lineno)
        else:
            found.append((node, first, node.end_lineno))
        last = node.end_lineno
    return found


def defines(node: ast.stmt) -> set[str]:
    if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
        return {node.name}
    if isinstance(node, (ast.Assign, ast.AnnAssign)):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        return {n.id for t in targets for n in ast.walk(t) if isinstance(n, ast.Name)}
    return set()


def is_import(node: ast.stmt) -> bool:
    return isinstance(node, (ast.Import, ast.ImportFrom)) or (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING")


def after_imports(text: str, said: str) -> str:
    """The text with lines put behind its docstring and ``from __future__``, before its first import."""
    lines = text.splitlines()
    at = 0
    for node, first, last in spans(text):
        if isinstance(node, ast.Expr) or (isinstance(node, ast.ImportFrom) and node.module == "__future__"):
            at = last
    return "\n".join([*lines[:at], "", said, "", *lines[at:]]) + "\n"


added: dict[str, str] = {}
# --- what is changed by hand -------------------------------------------------------------------------------------------------
exec((HERE / "byhand.py").read_text(), {**globals()})

# --- lines of pages that have grown ---------------------------------------------------------------------------------------------
PAGE_WIDTH = 140
for path in contents:
    if not path.endswith(".md"):
        continue
    was = set((TREE / path).read_text(encoding="utf-8").splitlines())
    lines, done, at = contents[path].splitlines(), [], 0
    plain = re.compile(r"^(?![|#`:.$<]|\.\.|---|\s*\{)\s*\S")
    item = re.compile(r"^(\s*)([-*]|\d+\.) ")
    fenced = False
    blocks: list[tuple[bool, list[str]]] = []
    for line in lines:
        if line.lstrip().startswith("```"):
            fenced = not fenced
            blocks.append((False, [line]))
        elif fenced or not plain.match(line):
            blocks.append((False, [line]))
        elif blocks and blocks[-1][0] and not item.match(line):
            blocks[-1][1].append(line)
        else:
            blocks.append((True, [line]))
    for prose, block in blocks:
        if prose and any(len(line) > PAGE_WIDTH and line not in was for line in block):
            head = item.match(block[0])
            lead = head[0] if head else re.match(r"\s*", block[0])[0]
            words = " ".join([block[0][len(lead):], *(line.strip() for line in block[1:])])
            block = textwrap.wrap(
                words, PAGE_WIDTH, initial_indent=lead, subsequent_indent=" " * len(lead), break_long_words=False, break_on_hyphens=False
            )
        done += block
    contents[path] = "\n".join(done) + "\n"

for rel, parts in SPLITS.items():
    path = f"src/collisions/{rel}"
    if path not in contents:
        problem(f"nothing to split: {rel}")
        continue
    owner = MODULES[module_of(rel)]
    for new, (docstring, names) in parts.items():
        text = contents[path]
        lines = text.splitlines()
        chosen = [(node, a, b) for node, a, b in spans(text) if defines(node) and defines(node) <= set(names)]
        missing = set(names) - {n for node, *_ in chosen for n in defines(node)}
        if missing:
            problem(f"{rel}: not found for {new}: {sorted(missing)}")
        imports = []
        for node, a, b in spans(text):
            if isinstance(node, ast.ImportFrom) and node.level:
                base = owner.split(".")[:-1]
                base = base[: len(base) - node.level + 1]
                whole = ".".join(base + (node.module.split(".") if node.module else []))
                words = ", ".join(x.name + (f" as {x.asname}" if x.asname else "") for x in node.names)
                if whole != module_of(new):
                    imports.append(f"from {relative(whole, module_of(new), False)} import {words}")
            elif isinstance(node, (ast.Import, ast.ImportFrom)):
                imports.append("\n".join(lines[a - 1 : b]))
        blocks = ["\n".join(lines[a - 1 : b]) + ("" if isinstance(node, (ast.Assign, ast.AnnAssign)) else "\n\n") for node, a, b in chosen]
        added[f"src/collisions/{new}"] = f'"""{docstring}"""\n\n' + "\n".join(imports) + "\n\n" + "\n".join(blocks).rstrip() + "\n"
        gone = {n for _, a, b in chosen for n in range(a, b + 1)}
        left = "\n".join(line for at, line in enumerate(lines, 1) if at not in gone) + "\n"
        used = {n.id for n in ast.walk(ast.parse(left)) if isinstance(n, ast.Name)} & set(names)
        if used:
            left = after_imports(left, f"from {relative(module_of(new), owner, False)} import {', '.join(sorted(used))}")
        contents[path] = left

for rel, into in MERGES.items():
    path, other = f"src/collisions/{rel}", f"src/collisions/{into}"
    if path not in contents:
        continue
    text, whole = contents[path], contents[other]
    lines = text.splitlines()
    body, imports = [], []
    for node, a, b in spans(text):
        if isinstance(node, ast.Expr) and not body and not imports:
            continue
        if isinstance(node, ast.ImportFrom) and node.module == "__future__":
            continue
        (imports if is_import(node) else body).append("\n".join(lines[a - 1 : b]))
    clash = {n for node, *_ in spans(text) for n in defines(node)} & {n for node, *_ in spans(whole) for n in defines(node)}
    if clash:
        problem(f"{rel} and {into} both define {sorted(clash)}")
    whole = after_imports(whole, "\n".join(imports))
    last = max(b for node, a, b in spans(whole) if is_import(node))
    both = whole.splitlines()
    contents[other] = "\n".join([*both[:last], "", "", "\n\n\n".join(body), "", "", *both[last:]]) + "\n"
    del contents[path]

# --- write -------------------------------------------------------------------------------------------------------------------
for path, now in moved:
    (TREE / now).parent.mkdir(parents=True, exist_ok=True)
    if path.startswith("src/") and path.removeprefix("src/collisions/") in MERGES:
        git("rm", "-q", "-f", path)
    else:
        git("mv", path, now)
where = dict(moved)
for path, text in contents.items():
    target_file = TREE / where.get(path, path)
    if target_file.read_text(encoding="utf-8") != text:
        target_file.write_text(text, encoding="utf-8")
for path, text in added.items():
    (TREE / path).parent.mkdir(parents=True, exist_ok=True)
    (TREE / path).write_text(text, encoding="utf-8")
for room, docstring in DOCSTRINGS.items():
    (SRC / room).mkdir(exist_ok=True)
    (SRC / room / "__init__.py").write_text(f'"""{docstring}"""\n', encoding="utf-8")

touched = [str(TREE / where.get(path, path)) for path in contents if path.endswith(".py")] + [str(TREE / path) for path in added]
subprocess.run([*RUFF, "check", "-q", "--fix", "--select", "F401,F811,I001", *touched], cwd=TREE, check=False)
subprocess.run([*RUFF, "format", "-q", *touched], cwd=TREE, check=False)
git("add", "-A")
print(f"{len(moved)} files moved, {len(added)} made; {len(problems)} problems")
