"""Fuzz by seeds: cheap draws, calls that are counted by public name, and every name of the package
listed to be compared.

Each seed is one case. ``COLLISIONS_FUZZ_CASES`` is the number of them (``100000``) or a range
(``50000:100000``), without it a few; ``COLLISIONS_FUZZ_COUNTS`` names a file for the table of how
often each name was called, answered, what a call cost, and what failed. An argument of a public
function that no case ever passes in a call that is answered fails the test that declares the
function. A failure names its seed: run it again alone by ``COLLISIONS_FUZZ_CASES=SEED:SEED+1 pytest
-m "" -k TEST``.
"""

from __future__ import annotations

import contextlib
import importlib
import inspect
import math
import os
import pickle
import random
import re
import signal
import threading
import time
import traceback
import warnings
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.derivation import explain
from collisions.diagnostics.finding import Findings
from collisions.diagnostics.moves import Moves
from collisions.estimate.fit_result import Direction, Estimate, Residual, Values
from collisions.estimate.posterior_result import PosteriorOutput
from collisions.impact.choice import ByModel
from collisions.impact.inputs import Inputs
from collisions.impact.left_out import LeftOut, LeftOutVehicle
from collisions.impact.pulse import Pulse
from collisions.impact.vehicle_result import VehicleResult
from collisions.messages.warning import Note
from collisions.quantities.attributes import Quantities
from collisions.quantities.units import Texts
from collisions.reconstruct.momentum_solution import Sensitivity
from collisions.scene.levels import Level
from collisions.scene.notices import Notice
from collisions.scene.required import Cost, Required
from collisions.scene.run import Moved, Rests, Track
from collisions.uncertainty.distribution import GivenUnit, WithoutUnit
from strategies import (
    EXTREMES,
    NEVER,
    NUMBERS,
    ODD_UNITS,
    PLACES,
    RANGES,
    SPELLINGS,
    UNITS,
    YAW_RATES,
    quantity,
    registries,
)

_FEW = 12
_MORE = 600  # seeds after which an argument that was never passed is one that nobody draws
_HANGS = 60.0  # seconds
_MOST_FAILURES = 25
_PACKAGE = str(Path(col.__file__).parent)
# What is said of a keyword that is unknown or left out, by Python or with what to write.
_MISSPELT = re.compile(
    r"missing \d+ required|unexpected keyword|multiple values for|keywords must be strings|takes "
    r"the fields of a Vehicle|^again\(\) takes the arguments of |^\w[\w.]*(\(\))? has no "
    r"argument '.*'; (write |it has |\w+ has it|\w+ and \w+ have it)|^Vehicle takes its "
    r"arguments by name",
    re.DOTALL,
)
# What an impact says of itself to be NaN where it ended while the contact points still approached.
INCOMPLETE = frozenset({"Impact.common_velocity", "LeftOut.mutual_crush", "LeftOut.residual_crush"})


def seeds() -> range:
    """The cases of a run."""
    first, _, last = os.environ.get("COLLISIONS_FUZZ_CASES", str(_FEW)).rpartition(":")
    return range(int(first or 0), int(last))


# --- the names ------------------------------------------------------------------------------------

MODULES = ("reporting", "diagnostics", "derivation")  # public beside those of collisions.__all__
# What is given back without being in any __all__.
GIVEN_BACK = (
    VehicleResult, Pulse, LeftOut, LeftOutVehicle, Findings, Moves, Estimate, Residual, Direction,
    Values,
    Sensitivity, ByModel, Inputs, PosteriorOutput,
    Note, Moved, Notice, Rests, Track, Cost, Level, Required,
)  # fmt: skip


@cache
def public() -> dict[str, Any]:
    """Every public callable by name: functions, classes and their own public methods, each under
    the first of its names.
    """
    found: dict[str, Any] = {}
    modules = [name for name in col.__all__ if isinstance(getattr(col, name), ModuleType)]
    for prefix in ("", *modules, *MODULES):
        module = importlib.import_module(f"collisions.{prefix}".rstrip("."))
        for name in getattr(module, "__all__", ()) or [explain.__name__]:
            value = getattr(module, name)
            # A protocol is for type checkers: nobody calls it.
            if getattr(value, "_is_protocol", False):
                continue
            if callable(value) and all(value is not other for other in found.values()):
                found[f"{prefix}.{name}".lstrip(".")] = value
    for kind in GIVEN_BACK:
        found.setdefault(kind.__name__, kind)
    classes = {name: kind for name, kind in found.items() if inspect.isclass(kind)}
    for name, kind in classes.items():
        # With those of bases that are not public themselves.
        for base in (
            kind,
            *(
                base
                for base in kind.__mro__
                if base not in classes.values() and "collisions" in base.__module__
            ),
        ):
            for method, value in vars(base).items():
                if not method.startswith("_") and (
                    inspect.isfunction(value) or isinstance(value, classmethod | staticmethod)
                ):
                    found[f"{name}.{method}"] = value
    return found


