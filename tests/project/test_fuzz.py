"""Arbitrary arguments: every call answers in full or raises a CollisionsError; no other exception,
no numpy warning, no hang.

``COLLISIONS_FUZZ`` sets the number of examples of each test and then draws new ones in every run.
"""

from __future__ import annotations

import contextlib
import copy
import json
import math
import os
import pickle
import re
import signal
import threading
import warnings
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import collisions as col
from collisions.quantities.attributes import attributes
from strategies import (
    SHAPES,
    arrays,
    extreme,
    garbage,
    never_numbers,
    numbers,
    plausible,
    registries,
    texts,
    values,
)

pytestmark = pytest.mark.slow
EXAMPLES = int(os.environ.get("COLLISIONS_FUZZ", "0"))
SECONDS = 60.0
BUSY = 1e100  # beyond this, products of two numbers may leave the range of floats


def examples(share: float = 1.0) -> Any:
    """The examples of one test: few and the same in every run, or as many as the environment asks
    for, new each time.
    """
    return settings(
        max_examples=max(1, int((EXAMPLES or 30) * share)),
        derandomize=not EXAMPLES,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )


class Hung(BaseException):
    """Nothing in the package may catch this."""


@contextlib.contextmanager
def promptly() -> Any:
    """Fails what has worked for some seconds without an end, where the system has an alarm to set:
    of processor time, so that it does not depend on what else the machine does.
    """
    # Windows has neither the alarm nor its signal.
    if (
        not hasattr(signal, "setitimer")
        or threading.current_thread() is not threading.main_thread()
    ):
        yield
        return

    def ring(*_: Any) -> None:
        raise Hung

    previous = signal.signal(signal.SIGPROF, ring)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        yield
    except Hung:
        raise AssertionError(f"still running after {SECONDS} s of work") from None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, previous)


def attempt(label: str, call: Any) -> Any:
    """The answer of a call, or the CollisionsError it raised; anything else, numpy's warnings
    included, is a failure.
    """
    with promptly(), warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", col.CollisionsWarning)
        try:
            return call()
        except col.CollisionsError as error:
            refused = error
    assert re.fullmatch("[a-z][a-z_0-9]*", refused.code), label
    assert str(refused), label
    assert repr(refused), label
    assert isinstance(refused, ValueError), label
    return refused


def must_answer(label: str, call: Any) -> Any:
    """The answer of a call that nothing can be wrong with."""
    found = attempt(label, call)
    assert not isinstance(found, col.CollisionsError), f"{label}: {found}"
    return found


def modest(*objects: Any) -> bool:
    """Whether every number in there is so far from the ends of the range that no product of two
    leaves it.
    """
    for value in objects:
        if isinstance(value, col.Vehicle):
            parts = [getattr(value, name) for name in FIELDS if name != "name"]
            if not modest(
                *(
                    math.nan if name == "mass" else part
                    for name, part in zip(FIELDS, parts, strict=False)
                ),
                value.mass,
            ):
                return False
        elif isinstance(value, tuple):
            if not modest(*value):
                return False
        elif value is not None and not isinstance(value, str):
            size = np.abs(np.asarray(value, dtype=float))
            size = size[np.isfinite(size)]
            limit = 1e15 if getattr(value, "dtype", None) == np.float32 else BUSY
            if np.any(size > limit) or np.any((size < 1.0 / limit) & (size > 0.0)):
                return False
    return True


FIELDS = ("mass", "vx", "vy", "yaw_rate", "yaw_inertia", "x", "y", "heading", "pivot", "name")
# In an answered case these may be no finite number: no direction at rest or without an impulse, no
# slip that needs a pull.
OPEN = {"impulse_direction", "pdof", "pdof_clock", "impulse_ratio", "critical_impulse_ratio"}
# These are inputs and not results.
INPUTS = {
    "restitution",
    "friction",
    "normal",
    "normal_angle",
    "point",
    "model",
    "law",
    "choice",
    "status",
    "ok",
    "refused",
    "complete",
    "reconstruction",
}
WORDS = {"kind", "regime"}
# What the solver itself gives, finite wherever it answers; the rest is finite where no product can
# leave the range of floats.
CERTAIN = {"closing_speed", "slip_before", "slip_after", "normal_impulse", "tangential_impulse",
"compression_impulse", "effective_mass",
           "energy_loss", "energy_loss_normal", "energy_loss_tangential", "delta_vx", "delta_vy",
           "delta_yaw_rate"}  # fmt: skip


