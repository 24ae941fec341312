"""The blocks as Markdown."""

from __future__ import annotations

import re
from collections.abc import Sequence

from .blocks import Block, Heading, Items, Paragraph, Picture, Record, Table, Working

FENCE = "```json\n"
_MARKS = re.compile(r"([\\`*_{}\[\]<>$|#~&])")
# What would begin a list or underline a line at the start of one.
_START = re.compile(r"^(\d*)([-+=.)])")


def markdown(blocks: Sequence[Block]) -> str:
    """The whole page."""
    return "\n\n".join(_block(block) for block in blocks) + "\n"


def _block(block: Block) -> str:
    match block:
        case Heading(text, level):
            return f"{'#' * level} {_escaped(text)}"
        case Paragraph(text, stressed):
            return f"**{_escaped(text)}**" if stressed else _line(text)
        case Table(head, rows):
            lines = [head, *rows]
            shown = [f"| {' | '.join(map(_escaped, line))} |" for line in lines]
            return "\n".join([shown[0], "| --- | --- | --- |", *shown[1:]])
        case Items(lines):
            return "\n".join(
                f"- **{_escaped(strong)}** {_escaped(text)}" if strong else f"- {_line(text)}" for strong, text in lines
            )
        case Picture(caption, _):
            return _line(caption)
        case Working(text):
            return text.rstrip("\n")
        case Record(text):
            return f"{FENCE}{text}\n```"


def _escaped(text: str) -> str:
    return _MARKS.sub(r"\\\1", text)


def _line(text: str) -> str:
    return _START.sub(r"\1\\\2", _escaped(text))
