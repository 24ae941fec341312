"""Every public function and method says in its docstring what it takes and gives, in sections, with
units in brackets.
"""

import inspect
import re

import pytest

from fuzzing import arguments, public

# In the unit of what the caller describes by them, whatever that is.
OF_ANY_UNIT = {
    *(f"uncertainty.{kind}" for kind in ("Censored", "Interval", "LogNormal", "Normal", "Samples",
    "Triangular", "Uniform")),
    *(f"uncertainty.{name}" for name in ("LogNormal.between", "Normal.between", "Samples.joint")),
    ("diagnose", "limits"), ("explain", "uncertainty"), ("uncertainty.propagate", "tolerance"),
}  # fmt: skip
FUNCTIONS = [name for name, value in public().items() if not inspect.isclass(value)]
MADE = [
    name
    for name, value in public().items()
    if inspect.isclass(value) and arguments(name) and "message" not in arguments(name)
]


def sections(name):
    """The entries of each section by its title: of an entry its names and what stands behind the
    colon.
    """
    text = inspect.getdoc(getattr(public()[name], "__func__", public()[name])) or ""
    found = {}
    for title, body in re.findall(
        r"^(\w[\w ]*)\n-{3,}\n(.*?)(?=\n\n\w[\w ]*\n-{3,}\n|\Z)", text, re.DOTALL | re.MULTILINE
    ):
        heads = [line for line in body.splitlines() if line and not line.startswith(" ")]
        found[title] = [head.partition(" : ")[::2] for head in heads]
    return found


def names_of(entry):
    """``forward, left`` and ``**changes`` without what is no part of the name."""
    return [one.strip().lstrip("*") for one in entry[0].split(",")]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_what_it_takes_and_gives(name):
    """Each argument has an entry, none has one that is not there, and there is a section on what
    comes back.
    """
    value = public()[name]
    parameters = inspect.signature(getattr(value, "__func__", value)).parameters.keys() - {
        "self",
        "cls",
    }
    found = sections(name)
    documented = [one for entry in found.get("Parameters", ()) for one in names_of(entry)]
    assert sorted(documented) == sorted(parameters)
    assert found.get("Returns"), f"{name} does not say what it returns"


@pytest.mark.parametrize("name", [*FUNCTIONS, *MADE])
def test_numbers_have_their_unit(name):
    """Also those without a dimension, as [-]; a number is what may be a float, an array or a
    Quantity.
    """
    for entry in sections(name).get("Parameters", ()):
        named, kind = entry
        open_unit = name in OF_ANY_UNIT or (name, named) in OF_ANY_UNIT
        if re.search(r"\b(float|array|Quantity)\b", kind) and not open_unit:
            assert re.search(r"\[[^\]]+\]", kind), (
                f"{name}({named} : {kind}) has no unit in brackets; [-] if it has no dimension"
            )


def test_nothing_is_left_out():
    """The classes whose arguments are looked at are those that callers make."""
    assert {"Vehicle", "uncertainty.Normal", "uncertainty.Censored"} <= set(MADE)
    assert len(FUNCTIONS) > 90
