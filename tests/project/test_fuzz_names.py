"""Every public name under arbitrary arguments: an answer that is finite or documented, or a
CollisionsError; nothing else.

The list of public names is the list of what is fuzzed: a name that is added and not fuzzed fails
here.
"""

from __future__ import annotations

import contextlib
import copy
import functools
import itertools
import json
import math
import pickle
from typing import Any
from unittest import mock

import matplotlib.pyplot as plt
import numpy as np
import pytest

import collisions as col
from collisions import plot, reconstruct, reference, reporting, scene, travel, uncertainty
from collisions.diagnostics import LIMITS
from collisions.estimate import posterior
from collisions.travel import motion as motion_of_wheels
from fuzzing import (
    AGAIN,
    FUZZED,
    INCOMPLETE,
    Case,
    arguments,
    fuzzes,
    incomplete,
    load_units,
    public,
)
from strategies import RANGES, registries

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module", autouse=True)
def _pint_loaded() -> None:
    load_units()


def test_every_public_name_is_fuzzed() -> None:
    """What is public and what the tests below declare are one list."""
    names = set(public())
    missing, stray = sorted(names - FUZZED.keys()), sorted(FUZZED.keys() - names)
    assert not missing, (
        f"no fuzz test declares {missing}: call them in a test under @fuzzes(...) in {__name__}"
    )
    assert not stray, f"{stray} are fuzzed, but not public"


def test_what_callers_pass_is_known_to_the_last_argument() -> None:
    """Those that ** stands for are named, so that none of them is left out; an impact is solved
    again by all of its solver's.
    """
    for name, takes in AGAIN.items():
        assert set(takes) == arguments(name) - {"on_failure", "threads", "progress"}, name
    assert {"mass", "name", "pivot"} < arguments("Vehicle.replace")
    assert {"message", "code"} == arguments("InputError")
    assert not arguments("reconstruct.Fit")


# --- states and impacts ---------------------------------------------------------------------------

BODY = ("mass", "vx", "vy", "yaw_rate", "yaw_inertia", "x", "y", "heading")
NAMES = ("", "", "A", "Golf", "<b>&amp;|$x_1$", "a\nb", "\ud800half", "中文 " * 12, "`~~~ ```")
SOLVERS = ("linear_central", "oblique_central", "eccentric", "solve", "time_resolved")
PLACED = ("eccentric", "solve", "time_resolved")
# In a plain answered case these may be no finite number: what each says of it.
OPEN = frozenset(
    {
        "Vehicle.mass", "Vehicle.yaw_inertia", "Vehicle.course", "Vehicle.momentum",
        "Vehicle.kinetic_energy",
        "VehicleResult.impulse_direction", "VehicleResult.pdof", "VehicleResult.pdof_clock",
        "Impact.impulse_ratio", "Impact.critical_impulse_ratio", "Impact.friction",
        "reconstruct.Reconstruction.condition", "reconstruct.Reconstruction.answers",
        "reconstruct.Reconstruction.given", "reconstruct.Reconstruction.slip_if_stuck", "ByModel",
        "ModelChoice.errors", "Inputs.rule_value",
    }
)  # fmt: skip


def run_options(case: Case) -> dict[str, Any]:
    """How a run is carried out; in an odd case at times anything that is no function, which may
    raise what it likes.
    """
    reports: list[tuple[int, int]] = []
    found = {
        "threads": case.choice((1, 2)),
        "progress": case.choice((None, False, True, lambda *done: reports.append(done))),
    }
    if case.mood == "odd" and case.maybe(0.5):
        found[case.choice(sorted(found))] = case.choice((1, 2, 0, None, False, "x", 1.5, -1))
    return {name: found[name] for name in found if case.maybe(0.7)}


def vehicle(case: Case, **near: float) -> col.Vehicle:
    """A vehicle that can be made, with these numbers if the case is a plain one."""
    if case.maybe(0.06):
        return col.Vehicle.barrier(name=case.choice(NAMES))
    fields = {name: near.get(name, case.number(name)) for name in BODY}
    if case.mood != "plain":
        for name in BODY:
            if case.maybe(0.3):
                value = case.value(name)
                if case.mood != "odd":
                    fields[name] = value
    for name in ("yaw_inertia", "x", "y", "heading"):
        if case.maybe(0.015):
            del fields[name]
    if case.maybe(0.05):
        fields["yaw_inertia"] = math.inf
    elif case.maybe(0.08):
        fields |= {"pivot": (case.number("x"), case.number("y")), "vx": 0.0, "vy": 0.0}
    fields["name"] = case.choice(NAMES)
    made = case.call("Vehicle", col.Vehicle, **fields)
    if isinstance(made, col.Vehicle):
        return made
    return col.Vehicle(mass=1200.0, vx=10.0, yaw_inertia=1800.0, x=0.0, y=0.0, heading=0.2)


def contact(case: Case, model: str = "eccentric") -> dict[str, Any]:
    """Where and by which law the bodies touch."""
    found: dict[str, Any] = {"normal": case.value("normal")}
    if case.maybe(0.2):
        found["normal"] = (case.value("vx"), case.value("vy"))
    if model == "time_resolved":
        found |= contact_time(case)
    elif model != "linear_central":
        rule = case.choice(("friction", "friction", "impulse_ratio", "critical_fraction"))
        found[rule] = math.inf if rule == "friction" and case.maybe(0.1) else case.value(rule)
        found["law"] = case.option("brach", "brach", "kudlich-slibar", "stronge")
        if case.maybe(0.03):
            found |= {
                other: case.value(other)
                for other in ("friction", "impulse_ratio", "critical_fraction")
            }
    if model != "time_resolved" and case.maybe(0.2):
        found["incomplete"] = case.option(True, True, False)
    if model in ("eccentric", "solve") and case.maybe(0.2):
        push = (case.value("vx"), case.value("vy"), case.value("yaw_rate"))
        found[case.choice(("outside_a", "outside_b"))] = push[: case.choice((2, 3))]
    if model in PLACED:
        found["point"] = case.pair("point")
        found |= wheels(case)
    if model == "eccentric" and found.keys() & {"tyres_a", "tyres_b"} and case.maybe(0.9):
        found["duration"] = case.value("duration")
    return found


def wheels(case: Case) -> dict[str, Any]:
    """Tyres of one vehicle or of both, now and then."""
    if case.maybe(0.8):
        return {}
    some = case.sample(("tyres_a", "tyres_b"), case.choice((1, 2)))
    return {name: case.option(*[tyres_of(case)] * 9, None) for name in some}


def tyres_of(case: Case) -> Any:
    """Tyres that can be made."""
    given: dict[str, Any] = {
        "friction": case.value("drag"),
        "lock": case.option(case.value("lock"), [case.value("lock") for _ in range(4)]),
    }
    size = case.choice(("wheelbase", "wheelbase", "distance"))
    given |= {"wheelbase": case.value(size), "track": case.value(size)}
    for name, draw in (
        ("steer", lambda: case.value("heading")),
        ("cornering", lambda: case.option(9.5, case.value("distance"))),
        ("height", lambda: case.option(None, 0.4)),
    ):
        if case.maybe(0.2):
            given[name] = draw()
    made = case.call("travel.Tyres", travel.Tyres, **case.spoil(given))
    return made if isinstance(made, travel.Tyres) else travel.Tyres(0.7, 0.1, 2.7, 1.5)


def contact_time(case: Case) -> dict[str, Any]:
    """How a contact passes."""
    found: dict[str, Any] = {
        "friction": math.inf if case.maybe(0.1) else case.value("friction"),
        "steps": case.option(10, 12),
    }
    found["geometry"] = case.option("maximum_engagement", "first_contact", "fixed")
    kind = case.choice(("duration", "stiffness", "crush_a", "crush_b", "both"))
    if kind == "duration":
        found["duration"] = case.value("duration")
    elif kind == "stiffness":
        found["stiffness"] = case.value("stiffness")
    for name in {"both": ("crush_a", "crush_b")}.get(
        kind, (kind,) if kind.startswith("crush") else ()
    ):
        found[name] = tuple(case.value(part) for part in ("stiffness_a", "stiffness_b", "width"))
    rough = case.maybe(0.7)
    for name, value in (("drag", "drag"), ("wheelbase", "length"), ("track", "width")):
        if rough and case.maybe(0.5):
            found[name] = case.value(value)
    return found


def meeting(case: Case, model: str) -> tuple[col.Vehicle, col.Vehicle, dict[str, Any]]:
    """Two vehicles and a contact, in most cases such that they meet."""
    found = contact(case, model)
    normal = found["normal"]
    spin, across = model in PLACED, model != "linear_central"
    if case.maybe(0.8) and type(normal) is float and math.isfinite(normal):
        c, s = math.cos(normal), math.sin(normal)
        first, second = case.uniform(2.0, 30.0), case.uniform(-20.0, 1.0)
        side = case.uniform(-8.0, 8.0) if across else 0.0
        reach, off, aside = case.uniform(0.5, 2.5), case.uniform(0.5, 2.5), case.uniform(-1.0, 1.0)
        moving = {
            "vx": first * c - side * s,
            "vy": first * s + side * c,
            "x": -reach * c - aside * s,
            "y": -reach * s + aside * c,
        }
        other = {
            "vx": second * c,
            "vy": second * s,
            "x": off * c + aside * s,
            "y": off * s - aside * c,
        }
        if case.mood not in ("extreme", "odd", "batch"):
            found |= {"point": (case.uniform(-0.3, 0.3), case.uniform(-0.3, 0.3))} if spin else {}
    else:
        moving, other = {}, {}
    if not spin:
        moving |= {"yaw_rate": 0.0}
        other |= {"yaw_rate": 0.0}
    return vehicle(case, **moving), vehicle(case, **other), found


def impact_of(case: Case, model: str | None = None) -> Any:
    """The answer of one of the solvers, or its refusal."""
    model = case.choice(SOLVERS) if model is None else model
    a, b, keywords = meeting(case, model)
    if model == "solve":
        keywords["tolerance"] = case.value("tolerance")
        keywords |= {name: case.value(name) for name in ("duration", "drag") if case.maybe(0.2)}
        if case.maybe(0.05):
            keywords["point"] = None
    if case.maybe(0.3):
        keywords["on_failure"] = case.option("nan", "raise", None)
    if case.maybe(0.1):
        keywords |= run_options(case)
    ends = [a, b, case.value("restitution")]
    if keywords.get("incomplete") is True and case.maybe(0.7):
        ends[2] = -case.uniform(0.0, 1.1)
    if case.mood == "odd" and case.maybe(0.1):
        ends[case.randrange(3)] = case.garbage()
    found = case.call(model, getattr(col, model), *ends, **case.spoil(keywords))
    if model != "solve":
        return found
    for name in ("on_failure", "threads", "progress"):
        keywords.pop(name, None)
    choice = case.call("required_model", col.required_model, *ends, **keywords)
    if isinstance(choice, col.ModelChoice):
        case.look(choice, OPEN)
    return found


@fuzzes(
    "Vehicle",
    "Vehicle.barrier",
    "Vehicle.from_speed",
    "Vehicle.replace",
    "Vehicle.point",
    "Vehicle.velocity_at",
)
def test_vehicles(case: Case) -> None:
    """Every field and every place may be anything."""
    fields = {name: case.value(name) for name in BODY if case.maybe(0.8)} | {
        "name": case.option(*NAMES)
    }
    if case.maybe(0.2):
        fields["pivot"] = case.pair("pivot")
        if case.maybe(0.7):
            fields["vx"] = fields["vy"] = 0.0
    made = case.call("Vehicle", col.Vehicle, **case.spoil(dict(fields)))
    moving = {name: value for name, value in fields.items() if name not in ("vx", "vy", "pivot")}
    moving |= {"speed": case.value("speed"), "course": case.value("course")}
    other = case.call("Vehicle.from_speed", col.Vehicle.from_speed, **case.spoil(moving))
    if case.maybe(0.3):
        made = other
    fixed = {name: fields[name] for name in fields if case.maybe(0.2)}
    if "pivot" in fixed and case.maybe(0.8):
        fixed = {name: value for name, value in fixed.items() if name not in ("vx", "vy")} | {
            "x": fields.get("x", 1.0),
            "y": 0.0,
        }
    case.call("Vehicle.barrier", col.Vehicle.barrier, **case.spoil(fixed))
    if not isinstance(made, col.Vehicle):
        made = vehicle(case)
    case.look(made, OPEN)
    changes = {name: case.value(name) for name in BODY if case.maybe(0.2)}
    if case.maybe(0.1):
        changes["pivot"] = case.option(None, case.pair("pivot"))
    if case.maybe(0.1):
        changes["name"] = case.option(*NAMES)
    changed = case.call("Vehicle.replace", made.replace, **case.spoil(changes))
    if isinstance(changed, col.Vehicle):
        case.look(changed, OPEN)
    names = case.choice(
        (
            ("forward", "left"),
            ("forward",),
            ("left",),
            ("distance", "angle"),
            ("distance",),
            ("forward", "angle"),
            (),
        )
    )
    for label, call, keywords in (
        ("Vehicle.point", made.point, {name: case.value(name) for name in names}),
        ("Vehicle.velocity_at", made.velocity_at, {"point": case.pair("point")}),
    ):
        place = case.call(label, call, **case.spoil(keywords))
        if isinstance(place, tuple):
            assert len(place) == 2
            assert case.mood != "plain" or all(map(math.isfinite, place)), place


