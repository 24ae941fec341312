"""Errors carry their parts: the argument, what was given, what is allowed and what to write."""

import pickle

import pytest

import collisions as col
from collisions.messages.marked import as_code, in_other_words, plain

MADE = [
    (lambda: col.Vehicle(mass=-2.0), ("mass", -2.0, "> 0 (inf allowed)", None)),
    (
        lambda: col.linear_central(col.Vehicle(mass=1), col.Vehicle(mass=1), 1.4),
        ("restitution", 1.4, "from 0 to 1", "if percent were meant, write '1.4 %'"),
    ),
    (
        lambda: col.linear_central(
            col.Vehicle(mass=1), col.Vehicle(mass=1), 0.1, normal=(1.0, 2.0, 3.0)
        ),
        ("normal", (1.0, 2.0, 3.0), "an angle or a tuple (x, y)", None),
    ),
    (
        lambda: col.linear_central(col.Vehicle(mass=1), 7, 0.1),
        ("b", 7, "a Vehicle", "write collisions.Vehicle(mass=...)"),
    ),
    (
        lambda: col.Vehicle(mass="5 kgg"),
        ("mass", "5 kgg", None, "write for example 1100 (kg), '1100 kg' or '2425 lb'"),
    ),
]


@pytest.mark.parametrize(("call", "parts"), MADE)
def test_an_error_has_its_parts_as_attributes(call, parts):
    """They stand in the message too, and are kept by pickling."""
    with pytest.raises(col.InputError) as caught:
        call()
    for error in (caught.value, pickle.loads(pickle.dumps(caught.value))):
        assert (error.argument, error.given, error.allowed, error.instead) == parts
        assert str(error).startswith(parts[0])
        assert all(part in str(error) for part in parts[2:] if part)


def test_what_cannot_be_pickled_is_left_out_of_a_pickled_error():
    """The message shows it all the same."""
    with pytest.raises(col.InputError) as caught:
        col.Vehicle(mass=1.0, name=lambda: "A")
    error = pickle.loads(pickle.dumps(caught.value))
    assert callable(caught.value.given)
    assert error.given is None
    assert str(error) == str(caught.value) == "name must be a text, got function"


def test_several_errors_have_parts_of_their_own():
    """The whole has none, and its problems have theirs."""
    with pytest.raises(col.InputError) as caught:
        col.Vehicle(mass=-2.0, vx="x")
    assert caught.value.argument is None
    problems = caught.value.fields["problems"]
    assert [(one.argument, one.given) for one in problems] == [("mass", -2.0), ("vx", "x")]


def test_marks_are_not_seen_and_a_backquote_is():
    """A text as code is the same text again, whatever is in it."""
    for text in ("friction=0", "a`b", "`|x|y`", "", "|", "||"):
        assert plain(as_code(text)) == text
        assert isinstance(plain(f"{text} is {text}"), str)
        assert in_other_words(f"so {as_code('x`y')} it is", str.upper) == "so X`Y it is"
