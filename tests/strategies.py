"""Hypothesis strategies for arguments of every kind: plausible, extreme, and of types that no
caller should give.
"""

from __future__ import annotations

import math
import string
from decimal import Decimal
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pint
from hypothesis import strategies as st

INF = math.inf
EXTREMES = (
    0.0, -0.0, 5e-324, 1e-320, 2.2e-308, 1e-200, 1e-155, 1e-30, 1e-9, 1.0, 1.0 + 2**-52, 20.0,
    1e9, 1e30, 3e38, 4e38, 1e100, 1e150,
    1e155, 1e200, 1e307, 1e308, 1.7976931348623157e308, INF, math.nan,
)  # fmt: skip
UNITS = {
    "mass": "kg",
    "vx": "m/s",
    "vy": "m/s",
    "yaw_rate": "rad/s",
    "yaw_inertia": "kg*m**2",
    "x": "m",
    "y": "m",
    "heading": "rad",
    "speed": "m/s",
    "course": "rad",
    "pivot": "m",
    "point": "m",
    "forward": "m",
    "left": "m",
    "distance": "m",
    "angle": "rad",
    "normal": "rad",
    "restitution": "",
    "friction": "",
    "impulse_ratio": "",
    "critical_fraction": "",
    "share_a": "",
    "energy_loss": "J",
    "outside_impulse": "N*s",
    "stiffness": "N/m",
    "stiffness_a": "N/m",
    "stiffness_b": "N/m**2",
    "width": "m",
    "drag": "",
    "grade": "",
    "lock": "",
    "tolerance": "m/s",
    "duration": "s",
    "length": "m",
    "wheelbase": "m",
}
SPELLINGS = {
    "kg": ("kg", "lb", "tonne", "g", "slug"),
    "m/s": ("m/s", "km/h", "mph", "ft/s", "knot"),
    "rad/s": ("rad/s", "deg/s", "rpm", "turn/s"),
    "kg*m**2": ("kg*m**2", "kg m^2", "slug*ft**2", "lbf*ft*s**2", "kg·m²"),
    "m": ("m", "cm", "ft", "inch", "mile", "Mpc"),
    "rad": ("rad", "deg", "°", "mrad", "turn", "arcsec"),
    "J": ("J", "kJ", "ft*lbf", "kWh", "N*m"),
    "N*s": ("N*s", "kN*s", "lbf*s", "kg*m/s"),
    "s": ("s", "ms", "minute"),
    "N/m": ("N/m", "N/cm", "lbf/inch"),
    "N/m**2": ("N/m**2", "kPa", "psi"),
    "": ("%", "percent", "ppm", "dimensionless", ""),
}
# What a caller who knows the library gives, in SI.
RANGES = {
    "mass": (300.0, 4e4),
    "yaw_inertia": (200.0, 1e5),
    "restitution": (0.0, 1.0),
    "friction": (0.0, 2.0),
    "impulse_ratio": (-1.0, 1.0),
    "critical_fraction": (0.0, 1.0),
    "share_a": (0.0, 1.0),
    "heading": (-3.0, 3.0),
    "normal": (-3.0, 3.0),
    "course": (-3.0, 3.0),
    "angle": (-3.0, 3.0),
    "vx": (-40.0, 40.0),
    "vy": (-40.0, 40.0),
    "speed": (0.0, 40.0),
    "distance": (0.0, 60.0),
    "energy_loss": (0.0, 4e5),
    "outside_impulse": (-4e3, 4e3),
    "stiffness": (1e5, 2e6),
    "stiffness_a": (1e4, 1e5),
    "stiffness_b": (1e5, 1e6),
    "width": (0.0, 2.0),
    "drag": (0.0, 1.2),
    "grade": (-0.2, 0.2),
    "lock": (0.0, 1.0),
    "tolerance": (0.0, 2.0),
    "duration": (0.05, 0.2),
    "length": (3.0, 6.0),
    "wheelbase": (2.3, 3.2),
}
YAW_RATES = (0.0, 0.0, 0.5, -3.0)
PLACES = (-5.0, 5.0)
ODD_UNITS = (
    "degC", "degF", "delta_degC", "dBm", "dB", "Np", "hertz", "count", "bit", "N", "g_0",
    "kelvin", "J", "percent", "rad", "sr", "m/m",
    "deg*deg", "km/h/s", "1/s", "m**-9", "lbf", "pH", "cm_1", "quettameter", "yoctokg",
    "US_survey_foot", "eV/c**2", "tex", "foo",
)  # fmt: skip


