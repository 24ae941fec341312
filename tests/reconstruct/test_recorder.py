"""The pulse of a recorder: totals and direction of a known shape, polarity, whether it ended,
files, and every refusal.
"""

import copy
import math
import pickle
import re

import numpy as np
import pint
import pytest

import collisions as col
from collisions import reference, uncertainty
from collisions.reconstruct import posterior, recorded_pulse, speeds

KMH = 1 / 3.6
TIME = np.arange(0.0, 0.2501, 0.01)


def haversine(time, length=0.11):
    """Share of the delta-V of a haversine pulse of this length."""
    x = np.clip(time / length, 0.0, 1.0)
    return x - np.sin(2 * math.pi * x) / (2 * math.pi)


def test_totals_of_a_known_pulse():
    """Integrated by hand: the whole of it at its end, the direction from both components, the time
    of the last sample in it.
    """
    pulse = recorded_pulse(
        TIME, -40 * KMH * haversine(TIME), 12 * KMH * haversine(TIME), polarity="49 CFR 563"
    )
    assert pulse.ended
    assert pulse.delta_v_forward == pytest.approx(-40 * KMH, rel=1e-14)
    # Pushed to the right, positive by Part 563: struck from the front left, which is negative as a
    # PDOF.
    assert pulse.delta_v_left == pytest.approx(-12 * KMH, rel=1e-14)
    assert pulse.pdof == pytest.approx(-math.atan2(12, 40), rel=1e-14)
    assert pulse.delta_v == pytest.approx(math.hypot(40, 12) * KMH, rel=1e-14)
    assert pulse.duration == pytest.approx(0.11, rel=1e-12)
    assert pulse.error_forward == pytest.approx(4 * KMH, rel=1e-14)
    assert pulse.error_left == pytest.approx(1.2 * KMH, rel=1e-14)
    assert pulse.q.delta_v.m_as("km/h") == pytest.approx(math.hypot(40, 12), rel=1e-14)
    # The other polarity is the other side.
    mirrored = recorded_pulse(
        TIME, -40 * KMH * haversine(TIME), 12 * KMH * haversine(TIME), polarity="ISO 8855"
    )
    assert mirrored.delta_v_left == -pulse.delta_v_left
    assert mirrored.pdof == -pulse.pdof
    for twin in (pickle.loads(pickle.dumps(pulse)), copy.deepcopy(pulse)):
        assert twin == pulse
    assert pulse != mirrored
    with pytest.raises(ValueError, match="read-only"):
        pulse.forward[0] = 1.0
    assert "ended=True" in repr(pulse)
    assert [re.split(" {2,}", line)[0] for line in str(pulse.summary()).splitlines()] == [
        "Recorded pulse", "delta-V", "delta-V forward", "delta-V left", "PDOF", "duration", "ended",
        "recorded time", "recorded forward", "recorded left",
    ]  # fmt: skip
    assert re.search(
        r"delta-V forward +-40.0 km/h, within 4.0 km/h\n", str(pulse.summary("metric"))
    )
    assert re.search(r"ended +yes\nrecorded time +0 to 0.250 s\n", str(pulse.summary()))
    assert "to -0 m" not in repr(pulse)


def test_the_signs_are_those_of_an_impact():
    """The recorder of a car that was struck, by Part 563, gives the components and the PDOF that
    the impact has.
    """
    car = col.Vehicle(mass=1500.0, yaw_inertia=math.inf, x=0.0, y=0.0, heading=2.0, vx=3.0)
    other = col.Vehicle(mass=1800.0, yaw_inertia=math.inf, x=-4.0, y=1.0, heading=0.1, vx=20.0)
    side = col.eccentric(other, car, 0.1, normal=0.0, point=(-2.0, 0.2), friction=0.4).b
    shape = haversine(TIME)
    pulse = recorded_pulse(
        TIME, side.delta_v_forward * shape, -side.delta_v_left * shape, polarity="49 CFR 563"
    )
    assert pulse.delta_v_left == pytest.approx(side.delta_v_left, rel=1e-14)
    assert pulse.pdof == pytest.approx(side.pdof, rel=1e-14)


