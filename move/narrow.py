"""Makes the lines of a checkout at most 100 wide: ``python narrow.py TREE``; nothing is committed.

Code is left to ruff format; docstrings, comments, long texts and tables without formatting are broken here. The code of every file
is compared before and after: syntax trees but for white space in docstrings. A file that differs is left as it was, and named ("!!").
"""

from __future__ import annotations

import ast
import bisect
import doctest
import io
import re
import subprocess
import sys
import textwrap
import tokenize
from pathlib import Path

TREE = Path(sys.argv[1]).resolve()
ONLY = {str(Path(one).resolve()) for one in sys.argv[2:]}
WIDTH = 100
RUFF = str(Path(sys.executable).parent / "ruff")
FOLDERS = ("src", "tests", "docs", "benchmarks", "examples", "validation", "design")
HEADED = {"Parameters", "Other Parameters", "Returns", "Yields", "Raises", "Warns", "Attributes", "See Also", "Methods", "Keys"}
ITEM = re.compile(r"^(\s*)([-*•]|\d+[.)]) +")
BULLET = re.compile(r"^(\s*)(?:[-*•]|\d+[.)]) ")


def ruff(*words: str) -> None:
    subprocess.run([RUFF, *words], cwd=TREE, check=False)


# --- the same code? ----------------------------------------------------------------------------------------------------------
def normal(text: str) -> str:
    """The syntax tree, with the white space of docstrings made one."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            node.value.value = doctested(node.value.value)
        if isinstance(node, ast.JoinedStr):
            parts: list[ast.expr] = []
            for part in node.values:
                if isinstance(part, ast.Constant) and parts and isinstance(parts[-1], ast.Constant):
                    parts[-1] = ast.Constant(parts[-1].value + part.value)
                else:
                    parts.append(part)
            node.values = parts
    return ast.dump(tree)


def doctested(text: str) -> str:
    """A docstring: white space made one, examples as their syntax trees."""
    parts = []
    for part in doctest.DocTestParser().parse(text):
        if isinstance(part, str):
            parts.append(" ".join(part.split()))
        else:
            try:
                parts.append(ast.dump(ast.parse(part.source)))
            except SyntaxError:
                parts.append(" ".join(part.source.split()))
            parts.append(" ".join(part.want.split()))
    return " ".join(parts)


# --- prose -------------------------------------------------------------------------------------------------------------------
def filled(words: str, first: str, rest: str, width: int) -> list[str]:
    return textwrap.wrap(
        words, width, initial_indent=first, subsequent_indent=rest, break_long_words=False, break_on_hyphens=False
    ) or [first.rstrip()]


def wrapped_lines(lines: list[str], lead: int, width: int, closing: int) -> list[str]:
    """Lines of a docstring, the first without its indentation and ``lead`` columns in; paragraphs that are too wide are filled.

    ``closing`` is what the last line must leave room for, 0 if the closing quotes have a line of their own.
    """
    out: list[str] = []
    section, literal, base = "", None, None
    at = 0
    margin = min((len(l) - len(l.lstrip()) for l in lines[1:] if l.strip()), default=0)
    while at < len(lines):
        line = lines[at]
        if not line.strip():
            out.append(line)
            at += 1
            continue
        indent = 0 if at == 0 else len(line) - len(line.lstrip())
        if literal is not None and at and indent > literal:
            out.append(line)
            at += 1
            continue
        literal = None
        if at + 1 < len(lines) and re.fullmatch(r"\s*-{3,}", lines[at + 1]):
            section = line.strip()
            out += lines[at : at + 2]
            at += 2
            continue
        stripped = line.strip()
        fixed = stripped.startswith((">>>", ".. ", "|", "==", "+-", "::"))
        if stripped.startswith(">>>") or fixed:
            while at < len(lines) and lines[at].strip():  # a doctest with its output
                out.append(lines[at])
                at += 1
            continue
        if at and section in HEADED and indent == margin:
            out.append(line)
            at += 1
            continue
        # A paragraph: this line, and those that follow at the indentation of its text.
        item = ITEM.match(line)
        hang = len(item[0]) if item else indent
        block = [line]
        nxt = at + 1
        while nxt < len(lines) and lines[nxt].strip():
            other = lines[nxt]
            depth = len(other) - len(other.lstrip())
            if ITEM.match(other) or other.lstrip().startswith((">>>", "..", "|")) or re.fullmatch(r"\s*[-=]{3,}.*", other):
                break
            if (margin if at == 0 else hang) != depth and not (item and depth == indent and False):
                break
            block.append(other)
            nxt += 1
        last = nxt == len(lines)
        wide = [len(one) + (lead if at == 0 and i == 0 else 0) + (closing if last and i == len(block) - 1 else 0) for i, one in enumerate(block)]
        if max(wide) > width:
            words = " ".join([block[0].strip() if not item else block[0][len(item[0]) :].strip(), *(one.strip() for one in block[1:])])
            first = item[0] if item else " " * indent
            rest = " " * (margin if at == 0 else hang)
            if at == 0:
                made = filled(words, " " * lead, rest, width)
                made[0] = made[0][lead:]
            else:
                made = filled(words, first, rest, width)
            block = made
        out += block
        if stripped and block[-1].rstrip().endswith("::"):
            literal = indent if at else margin
        at = nxt
    return out


def docstring(text: str, column: int) -> str:
    """A string token that is a docstring, ``column`` from the left."""
    found = re.match(r"(?i)([a-z]*)(\"\"\"|''')(.*)(\2)$", text, re.DOTALL)
    if not found:
        return text
    prefix, quotes, body, _ = found.groups()
    lines = body.split("\n")
    own = lines[-1].strip() == "" and len(lines) > 1
    content = lines[:-1] if own else lines
    lead = column + len(prefix) + 3
    if len(lines) == 1 and lead + len(body) + 3 <= WIDTH:
        return text
    if len(lines) == 1:
        made = filled(body.strip(), " " * lead, " " * column, WIDTH)
        if len(made) == 1:
            made = filled(body.strip(), " " * lead, " " * column, WIDTH - 12)
        made[0] = made[0][lead:]
        if len(made) == 1:
            return text
        return f"{prefix}{quotes}" + "\n".join(made) + f"\n{' ' * column}{quotes}"
    made = wrapped_lines(content, lead, WIDTH, 0 if own else 3)
    if made == content:
        return text
    tail = f"\n{' ' * column}" if own else ""
    return f"{prefix}{quotes}" + "\n".join(made) + tail + quotes


class Offsets:
    """Character offsets of rows and columns."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.starts = [0]
        for line in text.splitlines(keepends=True):
            self.starts.append(self.starts[-1] + len(line))

    def at(self, place: tuple[int, int]) -> int:
        return self.starts[place[0] - 1] + place[1]

    def row(self, offset: int) -> int:
        return bisect.bisect_right(self.starts, offset)


