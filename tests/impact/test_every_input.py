"""Every input is used or refused by every solver, law and rule, and printed, recorded and described
wherever it was used.
"""

import json
import math
import warnings

import pytest

import collisions as col
from collisions import travel
from collisions.derivation import explain
from collisions.diagnostics import LIMITS
from collisions.impact.inputs import ARGUMENTS, CRUSH_UNITS, UNITS
from collisions.kernels.contact_laws import LAWS, RULES

# Of every input two values, told apart in print from all other numbers, and what has to be given
# with it to time_resolved.
LASTING = {"duration": 0.1013}
TYRES = travel.Tyres(
    0.6713,
    (0.1719, 0.2317, 0.3137, 0.4179),
    2.7139,
    1.5317,
    steer=0.0917,
    cornering=8.317,
    height=0.5179,
)
CRUSH = (41237.0, 612370.0, 1.5173)
VALUES = {
    "restitution": (0.2371, 0.3719, LASTING),
    "point": ((0.1237, -0.0617), (0.2143, 0.0719), LASTING),
    "duration": (0.1019, 0.0857, {}),
    "stiffness": (723470.0, 587650.0, {}),
    "crush_a": (CRUSH, (51237.0, 712370.0, 1.6173), {"crush_b": (38123.0, 571230.0, 1.4239)}),
    "crush_b": (CRUSH, (51237.0, 712370.0, 1.6173), {"crush_a": (38123.0, 571230.0, 1.4239)}),
    "drag": (0.4321, 0.6143, LASTING),
    "wheelbase": (2.6137, 3.1259, LASTING | {"drag": 0.4321}),
    "track": (1.5137, 1.8259, LASTING | {"drag": 0.4321}),
    "outside_a": ((312.7, -123.9, 451.3), (-112.3, 223.9, -151.3), LASTING),
    "outside_b": ((317.9, -129.1, 457.1), (-117.9, 229.1, -157.1), LASTING),
}
RULE_VALUES = {
    "friction": (0.1379, 0.1129),
    "impulse_ratio": (-0.1379, -0.1129),
    "critical_fraction": (0.5379, 0.6129),
}
# Of a body: the mass is printed by all, what the central models have no use for is refused or
# printed.
BODY = {
    "mass": (1493.7, 1347.1), "yaw_inertia": (2513.7, 3147.9), "vx": (14.137, 16.139),
    "vy": (1.2137, 2.1379), "yaw_rate": (0.3137, 0.5179),
    "x": (-2.1379, -1.8137), "y": (0.3179, 0.5237), "heading": (0.1537, 0.3179),
}  # fmt: skip
SOLVERS = sorted(ARGUMENTS)
CONTACTS = [
    (law, rule) for law in LAWS for rule in RULES if rule == "friction" or not LAWS[law].followed
]


def contact(solver, law, rule):
    """The arguments of a solver beyond the vehicles and what is tried."""
    takes = ARGUMENTS[solver]
    found = {"restitution": 0.1531, "normal": 0.0}
    if solver != "linear_central":
        found |= {"normal": 0.0713, rule: RULE_VALUES[rule][0]}
    if "law" in takes:
        found["law"] = law
    if "point" in takes:
        found["point"] = (0.0531, 0.0917)
    if solver == "solve":
        found["tolerance"] = 0.0
    if solver == "time_resolved":
        found |= LASTING
    return found


def bodies(solver, **changes):
    """A car that turns and slides, and one that stands; for the central models without what these
    refuse.
    """
    own = {
        "mass": 1500.0,
        "yaw_inertia": 2500.0,
        "vx": 14.0,
        "vy": 2.0,
        "yaw_rate": 0.2,
        "x": -2.0,
        "y": 0.4,
        "heading": 0.1,
    }
    if solver in ("linear_central", "oblique_central"):
        own["yaw_rate"] = 0.0
    if solver == "linear_central":
        own["vy"] = 0.0
    return col.Vehicle(**(own | changes)), col.Vehicle(
        mass=1200.0, yaw_inertia=1900.0, x=2.0, y=0.0, heading=1.3
    )


