"""Shared by the reverse solvers: known values, single cases and batches (``Cases``), and the
forward run at the end.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..impact.impact import Impact, answer_of, found_by, solved
from ..impact.inputs import Inputs, body_numbers, first_case
from ..impact.reconstruction import Reconstruction, found_from, origin_where_answered
from ..impact.run import check_options, error_of, state_refusals, warn_of_refusals
from ..kernels.contact_laws import RULES
from ..kernels.eccentric import eccentric
from ..kernels.elementwise import FINITE, POSITIVE, restitution_domain
from ..kernels.problem import Body, Contact, Problem
from ..kernels.status import Answer
from ..messages.errors import (
    CollisionsError,
    IllConditionedWarning,
    InputError,
    MissingInputError,
    Status,
    placed,
)
from ..messages.warning import quietly, state_of_study, warn_of_cases
from ..quantities.attributes import read_only
from ..quantities.precision import precision
from ..quantities.reading import ArgumentReader, amount, broadcast
from ..quantities.settings import in_si
from ..quantities.units import Texts
from ..vehicle.drag import GRAVITY, read_drag, read_duration
from ..vehicle.tyres import lacking
from ..vehicle.vehicle import Vehicle

# The numbers of a body, in the order in which ``forward`` takes them.
NUMBERS = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y", "pivot_x", "pivot_y")
# Prefixes of the names of numbers that cannot be below 0.
_AMOUNTS = ("energy", "closing_speed", "speed_", "delta_v_a", "delta_v_b", "ees_", "max_crush")
DRAGS = ("drag_a", "drag_b")
# Known values of both vehicles that count as one.
PAIRS = {"ees_a": "ees_b", "max_crush_speed_a": "max_crush_speed_b"}
# Above it the digits that no measurement has decide the answer.
_ILL_CONDITIONED = 1e6
# For functions whose result has no status.
ASK_ALONE = "asked alone, each says why"


def body_of(numbers: Iterable[Any], pinned: bool) -> Body:
    """A body as the kernels take it, from its ``NUMBERS``."""
    *motion, pivot_x, pivot_y = numbers
    return Body._make((*motion, (pivot_x, pivot_y) if pinned else None))


def forward(
    contact: Contact,
    bodies: Iterable[Iterable[Any]],
    rule: str,
    law: str,
    pinned: Iterable[bool] = (False, False),
    contact_velocity: tuple[Any, Any] | None = None,
    outside: Any = None,
) -> Answer:
    """What the eccentric kernel answers for two bodies, each as its ``NUMBERS``."""
    a, b = (body_of(numbers, turns) for numbers, turns in zip(bodies, pinned, strict=True))
    problem = Problem(contact, a, b, outside=outside, contact_velocity=contact_velocity)
    return eccentric(problem, rule, law)


def counted(given: Iterable[str]) -> tuple[str, ...]:
    """The names of known values without the second of each pair that counts as one."""
    return tuple(name for name in given if name not in PAIRS.values())


def exactly(known: dict[str, Any], count: int, what: str) -> dict[str, Any]:
    """The known values that were given; refused unless there are exactly as many as needed. A pair
    counts as one.
    """
    given = {name: value for name, value in known.items() if value is not None}
    for one, other in PAIRS.items():
        if (one in given) != (other in given):
            raise InputError(
                f"give both {one} and {other}, or neither; that of an infinite mass is 0",
                code="one_ees",
                argument=one,
            )
    names = counted(given)
    if len(names) == count:
        return given
    words = {
        name: f"{name} with {PAIRS[name]}" if name in PAIRS else name for name in counted(known)
    }
    missing = ", ".join(word for name, word in words.items() if name not in given)
    more = len(names) > count
    advice = (
        f"leave out {len(names) - count}" if more else f"give {count - len(names)} of {missing}"
    )
    raise InputError(
        f"{what} takes exactly {count} of {', '.join(words.values())}; got {len(names)} "
        f"({', '.join(names) or 'none'}): {advice}",
        code="too_many_knowns" if more else "too_few_knowns",
        argument=", ".join(names),
        given=names,
    )


def read_masses(reader: ArgumentReader, mass_a: Any, mass_b: Any) -> dict[str, Any]:
    """Both masses by name."""
    return {
        name: reader.number(mass, "kg", name, POSITIVE)
        for name, mass in (("mass_a", mass_a), ("mass_b", mass_b))
    }


def read_amounts(reader: ArgumentReader, given: Mapping[str, Any]) -> dict[str, Any]:
    """Known energies and speeds by name."""
    return {
        name: amount(reader, value, "J" if name == "energy_loss" else "m/s", name)
        for name, value in given.items()
    }


def read_drags(reader: ArgumentReader, duration: Any, drags: dict[str, Any]) -> dict[str, Any]:
    """Duration and the drags that were given: some of them with a duration, or none."""
    given = {name: drag for name, drag in drags.items() if drag is not None}
    if (duration is None) == bool(given):
        lacking = "duration" if duration is None else "drag_a"
        text = (
            (
                f"{' and '.join(given)} need a duration, over which tyres act; write "
                "`duration='100 ms'`"
            )
            if given
            else (
                "duration counts for drag_a and drag_b alone, and neither was given; write "
                "`drag_b=0.7`, or leave it out"
            )
        )
        reader.refuse(MissingInputError(text, code="bad_combination", argument=lacking))
    if duration is None or not given:
        return {}
    found = {"duration": read_duration(reader, duration, "leave it and the drags out instead")}
    return found | {name: read_drag(reader, drag, name) for name, drag in given.items()}


def drag_faults(numbers: Mapping[str, Any]) -> list[tuple[Any, int]]:
    """The faults of arrays of duration and drags."""
    if "duration" not in numbers:
        return []
    below = [
        (np.less(numbers[name], 0.0), Status.NEGATIVE_SIZE) for name in DRAGS if name in numbers
    ]
    return [(np.less_equal(numbers["duration"], 0.0), Status.NOT_POSITIVE), *below]


def slowed_by(numbers: Mapping[str, Any]) -> dict[str, Any]:
    """What tyres slow each vehicle by while an in-line contact lasts: one of infinite mass, or
    without a drag, by nothing.
    """
    time = numbers.get("duration", 0.0)
    return {
        label: np.where(
            np.isinf(numbers[f"mass_{label}"]),
            0.0,
            GRAVITY * time * numbers.get(f"drag_{label}", 0.0),
        )
        for label in "ab"
    }


def split_texts(body: Vehicle, motion: Sequence[str]) -> tuple[dict[str, str], dict[str, str]]:
    """A vehicle's texts in two parts: of the fields that stay, and of those in ``motion``, which
    the result replaces.
    """
    texts = Texts(body.given)
    staying = {name: text for name, text in texts.items() if name not in motion}
    return staying, {name: text for name, text in texts.items() if name in motion}


def numbers_by_name(inputs: Inputs, state: str = "", without: Sequence[str] = ()) -> dict[str, Any]:
    """The numbers of a contact and of both vehicles by their names in messages; ``state`` is
    appended, as in a_after.
    """
    found = {
        inputs.rule: inputs.rule_value,
        "normal[0]": inputs.normal[0],
        "normal[1]": inputs.normal[1],
    }
    found |= {f"point[{i}]": part for i, part in enumerate(inputs.point or ())}
    bodies = ((f"a{state}", inputs.a), (f"b{state}", inputs.b))
    for label, body in bodies:
        numbers = zip(NUMBERS, body_numbers(body, inputs.point), strict=True)
        found |= {f"{label}.{name}": value for name, value in numbers if name not in without}
    return found | {
        f"{label}.heading": body.heading for label, body in bodies if body.heading is not None
    }


class Cases(NamedTuple):
    """The shape and precision of a problem: a single case or a batch."""

    shape: tuple[int, ...] | None
    dtype: Any

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Cases:
        """The cases that the arrays among the values broadcast to."""
        return cls(broadcast(values), precision(values.values()))

    @property
    def eps(self) -> float:
        """The rounding of the precision."""
        return float(np.finfo(np.float64 if self.shape is None else self.dtype).eps)

    def values(self, found: Any) -> Any:
        """A float for a single case, a locked copy of the array for a batch."""
        if self.shape is None:
            return float(found)
        # The forward solver reports values too large for float32.
        with np.errstate(over="ignore"):
            return read_only(np.array(np.broadcast_to(found, self.shape), dtype=self.dtype))

    def where(self, keep: Any, found: Any) -> Any:
        """The values, NaN in the cases where the condition does not hold."""
        if self.shape is None:
            return float(found) if keep else math.nan
        return self.values(np.where(keep, found, np.nan))

    def beyond(self, found: Any) -> Any:
        """Whether a result is not finite, or would overflow in the precision of the batch."""
        with np.errstate(over="ignore"):
            return ~np.isfinite(np.asarray(found).astype(self.dtype))

    def counts(self, found: Any) -> Any:
        """An int, or infinity, for a single case, a locked array of ints for a batch."""
        if self.shape is None:
            return found if found == math.inf else int(found)
        return read_only(np.array(np.broadcast_to(found, self.shape), dtype=np.int64))

    def first_status(self, findings: Sequence[tuple[Any, int]]) -> Any:
        """Code of the first finding that holds, 0 without one: an int, or an array for a batch."""
        status = np.zeros(self.shape or (), dtype=np.uint8)
        for condition, code in reversed(findings):
            status = np.where(condition, np.uint8(code), status)
        return int(status) if self.shape is None else status

    def sides(self, found: Any) -> Any:
        """A side for a single case, 1, -1 or 0, a locked array of them for a batch."""
        with np.errstate(invalid="ignore"):
            return self.counts(np.nan_to_num(found).astype(np.int64))

    def how_many(self, where: Any) -> str:
        """The number of these cases, to begin a message; "" for a single case."""
        if self.shape is None:
            return ""
        return (
            f"{int(np.count_nonzero(np.broadcast_to(where, self.shape)))} of "
            f"{math.prod(self.shape)} cases: "
        )

    def each(self, where: Any) -> Any:
        """Whether it holds, for each case of a batch; None for a single case."""
        return None if self.shape is None else np.broadcast_to(where, self.shape)

    def reconstruction(
        self,
        method: str,
        known: Sequence[str],
        condition: Any,
        answers: Any,
        velocity: Sequence[Any] = (),
        where: Any = True,
        *,
        given: Mapping[str, Any],
        also: Sequence[str] = (),
    ) -> Reconstruction:
        """The ``Reconstruction`` with closing speed and slip if they are known; numbers are NaN
        where ``where`` is False. ``given`` has the numbers of what was known, and ``also`` what was
        found beside what the solver always finds.
        """
        condition, *found = (self.where(where, value) for value in (condition, *velocity))
        return Reconstruction(
            method=method,
            known=tuple(known),
            condition=condition,
            answers=self.counts(answers),
            contact_velocity=(found[0], found[1]) if found else None,
            found=(*found_from(method, known), *also),
            given={name: _kept(number) for name, number in given.items()},
        )

    def one(self, found: Any, index: tuple[int, ...]) -> float:
        """The value of the case at an index."""
        return float(np.broadcast_to(found, self.shape or ())[index])


def _kept(number: Any) -> Any:
    """A number as an answer keeps it: a float, or a locked array."""
    return read_only(number) if np.ndim(number) else float(number)


def input_faults(numbers: Mapping[str, Any], incomplete: bool = False) -> list[tuple[Any, int]]:
    """The faults of arrays, whose elements the reader does not check; and of NaN from a case that
    was refused.
    """
    found: list[tuple[Any, int]] = []
    with np.errstate(invalid="ignore"):
        for name, value in numbers.items():
            if isinstance(value, float) or not np.ndim(value):
                found += [(True, Status.NOT_FINITE)] if value != value else []
                continue
            found += [
                (fault(value), status)
                for fault, status in _domain(name.rpartition(".")[2], incomplete).faults
            ]
            if name.startswith(_AMOUNTS):
                found.append((value < 0.0, Status.CONTRADICTORY))
    return found


def _domain(name: str, incomplete: bool) -> Any:
    if name.startswith(("mass", "yaw_inertia")):
        return POSITIVE
    if name in RULES:
        return RULES[name].domain
    return restitution_domain(incomplete) if name == "restitution" else FINITE


def finish(
    inputs_of: Callable[[Any], Inputs],
    status: Any,
    origin: Reconstruction,
    on_failure: Any,
    refusal: Callable[[], CollisionsError],
    solve_case: Callable[[tuple[int, ...]], Any],
) -> Impact:
    """The impact from the reconstructed state; cases without one are handled as ``on_failure``
    says.

    ``inputs_of(found)`` gives the inputs, with NaN for the reconstructed values except in the
    ``found`` cases. ``refusal`` makes the error of a single case, ``solve_case`` solves the case of
    a batch at an index alone.
    """
    check_options(on_failure)
    if not isinstance(status, np.ndarray):
        raise_or_warn(status, on_failure, lambda index: refusal())
        found = run_forward(inputs_of, status, origin, on_failure)
        if status == Status.OK:
            raise_or_warn(found.status, on_failure, lambda index: refusal())
        return found
    found = run_forward(inputs_of, status, origin, "nan")

    def refusal_at(index: tuple[int, ...]) -> CollisionsError:
        try:
            with quietly(), in_si():
                solve_case(index)
        except CollisionsError as problem:
            return problem
        # In double precision the case may have a solution.
        outcome = Status(int(np.asarray(found.status)[index]))
        return error_of(outcome, outcome.sentence)

    raise_or_warn(found.status, on_failure, refusal_at)
    return found


def warn_of_condition(
    condition: Any,
    known: str,
    moves: str = "the speeds before by more than the closing speed",
    cure: str = "give another known value in place of one of these",
) -> None:
    """Warn where what was found rests on digits of what is known that no measurement has."""
    ill = np.asarray(condition) > _ILL_CONDITIONED
    if not np.any(ill):
        return
    worst = float(np.max(np.where(ill, condition, 0.0)))
    why = f"a change of a millionth of what is known may move {moves}; {cure}"
    of = f"{np.count_nonzero(ill)} of {ill.size} cases: " if ill.ndim else ""
    text = f"{of}the condition of {known} is {worst:.3g}: {why}"
    sentence = f"the condition of {known} is above {_ILL_CONDITIONED:.0e}: {why}"
    warning = IllConditionedWarning(text, code="ill_conditioned", condition=worst)
    warn_of_cases(warning, {sentence: ill})


_OF_ONE_CASE = ". The statements of one case say how much that is"


def state_instant(
    solver: str,
    missing: str = "`duration=`, `tyres_a=` and `tyres_b=`",
    *,
    of_one_case: str = _OF_ONE_CASE,
) -> None:
    """State of a study that its impacts were found as instants, as what is ``missing`` was not
    given; ``of_one_case`` says where one case has more of it.
    """
    state_of_study(
        f"{solver} found every case as an instant, which leaves out the tyres and the "
        f"motion while the contact lasts; give {missing}{of_one_case}",
        "instant",
    )


def state_other(
    solver: str,
    held: Collection[str],
    masses: Sequence[Any],
    argument: str = "tyres",
    *,
    of_one_case: str = _OF_ONE_CASE,
) -> None:
    """State of a study with the tyres of the vehicles ``held`` that those of the other are not in
    it, as their ``argument`` was not given.
    """
    for label in lacking(held, *masses):
        state_of_study(
            f"{solver} found every case without the tyres of vehicle {label.upper()}, which leaves "
            f"out what they do while the contact lasts; give `{argument}_{label}=`{of_one_case}",
            "without_tyres",
        )


def state_motion(solver: str) -> None:
    """State of a study with tyres that its impacts leave out the motion during the contact."""
    state_of_study(
        f"{solver} found every case with the tyres, which leaves out that point and normal move on "
        "while the contact lasts. The statements of one case say how much that is",
        "motion",
    )


def run_forward(
    inputs_of: Callable[[Any], Inputs], status: Any, origin: Reconstruction, on_failure: Any = None
) -> Impact:
    """The forward impact from the reconstructed state; where it is refused, the reconstructed
    values are NaN.
    """
    found = np.equal(status, Status.OK)
    velocity = origin.contact_velocity
    with in_si():
        inputs = _with_velocity(inputs_of(found), velocity)
        impact = solved(inputs, on_failure=on_failure)
        if np.any(found & impact.refused):
            velocity = velocity and origin_where_answered(origin, impact.status).contact_velocity
            inputs = _with_velocity(inputs_of(found & np.logical_not(impact.refused)), velocity)
    if velocity and np.shape(velocity[0]) != np.shape(impact.status):
        # A number of a vehicle on which nothing depends has more cases.
        shape = np.shape(impact.status)
        velocity = read_only(tuple(np.broadcast_to(part, shape).copy() for part in velocity))
        inputs = _with_velocity(inputs, velocity)
    return found_by(origin, inputs, answer_of(impact), status)


def _with_velocity(inputs: Inputs, velocity: Any) -> Inputs:
    return inputs if velocity is None else replace(inputs, contact_velocity=velocity)


def raise_or_warn(
    status: Any, on_failure: Any, error: Callable[[tuple[int, ...]], CollisionsError]
) -> None:
    """Raise or warn about refused cases; ``error`` gives that of the case at an index, () if there
    is only one. With "nan" they are stated of a study.
    """
    if not np.any(status > Status.ENERGY_GAIN):
        return
    if on_failure == "nan":
        state_refusals(status)
        return
    if not isinstance(status, np.ndarray):
        raise error(())
    if on_failure == "raise":
        index, place = first_case(status > Status.ENERGY_GAIN)
        problem = error(index)
        raise placed(problem, place)
    warn_of_refusals(status)
