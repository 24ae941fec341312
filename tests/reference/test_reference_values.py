"""Published values: against where they were published, their ranges, sources, refusals and
warnings.
"""

import itertools
import math
import operator
import re
import warnings

import numpy as np
import pint
import pytest

import collisions as col
from collisions import reconstruct, reference

MPH = 0.44704
# Code of Virginia, section 46.2-880: miles per hour and braking distance of automobiles in feet.
VIRGINIA = {
    10: 5, 15: 11, 20: 19, 25: 30, 30: 43, 35: 58, 40: 76, 45: 96, 50: 119, 55: 144,
    60: 171, 65: 201, 70: 233, 75: 268, 80: 305, 85: 344, 90: 386, 95: 430, 100: 476,
}  # fmt: skip
# Small-overlap tests, pycrash Brach Matrix.xlsx: share of the critical ratio in percent, critical
# ratio, restitution.
SMALL_OVERLAP = [
    (100, -1.98, 0.0), (98.9, -2.006, 0.147), (82.3, -1.909, 0.0), (89.5, -1.903, 0.0),
        (100, -1.944, 0.039),
    (97.4, -1.705, 0.253), (100, -2.048, 0.0), (100, -2.041, 0.022), (99.3, -1.718, 0.15),
        (100, -1.839, 0.231),
]  # fmt: skip


# Restitution


@pytest.mark.parametrize(
    ("mph", "e"), [(2, 0.4876), (3, 0.4418), (5, 0.3826), (7, 0.3394), (10, 0.2871), (15, 0.2161)]
)
def test_the_fit_has_the_values_of_the_shared_table(mph, e):
    """To the last of its four digits."""
    assert reference.restitution(f"{mph} mph") == pytest.approx(e, abs=5e-5)


def test_the_fit_against_what_was_measured():
    """Two tests of GBB: what the quality says of them, to its two digits."""
    for mph, measured, below in ((5.5, 0.2, 0.17), (8.0, 0.266, 0.05)):
        assert reference.restitution(mph * MPH) - measured == pytest.approx(below, abs=5e-3)
    assert "0.17 and 0.05 below" in reference.RESTITUTION_FIT.quality


