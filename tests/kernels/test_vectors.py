"""The test vectors for other programs: the library keeps to them, and they are what their script
and schema say.
"""

import itertools
import json
import math
import os
import runpy
import shutil
import subprocess
import sys
import warnings
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import jsonschema
import pytest

import collisions as col
from collisions.kernels.contact_laws import LAWS, RULES

VECTORS = Path(__file__).resolve().parents[2] / "vectors"
FILE = VECTORS / "impacts.json"

pytestmark = pytest.mark.skipif(not FILE.is_file(), reason="this copy has no test vectors")

# A program for the readers that solves with the library.
LIBRARY = """
import warnings
import collisions as col

warnings.simplefilter("ignore", col.CollisionsWarning)
NAMES = ("a", "b", "name", "id", "kind", "solver", "restitution")

def number(value):
    return float(value) if isinstance(value, (str, int)) else value

def body(given):
    values = {name: tuple(value) if name == "pivot" else number(value) for name, value in \
given.items()}
    return col.Vehicle(**values)

def solve(impact):
    options = {name: impact[name] for name in impact if name not in NAMES}
    for name, value in options.items():
        if isinstance(value, list):
            options[name] = tuple(value)
        elif name not in ("law", "incomplete"):
            options[name] = number(value)
    solver = getattr(col, impact["solver"])
    found = solver(body(impact["a"]), body(impact["b"]), float(impact["restitution"]), **options)
    sides = {
        name: {
            "delta_v": [side.delta_vx, side.delta_vy], "velocity": [side.after.vx, side.after.vy],
            "delta_yaw_rate": side.delta_yaw_rate, "yaw_rate": side.after.yaw_rate, "pdof": \
side.pdof,
            "pivot_impulse": [side.pivot_impulse_x, side.pivot_impulse_y],
        }
        for name, side in (("a", found.a), ("b", found.b))
    }
    return {
        "regime": found.regime, "closing_speed": found.closing_speed, "slip_before": \
found.slip_before,
        "impulse": [found.normal_impulse, found.tangential_impulse], "energy_loss": \
found.energy_loss, **sides,
    }
"""

# The same for in-line impacts alone, by hand.
IN_LINE = """
export function solve({ solver, a, b, restitution: e, normal }) {
  if (solver !== "linear_central") return null;
  const n = normal[0];
  const [massA, massB] = [a, b].map(({ mass }) => Number(mass));
  const mass = massA === Infinity ? massB : massB === Infinity ? massA : massA * massB / (massA + \
massB);
  const closing = n * (a.vx - b.vx), impulse = (1 + e) * mass * closing;
  const side = ({ vx, heading }, mass, force) => ({
    delta_v: [force / mass, 0], velocity: [vx + force / mass, 0],
    pdof: Math.atan2(-Math.sin(heading) * force, -Math.cos(heading) * force),
  });
  return {
    regime: "frictionless", closing_speed: closing, impulse: [impulse, 0], energy_loss: (1 - e) * \
closing * impulse / 2,
    a: side(a, massA, -n * impulse), b: side(b, massB, n * impulse),
  };
}
"""


@pytest.fixture(scope="module")
def impacts():
    """All impacts; numbers with a point as decimals, as they are written."""
    return json.loads(FILE.read_text(encoding="utf-8"), parse_float=Decimal)["impacts"]


def read(impact):
    """The question alone, as any program reads it."""
    return json.loads(
        json.dumps({name: impact[name] for name in impact if name != "answer"}, default=float)
    )


def error(name, found, numbers):
    """Length of the difference from what is written, taken exactly."""
    found = found if isinstance(found, list) else [found]
    assert all(map(math.isfinite, found))
    apart = [
        float(Fraction(got) - Fraction(number)) for got, number in zip(found, numbers, strict=True)
    ]
    size = math.hypot(*apart)
    return abs(math.remainder(size, math.tau)) if name == "pdof" else size


def compared(found, answer, place=""):
    """Every promised answer as (place, error, what is allowed); regimes are equal."""
    for name, wanted in answer.items():
        if isinstance(wanted, dict):
            yield from compared(found[name], wanted, f"{place}{name}.")
        elif isinstance(wanted, str):
            assert found[name] == wanted
        else:
            yield f"{place}{name}", error(name, found[name], wanted[:-1]), float(wanted[-1])