def tokens(text: str) -> list[tokenize.TokenInfo]:
    return list(tokenize.generate_tokens(io.StringIO(text).readline))


def docstrings(text: str) -> str:
    where = Offsets(text)
    places = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            line = text.splitlines()[node.lineno - 1]
            places.add((node.lineno, len(line.encode()[: node.col_offset].decode())))
    for token in reversed(tokens(text)):
        if token.type == tokenize.STRING and token.start in places:
            start, end = where.at(token.start), where.at(token.end)
            text = text[:start] + docstring(text[start:end], token.start[1]) + text[end:]
    return text


KEEP = re.compile(r"#\s*(fmt|noqa|type|ruff|pragma|mypy|pyright|isort)\b|#!|# -\*-")


def comments(text: str, notebook: bool) -> str:
    """Full-line comments filled; comments behind code put on a line before it. Of notebooks paragraphs only."""
    lines = text.splitlines()
    own: dict[int, int] = {}
    behind: dict[int, int] = {}
    for token in tokens(text):
        if token.type == tokenize.COMMENT:
            (own if not lines[token.start[0] - 1][: token.start[1]].strip() else behind)[token.start[0]] = token.start[1]
    inside_strings = set()
    for token in tokens(text):
        if token.type == tokenize.STRING and token.start[0] != token.end[0]:
            inside_strings |= set(range(token.start[0], token.end[0]))
    out: list[str] = []
    row = 1
    while row <= len(lines):
        line = lines[row - 1]
        if row in own and re.match(r"\s*# ?-{3}", line) and len(line) > WIDTH and line.endswith("---"):
            out.append(line[:WIDTH])  # a line that parts sections
            row += 1
            continue
        if row in own and not KEEP.match(line.strip()):
            column = own[row]
            block = [line]
            special = re.compile(r"#( *$| %%| ?#| \||  | \$\$| ---|:|\s*[-*] |\s*\d+\. )")
            # A paragraph: until a line that ends one, an empty or a special one.
            nxt = row + 1
            if not special.match(line.strip()) or re.match(r"#\s*[-*] ", line.strip()):
                while nxt in own and own[nxt] == column and not KEEP.match(lines[nxt - 1].strip()):
                    said = lines[nxt - 1].strip()
                    bullet = re.match(r"#\s*[-*] ", line.strip())
                    if special.match(said) and not (bullet and re.match(r"#   ?\S", said)):
                        break
                    before = block[-1].rstrip()
                    if not notebook and before.endswith((".", ":")) and len(before) < 88 and re.match(r"# [A-Z]", said):
                        break
                    block.append(lines[nxt - 1])
                    nxt += 1
            if max(map(len, block)) > WIDTH and not re.match(r"# ?(#|\||\$\$)", line.strip()):
                bullet = re.match(r"#\s*[-*] ", line.strip())
                first = " " * column + (bullet[0] if bullet else "# ")
                rest = " " * column + "# " + " " * (len(bullet[0]) - 2 if bullet else 0)
                words = " ".join([block[0].strip()[len(first) - column :].strip(), *(one.strip()[1:].strip() for one in block[1:])])
                block = filled(words, first, rest, WIDTH)
            out += block
            row = nxt
            continue
        if row in behind and len(line) > WIDTH and not KEEP.match(line[behind[row] :]) and row - 1 not in inside_strings and row not in inside_strings:
            code, said = line[: behind[row]].rstrip(), line[behind[row] :]
            column = len(line) - len(line.lstrip())
            out += filled(said[1:].strip(), " " * column + "# ", " " * column + "# ", WIDTH)
            out.append(code)
        else:
            out.append(line)
        row += 1
    return "\n".join(out) + "\n"