def look_at_vehicle(vehicle: col.Vehicle, *, made_by_hand: bool = True) -> None:
    """Every output of a Vehicle."""
    for name in FIELDS:
        value = getattr(vehicle, name)
        for part in value if isinstance(value, tuple) else (value,):
            assert part is None or type(part) is float or isinstance(part, (str, np.ndarray)), name
            assert not isinstance(part, np.ndarray) or (
                not part.flags.writeable and part.dtype in (np.float32, np.float64)
            ), name
    for name in ("speed", "course", "momentum", "kinetic_energy"):
        attempt(name, lambda name=name: getattr(vehicle, name))
        attempt(f"q.{name}", lambda name=name: getattr(vehicle.q, name))
    must_answer("repr", lambda: repr(vehicle))
    must_answer("html", lambda: vehicle._repr_html_())
    assert must_answer("==", lambda: vehicle == copy.copy(vehicle))
    assert must_answer("pickle", lambda: pickle.loads(pickle.dumps(vehicle))) == vehicle
    if made_by_hand:
        again = attempt("replace", lambda: vehicle.replace())
        assert (
            isinstance(again, col.CollisionsError) or vehicle.pivot is not None or again == vehicle
        )


def check_numbers(
    label: str, value: Any, refused: Any, shape: tuple[int, ...], finite: bool
) -> None:
    """Finite in every answered case, NaN in every refused one."""
    for part in value if isinstance(value, tuple) else (value,):
        assert np.broadcast_shapes(np.shape(part), shape) == shape, label
        assert type(part) in (float, int) or isinstance(part, np.ndarray), (label, type(part))
        number = np.broadcast_to(np.asarray(part, dtype=float), shape)
        assert np.isnan(number[refused]).all(), f"{label} has a number in a refused case: {part!r}"
        if finite:
            assert np.isfinite(number[~refused]).all(), f"{label} is not finite: {part!r}"


def look_at_impact(impact: col.Impact) -> None:
    """Every attribute of an Impact, its refused and its answered cases, and what it can be turned
    into.
    """
    status = np.asarray(impact.status)
    shape, refused = status.shape, status > col.Status.ENERGY_GAIN
    assert np.array_equal(np.asarray(impact.refused), refused)
    assert np.array_equal(np.asarray(impact.ok), status == col.Status.OK)
    # A closing speed far below both speeds may have been given backwards.
    tame = modest(
        impact.a.before, impact.b.before, impact.closing_speed, impact.point, impact.normal,
        impact.inputs.rule_value,
    )  # fmt: skip

    def look(label: str, owner: Any, name: str) -> None:
        value = must_answer(label, lambda: getattr(owner, name))
        quantity = attempt(f"q.{label}", lambda: getattr(owner.q, name))
        # What is None for want of a heading says so.
        wanting = value is None and isinstance(quantity, col.MissingInputError)
        assert wanting or not isinstance(quantity, col.CollisionsError), f"q.{label}: {quantity}"
        if isinstance(value, col.Vehicle):
            look_at_vehicle(value, made_by_hand=False)
            if name == "before" and not shape:
                assert refused or np.isfinite((value.vx, value.vy, value.yaw_rate)).all(), label
            if name != "before":
                check_numbers(label, (value.vx, value.vy, value.yaw_rate), refused, shape, tame)
        elif name in WORDS:
            words = np.broadcast_to(np.asarray(value), shape)
            assert (not shape) or ((words == "") == refused).all(), label
        elif value is not None and name not in INPUTS and name not in ("a", "b"):
            certain = name in CERTAIN
            check_numbers(label, value, refused, shape, (tame or certain) and name not in OPEN)

    for name in attributes(col.Impact):
        attempt_all(name, lambda name=name: look(name, impact, name))
    for side in "ab":
        for name in attributes(type(impact.a)):
            attempt_all(
                f"{side}.{name}",
                lambda side=side, name=name: look(f"{side}.{name}", getattr(impact, side), name),
            )
        attempt_all(
            "side repr",
            lambda side=side: repr(getattr(impact, side)) + getattr(impact, side)._repr_html_(),
        )
    attempt_all("repr", lambda: repr(impact))
    attempt_all("html", lambda: impact._repr_html_())
    attempt_all("pickle", lambda: check_equal(pickle.loads(pickle.dumps(impact)), impact))
    attempt_all("columns", lambda: check_columns(impact.to_columns(), status.size))
    attempt_all("record", lambda: check_record(impact))
    attempt_all("ees", lambda: check_ees(impact, refused, shape, tame))