@fuzzes(
    *SOLVERS, "required_model", "ModelChoice", "ByModel", "Impact", "Pulse", "Inputs",
    "VehicleResult",
    "Impact.again", "Impact.case", "Impact.ees", "Impact.max_crush_speeds", "Impact.to_dict",
    "Impact.from_dict", "Impact.to_columns", "VehicleResult.delta_v_at", "VehicleResult.recorded",
)  # fmt: skip
def test_impacts(case: Case) -> None:
    """Any two bodies, any contact; of what is answered everything is read, written down and read
    back.
    """
    impact = case.choice([impact_of(case, model) for model in SOLVERS])
    if not isinstance(impact, col.Impact):
        impact = known_impact(case.randrange(7))
    case.look(impact, OPEN)
    if case.mood in ("plain", "written") and np.ndim(impact.status) == 0 and impact.ok:
        check_balances(impact)
    case.call("Impact.ees", impact.ees, case.value("share_a"))
    case.call("Impact.max_crush_speeds", impact.max_crush_speeds, case.value("share_a"))
    case.call(
        "VehicleResult.delta_v_at", case.choice((impact.a, impact.b)).delta_v_at, case.pair("point")
    )
    followed = impact if impact.pulse is not None or case.maybe(0.1) else known_impact(6)
    place = {name: case.option(0.5, case.value("x")) for name in ("forward", "left")}
    shown = case.call(
        "VehicleResult.recorded",
        case.choice((followed.a, followed.b)).recorded,
        case.option(0.05, [0.0, 0.03, 1.0], np.array([0.02, 0.2]), case.value("duration")),
        **case.spoil(place | {"axes": case.option("turning", "fixed")}),
    )
    assert isinstance(shown, Exception) or np.shape(shown[0]) == np.shape(shown[1])
    index = case.option(0, 0, -1, 2, (0,), (0, 1), (), case.randint(-9, 9))
    one = case.call("Impact.case", impact.case, index)
    if isinstance(one, col.Impact):
        assert isinstance(one.status, col.Status)
    case.call("Impact.again", impact.again, **case.spoil(changes_of(case, impact)))
    columns = case.must("Impact.to_columns", impact.to_columns)
    assert {len(column) for column in columns.values()} == {np.size(impact.status)}
    chosen = {
        "units": case.option(None, *UNIT_SYSTEMS),
        "columns": case.sample(sorted(columns), min(2, len(columns))),
    }
    case.call(
        "Impact.to_columns",
        impact.to_columns,
        **case.spoil({name: chosen[name] for name in chosen if case.maybe(0.7)}),
    )
    record = case.must("Impact.to_dict", impact.to_dict)
    twin = case.must(
        "Impact.from_dict", col.Impact.from_dict, json.loads(json.dumps(record, allow_nan=False))
    )
    assert twin == impact, "another impact after to_dict and from_dict"


def changes_of(case: Case, impact: col.Impact) -> dict[str, Any]:
    """Some arguments of the solver that answered, as another case of it has them; now and then one
    of another solver.
    """
    model = impact.inputs.model
    drawn = {
        "a": impact.a.before,
        "b": vehicle(case),
        "restitution": case.value("restitution"),
        **contact(case, model),
    }
    if case.maybe(0.5):
        drawn["a"] = vehicle(case)
    if model == "solve":
        drawn |= {name: case.value(name) for name in ("tolerance", "duration", "drag")}
    found = {name: drawn[name] for name in drawn if case.maybe(0.35)}
    if case.mood == "odd":
        found[case.choice(sorted({name for takes in AGAIN.values() for name in takes}))] = (
            case.garbage()
        )
    return found


def check_balances(impact: col.Impact) -> None:
    """What the bodies gain of momentum tyres and outside impulses gave, and where the energy went;
    of free bodies alone.
    """
    sides = impact.a, impact.b
    for state in (side.before for side in sides):
        # What is fixed takes up momentum, and a flywheel without end gives energy.
        if (
            math.isinf(state.mass)
            or state.pivot is not None
            or (state.yaw_rate != 0.0 and state.yaw_inertia == math.inf)
        ):
            return
    # Rounding of sums that cancel: some hundred roundings of what is summed, and in a contact that
    # takes time of every step.
    scale = sum(side.before.mass * (1.0 + side.before.speed + side.delta_v) for side in sides)
    for axis in "xy":
        gained = sum(side.before.mass * getattr(side, f"delta_v{axis}") for side in sides)
        given = sum(
            getattr(side, f"{what}_{axis}")
            for side in sides
            for what in ("tyre_impulse", "outside")
        )
        assert abs(gained - given) <= 1e-12 * scale, (
            f"momentum {gained} along {axis} from impulses {given} outside"
        )
    lost = impact.energy_loss + sum(side.tyre_loss - side.outside_work for side in sides)
    gains = [energy_of(side.after) - energy_of(side.before) for side in sides]
    most = sum(energy_of(state) for side in sides for state in (side.before, side.after))
    assert abs(lost + sum(gains)) <= 1e-10 * most, (
        f"{-sum(gains)} J is gone, {lost} J is said to be"
    )
    for side, gain in zip(sides, gains, strict=True):
        assert abs(side.kinetic_energy_change - gain) <= 1e-10 * most, (
            f"{side.kinetic_energy_change} J is not {gain} J"
        )


def energy_of(vehicle: col.Vehicle) -> float:
    """Of a body whose yaw inertia may be unknown or infinite."""
    inertia = (
        vehicle.yaw_inertia
        if vehicle.yaw_inertia is not None and math.isfinite(vehicle.yaw_inertia)
        else 0.0
    )
    return 0.5 * (vehicle.mass * vehicle.speed**2 + inertia * vehicle.yaw_rate**2)


@functools.cache
def known_impact(which: int) -> col.Impact:
    """Impacts that are answered, for cases whose own are not."""
    a = col.Vehicle(
        mass=1500.0, vx=20.0, vy=1.0, yaw_inertia=2400.0, x=-2.0, y=0.4, heading=0.1, name="A"
    )
    b = col.Vehicle(mass=1200.0, vx=-3.0, yaw_inertia=1700.0, x=2.0, y=0.0, heading=3.0)
    scene: dict[str, Any] = {"normal": 0.1, "point": (0.0, 0.4)}
    speeds = np.array([20.0, 12.0, -20.0])
    return (
        lambda: col.eccentric(a, b, 0.2, friction=0.4, **scene),
        lambda: col.solve(a, b, 0.2, friction=0.4, tolerance=0.5, **scene),
        lambda: col.eccentric(a, col.Vehicle.barrier(), 0.1, friction=0.02, **scene),
        lambda: col.eccentric(a.replace(vx=speeds), b, 0.2, friction=0.4, on_failure="nan",
        **scene),
        lambda: reconstruct.central(1500.0, 1200.0, va=20.0, vb=0.0, vb_after=13.0),
        lambda: reconstruct.momentum(1500.0, 1200.0, course_a=0.0, course_b=1.5,
        course_a_after=0.5, course_b_after=0.8, speed_a_after=9.0, speed_b_after=8.0),
        lambda: col.time_resolved(a, b, 0.2, friction=0.4, duration=0.1, drag=0.7, **scene),
    )[which]() if which != 5 else col.linear_central(a.replace(vy=0.0), b, 0.3)  # fmt: skip


# --- what is made of an impact --------------------------------------------------------------------

UNIT_SYSTEMS = ("si", "metric", "us")
# Shares of a delta-V that is 0, and what is beyond the model, are no numbers; each says so of
# itself.
LEFT_OPEN = frozenset(
    f"LeftOutVehicle.{name}"
    for name in (
        "tyre_share_bound",
        "tyre_share",
        "geometry_share",
        "geometry_delta_v",
        "geometry_yaw_rate",
        "tyre_delta_v",
    )
)


def outline(case: Case) -> Any:
    """A rectangle, a polygon, or at times anything."""
    if case.mood == "odd" and case.maybe(0.2):
        return case.garbage()
    how = case.random()
    if how < 0.5:
        return (
            case.value("length"),
            case.value("width"),
            *([case.value("restitution")] if case.maybe(0.3) else []),
        )
    if how < 0.8:
        count, turn = case.randint(3, 7), case.uniform(0.0, 6.0)
        angles = [turn + 2.0 * math.pi * (i + case.uniform(0.0, 0.5)) / count for i in range(count)]
        return [(2.3 * math.cos(angle), 0.9 * math.sin(angle)) for angle in angles]
    return [(case.value("x"), case.value("y")) for _ in range(case.randint(2, 6))]


def what_is_known(case: Case) -> dict[str, Any]:
    """Options of ``diagnose`` that ``report`` has too."""
    found: dict[str, Any] = {}
    for name, draw in (
        ("outline_a", lambda: outline(case)),
        ("outline_b", lambda: outline(case)),
        ("duration", lambda: case.value("duration")),
        ("drag", lambda: case.value("drag")),
        ("limits", lambda: case.option(
            {case.choice(sorted(LIMITS)): case.value("drag") if case.maybe(0.9) else case.text()})),
        ("crush_energy", lambda: case.value("energy_loss")),
        ("damage_pdof_a", lambda: case.value("angle")),
        ("damage_pdof_b", lambda: case.value("angle")),
        ("damage_delta_v_a", lambda: case.value("speed")),
        ("damage_delta_v_b", lambda: case.value("speed")),
    ):  # fmt: skip
        if case.maybe(0.25):
            found[name] = draw()
    return found


def answer_of(case: Case) -> Any:
    """An impact, now and then a batch or something that is none."""
    impact = impact_of(case)
    if case.mood == "odd" and case.maybe(0.1):
        return case.garbage()
    if not isinstance(impact, col.Impact):
        return known_impact(case.choice((0, 1, 2, 4, 5, 6)))
    if isinstance(impact.status, np.ndarray) and impact.status.size and case.maybe(0.9):
        one = case.call("Impact.case", impact.case, (0,) * impact.status.ndim)
        return one if isinstance(one, col.Impact) else impact
    return impact


@fuzzes(
    "left_out", "LeftOut", "LeftOutVehicle", "diagnose", "Findings", "Findings.to_dict", "Moves",
    "Moves.summary", "diagnostics.Finding", "diagnostics.Move",
    "diagnostics.Move.to_dict",
    "diagnostics.Limit", "explain", "report",
    "reporting.replay", "reporting.options", "impact_schema",
)  # fmt: skip
def test_what_is_made_of_an_impact(case: Case) -> None:
    """left_out, diagnose, explain and the report of one impact; the report is read back, whole and
    spoiled.
    """
    impact = answer_of(case)
    asked = {name: case.value(name) for name in ("duration", "drag")}
    asked["geometry"] = case.option("maximum_engagement", "first_contact")
    asked |= wheels(case)
    left = case.call("left_out", col.left_out, impact, **case.spoil(asked))
    if not isinstance(left, Exception):
        case.look(
            left,
            None
            if np.any(impact.refused)
            else LEFT_OPEN | INCOMPLETE
            if incomplete(impact)
            else LEFT_OPEN,
        )
    known = what_is_known(case)
    findings = case.call(
        "diagnose",
        col.diagnose,
        impact,
        **case.spoil({**known, **wheels(case), "units": case.option(*UNIT_SYSTEMS)}),
    )
    if not isinstance(findings, Exception):
        numbers = "delta_v_a", "delta_v_b", "yaw_rate_a", "yaw_rate_b", "share"
        without_answer = {f"diagnostics.Move.{name}" for name in numbers}
        measures = {"diagnostics.Finding.measured", "diagnostics.Finding.limit"}
        case.look(findings, frozenset(measures | without_answer))
        json.dumps(case.must("Findings.to_dict", findings.to_dict), allow_nan=False)
        assert str(case.must("Moves.summary", findings.moves.summary, case.choice(UNIT_SYSTEMS)))
        for move in findings.moves:
            case.must("diagnostics.Move.to_dict", move.to_dict)
        for finding in findings:
            assert finding.code in LIMITS
            case.look(
                finding, frozenset({"diagnostics.Finding.measured", "diagnostics.Finding.limit"})
            )
            case.look(LIMITS[finding.code], frozenset({"diagnostics.Limit.default"}))
    case.look(LIMITS[case.choice(sorted(LIMITS))], frozenset({"diagnostics.Limit.default"}))
    explained(case, impact)
    options = known | {"form": case.option("markdown", "html"), "units": case.option(*UNIT_SYSTEMS)}
    # A picture takes a quarter of a second each.
    options["figures"] = case.option(False) if case.randrange(1000) else True
    for name, draw in (
        ("title", lambda: case.option("A title", case.text())),
        ("notes", lambda: case.option("note", ["one", "two"], [case.text()])),
        ("share_a", lambda: case.value("share_a")),
        ("uncertainty", lambda: uncertainties(case)),
        ("derivation", lambda: case.option(True, False)),
        ("author", lambda: case.option("J. Doe", case.text())),
        ("case", lambda: case.option("2026-11", case.text())),
        ("date", lambda: case.option("25 November 2026", case.text())),
        ("exhibit", lambda: case.option("12", case.text())),
        ("answers", lambda: case.option(["a.delta_v"], [case.text()], case.text())),
    ):
        if case.maybe(0.1):
            options[name] = draw()
    page = case.call("report", col.report, impact, **case.spoil(options))
    read_back(case, impact, page)
    assert json.dumps(case.must("impact_schema", col.impact_schema), allow_nan=False)


