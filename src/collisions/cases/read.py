"""Case files: one case as TOML, whose keys are the arguments of the public functions. Nothing in a
file is evaluated.
"""

from __future__ import annotations

import math
import re
import tomllib
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import date, time
from functools import cache
from inspect import Parameter, getdoc, signature
from pathlib import Path
from typing import Any

from .. import reconstruct, reference, travel, uncertainty
from ..impact import solvers
from ..messages.errors import CollisionsError, InputError, UnitsError
from ..messages.hints import nearest
from ..messages.marked import as_code
from ..quantities.reading import ArgumentReader
from ..quantities.units import example, shown, to_quantity, unit_as_written
from ..quantities.usual_units import Worked
from ..reporting import report
from ..reporting.checking import check_alone
from ..reporting.what_if import SLIDERS
from ..scene import Contact
from ..uncertainty.distribution import WithoutUnit
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle
from . import crash
from .words import DISTRIBUTIONS, as_in_file, in_file_words

# The functions of which a file calls one, by the name of its table.
FORWARD = {
    name: getattr(solvers, name)
    for name in ("linear_central", "oblique_central", "eccentric", "solve", "time_resolved")
}
SOLVERS: dict[str, Callable[..., Any]] = FORWARD | {
    f"reconstruct.{f.__name__}": f
    for f in (reconstruct.central, reconstruct.momentum, reconstruct.planar, reconstruct.speeds)
}  # fmt: skip
# What is asked of the uncertain numbers of a file; without a table of these it is ``propagate`` as
# in ``_PROPAGATE``.
STUDIES: dict[str, Callable[..., Any]] = {
    "propagate": uncertainty.propagate, "fit": reconstruct.fit, "posterior": reconstruct.posterior,
}  # fmt: skip
# Functions that may stand in place of a number: speed_a_after = { travel.speed = { distance = "12
# m", drag = 0.7 } }
FUNCTIONS: dict[str, Callable[..., Any]] = DISTRIBUTIONS | {
    "travel.speed": travel.speed,
    "reference.yaw_inertia": reference.yaw_inertia,
    "reconstruct.crush_energy": reconstruct.crush_energy,
    "reconstruct.inline_closing_speed": reconstruct.inline_closing_speed,
}
# The units of what they return, by which it is checked against what the place takes.
GIVES = {
    "travel.speed": "m/s",
    "reference.yaw_inertia": "kg*m**2",
    "reconstruct.crush_energy": "J",
    "reconstruct.inline_closing_speed": "m/s",
}
# Arguments that a file has no use for, or that come from the rest of it.
_NOT_IN_FILES = {
    "on_failure",
    "threads",
    "progress",
    "model",
    # Another function than the case.
    "finer",
    "finer_samples",
    "inputs",
    "unknowns",
    "impact",
    "uncertainty",
    "form",
    "rest",
}
# But for these of single functions.
_IN_FILES = {(Contact, "model")}
# Annotations of arguments that may be several numbers.
SEVERAL = ("Pair", "Impulse", "Segments", "Sequence[Input]", "tuple")
_PROPAGATE, _POSTERIOR = {"method": "quasi_random", "seed": 0}, {"seed": 0}
_UNCERTAIN = re.compile(r"(.*?)(\+/?-|±|(?<!\.)\.\.(?!\.))(.*?)(?:\(([^()]*%)\s*\)\s*)?", re.DOTALL)
# What people write for a range: "40-50 mph", "0.4 to 0.7", "1...2", which may also end in ".2".
_END = r"[0-9]+(?:\.[0-9]*)?"
_RANGE = re.compile(
    rf"(-?{_END})\s*(?:(?![eE]-)[^\d\s*^]+?\s*)?(?:-|–|to|…|\.{{3,}})\s*({_END})\s*"
    r"([a-zA-Z°%].*)?",
    re.DOTALL,
)
_TOO_MANY = re.compile(r"(?<![\d_])\d[\d_]{4300}")  # digits in a row, which Python does not read
# The parts of a key, and a whole one at the beginning of a line, a head or a pair; the time to read
# a key grows as the square of their number.
_PART = re.compile(r"""[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+'""")
_KEY = re.compile(
    rf"(?:^|[\[{{,])[ \t]*+((?:{_PART.pattern})(?:[ \t]*+\.[ \t]*+(?:{_PART.pattern}))*+)",
    re.MULTILINE,
)
_MOST_PARTS = 100
_PAIR, _SLOPES = '["1.2 m", "-0.4 m"]', '["2 %", "0 %"]'
_LARGEST_FILE = 1_000_000  # bytes
# Characters of a text that stands for a number, a range with its percentage at most, and of a key.
_LONGEST_TEXT = 200
_LONGEST_MESSAGE = 4000  # of one problem; what it quotes is shorter, but it may quote much


