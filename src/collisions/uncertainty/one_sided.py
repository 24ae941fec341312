"""``OneSided``: an output of a model that is known from one side only in some of its cases."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..messages.errors import ShapeError
from ..quantities.reading import ArgumentReader
from ..quantities.refusals import must_be
from ..quantities.units import is_quantity, si_unit


@dataclass(frozen=True, slots=True, eq=False)
class OneSided:
    """An output of a model for ``propagate`` that is known from one side only in some cases.

    A case whose side is +1 says "at least this value", and -1 "at most": the truth may lie anywhere
    beyond. ``propagate`` keeps these cases and takes them as unbounded on that side. Where their
    share decides an end of a range, that end is infinite. Mean, standard deviation and shares of
    the variance do not exist then and are NaN, or empty.

    Parameters
    ----------
    values : float, Quantity or array [SI]
        The values or bounds, one for each case, as a model returns an output: SI where a Quantity.
    sides : int or array of int [-]
        For each case +1 (at least), -1 (at most) or 0 (known both ways), such as
        ``impact.reconstruction.one_sided["speed_b"]``.

    Raises
    ------
    InputError
        A side that is none of these.
    ShapeError
        Values and sides of different shapes.

    Examples
    --------
    A delta-V, of which a third of the records stopped early:

    >>> import numpy as np
    >>> from collisions.uncertainty import OneSided, Uniform, propagate
    >>> def recorded(delta_v):
    ...     return {"delta_v": OneSided(delta_v, np.where(delta_v > 8.0, 1, 0))}
    >>> found = propagate(recorded, {"delta_v": Uniform(6.0, 9.0)}, samples=1024, seed=1)["delta_v"]
    >>> print(found.row()[1])
    at least 6.08063, 97.5 percent
    """

    values: Any
    sides: Any = 0

    def __post_init__(self) -> None:
        of_sides = ArgumentReader(trusted=("sides",))
        sides = np.asarray(of_sides.number(self.sides, "", "sides"))
        if of_sides.problems or not np.isin(sides, (-1, 0, 1)).all():
            raise must_be(
                "sides",
                "1 (at least the value), -1 (at most) or 0 (known both ways), or an array of these",
                self.sides,
                code="bad_option",
            )
        unit = (si_unit(self.values, per_angle=True) or "") if is_quantity(self.values) else ""
        reader = ArgumentReader(trusted=("values",))
        values = reader.number(self.values, unit, "values")
        reader.close()
        if sides.ndim and np.shape(values) != sides.shape:
            raise ShapeError(
                f"values has shape {np.shape(values)} and sides {sides.shape}; give a side for "
                "each value, or one for all",
                code="bad_shape",
                argument="sides",
            )


class Answers(dict[str, Any]):
    """The outputs of some cases by name, and for those known from one side the sides by name."""

    def __init__(self, outputs: dict[str, Any], sides: dict[str, Any]) -> None:
        super().__init__(outputs)
        self.sides = sides


def joined(parts: list[Answers]) -> Answers:
    """The answers of blocks of cases, one after another."""
    one_sided = dict.fromkeys(name for part in parts for name in part.sides)
    return Answers(
        {name: np.concatenate([part[name] for part in parts]) for name in parts[0]},
        {
            name: np.concatenate(
                [part.sides.get(name, np.zeros(len(part[name]), dtype=np.int8)) for part in parts]
            )
            for name in one_sided
        },
    )