@cache
def _names_of(kind: type) -> list[str]:
    """The public names of a class and of those it is made from, nearest first."""
    names = {value: name for name, value in public().items() if inspect.isclass(value)}
    return [names[base] for base in kind.__mro__ if base in names]


@cache
def _shown_by(kind: type) -> tuple[str, ...]:
    """The public attributes of a class that are no methods."""
    return tuple(
        name
        for name in dir(kind)
        if not name.startswith("_") and name != "q" and not callable(getattr(kind, name))
    )


# Classes whose arguments are documented, and which callers are only given.
_ONLY_GIVEN = {
    "reconstruct.Reconstruction",
    "reference.Fit",
    "reference.Published",
    "diagnostics.Finding",
    "diagnostics.Limit",
}


@cache
def arguments(name: str) -> frozenset[str]:
    """The arguments of a public function, method or class that callers make, with those that **
    stands for.
    """
    value = public()[name]
    if inspect.isclass(value):
        made = issubclass(value, Exception) or (
            "\nParameters\n" in inspect.cleandoc(value.__doc__ or "") and name not in _ONLY_GIVEN
        )
        if not made:
            return frozenset()
    parameters = inspect.signature(getattr(value, "__func__", value)).parameters
    further = {given.name for given in parameters.values() if given.kind is given.VAR_KEYWORD}
    return frozenset(parameters) - {"self", "cls"} - further | (
        _further(name) if further else frozenset()
    )


def _further(name: str) -> frozenset[str]:
    """What ** stands for, where that is a list of names."""
    fields = frozenset(inspect.signature(col.Vehicle).parameters)
    if name == "Vehicle.from_speed":
        return fields - {
            "vx",
            "vy",
            "pivot",
        }  # the velocity of a pinned vehicle is that of its turning
    if name == "Impact.again":
        return frozenset().union(*AGAIN.values())
    if name == "Vehicle.barrier":
        return fields - {"pivot"}  # what is pinned turns, and has a mass
    return fields if name == "Vehicle.replace" else frozenset()


_RULED = ("friction", "impulse_ratio", "critical_fraction", "law", "incomplete")
_BOTH = ("a", "b", "restitution", "normal")
_HELD = ("duration", "tyres_a", "tyres_b")
# What an impact of each solver can be solved again with.
AGAIN = {
    "linear_central": (*_BOTH, "incomplete"),
    "oblique_central": (*_BOTH, *_RULED),
    "eccentric": (*_BOTH, *_RULED, "point", "outside_a", "outside_b", *_HELD),
    "solve": (*_BOTH, *_RULED, "point", "outside_a", "outside_b", *_HELD, "tolerance", "drag"),
    "time_resolved": (*_BOTH, *_HELD, "point", "friction", "stiffness", "crush_a", "crush_b",
    "drag", "geometry", "steps", "wheelbase", "track"),
}  # fmt: skip


@cache
def _signature(function: Any) -> inspect.Signature | None:
    try:
        return inspect.signature(function)
    except (TypeError, ValueError):
        return None


def _note_arguments(
    name: str, function: Any, args: tuple[Any, ...], kwargs: dict[str, Any]
) -> None:
    """Remember which arguments a call that was answered was given."""
    try:
        signature = _signature(function)
    except TypeError:  # a method of what has no hash
        signature = inspect.signature(function)
    if signature is None:
        return
    # What is required may be missing where nothing needs it, as in a batch of no cases.
    for parameter, value in signature.bind_partial(*args, **kwargs).arguments.items():
        several = signature.parameters[parameter].kind is inspect.Parameter.VAR_KEYWORD
        _passed[name].update(value if several else (parameter,))


# --- the run --------------------------------------------------------------------------------------