# --- texts -------------------------------------------------------------------------------------------------------------------
STRING = re.compile(r"(?is)^([a-z]*)('''|\"\"\"|'|\")(.*)\2$")


def pieces(body: str, formatted: bool, raw: bool = False) -> list[str]:
    """A text at its blanks, each blank with the word before it; what stands in braces of an f-string is not cut."""
    found, depth, word, at = [], 0, "", 0
    while at < len(body):
        char = body[at]
        if formatted and body[at : at + 2] in ("{{", "}}") and (depth == 0):
            word += body[at : at + 2]
            at += 2
            continue
        if formatted and char == "{":
            depth += 1
        elif formatted and char == "}":
            depth -= 1
        word += char
        at += 1
        if char == " " and depth == 0 and at < len(body) and body[at] != " ":
            found.append(word)
            word = ""
        elif raw and not formatted and char == "|" and body[at - 2 : at - 1] != "\\":
            found.append(word)
            word = ""
        elif body[at - 2 : at] == r"\n" and depth == 0 and not raw and body[at - 3 : at - 2] != "\\" and at < len(body):
            found.append(word)
            word = ""
    return [*found, word] if word else found


def split(prefix: str, quote: str, body: str, room: int) -> list[str]:
    """A text as texts of at most ``room`` columns each."""
    formatted = "f" in prefix.lower()
    made: list[str] = [] if body else [""]
    for piece in pieces(body, formatted, "r" in prefix.lower()):
        if made and len(made[-1]) + len(piece) + len(prefix) + 2 <= room:
            made[-1] += piece
        else:
            made.append(piece)
    plain = prefix.replace("f", "").replace("F", "")
    return [f"{prefix if '{' in one or '}' in one or not formatted else plain}{quote}{one}{quote}" for one in made]