@fuzzes("what_if", share=0.2)
def test_pages_of_sliders(case: Case) -> None:
    """Any impact, any names and ends."""
    names = (
        "speed_a",
        "vx_b",
        "mass_a",
        "restitution",
        "friction",
        "normal",
        "point_x",
        "heading_b",
        case.text(),
    )
    ranges = {}
    for name in case.sample(names, 2):
        low, high = sorted((case.number("vx"), case.number("vx")))
        ranges[name] = case.option(
            (case.value("speed"), case.value("speed")), (low, high), (-1e3, 1e3), (0.0, 1.0)
        )
    impact = case.option(answer_of(case), known_impact(0), known_impact(5))
    options = {"units": case.option(None, *UNIT_SYSTEMS)} | {
        f"outline_{v}": outline(case) for v in "ab" if case.maybe(0.2)
    }
    if isinstance(impact, col.Impact) and case.maybe(0.5):
        e = (
            impact.restitution
            if isinstance(impact.restitution, float) and 0.0 <= impact.restitution <= 1.0
            else 0.2
        )
        ranges = {"restitution": (0.5 * e, 0.5 * (1.0 + e))}
    if case.maybe(0.3):
        low, high = sorted((case.number("vx"), case.number("vx")))
        name = case.choice(("a.delta_v", "b.after.speed", "a.pdof", "energy_loss", case.text()))
        options["observed"] = {name: case.option((low, high), low, case.value("speed"))}
    found = case.call("what_if", col.what_if, impact, ranges, **case.spoil(options))
    assert isinstance(found, Exception) or found.startswith("<!DOCTYPE html>")


def uncertainties(case: Case) -> Any:
    """Half-widths of inputs, a propagation, or what is neither."""
    name = case.choice(
        ("a.vx", "b.vx", "restitution", "friction", "b.after.vx", "energy_loss", "a_delta_v", "x")
    )
    return case.option({name: case.value("speed")}, known_propagation(), None)


def explained(case: Case, answer: Any) -> None:
    """The derivation of an answer."""
    options = {"units": case.option(*UNIT_SYSTEMS), "form": case.option("markdown", "text")}
    if case.maybe(0.15):
        options["uncertainty"] = uncertainties(case)
    page = case.call("explain", col.explain, answer, **case.spoil(options))
    if not isinstance(page, Exception):
        assert isinstance(page, str)
        assert "nan" not in page.replace("finan", "").split(), page


def reported(case: Case, answer: Any, known: dict[str, Any]) -> None:
    """The report of another answer than an impact, read back."""
    options = known | {
        "form": case.option("markdown", "html"),
        "units": case.option(*UNIT_SYSTEMS),
        "figures": False,
    }
    read_back(case, answer, case.call("report", col.report, answer, **case.spoil(options)))


def read_back(case: Case, impact: Any, page: Any) -> None:
    """A report gives its impact and its options again; what is no report, or a spoiled one, is
    refused or read.
    """
    if isinstance(page, Exception):
        text = case.option(case.text(), "<html>", "```json\n{}\n```")
        whole = False
    else:
        assert isinstance(page, str)
        text, whole = page, case.maybe(0.5)
        if not whole:
            at = case.randrange(len(text))
            how = case.randrange(4)
            start = text.rfind('"format"')
            if how == 0:
                text = text[:at]
            elif how == 1:
                text = text[:at] + case.choice('0123456789{}[]",.-enN\x00') + text[at + 1 :]
            elif how == 2 and start > 0:
                # Inside the record.
                at = case.randrange(start, len(text))
                text = (
                    text[:at]
                    + case.choice(
                        ("1", "e9", "-", '"', "null", "1e999", "0" * 400, "NaN", "[", "{")
                    )
                    + text[at + case.randrange(4) :]
                )
            else:
                numbers = [i for i in range(max(start, 0), len(text)) if text[i].isdigit()]
                if numbers:
                    at = case.choice(numbers)
                    text = (
                        text[:at] + case.choice(("7", "9" * 400, "true", "null")) + text[at + 1 :]
                    )
    found = case.call("reporting.replay", reporting.replay, text)
    given = case.call("reporting.options", reporting.options, text)
    if whole:
        same = found == impact if isinstance(impact, col.Impact) else repr(found) == repr(impact)
        assert same or isinstance(impact, reconstruct.Fit), f"another answer was read back: {found}"
        assert isinstance(given, dict), given
    for answer in (found, given):
        assert isinstance(
            answer, col.Impact | reconstruct.MomentumSolution | dict | col.InputError
        ), answer


# --- backwards ------------------------------------------------------------------------------------

MASSES = ("mass_a", "mass_b")


def solved(case: Case, name: str, /, *args: Any, **keywords: Any) -> Any:
    """The answer of a reverse solver, or its refusal, with the answers it has all the same."""
    found = case.call(
        f"reconstruct.{name}", getattr(reconstruct, name), *args, **case.spoil(keywords)
    )
    for one in (
        found.solutions
        if isinstance(found, col.NoSolutionError)
        else found
        if isinstance(found, tuple)
        else [found]
    ):
        if isinstance(one, float):
            assert math.isfinite(one), one
        elif not isinstance(one, Exception):
            case.look(one, OPEN | MOMENTUM_OPEN | FIT_OPEN)
    return found


MOMENTUM_OPEN = frozenset(
    f"reconstruct.MomentumSolution.{name}"
    for name in ("condition", "pdof_a", "pdof_b", "restitution", "mass_a", "mass_b", "sensitivity")
) | {"Sensitivity"}


def motion(case: Case, impact: Any) -> tuple[Any, Any]:
    """Two vehicles after: those of the impact, or any."""
    if isinstance(impact, col.Impact) and case.maybe(0.8):
        return impact.a.after, impact.b.after
    return vehicle(case), vehicle(case)


@fuzzes(
    "reconstruct.central", "reconstruct.inline_closing_speed", "reconstruct.momentum",
    "reconstruct.MomentumSolution", "Sensitivity",
    "reconstruct.Reconstruction", "reconstruct.crush_delta_v", "reconstruct.crush_energy",
    "reconstruct.crush_share",
)  # fmt: skip
def test_reverse_solvers_of_numbers(case: Case) -> None:
    """Any numbers; with too few, too many and contradictory ones."""
    masses = {name: case.value("mass") for name in MASSES}
    kinds = {
        **dict.fromkeys(("va", "vb", "va_after", "vb_after"), "vx"),
        "restitution": "restitution",
        "energy_loss": "energy_loss",
    }
    count = case.choice((3, 3, 3, 3, 3, 2, 4))
    failing = {"on_failure": case.option(None, "nan", "raise")} if case.maybe(0.3) else {}
    given = {name: case.value(kinds[name]) for name in case.sample(sorted(kinds), count)}
    if case.maybe(0.5):
        given = {
            "va": case.uniform(10.0, 30.0),
            "vb": case.uniform(-20.0, 5.0),
            "restitution": case.value("restitution"),
        }
    given |= {name: case.value("heading") for name in ("heading_a", "heading_b") if case.maybe(0.1)}
    failing |= {
        name: case.value("duration" if name == "duration" else "drag")
        for name in case.choice(((), (), ("duration", "drag_a", "drag_b"), ("drag_a",)))
    }
    if case.maybe(0.1):
        given |= (
            {"restitution": -case.random()} if "restitution" in given and case.maybe(0.5) else {}
        )
        solved(case, "central", **masses, **given, **failing, incomplete=case.option(True, False))
    else:
        headings = {name: case.value("heading") for name in ("heading_a", "heading_b")}
        solved(case, "central", **masses, **(given | headings), **failing)
    known = case.choice(
        (
            {"delta_v_a": "speed"},
            {"delta_v_b": "speed"},
            {"energy_loss": "energy_loss"},
            {"ees_a": "speed", "ees_b": "speed"},
            {"max_crush_speed_a": "speed", "max_crush_speed_b": "speed"},
        )
    )
    e = case.option(
        case.value("restitution"),
        case.value("restitution"),
        reference.restitution,
        lambda v: 0.1,
        lambda v: 1 / v,
        lambda v: math.nan,
        lambda v: "x",
    )
    solved(
        case,
        "inline_closing_speed",
        **masses,
        restitution=e,
        **{name: case.value(kind) for name, kind in known.items()},
        **{
            name: case.value("duration" if name == "duration" else "drag")
            for name in case.choice(((), (), ("duration", "drag_a", "drag_b"), ("drag_a",)))
        },
    )
    courses = {
        name: case.value("course")
        for name in ("course_a", "course_b", "course_a_after", "course_b_after")
        if case.maybe(0.97)
    }
    speeds = {
        name: case.value("speed")
        for name in case.sample(
            ("speed_a", "speed_b", "speed_a_after", "speed_b_after"), case.choice((2, 2, 2, 1, 3))
        )
    }
    if case.maybe(0.5):
        speeds = {name: case.value("speed") for name in ("speed_a_after", "speed_b_after")}
    more = {name: case.value("heading") for name in ("heading_a", "heading_b") if case.maybe(0.3)}
    more |= {name: value for name, value in failing.items() if name == "on_failure"}
    if case.maybe(0.1):
        more["together"] = case.option(True, False)
    if case.maybe(0.2):
        more["normal"] = case.value("normal")
    if case.maybe(0.1):
        more["outside_impulse"] = case.pair("outside_impulse")
    if case.maybe(0.15):
        # One velocity whole: three speeds, or both before of vehicles that stay together.
        lost = case.choice(("a", "b", "a_after", "b_after"))
        speeds = {name: case.value("speed") for name in ("speed_a", "speed_b")}
        together = more["together"] = lost.endswith("after") and case.maybe(0.5)
        if not together:
            speeds = {
                name: case.value("speed")
                for name in ("speed_a", "speed_b", "speed_a_after", "speed_b_after")
                if name != f"speed_{lost}"
            }
        gone = ("a_after", "b_after") if together else (lost,)
        courses = {
            name: value for name, value in courses.items() if name[len("course_") :] not in gone
        }
    elif case.maybe(0.15):
        # A course beside the speed of another: three speeds, and that course is not known.
        sought, other = case.choice(
            (("a", "b"), ("b", "a_after"), ("a_after", "b"), ("b", "b_after"))
        )
        speeds = {
            name: case.value("speed")
            for name in ("speed_a", "speed_b", "speed_a_after", "speed_b_after")
            if name != f"speed_{other}"
        }
        courses.pop(f"course_{sought}", None)
        if case.maybe(0.7):
            more["course_near"] = case.value("course")
    if case.maybe(0.3):
        more |= lasting(case)
        for label in "ab":
            if f"tyres_{label}" in more or case.maybe(0.05):
                more[f"heading_{label}"] = case.value("heading")
                if case.maybe(0.4):
                    more[f"yaw_rate_{label}_after"] = case.value("yaw_rate")
    momentum = solved(case, "momentum", **masses, **courses, **speeds, **more)
    if isinstance(momentum, reconstruct.MomentumSolution) and case.maybe(0.2):
        explained(case, momentum)
        known = what_is_known(case)
        case.call("diagnose", col.diagnose, momentum, **case.spoil(dict(known)))
        reported(case, momentum, known if case.maybe(0.3) else {})
    count = case.randint(1, 6)
    depths = [case.value("width") for _ in range(count)]
    widths = case.option(case.value("width"), [case.value("width") for _ in range(count - 1)])
    found = solved(
        case,
        "crush_energy",
        widths,
        depths,
        case.value("stiffness_a"),
        case.value("stiffness_b"),
        force_angle=case.option(0.0, case.value("angle")),
        name=case.option("", "front", case.text()),
    )
    assert not isinstance(found, float) or found >= 0.0
    share = solved(case, "crush_share", case.value("stiffness_a"), case.value("stiffness_b"))
    assert not isinstance(share, float) or 0.0 <= share <= 1.0
    gammas = {f"gamma_{side}": case.value("share_a") for side in "ab" if case.maybe(0.7)}
    both = solved(
        case,
        "crush_delta_v",
        case.value("energy_loss"),
        case.value("mass_a"),
        case.value("mass_b"),
        **gammas,
    )
    assert not isinstance(both, tuple) or not isinstance(both[0], float) or min(both) >= 0.0


@fuzzes(
    "reconstruct.recorded_pulse",
    "reconstruct.RecordedPulse",
    "reconstruct.RecordedPulse.inputs",
    "reconstruct.RecordedPulse.summary",
)
def test_recorded_pulses(case: Case) -> None:
    """A record of anything: with samples that rise it is answered, with its error, and handed on
    where it ended.
    """
    times: Any = np.arange(case.randint(1, 30)) * case.choice(
        (0.01, 0.01, 1e-3, 1e3, -0.01, 0.0, math.nan, 1e-320)
    )
    shape = (
        np.sin(np.clip(np.arange(times.size) / 11.0, 0.0, 1.0) * 1.5)
        if isinstance(times, np.ndarray)
        else 1.0
    )
    given = [times, case.option(-8.0 * shape, case.value("vx"))]
    given += [case.option(2.0 * shape, case.value("vx"))] if case.maybe(0.6) else []
    polarity = case.option("49 CFR 563", "ISO 8855")
    place = (
        {name: case.option(0.5, case.value("x")) for name in ("forward", "left")}
        if case.maybe(0.4)
        else {}
    )
    pulse = case.call(
        "reconstruct.recorded_pulse",
        reconstruct.recorded_pulse,
        *given,
        polarity=polarity,
        **case.spoil(place),
    )
    if not isinstance(pulse, Exception):
        case.look(pulse, None)
        assert str(
            case.must("reconstruct.RecordedPulse.summary", pulse.summary, case.choice(UNIT_SYSTEMS))
        )
        case.call("reconstruct.RecordedPulse.inputs", pulse.inputs, case.option("a", "b"))