def test_it_is_warned_of_beyond_its_range_and_refused_where_it_is_none():
    """From 15 mph on an extrapolation; above 58.7 km/h it would be negative."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        reference.restitution("2 mph"), reference.restitution("15 mph")
    with pytest.warns(
        col.OutOfRangeWarning, match="closing_speed 15 m/s lies outside the range"
    ) as caught:
        assert 0.0 < reference.restitution(15.0) < 0.05
    assert caught[0].filename == __file__
    assert "SAE 2002-01-0540" in str(caught[0].message)
    with pytest.warns(col.OutOfRangeWarning):
        reference.restitution("58.7 km/h")
    for speed in ("58.8 km/h", 30.0, 0.07):
        with pytest.raises(
            col.InputError, match="no restitution; it holds from 2 to 15 mph"
        ) as refused:
            reference.restitution(speed)
        assert refused.value.code == "outside_reference"


def test_refuse_keeps_to_the_range():
    """Both ends hold, beyond them nothing does."""
    assert reference.restitution("15 mph", outside="refuse") == reference.restitution("15 mph")
    for speed in (1.99 * MPH, 15.01 * MPH):
        with pytest.raises(col.InputError, match=re.escape("outside='warn'")) as refused:
            reference.restitution(speed, outside="refuse")
        assert refused.value.code == "outside_reference"
        assert refused.value.fields["argument"] == "closing_speed"


def test_many_at_once():
    """As one by one; those without an answer are NaN, counted in one warning."""
    speeds = np.array([1.0, 5.0, 10.0, 20.0, -1.0, 0.0, math.nan])
    with pytest.warns(col.OutOfRangeWarning, match="of 7 cases 1 lie outside") as caught:
        found = reference.restitution(speeds)
    assert len(caught) == 1
    assert caught[0].message.fields["counts"] == {"outside_reference": 1, "refused": 4}
    assert np.isnan(found).tolist() == [False, False, False, True, True, True, True]
    # math.log10 and numpy's may differ by a rounding.
    assert found[:2] == pytest.approx(
        [reference.restitution(speed) for speed in (1.0, 5.0)], rel=4e-16
    )
    assert not found.flags.writeable
    with pytest.warns(col.OutOfRangeWarning, match="5 have no answer"):
        assert np.isnan(reference.restitution(speeds, outside="refuse")[2])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert reference.restitution(np.array([2.0, 3.0], dtype=np.float32)).dtype == np.float32


def test_the_reverse_solvers_take_it():
    """And say where it ended."""

    def fit(speed):
        return reference.restitution(speed, outside="refuse")

    closing = reconstruct.inline_closing_speed(1500, 1500, fit, delta_v_b="5 km/h")
    assert (1.0 + fit(closing)) / 2.0 * closing == pytest.approx(5 / 3.6, rel=1e-12)
    with pytest.raises(col.InputError, match="lies outside the range it holds for"):
        reconstruct.inline_closing_speed(1500, 1500, fit, delta_v_b="30 km/h")


def test_the_plausible_range_holds_what_was_measured():
    """Every restitution of the shared tables at its closing speed."""
    measured = [
        (5.5 * MPH, 0.2),
        (8.0 * MPH, 0.266),
        (52.35 * MPH, 0.126),
        (54.49 * MPH, 0.15),
        (57.09 / 3.6, 0.17),
        (16.7, 0.008),
    ]
    measured += [(speed, e) for _, _, e in SMALL_OVERLAP for speed in (3.83, 5.04)]
    for speed, e in measured:
        low, high = reference.restitution_range(speed)
        assert low <= e <= high
    assert reference.restitution_range(0.5) == (0.0, 1.0)
    assert reference.restitution_range("30 m/s") == (0.0, 0.3)
    low, high = reference.restitution_range(np.array([0.5, 5.0, 30.0, -1.0]))
    assert low[:3].tolist() == [0.0] * 3
    assert high[:3] == pytest.approx(
        [reference.restitution_range(speed)[1] for speed in (0.5, 5.0, 30.0)], rel=4e-16
    )
    assert np.isnan(high[3])
    with pytest.raises(col.InputError, match="must be >= 0"):
        reference.restitution_range(-1.0)


# Yaw inertia


def test_yaw_inertia_of_the_car_that_could_be_compared():
    """2008 Ford Fusion in pycrash: 3574.2 lb, 190 in, wheelbase 107 in, 6 ft wide, 2336.3 slug ft2;
    what the quality says.
    """
    measured = pint.get_application_registry().Quantity(2336.3, "slug*ft**2").m_as("kg*m**2")
    size = {"mass": "3574.2 lb", "length": "190 inch"}
    low = reference.yaw_inertia(**size, wheelbase="107 inch")
    high = reference.yaw_inertia(**size, width="6 ft")
    assert round(100 * (low / measured - 1)) == -15
    assert round(100 * (high / measured - 1)) == 14
    assert "15 percent less" in reference.YAW_INERTIA_WHEELBASE.quality
    assert "14 percent more" in reference.YAW_INERTIA_RECTANGLE.quality


def test_yaw_inertia_of_the_published_input_set():
    """Schreier and Nelson's cars, as recomputed from eeswebgl: 998.3477 and 2681.4224 kg m2."""
    for mass, wheelbase, length, expected in (
        (880, 2.4, 3.725, 998.3477),
        (1600, 2.795, 4.725, 2681.4224),
    ):
        assert reference.yaw_inertia(mass, length=length, wheelbase=wheelbase) == pytest.approx(
            expected, abs=5e-5
        )


def test_the_rectangle_is_one():
    """Against a sum over cells; halving their size quarters the error, which is (1/400)**2."""
    across, along = (
        ((np.arange(400) + 0.5) / 400 - 0.5)[:, np.newaxis] * 1.8,
        ((np.arange(400) + 0.5) / 400 - 0.5) * 4.5,
    )
    summed = 1500.0 * np.mean(across**2 + along**2)
    assert reference.yaw_inertia(1500, length=4.5, width=1.8) == pytest.approx(
        summed, rel=1 / 400**2 * 1.01
    )


