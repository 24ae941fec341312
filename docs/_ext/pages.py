"""What a page shows of another one: its code, so that a crash is written down once."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

PAGES = Path(__file__).resolve().parent.parent


def names_of(page: str, *, until: str) -> dict[str, Any]:
    """Everything that the code of a page defines, run up to the heading with this text."""
    text = (PAGES / f"{page}.md").read_text(encoding="utf-8")
    text = text[: text.index(f"\n## {until}\n")]
    names: dict[str, Any] = {}
    for code in re.findall(r"^```\{code-cell\}[^\n]*\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        if not code.startswith(":tags: [remove-"):
            exec(compile(code, f"{page}.md", "exec"), names)
    return names
