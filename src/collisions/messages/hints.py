"""Hints for a name that there is not, such as an argument that a function does not have: the
TypeError names the one that is meant, or all that there are.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from inspect import CO_VARKEYWORDS, Parameter, signature
from types import MappingProxyType
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")
F = TypeVar("F", bound=Callable[..., Any])

# Synonyms of arguments.
_CALLED = {
    "mass": "weight m",
    "yaw_rate": "omega angular_velocity spin r",
    "yaw_inertia": "inertia izz iz moment_of_inertia",
    "heading": "angle theta psi yaw orientation",
    "restitution": "e cor epsilon coefficient_of_restitution",
    "friction": "mu f drag coefficient_of_friction",
    "drag": "mu f friction drag_factor deceleration coefficient_of_friction",
    "normal": "angle contact_angle normal_angle n",
    "point": "poi contact impact_point contact_point",
    "mean": "mu loc average value m",
    "sd": "std sigma stdev stddev standard_deviation scale s",
    "low": "lower min minimum start a",
    "high": "upper max maximum stop end b",
    "mode": "likely most_likely peak",
    "grade": "slope",
    "units": "unit system",
    "axes": "ax axis",
    "samples": "n size draws trials",
    "seed": "random_state rng",
    "distance": "d length",
    "end_speed": "final_speed v_end",
    "speed": "v velocity initial_speed",
    "delta_v": "dv",
    "course": "direction angle",
    "inputs": "distributions",
    "outline": "size shape",
}


# The letter, or the number, of a vehicle in a name: speed_a_after, va_after, a.delta_v.
_VEHICLE = r"(?:(?<=[_.])|(?<=^)|(?<=^v)|(?<=\D)(?=\d))[ab12](?=[_.]|$)"
# What points the other way.
_OPPOSITE = {"right": "left", "back": "forward", "rear": "forward"}


def no_argument(
    caller: str,
    names: Iterable[str],
    unknown: Iterable[str],
    hints: Mapping[str, str] = MappingProxyType({}),
) -> TypeError:
    """The error for an argument that a function does not have, with the one that is meant."""
    known, given = list(names), next(iter(unknown))
    # No argument has a capital: speed_A and speedA are speed_a.
    written = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", given).lower()
    stem, side = parted(written)
    near = [written] if written in known else []
    near += [name for name in known if written in _CALLED.get(name, "").split()]
    # Without the letter of a vehicle: v_a is speed_a.
    near += [
        name
        for name in known
        if parted(name)[1] == side and stem in _CALLED.get(parted(name)[0], "").split()
    ]
    near += nearest(written, known, 1, 0.75)  # friction is not restitution
    hint = hints.get(given) or (
        _to_write(near[0], written, known) if near else f"it has {', '.join(known)}"
    )
    return TypeError(f"{caller} has no argument {given!r}; {hint}")


def _to_write(name: str, written: str, known: Iterable[str]) -> str:
    """What to write in place of a name: of both vehicles where it says neither."""
    meant = [name]
    if _vehicle_of(name) and not _vehicle_of(written):
        of_both = re.sub(_VEHICLE, "[ab]", name)
        meant = [one for one in known if re.fullmatch(of_both, one)]
    turned = any(
        way in written and to in name and to not in written for way, to in _OPPOSITE.items()
    )
    sign = ", with the other sign" if turned else ""
    return f"write {' or '.join(f'{one}=' for one in meant)}{sign}"


def _vehicle_of(name: str) -> str:
    """The letter of the vehicle that an argument is of, also of the first and second; "" if it says
    none, or both.
    """
    found = {{"1": "a", "2": "b"}.get(one, one) for one in re.findall(_VEHICLE, name)}
    return found.pop() if len(found) == 1 else ""


def nearest(given: str, known: Iterable[str], most: int, alike: float) -> list[str]:
    """So many of the known names at most that are as much alike to a given one, from 0 to 1, upper
    and lower case being the same; the nearest first.

    Of a name that says one vehicle those of the other come last, and where one name is asked for
    they are none.
    """
    from difflib import get_close_matches

    spelled: dict[str, list[str]] = {}
    for name in known:
        spelled.setdefault(name.lower(), []).append(name)
    vehicle = _vehicle_of(given.lower())
    others = {name for name in spelled if vehicle and _vehicle_of(name) not in ("", vehicle)}
    found = get_close_matches(given.lower(), spelled.keys() - others, most, alike)
    if most > 1:
        found += get_close_matches(given.lower(), others, most, alike)
    return [name for lower in found for name in spelled[lower]][:most]


def parted(name: str) -> tuple[str, str]:
    """A name without the letter of a vehicle at its end, and that letter."""
    stem, _, side = name.rpartition("_")
    return (stem, side) if side in ("a", "b") else (name, "")


def hinted(function: Callable[P, T]) -> Callable[P, T]:
    """Decorate a function so that an argument it does not have is refused with a hint.

    One that takes ``**unknown`` refuses it itself, by ``no_argument``, for a fiftieth of the cost.
    """
    if function.__code__.co_flags & CO_VARKEYWORDS and "unknown" in function.__code__.co_varnames:
        return _without_unknown(function)

    @wraps(function)
    def call(*args: P.args, **options: P.kwargs) -> T:
        try:
            return function(*args, **options)
        except TypeError as error:
            # Raised within the function, and not by the call itself.
            if error.__traceback__ is None or error.__traceback__.tb_next is not None:
                raise
            made, own = function.__name__ == "__init__", f"{function.__qualname__}()"
            taken = list(signature(function).parameters.values())[made:]
            caller, names = type(args[0]).__name__ if made else own, [one.name for one in taken]
            if unknown := [name for name in options if name not in names]:
                raise no_argument(caller, names, unknown) from None
            by_name = [one.name for one in taken if one.kind is Parameter.KEYWORD_ONLY]
            surplus = (
                f"; write the others by name, such as {by_name[0]}="
                if "were given" in str(error) and by_name
                else ""
            )
            raise TypeError(str(error).replace(own, caller) + surplus) from None

    return call


def _without_unknown(function: F) -> F:
    """The function with a signature that does not show ``**unknown``.

    What has no default is None in a call, as otherwise Python would say that it is missing, and not
    what it was given as; a reader refuses the None.
    """
    shown = signature(function)
    taken = [
        one
        for one in shown.parameters.values()
        if one.kind not in (Parameter.VAR_KEYWORD, Parameter.VAR_POSITIONAL)
    ]
    vars(function)["__signature__"] = shown.replace(parameters=taken)
    needed = [one for one in taken if one.default is Parameter.empty and one.name != "self"]
    by_name = {one.name: None for one in needed if one.kind is Parameter.KEYWORD_ONLY}
    function.__defaults__ = (None,) * (len(needed) - len(by_name))
    function.__kwdefaults__ = by_name | (function.__kwdefaults__ or {})
    return function