def lasting(case: Case) -> dict[str, Any]:
    """How long a contact lasts, and the wheels of one vehicle or of both."""
    found: dict[str, Any] = {"duration": case.value("duration")} if case.maybe(0.95) else {}
    for name in ("tyres_a", "tyres_b"):
        locks = [case.uniform(0.0, 1.0) for _ in range(4)]
        if case.mood == "odd" and case.maybe(0.4):
            found[name] = case.garbage()
        elif case.maybe(0.8):
            found[name] = travel.Tyres(case.uniform(0.0, 1.2), locks, 2.7, 1.5)
    # Wheels without a duration are refused, whatever they are.
    if case.mood == "odd" and case.maybe(0.4):
        found.pop("duration", None)
    return found


@fuzzes("reconstruct.planar", "reconstruct.restitution", "reconstruct.friction")
def test_reverse_solvers_of_motions(case: Case) -> None:
    """From the states that an impact ended with, or from any; what is answered leads to
    them again.
    """
    a, b, keywords = meeting(case, "eccentric")
    e = case.value("restitution")
    impact = case.call("eccentric", col.eccentric, a, b, e, **keywords)
    after = motion(case, impact)
    known = {"restitution": e}
    if case.maybe(0.4):
        known = {
            case.choice(("closing_speed", "energy_loss")): case.value(
                case.choice(("speed", "energy_loss"))
            )
        }
        if isinstance(impact, col.Impact) and case.maybe(0.6):
            known = {name: getattr(impact, name) for name in known}
    if case.maybe(0.3):
        known["regime"] = case.option("sliding", "sticking", "frictionless", "given")
    if case.maybe(0.2):
        known["on_failure"] = case.option("nan", "raise")
    if case.maybe(0.3):
        known |= lasting(case)
    solved(case, "planar", *after, **{**keywords, **known})
    motions = [a, b, *after]
    if case.mood == "odd" and case.maybe(0.1):
        motions[case.randrange(4)] = case.garbage()
    where = {
        name: keywords[name] for name in ("normal", "point") if name == "normal" or case.maybe(0.8)
    }
    for name in ("restitution", "friction"):
        solved(case, name, *motions, **where)


@fuzzes("reconstruct.speeds")
def test_speeds(case: Case) -> None:
    """Two vehicles and two things known of them, of an impact that was or of none."""
    a, b, keywords = meeting(case, "eccentric")
    e = case.value("restitution")
    impact = case.call("eccentric", col.eccentric, a, b, e, **keywords)
    kinds = {
        "speed_a": "speed",
        "speed_b": "speed",
        "delta_v_a": "speed",
        "delta_v_b": "speed",
        "energy_loss": "energy_loss",
    }
    kinds |= {f"{name}_{side}": "speed" for name in ("ees", "max_crush_speed") for side in "ab"}
    kinds |= {f"delta_v_{part}_{side}": "vx" for part in ("forward", "left") for side in "ab"}
    names = [
        case.choice(("speed_a", "speed_b")),
        case.choice(("delta_v_a", "delta_v_b", "energy_loss")),
    ]
    if case.maybe(0.3):
        names = case.sample(sorted(kinds), case.choice((2, 2, 2, 1, 3)))
    elif case.maybe(0.3):
        names = [
            f"delta_v_{part}_{side}"
            for side in case.choice(("a", "b", "ab"))
            for part in ("forward", "left")
        ]
    known = {name: case.value(kinds[name]) for name in names}
    courses = {f"course_{side}": case.value("course") for side in "ab"}
    if isinstance(impact, col.Impact) and case.maybe(0.8):
        known = {name: _known_of(impact, name) for name in known}
        courses = {"course_a": impact.a.before.course, "course_b": impact.b.before.course}
        if case.maybe(0.1):
            known = dict(zip(("ees_a", "ees_b"), impact.ees(case.random()), strict=True)) | {
                names[0]: known[names[0]]
            }
        elif case.maybe(0.1):
            both = zip(
                ("max_crush_speed_a", "max_crush_speed_b"),
                impact.max_crush_speeds(case.random()),
                strict=True,
            )
            known = dict(both) | {names[0]: known[names[0]]}
    for name in sorted(courses):
        if case.maybe(0.05):
            courses[name] = None
    if case.maybe(0.05):
        e = case.choice(
            (
                reference.restitution,
                lambda v: 0.1,
                lambda v: 1.0 / v,
                lambda v: math.nan,
                lambda v: "x",
                lambda v: 0.5 / (1.0 + v),
            )
        )
    if case.maybe(0.1):
        known["forward_only"] = case.option(True, False)
    if case.maybe(0.2 + 0.5 * all(name.startswith("delta_v_") for name in names)):
        known["regime"] = case.option(None, None, "sticking", "sliding")
        known["slid"] = case.option(None, "bound", "bound")
    sides = {name[-1] for name in known if name.startswith(("delta_v_forward", "delta_v_left"))}
    if case.maybe(0.5 if sides else 0.05):
        known |= {f"recorder_{side}": case.option((0.5, 0.1), case.pair("x")) for side in sides}
        known |= {"duration": case.option(0.1, case.value("duration"))}
        known |= {"axes": case.option("turning", "fixed")} if case.maybe(0.5) else {}
    if case.maybe(0.2):
        known |= lasting(case)
    solved(case, "speeds", a, b, restitution=e, **{**keywords, **courses, **known})


def _known_of(impact: col.Impact, name: str) -> Any:
    if name == "energy_loss":
        return impact.energy_loss
    side = getattr(impact, name[-1])
    if name.startswith(("ees", "max_crush")):
        return (impact.ees if name.startswith("ees") else impact.max_crush_speeds)(0.5)[
            "ab".index(name[-1])
        ]
    if name.startswith("speed"):
        return side.before.speed
    found = getattr(side, name[:-2])
    return 1.0 if found is None else found


# --- fit ------------------------------------------------------------------------------------------

FIT_OPEN = frozenset(
    f"reconstruct.Fit.{name}" for name in ("values", "covariance", "correlation_matrix",
    "p_value", "nonlinearity", "bounds", "standard_errors", "contributions", "profiles")
) | {
    "Estimate.profile", "Estimate.value", "Estimate.standard_error", "Estimate.low",
    "Estimate.high", "Values", "Direction.changes",
    "uncertainty.Normal.support", "Residual.computed", "Residual.residual", "Residual.over_sigma",
}  # fmt: skip


def straight(x: Any, y: Any) -> dict[str, Any]:
    """A model without a bend."""
    return {"s": x + 2.0 * y, "d": x - y}


def bent(x: Any, y: Any) -> dict[str, Any]:
    """A model of every kind of bend, refused in part; numbers of any size."""
    with np.errstate(all="ignore"):
        return {"s": np.sqrt(x) * y, "d": np.where(x > y, x * x, y / x)}


def struck(x: Any, y: Any) -> dict[str, Any]:
    """An impact."""
    impact = col.linear_central(
        col.Vehicle(mass=1500.0, vx=x), col.Vehicle(mass=1200.0, vx=y), 0.2, on_failure="nan"
    )
    return {"s": impact.a.q.delta_v, "d": impact.b.after.vx}


def angled(x: Any, y: Any) -> dict[str, Any]:
    """Angles with their unit."""
    return {"s": registries()[0].Quantity(np.arctan2(y, x), "rad"), "d": np.hypot(x, y)}


def nearly(case: Case, model: Any) -> Any:
    """A finer model beside one: near it, another one, or none."""
    more = case.uniform(0.95, 1.1)

    def found(x: Any, y: Any) -> dict[str, Any]:
        computed: dict[str, Any] = model(more * x, y)
        return computed

    return case.option(found, found, found, straight, bent, unlawful(case))


def unlawful(case: Case) -> Any:
    """A model that is none."""
    value = case.garbage()
    return case.choice(
        (value, lambda **inputs: value, lambda **inputs: {"s": value, "d": 0.0}, lambda x: {"s": x})
    )


def stated(case: Case) -> Any:
    """What is known of an unknown, or what is observed."""
    low = case.uniform(-5.0, 20.0)
    high = low + case.uniform(0.1, 20.0)
    scale = abs(case.extreme()) if case.mood == "extreme" and case.maybe(0.5) else 1.0
    made = case.choice(
        (
            lambda: uncertainty.Interval(low * scale, high * scale),
            lambda: uncertainty.Uniform(low * scale, high * scale),
            lambda: uncertainty.Normal(high * scale, scale),
            lambda: uncertainty.Normal(high * scale, scale, truncate=(low * scale, None)),
            lambda: high * scale,
            lambda: uncertainty.LogNormal(2.0, 1.0),
            lambda: case.value("vx"),
        )
    )
    try:
        return made()
    except col.CollisionsError:
        return 5.0


@fuzzes(
    "reconstruct.fit",
    "reconstruct.Fit",
    "reconstruct.Fit.to_dict",
    "Estimate",
    "Estimate.interval",
    "Residual",
    "Direction",
    "Values",
)
def test_fit(case: Case) -> None:
    """Any model, any knowledge before and any observation; one that was answered is
    read in full.
    """
    plain = case.maybe(0.4)
    model = straight if plain else case.option(straight, bent, bent, struck, angled)
    unknowns = {name: stated(case) for name in "xy"}
    if plain or case.maybe(0.3):
        unknowns = {
            "x": uncertainty.Interval(0.0, 40.0),
            "y": case.choice((5.0, uncertainty.Normal(4.0, 2.0))),
        }
    observed: dict[str, Any] = {
        name: (
            case.value("speed"),
            case.option(0.5, 1.0, abs(case.number("vx")) + 0.1)
            if case.mood != "extreme"
            else abs(case.extreme()),
        )
        for name in case.choice((("s", "d"), ("s", "d"), ("s",), ("d",), ("s", "z")))
    }
    if case.mood == "odd":
        if case.maybe(0.2):
            model = unlawful(case)
        if case.maybe(0.2):
            unknowns = case.option({"x": case.garbage(), "y": 1.0}, case.garbage())
        if case.maybe(0.2):
            observed = case.option({"s": case.garbage()}, case.garbage())
    finer = nearly(case, model) if case.maybe(0.2) else None
    found = solved(case, "fit", model=model, unknowns=unknowns, observed=observed, finer=finer)
    if not isinstance(found, reconstruct.Fit):
        found = known_fit()
    assert json.dumps(case.must("reconstruct.Fit.to_dict", found.to_dict), allow_nan=False)
    if case.maybe(0.1):
        explained(case, found)
        reported(case, found, {})
    case.call("reconstruct.Fit", found.__getitem__, case.option("x", case.garbage()))
    for name in found.names:
        case.look(found[name], FIT_OPEN, thorough=False)
        case.call(
            "Estimate.interval", found[name].interval, case.option(0.95, 0.5, case.value("share_a"))
        )


@functools.cache
def known_fit() -> reconstruct.Fit:
    """A fit, of which one direction is held by a prior alone."""
    known = {"x": uncertainty.Normal(5.0, 3.0), "y": uncertainty.Normal(4.0, 2.0)}
    return reconstruct.fit(straight, known, {"s": (12.0, 0.5)})


POSTERIOR_OPEN = FIT_OPEN | {"uncertainty.LogNormal.support"} | {
    f"reconstruct.{name}" for name in ("Posterior.p_value", "Posterior.correlation",
    "Posterior.predicted", "Posterior.draws")
} | {
    f"PosteriorOutput.{name}" for name in ("mean", "std", "values", "unit", "mean_standard_error",
    "std_standard_error")
}  # fmt: skip


def reading(case: Case) -> Any:
    """What a posterior takes as an observation."""
    value, error = case.value("speed"), case.option(0.5, 1.0, 1e-3, None)
    low = case.option(None, case.uniform(0.0, 15.0))
    made = case.choice(
        (
            lambda: (value, 0.5),
            lambda: uncertainty.Normal(case.uniform(0.0, 20.0), 0.8),
            lambda: uncertainty.Interval(3.0, case.uniform(4.0, 20.0)),
            lambda: case.call("uncertainty.Censored", uncertainty.Censored,
            **case.spoil({"low": low, "high": case.option(None, 17.0), "error": error})),
        )
    )  # fmt: skip
    return made()