@pytest.mark.parametrize(
    ("stop", "ended"), [(0.06, False), (0.09, False), (0.11, False), (0.12, True), (0.25, True)]
)
def test_whether_it_ended(stop, ended):
    """The last 20 ms change 40 km/h by 4.4 up to 110 ms, by 0.4 up to 120 (0.8 is the limit of 49
    CFR 563.5).
    """
    time = TIME[stop + 1e-9 >= TIME]
    change = 40 * (haversine(time[-1:]) - haversine(time[-1:] - 0.02))[0]
    assert (change <= 0.8) == ended
    if ended:
        pulse = recorded_pulse(time, -40 * KMH * haversine(time), polarity="49 CFR 563")
        assert (pulse.evidence[0].mean, pulse.evidence[1]) == (pulse.delta_v_forward, None)
        assert pulse.evidence[0].sd == pytest.approx(4 * KMH / math.sqrt(3), rel=1e-14)
        assert pulse.inputs("b")["delta_v_forward_b"].support == pytest.approx(
            (-44 * KMH, -36 * KMH), rel=1e-12
        )
        return
    with pytest.warns(
        col.OutOfRangeWarning, match="while delta-V still changes.*is a lower bound"
    ) as caught:
        pulse = recorded_pulse(time, -40 * KMH * haversine(time), polarity="49 CFR 563")
    assert caught[0].message.code == "pulse_cut"
    assert caught[0].filename == __file__
    assert not pulse.ended
    assert pulse.delta_v == pytest.approx(40 * KMH * haversine(time[-1]), rel=1e-12)
    with pytest.raises(col.InputError, match="takes it as a bound") as refused:
        pulse.inputs("a")
    assert refused.value.code == "pulse_cut"
    (reading, none) = pulse.evidence
    assert (reading.low, reading.high, none) == (None, pulse.delta_v_forward, None)
    assert reading.error == pytest.approx(pulse.error_forward / math.sqrt(3), rel=1e-14)


def test_a_cut_pulse_is_evidence_of_at_least_so_much():
    """In a posterior it only rules out less: with a flat prior what is left lies beyond the bound,
    to its error.
    """
    time = TIME[TIME <= 0.0601]
    with pytest.warns(col.OutOfRangeWarning):
        pulse = recorded_pulse(
            time, -40 * KMH * haversine(time), 9 * KMH * haversine(time), polarity="ISO 8855"
        )
    forward, left = pulse.evidence
    unknowns = {"forward": uncertainty.Uniform(-20.0, 0.0), "left": uncertainty.Uniform(-5.0, 5.0)}
    found = posterior(
        lambda forward, left: {"f": forward, "l": left},
        unknowns,
        {"f": forward, "l": left},
        samples=1024,
        seed=1,
    )
    assert found["forward"].interval(0.99)[1] < pulse.delta_v_forward + 3 * pulse.error_forward
    assert found["forward"].mean == pytest.approx((pulse.delta_v_forward - 20.0) / 2, abs=0.5)
    assert found["left"].interval(0.99)[0] > pulse.delta_v_left - 3 * pulse.error_left


def test_it_goes_into_speeds():
    """Its inputs have the names of the arguments; their middles are the answer of the
    components.
    """
    pulse = recorded_pulse(
        TIME, -6.0 * haversine(TIME), -1.0 * haversine(TIME), polarity="49 CFR 563"
    )
    inputs = pulse.inputs("a")
    assert list(inputs) == ["delta_v_forward_a", "delta_v_left_a"]
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.0, y=0.0, heading=0.0)
    b = col.Vehicle(mass=1300.0, yaw_inertia=2000.0, x=2.0, y=0.8)
    contact = {
        "course_a": 0.0,
        "course_b": 1.4,
        "restitution": 0.1,
        "normal": 0.0,
        "point": (0.0, 0.4),
        "friction": math.inf,
    }
    (found,) = speeds(a, b, **contact, **{name: one.mean for name, one in inputs.items()})
    assert found.a.delta_v_left == pytest.approx(1.0, rel=1e-12)
    # A small component is known to half the step of 1 km/h at best.
    small = recorded_pulse(TIME, -6.0 * haversine(TIME), 0.1 * haversine(TIME), polarity="ISO 8855")
    assert small.error_left == pytest.approx(0.5 * KMH, rel=1e-14)
    assert reference.RECORDER_RESOLUTION.high == pytest.approx(KMH, rel=1e-15)
    forward_only = recorded_pulse(TIME, -6.0 * haversine(TIME), polarity="ISO 8855")
    assert forward_only.pdof is forward_only.error_left is forward_only.delta_v_left is None
    assert list(forward_only.inputs("b")) == ["delta_v_forward_b"]
    assert forward_only.delta_v == 6.0


