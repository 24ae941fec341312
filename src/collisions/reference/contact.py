"""The contact of vehicles: restitution, friction, impulse ratios, and how long they touch."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..kernels.elementwise import POSITIVE_FINITE
from ..messages.errors import InputError
from ..messages.hints import hinted
from ..quantities.reading import ArgumentReader, at_least_zero, single_number
from ..quantities.refusals import must_be
from ..quantities.tables import Sentences
from ..quantities.units import Input, Value, has_unit, shown, texts_of
from .published import Fit, Outside, Published, check_outside, settle

_MPH = 0.44704
_PYCRASH = "https://github.com/joe-cormier/pycrash"
_EDCRASH = (
    "EDCRASH manual, chapter 6, Coefficient of Restitution Warnings (Engineering Dynamics "
    "Corporation; https://github.com/edccorp/hveManuals, "
    "docs/manuals/programs/EDCRASH/06-messages.md)"
)
_OBLIQUE_TESTS = (
    "Rose, Fenton and Beauchamp, SAE 2006-01-0908, NHTSA tests 4363, 4364, 4438 and 4474, as in "
    "https://github.com/joe-cormier/pycrash (test_inputs_rose.py)"
)
_SMALL_OVERLAP_TESTS = (
    "ten small-overlap barrier tests in https://github.com/joe-cormier/pycrash "
    "(projects/validation impact momentum/docs/Brach Matrix.xlsx)"
)
_OBLIQUE = "oblique frontal impact of car and car or sport utility vehicle, 35 mph each"
_SMALL_OVERLAP = "cars of 2008 to 2012 into a barrier, 40 mph, 20 or 25 percent of the width"

RESTITUTION_FIT = Fit(
    name="restitution against closing speed",
    formula="e = 0.47477 - 0.26139 L + 0.03382 L**2 - 0.11639 L**3, L = log10(closing speed in "
    "m/s)",
    unit="",
    ranges={"closing_speed": (2.0 * _MPH, 15.0 * _MPH, "m/s")},
    source=f"Cipriani and others, SAE 2002-01-0540, as it stands in {_PYCRASH} "
    "(pycrash/functions/ar.py, cipriani_rest)",
    domain="low-speed, collinear, vehicle to vehicle",
    quality=(
        "Read from pycrash, not from the paper: neither the speeds that the paper tested nor the "
        "scatter about the fit could be checked, and 2 to 15 mph is the range in which it is "
        "used here. Two rear-end tests published by GBB lie 0.17 and 0.05 below it. It is "
        "negative above 58.7 km/h."
    ),
)
RESTITUTION = Published(
    name="restitution, vehicle collisions in general",
    low=0.0,
    high=0.25,
    source=_EDCRASH,
    domain="vehicle to vehicle; may be higher at low speed, where bumpers spring back",
    quality="A rule in the manual of a program, without tests beside it; the tests at full speed "
    "exceed it by at most 0.003.",
)
RESTITUTION_LOW_SPEED = Published(
    name="restitution, low speed",
    low=0.2,
    high=0.4,
    source="SAE 931842, abstract "
    "(https://www.sae.org/publications/technical-papers/content/931842/)",
    domain="rear-end and barrier tests with factory bumpers, velocity changes of 2 to 5 mph (0.9 "
    "to 2.2 m/s)",
    quality="Measured with accelerometers and high-speed film; the abstract says clustered in "
    "this range, not bounded by it.",
)
RESTITUTION_OBLIQUE = Published(
    name="restitution, oblique frontal tests at full speed",
    low=0.089,
    high=0.150,
    source=_OBLIQUE_TESTS,
    domain="car into car or utility vehicle, 35 mph each, along the contact normal, closing "
    "speed 23.4 and 24.4 m/s in two",
    quality="Four tests; how the paper arrived at the values could not be checked.",
)
RESTITUTION_SMALL_OVERLAP = Published(
    name="restitution, small overlap with a barrier",
    low=0.0,
    high=0.253,
    source=_SMALL_OVERLAP_TESTS,
    domain="cars of 2008 to 2012, 40 mph, 20 or 25 percent of the width; closing speed along the "
    "contact normal 3.8 to 5.0 m/s",
    quality="Fitted to measured motion; some yaw inertias behind the fit are borrowed from "
    "another car.",
)
RESTITUTION_FRONTAL_BARRIER = Published(
    name="restitution, full frontal rigid barrier",
    low=0.158,
    high=0.181,
    typical=0.17,
    source=f"NHTSA test 10146, raw accelerometers in {_PYCRASH} (projects/pycrash "
    "demo/data/input/v10146ascii), integrated",
    domain="one car of 2018 into a rigid barrier at 57.1 km/h",
    quality="One test; the range is that of its sensors.",
)


def _by_overlap(
    which: str, low: float, high: float, source: str, domain: str, quality: str
) -> Published:
    """A row of restitution by the share of the width that overlaps."""
    return Published(
        name=f"restitution, rear-end, {which}",
        low=low,
        high=high,
        source=source,
        domain=domain,
        quality=quality,
    )


_REAR_END = (
    "Verkehrsunfall und Fahrzeugtechnik 2000, p. 275, abstract at "
    "https://www.colliseum.eu/wiki (Die Stosszahl bei Auffahrkollisionen)",
    "car into the rear of a car, relative speed 7.8 to 32.4 km/h",
    (
        "Second hand: the abstract of an evaluation of 38 tests, which calls it a guide; few "
        "tests had a small overlap."
    ),
)
_LOW_SPEED_REAR_END = (
    "Moosmueller and Reinkemeyer, Verkehrsunfall und Fahrzeugtechnik 45 (2007), p. 44, summary at "
    "https://www.colliseum.eu/wiki (Erkenntnisse zum Deformationsverhalten moderner Fahrzeuge)",
    "modern cars of 2002 to 2004 into the rear of one, delta-V up to 10 km/h",
    (
        "Second hand: a summary of three test series of the Allianz Zentrum für Technik, of "
        "which it quotes the values."
    ),
)
RESTITUTION_OVERLAP_SMALL = _by_overlap("under half the width", 0.0, 0.15, *_REAR_END)
RESTITUTION_OVERLAP_HALF = _by_overlap("about half the width", 0.10, 0.20, *_REAR_END)
RESTITUTION_OVERLAP_LARGE = _by_overlap("over half the width", 0.15, 0.30, *_REAR_END)
RESTITUTION_LOW_SPEED_HALF = _by_overlap(
    "half the width, low speed", 0.173, 0.247, *_LOW_SPEED_REAR_END
)
RESTITUTION_LOW_SPEED_FULL = _by_overlap("full width, low speed", 0.328, 0.38, *_LOW_SPEED_REAR_END)

INTER_VEHICLE_FRICTION = Published(
    name="inter-vehicle friction",
    low=0.3,
    high=1.0,
    typical=0.55,
    source=(
        "McHenry and McHenry, SAE 970947, as quoted by the authors "
        "(http://www.mchenrysoftware.com/board/viewtopic.php?f=36&t=26); 0.55 is also the "
        "default of EDSMAC (https://github.com/edccorp/hveManuals)"
    ),
    domain="Coulomb friction between vehicle bodies in SMAC simulations",
    quality=(
        "A recommendation from use, not a measurement. The same page reports that Marine (SAE "
        "2007-01-0744) has values far above 1; pycrash has 0.3 as default."
    ),
)
IMPULSE_RATIO_OBLIQUE = Published(
    name="impulse ratio, magnitude, oblique frontal tests",
    low=0.40,
    high=0.51,
    source=_OBLIQUE_TESTS,
    domain=_OBLIQUE,
    quality="Four tests; the critical ratio of each, which follows from geometry and speeds: no "
    "measurement of its own.",
)
IMPULSE_RATIO_SMALL_OVERLAP = Published(
    name="impulse ratio, magnitude, small overlap with a barrier",
    low=1.57,
    high=2.05,
    source=_SMALL_OVERLAP_TESTS,
    domain=_SMALL_OVERLAP,
    quality="Fitted to measured motion; above 1, because parts snag: no Coulomb friction.",
)
SHARE_OF_CRITICAL_OBLIQUE = Published(
    name="share of the critical impulse ratio, oblique frontal tests",
    low=1.0,
    high=1.0,
    source=_OBLIQUE_TESTS,
    domain=_OBLIQUE,
    quality="Used by the authors for four tests; the delta-Vs that follow from it are their "
    "solution, not a measurement.",
)
SHARE_OF_CRITICAL_SMALL_OVERLAP = Published(
    name="share of the critical impulse ratio, small overlap with a barrier",
    low=0.823,
    high=1.0,
    source=_SMALL_OVERLAP_TESTS,
    domain=_SMALL_OVERLAP,
    quality="Fitted to measured motion in ten tests.",
)

_COLLISEUM = (
    "Fahrzeugbelastungen bei Heck-Crashs im niedrigen Geschwindigkeitsbereich (DTC, AGU), as "
    "quoted at https://www.colliseum.eu/wiki (Stosszeit)"
)
_DURATION = (
    "Second hand: ends and mean of a series of tests; the end of a contact is a matter of the "
    "threshold."
)
CONTACT_DURATION = Published(
    name="duration of contact, rear-end, unbraked",
    low=0.078,
    high=0.147,
    typical=0.115,
    unit="s",
    source=_COLLISEUM,
    domain="cars into the rear of cars at low speed, not braked",
    quality=_DURATION,
)
CONTACT_DURATION_BRAKED = Published(
    name="duration of contact, rear-end, braked",
    low=0.088,
    high=0.124,
    typical=0.109,
    unit="s",
    source=_COLLISEUM,
    domain="cars into the rear of cars at low speed, braked",
    quality=_DURATION,
)
CONTACT_DURATION_SIDESWIPE = Published(
    name="duration of contact, sideswipe",
    low=0.3,
    high=1.0,
    unit="s",
    source="https://www.colliseum.eu/wiki (Stosszeit) for over 0.3 s; about 1 s by Funk and "
    "others (SAE, 2004)",
    domain="cars that slide along each other",
    quality="Second hand: one test by its video, and a round number that is quoted of a paper "
    "which was not read.",
)

CONTACT_POINT_DRAWN = Published(
    name="contact point from a drawing, how far aside the impulse passed",
    low=0.08,
    high=0.54,
    typical=0.27,
    unit="m",
    source=(
        "seven staged collisions (RICSAC; Jones and Baum, DOT HS-805 040, 1978), measurements by "
        "Neades, thesis (references/JNeadesThesis.pdf in the history of "
        f"{_PYCRASH}); worked out in validation/blind"
    ),
    domain="the centroid of the drawn damage; two cars of the nineteen-seventies, 9 to 20 m/s, "
    "front against side, rear or front",
    quality=(
        "Seven tests, by the yaw rates after; the usual value is their root mean square. A couple "
        "that a wide contact passes on looks the same as a point elsewhere. Yaw inertias are those "
        "of classes of cars, and 0.35 m more (root mean square) of the lever arms is of no point: "
        "it turns both cars the same way."
    ),
)

_RECORDER = "49 CFR 563.8, Table III (https://www.ecfr.gov/current/title-49/part-563)"
RECORDER_ACCURACY = Published(
    name="accuracy of a recorder's delta-V, relative",
    low=-0.10,
    high=0.10,
    source=_RECORDER,
    domain="longitudinal and lateral delta-V of US light vehicles with a recorder under Part "
    "563, from September 2012 on",
    quality="What the regulation demands, each component by itself; of an impact within the "
    "range of the sensor.",
)
RECORDER_RESOLUTION = Published(
    name="step in which a recorder reports delta-V",
    low=1.0 / 3.6,
    high=1.0 / 3.6,
    unit="m/s",
    source=_RECORDER,
    domain="as for the accuracy",
    quality="What the regulation demands; some recorders report finer steps.",
)
RECORDER_RANGE = Published(
    name="delta-V over which a recorder's accuracy is demanded",
    low=-100.0 / 3.6,
    high=100.0 / 3.6,
    unit="m/s",
    source=_RECORDER,
    domain="as for the accuracy",
    quality="The least range that the regulation demands, each component by itself; a recorder may "
    "go beyond it.",
)
RECORDER_ERROR = Published(
    name="error of a recorder's delta-V in tests, relative",
    low=0.0,
    high=0.10,
    typical=0.06,
    source="Niehoff and others, Evaluation of Event Data Recorders in Full Systems Crash Tests, "
    "ESV 2005 (NHTSA), abstract",
    domain="recorders of three makers before Part 563, in frontal tests, where the whole pulse "
    "was recorded",
    quality="The average is just under 6 percent; the upper end is that of Part 563. Pulses that "
    "ended early read too low.",
)

# Half the width of the range that SAE 931842 measured, taken as the scatter about the fit.
_SCATTER = 0.5 * (RESTITUTION_LOW_SPEED.high - RESTITUTION_LOW_SPEED.low)
# Upper bound above the speeds of the fit: the highest value published there, 0.253, with a small
# margin.
_HIGHEST = 0.3


@hinted
def restitution(closing_speed: Input, *, outside: Outside = "warn") -> Value:
    """Coefficient of restitution at a closing speed, by the fit of Cipriani and others.

    The fit is a mean over pairs of vehicles, and a single pair may be 0.1 to 0.2 off, so use a
    range. Its source, range and quality are in ``RESTITUTION_FIT``.

    Parameters
    ----------
    closing_speed : float, str, Quantity or array [m/s]
        Along the contact normal, > 0.
    outside : {"warn", "refuse"}
        What to do outside 2 to 15 mph: extrapolate with a warning, or refuse. Where the formula
        gives no restitution, above 58.7 km/h or below 0.25 km/h, the speed is refused in any case.

    Returns
    -------
    float or array
        Restitution, from 0 to 1; NaN for a case of a batch that is refused.

    Raises
    ------
    InputError
        An argument that cannot be used; a single closing speed for which there is no answer (code
        ``outside_reference``).

    Warns
    -----
    OutOfRangeWarning
        Outside the range of the fit.

    Examples
    --------
    >>> from collisions import reconstruct, reference
    >>> round(reference.restitution("5 mph"), 4)
    0.3826

    As a function of the closing speed for the reverse solvers, which then stay within its range:

    >>> fit = lambda speed: reference.restitution(speed, outside="refuse")
    >>> round(3.6 * reconstruct.inline_closing_speed(1500, 1500, fit, delta_v_a="5 km/h"), 1)
    7.2
    """
    reader = ArgumentReader()
    speed: Any = reader.number(closing_speed, "m/s", "closing_speed", POSITIVE_FINITE)
    check_outside(reader, outside)
    reader.close()
    with np.errstate(all="ignore"):
        e = _fitted((math if isinstance(speed, float) else np).log10(speed))
        usable = (e >= 0.0) & (e <= 1.0) & (speed > 0.0)
    if isinstance(e, float) and not usable:
        given = shown(closing_speed) if has_unit(closing_speed) else f"{speed:.6g} m/s"
        raise InputError(
            f"closing_speed {given}: the fit gives {e:.3g}, which is no restitution; it holds "
            "from 2 to 15 mph. Give a value, such as one from reference.RESTITUTION",
            code="outside_reference",
            argument="closing_speed",
        )
    return settle(
        RESTITUTION_FIT,
        e,
        {"closing_speed": speed},
        usable,
        outside,
        Sentences(texts_of(reader.texts)),
    )


@hinted
def restitution_range(closing_speed: Input) -> tuple[Value, Value]:
    """Lowest and highest plausible restitution at a closing speed.

    The lowest is 0, because bodies may stay together. Up to 15 mph the highest is the fit plus 0.1
    (half the width of ``RESTITUTION_LOW_SPEED``), but at least 0.3. Above 15 mph it is 0.3, which
    exceeds every value published here for such speeds (``RESTITUTION``, ``RESTITUTION_OBLIQUE``,
    ``RESTITUTION_SMALL_OVERLAP``). Below 2 mph it is 1, because nothing is published.

    Parameters
    ----------
    closing_speed : float, str, Quantity or array [m/s]
        Along the contact normal, >= 0.

    Returns
    -------
    tuple of float or array
        Lowest and highest.

    Raises
    ------
    InputError
        An argument that cannot be used.

    Examples
    --------
    >>> [round(restitution_range(speed)[1], 2) for speed in ("1 mph", "3 mph", "10 mph", "40 mph")]
    [1.0, 0.54, 0.39, 0.3]
    """
    reader = ArgumentReader()
    speed: Any = reader.number(closing_speed, "m/s", "closing_speed")
    speed = at_least_zero(
        reader,
        speed,
        closing_speed,
        "closing_speed",
        "negative_speed",
        "it is the speed of approach",
    )
    reader.close()
    slowest, fastest, _ = RESTITUTION_FIT.ranges["closing_speed"]
    with np.errstate(all="ignore"):
        fitted = np.where(
            speed < slowest,
            1.0,
            np.where(speed > fastest, -1.0, _fitted(np.log10(speed)) + _SCATTER),
        )
        usable = np.isfinite(speed) & np.greater_equal(speed, 0.0)
        ends: list[Any] = [
            np.where(usable, end, math.nan) for end in (0.0, np.maximum(fitted, _HIGHEST))
        ]
    for end in ends:
        end.setflags(write=False)
    found: tuple[Any, Any] = (
        (float(ends[0]), float(ends[1])) if isinstance(speed, float) else (ends[0], ends[1])
    )
    return found


def _fitted(x: Any) -> Any:
    """The fit at the logarithm of the closing speed."""
    return 0.47477 + x * (-0.26139 + x * (0.03382 - 0.11639 * x))


@hinted
def restitution_by_overlap(overlap: Input) -> Published:
    """Published range of the restitution in a rear-end collision, by the share of the width that
    overlaps.

    Here up to 45 percent counts as under half and 55 percent or more as over half; the source says
    only "about".

    Parameters
    ----------
    overlap : float, str or Quantity [-]
        Share of the width, > 0 and at most 1.

    Returns
    -------
    Published
        The range with its source, for relative speeds of 7.8 to 32.4 km/h.

    Raises
    ------
    InputError
        An overlap that cannot be used.

    Examples
    --------
    >>> row = restitution_by_overlap("40 %")
    >>> row.low, row.high
    (0.0, 0.15)
    """
    reader = ArgumentReader()
    share = single_number(
        reader, reader.number(overlap, "", "overlap"), "overlap", "takes one value; ask for each"
    )
    if share <= 0.0 or share > 1.0:
        reader.refuse(must_be("overlap", "> 0 and at most 1", overlap, code="bad_fraction"))
    reader.close()
    return (RESTITUTION_OVERLAP_SMALL, RESTITUTION_OVERLAP_HALF, RESTITUTION_OVERLAP_LARGE)[
        (share > 0.45) + (share >= 0.55)
    ]
