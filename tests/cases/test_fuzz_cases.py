"""Mutated case files: an answer, or lines that name a key and a cure; never anything else.

``COLLISIONS_FUZZ_CASES`` is the number of files (``10000``) or a range (``5000:10000``), without it
a few hundred.
"""

import json
import os
import random
import re

import pytest

from case_texts import FILES, POSTERIOR
from collisions.cases.answers import answers
from collisions.cases.read import SOLVERS, CaseError, descriptions, parameters, read_text
from collisions.scene import Contact, Mover
from collisions.travel import Tyres
from fuzzing import _promptly
from strategies import EXTREMES

_FEW = 300
SEED = '[propagate]\nmethod = "quasi_random"\nseed = 1\nsamples = 64\n'
VALUES = (
    "inf", "-inf", "nan", "true", "[]", "[[]]", "{}", "[1, 2, 3]", '""', '"x"',
    "1979-05-27T07:32:00Z", "07:32:00", "0x" + "f" * 5000, "9" * 400,
    '"50 km/h +/- 3 km/h"', '"1 .. 2"', '"2 .. 1"', '"+/-"', '".."', '" .. (95 %)"',
    '"1 .. 2 (95 %)"', '"5 +/- 1 (200 %)"', '"1 kg +/- 1 m"',
    '"80 km/h 5"', '"9**9**9 m"', '"__import__(1)"', "{ Normal = { mean = 1, sd = 2 } }",
    "{ Uniform = 1 }", "{ Normal = {} }",
    "{ travel.speed = { distance = 12, drag = 0.7 } }", "{ travel.speed = {} }",
    "{ travel = { path = 1 } }", "{ a = 1, b = 2 }",
    "[0, [1, { Interval = { low = 0, high = 1 } }]]",
    '["0.4 .. 0.7", 1]', "{ Samples = { values = [1, 2, 3] } }",
    ('{ reconstruct.crush_energy = { widths = 1, depths = ["20 cm", 0.3], stiffness_a = 1e4, '
     'stiffness_b = 1e5 } }'),
)  # fmt: skip
KEYS = sorted(
    {
        name
        for function in (*SOLVERS.values(), Mover, Contact, Tyres)
        for name in parameters(function)
    }
    | set(parameters(SOLVERS["solve"]))
)
LINES = (
    "[report]", "[propagate]", "[fit]", "[a]", "[b]", "[eccentric]", "[reconstruct.speeds]",
    "reconstruct = 3", "a = 3", "[[a]]", "answer = 2", "answer = 0",
    "outputs = []", 'outputs = ["a.delta_v", "a.pdof"]', 'outputs = ["a.nothing"]',
    'correlation = [["a.mass", "b.mass", 2]]', "samples = 64", 'method = "interval"',
    'method = "first_order"', "seed = -1", "tolerance = 0.5",
    'units = "us"', "share_a = 0.5", 'notes = ["x"]', "outline_a = [4, 2]",
    "[[mover]]", "[[contact]]", "[[surface]]", "[scene]", "[scene.shared]", "[observed]",
    'road = ["A.drag", "B.tyres.friction"]', 'order = [["A", "B"]]', 'name = "C"',
    'limits = { restitution = 0.1 }', "derivation = true", "\ud800", "\x00", "[" * 3000,
    "x = " + "[" * 3000,
)  # fmt: skip


# What no case file has: calls and arguments as Python writes them, outside of texts that were
# given.
PYTHON = re.compile(
    r"[a-z_]=\S|\b(None|True|False|dict|tuple|numpy|Quantity)\b|\b(Normal|Uniform|Interval|"
    r"Censored|Samples)(\.between)?\(|\.solutions"
)
GIVEN = re.compile(r"'[^']*'|\"[^\"]*\"")


def seeds():
    """The files of a run."""
    first, _, last = os.environ.get("COLLISIONS_FUZZ_CASES", str(_FEW)).rpartition(":")
    return range(int(first or 0), int(last))


