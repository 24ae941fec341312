"""What a tool author relies on: answers that travel between processes and threads, tables in and
out, and a schema.
"""

import ast
import copy
import inspect
import io
import json
import math
import pickle
import threading
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from multiprocessing import get_context
from operator import attrgetter
from pathlib import Path
from typing import get_args

import jsonschema
import numpy as np
import pandas as pd
import pint
import pytest

import collisions as col
from collisions import reconstruct, reference, travel
from collisions.impact import inputs
from collisions.impact.impact import Kind, Regime
from collisions.impact.models import BY_NAME
from collisions.kernels.status import Answer
from collisions.uncertainty import (
    Interval,
    LogNormal,
    Normal,
    Samples,
    Triangular,
    Uniform,
    propagate,
)
from fuzzing import arguments, public
from pages import GONE, put
from strategies import Nasty, other_registry

A = col.Vehicle(
    mass="1500 kg", yaw_inertia=2400.0, vx="50 km/h", x=-2.0, y=0.4, heading=0.0, name="A"
)
B = col.Vehicle(mass=1200.0, yaw_inertia=1700.0, x=2.0, y=0.0)
PINNED = col.Vehicle(mass=900.0, yaw_inertia=1200.0, x=2.0, y=0.0, pivot=(3.0, 1.0))
MANY = A.replace(vx=np.array([14.0, 12.0, -3.0]))
SCENE = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5}
CENTRAL = {"normal": 0.0, "friction": 0.5}


def slide(drag, distance):
    return {"speed": travel.speed(distance, drag=drag)}


def ranges(method):
    inputs = {"drag": Interval(0.6, 0.8), "distance": 12.0} if method == "interval" else KNOWN
    drawn = (
        {"samples": 64, "seed": 1}
        if method in ("latin_hypercube", "quasi_random", "monte_carlo")
        else {}
    )
    return propagate(slide, inputs, method=method, **drawn)