def attempt_all(label: str, call: Any) -> None:
    """One look at a result, whose failure names it."""
    must_answer(label, call)


def check_equal(one: Any, other: Any) -> None:
    """The same by value."""
    assert one == other


def check_columns(columns: dict[str, list[Any]], size: int) -> None:
    """One value a case in each."""
    assert {len(column) for column in columns.values()} == {size}


def check_record(impact: col.Impact) -> None:
    """Strict JSON that solves to the same again."""
    text = json.dumps(impact.to_dict(), allow_nan=False)
    twin = col.Impact.from_dict(json.loads(text))
    assert twin == impact


def check_ees(impact: col.Impact, refused: Any, shape: tuple[int, ...], tame: bool) -> None:
    """The equivalent speeds of both."""
    check_numbers("crush", impact.max_crush_speeds(0.5), refused, shape, tame)


def some_of(fields: Any, *, odd: float = 0.3) -> Any:
    """Arguments by name, each left out or given; mostly in order, a few of them anything."""

    @st.composite
    def build(draw: Any) -> dict[str, Any]:
        shapes = draw(st.sampled_from((SHAPES, ((3,),), ((3,),), ((2, 3), (3,), (2, 1)))))
        mood = draw(
            st.sampled_from(
                ("plain", "plain", "numbers", "numbers", "values", "values", "odd", "odd")
            )
        )
        found = {}
        for name in fields:
            if draw(st.integers(0, 9)) < (
                1 if name in ("mass", "restitution", "normal", "point") else 3
            ):
                continue
            pair = name in ("pivot", "point")
            kind = (
                plausible(name)
                if mood == "plain"
                else numbers(name)
                if mood == "numbers"
                else values(name, shapes)
            )
            if mood == "odd" and draw(st.floats(0.0, 1.0)) < odd:
                kind = garbage()
            found[name] = draw(
                st.tuples(kind, kind)
                if pair and not (mood == "odd" and draw(st.booleans()))
                else kind
            )
        return found

    return build()


BODY = ("mass", "vx", "vy", "yaw_rate", "yaw_inertia", "x", "y", "heading")
anything = garbage()
pairs = st.one_of(
    st.tuples(numbers("point"), numbers("point")),
    st.tuples(values("point"), values("point")),
    st.tuples(garbage(), garbage()),
    st.lists(garbage(), max_size=3),
    garbage(),
    arrays("point", ((2,), (2, 2), (3,))),
)


def called_wrongly(call: Any) -> Any:
    """The answer of a call whose keywords may be missing or unknown, which Python
    itself refuses.
    """
    try:
        return call()
    except TypeError as error:
        said = (
            r"missing \d+ required|has no argument|multiple values for (keyword )?argument|"
            r"keywords must be strings"
        )
        if not re.search(said, str(error)):
            raise
        return None


