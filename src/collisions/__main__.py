"""The command: ``python -m collisions case.toml`` answers a case file; ``new`` prints one to start
from.
"""

from __future__ import annotations

import argparse
import errno
import os
import sys
from collections.abc import Sequence
from os.path import realpath
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from . import __version__
from .quantities.formatting import SYSTEMS

if TYPE_CHECKING:
    from .cases.answers import Answers
    from .cases.read import CaseError

# What answers cases is imported where it is used: ``new`` prints a text and needs none of it.

_CASES = Path(__file__).with_name("cases")
_OF_UNITS = {"us": "_us"}  # of templates, in their names
_HTML, _MARKDOWN = (".html", ".htm"), (".md", ".markdown")
_ENDS = """\
exit codes: 0 answered; 1 the case was read, but has no answer, or more than one where one is \
needed; 2 the file or the command
cannot be used; 130 stopped by Ctrl-C; 141 nobody reads the output. What is wrong is one line \
each: the file, the key in it, and
what to write."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command with these arguments, by default those of the command line; gives the exit
    code.
    """
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    try:
        code = _run(_parser().parse_args(arguments))
        sys.stdout.flush()
        return code
    except OSError as error:
        if error.errno not in (errno.EPIPE, errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO):
            raise
        # Python would flush what is left again at the end.
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), sys.stdout.fileno())
        # Whoever reads the output has enough, as head has.
        if isinstance(error, BrokenPipeError):
            return 141  # as shells have it
        print(f"cannot write the output ({error.strerror or error})", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("stopped; nothing more was written", file=sys.stderr)
        return 130  # as shells have it


def _run(options: Any) -> int:
    """Do what the command line asks for; gives the exit code."""
    if options.case in ("new", "schema"):
        return _printed(options)
    from .cases.answers import answers
    from .cases.read import CaseError, read

    try:
        _check_names(options)
        if options.scene:
            raise CaseError(("", "--scene goes with 'new'; leave it out, as the file says itself"))
        found = answers(read(options.case))
        whole = found.to_dict() if options.json else found.text(options.units)
    except CaseError as error:
        _warned(options, error.warnings)
        return _refused(options, error, {"warnings": error.warnings} if error.warnings else {})
    code = 0
    try:
        _write(_pages(options, found))
    except CaseError as error:
        code = _refused(options, error, whole)
    _warned(options, found.warnings)
    if isinstance(whole, str):
        print(whole, end="")
    elif not code:
        print(_as_json(whole))
    return code


def _printed(options: Any) -> int:
    """Print a case to start from, in the units that were asked for, or the schema; gives the exit
    code.
    """
    others = {
        "--report": options.report,
        "--what-if": options.what_if,
        "--play": options.play,
        "--json": options.json or None,
    }
    if options.case == "schema":
        others |= {"--units": options.units, "--scene": options.scene or None}
    given = [name for name, value in others.items() if value is not None]
    if given:
        takes = "takes --units and --scene" if options.case == "new" else "takes no options"
        print(f"{options.case}: {takes}; leave out {' and '.join(given)}", file=sys.stderr)
        return 2
    if options.case == "schema":
        from .cases.schema import case_schema

        print(_as_json(case_schema()))
        return 0
    of = "crash" if options.scene else "case"
    name = f"{of}_template{_OF_UNITS.get(options.units, '')}.toml"
    text = (_CASES / name).read_text(encoding="utf-8")
    if options.units == "si":
        text = text.replace(
            '"metric"               # or "si"', '"si"                   # or "metric"'
        )
    print(text, end="")
    return 0


def _pages(options: Any, found: Answers) -> dict[Path, str]:
    """The pages that were asked for, by the file that they go into."""
    pages = {}
    if options.report is not None:
        pages[Path(options.report)] = found.report(
            "html" if options.report.lower().endswith(_HTML) else "markdown", options.units
        )
    if options.what_if is not None:
        pages[Path(options.what_if)] = found.what_if(options.units)
    if options.play is not None:
        pages[Path(options.play)] = found.play(options.units)
    return pages


def _write(pages: dict[Path, str]) -> None:
    """Write all of these files, or none: first under names beside their own."""
    from .cases.read import CaseError

    parts: dict[Path, Path] = {}
    try:
        for path, text in pages.items():
            target = Path(realpath(path))
            if target.is_dir():
                raise IsADirectoryError(0, "Is a directory")
            if target.exists():
                target.open("ab").close()  # whether it may be written
            parts[target] = target.with_name(f"{target.name}.{os.getpid()}.part")
            parts[target].write_text(text, encoding="utf-8", newline="\n")
        for target, part in parts.items():
            part.replace(target)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        text = (
            f"cannot write {path} ({why}), and nothing was written; give the path of a file that "
            "may be written"
        )
        raise CaseError(("", text)) from None
    finally:
        for part in parts.values():
            part.unlink(missing_ok=True)


def _check_names(options: Any) -> None:
    """Refuse to write over the case file, one page over the other, or a page under a name that says
    something else.
    """
    from .cases.read import CaseError

    taken = {realpath(options.case)}
    for option, name, endings in (
        ("--report", options.report, _HTML + _MARKDOWN),
        ("--what-if", options.what_if, _HTML),
        ("--play", options.play, _HTML),
    ):
        if name is not None:
            if realpath(name) in taken or not name.lower().endswith(endings):
                listed = " or ".join(endings[::2])
                raise CaseError(
                    (
                        "",
                        (
                            f"{option} cannot write {name}; give a name of its own, which ends "
                            f"in {listed}"
                        ),
                    )
                )
            taken.add(realpath(name))


def _refused(options: Any, error: CaseError, whole: Any) -> int:
    """Say what is wrong, a line each, or as JSON beside the results; gives the exit code."""
    if options.json:
        problems = [
            {"file": options.case, "key": key, "text": text} for key, text in error.problems
        ]
        print(_as_json({"code": error.code, "errors": problems, **whole}))
    for key, text in error.problems:
        print(": ".join(filter(None, (options.case, key, text))), file=sys.stderr)
    return 1 if error.refused else 2


def _warned(options: Any, warnings: Sequence[str]) -> None:
    """Say each warning on a line of its own."""
    for warning in warnings:
        print(f"{options.case}: warning: {warning}", file=sys.stderr)


def _as_json(whole: Any) -> str:
    """A document as it is printed; no number in it is NaN or infinite."""
    import json

    return json.dumps(whole, indent=1, allow_nan=False)


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """One line, as for every mistake."""
        self.exit(
            2,
            f"{self.prog}: {message}; write for example: {self.prog} case.toml --report "
            "report.html; see --help\n",
        )


class _Once(argparse.Action):
    """An option with a value that is given once: of two files one would not be written."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option: str | None = None,
    ) -> None:
        if getattr(namespace, self.dest) is not None:
            parser.error(f"{option} is given twice, and takes one file; give one of them")
        setattr(namespace, self.dest, values)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="collisions",
        description="Answers a case file: one vehicle impact or a whole crash as a page of text, "
        "forwards or backwards, with its uncertainty.",
        epilog=_ENDS,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "case",
        help="a case file; or 'new', which prints one to start from (collisions new > case.toml; "
        "with --scene a whole crash, with --units us in mph, ft and lb), or 'schema', for the JSON "
        "schema of case files for editors",
    )
    parser.add_argument(
        "--report", action=_Once, metavar="FILE", help="write a report: .html with figures, or .md"
    )
    parser.add_argument(
        "--what-if",
        action=_Once,
        metavar="FILE",
        help="write an HTML page with a slider for each uncertain number",
    )
    parser.add_argument(
        "--play",
        action=_Once,
        metavar="FILE",
        help="write an HTML page that plays a scene, with a slider of time",
    )
    parser.add_argument(
        "--scene", action="store_true", help="with 'new': a whole crash, with movers and contacts"
    )
    parser.add_argument(
        "--units",
        choices=SYSTEMS,
        help="of what is written; by default those of [report], else us or metric, as the inputs "
        "are",
    )
    parser.add_argument(
        "--json", action="store_true", help="print everything as JSON, for other tools"
    )
    parser.add_argument("--version", action="version", version=f"collisions {__version__}")
    return parser


if __name__ == "__main__":
    sys.exit(main())
