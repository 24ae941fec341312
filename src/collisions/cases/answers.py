"""Answers of a case file: results, what follows from its uncertain numbers, warnings; as text, as
JSON and as a report.
"""

from __future__ import annotations

import json
import math
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import reduce
from inspect import signature
from typing import Any

import numpy as np

from ..diagnostics import diagnose
from ..impact.impact import Impact
from ..impact.reconstruction import side_of
from ..messages.errors import CollisionsWarning, InputError, as_marked
from ..messages.warning import of_answer
from ..quantities.attributes import missing_error, unit_of
from ..quantities.formatting import percent
from ..quantities.tables import given_texts, spoken_system
from ..quantities.units import rendered, to_quantity
from ..reconstruct import MomentumSolution
from ..reporting import report
from ..reporting.checking import inputs_of
from ..reporting.play import play
from ..reporting.record import record
from ..reporting.scene_words import input_in_words
from ..reporting.what_if import starts, what_if
from ..scene.run import Run
from ..scene.scene import Scene
from ..uncertainty import Interval, OneSided
from .crash import SCENE
from .crash_answers import crash_model, found_run, usual_outputs
from .read import (
    FUNCTIONS,
    SOLVERS,
    STUDIES,
    Call,
    Case,
    CaseError,
    Uncertain,
    descriptions,
    parameters,
    suggestion,
)
from .words import as_in_file, in_file_words


