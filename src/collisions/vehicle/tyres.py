"""``Tyres``: the four wheels of a vehicle, how they are braked and steered, and the friction of the
ground.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from ..kernels.elementwise import (
    AT_LEAST_ZERO,
    FINITE,
    NOT_NEGATIVE,
    POSITIVE_FINITE,
    UNIT_INTERVAL,
)
from ..kernels.tyre import Tyres as Numbers
from ..messages.errors import InputError, ShapeError
from ..messages.hints import hinted, no_argument
from ..messages.marked import type_of
from ..quantities.attribute_stubs import TyresQuantities
from ..quantities.attributes import Shown, read_only, returns
from ..quantities.reading import ArgumentReader, at_least_zero, warn_if_large
from ..quantities.refusals import must_be
from ..quantities.settings import Default, in_si
from ..quantities.tables import Sentences
from ..quantities.units import Input, Texts, Value, texts_of
from .drag import one_value, read_friction

WHEELS = ("front left", "front right", "rear left", "rear right")
LOCKS = tuple(f"lock[{i}]" for i in range(len(WHEELS)))
# No road vehicle is larger [m]: beyond, a bare number is in another unit.
LARGEST = {"wheelbase": 12.0, "track": 3.5, "height": 3.5}


@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Tyres(Shown):
    """Four wheels on the ground, each with its friction, braking and side force: for ``simulate``
    and contacts that last.

    A braked wheel rolls until its brake can hold it: with a slip angle a, the force along it is
    that of the brake, ``lock`` times that of a locked wheel, but at most the part cos(a) of the
    friction. Across it acts Fiala's side force for a, at most what the friction circle leaves::

        along  = friction * load * min(lock, |cos(a)|)
        across = friction * load * min(sqrt(1 - (along / friction / load)**2), 1 - (1 - z)**3)
        z      = min(1, cornering * |tan(a)| / (3 * friction))

    A brake holds a moment: on ground of another friction, or under another load, the force that it
    can hold stays, up to that of a locked wheel. So a wheel of ``lock`` 0.4 is locked on ice. A
    wheel of ``lock`` 1 does not turn on any ground.

    Parameters
    ----------
    friction : float, str, Quantity or array [-]
        Friction of locked tyres on the ground, >= 0.
    lock : float, str, Quantity or array [-], or a list of four
        Braking of the wheels, from damage, brakes or an engaged gear, as a fraction of what locks
        them on this ground: 0 if a wheel rolls freely, 1 if it is locked. One for all, or front
        left, front right, rear left, rear right.
    wheelbase, track : float, str, Quantity or array [m]
        Distances between the wheels, > 0. The centre of mass is midway.
    steer : float, str, Quantity or array [rad]
        Steer angle of both front wheels, positive to the left.
    cornering : float, str, Quantity or array [-]
        Cornering stiffness of a tyre over its load, per radian, > 0. 16 to 17 % of the load per
        degree is typical of cars.
    height : float, str, Quantity or array, optional [m]
        Height of the centre of mass above the ground. With it, the loads of the wheels follow the
        forces of the tyres, which hold the vehicle upright; without it they stay as at rest, a
        quarter of the weight each.

    Raises
    ------
    InputError
        Naming every argument that cannot be used; a ``height`` at which a wheel lifts off, so that
        the vehicle might tip over.

    Warns
    -----
    SuspectUnitsWarning
        A bare number that is probably in another unit.

    Examples
    --------
    A car whose left front wheel is jammed and whose others roll nearly freely:

    >>> from collisions.travel import Tyres
    >>> Tyres(0.7, [1, 0.05, 0.05, 0.05], "2.7 m", "1.5 m").locks
    (1.0, 0.05, 0.05, 0.05)
    """

    _title = "Tyres"

    if TYPE_CHECKING:

        @property
        def q(self) -> TyresQuantities: ...

    friction: Value = field(metadata={"unit": ""})
    lock: Value | tuple[Value, Value, Value, Value] = field(metadata={"unit": ""})
    wheelbase: Value = field(metadata={"unit": "m"})
    track: Value = field(metadata={"unit": "m"})
    steer: Value = field(metadata={"unit": "rad"})
    cornering: Value = field(metadata={"unit": ""})
    height: Value | None = field(metadata={"unit": "m"})

    @hinted
    def __init__(
        self,
        friction: Input,
        lock: Input | Sequence[Input],
        wheelbase: Input,
        track: Input,
        *,
        steer: Input = 0.0,
        cornering: Input = Default(9.5),  # noqa: B008 - Default cannot change
        height: Input | None = None,
        **unknown: Any,
    ) -> None:
        if unknown:
            raise no_argument("Tyres", NAMES, unknown, _HINTS)
        reader = ArgumentReader()
        given = {
            "friction": friction,
            "wheelbase": wheelbase,
            "track": track,
            "cornering": cornering,
            "steer": steer,
        }
        read: dict[str, Any] = {
            "friction": read_friction(reader, friction, "friction"),
            "lock": _read_lock(reader, lock),
        }
        for name in ("wheelbase", "track", "cornering"):
            read[name] = one_value(reader, given[name], UNITS[name], name, POSITIVE_FINITE)
        read["steer"] = one_value(reader, steer, "rad", "steer")
        read["height"] = None
        if height is not None:
            found = one_value(reader, height, "m", "height")
            read["height"] = at_least_zero(
                reader, found, height, "height", "negative_length", "it is above the ground"
            )
        for name, value in (("wheelbase", wheelbase), ("track", track), ("height", height)):
            if value is not None:
                warn_if_large(value, read[name], LARGEST[name], name, "metres", "cm", "in")
        reader.close()
        refuse_lifting(read, read["friction"], texts_of(reader.texts))
        _set(self, read, Texts(reader.texts))

    def replace(self, **changes: Any) -> Tyres:
        """The tyres with some of the arguments changed.

        Parameters
        ----------
        **changes : see ``Tyres``
            Arguments of ``Tyres`` by name.

        Returns
        -------
        Tyres
        """
        if unknown := changes.keys() - set(NAMES):
            raise no_argument("Tyres.replace", NAMES, unknown, _HINTS)
        kept = {name: as_given(self, name) for name in NAMES if name not in changes}
        with in_si(but=changes):
            return Tyres(**kept, **changes)

    @property
    def given(self) -> Texts:
        """The texts that the arguments were given as."""
        return _given(self)

    @property
    @returns("")
    def locks(self) -> tuple[Any, Any, Any, Any]:
        """The lock of each wheel: front left, front right, rear left, rear right."""
        return self.lock if isinstance(self.lock, tuple) else (self.lock,) * 4

    @property
    def named(self) -> dict[str, Any]:
        """Every number by its name; four locks as lock[0] to lock[3]."""
        found: dict[str, Any] = {"friction": self.friction}
        if isinstance(self.lock, tuple):
            found |= zip(LOCKS, self.lock, strict=True)
        else:
            found["lock"] = self.lock
        for name, value in zip(_OTHERS, _others(self), strict=True):
            if value is not None:
                found[name] = value
        return found

    @property
    def steered(self) -> bool:
        """Whether the front wheels may be turned, in any case of a batch."""
        steer = self.steer
        return steer != 0.0 if isinstance(steer, float) else bool(np.any(steer != 0.0))

    @property
    def transfers(self) -> bool:
        """Whether loads follow the forces, in any case of a batch."""
        height = self.height
        if height is None or isinstance(height, float):
            return height is not None and height != 0.0
        return bool(np.any(height != 0.0))

    def _texts(self) -> Iterable[Any]:
        return texts_of(_given(self))

    def _values(self, prefix: str = "") -> Iterator[tuple[str, Any, str | None]]:
        yield from (
            (name, value, unit)
            for name, value, unit in Shown._values(self, prefix)
            if value is not None
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, ({name: getattr(self, name) for name in NAMES}, _given(self))


NAMES = tuple(f.name for f in fields(Tyres))
_OTHERS = tuple(name for name in NAMES if name not in ("friction", "lock"))
_others = attrgetter(*_OTHERS)
UNITS: dict[str, str] = {f.name: f.metadata["unit"] for f in fields(Tyres)}
# Domains of the values of a batch, which are looked at case by case where the tyres are used.
DOMAINS = {
    "friction": FINITE._replace(name="friction", faults=(*FINITE.faults, *NOT_NEGATIVE.faults)),
    "lock": UNIT_INTERVAL,
    **dict.fromkeys(("wheelbase", "track", "cornering"), POSITIVE_FINITE),
    "steer": FINITE,
    "height": AT_LEAST_ZERO,
}
_HINTS = {
    "mu": "write friction=",
    "drag": "write friction= and lock=",
    "brake": "write lock=",
    "slope": "it is an argument of simulate",
    "surfaces": "they are an argument of simulate",
}


def _given(tyres: Tyres) -> Texts:
    """The texts that the arguments were given as."""
    texts: Texts = getattr(tyres, "_inputs_as_texts")  # noqa: B009 - mypy knows no such field
    return texts


def as_given(tyres: Tyres, name: str) -> Any:
    """The text that an argument was given as, or its number; of four locks a list."""
    value, texts = getattr(tyres, name), _given(tyres)
    if isinstance(value, tuple):
        return [texts.get(f"{name}[{i}]", part) for i, part in enumerate(value)]
    return texts.get(name, value)


def _set(tyres: Tyres, values: Mapping[str, Any], texts: Texts) -> None:
    for name in NAMES:
        object.__setattr__(tyres, name, read_only(values[name]))
    object.__setattr__(tyres, "_inputs_as_texts", texts)


def _restored(values: Mapping[str, Any], texts: Texts) -> Tyres:
    """Unpickled tyres, whose numbers were read before."""
    tyres: Tyres = object.__new__(Tyres)
    _set(tyres, values, texts)
    return tyres


def tyres_with(values: Mapping[str, Any], other: Tyres) -> Tyres:
    """Tyres of these numbers, validated, with the texts of others: those of some cases of a batch,
    or of one.
    """
    with in_si():
        found = Tyres(**values)
    _set(found, values, _given(other))
    return found


def _read_lock(reader: ArgumentReader, given: Any) -> Any:
    """One lock, or a tuple of four."""
    if not isinstance(given, (list, tuple)):
        return one_value(reader, given, "", "lock", UNIT_INTERVAL)
    if len(given) != len(WHEELS):
        text = (
            f"lock is a list of {len(given)}; give one value for all wheels, or four: "
            f"{', '.join(WHEELS)}"
        )
        return reader.refuse(ShapeError(text, code="bad_shape", argument="lock"))
    return tuple(
        one_value(reader, value, "", name, UNIT_INTERVAL)
        for name, value in zip(LOCKS, given, strict=True)
    )


def lifts(tyres: Mapping[str, Any], friction: Any) -> Any:
    """Whether the greatest force on this friction could lift a wheel off the ground."""
    if tyres.get("height") is None:
        return False
    return could_lift(friction, tyres["height"], tyres["wheelbase"], tyres["track"])


def could_lift(friction: Any, height: Any, wheelbase: Any, track: Any) -> Any:
    """Whether the greatest force between the axes of the vehicle takes the load of a wheel."""
    with np.errstate(all="ignore"):
        return (
            2.0 * friction * height * np.hypot(1.0 / np.asarray(wheelbase), 1.0 / np.asarray(track))
            >= 1.0
        )


def refuse_lifting(tyres: Mapping[str, Any], friction: Any, texts: Iterable[Any]) -> None:
    """Refuses a single height at which a wheel would lift off; of a batch that is said case by case
    where it is used.
    """
    if any(
        isinstance(value, np.ndarray)
        for value in (friction, tyres["wheelbase"], tyres["track"], tyres.get("height"))
    ):
        return
    if lifts(tyres, friction):
        say = Sentences(texts)
        most = 0.5 / (friction * math.hypot(1.0 / tyres["wheelbase"], 1.0 / tyres["track"]))
        raise InputError(
            f"height is {say(tyres['height'], 'length')}, and from {say(most, 'length', 3)} on a "
            f"wheel lifts off where a friction of {friction:g} is used between the axes of the "
            "vehicle, which might then tip over: that is not followed here; correct it, or leave "
            "height out",
            code="wheel_lifts",
            argument="height",
        )


def lacking(held: Collection[str], mass_a: Any, mass_b: Any) -> tuple[str, ...]:
    """The vehicles, "a" and "b", without tyres that could have some, beside those ``held`` by
    theirs: a body of infinite mass has none.
    """
    masses = {"a": mass_a, "b": mass_b}
    return tuple(
        label for label, mass in masses.items() if label not in held and np.any(np.isfinite(mass))
    )


def kernel_numbers(flat: Mapping[str, Any], xp: Any = math) -> Numbers:
    """What the kernel takes, from the numbers by name (``Tyres.named``), floats or arrays; ``xp``
    is math or numpy.
    """
    height = flat.get("height", 0.0)
    locks = tuple(flat[name] if name in flat else flat["lock"] for name in LOCKS)
    return Numbers(
        locks,
        flat["friction"],
        flat["cornering"],
        0.5 * flat["wheelbase"],
        0.5 * flat["track"],
        xp.cos(flat["steer"]),
        xp.sin(flat["steer"]),
        height / flat["wheelbase"],
        height / flat["track"],
    )


def not_tyres(label: str, given: Any) -> InputError:
    """The error for an argument that is not Tyres."""
    return must_be(
        label,
        "Tyres",
        given,
        "; write collisions.travel.Tyres(friction, lock, wheelbase, track)",
        code="not_tyres",
        got=type_of(given),
    )