def in_radians(normal):
    """More than a turn is warned of, and remembered."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.SuspectUnitsWarning)
        return col.eccentric(A, B, 0.1, normal=normal, point=(0.0, 0.0), friction=0.5)


def pushed(speed):
    moving = col.Vehicle(mass=1500.0, vx=speed)
    return {
        "delta_v": col.linear_central(
            moving, col.Vehicle(mass=1200.0), 0.1, on_failure="nan"
        ).b.delta_v
    }


def sides(impact):
    return impact.a, impact.b


def backwards(**ends):
    return reconstruct.momentum(
        1500.0,
        1200.0,
        course_a=0.0,
        course_b="90 deg",
        course_a_after=0.3,
        course_b_after=0.7,
        **ends,
    )


KNOWN = {"drag": Uniform(0.6, 0.8), "distance": Normal(12.0, 1.0)}
FULL = col.eccentric(A, B, 0.45, **SCENE)
FORWARD = {
    "linear": lambda: col.linear_central(A.replace(y=0.0), B, 0.1),
    "linear, many": lambda: col.linear_central(MANY, B, np.array([[0.0], [1.0]]), on_failure="nan"),
    "oblique": lambda: col.oblique_central(A, B, 0.1, **CENTRAL),
    "oblique, many": lambda: col.oblique_central(MANY, B, 0.1, normal=0.0, impulse_ratio=-0.2,
    on_failure="nan"),
    "eccentric": lambda: FULL,
    "eccentric, many": lambda: col.eccentric(
        MANY, B, 0.1, law="kudlich-slibar", on_failure="nan",
        **SCENE | {"friction": np.array([0.0, 0.5, 9.0])}
    ),
    "time-resolved": lambda: col.time_resolved(A, B, 0.1, duration="100 ms", drag=0.7,
    **SCENE | {"friction": 0.4}),
    "time-resolved, many": lambda: col.time_resolved(
        MANY, B, 0.1, crush_a=("60 kN/m", 7e5, 1.5), geometry="fixed", on_failure="nan",
        **SCENE | {"friction": 0.4}
    ),
    "single precision": lambda: col.eccentric(A.replace(vx=np.float32([14, -3])), B,
    np.float32([0, 1]), on_failure="nan", **SCENE),
    "pinned": lambda: col.eccentric(A, PINNED, 0.1, normal=0.0, point=(0.0, 0.0),
    critical_fraction=1.0),
    "wall": lambda: col.eccentric(A, col.Vehicle.barrier(), 0.1, normal=0.0, point=(0.0, 0.0),
    friction=math.inf),
    "frictionless": lambda: col.eccentric(A, B, 1.0, normal="10 deg", point=(0.0, 0.0), friction=0),
    "bare angles": lambda: in_radians(np.array([12.6, 0.1])),
    "no slip would pull": lambda: col.eccentric(A, PINNED, 0.0, normal=np.array([0.0, 3.0]),
    point=(0.0, 0.0), friction=0.3, on_failure="nan"),
    "refused": lambda: col.linear_central(B, A.replace(y=0.0), 0.1, on_failure="nan"),
    "nothing": lambda: col.linear_central(A.replace(y=0.0), B, np.array([])),
    "solve": lambda: col.solve(A, B, 0.1, tolerance="1 km/h", **SCENE),
    "solve, in line": lambda: col.solve(A.replace(y=0.0), B, 0.1, tolerance="1 km/h", **SCENE),
    "solve, many": lambda: col.solve(MANY, B, 0.1, tolerance=np.array([0.0, 5.0, 5.0]),
    on_failure="nan", **SCENE),
    "central": lambda: reconstruct.central(1500.0, 1200.0, va=10.0, vb=0.0, restitution=0.1),
    "central, many": lambda: reconstruct.central(
        1500.0, 1200.0, va=np.array([10.0, 5.0]), vb=0.0, vb_after=8.0, on_failure="nan"
    ),
    "planar": lambda: reconstruct.planar(
        FULL.a.after, FULL.b.after, restitution=0.45, normal=0.0, point=(0.0, 0.0),
        impulse_ratio=FULL.impulse_ratio
    ),
    "speeds": lambda: reconstruct.speeds(
        A, B, course_a=0.0, course_b=None, speed_b=0.0, delta_v_b="10 km/h", restitution=0.1,
        **SCENE
    )[0],
}  # fmt: skip
OTHERS = {
    "a vehicle": lambda: A,
    "vehicles": lambda: (MANY, PINNED, col.Vehicle.barrier()),
    "sides": lambda: [repr(side) for side in sides(FULL)],
    "choice": lambda: col.required_model(MANY, B, 0.1, **SCENE),
    "momentum": lambda: backwards(speed_a_after=8.0, speed_b_after=9.0),
    "run-out": lambda: travel.path([(0.0, 0.0), (5.0, 1.0)], [0.0, 0.3], friction=0.7, lock=1),
    "left out": lambda: col.left_out(FULL, duration=0.1, drag=0.7),
    "findings": lambda: col.diagnose(FULL),
    "published": lambda: (reference.PUBLISHED, reference.FITS),
    "a fit": lambda: reconstruct.fit(pushed, {"speed": Interval(5.0, 30.0)},
    {"delta_v": Normal(8.0, 0.5)}),
    "inputs": lambda: [
        Normal("25 deg", "3 deg"), Normal(0.1, 0.1, truncate=(0, 1)), Uniform(0, 1),
            Triangular(0, 1, 2),
        LogNormal.between("0.5 s", "2 s", 0.9), Samples([1.0, 2.0]), Interval(0, 1),
    ],
    **{method: partial(ranges, method) for method in (
        "first_order", "second_order", "latin_hypercube", "quasi_random", "monte_carlo", "interval",
    )},
}  # fmt: skip
ERRORS = {
    col.NoImpactError: lambda: col.linear_central(A.replace(vx=-3.0, y=0.0), B, 0.1),
    col.MissingInputError: lambda: col.eccentric(A.replace(yaw_inertia=None), B, 0.1, **SCENE),
    col.UnitsError: lambda: col.Vehicle(mass="1500 kg 5"),
    col.ShapeError: lambda: col.linear_central(MANY, B, np.zeros(2)),
    col.AmbiguousSolutionError: lambda: reconstruct.central(
        1500.0, 2500.0, va=25.0, vb_after=15.0, energy_loss=150e3
    ),
    col.NoSolutionError: lambda: reconstruct.planar(
        FULL.a.after, FULL.b.after, restitution=0.45, **SCENE
    ),
    col.InputError: lambda: col.linear_central(A, B, 1.5),
}
SCHEMA = col.impact_schema()
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)


def equal(one, other):
    """By value; what has no equality of its own is compared as it is shown."""
    return one == other or repr(one) == repr(other)


# Across processes.


@pytest.fixture(scope="module")
def process():
    """A worker that was started by spawn, which inherits nothing."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as executor:
        yield executor


@pytest.mark.parametrize("name", [*FORWARD, *OTHERS])
def test_every_answer_can_be_copied_and_pickled(name):
    """Equal to the original, by pickle at every protocol and by both kinds of copy."""
    answer = {**FORWARD, **OTHERS}[name]()
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        assert equal(pickle.loads(pickle.dumps(answer, protocol)), answer)
    assert equal(copy.copy(answer), answer)
    assert equal(copy.deepcopy(answer), answer)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*FORWARD, *OTHERS])
def test_every_answer_crosses_to_a_spawned_process_and_back(process, name):
    """The copy that comes back was made by an interpreter that had to import what it needs by
    itself.
    """
    answer = {**FORWARD, **OTHERS}[name]()
    assert equal(process.submit(copy.copy, answer).result(), answer)