@dataclass(frozen=True)
class Answers:
    """The results of a case, what follows from its uncertain numbers, and the texts of the warnings
    so far.
    """

    case: Case
    results: tuple[Any, ...]
    propagation: Any
    warnings: list[str]

    def report(self, form: str, units: str | None = None) -> str:
        """The report of the one result; ``units`` in place of those of the file."""
        options = {
            **self.case.report,
            "units": self._units(units),
            "form": form,
            "uncertainty": self.propagation,
        }
        notes, one = options.get("notes", ()), self._one()
        if isinstance(notes, (str, tuple, dict)):
            own = notes if isinstance(notes, tuple) else (notes,)
            if isinstance(one, (Impact, MomentumSolution)):
                options["notes"] = (*own, *_stated(self.case.call, inputs_of(one), own))
            elif isinstance(one, Run):
                options["notes"] = (*own, *_stated_in_scene(self.case.call, one.scene))
            else:
                # The result of a study holds neither the solver nor what is known exactly.
                case = "a scene" if self.case.solver == SCENE else self.case.solver
                known = ", ".join(_known(self.case.call))
                options["notes"] = (*own, f"The case is {case}, with {known}.")
        whole: str = self._made(report, {**options, "impact": one})
        return whole

    def what_if(self, units: str | None = None) -> str:
        """The page with sliders: over the ranges of the file, or over what it says of its uncertain
        numbers.
        """
        one, found = self._one(), self.case.ranges
        if not isinstance(one, Impact):
            text = (
                "moves the inputs of an impact, and this file gives none; ask for it in a file "
                "with [eccentric] or the like"
            )
            text += (
                f", and without [{self.case.study}]"
                if self.case.study not in ("", "propagate")
                else ""
            )
            raise CaseError(("what_if", text))
        if one.inputs.tyres:
            text = (
                "has no page for an impact with tyres, whose force it would not work out again; "
                "leave the duration and the tables of tyres out, and give outside_a and outside_b, "
                "the impulses of the tyres that the report has"
            )
            raise CaseError(("what_if", text))
        if not found:
            known = starts(one)
            named = (
                (_slider(key), uncertain.stated) for key, uncertain in self.case.uncertain.items()
            )
            found = {name: _ends(name, stated) for name, stated in named if name in known}
            if not found:
                text = (
                    "is not there, and nothing else says what to move; write it, such as speed_a "
                    '= ["30 km/h", "80 km/h"]'
                )
                raise CaseError(("what_if.ranges", text))
        drawn = {
            name: outline
            for name, outline in self.case.report.items()
            if name.startswith("outline_")
        }
        whole: str = self._made(
            what_if,
            {"impact": one, "ranges": found, "units": self._units(units), **drawn},
            "what_if",
        )
        return whole

    def play(self, units: str | None = None) -> str:
        """The page that plays the scene: as it was stated, or as a study found it."""
        if self.case.solver != SCENE:
            text = "plays a scene, and this file is of one impact; write [[mover]] and [[contact]]"
            raise CaseError(("play", text))
        run, one = self._one(), self._one()
        if not isinstance(one, Run):
            with _noting(self.warnings):
                run, which = found_run(self.case, one)
            self.warnings.append(f"the page plays the scene of {which}")
        whole: str = self._made(play, {"run": run, "units": self._units(units)}, "play")
        return whole

    def _one(self) -> Any:
        """The one result that a page is of."""
        if len(self.results) > 1:
            text = (
                f"{len(self.results)} answers fit, and a page is of one; write answer = 1 or "
                "another at the top of the file"
            )
            raise CaseError(("answer", text), refused=True, code="ambiguous")
        return self.results[0]

    def text(self, units: str | None = None) -> str:
        """The results with their findings, and the ranges with what they come from."""
        found: list[Any] = []
        system = self._units(units)
        for number, result in enumerate(self.results, 1):
            found += [f"Answer {number} of {len(self.results)}"] if len(self.results) > 1 else []
            parts = [result]
            if (looked := self._looked_at(result, system)) is not None:
                parts.append(looked)
            found += [self._made(part.summary, {"units": system}) for part in parts]
        if self.propagation is not None:
            found.insert(
                0,
                "Of what is not known exactly the mean, or the middle of an interval; below, "
                "what its spread does:",
            )
            shares = [
                self._made(_variance_shares, {"output": output}, "propagate")
                for output in self.propagation.outputs.values()
            ]
            found += [self.propagation.summary(system), "\n".join(filter(None, shares))]
        return "\n\n".join(str(part).strip() for part in found if str(part).strip()) + "\n"

    def to_dict(self) -> dict[str, Any]:
        """Everything in plain values for other tools: each result as the record at the end of a
        report.
        """
        results = [json.loads(record(result, {}, self.propagation)) for result in self.results]
        ranges = (
            None
            if self.propagation is None
            else self._made(self.propagation.to_dict, {}, "propagate")
        )
        return {
            "results": results,
            "statements": [list(getattr(result, "statements", ())) for result in self.results],
            "findings": [
                []
                if (looked := self._looked_at(result, None)) is None
                else looked.to_dict()["findings"]
                for result in self.results
            ],
            "uncertainty": ranges,
            "warnings": self.warnings,
        }

    def _looked_at(self, result: Any, units: Any) -> Any:
        """What ``diagnose`` finds in a result, as the file asks for it; None for one that it does
        not take.
        """
        if not isinstance(result, (Impact, MomentumSolution, Run)):
            return None
        given = {
            name: value for name, value in self.case.report.items() if name in parameters(diagnose)
        }
        given |= {} if units is None else {"units": units}
        return self._made(diagnose, {**given, "impact": result}, "report")

    def _units(self, units: str | None) -> Any:
        given = {"units": units} if units else self.case.report
        if "units" in given:
            return given["units"]
        return spoken_system(given_texts(self.results[0]))

    def _made(self, function: Any, arguments: dict[str, Any], key: str = "report") -> Any:
        """What a function makes of the results; its warnings are kept, and a refusal names the
        table of its options.
        """
        with _noting(self.warnings, [] if key == "propagate" else None):
            return Call(key, function, arguments)({})