@pytest.fixture(scope="module", autouse=True)
def _pint_loaded() -> None:
    """The first unit loads pint, which is no example's fault."""
    registries()[0].Quantity(1.0, "km/h").to("m/s")


@cache
def bodies(shapes: Any = ((3,),), everything: bool = True) -> Any:
    """A Vehicle that can be made: plausible, extreme or a batch."""
    return _bodies(shapes, everything)


@st.composite
def _bodies(draw: Any, shapes: Any, everything: bool) -> col.Vehicle:
    kind = draw(st.sampled_from(("plain", "plain", "numbers", "arrays", "arrays", "single")))

    def one(name: str) -> Any:
        if kind == "plain":
            return plausible(name)
        if kind == "numbers":
            return numbers(name)
        kinds = ("f4",) if kind == "single" else ("f8", "f8", "f4")
        return st.one_of(
            plausible(name), numbers(name), arrays(name, shapes, kinds), arrays(name, shapes, kinds)
        )

    if draw(st.integers(0, 9)) == 0:
        return col.Vehicle.barrier()
    fields = {name: draw(one(name)) for name in BODY}
    if not everything and draw(st.booleans()):
        fields["yaw_rate"] = 0.0
        if draw(st.booleans()):
            fields["vy"] = 0.0
    for name in ("yaw_inertia", "x", "y", "heading"):
        if draw(st.integers(0, 19)) == 0:
            del fields[name]
    if draw(st.integers(0, 5)) == 0:
        fields["mass"] = math.inf
        fields["yaw_inertia"] = math.inf
    if draw(st.integers(0, 4)) == 0:
        fields["pivot"] = (draw(one("x")), draw(one("y")))
        if draw(st.integers(0, 4)):
            fields["vx"] = fields["vy"] = 0.0
    made = attempt("Vehicle", lambda: col.Vehicle(**fields))
    return (
        made
        if isinstance(made, col.Vehicle)
        else col.Vehicle(mass=1200.0, vx=10.0, yaw_inertia=1800.0, x=0.0, y=0.0)
    )


@st.composite
def arguments(draw: Any, model: str, odd: float) -> dict[str, Any]:
    """The keywords of a solver."""
    shapes = draw(st.sampled_from((((3,),), ((3,),), ((2, 3), (3,), (2, 1)), SHAPES)))

    def one(name: str) -> Any:
        if draw(st.floats(0.0, 1.0)) < odd:
            return garbage()
        return draw(
            st.sampled_from(
                (plausible(name), numbers(name), values(name, shapes), arrays(name, shapes))
            )
        )

    found: dict[str, Any] = {
        "a": draw(bodies(shapes, model == "eccentric")),
        "b": draw(bodies(shapes, model == "eccentric")),
    }
    found["restitution"] = draw(one("restitution"))
    if model != "linear_central" or draw(st.booleans()):
        found["normal"] = draw(
            st.one_of(one("normal"), st.tuples(one("impulse_ratio"), one("impulse_ratio")))
        )
    if model != "linear_central":
        rule = draw(st.sampled_from(("friction", "impulse_ratio", "critical_fraction")))
        found[rule] = draw(one(rule))
        found["law"] = draw(st.sampled_from(("brach", "kudlich-slibar", "stronge")))
    if model == "eccentric":
        found["point"] = draw(st.tuples(one("point"), one("point")))
    found["on_failure"] = draw(st.sampled_from((None, "nan", "nan", "raise")))
    if odd:
        for name in (
            "a",
            "b",
            "law",
            "on_failure",
            "threads",
            "progress",
            "point",
            "friction",
            "nonsense",
        ):
            if draw(st.integers(0, 19)) == 0:
                found[name] = draw(garbage())
        if callable(found.get("progress")):
            # A call of the caller's own fails as it likes.
            del found["progress"]
        for name in ("restitution", "normal"):
            if draw(st.integers(0, 19)) == 0:
                found.pop(name, None)
    return found


MODELS = ("linear_central", "oblique_central", "eccentric")
every_model = pytest.mark.parametrize("model", MODELS)


