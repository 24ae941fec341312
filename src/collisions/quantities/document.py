"""``Document``: a page that is a ``str``, shows itself in a notebook, and can be saved."""

from __future__ import annotations

from html import escape
from os import PathLike
from pathlib import Path
from typing import Any

from ..messages.errors import InputError


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
            An existing file is replaced. Only a page of HTML may have a name that ends in .html or
            .htm.

        Returns
        -------
        pathlib.Path

        Raises
        ------
        InputError
            The name is that of a page of HTML, and this page is not one.
        OSError
            The file cannot be written.
        """
        target = Path(path)
        kind, suffix = {"html": ("HTML", ".html"), "markdown": ("Markdown", ".md")}.get(
            self.form, ("plain text", ".txt")
        )
        if self.form != "html" and target.suffix.lower() in (".html", ".htm"):
            instead = str(target.with_suffix(suffix))
            raise InputError(
                f"path ends in {target.suffix}, but this page is {kind}, not HTML; write "
                f"save({instead!r})",
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