def long_texts(text: str, width: int) -> str:
    """String literals that reach beyond the width, as several that stand one after another."""
    lines = text.splitlines()
    if max(map(len, lines), default=0) <= width:
        return text
    where = Offsets(text)
    unformatted = skipped(text)
    tree = ast.parse(text)
    parents = {child: node for node in ast.walk(tree) for child in ast.iter_child_nodes(node)}
    every = [t for t in tokens(text) if t.type not in (tokenize.NL, tokenize.COMMENT)]
    strings = [t for t in every if t.type == tokenize.STRING]
    depth_at: dict[tuple[int, int], int] = {}
    depth = 0
    for token in every:
        depth_at[token.start] = depth
        if token.type == tokenize.OP:
            depth += (token.string in "([{") - (token.string in ")]}")
    edits = []
    for node in ast.walk(tree):
        is_text = isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))
        if not is_text or isinstance(parents.get(node), (ast.Expr, ast.JoinedStr, ast.FormattedValue)):
            continue
        if any(isinstance(up, ast.JoinedStr) for up in above(node, parents)):
            continue

        def char(row: int, byte: int) -> tuple[int, int]:
            return row, len(lines[row - 1].encode()[:byte].decode())

        start, end = char(node.lineno, node.col_offset), char(node.end_lineno, node.end_col_offset)
        own = [t for t in strings if start <= t.start and t.end <= end]
        if not own or not any(len(lines[t.start[0] - 1]) > width for t in own):
            continue
        # What is not formatted is first broken at its commas.
        if own[0].start[0] in unformatted and len(own[0].string) < width - 24:
            continue
        if any(t.start[0] != t.end[0] for t in own):
            continue
        parts = [STRING.match(t.string).groups() for t in own]
        if any(quote in ("'''", '"""') or set(prefix.lower()) & set("bu") for prefix, quote, _ in parts):
            continue
        raw = {"r" in prefix.lower() for prefix, _, _ in parts}
        if len({quote for _, quote, _ in parts}) > 1 or len(raw) > 1:
            groups = [[p] for p in parts]
        else:
            groups = [parts]
        line = lines[start[0] - 1]
        indent = len(line) - len(line.lstrip())
        up = parents.get(node)
        free = depth_at.get(own[0].start, 0) == 0
        boxed = isinstance(up, (ast.List, ast.Tuple, ast.Set, ast.Dict)) or free or isinstance(up, ast.keyword) and False
        # Where it will stand: on lines of its own, a level in.
        alone = start[1] == indent
        room = width - (indent + (4 if boxed or not alone else 0)) - 2
        if not alone and not boxed:
            room = max(30, min(room, width - start[1] - 2))
        made: list[str] = []
        if len(own) == 1 and len(own[0].string) <= room:
            room = int(0.6 * len(own[0].string))  # it stands behind something
        for group in groups:
            formatted = any("f" in prefix.lower() for prefix, _, _ in group)
            joined = "".join(
                body if not formatted or "f" in prefix.lower() else body.replace("{", "{{").replace("}", "}}") for prefix, _, body in group
            )
            made += split(("r" if raw == {True} or (len(group) == 1 and "r" in group[0][0].lower()) else "") + ("f" if formatted else ""), group[0][1], joined, room)
        if len(made) == 1 and len(own) == 1:
            continue
        already = free is False and lines_before(text, where.at(own[0].start)) == "(" and boxed
        if boxed and not already:
            gap = "\n" + " " * min(start[1] + 1, indent + 8) if start[0] in unformatted else " "
            said = "(" + gap.join(made) + ")"
        else:
            said = ("\n" + " " * start[1]).join(made)
        edits.append((where.at(own[0].start), where.at(own[-1].end), said))
    for start, end, said in sorted(edits, reverse=True):
        text = text[:start] + said + text[end:]
    return text


def above(node: ast.AST, parents: dict) -> list:
    found = []
    while node in parents:
        node = parents[node]
        found.append(node)
    return found


def lines_before(text: str, at: int) -> str:
    return text[:at].rstrip()[-1:]


def pages(text: str) -> str:
    """Lines of texts in triple quotes that are no docstrings, broken by a backslash."""
    where = Offsets(text)
    inside = {(n.value.lineno, n.value.col_offset) for n in ast.walk(ast.parse(text)) if isinstance(n, ast.Expr) and isinstance(n.value, ast.Constant)}
    for token in reversed(tokens(text)):
        found = STRING.match(token.string) if token.type == tokenize.STRING else None
        if not found or len(found[2]) != 3 or "r" in found[1].lower() or token.start in inside:
            continue
        made, lead = [], token.start[1]
        for line in token.string.split("\n"):
            while lead + len(line) > WIDTH and (at := line.rfind(" ", 20, WIDTH - 2 - lead)) > 0 and not ("f" in found[1].lower() and line[:at].count("{") != line[:at].count("}")):
                made.append(line[: at + 1] + "\\")
                line = line[at + 1 :]
                lead = 0
                if line.startswith(" "):
                    made[-1] = made[-1][:-1] + line[: len(line) - len(line.lstrip())] + "\\"
                    line = line.lstrip()
            made.append(line)
            lead = 0
        start, end = where.at(token.start), where.at(token.end)
        text = text[:start] + "\n".join(made) + text[end:]
    return text