@examples(3)
@given(
    some_of((*BODY, "pivot")),
    st.one_of(st.just(""), st.text(max_size=5), anything),
    st.integers(0, 9),
)
def test_a_vehicle_of_anything(fields: dict[str, Any], name: Any, how: int) -> None:
    """The constructor and the barrier take every field as anything."""
    if how < 2:
        fields["name"] = name
    make = col.Vehicle.barrier if how == 9 else col.Vehicle
    vehicle = attempt("Vehicle", lambda: called_wrongly(lambda: make(**fields)))
    if isinstance(vehicle, col.Vehicle):
        look_at_vehicle(vehicle)


@examples()
@given(some_of(("speed", "course", "mass", "yaw_rate", "vx", "heading")))
def test_a_vehicle_from_any_speed_and_course(fields: dict[str, Any]) -> None:
    """Speed and course take anything too; the speed that comes back is the one given."""
    if "vx" in fields and len(fields) > 3:
        del fields["vx"]
    vehicle = attempt(
        "from_speed", lambda: called_wrongly(lambda: col.Vehicle.from_speed(**fields))
    )
    if isinstance(vehicle, col.Vehicle):
        look_at_vehicle(vehicle)
        speed = fields["speed"]
        if type(speed) is float and modest(speed) and isinstance(vehicle.vx, float):
            assert vehicle.speed == pytest.approx(abs(speed), rel=1e-15)


@examples()
@given(bodies(), some_of(BODY), st.one_of(st.none(), pairs), st.booleans())
def test_a_vehicle_replaced_by_anything(
    vehicle: col.Vehicle, changes: dict[str, Any], pivot: Any, pin: bool
) -> None:
    """Every field of a vehicle can be replaced, or the replacement is refused."""
    if pin:
        changes["pivot"] = pivot
    found = attempt("replace", lambda: vehicle.replace(**changes))
    if isinstance(found, col.Vehicle):
        look_at_vehicle(found)


@examples()
@given(bodies(), pairs, some_of(("forward", "left", "distance", "angle")))
def test_places_on_a_vehicle(vehicle: col.Vehicle, point: Any, place: dict[str, Any]) -> None:
    """point and velocity_at take anything; from ordinary numbers come ordinary numbers."""
    for label, call in (
        ("velocity_at", lambda: vehicle.velocity_at(point)),
        ("point", lambda: vehicle.point(**place)),
    ):
        found = attempt(label, call)
        if isinstance(found, col.CollisionsError):
            continue
        assert isinstance(found, tuple), label
        assert len(found) == 2, label
        for part in found:
            assert type(part) is float or isinstance(part, np.ndarray), (label, type(part))
        inputs = point if label == "velocity_at" else tuple(place.values())
        if (
            all(type(part) is float for part in inputs)
            and modest(vehicle, inputs)
            and all(type(p) is float for p in found)
        ):
            assert all(map(math.isfinite, found)), label


@every_model
@examples(2)
@given(data=st.data())
def test_a_solver_of_any_numbers(model: str, data: Any) -> None:
    """Numbers of any size, single and in batches: answered in full, or refused case by case."""
    given_to = data.draw(arguments(model, 0.0))
    impact = attempt(model, lambda: getattr(col, model)(**given_to))
    if isinstance(impact, col.Impact):
        look_at_impact(impact)


@every_model
@examples(2)
@given(data=st.data())
def test_a_solver_of_anything(model: str, data: Any) -> None:
    """Arguments of any type."""
    given_to = data.draw(arguments(model, 0.15))
    impact = attempt(model, lambda: called_wrongly(lambda: getattr(col, model)(**given_to)))
    if isinstance(impact, col.Impact):
        look_at_impact(impact)


@examples()
@given(arguments("eccentric", 0.0), st.one_of(values("share_a"), anything), pairs)
def test_questions_to_an_impact(given_to: dict[str, Any], share: Any, point: Any) -> None:
    """ees and delta_v_at take anything."""
    impact = attempt("eccentric", lambda: col.eccentric(**given_to))
    if isinstance(impact, col.Impact):
        attempt("ees", lambda: impact.ees(share))
        attempt("delta_v_at", lambda: impact.a.delta_v_at(point))