def test_yaw_inertia_outside_and_in_batches():
    """Warned of, refused when asked to be, NaN in a batch."""
    with pytest.warns(col.OutOfRangeWarning, match="mass 2500 kg"):
        assert reference.yaw_inertia(2500, length=4.5, width=1.9) > 0.0
    with pytest.raises(col.InputError, match="lies outside the range") as refused:
        reference.yaw_inertia(2500, length=4.5, width=1.9, outside="refuse")
    assert refused.value.code == "outside_reference"
    with pytest.warns(col.OutOfRangeWarning, match="of 3 cases 1 lie outside"):
        found = reference.yaw_inertia(np.array([1000.0, 2500.0, -1.0]), length=4.5, width=1.8)
    assert found[0] == pytest.approx(
        reference.yaw_inertia(1000.0, length=4.5, width=1.8), rel=1e-15
    )
    assert np.isnan(found).tolist() == [False, False, True]


# Ranges


def test_drag_behind_the_table_of_virginia():
    """Every braking distance to the foot, by the formula of the course sheets that the quality
    names.
    """
    drag = reference.DRAG_FACTORS[-1]
    assert drag.low == drag.high == 0.70
    assert "30 times 0.70" in drag.quality
    assert {mph: round(mph**2 / (30 * drag.low)) for mph in VIRGINIA} == VIRGINIA


def test_drag_factors_of_the_table():
    """As quoted at mfes.com: below and above 30 mph."""
    quoted = {
        "new dry asphalt": ((0.80, 1.2), (0.65, 1.0)),
        "travelled dry asphalt": ((0.60, 0.80), (0.55, 0.70)),
        "polished dry asphalt": ((0.55, 0.75), (0.45, 0.65)),
    }
    for surface, rows in quoted.items():
        for speed, (low, high) in zip(("29.9 mph", "30 mph"), rows, strict=True):
            row = reference.drag_factor(surface, speed=speed)
            assert (row.low, row.high) == (low, high)
            assert "mfes.com" in row.source


@pytest.mark.parametrize("speed", ["30 mph", "44 ft/s", "48.28032 km/h", "13.4112 m/s", 13.4112])
def test_exactly_thirty_miles_an_hour_is_above_in_any_unit(speed):
    """A mile has 5280 ft, so 44 ft/s is exactly that, but for rounding."""
    assert reference.drag_factor("travelled dry asphalt", speed=speed).low == 0.55


# EDSMAC manual, Table 2-7, with the surfaces in its order: dry below and above 30 mph, wet below
# and above.
EDSMAC = """
new concrete           0.80 - 1.20 | 0.70 - 1.00 | 0.50 - 0.80 | 0.40 - 0.75
travelled concrete     0.60 - 0.80 | 0.60 - 0.75 | 0.45 - 0.70 | 0.45 - 0.65
polished concrete      0.55 - 0.75 | 0.50 - 0.65 | 0.45 - 0.65 | 0.45 - 0.60
new asphalt            0.80 - 1.20 | 0.65 - 1.00 | 0.50 - 0.80 | 0.45 - 0.75
travelled asphalt      0.60 - 0.80 | 0.55 - 0.70 | 0.50 - 0.80 | 0.45 - 0.75
polished asphalt       0.55 - 0.75 | 0.45 - 0.65 | 0.45 - 0.65 | 0.40 - 0.60
asphalt with excess tar 0.50 - 0.60 | 0.35 - 0.60 | 0.30 - 0.60 | 0.25 - 0.55
packed and oiled gravel 0.55 - 0.85 | 0.50 - 0.80 | 0.40 - 0.80 | 0.40 - 0.60
loose gravel           0.40 - 0.70 | 0.40 - 0.70 | 0.45 - 0.75 | 0.45 - 0.75
packed cinders         0.50 - 0.70 | 0.50 - 0.70 | 0.65 - 0.75 | 0.65 - 0.75
crushed rock           0.55 - 0.75 | 0.55 - 0.75 | 0.55 - 0.75 | 0.55 - 0.75
ice                    0.10 - 0.25 | 0.07 - 0.20 | 0.05 - 0.10 | 0.05 - 0.10
packed snow            0.30 - 0.55 | 0.35 - 0.55 | 0.30 - 0.60 | 0.30 - 0.60
loose snow             0.10 - 0.25 | 0.10 - 0.20 | 0.30 - 0.60 | 0.30 - 0.60
"""


