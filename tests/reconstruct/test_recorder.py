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
from scenes import BESIDE

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


@pytest.mark.slow
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
    a, b = BESIDE[0].replace(heading=0.0), BESIDE[1]
    contact = {
        "course_a": 0.0,
        "course_b": 1.4,
        "restitution": 0.1,
        "normal": 0.0,
        "point": (0.0, 0.4),
        "friction": math.inf,
        "regime": "sticking",
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
        ("", "it is empty"),
        ("\n \n,,\n", "it is empty"),
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


def written(path, heads, columns, separator=",", **how):
    """A table of these heads and columns of cells, in a file."""
    rows = [heads, *(separator.join(cells) for cells in zip(*columns, strict=True))]
    path.write_bytes("\n".join(rows).encode(how.get("encoding", "utf-8")))
    return path


TIMES, FORWARD, LATERAL = ([f"{value:.2f}" for value in column] for column in (1000 * TIME,
    -40 * haversine(TIME), 9 * haversine(TIME)))  # fmt: skip
MPH = 1609.344 / 3600  # exact by definition


@pytest.mark.parametrize(
    ("heads", "order", "separator", "unit"),
    [
        ("time [ms],longitudinal [km/h],lateral [km/h]", "tfl", ",", KMH),
        ("time [ms],lateral [km/h],longitudinal [km/h]", "tlf", ",", KMH),
        ("lateral [km/h],time [ms],longitudinal [km/h]", "ltf", ",", KMH),
        ("Time (msec)\tDelta-V, longitudinal (MPH)\tDelta-V, lateral (MPH)", "tfl", "\t", MPH),
        ('Time (msec),"Delta-V, lateral (MPH)","Delta-V, longitudinal (MPH)"', "tlf", ",", MPH),
        ("Time (ms);Lateral Delta-V (km/h);Longitudinal Delta-V (km/h)", "tlf", ";", KMH),
        (
            "TIME (MSEC);LATERAL VELOCITY CHANGE (KPH);LONGITUDINAL VELOCITY CHANGE (KPH);",
            "tlf ",
            ";",
            KMH,
        ),
        (
            "Time [ms];\u0394v long. [km/h];\u0394v lat. (positive to the right) [km/h]",
            "tfl",
            ";",
            KMH,
        ),
        ("Time [ms];forward [km/h];positive from left to right [km/h]", "tfl", ";", KMH),
        ("time_ms [ms];delta_v_longitudinal [m/s];delta_v_lateral [m/sec]", "tfl", ";", 1.0),
    ],
)
@pytest.mark.parametrize("comma", [False, True])
# 40 m/s are more than recorders have to be exact for.
@pytest.mark.filterwarnings("ignore:delta_v_forward goes to:collisions.OutOfRangeWarning")
def test_columns_are_those_of_their_heads(heads, order, separator, unit, comma, tmp_path):
    """The same numbers under heads in any order, as reports write them; a place in the file says
    nothing.
    """
    if comma and separator == ",":
        return
    columns = {"t": TIMES, "f": FORWARD, "l": LATERAL, " ": [""] * len(TIMES)}
    cells = [
        [cell.replace(".", ",") if comma else cell for cell in columns[which]] for which in order
    ]
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        path = written(tmp_path / "pulse.csv", heads, cells, separator, encoding=encoding)
        pulse = recorded_pulse(path, polarity="49 CFR 563")
        np.testing.assert_allclose(pulse.time, [float(cell) / 1000 for cell in TIMES], rtol=1e-15)
        np.testing.assert_allclose(
            pulse.forward, [unit * float(cell) for cell in FORWARD], rtol=1e-14
        )
        np.testing.assert_allclose(
            pulse.left, [-unit * float(cell) for cell in LATERAL], rtol=1e-14
        )


def test_what_a_recorder_does_not_have(tmp_path):
    """SNA in all of the lateral column is no lateral column; in the last rows the record is
    shorter.
    """
    heads, none, last = (
        "Time (ms),Longitudinal (km/h),Lateral (km/h)",
        ["SNA"] * len(TIMES),
        ["N/A"] * 3,
    )
    path = written(tmp_path / "pulse.csv", heads, [TIMES, FORWARD, none])
    pulse = recorded_pulse(path, polarity="49 CFR 563")
    assert (pulse.delta_v_left, pulse.pdof) == (None, None)
    assert pulse.delta_v_forward == pytest.approx(-40 * KMH, rel=1e-14)
    for times in (TIMES, TIMES[:-3] + last):
        path = written(
            tmp_path / "pulse.csv",
            heads,
            [times, FORWARD[:-3] + last, [*LATERAL[:-3], "SNA", "sna", "Not available"]],
        )
        assert len(recorded_pulse(path, polarity="49 CFR 563").time) == len(TIME) - 3
    # A record that is not available to its end stops early.
    path = written(
        tmp_path / "pulse.csv", heads, [TIMES, FORWARD[:7] + none[7:], LATERAL[:7] + none[7:]]
    )
    with pytest.warns(col.OutOfRangeWarning, match=r"stops at 0\.06 s"):
        assert not recorded_pulse(path, polarity="49 CFR 563").ended


# Heads or cells, and what the refusal says of them.
TABLES = [
    ("time [ms],lateral [km/h]", "0,1\n10,2", "no column whose head says 'longitudinal'"),
    (
        "time [ms],delta-V [km/h]",
        "0,1\n10,2",
        r"'delta-V \[km/h\]' may be neither time, longitudinal nor lateral",
    ),
    ("sample [ms],longitudinal [km/h]", "0,1\n10,2", "may be neither"),
    ("time [ms],longitudinal [km/h],longitudinal [mph]", "0,1,2\n10,2,3", "are both longitudinal"),
    ("time [ms],longitudinal lateral [km/h]", "0,1\n10,2", "may be longitudinal or lateral"),
    ("time [ms],time, longitudinal [km/h]", "0,1,2\n10,2,3", "are both time"),
    ("time [ms],longitudinal speed [km/h]", "0,1\n10,2", "says 'speed'"),
    ("time [ms],longitudinal velocity [km/h]", "0,1\n10,2", "says 'velocity'"),
    ("time [ms],v longitudinal [km/h]", "0,1\n10,2", "says 'v'"),
    ("time [ms],max delta-V longitudinal [km/h]", "0,1\n10,2", "says 'max'"),
    ("time [ms],longitudinal [km/h],resultant [km/h]", "0,1,2\n10,2,3", "says 'resultant'"),
    ("time [ms],longitudinal (positive rearward) [km/h]", "0,1\n10,2", "says 'rearward'"),
    (
        "time [ms],longitudinal [km/h],lateral (positive left) [km/h]",
        "0,1,2\n10,2,3",
        "positive to the right",
    ),
    (
        "time [ms],longitudinal [km/h],left [km/h]",
        "0,1,2\n10,2,3",
        "says left, and by polarity='49 CFR 563'",
    ),
    (
        "time [ms],longitudinal [km/h],lateral left/right [km/h]",
        "0,1,2\n10,2,3",
        "says left or right",
    ),
    (
        "time [ms],longitudinal [km/h],lateral (negative left) [km/h]",
        "0,1,2\n10,2,3",
        "says 'negative'",
    ),
    ("time [ms],adjusted longitudinal delta-V [km/h]", "0,1\n10,2", "says 'adjusted'"),
    ("time [ms],longitudinal delta-V (corrected) [km/h]", "0,1\n10,2", "says 'corrected'"),
    ("time [ms],pre-crash longitudinal delta-V [km/h]", "0,1\n10,2", "pre-crash.*says 'pre'"),
    ("pre-crash time [s],longitudinal [km/h]", "0,1\n10,2", "pre-crash time.*says 'pre'"),
    ("time [ms],longitudinal [km/h]", "0,0\n10,-950\n20,-1.024", "'-1.024' in row 4 of longit"),
    ("time [ms];longitudinal [km/h]", "0;0\n10;-9\n20;-24,000", "'-24,000' in row 4 of longit"),
    ("time [ms];longitudinal [mm/s]", "0;0\n10;-1,234\n20;-9,000", "'-1,234' in row 3 of longit"),
    ("time [ms];longitudinal [km/h]", "0;0,0\n10;-9,5\n20;-24.000", "'-24.000' a point"),
    ("time [ms];longitudinal [km/h]", "0;0,0\n10;-9,5\n20;-24.000,5", "'-24.000,5' a point"),
    ("time [ms],longitudinal (MPH [km/h])", "0,1\n10,2", "has two units"),
    ("time [ms],longitudinal (MPH) [km/h]", "0,1\n10,2", "has two units"),
    ("time [ms],longitudinal", "0,1\n10,2", "has no unit"),
    ("Crash pulse\ntime [ms],longitudinal [km/h]", "0,1\n10,2", "nothing above the heads"),
    ("time (msec),Delta-V, longitudinal (MPH)", "0,1\n10,2", "stands in quotes"),
    ("time [ms],longitudinal [km/h]", "0,1_0\n10,2_0", "could not convert '1_0' in row 2"),
    ("time [ms],longitudinal [km/h]", "0,\u0661\n10,\u0662", "could not convert '\u0661' in row 2"),
    ("time [ms],longitudinal [km/h]", "0,\uff11\n10,\uff12", "could not convert"),
    ("time [ms],longitudinal [km/h]", "0,infinity\n10,2", "could not convert"),
    ("time [ms],longitudinal [km/h]", "0,0x1\n10,2", "could not convert"),
    ("time [ms],longitudinal [km/h]", "0,\n10,2", "could not convert ''"),
    ("time [ms],longitudinal [km/h]", "0,\u22121\n10,2", "could not convert"),
    ("time [ms];longitudinal [km/h]", "0;-1,5\n10;-2.5", "has a decimal comma and '-2.5' a point"),
    ("time [ms],longitudinal [km/h]", '0,"-1,5"\n10,"-2,5"', "semicolons or tabs"),
    (
        "time [ms],longitudinal [km/h]",
        "0,1\n10,SNA\n20,2",
        "longitudinal is not available in row 3",
    ),
    (
        "time [ms],longitudinal [km/h],lateral [km/h]",
        "0,1,1\n10,2,SNA",
        "lateral is not available in row 3",
    ),
    ("time [ms],longitudinal [km/h]", "SNA,0\n10,1", "could not convert 'SNA'"),
    (
        "time [ms],longitudinal [km/h]",
        "0," + "1" * 200_000,
        "it is no table \\(field larger than field limit",
    ),
    ("time [ms],longitudinal [km/h]", "0," + "1" * 1_000, "row 2 has a cell of 1000 characters"),
    ("time [ms],longitudinal [km/h]", '0,"1', "it is no table"),
    ("time [ms],longitudinal [km/h]", '0,"1"2', "it is no table"),
    ("time [ms],longitudinal [km/h]", "0,1\0", "holds NUL characters"),
    ("time [ms],longitudinal [km/h]", "0,1\n" * 300_000, "larger than 1 MB"),
]


@pytest.mark.parametrize(
    ("heads", "cells", "said"), TABLES, ids=[f"{i}" for i in range(len(TABLES))]
)
def test_tables_that_say_something_else_are_refused(heads, cells, said, tmp_path):
    path = tmp_path / "pulse.csv"
    path.write_text(f"{heads}\n{cells}", encoding="utf-8", newline="")
    with pytest.raises(col.InputError, match=said) as caught:
        recorded_pulse(path, polarity="49 CFR 563")
    assert (caught.value.code, caught.value.fields["argument"]) == ("bad_file", "time")
    assert "write time [ms],longitudinal [km/h],lateral [km/h], or give arrays" in str(caught.value)


# Heads of the longitudinal column with a word that is not of cumulative delta-V, positive forward.
FORWARD_HEADS = [
    ("longitudinal deceleration", "deceleration"), ("deceleration, longitudinal", "deceleration"),
    ("longitudinal jerk", "jerk"), ("incremental longitudinal", "incremental"),
    ("longitudinal delta-V increment", "increment"), ("longitudinal delta-V per sample", "per"),
    ("longitudinal delta-V (abs)", "abs"), ("|longitudinal delta-V|", "|"),
    ("longitudinal delta-V, absolute", "absolute"), ("longitudinal delta-v x -1", "-"),
    ("longitudinal delta-V x10", "10"), ("-longitudinal", "-"), ("\u2212longitudinal", "\u2212"),
    ("longitudinal * 2", "*"), ("longitudinal of the other vehicle", "other"),
    ("longitudinal error", "error"), ("longitudinal limit", "limit"),
    ("longitudinal mean", "mean"), ("longitudinal offset", "offset"),
    ("longitudinal target", "target"), ("longitudinal EES", "ees"),
    ("longitudinal PDOF", "pdof"), ("longitudinal sensor 2", "sensor"),
    ("Event 1 longitudinal", "event"), ("longitudinal delta-V 2", "2"),
    ("loss of longitudinal velocity", "loss"), ("longitudinal inverted", "inverted"),
    ("longitudinal SAE J670", "j"), ("longitudinal_kmh (mph)", "kmh"), ("v longitudinal", "v"),
]  # fmt: skip
LATERAL_HEADS = [
    ("lateral inverted", "inverted"), ("lateral, passenger side", "passenger"),
    ("lateral outboard", "outboard"), ("lateral nearside", "nearside"),
    ("lateral from left", "from"), ("lateral (- right)", "-"), ("lateral ISO 6487", "6487"),
    ("lateral x", "x"),
]  # fmt: skip
TIME_HEADS = [
    ("time remaining", "remaining"), ("time to event", "to"), ("time step", "step"),
    ("time constant", "constant"), ("sample time", "sample"), ("time since ignition", "since"),
    ("delta time", "delta"), ("-time", "-"),
]  # fmt: skip


@pytest.mark.parametrize(("head", "word"), [*FORWARD_HEADS, *LATERAL_HEADS, *TIME_HEADS])
def test_a_head_with_a_word_that_is_not_known_is_refused(head, word, tmp_path):
    """What else it says may mean another quantity or the other sign."""
    heads = {"time": "time [ms]", "longitudinal": "longitudinal [km/h]"}
    of = next((one for one in ("longitudinal", "lateral") if one in head), "time")
    heads[of] = head if "(mph)" in head else f"{head} [{'ms' if of == 'time' else 'km/h'}]"
    columns = [TIMES, FORWARD, LATERAL]
    path = written(tmp_path / "p.csv", ";".join(heads.values()), columns[: len(heads)], ";")
    with pytest.raises(col.InputError) as caught:
        recorded_pulse(path, polarity="49 CFR 563")
    text = str(caught.value)
    assert caught.value.code == "bad_file"
    assert re.search(rf" says ('[^']*', )*{re.escape(repr(word))}[, ].*is not understood", text)
    assert f"if it is, write '{of} [unit]' as its head" in text
    assert "or give arrays" in text


@pytest.mark.parametrize(
    ("head", "polarity"),
    [
        *((head, "49 CFR 563") for head in ("lateral SAE", "SAE J211 lateral", "lateral (SAE)",
            "lateral, 49 CFR 563", "lateral (Part 563)", "lateral (SAE J1733)",
            "y axis lateral delta-V (+ = right)", "lateral, positive to the right")),
        *((head, "ISO 8855") for head in ("lateral ISO", "ISO 8855 lateral", "lateral (ISO)",
            "lateral left positive", "lateral from the right to the left")),
    ],
)  # fmt: skip
def test_a_side_that_a_head_states_agrees_with_the_polarity_or_is_refused(head, polarity, tmp_path):
    heads = f"time [ms];longitudinal [km/h];{head} [km/h]"
    path = written(tmp_path / "p.csv", heads, [TIMES, FORWARD, LATERAL], ";")
    side = {"49 CFR 563": -1.0, "ISO 8855": 1.0}[polarity]
    assert recorded_pulse(path, polarity=polarity).delta_v_left == pytest.approx(9 * KMH * side)
    (other,) = {"49 CFR 563", "ISO 8855"} - {polarity}
    with pytest.raises(col.InputError, match=f"and by polarity='{other}' lateral is positive to"):
        recorded_pulse(path, polarity=other)


@pytest.mark.parametrize(
    "head",
    ["Delta-V, longitudinal (km/h)", "Longitudinal Crash Pulse (km/h)", "Long. Delta V (km/h)",
     "Longitudinal Cumulative Delta-V (KPH)", "Recorded longitudinal velocity change [km/h]",
     "LONGITUDINAL AXIS RECORDED VELOCITY CHANGE (KM/H)", "longitudinal change of velocity [km/h]",
     "longitudinal (x) \u0394v, positive forward [km/h]", "longitudinal_kmh [km/h]"],
)  # fmt: skip
def test_heads_of_retrieval_reports_are_read(head, tmp_path):
    path = written(tmp_path / "p.csv", f"Time (msec);{head}", [TIMES, FORWARD], ";")
    pulse = recorded_pulse(path, polarity="49 CFR 563")
    assert pulse.delta_v_forward == pytest.approx(-40 * KMH, rel=1e-14)


@pytest.mark.parametrize(
    "data",
    [
        b"time [ms],longitudinal [km/h] \xe9\n0,1",
        b"\xff\xfet\x00i",
        b"\x00" * 50,
        bytes(range(256)),
    ],
)
def test_files_that_are_no_text_are_refused(data, tmp_path):
    path = tmp_path / "pulse.csv"
    path.write_bytes(data)
    with pytest.raises(col.InputError) as caught:
        recorded_pulse(path, polarity="49 CFR 563")
    assert caught.value.code == "bad_file"


def test_a_file_has_its_delta_v(tmp_path):
    path = written(tmp_path / "pulse.csv", "time [ms],longitudinal [km/h]", [TIMES, FORWARD])
    for name in ("delta_v_forward", "delta_v_left"):
        with pytest.raises(col.InputError, match=f"{name} stands beside the file") as caught:
            recorded_pulse(path, **{name: SHAPE}, polarity="49 CFR 563")
        assert caught.value.fields["argument"] == name


@pytest.mark.parametrize(
    ("left", "bound"),
    [
        ([0.0, 2.0, 5.0, 6.0, 5.0, 3.5, 2.0], None),  # on its way back
        ([0.0, 0.0, 0.0, 0.1, 0.2, 0.3, 0.49], None),  # within half a km/h of 0
        ([0.0, -2.0, -2.5, -2.0, -1.0, 1.0, 2.4], None),  # greater before, to the other side
        ([0.0, 0.0, 0.0, 0.1, 0.2, 0.3, 0.51], 0.51),
        ([0.0, 2.0, 5.0, 6.0, 7.0, 7.0, 7.0], 7.0),
        ([0.0, 2.0, 5.0, 6.0, 7.0, 7.1, 7.0], None),
    ],
)
def test_a_component_that_does_not_grow_when_a_record_stops_is_no_bound(left, bound):
    """It need not have gone on to be as much."""
    ahead = np.array([0.0, -3.0, -7.0, -12.0, -17.0, -22.0, -27.0]) * KMH
    time = 0.01 * np.arange(7)
    with pytest.warns(col.OutOfRangeWarning, match="a lower bound"):
        pulse = recorded_pulse(time, ahead, np.array(left) * KMH, polarity="ISO 8855")
    assert pulse.evidence[0].high == pulse.delta_v_forward
    assert (pulse.evidence[1] and pulse.evidence[1].low) == (bound and pytest.approx(bound * KMH))
    with pytest.warns(col.OutOfRangeWarning):
        mirrored = recorded_pulse(time, ahead, np.array(left) * KMH, polarity="49 CFR 563")
    assert (mirrored.evidence[1] is None) == (bound is None)


def test_a_bound_holds_from_the_total_to_the_end_of_the_record():
    """The largest resultant need not be that of the last sample: what falls from there on is no
    bound, and what grows on is one at the total.
    """
    ahead = np.array([0, -4, -9, -14, -18, -22, -25, -23]) * KMH
    aside = np.array([0, 1, 2, 3, 4, 5, 6, 8]) * KMH
    with pytest.warns(col.OutOfRangeWarning, match="a lower bound"):
        pulse = recorded_pulse(0.01 * np.arange(8), ahead, aside, polarity="ISO 8855")
    assert pulse.delta_v_forward == -25 * KMH
    forward, left = pulse.evidence
    assert forward is None
    assert left.low == 6 * KMH


def test_a_cut_record_of_exactly_0_says_nothing_of_the_side():
    """A bound at 0 would assert one of the sides."""
    time = TIME[TIME <= 0.0601]
    for zero in (0.0, -0.0):
        with pytest.warns(col.OutOfRangeWarning):
            pulse = recorded_pulse(
                time, -40 * KMH * haversine(time), zero * time, polarity="49 CFR 563"
            )
        assert pulse.evidence[0].high == pulse.delta_v_forward
        assert pulse.evidence[1] is None
    with pytest.warns(col.OutOfRangeWarning):
        assert (
            recorded_pulse(
                time, 0.0 * time, -40 * KMH * haversine(time), polarity="ISO 8855"
            ).evidence[0]
            is None
        )
    # One that has ended there says that it is 0, to its error.
    whole = recorded_pulse(TIME, -40 * KMH * haversine(TIME), 0.0 * TIME, polarity="49 CFR 563")
    assert (whole.evidence[1].mean, whole.evidence[1].sd) == (
        0.0,
        pytest.approx(0.5 * KMH / math.sqrt(3), rel=1e-14),
    )


SHAPE = -10 * haversine(TIME)
REFUSALS = [
    ("bad_option", (TIME, SHAPE), {"polarity": "right"}, "'49 CFR 563'"),
    ("bad_shape", (TIME,), {}, "got no delta_v_forward, time"),
    ("bad_shape", (None, SHAPE), {}, "got no time, delta_v_forward"),
    ("bad_shape", (None, SHAPE, SHAPE), {}, "got no time, delta_v_forward"),
    ("bad_shape", (None, None, None), {}, "got no time, no delta_v_forward"),
    # What is to the left is not taken for what is ahead.
    ("bad_shape", (TIME, None, SHAPE), {}, "got no delta_v_forward, time"),
    ("bad_shape", (TIME, SHAPE[1:]), {}, "arrays of one length"),
    ("bad_shape", (TIME[:1], SHAPE[:1]), {}, "two samples at least"),
    ("bad_shape", (0.1, 3.0), {}, "two samples"),
    ("bad_pulse", (TIME[::-1], SHAPE), {}, "must rise"),
    ("bad_pulse", (1000 * TIME, SHAPE), {}, "were milliseconds meant"),
    ("bad_pulse", (TIME, SHAPE * math.nan), {}, "finite number"),
    ("bad_units", (TIME, "3 kg"), {}, "delta_v_forward"),
    # A recorder's step is 1 km/h.
    (
        "bad_pulse",
        (TIME, SHAPE + 5 * KMH),
        {},
        r"delta_v_forward begins with 5 km/h at time 0, .* take its first value off",
    ),
    ("bad_pulse", (TIME, SHAPE, SHAPE - 1.01 * KMH), {}, "delta_v_left begins with"),
    ("bad_pulse", (TIME - 0.05, SHAPE + 5 * KMH), {}, "at -0.05 s, before time 0"),
    # An acceleration, which is greatest early.
    ("bad_pulse", (TIME, -95.0 * np.exp(-TIME / 0.05)), {}, "not a speed or an acceleration"),
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


def test_the_place_of_the_recorder_is_kept():
    """With the readings, and handed on with them; the readings stay those of that place."""
    given = (TIME, -6.0 * haversine(TIME), 1.0 * haversine(TIME))
    pulse = recorded_pulse(*given, polarity="ISO 8855", forward="50 cm", left=-0.1)
    assert pulse.place == (0.5, -0.1)
    assert pulse.delta_v_forward == -6.0
    assert pulse.inputs("b")["recorder_b"] == (0.5, -0.1)
    assert re.search(r"recorder ahead +0\.50 m\n", str(pulse.summary("metric")))
    assert [part.m_as("cm") for part in pulse.q.place] == pytest.approx([50.0, -10.0])
    assert pickle.loads(pickle.dumps(pulse)).place == pulse.place
    plain = recorded_pulse(*given, polarity="ISO 8855")
    assert plain.place is None
    assert "recorder_b" not in plain.inputs("b")
    assert "recorder" not in str(plain)
    assert recorded_pulse(*given, polarity="ISO 8855", forward=0, left=0).place == (0.0, 0.0)


@pytest.mark.parametrize(
    ("place", "code", "said"),
    [
        ({"forward": 0.5}, "missing_place", "write left=0"),
        ({"left": "20 cm"}, "missing_place", "write forward=0"),
        ({"forward": 500.0, "left": 0.0}, "out_of_range", "were millimetres meant"),
        ({"forward": math.nan, "left": 0.0}, "not_finite", "forward"),
        ({"forward": "0.5 s", "left": 0.0}, "bad_units", "forward"),
        ({"forward": np.array([0.5, 0.6]), "left": 0.0}, "bad_shape", "one number"),
    ],
)
def test_a_place_that_is_none_is_refused(place, code, said):
    with pytest.raises(col.InputError, match=said) as caught:
        recorded_pulse(TIME, SHAPE, polarity="49 CFR 563", **place)
    assert caught.value.code == code


def test_a_record_that_begins_before_or_after_its_zero_has_the_same_duration():
    """The time from its first sample to the greatest delta-V, wherever the recorder counts from."""
    shape = -10.0 * haversine(TIME)
    for start in (-0.05, 0.0, 0.2):
        pulse = recorded_pulse(TIME + start, shape, polarity="ISO 8855")
        assert pulse.duration == pytest.approx(0.11, rel=1e-9), start


def test_a_table_that_begins_one_step_late_counts_from_time_0():
    """And one that begins later, with some delta-V already, is refused."""
    shape = -10.0 * haversine(TIME)
    late = recorded_pulse(TIME[1:], shape[1:], polarity="ISO 8855")
    assert late.duration == pytest.approx(0.11, rel=1e-9)
    with pytest.raises(col.InputError, match="the samples before it are not there") as caught:
        recorded_pulse(TIME[2:], shape[2:], polarity="ISO 8855")
    assert caught.value.code == "bad_pulse"


def test_samples_before_the_pulse_begins_are_no_part_of_its_duration():
    """A record may begin before its time zero, or with zeros after it."""
    for start, begins in ((-0.05, 0.0), (0.0, 0.06)):
        time = start + np.arange(0.0, 0.3, 0.01)
        since = np.round(time - begins, 9)
        forward, left = -8.0 * haversine(since), 2.0 * haversine(since - 0.02)
        pulse = recorded_pulse(time, forward, left, polarity="ISO 8855")
        assert pulse.duration == pytest.approx(0.13, rel=1e-9), start
        np.testing.assert_allclose(pulse.time, time, rtol=1e-12)
    flat = recorded_pulse(TIME, 0.0 * TIME, polarity="ISO 8855")
    assert flat.duration == 0.0


@pytest.mark.parametrize(
    ("early", "late"),
    [
        ({-0.02: 1.0}, {}),
        ({-0.04: 0.0, -0.02: -1.0}, {}),
        ({-0.02: 0.0}, {0.0: 1.0}),
        ({-0.06: 0.02, -0.04: -0.03, -0.02: 0.01}, {0.0: -0.02}),
        ({-0.02: -0.6}, {0.0: -0.6}),
    ],
)
def test_a_step_of_the_recorder_before_time_0_is_no_part_of_the_duration(early, late):
    """The change of the event begins at time 0, where no more than a step stands before it: as for
    the same table from time 0 on, 80 ms to its largest delta-V, which is none of those before.
    """
    event = {0.0: 0.0, 0.02: -2.0, 0.04: -8.0, 0.06: -14.0, 0.08: -16.0, 0.1: -16.0}
    aside = {0.02: 0.5, 0.04: 2.0, 0.06: 3.0, 0.08: 3.0, 0.1: 3.0}
    for share in (1.0, 0.05):
        whole = early | {at: share * value for at, value in event.items()} | late
        if share < 1.0 and late:
            continue
        time, forward = np.array([*whole]), KMH * np.array([*whole.values()])
        left = KMH * share * np.array([aside.get(at, 0.0) for at in whole])
        for parts in ((forward,), (0.0 * forward, forward), (forward, left)):
            pulse = recorded_pulse(time, *parts, polarity="ISO 8855")
            assert pulse.duration == pytest.approx(0.08, rel=1e-12)
            assert pulse.delta_v == pytest.approx(share * math.hypot(16, 3 * (parts[-1] is left))
                                                  * KMH, rel=1e-12)  # fmt: skip
            readings = [one for one in pulse.evidence if one is not None]
            assert -share * 16 * KMH in [pytest.approx(one.mean, rel=1e-12) for one in readings]


def test_a_record_that_counts_from_elsewhere_begins_where_it_was_last_none():
    """More than a step stands before time 0 and there: what came and went before is no part."""
    shape = -10.0 * haversine(TIME)
    time = np.concatenate([[-0.09, -0.08, -0.07, -0.06], TIME - 0.05])
    forward = np.concatenate([[0.0, 0.5 * KMH, 0.0, 0.0], shape])
    pulse = recorded_pulse(time, forward, polarity="ISO 8855")
    assert pulse.duration == pytest.approx(0.11, rel=1e-9)
    # Of another event there is more before, and none left.
    forward[1] = -6.0 * KMH
    forward[4:] = 10.0 * KMH * np.clip(TIME - 0.05, 0.0, None)
    with pytest.raises(col.InputError, match=r"forward is -6 km/h at -0\.08 s") as caught:
        recorded_pulse(time, forward, polarity="ISO 8855")
    assert caught.value.code == "bad_pulse"


def test_the_bound_of_a_record_that_stops_early_is_told_in_km_per_hour():
    """10 m/s are 36 km/h; the time is that of the last sample."""
    time = np.arange(0.0, 0.0601, 0.01)
    with pytest.warns(
        col.OutOfRangeWarning,
        match=re.escape(
            "the record stops at 0.06 s while delta-V still changes: 36 km/h is a lower bound"
        ),
    ):
        pulse = recorded_pulse(time, -10.0 * time / 0.06, polarity="ISO 8855")
    with pytest.raises(col.InputError, match=r"36 km/h is a lower bound"):
        pulse.inputs("a")
    assert any("36 km/h is a lower bound" in one for one in pulse.statements)
    said = " ".join(str(pulse.summary("us")).split())
    assert "22.4 mph is a lower bound" in said
    assert "km/h" not in said


def test_a_record_of_nothing_has_no_direction():
    """A vector of 0 points nowhere."""
    pulse = recorded_pulse(TIME, 0.0 * TIME, 0.0 * TIME, polarity="ISO 8855")
    assert pulse.delta_v == 0.0
    assert pulse.pdof is None
    assert "PDOF" not in str(pulse.summary())


def test_the_evidence_of_a_reading_has_the_deviation_of_its_range():
    """10 % of 36 km/h either way: as a uniform distribution, 1 m/s over the root of three."""
    pulse = recorded_pulse(TIME, -10.0 * haversine(TIME), polarity="ISO 8855")
    given, aside = pulse.evidence
    assert aside is None
    assert (given.mean, given.sd) == pytest.approx((-10.0, 1.0 / math.sqrt(3.0)), rel=1e-12)


def test_a_first_sample_may_be_off_by_the_step_of_a_recorder():
    """By 1 km/h, and by more where the record begins after the event has."""
    shape = -10.0 * haversine(TIME)
    assert recorded_pulse(TIME, shape + KMH, polarity="ISO 8855").ended
    assert recorded_pulse(TIME + 0.01, shape - 3 * KMH, polarity="ISO 8855").ended


def test_a_delta_v_beyond_what_recorders_are_exact_for(tmp_path):
    """49 CFR 563.8, Table III: -100 to 100 km/h. Numbers without a unit may be of another one."""
    with pytest.warns(col.SuspectUnitsWarning, match=r"-864 km/h.*pint.Quantity\(values") as bare:
        recorded_pulse(TIME, -240.0 * haversine(TIME), polarity="49 CFR 563")
    assert (bare[0].message.code, bare[0].message.fields["argument"]) == (
        "suspect_units",
        "delta_v_forward",
    )
    registry = pint.get_application_registry()
    fast = registry.Quantity(-864.0 * haversine(TIME), "km/h")
    with pytest.warns(col.OutOfRangeWarning, match="delta_v_left goes to 864 km/h") as given:
        recorded_pulse(TIME, SHAPE, fast, polarity="49 CFR 563")
    assert given[0].message.code == "beyond_recorder"
    cells = [str(round(-240.0 * share, 2)) for share in haversine(TIME)]
    path = written(tmp_path / "p.csv", "time [ms],longitudinal [m/s]", [TIMES, cells])
    with pytest.warns(col.OutOfRangeWarning, match="goes to -864 km/h"):
        recorded_pulse(path, polarity="49 CFR 563")


def test_three_decimals_are_decimals_where_the_column_shows_it(tmp_path):
    path = tmp_path / "p.csv"
    for rows in (
        "0;0,000\n10;-5,123\n20;-24,124\n60;-24,124",
        "0;0\n10;-5\n20;-24,124\n60;-24,12",
        "0;0\n10;-0,123\n20;-24,124\n60;-24,124",
    ):
        path.write_text(f"time [ms];longitudinal [km/h]\n{rows}", encoding="utf-8")
        pulse = recorded_pulse(path, polarity="49 CFR 563")
        assert pulse.delta_v_forward == pytest.approx(-24.124 * KMH, rel=1e-12)


LONG = np.arange(0.0, 0.4001, 0.01)


@pytest.mark.parametrize(
    ("speed", "ended", "had"),
    [
        # Locked wheels from 0.11 s on, 0.49 km/h in each 20 ms.
        (
            24.0 * np.clip(LONG / 0.11, 0.0, 1.0) + 24.7 * np.clip(LONG - 0.11, 0.0, None),
            0.13,
            24.5,
        ),
        # Another impact, from 0.16 s on.
        (
            10.0 * np.clip(LONG / 0.08, 0.0, 1.0) + 15.0 * np.clip((LONG - 0.16) / 0.08, 0.0, 1.0),
            0.1,
            10.0,
        ),
    ],
)
def test_delta_v_after_the_end_of_the_event_is_said(speed, ended, had):
    """49 CFR 563.7, Table I: the maximum is sought up to 30 ms after the end of the event."""
    with pytest.warns(col.OutOfRangeWarning, match=f"had ended at {ended:g} s") as warned:
        pulse = recorded_pulse(LONG, -speed / 3.6, polarity="49 CFR 563")
    assert [one.message.code for one in warned] == ["went_on"]
    (said,) = pulse.statements
    assert f"went on to {speed.max():.4g} km/h at {LONG[np.argmax(speed)]:.3g} s" in said
    assert "mph" in " ".join(str(pulse.summary("us")).split()).partition("went on to")[2]
    with pytest.warns(col.OutOfRangeWarning, match="went on to"):
        study = uncertainty.propagate(
            lambda delta_v_forward_b: {"x": delta_v_forward_b}, pulse.inputs("b"), samples=64
        )
    assert any(said in one for one in study.statements)
    with pytest.warns(col.OutOfRangeWarning, match="went on to"):
        found = posterior(
            lambda v: {"y": v},
            {"v": uncertainty.Uniform(-20.0, 0.0)},
            {"y": pulse.evidence[0]},
            samples=512,
            seed=1,
        )
    assert any(said in one for one in found.statements)
    # The samples after the end left out, there is nothing to say.
    count = np.count_nonzero(ended + 0.02 >= LONG)
    cut = recorded_pulse(LONG[:count], -speed[:count] / 3.6, polarity="49 CFR 563")
    assert cut.statements == ()
    assert cut.delta_v * 3.6 == pytest.approx(had, abs=0.5)


def test_the_size_at_the_end_of_the_event_is_that_of_its_time():
    """And not that of 30 ms later, up to which the maximum is sought; nor does a turn go unsaid."""
    speed = np.interp(LONG, [0.0, 0.03, 0.06, 0.12, 0.4], [0.0, 5.0, 5.7, 40.0, 40.0])
    with pytest.warns(col.OutOfRangeWarning, match=r"ended at 0\.05 s, with 5\.467 km/h"):
        recorded_pulse(LONG, -speed / 3.6, polarity="49 CFR 563")
    ahead = 30.0 * np.clip(LONG / 0.1, 0.0, 1.0) * np.clip((0.34 - LONG) / 0.1, 0.0, 1.0)
    aside = 30.5 * np.clip((LONG - 0.24) / 0.1, 0.0, 1.0)
    with pytest.warns(col.OutOfRangeWarning, match=r"to 30\.5 km/h, in another direction, at"):
        recorded_pulse(LONG, -ahead / 3.6, aside / 3.6, polarity="49 CFR 563")
    back = 10.0 * np.clip(LONG / 0.08, 0.0, 1.0) - 40.0 * np.clip((LONG - 0.16) / 0.08, 0.0, 1.0)
    with pytest.warns(col.OutOfRangeWarning, match=r"to 30 km/h, in another direction, at"):
        recorded_pulse(LONG, -back / 3.6, polarity="49 CFR 563")


def test_what_comes_within_the_stated_error_after_the_end_is_not_said():
    """A step of rounding, and little braking: the range holds both."""
    for later in (1.0, 2.0):
        speed = 24.0 * np.clip(TIME / 0.11, 0.0, 1.0) + later * np.greater(TIME, 0.195)
        pulse = recorded_pulse(TIME, -speed / 3.6, polarity="49 CFR 563")
        assert pulse.statements == ()