def brief(make: Any) -> Any:
    """A strategy that is made once and shown by its name: Hypothesis warns of a long one."""
    made = cache(make)

    def drawn(draw: Any) -> Any:
        return draw(made())

    drawn.__name__ = make.__name__
    return cache(st.composite(drawn))


@cache
def other_registry() -> Any:
    """A plain registry beside the application's, made once, as each takes time; nothing may be
    defined in it.
    """
    return pint.UnitRegistry()


@cache
def registries() -> tuple[Any, ...]:
    """Registries a caller may bring along, made once: the application's, one of its own, one that
    counts in Decimal.
    """
    return (
        pint.get_application_registry(),
        pint.UnitRegistry(system="imperial"),
        pint.UnitRegistry(non_int_type=Decimal),
        pint.UnitRegistry(autoconvert_offset_to_baseunit=True, force_ndarray_like=True),
    )


@cache
def plausible(name: str) -> Any:
    """What a caller who knows the library gives, in SI."""
    if name == "yaw_rate":
        return st.sampled_from(YAW_RATES)
    kind = st.floats(*RANGES.get(name, PLACES))
    return st.one_of(kind, st.just(INF)) if name == "friction" else kind


@cache
def extreme() -> Any:
    """Any float, the ends of the range more often than the rest."""
    signed = st.tuples(st.sampled_from(EXTREMES), st.sampled_from((1.0, -1.0))).map(
        lambda pair: pair[0] * pair[1]
    )
    return st.one_of(signed, signed, st.floats())


@cache
def numbers(name: str) -> Any:
    """Mostly plausible."""
    return st.one_of(plausible(name), plausible(name), plausible(name), extreme())


SHAPES = ((3,), (1,), (2, 3), (0,), (2, 1), (1, 1, 3))
KINDS = ("f8", "f8", "f8", "f4", "f2", "g", ">f8", "<f4", ">f4", "i4", "u1", "i8")


@cache
def arrays(name: str, shapes: Any = SHAPES, kinds: Any = KINDS) -> Any:
    """Numbers of any precision, order and layout."""
    return _arrays(name, shapes, kinds)


@st.composite
def _arrays(draw: Any, name: str, shapes: Any, kinds: Any) -> np.ndarray:
    shape = draw(st.sampled_from(shapes))
    count = math.prod(shape)
    values = draw(st.lists(numbers(name), min_size=count, max_size=count))
    kind = np.dtype(draw(st.sampled_from(kinds)))
    with np.errstate(all="ignore"):
        array = np.array(values, dtype=float).reshape(shape)
        array = (
            np.nan_to_num(array, posinf=9.0, neginf=-9.0).clip(0, 200).astype(kind)
            if kind.kind in "iu"
            else array.astype(kind)
        )
    layout = draw(
        st.sampled_from(("plain", "strided", "fortran", "reversed", "locked", "broadcast"))
    )
    if layout == "strided":
        return np.repeat(array, 2, axis=-1)[..., ::2]
    if layout == "fortran":
        return np.asfortranarray(array)
    if layout == "reversed":
        return array[..., ::-1]
    if layout == "locked":
        array.setflags(write=False)
    if layout == "broadcast" and count:
        return np.broadcast_to(array[..., :1], shape)
    return array


@cache
def values(name: str, shapes: Any = SHAPES) -> Any:
    """A number, an array, a text or a Quantity, as may be given for this argument."""
    spellings = st.sampled_from(SPELLINGS[UNITS[name]])
    as_text = st.builds("{!r} {}".format, plausible(name), spellings)
    return st.one_of(
        numbers(name),
        numbers(name),
        arrays(name, shapes),
        as_text,
        st.builds(
            quantity, st.one_of(numbers(name), arrays(name, shapes)), spellings, st.integers(0, 3)
        ),
        st.builds(np.asarray, numbers(name)),
        numbers(name).map(lambda x: np.float32(x) if abs(x) < 3e38 else np.float64(x)),
        st.integers(-(2**70), 2**70),
    )


def quantity(magnitude: Any, unit: str, registry: int) -> Any:
    """A Quantity of one of the registries; of what pint itself will not have, a dictionary."""
    source = registries()[registry]
    try:
        return source.Quantity(magnitude, source.parse_units(unit))
    except Exception:
        return {unit: magnitude}


