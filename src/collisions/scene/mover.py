"""``Mover``: a vehicle of a scene, with its outline and what slows it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..messages.errors import InputError
from ..messages.hints import hinted
from ..quantities.attributes import Shown, read_only, returns, texts_given
from ..quantities.reading import ArgumentReader
from ..quantities.refusals import one_of
from ..quantities.settings import in_si
from ..quantities.tables import Cells, Part, Summary, all_numbers
from ..quantities.units import Input, Texts, Value, texts_of
from ..vehicle.drag import read_drag
from ..vehicle.outlines import read_outline
from ..vehicle.tyres import Tyres, not_tyres
from ..vehicle.vehicle import Vehicle, not_a_vehicle

# Of an outline [m]: what is smaller is no vehicle, and what is larger no place.
_LEAST, _MOST = 1e-2, 1e4
# The arguments of a mover.
NAMES = ("vehicle", "outline", "tyres", "drag")


@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Mover(Shown):
    """A vehicle of a scene: its state at the start, its outline, and what slows it on the ground.

    With ``tyres`` it moves on four wheels, as ``travel.simulate`` has it. With ``drag`` it slides
    straight on, and its yaw rate falls as its speed does; down a slope that is steeper than the
    drag it gains speed evenly, at an even yaw rate. With neither it moves on unslowed, also on a
    slope; only to ask for its place of rest is then an error. A vehicle that stands on braked
    wheels stands until it is struck. A barrier is a mover that stays.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle at the start of the scene. A pivot is refused.
    outline : tuple or list, optional [m]
        (length, width); (length, width, how far the centre of mass is ahead of the middle); or
        three or more corners (forward, left) from the centre of mass. Contacts at "touch" and those
        whose point comes from the outlines need it.
    tyres : travel.Tyres, optional
        The four wheels, until a contact gives others by ``tyres_after``.
    drag : float, str, Quantity or array [-], optional
        Deceleration over gravity on the level, in place of tyres: as a fraction or with a unit of
        acceleration. 0 is a vehicle on the ground that nothing but a slope slows or speeds up.

    Raises
    ------
    InputError
        Naming every argument that cannot be used.

    Examples
    --------
    >>> import collisions as col
    >>> from collisions.scene import Mover
    >>> car = col.Vehicle(mass="1500 kg", vx="50 km/h", x=0, y=0, heading=0)
    >>> Mover(car, outline=("4.5 m", "1.8 m"), drag=0.7).drag
    0.7
    """

    _title = "Mover"

    vehicle: Vehicle
    outline: Any = field(metadata={"unit": "m"})
    tyres: Tyres | None
    drag: Value | None = field(metadata={"unit": ""})

    @hinted
    def __init__(
        self,
        vehicle: Vehicle,
        *,
        outline: Any = None,
        tyres: Tyres | None = None,
        drag: Input | None = None,
    ) -> None:
        reader = ArgumentReader()
        if not isinstance(vehicle, Vehicle):
            reader.refuse(not_a_vehicle("vehicle", vehicle))
        elif vehicle.pivot is not None:
            text = (
                "vehicle is on a pivot, which a scene cannot hold; write "
                "vehicle.replace(pivot=None), or solve its impact by eccentric"
            )
            reader.refuse(InputError(text, code="pinned", argument="vehicle"))
        corners = None if outline is None else read_outline(reader, outline, "outline")
        if corners is not None:
            size = float(np.ptp(corners, axis=0).min()), float(np.ptp(corners, axis=0).max())
            if not _LEAST <= size[0] <= size[1] <= _MOST:
                text = (
                    f"outline is {size[1]:.3g} m long and {size[0]:.3g} m wide, and may be from "
                    f"{_LEAST:g} to {_MOST:g} m; give metres, such as `(4.5, 1.8)`"
                )
                reader.refuse(InputError(text, code="bad_outline", argument="outline"))
        if tyres is not None and not isinstance(tyres, Tyres):
            reader.refuse(not_tyres("tyres", tyres))
        read = None if drag is None else read_drag(reader, drag, "drag")
        if tyres is not None and drag is not None:
            text = "give `tyres=` or `drag=`, not both: each says what slows the vehicle"
            reader.refuse(InputError(text, code="bad_combination", argument="drag"))
        reader.close()
        for name, value in (
            ("vehicle", vehicle),
            ("outline", read_only(corners)),
            ("tyres", tyres),
            ("drag", read_only(read)),
            ("_inputs_as_texts", Texts(reader.texts)),
        ):
            object.__setattr__(self, name, value)

    def replace(self, **changes: Any) -> Mover:
        """The mover with some of the arguments changed.

        Parameters
        ----------
        **changes : see ``Mover``
            Arguments of ``Mover`` by name.

        Returns
        -------
        Mover
        """
        kept = {name: self.as_given(name) for name in NAMES}
        with in_si(but=changes):
            return Mover(**{**kept, **changes})

    def as_given(self, name: str) -> Any:
        """The text that an argument was given as, or its value.

        Parameters
        ----------
        name : str
            An argument of ``Mover``; an outline is given by its corners.

        Returns
        -------
        object

        Raises
        ------
        InputError
            A name that is none of these.
        """
        if not isinstance(name, str) or name not in NAMES:
            raise one_of("name", NAMES, name, code="unknown_name")
        value = getattr(self, name)
        return texts_given(self).get(name, value)

    @property
    def fixed(self) -> bool:
        """Whether nothing can move it: a barrier, in every case."""
        body = self.vehicle
        inertia = 0.0 if body.yaw_inertia is None else body.yaw_inertia
        still = (body.vx, body.vy, body.yaw_rate)
        return bool(
            np.all(np.isinf(body.mass))
            and np.all(np.isinf(inertia))
            and all(np.all(np.equal(part, 0.0)) for part in still)
        )

    @property
    @returns("m")
    def reach(self) -> float:
        """Distance of the farthest corner from the centre of mass [m]; 0 without an outline."""
        if self.outline is None:
            return 0.0
        return max(math.hypot(*corner) for corner in self.outline.tolist())

    def _texts(self) -> Iterable[Any]:
        tyres = () if self.tyres is None else texts_of(self.tyres.given)
        return (*texts_of(self.vehicle.given), *texts_of(texts_given(self)), *tyres)

    def _summary(self, numbers: Cells) -> Summary:
        rows = [*self.vehicle._summary(numbers).parts[0].rows]
        if self.outline is not None:
            length, width = (float(size) for size in np.ptp(self.outline, axis=0))
            rows.append(("outline", f"{numbers.text(length, 'm')} by {numbers.text(width, 'm')}"))
        if self.drag is not None:
            rows.append(("drag", numbers.text(self.drag, "")))
        parts = [Part(rows)]
        if self.tyres is not None:
            parts += [
                part._replace(heading="Tyres")
                for part in self.tyres._summary(numbers).parts
                if not part.folded
            ]
        return Summary(self.vehicle.name or self._title, [*parts, all_numbers(self._rows())])

    def _values(self, prefix: str = "") -> Iterator[tuple[str, Any, str | None]]:
        if self.drag is not None:
            yield f"{prefix}drag", self.drag, ""

    def _rows(self, prefix: str = "") -> Iterator[tuple[str, str]]:
        yield f"{prefix}vehicle", repr(self.vehicle)
        if self.outline is not None:
            corners = ", ".join(f"({ahead:g}, {left:g})" for ahead, left in self.outline.tolist())
            yield f"{prefix}outline", f"[{corners}]"
        if self.tyres is not None:
            yield f"{prefix}tyres", repr(self.tyres)
        yield from Shown._rows(self, prefix)

    def __reduce__(self) -> tuple[Any, ...]:
        given = {name: self.as_given(name) for name in NAMES}
        return _restored, (given,)


def _restored(given: dict[str, Any]) -> Mover:
    with in_si():
        return Mover(**given)