class CaseError(Exception):
    """What is wrong with a case, as pairs of key and text; ``refused`` if it was read, but has no
    answer; and the ``warnings`` that were given before it was found.
    """

    def __init__(
        self, *problems: tuple[str, str], refused: bool = False, code: str = "bad_case"
    ) -> None:
        self.problems = [
            (re.sub(r"\['(.*?)'\]", r'."\1"', key), " ".join(_cut(text, _LONGEST_MESSAGE).split()))
            for key, text in problems
        ]
        self.refused = refused
        self.code = code
        self.warnings: list[str] = []
        super().__init__("; ".join(f"{key}: {text}" for key, text in self.problems))


def _cut(text: str, longest: int) -> str:
    """A text of so many characters at most."""
    return text if len(text) <= longest else text[: longest - 3] + "..."


@dataclass(frozen=True)
class Uncertain:
    """A number that is not known exactly: its key, what is stated of it, and what stands for it in
    a single case.
    """

    key: str
    stated: Any
    nominal: Any

    @property
    def said(self) -> str:
        """What is stated, without what it means."""
        return str(self.stated).partition(",")[0]

    def named(self, key: str) -> Uncertain:
        """The same under another key."""
        return Uncertain(key, self.stated, self.nominal)


@dataclass(frozen=True)
class Call:
    """A call of a public function, whose arguments are constants, uncertain numbers or calls."""

    key: str
    function: Callable[..., Any]
    arguments: Mapping[str, Any]

    @property
    def named(self) -> str:
        """The name by which a file calls its function in place of a number; "" of any other."""
        return next((name for name, one in FUNCTIONS.items() if one == self.function), "")

    def __call__(self, values: Mapping[str, Any], **options: Any) -> Any:
        """The result for these values of the uncertain numbers, by key; a refusal names the key in
        the file.
        """
        arguments = {
            name: _with_values(argument, values) for name, argument in self.arguments.items()
        }
        try:
            return self.function(**arguments, **options)
        except CollisionsError as error:
            parts = error.fields.get("problems", (error,))
            places = [self._key_of(part) for part in parts]
            problems = [
                (key, self._message(part, key)) for part, key in zip(parts, places, strict=True)
            ]
            raise CaseError(
                *problems, refused=not isinstance(error, InputError), code=error.code
            ) from error

    def _message(self, error: CollisionsError, key: str) -> str:
        """What an error says, beside the key of its argument; of a range it names both ends, not
        what stands for them.
        """
        text, given = _beside_key(error, key), error.fields.get("given")
        one = self._argument(str(error.fields.get("argument")))
        if isinstance(one, Uncertain) and isinstance(error, UnitsError) and given is not None:
            if isinstance(one.stated.unit, WithoutUnit):
                text = f"{one.said} has no unit{error.fields.get('instead', '')}"
            else:
                text = text.replace(shown(given), one.said, 1)
        return in_file_words(text)

    def _argument(self, name: str) -> Any:
        """What was given for an argument, or for a part of it, such as "point[0]"."""
        whole, _, place = name.partition("[")
        found = self.arguments.get(whole)
        if place and isinstance(found, tuple):
            at = place.rstrip("]")
            return found[int(at)] if at.isdigit() and int(at) < len(found) else None
        return found

    def _key_of(self, error: CollisionsError) -> str:
        """The key that an error is about: an argument, that of a vehicle, or the table."""
        name = str(error.fields.get("argument", ""))
        body = error.fields.get("vehicle") or name.partition(".")[0]
        for own, value in self.arguments.items():
            if isinstance(value, dict) and name in value:
                return name if own in ("inputs", "unknowns") else f"{self.key}.{own}.{name}"
        inside = self.arguments.get(body)
        if isinstance(inside, Call) and inside.named:  # in place of a number
            inside = None
        if isinstance(inside, Call) or "vehicle" in error.fields:
            place = inside.key if isinstance(inside, Call) else body
            return f"{place}.{name.rpartition('.')[2]}".rstrip(".")
        first = name.partition("[")[0]
        if self.key == crash.SCENE and first in crash.FROM_TABLES:
            return name
        return f"{self.key}.{name}" if first in parameters(self.function) else self.key