FUZZED: dict[str, str] = {}  # test by public name
_cases: Counter[str] = Counter()
_answered: Counter[str] = Counter()
_seconds: defaultdict[str, float] = defaultdict(float)
_failed: list[str] = []
_passed: defaultdict[str, set[str]] = defaultdict(
    set
)  # by public name, in calls that were answered


def fuzzes(
    *names: str, share: float = 1.0
) -> Callable[[Callable[[Case], None]], Callable[[], None]]:
    """Makes a test of a function of one case, which calls these public names; ``share`` of the
    seeds are enough for it.
    """

    def declare(body: Callable[[Case], None]) -> Callable[[], None]:
        for name in names:
            FUZZED[name] = body.__name__

        def test() -> None:
            _run(body, names, share)

        test.__name__, test.__doc__ = body.__name__, body.__doc__
        return test

    return declare


def _run(body: Callable[[Case], None], names: tuple[str, ...], share: float) -> None:
    every = seeds()
    chosen = (
        range(every.start, every.start + max(3, round(len(every) * share)))
        if len(every) > 3
        else every
    )
    before, failures = Counter(_cases), {}
    _passed.clear()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", col.CollisionsWarning)
        # A font need not have every letter of a name.
        warnings.filterwarnings("ignore", "Glyph .* missing from font")
        for seed in range(chosen.start, chosen.stop + (_MORE if len(every) >= _FEW else 0)):
            # Beyond those asked for as long as an argument has not been passed.
            if seed >= chosen.stop and not _never_passed(names):
                break
            case = Case(f"{body.__name__} {seed}")
            try:
                with _promptly():
                    body(case)
            except Exception as error:
                where = [
                    frame
                    for frame in traceback.extract_tb(error.__traceback__)
                    if frame.filename.startswith(_PACKAGE)
                ]
                place = (
                    f"{Path(where[-1].filename).relative_to(_PACKAGE)}:{where[-1].lineno}"
                    if where
                    else "the check"
                )
                line = f"{type(error).__name__}: {str(error)[:400]} at {place}, in {case.last}"
                failures.setdefault((type(error), place, case.last_name), [seed, line, 0])[2] += 1
                if len(failures) == _MOST_FAILURES:
                    break
    listed = [
        f"{body.__name__}, seed {seed} ({count} like it): {line}"
        for seed, line, count in failures.values()
    ]
    _failed.extend(listed)
    _write_counts()
    if failures:
        pytest.fail("\n".join(listed), pytrace=False)
    silent = [name for name in names if _cases[name] == before[name]]
    if silent and len(chosen) >= _FEW:
        pytest.fail(
            f"{body.__name__} says that it fuzzes {silent}, and never called them", pytrace=False
        )
    never = _never_passed(names)
    if never and len(every) >= _FEW:
        text = (
            f"{body.__name__} never passes these arguments in a call that is answered: "
            f"{', '.join(never)}; draw them in it"
        )
        pytest.fail(text, pytrace=False)


def _never_passed(names: tuple[str, ...]) -> list[str]:
    """Arguments of these public names that no call had."""
    return [
        f"{name}({given})" for name in names for given in sorted(arguments(name) - _passed[name])
    ]


class HungError(Exception):
    """What is still running is stopped by this."""


@contextlib.contextmanager
def _promptly() -> Iterator[None]:
    """Stops what has not ended within some seconds of processor time, where the system has an alarm
    to set.
    """
    # Windows has neither the alarm nor its signal.
    if (
        not hasattr(signal, "setitimer")
        or threading.current_thread() is not threading.main_thread()
    ):
        yield
        return

    def ring(*_: Any) -> None:
        raise HungError(f"still running after {_HANGS} s")

    previous = signal.signal(signal.SIGPROF, ring)
    signal.setitimer(signal.ITIMER_PROF, _HANGS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, previous)


def _write_counts() -> None:
    path = os.environ.get("COLLISIONS_FUZZ_COUNTS")
    if path:
        rows = [f"{'name':42}{'cases':>9}{'answered':>10}{'us a case':>11}{'seconds':>9}"]
        for name in sorted(_cases, key=lambda name: -_seconds[name]):
            each = 1e6 * _seconds[name] / _cases[name]
            rows.append(
                f"{name:42}{_cases[name]:9}{_answered[name]:10}{each:11.0f}{_seconds[name]:9.1f}"
            )
        Path(path).write_text(
            "\n".join([*rows, *_failed]) + "\n", encoding="utf-8", errors="replace"
        )


