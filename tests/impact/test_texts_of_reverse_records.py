"""Records of reverse answers: a text of what was given is the number beside it, or the record is
refused when it is read.
"""

import json
import math
import warnings

import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct, reporting

BODY = {"mass": 1500, "yaw_inertia": 2500, "x": -2, "y": 0, "heading": "0 deg"}
OTHER = {"mass": 1200, "yaw_inertia": 1800, "x": 1, "y": -0.8, "heading": "90 deg"}
CONTACT = {"normal": "0 deg", "point": (0.0, 0.0), "friction": 0.5}
CRASH = col.eccentric(
    col.Vehicle(**BODY, vx="50 km/h"), col.Vehicle(**OTHER, vy="40 km/h"), 0.1, **CONTACT
)


def of_speeds(**given):
    return reconstruct.speeds(
        col.Vehicle(**BODY), col.Vehicle(**OTHER), restitution=0.1,
        course_a="0 deg", course_b="90 deg", **CONTACT, **given,
    )[0]  # fmt: skip


def in_km_h(value):
    return f"{value * 3.6!r} km/h"


REVERSE = {
    "central": lambda: reconstruct.central(
        "1100 kg", "950 kg", va="80 km/h", vb=0.0, vb_after="60 km/h"
    ),
    "central, energy": lambda: reconstruct.central(
        "1100 kg", "950 kg", va="80 km/h", vb=0.0, energy_loss="100 kJ"
    ),
    "central, drags": lambda: reconstruct.central(
        1100, 950, va="80 km/h", vb=0.0, vb_after="60 km/h", duration="100 ms",
        drag_a="70 %", drag_b="6.9 m/s**2",
    ),
    "central, many": lambda: reconstruct.central(
        np.array([1100.0, 1200.0]), 950, va="80 km/h", vb=0.0, vb_after="60 km/h"
    ),
    "central, single precision": lambda: reconstruct.central(
        np.float32([1100, 1200]), np.float32(950), va="80 km/h", vb=0.0, vb_after="61 km/h"
    ),
    "planar": lambda: reconstruct.planar(
        col.Vehicle(**BODY, vx="20 km/h", vy="8 km/h", yaw_rate="60 deg/s"),
        col.Vehicle.from_speed(
            **OTHER, speed="30 km/h", course="-335 deg", yaw_rate="-100 deg/s"
        ),
        closing_speed="40 km/h", **CONTACT,
    ),
    "speeds": lambda: of_speeds(delta_v_a=in_km_h(CRASH.a.delta_v), speed_b="40 km/h"),
    "speeds, recorder": lambda: of_speeds(
        delta_v_forward_a=in_km_h(CRASH.a.delta_v_forward),
        delta_v_left_a=in_km_h(CRASH.a.delta_v_left),
        recorder_a=("0 cm", "0 in"), duration="1 ms", axes="fixed", speed_b="40 km/h",
    ),
}  # fmt: skip


def found(name):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return REVERSE[name]()


def read(record):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return col.Impact.from_dict(record)


@pytest.mark.slow
@pytest.mark.parametrize("name", REVERSE)
def test_a_text_that_is_not_its_number_is_refused(name):
    """Another number, another kind, no unit, or none that can be read: whatever text it is."""
    impact = found(name)
    record = json.loads(json.dumps(impact.to_dict()))
    assert read(record) == impact
    texts = record["inputs"]["known"]
    assert texts
    for key, text in texts.items():
        number, _, unit = text.partition(" ")
        more = f"{float(number) * 1.001 + 1e-3!r} {unit}"
        for wrong in (more, "5 furlong*kg", "abc", "65.4", f"inf {unit}", f"-inf {unit}", ""):
            changed = json.loads(json.dumps(record))
            changed["inputs"]["known"][key] = wrong
            with pytest.raises(
                col.InputError, match=rf"{key} was given as .*, which is not its number"
            ) as caught:
                read(changed)
            assert caught.value.code == "bad_record"


def test_the_same_number_in_another_unit_is_no_other_number():
    """To rounding."""
    record = found("central").to_dict()
    record["inputs"]["known"]["vb_after"] = "16.666666666666668 m/s"
    page = col.report(read(record), form="markdown")
    assert reporting.replay(page) == read(record)


def test_a_text_of_what_was_not_given_is_refused():
    """It would stand among what was given, without a number."""
    record = found("central").to_dict()
    record["inputs"]["known"]["energy_loss"] = "100 kJ"
    with pytest.raises(
        col.InputError, match=r"energy_loss was given as .100 kJ., which is not its"
    ):
        read(record)


@pytest.mark.slow
def test_a_unit_that_only_its_own_registry_knows_is_left_out():
    """Its text could not be read again; its number is there."""
    own = pint.UnitRegistry()
    own.define("haste = 1 m/s")
    impact = reconstruct.central(1100, 950, va=22.0, vb=0.0, vb_after=own.Quantity(16.0, "haste"))
    record = json.loads(json.dumps(impact.to_dict()))
    assert record["inputs"]["known"] == {}
    assert math.isclose(record["results"]["reconstruction"]["given"]["vb_after"], 16.0)
    assert read(record).a.before.vx == impact.a.before.vx