def _beside_key(error: CollisionsError, key: str) -> str:
    """The message of an error, marked, without its argument where the key says it."""
    argument, fields = str(error.fields.get("argument") or ""), error.fields
    told = argument and key.endswith(argument.rpartition(".")[2])
    if told and "allowed" in fields and error.marked.startswith(f"{argument} must be "):
        got = fields.get("got") or as_code(as_in_file(fields["given"]))
        return f"must be {fields['allowed']}, got {got}{fields.get('instead', '')}"
    text = error.marked.removeprefix(f"{argument}: ")
    return text if error.place in ("", argument) else f"{error.place}: {text}"


@dataclass(frozen=True)
class Case:
    """A case as it was read: the solver and the call of it, what is asked of its uncertain numbers,
    options of the report.

    ``answer`` says which of several answers to take, from 1.
    """

    solver: str
    call: Call
    uncertain: Mapping[str, Uncertain]
    study: str
    options: Mapping[str, Any]
    report: Mapping[str, Any]
    ranges: Mapping[str, Any]
    answer: int | None


def read(path: str | Path) -> Case:
    """The case of a file; CaseError if it cannot be read."""
    try:
        with Path(path).open("rb") as file:
            return read_text(file.read(_LARGEST_FILE + 1))
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise CaseError(
            (
                "",
                (
                    f"cannot be read ({why}); give the path of a case file, or start from what "
                    "'new' prints"
                ),
            )
        ) from None


def read_text(data: bytes) -> Case:
    """The case of a file's content."""
    if len(data) > _LARGEST_FILE:
        raise CaseError(
            ("", "is larger than 1 MB; a case file is a page of text, such as 'new' prints")
        )
    try:
        # Some shells write UTF-16 where the output of a command is sent to a file.
        text = data.decode(
            "utf-16" if data.startswith((BOM_UTF16_LE, BOM_UTF16_BE)) else "utf-8-sig"
        )
        if any(len(_PART.findall(key[1])) > _MOST_PARTS for key in _KEY.finditer(text)):
            raise RecursionError
        document = tomllib.loads(text, parse_float=_float)
        if problems := list(_too_large(document)):
            raise CaseError(*problems)
        reader = Reader(document)
    except UnicodeDecodeError:
        raise CaseError(("", "is no text in UTF-8; save it with this encoding")) from None
    except RecursionError:
        raise CaseError(
            ("", "is nested too deeply; a value is a number, a text, a pair or a table of these")
        ) from None
    except ValueError as error:
        raise CaseError(_not_toml(text, str(error))) from None
    return reader.case()


class _TooLarge(float):
    """A number of a file that is too large for a float, which would become infinite."""

    text: str


def _float(text: str) -> float:
    """A number of a file."""
    found = float(text)
    if math.isinf(found) and "inf" not in text:
        found = _TooLarge(found)
        found.text = text
    return found


def _too_large(given: Any, key: str = "") -> Iterator[tuple[str, str]]:
    """The keys of numbers that are too large, and what is wrong with them."""
    if isinstance(given, _TooLarge):
        yield (
            key,
            f"has the number {given.text[:40]}, which is larger than 1.7e308; look for a slipped "
            "digit, or write inf",
        )
    elif isinstance(given, dict):
        for name, value in given.items():
            yield from _too_large(value, f"{key}.{name}" if key else name)
    elif isinstance(given, list):
        for i, value in enumerate(given):
            yield from _too_large(value, f"{key}[{i}]")