@pytest.mark.parametrize("name", FORWARD)
def test_every_attribute_is_the_same_after_the_journey(name):
    """Worked out anew from what was pickled, to the bit; arrays are locked again."""
    impact = FORWARD[name]()
    again = pickle.loads(pickle.dumps(impact))
    assert repr(again.to_columns()) == repr(impact.to_columns())
    assert json.dumps(again.to_dict(), sort_keys=True) == json.dumps(
        impact.to_dict(), sort_keys=True
    )
    for value in (again.normal_impulse, again.a.delta_v, again.a.after.vx, again.a.before.vx):
        if isinstance(value, np.ndarray):
            assert not value.flags.writeable


@pytest.mark.slow
@pytest.mark.parametrize("kind", ERRORS)
def test_errors_keep_their_fields(process, kind):
    """Code, message and fields, through pickle, copy and a worker that raises; the answers of an
    ambiguous case among them.
    """
    with pytest.raises(kind) as caught:
        ERRORS[kind]()
    error = caught.value
    assert type(error) is kind
    assert error.code
    for again in (
        pickle.loads(pickle.dumps(error)),
        copy.deepcopy(error),
        process.submit(copy.copy, error).result(),
    ):
        assert type(again) is kind
        assert (str(again), again.code) == (str(error), error.code)
        assert equal(again.fields, error.fields)
        assert (
            again != error
        )  # as the page says: like every exception of Python it is equal only to itself
    if kind is col.AmbiguousSolutionError:
        assert len(pickle.loads(pickle.dumps(error)).solutions) == 2


@pytest.mark.slow
def test_a_worker_raises_what_a_caller_would_see(process):
    """The solver itself as the task; its refusal arrives whole."""
    with pytest.raises(col.NoImpactError) as caught:
        process.submit(col.linear_central, A.replace(vx=-3.0, y=0.0), B, 0.1).result()
    assert caught.value.closing_speed == -3.0


def test_warnings_keep_their_fields():
    """A warning is pickled like an error."""
    with pytest.warns(col.CollisionsWarning) as caught:
        col.linear_central(MANY.replace(y=0.0), B, 0.1)
    warning = caught[0].message
    again = pickle.loads(pickle.dumps(warning))
    assert (type(again), again.code, again.fields) == (
        type(warning),
        "refused_cases",
        {"counts": {"separating": 1}},
    )


@pytest.mark.slow
def test_the_typed_caller_uses_every_public_function():
    """As the page says of ``tests/typing/caller.py``, which type checkers read: by its module, or
    by its name as a method.
    """
    tree = ast.parse(
        (Path(__file__).parent.parent / "typing" / "caller.py").read_text(encoding="utf-8")
    )
    read = [ast.unparse(node) for node in ast.walk(tree) if isinstance(node, ast.Attribute)]
    used = {name.removeprefix("col.") for name in read}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("collisions."):
            used |= {
                f"{node.module.removeprefix('collisions.')}.{alias.name}" for alias in node.names
            }
    methods, unused = {name.rpartition(".")[2] for name in read}, []
    for name, value in public().items():
        owner, _, inner = name.rpartition(".")
        if inspect.isclass(value) and not arguments(name):
            continue
        if inner not in methods if inspect.isclass(public().get(owner)) else name not in used:
            unused.append(name)
    assert not unused, f"use these in tests/typing/caller.py: {', '.join(unused)}"


def test_labels_are_those_that_type_checkers_know():
    """A comparison with another one fails a type check; none that can come out is missing, and none
    is too many.
    """
    e = np.array([0.0, 0.5, 1.0, -0.1])
    kinds = set(col.linear_central(A.replace(y=0.0), B, e, incomplete=True).kind)
    assert {*kinds, ""} == set(get_args(Kind))
    lever = A.replace(y=1.0, vy=2.0)
    contact = {"normal": 0.0, "point": (0.0, 0.0)}
    found = {col.eccentric(lever, B, 0.1, friction=mu, **contact).regime for mu in (0.0, 0.05, 9.0)}
    found |= {col.eccentric(A, B, 0.1, impulse_ratio=0.1, **contact).regime}
    found |= set(
        col.eccentric(
            A.replace(vx=-1.0), B, [0.1], friction=0.5, on_failure="nan", **contact
        ).regime
    )
    reversing = col.eccentric(
        A.replace(yaw_rate=np.linspace(-9.0, 9.0, 200), vy=1.0),
        B,
        0.9,
        friction=np.linspace(0.05, 1.0, 40)[:, None],
        law="stronge",
        on_failure="nan",
        **contact,
    )
    found |= set(np.ravel(reversing.regime))
    assert found == set(get_args(Regime))
    assert set(get_args(inputs.ModelName)) == set(BY_NAME) - {"solve"}


@pytest.mark.slow
@pytest.mark.parametrize("name", FORWARD)
def test_a_column_asked_for_is_that_of_the_whole_table(name):
    """Each by itself, whatever else of the impact was worked out."""
    for column, values in FORWARD[name]().to_columns().items():
        alone = FORWARD[name]().to_columns(columns=column)
        assert repr(alone) == repr({column: values})