def test_drag_factors_of_every_surface():
    """Each cell of the table, and that there are no others."""
    cells = 0
    for line in EDSMAC.strip().splitlines():
        name, *ends = re.match(
            r"([a-z ]+?) +" + r" \| ".join([r"([\d.]+) - ([\d.]+)"] * 4), line
        ).groups()
        for at, (state, speed) in enumerate(
            itertools.product(("dry", "wet"), ("20 mph", "40 mph"))
        ):
            worn, _, road = name.rpartition(" ")
            surface = (
                f"{worn} {state} {road}"
                if worn in ("new", "travelled", "polished")
                else f"{state} {name}"
            )
            row = reference.drag_factor(surface, speed=speed)
            assert (row.low, row.high) == (float(ends[2 * at]), float(ends[2 * at + 1])), (
                line,
                state,
                speed,
            )
            assert "Table 2-7" in row.source
            cells += 1
    assert cells + 1 == len(reference.DRAG_FACTORS)  # one stands in a statute


def test_values_read_at_second_hand():
    """As Colliseum, EDSMAC Table 2-6, 49 CFR 563 and ESV 2005 have them; what is quoted of others
    says so.
    """
    ends = {
        "CONTACT_DURATION": (0.078, 0.147, 0.115), "CONTACT_DURATION_BRAKED": (0.088, 0.124, 0.109),
        "RESTITUTION_LOW_SPEED_HALF": (0.173, 0.247, None),
        "RESTITUTION_LOW_SPEED_FULL": (0.328, 0.38, None),
        "ROLLING_RESISTANCE": (0.010, 0.013, None), "ENGINE_BRAKING_HIGH": (0.15, 0.2, None),
        "ENGINE_BRAKING_LOW": (0.2, 0.4, None), "RECORDER_ACCURACY": (-0.1, 0.1, None),
        "YAW_INERTIA_INDEX": (0.89, 1.13, None),
    }  # fmt: skip
    for name, values in ends.items():
        row = getattr(reference, name)
        assert (row.low, row.high, row.typical) == values, name
        assert row in reference.PUBLISHED
        assert ("colliseum" in row.source or "quoted" in row.source) == (
            "Second hand" in row.quality
        ), name
    assert reference.RECORDER_ERROR.typical == 0.06
    assert reference.RECORDER_RANGE.q.high.m_as("km/h") == pytest.approx(100.0, rel=1e-15)
    assert reference.RECORDER_RESOLUTION.q.low.m_as("km/h") == pytest.approx(1.0, rel=1e-15)


@pytest.mark.parametrize(
    ("overlap", "ends"),
    [
        (0.1, (0, 0.15)),
        ("45 %", (0, 0.15)),
        (0.46, (0.1, 0.2)),
        (0.5, (0.1, 0.2)),
        ("55 %", (0.15, 0.3)),
        (1.0, (0.15, 0.3)),
    ],
)
def test_restitution_by_overlap(overlap, ends):
    """VuF 2000, p. 275: under, about and over half of the width."""
    row = reference.restitution_by_overlap(overlap)
    assert (row.low, row.high) == ends
    assert "2000, p. 275" in row.source


