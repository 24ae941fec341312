"""The schema of a declared type says what JSON Schema says of such values."""

import pytest

from collisions.quantities.json_schema import NULL, TEXT, array_of, closed, described, schema_of

TYPES = {
    "Value": {"type": "number"},
    "str": TEXT,
    "tuple[Value, Value]": array_of({"type": "number"}, 2),
}


@pytest.mark.parametrize(
    ("declared", "valid", "invalid"),
    [
        ("Value", [1.5, 2], ["1", None, [1.0]]),
        ("Value | None", [1.5, None], ["1", [1.0, 2.0]]),
        ("tuple[Value, Value]", [[1.0, 2.0]], [1.0, [1.0], [1.0, 2.0, 3.0], None]),
        ("Value | tuple[Value, Value] | None", [1.0, [1.0, 2.0], None], [[1.0], "a"]),
        ("Literal['a', 'b | c'] | None", ["a", "b | c", None], ["c", "b", 1.0]),
        ("Literal['a']", ["a"], ["b", None]),
    ],
)
def test_the_schema_takes_what_the_type_does(declared, valid, invalid):
    """By an independent checker of JSON Schema."""
    jsonschema = pytest.importorskip("jsonschema")
    check = jsonschema.Draft202012Validator(schema_of(declared, TYPES))
    assert all(check.is_valid(value) for value in valid)
    assert not any(check.is_valid(value) for value in invalid)


def test_a_type_without_a_schema_is_an_error():
    """Not a schema that takes everything."""
    with pytest.raises(KeyError, match="Wheel"):
        schema_of("Value | Wheel", TYPES)


def test_what_is_said_of_a_value_and_its_unit():
    """A number without a unit has 1, and several numbers a unit each."""
    assert described({}, "Mass, > 0", "kg") == {"description": "Mass, > 0 [kg]"}
    assert described({}, unit="") == {"description": "[1]"}
    assert described({}, unit=("N/m", "m")) == {"description": "[N/m, m]"}
    assert described({"type": "null"}) == NULL


def test_an_object_has_these_properties_and_no_other():
    """All of them are needed, or those that are named."""
    jsonschema = pytest.importorskip("jsonschema")
    either = {"a": TEXT, "b": TEXT}
    whole, part = (jsonschema.Draft202012Validator(closed(either, n)) for n in (None, ["a"]))
    assert (whole.is_valid({"a": "", "b": ""}), whole.is_valid({"a": ""})) == (True, False)
    assert (part.is_valid({"a": ""}), part.is_valid({"a": "", "c": ""})) == (True, False)