def _not_toml(text: str, error: str) -> tuple[str, str]:
    """The key of a text that is not TOML, and what is wrong with it, with the line and what to
    write.
    """
    error = _cut(error, _LONGEST_MESSAGE // 4)  # it may name a key of any length
    at, lines = re.search(r"at line (\d+)", error), re.split(r"\r\n|\n|\r(?!\n)", text)
    number = (
        int(at[1]) - 1
        if at
        else next((i for i, line in enumerate(lines) if _TOO_MANY.search(line)), 0)
    )
    line = lines[number].strip() if number < len(lines) else ""
    key, equals, value = (part.strip() for part in line.partition("#")[0].partition("="))
    table = next(
        (found[1] for one in lines[number::-1] if (found := re.match(r"\s*\[([\w. -]+)\]", one))),
        "",
    )
    if not re.fullmatch(r"[\w.-]+", key):
        key = ""
    cure = 'write key = value, with every text in quotes, such as mass = "1500 kg"'
    if "digits" in error:
        error, cure = (
            f"Too many digits (at line {number + 1})",
            "write a large number with a point, such as 1.0e30",
        )
    elif "twice" in error or "overwrite" in error:
        cure = "a file is of one case, with each table and each key once"
    elif set(line) & set("“”„‘’"):
        cure = 'write straight quotes, "'
    elif "\r" in text and "\n" not in text:
        cure = "save the file with line ends that TOML knows, LF or CRLF"
    elif key and re.fullmatch(r"[-+]?\d+,\d+", value):
        cure = f"a decimal has a point: write {key} = {value.replace(',', '.')}"
    elif key and equals and re.fullmatch(r"[^\"'\[{]+", value):
        cure = f'write {key} = "{value}", with every text in quotes'
    error = re.sub(
        r"\(('[^()]*),?\)",
        lambda name: "[" + ".".join(re.findall(r"'(.*?)'", name[1])) + "]",
        error,
    )
    where = _cut(f"{table}.{key}".strip("."), _LONGEST_TEXT) if equals and key else ""
    return where, f"is not TOML: {error}, {as_in_file(line)}; {_cut(cure, _LONGEST_TEXT)}"


@cache
def parameters(function: Callable[..., Any]) -> dict[str, Parameter]:
    """The arguments of a public function that a file may give, in the order of its signature."""
    found = dict(signature(function).parameters)
    if function == Vehicle.from_speed:
        found = {"speed": found["speed"], "course": found["course"], **parameters(Vehicle)}
        del found["vx"], found["vy"]
    return {
        name: parameter
        for name, parameter in found.items()
        if name not in _NOT_IN_FILES or (function, name) in _IN_FILES
    }


def vehicles(function: Callable[..., Any]) -> list[str]:
    """The arguments of a solver that are vehicles."""
    return [name for name, one in parameters(function).items() if one.annotation == "Vehicle"]


@cache
def descriptions(function: Callable[..., Any]) -> dict[str, str]:
    """Each argument with its unit and what its docstring says of it."""
    section = (getdoc(function) or "").partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    found: dict[str, str] = {}
    if function == Vehicle.from_speed:
        moving = {
            name: (getdoc(getattr(Vehicle, name)) or "").partition(",")[0].rstrip(".")
            for name in ("speed", "course")
        }
        found = descriptions(Vehicle) | moving
    for names, kind, text in re.findall(
        r"^(\w[\w, ]*?)(?: : (.*))?\n((?: {4}.*\n?)+)", section, re.MULTILINE
    ):
        if (as_for := re.match(r"\s*As for ``(\w+)``", text)) and as_for[1] in FORWARD:
            found = found | {
                name: descriptions(FORWARD[as_for[1]])[name] for name in names.split(", ")
            }
            continue
        unit = (re.search(r" ?\[\S+?\]", kind) or [""])[0].replace(" [1]", "").replace(" [-]", "")
        found = found | dict.fromkeys(
            names.split(", "), f"{' '.join(text.split()).rstrip('.')}{unit}"
        )
    return found


def suggestion(given: str, names: Iterable[str]) -> str:
    """What to write in place of a name that is not known."""
    listed = list(names)
    near = nearest(given, listed, 1, 0.7)
    return f"did you mean {near[0]}?" if near else f"write one of {', '.join(listed)}"


def parse_uncertain(text: str, bounds: Callable[[str, str], Any] = uncertainty.Uniform) -> Any:
    """What a text says of an uncertain number: "50 km/h +/- 3 km/h", "0.4 .. 0.7", either with "
    (95 %)"; None for others.

    A number after +/- is one standard deviation of a normal distribution; two dots stand between
    the ``bounds`` of a uniform one. With a percentage the range holds that share of a normal
    distribution.
    """
    found = _UNCERTAIN.fullmatch(text)
    if found is None:
        return None
    one, sign, other, coverage = (part and part.strip() for part in found.groups())
    # "nan" and "inf" are numbers, which are refused as such.
    units = ["" if part in ("nan", "inf") else unit_as_written(part) for part in (one, other)]
    shares = [unit in ("%", "percent") for unit in units]
    if re.match(r"[^\W\d]|[%°]", max(units)) and (
        shares[0] != shares[1] or (units[0] != units[1] and "" in units)
    ):
        both = [
            part if unit else f"{part} {max(units)}"
            for part, unit in zip((one, other), units, strict=True)
        ]
        cure = "'50 km/h +/- 3 km/h'" if any(shares) else repr(f" {sign} ".join(both))
        text = (
            f"cannot read {as_in_file(text)}: both numbers need the same unit; write for example "
            f"{cure}"
        )
        raise InputError(text, code="bad_units", argument="")
    if sign == "..":
        return uncertainty.Normal.between(one, other, coverage) if coverage else bounds(one, other)
    whole = uncertainty.Normal(one, other)
    if not coverage:
        return whole
    factor, unit = getattr(whole.unit, "factor", 1.0), getattr(whole.unit, "written", whole.unit)
    low, high = (
        f"{(whole.given_mean + side * whole.given_sd) / factor!r} {unit}".strip()
        for side in (-1.0, 1.0)
    )
    return uncertainty.Normal.between(low, high, coverage)


def _with_values(node: Any, values: Mapping[str, Any]) -> Any:
    if isinstance(node, Uncertain):
        if node.key not in values:
            return node.nominal
        # Where it was stated with a unit, a bare angle of more than a turn would give a warning.
        given, unit = values[node.key], node.stated.unit
        if isinstance(unit, WithoutUnit):
            return Worked(given, "", node.said)
        return to_quantity(given, unit) if hasattr(unit, "written") else given
    if isinstance(node, Call):
        found, unit = node(values), GIVES.get(node.named)
        return found if unit is None else Worked(found, unit, node.named)
    if isinstance(node, dict):
        return {name: _with_values(part, values) for name, part in node.items()}
    return tuple(_with_values(part, values) for part in node) if isinstance(node, tuple) else node


class Reader:
    """Reads one document, and collects what is wrong with it."""

    def __init__(self, document: dict[str, Any]) -> None:
        self.problems: list[tuple[str, str]] = []
        self.uncertain: dict[str, Uncertain] = {}
        self.solver = ""
        self.document: dict[str, Any] = self.as_tuples(document)
        # The reverse solvers under their names, as the others are.
        if isinstance(inside := self.document.get("reconstruct"), dict):
            del self.document["reconstruct"]
            self.document |= {f"reconstruct.{name}": table for name, table in inside.items()}

    def as_tuples(self, node: Any, key: str = "") -> Any:
        """A part of the document with its lists as tuples; whole numbers beyond those of TOML are
        refused.
        """
        if isinstance(node, dict):
            if key and "answer" in node:
                self.refuse(
                    f"{key}.answer",
                    f"stands inside the table [{key}]; move this line above the first table of "
                    "the file",
                )
            parts = {name: part for name, part in node.items() if name != "answer" or not key}
            for name in [name for name in parts if len(name) > _LONGEST_TEXT]:
                del parts[name]
                short = f"{key}.{_cut(name, 40)}".lstrip(".")
                most = f"a key has {_LONGEST_TEXT} at most, write its name"
                self.refuse(short, f"is a key of {len(name)} characters; {most}")
            return {
                name: self.as_tuples(part, f"{key}.{name}".lstrip("."))
                for name, part in parts.items()
            }
        if isinstance(node, list):
            return tuple(self.as_tuples(part, f"{key}[{at}]") for at, part in enumerate(node))
        if type(node) is int and not -(2**63) <= node < 2**63:
            self.refuse(
                key,
                "is a whole number of more than 64 bits, which TOML has not; write it with a "
                "point: 1.0e30",
            )
        if isinstance(node, (date, time)):
            self.refuse(
                key,
                f"is a date or a time, {as_in_file(node)}; write a number, or a text in quotes: "
                f'"{as_in_file(node)}"',
            )
        return node

    def refuse(self, key: str, text: str) -> None:
        self.problems.append((key, text))

    def case(self) -> Case:
        """The whole case."""
        self._observed_at_the_top()
        solvers_of, studies = (
            [name for name in names if name in self.document] for names in (SOLVERS, STUDIES)
        )
        if self.document.keys() & {*crash.TABLES}:
            return self._crash(solvers_of, studies)
        asked = solvers_of if len(solvers_of) == 1 else list(SOLVERS)
        bodies = list(dict.fromkeys(label for name in asked for label in vehicles(SOLVERS[name])))
        known = [*asked, *bodies, *STUDIES, *crash.TABLES, "report", "what_if", "answer"]
        self.known(self.document, "", known)
        if len(solvers_of) != 1:
            tables = ", ".join(f"[{name}]" for name in solvers_of or SOLVERS)
            what = (
                "has the tables {}; leave one of them"
                if solvers_of
                else "has no table of a solver; write one of {}, or [[mover]] and [[contact]]"
            )
            self.refuse("", what.format(tables))
            raise CaseError(*self.problems)
        self.solver = name = solvers_of[0]
        call = self.call(
            name,
            SOLVERS[name],
            self.document[name],
            {label: self.vehicle(label) for label in bodies},
        )
        for label in bodies if name == "reconstruct.speeds" else ():
            for key in {"vx", "vy", "speed", "course"} & self.table(label).keys():
                own = f"course_{label}" if key in ("vx", "vy") else f"{key}_{label}"
                self.refuse(
                    f"{label}.{key}",
                    f"is what {name} finds; leave it out, and write {own} in [{name}] if it is "
                    "known",
                )
        study, options = self._asked(studies)
        answer = self.document.get("answer")
        if answer is not None and not (type(answer) is int and answer > 0):
            self.refuse(
                "answer",
                "must be a whole number from 1, which of several answers to take, got "
                f"{as_in_file(answer)}; write 1",
            )
        page, ranges = self._pages()
        if self.problems:
            raise CaseError(*self.problems)
        return Case(name, call, self.uncertain, study, options, page, ranges, answer)

    def _observed_at_the_top(self) -> None:
        """Put what was observed, which may stand in a table of its own, into that of its study."""
        if "observed" not in self.document:
            return
        study = next((name for name in ("fit", "posterior") if name in self.document), "posterior")
        table = self.table(study)
        if "observed" in table:
            self.refuse(
                "observed", f"stands beside [{study}.observed]; leave out one of these tables"
            )
        self.document[study] = {"observed": self.document.pop("observed"), **table}

    def _crash(self, solvers_of: list[str], studies: list[str]) -> Case:
        """The case of a whole scene."""
        for name in solvers_of:
            self.refuse(
                name,
                "stands beside [[mover]] or [[contact]]; a file is of one impact, or of a scene "
                "whose impacts are its contacts",
            )
        known = [*crash.TABLES, *SOLVERS, *STUDIES, "report", "what_if"]
        self.known(self.document, "", known)
        self.solver = crash.SCENE
        call = crash.read_crash(self)
        study, options = self._asked(studies)
        page, ranges = self._pages()
        if self.problems:
            raise CaseError(*self.problems)
        return Case(crash.SCENE, call, self.uncertain, study, options, page, ranges, None)

    def _asked(self, studies: list[str]) -> tuple[str, dict[str, Any]]:
        """What is asked of the uncertain numbers, with its arguments."""
        if studies and studies[0] != "propagate" and not self.uncertain:
            self.refuse(
                studies[0],
                'has nothing to find; write what is sought as a range, such as speed = "20 km/h '
                '.. 90 km/h"',
            )
        if len(studies) > 1:
            self.refuse(studies[1], f"stands beside [{studies[0]}]; leave out one of these tables")
        study = studies[0] if studies else "propagate" if self.uncertain else ""
        return study, self.study(study) if study else {}

    def _pages(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """The options of the report, and the ranges of the page with sliders."""
        page, ranges = self.table("report"), self.table("what_if.ranges")
        self.known(page, "report", parameters(report))
        self._check_report(page)
        self.known(self.table("what_if"), "what_if", ["ranges"])
        self.known(ranges, "what_if.ranges", SLIDERS)
        return page, ranges

    def _check_report(self, page: dict[str, Any]) -> None:
        """Refuse options of the report that no report can use, also where none is asked for."""
        usual = {name: one.default for name, one in signature(report).parameters.items()}
        reader = ArgumentReader()
        check_alone(reader, usual | page)
        call = Call("report", report, page)
        known = {key for key, _ in self.problems}  # as of a date, which no key takes
        for problem in reader.problems:
            key = call._key_of(problem)
            if key not in known:
                self.refuse(key, call._message(problem, key))

    def known(self, table: Iterable[str], place: str, names: Iterable[str]) -> None:
        """Refuse the keys of a table that are not among these names."""
        for key in table:
            if key not in names:
                self.refuse(
                    f"{place}.{key}".lstrip("."), f"is not known here; {suggestion(key, names)}"
                )

    def table(self, name: str) -> dict[str, Any]:
        """The table at a path with dots; empty where there is none."""
        found: Any = self.document
        for part in name.split("."):
            found = found.get(part, {}) if isinstance(found, dict) else found
        if isinstance(found, dict):
            return found
        self.refuse(
            name,
            f"must be a table, got {as_in_file(found)}; write [{name}] on a line of its own, and "
            "its keys below",
        )
        return {}

    def vehicle(self, label: str) -> Call:
        """The vehicle of a table, by speed and course where it has them."""
        given = self.table(label)
        self.known(given, label, self.of_vehicles)
        return self.moving(label, given)

    @property
    def of_vehicles(self) -> list[str]:
        """The keys of a vehicle."""
        return [*(parameters(Vehicle) | parameters(Vehicle.from_speed))]

    def moving(self, label: str, given: Mapping[str, Any]) -> Call:
        """The vehicle with these keys, by speed and course where it has them."""
        function = Vehicle.from_speed if {"speed", "course"} & given.keys() else Vehicle
        if function != Vehicle and {"vx", "vy"} & given.keys():
            self.refuse(label, "has its velocity in two ways; leave vx and vy, or speed and course")
        takes = parameters(function)
        return self.call(
            label, function, {name: value for name, value in given.items() if name in takes}
        )

    def call(
        self,
        key: str,
        function: Callable[..., Any],
        given: Any,
        beside: Mapping[str, Any] | None = None,
        plain: bool = False,
    ) -> Call:
        """The call of a function with the arguments of a table, and those that stand ``beside`` it
        in the file.

        With ``plain`` every value is taken as it is.
        """
        takes = {
            name: one for name, one in parameters(function).items() if name not in (beside or {})
        }
        if not isinstance(given, dict):
            self.refuse(
                key,
                f"must be a table of arguments, got {as_in_file(given)}; write {{ "
                f"{next(iter(takes))} = ... }}",
            )
            given = {}
        self.known(given, key, takes)
        for name, one in takes.items():
            # What may be None is not known, which a file says by leaving it out.
            if (
                one.default is Parameter.empty
                and name not in given
                and "None" not in str(one.annotation)
            ):
                what = descriptions(function).get(name, name).replace("``", "")
                unit = re.search(r"\[(\S+)\]$", what)
                such = (
                    f", such as {_PAIR if one.annotation == 'Pair' else example(unit[1])}"
                    if unit
                    else ""
                )
                self.refuse(f"{key}.{name}", f"is missing; give it: {what}{such}")
        read = {
            name: value
            if plain
            else self.value(f"{key}.{name}", value, str(takes[name].annotation))
            for name, value in given.items()
            if name in takes
        }
        unknown = {name: None for name, one in takes.items() if one.default is Parameter.empty}
        return Call(key, function, {**unknown, **(beside or {}), **read})

    def value(self, key: str, value: Any, kind: str) -> Any:
        """An argument: a number or a text as it is, what stands there in place of a number, or the
        table of a vehicle's tyres.
        """
        if kind.removesuffix(" | None") == "Tyres":
            return self.call(key, Tyres, value)
        if not any(name in kind for name in ("Input", *SEVERAL)):
            return value
        if kind.removesuffix(" | None") == "Pair" and not (
            isinstance(value, tuple) and len(value) == 2
        ):
            self.refuse(
                key,
                f"takes two numbers in brackets, got {as_in_file(value)}; write for example "
                f"{_SLOPES if key.endswith('slope') else _PAIR}",
            )
        elif isinstance(value, dict):
            return self.function(key, value)
        elif isinstance(value, tuple):
            if any(name in kind for name in SEVERAL):
                return tuple(
                    self.value(f"{key}[{at}]", part, "Input") for at, part in enumerate(value)
                )
            self.refuse(
                key, f"takes one value, got {as_in_file(value)}; write a file for each case"
            )
        elif isinstance(value, str) and not self.fits(key, value):
            return None
        elif isinstance(value, str) and _UNCERTAIN.fullmatch(value):
            return self.stated(key, Call(key, parse_uncertain, {"text": value}))
        elif isinstance(value, str) and (found := _RANGE.fullmatch(value.strip())):
            low, high = (f"{found[at]} {found[3] or ''}".strip() for at in (1, 2))
            self.refuse(
                key,
                f'cannot read {as_in_file(value)}; a range has two dots: write "{low} .. {high}"',
            )
        return value

    def fits(self, key: str, text: str) -> bool:
        """Whether a text is short enough for a number; refused if it is not."""
        if len(text) > _LONGEST_TEXT:
            cure = 'such as "80 km/h", "50 km/h +/- 3 km/h" or "0.4 .. 0.7 (95 %)"'
            limit = f"a number with its unit, or a range, has {_LONGEST_TEXT} at most, {cure}"
            start = as_in_file(_cut(text, 40))
            self.refuse(key, f"is a text of {len(text)} characters, {start}; {limit}")
        return len(text) <= _LONGEST_TEXT

    def function(self, key: str, table: Any) -> Any:
        """The result of the function that a table names in place of a number."""
        for name, function in FUNCTIONS.items():
            inside = table
            for part in name.split("."):
                inside = inside.get(part) if isinstance(inside, dict) and len(inside) == 1 else None
            if inside is not None:
                count = len(self.problems)
                call = self.call(f"{key}.{name}", function, inside, plain=name in DISTRIBUTIONS)
                return (
                    self.stated(key, call)
                    if name in DISTRIBUTIONS and len(self.problems) == count
                    else call
                )
        cure = suggestion(".".join(table), FUNCTIONS)
        self.refuse(
            key,
            "is a table that names no function which may stand for a number, got "
            f"{as_in_file(table)}; {cure}",
        )
        return None

    def stated(self, key: str, call: Call) -> Any:
        """An uncertain number; its mean, or the middle of an interval, stands in a single case, in
        the unit as written.
        """
        try:
            found = call({})
        except CaseError as error:
            self.problems.extend(error.problems)
            return None
        middle = (
            0.5 * found.low + 0.5 * found.high
            if isinstance(found, uncertainty.Interval)
            else getattr(found, "mean", None)
        )
        if middle is None and ".observed[" not in key:
            self.refuse(
                key,
                "is a reading with one bound, which only an observation may be; write a range, "
                'such as "0.4 .. 0.7"',
            )
        elif middle is not None and hasattr(found.unit, "written"):
            middle = f"{middle / found.unit.factor:.15g} {found.unit.written}"
        elif middle is not None and isinstance(found.unit, WithoutUnit):
            middle = f"{middle:.15g}"  # a text without a unit is refused where one is needed
        name = key.removeprefix(f"{self.solver}.")
        self.uncertain[name] = Uncertain(name, found, middle)
        return self.uncertain[name]

    def study(self, name: str) -> dict[str, Any]:
        """The arguments of what is asked of the uncertain numbers."""
        given = self.table(name)
        takes = parameters(STUDIES[name])
        self.known(given, name, takes)
        found = dict(given)
        if name == "propagate":
            bounds_only = all(
                isinstance(one.stated, uncertainty.Interval) for one in self.uncertain.values()
            )
            found = ({"method": "interval"} if bounds_only else _PROPAGATE) | found
        elif name == "posterior":
            found = _POSTERIOR | found
        rows = found.get("correlation", ())
        if isinstance(rows, tuple) and all(
            isinstance(row, tuple) and len(row) == 3 for row in rows
        ):
            found |= {"correlation": {row[:2]: row[2] for row in rows}} if rows else {}
        else:
            self.refuse(
                f"{name}.correlation",
                f'takes rows such as [["a.mass", "b.mass", 0.5]], got {as_in_file(rows)}; write '
                "them so",
            )
        if "observed" in takes:
            rows = given.get("observed")
            if not isinstance(rows, dict) or not rows:
                self.refuse(
                    f"{name}.observed",
                    'must be a table of what was found; write "a.delta_v" = "20 km/h +/- 1 km/h"',
                )
                rows = {}
            found["observed"] = {
                key: self._observed(f"{name}.observed['{key}']", value)
                for key, value in rows.items()
            }
        return found

    def _observed(self, key: str, value: Any) -> Any:
        """A measured value with its error, or bounds of it: a text, a table that names what it is,
        or a pair.
        """
        found = value
        if isinstance(value, str) and not self.fits(key, value):
            found = None
        elif isinstance(value, str) and _UNCERTAIN.fullmatch(value):
            # For an observation, two dots say that it lies between, not how probable each place is.
            found = self.stated(
                key, Call(key, parse_uncertain, {"text": value, "bounds": uncertainty.Interval})
            )
        elif isinstance(value, dict) and not value.keys() & {
            name.partition(".")[0] for name in FUNCTIONS
        }:
            self.refuse(
                key,
                'has its name without quotes; write "a.delta_v" = "20 km/h +/- 1 km/h", the name '
                "in quotes too",
            )
        elif isinstance(value, (str, dict)):
            found = self.value(key, value, "Input")
        self.uncertain.pop(key, None)
        return found.stated if isinstance(found, Uncertain) else found
