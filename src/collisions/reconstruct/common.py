"""What every reverse solver ends with: the forward solver's answer to what it found, or the reason why there is none."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..errors import CollisionsError, InputError, Status
from ..impact import Impact, found_by
from ..inputs import Inputs
from ..kernels.batch import precision
from ..kernels.contact_laws import RULES
from ..kernels.eccentric import eccentric
from ..kernels.elementwise import FINITE, POSITIVE, RESTITUTION
from ..provenance import Reconstruction
from ..quantities import lock
from ..reading import broadcast
from ..solving import check_options, first_refused, warn_of_refusals
from ..vehicle import Vehicle

# How the names of numbers begin that cannot be below 0.
_AMOUNTS = ("energy", "closing_speed", "speed_", "delta_v_", "ees_")


def parted(body: Vehicle, motion: Sequence[str]) -> tuple[dict[str, str], dict[str, str]]:
    """The texts that a vehicle was given as: of what stays, and of these parts of its motion, which will be others."""
    texts = body._given or {}
    kept = {name: text for name, text in texts.items() if name not in motion}
    return kept, {name: text for name, text in texts.items() if name in motion}


def exactly(known: dict[str, Any], count: int, what: str) -> dict[str, Any]:
    """The values that were given, if they are as many as the question needs."""
    given = {name: value for name, value in known.items() if value is not None}
    if len(given) == count:
        return given
    missing = [name for name in known if name not in given]
    named, missed = ", ".join(known), ", ".join(missing)
    if "ees_a" in known:
        named, missed = (text.replace("ees_a", "ees_a with ees_b") for text in (named, missed))
    advice = f"leave out {len(given) - count}" if len(given) > count else f"give {count - len(given)} of {missed}"
    raise InputError(
        f"{what} takes exactly {count} of {named}; got {len(given)} ({', '.join(given) or 'none'}): {advice}",
        code="too_many_knowns" if len(given) > count else "too_few_knowns",
        argument=", ".join(given),
        given=tuple(given),
    )


# The forward kernel, called with the numbers of two bodies in this order.
forward: Callable[..., Any] = eccentric
NUMBERS = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y", "pivot_x", "pivot_y")

# For functions that answer with plain numbers, which have no status.
ASK_ALONE = "asked alone, each says why"


class Cases(NamedTuple):
    """What the answers to one question are: a single case, or a batch of a shape and a precision."""

    shape: tuple[int, ...] | None
    dtype: Any

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Cases:
        """As many cases as the arrays among the values go together to."""
        return cls(broadcast(values), precision(values.values()))

    def values(self, found: Any) -> Any:
        """A plain float for a single case, a locked array of its own for a batch."""
        if self.shape is None:
            return float(found)
        # Of what is too large for float32 the forward solver says so.
        with np.errstate(over="ignore"):
            return lock(np.array(np.broadcast_to(found, self.shape), dtype=self.dtype))

    def alike(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """The values by name, their arrays in the precision of the batch."""
        return {name: value.astype(self.dtype) if isinstance(value, np.ndarray) else value for name, value in values.items()}

    def beyond(self, found: Any) -> Any:
        """Where an answer is not finite, or would not be in the precision of the batch."""
        with np.errstate(over="ignore"):
            return ~np.isfinite(np.asarray(found).astype(self.dtype))

    def whole(self, found: Any) -> Any:
        """The same of what is counted."""
        return int(found) if self.shape is None else lock(np.array(np.broadcast_to(found, self.shape), dtype=np.int64))

    def first_status(self, findings: Sequence[tuple[Any, int]]) -> Any:
        """Code of the first finding that holds, 0 without one: an int, or an array for a batch."""
        status = np.zeros(self.shape or (), dtype=np.uint8)
        for condition, code in reversed(findings):
            status = np.where(condition, np.uint8(code), status)
        return int(status) if self.shape is None else status

    def one(self, found: Any, index: tuple[int, ...]) -> float:
        """The value of the case at an index."""
        return float(np.broadcast_to(found, self.shape or ())[index])


def input_faults(numbers: Mapping[str, Any]) -> list[tuple[Any, int]]:
    """What is wrong with values that the reader does not look into: those of arrays."""
    found: list[tuple[Any, int]] = []
    with np.errstate(invalid="ignore"):
        for name, value in numbers.items():
            kind = name.rpartition(".")[2]
            domain = (
                POSITIVE
                if kind.startswith(("mass", "yaw_inertia"))
                else RESTITUTION
                if kind == "restitution"
                else RULES[kind].domain
                if kind in RULES
                else FINITE
            )
            found += [(fault(value), status) for fault, status in domain.faults]
            if kind.startswith(_AMOUNTS):
                found.append((value < 0.0, Status.CONTRADICTORY))
    return found


def settle(
    asked: Callable[[Any], Inputs],
    status: Any,
    origin: Reconstruction,
    on_failure: Any,
    error: Callable[[tuple[int, ...]], CollisionsError],
) -> Impact:
    """The forward solver's impact from the state that was found; ``error`` gives the refusal of the case at an index.

    ``asked`` puts the question of the cases that it is told to keep; what was looked for is NaN in the others.
    """
    check_options(on_failure)
    single = not isinstance(status, np.ndarray)
    if single and status != Status.OK and on_failure != "nan":
        raise error(())
    found = answered(asked, status, origin, on_failure if single else "nan")
    if not single:
        raise_or_warn(found._raw.status, on_failure, error)
    return found


def answered(asked: Callable[[Any], Inputs], status: Any, origin: Reconstruction, on_failure: Any) -> Impact:
    """The forward solver's impact from the state that was found, without what was found where it refuses that state."""
    sure = np.equal(status, Status.OK)
    impact = Impact._solved(asked(sure)._changed(contact_velocity=origin.contact_velocity), on_failure=on_failure)
    question = impact.inputs
    if np.any(sure & impact.refused):
        question = asked(sure & np.logical_not(impact.refused))
    return found_by(origin, question, impact._raw, status)


def raise_or_warn(
    status: Any, on_failure: Any, error: Callable[[tuple[int, ...]], CollisionsError], advice: str | None = None
) -> None:
    """What a batch does about its refused cases."""
    if on_failure != "nan" and np.any(status > Status.ENERGY_GAIN):
        if on_failure == "raise":
            index, place = first_refused(status)
            problem = error(index)
            raise type(problem)(place + str(problem), code=problem.code, **problem.fields)
        warn_of_refusals(status, *([] if advice is None else [advice]))