def posterior_of(case: Case, observed: Any = None) -> Any:
    """A posterior of few samples, or its refusal."""
    # A hundred calls each, of which those of an impact cost most and show nothing else.
    model = struck if case.maybe(0.06) else case.choice((straight, bent, angled))
    unknowns: Any = {name: stated(case) for name in "xy"}
    if case.maybe(0.6):
        unknowns = {"x": uncertainty.Uniform(0.0, 40.0), "y": uncertainty.Normal(4.0, 2.0)}
    observed = observed or {
        name: reading(case) for name in case.choice((("s", "d"), ("s",), ("d",)))
    }
    if case.mood == "odd":
        model = case.option(model, unlawful(case))
        unknowns = case.option(
            unknowns, {"x": case.garbage(), "y": uncertainty.Uniform(0, 1)}, case.garbage()
        )
        observed = case.option(observed, {"s": case.garbage()}, case.garbage())
    options = {
        "samples": 512,
        "seed": case.randrange(2**64),
        "correlation": case.option(None, {("x", "y"): case.uniform(-1, 1)}),
    }
    if case.maybe(0.1):
        options |= run_options(case)
    if case.maybe(0.15):
        options["finer"] = nearly(case, model)
    elif case.maybe(0.1):
        path = "contacts[0].impact.A.delta_v"
        case.call(
            "reconstruct.posterior",
            reconstruct.posterior,
            known_scene(),
            {"A.vx": uncertainty.Uniform(10.0, 20.0)},
            {path: (4.0, 1.0)},
            samples=512,
            tolerance=case.option(0.5, {path: "1 m/s"}, case.uniform(0.01, 10.0), case.garbage()),
        )
    # Islands are followed four at a time: the other four cost as much again, and go the same way.
    with mock.patch.object(posterior, "ISLANDS", 8 if case.maybe(0.1) else 4):
        return case.call(
            "reconstruct.posterior",
            reconstruct.posterior,
            model,
            unknowns,
            observed,
            **case.spoil(options),
        )


@functools.cache
def known_posterior(mean: float = 4.0) -> reconstruct.Posterior:
    """A posterior of a line."""
    known = {"x": uncertainty.Normal(5.0, 3.0), "y": uncertainty.Normal(mean, 2.0)}
    return reconstruct.posterior(straight, known, {"s": (12.0, 0.5)}, samples=512, seed=1)


@fuzzes(
    "reconstruct.posterior", "reconstruct.Posterior", "reconstruct.compare",
    "reconstruct.Comparison", "uncertainty.Censored",
    *(f"reconstruct.Posterior.{name}" for name in (
        "inputs", "probability", "to_dict", "with_result")),
    "reconstruct.Comparison.to_dict", "reconstruct.Posterior.summary",
    "reconstruct.Comparison.summary", "PosteriorOutput.summary",
    *(f"PosteriorOutput{name}" for name in ("", ".record", ".histogram", ".probability",
    ".quantile_standard_error", ".may_wrap", ".turned")),
    "plot.corner", "plot.residuals",
    share=0.25,
)  # fmt: skip
def test_posterior(case: Case) -> None:
    """Any model, priors and readings; one that was answered is read in full and compared with
    another.
    """
    found = posterior_of(case)
    if not isinstance(found, reconstruct.Posterior):
        found = known_posterior()
    case.look(found, POSTERIOR_OPEN, thorough=False)
    assert json.dumps(case.must("reconstruct.Posterior.to_dict", found.to_dict), allow_nan=False)
    assert str(case.must("reconstruct.Posterior.summary", found.summary, case.choice(UNIT_SYSTEMS)))
    case.call("reconstruct.Posterior", found.__getitem__, case.option("x", "s", case.garbage()))
    for name in found:
        output = found[name]
        case.look(output, POSTERIOR_OPEN, thorough=False)
        assert str(case.must("PosteriorOutput.summary", output.summary, case.choice(UNIT_SYSTEMS)))
        assert json.dumps(case.must("PosteriorOutput.record", output.record), allow_nan=False)
        case.call("PosteriorOutput.histogram", output.histogram, case.option(40, 5, case.garbage()))
        asked = case.option(lambda values: values > 1.0)
        case.call("PosteriorOutput.probability", output.probability, asked)
        case.call(
            "PosteriorOutput.quantile_standard_error",
            output.quantile_standard_error,
            case.option(0.5, case.value("share_a")),
        )
        assert case.must("PosteriorOutput.may_wrap", output.may_wrap) in (True, False)
        assert len(case.must("PosteriorOutput.turned", output.turned, 1.0).values) == found.samples
    if not isinstance(inputs := case.call("reconstruct.Posterior.inputs", found.inputs), Exception):
        assert list(inputs) == list(found)
    more = case.call(
        "reconstruct.Posterior.with_result",
        found.with_result,
        case.option("worked out", "x", case.garbage()),
        case.option(lambda value: 2.0 * value, np.sum, case.garbage()),
        case.option("m/s", None, case.text()),
        value=case.option(found["x"], 3.0, uncertainty.Normal(1.0, 0.1), case.garbage()),
    )
    if isinstance(more, reconstruct.Posterior):
        assert json.dumps(more.to_dict(), allow_nan=False)
    condition = case.option(
        lambda at: at["x"] > case.uniform(0.0, 10.0), lambda at: at["x"], case.garbage()
    )
    chance = case.call("reconstruct.Posterior.probability", found.probability, condition)
    if not isinstance(chance, Exception):
        alone = math.isnan(found["x"].mean_standard_error)  # one island has all of the samples
        assert 0.0 <= chance[0] <= 1.0, chance
        assert math.isnan(chance[1]) if alone else chance[1] >= 0.0, chance
    one, other = case.choice(
        ((known_posterior(), known_posterior(5.0)), (found, found), (found, known_posterior()))
    )
    prior = case.option(
        None, {"one": 0.3, "other": 0.7}, {"one": case.value("share_a"), "other": 0.5}
    )
    accounts = case.option({"one": one, "other": other}, {"one": one}, case.garbage())
    compared = case.call(
        "reconstruct.compare", reconstruct.compare, accounts, **case.spoil({"prior": prior})
    )
    if isinstance(compared, reconstruct.Comparison):
        case.look(compared)
        assert str(
            case.must("reconstruct.Comparison.summary", compared.summary, case.choice(UNIT_SYSTEMS))
        )
        assert json.dumps(
            case.must("reconstruct.Comparison.to_dict", compared.to_dict), allow_nan=False
        )
        assert math.isclose(sum(compared.probability.values()), 1.0, rel_tol=1e-9)
    if case.maybe(0.2):
        case.call(
            "plot.corner",
            plot.corner,
            found,
            **case.spoil({"unknowns": case.option(None, ["x"], "y", ["s", "x"]), "units": "us"}),
        )
        plt.close("all")
        blank.cache_clear()
        case.call(
            "plot.residuals",
            plot.residuals,
            case.option(found, known_fit(), case.garbage()),
            axes=blank(),
        )


# --- travel ---------------------------------------------------------------------------------------


def segments(case: Case, name: str, count: int) -> Any:
    """One value, or one for each surface."""
    if case.maybe(0.5):
        return case.value(name)
    return [case.value(name) for _ in range(count if case.maybe(0.97) else count + 1)]


@fuzzes("travel.throw_speed", "travel.throw_bounds")
def test_throws(case: Case) -> None:
    """Somebody who was thrown: a speed, and bounds in their order that hold it if it went up."""
    ground = {"friction": case.value("friction"), "height": case.option(0.0, case.value("x"))}
    angle = case.value("heading")
    far = case.value("distance")
    found = [
        case.call(
            "travel.throw_speed", travel.throw_speed, far, **case.spoil({**ground, "angle": angle})
        ),
        case.call("travel.throw_bounds", travel.throw_bounds, far, **case.spoil(ground)),
    ]
    for one in found:
        if not isinstance(one, Exception):
            for speed in one if isinstance(one, tuple) else (one,):
                assert np.all(~(np.asarray(speed) < 0.0)), speed
    if not isinstance(found[1], Exception):
        least, greatest = found[1]
        assert np.all(~(np.asarray(least) > np.asarray(greatest))), found[1]


@fuzzes("travel.speed", "travel.time", "travel.distance", "travel.path", "travel.RunOut")
def test_travel(case: Case) -> None:
    """Straight and along a path, over one surface and several."""
    count = case.randint(1, 3)
    ground = {name: segments(case, name, count) for name in ("drag", "grade")} | {
        "end_speed": case.option(0.0, case.value("speed"))
    }
    length, start = [case.value("distance") for _ in range(count)], case.value("speed")
    if count == 1:
        length = case.option(length, length[0])
    for name in ("speed", "time", "distance"):
        first, over = length, dict(ground)
        if name == "distance":
            first, over = (
                start,
                {
                    "drag": case.value("drag"),
                    "grade": case.value("grade"),
                    "end_speed": case.option(0.0, case.value("vx")),
                },
            )
        found = case.call(f"travel.{name}", getattr(travel, name), first, **case.spoil(over))
        if not isinstance(found, Exception):
            assert np.all(~(np.asarray(found) < 0.0)), found
            assert case.mood != "plain" or np.all(np.isfinite(found)), found
    corners = case.choice((2, 2, 3, 3, 4, 1))
    points: Any = [case.pair("x") for _ in range(corners)]
    if case.maybe(0.1):
        points = case.option(
            np.array([case.number("x") for _ in range(2 * corners)]).reshape(corners, 2)
        )
    path = {name: segments(case, name, max(1, corners - 1)) for name in ("lock", "grade")} | {
        "friction": segments(case, "drag", max(1, corners - 1))
    }
    path |= {
        "headings": case.option(
            *[
                [
                    0.3 * case.value("heading")
                    if case.mood in ("plain", "extreme")
                    else case.value("heading")
                    for _ in range(corners)
                ]
            ]
            * 9,
            case.value("heading"),
        ),
        "end_speed": case.option(0.0, case.value("speed")),
        "window": case.option("7 m", 0.0, case.value("distance")),
    }
    if case.maybe(0.4):
        path |= {
            "point_error": case.option(0.1, case.value("distance")),
            "heading_error": case.option("3 deg", 0.0),
        }
    if case.maybe(0.3):
        path["tyres"] = tyres_of(case)
        if case.maybe(0.9):
            del path["lock"]
    if case.maybe(0.2):
        path["rotating_mass"] = case.option(0.03, case.value("lock"))
    found = case.call("travel.path", travel.path, points, **case.spoil(path))
    if isinstance(found, travel.RunOut):
        # A way that ends where it began has no straight course.
        closed = repr(points[0]) == repr(points[-1])
        free = {"travel.RunOut.course_difference", *(["travel.RunOut.straight_course"] * closed)}
        if (
            case.mood == "plain"
            and found.speed_error is not None
            and (found.speed_error == math.inf or case.maybe(0.05))
        ):
            wanted = speed_error(points, path)
            assert math.isnan(wanted) or math.isclose(
                found.speed_error, wanted, rel_tol=1e-6, abs_tol=1e-9
            ), wanted
            free |= {
                f"travel.RunOut.{name}"
                for name in ("speed_error", "yaw_rate_error")
                if wanted == math.inf
            }
        case.look(found, frozenset(free))