def test_the_library_keeps_to_every_vector(impacts):
    """Each answer within what the file allows, which is what the page on numerical stability
    promises.
    """
    names = {}
    exec(LIBRARY, names)
    count = 0
    with warnings.catch_warnings():
        for impact in impacts:
            found = names["solve"](read(impact))
            for place, off, allowed in compared(found, impact["answer"]):
                assert off <= allowed, (
                    f"impact {impact['id']}: {place} is off by {off}, of {allowed} allowed"
                )
                count += 1
    assert count > 12_000


def test_the_vectors_are_a_thousand_of_every_solver_law_and_rule(impacts):
    """With barriers, pivots, outside impulses and incomplete impacts under every law, in less than
    a megabyte.
    """
    assert FILE.stat().st_size < 1_000_000
    assert [impact["id"] for impact in impacts] == list(range(1, 1001))
    pairs = [
        (law, rule)
        for law, rule in itertools.product(LAWS, RULES)
        if not LAWS[law].followed or rule == "friction"
    ]
    for solver, law, rule in (
        (solver, *pair) for solver in ("oblique_central", "eccentric") for pair in pairs
    ):
        kinds = {
            impact["kind"]
            for impact in impacts
            if impact["solver"] == solver and impact["law"] == law and rule in impact
        }
        assert {"free", "barrier", "incomplete"} <= kinds, (solver, law, rule)
        if solver == "eccentric":
            assert {
                "A pinned",
                "B pinned",
                "both pinned",
                "map grid",
                "pushed",
                "pushed and pinned",
            } <= kinds
    assert sum(impact["solver"] == "linear_central" for impact in impacts) > 100
    regimes = {impact["answer"]["regime"] for impact in impacts}
    assert regimes == {"frictionless", "sliding", "sticking", "reversing", "given"}


def test_answers_have_seventeen_digits(impacts):
    """Or fewer where the rest are zeros: the mean number written is near 17."""
    written = [
        len(number.as_tuple().digits)
        for impact in impacts
        for number in impact["answer"]["b"]["delta_v"][:-1]
        if number
    ]
    assert max(written) == 17
    assert sum(written) / len(written) > 16.5


@pytest.mark.slow
def test_no_difference_of_the_inputs_is_rounded(impacts):
    """Of positions and of velocities, so that every program starts from the same numbers."""
    for impact in impacts:
        bodies = [impact["a"], impact["b"]]
        given = [
            tuple(body[name] for body in bodies)
            for name in ("vx", "vy")
            if all(name in body for body in bodies)
        ]
        for body in bodies:
            places = [(body["x"], body["y"])] if "x" in body else []
            places += [tuple(body["pivot"])] if "pivot" in body else []
            places += [tuple(impact["point"])] if "point" in impact else []
            given += [
                pair
                for one, other in itertools.combinations(places, 2)
                for pair in zip(one, other, strict=True)
            ]
        for one, other in given:
            assert Fraction(float(one) - float(other)) == Fraction(one) - Fraction(other), impact[
                "id"
            ]


def broken(impact):
    """The impact with one thing wrong, in several ways."""
    yield {**impact, "restitution": -0.2}
    yield {**impact, "friction": 0.5, "impulse_ratio": 0.1}
    yield {**impact, "law": "newton"}
    yield {**impact, "a": {**impact["a"], "mass": 0}}
    yield {**impact, "b": {**impact["b"], "speed": 3}}
    yield {name: impact[name] for name in impact if name != "point"}
    yield {**impact, "answer": {**impact["answer"], "energy_loss": [1.0]}}


@pytest.mark.slow
def test_the_schema_fits_and_refuses_what_is_wrong():
    """The whole file is valid, and one impact with a fault is not."""
    schema = json.loads((VECTORS / "schema.json").read_text(encoding="utf-8"))
    checks = jsonschema.Draft202012Validator
    checks.check_schema(schema)
    whole = json.loads(FILE.read_text(encoding="utf-8"))
    checks(schema).validate(whole)
    sample = next(
        impact
        for impact in whole["impacts"]
        if impact["solver"] == "eccentric" and "friction" in impact
    )
    assert checks(schema).is_valid({"format": 1, "impacts": [sample]})
    for fault in broken(sample):
        assert not checks(schema).is_valid({"format": 1, "impacts": [fault]}), fault


