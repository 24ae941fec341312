"""A scene as a function of some of its numbers, as ``propagate``, ``fit`` and ``posterior`` take
it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np

from ..messages.errors import CollisionsError, CollisionsWarning, InputError
from ..messages.warning import ONE_ORDER, quietly, state_of_study, warn_of_cases
from ..quantities.units import shown, to_quantity
from .marks import answers, of_mark
from .names import changed_by, inputs_of, no_path, replaced, units_of
from .results import (
    END,
    REST,
    absent,
    asked_of,
    between,
    by_contact,
    curves_of,
    numbered,
    result_of,
    told,
    unit_of_result,
    usual_order,
    warn_of_another,
)
from .run import Run, warn_of_findings
from .scene import Scene

# Numbers of a vehicle before an impact that say how fast it is and where it goes.
_MOTION = ("speed", "course", "vx", "vy")


class Order:
    """The contacts that impacts are of by their number, and what is to be said of it in a study."""

    def __init__(self, rules: Sequence[int], statements: Sequence[str] = ()) -> None:
        self.rules, self.statements = tuple(rules), tuple(statements)


def as_function(
    scene: Scene,
    names: Iterable[str],
    outputs: Iterable[str],
    tolerance: float,
    at_level: Callable[[Scene], Scene] | None = None,
    argument: str = "outputs",
    order: Order | None = None,
) -> Callable[..., dict[str, Any]]:
    """A function of some numbers of a scene, by their paths, that returns some of its results as
    Quantities; ``at_level`` makes the scene that is run of the one with these numbers.

    Impacts by their number are those of the scene as it is given here, or of an ``order``.
    """
    given = _paths_in(names, "names"), _paths_in(outputs, "outputs")
    wanted = given[1]
    for name in given[0]:
        if not isinstance(name, str):
            raise no_path(name, inputs_of(scene), "names")
    taken = units_of(scene, given[0])
    units = {path: unit_of_result(scene, path, argument) for path in wanted}
    marks = {path: asked for path in wanted if (asked := of_mark(scene, path, argument))}
    recorded = {
        path: one
        for path in wanted
        if (one := asked_of(scene, path, argument, warns=True)) and one.sample is not None
    }
    numbers = numbered(scene, wanted)
    if order is None:
        order = order_of(scene, given[0], numbers, tolerance, argument)
    standing = _standing(scene, given[0], wanted)
    # These are followed to their rest all at once.
    times = [one for path in wanted for one in between(scene, path) or (path,)]
    ends = [found[1] for path in wanted if (found := REST.fullmatch(path))]
    resting = list(scene.movers) if END in times else list(dict.fromkeys(ends))

    def model(**values: Any) -> dict[str, Any]:
        for name in standing:
            state_of_study(
                f"{name} stands at the start: no speed above 0 was given for it, and its speed is "
                "not among the unknowns",
                "stands",
            )
        for statement in order.statements:
            state_of_study(statement, ONE_ORDER)
        made = replaced(scene, values)
        made = made if at_level is None else at_level(made)
        # What vehicles touch after the last impact matters to where they come to rest.
        run = Run(made, tolerance, to_rest=bool(resting or marks))
        warn_of_findings(run)
        run._followed.to_rest(resting)
        if not run._followed.single:
            _warn_of_absent(run, numbers)
            warn_of_another(run, numbers, order.rules, "in the scene as written")
        # All points of a mark at once: the mark is worked out for them, and not kept.
        found = dict(zip(marks, answers(run, list(marks.values())), strict=True))
        # All samples of a recorder at once too.
        found |= curves_of(run, recorded, order.rules)
        found |= {path: result_of(run, path, order.rules) for path in wanted if path not in found}
        return {path: to_quantity(found[path], unit) for path, unit in units.items()}

    vars(model)["answers_by_case"] = True
    vars(model)["units_of_inputs"] = taken
    return model


def order_of(
    scene: Scene,
    changed: Iterable[str],
    numbers: Mapping[int, str],
    tolerance: float,
    argument: str = "outputs",
) -> Order:
    """The contacts that impacts of these numbers are of: what they must be, what ``order`` says, or
    as they come in the scene as it is written.
    """
    most = max(numbers, default=-1) + 1
    certain = dict(_certain(scene, changed, most))
    if numbers.keys() <= certain.keys() or not scene.contacts:
        return Order([certain.get(k, -1) for k in range(most)])
    if scene.order is not None:
        stated = [_rules_of(scene, pair) for pair in scene.order]
        if all(len(rules) == 1 for rules in stated):
            return Order([rules[0] for rules in stated])
    try:
        with quietly():
            rules = usual_order(Run(scene, tolerance))
        reason = f"it has {len(rules)} impact{'' if len(rules) == 1 else 's'}"
    except CollisionsError as error:
        rules, reason = (), f"it has no answer ({error.inner.rstrip('.')})"
    if most > len(rules):
        number = next(k for k in sorted(numbers) if k >= len(rules))
        meant = [
            f"'{path}'"
            for rule in range(len(scene.contacts))
            if asked_of(scene, path := by_contact(scene, numbers[number], rule))
        ]
        raise InputError(
            f"{argument} has {numbers[number]!r}, and of the scene as written it cannot be said "
            f"which contact that is: {reason}. Write {' or '.join(meant)}, the first impact of a "
            "contact whenever it comes",
            code="several_orders",
            argument=argument,
        )
    said = [
        f"{told(scene, k, rules)}; a case in which another comes in its place has no answer to it, "
        f"and counts as impossible where it is evidence; 'contacts[{rules[k]}].impact...' is the "
        f"first of these two in every case{', which is not this one' * (rules[k] in rules[:k])}"
        for k in sorted(numbers)
    ]
    return Order(rules, said)


def _certain(scene: Scene, changed: Iterable[str], most: int) -> Iterator[tuple[int, int]]:
    """The contacts that impacts of some numbers must be of, in whatever case."""
    moved = {one for path in changed for one in changed_by(scene, path)}
    at_start = [
        i
        for i, contact in enumerate(scene.contacts)
        if not contact.touches and np.all(np.equal(contact.at, 0.0))
        and f"contacts[{i}].at" not in moved
    ]  # fmt: skip
    others = [i for i in range(len(scene.contacts)) if i not in at_start]
    if len(at_start) > 1:
        return
    for k in range(most):
        if at_start and not k:
            yield k, at_start[0]
        elif len(others) == 1:
            yield k, others[0]
        elif at_start and not others:
            yield k, at_start[0]


def _rules_of(scene: Scene, pair: Collection[str]) -> list[int]:
    return [i for i, one in enumerate(scene.contacts) if {one.a, one.b} == {*pair}]


def _warn_of_absent(run: Run, numbers: Iterable[int]) -> None:
    """Say in how many cases of a study an impact of a number does not come."""
    answered = run._followed.told.failed == ""
    for number in numbers:
        missing = absent(run, number) & answered
        if many := int(np.count_nonzero(missing)):
            said = f"without an answer, as impacts[{number}] does not come"
            warning = CollisionsWarning(
                f"{many} of {run._followed.count} cases are {said}",
                code="refused_cases",
                counts={"no_such_impact": many},
            )
            # One that only some cases have is no mistake.
            warn_of_cases(warning, {said: missing}, least=1.0)


def _standing(scene: Scene, changed: Iterable[str], wanted: Iterable[str]) -> list[str]:
    """The vehicles whose speed or course before an impact is asked for, and which stand at the
    start in every case, though they could move.
    """
    paths = {one for path in changed for one in changed_by(scene, path)}
    asked = {name for path in wanted for name in _moving_before(scene, path)}
    return [
        name
        for name, mover in scene.movers.items()
        if name in asked
        and not mover.fixed
        and all(
            np.all(np.equal(getattr(mover.vehicle, part), 0.0)) and f"{name}.{part}" not in paths
            for part in ("vx", "vy", "yaw_rate")
        )
        and f"{name}.speed" not in paths
    ]


def _moving_before(scene: Scene, path: str) -> Iterator[str]:
    """The vehicles whose speed or course before an impact a path may ask for."""
    asked = asked_of(scene, path)
    label, _, rest = ("" if asked is None else asked.name).partition(".")
    moment, _, part = rest.partition(".")
    if asked is None or moment != "before" or part not in _MOTION:
        return
    for i, contact in enumerate(scene.contacts):
        if not asked.contact or i == asked.number:
            yield getattr(contact, label)


def _paths_in(given: Any, argument: str) -> tuple[Any, ...]:
    """What a collection of paths holds; refused is one text and what is none.

    A Quantity of one number has the method of a collection, and an object may raise anything in it.
    """
    if not isinstance(given, str) and isinstance(given, Iterable):
        with suppress(Exception):
            return tuple(given)
    raise InputError(
        f"{argument} must be a list of paths, such as ['Camry.vx'], got {shown(given)}",
        code="bad_shape",
        argument=argument,
    )