# --- tables that are not formatted ---------------------------------------------------------------------------------------------
def skipped(text: str) -> set[int]:
    """The rows of logical lines that are not formatted."""
    found, first = set(), None
    skip = {row for row, line in enumerate(text.splitlines(), 1) if re.search(r"# fmt: skip", line)}
    for token in tokens(text):
        if token.type in (tokenize.NL, tokenize.COMMENT, tokenize.INDENT, tokenize.DEDENT) and first is None:
            continue
        first = first or token.start[0]
        if token.type == tokenize.NEWLINE:
            if token.start[0] in skip:
                found |= set(range(first, token.start[0] + 1))
            first = None
    return found


def tables(text: str, only_skipped: bool = False) -> str:
    """Lines that stay too wide, as of tables without formatting, broken at a comma (or an operator) as far out as there is one."""
    for _ in range(12):
        lines = text.splitlines()
        wide = {row for row, line in enumerate(lines, 1) if len(line) > WIDTH}
        if only_skipped and wide:
            wide &= skipped(text)
        if not wide:
            break
        depth, found = 0, {}
        for token in tokens(text):
            if token.type == tokenize.OP:
                if token.string in ")]}":
                    depth -= 1
                if token.string in "([{":
                    depth += 1
                row, column = token.end
                if row in wide and depth and column < WIDTH - 1 and column < len(lines[row - 1].rstrip()):
                    rank = {",": 0, "(": 0.5, "[": 0.5, "{": 0.5}.get(token.string)
                    head = len(lines[row - 1]) - len(lines[row - 1].lstrip())
                    if rank is not None and column > head + 8 and lines[row - 1][column:].strip() and not lines[row - 1][column:].strip().startswith("#"):
                        found.setdefault(row, []).append((depth + rank, -column))
        if not found:
            break
        for row in sorted(found, reverse=True):
            line = lines[row - 1]
            _, column = min((depth, column) for depth, column in found[row] if -column > len(line) * 0.3) if any(-c > len(line) * 0.3 for _, c in found[row]) else min(found[row])
            outer = min(depth for depth, _ in found[row])
            head = len(line) - len(line.lstrip())
            deeper = 4 if line.lstrip()[0] in "([{" or re.match(r"\s*[\w.]+[(\[{]", line) else 0
            opening = line.rstrip().endswith(("fmt: skip",)) and line.count("(") + line.count("[") + line.count("{") == line.count(")") + line.count("]") + line.count("}")
            lines[row - 1] = line[:-column].rstrip() + "\n" + " " * (head + (deeper or (4 if opening else 0))) + line[-column:].strip()
        text = "\n".join(lines) + "\n"
    return text


# --- all of it -----------------------------------------------------------------------------------------------------------------
def settings() -> None:
    path = TREE / "pyproject.toml"
    text = path.read_text(encoding="utf-8")
    text = text.replace("line-length = 128", f"line-length = {WIDTH}")
    text = text.replace('"tests/*" = ["D", "E501"]  # tables of cases are read by their columns', '"tests/*" = ["D"]')
    path.write_text(text, encoding="utf-8")
    path = TREE / "examples/ruff.toml"
    if path.exists():
        text = path.read_text(encoding="utf-8")
        path.write_text(
            text.replace("max-line-length = 128", f"max-line-length = {WIDTH}"), encoding="utf-8"
        )
    # What a file says of itself may take two lines now.
    path = TREE / "docs/import_picture.py"
    text = path.read_text(encoding="utf-8")
    text = text.replace(
        '''    return (ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "").split("\\n")[0]''',
        '''    said = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return said.split("\\n\\n")[0].replace("\\n", " ")''',
    )
    path.write_text(text, encoding="utf-8")
    for path in (TREE / "benchmarks").glob("*.py"):
        text = path.read_text(encoding="utf-8")
        text = text.replace('description=str(__doc__).partition("\\n")[0]', 'description=str(__doc__).partition("\\n\\n")[0]')
        text = text.replace("description=__doc__.splitlines()[0]", 'description=str(__doc__).partition("\\n\\n")[0]')
        path.write_text(text, encoding="utf-8")