def solved(solver, arguments, **changes):
    """The impact; None if it was refused."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        try:
            return getattr(col, solver)(*bodies(solver, **changes), **arguments)
        except (col.InputError, col.NoSolutionError, TypeError):
            return None


def asked(solver, law, rule, name, value):
    """All arguments with one input at a value; ``time_resolved`` takes one of those that say how
    long a contact lasts.
    """
    found = contact(solver, law, rule)
    if solver == "time_resolved" and name in ("stiffness", "crush_a", "crush_b"):
        del found["duration"]
    if solver == "time_resolved" or (solver == "solve" and name == "drag"):
        found |= VALUES[name][2]
    if solver == "eccentric" and name == "duration":
        found["tyres_a"] = TYRES
    return found | {name: value}


def results(impact):
    """All that an impact answers."""
    return json.dumps(impact.to_dict()["results"], sort_keys=True)


def printed(text, numbers):
    """Those of the numbers that a page has not, with six figures."""
    plain = text.replace("\\", "").replace("−", "-")
    return [number for number in numbers if f"{abs(number):.6g}" not in plain]


def parts(value):
    return value if isinstance(value, tuple) else (value,)


def check_said(impact, name, numbers, other):
    """Explained, reported with its record, and read back; and what is said of the result moves with
    the input.
    """
    for form in ("text", "markdown"):
        assert not printed(explain(impact, units="si", form=form), numbers), (name, form)
    page = col.report(impact, form="markdown", units="si", figures=False)
    assert not printed(page.partition("## Record")[0], numbers), name
    record = impact.to_dict()
    again = col.Impact.from_dict(json.loads(json.dumps(record)))
    assert again == impact
    assert again.to_dict() == record
    assert printed(json.dumps(record["inputs"]), numbers) == []
    assert (
        str(impact.summary(units="si")) + impact._repr_html_()
        != str(other.summary(units="si")) + other._repr_html_()
    )
    # With limits that nothing keeps, every check says what it measured.
    limits = dict.fromkeys(LIMITS, 1e-9)
    measured = [
        [(found.code, found.vehicle, found.measured) for found in col.diagnose(one, limits=limits)]
        for one in (impact, other)
    ]
    assert measured[0] != measured[1], name


def schema_of(name):
    """What the schema has for an input."""
    return col.impact_schema()["properties"]["inputs"]["properties"].get(name)


def test_every_input_has_values_to_try():
    """An input that was added is tried too."""
    assert VALUES.keys() == UNITS.keys(), (
        "give two values of the new input, and what it needs beside it"
    )
    assert RULE_VALUES.keys() == RULES.keys()


@pytest.mark.parametrize("name", UNITS)
def test_the_schema_has_every_input(name):
    """With its unit, and required in a record."""
    described = json.dumps(schema_of(name))
    unit = UNITS[name]
    units = unit if isinstance(unit, tuple) else (unit,)
    assert schema_of(name) is not None
    assert name in col.impact_schema()["properties"]["inputs"]["required"]
    assert all(one in described for one in units if one), described


def cases():
    for solver in SOLVERS:
        for law, rule in CONTACTS:
            if "law" not in ARGUMENTS[solver] and (law, rule) != ("brach", "friction"):
                continue
            for name in UNITS:
                slow = solver == "time_resolved" or (
                    solver == "solve" and name in ("duration", "drag")
                )
                marks = (
                    [pytest.mark.slow]
                    if slow or (law, rule) not in (("brach", "friction"), ("stronge", "friction"))
                    else []
                )
                yield pytest.param(
                    solver, law, rule, name, marks=marks, id=f"{solver}-{law}-{rule}-{name}"
                )


@pytest.mark.parametrize(("solver", "law", "rule", "name"), list(cases()))
def test_an_input_is_used_or_refused(solver, law, rule, name):
    """Another value gives another answer; and where an answer is given, the value is said."""
    one, other, _ = VALUES[name]
    found = solved(solver, asked(solver, law, rule, name, one))
    takes = name in ARGUMENTS[solver] or name == "restitution"
    if found is None:
        assert not takes or solver == "solve", f"{solver} takes {name} and refused it"
        return
    assert takes, f"{solver} does not take {name} and answered"
    beside = solved(solver, asked(solver, law, rule, name, other))
    if solver == "solve" and name in ("duration", "drag") and (rule, law) != ("friction", "brach"):
        # No contact in time with these: said in the reason for the model, with the numbers all the
        # same.
        said = (
            f"time_resolved has a law of its own, and {law} was given"
            if rule == "friction"
            else f"time_resolved takes friction, and {rule} was given"
        )
        assert said in " ".join(explain(found, form="text", units="si").split())
        assert not printed(explain(found, form="text", units="si"), parts(one))
        return
    assert results(found) != results(beside), f"{solver} does not use {name}"
    check_said(found, name, parts(one), beside)


@pytest.mark.slow
@pytest.mark.parametrize("label", ["a", "b"])
@pytest.mark.parametrize("name", TYRES.named)
@pytest.mark.parametrize(
    "solver",
    [
        "eccentric",
        pytest.param("solve", marks=pytest.mark.slow),
        pytest.param("time_resolved", marks=pytest.mark.slow),
    ],
)
def test_every_number_of_tyres_is_used_and_said(solver, name, label):
    """Both vehicles move and are steered, so that no force of a wheel is 0."""
    value = TYRES.named[name]
    changed = {
        "lock": [0.777 if name == f"lock[{i}]" else lock for i, lock in enumerate(TYRES.lock)]
    }
    moved = TYRES.replace(**(changed if "lock" in name else {name: 1.139 * value}))
    arguments = contact(solver, "brach", "friction") | LASTING
    a, b = bodies(solver)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        found, beside = (
            getattr(col, solver)(
                a, b.replace(vx=-3.0, vy=4.0, yaw_rate=0.5), **arguments, **{f"tyres_{label}": one}
            )
            for one in (TYRES, moved)
        )
    assert results(found) != results(beside)
    for form in ("text", "markdown"):
        assert not printed(explain(found, units="si", form=form), (value,)), (name, form)
    page = col.report(found, form="markdown", units="si", figures=False)
    assert not printed(page.partition("## Record")[0], (value,))
    record = found.to_dict()
    assert col.Impact.from_dict(json.loads(json.dumps(record))) == found
    assert not printed(json.dumps(record["inputs"]), (value,))


@pytest.mark.parametrize("name", ["point", "duration", "drag", "friction"])
@pytest.mark.parametrize("tolerance", [3.0, 1000.0])
def test_what_only_decided_on_the_model_is_said(name, tolerance):
    """solve may take a model that has no use for an input: the pages have it all the same."""
    one = RULE_VALUES[name][0] if name in RULES else VALUES[name][0]
    arguments = (
        asked("solve", "brach", "friction", name, one)
        if name != "friction"
        else contact("solve", "brach", "friction")
    )
    found = solved("solve", arguments | {"tolerance": tolerance}, vy=0.0, yaw_rate=0.0)
    assert found.model in ("oblique_central", "linear_central")
    assert not printed(explain(found, units="si"), parts(one))
    page = col.report(found, form="markdown", units="si", figures=False)
    assert not printed(page.partition("## Record")[0], parts(one))


@pytest.mark.slow
@pytest.mark.parametrize(("law", "rule"), CONTACTS)
@pytest.mark.parametrize("solver", ["oblique_central", "eccentric", "solve"])
def test_the_value_of_a_rule_is_used_and_said(solver, law, rule):
    one, other = RULE_VALUES[rule]
    found, beside = (
        solved(solver, contact(solver, law, rule) | {rule: value}) for value in (one, other)
    )
    assert results(found) != results(beside)
    check_said(found, rule, (one,), beside)


@pytest.mark.slow
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("name", BODY)
def test_every_number_of_a_vehicle_is_used_or_refused(solver, name):
    """The central models have no use for places and inertia, which are said all the same."""
    one, other = BODY[name]
    arguments = contact(solver, "brach", "friction")
    found, beside = (solved(solver, arguments, **{name: value}) for value in (one, other))
    if found is None:
        assert (solver, name) in {
            ("linear_central", "vy"),
            ("linear_central", "yaw_rate"),
            ("oblique_central", "yaw_rate"),
        }
        return
    assert results(found) != results(beside)
    assert not printed(explain(found, units="si"), (one,))
    assert not printed(
        col.report(found, form="markdown", units="si", figures=False).partition("## Record")[0],
        (one,),
    )


def test_the_units_of_a_crush_stiffness_are_those_of_the_table():
    assert len(CRUSH) == len(CRUSH_UNITS)
    assert math.isfinite(sum(CRUSH))