class Nasty:
    """An object that refuses to be shown, compared, converted or measured."""

    def _no(self, *rest: Any) -> Any:
        raise RuntimeError("no")

    __repr__ = __str__ = __eq__ = __len__ = __float__ = __bool__ = __iter__ = _no
    __hash__ = object.__hash__


class NastyArray:
    """An object that claims to be an array and is not."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        raise RuntimeError("no")


class FakeArray:
    """An object whose array is whatever it was made with."""

    def __init__(self, held: Any) -> None:
        self.held = held

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        return self.held


class Tagged(np.ndarray):
    """An array with a unit of its own."""

    unit = "mph"


def cyclic() -> list[Any]:
    """A list that holds itself."""
    found: list[Any] = [1.0]
    found.append(found)
    return found


def deep(depth: int) -> Any:
    """A number in so many lists."""
    found: Any = 1.0
    for _ in range(depth):
        found = [found]
    return found


@brief
def never_numbers() -> Any:
    """What no numeric argument may ever take for a number."""
    return st.sampled_from(NEVER).map(lambda make: make())


# Texts for numbers, some of which are none.
NUMBERS = (
    "1",
    "-.5",
    "1e3",
    "1e400",
    "-1e-400",
    "+inf",
    "nan",
    "1_0",
    "٣",
    "1.",
    ".",
    "1e",
    "--1",
    "0x1",
    "1,5",
    "½",
    "²",
)
# numpy's longest kind holds no more than a float on Windows and on some Macs.
BEYOND_A_DOUBLE = (
    (lambda: np.longdouble("1e4000"), lambda: np.array([np.longdouble("1e4000"), 1]))
    if np.finfo(np.longdouble).maxexp > np.finfo(float).maxexp
    else ()
)
NEVER = (
    lambda: True,
    lambda: np.False_,
    lambda: np.array(True),
    lambda: np.array([True, False]),
    lambda: [True, 1.0],
    lambda: [np.array([True])],
    lambda: 1 + 0j,
    lambda: np.complex64(1),
    lambda: np.array([1 + 0j]),
    lambda: [1 + 0j],
    lambda: np.timedelta64(5, "s"),
    lambda: np.timedelta64("NaT", "s"),
    lambda: np.timedelta64(5, "D"),
    lambda: np.datetime64("2020-01-01"),
    lambda: np.array([5], dtype="m8[s]"),
    lambda: [np.timedelta64(5, "s"), np.timedelta64(6, "s")],
    lambda: [1.0, np.timedelta64(6, "D")],
    lambda: np.ma.masked,
    lambda: np.ma.masked_array([1.0, 2.0], [True, False]),
    lambda: np.ma.masked_array(3.0, True),
    lambda: np.ma.masked_array(3.0, False),
    lambda: [np.ma.masked_array([1.0, 2.0], [True, False])],
    lambda: [1.0, np.ma.masked],
    lambda: (np.ma.masked_array(3.0, True), 1.0, 2.0),
    lambda: np.array([1.0, 2.0]).view(Tagged),
    lambda: [np.array([1.0, 2.0]).view(Tagged)],
    lambda: np.array([1.0, None], dtype=object),
    lambda: np.array([Fraction(1, 2)], dtype=object),
    lambda: np.array(["1", "2"]),
    lambda: np.array("1 m/s"),
    lambda: np.str_("abc"),
    lambda: np.bytes_(b"5"),
    lambda: np.void(b"12345678"),
    lambda: np.zeros(2, dtype=[("a", "f8")]),
    lambda: np.array([b"5"]),
    lambda: b"5 m/s",
    lambda: bytearray(b"5"),
    lambda: memoryview(b"5"),
    lambda: Decimal("1.5"),
    lambda: Fraction(3, 2),
    lambda: {1.0},
    lambda: frozenset(),
    lambda: {"value": 1.0},
    lambda: {},
    lambda: range(3),
    lambda: (x for x in (1.0, 2.0)),
    lambda: iter([1.0]),
    lambda: object(),
    lambda: float,
    lambda: np.float64,
    lambda: np.ndarray,
    lambda: pint.Quantity,
    lambda: len,
    lambda: Ellipsis,
    lambda: NotImplemented,
    lambda: math,
    lambda: Nasty(),
    lambda: [Nasty(), 1.0],
    lambda: NastyArray(),
    lambda: [NastyArray()],
    lambda: FakeArray(3),
    lambda: FakeArray("3"),
    lambda: FakeArray(np.array([True])),
    lambda: FakeArray(np.ma.masked_array([1.0], [True])),
    lambda: cyclic(),
    lambda: deep(70),
    lambda: deep(5000),
    lambda: [[1.0, 2.0], [3.0]],
    lambda: [1.0, [2.0]],
    lambda: [[], [1.0]],
    lambda: ["1 m/s", 2.0],
    lambda: [None],
    lambda: [{}],
    lambda: 10**400,
    lambda: -(10**5000),
    lambda: [10**400, 1.0],
    *BEYOND_A_DOUBLE,
    lambda: registries()[0].m,
    lambda: registries()[1],
    lambda: quantity(True, "kg", 0),
    lambda: quantity(np.array([True]), "m", 0),
    lambda: quantity(1 + 2j, "m", 0),
    lambda: quantity(None, "m", 0),
    lambda: quantity("a", "m/s", 0),
    lambda: quantity(np.ma.masked_array([1.0, 2.0], [True, False]), "m/s", 0),
    lambda: quantity(10**400, "m/s", 0),
    lambda: quantity(np.array([None, 1.0], dtype=object), "m/s", 0),
    lambda: quantity(Fraction(3, 2), "m/s", 0),
    lambda: [quantity(1.0, "m/s", 0)],
    lambda: quantity(1.0, "degC", 0),
    lambda: quantity(1.0, "dBm", 0),
    lambda: quantity(1.0, "hertz", 0),
    lambda: quantity([], "kelvin", 0),
)  # fmt: skip


@brief
def texts() -> Any:
    """Texts of any kind, and such as are nearly a number and a unit."""
    spelled = st.sampled_from(
        [text for group in SPELLINGS.values() for text in group] + list(ODD_UNITS)
    )
    number = st.one_of(
        st.floats().map(repr),
        st.sampled_from(NUMBERS),
        st.integers(-(10**30), 10**30).map(str),
    )
    gap = st.sampled_from((" ", "", "  ", "\t", "\n", "\u00a0", " *", "\x00", "\u2009"))
    near = st.builds("{}{}{}".format, number, gap, spelled)
    alphabet = st.sampled_from(
        string.ascii_letters + string.digits + " */^().-+%°·²³µΩ_[]{}\n\x00é中\ud800"
    )
    mutated = st.builds(
        lambda text, at, new: text[:at] + new + text[at:],
        near,
        st.integers(0, 12),
        st.text(alphabet, max_size=3),
    )
    names = st.sampled_from(sorted(map(str, dir(registries()[0])))).map("1 {}".format)
    return st.one_of(
        near,
        mutated,
        st.text(max_size=20),
        st.text(alphabet, max_size=70),
        names,
        near.map(np.str_),
    )


@brief
def garbage() -> Any:
    """Anything at all."""
    leaf = st.one_of(
        extreme(),
        st.none(),
        st.booleans(),
        st.integers(),
        texts(),
        st.binary(max_size=5),
        st.complex_numbers(),
    )
    nested = st.recursive(
        leaf,
        lambda inner: st.one_of(
            st.lists(inner, max_size=3),
            st.tuples(inner, inner),
            st.dictionaries(st.text(max_size=3), inner, max_size=2),
        ),
        max_leaves=5,
    )
    dtypes = [
        "?",
        "b",
        "B",
        "h",
        "H",
        "i",
        "I",
        "q",
        "Q",
        "e",
        "f",
        "d",
        "g",
        "F",
        "D",
        "G",
        "S3",
        "U3",
        "O",
        "V4",
        "M8[s]",
        "m8[s]",
        ">f8",
        ">i2",
        "f8,i4",
    ]
    blank = st.builds(
        lambda kind, shape: np.zeros(shape, dtype=kind),
        st.sampled_from(dtypes),
        st.sampled_from(((), (2,), (0,), (3,), (2, 2))),
    )
    scalar = blank.filter(lambda array: array.size).map(lambda array: array.reshape(-1)[0])
    magnitude = st.one_of(
        numbers("mass"),
        arrays("mass"),
        st.none(),
        st.booleans(),
        st.integers(),
        blank,
        st.lists(extreme(), max_size=3),
    )
    spelled = [text for group in SPELLINGS.values() for text in group] + list(ODD_UNITS)
    odd = st.builds(quantity, magnitude, st.sampled_from(spelled), st.integers(0, 3))
    return st.one_of(
        never_numbers(),
        nested,
        texts(),
        blank,
        scalar,
        odd,
        odd,
        st.integers(-(10**400), 10**400),
        arrays("x"),
    )