def _stated(
    call: Call, inputs: list[str], own: tuple[Any, ...], place: str = ""
) -> Iterator[str | dict[str, str]]:
    """What a file states of inputs other than a number: beside the inputs of a page, or in a
    paragraph each. ``place`` is the table within that of the solver, such as "a." or "tyres_a.".
    """
    beside = {name: text for one in own if isinstance(one, dict) for name, text in one.items()}
    for key, value in call.arguments.items():
        if _is_table(value):
            yield from _stated(value, inputs, own, f"{key}.")
            continue
        text = _in_words(value)
        name = f"{place}{key}"
        on_page = next((one for one in (name, name.replace("_after.", ".")) if one in inputs), None)
        if text and on_page:
            yield {
                on_page: f"{text}. {beside[on_page]}"
                if isinstance(beside.get(on_page), str)
                else text
            }
        elif text:
            yield f"{name}: {text}."


def _is_table(value: Any) -> bool:
    """Whether a call stands for a table, of a vehicle or its tyres, and not for a number."""
    return isinstance(value, Call) and value.function not in FUNCTIONS.values()


def _numbers_of_scene(node: Any) -> Iterator[tuple[str, Call | None, Any]]:
    """The numbers that a file gives of a scene: key, the call that each is of, and value."""
    if isinstance(node, Call):
        for name, value in node.arguments.items():
            if _is_table(value) or name in ("movers", "contacts", "surfaces", "tyres_after"):
                yield from _numbers_of_scene(value)
            elif value is not None and name not in ("order", "shared"):
                yield f"{node.key}.{name}", node, value
        return
    for at, part in enumerate(node.values() if isinstance(node, dict) else node):
        if isinstance(part, Call):
            yield from _numbers_of_scene(part)
        else:
            corners, friction = part
            yield f"surfaces[{at}].corners", None, corners
            yield f"surfaces[{at}]", None, friction


def _stated_in_scene(call: Call, scene: Scene) -> Iterator[str]:
    """What a file states of the inputs of a scene other than a number, in a paragraph each."""
    known = scene.inputs()
    for key, _, value in _numbers_of_scene(call):
        if text := _in_words(value):
            path = key.removeprefix(f"{SCENE}.")
            # Both parts of a point and of a slope are inputs, and what was given is the pair.
            named = path in known or f"{path}[0]" in known
            yield f"{input_in_words(scene, path) if named else key}: {text}."


def _in_words(value: Any, given: bool = False) -> str:
    """What a value is stated as, or worked out from; "" of a number, unless it is ``given`` to a
    function.
    """
    if isinstance(value, Uncertain):
        return str(value.stated) if given else f"Stated as {value.stated}"
    if isinstance(value, Call):
        parts = [
            f"{key} {_in_words(part, given=True)}{_unit_of(value, key, part)}"
            for key, part in value.arguments.items()
            if part is not None
        ]
        return f"{'' if given else 'Worked out by '}{value.named} from {'; '.join(parts)}"
    if isinstance(value, tuple):
        parts = [_in_words(part, given=True) for part in value]
        # It stands beside every one of them.
        several = "both" if len(parts) == 2 else f"all {len(parts)}"
        stated = f"Stated of {several}, in order: {'; '.join(parts)}"
        return ", ".join(parts) if given else stated if any(map(_in_words, value)) else ""
    return str(value) if given else ""


def _unit_of(call: Call, name: str, value: Any) -> str:
    """The unit in which an argument takes a plain number, to stand behind it; "" of
    anything else.
    """
    unit = re.search(r"\[(\S+)\]$", descriptions(call.function).get(name, ""))
    return f" {unit[1]}" if unit and isinstance(value, (int, float)) else ""


def _known(call: Call) -> Iterator[str]:
    """What a call is given that is known exactly, each with its key."""
    if call.key == SCENE:
        for key, of, value in _numbers_of_scene(call):
            name = key.rpartition(".")[2]
            if isinstance(value, Call):
                yield from _known(value)
            elif not _uncertain(value):
                unit = "" if of is None else _unit_of(of, name, value)
                yield f"{key} = {as_in_file(value)}{unit}"
        return
    for name, value in call.arguments.items():
        if isinstance(value, Call):
            yield from _known(value)
        elif value is not None and not _uncertain(value):
            yield f"{call.key}.{name} = {value}{_unit_of(call, name, value)}"