# --- one case -------------------------------------------------------------------------------------

_MOODS = ("plain",) * 8 + ("written",) * 3 + ("extreme",) * 3 + ("batch",) * 3 + ("odd",) * 3
_KINDS = ("f8", "f8", "f8", "f8", "f4", "f2", "g", ">f8", ">f4", "i4", "u1", "i8")
_BLANKS = (
    "?",
    "b",
    "H",
    "q",
    "e",
    "f",
    "d",
    "g",
    "F",
    "D",
    "S3",
    "U3",
    "O",
    "V4",
    "M8[s]",
    "m8[s]",
    ">f8",
    "f8,i4",
)
_ALPHABET = "abcdefghijkmnrstxyzKLMN0123456789 */^().-+%°·²³µΩ_[]{}<>&$|\\\n\x00é中\ud800"
_TEXTS = (
    "",
    "x",
    "a",
    "si",
    "us",
    "metric",
    "nan",
    "inf",
    "html",
    "text",
    "markdown",
    "brach",
    "raise",
    "sliding",
    "both",
)
_SPELLED = [text for group in SPELLINGS.values() for text in group] + list(ODD_UNITS)


Open = frozenset[str] | None


class Case(random.Random):
    """One case: what it draws, and the calls it makes."""

    last_name = ""
    _call: tuple[Any, ...] = ()
    _within: frozenset[int] = (
        frozenset()
    )  # what is being looked at: a fixed input, given back as it was, may hold itself

    def __init__(self, seed: str) -> None:
        super().__init__(seed)
        self.mood = self.choice(_MOODS)
        self.shape = self.choice(((3,), (3,), (3,), (1,), (2, 3), (0,)))

    def __reduce__(self) -> Any:
        raise TypeError("a case is not copied")

    # What is called.

    def call(self, name: str, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Any:
        """The answer of a public function, or the error it refuses with; anything else it raises is
        a failure.
        """
        _cases[name] += 1
        self.last_name, self._call = name, (args, kwargs)
        start, refused = time.process_time(), None
        try:
            found = function(*args, **kwargs)
        except col.CollisionsError as error:
            found = refused = error
        except TypeError as error:
            if not _MISSPELT.search(str(error)):
                raise
            return error
        _seconds[name] += time.process_time() - start
        if refused is None:
            _answered[name] += 1
            if name in public():
                _note_arguments(name, function, args, kwargs)
        else:
            _check_refusal(refused)
        return found

    def must(self, name: str, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Any:
        """The answer of a call that nothing can be wrong with."""
        found = self.call(name, function, *args, **kwargs)
        assert not isinstance(found, col.CollisionsError | TypeError), f"refused: {found}"
        return found

    @property
    def last(self) -> str:
        """The last call, as a text."""

        def shown(value: Any) -> str:
            try:
                return repr(value)[:300]
            except Exception:
                return f"a {type(value).__name__}"

        args, kwargs = self._call or ((), {})
        named = [f"{key}={shown(value)}" for key, value in kwargs.items()]
        return f"{self.last_name}({', '.join([*map(shown, args), *named])})"

    def look(
        self, value: Any, documented: Open = frozenset(), thorough: bool | None = None
    ) -> None:
        """Read everything that an answer shows; ``documented`` are names that may be no finite
        number in a plain case.

        None are all of them. Only now and then (``thorough``) with units, as a text, a table and a
        pickle.
        """
        thorough = self.random() < 0.1 if thorough is None else thorough
        self.last_name, self._call = f"what followed {self.last_name}", ((value,), {})
        self._look(value, "", documented, thorough)

    def _look(self, value: Any, label: str, documented: Open, thorough: bool) -> None:
        kind = type(value)
        if kind is float:
            free = documented is None or self.mood != "plain" or label in documented
            assert free or math.isfinite(value), f"{label} is {value}"
            return
        if kind is np.ndarray and value.dtype.kind == "f":
            free = documented is None or self.mood != "plain" or label in documented
            assert free or np.isfinite(value).all(), f"{label} is {value}"
            return
        if kind.__module__.partition(".")[0] == "collisions" and kind not in (
            col.Status,
            GivenUnit,
            WithoutUnit,
            Texts,
        ):
            self._look_at(value, kind, documented, thorough)
        # A list of lists of lists that was given as an input is not read to its end.
        nested = id(value) in self._within or len(self._within) > 50
        if isinstance(value, Mapping | tuple | list) and not nested:
            around, self._within = self._within, self._within | {id(value)}
            for part in value.values() if isinstance(value, Mapping) else value:
                self._look(part, label, documented, thorough)
            self._within = around

    def _look_at(self, value: Any, kind: type, documented: Open, thorough: bool) -> None:
        names = _names_of(kind)
        if kind in (col.Impact, col.reconstruct.MomentumSolution) and not np.all(value.ok):
            documented = None
        elif kind is col.Impact and documented is not None and incomplete(value):
            documented |= INCOMPLETE
        elif (
            kind is col.Impact
            and documented is not None
            and self.mood == "plain"
            and value.pulse is not None
            and without_energy(value)
        ):
            documented |= {"VehicleResult.kinetic_energy_change"}
        assert names, f"{kind} is given back, and fuzzing.GIVEN_BACK does not have it"
        name = names[0]
        start = time.process_time()
        last = self.last_name
        self.last_name = f"{last}, of whose answer {name}"
        for attribute in (
            *_shown_by(kind),
            *(name for name in getattr(value, "__dict__", ()) if not name.startswith("_")),
        ):
            try:
                found = getattr(value, attribute)
                if thorough and isinstance(quantities := getattr(value, "q", None), Quantities):
                    getattr(quantities, attribute)
            except col.CollisionsError as error:
                found = _check_refusal(error)
            self._look(found, f"{name}.{attribute}", documented, thorough)
        if thorough:
            assert isinstance(repr(value) + str(value), str)
            if hasattr(value, "_repr_html_"):
                assert isinstance(value._repr_html_(), str)
            if hasattr(kind, "__reduce__") and not isinstance(value, _UNPICKLABLE):
                assert type(pickle.loads(pickle.dumps(value))) is kind
        self.last_name = last
        _cases.update(names)
        _answered.update(names)
        _seconds[name] += time.process_time() - start

    # What is drawn.

    def maybe(self, chance: float) -> bool:
        """True so often."""
        return self.random() < chance

    def number(self, name: str) -> float:
        """What a caller who knows the library gives, in SI."""
        if name == "yaw_rate":
            return self.choice(YAW_RATES)
        low, high = RANGES.get(name, PLACES)
        if self.random() < 0.05:
            return self.choice((low, high, round(self.uniform(low, high))))
        return self.uniform(low, high)

    def extreme(self) -> float:
        """Any float, the ends of the range more often than the rest."""
        if self.random() < 0.7:
            return self.choice(EXTREMES) * self.choice((1.0, -1.0))
        return math.ldexp(self.uniform(-1.0, 1.0), self.randint(-1074, 1024))

    def array(self, name: str, shape: tuple[int, ...] | None = None) -> Any:
        """Numbers of any precision, order and layout."""
        shape = self.shape if shape is None else shape
        spoiled = self.random() < 0.3
        draw = (
            (lambda: self.extreme() if self.random() < 0.2 else self.number(name))
            if spoiled
            else lambda: self.number(name)
        )
        made = np.array([draw() for _ in range(math.prod(shape))], dtype=float).reshape(shape)
        kind = np.dtype(self.choice(_KINDS))
        if kind.kind in "iu":
            return np.nan_to_num(made, posinf=9.0, neginf=-9.0).clip(0, 200).astype(kind)
        if kind != np.float64:
            with np.errstate(all="ignore"):
                made = made.astype(kind)
        layout = self.randrange(8)
        if layout == 0 and shape:
            return np.repeat(made, 2, axis=-1)[..., ::2]
        if layout == 1 and shape:
            return made[..., ::-1]
        if layout == 2 and shape and made.size:
            return np.broadcast_to(made[..., :1], shape)
        return made

    def text(self) -> str:
        """A text of any kind, often nearly a number and a unit."""
        kind = self.randrange(6)
        if kind == 0:
            return self.choice(_TEXTS)
        if kind == 1:
            return "".join(self.choices(_ALPHABET, k=self.randrange(70)))
        number = (
            self.choice(NUMBERS)
            if kind == 2
            else repr(self.extreme())
            if kind == 3
            else repr(self.uniform(-50.0, 50.0))
        )
        near = number + self.choice((" ", "", "\t", "\u00a0", " *", "\x00")) + self.choice(_SPELLED)
        at = self.randrange(len(near))
        return near[:at] + self.choice(_ALPHABET) + near[at:] if kind == 5 else near

    def written(self, name: str) -> Any:
        """A plausible number with its unit, as a text or as a Quantity."""
        unit = self.choice(SPELLINGS[UNITS.get(name, "m")])
        value = self.number(name)
        return (
            f"{value!r} {unit}" if self.random() < 0.5 else quantity(value, unit, self.randrange(4))
        )

    def garbage(self) -> Any:
        """Anything at all."""
        kind = self.randrange(12)
        if kind < 4:
            return self.choice(NEVER)()
        if kind == 4:
            return self.extreme()
        if kind == 5:
            return self.choice(
                (None, None, True, False, (), [], {}, "", b"", 0, -1, 2**63, -(2**70), 3 + 0j)
            )
        if kind in (6, 7):
            return self.text()
        if kind == 8:
            found = np.zeros(
                self.choice(((), (2,), (0,), (3,), (2, 2), (1,) * 33)), dtype=self.choice(_BLANKS)
            )
            return found.reshape(-1)[0] if found.size and self.maybe(0.3) else found
        if kind == 9:
            return quantity(
                self.choice((self.extreme(), self.number("vx"), 3, None)),
                self.choice(_SPELLED),
                self.randrange(4),
            )
        if kind == 10:
            return self.array("x", self.choice(((2,), (0,), (3,), (4, 1), (2, 2), ())))
        return self.choice((list, tuple))([self.garbage() for _ in range(self.randrange(3))])

    def value(self, name: str) -> Any:
        """An argument, as the mood of the case has it."""
        mood, chance = self.mood, self.random()
        if mood == "odd":
            if chance < 0.15:
                return self.garbage()
            mood = self.choice(_MOODS)
        if mood == "written" and chance < 0.5:
            return self.written(name)
        if mood == "extreme" and chance < 0.25:
            return self.extreme()
        if mood == "batch" and chance < 0.4:
            return self.array(name)
        return self.number(name)

    def pair(self, name: str) -> Any:
        """A pair of arguments, at times anything."""
        if self.mood == "odd" and self.maybe(0.15):
            return self.garbage()
        return self.value(name), self.value(name)

    def spoil(self, keywords: dict[str, Any]) -> dict[str, Any]:
        """The same keywords; in an odd case now and then with one of them anything, left out or
        misspelt.
        """
        if self.mood == "odd" and keywords and self.maybe(0.5):
            name = self.choice(sorted(keywords))
            how = self.random()
            if how < 0.1:
                del keywords[name]
            elif how < 0.15:
                keywords[name + "_"] = keywords.pop(name)
            else:
                found = self.garbage()
                # A function of the caller's own may raise what it likes.
                keywords[name] = -1 if name == "progress" and callable(found) else found
        return keywords

    def option(self, *usual: Any) -> Any:
        """One of these, in an odd case at times anything."""
        return self.garbage() if self.mood == "odd" and self.maybe(0.15) else self.choice(usual)


def incomplete(impact: col.Impact) -> bool:
    """Whether the contact points of a single impact still approach in the end."""
    return (
        impact.inputs.incomplete and np.ndim(impact.restitution) == 0 and impact.restitution < 0.0
    )


def without_energy(impact: col.Impact) -> bool:
    """Whether neither body has a finite energy, so that a contact that took time does not say what
    each one gained.
    """
    return all(
        (math.isinf(state.mass) and (state.vx, state.vy) != (0.0, 0.0))
        or (state.yaw_inertia in (None, math.inf) and state.yaw_rate != 0.0)
        for state in (impact.a.before, impact.b.before)
    )


def _check_refusal(error: Any) -> None:
    """Every error has a label and a text, and can be caught as a ValueError."""
    assert re.fullmatch("[a-z][a-z_0-9]*", error.code), f"code {error.code!r} of {error}"
    assert isinstance(error, ValueError), type(error)
    assert str(error), "an error without a word"


# What holds the user's model, or is a mapping that is part of another answer.
_UNPICKLABLE = (ByModel, col.uncertainty.Propagation, col.uncertainty.Output)


@cache
def load_units() -> None:
    """The first unit loads pint, which is no case's fault."""
    registries()[0].Quantity(1.0, "km/h").to("m/s")
