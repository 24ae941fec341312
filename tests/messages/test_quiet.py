"""Whoever counts refused and gaining cases themselves can have the warnings of them silent, in
their own thread only.
"""

import threading
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct, travel
from collisions.messages.warning import quietly, warn_of_cases

A = col.Vehicle(mass=1500.0, vx=15.0)
B = col.Vehicle(mass=1200.0)
# One case of three has a restitution that no impact has.
MIXED = np.array([0.1, 2.0, 0.3])


def refused():
    """A batch with a refused case."""
    return col.linear_central(A, B, MIXED)


def gaining(size=None):
    """An impulse ratio that drives the slip: more energy after than before."""
    ratio = 0.5 if size is None else np.full(size, 0.5)
    return col.oblique_central(A.replace(vy=1.0), B, 1.0, normal=0.0, impulse_ratio=ratio)


def travelled():
    """A length below zero among lengths."""
    return travel.speed(np.array([10.0, -1.0]), drag=0.7)


def gaining_momentum():
    """Cars that leave with more energy than they came with."""
    after = {
        "course_a_after": "-60 deg",
        "course_b_after": "120 deg",
        "speed_a_after": 20.0,
        "speed_b_after": 20.0,
    }
    return reconstruct.momentum(1000.0, 1000.0, course_a=0.0, course_b="90 deg", **after)


@pytest.mark.parametrize(
    ("call", "code"),
    [
        (refused, "refused_cases"),
        (gaining, "energy_gain"),
        (lambda: gaining(3), "energy_gain"),
        (
            lambda: col.left_out(col.linear_central(A, B, 0.1), duration=np.array([0.1, -0.1])),
            "refused_cases",
        ),
        (travelled, "refused_cases"),
        (gaining_momentum, "energy_gain"),
    ],
)
def test_what_is_said_of_cases_is_silent(call, code):
    """Said outside, at the line of the caller; not said inside; said again afterwards."""
    with pytest.warns(col.CollisionsWarning) as caught:
        call()
    assert [one.message.code for one in caught] == [code]
    assert caught[0].filename == __file__
    with quietly():
        call()
    with pytest.warns(col.CollisionsWarning) as caught:
        call()
    assert [one.message.code for one in caught] == [code]


def test_other_warnings_are_still_given():
    """A suspect unit is no matter of counting cases."""
    with quietly(), pytest.warns(col.SuspectUnitsWarning):
        col.Vehicle(mass=1500.0, heading=90.0)


def test_an_error_inside_ends_the_silence():
    """Also where it is nested."""
    with pytest.raises(col.InputError), quietly(), quietly():
        col.linear_central(A, B, 2.0)
    with pytest.warns(col.CollisionsWarning, match="1 of 3 cases"):
        refused()


def test_one_thread_is_silent_and_the_other_is_not():
    """Both at the same time: what is silent in one thread is said in the other."""
    meeting = threading.Barrier(2)
    seen = {}

    def work(silent):
        if not silent:
            meeting.wait()
            try:
                warn_of_cases(col.CollisionsWarning("said", code="refused_cases"), {})
            except col.CollisionsWarning:
                seen["other"] = "said"
            meeting.wait()
            return
        with quietly():
            meeting.wait()
            warn_of_cases(col.CollisionsWarning("not said", code="refused_cases"), {})
            meeting.wait()
        seen["silent"] = "nothing"

    with warnings.catch_warnings():
        warnings.simplefilter("error", col.CollisionsWarning)
        with ThreadPoolExecutor(2) as pool:
            list(pool.map(work, (True, False)))
    assert seen == {"silent": "nothing", "other": "said"}


def test_left_out_leaves_the_filters_of_the_program_alone(monkeypatch):
    """They are shared by all threads: what one changes for a moment, another may
    restore too late.
    """

    def touched(*_args, **_options):
        raise AssertionError("the filters of the program were changed")

    with pytest.warns(col.EnergyGainWarning):
        impact = gaining()
    monkeypatch.setattr(warnings, "catch_warnings", touched)
    monkeypatch.setattr(warnings, "simplefilter", touched)
    monkeypatch.setattr(warnings, "filterwarnings", touched)
    assert col.left_out(impact).b.tyre_delta_v > 0.0
