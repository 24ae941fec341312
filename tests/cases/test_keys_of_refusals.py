"""A refusal of a case file names the key that is wrong: every key of every table is given what it
cannot be.
"""

import re
import warnings
from collections import Counter

import pytest

from case_texts import FILES, POSTERIOR
from collisions.cases.answers import answers
from collisions.cases.read import FUNCTIONS, SOLVERS, CaseError, parameters, read_text, vehicles
from collisions.vehicle.vehicle import Vehicle
from variants import one_in

# Of every kind: no number, no text, no place, no direction, no table, and out of every range.
WRONG = ("true", '"x"', '"5 kg*m**7"', "[1, 2, 3, 4]", "[]", "{ y = 1 }", "nan", "-inf")
TEXTS = [*FILES, POSTERIOR]


def refused(text):
    """The keys of the refusal of a case, with what is said; none where it is answered."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            case = read_text(text.encode())
            case.call({})
            if case.study or case.report:
                answers(case).text()
    except CaseError as error:
        return error.problems
    return []


def keys_of(text):
    """Each line of a file that gives a key in one line, with the whole name of that key.

    What a mover has stands at its name; contacts and surfaces are counted.
    """
    table, counts, lines = "", Counter(), text.splitlines()
    for at, line in enumerate(lines):
        if found := re.match(r"\[\[(\w+)\]\]", line):
            number = counts[found[1]]
            counts[found[1]] += 1
            table = f"{found[1]}s[{number}]"
            if found[1] == "mover":
                table = re.search(r'name = "(.*)"', "\n".join(lines[at:]))[1]
        elif found := re.match(r"\[([\w.]+)\]", line):
            table = found[1]
        elif (found := re.match(r'("?[\w.]+"?) = ', line)) and not line.endswith("["):
            if found[1] == "name" and counts["mover"]:
                yield at, f"mover[{counts['mover'] - 1}].name"
            elif table.startswith("surfaces"):
                yield at, table
            else:
                yield at, f"{table}.{found[1]}".lstrip(".")


def names(key, problems):
    """Whether one of the problems stands at this key, or at a part of what it was given."""
    return any(place == key or place.startswith((f"{key}.", f"{key}[")) for place, _ in problems)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(TEXTS)))
def test_a_wrong_value_is_refused_at_its_key(number):
    """Where the file is answered all the same, the value was right for that key."""
    text, of_wrong = TEXTS[number], 0
    sought = sum(line.count("..") + line.count("+/-") for line in text.splitlines()) == 2
    for at, key in keys_of(text):
        for wrong in WRONG:
            if key.startswith("mover[") and wrong.startswith('"'):
                continue  # a right name, which other lines do not have
            lines = text.splitlines()
            lines[at] = f"{lines[at].partition(' = ')[0]} = {wrong}"
            found = refused("\n".join(lines) + "\n")
            if found and not (sought and found[0][1].startswith("has nothing to find")):
                # What a scene shares is refused as a whole.
                place = "scene.shared" if key.startswith("scene.shared.") else key
                assert names(place, found) or key in str(found), (key, wrong, found)
                of_wrong += 1
    assert of_wrong > 20


OTHERS = [
    (name, key)
    for name, solver in SOLVERS.items()
    for key in parameters(solver)
    if key not in vehicles(solver)
]


@pytest.mark.parametrize(("name", "key"), one_in(4, OTHERS))
def test_a_key_that_no_example_has_is_refused_by_its_name(name, key):
    """At the key, or in words that name it where it stands beside another that excludes it."""
    text = next(text for text in FILES if f"[{name}]" in text)
    for wrong in WRONG:
        lines = [line for line in text.splitlines() if not line.startswith(f"{key} = ")]
        lines.insert(lines.index(f"[{name}]") + 1, f"{key} = {wrong}")
        found = refused("\n".join(lines) + "\n")
        assert not found or names(f"{name}.{key}", found) or key in str(found), (wrong, found)


@pytest.mark.parametrize("key", [*parameters(Vehicle), *parameters(Vehicle.from_speed)])
def test_a_wrong_value_of_a_vehicle_is_refused_at_its_key(key):
    """Of either vehicle, whatever it is that cannot be."""
    moving = "" if key in ("vx", "vy") else "speed = 15.0\ncourse = 0.0\n"
    body = 'mass = 1500\nyaw_inertia = 2400\nx = {}\ny = 0.0\nheading = "0 deg"\n'
    text = f"[a]\n{body.format(-2.0)}{moving}[b]\n{body.format(2.0)}[eccentric]\n"
    text += "restitution = 0.1\nnormal = 0\npoint = [0, 0.1]\nfriction = 0.5\n"
    for wrong in WRONG:
        mine, b, others = text.partition("[b]\n")
        lines = [line for line in mine.splitlines() if not line.startswith(f"{key} = ")]
        found = refused("\n".join([*lines, f"{key} = {wrong}", b + others]))
        assert not found or names(f"a.{key}", found), (wrong, found)


@pytest.mark.parametrize(
    ("name", "key"), [(name, key) for name, one in FUNCTIONS.items() for key in parameters(one)]
)
def test_a_wrong_argument_of_a_function_is_refused_at_its_key(name, key):
    """Of a function that stands for a number; or at its table, in words that name it."""
    whole = {
        "travel.speed": {"distance": "12", "drag": "0.7"},
        "reference.yaw_inertia": {"mass": "1500", "length": "4.6", "wheelbase": "2.7"},
        "reconstruct.crush_energy": {
            "widths": "1.2",
            "depths": "[0.2, 0.3]",
            "stiffness_a": "1e4",
            "stiffness_b": "1e5",
        },
        "reconstruct.inline_closing_speed": {
            "energy_loss": "40000",
            "mass_a": "1100",
            "mass_b": "950",
            "restitution": "0.1",
        },
        "Normal": {"mean": "20", "sd": "1"},
        "LogNormal": {"mean": "20", "sd": "1"},
        "Uniform": {"low": "10", "high": "20"},
        "Triangular": {"low": "10", "mode": "15", "high": "20"},
        "Samples": {"values": "[10, 20, 30]"},
        "Interval": {"low": "10", "high": "20"},
        "Censored": {"low": "10"},
    }[name]
    for wrong in WRONG:
        inside = ", ".join(f"{one} = {value}" for one, value in (whole | {key: wrong}).items())
        call, place = f"{{ {name} = {{ {inside} }} }}", "a.vx"
        if name == "reference.yaw_inertia":
            place = "a.yaw_inertia"
        elif name == "reconstruct.crush_energy":
            place = "a.vx.reconstruct.inline_closing_speed.energy_loss"
            work = f"energy_loss = {call}, mass_a = 1100, mass_b = 950, restitution = 0.1"
            call = f"{{ reconstruct.inline_closing_speed = {{ {work} }} }}"
        text = (
            f"[a]\nmass = 1500\n{place.split('.')[1]} = {call}\n[b]\nmass = 1200\n"
            "[linear_central]\nrestitution = 0.1\n"
        )
        found = refused(text)
        at = f"{place}.{name}.{key}"
        spoken = names(f"{place}.{name}", found) and key in str(found)
        one_sided = name == "Censored" and "is a reading with one bound" in str(found)
        assert not found or names(at, found) or spoken or one_sided, (wrong, found)