def test_columns_take_no_answer_that_was_not_asked_for():
    """Each answer that is worked out stays with the impact: 8 bytes a case."""
    impact = pickle.loads(pickle.dumps(FORWARD["eccentric, many"]()))
    kept, of_side = {*vars(impact)}, {*vars(impact.a)}
    impact.to_columns(columns=["a.delta_v", "a.before.mass", "normal.x", "energy_loss"])
    assert vars(impact).keys() - kept - {"a", "b", "status"} == {"normal", "energy_loss"}
    of_side |= {"before", "delta_vx", "delta_vy", "delta_v"}
    assert vars(impact.a).keys() <= of_side
    impact.to_columns()
    assert "pdof" in vars(impact.a)


def test_columns_asked_for_by_what_cannot_be_gone_through_are_refused():
    """Found by the fuzz: an object whose iterator raises was let through to its own error."""
    with pytest.raises(col.InputError, match="columns: there is no column"):
        FULL.to_columns(columns=Nasty())
    assert list(FULL.to_columns(columns=(name for name in ("a.delta_v", "status")))) == [
        "a.delta_v",
        "status",
    ]


@pytest.mark.slow
def test_contacts_in_time_hold_the_bits_of_the_whole_in_blocks_of_more_than_128():
    """As the page for tool authors says: up to 128 cases are followed one by one, and their last
    digits may differ.
    """
    rng = np.random.default_rng(35)
    speeds, places = rng.uniform(2.0, 20.0, 300), rng.normal(0.0, 0.4, 300)

    def followed(part):
        rear = A.replace(vx=speeds[part], y=places[part])
        found = col.time_resolved(
            rear, B, 0.2, duration=0.1, drag=0.7, steps=20, on_failure="nan", **SCENE
        )
        return np.array([found.energy_loss, found.b.delta_v, found.b.delta_yaw_rate])

    whole = followed(slice(None))
    np.testing.assert_array_equal(
        np.hstack([followed(slice(0, 129)), followed(slice(129, 300))]), whole
    )
    by_one = np.hstack([followed(slice(start, start + 100)) for start in (0, 100, 200)])
    assert not np.array_equal(by_one, whole, equal_nan=True)
    np.testing.assert_allclose(by_one, whole, rtol=1e-12, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("size", [1, 7, 1000])
def test_blocks_in_another_process_hold_the_bits_of_the_whole(process, size):
    """Wherever a batch is cut, and whatever process has the part."""
    rng = np.random.default_rng(size)
    speeds, places, normals = (
        rng.uniform(1.0, 20.0, 2500),
        rng.normal(0.0, 0.4, 2500),
        rng.normal(0.0, 0.2, 2500),
    )
    solve = partial(col.eccentric, point=(0.0, 0.0), friction=0.3, on_failure="nan")
    whole = solve(A.replace(vx=speeds, y=places), B, 0.2, normal=normals)
    starts = range(0, 2500, size) if size > 7 else [0, 1, 1111, 2500 - size]
    for start in starts:
        part = slice(start, start + size)
        rear = A.replace(vx=speeds[part], y=places[part])
        found = process.submit(solve, rear, B, 0.2, normal=normals[part]).result()
        for mine, wanted in zip(found._answer, whole._answer, strict=True):
            np.testing.assert_array_equal(mine, wanted[part])


# Across threads.


def at_once(count, task):
    """The answers of a task in threads that begin together."""
    gate = threading.Barrier(count)

    def started(_):
        gate.wait()
        return task()

    with ThreadPoolExecutor(count) as executor:
        return list(executor.map(started, range(count)))


@pytest.mark.parametrize("threads", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_eight_threads_find_the_same_bits(threads):
    """The same batch at once, also where every call has threads of its own."""
    rng = np.random.default_rng(3)
    many = A.replace(vx=rng.uniform(1.0, 20.0, 50_000), y=rng.normal(0.0, 0.4, 50_000))
    wanted = col.eccentric(many, B, 0.2, **SCENE)
    for found in at_once(8, lambda: col.eccentric(many, B, 0.2, threads=threads, **SCENE)):
        for mine, other in zip(found._answer, wanted._answer, strict=True):
            np.testing.assert_array_equal(mine, other)


@pytest.mark.slow
def test_one_answer_may_be_read_in_eight_threads():
    """What is worked out when first read is the same for all who read at once."""
    names = (
        "regime",
        "kind",
        "impulse_ratio",
        "a.after.speed",
        "b.pdof",
        "a.delta_v",
        "energy_absorbed",
        "q.b.delta_v",
    )
    for _ in range(20):
        impact = col.eccentric(MANY, B.replace(heading=0.0), 0.1, on_failure="nan", **SCENE)
        wanted = [repr(attrgetter(name)(FORWARD_MANY)) for name in names]
        assert (
            at_once(8, lambda i=impact: [repr(attrgetter(name)(i)) for name in names])
            == [wanted] * 8
        )


FORWARD_MANY = col.eccentric(MANY, B.replace(heading=0.0), 0.1, on_failure="nan", **SCENE)


@pytest.mark.slow
def test_no_warning_is_lost_between_threads():
    """Every call warns of its own refused cases, also while others are silent because they count
    their cases themselves.
    """
    calls = 25

    def warned():
        for _ in range(calls):
            col.linear_central(MANY.replace(y=0.0), B, 0.1)

    def silent():
        for _ in range(calls):
            propagate(pushed, {"speed": Normal(1.0, 2.0)}, method="monte_carlo", samples=64, seed=1)

    tasks = [warned, silent] * 4
    with warnings.catch_warnings(record=True) as caught, ThreadPoolExecutor(8) as executor:
        warnings.simplefilter("always")
        list(executor.map(lambda task: task(), tasks))
    refused = [
        entry
        for entry in caught
        if entry.message.code == "refused_cases" and "on_failure" in str(entry.message)
    ]
    assert len(refused) == 4 * calls


@pytest.mark.slow
def test_the_first_unit_may_appear_in_several_threads():
    """Units are learnt once a registry; eight threads that read the same one for the first time
    agree.
    """
    registry = pint.UnitRegistry()
    for unit in ("knot", "furlong/fortnight", "km/min"):
        given = registry.Quantity(3.0, unit)
        found = at_once(8, lambda given=given: col.Vehicle(mass=1.0, vx=given).vx)
        assert set(found) == {found[0]}


# Tables.


TABLE = """\
case,mass [lb],speed [mph],e
x1,3000,30,0.1
x2,,30,0.1
x3,2800,-5,0.2
x4,2500,40,
"""


def test_rows_become_a_batch_and_a_batch_rows():
    """One unit a column; the index stays; a missing cell refuses its row alone and says why."""
    table = pd.read_csv(io.StringIO(TABLE), index_col="case")
    a = col.Vehicle(
        mass=pint.Quantity(table["mass [lb]"].to_numpy(), "lb"),
        vx=pint.Quantity(table["speed [mph]"].to_numpy(), "mph"),
    )
    impact = col.linear_central(a, B.replace(y=0.0), table["e"], on_failure="nan")
    answers = pd.DataFrame(impact.to_columns(), index=table.index)
    assert list(answers.index) == ["x1", "x2", "x3", "x4"]
    assert list(answers["status"]) == ["ok", "not_finite", "separating", "bad_restitution"]
    assert list(answers["refused"]) == [False, True, True, True]
    # Alone, the first row is the same case; 4 eps is what is promised of the delta-V.
    one = col.linear_central(col.Vehicle(mass="3000 lb", vx="30 mph"), B, 0.1)
    assert answers.loc["x1", "b.delta_v"] == pytest.approx(one.b.delta_v, rel=4 * 2.0**-52)
    assert (
        answers.loc[["x2", "x3", "x4"], ["b.delta_v", "a.after.vx", "energy_loss"]]
        .isna()
        .all(axis=None)
    )


def test_missing_cells_warn_or_raise_as_any_refused_case():
    """Without on_failure= one warning counts them; with "raise" the first is named by its place."""
    masses = np.array([1000.0, math.nan])
    with pytest.warns(
        col.CollisionsWarning, match=r"1 of 2 cases were refused and are NaN \(1 not_finite\)"
    ):
        col.linear_central(col.Vehicle(mass=masses, vx=10.0), B, 0.1)
    with pytest.raises(col.InputError, match="case 1") as caught:
        col.linear_central(col.Vehicle(mass=masses, vx=10.0), B, 0.1, on_failure="raise")
    assert caught.value.code == "not_finite"


def test_columns_that_hold_no_numbers_are_refused_by_name():
    """Texts with units in the cells are refused; missing cells of a nullable type of pandas are
    turned into NaN by hand.
    """
    with pytest.raises(col.InputError, match="mass is an array of") as caught:
        col.Vehicle(mass=pd.Series(["1000 kg", "1200 kg"]))
    assert caught.value.code == "not_a_number"
    nullable = pd.Series([1000.0, None], dtype="Float64").to_numpy(float, na_value=np.nan)
    assert np.isnan(col.Vehicle(mass=nullable).mass[1])


def test_series_are_taken_by_position():
    """What pandas would align by its index is taken row by row, like any array."""
    first, second = (
        pd.Series([10.0, 20.0], index=["x", "y"]),
        pd.Series([1.0, 2.0], index=["y", "x"]),
    )
    vehicle = col.Vehicle(mass=1.0, vx=first, vy=second)
    assert (list(vehicle.vx), list(vehicle.vy)) == ([10.0, 20.0], [1.0, 2.0])


@pytest.mark.parametrize("name", FORWARD)
def test_every_impact_fits_in_a_table(name):
    """One row a case, whatever the solver; numbers are floats, words are words."""
    impact = FORWARD[name]()
    frame = pd.DataFrame(impact.to_columns())
    assert len(frame) == np.size(impact.status)
    if len(frame):
        assert frame["closing_speed"].dtype == np.float64
        assert isinstance(frame["status"].iloc[0], str)


# The schema of a record.


def strict(impact):
    """A record after strict JSON."""
    return json.loads(json.dumps(impact.to_dict(), allow_nan=False))


@pytest.mark.slow
def test_the_schema_is_one():
    """Of draft 2020-12, plain data, and each time a new dict."""
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    assert SCHEMA["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert json.loads(json.dumps(SCHEMA, allow_nan=False)) == SCHEMA
    assert col.impact_schema() == SCHEMA
    assert col.impact_schema() is not SCHEMA


@pytest.mark.slow
@pytest.mark.parametrize("name", FORWARD)
def test_every_record_validates(name):
    """Every solver, alone and in a batch, forward and backward, refused cases among them."""
    impact = FORWARD[name]()
    record = strict(impact)
    VALIDATOR.validate(record)
    assert record["format"] == SCHEMA["properties"]["format"]["const"]
    VALIDATOR.validate(strict(col.Impact.from_dict(record)))


def test_a_batch_with_a_normal_that_is_no_angle_has_a_record():
    """Its case is refused, and the record is read back without a warning of numpy."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, vx=10.0, x=-2.0, y=0.0)
    b = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=2.0, y=0.0)
    contact = {"point": (0.0, 0.0), "friction": 0.3, "on_failure": "nan"}
    for kind in (np.float32, np.float64):
        normal = np.array([0.0, math.inf], kind)
        impact = col.eccentric(a, b, 0.1, normal=normal, **contact)
        assert list(impact.ok) == [True, False]
        assert col.Impact.from_dict(strict(impact)) == impact


@pytest.mark.slow
def test_records_together_reach_every_part_of_the_schema():
    """Each result is somewhere a number, somewhere a batch, and each that may be missing is
    somewhere missing.
    """
    records = [strict(make()) for make in FORWARD.values()]
    for name, described in SCHEMA["properties"]["results"]["properties"].items():
        found = [record["results"][name] for record in records]
        if {"type": "null"} in described.get("anyOf", ()):
            assert None in found, name
        if name not in ("a", "b", "reconstruction", "choice", "law", "point", "normal"):
            assert any(isinstance(value, dict) for value in found), name
            assert any(not isinstance(value, dict) for value in found), name
    assert {record["inputs"]["model"] for record in records} == set(
        SCHEMA["properties"]["inputs"]["properties"]["model"]["enum"]
    )


def changed(path, value):
    """A good record with one part replaced, or taken out."""
    return put(strict(FORWARD["eccentric, many"]()), path, value)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("path", "value"),
    [
        (["format"], "collisions impact 0"),
        (["format"], GONE),
        (["results"], GONE),
        (["units"], "US"),
        (["inputs", "model"], "newton"),
        (["inputs", "rule"], "mu"),
        (["inputs", "law"], "newton"),
        (["inputs", "law"], GONE),
        (["inputs", "point"], [0.0]),
        (["inputs", "point"], [0.0, 0.0, 0.0]),
        (["inputs", "normal"], 0.0),
        (["results", "restitution"], "20 %"),
        (["inputs", "restitution"], True),
        (["results", "a", "before", "mass"], "1500 kg"),
        (["inputs", "a", "speed"], "20 m/s"),
        (["inputs", "a", "mass"], GONE),
        (["inputs", "a", "vx"], [14.0, 12.0, -3.0]),
        (["inputs", "a", "vx", "dtype"], "float16"),
        (["inputs", "a", "vx", "shape"], [-3]),
        (["inputs", "a", "vx", "values"], GONE),
        (["inputs", "a", "vx", "values", 1], "infinity"),
        (["inputs", "a", "velocity"], 3.0),
        (["inputs", "a", "name"], 3),
        (["results", "status", "values", 0], 99),
        (["results", "status", "values", 0], "ok"),
        (["results", "regime", "values", 0], "rolling"),
        (["results", "ok", "values", 0], 1),
        (["results", "energy_loss"], GONE),
        (["results", "energy"], 3.0),
        (["results", "a", "delta_v"], "nothing"),
        (["results", "b", "after", "vx"], GONE),
        (["results", "choice"], "solve"),
        (["results", "reconstruction"], {"method": "central"}),
    ],
)  # fmt: skip
def test_the_schema_refuses_what_is_no_record(path, value):
    """A wrong name, type, word, or length anywhere in it; the same record is good without the
    change.
    """
    assert VALIDATOR.is_valid(strict(FORWARD["eccentric, many"]()))
    assert not VALIDATOR.is_valid(changed(path, value))


def test_a_law_and_a_point_belong_to_the_models_that_know_them():
    """linear_central has no law, and the central models no point."""
    record = strict(FORWARD["linear"]())
    record["inputs"]["law"] = "brach"
    assert not VALIDATOR.is_valid(record)
    for name in ("linear", "oblique"):
        record = strict(FORWARD[name]())
        record["inputs"]["point"] = [0.0, 0.0]
        assert not VALIDATOR.is_valid(record)
    record = strict(FULL)
    record["inputs"]["point"] = None
    assert not VALIDATOR.is_valid(record)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("part", "value"), [("shape", [2]), ("values", [14.0, 12.0]), ("shape", [1, 1, 4])]
)
def test_what_a_schema_cannot_say_is_refused_when_read(part, value):
    """A list that is not as long as its shape, and arrays that do not go together."""
    record = changed(["inputs", "a", "vx", part], value)
    VALIDATOR.validate(record)
    with pytest.raises(col.InputError):
        col.Impact.from_dict(record)
    several = changed(
        ["inputs", "restitution"], {"dtype": "float64", "shape": [2], "values": [0.1, 0.2]}
    )
    VALIDATOR.validate(several)
    with pytest.raises(col.ShapeError, match="do not broadcast together"):
        col.Impact.from_dict(several)


def test_every_attribute_is_in_the_schema():
    """What an impact and its sides work out, and the outputs of the kernels under their
    own names.
    """
    results = SCHEMA["properties"]["results"]["properties"]
    side = SCHEMA["$defs"]["side"]["properties"]
    assert {
        "closing_speed",
        "status",
        "regime",
        "energy_loss",
        "choice",
        "a",
        "b",
    } <= results.keys()
    assert {"delta_v", "pdof", "pdof_clock", "after", "at_compression"} <= side.keys()
    assert results["energy_loss"]["description"].startswith("Energy dissipated [J]")
    inner = {"no_slip_normal", "no_slip_tangential", "sticks", "coupling"}
    assert {
        name for name in Answer._fields if not name.startswith(("delta_", "impulse_"))
    } - inner <= results.keys()


# How a record says its inputs were given.


def refused(**changes):
    """Two bodies that lose no energy with a restitution of 1 percent: the answer is none."""
    given = {"va": 0.0, "restitution": "1.0 %", "energy_loss": 0.0, "on_failure": "nan"}
    return reconstruct.central(300.0, 300.0, **(given | changes))


@pytest.mark.parametrize("loss", [0.0, [0.0, 1000.0], [[1000.0], [0.0]]])
def test_a_refused_answer_of_a_reverse_solver_is_read_back(loss):
    """It does not hold the restitution that was given."""
    impact = refused(energy_loss=loss)
    assert np.any(impact.refused)
    record = strict(impact)
    again = col.Impact.from_dict(record)
    assert again == impact
    assert strict(again) == record


def silent(call):
    """The answer, without the warnings about its inputs."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        return call()


def test_each_input_stands_in_a_record_once_as_it_was_given():
    """As its text, or as its number; speed and course in place of vx and vy; its number in SI
    stands in the results.
    """
    a = col.Vehicle.from_speed(
        mass="1100 kg", speed="80 km/h", course=0.3, x=-1, y="0 in", yaw_inertia=1800.0, name="A"
    )
    pound = other_registry().Quantity(2000.0, "lb")
    b = silent(
        lambda: col.Vehicle(
            mass=pound, x=1.0, y=0.0, yaw_inertia=1500.0, yaw_rate=25.0, pivot=("3 m", 0.0)
        )
    )
    impact = silent(
        lambda: col.eccentric(a, b, "10 %", normal="10 deg", point=("1 in", 0.0), friction=math.inf)
    )
    inputs = strict(impact)["inputs"]
    assert {name: inputs["a"][name] for name in ("mass", "speed", "course", "x", "y", "name")} == {
        "mass": "1100 kg", "speed": "80 km/h", "course": "0.3 rad", "x": -1.0, "y": "0 in",
        "name": "A"
    }  # fmt: skip
    assert inputs["a"].keys().isdisjoint({"vx", "vy"})
    assert (inputs["b"]["mass"], inputs["b"]["pivot"]) == ("2000.0 pound", ["3 m", 0.0])
    assert (inputs["restitution"], inputs["point"], inputs["rule_value"]) == (
        "10 %",
        ["1 in", 0.0],
        "inf",
    )
    with warnings.catch_warnings():
        # What is suspect was said when it was given.
        warnings.simplefilter("error")
        again = col.Impact.from_dict(strict(impact))
    assert again == impact
    assert strict(again) == strict(impact)
    before = strict(impact)["results"]["a"]["before"]
    assert (before["mass"], before["vx"], before["y"]) == (1100.0, impact.a.before.vx, 0.0)


@pytest.mark.slow
def test_a_unit_that_only_its_own_registry_knows_stands_as_a_number():
    """Its text could not be read again."""
    own = pint.UnitRegistry()
    own.define("stonecar = 1500 kg")
    impact = col.linear_central(
        col.Vehicle(mass=own.Quantity(1.0, "stonecar"), vx=10.0), col.Vehicle(mass=900.0), 0.1
    )
    record = strict(impact)
    assert record["inputs"]["a"]["mass"] == 1500.0
    assert col.Impact.from_dict(record) == impact


OWN_UNITS = ("own_m = {} m", "own_kg = {} kg", "own_s = {} s", "own_angle = {} degree")
IN_OWN_UNITS = {
    "a.mass": {"a": {"mass": "1500 own_kg"}},
    "a.vx": {"a": {"vx": "15 own_m/s"}},
    "a.vx of its speed": {"a": {"speed": "15 own_m/s", "course": "5 deg"}},
    "b.vx of its course": {"b": {"speed": "3 m/s", "course": "5 own_angle"}},
    "b.yaw_inertia": {"b": {"yaw_inertia": "1500 kg*own_m**2"}},
    "b.heading": {"b": {"heading": "30 own_angle"}},
    "b.pivot": {"b": {"pivot": (2.5, "1 own_m")}},
    "normal": {"normal": "10 own_angle"},
    "point": {"point": (1.0, "0.25 own_m")},
}


def in_own_units(a=None, b=None, **contact):
    vehicle = {"mass": 1200.0, "yaw_inertia": 1500.0, "x": 0.0, "y": 0.0}
    golf = {**vehicle, **({} if "speed" in (a or {}) else {"vx": 15.0}), **(a or {})}
    polo = {**vehicle, "x": 3.0, **(b or {})}
    made = (
        col.Vehicle.from_speed(**body) if "speed" in body else col.Vehicle(**body)
        for body in (golf, polo)
    )
    return col.eccentric(
        *made,
        **{"restitution": 0.1, "normal": 0.0, "point": (1.0, 0.2), "friction": 0.4, **contact},
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "what",
    [
        name if name == "a.vx" else pytest.param(name, marks=pytest.mark.slow)
        for name in IN_OWN_UNITS
    ],
)
def test_a_unit_that_has_changed_since_the_record_was_written_is_refused(what):
    """A text would read as another number than the one that was solved; a record must never do that
    without a word.
    """
    before = pint.get_application_registry().get()
    records = []
    try:
        for size in (1.0, 1.0, 0.95):
            registry = pint.UnitRegistry()
            for line in OWN_UNITS:
                registry.define(line.format(size))
            pint.set_application_registry(registry)
            if size == 1.0:
                impact = in_own_units(**IN_OWN_UNITS[what])
                records.append(strict(impact))
                assert "own_" in json.dumps(records[0]["inputs"])
                assert all(col.Impact.from_dict(record) == impact for record in records)
        with pytest.raises(
            col.InputError,
            match=rf"{what.partition(' ')[0]} was given as .* its unit means something else",
        ) as caught:
            col.Impact.from_dict(records[0])
        assert caught.value.code == "bad_record"
    finally:
        pint.set_application_registry(before)


def test_only_what_a_reverse_solver_takes_can_have_been_given():
    """Texts of what it takes are read again; others, and any of a forward solver, are refused."""
    record = strict(reconstruct.central(1500.0, 1200.0, va="10 m/s", vb=0.0, vb_after="6 m/s"))
    assert record["inputs"]["known"] == {"vb_after": "6 m/s"}
    assert strict(col.Impact.from_dict(record)) == record
    forward = strict(FORWARD["linear"]())
    for owner, name in ((record, "closing_speed"), (record, "tyres"), (forward, "energy_loss")):
        owner["inputs"]["known"] = {name: "5"}
        with pytest.raises(col.InputError) as caught:
            col.Impact.from_dict(owner)
        assert caught.value.code == "bad_record"
        assert f"it has no '{name}' that could have been given" in str(caught.value)
    record["inputs"]["known"] = {"vb_after": 5.0}
    with pytest.raises(col.InputError, match="is no dict of texts"):
        col.Impact.from_dict(record)


def test_a_record_of_a_version_without_tyres_replays():
    """What came later and was not given may be missing from what was asked."""
    impact = col.eccentric(
        col.Vehicle(mass=1500.0, vx=13.9, yaw_inertia=2400.0, x=-2.0, y=0.4),
        col.Vehicle(mass=1200.0, vy=11.1, yaw_inertia=1700.0, x=0.8, y=-1.2),
        0.1,
        normal=0.1,
        point=(0.0, 0.0),
        friction=0.5,
    )
    record = impact.to_dict()
    for name in ("tyres_a", "tyres_b"):
        del record["inputs"][name]
    assert col.Impact.from_dict(record) == impact