@pytest.mark.slow
def test_the_file_is_what_the_script_writes(tmp_path):
    """Byte for byte but for line ends, without the library."""
    target = tmp_path / "again.json"
    blocked = tmp_path / "blocked"
    blocked.mkdir()
    (blocked / "collisions.py").write_text(
        "raise ImportError('the vectors share nothing with the library')\n", encoding="utf-8"
    )
    environment = {**os.environ, "PYTHONPATH": str(blocked)}
    subprocess.run(
        [sys.executable, str(VECTORS / "make.py"), str(target)],
        env=environment,
        check=True,
        timeout=1200,
    )
    assert target.read_text(encoding="utf-8") == FILE.read_text(encoding="utf-8")


@pytest.mark.slow
def test_what_is_allowed_is_what_the_tests_of_the_library_hold_it_to(impacts):
    """By the functions of tests/kernels/test_reference.py, rounded up to two digits."""
    from kernels import test_reference as held

    names = {"P": "impulse", **{f"{side}.after.v": f"{side}.velocity" for side in "ab"}}
    names |= {f"{side}.after.yaw_rate": f"{side}.yaw_rate" for side in "ab"}
    measures = (
        held.closing_and_slip,
        held.impulses,
        held.velocities,
        held.losses,
        held.pivots,
        held.directions,
    )
    seen = 0
    questions = runpy.run_path(str(VECTORS / "make.py"))["questions"]()
    for impact, (solver, _, scene, answer) in zip(impacts, questions, strict=True):
        if solver == "linear_central":
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            outputs = held._outputs(held.solved(solver, scene))
        promised = {
            name: promise
            for measure in measures
            for name, _, promise in measure(scene, answer, outputs)
        }
        promised = {names.get(name, name): promise for name, promise in promised.items()}
        for side in ("", "a", "b"):
            for name, written in (impact["answer"][side] if side else impact["answer"]).items():
                if not isinstance(written, list):
                    continue
                seen += 1
                exact = promised[f"{side}.{name}" if side else name]
                assert exact * (1 - 1e-9) <= float(written[-1]) <= exact * 1.1 + 1e-300, (
                    impact["id"],
                    side,
                    name,
                )
    assert seen > 10_000


def ran(command, **environment):
    """A reader's exit code and what it printed."""
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=1200,
        check=False,
        env={**os.environ, **environment},
    )
    assert done.stderr == ""
    return done.returncode, done.stdout.splitlines()


# A reader with a program that is right, a mistake in that, a program that takes nothing, and how
# many impacts the first takes.
READERS = [
    pytest.param(
        "read.py", LIBRARY, ("found.energy_loss", "found.energy_loss * 1.0000000001"),
        "def solve(impact): return None", 1000,
        id="Python",
    ),
    pytest.param(
        "read.mjs", IN_LINE, ("(1 + e) *", "(1.0000000001 + e) *"),
        "export const solve = () => null;", 125, id="JavaScript"
    ),
]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("reader", "program", "mistake", "nothing", "count"), READERS)
def test_a_reader_compares_a_program(reader, program, mistake, nothing, count, tmp_path):
    """With one that is right it passes; one that is wrong in the tenth digit is told where and by
    how much.
    """
    runs = {".py": sys.executable, ".mjs": shutil.which("node")}[Path(reader).suffix]
    if runs is None:
        pytest.skip("needs node")
    mine = (tmp_path / "mine").with_suffix(Path(reader).suffix)
    library = os.pathsep.join(
        [str(Path(col.__file__).parents[1]), os.environ.get("PYTHONPATH", "")]
    )

    def told(text):
        mine.write_text(text, encoding="utf-8")
        return ran([runs, str(VECTORS / reader), str(mine)], PYTHONPATH=library)

    assert told(program) == (0, [f"{count} impacts compared, 0 answers off"])
    assert program.count(mistake[0]) == 1
    code, lines = told(program.replace(*mistake))
    assert code == 1
    assert lines[0].startswith("impact 1: ")
    assert " is off by " in lines[0]
    assert lines[-1].startswith(f"{count} impacts compared, ")
    assert told(nothing) == (1, ["0 impacts compared, 0 answers off"])