def speed_error(points: list[Any], path: dict[str, Any]) -> float:
    """That of a path of plain numbers, from the speeds with each of its readings off; NaN if one of
    those is no path.
    """
    place, turn = path["point_error"], math.radians(3.0) if path["heading_error"] else 0.0
    exact = {
        name: value for name, value in path.items() if name not in ("point_error", "heading_error")
    }
    total = 0.0
    for i in range(3 * len(points)):
        ends = []
        for sign in (1.0, -1.0):
            off = [
                [x, y, heading] for (x, y), heading in zip(points, path["headings"], strict=True)
            ]
            off[i // 3][i % 3] += sign * (place, place, turn)[i % 3]
            try:
                run = travel.path(
                    [(x, y) for x, y, _ in off],
                    **{**exact, "headings": [heading for *_, heading in off]},
                )
            except col.NoSolutionError:
                return math.inf
            except col.CollisionsError:
                return math.nan
            ends.append(run.speed)
        total += (0.5 * (ends[0] - ends[1])) ** 2
    return math.sqrt(total)


@fuzzes(
    "travel.Tyres", "travel.Tyres.replace", "travel.Tyres.summary",
    "travel.simulate",
    "travel.SimulatedPath",
    "travel.SimulatedPath.at", "travel.SimulatedPath.summary", "plot.path", share=0.2,
)  # fmt: skip
def test_simulated_travel(case: Case) -> None:
    """One vehicle or many from separation to rest: at rest, or refused."""
    mass = case.number("mass")
    # A lorry with the yaw inertia of a wheelbarrow takes ten thousand steps.
    body = vehicle(case, mass=mass, yaw_inertia=mass * case.uniform(0.5, 4.0))
    given: dict[str, Any] = {
        "friction": case.value("drag"),
        "lock": case.option(case.value("lock"), [case.value("lock")] * 4),
    }
    size = case.choice(("wheelbase", "wheelbase", "distance"))
    given |= {"wheelbase": case.value(size), "track": case.value(size)}
    if case.maybe(0.3):
        given |= {"steer": case.value("heading"), "height": case.option(None, 0.4)}
    if case.maybe(0.3):
        given["cornering"] = case.option(8.0, 9.5, case.value("drag"))
    tyres = case.call("travel.Tyres", travel.Tyres, **case.spoil(given))
    if isinstance(tyres, travel.Tyres):
        case.must("travel.Tyres.replace", tyres.replace)
        assert str(case.must("travel.Tyres.summary", tyres.summary, case.choice(UNIT_SYSTEMS)))
        case.look(tyres)
    ground: dict[str, Any] = {}
    if case.maybe(0.2):
        corners = [case.pair("x") for _ in range(case.choice((2, 3, 3, 4, 5)))]
        ground["surfaces"] = case.option([(corners, case.value("drag"))], case.garbage())
    if case.maybe(0.2):
        ground["slope"] = case.option((0.02, "1 %"), case.garbage())
    if case.maybe(0.2):
        ground["rotating_mass"] = case.option(0.03, "4 %", case.value("lock"))
    if case.maybe(0.2):
        ground["until"] = case.option("2 s", 30.0)
    ground |= {"moments": case.option(2, 9), "tolerance": case.option(1e-4, 1e-5)}
    # What hardly slows takes ten thousand steps, and is refused for it as after fifteen hundred.
    with mock.patch.object(motion_of_wheels, "_MOST_STEPS", 10_000 if case.maybe(0.01) else 1_500):
        found = case.call("travel.simulate", travel.simulate, body, tyres, **case.spoil(ground))
    if isinstance(found, travel.SimulatedPath):
        assert np.all(np.diff(found.time, axis=0)[~np.isnan(np.diff(found.time, axis=0))] >= 0.0)
        assert str(
            case.must("travel.SimulatedPath.summary", found.summary, case.choice(UNIT_SYSTEMS))
        )
        case.must("travel.SimulatedPath.at", found.at, 0.3)
        several = case.array("duration", case.choice(((2,), (3,), (2, 1))))
        moment = several if case.maybe(0.3) else case.value("duration")
        case.call("travel.SimulatedPath.at", found.at, moment)
        # A case of a batch that was refused, for its many steps at the latest, is NaN throughout,
        # and one that still moves as it is left is NaN later.
        moves = found.time.ndim > 1 and np.any(found.end.speed > 0.0)
        refused = moves or np.isnan(found.x[0]).any()
        undefined = {f"Vehicle.{name}" for name in ("course", "kinetic_energy", "yaw_inertia")}
        case.look(found, None if refused else frozenset({"travel.SimulatedPath.marks"} | undefined))
        if case.maybe(0.2):
            outlines = {f"outline_{v}": outline(case) if case.maybe(0.3) else None for v in "ab"}
            drawn(case, "path", found, case.option(None, found), **outlines)


# --- scenes ---------------------------------------------------------------------------------------


def scene_vehicle(case: Case, name: str, x: float) -> col.Vehicle | Exception:
    """A car near x, that moves along the road or stands."""
    mass = case.number("mass")
    fields: dict[str, Any] = {
        "mass": mass,
        "yaw_inertia": mass * case.uniform(1.0, 2.0),
        "x": x + case.uniform(-0.5, 0.5),
        "y": case.uniform(-0.5, 0.5),
        "heading": case.choice((0.0, 1.5, case.number("heading"))),
        "vx": case.choice((0.0, case.number("vx"))),
    }
    for field in fields:
        if case.mood != "plain" and case.maybe(0.1):
            fields[field] = case.value(field)
    if case.maybe(0.05):
        del fields[case.choice(("yaw_inertia", "x", "heading"))]
    made = case.call("Vehicle", col.Vehicle, **case.spoil(fields), name=name)
    return made


def scene_tyres(case: Case) -> Any:
    """Tyres that stop a car soon."""
    lock = case.choice((1.0, 0.4, [1.0, 0.3, 0.3, 0.3], 0.0 if case.maybe(0.1) else 0.2))
    friction = case.value("drag") if case.maybe(0.2) else case.uniform(0.4, 0.9)
    return case.call("travel.Tyres", travel.Tyres, friction, lock, 2.7, 1.5)


def scene_movers(case: Case) -> dict[str, Any]:
    """One to three movers in a row."""
    found: dict[str, Any] = {}
    for k in range(case.choice((1, 2, 2, 2, 3))):
        given: dict[str, Any] = {"vehicle": scene_vehicle(case, "ABC"[k], 7.0 * k)}
        if case.maybe(0.9):
            given["outline"] = outline(case) if case.maybe(0.2) else (4.5, 1.8)
        how = case.random()
        if how < 0.5:
            given["tyres"] = scene_tyres(case)
        elif how < 0.8:
            given["drag"] = case.value("drag")
        mover = case.call("scene.Mover", scene.Mover, **case.spoil(given))
        if isinstance(mover, scene.Mover):
            case.must("scene.Mover.as_given", mover.as_given, name="vehicle")
            case.call("scene.Mover.as_given", mover.as_given, case.option("drag", "mass"))
            case.must("scene.Mover.replace", mover.replace, drag=None)
            assert str(case.must("scene.Mover.summary", mover.summary, case.choice(UNIT_SYSTEMS)))
        found["ABC"[k]] = mover
    return found


def scene_contact(case: Case, a: Any, b: Any) -> Any:
    """A contact of two names, with anything that a contact may have."""
    given: dict[str, Any] = {"a": a, "b": b, "restitution": case.value("restitution")}
    model = case.option(None, None, "eccentric", "solve", "linear_central", "oblique_central")
    if not (isinstance(model, str) and model == "linear_central"):
        given[case.choice(("friction", "friction", "impulse_ratio", "critical_fraction"))] = (
            case.number("critical_fraction")
        )
    if case.maybe(0.7):
        given["model"] = model
    if case.maybe(0.6):
        given["at"] = "touch"
        if case.maybe(0.4):
            given[case.choice(("depth", "delay"))] = case.choice((0.0, 0.02, case.value("width")))
    elif case.maybe(0.3):
        given["at"] = case.value("duration")
    if case.maybe(0.4):
        given["normal"] = case.option(0.0, case.value("normal"), (1.0, 0.1))
        if case.maybe(0.6):
            given["point"] = case.pair("x")
    elif case.maybe(0.3):
        given["plane"] = case.option("crossings", "face")
    if isinstance(model, str) and model == "solve" and case.maybe(0.6):
        given["tolerance"] = case.value("tolerance")
    if case.maybe(0.1):
        given |= {"duration": case.value("duration"), "model": case.option("eccentric", "solve")}
    if case.maybe(0.1):
        given["tyres_after"] = {a: scene_tyres(case)}
    if case.maybe(0.2):
        given["law"] = case.option("brach", "kudlich-slibar", "stronge")
    if case.maybe(0.1):
        given["incomplete"] = case.option(True, False)
    contact = case.call("scene.Contact", scene.Contact, **case.spoil(given))
    if isinstance(contact, scene.Contact):
        case.must("scene.Contact.as_given", contact.as_given, name="restitution")
        case.call("scene.Contact.as_given", contact.as_given, case.option("point", "given"))
        case.must("scene.Contact.replace", contact.replace, restitution=0.1)
        assert str(case.must("scene.Contact.summary", contact.summary, case.choice(UNIT_SYSTEMS)))
    return contact


def known_scene() -> scene.Scene:
    """A plain one, in which A runs into B."""
    bodies = {
        name: col.Vehicle(mass=1500.0, vx=vx, x=x, y=0.0, heading=0.0, yaw_inertia=2500.0)
        for name, vx, x in (("A", 15.0, 0.0), ("B", 0.0, 8.0))
    }
    row = {"normal": 0.0, "model": "linear_central", "at": "touch"}
    return scene.Scene(
        movers={
            name: scene.Mover(body, outline=(4.5, 1.8), drag=0.6) for name, body in bodies.items()
        },
        contacts=[scene.Contact("A", "B", restitution=0.1, **row)],
    )


@fuzzes(
    "play", "plot.timeline",
    "Cost", "Level", "Level.as_model", "Level.results", "Required", "Required.summary",
    "Required.to_dict",
    "Moved", "Moved.summary", "Notice", "Rests", "Rests.keys", "Track", "Track.summary",
    "scene.Contact", "scene.Contact.as_given", "scene.Contact.replace", "scene.Contact.summary",
    "scene.Mover", "scene.Mover.as_given", "scene.Mover.replace", "scene.Mover.summary",
    "scene.Run", "scene.Run.at", "scene.Run.case", "scene.Run.from_dict", "scene.Run.summary",
    "scene.Run.to_columns", "scene.Run.to_dict",
    "scene.Scene", "scene.Scene.as_model", "scene.Scene.case", "scene.Scene.from_dict",
    "scene.Scene.inputs", "scene.Scene.mark_points", "scene.Scene.replace", "scene.Scene.required",
    "scene.Scene.results", "scene.Scene.run",
    "scene.Scene.summary", "scene.Scene.to_dict", share=0.3,
)  # fmt: skip
def test_scenes(case: Case) -> None:
    """Movers, contacts and ground of any kind: a run, or a refusal."""
    movers = scene_movers(case)
    names = list(movers)
    contacts = [
        scene_contact(case, one, two) for one, two in itertools.pairwise(names) if case.maybe(0.85)
    ]
    given: dict[str, Any] = {"movers": case.option(movers), "contacts": case.option(contacts)}
    if case.maybe(0.15):
        corners = [case.pair("x") for _ in range(case.choice((2, 3, 4)))]
        given["surfaces"] = case.option([(corners, case.value("drag"))])
    if case.maybe(0.15):
        given["slope"] = case.option((0.02, "1 %"), case.pair("restitution"))
    if case.maybe(0.15):
        given["order"] = case.option([("A", "B")], [])
    if case.maybe(0.15):
        given["shared"] = case.option(
            {"e": ["contacts[0].restitution"]}, {"m": ["A.mass", "B.mass"]}
        )
    made = case.call("scene.Scene", scene.Scene, **case.spoil(given))
    if not isinstance(made, scene.Scene):
        made = known_scene()
    paths = case.must("scene.Scene.inputs", made.inputs)
    results = case.must("scene.Scene.results", made.results)
    record = json.dumps(case.must("scene.Scene.to_dict", made.to_dict), allow_nan=False)
    again = case.must("scene.Scene.from_dict", scene.Scene.from_dict, json.loads(record))
    assert case.mood in ("extreme", "odd", "batch") or again == made
    case.call("scene.Scene.from_dict", scene.Scene.from_dict, case.garbage())
    assert str(case.must("scene.Scene.summary", made.summary, case.choice(UNIT_SYSTEMS)))
    path = case.choice(list(paths))
    name = path.rpartition(".")[2].partition("[")[0]
    changes = case.option({path: case.value(name if name in RANGES else "x")}, {"A.z": 1.0})
    changed = case.call("scene.Scene.replace", made.replace, changes)
    if isinstance(changed, scene.Scene):
        made = changed
    if made.shape is not None:
        case.call("scene.Scene.case", made.case, case.option(0, 1, (0,)))
    wanted = case.sample(list(results), 2)
    seen = case.call(
        "scene.Scene.mark_points",
        made.mark_points,
        **case.spoil(
            {
                "name": case.option(*made.movers),
                "wheel": case.option("front_left", "rear_right"),
                "points": case.option([case.pair("x"), case.pair("x")]),
                "error": case.value("width"),
                "begins": case.option(True, False),
                "ends": case.option(True, False),
            }
        ),
    )
    if isinstance(seen, dict):
        wanted += seen
    with mock.patch.object(motion_of_wheels, "_MOST_STEPS", 1_500):
        found = case.call(
            "scene.Scene.run", made.run, **case.spoil({"tolerance": case.option(1e-4, 1e-3)})
        )
        names = case.option([path], [path], [case.garbage()])
        outputs = wanted if case.maybe(0.8) else case.option(wanted, [case.garbage()])
        model = case.call("scene.Scene.as_model", made.as_model, names, outputs, tolerance=1e-3)
        if callable(model):
            case.call("model of a scene", model, **{path: case.number(name)})
        if not isinstance(found, scene.Run):
            found = known_scene().run()
        ran(case, found)
        levels(case, known_scene())


def levels(case: Case, crash: scene.Scene) -> None:
    """Levels of a scene, with what is not known or without."""
    result = case.choice(list(crash.results()))
    kind = case.choice(("delta_v", "mass", "x"))
    unknowns = case.option(
        {"A.vx": uncertainty.Normal(8.0, 0.5)}, {"A.mass": uncertainty.Uniform("1 t", "2 t")}, {}
    )
    given = {
        "tolerances": {result: case.value(kind)},
        "unknowns": unknowns,
        "draws": case.option(32, 40),
        "tolerance": 1e-3,
    }
    found = case.call("scene.Scene.required", crash.required, **case.spoil(given))
    if isinstance(found, Exception):
        found = known_scene().required({"B.rest.x": 0.3}, tolerance=1e-3)
    assert case.must("Required", lambda: found) is found
    json.dumps(case.must("Required.to_dict", found.to_dict), allow_nan=False)
    assert str(case.must("Required.summary", found.summary, case.choice(UNIT_SYSTEMS)))
    level = case.must("Level", lambda: found.level)
    assert case.must("Level.results", level.results)
    paths = [next(iter(level.given.inputs()))]
    wanted = case.option(["B.rest.x"], ["q"])
    model = case.call("Level.as_model", level.as_model, paths, wanted, tolerance=1e-4)
    assert callable(model) or isinstance(model, Exception)
    assert case.must("Cost", lambda: repr(found.costs[0]))


def ran(case: Case, run: scene.Run) -> None:
    """Everything of a run."""
    record = json.dumps(case.must("scene.Run.to_dict", run.to_dict), allow_nan=False)
    case.must("scene.Run.from_dict", scene.Run.from_dict, json.loads(record))
    case.call("scene.Run.from_dict", scene.Run.from_dict, case.garbage())
    case.call("scene.Run.at", run.at, case.value("duration"))
    if run.scene.shape is not None:
        case.call("scene.Run.case", run.case, case.option(0, 1))
    case.must("scene.Run.to_columns", run.to_columns, units=case.choice((None, "us")))
    assert str(case.must("scene.Run.summary", run.summary, case.choice(UNIT_SYSTEMS)))
    one = run[next(iter(run.scene.movers))]
    case.call("Moved.summary", one.summary, case.choice(UNIT_SYSTEMS))
    track = case.must("Track", lambda: one.path)
    assert str(case.must("Track.summary", track.summary, case.choice(UNIT_SYSTEMS)))
    case.call("Moved", lambda: one.rest)
    assert list(case.must("Rests.keys", run.rest.keys)) == list(run.scene.movers)
    case.call("scene.Run", lambda: run.energy)
    drawn(case, "timeline", run)
    drawn(case, "scene", run)
    checked = case.call("diagnose", col.diagnose, run, **case.spoil({"drag": case.value("drag")}))
    assert isinstance(checked, Exception) or str(checked)
    explained(case, run)
    form = {"form": case.option("markdown"), "figures": False}
    whole = case.call("report", col.report, run, **case.spoil(form))
    if not isinstance(whole, Exception):
        case.call("reporting.replay", reporting.replay, whole)
    page = case.call("play", col.play, run, **case.spoil({"units": case.option(*UNIT_SYSTEMS)}))
    assert isinstance(page, Exception) or page.startswith("<!DOCTYPE html>")
    case.look(run, None, thorough=False)
    apart = known_scene().replace({"A.vx": 8.0, "A.x": 1.0})
    case.look(scene.Scene(movers=apart.movers, contacts=[]).run().findings)


# --- uncertainty ----------------------------------------------------------------------------------

KINDS = ("Normal", "LogNormal", "Uniform", "Triangular", "Interval", "Samples")
INPUT_OPEN = frozenset(f"uncertainty.{name}.support" for name in KINDS)


def stated_numbers(case: Case, kind: str) -> list[Any]:
    """Arguments of a distribution."""
    name = case.choice(("vx", "mass", "speed"))
    low = case.number(name)
    spread = 0.1 * abs(low) + case.random()
    found: list[Any] = {
        "Normal": [low, spread],
        "LogNormal": [abs(low) + 0.1, spread],
        "Uniform": [low, low + spread],
        "Triangular": [low, low + 0.3 * spread, low + spread],
        "Interval": [low, low + spread],
        "Samples": [[low, low + spread, low + 0.4 * spread]],
    }[kind]
    if case.mood == "written" and kind != "Samples":
        return [f"{value!r} m/s" for value in found]
    if case.mood in ("extreme", "odd") and case.maybe(0.7):
        found[case.randrange(len(found))] = (
            case.value(name) if case.mood == "extreme" else case.garbage()
        )
    if case.mood == "batch" and kind == "Samples":
        return [case.array(name)]
    return found


def distribution(case: Case, kind: str) -> Any:
    """A distribution of this kind, or its refusal."""
    keywords = {}
    args = stated_numbers(case, kind)
    if kind in ("Normal", "LogNormal") and case.maybe(0.4):
        ends = [
            f"{end!r} m/s" if case.mood == "written" else end
            for end in (case.number("speed"), 50.0)
        ]
        keywords["truncate"] = case.option(
            (ends[0], ends[1]),
            (ends[0], None),
            (None, ends[1]),
            (case.value("vx"), case.value("vx")),
        )
    return case.call(f"uncertainty.{kind}", getattr(uncertainty, kind), *args, **keywords)


@fuzzes(
    *(f"uncertainty.{kind}" for kind in KINDS), "uncertainty.Distribution",
    "uncertainty.Normal.between", "uncertainty.LogNormal.between",
    "uncertainty.Samples.joint", "uncertainty.Distribution.quantile",
    "uncertainty.Distribution.scored",
)  # fmt: skip
def test_distributions(case: Case) -> None:
    """Made of anything; quantiles and scores of anything; every quantile lies in the support."""
    made = [distribution(case, kind) for kind in KINDS]
    low, high = case.choice(
        (
            (1.0, 2.0),
            sorted((case.number("speed"), case.number("speed"))),
            (case.value("speed"), case.value("speed")),
        )
    )
    coverage = case.option(0.95, case.random(), case.value("share_a"), case.extreme())
    for kind in ("Normal", "LogNormal"):
        options = (
            {
                "truncate": case.option(
                    None, (low, None), (low, high), (case.value("vx"), case.value("vx"))
                )
            }
            if case.maybe(0.3)
            else {}
        )
        between = getattr(uncertainty, kind).between
        made.append(
            case.call(
                f"uncertainty.{kind}.between", between, low, high, coverage, **case.spoil(options)
            )
        )
    columns = {
        name: case.option([1.0, 2.0, case.value("vx")], case.array("vx", (3,)), case.value("vx"))
        for name in ("one", "two")
    }
    joint = case.call("uncertainty.Samples.joint", uncertainty.Samples.joint, **columns)
    if isinstance(joint, dict):
        made += joint.values()
    for one in made:
        if isinstance(one, uncertainty.Distribution | uncertainty.Interval):
            case.look(one, INPUT_OPEN | {"uncertainty.Distribution.support"})
        if not isinstance(one, uncertainty.Distribution):
            continue
        p = case.option(0.5, 0.0, 1.0, case.random(), np.array([0.1, 0.9]), case.value("share_a"))
        z = case.option(0.0, 1.0, case.gauss(0.0, 2.0), np.array([-1.0, 3.0]), case.value("vx"))
        start, end = one.support
        for label, found in (
            ("quantile", case.call("uncertainty.Distribution.quantile", one.quantile, p)),
            ("scored", case.call("uncertainty.Distribution.scored", one.scored, z)),
        ):
            if not isinstance(found, Exception):
                assert type(found) is float or found.dtype == np.float64, (label, found)
                assert np.all((found >= start) & (found <= end)), (
                    f"{label} of {one!r} is {found}, outside {start} to {end}"
                )
    case.look(
        case.choice(
            [one for one in made if isinstance(one, uncertainty.Distribution)]
            or [uncertainty.Uniform(0, 1)]
        ),
        INPUT_OPEN,
    )


METHODS = (
    "first_order",
    "second_order",
    "latin_hypercube",
    "quasi_random",
    "monte_carlo",
    "interval",
)
OUTPUT_OPEN = INPUT_OPEN | {
    f"uncertainty.{name}"
    for name in (
        "Output.mean_standard_error", "Output.std_standard_error",
        "Output.contribution_standard_errors", "Output.contributions",
        "Output.total_contributions", "Output.mean", "Output.std", "Output.values", "Output.unit",
        "Shares.first_error", "Shares.total_error", "Shares.total",
        "Shares.first", "Histogram.standard_errors", "Propagation.correlation",
        "Halved.now", "Halved.widths", "Halved.units", "Halved.coverage",
    )
}  # fmt: skip


def rear_end(speed: Any, restitution: Any, mass: Any) -> dict[str, Any]:
    """A real impact."""
    a, b = col.Vehicle(mass=mass, vx=speed), col.Vehicle(mass=1200.0)
    impact = col.linear_central(a, b, restitution, on_failure="nan")
    return {"delta_v": impact.b.q.delta_v, "energy_loss": impact.energy_loss, "hit": impact.ok}


def slower(speed: Any, restitution: Any, mass: Any) -> dict[str, Any]:
    """The same impact at a lower speed."""
    return rear_end(0.97 * speed, restitution, mass)


def scaled(speed: Any, restitution: Any, mass: Any) -> dict[str, Any]:
    """Numbers of any size, with and without a unit; whatever it is called with."""
    count = next(
        (len(value) for value in (speed, restitution, mass) if isinstance(value, np.ndarray)), 1
    )
    x, _, y = (
        value if isinstance(value, float | np.ndarray) else 1.0
        for value in (speed, restitution, mass)
    )
    turned = np.broadcast_to(np.arctan2(x, y), count)
    return {
        "delta_v": np.broadcast_to(np.divide(x * x, y), count),
        "energy_loss": registries()[0].Quantity(turned, "rad"),
    }


def propagation(case: Case) -> Any:
    """A propagation, or its refusal."""
    ranges = {"speed": (2.0, 30.0), "restitution": (0.0, 1.0), "mass": (800.0, 2000.0)}
    inputs: dict[str, Any] = {}
    for name, (low, high) in ranges.items():
        ends = sorted((case.uniform(low, high), case.uniform(low, high)))
        middle = 0.5 * (ends[0] + ends[1])
        inputs[name] = case.choice(
            (
                lambda ends=ends, middle=middle: uncertainty.Normal(
                    middle, 0.2 * (ends[1] - ends[0]), truncate=(0.0, None)
                ),
                lambda ends=ends: uncertainty.Uniform(*ends),
                lambda ends=ends, middle=middle: uncertainty.Triangular(ends[0], middle, ends[1]),
                lambda ends=ends, middle=middle: uncertainty.Samples([*ends, middle]),
                lambda middle=middle: middle,
            )
        )()
    # Local methods ask for thousands of cases beside, to be compared with them.
    method = case.choice(METHODS[:5] if case.maybe(0.3) else METHODS[2:5])
    if case.maybe(0.01):
        method = "interval"
        inputs |= {
            "speed": uncertainty.Interval(3.0, case.uniform(4.0, 30.0)),
            "restitution": uncertainty.Interval(0.0, case.random() + 0.1),
        }
    elif case.maybe(0.0003):
        # Of an interval beside distributions every figure is searched for, which takes a second.
        inputs["mass"] = uncertainty.Interval(1000.0, case.uniform(1100.0, 2000.0))
    options: dict[str, Any] = {"method": method, "seed": case.randrange(2**64)}
    if method in METHODS[2:5]:
        options["samples"] = case.choice((64, 64, 100, 128))
        if case.maybe(0.1):
            # Wide enough to be met by some hundred cases.
            del options["samples"]
            options["tolerance"] = case.option(
                case.uniform(1e3, 1e6), {"delta_v": case.uniform(1.0, 5.0)}, "5 m/s"
            )
    if case.maybe(0.1):
        options |= run_options(case)
    if case.maybe(0.2):
        options["correlation"] = {("speed", "mass"): case.uniform(-1.0, 1.0)}
    if case.maybe(0.3):
        options["finer"] = case.option(rear_end, slower, slower, scaled)
        if case.maybe(0.5):
            options["finer_samples"] = case.option(64, 100, 512)
    model: Any = rear_end if case.maybe(0.7) else scaled
    if case.maybe(0.05):
        model, inputs = known_scene(), {"A.vx": uncertainty.Uniform(10.0, case.uniform(11.0, 20.0))}
        options.pop("correlation", None)
        options["outputs"] = case.option(
            ["B.rest.x"],
            ["times[0]", "impacts[0].a.delta_v"],
            ["contacts[0].impact.B.ees(0.5)", "end - contacts[0].impact.time"],
        )
    if case.mood == "extreme":
        inputs[case.choice(sorted(inputs))] = case.extreme()
        model = scaled
    if case.mood == "odd":
        name = case.choice(
            ("model", "inputs", "method", "samples", "seed", "correlation", "input", "input")
        )
        value = case.garbage()
        if name == "input":
            inputs[case.choice(sorted(inputs))] = value
            model = scaled
        elif name == "model":
            model = case.choice(
                (value, lambda **inputs: value, lambda **inputs: {"delta_v": value})
            )
        elif name == "inputs":
            inputs = case.choice((value, {}, {"speed": uncertainty.Uniform(0, 1), 3: 1.0}))
        else:
            options[name] = value
            if name == "samples" and isinstance(value, int) and value > 10**4:
                options[name] = 64
    return case.call(
        "uncertainty.propagate", uncertainty.propagate, model, inputs, **case.spoil(options)
    )


def sided(case: Case, made: list[Any]) -> Any:
    """A model whose output is known from one side only in some cases."""
    sides = case.option(0, 1, -1, np.array([1, 0, -1, 1] * 16))
    # Drawn once: a model answers the same whenever it is asked.
    same = case.option(None, 3.0)

    def model(**inputs: Any) -> Any:
        (name,) = inputs
        answered = case.call(
            "uncertainty.OneSided",
            uncertainty.OneSided,
            inputs[name] if same is None else same,
            sides,
        )
        made.append(answered)
        return {"known": inputs[name], "sided": answered}

    return model


@fuzzes("uncertainty.OneSided")
def test_one_sided(case: Case) -> None:
    """Any values and sides, alone and as the output of a model; figures of an answer are numbers,
    infinities or NaN, and every text can be written.
    """
    given = {
        "values": case.option(3.0, "3 m/s", np.array([1.0, 2.0]), np.array([1.0, math.nan])),
        "sides": case.option(0, 1, -1, [1, -1], np.array([0, 1])),
    }
    case.call("uncertainty.OneSided", uncertainty.OneSided, **case.spoil(given))
    made: list[Any] = []
    inputs = {"x": uncertainty.Uniform(0.0, case.uniform(1.0, 20.0))}
    options = {"samples": 64, "seed": case.randrange(2**64)}
    found = case.call(
        "uncertainty.propagate", uncertainty.propagate, sided(case, made), inputs, **options
    )
    if not isinstance(found, uncertainty.Propagation):
        return
    output = found["sided"]
    low, high = output.interval()
    assert low <= high or math.isnan(low + high)
    assert json.dumps(found.to_dict(), allow_nan=False)
    assert str(found) + repr(output) + str(output.summary())


@fuzzes(
    "Note",
    "uncertainty.propagate", "uncertainty.Propagation", "uncertainty.Propagation.to_dict",
    "uncertainty.Output", "uncertainty.Shares",
    "uncertainty.Histogram",
    *(f"uncertainty.Output.{name}" for name in ("quantile", "quantile_standard_error", "interval",
    "histogram", "row", "record")),
)  # fmt: skip
def test_propagation(case: Case) -> None:
    """Any inputs, model and method; every figure of every output."""
    found = propagation(case)
    if not isinstance(found, uncertainty.Propagation):
        found = known_propagation()
    sampled = found.method not in ("first_order", "second_order", "interval")
    shares = case.maybe(0.15) and not (sampled and case.maybe(0.8))
    case.look(
        {
            name: getattr(found, name)
            for name in ("method", "samples", "failed", "seed", "interrupted")
        }
    )
    if shares:
        case.look(found, OUTPUT_OPEN)
        assert json.dumps(
            case.must("uncertainty.Propagation.to_dict", found.to_dict), allow_nan=False
        )
    else:
        known_shares(case)
    case.call("uncertainty.Propagation", found.__getitem__, case.option("delta_v", case.garbage()))
    for name in case.sample(list(found), 1):
        output = found[name]
        p = case.option(0.5, 0.0, 1.0, case.random(), [0.1, 0.9], case.value("share_a"))
        for label in ("quantile", "quantile_standard_error"):
            case.call(f"uncertainty.Output.{label}", getattr(output, label), p)
        ends = case.call(
            "uncertainty.Output.interval",
            output.interval,
            case.option(0.95, case.random(), case.value("share_a")),
        )
        assert isinstance(ends, Exception) or not ends[0] > ends[1]
        bars = case.call(
            "uncertainty.Output.histogram",
            output.histogram,
            case.option(40, 1, 7, case.randrange(-5, 200)),
        )
        if isinstance(bars, uncertainty.Histogram):
            case._look_at(bars, uncertainty.Histogram, OUTPUT_OPEN, False)
            assert len(bars.edges) == len(bars.shares) + 1
        assert len(case.must("uncertainty.Output.row", output.row)) == 2
        if shares:
            assert json.dumps(
                case.must("uncertainty.Output.record", output.record), allow_nan=False
            )


@functools.cache
def known_propagation() -> uncertainty.Propagation:
    """A propagation whose shares are worked out once."""
    inputs = {
        "speed": uncertainty.Normal(10.0, 1.0),
        "restitution": uncertainty.Uniform(0.0, 0.3),
        "mass": 1500.0,
    }
    return uncertainty.propagate(rear_end, inputs, method="first_order")


def known_shares(case: Case) -> None:
    """What is slow of a sampled output is read of one that has it."""
    known = known_propagation()
    case.look(known, OUTPUT_OPEN, thorough=False)
    case.must("uncertainty.Propagation.to_dict", known.to_dict)
    output = known[case.choice(list(known))]
    case.must("uncertainty.Output.record", output.record)
    case._look_at(output._shares(), uncertainty.Shares, OUTPUT_OPEN, False)


@fuzzes(
    "uncertainty.Output.probability",
    "uncertainty.Propagation.probability",
    "uncertainty.Propagation.if_halved",
    "uncertainty.Halved",
    "uncertainty.Halved.to_dict",
    "uncertainty.Halved.summary",
)
def test_questions_to_a_propagation(case: Case) -> None:
    """Any condition, of one output and of all; what half an error leaves of every range."""
    found = propagation(case)
    if not isinstance(found, uncertainty.Propagation):
        found = known_propagation()
    limit = case.number("vx")
    name = case.choice(list(found))
    for label, ask, condition in (
        ("Output", found[name].probability, lambda values: values > limit),
        ("Propagation", found.probability, lambda at: (at[name] > limit) & ~(at[name] > 9.0)),
    ):
        asked = case.call(f"uncertainty.{label}.probability", ask, case.option(condition))
        if not isinstance(asked, Exception):
            chance, error = asked
            assert 0.0 <= chance <= 1.0
            assert not error < 0.0
    widths = case.call("uncertainty.Propagation.if_halved", found.if_halved)
    if isinstance(widths, uncertainty.Halved):
        case.look(widths, OUTPUT_OPEN)
        assert all(width >= 0.0 or math.isnan(width) for width in widths.now.values())
        assert json.dumps(case.must("uncertainty.Halved.to_dict", widths.to_dict), allow_nan=False)
        case.call("uncertainty.Halved", widths.__getitem__, case.option(*widths))
        table = case.must(
            "uncertainty.Halved.summary", widths.summary, units=case.choice((None, *UNIT_SYSTEMS))
        )
        assert isinstance(str(table) + table._repr_html_(), str)


# --- summaries ------------------------------------------------------------------------------------


@fuzzes("options")
def test_options(case: Case) -> None:
    """Any value; numbers are read as before after the block."""
    with (
        contextlib.suppress(col.InputError),
        case.must("options", col.options, require_units=case.maybe(0.5)),
    ):
        case.call("Vehicle", col.Vehicle, mass=case.value("mass"), vx=case.value("vx"))
    case.call("options", col.options, require_units=case.garbage())
    col.options(require_units=False)


@fuzzes(
    "Vehicle.summary", "Impact.summary", "VehicleResult.summary", "ModelChoice.summary",
    "LeftOut.summary",
    "LeftOutVehicle.summary", "Pulse.summary",
    "Findings.summary", "Estimate.summary", "Residual.summary", "reconstruct.Fit.summary",
    "reconstruct.MomentumSolution.summary",
    "travel.RunOut.summary", "uncertainty.Propagation.summary", "uncertainty.Output.to",
    "uncertainty.Output.summary",
)  # fmt: skip
def test_summaries(case: Case) -> None:
    """A table of any result, in any units, as text and for a notebook."""
    a, b, found = meeting(case, "eccentric")
    results: dict[str, Any] = {"Vehicle": a}
    if case.maybe(0.2):
        # These are always the same; only the units differ.
        results |= {
            "reconstruct.Fit": known_fit(),
            "Estimate": known_fit()["x"],
            "Residual": known_fit().residuals["s"],
        }
        results |= {"uncertainty.Propagation": known_propagation(), "Pulse": known_impact(6).pulse}
        results |= {"uncertainty.Output": known_propagation()["delta_v"]}
    impact = case.call(
        "eccentric", col.eccentric, a, b, case.number("restitution"), **found, on_failure="nan"
    )
    if isinstance(impact, col.Impact):
        left = case.call("left_out", col.left_out, impact)
        findings = case.call("diagnose", col.diagnose, impact)
        results |= {
            "Impact": impact,
            "VehicleResult": impact.b,
            "LeftOut": left,
            "LeftOutVehicle": getattr(left, "a", None),
        }
        results |= {"Findings": findings}
    courses = {
        name: case.number("heading")
        for name in ("course_a", "course_b", "course_a_after", "course_b_after")
    }
    known = {
        "speed_a_after": case.number("speed"),
        "speed_b_after": case.number("speed"),
        **courses,
    }
    results["reconstruct.MomentumSolution"] = case.call(
        "reconstruct.momentum",
        reconstruct.momentum,
        case.number("mass"),
        case.number("mass"),
        **known,
    )
    results["travel.RunOut"] = case.call(
        "travel.path",
        travel.path,
        [(0.0, 0.0), (case.number("x"), 20.0)],
        [0.0, 1.0],
        friction=0.7,
        lock=case.random(),
    )
    results["ModelChoice"] = case.call("required_model", col.required_model, a, b, 0.1, **found)
    for name, result in results.items():
        if result is not None and not isinstance(result, Exception):
            table = case.call(f"{name}.summary", result.summary, case.option(None, *UNIT_SYSTEMS))
            if not isinstance(table, Exception):
                assert isinstance(str(table) + table._repr_html_(), str)
    ends = case.call(
        "uncertainty.Output.to", known_in_mph().to, case.option("mph", "km/h", "ft/s", "kg")
    )
    assert isinstance(ends, Exception) or ends.mean > 0.0


@functools.cache
def known_in_mph() -> uncertainty.Output:
    """An output with a unit."""
    speed = uncertainty.Normal("30 mph", "2 mph")
    return uncertainty.propagate(
        lambda v: {"v": col.Vehicle(mass=1.0, vx=v).q.vx}, {"v": speed}, seed=1, samples=64
    )["v"]


# --- reference ------------------------------------------------------------------------------------


@fuzzes(
    "reference.restitution", "reference.restitution_range", "reference.restitution_by_overlap",
    "reference.drag_factor", "reference.yaw_inertia", "reference.Published",
    "reference.Fit",
)  # fmt: skip
def test_reference(case: Case) -> None:
    """Published values of anything."""
    speed = case.value("speed")
    e = case.call(
        "reference.restitution",
        reference.restitution,
        speed,
        **case.spoil({"outside": case.option("warn", "refuse")}),
    )
    assert isinstance(e, Exception) or np.all(
        (np.asarray(e) >= 0.0) & (np.asarray(e) <= 1.0) | np.isnan(e)
    ), e
    assert not isinstance(e, float) or math.isfinite(e)
    ends = case.call("reference.restitution_range", reference.restitution_range, speed)
    assert isinstance(ends, Exception) or np.all((ends[0] <= ends[1]) | np.isnan(ends[0])), ends
    case.call(
        "reference.restitution_by_overlap",
        reference.restitution_by_overlap,
        case.value("restitution"),
    )
    surface = case.option("new dry asphalt", "travelled dry asphalt", "polished dry asphalt", "ice")
    row = case.call(
        "reference.drag_factor",
        reference.drag_factor,
        surface,
        **case.spoil({"speed": case.value("speed")}),
    )
    row = case.choice(reference.PUBLISHED) if isinstance(row, Exception) else row
    case.look(row)
    case.look(case.choice(reference.FITS))
    inside = case.call("reference.Published", row.__contains__, case.value("drag"))
    assert isinstance(inside, bool | Exception), inside
    size: dict[str, Any] = {
        "length": case.value("length"),
        case.choice(("wheelbase", "wheelbase", "width")): case.value("wheelbase"),
    }
    if case.maybe(0.1):
        size["width"] = case.option(None, case.value("width"))
    if case.maybe(0.2):
        size["outside"] = case.option("warn", "refuse")
    inertia = case.call(
        "reference.yaw_inertia", reference.yaw_inertia, case.value("mass"), **case.spoil(size)
    )
    assert not isinstance(inertia, float) or 0.0 <= inertia < math.inf, inertia


# --- plot -----------------------------------------------------------------------------------------


@functools.cache
def blank() -> Any:
    """One Axes for every picture."""
    return plt.subplots()[1]


def drawn(case: Case, name: str, *args: Any, **options: Any) -> None:
    """One picture, on Axes that are used again; a few are rendered."""
    axes = blank()
    if axes.has_data() or axes.texts:
        axes.clear()
    found = case.call(
        f"plot.{name}",
        getattr(plot, name),
        *args,
        **case.spoil({**options, "axes": axes, "units": case.option(*UNIT_SYSTEMS)}),
    )
    if isinstance(found, plt.Axes):
        assert found is axes or case.mood == "odd"
        limits = (*found.get_xlim(), *found.get_ylim())
        assert np.all(np.isfinite(limits)), f"limits {limits}"
        if case.maybe(0.01):
            found.figure.draw_without_rendering()
    for number in plt.get_fignums()[1:]:
        plt.close(number)


@fuzzes(
    "plot.energy",
    "plot.force_time",
    "plot.impulse_plane",
    "plot.momentum",
    "plot.pulse",
    "plot.scene",
    share=0.1,
)
def test_pictures_of_an_impact(case: Case) -> None:
    """Every picture of an impact of any size."""
    impact = answer_of(case)
    drawn(case, "energy", impact)
    drawn(case, "force_time", impact, case.value("duration"))
    drawn(case, "impulse_plane", impact)
    drawn(case, "momentum", impact)
    drawn(case, "pulse", impact)
    options = {f"outline_{side}": outline(case) for side in "ab" if case.maybe(0.3)}
    if case.maybe(0.5):
        options["moment"] = case.option("before", "after", "both")
    drawn(case, "scene", impact, **options)


@fuzzes("plot.distribution", "plot.contributions", share=0.1)
def test_pictures_of_an_uncertainty(case: Case) -> None:
    """Both pictures of a propagation by any method."""
    found = propagation(case)
    if not isinstance(found, uncertainty.Propagation):
        found = known_propagation()
    output = case.option(found[case.choice(list(found))])
    drawn(
        case,
        "distribution",
        output,
        coverage=case.option(0.95, 0.5, case.value("share_a")),
        bins=case.option(30, 10, 1),
    )
    drawn(case, "contributions", *case.choice(((output,), (found, case.option(*found)), (found,))))


# --- errors ---------------------------------------------------------------------------------------

ERRORS = [
    name
    for name, value in public().items()
    if isinstance(value, type) and issubclass(value, Exception)
]


@fuzzes(*ERRORS, "Status")
def test_errors(case: Case) -> None:
    """Every error and warning carries what it was given, through a copy and a pickle too; every
    status has its words.
    """
    for name in ERRORS:
        fields = {"argument": case.text(), "value": case.number("vx")}
        made = case.call(
            name,
            getattr(col, name),
            case.text(),
            code=case.choice(("bad_shape", "", "x")),
            **fields,
        )
        for twin in (pickle.loads(pickle.dumps(made)), copy.copy(made)):
            assert (type(twin), str(twin), twin.code, twin.fields) == (
                type(made),
                str(made),
                made.code,
                made.fields,
            )
    status = case.must("Status", col.Status, case.choice(list(col.Status)))
    assert status.sentence
    assert status.label == status.name.lower()