def _uncertain(value: Any) -> bool:
    """Whether a value, or a part of it, is not known exactly."""
    parts = value if isinstance(value, tuple) else (value,)
    return any(isinstance(part, Uncertain) for part in parts)


def _variance_shares(output: Any) -> str:
    """The inputs that the spread of an output comes from, as shares of its variance; "" where there
    are none.
    """
    with suppress(InputError):
        shares = sorted(output.contributions.items(), key=lambda one: -one[1])
        # Errors of sampling may bring one above the whole.
        listed = ", ".join(
            f"{name} {percent(min(share, 1.0))}" for name, share in shares if share >= 0.005
        )
        return f"Variance of {output.name}: {listed}" if listed else ""
    return ""


def _ends(name: str, stated: Any) -> tuple[str, str]:
    """The range of a slider over an uncertain number: its bounds, or three standard deviations to
    either side within them.
    """
    low, high = (stated.low, stated.high) if isinstance(stated, Interval) else stated.support
    if math.isinf(high - low):
        low, high = (
            max(low, stated.mean - 3.0 * stated.sd),
            min(high, stated.mean + 3.0 * stated.sd),
        )
    # Beyond these a slider would be refused, though a normal distribution reaches there.
    if name in ("restitution", "friction", "critical_fraction", "speed_a", "speed_b"):
        low = max(low, 0.0)
    if name in ("restitution", "critical_fraction"):
        high = min(high, 1.0)
    return f"{low!r} {stated.unit}".rstrip(), f"{high!r} {stated.unit}".rstrip()


# What an impact changes in a vehicle.
_MOVING = ("vx", "vy", "speed", "course", "yaw_rate")


def _slider(key: str) -> str:
    """The name by which ``what_if`` knows a key of the file."""
    label, _, name = key.rpartition(".")
    if name not in _MOVING:
        label = label.removesuffix("_after")  # what an impact leaves as it was
    return f"{name}_{label}" if label else key.replace("[0]", "_x").replace("[1]", "_y")


def answers(case: Case) -> Answers:
    """Solve a case, and do what it asks of its uncertain numbers."""
    noted: list[str] = []
    try:
        results, propagation = _answered(case, noted)
    except CaseError as error:
        error.warnings = noted
        raise
    return Answers(case, results, propagation, noted)


def _answered(case: Case, noted: list[str]) -> tuple[Any, Any]:
    """The results of a case, and what a propagation found of them; warnings go to ``noted``."""
    if case.study in ("", "propagate"):
        with _noting(noted) as of_the_case, of_answer(_at(case)):
            roots = _all_roots(case)
        results = _asked_for(case, roots)
        with _noting(noted, of_the_case):
            propagation = _propagated(case, results, len(roots)) if case.uncertain else None
        if case.study and not case.uncertain:
            noted.append(
                "[propagate] has nothing to propagate; write a number with its error, such as "
                '"50 km/h +/- 3 km/h"'
            )
    else:
        with _noting(noted):
            observed = case.options["observed"]
            model = (
                crash_model(case, list(observed), f"{case.study}.observed")
                if case.solver == SCENE
                else _model(case, observed, _at(case) or 0, _count(case))
            )
            unknowns = {name: one.stated for name, one in case.uncertain.items()}
            study = Call(
                case.study,
                STUDIES[case.study],
                {"model": model, "unknowns": unknowns, **case.options},
            )
            results, propagation = (study({}),), None
    return results, propagation


def _asked_for(case: Case, roots: tuple[Any, ...]) -> tuple[Any, ...]:
    """The answer that the file asks for, or all of them."""
    results = roots if case.answer is None else roots[case.answer - 1 : case.answer]
    if not results:
        text = (
            f"is {as_in_file(case.answer)}, and {len(roots)} fit; write a number from 1 to "
            f"{len(roots)}"
        )
        raise CaseError(("answer", text))
    return results


