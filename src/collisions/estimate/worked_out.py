"""What follows from the samples of a posterior and was none of its unknowns, such as the speed at
the start of a skid from that at its end.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..messages.errors import CollisionsError, InputError, NoSolutionError, UnitsError
from ..messages.marked import as_code
from ..messages.warning import Note, leave_to_outer, notes_of_samples
from ..quantities.formatting import KIND_OF
from ..quantities.settings import in_si, units_required
from ..quantities.units import rendered, shown, si_unit
from ..uncertainty.distributions import Distribution, Interval
from ..uncertainty.model import Model
from ..uncertainty.output import InUnit
from ..uncertainty.sampled import Sampled
from ..uncertainty.sampling import Joint
from .fit_result import with_unit


def worked_out(
    name: str,
    function: Callable[..., Any],
    unit: str | None,
    arguments: Mapping[str, Any],
    known: Mapping[str, Sampled],
    seed: np.random.SeedSequence,
) -> tuple[Any, str | None, tuple[Note, ...]]:
    """The function at the samples of what is known, its unit, and what it warned of.

    A distribution among the arguments is drawn for each sample, apart from everything else.
    """
    if not isinstance(name, str) or not name.strip() or name in known:
        taken = "taken already" if isinstance(name, str) and name in known else "no name"
        raise InputError(
            f"name {shown(name)} is {taken}; give the result a name of its own, such as "
            "'speed before the skid'",
            code="bad_name",
            argument="name",
        )
    if unit is not None and not (isinstance(unit, str) and unit in KIND_OF):
        raise _bad_unit(unit)
    for key, one in arguments.items():
        if isinstance(one, InUnit):
            raise InputError(
                f"{as_code(key)} is in a unit of its own, by `.to()`, and the function is called "
                "with samples in SI; leave `.to()` out, as `found['speed_a']`",
                code="bad_argument",
                argument=key,
            )
    drawn = {key: one for key, one in arguments.items() if isinstance(one, Distribution)}
    sampled = {key: one for key, one in arguments.items() if isinstance(one, Sampled)}
    for key, one in arguments.items():
        if isinstance(one, Interval) or (key in sampled and known.get(one.name) is not one):
            raise InputError(
                f"{as_code(key)} is {shown(one) if isinstance(one, Interval) else 'of another'}"
                f"{'' if isinstance(one, Interval) else ' result'}; give what this posterior has, "
                "as `found['speed_a']`, a distribution such as Normal or Uniform, or a value",
                code="bad_argument",
                argument=key,
            )
    if not sampled:
        raise InputError(
            "none of the arguments is of this posterior, so nothing in it changes the result; "
            "give one of its unknowns or outputs, as `found['speed_a']`",
            code="bad_argument",
            argument="arguments",
        )
    count = len(next(iter(known.values())).values)
    values = {key: one.values for key, one in sampled.items()}
    if drawn:
        joint = Joint(drawn, None)
        random = np.random.Generator(np.random.PCG64DXSM(seed))
        values |= joint.scored(random.standard_normal((joint.dimensions, count)))
    fixed = {key: one for key, one in arguments.items() if key not in values}
    if units_required.get():
        units: dict[str, Any] = {key: one.unit for key, one in sampled.items()}
        units |= {key: one.unit for key, one in drawn.items()}
        first = {key: with_unit(float(values[key][0]), unit) for key, unit in units.items()}
        _check_units(function, fixed, first)
    model = Model(lambda **given: {name: function(**given)}, fixed)
    found = model(values, count)[name]
    own = model.units[name]
    if own and unit and own != unit:
        raise UnitsError(
            f"unit is {unit}, and the function returns {own}; leave `unit` out",
            code="bad_units",
            argument="unit",
        )
    if np.all(np.isnan(found)):
        raise _no_answer(name, function, arguments, {key: values[key] for key in sampled}, values)
    leave_to_outer(model.noted)
    return found, own or unit, notes_of_samples(model.noted)


def _check_units(
    function: Callable[..., Any], fixed: Mapping[str, Any], first: Mapping[str, Any]
) -> None:
    """Where units are required: refuse what the function refuses of the values that stand beside
    the samples. It is asked as its caller would, with the first sample in its units; the samples
    themselves are bare numbers in SI.
    """
    try:
        function(**fixed, **first)
    except UnitsError as error:
        parts = error.fields.get("problems", (error,))
        for part in parts:
            if str(part.fields.get("argument")).partition("[")[0] in fixed:
                raise part from None
    except Exception:
        # Whether it has an answer is seen at every sample.
        pass


def _bad_unit(unit: Any) -> UnitsError:
    """The error for a unit in which no function of the package answers."""
    try:
        inside = si_unit(f"1 {unit}") if isinstance(unit, str) else ""
    except UnitsError:
        inside = ""
    instead = f"'{inside}'" if inside in KIND_OF and inside else "its SI unit, such as 'm/s'"
    return UnitsError(
        f"unit is {shown(unit)}, and a function that returns plain numbers returns them in SI: "
        f"write {instead}, whatever the report is to print, which has it in the units of the page; "
        "of a function that returns Quantities, as those of `travel.q` do, leave `unit` out",
        code="bad_units",
        argument="unit",
    )


def _no_answer(
    name: str,
    function: Callable[..., Any],
    arguments: Mapping[str, Any],
    sampled: Mapping[str, Any],
    values: Mapping[str, Any],
) -> NoSolutionError:
    """The error where the function has an answer at none of the samples, with its own reason for
    the first of them.
    """
    reason, blamed = "", ""
    try:
        with in_si():
            # Four digits are enough for a message.
            case = {key: float(f"{column[0]:.4g}") for key, column in values.items()}
            function(**{**arguments, **case})
    except CollisionsError as error:
        reason, blamed = f": {error.inner}", getattr(error, "argument", None) or ""
    except Exception:
        # A function of arrays need not take floats; an error about that says nothing of the case.
        pass
    cure = "; look at what each argument is"
    if blamed in sampled and np.all(sampled[blamed] < 0.0):
        of = str(arguments[blamed].name)
        cure = (
            f". {as_code(blamed)} is {shown(of)}, which is below 0 in every sample, as the "
            "velocity along an axis is where a vehicle goes against it. Build the vehicle with "
            "`Vehicle.from_speed(speed=..., course=...)`, and take its speed, such as "
            f"'{of.rpartition('.')[0] or 'Camry'}.speed', which is never below 0"
        )
    return NoSolutionError(
        f"{shown(name)} has no answer at any of the {len(next(iter(values.values())))} samples"
        f"{reason}{cure}",
        code="refused",
    )


def stated(function: Callable[..., Any], arguments: Mapping[str, Any]) -> dict[str, str]:
    """By what a result was worked out, and from what, in words."""
    own = getattr(function, "__name__", "<lambda>")
    package, *inside = str(getattr(function, "__module__", "")).split(".")
    texts = {} if own == "<lambda>" else {"by": own}
    if texts and package == __name__.partition(".")[0] and inside:
        texts["by"] = f"{inside[0]}.{own}"
    for key, one in arguments.items():
        if isinstance(one, Sampled):
            texts[key] = one.name
        else:
            plain = isinstance(one, (str, Distribution))
            texts[key] = str(one) if plain else rendered(one)
    return texts


def in_words(texts: Mapping[str, str]) -> str:
    """What ``stated`` gave, as one text."""
    parts = [f"{name.replace('_', ' ')} = {text}" for name, text in texts.items() if name != "by"]
    lead = f"by {texts['by']}: " if "by" in texts else ""
    return lead + ", ".join(parts)