def test_files(tmp_path):
    """A CSV with its units in the header reads as the arrays do; a byte order mark and empty lines
    do not matter.
    """
    registry = pint.get_application_registry()
    forward, lateral = -40 * haversine(TIME), 12 * haversine(TIME)
    path = tmp_path / "pulse.csv"
    rows = [
        f"{1000 * t!r},{f!r}, {s!r}"
        for t, f, s in zip(TIME.tolist(), forward.tolist(), lateral.tolist(), strict=True)
    ]
    path.write_text(
        "\n".join(["\ufefftime [ms],longitudinal [km/h],lateral [km/h]", *rows, "", ""]),
        encoding="utf-8",
    )
    by_arrays = recorded_pulse(registry.Quantity(1000 * TIME, "ms"),
        registry.Quantity(forward, "km/h"), registry.Quantity(lateral, "km/h"),
            polarity="49 CFR 563")  # fmt: skip
    for given in (path, str(path)):
        by_file = recorded_pulse(given, polarity="49 CFR 563")
        assert by_file.delta_v_left == pytest.approx(by_arrays.delta_v_left, rel=1e-14)
        np.testing.assert_allclose(by_file.time, by_arrays.time, rtol=1e-14)
    for text, said in (
        ("time,longitudinal\n0,1\n1,2", "unit in brackets"),
        ("time [ms],longitudinal [km/h]\n0,1\n1", "rows as long"),
        ("time [ms],longitudinal [km/h]\n0,x", "could not convert"),
        ("", "not enough values"),
    ):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(col.InputError, match=said) as caught:
            recorded_pulse(path, polarity="49 CFR 563")
        assert caught.value.code == "bad_file"
    path.write_text("time [kg],longitudinal [km/h]\n0,1\n1,2", encoding="utf-8")
    with pytest.raises(col.UnitsError, match="unit of time"):
        recorded_pulse(path, polarity="49 CFR 563")
    with pytest.raises(col.InputError, match="No such file"):
        recorded_pulse(tmp_path / "none.csv", polarity="49 CFR 563")


SHAPE = -10 * haversine(TIME)
REFUSALS = [
    ("bad_option", (TIME, SHAPE), {"polarity": "right"}, "'49 CFR 563'"),
    ("bad_shape", (TIME,), {}, "delta_v_forward"),
    ("bad_shape", (TIME, SHAPE[1:]), {}, "arrays of one length"),
    ("bad_shape", (TIME[:1], SHAPE[:1]), {}, "two samples at least"),
    ("bad_shape", (0.1, 3.0), {}, "two samples"),
    ("bad_pulse", (TIME[::-1], SHAPE), {}, "must rise"),
    ("bad_pulse", (1000 * TIME, SHAPE), {}, "were milliseconds meant"),
    ("bad_pulse", (TIME, SHAPE * math.nan), {}, "finite number"),
    ("bad_units", (TIME, "3 kg"), {}, "delta_v_forward"),
]


@pytest.mark.parametrize(
    ("code", "given", "options", "said"),
    REFUSALS,
    ids=[f"{i}-{row[0]}" for i, row in enumerate(REFUSALS)],
)
def test_refusals(code, given, options, said):
    """Each names the argument and what to write."""
    with pytest.raises(col.InputError, match=said) as caught:
        recorded_pulse(*given, **{"polarity": "49 CFR 563", **options})
    assert caught.value.code == code


def test_no_polarity_is_assumed():
    with pytest.raises(TypeError, match="polarity"):
        recorded_pulse(TIME, SHAPE)
    with pytest.raises(col.InputError, match="label must be 'a' or 'b'"):
        recorded_pulse(TIME, SHAPE, polarity="49 CFR 563").inputs("c")