def mutated(case):
    """One of the files with some changes of what people, editors and chance do to a text."""
    text = POSTERIOR if case.random() < 0.02 else case.choice(FILES)
    lines = [line.partition("#")[0].rstrip() for line in text.splitlines()]
    if "[propagate]" not in lines and "fit" not in text and "posterior" not in text:
        lines += SEED.splitlines()
    lines = [line for line in lines if not line.startswith("samples")]
    for table, least in (("[propagate]", 64), ("[posterior]", 512)):
        if table in lines:
            lines.insert(lines.index(table) + 1, f"samples = {least}")
    for _ in range(case.choice((1, 1, 1, 2, 3))):
        at, how = case.randrange(len(lines)), case.randrange(20)
        key, equals, value = lines[at].partition(" = ")
        if how < 6 and equals:
            numbers = re.findall(r"[0-9.]+", value) or ["0"]
            extreme = repr(case.choice(EXTREMES) if text is not POSTERIOR else 3.0)
            other = case.choice(
                (f"{case.uniform(-50.0, 90.0):.3g}", str(case.randrange(10)), extreme)
            )
            lines[at] = f"{key} = {value.replace(case.choice(numbers), other, 1)}"
        elif how < 11 and equals:
            lines[at] = f"{key} = {case.choice(VALUES)}"
        elif how < 13 and equals:
            lines[at] = f"{case.choice(KEYS)} = {value}"
        elif how == 13:
            del lines[at]
        elif how == 14:
            lines.insert(at, case.choice(lines))
        elif how < 18:
            lines.insert(at, case.choice((*LINES, f"{case.choice(KEYS)} = {case.choice(VALUES)}")))
        else:
            place = case.randrange(len(lines[at]) + 1)
            middle = case.choice(
                ("", "", '"', "=", "]", "[", ".", "-", "e9", "\t", "°", "km", " ", "0", "'''")
            )
            lines[at] = lines[at][:place] + middle + lines[at][place + case.randrange(2) :]
        if not lines:
            break
    data = "\n".join(lines).encode("utf-8", "surrogatepass")
    if case.random() < 0.02:
        place = case.randrange(len(data) + 1)
        data = data[:place] + bytes(case.randrange(256) for _ in range(3)) + data[place:]
    return data


@pytest.mark.slow
def test_a_mutated_file_is_answered_or_refused_by_key():
    """Everything that is made of an answer is made; a refusal is lines of text, each with a key of
    the file or none.
    """
    answered = refused = 0
    for seed in seeds():
        case = random.Random(f"case file {seed}")
        data = mutated(case)
        try:
            with _promptly():
                found = answers(read_text(data))
                assert found.text(case.choice((None, "us")))
                assert json.dumps(found.to_dict(), allow_nan=False)
                page = case.choice(
                    (
                        lambda found=found: found.report("markdown"),
                        lambda found=found: found.what_if("metric"),
                        lambda found=found: found.play("us"),
                    )
                )
                assert page()
        except CaseError as error:
            refused += 1
            lines = [f"{key}: {text}" for key, text in error.problems]
            if not lines or any("\n" in line or len(line) < 12 for line in lines):
                pytest.fail(f"seed {seed} is refused by {lines}")
            if any(
                PYTHON.search(GIVEN.sub("", text))
                for _, text in error.problems
                if not text.startswith("is not TOML")
            ):
                pytest.fail(f"seed {seed} speaks of Python: {lines}")
        except Exception as error:
            pytest.fail(
                f"seed {seed}: {type(error).__name__}: {error}\n{data.decode('utf-8', 'replace')}"
            )
        else:
            answered += 1
            if any(PYTHON.search(GIVEN.sub("", text)) for text in found.warnings):
                pytest.fail(f"seed {seed} speaks of Python: {found.warnings}")
    # Enough of either to show something; of 500 files 25 and more were answered.
    assert min(answered, refused) >= len(seeds()) // 50, (answered, refused)


@pytest.mark.slow
def test_the_unchanged_files_are_answered():
    """What is mutated would else be refused for reasons of its own."""
    for text in (*FILES, POSTERIOR):
        assert answers(read_text(text.encode())).results
    assert all(descriptions(function) for function in SOLVERS.values())