def test_impulse_ratios_of_the_tests():
    """Ends of the ranges against the rows they are taken from."""
    ratios = [share / 100 * abs(critical) for share, critical, _ in SMALL_OVERLAP]
    small = reference.IMPULSE_RATIO_SMALL_OVERLAP
    assert (round(min(ratios), 2), round(max(ratios), 2)) == (small.low, small.high)
    shares = reference.SHARE_OF_CRITICAL_SMALL_OVERLAP
    assert (min(row[0] for row in SMALL_OVERLAP) / 100, 1.0) == (shares.low, shares.high)
    e = reference.RESTITUTION_SMALL_OVERLAP
    assert (min(row[2] for row in SMALL_OVERLAP), max(row[2] for row in SMALL_OVERLAP)) == (
        e.low,
        e.high,
    )
    # pycrash test_inputs_rose.py: tests 4363, 4364, 4438, 4474.
    oblique = reference.IMPULSE_RATIO_OBLIQUE
    assert (min(0.51, 0.42, 0.44, 0.40), max(0.51, 0.42, 0.44, 0.40)) == (oblique.low, oblique.high)
    e = reference.RESTITUTION_OBLIQUE
    assert (min(0.126, 0.089, 0.095, 0.150), max(0.126, 0.089, 0.095, 0.150)) == (e.low, e.high)


@pytest.mark.parametrize("value", reference.PUBLISHED, ids=lambda value: value.name)
def test_every_value_says_where_it_is_from_and_how_good_it_is(value):
    """A source one can look up, a domain, a quality; ends in order; frozen."""
    assert re.search(r"SAE|https?://|NHTSA", value.source)
    assert value.domain
    assert value.quality.endswith(".")
    assert value.low <= (value.low if value.typical is None else value.typical) <= value.high
    assert value.low in value
    assert value.high + 1.0 not in value
    with pytest.raises(AttributeError):
        value.low = 0.0


@pytest.mark.parametrize("fit", reference.FITS, ids=lambda fit: fit.name)
def test_every_formula_says_so_too(fit):
    """With the range of each argument and its unit."""
    assert fit.source
    assert fit.domain
    assert fit.quality.endswith(".")
    for low, high, unit in fit.ranges.values():
        assert 0.0 < low < high
        assert unit


def test_no_name_twice():
    """So that a table can be read by it."""
    names = [value.name for value in (*reference.PUBLISHED, *reference.FITS)]
    assert len(set(names)) == len(names)
    assert all(hasattr(reference, name) for name in reference.__all__)


@pytest.mark.parametrize(
    ("call", "code", "said"),
    [
        (lambda: reference.restitution("5 m"), "bad_units", "cannot be taken as m/s"),
        (lambda: reference.restitution(0.0), "not_positive", "closing_speed must be > 0, got 0.0"),
        (lambda: reference.restitution(math.nan), "not_finite", "closing_speed is NaN"),
        (lambda: reference.restitution(5.0, outside="nan"), "bad_option", "outside must be 'warn'"),
        (lambda: reference.restitution(5.0, outside=3), "bad_option", "got 3"),
        (
            lambda: reference.yaw_inertia(1500, length=4.5),
            "one_form",
            "exactly one of wheelbase= and width=, got none",
        ),
        (
            lambda: reference.yaw_inertia(1500, length=4.5, wheelbase=2.7, width=1.8),
            "one_form",
            "got both",
        ),
        (
            lambda: reference.yaw_inertia(-1, length=4.5, width=1.8),
            "not_positive",
            "mass must be > 0",
        ),
        (
            lambda: reference.yaw_inertia(1500, length=2.7, wheelbase=4.5),
            "bad_dimensions",
            "is not below length 2.7 m",
        ),
        (
            lambda: reference.yaw_inertia(1e308, length=4.5, width=1.8),
            "out_of_range",
            "not a finite number",
        ),
        (lambda: reference.drag_factor("mud", speed=10.0), "unknown_surface", "'new dry asphalt'"),
        (
            lambda: reference.restitution_by_overlap(0.0),
            "bad_fraction",
            "overlap must be > 0 and at most 1, got 0",
        ),
        (lambda: reference.restitution_by_overlap("150 %"), "bad_fraction", "at most 1"),
        (lambda: reference.restitution_by_overlap(np.ones(2)), "bad_shape", "ask for each"),
        (
            lambda: reference.drag_factor("new dry asphalt", speed=-1.0),
            "negative_speed",
            "speed must be >= 0",
        ),
        (
            lambda: reference.drag_factor("new dry asphalt", speed=np.ones(2)),
            "bad_shape",
            "ask for each",
        ),
        (
            lambda: reference.drag_factor("mud", speed="x"),
            "bad_units",
            "2 arguments cannot be used",
        ),
    ],
)
def test_refusals(call, code, said):
    """Each names the argument and what to write."""
    with pytest.raises(col.InputError, match=re.escape(said)) as caught:
        call()
    assert caught.value.code == code


