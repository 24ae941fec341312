"""Where an impact comes from: the reverse solver that found it and how firmly, or how its model was chosen."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from .fields import Shown, lock, same, same_fields, show
from .kernels import codes
from .kernels.select import select
from .units import Value, to_quantity

# From the least to the full one.
MODELS = ("linear_central", "oblique_central", "eccentric")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reconstruction:
    """How a reverse solver found an impact.

    Parameters
    ----------
    method : str
        Function of ``collisions.reconstruct``.
    known : tuple of str
        What it was given beside masses and geometry.
    condition : float or array [1]
        How well-posed the question was: by how much relative errors of what was given may be larger in the speeds before the
        impact, taken relative to the closing speed. 10 means that one percent may become ten. It leaves out what is not known
        of friction, restitution, normal and courses. For ``planar`` it is the factor that restitution brings in, (1 + e)/e
        where e was given, or the jump between both ways to slide over the slip where that is larger.
    answers : int or array of int
        How many impacts fit what was given, of which this is one; infinite at the end of a range of them. Of a refused case
        the number that fit if they are several, else 0.
    contact_velocity : tuple of float or array [m/s], optional
        Closing speed and slip before, as found. The motions before are rounded to their own size, and their small differences
        would hold fewer digits.
    """

    method: str
    known: tuple[str, ...]
    condition: Value
    answers: Any = 1
    contact_velocity: tuple[Value, Value] | None = None

    def __eq__(self, other: object) -> bool:
        return same_fields(self, other) if isinstance(other, Reconstruction) else NotImplemented

    def _where_answered(self, status: Any) -> Reconstruction:
        """The same without what does not belong to a refused case: how well-posed it was, and how many fit but several."""
        refused = status > codes.ENERGY_GAIN
        if not np.any(refused):
            return self
        several = np.isin(status, (codes.AMBIGUOUS, codes.AMBIGUOUS_INVERSE))
        condition, answers = select(refused, math.nan, self.condition), select(refused > several, 0, self.answers)
        velocity = self.contact_velocity and lock(tuple(select(refused, math.nan, part) for part in self.contact_velocity))
        return replace(self, condition=lock(condition), answers=lock(answers), contact_velocity=velocity)

    @property
    def _fitting(self) -> str:
        """How many impacts fit, as a sentence says it."""
        return "a whole range of impacts" if self.answers == math.inf else f"{self.answers} impacts"


class ByModel(Mapping[str, Any]):
    """What is known of each model, by its name: like a dict that cannot be changed. ``.q`` has the numbers as Quantities."""

    __slots__ = ("_unit", "_values")

    def __init__(self, values: Mapping[str, Any], unit: str | None = None) -> None:
        self._values = lock(dict(values))
        self._unit = unit

    @property
    def q(self) -> Any:
        """The same with units."""
        return self if self._unit is None else {name: to_quantity(value, self._unit) for name, value in self.items()}

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mapping):
            return NotImplemented
        return same(dict(self), dict(other))

    def __reduce__(self) -> tuple[Any, ...]:
        return ByModel, (self._values, self._unit)

    def __repr__(self) -> str:
        return repr(self._values)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class ModelChoice(Shown):
    """Which model a scene requires, and why.

    Attributes
    ----------
    model : str or array of str
        "linear_central", "oblique_central" or "eccentric"; the last also where the case is refused.
    reason : str
        Why, in a sentence.
    errors : mapping of float or array [m/s]
        By cheaper model, what it is predicted to err by: hypot of the delta-V vector and of radius of gyration times yaw rate,
        for the worse of both vehicles. NaN where it cannot be told or the case is refused, infinite where only that model has
        no answer.
    missing : mapping of tuple of str
        By model, what it still needs, such as "a.yaw_inertia" or "point".
    tolerance : float or array [m/s]
        What was accepted.
    """

    _title = "Model required"

    reason: str
    errors: Mapping[str, Value]
    missing: Mapping[str, tuple[str, ...]]
    tolerance: Value = field(metadata={"unit": "m/s"})
    # Which of MODELS, by number.
    _which: Any

    def _where_answered(self, refused: Any) -> ModelChoice:
        """The same without the errors of cases that turned out to have no answer."""
        if not np.any(refused):
            return self
        return replace(self, errors={name: select(refused, math.nan, error) for name, error in self.errors.items()})

    def __post_init__(self) -> None:
        object.__setattr__(self, "errors", ByModel(self.errors, "m/s"))
        object.__setattr__(self, "missing", ByModel(self.missing))
        lock(self._which)

    @property
    def model(self) -> Any:
        """The name, or the names of a batch, which take fifty times the room of the numbers that are kept."""
        return lock(np.array(MODELS).take(self._which)) if isinstance(self._which, np.ndarray) else MODELS[self._which]

    def _rows(self, prefix: str = "") -> Iterator[tuple[str, str]]:
        yield prefix + "model", show(self.model)
        yield prefix + "reason", self.reason
        for name, error in self.errors.items():
            yield f"{prefix}errors.{name}", show(error, "m/s")
        for name, needed in self.missing.items():
            if needed:
                yield f"{prefix}missing.{name}", ", ".join(needed)
        yield prefix + "tolerance", show(self.tolerance, "m/s")


class Again(NamedTuple):
    """A choice that an answer was made by, given to ``solve`` in place of a tolerance when that answer is asked again."""

    choice: ModelChoice