def _count(case: Case) -> int:
    """How many answers a case has with each of its numbers as stated, of which a fit or posterior
    follows the one that the file asks for; 1 where it has none there.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            roots = _all_roots(case)
    except CaseError:
        if (case.answer or 1) > 1:
            raise
        return 1
    if len(_asked_for(case, roots)) > 1:
        raise _unchosen(len(roots))
    return len(roots)


def _unchosen(count: int) -> CaseError:
    text = (
        f"is not given, and {count} answers fit; write answer = 1 or another at the top of the file"
    )
    return CaseError(("answer", text), refused=True, code="ambiguous")


@contextmanager
def _noting(
    texts: list[str], before: list[CollisionsWarning] | None = None
) -> Iterator[list[CollisionsWarning]]:
    """Within this context warnings are not issued but added to the texts, each once.

    In a study of a case that gave the warnings ``before``, warnings that count the study's cases
    replace those of the case with the same code; of others one per code is added where the case has
    none. That a number needs a unit the case has said before.
    """
    found: list[CollisionsWarning] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", CollisionsWarning)
        try:
            yield found
        finally:
            # Also of a case that is refused then.
            found += [one.message for one in caught if isinstance(one.message, CollisionsWarning)]
            _add(found, texts, before)


def _add(
    found: list[CollisionsWarning], texts: list[str], before: list[CollisionsWarning] | None
) -> None:
    """Add warnings to the texts, as ``_noting`` says."""
    codes = {one.code for one in before or ()} | (
        {"suspect_units"} if before is not None else set()
    )
    counted = {one.code for one in found if "cases" in one.fields} if before is not None else set()
    texts[:] = [
        text
        for text in texts
        if text not in {_line(one) for one in before or () if one.code in counted}
    ]
    for one in found:
        if (one.code not in codes or "cases" in one.fields) and _line(one) not in texts:
            texts.append(_line(one))
        if before is not None:
            codes.add(one.code)


def _line(warning: CollisionsWarning) -> str:
    return " ".join(in_file_words(as_marked(warning)).split())


def _at(case: Case) -> int | None:
    """The place of the answer that the file asks for, from 0; None where it asks for none."""
    return None if case.answer is None else case.answer - 1


def _all_roots(case: Case) -> tuple[Any, ...]:
    """Every answer that the solver of a case returns."""
    try:
        return _roots(case.call({}))
    except CaseError as error:
        if error.code == "ambiguous" and case.answer is not None:
            text = (
                "chooses among answers that a solver returns side by side, as speeds does; what is "
                "refused as ambiguous needs another number that decides, as said above"
            )
            error.problems.append(("answer", text))
        raise


def _roots(found: Any) -> tuple[Any, ...]:
    """The results of a solver, always as a tuple."""
    return found if isinstance(found, tuple) else (found,)


def _propagated(case: Case, results: tuple[Any, ...], count: int) -> Any:
    """What follows for the outputs that were asked for, or for the first that a reader
    looks for.
    """
    if len(results) > 1:
        raise _unchosen(count)
    options = dict(case.options)
    outputs = options.pop("outputs", _default_outputs(results[0]))
    if (
        not isinstance(outputs, tuple)
        or not outputs
        or not all(isinstance(name, str) for name in outputs)
    ):
        raise CaseError(
            (
                "propagate.outputs",
                'must be a list of names of answers, such as ["a.delta_v", "energy_loss"]',
            )
        )
    model = (
        crash_model(case, list(outputs), "propagate.outputs")
        if case.solver == SCENE
        else _model(case, outputs, (case.answer or 1) - 1, count)
    )
    inputs = {name: one.stated for name, one in case.uncertain.items()}
    return Call("propagate", STUDIES["propagate"], {"model": model, "inputs": inputs, **options})(
        {}
    )


def _model(case: Case, outputs: Any, which: int, count: int) -> Any:
    """The case as a function of its uncertain numbers, which gives these outputs as Quantities."""
    takes = signature(SOLVERS[case.solver]).parameters
    place = "outputs" if case.study == "propagate" else "observed"
    options = {"on_failure": "nan"} if "on_failure" in takes else {}

    def model(**values: Any) -> dict[str, Any]:
        with of_answer(_at(case)):
            roots = _roots(case.call(values, **options))
        all_there = True if len(roots) == count == 1 else _all_there(case, roots, count)
        shape = np.broadcast_shapes(*map(np.shape, values.values()))
        found = roots[min(which, len(roots) - 1)]
        return {
            name: _output(found, name, f"{case.study or 'propagate'}.{place}", all_there, shape)
            for name in outputs
        }

    return model


def _all_there(case: Case, roots: tuple[Any, ...], count: int) -> Any:
    """In which cases there are as many answers as in the stated one; in the others there is none.

    Another number is refused: where two answers have met and vanished, those left cannot be told
    apart.
    """
    many: Any = sum(1 - np.asarray(root.refused, dtype=int) for root in roots)
    for other in np.unique(many).tolist():
        if other not in (0, count):
            text = (
                f"has {'more' if other > count else 'fewer'} answers in some cases than in the "
                f"stated one ({other} for {count}), and which is which cannot be told there; "
                "narrow what is uncertain, or give what decides"
            )
            raise CaseError((case.solver, text), refused=True, code="ambiguous")
    return many == count


def _found(result: Any, name: str) -> tuple[Any, str, Any, str | None]:
    """The object that holds the number of a path, the number's own name, the number and its unit;
    None for any other value.
    """
    path, _, last = name.rpartition(".")
    owner = reduce(
        lambda whole, part: getattr(whole, part, None), filter(None, path.split(".")), result
    )
    return owner, last, getattr(owner, last, None), unit_of(type(owner), last)


def _output(result: Any, name: str, place: str, there: Any, shape: tuple[int, ...]) -> Any:
    """A number of a result by its path, as a Quantity for each case; NaN where the result is not
    there.
    """
    owner, last, value, unit = _found(result, name)
    if unit is None or isinstance(value, tuple):
        names = result.to_columns() if isinstance(result, Impact) else result.__dataclass_fields__
        names = [one for one in names if _found(result, one)[3] is not None]
        raise CaseError(
            (place, f"{rendered(name)} is no number of the answer; {suggestion(name, names)}")
        )
    if value is None:
        why = missing_error(owner, last) or "this case has none"
        raise CaseError((place, f"{rendered(name)} is not known: {why}"))
    values = to_quantity(np.broadcast_to(np.where(there, value, np.nan), shape), unit)
    origin = result.reconstruction if isinstance(result, Impact) else None
    if origin is None or not origin.one_sided:
        return values
    side = side_of(origin, name)
    if side is None:
        text = (
            f"{rendered(name)} is open, as the contact slid, or may have, and more slip changes "
            "it; ask for the speeds before, delta-V or energy_loss"
        )
        raise CaseError((place, text), refused=True)
    if np.any(side) and not place.startswith("propagate"):
        text = (
            f"{rendered(name)} is known from one side only, as the contact slid, or may have: that "
            "is no value to compare; take [eccentric] with the speeds among the unknowns"
        )
        raise CaseError((place, text), refused=True)
    return OneSided(values, np.broadcast_to(np.where(there, side, 0), shape))


def _default_outputs(result: Any) -> tuple[str, ...]:
    """The outputs where the file names none: what was sought of a reverse solver, and what people
    ask of an impact.
    """
    if isinstance(result, Run):
        return usual_outputs(result)
    if isinstance(result, MomentumSolution):
        return (*result.found, "delta_v_a", "delta_v_b")
    speeds = ("a.before.speed", "b.before.speed") if result.found else ()
    return (*speeds, "a.delta_v", "b.delta_v", "energy_loss")