def _record(model: str, batch: bool) -> dict[str, Any]:
    """A record to spoil."""
    vx = np.array([20.0, -20.0, math.nan]) if batch else 20.0
    a = col.Vehicle(mass=1100.0, vx=vx, yaw_inertia=1800.0, x=0.0, y=0.0)
    b = col.Vehicle(mass=math.inf, yaw_inertia=math.inf, name="wall")
    more = {
        "linear_central": {},
        "oblique_central": {"normal": 0.2, "friction": math.inf},
        "eccentric": {"normal": 0.2, "point": (1.0, 0.3), "impulse_ratio": 0.1},
    }[model]
    return json.loads(
        json.dumps(getattr(col, model)(a, b, 0.2, on_failure="nan", **more).to_dict())
    )


RECORDS = {(model, batch): _record(model, batch) for model in MODELS for batch in (False, True)}
plain_json = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(),
        st.integers(-(10**400), 10**400),
        st.floats(),
        st.text(max_size=5),
        st.sampled_from(
            (
                "inf",
                "nan",
                "friction",
                "threads",
                "on_failure",
                "law",
                "normal",
                "linear_central",
                "eccentric",
                "brach",
                "1 kg",
            )
        ),
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3),
        st.dictionaries(
            st.sampled_from(("dtype", "shape", "values", "status", "a")), inner, max_size=3
        ),
        st.fixed_dictionaries(
            {
                "dtype": st.sampled_from(
                    (
                        "float64",
                        "float32",
                        "object",
                        "bool",
                        "uint8",
                        "U3",
                        "complex128",
                        "float16",
                        "m8[s]",
                        "O",
                        "f8,f8",
                    )
                ),
                "shape": st.lists(st.integers(-2, 3), max_size=3),
                "values": st.lists(inner, max_size=3),
            }
        ),
    ),
    max_leaves=6,
)


@examples(2)
@given(
    st.sampled_from(sorted(RECORDS)),
    st.one_of(plain_json, plain_json, garbage()),
    st.integers(0, 10**6),
    st.booleans(),
)
def test_a_record_of_anything(which: tuple[str, bool], new: Any, at: int, drop: bool) -> None:
    """A record with one part changed or taken out is solved again or refused, and so is what never
    was a record.
    """
    record = copy.deepcopy(RECORDS[which])
    places = [(record, key) for key in record]
    for holder, key in places:
        if isinstance(holder[key], dict) and key != "results":
            places += [(holder[key], inner) for inner in holder[key]]
    places += [(record["results"], "status"), (None, None)]
    holder, key = places[at % len(places)]
    if holder is None:
        record = new
    elif drop:
        del holder[key]
    else:
        holder[key] = new
    impact = attempt("from_dict", lambda: col.Impact.from_dict(record))
    if isinstance(impact, col.Impact):
        look_at_impact(impact)


READ_AS = {
    "kg": "mass",
    "m/s": "vx",
    "rad/s": "yaw_rate",
    "kg*m**2": "yaw_inertia",
    "m": "x",
    "rad": "heading",
}


@examples(4)
@given(texts(), st.sampled_from(("", *READ_AS)))
def test_any_text(text: str, unit: str) -> None:
    """A text is refused or is the number in front of it times the unit behind it, and
    nothing else.
    """
    name = READ_AS.get(unit)
    if name is None:
        a, b = col.Vehicle(mass=1.0, vx=1.0), col.Vehicle(mass=1.0)
        impact = attempt("restitution", lambda: col.linear_central(a, b, text))
        found = impact if isinstance(impact, col.CollisionsError) else impact.restitution
    else:
        vehicle = attempt(name, lambda: col.Vehicle(**{"mass": 1.0, name: text}))
        found = vehicle if isinstance(vehicle, col.CollisionsError) else getattr(vehicle, name)
    if isinstance(found, col.CollisionsError):
        return
    read = text.strip()
    ends = [end for end in range(len(read), 0, -1) if _is_float(read[:end])]
    assert ends, text
    factor = (
        registries()[0]
        .Quantity(1.0, read[ends[0] :].strip() or "dimensionless")
        .m_as(unit or "dimensionless")
    )
    assert found == pytest.approx(float(read[: ends[0]]) * factor, rel=1e-14, abs=0.0)