def by_hand() -> None:
    """Lines that no rule breaks, and a count of lines that were wider."""
    for path in (TREE / "tests").rglob("test_printers.py"):
        text = path.read_text(encoding="utf-8")
        now = text.replace(
            '''    """Under a hundred lines: what is common is on the tape."""
    assert sum(map(bool, (KERNELS / f"{name}.py").read_text(encoding="utf-8").splitlines())) < 100
''',
            '''    """Under a hundred lines of code: what is common is on the tape."""
    tree = ast.parse((KERNELS / f"{name}.py").read_text(encoding="utf-8"))
    said = [node for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)]
    words = {row for node in said for row in range(node.lineno, node.end_lineno + 1)}
    code = {row for node in ast.walk(tree) if hasattr(node, "lineno") for row in (node.lineno, node.end_lineno)}
    assert len(code - words) < 100
''',
        )
        if now == text:
            print("!! tests/engine/test_printers.py: its count of lines is not as expected")
        elif "import ast" not in now:
            now = now.replace("from pathlib import Path\n", "import ast\nfrom pathlib import Path\n", 1)
        path.write_text(now, encoding="utf-8")
    for path in (TREE / "src").rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        now = text.replace(
            """    >>> with col.options(require_units=True):
    ...     col.Vehicle(mass="1500 kg", vx=20)
    Traceback (most recent call last):
    ...
    collisions.UnitsError: vx = 20 has no unit, and options(require_units=True) asks for one; write for example '80 km/h'
""",
            """    >>> with col.options(require_units=True):  # doctest: +ELLIPSIS
    ...     col.Vehicle(mass="1500 kg", vx=20)
    Traceback (most recent call last):
    ...
    collisions.UnitsError: vx = 20 has no unit, and options(require_units=True) asks for one; ...
""",
        )
        if now != text:
            path.write_text(now, encoding="utf-8")


def main() -> None:
    settings()
    by_hand()
    tracked = subprocess.run(["git", "-C", str(TREE), "ls-files", "-co", "--exclude-standard", "*.py"], check=True, capture_output=True, text=True)
    files = [TREE / name for name in tracked.stdout.split() if name.startswith(FOLDERS) and (TREE / name).exists()]
    files = [file for file in files if not ONLY or str(file) in ONLY]
    before = {file: file.read_text(encoding="utf-8") for file in files}
    ruff("format", "-q", *map(str, files))
    bad = []
    for turn in range(3):
        for file in files:
            text = file.read_text(encoding="utf-8")
            notebook = file.is_relative_to(TREE / "examples")
            if max(map(len, text.splitlines()), default=0) <= WIDTH and not notebook:
                continue
            try:
                now = comments(docstrings(text), notebook)
                if not notebook:
                    now = tables(now, only_skipped=True)
                now = long_texts(now, 88 if notebook else WIDTH)
                now = pages(now)
                if turn == 2 and not notebook:
                    now = tables(now)
                ast.parse(now)
            except Exception as error:  # what cannot be broken stays as it is
                (Path("..") / f"narrow_{file.stem}.txt").write_text(now, encoding="utf-8")
                print("!!", file.relative_to(TREE), type(error).__name__, error)
                continue
            if now != text:
                file.write_text(now, encoding="utf-8")
        ruff("format", "-q", *map(str, files))
        if turn == 0:
            wide = [str(file) for file in files if re.search(r"^ *(>>>|\.\.\.) .{%d,}$" % (WIDTH - 8), file.read_text(encoding="utf-8"), re.MULTILINE)]
            for one in map(Path, wide):
                text = one.read_text(encoding="utf-8")
                one.write_text(text.replace("::\n", "\u2237\n"), encoding="utf-8")  # a formula is no code
                ruff("format", "-q", "--config", "format.docstring-code-format=true", str(one))
                one.write_text(one.read_text(encoding="utf-8").replace("\u2237\n", "::\n"), encoding="utf-8")
                if normal(one.read_text(encoding="utf-8")) != normal(text):  # a formula taken for code
                    one.write_text(text, encoding="utf-8")
    for file in files:
        # A checker names the line of the argument.
        text = file.read_text(encoding="utf-8")
        now = re.sub(r"^(    .*[^,\n]),?\n\)  # refused$", r"\1  # refused\n)", text, flags=re.MULTILINE)
        if file.name == "refused.py" and now != text:
            file.write_text(now, encoding="utf-8")
            ruff("format", "-q", str(file))
    for file in files:
        if normal(file.read_text(encoding="utf-8")) != normal(before[file]):
            bad.append(file)
            print("!! the code of", file.relative_to(TREE), "is another: left as it was")
            (Path("..") / f"differs_{file.name}").write_text(file.read_text()); file.write_text(before[file], encoding="utf-8")
    left = [(file, row, len(line)) for file in files for row, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1) if len(line) > WIDTH]
    for file, row, length in left:
        print(f"   {file.relative_to(TREE)}:{row}: {length}")
    print(f"{len(files)} files, {len(left)} lines still beyond {WIDTH}, {len(bad)} files left as they were")


main()
