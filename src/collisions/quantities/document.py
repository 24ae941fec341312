"""``Document``: a page that is a ``str``, shows itself in a notebook, and can be saved."""

from __future__ import annotations

import re
from html import escape
from os import PathLike
from pathlib import Path
from typing import Any

from ..messages.errors import InputError

# Each form with what it is called, and the endings of its files, of which the first is usual.
_FORMS = {
    "html": ("HTML", (".html", ".htm")),
    "markdown": ("Markdown", (".md", ".markdown", ".txt")),
    "text": ("plain text", (".txt", ".text")),
}
# What follows the last point of a name, if it is an ending: not in "case 1.2" or "Golf vs. Polo".
_ENDING = re.compile(r"\.[A-Za-z][A-Za-z0-9]{0,7}")


class Document(str):
    """The text of a page: a ``str`` that a notebook shows as a page, and that ``save`` writes to a
    file.

    Attributes
    ----------
    form : str
        "html", "markdown" or "text".
    """

    form: str

    def __new__(cls, text: str, form: str = "text") -> Document:
        made = super().__new__(cls, text)
        made.form = form
        return made

    def save(self, path: str | PathLike[str]) -> Path:
        """Write the page to a file, in UTF-8, and return the path of the file.

        Parameters
        ----------
        path : str or path
            An existing file is replaced. The ending of its name has to be one of the form of the
            page: .html or .htm of HTML, .md, .markdown or .txt of Markdown, .txt or .text of
            plain text; or there is none. For a PDF save HTML, open it in a browser and print it.

        Returns
        -------
        pathlib.Path

        Raises
        ------
        InputError
            The name ends as that of another form does.
        OSError
            The file cannot be written.
        """
        target = Path(path)
        kind, endings = _FORMS[self.form]
        suffix = endings[0]
        ending = target.suffix.lower()
        if ending not in endings and _ENDING.fullmatch(ending):
            raise InputError(
                f"path ends in {target.suffix}, but this page is {kind}{_not_as(ending)}; "
                + self._instead(target),
                code="bad_option",
                argument="path",
            )
        try:
            target.write_text(self, encoding="utf-8", newline="\n")
        except FileNotFoundError as error:
            folder = str(target.parent)
            text = (
                f"there is no folder {folder!r}; make it first, by "
                f"pathlib.Path({folder!r}).mkdir(parents=True), to save"
            )
            raise FileNotFoundError(error.errno, text, str(target)) from None
        except IsADirectoryError as error:
            text = (
                "this is a folder; name a file in it, such as "
                f"{str(target / f'report{suffix}')!r}, in place of"
            )
            raise IsADirectoryError(error.errno, text, str(target)) from None
        return target

    def _instead(self, target: Path) -> str:
        """What to write in place of a path whose ending is that of another form."""
        own = f"write save({str(target.with_suffix(_FORMS[self.form][1][0]))!r})"
        if target.suffix.lower() != ".pdf":
            return own
        how = "open that in a browser and print it to a PDF"
        if self.form != "html":
            page = str(target.with_suffix(".html"))
            own += f"; to print, write collisions.report(...).save({page!r})"
        return f"{own}, {how}"

    def _repr_html_(self) -> str | None:
        # In a frame: the page has a style of its own, which is not that of the notebook.
        if self.form != "html":
            return None
        return (
            f'<iframe srcdoc="{escape(self)}" '
            'style="width:100%;height:64em;max-height:95vh;border:1px solid #ccc"></iframe>'
        )

    def _repr_markdown_(self) -> str | None:
        return str(self) if self.form == "markdown" else None

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        printer.text(str(self))


def _not_as(ending: str) -> str:
    """What a page with this ending would be; "" for an ending that is not known."""
    kinds = {".pdf": "PDF"} | {one: kind for kind, endings in _FORMS.values() for one in endings}
    return f", not {kinds[ending]}" if ending in kinds else ""