def _is_float(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return text.isascii() and "_" not in text and not text[-1].isspace()


@examples(4)
@given(never_numbers(), st.sampled_from((*BODY, "pivot", "point", "speed", "course", "forward",
    "angle", "normal", "restitution", "friction", "impulse_ratio", "critical_fraction", "share_a",
    "normal[0]")))  # fmt: skip
def test_what_is_never_a_number(value: Any, name: str) -> None:
    """Refused wherever a number is asked for; a mass or a speed is never made of it."""
    a = col.Vehicle(mass=1100.0, vx=20.0, yaw_inertia=1800.0, x=0.0, y=0.0, heading=0.0)
    scene = {
        "a": a,
        "b": a.replace(vx=0.0),
        "restitution": 0.1,
        "normal": 0.0,
        "point": (1.0, 0.3),
        "friction": 0.3,
    }
    if name in BODY:
        found = attempt(name, lambda: col.Vehicle(**{"mass": 1.0, name: value}))
    elif name == "pivot":
        found = attempt(
            name, lambda: col.Vehicle(mass=1.0, yaw_inertia=1.0, x=1.0, y=1.0, pivot=(value, 0.0))
        )
    elif name in ("speed", "course"):
        found = attempt(
            name,
            lambda: col.Vehicle.from_speed(
                **{"mass": 1.0, "speed": 1.0, "course": 0.0, name: value}
            ),
        )
    elif name == "forward":
        found = attempt(name, lambda: a.point(forward=value))
    elif name == "angle":
        found = attempt(name, lambda: a.point(distance=1.0, angle=value))
    elif name == "share_a":
        found = attempt(name, lambda: col.eccentric(**scene).ees(value))
    else:
        if name in ("impulse_ratio", "critical_fraction"):
            del scene["friction"]
        scene[name.partition("[")[0]] = (value, 0.5) if name in ("point", "normal[0]") else value
        found = attempt(name, lambda: col.eccentric(**scene))
    assert isinstance(found, col.InputError), f"{name} was taken as {found!r}"


COMPARED = (
    "closing_speed",
    "slip_before",
    "normal_impulse",
    "tangential_impulse",
    "energy_loss",
    "effective_mass",
    "relative_speed",
)
MOVED = ("delta_vx", "delta_vy", "delta_yaw_rate", "impulse_x", "impulse_y")


@st.composite
def batches(draw: Any, model: str, count: int = 4, worth: Any = plausible) -> dict[str, np.ndarray]:
    """Every number of a batch, by the name of the argument and the side."""
    found = {}
    for side in "ab":
        for name in ("mass", "vx", "vy", "yaw_rate", "yaw_inertia", "x", "y"):
            found[f"{side}.{name}"] = draw(st.lists(worth(name), min_size=count, max_size=count))
    for name in ("restitution", "normal", "friction", "point[0]", "point[1]"):
        found[name] = draw(st.lists(worth(name.partition("[")[0]), min_size=count, max_size=count))
    if model != "eccentric":
        found["a.yaw_rate"] = found["b.yaw_rate"] = [0.0] * count
    if model == "linear_central":
        found["normal"] = [0.0] * count
        found["a.vy"] = found["b.vy"] = [0.0] * count
    return {name: np.array(numbers_of) for name, numbers_of in found.items()}


def solve(model: str, columns: Any, **options: Any) -> Any:
    """The impact of one case or of all."""
    a, b = (
        col.Vehicle(
            **{
                name.partition(".")[2]: value
                for name, value in columns.items()
                if name.startswith(f"{side}.")
            }
        )
        for side in "ab"
    )
    more = {"normal": columns["normal"], **options}
    if model != "linear_central":
        more["friction"] = columns["friction"]
    if model == "eccentric":
        more["point"] = (columns["point[0]"], columns["point[1]"])
    return getattr(col, model)(a, b, columns["restitution"], **more)


@every_model
@examples()
@given(data=st.data())
def test_a_case_of_a_batch_is_the_case_alone(model: str, data: Any) -> None:
    """Each ordinary case of a batch has the status and, to rounding, the numbers it has alone."""
    columns = data.draw(batches(model))
    many = must_answer("batch", lambda: solve(model, columns, on_failure="nan"))
    for i in range(4):
        alone = attempt(
            "alone",
            lambda i=i: solve(model, {name: float(value[i]) for name, value in columns.items()}),
        )
        status = col.Status(int(many.status[i]))
        if isinstance(alone, col.CollisionsError):
            assert alone.code == status.label
            continue
        assert alone.status is status
        speeds = sum(
            abs(float(value[i])) * (1.0 if ".v" in name else 10.0)
            for name, value in columns.items()
            if ".v" in name or "rate" in name
        )
        # 1e-9 covers the promise of 8 eps kappa S_P while kappa stays below 1e5, which ordinary
        # cars and levers do.
        limits = {
            "speed": 1e-9 * speeds,
            "impulse": 1e-9 * speeds * 4e4,
            "energy": 1e-9 * speeds**2 * 4e4,
            "mass": 1e-9 * 4e4,
        }
        for name in COMPARED:
            kind = next(kind for kind in limits if kind in name) if "slip" not in name else "speed"
            assert getattr(many, name)[i] == pytest.approx(
                getattr(alone, name), rel=1e-9, abs=limits[kind]
            ), name
        for side in "ab":
            for name in MOVED:
                one, other = (
                    getattr(getattr(many, side), name)[i],
                    getattr(getattr(alone, side), name),
                )
                assert one == pytest.approx(
                    other, rel=1e-9, abs=limits["impulse" if "impulse" in name else "speed"] * 100.0
                ), (
                    side,
                    name,
                )


@every_model
@examples()
@given(data=st.data())
def test_a_spoiled_case_leaves_its_neighbours_alone(model: str, data: Any) -> None:
    """Whatever numbers one case holds, the others keep every bit of every attribute."""
    columns = data.draw(batches(model, worth=data.draw(st.sampled_from((plausible, numbers)))))
    where = data.draw(st.integers(0, 3))
    changed = data.draw(
        st.lists(st.sampled_from(sorted(columns)), min_size=1, max_size=4, unique=True)
    )
    spoiled = {name: value.copy() for name, value in columns.items()}
    for name in changed:
        spoiled[name][where] = data.draw(extreme())
    one = must_answer("whole", lambda: solve(model, columns, on_failure="nan"))
    other = must_answer("spoiled", lambda: solve(model, spoiled, on_failure="nan"))
    rest = np.arange(4) != where
    for side in (None, "a", "b"):
        owners = (one, other) if side is None else (getattr(one, side), getattr(other, side))
        for name in attributes(type(owners[0])):
            before, after = (
                must_answer(name, lambda owner=owner, name=name: getattr(owner, name))
                for owner in owners
            )
            if isinstance(before, col.Vehicle):
                before, after = ((v.vx, v.vy, v.yaw_rate) for v in (before, after))
            for left, right in zip(
                *(part if isinstance(part, tuple) else (part,) for part in (before, after)),
                strict=True,
            ):
                if (
                    isinstance(left, np.ndarray)
                    and isinstance(right, np.ndarray)
                    and left.dtype.kind in "fbiu"
                ):
                    assert left[rest].tobytes() == right[rest].tobytes(), (side, name)
                elif isinstance(left, np.ndarray):
                    assert (left[rest] == right[rest]).all(), (side, name)