@pytest.mark.parametrize("overlap", [math.nan, math.inf, None, True, "x", "5 mph"])
def test_an_overlap_that_cannot_be_read_is_refused_once(overlap):
    """And is not said to be above 1 as well."""
    with pytest.raises(col.InputError, match=r"^overlap\b[^\n]*$"):
        reference.restitution_by_overlap(overlap)


def test_values_and_formulas_with_their_units():
    """Each number as a Quantity, by pint itself; a value that is not there stays None."""
    registry = pint.get_application_registry()
    duration = reference.CONTACT_DURATION.q
    assert duration.low.m_as("ms") == pytest.approx(78.0, rel=1e-15)
    assert duration.high.m_as("ms") == pytest.approx(147.0, rel=1e-15)
    assert duration.typical == registry.Quantity(0.115, "s")
    assert reference.RESTITUTION.q.typical is None
    assert duration.source == reference.CONTACT_DURATION.source
    assert reference.INTER_VEHICLE_FRICTION.q.typical == registry.Quantity(0.55, "dimensionless")
    low, high, unit = reference.RESTITUTION_FIT.q.ranges["closing_speed"]
    # 0.44704 m/s is a mile per hour exactly.
    assert (low.m_as("mph"), high.m_as("mph")) == (
        pytest.approx(2.0, rel=1e-15),
        pytest.approx(15.0, rel=1e-15),
    )
    assert unit == "m/s"
    for fit in reference.FITS:
        assert fit.q.ranges.keys() == fit.ranges.keys()
        for name, ends in fit.q.ranges.items():
            assert tuple(end.m_as(fit.ranges[name][2]) for end in ends[:2]) == fit.ranges[name][:2]


@pytest.mark.parametrize("name", ["mass", "length"])
def test_a_yaw_inertia_of_nothing_is_refused(name):
    """None is no number, for the arguments that every form needs."""
    with pytest.raises(col.InputError, match=f"{name} must be a number"):
        reference.yaw_inertia(**{"mass": 1500.0, "length": 4.5, "wheelbase": 2.6, name: None})


def test_membership_reads_units_and_refuses_what_is_no_number():
    """A range is asked with the unit or without; texts that are no number, arrays and objects are
    refused, not compared.
    """
    assert "60 %" in reference.INTER_VEHICLE_FRICTION
    assert "70 ms" not in reference.CONTACT_DURATION
    assert 0.108 in reference.CONTACT_DURATION
    for value in ("x", b"0.5", None, np.array([0.5, 0.6]), "0.5 m", True):
        with pytest.raises(col.InputError):
            operator.contains(reference.INTER_VEHICLE_FRICTION, value)


def test_what_lies_outside_is_said_in_the_units_of_the_inputs():
    """The range too."""
    with pytest.warns(col.OutOfRangeWarning, match=r"closing_speed 36 mph .*, 2 mph to 15 mph"):
        reference.restitution("36 mph")
    with pytest.raises(col.InputError, match=r"mass 9300 lb, length 14 ft, .*1940 lb to 3576 lb"):
        reference.yaw_inertia("9300 lb", length="14 ft", wheelbase="9 ft", outside="refuse")
    with pytest.raises(col.InputError, match="wheelbase 10 ft is not below length 9 ft"):
        reference.yaw_inertia("3000 lb", length="9 ft", wheelbase="10 ft")
